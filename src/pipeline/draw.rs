//! The stages in a row.

use super::clip::{Clip, MOST_CORNERS, ScreenVertex};
use super::color::{Coloring, dim};
use super::setup::{Cull, Needs, Oriented, Packing, TriangleSetup, area, position};
use super::shade::{Quality, Shader};
use super::span::{Rows, Window};
use super::stats::Count;
use super::straight::Straight;
use super::transform::ToClip;
use crate::math::{Pose, Vec3};
use crate::num::I16F16;
use crate::scene::{Mesh, Projection, Vertex};
use crate::target::{Band, DepthFormat, PixelFormat};
use core::fmt;

/// How many screen vertices are kept, the oldest making room for the newest: neighbours in a mesh share most of theirs.
/// (Clipping borrows the memory for the corners of a polygon.)
const CACHED: usize = MOST_CORNERS;
const HINTS: usize = 64;
/// u of a vertex that has no attributes yet.
const MISSING: I16F16 = I16F16::MIN;

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
    let to_clip = ToClip::new(projection, camera, pose);
    let clip = Clip::new(projection, to_clip.unit_bits());
    let is_seen = clip.sees(&to_clip, mesh.bounds(), projection);
    let window = band.window().within(&projection.viewport);
    if window.is_empty() || !is_seen {
        stats.count(|stats| &mut stats.meshes_out_of_sight);
        return;
    }
    let lit;
    let coloring = if S::LIT {
        lit = coloring::<F, S>(shader, pose);
        &lit
    } else {
        &Coloring::OWN
    };
    let placer = Placer {
        mesh,
        to_clip: &to_clip,
        clip: &clip,
        coloring,
        cull: shader.cull(),
        light_face: if S::LIT && coloring.is_faceted() { Some(Placer::light_face) } else { None },
    };
    let mut raster = Raster::new(shader, [projection.orthographic, false], window, band);
    let mut cache = Cache::ZERO;
    cache.forget();
    while let Some(triangle) = placer.next(&mut cache, stats) {
        raster.draw_oriented(&triangle, stats);
    }
}

/// Not inlined: what it takes is not on the stack while pixels are drawn.
#[inline(never)]
fn coloring<F: PixelFormat, S: Shader<F>>(shader: &S, pose: &Pose) -> Coloring {
    shader.coloring(pose)
}

/// The vertices that were placed last. In this order, in which Armv6-M needs the fewest registers to reach them.
#[repr(C)]
struct Cache {
    owners: [u16; CACHED],
    newest: u8,
    /// How many pieces are to be drawn of the triangle that was cut last.
    pieces: u8,
    /// How many of the mesh's triangles were looked at.
    triangles: usize,
    /// Where the last vertex with these lowest bits of its index is. (It may be there without a hint, and is placed again then.)
    hints: [u8; HINTS],
    vertices: [ScreenVertex; CACHED],
}

impl Cache {
    const ZERO: Self = Self {
        owners: [0; CACHED],
        newest: 0,
        pieces: 0,
        triangles: 0,
        hints: [0; HINTS],
        vertices: [ScreenVertex::ZERO; CACHED],
    };

    /// Nothing is found then: there is 0 in all slots but that to which the hint for 0 leads, and 1 in no other than that.
    fn forget(&mut self) {
        self.owners = [0; CACHED];
        self.owners[0] = 1;
        [self.hints[0], self.hints[1]] = [0, 1];
    }

    /// The slot of a vertex.
    #[inline(always)]
    fn find(&self, index: u16) -> Option<usize> {
        let slot = usize::from(self.hints[usize::from(index) % HINTS]);
        (self.owners.get(slot) == Some(&index)).then_some(slot)
    }

    /// A vertex's slot from now on: the oldest that is not among `used` (bits).
    #[inline(always)]
    fn give(&mut self, index: u16, used: u32) -> usize {
        let after = |slot| if slot < CACHED - 1 { slot + 1 } else { 0 };
        let mut slot = after(usize::from(self.newest));
        while used >> slot & 1 != 0 {
            slot = after(slot);
        }
        self.newest = slot as u8;
        self.owners[slot] = index;
        self.hints[usize::from(index) % HINTS] = slot as u8;
        slot
    }
}

/// A slot that is one.
#[inline(always)]
fn in_cache(slot: usize) -> Option<usize> {
    (slot < CACHED).then_some(slot)
}

/// The stages before set-up, for one mesh. Their temporaries are not on the stack while pixels are drawn: that is why its
/// functions are not inlined.
struct Placer<'a> {
    mesh: &'a Mesh<'a>,
    to_clip: &'a ToClip,
    clip: &'a Clip,
    coloring: &'a Coloring,
    cull: Cull,
    /// [`Placer::light_face`] if there is something to do for it: a pointer, so that a program without lights has it not.
    light_face: Option<fn(&Self, &mut Cache, usize)>,
}

impl Placer<'_> {
    /// The next triangle, or piece of one that was cut, that is not left out. Those that are, more than half of a closed mesh,
    /// get no further than this loop, and vertices that only they have need nothing but a position.
    #[inline(never)]
    fn next<'c>(&self, cache: &'c mut Cache, stats: &mut impl Count) -> Option<Oriented<'c>> {
        if cache.pieces > 0 && self.find_piece(cache, stats) {
            return self.piece(cache);
        }
        loop {
            let indices = self.mesh.triangle(cache.triangles)?;
            cache.triangles += 1;
            stats.count(|stats| &mut stats.triangles);
            let Some(slots) = self.place(indices, cache, stats) else {
                self.cut(cache, stats);
                if self.find_piece(cache, stats) {
                    return self.piece(cache);
                }
                continue;
            };
            let area = area(slots.map(|slot| position(&cache.vertices[slot])));
            if self.cull.leaves_out(area) {
                stats.count(|stats| &mut stats.culled);
                continue;
            }
            for i in 0..3 {
                let vertex = &mut cache.vertices[slots[i]];
                if vertex.u == MISSING {
                    self.complete(indices[i], vertex);
                }
            }
            if let Some(light_face) = self.light_face {
                light_face(self, cache, 0);
            }
            return Some(Oriented::of_area(slots.map(|slot| &cache.vertices[slot]), area));
        }
    }

    /// Where in the cache a triangle's vertices are, their attributes perhaps [`MISSING`]; `None` if it has to be cut.
    #[inline(always)]
    fn place(&self, [a, b, c]: [u16; 3], cache: &mut Cache, stats: &mut impl Count) -> Option<[usize; 3]> {
        // Only a vertex that is placed anew is asked whether it has to be cut off.
        let a = match cache.find(a) {
            Some(slot) => slot,
            None => in_cache(self.place_vertex(a, 0, cache, stats))?,
        };
        let b = match cache.find(b) {
            Some(slot) => slot,
            None => in_cache(self.place_vertex(b, 1 << a, cache, stats))?,
        };
        let c = match cache.find(c) {
            Some(slot) => slot,
            None => in_cache(self.place_vertex(c, 1 << a | 1 << b, cache, stats))?,
        };
        Some([a, b, c])
    }

    /// Puts a vertex in a slot that is not among `used` (bits); no slot if it has to be cut off, and the triangle with it, which
    /// empties the cache.
    #[inline(never)]
    fn place_vertex(&self, index: u16, used: u32, cache: &mut Cache, stats: &mut impl Count) -> usize {
        stats.count(|stats| &mut stats.transformed);
        let slot = cache.give(index, used);
        let to = &mut cache.vertices[slot];
        to.u = MISSING;
        if self.clip.place_bare(self.to_clip, self.mesh.vertex(index), to) { slot } else { CACHED }
    }

    /// Gives a vertex its attributes.
    #[inline(never)]
    fn complete(&self, index: u16, to: &mut ScreenVertex) {
        to.set_attributes(self.mesh.vertex(index), self.coloring);
    }

    /// Gives the corners of the triangle last looked at its own colours, or those that it has after it was cut, if so many.
    fn light_face(&self, cache: &mut Cache, cut: usize) {
        let indices = self.last(cache);
        let Some(light) = self.coloring.on_face(self.corners(cache)) else {
            return;
        };
        // A vertex may be there twice.
        for (i, (owner, vertex)) in cache.owners.iter().zip(&mut cache.vertices).enumerate() {
            if cut == 0 && indices.contains(owner) {
                vertex.set_attributes(self.mesh.vertex(*owner), self.coloring);
                dim(&mut vertex.color, light);
            } else if i < cut {
                dim(&mut vertex.color, light);
            }
        }
    }

    /// The triangle last looked at.
    fn last(&self, cache: &Cache) -> [u16; 3] {
        self.mesh.triangle(cache.triangles - 1).unwrap_or_default()
    }

    fn corners(&self, cache: &Cache) -> [&Vertex; 3] {
        self.last(cache).map(|index| self.mesh.vertex(index))
    }

    /// Cuts the triangle last looked at, in the cache's memory.
    #[cold]
    #[inline(never)]
    fn cut(&self, cache: &mut Cache, stats: &mut impl Count) {
        stats.count(|stats| &mut stats.clipped);
        cache.forget();
        let corners = self.corners(cache);
        let Some(count) = self.clip.cut(self.to_clip, self.coloring, corners, &mut cache.vertices) else {
            return stats.count(|stats| &mut stats.rejected);
        };
        if let Some(light_face) = self.light_face {
            light_face(self, cache, count);
        }
        cache.pieces = count.saturating_sub(2) as u8;
    }

    /// Whether there is a piece left, of a triangle that was cut, that is not left out.
    #[cold]
    #[inline(never)]
    fn find_piece(&self, cache: &mut Cache, stats: &mut impl Count) -> bool {
        while cache.pieces > 0 {
            cache.pieces -= 1;
            if self.piece(cache).is_some() {
                return true;
            }
            stats.count(|stats| &mut stats.culled);
        }
        false
    }

    /// That piece, of a fan around the first vertex.
    #[cold]
    #[inline(never)]
    fn piece<'c>(&self, cache: &'c Cache) -> Option<Oriented<'c>> {
        let [first, rest @ ..] = &cache.vertices;
        let [second, third, ..] = rest.get(usize::from(cache.pieces)..)? else { return None };
        Oriented::new([first, second, third], self.cull)
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
    Raster::new(shader, [false; 2], window, band).draw(vertices.each_ref(), cull, &mut ());
    Ok(())
}

pub(super) fn needs<F: PixelFormat, D: DepthFormat, S: Shader<F>>(
    shader: &S,
    [is_orthographic, is_gray]: [bool; 2],
) -> Needs {
    let texture_scale = shader.texture_scale().min(8);
    let inputs = shader.inputs();
    Needs {
        inputs,
        straight: if is_orthographic { Straight::Always } else { S::Quality::STRAIGHT },
        every_pixel: S::Quality::EVERY_PIXEL,
        texture_scale,
        packing: Packing::new(shader.packed_log2(), texture_scale, inputs),
        depth: !D::ALWAYS_PASSES,
        gray: is_gray,
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
    /// For a camera that may be orthographic, and colours that may all be grey.
    ///
    /// Not inlined: it takes as much of the caller's stack as it returns, and no more.
    #[inline(never)]
    pub(crate) fn new(shader: &'a S, kind: [bool; 2], window: Window, band: &'a mut Band<'b, F, D>) -> Self {
        let (setup, rows) = (TriangleSetup::new(), Rows::default());
        Self { shader, band, window, needs: needs::<F, D, S>(shader, kind), setup, rows }
    }

    /// The same for another shader and window.
    pub(crate) fn change(&mut self, shader: &'a S, kind: [bool; 2], window: Window) {
        (self.shader, self.window) = (shader, window);
        self.needs = needs::<F, D, S>(shader, kind);
    }

    #[inline]
    pub(crate) fn draw(&mut self, vertices: [&ScreenVertex; 3], cull: Cull, stats: &mut impl Count) {
        match Oriented::new(vertices, cull) {
            Some(triangle) => self.draw_oriented(&triangle, stats),
            None => stats.count(|stats| &mut stats.culled),
        }
    }

    /// A triangle that is clockwise on the screen, its nearest vertex first.
    #[inline]
    pub(crate) fn draw_in_order(&mut self, vertices: [&ScreenVertex; 3]) {
        self.setup.corners = vertices.map(position);
        let area = area(self.setup.corners) as u32;
        self.draw_placed(&Oriented { vertices, area }, &mut ());
    }

    #[inline]
    fn draw_oriented(&mut self, triangle: &Oriented<'_>, stats: &mut impl Count) {
        self.setup.corners = triangle.vertices.map(position);
        self.draw_placed(triangle, stats);
    }

    /// A triangle whose corners are in the set-up.
    #[inline(never)]
    fn draw_placed(&mut self, triangle: &Oriented<'_>, stats: &mut impl Count) {
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
