//! The colours that are drawn into, and drawing without depth.

use core::ptr::addr_of_mut;
use fixel::Band;
use fixel_firmware::bench::{Flat, PIXELS, SIZE};

/// For a debugger or an emulator to read.
#[unsafe(no_mangle)]
pub(crate) static mut FRAMEBUFFER: [u16; PIXELS] = [0; PIXELS];
static mut NO_DEPTH: [(); PIXELS] = [(); PIXELS];

pub(crate) fn with_flat(draw: impl FnOnce(&mut Flat<'_>)) {
    // SAFETY: one thread, no interrupts, and no reference outlives a scene.
    let (pixels, depth) = unsafe { (&mut *addr_of_mut!(FRAMEBUFFER), &mut *addr_of_mut!(NO_DEPTH)) };
    if let Ok(mut frame) = Band::new(SIZE, pixels, depth) {
        draw(&mut frame);
    }
}
