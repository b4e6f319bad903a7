//! Number formats, literals, and the only multiply.
//!
//! Every quantity has one format, named after its integer and fraction bits as in the [`fixed`]
//! crate: `I4F12` is a signed number of 4 integer bits (sign included) and 12 fraction bits.
//!
//! | quantity | format | range | step |
//! |---|---|---|---|
//! | mesh position | [`I4F12`] | −8 … 7.9998 | 1/4096 |
//! | mesh texture coordinate | [`I12F4`] | −2048 … 2047.9 texels | 1/16 texel |
//! | rotation matrix, sine | [`I2F14`] | −2 … 1.9999 | 1/16384 |
//! | quaternion | [`I2F30`] | −2 … 2 | 2⁻³⁰ |
//! | scale of a pose | [`U10F22`] | 0 … 1023.9999998 | 2.4·10⁻⁷ |
//! | world position | [`I16F16`] | −32768 … 32767.99998 | 1/65536 |
//! | screen position | [`I12F4`] | guard band ±1023½ px | 1/16 px |
//! | q = near/w | [`U1F31`] | 0 … 1 − 2⁻³¹ | 2⁻³¹ |
//! | texture coordinate on screen | [`I16F16`] | −8192 … 8192 texels | 2⁻¹⁶ texel |
//! | colour channel on screen | [`U8F8`] | 0 … 255 is dark … full | 1/256 |

use core::hint::black_box;

pub use fixed::types::{I2F14, I2F30, I4F12, I12F4, I16F16, U1F31, U8F8, U10F22};

/// Whether arithmetic is done as Armv6-M needs it, which has no 32 × 32 → 64 multiply and cannot count zeros.
///
/// No stable `cfg` names Armv6-M; of the Arm targets it is the one without atomic swaps. `RUSTFLAGS="--cfg fixel_armv6m"` asks for
/// the same arithmetic on any other machine, so that the tests can hold it there.
pub(crate) const IS_ARMV6M: bool =
    cfg!(any(fixel_armv6m, all(target_arch = "arm", not(target_has_atomic = "32"))));

/// The product of two 32-bit numbers in 64 bits: the only wide multiply in the crate.
///
/// Most cores have an instruction for it. Armv6-M has not: there the compiler would call a library
/// routine for 64 × 64 bits (52 instructions), so the product is put together from four 16-bit ones: 34 cycles, and not inlined.
#[cfg_attr(all(target_arch = "arm", not(target_has_atomic = "32")), inline(never))]
#[cfg_attr(not(all(target_arch = "arm", not(target_has_atomic = "32"))), inline)]
pub(crate) const fn wide(a: i32, b: i32) -> i64 {
    wide_inlined(a, b)
}

/// As [`wide`], 13 cycles faster on Armv6-M, and 40 bytes longer wherever it is.
#[inline(always)]
pub(crate) const fn wide_inlined(a: i32, b: i32) -> i64 {
    if IS_ARMV6M { wide_split(a, b) } else { a as i64 * b as i64 }
}

/// [`wide`] from four products of 16-bit halves, none of which overflows 32 bits.
#[inline]
const fn wide_split(a: i32, b: i32) -> i64 {
    let (a_high, a_low) = (a >> 16, a & 0xffff);
    let (b_high, b_low) = (b >> 16, b & 0xffff);
    let low = (a_low as u32).wrapping_mul(b_low as u32);
    // −2¹⁵·(2¹⁶−1) … (2¹⁵−1)(2¹⁶−1) + 2¹⁶ − 1 fits an i32, twice.
    let middle = a_high * b_low + (low >> 16) as i32;
    let middle_2 = a_low * b_high + (middle & 0xffff);
    let high = a_high * b_high + (middle >> 16) + (middle_2 >> 16);
    let low = ((middle_2 as u32) << 16) | (low & 0xffff);
    ((high as i64) << 32) | low as i64
}

// The short products below have operands of limited range, which debug builds check on every machine: beyond it the shorter
// arithmetic of Armv6-M would overflow.

/// `a · b / 2¹⁶` rounded down, for a `b` of 0 … 2¹⁶: two short products on Armv6-M.
#[inline]
pub(crate) const fn mul_16(a: i32, b: u32) -> i32 {
    debug_assert!(b <= 1 << 16);
    if IS_ARMV6M { mul_16_split(a, b) } else { ((a as i64 * b as i32 as i64) >> 16) as i32 }
}

#[inline]
const fn mul_16_split(a: i32, b: u32) -> i32 {
    (a >> 16) * b as i32 + (((a as u32 & 0xffff) * b) >> 16) as i32
}

/// `a · b / 2¹⁶` rounded down, for a `b` of −2¹⁵ … 2¹⁵ − 1: likewise. Beyond that some number, the same on every machine.
#[inline]
pub(crate) const fn mul_16_signed(a: i32, b: i32) -> i32 {
    if IS_ARMV6M {
        mul_16_signed_split(a, b as i16 as i32)
    } else {
        ((a as i64 * b as i16 as i64) >> 16) as i32
    }
}

#[inline]
const fn mul_16_signed_split(a: i32, b: i32) -> i32 {
    (a >> 16) * b + (((a & 0xffff) * b) >> 16)
}

/// `a · b / 2¹⁶` rounded down, for the even part of an `a` of −2³⁰ … 2³⁰ − 1 and a `b` of 0 … 2¹⁷: likewise.
#[inline]
pub(crate) const fn mul_17(a: i32, b: u32) -> i32 {
    debug_assert!(-1 << 30 <= a && a < 1 << 30 && b <= 1 << 17);
    if IS_ARMV6M { mul_17_split(a, b) } else { (((a & !1) as i64 * b as i32 as i64) >> 16) as i32 }
}

#[inline]
const fn mul_17_split(a: i32, b: u32) -> i32 {
    (a >> 16) * b as i32 + ((((a as u32 & 0xffff) >> 1) * b) >> 15) as i32
}

/// `a · b / 2²⁰` rounded down, for `a` without its last 8 bits and a `b` of 0 … 2²⁰: likewise.
#[inline]
pub(crate) const fn mul_20(a: i32, b: u32) -> i32 {
    debug_assert!(b <= 1 << 20);
    if IS_ARMV6M { mul_20_split(a, b) } else { (((a & !0xff) as i64 * b as i32 as i64) >> 20) as i32 }
}

#[inline]
const fn mul_20_split(a: i32, b: u32) -> i32 {
    // −2¹¹ · 2²⁰ … and 12 bits by 20.
    (a >> 20) * b as i32 + ((((a as u32) << 12 >> 20) * b) >> 12) as i32
}

/// `a · b / 2^S`, rounded to nearest, halves up; the low 32 bits of it.
#[inline]
pub(crate) const fn mul_round<const S: u32>(a: i32, b: i32) -> i32 {
    ((wide_inlined(a, b) + (1 << (S - 1))) >> S) as i32
}

/// `a · b`, exactly, of numbers without a sign: by [`wide`], so that on Armv6-M the compiler's routine is not linked as well.
#[cfg_attr(all(target_arch = "arm", not(target_has_atomic = "32")), inline(never))]
#[cfg_attr(not(all(target_arch = "arm", not(target_has_atomic = "32"))), inline)]
pub(crate) const fn wide_unsigned(a: u32, b: u32) -> u64 {
    // What has its upper bit set is 2³² too small there.
    let more = (if a >> 31 != 0 { b } else { 0 }).wrapping_add(if b >> 31 != 0 { a } else { 0 });
    (wide(a as i32, b as i32) as u64).wrapping_add((more as u64) << 32)
}

/// `a · b / 2³⁰`, rounded down, for an `a` within ±2⁵⁹ if the result is.
///
/// Not inlined on Armv6-M: of three wide multiplies there is one copy.
#[cfg_attr(all(target_arch = "arm", not(target_has_atomic = "32")), inline(never))]
#[cfg_attr(not(all(target_arch = "arm", not(target_has_atomic = "32"))), inline)]
pub(crate) const fn mul_long(a: i64, b: i32) -> i64 {
    let (upper, lower) = ((a >> 30) as i32, (a & ((1 << 30) - 1)) as i32);
    wide(upper, b) + (wide_inlined(lower, b) >> 30)
}

/// The upper 32 bits of `a · b` for a `b` of 0 … 2³¹, or up to 2 less: three short products on Armv6-M.
#[inline]
pub(crate) const fn mul_high_short(a: i32, b: u32) -> i32 {
    debug_assert!(b <= 1 << 31);
    mul_16(a, b >> 16) + (((a >> 16) * (b & 0xffff) as i32) >> 16)
}

/// The upper 32 bits of `a · b`, rounded down, for a `b` of 0 … 2³¹.
#[inline]
pub(crate) const fn mul_high(a: i32, b: u32) -> i32 {
    debug_assert!(b <= 1 << 31);
    if IS_ARMV6M { mul_high_split(a, b) } else { ((a as i64 * b as i64) >> 32) as i32 }
}

/// Likewise, for a `b` that is not negative: one instruction on most cores.
#[inline]
pub(crate) const fn mul_high_signed(a: i32, b: i32) -> i32 {
    debug_assert!(b >= 0);
    if IS_ARMV6M { mul_high_split(a, b as u32) } else { ((a as i64 * b as i64) >> 32) as i32 }
}

#[inline]
const fn mul_high_split(a: i32, b: u32) -> i32 {
    let (a_high, a_low) = (a >> 16, a as u32 & 0xffff);
    let (b_high, b_low) = (b >> 16, b & 0xffff);
    let middle = a_high * b_low as i32 + ((a_low * b_low) >> 16) as i32;
    let middle_2 = a_low * b_high + (middle as u32 & 0xffff);
    a_high * b_high as i32 + (middle >> 16) + (middle_2 >> 16) as i32
}

/// A `value` other than 0, shifted left until its first bit is set, and how far.
///
/// Armv6-M has no instruction that counts zeros, and the compiler's routine takes 45 cycles there. This takes 4 for each
/// zero, and 4 for every 8 at first; clip coordinates have few.
#[inline(always)]
pub(crate) const fn normalised(value: u32) -> (u32, u32) {
    if IS_ARMV6M {
        normalised_stepwise(value)
    } else {
        (value << value.leading_zeros(), value.leading_zeros())
    }
}

/// As [`normalised`], out of line on Armv6-M: still half as long as the compiler's routine.
#[cfg_attr(all(target_arch = "arm", not(target_has_atomic = "32")), inline(never))]
#[cfg_attr(not(all(target_arch = "arm", not(target_has_atomic = "32"))), inline)]
pub(crate) const fn normalise(value: u32) -> (u32, u32) {
    normalised(value)
}

#[inline(always)]
const fn normalised_stepwise(mut value: u32) -> (u32, u32) {
    let mut zeros = 0;
    while value >> 24 == 0 {
        (value, zeros) = (value << 8, zeros + 8);
    }
    while (value as i32) >= 0 {
        (value, zeros) = (value << 1, zeros + 1);
    }
    (value, zeros)
}

/// The leading zeros of a number, 32 of 0. On Armv6-M, which has no instruction for that, by what [`normalise`] has: so the compiler's
/// routine is not linked as well.
#[cfg_attr(all(target_arch = "arm", not(target_has_atomic = "32")), inline(never))]
#[cfg_attr(not(all(target_arch = "arm", not(target_has_atomic = "32"))), inline)]
pub(crate) const fn zeros_of(value: u32) -> u32 {
    if !IS_ARMV6M {
        value.leading_zeros()
    } else if value == 0 {
        32
    } else {
        normalise(value).1
    }
}

/// Likewise of a number of 64 bits.
#[cfg_attr(all(target_arch = "arm", not(target_has_atomic = "32")), inline(never))]
#[cfg_attr(not(all(target_arch = "arm", not(target_has_atomic = "32"))), inline)]
pub(crate) const fn leading_zeros(value: u64) -> u32 {
    if !IS_ARMV6M {
        return value.leading_zeros();
    }
    let upper = zeros_of((value >> 32) as u32);
    if upper < 32 { upper } else { 32 + zeros_of(value as u32) }
}

/// The number of the lowest bit that is set: one is. On Armv6-M one after another: the compiler's way takes a table.
#[cfg_attr(all(target_arch = "arm", not(target_has_atomic = "32")), inline(never))]
#[cfg_attr(not(all(target_arch = "arm", not(target_has_atomic = "32"))), inline)]
pub(crate) fn lowest_bit(mut of: u32) -> usize {
    if !IS_ARMV6M {
        return of.trailing_zeros() as usize;
    }
    let mut number = 0;
    while of & 1 == 0 {
        (of, number) = (of >> 1, number + 1);
        // Not unrolled.
        black_box(());
    }
    number
}

/// `value / 2^shift`, rounded to nearest, halves up, for a `shift` of 0 … 63.
#[inline]
pub(crate) const fn shift_round(value: i64, shift: u32) -> i64 {
    if shift == 0 { value } else { ((value >> (shift - 1)) + 1) >> 1 }
}

/// As [`shift_round`], for a `shift` of 1 … 32 and a result of at most 31 bits with the sign.
#[inline]
pub(crate) const fn shift_round_short(value: i64, shift: u32) -> i32 {
    let down = (shift - 1) & 31;
    let bits = (value as u32 >> down) | ((value >> 32) as u32) << 1 << (31 - down);
    (bits as i32 + 1) >> 1
}

/// The raw bits of `value` in a format with `fraction_bits`, rounded to nearest and saturated to
/// an `i32`; 0 for NaN. Meant for constants: at run time it costs a few soft-float calls.
#[expect(clippy::float_arithmetic, reason = "set-up convenience, folded in constants")]
pub(crate) const fn bits_from_f32(value: f32, fraction_bits: u32) -> i32 {
    let scaled = value as f64 * (1u64 << fraction_bits) as f64;
    // `as` saturates and turns NaN into 0.
    (if scaled < 0.0 { scaled - 0.5 } else { scaled + 0.5 }) as i32
}

/// As [`bits_from_f32`] for formats of any length; what is no number is too large for all of them.
#[inline]
#[expect(clippy::float_arithmetic, reason = "set-up convenience, folded in constants")]
pub(crate) const fn bits_or_max(value: f32, fraction_bits: u32) -> i64 {
    let scaled = value as f64 * (1u64 << fraction_bits) as f64;
    let rounded = (if scaled < 0.0 { scaled - 0.5 } else { scaled + 0.5 }) as i64;
    if scaled <= f64::MAX { rounded } else { i64::MAX }
}

#[cfg(test)]
#[expect(clippy::float_arithmetic, reason = "the f64 truth of the tests")]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn split_multiply_is_the_widening_one_at_every_corner() {
        let corners = [
            i32::MIN,
            i32::MIN + 1,
            -65537,
            -65536,
            -65535,
            -32768,
            -1,
            0,
            1,
            32767,
            65535,
            65536,
            65537,
            i32::MAX - 1,
            i32::MAX,
        ];
        for a in corners {
            for b in corners {
                assert_eq!(wide_split(a, b), i64::from(a) * i64::from(b), "{a} · {b}");
            }
        }
    }

    proptest! {
        #![proptest_config(ProptestConfig { cases: 100_000, failure_persistence: None, ..ProptestConfig::default() })]
        #[test]
        fn split_multiply_is_the_widening_one_in_100_000_cases(a: i32, b: i32) {
            prop_assert_eq!(wide_split(a, b), i64::from(a) * i64::from(b));
        }
    }

    proptest! {
        #![proptest_config(ProptestConfig { cases: 100_000, failure_persistence: None, ..ProptestConfig::default() })]
        #[test]
        fn short_split_multiplies_are_the_widening_ones_in_100_000_cases(a: i32, b in 0u32..=1 << 17) {
            let exactly = |a: i32, b: i64| (i64::from(a) * b) >> 16;
            for a in [a, i32::MIN, i32::MAX, a >> 16] {
                for b in [b >> 1, 1 << 16, 0xffff] {
                    prop_assert_eq!(i64::from(mul_16_split(a, b)), exactly(a, b.into()));
                    let signed = b as i32 - (1 << 15);
                    if signed < 1 << 15 {
                        prop_assert_eq!(i64::from(mul_16_signed_split(a, signed)), exactly(a, signed.into()));
                        prop_assert_eq!(i64::from(mul_16_signed(a, signed)), exactly(a, signed.into()));
                    }
                }
            }
            for a in [a >> 1, -1 << 30, (1 << 30) - 1, a >> 16] {
                for b in [b, (1 << 17) - 1, 0xffff] {
                    prop_assert_eq!(i64::from(mul_17_split(a, b)), exactly(a & !1, b.into()));
                }
            }
            for a in [a, i32::MIN, i32::MAX, a >> 16] {
                for b in [b << 3, 1 << 20, (1 << 20) - 1, b] {
                    let exactly = exactly(a & !0xff, b.into()) >> 4;
                    prop_assert_eq!(i64::from(mul_20_split(a, b)), exactly);
                    prop_assert_eq!(i64::from(mul_20(a, b)), exactly);
                }
            }
        }
    }

    proptest! {
        #![proptest_config(ProptestConfig { cases: 100_000, failure_persistence: None, ..ProptestConfig::default() })]
        #[test]
        fn three_short_products_are_at_most_2_below_the_upper_half_in_100_000_cases(a: i32, b in 0u32..=1 << 31) {
            for a in [a, i32::MIN, i32::MAX] {
                for b in [b, 1 << 31, (1 << 31) - 1, b >> 16] {
                    let below = ((i64::from(a) * i64::from(b)) >> 32) - i64::from(mul_high_short(a, b));
                    prop_assert!((0..=2).contains(&below), "{} · {}: {}", a, b, below);
                }
            }
        }
    }

    proptest! {
        #![proptest_config(ProptestConfig { cases: 100_000, failure_persistence: None, ..ProptestConfig::default() })]
        #[test]
        fn split_upper_halves_are_exact_in_100_000_cases(a: i32, b in 0u32..=1 << 31) {
            for a in [a, i32::MIN, i32::MAX, a >> 16] {
                for b in [b, 1 << 31, (1 << 31) - 1, b >> 16, 0xffff] {
                    prop_assert_eq!(i64::from(mul_high_split(a, b)), (i64::from(a) * i64::from(b)) >> 32);
                }
            }
        }
    }

    #[test]
    fn normalising_by_steps_is_counting_zeros() {
        for shift in 0..32 {
            for value in [1 << 31, u32::MAX, 0xa5a5_a5a5] {
                let value: u32 = value >> shift;
                assert_eq!(normalised_stepwise(value), (value << shift, value.leading_zeros()), "{value:#x}");
            }
        }
    }

    proptest! {
        #![proptest_config(ProptestConfig { cases: 100_000, failure_persistence: None, ..ProptestConfig::default() })]
        #[test]
        fn literals_are_rounded_as_exactly_in_100_000_cases(any: u32, place in -9.0..9.0_f32, ends in -2_i32..=2, fraction_bits in 0_u32..=22) {
            // A step of an f32 beside a half of the last bit, too.
            let half = (place * 4096.0).floor().abs() / 4096.0 + 0.5 / 4096.0;
            let beside_half = f32::from_bits(half.to_bits().wrapping_add_signed(ends));
            for value in [f32::from_bits(any), place, beside_half, -beside_half] {
                // Exact in f64; `round` takes halves away from 0.
                let exactly = (f64::from(value) * f64::from(1 << fraction_bits)).round();
                let bits = bits_or_max(value, fraction_bits);
                if exactly.abs() < 2_f64.powi(52) {
                    prop_assert_eq!(bits as f64, exactly, "{}", value);
                } else {
                    prop_assert!(bits.unsigned_abs() >= 1 << 52 && (bits < 0) == (exactly < 0.0), "{}", value);
                }
            }
        }
    }

    #[test]
    fn literals_round_saturate_and_take_nan() {
        assert_eq!(bits_from_f32(1.5, 12), 6144);
        assert_eq!(bits_from_f32(-0.5 / 65536.0, 16), -1);
        assert_eq!(bits_from_f32(0.49 / 65536.0, 16), 0);
        assert_eq!(bits_from_f32(f32::NAN, 16), 0);
        assert_eq!(bits_from_f32(f32::INFINITY, 16), i32::MAX);
        assert_eq!(bits_from_f32(f32::NEG_INFINITY, 16), i32::MIN);
    }

    #[test]
    fn literals_that_are_no_numbers_fit_no_format() {
        for none in [f32::NAN, -f32::NAN, f32::INFINITY, f32::MAX] {
            assert_eq!(bits_or_max(none, 12), i64::MAX);
        }
        for none in [f32::NEG_INFINITY, f32::MIN] {
            assert_eq!(bits_or_max(none, 12), i64::MIN);
        }
    }
}
