//! Held triangles: small ones whose attributes are limited to the range of the corners at the ends of each row.
//!
//! - In: a small triangle that is not [plain](super::small), and its gradients.
//! - Out: its planes, what they are bent by, and the ranges; along a row, attributes within these.
//! - Assumes: what [`small`](super::small) has asked of it.

use super::attribute::Attribute;
use super::course::{Course, Fall, Kept, is_little, kept, limits};
use super::gradients::Gradients;
use super::needs::{Needs, SmallTriangle};
use super::plane::Plane;
use super::scaling::Scaling;
use super::straight::{Bend, Straight};
use super::triangle::{STRAIGHT, TriangleSetup};
use crate::num::{mul_16, mul_16_signed};

impl TriangleSetup {
    /// Sets the attributes of a small triangle as linear on the screen, to be held: from the gradients, and q at the corners. False if the
    /// general way has to.
    #[inline(never)]
    pub(super) fn set_held(&mut self, small: &SmallTriangle<'_>) -> bool {
        let &SmallTriangle { vertices, needs, ref gradients, q, .. } = small;
        let (most, least) = (q[0].max(q[1]).max(q[2]), q[0].min(q[1]).min(q[2]));
        let is_level = needs.is_exactly_straight(least, most);
        if let Straight::Below(limit) = needs.straight
            && !is_level
            && !Bend::new(&gradients.edges, q).is_some_and(|bend| bend.is_straight(limit.get()))
        {
            return false;
        }
        if needs.scale != 0 && !needs.are_narrow(vertices) {
            return false;
        }
        self.set_corners(vertices);
        (self.is_held, self.longest) = (true, STRAIGHT);
        needs.set_gray(self, vertices);
        self.bends = [[0; 3]; 2];
        let (scaling, attributes) = (needs.scaled_at_once(), &mut self.attributes);
        let are_set = needs.each_attribute(&scaling, vertices, self.gray, |i, at, _| {
            let Some(attribute) = attributes.get_mut(i) else {
                return false;
            };
            let rise = attribute.set_range(at, 0);
            if attribute.range >= 1 << 27 {
                return false;
            }
            let origin = attribute.origin();
            gradients.set_plane(&mut attribute.plane, origin, &rise.map(|rise| rise >> 8));
            true
        });
        if are_set && let Some(uv) = &needs.code.uv {
            (uv.complete_held)(self, small, &scaling, is_level);
        }
        are_set
    }

    /// Completes u and v: [`UvCode::complete_held`](super::needs::UvCode).
    #[inline(never)]
    pub(super) fn complete_held_uv(&mut self, small: &SmallTriangle<'_>, scaling: &Scaling, is_exact: bool) {
        if is_exact {
            self.lean(small.vertices, scaling, 2, i32::MAX);
        } else {
            self.keep_small_inside(small.needs);
        }
    }

    /// Lets u and v, whose planes are set as linear, follow perspective: bends both and holds them, unless they are straight enough, or
    /// if they are lifted. False if a quadratic is not exact enough, or if one differs by 2²⁶ or more: V takes up to a quarter of that
    /// besides.
    #[inline(never)]
    pub(super) fn bend(&mut self, small: &SmallTriangle<'_>) -> bool {
        let [q0, q1, q2] = small.q;
        let (least, most) = (q0.min(q1).min(q2), q0.max(q1).max(q2));
        let [u, v, ..] = &self.attributes;
        let limits = limits(small.needs.packing.is_large());
        let are_little = [(u, limits[0]), (v, limits[1])]
            .map(|(of, limits)| is_little(of.range, most - least, least, limits));
        are_little == [true; 2]
            || Fall::new(most - least, least).is_some_and(|fall| {
                self.lift(small, &fall, are_little).is_some() || self.bend_both(small, &fall)
            })
    }

    /// Lifts u and v as far as they need it, unless one is to be bent: then `None`. Some are straight since their errors are little.
    #[inline(never)]
    fn lift(&mut self, small: &SmallTriangle<'_>, fall: &Fall, are_little: [bool; 2]) -> Option<()> {
        let loss = fall.loss(self.z.steps, small.gradients.thinness());
        let [u, v, ..] = &mut self.attributes;
        let kept_u = if are_little[0] { None } else { kept_end(u, 0, small, fall, loss)? };
        let kept_v = if are_little[1] { None } else { kept_end(v, 1, small, fall, loss)? };
        if let Some(kept) = kept_u {
            fall.lift(&mut u.plane, kept);
        }
        if let Some(kept) = kept_v {
            fall.lift(&mut v.plane, kept);
        }
        Some(())
    }

    /// Bends u and v.
    #[inline(never)]
    fn bend_both(&mut self, small: &SmallTriangle<'_>, fall: &Fall) -> bool {
        let &SmallTriangle { vertices, needs, ref gradients, ref q, .. } = small;
        // ∇q/q_mid per column and row, 16 fraction bits.
        let Some(slopes_of_q) = fall.slopes(self.z.steps, gradients.longest()) else {
            return false;
        };
        let rises_of_q = [fall.rise(q[0], q[1]), fall.rise(q[0], q[2])];
        self.set_corners(vertices);
        self.is_bent = true;
        // Over L steps of a row a straight line is off from the quadratic by ¼·L²·|∇u·∇q|/q_mid, with both along the row. In
        // pixels that is at most ¼·L²·|∇q|/q_mid: 3/32 at most.
        let mut longest = i32::from(STRAIGHT);
        while (longest * longest) * slopes_of_q[0].abs() > 3 << 13 {
            longest >>= 1;
        }
        self.longest = longest as u8;
        for i in 0..2 {
            // One after another, so that what they take is not on the stack together.
            let (attribute, quadratic) = (&mut self.attributes[i], &mut self.bends[i]);
            let mut rise = attribute.set_range(vertices.map(|vertex| needs.scaled_uv(vertex, i)), 0);
            if attribute.range >= 1 << 26 {
                return false;
            }
            set_quadratic(quadratic, &attribute.plane.steps, slopes_of_q);
            bend_rise(&mut rise, &rises_of_q);
            let origin = attribute.origin();
            gradients.set_plane(&mut attribute.plane, origin, &rise);
            bend_plane(&mut attribute.plane, quadratic, gradients);
        }
        self.keep_small_inside(needs);
        true
    }

    /// Limits u and v of a small triangle that does not lean: u below its greatest value, v to its inset. Where u repeats within four
    /// pixels planes are evaluated at every pixel.
    #[inline(never)]
    fn keep_small_inside(&mut self, needs: &Needs) {
        if needs.packing.is_steep(self.attributes[0].plane.steps[0]) {
            self.longest = 0;
        }
        let [u, v, ..] = &mut self.attributes;
        u.open_end();
        v.keep_straight_inside(needs.packing.inset.into());
    }

    /// An attribute of a small triangle at a pixel beyond the first one, I16F16, and its step along a row of at most `longest` steps. One
    /// that is held does not leave its range.
    #[inline]
    pub(crate) fn along(&self, i: usize, place: [i32; 2], steps: i32) -> (i32, i32) {
        let Some(attribute) = self.attributes.get(i) else {
            return (0, 0);
        };
        if self.is_held || self.is_bent && i < 2 {
            let bend = self.bends.get(i).unwrap_or(&[0; 3]);
            return along_one(attribute, bend, place, steps);
        }
        (attribute.plane.at(place) as i32, attribute.plane.steps[0])
    }

    /// u and v of a bent triangle, as [`TriangleSetup::along`].
    #[inline(always)]
    pub(crate) fn along_bent(&self, place: [i32; 2], steps: i32) -> [(i32, i32); 2] {
        let [u, v, ..] = &self.attributes;
        [along_held(u, &self.bends[0], place, steps), along_held(v, &self.bends[1], place, steps)]
    }
}

/// The value that u or v keeps, if it is to be lifted: that at an end of its range, as far inside as its margin. `None` if it is to be bent.
#[inline(never)]
fn kept_end(
    attribute: &Attribute,
    i: usize,
    small: &SmallTriangle<'_>,
    fall: &Fall,
    loss: u32,
) -> Option<Option<i32>> {
    let &SmallTriangle { vertices, needs, ref q, .. } = small;
    match fall.course(attribute, loss, limits(needs.packing.is_large())[i & 1]) {
        Course::Straight => return Some(None),
        Course::Lifted => {}
        Course::Bent => return None,
    }
    let margin = i32::from(needs.margins[i]) << 8;
    let kept = match kept(&vertices.map(|vertex| needs.scaled_uv(vertex, i)), q)? {
        Kept::Greatest => attribute.least.wrapping_add_unsigned(attribute.range).wrapping_sub(margin),
        Kept::Least => attribute.least.wrapping_add(margin),
    };
    Some(Some(kept))
}

/// A held attribute m columns right and n rows below the first pixel, I16F16, and its step along a row of at most `longest` steps, in
/// neither of which it leaves the range.
#[inline(always)]
fn along_held(attribute: &Attribute, &[xx, xy, yy]: &[i32; 3], [m, n]: [i32; 2], steps: i32) -> (i32, i32) {
    let Plane { origin, steps: [right, down] } = attribute.plane;
    let right = right.wrapping_add(xy.wrapping_mul(n)).wrapping_add(xx.wrapping_mul(m));
    let down = down.wrapping_add(yy.wrapping_mul(n));
    let value = origin.wrapping_add_signed(right.wrapping_mul(m)).wrapping_add_signed(down.wrapping_mul(n));
    attribute.along((value, right.wrapping_add(xx.wrapping_mul(m + steps))), steps)
}

/// Likewise: for where it is not asked as often.
#[inline(never)]
fn along_one(attribute: &Attribute, bend: &[i32; 3], place: [i32; 2], steps: i32) -> (i32, i32) {
    along_held(attribute, bend, place, steps)
}

/// The coefficients of x², xy and y² in −(∇u·p)(∇q·p)/q_mid, from ∇u and ∇q/q_mid. u's steps are below 2²⁹, a range of 2²⁶ over at
/// least 1/8 px, and q's are at most ¼: 2²⁷, and twice that for xy.
#[inline(never)]
fn set_quadratic(to: &mut [i32; 3], &[right, down]: &[i32; 2], [q_right, q_down]: [i32; 2]) {
    *to = [
        -mul_16_signed(right, q_right),
        -mul_16_signed(right, q_down) - mul_16_signed(down, q_right),
        -mul_16_signed(down, q_down),
    ];
}

/// V, in the place of ∇u: Δuᵢ·(1 + Δqᵢ/q_mid), in units of 2⁸.
#[inline(never)]
fn bend_rise(rise: &mut [i32; 2], rises_of_q: &[i32; 2]) {
    for (rise, &rise_of_q) in rise.iter_mut().zip(rises_of_q) {
        let change = mul_16(*rise, rise_of_q.unsigned_abs());
        *rise = (if rise_of_q < 0 { *rise - change } else { *rise + change }) >> 8;
    }
}

/// Bends the plane of a texture coordinate whose steps are V, from the coefficients of x², xy and y².
#[inline(never)]
fn bend_plane(plane: &mut Plane, &[xx, xy, yy]: &[i32; 3], gradients: &Gradients) {
    let [x, y] = gradients.to_center;
    // The quadratic is evaluated by offsets (m, n) from the centre of the first pixel, while p counts from corner 0:
    // it is (m + x/16, n + y/16). What is linear in m and n of that goes into the steps, and what is constant into
    // the origin. With x at most 8 and y at most 15, and coefficients below 2²⁷, 2²⁸ and 2²⁷, sums are below 2³¹.
    let more = [(xx >> 3) * x + (xy >> 4) * y, (xy >> 4) * x + (yy >> 3) * y];
    plane.origin = plane
        .origin
        .wrapping_add_signed(((xx >> 6) * (x * x) + (xy >> 6) * (x * y) + (yy >> 6) * (y * y)) >> 2);
    for (step, more) in plane.steps.iter_mut().zip(more) {
        *step = step.wrapping_add(more);
    }
}
