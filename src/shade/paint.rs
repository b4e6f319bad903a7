//! Which loop draws a triangle: that of small ones, of opaque ones, in fog, or in layers.
//!
//! - In: a cover, and the fill that a shader chose.
//! - Out: words and depths where the triangle is seen.
//! - Assumes: the triangle was set up for the shader.

use super::border::uv_bits;
use super::cover::Cover;
use super::even::Even;
use super::fill::{Fill, FillRow};
use super::layered::draw_some;
use super::opaque;
use super::quality::Quality;
use super::quality::sealed::Sealed;
use super::shader::Pixels;
use crate::frame::{DepthFormat, PixelFormat};

impl<F: PixelFormat, D: DepthFormat> Sealed for Cover<'_, '_, F, D> {}

impl<F: PixelFormat, D: DepthFormat, Q: Quality> Pixels<F::Word, Q> for Cover<'_, '_, F, D> {
    #[inline]
    fn is_gray(&self) -> bool {
        self.setup.gray
    }

    fn uv_are_inside(&self, log2: [u32; 2]) -> bool {
        self.setup.uv_are_inside(log2)
    }

    fn uv_bits(&self) -> [u32; 2] {
        uv_bits(self.setup)
    }

    #[inline]
    fn fill_evenly(self, word: F::Word) {
        if let Some(draw) = self.target.drawn_by() {
            draw(self, &Even(word));
        } else if self.setup.is_patch() {
            self.draw_small(&Even(word));
        } else {
            opaque::draw_evenly(self, word);
        }
    }

    #[inline]
    fn fill<const N: usize, L: Fill<F::Word> + FillRow<N, Word = F::Word>>(self, fill: &L) {
        draw(self, fill);
    }

    #[inline]
    fn fill_rows(self, fill: &dyn Fill<F::Word>) {
        match self.target.drawn_by() {
            Some(draw) => draw(self, fill),
            None => opaque::draw(self, fill),
        }
    }

    #[inline]
    fn fill_some(self, fill: &dyn Fill<Option<F::Word>>) {
        draw_some(self, fill);
    }
}

#[inline]
fn draw<const N: usize, F, D, L>(cover: Cover<'_, '_, F, D>, fill: &L)
where
    F: PixelFormat,
    D: DepthFormat,
    L: Fill<F::Word> + FillRow<N, Word = F::Word>,
{
    if let Some(draw) = cover.target.drawn_by() {
        draw(cover, fill);
    } else if cover.setup.is_patch() {
        cover.draw_small(fill);
    } else {
        opaque::draw(cover, fill);
    }
}
