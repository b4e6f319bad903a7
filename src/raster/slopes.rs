//! Slopes: how the barycentric weights of a triangle of any size change over the screen, and planes made with them.
//!
//! - In: the corners of a triangle, and 1/area.
//! - Out: planes, from values at the corners; whether the triangle is a [sliver](super::setup).
//! - Assumes: the corners lie in the guard band.

use super::plane::Plane;
use super::triangle::{TriangleSetup, edges};
use crate::math::recip::Reciprocal;
use crate::num::{IS_ARMV6M, mul_round, normalise};
use core::hint::black_box;

/// How weights of corners 1 and 2 change over the screen, and where planes begin: for set-up only.
pub(super) struct Slopes {
    /// Whether planes hold the values at the corners: see [`TriangleSetup::sliver`].
    pub(super) sliver: bool,
    /// Over one column, over one row, in units of 2^−(32 + `fraction_bits`) of that axis.
    of_weights: [[i32; 2]; 2],
    fraction_bits: [i8; 2],
    /// Corner 0's pixel.
    pixel: [i32; 2],
    /// From corner 0 to the centre of that pixel, −7 … 8 sixteenths.
    to_center: [i32; 2],
    /// From that pixel to the middle of what is within the screen.
    to_middle: [i32; 2],
    /// Columns and rows of what is within the screen, added up.
    pub(super) size: u32,
}

impl Slopes {
    /// Finds out whether it is a sliver, too. `area` is twice the area in 1/256 px².
    ///
    /// Not inlined: what it takes is not on the stack while planes are set.
    #[inline(never)]
    pub(super) fn new(setup: &TriangleSetup, area: u32) -> Self {
        let corners = setup.corners();
        let (edges, a) = (edges(&corners), corners[0]);
        let spread = |e: [i32; 2]| (e[0].abs() + e[1].abs()) as u32; // below 2¹⁶
        let (height, width) = (spread(edges[0]), spread(edges[1]));
        // Of each axis the largest difference to 30 bits, times 1/area: over columns there are more of them the less high it is.
        let shifts = edges.map(|[b, c]| normalise(b.unsigned_abs() | c.unsigned_abs() | 1).1 - 2);
        let Reciprocal { mantissa, zeros } = setup.area();
        // (e·2^shift · mantissa) / 2³¹, by halves of the mantissa: e is below 2¹⁵, and so `shift` at least 15.
        let weight = |e: i32, shift: u32| {
            ((e * (mantissa >> 16)) << (shift - 15)) + ((e * (mantissa & 0xffff)) >> (31 - shift))
        };
        let pixel = a.map(|at| at >> 4);
        Self {
            // Steps must fit 32 bits: at least a pixel wide and high. And their errors, one and a half unit of 2^−`fraction_bits` a
            // pixel, must not exceed 384 units along an axis: it is less than 2^(26 − `shift` of the other one) pixels long.
            sliver: height.max(width) * 16 > area || shifts[0] + shifts[1] < 23 + zeros,
            of_weights: [0, 1].map(|axis| edges[axis].map(|e| weight(e, shifts[axis]))),
            // A weight · 2^−(32 + n) = 16·e·mantissa·2^(zeros − 62)
            fraction_bits: shifts.map(|shift| (shift as i32 - 5 - zeros as i32) as i8),
            pixel,
            to_center: [pixel[0] * 16 + 8 - a[0], pixel[1] * 16 + 8 - a[1]],
            to_middle: [0; 2],
            size: 0,
        }
    }

    /// Finds the middle, and columns and rows: apart, so that it is not on the stack together with the rest.
    #[inline(never)]
    pub(super) fn find_middle(&mut self, setup: &TriangleSetup) {
        for axis in 0..2 {
            let [first, last] = setup.extent(axis);
            self.to_middle[axis] = ((first + last) >> 1) - self.pixel[axis];
            self.size += (last - first) as u32;
        }
    }

    /// Whether they are too coarse for [`Exact`](crate::Exact): as `sliver` asks, but with the fewer bits of the two for both axes.
    pub(super) fn are_coarse(&self, area_zeros: u32) -> bool {
        // As 2 · `shift` < 23 + zeros.
        2 * self.fraction_bits() + (area_zeros as i32) < 13
    }

    /// The fraction bits of slopes, along the axis where there are fewer.
    pub(super) fn fraction_bits(&self) -> i32 {
        self.fraction_bits[0].min(self.fraction_bits[1]).into()
    }

    /// Completes a plane whose `origin` holds the value at corner 0, from the rise to corners 1 and 2.
    #[inline(never)]
    pub(super) fn set_plane(&self, plane: &mut Plane, rise: [i32; 2]) {
        if self.sliver {
            plane.steps = rise;
            return;
        }
        // Hidden, so that the loop is not unrolled: 110 bytes less on Armv6-M.
        for axis in 0..if IS_ARMV6M { black_box(2) } else { 2 } {
            let axis = axis & 1;
            let [b, c] = self.of_weights[axis];
            let slope = mul_round::<32>(rise[0], b).wrapping_add(mul_round::<32>(rise[1], c));
            let bits = i32::from(self.fraction_bits[axis]);
            let (step, rest) = if bits > 0 {
                let step = ((slope >> (bits - 1)) + 1) >> 1;
                // What rounding leaves, with at most 12 of its bits, as far as the middle is away.
                let rest = slope.wrapping_sub(step << bits);
                (
                    step,
                    if bits > 12 {
                        ((rest >> (bits - 12)) * self.to_middle[axis]) >> 12
                    } else {
                        (rest * self.to_middle[axis]) >> bits
                    },
                )
            } else {
                (slope << -bits, 0)
            };
            plane.steps[axis] = step;
            plane.origin = plane
                .origin
                .wrapping_add_signed((step >> 4) * self.to_center[axis])
                .wrapping_sub((self.pixel[axis].wrapping_mul(step)) as u32)
                .wrapping_add_signed(rest);
        }
    }

    /// Sets a plane from the values at the corners.
    #[inline]
    pub(super) fn set_plane_of(&self, plane: &mut Plane, at: [u32; 3]) {
        plane.origin = at[0];
        self.set_plane(plane, [1, 2].map(|i| at[i].wrapping_sub(at[0]) as i32));
    }
}
