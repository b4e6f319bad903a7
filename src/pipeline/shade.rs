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

use super::color::Coloring;
use super::setup::{Attribute, Cull};
use super::span::Span;
use crate::math::Pose;
use crate::math::recip::Reciprocal;
use crate::num::{I16F16, wide};
use crate::target::PixelFormat;

/// How exactly perspective is followed between the pixels of a span: [`Exact`], [`QuarterPixel`]
/// or [`Affine`].
///
/// The error is measured in pixels on the screen: the error of an attribute, divided by
/// its largest change over one pixel step (at least 1 texel or 1/255).
pub trait Quality: sealed::Sealed {
    /// Whether the division by w takes place at all.
    #[doc(hidden)]
    const PERSPECTIVE: bool;
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
    const PERSPECTIVE: bool = true;
    const EVERY_PIXEL: bool = true;
}

impl Quality for QuarterPixel {
    const PERSPECTIVE: bool = true;
    const EVERY_PIXEL: bool = false;
}

impl Quality for Affine {
    const PERSPECTIVE: bool = false;
    const EVERY_PIXEL: bool = false;
}

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

/// The longest sub-span, log₂: beyond it nothing is gained.
const MAX_LOG2: u32 = 5;

/// A place in a span: q and the first `N` attributes' planes.
struct Place<'a, const N: usize> {
    attributes: &'a [Attribute; N],
    q: u32,
    q_step: i32,
    q_min: u32,
    values: [i32; N],
}

impl<const N: usize> Place<'_, N> {
    #[inline]
    fn advance(&mut self, pixels: i32) {
        self.q = self.q.wrapping_add_signed(self.q_step.wrapping_mul(pixels));
        for (value, attribute) in self.values.iter_mut().zip(self.attributes) {
            *value = value.wrapping_add(attribute.step.wrapping_mul(pixels));
        }
    }

    /// q with rounding errors below the least value at a corner taken away; those above 2³¹ do no harm.
    #[inline]
    fn bounded(&self, q: u32) -> u32 {
        if q.wrapping_sub(self.q_min) > 3 << 30 { self.q_min } else { q }
    }

    /// The attributes here, I16F16: one reciprocal.
    #[inline]
    fn resolve(&self) -> [i32; N] {
        let q = Reciprocal::coarse(self.bounded(self.q));
        core::array::from_fn(|i| self.attributes[i].resolve(self.values[i], q))
    }

    /// log₂ of the sub-span's length for the next `count` pixels: L² ≤ ¾·q/|q′|, where q is least.
    #[inline]
    fn sub_span_log2(&self, count: i32) -> SubSpans {
        let end = self.q.wrapping_add_signed(self.q_step.wrapping_mul(count - 1));
        let limit = self.bounded(self.q).min(self.bounded(end)) / 4 * 3;
        let slope = self.q_step.unsigned_abs();
        if wide((count - 1) * (count - 1), slope.min(i32::MAX as u32) as i32) <= i64::from(limit) {
            return SubSpans::One;
        }
        let mut log2 = MAX_LOG2;
        while log2 > 0 && slope > limit >> (2 * log2) {
            log2 -= 1;
        }
        SubSpans::Log2(log2)
    }
}

enum SubSpans {
    /// The whole span.
    One,
    /// 2^this pixels each.
    Log2(u32),
}

impl Span<'_> {
    /// Fills pixels from this span's first one with `color` of the first `N` attributes, I16F16,
    /// which never leave the range of the triangle's corners.
    ///
    /// Not inlined: a shader that chooses between loops would need the stack of all of them.
    #[inline(never)]
    pub(crate) fn shade<Q: Quality, W, const N: usize>(
        &self,
        pixels: &mut [W],
        color: impl Fn([i32; N]) -> W,
    ) {
        let setup = self.setup;
        let Some(attributes) = setup.attributes.first_chunk::<N>() else {
            return;
        };
        let weights = setup.weights(self.x, self.y);
        let mut place = Place {
            attributes,
            q: setup.q.at(weights),
            q_step: setup.q.step,
            q_min: setup.q_min,
            values: core::array::from_fn(|i| attributes[i].at(weights)),
        };
        let sub_spans =
            if Q::EVERY_PIXEL { SubSpans::Log2(0) } else { place.sub_span_log2(pixels.len() as i32) };
        match sub_spans {
            SubSpans::Log2(0) => {
                for pixel in pixels {
                    *pixel = color(place.resolve());
                    place.advance(1);
                }
            }
            SubSpans::Log2(log2) => {
                let mut pixels = pixels;
                let mut at = place.resolve();
                // The next sub-span starts at a pixel of this span, so inside the triangle.
                while pixels.len() > 1 << log2 {
                    let (block, rest) = core::mem::take(&mut pixels).split_at_mut(1 << log2);
                    place.advance(1 << log2);
                    let next = place.resolve();
                    // Towards zero, so that no pixel lies beyond `next`.
                    let step = core::array::from_fn(|i| {
                        let rise = next[i].wrapping_sub(at[i]);
                        (rise + ((rise >> 31) & ((1 << log2) - 1))) >> log2
                    });
                    run(block, at, step, &color);
                    (at, pixels) = (next, rest);
                }
                tail(pixels, at, place, &color);
            }
            SubSpans::One => {
                let at = place.resolve();
                tail(pixels, at, place, &color);
            }
        }
    }
}

/// The last sub-span: exact at its first and at its last pixel.
#[inline(never)]
fn tail<W, const N: usize>(
    pixels: &mut [W],
    at: [i32; N],
    mut place: Place<'_, N>,
    color: &impl Fn([i32; N]) -> W,
) {
    let steps = pixels.len().saturating_sub(1) as i32;
    let mut step = [0; N];
    if steps > 0 {
        place.advance(steps);
        let last = place.resolve();
        // 1/steps with 31 bits, rounded down, so that no pixel lies beyond `last`.
        let reciprocal = Reciprocal::precise(steps as u32);
        let inverse = (reciprocal.mantissa - 4) >> (31 - reciprocal.zeros);
        step = core::array::from_fn(|i| {
            let rise = last[i].wrapping_sub(at[i]);
            let size = (wide(rise.wrapping_abs(), inverse) >> 31) as i32;
            if rise < 0 { -size } else { size }
        });
    }
    run(pixels, at, step, color);
}

#[inline]
fn run<W, const N: usize>(
    pixels: &mut [W],
    mut at: [i32; N],
    step: [i32; N],
    color: &impl Fn([i32; N]) -> W,
) {
    for pixel in pixels {
        *pixel = color(at);
        for (value, step) in at.iter_mut().zip(step) {
            *value = value.wrapping_add(step);
        }
    }
}
