//! Stage 1: mesh space to clip space.
//!
//! One matrix a mesh does it all: the pose, the inverse of the camera's, the focal length.
//! Its elements share one exponent (block floating point), and so do all clip coordinates of the
//! mesh: a small object has the fine unit that its nearness needs, a wide one the coarse
//! unit that its size needs. The unit cancels in x/w, and nothing can overflow.

use crate::math::Pose;
use crate::num::{I4F12, I16F16, U8F8, mul_round, shift_round};
use crate::scene::Projection;

/// A vertex in clip space: what stands before the division by w.
#[derive(Clone, Copy, Debug)]
pub(super) struct ClipVertex {
    /// Right and down, times focal length / 2^[`focal_log2`](focal_log2), and the distance before the eye, in units of
    /// 2^−`unit_bits`.
    pub(super) at: [i32; 3],
    pub(super) u: I16F16,
    pub(super) v: I16F16,
    pub(super) color: [U8F8; 3],
}

const _: () = assert!(size_of::<ClipVertex>() == 28);

/// The exponent k with focal length = 2^(k−1) … 2^k pixels, −3 … 13.
pub(super) const fn focal_log2(focal: I16F16) -> i32 {
    16 - focal.to_bits().leading_zeros() as i32
}

/// The most fraction bits of clip coordinates. The near plane may be one last bit of the world, 2⁻¹⁶, away, where w is not to
/// be rounded to a thousandth.
const FINEST: i32 = 34;
/// The most without perspective, where 2^this is a number in clip space.
const FINEST_FLAT: i32 = 28;

/// From mesh space to clip space.
pub(super) struct ToClip {
    /// For x, y and w.
    rows: [Row; 3],
    unit_bits: i32,
}

/// From a position in the mesh to one clip coordinate.
///
/// The clip units to a step of each position, within ±2¹³, in two halves, so that three products of either with 16 bits
/// fit an `i32`.
struct Row {
    /// In the upper half rounded, in the lower what that leaves, 15 fraction bits, within ±2¹⁴: one load for both.
    elements: [i32; 3],
    /// In clip units, within ±2²⁹.
    translation: i32,
}

impl Row {
    /// From elements of 15 fraction bits.
    fn new(elements: [i32; 3], translation: i32) -> Self {
        let halves = |element: i32| {
            let whole = (element + (1 << 14)) >> 15;
            whole << 16 | i32::from((element - (whole << 15)) as u16)
        };
        Self { elements: elements.map(halves), translation }
    }

    #[inline(always)]
    fn place(&self, position: [i32; 3]) -> i32 {
        let (mut whole, mut rest) = (self.translation, 0);
        for (at, halves) in position.into_iter().zip(self.elements) {
            whole += at * (halves >> 16);
            rest += at * i32::from(halves as i16);
        }
        whole + (rest >> 15)
    }
}

/// Rows of eye space turned into rows of clip space: y down, w along −z.
const SIGNS: [i64; 3] = [1, -1, -1];

impl ToClip {
    #[inline(never)]
    pub(super) fn new(projection: &Projection, camera: &Pose, pose: &Pose) -> Self {
        // The camera's axes are the columns of its rotation; what it sees is turned by the rows.
        let axis = |row: usize| camera.rotation.map(|r| i64::from(r[row].to_bits()));
        let distance: [i64; 3] = {
            let (to, from) = (pose.translation.bits(), camera.translation.bits());
            core::array::from_fn(|i| i64::from(to[i]) - i64::from(from[i]))
        };
        let scale = pose.scale.map(|scale| i64::from(scale.to_bits()));
        // 28 fraction bits (4.0 at most) times 22 are 50; 14 times 16 are 30.
        let mut matrix = [[0i64; 3]; 3];
        let mut translation = [0i64; 3];
        for (row, sign) in SIGNS.iter().enumerate() {
            let axis = axis(row).map(|component| component * sign);
            matrix[row] = core::array::from_fn(|column| {
                let sum = dot(axis, pose.rotation.map(|r| i64::from(r[column].to_bits())));
                sum.clamp(-1 << 30, 1 << 30) * scale[column]
            });
            translation[row] = dot(axis, distance);
        }

        let excess = bits(matrix.as_flattened()) - 30;
        let fraction_bits = 50 - excess;
        // The finest unit in which neither the translation (2²⁹) nor the sums (3·2²⁸) are too large.
        let unit_bits = (59 - bits(&translation)).min(fraction_bits - 5).min(FINEST);
        // Without perspective depth reaches from plane to plane: the far one has to be among the clip coordinates.
        let far_bits = if projection.orthographic {
            // And 1 is what divides.
            (15 + projection.far.to_bits().leading_zeros() as i32).min(FINEST_FLAT)
        } else {
            FINEST
        };
        let unit_bits = unit_bits.min(far_bits);
        let to_i32 = |value, shift: i32| {
            (if shift >= 0 { shift_round(value, shift.min(63) as u32) } else { value << -shift.max(-63) })
                as i32
        };
        let focal = projection.focal.to_bits();
        let focal = focal << (focal.leading_zeros() - 1); // 2³⁰ … 2³¹ − 1
        // At least 1.
        let shift = (fraction_bits - 4 - unit_bits).min(31);
        let rows = core::array::from_fn(|row| {
            let times_focal = |value| if row < 2 { mul_round::<31>(value, focal) } else { value };
            let elements = matrix[row].map(|element| {
                // 30 bits; then 15 fraction bits.
                ((times_focal(to_i32(element, excess)) >> shift) + 1) >> 1
            });
            Row::new(elements, times_focal(to_i32(translation[row], 30 - unit_bits)))
        });
        Self { rows, unit_bits }
    }

    /// Fraction bits of clip coordinates, 10 … 34.
    pub(super) const fn unit_bits(&self) -> i32 {
        self.unit_bits
    }

    /// Whether a sphere of the mesh, whose centre lies `outside` of a plane, reaches over it, give or take four clip units for
    /// rounding. Outside is what a coordinate · 2^`log2` − w · `slope` says, in either direction. A `log2` of 0 … 17, a slope
    /// within ±2¹⁶.
    ///
    /// Whatever becomes of the sphere, it reaches as far as its radius times the gradient of what measures that distance. This
    /// is the gradient of the elements themselves: so it is right for every matrix, one that stretches, shears or mirrors, too.
    #[inline(never)]
    pub(super) fn reaches(&self, outside: i64, radius: u32, (axis, log2, slope): (usize, i32, i32)) -> bool {
        if outside <= 0 {
            return true;
        }
        // The elements' upper halves: below 2¹³ · 2¹⁷ + 2¹⁶ · 2¹³.
        let ([.., w], across) = (&self.rows, &self.rows[axis]);
        let gradient: [u32; 3] = core::array::from_fn(|i| {
            (((across.elements[i] >> 16) << log2) - (w.elements[i] >> 16) * slope).unsigned_abs()
        });
        // Each half is within ½ of its element, all three within √¾.
        let unit = (1 << log2) + slope.unsigned_abs();
        let outside = outside - i64::from(radius + 4) * i64::from(unit);
        // All over a power of two so that 14 bits of the gradient are left, and then outside ≤ radius · gradient, squared.
        let all = gradient.iter().fold(0, |all, side| all | side);
        let shift = 18_u32.saturating_sub(all.leading_zeros());
        let squares: u32 = gradient.iter().map(|side| (side >> shift) + 1).map(|side| side * side).sum();
        let Ok(outside) = u32::try_from((outside >> shift).max(0)) else {
            return false; // Below 2¹⁶ · 2¹⁵ it would have to be.
        };
        u64::from(outside) * u64::from(outside) <= u64::from(radius * radius) * u64::from(squares)
    }

    /// Places one vertex along one axis, x, y or w: 6 short multiplications.
    #[inline(always)]
    pub(super) fn place(&self, position: [i32; 3], axis: usize) -> i32 {
        self.rows[axis].place(position)
    }

    /// Along all.
    #[inline(never)]
    pub(super) fn place_all(&self, position: [I4F12; 3]) -> [i32; 3] {
        let position = position.map(|at| i32::from(at.to_bits()));
        self.rows.each_ref().map(|row| row.place(position))
    }
}

fn dot(a: [i64; 3], b: [i64; 3]) -> i64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// How many bits the largest magnitude has.
fn bits(values: &[i64]) -> i32 {
    64 - values.iter().fold(0, |all, value| all | value.unsigned_abs()).leading_zeros() as i32
}
