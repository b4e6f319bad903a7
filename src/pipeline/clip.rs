//! Stage 2: clip space to the screen.
//!
//! A triangle whose vertices all lie before the near plane and inside the guard band goes straight
//! to the division by w. Any other is cut first, in clip space where all attributes are linear:
//!
//! ```text
//!        guard band −1023 … 1022 px          near plane: w = near
//!   ┌────────────────────────────────┐
//!   │        ┌─────────┐             │       The new vertex on an edge is computed from the end
//!   │        │ screen  │     ●───────┼──○    inside towards the end outside, in both triangles
//!   │        └─────────┘             │       of the edge: the same numbers, the same vertex.
//!   └────────────────────────────────┘
//! ```

use super::color::Coloring;
use super::transform::{ClipVertex, ToClip, focal_log2};
use crate::math::recip::Reciprocal;
use crate::num::{I12F4, I16F16, U1F31, U8F8, mul_shift_round, wide};
use crate::scene::{Bounds, Projection, Vertex};
use core::ops::RangeInclusive;
use heapless::Vec;

/// A vertex on the screen, with all that is linear before or after the division by w.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ScreenVertex {
    /// Pixels from the left edge, −1024 … 1023; pixel centres are at +½.
    pub x: I12F4,
    /// Pixels from the top edge, down, −1024 … 1023.
    pub y: I12F4,
    /// near/w; 0 counts as 2⁻³¹, 1 and more as 1 − 2⁻³¹.
    pub q: U1F31,
    /// Texture coordinate to the right, in texels, −8192 … 8192.
    pub u: I16F16,
    /// Texture coordinate downwards, likewise.
    pub v: I16F16,
    /// Red, green and blue, 0 … 255.
    pub color: [U8F8; 3],
}

const _: () = assert!(size_of::<ScreenVertex>() == 24);

/// The guard band of [`ScreenVertex`] positions, in 1/16 px: its width and height of 2047 px are
/// the most with which every edge function fits an `i32`.
const GUARD_BAND: RangeInclusive<i64> = -1024 * 16..=1023 * 16;

/// Where clipping cuts: a pixel inside the guard band, so that rounding stays in it.
const CUT: RangeInclusive<i64> = -1023 * 16..=1022 * 16;

const MAX_TEXELS: i32 = 8192 << 16;

impl ScreenVertex {
    pub(super) fn in_range(&self) -> bool {
        [self.x, self.y].iter().all(|at| GUARD_BAND.contains(&i64::from(at.to_bits())))
            && [self.u, self.v].iter().all(|t| (-MAX_TEXELS..=MAX_TEXELS).contains(&t.to_bits()))
    }
}

/// One vertex more for each of the six planes, and one to spare.
type Polygon = Vec<ClipVertex, MOST_CORNERS>;

/// The most corners that a clipped triangle has: three, and one more for each plane.
pub(super) const MOST_CORNERS: usize = 9;

/// Clips and projects.
pub(super) struct Clip {
    /// The near plane in clip units, rounded up; at least 1.
    near: i32,
    /// The far plane in clip units, rounded down.
    far: i32,
    /// Perspective: near as a mantissa of 31 bits; orthographic: 1/(far − near) as such.
    depth_mantissa: i32,
    /// Perspective: q = mantissa/w · 2^(62 − shift); orthographic: q = (far − w) · mantissa · 2^−shift.
    depth_shift: i32,
    /// Screen = centre + x/w · 2^`scale` in 1/16 px.
    scale: i32,
    /// The vanishing point, in 1/16 px.
    center: [i32; 2],
    /// 1.0 in clip units if w does not divide, else 0.
    orthographic: i32,
}

/// The planes of the guard band, across and down.
const SIDES: [(usize, i64); 4] = [(0, *CUT.start()), (0, *CUT.end()), (1, *CUT.start()), (1, *CUT.end())];

impl Clip {
    #[inline(never)]
    pub(super) fn new(projection: &Projection, unit_bits: i32) -> Self {
        // To clip units: up for the near plane, so that nothing that is drawn has a q above 1.
        let in_units = |distance: I16F16, round_up: bool| {
            let distance = i64::from(distance.to_bits());
            let units = if unit_bits >= 16 {
                distance << (unit_bits - 16)
            } else {
                (distance + if round_up { (1 << (16 - unit_bits)) - 1 } else { 0 }) >> (16 - unit_bits)
            };
            // A plane beyond all clip coordinates.
            units.min(i64::from(i32::MAX)) as i32
        };
        let near = in_units(projection.near, true);
        let far = if projection.far == I16F16::MAX { i32::MAX } else { in_units(projection.far, false) };
        let (depth_mantissa, depth_shift) = if projection.orthographic {
            let range = Reciprocal::precise(far.saturating_sub(near).max(1) as u32);
            (range.mantissa, 31 - range.zeros as i32)
        } else {
            let zeros = projection.near.to_bits().leading_zeros() as i32 - 1;
            (projection.near.to_bits() << zeros, 47 + zeros - unit_bits)
        };
        Self {
            near,
            far,
            depth_mantissa,
            depth_shift,
            scale: focal_log2(projection.focal) + 4,
            center: projection.center,
            orthographic: if projection.orthographic { 1 << unit_bits } else { 0 },
        }
    }

    /// What x and y are divided by, in clip units.
    #[inline]
    fn divisor(&self, vertex: &ClipVertex) -> i32 {
        if self.orthographic != 0 { self.orthographic } else { vertex.w }
    }

    /// Whether anything within a mesh's bounds may be seen through the viewport, between the planes.
    #[inline(never)]
    pub(super) fn sees(&self, to_clip: &ToClip, bounds: &Bounds, projection: &Projection) -> bool {
        let (center, radius) = &to_clip.bounds(bounds);
        let (w, viewport) = (i64::from(center.w), &projection.viewport);
        if w + *radius < i64::from(self.near) || w - radius > i64::from(self.far) {
            return false;
        }
        // Each side of the viewport is a plane through the eye (or along the line of sight) that lies at a slope of
        // side : focal length; all in 1/16 px.
        let focal = i64::from(projection.focal.to_bits()) >> 12;
        let sides = [
            (0, -1, i32::from(viewport.left)),
            (0, 1, i32::from(viewport.left) + i32::from(viewport.width)),
            (1, -1, i32::from(viewport.top)),
            (1, 1, i32::from(viewport.top) + i32::from(viewport.height)),
        ];
        sides.iter().all(|&(axis, sign, side)| {
            let slope = i64::from(side) * 16 - i64::from(self.center[axis]);
            let across = i64::from(if axis == 0 { center.x } else { center.y }) << self.scale;
            let outside = (across - slope * i64::from(self.divisor(center))) * sign;
            let length = if self.orthographic != 0 {
                focal
            } else {
                ((focal * focal + slope * slope) as u64).isqrt() as i64
            };
            outside <= (radius + 1) * (length + 1)
        })
    }

    /// Cuts a triangle that is not inside all planes and puts what is left of it on the screen, as a fan
    /// around its first vertex; `None` if that does not fit the guard band (which only the coarsest of numbers do not).
    #[cold]
    #[inline(never)]
    pub(super) fn cut(
        &self,
        to_clip: &ToClip,
        coloring: &Coloring,
        corners: [&Vertex; 3],
        to: &mut [ScreenVertex; MOST_CORNERS],
    ) -> Option<usize> {
        let mut polygon = Polygon::new();
        for corner in corners {
            // There is room.
            let _ = polygon.push(to_clip.transform(corner, coloring.of_vertex(corner)));
        }
        cut_by(
            &mut polygon,
            |vertex| vertex.w >= self.near,
            |vertex| i64::from(vertex.w) - i64::from(self.near),
        );
        cut_by(
            &mut polygon,
            |vertex| vertex.w <= self.far,
            |vertex| i64::from(self.far) - i64::from(vertex.w),
        );
        for (axis, side) in SIDES {
            cut_by(
                &mut polygon,
                |vertex| {
                    let at = self.screen(vertex, axis, Reciprocal::coarse(self.divisor(vertex) as u32));
                    if side < 0 { at >= side } else { at <= side }
                },
                |vertex| {
                    let offset = wide(self.divisor(vertex), side as i32 - self.center[axis]);
                    let x = i64::from(if axis == 0 { vertex.x } else { vertex.y }) << self.scale;
                    if side < 0 { x - offset } else { offset - x }
                },
            );
        }
        let fits = polygon.iter().zip(&mut *to).all(|(vertex, to)| self.project(vertex, &GUARD_BAND, to));
        fits.then_some(polygon.len())
    }

    /// Puts a vertex that clipping has nothing to do with on the screen; false, and nothing done, for another.
    #[inline(never)]
    pub(super) fn place(
        &self,
        to_clip: &ToClip,
        coloring: &Coloring,
        vertex: &Vertex,
        to: &mut ScreenVertex,
    ) -> bool {
        self.project(&to_clip.transform(vertex, coloring.of_vertex(vertex)), &CUT, to)
    }

    /// Screen position along an axis, in 1/16 px from the edge of the screen, rounded to nearest.
    #[inline]
    fn screen(&self, vertex: &ClipVertex, axis: usize, w: Reciprocal) -> i64 {
        let x = if axis == 0 { vertex.x } else { vertex.y };
        let shift = 62 - w.zeros as i32 - self.scale;
        mul_shift_round(x, w.mantissa, shift as u32) + i64::from(self.center[axis])
    }

    /// Puts the vertex on the screen; false, and nothing done, if it is not between the planes or its
    /// position (1/16 px) not in `range`.
    #[inline(never)]
    fn project(&self, vertex: &ClipVertex, range: &RangeInclusive<i64>, to: &mut ScreenVertex) -> bool {
        if vertex.w < self.near || vertex.w > self.far {
            return false;
        }
        let w = Reciprocal::coarse(self.divisor(vertex) as u32);
        let (x, y) = (self.screen(vertex, 0, w), self.screen(vertex, 1, w));
        if !range.contains(&x) || !range.contains(&y) {
            return false;
        }
        let q = if self.orthographic != 0 {
            mul_shift_round(self.far - vertex.w, self.depth_mantissa, self.depth_shift as u32)
        } else {
            let shift = (self.depth_shift - w.zeros as i32).clamp(0, 63);
            mul_shift_round(self.depth_mantissa, w.mantissa, shift as u32)
        };
        *to = ScreenVertex {
            x: I12F4::from_bits(x as i16),
            y: I12F4::from_bits(y as i16),
            q: U1F31::from_bits(q.clamp(1, i64::from(i32::MAX)) as u32),
            u: vertex.u,
            v: vertex.v,
            color: vertex.color,
        };
        true
    }
}

/// Cuts a convex polygon by one plane (Sutherland–Hodgman, in place). `distance` is linear in
/// clip space and positive inside.
fn cut_by(
    polygon: &mut Polygon,
    inside: impl Fn(&ClipVertex) -> bool,
    distance: impl Fn(&ClipVertex) -> i64,
) {
    let count = polygon.len();
    let Some(first_out) = polygon.iter().position(|vertex| !inside(vertex)) else {
        return;
    };
    // The first vertex inside that follows one outside.
    let Some(run) = (first_out..count).chain(0..first_out).find(|&i| inside(&polygon[i])) else {
        polygon.clear();
        return;
    };
    // To the front with it. Three reversals rotate; the library's way takes more stack and flash.
    polygon[..run].reverse();
    polygon[run..].reverse();
    polygon.reverse();
    // Inside: 0 … stay; outside: stay … count.
    let stay = polygon.iter().position(|vertex| !inside(vertex)).unwrap_or(count);
    let cross =
        |from: &ClipVertex, to: &ClipVertex| between(from, to, distance(from).max(0), -distance(to).min(0));
    let leave = cross(&polygon[stay - 1], &polygon[stay]);
    let enter = cross(&polygon[0], &polygon[count - 1]);
    polygon.truncate(stay);
    // Each plane adds at most one vertex to a convex polygon: there is room.
    let _ = polygon.push(leave);
    let _ = polygon.push(enter);
}

/// The point that divides an edge as `before` to `behind`, computed from the end `inside`.
fn between(inside: &ClipVertex, outside: &ClipVertex, before: i64, behind: i64) -> ClipVertex {
    // t = before / (before + behind) in 30 bits.
    let whole = before + behind;
    let t = if whole == 0 {
        0
    } else {
        let shift = whole.leading_zeros() as i32 - 33; // whole becomes 2³⁰ … 2³¹ − 1
        let normal = |value: i64| (if shift >= 0 { value << shift } else { value >> -shift }) as i32;
        let reciprocal = Reciprocal::precise(normal(whole) as u32);
        ((wide(normal(before), reciprocal.mantissa) >> 31) as i32).min(1 << 30)
    };
    // Weights 2³⁰ − t and t: no difference is taken that could overflow.
    let mix = |a: i32, b: i32| ((wide(a, (1 << 30) - t) + wide(b, t) + (1 << 29)) >> 30) as i32;
    ClipVertex {
        x: mix(inside.x, outside.x),
        y: mix(inside.y, outside.y),
        w: mix(inside.w, outside.w),
        u: I16F16::from_bits(mix(inside.u.to_bits(), outside.u.to_bits())),
        v: I16F16::from_bits(mix(inside.v.to_bits(), outside.v.to_bits())),
        color: core::array::from_fn(|i| {
            U8F8::from_bits(mix(inside.color[i].to_bits().into(), outside.color[i].to_bits().into()) as u16)
        }),
    }
}
