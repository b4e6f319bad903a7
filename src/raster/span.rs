//! The arrow out of raster: pixels of one row of a triangle, side by side.

use super::triangle::TriangleSetup;

/// Pixels of one row of a triangle, side by side and all visible.
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

    /// Without its first pixels.
    pub(crate) const fn ahead(&self, pixels: usize) -> Self {
        Self { setup: self.setup, x: self.x + pixels as i32, y: self.y }
    }

    /// q = near/w with 31 fraction bits at the first pixel, and its step.
    pub(crate) fn depth(&self) -> (u32, i32) {
        self.setup.at(&self.setup.z, self.x, self.y)
    }
}
