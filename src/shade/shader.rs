//! Shaders: what a pixel shows. [`perspective`](super::perspective) says how attributes get to it along a row.
//!
//! - In: the attributes at one pixel centre, or many pixels to choose a fill for.
//! - Out: words.
//! - Assumes: attributes lie in the range of the triangle's corners.

use super::fill::{Each, Fill, FillRow};
use super::quality::{Quality, sealed::Sealed};
use crate::frame::PixelFormat;
use crate::geometry::{Coloring, Cull, Inputs};
use crate::num::{I16F16, U1F31};

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
    pub(super) fn new([u, v, red, green, blue]: [i32; 5]) -> Self {
        Self {
            u: I16F16::from_bits(u),
            v: I16F16::from_bits(v),
            color: [red, green, blue].map(I16F16::from_bits),
        }
    }
}

/// What a [`Shader`] needs to know of a pixel.
///
/// ```
/// use fixel::embedded_graphics::pixelcolor::Rgb565;
/// use fixel::{Fragment, Inputs, QuarterPixel, Reach, Shader, Varying};
/// /// Every other row of the screen, as on an old tube.
/// struct Rows;
/// impl Shader<Rgb565> for Rows {
///     type Quality = QuarterPixel;
///     const REACH: Reach = Reach::Place;
///     fn inputs(&self) -> Inputs {
///         Inputs::None
///     }
///     fn color(&self, _: &Varying) -> u16 {
///         0x07e0
///     }
///     fn fragment(&self, fragment: &Fragment<u16>) -> Option<u16> {
///         (fragment.place[1] % 2 == 0).then(|| self.color(&fragment.varying)) // `None`: left out
///     }
/// }
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Reach {
    /// Its attributes: the fastest, and all that [materials](crate::Material) need.
    Attributes,
    /// Where it is on the screen and how far away, too; and it may be left out.
    Place,
    /// What the target holds, too. Such triangles write no depth; in a list they are drawn last, from back to front.
    Target,
}

/// One pixel of a triangle, for [`Shader::fragment`].
#[derive(Clone, Copy, Debug)]
pub struct Fragment<W> {
    /// The attributes at its centre.
    pub varying: Varying,
    /// Its column and its row on the screen.
    pub place: [i32; 2],
    /// near/w, as depth has it: 1 at the near plane and less beyond. Of orthographic cameras it is linear, 0 at the far plane.
    pub near_w: U1F31,
    /// The word that the target holds.
    pub target: W,
}

/// What a pixel shows. [`Material`](crate::Material) is the shader that comes with the crate.
///
/// A shader may be an `enum` of several, each with numbers of its own: it is asked once for many pixels how to
/// [paint](Shader::paint) them.
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

    /// What it needs to know of a pixel beside its attributes. If it is more than those, [`Shader::fragment`] is asked, and
    /// neither [`Shader::color`] nor [`Shader::paint`] (but the default `fragment` asks `color`). Each pixel is asked for by itself
    /// then, and a [`ShadedTriangle`](crate::ShadedTriangle) takes no such shader.
    const REACH: Reach = Reach::Attributes;

    /// Which attributes [`Shader::color`] reads; the fewer, the faster.
    fn inputs(&self) -> Inputs;

    /// The pixel word for the attributes at one pixel centre.
    fn color(&self, varying: &Varying) -> F::Word;

    /// The pixel word for a pixel, or `None` to leave it out: then its depth stays, too.
    fn fragment(&self, fragment: &Fragment<F::Word>) -> Option<F::Word> {
        Some(self.color(&fragment.varying))
    }

    /// Which side of a triangle [`Camera::draw`](crate::Camera::draw) leaves out.
    fn cull(&self) -> Cull {
        Cull::Back
    }

    /// What colour the vertices of a mesh have, for shaders that read it: their own, unless it says otherwise.
    fn coloring(&self) -> Coloring {
        Coloring::OWN
    }

    /// By how much texture coordinates are multiplied, as a power of two: 2⁰ … 2⁸, so that a plane can repeat its
    /// texture hundreds of times. What goes beyond ±32768 texels starts again at the other end, which no repeated
    /// texture shows.
    fn texture_scale(&self) -> u32 {
        0
    }

    /// Log₂ of the texture's sides, if coordinates are packed in one word.
    #[doc(hidden)]
    fn packed_log2(&self) -> Option<[u32; 2]> {
        None
    }

    /// Fills some pixels of a triangle. The default calls [`Shader::color`] for each; a shader that chooses between several
    /// ways to colour a pixel may do so here, once for many.
    fn paint<P: Pixels<F::Word, Self::Quality>>(&self, pixels: P) {
        let gray = pixels.is_gray();
        match self.inputs() {
            Inputs::None => pixels.fill_evenly(self.color(&Varying::default())),
            Inputs::Uv => {
                pixels.shade(|[u, v]| self.color(&Varying::new([u, v, 0, 0, 0])));
            }
            Inputs::Color if gray => {
                pixels.shade(|[c]| self.color(&Varying::new([0, 0, c, c, c])));
            }
            Inputs::Color => {
                pixels.shade(|[r, g, b]| self.color(&Varying::new([0, 0, r, g, b])));
            }
            Inputs::UvColor if gray => {
                pixels.shade(|[u, v, c]| self.color(&Varying::new([u, v, c, c, c])));
            }
            Inputs::UvColor => {
                pixels.shade(|all| self.color(&Varying::new(all)));
            }
        }
    }
}

/// Pixels side by side, or all of a small triangle, for a [`Shader`] of quality `Q` to fill with words `W`: it says once with what.
///
/// ```
/// use fixel::embedded_graphics::pixelcolor::Rgb565;
/// use fixel::{Inputs, Pixels, QuarterPixel, Shader, Varying};
/// enum Stripes {
///     Upright,
///     Level,
/// }
/// fn stripe(texels: i32) -> u16 {
///     if texels & 0x8_0000 == 0 { 0xffff } else { 0x001f } // each 8 texels wide, from bits of I16F16
/// }
/// impl Shader<Rgb565> for Stripes {
///     type Quality = QuarterPixel;
///     fn inputs(&self) -> Inputs {
///         Inputs::Uv
///     }
///     fn color(&self, at: &Varying) -> u16 {
///         stripe(if matches!(self, Self::Upright) { at.u } else { at.v }.to_bits())
///     }
///     // As `color` alone would do, without a choice at each pixel.
///     fn paint<P: Pixels<u16, QuarterPixel>>(&self, pixels: P) {
///         match self {
///             Self::Upright => pixels.shade(|[u]| stripe(u)),
///             Self::Level => pixels.shade(|[_, v]| stripe(v)),
///         }
///     }
/// }
/// ```
pub trait Pixels<W, Q: Quality>: Sealed + Sized {
    /// Whether the triangle's colours are greys: then there is one attribute for all three channels.
    fn is_gray(&self) -> bool;

    /// Fills them with one word.
    fn fill_evenly(self, word: W);

    #[doc(hidden)]
    fn fill<const N: usize, L: Fill<W> + FillRow<N, Word = W>>(self, fill: &L);

    /// Fills them row by row, small triangles too: without a loop of their own, most of a fill's flash.
    #[doc(hidden)]
    fn fill_rows(self, fill: &dyn Fill<W>);

    /// Whether u and v are inside a texture of 2^`log2` texels everywhere.
    #[doc(hidden)]
    fn uv_are_inside(&self, log2: [u32; 2]) -> bool;

    /// The integer bits, with a sign, that u and v take.
    #[doc(hidden)]
    fn uv_bits(&self) -> [u32; 2];

    #[doc(hidden)]
    fn fill_some(self, fill: &dyn Fill<Option<W>>);

    /// Fills each with `color` of the first `N` attributes that the shader [reads](Shader::inputs), as bits of I16F16: u and v,
    /// then red, green and blue, or one grey. They never leave the range of the triangle's corners, and u and v are less than the
    /// greatest value there, unless they are the same at all three. Of more than five attributes nothing is filled.
    #[inline]
    fn shade<const N: usize>(self, color: impl Fn([i32; N]) -> W) {
        self.fill(&Each::<N, Q, W, _>::new(color));
    }

    /// As [`Pixels::shade`], row by row, without those pixels of which `color` makes nothing.
    #[doc(hidden)]
    #[inline]
    fn shade_some<const N: usize>(self, color: impl Fn([i32; N]) -> Option<W>) {
        self.fill_some(&Each::<N, Q, Option<W>, _>::new(color));
    }

    /// As [`Pixels::shade`], [row by row](Pixels::fill_rows).
    #[doc(hidden)]
    #[inline]
    fn shade_rows<const N: usize>(self, color: impl Fn([i32; N]) -> W) {
        self.fill_rows(&Each::<N, Q, W, _>::new(color));
    }
}
