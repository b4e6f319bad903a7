//! Pixel formats: how a colour is stored as a word.
//!
//! - In: a colour, as embedded-graphics has it, as RGB565, or as channels of 8 bits.
//! - Out: its word, which is one pixel in memory.
//! - Assumes: nothing.

use super::threshold::{Quantize, Threshold};
use crate::num::IS_ARMV6M;
use core::marker::PhantomData;
use embedded_graphics::pixelcolor::{PixelColor, Rgb565, Rgb888, raw::RawU16};
use embedded_graphics::prelude::RawData;

/// How a colour is stored in memory.
///
/// A colour type that is its own format is stored as a word in the machine's byte order, or as three bytes in the order of the
/// wire. [`BigEndian`] has the order that most SPI displays want, so that rows can be sent as they are.
///
/// | format | word | what it is for |
/// |---|---|---|
/// | `Rgb565`, `BigEndian<Rgb565>` | `u16` | most colour displays, and the fastest: textures are RGB565, and its loops are compiled with this crate |
/// | `Bgr565`, `BigEndian<Bgr565>` | `u16` | the same with red and blue swapped |
/// | `Rgb888`, `Bgr888` | `[u8; 3]`, as its name says | displays of 24 bits; and to be [dithered](crate::Band::dithered) for those of 18, 16 and less |
/// | `Rgb666` | `[u8; 3]`: red, green, blue, each in the upper six bits of its byte | displays in their mode of 18 bits (ILI9341, ILI9488) |
/// | `Gray8` | `u8`, the luma of ITU-R BT.601 | grey and monochrome displays, [dithered](crate::Band::dithered); the least memory |
///
/// Each holds the nearest to what it is given, and to texels in light, to half a step of its channel. Only `Rgb565` cuts them: in it a
/// channel of 8 bits is at most 0.86 steps too dark, and a texel in light 1.1 steps off. Rounding would take 22 / 9 cycles a pixel of three channels, on a Cortex-M0+ / M4F; to see
/// all that 16 bits can show, draw in `Rgb888` and [dither](crate::Band::dithered). [`guide::cost`](crate::guide::cost) has what pixels of each take.
#[diagnostic::on_unimplemented(
    message = "`{Self}` is not a format that pixels are drawn in",
    label = "a band's pixels are `Rgb565`, `Bgr565`, `Rgb666`, `Rgb888`, `Bgr888` or `Gray8`",
    note = "for a display of fewer bits (`BinaryColor`, `Gray2`, `Gray4`) draw in `Gray8` and send `band.dithered::<BinaryColor>()`",
    note = "for a display of other colours draw in `Rgb565` or `Rgb888` and pass `&mut display.color_converted()` of embedded-graphics, or implement `PixelFormat` for a format of your own",
    note = "for two-byte words in the order of most SPI displays there is `BigEndian<Rgb565>`"
)]
pub trait PixelFormat: 'static {
    /// One pixel in memory.
    type Word: Copy;
    /// The colour that 2D drawing uses.
    type Color: PixelColor;

    /// A colour's word.
    fn encode(color: Self::Color) -> Self::Word;

    /// A word's colour.
    fn decode(word: Self::Word) -> Self::Color;

    /// The word of an RGB565 number in the machine's byte order, as textures hold it.
    fn rgb565(bits: u16) -> Self::Word;

    /// The word of three 8-bit channels.
    fn rgb888(red: u8, green: u8, blue: u8) -> Self::Word;

    /// The word of a texel, an RGB565 number, in light. Each channel of light is a whole number of 0 … 255, and 255 leaves the texel
    /// as it is. This one's is an RGB565 number again, each channel rounded down; a format of your own with more bits than that may be finer.
    #[inline]
    #[must_use]
    fn lit(texel: u16, light: [u32; 3]) -> Self::Word {
        // 0 … 256, so that full light leaves a texel as it is.
        let [red, green, blue] = light.map(|light| light + (light >> 7));
        let texel = u32::from(texel);
        let green = ((texel >> 5 & 63) * green) >> 8;
        let (red, blue) = if red == blue && !IS_ARMV6M {
            // Both in one product, 16 bits apart.
            let both = ((texel | texel << 5) & 0x1f_001f) * red;
            (both >> 24, both >> 8 & 31)
        } else {
            (((texel >> 11) * red) >> 8, ((texel & 31) * blue) >> 8)
        };
        Self::rgb565((red << 11 | green << 5 | blue) as u16)
    }

    /// The least change of a channel that the format shows, in whole levels of 1/255, 1 … 8: that of its finest channel. Colours of small
    /// triangles may be off by this; ¼ pixel is the bound of all others.
    const COLOR_STEP: u8 = 1;

    /// The same words, if they are those of [`Rgb565`] on this machine: then loops that are compiled with this crate write them,
    /// however the program is optimised.
    #[doc(hidden)]
    #[inline]
    #[must_use]
    fn as_rgb565(_words: &mut [Self::Word]) -> Option<&mut [u16]> {
        None
    }

    /// Whether a word has room for 16 bits of a pass that is not the last: see [`PixelFormat::keep`].
    #[doc(hidden)]
    const KEEPS: bool = false;

    /// The word in which 16 bits are left for the next pass.
    #[doc(hidden)]
    #[inline]
    #[must_use]
    fn keep(bits: u16) -> Self::Word {
        Self::rgb565(bits)
    }

    /// What was left in a word.
    #[doc(hidden)]
    #[inline]
    #[must_use]
    fn kept(_word: Self::Word) -> u16 {
        0
    }

    /// The RGB565 number of a word that [`PixelFormat::rgb565`] made.
    #[doc(hidden)]
    #[inline]
    #[must_use]
    fn texel(_word: Self::Word) -> u16 {
        0
    }

    /// A word's colour on a display of few bits.
    #[doc(hidden)]
    #[inline]
    #[must_use]
    fn quantize<C: Quantize>(word: Self::Word, threshold: Threshold) -> C
    where
        Self::Color: Into<Rgb888>,
    {
        C::quantize(Self::decode(word).into(), threshold)
    }

    /// The word of a grey, whose three channels are all `level`.
    #[inline]
    #[must_use]
    fn gray(level: u8) -> Self::Word {
        Self::rgb888(level, level, level)
    }
}

impl PixelFormat for Rgb565 {
    type Word = u16;
    type Color = Self;

    #[inline]
    fn encode(color: Self) -> u16 {
        RawU16::from(color).into_inner()
    }

    #[inline]
    fn decode(word: u16) -> Self {
        RawU16::new(word).into()
    }

    #[inline]
    fn rgb565(bits: u16) -> u16 {
        bits
    }

    #[inline]
    fn rgb888(red: u8, green: u8, blue: u8) -> u16 {
        (u16::from(red) & 0xf8) << 8 | (u16::from(green) & 0xfc) << 3 | u16::from(blue) >> 3
    }

    /// Of green.
    const COLOR_STEP: u8 = 4;

    #[inline]
    fn as_rgb565(words: &mut [u16]) -> Option<&mut [u16]> {
        Some(words)
    }

    const KEEPS: bool = true;

    #[inline]
    fn keep(bits: u16) -> u16 {
        bits
    }

    #[inline]
    fn kept(word: u16) -> u16 {
        word
    }

    #[inline]
    fn texel(word: u16) -> u16 {
        word
    }

    #[inline]
    fn gray(level: u8) -> u16 {
        GRAYS[usize::from(level >> 2)]
    }
}

/// The words of greys, by the 6 bits of green: 4 cycles less than to put one together, on a Cortex-M0+ as on an M4.
static GRAYS: [u16; 64] = {
    let mut grays = [0; 64];
    let mut green = 0;
    while green < 64 {
        let red = green as u16 >> 1;
        grays[green] = red << 11 | (green as u16) << 5 | red;
        green += 1;
    }
    grays
};

/// A 16-bit format with its bytes in big-endian order on every machine.
#[derive(Clone, Copy, Debug)]
pub struct BigEndian<F>(PhantomData<F>);

impl<F: PixelFormat<Word = u16>> PixelFormat for BigEndian<F> {
    type Word = u16;
    type Color = F::Color;

    #[inline]
    fn encode(color: F::Color) -> u16 {
        F::encode(color).to_be()
    }

    #[inline]
    fn decode(word: u16) -> F::Color {
        F::decode(u16::from_be(word))
    }

    #[inline]
    fn rgb565(bits: u16) -> u16 {
        F::rgb565(bits).to_be()
    }

    #[inline]
    fn rgb888(red: u8, green: u8, blue: u8) -> u16 {
        F::rgb888(red, green, blue).to_be()
    }

    #[inline]
    fn lit(texel: u16, light: [u32; 3]) -> u16 {
        F::lit(texel, light).to_be()
    }

    const COLOR_STEP: u8 = F::COLOR_STEP;

    const KEEPS: bool = F::KEEPS;

    #[inline]
    fn keep(bits: u16) -> u16 {
        F::keep(bits)
    }

    #[inline]
    fn kept(word: u16) -> u16 {
        F::kept(word)
    }

    #[inline]
    fn texel(word: u16) -> u16 {
        F::texel(u16::from_be(word))
    }

    #[inline]
    fn gray(level: u8) -> u16 {
        F::gray(level).to_be()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use embedded_graphics::pixelcolor::{Bgr565, Gray8, Rgb666};

    /// A format of a user, whose words are no RGB565.
    struct Swapped;

    impl PixelFormat for Swapped {
        type Word = u16;
        type Color = Bgr565;

        fn encode(color: Bgr565) -> u16 {
            RawU16::from(color).into_inner()
        }

        fn decode(word: u16) -> Bgr565 {
            RawU16::new(word).into()
        }

        fn rgb565(bits: u16) -> u16 {
            bits << 11 | bits & 0x07e0 | bits >> 11
        }

        fn rgb888(red: u8, green: u8, blue: u8) -> u16 {
            Rgb565::rgb888(blue, green, red)
        }
    }

    /// Where words keep what a pass leaves in them, it comes back, and so does a texel.
    fn keeps<F: PixelFormat>() -> bool {
        (0..=u16::MAX).all(|bits| F::kept(F::keep(bits)) == bits && F::texel(F::rgb565(bits)) == bits)
    }

    #[test]
    fn a_format_keeps_all_texels_if_it_says_so() {
        for (says, keeps) in [
            (Rgb565::KEEPS, keeps::<Rgb565>()),
            (BigEndian::<Rgb565>::KEEPS, keeps::<BigEndian<Rgb565>>()),
            (Swapped::KEEPS, keeps::<Swapped>()),
            (BigEndian::<Swapped>::KEEPS, keeps::<BigEndian<Swapped>>()),
            (Bgr565::KEEPS, keeps::<Bgr565>()),
            (BigEndian::<Bgr565>::KEEPS, keeps::<BigEndian<Bgr565>>()),
            (Rgb888::KEEPS, keeps::<Rgb888>()),
            (Rgb666::KEEPS, keeps::<Rgb666>()),
            (Gray8::KEEPS, keeps::<Gray8>()),
        ] {
            assert_eq!(says, keeps);
        }
    }
}
