//! The sphere of even triangles.
//!
//! An icosahedron's 20 triangles are ten diamonds: five that reach up to the north pole and five that
//! reach down to the south pole. Each is a square array of vertices, which owns two of its edges and finds
//! the others in its neighbours', so that no vertex is ever searched for.
//!
//! ```text
//!        north                     a′
//!   (0,f)/‾‾\(f,f)            (0,f)/‾‾\(f,f)
//!       /    \                    /    \
//!    a ‾‾‾‾‾‾ a′               b ‾‾‾‾‾‾ b′
//!       \    /                    \    /
//!   (0,0)\__/(f,0)            (0,0)\__/(f,0)
//!          b                       south
//! ```

use super::builder::{Builder, in_strips, length};
use super::round::{scaled, sin_cos};
use super::shape::{Counts, Shape};
use crate::num::I12F4;

/// A sphere of 20 · `frequency`² triangles of nearly one size, without texture coordinates: each edge of an
/// icosahedron, a corner of which is at +y, in `frequency` ≥ 1 parts.
///
/// 10 · `frequency`² + 2 vertices: no vertex is there twice. Cutting every triangle into four n times is a
/// frequency of 2ⁿ.
#[must_use]
pub const fn icosphere<const V: usize, const T: usize>(radius: f32, frequency: usize) -> Shape<V, T> {
    assert!(frequency >= 1, "an icosphere's frequency is at least 1");
    let radius = length(radius);
    let mut shape = Builder::new(Counts::icosphere(frequency));

    let mut diamond = 0;
    while diamond < 10 {
        let corners = corners(diamond);
        let mut n = 0;
        while n < frequency * frequency {
            let normal = point(&corners, n / frequency, n % frequency, frequency);
            shape.vertex(scaled(normal, radius), normal, [I12F4::ZERO; 2]);
            let (j, i) = in_strips(n, frequency, frequency);
            shape.square(
                vertex(diamond, i, j, frequency),
                vertex(diamond, i + 1, j, frequency),
                vertex(diamond, i + 1, j + 1, frequency),
                vertex(diamond, i, j + 1, frequency),
            );
            n += 1;
        }
        diamond += 1;
    }
    shape.vertex([0.0, radius, 0.0], [0.0, 1.0, 0.0], [I12F4::ZERO; 2]);
    shape.vertex([0.0, -radius, 0.0], [0.0, -1.0, 0.0], [I12F4::ZERO; 2]);
    shape.finish()
}

/// The index of vertex (`i`, `j`), 0 … f each, of a diamond: 0 … 4 are the northern ones, 5 … 9 the southern.
const fn vertex(diamond: usize, i: usize, j: usize, f: usize) -> usize {
    let northern = diamond < 5;
    let next = diamond / 5 * 5 + (diamond + 1) % 5;
    if i < f && j < f {
        (diamond * f + i) * f + j
    } else if northern {
        match (i, j) {
            (0, _) => 10 * f * f,
            // The edge b–a′ of the southern diamond below; a′ is the next one's own.
            (_, j) if j < f => vertex(diamond + 5, 0, j, f),
            // The edge north–a′ of the next one.
            _ => vertex(next, 0, f - i, f),
        }
    } else {
        match (i, j) {
            (_, 0) => 10 * f * f + 1,
            // The edge a′–b′ of the next northern diamond; b′ is the next southern one's own.
            (i, _) if i < f => vertex(next - 5, i, 0, f),
            // The edge south–b′ of the next one.
            _ => vertex(next, f - j, 0, f),
        }
    }
}

/// The corners (0, 0), (f, 0), (f, f) and (0, f) of a diamond, of length 1.
const fn corners(diamond: usize) -> [[f64; 3]; 4] {
    let k = diamond % 5;
    // In tenths of a turn: the lower ring stands between the upper one's corners.
    let [a, b] = [ring(2 * k, 1.0), ring(2 * k + 1, -1.0)];
    let [next_a, next_b] = [ring(2 * k + 2, 1.0), ring(2 * k + 3, -1.0)];
    if diamond < 5 { [a, b, next_a, [0.0, 1.0, 0.0]] } else { [b, [0.0, -1.0, 0.0], next_b, next_a] }
}

/// A corner of the icosahedron that is no pole: at latitude atan ½, up or down.
const fn ring(tenth: usize, up: f64) -> [f64; 3] {
    /// 1/√5.
    const HEIGHT: f64 = 0.447_213_595_499_957_9;
    let (s, c) = sin_cos(tenth, 10);
    [2.0 * HEIGHT * s, up * HEIGHT, 2.0 * HEIGHT * c]
}

/// Vertex (`i`, `j`) of a diamond, on the sphere.
const fn point(corners: &[[f64; 3]; 4], i: usize, j: usize, f: usize) -> [f64; 3] {
    let [first, right, last, left] = corners;
    // On the triangle on this side of the diagonal: weights that sum to f.
    let (side, weights) = if i >= j { (right, [f - i, i - j, j]) } else { (left, [f - j, j - i, i]) };
    let mut point = [0.0; 3];
    let mut squares = 0.0;
    let mut axis = 0;
    while axis < 3 {
        point[axis] = (first[axis] * weights[0] as f64
            + side[axis] * weights[1] as f64
            + last[axis] * weights[2] as f64)
            / f as f64;
        squares += point[axis] * point[axis];
        axis += 1;
    }
    // Newton for the square root of 0.63 … 1: four steps double 2 digits to 32.
    let mut root = 0.9;
    let mut step = 0;
    while step < 5 {
        root = (root + squares / root) / 2.0;
        step += 1;
    }
    scaled(point, 1.0 / root)
}
