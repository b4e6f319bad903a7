//! The stages in a row.

use super::clip::{Clip, MOST_CORNERS, ScreenVertex};
use super::color::Coloring;
use super::setup::{Cull, Needs, Oriented, TriangleSetup};
use super::shade::{Quality, Shader};
use super::span::{Rows, Window};
use super::stats::Count;
use super::straight::Straight;
use super::transform::ToClip;
use crate::math::{Pose, Vec3};
use crate::scene::{Mesh, Projection, Vertex};
use crate::target::{Band, DepthFormat, PixelFormat};
use core::fmt;

/// How many screen vertices are kept, the oldest making room for the newest: neighbours in a mesh share most of theirs.
/// (Clipping borrows the memory for the corners of a polygon.)
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
    let placer = Placer { mesh, to_clip: &to_clip, clip: &clip, coloring: &coloring };
    let mut cache =
        Cache { vertices: [ScreenVertex::default(); MOST_CORNERS], owners: [NOBODY; CACHED], oldest: 0 };
    let (mut setup, mut rows) = (TriangleSetup::new(), Rows::default());
    let straight = if projection.orthographic { Straight::Always } else { S::Quality::STRAIGHT };
    for indices in mesh.triangles() {
        stats.count(|stats| &mut stats.triangles);
        let placed = placer.place(indices, &mut cache, stats);
        let pieces = if placed.is_some() { 1 } else { placer.cut(indices, &mut cache, stats) };
        for piece in 0..pieces {
            let slots = placed.unwrap_or([0, piece + 1, piece + 2]);
            let mut triangle = slots.map(|slot| &cache.vertices[slot.min(MOST_CORNERS - 1)]);
            let mut copies;
            if coloring.is_faceted() {
                copies = triangle.map(|vertex| *vertex);
                placer.color_face(indices, shader.cull(), &mut copies);
                triangle = copies.each_ref();
            }
            draw_checked(triangle, shader.cull(), straight, shader, band, &window, &mut setup, &mut rows, stats);
        }
    }
}

/// The vertices that were placed last.
struct Cache {
    vertices: [ScreenVertex; MOST_CORNERS],
    owners: [u32; CACHED],
    oldest: usize,
}

/// The stages before set-up, for one mesh. Their temporaries are not on the stack while pixels are drawn: that is why its
/// functions are not inlined.
struct Placer<'a> {
    mesh: &'a Mesh<'a>,
    to_clip: &'a ToClip,
    clip: &'a Clip,
    coloring: &'a Coloring,
}

impl Placer<'_> {
    /// Where in the cache a triangle's vertices on the screen are, or are now; `None` if it has to be cut.
    #[inline(never)]
    fn place(&self, indices: [u16; 3], cache: &mut Cache, stats: &mut impl Count) -> Option<[usize; 3]> {
        let mut slots = [CACHED; 3];
        for (i, index) in indices.into_iter().enumerate() {
            let index = u32::from(index);
            slots[i] = match cache.owners.iter().position(|owner| *owner == index) {
                Some(slot) => slot,
                None => {
                    stats.count(|stats| &mut stats.transformed);
                    // The oldest, but none of this triangle's.
                    let mut slot = cache.oldest % CACHED;
                    while slots.contains(&slot) {
                        slot = (slot + 1) % CACHED;
                    }
                    cache.owners[slot] = NOBODY;
                    let vertex = self.mesh.vertex(index as u16);
                    if !self.clip.place(self.to_clip, self.coloring, vertex, &mut cache.vertices[slot]) {
                        return None;
                    }
                    cache.owners[slot] = index;
                    cache.oldest = slot + 1;
                    slot
                }
            };
        }
        Some(slots)
    }

    /// Cuts a triangle, in the cache's memory: how many pieces it has, as a fan around the first vertex.
    #[cold]
    #[inline(never)]
    fn cut(&self, indices: [u16; 3], cache: &mut Cache, stats: &mut impl Count) -> usize {
        stats.count(|stats| &mut stats.clipped);
        cache.owners = [NOBODY; CACHED];
        let corners = indices.map(|index| self.mesh.vertex(index));
        match self.clip.cut(self.to_clip, self.coloring, corners, &mut cache.vertices) {
            Some(corners) => corners.saturating_sub(2).min(MOST_CORNERS - 2),
            None => {
                stats.count(|stats| &mut stats.rejected);
                0
            }
        }
    }

    /// Gives a triangle that is not culled the light of its face.
    #[inline(never)]
    fn color_face(&self, indices: [u16; 3], cull: Cull, triangle: &mut [ScreenVertex; 3]) {
        if Oriented::new(triangle.each_ref(), cull).is_none() {
            return;
        }
        let corners = indices.map(|index| self.mesh.vertex(index));
        for vertex in triangle {
            vertex.color = self.coloring.on_triangle(vertex.color, corners);
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
    draw_checked(
        vertices.each_ref(),
        cull,
        S::Quality::STRAIGHT,
        shader,
        band,
        &window,
        &mut TriangleSetup::new(),
        &mut Rows::default(),
        &mut (),
    );
    Ok(())
}

#[inline(never)]
fn draw_checked<F, D, S>(
    vertices: [&ScreenVertex; 3],
    cull: Cull,
    straight: Straight,
    shader: &S,
    band: &mut Band<'_, F, D>,
    window: &Window,
    setup: &mut TriangleSetup,
    rows: &mut Rows,
    stats: &mut impl Count,
) where
    F: PixelFormat,
    D: DepthFormat,
    S: Shader<F>,
{
    let Some(triangle) = Oriented::new(vertices, cull) else {
        return stats.count(|stats| &mut stats.culled);
    };
    if !window.touches(&triangle) {
        return stats.count(|stats| &mut stats.out_of_sight);
    }
    stats.count(|stats| &mut stats.drawn);
    let (inputs, texture_scale) = (shader.inputs(), shader.texture_scale().min(8));
    setup.set(
        &triangle,
        &Needs {
            inputs,
            straight,
            every_pixel: S::Quality::EVERY_PIXEL,
            texture_scale,
            depth: !D::ALWAYS_PASSES,
        },
    );
    band.draw(setup, rows, window, shader);
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
