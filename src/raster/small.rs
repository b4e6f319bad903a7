//! Set-up of a small triangle, as most triangles of a mesh are: what [`setup`](super::setup) does, in 32-bit products.
//!
//! - In: a triangle at most 32 pixels wide and less high, clockwise from its uppermost corner on, and what the shader wants of it.
//! - Out: the planes of its depth and attributes; or `false` if it has to be set up by the general way.
//! - Assumes: the corners lie in the guard band.
//!
//! The general way takes a triangle nevertheless if it is too thin, if q varies too much, if its attributes have to be divided by q at
//! its pixels, or if a colour would be off by more than what shows ([`Needs::color_step`]).
//!
//! # One gradient for all
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
//!
//! # Range by construction
//!
//! Nothing limits a *plain* triangle's attributes at its pixels. Instead corners that are within a margin of the least and the
//! greatest value are moved to that margin before the plane is made ([`Gradients::set_within`]). A margin is as much as all that follows
//! may be off by: the plane, and what packing takes ([`Needs::margins`]). A texture coordinate is moved by 1/20 texel at most (64 texels
//! a side), a colour by 1/256 of 1/255.
//!
//! Others are *held*: at the ends of each row their attributes are limited to the range of the corners. These are
//!
//! - triangles whose texture coordinates are exactly straight, and [lean](super::lean);
//! - those whose u repeats within four pixels, evaluated pixel by pixel;
//! - straight ones in [`Exact`](crate::Exact), which would not stand a margin;
//! - bent ones.
//!
//! # Bent triangles
//!
//! A triangle that is not straight may be *bent*: its texture coordinates are quadratics on the screen, and again no pixel divides.
//! [`straight`](super::straight) has the difference of exact and linear u: the covariance of u and q, divided by q. The
//! covariance is a quadratic that is 0 at the corners. With a constant in the place of the divisor, q_mid = (q_min +
//! q_max)/2, the whole is one, too:
//!
//! ```text
//! u = u₀ + V·p − (∇u·p)(∇q·p)/q_mid,   p being the offset from corner 0
//! ```
//!
//! ∇u and ∇q are the gradients of linear interpolation. V is the gradient with which u is right at corners 1 and 2: V·p is
//! Δuᵢ·(1 + Δqᵢ/q_mid) there.
//!
//! q_mid differs from q by at most half of what q varies by. So of the correction, at most (length/4)·fall pixels, at most
//! fall/2 is wrong: length·fall²/8 pixels, of which 3/32 are allowed. A row is drawn as straight lines between points
//! of the quadratic, which may be off by 3/32 again. Rounding has the rest of the quarter pixel.
//!
//! Colours are linear all the same: they may be off by a step of the target's finest channel.

use super::packing::PACKED_MARGIN;
use super::plane::Plane;
use super::spans::SmallEdges;
use super::straight::{Bend, Straight};
use super::triangle::{Needs, TriangleSetup};
use crate::geometry::{Inputs, ScreenVertex};
use crate::math::recip::short_of;
use crate::num::mul_17;

/// What all planes of a triangle have in common.
pub(super) struct Gradients {
    /// How the edge functions of corners 1 and 2 change over a column, and over a row, of 1/16 px.
    pub(super) edges: [[i32; 2]; 2],
    /// 1 / (twice the area in 1/256 px²) = `reciprocal` · 2^(`zeros` − 48); 2¹⁶ … 2¹⁷.
    reciprocal: u32,
    /// By how much slopes are shifted left, −8 … 9: `zeros` − 20. These are 2⁴ for 16 sixteenths, 2⁸ for the rises' unit, 2¹⁶ that
    /// `mul_17` took away, and 2^(`zeros` − 48).
    up: i32,
    /// Corner 0's pixel.
    pub(super) pixel: [i32; 2],
    /// From corner 0 to the centre of that pixel, −7 … 8 sixteenths.
    pub(super) to_center: [i32; 2],
}

impl Gradients {
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
            plane.origin = plane
                .origin
                .wrapping_add_signed((step >> 4) * self.to_center[axis])
                .wrapping_sub(self.pixel[axis].wrapping_mul(step) as u32);
        }
    }

    /// Likewise.
    #[inline(never)]
    pub(super) fn set_plane(&self, plane: &mut Plane, at: u32, rises: &[i32; 2]) {
        self.set(plane, at, *rises);
    }

    /// Sets the plane of an attribute from its value at corner 0 and the rises to corners 1 and 2, in units of 2⁸ of the plane's, so that
    /// it stays a `margin` inside its range at the corners. Where there is no room for that it is the middle of the range, all over: or
    /// of the texel that this is in. Returns the least value, less that at corner 0, and the range; from 2¹⁹ on no plane is set.
    #[inline(never)]
    fn set_within(&self, plane: &mut Plane, at: i32, rises: &[i32; 2], margin: i32) -> [i32; 2] {
        let [mut b, mut c] = *rises;
        let (least, greatest) = (b.min(c).min(0), b.max(c).max(0));
        if greatest - least >= 1 << 19 {
            return [least, greatest - least];
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
            }
        }
        self.set(plane, ((at + first) << 8) as u32, [b, c]);
        [least, greatest - least]
    }
}

impl TriangleSetup {
    /// Sets all planes of a small triangle. False, and the planes of no use, if the general way has to.
    #[inline(never)]
    pub(crate) fn set_small(
        &mut self,
        vertices: &[&ScreenVertex; 3],
        edges: &SmallEdges,
        area: u32,
        needs: &Needs,
    ) -> bool {
        let &SmallEdges { top, next: [bx, by], last: [cx, cy] } = edges;
        let size = |x: i32| x ^ (x >> 31);
        self.is_small = true;
        (self.is_held, self.is_bent, self.sliver) = (false, false, false);
        // At least the largest difference, and less than twice that.
        let largest = (size(bx) | by | size(cx) | cy) as u32;
        // Thick enough: no edge is longer than 2 · `largest` along an axis, so along the other one the triangle measures at
        // least 4/2 sixteenths. A rise of 2²⁷ over that makes a step of 2³⁰, which fits.
        if largest * 4 > area {
            return false;
        }
        if needs.inputs == Inputs::None && !needs.depth {
            return true;
        }
        let [q, q_b, q_c] = vertices.map(|vertex| vertex.q.to_bits());
        // Rounding, by less than 2048 units, must not take depth out of 2¹⁵ … 2³¹: beyond it would wrap, and below it would
        // be 0 in 16 bits.
        let room = |q: u32| q.wrapping_sub((1 << 15) + 2048);
        if room(q).max(room(q_b)).max(room(q_c)) > (1 << 31) - (1 << 15) - 4096 {
            return false;
        }
        let [rise_b, rise_c] = [q_b, q_c].map(|other| other.wrapping_sub(q) as i32);
        let fall = (size(rise_b) | size(rise_c) | size(rise_b.wrapping_sub(rise_c))) as u32;
        if fall >= 1 << 27 {
            return false;
        }
        if needs.scale != 0 && !are_narrow(vertices, needs.scale) {
            return false;
        }
        let (reciprocal, zeros) = short_of(area);
        let gradients = Gradients {
            edges: [[cy, -by], [-cx, bx]],
            reciprocal,
            up: zeros as i32 - 20,
            pixel: top.map(|at| at >> 4),
            to_center: top.map(|at| 8 - (at & 15)),
        };
        gradients.set_plane(&mut self.z, q, &[rise_b >> 8, rise_c >> 8]);
        if needs.inputs == Inputs::None {
            return true;
        }
        if needs.every_pixel {
            return self.set_held(vertices, needs, &gradients, [q, q_b, q_c]);
        }
        let mut bend = ColorBend::NONE;
        if fall != 0
            && let Straight::Below(limit) = needs.straight
        {
            let least = q.min(q_b).min(q_c);
            // As `Bend::is_needless`, with the largest difference for all edges: 26 bits, and 12 times 15 and a bit.
            if (2 * largest) * ((fall >> 12) + 1) > ((least >> 16) * limit) >> 8 {
                bend = ColorBend::new(fall, least, needs.color_step);
            }
        } else if needs.reads_uv() {
            return self.set_held(vertices, needs, &gradients, [q, q_b, q_c]);
        }
        if needs.reads_uv() {
            if !self.set_uv(vertices, needs, &gradients) {
                return false;
            }
            if bend.is_needed()
                && let Straight::Below(limit) = needs.straight
                && !Bend::is_needless(&gradients.edges, [q, q_b, q_c], limit)
                && !self.bend(vertices, needs, &gradients, [q, q_b, q_c], limit)
            {
                return false;
            }
            if !self.is_bent && needs.packing.is_steep(self.attributes[0].plane.steps[0]) {
                return self.set_held(vertices, needs, &gradients, [q, q_b, q_c]);
            }
        }
        self.set_colors(vertices, needs, &gradients, bend)
    }

    /// Sets u and v as plain. False, and their planes of no use, if one varies too much.
    #[inline(never)]
    fn set_uv(&mut self, vertices: &[&ScreenVertex; 3], needs: &Needs, gradients: &Gradients) -> bool {
        for i in 0..2 {
            let [a, b, c] = vertices.map(|vertex| needs.scaled_uv(vertex, i) & !0xff);
            let rises = [b, c].map(|other| other.wrapping_sub(a) >> 8);
            let attribute = &mut self.attributes[i];
            let [least, range] =
                gradients.set_within(&mut attribute.plane, a >> 8, &rises, needs.margins[i].into());
            if range >= 1 << 19 {
                return false;
            }
            // For what asks where a texture is seen.
            attribute.scale_log2 = 0;
            attribute.least = a.wrapping_add(least << 8);
            attribute.range = ((range << 8) as u32).saturating_sub(1);
        }
        true
    }

    /// Sets colours, if they are read, as plain. False, and their planes of no use, if one would be off by more than a step.
    #[inline(never)]
    fn set_colors(
        &mut self,
        vertices: &[&ScreenVertex; 3],
        needs: &Needs,
        gradients: &Gradients,
        bend: ColorBend,
    ) -> bool {
        if !needs.reads_color() {
            return true;
        }
        self.set_gray(vertices, needs);
        let (first, count) = (if needs.reads_uv() { 2 } else { 0 }, if self.gray { 1 } else { 3 });
        for (i, attribute) in self.attributes.iter_mut().skip(first).take(count).enumerate() {
            let [a, b, c] = vertices.map(|vertex| i32::from(vertex.color[i].to_bits()));
            let [_, range] = gradients.set_within(&mut attribute.plane, a, &[b - a, c - a], 1);
            if bend.is_too_large(range) {
                return false;
            }
        }
        true
    }
}

/// Whether texture coordinates vary by so little that scaled by 2^`scale` they stay below 2²⁷.
#[cold]
#[inline(never)]
fn are_narrow(vertices: &[&ScreenVertex; 3], scale: u32) -> bool {
    let [a, b, c] = vertices.map(|vertex| [vertex.u.to_bits(), vertex.v.to_bits()]);
    [[a, b], [a, c], [b, c]].iter().all(|[a, b]| (0..2).all(|i| (a[i].abs_diff(b[i]) >> (27 - scale)) == 0))
}

/// Which ranges of colours are too large for straight lines: those with range · `fall` > `most`.
#[derive(Clone, Copy)]
struct ColorBend {
    fall: u32,
    most: u32,
}

impl ColorBend {
    /// None.
    const NONE: Self = Self { fall: 0, most: 0 };

    /// Whether it is not none.
    fn is_needed(self) -> bool {
        self.fall != 0
    }

    /// Linear interpolation is off by ¼ · range · fall / least at most (see [`straight`](super::straight)). That has to be
    /// at most one `step`, in whole levels of 1/255, 1 … 8. `fall` is that of q, below 2²⁷, and ranges are below 2¹⁶ units of
    /// 1/256 level.
    fn new(fall: u32, least: u32, step: u32) -> Self {
        Self { fall: (fall >> 16) + 1, most: (step << 10) * (least >> 16) }
    }

    #[inline]
    fn is_too_large(self, range: i32) -> bool {
        range as u32 * self.fall > self.most
    }
}
