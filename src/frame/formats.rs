//! Pixel formats beside RGB565: three bytes a pixel, red and blue swapped, and grey.
//!
//! - In: a colour, as embedded-graphics has it, as RGB565, or as channels of 8 bits.
//! - Out: its word, in which each channel is the nearest that there is.
//! - Assumes: nothing.

use super::channel::{luma, nearest, products, split};
use super::format::PixelFormat;
use super::threshold::{Quantize, Threshold};
use embedded_graphics::pixelcolor::{Bgr565, Bgr888, Gray8, GrayColor, Rgb666, Rgb888, RgbColor};

/// Formats of red and blue of 0 … `$most` and green of 0 … `$green`: their words from these channels, and back.
macro_rules! rgb_formats {
    ($($format:ident, $word:ty, $most:literal $green:literal, $pack:expr, $unpack:expr, { $($more:item)* })*) => {$(
        impl PixelFormat for $format {
            type Word = $word;
            type Color = Self;

            #[inline]
            fn encode(color: Self) -> $word {
                $pack([color.r(), color.g(), color.b()].map(u32::from))
            }

            #[inline]
            fn decode(word: $word) -> Self {
                let [red, green, blue] = $unpack(word);
                Self::new(red, green, blue)
            }

            #[inline]
            fn rgb565(bits: u16) -> $word {
                let [red, green, blue] = split(bits);
                $pack([nearest::<31, $most>(red), nearest::<63, $green>(green), nearest::<31, $most>(blue)])
            }

            #[inline]
            fn rgb888(red: u8, green: u8, blue: u8) -> $word {
                let [red, green, blue] = [red, green, blue].map(u32::from);
                $pack([nearest::<255, $most>(red), nearest::<255, $green>(green), nearest::<255, $most>(blue)])
            }

            const BITS: [u32; 3] = [bits($most), bits($green), bits($most)];

            #[inline]
            fn cut(rgb: [u32; 3]) -> $word {
                $pack(core::array::from_fn(|i| rgb[i] >> (8 - Self::BITS[i])))
            }

            #[inline]
            fn lit(texel: u16, light: [u32; 3]) -> $word {
                const RED: u32 = 31 * 255;
                const GREEN: u32 = 63 * 255;
                let [red, green, blue] = products(texel, light);
                $pack([nearest::<RED, $most>(red), nearest::<GREEN, $green>(green), nearest::<RED, $most>(blue)])
            }

            $($more)*
        }
    )*};
}

/// The bits of a channel of 0 … `most`.
const fn bits(most: u32) -> u32 {
    (most + 1).trailing_zeros()
}

rgb_formats! {
    Rgb888, [u8; 3], 255 255, |rgb: [u32; 3]| rgb.map(|channel| channel as u8), |word: [u8; 3]| word, {}

    Bgr888, [u8; 3], 255 255,
        |[red, green, blue]: [u32; 3]| [blue, green, red].map(|channel| channel as u8),
        |[blue, green, red]: [u8; 3]| [red, green, blue],
        {}

    // A byte a channel, whose lower two bits the display leaves out.
    Rgb666, [u8; 3], 63 63,
        |rgb: [u32; 3]| rgb.map(|channel| (channel << 2) as u8),
        |word: [u8; 3]| word.map(|byte| byte >> 2),
        { const COLOR_STEP: u8 = 4; }

    Bgr565, u16, 31 63,
        |[red, green, blue]: [u32; 3]| (blue << 11 | green << 5 | red) as u16,
        |word: u16| swapped(word).map(|channel| channel as u8),
        {
            const COLOR_STEP: u8 = 4;
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
                word << 11 | word & 0x07e0 | word >> 11
            }
        }
}

/// Red, green and blue of a word of BGR565.
#[inline(always)]
fn swapped(word: u16) -> [u32; 3] {
    let [blue, green, red] = split(word);
    [red, green, blue]
}

/// Light of each channel counts for what the channel counts in luma.
impl PixelFormat for Gray8 {
    type Word = u8;
    type Color = Self;

    #[inline]
    fn encode(color: Self) -> u8 {
        color.luma()
    }

    #[inline]
    fn decode(word: u8) -> Self {
        Self::new(word)
    }

    #[inline]
    fn rgb565(bits: u16) -> u8 {
        // By the same weights, so that full light changes nothing.
        Self::lit(bits, [255; 3])
    }

    #[inline]
    fn rgb888(red: u8, green: u8, blue: u8) -> u8 {
        luma::<255, 255>([red, green, blue].map(u32::from))
    }

    #[inline]
    fn lit(texel: u16, light: [u32; 3]) -> u8 {
        luma::<{ 31 * 255 }, { 63 * 255 }>(products(texel, light))
    }

    #[inline]
    fn quantize<C: Quantize>(word: u8, threshold: Threshold) -> C {
        C::quantize_gray(word, threshold)
    }

    #[inline]
    fn gray(level: u8) -> u8 {
        level
    }
}
