//! What a shader wants of the vertices and triangles of a mesh that is recorded.

use crate::frame::PixelFormat;
use crate::geometry::{Coloring, Cull, Inputs};
use crate::math::Pose;
use crate::shade::Shader;

/// What a shader wants of the vertices and triangles.
pub(crate) struct Style<'p> {
    pub(crate) cull: Cull,
    pub(crate) inputs: Inputs,
    pub(super) coloring: Coloring<'p>,
}

impl<'p> Style<'p> {
    /// Not inlined, so that its stack frame is gone while a mesh is recorded.
    #[inline(never)]
    pub(crate) fn new<F: PixelFormat, S: Shader<F>>(shader: &S, camera: &Pose, pose: &'p Pose) -> Self {
        let cull = shader.cull().of_mesh(camera.is_mirrored() != pose.is_mirrored());
        Self { cull, inputs: shader.inputs(), coloring: shader.coloring(pose) }
    }

    pub(super) fn has_color(&self) -> bool {
        matches!(self.inputs, Inputs::Color | Inputs::UvColor)
    }
}
