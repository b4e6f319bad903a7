//! What perspective hands to fills: what attributes are made of along a part of a row.
//!
//! - In: how w changes along a part of a row, and a line in t for each attribute.
//! - Out: t at a pixel, or for a chord of pixels; with it attributes.
//! - Assumes: w is at least 1/8 (in the exact form ½). In chords at most 127 pixels follow the first, in the general
//!   forms 63: so t fits 16 bits.
//!
//! w is q divided by the greatest q of the part, which is at the *near* end. t is 1/w, or n/w, n being the number of
//! pixels from the near end. [`perspective`](super::perspective) says why.

use super::inverses::{ONE_LOG2, exact_inverse, inverse};
use super::units::Form;
use crate::num::mul_16;
use crate::raster::{ATTRIBUTES, short_inverse, towards_zero};

/// Attributes along a part of a row: `at` + t · `slope`, with t = 1/w or n/w as the form has it.
///
/// Of a texture that repeats, and of colours, they are modulo 2³²: see [`Units`](super::units::Units). In the general
/// form t · `slope` is shifted right by `down`. Of a straight part `at` is at the first pixel and `slope` the step,
/// both I16F16.
#[derive(Debug, Default)]
// In this order, so that bytes lie where short instructions reach.
#[repr(C)]
pub struct Curve {
    pub(crate) down: [u8; ATTRIBUTES],
    /// How far the left pixel is from the near end, and by how much the next is farther: 1 or −1. (In 8 bits each: a curve is on the
    /// stack while pixels are drawn.)
    pub(super) n: u8,
    pub(super) n_step: i8,
    /// The leading zeros of q at the last division, which those at the next are close to. (It fills a gap.)
    pub(super) zeros: u8,
    pub(crate) lines: [Linear; ATTRIBUTES],
    /// w at the left pixel, 32 fraction bits (1 is `u32::MAX`), and its step to the right, which wraps.
    pub(crate) w: u32,
    pub(crate) w_step: u32,
}

/// An attribute along a part of a row: linear in t. `at` is its value at t = 0, and `slope` its change over a unit of
/// t, with 13 fraction bits in 1/w, 7 in n/w, and 9 in the n/w of `Exact`.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Linear {
    pub(crate) at: u32,
    pub(crate) slope: i32,
}

impl Linear {
    /// At t.
    #[inline(always)]
    pub(crate) fn value(self, t: u32) -> u32 {
        self.at.wrapping_add(t.wrapping_mul(self.slope as u32))
    }
}

impl Linear {
    /// Turned round: all bits of its values inverted.
    #[inline(always)]
    pub(crate) fn turned(self) -> Self {
        Self { at: !self.at, slope: self.slope.wrapping_neg() }
    }
}

impl Curve {
    /// How far the left pixel is from the near end, and by how much the next is farther, which may wrap: 1 or −1.
    #[inline(always)]
    pub(crate) fn distances(&self) -> (u32, u32) {
        (self.n.into(), self.n_step as u32)
    }

    /// Sets these for a part of so many steps, at most [`MOST_IN_CHORDS`]; of more they are of no use.
    #[inline(always)]
    pub(super) fn set_distances(&mut self, rises: bool, steps: u32) {
        (self.n, self.n_step) = if rises { (steps as u8, -1) } else { (0, 1) };
    }

    /// Goes on by so many pixels.
    #[inline]
    pub(crate) fn go_on(&mut self, count: u32) {
        self.w = self.w.wrapping_add(count.wrapping_mul(self.w_step));
        let (n, n_step) = self.distances();
        self.n = n.wrapping_add(count.wrapping_mul(n_step)) as u8;
    }

    /// Makes w 1 at the near end, which is the right one if q rises.
    #[inline(always)]
    pub(super) fn set_w(&mut self, rises: bool, w_step: u32, steps: u32) {
        (self.w, self.w_step) = if rises {
            (u32::MAX.wrapping_sub(w_step.wrapping_mul(steps)), w_step)
        } else {
            (u32::MAX, 0u32.wrapping_sub(w_step))
        };
    }
}

/// The fraction bits of n/w in chords, and of the general form.
pub(crate) const CHORD_LOG2: u32 = 7;
/// Those of the general form in [`Exact`](super::Exact).
const EXACT_LOG2: u32 = 9;
/// The steps of a chord.
pub(crate) const CHORD: u32 = 8;
/// The most steps in chords, for which n/w has room in 16 bits.
pub(crate) const MOST_IN_CHORDS: u32 = 127;
/// The fraction bits of n/w.
#[inline]
pub(crate) fn fraction_bits(form: Form) -> u32 {
    if form == Form::Exact { EXACT_LOG2 } else { CHORD_LOG2 }
}

/// n/w, with as many fraction bits as the form has.
#[inline(always)]
pub(crate) fn distance(form: Form, w: u32, n: u32) -> u32 {
    match form {
        Form::Exact => n.wrapping_mul(exact_inverse(w)) >> (16 - EXACT_LOG2),
        _ => n.wrapping_mul(inverse(w)) >> (ONE_LOG2 - CHORD_LOG2),
    }
}

/// t at one pixel after another: 1/w, or with `CHORDS` n/w, as chords have it.
pub(crate) struct Ts<const CHORDS: bool> {
    w: u32,
    w_step: u32,
    n: u32,
    n_step: u32,
}

impl<const CHORDS: bool> Ts<CHORDS> {
    #[inline(always)]
    pub(crate) fn new(curve: &Curve) -> Self {
        let (w, w_step, (n, n_step)) = (curve.w, curve.w_step, curve.distances());
        Self { w, w_step, n, n_step }
    }

    #[inline(always)]
    pub(crate) fn next(&mut self) -> u32 {
        let t = if CHORDS { distance(Form::Modular, self.w, self.n) } else { inverse(self.w) };
        (self.w, self.n) = (self.w.wrapping_add(self.w_step), self.n.wrapping_add(self.n_step));
        t
    }
}

/// The chords of a curve, one after another.
pub(crate) struct Chords {
    w: u32,
    w_step: u32,
    n: u32,
    n_step: u32,
    t: u32,
}

impl Chords {
    #[inline(always)]
    pub(crate) fn new(curve: &Curve) -> Self {
        let (w, w_step, (n, n_step)) = (curve.w, curve.w_step, curve.distances());
        Self { w, w_step, n, n_step, t: distance(Form::Modular, w, n) }
    }

    /// n/w where a chord begins, with 7 fraction bits, and its step over a pixel with 13. It is [`CHORD`] steps long.
    #[inline(always)]
    pub(crate) fn next(&mut self) -> (u32, u32) {
        let (t, rise) = self.rise(CHORD);
        (t, (rise << 3) as u32)
    }

    /// The last one, of fewer steps, its step cut towards zero.
    #[inline(always)]
    pub(crate) fn last(&mut self, steps: u32) -> (u32, u32) {
        let (t, rise) = self.rise(steps);
        (t, towards_zero(mul_16(rise << 6, short_inverse(steps as i32))) as u32)
    }

    #[inline(always)]
    fn rise(&mut self, steps: u32) -> (u32, i32) {
        let t = self.t;
        self.w = self.w.wrapping_add(self.w_step.wrapping_mul(steps));
        self.n = self.n.wrapping_add(self.n_step.wrapping_mul(steps));
        self.t = distance(Form::Modular, self.w, self.n);
        (t, self.t.wrapping_sub(t) as i32)
    }
}
