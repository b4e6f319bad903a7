//! Materials: the shaders that come with the crate.

use super::channels::{Gray, RedBlueGreen, color, lit};
use super::colors::Colors;
use super::lit_texels::LitTexels;
use super::quality::{Affine, Exact, Quality, QuarterPixel};
use super::shader::{Pixels, Shader, Varying};
use super::texels::Texels;
use crate::frame::PixelFormat;
use crate::geometry::{Coloring, Cull, Inputs};
use crate::math::Pose;
use crate::scene::{Lights, Texture};
use core::marker::PhantomData;
use embedded_graphics::pixelcolor::{Rgb565, raw::RawU16};
use embedded_graphics::prelude::RawData;

/// What a mesh looks like: one colour, a texture, or its vertices' colours; as it is, or in the light of some [`Lights`].
///
/// The type parameter is the [quality](Quality); only the loops of the qualities that a program
/// names are in its flash.
#[derive(Debug)]
pub struct Material<'a, Q = QuarterPixel> {
    surface: Surface<'a>,
    cull: Cull,
    lights: Option<&'a Lights<'a>>,
    faceted: bool,
    two_sided: bool,
    texture_scale: u8,
    quality: PhantomData<fn() -> Q>,
}

#[derive(Clone, Copy, Debug)]
enum Surface<'a> {
    /// RGB565 bits.
    Flat(u16),
    Textured(Texture<'a>),
    Clamped(Texture<'a>),
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
        Self {
            surface,
            cull: Cull::Back,
            lights: None,
            faceted: false,
            two_sided: false,
            texture_scale: 0,
            quality: PhantomData,
        }
    }

    /// One colour.
    #[must_use]
    pub fn flat(color: Rgb565) -> Self {
        Self::new(Surface::Flat(RawU16::from(color).into_inner()))
    }

    /// A texture, at the vertices' texture coordinates. It repeats, to negative coordinates too.
    #[must_use]
    pub const fn textured(texture: &Texture<'a>) -> Self {
        Self::new(Surface::Textured(*texture))
    }

    /// A texture whose border texels are seen beyond its borders. For labels and decals: it takes longer to draw than one that
    /// [repeats](Material::textured), most of all in small triangles.
    #[must_use]
    pub const fn clamped(texture: &Texture<'a>) -> Self {
        Self::new(Surface::Clamped(*texture))
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
        Material {
            surface: self.surface,
            cull: self.cull,
            lights: self.lights,
            faceted: self.faceted,
            two_sided: self.two_sided,
            texture_scale: self.texture_scale,
            quality: PhantomData,
        }
    }

    /// The same with other sides left out; without this, backs are.
    #[must_use]
    pub const fn cull(self, cull: Cull) -> Self {
        Self { cull, ..self }
    }

    /// The same in the light of some lights: once a vertex, by its normal, and blended between the vertices (Gouraud
    /// shading). Colours and texels are multiplied by the light.
    #[must_use]
    pub const fn lit(self, lights: &'a Lights<'a>) -> Self {
        Self { lights: Some(lights), ..self }
    }

    /// The same with the light of each triangle's middle on all of it, by the triangle's own normal (flat shading).
    #[must_use]
    pub const fn faceted(self) -> Self {
        Self { faceted: true, ..self }
    }

    /// The same seen and lit from both sides.
    #[must_use]
    pub const fn two_sided(self) -> Self {
        Self { cull: Cull::None, two_sided: true, ..self }
    }

    /// The same with texture coordinates times 2^`log2` (at most 2⁸): a plane that a mesh's coordinates of ±2048 texels
    /// fill shows a texture of 64 texels 16384 times. For textures that repeat.
    #[must_use]
    pub const fn texture_scale(self, log2: u8) -> Self {
        Self { texture_scale: if log2 > 8 { 8 } else { log2 }, ..self }
    }
}

impl<F: PixelFormat, Q: Quality> Shader<F> for Material<'_, Q> {
    type Quality = Q;

    fn cull(&self) -> Cull {
        self.cull
    }

    fn inputs(&self) -> Inputs {
        match (&self.surface, self.lights) {
            (Surface::Flat(_), None) => Inputs::None,
            (Surface::Textured(_) | Surface::Clamped(_), None) => Inputs::Uv,
            (Surface::Textured(_) | Surface::Clamped(_), Some(_)) => Inputs::UvColor,
            (Surface::Flat(_) | Surface::Gouraud, _) => Inputs::Color,
        }
    }

    fn texture_scale(&self) -> u32 {
        self.texture_scale.into()
    }

    fn packed_log2(&self) -> Option<[u32; 2]> {
        match &self.surface {
            Surface::Textured(texture) => packed_log2::<Q>(texture, self.texture_scale),
            Surface::Flat(_) | Surface::Clamped(_) | Surface::Gouraud => None,
        }
    }

    fn has_small(&self) -> bool {
        !matches!(self.surface, Surface::Clamped(_))
    }

    fn coloring<'p>(&self, pose: &'p Pose) -> Coloring<'p> {
        let Some(lights) = self.lights else {
            return Coloring::default();
        };
        let base = match self.surface {
            Surface::Flat(color) => Some(channels(color)),
            Surface::Textured(_) | Surface::Clamped(_) => Some([255; 3]),
            Surface::Gouraud => None,
        };
        Coloring::lit(base, lights.in_mesh_space(pose), self.faceted, self.two_sided)
    }

    fn color(&self, varying: &Varying) -> F::Word {
        let (u, v) = (varying.u.to_bits() >> 16, varying.v.to_bits() >> 16);
        let channels = whole(varying.color.map(|channel| channel.to_bits()));
        match (&self.surface, self.lights) {
            (Surface::Flat(color), None) => F::rgb565(*color),
            (Surface::Textured(texture), None) => F::rgb565(texture.fetch_repeat(u, v)),
            (Surface::Textured(texture), Some(_)) => lit::<F>(texture.fetch_repeat(u, v), channels),
            (Surface::Clamped(texture), None) => F::rgb565(texture.fetch_clamp(u, v)),
            (Surface::Clamped(texture), Some(_)) => lit::<F>(texture.fetch_clamp(u, v), channels),
            (Surface::Flat(_) | Surface::Gouraud, _) => color::<F>(channels),
        }
    }

    fn paint<P: Pixels<F::Word, Q>>(&self, pixels: P) {
        let (gray, exact) = (pixels.is_gray(), Q::EVERY_PIXEL);
        let scale_log2 = self.texture_scale.into();
        match (&self.surface, self.lights) {
            (Surface::Flat(color), None) => pixels.fill_evenly(F::rgb565(*color)),
            (Surface::Textured(texture), None) => textured::<F, Q, P>(texture, scale_log2, pixels),
            (Surface::Textured(texture), Some(_)) => match (exact, gray) {
                (false, true) => pixels.fill(&LitTexels::<1, F, Gray>::new(texture, scale_log2)),
                (false, false) => pixels.fill(&LitTexels::<3, F, RedBlueGreen>::new(texture, scale_log2)),
                (true, true) => pixels.shade(|[u, v, light]| {
                    lit::<F>(texture.fetch_repeat(u >> 16, v >> 16), whole([light; 3]))
                }),
                (true, false) => pixels.shade(|[u, v, light @ ..]: [i32; 5]| {
                    lit::<F>(texture.fetch_repeat(u >> 16, v >> 16), whole(light))
                }),
            },
            (Surface::Clamped(texture), None) => {
                pixels.shade_rows(|[u, v]| F::rgb565(texture.fetch_clamp(u >> 16, v >> 16)));
            }
            (Surface::Clamped(texture), Some(_)) if gray => {
                pixels.shade_rows(|[u, v, light]| {
                    lit::<F>(texture.fetch_clamp(u >> 16, v >> 16), whole([light; 3]))
                });
            }
            (Surface::Clamped(texture), Some(_)) => pixels.shade_rows(|[u, v, light @ ..]: [i32; 5]| {
                lit::<F>(texture.fetch_clamp(u >> 16, v >> 16), whole(light))
            }),
            (Surface::Flat(_) | Surface::Gouraud, _) => match (exact, gray) {
                (false, true) => pixels.fill(&Colors::<1, F, Gray>::NEW),
                (false, false) => pixels.fill(&Colors::<3, F, RedBlueGreen>::NEW),
                (true, true) => pixels.shade(|[gray]| color::<F>(whole([gray; 3]))),
                (true, false) => pixels.shade(|rgb: [i32; 3]| color::<F>(whole(rgb))),
            },
        }
    }
}

/// A [`Material`] that is a texture which repeats, and can be nothing else: a program that draws with no other has
/// two thirds of the code that it has with [`Material`], which has loops for every surface.
///
/// ```
/// use fixel::{Material, Texture, Textured};
/// static CHECKS: Texture = Texture::new(&[0xffdf, 0x4a69, 0x4a69, 0xffdf], 1, 1);
/// let checks = Textured::new(&CHECKS).texture_scale(2); // draws as Material::textured(&CHECKS).texture_scale(2)
/// # let _ = checks;
/// ```
#[derive(Debug)]
pub struct Textured<'a, Q = QuarterPixel> {
    texture: Texture<'a>,
    cull: Cull,
    texture_scale: u8,
    quality: PhantomData<fn() -> Q>,
}

impl<Q> Clone for Textured<'_, Q> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<Q> Copy for Textured<'_, Q> {}

impl<'a> Textured<'a> {
    /// At the vertices' texture coordinates; it repeats, and backs are left out.
    #[must_use]
    pub const fn new(texture: &Texture<'a>) -> Self {
        Self { texture: *texture, cull: Cull::Back, texture_scale: 0, quality: PhantomData }
    }
}

impl<'a, Q> Textured<'a, Q> {
    /// The same in another quality.
    #[must_use]
    pub const fn quality<P>(self) -> Textured<'a, P> {
        Textured {
            texture: self.texture,
            cull: self.cull,
            texture_scale: self.texture_scale,
            quality: PhantomData,
        }
    }

    /// The same with other sides left out.
    #[must_use]
    pub const fn cull(self, cull: Cull) -> Self {
        Self { cull, ..self }
    }

    /// As [`Material::texture_scale`].
    #[must_use]
    pub const fn texture_scale(self, log2: u8) -> Self {
        Self { texture_scale: if log2 > 8 { 8 } else { log2 }, ..self }
    }
}

impl<F: PixelFormat, Q: Quality> Shader<F> for Textured<'_, Q> {
    type Quality = Q;

    const LIT: bool = false;

    fn cull(&self) -> Cull {
        self.cull
    }

    fn inputs(&self) -> Inputs {
        Inputs::Uv
    }

    fn texture_scale(&self) -> u32 {
        self.texture_scale.into()
    }

    fn packed_log2(&self) -> Option<[u32; 2]> {
        packed_log2::<Q>(&self.texture, self.texture_scale)
    }

    fn color(&self, varying: &Varying) -> F::Word {
        F::rgb565(self.texture.fetch_repeat(varying.u.to_bits() >> 16, varying.v.to_bits() >> 16))
    }

    fn paint<P: Pixels<F::Word, Q>>(&self, pixels: P) {
        textured::<F, Q, P>(&self.texture, self.texture_scale.into(), pixels);
    }
}

fn packed_log2<Q: Quality>(texture: &Texture<'_>, texture_scale: u8) -> Option<[u32; 2]> {
    (!Q::EVERY_PIXEL && texture.is_packable(texture_scale.into())).then_some(texture.log2())
}

fn textured<F, Q, P>(texture: &Texture<'_>, scale_log2: u32, pixels: P)
where
    F: PixelFormat,
    Q: Quality,
    P: Pixels<F::Word, Q>,
{
    if Q::EVERY_PIXEL {
        pixels.shade(|[u, v]| F::rgb565(texture.fetch_repeat(u >> 16, v >> 16)));
    } else {
        pixels.fill(&Texels::<F>::new(texture, scale_log2));
    }
}

/// Channels of I16F16, 0 … 255.996, without their fractions.
#[inline]
fn whole(channels: [i32; 3]) -> [u32; 3] {
    channels.map(|channel| channel as u32 >> 16)
}

/// RGB565 as 8-bit channels, full as 255.
const fn channels(color: u16) -> [u8; 3] {
    let (red, green, blue) = (color >> 11, color >> 5 & 63, color & 31);
    [(red << 3 | red >> 2) as u8, (green << 2 | green >> 4) as u8, (blue << 3 | blue >> 2) as u8]
}
