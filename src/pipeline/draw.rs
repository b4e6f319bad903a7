//! The stages in a row.

use super::clip::{Clip, MOST_CORNERS, ScreenVertex};
use super::color::Coloring;
use super::setup::{Cull, Needs, Oriented, TriangleSetup};
use super::shade::{NO_PERSPECTIVE, Quality, Shader};
use super::span::Window;
use super::stats::Count;
use super::transform::ToClip;
use crate::math::{Pose, Vec3};
use crate::scene::{Mesh, Projection, Vertex};
use crate::target::{Band, DepthFormat, PixelFormat};
use core::fmt;

/// How many screen vertices are kept, by the low bits of their index: neighbours in a mesh share most of theirs.
const CACHED: usize = 8;
const NOBODY: u32 = u32::MAX;

/// Draws a mesh in one pose before one camera, from vertex to pixel.
pub(crate) fn draw<F, D, S>(
    mesh: &Mesh<'_>,
    projection: &Projection,
    camera: &Pose,
    pose: &Pose,
    shader: &S,
    band: &mut Band<'_, F, D>,
    stats: &mut impl Count,
) where
    F: PixelFormat,
    D: DepthFormat,
    S: Shader<F>,
{
    stats.count(|stats| &mut stats.meshes);
    let window = band.window().within(&projection.viewport);
    let to_clip = ToClip::new(projection, camera, pose);
    let clip = Clip::new(projection, to_clip.unit_bits());
    if window.is_empty() || !clip.sees(&to_clip, mesh.bounds(), projection) {
        stats.count(|stats| &mut stats.meshes_out_of_sight);
        return;
    }
    let coloring = shader.coloring(pose);
    // The vertex cache, and whose each vertex is. Clipping borrows its memory for the corners of a polygon.
    let mut cache = [ScreenVertex::default(); MOST_CORNERS];
    let mut owners = [NOBODY; CACHED];
    let straight = if projection.orthographic { NO_PERSPECTIVE } else { S::Quality::STRAIGHT };
    for indices in mesh.triangles() {
        stats.count(|stats| &mut stats.triangles);
        let mut triangle = [ScreenVertex::default(); 3];
        let mut inside = true;
        for corner in 0..3 {
            let index = indices[corner];
            let slot = usize::from(index) % CACHED;
            if owners[slot] != u32::from(index) {
                stats.count(|stats| &mut stats.transformed);
                owners[slot] = u32::from(index);
                if !clip.place(&to_clip, &coloring, mesh.vertex(index), &mut cache[slot]) {
                    owners[slot] = NOBODY;
                    inside = false;
                    break;
                }
            }
            triangle[corner] = cache[slot];
        }
        let pieces = if inside {
            1
        } else {
            stats.count(|stats| &mut stats.clipped);
            owners = [NOBODY; CACHED];
            let corners = indices.map(|index| mesh.vertex(index));
            let Some(corners) = clip.cut(&to_clip, &coloring, corners, &mut cache) else {
                stats.count(|stats| &mut stats.rejected);
                continue;
            };
            corners.saturating_sub(2)
        };
        for piece in 0..pieces.min(MOST_CORNERS - 2) {
            if !inside {
                triangle = [cache[0], cache[piece + 1], cache[piece + 2]];
            }
            if coloring.is_faceted() && Oriented::new(&triangle, shader.cull()).is_some() {
                let corners = indices.map(|index| mesh.vertex(index));
                for vertex in &mut triangle {
                    vertex.color = coloring.on_triangle(vertex.color, corners);
                }
            }
            if let Some(triangle) = Oriented::new(&triangle, shader.cull()) {
                if window.touches(&triangle) {
                    stats.count(|stats| &mut stats.drawn);
                    draw_oriented(&triangle, straight, shader, band, &window);
                } else {
                    stats.count(|stats| &mut stats.out_of_sight);
                }
            } else {
                stats.count(|stats| &mut stats.culled);
            }
        }
    }
}

/// A point of the world on the screen.
pub(crate) fn project(projection: &Projection, camera: &Pose, point: Vec3) -> Option<ScreenVertex> {
    let to_clip = ToClip::new(projection, camera, &Pose::IDENTITY.at(point));
    let mut at = ScreenVertex::default();
    Clip::new(projection, to_clip.unit_bits())
        .place(&to_clip, &Coloring::default(), &Vertex::default(), &mut at)
        .then_some(at)
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
    let window = band.window();
    if let Some(triangle) = Oriented::new(vertices, cull) {
        draw_oriented(&triangle, S::Quality::STRAIGHT, shader, band, &window);
    }
    Ok(())
}

#[inline(never)]
fn draw_oriented<F, D, S>(
    triangle: &Oriented<'_>,
    straight: (u32, u32),
    shader: &S,
    band: &mut Band<'_, F, D>,
    window: &Window,
) where
    F: PixelFormat,
    D: DepthFormat,
    S: Shader<F>,
{
    let mut setup = TriangleSetup::new(triangle);
    let (inputs, texture_scale) = (shader.inputs(), shader.texture_scale().min(8));
    setup.set_planes(triangle, &Needs { inputs, straight, texture_scale, depth: !D::ALWAYS_PASSES });
    band.draw(&setup, window, shader);
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
