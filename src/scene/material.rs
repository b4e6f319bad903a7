//! Materials: the shaders that come with the crate.

use super::{Texture, Wrap};
use crate::pipeline::{Affine, Cull, Exact, Inputs, Quality, QuarterPixel, Shader, Span, Varying};
use crate::target::PixelFormat;
use core::marker::PhantomData;
use embedded_graphics::pixelcolor::{Rgb565, raw::RawU16};
use embedded_graphics::prelude::RawData;

/// What a mesh looks like: one colour, a texture, or its vertices' colours.
///
/// The type parameter is the [quality](Quality); only the loops of the qualities that a program
/// names are in its flash.
#[derive(Debug)]
pub struct Material<'a, Q = QuarterPixel> {
    surface: Surface<'a>,
    cull: Cull,
    quality: PhantomData<fn() -> Q>,
}

#[derive(Clone, Copy, Debug)]
enum Surface<'a> {
    /// RGB565 bits.
    Flat(u16),
    Textured(Texture<'a>),
    Gouraud,
}

impl<Q> Clone for Material<'_, Q> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<Q> Copy for Material<'_, Q> {}

impl<'a> Material<'a> {
    const fn new(surface: Surface<'a>) -> Self {
        Self { surface, cull: Cull::Back, quality: PhantomData }
    }

    /// One colour.
    #[must_use]
    pub fn flat(color: Rgb565) -> Self {
        Self::new(Surface::Flat(RawU16::from(color).into_inner()))
    }

    /// A texture, at the vertices' texture coordinates.
    #[must_use]
    pub const fn textured(texture: &Texture<'a>) -> Self {
        Self::new(Surface::Textured(*texture))
    }

    /// The vertices' colours, blended between them.
    #[must_use]
    pub const fn gouraud() -> Self {
        Self::new(Surface::Gouraud)
    }
}

impl<'a, Q> Material<'a, Q> {
    /// The same, exact at every pixel.
    #[must_use]
    pub const fn exact(self) -> Material<'a, Exact> {
        self.quality()
    }

    /// The same without perspective.
    #[must_use]
    pub const fn affine(self) -> Material<'a, Affine> {
        self.quality()
    }

    /// The same in another quality.
    #[must_use]
    pub const fn quality<P>(self) -> Material<'a, P> {
        Material { surface: self.surface, cull: self.cull, quality: PhantomData }
    }

    /// The same with other sides left out; without this, backs are.
    #[must_use]
    pub const fn cull(self, cull: Cull) -> Self {
        Self { cull, ..self }
    }
}

impl<F: PixelFormat, Q: Quality> Shader<F> for Material<'_, Q> {
    type Quality = Q;

    fn cull(&self) -> Cull {
        self.cull
    }

    fn inputs(&self) -> Inputs {
        match self.surface {
            Surface::Flat(_) => Inputs::None,
            Surface::Textured(_) => Inputs::Uv,
            Surface::Gouraud => Inputs::Color,
        }
    }

    fn color(&self, varying: &Varying) -> F::Word {
        let (u, v) = (varying.u.to_bits() >> 16, varying.v.to_bits() >> 16);
        match &self.surface {
            Surface::Flat(color) => F::rgb565(*color),
            Surface::Textured(texture) => F::rgb565(match texture.wrapping() {
                Wrap::Repeat => texture.fetch_repeat(u, v),
                Wrap::Clamp => texture.fetch_clamp(u, v),
            }),
            Surface::Gouraud => gouraud::<F>(varying.color.map(|channel| channel.to_bits())),
        }
    }

    fn span(&self, span: &Span<'_>, pixels: &mut [F::Word]) {
        match &self.surface {
            Surface::Flat(color) => pixels.fill(F::rgb565(*color)),
            Surface::Textured(texture) => match texture.wrapping() {
                Wrap::Repeat => {
                    span.shade::<Q, F::Word, 2>(pixels, |[u, v]| {
                        F::rgb565(texture.fetch_repeat(u >> 16, v >> 16))
                    });
                }
                Wrap::Clamp => {
                    span.shade::<Q, F::Word, 2>(pixels, |[u, v]| {
                        F::rgb565(texture.fetch_clamp(u >> 16, v >> 16))
                    });
                }
            },
            Surface::Gouraud => span.shade::<Q, F::Word, 3>(pixels, gouraud::<F>),
        }
    }
}

/// Channels in I16F16, 0 … 255, which `shade` promises.
#[inline]
fn gouraud<F: PixelFormat>(channels: [i32; 3]) -> F::Word {
    let [red, green, blue] = channels.map(|channel| (channel >> 16) as u8);
    F::rgb888(red, green, blue)
}
