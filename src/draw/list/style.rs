//! What a surface wants of the vertices and triangles of a mesh that is recorded.

use crate::frame::{DepthFormat, PixelFormat};
use crate::geometry::{Cull, Inputs, VertexColors};
use crate::math::Pose;
use crate::scene::Lights;
use crate::shade::Surface;

/// What a surface wants of the vertices and triangles.
pub(crate) struct Style<'p> {
    pub(crate) cull: Cull,
    pub(crate) inputs: Inputs,
    pub(super) coloring: VertexColors<'p>,
}

impl<'p> Style<'p> {
    /// Not inlined, so that its stack frame is gone while a mesh is recorded.
    #[inline(never)]
    pub(crate) fn new<F: PixelFormat, D: DepthFormat>(
        surface: &Surface<'_, F, D>,
        camera: &Pose,
        pose: &'p Pose,
        lights: Option<&Lights<'_>>,
    ) -> Self {
        let cull = surface.cull.of_mesh(camera.is_mirrored() != pose.is_mirrored());
        let mut coloring = surface.coloring.unlit();
        surface.coloring.light(&mut coloring, lights, pose);
        Self { cull, inputs: surface.look.traits.inputs(), coloring }
    }

    pub(super) fn has_color(&self) -> bool {
        matches!(self.inputs, Inputs::Color | Inputs::UvColor)
    }
}
