//! The depth test along a span: which of its pixels are seen, as runs.
//!
//! - In: stored depths, and near/w at the first pixel with its step.
//! - Out: the next run of pixels that pass, whose depths are stored.
//! - Assumes: near/w stays within 0 … 2³¹ along the span.
//!
//! The loops know nothing of colours, and what makes colours knows nothing of depth.

use crate::frame::DepthFormat;
use crate::num::U1F31;
use core::ops::Range;

/// Tests depth up to the first pixel that fails behind one that passes; returns the run of those that pass, and how many were
/// tested.
#[inline(never)]
pub(crate) fn visible<D: DepthFormat>(
    depth: &mut [D::Word],
    near_w: u32,
    step: i32,
) -> (Range<usize>, usize) {
    let last = near_w.wrapping_add_signed(step.wrapping_mul(depth.len() as i32 - 1));
    // It is linear in between.
    let [start, end] = if near_w.min(last) >> 15 != 0 {
        first_run(depth, near_w, step, D::test_small)
    } else {
        first_run_far_away::<D>(depth, near_w, step)
    };
    (start..end, (end + 1).min(depth.len()))
}

#[cold]
#[inline(never)]
fn first_run_far_away<D: DepthFormat>(depth: &mut [D::Word], near_w: u32, step: i32) -> [usize; 2] {
    first_run(depth, near_w, step, D::test)
}

/// One loop looks for a pixel that passes and one for a pixel that does not: they know nothing of colours, and colours nothing
/// of depth.
#[inline(always)]
fn first_run<W>(
    depth: &mut [W],
    mut near_w: u32,
    step: i32,
    test: impl Fn(&mut W, U1F31) -> bool,
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
    let behind = depth.get_mut(start + 1..).unwrap_or_default();
    let passed = passing(behind, near_w, step, test);
    [start, (start + 1 + passed).min(depth.len())]
}

/// How many pixels pass up to the first that does not. Out of line on Armv6-M, where it needs all registers: 8 cycles a pixel, not 14.
#[cfg_attr(all(target_arch = "arm", not(target_has_atomic = "32")), inline(never))]
#[cfg_attr(not(all(target_arch = "arm", not(target_has_atomic = "32"))), inline)]
fn passing<W>(depth: &mut [W], mut near_w: u32, step: i32, test: impl Fn(&mut W, U1F31) -> bool) -> usize {
    let mut passes = |stored: &mut W, step: i32| {
        let passes = test(stored, U1F31::from_bits(near_w));
        near_w = near_w.wrapping_add_signed(step);
        passes
    };
    let (blocks, rest) = depth.as_chunks_mut::<8>();
    let tested = 8 * blocks.len();
    for (n, block) in blocks.iter_mut().enumerate() {
        // Unknown, so that not all of its multiples are kept in memory.
        let step = core::hint::black_box(step);
        for (i, stored) in block.iter_mut().enumerate() {
            if !passes(stored, step) {
                return 8 * n + i;
            }
        }
    }
    tested + rest.iter_mut().position(|stored| !passes(stored, step)).unwrap_or(rest.len())
}
