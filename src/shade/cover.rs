//! The pixels that a triangle covers: depth is tested, and what is visible is handed to a fill, run by run.
//!
//! - In: a triangle that is set up, its rows, and the memory of a band.
//! - Out: words and depths where the triangle is in front.
//! - Assumes: the rows lie in the band.
//!
//! A shader says once for all of a triangle what fills it. A small triangle is drawn at one go, see
//! [`patch`](super::patch). Of any other each row is a span of pixels, and what is visible of a span is one run or
//! several.

use super::fill::{Even, Fill, FillRow};
use super::patch::is_small;
use super::perspective::Perspective;
use super::quality::Quality;
use super::quality::sealed::Sealed;
use super::shader::Pixels;
use crate::frame::{DepthFormat, PixelFormat, Window};
use crate::raster::{Rows, TriangleSetup, first_visible, visible};

/// A triangle, and the memory that it is drawn to.
pub(crate) struct Cover<'a, F: PixelFormat, D: DepthFormat> {
    pub(crate) setup: &'a TriangleSetup,
    pub(crate) rows: &'a mut Rows,
    pub(crate) window: &'a Window,
    /// The index of column 0 of row 0 among `pixels`, which wraps as it may lie before them. A row further it is `width` more.
    pub(crate) origin: usize,
    pub(crate) width: usize,
    pub(crate) pixels: &'a mut [F::Word],
    /// Empty if it is never tested.
    pub(crate) depth: &'a mut [D::Word],
}

impl<F: PixelFormat, D: DepthFormat> Sealed for &mut Cover<'_, F, D> {}

impl<F: PixelFormat, D: DepthFormat, Q: Quality> Pixels<F::Word, Q> for &mut Cover<'_, F, D> {
    #[inline]
    fn is_gray(&self) -> bool {
        self.setup.gray
    }

    #[inline]
    fn fill_evenly(self, word: F::Word) {
        self.draw(&Even(word));
    }

    #[inline]
    fn fill<const N: usize, L: Fill<F::Word> + FillRow<N, Word = F::Word>>(self, fill: &L) {
        self.draw(fill);
    }

    #[inline]
    fn fill_rows(self, fill: &dyn Fill<F::Word>) {
        self.draw_rows(fill);
    }
}

impl<F: PixelFormat, D: DepthFormat> Cover<'_, F, D> {
    #[inline]
    fn draw<const N: usize, L: Fill<F::Word> + FillRow<N, Word = F::Word>>(&mut self, fill: &L) {
        if is_small(self.setup, self.rows) {
            return self.draw_small(fill);
        }
        self.draw_rows(fill);
    }

    #[inline(never)]
    fn draw_rows(&mut self, fill: &dyn Fill<F::Word>) {
        let Self { setup, rows, window, origin, width, pixels, depth } = self;
        let (setup, origin, width) = (*setup, *origin, *width);
        let mut line = Perspective::new(setup, fill.units());
        rows.each(window, |y, start, end| {
            let first = origin.wrapping_add((y as usize).wrapping_mul(width)).wrapping_add(start as usize);
            let count = (end - start) as usize;
            // In two steps: the end of a range is checked more dearly.
            let Some(pixels) = pixels.get_mut(first..).and_then(|rest| rest.get_mut(..count)) else {
                return;
            };
            if !D::ALWAYS_PASSES {
                let Some(depth) = depth.get_mut(first..).and_then(|rest| rest.get_mut(..count)) else {
                    return;
                };
                // One pixel needs no step, which takes a while in a sliver.
                let z = match count {
                    1 if setup.sliver => (setup.value_in_sliver(&setup.z, start, y), 0),
                    _ => setup.at(&setup.z, start, y),
                };
                let passed = first_visible::<D>(depth, z);
                if passed != Some(count) {
                    return draw_visible::<F::Word, D>(
                        &mut line,
                        [start, y],
                        pixels,
                        (depth, z),
                        fill,
                        passed,
                    );
                }
            }
            line.draw(start, y, pixels, fill);
        });
    }
}

/// Draws what is visible of a span, some pixels of which are hidden, run by run. Of its pixels `passed` were tested
/// and are visible, and the next one is hidden; none was tested where it is `None`.
#[inline(never)]
fn draw_visible<W, D: DepthFormat>(
    line: &mut Perspective<'_>,
    [mut x, y]: [i32; 2],
    mut pixels: &mut [W],
    (mut depth, (mut near_w, step)): (&mut [D::Word], (u32, i32)),
    fill: &dyn Fill<W>,
    passed: Option<usize>,
) {
    let mut run = 0..passed.unwrap_or(0);
    let mut tested = passed.map_or(0, |passed| passed + 1);
    loop {
        let (done, rest) = pixels.split_at_mut(tested.min(pixels.len()));
        if let Some(visible) = done.get_mut(run.clone())
            && !visible.is_empty()
        {
            line.draw(x + run.start as i32, y, visible, fill);
        }
        (pixels, depth) = (rest, depth.get_mut(tested..).unwrap_or_default());
        if depth.is_empty() {
            return;
        }
        x += tested as i32;
        near_w = near_w.wrapping_add_signed(step.wrapping_mul(tested as i32));
        (run, tested) = visible::<D>(depth, near_w, step);
    }
}
