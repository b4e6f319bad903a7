//! Prepared: a triangle's rows and planes, the one for small triangles and the one for any.
//!
//! - In: a triangle on the screen, a window, and what the shader wants of it.
//! - Out: its rows, and its planes.
//! - Assumes: the corners lie in the guard band.

use super::needs::Needs;
use super::rows::{Rows, Small};
use super::triangle::TriangleSetup;
use crate::frame::Window;
use crate::geometry::Oriented;
use core::hint::black_box;

/// Rows and planes. One serves all triangles of a draw, one after another.
pub(crate) struct Prepared {
    pub(crate) setup: TriangleSetup,
    pub(crate) rows: Rows,
}

impl Prepared {
    /// Of no triangle.
    pub(crate) fn new() -> Self {
        Self { setup: TriangleSetup::new(), rows: Rows::NONE }
    }

    /// Prepares a triangle. False if it has no pixels in the window. (True does not mean that it has.)
    ///
    /// What this calls is called from here, one after another, and not from each other: so that what finds the rows is not on the
    /// stack any more where planes are set.
    #[inline]
    pub(crate) fn set(&mut self, triangle: &Oriented<'_>, window: &Window, needs: &Needs) -> bool {
        let [a, b, c] = triangle.vertices;
        // Hidden: as selects instead of branches it takes 25 cycles more on a Cortex-M4.
        let from_top = if a.y <= b.y && a.y <= c.y {
            black_box([a, b, c])
        } else if b.y <= c.y {
            black_box([b, c, a])
        } else {
            black_box([c, a, b])
        };
        match self.rows.start_small(&from_top, window) {
            Small::Hidden => false,
            Small::Rows if (needs.code.small)(&mut self.setup, &from_top, triangle.area, needs) => true,
            other => self.set_any(triangle, window, needs, matches!(other, Small::Not)),
        }
    }

    /// Prepares a triangle that is not small, or whose rows alone are.
    #[cold]
    #[inline(never)]
    fn set_any(&mut self, triangle: &Oriented<'_>, window: &Window, needs: &Needs, is_large: bool) -> bool {
        if is_large && !self.rows.start_long(&triangle.vertices, window) {
            return false;
        }
        (needs.code.any)(&mut self.setup, &triangle.nearest_first(), needs);
        true
    }
}
