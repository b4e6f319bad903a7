//! s4, a screen of 240×320, in the RAM of a small board: from a list, in bands of 16 rows, or 8 with the feature `rows-8`.
//! There is no frame buffer: a band's bytes go into a checksum where they would go to a display.
//!
//! On the LM3S6965EVB board, and on a desktop, it prints a line, `s4 rgb565 XXXXXXXX`, through semihosting, and exits; with
//! the argument `hold` (QEMU's `-semihosting-config …,arg=bands,arg=hold`) it never exits.
//!
//! With the feature `mps2` it counts the instructions of s4 in bands and at once, on an MPS2 board in QEMU; with `bare` it is
//! functions for any counter: see `functions.rs`.

#![cfg_attr(target_os = "none", no_std, no_main)]

#[cfg(board = "microbit")]
compile_error!(
    "`bands` runs on the lm3s6965evb board: build it with --bin bands --target thumbv7m-none-eabi"
);

#[cfg(board = "bare")]
#[expect(unsafe_code, reason = "exported symbols")]
#[path = "../bench/bare.rs"]
mod bare;
#[cfg(any(board = "bare", board = "mps2"))]
#[expect(unsafe_code, reason = "exported symbols, and frames that are too large for a stack")]
mod functions;
#[cfg(board = "lm3s6965evb")]
mod lm3s6965;
#[cfg(board = "mps2")]
mod mps2;

#[cfg(any(board = "lm3s6965evb", not(target_os = "none")))]
use embedded_graphics::prelude::*;
#[cfg(any(board = "lm3s6965evb", not(target_os = "none")))]
use fixel_firmware::{
    bench::Deep,
    checksum::Rgb565Sum,
    s4::{self, List},
};

/// What is drawn at a time.
#[cfg(any(board = "lm3s6965evb", not(target_os = "none")))]
const BAND: Size = Size::new(s4::SIZE.width, if cfg!(feature = "rows-8") { 8 } else { 16 });
/// Its pixels.
#[cfg(any(board = "lm3s6965evb", not(target_os = "none")))]
const PIXELS: usize = (BAND.width * BAND.height) as usize;

/// Draws the scene; returns the checksum of the whole screen's words.
#[cfg(any(board = "lm3s6965evb", not(target_os = "none")))]
fn frame(pixels: &mut [u16; PIXELS], depth: &mut [u16; PIXELS], list: &mut List) -> u32 {
    s4::record(list).expect("the list holds the scene");
    let mut band = Deep::new(BAND, pixels, depth).expect("the buffers hold it");
    let mut sum = Rgb565Sum::new();
    let Ok(()) = s4::render(list, &mut band, |band| {
        sum.add(band.pixels());
        Ok::<_, core::convert::Infallible>(())
    });
    sum.finish()
}

#[cfg(not(target_os = "none"))]
fn main() {
    let (mut pixels, mut depth) = ([0; PIXELS], [0; PIXELS]);
    println!("s4 rgb565 {:08X}", frame(&mut pixels, &mut depth, &mut List::new()));
}
