//! The fill of texels times light, of a texture that repeats.
//!
//! - In: a run of pixels, and the curve of u, v and light.
//! - Out: words.
//! - Assumes: u and v are as for [`Texels`], and light as for [`Colors`](super::colors::Colors).
//!
//! With 1/w at every pixel a Cortex-M0+ takes passes, because it has few registers: texels first, then light on them
//! in place. It looks 1/w up again, as texels took its place. On a Cortex-M4 one loop takes 30 cycles a pixel.

use super::channels::{Channels, lit};
use super::curve::{Curve, Linear};
use super::fill::{Fill, FillRow, plus, some_of};
use super::inverses::inverse;
use super::packed::{
    downs, integer_bits, lines_of, longest_row_of, packed_from, packed_step, shifted, turned,
};
use super::row::Row;
use super::texels::{Texels, packed_chord};
use super::units::Units;
use crate::frame::{DepthFormat, PixelFormat};
use crate::num::IS_ARMV6M;
use crate::raster::ATTRIBUTES;
use crate::scene::Texture;
use core::hint::black_box;
use core::marker::PhantomData;

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

    /// Packed coordinates, and light, along a straight line.
    #[inline(never)]
    fn run(&self, pixels: &mut [F::Word], [mut packed, step]: [u32; 2], [mut light, light_step]: [C; 2]) {
        // A copy stays in registers.
        let texture = *self.texture;
        for pixel in pixels {
            *pixel = lit::<F>(texture.fetch_packed(packed), light.rgb());
            (packed, light) = (packed.wrapping_add(step), light.plus(light_step));
            // Not unrolled: 1 KiB.
            black_box(());
        }
    }

    /// As [`LitTexels::run`], with u and v in 32 bits each, of which the texture's are the upper ones.
    #[inline(never)]
    fn run_unpacked(
        &self,
        pixels: &mut [F::Word],
        [at, step]: [[i32; 2]; 2],
        [mut light, light_step]: [C; 2],
    ) {
        let [u_down, v_down] = downs(self.texture);
        let (texture, mut at) = (*self.texture, at);
        for pixel in pixels {
            let texel = texture.fetch_repeat(at[0] >> u_down, at[1] >> v_down);
            *pixel = lit::<F>(texel, light.rgb());
            (at, light) = (plus(at, step), light.plus(light_step));
            // Not unrolled: 1 KiB.
            black_box(());
        }
    }

    /// Light on texels that are there already.
    #[inline(never)]
    fn light(&self, pixels: &mut [F::Word], curve: &Curve) {
        let lines = some_of::<M, _>(&curve.lines, 2);
        let (mut w, w_step) = (curve.w, curve.w_step);
        for pixel in pixels {
            let t = inverse(w);
            let light = C::place_modular(lines.map(|line| line.value(t)));
            *pixel = lit::<F>(F::texel(*pixel), light.rgb());
            w = w.wrapping_add(w_step);
            black_box(());
        }
    }

    #[inline(never)]
    fn table_at_once(&self, pixels: &mut [F::Word], curve: &Curve) {
        let ([a, _], [u, v]) = (self.texture.log2(), lines_of(self.texture, &curve.lines));
        let [u_down, v_down] = downs(self.texture);
        let lines = some_of::<M, _>(&curve.lines, 2);
        let texels = self.texture.texels();
        let (mut w, w_step) = (curve.w, curve.w_step);
        for pixel in pixels {
            let t = inverse(w);
            let index = (v.value(t) >> v_down) << a | u.value(t) >> u_down;
            let light = C::place_modular(lines.map(|line| line.value(t)));
            *pixel = lit::<F>(texels.get(index as usize).copied().unwrap_or_default(), light.rgb());
            w = w.wrapping_add(w_step);
            black_box(());
        }
    }
}

impl<const M: usize, F: PixelFormat, C: Channels<M>> Fill<F::Word> for LitTexels<'_, M, F, C> {
    fn units(&self) -> Units {
        let [a, b] = integer_bits(self.texture);
        if M == 1 { Units::modular([a, b, 8]) } else { Units::modular([a, b, 8, 8, 8]) }
    }

    #[inline(never)]
    fn straight(&self, pixels: &mut [F::Word], line: &Curve) {
        let [a, b] = self.texture.log2();
        let [Linear { at: u, slope: u_step }, Linear { at: v, slope: v_step }, ..] = line.lines;
        let (mut u, mut v) = (u as i32, v as i32);
        let lights = some_of::<M, _>(&line.lines, 2);
        let (mut light, light_step) = (lights.map(|line| line.at as i32), lights.map(|line| line.slope));
        let packed_light_step = C::step(light_step);
        let log2 = if self.is_packed && self.texture.is_large() { 3 } else { C::RUN_LOG2 };
        for block in pixels.chunks_mut(1 << log2) {
            let lights = [C::place(light), packed_light_step];
            if self.is_packed {
                let step = packed_step([turned(shifted(u_step, a)), shifted(v_step, b)]);
                self.run(block, [packed_from([u >> a, v >> b], u_step), step], lights);
            } else {
                let [a, b] = integer_bits(self.texture);
                let up = |[u, v]: [i32; 2]| [u << (16 - a), v << (16 - b)];
                self.run_unpacked(block, [up([u, v]), up([u_step, v_step])], lights);
            }
            (u, v) = (u.wrapping_add(u_step << log2), v.wrapping_add(v_step << log2));
            for (light, step) in light.iter_mut().zip(light_step) {
                *light = light.wrapping_add(step << log2);
            }
        }
    }

    #[inline(never)]
    fn table(&self, pixels: &mut [F::Word], curve: &Curve) {
        if IS_ARMV6M && F::KEEPS {
            Texels::<F>::new(self.texture, self.scale_log2).table(pixels, curve);
            return self.light(pixels, curve);
        }
        self.table_at_once(pixels, curve);
    }

    fn chord(&self, pixels: &mut [F::Word], lines: &[Linear; ATTRIBUTES]) {
        let [u, v, ..] = lines;
        let lights = C::modular(some_of(lines, 2));
        // Packed chords need more room at the ends of the range than large textures have.
        if self.is_packed && !self.texture.is_large() {
            self.run(pixels, packed_chord([u.at, v.at], [u.slope, v.slope]), lights);
        } else {
            self.run_unpacked(pixels, [[u.at as i32, v.at as i32], [u.slope, v.slope]], lights);
        }
    }
}

macro_rules! fill_row_of_lit_texels {
    ($n:literal, $m:literal) => {
        impl<F: PixelFormat, C: Channels<$m>> FillRow<$n> for LitTexels<'_, $m, F, C> {
            type Word = F::Word;

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
                self.row_of(row, ([u, v], [u_step, v_step]), (light, light_step));
            }
        }
    };
}

fill_row_of_lit_texels!(3, 1);
fill_row_of_lit_texels!(5, 3);

impl<const M: usize, F: PixelFormat, C: Channels<M>> LitTexels<'_, M, F, C> {
    #[inline]
    fn row_of<D: DepthFormat>(
        &self,
        row: Row<'_, F::Word, D>,
        ([u, v], [u_step, v_step]): ([i32; 2], [i32; 2]),
        (light, light_step): ([i32; M], [i32; M]),
    ) {
        let light_step = C::step(light_step);
        let light = C::place(light);
        if !self.is_packed {
            let up = |[u, v]: [i32; 2]| [u << row.scale_log2(0), v << row.scale_log2(1)];
            let (at, step) = (up([u, v]), up([u_step, v_step]));
            return row.draw(
                (at, light),
                |(at, light)| (plus(at, step), light.plus(light_step)),
                |([u, v], light)| lit::<F>(self.texture.fetch_repeat(u >> 16, v >> 16), light.rgb()),
            );
        }
        let [a, b] = self.texture.log2();
        let [a, b] = [a.wrapping_sub(row.scale_log2(0)) & 31, b.wrapping_sub(row.scale_log2(1)) & 31];
        let step = packed_step([shifted(u_step, a), shifted(v_step, b)]);
        let first = packed_from([u >> a, v >> b], u_step);
        let plus = |light: C| light.plus(light_step);
        row.draw_texels(self.texture, [first, step], light, plus, |texel, light| {
            lit::<F>(texel, light.rgb())
        });
    }
}

#[cfg(test)]
mod tests {
    use super::super::channels::{Gray, RedBlueGreen};
    use super::super::texels::tests::{curves, texels};
    use super::*;
    use crate::frame::BigEndian;
    use embedded_graphics::pixelcolor::Rgb565;
    use proptest::prelude::*;
    use std::vec;

    fn passes_are_one_loop<const M: usize, F: PixelFormat<Word = u16>, C: Channels<M>>(
        texture: &Texture<'_>,
        curve: &Curve,
        count: usize,
    ) -> bool {
        let fill = LitTexels::<M, F, C>::new(texture, 0);
        let (mut passes, mut once) = (vec![1; count], vec![2; count]);
        Texels::<F>::new(texture, 0).table(&mut passes, curve);
        fill.light(&mut passes, curve);
        fill.table_at_once(&mut once, curve);
        passes == once
    }

    proptest! {
        #![proptest_config(ProptestConfig { cases: 4_000, failure_persistence: None, ..ProptestConfig::default() })]
        #[test]
        fn one_loop_gives_the_bytes_of_texels_and_light_on_them_in_4_000_runs(
            (curve, count) in curves(),
            log2 in [0..=7_u32, 0..=7_u32],
        ) {
            let rows = texels(log2);
            let texture = Texture::new(&rows, log2[0], log2[1]);
            prop_assert!(passes_are_one_loop::<1, Rgb565, Gray>(&texture, &curve, count));
            prop_assert!(passes_are_one_loop::<3, Rgb565, RedBlueGreen>(&texture, &curve, count));
            prop_assert!(passes_are_one_loop::<3, BigEndian<Rgb565>, RedBlueGreen>(&texture, &curve, count));
        }
    }
}
