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

use super::setup::{Oriented, TriangleSetup};
use crate::math::recip::{Reciprocal, corrected, short};
use crate::num::{I12F4, mul_17};
use crate::scene::Viewport;
use core::ops::Range;

/// Pixels of one row of a triangle, side by side and all visible; handed to a
/// [`Shader`](super::Shader).
#[derive(Clone, Copy, Debug)]
pub struct Span<'a> {
    pub(super) setup: &'a TriangleSetup,
    pub(super) x: i32,
    pub(super) y: i32,
}

const _: () = assert!(size_of::<Span<'_>>() == size_of::<usize>() + 8);

impl<'a> Span<'a> {
    pub(crate) fn new(setup: &'a TriangleSetup, x: i32, y: i32) -> Self {
        Self { setup, x, y }
    }

    /// Column of the first pixel.
    #[must_use]
    pub const fn x(&self) -> i32 {
        self.x
    }

    /// Row on the screen (not in the band).
    #[must_use]
    pub const fn y(&self) -> i32 {
        self.y
    }

    /// Whether the triangle's colours are greys, so that the first channel stands for all.
    pub(crate) const fn is_gray(&self) -> bool {
        self.setup.gray
    }

    pub(crate) const fn setup(&self) -> &'a TriangleSetup {
        self.setup
    }

    /// q = near/w with 31 fraction bits at the first pixel, and its step.
    pub(crate) fn depth(&self) -> (u32, i32) {
        self.setup.at(&self.setup.z, self.x, self.y)
    }
}

/// An edge from row to row.
#[derive(Debug)]
struct Edge {
    /// Pixel centres left of the edge.
    x: i32,
    /// By how much the edge lies right of where it would meet the centre before, 0 … `divisor` − 1.
    remainder: i32,
    slope: i32,
    slope_remainder: i32,
    /// 16·dy.
    divisor: i32,
}

impl Edge {
    /// Both ends in 1/16 px, `top` above `bottom`, and the first row wanted, which lies between.
    fn new(top: [i32; 2], bottom: [i32; 2], row: i32) -> Self {
        let (dx, dy) = (bottom[0] - top[0], bottom[1] - top[1]);
        if dy < 1 << 10 && dx.abs() < 1 << 10 {
            return Self::short([dx, dy], top, row);
        }
        let divisor = 16 * dy;
        let reciprocal = Reciprocal::precise(divisor as u32);
        // −E at centre 0, plus divisor − 1 to round up: below 16392·32752 + 32752² + 524032 < 2³¹.
        let below = row * 16 + 8 - top[1];
        let (x, remainder) = reciprocal.div_rem((top[0] - 8) * dy + below * dx + divisor - 1, divisor);
        let (slope, slope_remainder) = reciprocal.div_rem(16 * dx, divisor);
        Self { x, remainder, slope, slope_remainder, divisor }
    }

    /// An edge less than 64 pixels wide and high, likewise.
    #[inline]
    fn short([dx, dy]: [i32; 2], top: [i32; 2], row: i32) -> Self {
        let divisor = 16 * dy;
        let (mut mantissa, mut zeros) = ((dy as u32) << 22, 22);
        while (mantissa as i32) > 0 {
            (mantissa, zeros) = (mantissa << 1, zeros + 1);
        }
        // 1/dy = reciprocal · 2^(zeros − 48): off by 2⁻¹⁷, so quotients below 2¹⁷ by less than 1.
        let reciprocal = short(mantissa);
        let below = row * 16 + 8 - top[1];
        // Below 2²¹.
        let numerator = ((top[0] & 15) - 8) * dy + below * dx + divisor - 1;
        let x = mul_17(numerator << 8, reciprocal) >> (44 - zeros);
        let (x, remainder) = corrected(x, numerator, divisor);
        let (slope, slope_remainder) = corrected((dx * reciprocal as i32) >> (48 - zeros), 16 * dx, divisor);
        Self { x: (top[0] >> 4) + x, remainder, slope, slope_remainder, divisor }
    }

    fn next_row(&mut self) {
        self.x += self.slope;
        self.remainder += self.slope_remainder;
        if self.remainder >= self.divisor {
            self.remainder -= self.divisor;
            self.x += 1;
        }
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

    /// Whether a triangle's bounding box has a pixel centre in it.
    #[inline]
    pub(super) fn touches(&self, triangle: &Oriented<'_>) -> bool {
        let overlaps = |a: I12F4, b: I12F4, c: I12F4, range: &Range<i32>| {
            let (low, high) = (a.min(b).min(c).to_bits(), a.max(b).max(c).to_bits());
            first_row(low.into()) < range.end && first_row(high.into()) >= range.start
        };
        let [a, b, c] = triangle.vertices;
        overlaps(a.y, b.y, c.y, &self.rows) && overlaps(a.x, b.x, c.x, &self.columns)
    }
}

impl TriangleSetup {
    /// Hands on every row of the triangle within a window, as its row and its pixels.
    pub(crate) fn rows(&self, window: &Window, mut emit: impl FnMut(i32, Range<i32>)) {
        let [mut top, mut middle, mut bottom] = self.corners;
        if middle[1] < top[1] {
            (top, middle) = (middle, top);
        }
        if bottom[1] < middle[1] {
            (middle, bottom) = (bottom, middle);
            if middle[1] < top[1] {
                (top, middle) = (middle, top);
            }
        }
        let start = first_row(top[1]).max(window.rows.start);
        let end = first_row(bottom[1]).min(window.rows.end);
        if start >= end {
            return;
        }
        let knee = first_row(middle[1]).clamp(start, end);
        let long_is_left =
            (bottom[0] - top[0]) * (middle[1] - top[1]) - (bottom[1] - top[1]) * (middle[0] - top[0]) < 0;
        let mut long = Edge::new(top, bottom, start);
        let mut short =
            if start < knee { Edge::new(top, middle, start) } else { Edge::new(middle, bottom, start) };
        for y in start..end {
            if y == knee && y > start {
                short = Edge::new(middle, bottom, y);
            }
            let (left, right) = if long_is_left { (long.x, short.x) } else { (short.x, long.x) };
            let pixels = left.max(window.columns.start)..right.min(window.columns.end);
            if pixels.start < pixels.end {
                emit(y, pixels);
            }
            long.next_row();
            short.next_row();
        }
    }
}
