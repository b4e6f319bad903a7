//! Scales: from literals, products and quotients, and the error of a number that is none.

use crate::num::{U10F22, bits_or_max};
use core::fmt;

/// `None` for a number that is none, below 0 or too large.
pub(super) const fn scale_of(value: f32) -> Option<U10F22> {
    let bits = bits_or_max(value, 22);
    if value < 0.0 || bits > u32::MAX as i64 { None } else { Some(U10F22::from_bits(bits as u32)) }
}

pub(super) const fn scale_of_bits(bits: u64) -> U10F22 {
    U10F22::from_bits(if bits > u32::MAX as u64 { u32::MAX } else { bits as u32 })
}

/// A length of 22 fraction bits, below 2³⁴, times a scale: rounded, saturated.
pub(super) const fn product(length: u64, scale: u32) -> U10F22 {
    // A length of more than 32 bits has two to spare.
    let (length, shift) = if length <= u32::MAX as u64 { (length, 22) } else { (length >> 2, 20) };
    // Below 2⁶⁴ with the rounding too: (2³² − 1)² + 2²¹.
    scale_of_bits((length * scale as u64 + (1 << (shift - 1))) >> shift)
}

/// `dividend` · 2^`exponent` / `divisor`, which has at most 48 bits, as bits of a scale: within 2⁻³⁰ of itself, rounded, saturated.
pub(super) const fn quotient(dividend: u64, divisor: u64, exponent: i32) -> U10F22 {
    if dividend == 0 {
        return U10F22::ZERO;
    } else if divisor == 0 {
        return U10F22::MAX;
    }
    let (up, down) = (dividend.leading_zeros(), 32u32.saturating_sub(divisor.leading_zeros()));
    // 31 bits or more, times 2^−shift.
    let ratio = (dividend << up) / (divisor >> down);
    let shift = up as i32 + down as i32 - exponent;
    if shift > 64 {
        U10F22::ZERO
    } else if shift > 0 {
        scale_of_bits((ratio >> (shift - 1)).saturating_add(1) >> 1)
    } else if shift > -32 && ratio <= u32::MAX as u64 {
        scale_of_bits(ratio << -shift)
    } else {
        U10F22::MAX
    }
}

/// A scale that a [`Pose`](crate::Pose) cannot have: it is not a number of 0 or more and below 1024.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ScaleError {
    /// What was given.
    pub scale: f32,
}

impl fmt::Display for ScaleError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "the scale of a pose is not a number of 0 or more and below 1024: {}", self.scale)
    }
}

impl core::error::Error for ScaleError {}
