//! A frame as the board draws it, and the desktop.

use core::convert::Infallible;

use embedded_graphics::prelude::*;
use fixel_firmware::{
    bench::Deep,
    checksum::Rgb565Sum,
    s4::{self, List},
};

/// What is drawn at a time.
const BAND: Size = Size::new(s4::SIZE.width, if cfg!(feature = "rows-8") { 8 } else { 16 });
/// Its pixels.
pub(crate) const PIXELS: usize = (BAND.width * BAND.height) as usize;

/// Draws the scene; returns the checksum of the whole screen's words.
pub(crate) fn draw(pixels: &mut [u16; PIXELS], depth: &mut [u16; PIXELS], list: &mut List<'_>) -> u32 {
    s4::record(list).expect("the list holds the scene");
    let mut band = Deep::new(BAND, pixels, depth).expect("the buffers hold it");
    let mut sum = Rgb565Sum::new();
    let Ok(()) = s4::render(list, &mut band, |band| {
        sum.add(band.pixels());
        Ok::<_, Infallible>(())
    });
    sum.finish()
}
