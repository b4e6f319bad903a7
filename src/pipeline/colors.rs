//! Runs of colours, and of texels times light.
//!
//! Of three channels each has 8 integer and 8 fraction bits here, and red and blue share a word: one addition steps both. Steps
//! are cut to their last bit towards zero, so that after 8 bent pixels or 16 straight ones a channel is off by 1/16 of 1/255 at
//! most. A single channel keeps its 16 fraction bits.

use super::fill::{
    Fill, in_pairs, longest_row_of, packed_from, packed_step, plus, shifted, turned, uv_in_units,
};
use super::patch::Row;
use crate::scene::Texture;
use crate::target::{DepthFormat, PixelFormat};
use core::marker::PhantomData;

/// `M` channels in as few words as they need; places, steps and bends alike.
pub(crate) trait Channels<const M: usize>: Copy {
    /// How many of 16 fraction bits are left out.
    const DROPPED: u32;
    /// The longest bent run, in pixels.
    const LONGEST: i32;
    /// Log₂ of the longest straight run that does not start anew from 32 bits, if bits are left out.
    const RUN_LOG2: u32;

    /// From channels without the bits left out.
    fn pack(channels: [i32; M]) -> Self;

    fn plus(self, other: Self) -> Self;

    /// From I16F16.
    #[inline]
    fn place(channels: [i32; M]) -> Self {
        Self::pack(channels.map(|channel| channel >> Self::DROPPED))
    }

    /// From a step in I16F16, cut towards zero.
    #[inline]
    fn step(step: [i32; M]) -> Self {
        Self::pack(step.map(|step| shifted(step, Self::DROPPED)))
    }

    /// Red, green and blue, 0 … 255.
    fn rgb(self) -> [u32; 3];

    #[inline]
    fn word<F: PixelFormat>(self) -> F::Word {
        color::<F>(self.rgb())
    }
}

/// One channel for all three.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Gray(i32);

impl Channels<1> for Gray {
    const DROPPED: u32 = 0;
    const LONGEST: i32 = super::walk::LONGEST as i32;
    const RUN_LOG2: u32 = 5;

    #[inline]
    fn pack([gray]: [i32; 1]) -> Self {
        Self(gray)
    }

    #[inline]
    fn plus(self, other: Self) -> Self {
        Self(self.0.wrapping_add(other.0))
    }

    #[inline]
    fn rgb(self) -> [u32; 3] {
        [self.0 as u32 >> 16; 3]
    }

    #[inline]
    fn word<F: PixelFormat>(self) -> F::Word {
        F::gray((self.0 >> 16) as u8)
    }
}

/// Red above blue, and green.
#[derive(Clone, Copy, Debug)]
pub(crate) struct RedBlueGreen(i32, i32);

impl Channels<3> for RedBlueGreen {
    const DROPPED: u32 = 8;
    const LONGEST: i32 = 8;
    const RUN_LOG2: u32 = 4;

    #[inline]
    fn pack([red, green, blue]: [i32; 3]) -> Self {
        // Blue is never below 0 at a pixel, so what a negative step borrows from red is given back.
        Self((red << 16).wrapping_add(blue), green)
    }

    #[inline]
    fn plus(self, other: Self) -> Self {
        Self(self.0.wrapping_add(other.0), self.1.wrapping_add(other.1))
    }

    #[inline]
    fn rgb(self) -> [u32; 3] {
        [self.0 as u32 >> 24, self.1 as u32 >> 8, (self.0 as u32 >> 8) & 0xff]
    }
}

/// Gouraud shading.
pub(crate) struct Colors<F, C>(PhantomData<(F, C)>);

impl<F, C> Colors<F, C> {
    pub(crate) const NEW: Self = Self(PhantomData);
}

impl<F: PixelFormat, C: Channels<M>, const M: usize> Fill<M> for Colors<F, C> {
    type Word = F::Word;

    #[inline]
    fn longest(&self) -> i32 {
        C::LONGEST
    }

    #[inline]
    fn in_units(&self, _i: usize, value: i32, _scale_log2: u32) -> i32 {
        value >> C::DROPPED
    }

    #[inline]
    fn pixel(&self, at: [i32; M]) -> F::Word {
        C::place(at).word::<F>()
    }

    #[inline(never)]
    fn run_long(&self, pixels: &mut [F::Word], mut at: [i32; M], step: [i32; M]) {
        let packed_step = C::step(step);
        let run = |pixels: &mut [F::Word], at: [i32; M]| {
            let mut packed = C::place(at);
            for pixel in pixels {
                *pixel = packed.word::<F>();
                packed = packed.plus(packed_step);
            }
        };
        if C::DROPPED == 0 {
            return run(pixels, at);
        }
        for block in pixels.chunks_mut(1 << C::RUN_LOG2) {
            run(block, at);
            for (at, step) in at.iter_mut().zip(step) {
                *at = at.wrapping_add(step << C::RUN_LOG2);
            }
        }
    }

    #[inline]
    fn longest_row(&self) -> i32 {
        (1 << C::RUN_LOG2) - 1
    }

    #[inline]
    fn row<D: DepthFormat>(&self, row: Row<'_, F::Word, D>, at: [i32; M], step: [i32; M]) {
        let step = C::step(step);
        let first = C::place(at);
        row.draw(first, |at| at.plus(step), |at| at.word::<F>());
    }

    #[inline]
    fn bent(&self, pixels: &mut [F::Word], at: [i32; M], step: [i32; M], bend: [i32; M]) {
        let draw = |pixel: &mut F::Word, [at, step]: &mut [C; 2]| {
            *pixel = at.word::<F>();
            *at = at.plus(*step);
        };
        in_pairs(pixels, [at, step].map(C::pack), C::pack(bend), draw, |[_, step], bend| {
            *step = step.plus(bend);
        });
    }
}

/// Texels times light; of a texture that repeats, with coordinates packed as [`Texels`](super::Texels) has them.
pub(crate) struct LitTexels<'a, F, C> {
    texture: &'a Texture<'a>,
    is_packed: bool,
    channels: PhantomData<(F, C)>,
}

impl<'a, F: PixelFormat, C> LitTexels<'a, F, C> {
    #[inline]
    pub(crate) fn new(texture: &'a Texture<'a>, scale_log2: u32) -> Self {
        Self { texture, is_packed: texture.is_packable(scale_log2), channels: PhantomData }
    }

    /// A straight run from a place of u and v, and of light, with the step of each, in the units of bent runs.
    #[inline]
    fn run<const M: usize>(
        &self,
        pixels: &mut [F::Word],
        [at, step]: [[i32; 2]; 2],
        [mut light, light_step]: [C; 2],
    ) where
        C: Channels<M>,
    {
        if !self.is_packed {
            return self.run_unpacked(pixels, [at, step], [light, light_step]);
        }
        let (mut packed, step) = (packed_from(at, step[0]), packed_step([turned(step[0]), step[1]]));
        for pixel in pixels {
            *pixel = lit::<F>(self.texture.fetch_packed(packed), light.rgb());
            (packed, light) = (packed.wrapping_add(step), light.plus(light_step));
        }
    }

    /// As [`LitTexels::run`] of a texture that is not packable.
    #[inline(never)]
    fn run_unpacked<const M: usize>(
        &self,
        pixels: &mut [F::Word],
        [mut at, step]: [[i32; 2]; 2],
        [mut light, light_step]: [C; 2],
    ) where
        C: Channels<M>,
    {
        for pixel in pixels {
            *pixel = lit::<F>(self.texture.fetch(at[0] >> 16, at[1] >> 16), light.rgb());
            (at, light) = (plus(at, step), light.plus(light_step));
            // Not unrolled: 1 KiB.
            core::hint::black_box(());
        }
    }

    /// A bent run: where u and v, and light, begin, their steps, and what is added to these after every second pixel.
    #[inline]
    fn bend<const M: usize>(
        &self,
        pixels: &mut [F::Word],
        [at, step, bend]: [[i32; 2]; 3],
        [light, light_step, light_bend]: [C; 3],
    ) where
        C: Channels<M>,
    {
        if !self.is_packed {
            return self.bend_unpacked(pixels, [at, step, bend], [light, light_step, light_bend]);
        }
        let packed = packed_from(at, step[0].wrapping_mul(2).wrapping_add(bend[0]));
        let (step, bend, light) = (packed_step(step), packed_step(bend), [light, light_step]);
        let draw = |pixel: &mut F::Word, (at, light): &mut ([u32; 2], [C; 2])| {
            *pixel = lit::<F>(self.texture.fetch_packed(at[0]), light[0].rgb());
            (at[0], light[0]) = (at[0].wrapping_add(at[1]), light[0].plus(light[1]));
        };
        in_pairs(pixels, ([packed, step], light), (bend, light_bend), draw, |(at, light), bend| {
            (at[1], light[1]) = (at[1].wrapping_add(bend.0), light[1].plus(bend.1));
        });
    }

    /// As [`LitTexels::bend`] of a texture that is not packable.
    #[inline(never)]
    fn bend_unpacked<const M: usize>(
        &self,
        pixels: &mut [F::Word],
        [at, step, bend]: [[i32; 2]; 3],
        [light, light_step, light_bend]: [C; 3],
    ) where
        C: Channels<M>,
    {
        let light = [light, light_step];
        let draw = |pixel: &mut F::Word, (at, light): &mut ([[i32; 2]; 2], [C; 2])| {
            let [[u, v], step] = *at;
            *pixel = lit::<F>(self.texture.fetch(u >> 16, v >> 16), light[0].rgb());
            (at[0], light[0]) = (plus([u, v], step), light[0].plus(light[1]));
        };
        in_pairs(pixels, ([at, step], light), (bend, light_bend), draw, |(at, light), bend| {
            (at[1], light[1]) = (plus(at[1], bend.0), light[1].plus(bend.1));
        });
    }

    #[inline]
    fn short<D: DepthFormat, const M: usize>(
        &self,
        row: Row<'_, F::Word, D>,
        ([u, v], [u_step, v_step]): ([i32; 2], [i32; 2]),
        (light, light_step): ([i32; M], [i32; M]),
    ) where
        C: Channels<M>,
    {
        let light_step = C::step(light_step);
        let light = C::place(light);
        if !self.is_packed {
            let [at, step] = [[u, v], [u_step, v_step]].map(|uv| uv.map(|value| value << row.scale_log2(0)));
            return row.draw(
                (at, light),
                |(at, light)| (plus(at, step), light.plus(light_step)),
                |([u, v], light)| lit::<F>(self.texture.fetch(u >> 16, v >> 16), light.rgb()),
            );
        }
        let [a, b] = self.texture.log2().map(|log2| log2.wrapping_sub(row.scale_log2(0)) & 31);
        let step = packed_step([shifted(u_step, a), shifted(v_step, b)]);
        let first = packed_from([u >> a, v >> b], u_step);
        let plus = |light: C| light.plus(light_step);
        row.draw_texels(self.texture, [first, step], light, plus, |texel, light| {
            lit::<F>(texel, light.rgb())
        });
    }

    #[inline]
    fn long<const M: usize>(
        &self,
        pixels: &mut [F::Word],
        (mut at, step): ([i32; 2], [i32; 2]),
        (mut light, light_step): ([i32; M], [i32; M]),
    ) where
        C: Channels<M>,
    {
        let [a, b] = if self.is_packed { self.texture.log2() } else { [0; 2] };
        let unit_step = [shifted(step[0], a), shifted(step[1], b)];
        let packed_light_step = C::step(light_step);
        let log2 = if self.is_packed && self.texture.is_large() { 3 } else { C::RUN_LOG2 };
        for block in pixels.chunks_mut(1 << log2) {
            let packed_light = C::place(light);
            self.run(block, [[at[0] >> a, at[1] >> b], unit_step], [packed_light, packed_light_step]);
            at = [at[0].wrapping_add(step[0] << log2), at[1].wrapping_add(step[1] << log2)];
            for (light, step) in light.iter_mut().zip(light_step) {
                *light = light.wrapping_add(step << log2);
            }
        }
    }
}

macro_rules! fill_of_lit_texels {
    ($n:literal, $m:literal) => {
        impl<F: PixelFormat, C: Channels<$m>> Fill<$n> for LitTexels<'_, F, C> {
            type Word = F::Word;

            #[inline]
            fn longest(&self) -> i32 {
                if self.is_packed && self.texture.is_large() { 8 } else { C::LONGEST }
            }

            #[inline]
            fn in_units(&self, i: usize, value: i32, scale_log2: u32) -> i32 {
                if i < 2 {
                    uv_in_units(self.texture, self.is_packed, i, value, scale_log2)
                } else {
                    value >> C::DROPPED
                }
            }

            #[inline]
            fn pixel(&self, [u, v, light @ ..]: [i32; $n]) -> F::Word {
                let light = C::place(light);
                lit::<F>(self.texture.fetch(u >> 16, v >> 16), light.rgb())
            }

            #[inline]
            fn run_long(
                &self,
                pixels: &mut [F::Word],
                [u, v, light @ ..]: [i32; $n],
                [u_step, v_step, light_step @ ..]: [i32; $n],
            ) {
                self.long(pixels, ([u, v], [u_step, v_step]), (light, light_step));
            }

            #[inline]
            fn longest_row(&self) -> i32 {
                longest_row_of(self.texture, self.is_packed).min((1 << C::RUN_LOG2) - 1)
            }

            #[inline]
            fn row<D: DepthFormat>(
                &self,
                row: Row<'_, F::Word, D>,
                [u, v, light @ ..]: [i32; $n],
                [u_step, v_step, light_step @ ..]: [i32; $n],
            ) {
                self.short(row, ([u, v], [u_step, v_step]), (light, light_step));
            }

            #[inline]
            fn bent(&self, pixels: &mut [F::Word], at: [i32; $n], step: [i32; $n], bend: [i32; $n]) {
                let ([u, v, at @ ..], [u_step, v_step, step @ ..]) = (at, step);
                let [u_bend, v_bend, bend @ ..] = bend;
                let uv = [[u, v], [u_step, v_step], [u_bend, v_bend]];
                self.bend(pixels, uv, [at, step, bend].map(C::pack));
            }
        }
    };
}

fill_of_lit_texels!(3, 1);
fill_of_lit_texels!(5, 3);

/// The word of whole channels, 0 … 255.
#[inline]
pub(crate) fn color<F: PixelFormat>([red, green, blue]: [u32; 3]) -> F::Word {
    F::rgb888(red as u8, green as u8, blue as u8)
}

/// A texel times light.
#[inline]
pub(crate) fn lit<F: PixelFormat>(texel: u16, light: [u32; 3]) -> F::Word {
    // 0 … 256, so that full light leaves a texel as it is.
    let [red, green, blue] = light.map(|light| light + (light >> 7));
    let texel = u32::from(texel);
    let red = (((texel & 0xf800) * red) >> 8) & 0xf800;
    let green = (((texel & 0x07e0) * green) >> 8) & 0x07e0;
    let blue = ((texel & 0x001f) * blue) >> 8;
    F::rgb565((red | green | blue) as u16)
}
