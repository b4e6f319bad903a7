//! Poses one after the other, and the pose that undoes one.

use super::matrix::{bits, column_of, dot, round14, saturated};
use super::scale::{product, quotient, scale_of_bits};
use super::unit::{length, normalized};
use super::{Pose, Vec3};
use crate::num::{I2F14, U10F22, shift_round, wide};
use core::ops::Mul;

impl Pose {
    /// This pose first, then `outer`; as an operator `outer * self`.
    ///
    /// A child's pose in its parent, then the parent's in the world, is the child's in the world: for every pair of poses, but for
    /// rounding.
    ///
    /// If `outer` has one scale for all axes, each element, each scale and each coordinate are rounded once, and saturate. The
    /// result's rotation is a rotation if both are.
    ///
    /// If not, a child that is turned in its parent is sheared by the parent's stretch (but where it is turned by quarters
    /// about the axes): no scales and no rotation make that. The result then has the sheared axes in its `rotation`, as
    /// columns of length 1 that are not at right angles, and their lengths, within 2⁻²⁷ of themselves and a bit, in its `scale`.
    /// It draws, lights, transforms, composes and inverts as exactly as any other, as far as its elements of 14 bits tell columns
    /// from each other; what asks for [the rotation itself](Pose::quaternion) gets the nearest.
    #[must_use]
    pub const fn then(self, outer: Self) -> Self {
        let (mut rotation, mut scale) = (outer.rotation, self.scale);
        let stretch = [outer.scale[0].to_bits(), outer.scale[1].to_bits(), outer.scale[2].to_bits()];
        let is_even = stretch[0] == stretch[1] && stretch[1] == stretch[2];
        let mut column = 0;
        while column < 3 {
            let axis = column_of(&self.rotation, column);
            // 36 fraction bits, below 2⁴⁸.
            let stretched = [
                axis[0] as i64 * stretch[0] as i64,
                axis[1] as i64 * stretch[1] as i64,
                axis[2] as i64 * stretch[2] as i64,
            ];
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

    /// The pose that undoes this one, as far as formats go.
    ///
    /// Of a pose that keeps angles (one scale for all axes, and a rotation) it is the rotation transposed, the scale's
    /// reciprocal, and the translation that takes this one's back to the origin.
    /// Together they turn by less than 2.3 · 2⁻¹⁴ per element. The reciprocal is rounded to 2⁻²² (for a
    /// scale of 1000 that is 2⁻¹³ of it) and saturates for scales below 2⁻¹⁰, also for 0,
    /// which has no inverse; the translation saturates where it is beyond ±32768.
    ///
    /// Of any other it is the inverse matrix, as [`Pose::then`] has it: columns of length 1, each element within 0.501 · 2⁻¹⁴, in
    /// `rotation`, which is none if axes of different scales were turned; their lengths within 2⁻²⁷ of themselves and a bit in
    /// `scale`. What has no inverse (a scale of 0, a matrix that is flat) or one too large gets the largest scale.
    #[must_use]
    pub const fn inverse(self) -> Self {
        let (rotation, scale) =
            if self.keeps_angles() { self.transposed() } else { self.inverse_of_any_matrix() };
        let back = Self { rotation, scale, translation: Vec3::ZERO };
        let [x, y, z] = back.placed(self.translation);
        Self { translation: saturated([-x, -y, -z]), ..back }
    }

    /// The inverse's rotation and scale, if this is a rotation and one scale.
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

    /// The inverse's rotation and scale: rows of cofactors as columns, divided by the determinant, and each row by a scale.
    const fn inverse_of_any_matrix(&self) -> ([[I2F14; 3]; 3], [U10F22; 3]) {
        let cofactors = self.cofactors();
        let determinant = dot(bits(self.rotation[0]), cofactors[0]); // 42 fraction bits, below 2⁴⁸
        // 2⁴⁰ times reciprocals are 31 bits times 2^(33 − zeros).
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
            // Below 2⁶², in the largest unit of those that are not 0.
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
            // The column is v · 2^(7 − unit) / determinant.
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

/// The right one first: `parent * child` is `child.then(parent)`.
impl Mul for Pose {
    type Output = Self;
    fn mul(self, child: Self) -> Self {
        child.then(self)
    }
}
