//! Cuts triangles whose texture coordinates span more texels than a format holds.
//!
//! - In: triangles with coordinates in texels, of any size.
//! - Out: triangles that cover the same, none of which spans more texels along u or v than was asked for.
//! - Assumes: finite numbers.
//!
//! An edge is cut in the middle if any triangle that has it needs that, so neighbours are cut alike and no crack opens.

use crate::model::Corner;
use crate::normals::place;
use std::collections::HashSet;

/// The most texels that a triangle may span.
pub(crate) const MOST: f64 = 2047.0;
/// … of a texture that does not repeat: what reaches into it, at most 1024 texels, ends within the format's range then, and what
/// does not is its border wherever it ends.
pub(crate) const MOST_CLAMPED: f64 = 1000.0;
/// More triangles are not made of one model.
const MOST_TRIANGLES: usize = 1 << 20;

/// A corner with coordinates in texels.
#[derive(Clone, Copy, Debug)]
pub(crate) struct TexelCorner {
    pub(crate) corner: Corner,
    pub(crate) texels: [f64; 2],
}

pub(crate) type TexelTriangle = [TexelCorner; 3];

fn middle(a: &TexelCorner, b: &TexelCorner) -> TexelCorner {
    let half = |a: f32, b: f32| a / 2.0 + b / 2.0;
    let (p, q) = (a.corner, b.corner);
    // The same from both sides, to the bit.
    let position = [0, 1, 2].map(|i| half(p.position[i], q.position[i]));
    let normal = match (p.normal, q.normal) {
        (Some(m), Some(n)) => crate::obj::unit([0, 1, 2].map(|i| half(m[i], n[i]))),
        _ => None,
    };
    let color = match (p.color, q.color) {
        (Some(m), Some(n)) => Some([0, 1, 2].map(|i| u8::midpoint(m[i], n[i]))),
        _ => None,
    };
    TexelCorner {
        corner: Corner { position, uv: None, normal, color },
        texels: [0, 1].map(|i| f64::midpoint(a.texels[i], b.texels[i])),
    }
}

fn is_long(a: &TexelCorner, b: &TexelCorner, most: f64) -> bool {
    (0..2).any(|i| (a.texels[i] - b.texels[i]).abs() > most)
}

/// Cuts what spans more texels than its part may; `None` if that would make too many triangles. Also says how many triangles were cut.
pub(crate) fn cut(parts: &mut [Vec<TexelTriangle>], most: &[f64]) -> Option<usize> {
    let mut count = 0;
    loop {
        let mut long = HashSet::new();
        for ([a, b, c], most) in
            parts.iter().zip(most).flat_map(|(part, most)| part.iter().map(move |all| (all, *most)))
        {
            for (from, to) in [(a, b), (b, c), (c, a)] {
                if is_long(from, to, most) {
                    let [from, to] = [from, to].map(|end| place(end.corner.position));
                    long.insert((from.min(to), from.max(to)));
                }
            }
        }
        if long.is_empty() {
            return Some(count);
        }
        let mut total = 0;
        for part in parts.iter_mut() {
            let mut pieces = Vec::with_capacity(part.len());
            for triangle in part.iter() {
                let is_cut = [0, 1, 2].map(|k| {
                    let [from, to] = [k, (k + 1) % 3].map(|k| place(triangle[k].corner.position));
                    long.contains(&(from.min(to), from.max(to)))
                });
                count += usize::from(is_cut != [false; 3]);
                cut_one(triangle, is_cut, &mut pieces);
            }
            total += pieces.len();
            *part = pieces;
        }
        if total > MOST_TRIANGLES {
            return None;
        }
    }
}

/// The pieces of one triangle, of which some edges are cut: edge k runs from corner k to the next.
fn cut_one(triangle: &TexelTriangle, is_cut: [bool; 3], pieces: &mut Vec<TexelTriangle>) {
    // Turned so that the first edge is cut, and with two that are, the last is not.
    let cuts = is_cut.iter().filter(|cut| **cut).count();
    let first = match cuts {
        1 => is_cut.iter().position(|cut| *cut),
        2 => is_cut.iter().position(|cut| !*cut).map(|whole| (whole + 1) % 3),
        _ => Some(0),
    };
    let [a, b, c] = [0, 1, 2].map(|k| triangle[(k + first.unwrap_or(0)) % 3]);
    match cuts {
        0 => pieces.push([a, b, c]),
        1 => {
            let m = middle(&a, &b);
            pieces.extend([[a, m, c], [m, b, c]]);
        }
        2 => {
            let (m, n) = (middle(&a, &b), middle(&b, &c));
            pieces.extend([[m, b, n], [a, m, n], [a, n, c]]);
        }
        _ => {
            let (m, n, o) = (middle(&a, &b), middle(&b, &c), middle(&c, &a));
            pieces.extend([[a, m, o], [m, b, n], [o, n, c], [m, n, o]]);
        }
    }
}

/// Moves coordinates by whole repeats of a texture of `period` texels, so that all are within ±2047 texels: all together if they span no
/// more than that, else triangle by triangle.
pub(crate) fn shift(triangles: &mut [TexelTriangle], period: [f64; 2]) {
    for (axis, period) in period.into_iter().enumerate() {
        let all = || triangles.iter().flatten().map(|corner| corner.texels[axis]);
        let (low, high) = all().fold((f64::MAX, f64::MIN), |(low, high), at| (low.min(at), high.max(at)));
        if low >= -MOST && high <= MOST {
            continue;
        }
        let by = (f64::midpoint(low, high) / period).round() * period;
        if low - by >= -MOST && high - by <= MOST {
            triangles.iter_mut().flatten().for_each(|corner| corner.texels[axis] -= by);
            continue;
        }
        for triangle in triangles.iter_mut() {
            // Neighbours are mostly moved alike, and still share vertices then: 1024 is a whole number of repeats.
            let ends = triangle.map(|corner| corner.texels[axis]);
            let middle = f64::midpoint(
                ends.into_iter().fold(f64::MAX, f64::min),
                ends.into_iter().fold(f64::MIN, f64::max),
            );
            let by = (middle / 1024.0).round() * 1024.0;
            triangle.iter_mut().for_each(|corner| corner.texels[axis] -= by);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn corner(x: f32, y: f32, texels: [f64; 2]) -> TexelCorner {
        let corner = Corner { position: [x, y, 0.0], uv: None, normal: Some([0.0, 0.0, 1.0]), color: None };
        TexelCorner { corner, texels }
    }

    /// A wall of one unit, its neighbour without a texture, and how many texels the wall is wide and high.
    fn wall(texels: f64) -> Vec<Vec<TexelTriangle>> {
        let at = |x: f32, y: f32| corner(x, y, [f64::from(x) * texels + 5000.0, f64::from(y) * texels]);
        let plain = |x: f32, y: f32| corner(x, y, [0.0; 2]);
        let quad = |at: &dyn Fn(f32, f32) -> TexelCorner, x: f32| {
            let [a, b, c, d] = [at(x, 0.0), at(x + 1.0, 0.0), at(x + 1.0, 1.0), at(x, 1.0)];
            vec![[a, b, c], [a, c, d]]
        };
        vec![quad(&at, 0.0), quad(&plain, 1.0)]
    }

    fn area(triangles: &[TexelTriangle]) -> f64 {
        let of = |t: &TexelTriangle| crate::normals::across(t.map(|corner| corner.corner.position))[2] / 2.0;
        triangles.iter().map(of).sum()
    }

    #[test]
    fn what_spans_too_much_is_cut_without_cracks() {
        let mut parts = wall(9000.0);
        assert!(cut(&mut parts, &[MOST; 2]).expect("not too many") > 4);
        for part in &parts {
            assert!((area(part) - 1.0).abs() < 1e-6);
            assert!(part.iter().all(across_is_up));
        }
        // Each edge inside has a triangle on either side: neighbours were cut alike.
        let mut edges = std::collections::HashMap::new();
        for [a, b, c] in parts.iter().flatten() {
            for (from, to) in [(a, b), (b, c), (c, a)] {
                let [from, to] = [from, to].map(|end| place(end.corner.position));
                *edges.entry((from.min(to), from.max(to))).or_insert(0) += if from < to { 1 } else { -1 };
            }
        }
        let on_border = |p: [u32; 3]| p.map(f32::from_bits);
        for ((from, to), sum) in edges {
            let (from, to) = (on_border(from), on_border(to));
            let border = [0.0, 2.0].iter().any(|x| from[0] == *x && to[0] == *x)
                || [0.0, 1.0].iter().any(|y| from[1] == *y && to[1] == *y);
            assert_eq!(sum == 0, !border, "{from:?} {to:?}");
        }
        shift(&mut parts[0], [64.0; 2]);
        for corner in parts[0].iter().flatten() {
            assert!(corner.texels.iter().all(|at| at.abs() <= MOST), "{corner:?}");
            let exact = f64::from(corner.corner.position[0]) * 9000.0 + 5000.0;
            assert!(
                ((exact - corner.texels[0]) / 64.0 - ((exact - corner.texels[0]) / 64.0).round()).abs()
                    < 1e-6
            );
        }
        assert_eq!(cut(&mut wall(1e30), &[MOST; 2]), None);
    }

    fn across_is_up(triangle: &TexelTriangle) -> bool {
        crate::normals::across(triangle.map(|corner| corner.corner.position))[2] > 0.0
    }
}
