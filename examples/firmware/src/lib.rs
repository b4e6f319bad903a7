//! The part of the firmware that a board and a desktop share: the [`scene`], the bytes of its
//! grey levels ([`gray4`]), the [`checksum`]s by which two machines compare their pictures, and the
//! driver of the OLED ([`ssd0323`]).
//!
//! The programs are `src/bin/oled` (LM3S6965EVB, Cortex-M3) and `src/bin/microbit` (Cortex-M0).
//!
//! What speed is judged on is of no board: the scenes of [`bench`](mod@bench) and, one kind of work each, of [`cost`];
//! and [`s4`], a whole display's, which `src/bin/bands` draws on the LM3S6965EVB, too. So are the small programs by which
//! flash is judged, which draw a [`cube`](mod@cube).

#![cfg_attr(not(test), no_std)]
#![forbid(unsafe_code)]

pub mod bench;
pub mod checksum;
pub mod cost;
pub mod cube;
pub mod gray4;
pub mod s4;
pub mod scene;
pub mod ssd0323;
