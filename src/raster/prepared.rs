//! Prepared: a triangle's rows and planes, the one for small triangles and the one for any.
//!
//! - In: a triangle on the screen, a window, and what the shader wants of it.
//! - Out: its rows, and its planes.
//! - Assumes: the corners lie in the guard band.

use super::needs::Needs;
use super::rows::Rows;
use super::spans::SmallEdges;
use super::triangle::TriangleSetup;
use crate::frame::Window;
use crate::geometry::{Oriented, ScreenVertex, position};

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
    #[inline]
    pub(crate) fn set(&mut self, triangle: &Oriented<'_>, window: &Window, needs: &Needs) -> bool {
        let [a, b, c] = triangle.vertices;
        let small = if a.y <= b.y && a.y <= c.y {
            self.set_small([a, b, c], triangle.area, window, needs)
        } else if b.y <= c.y {
            self.set_small([b, c, a], triangle.area, window, needs)
        } else {
            self.set_small([c, a, b], triangle.area, window, needs)
        };
        match small {
            Small::Set => true,
            Small::Hidden => false,
            // From here, so that what a small triangle takes is not on the stack.
            other => self.set_any(triangle, window, needs, matches!(other, Small::Not)),
        }
    }

    /// Prepares a small triangle, from its uppermost vertex on.
    #[inline(never)]
    fn set_small(
        &mut self,
        vertices: [&ScreenVertex; 3],
        area: u32,
        window: &Window,
        needs: &Needs,
    ) -> Small {
        let (Some(edges), Some(spans)) = (SmallEdges::of(vertices), self.rows.short()) else {
            return Small::Not;
        };
        if !spans.start(&edges, window) {
            Small::Hidden
        } else if (needs.code.small)(&mut self.setup, &vertices, &edges, area, needs) {
            Small::Set
        } else {
            Small::Rows
        }
    }

    /// Prepares a triangle that is not small, or whose rows alone are.
    #[cold]
    #[inline(never)]
    fn set_any(&mut self, triangle: &Oriented<'_>, window: &Window, needs: &Needs, is_large: bool) -> bool {
        if is_large && !self.rows.start_long(&triangle.vertices.map(position), window) {
            return false;
        }
        (needs.code.any)(&mut self.setup, &triangle.nearest_first(), needs);
        true
    }
}

/// What the set-up for small triangles made of one.
enum Small {
    /// It is set up.
    Set,
    /// It has no pixels in the window.
    Hidden,
    /// Its rows are; its planes have to be set by the general way.
    Rows,
    /// It is not small.
    Not,
}
