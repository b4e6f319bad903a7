//! The loops of texels of a texture that repeats.
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
//!
//! Those for [`Rgb565`] are functions without type parameters, so that they are compiled with this crate and at its level of
//! optimisation, not at that of the program.

use super::curve::{CHORD, Chords, Curve, Linear, Ts};
use super::fill::plus;
use super::inverses::leave;
use super::packed::{downs, lines_of, packed_from, packed_step, shifted, sized, turned};
use crate::frame::PixelFormat;
use crate::num::IS_ARMV6M;
use crate::raster::ATTRIBUTES;
use crate::scene::Texture;
use core::hint::black_box;
use embedded_graphics::pixelcolor::Rgb565;

/// What the loops read, whatever the format.
pub(crate) struct Loops<'a> {
    pub(super) texture: &'a Texture<'a>,
    pub(super) is_packed: bool,
    square: Square<'a>,
}

#[inline(never)]
pub(super) fn straight_in_rgb565(loops: &Loops<'_>, pixels: &mut [u16], line: &Curve) {
    loops.straight::<Rgb565>(pixels, line);
}

#[inline(never)]
pub(super) fn table_in_rgb565(loops: &Loops<'_>, pixels: &mut [u16], curve: &Curve) {
    loops.table::<Rgb565>(pixels, curve);
}

#[inline(never)]
pub(super) fn chords_in_rgb565(loops: &Loops<'_>, pixels: &mut [u16], curve: &Curve) {
    loops.chords::<Rgb565>(pixels, curve);
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

impl<'a> Loops<'a> {
    #[inline]
    pub(super) fn new(texture: &'a Texture<'a>, scale_log2: u32) -> Self {
        let ([a, b], rows) = (texture.log2(), texture.texels());
        // 4096 texels are 64 rows of 64, 1024 are 32 of 32.
        let square = match (rows.as_chunks().0.try_into(), rows.as_chunks().0.try_into()) {
            (Ok(rows), _) if a == b => Square::Of64(rows),
            (_, Ok(rows)) if a == b => Square::Of32(rows),
            _ => Square::Any,
        };
        Self { texture, is_packed: texture.is_packable(scale_log2), square }
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
    pub(super) fn straight<F: PixelFormat>(&self, pixels: &mut [F::Word], line: &Curve) {
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
    pub(super) fn table<F: PixelFormat>(&self, pixels: &mut [F::Word], curve: &Curve) {
        match self.square {
            Square::Of64(texels) => self.table_sized::<F, 6, 64>(pixels, texels, curve),
            Square::Of32(texels) => self.table_32::<F>(pixels, texels, curve),
            Square::Any => self.each_any::<F, false>(pixels, curve),
        }
    }

    #[inline]
    pub(super) fn chords<F: PixelFormat>(&self, pixels: &mut [F::Word], curve: &Curve) {
        self.chords_of::<F, false>(pixels, curve);
    }
}

/// Words made of t, which a first pass leaves in the pixels: 1/w takes 8.3 cycles a pixel on a Cortex-M0+, and the second pass 22.9.
#[inline(always)]
pub(super) fn in_passes<const CHORDS: bool, F: PixelFormat>(
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

/// The pixels of a run's chords, and 1 to 8 of the last one, whose end is the run's.
#[inline(always)]
fn eights_and_last<W>(pixels: &mut [W]) -> (&mut [[W; CHORD as usize]], &mut [W]) {
    let at = pixels.len().saturating_sub(1) & !(CHORD as usize - 1);
    let (before, last) = pixels.split_at_mut_checked(at).unwrap_or_default();
    (before.as_chunks_mut().0, last)
}

/// A chord from a place, in units of 32 bits, and its step; as a packed place and step, both rounded down.
#[inline(always)]
fn packed_chord([u, v]: [u32; 2], [u_step, v_step]: [i32; 2]) -> [u32; 2] {
    const UPPER: u32 = 0xffff_0000;
    [v & UPPER | u >> 16, (v_step as u32 & UPPER).wrapping_add_signed(u_step >> 16)]
}
