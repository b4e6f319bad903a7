//! s4 as functions that a counter calls by name: in bands of any height, and at once, with room for a whole frame.

use core::{convert::Infallible, ptr::addr_of_mut};
use embedded_graphics::prelude::*;
use fixel_firmware::{
    bench::Deep,
    s4::{self, List, Memory, PIXELS},
};

/// For a debugger or an emulator to read: the frame, or the last band.
#[unsafe(no_mangle)]
static mut FRAMEBUFFER: [u16; PIXELS] = [0; PIXELS];
static mut DEPTH: [u16; PIXELS] = [0; PIXELS];
static mut MEMORY: Memory = Memory::new();
/// On the memory, from the first call on.
static mut LIST: Option<List<'static>> = None;

/// Puts the scene into the list; returns its triangles.
#[unsafe(no_mangle)]
pub(crate) extern "C" fn bench_s4_list() -> u32 {
    // SAFETY: one thread, no interrupts, and no reference outlives a function of this program.
    let list = unsafe { &mut *addr_of_mut!(LIST) };
    // SAFETY: as above; the memory is borrowed once, by the list.
    let list = list.get_or_insert_with(|| List::new(unsafe { &mut *addr_of_mut!(MEMORY) }));
    match s4::record(list) {
        Ok(()) => list.lengths()[1] as u32,
        Err(_) => 0,
    }
}

/// Draws what is in the list, `rows` rows (1 … 320) at a time; returns how many rows it showed.
#[unsafe(no_mangle)]
pub(crate) extern "C" fn bench_s4_bands(rows: u32) -> u32 {
    // SAFETY: as above.
    let (list, pixels, depth) =
        unsafe { (&mut *addr_of_mut!(LIST), &mut *addr_of_mut!(FRAMEBUFFER), &mut *addr_of_mut!(DEPTH)) };
    let mut shown = 0;
    if let (Some(list), Ok(mut band)) = (list, Deep::new(Size::new(s4::SIZE.width, rows), pixels, depth)) {
        let Ok(()) = s4::render(list, &mut band, |band| {
            shown += band.size().height;
            Ok::<_, Infallible>(())
        });
    }
    shown
}

/// A frame: the list, and what is in it, `rows` rows at a time; returns how many rows it showed.
#[unsafe(no_mangle)]
pub(crate) extern "C" fn bench_s4(rows: u32) -> u32 {
    if bench_s4_list() == 0 { 0 } else { bench_s4_bands(rows) }
}

/// The same frame drawn at once, without a list; returns its rows.
#[unsafe(no_mangle)]
pub(crate) extern "C" fn bench_s4_whole(_frame: u32) -> u32 {
    // SAFETY: as above.
    let (pixels, depth) = unsafe { (&mut *addr_of_mut!(FRAMEBUFFER), &mut *addr_of_mut!(DEPTH)) };
    match Deep::new(s4::SIZE, pixels, depth) {
        Ok(mut frame) => {
            s4::draw(&mut frame);
            frame.size().height
        }
        Err(_) => 0,
    }
}
