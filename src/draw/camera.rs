//! What a camera does: it puts a point of the world on the screen, and draws a mesh to a canvas.
//!
//! - In: a mesh, its pose and a shader; or a point of the world.
//! - Out: what the canvas makes of the mesh; or the point's place on the screen.
//! - Assumes: nothing: any numbers are taken.

use super::canvas::Canvas;
use crate::geometry::{Clip, Coloring, MOST_CORNERS, ScreenVertex, Stats, ToClip};
use crate::math::{Pose, Vec3};
use crate::num::{I12F4, U1F31};
use crate::scene::{Camera, Mesh, Projection, Vertex};

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

    /// Draws a mesh, standing as `pose` says: into a band at once, or into a display list, which keeps mesh and shader
    /// borrowed and may be full.
    ///
    /// Triangles that cross the near plane or leave the guard band are clipped; those that turn
    /// away are culled as the shader says.
    ///
    /// A vertex is placed as the numbers of mesh, pose and camera say, rounded to 1/16 px. Before rounding it is off
    /// by at most 1/1024 px, and nearer than ¼ of a unit (of the mesh or of the world, whichever is longer) by ¼/w of
    /// that as much, but not by more than 1/128 px, up to the near plane: for focal lengths of up to 1024 pixels and
    /// scales of up to 100, at any distance from the world's origin. At the largest scale it may be 1/22 px there. So
    /// it is with the corners at which planes cut a triangle; and none that is seen is left out, at any scale. Where
    /// the scales of the mesh's axes differ, all vertices are placed as exactly as if all axes had the largest.
    ///
    /// `pose` may stretch, shear and [mirror](Pose::is_mirrored) the mesh. Fronts stay fronts, and light falls on the
    /// surface as it lies in the world: see [`Pose`].
    ///
    /// Whatever the numbers, it draws or leaves out, and never fails but for want of room in a list: coordinates at the ends of
    /// every format, vertices that coincide, scale 0, rotations that are none, everything behind the eye, a vertex in the eye,
    /// targets of 0 × 0 or 1 × 1 pixels, viewports beyond the target, far planes before near ones. What is
    /// left out is what [`Stats`] counts.
    pub fn draw<'a, S, C>(&self, mesh: &Mesh<'a>, pose: &Pose, shader: &'a S, canvas: &mut C) -> C::Output
    where
        C: Canvas<'a, S>,
    {
        canvas.draw_mesh(self, mesh, pose, shader, &mut ())
    }

    /// As [`Camera::draw`], and counts what became of the mesh.
    pub fn draw_counted<'a, S, C>(
        &self,
        mesh: &Mesh<'a>,
        pose: &Pose,
        shader: &'a S,
        canvas: &mut C,
        stats: &mut Stats,
    ) -> C::Output
    where
        C: Canvas<'a, S>,
    {
        canvas.draw_mesh(self, mesh, pose, shader, stats)
    }
}

/// A point of the world on the screen.
pub(crate) fn project(projection: &Projection, camera: &Pose, point: Vec3) -> Option<ScreenVertex> {
    let to_clip = ToClip::new(projection, camera, &Pose::IDENTITY.at(point));
    let mut at = [ScreenVertex::default(); MOST_CORNERS];
    // Clipping places it if it is too near for 32 bits, and leaves nothing of it if it is cut off.
    let (clip, corner) = (Clip::new(projection, to_clip.unit_bits()), &Vertex::default());
    let (count, _) = clip.cut(&to_clip, &Coloring::default(), [corner; 3], &mut at);
    at.first().filter(|_| count > 0).copied()
}
