//! A window: the columns and rows that are drawn to; and which pixel centres lie between two positions.
//!
//! - In: positions in 1/16 px, viewports.
//! - Out: columns and rows of pixels, as start and end (exclusive).
//! - Assumes: pixel centres are at +½, as everywhere.

use crate::scene::Viewport;
use core::ops::Range;

/// The first pixel, along an axis, whose centre lies at or after a position (1/16 px).
pub(crate) const fn first_center(at: i32) -> i32 {
    (at + 7) >> 4
}

/// The columns, or rows, of an area that lie in a range. (`Rectangle::intersection` overflows on areas at the ends of the range of
/// coordinates.)
#[inline]
pub(super) fn overlap(start: i32, length: u32, range: Range<i32>) -> Option<Range<i32>> {
    let end = (i64::from(start) + i64::from(length)).min(i64::from(range.end)) as i32;
    let start = start.max(range.start);
    (start < end).then_some(start..end)
}

/// The part of the screen that is drawn to.
#[derive(Clone, Debug)]
pub(crate) struct Window {
    pub(crate) columns: Range<i32>,
    pub(crate) rows: Range<i32>,
}

impl Window {
    /// The window of the largest target.
    pub(crate) const LARGEST: Self = Self { columns: 0..1023, rows: 0..1023 };

    /// The pixels, along an axis, whose centres lie between the least and the greatest of three positions (1/16 px), as
    /// [start, end], end exclusive. A centre at the least is one of them, a centre at the greatest is not.
    pub(crate) fn centers(a: i32, b: i32, c: i32) -> [i32; 2] {
        [first_center(a.min(b).min(c)), first_center(a.max(b).max(c))]
    }

    /// The part of it that lies in a viewport.
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
