//! Thresholds: how the colours of a display of few bits are made of 8-bit channels.
//!
//! - In: 8-bit channels, and the threshold of a pixel.
//! - Out: a colour of the display: each channel rounded up or down.
//! - Assumes: nothing.

use super::channel::luma;
use embedded_graphics::pixelcolor::{
    Bgr565, Bgr888, BinaryColor, Gray2, Gray4, Gray8, PixelColor, Rgb565, Rgb666, Rgb888, RgbColor,
};

/// A colour of a display that has fewer bits than the pixels of a band: made of 8-bit channels by a [`Threshold`].
///
/// Of embedded-graphics' colours these are: [`BinaryColor`], [`Gray2`], [`Gray4`], [`Gray8`] (by the luma of ITU-R BT.601), [`Rgb565`],
/// [`Bgr565`], [`Rgb666`], [`Rgb888`], [`Bgr888`]. For another display, of three inks say, implement it for its colour type:
///
/// ```
/// use fixel::embedded_graphics::{pixelcolor::{Rgb888, raw::RawU2}, prelude::*};
/// use fixel::{Quantize, Threshold};
/// #[derive(Clone, Copy, PartialEq)]
/// enum Ink { White, Black, Red }
/// # impl PixelColor for Ink { type Raw = RawU2; }
/// impl Quantize for Ink {
///     fn quantize(color: Rgb888, threshold: Threshold) -> Self {
///         match [color.r(), color.g()].map(|level| threshold.is_below(level)) {
///             [true, true] => Self::White,
///             [true, false] => Self::Red,
///             _ => Self::Black,
///         }
///     }
/// }
/// ```
#[diagnostic::on_unimplemented(
    message = "a band cannot be sent in `{Self}`",
    label = "a band is sent in `BinaryColor`, `Gray2`, `Gray4`, `Gray8`, `Rgb565`, `Bgr565`, `Rgb666`, `Rgb888` or `Bgr888`",
    note = "for another display implement `Quantize` for its colour type"
)]
pub trait Quantize: PixelColor {
    /// The colour of a pixel with this threshold.
    fn quantize(color: Rgb888, threshold: Threshold) -> Self;

    /// The same of a grey.
    #[inline]
    #[must_use]
    fn quantize_gray(level: u8, threshold: Threshold) -> Self {
        Self::quantize(Rgb888::new(level, level, level), threshold)
    }
}

/// Whether a pixel is rounded up or down: it is up where what is left above a whole level, in 255ths, is greater.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Threshold(pub(super) u8);

impl Threshold {
    /// A threshold of 0 … 254, to which it is limited: 127 rounds to the nearest.
    #[inline]
    #[must_use]
    pub const fn new(threshold: u8) -> Self {
        Self(if threshold < 254 { threshold } else { 254 })
    }

    /// Whether an 8-bit level is greater.
    #[inline]
    #[must_use]
    pub const fn is_below(self, level: u8) -> bool {
        level > self.0
    }

    /// An 8-bit level as one of 0 … `most`: level · most / 255, rounded up or down.
    ///
    /// It costs two products where `most` is a literal; else divisions, too.
    ///
    /// A level that is the nearest of 255 to one of `most` becomes that one, whatever the threshold: RGB565 that was stored in 8 bits
    /// a channel comes back as it was. The mean of what [`Band::dithered`](crate::Band::dithered) makes is off by 1/128 of a step; and by half of 1/255, which is
    /// what 8 bits leave open, where 255 is no multiple of `most`.
    #[inline(always)]
    #[must_use]
    pub const fn level(self, level: u8, most: u8) -> u8 {
        // With 20 fraction bits. How far, in 255ths of a step, a whole level may be from its nearest of 255:
        let slack = if matches!(most, 0 | 1 | 3 | 5 | 15 | 17 | 51 | 85 | 255) { 0 } else { most as u32 / 2 };
        let factor = ((most as u32) << 20).div_ceil(255);
        // A pixel is up where more than slack + threshold · (127 − slack) / 127 255ths are left, by half of one at least: so 20 bits decide
        // as the real numbers do. One product and one sum a channel, and one of each for all channels that have as many levels.
        let (at_0, a_threshold) = (((509 - 2 * slack) << 19) / 255, ((127 - slack) << 20) / (127 * 255));
        ((level as u32 * factor + at_0 - self.0 as u32 * a_threshold) >> 20) as u8
    }
}

impl Quantize for BinaryColor {
    #[inline]
    fn quantize(color: Rgb888, threshold: Threshold) -> Self {
        Self::quantize_gray(luma_of(color), threshold)
    }

    #[inline]
    fn quantize_gray(level: u8, threshold: Threshold) -> Self {
        threshold.is_below(level).into()
    }
}

macro_rules! grays {
    ($($gray:ident $most:literal;)*) => {$(
        impl Quantize for $gray {
            #[inline]
            fn quantize(color: Rgb888, threshold: Threshold) -> Self {
                Self::quantize_gray(luma_of(color), threshold)
            }

            #[inline]
            fn quantize_gray(level: u8, threshold: Threshold) -> Self {
                Self::new(threshold.level(level, $most))
            }
        }
    )*};
}

macro_rules! colors {
    ($($color:ident)*) => {$(
        impl Quantize for $color {
            #[inline]
            fn quantize(color: Rgb888, threshold: Threshold) -> Self {
                Self::new(
                    threshold.level(color.r(), Self::MAX_R),
                    threshold.level(color.g(), Self::MAX_G),
                    threshold.level(color.b(), Self::MAX_B),
                )
            }
        }
    )*};
}

grays! { Gray2 3; Gray4 15; Gray8 255; }
colors! { Rgb565 Bgr565 Rgb666 Rgb888 Bgr888 }

#[inline(always)]
fn luma_of(color: Rgb888) -> u8 {
    luma::<255, 255>([color.r(), color.g(), color.b()].map(u32::from))
}
