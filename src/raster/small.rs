//! Set-up of a small triangle, as most triangles of a mesh are: what [`setup`](super::setup) does, in 32-bit products.
//!
//! - In: a triangle at most 32 pixels wide and less high, clockwise from its uppermost corner on, and what the shader wants of it.
//! - Out: the planes of its depth and attributes; or `false` if it has to be set up by the general way.
//! - Assumes: the corners lie in the guard band.
//!
//! The general way takes a triangle nevertheless if it is too thin, if q varies too much, if its attributes have to be divided by q at
//! its pixels, or if a colour would be off by more than what shows ([`Needs::color_step`]).
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
//! Before that each coordinate is asked whether it needs it: see [`course`](super::course). Some are straight enough if they are lifted.
//!
//! Colours are linear all the same: they may be off by a step of the target's finest channel.

use super::gradients::Gradients;
use super::needs::{ColorBend, Needs, SmallTriangle};
use super::packing::LARGE;
use super::straight::Straight;
use super::triangle::{Planes, STRAIGHT, TriangleSetup, are_gray};
use crate::geometry::{ScreenVertex, position};

impl TriangleSetup {
    /// Sets the plane of depth, and those of attributes, of a triangle: [`InputCode::small`](super::needs::InputCode). As the next one
    /// without type parameters, so that it is compiled with this crate, at its level of optimisation and not at that of the program.
    #[inline(never)]
    pub(super) fn set_small(&mut self, vertices: &[&ScreenVertex; 3], area: u32, needs: &Needs) -> bool {
        self.set_small_if::<true>(vertices, area, needs)
    }

    /// Sets the plane of depth alone.
    #[inline(never)]
    pub(super) fn set_small_depth(
        &mut self,
        vertices: &[&ScreenVertex; 3],
        area: u32,
        needs: &Needs,
    ) -> bool {
        self.set_small_if::<false>(vertices, area, needs)
    }

    #[inline(always)]
    fn set_small_if<const READS: bool>(
        &mut self,
        vertices: &[&ScreenVertex; 3],
        area: u32,
        needs: &Needs,
    ) -> bool {
        let [top @ [x, y], next, last] = vertices.map(position);
        let ([bx, by], [cx, cy]) = ([next[0] - x, next[1] - y], [last[0] - x, last[1] - y]);
        self.planes = Planes::Small;
        (self.is_held, self.is_bent) = (false, false);
        let (width, height) = ((bx.max(cx).max(0) - bx.min(cx).min(0)) as u32, by.max(cy) as u32);
        // Thick enough: where it is longest, a row or a column is `area` by its height or width long, at least 2 sixteenths. A rise of 2²⁷
        // over that makes a step of 2³⁰, which fits.
        if width.max(height) * 2 > area {
            return false;
        }
        if !READS && !needs.depth {
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
        let size = |x: i32| x ^ (x >> 31);
        let fall = (size(rise_b) | size(rise_c) | size(rise_b.wrapping_sub(rise_c))) as u32;
        if fall >= 1 << 27 {
            return false;
        }
        // Made where it stays: nothing is copied.
        let small = &SmallTriangle {
            vertices,
            needs,
            gradients: Gradients::new(top, [[bx, by], [cx, cy]], area),
            q: [q, q_b, q_c],
        };
        small.gradients.set_plane(&mut self.z, q, &[rise_b >> 8, rise_c >> 8]);
        if !READS {
            return true;
        }
        if needs.every_pixel {
            return self.set_held(small);
        }
        let mut bend = ColorBend::NONE;
        if fall != 0
            && let Straight::Below(limit) = needs.straight
        {
            let least = q.min(q_b).min(q_c);
            // As `Bend::is_straight`, with width and height for all edges: 25 bits, and 12 times 15 and a bit.
            if (width + height) * ((fall >> 12) + 1) > ((least >> 16) * limit.get()) >> 8 {
                bend = ColorBend::new(fall, least, needs.color_step.into());
            }
        } else if needs.code.uv.is_some() {
            return self.set_held(small);
        }
        if let Some(uv) = &needs.code.uv {
            self.longest = if needs.packing.is_large() { LARGE } else { STRAIGHT };
            if !(uv.small)(self, small) {
                return false;
            }
            if bend.is_needed() && !(uv.bend)(self, small) {
                return false;
            }
            if !self.is_bent && needs.packing.is_steep(self.attributes[0].plane.steps[0]) {
                return self.set_held(small);
            }
        }
        needs.code.small_color.is_none_or(|set_colors| set_colors(self, small, bend))
    }

    /// Sets u and v as plain: [`UvCode::small`](super::needs::UvCode).
    #[inline(never)]
    pub(super) fn set_small_uv(&mut self, small: &SmallTriangle<'_>) -> bool {
        let &SmallTriangle { vertices, needs, ref gradients, .. } = small;
        if needs.scale != 0 && !needs.are_narrow(vertices) {
            return false;
        }
        for i in 0..2 {
            let [a, b, c] = vertices.map(|vertex| needs.scaled_uv(vertex, i) & !0xff);
            let rises = [b, c].map(|other| other.wrapping_sub(a) >> 8);
            let attribute = &mut self.attributes[i];
            let (least, range) =
                gradients.set_within(&mut attribute.plane, a >> 8, &rises, needs.margins[i].into());
            if range >= 1 << 19 {
                return false;
            }
            // For what asks where a texture is seen.
            attribute.set_scale_log2(0);
            attribute.least = a.wrapping_add(least << 8);
            attribute.range = ((range << 8) as u32).saturating_sub(1);
        }
        true
    }

    /// Sets colours as plain: [`InputCode::small_color`](super::needs::InputCode).
    #[inline(never)]
    pub(super) fn set_small_colors(&mut self, small: &SmallTriangle<'_>, bend: ColorBend) -> bool {
        let &SmallTriangle { vertices, needs, ref gradients, .. } = small;
        // As `Needs::set_gray`, but what reads colours is here already: through its pointer s3_tex takes 1470 cycles more.
        self.gray = needs.gray || are_gray(vertices);
        let is_gray = self.gray;
        let colors = if needs.reads_uv() { &mut self.attributes[2..] } else { &mut self.attributes[..] };
        for (i, attribute) in (0..3).zip(colors) {
            let [a, b, c] = vertices.map(|vertex| i32::from(vertex.color[i].to_bits()));
            let (_, range) = gradients.set_within(&mut attribute.plane, a, &[b - a, c - a], 1);
            if bend.is_too_large(range) {
                return false;
            }
            if is_gray {
                break;
            }
        }
        true
    }
}
