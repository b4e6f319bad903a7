//! Stage 4: a triangle's rows.
//!
//! Along a row each edge that is not level gives one number: how many pixel centres lie to its left.
//!
//! ```text
//!   pixel       0     1     2     3     4     5
//!   centres     ·     ·     ·     ·     ·     ·
//!                  \                 /
//!                   left edge: 1    right edge: 4      → pixels 1 … 3
//! ```
//!
//! A centre on the edge itself counts as right of it. So a left edge owns the centres on it and
//! a right edge does not, a level top edge does and a level bottom edge does not (a row belongs to the
//! triangle if top ≤ centre < bottom): the top-left rule. Two triangles that share an edge ask for the
//! same number, one as its end and one as its start: no centre is missed and none drawn twice, by construction.
//!
//! The number is ceil(−E/16dy) for the edge function E at the row's first centre. From row to row it changes
//! by the slope, kept as a quotient and a remainder (Bresenham's way), so it stays exact.

use super::fill::Fill;
use super::setup::TriangleSetup;
use super::shade::{Pixels, Quality, sealed::Sealed};
use crate::math::recip::{Reciprocal, quotient_of_10_bits};
use crate::scene::Viewport;
use core::ops::Range;

/// Pixels of one row of a triangle, side by side and all visible.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Span<'a> {
    pub(super) setup: &'a TriangleSetup,
    pub(super) x: i32,
    pub(super) y: i32,
}

const _: () = assert!(size_of::<Span<'_>>() == size_of::<usize>() + 8);

impl<'a> Span<'a> {
    pub(crate) fn new(setup: &'a TriangleSetup, x: i32, y: i32) -> Self {
        Self { setup, x, y }
    }

    /// Without its first pixels.
    pub(crate) const fn ahead(&self, pixels: usize) -> Self {
        Self { setup: self.setup, x: self.x + pixels as i32, y: self.y }
    }

    /// q = near/w with 31 fraction bits at the first pixel, and its step.
    pub(crate) fn depth(&self) -> (u32, i32) {
        self.setup.at(&self.setup.z, self.x, self.y)
    }
}

/// A [`Span`] and its pixels.
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
        if self.span.setup.straight {
            self.span.fill_straight(self.pixels, fill);
        } else {
            self.span.fill::<Q, N, L>(self.pixels, fill);
        }
    }
}

/// An edge from row to row.
#[derive(Clone, Copy, Debug, Default)]
struct Edge {
    /// Pixel centres left of the edge, with [`FRACTION`] bits: the fraction of a short edge, and none of a long one.
    x: i32,
    slope: i32,
    /// Of a long edge: by how much it lies right of where it would meet the centre before, 0 … `divisor` − 1.
    remainder: i32,
    slope_remainder: i32,
    /// 16·dy.
    divisor: i32,
}

const FRACTION: u32 = 20;

impl Edge {
    /// Both ends in 1/16 px, `top` above `bottom`, and the first row wanted, which lies between.
    #[inline(always)]
    fn set(&mut self, is_long: bool, top: &[i32; 2], bottom: &[i32; 2], row: i32) {
        if is_long {
            return self.long(top, bottom, row);
        }
        self.x = (top[0] + 8) << (FRACTION - 4);
        self.short(bottom[0] - top[0], bottom[1] - top[1], row * 16 + 8 - top[1]);
    }

    /// Likewise.
    #[cold]
    #[inline(never)]
    fn long(&mut self, top: &[i32; 2], bottom: &[i32; 2], row: i32) {
        let (dx, dy) = (bottom[0] - top[0], bottom[1] - top[1]);
        let divisor = 16 * dy;
        let reciprocal = Reciprocal::precise(divisor as u32);
        // −E at centre 0, plus divisor − 1 to round up: below 16392·32752 + 32752² + 524032 < 2³¹.
        let below = row * 16 + 8 - top[1];
        let (x, remainder) = reciprocal.div_rem((top[0] - 8) * dy + below * dx + divisor - 1, divisor);
        let (slope, slope_remainder) = reciprocal.div_rem(16 * dx, divisor);
        *self = Self { x: x << FRACTION, slope: slope << FRACTION, remainder, slope_remainder, divisor };
    }

    /// From an `x` that is half a pixel right of the upper end, by how far right the lower end lies and how far below it and the
    /// first row's centres (1/16 px): at most 32 pixels wide and less high, without a remainder.
    ///
    /// The number is a multiple of 1/16dy, rounded up. 2⁻¹⁴ less, half of the least such step, may be wrong by just as much. The
    /// reciprocal is, by 2⁻²⁰, and makes |dx|·2⁻²⁴ ≤ 2⁻¹⁵ of x; the slope's rounding makes 2⁻²¹ a row, 2⁻¹⁶ at most.
    #[inline(never)]
    fn short(&mut self, dx: i32, dy: i32, below: i32) {
        let slope = quotient_of_10_bits(dx, dy);
        self.x += ((below * slope) >> 4) - ((1 << (FRACTION - 14)) + 1);
        self.slope = slope;
    }

    /// To the next row. At a triangle's end x may lie beyond all columns.
    #[inline]
    fn next(&mut self) -> i32 {
        let x = self.x >> FRACTION;
        self.x = self.x.wrapping_add(self.slope);
        x
    }

    fn carry(&mut self) {
        self.remainder += self.slope_remainder;
        if self.remainder >= self.divisor {
            self.remainder -= self.divisor;
            self.x = self.x.wrapping_add(1 << FRACTION);
        }
    }
}

/// A triangle's rows within a window. One is used for all triangles of a draw.
#[derive(Clone, Debug, Default)]
pub(crate) struct Rows {
    left: Edge,
    right: Edge,
    row: i32,
    /// Where one edge takes another's place, and the end of the rows.
    knee: i32,
    end: i32,
    /// The edge that begins at the knee.
    lower: Edge,
    lower_is_right: bool,
    is_long: bool,
    /// Whether some of the triangle lies beyond the window's first or last column.
    is_cut: bool,
}

impl Rows {
    /// Those of a triangle whose corners run clockwise.
    #[inline]
    pub(crate) fn start(&mut self, [a, b, c]: &[[i32; 2]; 3], window: &Window) {
        if a[1] <= b[1] && a[1] <= c[1] {
            self.start_at(a, b, c, window);
        } else if b[1] <= c[1] {
            self.start_at(b, c, a, window);
        } else {
            self.start_at(c, a, b, window);
        }
    }

    /// From the top down the right to `next`, and down the left to `last`.
    ///
    /// Not inlined: on a Cortex-M0+ it takes less to hand on three places than to choose between corners time and again.
    #[inline(never)]
    fn start_at(&mut self, top: &[i32; 2], next: &[i32; 2], last: &[i32; 2], window: &Window) {
        let (next_row, last_row) = (first_row(next[1]), first_row(last[1]));
        let Range { start, end } = window.columns;
        self.row = first_row(top[1]).max(window.rows.start);
        self.end = next_row.max(last_row).min(window.rows.end);
        // A cut triangle may lie beyond all columns.
        let inside = |x: i32| (x - start * 16) | (end * 16 - x);
        self.is_cut = inside(top[0]) | inside(next[0]) | inside(last[0]) < 0;
        let xs = [top[0], next[0], last[0]];
        if self.is_cut
            && (xs.iter().all(|x| first_row(*x) >= end) || xs.iter().all(|x| first_row(*x) < start))
        {
            self.end = self.row;
        }
        if self.row >= self.end {
            return;
        }
        let wide = |from: i32, to: i32| to - from + (1 << 9);
        self.is_long = (wide(top[0], next[0]) | wide(top[0], last[0]) | wide(next[0], last[0])) as u32 >> 10
            != 0
            || (next[1] - top[1]) | (last[1] - top[1]) >= 1 << 9;
        if next_row > self.row {
            self.right.set(self.is_long, top, next, self.row);
        }
        if last_row > self.row {
            self.left.set(self.is_long, top, last, self.row);
        }
        self.lower_is_right = next_row < last_row;
        self.knee = next_row.min(last_row).min(self.end);
        if self.knee < self.end {
            let (from, to) = if self.lower_is_right { (next, last) } else { (last, next) };
            self.lower.set(self.is_long, from, to, self.knee.max(self.row));
        }
    }

    /// Whether it has none, or just one or two that are empty: many a small triangle has no more in a band.
    #[inline]
    pub(super) fn are_none(&self) -> bool {
        if self.row >= self.end {
            return true;
        }
        let count = self.end - self.row;
        let is_empty = |left: i32, right: i32| left >> FRACTION >= right >> FRACTION;
        let (left, right) = (&self.left, &self.right);
        count <= 2
            && self.end <= self.knee
            && is_empty(left.x, right.x)
            && (count == 1
                || !self.is_long
                    && is_empty(left.x.wrapping_add(left.slope), right.x.wrapping_add(right.slope)))
    }

    /// Whether they are at most 32 pixels wide and less high, and all columns within the window.
    #[inline]
    pub(crate) fn are_simple(&self) -> bool {
        !self.is_long && !self.is_cut
    }

    /// The first row.
    #[inline]
    pub(crate) fn row(&self) -> i32 {
        self.row
    }

    /// The first row alone.
    pub(super) fn first(&self) -> Self {
        let end = self.end.min(self.row + 1);
        Self { end, knee: self.knee.min(end), ..self.clone() }
    }

    /// The next row where [`Rows::are_simple`]: the first column and the one behind the last. It may be empty.
    #[inline(always)]
    pub(super) fn next(&mut self) -> Option<(i32, i32)> {
        if self.row >= self.knee && !self.reach_knee() {
            return None;
        }
        self.row += 1;
        Some((self.left.next(), self.right.next()))
    }

    /// Hands on every row where [`Rows::are_simple`], from a pixel on: how far it lies below that, and how far its first column
    /// and the one behind the last lie to the right. It may be empty.
    ///
    /// Edges are on the stack here, which takes no register to find them.
    #[inline(always)]
    pub(super) fn each_simple(&mut self, [x, y]: [i32; 2], mut emit: impl FnMut(i32, i32, i32)) {
        let beside = |edge: &Edge| Edge { x: edge.x.wrapping_sub(x << FRACTION), ..*edge };
        let (mut left, mut right) = (beside(&self.left), beside(&self.right));
        loop {
            for row in self.row - y..self.knee - y {
                emit(row, left.next(), right.next());
            }
            if self.knee >= self.end {
                return;
            }
            let edge = if self.lower_is_right { &mut right } else { &mut left };
            *edge = beside(&self.lower);
            (self.row, self.knee) = (self.row.max(self.knee), self.end);
        }
    }

    /// Hands on every row: the row, the first column and the one behind the last.
    #[inline]
    pub(crate) fn each(&mut self, window: &Window, mut emit: impl FnMut(i32, i32, i32)) {
        while let Some((mut left, mut right)) = self.next() {
            left = left.max(window.columns.start);
            right = right.min(window.columns.end);
            if self.is_long {
                self.left.carry();
                self.right.carry();
            }
            if left < right {
                emit(self.row - 1, left, right);
            }
        }
    }

    /// The edge that begins at the knee takes the place of the one that ends there. False at the end.
    #[inline(never)]
    fn reach_knee(&mut self) -> bool {
        if self.row >= self.end {
            return false;
        }
        let edge = if self.lower_is_right { &mut self.right } else { &mut self.left };
        *edge = self.lower;
        self.knee = self.end;
        true
    }
}

/// The first row whose centres lie on or below `y` (1/16 px).
const fn first_row(y: i32) -> i32 {
    (y + 7) >> 4
}

/// The part of the screen that is drawn to.
#[derive(Clone, Debug)]
pub(crate) struct Window {
    pub(crate) columns: Range<i32>,
    pub(crate) rows: Range<i32>,
}

impl Window {
    /// Of the largest target.
    pub(crate) const LARGEST: Self = Self { columns: 0..1023, rows: 0..1023 };

    /// The first pixel centre within an extent of three positions (1/16 px) along an axis, and the one behind the last.
    pub(super) fn centers(a: i32, b: i32, c: i32) -> [i32; 2] {
        [first_row(a.min(b).min(c)), first_row(a.max(b).max(c))]
    }

    pub(crate) fn within(self, viewport: &Viewport) -> Self {
        let (left, top) = (i32::from(viewport.left), i32::from(viewport.top));
        let within = |range: Range<i32>, start: i32, length: i16| {
            range.start.max(start)..range.end.min(start + i32::from(length))
        };
        Self {
            columns: within(self.columns, left, viewport.width),
            rows: within(self.rows, top, viewport.height),
        }
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.columns.is_empty() || self.rows.is_empty()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn short_edges_of_all_sizes_count_exactly_in_every_row() {
        let mut seed = 1_u32;
        for dy in 1..1 << 9 {
            for dx in -512..=512 {
                seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
                let top = [(seed >> 16) as i32 % 15_000, (seed >> 4) as i32 & 15];
                let bottom = [top[0] + dx, top[1] + dy];
                let (start, end) = (first_row(top[1]), first_row(bottom[1]));
                let mut edge = Edge::default();
                // As the window may have it, from any row on.
                let first = start + (seed >> 10 & 1) as i32 * ((end - start) / 2);
                if first < end {
                    edge.set(false, &top, &bottom, first);
                }
                for row in first..end {
                    let exactly = (top[0] - 8) * dy + (row * 16 + 8 - top[1]) * dx + 16 * dy - 1;
                    assert_eq!(edge.next(), exactly.div_euclid(16 * dy), "{top:?} to {bottom:?}, row {row}");
                }
            }
        }
    }
}
