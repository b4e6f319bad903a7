//! Normals where a file has none.
//!
//! - In: triangles, some corners of which have no normal.
//! - Out: the same, all with a normal but those of triangles that have no area.
//! - Assumes: finite positions.
//!
//! A corner's normal is the mean of those triangles around it that are smooth with its own, weighted by their angles there: so it does
//! not depend on how a surface is cut into triangles.

use crate::model::{Part, Smoothing, Triangle};
use std::collections::HashMap;

/// At a point with more triangles each has its own normal: looking at all pairs would take too long.
const MOST: usize = 2048;

pub(crate) type Place = [u32; 3];

/// A position to compare: −0 is 0.
pub(crate) fn place(position: [f32; 3]) -> Place {
    position.map(|component| (component + 0.0).to_bits())
}

struct Face {
    /// Of length 1, or 0.
    normal: [f64; 3],
    /// At each corner.
    angles: [f64; 3],
    smoothing: Smoothing,
}

fn difference(a: [f32; 3], b: [f32; 3]) -> [f64; 3] {
    [0, 1, 2].map(|i| f64::from(a[i]) - f64::from(b[i]))
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// Across a triangle, as long as twice its area.
pub(crate) fn across(corners: [[f32; 3]; 3]) -> [f64; 3] {
    let (a, b) = (difference(corners[1], corners[0]), difference(corners[2], corners[0]));
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

fn normalized(vector: [f64; 3]) -> [f64; 3] {
    let length = dot(vector, vector).sqrt();
    if length > 0.0 { vector.map(|component| component / length) } else { [0.0; 3] }
}

fn face(triangle: &Triangle) -> Face {
    let corners = triangle.corners.map(|corner| corner.position);
    let angles = [0, 1, 2].map(|k| {
        let a = normalized(difference(corners[(k + 1) % 3], corners[k]));
        let b = normalized(difference(corners[(k + 2) % 3], corners[k]));
        dot(a, b).clamp(-1.0, 1.0).acos()
    });
    Face { normal: normalized(across(corners)), angles, smoothing: triangle.smoothing }
}

/// Computes those that are missing, and says how many corners that were. `crease`: triangles that meet at more are not smooth, in
/// degrees.
pub(crate) fn complete(parts: &mut [Part], crease: f64) -> usize {
    let missing =
        |triangle: &Triangle| triangle.corners.iter().filter(|corner| corner.normal.is_none()).count();
    let count = parts.iter().flat_map(|part| &part.triangles).map(missing).sum();
    if count == 0 {
        return 0;
    }
    let faces: Vec<Face> = parts.iter().flat_map(|part| &part.triangles).map(face).collect();
    let mut around: HashMap<Place, Vec<(u32, u8)>> = HashMap::new();
    for (number, triangle) in parts.iter().flat_map(|part| &part.triangles).enumerate() {
        for (k, corner) in triangle.corners.iter().enumerate() {
            around.entry(place(corner.position)).or_default().push((number as u32, k as u8));
        }
    }
    // Rounding must not part what meets at just that angle.
    let least = (crease + 0.01).to_radians().cos();
    let smooth = |own: &Face, other: &Face| match (own.smoothing, other.smoothing) {
        (Smoothing::ByAngle, Smoothing::ByAngle) => dot(own.normal, other.normal) >= least,
        (Smoothing::Group(a), Smoothing::Group(b)) => a == b,
        _ => false,
    };
    let triangles = parts.iter_mut().flat_map(|part| &mut part.triangles);
    for (own, triangle) in faces.iter().zip(triangles) {
        for corner in triangle.corners.iter_mut().filter(|corner| corner.normal.is_none()) {
            let all = &around[&place(corner.position)];
            let mut sum = [0.0; 3];
            if all.len() <= MOST {
                for (other, k) in all {
                    let other = &faces[*other as usize];
                    if smooth(own, other) {
                        let angle = other.angles[usize::from(*k)];
                        sum = [0, 1, 2].map(|i| sum[i] + angle * other.normal[i]);
                    }
                }
            }
            let mut normal = normalized(sum);
            if dot(normal, normal) < 0.5 {
                normal = own.normal;
            }
            if dot(normal, normal) > 0.5 {
                corner.normal = Some(normal.map(|component| component as f32));
            }
        }
    }
    count
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::Corner;

    /// Two quads of two triangles each that meet at an angle along the y axis.
    fn roof(degrees: f32, smoothing: [Smoothing; 2]) -> Vec<Part> {
        let (sin, cos) = degrees.to_radians().sin_cos();
        let corner = |position| Corner { position, uv: None, normal: None, color: None };
        let quad = |a, b, c, d, smoothing| {
            [[a, b, c], [a, c, d]].map(|corners| Triangle { corners: corners.map(corner), smoothing })
        };
        let (o, y) = ([0.0; 3], [0.0, 1.0, 0.0]);
        let left = quad([-1.0, 0.0, 0.0], o, y, [-1.0, 1.0, 0.0], smoothing[0]);
        let right = quad(o, [cos, 0.0, -sin], [cos, 1.0, -sin], y, smoothing[1]);
        vec![Part { name: String::new(), material: 0, triangles: [left, right].concat() }]
    }

    fn at_edge(mut parts: Vec<Part>, crease: f64) -> [f32; 3] {
        assert_eq!(complete(&mut parts, crease), 12);
        parts[0].triangles[0].corners[1].normal.expect("it was missing")
    }

    #[test]
    fn a_crease_parts_what_meets_at_more_than_its_angle() {
        let half = 15.0_f32.to_radians();
        let by_angle = [Smoothing::ByAngle; 2];
        let near = |a: [f32; 3], b: [f32; 3]| a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-6);
        // The diagonals of the quads do not matter: the weights are angles.
        assert!(near(at_edge(roof(30.0, by_angle), 30.0), [half.sin(), 0.0, half.cos()]));
        assert!(near(at_edge(roof(30.0, by_angle), 29.0), [0.0, 0.0, 1.0]));
        let groups = |a, b| [Smoothing::Group(a), Smoothing::Group(b)];
        assert!(near(at_edge(roof(90.0, groups(1, 1)), 10.0), [0.5_f32.sqrt(), 0.0, 0.5_f32.sqrt()]));
        assert!(near(at_edge(roof(20.0, groups(1, 2)), 90.0), [0.0, 0.0, 1.0]));
        assert!(near(at_edge(roof(20.0, [Smoothing::Flat; 2]), 90.0), [0.0, 0.0, 1.0]));
    }
}
