//! Preparation: a triangle's rows and planes, in the way of small triangles or in that of any.
//!
//! - In: a triangle on the screen, a window, and what the shader wants of it.
//! - Out: its rows, and its planes.
//! - Assumes: the corners lie in the guard band.

use super::needs::Needs;
use super::rows::{Rows, Small};
use super::triangle::TriangleSetup;
use crate::frame::Window;
use crate::geometry::{Oriented, ScreenVertex};
use core::hint::black_box;

impl TriangleSetup {
    /// Prepares a triangle: its rows, and its planes. One of each serves all triangles of a draw, one after another.
    /// False if it has no pixels in the window. (True does not mean that it has.)
    ///
    /// What this calls is called from here, one after another, and not from each other: so that what finds the rows is not on the
    /// stack any more where planes are set.
    #[inline]
    pub(crate) fn prepare(
        &mut self,
        rows: &mut Rows,
        triangle: &Oriented<'_>,
        window: &Window,
        needs: &Needs,
    ) -> bool {
        let from_top = from_top(triangle.vertices);
        match rows.start_small(&from_top, window, needs.rows_below) {
            Small::Hidden => return false,
            Small::Rows => {
                self.set_first_corner(from_top[0]);
                if (needs.code.small)(self, &from_top, triangle.area, needs) {
                    return true;
                }
            }
            Small::Not if !rows.start_long(&from_top, window) => return false,
            Small::Not => {}
        }
        (needs.code.any)(self, &from_top, triangle.area, needs);
        true
    }
}

impl Rows {
    /// Starts a triangle that is not small, and clockwise. False if it has no pixels in the window. (True does not mean that it has.)
    #[inline]
    pub(crate) fn start_any(&mut self, vertices: [&ScreenVertex; 3], window: &Window) -> bool {
        self.start_long(&from_top(vertices), window)
    }
}

/// The same from the uppermost on.
#[inline(always)]
pub(super) fn from_top([a, b, c]: [&ScreenVertex; 3]) -> [&ScreenVertex; 3] {
    // Hidden: as selects instead of branches it takes 25 cycles more on a Cortex-M4.
    if a.y <= b.y {
        if a.y <= c.y {
            return black_box([a, b, c]);
        }
    } else if b.y <= c.y {
        return black_box([b, c, a]);
    }
    black_box([c, a, b])
}
