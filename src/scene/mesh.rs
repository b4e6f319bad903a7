//! Meshes: vertices and triangles in flash.

use super::vertex::{Vertex, is_gray as is_color_gray};
use crate::num::I4F12;
use core::fmt;

/// Borrowed vertices and the triangles between them, checked when made.
///
/// The front of a triangle is the side from which its vertices run counter-clockwise.
///
/// ```
/// use fixel::{Mesh, Vertex};
/// const TRIANGLE: Mesh = Mesh::new(
///     &[Vertex::new(-1.0, -1.0, 0.0), Vertex::new(1.0, -1.0, 0.0), Vertex::new(0.0, 1.0, 0.0)],
///     &[[0, 1, 2]],
/// );
/// assert_eq!(TRIANGLE.triangles().len(), 1);
/// ```
///
/// A bad index does not compile:
///
/// ```compile_fail
/// # use fixel::{Mesh, Vertex};
/// const BAD: Mesh = Mesh::new(&[Vertex::new(0.0, 0.0, 0.0)], &[[0, 0, 1]]);
/// # let _ = BAD;
/// ```
///
/// One of 65 536 vertices and 65 535 triangles takes the compiler a few seconds. A constant may take two million calls and turns
/// of loops (`long_running_const_eval`), of which this takes 8 a vertex and 2 a triangle, and a vertex from literals 20.
#[derive(Clone, Copy, Debug)]
pub struct Mesh<'a> {
    vertices: &'a [Vertex],
    triangles: Triangles<'a>,
    bounds: Bounds,
}

/// Three indices into the vertices for each triangle, from the first on.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Triangles<'a> {
    U8(&'a [[u8; 3]]),
    U16(&'a [[u16; 3]]),
}

impl Triangles<'_> {
    const fn len(&self) -> usize {
        match self {
            Self::U8(triangles) => triangles.len(),
            Self::U16(triangles) => triangles.len(),
        }
    }

    /// The triangle `i`, which is there.
    const fn at(&self, i: usize) -> [u16; 3] {
        match self {
            Self::U8(triangles) => [triangles[i][0] as u16, triangles[i][1] as u16, triangles[i][2] as u16],
            Self::U16(triangles) => triangles[i],
        }
    }

    /// The first triangle that names a vertex that is not there, if there are so many `vertices`.
    ///
    /// A call and a turn of the loop a triangle: after two million the compiler says that a constant takes too long.
    const fn first_bad(&self, vertices: usize) -> Option<MeshError> {
        let count = self.len();
        let mut triangle = 0;
        while triangle < count {
            let [a, b, c] = self.at(triangle);
            let index = if a as usize >= vertices {
                a
            } else if b as usize >= vertices {
                b
            } else {
                c
            };
            if index as usize >= vertices {
                return Some(MeshError { triangle, index });
            }
            triangle += 1;
        }
        None
    }
}

impl Iterator for Triangles<'_> {
    type Item = [u16; 3];

    #[inline]
    fn next(&mut self) -> Option<[u16; 3]> {
        match self {
            Self::U8(triangles) => {
                let (first, left) = triangles.split_first()?;
                *triangles = left;
                Some(first.map(u16::from))
            }
            Self::U16(triangles) => {
                let (first, left) = triangles.split_first()?;
                *triangles = left;
                Some(*first)
            }
        }
    }

    #[inline]
    fn size_hint(&self) -> (usize, Option<usize>) {
        let len = Self::len(self);
        (len, Some(len))
    }
}

impl ExactSizeIterator for Triangles<'_> {}

/// A sphere around all vertices, and what is known of their colours.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Bounds {
    pub(crate) center: [I4F12; 3],
    /// Whether all vertices are grey.
    pub(crate) is_gray: bool,
    /// I20F12 bits, at most √3·8.
    pub(crate) radius: i32,
}

impl<'a> Mesh<'a> {
    /// A mesh in a `const`: a bad index is a compile error.
    ///
    /// # Panics
    ///
    /// Outside a `const`, on a triangle that names a vertex that is not there. See [`Mesh::try_new`].
    #[must_use]
    pub const fn new(vertices: &'a [Vertex], triangles: &'a [[u16; 3]]) -> Self {
        checked(Self::try_from(vertices, Triangles::U16(triangles)))
    }

    /// As [`Mesh::new`], for at most 256 vertices with indices of one byte.
    ///
    /// # Panics
    ///
    /// As [`Mesh::new`].
    #[must_use]
    pub const fn new_u8(vertices: &'a [Vertex], triangles: &'a [[u8; 3]]) -> Self {
        checked(Self::try_from(vertices, Triangles::U8(triangles)))
    }

    /// A mesh from data that comes at run time.
    ///
    /// # Errors
    ///
    /// [`MeshError`] for the first triangle that names a vertex that is not there.
    pub const fn try_new(vertices: &'a [Vertex], triangles: &'a [[u16; 3]]) -> Result<Self, MeshError> {
        Self::try_from(vertices, Triangles::U16(triangles))
    }

    /// As [`Mesh::try_new`], with indices of one byte.
    ///
    /// # Errors
    ///
    /// As [`Mesh::try_new`].
    pub const fn try_new_u8(vertices: &'a [Vertex], triangles: &'a [[u8; 3]]) -> Result<Self, MeshError> {
        Self::try_from(vertices, Triangles::U8(triangles))
    }

    const fn try_from(vertices: &'a [Vertex], triangles: Triangles<'a>) -> Result<Self, MeshError> {
        match triangles.first_bad(vertices.len()) {
            Some(error) => Err(error),
            None => Ok(Self { vertices, triangles, bounds: Bounds::new(vertices) }),
        }
    }

    /// The triangles `start` … `end` − 1 alone (as far as there are such): a mesh with several materials is drawn
    /// part by part.
    ///
    /// ```
    /// use fixel::{Mesh, shapes};
    /// static CUBE: shapes::Shape<24, 12> = shapes::cube(2.0, [2, 2]);
    /// const CUBE_MESH: Mesh = CUBE.mesh();
    /// const FRONT: Mesh = CUBE_MESH.part(0, 2); // the face towards +z, two triangles
    /// assert_eq!(FRONT.triangles().len(), 2);
    /// ```
    #[must_use]
    pub const fn part(self, start: usize, end: usize) -> Self {
        const fn part<T>(triangles: &[T], start: usize, end: usize) -> &[T] {
            let end = if end < triangles.len() { end } else { triangles.len() };
            triangles.split_at(end).0.split_at(if start < end { start } else { end }).1
        }
        let triangles = match self.triangles {
            Triangles::U8(triangles) => Triangles::U8(part(triangles, start, end)),
            Triangles::U16(triangles) => Triangles::U16(part(triangles, start, end)),
        };
        Self { triangles, ..self }
    }

    /// The vertices.
    #[must_use]
    pub const fn vertices(&self) -> &'a [Vertex] {
        self.vertices
    }

    /// The triangles, three indices into [`Mesh::vertices`] each.
    #[must_use]
    pub fn triangles(&self) -> impl ExactSizeIterator<Item = [u16; 3]> + use<'a> {
        self.triangles
    }

    /// The same, by the type's name.
    pub(crate) const fn indices(&self) -> Triangles<'a> {
        self.triangles
    }

    /// How many triangles it has.
    pub(crate) const fn triangle_count(&self) -> usize {
        self.triangles.len()
    }

    /// The triangle `i`, if there are so many.
    #[inline]
    pub(crate) fn triangle(&self, i: usize) -> Option<[u16; 3]> {
        match self.triangles {
            Triangles::U8(triangles) => triangles.get(i).map(|corners| corners.map(u16::from)),
            Triangles::U16(triangles) => triangles.get(i).copied(),
        }
    }

    /// A vertex that a triangle names: the index was checked when the mesh was made.
    #[inline]
    pub(crate) fn vertex(&self, index: u16) -> &'a Vertex {
        const NONE: &Vertex = &Vertex::new(0.0, 0.0, 0.0);
        self.vertices.get(usize::from(index)).unwrap_or(NONE)
    }

    pub(crate) const fn bounds(&self) -> &Bounds {
        &self.bounds
    }
}

const fn checked(mesh: Result<Mesh<'_>, MeshError>) -> Mesh<'_> {
    match mesh {
        Ok(mesh) => mesh,
        Err(_) => panic!("a triangle of the mesh names a vertex that is not there"),
    }
}

impl Bounds {
    /// The sphere around the middle of the bounding box, its radius rounded up.
    ///
    /// Eight calls and turns of loops a vertex, of those two million; straight on, which the compiler's interpreter does in half
    /// the time that loops over the axes take.
    const fn new(vertices: &[Vertex]) -> Self {
        let count = vertices.len();
        let (mut low_x, mut low_y, mut low_z) = (i16::MAX, i16::MAX, i16::MAX);
        let (mut high_x, mut high_y, mut high_z) = (i16::MIN, i16::MIN, i16::MIN);
        let mut i = 0;
        while i < count {
            let [x, y, z] = vertices[i].position;
            let (x, y, z) = (x.to_bits(), y.to_bits(), z.to_bits());
            low_x = if x < low_x { x } else { low_x };
            low_y = if y < low_y { y } else { low_y };
            low_z = if z < low_z { z } else { low_z };
            high_x = if x > high_x { x } else { high_x };
            high_y = if y > high_y { y } else { high_y };
            high_z = if z > high_z { z } else { high_z };
            i += 1;
        }
        let center_x = (low_x as i32 + high_x as i32) / 2;
        let center_y = (low_y as i32 + high_y as i32) / 2;
        let center_z = (low_z as i32 + high_z as i32) / 2;
        let (mut most, mut is_gray) = (0, true);
        let mut i = 0;
        while i < count {
            is_gray &= is_color_gray(vertices[i].color);
            let [x, y, z] = vertices[i].position;
            // Up to 2¹⁶, and so 3 · 2³².
            let x = (x.to_bits() as i32 - center_x) as i64;
            let y = (y.to_bits() as i32 - center_y) as i64;
            let z = (z.to_bits() as i32 - center_z) as i64;
            let squares = (x * x + y * y + z * z) as u64;
            most = if squares > most { squares } else { most };
            i += 1;
        }
        let center = [
            I4F12::from_bits(center_x as i16),
            I4F12::from_bits(center_y as i16),
            I4F12::from_bits(center_z as i16),
        ];
        Self { center, is_gray, radius: most.isqrt() as i32 + 1 }
    }
}

/// A triangle names a vertex that is not there.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct MeshError {
    /// Which triangle, from 0.
    pub triangle: usize,
    /// The index that is too large.
    pub index: u16,
}

impl fmt::Display for MeshError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "triangle {} names vertex {}, which is not there", self.triangle, self.index)
    }
}

impl core::error::Error for MeshError {}
