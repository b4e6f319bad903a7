//! Kinds of material whose texture is clamped or mirrored at its borders.
//!
//! - In: a material's recipe, and pixels.
//! - Out: the fill that these pixels get.
//! - Assumes: the triangle was set up for the kind's inputs.
//!
//! A triangle that shows none of what is beyond the borders, as most do, is drawn by the loops of textures that repeat.

use super::border::{Border, Clamp, Mirror};
use super::channels::{Gray, RedBlueGreen, lit};
use super::kinds::sealed::Sealed;
use super::kinds::{Base, Kind, LitKind, LitTextured, Textured, channels_of, texel_of, whole};
use super::pieces::{Bordered, LitBordered};
use super::quality::Quality;
use super::recipe::Recipe;
use super::shader::{Pixels, Varying};
use crate::frame::PixelFormat;
use crate::geometry::Inputs;

/// A texture whose border texels are seen beyond its borders.
#[derive(Clone, Copy, Debug)]
pub struct Clamped;

/// A texture whose border texels are seen beyond its borders, in light.
#[derive(Clone, Copy, Debug)]
pub struct LitClamped;

/// A texture that is turned round at each of its borders.
#[derive(Clone, Copy, Debug)]
pub struct Mirrored;

/// A texture that is turned round at each of its borders, in light.
#[derive(Clone, Copy, Debug)]
pub struct LitMirrored;

macro_rules! bordered_kinds {
    ($($kind:ident $lit:ident $border:ident),*) => {$(
        impl Sealed for $kind {}
        impl Sealed for $lit {}

        impl LitKind for $kind {
            type Lit = $lit;
            const BASE: Base = Base::White;
        }

        impl LitKind for $lit {
            type Lit = Self;
            const BASE: Base = Base::Same;
        }

        impl Kind for $kind {
            const INPUTS: Inputs = Inputs::Uv;
            const IS_PACKED: bool = true;

            fn color<F: PixelFormat>(recipe: &Recipe<'_>, varying: &Varying) -> F::Word {
                let [u, v] = texel_of(varying);
                F::rgb565($border::texel(&recipe.texture, u, v))
            }

            #[inline]
            fn paint<F: PixelFormat, Q: Quality, P: Pixels<F::Word, Q>>(recipe: &Recipe<'_>, pixels: P) {
                paint::<$border, F, Q, P>(recipe, pixels);
            }
        }

        impl Kind for $lit {
            const INPUTS: Inputs = Inputs::UvColor;
            const IS_PACKED: bool = true;

            fn color<F: PixelFormat>(recipe: &Recipe<'_>, varying: &Varying) -> F::Word {
                let [u, v] = texel_of(varying);
                lit::<F>($border::texel(&recipe.texture, u, v), channels_of(varying))
            }

            #[inline]
            fn paint<F: PixelFormat, Q: Quality, P: Pixels<F::Word, Q>>(recipe: &Recipe<'_>, pixels: P) {
                paint_lit::<$border, F, Q, P>(recipe, pixels);
            }
        }
    )*};
}

bordered_kinds!(Clamped LitClamped Clamp, Mirrored LitMirrored Mirror);

#[inline]
fn paint<B: Border, F: PixelFormat, Q: Quality, P: Pixels<F::Word, Q>>(recipe: &Recipe<'_>, pixels: P) {
    let texture = &recipe.texture;
    if is_repeated_alike::<F, Q, P>(recipe, &pixels) {
        return Textured::paint::<F, Q, P>(recipe, pixels);
    }
    let uv_bits = pixels.uv_bits();
    if !Q::EVERY_PIXEL && Bordered::<F, B>::fits(uv_bits) {
        pixels.fill_rows(&Bordered::<F, B>::new(texture, recipe.scale_log2.into(), uv_bits));
    } else {
        pixels.shade_rows(|[u, v]| F::rgb565(B::texel(texture, u >> 16, v >> 16)));
    }
}

#[inline]
fn paint_lit<B: Border, F: PixelFormat, Q: Quality, P: Pixels<F::Word, Q>>(recipe: &Recipe<'_>, pixels: P) {
    let texture = &recipe.texture;
    if is_repeated_alike::<F, Q, P>(recipe, &pixels) {
        return LitTextured::paint::<F, Q, P>(recipe, pixels);
    }
    let (uv_bits, scale_log2) = (pixels.uv_bits(), recipe.scale_log2.into());
    match (!Q::EVERY_PIXEL && Bordered::<F, B>::fits(uv_bits), pixels.is_gray()) {
        (true, true) => {
            pixels.fill_rows(&LitBordered::<1, F, B, Gray>::new(texture, scale_log2, uv_bits));
        }
        (true, false) => {
            pixels.fill_rows(&LitBordered::<3, F, B, RedBlueGreen>::new(texture, scale_log2, uv_bits));
        }
        (false, true) => pixels
            .shade_rows(|[u, v, light]| lit::<F>(B::texel(texture, u >> 16, v >> 16), whole([light; 3]))),
        (false, false) => pixels.shade_rows(|[u, v, light @ ..]: [i32; 5]| {
            lit::<F>(B::texel(texture, u >> 16, v >> 16), whole(light))
        }),
    }
}

/// Whether a triangle shows none of what is beyond the borders.
#[inline]
fn is_repeated_alike<F: PixelFormat, Q: Quality, P: Pixels<F::Word, Q>>(
    recipe: &Recipe<'_>,
    pixels: &P,
) -> bool {
    !Q::EVERY_PIXEL && recipe.scale_log2 == 0 && pixels.uv_are_inside(recipe.texture.log2())
}
