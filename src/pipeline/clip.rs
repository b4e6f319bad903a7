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
use super::fan::arrange;
use super::transform::{ClipVertex, ToClip, focal_log2};
use crate::math::recip::{Reciprocal, looked_up};
use crate::num::{I12F4, I16F16, U1F31, U8F8, mul_high_short, mul_round, normalised, wide};
use crate::scene::{Bounds, Projection, Vertex};
use core::{mem, ops::RangeInclusive};

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

/// The most corners that a clipped triangle has: three, and one more for each plane.
pub(super) const MOST_CORNERS: usize = 9;

/// A polygon in clip space, in the memory of the screen vertices that become of it: they have room for all but w.
struct Polygon<'a> {
    /// Position and q hold x and y of clip space.
    vertices: &'a mut [ScreenVertex; MOST_CORNERS],
    w: [i32; MOST_CORNERS],
    count: usize,
}

impl<'a> Polygon<'a> {
    #[inline(never)]
    fn new(
        to_clip: &ToClip,
        coloring: &Coloring,
        corners: [&Vertex; 3],
        vertices: &'a mut [ScreenVertex; MOST_CORNERS],
    ) -> Self {
        let mut polygon = Self { vertices, w: [0; MOST_CORNERS], count: 0 };
        for vertex in corners {
            polygon.push(&in_clip_space(to_clip, coloring, vertex));
        }
        polygon
    }

    #[inline(always)]
    fn at(&self, i: usize) -> [i32; 3] {
        let vertex = &self.vertices[i];
        let x = i32::from(vertex.y.to_bits()) << 16 | i32::from(vertex.x.to_bits() as u16);
        [x, vertex.q.to_bits() as i32, self.w[i]]
    }

    /// Each plane adds at most one vertex to a convex polygon: there is room.
    #[inline(never)]
    fn push(&mut self, vertex: &ClipVertex) {
        let ClipVertex { at: [x, y, w], u, v, color } = *vertex;
        if let (Some(to), Some(to_w)) = (self.vertices.get_mut(self.count), self.w.get_mut(self.count)) {
            let [low, high] = [x as i16, (x >> 16) as i16].map(I12F4::from_bits);
            *to = ScreenVertex { x: low, y: high, q: U1F31::from_bits(y as u32), u, v, color };
            *to_w = w;
            self.count += 1;
        }
    }

    /// Moves the vertices before `first` to the end, by three reversals: the library's way takes more stack and flash.
    #[inline(never)]
    fn rotate(&mut self, first: usize) {
        if first > 0 {
            self.reverse(0, first);
            self.reverse(first, self.count);
            self.reverse(0, self.count);
        }
    }

    /// The library's takes 600 bytes, unrolled.
    #[inline(never)]
    fn reverse(&mut self, mut first: usize, mut end: usize) {
        while first + 1 < end {
            end -= 1;
            if let Some((before, [last, ..])) = self.vertices.split_at_mut_checked(end)
                && let Some(first) = before.get_mut(first)
            {
                mem::swap(first, last);
            }
            self.w.swap(first, end);
            first += 1;
        }
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

/// A plane that clipping cuts along.
#[derive(Clone, Copy)]
struct Plane {
    /// Of the clip coordinates.
    axis: usize,
    /// Across and down: where on the screen, in 1/16 px; along: the distance.
    limit: i32,
    /// Whether the inside is above.
    lower: bool,
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
        let (center, radius) = &to_clip.bounds(bounds);
        let (w, viewport) = (i64::from(center[2]), &projection.viewport);
        // Between planes that coincide, or are the wrong way round, there is nothing; rounded, it might have an area.
        if self.near >= self.far || w + *radius < i64::from(self.near) || w - radius > i64::from(self.far) {
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
            let slope = i64::from(side) * 16 - i64::from(projection.center[axis]);
            let across = i64::from(center[axis]) << self.scale;
            let outside = (across - slope * i64::from(self.divisor(center[2]))) * sign;
            let length =
                if self.flat != 0 { focal + 1 } else { length(focal as u32, slope.unsigned_abs() as u32) };
            outside <= (radius + 1) * length
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
        let mut polygon = Polygon::new(to_clip, coloring, corners, to);
        for axis in [2, 0, 1] {
            let range = if axis == 2 { [self.near, self.far] } else { [*CUT.start(), *CUT.end()] };
            let [below, mut above] = self.outside(&polygon, axis, range);
            if below != 0 {
                self.cut_by(&mut polygon, &Plane { axis, limit: range[0], lower: true }, below);
                [_, above] = self.outside(&polygon, axis, range);
            }
            if above != 0 {
                self.cut_by(&mut polygon, &Plane { axis, limit: range[1], lower: false }, above);
            }
        }
        let count = polygon.count;
        if !(0..count).all(|i| self.put_on_screen(&mut polygon, i)) {
            return None;
        }
        arrange(to.get_mut(..count)?);
        Some(count)
    }

    #[inline(never)]
    fn put_on_screen(&self, polygon: &mut Polygon<'_>, i: usize) -> bool {
        let (at, to) = (polygon.at(i), &mut polygon.vertices[i]);
        self.project(|axis| at[axis], &GUARD_BAND, (&mut to.x, &mut to.y, &mut to.q))
    }

    /// Puts a vertex that clipping has nothing to do with on the screen; false, and `to` of no use, for another.
    pub(super) fn place(
        &self,
        to_clip: &ToClip,
        coloring: &Coloring,
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

    /// Where a vertex is along an axis of the screen, in 1/16 px, or (axis 2) its w.
    #[inline(never)]
    fn along(&self, polygon: &Polygon<'_>, i: usize, axis: usize) -> i32 {
        let at = polygon.at(i);
        if axis == 2 { at[2] } else { self.screen(at[axis], axis, self.inverse(at[2].max(1))) }
    }

    /// Which vertices (bits) lie below and above a range of clip space (axis 2) or of the screen.
    #[inline(never)]
    fn outside(&self, polygon: &Polygon<'_>, axis: usize, [start, end]: [i32; 2]) -> [u32; 2] {
        let mut outside = [0; 2];
        for i in 0..polygon.count {
            let at = self.along(polygon, i, axis);
            outside[0] |= u32::from(at < start) << i;
            outside[1] |= u32::from(at > end) << i;
        }
        outside
    }

    /// Linear in clip space, and positive inside.
    #[inline(never)]
    fn distance(&self, at: &[i32; 3], plane: &Plane) -> i64 {
        let [.., w] = *at;
        let distance = match plane.axis {
            2 => i64::from(w) - i64::from(plane.limit),
            axis => {
                let slope = plane.limit - (self.center[axis] >> FINER);
                (i64::from(at[axis]) << self.scale) - wide(self.divisor(w), slope)
            }
        };
        if plane.lower { distance } else { -distance }
    }

    /// Cuts a convex polygon by one plane, outside which some vertices (bits) lie (Sutherland–Hodgman, in place).
    #[inline(never)]
    fn cut_by(&self, polygon: &mut Polygon<'_>, plane: &Plane, outside: u32) {
        let count = polygon.count;
        if outside == (1 << count) - 1 {
            polygon.count = 0;
            return;
        }
        let outside = outside | outside << count; // twice around
        // To the front with the first vertex inside that follows one outside.
        let first_out = outside.trailing_zeros();
        let first = first_out + (outside >> first_out).trailing_ones();
        polygon.rotate(if first < count as u32 { first as usize } else { first as usize - count });
        // Inside: 0 … stay; outside: stay … count.
        let stay = (outside >> first).trailing_zeros() as usize;
        let leave = self.cross(polygon, stay - 1, stay, plane);
        let enter = self.cross(polygon, 0, count - 1, plane);
        polygon.count = stay;
        polygon.push(&leave);
        polygon.push(&enter);
    }

    /// Where an edge crosses a plane, computed from its end `inside`.
    #[inline(never)]
    fn cross(&self, polygon: &Polygon<'_>, inside: usize, outside: usize, plane: &Plane) -> ClipVertex {
        let (from, to) = (polygon.at(inside), polygon.at(outside));
        let t = ratio(self.distance(&from, plane).max(0), -self.distance(&to, plane).min(0));
        let at = core::array::from_fn(|axis| mix(from[axis], to[axis], t));
        let (from, to) = (&polygon.vertices[inside], &polygon.vertices[outside]);
        ClipVertex {
            at,
            u: I16F16::from_bits(mix(from.u.to_bits(), to.u.to_bits(), t)),
            v: I16F16::from_bits(mix(from.v.to_bits(), to.v.to_bits(), t)),
            color: core::array::from_fn(|i| {
                U8F8::from_bits(mix(from.color[i].to_bits().into(), to.color[i].to_bits().into(), t) as u16)
            }),
        }
    }
}

/// Just more than √(a² + b²). The library's root divides.
#[inline(never)]
fn length(a: u32, b: u32) -> i64 {
    let mut shift = 0;
    while (a | b) >> shift >= 1 << 14 {
        shift += 1;
    }
    let [a, b] = [a, b].map(|side| (side >> shift) + u32::from(shift > 0));
    let mut root = 0;
    for bit in (0..15).rev() {
        let next = root | 1 << bit;
        if next * next <= a * a + b * b {
            root = next;
        }
    }
    i64::from(root + 1) << shift
}

#[inline(never)]
fn in_clip_space(to_clip: &ToClip, coloring: &Coloring, vertex: &Vertex) -> ClipVertex {
    let mut color = [U8F8::ZERO; 3];
    coloring.of_vertex(vertex, &mut color);
    let [u, v] = vertex.uv.map(I16F16::from);
    ClipVertex { at: to_clip.place_all(vertex.position), u, v, color }
}

/// before / (before + behind) in 30 bits.
#[inline(always)]
fn ratio(before: i64, behind: i64) -> i32 {
    let whole = before + behind;
    if whole == 0 {
        return 0;
    }
    let shift = whole.leading_zeros() as i32 - 33; // whole becomes 2³⁰ … 2³¹ − 1
    let normal = |value: i64| (if shift >= 0 { value << shift } else { value >> -shift }) as i32;
    let reciprocal = Reciprocal::precise(normal(whole) as u32);
    ((wide(normal(before), reciprocal.mantissa) >> 31) as i32).min(1 << 30)
}

/// Weights 2³⁰ − t and t: no difference is taken that could overflow.
#[inline(never)]
fn mix(a: i32, b: i32, t: i32) -> i32 {
    if a == b {
        return a; // As the rest would say: colours, for the most part.
    }
    ((wide(a, (1 << 30) - t) + wide(b, t) + (1 << 29)) >> 30) as i32
}
