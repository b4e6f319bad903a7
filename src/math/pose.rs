//! Where a mesh or a camera stands.

use super::{Turn, Vec3};
use crate::num::{I2F14, U10F22, bits_from_f32};

/// A rotation, one scale for all axes, and a translation, applied in this order.
///
/// The rotation matrix is held row by row: row 0 gives the new x. Turning a pose rounds each
/// element to 2⁻¹⁴, so build the pose of each frame anew from angles instead of turning
/// the last one a little further.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Pose {
    /// Rows of the rotation matrix.
    pub rotation: [[I2F14; 3]; 3],
    /// The size of one mesh unit in the world.
    pub scale: U10F22,
    /// Where the origin of the mesh goes.
    pub translation: Vec3,
}

impl Pose {
    /// Leaves everything where it is.
    pub const IDENTITY: Self = Self {
        rotation: [
            [I2F14::ONE, I2F14::ZERO, I2F14::ZERO],
            [I2F14::ZERO, I2F14::ONE, I2F14::ZERO],
            [I2F14::ZERO, I2F14::ZERO, I2F14::ONE],
        ],
        scale: U10F22::ONE,
        translation: Vec3::ZERO,
    };

    /// The same, turned about the world's x axis: y turns towards z. The translation stays.
    #[must_use]
    pub const fn rotated_x(self, turn: Turn) -> Self {
        self.rotated(1, 2, turn)
    }

    /// The same, turned about the world's y axis: z turns towards x. The translation stays.
    #[must_use]
    pub const fn rotated_y(self, turn: Turn) -> Self {
        self.rotated(2, 0, turn)
    }

    /// The same, turned about the world's z axis: x turns towards y. The translation stays.
    #[must_use]
    pub const fn rotated_z(self, turn: Turn) -> Self {
        self.rotated(0, 1, turn)
    }

    /// The same, with the mesh's origin at `translation`.
    #[must_use]
    pub const fn at(self, translation: Vec3) -> Self {
        Self { translation, ..self }
    }

    /// The same, with one mesh unit `scale` long.
    #[must_use]
    pub const fn scaled(self, scale: U10F22) -> Self {
        Self { scale, ..self }
    }

    /// As [`Pose::scaled`], from a literal: saturated to 0 … 512, 0 for NaN.
    #[must_use]
    pub const fn scaled_lit(self, scale: f32) -> Self {
        let bits = bits_from_f32(scale, 22);
        self.scaled(U10F22::from_bits(if bits < 0 { 0 } else { bits as u32 }))
    }

    /// Rows `a` and `b` mixed by the turn from axis `a` towards axis `b`.
    const fn rotated(mut self, a: usize, b: usize, turn: Turn) -> Self {
        let (sin, cos) = (turn.sin().to_bits() as i32, turn.cos().to_bits() as i32);
        let mut i = 0;
        while i < 3 {
            let (p, q) = (self.rotation[a][i].to_bits() as i32, self.rotation[b][i].to_bits() as i32);
            self.rotation[a][i] = round14(p as i64 * cos as i64 - q as i64 * sin as i64);
            self.rotation[b][i] = round14(p as i64 * sin as i64 + q as i64 * cos as i64);
            i += 1;
        }
        self
    }
}

impl Default for Pose {
    fn default() -> Self {
        Self::IDENTITY
    }
}

/// A sum of products with 28 fraction bits as an `I2F14`, rounded and saturated.
pub(crate) const fn round14(sum: i64) -> I2F14 {
    let rounded = (sum + (1 << 13)) >> 14;
    I2F14::from_bits(if rounded > i16::MAX as i64 {
        i16::MAX
    } else if rounded < i16::MIN as i64 {
        i16::MIN
    } else {
        rounded as i16
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn turns_are_right_handed() {
        let quarter = Turn::from_degrees(90);
        // A turn about x takes y to z: the column of y is (0, 0, 1).
        assert_eq!(Pose::IDENTITY.rotated_x(quarter).rotation[2][1], 1);
        assert_eq!(Pose::IDENTITY.rotated_y(quarter).rotation[0][2], 1);
        assert_eq!(Pose::IDENTITY.rotated_z(quarter).rotation[1][0], 1);
    }
}
