//! What a camera can draw to: a band, at once, or a display list, for later.

use super::mesh::draw;
use crate::frame::{Band, DepthFormat, PixelFormat};
use crate::geometry::Count;
use crate::math::Pose;
use crate::scene::{Camera, Mesh};
use crate::shade::Shader;

/// What [`Camera::draw`] draws to: a [`Band`], at once, or a [`DisplayList`](super::DisplayList), for later.
///
/// A list keeps the shader and the mesh's vertices borrowed, for `'a`; a band does not.
pub trait Canvas<'a, S>: sealed::Sealed {
    /// `()` of a band, where drawing cannot fail; a `Result` of a list.
    type Output;

    #[doc(hidden)]
    fn draw_mesh(
        &mut self,
        camera: &Camera,
        mesh: &Mesh<'a>,
        pose: &Pose,
        shader: &'a S,
        stats: &mut impl Count,
    ) -> Self::Output;
}

impl<'a, F: PixelFormat, D: DepthFormat, S: Shader<F>> Canvas<'a, S> for Band<'_, F, D> {
    type Output = ();

    #[inline]
    fn draw_mesh(
        &mut self,
        camera: &Camera,
        mesh: &Mesh<'a>,
        pose: &Pose,
        shader: &'a S,
        stats: &mut impl Count,
    ) {
        draw(mesh, camera.projection(), camera.placement(), pose, shader, self, stats);
    }
}

pub(crate) mod sealed {
    pub trait Sealed {}
    impl<F: super::PixelFormat, D: super::DepthFormat> Sealed for super::Band<'_, F, D> {}
}
