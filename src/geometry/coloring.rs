//! The rule for the colours of a mesh's vertices: what a material or a shader says of them, before there is a mesh or a light.
//!
//! - In: a material's colour, and whether light falls on it.
//! - Out: the colours of the vertices during one draw, once a pose and the view's lights are known.
//! - Assumes: nothing.
//!
//! A rule refers to the functions that compute light. So only programs in which a rule is lit link them.

use super::assembly::{LightFace, light_face};
use super::vertex_colors::{FACETED, LightCode, SMOOTH, VertexColors};
use crate::math::Pose;
use crate::scene::Lights;

/// The functions of flat shading, by reference as those of smooth shading are.
#[derive(Clone, Copy, Debug)]
struct OnFaces {
    code: &'static LightCode,
    light_face: LightFace,
}

/// Where the colour of a mesh's vertices comes from, for a [`Shader`](crate::Shader) that reads colours. The default is the vertices'
/// own colour, unlit. [`Material`](crate::Material) has builders of the same names.
///
/// ```
/// use fixel::Coloring;
/// let brass = Coloring::of([200, 160, 60]).lit(); // red, green and blue, 0 … 255, times the light of the view
/// # let _ = brass;
/// ```
#[derive(Clone, Copy, Debug, Default)]
pub struct Coloring {
    /// Red, green and blue of all vertices; `None`: each has its own.
    base: Option<[u8; 3]>,
    light: Option<&'static LightCode>,
    /// In place of `light`, where there is any.
    on_faces: Option<&'static OnFaces>,
    two_sided: bool,
}

impl Coloring {
    /// The vertices' own colour, unlit.
    pub const OWN: Self = Self { base: None, light: None, on_faces: None, two_sided: false };

    /// One colour for all vertices, unlit.
    #[must_use]
    pub const fn of(color: [u8; 3]) -> Self {
        Self::OWN.with_base(color)
    }

    pub(crate) const fn with_base(self, color: [u8; 3]) -> Self {
        Self { base: Some(color), ..self }
    }

    /// The same times the light of the view: computed at each vertex, by its normal (smooth shading).
    #[must_use]
    pub const fn lit(self) -> Self {
        Self { light: Some(SMOOTH), ..self }
    }

    /// The same with light, where there is any, computed once a triangle (flat shading).
    #[must_use]
    pub const fn faceted(self) -> Self {
        Self { on_faces: Some(&OnFaces { code: FACETED, light_face }), ..self }
    }

    /// The same with light from behind a surface counting as light from in front does.
    #[must_use]
    pub const fn two_sided(self) -> Self {
        Self { two_sided: true, ..self }
    }

    /// The colours of a mesh without light.
    #[inline]
    pub(crate) fn unlit<'p>(&self) -> VertexColors<'p> {
        VertexColors::unlit(self.base)
    }

    /// Adds the light of a view on a mesh in this pose, if there is any. Without lights nothing is dark: colours are as they are unlit.
    ///
    /// Not inlined: what it takes is not on the stack while pixels are drawn.
    #[inline(never)]
    pub(crate) fn light<'p>(
        &self,
        colors: &mut VertexColors<'p>,
        lights: Option<&Lights<'_>>,
        pose: &'p Pose,
    ) {
        if let (Some(lights), Some(smooth)) = (lights, self.light) {
            let code = self.on_faces.map_or(smooth, |on_faces| on_faces.code);
            colors.light(code, lights, pose, self.two_sided);
        }
    }

    /// What lights a face in a view with lights, with flat shading.
    pub(crate) fn light_face(&self, lights: Option<&Lights<'_>>) -> Option<LightFace> {
        lights.and(self.light).and(self.on_faces).map(|on_faces| on_faces.light_face)
    }
}
