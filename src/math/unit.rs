//! Unit vectors, and the sine and cosine, to 30 fraction bits: what rotations are made of.

use crate::num::{mul_round, shift_round, wide};

/// 1.0 with 30 fraction bits.
pub(crate) const ONE: i32 = 1 << 30;

/// The direction of a vector of up to 4 components, whatever its unit, as a unit vector of 30
/// fraction bits: each component within 2.5 · 2⁻³⁰, the length within 1.001 · 2⁻³⁰. `None` for the zero vector.
///
/// One integer square root and `N` 64-bit divisions: for set-up.
pub(crate) const fn normalized<const N: usize>(v: [i64; N]) -> Option<[i32; N]> {
    let Some(Scaled { vector, length, .. }) = Scaled::new(v) else {
        return None;
    };
    let mut unit = [0; N];
    let mut i = 0;
    while i < N {
        unit[i] = ((vector[i] << 30) / length) as i32;
        i += 1;
    }
    Some(renormalized(unit))
}

/// The length of a vector of up to 4 components, in their unit: within 2⁻²⁸ of itself and ½, and exact for one along an axis.
/// One integer square root.
pub(crate) const fn length<const N: usize>(v: [i64; N]) -> u64 {
    let (mut most, mut sum) = (0, 0u64);
    let mut i = 0;
    while i < N {
        let magnitude = v[i].unsigned_abs();
        most = if magnitude > most { magnitude } else { most };
        sum = sum.saturating_add(magnitude);
        i += 1;
    }
    match Scaled::new(v) {
        Some(Scaled { length, zeros, .. }) if sum > most => {
            if zeros >= 34 {
                shift_round(length, zeros - 34) as u64
            } else {
                (length as u64) << (34 - zeros)
            }
        }
        _ => most,
    }
}

/// A vector scaled so that its largest component has 30 bits.
struct Scaled<const N: usize> {
    vector: [i64; N],
    /// 2²⁹ … 2³¹, rounded down: 2⁻²⁹ of it at most.
    length: i64,
    /// The leading zeros of the largest component before: 34 afterwards.
    zeros: u32,
}

impl<const N: usize> Scaled<N> {
    /// `None` for the zero vector.
    const fn new(v: [i64; N]) -> Option<Self> {
        const { assert!(N <= 4) }
        let mut all = 0;
        let mut i = 0;
        while i < N {
            all |= v[i].unsigned_abs();
            i += 1;
        }
        if all == 0 {
            return None;
        }
        // 30 bits each, so that the sum of four squares is at most 2⁶².
        let zeros = all.leading_zeros();
        let mut vector = [0i64; N];
        let mut squares = 0u64;
        i = 0;
        while i < N {
            vector[i] = if zeros >= 34 { v[i] << (zeros - 34) } else { shift_round(v[i], 34 - zeros) };
            squares += wide(vector[i] as i32, vector[i] as i32) as u64;
            i += 1;
        }
        Some(Self { vector, length: squares.isqrt() as i64, zeros })
    }
}

/// The same with the length of 1, for a length that is within 2⁻¹⁰ of it: one Newton–Raphson
/// step, 2·`N` multiplications. Each component is rounded once more, the length ends within 1.001 · 2⁻³⁰.
pub(crate) const fn renormalized<const N: usize>(v: [i32; N]) -> [i32; N] {
    let mut excess = -(1 << 60);
    let mut i = 0;
    while i < N {
        excess += wide(v[i], v[i]);
        i += 1;
    }
    // |v|² = 1 + e: v/|v| ≈ v − v·e/2, with 40 fraction bits for e/2.
    let half = (excess >> 21) as i32;
    let mut unit = v;
    i = 0;
    while i < N {
        unit[i] -= mul_round::<40>(v[i], half);
        i += 1;
    }
    unit
}

/// 1/3!, 1/5!, 1/7!, 1/9!, 1/11! with 31 fraction bits; the first term left out is below 2⁻³⁷.
const SINE: [i32; 5] = [357_913_941, 17_895_697, 426_088, 5_918, 54];
/// 1/2!, 1/4!, 1/6!, 1/8!, 1/10!; the first term left out is below 2⁻³².
const COSINE: [i32; 5] = [1 << 30, 89_478_485, 2_982_616, 53_261, 592];

/// Sine and cosine of `phase`/2³² of a turn, 30 fraction bits, each within 1.4 of the last;
/// exact at multiples of a quarter turn. Taylor's series on ±1/8 turn, 14 multiplications.
pub(crate) const fn sin_cos(phase: u32) -> (i32, i32) {
    let quadrant = phase.wrapping_add(1 << 29) >> 30;
    let rest = phase.wrapping_sub(quadrant << 30) as i32;
    // π with 29 fraction bits; radians with 31, at most π/4 of them.
    let x = mul_round::<29>(rest, 1_686_629_713);
    let square = mul_round::<31>(x, x);
    let sine = (x - mul_round::<31>(x, alternating(square, &SINE)) + 1) >> 1;
    let cosine = ONE - ((alternating(square, &COSINE) + 1) >> 1);
    match quadrant & 3 {
        0 => (sine, cosine),
        1 => (cosine, -sine),
        2 => (-sine, -cosine),
        _ => (-cosine, sine),
    }
}

/// c₀s − c₁s² + c₂s³ − …, 31 fraction bits.
const fn alternating(s: i32, coefficients: &[i32; 5]) -> i32 {
    let mut sum = 0;
    let mut i = 5;
    while i > 0 {
        i -= 1;
        sum = mul_round::<31>(coefficients[i] - sum, s);
    }
    sum
}

#[cfg(test)]
#[expect(clippy::float_arithmetic, reason = "the f64 truth of the tests")]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use std::println;

    const BIT: f64 = 1.0 / (1u64 << 30) as f64;

    #[test]
    fn sine_and_cosine_are_within_1_4_of_2_pow_minus_30_for_2_pow_20_angles() {
        let mut worst = 0f64;
        for i in 0..1u32 << 20 {
            // Every 2¹²th angle, and with the low bits of all sorts.
            let phase = (i << 12).wrapping_add(i.wrapping_mul(2_654_435_769) >> 20);
            let angle = f64::from(phase) / 2f64.powi(32) * core::f64::consts::TAU;
            let (sine, cosine) = sin_cos(phase);
            for (ours, exact) in [(sine, angle.sin()), (cosine, angle.cos())] {
                worst = worst.max((f64::from(ours) - exact / BIT).abs());
            }
        }
        println!("30-bit sine, cosine: 2^20 angles, error within {worst:.3} · 2^-30");
        assert!(worst <= 1.4);
        for (i, exact) in [(0, ONE), (ONE, 0), (0, -ONE), (-ONE, 0)].into_iter().enumerate() {
            assert_eq!(sin_cos((i as u32) << 30), exact);
        }
    }

    fn check<const N: usize>(v: [i64; N]) -> Result<f64, TestCaseError> {
        let length = v.iter().map(|&c| (c as f64).powi(2)).sum::<f64>().sqrt();
        let Some(unit) = normalized(v) else {
            prop_assert_eq!(v, [0; N]);
            return Ok(0.0);
        };
        let squares = unit.iter().map(|&c| (f64::from(c) * BIT).powi(2)).sum::<f64>();
        prop_assert!((squares.sqrt() - 1.0).abs() <= 1.001 * BIT);
        let error = (0..N).map(|i| (f64::from(unit[i]) - v[i] as f64 / length / BIT).abs());
        Ok(error.fold(0.0, f64::max))
    }

    proptest! {
        #![proptest_config(ProptestConfig { cases: 100_000, failure_persistence: None, ..ProptestConfig::default() })]
        #[test]
        fn unit_vectors_are_within_2_5_of_2_pow_minus_30_in_100_000_cases(v: [i64; 4], zeros in 0u32..64, some in 0usize..5) {
            let v: [i64; 4] = core::array::from_fn(|i| if i == some { 0 } else { v[i] >> zeros });
            let worst = check(v)?.max(check([v[0], v[1], v[2]])?);
            prop_assert!(worst <= 2.5, "{worst}");
        }
    }

    #[test]
    fn the_longest_and_the_shortest_vectors_are_normalized() {
        assert_eq!(normalized([0; 3]), None);
        assert_eq!(normalized([i64::MIN, 0, 0]), Some([-ONE, 0, 0]));
        assert_eq!(normalized([0, 1, 0]), Some([0, ONE, 0]));
        assert_eq!(normalized([i64::MIN; 4]), Some([-ONE / 2; 4]));
        assert_eq!(normalized([i64::MAX; 4]), Some([ONE / 2; 4]));
    }
}
