//! The error of a display list that is full: which capacity has no room.

use core::fmt;

/// A display list is full; it is as it was before the draw that did not fit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CapacityError {
    /// Of vertices, `V`: of those that stay, and all of the mesh that is drawn.
    Vertices {
        /// How many there can be.
        capacity: usize,
    },
    /// Of triangles, `T`.
    Triangles {
        /// How many there can be.
        capacity: usize,
    },
    /// Of draws, `D`.
    Draws {
        /// How many there can be.
        capacity: usize,
    },
}

impl fmt::Display for CapacityError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (capacity, what) = match self {
            Self::Vertices { capacity } => (capacity, "vertices"),
            Self::Triangles { capacity } => (capacity, "triangles"),
            Self::Draws { capacity } => (capacity, "draws"),
        };
        write!(f, "the display list has no room for more than {capacity} {what}")
    }
}

impl core::error::Error for CapacityError {}

/// Which capacity is full.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Full {
    Vertices,
    Triangles,
}
