//! A room of walls with openings, as one mesh: the cells of a sheet share their vertices, so that no crack can be.

use fixel::fixed::types::I12F4;
use fixel::{Mesh, MeshError, Vertex};
use std::ops::Range;

/// A mesh that is put together from flat sheets.
#[derive(Default)]
pub struct Walls {
    vertices: Vec<Vertex>,
    triangles: Vec<[u16; 3]>,
}

/// A rectangle of cells, along the wall and up it.
pub type Opening = [Range<usize>; 2];

/// A wall seen from outside.
pub struct Wall<'a> {
    /// The middle of its outside, at y = 0.
    pub middle: [f32; 3],
    /// To the right, of length 1 and level.
    pub right: [f32; 3],
    /// Where its columns of cells begin and end, to the right of the middle.
    pub columns: &'a [f32],
    /// Where its rows begin and end.
    pub rows: &'a [f32],
    pub opening: Option<Opening>,
}

const UP: [f32; 3] = [0.0, 1.0, 0.0];
const THICK: f32 = 0.4;
const TEXELS_A_UNIT: f32 = 42.0;

#[expect(clippy::float_arithmetic, reason = "on a desktop")]
impl Walls {
    pub fn mesh(&self) -> Result<Mesh<'_>, MeshError> {
        Mesh::try_new(&self.vertices, &self.triangles)
    }

    /// Both sides of a wall, its top, its ends, and what is seen of its thickness in the opening.
    ///
    /// The columns are to be the same to both sides of the middle.
    pub fn wall(&mut self, wall: &Wall<'_>) {
        let Wall { middle, right, columns, rows, opening } = wall;
        let (&[left, .., end], &[bottom, .., top]) = (*columns, *rows) else { return };
        let outward = cross(*right, UP);
        let [leftward, inward] = [*right, outward].map(|direction| direction.map(|x| -x));
        let inside = along(*middle, outward, -THICK);
        let depth = [0.0, THICK];
        self.sheet(*middle, [*right, UP], [columns, rows], opening.as_ref());
        self.sheet(inside, [leftward, UP], [columns, rows], opening.as_ref());
        self.sheet(along(*middle, UP, top), [*right, inward], [columns, &depth], None);
        self.sheet(along(*middle, *right, end), [inward, UP], [&depth, rows], None);
        self.sheet(along(inside, *right, left), [outward, UP], [&depth, rows], None);
        let Some([across, upward]) = opening else { return };
        let (columns, rows) = (&columns[across.start..=across.end], &rows[upward.start..=upward.end]);
        let (&[left, .., end], &[low, .., high]) = (columns, rows) else { return };
        self.sheet(along(*middle, *right, left), [inward, UP], [&depth, rows], None);
        self.sheet(along(inside, *right, end), [outward, UP], [&depth, rows], None);
        self.sheet(along(inside, UP, high), [*right, outward], [columns, &depth], None);
        if low > bottom {
            self.sheet(along(*middle, UP, low), [*right, inward], [columns, &depth], None);
        }
    }

    /// A sheet of cells that faces right × up; `steps` are where they begin and end, to the right and upwards.
    ///
    /// In the picture the bricks stand: it is turned clockwise here.
    fn sheet(
        &mut self,
        corner: [f32; 3],
        [right, up]: [[f32; 3]; 2],
        [columns, rows]: [&[f32]; 2],
        opening: Option<&Opening>,
    ) {
        let (first, width) = (self.vertices.len(), columns.len());
        let normal = cross(right, up);
        for &t in rows {
            for &s in columns {
                let [x, y, z] = along(along(corner, right, s), up, t);
                let [u, v] = [-t, -s].map(|place| I12F4::unwrapped_from_num(place * TEXELS_A_UNIT));
                let vertex = Vertex::new(x, y, z).uv_sixteenths(u, v);
                self.vertices.push(vertex.normal(normal[0], normal[1], normal[2]));
            }
        }
        for row in 1..rows.len() {
            for column in 1..width {
                if opening.is_some_and(|[c, r]| c.contains(&(column - 1)) && r.contains(&(row - 1))) {
                    continue;
                }
                let high = (first + row * width + column) as u16;
                let low = high - width as u16;
                self.triangles.extend([[low - 1, low, high], [low - 1, high, high - 1]]);
            }
        }
    }
}

#[expect(clippy::float_arithmetic, reason = "on a desktop")]
fn along(from: [f32; 3], direction: [f32; 3], distance: f32) -> [f32; 3] {
    [0, 1, 2].map(|axis| from[axis] + direction[axis] * distance)
}

#[expect(clippy::float_arithmetic, reason = "on a desktop")]
fn cross(a: [f32; 3], b: [f32; 3]) -> [f32; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}
