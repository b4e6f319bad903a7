//! Where a run of a texture with borders enters another [cell](super::border).
//!
//! - In: a coordinate's line along a run, and a pixel of it.
//! - Out: the line in the cell that the pixel is in, and for how many pixels.
//! - Assumes: along a straight run a coordinate changes by less than 2³¹. Along a curved one it is monotonic.
//!
//! What decides which cell a pixel is in are the very coordinates that its texel is fetched at. A straight line's border is found by
//! one quotient, a curve's by bisection.

use super::border::{Border, Side};
use super::curve::{Curve, Linear, distance};
use super::inverses::inverse;
use super::units::Form;
use crate::num::IS_ARMV6M;
use core::hint::black_box;

/// How a curved run follows perspective.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Way {
    Table,
    Chords,
}

impl Way {
    /// What a line's slope is to be multiplied by, n pixels after the beginning.
    #[inline(always)]
    pub(super) fn t(self, curve: &Curve, n: u32) -> u32 {
        let w = curve.w.wrapping_add(n.wrapping_mul(curve.w_step));
        match self {
            Self::Table => inverse(w),
            Self::Chords => {
                let (first, step) = curve.distances();
                distance(Form::Modular, w, first.wrapping_add(n.wrapping_mul(step)))
            }
        }
    }
}

/// Where a part of a curve begins and where the curve ends, in t.
pub(super) struct Ends {
    pub(super) t: u32,
    pub(super) last: u32,
    pub(super) way: Way,
}

/// Makes a straight line that of the cell that it is in, and says for how many pixels, at most `most`. Out of line on Armv6-M only: on a
/// Cortex-M4 it takes 20 cycles less for each border otherwise.
#[cfg_attr(all(target_arch = "arm", not(target_has_atomic = "32")), inline(never))]
#[cfg_attr(not(all(target_arch = "arm", not(target_has_atomic = "32"))), inline(always))]
pub(super) fn enter_straight<B: Border>(side: &Side, line: &mut Linear, most: u32) -> u32 {
    let slope = line.slope;
    let (seen, ahead) = B::enter(line.at, slope < 0, side);
    *line = seen.of(*line);
    pixels_up_to(ahead, slope.unsigned_abs(), most)
}

/// Makes a part's line that of the cell that it begins in, and says for how many pixels, at most `most`.
#[inline(never)]
pub(super) fn enter_curved<B: Border>(
    side: &Side,
    curve: &Curve,
    part: &mut Curve,
    i: usize,
    (ends, most): (&Ends, u32),
) -> u32 {
    let line = curve.lines[i & 1];
    let [at, last] = [line.value(ends.t), line.value(ends.last)];
    let falls = (last as i32) < at as i32;
    let (seen, ahead) = B::enter(at, falls, side);
    part.lines[i & 1] = shifted_up(seen.of(line), side.spare_bits());
    if ahead > (last as i32).abs_diff(at as i32) {
        return most;
    }
    // Turned round, so that it rises.
    let (line, at) = if falls { (line.turned(), !at) } else { (line, at) };
    let leaves = |t: u32| line.value(t).wrapping_sub(at) >= ahead;
    if ends.way == Way::Chords {
        first_of(0, most, |n| leaves(Way::Chords.t(part, n)))
    } else {
        first_of(0, most, |n| leaves(Way::Table.t(part, n)))
    }
}

/// The first n for which something is so, which it is not at `last_not`, and is at `end` − 1.
#[inline(always)]
fn first_of(mut last_not: u32, end: u32, is_so: impl Fn(u32) -> bool) -> u32 {
    let mut first = end - 1;
    while first - last_not > 1 {
        let middle = (last_not + first) / 2;
        if is_so(middle) {
            first = middle;
        } else {
            last_not = middle;
        }
    }
    first
}

/// How many pixels it takes to go so far at such a step, at most `most`, and at least one.
#[inline(always)]
fn pixels_up_to(far: u32, step: u32, most: u32) -> u32 {
    if far > step.wrapping_mul(most.wrapping_sub(1)) {
        return most;
    }
    if IS_ARMV6M { divided_up(far, step) } else { far.div_ceil(step.max(1)) }
}

/// The quotient of two numbers that are not 0 and below 2³⁰, rounded up, without an instruction that divides: by multiples of the divisor
/// by powers of four, up, and of two, down again.
#[inline(always)]
fn divided_up(dividend: u32, divisor: u32) -> u32 {
    let (mut multiple, mut times) = (divisor, 1);
    while multiple < dividend {
        (multiple, times) = (multiple << 2, times << 2);
        // Not unrolled.
        black_box(());
    }
    let (mut rest, mut quotient) = (dividend, 1);
    while times > 1 {
        (multiple, times) = (multiple >> 1, times >> 1);
        if multiple < rest {
            (rest, quotient) = (rest - multiple, quotient + times);
        }
    }
    quotient
}

#[inline(always)]
pub(super) fn shifted_up(line: Linear, up: u32) -> Linear {
    Linear { at: line.at << (up & 31), slope: line.slope << (up & 31) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #![proptest_config(ProptestConfig { cases: 4_000, failure_persistence: None, ..ProptestConfig::default() })]
        #[test]
        fn quotients_are_rounded_up_to_at_least_1_and_at_most_what_there_is(
            far in 1..1_u32 << 28, step in 0..1_u32 << 28, most in 1..1024_u32,
        ) {
            let step = step / most;
            let exactly = far.checked_div(step).map_or(most, |_| far.div_ceil(step).min(most));
            prop_assert_eq!(pixels_up_to(far, step, most), exactly);
            prop_assert_eq!(divided_up(far, step.max(1)), far.div_ceil(step.max(1)));
        }
    }
}
