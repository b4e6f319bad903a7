//! Lean: texture coordinates that take the right one of two texels, and keep to the range of the corners.
//!
//! - In: a triangle whose planes are set, and its texture coordinates at the corners.
//! - Out: the planes of u and v, moved by at most their error; the range to which u and v are limited.
//! - Assumes: errors of planes as `lean_large` says, and of packed runs as [`packing`](super::packing) does.
//!
//! A texture coordinate that is a whole number at a pixel's centre lies between two texels. It is to show the one to which it
//! changes right of the centre, or below if it does not change to the right, as the top-left rule covers pixels. But planes
//! are rounded, and runs of packed coordinates too: either might be a little behind, and show the other texel. So where
//! attributes are *exactly* straight (q is constant, or does not count) the plane is moved ahead in that direction, by as
//! much as it may be behind: it *leans*. With perspective a coordinate is hardly ever whole at a pixel's centre: other
//! triangles do not lean.
//!
//! All triangles keep u and v in [min, max) of their corners: the range ends 2⁻¹⁶ below the greatest value. And v, which
//! carries of u move where both are packed, keeps as far from both ends as these can take it.

use super::scaling::Scaling;
use super::triangle::{TriangleSetup, edges};
use crate::geometry::ScreenVertex;
use crate::num::wide;

impl TriangleSetup {
    /// [`UvCode::complete`](super::needs::UvCode): makes u and v of a triangle that is not small lean, or limits them.
    /// `fraction_bits` are those of the slopes in [`slopes`](super::slopes), if u and v are exactly straight.
    ///
    /// Where they are not, u may repeat within four pixels somewhere: so twice the inset.
    #[inline(never)]
    pub(super) fn settle(
        &mut self,
        vertices: &[&ScreenVertex; 3],
        scaling: &Scaling,
        fraction_bits: Option<i32>,
    ) {
        if let Some(fraction_bits) = fraction_bits {
            return self.lean_large(vertices, scaling, fraction_bits);
        }
        let [u, v, ..] = &mut self.attributes;
        u.open_end();
        v.keep_inside(2 * u32::from(scaling.packing(1).inset), self.straight);
    }

    /// As [`TriangleSetup::lean`], of one that is not small: finds the bound of the plane's error. `bits` are the fraction
    /// bits of the slopes from which steps were rounded.
    ///
    /// A plane is off by at most 20 units at corner 0. To that each column and row adds half a unit for the rounding of the
    /// step, counted from the middle of what is on the screen, and 1.5 units of the slope, 1.5 · 2^−`bits`, counted from
    /// corner 0.
    #[cold]
    fn lean_large(&mut self, vertices: &[&ScreenVertex; 3], scaling: &Scaling, bits: i32) {
        let [width, height] = [0, 1].map(|axis| self.extent(axis)).map(|[first, last]| last - first + 1);
        if self.planes.is_sliver() {
            // Evaluated by weights where a run begins: off by 4 units at most (24 are allowed). Then half a unit per column.
            self.lean(vertices, scaling, 0, 24 + (width >> 1));
        } else if bits < 3 {
            // Slopes of so few fraction bits have triangles within 1024 px of corner 0, or else they would be slivers. So the
            // error at the corners, which `lean` finds, is a good bound, and none within the screen is needed. A step may be
            // off by a unit of the slope or more, which is 2^−`bits` units of the step: `slack` is 5/4 of that, at least 1.
            self.lean(vertices, scaling, if bits < 0 { (5 << (-bits & 31)) >> 2 } else { 1 }, i32::MAX);
        } else {
            let all = (0..2).fold(2, |all, axis| {
                let [a, b, c] = self.corners.map(|corner| i32::from(corner[axis] >> 4));
                all + a.max(b).max(c) - a.min(b).min(c)
            });
            self.lean(vertices, scaling, 0, 21 + ((width + height) >> 2) + ((3 * all) >> (bits + 1)));
        }
    }

    /// Makes exactly straight texture coordinates lean: moves their planes in the [`direction`] that decides between two
    /// texels, by as much as a run that is drawn from them may be behind. That is the sum of:
    ///
    /// - The plane's error. It is linear as well, so inside the triangle it is nowhere larger than at the worst corner, where
    ///   it can be computed. `most` is another bound of it, within the screen; the smaller one counts. A sliver has only
    ///   `most`.
    /// - Packed coordinates: what rounding takes at the run's first pixel, and what cutting takes from the step, at every
    ///   pixel.
    /// - Carries of u into v. They may put v ahead as well. So where an end of v's range is as close to a texel border as
    ///   that, the range ends this side of it. The texels it shows are the same.
    ///
    /// Steps that are within `slack` units of a sprite's are [taken for those](super::plane::Plane::snap), if that makes no
    /// larger error.
    #[cold]
    #[inline(never)]
    pub(super) fn lean(&mut self, vertices: &[&ScreenVertex; 3], scaling: &Scaling, slack: u32, most: i32) {
        self.leans = true;
        let [u, v] = [0, 1].map(|i| scaling.uv(vertices, i));
        let carries = self.lean_by(0, &u, scaling, [slack, 0], most);
        self.lean_by(1, &v, scaling, [slack, carries], most);
    }

    /// Makes attribute `i`, 0 for u or 1 for v, lean. `at` are its values at the corners, I16F16, and `carries` the units by
    /// which carries may move it. Returns how many units its own carries may come to.
    #[inline(never)]
    fn lean_by(
        &mut self,
        i: usize,
        at: &[i32; 3],
        scaling: &Scaling,
        [slack, carries]: [u32; 2],
        most: i32,
    ) -> u32 {
        let first = self.first_pixel();
        let direction =
            direction(&edges(&self.corners()), [at[1].wrapping_sub(at[0]), at[2].wrapping_sub(at[0])]);
        let attribute = &mut self.attributes[i];
        if direction == 0 {
            // Constant. v is put in the middle of its texel if carries can move it.
            if i > 0 {
                attribute.keep_inside(scaling.packing(1).inset.into(), true);
            }
            return 0;
        }
        let mut plane = attribute.plane;
        let mut behind = most;
        if !self.planes.is_sliver() {
            let mut snapped = plane;
            snapped.snap(slack, self.planes.is_small());
            let [mut errors, by_snapped] =
                [plane, snapped].map(|plane| plane.errors(&self.corners, first, at, attribute.least));
            // Whichever has errors closer together.
            if by_snapped[1] - by_snapped[0] <= errors[1] - errors[0] {
                (plane, errors) = (snapped, by_snapped);
            }
            behind = behind.min(1 + (if direction > 0 { -errors[0] } else { errors[1] } >> 4));
        }
        let packing = scaling.packing(i);
        let step = self.step(&plane).unsigned_abs();
        let [first, last] = self.extent(0);
        let unit = packing.unit();
        // With a large texture (15 steps) triangles that are not small are drawn in blocks of 8 pixels.
        let longest =
            if packing.steps == 15 && !self.planes.is_small() { 7 } else { u32::from(packing.steps) };
        let steps = longest.min((last - first) as u32);
        let room = (carries * unit) as i32;
        behind += room + (unit + steps * (step & (unit - 1))) as i32;
        plane.origin = plane.origin.wrapping_add_signed(direction * behind);
        // In I16F16, before the rest of the scale makes 1.0 of it.
        let texel = 0x10000 >> scaling.rest(i);
        let attribute = &mut self.attributes[i];
        let mut least = attribute.least;
        let mut greatest = least.wrapping_add_unsigned(attribute.range).wrapping_sub(1);
        if least & (texel - 1) < room {
            least = least.wrapping_add(room);
        }
        if greatest & (texel - 1) >= texel - room {
            greatest = greatest.wrapping_sub(room);
        }
        attribute.plane = plane;
        attribute.limit(least, greatest.wrapping_sub(least).max(0) as u32);
        if packing.is_steep(step as i32) {
            self.longest = 0;
        }
        packing.carries(step, steps)
    }
}

/// The sign of the change of a value to the right, or, if it does not change that way, downwards; 0 if it is constant. From
/// the edges, as [`edges`] has them, and the rise from corner 0 to corners 1 and 2; exact.
fn direction([right, down]: &[[i32; 2]; 2], rise: [i32; 2]) -> i32 {
    match sign_of_sum(right, rise) {
        0 => sign_of_sum(down, rise),
        sign => sign,
    }
}

/// The sign of a gradient's component: of the rises times the gradients of the weights of corners 1 and 2.
#[inline(never)]
fn sign_of_sum([b, c]: &[i32; 2], rise: [i32; 2]) -> i32 {
    (wide(rise[0], *b) + wide(rise[1], *c)).signum() as i32
}
