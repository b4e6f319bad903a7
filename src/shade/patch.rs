//! A patch: a small triangle drawn at one go, all rows of it.
//!
//! - In: a small triangle that is set up, its spans, and the memory of a band.
//! - Out: words and depths where the triangle is in front.
//! - Assumes: near/w is 2⁻¹⁶ or more all over the triangle, as set-up makes sure for small ones.
//!
//! A row of such a triangle has two or three pixels. To hand them on, first to a depth test and then to a loop that draws them,
//! takes longer than to draw them. So both loops stand side by side here, once for each fill and depth format: one counts the pixels
//! that are in front, the next draws them. Where there are registers for all that both need, they are one loop.
//!
//! All that belongs to a row is a product with its number: nothing is carried from row to row.

use super::cover::Cover;
use super::fill::{FillRow, tested};
use super::memory::Memory;
use crate::frame::{DepthFormat, PixelFormat};
use crate::num::{IS_ARMV6M, U1F31};
use crate::raster::{Rows, Spans, TriangleSetup, WIDEST};
use core::hint::black_box;
use core::ops::Range;

impl<F: PixelFormat, D: DepthFormat> Cover<'_, '_, F, D> {
    /// Draws a small triangle: by a function that is compiled with this crate, if there is one.
    #[inline]
    pub(super) fn draw_small<const N: usize, L>(self, fill: &L)
    where
        L: FillRow<N, Word = F::Word>,
    {
        let Self { setup, target } = self;
        let is_drawn =
            target.memory.in_rgb565::<F, D>().is_some_and(|memory| fill.draw_in_rgb565::<F>(setup, memory));
        if !is_drawn {
            draw_apart::<N, D, L>(setup, &mut target.memory, fill);
        }
    }
}

/// Draws a small triangle in any formats.
#[inline(never)]
fn draw_apart<const N: usize, D, L>(
    setup: &TriangleSetup,
    memory: &mut Memory<'_, L::Word, D::Word>,
    fill: &L,
) where
    D: DepthFormat,
    L: FillRow<N>,
{
    memory.draw_small::<N, D, L>(setup, fill);
}

impl<P, Z> Memory<'_, P, Z> {
    /// Draws a small triangle.
    #[inline(always)]
    pub(super) fn draw_small<const N: usize, D, L>(&mut self, setup: &TriangleSetup, fill: &L)
    where
        D: DepthFormat<Word = Z>,
        L: FillRow<N, Word = P>,
    {
        // Hidden on Armv6-M: what rows read of it would be kept, in registers that there are not.
        let setup = if IS_ARMV6M { black_box(setup) } else { setup };
        let Self { rows, origin, width, pixels, depth, .. } = self;
        let width = *width;
        let (Rows::Short(spans), Some(attributes)) = (rows, setup.attributes.first_chunk::<N>()) else {
            return;
        };
        // So that both are known to be as long.
        let length = if D::ALWAYS_PASSES { pixels.len() } else { pixels.len().min(depth.len()) };
        let Some(pixels) = pixels.get_mut(..length) else {
            return;
        };
        let all_depth = depth.get_mut(..length).unwrap_or_default();
        let (row, column) = (i32::from(spans.row), i32::from(spans.column));
        let origin = *origin;
        let first_of_row_0 =
            origin.wrapping_add((row as usize).wrapping_mul(width)).wrapping_add(column as usize);
        let longest = setup.longest as usize + 1;
        let steps = || core::array::from_fn(|i| attributes[i].plane.steps[0]);
        let plain_step = fill.step(steps());
        let Range { start: first_row, end: mut n } = spans.rows();
        while n > first_row {
            n -= 1;
            let this = n;
            let [start, end] = spans.span(this).map(usize::from);
            if start >= end {
                continue;
            }
            let place = beyond_first([start, this]);
            let mut count = end - start;
            // What is left of a row comes next, as a row of its own: so the loop knows nothing of parts.
            if L::BENDS && count > longest {
                count = longest;
                n = spans.leave(this, start + count);
            }
            let first = first_of_row_0.wrapping_add(this * width).wrapping_add(start);
            // In two steps: the end of a range is checked more dearly.
            let Some(mut pixels) = pixels.get_mut(first..).and_then(|rest| rest.get_mut(..count)) else {
                return;
            };
            let at = || core::array::from_fn(|i| attributes[i].plane.at(place) as i32);
            let step = || if L::PACKS { plain_step } else { fill.step(steps()) };
            if !D::ALWAYS_PASSES {
                let Some(depth) = all_depth.get_mut(first..).and_then(|rest| rest.get_mut(..count)) else {
                    return;
                };
                let near_w = (setup.z.at(place), setup.z.steps[0]);
                let left = if L::FUSES {
                    let step = step();
                    fill.row_tested::<D>(pixels, depth, near_w, (fill.at(at(), step), step))
                } else {
                    tested::<D>(depth, near_w)
                };
                if left > 0 {
                    let hidden = [count, left];
                    (count, n) =
                        skip_hidden::<D>(setup, spans, all_depth, [origin, width], [start, this], hidden);
                    if count == 0 {
                        continue;
                    }
                    pixels = pixels.get_mut(..count).unwrap_or_default();
                }
                if L::FUSES {
                    continue;
                }
            }
            let at = at();
            let (at, step) = if L::BENDS && setup.is_bent {
                fill.bent(setup, (place, count as i32 - 1), at, steps())
            } else {
                let step = step();
                (fill.at(at, step), step)
            };
            fill.row(pixels, at, step);
        }
    }
}

/// From a triangle's first pixel, where planes begin, to a column and a row of its table.
#[inline(always)]
fn beyond_first([column, row]: [usize; 2]) -> [i32; 2] {
    [column as i32 - WIDEST as i32, row as i32]
}

/// Leaves of a row what follows its hidden pixels. Of a run of so many pixels, from a column and a row of the table on, the last `left`
/// were not tested, but for the first of them, which is hidden. Returns how many are visible before that, and the end of the rows that are
/// still to be drawn.
///
/// It finds all anew, so that nothing is kept for it. A format is asked once to test and store for each pixel of a triangle, as one that
/// counts them expects.
#[cold]
#[inline(never)]
fn skip_hidden<D: DepthFormat>(
    setup: &TriangleSetup,
    spans: &mut Spans,
    depth: &mut [D::Word],
    [origin, width]: [usize; 2],
    [column, row]: [usize; 2],
    [count, left]: [usize; 2],
) -> (usize, usize) {
    let visible = count - left;
    let column = column + visible;
    let (x, y) = (i32::from(spans.column) + column as i32, i32::from(spans.row) + row as i32);
    let first = origin.wrapping_add((y as usize).wrapping_mul(width)).wrapping_add(x as usize);
    let mut hidden = 1;
    for stored in depth.iter_mut().skip(first + 1).take(left - 1) {
        let near_w = U1F31::from_bits(setup.z.at(beyond_first([column + hidden, row])));
        if D::test(stored, near_w) {
            break;
        }
        D::test_and_store_small(stored, near_w);
        hidden += 1;
    }
    (visible, spans.leave(row, column + hidden))
}
