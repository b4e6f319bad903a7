//! A run of pixels, all of which are drawn: what a picture that has no depth passes to a shader.
//!
//! - In: a span, and the words of its pixels.
//! - Out: the same for a shader, as `Pixels` that it fills.
//! - Assumes: nothing hides a pixel.

use super::border::uv_bits;
use super::fill::{Fill, FillRow};
use super::perspective::Perspective;
use super::quality::Quality;
use super::quality::sealed::Sealed;
use super::shader::Pixels;
use crate::raster::Span;

/// A [`Span`] and the words of its pixels, which say how many there are.
pub(crate) struct Run<'a, W> {
    pub(crate) span: Span<'a>,
    pub(crate) pixels: &'a mut [W],
}

impl<W> Sealed for Run<'_, W> {}

impl<W: Copy, Q: Quality> Pixels<W, Q> for Run<'_, W> {
    #[inline]
    fn is_gray(&self) -> bool {
        self.span.setup.gray
    }

    fn uv_are_inside(&self, log2: [u32; 2]) -> bool {
        self.span.setup.uv_are_inside(log2)
    }

    fn uv_bits(&self) -> [u32; 2] {
        uv_bits(self.span.setup)
    }

    #[inline]
    fn fill_evenly(self, word: W) {
        self.pixels.fill(word);
    }

    #[inline]
    fn fill<const N: usize, L: Fill<W> + FillRow<N, Word = W>>(self, fill: &L) {
        self.draw(fill);
    }

    #[inline]
    fn fill_rows(self, fill: &dyn Fill<W>) {
        self.draw(fill);
    }

    /// Never asked for: what leaves pixels out is no opaque material, and a picture without a buffer takes no other.
    fn fill_some(self, _: &dyn Fill<Option<W>>) {}
}

impl<W> Run<'_, W> {
    #[inline(never)]
    fn draw(self, fill: &dyn Fill<W>) {
        let Span { setup, x, y } = self.span;
        if !self.pixels.is_empty() {
            Perspective::new(setup, fill).draw(x, y, self.pixels, fill);
        }
    }
}
