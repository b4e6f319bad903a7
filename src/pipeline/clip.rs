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

mod cut;

pub(super) use cut::MOST_CORNERS;

use super::color::Coloring;
use super::transform::{ToClip, focal_log2};
use crate::math::recip::{Reciprocal, looked_up};
use crate::num::{I12F4, I16F16, U1F31, U8F8, mul_high_short, mul_round, normalised, wide};
use crate::scene::{Bounds, Projection, Vertex};
use core::ops::RangeInclusive;

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
const GUARD_BAND: RangeInclusive<i32> = -1024 * 16..=1023 * 16;

/// Where clipping cuts: a pixel inside the guard band, so that rounding stays in it.
const CUT: RangeInclusive<i32> = -1023 * 16..=1022 * 16;

const MAX_TEXELS: i32 = 8192 << 16;

impl ScreenVertex {
    /// The default.
    pub(super) const ZERO: Self = Self {
        x: I12F4::ZERO,
        y: I12F4::ZERO,
        q: U1F31::ZERO,
        u: I16F16::ZERO,
        v: I16F16::ZERO,
        color: [U8F8::ZERO; 3],
    };

    pub(crate) fn in_range(&self) -> bool {
        [self.x, self.y].iter().all(|at| GUARD_BAND.contains(&i32::from(at.to_bits())))
            && [self.u, self.v].iter().all(|t| (-MAX_TEXELS..=MAX_TEXELS).contains(&t.to_bits()))
    }

    /// What is beyond position and q, from a mesh.
    #[inline]
    pub(super) fn set_attributes(&mut self, vertex: &Vertex, coloring: &Coloring) {
        [self.u, self.v] = vertex.uv.map(I16F16::from);
        coloring.of_vertex(vertex, &mut self.color);
    }
}

/// Clips and projects.
pub(super) struct Clip {
    /// The near plane in clip units, rounded up; at least 1.
    near: i32,
    /// The far plane in clip units, rounded down.
    far: i32,
    /// Perspective: near as a mantissa of 31 bits; orthographic: 1/(far − near) as such.
    depth_mantissa: i32,
    /// Perspective: the leading zeros of near in clip units; orthographic: those of far − near, less one.
    depth_zeros: i32,
    /// Screen = centre + x/w · 2^`scale` in 1/16 px.
    scale: i32,
    /// The vanishing point, in 1/16 px with [`FINER`] bits more, plus a half, so that what is added to it is rounded to
    /// nearest.
    center: [i32; 2],
    /// The fraction bits of clip coordinates if w does not divide, else 0.
    flat: i32,
}

/// How many bits screen positions have behind the 1/16 px before they are rounded.
const FINER: u32 = 13;

/// 1/w.
#[derive(Clone, Copy)]
struct Inverse {
    /// 1/w = mantissa · 2^(`zeros` − 62), 2³⁰ … 2³¹.
    mantissa: u32,
    zeros: i32,
}

impl Inverse {
    /// Of 1 or more.
    #[inline(always)]
    fn of(w: i32) -> Self {
        let (w, zeros) = normalised(w as u32);
        Self { mantissa: looked_up(w), zeros: zeros as i32 }
    }
}

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
        let (depth_mantissa, depth_zeros) = if projection.orthographic {
            let range = Reciprocal::precise(far.saturating_sub(near).max(1) as u32);
            (range.mantissa, range.zeros as i32 - 1)
        } else {
            let zeros = projection.near.to_bits().leading_zeros() as i32;
            (projection.near.to_bits() << (zeros - 1), zeros + 16 - unit_bits)
        };
        Self {
            near,
            far,
            depth_mantissa,
            depth_zeros,
            scale: focal_log2(projection.focal) + 4,
            center: projection.center.map(|at| (at << FINER) + (1 << (FINER - 1))),
            flat: if projection.orthographic { unit_bits } else { 0 },
        }
    }

    /// What x and y are divided by, in clip units.
    #[inline]
    fn divisor(&self, w: i32) -> i32 {
        if self.flat != 0 { 1 << self.flat } else { w }
    }

    /// Whether anything within a mesh's bounds may be seen through the viewport, between the planes.
    #[inline(never)]
    pub(super) fn sees(&self, to_clip: &ToClip, bounds: &Bounds, projection: &Projection) -> bool {
        let center @ [.., w] = to_clip.place_all(bounds.center);
        let (viewport, radius) = (&projection.viewport, bounds.radius.unsigned_abs());
        let [before, beyond] = [i64::from(self.near) - i64::from(w), i64::from(w) - i64::from(self.far)];
        // Between planes that coincide, or are the wrong way round, there is nothing; rounded, it might have an area.
        if self.near >= self.far
            || !to_clip.reaches(before, radius, (2, 0, 0))
            || !to_clip.reaches(beyond, radius, (2, 0, 0))
        {
            return false;
        }
        let sides = [
            (0, -1, i32::from(viewport.left)),
            (0, 1, i32::from(viewport.left) + i32::from(viewport.width)),
            (1, -1, i32::from(viewport.top)),
            (1, 1, i32::from(viewport.top) + i32::from(viewport.height)),
        ];
        sides.into_iter().all(|(axis, sign, side)| {
            let slope = side * 16 - projection.center[axis];
            self.reaches(to_clip, [center[axis], w], radius, (axis, sign, slope))
        })
    }

    /// Whether bounds reach over a side of the viewport: a plane through the eye (or along the line of sight) that lies at
    /// a slope of side : focal length, in 1/16 px.
    #[inline(never)]
    fn reaches(
        &self,
        to_clip: &ToClip,
        [across, w]: [i32; 2],
        radius: u32,
        (axis, sign, slope): (usize, i64, i32),
    ) -> bool {
        let outside = ((i64::from(across) << self.scale) - wide(self.divisor(w), slope)) * sign;
        to_clip.reaches(outside, radius, (axis, self.scale, if self.flat != 0 { 0 } else { slope }))
    }

    /// Puts a vertex that clipping has nothing to do with on the screen; false, and `to` of no use, for another.
    pub(super) fn place(
        &self,
        to_clip: &ToClip,
        coloring: &Coloring<'_>,
        vertex: &Vertex,
        to: &mut ScreenVertex,
    ) -> bool {
        let is_inside = self.place_bare(to_clip, vertex, to);
        if is_inside {
            to.set_attributes(vertex, coloring);
        }
        is_inside
    }

    /// As [`Clip::place`], the position and q alone, in one function, so that clip coordinates stay in registers: 370 cycles on
    /// a Cortex-M0+, 180 on an M4.
    #[inline(never)]
    pub(super) fn place_bare(&self, to_clip: &ToClip, vertex: &Vertex, to: &mut ScreenVertex) -> bool {
        self.locate(to_clip, vertex, (&mut to.x, &mut to.y, &mut to.q))
    }

    /// As [`Clip::place_bare`].
    #[inline(always)]
    pub(super) fn locate(
        &self,
        to_clip: &ToClip,
        vertex: &Vertex,
        place: (&mut I12F4, &mut I12F4, &mut U1F31),
    ) -> bool {
        let position = vertex.position.map(|at| i32::from(at.to_bits()));
        self.project(|axis| to_clip.place(position, axis), &CUT, place)
    }

    /// 1/w, or what is in its place without perspective.
    #[inline(always)]
    fn inverse(&self, w: i32) -> Inverse {
        if self.flat != 0 { Inverse { mantissa: 1 << 31, zeros: 31 - self.flat } } else { Inverse::of(w) }
    }

    /// Screen position along an axis, in 1/16 px from the edge of the screen, rounded to nearest, or far beyond it.
    #[inline(always)]
    fn screen(&self, x: i32, axis: usize, w: Inverse) -> i32 {
        // As far as w was shifted, so that the product has FINER bits more: what overflows is beyond ±2¹⁶/16 px.
        let shift = w.zeros + self.scale - 17;
        let x = if shift >= 0 {
            let shifted = x << shift;
            if shifted >> shift != x {
                return if x < 0 { i32::MIN } else { i32::MAX };
            }
            shifted
        } else {
            x >> -shift
        };
        (mul_high_short(x, w.mantissa) + self.center[axis]) >> FINER
    }

    /// Where a point of clip space is on the screen, and its q; false if it is not between the planes or its position
    /// (1/16 px) not in `range`. Each coordinate is computed where it is used, and each result stored at once: there are
    /// few registers.
    #[inline(always)]
    fn project(
        &self,
        at: impl Fn(usize) -> i32,
        range: &RangeInclusive<i32>,
        (to_x, to_y, to_q): (&mut I12F4, &mut I12F4, &mut U1F31),
    ) -> bool {
        let w = at(2);
        if w < self.near || w > self.far {
            return false;
        }
        let inverse = self.inverse(w);
        let q = if self.flat != 0 {
            // Both of 31 bits.
            let depth = (self.far - w) << self.depth_zeros;
            (mul_round::<30>(depth, self.depth_mantissa) as u32).clamp(1, i32::MAX as u32)
        } else {
            // 2³⁰ … 2³², of which the upper bits are q: all but as many as w has more than near.
            let quotient = (mul_high_short(self.depth_mantissa, inverse.mantissa) as u32) << 2;
            match (self.depth_zeros - inverse.zeros) as u32 {
                0 => quotient.min(i32::MAX as u32),
                shift => ((quotient >> (shift - 1).min(30)) + 1) >> 1,
            }
        };
        *to_q = U1F31::from_bits(q);
        let x = self.screen(at(0), 0, inverse);
        if !range.contains(&x) {
            return false;
        }
        *to_x = I12F4::from_bits(x as i16);
        let y = self.screen(at(1), 1, inverse);
        *to_y = I12F4::from_bits(y as i16);
        range.contains(&y)
    }
}
