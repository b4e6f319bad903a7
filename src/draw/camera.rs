//! What a camera does: it puts a point of the world on the screen, and draws a mesh to a canvas.
//!
//! - In: a mesh, its pose and a shader; or a point of the world.
//! - Out: what the canvas makes of the mesh; or the point's place on the screen.
//! - Assumes: nothing: any numbers are taken.

use super::canvas::Canvas;
use super::view::View;
use crate::frame::{Band, Depth16, DepthFormat, PixelFormat};
use crate::geometry::{Clip, MOST_CORNERS, ScreenVertex, Stats, ToClip, Upper};
use crate::math::{Pose, Vec3};
use crate::num::{I12F4, U1F31};
use crate::scene::{Camera, Lights, Mesh, Projection, Vertex};
use crate::shade::{Fog, Surface};

/// A point of the world on the screen, of [`Camera::project`]. [`interface`](crate::guide::interface) hangs labels on such points.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Projected {
    /// Pixels from the left edge; pixel centres are at +½.
    pub x: I12F4,
    /// Pixels from the top edge, down.
    pub y: I12F4,
    /// near/w (perspective) or 1 at the near and 0 at the far plane (orthographic), to compare with depth.
    pub q: U1F31,
}

impl Projected {
    /// Its depth as [`Depth16`] has it, to compare with [`Band::depth`]: near/w · 2¹⁶ rounded down, but at least 1.
    #[must_use]
    pub fn depth(&self) -> u16 {
        let mut depth = 0;
        Depth16::store(&mut depth, self.q);
        depth
    }

    /// Whether it would be seen in a band as a pixel: whether nothing that was drawn there is as near. `None` if it lies outside the
    /// band's rows or columns.
    #[must_use]
    pub fn is_visible_in<F: PixelFormat, D: DepthFormat>(&self, band: &Band<'_, F, D>) -> Option<bool> {
        let [x, y] = [self.x, self.y].map(|at| i32::from(at.to_bits()) >> 4);
        let window = band.window();
        if !window.columns.contains(&x) || !window.rows.contains(&y) {
            return None;
        }
        let index = (y - window.rows.start) as usize * usize::from(band.width) + x as usize;
        Some(D::ALWAYS_PASSES || D::test(band.depth.get(index)?, self.q))
    }
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

    /// What this camera sees in fog.
    #[must_use]
    pub const fn in_fog<'f>(&self, fog: &Fog<'f>) -> View<'_, Fog<'f>> {
        View::of(self).in_fog(fog)
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
    let (to_clip, unit_bits) = ToClip::new(projection, camera, &Pose::IDENTITY.at(point));
    let mut at = [ScreenVertex::default(); MOST_CORNERS];
    // Clipping places it if it is too near for 32 bits, and leaves nothing of it if it is cut off.
    let (clip, corner) = (Clip::new(projection, unit_bits), &Vertex::default());
    let (count, _) = clip.cut(&to_clip, [corner; 3], &mut at, &mut Upper::default());
    at.first().filter(|_| count > 0).copied()
}
