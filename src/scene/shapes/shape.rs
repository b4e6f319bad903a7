//! What a shape is: vertices and triangles, as many as its type says.

use crate::scene::{Mesh, Vertex};

/// `V` vertices and `T` triangles.
#[derive(Clone, Debug)]
pub struct Shape<const V: usize, const T: usize> {
    pub(super) vertices: [Vertex; V],
    pub(super) triangles: [[u16; 3]; T],
}

impl<const V: usize, const T: usize> Shape<V, T> {
    /// The mesh, for a `const`; at run time this checks all indices again.
    #[must_use]
    pub const fn mesh(&self) -> Mesh<'_> {
        Mesh::new(&self.vertices, &self.triangles)
    }

    /// The same in one colour.
    #[must_use]
    pub const fn color(mut self, red: u8, green: u8, blue: u8) -> Self {
        let mut i = 0;
        while i < V {
            self.vertices[i].color = [red, green, blue];
            i += 1;
        }
        self
    }
}

/// How many vertices and triangles a [`Shape`] has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Counts {
    /// V.
    pub vertices: usize,
    /// T.
    pub triangles: usize,
}

impl Counts {
    /// Of [`grid`](super::grid).
    #[must_use]
    pub const fn grid(columns: usize, rows: usize) -> Self {
        Self { vertices: (columns + 1) * (rows + 1), triangles: 2 * columns * rows }
    }

    /// Of [`uv_sphere`](super::uv_sphere).
    #[must_use]
    pub const fn uv_sphere(segments: usize, rings: usize) -> Self {
        Self {
            vertices: (segments + 1) * rings.saturating_sub(1) + 2 * segments,
            triangles: 2 * segments * rings.saturating_sub(1),
        }
    }

    /// Of [`icosphere`](super::icosphere()).
    #[must_use]
    pub const fn icosphere(frequency: usize) -> Self {
        Self { vertices: 10 * frequency * frequency + 2, triangles: 20 * frequency * frequency }
    }

    /// Of [`torus`](super::torus).
    #[must_use]
    pub const fn torus(rings: usize, sides: usize) -> Self {
        Self { vertices: rings * sides, triangles: 2 * rings * sides }
    }

    /// Of [`torus_textured`](super::torus_textured).
    #[must_use]
    pub const fn torus_textured(rings: usize, sides: usize) -> Self {
        Self::grid(rings, sides)
    }

    /// Of [`cylinder`](super::cylinder).
    #[must_use]
    pub const fn cylinder(sides: usize) -> Self {
        Self { vertices: 4 * sides + 2, triangles: (4 * sides).saturating_sub(4) }
    }
}
