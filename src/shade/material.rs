//! Materials: what the crate brings to draw meshes with.
//!
//! - In: a colour or a texture, and how light falls on it.
//! - Out: a recipe, and the type that says which loops draw it.
//! - Assumes: nothing.

use super::kinds::{Base, Clamped, Flat, Gouraud, Kind, Textured};
use super::quality::{Affine, Exact, Quality, QuarterPixel};
use super::recipe::Recipe;
use super::shader::{Pixels, Shader, Varying};
use crate::frame::PixelFormat;
use crate::geometry::{Coloring, Cull, Inputs};
use crate::scene::Texture;
use core::fmt;
use core::marker::PhantomData;
use embedded_graphics::pixelcolor::{Rgb565, raw::RawU16};
use embedded_graphics::prelude::RawData;

/// What a mesh looks like: one colour, a texture, or its vertices' colours; as it is, or in the light of the
/// [view](crate::View).
///
/// A material is a small value; it borrows its texture and nothing else. The type says which loops draw it, so that only
/// the loops that a program names are in its flash: `K` is the [kind](Kind) of material, and `Q` the [quality](Quality).
///
/// ```
/// use fixel::material::Gouraud;
/// use fixel::{Material, Texture, embedded_graphics::{pixelcolor::Rgb565, prelude::*}};
/// static CHECKS: Texture = Texture::new(&[0xffdf, 0x4a69, 0x4a69, 0xffdf], 1, 1);
/// static LACQUER: Material<Gouraud> = Material::gouraud().lit(); // `static`s name the type
/// let gold = Material::flat(Rgb565::CSS_GOLD);
/// let floor = Material::textured(&CHECKS).texture_scale(4).lit();
/// # let _ = (gold, floor);
/// ```
pub struct Material<'a, K, Q = QuarterPixel> {
    pub(super) recipe: Recipe<'a>,
    pub(super) coloring: Coloring,
    pub(super) cull: Cull,
    kind: PhantomData<fn() -> (K, Q)>,
}

impl<K, Q> Clone for Material<'_, K, Q> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<K, Q> Copy for Material<'_, K, Q> {}

impl<K, Q> fmt::Debug for Material<'_, K, Q> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Material")
            .field("recipe", &self.recipe)
            .field("cull", &self.cull)
            .finish_non_exhaustive()
    }
}

impl<'a, K> Material<'a, K> {
    const fn new(recipe: Recipe<'a>) -> Self {
        Self { recipe, coloring: Coloring::OWN, cull: Cull::Back, kind: PhantomData }
    }
}

impl Material<'static, Flat> {
    /// One colour.
    #[must_use]
    pub fn flat(color: Rgb565) -> Self {
        Self::new(Recipe::plain(RawU16::from(color).into_inner()))
    }
}

impl Material<'static, Gouraud> {
    /// The vertices' colours, blended between them (Gouraud shading).
    #[must_use]
    pub const fn gouraud() -> Self {
        Self::new(Recipe::plain(0))
    }
}

impl<'a> Material<'a, Textured> {
    /// A texture, at the vertices' texture coordinates. It repeats, to negative coordinates too.
    #[must_use]
    pub const fn textured(texture: &Texture<'a>) -> Self {
        Self::new(Recipe { texture: *texture, ..Recipe::plain(0) })
    }
}

impl<'a> Material<'a, Clamped> {
    /// A texture whose border texels are seen beyond its borders. For labels and decals: it takes longer to draw than one that
    /// [repeats](Material::textured), most of all in small triangles.
    #[must_use]
    pub const fn clamped(texture: &Texture<'a>) -> Self {
        Self::new(Recipe { texture: *texture, ..Recipe::plain(0) })
    }
}

impl<'a, K, Q> Material<'a, K, Q> {
    /// The same, exact at every pixel.
    #[must_use]
    pub const fn exact(self) -> Material<'a, K, Exact> {
        self.cast()
    }

    /// The same without perspective.
    #[must_use]
    pub const fn affine(self) -> Material<'a, K, Affine> {
        self.cast()
    }

    /// The same in another quality.
    #[must_use]
    pub const fn quality<P>(self) -> Material<'a, K, P> {
        self.cast()
    }

    const fn cast<L, P>(self) -> Material<'a, L, P> {
        Material { recipe: self.recipe, coloring: self.coloring, cull: self.cull, kind: PhantomData }
    }

    /// The same with other sides left out; without this, backs are.
    #[must_use]
    pub const fn cull(self, cull: Cull) -> Self {
        Self { cull, ..self }
    }

    /// The same, lit once a triangle, in its middle and by its own normal (flat shading), where it is [lit](Material::lit).
    #[must_use]
    pub const fn faceted(self) -> Self {
        Self { coloring: self.coloring.faceted(), ..self }
    }

    /// The same seen and lit from both sides.
    #[must_use]
    pub const fn two_sided(self) -> Self {
        Self { cull: Cull::None, coloring: self.coloring.two_sided(), ..self }
    }

    /// The same with texture coordinates times 2^`log2` (at most 2⁸): a plane that a mesh's coordinates of ±2048 texels
    /// fill shows a texture of 64 texels 16384 times. For textures that repeat.
    #[must_use]
    pub const fn texture_scale(self, log2: u8) -> Self {
        let recipe = Recipe { scale_log2: if log2 > 8 { 8 } else { log2 }, ..self.recipe };
        Self { recipe, ..self }
    }
}

impl<'a, K: Kind, Q> Material<'a, K, Q> {
    /// The same in the light of the view ([`Camera::lit_by`](crate::Camera::lit_by)): once a vertex, by its normal, and
    /// blended between the vertices (Gouraud shading). Colours and texels are multiplied by the light.
    ///
    /// In a view without lights it is seen as if it were not lit.
    #[must_use]
    pub const fn lit(self) -> Material<'a, K::Lit, Q> {
        let base = match K::BASE {
            Base::Same => self.coloring,
            Base::Material => self.coloring.with_base(channels(self.recipe.color)),
            Base::White => self.coloring.with_base([255; 3]),
        };
        Material { coloring: base.lit(), ..self.cast() }
    }
}

impl<F: PixelFormat, K: Kind, Q: Quality> Shader<F> for Material<'_, K, Q> {
    type Quality = Q;

    fn cull(&self) -> Cull {
        self.cull
    }

    fn inputs(&self) -> Inputs {
        K::INPUTS
    }

    fn texture_scale(&self) -> u32 {
        self.recipe.scale_log2.into()
    }

    fn packed_log2(&self) -> Option<[u32; 2]> {
        let is_packed = K::IS_PACKED && !Q::EVERY_PIXEL;
        (is_packed && self.recipe.texture.is_packable(self.recipe.scale_log2.into()))
            .then(|| self.recipe.texture.log2())
    }

    fn has_small(&self) -> bool {
        K::HAS_SMALL
    }

    fn coloring(&self) -> Coloring {
        self.coloring
    }

    fn color(&self, varying: &Varying) -> F::Word {
        K::color::<F>(&self.recipe, varying)
    }

    fn paint<P: Pixels<F::Word, Q>>(&self, pixels: P) {
        K::paint::<F, Q, P>(&self.recipe, pixels);
    }
}

/// RGB565 as 8-bit channels, full as 255.
const fn channels(color: u16) -> [u8; 3] {
    let (red, green, blue) = (color >> 11, color >> 5 & 63, color & 31);
    [(red << 3 | red >> 2) as u8, (green << 2 | green >> 4) as u8, (blue << 3 | blue >> 2) as u8]
}
