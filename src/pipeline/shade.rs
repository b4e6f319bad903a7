//! Stage 5: a span's pixels.
//!
//! # Perspective with a proven bound, at nearly affine cost
//!
//! Along a row u = u₀ + U/q with U and q linear. Taking u exactly every L pixels and linearly between is
//! off, at a fraction τ of the way and with s = L·q′/q at the end where q is smaller, by
//!
//! ```text
//! error / |u′| = L·s·τ(1 − τ)·(1 + τs)/(1 + s)  ≤  L·s/4  =  (L²/4)·|q′/q|   pixels,
//! ```
//!
//! a displacement on the screen, whatever the texture. The [`QuarterPixel`] quality asks for at most
//! 3/16 of a pixel and leaves 1/16 to rounding: **L² ≤ ¾·q/|q′|**. So floors seen level and walls seen
//! straight (q′ ≈ 0) are one affine run, and a strongly foreshortened wall divides every few pixels.

use super::attribute::{Attribute, inverse, step_of};
use super::color::Coloring;
use super::fill::{Each, Fill};
use super::setup::Cull;
use super::span::Span;
use crate::math::Pose;
use crate::math::recip::Reciprocal;
use crate::num::{I16F16, wide};
use crate::target::PixelFormat;
use core::marker::PhantomData;

/// How exactly perspective is followed between the pixels of a span: [`Exact`], [`QuarterPixel`]
/// or [`Affine`].
///
/// The error is measured in pixels on the screen: the error of an attribute, divided by
/// its largest change over one pixel step (at least 1 texel or 1/255).
pub trait Quality: sealed::Sealed {
    /// A triangle is straight, its attributes counting as linear on the screen, if
    /// (width + height)·(q_max − q_min) ≤ this fraction · q_min. It displaces them by at most ¼ · that fraction · q_max/q_min
    /// pixels: linear and exact interpolation differ by the covariance of u and q under the weights, divided by q.
    #[doc(hidden)]
    const STRAIGHT: (u32, u32);
    /// Whether it takes place at every pixel.
    #[doc(hidden)]
    const EVERY_PIXEL: bool;
}

/// A division at every pixel: an error of at most 0.02 pixel.
#[derive(Clone, Copy, Debug)]
pub struct Exact;

/// Divisions as far apart as an error of ¼ pixel allows: the default.
#[derive(Clone, Copy, Debug)]
pub struct QuarterPixel;

/// No division: attributes are linear on the screen, and textures swim. The error is unbounded.
#[derive(Clone, Copy, Debug)]
pub struct Affine;

impl Quality for Exact {
    const STRAIGHT: (u32, u32) = (1, 32);
    const EVERY_PIXEL: bool = true;
}

impl Quality for QuarterPixel {
    const STRAIGHT: (u32, u32) = (3, 4);
    const EVERY_PIXEL: bool = false;
}

impl Quality for Affine {
    const STRAIGHT: (u32, u32) = NO_PERSPECTIVE;
    const EVERY_PIXEL: bool = false;
}

/// Every triangle is straight.
pub(super) const NO_PERSPECTIVE: (u32, u32) = (1, 0);

mod sealed {
    pub trait Sealed {}
    impl Sealed for super::Exact {}
    impl Sealed for super::QuarterPixel {}
    impl Sealed for super::Affine {}
}

/// Which attributes of the vertices a shader reads.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Inputs {
    /// None.
    None,
    /// u and v.
    Uv,
    /// Red, green and blue.
    Color,
    /// u, v, red, green and blue.
    UvColor,
}

/// The attributes at one pixel centre; those that a shader does not read are 0.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Varying {
    /// Texture coordinate to the right, in texels.
    pub u: I16F16,
    /// Texture coordinate downwards, in texels.
    pub v: I16F16,
    /// Red, green and blue, 0 … 255.996.
    pub color: [I16F16; 3],
}

impl Varying {
    fn new([u, v, red, green, blue]: [i32; 5]) -> Self {
        Self {
            u: I16F16::from_bits(u),
            v: I16F16::from_bits(v),
            color: [red, green, blue].map(I16F16::from_bits),
        }
    }
}

/// What a pixel shows. [`Material`](crate::Material) is the shader that comes with the crate.
///
/// ```
/// use fixel::{Cull, Inputs, QuarterPixel, Shader, Varying};
/// use fixel::embedded_graphics::pixelcolor::Rgb565;
/// /// Rings around the origin of the texture coordinates.
/// struct Rings;
/// impl Shader<Rgb565> for Rings {
///     type Quality = QuarterPixel;
///     fn inputs(&self) -> Inputs {
///         Inputs::Uv
///     }
///     fn color(&self, at: &Varying) -> u16 {
///         let (u, v) = (at.u.to_num::<i32>(), at.v.to_num::<i32>());
///         if (u * u + v * v) & 64 == 0 { 0xffff } else { 0x001f }
///     }
/// }
/// ```
pub trait Shader<F: PixelFormat> {
    /// How exactly the attributes follow perspective.
    type Quality: Quality;

    /// Which attributes [`Shader::color`] reads; the fewer, the faster.
    fn inputs(&self) -> Inputs;

    /// The pixel word for the attributes at one pixel centre.
    fn color(&self, varying: &Varying) -> F::Word;

    /// Which side of a triangle [`Camera::draw`](crate::Camera::draw) leaves out.
    fn cull(&self) -> Cull {
        Cull::Back
    }

    /// What colour the vertices of a mesh in this pose have, for shaders that read it: their own, unless lit.
    fn coloring(&self, pose: &Pose) -> Coloring {
        let _ = pose;
        Coloring::default()
    }

    /// By how much texture coordinates are multiplied, as a power of two: 2⁰ … 2⁸, so that a plane can repeat its
    /// texture hundreds of times. What goes beyond ±32768 texels starts again at the other end, which no repeated
    /// texture shows.
    fn texture_scale(&self) -> u32 {
        0
    }

    /// Draws the visible pixels of a span. The default calls [`Shader::color`] for each.
    fn span(&self, span: &Span<'_>, pixels: &mut [F::Word]) {
        match self.inputs() {
            Inputs::None => pixels.fill(self.color(&Varying::default())),
            Inputs::Uv => {
                span.shade::<Self::Quality, _, 2>(pixels, |[u, v]| self.color(&Varying::new([u, v, 0, 0, 0])))
            }
            Inputs::Color => {
                span.shade::<Self::Quality, _, 3>(pixels, |[r, g, b]| {
                    self.color(&Varying::new([0, 0, r, g, b]))
                });
            }
            Inputs::UvColor => {
                span.shade::<Self::Quality, _, 5>(pixels, |all| self.color(&Varying::new(all)))
            }
        }
    }
}

/// A place in a span: q and the first `N` attributes' planes.
struct Place<'a, const N: usize> {
    attributes: &'a [Attribute; N],
    q: u32,
    q_step: i32,
    q_min: u32,
    values: [i32; N],
    steps: [i32; N],
    /// The leading zeros of q at the last place, which those at the next are close to.
    zeros: u32,
}

impl<const N: usize> Place<'_, N> {
    #[inline]
    fn advance(&mut self, pixels: i32) {
        self.q = self.q.wrapping_add_signed(self.q_step.wrapping_mul(pixels));
        for (value, step) in self.values.iter_mut().zip(self.steps) {
            *value = value.wrapping_add(step.wrapping_mul(pixels));
        }
    }

    /// q with rounding errors below the least value at a corner taken away; those above 2³¹ do no harm.
    #[inline]
    fn bounded(&self, q: u32) -> u32 {
        if q.wrapping_sub(self.q_min) > 3 << 30 { self.q_min } else { q }
    }

    /// The attributes here, I16F16: one reciprocal.
    #[inline]
    fn resolve(&mut self) -> [i32; N] {
        let q = Reciprocal::coarse_near(self.bounded(self.q), self.zeros);
        self.zeros = q.zeros;
        core::array::from_fn(|i| self.attributes[i].resolve(self.values[i], q))
    }

    /// The steps from `at` here to the attributes of the last of `count` pixels: exact at both.
    #[inline(never)]
    fn last_steps(&mut self, at: &[i32; N], count: usize) -> [i32; N] {
        if count < 2 {
            return [0; N];
        }
        self.advance(count as i32 - 1);
        let last = self.resolve();
        let inverse = inverse(count - 1);
        core::array::from_fn(|i| step_of(last[i].wrapping_sub(at[i]), inverse))
    }

    /// Whether linear attributes over this many pixels from here are exact enough: L² ≤ ¾·q/|q′|, where q is least.
    #[inline]
    fn is_straight_for(&self, pixels: i32) -> bool {
        let slope = self.q_step.unsigned_abs().min(i32::MAX as u32) as i32;
        let end = self.q.wrapping_add_signed(self.q_step.wrapping_mul(pixels));
        let least = self.bounded(if self.q_step < 0 { end } else { self.q });
        wide(pixels * pixels, slope) <= i64::from(least / 4 * 3)
    }

    /// As [`Place::is_straight_for`] 2^`log2` pixels, at most 2⁸.
    #[inline]
    fn is_straight_for_log2(&self, log2: u32) -> bool {
        let end = self.q.wrapping_add_signed(self.q_step << log2);
        let least = self.bounded(if self.q_step < 0 { end } else { self.q });
        self.q_step.unsigned_abs() <= ((least >> 2) * 3) >> (2 * log2)
    }
}

impl Span<'_> {
    /// Fills pixels from this span's first one with `color` of the first `N` attributes, I16F16,
    /// which never leave the range of the triangle's corners.
    #[inline]
    pub(crate) fn shade<Q: Quality, W, const N: usize>(
        &self,
        pixels: &mut [W],
        color: impl Fn([i32; N]) -> W,
    ) {
        self.fill::<Q, N, _>(pixels, &Each(color, PhantomData));
    }

    /// As [`Span::shade`], run by run.
    ///
    /// Not inlined: a shader that chooses between loops would need the stack of all of them.
    #[inline(never)]
    pub(crate) fn fill<Q: Quality, const N: usize, L: Fill<N>>(&self, pixels: &mut [L::Word], fill: &L) {
        let setup = self.setup;
        let Some(attributes) = setup.attributes.first_chunk::<N>() else {
            return;
        };
        if setup.straight {
            let (mut at, mut step) = ([0; N], [0; N]);
            for (i, attribute) in attributes.iter().enumerate() {
                let plane = setup.at(&attribute.plane, self.x, self.y);
                (at[i], step[i]) = attribute.along(plane, pixels.len() as i32 - 1);
            }
            return fill.run_long(pixels, at, step);
        }
        if Q::EVERY_PIXEL && setup.sliver {
            for (x, pixel) in (self.x..).zip(pixels) {
                *pixel = fill.pixel(setup.resolve_in_sliver(attributes, x, self.y));
            }
            return;
        }
        let (q, q_step) = setup.at(&setup.q, self.x, self.y);
        let mut place =
            Place { attributes, q, q_step, q_min: setup.q_min, values: [0; N], steps: [0; N], zeros: 0 };
        for (i, attribute) in attributes.iter().enumerate() {
            let (value, step) = setup.at(&attribute.plane, self.x, self.y);
            place.values[i] = value as i32;
            place.steps[i] = step;
        }
        if Q::EVERY_PIXEL {
            for pixel in pixels {
                *pixel = fill.pixel(place.resolve());
                place.advance(1);
            }
            return;
        }
        let mut pixels = pixels;
        let max_log2 = fill.max_log2();
        let mut at = place.resolve();
        if place.is_straight_for(pixels.len() as i32 - 1) {
            let step = place.last_steps(&at, pixels.len());
            return fill.run_long(pixels, at, step);
        }
        let mut log2 = max_log2;
        loop {
            // As long as this place allows: where q grows along the row, sub-spans grow too.
            log2 = (log2 + 1).min(max_log2);
            while log2 > 0 && !place.is_straight_for_log2(log2) {
                log2 -= 1;
            }
            if pixels.len() <= 1 << log2 {
                break;
            }
            // The next sub-span starts at a pixel of this span, so inside the triangle.
            let (block, rest) = core::mem::take(&mut pixels).split_at_mut(1 << log2);
            place.advance(1 << log2);
            let next = place.resolve();
            // Towards zero, so that no pixel lies beyond `next`.
            let step = core::array::from_fn(|i| {
                let rise = next[i].wrapping_sub(at[i]);
                (rise + ((rise >> 31) & ((1 << log2) - 1))) >> log2
            });
            fill.run(block, at, step);
            (at, pixels) = (next, rest);
        }
        let step = place.last_steps(&at, pixels.len());
        fill.run(pixels, at, step);
    }
}
