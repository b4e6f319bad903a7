//! Fog: colours fade with the distance along the line of sight.
//!
//! - In: near/w along a run of pixels, and their words.
//! - Out: the words in fog.
//! - Assumes: near/w is 2⁻²⁰ or more, to which set-up limits it.
//!
//! How much fog a pixel has is a function of w, the view depth, which is not linear on the screen. Three formulas use w in a unit
//! of their own: let d be w·S.
//!
//! ```text
//! linear        d − start·S,  S = 1 / (end − start)
//! exponential   1 − 2^−d,     S = density / ln 2
//! table         entries ⌊d⌋ and ⌊d⌋ + 1, blended,  S = (entries − 1) / far
//! ```
//!
//! d is made of near/w by a reciprocal of 16 bits and one product: no division, and none of 64 bits. Fog is 8 bits, 0 … 255, and
//! is laid over a word as [`BlendFormat::over`] does. Where fog changes by at most 2 of 255 over 8 pixels, and in one piece of its
//! function, it is interpolated between the two: as it only rises or falls there, that is off by at most 2.

use super::inverses::exact_inverse;
use crate::frame::{BlendFormat, Gradient, PixelFormat};
use crate::num::{I16F16, normalised};
use crate::scene::Camera;
use embedded_graphics::pixelcolor::{Rgb565, raw::RawU16};
use embedded_graphics::prelude::RawData;

/// Fog of a [view](crate::View): how thick it is at which view depth, and its colour. View depth is measured
/// along the camera's axis, not from the eye to the point: what moves from the middle to the edge as a camera turns has less fog.
///
/// What a pixel shows is off by less than one step of the target's channel, where near/w is 1/100 or more and in the middle of what 31 bits
/// of it hold: a view depth of a thousand near planes is fine. Materials that are [added](crate::Material::additive) fade to black,
/// those that [multiply](crate::Material::multiply) to white, all others to the fog's colour. A shader that reads the target
/// gets what is there with its fog, and fog is laid over what it returns.
///
/// A view and a list copy the fog; only a table or a gradient stays borrowed. Backgrounds get none, nor does what is drawn without a
/// view.
///
/// ```
/// use fixel::embedded_graphics::{pixelcolor::{Rgb565, Rgb888}, prelude::*};
/// use fixel::{Fog, Gradient, num::I16F16};
/// let sky = Gradient::new(Rgb888::CSS_MIDNIGHT_BLUE, Rgb888::CSS_LIGHT_PINK, 240); // the background, too
/// let haze = Fog::exponential(Rgb565::CSS_GRAY, I16F16::lit("0.1")).towards(&sky);
/// let wall = Fog::linear(Rgb565::CSS_GRAY, I16F16::lit("20"), I16F16::lit("40"));
/// # let _ = (haze, wall);
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Fog<'a> {
    color: Rgb565,
    gradient: Option<&'a Gradient>,
    amount: Amount<'a>,
}

/// How much fog there is at which view depth. Distances are I16F16.
#[derive(Clone, Copy, Debug)]
enum Amount<'a> {
    Linear { start: i32, end: i32 },
    Exponential { density: i32 },
    Table { far: i32, table: &'a [u8] },
}

impl<'a> Fog<'a> {
    const fn new(color: Rgb565, amount: Amount<'a>) -> Self {
        Self { color, gradient: None, amount }
    }

    /// None up to a view depth of `start`, all fog from `end` on, and linear between.
    ///
    /// `start` is limited to 0 … 30719.99. `end` is at least 33/32 of `start`, and at least 1/256 more than it: nearer to each
    /// other they would ask for more digits than 1/w has.
    #[must_use]
    pub const fn linear(color: Rgb565, start: I16F16, end: I16F16) -> Self {
        let start = limited(start.to_bits(), 0, i32::MAX - (1 << 27));
        let least = if start >> 5 > 1 << 8 { start >> 5 } else { 1 << 8 };
        Self::new(color, Amount::Linear { start, end: limited(end.to_bits(), start + least, i32::MAX) })
    }

    /// 1 − e^(−`density`·w) of it at a view depth of w; the density, limited to 1/65536 … 64, is per unit of the
    /// world.
    #[must_use]
    pub const fn exponential(color: Rgb565, density: I16F16) -> Self {
        Self::new(color, Amount::Exponential { density: limited(density.to_bits(), 1, 64 << 16) })
    }

    /// As a table says, 0 … 255: its entries lie at equal distances from a view depth of 0 to one of `far`, at least 1/256; between
    /// them fog is linear, and beyond it is that of the last entry. Of an empty table there is none; of the entries beyond the
    /// 4096th none is used.
    #[must_use]
    pub const fn table(color: Rgb565, far: I16F16, table: &'a [u8]) -> Self {
        let table = if table.len() > 4096 { table.split_at(4096).0 } else { table };
        Self::new(color, Amount::Table { far: limited(far.to_bits(), 1 << 8, i32::MAX), table })
    }

    /// The same with the colours of a gradient in place of one colour, by the rows of the screen: what is far away vanishes in
    /// the background that the gradient is.
    #[must_use]
    pub const fn towards(self, gradient: &'a Gradient) -> Self {
        Self { gradient: Some(gradient), ..self }
    }
}

/// The same numbers, and the same gradient and table in memory: their values are not compared.
impl PartialEq for Fog<'_> {
    fn eq(&self, other: &Self) -> bool {
        let same_amount = match (self.amount, other.amount) {
            (Amount::Linear { start, end }, Amount::Linear { start: s, end: e }) => [start, end] == [s, e],
            (Amount::Exponential { density }, Amount::Exponential { density: other }) => density == other,
            (Amount::Table { far, table }, Amount::Table { far: other_far, table: other }) => {
                far == other_far && core::ptr::eq(table, other)
            }
            _ => false,
        };
        same_amount
            && self.gradient.map(core::ptr::from_ref) == other.gradient.map(core::ptr::from_ref)
            && self.color == other.color
    }
}

const fn limited(value: i32, least: i32, most: i32) -> i32 {
    if value < least {
        least
    } else if value > most {
        most
    } else {
        value
    }
}

/// A function that lays fog over words, from a pixel with this near/w and its step on.
type LayOver<F> = fn(&Fogging<'_, F>, [i32; 2], (u32, i32), Option<u16>, &mut [<F as PixelFormat>::Word]);

/// Fog before a camera.
pub(crate) struct Fogging<'a, F: PixelFormat> {
    fog: Fog<'a>,
    depth: ViewDepth,
    /// What is taken from d, 16 fraction bits.
    offset: u32,
    lay_over: LayOver<F>,
}

impl<F: PixelFormat> Clone for Fogging<'_, F> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<F: PixelFormat> Copy for Fogging<'_, F> {}

/// Whether they are the same fog before like cameras.
impl<F: PixelFormat> PartialEq for Fogging<'_, F> {
    fn eq(&self, other: &Self) -> bool {
        self.fog == other.fog && self.depth == other.depth
    }
}

impl<'a, F: PixelFormat> Fogging<'a, F> {
    pub(crate) fn new(fog: Fog<'a>, camera: &Camera) -> Self
    where
        F: BlendFormat,
    {
        // S as a quotient of two numbers of I16F16 or less.
        let (numerator, denominator): (u64, u64) = match fog.amount {
            Amount::Linear { start, end } => (1 << 16, (end - start) as u64),
            // 1/ln 2 is 1477/1024, less 0.0003.
            Amount::Exponential { density } => (density as u64 * 1477, 1 << (16 + 10)),
            Amount::Table { far, table } => ((table.len().saturating_sub(1) as u64) << 16, far as u64),
        };
        let depth = ViewDepth::new(camera, numerator.max(1), denominator);
        let offset = match fog.amount {
            Amount::Linear { start, end } => (((start as u64) << 16) / (end - start) as u64) as u32,
            _ => 0,
        };
        Self { fog, depth, offset, lay_over: lay_over::<F> }
    }

    /// Lays fog over words from the pixel (x, y) on, which has this near/w (31 fraction bits, with its step). `fades_to` is an
    /// RGB565 number in place of the fog's colour.
    pub(crate) fn lay_over(
        &self,
        place: [i32; 2],
        near_w: (u32, i32),
        fades_to: Option<u16>,
        words: &mut [F::Word],
    ) {
        (self.lay_over)(self, place, near_w, fades_to, words);
    }

    fn color_of_row(&self, y: i32) -> F::Word {
        match self.fog.gradient {
            Some(gradient) => gradient.word::<F>(y.max(0) as u32),
            None => F::rgb565(RawU16::from(self.fog.color).into_inner()),
        }
    }

    /// Fog at a pixel, 0 … 255, and the piece of its function, along which it only rises or falls.
    fn at(&self, near_w: u32) -> (u32, u32) {
        let d = self.depth.at(near_w);
        // 0 … 1 with 16 fraction bits.
        let fog = match &self.fog.amount {
            Amount::Linear { .. } => d.saturating_sub(self.offset).min(1 << 16),
            Amount::Exponential { .. } => (1 << 16) - two_to_minus(d),
            Amount::Table { table, .. } => return (from_table(table, d), d >> 16),
        };
        ((fog * 255 + (1 << 15)) >> 16, 0)
    }
}

/// View depth in a unit of its own, from near/w.
#[derive(Clone, Copy, PartialEq, Eq)]
enum ViewDepth {
    /// `factor` · 2^`exponent` · 1/q.
    Perspective { factor: u32, exponent: i32 },
    /// `near` + `factor` · 2^`exponent` · (1 − q).
    Orthographic { near: u32, factor: u32, exponent: i32 },
}

impl ViewDepth {
    /// In units of which the world's has `numerator` / `denominator`, with 16 fraction bits.
    fn new(camera: &Camera, numerator: u64, denominator: u64) -> Self {
        let (near, far) = camera.planes();
        let [near, far] = [near, far].map(|at| at.to_bits().max(1) as u64);
        // Of a distance in I16F16: 15 bits, and how many more the whole has.
        let scaled = |distance: u64| {
            // Below 2³¹ · 2³³.
            let product = distance * numerator;
            // As many bits as 64 have room for.
            let up = product.leading_zeros();
            let quotient = ((product << up) / denominator).max(1);
            let down = 49 - quotient.leading_zeros() as i32;
            let factor = if down > 0 { quotient >> down } else { quotient << -down };
            (factor as u32, down - up as i32)
        };
        if camera.is_orthographic() {
            let (factor, exponent) = scaled(far.saturating_sub(near).max(1));
            let near = u32::try_from(near * numerator / denominator).unwrap_or(u32::MAX);
            return Self::Orthographic { near, factor, exponent };
        }
        let (factor, exponent) = scaled(near);
        Self::Perspective { factor, exponent }
    }

    /// With 16 fraction bits, at most `u32::MAX`.
    #[inline]
    fn at(self, near_w: u32) -> u32 {
        match self {
            Self::Perspective { factor, exponent } => {
                // q is m · 2^−(zeros − 1) with m of ½ to 1.
                let (m, zeros) = normalised(near_w.max(1));
                shifted(exact_inverse(m) >> 1, factor, exponent + zeros as i32 - 16)
            }
            Self::Orthographic { near, factor, exponent } => {
                // 1 − q is m · 2^(1 − zeros) with m of ½ to 1.
                let (m, zeros) = normalised((1u32 << 31) - near_w.min((1 << 31) - 1));
                near.saturating_add(shifted(m >> 16, factor, exponent - zeros as i32 - 15))
            }
        }
    }
}

/// The product of 17 (up to 2¹⁶) and 15 bits times 2^`exponent`, limited.
#[inline]
fn shifted(a: u32, factor: u32, exponent: i32) -> u32 {
    let product = a.wrapping_mul(factor);
    if exponent <= 0 {
        product.checked_shr(exponent.unsigned_abs()).unwrap_or(0)
    } else if product.leading_zeros() < exponent as u32 {
        u32::MAX
    } else {
        product << exponent
    }
}

/// 2^−d, 16 fraction bits, off by less than 2⁻¹³.
fn two_to_minus(d: u32) -> u32 {
    /// 2^(−i/32), 16 fraction bits.
    static POWERS: [u32; 33] = {
        // 2^(−1/32) with 32 fraction bits, and its powers.
        let (root, mut power): (u64, u64) = (4_202_935_003, 1 << 32);
        let mut powers = [0; 33];
        let mut i = 0;
        while i < 33 {
            powers[i] = ((power + (1 << 15)) >> 16) as u32;
            power = ((power as u128 * root as u128) >> 32) as u64;
            i += 1;
        }
        powers
    };
    let (whole, i, rest) = (d >> 16, (d >> 11 & 31) as usize, d & 0x7ff);
    let (here, next) = (POWERS[i], POWERS[i + 1]);
    (here - (((here - next) * rest) >> 11)).checked_shr(whole).unwrap_or(0)
}

/// An entry of a table, blended with the next, at a place with 16 fraction bits.
fn from_table(table: &[u8], d: u32) -> u32 {
    let entry = |i: usize| table.get(i).or(table.last()).map_or(0, |&entry| i32::from(entry));
    let (here, next) = (entry((d >> 16) as usize), entry((d >> 16) as usize + 1));
    (here + (((next - here) * ((d & 0xffff) as i32) + (1 << 15)) >> 16)) as u32
}

/// The steps between two pixels whose fog is computed, if it changes little.
const STEPS: usize = 8;

/// Columns come in groups of [`STEPS`] on the screen, wherever a run begins: what fog a pixel has does not depend on what hides its
/// neighbours.
fn lay_over<F: BlendFormat>(
    fogging: &Fogging<'_, F>,
    [x, y]: [i32; 2],
    (mut near_w, step): (u32, i32),
    fades_to: Option<u16>,
    mut words: &mut [F::Word],
) {
    let color = match fades_to {
        Some(number) => F::rgb565(number),
        None => fogging.color_of_row(y),
    };
    // near/w so many pixels on, if it is still one.
    let ahead = |near_w: u32, pixels: i32| {
        let there = near_w.checked_add_signed(step.checked_mul(pixels)?)?;
        (there <= i32::MAX as u32).then_some(there)
    };
    // The group's first pixel, which may lie before the run.
    let mut into = x & (STEPS as i32 - 1);
    let mut fog = ahead(near_w, -into).map(|there| fogging.at(there));
    while !words.is_empty() {
        let count = words.len().min(STEPS - into as usize);
        let next = ahead(near_w, STEPS as i32 - into);
        let next_fog = if step == 0 { fog } else { next.map(|there| fogging.at(there)) };
        let (block, rest) = words.split_at_mut(count);
        match (fog, next_fog) {
            (Some((first, piece)), Some((last, last_piece)))
                if piece == last_piece && first.abs_diff(last) <= 2 =>
            {
                if first | last != 0 {
                    // With 16 fraction bits; rounded.
                    let slope = (last as i32 - first as i32) << (16 - 3);
                    let mut at = ((first as i32) << 16) + (1 << 15) + slope * into;
                    for word in block {
                        *word = F::over(*word, color, (at >> 16) as u8);
                        at += slope;
                    }
                }
            }
            _ => {
                let mut at = near_w;
                for word in block {
                    *word = F::over(*word, color, fogging.at(at).0 as u8);
                    at = at.wrapping_add_signed(step);
                }
            }
        }
        near_w = near_w.wrapping_add_signed(step.wrapping_mul(count as i32));
        (fog, words, into) = (next_fog, rest, 0);
    }
}
