//! What can be drawn to: a band, at once, or a display list, for later.

use super::mesh::draw;
use super::sight::Sight;
use crate::frame::{Band, DepthFormat, PixelFormat};
use crate::geometry::Count;
use crate::math::Pose;
use crate::scene::Mesh;
use crate::shade::Surface;

/// What [`Camera::draw`](crate::Camera::draw) draws to: a [`Band`], at once, or a [`DisplayList`](super::DisplayList), for later.
///
/// A list keeps the mesh's vertices, a material's texture and mask, a fog's gradient or table, and shaders borrowed, for `'a`; a band
/// does not.
pub trait Canvas<'a>: sealed::Sealed {
    /// How its pixels are stored.
    type Format: PixelFormat;
    /// How its depths are.
    type Depth: DepthFormat;
    /// `()` of a band, where drawing cannot fail; a `Result` of a list.
    type Output;

    #[doc(hidden)]
    fn draw_mesh(
        &mut self,
        sight: &Sight<'_, 'a, Self::Format, Self::Depth>,
        mesh: &Mesh<'a>,
        pose: &Pose,
        surface: &Surface<'a, Self::Format, Self::Depth>,
        stats: &mut impl Count,
    ) -> Self::Output;
}

impl<'a, F: PixelFormat, D: DepthFormat> Canvas<'a> for Band<'_, F, D> {
    type Format = F;
    type Depth = D;
    type Output = ();

    #[inline]
    fn draw_mesh(
        &mut self,
        sight: &Sight<'_, 'a, F, D>,
        mesh: &Mesh<'a>,
        pose: &Pose,
        surface: &Surface<'a, F, D>,
        stats: &mut impl Count,
    ) {
        draw(mesh, sight, pose, surface, self, stats);
    }
}

pub(crate) mod sealed {
    pub trait Sealed {}
    impl<F: super::PixelFormat, D: super::DepthFormat> Sealed for super::Band<'_, F, D> {}
}
