//! Rows: which pixels of each row a triangle covers, exactly.
//!
//! - In: corners in 1/16 px, clockwise, and a window.
//! - Out: for each row the span of columns that the triangle covers, as start and end (exclusive).
//! - Assumes: the corners lie in the guard band, so that edge functions fit an i32.
//!
//! Along a row each edge that is not horizontal gives one number: how many pixel centres lie to its left.
//!
//! ```text
//!   pixel       0     1     2     3     4     5
//!   centres     ·     ·     ·     ·     ·     ·
//!                  \                 /
//!                   left edge: 1    right edge: 4      → pixels 1 … 3
//! ```
//!
//! A centre on the edge itself counts as right of it. So a left edge owns the centres on it and a right edge does not.
//! A row belongs to the triangle if top ≤ centre < bottom. So a horizontal top edge owns the centres on it and a horizontal
//! bottom edge does not. That is the top-left rule. Two triangles that share an edge ask for the same number, one as the end
//! of its span and one as the start: no centre is missed and none drawn twice, by construction.
//!
//! The number is ceil(E/16dy). E is the edge function (see [`setup`](super::setup)) of the edge from its upper end to its lower
//! one, at the row's centre in column 0; dy is the edge's height in 1/16 px. From row to row E/16dy changes by the slope dx/dy:
//!
//! - A *long* edge keeps number and slope as quotient and remainder, as Bresenham does: exact for edges of any size.
//! - A *short* edge keeps them with 20 fraction bits. That is exact as well, for triangles within 32 pixels: `Edge::short`
//!   proves it. One addition takes it to the next row.

use crate::frame::{Window, first_center};
use crate::math::recip::{Reciprocal, quotient_of_10_bits};
use core::ops::Range;

/// An edge, in one row after another.
#[derive(Clone, Copy, Debug, Default)]
struct Edge {
    /// How many pixel centres lie left of the edge, with [`FRACTION`] fraction bits. In a long edge these are 0: `remainder`
    /// is in their place.
    x: i32,
    /// What `x` changes by from row to row.
    slope: i32,
    /// Long edges: what the division that gave `x` leaves, 0 … `divisor` − 1. The edge lies (`remainder` + 1)/`divisor` pixels
    /// right of the last centre that is left of it.
    remainder: i32,
    /// Long edges: what `remainder` changes by from row to row.
    slope_remainder: i32,
    /// Long edges: 16·dy.
    divisor: i32,
}

/// The fraction bits of [`Edge::x`] and [`Edge::slope`].
const FRACTION: u32 = 20;

impl Edge {
    /// Sets an edge from `top` down to `bottom`, both in 1/16 px, at `row`, whose centres lie between them.
    #[inline(always)]
    fn set(&mut self, is_long: bool, top: &[i32; 2], bottom: &[i32; 2], row: i32) {
        if is_long {
            return self.long(top, bottom, row);
        }
        self.x = (top[0] + 8) << (FRACTION - 4);
        self.short(bottom[0] - top[0], bottom[1] - top[1], row * 16 + 8 - top[1]);
    }

    /// As [`Edge::set`], for a long edge.
    #[cold]
    #[inline(never)]
    fn long(&mut self, top: &[i32; 2], bottom: &[i32; 2], row: i32) {
        let (dx, dy) = (bottom[0] - top[0], bottom[1] - top[1]);
        let divisor = 16 * dy;
        let reciprocal = Reciprocal::precise(divisor as u32);
        // E at the centre in column 0, plus divisor − 1 to round up: at most 16384·32752 + 32752² + 524032 < 2³¹.
        let below = row * 16 + 8 - top[1];
        let (x, remainder) = reciprocal.div_rem((top[0] - 8) * dy + below * dx + divisor - 1, divisor);
        let (slope, slope_remainder) = reciprocal.div_rem(16 * dx, divisor);
        *self = Self { x: x << FRACTION, slope: slope << FRACTION, remainder, slope_remainder, divisor };
    }

    /// Completes a short edge, whose `x` holds the column of the upper end plus ½. From the upper end it is `dx` to the right and
    /// `dy` down to the lower end, and `below` down to the centres of the first row. All are in 1/16 px, `dx` within ±512 and
    /// `dy` 1 … 511.
    ///
    /// Why 20 bits are enough: let X be the column of the edge plus ½. The number is ceil(X − 1). X is a multiple of 1/16dy,
    /// which is more than 2⁻¹³. So the number is floor(X − δ) with any δ above 0 and up to 2⁻¹³. δ = 2⁻¹⁴ is the middle: it
    /// may be wrong by up to 2⁻¹⁴ either way. The reciprocal's relative error of 2⁻²⁰ moves x by at most |dx|·2⁻²⁴ ≤ 2⁻¹⁵.
    /// The slope's rounding moves it by 2⁻²¹ in every row, by 2⁻¹⁶ in 32 rows. What is left, 2⁻¹⁶, is more than the last bits
    /// of the line with `below`.
    #[inline(always)]
    fn short(&mut self, dx: i32, dy: i32, below: i32) {
        let slope = quotient_of_10_bits(dx, dy);
        self.x += ((below * slope) >> 4) - ((1 << (FRACTION - 14)) + 1);
        self.slope = slope;
    }

    /// How many centres lie left of the edge in this row; steps `x` to the next row. After the last row `x` may leave the
    /// range of columns, so it wraps.
    #[inline]
    fn next(&mut self) -> i32 {
        let x = self.x >> FRACTION;
        self.x = self.x.wrapping_add(self.slope);
        x
    }

    /// Long edges, after [`Edge::next`]: steps the remainder and carries into `x`.
    fn carry(&mut self) {
        self.remainder += self.slope_remainder;
        if self.remainder >= self.divisor {
            self.remainder -= self.divisor;
            self.x = self.x.wrapping_add(1 << FRACTION);
        }
    }
}

/// A triangle's rows within a window. One `Rows` serves all triangles of a draw, one after another.
#[derive(Clone, Debug, Default)]
pub(crate) struct Rows {
    left: Edge,
    right: Edge,
    /// The next row.
    row: i32,
    /// The row of the middle corner, at most `end`. There `lower` takes the place of the edge that ends.
    knee: i32,
    /// The end of the rows (exclusive).
    end: i32,
    /// The edge that begins at the knee.
    lower: Edge,
    lower_is_right: bool,
    /// Whether the edges are long: the triangle is more than 32 pixels wide, or 32 or more high.
    is_long: bool,
    /// Whether a corner lies left or right of the window.
    crosses_sides: bool,
}

impl Rows {
    /// Starts a triangle, whose corners run clockwise.
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

    /// Starts a triangle at its uppermost corner `top`. From there a right edge leads down to `next` and a left one to `last`.
    ///
    /// Not inlined: on a Cortex-M0+ to pass three pointers costs less than to choose between corners again and again.
    #[inline(never)]
    fn start_at(&mut self, top: &[i32; 2], next: &[i32; 2], last: &[i32; 2], window: &Window) {
        let (next_row, last_row) = (first_center(next[1]), first_center(last[1]));
        let Range { start, end } = window.columns;
        self.row = first_center(top[1]).max(window.rows.start);
        self.end = next_row.max(last_row).min(window.rows.end);
        // Negative if x is not.
        let inside = |x: i32| (x - start * 16) | (end * 16 - x);
        self.crosses_sides = inside(top[0]) | inside(next[0]) | inside(last[0]) < 0;
        // No rows if all columns lie beyond the same side.
        let xs = [top[0], next[0], last[0]];
        if self.crosses_sides
            && (xs.iter().all(|x| first_center(*x) >= end) || xs.iter().all(|x| first_center(*x) < start))
        {
            self.end = self.row;
        }
        if self.row >= self.end {
            return;
        }
        // A difference of −512 … 511 becomes 0 … 1023: no bit from 2¹⁰ on is set.
        let biased = |from: i32, to: i32| to - from + (1 << 9);
        self.is_long =
            (biased(top[0], next[0]) | biased(top[0], last[0]) | biased(next[0], last[0])) as u32 >> 10 != 0
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

    /// A quick test for small triangles, many of which cover no pixel of a band: whether there are no rows, or only one or
    /// two, and these empty. (False does not mean that a pixel is covered.)
    #[inline]
    pub(crate) fn are_none(&self) -> bool {
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

    /// Whether edges are short (at most 32 pixels wide, fewer than 32 high) and no corner lies left or right of the window.
    #[inline]
    pub(crate) fn are_simple(&self) -> bool {
        !self.is_long && !self.crosses_sides
    }

    /// The first row.
    #[inline]
    pub(crate) fn row(&self) -> i32 {
        self.row
    }

    /// A copy with the first row only.
    pub(crate) fn first(&self) -> Self {
        let end = self.end.min(self.row + 1);
        Self { end, knee: self.knee.min(end), ..self.clone() }
    }

    /// The span of the next row as start and end (exclusive), not clipped to the window; it may be empty. Long edges need
    /// [`Edge::carry`] after it.
    #[inline(always)]
    pub(crate) fn next(&mut self) -> Option<(i32, i32)> {
        if self.row >= self.knee && !self.reach_knee() {
            return None;
        }
        self.row += 1;
        Some((self.left.next(), self.right.next()))
    }

    /// Calls `emit` with every row of a triangle whose rows [`are_simple`](Rows::are_simple). All numbers are relative to the
    /// pixel [x, y]: how far below it the row lies, and how far right of it the span starts and ends (exclusive). A span may
    /// be empty.
    ///
    /// Works on copies of the edges on the stack: to reach them takes no register for `self`.
    #[inline(always)]
    pub(crate) fn each_simple(&mut self, [x, y]: [i32; 2], mut emit: impl FnMut(i32, i32, i32)) {
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

    /// Calls `emit` with every row that is not empty: the row, and its span's start and end (exclusive), clipped to the window.
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

    /// Lets the edge that begins at the knee take the place of the one that ends there. False at the end of the rows.
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

/// How many pixel centres of a row lie left of an edge, `top` above `bottom` (1/16 px) and the row between them.
#[cold]
pub(super) fn centers_left(top: &[i32; 2], bottom: &[i32; 2], row: i32) -> i32 {
    let mut edge = Edge::default();
    edge.long(top, bottom, row);
    edge.x >> FRACTION
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
                let (start, end) = (first_center(top[1]), first_center(bottom[1]));
                let mut edge = Edge::default();
                // A window may begin at any row: half of the edges start in the middle.
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
