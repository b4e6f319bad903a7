//! Ready-made meshes, built by the compiler.
//!
//! A shape's size is in its type, so it can stand in flash: [`Shape`] has the counts, [`Counts`]
//! computes them, and wrong ones are a compile error that names the right ones.
//!
//! ```
//! use fixel::Mesh;
//! use fixel::shapes::{Counts, Shape, torus, uv_sphere};
//!
//! static RING: Shape<500, 1000> = torus(1.0, 0.45, 25, 20);
//! const RING_MESH: Mesh = RING.mesh();
//!
//! const N: Counts = Counts::uv_sphere(24, 12);
//! static GLOBE: Shape<{ N.vertices }, { N.triangles }> = uv_sphere(1.0, 24, 12, [512, 256]);
//! # assert_eq!(RING_MESH.vertices().len(), 500);
//! # assert_eq!(GLOBE.mesh().triangles().len(), 528);
//! ```
//!
//! A torus of 25 × 20 squares is not a `Shape<526, 1000>` ("this shape is a Shape<500, 1000>"):
//!
//! ```compile_fail,E0080
//! # use fixel::shapes::{Shape, torus};
//! static RING: Shape<526, 1000> = torus(1.0, 0.45, 25, 20);
//! # let _ = RING.mesh();
//! ```
//!
//! All shapes have the origin in their middle and are closed (but for [`quad`] and [`grid`]); their
//! triangles run counter-clockwise seen from outside, their normals point outward, their colour is white.
//! Lengths are in mesh units, above 0; no vertex may leave −8 … 7.9998. A shape some units large keeps more
//! of its form in 12 fraction bits than a small one; the pose scales it. Textures read from
//! left to right seen from outside; the parameter `texels` says how many of them, 0 … 2047, go across and
//! down: the texture's size, times how often it is to be repeated.
//!
//! # Panics
//!
//! All functions here are meant for `const` and `static`, where a parameter that makes no such shape, or
//! counts that do not fit, are a compile error. Elsewhere they panic, and compute in soft float
//! where there is no FPU.

#![expect(clippy::float_arithmetic, reason = "meant to be evaluated by the compiler")]

mod icosphere;
mod round;
#[cfg(test)]
mod tests;

pub use icosphere::icosphere;
pub use round::{cylinder, torus, torus_textured, uv_sphere};

use super::{Mesh, Vertex};
use crate::num::I12F4;

/// `V` vertices and `T` triangles.
#[derive(Clone, Debug)]
pub struct Shape<const V: usize, const T: usize> {
    vertices: [Vertex; V],
    triangles: [[u16; 3]; T],
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
    /// Of [`grid`].
    #[must_use]
    pub const fn grid(columns: usize, rows: usize) -> Self {
        Self { vertices: (columns + 1) * (rows + 1), triangles: 2 * columns * rows }
    }

    /// Of [`uv_sphere`].
    #[must_use]
    pub const fn uv_sphere(segments: usize, rings: usize) -> Self {
        Self {
            vertices: (segments + 1) * rings.saturating_sub(1) + 2 * segments,
            triangles: 2 * segments * rings.saturating_sub(1),
        }
    }

    /// Of [`icosphere`].
    #[must_use]
    pub const fn icosphere(frequency: usize) -> Self {
        Self { vertices: 10 * frequency * frequency + 2, triangles: 20 * frequency * frequency }
    }

    /// Of [`torus`].
    #[must_use]
    pub const fn torus(rings: usize, sides: usize) -> Self {
        Self { vertices: rings * sides, triangles: 2 * rings * sides }
    }

    /// Of [`torus_textured`].
    #[must_use]
    pub const fn torus_textured(rings: usize, sides: usize) -> Self {
        Self::grid(rings, sides)
    }

    /// Of [`cylinder`].
    #[must_use]
    pub const fn cylinder(sides: usize) -> Self {
        Self { vertices: 4 * sides + 2, triangles: (4 * sides).saturating_sub(4) }
    }
}

/// A rectangle in the plane z = 0 that faces +z, the texture's top towards +y.
#[must_use]
pub const fn quad(width: f32, height: f32, texels: [u16; 2]) -> Shape<4, 2> {
    grid(width, height, 1, 1, texels)
}

/// A [`quad`] of `columns` × `rows` parts, for light that differs from place to place.
///
/// (`columns` + 1)(`rows` + 1) vertices, 2 · `columns` · `rows` triangles.
#[must_use]
pub const fn grid<const V: usize, const T: usize>(
    width: f32,
    height: f32,
    columns: usize,
    rows: usize,
    texels: [u16; 2],
) -> Shape<V, T> {
    assert!(columns > 0 && rows > 0, "a grid has at least one column and one row");
    let (width, height) = (length(width), length(height));
    let mut shape = Builder::new(Counts::grid(columns, rows));
    let mut row = 0;
    while row <= rows {
        let mut column = 0;
        while column <= columns {
            let x = width * (column as f64 / columns as f64 - 0.5);
            let y = height * (0.5 - row as f64 / rows as f64);
            let uv = [part(texels[0], column, columns), part(texels[1], row, rows)];
            shape.vertex([x, y, 0.0], [0.0, 0.0, 1.0], uv);
            column += 1;
        }
        row += 1;
    }
    shape.squares(0, columns, rows);
    shape.finish()
}

/// A cube, each face with the texture from corner to corner: upright on the four sides, and on top and
/// bottom with the edge towards −z and +z uppermost. Faces are flat: 24 vertices.
#[must_use]
pub const fn cube(edge: f32, texels: [u16; 2]) -> Shape<24, 12> {
    // Normal, right, and up of each face, seen from outside.
    const FACES: [[[f64; 3]; 3]; 6] = [
        [[0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]],
        [[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]],
        [[0.0, 0.0, -1.0], [-1.0, 0.0, 0.0], [0.0, 1.0, 0.0]],
        [[-1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, 1.0, 0.0]],
        [[0.0, 1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, -1.0]],
        [[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]],
    ];
    let half = length(edge) / 2.0;
    let mut shape = Builder::new(Counts { vertices: 24, triangles: 12 });
    let mut face = 0;
    while face < 6 {
        let [normal, right, up] = FACES[face];
        let first = shape.next_vertex;
        let mut corner = 0;
        while corner < 4 {
            let (column, row) = (corner % 2, corner / 2);
            let (s, t) = (2.0 * column as f64 - 1.0, 1.0 - 2.0 * row as f64);
            let mut place = [0.0; 3];
            let mut i = 0;
            while i < 3 {
                place[i] = half * (normal[i] + s * right[i] + t * up[i]);
                i += 1;
            }
            shape.vertex(place, normal, [part(texels[0], column, 1), part(texels[1], row, 1)]);
            corner += 1;
        }
        shape.squares(first, 1, 1);
        face += 1;
    }
    shape.finish()
}

/// A shape that is being put together.
struct Builder<const V: usize, const T: usize> {
    shape: Shape<V, T>,
    next_vertex: usize,
    next_triangle: usize,
}

impl<const V: usize, const T: usize> Builder<V, T> {
    const fn new(counts: Counts) -> Self {
        assert!(counts.vertices <= 1 << 16, "a shape has at most 65536 vertices");
        if counts.vertices != V || counts.triangles != T {
            wrong_counts(counts);
        }
        let vertices = [Vertex::new(0.0, 0.0, 0.0); V];
        Self { shape: Shape { vertices, triangles: [[0; 3]; T] }, next_vertex: 0, next_triangle: 0 }
    }

    const fn vertex(&mut self, place: [f64; 3], normal: [f64; 3], [u, v]: [I12F4; 2]) {
        let mut i = 0;
        while i < 3 {
            assert!(place[i] >= -8.0 && place[i] < 7.9999, "a vertex of the shape is not within −8 … 7.9998");
            i += 1;
        }
        self.shape.vertices[self.next_vertex] =
            Vertex::new(place[0] as f32, place[1] as f32, place[2] as f32)
                .normal(normal[0] as f32, normal[1] as f32, normal[2] as f32)
                .uv_sixteenths(u, v);
        self.next_vertex += 1;
    }

    const fn triangle(&mut self, a: usize, b: usize, c: usize) {
        self.shape.triangles[self.next_triangle] = [a as u16, b as u16, c as u16];
        self.next_triangle += 1;
    }

    /// Two triangles, of a square whose corners run counter-clockwise.
    const fn square(&mut self, a: usize, b: usize, c: usize, d: usize) {
        self.triangle(a, b, c);
        self.triangle(a, c, d);
    }

    /// The squares between rows of `columns` + 1 vertices, [`in_strips`], that begin at vertex `first`.
    const fn squares(&mut self, first: usize, columns: usize, rows: usize) {
        let mut i = 0;
        while i < columns * rows {
            let (column, row) = in_strips(i, columns, rows);
            let top = first + row * (columns + 1) + column;
            let bottom = top + columns + 1;
            self.square(bottom, bottom + 1, top + 1, top);
            i += 1;
        }
    }

    const fn finish(self) -> Shape<V, T> {
        assert!(self.next_vertex == V && self.next_triangle == T);
        self.shape
    }
}

/// Column and row of the `i`-th square, in strips of three columns from top to bottom, so that the draw call's cache of 9 vertices
/// still has a square's upper corners from the row above: two vertices are transformed for three triangles, instead of one for
/// each when whole rows are drawn.
const fn in_strips(i: usize, columns: usize, rows: usize) -> (usize, usize) {
    const WIDTH: usize = 3;
    let strip = i / (WIDTH * rows);
    let left = strip * WIDTH;
    let width = if columns - left < WIDTH { columns - left } else { WIDTH };
    let i = i - left * rows;
    (left + i % width, i / width)
}

/// A length that was given, if it is one.
const fn length(length: f32) -> f64 {
    assert!(length > 0.0 && length < 16.0, "a length of the shape is not above 0 and below 16");
    length as f64
}

/// `i`/`n` of so many texels.
const fn part(texels: u16, i: usize, n: usize) -> I12F4 {
    assert!(texels < 2048, "texture coordinates end at 2047");
    I12F4::from_bits(((texels as usize * 16 * i + n / 2) / n) as i16)
}

/// Says what the counts should be.
const fn wrong_counts(Counts { vertices, triangles }: Counts) -> ! {
    const BEFORE: &[u8] = b"this shape is a Shape<";
    let mut text = [b' '; 40];
    // From the end to the beginning.
    let at = text.len() - 1;
    text[at] = b'>';
    let at = write_before(&mut text, at, triangles);
    let at = at - 2;
    text[at] = b',';
    let mut at = write_before(&mut text, at, vertices);
    let mut i = BEFORE.len();
    while i > 0 {
        i -= 1;
        at -= 1;
        text[at] = BEFORE[i];
    }
    match core::str::from_utf8(text.split_at(at).1) {
        Ok(text) => panic!("{}", text),
        Err(_) => panic!("this shape has other counts"),
    }
}

/// Writes a number that ends before `text[at]`; where it begins.
const fn write_before(text: &mut [u8], mut at: usize, mut number: usize) -> usize {
    loop {
        at -= 1;
        text[at] = b'0' + (number % 10) as u8;
        number /= 10;
        if number == 0 {
            return at;
        }
    }
}
