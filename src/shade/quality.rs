//! The qualities: how exactly perspective is followed.

use crate::raster::Straight;

/// How exactly perspective is followed between the pixels of a span: [`Exact`], [`QuarterPixel`]
/// or [`Affine`].
///
/// The error is measured in pixels on the screen: the error of an attribute, divided by
/// its largest change over one pixel step (at least 1 texel or 1/255).
pub trait Quality: sealed::Sealed + Send + Sync + 'static {
    /// Which triangles' attributes count as linear on the screen.
    #[doc(hidden)]
    const STRAIGHT: Straight;
    /// Whether perspective is exact at every pixel.
    #[doc(hidden)]
    const EVERY_PIXEL: bool;
}

/// One step of Newton's iteration at every pixel: an error of at most 0.02 pixel.
#[derive(Clone, Copy, Debug)]
pub struct Exact;

/// A reciprocal from a table, at every pixel or as far apart as an error of ¼ pixel allows: the default.
#[derive(Clone, Copy, Debug)]
pub struct QuarterPixel;

/// No division: attributes are linear on the screen, and textures swim. The error is unbounded.
#[derive(Clone, Copy, Debug)]
pub struct Affine;

impl Quality for Exact {
    const STRAIGHT: Straight = Straight::below((1 << 16) / 32);
    const EVERY_PIXEL: bool = true;
}

impl Quality for QuarterPixel {
    const STRAIGHT: Straight = Straight::below((1 << 16) / 4 * 3);
    const EVERY_PIXEL: bool = false;
}

impl Quality for Affine {
    const STRAIGHT: Straight = Straight::Always;
    const EVERY_PIXEL: bool = false;
}

pub(crate) mod sealed {
    pub trait Sealed {}
    impl Sealed for super::Exact {}
    impl Sealed for super::QuarterPixel {}
    impl Sealed for super::Affine {}
}
