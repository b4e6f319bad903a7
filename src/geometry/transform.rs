//! Transform: from mesh space to clip space.
//!
//! - In: the pose of a mesh, the pose and projection of the camera; then positions.
//! - Out: clip coordinates: right, down and before the eye, in units that suit this mesh.
//! - Assumes: nothing; a matrix of any numbers fits its unit.
//!
//! One matrix a mesh does it all: the pose, the inverse of the camera's, the focal length.
//! Its elements share one exponent (block floating point), and so do all clip coordinates of the
//! mesh: a small object has the fine unit that its nearness needs, a wide one the coarse
//! unit that its size needs. The unit cancels in x/w, and nothing can overflow.
//!
//! A mesh may reach 16 000 units far and still be cut at a near plane 1/256 of a unit before the eye: no 32 bits hold both. What
//! is so near that 32 bits are too few for it is cut off by [`clip`](super::clip), and clipping has 14 bits more: [`FINE`].

use super::split::Split;
use crate::math::{Pose, dot};
use crate::num::{
    I4F12, I16F16, U10F22, leading_zeros, mul_long, shift_round, wide, wide_unsigned, zeros_of,
};
use crate::scene::{Bounds, Projection, Viewport};
use core::array;

/// The exponent k with focal length = 2^(k−1) … 2^k pixels, −3 … 13.
pub(crate) const fn focal_log2(focal: I16F16) -> i32 {
    16 - zeros_of(focal.to_bits() as u32) as i32
}

/// The most fraction bits of clip coordinates. The near plane may be one last bit of the world, 2⁻¹⁶, away, where w is not to
/// be rounded to a thousandth.
const FINEST: i32 = 34;
/// The most without perspective, where 2^this is a number in clip space.
const FINEST_FLAT: i32 = 28;

/// How many bits more there are in clipping: of clip coordinates 46 in all, in an `i64`.
pub(super) const FINE: i32 = 14;

/// From mesh space to clip space.
pub(crate) struct ToClip {
    /// For x, y and w.
    rows: [Row; 3],
    /// What rounding took from the elements and the translation of each row, in units of 2^−[`FINE`] of theirs, within ±2¹⁴; 0
    /// where clipping needs no more bits.
    rests: [[i16; 4]; 3],
}

/// From a position in the mesh to one clip coordinate.
///
/// The clip units to a step of each position, within ±2¹³, in two halves, so that three products of either with 16 bits
/// fit an `i32`.
#[derive(Clone, Copy)]
struct Row {
    /// In the upper half rounded, in the lower what that leaves, 15 fraction bits, within ±2¹⁴: one load for both. In a row that is
    /// [narrow](ToClip::narrow) one number.
    elements: [i32; 3],
    /// In clip units, within ±2²⁹. In a narrow row with as many fraction bits as its elements.
    translation: i32,
}

/// What all rows of a mesh are rounded to.
struct Unit {
    /// How many bits more than 30 the elements have.
    excess: i32,
    /// How many of the 30 bits more than 15 fraction bits, less one.
    shift: i32,
    /// The focal length's mantissa, by which the rows for x and y are multiplied.
    focal: i32,
    /// Whether clipping needs more bits.
    is_fine: bool,
    /// Fraction bits of clip coordinates.
    bits: i32,
}

impl Unit {
    /// An element, times the focal length's mantissa if that is not 0. Out of line on Armv6-M: there is one copy for all elements.
    #[cfg_attr(all(target_arch = "arm", not(target_has_atomic = "32")), inline(never))]
    #[cfg_attr(not(all(target_arch = "arm", not(target_has_atomic = "32"))), inline)]
    fn rounded(&self, exact: &Split, focal: i32) -> i32 {
        // 30 bits; then 15 fraction bits.
        halves(((shortened(exact.value(), self.excess, focal) >> self.shift) + 1) >> 1)
    }
}

impl Row {
    #[inline(always)]
    fn place(&self, position: [i32; 3]) -> i32 {
        let (mut whole, mut rest) = (self.translation, 0);
        for (at, halves) in position.into_iter().zip(self.elements) {
            whole += at * (halves >> 16);
            rest += at * i32::from(halves as i16);
        }
        whole + (rest >> 15)
    }

    /// The same, out of line on Armv6-M: there is one copy for all rows.
    #[cfg_attr(all(target_arch = "arm", not(target_has_atomic = "32")), inline(never))]
    #[cfg_attr(not(all(target_arch = "arm", not(target_has_atomic = "32"))), inline)]
    fn place_apart(&self, position: &[I4F12; 3]) -> i32 {
        self.place(position.map(|at| i32::from(at.to_bits())))
    }

    /// The same with [`FINE`] bits more.
    #[inline(never)]
    fn place_fine(&self, position: [i32; 3], rests: &[i16; 4]) -> i64 {
        let (mut whole, mut rest, mut finer) = (self.translation, 0, 0);
        for ((at, halves), more) in position.into_iter().zip(self.elements).zip(rests) {
            whole += at * (halves >> 16);
            rest += at * i32::from(halves as i16);
            finer += at * i32::from(*more);
        }
        let rest = ((i64::from(rest) << FINE) + i64::from(finer)) >> 15;
        (i64::from(whole) << FINE) + i64::from(rests[3]) + rest
    }
}

/// Sets what rounding took from the elements and the translation of a row: of elements with 50 fraction bits, a translation with 30,
/// and the focal length's mantissa, or 0 where it is no part of the row.
///
/// An element was rounded three times, to ½ + ½ of its 30 bits and to ½ of what is left of these, at most a quarter: what that
/// leaves is within ¾ of 2^[`FINE`], and three of it times 2¹⁵ steps are below 2³¹.
#[cold]
#[inline(never)]
fn set_rests(rests: &mut [i16; 4], row: &Row, exact: &[Split; 4], focal: i32, unit_bits: i32) {
    // Elements are steps of 2⁻¹² with 15 fraction bits.
    for ((to, halves), value) in rests.iter_mut().zip(row.elements).zip(exact) {
        *to = rest(value.value(), 33 - unit_bits, focal, element(halves));
    }
    rests[3] = rest(exact[3].value(), 16 - unit_bits, focal, row.translation);
}

#[inline(never)]
fn rest(value: i64, shift: i32, focal: i32, rounded: i32) -> i16 {
    // Below 2⁴⁵.
    let value = if shift < 0 { value << -shift } else { value >> shift };
    let value = if focal != 0 { mul_long(value, focal) >> 1 } else { value };
    (value - (i64::from(rounded) << FINE)) as i16
}

/// From which distance w on, in clip units, 32 bits place a vertex well enough: `i32::MAX` if they never do.
///
/// A clip coordinate is off by less than 3 units: 1.5 by elements (each rounded to 2⁻¹⁶ of a unit, and times up to 2¹⁵ steps),
/// ½ by the translation, 1 by what is cut off the sum. On the screen, c px from the line of sight, that is at most
/// 3·(2^k + c)/w px for a focal length of up to 2^k: within 1/128 px where w ≥ 384·(2^k + c), c being that of the viewport's sides.
/// (What lies farther out is off by more, and as much less its edges are where they come into view.) Without perspective 1 takes
/// the place of w, and nothing is added for c.
#[inline(never)]
pub(super) fn least_w(projection: &Projection, unit_bits: i32) -> i32 {
    let focal_log2 = focal_log2(projection.focal);
    if !projection.orthographic {
        let Viewport { left, top, width, height } = projection.viewport;
        let [x, y] = projection.center;
        let reach = |center: i32, start: i16, length: i16| {
            let half = i32::from(length) * 8;
            (center - i32::from(start) * 16 - half).abs() + half
        };
        let reach = reach(x, left, width).max(reach(y, top, height)) >> 4;
        ((1 << focal_log2.max(0)) + reach) * 384
    } else if unit_bits < focal_log2 + 9 {
        i32::MAX
    } else {
        0
    }
}

impl ToClip {
    /// Of no mesh.
    pub(crate) const ZERO: Self =
        Self { rows: [Row { elements: [0; 3], translation: 0 }; 3], rests: [[0; 4]; 3] };

    /// With the fraction bits of clip coordinates.
    pub(crate) fn new(projection: &Projection, camera: &Pose, pose: &Pose) -> (Self, i32) {
        let mut to_clip = Self::ZERO;
        let unit_bits = to_clip.set(projection, camera, pose);
        (to_clip, unit_bits)
    }

    /// Sets one that is [`ZERO`](Self::ZERO), in place, so that nothing is copied. What is done nine times is a function of its own, so
    /// that it is there once. Returns the fraction bits of clip coordinates, 10 … 34.
    #[inline(never)]
    pub(crate) fn set(&mut self, projection: &Projection, camera: &Pose, pose: &Pose) -> i32 {
        let mut exact = Exact { rows: [[Split::ZERO; 4]; 3], all: [Split::ZERO; 2] };
        for row in 0..3 {
            exact.set_row(row, camera, pose);
        }
        let [of_matrix, of_translation] = exact.all.map(|all| 64 - leading_zeros(all.value() as u64) as i32);
        let excess = of_matrix - 30;
        let fraction_bits = 50 - excess;
        // The finest unit in which neither the translation (2²⁹) nor the sums (3·2²⁸) are too large.
        let unit_bits = (59 - of_translation).min(fraction_bits - 5).min(FINEST);
        // Without perspective depth reaches from plane to plane: the far one has to be among the clip coordinates.
        let far_bits = if projection.orthographic {
            // And 1 is what divides.
            (15 + zeros_of(projection.far.to_bits() as u32) as i32).min(FINEST_FLAT)
        } else {
            FINEST
        };
        let unit_bits = unit_bits.min(far_bits);
        let focal = projection.focal.to_bits();
        let focal = focal << (zeros_of(focal as u32) - 1); // 2³⁰ … 2³¹ − 1
        // At least 1.
        let shift = (fraction_bits - 4 - unit_bits).min(31);
        let least = least_w(projection, unit_bits);
        // The near plane may be nearer than that, in 1/65536.
        let is_near = i64::from(projection.near.to_bits()) < (i64::from(least) << 16) >> unit_bits;
        let is_fine = least == i32::MAX || is_near;
        let unit = Unit { excess, shift, focal, is_fine, bits: unit_bits };
        for row in 0..3 {
            self.set_row(row, &exact, &unit);
        }
        unit_bits
    }

    /// Sets the row for x, y or w.
    #[inline(never)]
    fn set_row(&mut self, axis: usize, exact: &Exact, unit: &Unit) {
        let (row, exact) = (&mut self.rows[axis], &exact.rows[axis]);
        let [.., translation] = *exact;
        let focal = if axis < 2 { unit.focal } else { 0 };
        for (to, element) in row.elements.iter_mut().zip(exact) {
            *to = unit.rounded(element, focal);
        }
        row.translation = shortened(translation.value(), 30 - unit.bits, focal);
        if unit.is_fine {
            set_rests(&mut self.rests[axis], row, exact, focal, unit.bits);
        }
    }

    /// Whether a sphere of the mesh, whose centre lies `outside` of a plane, reaches over it, give or take four clip units for
    /// rounding. Outside is what a coordinate · 2^`log2` − w · `slope` says, in either direction. A `log2` of 0 … 17, a slope
    /// within ±2¹⁶.
    ///
    /// Whatever becomes of the sphere, it reaches as far as its radius times the gradient of what measures that distance. This
    /// is the gradient of the elements themselves: so it is right for every matrix, one that stretches, shears or mirrors, too.
    #[inline(never)]
    pub(crate) fn reaches(&self, outside: i64, radius: u32, (axis, log2, slope): (usize, i32, i32)) -> bool {
        if outside <= 0 {
            return true;
        }
        // The elements' upper halves: below 2¹³ · 2¹⁷ + 2¹⁶ · 2¹³.
        let ([.., w], Some(across)) = (&self.rows, self.rows.get(axis)) else {
            return true;
        };
        let gradient: [u32; 3] = core::array::from_fn(|i| {
            (((across.elements[i] >> 16) << log2) - (w.elements[i] >> 16) * slope).unsigned_abs()
        });
        // Each half is within ½ of its element, all three within √¾.
        let unit = (1 << log2) + slope.unsigned_abs();
        let outside = outside - wide((radius + 4) as i32, unit as i32);
        // All over a power of two so that 14 bits of the gradient are left, and then outside ≤ radius · gradient, squared.
        let all = gradient.iter().fold(0, |all, side| all | side);
        let shift = 18_u32.saturating_sub(zeros_of(all));
        let squares: u32 = gradient.iter().map(|side| (side >> shift) + 1).map(|side| side * side).sum();
        let Ok(outside) = u32::try_from((outside >> shift).max(0)) else {
            return false; // Below 2¹⁶ · 2¹⁵ it would have to be.
        };
        wide_unsigned(outside, outside) <= wide_unsigned(radius * radius, squares)
    }

    /// How far a sphere with this radius reaches along an axis, x, y or w, in clip units, and a little farther: whatever its
    /// coordinates are rounded by.
    #[inline(never)]
    pub(super) fn reach(&self, axis: usize, radius: u32) -> i32 {
        let elements = self.rows[axis].elements.map(|halves| element(halves).unsigned_abs());
        // 14 bits of the largest; at most 15 of 29 go.
        let shift = 18_u32.saturating_sub(zeros_of(elements[0] | elements[1] | elements[2]));
        let squares = elements.map(|element| (element >> shift) + 1).map(|element| element * element);
        let length = root_or_more(squares[0] + squares[1] + squares[2]);
        // 17 bits by 15, and at most 2³⁰ in clip units.
        ((radius * length) >> (15 - shift)) as i32 + radius as i32 + 8
    }

    /// Makes a row narrow: with `bits` fraction bits (0 … 15), exact at the bounds' centre. From then on it is one for
    /// [`place_narrow`](Self::place_narrow) alone.
    #[inline(never)]
    pub(super) fn narrow(&mut self, axis: usize, bits: u32, bounds: &Bounds) {
        let dropped = 15 - bits;
        let half = (1 << dropped) >> 1;
        let row = &mut self.rows[axis];
        let mut rest = half;
        for (to, at) in row.elements.iter_mut().zip(bounds.center) {
            let element = element(*to);
            *to = (element + half) >> dropped;
            // Within ±2¹⁴ · 2¹⁵.
            rest += (element - (*to << dropped)) * i32::from(at.to_bits());
        }
        row.translation = (row.translation << bits).wrapping_add(rest >> dropped);
    }

    /// Along one axis by a row that is narrow: 3 products. The sum fits, but may wrap around in between.
    #[inline(always)]
    pub(super) fn place_narrow(&self, position: [i32; 3], axis: usize) -> i32 {
        let Row { elements, translation } = self.rows[axis];
        (0..3).fold(translation, |sum, i| sum.wrapping_add(elements[i].wrapping_mul(position[i])))
    }

    /// Places one vertex along one axis, x, y or w: 6 short multiplications.
    #[inline(always)]
    pub(crate) fn place(&self, position: [i32; 3], axis: usize) -> i32 {
        self.rows[axis].place(position)
    }

    /// Along one axis, with [`FINE`] bits more: within ±2⁴⁵.
    ///
    /// Where they are needed (else these are the 32 bits alone, and as good as these have to be) each is off by less than 9 units:
    /// 2 by each element (½ by its rounding and 1½ by that of its product with the focal length, at 2¹⁵ steps), 2 by the
    /// translation, and 1 by what is cut off the sum.
    pub(super) fn place_fine(&self, position: [I4F12; 3], axis: usize) -> i64 {
        let position = position.map(|at| i32::from(at.to_bits()));
        self.rows[axis].place_fine(position, &self.rests[axis])
    }

    /// Along all.
    #[inline(never)]
    pub(crate) fn place_all(&self, position: [I4F12; 3]) -> [i32; 3] {
        self.rows.each_ref().map(|row| row.place_apart(&position))
    }
}

/// An element of a [`Row`], from one of 15 fraction bits.
fn halves(element: i32) -> i32 {
    let whole = (element + (1 << 14)) >> 15;
    whole << 16 | i32::from((element - (whole << 15)) as u16)
}

/// The opposite of [`halves`].
fn element(halves: i32) -> i32 {
    ((halves >> 16) << 15) + i32::from(halves as i16)
}

/// The square root of up to 30 bits, or up to 1 % more from 2²⁶ on. (Below that it is any number up to 8300.)
///
/// The root curves downwards, so that it is below all its tangents: at t² the tangent is t/2 + square/2t. These are at the squares of 1.15,
/// 1.45 and 1.8 times 2¹⁴.
fn root_or_more(square: u32) -> u32 {
    let halved = u32::from(square < 1 << 28);
    // 14 fraction bits, of 1 … 4.
    let square = square << (2 * halved) >> 14;
    let tangents = [(9421, 28494), (11879, 22599), (14746, 18205)];
    let least =
        tangents.iter().fold(u32::MAX, |least, (half, slope)| least.min(half + ((square * slope) >> 16)));
    // What was cut off, and half a step.
    (least + 2 + halved) >> halved
}

/// The matrix before it is rounded, without the focal length.
struct Exact {
    /// Elements: 28 fraction bits (4.0 at most) times 22 are 50. Translation: 14 times 16 are 30.
    rows: [[Split; 4]; 3],
    /// The bits that are in any element, and in any translation.
    all: [Split; 2],
}

impl Exact {
    /// Sets the row for x, y or w. The camera's axes are the columns of its rotation, and what it sees is turned by the rows; in
    /// clip space y is down and w along −z.
    #[inline(never)]
    fn set_row(&mut self, row: usize, camera: &Pose, pose: &Pose) {
        let sign = if row == 0 { 1 } else { -1 };
        let axis = camera.rotation.map(|r| i32::from(r[row].to_bits()) * sign);
        let [to, from] = [pose, camera].map(|pose| dot(axis, pose.translation.bits()));
        let (exact, all) = (&mut self.rows[row], &mut self.all);
        exact[3].set(to - from, &mut all[1]);
        for (column, to) in exact.iter_mut().enumerate().take(3) {
            to.set(scaled_axis(axis, pose, column), &mut all[0]);
        }
    }
}

/// How far an axis of a pose reaches along another axis, times its scale.
#[inline(never)]
fn scaled_axis(axis: [i32; 3], pose: &Pose, column: usize) -> i64 {
    // Products are within ±2³⁰.
    let products: [i32; 3] = array::from_fn(|i| axis[i] * i32::from(pose.rotation[i][column].to_bits()));
    let sum = products.into_iter().fold(0_i32, i32::saturating_add);
    scaled(sum.clamp(-1 << 30, 1 << 30), pose.scale[column])
}

fn scaled(value: i32, scale: U10F22) -> i64 {
    // One of 32 bits without sign: its last one goes apart.
    let scale = scale.to_bits();
    (wide(value, (scale >> 1) as i32) << 1) + i64::from(if scale & 1 == 0 { 0 } else { value })
}

/// A number without its last `dropped` bits, or with so many more, times the focal length's mantissa, if that is not 0.
#[inline(never)]
fn shortened(value: i64, dropped: i32, focal: i32) -> i32 {
    let value =
        if dropped >= 0 { shift_round(value, dropped.min(63) as u32) } else { value << -dropped.max(-63) };
    // As `mul_round`, but with the one copy of the product: that has its own wherever it is.
    if focal != 0 { ((wide(value as i32, focal) + (1 << 30)) >> 31) as i32 } else { value as i32 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn roots_are_never_too_small_nor_more_than_a_hundredth_too_large() {
        for square in (1..1 << 30).step_by(997).chain([1 << 26, (1 << 28) - 1, 1 << 28, (1 << 30) - 1]) {
            let (exact, root) = (f64::from(square).sqrt(), f64::from(root_or_more(square)));
            assert!(
                root >= exact && (root <= exact * 1.0101 || square < 1 << 26 && root < 8300.0),
                "{root} of {exact}²"
            );
        }
    }
}
