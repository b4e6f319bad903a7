//! One attribute over a triangle, between [set-up](super::setup) and [shading](super::shade).

use super::setup::Plane;
use crate::math::recip::Reciprocal;
use crate::num::{mul_17, wide};

/// (u − u₀)·q, and the way back to u.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Attribute {
    /// (u − u₀)·q in units of 2^(32 − `shift`) · (I16F16 · unit of q); of a sliver in `Exact` u − u₀ in I16F16, and of a straight
    /// triangle u − `least`.
    pub(super) plane: Plane,
    /// Of a bent triangle: what is to be added x², xy and y² times, x and y being the way from corner 0's pixel.
    pub(super) bend: [i32; 3],
    /// 1 … 31.
    pub(super) shift: i32,
    /// What u may be, I16F16: the least, how much more than u₀ that is, and how much more than the least there may be. It is the
    /// range at the corners, or of a texture coordinate a little less.
    pub(super) least: i32,
    pub(super) low: i32,
    pub(super) range: u32,
    /// What comes out is times 2^this, modulo 2³².
    pub(super) scale_log2: u32,
}

impl Attribute {
    /// What a straight triangle's plane begins with at corner 0.
    #[inline]
    pub(super) fn origin(&self) -> u32 {
        0u32.wrapping_sub(self.low as u32)
    }

    /// Between I16F16 values at the corners, without a plane; and by how much it rises from corner 0 to 1 and 2.
    #[inline]
    pub(super) fn between(at: [i32; 3], scale_log2: u32) -> (Self, [i32; 2]) {
        let mut attribute = Self::default();
        let rise = attribute.set_range(at, scale_log2);
        (attribute, rise)
    }

    /// As [`Attribute::between`], in place: all but the plane and what goes with that stays.
    #[inline]
    pub(super) fn set_range(&mut self, at: [i32; 3], scale_log2: u32) -> [i32; 2] {
        let rise = [at[1] - at[0], at[2] - at[0]];
        let (low, high) = (rise[0].min(rise[1]).min(0), rise[0].max(rise[1]).max(0));
        self.least = at[0] + low;
        self.low = low;
        self.range = high.wrapping_sub(low) as u32;
        self.scale_log2 = scale_log2;
        rise
    }

    /// Makes the range of a texture coordinate end below its greatest value. One that is the same at all corners stays what it is.
    #[inline]
    pub(super) fn open_end(&mut self) {
        self.range = self.range.saturating_sub(1);
    }

    /// Makes the range of a straight triangle's texture coordinate end an `inset` inside on both sides.
    #[inline]
    pub(super) fn keep_straight_inside(&mut self, inset: u32) {
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
    pub(super) fn keep_inside(&mut self, inset: u32, is_straight: bool) {
        let low = self.low;
        let origin = self.plane.origin;
        self.keep_straight_inside(inset);
        self.low = low.wrapping_add_unsigned(inset);
        if !is_straight {
            self.plane.origin = origin;
        }
    }

    /// Where there is no room for an inset in a range, a texture coordinate is its middle, all over: one that is the same at all
    /// corners stays what it is. If it may be packed, which takes an inset of more than 2, it is in the middle of its texel.
    #[cold]
    #[inline(never)]
    fn keep_amid(&mut self, inset: u32) {
        let texel = 0x10000 >> self.scale_log2;
        self.least += (self.range >> 1) as i32;
        if inset > 2 {
            self.least = (self.least & -texel) + texel / 2;
        }
        (self.low, self.range) = (0, 0);
    }

    /// Sets what u may be, from the least to the greatest, of a straight triangle of which all else is set.
    #[inline]
    pub(super) fn limit(&mut self, least: i32, greatest: i32) {
        let more = least.wrapping_sub(self.least);
        self.least = least;
        self.low = self.low.wrapping_add(more);
        self.range = greatest.wrapping_sub(least) as u32;
        self.plane.origin = self.plane.origin.wrapping_add_signed(-more);
    }

    /// The attribute in I16F16 from its plane's value and 1/q; never outside the corners' range.
    #[inline]
    pub(super) fn exact(&self, value: i32, q: Reciprocal) -> i32 {
        let product = ((wide(value, q.mantissa) + (1 << 31)) >> 32) as i32; // below 2³⁰
        let down = self.shift - 2 - q.zeros as i32;
        let offset =
            if down > 0 { ((product >> (down - 1)) + 1) >> 1 } else { self.scaled_up(product, -down) };
        self.finish(offset)
    }

    /// As [`Attribute::exact`], from 1/q in 17 bits, as [`short`](crate::math::recip::short) has it of q's mantissa, and
    /// the leading zeros of q; without `scale_log2`.
    #[inline]
    pub(super) fn divided(&self, value: i32, reciprocal: u32, zeros: u32) -> i32 {
        self.bounded(self.offset(value, reciprocal, zeros))
    }

    #[inline]
    fn offset(&self, value: i32, reciprocal: u32, zeros: u32) -> i32 {
        let product = mul_17(value, reciprocal); // within 2³¹
        let down = self.shift - zeros as i32;
        if down >= 0 { product >> (down & 31) } else { self.scaled_up(product, -down) }
    }

    /// Where q is the same all along: as [`Attribute::along`].
    #[inline]
    pub(super) fn level(&self, value: i32, step: i32, reciprocal: u32, zeros: u32, steps: i32) -> (i32, i32) {
        let product = mul_17(step, reciprocal);
        let down = self.shift - zeros as i32;
        let step = if down >= 0 { product >> (down & 31) } else { product << (-down & 31) };
        self.along((self.offset(value, reciprocal, zeros).wrapping_sub(self.low) as u32, step), steps)
    }

    #[cold]
    #[inline(never)]
    fn scaled_up(&self, product: i32, shift: i32) -> i32 {
        let (shift, high) = (shift.min(31), self.low.wrapping_add_unsigned(self.range));
        product.clamp(self.low >> shift, high >> shift) << shift
    }

    /// The attribute in I16F16 from u − u₀.
    #[inline]
    pub(super) fn finish(&self, offset: i32) -> i32 {
        self.bounded(offset) << self.scale_log2
    }

    #[inline]
    fn bounded(&self, offset: i32) -> i32 {
        let mut above = offset.wrapping_sub(self.low) as u32;
        if above > self.range {
            above = if offset < self.low { 0 } else { self.range };
        }
        self.least.wrapping_add_unsigned(above)
    }

    /// Of a straight triangle: whether its plane's value is within the range, and no more `steps` further.
    #[inline]
    pub(super) fn leaves(&self, (value, step): (u32, i32), steps: i32) -> bool {
        value <= self.range && value.wrapping_add_signed(step.wrapping_mul(steps)) > self.range
    }

    /// Of a straight triangle: the attribute in I16F16 and its step along `steps` + 1 pixels, from the plane's. Never
    /// outside the corners' range, even where rounding takes the plane there.
    #[inline]
    pub(super) fn along(&self, (value, step): (u32, i32), steps: i32) -> (i32, i32) {
        let (first, last) = (value, value.wrapping_add_signed(step.wrapping_mul(steps)));
        if first <= self.range && last <= self.range {
            return (self.least.wrapping_add_unsigned(first) << self.scale_log2, step << self.scale_log2);
        }
        self.along_border(first as i32, last as i32, steps)
    }

    #[cold]
    #[inline(never)]
    fn along_border(&self, first: i32, last: i32, steps: i32) -> (i32, i32) {
        let (at, step) = self.unscaled_border(first, last, steps);
        (at << self.scale_log2, step << self.scale_log2)
    }

    /// As [`Attribute::along`], without `scale_log2`. Calling it from there costs small triangles 2 % on a Cortex-M0+.
    #[inline]
    pub(super) fn unscaled(&self, (value, step): (u32, i32), steps: i32) -> (i32, i32) {
        let (first, last) = (value, value.wrapping_add_signed(step.wrapping_mul(steps)));
        if first <= self.range && last <= self.range {
            return (self.least.wrapping_add_unsigned(first), step);
        }
        self.unscaled_border(first as i32, last as i32, steps)
    }

    #[cold]
    #[inline(never)]
    pub(super) fn unscaled_border(&self, first: i32, last: i32, steps: i32) -> (i32, i32) {
        let [first, last] = [first, last].map(|above| above.clamp(0, self.range as i32));
        (self.least + first, step_of(last - first, inverse(steps.max(1) as usize)))
    }
}

/// 1/n with 31 fraction bits, rounded down.
static INVERSES: [i32; 32] = {
    let mut inverses = [i32::MAX; 32];
    let mut i = 1;
    while i < 32 {
        inverses[i] = i32::MAX / i as i32;
        i += 1;
    }
    inverses
};

/// 1/`steps` with 31 fraction bits, rounded down, so that `steps` steps never lead beyond their end.
#[inline]
fn inverse(steps: usize) -> i32 {
    INVERSES.get(steps).copied().unwrap_or_else(|| {
        let reciprocal = Reciprocal::coarse(steps as u32);
        (reciprocal.mantissa - (reciprocal.mantissa >> 19)) >> (31 - reciprocal.zeros)
    })
}

/// 1/`steps` of fewer than 32 with 16 fraction bits, likewise.
#[inline]
pub(super) fn short_inverse(steps: i32) -> u32 {
    INVERSES[steps as usize & 31] as u32 >> 15
}

/// `rise` in as many steps as [`inverse`] was asked for, cut towards zero.
#[inline]
fn step_of(rise: i32, inverse: i32) -> i32 {
    let size = (wide(rise.wrapping_abs(), inverse) >> 31) as i32;
    if rise < 0 { -size } else { size }
}

/// Of a product rounded down: one more if it is negative.
#[inline]
pub(super) fn towards_zero(product: i32) -> i32 {
    product - (product >> 31)
}
