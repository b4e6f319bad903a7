//! Light on texels.
//!
//! - In: a run of pixels, a fill of texels, and the curve of u, v and light.
//! - Out: words.
//! - Assumes: light is as for [`Colors`](super::colors::Colors).
//!
//! Texels come first, by the loops that draw them without light, and then light on them in place. On a Cortex-M0+, which has few
//! registers, that takes 46 cycles a pixel where one loop takes 71, and on a Cortex-M4 27 where one loop takes 30. Light looks 1/w
//! up again, as texels took its place. Of formats whose words do not [keep](PixelFormat::texel) a texel one loop makes both.

use super::channels::{Channels, lit};
use super::curve::{Curve, Linear, Ts};
use super::fill::{Fill, plus, some_of};
use super::units::Units;
use crate::frame::PixelFormat;
use core::hint::black_box;
use core::marker::PhantomData;

/// A fill of texels.
pub(super) trait FillTexels<F: PixelFormat>: Fill<F::Word> {
    /// The integer bits of u and v in its units.
    fn integer_bits(&self) -> [u32; 2];

    /// The texel at coordinates in its units.
    fn texel(&self, uv: [u32; 2]) -> u16;
}

/// `M` channels of light on texels.
pub(super) struct Light<const M: usize, F, C>(PhantomData<(F, C)>);

impl<const M: usize, F: PixelFormat, C: Channels<M>> Light<M, F, C> {
    /// For texels whose u and v have these integer bits.
    #[inline]
    pub(super) fn units([a, b]: [u32; 2]) -> Units {
        if M == 1 { Units::modular([a, b, 8]) } else { Units::modular([a, b, 8, 8, 8]) }
    }

    /// Along a straight line, I16F16.
    #[inline(always)]
    pub(super) fn straight(texels: &impl FillTexels<F>, pixels: &mut [F::Word], line: &Curve) {
        if F::KEEPS {
            texels.straight(pixels, line);
        }
        let lights = some_of::<M, _>(&line.lines, 2);
        let (mut at, step) = (lights.map(|line| line.at as i32), lights.map(|line| line.slope));
        let packed_step = C::step(step);
        if F::KEEPS && C::DROPPED == 0 {
            return Self::on(pixels, C::place(at), packed_step);
        }
        let ups = texels.integer_bits().map(|bits| (16 - bits) & 31);
        let [u, v, ..] = line.lines;
        let (mut uv, uv_step) =
            ([u.at << ups[0], v.at << ups[1]].map(|at| at as i32), [u.slope << ups[0], v.slope << ups[1]]);
        for block in pixels.chunks_mut(1 << C::RUN_LOG2) {
            if F::KEEPS {
                Self::on(block, C::place(at), packed_step);
            } else {
                Self::straight_at_once(texels, block, [uv, uv_step], [C::place(at), packed_step]);
                uv = plus(uv, uv_step.map(|step| step << C::RUN_LOG2));
            }
            at = plus(at, step.map(|step| step << C::RUN_LOG2));
        }
    }

    /// With 1/w at every pixel.
    #[inline(always)]
    pub(super) fn table(texels: &impl FillTexels<F>, pixels: &mut [F::Word], curve: &Curve) {
        if F::KEEPS {
            texels.table(pixels, curve);
            return Self::on_curve::<false>(pixels, curve);
        }
        Self::at_once::<false>(texels, pixels, curve);
    }

    /// With n/w at every pixel.
    #[inline(always)]
    pub(super) fn chords(texels: &impl FillTexels<F>, pixels: &mut [F::Word], curve: &Curve) {
        if F::KEEPS {
            texels.chords(pixels, curve);
            return Self::on_curve::<true>(pixels, curve);
        }
        Self::at_once::<true>(texels, pixels, curve);
    }

    /// Light on texels along a straight line. Not unrolled, nor is any other loop here: no register would be left.
    #[inline(never)]
    fn on(pixels: &mut [F::Word], mut light: C, step: C) {
        for pixel in pixels {
            *pixel = lit::<F>(F::texel(*pixel), light.rgb());
            light = light.plus(step);
            black_box(());
        }
    }

    #[inline(never)]
    fn on_curve<const CHORDS: bool>(pixels: &mut [F::Word], curve: &Curve) {
        let lines = some_of::<M, _>(&curve.lines, 2);
        let mut ts = Ts::<CHORDS>::new(curve);
        for pixel in pixels {
            let t = ts.next();
            *pixel = lit::<F>(F::texel(*pixel), C::rgb_modular(lines.map(|line| line.value(t))));
            black_box(());
        }
    }

    #[inline(never)]
    fn straight_at_once(
        texels: &impl FillTexels<F>,
        pixels: &mut [F::Word],
        [mut at, step]: [[i32; 2]; 2],
        [mut light, light_step]: [C; 2],
    ) {
        for pixel in pixels {
            *pixel = lit::<F>(texels.texel(at.map(|at| at as u32)), light.rgb());
            (at, light) = (plus(at, step), light.plus(light_step));
            black_box(());
        }
    }

    #[inline(never)]
    fn at_once<const CHORDS: bool>(texels: &impl FillTexels<F>, pixels: &mut [F::Word], curve: &Curve) {
        let [u, v, ..]: [Linear; 5] = curve.lines;
        let lines = some_of::<M, _>(&curve.lines, 2);
        let mut ts = Ts::<CHORDS>::new(curve);
        for pixel in pixels {
            let t = ts.next();
            let texel = texels.texel([u.value(t), v.value(t)]);
            *pixel = lit::<F>(texel, C::rgb_modular(lines.map(|line| line.value(t))));
            black_box(());
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::channels::{Gray, RedBlueGreen};
    use super::super::texels::Texels;
    use super::super::texels::tests::{curves, texels};
    use super::*;
    use crate::frame::BigEndian;
    use crate::scene::Texture;
    use embedded_graphics::pixelcolor::Rgb565;
    use proptest::prelude::*;
    use std::vec;

    fn passes_are_one_loop<const M: usize, F: PixelFormat<Word = u16>, C: Channels<M>>(
        texture: &Texture<'_>,
        curve: &Curve,
        count: usize,
    ) -> bool {
        let texels = Texels::<F>::new(texture, 0);
        let (mut passes, mut once) = (vec![1; count], vec![2; count]);
        Light::<M, F, C>::table(&texels, &mut passes, curve);
        Light::<M, F, C>::at_once::<false>(&texels, &mut once, curve);
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
