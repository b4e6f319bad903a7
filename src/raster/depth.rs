//! The depth test along a span: which of its pixels are visible, as runs.
//!
//! - In: stored depths, and near/w (31 fraction bits; greater is nearer) at the first pixel with its step per pixel.
//! - Out: the first run of pixels that pass, their new depths stored if they are to be, and how many pixels were tested to find it.
//! - Assumes: near/w stays within 0 … 2³¹ along the span, that is 0 … 1.
//!
//! A span may have several runs, with hidden pixels between them. The caller shades one run, then asks again with what is left of
//! the span. So a test and a shader are never in one loop, and neither takes registers from the other. (Small triangles are
//! tested and shaded in one loop: see `shade::patch`.)

use crate::frame::{Depth16, DepthFormat, SliceOf};
use crate::num::U1F31;
use core::ops::Range;

/// How many pixels of a span pass before the first that does not; stores their depths if it `STORES`. None are tested where
/// near/w may be below 2⁻¹⁶.
#[inline]
pub(crate) fn first_visible<D: DepthFormat, const STORES: bool>(
    depth: &mut [D::Word],
    (near_w, step): (u32, i32),
) -> Option<usize> {
    let last = near_w.wrapping_add_signed(step.wrapping_mul(depth.len() as i32 - 1));
    (near_w.min(last) >> 15 != 0).then(|| passing_small::<D, STORES>(depth, near_w, step))
}

/// [`passing`] where near/w is 2⁻¹⁶ or more.
#[inline]
fn passing_small<D: DepthFormat, const STORES: bool>(depth: &mut [D::Word], near_w: u32, step: i32) -> usize {
    match D::in_depth16::<SliceOf<'_>>(depth) {
        Some(depth) if STORES => passing_depth16(depth, near_w, step),
        _ => passing_apart(depth, near_w, step, small::<D, STORES>),
    }
}

/// As [`passing`], stored. Without type parameters, so that it is compiled with this crate, at its level of optimisation and not at that of
/// the program.
#[inline(never)]
fn passing_depth16(depth: &mut [u16], near_w: u32, step: i32) -> usize {
    passing(depth, near_w, step, Depth16::test_and_store_small)
}

/// The test where near/w is 2⁻¹⁶ or more.
#[inline(always)]
fn small<D: DepthFormat, const STORES: bool>(stored: &mut D::Word, near_w: U1F31) -> bool {
    if STORES { D::test_and_store_small(stored, near_w) } else { D::test(stored, near_w) }
}

/// Finds the first run of pixels that pass, and stores their depths if it `STORES`. Stops at the first pixel that fails after one that passed.
/// Returns the run, which is empty and at the end of `depth` if no pixel passes, and how many pixels were tested.
#[inline(never)]
pub(crate) fn visible<D: DepthFormat, const STORES: bool>(
    depth: &mut [D::Word],
    near_w: u32,
    step: i32,
) -> (Range<usize>, usize) {
    let last = near_w.wrapping_add_signed(step.wrapping_mul(depth.len() as i32 - 1));
    // near/w is linear, so the least of it is at an end. From 2⁻¹⁶ on (bit 15) the format's shorter test does.
    let [start, end] = if near_w.min(last) >> 15 != 0 {
        first_run(depth, near_w, step, small::<D, STORES>, |depth, near_w, step, _| {
            passing_small::<D, STORES>(depth, near_w, step)
        })
    } else {
        first_run_far_away::<D, STORES>(depth, near_w, step)
    };
    (start..end, (end + 1).min(depth.len()))
}

/// [`first_run`] where near/w may be below 2⁻¹⁶.
#[cold]
#[inline(never)]
fn first_run_far_away<D: DepthFormat, const STORES: bool>(
    depth: &mut [D::Word],
    near_w: u32,
    step: i32,
) -> [usize; 2] {
    if STORES {
        first_run(depth, near_w, step, D::test_and_store, passing_far_away)
    } else {
        first_run(depth, near_w, step, |stored, near_w| D::test(stored, near_w), passing_far_away)
    }
}

/// The start and the end (exclusive) of the first run. One loop skips pixels that fail, then `passing` counts those that pass.
#[inline(always)]
fn first_run<W, T: Fn(&mut W, U1F31) -> bool>(
    depth: &mut [W],
    mut near_w: u32,
    step: i32,
    test: T,
    passing: impl Fn(&mut [W], u32, i32, T) -> usize,
) -> [usize; 2] {
    let mut start = 0;
    for stored in &mut *depth {
        let passes = test(stored, U1F31::from_bits(near_w));
        near_w = near_w.wrapping_add_signed(step);
        if passes {
            break;
        }
        start += 1;
    }
    let rest = depth.get_mut(start + 1..).unwrap_or_default();
    let passed = passing(rest, near_w, step, test);
    [start, (start + 1 + passed).min(depth.len())]
}

/// [`passing`], out of line on Armv6-M, where it needs all registers: 8 cycles per pixel instead of 14.
#[cfg_attr(all(target_arch = "arm", not(target_has_atomic = "32")), inline(never))]
#[cfg_attr(not(all(target_arch = "arm", not(target_has_atomic = "32"))), inline)]
fn passing_apart<W>(depth: &mut [W], near_w: u32, step: i32, test: impl Fn(&mut W, U1F31) -> bool) -> usize {
    passing(depth, near_w, step, test)
}

/// How many pixels pass before the first that fails.
#[inline(always)]
fn passing<W>(depth: &mut [W], mut near_w: u32, step: i32, test: impl Fn(&mut W, U1F31) -> bool) -> usize {
    let mut passes = |stored: &mut W, step: i32| {
        let passes = test(stored, U1F31::from_bits(near_w));
        near_w = near_w.wrapping_add_signed(step);
        passes
    };
    let (blocks, rest) = depth.as_chunks_mut::<8>();
    let tested = 8 * blocks.len();
    for (n, block) in blocks.iter_mut().enumerate() {
        // Hidden from the optimizer, which would compute the multiples of the step before the loop and keep them in memory.
        let step = core::hint::black_box(step);
        for (i, stored) in block.iter_mut().enumerate() {
            if !passes(stored, step) {
                return 8 * n + i;
            }
        }
    }
    tested + rest.iter_mut().position(|stored| !passes(stored, step)).unwrap_or(rest.len())
}

/// As [`passing`], not unrolled: 400 bytes less.
#[inline(always)]
fn passing_far_away<W>(
    depth: &mut [W],
    mut near_w: u32,
    step: i32,
    test: impl Fn(&mut W, U1F31) -> bool,
) -> usize {
    let mut passed = 0;
    for stored in depth {
        if !test(stored, U1F31::from_bits(near_w)) {
            break;
        }
        near_w = near_w.wrapping_add_signed(step);
        passed += 1;
        core::hint::black_box(());
    }
    passed
}
