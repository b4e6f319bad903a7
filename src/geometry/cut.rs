//! Clipping of one triangle: what of it lies between the near and the far plane and inside the guard band.
//!
//! - In: the corners of a triangle in mesh space.
//! - Out: what is left of it, as a convex polygon of screen vertices that is a fan around the first; perhaps no corners.
//! - Assumes: a corner lies outside a clipping plane, or is so near that 32 bits are too few to place it.
//!
//! This is Sutherland–Hodgman in clip space, one plane after another, in place. Neighbours have to fit together:
//!
//! - Where an edge crosses a plane the new vertex is computed from the end inside towards the end outside. Both triangles of
//!   the edge do the same with the same numbers.
//! - A vertex that needs no clipping keeps the position that triangles that are not clipped have, and counts as inside.
//!
//! # How exact the corners are
//!
//! Clip coordinates have 46 bits here, [`FINE`] more than elsewhere. In these finer units:
//!
//! - x, y and w of [`ToClip::place_fine`] are off by less than 9. Clipping by two planes and the last shift add 8 for w.
//! - x and y are held as X = w · position / 2¹⁵, the position in 1/16 px. So a unit of X is 2¹¹/w pixels. The same steps make
//!   X off by 10 units.
//!
//! Before it is rounded to 1/16 px a corner is therefore off by at most
//!
//! ```text
//! (9·2^k + 17·c + 20 480) / w pixels,   2^k ≥ the focal length, and c the corner's distance from the line of sight, in pixels
//! ```
//!
//! How small can w be? The near plane is at least 2⁻⁸ away. A mesh of scale s < 2¹⁰ reaches 14·s < 2¹⁴ from its origin. If it
//! reaches the eye its origin is no farther, so its finer unit is at most 2⁻²⁸: w ≥ 2²⁰. At a scale of 1 it is w ≥ 2³⁰. (All
//! this is for a rotation. A matrix with elements up to 2 may make units four times as coarse.) Examples at w = 2²⁰:
//!
//! - A focal length of 512 px, in a corner 1023 px from the line of sight: 1/25 px.
//! - The longest focal length, 2¹³ px, on the guard band's border, 3069 px from a line of sight far outside: 1/7 px.
//!
//! Rounding adds 1/32 px, so the sum is below ¼ px. The sides of clipping are at ±1022¾ px. So they stay beyond the centres
//! of the last columns and rows that can be drawn, ±1022½ px, and inside the guard band of ±1023½ px. Nothing visible is lost
//! for want of bits. (A corner that a matrix that is no rotation takes farther is put on the guard band's border.)

use super::clip::{CUT_AT, Clip, FINER, on_border};
use super::fan::center;
use super::ratio::{Ratio, mix};
use super::screen::ScreenVertex;
use super::split::Split;
use super::transform::{FINE, ToClip};
use crate::num::{I12F4, I16F16, U8F8, lowest_bit, mul_long, wide, zeros_of};
use crate::scene::Vertex;
use core::mem;

/// The most corners that a clipped triangle has: three, and one more for each plane.
pub(crate) const MOST_CORNERS: usize = 9;

/// x of a corner that is still to be put on the screen.
const NOT_PLACED: I12F4 = I12F4::MIN;

/// x and y of a corner are held as w · position in 1/16 px / 2^this. Positions in the guard band are within ±2¹⁴, so x and y
/// are within ±w/2.
const COARSER: i32 = 15;

/// A polygon in clip space, and the screen vertices that become of it.
struct Polygon<'a> {
    /// A vertex that needs no clipping has its position. Any other has [`NOT_PLACED`] for x, and in the bits of y outside of
    /// which sides it lies, as [`Clip::look`] puts them there.
    vertices: &'a mut [ScreenVertex; MOST_CORNERS],
    /// x and y as [`COARSER`] says, from the screen's upper left corner; w in clip units with [`FINE`] bits more. 48 bits each: of corner
    /// after corner, the lower 32 and the upper 16.
    lower: [[u32; 3]; MOST_CORNERS],
    upper: &'a mut Upper,
    count: usize,
    /// w of the near and of the far plane, in the same unit.
    planes: [Split; 2],
}

/// The memory that clipping takes besides that of the vertices and its own stack. A mesh has it while none of its triangles is drawn.
pub(crate) type Upper = [[i16; 3]; MOST_CORNERS];

impl Polygon<'_> {
    #[inline(always)]
    fn at(&self, i: usize, axis: usize) -> i64 {
        let upper = self.upper.get(i).and_then(|at| at.get(axis)).copied().unwrap_or(0);
        let lower = self.lower.get(i).and_then(|at| at.get(axis)).copied().unwrap_or(0);
        i64::from(upper) << 32 | i64::from(lower)
    }

    #[inline(always)]
    fn set(&mut self, i: usize, axis: usize, value: i64) {
        if let (Some(upper), Some(lower)) = (self.upper.get_mut(i), self.lower.get_mut(i))
            && let (Some(upper), Some(lower)) = (upper.get_mut(axis), lower.get_mut(axis))
        {
            (*upper, *lower) = ((value >> 32) as i16, value as u32);
        }
    }

    /// Sets a coordinate of corner `to` between those of `a` (where `t` is 0) and `b` (1).
    #[inline(never)]
    fn mix(&mut self, axis: usize, corners: [u8; 3], t: &Ratio) {
        let [a, b, to] = corners.map(usize::from);
        if a.max(b).max(to) >= MOST_CORNERS {
            return;
        }
        self.set(to, axis, t.between(self.at(a, axis), self.at(b, axis)));
    }

    /// A coordinate without its last `dropped` bits, 0 … 31. What is left has to fit 32 bits.
    #[inline(never)]
    fn short(&self, i: usize, axis: usize, dropped: i32) -> i32 {
        let at = self.at(i, axis);
        ((at >> 32) as i32) << (31 - dropped) << 1 | (at as u32 >> dropped) as i32
    }

    /// Moves the vertices before `first` to the end, by three reversals. (`rotate_left` takes 2 KiB of flash, and more
    /// stack.)
    #[inline(never)]
    fn rotate(&mut self, first: usize) {
        if first > 0 {
            self.reverse(0, first);
            self.reverse(first, self.count);
            self.reverse(0, self.count);
        }
    }

    /// Reverses the vertices from `first` to before `end`. (`reverse` takes 600 bytes, unrolled.)
    #[inline(never)]
    fn reverse(&mut self, mut first: usize, mut end: usize) {
        while first + 1 < end {
            end -= 1;
            if let Some((a, b)) = two(self.vertices, first, end) {
                a.exchange(b);
            }
            if let Some((a, b)) = two(&mut self.lower, first, end) {
                a.iter_mut().zip(b).for_each(|(a, b)| mem::swap(a, b));
            }
            if let Some((a, b)) = two(self.upper, first, end) {
                a.iter_mut().zip(b).for_each(|(a, b)| mem::swap(a, b));
            }
            first += 1;
        }
    }
}

/// Two elements, `first` < `last`.
#[inline(always)]
fn two<T>(all: &mut [T], first: usize, last: usize) -> Option<(&mut T, &mut T)> {
    match all.split_at_mut_checked(last)? {
        (before, [last, ..]) => Some((before.get_mut(first)?, last)),
        _ => None,
    }
}

impl Clip {
    /// Clips a triangle and puts what is left of it on the screen, as a fan around its first vertex. Returns how many corners
    /// that has, and whether it is [folded](super::fan). `to` begins with the attributes of the corners.
    #[cold]
    #[inline(never)]
    pub(crate) fn cut(
        &self,
        to_clip: &ToClip,
        corners: [&Vertex; 3],
        to: &mut [ScreenVertex; MOST_CORNERS],
        upper: &mut Upper,
    ) -> (usize, bool) {
        let planes = self.planes.map(|plane| Split::new(self.distance_of(plane)));
        let mut polygon = Polygon { vertices: to, lower: [[0; 3]; MOST_CORNERS], upper, count: 3, planes };
        let mut outside = 0;
        for (i, vertex) in corners.into_iter().enumerate() {
            // One after another, so that they are not on the stack together.
            let may_be_inside = self.start(to_clip, vertex, &mut polygon, i);
            outside |= self.sides(to_clip, vertex, &mut polygon, (i, may_be_inside));
        }
        // A side outside of which no vertex lies cuts nothing off. (In a loop that is not unrolled.)
        let mut side = 0;
        while outside != 0 {
            if outside & 1 != 0
                && let Some(stay) = Self::open(&mut polygon, side)
            {
                // Now 0 .. stay are inside, and stay .. count outside. These give way to two new vertices, one more than they are at
                // most: there is room for one per plane.
                let last = polygon.count - 1;
                self.cross(&mut polygon, [0, last as u8, stay as u8 + 1], side);
                self.cross(&mut polygon, [stay as u8 - 1, stay as u8, stay as u8], side);
                polygon.count = stay + 2;
            }
            (outside, side) = (outside >> 1, side + 1);
        }
        let count = polygon.count;
        for i in 0..count {
            self.put_on_screen(&mut polygon, i);
        }
        let (first, is_folded) = center(polygon.vertices.get(..count).unwrap_or_default());
        polygon.rotate(first);
        (count, is_folded)
    }

    /// Sets the clip coordinates of corner `i` to those of a vertex of the triangle. Returns whether it may need no clipping.
    #[inline(never)]
    fn start(&self, to_clip: &ToClip, vertex: &Vertex, polygon: &mut Polygon<'_>, i: usize) -> bool {
        if self.is_fine {
            for axis in [2, 0, 1] {
                self.start_along(to_clip, vertex, polygon, i, axis);
            }
            true
        } else {
            // From clip coordinates of 32 bits, which are exact enough.
            let [x, y, w] = to_clip.place_all(vertex.position);
            let divisor = if self.flat() != 0 { 1 << self.flat() } else { w };
            polygon.set(i, 0, self.across(x, divisor, self.center[0]));
            polygon.set(i, 1, self.across(y, divisor, self.center[1]));
            polygon.set(i, 2, i64::from(w) << FINE);
            w >= self.least
        }
    }

    /// Sets the position of corner `i`, a vertex of the triangle, if it needs no clipping. Returns the sides outside of which it lies.
    #[cfg_attr(all(target_arch = "arm", not(target_has_atomic = "32")), inline(never))]
    #[cfg_attr(not(all(target_arch = "arm", not(target_has_atomic = "32"))), inline(always))]
    fn sides(&self, to_clip: &ToClip, vertex: &Vertex, polygon: &mut Polygon<'_>, at: (usize, bool)) -> u32 {
        let (i, may_be_inside) = at;
        self.look(polygon, i);
        let Some(to) = polygon.vertices.get_mut(i) else {
            return 0;
        };
        // `place_bare` may overwrite it.
        let outside = to.y;
        // The first condition saves that work: most often such a vertex is behind the eye.
        if !may_be_inside || !self.place_bare(to_clip, vertex, to) {
            (to.x, to.y) = (NOT_PLACED, outside);
            return outside.to_bits() as u32;
        }
        0
    }

    /// x or y of a corner, from clip coordinates of 32 bits. Out of line on Armv6-M: there is one copy for both.
    #[cfg_attr(all(target_arch = "arm", not(target_has_atomic = "32")), inline(never))]
    #[cfg_attr(not(all(target_arch = "arm", not(target_has_atomic = "32"))), inline)]
    fn across(&self, at: i32, divisor: i32, center: i32) -> i64 {
        ((i64::from(at) << self.scale()) + wide(divisor, center >> FINER)) >> (COARSER - FINE)
    }

    /// Sets one clip coordinate of corner `i` from all bits there are: w (axis 2) first, as x and y need it.
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
            at = ((at << 2) >> (2 + COARSER - self.scale())) + center;
        }
        polygon.set(i, axis, at);
    }

    /// Projects corner `i` to the screen, if it has no position yet. One that lands outside the guard band is put on its
    /// border: that takes a matrix that is no rotation, see the head of this file.
    #[inline(never)]
    fn put_on_screen(&self, polygon: &mut Polygon<'_>, i: usize) {
        if polygon.vertices.get(i).is_none_or(|vertex| vertex.x != NOT_PLACED) {
            return;
        }
        // All coordinates are shortened alike, so that the largest has 30 bits and a sign. Without perspective w does not
        // divide: it keeps its own unit.
        let is_flat = self.flat() != 0;
        let [x, y, w] = [0, 1, 2].map(|axis| (polygon.at(i, axis) >> 32) as i32);
        let all = (x ^ x >> 31) | (y ^ y >> 31) | if is_flat { 0 } else { w };
        let dropped = if all == 0 { 2 } else { 34 - zeros_of(all as u32) as i32 };
        let [x, y] = [0, 1].map(|axis| polygon.short(i, axis, dropped));
        // Rounded up, so that it is not before the near plane and q not above 1.
        let w = polygon.short(i, 2, if is_flat { FINE } else { dropped }) + 1;
        let w = if is_flat { w.min(self.far) } else { w };
        let Some(to) = polygon.vertices.get_mut(i) else {
            return;
        };
        let inverse = self.set_q(w, FINE - dropped, &mut to.q);
        (to.x, to.y) = (on_border(x, COARSER, inverse), on_border(y, COARSER, inverse));
    }

    /// What x and y are divided by, in finer clip units: w, or 1 without perspective.
    #[inline(always)]
    fn divisor_of(&self, polygon: &Polygon<'_>, i: usize) -> i64 {
        if self.flat() != 0 { 1 << (self.flat() + FINE) } else { polygon.at(i, 2) }
    }

    /// How far inside a side a corner lies, as a linear function in clip space: negative outside, within ±2⁴⁷. Sides are
    /// near, far, left, right, top and bottom.
    #[inline(never)]
    fn distance(&self, polygon: &Polygon<'_>, i: usize, side: usize) -> i64 {
        if i >= MOST_CORNERS {
            return 0;
        }
        let at = polygon.at(i, if side < 2 { 2 } else { side / 2 - 1 });
        let at = if side & 1 == 0 { at } else { -at };
        let reach = match side {
            0 => -polygon.planes[0].value(),
            1 => polygon.planes[1].value(),
            _ => self.border_of(polygon, i),
        };
        reach + at
    }

    /// The largest |x| and |y| of a corner that lies inside the sides: w · [`CUT_AT`] / 2^[`COARSER`].
    #[inline(always)]
    fn border_of(&self, polygon: &Polygon<'_>, i: usize) -> i64 {
        // ±1022¾ px are (1 − 2⁻¹⁰ − 2⁻¹²)/2 of 2^COARSER sixteenths.
        const { assert!(CUT_AT << 2 == (1 << (COARSER + 1)) - (5 << (COARSER - 11))) };
        let divisor = self.divisor_of(polygon, i);
        (divisor - (divisor >> 10) - (divisor >> 12)) >> 1
    }

    /// Notes outside of which sides a corner lies: bit n of y for side n, in the order of [`Clip::distance`].
    #[inline(never)]
    fn look(&self, polygon: &mut Polygon<'_>, i: usize) {
        // Asked once, here: 50 bytes less on Armv6-M than where each coordinate is read.
        if i >= MOST_CORNERS {
            return;
        }
        let [x, y, w] = [0, 1, 2].map(|axis| polygon.at(i, axis));
        let border = self.border_of(polygon, i);
        let [near, far] = polygon.planes.map(Split::value);
        // Behind the eye the border is negative, and of two sides that face each other both may be true.
        let distances = [w - near, far - w, border + x, border - x, border + y, border - y];
        // The sign is the bit.
        let outside =
            distances.iter().rev().fold(0, |bits, distance| bits << 1 | (distance >> 63) as i16 & 1);
        if let Some(vertex) = polygon.vertices.get_mut(i) {
            vertex.y = I12F4::from_bits(outside);
        }
    }

    /// The sides outside of which a corner lies, as bits. None if it needs no clipping.
    #[inline(never)]
    fn outside(polygon: &Polygon<'_>, i: usize) -> u32 {
        match polygon.vertices.get(i) {
            Some(vertex) if vertex.x == NOT_PLACED => vertex.y.to_bits() as u32,
            _ => 0,
        }
    }

    /// Rotates a convex polygon so that it begins with those corners that lie inside a plane. Returns how many: then there are one or
    /// more outside. `None` if there are not, or all are: then the polygon is left with no corners.
    #[inline(never)]
    fn open(polygon: &mut Polygon<'_>, side: usize) -> Option<usize> {
        let count = polygon.count;
        let mut outside = 0_u32;
        for i in 0..count {
            outside |= (Self::outside(polygon, i) >> side & 1) << i;
        }
        if outside == 0 {
            return None;
        }
        if outside == (1 << count) - 1 {
            polygon.count = 0;
            return None;
        }
        // With the one that follows one outside.
        let outside = outside | outside << count; // twice around
        let first_out = lowest_bit(outside);
        let first = first_out + lowest_bit(!(outside >> first_out));
        polygon.rotate(if first < count { first } else { first - count });
        Some(lowest_bit(outside >> first))
    }

    /// Sets corner `to` where the edge from corner `inside` to corner `outside` crosses a plane. `to` may be `outside`.
    #[inline(never)]
    fn cross(&self, polygon: &mut Polygon<'_>, corners: [u8; 3], side: usize) {
        let [inside, outside, to] = corners.map(usize::from);
        // Rounded, one that counts as inside may lie a little outside.
        let before = self.distance(polygon, inside, side).max(0);
        let t = Ratio::new(before, -self.distance(polygon, outside, side), self.is_fine);
        for axis in 0..2 {
            polygon.mix(axis, corners, &t);
        }
        match polygon.planes.get(side) {
            Some(w) => polygon.set(to, 2, w.value()),
            None => polygon.mix(2, corners, &t),
        }
        let vertices = &mut *polygon.vertices;
        let attributes = |i: usize| vertices.get(i).map(|vertex| (vertex.u, vertex.v, vertex.color));
        let (Some(a), Some(b)) = (attributes(inside), attributes(outside)) else {
            return;
        };
        let Some(vertex) = vertices.get_mut(to) else {
            return;
        };
        (vertex.x, vertex.y) = (NOT_PLACED, I12F4::ZERO);
        let mixed = |a: I16F16, b: I16F16| I16F16::from_bits(mix(a.to_bits(), b.to_bits(), t.upper));
        (vertex.u, vertex.v) = (mixed(a.0, b.0), mixed(a.1, b.1));
        for ((channel, a), b) in vertex.color.iter_mut().zip(a.2).zip(b.2) {
            let [a, b] = [a, b].map(|channel| i32::from(channel.to_bits()));
            // Most often they are equal, and then `mix` would give the same.
            *channel = U8F8::from_bits(if a == b { a } else { mix(a, b, t.upper) } as u16);
        }
        // After the last two sides nothing is asked any more: what lies on the top side is not outside the bottom one.
        if side < 4 {
            self.look(polygon, to);
        }
    }
}
