//! Bands on their way to a display that a driver has set up: row after row as they stand in memory, without a call, a copy or a
//! conversion a pixel.
//!
//! Drivers that are embedded-graphics targets take colours one by one. The controllers behind them take a window and then bytes, and
//! a band of [`BigEndian`](fixel::BigEndian) words is such bytes. So let a driver set the display up, take the bus back from it
//! (`release()`), and send by [`Rows`], or by [`AsyncRows`] where SPI is asynchronous.
//!
//! Both speak what MIPI's display command set has and the ST7735, ST7789, ST7796, ILI9341, ILI9486, ILI9488 and GC9A01 understand:
//! `0x2a` and `0x2b` set the columns and rows of a window, `0x2c` begins pixels.

#![no_std]
#![forbid(unsafe_code)]

mod async_rows;
mod rows;
mod window;

pub use async_rows::{AsyncRows, Memory};
pub use rows::Rows;
pub use window::Error;
