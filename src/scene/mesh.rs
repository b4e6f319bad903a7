//! Meshes: vertices and triangles in flash.

use crate::num::{I4F12, I12F4, bits_from_f32, bits16_from_f32};
use core::fmt;

/// A vertex of a mesh, 16 bytes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Vertex {
    /// Position in mesh units; the pose places and scales it.
    pub position: [I4F12; 3],
    /// Texture coordinates in texels, (0, 0) the texture's first texel's outer corner.
    pub uv: [I12F4; 2],
    /// Red, green, blue, for [`Material::gouraud`](crate::Material::gouraud).
    pub color: [u8; 3],
    /// The direction that lights see, of length 1.0 = 127 in mesh space.
    pub normal: [i8; 3],
}

const _: () = assert!(size_of::<Vertex>() == 16);

impl Vertex {
    /// A vertex at a position from literals, −8 … 7.9998: rounded to 1/4096, saturated, NaN is 0.
    #[must_use]
    pub const fn new(x: f32, y: f32, z: f32) -> Self {
        Self {
            position: [
                I4F12::from_bits(bits16_from_f32(x, 12)),
                I4F12::from_bits(bits16_from_f32(y, 12)),
                I4F12::from_bits(bits16_from_f32(z, 12)),
            ],
            uv: [I12F4::ZERO; 2],
            color: [255; 3],
            normal: [0; 3],
        }
    }

    /// The same with texture coordinates in whole texels, −2048 … 2047 (saturated).
    #[must_use]
    pub const fn uv(mut self, u: i16, v: i16) -> Self {
        self.uv = [whole_texels(u), whole_texels(v)];
        self
    }

    /// The same with texture coordinates in texels, in steps of 1/16.
    #[must_use]
    pub const fn uv_sixteenths(mut self, u: I12F4, v: I12F4) -> Self {
        self.uv = [u, v];
        self
    }

    /// The same with a normal from literals: a vector of length 1, rounded to 1/127 and saturated; NaN is 0.
    #[must_use]
    pub const fn normal(mut self, x: f32, y: f32, z: f32) -> Self {
        self.normal = [unit127(x), unit127(y), unit127(z)];
        self
    }

    /// The same with a colour.
    #[must_use]
    pub const fn color(mut self, red: u8, green: u8, blue: u8) -> Self {
        self.color = [red, green, blue];
        self
    }
}

#[expect(clippy::float_arithmetic, reason = "set-up convenience, folded in constants")]
const fn unit127(component: f32) -> i8 {
    let bits = bits_from_f32(component * 127.0, 0);
    if bits > 127 {
        127
    } else if bits < -127 {
        -127
    } else {
        bits as i8
    }
}

const fn whole_texels(texels: i16) -> I12F4 {
    I12F4::from_bits(if texels > 2047 {
        2047 * 16
    } else if texels < -2048 {
        i16::MIN
    } else {
        texels * 16
    })
}

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
#[derive(Clone, Copy, Debug)]
pub struct Mesh<'a> {
    vertices: &'a [Vertex],
    triangles: Triangles<'a>,
    bounds: Bounds,
}

/// Three indices into the vertices for each triangle.
#[derive(Clone, Copy, Debug)]
enum Triangles<'a> {
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
}

/// A sphere around all vertices.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Bounds {
    pub(crate) center: [I4F12; 3],
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
        let mut triangle = 0;
        while triangle < triangles.len() {
            let corners = triangles.at(triangle);
            let mut corner = 0;
            while corner < 3 {
                let index = corners[corner];
                if index as usize >= vertices.len() {
                    return Err(MeshError { triangle, index });
                }
                corner += 1;
            }
            triangle += 1;
        }
        Ok(Self { vertices, triangles, bounds: Bounds::new(vertices) })
    }

    /// The triangles `start` … `end` − 1 alone (as far as there are such): a mesh with several materials is drawn
    /// part by part.
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
        let triangles = self.triangles;
        (0..triangles.len()).map(move |i| triangles.at(i))
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
    const fn new(vertices: &[Vertex]) -> Self {
        let mut center = [I4F12::ZERO; 3];
        let mut axis = 0;
        while axis < 3 {
            let (mut low, mut high) = (i16::MAX, i16::MIN);
            let mut i = 0;
            while i < vertices.len() {
                let at = vertices[i].position[axis].to_bits();
                low = if at < low { at } else { low };
                high = if at > high { at } else { high };
                i += 1;
            }
            center[axis] = I4F12::from_bits(((low as i32 + high as i32) / 2) as i16);
            axis += 1;
        }
        let mut most = 0;
        let mut i = 0;
        while i < vertices.len() {
            let mut squares = 0u64;
            let mut axis = 0;
            while axis < 3 {
                let d = (vertices[i].position[axis].to_bits() as i32 - center[axis].to_bits() as i32)
                    .unsigned_abs() as u64;
                squares += d * d;
                axis += 1;
            }
            most = if squares > most { squares } else { most };
            i += 1;
        }
        Self { center, radius: most.isqrt() as i32 + 1 }
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
