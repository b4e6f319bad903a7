//! The stages in a row.

use super::clip::{Clip, MOST_CORNERS, ScreenVertex};
use super::color::Coloring;
use super::setup::{Cull, Needs, Oriented, TriangleSetup, position};
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
const HINTS: usize = 64;

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
    let coloring = coloring::<F, S>(shader, pose);
    let placer = Placer { mesh, to_clip: &to_clip, clip: &clip, coloring: &coloring };
    let mut cache = Cache {
        vertices: [ScreenVertex::default(); MOST_CORNERS],
        owners: [NOBODY; CACHED],
        hints: [0; HINTS],
        oldest: 0,
    };
    let mut raster = Raster::new(shader, projection.orthographic, window, band);
    let (cull, is_faceted) = (shader.cull(), coloring.is_faceted());
    for indices in mesh.triangles() {
        stats.count(|stats| &mut stats.triangles);
        let placed = placer.place(indices, &mut cache, stats);
        match placed {
            Some(slots) if !is_faceted => raster.draw(cache.corners(slots), cull, stats),
            _ => {
                let pieces = if placed.is_some() { 1 } else { placer.cut(indices, &mut cache, stats) };
                placer.draw_pieces(indices, placed, pieces, &cache, &mut raster, stats);
            }
        }
    }
}

/// Not inlined: what it takes is not on the stack while pixels are drawn.
#[inline(never)]
fn coloring<F: PixelFormat, S: Shader<F>>(shader: &S, pose: &Pose) -> Coloring {
    shader.coloring(pose)
}

/// The vertices that were placed last.
struct Cache {
    vertices: [ScreenVertex; MOST_CORNERS],
    owners: [u32; CACHED],
    /// Where the last vertex with these lowest bits of its index is. (It may be there without a hint, and is placed again then.)
    hints: [u8; HINTS],
    oldest: usize,
}

impl Cache {
    #[inline]
    fn corners(&self, slots: [u8; 3]) -> [&ScreenVertex; 3] {
        slots.map(|slot| &self.vertices[usize::from(slot).min(MOST_CORNERS - 1)])
    }

    #[inline]
    fn hint(&self, index: u16) -> u8 {
        self.hints[usize::from(index) % HINTS]
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
    fn place(&self, indices: [u16; 3], cache: &mut Cache, stats: &mut impl Count) -> Option<[u8; 3]> {
        let mut slots = [CACHED as u8; 3];
        for i in 0..3 {
            let hint = cache.hint(indices[i]);
            slots[i] = if cache.owners[usize::from(hint) % CACHED] == u32::from(indices[i]) {
                hint
            } else {
                self.place_vertex(indices[i], slots, cache, stats)?
            };
        }
        Some(slots)
    }

    /// Puts a vertex in the place of the oldest, but none of this triangle's `slots`; `None` if it has to be cut off.
    #[inline(never)]
    fn place_vertex(
        &self,
        index: u16,
        slots: [u8; 3],
        cache: &mut Cache,
        stats: &mut impl Count,
    ) -> Option<u8> {
        let owner = u32::from(index);
        stats.count(|stats| &mut stats.transformed);
        let mut slot = cache.oldest % CACHED;
        while slots.contains(&(slot as u8)) {
            slot = (slot + 1) % CACHED;
        }
        cache.owners[slot] = NOBODY;
        let vertex = self.mesh.vertex(index);
        if !self.clip.place(self.to_clip, self.coloring, vertex, &mut cache.vertices[slot]) {
            return None;
        }
        cache.owners[slot] = owner;
        cache.hints[usize::from(index) % HINTS] = slot as u8;
        cache.oldest = slot + 1;
        Some(slot as u8)
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

    /// Draws the pieces of a triangle that was cut, or a triangle that has to be given the light of its face.
    #[inline(never)]
    fn draw_pieces<F, D, S>(
        &self,
        indices: [u16; 3],
        placed: Option<[u8; 3]>,
        pieces: usize,
        cache: &Cache,
        raster: &mut Raster<'_, '_, F, D, S>,
        stats: &mut impl Count,
    ) where
        F: PixelFormat,
        D: DepthFormat,
        S: Shader<F>,
    {
        for piece in 0..pieces as u8 {
            let piece = cache.corners(placed.unwrap_or([0, piece + 1, piece + 2]));
            if self.coloring.is_faceted() {
                self.draw_faceted(indices, piece, raster, stats);
            } else {
                raster.draw(piece, raster.shader.cull(), stats);
            }
        }
    }

    /// With the light of its face.
    #[inline(never)]
    fn draw_faceted<F, D, S>(
        &self,
        indices: [u16; 3],
        piece: [&ScreenVertex; 3],
        raster: &mut Raster<'_, '_, F, D, S>,
        stats: &mut impl Count,
    ) where
        F: PixelFormat,
        D: DepthFormat,
        S: Shader<F>,
    {
        let Some(oriented) = Oriented::new(piece, raster.shader.cull()) else {
            return stats.count(|stats| &mut stats.culled);
        };
        let mut colored = oriented.vertices.map(|vertex| *vertex);
        let corners = indices.map(|index| self.mesh.vertex(index));
        for vertex in &mut colored {
            vertex.color = self.coloring.on_triangle(vertex.color, corners);
        }
        raster.draw_oriented(&Oriented { vertices: colored.each_ref(), area: oriented.area }, stats);
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
    Raster::new(shader, false, window, band).draw(vertices.each_ref(), cull, &mut ());
    Ok(())
}

pub(super) fn needs<F: PixelFormat, D: DepthFormat, S: Shader<F>>(
    shader: &S,
    is_orthographic: bool,
) -> Needs {
    Needs {
        inputs: shader.inputs(),
        straight: if is_orthographic { Straight::Always } else { S::Quality::STRAIGHT },
        every_pixel: S::Quality::EVERY_PIXEL,
        texture_scale: shader.texture_scale().min(8),
        depth: !D::ALWAYS_PASSES,
    }
}

/// The stages from set-up on.
pub(crate) struct Raster<'a, 'b, F: PixelFormat, D: DepthFormat, S> {
    shader: &'a S,
    band: &'a mut Band<'b, F, D>,
    window: Window,
    needs: Needs,
    setup: TriangleSetup,
    rows: Rows,
}

impl<'a, 'b, F, D, S> Raster<'a, 'b, F, D, S>
where
    F: PixelFormat,
    D: DepthFormat,
    S: Shader<F>,
{
    pub(crate) fn new(
        shader: &'a S,
        is_orthographic: bool,
        window: Window,
        band: &'a mut Band<'b, F, D>,
    ) -> Self {
        let needs = needs::<F, D, S>(shader, is_orthographic);
        Self { shader, band, window, needs, setup: TriangleSetup::new(), rows: Rows::default() }
    }

    /// The same for another shader and window.
    pub(crate) fn change(&mut self, shader: &'a S, is_orthographic: bool, window: Window) {
        (self.shader, self.window) = (shader, window);
        self.needs = needs::<F, D, S>(shader, is_orthographic);
    }

    #[inline]
    pub(crate) fn draw(&mut self, vertices: [&ScreenVertex; 3], cull: Cull, stats: &mut impl Count) {
        match Oriented::new(vertices, cull) {
            Some(triangle) => self.draw_oriented(&triangle, stats),
            None => stats.count(|stats| &mut stats.culled),
        }
    }

    #[inline(never)]
    fn draw_oriented(&mut self, triangle: &Oriented<'_>, stats: &mut impl Count) {
        self.setup.corners = triangle.vertices.map(position);
        self.rows.start(&self.setup.corners, &self.window);
        if self.rows.are_none() {
            return stats.count(|stats| &mut stats.out_of_sight);
        }
        stats.count(|stats| &mut stats.drawn);
        self.setup.set(triangle, &self.needs, self.rows.are_simple());
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
