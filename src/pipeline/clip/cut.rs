//! Stage 2 for triangles that lie across a plane: they are cut in clip space.
//!
//! The corner on an edge is computed from the end inside towards the end outside, in both triangles of the edge.

use super::super::color::Coloring;
use super::super::fan::center;
use super::super::transform::{ClipVertex, ToClip};
use super::{CUT, Clip, FINER, GUARD_BAND, ScreenVertex};
use crate::math::recip::Reciprocal;
use crate::num::{I12F4, I16F16, U1F31, U8F8, wide};
use crate::scene::Vertex;
use core::mem;

/// The most corners that a clipped triangle has: three, and one more for each plane.
pub(in crate::pipeline) const MOST_CORNERS: usize = 9;

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
        coloring: &Coloring<'_>,
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

    /// Moves the vertices before `first` to the end, by three reversals: the library's way takes 2 KiB of flash, and more stack.
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
    /// Cuts a triangle that is not inside all planes and puts what is left of it on the screen, as a fan
    /// around its first vertex; `None` if that does not fit the guard band (which only the coarsest of numbers do not).
    #[cold]
    #[inline(never)]
    pub(in crate::pipeline) fn cut(
        &self,
        to_clip: &ToClip,
        coloring: &Coloring<'_>,
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
        polygon.rotate(center(polygon.vertices.get(..count)?));
        Some(count)
    }

    #[inline(never)]
    fn put_on_screen(&self, polygon: &mut Polygon<'_>, i: usize) -> bool {
        let (at, to) = (polygon.at(i), &mut polygon.vertices[i]);
        self.project(|axis| at[axis], &GUARD_BAND, (&mut to.x, &mut to.y, &mut to.q))
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

#[inline(never)]
fn in_clip_space(to_clip: &ToClip, coloring: &Coloring<'_>, vertex: &Vertex) -> ClipVertex {
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
