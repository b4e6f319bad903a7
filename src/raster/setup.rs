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
use super::needs::Needs;
use super::plane::Plane;
use super::scaling::Scaling;
use super::slopes::Slopes;
use super::straight::{Bend, Straight};
use super::triangle::{Planes, TriangleSetup, edges};
use crate::geometry::{ScreenVertex, nearest_first};
use crate::math::recip::Reciprocal;
use crate::num::{normalise, shift_round_short, wide};

impl TriangleSetup {
    /// Sets the plane of depth of any triangle, and those of attributes: [`InputCode::any`](super::needs::InputCode).
    #[inline(never)]
    pub(super) fn set(&mut self, vertices: &[&ScreenVertex; 3], area: u32, needs: &Needs) {
        self.set_if::<true>(vertices, area, needs);
    }

    /// Sets the plane of depth alone.
    #[inline(never)]
    pub(super) fn set_depth(&mut self, vertices: &[&ScreenVertex; 3], area: u32, needs: &Needs) {
        self.set_if::<false>(vertices, area, needs);
    }

    /// What is long is called from here, one after another, so that it is not on the stack together.
    #[inline(always)]
    fn set_if<const READS: bool>(&mut self, vertices: &[&ScreenVertex; 3], area: u32, needs: &Needs) {
        let vertices = &nearest_first(*vertices);
        self.set_corners(vertices);
        (self.planes, self.leans, self.straight) = (Planes::Screen, false, true);
        if !READS && !needs.depth {
            return;
        }
        self.set_area(Reciprocal::precise(area));
        let mut slopes = Slopes::new(self, area);
        slopes.find_middle(self);
        let near_w = vertices.map(|vertex| vertex.q.to_bits());
        // The nearest corner gets all 31 bits.
        let q = near_w.map(|q| q.clamp(1, i32::MAX as u32));
        let up = normalise(q[0]).1 - 1;
        let q = q.map(|near_w| near_w << up);
        let q_min = q[1].min(q[2]);
        self.bends[1][1] = q_min as i32;
        // Where the far corner is left with few of them, the rounding of steps would be too much for `Exact`: no planes.
        let is_perspective = matches!(needs.straight, Straight::Below(_));
        slopes.sliver |=
            needs.every_pixel && (q_min < 1 << 19 && is_perspective || slopes.are_coarse(self.area().zeros));
        if slopes.sliver {
            self.planes = Planes::Corners;
        }
        if needs.depth {
            // Depth must not wrap where rounding takes it out of 0 … 2³¹: 2048 units, 1/16 of a depth step, are room
            // for that.
            slopes.set_plane_of(&mut self.z, near_w.map(|q| q.clamp(2048, (1 << 31) - 2048)));
        }
        if !READS {
            return;
        }
        let mut scaling = needs.scaled_at_the_end();
        if let Some(uv) = &needs.code.uv
            && needs.scale != 0
        {
            (uv.scale)(needs, vertices, &mut scaling);
        }
        needs.set_gray(self, vertices);
        let is_exact = needs.is_exactly_straight(q_min, q[0]);
        self.straight = match needs.straight {
            Straight::Below(limit) if !is_exact => self.is_straight(&q, limit.get()),
            _ => true,
        };
        let reciprocal = if self.straight {
            0
        } else {
            let mut plane = Plane::default();
            slopes.set_plane_of(&mut plane, q);
            self.bends[0] = [plane.origin as i32, plane.steps[0], plane.steps[1]];
            // Only v of packed coordinates is moved by carries: twice, as u may repeat within four pixels.
            let inset = i32::from(scaling.packing(1).inset);
            self.bends[1][2] = if inset > 1 { 2 * inset } else { 0 };
            self.is_extreme =
                self.planes.is_sliver() || needs.every_pixel || self.planes_leave_range(q[0], slopes.size);
            self.set_q_step(needs.every_pixel)
        };
        needs.each_attribute(&scaling, vertices, self.gray, |i, at, scale_log2| {
            let Some(attribute) = self.attributes.get_mut(i) else {
                return false;
            };
            let mut rise = attribute.set_range(at, scale_log2);
            attribute.plane.origin = attribute.origin();
            if !self.straight {
                self.begin_bent(i, &mut rise, &q, needs, &scaling);
            }
            let Some(attribute) = self.attributes.get_mut(i) else {
                return false;
            };
            slopes.set_plane(&mut attribute.plane, rise);
            if !(self.straight || self.planes.is_sliver() && needs.every_pixel) {
                attribute.set_horizon(self.q_rises, self.q_step_zeros.into(), reciprocal);
            }
            true
        });
        if self.straight
            && let Some(uv) = &needs.code.uv
        {
            (uv.complete)(self, vertices, &scaling, is_exact.then(|| slopes.fraction_bits()));
        }
    }

    /// Whether linear interpolation will do for all attributes, from q at the corners.
    #[inline]
    fn is_straight(&self, q: &[u32; 3], limit: u32) -> bool {
        Bend::new(&edges(&self.corners()), *q).is_some_and(|bend| bend.is_straight(limit))
    }

    /// What a row needs for perspective, besides planes and horizons: the step of q along it, normalised. Returns its reciprocal.
    #[inline]
    fn set_q_step(&mut self, every_pixel: bool) -> i32 {
        let step = self.step(&self.q());
        let size = step.unsigned_abs();
        // Below 2¹² q changes by 2⁻⁸ of itself over 1023 pixels, if it is 2³⁰.
        self.is_level = !self.planes.is_sliver() && size < if every_pixel { 1 } else { 1 << 12 };
        let (mantissa, zeros) = normalise(size.max(1));
        (self.bends[1][0], self.q_step_zeros) = (mantissa as i32, zeros as u8);
        self.q_rises = step > 0;
        Reciprocal::precise_normalised(mantissa, zeros).mantissa
    }

    /// Whether the plane of U may be off by more than 2⁻¹⁷ of its attribute's range: by (n + m)/2 + 16 units of 2⁻²⁹
    /// after n columns and m rows from the middle of the triangle, times the greatest q by the least. `size` is 2·(n + m).
    #[inline]
    fn planes_leave_range(&self, greatest: u32, size: u32) -> bool {
        let units = size / 4 + 16;
        (units * (greatest >> 16)) >> 12 >= self.q_min() >> 16
    }

    /// Sets an attribute of a bent triangle, whose range is set, but for its plane and its horizon. Takes how much it rises from corner 0
    /// to 1 and 2, I16F16, and makes it what the plane does.
    #[inline(never)]
    fn begin_bent(&mut self, i: usize, rise: &mut [i32; 2], q: &[u32; 3], needs: &Needs, scaling: &Scaling) {
        let Some(attribute) = self.attributes.get_mut(i) else {
            return;
        };
        *rise = contract(attribute, *rise, i, scaling, self.is_extreme);
        attribute.plane.origin = 0;
        if self.planes.is_sliver() && needs.every_pixel {
            // For `resolve_in_sliver`.
            return;
        }
        let products = [wide(rise[0], q[1] as i32), wide(rise[1], q[2] as i32)];
        let largest = products[0].unsigned_abs() | products[1].unsigned_abs();
        // 30 bits of the larger, and not quite 2³⁰.
        let (_, zeros) = normalise(((largest + (largest >> 15)) >> 30) as u32 | 1);
        attribute.shift = zeros as u16;
        *rise = products.map(|product| shift_round_short(product, 32 - zeros));
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
