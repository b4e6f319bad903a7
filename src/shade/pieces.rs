//! The fill of texels of a texture that does not just repeat: beyond its borders it is clamped or mirrored.
//!
//! - In: a run of pixels, and the curve of u and v, which does not wrap.
//! - Out: words.
//! - Assumes: u and v stay where [`uv_bits`](super::border::uv_bits) of the triangle says.
//!
//! Along a run u and v are monotonic. So a run is split where it [enters](super::crossings) another [cell](super::border), and [`Texels`]
//! draws the pieces. Most runs have one: they are drawn as they are. Only mirrored textures have more than three cells to a side; where cells
//! are a few pixels long each pixel is folded by itself.
//!
//! Along chords the coordinates of the pixels between nodes lie between those of the nodes, in the cell.

use super::border::{Border, Side};
use super::channels::Channels;
use super::crossings::{Ends, Way, enter_curved, enter_straight, shifted_up};
use super::curve::{Curve, Linear};
use super::fill::Fill;
use super::light::{FillTexels, Light};
use super::loops::Loops;
use super::packed::{downs, integer_bits};
use super::passes::leave_apart;
use super::texels::Texels;
use super::units::Units;
use crate::frame::PixelFormat;
use crate::raster::ATTRIBUTES;
use crate::scene::Texture;
use core::hint::black_box;
use core::marker::PhantomData;

/// The most integer bits: slopes are left with 7 fraction bits, and over 7 times 1/w lose 1/18 texel.
const MOST_BITS: u32 = 12;
/// The most of them for chords, whose slopes count up to 511 times: 1/128 texel.
const MOST_BITS_OF_CHORDS: u32 = 9;
/// The fewest pixels that a cell has on the average, for pieces to pay.
const FEWEST: u32 = 16;

/// Texels of a texture with borders.
pub(crate) struct Bordered<'a, F, B> {
    texels: Texels<'a, F>,
    texture: &'a Texture<'a>,
    /// In I16F16, as straight lines are, and in the units of curves.
    straight: [Side; 2],
    curved: [Side; 2],
    border: PhantomData<B>,
}

impl<'a, F: PixelFormat, B: Border> Bordered<'a, F, B> {
    /// Whether coordinates with so many integer bits are not too many for it.
    #[inline]
    pub(crate) fn fits(uv_bits: [u32; 2]) -> bool {
        uv_bits.iter().all(|bits| *bits <= MOST_BITS)
    }

    /// For coordinates with so many integer bits, which fit. Not inlined, so that it is made where it stays.
    #[inline(never)]
    pub(crate) fn new(texture: &'a Texture<'a>, scale_log2: u32, uv_bits: [u32; 2]) -> Self {
        let (log2, own_bits) = (texture.log2(), integer_bits(texture));
        let sides = |bits: [u32; 2]| [0, 1].map(|i| Side::new(log2[i], own_bits[i], bits[i]));
        let (straight, curved) = (sides([16; 2]), sides([0, 1].map(|i| uv_bits[i].max(own_bits[i] + 1))));
        Self { texels: Texels::new(texture, scale_log2), texture, straight, curved, border: PhantomData }
    }

    /// Draws a straight run in pieces. For so many pixels u and v are `inside`.
    #[inline(always)]
    fn straight_pieces(&self, mut pixels: &mut [F::Word], line: &Curve, inside: [u32; 2]) {
        let [u, v, ..] = line.lines;
        let lines = [u, v];
        let end = pixels.len() as u32;
        if Self::are_short(&lines, &self.straight, [0, end.wrapping_sub(1)], end) {
            return self.one_by_one_straight(pixels, lines);
        }
        let (mut first, mut left, mut part) = (0, inside, lines);
        loop {
            let this = black_box(self);
            for i in 0..2 {
                if left[i] == 0 {
                    part[i] = Linear { at: line.lines[i].value(first), ..line.lines[i] };
                    left[i] = enter_straight::<B>(&this.straight[i], &mut part[i], end - first);
                }
            }
            let count = left[0].min(left[1]);
            let Some((piece, rest)) = pixels.split_at_mut_checked(count as usize) else {
                return;
            };
            this.straight_piece(piece, &part);
            if rest.is_empty() {
                return;
            }
            (pixels, first) = (rest, first + count);
            for i in 0..2 {
                left[i] -= count;
                part[i].at = part[i].value(count);
            }
        }
    }

    /// Whether the cells of a mirrored texture are a few pixels long.
    #[inline(always)]
    fn are_short(lines: &[Linear; 2], sides: &[Side; 2], [t, t_last]: [u32; 2], count: u32) -> bool {
        let borders = |(line, side): (&Linear, &Side)| B::borders([line.value(t), line.value(t_last)], side);
        B::IS_MIRROR && lines.iter().zip(sides).map(borders).sum::<u32>() * FEWEST > count
    }

    #[inline(always)]
    fn straight_piece(&self, pixels: &mut [F::Word], lines: &[Linear; 2]) {
        let [u, v] = *lines;
        if u.slope | v.slope == 0 {
            return self.fill(pixels, u.at >> 16, v.at >> 16);
        }
        if B::IS_MIRROR {
            return self.texels.lines(pixels, &[u, self.texels.lending_nothing(u, v)]);
        }
        self.texels.lines(pixels, lines);
    }

    /// Fills pixels with a texel.
    #[inline(always)]
    fn fill(&self, pixels: &mut [F::Word], u: u32, v: u32) {
        let word = F::rgb565(self.texture.fetch_repeat(u as i32, v as i32));
        pixels.fill(word);
    }

    /// Likewise, in less flash.
    #[inline(never)]
    fn fill_apart(&self, pixels: &mut [F::Word], u: u32, v: u32) {
        let word = F::rgb565(self.texture.fetch_repeat(u as i32, v as i32));
        for pixel in pixels {
            *pixel = word;
            black_box(());
        }
    }

    /// Draws a curved run.
    #[inline(never)]
    fn curved(&self, mut pixels: &mut [F::Word], curve: &Curve, way: Way) {
        let end = pixels.len() as u32;
        let [u, v, ..] = curve.lines;
        let mut ends = Ends { t: way.t(curve, 0), last: way.t(curve, end.wrapping_sub(1)), way };
        let inside = |line: Linear, side: &Side| {
            if B::is_inside([line.value(ends.t), line.value(ends.last)], side) { end } else { 0 }
        };
        let mut left = [inside(u, &self.curved[0]), inside(v, &self.curved[1])];
        if left[0] & left[1] == 0 && Self::are_short(&[u, v], &self.curved, [ends.t, ends.last], end) {
            return self.one_by_one(pixels, curve, [u, v], way);
        }
        let [u, v] = [(u, 0), (v, 1)].map(|(line, i)| shifted_up(line, self.curved[i].spare_bits()));
        // Lines that are not read are copies: zeros would be filled in by a call.
        let mut part = Curve { lines: [u, v, v, v, v], down: [0; ATTRIBUTES], ..*curve };
        loop {
            let this = black_box(self);
            let most = pixels.len() as u32;
            for (i, left) in left.iter_mut().enumerate() {
                if *left == 0 {
                    *left = enter_curved::<B>(&this.curved[i], curve, &mut part, i, (&ends, most));
                }
            }
            let count = left[0].min(left[1]);
            let Some((piece, rest)) = pixels.split_at_mut_checked(count as usize) else {
                return;
            };
            this.curved_piece(piece, &part, way);
            if rest.is_empty() {
                return;
            }
            pixels = rest;
            left = left.map(|left| left - count);
            part.go_on(count);
            ends.t = way.t(&part, 0);
        }
    }

    #[inline(always)]
    fn curved_piece(&self, pixels: &mut [F::Word], curve: &Curve, way: Way) {
        let [u, v, ..] = curve.lines;
        if u.slope | v.slope == 0 {
            let [u_down, v_down] = downs(self.texture);
            return self.fill_apart(pixels, u.at >> u_down, v.at >> v_down);
        }
        if way == Way::Table {
            self.texels.table(pixels, curve);
        } else if self.curved.iter().any(|side| u32::from(side.bits) > MOST_BITS_OF_CHORDS) {
            self.texels.each_any::<F, true>(pixels, curve);
        } else if B::IS_MIRROR {
            self.texels.chords_of::<F, true>(pixels, curve);
        } else {
            self.texels.chords(pixels, curve);
        }
    }

    /// Draws a mirrored texture whose cells are a few pixels long.
    #[inline(never)]
    fn one_by_one(&self, pixels: &mut [F::Word], curve: &Curve, lines: [Linear; 2], way: Way) {
        let [u, v] = Self::folding(lines, &self.curved);
        let texel = self.folded_texel();
        if way == Way::Chords {
            Loops::each::<F, true>(pixels, curve, [u, v], leave_apart::<true, F>, texel);
        } else {
            Loops::each::<F, false>(pixels, curve, [u, v], leave_apart::<false, F>, texel);
        }
    }

    /// Likewise, of a straight run.
    #[inline(never)]
    fn one_by_one_straight(&self, pixels: &mut [F::Word], lines: [Linear; 2]) {
        let [u, v] = Self::folding(lines, &self.straight);
        let (mut at, texel) = ([u.at, v.at], self.folded_texel());
        for pixel in pixels {
            *pixel = F::rgb565(texel(at[0], at[1]));
            at = [at[0].wrapping_add_signed(u.slope), at[1].wrapping_add_signed(v.slope)];
            black_box(());
        }
    }

    /// Lines whose sign says whether they are turned round; below that are the texture's bits.
    #[inline(always)]
    fn folding([u, v]: [Linear; 2], [a, b]: &[Side; 2]) -> [Linear; 2] {
        [shifted_up(u, a.spare_bits() - 1), shifted_up(v, b.spare_bits() - 1)]
    }

    #[inline(always)]
    fn folded_texel(&self) -> impl Fn(u32, u32) -> u16 + use<'a, F, B> {
        let ([a_down, b_down], texture) = (downs(self.texture), *self.texture);
        move |u, v| texture.fetch_repeat((folded(u) >> a_down) as i32, (folded(v) >> b_down) as i32)
    }
}

/// The lower 31 bits, turned round if the sign is set, as the upper ones.
#[inline(always)]
fn folded(at: u32) -> u32 {
    at << 1 ^ (at as i32 >> 31) as u32
}

impl<F: PixelFormat, B: Border> FillTexels<F> for Bordered<'_, F, B> {
    #[inline]
    fn integer_bits(&self) -> [u32; 2] {
        [0, 1].map(|i| self.curved[i].bits.into())
    }

    #[inline]
    fn texel(&self, [u, v]: [u32; 2]) -> u16 {
        let [a, b] = self.integer_bits().map(|bits| (32 - bits) & 31);
        B::texel(self.texture, u as i32 >> a, v as i32 >> b)
    }
}

impl<F: PixelFormat, B: Border> Fill<F::Word> for Bordered<'_, F, B> {
    fn units(&self) -> Units {
        Units::modular(self.integer_bits())
    }

    #[inline(never)]
    fn straight(&self, pixels: &mut [F::Word], line: &Curve) {
        let count = pixels.len() as u32;
        let last = count.wrapping_sub(1);
        let [u, v, ..] = line.lines;
        let inside = |line: Linear, side: &Side| {
            if B::is_inside([line.at, line.value(last)], side) { count } else { 0 }
        };
        let inside = [inside(u, &self.straight[0]), inside(v, &self.straight[1])];
        let lends = B::IS_MIRROR && u.slope < 0;
        if !lends && inside[0] & inside[1] == count {
            return self.texels.straight(pixels, line);
        }
        self.straight_pieces(pixels, line, inside);
    }

    fn table(&self, pixels: &mut [F::Word], curve: &Curve) {
        self.curved(pixels, curve, Way::Table);
    }

    fn chords(&self, pixels: &mut [F::Word], curve: &Curve) {
        self.curved(pixels, curve, Way::Chords);
    }
}

/// These texels times `M` channels of light.
pub(crate) struct LitBordered<'a, const M: usize, F, B, C>(Bordered<'a, F, B>, PhantomData<C>);

impl<'a, const M: usize, F: PixelFormat, B: Border, C: Channels<M>> LitBordered<'a, M, F, B, C> {
    /// As [`Bordered::new`].
    #[inline]
    pub(crate) fn new(texture: &'a Texture<'a>, scale_log2: u32, uv_bits: [u32; 2]) -> Self {
        Self(Bordered::new(texture, scale_log2, uv_bits), PhantomData)
    }
}

impl<const M: usize, F: PixelFormat, B: Border, C: Channels<M>> Fill<F::Word>
    for LitBordered<'_, M, F, B, C>
{
    fn units(&self) -> Units {
        Light::<M, F, C>::units(self.0.integer_bits())
    }

    #[inline(never)]
    fn straight(&self, pixels: &mut [F::Word], line: &Curve) {
        Light::<M, F, C>::straight(&self.0, pixels, line);
    }

    #[inline(never)]
    fn table(&self, pixels: &mut [F::Word], curve: &Curve) {
        Light::<M, F, C>::table(&self.0, pixels, curve);
    }

    #[inline(never)]
    fn chords(&self, pixels: &mut [F::Word], curve: &Curve) {
        Light::<M, F, C>::chords(&self.0, pixels, curve);
    }
}

#[cfg(test)]
mod tests {
    use super::super::border::{Clamp, Mirror};
    use super::super::texels::tests::{curves, texels};
    use super::*;
    use embedded_graphics::pixelcolor::Rgb565;
    use proptest::prelude::*;
    use std::vec;
    use std::vec::Vec;

    /// Whether pieces show at every pixel the texel that the border has at its own coordinates.
    fn pieces_are_pixels<B: Border>(texture: &Texture<'_>, bits: u32, curve: &Curve, count: usize) -> bool {
        let fill = Bordered::<Rgb565, B>::new(texture, 0, [bits; 2]);
        let mut drawn = vec![0; count];
        fill.table(&mut drawn, curve);
        let [u, v, ..] = curve.lines;
        let pixels: Vec<_> = (0..count as u32)
            .map(|n| Way::Table.t(curve, n))
            .map(|t| fill.texel([u.value(t), v.value(t)]))
            .collect();
        drawn == pixels
    }

    /// Whether straight pieces show at every pixel a texel that the border has within 1/16 texel of its coordinates.
    fn straight_pieces_are_pixels<B: Border>(texture: &Texture<'_>, line: &Curve, count: usize) -> bool {
        let fill = Bordered::<Rgb565, B>::new(texture, 0, [MOST_BITS; 2]);
        let mut drawn = vec![0; count];
        fill.straight(&mut drawn, line);
        let [u, v, ..] = line.lines;
        drawn.iter().zip(0..).all(|(&word, n)| {
            let near = |line: Linear| [-1, 0, 1].map(|off| (line.value(n) as i32 + (off << 12)) >> 16);
            near(u).iter().any(|&u| near(v).iter().any(|&v| B::texel(texture, u, v) == word))
        })
    }

    proptest! {
        #![proptest_config(ProptestConfig { cases: 4_000, failure_persistence: None, ..ProptestConfig::default() })]
        #[test]
        fn straight_runs_in_pieces_are_their_pixels_one_by_one_in_4_000_runs(
            ends in prop::array::uniform4((-2000..2000_i32, 0..12_u32)),
            count in 1..200_usize,
            log2 in prop_oneof![Just([6, 6]), Just([5, 5]), [0..=7_u32, 0..=7_u32]],
        ) {
            let mut line = Curve::default();
            let texels = ends.map(|(texel, scale)| (texel << 16) >> scale);
            for (line, (from, to)) in line.lines.iter_mut().zip([(texels[0], texels[1]), (texels[2], texels[3])]) {
                *line = Linear { at: from as u32, slope: (to - from) / count as i32 };
            }
            let rows = self::texels(log2);
            let texture = Texture::new(&rows, log2[0], log2[1]);
            prop_assert!(straight_pieces_are_pixels::<Clamp>(&texture, &line, count));
            prop_assert!(straight_pieces_are_pixels::<Mirror>(&texture, &line, count));
        }

        #[test]
        fn runs_in_pieces_are_their_pixels_one_by_one_in_4_000_runs(
            (mut curve, count) in curves(),
            log2 in prop_oneof![Just([6, 6]), Just([5, 5]), [0..=7_u32, 0..=7_u32]],
            bits in 8..=12_u32,
            scale in 0..12_u32,
        ) {
            // t is below 2¹⁶, so that coordinates stay within 32 bits.
            for line in &mut curve.lines {
                line.at = (line.at as i32 >> 1) as u32;
                line.slope >>= 17 + scale;
            }
            let rows = texels(log2);
            let texture = Texture::new(&rows, log2[0], log2[1]);
            prop_assert!(pieces_are_pixels::<Clamp>(&texture, bits, &curve, count));
            prop_assert!(pieces_are_pixels::<Mirror>(&texture, bits, &curve, count));
        }
    }
}
