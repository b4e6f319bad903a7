//! A frame for the libraries that draw through embedded-graphics.

use crate::model::{HEIGHT, PIXELS, WIDTH};
use embedded_graphics::Pixel;
use embedded_graphics::pixelcolor::{Rgb565, raw::RawU16};
use embedded_graphics::prelude::*;
use embedded_graphics::primitives::Rectangle;
use std::convert::Infallible;

/// 160×120 colours in memory: as fast a `DrawTarget` as there can be without `unsafe`, so that it is not the
/// target that a library is measured by. A solid row is one `fill`.
#[derive(Debug)]
pub struct Frame {
    pixels: Vec<Rgb565>,
}

impl Frame {
    /// A black frame.
    #[must_use]
    pub fn new() -> Self {
        Self { pixels: vec![Rgb565::BLACK; PIXELS] }
    }

    /// Everything in one colour, a word of RGB565.
    pub fn clear_to(&mut self, word: u16) {
        self.pixels.fill(RawU16::new(word).into());
    }

    /// The words of the pixels, row after row.
    #[must_use]
    pub fn words(&self) -> Vec<u16> {
        self.pixels.iter().map(|&color| color.into_storage()).collect()
    }
}

impl Default for Frame {
    fn default() -> Self {
        Self::new()
    }
}

impl OriginDimensions for Frame {
    fn size(&self) -> Size {
        Size::new(WIDTH as u32, HEIGHT as u32)
    }
}

impl DrawTarget for Frame {
    type Color = Rgb565;
    type Error = Infallible;

    #[inline]
    fn draw_iter<I: IntoIterator<Item = Pixel<Rgb565>>>(&mut self, pixels: I) -> Result<(), Infallible> {
        for Pixel(Point { x, y }, color) in pixels {
            // Negative coordinates are large ones.
            if (x as usize) < WIDTH
                && let Some(pixel) = self.pixels.get_mut((y as usize).wrapping_mul(WIDTH) + x as usize)
            {
                *pixel = color;
            }
        }
        Ok(())
    }

    #[inline]
    fn fill_solid(&mut self, area: &Rectangle, color: Rgb565) -> Result<(), Infallible> {
        let area = area.intersection(&self.bounding_box());
        let (left, width) = (area.top_left.x as usize, area.size.width as usize);
        for y in area.rows() {
            let row = y as usize * WIDTH + left;
            self.pixels[row..row + width].fill(color);
        }
        Ok(())
    }
}
