//! Composition of poses, and the inverse of a pose.
//!
//! - In: one pose or two, with any numbers in their fields.
//! - Out: a pose, its elements rounded to their formats and saturated where they are too large.
//! - Assumes: nothing.
//!
//! A pose takes p to R·S·p + t: scales S along the axes of the mesh, then a matrix R, then a translation t. The product of
//! two such maps, and the inverse of one, is again a matrix M and a translation, but M is seldom scales and then a rotation.
//! So R may be any matrix with columns of length 1: every M is such an R times S, the lengths of M's own columns.

use super::matrix::{bits, column_of, dot, round14, saturated};
use super::scale::{product, quotient, scale_of_bits};
use super::unit::{length, normalized};
use super::{Pose, Vec3};
use crate::num::{I2F14, U10F22, shift_round, wide};
use core::ops::Mul;

impl Pose {
    /// The composition of two poses: this one first, then `outer`. As an operator it is `outer * self`.
    ///
    /// If `self` is a child's pose in its parent and `outer` the parent's in the world, the result is the child's in the
    /// world. That holds for every pair of poses, but for rounding.
    ///
    /// If `outer` has the same scale along all axes, each element, scale and coordinate is rounded once, and saturates. The
    /// result's `rotation` is a rotation if both are.
    ///
    /// If its scales differ, they shear a child that is turned in its parent (except by quarter turns about the axes). No
    /// scales followed by a rotation do that. The result's `rotation` then is none: its columns are the sheared axes, of
    /// length 1 but not at right angles. Its `scale` has their lengths, within 2⁻²⁷ of themselves and one
    /// last bit. Such a pose draws, lights, transforms, composes and inverts as exactly as any other, as long as its columns
    /// differ by enough of their 14 fraction bits. [`Pose::quaternion`] gives the nearest rotation.
    #[must_use]
    pub const fn then(self, outer: Self) -> Self {
        let (mut rotation, mut scale) = (outer.rotation, self.scale);
        let stretch = [outer.scale[0].to_bits(), outer.scale[1].to_bits(), outer.scale[2].to_bits()];
        let is_even = stretch[0] == stretch[1] && stretch[1] == stretch[2];
        let mut column = 0;
        while column < 3 {
            let axis = column_of(&self.rotation, column);
            // A column of S_outer·R: 36 fraction bits, below 2⁴⁸.
            let stretched = [
                axis[0] as i64 * stretch[0] as i64,
                axis[1] as i64 * stretch[1] as i64,
                axis[2] as i64 * stretch[2] as i64,
            ];
            // The column's direction, how many fraction bits that has, and its length with 22: as they are if the scales are
            // one, since then the length is the scale.
            let (axis, fraction_bits, by) = match normalized(stretched) {
                Some(axis) if !is_even => (axis, 30, shift_round(length(stretched) as i64, 14) as u64),
                _ => (axis, 14, if is_even { stretch[0] as u64 } else { 0 }),
            };
            let mut row = 0;
            while row < 3 {
                rotation[row][column] = round14(dot(bits(outer.rotation[row]), axis), fraction_bits);
                row += 1;
            }
            scale[column] = product(by, scale[column].to_bits());
            column += 1;
        }
        Self { rotation, scale, translation: outer.transform_point(self.translation) }
    }

    /// The pose that undoes this one, as far as the formats allow.
    ///
    /// For a pose that keeps angles (the same scale along all axes, and a rotation or reflection) it has the transposed
    /// matrix, the reciprocal of the scale, and the translation that takes this pose's back to the origin.
    /// The product of both matrices differs from the identity by less than 2.3 · 2⁻¹⁴ per element. The reciprocal is rounded
    /// to 2⁻²² (for a scale of 1000 that is 2⁻¹³ of it). It saturates for scales below 2⁻¹⁰, and for 0, which has no inverse.
    /// The translation saturates beyond ±32768.
    ///
    /// For any other pose it is the inverse matrix in the form that [`Pose::then`] describes. `rotation` has its columns, of
    /// length 1, each element within 0.501 · 2⁻¹⁴; it is no rotation if axes of different scales were turned. `scale` has the
    /// lengths of the columns, within 2⁻²⁷ of themselves and one last bit. A pose without inverse (a scale is
    /// 0, or the matrix is flat) gets the largest scale, as does one whose inverse is too large.
    #[must_use]
    pub const fn inverse(self) -> Self {
        let (rotation, scale) =
            if self.keeps_angles() { self.transposed() } else { self.inverse_of_any_matrix() };
        let back = Self { rotation, scale, translation: Vec3::ZERO };
        let [x, y, z] = back.placed(self.translation);
        Self { translation: saturated([-x, -y, -z]), ..back }
    }

    /// The inverse's rotation and scale, for a pose that keeps angles.
    const fn transposed(&self) -> ([[I2F14; 3]; 3], [U10F22; 3]) {
        let mut rotation = self.rotation;
        let mut i = 0;
        while i < 9 {
            rotation[i / 3][i % 3] = self.rotation[i % 3][i / 3];
            i += 1;
        }
        let scale = self.scale[0].to_bits() as u64;
        let reciprocal = match ((1u64 << 44) + scale / 2).checked_div(scale) {
            Some(reciprocal) => reciprocal,
            None => u64::MAX,
        };
        (rotation, [scale_of_bits(reciprocal); 3])
    }

    /// The inverse's rotation and scale, for any pose: S⁻¹·R⁻¹, where R⁻¹ = cof(R)ᵀ/det(R). So column j has the elements
    /// cof(R)ⱼᵢ / (scaleᵢ · det(R)).
    const fn inverse_of_any_matrix(&self) -> ([[I2F14; 3]; 3], [U10F22; 3]) {
        let cofactors = self.cofactors();
        let determinant = dot(bits(self.rotation[0]), cofactors[0]); // 42 fraction bits, below 2⁴⁸
        // 1/scale = reciprocals · 2^(33 − zeros) / 2⁴⁰, each of 31 bits. A scale of 0 counts as 2⁻²².
        let (mut reciprocals, mut zeros) = ([0i32; 3], [0u32; 3]);
        let mut i = 0;
        while i < 3 {
            let scale = self.scale[i].to_bits() as u64;
            let reciprocal = (1u64 << 62) / if scale > 0 { scale } else { 1 };
            zeros[i] = reciprocal.leading_zeros();
            reciprocals[i] = ((reciprocal << zeros[i]) >> 33) as i32;
            i += 1;
        }
        let (mut rotation, mut scale) = (self.rotation, self.scale);
        let mut column = 0;
        while column < 3 {
            // cof(R)ⱼᵢ/scaleᵢ, below 2⁶². Each has a unit of its own, 2^−zeros; all are shifted to the largest one, that of
            // the least zeros.
            let (mut v, mut unit) = ([0; 3], 33);
            i = 0;
            while i < 3 {
                v[i] = wide(cofactors[column][i], reciprocals[i]);
                unit = if v[i] != 0 && zeros[i] < unit { zeros[i] } else { unit };
                i += 1;
            }
            i = 0;
            while i < 3 {
                v[i] >>= if v[i] != 0 { zeros[i] - unit } else { 0 };
                i += 1;
            }
            // The column is v · 2^(7 − unit) / determinant, both as integers: 28 fraction bits of v's cofactors and 40 − 33 +
            // `unit` of its reciprocals, against 42 of the determinant.
            let axis = match normalized(v) {
                Some(axis) => axis,
                None => [0; 3],
            };
            i = 0;
            while i < 3 {
                let component = if determinant < 0 { -axis[i] } else { axis[i] };
                rotation[i][column] = round14(component as i64, 16);
                i += 1;
            }
            scale[column] = quotient(length(v), determinant.unsigned_abs(), 29 - unit as i32);
            column += 1;
        }
        (rotation, scale)
    }
}

/// Composition, the right one first: `parent * child` is `child.then(parent)`.
impl Mul for Pose {
    type Output = Self;
    fn mul(self, child: Self) -> Self {
        child.then(self)
    }
}
