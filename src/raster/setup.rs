//! Set-up of any triangle: what its rows and pixels need, computed once.
//!
//! - In: an oriented triangle, and what the shader wants of it.
//! - Out: the planes of depth, q and attributes, in a `TriangleSetup` that is used again.
//! - Assumes: the corners lie in the guard band.
//!
//! An edge function is the signed area of an edge and a point, in 1/256 px²:
//!
//! ```text
//! E_ab(p) = (b.x − a.x)(p.y − a.y) − (b.y − a.y)(p.x − a.x)
//! ```
//!
//! Divided by the triangle's own area it is the barycentric weight of the corner opposite. In a guard
//! band of ±1023½ px no difference exceeds 2047·16 = 32752, so no edge function exceeds
//! 2·32752² = 2 145 387 008 < 2³¹: they are exact in an `i32`.
//!
//! # Attributes, and why they are exact enough
//!
//! After projection u is not linear on the screen, but q and u·q are. Both are held as integers
//! that use all bits of this triangle's range: q scaled so that the nearest corner has 31 bits, and
//! U = (u − u₀)·q with 30, u₀ being the u of the **nearest** corner. With d the triangle's extent in pixels
//! and M the largest change of u per pixel step at p:
//!
//! - u is a quotient of linear functions, so u(corner) − u(p) = (q(p)/q(corner)) · ∇u(p)·(corner − p):
//!   |u₀ − u(p)| ≤ 2·M·d · q(p)/q₀, and |U(corner)| ≤ 4·M·d · q(p).
//! - An error of k units in q (of 2⁻³⁰·q₀ or less) moves u by k·2⁻³⁰·q₀·|u₀ − u|/q ≤ k·2⁻²⁹·M·d.
//! - An error of k units in U (of 2⁻²⁹·max|U|) moves u by k·2⁻²⁹·max|U|/q ≤ k·2⁻²⁷·M·d.
//! - The reciprocal's 2⁻²⁰ moves u by 2⁻¹⁹·M·d; the 17 bits of it that rows take where q is the same all along, by
//!   2⁻¹⁶·M·d, 0.031 px at most.
//!
//! Each is kept as a plane: a value at pixel (0, 0) and one rounded step a column and a row, **in wrapping
//! integers**. What the plane says far outside the triangle wraps, and wraps back: inside, where the true value fits
//! 32 bits, only the rounding of the steps remains, k ≤ (n + m)/2 + 16 after n columns and m rows from the middle of
//! what is within the screen. With n, m ≤ 512 and d ≤ 2047 the sum of these, without the 17 bits of level rows, is
//! 0.014 px in the very worst case for any ratio of w.
//!
//! # Which texel a whole coordinate is
//!
//! Where q is the same at all corners, or does not count, texture coordinates are straight: then a coordinate that is whole at a
//! pixel's centre is sampled infinitesimally right of that, and infinitely less below, as coverage is by the top-left rule. So
//! `TriangleSetup::lean` moves its plane in the direction in which it changes there, once, by as much as all that follows may be
//! behind. And its range ends below the greatest value at the corners: so it does for all triangles.
//!
//! # Slivers
//!
//! In a sliver, thinner than a pixel or two along x or y, the steps are large and nearly cancel, and where distances
//! differ more than 4096-fold q has too few bits at the far corner for [`Exact`](crate::Exact). Then a plane holds
//! the values at the corners instead, and is evaluated by weights from the exact edge functions, which never cancel;
//! `Exact` mixes attributes at every pixel, by weights from the exact products of edge functions and q. Both are
//! slower, rare, and out of line.

use super::attribute::Attribute;
use super::plane::Plane;
use super::straight::{Bend, Straight};
use super::triangle::{Needs, STRAIGHT, TriangleSetup, edges};
use crate::geometry::{Inputs, Oriented, is_gray};
use crate::math::recip::Reciprocal;
use crate::num::{mul_round, normalised, shift_round, wide};

/// How weights of corners 1 and 2 change over the screen, and where planes begin: for set-up only.
struct Slopes {
    /// Over one column, over one row, in units of 2^−(32 + `fraction_bits`).
    of_weights: [[i32; 2]; 2],
    fraction_bits: i32,
    /// Corner 0's pixel.
    pixel: [i32; 2],
    /// From corner 0 to the centre of that pixel, −7 … 8 sixteenths.
    to_center: [i32; 2],
    /// From that pixel to the middle of what is within the screen.
    to_middle: [i32; 2],
}

impl TriangleSetup {
    #[inline]
    pub(crate) fn set(&mut self, triangle: &Oriented<'_>, needs: &Needs, simple: bool) {
        self.sliver = false;
        self.leans = false;
        self.is_small = true;
        self.longest = STRAIGHT;
        if needs.inputs == Inputs::None && !needs.depth {
            self.straight = true;
            return;
        }
        if matches!(needs.inputs, Inputs::Color | Inputs::UvColor) {
            self.gray = needs.gray || triangle.vertices.into_iter().all(|vertex| is_gray(vertex.color));
        }
        if needs.scale_log2[0] > 0 && needs.packings[0].inset > 0 {
            return self.set_scaled(triangle, needs, simple);
        }
        if !self.set_small_planes(triangle, needs, simple) {
            self.set_any_planes(triangle, needs);
        }
    }

    /// Where texture coordinates are scaled, as much of the scale as there is room for goes into planes: for their rounding is
    /// multiplied by the rest of it. What is beyond ±32768 wraps, as it would if it were scaled at the end.
    #[cold]
    #[inline(never)]
    fn set_scaled(&mut self, triangle: &Oriented<'_>, needs: &Needs, simple: bool) {
        let [a, b, c] = triangle.vertices.map(|vertex| [vertex.u, vertex.v].map(|uv| uv.to_bits()));
        let sizes = [0, 1].map(|i| {
            (b[i] - a[i]).unsigned_abs() | (c[i] - a[i]).unsigned_abs() | (c[i] - b[i]).unsigned_abs()
        });
        // Differences stay below 2²⁷ in a small triangle, and 2²⁹ in any other.
        let within = |bits: u32| {
            let finer =
                [0, 1].map(|i| sizes[i].leading_zeros().saturating_sub(32 - bits).min(needs.scale_log2[i]));
            let scale_log2 = [0, 1].map(|i| needs.scale_log2[i] - finer[i]);
            Needs { finer, scale_log2, packings: [0, 1].map(|i| needs.packings[i].finer(finer[i])), ..*needs }
        };
        if !self.set_small_planes(triangle, &within(27), simple) {
            self.set_any_planes(triangle, &within(29));
        }
    }

    #[inline(never)]
    fn set_any_planes(&mut self, triangle: &Oriented<'_>, needs: &Needs) {
        self.is_small = false;
        let vertices = triangle.vertices;
        self.area = Reciprocal::precise(triangle.area);
        let slopes = self.slopes(triangle.area);
        let near_w = vertices.map(|vertex| vertex.q.to_bits());
        // The nearest corner gets all 31 bits.
        let q = near_w.map(|q| q.clamp(1, i32::MAX as u32));
        let q = q.map(|near_w| near_w << (q[0].leading_zeros() - 1));
        self.q_min = q[1].min(q[2]);
        // Where the far corner is left with few of them, the rounding of steps would be too much for `Exact`: no planes.
        let is_perspective = matches!(needs.straight, Straight::Below(_));
        self.sliver |= needs.every_pixel && self.q_min < 1 << 19 && is_perspective;
        if needs.depth {
            // Depth must not wrap where rounding takes it out of 0 … 2³¹: 2048 units, 1/16 of a depth step, are room
            // for that.
            let z = near_w.map(|q| q.clamp(2048, (1 << 31) - 2048));
            self.z = self.plane(&slopes, z[0], [1, 2].map(|i| z[i].wrapping_sub(z[0]) as i32));
        }
        if needs.inputs == Inputs::None {
            self.straight = true;
            return;
        }
        let is_exact = needs.is_exactly_straight(self.q_min, q[0]);
        self.straight = match needs.straight {
            Straight::Below(limit) if !is_exact => {
                Bend::new(&edges(&self.corners), q, self.q_min).is_some_and(|bend| bend.is_straight(limit))
            }
            _ => true,
        };
        if !self.straight {
            self.q = self.plane(&slopes, q[0], [1, 2].map(|i| q[i].wrapping_sub(q[0]) as i32));
        }
        let mixed = self.sliver && needs.every_pixel;
        self.is_extreme =
            !self.straight && (self.sliver || needs.every_pixel || self.planes_leave_range(q[0]));
        needs.each_attribute(triangle, self.gray, |i, at, scale_log2| {
            let at = if self.straight { at } else { self.contract(at, i, needs) };
            self.attributes[i] = self.attribute(&slopes, at, scale_log2, &q, mixed);
            true
        });
        if needs.packings[0].inset > 0 && self.straight {
            self.settle(triangle, needs, is_exact.then_some(slopes.fraction_bits));
        }
        if !self.straight {
            self.set_horizons(needs);
        }
    }

    /// What a row needs for perspective, besides the planes: the step of q along it, normalised, and each attribute's
    /// value at the horizon.
    fn set_horizons(&mut self, needs: &Needs) {
        let step = self.q.steps[0];
        let size = step.unsigned_abs();
        // Below 2¹² q changes by 2⁻⁸ of itself over 1023 pixels, if it is 2³⁰.
        self.is_level = !self.sliver && size < if needs.every_pixel { 1 } else { 1 << 12 };
        (self.q_step, self.q_step_zeros) = normalised(size.max(1));
        self.q_rises = step > 0;
        let reciprocal = Reciprocal::precise_normalised(self.q_step, self.q_step_zeros).mantissa;
        let inset = u32::from(needs.packings[1].inset);
        for (i, attribute) in self.attributes.iter_mut().take(needs.count(self.gray)).enumerate() {
            // Only v of packed coordinates is moved by carries: twice, as u may repeat within four pixels.
            let inset = if i == 1 && inset > 1 { 2 * inset } else { 0 };
            attribute.set_horizon(self.q_rises, self.q_step_zeros, reciprocal, inset);
        }
    }

    /// Whether the plane of U may be off by more than 2⁻¹⁷ of its attribute's range: by (n + m)/2 + 16 units of 2⁻²⁹
    /// after n columns and m rows from the middle of the triangle, times the greatest q by the least.
    fn planes_leave_range(&self, greatest: u32) -> bool {
        let [width, height] = [0, 1].map(|axis| self.extent(axis)).map(|[first, last]| (last - first) as u32);
        let units = (width + height) / 4 + 16;
        (units * (greatest >> 16)) >> 12 >= self.q_min >> 16
    }

    /// An attribute's values at the corners, I16F16, each moved a little towards the middle of the three: so that
    /// what rounding adds on the way to a pixel does not take it out of their range.
    ///
    /// That is 2⁻¹⁶ of the range, and 64 units at least, which are 2⁻¹⁰ of a texel or of 1/255; in extreme triangles
    /// 4 units, as there slopes come from both ends. Of texture coordinates that are packed it is 16 units of these
    /// at least: over a chord of 8 pixels v loses up to 8 by rounding, and 4 by carries. At the far end of a row the
    /// plane of U may be off by 2⁻¹⁷ of the range; where it may be more, the triangle [is
    /// extreme](TriangleSetup::planes_leave_range). The division at the near end is off by 2⁻²⁰, which 1/w makes 2⁻¹⁷
    /// at most.
    fn contract(&self, at: [i32; 3], i: usize, needs: &Needs) -> [i32; 3] {
        let is_packed = needs.packings[0].inset > 1 && i < 2;
        let log2 = if is_packed && !needs.packings[0].is_large() {
            31 - normalised(needs.packings[i].unit.into()).1 + 5
        } else {
            0
        };
        let log2 = log2.max(if self.is_extreme { 3 } else { 7 });
        let rise = [at[1].wrapping_sub(at[0]), at[2].wrapping_sub(at[0])];
        let (low, high) = (rise[0].min(rise[1]).min(0), rise[0].max(rise[1]).max(0));
        let range = high.wrapping_sub(low) as u32;
        let middle = at[0].wrapping_add(low).wrapping_add_unsigned(range >> 1);
        if range >> log2 > 1 {
            let shift = 31 - normalised(range).1 - log2;
            let shift = if self.is_extreme { shift } else { shift.min(15) };
            return at.map(|at| at.wrapping_add(middle.wrapping_sub(at) >> shift));
        }
        // No room: one value all over. v gets the centre of its texel, out of which no carry moves it.
        let texel = 0x10000 >> needs.scale_log2[i & 1];
        [if is_packed && i == 1 { (middle & -texel) + texel / 2 } else { middle }; 3]
    }

    /// Finds out whether it is a sliver, too.
    ///
    /// Not inlined: what it takes is not on the stack while planes are set.
    #[inline(never)]
    fn slopes(&mut self, area: u32) -> Slopes {
        let (edges, a) = (edges(&self.corners), self.corners[0]);
        let spread = |e: [i32; 2]| (e[0].abs() + e[1].abs()) as u32; // below 2¹⁶
        let (height, width) = (spread(edges[0]), spread(edges[1]));
        // The largest difference to 30 bits, times 1/area.
        let largest = edges.as_flattened().iter().fold(1, |all, e| all | e.unsigned_abs());
        let shift = largest.leading_zeros() - 2;
        // Steps must fit 32 bits: at least a pixel wide and high. And their errors, one and a half unit of 2^−`fraction_bits` a
        // pixel, must not exceed 256 units over the triangle's extent of 2^(30 − `shift`) sixteenths.
        self.sliver = height.max(width) * 16 > area || 2 * shift < 23 + self.area.zeros;
        let pixel = a.map(|at| at >> 4);
        Slopes {
            of_weights: edges.map(|edge| edge.map(|e| (wide(e << shift, self.area.mantissa) >> 31) as i32)),
            // (e·2^shift · mantissa / 2³¹) · 2^−(32 + n) = 16·e·mantissa·2^(zeros − 62)
            fraction_bits: shift as i32 - 5 - self.area.zeros as i32,
            pixel,
            to_center: [pixel[0] * 16 + 8 - a[0], pixel[1] * 16 + 8 - a[1]],
            to_middle: [0, 1].map(|axis| {
                let [first, last] = self.extent(axis);
                ((first + last) >> 1) - pixel[axis]
            }),
        }
    }

    /// From the value at corner 0 and the rise from there to corners 1 and 2.
    #[inline(never)]
    fn plane(&self, slopes: &Slopes, origin: u32, rise: [i32; 2]) -> Plane {
        if self.sliver {
            return Plane { origin, steps: rise };
        }
        let mut plane = Plane { origin, steps: [0; 2] };
        for axis in 0..2 {
            let [b, c] = slopes.of_weights[axis];
            let slope = mul_round::<32>(rise[0], b).wrapping_add(mul_round::<32>(rise[1], c));
            let bits = slopes.fraction_bits;
            let (step, rest) = if bits > 0 {
                let step = ((slope >> (bits - 1)) + 1) >> 1;
                // What rounding leaves, with at most 12 of its bits, as far as the middle is away.
                let rest = slope.wrapping_sub(step << bits);
                (
                    step,
                    if bits > 12 {
                        ((rest >> (bits - 12)) * slopes.to_middle[axis]) >> 12
                    } else {
                        (rest * slopes.to_middle[axis]) >> bits
                    },
                )
            } else {
                (slope << -bits, 0)
            };
            plane.steps[axis] = step;
            plane.origin = plane
                .origin
                .wrapping_add_signed((step >> 4) * slopes.to_center[axis])
                .wrapping_sub((slopes.pixel[axis].wrapping_mul(step)) as u32)
                .wrapping_add_signed(rest);
        }
        plane
    }

    /// An attribute from its I16F16 values at the corners (within ±2²⁹), and q there; `mixed` for
    /// [`resolve_in_sliver`](Self::resolve_in_sliver).
    #[inline(never)]
    fn attribute(
        &self,
        slopes: &Slopes,
        at: [i32; 3],
        scale_log2: u32,
        q: &[u32; 3],
        mixed: bool,
    ) -> Attribute {
        let (mut attribute, rise) = Attribute::between(at, scale_log2);
        if self.straight || mixed {
            let origin = if mixed && !self.straight { 0 } else { attribute.origin() };
            attribute.plane = self.plane(slopes, origin, rise);
            return attribute;
        }
        let products = [wide(rise[0], q[1] as i32), wide(rise[1], q[2] as i32)];
        let largest = products[0].unsigned_abs() | products[1].unsigned_abs();
        // 30 bits of the larger, and not quite 2³⁰.
        let exponent = 34u32.saturating_sub((largest + (largest >> 15)).leading_zeros()).max(1);
        let scaled = products.map(|product| shift_round(product, exponent) as i32);
        attribute.plane = self.plane(slopes, 0, scaled);
        attribute.shift = 32 - exponent as i32;
        attribute
    }
}
