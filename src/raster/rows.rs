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
//! - For triangles within 32 pixels it is kept with 20 fraction bits: see [`spans`](super::spans).
//! - For any other as quotient and remainder, as Bresenham does.
//!
//! Both are exact.

use super::spans::{SmallEdges, Spans};
use crate::frame::{Window, first_center};
use crate::geometry::{ScreenVertex, position};
use crate::math::recip::Reciprocal;

/// An edge, in one row after another: how many pixel centres lie to its left, as quotient and remainder.
#[derive(Clone, Copy, Debug, Default)]
struct Edge {
    /// How many pixel centres lie left of the edge.
    x: i32,
    /// What `x` changes by from row to row.
    slope: i32,
    /// What the division that gave `x` leaves, 0 … `divisor` − 1. The edge lies (`remainder` + 1)/`divisor` pixels right of the
    /// last centre that is left of it.
    remainder: i32,
    /// What `remainder` changes by from row to row.
    slope_remainder: i32,
    /// 16·dy.
    divisor: i32,
}

impl Edge {
    /// Sets an edge from `top` down to `bottom`, at `row`, whose centres lie between them.
    #[inline(never)]
    fn set(&mut self, top: &ScreenVertex, bottom: &ScreenVertex, row: i32) {
        let [top, bottom] = [top, bottom].map(position);
        let (dx, dy) = (bottom[0] - top[0], bottom[1] - top[1]);
        let divisor = 16 * dy;
        let reciprocal = Reciprocal::precise(divisor as u32);
        // E at the centre in column 0, plus divisor − 1 to round up: at most 16384·32752 + 32752² + 524032 < 2³¹.
        let below = row * 16 + 8 - top[1];
        let (x, remainder) = reciprocal.div_rem((top[0] - 8) * dy + below * dx + divisor - 1, divisor);
        let (slope, slope_remainder) = reciprocal.div_rem(16 * dx, divisor);
        *self = Self { x, slope, remainder, slope_remainder, divisor };
    }

    /// How many centres lie left of the edge in this row; goes on to the next one. After the last row `x` may leave the range of
    /// columns.
    #[inline]
    fn next(&mut self) -> i32 {
        let x = self.x;
        self.x += self.slope;
        self.remainder += self.slope_remainder;
        if self.remainder >= self.divisor {
            self.remainder -= self.divisor;
            self.x += 1;
        }
        x
    }
}

/// The rows of a triangle in a window. One serves all triangles of a draw, one after another.
#[derive(Clone, Debug)]
pub(crate) enum Rows {
    /// Of a small triangle.
    Short(Spans),
    /// Of any other.
    Long(LongRows),
}

/// What became of a triangle that may be small.
pub(super) enum Small {
    /// It is, and its rows are found.
    Rows,
    /// It has no pixels in the window.
    Hidden,
    /// It is not small.
    Not,
}

/// The rows of a triangle of any size. The side comes last, so that spans begin where this does.
#[derive(Clone, Debug, Default)]
#[repr(C)]
pub(crate) struct LongRows {
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
    lower_side: Side,
}

/// A side of a row. (No number is 0, which marks [`Rows::Short`] then: that is all zeros without a triangle.)
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(u8)]
enum Side {
    #[default]
    Left = 1,
    Right = 2,
}

const _: () = assert!(size_of::<Rows>() <= 76);

impl Rows {
    /// Of no triangle.
    pub(crate) const NONE: Self = Self::Short(Spans::NONE);

    /// Starts a triangle if it is small, from its uppermost corner on, and finds its rows below the window, too, if it has to.
    #[inline(never)]
    pub(super) fn start_small(
        &mut self,
        vertices: &[&ScreenVertex; 3],
        window: &Window,
        and_below: bool,
    ) -> Small {
        let at = vertices.map(position);
        let Some(edges) = SmallEdges::of(at) else {
            return Small::Not;
        };
        let Some(spans) = self.short() else {
            return Small::Not;
        };
        if spans.start(&edges, window, and_below) { Small::Rows } else { Small::Hidden }
    }

    /// Starts a triangle of any size, whose corners run clockwise from the uppermost on. False if it has no rows, or only one, and that is empty. (True
    /// does not mean that a pixel is covered.)
    #[inline(never)]
    pub(super) fn start_long(&mut self, corners: &[&ScreenVertex; 3], window: &Window) -> bool {
        if let Self::Short(_) = self {
            *self = Self::Long(LongRows::default());
        }
        match self {
            Self::Long(rows) => rows.start(corners, window),
            Self::Short(_) => false,
        }
    }

    /// Whether those of a small triangle are known to end in the window.
    #[inline]
    pub(crate) fn end_in_window(&self) -> bool {
        matches!(self, Self::Short(spans) if spans.end_in_window())
    }

    /// Of a small triangle the row and the column of its table, its end in the table, and the rows of it that lie below the window; of
    /// any other zeros.
    #[inline]
    pub(super) fn below(&self) -> ([i16; 2], u8, &[u32]) {
        match self {
            Self::Short(spans) => ([spans.row, spans.column], spans.last, spans.below()),
            Self::Long(_) => ([0; 2], 0, &[]),
        }
    }

    /// Goes on with these in the window below. Returns where they belong.
    #[inline]
    pub(super) fn go_on(&mut self, row_and_column: [i16; 2], last: u8, window: &Window) -> &mut [u32] {
        match self.short() {
            Some(spans) => spans.go_on(row_and_column, last, window),
            None => &mut [],
        }
    }

    /// As those of a small triangle.
    #[inline(always)]
    fn short(&mut self) -> Option<&mut Spans> {
        if let Self::Long(_) = self {
            *self = Self::NONE;
        }
        match self {
            Self::Short(spans) => Some(spans),
            Self::Long(_) => None,
        }
    }

    /// Calls `emit` with every row that is not empty: the row, and its span's start and end (exclusive), clipped to the window.
    #[inline]
    pub(crate) fn each(&mut self, window: &Window, mut emit: impl FnMut(i32, i32, i32)) {
        while let Some((row, left, right)) = self.next(window) {
            if left < right {
                emit(row, left, right);
            }
        }
    }

    /// The next row, and its span's start and end (exclusive), clipped to the window. The span may be empty.
    #[inline(always)]
    pub(crate) fn next(&mut self, window: &Window) -> Option<(i32, i32, i32)> {
        match self {
            Self::Short(spans) => spans.next(),
            Self::Long(rows) => rows.next(window),
        }
    }
}

impl LongRows {
    /// As [`Rows::start_long`]. From the uppermost corner a right edge leads down to `next` and a left one to `last`.
    #[inline(never)]
    fn start(&mut self, &[top, next, last]: &[&ScreenVertex; 3], window: &Window) -> bool {
        let row_of = |vertex: &ScreenVertex| first_center(vertex.y.to_bits().into());
        let (next_row, last_row) = (row_of(next), row_of(last));
        let (row, mut end) =
            (row_of(top).max(window.rows.start), next_row.max(last_row).min(window.rows.end));
        // No rows if all columns lie beyond the same side.
        let columns = [top, next, last].map(|corner| first_center(corner.x.to_bits().into()));
        let window = &window.columns;
        if columns.iter().all(|&column| column >= window.end)
            || columns.iter().all(|&column| column < window.start)
        {
            end = row;
        }
        (self.row, self.end) = (row, end);
        if row >= end {
            return false;
        }
        if next_row > row {
            self.right.set(top, next, row);
        }
        if last_row > row {
            self.left.set(top, last, row);
        }
        self.lower_side = if next_row < last_row { Side::Right } else { Side::Left };
        self.knee = next_row.min(last_row).min(end);
        if self.knee < end {
            let (from, to) = if self.lower_side == Side::Right { (next, last) } else { (last, next) };
            self.lower.set(from, to, self.knee.max(row));
        }
        !self.are_none()
    }

    /// A quick test for triangles that cover no pixel of a band: whether there is only one row, and that is empty.
    fn are_none(&self) -> bool {
        let end = self.end;
        self.row + 1 == end && end <= self.knee && self.left.x >= self.right.x
    }

    /// The next row, and its span's start and end (exclusive), clipped to the window. The span may be empty.
    #[inline(always)]
    fn next(&mut self, window: &Window) -> Option<(i32, i32, i32)> {
        if self.row >= self.knee && !self.reach_knee() {
            return None;
        }
        let (left, right) = (self.left.next(), self.right.next());
        let row = self.row;
        self.row += 1;
        Some((row, left.max(window.columns.start), right.min(window.columns.end)))
    }

    /// Lets the edge that begins at the knee take the place of the one that ends there. False at the end of the rows.
    #[inline(never)]
    fn reach_knee(&mut self) -> bool {
        let end = self.end;
        if self.row >= end {
            return false;
        }
        let edge = if self.lower_side == Side::Right { &mut self.right } else { &mut self.left };
        *edge = self.lower;
        self.knee = end;
        true
    }
}

/// How many pixel centres of a row lie left of an edge, `top` above `bottom` and the row between them.
#[cold]
pub(super) fn centers_left(top: &ScreenVertex, bottom: &ScreenVertex, row: i32) -> i32 {
    let mut edge = Edge::default();
    edge.set(top, bottom, row);
    edge.x
}
