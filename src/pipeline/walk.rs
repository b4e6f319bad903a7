//! Stage 5, along a row: perspective with a proven bound, at nearly affine cost.
//!
//! Along a row u = u₀ + U/q with U and q linear. It is divided every L pixels only. Between two such places, with
//! q = q₀ and q₁ and a rise Δu, the change of u from pixel to pixel is u′ = Δu/L · q₀q₁/q²: known at both ends, and larger by
//! the ratio q₀/q₁ at the one end and smaller by it at the other. So instead of the straight line a **quadratic** is drawn
//! that goes through both ends and bends as much as u does: u″ = (u′₁ − u′₀)/L = −(Δu/L)·(q′/q₀ + q′/q₁). It is drawn in
//! straight pairs of pixels, each step two u″ longer than the last: one addition for two pixels, and for an even L as exact. At
//! a fraction τ of the way it is off by
//!
//! ```text
//! error / u′ = L·τ(1 − τ)·(q₁ − q₀)·q²/(q₀q₁)·(1/q − ½/q₀ − ½/q₁)   pixels,
//! ```
//!
//! a displacement on the screen, whatever the texture: about 0.048·L³·(q′/q)², where the straight line is off by
//! L²/4·|q′/q|. The [`QuarterPixel`](super::QuarterPixel) quality asks for at most 3/16 of a pixel and leaves 1/16 to rounding: a division every 8
//! pixels where q changes by 1/12 of itself a pixel (a straight line could be 3 long), every 16 where it is 1/33 (5). Floors
//! seen level and walls seen straight (q′ ≈ 0) are one straight run with one division.

use super::attribute::{Attribute, short_inverse, towards_zero};
use super::fill::Fill;
use super::shade::Quality;
use super::span::Span;
use crate::math::recip::{Reciprocal, short};
use crate::num::{mul_16, mul_16_signed, normalised};

/// How far apart divisions may be: the longest sub-span, in pixels, where q/|q′| is at least `LEAST[length]` / 16 pixels
/// all along: the error of the quadratic's pairs stays below 3/16 pixel, and of those beyond 16 pixels, whose steps are rounded more often,
/// below 1/8.
const LEAST: [u32; LONGEST + 1] = [
    0, 0, 73, 78, 78, 138, 138, 193, 193, 247, 262, 334, 335, 426, 427, 517, 530, 755, 773, 879, 901, 1023,
    1028, 1168, 1183,
];
/// The longest sub-span.
pub(super) const LONGEST: usize = 24;

/// The longest sub-span by |q′|/q at its beginning in 1/256: where q rises, and where it falls.
static LENGTHS: [[u8; 128]; 2] = [lengths(false), lengths(true)];

const fn lengths(falling: bool) -> [u8; 128] {
    let mut lengths = [1; 128];
    let mut i = 0;
    while i < 128 {
        // Along a row q/|q′| changes by one pixel a pixel.
        let at_least = 16 * 256 / (i as u32 + 1);
        let mut length = LONGEST;
        while length > 1 && LEAST[length] + if falling { 16 * length as u32 } else { 0 } > at_least {
            length -= 1;
        }
        lengths[i] = length as u8;
        i += 1;
    }
    lengths
}

/// A pixel of a span, and what is linear along the row from there.
struct Walk<'a, const N: usize> {
    attributes: &'a [Attribute; N],
    q: u32,
    q_step: i32,
    q_min: u32,
    values: [i32; N],
    steps: [i32; N],
    /// The leading zeros of q at the last division, which those at the next are close to.
    zeros: u32,
}

impl<'a, const N: usize> Walk<'a, N> {
    #[inline]
    fn new(span: &Span<'a>, attributes: &'a [Attribute; N]) -> Self {
        let setup = span.setup;
        let (q, q_step) = setup.at(&setup.q, span.x, span.y);
        let mut walk =
            Self { attributes, q, q_step, q_min: setup.q_min, values: [0; N], steps: [0; N], zeros: 1 };
        for (i, attribute) in attributes.iter().enumerate() {
            let (value, step) = setup.at(&attribute.plane, span.x, span.y);
            walk.values[i] = value as i32;
            walk.steps[i] = step;
        }
        walk
    }

    #[inline]
    fn advance(&mut self, pixels: i32) {
        self.q = self.q.wrapping_add_signed(self.q_step.wrapping_mul(pixels));
        for (value, step) in self.values.iter_mut().zip(self.steps) {
            *value = value.wrapping_add(step.wrapping_mul(pixels));
        }
    }

    /// q with what rounding errors took below the least or above the greatest value at a corner taken away.
    #[cold]
    #[inline(never)]
    fn bounded(&self) -> u32 {
        if self.q.wrapping_sub(self.q_min) > 3 << 30 { self.q_min } else { self.q.min(i32::MAX as u32) }
    }

    /// q's mantissa, 2³¹ … 2³² − 1; sets `zeros`, 1 … 31.
    #[inline]
    fn normalised(&mut self) -> u32 {
        let mantissa = self.q << self.zeros;
        // Most often q has as many leading zeros as at the last division. Armv6-M has no instruction that counts them.
        if (mantissa as i32) < 0 && mantissa >> self.zeros == self.q {
            return mantissa;
        }
        let q = if self.q as i32 <= 0 { self.bounded() } else { self.q };
        let mantissa;
        (mantissa, self.zeros) = normalise(q);
        mantissa
    }

    /// The attributes here, I16F16, by a division of 20 bits.
    #[inline]
    fn exact(&mut self) -> [i32; N] {
        let mantissa = self.normalised();
        let q = Reciprocal::coarse_normalised(mantissa, self.zeros);
        core::array::from_fn(|i| self.attributes[i].exact(self.values[i], q))
    }

    /// Whether q is so nearly the same for some pixels that attributes are linear: (length)²·|q′|/q ≤ 1/8, the error of going
    /// along the tangent.
    #[inline]
    fn is_level(&self, pixels: i32) -> bool {
        let rise = self.q_step.unsigned_abs();
        rise < 1 << 12 && rise * (pixels * pixels) as u32 <= self.least(pixels) >> 3
    }

    /// The least q of the next pixels.
    #[inline]
    fn least(&self, pixels: i32) -> u32 {
        if self.q_step < 0 { self.q.wrapping_add_signed(self.q_step.wrapping_mul(pixels)) } else { self.q }
    }
}

/// Out of line on Armv6-M, where it takes half as long as the compiler's routine: see [`normalised`].
#[cfg_attr(all(target_arch = "arm", not(target_has_atomic = "32")), inline(never))]
#[cfg_attr(not(all(target_arch = "arm", not(target_has_atomic = "32"))), inline)]
fn normalise(q: u32) -> (u32, u32) {
    normalised(q)
}

impl Span<'_> {
    /// Fills pixels from this span's first one, of a straight triangle.
    #[inline(never)]
    pub(crate) fn fill_straight<const N: usize, L: Fill<N>>(&self, mut pixels: &mut [L::Word], fill: &L) {
        let setup = self.setup;
        let Some(attributes) = setup.attributes.first_chunk::<N>() else {
            return;
        };
        let (mut x, mut left) = (self.x, pixels.len() as i32 - 1);
        'run: loop {
            let (mut at, mut step) = ([0; N], [0; N]);
            for (i, attribute) in attributes.iter().enumerate() {
                let plane = setup.at(&attribute.plane, x, self.y);
                if setup.leans && left > 0 && attribute.leaves(plane, left) {
                    // Up to where it leaves its range an exact attribute stays so.
                    left >>= 1;
                    continue 'run;
                }
                (at[i], step[i]) = attribute.along(plane, left);
            }
            let count = left + 1;
            let Some((run, rest)) = core::mem::take(&mut pixels).split_at_mut_checked(count as usize) else {
                return;
            };
            fill.run_long(run, at, step);
            if rest.is_empty() {
                return;
            }
            (x, left, pixels) = (x + count, rest.len() as i32 - 1, rest);
        }
    }

    /// Likewise of one that is not straight, run by run.
    ///
    /// Not inlined: a shader that chooses between loops would need the stack of all of them.
    #[inline(never)]
    pub(crate) fn fill<Q: Quality, const N: usize, L: Fill<N>>(&self, mut pixels: &mut [L::Word], fill: &L) {
        let setup = self.setup;
        let Some(attributes) = setup.attributes.first_chunk::<N>() else {
            return;
        };
        let mut left = pixels.len() as i32 - 1;
        if Q::EVERY_PIXEL && setup.sliver {
            for (x, pixel) in (self.x..).zip(pixels) {
                *pixel = fill.pixel(setup.resolve_in_sliver(attributes, x, self.y));
            }
            return;
        }
        let mut walk = Walk::new(self, attributes);
        if Q::EVERY_PIXEL {
            for pixel in pixels {
                *pixel = fill.pixel(walk.exact());
                walk.advance(1);
            }
            return;
        }
        if walk.is_level(left) {
            let (reciprocal, zeros) = (short(walk.normalised()), walk.zeros);
            let (mut at, mut step) = ([0; N], [0; N]);
            for (i, attribute) in attributes.iter().enumerate() {
                (at[i], step[i]) = attribute.level(walk.values[i], walk.steps[i], reciprocal, zeros, left);
            }
            return fill.run_long(pixels, at, step);
        }
        // Where q changes by half of itself within a pixel, at every pixel.
        let least = walk.least(left);
        let longest = if walk.q_step.unsigned_abs() > least >> 1 { 1 } else { fill.longest() };
        let lengths = &LENGTHS[usize::from(walk.q_step < 0)];
        let (mut at, mut slope, mut length) = ([0; N], 0, 0);
        loop {
            let mantissa = walk.normalised();
            let (reciprocal, zeros) = (short(mantissa), walk.zeros);
            // 16 bits times 17: below 2³¹ unless q changes by half of itself within a pixel. 15 fraction bits.
            let next_slope = ((walk.q_step << zeros) >> 16).wrapping_mul(reciprocal as i32) >> 17;
            let mut next: [i32; N] =
                core::array::from_fn(|i| attributes[i].divided(walk.values[i], reciprocal, zeros));
            if length == 0 && left == 0 {
                let at = core::array::from_fn(|i| next[i] << attributes[i].scale_log2);
                return pixels.iter_mut().for_each(|pixel| *pixel = fill.pixel(at));
            }
            for i in 0..N {
                next[i] = fill.in_units(i, next[i], attributes[i].scale_log2);
            }
            if length > 0 {
                left -= length;
                let bending = -(slope + next_slope);
                let inverse = short_inverse(length);
                let (mut step, mut bend) = ([0; N], [0; N]);
                for i in 0..N {
                    let rise = next[i].wrapping_sub(at[i]);
                    (step[i], bend[i]) = quadratic(rise, length, inverse, bending);
                }
                let count = (length + i32::from(left == 0)) as usize;
                let Some((run, rest)) = core::mem::take(&mut pixels).split_at_mut_checked(count) else {
                    return;
                };
                fill.bent(run, at, step, bend);
                if left == 0 {
                    return;
                }
                pixels = rest;
            }
            (at, slope) = (next, next_slope);
            let by_slope = lengths[(slope.unsigned_abs() >> 7).min(127) as usize];
            length = i32::from(by_slope).min(longest).min(left);
            walk.advance(length);
        }
    }
}

/// The first step, and what is added to it every second pixel, on pairs of equal steps along the quadratic through both ends on
/// which u′ changes as much as it should from one to the other, by −(u₁ − u₀)/L · (q′/q₀ + q′/q₁) · L. All is cut towards zero, so
/// that no pixel lies beyond the end.
#[inline]
fn quadratic(rise: i32, length: i32, inverse: u32, bending: i32) -> (i32, i32) {
    let mean = towards_zero(mul_16(rise, inverse));
    let bend = towards_zero(mul_16_signed(mean << 2, bending));
    // Pairs before the last have added 0 + 2 + 4 …, and a single step behind them half as much as a pair.
    let bends = ((length - 1) * (length - 1)) >> 2;
    let straight = rise.wrapping_sub(bend.wrapping_mul(bends));
    (towards_zero(mul_16(straight, inverse)), bend)
}

#[cfg(test)]
#[expect(clippy::float_arithmetic, reason = "the truth in f64")]
mod tests {
    use super::*;
    use std::println;

    /// The largest displacement over `length` pixels in which q goes from `q0` to `q1`, at its pixels.
    fn displacement(length: usize, q0: f64, q1: f64) -> f64 {
        let n = length as f64;
        // u goes from 0 to 1, in pairs of equal steps.
        let bend = 2.0 * (q0 / q1 - q1 / q0) / (n * n);
        let bends: usize = (0..length).map(|x| x / 2).sum();
        let first = (1.0 - bend * bends as f64) / n;
        let (mut u, mut worst) = (0.0, 0f64);
        for x in 0..=length {
            let q = q0 + (q1 - q0) * x as f64 / n;
            let (exact, derivative) = (x as f64 / n * q1 / q, q0 * q1 / (q * q) / n);
            worst = worst.max((u - exact).abs() / derivative);
            u += first + bend * (x / 2) as f64;
        }
        worst
    }

    #[test]
    fn the_longest_sub_spans_displace_by_three_sixteenths_of_a_pixel() {
        for (length, &least) in LEAST.iter().enumerate().skip(2) {
            let least_px = f64::from(least) / 16.0;
            let mut worst = 0f64;
            for times in 0..200 {
                // From the least q/|q′| allowed to 20 times that.
                let least = least_px * 1.015_f64.powi(times);
                let end = 1.0 + length as f64 / least;
                let found = displacement(length, 1.0, end).max(displacement(length, end, 1.0));
                let bound = if length > 16 { 2.0 / 16.0 } else { 3.0 / 16.0 };
                assert!(found <= bound, "{length} pixels at {least}: {found}");
                worst = worst.max(found);
            }
            println!("{length} pixels at q/|q′| ≥ {least_px} px: {worst:.4}");
            // No shorter than the bound asks for; the shortest are bounded by monotony.
            let is_tight = worst > if length > 16 { 0.12 } else { 0.18 };
            assert!(length < 4 || is_tight || least - LEAST[length - 1] <= 1, "{length}: {worst}");
        }
    }

    #[test]
    fn lengths_keep_q_above_the_least_all_along() {
        for (falling, lengths) in LENGTHS.iter().enumerate() {
            for (i, &length) in lengths.iter().enumerate().filter(|(_, length)| **length > 1) {
                let at_least = 256.0 / (i + 1) as f64 - (falling * usize::from(length)) as f64;
                assert!(at_least >= f64::from(LEAST[usize::from(length)]) / 16.0, "{i}: {length}");
            }
        }
    }
}
