//! Reciprocals from a table: 1/q, and every other quotient, without a divide instruction.
//!
//! - In: a divisor, or one that is normalised, with its leading zeros.
//! - Out: its reciprocal with a relative error below 2⁻²⁰ (`coarse`) or 2⁻³⁰ (`precise`), or in 17 bits (`short`); or an exact
//!   quotient and remainder (`div_rem`), or a quotient of small integers (`quotient_of_10_bits`).
//! - Assumes: what each function says of its divisor. Where 0 is allowed it counts as 1.
//!
//! A divisor is normalised by its leading zeros to `m` = 2³¹ … 2³² − 1. The 9 bits after its leading one select an interval
//! of the table, and the next 15 interpolate in it, linearly: by the chord of 1/x, x = m/2³¹. The chord is too high by up to
//! 2⁻²⁰/x² of the value (f″h²/8 with h = 1/512). So the entries are lowered by half of that, and the error stays below 2⁻²⁰
//! on both sides. The first entry is not lowered, so that powers of two stay exact. The scheme is that of the Nintendo 64's
//! rasterizer, which has 64 intervals.
//!
//! One Newton–Raphson step squares the error: [`Reciprocal::precise`] is good to 2⁻³⁰.

use crate::num::{mul_high, normalise, normalised, wide_inlined};

const INTERVALS: usize = 512;

/// 2³¹/x for x = 1 + i/512, rounded, less 2¹⁰/x³, which is half of the chord's error.
static TABLE: [u32; INTERVALS + 1] = table();

const fn table() -> [u32; INTERVALS + 1] {
    let mut table = [0; INTERVALS + 1];
    let mut i = 0;
    while i <= INTERVALS {
        let n = (INTERVALS + i) as u64; // x = n/512
        let half_chord = if i == 0 { 0 } else { (1 << 37) / (n * n * n) };
        table[i] = (((1 << 40) + n / 2) / n - half_chord) as u32;
        i += 1;
    }
    table
}

/// 1/d as a mantissa and the leading zeros of d: 1/d = `mantissa` · 2^(`zeros` − 62).
#[derive(Clone, Copy, Debug)]
pub(crate) struct Reciprocal {
    /// 2³⁰ … 2³¹ − 1; in a [`coarse`](Self::coarse) one it may be up to 94 below 2³⁰.
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
        // 2³¹, which comes of powers of two, is one too many for an i32: they are off by the last bit here.
        Self { mantissa: looked_up(m).min(i32::MAX as u32) as i32, zeros }
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
        // With y the mantissa: r = 2⁶¹ − (m/2)·y, |r| ≤ 2⁴¹, and y += y·r/2⁶¹.
        let r = (1 << 61) - wide_inlined(half_m, mantissa);
        let step = (wide_inlined(mantissa, (r >> 20) as i32) + (1 << 40)) >> 41;
        let mantissa = (mantissa as u32).wrapping_add_signed(step as i32).min(i32::MAX as u32);
        Self { mantissa: mantissa as i32, zeros }
    }

    /// The quotient `numerator / divisor`, rounded down, and the remainder 0 … `divisor` − 1. `self` is the precise
    /// reciprocal of `divisor` (1 … 2²⁴).
    #[inline]
    pub(crate) fn div_rem(self, numerator: i32, divisor: i32) -> (i32, i32) {
        let half = mul_high(numerator, self.mantissa as u32);
        corrected((half << 1) >> (31 - self.zeros), numerator, divisor)
    }
}

/// 2⁶²/m for m = 2³¹ … 2³² − 1: 2³¹ … 2³⁰, or up to 94 less at the end. The relative error is below 2⁻²⁰, and 0 for m = 2³¹.
#[inline]
pub(crate) fn looked_up(m: u32) -> u32 {
    let i = (m >> 22) as usize & (INTERVALS - 1);
    let (left, right) = (TABLE[i], TABLE[i + 1]);
    // 17 bits · 15 bits.
    let fall = (((left - right) >> 5) * ((m >> 7) & 0x7fff)) >> 10;
    left - fall
}

/// As [`looked_up`], but 2³¹ − 1 at most, which fits an `i32`.
#[inline]
pub(crate) fn looked_up_signed(m: u32) -> i32 {
    let inverse = looked_up(m);
    (inverse - (inverse >> 31)) as i32
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
    let (m, zeros) = normalised(divisor.max(1));
    (short(m), zeros)
}

/// `numerator / divisor` with 20 fraction bits, for a numerator within ±512 (10 bits with the sign) and a divisor of 1 … 511.
/// Each such divisor falls on an entry of the table, so nothing is interpolated. The reciprocal's relative error is below
/// 2⁻²⁰, and the quotient is rounded to nearest.
#[inline]
pub(crate) fn quotient_of_10_bits(numerator: i32, divisor: i32) -> i32 {
    let (m, zeros) = normalised((divisor as u32) << 23);
    let reciprocal = (TABLE[(m >> 22) as usize & (INTERVALS - 1)] + (1 << 9)) >> 10;
    (((numerator * reciprocal as i32) >> ((8 - zeros) & 31)) + 1) >> 1
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
        // The table stage takes 24 bits after the leading one: these are all its inputs.
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
