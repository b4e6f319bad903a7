//! Where a mesh or a camera stands.

use super::{Quaternion, Turn, Vec3};
use crate::num::{I2F14, I16F16, U10F22, bits_or_max, shift_round, wide};
use core::fmt;
use core::ops::Mul;

/// A rotation, one scale for all axes, and a translation, applied in this order.
///
/// The rotation matrix is held row by row: row 0 gives the new x. Turning a pose rounds each
/// element to 2⁻¹⁴, so build the pose of each frame anew from angles or a [`Quaternion`] instead of turning
/// the last one a little further, or make it good with [`Pose::orthonormalized`].
///
/// The fields may hold any numbers: nothing here panics or wraps, results that are too large saturate.
///
/// ```
/// use fixel::{Pose, Quaternion, Turn, Vec3};
/// let arm = Pose::from_euler(Turn::from_degrees(90), Turn::ZERO, Turn::ZERO).at(Vec3::lit(0.0, 2.0, 0.0));
/// let hand = Pose::IDENTITY.scaled_lit(0.5).at(Vec3::lit(0.0, 0.0, -3.0));
/// let hand = arm * hand; // what was placed on the arm is placed in the world
/// assert_eq!(hand.translation, Vec3::lit(-3.0, 2.0, 0.0));
/// assert_eq!(hand.inverse().transform_point(hand.translation), Vec3::ZERO);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Pose {
    /// Rows of the rotation matrix.
    pub rotation: [[I2F14; 3]; 3],
    /// The size of one mesh unit in the world: 10⁻³ has 12 significant bits, 1 has 22, 10³ has 32.
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

    /// A rotation alone: each element within 0.501 · 2⁻¹⁴.
    #[must_use]
    pub const fn from_quaternion(quaternion: Quaternion) -> Self {
        Self { rotation: quaternion.rotation(), ..Self::IDENTITY }
    }

    /// A right-handed rotation about an axis of any length: each element within 0.501 · 2⁻¹⁴. The
    /// zero axis gives [`Pose::IDENTITY`].
    #[must_use]
    pub const fn from_axis_turn(axis: Vec3, turn: Turn) -> Self {
        Self::from_quaternion(Quaternion::from_axis_turn(axis, turn))
    }

    /// Roll about z, then pitch about x, then yaw about y, all three axes those of the world, as
    /// [`Quaternion::from_euler`]: each element within 0.501 · 2⁻¹⁴.
    #[must_use]
    pub const fn from_euler(yaw: Turn, pitch: Turn, roll: Turn) -> Self {
        Self::from_quaternion(Quaternion::from_euler(yaw, pitch, roll))
    }

    /// The same, turned about the world's x axis: y turns towards z. The translation stays.
    #[must_use]
    pub const fn rotated_x(self, turn: Turn) -> Self {
        self.mixed(1, 2, turn)
    }

    /// The same, turned about the world's y axis: z turns towards x. The translation stays.
    #[must_use]
    pub const fn rotated_y(self, turn: Turn) -> Self {
        self.mixed(2, 0, turn)
    }

    /// The same, turned about the world's z axis: x turns towards y. The translation stays.
    #[must_use]
    pub const fn rotated_z(self, turn: Turn) -> Self {
        self.mixed(0, 1, turn)
    }

    /// The same, turned about the world's origin: `quaternion` after what was there. The translation stays.
    /// Each element is rounded once, to 2⁻¹⁴.
    #[must_use]
    pub const fn rotated(mut self, quaternion: Quaternion) -> Self {
        let turn = quaternion.matrix();
        let old = self.rotation;
        let mut i = 0;
        while i < 9 {
            let (row, column) = (i / 3, i % 3);
            // 30 and 14 fraction bits, down to 28.
            let sum = dot(turn[row], column_of(&old, column));
            self.rotation[row][column] = round14(shift_round(sum, 16));
            i += 1;
        }
        self
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

    /// As [`Pose::scaled`], from a literal: 0 or more and below 1024, rounded to 2⁻²². In a `const` or `static` one outside
    /// that, or NaN, is a compile error:
    ///
    /// ```compile_fail,E0080
    /// # use fixel::Pose;
    /// const HUGE: Pose = Pose::IDENTITY.scaled_lit(5000.0);
    /// # let _ = HUGE;
    /// ```
    ///
    /// # Panics
    ///
    /// Elsewhere it panics then. See [`Pose::try_scaled_lit`].
    #[must_use]
    #[inline]
    #[track_caller]
    pub const fn scaled_lit(self, scale: f32) -> Self {
        match self.try_scaled_lit(scale) {
            Ok(pose) => pose,
            Err(_) => panic!("the scale of a pose is not a number of 0 or more and below 1024"),
        }
    }

    /// As [`Pose::scaled_lit`], for numbers that come at run time; in software where there is no FPU.
    ///
    /// # Errors
    ///
    /// [`ScaleError`] for a scale that is negative, 1024 or more, or NaN.
    #[inline]
    pub const fn try_scaled_lit(self, scale: f32) -> Result<Self, ScaleError> {
        let bits = bits_or_max(scale, 22);
        if bits < 0 || bits > u32::MAX as i64 {
            return Err(ScaleError { scale });
        }
        Ok(self.scaled(U10F22::from_bits(bits as u32)))
    }

    /// This pose first, then `outer`; as an operator `outer * self`.
    ///
    /// A child's pose in its parent, then the parent's in the world, is the child's in the world. Each
    /// element, the scale and each coordinate are rounded once, and saturate.
    #[must_use]
    pub const fn then(self, outer: Self) -> Self {
        let mut rotation = outer.rotation;
        let mut i = 0;
        while i < 9 {
            rotation[i / 3][i % 3] =
                round14(dot(bits(outer.rotation[i / 3]), column_of(&self.rotation, i % 3)));
            i += 1;
        }
        // 44 fraction bits; the whole product is below 2⁶⁴, with the rounding too.
        let scale = self.scale.to_bits() as u64 * outer.scale.to_bits() as u64;
        let scale = (scale + (1 << 21)) >> 22;
        Self {
            rotation,
            scale: U10F22::from_bits(if scale > u32::MAX as u64 { u32::MAX } else { scale as u32 }),
            translation: outer.transform_point(self.translation),
        }
    }

    /// The pose that undoes this one, as far as formats go: the rotation transposed, the scale's reciprocal,
    /// and the translation that takes this one's back to the origin.
    ///
    /// Together they turn by less than 2.3 · 2⁻¹⁴ per element. The reciprocal is rounded to 2⁻²² (for a
    /// scale of 1000 that is 2⁻¹³ of it) and saturates for scales below 2⁻¹⁰, also for 0,
    /// which has no inverse; the translation saturates where it is beyond ±32768. The rotation must be one: see
    /// [`Pose::orthonormalized`].
    #[must_use]
    pub const fn inverse(self) -> Self {
        let mut rotation = self.rotation;
        let mut i = 0;
        while i < 9 {
            rotation[i / 3][i % 3] = self.rotation[i % 3][i / 3];
            i += 1;
        }
        let scale = self.scale.to_bits() as u64;
        let reciprocal = match ((1u64 << 44) + scale / 2).checked_div(scale) {
            Some(reciprocal) => reciprocal,
            None => u64::MAX,
        };
        let scale =
            U10F22::from_bits(if reciprocal > u32::MAX as u64 { u32::MAX } else { reciprocal as u32 });
        let back = Self { rotation, scale, translation: Vec3::ZERO };
        let [x, y, z] = back.placed(self.translation);
        Self { translation: saturated([-x, -y, -z]), ..back }
    }

    /// Where a point goes: turned, scaled, moved. Rounded once, from exact, to 2⁻¹⁶; saturated.
    ///
    /// 15 multiplications. Meshes have their own, quicker way.
    #[must_use]
    pub const fn transform_point(&self, point: Vec3) -> Vec3 {
        let [x, y, z] = self.placed(point);
        let to = self.translation.bits();
        saturated([x + to[0] as i64, y + to[1] as i64, z + to[2] as i64])
    }

    /// Where a direction points: turned, but neither scaled nor moved. Rounded once, from exact, to
    /// 2⁻¹⁶; saturated.
    #[must_use]
    pub const fn transform_direction(&self, direction: Vec3) -> Vec3 {
        let [x, y, z] = self.turned(direction);
        saturated([shift_round(x, 14), shift_round(y, 14), shift_round(z, 14)])
    }

    /// The pose between `self` (at t = 0 or less) and `other` (at 1 or more), both ends exact: the
    /// rotation by [`Quaternion::slerp`], at constant speed the shorter way, scale and translation in a straight line.
    ///
    /// An element of the rotation is within 2 · 2⁻¹⁴ of the slerp between the exact rotations that both matrices
    /// were rounded from; scale and translation within half a bit. Both matrices are made quaternions here, at four square
    /// roots and sixteen 64-bit divisions: where that counts, keep quaternions in the keyframes.
    #[must_use]
    pub const fn interpolate(&self, other: &Self, t: I16F16) -> Self {
        if t.to_bits() <= 0 {
            return *self;
        } else if t.to_bits() >= 1 << 16 {
            return *other;
        }
        let (from, to) = (self.translation.bits(), other.translation.bits());
        let (small, large) = (self.scale.to_bits() as i64, other.scale.to_bits() as i64);
        Self {
            rotation: self.quaternion().slerp(other.quaternion(), t).rotation(),
            scale: U10F22::from_bits(between(small, large, t) as u32),
            translation: saturated([
                between(from[0] as i64, to[0] as i64, t),
                between(from[1] as i64, to[1] as i64, t),
                between(from[2] as i64, to[2] as i64, t),
            ]),
        }
    }

    /// The same with the rotation that is nearest to its matrix: each element within 0.501 · 2⁻¹⁴ of
    /// an exact one. Makes good what many turns have worn off; numbers that are no rotation at all become some rotation.
    #[must_use]
    pub const fn orthonormalized(self) -> Self {
        Self { rotation: self.quaternion().rotation(), ..self }
    }

    /// The rotation as a quaternion, as [`Quaternion::from_rotation`].
    #[must_use]
    pub const fn quaternion(&self) -> Quaternion {
        Quaternion::from_rotation(&self.rotation)
    }

    /// Turned: 30 fraction bits, below 2⁴⁸.
    const fn turned(&self, point: Vec3) -> [i64; 3] {
        let point = point.bits();
        [
            dot(bits(self.rotation[0]), point),
            dot(bits(self.rotation[1]), point),
            dot(bits(self.rotation[2]), point),
        ]
    }

    /// Turned and scaled: 16 fraction bits, rounded, below 2⁴⁵.
    const fn placed(&self, point: Vec3) -> [i64; 3] {
        let mut placed = self.turned(point);
        let scale = self.scale.to_bits() as i64;
        let mut i = 0;
        while i < 3 {
            // 30 and 22 fraction bits, down to 16: in two parts, as the whole product has 80 bits.
            let (high, low) = (placed[i] >> 24, placed[i] & 0xff_ffff);
            placed[i] = shift_round(high * scale + ((low * scale) >> 24), 12);
            i += 1;
        }
        placed
    }

    /// Rows `a` and `b` mixed by the turn from axis `a` towards axis `b`.
    const fn mixed(mut self, a: usize, b: usize, turn: Turn) -> Self {
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

/// A scale that a [`Pose`] cannot have: it is not a number of 0 or more and below 1024.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ScaleError {
    /// What was given.
    pub scale: f32,
}

impl fmt::Display for ScaleError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "the scale of a pose is not a number of 0 or more and below 1024: {}", self.scale)
    }
}

impl core::error::Error for ScaleError {}

impl Default for Pose {
    fn default() -> Self {
        Self::IDENTITY
    }
}

/// The right one first: `parent * child` is `child.then(parent)`.
impl Mul for Pose {
    type Output = Self;
    fn mul(self, child: Self) -> Self {
        child.then(self)
    }
}

const fn bits(row: [I2F14; 3]) -> [i32; 3] {
    [row[0].to_bits() as i32, row[1].to_bits() as i32, row[2].to_bits() as i32]
}

const fn column_of(rows: &[[I2F14; 3]; 3], column: usize) -> [i32; 3] {
    bits([rows[0][column], rows[1][column], rows[2][column]])
}

/// Below 2⁶³, as one factor of each product is at most 2³⁰.
const fn dot(a: [i32; 3], b: [i32; 3]) -> i64 {
    wide(a[0], b[0]) + wide(a[1], b[1]) + wide(a[2], b[2])
}

/// a + (b − a) · t, rounded, for a `t` of 0 … 1 and numbers below 2³³.
const fn between(a: i64, b: i64, t: I16F16) -> i64 {
    a + shift_round((b - a) * t.to_bits() as i64, 16)
}

const fn saturated(v: [i64; 3]) -> Vec3 {
    const fn coordinate(bits: i64) -> I16F16 {
        I16F16::from_bits(if bits > i32::MAX as i64 {
            i32::MAX
        } else if bits < i32::MIN as i64 {
            i32::MIN
        } else {
            bits as i32
        })
    }
    Vec3::new(coordinate(v[0]), coordinate(v[1]), coordinate(v[2]))
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
#[expect(clippy::float_arithmetic, reason = "the f64 truth of the tests")]
mod tests;
