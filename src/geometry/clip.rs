//! Clip: from clip space to the screen.
//!
//! - In: a vertex of a mesh, or of a polygon that was cut.
//! - Out: a screen vertex; or no, if a plane cuts it off or it is so near that cutting has to place it.
//! - Assumes: clip coordinates as [`transform`](super::transform) makes them.
//!
//! A triangle whose vertices all lie before the near plane and inside the guard band goes straight
//! to the division by w. Any other is cut first, in clip space where all attributes are linear:
//!
//! ```text
//!          guard band ±1022¾ px              near plane: w = near
//!   ┌────────────────────────────────┐
//!   │        ┌─────────┐             │       The new vertex on an edge is computed from the end
//!   │        │ screen  │     ●───────┼──○    inside towards the end outside, in both triangles
//!   │        └─────────┘             │       of the edge: the same numbers, the same vertex.
//!   └────────────────────────────────┘
//! ```

use super::screen::{GUARD, ScreenVertex};
use super::transform::{FINE, ToClip, focal_log2, least_w};
use crate::math::recip::{Reciprocal, looked_up};
use crate::num::{I12F4, I16F16, U1F31, mul_high_short, normalised, wide, zeros_of};
use crate::scene::{Bounds, Projection, Vertex, Viewport};
use core::hint::black_box;
use core::ops::RangeInclusive;

/// Where clipping cuts, ±1022¾ px: beyond the centres of the first and the last column and row that may be drawn, −1022½ and
/// 1022½, so that nothing is missing there, and ¾ px inside the guard band, so that rounding stays in it. A corner on this line is off
/// by less than ¼ px, rounding included: [`cut`](super::cut) has the sum.
const CUT: RangeInclusive<i32> = -CUT_AT..=CUT_AT;
pub(super) const CUT_AT: i32 = 1022 * 16 + 12;

const _: () = assert!(2 * (2 * GUARD as i64).pow(2) < 1 << 31);
const _: () = assert!(CUT_AT > 1022 * 16 + 8 && CUT_AT < GUARD);

/// Clips and projects.
pub(crate) struct Clip {
    /// The far plane in clip units, rounded down.
    pub(super) far: i32,
    /// From which w on vertices are placed by 32 bits: beyond the near plane.
    pub(super) least: i32,
    /// Whether that is further than the near plane, so that clipping has to take all bits that it has.
    pub(super) is_fine: bool,
    /// If the mesh is whole, how it is placed. Else, and until that is known, `None`.
    pub(super) whole: Option<Shifts>,
    /// Both planes as the camera has them, for clipping.
    pub(super) planes: [I16F16; 2],
    /// Perspective: near as a mantissa of 31 bits; orthographic: 1/(far − near) as such.
    pub(super) depth_mantissa: i32,
    /// Perspective: the leading zeros of near in clip units; orthographic: those of far − near, less one.
    depth_zeros: i8,
    /// Screen = centre + x/w · 2^`scale` in 1/16 px.
    scale: i8,
    /// The vanishing point, in 1/16 px with [`FINER`] bits more, plus a half, so that what is added to it is rounded to
    /// nearest.
    pub(super) center: [i32; 2],
    /// The fraction bits of clip coordinates if w does not divide, else 0.
    flat: i8,
    /// The fraction bits of clip coordinates.
    unit_bits: i8,
}

/// How far products with 1/w are shifted where a mesh is whole, for a w without leading zeros.
#[derive(Clone, Copy)]
pub(super) struct Shifts {
    /// For q, less one bit.
    pub(super) depth: u8,
    /// For x and y.
    pub(super) position: u8,
}

/// How many bits screen positions have behind the 1/16 px before they are rounded.
pub(super) const FINER: u32 = 13;

/// 1/w.
#[derive(Clone, Copy)]
pub(super) struct Inverse {
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
    /// Of no projection.
    pub(super) const ZERO: Self = Self {
        far: 0,
        least: 0,
        is_fine: false,
        whole: None,
        planes: [I16F16::ZERO; 2],
        depth_mantissa: 0,
        depth_zeros: 0,
        scale: 0,
        center: [0; 2],
        flat: 0,
        unit_bits: 0,
    };

    pub(crate) fn new(projection: &Projection, unit_bits: i32) -> Self {
        let mut clip = Self::ZERO;
        clip.set(projection, unit_bits);
        clip
    }

    /// Sets one that is [`ZERO`](Self::ZERO), in place, so that nothing is copied.
    #[inline(never)]
    pub(super) fn set(&mut self, projection: &Projection, unit_bits: i32) {
        let near = in_units(projection.near, unit_bits, true);
        let far =
            if projection.far == I16F16::MAX { i32::MAX } else { in_units(projection.far, unit_bits, false) };
        let (depth_mantissa, depth_zeros) = if projection.orthographic {
            let range = Reciprocal::precise(far.saturating_sub(near).max(1) as u32);
            (range.mantissa, range.zeros as i32 - 1)
        } else {
            let zeros = zeros_of(projection.near.to_bits() as u32) as i32;
            (projection.near.to_bits() << (zeros - 1), zeros + 16 - unit_bits)
        };
        let least = least_w(projection, unit_bits);
        self.far = far;
        self.least = near.max(least);
        self.is_fine = near < least;
        self.planes = [projection.near, projection.far];
        self.depth_mantissa = depth_mantissa;
        self.depth_zeros = depth_zeros as i8;
        self.scale = (focal_log2(projection.focal) + 4) as i8;
        self.center = projection.center.map(|at| (at << FINER) + (1 << (FINER - 1)));
        self.unit_bits = unit_bits as i8;
        self.flat = if projection.orthographic { self.unit_bits } else { 0 };
    }

    /// A plane's w in clip units, with [`FINE`] bits more: exact, as clip units are 2⁻¹⁰ or less, and at most 2⁴⁶, which is beyond
    /// all that there is. A plane at the format's end is none: a mesh that stands there reaches further.
    #[inline(never)]
    pub(super) fn distance_of(&self, plane: I16F16) -> i64 {
        if plane == I16F16::MAX {
            return 1 << 46;
        }
        (i64::from(plane.to_bits()) << (i32::from(self.unit_bits) + FINE - 16)).min(1 << 46)
    }

    /// Screen = centre + x/w · 2^this in 1/16 px.
    #[inline(always)]
    pub(super) fn scale(&self) -> i32 {
        self.scale.into()
    }

    /// The fraction bits of clip coordinates if w does not divide, else 0.
    #[inline(always)]
    pub(super) fn flat(&self) -> i32 {
        self.flat.into()
    }

    /// Perspective: the leading zeros of near in clip units; orthographic: those of far − near, less one.
    #[inline(always)]
    pub(super) fn depth_zeros(&self) -> i32 {
        self.depth_zeros.into()
    }

    /// What x and y are divided by, in clip units.
    #[inline]
    pub(super) fn divisor(&self, w: i32) -> i32 {
        if self.flat() != 0 { 1 << self.flat() } else { w }
    }

    /// The middle of a mesh's bounds in clip space, if anything within these may be seen through the viewport, between the planes.
    #[inline(never)]
    pub(super) fn sees(
        &self,
        to_clip: &ToClip,
        bounds: &Bounds,
        projection: &Projection,
    ) -> Option<[i32; 3]> {
        let center @ [.., w] = to_clip.place_all(bounds.center);
        let radius = bounds.radius.unsigned_abs();
        let [near, far] = [projection.near, projection.far].map(|at| self.distance_of(at) >> FINE);
        let [before, beyond] = [near - i64::from(w), i64::from(w) - far];
        // Between planes that coincide, or are the wrong way round, there is nothing; rounded, it might have an area.
        if projection.near >= projection.far
            || !to_clip.reaches(before, radius, (2, 0, 0))
            || !to_clip.reaches(beyond, radius, (2, 0, 0))
        {
            return None;
        }
        // Hidden, so that the loop is not unrolled.
        let is_seen =
            (0..black_box(4)).all(|side| self.reaches(to_clip, &center, radius, (projection, side)));
        is_seen.then_some(center)
    }

    /// Whether bounds reach over a side of the viewport: a plane through the eye (or along the line of sight) that lies at
    /// a slope of side : focal length, in 1/16 px. Sides are left, right, top and bottom.
    #[cfg_attr(all(target_arch = "arm", not(target_has_atomic = "32")), inline(never))]
    #[cfg_attr(not(all(target_arch = "arm", not(target_has_atomic = "32"))), inline)]
    fn reaches(
        &self,
        to_clip: &ToClip,
        &[x, y, w]: &[i32; 3],
        radius: u32,
        (projection, side): (&Projection, usize),
    ) -> bool {
        let Viewport { left, top, width, height } = projection.viewport;
        let (axis, is_end) = (side >> 1, side & 1 != 0);
        let (start, length, across) = if axis == 0 { (left, width, x) } else { (top, height, y) };
        let [middle_x, middle_y] = projection.center;
        let side = i32::from(start) + if is_end { i32::from(length) } else { 0 };
        let slope = side * 16 - if axis == 0 { middle_x } else { middle_y };
        let outside = (i64::from(across) << self.scale()) - wide(self.divisor(w), slope);
        let outside = if is_end { outside } else { -outside };
        to_clip.reaches(outside, radius, (axis, self.scale(), if self.flat() != 0 { 0 } else { slope }))
    }

    /// Puts a vertex that clipping has nothing to do with on the screen, its position and q alone; false, and `to` of no use, for
    /// another: one that is cut off, or so near that clipping places it. In one function, so that clip coordinates stay in registers:
    /// 390 cycles on a Cortex-M0+, 180 on an M4.
    #[inline(never)]
    pub(crate) fn place_bare(&self, to_clip: &ToClip, vertex: &Vertex, to: &mut ScreenVertex) -> bool {
        self.locate(to_clip, vertex, (&mut to.x, &mut to.y, &mut to.q))
    }

    /// As [`Clip::place_bare`].
    #[inline(always)]
    pub(crate) fn locate(
        &self,
        to_clip: &ToClip,
        vertex: &Vertex,
        place: (&mut I12F4, &mut I12F4, &mut U1F31),
    ) -> bool {
        let position = vertex.position.map(|at| i32::from(at.to_bits()));
        let w = to_clip.place(position, 2);
        let within = |at: i32| CUT.contains(&at).then_some(at);
        w >= self.least
            && w <= self.far
            && self.project(
                |axis| to_clip.place(position, axis),
                w,
                self.scale(),
                &self.center,
                within,
                place,
            )
    }

    /// Where a point of clip space between the planes is on the screen, and its q; false if `within` has no place for its position
    /// (1/16 px) along an axis. Each coordinate is computed where it is used, and each result stored at once: there are few registers.
    #[inline(always)]
    fn project(
        &self,
        at: impl Fn(usize) -> i32,
        w: i32,
        scale: i32,
        center: &[i32; 2],
        within: impl Fn(i32) -> Option<i32>,
        (to_x, to_y, to_q): (&mut I12F4, &mut I12F4, &mut U1F31),
    ) -> bool {
        let inverse = self.set_q(w, 0, to_q);
        let Some(x) = within(screen(at(0), scale, center[0], inverse)) else {
            return false;
        };
        *to_x = I12F4::from_bits(x as i16);
        let Some(y) = within(screen(at(1), scale, center[1], inverse)) else {
            return false;
        };
        *to_y = I12F4::from_bits(y as i16);
        true
    }

    /// Sets q of a point whose w has `finer` bits more than clip coordinates, and returns what x and y are multiplied by. Out of line on
    /// Armv6-M, for 8 cycles a vertex: it is there once, and not where clipping places corners as well.
    #[cfg_attr(all(target_arch = "arm", not(target_has_atomic = "32")), inline(never))]
    #[cfg_attr(not(all(target_arch = "arm", not(target_has_atomic = "32"))), inline(always))]
    pub(super) fn set_q(&self, w: i32, finer: i32, to_q: &mut U1F31) -> Inverse {
        let inverse;
        let q = if self.flat() != 0 {
            inverse = Inverse { mantissa: 1 << 31, zeros: 31 - self.flat() - finer };
            // Both of 31 bits.
            let depth = (self.far - w) << self.depth_zeros();
            (((wide(depth, self.depth_mantissa) + (1 << 29)) >> 30) as u32).clamp(1, i32::MAX as u32)
        } else {
            inverse = Inverse::of(w);
            // 2³⁰ … 2³², of which the upper bits are q: all but as many as w has more than near.
            let quotient = (mul_high_short(self.depth_mantissa, inverse.mantissa) as u32) << 2;
            match (self.depth_zeros() - finer - inverse.zeros) as u32 {
                0 => quotient.min(i32::MAX as u32),
                shift => ((quotient >> (shift - 1).min(30)) + 1) >> 1,
            }
        };
        *to_q = U1F31::from_bits(q);
        inverse
    }
}

/// A plane's distance in clip units: up for the near plane, so that nothing that is drawn has a q above 1.
#[inline(never)]
fn in_units(distance: I16F16, unit_bits: i32, round_up: bool) -> i32 {
    let distance = i64::from(distance.to_bits());
    let units = if unit_bits >= 16 {
        distance << (unit_bits - 16)
    } else {
        (distance + if round_up { (1 << (16 - unit_bits)) - 1 } else { 0 }) >> (16 - unit_bits)
    };
    // A plane beyond all clip coordinates.
    units.min(i64::from(i32::MAX)) as i32
}

/// Where x or y of a corner that was cut lies on the screen, within the guard band.
#[cfg_attr(all(target_arch = "arm", not(target_has_atomic = "32")), inline(never))]
#[cfg_attr(not(all(target_arch = "arm", not(target_has_atomic = "32"))), inline(always))]
pub(super) fn on_border(at: i32, scale: i32, w: Inverse) -> I12F4 {
    I12F4::from_bits(screen(at, scale, 1 << (FINER - 1), w).clamp(-GUARD, GUARD) as i16)
}

/// Screen position along an axis, in 1/16 px from the edge of the screen, rounded to nearest, or far beyond it.
#[inline(always)]
fn screen(x: i32, scale: i32, center: i32, w: Inverse) -> i32 {
    // As far as w was shifted, so that the product has FINER bits more: what overflows is beyond ±2¹⁶/16 px.
    let shift = w.zeros + scale - 17;
    let x = if shift >= 0 {
        let shifted = x << shift;
        if shifted >> shift != x {
            return if x < 0 { i32::MIN } else { i32::MAX };
        }
        shifted
    } else {
        x >> -shift
    };
    // Within ±2³⁰ each: the screen's middle is within ±2¹⁵/16 px.
    (mul_high_short(x, w.mantissa) + center) >> FINER
}
