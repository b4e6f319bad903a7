//! Stage 3 for small triangles, which most of a mesh's are: short products.
//!
//! A triangle of at most 64 pixels across whose distances differ by less than a quarter needs planes that are exact enough
//! over 64 pixels only. An edge's extent e is below 2¹⁰ there, in 1/16 px: a value's slope, 16·(Σ rise·e)/area a pixel, is a
//! sum of products without rounding where rises have 19 bits, times 1/area with a relative error of 2⁻¹⁷. So after 64
//! columns and rows a value is off by 1/1024 of its change over one pixel.
//!
//! # Bent triangles
//!
//! Where u is not linear enough it bends, as [`straight`](super::straight) has it, by the covariance of u and q divided by q.
//! With q̄, the middle of the least and the greatest q, for q that is a quadratic, of which no pixel needs a division:
//!
//! ```text
//! u = u₀ + V − (∇u·p)(∇q·p)/q̄,   p the way from corner 0, and V the plane that leaves the corners as they are
//! ```
//!
//! q̄ is wrong by half of what q falls by, so at most ½·fall of the bend is: (length/4)·fall·(fall/2), of which 3/32 pixel are
//! allowed. [`Patch`](super::Patch) draws a row of it as a straight line between its ends, or several, and may be wrong by as
//! much again.

use super::attribute::Attribute;
use super::patch::STRAIGHT;
use super::setup::{Needs, Oriented, Plane, TriangleSetup, edges};
use super::shade::Inputs;
use super::straight::{Bend, Straight};
use crate::math::recip::short_of;
use crate::num::{mul_16, mul_16_signed, mul_17};

/// What all planes of a triangle have in common.
struct Slopes {
    /// By how much the edge functions of corners 1 and 2 change a column, and a row, of 1/16 px; below 2¹⁰.
    edges: [[i32; 2]; 2],
    /// 1/area = `reciprocal` · 2^(`zeros` − 48).
    reciprocal: u32,
    zeros: u32,
    /// Corner 0's pixel.
    pixel: [i32; 2],
    /// From corner 0 to the centre of that pixel, −7 … 8 sixteenths.
    to_center: [i32; 2],
}

impl Slopes {
    /// As [`Slopes::set`], for a caller that does little else.
    ///
    /// Not inlined: one in which all of this is at hand keeps most of it on the stack.
    #[inline(never)]
    fn set_plane(&self, plane: &mut Plane, rise_1: i32, rise_2: i32) {
        self.set(plane, rise_1, rise_2);
    }

    /// Sets an attribute from its I16F16 values at the corners: false if it changes too much.
    #[inline(never)]
    fn set_attribute(&self, attribute: &mut Attribute, at: &[i32; 3], scale_log2: u32) -> bool {
        let rise = attribute.set_range(*at, scale_log2);
        attribute.plane.origin = attribute.origin();
        self.set(&mut attribute.plane, rise[0], rise[1]);
        attribute.range < 1 << 27
    }

    /// Sets a plane, whose `origin` is the value at corner 0 yet, by the rise from there to corners 1 and 2; a step has to fit 32
    /// bits.
    #[inline(always)]
    fn set(&self, plane: &mut Plane, rise_1: i32, rise_2: i32) {
        let size = rise_1.unsigned_abs() | rise_2.unsigned_abs();
        let dropped = if size < 1 << 19 {
            0
        } else if size < 1 << 27 {
            8
        } else {
            12
        };
        let (rise_1, rise_2) = (rise_1 >> dropped, rise_2 >> dropped);
        let up = (self.zeros + dropped) as i32 - 28;
        for axis in 0..2 {
            let [b, c] = self.edges[axis];
            let slope = mul_17(rise_1 * b + rise_2 * c, self.reciprocal);
            let step = if up < 0 { slope >> (-up & 31) } else { slope << (up & 31) };
            plane.steps[axis] = step;
            plane.origin = plane
                .origin
                .wrapping_add_signed((step >> 4) * self.to_center[axis])
                .wrapping_sub(self.pixel[axis].wrapping_mul(step) as u32);
        }
    }
}

impl TriangleSetup {
    /// Sets all planes of a small triangle: false, and nothing of use done, for any other.
    #[inline(never)]
    pub(super) fn set_small_planes(&mut self, triangle: &Oriented<'_>, needs: &Needs, simple: bool) -> bool {
        let edges = edges(&self.corners);
        let largest = edges.as_flattened().iter().fold(0, |all, e| all | e.unsigned_abs());
        // At most 64 pixels across, and at least a quarter thick: a step of 2²⁷ over that still fits.
        if largest >= 1 << 10 || largest * 4 > triangle.area {
            return false;
        }
        let q = triangle.vertices.map(|vertex| vertex.q.to_bits());
        let (most, least) = (q[0], q[1].min(q[2]));
        // Depth must not wrap where rounding takes it out of 0 … 2³¹, and is never 0.
        if most > (1 << 31) - 2048 || least < (1 << 15) + 2048 || most - least >= 1 << 27 {
            return false;
        }
        let (reciprocal, zeros) = short_of(triangle.area);
        let slopes = Slopes {
            edges,
            reciprocal,
            zeros,
            pixel: self.corners[0].map(|at| at >> 4),
            to_center: self.corners[0].map(|at| 8 - (at & 15)),
        };
        // Also where no depth is tested: pixels are not to depend on that.
        self.z.origin = q[0];
        slopes.set_plane(&mut self.z, q[1].wrapping_sub(q[0]) as i32, q[2].wrapping_sub(q[0]) as i32);
        // 2⁻¹⁶ of which, over the triangle's extent, is a quarter of a depth step.
        let step = self.z.steps[0].unsigned_abs() | self.z.steps[1].unsigned_abs();
        if step >> 27 != 0 || (step >> 8) * largest > 1 << 25 {
            return false;
        }
        let are_set = match needs.straight {
            Straight::Below(limit)
                if needs.inputs != Inputs::None
                    && most != least
                    && !Bend::is_needless(&edges, q, least, limit) =>
            {
                self.set_bending(triangle, needs, &slopes, &q, limit, simple)
            }
            _ => {
                self.straight = true;
                self.set_linear(triangle, needs, &slopes)
            }
        };
        if are_set && needs.packing.inset > 0 {
            if needs.is_exactly_straight(least, most) {
                self.lean(triangle, needs, 2, i32::MAX);
            } else {
                self.keep_small_inside(needs);
            }
        }
        are_set
    }

    /// Sets attributes that may bend: false, and nothing of use done, where they do too much.
    #[inline(never)]
    fn set_bending(
        &mut self,
        triangle: &Oriented<'_>,
        needs: &Needs,
        slopes: &Slopes,
        q: &[u32; 3],
        limit: u32,
        simple: bool,
    ) -> bool {
        let Some(bend) = Bend::new(&slopes.edges, *q, q[1].min(q[2])) else {
            return false;
        };
        self.straight = bend.is_straight(limit) || self.are_straight(triangle, needs, &bend, limit);
        if self.straight {
            return self.set_linear(triangle, needs, slopes);
        }
        if simple
            && !needs.every_pixel
            && let Some(slopes_of_q) = bend.slopes(self.z.steps)
            && self.set_linear(triangle, needs, slopes)
        {
            self.set_bent(triangle, needs, slopes, &bend, slopes_of_q);
        }
        self.straight
    }

    /// Whether attributes that are linear on the screen are good enough.
    #[inline(never)]
    fn are_straight(&self, triangle: &Oriented<'_>, needs: &Needs, bend: &Bend, limit: u32) -> bool {
        needs.each_attribute(triangle, self.gray, |_, [a, b, c], scale_log2| {
            let rise = [b - a, c - a];
            (rise[0].unsigned_abs() | rise[1].unsigned_abs()) < 1 << 27
                && bend.is_straight_for(limit, rise, 0x10000 >> scale_log2)
        })
    }

    /// Makes attributes linear on the screen: false if one changes too much.
    ///
    /// Not inlined: what this needs of the stack need not be there when attributes are bent.
    #[inline(never)]
    fn set_linear(&mut self, triangle: &Oriented<'_>, needs: &Needs, slopes: &Slopes) -> bool {
        let attributes = &mut self.attributes;
        needs.each_attribute(triangle, self.gray, |i, at, scale_log2| {
            attributes.get_mut(i).is_some_and(|attribute| slopes.set_attribute(attribute, &at, scale_log2))
        })
    }

    /// Bends attributes, of which planes are set, as much as perspective does.
    #[inline(never)]
    fn set_bent(
        &mut self,
        triangle: &Oriented<'_>,
        needs: &Needs,
        slopes: &Slopes,
        bend: &Bend,
        [q_right, q_down]: [i32; 2],
    ) {
        self.straight = true;
        self.longest = STRAIGHT / 2;
        while (self.longest * self.longest) * q_right.abs() > 3 << 13 {
            self.longest >>= 1;
        }
        let [x, y] = slopes.to_center;
        needs.each_attribute(triangle, self.gray, |i, at, _| {
            let Some(attribute) = self.attributes.get_mut(i) else {
                return false;
            };
            let rise = [at[1] - at[0], at[2] - at[0]];
            let [right, down] = attribute.plane.steps;
            let xx = -mul_16_signed(right, q_right);
            let xy = -mul_16_signed(right, q_down) - mul_16_signed(down, q_right);
            let yy = -mul_16_signed(down, q_down);
            // So much that the corners are what they were.
            attribute.plane.origin = attribute.origin();
            let [rise_1, rise_2] = [0, 1].map(|i| rise[i] - mul_16(rise[i], bend.fall(i)));
            slopes.set_plane(&mut attribute.plane, rise_1, rise_2);
            // From corner 0's pixel instead of corner 0.
            let more = [(xx >> 3) * x + (xy >> 4) * y, (xy >> 4) * x + (yy >> 3) * y];
            let [m, n] = slopes.pixel;
            attribute.plane.origin = attribute
                .plane
                .origin
                .wrapping_add_signed(((xx >> 5) * (x * x) + (xy >> 5) * (x * y) + (yy >> 5) * (y * y)) >> 3)
                .wrapping_sub(m.wrapping_mul(more[0]).wrapping_add(n.wrapping_mul(more[1])) as u32);
            for (step, more) in attribute.plane.steps.iter_mut().zip(more) {
                *step = step.wrapping_add(more);
            }
            attribute.bend = [xx, xy, yy];
            true
        });
    }
}
