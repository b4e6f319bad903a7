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

use super::transform::{ClipVertex, focal_log2};
use crate::math::recip::Reciprocal;
use crate::num::{I12F4, I16F16, U1F31, U8F8, shift_round, wide};
use crate::scene::Projection;
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

/// One vertex more for each of the five planes.
pub(super) type Polygon = Vec<ClipVertex, 8>;

/// Clips and projects.
pub(super) struct Clip {
    /// The near plane in clip units, rounded up; at least 1.
    near: i32,
    /// near as a mantissa of 31 bits …
    near_mantissa: i32,
    /// … and the shift that makes near/w of it: q = `near_mantissa` / w · 2^−(`near_shift` − 62).
    near_shift: i32,
    /// Screen = centre + x/w · 2^`scale` in 1/16 px.
    scale: i32,
    /// The vanishing point, in 1/16 px.
    center: [i32; 2],
}

/// The two ends of the screen, across and down.
const SIDES: [(usize, i64); 4] = [(0, *CUT.start()), (0, *CUT.end()), (1, *CUT.start()), (1, *CUT.end())];

impl Clip {
    pub(super) fn new(projection: &Projection, unit_bits: i32) -> Self {
        let near = i64::from(projection.near.to_bits());
        let near_units = if unit_bits >= 16 {
            near << (unit_bits - 16)
        } else {
            // Up: nothing that is drawn has a q above 1.
            (near + (1 << (16 - unit_bits)) - 1) >> (16 - unit_bits)
        };
        let zeros = projection.near.to_bits().leading_zeros() as i32 - 1;
        Self {
            // A near plane beyond all clip coordinates clips everything.
            near: near_units.min(i64::from(i32::MAX)) as i32,
            near_mantissa: projection.near.to_bits() << zeros,
            near_shift: 47 + zeros - unit_bits,
            scale: focal_log2(projection.focal) + 4,
            center: [i32::from(projection.width) * 8, i32::from(projection.height) * 8],
        }
    }

    /// Hands on what is left of a triangle: nothing, itself, or up to six pieces.
    #[inline]
    pub(super) fn clip(&self, polygon: &mut Polygon, mut draw: impl FnMut(&[ScreenVertex; 3])) {
        let mut triangle = [ScreenVertex::default(); 3];
        let inside =
            triangle.iter_mut().zip(&*polygon).all(|(vertex, corner)| self.project(corner, &CUT, vertex));
        if !inside {
            self.cut(polygon);
        }
        // A triangle, or a fan around the first vertex.
        let mut count = 0;
        for corner in &*polygon {
            if (inside && count < 3) || self.project(corner, &GUARD_BAND, &mut triangle[count.min(2)]) {
                count += 1;
                if count >= 3 {
                    draw(&triangle);
                    triangle[1] = triangle[2];
                }
            }
        }
    }

    #[cold]
    #[inline(never)]
    fn cut(&self, polygon: &mut Polygon) {
        cut_by(polygon, |vertex| vertex.w >= self.near, |vertex| i64::from(vertex.w) - i64::from(self.near));
        for (axis, side) in SIDES {
            cut_by(
                polygon,
                |vertex| {
                    let at = self.screen(vertex, axis, Reciprocal::precise(vertex.w as u32));
                    if side < 0 { at >= side } else { at <= side }
                },
                |vertex| {
                    let offset = wide(vertex.w, side as i32 - self.center[axis]);
                    let x = i64::from(if axis == 0 { vertex.x } else { vertex.y }) << self.scale;
                    if side < 0 { x - offset } else { offset - x }
                },
            );
        }
    }

    /// Screen position along an axis, in 1/16 px from the edge of the screen, rounded to nearest.
    fn screen(&self, vertex: &ClipVertex, axis: usize, w: Reciprocal) -> i64 {
        let x = if axis == 0 { vertex.x } else { vertex.y };
        let shift = 62 - w.zeros as i32 - self.scale;
        shift_round(wide(x, w.mantissa), shift as u32) + i64::from(self.center[axis])
    }

    /// Puts the vertex on the screen; false, and nothing done, if it lies before the near plane or its
    /// position (1/16 px) outside `range`.
    #[inline(never)]
    fn project(&self, vertex: &ClipVertex, range: &RangeInclusive<i64>, to: &mut ScreenVertex) -> bool {
        if vertex.w < self.near {
            return false;
        }
        let w = Reciprocal::precise(vertex.w as u32);
        let (x, y) = (self.screen(vertex, 0, w), self.screen(vertex, 1, w));
        if !range.contains(&x) || !range.contains(&y) {
            return false;
        }
        let shift = (self.near_shift - w.zeros as i32).clamp(0, 63);
        let q = shift_round(wide(self.near_mantissa, w.mantissa), shift as u32);
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
