//! Pixel formats: how a colour is stored as a word.
//!
//! - In: a colour, as embedded-graphics has it, as RGB565, or as channels of 8 bits.
//! - Out: its word, which is one pixel in memory.
//! - Assumes: nothing.

use super::channel::{nearest, split};
use super::threshold::{Quantize, Threshold};
use crate::num::IS_ARMV6M;
use core::marker::PhantomData;
use embedded_graphics::pixelcolor::{PixelColor, Rgb565, Rgb888, raw::RawU16};
use embedded_graphics::prelude::RawData;

/// What is made of words of any type, such as a slice of them. A format whose words are those of a known one hands it back as made of
/// these.
#[doc(hidden)]
pub trait OfWords {
    /// Of this type of word.
    type Of<W: 'static>;
}

/// A slice of words, to be written.
pub(crate) struct SliceOf<'a>(PhantomData<&'a ()>);

impl<'a> OfWords for SliceOf<'a> {
    type Of<W: 'static> = &'a mut [W];
}

/// A single word.
pub(crate) struct Single;

impl OfWords for Single {
    type Of<W: 'static> = W;
}

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
/// Each holds the nearest to what it is given, and to texels in light: half a step of its channel is the most that it is off. To see
/// more than 16 bits can show, draw in `Rgb888` and [dither](crate::Band::dithered). [`guide::cost`](crate::guide::cost) has what pixels of each take.
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
    /// as it is. This one's is an RGB565 number again, each channel the nearest; a format of your own with more bits than that may be finer.
    #[inline]
    #[must_use]
    fn lit(texel: u16, light: [u32; 3]) -> Self::Word {
        Self::rgb565(in_light(texel, light))
    }

    /// How many bits a word holds of red, green and blue, if [`PixelFormat::cut`] leaves the others out; 8 if it leaves out none.
    #[doc(hidden)]
    const BITS: [u32; 3] = [8; 3];

    /// The word of three 8-bit channels that are scaled for it (`scaled` in shade's channels): bits are cut off.
    #[doc(hidden)]
    #[inline]
    #[must_use]
    fn cut([red, green, blue]: [u32; 3]) -> Self::Word {
        Self::rgb888(red as u8, green as u8, blue as u8)
    }

    /// The least change of a channel that the format shows, in whole levels of 1/255, 1 … 8: that of its finest channel. Colours of small
    /// triangles may be off by this; ¼ pixel is the bound of all others.
    const COLOR_STEP: u8 = 1;

    /// What is made of this format's words, if they are those of [`Rgb565`] on this machine: then loops that are compiled with this crate
    /// write them, however the program is optimised.
    #[doc(hidden)]
    #[inline]
    fn in_rgb565<T: OfWords>(_of: T::Of<Self::Word>) -> Option<T::Of<u16>> {
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
        let [red, green, blue] = [red, green, blue].map(u32::from);
        (nearest::<255, 31>(red) << 11 | nearest::<255, 63>(green) << 5 | nearest::<255, 31>(blue)) as u16
    }

    const BITS: [u32; 3] = [5, 6, 5];

    #[inline]
    fn cut([red, green, blue]: [u32; 3]) -> u16 {
        ((red & 0xf8) << 8 | (green & 0xfc) << 3 | blue >> 3) as u16
    }

    /// Of green.
    const COLOR_STEP: u8 = 4;

    #[inline]
    fn in_rgb565<T: OfWords>(of: T::Of<u16>) -> Option<T::Of<u16>> {
        Some(of)
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
        GRAYS[usize::from(level)]
    }
}

/// A texel in light, 0 … 255 in each channel, to the nearest: the two ways give the same.
#[inline]
fn in_light(texel: u16, light: [u32; 3]) -> u16 {
    if IS_ARMV6M {
        // No constant of more than 8 bits, each of which would be a register less. x / 255 = x / 256 · (1 + 1/256 + …): exact
        // to the nearest for these x. Each channel is shifted down before they are joined, one after another: with the shifts in one the
        // compiler takes constants for them, and 4 cycles more.
        let [red, green, blue] = split(texel);
        let times = |channel: u32, light: u32| {
            let x = channel * light + 128;
            (x + (x >> 8)) >> 8
        };
        let [red, green, blue] = [times(red, light[0]), times(green, light[1]), times(blue, light[2])];
        return ((red << 6 | green) << 5 | blue) as u16;
    }
    const HALF: u32 = 0x8000;
    // 257/65536 is 1/255 but for 2⁻¹⁶ of it, and no product divided by 255 is so close to a half that this matters. Channels stay in
    // their places: to move them there and back would take 7 cycles more on a Cortex-M4.
    let (texel, [red, green, blue]) = (u32::from(texel), light.map(|light| light + (light << 8)));
    let red = ((texel & 0xf800) * red + (HALF << 11)) & (0xf800 << 16);
    let green = ((texel & 0x07e0) * green + (HALF << 5)) & (0x07e0 << 16);
    let blue = (texel & 0x001f) * blue + HALF;
    ((red | green | blue) >> 16) as u16
}

/// The words of greys: several cycles less than to put one together, on a Cortex-M0+ as on an M4.
static GRAYS: [u16; 256] = {
    let mut grays = [0; 256];
    let mut level = 0;
    while level < 256 {
        let [red, green] = [nearest::<255, 31>(level as u32), nearest::<255, 63>(level as u32)];
        grays[level] = (red << 11 | green << 5 | red) as u16;
        level += 1;
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

    const BITS: [u32; 3] = F::BITS;

    #[inline]
    fn cut(rgb: [u32; 3]) -> u16 {
        F::cut(rgb).to_be()
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
