//! Fills: rows of pixels along which attributes are linear.

use super::patch::{Row, STRAIGHT};
use super::walk::LONGEST;
use crate::scene::Texture;
use crate::target::{DepthFormat, PixelFormat};
use core::marker::PhantomData;

/// How the pixels of a run get their words from `N` attributes in I16F16.
pub trait Fill<const N: usize> {
    type Word;

    /// The longest bent run that is exact enough.
    #[inline]
    fn longest(&self) -> i32 {
        LONGEST as i32
    }

    /// Attribute `i` of I16F16 times 2^`scale_log2` in the units of bent runs.
    #[inline]
    fn in_units(&self, _i: usize, value: i32, scale_log2: u32) -> i32 {
        value << scale_log2
    }

    /// One pixel.
    fn pixel(&self, at: [i32; N]) -> Self::Word;

    /// Any number of pixels side by side, the first at `at`, each `step` further.
    ///
    /// Not inlined, here and in others: two functions have it.
    #[inline(never)]
    fn run_long(&self, pixels: &mut [Self::Word], mut at: [i32; N], step: [i32; N]) {
        for pixel in pixels {
            *pixel = self.pixel(at);
            at = plus(at, step);
        }
    }

    /// The longest [`Fill::row`] that is exact enough, in steps.
    #[inline]
    fn longest_row(&self) -> i32 {
        STRAIGHT
    }

    /// A short row of pixels, some of which may be hidden, the first at `at`, each `step` further, both without the row's
    /// `scale_log2`.
    #[inline]
    fn row<D: DepthFormat>(&self, row: Row<'_, Self::Word, D>, at: [i32; N], step: [i32; N]) {
        let [at, step]: [[i32; N]; 2] =
            [at, step].map(|value| core::array::from_fn(|i| value[i] << row.scale_log2(i)));
        row.draw(at, |at| plus(at, step), |at| self.pixel(at));
    }

    /// At most `longest` pixels and one side by side, the first at `at`, each `step` further, `bend` being added to that
    /// after every second; in the units of bent runs.
    #[inline]
    fn bent(&self, pixels: &mut [Self::Word], at: [i32; N], step: [i32; N], bend: [i32; N]) {
        let draw = |pixel: &mut Self::Word, [at, step]: &mut [[i32; N]; 2]| {
            *pixel = self.pixel(*at);
            *at = plus(*at, *step);
        };
        in_pairs(pixels, [at, step], bend, draw, |[_, step], bend| *step = plus(*step, bend));
    }
}

/// Draws pixel by pixel, from `state` on, and bends after every second.
///
/// Steps that stay for two pixels leave the compiler more registers than those that change at each: 13 cycles a pixel instead of
/// 18 for texels on a Cortex-M0+, and as exact.
#[inline]
pub(super) fn in_pairs<W, T, B: Copy>(
    pixels: &mut [W],
    mut state: T,
    bend: B,
    draw: impl Fn(&mut W, &mut T),
    add: impl Fn(&mut T, B),
) {
    let (pairs, last) = pixels.as_chunks_mut::<2>();
    for [a, b] in pairs {
        draw(a, &mut state);
        draw(b, &mut state);
        add(&mut state, bend);
    }
    for pixel in last {
        draw(pixel, &mut state);
    }
}

#[inline]
pub(super) fn plus<const N: usize>(a: [i32; N], b: [i32; N]) -> [i32; N] {
    core::array::from_fn(|i| a[i].wrapping_add(b[i]))
}

/// Pixel by pixel.
pub(crate) struct Each<W, C>(C, PhantomData<fn() -> W>);

impl<W, C> Each<W, C> {
    pub(crate) const fn new(color: C) -> Self {
        Self(color, PhantomData)
    }
}

impl<W, const N: usize, C: Fn([i32; N]) -> W> Fill<N> for Each<W, C> {
    type Word = W;

    #[inline]
    fn pixel(&self, at: [i32; N]) -> W {
        (self.0)(at)
    }
}

/// Texels. Of a texture that repeats u and v are packed in one word.
///
/// For 2^a × 2^b texels the lower half of the word holds u with a integer and 16 − a fraction bits, the upper half v with b
/// and 16 − b: one addition steps both, and both repeat by themselves. Masking leaves the integer bits, and one
/// multiplication moves those of u below those of v:
///
/// ```text
///   vvvvvv00 00000000 uuuuuu00 00000000  · (1 + 2^(16 − b))  >> (32 − a − b)  =  vvvvvvuu uuuu
/// ```
///
/// With the number of texels an array's, the compiler sees that the index cannot be outside it: 9 cycles a pixel on a
/// Cortex-M0+ (13 if the run is bent) where a bounds check would make it 20. That is so for 32×32 and 64×64 texels and
/// whatever has as many.
///
/// A carry from u moves v by its last bit; steps are cut to their last bit towards zero. So runs are so short, before they
/// start anew from 32 bits, that all of that is 1/16 texel at most. What it is exactly [`Packing`](super::setup::Packing) has, so
/// that it makes nobody see the wrong side of a whole coordinate, or the opposite border.
pub(crate) struct Texels<'a, F> {
    texture: &'a Texture<'a>,
    is_packed: bool,
    format: PhantomData<F>,
}

impl<'a, F: PixelFormat> Texels<'a, F> {
    #[inline]
    pub(crate) fn new(texture: &'a Texture<'a>, scale_log2: u32) -> Self {
        Self { texture, is_packed: texture.is_packable(scale_log2), format: PhantomData }
    }

    /// Straight, from packed coordinates on.
    #[inline]
    fn run_sized<const COUNT: usize>(
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
        let (fours, rest) = pixels.as_chunks_mut::<4>();
        for four in fours {
            four.iter_mut().for_each(&mut draw);
        }
        rest.iter_mut().for_each(draw);
    }

    /// As [`in_pairs`], with which it is 4 % slower on a Cortex-M4.
    #[inline]
    fn bent_sized<const COUNT: usize>(
        &self,
        pixels: &mut [F::Word],
        texels: &[u16; COUNT],
        [mut packed, mut step, bend]: [u32; 3],
    ) {
        let texel = sized(self.texture, texels);
        let mut draw = |pixel: &mut F::Word, step: u32| {
            *pixel = F::rgb565(texel(packed));
            packed = packed.wrapping_add(step);
        };
        let (pairs, last) = pixels.as_chunks_mut::<2>();
        for [a, b] in pairs {
            draw(a, step);
            draw(b, step);
            step = step.wrapping_add(bend);
        }
        last.iter_mut().for_each(|pixel| draw(pixel, step));
    }

    /// Hands on blocks so short that truncated steps do not matter.
    #[inline(always)]
    fn in_blocks(
        &self,
        mut pixels: &mut [F::Word],
        [mut u, mut v]: [i32; 2],
        [u_step, v_step]: [i32; 2],
        run: impl Fn(&mut [F::Word], u32, u32),
    ) {
        let [a, b] = self.texture.log2();
        // After 64 pixels a truncated step is off by 1/16 texel of 64.
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

    /// Of any size.
    #[inline(never)]
    fn run_checked(&self, pixels: &mut [F::Word], packed: u32, step: u32, bend: u32) {
        let draw = |pixel: &mut F::Word, [packed, step]: &mut [u32; 2]| {
            *pixel = F::rgb565(self.texture.fetch_packed(*packed));
            *packed = packed.wrapping_add(*step);
        };
        in_pairs(pixels, [packed, step], bend, draw, |[_, step], bend| *step = step.wrapping_add(bend));
    }
}

/// Out of line: packed runs have the registers.
impl<F: PixelFormat> Texels<'_, F> {
    #[inline(never)]
    fn run_unpacked(&self, pixels: &mut [F::Word], at: [i32; 2], step: [i32; 2]) {
        Each::new(|at| self.pixel(at)).run_long(pixels, at, step);
    }

    #[inline(never)]
    fn bent_unpacked(&self, pixels: &mut [F::Word], at: [i32; 2], step: [i32; 2], bend: [i32; 2]) {
        Each::new(|at| self.pixel(at)).bent(pixels, at, step, bend);
    }
}

impl<F: PixelFormat> Fill<2> for Texels<'_, F> {
    type Word = F::Word;

    #[inline]
    fn longest(&self) -> i32 {
        if self.texture.is_large() { 8 } else { LONGEST as i32 }
    }

    #[inline]
    fn in_units(&self, i: usize, value: i32, scale_log2: u32) -> i32 {
        uv_in_units(self.texture, self.is_packed, i, value, scale_log2)
    }

    #[inline]
    fn pixel(&self, [u, v]: [i32; 2]) -> F::Word {
        F::rgb565(self.texture.fetch(u >> 16, v >> 16))
    }

    #[inline]
    fn run_long(&self, pixels: &mut [F::Word], at: [i32; 2], step: [i32; 2]) {
        if !self.is_packed {
            return self.run_unpacked(pixels, at, step);
        }
        let texels = self.texture.texels();
        if let Ok(texels) = <&[u16; 0x1000]>::try_from(texels) {
            self.in_blocks(pixels, at, step, |block, packed, step| {
                self.run_sized(block, texels, packed, step);
            });
        } else if let Ok(texels) = <&[u16; 0x400]>::try_from(texels) {
            self.in_blocks(pixels, at, step, |block, packed, step| {
                self.run_sized(block, texels, packed, step);
            });
        } else {
            self.in_blocks(pixels, at, step, |block, packed, step| self.run_checked(block, packed, step, 0));
        }
    }

    #[inline]
    fn longest_row(&self) -> i32 {
        longest_row_of(self.texture, self.is_packed)
    }

    #[inline]
    fn row<D: DepthFormat>(&self, row: Row<'_, F::Word, D>, [u, v]: [i32; 2], [u_step, v_step]: [i32; 2]) {
        if !self.is_packed {
            let [at, step] = [[u, v], [u_step, v_step]].map(|uv| uv.map(|value| value << row.scale_log2(0)));
            return row.draw(at, |at| plus(at, step), |at| self.pixel(at));
        }
        let [a, b] = self.texture.log2().map(|log2| log2.wrapping_sub(row.scale_log2(0)) & 31);
        let step = packed_step([shifted(u_step, a), shifted(v_step, b)]);
        let first = packed_from([u >> a, v >> b], u_step);
        row.draw_texels(self.texture, [first, step], (), |()| (), |texel, ()| F::rgb565(texel));
    }

    #[inline]
    fn bent(&self, pixels: &mut [F::Word], at: [i32; 2], step: [i32; 2], bend: [i32; 2]) {
        if !self.is_packed {
            return self.bent_unpacked(pixels, at, step, bend);
        }
        let packed = packed_from(at, step[0].wrapping_mul(2).wrapping_add(bend[0]));
        let (step, bend) = (packed_step(step), packed_step(bend));
        let texels = self.texture.texels();
        if let Ok(texels) = <&[u16; 0x1000]>::try_from(texels) {
            self.bent_sized(pixels, texels, [packed, step, bend]);
        } else if let Ok(texels) = <&[u16; 0x400]>::try_from(texels) {
            self.bent_sized(pixels, texels, [packed, step, bend]);
        } else {
            self.run_checked(pixels, packed, step, bend);
        }
    }
}

/// The texel at packed coordinates of a texture of so many.
#[inline]
pub(super) fn sized<const COUNT: usize>(texture: &Texture<'_>, texels: &[u16; COUNT]) -> impl Fn(u32) -> u16 {
    let [mask, multiplier] = texture.mask_and_multiplier();
    move |packed| texels[((packed & mask).wrapping_mul(multiplier) >> (32 - COUNT.trailing_zeros())) as usize]
}

/// [`Fill::longest_row`] of texels. Packed, a step is cut to 8 bits for 256 texels: after 15 it is off by 1/17 texel.
#[inline]
pub(super) fn longest_row_of(texture: &Texture<'_>, is_packed: bool) -> i32 {
    if is_packed && texture.is_large() { 15 } else { STRAIGHT }
}

/// u (`i` = 0) or v of I16F16 times 2^`scale_log2`, without the bits for which packed coordinates have no room.
#[inline]
pub(super) fn uv_in_units(
    texture: &Texture<'_>,
    is_packed: bool,
    i: usize,
    value: i32,
    scale_log2: u32,
) -> i32 {
    if is_packed { value >> (texture.log2()[i].wrapping_sub(scale_log2) & 31) } else { value << scale_log2 }
}

/// The place of a run, whose first step of u is negative or not.
#[inline]
pub(super) fn packed_from([u, v]: [i32; 2], u_step: i32) -> u32 {
    // A negative step of u borrows from v where u starts anew: lend it the last bit.
    ((v as u32) << 16 | (u as u32 & 0xffff)).wrapping_add((u_step as u32 >> 31) << 16)
}

/// A difference: u may be negative, and then borrows from v.
#[inline]
pub(super) fn packed_step([u, v]: [i32; 2]) -> u32 {
    ((v as u32) << 16).wrapping_add(u as u32)
}

/// A step of u without whole turns, which would be carried into v.
#[inline]
pub(super) fn turned(u_step: i32) -> i32 {
    (u_step as i16).into()
}

/// A step without its last bits, cut towards zero.
#[inline]
pub(super) fn shifted(step: i32, log2: u32) -> i32 {
    (step + ((step >> 31) & ((1 << log2) - 1))) >> log2
}
