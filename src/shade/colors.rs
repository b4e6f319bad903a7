//! The fill of colours between vertices (Gouraud shading).
//!
//! - In: a run of pixels, and the curve of its channels.
//! - Out: words.
//! - Assumes: channels stay within 0 … 255.996 at every pixel.

use super::channels::{Channels, Gray, RedBlueGreen};
use super::curve::{Curve, Ts};
use super::fill::{Fill, FillRow, draw_row, draw_row_tested, some_of};
use super::inverses::ONE_LOG2;
use super::memory::Memory;
use super::units::Units;
use crate::frame::{Depth16, DepthFormat, PixelFormat};
use crate::num::IS_ARMV6M;
use crate::raster::TriangleSetup;
use core::hint::black_box;
use core::marker::PhantomData;
use embedded_graphics::pixelcolor::Rgb565;

/// `M` channels: one for greys, else three.
pub(crate) struct Colors<const M: usize, F, C>(PhantomData<(F, C)>);

impl<const M: usize, F, C> Colors<M, F, C> {
    pub(crate) const NEW: Self = Self(PhantomData);
}

impl<const M: usize, F: PixelFormat, C: Channels<M>> Colors<M, F, C> {
    /// Along a straight line of packed channels.
    #[inline(never)]
    fn run(pixels: &mut [F::Word], mut packed: C, step: C) {
        for pixel in pixels {
            *pixel = packed.word::<F>();
            packed = packed.plus(step);
            black_box(());
        }
    }

    /// With t at every pixel.
    #[inline(always)]
    fn each<const CHORDS: bool>(pixels: &mut [F::Word], curve: &Curve, mut ts: Ts<CHORDS>) {
        // Where w or n begins.
        let lines = C::scaled_lines::<F>(some_of(&curve.lines, 0), if CHORDS { 0 } else { 1 << ONE_LOG2 });
        for pixel in pixels {
            let t = ts.next();
            *pixel = C::word_modular::<F>(lines.map(|line| line.value(t)));
            black_box(());
        }
    }
}

impl<const M: usize, F: PixelFormat, C: Channels<M>> Fill<F::Word> for Colors<M, F, C> {
    fn units(&self) -> Units {
        Units::modular([8; M])
    }

    #[inline(never)]
    fn straight(&self, pixels: &mut [F::Word], line: &Curve) {
        let lines = some_of::<M, _>(&line.lines, 0);
        let (mut at, step) = (
            C::scaled::<F>(lines.map(|line| line.at as i32)),
            C::scaled_step::<F>(lines.map(|line| line.slope)),
        );
        let packed_step = C::step(step);
        if C::DROPPED == 0 {
            return Self::run(pixels, C::place(at), packed_step);
        }
        for block in pixels.chunks_mut(1 << C::RUN_LOG2) {
            Self::run(block, C::place(at), packed_step);
            for (at, step) in at.iter_mut().zip(step) {
                *at = at.wrapping_add(step << C::RUN_LOG2);
            }
        }
    }

    #[inline(never)]
    fn table(&self, pixels: &mut [F::Word], curve: &Curve) {
        Self::each(pixels, curve, Ts::<false>::new(curve));
    }

    #[inline(never)]
    fn chords(&self, pixels: &mut [F::Word], curve: &Curve) {
        Self::each(pixels, curve, Ts::<true>::new(curve));
    }
}

impl<const M: usize, F: PixelFormat, C: Channels<M>> FillRow<M> for Colors<M, F, C> {
    type Word = F::Word;
    type At = C;
    type Step = C;
    const BENDS: bool = false;
    const PACKS: bool = C::DROPPED > 0;

    #[inline]
    fn at(&self, at: [i32; M], _: C) -> C {
        C::place(C::scaled::<F>(at))
    }

    #[inline]
    fn step(&self, step: [i32; M]) -> C {
        C::step(C::scaled_step::<F>(step))
    }

    #[inline]
    fn draw_in_rgb565<G: PixelFormat<Word = F::Word>>(
        &self,
        setup: &TriangleSetup,
        memory: &mut Memory<'_, u16, u16>,
    ) -> bool {
        match M {
            1 => draw_gray_in_rgb565(setup, memory),
            _ => draw_rgb_in_rgb565(setup, memory),
        }
        true
    }

    #[inline]
    fn row(&self, pixels: &mut [F::Word], at: C, step: C) {
        draw_row(pixels, at, step, |at| at.word::<F>());
    }

    const FUSES: bool = !IS_ARMV6M;

    #[inline(always)]
    fn row_tested<D: DepthFormat>(
        &self,
        pixels: &mut [F::Word],
        depth: &mut [D::Word],
        near_w: (u32, i32),
        along: (C, C),
    ) -> usize {
        draw_row_tested::<_, D, _>(pixels, depth, near_w, along, |at| at.word::<F>())
    }
}

#[inline(never)]
fn draw_gray_in_rgb565(setup: &TriangleSetup, memory: &mut Memory<'_, u16, u16>) {
    memory.draw_small::<1, Depth16, _>(setup, &Colors::<1, Rgb565, Gray>::NEW);
}

#[inline(never)]
fn draw_rgb_in_rgb565(setup: &TriangleSetup, memory: &mut Memory<'_, u16, u16>) {
    memory.draw_small::<3, Depth16, _>(setup, &Colors::<3, Rgb565, RedBlueGreen>::NEW);
}
