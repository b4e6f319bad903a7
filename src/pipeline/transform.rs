//! Stage 1: mesh space to clip space.
//!
//! One matrix a mesh does it all: the pose, the inverse of the camera's, the focal length.
//! Its elements share one exponent (block floating point), and so do all clip coordinates of the
//! mesh: a small object has the fine unit that its nearness needs, a wide one the coarse
//! unit that its size needs. The unit cancels in x/w, and nothing can overflow.

use crate::math::Pose;
use crate::num::{I16F16, U8F8, mul_round, shift_round};
use crate::scene::{Bounds, Projection, Vertex};

/// A vertex in clip space: what stands before the division by w.
#[derive(Clone, Copy, Debug)]
pub(super) struct ClipVertex {
    /// Right, times focal length / 2^[`focal_log2`](focal_log2), in units of 2^−`unit_bits`.
    pub(super) x: i32,
    /// Down, likewise.
    pub(super) y: i32,
    /// Distance before the eye, in units of 2^−`unit_bits`.
    pub(super) w: i32,
    pub(super) u: I16F16,
    pub(super) v: I16F16,
    pub(super) color: [U8F8; 3],
}

const _: () = assert!(size_of::<ClipVertex>() == 28);

/// The exponent k with focal length = 2^(k−1) … 2^k pixels, −3 … 13.
pub(super) const fn focal_log2(focal: I16F16) -> i32 {
    16 - focal.to_bits().leading_zeros() as i32
}

/// From mesh space to clip space.
pub(super) struct ToClip {
    /// Rows for x, y and w, in units of 2^−(`shift` + `unit_bits` + 4); below 2³⁰.
    matrix: [[i32; 3]; 3],
    /// 1 … 31: from sums of products to clip units.
    shift: u32,
    /// In clip units, within ±2²⁹.
    translation: [i32; 3],
    unit_bits: i32,
    /// The pose's, U10F22.
    scale: u32,
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
        // 28 fraction bits (4.0 at most) times 22 are 50; 14 times 16 are 30.
        let mut matrix = [[0i64; 3]; 3];
        let mut translation = [0i64; 3];
        for (row, sign) in SIGNS.iter().enumerate() {
            let axis = axis(row).map(|component| component * sign);
            matrix[row] = core::array::from_fn(|column| {
                let sum = dot(axis, pose.rotation.map(|r| i64::from(r[column].to_bits())));
                sum.clamp(-1 << 30, 1 << 30) * i64::from(pose.scale.to_bits())
            });
            translation[row] = dot(axis, distance);
        }

        let excess = bits(matrix.as_flattened()) - 30;
        let fraction_bits = 50 - excess;
        // The finest unit in which neither the translation (2²⁹) nor the sums (3·2²⁸) are too large.
        let unit_bits = (59 - bits(&translation)).min(fraction_bits - 5).min(28);
        // Without perspective depth reaches from plane to plane: the far one has to be among the clip coordinates.
        let far_bits =
            if projection.orthographic { 15 + projection.far.to_bits().leading_zeros() as i32 } else { 28 };
        let unit_bits = unit_bits.min(far_bits);
        let to_i32 = |value, shift: i32| {
            (if shift >= 0 { shift_round(value, shift.min(63) as u32) } else { value << -shift.max(-63) })
                as i32
        };
        let mut clip = Self {
            matrix: matrix.map(|row| row.map(|element| to_i32(element, excess))),
            shift: (fraction_bits - 4 - unit_bits).min(31) as u32,
            translation: translation.map(|element| to_i32(element, 30 - unit_bits)),
            unit_bits,
            scale: pose.scale.to_bits(),
        };
        let focal = projection.focal.to_bits();
        let focal = focal << (focal.leading_zeros() - 1); // 2³⁰ … 2³¹ − 1
        for row in 0..2 {
            clip.matrix[row] = clip.matrix[row].map(|element| mul_round::<31>(element, focal));
            clip.translation[row] = mul_round::<31>(clip.translation[row], focal);
        }
        clip
    }

    /// Fraction bits of clip coordinates, 10 … 28.
    pub(super) const fn unit_bits(&self) -> i32 {
        self.unit_bits
    }

    /// The bounds' centre, and the radius in clip units, rounded up by more than a rotation's elements are rounded.
    pub(super) fn bounds(&self, bounds: &Bounds) -> (ClipVertex, i64) {
        let radius = (i64::from(bounds.radius) * i64::from(self.scale)) >> (34 - self.unit_bits);
        let center = Vertex { position: bounds.center, ..Vertex::default() };
        (self.transform(&center, [U8F8::ZERO; 3]), radius + (radius >> 10) + 4)
    }

    /// Places one vertex: 18 short multiplications.
    #[inline(never)]
    pub(super) fn transform(&self, vertex: &Vertex, color: [U8F8; 3]) -> ClipVertex {
        let position = vertex.position.map(|p| i32::from(p.to_bits()));
        let place = |row: usize| {
            let [a, b, c] = self.matrix[row];
            let sum = mul16(position[0], a) + mul16(position[1], b) + mul16(position[2], c);
            (((sum >> (self.shift - 1)) + 1) >> 1) + self.translation[row]
        };
        ClipVertex {
            x: place(0),
            y: place(1),
            w: place(2),
            u: vertex.uv[0].into(),
            v: vertex.uv[1].into(),
            color,
        }
    }
}

fn dot(a: [i64; 3], b: [i64; 3]) -> i64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// `a · b / 2¹⁶` rounded down, for an `a` of 16 bits: two short products.
#[inline]
const fn mul16(a: i32, b: i32) -> i32 {
    a * (b >> 16) + ((a * (b & 0xffff)) >> 16)
}

/// How many bits the largest magnitude has.
fn bits(values: &[i64]) -> i32 {
    64 - values.iter().fold(0, |all, value| all | value.unsigned_abs()).leading_zeros() as i32
}
