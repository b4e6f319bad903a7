//! The fill of texels, of a texture that repeats.
//!
//! - In: a run of pixels, and the curve of u and v.
//! - Out: words.
//! - Assumes: the curve is in the texture's units: u of 2^a texels has a integer bits and 32 − a fraction bits, and v likewise. Of
//!   one texel it has one integer bit, which is left out.
//!
//! The [loops](super::loops) are chosen here: for [`Rgb565`](embedded_graphics::pixelcolor::Rgb565) those that are compiled with this crate.

use super::curve::{Curve, Linear};
use super::fill::{Fill, FillRow};
use super::light::FillTexels;
use super::loops::{Loops, chords_in_rgb565, straight_in_rgb565, table_in_rgb565};
use super::memory::Memory;
use super::packed::{bent, downs, draw_texels_alone, integer_bits, place_of, step_of};
use super::units::Units;
use crate::frame::{Depth16, PixelFormat, SliceOf};
use crate::raster::TriangleSetup;
use crate::scene::Texture;
use core::marker::PhantomData;
use embedded_graphics::pixelcolor::Rgb565;

/// Texels of a texture that repeats.
pub(crate) struct Texels<'a, F> {
    loops: Loops<'a>,
    format: PhantomData<F>,
}
impl<'a, F> core::ops::Deref for Texels<'a, F> {
    type Target = Loops<'a>;

    #[inline]
    fn deref(&self) -> &Loops<'a> {
        &self.loops
    }
}

impl<'a, F: PixelFormat> Texels<'a, F> {
    #[inline]
    pub(crate) fn new(texture: &'a Texture<'a>, scale_log2: u32) -> Self {
        Self { loops: Loops::new(texture, scale_log2), format: PhantomData }
    }

    /// Any number of pixels, along straight lines in I16F16.
    #[inline]
    pub(super) fn lines(&self, pixels: &mut [F::Word], lines: &[Linear; 2]) {
        match F::in_rgb565::<SliceOf<'_>>(pixels) {
            Some(pixels) => straight_in_rgb565(&self.loops, pixels, lines),
            None => self.loops.straight::<F>(pixels, lines),
        }
    }
}

impl<F: PixelFormat> FillTexels<F> for Texels<'_, F> {
    #[inline]
    fn integer_bits(&self) -> [u32; 2] {
        integer_bits(self.texture)
    }

    #[inline]
    fn texel(&self, [u, v]: [u32; 2]) -> u16 {
        let [u_down, v_down] = downs(self.texture);
        self.texture.fetch_repeat((u >> u_down) as i32, (v >> v_down) as i32)
    }
}

impl<F: PixelFormat> Fill<F::Word> for Texels<'_, F> {
    fn units(&self) -> Units {
        Units::modular(integer_bits(self.texture))
    }

    #[inline]
    fn straight(&self, pixels: &mut [F::Word], line: &Curve) {
        if let Some(lines) = line.lines.first_chunk() {
            self.lines(pixels, lines);
        }
    }

    #[inline]
    fn table(&self, pixels: &mut [F::Word], curve: &Curve) {
        match F::in_rgb565::<SliceOf<'_>>(pixels) {
            Some(pixels) => table_in_rgb565(&self.loops, pixels, curve),
            None => self.loops.table::<F>(pixels, curve),
        }
    }

    #[inline]
    fn chords(&self, pixels: &mut [F::Word], curve: &Curve) {
        match F::in_rgb565::<SliceOf<'_>>(pixels) {
            Some(pixels) => chords_in_rgb565(&self.loops, pixels, curve),
            None => self.loops.chords::<F>(pixels, curve),
        }
    }
}

impl<F: PixelFormat> FillRow<2> for Texels<'_, F> {
    type Word = F::Word;
    type At = [i32; 2];
    type Step = [i32; 2];

    #[inline]
    fn at(&self, at: [i32; 2], step: [i32; 2]) -> [i32; 2] {
        place_of(self.texture, self.is_packed, at, step)
    }

    #[inline]
    fn step(&self, step: [i32; 2]) -> [i32; 2] {
        step_of(self.texture, self.is_packed, step)
    }

    #[inline]
    fn bent(
        &self,
        setup: &TriangleSetup,
        along: ([i32; 2], i32),
        _: [i32; 2],
        _: [i32; 2],
    ) -> ([i32; 2], [i32; 2]) {
        bent(self.texture, self.is_packed, setup, along)
    }

    #[inline]
    fn draw_in_rgb565<G: PixelFormat<Word = F::Word>>(
        &self,
        setup: &TriangleSetup,
        memory: &mut Memory<'_, u16, u16>,
    ) -> bool {
        draw_small_in_rgb565(&self.loops, setup, memory);
        true
    }

    #[inline]
    fn row(&self, pixels: &mut [F::Word], at: [i32; 2], step: [i32; 2]) {
        draw_texels_alone::<F>(self.texture, self.is_packed, pixels, at, step);
    }
}

#[inline(never)]
fn draw_small_in_rgb565(loops: &Loops<'_>, setup: &TriangleSetup, memory: &mut Memory<'_, u16, u16>) {
    let texels = Texels::<Rgb565> { loops: *loops, format: PhantomData };
    memory.draw_small::<2, Depth16, _>(setup, &texels);
}

#[cfg(test)]
pub(super) mod tests {
    use super::super::packed::lines_of;
    use super::super::passes::{at_once, leave_apart, second_pass};
    use super::*;
    use crate::frame::BigEndian;
    use proptest::prelude::*;
    use std::vec;
    use std::vec::Vec;

    /// Any curve of so many pixels, along which w stays above 1/8.
    pub(crate) fn curves() -> impl Strategy<Value = (Curve, usize)> {
        let lines = [
            any::<(u32, i32)>(),
            any::<(u32, i32)>(),
            any::<(u32, i32)>(),
            any::<(u32, i32)>(),
            any::<(u32, i32)>(),
        ];
        (lines, 1..200_usize, 1_u32 << 29.., any::<bool>()).prop_map(|(lines, count, w_far, rises)| {
            let w_step = (u32::MAX - w_far) / count as u32;
            let w = if rises { u32::MAX - w_step * (count as u32 - 1) } else { u32::MAX };
            let w_step = if rises { w_step } else { 0u32.wrapping_sub(w_step) };
            let lines = lines.map(|(at, slope)| Linear { at, slope });
            (Curve { lines, w, w_step, ..Curve::default() }, count)
        })
    }

    /// Texels of any colours.
    pub(crate) fn texels(log2: [u32; 2]) -> Vec<u16> {
        (0..1_u32 << (log2[0] + log2[1])).map(|i| (i.wrapping_mul(40_503) >> 3) as u16).collect()
    }

    fn both<F: PixelFormat<Word = u16>>(texture: &Texture<'_>, curve: &Curve, count: usize) -> [Vec<u16>; 2] {
        let [u, v, ..] = lines_of(texture, &curve.lines);
        let [u_down, v_down] = downs(texture);
        let word = |t: u32| {
            F::rgb565(texture.fetch_repeat((u.value(t) >> u_down) as i32, (v.value(t) >> v_down) as i32))
        };
        let (mut passes, mut once) = (vec![1; count], vec![2; count]);
        leave_apart::<false, F>(&mut passes, curve);
        second_pass::<F>(&mut passes, word);
        at_once::<false, F>(&mut once, curve, word);
        [passes, once]
    }

    proptest! {
        #![proptest_config(ProptestConfig { cases: 4_000, failure_persistence: None, ..ProptestConfig::default() })]
        #[test]
        fn one_loop_and_the_loops_of_known_sizes_give_the_bytes_of_the_passes_in_4_000_runs(
            (curve, count) in curves(),
            log2 in prop_oneof![Just([6, 6]), Just([5, 5]), [0..=7_u32, 0..=7_u32]],
        ) {
            let rows = texels(log2);
            let texture = Texture::new(&rows, log2[0], log2[1]);
            let [passes, once] = both::<Rgb565>(&texture, &curve, count);
            prop_assert_eq!(&passes, &once);
            let mut drawn = vec![3; count];
            Texels::<Rgb565>::new(&texture, 0).table(&mut drawn, &curve);
            prop_assert_eq!(&passes, &drawn);
            let [big_endian, once] = both::<BigEndian<Rgb565>>(&texture, &curve, count);
            prop_assert_eq!(&big_endian, &once);
            prop_assert!(big_endian.iter().zip(&passes).all(|(big, word)| *big == word.to_be()));
        }
    }
}
