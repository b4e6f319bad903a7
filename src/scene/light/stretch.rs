//! Light on a mesh whose pose does not keep angles: places and normals of the mesh are brought to the axes of the world.
//!
//! Of a pose that scales by S and then takes what is left through a matrix R, a place p goes to R·S·p. What is at right angles to a
//! surface goes to (R·S)⁻ᵀ·n, which is cof(R)·cof(S)·n but for its length, and for its sign if the pose is mirrored: a cofactor
//! matrix needs no division, and there is one of a flat matrix, too.
//!
//! In: the pose, and vectors in the mesh. Out: the same in the axes of the world. All is short of overflowing whatever the numbers.

use super::normal::{Normal, across_face, magnitude, magnitude64};
use crate::math::Pose;
use crate::num::{I4F12, wide};
use core::array;

/// How many bits the largest scale has, at least 1.
fn bits(pose: &Pose) -> u32 {
    32 - magnitude_of_scales(pose).leading_zeros()
}

fn magnitude_of_scales(pose: &Pose) -> u32 {
    pose.scale.iter().fold(1, |all, scale| all | scale.to_bits())
}

/// The unit of [`place`] in units of the world, as log₂: 4 to 8 times the largest scale. So a place has room: no matrix in I2F14
/// makes a vector more than 6 times as long.
pub(super) fn unit_log2(pose: &Pose) -> i32 {
    bits(pose) as i32 - 20
}

/// The scales in a unit in which the largest has 31 bits.
fn scales(pose: &Pose) -> [i32; 3] {
    let bits = bits(pose);
    pose.scale.map(|scale| {
        let scale = scale.to_bits();
        (if bits < 32 { scale << (31 - bits) } else { scale >> 1 }) as i32
    })
}

/// A place of the mesh along the axes of the world, as seen from the mesh's origin, in [its unit](unit_log2), 26 fraction bits.
#[cold]
#[inline(never)]
pub(super) fn place(pose: &Pose, position: [I4F12; 3]) -> [i32; 3] {
    let scales = scales(pose);
    // 15 by 31 bits, to 30.
    let scaled: [i32; 3] = array::from_fn(|i| (wide(position[i].to_bits().into(), scales[i]) >> 16) as i32);
    pose.rotation.map(|row| {
        // Below 2⁴⁶·⁶.
        let sum: i64 = (0..3).map(|i| wide(row[i].to_bits().into(), scaled[i])).sum();
        (sum >> 17) as i32
    })
}

/// A normal of the mesh at right angles to the stretched surface, as long as it was.
#[cold]
#[inline(never)]
pub(super) fn normal(pose: &Pose, normal: Normal) -> Normal {
    across(pose, normal.bits()).times_length_of(normal)
}

/// The normal of a face of the stretched mesh.
#[cold]
#[inline(never)]
pub(super) fn face_normal(pose: &Pose, corners: [[I4F12; 3]; 3]) -> Normal {
    across(pose, across_face(corners))
}

/// The unit vector at right angles to the stretched surface, from any vector at right angles to it in the mesh.
#[inline(never)]
fn across(pose: &Pose, vector: [i32; 3]) -> Normal {
    let scales = scales(pose);
    // The scales of the other two axes, multiplied: 31 bits of the largest, and as fine ones of the others.
    let others: [u64; 3] = array::from_fn(|i| wide(scales[(i + 1) % 3], scales[(i + 2) % 3]).unsigned_abs());
    let zeros = others.iter().fold(1, |all, product| all | product).leading_zeros();
    let scaled = array::from_fn(|i| wide(vector[i], ((others[i] << zeros) >> 33) as i32));
    // 15 bits.
    let excess = 49 - magnitude64(scaled).leading_zeros() as i32;
    let scaled = scaled.map(|at| {
        (if excess > 0 { ((at >> (excess - 1)) + 1) >> 1 } else { at << (-excess).min(63) }) as i32
    });

    let cofactors = pose.cofactors();
    let all = magnitude(array::from_fn(|i| magnitude(cofactors[i]) as i32));
    // 14 bits, or 15 after rounding.
    let excess = 18 - all.leading_zeros() as i32;
    let sign = if pose.is_mirrored() { -1 } else { 1 };
    Normal::along(cofactors.map(|row| {
        // Below 3 · 2¹⁵ · 2¹⁴ < 2³¹.
        let sum: i32 = (0..3)
            .map(|i| {
                let cofactor = row[i];
                let cofactor = if excess > 0 {
                    ((cofactor >> (excess - 1)) + 1) >> 1
                } else {
                    cofactor << -excess.max(-31)
                };
                cofactor * scaled[i]
            })
            .sum();
        sum * sign
    }))
}
