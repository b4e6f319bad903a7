//! A patch: a small triangle drawn at one go, all rows of it.
//!
//! - In: a small triangle that is set up, its rows, and the memory of a band.
//! - Out: words and depths where the triangle is in front.
//! - Assumes: the triangle is straight (or one quadratic), at most 32 pixels wide and less high.
//!
//! A row of such a triangle has two or three pixels. To find which of them are visible, and to hand these to a loop that draws
//! them, takes longer than to draw them, about 450 cycles on a Cortex-M0+: so nothing is handed on, and one loop tests a pixel's
//! depth and draws it, at 170 cycles a row. From row to row depth and attributes go by one addition; what a bent triangle's
//! attributes have to be bent by is a quadratic of column and row, evaluated at the first and the last pixel.
//!
//! What a pixel shows depends on its triangle alone, not on what hides it or where the band begins: rows are shaded whole.

use super::cover::Cover;
use super::fill::FillRow;
use super::row::Row;
use crate::frame::{DepthFormat, PixelFormat};
use crate::raster::{Rows, STRAIGHT, TriangleSetup};

/// Whether a triangle is drawn at one go.
#[inline]
pub(crate) fn is_small(setup: &TriangleSetup, rows: &Rows) -> bool {
    setup.is_small && setup.straight && rows.are_simple()
}

impl<F: PixelFormat, D: DepthFormat> Cover<'_, F, D> {
    #[inline(never)]
    pub(super) fn draw_small<const N: usize, L: FillRow<N, Word = F::Word>>(&mut self, fill: &L) {
        let Self { setup, rows, origin, width, pixels, depth, .. } = self;
        let (setup, origin, width) = (*setup, *origin, *width);
        // Where column 0 of the first row would be.
        let mut row = origin.wrapping_add((rows.row() as usize).wrapping_mul(width));
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
        // Hidden, so that the compiler keeps the minimum, and not what it is of.
        let longest = core::hint::black_box(setup.longest.min(fill.longest_row()));
        let is_bent = setup.longest < STRAIGHT;
        let scales = [0, 1].map(|i| attributes.get(i).map_or(0, |attribute| attribute.scale_log2));
        let scale_log2 = scales[0] | scales[1] << 8;
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
                    (at[i], step[i]) = attribute.along((value, right), steps);
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
                    fill.row(Row::<F::Word, D> { pixels, depth, near_w, near_w_step, scale_log2 }, at, step);
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
