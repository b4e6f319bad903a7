//! Set-up of a small triangle, as most triangles of a mesh are: what [`setup`](super::setup) does, in 32-bit products.
//!
//! - In: an oriented triangle, and what the shader wants of it.
//! - Out: the planes of its depth and attributes; or `false` if it has to be set up by the general way.
//! - Assumes: the corners lie in the guard band.
//!
//! A triangle is *small* if corners 1 and 2 are less than 64 pixels from corner 0, in x and in y. The general way takes it
//! nevertheless if it is too thin, if q varies too much, or if its attributes have to be divided by q at its pixels.
//!
//! With e for the differences of an edge in 1/16 px, below 2¹⁰, and `area` for twice the area in 1/256 px², a value changes
//! by 16·(rise₁·e₁ + rise₂·e₂)/area per pixel. For rises of 19 bits the sum is exact in 32 bits; longer ones are shortened to
//! that. 1/area has a relative error of 2⁻¹⁷. So 64 columns and 64 rows from corner 0 a value is off by 128·2⁻¹⁷ = 1/1024 of
//! its change over one pixel.
//!
//! # Bent triangles
//!
//! A triangle that is not straight may be *bent*: its attributes are quadratics on the screen, and again no pixel divides.
//! [`straight`](super::straight) has the difference of exact and linear u: the covariance of u and q, divided by q. The
//! covariance is a quadratic that is 0 at the corners. With a constant in the place of the divisor, q_mid = (q_min +
//! q_max)/2, the whole is one, too:
//!
//! ```text
//! u = u₀ + V·p − (∇u·p)(∇q·p)/q_mid,   p being the offset from corner 0
//! ```
//!
//! ∇u and ∇q are the gradients of linear interpolation. V is the gradient with which u is right at corners 1 and 2: V·p is
//! Δuᵢ·(1 + Δqᵢ/q_mid) there. (q₀ is the greatest, so Δqᵢ ≤ 0.)
//!
//! q_mid differs from q by at most half of what q varies by. So of the correction, at most (length/4)·fall pixels, at most
//! fall/2 is wrong: length·fall²/8 pixels, of which 3/32 are allowed. A patch draws a row as straight lines between points
//! of the quadratic, which may be off by 3/32 again. Rounding has the rest of the quarter pixel.

use super::attribute::Attribute;
use super::plane::Plane;
use super::straight::{Bend, Straight};
use super::triangle::{Needs, STRAIGHT, TriangleSetup, edges};
use crate::geometry::{Inputs, Oriented};
use crate::math::recip::short_of;
use crate::num::{mul_16, mul_16_signed, mul_17};

/// What all planes of a triangle have in common.
struct Slopes {
    /// As [`edges`] has them, in 1/16 px, below 2¹⁰.
    edges: [[i32; 2]; 2],
    /// 1 / (twice the area in 1/256 px²) = `reciprocal` · 2^(`zeros` − 48); 2¹⁶ … 2¹⁷.
    reciprocal: u32,
    /// The leading zeros of twice the area.
    zeros: u32,
    /// Corner 0's pixel.
    pixel: [i32; 2],
    /// From corner 0 to the centre of that pixel, −7 … 8 sixteenths.
    to_center: [i32; 2],
}

impl Slopes {
    /// As [`Slopes::set`].
    ///
    /// Not inlined: a caller that does more than this would keep most of it on the stack.
    #[inline(never)]
    fn set_plane(&self, plane: &mut Plane, rise_1: i32, rise_2: i32) {
        self.set(plane, rise_1, rise_2);
    }

    /// Sets range and plane of an attribute from its I16F16 values at the corners. False, and the plane of no use, if these
    /// differ by 2²⁷ or more.
    #[inline(never)]
    fn set_attribute(&self, attribute: &mut Attribute, at: &[i32; 3], scale_log2: u32) -> bool {
        let rise = attribute.set_range(*at, scale_log2);
        attribute.plane.origin = attribute.origin();
        self.set(&mut attribute.plane, rise[0], rise[1]);
        attribute.range < 1 << 27
    }

    /// Completes a plane whose `origin` holds the value at corner 0, from the rises to corners 1 and 2. Its steps are right
    /// if they fit 32 bits.
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
        // 2⁴ for 16 sixteenths, 2¹⁶ that `mul_17` took away, and 2^(zeros − 48) of the reciprocal.
        let up = (self.zeros + dropped) as i32 - 28;
        for axis in 0..2 {
            let [b, c] = self.edges[axis];
            // Two products of 19 bits and a sign with 10 bits and a sign: within ±2³⁰.
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
    /// Sets all planes of a small triangle. False, and the planes of no use, if the general way has to. `simple` says that
    /// the triangle's [rows](super::rows) are, so that a patch may draw it.
    #[inline(never)]
    pub(crate) fn set_small_planes(&mut self, triangle: &Oriented<'_>, needs: &Needs, simple: bool) -> bool {
        let edges = edges(&self.corners);
        let largest = edges.as_flattened().iter().fold(0, |all, e| all | e.unsigned_abs());
        // Less than 64 pixels from corner 0. And thick enough: no edge is longer than 2 · `largest` along an axis, so along
        // the other one the triangle measures at least 4/2 sixteenths. A rise of 2²⁷ over that makes a step of 2³⁰, which
        // fits.
        if largest >= 1 << 10 || largest * 4 > triangle.area {
            return false;
        }
        let q = triangle.vertices.map(|vertex| vertex.q.to_bits());
        let (most, least) = (q[0], q[1].min(q[2]));
        // Rounding, by less than 2048 units, must not take depth out of 2¹⁵ … 2³¹: beyond it would wrap, and below it would
        // be 0 in 16 bits.
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
        // Also where no depth is tested: a step that is refused below sends the triangle the general way, and pixels are not
        // to depend on whether depth is tested.
        self.z.origin = q[0];
        slopes.set_plane(&mut self.z, q[1].wrapping_sub(q[0]) as i32, q[2].wrapping_sub(q[0]) as i32);
        // A step is off by 2⁻¹⁷ of itself. Over `largest` sixteenths to the right and down that has to stay below 2¹³ units,
        // a quarter of a step of a 16-bit depth: step · largest ≤ 2³³.
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
        if are_set && needs.packings[0].inset > 0 {
            if needs.is_exactly_straight(least, most) {
                self.lean(triangle, needs, 2, i32::MAX);
            } else {
                self.keep_small_inside(needs);
            }
        }
        are_set
    }

    /// Sets attributes as straight or, where that is not exact enough, as bent. False, and their planes of no use, if neither
    /// will do (they have to be divided by q), or one varies too much.
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
        {
            self.straight = self.set_bent(triangle, needs, slopes, &bend, slopes_of_q);
        }
        self.straight
    }

    /// Whether linear interpolation will do for each attribute.
    #[inline]
    fn are_straight(&self, triangle: &Oriented<'_>, needs: &Needs, bend: &Bend, limit: u32) -> bool {
        needs.each_attribute(triangle, self.gray, |_, [a, b, c], scale_log2| {
            let rise = [b.wrapping_sub(a), c.wrapping_sub(a)];
            (rise[0].unsigned_abs() | rise[1].unsigned_abs()) < 1 << 27
                && bend.is_straight_for(limit, rise, 0x10000 >> scale_log2)
        })
    }

    /// Sets attributes as linear on the screen. False if the values of one differ by 2²⁷ or more.
    ///
    /// Not inlined, to keep its stack frame from being there while attributes are bent.
    #[inline(never)]
    fn set_linear(&mut self, triangle: &Oriented<'_>, needs: &Needs, slopes: &Slopes) -> bool {
        let attributes = &mut self.attributes;
        needs.each_attribute(triangle, self.gray, |i, at, scale_log2| {
            attributes.get_mut(i).is_some_and(|attribute| slopes.set_attribute(attribute, &at, scale_log2))
        })
    }

    /// Sets attributes as bent. False if the values of one differ by 2²⁷ or more. The last parameter is ∇q/q_mid per column and
    /// row, 16 fraction bits.
    #[inline]
    fn set_bent(
        &mut self,
        triangle: &Oriented<'_>,
        needs: &Needs,
        slopes: &Slopes,
        bend: &Bend,
        [q_right, q_down]: [i32; 2],
    ) -> bool {
        // Over L steps of a row a straight line is off from the quadratic by ¼·L²·|∇u·∇q|/q_mid, with both along the row. In
        // pixels that is at most ¼·L²·|∇q|/q_mid: 3/32 at most.
        self.longest = STRAIGHT / 2;
        while (self.longest * self.longest) * q_right.abs() > 3 << 13 {
            self.longest >>= 1;
        }
        let [x, y] = slopes.to_center;
        needs.each_attribute(triangle, self.gray, |i, at, scale_log2| {
            let Some(attribute) = self.attributes.get_mut(i) else {
                return false;
            };
            let rise = attribute.set_range(at, scale_log2);
            if attribute.range >= 1 << 27 {
                return false;
            }
            // ∇u: of this plane only the steps count.
            slopes.set_plane(&mut attribute.plane, rise[0], rise[1]);
            let [right, down] = attribute.plane.steps;
            // The coefficients of x², xy and y² in −(∇u·p)(∇q·p)/q_mid. u's steps are below 2³⁰, a range of 2²⁷ over at least
            // 1/8 px, and q's are at most ¼: 2²⁸, and twice that for xy.
            let xx = -mul_16_signed(right, q_right);
            let xy = -mul_16_signed(right, q_down) - mul_16_signed(down, q_right);
            let yy = -mul_16_signed(down, q_down);
            // V, in the place of ∇u: Δuᵢ·(1 − fall).
            attribute.plane.origin = attribute.origin();
            let [rise_1, rise_2] = [0, 1].map(|i| rise[i] - mul_16(rise[i], bend.fall(i)));
            slopes.set_plane(&mut attribute.plane, rise_1, rise_2);
            // The quadratic is evaluated by offsets (m, n) from the centre of corner 0's pixel, while p counts from corner 0:
            // it is (m + x/16, n + y/16). What is linear in m and n of that goes into the steps, and what is constant into
            // the origin. With x and y at most 8, sums are below 2³¹.
            let more = [(xx >> 3) * x + (xy >> 4) * y, (xy >> 4) * x + (yy >> 3) * y];
            // From pixel (0, 0) on, as the origin is.
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
        })
    }
}
