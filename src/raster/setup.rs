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
use super::scaling::Scaling;
use super::straight::{Bend, Straight};
use super::triangle::{Needs, TriangleSetup, edges};
use crate::geometry::{Inputs, Oriented, position};
use crate::math::recip::Reciprocal;
use crate::num::{mul_round, normalise, shift_round_short, wide};

/// How weights of corners 1 and 2 change over the screen, and where planes begin: for set-up only.
struct Slopes {
    /// Whether planes hold the values at the corners: see [`TriangleSetup::sliver`].
    sliver: bool,
    /// Over one column, over one row, in units of 2^−(32 + `fraction_bits`).
    of_weights: [[i32; 2]; 2],
    fraction_bits: i32,
    /// Corner 0's pixel.
    pixel: [i32; 2],
    /// From corner 0 to the centre of that pixel, −7 … 8 sixteenths.
    to_center: [i32; 2],
    /// From that pixel to the middle of what is within the screen.
    to_middle: [i32; 2],
    /// Columns and rows of what is within the screen, added up.
    size: u32,
}

impl Slopes {
    /// Finds out whether it is a sliver, too. `area` is twice the area in 1/256 px².
    ///
    /// Not inlined: what it takes is not on the stack while planes are set.
    #[inline(never)]
    fn new(setup: &TriangleSetup, area: u32) -> Self {
        let (edges, a) = (edges(&setup.corners), setup.corners[0]);
        let spread = |e: [i32; 2]| (e[0].abs() + e[1].abs()) as u32; // below 2¹⁶
        let (height, width) = (spread(edges[0]), spread(edges[1]));
        // The largest difference to 30 bits, times 1/area.
        let largest = edges.as_flattened().iter().fold(1, |all, e| all | e.unsigned_abs());
        let shift = normalise(largest).1 - 2;
        let Reciprocal { mantissa, zeros } = setup.area;
        // (e·2^shift · mantissa) / 2³¹, by halves of the mantissa: e is below 2¹⁵, and so `shift` at least 15.
        let weight =
            |e: i32| ((e * (mantissa >> 16)) << (shift - 15)) + ((e * (mantissa & 0xffff)) >> (31 - shift));
        let pixel = a.map(|at| at >> 4);
        let extents = [0, 1].map(|axis| setup.extent(axis));
        Self {
            // Steps must fit 32 bits: at least a pixel wide and high. And their errors, one and a half unit of
            // 2^−`fraction_bits` a pixel, must not exceed 256 units over the triangle's extent of 2^(30 − `shift`) sixteenths.
            sliver: height.max(width) * 16 > area || 2 * shift < 23 + zeros,
            of_weights: edges.map(|edge| edge.map(weight)),
            // A weight · 2^−(32 + n) = 16·e·mantissa·2^(zeros − 62)
            fraction_bits: shift as i32 - 5 - zeros as i32,
            pixel,
            to_center: [pixel[0] * 16 + 8 - a[0], pixel[1] * 16 + 8 - a[1]],
            to_middle: [0, 1].map(|axis| ((extents[axis][0] + extents[axis][1]) >> 1) - pixel[axis]),
            size: extents.iter().map(|[first, last]| last - first).sum::<i32>() as u32,
        }
    }

    /// Completes a plane whose `origin` holds the value at corner 0, from the rise to corners 1 and 2.
    #[inline(never)]
    fn set_plane(&self, plane: &mut Plane, rise: [i32; 2]) {
        if self.sliver {
            plane.steps = rise;
            return;
        }
        for axis in 0..2 {
            let [b, c] = self.of_weights[axis];
            let slope = mul_round::<32>(rise[0], b).wrapping_add(mul_round::<32>(rise[1], c));
            let bits = self.fraction_bits;
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
    fn set_plane_of(&self, plane: &mut Plane, at: [u32; 3]) {
        plane.origin = at[0];
        self.set_plane(plane, [1, 2].map(|i| at[i].wrapping_sub(at[0]) as i32));
    }
}

/// What all attributes of a bent triangle have in common: for set-up only.
struct Bent<'a> {
    slopes: &'a Slopes,
    /// At the corners.
    q: [u32; 3],
    /// 1/(the step of q along a row), from that normalised.
    reciprocal: i32,
    every_pixel: bool,
    scaling: &'a Scaling,
}

impl TriangleSetup {
    /// Sets all planes of any triangle, the nearest vertex of which is first.
    #[inline(never)]
    pub(crate) fn set(&mut self, triangle: &Oriented<'_>, needs: &Needs) {
        self.corners = triangle.vertices.map(position);
        (self.is_small, self.sliver, self.leans) = (false, false, false);
        if needs.inputs == Inputs::None && !needs.depth {
            self.straight = true;
            return;
        }
        if needs.reads_color() {
            self.set_gray(&triangle.vertices, needs);
        }
        let is_scaled = needs.scale != 0 && needs.reads_uv();
        let scaling =
            if is_scaled { needs.scaled_for(&triangle.vertices) } else { needs.scaled_at_the_end() };
        self.set_planes(triangle, needs, &scaling);
    }

    #[inline(never)]
    fn set_planes(&mut self, triangle: &Oriented<'_>, needs: &Needs, scaling: &Scaling) {
        self.area = Reciprocal::precise(triangle.area);
        let mut slopes = Slopes::new(self, triangle.area);
        let near_w = triangle.vertices.map(|vertex| vertex.q.to_bits());
        // The nearest corner gets all 31 bits.
        let q = near_w.map(|q| q.clamp(1, i32::MAX as u32));
        let up = normalise(q[0]).1 - 1;
        let q = q.map(|near_w| near_w << up);
        self.q_min = q[1].min(q[2]);
        // Where the far corner is left with few of them, the rounding of steps would be too much for `Exact`: no planes.
        let is_perspective = matches!(needs.straight, Straight::Below(_));
        slopes.sliver |= needs.every_pixel && self.q_min < 1 << 19 && is_perspective;
        self.sliver = slopes.sliver;
        if needs.depth {
            // Depth must not wrap where rounding takes it out of 0 … 2³¹: 2048 units, 1/16 of a depth step, are room
            // for that.
            slopes.set_plane_of(&mut self.z, near_w.map(|q| q.clamp(2048, (1 << 31) - 2048)));
        }
        if needs.inputs == Inputs::None {
            self.straight = true;
            return;
        }
        let is_exact = needs.is_exactly_straight(self.q_min, q[0]);
        self.straight = match needs.straight {
            Straight::Below(limit) if !is_exact => self.is_straight(&q, limit),
            _ => true,
        };
        if self.straight {
            needs.each_attribute(scaling, &triangle.vertices, self.gray, |i, at, scale_log2| {
                let attribute = &mut self.attributes[i];
                let rise = attribute.set_range(at, scale_log2);
                attribute.plane.origin = attribute.origin();
                slopes.set_plane(&mut attribute.plane, rise);
                true
            });
            if needs.reads_uv() {
                self.settle(&triangle.vertices, scaling, is_exact.then_some(slopes.fraction_bits));
            }
            return;
        }
        slopes.set_plane_of(&mut self.q, q);
        self.is_extreme = self.sliver || needs.every_pixel || self.planes_leave_range(q[0], slopes.size);
        let reciprocal = self.set_q_step(needs.every_pixel);
        let bent = Bent { slopes: &slopes, q, reciprocal, every_pixel: needs.every_pixel, scaling };
        needs.each_attribute(scaling, &triangle.vertices, self.gray, |i, at, scale_log2| {
            self.set_bent_attribute(i, &at, scale_log2, &bent);
            true
        });
    }

    /// Whether linear interpolation will do for all attributes, from q at the corners.
    #[inline]
    fn is_straight(&self, q: &[u32; 3], limit: u32) -> bool {
        Bend::new(&edges(&self.corners), *q).is_some_and(|bend| bend.is_straight(limit))
    }

    /// What a row needs for perspective, besides planes and horizons: the step of q along it, normalised. Returns its reciprocal.
    #[inline]
    fn set_q_step(&mut self, every_pixel: bool) -> i32 {
        let step = self.step(&self.q);
        let size = step.unsigned_abs();
        // Below 2¹² q changes by 2⁻⁸ of itself over 1023 pixels, if it is 2³⁰.
        self.is_level = !self.sliver && size < if every_pixel { 1 } else { 1 << 12 };
        (self.q_step, self.q_step_zeros) = normalise(size.max(1));
        self.q_rises = step > 0;
        Reciprocal::precise_normalised(self.q_step, self.q_step_zeros).mantissa
    }

    /// Whether the plane of U may be off by more than 2⁻¹⁷ of its attribute's range: by (n + m)/2 + 16 units of 2⁻²⁹
    /// after n columns and m rows from the middle of the triangle, times the greatest q by the least. `size` is 2·(n + m).
    #[inline]
    fn planes_leave_range(&self, greatest: u32, size: u32) -> bool {
        let units = size / 4 + 16;
        (units * (greatest >> 16)) >> 12 >= self.q_min >> 16
    }

    /// Sets an attribute of a bent triangle from its I16F16 values at the corners (within ±2²⁹).
    #[inline]
    fn set_bent_attribute(&mut self, i: usize, at: &[i32; 3], scale_log2: u32, bent: &Bent<'_>) {
        let Some(attribute) = self.attributes.get_mut(i) else {
            return;
        };
        let &Bent { slopes, q, reciprocal, every_pixel, scaling } = bent;
        let rise = attribute.set_range(*at, scale_log2);
        let rise = contract(attribute, rise, i, scaling, self.is_extreme);
        attribute.plane.origin = 0;
        if self.sliver && every_pixel {
            // For `resolve_in_sliver`.
            return slopes.set_plane(&mut attribute.plane, rise);
        }
        let products = [wide(rise[0], q[1] as i32), wide(rise[1], q[2] as i32)];
        let largest = products[0].unsigned_abs() | products[1].unsigned_abs();
        // 30 bits of the larger, and not quite 2³⁰.
        let (_, zeros) = normalise(((largest + (largest >> 15)) >> 30) as u32 | 1);
        attribute.shift = zeros as i32;
        slopes
            .set_plane(&mut attribute.plane, products.map(|product| shift_round_short(product, 32 - zeros)));
        // Only v of packed coordinates is moved by carries: twice, as u may repeat within four pixels.
        let inset = u32::from(scaling.packing(1).inset);
        let inset = if i == 1 && inset > 1 { 2 * inset } else { 0 };
        attribute.set_horizon(self.q_rises, self.q_step_zeros, reciprocal, inset);
    }
}

/// Moves an attribute's values at the corners a little towards the middle of their range: so that what rounding adds on the
/// way to a pixel does not take it out of that. Takes and returns how much it rises from corner 0 to 1 and 2.
///
/// That is 2⁻¹⁶ of the range, and 64 units at least, which are 2⁻¹⁰ of a texel or of 1/255; in extreme triangles
/// 4 units, as there slopes come from both ends. Of texture coordinates that are packed it is 16 units of these
/// at least: over a chord of 8 pixels v loses up to 8 by rounding, and 4 by carries. At the far end of a row the
/// plane of U may be off by 2⁻¹⁷ of the range; where it may be more, the triangle [is
/// extreme](TriangleSetup::planes_leave_range). The division at the near end is off by 2⁻²⁰, which 1/w makes 2⁻¹⁷
/// at most.
#[inline]
fn contract(
    attribute: &mut Attribute,
    rise: [i32; 2],
    i: usize,
    scaling: &Scaling,
    is_extreme: bool,
) -> [i32; 2] {
    let packing = scaling.packing(i);
    let (least, most_shift) = if is_extreme { (3, 31) } else { (7, 15) };
    let log2 = if i < 2 { packing.contraction_log2().max(least) } else { least };
    if attribute.range >> log2 > 1 {
        let shift = 31 - normalise(attribute.range).1 - log2;
        return attribute.draw_in(rise, shift.min(most_shift));
    }
    // No room: one value all over. v gets the centre of its texel, out of which no carry moves it.
    attribute.keep_amid(if i == 1 { packing.inset.into() } else { 0 });
    [0; 2]
}
