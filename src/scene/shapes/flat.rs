//! Shapes of flat faces.

use super::builder::{Builder, length, part};
use super::shape::{Counts, Shape};

/// A rectangle in the plane z = 0 that faces +z, the texture's top towards +y; `width` and `height` in mesh units.
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

/// A cube of `edge` mesh units, each face with the texture from corner to corner: upright on the four sides, and on top and
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
