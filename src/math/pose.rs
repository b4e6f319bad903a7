//! Where a mesh or a camera stands.

use super::unit::{length, normalized};
use super::{Quaternion, Turn, Vec3};
use crate::num::{I2F14, I16F16, U10F22, bits_from_f32, shift_round, wide};
use core::fmt;
use core::ops::Mul;

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
            let sum = dot(turn[row], column_of(&old, column));
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

    /// As [`Pose::scaled`], from a literal: saturated to 0 … 512, 0 for NaN.
    #[must_use]
    pub const fn scaled_lit(self, scale: f32) -> Self {
        let bits = bits_from_f32(scale, 22);
        self.scaled(U10F22::from_bits(if bits < 0 { 0 } else { bits as u32 }))
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
    const fn placed(&self, point: Vec3) -> [i64; 3] {
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
            let (p, q) = (self.rotation[a][i].to_bits() as i32, self.rotation[b][i].to_bits() as i32);
            self.rotation[a][i] = round14(p as i64 * cos as i64 - q as i64 * sin as i64, 14);
            self.rotation[b][i] = round14(p as i64 * sin as i64 + q as i64 * cos as i64, 14);
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

/// The same with its x column the other way round: the mirror image of what is turned.
const fn turned_round(mut rotation: [[I2F14; 3]; 3]) -> [[I2F14; 3]; 3] {
    let mut row = 0;
    while row < 3 {
        rotation[row][0] = rotation[row][0].saturating_neg();
        row += 1;
    }
    rotation
}

/// Of vectors of 16 bits: each difference is at most 2³⁰ + 2¹⁵ · (2¹⁵ − 1), which fits.
const fn cross(a: [i32; 3], b: [i32; 3]) -> [i32; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// Of vectors of 16 bits, its low 32 bits.
const fn wrapping_dot(a: [i32; 3], b: [i32; 3]) -> i32 {
    (a[0] * b[0]).wrapping_add(a[1] * b[1]).wrapping_add(a[2] * b[2])
}

const fn off(value: i32, from: i32) -> u32 {
    value.wrapping_sub(from).unsigned_abs()
}

/// `None` for a number that is none, below 0 or too large.
#[expect(clippy::float_arithmetic, reason = "set-up convenience, folded in constants")]
const fn scale_of(value: f32) -> Option<U10F22> {
    let bits = value as f64 * (1u64 << 22) as f64 + 0.5;
    // NaN is not within.
    if bits >= 0.0 && value >= 0.0 && bits < (1u64 << 32) as f64 {
        Some(U10F22::from_bits(bits as u32))
    } else {
        None
    }
}

const fn scale_of_bits(bits: u64) -> U10F22 {
    U10F22::from_bits(if bits > u32::MAX as u64 { u32::MAX } else { bits as u32 })
}

/// A length of 22 fraction bits, below 2³⁴, times a scale: rounded, saturated.
const fn product(length: u64, scale: u32) -> U10F22 {
    // A length of more than 32 bits has two to spare.
    let (length, shift) = if length <= u32::MAX as u64 { (length, 22) } else { (length >> 2, 20) };
    // Below 2⁶⁴ with the rounding too: (2³² − 1)² + 2²¹.
    scale_of_bits((length * scale as u64 + (1 << (shift - 1))) >> shift)
}

/// `dividend` · 2^`exponent` / `divisor`, which has at most 48 bits, as bits of a scale: within 2⁻³⁰ of itself, rounded, saturated.
const fn quotient(dividend: u64, divisor: u64, exponent: i32) -> U10F22 {
    if dividend == 0 {
        return U10F22::ZERO;
    } else if divisor == 0 {
        return U10F22::MAX;
    }
    let (up, down) = (dividend.leading_zeros(), 32u32.saturating_sub(divisor.leading_zeros()));
    // 31 bits or more, times 2^−shift.
    let ratio = (dividend << up) / (divisor >> down);
    let shift = up as i32 + down as i32 - exponent;
    if shift > 64 {
        U10F22::ZERO
    } else if shift > 0 {
        scale_of_bits((ratio >> (shift - 1)).saturating_add(1) >> 1)
    } else if shift > -32 && ratio <= u32::MAX as u64 {
        scale_of_bits(ratio << -shift)
    } else {
        U10F22::MAX
    }
}

/// Below 2⁶³, as one factor of each product is at most 2³⁰. Not inlined: on Armv6-M it is long.
#[inline(never)]
pub(crate) const fn dot(a: [i32; 3], b: [i32; 3]) -> i64 {
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

/// A sum of products with 14 fraction bits and `fraction_bits` more as an `I2F14`, rounded and saturated.
const fn round14(sum: i64, fraction_bits: u32) -> I2F14 {
    let rounded = shift_round(sum, fraction_bits);
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
