//! The fill of texels times light, of a texture that repeats.
//!
//! - In: a run of pixels, and the curve of u, v and light.
//! - Out: words.
//! - Assumes: u and v are as for [`Texels`], and light as for [`Colors`](super::colors::Colors).

use super::channels::{Channels, lit};
use super::curve::Curve;
use super::fill::{Fill, FillRow, plus};
use super::light::Light;
use super::packed::{longest_row_of, packed_from, packed_step, shifted};
use super::row::Row;
use super::texels::Texels;
use super::units::Units;
use crate::frame::{DepthFormat, PixelFormat};
use crate::scene::Texture;
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
}

impl<const M: usize, F: PixelFormat, C: Channels<M>> Fill<F::Word> for LitTexels<'_, M, F, C> {
    fn units(&self) -> Units {
        Light::<M, F, C>::units(&self.texels())
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
