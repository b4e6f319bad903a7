//! A row of a small triangle: one loop tests the depth of its pixels and shades them.
//!
//! - In: the pixels and depths of the row, near/w at the first pixel and its step per pixel; attributes likewise.
//! - Out: words and depths of the pixels that are visible.
//! - Assumes: near/w is 2⁻¹⁶ or more all along, as set-up makes sure for small triangles; the row is at most 32 pixels long.

use super::packed::sized;
use crate::frame::DepthFormat;
use crate::num::U1F31;
use crate::scene::Texture;

/// A row of at most 32 pixels, some of which may be hidden.
#[derive(Debug)]
pub struct Row<'a, W, D: DepthFormat> {
    pub(crate) pixels: &'a mut [W],
    pub(crate) depth: &'a mut [D::Word],
    /// near/w at the first pixel, with 31 fraction bits. (Greater is nearer.)
    pub(crate) near_w: u32,
    /// What it changes by from pixel to pixel.
    pub(crate) near_w_step: i32,
    /// u and v, if there are any, are still to be shifted left by the two lower bytes of this, as by `Attribute::scale_log2`.
    pub(crate) scale_log2: u32,
}

impl<W, D: DepthFormat> Row<'_, W, D> {
    /// By how much attribute `i` is still to be shifted left. (If there are no u and v the first two are colours, and this is 0.)
    #[inline]
    pub(crate) fn scale_log2(&self, i: usize) -> u32 {
        if i < 2 { self.scale_log2 >> (8 * i) & 31 } else { 0 }
    }

    /// Draws the pixels that are visible. `at` is what the first pixel's word is made of: its attributes, in whatever form.
    /// `next` leads from there to the next pixel, and `word` makes a word of it.
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
            if D::test_and_store_small(stored, U1F31::from_bits(self.near_w)) {
                *pixel = word(at);
            }
            self.near_w = self.near_w.wrapping_add_signed(self.near_w_step);
            at = next(at);
            // Keeps the loop from being unrolled, which does not pay for a few pixels.
            core::hint::black_box(());
        }
    }

    /// As [`Row::draw`], with texels. u and v are packed in one word, `at` at the first pixel, and step by `step`. `other` is
    /// whatever else a word is made of, besides the texel, and `next` leads to the next pixel's.
    ///
    /// For 4096 and 1024 texels the compiler knows that no index lies outside: nothing is checked.
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
