//! Where a mesh or a camera stands.

use super::matrix::{
    bits, column_of, cross, dot, off, round14, round14_short, saturated, turned_round, wrapping_dot,
};
use super::scale::{ScaleError, scale_of};
use super::{Quaternion, Turn, Vec3};
use crate::num::{I2F14, I16F16, U10F22, shift_round};
use core::hint::black_box;

/// A scale for each axis of the mesh, a rotation, and a translation, applied in this order.
///
/// The rotation matrix is held row by row: row 0 gives the new x. Turning a pose rounds each
/// element to 2⁻¹⁴, so build the pose of each frame anew from angles or a [`Quaternion`] instead of turning
/// the last one a little further, or make it good with [`Pose::orthonormalized`].
///
/// The fields may hold any numbers: nothing here panics or wraps, results that are too large saturate.
///
/// # Mirrored, stretched, sheared
///
/// `rotation` may be any matrix. A mesh is then drawn, culled and lit as that matrix says:
///
/// - With a column turned round (each element negated) it is the mirror image, and what was the front is the front:
///   [`Pose::is_mirrored`].
/// - With axes of different scale, or a matrix that is no rotation, light falls on the surface as it lies in the world (its normals
///   are those of the stretched surface). This takes some 800 cycles more a vertex that is lit, on a Cortex-M0+; poses that keep
///   angles pay nothing.
///
/// ```
/// use fixel::{Pose, Turn, Vec3};
/// const PILLAR: Pose = Pose::IDENTITY.stretched_lit(0.5, 4.0, 0.5).at(Vec3::lit(0.0, 2.0, -9.0));
/// let fallen = PILLAR.rotated_z(Turn::from_degrees(90)); // as long as before
/// assert_eq!(fallen.transform_point(Vec3::lit(0.0, 1.0, 0.0)), Vec3::lit(-4.0, 2.0, -9.0));
/// ```
///
/// # Parents and children
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
    /// The size of one mesh unit in the world along each axis of the mesh: 10⁻³ has 12 significant bits, 1 has 22, 10³ has 32.
    pub scale: [U10F22; 3],
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
        scale: [U10F22::ONE; 3],
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
            let sum = dot(column_of(&old, column), turn[row]);
            self.rotation[row][column] = round14(sum, 30);
            i += 1;
        }
        self
    }

    /// The same, with the mesh's origin at `translation`.
    #[must_use]
    pub const fn at(self, translation: Vec3) -> Self {
        Self { translation, ..self }
    }

    /// The same, with one mesh unit `scale` long, along all axes.
    #[must_use]
    pub const fn scaled(self, scale: U10F22) -> Self {
        self.stretched([scale; 3])
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
        match scale_of(scale) {
            Some(along_all) => Ok(self.scaled(along_all)),
            None => Err(ScaleError { scale }),
        }
    }

    /// The same, with one unit of the mesh so long along its x, its y and its z axis: these, not the world's, also where the pose is
    /// turned already.
    #[must_use]
    pub const fn stretched(self, scale: [U10F22; 3]) -> Self {
        Self { scale, ..self }
    }

    /// As [`Pose::stretched`], from literals: each 0 or more and below 1024, rounded to 2⁻²². In a `const` or `static` one outside
    /// that, or NaN, is a compile error:
    ///
    /// ```compile_fail,E0080
    /// # use fixel::Pose;
    /// const INSIDE_OUT: Pose = Pose::IDENTITY.stretched_lit(1.0, -1.0, 1.0);
    /// # let _ = INSIDE_OUT;
    /// ```
    ///
    /// # Panics
    ///
    /// Elsewhere it panics then. See [`Pose::try_stretched_lit`].
    #[must_use]
    #[inline]
    #[track_caller]
    pub const fn stretched_lit(self, x: f32, y: f32, z: f32) -> Self {
        match self.try_stretched_lit(x, y, z) {
            Ok(pose) => pose,
            Err(_) => panic!("the scale of a pose is not a number of 0 or more and below 1024"),
        }
    }

    /// As [`Pose::stretched_lit`], for numbers that come at run time; in software where there is no FPU.
    ///
    /// # Errors
    ///
    /// [`ScaleError`] for the first scale that is negative, 1024 or more, or NaN.
    #[inline]
    pub const fn try_stretched_lit(self, x: f32, y: f32, z: f32) -> Result<Self, ScaleError> {
        match (scale_of(x), scale_of(y), scale_of(z)) {
            (Some(along_x), Some(along_y), Some(along_z)) => Ok(self.stretched([along_x, along_y, along_z])),
            (None, ..) => Err(ScaleError { scale: x }),
            (_, None, _) => Err(ScaleError { scale: y }),
            (.., None) => Err(ScaleError { scale: z }),
        }
    }

    /// Whether the pose makes a mirror image of a mesh: whether the determinant of `rotation` is below 0, exactly.
    ///
    /// A mesh is then drawn with its fronts in front, though they run the other way round on the screen. The same goes for the
    /// mirror image that a camera shows whose pose is mirrored; where both are nothing is.
    #[must_use]
    #[inline(never)]
    pub const fn is_mirrored(&self) -> bool {
        let rows = [bits(self.rotation[0]), bits(self.rotation[1]), bits(self.rotation[2])];
        dot(rows[0], cross(rows[1], rows[2])) < 0
    }

    /// Whether what it places keeps its angles.
    pub(crate) const fn keeps_angles(&self) -> bool {
        let [x, y, z] = self.scale;
        x.to_bits() == y.to_bits() && y.to_bits() == z.to_bits() && self.is_orthonormal()
    }

    /// Whether the matrix is a rotation or mirrors one, give or take what turning it a few times takes away: RᵀR is 1 but for
    /// 2⁻¹⁰, summed up over each row.
    #[inline(never)]
    pub(crate) const fn is_orthonormal(&self) -> bool {
        let rotation = &self.rotation;
        let [x, y, z] = [column_of(rotation, 0), column_of(rotation, 1), column_of(rotation, 2)];
        // 28 fraction bits. What wraps is far from 0 and 1 also then: the sums are within ±3 · 2³⁰.
        let [xx, yy, zz] = [wrapping_dot(x, x), wrapping_dot(y, y), wrapping_dot(z, z)];
        let [xx, yy, zz] = [off(xx, 1 << 28), off(yy, 1 << 28), off(zz, 1 << 28)];
        let [xy, yz, zx] =
            [off(wrapping_dot(x, y), 0), off(wrapping_dot(y, z), 0), off(wrapping_dot(z, x), 0)];
        xx.saturating_add(xy).saturating_add(zx) <= 1 << 18
            && yy.saturating_add(xy).saturating_add(yz) <= 1 << 18
            && zz.saturating_add(yz).saturating_add(zx) <= 1 << 18
    }

    /// The transpose of the inverse of the rotation, but for its length: 28 fraction bits. Where the pose is
    /// [mirrored](Pose::is_mirrored) it points the other way.
    pub(crate) const fn cofactors(&self) -> [[i32; 3]; 3] {
        let [x, y, z] = [bits(self.rotation[0]), bits(self.rotation[1]), bits(self.rotation[2])];
        [cross(y, z), cross(z, x), cross(x, y)]
    }

    /// Where a point goes: scaled, turned, moved. Rounded once, from exact, to 2⁻¹⁶; saturated.
    ///
    /// 21 multiplications. Meshes have their own, quicker way.
    #[must_use]
    pub const fn transform_point(&self, point: Vec3) -> Vec3 {
        let [x, y, z] = self.placed(point);
        let to = self.translation.bits();
        saturated([x + to[0] as i64, y + to[1] as i64, z + to[2] as i64])
    }

    /// Where a direction points: turned, but neither scaled nor moved. Rounded once, from exact, to
    /// 2⁻¹⁶; saturated.
    ///
    /// That is how an axis of the mesh lies in the world. A way from one point to another is scaled too: the difference of where
    /// both go. (A surface's normal is neither, if axes have different scales.)
    #[must_use]
    pub const fn transform_direction(&self, direction: Vec3) -> Vec3 {
        let v = direction.bits();
        let [x, y, z] = self.rotation;
        saturated([
            shift_round(dot(bits(x), v), 14),
            shift_round(dot(bits(y), v), 14),
            shift_round(dot(bits(z), v), 14),
        ])
    }

    /// The pose between `self` (at t = 0 or less) and `other` (at 1 or more), both ends exact: the
    /// rotation by [`Quaternion::slerp`], at constant speed the shorter way, scales and translation in a straight line.
    ///
    /// An element of the rotation is within 2 · 2⁻¹⁴ of the slerp between the exact rotations that both matrices
    /// were rounded from; scales and translation within half a bit. Both matrices are made quaternions here, at four square
    /// roots and sixteen 64-bit divisions: where that counts, keep quaternions in the keyframes.
    ///
    /// A mirrored pose counts as a rotation of what has the opposite of its scale along x: between two mirrored poses all are, and
    /// from one to one that is not the mesh grows flat along x and turns inside out. Matrices that are neither a rotation nor
    /// mirror one (of [`Pose::then`], say) count as the nearest that does: then the way begins and ends with a step.
    #[must_use]
    pub const fn interpolate(&self, other: &Self, t: I16F16) -> Self {
        if t.to_bits() <= 0 {
            return *self;
        } else if t.to_bits() >= 1 << 16 {
            return *other;
        }
        let (from, to) = (self.translation.bits(), other.translation.bits());
        let (mut scale, mut is_mirrored) = (self.scale, false);
        let mut axis = 0;
        while axis < 3 {
            let (mut start, mut end) =
                (self.scale[axis].to_bits() as i64, other.scale[axis].to_bits() as i64);
            if axis == 0 {
                start = if self.is_mirrored() { -start } else { start };
                end = if other.is_mirrored() { -end } else { end };
            }
            let now = between(start, end, t);
            // Flat it is as it was.
            is_mirrored |= now < 0 || axis == 0 && now == 0 && self.is_mirrored();
            scale[axis] = U10F22::from_bits(now.unsigned_abs() as u32);
            axis += 1;
        }
        let rotation = self.quaternion().slerp(other.quaternion(), t).rotation();
        Self {
            rotation: if is_mirrored { turned_round(rotation) } else { rotation },
            scale,
            translation: saturated([
                between(from[0] as i64, to[0] as i64, t),
                between(from[1] as i64, to[1] as i64, t),
                between(from[2] as i64, to[2] as i64, t),
            ]),
        }
    }

    /// The same with the rotation that is nearest to its matrix, or, of a mirrored pose, the nearest that mirrors one: each element
    /// within 0.501 · 2⁻¹⁴ of an exact one. Makes good what many turns have worn off; numbers that are no rotation at all become
    /// some rotation. Scales stay.
    #[must_use]
    pub const fn orthonormalized(self) -> Self {
        let rotation = self.quaternion().rotation();
        Self { rotation: if self.is_mirrored() { turned_round(rotation) } else { rotation }, ..self }
    }

    /// The rotation as a quaternion, as [`Quaternion::from_rotation`]; of a mirrored pose, that of the same with its x axis turned
    /// round, which is none.
    #[must_use]
    pub const fn quaternion(&self) -> Quaternion {
        if self.is_mirrored() {
            Quaternion::from_rotation(&turned_round(self.rotation))
        } else {
            Quaternion::from_rotation(&self.rotation)
        }
    }

    /// Scaled and turned: 16 fraction bits, rounded, below 2⁴⁶.
    pub(super) const fn placed(&self, point: Vec3) -> [i64; 3] {
        let (mut placed, mut rest) = ([0; 3], [0; 3]);
        let point = point.bits();
        let mut i = 0;
        while i < 9 {
            let (row, axis) = (i / 3, i % 3);
            // 16 and 22 fraction bits, below 2⁶³. In two parts, as with 14 bits more the whole sum has 80 bits.
            let scaled = point[axis] as i64 * self.scale[axis].to_bits() as i64;
            let (high, low) = (scaled >> 24, scaled & 0xff_ffff);
            let element = self.rotation[row][axis].to_bits() as i64;
            placed[row] += element * high;
            rest[row] += element * low;
            i += 1;
        }
        // 52 fraction bits down to 16.
        i = 0;
        while i < 3 {
            placed[i] = shift_round(placed[i] + (rest[i] >> 24), 12);
            i += 1;
        }
        placed
    }

    /// Rows `a` and `b` mixed by the turn from axis `a` towards axis `b`.
    const fn mixed(mut self, a: usize, b: usize, turn: Turn) -> Self {
        let (sin, cos) = (turn.sin().to_bits() as i32, turn.cos().to_bits() as i32);
        let mut i = 0;
        while i < 3 {
            // Not unrolled.
            black_box(());
            let (p, q) = (self.rotation[a][i].to_bits() as i32, self.rotation[b][i].to_bits() as i32);
            // Within 2 · 2¹⁵ · 2¹⁴.
            self.rotation[a][i] = round14_short(p * cos - q * sin);
            self.rotation[b][i] = round14_short(p * sin + q * cos);
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

/// a + (b − a) · t, rounded, for a `t` of 0 … 1 and numbers below 2³³.
const fn between(a: i64, b: i64, t: I16F16) -> i64 {
    a + shift_round((b - a) * t.to_bits() as i64, 16)
}

#[cfg(test)]
#[expect(clippy::float_arithmetic, reason = "the f64 truth of the tests")]
mod tests;
