//! Where an edge crosses a plane, as a ratio, and what lies there.
//!
//! - In: the distances of both ends from the plane, 0 … 2⁴⁷; then numbers at both ends.
//! - Out: the numbers at the crossing.
//! - Assumes: nothing.

use crate::math::recip::Reciprocal;
use crate::num::{leading_zeros, mul_long, wide};

/// A ratio of 0 … 1.
pub(super) struct Ratio {
    /// In units of 2⁻³⁰.
    pub(super) upper: i32,
    /// The remainder, in units of 2⁻⁵⁴.
    lower: i32,
}

impl Ratio {
    /// `before` / (`before` + `behind`), the distances of an edge's ends from a plane, 0 … 2⁴⁷ each: to 30 bits, and if it is
    /// to be fine to 2⁻⁴⁴, by a second quotient of what the first one leaves.
    #[inline(never)]
    pub(super) fn new(before: i64, behind: i64, is_fine: bool) -> Self {
        let whole = before + behind;
        if whole == 0 {
            return Self { upper: 0, lower: 0 };
        }
        let shift = leading_zeros(whole as u64) - 16; // whole becomes 2⁴⁷ … 2⁴⁸ − 1
        let (before, whole) = (before << shift, whole << shift);
        // From its upper 32 bits: 1/whole = mantissa · 2⁻⁷⁸. So before/whole in 2⁻³⁰ is before · mantissa / 2⁴⁸.
        let mantissa = Reciprocal::precise_normalised((whole >> 16) as u32, 1).mantissa;
        let upper = (mul_long(before, mantissa) >> 18).min(1 << 30) as i32;
        let rest = if is_fine { (before - mul_long(whole, upper)) as i32 } else { 0 };
        Self { upper, lower: (wide(rest, mantissa) >> 24) as i32 }
    }

    /// From `a` to `b`, which differ by less than 2⁴⁷, rounded down.
    #[inline(always)]
    pub(super) fn between(&self, a: i64, b: i64) -> i64 {
        let mut share = mul_long(b - a, self.upper);
        if self.lower != 0 {
            share += mul_long((b - a) >> 24, self.lower);
        }
        a + share
    }
}

/// a + (b − a) · t / 2³⁰, rounded to nearest. Weighted with 2³⁰ − t and t, as b − a might overflow.
#[inline(never)]
pub(super) fn mix(a: i32, b: i32, t: i32) -> i32 {
    ((wide(a, (1 << 30) - t) + wide(b, t) + (1 << 29)) >> 30) as i32
}
