//! The arrow out of set-up: a triangle with all that its rows and pixels need, computed once.

use super::attribute::Attribute;
use super::plane::Plane;
use super::spans::WIDEST;
use crate::frame::first_center;
use crate::geometry::{ScreenVertex, is_gray};
use crate::math::recip::Reciprocal;
use crate::num::{leading_zeros, mul_round, normalise, shift_round, wide, wide_inlined};

/// The longest row of a straight triangle, in steps.
pub(crate) const STRAIGHT: u8 = 31;

/// The most attributes that a shader can read: u, v, red, green, blue.
pub(crate) const ATTRIBUTES: usize = 5;

/// What the planes of a triangle hold.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Planes {
    /// Values of which the first is that at pixel (0, 0) of the screen.
    Screen,
    /// The same, from its [first pixel](TriangleSetup::first_pixel) on: it is [small](super::small). Its depth is never below 1 of 2¹⁶.
    Small,
    /// Values at its corners: it is a [sliver](super::setup), or of very different distances.
    Corners,
}

impl Planes {
    #[inline(always)]
    pub(crate) fn is_small(self) -> bool {
        self == Self::Small
    }

    #[inline(always)]
    pub(crate) fn is_sliver(self) -> bool {
        self == Self::Corners
    }
}

/// A triangle ready to be cut into spans.
#[derive(Debug)]
// In this order, so that flags lie where short instructions reach from depth.
#[repr(C)]
pub struct TriangleSetup {
    pub(crate) attributes: [Attribute; ATTRIBUTES],
    /// What perspective takes. Of a small triangle that is held: of u and v what is to be added x², xy and y² times, x and y being the way
    /// from the first pixel. Of any other that is bent: near/w scaled to 31 bits, as a plane; the size of its step along a row with the
    /// first bit set; the least that it is at a corner; and what straight lines of v keep from the ends of its range.
    pub(super) bends: [[i32; 3]; 2],
    /// The mantissa of 1 / (twice the area in 1/256 px²); not of small triangles.
    pub(super) area: i32,
    /// near/w with 31 fraction bits; for depth.
    pub(crate) z: Plane,
    /// x and y in 1/16 px, clockwise on the screen. The nearest is first, of a small triangle the uppermost. Of a small one that is neither
    /// held nor bent the other two stay what they were: nothing asks for them.
    pub(super) corners: [[i16; 2]; 3],
    /// Of a held or bent triangle: how many steps along a row attributes are nearly linear. Where u and v are not read it stays what it was.
    pub(crate) longest: u8,
    /// Of a bent one: whether q is nearly the same all along a row, so that attributes may be straight there: its
    /// step is below 2¹².
    pub(crate) is_level: bool,
    /// What its planes hold.
    pub(crate) planes: Planes,
    /// Whether all colours at the corners are greys, so that one channel stands for three.
    pub(crate) gray: bool,
    /// Of a bent one: how far the step of q was shifted, and whether q rises.
    pub(super) q_step_zeros: u8,
    pub(crate) q_rises: bool,
    /// Of a small one: whether attributes are [held](super::held) in their range. Else planes are of the attributes themselves, as I16F16
    /// with all of the scale.
    pub(crate) is_held: bool,
    /// Of a small one: whether u and v are quadratics, and held.
    pub(crate) is_bent: bool,
    /// Of one that is not small: whether attributes are linear on the screen, or nearly, so that planes hold them as they are.
    pub(crate) straight: bool,
    /// Whether they are so exactly, and texture coordinates [lean](TriangleSetup::lean).
    pub(crate) leans: bool,
    /// Of a bent one: whether its planes may leave the range of the corners by more than [`TriangleSetup::contract`] allows for.
    pub(crate) is_extreme: bool,
    /// The leading zeros of twice the area in 1/256 px²; not of small triangles.
    pub(super) area_zeros: u8,
}

const _: () = assert!(size_of::<TriangleSetup>() <= 224);

impl TriangleSetup {
    /// Of no triangle. (One is used for all triangles of a draw: setting it to zero takes 240 cycles.)
    pub(crate) fn new() -> Self {
        Self {
            corners: [[0; 2]; 3],
            area: 0,
            area_zeros: 0,
            gray: false,
            planes: Planes::Screen,
            is_held: false,
            is_bent: false,
            straight: false,
            leans: false,
            is_extreme: false,
            z: Plane::default(),
            bends: [[0; 3]; 2],
            longest: 0,
            is_level: false,
            q_step_zeros: 0,
            q_rises: false,
            attributes: [Attribute::default(); ATTRIBUTES],
        }
    }

    /// Before a shader's triangles, which may not read u and v.
    pub(crate) fn forget_longest(&mut self) {
        self.longest = STRAIGHT;
    }

    /// x and y of the corners, in 1/16 px.
    #[inline(always)]
    pub(super) fn corners(&self) -> [[i32; 2]; 3] {
        self.corners.map(|corner| corner.map(i32::from))
    }

    /// Sets its corners from the vertices.
    #[inline(always)]
    pub(super) fn set_corners(&mut self, vertices: &[&ScreenVertex; 3]) {
        self.corners = vertices.map(|vertex| [vertex.x.to_bits(), vertex.y.to_bits()]);
    }

    /// Sets the first corner alone: for the [first pixel](Self::first_pixel) of a small triangle.
    #[inline(always)]
    pub(super) fn set_first_corner(&mut self, vertex: &ScreenVertex) {
        self.corners[0] = [vertex.x.to_bits(), vertex.y.to_bits()];
    }

    /// Sets the first corner so that the [first pixel](Self::first_pixel) of a small triangle is in the first row of a table of spans, and
    /// [`WIDEST`] columns right of its first column.
    #[inline(always)]
    pub(super) fn set_first_pixel(&mut self, [row, column]: [i16; 2]) {
        self.corners[0] = [(column + WIDEST as i16) << 4, row << 4];
    }

    /// The pixel where planes begin. Of a small triangle that of corner 0, or the one below if its centre lies above the corner; of any
    /// other pixel (0, 0).
    #[inline(always)]
    pub(super) fn first_pixel(&self) -> [i32; 2] {
        if !self.planes.is_small() {
            return [0; 2];
        }
        let [x, y] = self.corners[0].map(i32::from);
        [x >> 4, first_center(y)]
    }

    /// From there to a pixel.
    #[inline(always)]
    pub(crate) fn beyond_first(&self, [x, y]: [i32; 2]) -> [i32; 2] {
        let [first_x, first_y] = self.first_pixel();
        [x - first_x, y - first_y]
    }

    /// 1 / (twice the area in 1/256 px²); not of small triangles.
    #[inline(always)]
    pub(super) fn area(&self) -> Reciprocal {
        Reciprocal { mantissa: self.area, zeros: self.area_zeros.into() }
    }

    /// Sets that.
    #[inline(always)]
    pub(super) fn set_area(&mut self, area: Reciprocal) {
        (self.area, self.area_zeros) = (area.mantissa, area.zeros as u8);
    }

    /// near/w scaled to 31 bits; for the division. Of a bent triangle that is not small.
    #[inline(always)]
    pub(crate) fn q(&self) -> Plane {
        let [origin, right, down] = self.bends[0];
        Plane { origin: origin as u32, steps: [right, down] }
    }

    /// Of the same: the step of q along a row, its size with the first bit set, and how far it was shifted for that.
    #[inline(always)]
    pub(crate) fn q_step(&self) -> (u32, u32) {
        (self.bends[1][0] as u32, self.q_step_zeros.into())
    }

    /// The least q of the corners.
    #[inline(always)]
    pub(super) fn q_min(&self) -> u32 {
        self.bends[1][1] as u32
    }

    /// What straight lines of attribute `i` keep from the ends of its range.
    #[inline(always)]
    pub(crate) fn inset(&self, i: usize) -> u32 {
        if i == 1 { self.bends[1][2] as u32 } else { 0 }
    }

    /// Whether it is small and may be drawn at one go.
    #[inline]
    pub(crate) fn is_patch(&self) -> bool {
        self.planes.is_small() && !self.is_held
    }

    /// The first and the last column or row of it within the screen, or as much of it as the screen has.
    #[cfg_attr(all(target_arch = "arm", not(target_has_atomic = "32")), inline(never))]
    #[cfg_attr(not(all(target_arch = "arm", not(target_has_atomic = "32"))), inline)]
    pub(super) fn extent(&self, axis: usize) -> [i32; 2] {
        let [a, b, c] = self.corners.map(|corner| i32::from(corner[axis] >> 4));
        let (first, last) = (a.min(b).min(c), a.max(b).max(c));
        [first.max((last - 1023).min(0)), last.min(1023)]
    }

    /// Whether u and v, the first two attributes, are everywhere inside a texture of 2^`log2` texels: there it is all the same
    /// whether it is repeated or clamped.
    pub(crate) fn uv_are_inside(&self, log2: [u32; 2]) -> bool {
        self.attributes.iter().zip(log2).all(|(attribute, log2)| {
            let last = attribute.least.checked_add_unsigned(attribute.range);
            attribute.scale_log2() == 0
                && attribute.least >= 0
                && last.is_some_and(|last| (last >> 16) < 1 << log2)
        })
    }

    /// A plane's value at a pixel's centre, and its step to the right. Inside the triangle only.
    #[inline]
    pub(crate) fn at(&self, plane: &Plane, x: i32, y: i32) -> (u32, i32) {
        if self.planes != Planes::Screen {
            return self.at_apart(plane, x, y);
        }
        (plane.at([x, y]), plane.steps[0])
    }

    /// A plane's step to the right.
    #[inline]
    pub(super) fn step(&self, plane: &Plane) -> i32 {
        if self.planes.is_sliver() { self.step_in_sliver(plane) } else { plane.steps[0] }
    }

    /// near/w at the first pixel of a span of so many, and its step. One pixel needs no step, which takes a while in a sliver.
    #[inline(always)]
    pub(crate) fn near_w_of(&self, x: i32, y: i32, count: usize) -> (u32, i32) {
        match self.planes {
            Planes::Screen => (self.z.at([x, y]), self.z.steps[0]),
            Planes::Corners if count == 1 => (self.value_in_sliver(&self.z, x, y), 0),
            _ => self.at_apart(&self.z, x, y),
        }
    }

    /// q with what rounding errors took below the least or above the greatest value at a corner taken away.
    #[inline]
    pub(crate) fn bounded(&self, q: u32) -> u32 {
        if q as i32 <= 0 { self.bounded_q(q) } else { q }
    }

    #[cold]
    #[inline(never)]
    fn bounded_q(&self, q: u32) -> u32 {
        let least = self.q_min();
        if q.wrapping_sub(least) > 3 << 30 { least } else { q.min(i32::MAX as u32) }
    }

    /// By how much corners 1 and 2 count at a pixel of a sliver, 31 fraction bits: exact edge functions times 1/area.
    #[cold]
    #[inline(never)]
    pub(crate) fn weights(&self, x: i32, y: i32) -> [u32; 2] {
        let [[ax, ay], [bx, by], [cx, cy]] = self.corners();
        let (px, py) = (x * 16 + 8 - ax, y * 16 + 8 - ay);
        [(ax - cx) * py - (ay - cy) * px, (bx - ax) * py - (by - ay) * px].map(|edge_function| {
            // Up to the area: below 2³¹ after this shift, and 1/area has as many zeros.
            let weight = wide_inlined(edge_function << (u32::from(self.area_zeros) - 1), self.area) >> 30;
            (weight as u32).min(i32::MAX as u32)
        })
    }

    /// A plane's value at a pixel of a triangle that is not small: in a sliver by how much corners 1 and 2 count there.
    #[inline]
    pub(crate) fn at_or_weighted(&self, plane: &Plane, [x, y]: [i32; 2], weights: &[u32; 2]) -> u32 {
        if self.planes.is_sliver() { plane.weighted(weights) } else { plane.at([x, y]) }
    }

    /// A plane's value in a sliver.
    #[cold]
    #[inline(never)]
    pub(crate) fn value_in_sliver(&self, plane: &Plane, x: i32, y: i32) -> u32 {
        plane.weighted(&self.weights(x, y))
    }

    /// A plane's value and its step to the right, in a sliver or a small triangle.
    #[cold]
    #[inline(never)]
    fn at_apart(&self, plane: &Plane, x: i32, y: i32) -> (u32, i32) {
        if self.planes.is_small() {
            return (plane.at(self.beyond_first([x, y])), plane.steps[0]);
        }
        (self.value_in_sliver(plane, x, y), self.step_in_sliver(plane))
    }

    /// A plane's step to the right in a sliver, the same in all of it.
    #[cold]
    #[inline(never)]
    fn step_in_sliver(&self, plane: &Plane) -> i32 {
        let [[_, ay], [_, by], [_, cy]] = self.corners();
        let [b, c] = plane.steps;
        // 16 · (b·(y₂ − y₀) − c·(y₁ − y₀)) / area, with 31 bits of the sum. It may be too large for an i32: then no span has
        // two pixels, since the value stays within 32 bits.
        let sum = wide(cy - ay, b) - wide(by - ay, c);
        let magnitude = sum.abs();
        let excess = 31 - normalise((magnitude >> 30) as u32 | 1).1;
        let product = wide((magnitude >> excess) as i32, self.area);
        let step =
            shift_round(product, 58 - u32::from(self.area_zeros) - excess).min(i64::from(i32::MAX)) as i32;
        if sum < 0 { -step } else { step }
    }

    /// An attribute of a sliver at a pixel's centre, I16F16 without its scale, with weights edge function · q / sum of both
    /// at each corner: exact products, divided to 30 bits.
    #[cold]
    #[inline(never)]
    pub(crate) fn resolve_in_sliver(&self, attribute: &Attribute, x: i32, y: i32) -> i32 {
        let [[ax, ay], [bx, by], [cx, cy]] = self.corners();
        let (px, py) = (x * 16 + 8 - ax, y * 16 + 8 - ay);
        let (b, c) = ((ax - cx) * py - (ay - cy) * px, (bx - ax) * py - (by - ay) * px);
        let a = (bx - ax) * (cy - ay) - (by - ay) * (cx - ax) - b - c;
        let plane = self.q();
        let q = |rise: i32| plane.origin.wrapping_add_signed(rise) as i32;
        // Together at most area · 2³¹.
        let (b, c) = (wide(b, q(plane.steps[0])), wide(c, q(plane.steps[1])));
        let sum = (wide(a, q(0)) + b + c).max(1);
        // Their upper 31 bits.
        let excess = 33 - leading_zeros(sum as u64) as i32;
        let upper = |product: i64| (if excess >= 0 { product >> excess } else { product << -excess }) as i32;
        let reciprocal = Reciprocal::precise(upper(sum) as u32);
        let weights = [b, c].map(|product| {
            let weight = wide(upper(product), reciprocal.mantissa) >> 30;
            weight.min(i64::from(i32::MAX)) as i32
        });
        let [b, c] = attribute.plane.steps;
        attribute.bounded(mul_round::<31>(weights[0], b) + mul_round::<31>(weights[1], c))
    }
}

/// Whether all colours at the corners are greys.
#[inline(never)]
pub(super) fn are_gray(vertices: &[&ScreenVertex; 3]) -> bool {
    vertices.iter().all(|vertex| is_gray(vertex.color))
}

/// By how much the edge functions of corners 1 and 2 change a column, and a row, of 1/16 px.
#[inline]
pub(crate) fn edges([a, b, c]: &[[i32; 2]; 3]) -> [[i32; 2]; 2] {
    [[c[1] - a[1], a[1] - b[1]], [a[0] - c[0], b[0] - a[0]]]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn q_that_rounding_took_out_of_its_range_is_brought_back() {
        let (least, most) = (5, i32::MAX as u32);
        let setup = TriangleSetup { bends: [[0; 3], [0, least as i32, 0]], ..TriangleSetup::new() };
        let met =
            [(0, least), (u32::MAX, least), (u32::MAX - 2000, least), (1 << 31, most), (most + 2000, most)];
        let inside = [least, 6, 1 << 20, most].map(|q| (q, q));
        for (q, bounded) in met.into_iter().chain(inside) {
            assert_eq!(setup.bounded(q), bounded, "{q:#x}");
        }
    }
}
