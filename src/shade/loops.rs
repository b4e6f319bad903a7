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
//! Cortex-M0+ where a bounds check would make it 20. That is so for 64×64 texels and whatever has as many. For 32×32 and whatever
//! has as many nothing is checked either, but to save flash the loop is not unrolled: 16.
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

use super::curve::{CHORD, Chords, Curve, Linear};
use super::fill::{draw_row, plus};
use super::packed::{downs, lines_of, packed_from, packed_step, shifted, sized, squared, turned};
use super::passes::{at_once, leave_apart, leave_ts, second_pass};
use crate::frame::PixelFormat;
use crate::num::IS_ARMV6M;
use crate::scene::Texture;
use bytemuck::must_cast_ref;
use core::hint::black_box;
use embedded_graphics::pixelcolor::Rgb565;

/// What the loops read, whatever the format.
#[derive(Clone, Copy)]
pub(crate) struct Loops<'a> {
    pub(super) texture: &'a Texture<'a>,
    pub(super) is_packed: bool,
    /// The pixels of a block along a straight line: so many that steps, which are cut, are off by 1/16 texel in the end. Large textures
    /// have fewer fraction bits than 10.
    block_log2: u8,
    known: Known<'a>,
}

/// A texture whose loops know how many texels it has, and perhaps that it is a square.
#[derive(Clone, Copy)]
enum Known<'a> {
    Of64x64(&'a [u16; 0x1000]),
    Of4096(&'a [u16; 0x1000]),
    Of32x32(&'a [u16; 0x400]),
    Of1024(&'a [u16; 0x400]),
    No,
}

#[inline(never)]
pub(super) fn straight_in_rgb565(loops: &Loops<'_>, pixels: &mut [u16], lines: &[Linear; 2]) {
    loops.straight::<Rgb565>(pixels, lines);
}

#[inline(never)]
pub(super) fn table_in_rgb565(loops: &Loops<'_>, pixels: &mut [u16], curve: &Curve) {
    loops.table::<Rgb565>(pixels, curve);
}

#[inline(never)]
pub(super) fn chords_in_rgb565(loops: &Loops<'_>, pixels: &mut [u16], curve: &Curve) {
    loops.chords::<Rgb565>(pixels, curve);
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
    #[inline(never)]
    pub(super) fn new(texture: &'a Texture<'a>, scale_log2: u32) -> Self {
        let texels = texture.texels();
        let [a, b] = texture.log2();
        let known = match (texels.try_into(), texels.try_into()) {
            (Ok(texels), _) if a == b => Known::Of64x64(texels),
            (Ok(texels), _) => Known::Of4096(texels),
            (_, Ok(texels)) if a == b => Known::Of32x32(texels),
            (_, Ok(texels)) => Known::Of1024(texels),
            _ => Known::No,
        };
        let block_log2 = if texture.is_large() { 3 } else { 6 };
        Self { texture, is_packed: texture.is_packable(scale_log2), block_log2, known }
    }
}

/// Whether straight lines of 64×64 texels have loops of their own, with size, mask and multiplier as constants. On a Cortex-M4 these are
/// part of instructions: 4 %. RISC-V and Armv6-M have none for constants so large.
const BY_CONSTANTS: bool = !(IS_ARMV6M || cfg!(target_arch = "riscv32"));

/// Along a straight line of packed coordinates, in blocks so short that truncated steps do not matter: of a texture's size, and
/// so many pixels.
#[inline(always)]
fn line_in_blocks<F: PixelFormat>(
    mut pixels: &mut [F::Word],
    lines: &[Linear; 2],
    ([a, b], block_log2): ([u32; 2], u32),
    draw: impl Fn(&mut [F::Word], u32, u32),
) {
    let [Linear { at: u, slope: u_step }, Linear { at: v, slope: v_step }] = *lines;
    let (mut u, mut v) = (u as i32, v as i32);
    let log2 = block_log2 & 31;
    let mut step = packed_step([turned(shifted(u_step, a)), shifted(v_step, b)]);
    if !IS_ARMV6M {
        // Hidden: multiples of it would be computed apart.
        step = black_box(step);
    }
    loop {
        let (block, rest) = pixels.split_at_mut(pixels.len().min(1 << log2));
        draw(block, packed_from([u >> a, v >> b], u_step), step);
        if rest.is_empty() {
            return;
        }
        pixels = rest;
        (u, v) = (u.wrapping_add(u_step << log2), v.wrapping_add(v_step << log2));
    }
}

/// As [`Loops::line`], unrolled.
#[inline(always)]
fn unrolled<F: PixelFormat>(pixels: &mut [F::Word], mut packed: u32, step: u32, texel: &impl Fn(u32) -> u16) {
    let (blocks, rest) = pixels.as_chunks_mut::<8>();
    for block in blocks {
        for pixel in block {
            *pixel = F::rgb565(texel(packed));
            packed = packed.wrapping_add(step);
        }
    }
    draw_row(rest, packed, step, |packed| F::rgb565(texel(packed)));
}

impl Loops<'_> {
    /// Along a straight line, from packed coordinates on. Not unrolled.
    #[inline(never)]
    fn line<F: PixelFormat>(&self, pixels: &mut [F::Word], packed: u32, step: u32) {
        if let Known::Of32x32(texels) | Known::Of1024(texels) = self.known {
            return line_of_1024::<F>(sized(self.texture, texels), pixels, packed, step);
        }
        // A copy stays in registers.
        let texture = *self.texture;
        draw_row(pixels, packed, step, |packed| F::rgb565(texture.fetch_packed(packed)));
    }

    /// Along a straight line of packed coordinates.
    #[inline(always)]
    fn line_packed<F: PixelFormat>(&self, pixels: &mut [F::Word], lines: &[Linear; 2]) {
        if let Known::Of64x64(texels) = self.known
            && BY_CONSTANTS
        {
            let texel = squared::<6, _>(self.texture, texels);
            let log2 = ([6; 2], 6);
            return line_in_blocks::<F>(pixels, lines, log2, |block, packed, step| {
                unrolled::<F>(block, packed, step, &texel);
            });
        }
        let log2 = (self.texture.log2(), self.block_log2.into());
        line_in_blocks::<F>(pixels, lines, log2, |block, packed, step| match self.known {
            Known::Of64x64(texels) | Known::Of4096(texels) => {
                unrolled::<F>(block, packed, step, &sized(self.texture, texels));
            }
            _ => self.line::<F>(block, packed, step),
        });
    }

    /// Along a straight line of coordinates that are not packed.
    #[inline(never)]
    fn line_unpacked<F: PixelFormat>(&self, pixels: &mut [F::Word], lines: &[Linear; 2]) {
        let [Linear { at: u, slope: u_step }, Linear { at: v, slope: v_step }] = *lines;
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
        let mut nodes = Nodes::<CUTS>::new(curve);
        let (eights, last) = eights_and_last(pixels);
        // 4096 texels that are packed and not large are a square.
        if let Known::Of64x64(texels) = self.known {
            let texel = squared::<6, _>(self.texture, texels);
            for eight in eights {
                let [mut packed, step] = nodes.next();
                for pixel in eight {
                    *pixel = F::rgb565(texel(packed));
                    packed = packed.wrapping_add(step);
                }
                black_box(());
            }
        } else {
            for eight in eights {
                let [packed, step] = nodes.next();
                self.line::<F>(eight, packed, step);
            }
        }
        let [packed, step] = nodes.last((last.len() as u32).wrapping_sub(1));
        match self.known {
            Known::Of64x64(texels) => {
                let texel = squared::<6, _>(self.texture, texels);
                draw_row(last, packed, step, |packed| F::rgb565(texel(packed)));
            }
            _ => self.line::<F>(last, packed, step),
        }
    }

    /// A straight line's v without what is lent to it where u falls, for u that does not repeat.
    #[inline(always)]
    pub(super) fn lending_nothing(&self, u: Linear, v: Linear) -> Linear {
        let lent = if self.is_packed && u.slope < 0 { 1 << self.texture.log2()[1] } else { 0 };
        Linear { at: v.at.wrapping_sub(lent), ..v }
    }

    /// With 1/w at every pixel, of 2^`A` × 2^`A` texels.
    #[inline(always)]
    fn table_sized<F: PixelFormat, const A: u32, const SIDE: usize>(
        &self,
        pixels: &mut [F::Word],
        texels: &[[u16; SIDE]; SIDE],
        curve: &Curve,
        first_pass: impl Fn(&mut [F::Word], &Curve),
    ) {
        let shift = 32 - A;
        let [u, v, ..] = curve.lines;
        Self::each::<F, false>(pixels, curve, [u, v], first_pass, move |u, v| {
            texels[(v >> shift) as usize & (SIDE - 1)][(u >> shift) as usize & (SIDE - 1)]
        });
    }

    /// With t at every pixel: 1/w, or with `CHORDS` n/w.
    #[inline(always)]
    pub(super) fn each<F: PixelFormat, const CHORDS: bool>(
        pixels: &mut [F::Word],
        curve: &Curve,
        [u, v]: [Linear; 2],
        first_pass: impl Fn(&mut [F::Word], &Curve),
        texel: impl Fn(u32, u32) -> u16,
    ) {
        let word = |t: u32| F::rgb565(texel(u.value(t), v.value(t)));
        if IS_ARMV6M && F::KEEPS {
            first_pass(pixels, curve);
            second_pass::<F>(pixels, word);
        } else {
            at_once::<CHORDS, F>(pixels, curve, word);
        }
    }

    #[inline(never)]
    fn table_32<F: PixelFormat>(&self, pixels: &mut [F::Word], texels: &[u16; 0x400], curve: &Curve) {
        self.table_sized::<F, 5, 32>(pixels, must_cast_ref(texels), curve, leave_apart::<false, F>);
    }

    /// Likewise, of any size.
    #[inline(never)]
    pub(super) fn each_any<F: PixelFormat, const CHORDS: bool>(&self, pixels: &mut [F::Word], curve: &Curve) {
        if IS_ARMV6M && F::KEEPS {
            leave_apart::<CHORDS, F>(pixels, curve);
            return self.any_of_kept::<F>(pixels, curve);
        }
        let [u, v] = lines_of(self.texture, &curve.lines);
        let texel = self.any();
        at_once::<CHORDS, F>(pixels, curve, |t| F::rgb565(texel(u.value(t), v.value(t))));
    }

    #[inline(never)]
    fn any_of_kept<F: PixelFormat>(&self, pixels: &mut [F::Word], curve: &Curve) {
        let [u, v] = lines_of(self.texture, &curve.lines);
        let texel = self.any();
        for pixel in pixels {
            let t = F::kept(*pixel).into();
            *pixel = F::rgb565(texel(u.value(t), v.value(t)));
            black_box(());
        }
    }

    /// The texel at a place, of any size.
    #[inline(always)]
    fn any(&self) -> impl Fn(u32, u32) -> u16 {
        let ([a, _], texels) = (self.texture.log2(), self.texture.texels());
        let [u_down, v_down] = downs(self.texture);
        move |u, v| {
            let index = (v >> v_down) << a | u >> u_down;
            texels.get(index as usize).copied().unwrap_or_default()
        }
    }

    #[inline]
    pub(super) fn straight<F: PixelFormat>(&self, pixels: &mut [F::Word], lines: &[Linear; 2]) {
        if !self.is_packed {
            return self.line_unpacked::<F>(pixels, lines);
        }
        self.line_packed::<F>(pixels, lines);
    }

    #[inline]
    pub(super) fn table<F: PixelFormat>(&self, pixels: &mut [F::Word], curve: &Curve) {
        match self.known {
            Known::Of64x64(texels) => {
                self.table_sized::<F, 6, 64>(pixels, must_cast_ref(texels), curve, leave_ts::<false, F>);
            }
            Known::Of32x32(texels) => self.table_32::<F>(pixels, texels, curve),
            _ => self.each_any::<F, false>(pixels, curve),
        }
    }

    #[inline]
    pub(super) fn chords<F: PixelFormat>(&self, pixels: &mut [F::Word], curve: &Curve) {
        self.chords_of::<F, false>(pixels, curve);
    }
}

/// Along a straight line, of 1024 texels. A function of its own, for its registers.
#[inline(never)]
fn line_of_1024<F: PixelFormat>(texel: impl Fn(u32) -> u16, pixels: &mut [F::Word], packed: u32, step: u32) {
    draw_row(pixels, packed, step, |packed| F::rgb565(texel(packed)));
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
