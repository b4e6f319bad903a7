//! Prepared: a triangle's rows and planes, the one for small triangles and the one for any.
//!
//! - In: a triangle on the screen, a window, and what the shader wants of it.
//! - Out: its rows, and its planes.
//! - Assumes: the corners lie in the guard band.

use super::rows::Rows;
use super::spans::SmallEdges;
use super::triangle::{Needs, TriangleSetup};
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
        if a.y <= b.y && a.y <= c.y {
            self.set_from(a, b, c, triangle.area, window, needs)
        } else if b.y <= c.y {
            self.set_from(b, c, a, triangle.area, window, needs)
        } else {
            self.set_from(c, a, b, triangle.area, window, needs)
        }
    }

    /// From the uppermost vertex on.
    #[inline(never)]
    fn set_from(
        &mut self,
        a: &ScreenVertex,
        b: &ScreenVertex,
        c: &ScreenVertex,
        area: u32,
        window: &Window,
        needs: &Needs,
    ) -> bool {
        let vertices = [a, b, c];
        let (Some(edges), Some(spans)) = (SmallEdges::of(vertices), self.rows.short()) else {
            return self.set_large(&Oriented { vertices, area }, window, needs);
        };
        if !spans.start(&edges, window) {
            return false;
        }
        if !self.setup.set_small(&vertices, &edges, area, needs) {
            self.set_any(&Oriented { vertices, area }, needs);
        }
        true
    }

    /// A triangle that is not small.
    #[cold]
    #[inline(never)]
    fn set_large(&mut self, triangle: &Oriented<'_>, window: &Window, needs: &Needs) -> bool {
        let is_seen = self.rows.start_long(&triangle.vertices.map(position), window);
        if is_seen {
            self.set_any(triangle, needs);
        }
        is_seen
    }

    #[inline(never)]
    fn set_any(&mut self, triangle: &Oriented<'_>, needs: &Needs) {
        self.setup.set(&triangle.nearest_first(), needs);
    }
}
