//! The fill of texels times light, of a texture that repeats.
//!
//! - In: a run of pixels, and the curve of u, v and light.
//! - Out: words.
//! - Assumes: u and v are as for [`Texels`], and light as for [`Colors`](super::colors::Colors).
//!
//! Texels come first, by the loops of [`Texels`], and then light on them in place: on a Cortex-M0+, which has few registers,
//! that takes 45 cycles a pixel where one loop takes 71, and on a Cortex-M4 27 where one loop takes 30. Of formats whose
//! words do not [keep](PixelFormat::texel) a texel one loop makes both.

use super::channels::{Channels, lit};
use super::curve::{Curve, Linear, distance};
use super::fill::{Fill, FillRow, each_chord, plus, some_of};
use super::inverses::inverse;
use super::packed::{downs, integer_bits, lines_of, longest_row_of, packed_from, packed_step, shifted};
use super::row::Row;
use super::texels::Texels;
use super::units::{Form, Units};
use crate::frame::{DepthFormat, PixelFormat};
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

    /// The texels alone.
    #[inline]
    fn texels(&self) -> Texels<'_, F> {
        Texels::new(self.texture, self.scale_log2)
    }

    /// Texels and light along a straight line. Of u and v the texture's bits are the upper ones of 32.
    #[inline(never)]
    fn at_once(&self, pixels: &mut [F::Word], [at, step]: [[i32; 2]; 2], [mut light, light_step]: [C; 2]) {
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

    /// Light along a straight line, I16F16, on texels that are there already.
    #[inline(never)]
    fn light_straight(pixels: &mut [F::Word], lines: &[Linear; ATTRIBUTES]) {
        let lines = some_of::<M, _>(lines, 2);
        let (mut at, step) = (lines.map(|line| line.at as i32), lines.map(|line| line.slope));
        let packed_step = C::step(step);
        if C::DROPPED == 0 {
            return Self::light_on(pixels, C::place(at), packed_step);
        }
        for block in pixels.chunks_mut(1 << C::RUN_LOG2) {
            Self::light_on(block, C::place(at), packed_step);
            for (at, step) in at.iter_mut().zip(step) {
                *at = at.wrapping_add(step << C::RUN_LOG2);
            }
        }
    }

    /// Light on texels, from packed channels on.
    #[inline(always)]
    fn light_on(pixels: &mut [F::Word], mut light: C, step: C) {
        // Not unrolled, nor is any other loop here: no register would be left.
        for pixel in pixels {
            *pixel = lit::<F>(F::texel(*pixel), light.rgb());
            light = light.plus(step);
            black_box(());
        }
    }

    /// Light with 1/w at every pixel, on texels that are there already.
    #[inline(never)]
    fn light_table(pixels: &mut [F::Word], curve: &Curve) {
        let lines = some_of::<M, _>(&curve.lines, 2);
        let (mut w, w_step) = (curve.w, curve.w_step);
        for pixel in pixels {
            let t = inverse(w);
            *pixel = lit::<F>(F::texel(*pixel), C::rgb_modular(lines.map(|line| line.value(t))));
            w = w.wrapping_add(w_step);
            black_box(());
        }
    }

    /// Light with n/w at every pixel, on texels that are there already.
    #[inline(never)]
    fn light_distances(pixels: &mut [F::Word], curve: &Curve) {
        let lines = some_of::<M, _>(&curve.lines, 2);
        let (mut w, mut n) = (curve.w, curve.n);
        for pixel in pixels {
            let t = distance(Form::Modular, w, n);
            *pixel = lit::<F>(F::texel(*pixel), C::rgb_modular(lines.map(|line| line.value(t))));
            (w, n) = (w.wrapping_add(curve.w_step), n.wrapping_add(curve.n_step));
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
            let texel = texels.get(index as usize).copied().unwrap_or_default();
            *pixel = lit::<F>(texel, C::rgb_modular(lines.map(|line| line.value(t))));
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
        if F::KEEPS {
            self.texels().straight(pixels, line);
            return Self::light_straight(pixels, &line.lines);
        }
        let [Linear { at: u, slope: u_step }, Linear { at: v, slope: v_step }, ..] = line.lines;
        let lights = some_of::<M, _>(&line.lines, 2);
        let (mut light, light_step) = (lights.map(|line| line.at as i32), lights.map(|line| line.slope));
        let [a, b] = integer_bits(self.texture);
        let up = |[u, v]: [i32; 2]| [u << (16 - a), v << (16 - b)];
        let (mut at, step) = (up([u as i32, v as i32]), up([u_step, v_step]));
        for block in pixels.chunks_mut(1 << C::RUN_LOG2) {
            self.at_once(block, [at, step], [C::place(light), C::step(light_step)]);
            at = plus(at, step.map(|step| step << C::RUN_LOG2));
            light = plus(light, light_step.map(|step| step << C::RUN_LOG2));
        }
    }

    #[inline(never)]
    fn table(&self, pixels: &mut [F::Word], curve: &Curve) {
        if F::KEEPS {
            self.texels().table(pixels, curve);
            return Self::light_table(pixels, curve);
        }
        self.table_at_once(pixels, curve);
    }

    #[inline(never)]
    fn chords(&self, pixels: &mut [F::Word], curve: &Curve) -> bool {
        if F::KEEPS {
            let texels = self.texels();
            if !texels.chords(pixels, curve) {
                each_chord(pixels, curve, &texels);
            }
            Self::light_distances(pixels, curve);
        }
        F::KEEPS
    }

    fn chord(&self, pixels: &mut [F::Word], lines: &[Linear; ATTRIBUTES]) {
        let [u, v, ..] = lines;
        let lights = C::modular(some_of(lines, 2));
        self.at_once(pixels, [[u.at as i32, v.at as i32], [u.slope, v.slope]], lights);
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
        LitTexels::<M, F, C>::light_table(&mut passes, curve);
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
