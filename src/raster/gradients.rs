//! Gradients of a small triangle: how much depth, a texture coordinate or a colour changes over a pixel, in 32-bit products.
//!
//! - In: the edges of a [small](super::small) triangle, and values at its corners.
//! - Out: planes.
//! - Assumes: values of planes fit 32 bits inside the triangle, and rises have 19.
//!
//! With e for the differences of an edge in 1/16 px, at most 2⁹, and `area` for twice the area in 1/256 px², a value changes
//! by 16·(rise₁·e₁ + rise₂·e₂)/area per pixel. All rises are taken in units of 2⁸ of the plane's own: so they have 19 bits,
//! and the sum is exact in 32 bits, be it depth, a texture coordinate or a colour. What that cuts off is 2⁻⁸ of a step of
//! 16-bit depth, or 1/256 of a texel or of 1/255.
//!
//! 1/area has a relative error of 2⁻¹⁷. It is the same for both steps of a plane. So it stretches the plane by that about
//! corner 0: a value is off by 2⁻¹⁷ of its range, wherever it is in the triangle. The rest is rounding, less than a unit of the
//! slope for each column and row from corner 0: no more than 64 units of the plane in all, since where the slope's unit is larger
//! (the area has more than 20 leading zeros) the triangle is smaller by as much, or else too thin. And 24 units for the origin.

use super::packing::{PACKED_MARGIN, PLANE_MARGIN};
use super::plane::Plane;
use crate::math::recip::short_of;
use crate::num::{IS_ARMV6M, mul_17};

/// What all planes of a triangle have in common.
pub(super) struct Gradients {
    /// How the edge functions of corners 1 and 2 change over a column, and over a row, of 1/16 px.
    pub(super) edges: [[i32; 2]; 2],
    /// 1 / (twice the area in 1/256 px²) = `reciprocal` · 2^(`zeros` − 48); 2¹⁶ … 2¹⁷.
    reciprocal: u32,
    /// By how much slopes are shifted left, −8 … 9: `zeros` − 20. These are 2⁴ for 16 sixteenths, 2⁸ for the rises' unit, 2¹⁶ that
    /// `mul_17` took away, and 2^(`zeros` − 48).
    up: i32,
    /// From corner 0 to the centre of the [first pixel](super::triangle::TriangleSetup::first_pixel), −7 … 8 and 0 … 15 sixteenths.
    pub(super) to_center: [i32; 2],
}

impl Gradients {
    /// Of a triangle whose uppermost corner is at `top`, from the differences to the next two, and twice its area, all in 1/16 px.
    #[inline(always)]
    pub(super) fn new(top: [i32; 2], [[bx, by], [cx, cy]]: [[i32; 2]; 2], area: u32) -> Self {
        let (reciprocal, zeros) = short_of(area);
        Self {
            edges: [[cy, -by], [-cx, bx]],
            reciprocal,
            up: zeros as i32 - 20,
            to_center: [8 - (top[0] & 15), 15 - ((top[1] + 7) & 15)],
        }
    }

    /// The greatest |Δx| + |Δy| of an edge, in 1/16 px.
    #[inline]
    pub(super) fn longest(&self) -> u32 {
        let [across, down] = self.edges;
        let length = |x: i32, y: i32| x.unsigned_abs() + y.unsigned_abs();
        length(across[0], down[0])
            .max(length(across[1], down[1]))
            .max(length(across[0] + across[1], down[0] + down[1]))
    }

    /// The larger one of its height and its width, divided by twice its area: in 1/px, 12 fraction bits, rounded up from at most 8.0.
    #[inline]
    pub(super) fn thinness(&self) -> u32 {
        let [height, width] = self.edges.map(|[b, c]| b.max(-c).max(0) - b.min(-c).min(0));
        // 2⁹ times 2¹⁷: in 1/16 px · 2⁴⁸/`zeros`, of which 2⁸ makes 1/px, and with 12 fraction bits.
        ((height.max(width) as u32 * self.reciprocal) >> ((12 - self.up) & 31)) + 1
    }

    /// Sets a plane from its value at corner 0 and the rises to corners 1 and 2, these in units of 2⁸ of the value's; below 2¹⁹, and so
    /// is what they differ by.
    #[inline(always)]
    fn set(&self, plane: &mut Plane, at: u32, [rise_1, rise_2]: [i32; 2]) {
        plane.origin = at;
        for axis in 0..2 {
            let [b, c] = self.edges[axis];
            // Two products of 19 bits and a sign with 9 bits and a sign: within ±2³⁰.
            let slope = mul_17(rise_1 * b + rise_2 * c, self.reciprocal);
            let step = if self.up < 0 { slope >> (-self.up & 31) } else { slope << (self.up & 31) };
            plane.steps[axis] = step;
            plane.origin = plane.origin.wrapping_add_signed((step >> 4) * self.to_center[axis]);
        }
    }

    /// Likewise.
    #[inline(never)]
    pub(super) fn set_plane(&self, plane: &mut Plane, at: u32, rises: &[i32; 2]) {
        self.set(plane, at, *rises);
    }

    /// Sets the plane of an attribute from its value at corner 0 and the rises to corners 1 and 2, in units of 2⁸ of the plane's, so that
    /// it stays a `margin` inside its range at the corners. Where there is no room for that it is the middle of the range, all over: or
    /// of the texel that this is in. Returns the least value, less that at corner 0, and the range; from 2¹⁹ on no plane is set. Nor is it
    /// where a texture coordinate that is not packed has no room: its last bits, which are left out here, are all that it has.
    #[inline(always)]
    pub(super) fn set_within(&self, plane: &mut Plane, at: i32, rises: &[i32; 2], margin: i32) -> (i32, i32) {
        if IS_ARMV6M {
            self.set_within_apart(plane, at, rises, margin)
        } else {
            // 12 cycles less on a Cortex-M4.
            self.set_within_here(plane, at, rises, margin)
        }
    }

    #[inline(never)]
    fn set_within_apart(&self, plane: &mut Plane, at: i32, rises: &[i32; 2], margin: i32) -> (i32, i32) {
        self.set_within_here(plane, at, rises, margin)
    }

    #[inline(always)]
    fn set_within_here(&self, plane: &mut Plane, at: i32, rises: &[i32; 2], margin: i32) -> (i32, i32) {
        let [mut b, mut c] = *rises;
        let (least, greatest) = (b.min(c).min(0), b.max(c).max(0));
        if greatest - least >= 1 << 19 {
            return (least, greatest - least);
        }
        let (low, high) = (least + margin, greatest - margin);
        let mut first = (low + high) >> 1;
        if low <= high {
            first = 0.clamp(low, high);
            (b, c) = (b.clamp(low, high) - first, c.clamp(low, high) - first);
        } else {
            (b, c) = (0, 0);
            if margin >= i32::from(PACKED_MARGIN) {
                first = ((at + first) & !0xff) + 0x80 - at;
            } else if margin == i32::from(PLANE_MARGIN) {
                return (least, i32::MAX);
            }
        }
        self.set(plane, ((at + first) << 8) as u32, [b, c]);
        (least, greatest - least)
    }
}
