//! The channels of a colour, packed in as few machine words as they need, so that few additions step them.
//!
//! - In: one channel (a grey) or three, in I16F16, with their steps and bends.
//! - Out: the word of a pixel.
//! - Assumes: channels stay within 0 … 255 at every pixel.
//!
//! Each of three channels has 8 integer and 8 fraction bits here. Red and blue share a machine word: one addition steps both.
//! A single channel keeps its 16 fraction bits.
//!
//! Formats of fewer bits cut a channel. So that this gives the nearest step, colours are [scaled](Channels::scaled) for the format
//! where a line begins, and no pixel has to be rounded.
//!
//! With 8 fraction bits steps are cut towards zero. So after 16 pixels of a straight line a channel is off by at most 1/16 of
//! 1/255, its unit. That is how long a line may be before it starts anew.

use super::curve::Linear;
use super::fill::Steps;
use super::packed::shifted;
use crate::frame::PixelFormat;
use crate::num::IS_ARMV6M;

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

    /// Channels of a colour, I16F16, scaled for the words of a format; [`Channels::word`] takes them.
    #[inline]
    fn scaled<F: PixelFormat>(channels: [i32; M]) -> [i32; M] {
        channels
    }

    /// Steps of these.
    #[inline]
    fn scaled_step<F: PixelFormat>(step: [i32; M]) -> [i32; M] {
        step
    }

    /// The lines of a colour in 8 integer and 24 fraction bits, scaled likewise; at `t` it is a colour.
    #[inline]
    fn scaled_lines<F: PixelFormat>(lines: [Linear; M], _t: u32) -> [Linear; M] {
        lines
    }

    /// Red, green and blue, 0 … 255, from 8 integer and 24 fraction bits.
    fn rgb_modular(channels: [u32; M]) -> [u32; 3];

    /// The word of a pixel, from 8 integer and 24 fraction bits that are [scaled](Channels::scaled_lines).
    fn word_modular<F: PixelFormat>(channels: [u32; M]) -> F::Word;

    /// Red, green and blue, 0 … 255.
    fn rgb(self) -> [u32; 3];

    /// The word of a pixel, of a colour that is [scaled](Channels::scaled).
    fn word<F: PixelFormat>(self) -> F::Word;
}

/// A channel, I16F16, scaled so that its upper bits are the nearest of 0 … 2^bits − 1: (2^bits − 1)/255 of it, and half a step, as a
/// channel of 256.
#[inline]
fn scaled(channel: i32, bits: u32) -> i32 {
    scaled_step(channel, bits) + half(bits)
}

/// The step of one from pixel to pixel, scaled alike: within 0.00011 of exact, for a bit less work than a product.
#[inline]
fn scaled_step(step: i32, bits: u32) -> i32 {
    match bits {
        5 | 6 => step - (step >> bits) + (step >> 8),
        _ => step,
    }
}

/// Half a step, I16F16: in the middle of those that are right for all whole channels.
#[inline]
fn half(bits: u32) -> i32 {
    match bits {
        5 => 261_244,
        6 => 130_684,
        _ => 0,
    }
}

/// One channel that stands for all three.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Gray(i32);

impl Gray {
    /// By how much it is shifted left from I16F16: by 8, nothing is left above its integer bits that has to be masked. That saves
    /// 2 cycles a pixel on a Cortex-M0+; a Cortex-M4 takes bits out of the middle as fast.
    const UP: u32 = if IS_ARMV6M { 8 } else { 0 };

    #[inline]
    fn whole(self) -> u32 {
        self.0 as u32 >> (16 + Self::UP)
    }
}

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
        Self(gray << Self::UP)
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
        [self.whole(); 3]
    }

    #[inline]
    fn word<F: PixelFormat>(self) -> F::Word {
        F::gray(self.whole() as u8)
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
    fn scaled_lines<F: PixelFormat>(lines: [Linear; 3], t: u32) -> [Linear; 3] {
        core::array::from_fn(|i| {
            let (color, slope) = (lines[i].value(t), scaled_step(lines[i].slope, F::BITS[i]));
            let less = if F::BITS[i] < 8 { (color >> F::BITS[i]) - (color >> 8) } else { 0 };
            let color = color - less + ((half(F::BITS[i]) as u32) << 8);
            Linear { at: color.wrapping_sub(t.wrapping_mul(slope as u32)), slope }
        })
    }

    #[inline]
    fn word_modular<F: PixelFormat>(channels: [u32; 3]) -> F::Word {
        F::cut(Self::rgb_modular(channels))
    }

    #[inline]
    fn scaled<F: PixelFormat>(channels: [i32; 3]) -> [i32; 3] {
        core::array::from_fn(|i| scaled(channels[i], F::BITS[i]))
    }

    #[inline]
    fn scaled_step<F: PixelFormat>(step: [i32; 3]) -> [i32; 3] {
        core::array::from_fn(|i| scaled_step(step[i], F::BITS[i]))
    }

    #[inline]
    fn word<F: PixelFormat>(self) -> F::Word {
        F::cut(self.rgb())
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
