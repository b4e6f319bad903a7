//! What is visible of a triangle, run by run.
//!
//! - In: a cover, and what draws a run of pixels.
//! - Out: what the runs draw, and depths where the triangle is in front, if they are stored.
//! - Assumes: no pixel of a run is left out.
//!
//! Each row of a triangle is a span of pixels, and what is visible of a span is one run or several.

use super::cover::{Cover, Target};
use super::memory::Memory;
use crate::frame::{DepthFormat, PixelFormat};
use crate::num::IS_ARMV6M;
use crate::raster::{TriangleSetup, first_visible, visible};
use core::hint::black_box;

/// What draws a run of visible pixels from (x, y) on.
pub(super) trait DrawRun<W> {
    type Again<'r>: DrawRun<W>
    where
        Self: 'r;

    fn draw_run(&mut self, x: i32, y: i32, pixels: &mut [W]);

    /// A copy to be lent to a function. What is lent itself has to be read from memory again afterwards: 15 cycles a row on
    /// a Cortex-M0+.
    fn again(&mut self) -> Self::Again<'_>;
}

/// Draws what is visible of each row, and stores its depth if it `STORES`.
#[inline(always)]
pub(super) fn draw_rows<const STORES: bool, F: PixelFormat, D: DepthFormat>(
    cover: Cover<'_, '_, F, D>,
    mut runs: impl DrawRun<F::Word>,
) {
    if D::ALWAYS_PASSES {
        return draw_all(cover, runs);
    }
    let Cover { setup, target } = cover;
    loop {
        // On Armv6-M it is hidden, so that what is in it is read in each row, and not kept on the stack besides: 40 bytes, for 15
        // cycles a row.
        let target = if IS_ARMV6M { black_box(&mut *target) } else { &mut *target };
        let Memory { rows, window, .. } = &mut target.memory;
        let Some((y, start, end)) = rows.next(window) else {
            return;
        };
        if start >= end {
            continue;
        }
        let count = (end - start) as usize;
        // Early or late, as it takes fewer registers.
        let z = || setup.near_w_of(start, y, count);
        let early = IS_ARMV6M.then(z);
        let Some((pixels, depth)) = words(&mut target.memory, [start, y], count) else {
            continue;
        };
        let passed = first_visible::<D, STORES>(depth, early.unwrap_or_else(z));
        if passed == Some(count) {
            runs.draw_run(start, y, pixels);
        } else {
            draw_visible::<STORES, F, D>(&mut runs.again(), setup, target, [start, y], count, passed);
        }
    }
}

/// So many pixels of a row, and their depths.
#[inline(always)]
fn words<'m, P: 'static, Z: 'static>(
    memory: &'m mut Memory<'_, P, Z>,
    [x, y]: [i32; 2],
    count: usize,
) -> Option<(&'m mut [P], &'m mut [Z])> {
    let Memory { origin, width, pixels, depth, .. } = memory;
    let first = origin.wrapping_add((y as usize).wrapping_mul(*width)).wrapping_add(x as usize);
    // So that both are known to be as long.
    let length = pixels.len().min(depth.len());
    let (pixels, depth) = (pixels.get_mut(..length)?, depth.get_mut(..length)?);
    // In two steps: the end of a range is checked more dearly.
    Some((pixels.get_mut(first..)?.get_mut(..count)?, depth.get_mut(first..)?.get_mut(..count)?))
}

/// Draws each row: there are no depths.
#[inline(always)]
fn draw_all<F: PixelFormat, D: DepthFormat>(cover: Cover<'_, '_, F, D>, mut runs: impl DrawRun<F::Word>) {
    let Memory { rows, window, origin, width, pixels, .. } = &mut cover.target.memory;
    let (origin, width) = (*origin, *width);
    rows.each(window, |y, start, end| {
        let first = origin.wrapping_add((y as usize).wrapping_mul(width)).wrapping_add(start as usize);
        let count = (end - start) as usize;
        if let Some(pixels) = pixels.get_mut(first..).and_then(|rest| rest.get_mut(..count)) {
            runs.draw_run(start, y, pixels);
        }
    });
}

/// Draws what is visible of a span of so many pixels, some of which are hidden, run by run. Of its pixels `passed` were tested
/// and are visible, and the next one is hidden; none was tested where it is `None`.
///
/// What it takes it looks up anew: so it is not on the stack twice.
#[inline(never)]
fn draw_visible<const STORES: bool, F: PixelFormat, D: DepthFormat>(
    runs: &mut impl DrawRun<F::Word>,
    setup: &TriangleSetup,
    target: &mut Target<'_, F, D>,
    [mut x, y]: [i32; 2],
    count: usize,
    passed: Option<usize>,
) {
    let (mut near_w, step) = setup.near_w_of(x, y, count);
    let Some((mut pixels, mut depth)) = words(&mut target.memory, [x, y], count) else {
        return;
    };
    let mut run = 0..passed.unwrap_or(0);
    let mut tested = passed.map_or(0, |passed| passed + 1);
    loop {
        let (done, rest) = pixels.split_at_mut(tested.min(pixels.len()));
        if let Some(visible) = done.get_mut(run.clone())
            && !visible.is_empty()
        {
            runs.draw_run(x + run.start as i32, y, visible);
        }
        (pixels, depth) = (rest, depth.get_mut(tested..).unwrap_or_default());
        if depth.is_empty() {
            return;
        }
        x += tested as i32;
        near_w = near_w.wrapping_add_signed(step.wrapping_mul(tested as i32));
        (run, tested) = visible::<D, STORES>(depth, near_w, step);
    }
}
