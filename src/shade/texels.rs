//! The fill of texels, of a texture that repeats.
//!
//! - In: a run of pixels, and the curve of u and v.
//! - Out: words.
//! - Assumes: the curve is in the texture's units: u of 2^a texels has a integer bits and 32 − a fraction bits, and v likewise. Of
//!   one texel it has one integer bit, which is left out.
//!
//! Along straight lines u and v are packed in one word, so that one addition steps both. For 2^a × 2^b texels the lower half of the
//! word holds u with a integer and 16 − a fraction bits, the upper half v with b and 16 − b, and both repeat by themselves.
//! Masking leaves the integer bits, and one multiplication moves those of u below those of v:
//!
//! ```text
//!   vvvvvv00 00000000 uuuuuu00 00000000  · (1 + 2^(16 − b))  >> (32 − a − b)  =  vvvvvvuu uuuu
//! ```
//!
//! With the number of texels an array's, the compiler sees that the index cannot be outside it: 9 cycles a pixel on a
//! Cortex-M0+ where a bounds check would make it 20. That is so for 32×32 and 64×64 texels and whatever has as many.
//!
//! A carry from u moves v by its last bit; steps are cut to their last bit towards zero. So lines are so short,
//! before they start anew from 32 bits, that all of that is 1/16 texel at most. [`Packing`](crate::raster::Packing)
//! has the exact sum: it keeps away the wrong texel at a whole coordinate, and the opposite border.
//!
//! With 1/w at every pixel u and v have a word each. On a Cortex-M0+, which has few registers, a first pass leaves 1/w in the
//! pixels, and a second makes texels of them: 31 cycles a pixel, where one loop takes 35. On a Cortex-M4 one loop takes 15.

use super::curve::{CHORD, Chords, Curve, Linear, Ts};
use super::fill::{Fill, FillRow, plus};
use super::inverses::leave;
use super::light::FillTexels;
use super::packed::{
    downs, integer_bits, lines_of, longest_row_of, packed_from, packed_step, shifted, sized, turned,
};
use super::row::Row;
use super::units::Units;
use crate::frame::{DepthFormat, PixelFormat};
use crate::num::IS_ARMV6M;
use crate::raster::ATTRIBUTES;
use crate::scene::Texture;
use core::hint::black_box;
use core::marker::PhantomData;
use embedded_graphics::pixelcolor::Rgb565;

/// Texels of a texture that repeats.
pub(crate) struct Texels<'a, F> {
    loops: Loops<'a>,
    format: PhantomData<F>,
}

/// What the loops read, whatever the format: those for [`Rgb565`] are functions without type parameters, so that they are compiled
/// with this crate and at its level of optimisation.
pub(crate) struct Loops<'a> {
    texture: &'a Texture<'a>,
    is_packed: bool,
    square: Square<'a>,
}

#[inline(never)]
fn straight_in_rgb565(loops: &Loops<'_>, pixels: &mut [u16], line: &Curve) {
    loops.straight::<Rgb565>(pixels, line);
}

#[inline(never)]
fn table_in_rgb565(loops: &Loops<'_>, pixels: &mut [u16], curve: &Curve) {
    loops.table::<Rgb565>(pixels, curve);
}

#[inline(never)]
fn chords_in_rgb565(loops: &Loops<'_>, pixels: &mut [u16], curve: &Curve) {
    loops.chords::<Rgb565>(pixels, curve);
}

impl<'a, F> core::ops::Deref for Texels<'a, F> {
    type Target = Loops<'a>;

    #[inline]
    fn deref(&self) -> &Loops<'a> {
        &self.loops
    }
}

/// A texture whose loops know its size.
#[derive(Clone, Copy)]
enum Square<'a> {
    Of64(&'a [[u16; 64]; 64]),
    Of32(&'a [[u16; 32]; 32]),
    Any,
}

/// Chords of packed coordinates: where each begins, and its step.
struct Nodes<const CUTS: bool> {
    chords: Chords,
    lines: [Linear; 2],
    steps: [u32; 2],
}

impl<const CUTS: bool> Nodes<CUTS> {
    #[inline(always)]
    fn new(curve: &Curve) -> Self {
        let [u, v, ..] = curve.lines;
        let steps = [u, v].map(|line| shifted(line.slope, 6) as u32);
        Self { chords: Chords::new(curve), lines: [u, v], steps }
    }

    #[inline(always)]
    fn node(&self, (t, rise): (u32, u32)) -> [u32; 2] {
        let steps = self.steps.map(|step| rise.wrapping_mul(step) as i32);
        let steps = if CUTS { steps.map(|step| step + (step >> 31 & 0xffff)) } else { steps };
        packed_chord(self.lines.map(|line| line.value(t)), steps)
    }

    #[inline(always)]
    fn next(&mut self) -> [u32; 2] {
        let chord = self.chords.next();
        self.node(chord)
    }

    #[inline(always)]
    fn last(&mut self, steps: u32) -> [u32; 2] {
        let chord = self.chords.last(steps);
        self.node(chord)
    }
}

impl<'a, F: PixelFormat> Texels<'a, F> {
    #[inline]
    pub(crate) fn new(texture: &'a Texture<'a>, scale_log2: u32) -> Self {
        let ([a, b], rows) = (texture.log2(), texture.texels());
        // 4096 texels are 64 rows of 64, 1024 are 32 of 32.
        let square = match (rows.as_chunks().0.try_into(), rows.as_chunks().0.try_into()) {
            (Ok(rows), _) if a == b => Square::Of64(rows),
            (_, Ok(rows)) if a == b => Square::Of32(rows),
            _ => Square::Any,
        };
        let loops = Loops { texture, is_packed: texture.is_packable(scale_log2), square };
        Self { loops, format: PhantomData }
    }
}

impl Loops<'_> {
    /// Along a straight line, from packed coordinates on.
    #[inline]
    fn line_sized<F: PixelFormat, const COUNT: usize>(
        &self,
        pixels: &mut [F::Word],
        texels: &[u16; COUNT],
        mut packed: u32,
        step: u32,
    ) {
        let texel = sized(self.texture, texels);
        let mut draw = |pixel: &mut F::Word| {
            *pixel = F::rgb565(texel(packed));
            packed = packed.wrapping_add(step);
        };
        let (blocks, rest) = pixels.as_chunks_mut::<8>();
        for block in blocks {
            block.iter_mut().for_each(&mut draw);
        }
        rest.iter_mut().for_each(draw);
    }

    /// Likewise, of any size.
    #[inline(never)]
    fn line_checked<F: PixelFormat>(&self, pixels: &mut [F::Word], mut packed: u32, step: u32) {
        // A copy stays in registers.
        let texture = *self.texture;
        for pixel in pixels {
            *pixel = F::rgb565(texture.fetch_packed(packed));
            packed = packed.wrapping_add(step);
            black_box(());
        }
    }

    /// Hands on blocks so short that truncated steps do not matter.
    #[inline(always)]
    fn in_blocks<F: PixelFormat>(
        &self,
        mut pixels: &mut [F::Word],
        line: &Curve,
        run: impl Fn(&mut [F::Word], u32, u32),
    ) {
        let [a, b] = self.texture.log2();
        let [Linear { at: u, slope: u_step }, Linear { at: v, slope: v_step }, ..] = line.lines;
        let (mut u, mut v) = (u as i32, v as i32);
        // After 64 pixels a step cut to 10 fraction bits is off by 1/16 texel. Large textures have fewer fraction bits.
        let log2 = if self.texture.is_large() { 3 } else { 6 };
        let step = packed_step([turned(shifted(u_step, a)), shifted(v_step, b)]);
        loop {
            let (block, rest) = pixels.split_at_mut(pixels.len().min(1 << log2));
            run(block, packed_from([u >> a, v >> b], u_step), step);
            if rest.is_empty() {
                return;
            }
            pixels = rest;
            (u, v) = (u.wrapping_add(u_step << log2), v.wrapping_add(v_step << log2));
        }
    }

    /// Along a straight line of coordinates that are not packed.
    #[inline(never)]
    fn line_unpacked<F: PixelFormat>(&self, pixels: &mut [F::Word], line: &Curve) {
        let [Linear { at: u, slope: u_step }, Linear { at: v, slope: v_step }, ..] = line.lines;
        let (texture, mut at) = (*self.texture, [u as i32, v as i32]);
        for pixel in pixels {
            *pixel = F::rgb565(texture.fetch_repeat(at[0] >> 16, at[1] >> 16));
            at = plus(at, [u_step, v_step]);
            black_box(());
        }
    }

    /// Along chords. `CUTS`: steps are cut towards zero, for lines that must not leave the texture.
    #[inline(always)]
    pub(super) fn chords_of<F: PixelFormat, const CUTS: bool>(&self, pixels: &mut [F::Word], curve: &Curve) {
        // Packed chords need more room at the ends of the range than large textures have.
        if !self.is_packed || self.texture.is_large() {
            return self.each_any::<F, true>(pixels, curve);
        }
        let texels = self.texture.texels();
        if let Ok(texels) = <&[u16; 0x1000]>::try_from(texels) {
            self.chords_sized::<F, CUTS, 0x1000>(pixels, texels, curve);
        } else if let Ok(texels) = <&[u16; 0x400]>::try_from(texels) {
            self.chords_sized::<F, CUTS, 0x400>(pixels, texels, curve);
        } else {
            let mut nodes = Nodes::<CUTS>::new(curve);
            let (eights, last) = eights_and_last(pixels);
            for eight in eights {
                let [packed, step] = nodes.next();
                self.line_checked::<F>(eight, packed, step);
            }
            let [packed, step] = nodes.last((last.len() as u32).wrapping_sub(1));
            self.line_checked::<F>(last, packed, step);
        }
    }

    /// Takes away from a straight line's v what is lent to it where u falls, for u that does not repeat.
    pub(super) fn lend_nothing(&self, [u, v, ..]: &mut [Linear; ATTRIBUTES]) {
        if self.is_packed && u.slope < 0 {
            v.at = v.at.wrapping_sub(1 << self.texture.log2()[1]);
        }
    }

    #[inline(always)]
    fn chords_sized<F: PixelFormat, const CUTS: bool, const COUNT: usize>(
        &self,
        pixels: &mut [F::Word],
        texels: &[u16; COUNT],
        curve: &Curve,
    ) {
        let texel = sized(self.texture, texels);
        let mut nodes = Nodes::<CUTS>::new(curve);
        let (eights, last) = eights_and_last(pixels);
        for eight in eights {
            let [mut packed, step] = nodes.next();
            for pixel in eight {
                *pixel = F::rgb565(texel(packed));
                packed = packed.wrapping_add(step);
            }
            black_box(());
        }
        let [mut packed, step] = nodes.last((last.len() as u32).wrapping_sub(1));
        for pixel in last {
            *pixel = F::rgb565(texel(packed));
            packed = packed.wrapping_add(step);
            black_box(());
        }
    }

    /// With 1/w at every pixel, of 2^`A` × 2^`A` texels.
    #[inline(always)]
    fn table_sized<F: PixelFormat, const A: u32, const SIDE: usize>(
        &self,
        pixels: &mut [F::Word],
        texels: &[[u16; SIDE]; SIDE],
        curve: &Curve,
    ) {
        let shift = 32 - A;
        let [u, v, ..] = curve.lines;
        Self::each::<F, false>(pixels, curve, [u, v], move |u, v| {
            texels[(v >> shift) as usize & (SIDE - 1)][(u >> shift) as usize & (SIDE - 1)]
        });
    }

    /// With t at every pixel: 1/w, or with `CHORDS` n/w.
    #[inline(always)]
    pub(super) fn each<F: PixelFormat, const CHORDS: bool>(
        pixels: &mut [F::Word],
        curve: &Curve,
        [u, v]: [Linear; 2],
        texel: impl Fn(u32, u32) -> u16,
    ) {
        let word = |t: u32| F::rgb565(texel(u.value(t), v.value(t)));
        if IS_ARMV6M && F::KEEPS {
            in_passes::<CHORDS, F>(pixels, curve, word);
        } else {
            at_once::<CHORDS, F>(pixels, curve, word);
        }
    }

    #[inline(never)]
    fn table_32<F: PixelFormat>(&self, pixels: &mut [F::Word], texels: &[[u16; 32]; 32], curve: &Curve) {
        self.table_sized::<F, 5, 32>(pixels, texels, curve);
    }

    /// Likewise, of any size.
    #[inline(never)]
    pub(super) fn each_any<F: PixelFormat, const CHORDS: bool>(&self, pixels: &mut [F::Word], curve: &Curve) {
        let ([a, _], texels) = (self.texture.log2(), self.texture.texels());
        let [u_down, v_down] = downs(self.texture);
        Self::each::<F, CHORDS>(pixels, curve, lines_of(self.texture, &curve.lines), |u, v| {
            let index = (v >> v_down) << a | u >> u_down;
            texels.get(index as usize).copied().unwrap_or_default()
        });
    }

    #[inline]
    fn straight<F: PixelFormat>(&self, pixels: &mut [F::Word], line: &Curve) {
        if !self.is_packed {
            return self.line_unpacked::<F>(pixels, line);
        }
        let texels = self.texture.texels();
        if let Ok(texels) = <&[u16; 0x1000]>::try_from(texels) {
            self.in_blocks::<F>(pixels, line, |block, packed, step| {
                self.line_sized::<F, _>(block, texels, packed, step)
            });
        } else if let Ok(texels) = <&[u16; 0x400]>::try_from(texels) {
            self.in_blocks::<F>(pixels, line, |block, packed, step| {
                self.line_sized::<F, _>(block, texels, packed, step)
            });
        } else {
            self.in_blocks::<F>(pixels, line, |block, packed, step| {
                self.line_checked::<F>(block, packed, step)
            });
        }
    }

    #[inline]
    fn table<F: PixelFormat>(&self, pixels: &mut [F::Word], curve: &Curve) {
        match self.square {
            Square::Of64(texels) => self.table_sized::<F, 6, 64>(pixels, texels, curve),
            Square::Of32(texels) => self.table_32::<F>(pixels, texels, curve),
            Square::Any => self.each_any::<F, false>(pixels, curve),
        }
    }

    #[inline]
    fn chords<F: PixelFormat>(&self, pixels: &mut [F::Word], curve: &Curve) {
        self.chords_of::<F, false>(pixels, curve);
    }
}

/// Words made of t, which a first pass leaves in the pixels: 1/w takes 8.3 cycles a pixel on a Cortex-M0+, and the second pass 22.9.
#[inline(always)]
fn in_passes<const CHORDS: bool, F: PixelFormat>(
    pixels: &mut [F::Word],
    curve: &Curve,
    word: impl Fn(u32) -> F::Word,
) {
    if CHORDS {
        let mut ts = Ts::<true>::new(curve);
        for pixel in &mut *pixels {
            *pixel = F::keep(ts.next() as u16);
            black_box(());
        }
    } else {
        leave::<F>(pixels, curve.w, curve.w_step);
    }
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

/// The same in one loop: with 1/w 15 cycles a pixel on a Cortex-M4, where it is not unrolled.
#[inline(always)]
fn at_once<const CHORDS: bool, F: PixelFormat>(
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

/// The pixels of a run's chords, and 1 to 8 of the last one, whose end is the run's.
#[inline(always)]
fn eights_and_last<W>(pixels: &mut [W]) -> (&mut [[W; CHORD as usize]], &mut [W]) {
    let (before, last) = pixels.split_at_mut(pixels.len().saturating_sub(1) & !(CHORD as usize - 1));
    (before.as_chunks_mut().0, last)
}

/// A chord from a place, in units of 32 bits, and its step; as a packed place and step, both rounded down.
#[inline(always)]
fn packed_chord([u, v]: [u32; 2], [u_step, v_step]: [i32; 2]) -> [u32; 2] {
    const UPPER: u32 = 0xffff_0000;
    [v & UPPER | u >> 16, (v_step as u32 & UPPER).wrapping_add_signed(u_step >> 16)]
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
        match F::as_rgb565(pixels) {
            Some(pixels) => straight_in_rgb565(&self.loops, pixels, line),
            None => self.loops.straight::<F>(pixels, line),
        }
    }

    #[inline]
    fn table(&self, pixels: &mut [F::Word], curve: &Curve) {
        match F::as_rgb565(pixels) {
            Some(pixels) => table_in_rgb565(&self.loops, pixels, curve),
            None => self.loops.table::<F>(pixels, curve),
        }
    }

    #[inline]
    fn chords(&self, pixels: &mut [F::Word], curve: &Curve) {
        match F::as_rgb565(pixels) {
            Some(pixels) => chords_in_rgb565(&self.loops, pixels, curve),
            None => self.loops.chords::<F>(pixels, curve),
        }
    }
}

impl<F: PixelFormat> FillRow<2> for Texels<'_, F> {
    type Word = F::Word;

    #[inline]
    fn longest_row(&self) -> i32 {
        longest_row_of(self.texture, self.is_packed)
    }

    #[inline]
    fn row<D: DepthFormat>(&self, row: Row<'_, F::Word, D>, [u, v]: [i32; 2], [u_step, v_step]: [i32; 2]) {
        if !self.is_packed {
            let up = |[u, v]: [i32; 2]| [u << row.scale_log2(0), v << row.scale_log2(1)];
            let (at, step) = (up([u, v]), up([u_step, v_step]));
            let word = |[u, v]: [i32; 2]| F::rgb565(self.texture.fetch_repeat(u >> 16, v >> 16));
            return row.draw(at, |at| plus(at, step), word);
        }
        let [a, b] = self.texture.log2();
        let [a, b] = [a.wrapping_sub(row.scale_log2(0)) & 31, b.wrapping_sub(row.scale_log2(1)) & 31];
        let step = packed_step([shifted(u_step, a), shifted(v_step, b)]);
        let first = packed_from([u >> a, v >> b], u_step);
        row.draw_texels(self.texture, [first, step], (), |()| (), |texel, ()| F::rgb565(texel));
    }
}

#[cfg(test)]
pub(super) mod tests {
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
        in_passes::<false, F>(&mut passes, curve, word);
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
