//! Blending: what becomes of a pixel in memory when a colour is laid over it.
//!
//! - In: the word that is there, the word that is drawn, and how opaque it is.
//! - Out: the word that stays.
//! - Assumes: nothing.
//!
//! Channels are blended as they are stored. What comes out of one is the real number that its formula gives, rounded to the
//! nearest step of the channel: off by at most half a step.

use super::format::{BigEndian, PixelFormat};
use embedded_graphics::pixelcolor::{Bgr565, Bgr888, Gray8, Rgb565, Rgb666, Rgb888};

/// A pixel format whose words can be blended: for transparent materials and fog.
///
/// In the formulas t is a channel of what is there, s of what is drawn, m the greatest value of the channel, and a the
/// opacity, 0 … 255.
///
/// A format of your own has to keep to this, too: over with 255 is the source, adding black and multiplying with white change
/// nothing.
#[diagnostic::on_unimplemented(
    message = "`{Self}` cannot blend pixels",
    label = "transparent materials and fog need a format that is `BlendFormat`",
    note = "all formats of this crate are; implement `BlendFormat` for a format of your own"
)]
pub trait BlendFormat: PixelFormat {
    /// Source over target: (s·a + t·(255 − a)) / 255.
    fn over(target: Self::Word, source: Self::Word, alpha: u8) -> Self::Word;

    /// Light added: min(t + s·a / 255, m).
    fn add(target: Self::Word, source: Self::Word, alpha: u8) -> Self::Word;

    /// Seen through a coloured glass: t·s / m.
    fn multiply(target: Self::Word, source: Self::Word) -> Self::Word;
}

/// Red in the upper half, blue in the lower one: sums and products of both at once.
#[inline(always)]
fn red_and_blue(word: u16) -> u32 {
    u32::from(word >> 11) << 16 | u32::from(word & 31)
}

#[inline(always)]
fn green(word: u16) -> u32 {
    u32::from(word >> 5 & 63)
}

#[inline(always)]
fn joined(red_and_blue: u32, green: u32) -> u16 {
    ((red_and_blue >> 16) << 11 | green << 5 | red_and_blue & 31) as u16
}

/// x / 255 of two halves of up to 65279 each, rounded to nearest, and then only the lower bits of each that `mask` has.
#[inline(always)]
fn over_255(x: u32, mask: u32) -> u32 {
    // x / 255 = x / 256 · (1 + 1/256 + …): exact to the nearest for every x up to 65279.
    let x = x + 0x0080_0080;
    (x + (x >> 8 & 0x00ff_00ff)) >> 8 & mask
}

const RED_AND_BLUE: u32 = 0x001f_001f;

impl BlendFormat for Rgb565 {
    #[inline]
    fn over(target: u16, source: u16, alpha: u8) -> u16 {
        let (a, rest) = (u32::from(alpha), u32::from(255 - alpha));
        joined(
            over_255(red_and_blue(source) * a + red_and_blue(target) * rest, RED_AND_BLUE),
            over_255(green(source) * a + green(target) * rest, 63),
        )
    }

    #[inline]
    fn add(target: u16, source: u16, alpha: u8) -> u16 {
        let a = u32::from(alpha);
        let sum = red_and_blue(target) + over_255(red_and_blue(source) * a, RED_AND_BLUE);
        // What carries into bit 5 of a half is too much: all five bits below it are set.
        let carries = sum & 0x0020_0020;
        let sum = (sum | (carries - (carries >> 5))) & RED_AND_BLUE;
        joined(sum, (green(target) + over_255(green(source) * a, 63)).min(63))
    }

    #[inline]
    fn multiply(target: u16, source: u16) -> u16 {
        // 1/31 and 1/63 with 20 fraction bits: what that is off, 0.0002 at most, takes no product across a half.
        let of_31 = |t: u32, s: u32| (t * s * 33825 + (1 << 19)) >> 20;
        let of_63 = |t: u32, s: u32| (t * s * 16644 + (1 << 19)) >> 20;
        let [t, s] = [target, source].map(u32::from);
        let (red, green, blue) =
            (of_31(t >> 11, s >> 11), of_63(t >> 5 & 63, s >> 5 & 63), of_31(t & 31, s & 31));
        (red << 11 | green << 5 | blue) as u16
    }
}

impl<F: BlendFormat<Word = u16>> BlendFormat for BigEndian<F> {
    #[inline]
    fn over(target: u16, source: u16, alpha: u8) -> u16 {
        F::over(u16::from_be(target), u16::from_be(source), alpha).to_be()
    }

    #[inline]
    fn add(target: u16, source: u16, alpha: u8) -> u16 {
        F::add(u16::from_be(target), u16::from_be(source), alpha).to_be()
    }

    #[inline]
    fn multiply(target: u16, source: u16) -> u16 {
        F::multiply(u16::from_be(target), u16::from_be(source)).to_be()
    }
}

/// The fields are as wide as those of RGB565, and which is red does not matter.
impl BlendFormat for Bgr565 {
    #[inline]
    fn over(target: u16, source: u16, alpha: u8) -> u16 {
        Rgb565::over(target, source, alpha)
    }

    #[inline]
    fn add(target: u16, source: u16, alpha: u8) -> u16 {
        Rgb565::add(target, source, alpha)
    }

    #[inline]
    fn multiply(target: u16, source: u16) -> u16 {
        Rgb565::multiply(target, source)
    }
}

/// The first byte in the upper half, the last one in the lower one.
#[inline(always)]
fn outer([first, _, last]: [u8; 3]) -> u32 {
    u32::from(first) << 16 | u32::from(last)
}

#[inline(always)]
fn bytes(outer: u32, middle: u32) -> [u8; 3] {
    [(outer >> 16) as u8, middle as u8, outer as u8]
}

/// Formats of three bytes: what their levels are times, the greatest level, and products of two levels divided by it.
macro_rules! three_bytes {
    ($($format:ident: $shift:literal $most:literal $product:expr;)*) => {$(
        impl BlendFormat for $format {
            #[inline]
            fn over(target: [u8; 3], source: [u8; 3], alpha: u8) -> [u8; 3] {
                let (a, rest) = (u32::from(alpha), u32::from(255 - alpha));
                let [t, s] = [target, source].map(|word| word.map(|byte| byte >> $shift));
                let outer = over_255(outer(s) * a + outer(t) * rest, $most << 16 | $most);
                bytes(outer, over_255(u32::from(s[1]) * a + u32::from(t[1]) * rest, $most)).map(|byte| byte << $shift)
            }

            #[inline]
            fn add(target: [u8; 3], source: [u8; 3], alpha: u8) -> [u8; 3] {
                core::array::from_fn(|i| {
                    let [t, s] = [target[i], source[i]].map(|byte| u32::from(byte >> $shift));
                    (((t + over_255(s * u32::from(alpha), $most)).min($most)) << $shift) as u8
                })
            }

            #[inline]
            fn multiply(target: [u8; 3], source: [u8; 3]) -> [u8; 3] {
                core::array::from_fn(|i| {
                    let [t, s] = [target[i], source[i]].map(|byte| u32::from(byte >> $shift));
                    ($product(t * s) << $shift) as u8
                })
            }
        }
    )*};
}

three_bytes! {
    Rgb888: 0 255 |product| over_255(product, 255);
    Bgr888: 0 255 |product| over_255(product, 255);
    // 1/63 with 20 fraction bits, as above.
    Rgb666: 2 63 |product: u32| (product * 16644 + (1 << 19)) >> 20;
}

/// The grey of what is blended is the blend of greys, but for what [`BlendFormat::add`] limits and [`BlendFormat::multiply`] multiplies:
/// there colours go a channel at a time.
impl BlendFormat for Gray8 {
    #[inline]
    fn over(target: u8, source: u8, alpha: u8) -> u8 {
        let a = u32::from(alpha);
        over_255(u32::from(source) * a + u32::from(target) * (255 - a), 255) as u8
    }

    #[inline]
    fn add(target: u8, source: u8, alpha: u8) -> u8 {
        target.saturating_add(over_255(u32::from(source) * u32::from(alpha), 255) as u8)
    }

    #[inline]
    fn multiply(target: u8, source: u8) -> u8 {
        over_255(u32::from(target) * u32::from(source), 255) as u8
    }
}
