//! An extent: a rectangle of pixels in 8 bytes, which holds all that the triangles of a band touch.

use crate::frame::Window;
use embedded_graphics::geometry::{Point, Size};
use embedded_graphics::primitives::Rectangle;

/// A rectangle of pixels, from `left` to `right` and from `top` to `bottom`, ends exclusive. It is empty unless each end lies
/// after its start.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Extent {
    pub(super) left: i16,
    pub(super) right: i16,
    pub(super) top: i16,
    pub(super) bottom: i16,
}

const _: () = assert!(size_of::<Extent>() == 8);

impl Extent {
    /// No pixel.
    pub(crate) const NONE: Self = Self { left: i16::MAX, right: 0, top: i16::MAX, bottom: 0 };
    /// All pixels that there may be.
    pub(super) const ALL: Self = Self { left: 0, right: i16::MAX, top: 0, bottom: i16::MAX };

    /// From [start, end] of columns and [start, end] of rows, ends exclusive. All of them fit an `i16`.
    pub(crate) fn new(bounds: [[i32; 2]; 2]) -> Self {
        let [[left, right], [top, bottom]] = bounds.map(|ends| ends.map(|end| end as i16));
        Self { left, right, top, bottom }
    }

    pub(super) fn is_empty(&self) -> bool {
        self.left >= self.right || self.top >= self.bottom
    }

    /// The least extent that holds both.
    pub(crate) fn union(self, other: Self) -> Self {
        if self.is_empty() {
            return other;
        }
        if other.is_empty() {
            return self;
        }
        Self {
            left: self.left.min(other.left),
            right: self.right.max(other.right),
            top: self.top.min(other.top),
            bottom: self.bottom.max(other.bottom),
        }
    }

    /// The part of it that lies in a window.
    pub(crate) fn within(self, window: &Window) -> Self {
        Self {
            left: self.left.max(window.columns.start as i16),
            right: self.right.min(window.columns.end as i16),
            top: self.top.max(window.rows.start as i16),
            bottom: self.bottom.min(window.rows.end as i16),
        }
    }

    pub(super) fn rectangle(&self) -> Rectangle {
        let side = |start: i16, end: i16| (end - start).max(0) as u32;
        Rectangle::new(
            Point::new(self.left.into(), self.top.into()),
            Size::new(side(self.left, self.right), side(self.top, self.bottom)),
        )
    }
}
