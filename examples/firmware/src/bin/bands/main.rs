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
#[cfg(any(board = "lm3s6965evb", not(target_os = "none")))]
mod frame;
#[cfg(any(board = "bare", board = "mps2"))]
#[expect(unsafe_code, reason = "exported symbols, and frames that are too large for a stack")]
mod functions;
#[cfg(board = "lm3s6965evb")]
mod lm3s6965;
#[cfg(board = "mps2")]
mod mps2;

#[cfg(not(target_os = "none"))]
fn main() {
    let (mut pixels, mut depth) = ([0; frame::PIXELS], [0; frame::PIXELS]);
    let mut memory = fixel_firmware::s4::Memory::new();
    let mut list = fixel_firmware::s4::List::new(&mut memory);
    let rgb565 = frame::draw(&mut pixels, &mut depth, &mut list);
    println!("s4 rgb565 {rgb565:08X}");
}
