//! Lean: texture coordinates that keep to their side of a whole texel, and to the range of the corners.
//!
//! - In: a triangle whose planes are set, and its texture coordinates at the corners.
//! - Out: the planes of u and v moved by what they, and runs drawn from them, may be behind; the range that u and v may have.
//! - Assumes: what each path is off by, as said beside it.

use super::triangle::{Needs, STRAIGHT, TriangleSetup, edges};
use crate::geometry::{Oriented, ScreenVertex};
use crate::num::wide;

impl TriangleSetup {
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

    /// Makes u and v of what is not small lean if they are exactly straight, or stay a little inside their range.
    #[inline(never)]
    pub(super) fn settle(&mut self, triangle: &Oriented<'_>, needs: &Needs, fraction_bits: Option<i32>) {
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
}

/// Whether a value that rises so from corner 0 to 1 and 2 becomes more (1), less (−1) or nothing else (0) infinitesimally right of
/// any point, and infinitely less below that: as in the top-left rule. Exact.
fn direction([right, down]: &[[i32; 2]; 2], rise: [i32; 2]) -> i32 {
    match sign_of_sum(right, rise) {
        0 => sign_of_sum(down, rise),
        sign => sign,
    }
}

#[inline(never)]
fn sign_of_sum([b, c]: &[i32; 2], rise: [i32; 2]) -> i32 {
    (wide(rise[0], *b) + wide(rise[1], *c)).signum() as i32
}
