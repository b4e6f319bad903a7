//! Stage 5 for small straight triangles, which most of a mesh's are: all rows at one go.
//!
//! A row of such a triangle has two or three pixels. To find which of them are visible, and to hand these to a loop that draws
//! them, takes longer than to draw them, about 450 cycles on a Cortex-M0+: so nothing is handed on, and one loop tests a pixel's
//! depth and draws it, at 170 cycles a row. From row to row depth and attributes go by one addition; what a bent triangle's
//! attributes have to be bent by is a quadratic of column and row, evaluated at the first and the last pixel.
//!
//! What a pixel shows depends on its triangle alone, not on what hides it or where the band begins: rows are shaded whole.

use super::fill::{Each, Fill, sized};
use super::setup::TriangleSetup;
use super::shade::{Pixels, Quality, sealed::Sealed};
use super::span::Rows;
use crate::num::U1F31;
use crate::scene::Texture;
use crate::target::DepthFormat;

/// The longest row of a straight triangle, in steps.
pub(super) const STRAIGHT: i32 = 31;

/// The pixels of a small straight triangle.
pub(crate) struct Patch<'a, W, D: DepthFormat> {
    pub(crate) setup: &'a TriangleSetup,
    pub(crate) rows: &'a mut Rows,
    /// Where column 0 of the first row would be among the pixels, wrapping, and from where to where it is a row further.
    pub(crate) first: usize,
    pub(crate) width: usize,
    pub(crate) pixels: &'a mut [W],
    /// None if it is never tested.
    pub(crate) depth: &'a mut [D::Word],
}

impl<W, D: DepthFormat> Sealed for Patch<'_, W, D> {}

impl<W: Copy, D: DepthFormat, Q: Quality> Pixels<W, Q> for Patch<'_, W, D> {
    fn is_gray(&self) -> bool {
        self.setup.gray
    }

    fn fill_evenly(self, word: W) {
        self.draw(&Each::new(|[]: [i32; 0]| word));
    }

    fn fill<const N: usize, L: Fill<N, Word = W>>(self, fill: &L) {
        self.draw(fill);
    }
}

impl<W, D: DepthFormat> Patch<'_, W, D> {
    /// Whether a triangle can be drawn so.
    #[inline]
    pub(crate) fn takes(setup: &TriangleSetup, rows: &Rows) -> bool {
        setup.is_small && setup.straight && rows.are_simple()
    }

    #[inline(never)]
    fn draw<const N: usize, L: Fill<N, Word = W>>(self, fill: &L) {
        let Self { setup, rows, first: mut row, width, pixels, depth } = self;
        let Some(attributes) = setup.attributes.first_chunk::<N>() else {
            return;
        };
        // So that both are known to be as long.
        let length = if D::ALWAYS_PASSES { pixels.len() } else { pixels.len().min(depth.len()) };
        let Some(pixels) = pixels.get_mut(..length) else {
            return;
        };
        let depth = depth.get_mut(..length).unwrap_or_default();
        // At corner 0's column, and from its row on.
        let [x, y] = setup.corners[0].map(|at| at >> 4);
        let mut near_w = setup.at(&setup.z, x, rows.row()).0;
        let mut values: [u32; N] = core::array::from_fn(|i| setup.at(&attributes[i].plane, x, rows.row()).0);
        let near_w_step = setup.z.steps[0];
        // Hidden, so that the compiler keeps one number.
        let longest = core::hint::black_box(setup.longest.min(fill.longest_row()));
        let is_bent = setup.longest < STRAIGHT;
        let scale_log2 = attributes.first().map_or(0, |attribute| attribute.scale_log2);
        row = row.wrapping_add(x as usize);
        rows.each_simple([x, y], |n, mut m, end| {
            while m < end {
                let steps = (end - m - 1).min(longest);
                let (mut at, mut step) = ([0; N], [0; N]);
                for (i, attribute) in attributes.iter().enumerate() {
                    let (mut value, mut right) = (values[i], attribute.plane.steps[0]);
                    if is_bent {
                        let [xx, xy, yy] = attribute.bend;
                        let down = yy.wrapping_mul(n).wrapping_mul(n);
                        right = right.wrapping_add(xy.wrapping_mul(n)).wrapping_add(xx.wrapping_mul(m));
                        value = value.wrapping_add_signed(down.wrapping_add(right.wrapping_mul(m)));
                        right = right.wrapping_add(xx.wrapping_mul(m + steps));
                    } else {
                        value = value.wrapping_add_signed(right.wrapping_mul(m));
                    }
                    (at[i], step[i]) = attribute.unscaled((value, right), steps);
                }
                let (first, count) = (row.wrapping_add(m as usize), steps as usize + 1);
                // In two steps: the end of a range is checked more dearly.
                let part = |all| <[_]>::get_mut(all, first..).and_then(|rest| rest.get_mut(..count));
                let depth = if D::ALWAYS_PASSES {
                    Some(&mut [][..])
                } else {
                    depth.get_mut(first..).and_then(|rest| rest.get_mut(..count))
                };
                if let (Some(pixels), Some(depth)) = (part(&mut *pixels), depth) {
                    let near_w = near_w.wrapping_add_signed(m.wrapping_mul(near_w_step));
                    fill.row(Row::<W, D> { pixels, depth, near_w, near_w_step, scale_log2 }, at, step);
                }
                m += steps + 1;
            }
            row = row.wrapping_add(width);
            near_w = near_w.wrapping_add_signed(setup.z.steps[1]);
            for (value, attribute) in values.iter_mut().zip(attributes) {
                *value = value.wrapping_add_signed(attribute.plane.steps[1]);
            }
        });
    }
}

/// A short row of pixels, some of which may be hidden.
#[derive(Debug)]
pub struct Row<'a, W, D: DepthFormat> {
    pixels: &'a mut [W],
    depth: &'a mut [D::Word],
    /// With 31 fraction bits, at the first pixel.
    near_w: u32,
    near_w_step: i32,
    /// Of u and v, if there are any: as [`Attribute`](super::attribute::Attribute) has it.
    scale_log2: u32,
}

impl<W, D: DepthFormat> Row<'_, W, D> {
    /// By how much attribute `i` is to be shifted left.
    #[inline]
    pub(super) fn scale_log2(&self, i: usize) -> u32 {
        if i < 2 { self.scale_log2 & 31 } else { 0 }
    }

    /// Draws what is visible of it: the word of a place, the first being `at`.
    #[inline]
    pub(super) fn draw<P: Copy>(mut self, mut at: P, next: impl Fn(P) -> P, word: impl Fn(P) -> W) {
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
    /// Of the sizes for which [`Texels`](super::fill::Texels) has an array no index has to be checked.
    #[inline]
    pub(super) fn draw_texels<P: Copy>(
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
