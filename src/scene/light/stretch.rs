//! Light on a mesh whose pose does not keep angles: places and normals of the mesh are brought to the axes of the world.
//!
//! Of a pose that scales by S and then takes what is left through a matrix R, a place p goes to R·S·p. What is at right angles to a
//! surface goes to (R·S)⁻ᵀ·n, which is cof(R)·cof(S)·n but for its length, and for its sign if the pose is mirrored: a cofactor
//! matrix needs no division, and there is one of a flat matrix, too.
//!
//! In: the pose, and vectors in the mesh. Out: the same in the axes of the world. All is short of overflowing whatever the numbers.

use super::normal::{Normal, magnitude64};
use crate::math::{Pose, dot};
use crate::num::{I4F12, wide};
use core::array;

/// How many bits the largest scale has, at least 1.
fn bits(pose: &Pose) -> u32 {
    32 - pose.scale.iter().fold(1, |all, scale| all | scale.to_bits()).leading_zeros()
}

/// The unit of [`place`] in units of the world, as log₂: 4 to 8 times the largest scale. So a place has room: no matrix in I2F14
/// makes a vector more than 6 times as long.
pub(super) fn unit_log2(pose: &Pose) -> i32 {
    bits(pose) as i32 - 20
}

/// The scales in a unit in which the largest has 31 bits.
#[inline(never)]
fn scales(pose: &Pose) -> [i32; 3] {
    let bits = bits(pose);
    pose.scale.map(|scale| (scale.to_bits() << (32 - bits) >> 1) as i32)
}

/// A place of the mesh along the axes of the world, as seen from the mesh's origin, in [its unit](unit_log2), 26 fraction bits.
#[cold]
#[inline(never)]
pub(super) fn place(pose: &Pose, position: [I4F12; 3]) -> [i32; 3] {
    let scales = scales(pose);
    // 15 by 31 bits, to 30.
    let scaled = array::from_fn(|i| (wide(position[i].to_bits().into(), scales[i]) >> 16) as i32);
    // Below 2⁴⁶·⁶, to 2²⁹·⁶.
    pose.rotation.map(|row| (dot(row.map(|element| element.to_bits().into()), scaled) >> 17) as i32)
}

/// A normal of the mesh at right angles to the stretched surface, as long as it was.
#[cold]
#[inline(never)]
pub(super) fn normal(pose: &Pose, normal: Normal) -> Normal {
    across(pose, normal.bits()).times_length_of(normal)
}

/// The unit vector at right angles to the stretched surface, from any vector at right angles to it in the mesh.
#[cold]
#[inline(never)]
pub(super) fn across(pose: &Pose, vector: [i32; 3]) -> Normal {
    let [x, y, z] = scales(pose);
    // cof(S): the scales of the other two axes, multiplied; 30 bits of the largest, and as fine ones of the others.
    let others = shortened([wide(y, z), wide(z, x), wide(x, y)], 30);
    let scaled = shortened(array::from_fn(|i| wide(vector[i], others[i])), 30);
    // Below 2⁶³: see `dot`.
    let turned = pose.cofactors().map(|row| dot(scaled, row));
    let outwards = if pose.is_mirrored() { turned.map(|component| -component) } else { turned };
    Normal::along(shortened(outwards, 30))
}

/// The same direction in a unit in which the largest component has so many bits (or, as it is rounded, is one more).
#[inline(never)]
fn shortened(vector: [i64; 3], bits: i32) -> [i32; 3] {
    let excess = 64 - magnitude64(vector).leading_zeros() as i32 - bits;
    vector
        .map(|at| (if excess > 0 { ((at >> (excess - 1)) + 1) >> 1 } else { at << -excess.max(-63) }) as i32)
}
