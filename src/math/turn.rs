//! Binary angles and their sines.

use crate::num::{I2F14, bits_from_f32};
use core::ops::{Add, AddAssign, Mul, Neg, Sub, SubAssign};
use micromath::F32Ext;

/// An angle in 1/65536 of a full turn; it wraps by itself.
///
/// ```
/// use fixel::Turn;
/// assert_eq!(Turn::from_degrees(-90), Turn::from_degrees(270));
/// assert_eq!(Turn::from_degrees(30).sin(), 0.5);
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct Turn(u16);

const QUARTER: u16 = 1 << 14;
/// sin(πx/2) is about x + x·(E₀ − E₁x² + E₂x⁴ − E₃x⁶) for x = 0 … 1, a part of a quarter turn. These are the E, the first with 19
/// fraction bits, the others with 16. Of all near the series' own they have the least error with the arithmetic of [`Turn::sin`].
const SERIES: [u32; 4] = [299_268, 42_333, 5210, 286];

impl Turn {
    /// No turn.
    pub const ZERO: Self = Self(0);

    /// From 1/65536 of a turn.
    #[must_use]
    pub const fn from_raw(raw: u16) -> Self {
        Self(raw)
    }

    /// 1/65536 of a turn.
    #[must_use]
    pub const fn raw(self) -> u16 {
        self.0
    }

    /// From whole degrees, rounded to the nearest 1/65536 of a turn.
    #[must_use]
    pub const fn from_degrees(degrees: i32) -> Self {
        let degrees = degrees.rem_euclid(360) as u32;
        Self(((degrees * 65536 + 180) / 360) as u16)
    }

    /// From radians, rounded to the nearest 1/65536 of a turn; 0 for NaN and infinities.
    ///
    /// A convenience for set-up: it costs a few soft-float calls.
    #[must_use]
    #[expect(clippy::float_arithmetic, reason = "set-up convenience")]
    pub fn from_radians(radians: f32) -> Self {
        if !radians.is_finite() {
            return Self::ZERO;
        }
        let turns = radians * core::f32::consts::FRAC_1_PI * 0.5;
        let fraction = F32Ext::fract(turns); // towards zero: −1 … 1
        Self(bits_from_f32(fraction, 16) as u16)
    }

    /// The sine, within 0.66 of its last bit (2⁻¹⁴) of the exact one; exact at multiples of a quarter turn.
    // Out of line: whatever turns a pose asks for two.
    #[must_use]
    #[inline(never)]
    pub const fn sin(self) -> I2F14 {
        let folded = self.0 & (2 * QUARTER - 1);
        let folded = if folded > QUARTER { 2 * QUARTER - folded } else { folded } as i32;
        // x has 14 fraction bits, its square 16. No product is longer than 32 bits.
        let square = ((folded * folded) >> 12) as u32;
        let [e0, e1, e2, e3] = SERIES;
        let inner = e1 - ((square * (e2 - ((square * e3) >> 16))) >> 16);
        let more = e0 as i32 - ((square * inner) >> 13) as i32;
        let sine = folded + ((folded * more + (1 << 18)) >> 19);
        I2F14::from_bits(if self.0 < 2 * QUARTER { sine } else { -sine } as i16)
    }

    /// The cosine: the sine a quarter turn on.
    #[must_use]
    pub const fn cos(self) -> I2F14 {
        Self(self.0.wrapping_add(QUARTER)).sin()
    }
}

impl Add for Turn {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self(self.0.wrapping_add(other.0))
    }
}

impl AddAssign for Turn {
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl Sub for Turn {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        Self(self.0.wrapping_sub(other.0))
    }
}

impl SubAssign for Turn {
    fn sub_assign(&mut self, other: Self) {
        *self = *self - other;
    }
}

impl Neg for Turn {
    type Output = Self;
    fn neg(self) -> Self {
        Self(self.0.wrapping_neg())
    }
}

impl Mul<i32> for Turn {
    type Output = Self;
    fn mul(self, times: i32) -> Self {
        Self((i32::from(self.0).wrapping_mul(times)) as u16)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::println;

    #[test]
    fn sine_and_cosine_are_within_0_66_of_a_bit_for_all_65536_angles() {
        let mut worst = 0f64;
        for raw in 0..=u16::MAX {
            let turn = Turn::from_raw(raw);
            let angle = f64::from(raw) / 65536.0 * core::f64::consts::TAU;
            for (ours, exact) in [(turn.sin(), angle.sin()), (turn.cos(), angle.cos())] {
                worst = worst.max((f64::from(ours.to_bits()) - exact * 16384.0).abs());
            }
        }
        println!("sine, cosine: 65536 angles, error within {worst:.3} · 2^-14");
        assert!(worst <= 0.66);
    }

    #[test]
    fn quarters_are_exact() {
        for (degrees, sine) in [(0, 0), (90, 1), (180, 0), (270, -1), (360, 0)] {
            assert_eq!(Turn::from_degrees(degrees).sin(), sine);
            assert_eq!(Turn::from_degrees(degrees - 90).cos(), sine);
        }
    }

    #[test]
    fn radians_round_and_take_anything() {
        assert_eq!(Turn::from_radians(core::f32::consts::FRAC_PI_2), Turn::from_degrees(90));
        assert_eq!(Turn::from_radians(-core::f32::consts::FRAC_PI_2), Turn::from_degrees(270));
        assert_eq!(Turn::from_radians(f32::NAN), Turn::ZERO);
        assert_eq!(Turn::from_radians(f32::INFINITY), Turn::ZERO);
        let _ = Turn::from_radians(f32::MAX);
    }
}
