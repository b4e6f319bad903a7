//! The memory of a display list: plain data, which outlives the frames that are recorded in it.

use super::entries::{ListTriangle, ListVertex, MOST_SLOTS};
use crate::geometry::MOST_CORNERS;
use crate::scene::Mesh;
use core::fmt;
use heapless::Vec;

/// Memory for a [`DisplayList`](super::DisplayList) of at most `V` vertices and `T` triangles, of up to 65535 each.
///
/// It borrows nothing, so it can stand in a `static`, from where `static_cell::ConstStaticCell` or the like hands it out.
/// A vertex takes 16 bytes and a triangle 10.
///
/// ```
/// use fixel::ListMemory;
/// static MEMORY: ListMemory<546, 429> = ListMemory::new();
/// assert_eq!(size_of_val(&MEMORY), ListMemory::<546, 429>::BYTES);
/// ```
pub struct ListMemory<const V: usize, const T: usize> {
    pub(super) vertices: Vec<ListVertex, V>,
    pub(super) triangles: Vec<ListTriangle, T>,
    pub(super) index: Vec<u16, T>,
}

impl<const V: usize, const T: usize> ListMemory<V, T> {
    /// How many bytes it takes.
    pub const BYTES: usize = size_of::<Self>();

    /// Memory that holds nothing. Nothing but its lengths is written.
    #[must_use]
    pub const fn new() -> Self {
        const { assert!(V <= MOST_SLOTS && T <= MOST_SLOTS, "a list has at most 65535 vertices and triangles") };
        Self { vertices: Vec::new(), triangles: Vec::new(), index: Vec::new() }
    }
}

impl Mesh<'_> {
    /// The most vertices and triangles that a draw of this mesh takes in a [`DisplayList`](super::DisplayList), from whatever
    /// side, with any surface: all of its vertices, and of each triangle, as if all planes cut it, 18 corners and 7 pieces.
    ///
    /// Far more than a mesh takes that is not cut by a plane nor lit by its faces: there it is what the mesh has.
    #[must_use]
    pub const fn most_in_list(&self) -> [usize; 2] {
        let triangles = self.triangle_count();
        // With colour and texture a corner that is cut takes two vertices.
        let corners = triangles.saturating_mul(2 * MOST_CORNERS);
        [self.vertices().len().saturating_add(corners), triangles.saturating_mul(MOST_CORNERS - 2)]
    }
}

impl<const V: usize, const T: usize> Default for ListMemory<V, T> {
    fn default() -> Self {
        Self::new()
    }
}

impl<const V: usize, const T: usize> fmt::Debug for ListMemory<V, T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("ListMemory").field("vertices", &V).field("triangles", &T).finish()
    }
}
