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
    let mut raster = Raster {
        shader,
        band,
        window,
        straight: if projection.orthographic { Straight::Always } else { S::Quality::STRAIGHT },
        setup: TriangleSetup::new(),
        rows: Rows::default(),
    };
    let (cull, is_faceted) = (shader.cull(), coloring.is_faceted());
    for indices in mesh.triangles() {
        stats.count(|stats| &mut stats.triangles);
        match placer.place(indices, &mut cache, stats) {
            Some(slots) if !is_faceted => raster.draw(cache.corners(slots), cull, stats),
            placed => placer.draw_specially(indices, placed, &mut cache, &mut raster, stats),
        }
    }
}

/// The vertices that were placed last.
struct Cache {
    vertices: [ScreenVertex; MOST_CORNERS],
    owners: [u32; CACHED],
    oldest: usize,
}

impl Cache {
    #[inline]
    fn corners(&self, slots: [usize; 3]) -> [&ScreenVertex; 3] {
        slots.map(|slot| &self.vertices[slot.min(MOST_CORNERS - 1)])
    }
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

    /// Draws a triangle that has to be cut, or to be given the light of its face: what that takes is on the stack only here.
    #[inline(never)]
    fn draw_specially<F, D, S>(
        &self,
        indices: [u16; 3],
        placed: Option<[usize; 3]>,
        cache: &mut Cache,
        raster: &mut Raster<'_, '_, F, D, S>,
        stats: &mut impl Count,
    ) where
        F: PixelFormat,
        D: DepthFormat,
        S: Shader<F>,
    {
        let cull = raster.shader.cull();
        let pieces = if placed.is_some() { 1 } else { self.cut(indices, cache, stats) };
        for piece in 0..pieces {
            let mut triangle = cache.corners(placed.unwrap_or([0, piece + 1, piece + 2]));
            let mut copies;
            if self.coloring.is_faceted() {
                copies = triangle.map(|vertex| *vertex);
                self.color_face(indices, cull, &mut copies);
                triangle = copies.each_ref();
            }
            raster.draw(triangle, cull, stats);
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
    let (setup, rows) = (TriangleSetup::new(), Rows::default());
    let mut raster = Raster { shader, band, window, straight: S::Quality::STRAIGHT, setup, rows };
    raster.draw(vertices.each_ref(), cull, &mut ());
    Ok(())
}

/// The stages from set-up on.
struct Raster<'a, 'b, F: PixelFormat, D: DepthFormat, S> {
    shader: &'a S,
    band: &'a mut Band<'b, F, D>,
    window: Window,
    straight: Straight,
    setup: TriangleSetup,
    rows: Rows,
}

impl<F, D, S> Raster<'_, '_, F, D, S>
where
    F: PixelFormat,
    D: DepthFormat,
    S: Shader<F>,
{
    #[inline]
    fn draw(&mut self, vertices: [&ScreenVertex; 3], cull: Cull, stats: &mut impl Count) {
        match Oriented::new(vertices, cull) {
            Some(triangle) => self.draw_oriented(&triangle, stats),
            None => stats.count(|stats| &mut stats.culled),
        }
    }

    #[inline(never)]
    fn draw_oriented(&mut self, triangle: &Oriented<'_>, stats: &mut impl Count) {
        if !self.window.touches(triangle) {
            return stats.count(|stats| &mut stats.out_of_sight);
        }
        stats.count(|stats| &mut stats.drawn);
        let needs = Needs {
            inputs: self.shader.inputs(),
            straight: self.straight,
            every_pixel: S::Quality::EVERY_PIXEL,
            texture_scale: self.shader.texture_scale().min(8),
            depth: !D::ALWAYS_PASSES,
        };
        self.setup.set(triangle, &needs);
        self.band.draw(&self.setup, &mut self.rows, &self.window, self.shader);
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
