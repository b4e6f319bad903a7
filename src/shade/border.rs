//! The fill of texels of a texture that does not just repeat: beyond its borders it is clamped or mirrored.
//!
//! - In: a run of pixels, and the curve of u and v, which does not wrap.
//! - Out: words.
//! - Assumes: u and v stay where [`uv_bits`] of the triangle says.
//!
//! A texture divides the plane of u and v into cells, and in each of them it is seen as if it repeated, but for a change that is the
//! same all over the cell: a coordinate is constant, or it is turned round. Along a run u and v are monotonic. So a run is split
//! where it enters another cell, which bisection finds, and [`Texels`] draws the pieces. Only mirrored textures have more than
//! three cells to a side; where cells are a few pixels long each pixel is folded by itself.
//!
//! What decides which cell a pixel is in are the very coordinates that its texel is fetched at. Along chords those of the pixels
//! between nodes lie between them, in the cell.

use super::channels::Channels;
use super::curve::{Curve, Linear, distance};
use super::fill::Fill;
use super::inverses::inverse;
use super::light::{FillTexels, Light};
use super::packed::integer_bits;
use super::texels::{Loops, Texels};
use super::units::{Form, Units};
use crate::frame::PixelFormat;
use crate::raster::TriangleSetup;
use crate::scene::Texture;
use core::hint::black_box;
use core::marker::PhantomData;

/// What is seen beyond the borders of a texture.
pub(crate) trait Border: 'static {
    /// Whether each cell shows the texture turned round once more.
    const IS_MIRROR: bool;

    /// The texel at whole coordinates of any size.
    fn texel(texture: &Texture<'_>, u: i32, v: i32) -> u16;

    /// The cell of a coordinate that has the integer bits of `side`.
    fn cell(at: u32, side: &Side) -> i32;

    /// Where the cell after this one begins, or if coordinates fall, where this one does.
    fn border(cell: i32, rises: bool, side: &Side) -> i32;

    /// A coordinate as it is in the texture, of which a texel is 2^`texel_log2`.
    fn inside(line: Linear, cell: i32, side_log2: u32, texel_log2: u32) -> Linear;
}

/// The border texels go on.
pub(crate) enum Clamp {}

/// The texture is turned round at each border.
pub(crate) enum Mirror {}

/// One axis of a texture.
#[derive(Clone, Copy)]
pub(crate) struct Side {
    log2: u32,
    /// The integer bits of coordinates, with a sign; of these the texture has `own_bits`.
    bits: u32,
    own_bits: u32,
    /// Half a texel after the texture's beginning, and half a texel before its end.
    first: i32,
    last: i32,
}

impl Side {
    fn new(log2: u32, own_bits: u32, uv_bits: u32) -> Self {
        let bits = uv_bits.max(own_bits + 1);
        let half = 1_u32 << ((31 - bits) & 31);
        let last = (half << ((log2 + 1) & 31)).wrapping_sub(half) as i32;
        Self { log2, bits, own_bits, first: half as i32, last }
    }
}

impl Border for Clamp {
    const IS_MIRROR: bool = false;

    #[inline]
    fn texel(texture: &Texture<'_>, u: i32, v: i32) -> u16 {
        texture.fetch_clamp(u, v)
    }

    /// Below 0 to half a texel after the border, likewise above 0: there it is all the same texel. So what rounding makes of
    /// coordinates that are inside does not leave the texture.
    #[inline(always)]
    fn cell(at: u32, side: &Side) -> i32 {
        i32::from(at as i32 >= side.last) - i32::from((at as i32) < side.first)
    }

    #[inline(always)]
    fn border(cell: i32, rises: bool, side: &Side) -> i32 {
        if (cell < 0) | (cell == 0) & !rises { side.first } else { side.last }
    }

    #[inline(always)]
    fn inside(line: Linear, cell: i32, side_log2: u32, texel_log2: u32) -> Linear {
        let last = if cell < 0 { 0 } else { ((1 << side_log2) - 1) << texel_log2 };
        if cell == 0 { line } else { Linear { at: last + (1 << texel_log2 >> 1), slope: 0 } }
    }
}

impl Border for Mirror {
    const IS_MIRROR: bool = true;

    #[inline]
    fn texel(texture: &Texture<'_>, u: i32, v: i32) -> u16 {
        texture.fetch_mirror(u, v)
    }

    #[inline(always)]
    fn cell(at: u32, side: &Side) -> i32 {
        at as i32 >> ((32 + side.own_bits - side.bits) & 31)
    }

    #[inline(always)]
    fn border(cell: i32, rises: bool, side: &Side) -> i32 {
        cell.wrapping_add(rises.into()) << ((32 + side.own_bits - side.bits) & 31)
    }

    #[inline(always)]
    fn inside(line: Linear, cell: i32, _: u32, _: u32) -> Linear {
        if cell & 1 == 0 { line } else { line.turned() }
    }
}

/// The integer bits, with a sign, that u and v of a triangle take, and a texel more on each side; 32 if they wrap.
pub(super) fn uv_bits(setup: &TriangleSetup) -> [u32; 2] {
    let [u, v, ..] = &setup.attributes;
    [u, v].map(|attribute| match attribute.least.checked_add_unsigned(attribute.range) {
        Some(most) if attribute.scale_log2 == 0 => {
            let farthest = (most >> 16).saturating_add(1).max(1 - (attribute.least >> 16));
            33 - farthest.leading_zeros()
        }
        _ => 32,
    })
}

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
            Way::Straight => first_of(inside, end, |n| leaves(n)),
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
            for i in 0..2 {
                part.lines[i] = self.inside(curve.lines[i], axes[i].cell, &self.sides[i], first, way);
            }
            let piece;
            (piece, rest) = rest.split_at_mut((next - first) as usize);
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
            Way::Table => Loops::each::<F, false>(pixels, curve, [u, v], texel),
            Way::Chords => Loops::each::<F, true>(pixels, curve, [u, v], texel),
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
        Light::<M, F, C>::units(&self.0)
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
