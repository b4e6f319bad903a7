//! A short row of pixels: depth is tested and colours are made in one loop.
//!
//! - In: pixels and depths of one row, near/w and its step.
//! - Out: words where the depth is in front.

use super::packed::sized;
use crate::frame::DepthFormat;
use crate::num::U1F31;
use crate::scene::Texture;

/// A short row of pixels, some of which may be hidden.
#[derive(Debug)]
pub struct Row<'a, W, D: DepthFormat> {
    pub(crate) pixels: &'a mut [W],
    pub(crate) depth: &'a mut [D::Word],
    /// With 31 fraction bits, at the first pixel.
    pub(crate) near_w: u32,
    pub(crate) near_w_step: i32,
    /// Of u and v, if there are any: as `Attribute` has it.
    pub(crate) scale_log2: u32,
}

impl<W, D: DepthFormat> Row<'_, W, D> {
    /// By how much attribute `i` is to be shifted left.
    #[inline]
    pub(crate) fn scale_log2(&self, i: usize) -> u32 {
        if i < 2 { self.scale_log2 & 31 } else { 0 }
    }

    /// Draws what is visible of it: the word of a place, the first being `at`.
    #[inline]
    pub(crate) fn draw<P: Copy>(mut self, mut at: P, next: impl Fn(P) -> P, word: impl Fn(P) -> W) {
        if D::ALWAYS_PASSES {
            for pixel in self.pixels {
                *pixel = word(at);
                at = next(at);
                core::hint::black_box(());
            }
            return;
        }
        for (pixel, stored) in self.pixels.iter_mut().zip(self.depth) {
            if D::test_small(stored, U1F31::from_bits(self.near_w)) {
                *pixel = word(at);
            }
            self.near_w = self.near_w.wrapping_add_signed(self.near_w_step);
            at = next(at);
            // Not unrolled, which few pixels do not pay for.
            core::hint::black_box(());
        }
    }

    /// As [`Row::draw`], of texels at packed coordinates, the first at `at`, each `step` further, and what else goes along.
    ///
    /// Of the sizes for which `Texels` has an array no index has to be checked.
    #[inline]
    pub(crate) fn draw_texels<P: Copy>(
        self,
        texture: &Texture<'_>,
        [at, step]: [u32; 2],
        other: P,
        next: impl Fn(P) -> P,
        word: impl Fn(u16, P) -> W,
    ) {
        let next = |(at, other): (u32, P)| (at.wrapping_add(step), next(other));
        if let Ok(texels) = <&[u16; 0x1000]>::try_from(texture.texels()) {
            let texel = sized(texture, texels);
            self.draw((at, other), next, |(at, other)| word(texel(at), other));
        } else if let Ok(texels) = <&[u16; 0x400]>::try_from(texture.texels()) {
            let texel = sized(texture, texels);
            self.draw((at, other), next, |(at, other)| word(texel(at), other));
        } else {
            self.draw((at, other), next, |(at, other)| word(texture.fetch_packed(at), other));
        }
    }
}
