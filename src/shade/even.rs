//! The fill of one word, everywhere.
//!
//! - In: a run of pixels.
//! - Out: words.
//! - Assumes: nothing.

use super::curve::Curve;
use super::fill::{Fill, FillRow, draw_row};
use super::memory::Memory;
use super::units::Units;
use crate::frame::{Depth16, PixelFormat, Single};
use crate::raster::TriangleSetup;

/// One word everywhere.
pub(crate) struct Even<W>(pub(crate) W);

impl<W: Copy> Fill<W> for Even<W> {
    fn units(&self) -> Units {
        Units::general(0, false)
    }

    fn straight(&self, pixels: &mut [W], _: &Curve) {
        fill(pixels, self.0);
    }

    fn table(&self, pixels: &mut [W], _: &Curve) {
        fill(pixels, self.0);
    }
}

impl<W: Copy + 'static> FillRow<0> for Even<W> {
    type Word = W;
    type At = ();
    type Step = ();

    #[inline]
    fn at(&self, _: [i32; 0], (): ()) {}

    #[inline]
    fn step(&self, _: [i32; 0]) {}

    #[inline]
    fn draw_in_rgb565<F: PixelFormat<Word = W>>(
        &self,
        setup: &TriangleSetup,
        memory: &mut Memory<'_, u16, u16>,
    ) -> bool {
        F::in_rgb565::<Single>(self.0).is_some_and(|word| {
            draw_evenly_in_rgb565(setup, memory, word);
            true
        })
    }

    #[inline]
    fn row(&self, pixels: &mut [W], (): (), (): ()) {
        draw_row(pixels, (), (), |()| self.0);
    }
}

/// Not inlined: among the rows' loop it would have no registers, and take twice as long on a Cortex-M0+. And so it is there once.
#[inline(never)]
pub(super) fn fill<W: Copy>(pixels: &mut [W], word: W) {
    pixels.fill(word);
}

#[inline(never)]
fn draw_evenly_in_rgb565(setup: &TriangleSetup, memory: &mut Memory<'_, u16, u16>, word: u16) {
    memory.draw_small::<0, Depth16, _>(setup, &Even(word));
}
