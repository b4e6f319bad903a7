//! One attribute over a triangle: its plane, and how a value of the plane becomes u again.
//!
//! - In: the plane's value at a pixel, and 1/q or none.
//! - Out: u in I16F16, never outside the range of the corners.
//! - Assumes: the pixel lies in the triangle.

use super::plane::Plane;
use crate::math::recip::Reciprocal;
use crate::num::{mul_17, mul_high_signed, wide};
use core::hint::black_box;

/// (u − u₀)·q, and the way back to u.
///
/// The fields are in the order in which Armv6-M reaches those of u and of v with one register.
#[derive(Clone, Copy, Debug, Default, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
pub(crate) struct Attribute {
    /// (u − u₀)·q in units of 2^(32 − `shift`) · (I16F16 · unit of q); of a sliver in `Exact` u − u₀ in I16F16, and of a straight
    /// triangle u − `least`.
    pub(crate) plane: Plane,
    /// What u may be, I16F16: the least, how much more than u₀ that is, and how much more than the least there may be. It is the
    /// range at the corners, or of a texture coordinate a little less.
    pub(crate) least: i32,
    pub(crate) low: i32,
    pub(crate) range: u32,
    /// Of a bent triangle that is not small: how much more than the least u would be along a row where q is infinite, in 2^k of I16F16.
    horizon: i32,
    /// 1 … 31.
    pub(super) shift: u16,
    /// In the lower half [`Attribute::scale_log2`], in the upper one k.
    scales: u16,
}

const _: () = assert!(size_of::<Attribute>() == 32);

/// A pixel of a triangle that is no sliver, and 1/q there.
#[derive(Clone, Copy)]
pub(crate) struct Place {
    pub(crate) x: i32,
    pub(crate) y: i32,
    /// 1/q, as [`looked_up`](crate::math::recip::looked_up) has it of q's mantissa, and the leading zeros of q.
    pub(crate) reciprocal: i32,
    pub(crate) zeros: u32,
}

impl Attribute {
    /// What pixels of a plain triangle take of a texture coordinate: its plane, and the first and the last texel.
    #[inline(always)]
    pub(super) fn plain(&self) -> [u32; 4] {
        let [a, b, c] = bytemuck::must_cast(self.plane);
        let last = self.least.wrapping_add_unsigned(self.range);
        [a, b, c, (self.least as u32) >> 16 | (last >> 16 << 16) as u32]
    }

    /// Becomes that. Its range goes from the start of the first texel to that of the last.
    #[inline(always)]
    pub(super) fn set_plain(&mut self, &[a, b, c, texels]: &[u32; 4]) {
        self.plane = bytemuck::must_cast([a, b, c]);
        let (first, last) = (texels << 16, texels >> 16 << 16);
        self.least = first as i32;
        self.range = last.wrapping_sub(first);
        self.set_scale_log2(0);
    }

    /// What a straight triangle's plane begins with at corner 0.
    #[inline]
    pub(crate) fn origin(&self) -> u32 {
        0u32.wrapping_sub(self.low as u32)
    }

    /// Sets the range from I16F16 values at the corners; all but that stays. Returns by how much it rises from corner 0 to 1 and 2.
    #[inline]
    pub(crate) fn set_range(&mut self, at: [i32; 3], scale_log2: u32) -> [i32; 2] {
        let rise = [at[1].wrapping_sub(at[0]), at[2].wrapping_sub(at[0])];
        let (low, high) = (rise[0].min(rise[1]).min(0), rise[0].max(rise[1]).max(0));
        self.least = at[0].wrapping_add(low);
        self.low = low;
        self.range = high.wrapping_sub(low) as u32;
        self.set_scale_log2(scale_log2);
        rise
    }

    /// Moves the values at the corners towards the middle of their range, each by 2^−`shift` of its way there. Takes and returns
    /// by how much they rise from corner 0 to 1 and 2.
    #[inline]
    pub(super) fn draw_in(&mut self, rise: [i32; 2], shift: u32) -> [i32; 2] {
        let (half, range) = ((self.range >> 1) as i32, self.range as i32);
        // From corner 0, as rises are.
        let middle = self.low + half;
        let first = middle >> shift;
        let (up, down) = (half >> shift, (half - range) >> shift);
        self.least = self.least.wrapping_add(up);
        self.low += up - first;
        self.range = (range + down - up) as u32;
        rise.map(|rise| rise + ((middle - rise) >> shift) - first)
    }

    /// Makes the range of a texture coordinate end below its greatest value. One that is the same at all corners stays what it is.
    #[inline]
    pub(crate) fn open_end(&mut self) {
        self.range = self.range.saturating_sub(1);
    }

    /// Makes the range of a straight triangle's texture coordinate end an `inset` inside on both sides.
    #[inline]
    pub(crate) fn keep_straight_inside(&mut self, inset: u32) {
        let range = self.range;
        if range < 2 * inset {
            self.plane = Plane::default();
            return self.keep_amid(inset);
        }
        self.range = range - 2 * inset;
        self.least = self.least.wrapping_add_unsigned(inset);
        self.plane.origin = self.plane.origin.wrapping_sub(inset);
    }

    /// Likewise, of any triangle.
    #[inline(never)]
    pub(crate) fn keep_inside(&mut self, inset: u32, is_straight: bool) {
        let (low, origin, has_room) = (self.low, self.plane.origin, self.range >= 2 * inset);
        self.keep_straight_inside(inset);
        if has_room {
            self.low = low.wrapping_add_unsigned(inset);
            if !is_straight {
                self.plane.origin = origin;
            }
        }
    }

    /// Where there is no room for an inset in a range, a texture coordinate is its middle, all over.
    #[cold]
    #[inline(never)]
    pub(super) fn keep_amid(&mut self, inset: u32) {
        (self.least, self.low, self.range) = (self.amid(inset), 0, 0);
    }

    /// The middle of the range: one that is the same at all corners stays what it is. If it may be packed, which takes an inset of more
    /// than 2, it is in the middle of its texel.
    fn amid(&self, inset: u32) -> i32 {
        let (texel, middle) =
            (0x10000 >> self.scale_log2(), self.least.wrapping_add_unsigned(self.range >> 1));
        if inset > 2 { (middle & -texel) + texel / 2 } else { middle }
    }

    /// Sets what u may be, of a straight triangle of which all else is set: the least, and how much more.
    #[inline]
    pub(crate) fn limit(&mut self, least: i32, range: u32) {
        let more = least.wrapping_sub(self.least);
        self.least = least;
        self.low = self.low.wrapping_add(more);
        self.range = range;
        self.plane.origin = self.plane.origin.wrapping_add_signed(-more);
    }

    /// How much more than the least it is at a place, in I16F16, without `scale_log2`: never more than the range.
    #[inline]
    pub(crate) fn at(&self, place: &Place) -> i32 {
        self.divided(self.plane.at([place.x, place.y]) as i32, place.reciprocal, place.zeros)
    }

    /// Likewise, from the plane's value.
    #[inline]
    pub(crate) fn divided(&self, value: i32, reciprocal: i32, zeros: u32) -> i32 {
        // Values at corners are within ±(2³⁰ − 2¹⁵), those between too but for rounding: less than 2¹¹ units, see
        // [set-up](super::setup).
        let product = mul_high_signed(value, reciprocal);
        let down = self.shift() - 2 - zeros as i32;
        self.bounded(if down >= 0 { product >> (down & 31) } else { self.scaled_up(product, -down) })
    }

    /// How much more than the least it is, in I16F16, and its step where q stays the same: from the plane's value and step and 1/q in 17
    /// bits, as [`short`](crate::math::recip::short) has it, and the leading zeros of q. Beyond the range, if rounding takes it there.
    #[inline]
    pub(crate) fn above(&self, (value, step): (i32, i32), reciprocal: u32, zeros: u32) -> (u32, i32) {
        let (product, step) = (mul_17(value, reciprocal), mul_17(step, reciprocal));
        let down = self.shift() - zeros as i32;
        let (offset, step) = if down >= 0 {
            (product >> (down & 31), step >> (down & 31))
        } else {
            (self.scaled_up(product, -down), step << (-down & 31))
        };
        (offset.wrapping_sub(self.low) as u32, step)
    }

    /// What comes out is times 2^this, modulo 2³².
    #[inline(always)]
    pub(crate) fn scale_log2(&self) -> u32 {
        u32::from(self.scales) & 31
    }

    #[inline(always)]
    pub(super) fn set_scale_log2(&mut self, log2: u32) {
        self.scales = log2 as u16;
    }

    /// 1 … 31.
    #[inline(always)]
    pub(crate) fn shift(&self) -> i32 {
        self.shift.into()
    }

    /// Sets the horizon, from the normalised step of q along a row, its leading zeros and its reciprocal in 31 bits.
    #[inline]
    pub(super) fn set_horizon(&mut self, rises: bool, zeros: u32, reciprocal: i32) {
        let quotient = (wide(self.plane.steps[0], reciprocal) >> 32) as i32;
        let quotient = if rises { quotient } else { -quotient };
        // By how much the quotient is to be shifted left.
        let up = zeros as i32 + 2 - self.shift();
        let (horizon, log2) = if (1..29).contains(&up) && quotient.unsigned_abs() >> (29 - up) == 0 {
            ((quotient << up).wrapping_sub(self.low), 0)
        } else if up > 0 {
            (quotient.wrapping_sub(self.low >> up.min(31)), up as u16)
        } else {
            ((quotient >> (-up).min(31)).wrapping_sub(self.low), 0)
        };
        self.horizon = horizon;
        self.scales = self.scales & 31 | log2 << 8;
    }

    /// How much more than the least it is at the horizon, in 2^k of I16F16, and k.
    #[inline]
    pub(crate) fn horizon(&self) -> (i32, u32) {
        (self.horizon, (self.scales >> 8).into())
    }

    #[cold]
    #[inline(never)]
    fn scaled_up(&self, product: i32, shift: i32) -> i32 {
        let (shift, high) = (shift.min(31), self.low.wrapping_add_unsigned(self.range));
        // Hidden: the optimizer would compute this where it is not asked for. A row takes 20 cycles more on a Cortex-M0+ then.
        black_box(());
        product.max(self.low >> shift).min(high >> shift) << shift
    }

    /// u − u₀ as how much more than the least u is: never more than the range.
    #[inline]
    pub(crate) fn bounded(&self, offset: i32) -> i32 {
        let mut above = offset.wrapping_sub(self.low) as u32;
        if above > self.range {
            above = if offset < self.low { 0 } else { self.range };
        }
        above as i32
    }

    /// Of a straight triangle: whether its plane's value is within the range, and no more `steps` further.
    #[inline]
    pub(crate) fn leaves(&self, (value, step): (u32, i32), steps: i32) -> bool {
        value <= self.range && value.wrapping_add_signed(step.wrapping_mul(steps)) > self.range
    }

    /// Of a straight line: the attribute in I16F16 and its step along `steps` + 1 pixels, from the plane's, without
    /// `scale_log2`. Never outside the range, even where rounding takes the plane there.
    #[inline]
    pub(crate) fn along(&self, (value, step): (u32, i32), steps: i32) -> (i32, i32) {
        let (first, last) = (value, value.wrapping_add_signed(step.wrapping_mul(steps)));
        if first <= self.range && last <= self.range {
            return (self.least.wrapping_add_unsigned(first), step);
        }
        self.along_border(first as i32, last as i32, steps)
    }

    /// Likewise, an `inset` inside the range.
    #[inline]
    pub(crate) fn along_inside(&self, (value, step): (u32, i32), steps: i32, inset: u32) -> (i32, i32) {
        let (first, last) = (value, value.wrapping_add_signed(step.wrapping_mul(steps)));
        let [first_inside, last_inside] = [first, last].map(|above| above.wrapping_sub(inset));
        let range = self.range as i32 - 2 * inset as i32;
        if range >= 0 && first_inside <= range as u32 && last_inside <= range as u32 {
            return (self.least.wrapping_add_unsigned(first), step);
        }
        self.along_border_inside([first as i32, last as i32], steps, inset)
    }

    #[cold]
    #[inline(never)]
    fn along_border(&self, first: i32, last: i32, steps: i32) -> (i32, i32) {
        held(self.least, self.range, [first, last], steps)
    }

    #[cold]
    #[inline(never)]
    fn along_border_inside(&self, [first, last]: [i32; 2], steps: i32, inset: u32) -> (i32, i32) {
        let (least, range) = if self.range < 2 * inset {
            (self.amid(inset), 0)
        } else {
            (self.least.wrapping_add_unsigned(inset), self.range - 2 * inset)
        };
        let moved = least.wrapping_sub(self.least);
        held(least, range, [first.wrapping_sub(moved), last.wrapping_sub(moved)], steps)
    }
}

/// A straight line that rounding takes out of the range at one end: it is held there.
#[cold]
#[inline(never)]
fn held(least: i32, range: u32, ends: [i32; 2], steps: i32) -> (i32, i32) {
    let [first, last] = ends.map(|above| above.max(0).min(range as i32));
    (least.wrapping_add(first), step_of(last - first, inverse(steps.max(1) as u32)))
}

/// 1/n with 16 fraction bits, rounded down; of 1 a unit less.
static INVERSES: [u16; 32] = {
    let mut inverses = [u16::MAX; 32];
    let mut i = 1;
    while i < 32 {
        inverses[i] = u16::MAX / i as u16;
        i += 1;
    }
    inverses
};

/// 1/`steps` with 31 fraction bits, rounded down, so that `steps` steps never lead beyond their end: 1 … 2⁻¹⁸ of itself too small.
#[inline]
fn inverse(steps: u32) -> i32 {
    let reciprocal = Reciprocal::coarse(steps);
    reciprocal.mantissa_below() >> (31 - reciprocal.zeros)
}

/// 1/`steps` of fewer than 32 with 16 fraction bits, likewise.
#[inline]
pub(crate) fn short_inverse(steps: i32) -> u32 {
    INVERSES[steps as usize & 31].into()
}

/// `rise` in as many steps as [`inverse`] was asked for, cut towards zero.
#[inline]
fn step_of(rise: i32, inverse: i32) -> i32 {
    let size = (wide(rise.wrapping_abs(), inverse) >> 31) as i32;
    if rise < 0 { -size } else { size }
}

/// Of a product rounded down: one more if it is negative.
#[inline]
pub(crate) fn towards_zero(product: i32) -> i32 {
    product - (product >> 31)
}
