//! Stage 3: what a triangle's spans and pixels need, computed once.
//!
//! An edge function is the signed area of an edge and a point, in 1/256 px²:
//!
//! ```text
//! E_ab(p) = (b.x − a.x)(p.y − a.y) − (b.y − a.y)(p.x − a.x)
//! ```
//!
//! Divided by the triangle's own area it is the barycentric weight of the corner opposite. In a guard
//! band 2047 px wide no difference exceeds 2047·16 = 32752, so no edge function exceeds
//! 2·32752² = 2 145 387 008 < 2³¹: they are exact in an `i32`.
//!
//! # Attributes, and why they are exact enough
//!
//! After projection u is not linear on the screen, but q and u·q are. Both are held as integers
//! that use all bits of this triangle's range: q scaled so that the nearest corner has 31 bits, and
//! U = (u − u₀)·q with 30, u₀ being the u of the **nearest** corner. With d the triangle's extent in pixels
//! and M the largest change of u per pixel step at p:
//!
//! - u is a quotient of linear functions, so u(corner) − u(p) = (q(p)/q(corner)) · ∇u(p)·(corner − p):
//!   |u₀ − u(p)| ≤ 2·M·d · q(p)/q₀, and |U(corner)| ≤ 4·M·d · q(p).
//! - An error of k units in q (of 2⁻³⁰·q₀ or less) moves u by k·2⁻³⁰·q₀·|u₀ − u|/q ≤ k·2⁻²⁹·M·d.
//! - An error of k units in U (of 2⁻²⁹·max|U|) moves u by k·2⁻²⁹·max|U|/q ≤ k·2⁻²⁷·M·d.
//! - The reciprocal's 2⁻²⁰ moves u by 2⁻¹⁹·M·d; the 17 bits of it that the default quality takes, by 2⁻¹⁶·M·d, 0.031 px at most.
//!
//! Each is kept as a plane: a value at pixel (0, 0) and one rounded step a column and a row, **in wrapping
//! integers**. What the plane says far outside the triangle wraps, and wraps back: inside, where the true value fits 32
//! bits, only the rounding of the steps remains, k ≤ (n + m)/2 + 16 after n columns and m rows from the middle of what is
//! within the screen. With n, m ≤ 512 and d ≤ 2047 the sum of all is 0.012 px in the very worst case for any ratio of w.
//!
//! # Which texel a whole coordinate is
//!
//! Where q is the same at all corners, or does not count, texture coordinates are straight: then a coordinate that is whole at a
//! pixel's centre is sampled infinitesimally right of that, and infinitely less below, as coverage is by the top-left rule. So
//! `TriangleSetup::lean` moves its plane in the direction in which it changes there, once, by as much as all that follows may be
//! behind. And its range ends below the greatest value at the corners: so it does for all triangles.
//!
//! # Slivers
//!
//! In a sliver the steps are large and nearly cancel, and where distances differ more than 4096-fold q has too few bits at
//! the far corner for [`Exact`](super::Exact). Then a plane holds the values at the corners instead, and is
//! evaluated by weights from the exact edge functions, which never cancel; `Exact` mixes attributes at every pixel, by weights
//! from the exact products of edge functions and q. Both are slower, rare, and out of line.

use super::attribute::Attribute;
use super::clip::ScreenVertex;
use super::color::is_gray;
use super::patch::STRAIGHT;
use super::shade::Inputs;
use super::straight::{Bend, Straight};
use crate::math::recip::Reciprocal;
use crate::num::{mul_round, shift_round, wide};

/// Which side of a triangle is left out.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Cull {
    /// Triangles that run clockwise on the screen.
    #[default]
    Back,
    /// Triangles that run counter-clockwise on the screen.
    Front,
    /// None.
    None,
}

impl Cull {
    /// By twice the area, positive clockwise on the screen.
    #[inline]
    pub(super) fn leaves_out(self, area: i32) -> bool {
        match self {
            _ if area == 0 => true,
            Self::Back => area > 0,
            Self::Front => area < 0,
            Self::None => false,
        }
    }
}

/// The most attributes that a shader can read: u, v, red, green, blue.
pub(super) const ATTRIBUTES: usize = 5;

/// A triangle ready to be cut into spans: corners clockwise on the screen, the nearest first.
#[derive(Debug)]
pub(crate) struct TriangleSetup {
    /// x and y in 1/16 px.
    pub(super) corners: [[i32; 2]; 3],
    /// 1 / (twice the area in 1/256 px²); not of small triangles.
    area: Reciprocal,
    /// Whether all colours at the corners are greys, so that one channel stands for three.
    pub(super) gray: bool,
    /// Whether planes hold values at corners: a sliver, or of very different distances.
    pub(super) sliver: bool,
    /// Whether it is set up as a small one: no sliver, and its depth never below 1 of 2¹⁶.
    pub(super) is_small: bool,
    /// Whether attributes are linear on the screen, or nearly, or with what they bend by: planes hold them as they are.
    pub(super) straight: bool,
    /// Whether they are so exactly, and texture coordinates [lean](TriangleSetup::lean).
    pub(super) leans: bool,
    /// near/w with 31 fraction bits; for depth.
    pub(super) z: Plane,
    /// near/w scaled to 31 bits; for the division. Not of straight triangles.
    pub(super) q: Plane,
    /// Of a bent triangle: how many steps along a row attributes are nearly linear.
    pub(super) longest: i32,
    /// The least q of the corners.
    pub(super) q_min: u32,
    pub(super) attributes: [Attribute; ATTRIBUTES],
}

const _: () = assert!(size_of::<TriangleSetup>() <= 304);

/// A linear function on the screen, in integers that wrap.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Plane {
    /// At pixel (0, 0); of a sliver, at corner 0.
    pub(super) origin: u32,
    /// One column to the right, one row down; of a sliver, from corner 0 to corners 1 and 2.
    pub(super) steps: [i32; 2],
}

impl Plane {
    /// Moves each step to the nearest multiple of 2⁻¹² if that is within its error, of a small triangle 2⁻¹⁶ of it more; around a
    /// corner.
    ///
    /// Sprites have such steps: of whole texels a pixel, of a half or a quarter. One unit less would cost a unit of packed
    /// coordinates at every pixel.
    fn snap(&mut self, corner: &[i32; 2], error: u32, is_small: bool) {
        for (step, at) in self.steps.iter_mut().zip(corner) {
            let change = (step.wrapping_add(8) & !15).wrapping_sub(*step);
            let error = error + if is_small { step.unsigned_abs() >> 16 } else { 0 };
            if change.unsigned_abs() <= error {
                *step = step.wrapping_add(change);
                self.origin = self.origin.wrapping_sub((at >> 4).wrapping_mul(change) as u32);
            }
        }
    }

    /// By how much what it says at the corners (1/16 px), above `least`, is above the values there, in 1/16: 0 or less, and 0 or more.
    #[inline(never)]
    fn errors(&self, corners: &[[i32; 2]; 3], values: &[i32; 3], least: i32) -> [i32; 2] {
        let [right, down] = self.steps;
        let mut errors = [0; 2];
        for ([x, y], value) in corners.iter().zip(values) {
            let way = right.wrapping_mul(x - 8).wrapping_add(down.wrapping_mul(y - 8));
            let error = ((self.origin.wrapping_sub((value - least) as u32) << 4) as i32).wrapping_add(way);
            errors = [errors[0].min(error), errors[1].max(error)];
        }
        errors
    }
}

/// How weights of corners 1 and 2 change over the screen, and where planes begin: for set-up only.
struct Slopes {
    /// Over one column, over one row, in units of 2^−(32 + `fraction_bits`).
    of_weights: [[i32; 2]; 2],
    fraction_bits: i32,
    /// Corner 0's pixel.
    pixel: [i32; 2],
    /// From corner 0 to the centre of that pixel, −7 … 8 sixteenths.
    to_center: [i32; 2],
    /// From that pixel to the middle of what is within the screen.
    to_middle: [i32; 2],
}

/// What a shader wants of a triangle.
pub(super) struct Needs {
    pub(super) inputs: Inputs,
    pub(super) straight: Straight,
    /// Whether it divides at every pixel.
    pub(super) every_pixel: bool,
    /// u and v are multiplied by 2^this, 0 … 8.
    pub(super) texture_scale: u32,
    pub(super) packing: Packing,
    /// Whether depth is tested.
    pub(super) depth: bool,
    /// Whether all colours are known to be grey.
    pub(super) gray: bool,
}

/// How [packed texture coordinates](super::fill::Texels) are drawn, before they are scaled. Of others a unit is 1, and a run has no
/// steps that add up.
pub(super) struct Packing {
    /// The larger unit of the two, I16F16: at a run's first pixel they are rounded down to it, and their steps are cut to it.
    unit: u16,
    /// How far from the ends of their range u and v stay if they may not be [exactly straight](TriangleSetup::lean), I16F16: as far as
    /// carries can take v where u does not repeat within four pixels, and 1 at least. 0 if they are not among the inputs.
    pub(super) inset: u16,
    /// The most steps before a run starts anew.
    steps: u8,
    /// Log₂ of where u repeats, I16F16. There it carries into v.
    turn_log2: u8,
}

const _: () = assert!(size_of::<Packing>() == 6);

impl Packing {
    /// Of a texture with sides of these log₂, if it is packed, for these inputs.
    #[inline(never)]
    pub(super) fn new(log2: Option<[u32; 2]>, scale_log2: u32, inputs: Inputs) -> Self {
        if !matches!(inputs, Inputs::Uv | Inputs::UvColor) {
            return Self { unit: 1, inset: 0, steps: 0, turn_log2: 31 };
        }
        let Some([a, b]) = log2 else {
            return Self { unit: 1, inset: 1, steps: 0, turn_log2: 31 };
        };
        let steps = if a.max(b) > 6 { 15 } else { 63 };
        let unit = 1 << (a.max(b).wrapping_sub(scale_log2) & 15);
        let turn_log2 = (16 + a).wrapping_sub(scale_log2) as u8;
        Self { unit, inset: unit * (steps / 4 + 3), steps: steps as u8, turn_log2 }
    }

    /// Whether a step makes u repeat within four pixels.
    #[inline]
    fn is_steep(&self, u_step: i32) -> bool {
        u_step.unsigned_abs() >> ((self.turn_log2 - 2) & 31) != 0
    }

    /// How many units of v carries may come to in so many steps of u: one where it begins, one for each time it repeats, which is
    /// every second step at the most, as whole turns of u are left out; and v may be one unit too large for what a falling u is to
    /// borrow from it.
    fn carries(&self, u_step: u32, steps: u32) -> u32 {
        let turns = ((u_step >> 8) * steps) >> (self.turn_log2 - 8);
        (turns + 3).min(steps / 2 + 2)
    }
}

impl Needs {
    /// Whether attributes are exactly linear on the screen where a triangle's corners have these least and greatest q.
    #[inline]
    pub(super) fn is_exactly_straight(&self, least: u32, most: u32) -> bool {
        least == most || matches!(self.straight, Straight::Always)
    }

    /// Hands on the attributes in use, with the corners' values in I16F16 and the scale's log₂, until one returns false: u and
    /// v, then colours, of which there is one in a grey triangle.
    #[inline]
    pub(super) fn each_attribute(
        &self,
        triangle: &Oriented<'_>,
        gray: bool,
        mut set: impl FnMut(usize, [i32; 3], u32) -> bool,
    ) -> bool {
        let vertices = triangle.vertices;
        let uv = matches!(self.inputs, Inputs::Uv | Inputs::UvColor);
        let color = matches!(self.inputs, Inputs::Color | Inputs::UvColor);
        let first = if uv { 0 } else { 2 };
        let end = if !color {
            2
        } else if gray {
            3
        } else {
            5
        };
        (first..end).all(|i| {
            let at = |vertex: &ScreenVertex| match i {
                0 => vertex.u.to_bits(),
                1 => vertex.v.to_bits(),
                _ => i32::from(vertex.color[i - 2].to_bits()) << 8,
            };
            set(i - first, vertices.map(at), if i < 2 { self.texture_scale } else { 0 })
        })
    }
}

/// A triangle's vertices clockwise on the screen, the nearest first, and twice its area in 1/256 px².
pub(super) struct Oriented<'a> {
    pub(super) vertices: [&'a ScreenVertex; 3],
    pub(super) area: u32,
}

impl<'a> Oriented<'a> {
    /// `None` for a triangle without area or culled.
    #[inline]
    pub(super) fn new(vertices: [&'a ScreenVertex; 3], cull: Cull) -> Option<Self> {
        let area = area(vertices.map(position));
        (!cull.leaves_out(area)).then(|| Self::of_area(vertices, area))
    }

    /// Of a triangle's [`area`], which is not 0.
    #[inline(always)]
    pub(super) fn of_area(vertices: [&'a ScreenVertex; 3], area: i32) -> Self {
        Self { vertices: in_order(vertices, area, |vertex| vertex.q.to_bits()), area: area.unsigned_abs() }
    }
}

/// Twice the area of a triangle between positions in 1/16 px, positive clockwise on the screen.
#[inline(always)]
pub(super) fn area([[ax, ay], [bx, by], [cx, cy]]: [[i32; 2]; 3]) -> i32 {
    (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)
}

/// The corners of a triangle of this [`area`], which is not 0, as set-up takes them: clockwise, the nearest first.
#[inline(always)]
pub(super) fn in_order<T: Copy>([a, b, c]: [T; 3], area: i32, q: impl Fn(T) -> u32) -> [T; 3] {
    let [b, c] = if area < 0 { [c, b] } else { [b, c] };
    if q(b) > q(a) && q(b) >= q(c) {
        [b, c, a]
    } else if q(c) > q(a) {
        [c, a, b]
    } else {
        [a, b, c]
    }
}

impl TriangleSetup {
    /// Of no triangle. (One is used for all triangles of a draw: setting it to zero takes 240 cycles.)
    pub(super) fn new() -> Self {
        Self {
            corners: [[0; 2]; 3],
            area: Reciprocal { mantissa: 0, zeros: 0 },
            gray: false,
            sliver: false,
            is_small: false,
            straight: false,
            leans: false,
            z: Plane::default(),
            q: Plane::default(),
            longest: 0,
            q_min: 0,
            attributes: [Attribute::default(); ATTRIBUTES],
        }
    }

    #[inline]
    pub(super) fn set(&mut self, triangle: &Oriented<'_>, needs: &Needs, simple: bool) {
        self.sliver = false;
        self.leans = false;
        self.is_small = true;
        self.longest = STRAIGHT;
        if needs.inputs == Inputs::None && !needs.depth {
            self.straight = true;
            return;
        }
        if matches!(needs.inputs, Inputs::Color | Inputs::UvColor) {
            self.gray = needs.gray || triangle.vertices.into_iter().all(|vertex| is_gray(vertex.color));
        }
        if !self.set_small_planes(triangle, needs, simple) {
            self.set_any_planes(triangle, needs);
        }
    }

    /// Makes the range of a small triangle's u and v end a little inside on both sides, where they may not be exactly straight.
    #[inline]
    pub(super) fn keep_small_inside(&mut self, needs: &Needs) {
        let [u, v, ..] = &mut self.attributes;
        if needs.packing.is_steep(u.plane.steps[0]) {
            return self.keep_steep_inside(needs);
        }
        u.open_end();
        v.keep_straight_inside(needs.packing.inset.into());
    }

    /// As [`TriangleSetup::keep_small_inside`], where u repeats within four pixels: so often that v had better not be stepped.
    #[cold]
    #[inline(never)]
    fn keep_steep_inside(&mut self, needs: &Needs) {
        self.step_singly();
        let [u, v, ..] = &mut self.attributes;
        u.open_end();
        v.keep_inside(2 * u32::from(needs.packing.inset), true);
    }

    /// Makes rows of a small triangle begin anew at every pixel.
    fn step_singly(&mut self) {
        if self.longest == STRAIGHT {
            self.attributes.iter_mut().for_each(|attribute| attribute.bend = [0; 3]);
        }
        self.longest = 0;
    }

    #[inline(never)]
    fn set_any_planes(&mut self, triangle: &Oriented<'_>, needs: &Needs) {
        self.is_small = false;
        let vertices = triangle.vertices;
        self.area = Reciprocal::precise(triangle.area);
        let slopes = self.slopes(triangle.area);
        let near_w = vertices.map(|vertex| vertex.q.to_bits());
        // The nearest corner gets all 31 bits.
        let q = near_w.map(|q| q.clamp(1, i32::MAX as u32));
        let q = q.map(|near_w| near_w << (q[0].leading_zeros() - 1));
        self.q_min = q[1].min(q[2]);
        // Where the far corner is left with few of them, the rounding of steps would be too much for `Exact`: no planes.
        let is_perspective = matches!(needs.straight, Straight::Below(_));
        self.sliver |= needs.every_pixel && self.q_min < 1 << 19 && is_perspective;
        if needs.depth {
            // Depth must not wrap where rounding takes it out of 0 … 2³¹: 2048 units, 1/16 of a depth step, are room
            // for that.
            let z = near_w.map(|q| q.clamp(2048, (1 << 31) - 2048));
            self.z = self.plane(&slopes, z[0], [1, 2].map(|i| z[i].wrapping_sub(z[0]) as i32));
        }
        if needs.inputs == Inputs::None {
            self.straight = true;
            return;
        }
        let is_exact = needs.is_exactly_straight(self.q_min, q[0]);
        self.straight = match needs.straight {
            Straight::Below(limit) if !is_exact => {
                Bend::new(&edges(&self.corners), q, self.q_min).is_some_and(|bend| bend.is_straight(limit))
            }
            _ => true,
        };
        if !self.straight {
            self.q = self.plane(&slopes, q[0], [1, 2].map(|i| q[i].wrapping_sub(q[0]) as i32));
        }
        let mixed = self.sliver && needs.every_pixel;
        needs.each_attribute(triangle, self.gray, |i, at, scale_log2| {
            self.attributes[i] = self.attribute(&slopes, at, scale_log2, &q, mixed);
            true
        });
        if needs.packing.inset > 0 {
            self.settle(triangle, needs, is_exact.then_some(slopes.fraction_bits));
        }
    }

    /// Makes u and v of what is not small lean if they are exactly straight, or stay a little inside their range.
    #[inline(never)]
    fn settle(&mut self, triangle: &Oriented<'_>, needs: &Needs, fraction_bits: Option<i32>) {
        if let Some(fraction_bits) = fraction_bits {
            return self.lean_large(triangle, needs, fraction_bits);
        }
        let [u, v, ..] = &mut self.attributes;
        u.open_end();
        v.keep_inside(2 * u32::from(needs.packing.inset), self.straight);
    }

    /// As [`TriangleSetup::lean`], of one that is not small.
    ///
    /// A plane is off by half a unit at every column and row from its middle on, by one and a half unit of a slope from corner 0 on, and
    /// by 20 where it begins.
    #[cold]
    fn lean_large(&mut self, triangle: &Oriented<'_>, needs: &Needs, bits: i32) {
        let [width, height] = [0, 1].map(|axis| self.extent(axis)).map(|[first, last]| last - first + 1);
        if self.sliver {
            self.lean(triangle, needs, 0, 24 + (width >> 1));
        } else if bits < 3 {
            // Steps of few fraction bits, of a triangle that is not much larger than the screen.
            self.lean(triangle, needs, if bits < 0 { (5 << (-bits & 31)) >> 2 } else { 1 }, i32::MAX);
        } else {
            let all = (0..2).fold(2, |all, axis| {
                let [a, b, c] = self.corners.map(|corner| corner[axis] >> 4);
                all + a.max(b).max(c) - a.min(b).min(c)
            });
            self.lean(triangle, needs, 0, 21 + ((width + height) >> 2) + ((3 * all) >> (bits + 1)));
        }
    }

    /// Makes exactly straight texture coordinates lean in the direction of the change that decides of which texel a whole coordinate
    /// is (see [`direction`]): by as much as their plane, and a run that is drawn from it, may be behind. So a coordinate that is whole
    /// at a pixel's centre is never taken for the texel on the wrong side.
    ///
    /// What a plane is off by is linear too, so nowhere worse than at one of the corners, where it is known: `most` is what it may be
    /// within the screen. (A sliver's plane is exact to 4 units where a run begins, and its step to half a unit: `most`.)
    ///
    /// A run of packed coordinates is behind by what they are rounded down to at its first pixel, by what its step is cut to, at every
    /// further pixel, and v by the carries of u, which may put it ahead, too. So v stays that far from the border between two texels
    /// where the end of its range lies close to one; which texels it shows does not depend on that.
    ///
    /// A step that may be off by `slack` is [taken for](Plane::snap) the one of a sprite.
    #[cold]
    #[inline(never)]
    pub(super) fn lean(&mut self, triangle: &Oriented<'_>, needs: &Needs, slack: u32, most: i32) {
        self.leans = true;
        let [u, v] = [|vertex: &ScreenVertex| vertex.u, |vertex: &ScreenVertex| vertex.v]
            .map(|coordinate| triangle.vertices.map(|vertex| coordinate(vertex).to_bits()));
        let carries = self.lean_by(0, &u, needs, [slack, 0], most);
        self.lean_by(1, &v, needs, [slack, carries], most);
    }

    /// Makes one do so, from its values at the corners. Returns in how many units carries of it may come to.
    #[inline(never)]
    fn lean_by(
        &mut self,
        i: usize,
        at: &[i32; 3],
        needs: &Needs,
        [slack, carries]: [u32; 2],
        most: i32,
    ) -> u32 {
        let direction = direction(&edges(&self.corners), [at[1] - at[0], at[2] - at[0]]);
        let attribute = &mut self.attributes[i];
        if direction == 0 {
            // The middle of its texel, if carries can move it.
            if i > 0 {
                attribute.keep_inside(needs.packing.inset.into(), true);
            }
            return 0;
        }
        let mut plane = attribute.plane;
        let mut behind = most;
        if !self.sliver {
            let mut snapped = plane;
            snapped.snap(&self.corners[0], slack, self.is_small);
            let [mut errors, by_snapped] =
                [plane, snapped].map(|plane| plane.errors(&self.corners, at, attribute.least));
            // Whichever is off by less from one corner to another.
            if by_snapped[1] - by_snapped[0] <= errors[1] - errors[0] {
                (plane, errors) = (snapped, by_snapped);
            }
            behind = behind.min(1 + (if direction > 0 { -errors[0] } else { errors[1] } >> 4));
        }
        let packing = &needs.packing;
        let [[first, y], ..] = self.corners.map(|corner| corner.map(|at| at >> 4));
        let step = self.at(&plane, first, y).1.unsigned_abs();
        let [first, last] = self.extent(0);
        let unit = u32::from(packing.unit);
        // Of a large texture, what is not small is drawn in shorter runs.
        let longest = if packing.steps == 15 && !self.is_small { 7 } else { u32::from(packing.steps) };
        let steps = longest.min((last - first) as u32);
        let room = (carries * unit) as i32;
        behind += room + (unit + steps * (step & (unit - 1))) as i32;
        plane.origin = plane.origin.wrapping_add_signed(direction * behind);
        let texel = 0x10000 >> needs.texture_scale;
        let attribute = &mut self.attributes[i];
        let mut least = attribute.least;
        let mut greatest = least.wrapping_add_unsigned(attribute.range) - 1;
        if least & (texel - 1) < room {
            least += room;
        }
        if greatest & (texel - 1) >= texel - room {
            greatest -= room;
        }
        attribute.plane = plane;
        attribute.limit(least, greatest.max(least));
        if packing.is_steep(step as i32) {
            self.step_singly();
        }
        packing.carries(step, steps)
    }

    /// A plane's value at a pixel's centre, and its step to the right. Inside the triangle only.
    #[inline]
    pub(super) fn at(&self, plane: &Plane, x: i32, y: i32) -> (u32, i32) {
        let [right, down] = plane.steps;
        if self.sliver {
            return self.at_in_sliver(plane, x, y);
        }
        (plane.origin.wrapping_add_signed(x.wrapping_mul(right).wrapping_add(y.wrapping_mul(down))), right)
    }

    /// By weights: exact edge functions times 1/area.
    #[cold]
    #[inline(never)]
    fn at_in_sliver(&self, plane: &Plane, x: i32, y: i32) -> (u32, i32) {
        let [[ax, ay], [bx, by], [cx, cy]] = self.corners;
        let (px, py) = (x * 16 + 8 - ax, y * 16 + 8 - ay);
        let weighted = |edge_function: i32, rise: i32| {
            // Up to the area: below 2³¹ after this shift, and 1/area has as many zeros.
            let weight = wide(edge_function << (self.area.zeros - 1), self.area.mantissa) >> 30;
            mul_round::<31>(weight.min(i64::from(i32::MAX)) as i32, rise)
        };
        let [b, c] = plane.steps;
        let value = plane
            .origin
            .wrapping_add_signed(weighted((ax - cx) * py - (ay - cy) * px, b))
            .wrapping_add_signed(weighted((bx - ax) * py - (by - ay) * px, c));
        // 16 · (b·(y₂ − y₀) − c·(y₁ − y₀)) / area, with 31 bits of the sum. It may be too large for an i32: then no span has
        // two pixels, since the value stays within 32 bits.
        let sum = wide(cy - ay, b) - wide(by - ay, c);
        let magnitude = sum.unsigned_abs();
        let excess = 33u32.saturating_sub(magnitude.leading_zeros());
        let product = wide((magnitude >> excess) as i32, self.area.mantissa);
        let step = shift_round(product, 58 - self.area.zeros - excess).min(i64::from(i32::MAX)) as i32;
        (value, if sum < 0 { -step } else { step })
    }

    /// The first `N` attributes of a sliver at a pixel's centre, I16F16, with weights edge function · q / sum of both
    /// at each corner: exact products, divided to 30 bits.
    #[cold]
    #[inline(never)]
    pub(super) fn resolve_in_sliver<const N: usize>(
        &self,
        attributes: &[Attribute; N],
        x: i32,
        y: i32,
    ) -> [i32; N] {
        let [[ax, ay], [bx, by], [cx, cy]] = self.corners;
        let (px, py) = (x * 16 + 8 - ax, y * 16 + 8 - ay);
        let (b, c) = ((ax - cx) * py - (ay - cy) * px, (bx - ax) * py - (by - ay) * px);
        let a = (bx - ax) * (cy - ay) - (by - ay) * (cx - ax) - b - c;
        let q = |rise: i32| self.q.origin.wrapping_add_signed(rise) as i32;
        // Together at most area · 2³¹.
        let (b, c) = (wide(b, q(self.q.steps[0])), wide(c, q(self.q.steps[1])));
        let sum = (wide(a, q(0)) + b + c).max(1);
        // Their upper 31 bits.
        let excess = 33 - sum.leading_zeros() as i32;
        let upper = |product: i64| (if excess >= 0 { product >> excess } else { product << -excess }) as i32;
        let reciprocal = Reciprocal::precise(upper(sum) as u32);
        let weights = [b, c].map(|product| {
            let weight = wide(upper(product), reciprocal.mantissa) >> 30;
            weight.min(i64::from(i32::MAX)) as i32
        });
        attributes.each_ref().map(|attribute| {
            let [b, c] = attribute.plane.steps;
            attribute.finish(mul_round::<31>(weights[0], b) + mul_round::<31>(weights[1], c))
        })
    }

    /// The first and the last column or row of it within the screen, or as much of it as the screen has.
    #[inline(never)]
    fn extent(&self, axis: usize) -> [i32; 2] {
        let [a, b, c] = self.corners.map(|corner| corner[axis] >> 4);
        let (first, last) = (a.min(b).min(c), a.max(b).max(c));
        [first.max((last - 1023).min(0)), last.min(1023)]
    }

    /// Finds out whether it is a sliver, too.
    ///
    /// Not inlined: what it takes is not on the stack while planes are set.
    #[inline(never)]
    fn slopes(&mut self, area: u32) -> Slopes {
        let (edges, a) = (edges(&self.corners), self.corners[0]);
        let spread = |e: [i32; 2]| (e[0].abs() + e[1].abs()) as u32; // below 2¹⁶
        let (height, width) = (spread(edges[0]), spread(edges[1]));
        // The largest difference to 30 bits, times 1/area.
        let largest = edges.as_flattened().iter().fold(1, |all, e| all | e.unsigned_abs());
        let shift = largest.leading_zeros() - 2;
        // Steps must fit 32 bits: at least a pixel wide and high. And their errors, one and a half unit of 2^−`fraction_bits` a
        // pixel, must not exceed 256 units over the triangle's extent of 2^(30 − `shift`) sixteenths.
        self.sliver = height.max(width) * 16 > area || 2 * shift < 23 + self.area.zeros;
        let pixel = a.map(|at| at >> 4);
        Slopes {
            of_weights: edges.map(|edge| edge.map(|e| (wide(e << shift, self.area.mantissa) >> 31) as i32)),
            // (e·2^shift · mantissa / 2³¹) · 2^−(32 + n) = 16·e·mantissa·2^(zeros − 62)
            fraction_bits: shift as i32 - 5 - self.area.zeros as i32,
            pixel,
            to_center: [pixel[0] * 16 + 8 - a[0], pixel[1] * 16 + 8 - a[1]],
            to_middle: [0, 1].map(|axis| {
                let [first, last] = self.extent(axis);
                ((first + last) >> 1) - pixel[axis]
            }),
        }
    }

    /// From the value at corner 0 and the rise from there to corners 1 and 2.
    #[inline(never)]
    fn plane(&self, slopes: &Slopes, origin: u32, rise: [i32; 2]) -> Plane {
        if self.sliver {
            return Plane { origin, steps: rise };
        }
        let mut plane = Plane { origin, steps: [0; 2] };
        for axis in 0..2 {
            let [b, c] = slopes.of_weights[axis];
            let slope = mul_round::<32>(rise[0], b).wrapping_add(mul_round::<32>(rise[1], c));
            let bits = slopes.fraction_bits;
            let (step, rest) = if bits > 0 {
                let step = ((slope >> (bits - 1)) + 1) >> 1;
                // What rounding leaves, with at most 12 of its bits, as far as the middle is away.
                let rest = slope.wrapping_sub(step << bits);
                (
                    step,
                    if bits > 12 {
                        ((rest >> (bits - 12)) * slopes.to_middle[axis]) >> 12
                    } else {
                        (rest * slopes.to_middle[axis]) >> bits
                    },
                )
            } else {
                (slope << -bits, 0)
            };
            plane.steps[axis] = step;
            plane.origin = plane
                .origin
                .wrapping_add_signed((step >> 4) * slopes.to_center[axis])
                .wrapping_sub((slopes.pixel[axis].wrapping_mul(step)) as u32)
                .wrapping_add_signed(rest);
        }
        plane
    }

    /// An attribute from its I16F16 values at the corners (within ±2²⁹), and q there; `mixed` for
    /// [`resolve_in_sliver`](Self::resolve_in_sliver).
    #[inline(never)]
    fn attribute(
        &self,
        slopes: &Slopes,
        at: [i32; 3],
        scale_log2: u32,
        q: &[u32; 3],
        mixed: bool,
    ) -> Attribute {
        let (mut attribute, rise) = Attribute::between(at, scale_log2);
        if self.straight || mixed {
            let origin = if mixed && !self.straight { 0 } else { attribute.origin() };
            attribute.plane = self.plane(slopes, origin, rise);
            return attribute;
        }
        let products = [wide(rise[0], q[1] as i32), wide(rise[1], q[2] as i32)];
        let largest = products[0].unsigned_abs() | products[1].unsigned_abs();
        // 30 bits of the larger, and not quite 2³⁰.
        let exponent = 34u32.saturating_sub((largest + (largest >> 15)).leading_zeros()).max(1);
        let scaled = products.map(|product| shift_round(product, exponent) as i32);
        attribute.plane = self.plane(slopes, 0, scaled);
        attribute.shift = 32 - exponent as i32;
        attribute
    }
}

/// By how much the edge functions of corners 1 and 2 change a column, and a row, of 1/16 px.
#[inline]
pub(super) fn edges([a, b, c]: &[[i32; 2]; 3]) -> [[i32; 2]; 2] {
    [[c[1] - a[1], a[1] - b[1]], [a[0] - c[0], b[0] - a[0]]]
}

/// Whether a value that rises so from corner 0 to 1 and 2 becomes more (1), less (−1) or nothing else (0) infinitesimally right of
/// any point, and infinitely less below that: as in the top-left rule. Exact.
pub(super) fn direction([right, down]: &[[i32; 2]; 2], rise: [i32; 2]) -> i32 {
    match sign_of_sum(right, rise) {
        0 => sign_of_sum(down, rise),
        sign => sign,
    }
}

#[inline(never)]
fn sign_of_sum([b, c]: &[i32; 2], rise: [i32; 2]) -> i32 {
    (wide(rise[0], *b) + wide(rise[1], *c)).signum() as i32
}

pub(super) fn position(vertex: &ScreenVertex) -> [i32; 2] {
    [vertex.x.to_bits().into(), vertex.y.to_bits().into()]
}
