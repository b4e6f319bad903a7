//! Passes over a run: what words are made of at every pixel, and the words.
//!
//! - In: a run of pixels, and its curve.
//! - Out: t at every pixel, 1/w or n/w, where the next pass finds it; or words.
//! - Assumes: in passes the format's words [keep](PixelFormat::keep) 16 bits.

use super::curve::{Curve, Ts};
use super::inverses::leave;
use crate::frame::PixelFormat;
use core::hint::black_box;

/// Leaves t in the pixels.
#[inline(always)]
pub(super) fn leave_ts<const CHORDS: bool, F: PixelFormat>(pixels: &mut [F::Word], curve: &Curve) {
    if !CHORDS {
        return leave::<F>(pixels, curve.w, curve.w_step);
    }
    let mut ts = Ts::<true>::new(curve);
    for pixel in pixels {
        *pixel = F::keep(ts.next() as u16);
        black_box(());
    }
}

/// Likewise, for loops that share it.
#[inline(never)]
pub(super) fn leave_apart<const CHORDS: bool, F: PixelFormat>(pixels: &mut [F::Word], curve: &Curve) {
    leave_ts::<CHORDS, F>(pixels, curve);
}

/// Words made of t, which a first pass left in the pixels: 1/w takes 8.3 cycles a pixel on a Cortex-M0+, and the second pass 22.9.
#[inline(always)]
pub(super) fn second_pass<F: PixelFormat>(pixels: &mut [F::Word], word: impl Fn(u32) -> F::Word) {
    let (fours, rest) = pixels.as_chunks_mut::<4>();
    for four in fours {
        four.iter_mut().for_each(|pixel| *pixel = word(F::kept(*pixel).into()));
        black_box(());
    }
    for pixel in rest {
        *pixel = word(F::kept(*pixel).into());
        black_box(());
    }
}

/// Both in one loop: with 1/w 15 cycles a pixel on a Cortex-M4, where it is not unrolled.
#[inline(always)]
pub(super) fn at_once<const CHORDS: bool, F: PixelFormat>(
    pixels: &mut [F::Word],
    curve: &Curve,
    word: impl Fn(u32) -> F::Word,
) {
    let mut ts = Ts::<CHORDS>::new(curve);
    for pixel in pixels {
        *pixel = word(ts.next());
        black_box(());
    }
}
