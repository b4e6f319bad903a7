//! How a material is laid over what is there, known from its type.
//!
//! - In: a type.
//! - Out: the functions that lay colours over what is there.
//! - Assumes: nothing.
//!
//! A program names a way to blend where it makes a material transparent. So only the loops of these ways are linked.

use super::blended;
use super::cover::LayerCode;
use super::layered::draw_filled;
use crate::frame::{BlendFormat, DepthFormat, PixelFormat};
use core::hint::black_box;
use core::marker::PhantomData;
use sealed::Sealed;

/// How a [`Material`](crate::Material) is laid over what is there: [`Opaque`], [`Masked`], [`ScreenDoor`], [`Over`], [`Additive`] or
/// [`Multiply`].
pub trait Layer: Sealed + 'static {
    /// What it becomes with an alpha.
    type Alpha: Layer;
    /// What it becomes where pixels are left out, or depth is not used as usual.
    type Masked: Layer;
}

/// It hides what is behind it, and every pixel of it is drawn.
#[derive(Clone, Copy, Debug)]
pub struct Opaque;

/// It hides what is behind it, where it is drawn.
#[derive(Clone, Copy, Debug)]
pub struct Masked;

/// Pixels are left out in a pattern: the less opaque, the more.
#[derive(Clone, Copy, Debug)]
pub struct ScreenDoor;

/// Source over target: (s·a + t·(255 − a)) / 255.
#[derive(Clone, Copy, Debug)]
pub struct Over;

/// Light added: min(t + s·a / 255, m).
#[derive(Clone, Copy, Debug)]
pub struct Additive;

/// As through a coloured glass: t·s′ / m, with s′ = (s·a + m·(255 − a)) / 255.
#[derive(Clone, Copy, Debug)]
pub struct Multiply;

pub(crate) mod sealed {
    pub trait Sealed {}
    impl Sealed for super::Opaque {}
    impl Sealed for super::Masked {}
    impl Sealed for super::ScreenDoor {}
    impl Sealed for super::Over {}
    impl Sealed for super::Additive {}
    impl Sealed for super::Multiply {}
}

impl Layer for Opaque {
    type Alpha = Over;
    type Masked = Masked;
}

impl Layer for Masked {
    type Alpha = Over;
    type Masked = Self;
}

impl Layer for ScreenDoor {
    type Alpha = Self;
    type Masked = Self;
}

impl Layer for Over {
    type Alpha = Self;
    type Masked = Self;
}

impl Layer for Additive {
    type Alpha = Self;
    type Masked = Self;
}

impl Layer for Multiply {
    type Alpha = Self;
    type Masked = Self;
}

/// A [`Layer`] in a pixel format: those that blend need one that [can](BlendFormat).
pub trait LayerIn<F: PixelFormat>: Layer {
    #[doc(hidden)]
    fn code<D: DepthFormat>() -> Code<F, D>;
}

/// The functions of a layer, for the crate alone to look into.
#[doc(hidden)]
#[expect(missing_debug_implementations, reason = "it is passed on at once")]
pub struct Code<F: PixelFormat, D: DepthFormat>(pub(super) &'static LayerCode<F, D>);

/// The functions of all layers.
struct Codes<F, D>(PhantomData<(F, D)>);

impl<F: PixelFormat, D: DepthFormat> Codes<F, D> {
    const MASKED: LayerCode<F, D> = LayerCode { draw: Some(draw_filled), ..LayerCode::OPAQUE };
    const SCREEN_DOOR: LayerCode<F, D> = LayerCode { is_screen_door: true, ..Self::MASKED };
}

impl<F: BlendFormat, D: DepthFormat> Codes<F, D> {
    const OVER: LayerCode<F, D> = LayerCode {
        draw: Some(blended::draw),
        blend: Some(over::<F>),
        blend_evenly: Some(over_evenly::<F>),
        reads_target: true,
        ..LayerCode::OPAQUE
    };
    const ADDITIVE: LayerCode<F, D> = LayerCode {
        blend: Some(add::<F>),
        blend_evenly: Some(add_evenly::<F>),
        fades_to: Some(0),
        ..Self::OVER
    };
    const MULTIPLY: LayerCode<F, D> = LayerCode {
        blend: Some(multiply::<F>),
        blend_evenly: Some(multiply_evenly::<F>),
        fades_to: Some(0xffff),
        ..Self::OVER
    };
}

macro_rules! layers {
    ($($layer:ident: $format:ident $code:expr;)*) => {$(
        impl<F: $format> LayerIn<F> for $layer {
            #[inline]
            fn code<D: DepthFormat>() -> Code<F, D> {
                Code(&$code)
            }
        }
    )*};
}

layers! {
    Opaque: PixelFormat LayerCode::OPAQUE;
    Masked: PixelFormat Codes::MASKED;
    ScreenDoor: PixelFormat Codes::SCREEN_DOOR;
    Over: BlendFormat Codes::OVER;
    Additive: BlendFormat Codes::ADDITIVE;
    Multiply: BlendFormat Codes::MULTIPLY;
}

/// The colour of a glass that is less than whole: mixed with white.
#[inline(always)]
fn thinned<F: BlendFormat>(word: F::Word, alpha: u8) -> F::Word {
    if alpha == 255 { word } else { F::over(F::rgb565(0xffff), word, alpha) }
}

// `black_box` keeps loops from being unrolled: that takes 1 KiB, and gains nothing.
macro_rules! loops {
    ($($each:ident $evenly:ident $blend:expr;)*) => {$(
        fn $each<F: BlendFormat>(pixels: &mut [F::Word], words: &[F::Word], opacity: &[u8]) {
            for ((pixel, word), opacity) in pixels.iter_mut().zip(words).zip(opacity) {
                if *opacity != 0 {
                    *pixel = $blend(*pixel, *word, *opacity);
                }
                black_box(());
            }
        }

        fn $evenly<F: BlendFormat>(pixels: &mut [F::Word], words: &[F::Word], alpha: u8) {
            if alpha != 0 {
                for (pixel, word) in pixels.iter_mut().zip(words) {
                    *pixel = $blend(*pixel, *word, alpha);
                    black_box(());
                }
            }
        }
    )*};
}

loops! {
    over over_evenly F::over;
    add add_evenly F::add;
    multiply multiply_evenly |pixel, word, alpha| F::multiply(pixel, thinned::<F>(word, alpha));
}
