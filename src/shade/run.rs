//! What is passed to a shader: a run, that is, a span of visible pixels with their memory.
//!
//! - In: a span, and the words of its pixels.
//! - Out: the same for a shader, as `Pixels` that it fills.
//! - Assumes: all of the pixels are visible: depth was tested, if at all.

use super::fill::Fill;
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

    #[inline]
    fn fill_evenly(self, word: W) {
        self.pixels.fill(word);
    }

    #[inline]
    fn fill<const N: usize, L: Fill<N, Word = W>>(self, fill: &L) {
        if self.span.is_straight() {
            self.span.fill_straight(self.pixels, fill);
        } else {
            self.span.fill::<Q, N, L>(self.pixels, fill);
        }
    }
}
