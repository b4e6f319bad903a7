//! A cover: a triangle's set-up, and where it is drawn to: its rows, the memory of a band, and what is done with colours once they
//! are made.
//!
//! - In: a triangle that is set up, its rows, and the memory of a band.
//! - Out: these, for the loops that draw it.
//! - Assumes: the rows lie in the band.
//!
//! An opaque surface has no functions in its [layers](Layers). Those of others are named where a material is made
//! transparent, or a view foggy. So only programs that do that link them.

use super::fill::Fill;
use super::fog::Fogging;
use super::memory::Memory;
use crate::frame::{DepthFormat, PixelFormat};
use crate::raster::TriangleSetup;

/// A triangle, and where it is drawn to. Two references, which are passed in registers.
pub(crate) struct Cover<'a, 'b, F: PixelFormat, D: DepthFormat> {
    pub(crate) setup: &'a TriangleSetup,
    pub(crate) target: &'a mut Target<'b, F, D>,
}

/// Where triangles are drawn to, one after another, and what is done with their colours there.
pub(crate) struct Target<'a, F: PixelFormat, D: DepthFormat> {
    pub(crate) memory: Memory<'a, F::Word, D::Word>,
    pub(crate) layers: &'a Layers<F, D>,
    pub(crate) fog: Option<&'a InFog<'a, F, D>>,
}

/// What is done with the colours of a surface: they are laid over what the band holds by how opaque they are.
pub(crate) struct Layers<F: PixelFormat, D: DepthFormat> {
    pub(crate) code: &'static LayerCode<F, D>,
    /// Writes how opaque the vertices make the pixels from (x, y) on.
    pub(crate) opacity: Option<Opacity>,
    pub(crate) layering: Layering,
}

/// The fog of a view.
#[doc(hidden)]
#[expect(missing_debug_implementations, reason = "it is passed on at once, or kept in a list")]
pub struct InFog<'a, F: PixelFormat, D: DepthFormat> {
    pub(super) fogging: Fogging<'a, F>,
    /// Draws a triangle of an opaque surface.
    pub(super) draw_opaque: DrawFill<F, D>,
}

/// Whether they do the same.
impl<F: PixelFormat, D: DepthFormat> PartialEq for InFog<'_, F, D> {
    fn eq(&self, other: &Self) -> bool {
        self.fogging == other.fogging
    }
}

/// The functions that lay colours over what is there.
pub(crate) struct LayerCode<F: PixelFormat, D: DepthFormat> {
    /// Draws a triangle whose colours a fill makes. `None`: into the band at once, as opaque surfaces are.
    pub(crate) draw: Option<DrawFill<F, D>>,
    /// Lays colours over pixels, each as opaque as its byte says. `None`: they take the pixels' place where that is not 0.
    pub(crate) blend: Option<Blend<F>>,
    /// The same where all pixels are as opaque.
    pub(crate) blend_evenly: Option<BlendEvenly<F>>,
    /// The RGB565 number that colours fade to in fog, if it is not the fog's own: what changes nothing when it is blended.
    pub(crate) fades_to: Option<u16>,
    /// Whether pixels are left out in a pattern instead of being blended.
    pub(crate) is_screen_door: bool,
    /// Whether what the band holds shows through: such triangles are drawn last in a list.
    pub(crate) reads_target: bool,
}

/// A function that draws a triangle whose colours a fill makes.
pub(crate) type DrawFill<F, D> = fn(Cover<'_, '_, F, D>, &dyn Fill<<F as PixelFormat>::Word>);

/// A function that blends: pixels, what is laid over them, and how opaque that is.
pub(crate) type Blend<F> = fn(&mut [<F as PixelFormat>::Word], &[<F as PixelFormat>::Word], &[u8]);

/// A function that blends: pixels, what is laid over them, and how opaque all of that is.
pub(crate) type BlendEvenly<F> = fn(&mut [<F as PixelFormat>::Word], &[<F as PixelFormat>::Word], u8);

/// A function that writes how opaque the vertices of a triangle make pixels.
pub(crate) type Opacity = fn(&TriangleSetup, [i32; 2], &mut [u8]);

/// How a surface is laid over what is there, in numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Layering {
    /// How opaque all of it is.
    pub(crate) alpha: u8,
    /// Whether what is behind something is hidden.
    pub(crate) tests_depth: bool,
    /// Whether depth is written. `None`: unless it shows what is behind it.
    pub(crate) writes_depth: Option<bool>,
    /// How many steps of 16-bit depth it counts as nearer.
    pub(crate) depth_bias: i16,
}

impl Layering {
    pub(crate) const OPAQUE: Self = Self { alpha: 255, tests_depth: true, writes_depth: None, depth_bias: 0 };
}

impl<F: PixelFormat, D: DepthFormat> LayerCode<F, D> {
    /// Of an opaque surface.
    pub(crate) const OPAQUE: Self = Self {
        draw: None,
        blend: None,
        blend_evenly: None,
        fades_to: None,
        is_screen_door: false,
        reads_target: false,
    };

    /// Of a shader that shows what is behind it.
    pub(crate) const READS_TARGET: Self = Self { reads_target: true, ..Self::OPAQUE };

    /// Whether they do the same.
    fn is_like(&self, other: &Self) -> bool {
        are_one(self.blend, other.blend, |a, b| core::ptr::fn_addr_eq(a, b))
            && self.draw.is_some() == other.draw.is_some()
            && self.is_screen_door == other.is_screen_door
            && self.reads_target == other.reads_target
    }
}

impl<F: PixelFormat, D: DepthFormat> Layers<F, D> {
    /// Of an opaque surface.
    pub(crate) const OPAQUE: Self =
        Self { code: &LayerCode::OPAQUE, opacity: None, layering: Layering::OPAQUE };

    /// Whether depth is written.
    pub(crate) fn writes_depth(&self) -> bool {
        self.layering.writes_depth.unwrap_or(!self.code.reads_target)
    }

    /// Whether they do the same.
    pub(crate) fn is_like(&self, other: &Self) -> bool {
        are_one(self.opacity, other.opacity, |a, b| core::ptr::fn_addr_eq(a, b))
            && self.code.is_like(other.code)
            && self.layering == other.layering
    }
}

/// Whether there is neither of two functions, or both are one.
fn are_one<T>(a: Option<T>, b: Option<T>, are_one: impl Fn(T, T) -> bool) -> bool {
    match (a, b) {
        (Some(a), Some(b)) => are_one(a, b),
        (None, None) => true,
        _ => false,
    }
}

impl<F: PixelFormat, D: DepthFormat> Target<'_, F, D> {
    /// What draws a triangle whose colours a fill makes, if it is not drawn as opaque surfaces are.
    #[inline]
    pub(super) fn drawn_by(&self) -> Option<DrawFill<F, D>> {
        self.layers.code.draw.or(self.fog.map(|fog| fog.draw_opaque))
    }
}

macro_rules! by_value {
    ($($type:ty),*) => {$(
        impl<F: PixelFormat, D: DepthFormat> Clone for $type {
            fn clone(&self) -> Self {
                *self
            }
        }

        impl<F: PixelFormat, D: DepthFormat> Copy for $type {}
    )*};
}

by_value!(Layers<F, D>, InFog<'_, F, D>);
