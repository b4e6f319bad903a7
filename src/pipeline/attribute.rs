//! One attribute over a triangle, between [set-up](super::setup) and [shading](super::shade).

use super::setup::Plane;
use crate::math::recip::Reciprocal;
use crate::num::{mul_17, wide};

/// The largest unit of packed texture coordinates, of a texture with a side of 256 texels: 1/256 texel (I16F16).
///
/// By so much a [straight run](super::fill::PackedLine) may be behind the coordinates that it is drawn from.
pub(super) const PACKED_UNIT: u32 = 1 << 8;

/// How far from the ends of their range bent texture coordinates stay, 1/51 texel: in a packed run v is off by one unit where it
/// begins and one where u repeats, which is after two pixels at the soonest. That is 5 of 2⁸ in the 8 pixels of a large texture,
/// or 13 of 2⁶ in 24.
pub(super) const BENT_MARGIN: u32 = 5 << 8;

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
    /// range at the corners; of a texture coordinate it ends below their greatest value, or a little inside on both sides.
    pub(super) least: i32,
    pub(super) low: i32,
    pub(super) range: u32,
    /// What comes out is times 2^this, modulo 2³².
    pub(super) scale_log2: u32,
}

impl Attribute {
    /// Moves a straight texture coordinate's plane in the direction of the change that decides of which texel a whole coordinate is:
    /// by the plane's error, of which `lean` has that direction too, and by a unit of packed coordinates. So a coordinate that is
    /// whole at a pixel's centre is never taken for the texel on the wrong side.
    ///
    /// And ends its range, which is that of the corners yet, below the greatest value there; one that is the same at all corners stays
    /// what it is.
    #[inline]
    pub(super) fn lean(&mut self, lean: i32, unit: u32) {
        let unit = lean.signum() * (unit as i32 + 1);
        self.plane.origin = self.plane.origin.wrapping_add_signed(lean + unit);
        self.range = self.range.saturating_sub(1);
    }

    /// What a straight triangle's plane begins with at corner 0.
    #[inline]
    pub(super) fn origin(&self) -> u32 {
        0u32.wrapping_sub(self.low as u32)
    }

    /// Sets the range from I16F16 values at the corners, but for an `inset` on both sides, as far as there is room for it. Returns by
    /// how much they rise from corner 0 to 1 and 2.
    #[inline]
    pub(super) fn set_range(&mut self, at: [i32; 3], scale_log2: u32, mut inset: u32) -> [i32; 2] {
        let rise = [at[1] - at[0], at[2] - at[0]];
        let (low, high) = (rise[0].min(rise[1]).min(0), rise[0].max(rise[1]).max(0));
        let range = high.wrapping_sub(low) as u32;
        self.range = range.wrapping_sub(2 * inset);
        if range < 2 * inset {
            (self.range, inset) = (0, range >> 1);
        }
        self.low = low.wrapping_add_unsigned(inset);
        self.least = at[0] + self.low;
        self.scale_log2 = scale_log2;
        rise
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

    /// Where q is the same all along: what a straight triangle's plane would say, and its step.
    #[inline]
    pub(super) fn level(&self, value: i32, step: i32, reciprocal: u32, zeros: u32) -> (u32, i32) {
        let product = mul_17(step, reciprocal);
        let down = self.shift - zeros as i32;
        let step = if down >= 0 { product >> (down & 31) } else { product << (-down & 31) };
        (self.offset(value, reciprocal, zeros).wrapping_sub(self.low) as u32, step)
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

    /// Of a straight run, from its plane's value and step: the attribute at the first and at the last pixel, and whether both are
    /// within its range; without `scale_log2`.
    #[inline]
    pub(super) fn ends(&self, (value, step): (u32, i32), steps: i32) -> ([i32; 2], bool) {
        let (first, last) = (value, value.wrapping_add_signed(step.wrapping_mul(steps)));
        let are_inside = first <= self.range && last <= self.range;
        ([first, last].map(|above| self.least.wrapping_add_unsigned(above)), are_inside)
    }
}

/// Keeps a straight run within the range of its attributes, some of which leave it by what rounding took them off: where they
/// are at the first pixel, their steps, and how many steps it makes. Returns how many it may make like that, up to where one of
/// them crosses the border. From there on that one goes along the border.
///
/// So what lies inside is as exact as elsewhere.
#[cold]
#[inline(never)]
pub(super) fn keep_within(attributes: &[Attribute], at: &mut [i32], step: &mut [i32], mut steps: i32) -> i32 {
    for ((attribute, at), step) in attributes.iter().zip(at).zip(step) {
        let first = at.wrapping_sub(attribute.least);
        let inside = first.clamp(0, attribute.range as i32);
        if inside != first {
            *at = attribute.least + inside;
            if *step != 0 && (first < 0) == (*step > 0) {
                steps = 0;
            }
            *step = 0;
        }
        while steps > 0 && inside.wrapping_add(step.wrapping_mul(steps)) as u32 > attribute.range {
            steps -= 1;
        }
    }
    steps
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

/// 1/`steps` of fewer than 32 with 16 fraction bits, rounded down, so that `steps` steps never lead beyond their end.
#[inline]
pub(super) fn short_inverse(steps: i32) -> u32 {
    INVERSES[steps as usize & 31] as u32 >> 15
}

/// Of a product rounded down: one more if it is negative.
#[inline]
pub(super) fn towards_zero(product: i32) -> i32 {
    product - (product >> 31)
}
