//! The channels of a colour, packed in as few machine words as they need, so that few additions step them.
//!
//! - In: one channel (a grey) or three, in I16F16, with their steps and bends.
//! - Out: the word of a pixel.
//! - Assumes: channels stay within 0 … 255 at every pixel.
//!
//! Each of three channels has 8 integer and 8 fraction bits here. Red and blue share a machine word: one addition steps both.
//! A single channel keeps its 16 fraction bits.
//!
//! With 8 fraction bits steps are cut towards zero. So after 16 pixels of a straight line a channel is off by at most 1/16 of
//! 1/255, its unit. That is how long a line may be before it starts anew.

use super::fill::Steps;
use super::packed::shifted;
use crate::frame::PixelFormat;

/// `M` packed channels: the values at a pixel, or steps.
pub(crate) trait Channels<const M: usize>: Steps {
    /// How many of the 16 fraction bits are dropped.
    const DROPPED: u32;
    /// Log₂ of the longest line, in pixels. If bits are dropped a longer one is drawn as several, each of which starts
    /// anew from 16 fraction bits.
    const RUN_LOG2: u32;

    /// Packs channels whose bits are dropped already.
    fn pack(channels: [i32; M]) -> Self;

    /// The values at a pixel, from I16F16.
    #[inline]
    fn place(channels: [i32; M]) -> Self {
        Self::pack(channels.map(|channel| channel >> Self::DROPPED))
    }

    /// A step, from I16F16, cut towards zero.
    #[inline]
    fn step(step: [i32; M]) -> Self {
        Self::pack(step.map(|step| shifted(step, Self::DROPPED)))
    }

    /// Red, green and blue, 0 … 255, from 8 integer and 24 fraction bits.
    fn rgb_modular(channels: [u32; M]) -> [u32; 3];

    /// The word of a pixel, from 8 integer and 24 fraction bits.
    #[inline]
    fn word_modular<F: PixelFormat>(channels: [u32; M]) -> F::Word {
        color::<F>(Self::rgb_modular(channels))
    }

    /// Red, green and blue, 0 … 255.
    fn rgb(self) -> [u32; 3];

    /// The word of a pixel.
    #[inline]
    fn word<F: PixelFormat>(self) -> F::Word {
        color::<F>(self.rgb())
    }
}

/// One channel that stands for all three, I16F16.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Gray(i32);

impl Steps for Gray {
    #[inline]
    fn plus(self, step: Self) -> Self {
        Self(self.0.wrapping_add(step.0))
    }
}

impl Channels<1> for Gray {
    const DROPPED: u32 = 0;
    const RUN_LOG2: u32 = 5;

    #[inline]
    fn pack([gray]: [i32; 1]) -> Self {
        Self(gray)
    }

    #[inline]
    fn rgb_modular([gray]: [u32; 1]) -> [u32; 3] {
        [gray >> 24; 3]
    }

    #[inline]
    fn word_modular<F: PixelFormat>([gray]: [u32; 1]) -> F::Word {
        F::gray((gray >> 24) as u8)
    }

    #[inline]
    fn rgb(self) -> [u32; 3] {
        [self.0 as u32 >> 16; 3]
    }

    #[inline]
    fn word<F: PixelFormat>(self) -> F::Word {
        F::gray((self.0 >> 16) as u8)
    }
}

/// Red in the upper half of the first word, blue in the lower one; green in the second word.
#[derive(Clone, Copy, Debug)]
pub(crate) struct RedBlueGreen(i32, i32);

impl Steps for RedBlueGreen {
    #[inline]
    fn plus(self, step: Self) -> Self {
        Self(self.0.wrapping_add(step.0), self.1.wrapping_add(step.1))
    }
}

impl Channels<3> for RedBlueGreen {
    const DROPPED: u32 = 8;
    const RUN_LOG2: u32 = 4;

    #[inline]
    fn pack([red, green, blue]: [i32; 3]) -> Self {
        // A negative step of blue borrows from red. Blue itself is never negative at a pixel, so there red is whole again.
        Self((red << 16).wrapping_add(blue), green)
    }

    #[inline]
    fn rgb_modular(channels: [u32; 3]) -> [u32; 3] {
        channels.map(|channel| channel >> 24)
    }

    #[inline]
    fn rgb(self) -> [u32; 3] {
        [self.0 as u32 >> 24, self.1 as u32 >> 8, (self.0 as u32 >> 8) & 0xff]
    }
}

/// The word of red, green and blue, each a whole number of 0 … 255.
#[inline]
pub(crate) fn color<F: PixelFormat>([red, green, blue]: [u32; 3]) -> F::Word {
    F::rgb888(red as u8, green as u8, blue as u8)
}

/// The word of a texel times light, of which 255 is full in each channel.
#[inline]
pub(crate) fn lit<F: PixelFormat>(texel: u16, light: [u32; 3]) -> F::Word {
    F::lit(texel, light)
}
