//! What the rasterizer passes to shading: a span, pixels of one row of a triangle side by side.
//!
//! - In: a triangle that is set up, and the span's first pixel.
//! - Out: near/w along the span; shading takes attributes from the set-up itself.
//! - Assumes: the pixels lie in the triangle. How many they are, the memory that goes with the span says.

use super::triangle::TriangleSetup;

/// Pixels of one row of a triangle, side by side, from the pixel (x, y) on.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Span<'a> {
    pub(crate) setup: &'a TriangleSetup,
    pub(crate) x: i32,
    pub(crate) y: i32,
}

const _: () = assert!(size_of::<Span<'_>>() == size_of::<usize>() + 8);

impl<'a> Span<'a> {
    pub(crate) fn new(setup: &'a TriangleSetup, x: i32, y: i32) -> Self {
        Self { setup, x, y }
    }

    /// The same without the first `pixels`.
    pub(crate) const fn ahead(&self, pixels: usize) -> Self {
        Self { setup: self.setup, x: self.x + pixels as i32, y: self.y }
    }
}
