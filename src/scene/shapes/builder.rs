//! How a shape is put together, vertex by vertex, and what it says if its type has other counts.

use super::shape::{Counts, Shape};
use crate::num::I12F4;
use crate::scene::Vertex;

/// A shape that is being put together.
pub(super) struct Builder<const V: usize, const T: usize> {
    pub(super) shape: Shape<V, T>,
    pub(super) next_vertex: usize,
    next_triangle: usize,
}

impl<const V: usize, const T: usize> Builder<V, T> {
    pub(super) const fn new(counts: Counts) -> Self {
        assert!(counts.vertices <= 1 << 16, "a shape has at most 65536 vertices");
        if counts.vertices != V || counts.triangles != T {
            wrong_counts(counts);
        }
        let vertices = [Vertex::new(0.0, 0.0, 0.0); V];
        Self { shape: Shape { vertices, triangles: [[0; 3]; T] }, next_vertex: 0, next_triangle: 0 }
    }

    pub(super) const fn vertex(&mut self, place: [f64; 3], normal: [f64; 3], [u, v]: [I12F4; 2]) {
        self.shape.vertices[self.next_vertex] =
            match Vertex::try_new(place[0] as f32, place[1] as f32, place[2] as f32) {
                Ok(vertex) => {
                    vertex.normal(normal[0] as f32, normal[1] as f32, normal[2] as f32).uv_sixteenths(u, v)
                }
                Err(_) => panic!("a vertex of the shape is not within −8 … 7.9998"),
            };
        self.next_vertex += 1;
    }

    pub(super) const fn triangle(&mut self, a: usize, b: usize, c: usize) {
        self.shape.triangles[self.next_triangle] = [a as u16, b as u16, c as u16];
        self.next_triangle += 1;
    }

    /// Two triangles, of a square whose corners run counter-clockwise.
    pub(super) const fn square(&mut self, a: usize, b: usize, c: usize, d: usize) {
        self.triangle(d, a, c);
        self.triangle(c, a, b);
    }

    /// The squares between rows of `columns` + 1 vertices, [`in_strips`], that begin at vertex `first`.
    pub(super) const fn squares(&mut self, first: usize, columns: usize, rows: usize) {
        let mut i = 0;
        while i < columns * rows {
            let (column, row) = in_strips(i, columns, rows);
            let top = first + row * (columns + 1) + column;
            let bottom = top + columns + 1;
            self.square(bottom, bottom + 1, top + 1, top);
            i += 1;
        }
    }

    pub(super) const fn finish(self) -> Shape<V, T> {
        assert!(self.next_vertex == V && self.next_triangle == T);
        self.shape
    }
}

/// Column and row of the `i`-th square, in strips of four columns from top to bottom, from right to left in each row.
///
/// With the order of corners in [`Builder::square`] the draw call's cache of 9 vertices still has a square's corners from the row
/// before: five vertices are transformed for eight triangles, instead of one for each when whole rows are drawn. (Wider strips take
/// a larger cache; from left to right, or with the triangles the other way round, strips of three columns are the widest.)
pub(super) const fn in_strips(i: usize, columns: usize, rows: usize) -> (usize, usize) {
    const WIDTH: usize = 4;
    let strip = i / (WIDTH * rows);
    let left = strip * WIDTH;
    let width = if columns - left < WIDTH { columns - left } else { WIDTH };
    let i = i - left * rows;
    (left + width - 1 - i % width, i / width)
}

/// A length that was given, if it is one.
pub(super) const fn length(length: f32) -> f64 {
    assert!(length > 0.0 && length < 16.0, "a length of the shape is not above 0 and below 16");
    length as f64
}

/// `i`/`n` of so many texels.
pub(super) const fn part(texels: u16, i: usize, n: usize) -> I12F4 {
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
