//! Materials: what the crate brings to draw meshes with.
//!
//! - In: a colour or a texture, and how light falls on it.
//! - Out: a recipe, and the type that says which loops draw it.
//! - Assumes: nothing.

use super::blend::{Additive, Layer, Multiply, Opaque, ScreenDoor};
use super::bordered::{Clamped, Mirrored};
use super::cover::Layering;
use super::cut_out::{CutOut, VertexAlpha};
use super::kinds::{Base, ColorlessKind, Flat, Gouraud, Kind, LitKind, TexelKind, Textured};
use super::quality::{Affine, Exact, Quality, QuarterPixel};
use super::recipe::Recipe;
use super::shader::{Pixels, Shader, Varying};
use crate::frame::PixelFormat;
use crate::geometry::{Coloring, Cull, Inputs};
use crate::scene::{Mask, Texture};
use core::fmt;
use core::marker::PhantomData;
use embedded_graphics::pixelcolor::{Rgb565, raw::RawU16};
use embedded_graphics::prelude::RawData;

/// What a mesh looks like: one colour, a texture, or its vertices' colours; as it is, or in the light of the
/// [view](crate::View).
///
/// A material is a small value; it borrows its texture and nothing else. The type says which loops draw it, so that only
/// the loops that a program names are in its flash: `K` is the [kind](Kind) of material, `Q` the [quality](Quality), and `L`
/// how it is [laid](Layer) over what is there. [`surfaces`](crate::guide::surfaces) shows what the builders do.
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
///
/// # In which order
///
/// Builders say what is the same and what is not, so most can be called in any order. These count:
///
/// - [`cut_out`](Material::cut_out) and [`masked`](Material::masked) come before [`vertex_alpha`](Material::vertex_alpha).
/// - Of [`additive`](Material::additive), [`multiply`](Material::multiply) and [`screen_door`](Material::screen_door) the last one
///   counts. They keep the [`alpha`](Material::alpha), of which the last one counts, too.
/// - [`two_sided`](Material::two_sided) shows both sides; [`cull`](Material::cull) after it leaves one out again, and keeps its light.
/// - What is said by [`depth`](Material::depth) stays, whatever is said of transparency before or after it.
pub struct Material<'a, K, Q = QuarterPixel, L = Opaque> {
    pub(super) recipe: Recipe<'a>,
    pub(super) layering: Layering,
    pub(super) coloring: Coloring,
    pub(super) cull: Cull,
    kind: PhantomData<Types<K, Q, L>>,
}

/// What is known of a material by its type, and takes no memory.
type Types<K, Q, L> = fn() -> (K, Q, L);

impl<K, Q, L> Clone for Material<'_, K, Q, L> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<K, Q, L> Copy for Material<'_, K, Q, L> {}

impl<K, Q, L> fmt::Debug for Material<'_, K, Q, L> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Material")
            .field("recipe", &self.recipe)
            .field("layering", &self.layering)
            .field("cull", &self.cull)
            .finish_non_exhaustive()
    }
}

impl<'a, K> Material<'a, K> {
    const fn new(recipe: Recipe<'a>) -> Self {
        let (layering, coloring) = (Layering::OPAQUE, Coloring::OWN);
        Self { recipe, layering, coloring, cull: Cull::Back, kind: PhantomData }
    }
}

impl Material<'static, Flat> {
    /// One colour.
    #[must_use]
    pub fn flat(color: Rgb565) -> Self {
        Self::flat_bits(RawU16::from(color).into_inner())
    }

    /// One colour, in a `const`: red in bits 11 … 15, green in 5 … 10, blue in 0 … 4.
    #[must_use]
    pub const fn flat_bits(rgb565: u16) -> Self {
        Self::new(Recipe::plain(rgb565))
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
    /// A texture whose border texels are seen beyond its borders. For labels and decals. Rows that cross a border are split there: they
    /// take about as long as if the texture [repeated](Material::textured), but for small triangles, and for coordinates of more than
    /// ±2046 texels, which take several times as long.
    #[must_use]
    pub const fn clamped(texture: &Texture<'a>) -> Self {
        Self::new(Recipe { texture: *texture, ..Recipe::plain(0) })
    }
}

impl<'a> Material<'a, Mirrored> {
    /// A texture that is turned round at each of its borders, so that it repeats without a seam, every other time as its mirror image.
    /// It takes about as long as one that is [clamped](Material::clamped); where it repeats within 16 pixels or less of a row, up to
    /// three times as long.
    #[must_use]
    pub const fn mirrored(texture: &Texture<'a>) -> Self {
        Self::new(Recipe { texture: *texture, ..Recipe::plain(0) })
    }
}

impl<'a, K, Q, L> Material<'a, K, Q, L> {
    /// The same, exact at every pixel.
    #[must_use]
    pub const fn exact(self) -> Material<'a, K, Exact, L> {
        self.cast()
    }

    /// The same without perspective.
    #[must_use]
    pub const fn affine(self) -> Material<'a, K, Affine, L> {
        self.cast()
    }

    /// The same in another quality.
    #[must_use]
    pub const fn quality<P>(self) -> Material<'a, K, P, L> {
        self.cast()
    }

    pub(super) const fn cast<K2, Q2, L2>(self) -> Material<'a, K2, Q2, L2> {
        let Self { recipe, layering, coloring, cull, .. } = self;
        Material { recipe, layering, coloring, cull, kind: PhantomData }
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
        self.with(Recipe { scale_log2: if log2 > 8 { 8 } else { log2 }, ..self.recipe })
    }

    /// The same with its light added to what is there: min(t + s·a / 255, m) for each channel, s being the
    /// material's, t what is there, m the greatest value, and a the [alpha](Material::alpha), 255 without one. Nothing is
    /// hidden, and no depth written.
    #[must_use]
    pub const fn additive(self) -> Material<'a, K, Q, Additive> {
        self.cast()
    }

    /// The same as a coloured glass, through which all else is seen: t·s / m for each channel, s being the material's, t
    /// what is there, and m the greatest value. Nothing is hidden, and no depth written. With an [alpha](Material::alpha) of less
    /// than 255 the glass is mixed with white first: (s·a + m·(255 − a)) / 255, rounded, in place of s.
    #[must_use]
    pub const fn multiply(self) -> Material<'a, K, Q, Multiply> {
        self.cast()
    }

    /// The same with pixels left out instead of blended: with an [alpha](Material::alpha) of a, 0 … 255, those are drawn that have
    /// a > 255·(b + ½) / 64, b being a pixel's number, 0 … 63, in Bayer's pattern of 8×8 on the screen. So it hides what is behind it,
    /// writes depth, and needs no order. Without an alpha all pixels are drawn. Of two such surfaces, one behind the other, the one
    /// behind shows only where it has the greater alpha, as both have the same pattern.
    #[must_use]
    pub const fn screen_door(self) -> Material<'a, K, Q, ScreenDoor> {
        self.cast()
    }

    const fn with(self, recipe: Recipe<'a>) -> Self {
        Self { recipe, ..self }
    }
}

impl<'a, K, Q, L: Layer> Material<'a, K, Q, L> {
    /// The same as opaque as `alpha` says, of 255: (s·a + t·(255 − a)) / 255 for each channel, s being the material's, t what
    /// is there, and a alpha (source over). It is hidden by what is in front, and writes no depth unless
    /// [`depth`](Material::depth) says so.
    ///
    /// 255 is opaque, but still drawn like this; 0 is nothing, at the cost of something: leave such a draw out.
    ///
    /// Such materials have to be drawn after all that is opaque, and from back to front: a [list](crate::DisplayList) does
    /// that by itself.
    #[must_use]
    pub const fn alpha(self, alpha: u8) -> Material<'a, K, Q, L::Alpha> {
        Self { layering: Layering { alpha, ..self.layering }, ..self }.cast()
    }

    /// The same with depth used otherwise. `tests`: whether nearer things hide it. `writes`: whether it hides what is drawn later and
    /// is farther away.
    #[must_use]
    pub const fn depth(self, tests: bool, writes: bool) -> Material<'a, K, Q, L::Masked> {
        let layering = Layering { tests_depth: tests, writes_depth: Some(writes), ..self.layering };
        Self { layering, ..self }.cast()
    }

    /// The same, counted as nearer than it is by so many steps of 16-bit depth (2⁻¹⁶ of near/w), or as farther where that is
    /// below 0; near/w is limited to 0 … 1 then. For decals: marks that lie in the plane of a wall, of other triangles.
    ///
    /// How many steps they want depends on the view, since corners are rounded to 1/16 pixel: the steeper a wall and the nearer to the
    /// near plane, the more. With the near plane at 0.1, 3 to 10 units away and at up to 65° and 50°, 8 steps left no hole in 300 views
    /// of 160×120; 2 left some in 13.
    #[must_use]
    pub const fn depth_bias(self, steps: i16) -> Material<'a, K, Q, L::Masked> {
        Self { layering: Layering { depth_bias: steps, ..self.layering }, ..self }.cast()
    }
}

impl<'a, K: TexelKind, Q, L: Layer> Material<'a, K, Q, L> {
    /// The same without the texels of this colour, exactly and before any light: there is nothing where they would be, and no
    /// depth is written. For leaves and fences.
    #[must_use]
    pub fn cut_out(self, key: Rgb565) -> Material<'a, CutOut<K>, Q, L::Masked> {
        let color = RawU16::from(key).into_inner();
        self.with(Recipe { color, mask: None, ..self.recipe }).cast()
    }

    /// The same with the texels only that a mask has; as [`Material::cut_out`].
    #[must_use]
    pub const fn masked(self, mask: &Mask<'a>) -> Material<'a, CutOut<K>, Q, L::Masked> {
        self.with(Recipe { mask: Some(*mask), ..self.recipe }).cast()
    }
}

impl<'a, K: ColorlessKind, Q, L: Layer> Material<'a, K, Q, L> {
    /// The same as opaque as its vertices say, times [alpha](Material::alpha). A vertex's alpha is red of its colour, which such
    /// materials need for nothing else; it is blended between vertices. [`Vertex::alpha`](crate::Vertex::alpha) sets it; a vertex
    /// without a colour is white, so opaque.
    ///
    /// There is none with light, nor of [`gouraud`](Material::gouraud), where colours are needed: that takes a
    /// [`Shader`](crate::Shader) which [reads the target](crate::Reach::Target).
    #[must_use]
    pub const fn vertex_alpha(self) -> Material<'a, VertexAlpha<K>, Q, L::Alpha> {
        self.cast()
    }
}

impl<'a, K: LitKind, Q, L> Material<'a, K, Q, L> {
    /// The same in the light of the view ([`Camera::lit_by`](crate::Camera::lit_by)): once a vertex, by its normal, and
    /// blended between the vertices (Gouraud shading). Colours and texels are multiplied by the light.
    ///
    /// In a view without lights it is seen as if it were not lit.
    #[must_use]
    pub const fn lit(self) -> Material<'a, K::Lit, Q, L> {
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
