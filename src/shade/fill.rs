//! Fills: how the pixels of a run get their words from attributes.
//!
//! - In: a run of pixels, and the curve that its attributes follow.
//! - Out: words.
//! - Assumes: the curve was made for the fill's units.
//!
//! A triangle's rows are cut into runs by one loop, and runs into curves by one
//! [`Perspective`](super::perspective::Perspective), whatever the surface. A fill is called once for each curve, as a
//! `dyn Fill`. So a program has one copy of these loops, and of each fill that a surface of it names.

use super::curve::{Curve, distance};
use super::memory::Memory;
use super::quality::Quality;
use super::units::{Form, Units};
use crate::frame::{DepthFormat, PixelFormat};
use crate::num::U1F31;
use crate::raster::{ATTRIBUTES, TriangleSetup};
use core::hint::black_box;
use core::marker::PhantomData;

/// How the pixels of a run get their words `W`. `pixels` is never empty.
///
/// Its loops are not to be inlined, as they would be where a program has but one fill: the loop over rows would leave
/// them no registers.
pub trait Fill<W> {
    /// The attributes that it takes.
    fn units(&self) -> Units;

    /// Any number of pixels, along a straight line in I16F16.
    fn straight(&self, pixels: &mut [W], line: &Curve);

    /// With 1/w at every pixel; in the general forms n/w.
    fn table(&self, pixels: &mut [W], curve: &Curve);

    /// With n/w at every pixel, or at every eighth one and straight lines between. Not of the general forms.
    fn chords(&self, _pixels: &mut [W], _curve: &Curve) {}
}

/// A fill of a small triangle's rows, from `N` attributes.
pub trait FillRow<const N: usize> {
    type Word;
    /// All attributes at a pixel, as rows take them.
    type At: Copy;
    /// A step of all of them: packed once a triangle, or once a run of one that is bent.
    type Step: Copy;

    /// Whether the first two attributes may be texture coordinates, which may be bent.
    const BENDS: bool = N > 1;

    /// Whether packing a step takes more than reading it again, for each row.
    const PACKS: bool = true;

    /// From I16F16, and the step from there on.
    fn at(&self, at: [i32; N], step: Self::Step) -> Self::At;

    /// From I16F16.
    fn step(&self, step: [i32; N]) -> Self::Step;

    /// From a bent triangle, at the first of `steps` + 1 pixels side by side: `at` and `step` have all but the first two attributes.
    #[inline]
    fn bent(
        &self,
        setup: &TriangleSetup,
        (place, steps): ([i32; 2], i32),
        mut at: [i32; N],
        mut step: [i32; N],
    ) -> (Self::At, Self::Step) {
        for (i, (at, step)) in at.iter_mut().zip(&mut step).take(2).enumerate() {
            (*at, *step) = setup.along(i, place, steps);
        }
        let step = self.step(step);
        (self.at(at, step), step)
    }

    /// Draws a small triangle in [`Rgb565`](embedded_graphics::pixelcolor::Rgb565), which `F` is, with [`Depth16`](crate::Depth16), by a
    /// function without type parameters: that is compiled with this crate, at its level of optimisation and not at that of the program.
    /// False if there is none.
    #[inline]
    fn draw_in_rgb565<F: PixelFormat<Word = Self::Word>>(
        &self,
        _setup: &TriangleSetup,
        _memory: &mut Memory<'_, u16, u16>,
    ) -> bool {
        false
    }

    /// At most so many pixels side by side.
    fn row(&self, pixels: &mut [Self::Word], at: Self::At, step: Self::Step);

    /// Whether [`row_tested`](Self::row_tested) is faster than to test all pixels of a row first, and then to draw them: so it is where
    /// there are registers for the variables of both.
    const FUSES: bool = false;

    /// As `row`, but tests depth before each pixel, near/w being `near_w.0` with a step of `near_w.1`, up to the first that is hidden.
    /// Returns how many are left from that one on.
    fn row_tested<D: DepthFormat>(
        &self,
        pixels: &mut [Self::Word],
        depth: &mut [D::Word],
        near_w: (u32, i32),
        (at, step): (Self::At, Self::Step),
    ) -> usize {
        let left = tested::<D>(depth, near_w);
        self.row(pixels.get_mut(..depth.len() - left).unwrap_or_default(), at, step);
        left
    }
}

/// Tests depths up to the first pixel that is hidden, and stores those before it. How many there are from that one on.
#[inline(always)]
pub(crate) fn tested<D: DepthFormat>(depth: &mut [D::Word], (mut near_w, step): (u32, i32)) -> usize {
    let mut depth = depth.iter_mut();
    loop {
        let left = depth.len();
        let Some(stored) = depth.next() else {
            return 0;
        };
        if !D::test_and_store_small(stored, U1F31::from_bits(near_w)) {
            return left;
        }
        near_w = near_w.wrapping_add_signed(step);
        // Not unrolled, which does not pay for a few pixels.
        black_box(());
    }
}

/// [`FillRow::row_tested`] in one loop.
#[inline(always)]
pub(crate) fn draw_row_tested<W, D: DepthFormat, A: Steps>(
    pixels: &mut [W],
    depth: &mut [D::Word],
    (mut near_w, near_w_step): (u32, i32),
    (mut at, step): (A, A),
    word: impl Fn(A) -> W,
) -> usize {
    let mut both = pixels.iter_mut().zip(depth);
    loop {
        let left = both.len();
        let Some((pixel, stored)) = both.next() else {
            return 0;
        };
        if !D::test_and_store_small(stored, U1F31::from_bits(near_w)) {
            return left;
        }
        near_w = near_w.wrapping_add_signed(near_w_step);
        *pixel = word(at);
        at = at.plus(step);
        black_box(());
    }
}

/// What can be stepped from pixel to pixel.
pub(crate) trait Steps: Copy {
    /// A step further.
    fn plus(self, step: Self) -> Self;
}

impl Steps for () {
    fn plus(self, (): ()) {}
}

impl Steps for u32 {
    #[inline]
    fn plus(self, step: Self) -> Self {
        self.wrapping_add(step)
    }
}

impl<const N: usize> Steps for [i32; N] {
    #[inline]
    fn plus(self, step: Self) -> Self {
        plus(self, step)
    }
}

impl<A: Steps, B: Steps> Steps for (A, B) {
    #[inline]
    fn plus(self, step: Self) -> Self {
        (self.0.plus(step.0), self.1.plus(step.1))
    }
}

/// Draws pixels side by side, each of which `word` makes of attributes.
#[inline(always)]
pub(crate) fn draw_row<W, A: Steps>(pixels: &mut [W], mut at: A, step: A, word: impl Fn(A) -> W) {
    for pixel in pixels {
        *pixel = word(at);
        at = at.plus(step);
        // Not unrolled, which does not pay for a few pixels.
        black_box(());
    }
}

#[inline]
pub(crate) fn plus<const N: usize>(a: [i32; N], b: [i32; N]) -> [i32; N] {
    core::array::from_fn(|i| a[i].wrapping_add(b[i]))
}

/// Pixel by pixel, by a function of `N` attributes in I16F16.
pub(crate) struct Each<const N: usize, Q, W, C>(C, PhantomData<fn(Q) -> W>);

impl<const N: usize, Q, W, C> Each<N, Q, W, C> {
    pub(crate) const fn new(color: C) -> Self {
        Self(color, PhantomData)
    }
}

/// Entries `first` … `first` + N of an array over attributes; zeros if there are fewer.
#[inline(always)]
pub(crate) fn some_of<const N: usize, T: Copy + Default>(all: &[T; ATTRIBUTES], first: usize) -> [T; N] {
    all.get(first..).and_then(<[T]>::first_chunk).copied().unwrap_or([T::default(); N])
}

impl<const N: usize, Q: Quality, W, C: Fn([i32; N]) -> W> Fill<W> for Each<N, Q, W, C> {
    fn units(&self) -> Units {
        Units::general(N, Q::EVERY_PIXEL)
    }

    fn straight(&self, pixels: &mut [W], line: &Curve) {
        let lines = some_of::<N, _>(&line.lines, 0);
        let (mut at, step) = (lines.map(|line| line.at as i32), lines.map(|line| line.slope));
        for pixel in pixels {
            *pixel = (self.0)(at);
            at = plus(at, step);
            black_box(());
        }
    }

    fn table(&self, pixels: &mut [W], curve: &Curve) {
        let (lines, down) = (some_of::<N, _>(&curve.lines, 0), some_of::<N, _>(&curve.down, 0));
        let (mut w, (mut n, n_step)) = (curve.w, curve.distances());
        for pixel in pixels {
            let t = distance(if Q::EVERY_PIXEL { Form::Exact } else { Form::General }, w, n) as i32;
            *pixel = (self.0)(core::array::from_fn(|i| {
                (lines[i].at as i32).wrapping_add(t.wrapping_mul(lines[i].slope) >> (down[i] & 31))
            }));
            (w, n) = (w.wrapping_add(curve.w_step), n.wrapping_add(n_step));
            black_box(());
        }
    }
}

impl<const N: usize, Q, W, C: Fn([i32; N]) -> W> FillRow<N> for Each<N, Q, W, C> {
    type Word = W;
    type At = [i32; N];
    type Step = [i32; N];

    #[inline]
    fn at(&self, at: [i32; N], _: [i32; N]) -> [i32; N] {
        at
    }

    #[inline]
    fn step(&self, step: [i32; N]) -> [i32; N] {
        step
    }

    #[inline]
    fn row(&self, pixels: &mut [W], at: [i32; N], step: [i32; N]) {
        draw_row(pixels, at, step, |at| (self.0)(at));
    }
}
