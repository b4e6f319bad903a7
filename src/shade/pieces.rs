//! The fill of texels of a texture that does not just repeat: beyond its borders it is clamped or mirrored.
//!
//! - In: a run of pixels, and the curve of u and v, which does not wrap.
//! - Out: words.
//! - Assumes: u and v stay where [`uv_bits`](super::border::uv_bits) of the triangle says.
//!
//! Along a run u and v are monotonic. So a run is split where it enters another [cell](super::border), which bisection finds, and
//! [`Texels`] draws the pieces. Only mirrored textures have more than three cells to a side; where cells are a few pixels long each pixel is
//! folded by itself.
//!
//! What decides which cell a pixel is in are the very coordinates that its texel is fetched at. Along chords those of the pixels
//! between nodes lie between them, in the cell.

use super::border::{Border, Side};
use super::channels::Channels;
use super::curve::{Curve, Linear, distance};
use super::fill::Fill;
use super::inverses::inverse;
use super::light::{FillTexels, Light};
use super::loops::Loops;
use super::packed::integer_bits;
use super::passes::leave_apart;
use super::texels::Texels;
use super::units::{Form, Units};
use crate::frame::PixelFormat;
use crate::scene::Texture;
use core::hint::black_box;
use core::marker::PhantomData;

/// The most integer bits: slopes are left with 7 fraction bits, and over 7 times 1/w lose 1/18 texel.
const MOST_BITS: u32 = 12;
/// The most of them for chords, whose slopes count up to 511 times: 1/128 texel.
const MOST_BITS_OF_CHORDS: u32 = 9;
/// The fewest pixels that a cell has on the average, for pieces to pay.
const FEWEST: u32 = 16;

/// How a run follows perspective.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Way {
    Straight,
    Table,
    Chords,
}

impl Way {
    /// What a line's slope is to be multiplied by, n pixels after the beginning.
    #[inline(always)]
    fn t(self, curve: &Curve, n: u32) -> u32 {
        let w = curve.w.wrapping_add(n.wrapping_mul(curve.w_step));
        match self {
            Self::Straight => n,
            Self::Table => inverse(w),
            Self::Chords => distance(Form::Modular, w, curve.n.wrapping_add(n.wrapping_mul(curve.n_step))),
        }
    }
}

/// A coordinate along a run.
struct Axis {
    line: Linear,
    /// Its cell at the first pixel that is left, and at the last one.
    cell: i32,
    last: i32,
    /// Where it leaves the cell, if that is found.
    next: u32,
}

impl Axis {
    /// The first pixel that is not in the cell of the pixel `inside`, of so many, the last of which is not either.
    #[inline(never)]
    fn leaves<B: Border>(&self, curve: &Curve, side: &Side, inside: u32, end: u32, way: Way) -> u32 {
        let rises = self.last > self.cell;
        let (mut line, mut border) = (self.line, B::border(self.cell, rises, side));
        if !rises {
            // Turned round, so that it rises. Then it is to be above what was below the border.
            (line, border) = (line.turned(), border.wrapping_neg());
        }
        let leaves = |t: u32| line.value(t) as i32 >= border;
        match way {
            Way::Straight => first_of(inside, end, leaves),
            Way::Table => first_of(inside, end, |n| leaves(Way::Table.t(curve, n))),
            Way::Chords => first_of(inside, end, |n| leaves(Way::Chords.t(curve, n))),
        }
    }
}

/// The first n for which something is so, which it is not at `last_not`, and is at `end` − 1.
#[inline(always)]
fn first_of(mut last_not: u32, end: u32, is_so: impl Fn(u32) -> bool) -> u32 {
    let mut first = end - 1;
    while first - last_not > 1 {
        let middle = (last_not + first) / 2;
        if is_so(middle) {
            first = middle;
        } else {
            last_not = middle;
        }
    }
    first
}

/// Texels of a texture with borders.
pub(crate) struct Bordered<'a, F, B> {
    texels: Texels<'a, F>,
    texture: &'a Texture<'a>,
    sides: [Side; 2],
    border: PhantomData<B>,
}

impl<'a, F: PixelFormat, B: Border> Bordered<'a, F, B> {
    /// For coordinates with so many integer bits; `None` if they are too many.
    pub(crate) fn new(texture: &'a Texture<'a>, scale_log2: u32, uv_bits: [u32; 2]) -> Option<Self> {
        let (log2, own_bits) = (texture.log2(), integer_bits(texture));
        if uv_bits.iter().any(|bits| *bits > MOST_BITS) {
            return None;
        }
        let sides = [0, 1].map(|i| Side::new(log2[i], own_bits[i], uv_bits[i]));
        Some(Self { texels: Texels::new(texture, scale_log2), texture, sides, border: PhantomData })
    }

    /// Draws a run in pieces.
    #[inline(never)]
    fn in_pieces(&self, pixels: &mut [F::Word], curve: &Curve, way: Way) {
        let end = pixels.len() as u32;
        let (t, t_last) = (way.t(curve, 0), way.t(curve, end - 1));
        let [u, v, ..] = curve.lines;
        let mut axes = [self.axis(u, 0, [t, t_last], way), self.axis(v, 1, [t, t_last], way)];
        if B::IS_MIRROR {
            let borders = axes.iter().map(|axis| axis.last.abs_diff(axis.cell)).sum::<u32>();
            if borders * FEWEST > end {
                return self.one_by_one(pixels, curve, axes.map(|axis| axis.line), way);
            }
        }
        let (mut rest, mut first) = (pixels, 0);
        let mut part = Curve { w_step: curve.w_step, n_step: curve.n_step, ..Curve::default() };
        loop {
            let mut next = end;
            for (axis, side) in axes.iter_mut().zip(&self.sides) {
                if axis.cell != axis.last {
                    if axis.next <= first {
                        axis.next = axis.leaves::<B>(curve, side, first, end, way);
                    }
                    next = next.min(axis.next);
                }
            }
            for (i, (axis, side)) in axes.iter().zip(&self.sides).enumerate() {
                part.lines[i] = self.inside(curve.lines[i], axis.cell, side, first, way);
            }
            let Some((piece, others)) = rest.split_at_mut_checked((next - first) as usize) else {
                return;
            };
            rest = others;
            if way == Way::Straight {
                self.straight_piece(piece, &mut part);
            } else {
                part.w = curve.w.wrapping_add(first.wrapping_mul(curve.w_step));
                part.n = curve.n.wrapping_add(first.wrapping_mul(curve.n_step));
                self.curved_piece(piece, &part, way);
            }
            if next == end {
                return;
            }
            first = next;
            let t = way.t(curve, first);
            for (axis, side) in axes.iter_mut().zip(&self.sides) {
                axis.cell = B::cell(axis.line.value(t), side);
            }
        }
    }

    /// A line in the units of a texture that repeats, for pixels that are all in the same cell, `first` pixels after the
    /// beginning of a curve.
    #[inline(always)]
    fn inside(&self, mut line: Linear, cell: i32, side: &Side, first: u32, way: Way) -> Linear {
        let mut texel_log2 = 16;
        if way == Way::Straight {
            line.at = line.value(first);
        } else {
            line = shifted_up(line, side.bits - side.own_bits);
            texel_log2 = 32 - side.own_bits;
        }
        B::inside(line, cell, side.log2, texel_log2)
    }

    #[inline(always)]
    fn straight_piece(&self, pixels: &mut [F::Word], line: &mut Curve) {
        let [u, v, ..] = line.lines;
        if u.slope | v.slope == 0 {
            return pixels.fill(F::rgb565(self.texture.fetch_repeat(u.at as i32 >> 16, v.at as i32 >> 16)));
        }
        if B::IS_MIRROR {
            self.texels.lend_nothing(&mut line.lines);
        }
        self.texels.straight(pixels, line);
    }

    #[inline(always)]
    fn curved_piece(&self, pixels: &mut [F::Word], curve: &Curve, way: Way) {
        if way == Way::Table {
            self.texels.table(pixels, curve);
        } else if self.sides.iter().any(|side| side.bits > MOST_BITS_OF_CHORDS) {
            self.texels.each_any::<F, true>(pixels, curve);
        } else if B::IS_MIRROR {
            self.texels.chords_of::<F, true>(pixels, curve);
        } else {
            self.texels.chords(pixels, curve);
        }
    }

    #[inline(always)]
    fn axis(&self, line: Linear, i: usize, [t, t_last]: [u32; 2], way: Way) -> Axis {
        let side = &self.sides[i];
        let line = if way == Way::Straight { shifted_up(line, 16 - side.bits) } else { line };
        Axis { line, cell: B::cell(line.value(t), side), last: B::cell(line.value(t_last), side), next: 0 }
    }

    /// Draws a mirrored texture whose cells are a few pixels long.
    #[inline(never)]
    fn one_by_one(&self, pixels: &mut [F::Word], curve: &Curve, lines: [Linear; 2], way: Way) {
        let [a, b] = self.sides;
        // A sign says whether it is turned round, and below that are the texture's bits.
        let up = |line, side: Side| shifted_up(line, side.bits - side.own_bits - 1);
        let [u, v] = [up(lines[0], a), up(lines[1], b)];
        let ([a_down, b_down], texture) = ([a, b].map(|side| 32 - side.own_bits), *self.texture);
        let texel = |u, v| texture.fetch_repeat((folded(u) >> a_down) as i32, (folded(v) >> b_down) as i32);
        match way {
            Way::Straight => {
                let mut at = [u.at, v.at];
                for pixel in pixels {
                    *pixel = F::rgb565(texel(at[0], at[1]));
                    at = [at[0].wrapping_add_signed(u.slope), at[1].wrapping_add_signed(v.slope)];
                    black_box(());
                }
            }
            Way::Table => Loops::each::<F, false>(pixels, curve, [u, v], leave_apart::<false, F>, texel),
            Way::Chords => Loops::each::<F, true>(pixels, curve, [u, v], leave_apart::<true, F>, texel),
        }
    }
}

/// The lower 31 bits, turned round if the sign is set, as the upper ones.
#[inline(always)]
fn folded(at: u32) -> u32 {
    at << 1 ^ (at as i32 >> 31) as u32
}

#[inline(always)]
fn shifted_up(line: Linear, up: u32) -> Linear {
    Linear { at: line.at << (up & 31), slope: line.slope << (up & 31) }
}

impl<F: PixelFormat, B: Border> FillTexels<F> for Bordered<'_, F, B> {
    #[inline]
    fn integer_bits(&self) -> [u32; 2] {
        self.sides.map(|side| side.bits)
    }

    #[inline]
    fn texel(&self, [u, v]: [u32; 2]) -> u16 {
        let [a, b] = self.sides.map(|side| 32 - side.bits);
        B::texel(self.texture, u as i32 >> a, v as i32 >> b)
    }
}

impl<F: PixelFormat, B: Border> Fill<F::Word> for Bordered<'_, F, B> {
    fn units(&self) -> Units {
        Units::modular(self.integer_bits())
    }

    fn straight(&self, pixels: &mut [F::Word], line: &Curve) {
        self.in_pieces(pixels, line, Way::Straight);
    }

    fn table(&self, pixels: &mut [F::Word], curve: &Curve) {
        self.in_pieces(pixels, curve, Way::Table);
    }

    fn chords(&self, pixels: &mut [F::Word], curve: &Curve) {
        self.in_pieces(pixels, curve, Way::Chords);
    }
}

/// These texels times `M` channels of light.
pub(crate) struct LitBordered<'a, const M: usize, F, B, C>(Bordered<'a, F, B>, PhantomData<C>);

impl<'a, const M: usize, F: PixelFormat, B: Border, C: Channels<M>> LitBordered<'a, M, F, B, C> {
    pub(crate) fn new(texels: Bordered<'a, F, B>) -> Self {
        Self(texels, PhantomData)
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
        let fill = Bordered::<Rgb565, B>::new(texture, 0, [bits; 2]).expect("the bits fit");
        let mut drawn = vec![0; count];
        fill.table(&mut drawn, curve);
        let [u, v, ..] = curve.lines;
        let pixels: Vec<_> = (0..count as u32)
            .map(|n| Way::Table.t(curve, n))
            .map(|t| fill.texel([u.value(t), v.value(t)]))
            .collect();
        drawn == pixels
    }

    proptest! {
        #![proptest_config(ProptestConfig { cases: 4_000, failure_persistence: None, ..ProptestConfig::default() })]
        #[test]
        fn runs_in_pieces_are_their_pixels_one_by_one_in_4_000_runs(
            (mut curve, count) in curves(),
            log2 in prop_oneof![Just([6, 6]), Just([5, 5]), [0..=7_u32, 0..=7_u32]],
            bits in 8..=12_u32,
            scale in 0..12_u32,
        ) {
            // t is below 2¹⁶, so that coordinates stay within 31 bits.
            for line in &mut curve.lines {
                line.at = (line.at as i32 >> 2) as u32;
                line.slope >>= 18 + scale;
            }
            let rows = texels(log2);
            let texture = Texture::new(&rows, log2[0], log2[1]);
            prop_assert!(pieces_are_pixels::<Clamp>(&texture, bits, &curve, count));
            prop_assert!(pieces_are_pixels::<Mirror>(&texture, bits, &curve, count));
        }
    }
}
