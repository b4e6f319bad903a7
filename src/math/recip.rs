//! Reciprocals from a table: 1/q, and every other quotient, without a divide instruction.
//!
//! - In: a divisor, or one that is normalised, with its leading zeros.
//! - Out: its reciprocal with a relative error below 2⁻²⁰ (`coarse`) or 2⁻³⁰ (`precise`), or in 17 bits (`short`); or an exact
//!   quotient and remainder (`div_rem`), or a quotient of small integers (`quotient_of_10_bits`).
//! - Assumes: what each function says of its divisor. Where 0 is allowed it counts as 1.
//!
//! A divisor is normalised by its leading zeros to `m` = 2³¹ … 2³² − 1, which is x = m/2³¹ in the unit of 1. The 8 bits after its
//! leading one select one of 256 intervals. The table has y, the reciprocal of the interval's beginning, and a series makes of it
//! the reciprocal of x: with δ = x·y − 1, what is too much,
//!
//! ```text
//! 1/x = y / (1 + δ) ≈ y · (1 − δ + δ²)      too high by δ³ of itself, as (1 + δ) · (1 − δ + δ²) = 1 + δ³
//! ```
//!
//! δ is below 2⁻⁸, an interval, and may be −2⁻¹⁵ from y's rounding: so δ³ is below 2⁻²⁴, and what is cut off on the way, 2⁻²² together,
//! is more. A table for the first two terms alone would have 512 entries. δ is the low bits of a product, since all above them are
//! those of 1.
//!
//! A Newton–Raphson step, y · (1 − δ), squares the error: [`Reciprocal::precise`] is good to 2⁻³⁰.

use crate::num::{IS_ARMV6M, mul_high, normalise, wide_inlined};

const INTERVALS: usize = 256;

/// 2¹⁶/x for x = 1 + i/256, rounded. The first one is 2 less, so that it fits, and no reciprocal is 2³¹.
static TABLE: [u16; INTERVALS] = table();

const fn table() -> [u16; INTERVALS] {
    let mut table = [u16::MAX - 1; INTERVALS];
    let mut i = 1;
    while i < INTERVALS {
        let n = (INTERVALS + i) as u32; // x = n/256
        table[i] = (((1 << 24) + n / 2) / n) as u16;
        i += 1;
    }
    table
}

/// 1/d as a mantissa and the leading zeros of d: 1/d = `mantissa` · 2^(`zeros` − 62).
#[derive(Clone, Copy, Debug)]
pub(crate) struct Reciprocal {
    /// 2³⁰ … 2³¹ − 1.
    pub(crate) mantissa: i32,
    /// The leading zeros of the divisor, 0 … 31.
    pub(crate) zeros: u32,
}

impl Reciprocal {
    /// From the table: relative error below 2⁻²⁰. A divisor of 0 counts as 1.
    #[inline]
    pub(crate) fn coarse(divisor: u32) -> Self {
        let (m, zeros) = normalise(divisor.max(1));
        Self::coarse_normalised(m, zeros)
    }

    /// As [`Reciprocal::coarse`], from a normalised divisor `m`, 2³¹ … 2³² − 1, and the leading zeros that it had.
    #[inline]
    pub(crate) fn coarse_normalised(m: u32, zeros: u32) -> Self {
        Self { mantissa: looked_up(m) as i32, zeros }
    }

    /// A mantissa that is not too large, from the table's: for a step that must not lead beyond its end.
    #[inline]
    pub(crate) fn mantissa_below(&self) -> i32 {
        // 2⁻¹⁹ of itself less, which is more than its error.
        self.mantissa - (self.mantissa >> 19)
    }

    /// From the table and one Newton–Raphson step: relative error below 2⁻³⁰, for divisors below 2³¹. (From there on half of `m`
    /// would lose a bit.) A divisor of 0 counts as 1.
    #[inline]
    pub(crate) fn precise(divisor: u32) -> Self {
        let (m, zeros) = normalise(divisor.max(1));
        Self::precise_normalised(m, zeros)
    }

    /// From the mantissa `m`, 2³¹ … 2³² − 1.
    #[inline(never)]
    pub(crate) fn precise_normalised(m: u32, zeros: u32) -> Self {
        let Self { mantissa, zeros } = Self::coarse_normalised(m, zeros);
        let half_m = (m >> 1) as i32;
        // With y the mantissa: r = 2⁶¹ − (m/2)·y, |r| < 2⁴⁰, and y += y·r/2⁶¹, of which 11 bits are left: upper halves of both do.
        let r = (1 << 61) - wide_inlined(half_m, mantissa);
        let step = ((mantissa >> 16) * (r >> 24) as i32 + (1 << 20)) >> 21;
        let mantissa = (mantissa as u32).wrapping_add_signed(step).min(i32::MAX as u32);
        Self { mantissa: mantissa as i32, zeros }
    }

    /// The quotient `numerator / divisor`, rounded down, and the remainder 0 … `divisor` − 1. `self` is the precise
    /// reciprocal of `divisor` (1 … 2²⁴).
    #[cfg_attr(all(target_arch = "arm", not(target_has_atomic = "32")), inline(never))]
    #[cfg_attr(not(all(target_arch = "arm", not(target_has_atomic = "32"))), inline)]
    pub(crate) fn div_rem(self, numerator: i32, divisor: i32) -> (i32, i32) {
        let half = mul_high(numerator, self.mantissa as u32);
        corrected((half << 1) >> (31 - self.zeros), numerator, divisor)
    }
}

/// 2⁶²/m for m = 2³¹ … 2³² − 1: less than 2³¹ and more than 2³⁰. The relative error is below 2⁻²⁰.
#[inline]
pub(crate) fn looked_up(m: u32) -> u32 {
    let y = u32::from(TABLE[(m >> 23) as usize & (INTERVALS - 1)]);
    // x has 23 fraction bits here, y 16: what is left of the product is δ with 39, within ±2³¹.
    let excess = ((m >> 8).wrapping_mul(y) as i32) >> 16;
    let less = (excess - ((excess * excess) >> 23)) * y as i32;
    (y << 15).wrapping_add_signed(-(less >> 8))
}

/// The exact quotient and remainder, from a quotient that is off by at most a few.
#[inline]
fn corrected(mut quotient: i32, numerator: i32, divisor: i32) -> (i32, i32) {
    let mut remainder = numerator.wrapping_sub(quotient.wrapping_mul(divisor));
    // Most often these loops do not run.
    while remainder < 0 {
        (quotient, remainder) = (quotient - 1, remainder + divisor);
    }
    while remainder >= divisor {
        (quotient, remainder) = (quotient + 1, remainder - divisor);
    }
    (quotient, remainder)
}

/// 2⁴⁸/m for m = 2³¹ … 2³² − 1, rounded: 2¹⁶ … 2¹⁷, short enough for `mul_17` and products with 15 bits. The relative error
/// is at most 2⁻¹⁷ from rounding, and the table's.
#[inline]
pub(crate) fn short(m: u32) -> u32 {
    (looked_up(m) + (1 << 13)) >> 14
}

/// [`short`] of the normalised divisor, and the divisor's leading zeros: 1/d = the former · 2^(zeros − 48). A divisor of 0
/// counts as 1.
#[inline]
pub(crate) fn short_of(divisor: u32) -> (u32, u32) {
    let (m, zeros) = normalise(divisor.max(1));
    (short(m), zeros)
}

/// `numerator / divisor` with 20 fraction bits, for a numerator within ±512 (10 bits with the sign) and a divisor of 1 … 511.
/// The reciprocal is off by at most 2⁻²⁰ of itself, and the quotient is rounded to nearest.
#[inline]
pub(crate) fn quotient_of_10_bits(numerator: i32, divisor: i32) -> i32 {
    let (mut m, mut down) = ((divisor as u32) << 23, 8);
    if IS_ARMV6M {
        while (m as i32) >= 0 {
            (m, down) = (m << 1, down - 1);
        }
    } else {
        let (divisor, zeros) = (divisor as u32, divisor.leading_zeros());
        (m, down) = (divisor << zeros, 31 - zeros);
    }
    let y = u32::from(TABLE[usize::from((m >> 23) as u8)]);
    // As in `looked_up`, but at the beginning of the interval, where δ is y's rounding alone. It has 32 fraction bits; the lowest 8 are 0.
    let excess = (m >> 15).wrapping_mul(y) as i32;
    let less = if IS_ARMV6M { ((excess >> 8) * y as i32) >> 19 } else { mul_high(excess, y << 5) };
    let reciprocal = (y << 5) as i32 - less;
    (((numerator * reciprocal) >> (down & 31)) + 1) >> 1
}

#[cfg(test)]
#[expect(clippy::float_arithmetic, reason = "the truth in f64")]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use std::println;

    fn relative_error(r: Reciprocal, divisor: u32) -> f64 {
        let exact = 2f64.powi(62 - r.zeros as i32) / f64::from(divisor);
        f64::from(r.mantissa) / exact - 1.0
    }

    #[test]
    fn coarse_is_within_2_pow_minus_20_for_every_input_of_its_table_stage() {
        // The table stage takes 23 bits after the leading one: these are all its inputs, each twice.
        let (mut low, mut high) = (0f64, 0f64);
        for d in 1u32 << 24..1 << 25 {
            let error = relative_error(Reciprocal::coarse(d), d);
            (low, high) = (low.min(error), high.max(error));
        }
        println!(
            "reciprocal, coarse: 2^24 inputs, error {:+.3} … {:+.3} · 2^-20",
            low * 2f64.powi(20),
            high * 2f64.powi(20)
        );
        assert!(low > -(2f64.powi(-20)) && high < 2f64.powi(-20));
    }

    #[test]
    fn both_hold_for_a_dense_sample_of_all_32_bit_inputs() {
        let (mut coarse, mut precise) = (0f64, 0f64);
        let mut count = 0;
        for shift in 0..32 {
            // Odd strides: all of the octaves below 2¹⁶, and 21 845 or more of each from there on.
            let first = 1u64 << shift;
            let stride = ((first >> 15) | 1) as usize;
            for d in (first..2 * first).step_by(stride) {
                let d = d as u32;
                coarse = coarse.max(relative_error(Reciprocal::coarse(d), d).abs());
                if d < 1 << 31 {
                    precise = precise.max(relative_error(Reciprocal::precise(d), d).abs());
                }
                count += 1;
            }
        }
        println!(
            "reciprocal, {count} inputs of 1 … 2^32-1: coarse within 2^{:.2}, precise within 2^{:.2}",
            coarse.log2(),
            precise.log2()
        );
        assert!(coarse < 2f64.powi(-20));
        assert!(precise < 2f64.powi(-30));
    }

    proptest! {
        #![proptest_config(ProptestConfig { cases: 100_000, failure_persistence: None, ..ProptestConfig::default() })]
        #[test]
        fn quotients_are_exact_in_100_000_cases(n: i32, d in 1i32..1 << 24, small in 1i32..300) {
            for d in [d, small] {
                let r = Reciprocal::precise(d as u32);
                prop_assert_eq!(r.div_rem(n, d), (n.div_euclid(d), n.rem_euclid(d)));
            }
        }
    }
}
