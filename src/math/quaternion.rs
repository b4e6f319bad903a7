//! Rotations as unit quaternions.

use super::unit::{ONE, normalized, renormalized, sin_cos};
use super::{Turn, Vec3};
use crate::num::I2F30;
use crate::num::{I2F14, I16F16, mul_round, shift_round, wide};
use core::ops::Mul;

/// A rotation: the unit quaternion w + xi + yj + zk, in [`I2F30`].
///
/// For a turn by α about a unit axis that is w = cos α/2 and (x, y, z) = axis · sin α/2. It
/// composes and interpolates without ever ceasing to be a rotation: every operation
/// rounds to 2⁻³⁰ and leaves the length within 2⁻³⁰ of 1. 30 fraction bits, because the four numbers then fit
/// registers, their products one wide multiply, and the rounding of a [`Pose`](crate::Pose)'s 14-bit
/// matrix is the only one that counts. `q` and `−q` are the same rotation, but not `==`.
///
/// ```
/// use fixel::{Pose, Quaternion, Turn, Vec3, fixed::types::I16F16};
/// const SHUT: Quaternion = Quaternion::IDENTITY;
/// const OPEN: Quaternion = Quaternion::from_axis_turn(Vec3::lit(0.0, 1.0, 0.0), Turn::from_degrees(120));
/// let ajar = SHUT.slerp(OPEN, I16F16::lit("0.25"));
/// assert_eq!(Pose::from_quaternion(ajar), Pose::IDENTITY.rotated_y(Turn::from_degrees(30)));
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Quaternion {
    /// w, x, y, z; 30 fraction bits. The length is within 1.001 · 2⁻³⁰ of 1.
    bits: [i32; 4],
}

impl Quaternion {
    /// No rotation: w = 1.
    pub const IDENTITY: Self = Self { bits: [ONE, 0, 0, 0] };

    /// From four numbers in any common unit: they are divided by their length, each within
    /// 2.5 · 2⁻³⁰. All zeros give [`Quaternion::IDENTITY`].
    ///
    /// One square root and four 64-bit divisions.
    #[must_use]
    pub const fn new(w: I2F30, x: I2F30, y: I2F30, z: I2F30) -> Self {
        let bits = [w.to_bits() as i64, x.to_bits() as i64, y.to_bits() as i64, z.to_bits() as i64];
        match normalized(bits) {
            Some(bits) => Self { bits },
            None => Self::IDENTITY,
        }
    }

    /// Right-handed, about an axis of any length: each component within 3 · 2⁻³⁰.
    /// The zero axis gives [`Quaternion::IDENTITY`].
    #[must_use]
    pub const fn from_axis_turn(axis: Vec3, turn: Turn) -> Self {
        let [x, y, z] = axis.bits();
        match normalized([x as i64, y as i64, z as i64]) {
            Some(axis) => Self::about(axis, turn),
            None => Self::IDENTITY,
        }
    }

    /// Roll about z, then pitch about x, then yaw about y, all three axes those of the world; seen
    /// from the object, that looks along −z: it first turns left by `yaw`, then up by `pitch`, then
    /// tilts to its left by `roll`. Each component within 4 · 2⁻³⁰.
    #[must_use]
    pub const fn from_euler(yaw: Turn, pitch: Turn, roll: Turn) -> Self {
        let roll = Self::about([0, 0, ONE], roll);
        roll.then(Self::about([ONE, 0, 0], pitch)).then(Self::about([0, ONE, 0], yaw))
    }

    /// About a unit axis of 30 fraction bits. Of `q` and `−q` it is the one with w ≥ 0.
    const fn about(axis: [i32; 3], turn: Turn) -> Self {
        let raw = turn.raw() as u32;
        // More than half a turn is less than half a turn back.
        let (sin, cos) = sin_cos(if raw <= 1 << 15 { raw << 15 } else { raw << 15 | 1 << 31 });
        let [x, y, z] =
            [mul_round::<30>(axis[0], sin), mul_round::<30>(axis[1], sin), mul_round::<30>(axis[2], sin)];
        Self { bits: renormalized([cos, x, y, z]) }
    }

    /// The rotation that is nearest to a matrix (rows; least squares) that was one before its elements were rounded.
    ///
    /// From elements rounded to 2⁻¹⁴, each component is within 0.58 · 2⁻¹⁴. From numbers that are no rotation
    /// at all, it makes some rotation.
    ///
    /// The largest row of 4qqᵀ (Shepperd 1978), then one step of the power method towards its
    /// eigenvector, which is the nearest one (Bar-Itzhack 2000). Two square roots, eight 64-bit divisions.
    #[must_use]
    pub const fn from_rotation(rows: &[[I2F14; 3]; 3]) -> Self {
        const fn r(rows: &[[I2F14; 3]; 3], i: usize, j: usize) -> i32 {
            rows[i][j].to_bits() as i32
        }
        let (xx, yy, zz, one) = (r(rows, 0, 0), r(rows, 1, 1), r(rows, 2, 2), 1 << 14);
        let (wx, wy, wz) =
            (r(rows, 2, 1) - r(rows, 1, 2), r(rows, 0, 2) - r(rows, 2, 0), r(rows, 1, 0) - r(rows, 0, 1));
        let (xy, xz, yz) =
            (r(rows, 0, 1) + r(rows, 1, 0), r(rows, 0, 2) + r(rows, 2, 0), r(rows, 1, 2) + r(rows, 2, 1));
        // 4qqᵀ, 14 fraction bits, below 2¹⁷.
        let outer = [
            [one + xx + yy + zz, wx, wy, wz],
            [wx, one + xx - yy - zz, xy, xz],
            [wy, xy, one - xx + yy - zz, yz],
            [wz, xz, yz, one - xx - yy + zz],
        ];
        // The diagonal's sum is 4, so the largest of it is 1 or more.
        let mut largest = 0;
        let mut i = 1;
        while i < 4 {
            if outer[i][i] > outer[largest][largest] {
                largest = i;
            }
            i += 1;
        }
        let row = outer[largest];
        let Some(start) = normalized([row[0] as i64, row[1] as i64, row[2] as i64, row[3] as i64]) else {
            return Self::IDENTITY;
        };
        let mut step = [0; 4];
        i = 0;
        while i < 4 {
            step[i] = dot(outer[i], start);
            i += 1;
        }
        Self {
            bits: match normalized(step) {
                Some(bits) => bits,
                None => start,
            },
        }
    }

    /// The rotation as the rows of a matrix, each element within 0.501 · 2⁻¹⁴ of exact: 9
    /// multiplications.
    #[must_use]
    pub const fn rotation(self) -> [[I2F14; 3]; 3] {
        let matrix = self.matrix();
        let mut rows = [[I2F14::ZERO; 3]; 3];
        let mut i = 0;
        while i < 9 {
            let element = shift_round(matrix[i / 3][i % 3] as i64, 16);
            rows[i / 3][i % 3] = I2F14::from_bits(element as i16);
            i += 1;
        }
        rows
    }

    /// The rows with 30 fraction bits, each element within 4 · 2⁻³⁰.
    pub(super) const fn matrix(self) -> [[i32; 3]; 3] {
        /// Twice a sum of products, which has 60 fraction bits.
        const fn twice(sum: i64) -> i32 {
            shift_round(sum, 29) as i32
        }
        const HALF: i64 = 1 << 59;
        let [w, x, y, z] = self.bits;
        let (xx, yy, zz) = (wide(x, x), wide(y, y), wide(z, z));
        let (wx, wy, wz) = (wide(w, x), wide(w, y), wide(w, z));
        let (xy, xz, yz) = (wide(x, y), wide(x, z), wide(y, z));
        [
            [twice(HALF - yy - zz), twice(xy - wz), twice(xz + wy)],
            [twice(xy + wz), twice(HALF - xx - zz), twice(yz - wx)],
            [twice(xz - wy), twice(yz + wx), twice(HALF - xx - yy)],
        ]
    }

    /// This rotation first, `next` after it; as an operator `next * self`. Each component within
    /// 1.5 · 2⁻³⁰; 24 multiplications.
    #[must_use]
    pub const fn then(self, next: Self) -> Self {
        let (a, [w, x, y, z]) = (next.bits, self.bits);
        // Sums of four products of 2⁶⁰ at most.
        Self {
            bits: renormalized([
                shift_round(dot(a, [w, -x, -y, -z]), 30) as i32,
                shift_round(dot(a, [x, w, z, -y]), 30) as i32,
                shift_round(dot(a, [y, -z, w, x]), 30) as i32,
                shift_round(dot(a, [z, y, -x, w]), 30) as i32,
            ]),
        }
    }

    /// The rotation back: the conjugate. Exact.
    #[must_use]
    pub const fn inverse(self) -> Self {
        let [w, x, y, z] = self.bits;
        Self { bits: [w, -x, -y, -z] }
    }

    /// The rotation between `self` (at t = 0 or less) and `other` (at 1 or more), at constant speed along the
    /// shorter of the two ways: each component within 5 · 2⁻³⁰ of exact for every pair.
    ///
    /// The ends are exact, though the far one is `−other` where that is nearer. Rotations half a turn apart, which are
    /// equally far either way, turn towards `other` as it stands.
    ///
    /// Takes no angle and divides by no sine, so pairs close together lose nothing. The weight
    /// sin tθ / sin θ is t times the hypergeometric series F(1 + t, 1 − t; 3⁄2; s), s = sin² θ/2 = |a − b|²/4
    /// (Eberly 2011 has it in powers of cos θ − 1). All its terms are positive; it stops when they vanish. 6
    /// multiplications a term: 5 terms when the rotations are 30° apart, 10 at 90°, 32 at 180°.
    #[must_use]
    pub const fn slerp(self, other: Self, t: I16F16) -> Self {
        let (a, mut b) = (self.bits, other.bits);
        if dot(a, b) < 0 {
            b = [-b[0], -b[1], -b[2], -b[3]];
        }
        let t = t.to_bits();
        if t <= 0 {
            return self;
        } else if t >= 1 << 16 {
            return Self { bits: b };
        }
        // 0 … 2⁶¹, as no more than a right angle is between the two: components stay below 2³¹.
        let between = [a[0] - b[0], a[1] - b[1], a[2] - b[2], a[3] - b[3]];
        let s = shift_round(dot(between, between), 31) as i32;
        let (to_a, to_b) = weights(t, s);
        let mut bits = [0; 4];
        let mut i = 0;
        while i < 4 {
            bits[i] = shift_round(wide(to_a, a[i]) + wide(to_b, b[i]), 30) as i32;
            i += 1;
        }
        Self { bits: renormalized(bits) }
    }

    /// The cosine of half the angle.
    #[must_use]
    pub const fn w(self) -> I2F30 {
        I2F30::from_bits(self.bits[0])
    }

    /// The axis' x times the sine of half the angle.
    #[must_use]
    pub const fn x(self) -> I2F30 {
        I2F30::from_bits(self.bits[1])
    }

    /// The axis' y times the sine of half the angle.
    #[must_use]
    pub const fn y(self) -> I2F30 {
        I2F30::from_bits(self.bits[2])
    }

    /// The axis' z times the sine of half the angle.
    #[must_use]
    pub const fn z(self) -> I2F30 {
        I2F30::from_bits(self.bits[3])
    }
}

impl Default for Quaternion {
    fn default() -> Self {
        Self::IDENTITY
    }
}

/// The right one first, as with matrices: `a * b` is `b.then(a)`.
impl Mul for Quaternion {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        other.then(self)
    }
}

/// The sum of four products, each at most 2⁶¹ and together too.
const fn dot(a: [i32; 4], b: [i32; 4]) -> i64 {
    wide(a[0], b[0]) + wide(a[1], b[1]) + wide(a[2], b[2]) + wide(a[3], b[3])
}

const TERMS: usize = 32;

/// Each term of F(1 + t, 1 − t; 3⁄2; s) is the one before it times s · (i² − t²)/(i² + i/2), i = 1, 2 …:
/// i²/(i² + i/2) and 1/(i² + i/2), 31 fraction bits. At s = ½ what is left out is below 2⁻³³.
static RATIOS: [[i32; 2]; TERMS] = {
    let mut ratios = [[0; 2]; TERMS];
    let mut i = 1;
    while i <= TERMS as u64 {
        let divisor = i * (2 * i + 1);
        let (whole, part) = (((i * i) << 32) + divisor / 2, (1 << 32) + divisor / 2);
        ratios[i as usize - 1] = [(whole / divisor) as i32, (part / divisor) as i32];
        i += 1;
    }
    ratios
};

/// sin (1 − t)θ / sin θ and sin tθ / sin θ, 30 fraction bits, for a `t` of 16 and an `s` = sin² θ/2 of 31, at most ½.
const fn weights(t: i32, s: i32) -> (i32, i32) {
    let (u, t) = (ONE - (t << 14), t << 14);
    let (u2, t2) = (mul_round::<30>(u, u), mul_round::<30>(t, t));
    // Terms with 31 fraction bits, but for the first, which is 1; all others together are at most π/2 − 1.
    let (mut u_term, mut t_term) = (s, s);
    let (mut u_sum, mut t_sum) = (0, 0);
    let mut i = 0;
    while i < TERMS && (u_term | t_term) != 0 {
        let [whole, part] = RATIOS[i];
        u_term = mul_round::<31>(whole - mul_round::<30>(part, u2), u_term);
        t_term = mul_round::<31>(whole - mul_round::<30>(part, t2), t_term);
        u_sum += u_term;
        t_sum += t_term;
        u_term = mul_round::<31>(u_term, s);
        t_term = mul_round::<31>(t_term, s);
        i += 1;
    }
    (u + mul_round::<31>(u, u_sum), t + mul_round::<31>(t, t_sum))
}

#[cfg(test)]
#[expect(clippy::float_arithmetic, reason = "the f64 truth of the tests")]
pub(super) mod tests;
