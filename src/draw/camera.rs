//! What a camera does: it puts a point of the world on the screen, and draws a mesh to a canvas.
//!
//! - In: a mesh, its pose and a shader; or a point of the world.
//! - Out: what the canvas makes of the mesh; or the point's place on the screen.
//! - Assumes: nothing: any numbers are taken.

use super::canvas::Canvas;
use super::view::View;
use crate::geometry::{Clip, MOST_CORNERS, ScreenVertex, Stats, ToClip, VertexColors};
use crate::math::{Pose, Vec3};
use crate::num::{I12F4, U1F31};
use crate::scene::{Camera, Lights, Mesh, Projection, Vertex};
use crate::shade::Surface;

/// A point of the world on the screen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Projected {
    /// Pixels from the left edge; pixel centres are at +½.
    pub x: I12F4,
    /// Pixels from the top edge, down.
    pub y: I12F4,
    /// near/w (perspective) or 1 at the near and 0 at the far plane (orthographic), to compare with depth.
    pub q: U1F31,
}

impl Camera {
    /// Where a point of the world is on the screen; `None` if it is not between the planes or not
    /// within ±1022¾ px, where clipping cuts.
    #[must_use]
    pub fn project(&self, point: Vec3) -> Option<Projected> {
        let at = project(self.projection(), self.placement(), point)?;
        Some(Projected { x: at.x, y: at.y, q: at.q })
    }

    /// What this camera sees in the light of these lights. They fall on what is [lit](crate::Material::lit).
    #[must_use]
    pub const fn lit_by<'v>(&'v self, lights: &'v Lights<'v>) -> View<'v> {
        View::of(self).lit_by(lights)
    }

    /// [`View::draw`] without lights.
    pub fn draw<'a, C: Canvas<'a>>(
        &self,
        mesh: &Mesh<'a>,
        pose: &Pose,
        surface: impl Into<Surface<'a, C::Format, C::Depth>>,
        canvas: &mut C,
    ) -> C::Output {
        View::of(self).draw(mesh, pose, surface, canvas)
    }

    /// As [`Camera::draw`], and counts what became of the mesh.
    pub fn draw_counted<'a, C: Canvas<'a>>(
        &self,
        mesh: &Mesh<'a>,
        pose: &Pose,
        surface: impl Into<Surface<'a, C::Format, C::Depth>>,
        canvas: &mut C,
        stats: &mut Stats,
    ) -> C::Output {
        View::of(self).draw_counted(mesh, pose, surface, canvas, stats)
    }
}

/// A point of the world on the screen.
pub(crate) fn project(projection: &Projection, camera: &Pose, point: Vec3) -> Option<ScreenVertex> {
    let to_clip = ToClip::new(projection, camera, &Pose::IDENTITY.at(point));
    let mut at = [ScreenVertex::default(); MOST_CORNERS];
    // Clipping places it if it is too near for 32 bits, and leaves nothing of it if it is cut off.
    let (clip, corner) = (Clip::new(projection, to_clip.unit_bits()), &Vertex::default());
    let (count, _) = clip.cut(&to_clip, &VertexColors::default(), [corner; 3], &mut at);
    at.first().filter(|_| count > 0).copied()
}
