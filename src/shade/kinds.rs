//! Kinds of material: which loops draw a material, known from its type.
//!
//! - In: a material's recipe, and pixels.
//! - Out: the fill that these pixels get.
//! - Assumes: the triangle was set up for the kind's inputs.
//!
//! A program names the kinds of its materials where it makes them. So only the loops of these kinds are linked.

use super::channels::{Gray, RedBlueGreen, color, lit};
use super::colors::Colors;
use super::cover;
use super::lit_texels::LitTexels;
use super::quality::Quality;
use super::recipe::Recipe;
use super::shader::{Pixels, Varying};
use super::texels::Texels;
use crate::frame::PixelFormat;
use crate::geometry::Inputs;
use crate::scene::Texture;
use sealed::Sealed;

/// A kind of [`Material`](crate::Material): [`Flat`], [`Gouraud`], [`Textured`], [`Clamped`](crate::material::Clamped),
/// [`Mirrored`](crate::material::Mirrored), what [light](LitKind) makes of them,
/// and [`CutOut`](crate::material::CutOut) and [`VertexAlpha`](crate::material::VertexAlpha) of these.
pub trait Kind: Sealed + 'static {
    /// Which attributes it reads.
    #[doc(hidden)]
    const INPUTS: Inputs;
    /// Whether its texture may be packed.
    #[doc(hidden)]
    const IS_PACKED: bool = false;
    /// Writes how opaque the vertices make pixels, if they do.
    #[doc(hidden)]
    #[must_use]
    fn opacity<Q: Quality>() -> Option<Opacity> {
        None
    }

    /// The word of one pixel.
    #[doc(hidden)]
    fn color<F: PixelFormat>(recipe: &Recipe<'_>, varying: &Varying) -> F::Word;

    /// Fills pixels.
    #[doc(hidden)]
    fn paint<F: PixelFormat, Q: Quality, P: Pixels<F::Word, Q>>(recipe: &Recipe<'_>, pixels: P);
}

/// A [`Kind`] on which light may fall.
pub trait LitKind: Kind {
    /// What a material of this kind becomes in light.
    type Lit: LitKind;

    /// The colour that light is multiplied by.
    #[doc(hidden)]
    const BASE: Base;
}

/// A [`Kind`] of texels: those can be [cut out](crate::Material::cut_out).
pub trait TexelKind: Kind {
    /// The texel of the texture at whole coordinates, modulo its size.
    #[doc(hidden)]
    fn place(texture: &Texture<'_>, u: i32, v: i32) -> [i32; 2];
}

/// A [`Kind`] that does not need the vertices' colours, so that they can say [how opaque](crate::Material::vertex_alpha) it is.
pub trait ColorlessKind: Kind {}

/// A function that writes how opaque the pixels of a triangle are from (x, y) on.
#[doc(hidden)]
#[derive(Clone, Copy, Debug)]
pub struct Opacity(pub(super) cover::Opacity);

/// What light is multiplied by.
#[doc(hidden)]
#[derive(Clone, Copy, Debug)]
pub enum Base {
    /// What was there before: the vertices' colour, if nothing else.
    Same,
    /// The material's colour.
    Material,
    /// White: texels get the light later.
    White,
}

/// One colour.
#[derive(Clone, Copy, Debug)]
pub struct Flat;

/// Colours blended between vertices: their own, or light.
#[derive(Clone, Copy, Debug)]
pub struct Gouraud;

/// A texture that repeats.
#[derive(Clone, Copy, Debug)]
pub struct Textured;

/// A texture that repeats, in light.
#[derive(Clone, Copy, Debug)]
pub struct LitTextured;

pub(crate) mod sealed {
    pub trait Sealed {}
    impl Sealed for super::Flat {}
    impl Sealed for super::Gouraud {}
    impl Sealed for super::Textured {}
    impl Sealed for super::LitTextured {}
}

impl LitKind for Flat {
    type Lit = Gouraud;
    const BASE: Base = Base::Material;
}

impl Kind for Flat {
    const INPUTS: Inputs = Inputs::None;

    fn color<F: PixelFormat>(recipe: &Recipe<'_>, _: &Varying) -> F::Word {
        F::rgb565(recipe.color)
    }

    #[inline]
    fn paint<F: PixelFormat, Q: Quality, P: Pixels<F::Word, Q>>(recipe: &Recipe<'_>, pixels: P) {
        pixels.fill_evenly(F::rgb565(recipe.color));
    }
}

impl LitKind for Gouraud {
    type Lit = Self;
    const BASE: Base = Base::Same;
}

impl Kind for Gouraud {
    const INPUTS: Inputs = Inputs::Color;

    fn color<F: PixelFormat>(_: &Recipe<'_>, varying: &Varying) -> F::Word {
        color::<F>(channels_of(varying))
    }

    #[inline]
    fn paint<F: PixelFormat, Q: Quality, P: Pixels<F::Word, Q>>(_: &Recipe<'_>, pixels: P) {
        match (Q::EVERY_PIXEL, pixels.is_gray()) {
            (false, true) => pixels.fill(&Colors::<1, F, Gray>::NEW),
            (false, false) => pixels.fill(&Colors::<3, F, RedBlueGreen>::NEW),
            (true, true) => pixels.shade(|[gray]| color::<F>(whole([gray; 3]))),
            (true, false) => pixels.shade(|rgb: [i32; 3]| color::<F>(whole(rgb))),
        }
    }
}

impl LitKind for Textured {
    type Lit = LitTextured;
    const BASE: Base = Base::White;
}

impl Kind for Textured {
    const INPUTS: Inputs = Inputs::Uv;
    const IS_PACKED: bool = true;

    fn color<F: PixelFormat>(recipe: &Recipe<'_>, varying: &Varying) -> F::Word {
        let [u, v] = texel_of(varying);
        F::rgb565(recipe.texture.fetch_repeat(u, v))
    }

    #[inline]
    fn paint<F: PixelFormat, Q: Quality, P: Pixels<F::Word, Q>>(recipe: &Recipe<'_>, pixels: P) {
        let texture = &recipe.texture;
        if Q::EVERY_PIXEL {
            pixels.shade(|[u, v]| F::rgb565(texture.fetch_repeat(u >> 16, v >> 16)));
        } else {
            pixels.fill(&Texels::<F>::new(texture, recipe.scale_log2.into()));
        }
    }
}

impl LitKind for LitTextured {
    type Lit = Self;
    const BASE: Base = Base::Same;
}

impl Kind for LitTextured {
    const INPUTS: Inputs = Inputs::UvColor;
    const IS_PACKED: bool = true;

    fn color<F: PixelFormat>(recipe: &Recipe<'_>, varying: &Varying) -> F::Word {
        let [u, v] = texel_of(varying);
        lit::<F>(recipe.texture.fetch_repeat(u, v), channels_of(varying))
    }

    #[inline]
    fn paint<F: PixelFormat, Q: Quality, P: Pixels<F::Word, Q>>(recipe: &Recipe<'_>, pixels: P) {
        let (texture, scale_log2) = (&recipe.texture, recipe.scale_log2.into());
        match (Q::EVERY_PIXEL, pixels.is_gray()) {
            (false, true) => pixels.fill(&LitTexels::<1, F, Gray>::new(texture, scale_log2)),
            (false, false) => pixels.fill(&LitTexels::<3, F, RedBlueGreen>::new(texture, scale_log2)),
            (true, true) => pixels
                .shade(|[u, v, light]| lit::<F>(texture.fetch_repeat(u >> 16, v >> 16), whole([light; 3]))),
            (true, false) => pixels.shade(|[u, v, light @ ..]: [i32; 5]| {
                lit::<F>(texture.fetch_repeat(u >> 16, v >> 16), whole(light))
            }),
        }
    }
}

/// Channels of I16F16, 0 … 255.996, without their fractions.
#[inline]
pub(super) fn whole(channels: [i32; 3]) -> [u32; 3] {
    channels.map(|channel| channel as u32 >> 16)
}

pub(super) fn channels_of(varying: &Varying) -> [u32; 3] {
    whole(varying.color.map(|channel| channel.to_bits()))
}

/// The column and the row of a texel.
pub(super) fn texel_of(varying: &Varying) -> [i32; 2] {
    [varying.u, varying.v].map(|at| at.to_bits() >> 16)
}
