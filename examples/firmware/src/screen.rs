//! What the small programs have around their `draw`: a screen, and the function that draws a frame into it. A part of each of
//! them by `#[path]`.
//!
//! There is no board, no start-up code and no printing. On a desktop a program says how many pixels it covers.

use embedded_graphics::{pixelcolor::Rgb565, prelude::*};
use fixel::{Turn, prelude::Band};
use fixel_firmware::cube::{PIXELS, SIZE};

#[cfg(all(target_os = "none", not(board = "bare")))]
compile_error!("this program is for no board: build it with --features bare");

/// Draws one frame, the cube turned so far.
fn show(turn: Turn, pixels: &mut [u16; PIXELS], depth: &mut [u16; PIXELS]) {
    if let Ok(mut screen) = Band::new(SIZE, pixels, depth) {
        let Ok(()) = screen.clear(Rgb565::BLACK);
        crate::draw(turn, &mut screen);
    }
}

#[cfg(board = "bare")]
#[expect(unsafe_code, reason = "exported symbols")]
#[path = "bin/bench/bare.rs"]
mod bare;

#[cfg(board = "bare")]
#[expect(unsafe_code, reason = "an exported symbol, and a frame that is too large for a stack")]
mod exported {
    use super::{PIXELS, Turn, show};
    use core::ptr::addr_of_mut;

    static mut COLORS: [u16; PIXELS] = [0; PIXELS];
    static mut DEPTH: [u16; PIXELS] = [0; PIXELS];

    /// A frame, for whoever calls it by its name.
    #[unsafe(no_mangle)]
    extern "C" fn frame(turn: u16) {
        // SAFETY: one thread, no interrupts, and no reference outlives this function.
        let (colors, depth) = unsafe { (&mut *addr_of_mut!(COLORS), &mut *addr_of_mut!(DEPTH)) };
        show(Turn::from_raw(turn), colors, depth);
    }
}

/// Prints how many pixels a frame covers.
#[cfg(not(target_os = "none"))]
pub(crate) fn print() {
    let (mut colors, mut depth) = ([0; PIXELS], [0; PIXELS]);
    show(Turn::from_degrees(30), &mut colors, &mut depth);
    println!("{} pixels; for its flash see README.md", depth.iter().filter(|&&depth| depth != 0).count());
}
