//! What each kind of work costs: [`fixel_firmware::cost`] as functions that a counter of instructions calls.

#![cfg_attr(target_os = "none", no_std, no_main)]

#[cfg(all(target_os = "none", not(board = "bare")))]
compile_error!("`cost` is for counters of instructions: build it with --features bare");

#[cfg(board = "bare")]
#[expect(unsafe_code, reason = "exported symbols")]
#[path = "../bench/bare.rs"]
mod bare;
#[cfg(board = "bare")]
#[expect(unsafe_code, reason = "exported symbols, and frames that are too large for a stack")]
#[path = "../bench/deep.rs"]
mod deep;
#[cfg(board = "bare")]
#[expect(unsafe_code, reason = "exported symbols, and frames that are too large for a stack")]
#[path = "../bench/frames.rs"]
mod frames;

#[cfg(board = "bare")]
#[expect(unsafe_code, reason = "exported symbols")]
mod functions {
    use crate::{deep::with_deep, frames::with_flat};
    use fixel_firmware::cost;

    /// Draws a rectangle, without (0) or with (1) depth.
    #[unsafe(no_mangle)]
    extern "C" fn cost_rectangle(surface: u32, quality: u32, depth: u32, shape: u32) {
        if depth == 0 {
            with_flat(|frame| cost::rectangle(surface, quality, shape, frame));
        } else {
            with_deep(|frame| cost::rectangle(surface, quality, shape, frame));
        }
    }

    /// Draws a rectangle that is not opaque, or in fog, without (0) or with (1) depth.
    #[unsafe(no_mangle)]
    extern "C" fn cost_layered(number: u32, depth: u32, shape: u32) {
        if depth == 0 {
            with_flat(|frame| cost::layered_rectangle(number, shape, frame));
        } else {
            with_deep(|frame| cost::layered_rectangle(number, shape, frame));
        }
    }

    /// Draws triangles of a kind.
    #[unsafe(no_mangle)]
    extern "C" fn cost_triangles(kind: u32, many: u32, surface: u32) {
        with_flat(|frame| cost::triangles(kind, many, surface, frame));
    }
}

#[cfg(not(target_os = "none"))]
fn main() {
    println!("cost is called by a counter of instructions; see README.md");
}
