//! Drawing with depth, and what a counter calls before and after a scene.

use crate::frames::FRAMEBUFFER;
use core::ptr::addr_of_mut;
use fixel::Band;
use fixel_firmware::bench::{Deep, PIXELS, SIZE};

static mut DEPTH: [u16; PIXELS] = [0; PIXELS];

fn frame() -> (&'static mut [u16; PIXELS], &'static mut [u16; PIXELS]) {
    // SAFETY: one thread, no interrupts, and no reference outlives a function of this program.
    unsafe { (&mut *addr_of_mut!(FRAMEBUFFER), &mut *addr_of_mut!(DEPTH)) }
}

pub(crate) fn with_deep(draw: impl FnOnce(&mut Deep<'_>)) {
    let (pixels, depth) = frame();
    if let Ok(mut frame) = Band::new(SIZE, pixels, depth) {
        draw(&mut frame);
    }
}

/// Colour and depth as before a frame.
#[unsafe(no_mangle)]
pub(crate) extern "C" fn bench_clear() {
    let (pixels, depth) = frame();
    pixels.fill(0);
    depth.fill(0);
}

/// Pixels that were drawn since they were cleared: no scene draws black without depth.
#[unsafe(no_mangle)]
pub(crate) extern "C" fn bench_covered() -> u32 {
    let (pixels, depth) = frame();
    let mut covered = 0;
    for (pixel, depth) in pixels.iter().zip(depth) {
        covered += u32::from(*pixel != 0 || *depth != 0);
        // Not unrolled: it is no part of what is measured, but of the program's size.
        core::hint::black_box(());
    }
    covered
}
