//! What happens to a triangle, in order:
//!
//! ```text
//!            transform         clip            setup            span      shade
//! Vertex[3] ──────────▶ ClipVertex ──▶ ScreenVertex ──▶ TriangleSetup ──▶ Span ──▶ pixel word
//! ```

mod clip;
mod setup;
mod shade;
mod span;
mod transform;

pub use clip::ScreenVertex;
pub use setup::Cull;
pub use shade::{Affine, Exact, Inputs, Quality, QuarterPixel, Shader, Varying};
pub use span::Span;

use crate::math::Pose;
use crate::scene::{Mesh, Projection};
use crate::target::{Band, DepthFormat, PixelFormat};
use clip::{Clip, Polygon};
use core::fmt;
use setup::Oriented;
pub(crate) use setup::TriangleSetup;
use transform::ToClip;

/// Draws a mesh in one pose before one camera, from vertex to pixel.
pub(crate) fn draw<F, D, S>(
    mesh: &Mesh<'_>,
    projection: &Projection,
    camera: &Pose,
    pose: &Pose,
    shader: &S,
    band: &mut Band<'_, F, D>,
) where
    F: PixelFormat,
    D: DepthFormat,
    S: Shader<F>,
{
    let to_clip = ToClip::new(projection, camera, pose);
    let clip = Clip::new(projection, to_clip.unit_bits());
    for corners in mesh.corners() {
        let mut polygon = Polygon::new();
        for vertex in corners {
            // There is room for eight.
            let _ = polygon.push(to_clip.transform(vertex));
        }
        clip.clip(&mut polygon, |triangle| draw_checked(triangle, shader.cull(), shader, band));
    }
}

/// Draws one triangle that is on the screen already: the door for callers with their own vertices.
///
/// Only the rows of `band` are drawn, and only what `cull` does not leave out.
///
/// # Errors
///
/// [`RangeError`] if a vertex lies outside the guard band or a texture coordinate beyond ±8192
/// texels; nothing is drawn then.
pub fn draw_triangle<F, D, S>(
    vertices: &[ScreenVertex; 3],
    cull: Cull,
    shader: &S,
    band: &mut Band<'_, F, D>,
) -> Result<(), RangeError>
where
    F: PixelFormat,
    D: DepthFormat,
    S: Shader<F>,
{
    if !vertices.iter().all(ScreenVertex::in_range) {
        return Err(RangeError);
    }
    draw_checked(vertices, cull, shader, band);
    Ok(())
}

#[inline(never)]
fn draw_checked<F, D, S>(vertices: &[ScreenVertex; 3], cull: Cull, shader: &S, band: &mut Band<'_, F, D>)
where
    F: PixelFormat,
    D: DepthFormat,
    S: Shader<F>,
{
    if let Some(triangle) = Oriented::new(vertices, cull) {
        let mut setup = TriangleSetup::new(&triangle);
        setup.set_planes(&triangle, shader.inputs(), S::Quality::PERSPECTIVE);
        band.draw(&setup, shader);
    }
}

/// A vertex lies outside the guard band, or its texture coordinates are out of range.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RangeError;

impl fmt::Display for RangeError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "a screen vertex lies outside -1024 to 1023 px or its texture coordinates outside ±8192 texels"
        )
    }
}

impl core::error::Error for RangeError {}
