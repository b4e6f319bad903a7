//! The error of a display list that is full: which capacity has no room, and what was needed.

use core::fmt;

/// A display list is full; it is as it was before the draw that did not fit. [`memory`](crate::guide::memory) has how to find the
/// numbers that a scene needs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CapacityError {
    /// Of vertices, `V`: of those that stay, and all of the mesh that is drawn.
    Vertices {
        /// How many there can be.
        capacity: usize,
        /// How many there would be with this draw: exactly, or, where not even the mesh's own vertices fit, without
        /// those that clipping or flat shading adds.
        needed: usize,
    },
    /// Of triangles, `T`.
    Triangles {
        /// How many there can be.
        capacity: usize,
        /// How many there would be with this draw.
        needed: usize,
    },
    /// Of draws, `N`.
    Draws {
        /// How many there can be.
        capacity: usize,
        /// How many there would be with this one.
        needed: usize,
    },
}

impl fmt::Display for CapacityError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (capacity, needed, what) = match self {
            Self::Vertices { capacity, needed } => (capacity, needed, "vertices"),
            Self::Triangles { capacity, needed } => (capacity, needed, "triangles"),
            Self::Draws { capacity, needed } => (capacity, needed, "draws"),
        };
        write!(f, "the display list has room for {capacity} {what}, and {needed} are needed")
    }
}

impl core::error::Error for CapacityError {}
