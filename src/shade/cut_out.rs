//! Kinds of material that are not there everywhere: cut-out textures, and those whose vertices say how opaque they are.
//!
//! - In: a material's recipe, and pixels.
//! - Out: the fill that these pixels get, or nothing where a texel is left out; how opaque vertices make pixels.
//! - Assumes: the triangle was set up for the kind's inputs.

use super::bordered::{Clamped, LitClamped, LitMirrored, Mirrored};
use super::channels::lit;
use super::fill::Each;
use super::kinds::sealed::Sealed;
use super::kinds::{
    Base, ColorlessKind, Flat, Kind, LitKind, LitTextured, Opacity, TexelKind, Textured, whole,
};
use super::perspective::Perspective;
use super::quality::Quality;
use super::recipe::Recipe;
use super::shader::{Pixels, Varying};
use crate::frame::PixelFormat;
use crate::geometry::Inputs;
use crate::raster::TriangleSetup;
use crate::scene::Texture;
use core::marker::PhantomData;

/// A texture with texels that are left out.
#[derive(Clone, Copy, Debug)]
pub struct CutOut<K>(PhantomData<K>);

/// How opaque it is, the vertices say.
#[derive(Clone, Copy, Debug)]
pub struct VertexAlpha<K>(PhantomData<K>);

impl<K> Sealed for CutOut<K> {}
impl<K> Sealed for VertexAlpha<K> {}

macro_rules! texel_kinds {
    ($($kind:ident: $lit:ident $place:expr),*) => {$(
        impl TexelKind for $kind {
            #[inline]
            fn place(texture: &Texture<'_>, u: i32, v: i32) -> [i32; 2] {
                $place(texture, u, v)
            }
        }

        impl LitKind for CutOut<$kind> {
            type Lit = CutOut<$lit>;
            const BASE: Base = <$kind as LitKind>::BASE;
        }
    )*};
}

texel_kinds!(
    Textured: LitTextured repeated,
    LitTextured: LitTextured repeated,
    Clamped: LitClamped Texture::clamped,
    LitClamped: LitClamped Texture::clamped,
    Mirrored: LitMirrored Texture::mirrored,
    LitMirrored: LitMirrored Texture::mirrored
);

/// As it is: what fetches texels repeats them.
fn repeated(_: &Texture<'_>, u: i32, v: i32) -> [i32; 2] {
    [u, v]
}

impl ColorlessKind for Flat {}
impl ColorlessKind for Textured {}
impl ColorlessKind for Clamped {}
impl ColorlessKind for Mirrored {}
impl ColorlessKind for CutOut<Textured> {}
impl ColorlessKind for CutOut<Clamped> {}
impl ColorlessKind for CutOut<Mirrored> {}

impl<K: TexelKind> CutOut<K> {
    /// The texel at coordinates of I16F16, if it is there.
    #[inline]
    fn texel(recipe: &Recipe<'_>, u: i32, v: i32) -> Option<u16> {
        let texture = &recipe.texture;
        let [u, v] = K::place(texture, u >> 16, v >> 16);
        let texel = texture.fetch_repeat(u, v);
        let is_there = match &recipe.mask {
            Some(mask) => mask.is_there(u, v),
            None => texel != recipe.color,
        };
        is_there.then_some(texel)
    }
}

/// Texel and mask are found at the same coordinates, so that a hole never shows its neighbour.
impl<K: TexelKind> Kind for CutOut<K> {
    const INPUTS: Inputs = K::INPUTS;

    fn color<F: PixelFormat>(recipe: &Recipe<'_>, varying: &Varying) -> F::Word {
        K::color::<F>(recipe, varying)
    }

    #[inline]
    fn paint<F: PixelFormat, Q: Quality, P: Pixels<F::Word, Q>>(recipe: &Recipe<'_>, pixels: P) {
        if matches!(K::INPUTS, Inputs::Uv) {
            pixels.shade_some(|[u, v]| Self::texel(recipe, u, v).map(F::rgb565));
        } else if pixels.is_gray() {
            pixels.shade_some(|[u, v, light]| {
                Self::texel(recipe, u, v).map(|texel| lit::<F>(texel, whole([light; 3])))
            });
        } else {
            pixels.shade_some(|[u, v, light @ ..]: [i32; 5]| {
                Self::texel(recipe, u, v).map(|texel| lit::<F>(texel, whole(light)))
            });
        }
    }
}

impl<K: ColorlessKind> Kind for VertexAlpha<K> {
    const INPUTS: Inputs = if matches!(K::INPUTS, Inputs::Uv) { Inputs::UvColor } else { Inputs::Color };
    const IS_PACKED: bool = K::IS_PACKED;

    fn opacity<Q: Quality>() -> Option<Opacity> {
        let is_textured = matches!(K::INPUTS, Inputs::Uv);
        Some(Opacity(if is_textured { opacity_after_uv::<Q> } else { opacity::<Q> }))
    }

    fn color<F: PixelFormat>(recipe: &Recipe<'_>, varying: &Varying) -> F::Word {
        K::color::<F>(recipe, varying)
    }

    #[inline]
    fn paint<F: PixelFormat, Q: Quality, P: Pixels<F::Word, Q>>(recipe: &Recipe<'_>, pixels: P) {
        K::paint::<F, Q, P>(recipe, pixels);
    }
}

fn opacity<Q: Quality>(setup: &TriangleSetup, [x, y]: [i32; 2], to: &mut [u8]) {
    let fill = Each::<1, Q, u8, _>::new(|[alpha]: [i32; 1]| level(alpha));
    Perspective::new(setup, &fill).draw(x, y, to, &fill);
}

fn opacity_after_uv<Q: Quality>(setup: &TriangleSetup, [x, y]: [i32; 2], to: &mut [u8]) {
    let fill = Each::<3, Q, u8, _>::new(|[_, _, alpha]: [i32; 3]| level(alpha));
    Perspective::new(setup, &fill).draw(x, y, to, &fill);
}

/// The nearest level of I16F16: corners that clipping makes of 255 may be a little less.
#[inline]
fn level(alpha: i32) -> u8 {
    ((alpha + (1 << 15)) >> 16).min(255) as u8
}
