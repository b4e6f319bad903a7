//! Cut: triangles that cross a plane of clipping, or come very near the eye.
//!
//! - In: the corners of a triangle in the mesh.
//! - Out: what is left of it, as a polygon of screen vertices, a fan around the first.
//! - Assumes: at least one corner lies outside, or too near for 32 bits.
//!
//! The corner on an edge is computed from the end inside towards the end outside, in both triangles of the edge. A vertex that needs
//! no clipping stays where the triangles have it that are not cut, and counts as inside all planes.
//!
//! # How exact corners are
//!
//! Clip coordinates have 46 bits here, [`FINE`] more than elsewhere. Of these units [`ToClip::place_fine`] gets x, y and w less than
//! 9 wrong, and two cuts and the last shift 8 more of w. x and y are held in units of 2⁻¹⁵ · 1/16 px · w, of which as much makes 10 in all.
//! So before it is rounded to 1/16 px a corner is off by at most
//!
//! ```text
//! (9·2^k + 17·c + 20 480) / w px,   2^k at least the focal length, c its distance from the line of sight in pixels
//! ```
//!
//! w is at least near, 1/256. And a mesh that reaches the eye has a unit of 2⁻²⁸ or less: its scale is below 2¹⁰, and the way from its
//! origin to the eye is not longer than it reaches, 2¹⁴ (this is said of a rotation; a matrix with elements up to 2 may be four times as coarse). So w
//! is at least 2²⁰, and 2³⁰ at a scale of 1. For a focal length of 512 px that makes 1/25 px in the corner of a screen of 1023 px at the very
//! most, and a thousandth of that at a scale of 1; for the longest focal length, at the border of the guard band and 3069 px beside a line of sight that
//! leads far past it, 1/7 px.
//!
//! Rounding adds 1/32 px. Both together are below ¼ px: the planes, at ±1022¾ px, stay beyond the centres of the last columns and rows,
//! which are filled; and what is cut stays inside the guard band, ¾ px beyond. So nothing that is seen has to be left out for
//! want of bits. (What a matrix that is no rotation moves farther than that is put on the guard band's border.)

use super::clip::{CUT_AT, Clip, FINER};
use super::coloring::Coloring;
use super::fan::center;
use super::screen::{GUARD, ScreenVertex};
use super::transform::{FINE, ToClip};
use crate::math::recip::Reciprocal;
use crate::num::{I12F4, I16F16, U8F8, mul_long, wide};
use crate::scene::Vertex;
use core::mem;

/// The most corners that a clipped triangle has: three, and one more for each plane.
pub(crate) const MOST_CORNERS: usize = 9;

/// x of a corner that is still to be put on the screen.
const NOT_PLACED: I12F4 = I12F4::MIN;

/// How many bits x and y lose in sixteenths of a pixel.
const COARSER: i32 = 15;

/// A polygon in clip space, and the screen vertices that become of it.
struct Polygon<'a> {
    /// Their positions are those of the mesh's vertices that need no clipping, or [`NOT_PLACED`].
    vertices: &'a mut [ScreenVertex; MOST_CORNERS],
    /// x and y, which divided by w are 2^−[`COARSER`] px/16 from the screen's corner; w in clip units, with [`FINE`] bits more.
    at: [At; MOST_CORNERS],
    count: usize,
    /// The near plane and the far one, as w.
    planes: [i64; 2],
}

/// Three coordinates of 48 bits, each in an upper part and a lower one.
#[derive(Clone, Copy)]
struct At {
    lower: [u32; 3],
    upper: [i16; 4],
}

impl At {
    const ZERO: Self = Self { lower: [0; 3], upper: [0; 4] };
}

impl Polygon<'_> {
    #[inline(always)]
    fn at(&self, i: usize, axis: usize) -> i64 {
        i64::from(self.at[i].upper[axis]) << 32 | i64::from(self.at[i].lower[axis])
    }

    #[inline(always)]
    fn set(&mut self, i: usize, axis: usize, at: i64) {
        (self.at[i].upper[axis], self.at[i].lower[axis]) = ((at >> 32) as i16, at as u32);
    }

    #[inline(never)]
    fn mix(&mut self, axis: usize, [a, b, to]: [usize; 3], t: &Ratio) {
        self.set(to, axis, t.between(self.at(a, axis), self.at(b, axis)));
    }

    /// Without its last 0 … 31 bits, where the rest fits 32.
    #[inline(never)]
    fn short(&self, i: usize, axis: usize, dropped: i32) -> i32 {
        i32::from(self.at[i].upper[axis]) << (31 - dropped) << 1 | (self.at[i].lower[axis] >> dropped) as i32
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
            swap(self.vertices, first, end);
            swap(&mut self.at, first, end);
            first += 1;
        }
    }
}

/// The library's moves what it swaps three times, by a routine of 1300 bytes.
#[inline(always)]
fn swap<T>(all: &mut [T], first: usize, last: usize) {
    if let Some((before, [last, ..])) = all.split_at_mut_checked(last)
        && let Some(first) = before.get_mut(first)
    {
        mem::swap(first, last);
    }
}

impl Clip {
    /// Cuts a triangle that is not inside all planes, or has a corner too near for 32 bits, and puts what is left of it on the
    /// screen, as a fan around its first vertex. Returns how many corners that has, and whether it is [folded](super::fan).
    #[cold]
    #[inline(never)]
    pub(crate) fn cut(
        &self,
        to_clip: &ToClip,
        coloring: &Coloring<'_>,
        corners: [&Vertex; 3],
        to: &mut [ScreenVertex; MOST_CORNERS],
    ) -> (usize, bool) {
        let planes = self.planes.map(|plane| Self::distance_of(to_clip, plane));
        let mut polygon = Polygon { vertices: to, at: [At::ZERO; MOST_CORNERS], count: 3, planes };
        for (i, vertex) in corners.into_iter().enumerate() {
            self.start(to_clip, coloring, vertex, &mut polygon, i);
        }
        // Where no vertex is outside a side no corner will be.
        let outside = (0..3).fold(0, |all, i| all | Self::outside(&polygon, i));
        for side in 0..6 {
            if outside >> side & 1 != 0 {
                self.cut_by(&mut polygon, side);
            }
        }
        let count = polygon.count;
        for i in 0..count {
            self.put_on_screen(&mut polygon, i);
        }
        let (first, is_folded) = center(polygon.vertices.get(..count).unwrap_or_default());
        polygon.rotate(first);
        (count, is_folded)
    }

    /// Where a vertex is before anything is cut.
    #[inline(never)]
    fn start(
        &self,
        to_clip: &ToClip,
        coloring: &Coloring<'_>,
        vertex: &Vertex,
        polygon: &mut Polygon<'_>,
        i: usize,
    ) {
        let mut may_be_inside = true;
        if self.is_fine {
            for axis in [2, 0, 1] {
                self.start_along(to_clip, vertex, polygon, i, axis);
            }
        } else {
            // The same from 32 bits, which are as good.
            let [x, y, w] = to_clip.place_all(vertex.position);
            let divisor = if self.flat != 0 { 1 << self.flat } else { w };
            for (axis, at) in [(0, x), (1, y)] {
                let center = wide(divisor, self.center[axis] >> FINER);
                polygon.set(i, axis, ((i64::from(at) << self.scale) + center) >> (COARSER - FINE));
            }
            polygon.set(i, 2, i64::from(w) << FINE);
            may_be_inside = w >= self.least;
        }
        self.look(polygon, i);
        let to = &mut polygon.vertices[i];
        to.set_attributes(vertex, coloring);
        let outside = to.y;
        // Most often it is behind the eye.
        if !may_be_inside || !self.place_bare(to_clip, vertex, to) {
            (to.x, to.y) = (NOT_PLACED, outside);
        }
    }

    #[inline(never)]
    fn start_along(
        &self,
        to_clip: &ToClip,
        vertex: &Vertex,
        polygon: &mut Polygon<'_>,
        i: usize,
        axis: usize,
    ) {
        let mut at = to_clip.place_fine(vertex.position, axis);
        if let Some(center) = self.center.get(axis) {
            let center = mul_long(self.divisor_of(polygon, i), (center >> FINER) << COARSER);
            at = ((at << 2) >> (2 + COARSER - self.scale)) + center;
        }
        polygon.set(i, axis, at);
    }

    /// Rounds a corner to the screen, if it has no position yet. One that numbers too coarse move out of the guard band is put on
    /// its border; of a rotation there is none.
    #[inline(never)]
    fn put_on_screen(&self, polygon: &mut Polygon<'_>, i: usize) {
        if polygon.vertices[i].x != NOT_PLACED {
            return;
        }
        // As many bits as fit 31: without perspective of x and y, of which w is no part.
        let is_flat = self.flat != 0;
        let [x, y, w, _] = polygon.at[i].upper.map(i32::from);
        let all = (x ^ x >> 31) | (y ^ y >> 31) | if is_flat { 0 } else { w };
        let dropped = if all == 0 { 2 } else { 34 - all.leading_zeros() as i32 };
        let [x, y] = [0, 1].map(|axis| polygon.short(i, axis, dropped));
        // Up, so that it is not before the near plane.
        let w = polygon.short(i, 2, if is_flat { FINE } else { dropped }) + 1;
        let w = if is_flat { w.min(self.far) } else { w };
        let to = &mut polygon.vertices[i];
        let on_border = |at: i32| Some(at.clamp(-GUARD, GUARD));
        let place = (&mut to.x, &mut to.y, &mut to.q);
        let at = |axis| if axis == 0 { x } else { y };
        self.project(at, w, [FINE - dropped, COARSER], &[1 << (FINER - 1); 2], on_border, place);
    }

    /// What x and y are divided by.
    #[inline(always)]
    fn divisor_of(&self, polygon: &Polygon<'_>, i: usize) -> i64 {
        if self.flat != 0 { 1 << (self.flat + FINE) } else { polygon.at(i, 2) }
    }

    /// How far inside a side a corner lies, linear in clip space: of near, far, left, right, top and bottom. Within ±2⁴⁷.
    #[inline(never)]
    fn distance(&self, polygon: &Polygon<'_>, i: usize, side: usize) -> i64 {
        let at = polygon.at(i, if side < 2 { 2 } else { side / 2 - 1 });
        let at = if side & 1 == 0 { at } else { -at };
        match side {
            0 => at - polygon.planes[0],
            1 => at + polygon.planes[1],
            _ => self.border_of(polygon, i) + at,
        }
    }

    /// How far from the screen's corner the guard band is cut at a corner.
    #[inline(always)]
    fn border_of(&self, polygon: &Polygon<'_>, i: usize) -> i64 {
        // ±1022¾ px are 1 − 2⁻¹⁰ − 2⁻¹² of 2^COARSER sixteenths, twice.
        const { assert!(CUT_AT << 2 == (1 << (COARSER + 1)) - (5 << (COARSER - 11))) };
        let divisor = self.divisor_of(polygon, i);
        (divisor - (divisor >> 10) - (divisor >> 12)) >> 1
    }

    /// Writes down in the place of y outside which sides a corner lies (bits).
    #[inline(never)]
    fn look(&self, polygon: &mut Polygon<'_>, i: usize) {
        let [x, y, w] = [0, 1, 2].map(|axis| polygon.at(i, axis));
        let border = self.border_of(polygon, i);
        let [near, far] = polygon.planes;
        let mut outside = i16::from(w < near) | i16::from(w > far) << 1;
        for (at, bit) in [(x, 2), (y, 4)] {
            // Both, perhaps, behind the eye.
            outside |= (i16::from(-at > border) | i16::from(at > border) << 1) << bit;
        }
        polygon.vertices[i].y = I12F4::from_bits(outside);
    }

    /// Outside which sides a corner lies (bits): of none if it needs no clipping.
    #[inline(never)]
    fn outside(polygon: &Polygon<'_>, i: usize) -> u32 {
        let vertex = &polygon.vertices[i];
        if vertex.x == NOT_PLACED { vertex.y.to_bits() as u32 } else { 0 }
    }

    /// Cuts a convex polygon by one plane (Sutherland–Hodgman, in place).
    #[inline(never)]
    fn cut_by(&self, polygon: &mut Polygon<'_>, side: usize) {
        let count = polygon.count;
        let mut outside = 0_u32;
        for i in 0..count {
            outside |= (Self::outside(polygon, i) >> side & 1) << i;
        }
        if outside == 0 {
            return;
        }
        if outside == (1 << count) - 1 {
            polygon.count = 0;
            return;
        }
        let outside = outside | outside << count; // twice around
        // To the front with the first vertex inside that follows one outside.
        let first_out = outside.trailing_zeros();
        let first = first_out + (outside >> first_out).trailing_ones();
        polygon.rotate(if first < count as u32 { first as usize } else { first as usize - count });
        // Inside: 0 … stay; outside: stay … count. Each plane adds at most one vertex to a convex polygon: there is room.
        let stay = (outside >> first).trailing_zeros() as usize;
        self.cross(polygon, [0, count - 1, stay + 1], side);
        self.cross(polygon, [stay - 1, stay, stay], side);
        polygon.count = stay + 2;
    }

    /// Where an edge crosses a plane, computed from its end `inside`, as a corner in the place `to`, which may be that of the end
    /// `outside`.
    #[inline(never)]
    fn cross(&self, polygon: &mut Polygon<'_>, [inside, outside, to]: [usize; 3], side: usize) {
        let before = self.distance(polygon, inside, side).max(0);
        let t = Ratio::new(before, -self.distance(polygon, outside, side), self.is_fine);
        for axis in 0..2 {
            polygon.mix(axis, [inside, outside, to], &t);
        }
        match polygon.planes.get(side) {
            Some(&w) => polygon.set(to, 2, w),
            None => polygon.mix(2, [inside, outside, to], &t),
        }
        polygon.vertices[to].y = I12F4::ZERO;
        // On a side nothing is outside the opposite one, and after the last sides no one asks.
        if side < 4 {
            self.look(polygon, to);
        }
        let vertices = &mut *polygon.vertices;
        vertices[to].x = NOT_PLACED;
        vertices[to].u =
            I16F16::from_bits(mix(vertices[inside].u.to_bits(), vertices[outside].u.to_bits(), t.upper));
        vertices[to].v =
            I16F16::from_bits(mix(vertices[inside].v.to_bits(), vertices[outside].v.to_bits(), t.upper));
        for i in 0..3 {
            let [a, b] = [inside, outside].map(|vertex| i32::from(vertices[vertex].color[i].to_bits()));
            // As the rest would say, for the most part.
            vertices[to].color[i] = U8F8::from_bits(if a == b { a } else { mix(a, b, t.upper) } as u16);
        }
    }
}

/// A number of 0 … 1.
struct Ratio {
    /// In units of 2⁻³⁰.
    upper: i32,
    /// What is left, in units of 2⁻⁵⁴.
    lower: i32,
}

impl Ratio {
    /// before / (before + behind), both 0 … 2⁴⁷: a quotient of 30 bits and, if it is to be fine, another of what that leaves, so
    /// that it is within 2⁻⁴⁴.
    #[inline(never)]
    fn new(before: i64, behind: i64, is_fine: bool) -> Self {
        let whole = before + behind;
        if whole == 0 {
            return Self { upper: 0, lower: 0 };
        }
        let shift = whole.leading_zeros() - 16; // whole becomes 2⁴⁷ … 2⁴⁸ − 1
        let (before, whole) = (before << shift, whole << shift);
        // 1/whole = mantissa · 2⁻⁷⁸.
        let mantissa = Reciprocal::precise_normalised((whole >> 16) as u32, 1).mantissa;
        let upper = (mul_long(before, mantissa) >> 18).min(1 << 30) as i32;
        let rest = if is_fine { (before - mul_long(whole, upper)) as i32 } else { 0 };
        Self { upper, lower: (wide(rest, mantissa) >> 24) as i32 }
    }

    /// From `a` to `b`, which differ by less than 2⁴⁷, rounded down.
    #[inline(always)]
    fn between(&self, a: i64, b: i64) -> i64 {
        let mut share = mul_long(b - a, self.upper);
        if self.lower != 0 {
            share += mul_long((b - a) >> 24, self.lower);
        }
        a + share
    }
}

/// Weights 2³⁰ − t and t: no difference is taken that could overflow.
#[inline(never)]
fn mix(a: i32, b: i32, t: i32) -> i32 {
    ((wide(a, (1 << 30) - t) + wide(b, t) + (1 << 29)) >> 30) as i32
}
