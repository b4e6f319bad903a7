//! The fill of texels times light, of a texture that repeats.
//!
//! - In: a run of pixels, and the curve of u, v and light.
//! - Out: words.
//! - Assumes: u and v are as for [`Texels`], and light as for [`Colors`](super::colors::Colors).

use super::channels::{Channels, Gray, RedBlueGreen, lit};
use super::curve::Curve;
use super::fill::{Fill, FillRow};
use super::light::Light;
use super::memory::Memory;
use super::packed::{bent, draw_texels, draw_texels_alone, integer_bits, place_of, step_of};
use super::texels::Texels;
use super::units::Units;
use crate::frame::{Depth16, PixelFormat};
use crate::num::IS_ARMV6M;
use crate::raster::TriangleSetup;
use crate::scene::Texture;
use core::hint::black_box;
use core::marker::PhantomData;
use embedded_graphics::pixelcolor::Rgb565;

/// Texels times `M` channels of light.
pub(crate) struct LitTexels<'a, const M: usize, F, C> {
    texture: &'a Texture<'a>,
    scale_log2: u32,
    is_packed: bool,
    channels: PhantomData<(F, C)>,
}

impl<'a, const M: usize, F: PixelFormat, C: Channels<M>> LitTexels<'a, M, F, C> {
    #[inline]
    pub(crate) fn new(texture: &'a Texture<'a>, scale_log2: u32) -> Self {
        Self { texture, scale_log2, is_packed: texture.is_packable(scale_log2), channels: PhantomData }
    }

    /// The texels alone.
    #[inline]
    fn texels(&self) -> Texels<'_, F> {
        Texels::new(self.texture, self.scale_log2)
    }
}

impl<const M: usize, F: PixelFormat, C: Channels<M>> Fill<F::Word> for LitTexels<'_, M, F, C> {
    fn units(&self) -> Units {
        Light::<M, F, C>::units(integer_bits(self.texture))
    }

    #[inline(never)]
    fn straight(&self, pixels: &mut [F::Word], line: &Curve) {
        Light::<M, F, C>::straight(&self.texels(), pixels, line);
    }

    #[inline(never)]
    fn table(&self, pixels: &mut [F::Word], curve: &Curve) {
        Light::<M, F, C>::table(&self.texels(), pixels, curve);
    }

    #[inline(never)]
    fn chords(&self, pixels: &mut [F::Word], curve: &Curve) {
        Light::<M, F, C>::chords(&self.texels(), pixels, curve);
    }
}

macro_rules! fill_row_of_lit_texels {
    ($n:literal, $m:literal, $draw_in_rgb565:ident) => {
        impl<F: PixelFormat, C: Channels<$m>> FillRow<$n> for LitTexels<'_, $m, F, C> {
            type Word = F::Word;
            type At = ([i32; 2], C);
            type Step = ([i32; 2], C);

            #[inline]
            fn at(&self, [u, v, light @ ..]: [i32; $n], (step, _): ([i32; 2], C)) -> ([i32; 2], C) {
                (place_of(self.texture, self.is_packed, [u, v], step), C::place(light))
            }

            #[inline]
            fn step(&self, [u, v, light @ ..]: [i32; $n]) -> ([i32; 2], C) {
                (step_of(self.texture, self.is_packed, [u, v]), C::step(light))
            }

            #[inline]
            fn bent(
                &self,
                setup: &TriangleSetup,
                along: ([i32; 2], i32),
                [_, _, light @ ..]: [i32; $n],
                [_, _, light_step @ ..]: [i32; $n],
            ) -> (([i32; 2], C), ([i32; 2], C)) {
                let (at, step) = bent(self.texture, self.is_packed, setup, along);
                ((at, C::place(light)), (step, C::step(light_step)))
            }

            #[inline]
            fn draw_in_rgb565<G: PixelFormat<Word = F::Word>>(
                &self,
                setup: &TriangleSetup,
                memory: &mut Memory<'_, u16, u16>,
            ) -> bool {
                $draw_in_rgb565(self.texture, self.scale_log2, setup, memory);
                true
            }

            #[inline]
            fn row(
                &self,
                pixels: &mut [F::Word],
                (at, light): ([i32; 2], C),
                (step, light_step): ([i32; 2], C),
            ) {
                let (texture, is_packed) = (self.texture, self.is_packed);
                if IS_ARMV6M && F::KEEPS {
                    draw_texels_alone::<F>(texture, is_packed, pixels, at, step);
                    return light_row::<$m, F, C>(pixels, light, light_step);
                }
                draw_texels(
                    texture,
                    is_packed,
                    pixels,
                    (at, light),
                    (step, light_step),
                    |texel, light: C| lit::<F>(texel, light.rgb()),
                );
            }
        }
    };
}

/// Light on texels that are there already. (Counted: on Armv6-M an iterator would take a few cycles more for the end of each row.)
#[inline(always)]
fn light_row<const M: usize, F: PixelFormat, C: Channels<M>>(pixels: &mut [F::Word], mut light: C, step: C) {
    let (count, mut i) = (pixels.len(), 0);
    while i < count
        && let Some(pixel) = pixels.get_mut(i)
    {
        *pixel = lit::<F>(F::texel(*pixel), light.rgb());
        light = light.plus(step);
        i += 1;
        black_box(());
    }
}

fill_row_of_lit_texels!(3, 1, draw_gray_in_rgb565);
fill_row_of_lit_texels!(5, 3, draw_rgb_in_rgb565);

#[inline(never)]
fn draw_gray_in_rgb565(
    texture: &Texture<'_>,
    scale_log2: u32,
    setup: &TriangleSetup,
    memory: &mut Memory<'_, u16, u16>,
) {
    let texels = LitTexels::<1, Rgb565, Gray>::new(for_rows(texture), scale_log2);
    memory.draw_small::<3, Depth16, _>(setup, &texels);
}

#[inline(never)]
fn draw_rgb_in_rgb565(
    texture: &Texture<'_>,
    scale_log2: u32,
    setup: &TriangleSetup,
    memory: &mut Memory<'_, u16, u16>,
) {
    let texels = LitTexels::<3, Rgb565, RedBlueGreen>::new(for_rows(texture), scale_log2);
    memory.draw_small::<5, Depth16, _>(setup, &texels);
}

/// A texture as loops over rows are to know it: hidden but on Armv6-M. Else what rows read of it would be kept for all of them, on the stack,
/// which takes 1 % longer on a Cortex-M4.
#[inline(always)]
fn for_rows<'a>(texture: &'a Texture<'a>) -> &'a Texture<'a> {
    if IS_ARMV6M { texture } else { black_box(texture) }
}
