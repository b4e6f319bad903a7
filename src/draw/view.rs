//! Views: a camera, the lights in which it sees, and fog.
//!
//! - In: a mesh, its pose and a surface.
//! - Out: what the canvas makes of the mesh.
//! - Assumes: nothing: any numbers are taken.

use super::canvas::Canvas;
use super::sight::Sight;
use crate::frame::{BlendFormat, DepthFormat, PixelFormat};
use crate::geometry::{Count, Stats};
use crate::math::Pose;
use crate::scene::{Camera, Lights, Mesh};
use crate::shade::{Fog, InFog, Surface};
use sealed::Sealed;

/// What a [`Camera`] sees in the light of some [`Lights`], and in [`Fog`] or in clear air.
///
/// ```
/// use fixel::embedded_graphics::{pixelcolor::Rgb565, prelude::*};
/// use fixel::{Fog, prelude::*};
/// # let camera = Camera::perspective(Turn::from_degrees(60), Size::new(64, 64));
/// let torch = [Light::point(Vec3::lit(0.0, 1.0, 2.0), [255, 180, 90], fixel::num::I16F16::lit("8"))];
/// let lights = Lights::new([20, 20, 30], &torch); // made in this frame, and gone with it
/// let mist = Fog::linear(Rgb565::CSS_GRAY, fixel::num::I16F16::lit("2"), fixel::num::I16F16::lit("12"));
/// let view = camera.lit_by(&lights).in_fog(&mist);
/// # let _ = view;
/// ```
#[derive(Clone, Copy, Debug)]
pub struct View<'v, A = Clear> {
    camera: &'v Camera,
    lights: Option<&'v Lights<'v>>,
    air: A,
}

/// Air without fog.
#[derive(Clone, Copy, Debug)]
pub struct Clear;

/// What lies between the eye and what it sees: [`Clear`] air, or [`Fog`] in a pixel format that [can blend](BlendFormat). Programs
/// without fog do not link it.
pub trait Air<'a, F: PixelFormat>: Sealed {
    #[doc(hidden)]
    fn fog<D: DepthFormat>(&self, camera: &Camera) -> Option<InFog<'a, F, D>>;
}

impl<'a, F: PixelFormat> Air<'a, F> for Clear {
    #[inline]
    fn fog<D: DepthFormat>(&self, _: &Camera) -> Option<InFog<'a, F, D>> {
        None
    }
}

impl<'a, F: BlendFormat> Air<'a, F> for Fog<'a> {
    fn fog<D: DepthFormat>(&self, camera: &Camera) -> Option<InFog<'a, F, D>> {
        Some(InFog::new(self, camera))
    }
}

mod sealed {
    pub trait Sealed {}
    impl Sealed for super::Clear {}
    impl Sealed for super::Fog<'_> {}
}

impl<'v> View<'v> {
    /// Without lights, in clear air.
    #[must_use]
    pub const fn of(camera: &'v Camera) -> Self {
        Self { camera, lights: None, air: Clear }
    }
}

impl<'v, A: Copy> View<'v, A> {
    /// The same in fog, in place of any before. A list keeps it by value, but for a gradient or a table that it has.
    #[must_use]
    pub const fn in_fog<'f>(self, fog: &Fog<'f>) -> View<'v, Fog<'f>> {
        View { camera: self.camera, lights: self.lights, air: *fog }
    }

    /// The same in the light of these lights, in place of any before. A list does not keep them.
    #[must_use]
    pub const fn lit_by(self, lights: &'v Lights<'v>) -> Self {
        Self { lights: Some(lights), ..self }
    }

    /// Draws a mesh, standing as `pose` says: into a band at once, or into a display list, which keeps what it needs of
    /// both and may be full.
    ///
    /// Triangles that cross the near plane or leave the guard band are clipped; those that turn
    /// away are culled as the surface says.
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
    pub fn draw<'a, C: Canvas<'a>>(
        &self,
        mesh: &Mesh<'a>,
        pose: &Pose,
        surface: impl Into<Surface<'a, C::Format, C::Depth>>,
        canvas: &mut C,
    ) -> C::Output
    where
        A: Air<'a, C::Format>,
    {
        self.draw_counted_by(mesh, pose, &surface.into(), canvas, &mut ())
    }

    /// As [`View::draw`], and counts what became of the mesh.
    pub fn draw_counted<'a, C: Canvas<'a>>(
        &self,
        mesh: &Mesh<'a>,
        pose: &Pose,
        surface: impl Into<Surface<'a, C::Format, C::Depth>>,
        canvas: &mut C,
        stats: &mut Stats,
    ) -> C::Output
    where
        A: Air<'a, C::Format>,
    {
        self.draw_counted_by(mesh, pose, &surface.into(), canvas, stats)
    }

    #[inline]
    fn draw_counted_by<'a, C: Canvas<'a>>(
        &self,
        mesh: &Mesh<'a>,
        pose: &Pose,
        surface: &Surface<'a, C::Format, C::Depth>,
        canvas: &mut C,
        stats: &mut impl Count,
    ) -> C::Output
    where
        A: Air<'a, C::Format>,
    {
        // By reference: clear air takes no stack.
        let fog = self.air.fog(self.camera);
        let sight = Sight { camera: self.camera, lights: self.lights, fog: fog.as_ref() };
        canvas.draw_mesh(&sight, mesh, pose, surface, stats)
    }
}
