//! The channels of a colour in as few words as they need.
//!
//! Of three channels each has 8 integer and 8 fraction bits here, and red and blue share a word: one addition steps both. Steps
//! are cut to their last bit towards zero, so that after 8 bent pixels or 16 straight ones a channel is off by 1/16 of 1/255 at
//! most. A single channel keeps its 16 fraction bits.

use super::fill::LONGEST;
use super::packed::shifted;
use crate::frame::PixelFormat;

/// `M` channels in as few words as they need; places, steps and bends alike.
pub(crate) trait Channels<const M: usize>: Copy {
    /// How many of 16 fraction bits are left out.
    const DROPPED: u32;
    /// The longest bent run, in pixels.
    const LONGEST: i32;
    /// Log₂ of the longest straight run that does not start anew from 32 bits, if bits are left out.
    const RUN_LOG2: u32;

    /// From channels without the bits left out.
    fn pack(channels: [i32; M]) -> Self;

    fn plus(self, other: Self) -> Self;

    /// From I16F16.
    #[inline]
    fn place(channels: [i32; M]) -> Self {
        Self::pack(channels.map(|channel| channel >> Self::DROPPED))
    }

    /// From a step in I16F16, cut towards zero.
    #[inline]
    fn step(step: [i32; M]) -> Self {
        Self::pack(step.map(|step| shifted(step, Self::DROPPED)))
    }

    /// Red, green and blue, 0 … 255.
    fn rgb(self) -> [u32; 3];

    #[inline]
    fn word<F: PixelFormat>(self) -> F::Word {
        color::<F>(self.rgb())
    }
}

/// One channel for all three.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Gray(i32);

impl Channels<1> for Gray {
    const DROPPED: u32 = 0;
    const LONGEST: i32 = LONGEST as i32;
    const RUN_LOG2: u32 = 5;

    #[inline]
    fn pack([gray]: [i32; 1]) -> Self {
        Self(gray)
    }

    #[inline]
    fn plus(self, other: Self) -> Self {
        Self(self.0.wrapping_add(other.0))
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

/// Red above blue, and green.
#[derive(Clone, Copy, Debug)]
pub(crate) struct RedBlueGreen(i32, i32);

impl Channels<3> for RedBlueGreen {
    const DROPPED: u32 = 8;
    const LONGEST: i32 = 8;
    const RUN_LOG2: u32 = 4;

    #[inline]
    fn pack([red, green, blue]: [i32; 3]) -> Self {
        // Blue is never below 0 at a pixel, so what a negative step borrows from red is given back.
        Self((red << 16).wrapping_add(blue), green)
    }

    #[inline]
    fn plus(self, other: Self) -> Self {
        Self(self.0.wrapping_add(other.0), self.1.wrapping_add(other.1))
    }

    #[inline]
    fn rgb(self) -> [u32; 3] {
        [self.0 as u32 >> 24, self.1 as u32 >> 8, (self.0 as u32 >> 8) & 0xff]
    }
}

/// The word of whole channels, 0 … 255.
#[inline]
pub(crate) fn color<F: PixelFormat>([red, green, blue]: [u32; 3]) -> F::Word {
    F::rgb888(red as u8, green as u8, blue as u8)
}

/// A texel times light.
#[inline]
pub(crate) fn lit<F: PixelFormat>(texel: u16, light: [u32; 3]) -> F::Word {
    // 0 … 256, so that full light leaves a texel as it is.
    let [red, green, blue] = light.map(|light| light + (light >> 7));
    let texel = u32::from(texel);
    let red = (((texel & 0xf800) * red) >> 8) & 0xf800;
    let green = (((texel & 0x07e0) * green) >> 8) & 0x07e0;
    let blue = ((texel & 0x001f) * blue) >> 8;
    F::rgb565((red | green | blue) as u16)
}
