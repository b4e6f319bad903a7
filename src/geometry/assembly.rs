//! Primitive assembly: the triangles of a mesh, one after another, with their corners on the screen.
//!
//! - In: a mesh, its transform to clip space and the planes that clip it there, its colouring and culling.
//! - Out: the triangles that are not culled, wound clockwise and lit. A triangle that is clipped comes out in pieces.
//! - Assumes: triangles that follow each other share vertices. A cache of nine keeps the last that were transformed.
//!
//! First those vertices of a triangle are transformed that the cache does not hold. Then the triangle may be culled. Only the
//! vertices of triangles that are left get attributes and light. So the cache may hold vertices without attributes. A
//! triangle that has to be clipped takes the cache's memory for its polygon, and the cache is empty afterwards.

use super::cut::{MOST_CORNERS, Upper};
use super::fan::piece;
use super::orient::{Cull, Oriented, area, position};
use super::screen::ScreenVertex;
use super::stats::{Count, Stats};
use super::vertex_colors::{VertexColors, dim};
use super::whole::Placing;
use crate::math::Pose;
use crate::num::I16F16;
use crate::scene::{Mesh, Projection, Triangles, Vertex};

/// How many vertices the cache holds, the newest taking the place of the oldest. As many as a clipped triangle may have corners,
/// since clipping makes its polygon in the cache's memory.
const CACHED: usize = MOST_CORNERS;
/// How many hints there are: a vertex's is that of its index modulo this.
const HINTS: usize = 64;
/// u of a vertex that has no attributes yet: beyond all there are. (A number that shares no part with others saves 4 cycles.)
const MISSING: I16F16 = I16F16::from_bits(0x7f00_0000);

/// The vertices of a mesh that were transformed last, and how far [`Assembler::next`] has come. The fields are in the order
/// in which Armv6-M reaches them with the fewest registers.
#[repr(C)]
pub(crate) struct VertexCache<'m> {
    /// The index, in the mesh, of the vertex in each slot.
    owners: [u16; CACHED],
    /// The slot that was filled last.
    newest: u8,
    pub(crate) clipped: Clipped,
    /// The piece of a clipped triangle that comes next, or the last that came.
    piece: u8,
    /// Whether it is still to come.
    has_piece: bool,
    /// The mesh's triangles that were not looked at yet.
    left: Triangles<'m>,
    /// For each index modulo [`HINTS`] the slot of the vertex that was placed last. A vertex whose hint another one took is not
    /// found: it is transformed again, and is then in the cache twice.
    hints: [u8; HINTS],
    vertices: [ScreenVertex; CACHED],
}

/// What is still to come of the triangle last looked at, if it has to be clipped.
#[derive(Clone, Copy, PartialEq)]
pub(crate) enum Clipped {
    /// It has not, or nothing is.
    None,
    /// All: it is still to be [cut](Assembler::cut).
    Uncut,
    /// A polygon of so many corners, in pieces.
    Pieces(u8),
    /// A polygon of so many corners, which is folded.
    Folded(u8),
}

// So that clipping finds room where the hints are.
const _: () = assert!(
    core::mem::offset_of!(VertexCache<'_>, hints).is_multiple_of(align_of::<Upper>())
        && size_of::<Upper>() <= HINTS
);

impl<'m> VertexCache<'m> {
    /// For a new mesh. Before use it has to [`forget`](Self::forget): here, vertex 0 counts as cached.
    #[inline]
    pub(crate) fn new(mesh: &Mesh<'m>) -> Self {
        Self {
            owners: [0; CACHED],
            newest: 0,
            clipped: Clipped::None,
            piece: 0,
            has_piece: false,
            left: mesh.indices(),
            hints: [0; HINTS],
            vertices: [ScreenVertex::ZERO; CACHED],
        }
    }

    /// Empties the cache. Slot 0 counts as vertex 1 then and all others as vertex 0, while the hints of these two lead to
    /// slots 0 and 1. So neither they nor any other vertex is found.
    pub(crate) fn forget(&mut self) {
        self.owners = [0; CACHED];
        self.owners[0] = 1;
        [self.hints[0], self.hints[1]] = [0, 1];
    }

    /// The polygon that is left of the triangle that was cut last.
    pub(crate) fn polygon(&self) -> &[ScreenVertex] {
        match self.clipped {
            Clipped::Pieces(corners) | Clipped::Folded(corners) => self.vertices.get(..corners.into()),
            _ => None,
        }
        .unwrap_or_default()
    }

    /// Lets a piece of it be the [next](Assembler::next) triangle.
    pub(crate) fn set_piece(&mut self, number: usize) {
        (self.piece, self.has_piece) = (number as u8, true);
    }

    /// The slot of a vertex, if it is found.
    #[inline(always)]
    fn find(&self, index: u16) -> Option<usize> {
        let slot = usize::from(self.hints[usize::from(index) % HINTS]);
        (self.owners.get(slot) == Some(&index)).then_some(slot)
    }

    /// Gives a vertex the oldest slot that is not in the bit set `used`.
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

/// `None` for [`CACHED`], which stands for no slot.
#[inline(always)]
fn in_cache(slot: usize) -> Option<usize> {
    (slot < CACHED).then_some(slot)
}

/// The type of [`light_face`].
pub(crate) type LightFace = fn(&Assembler<'_>, &mut VertexCache<'_>, usize);

/// The stages before set-up, for one mesh. Its functions are not inlined, so that their stack frames are gone while pixels are
/// drawn.
#[repr(C)]
pub(crate) struct Assembler<'a> {
    pub(crate) placing: Placing,
    pub(crate) mesh: &'a Mesh<'a>,
    /// [`light_face`] with flat shading, else `None`. A function pointer, so that the linker drops it from
    /// programs without lights.
    pub(crate) light_face: Option<LightFace>,
    pub(crate) cull: Cull,
    pub(crate) coloring: VertexColors<'a>,
}

impl Assembler<'_> {
    /// Makes one that is of no pose yet that of a mesh in this pose before a camera: where its vertices are placed, and which way it
    /// faces. False if nothing of the mesh may be seen.
    ///
    /// Not inlined: what it takes is not on the stack while pixels are drawn.
    #[inline(never)]
    pub(crate) fn stand(&mut self, projection: &Projection, camera: &Pose, pose: &Pose) -> bool {
        self.cull = self.cull.of_mesh(camera.is_mirrored() != pose.is_mirrored());
        self.placing.set(projection, camera, pose);
        self.placing.sees(projection, self.mesh.bounds())
    }

    /// The next triangle that is not culled; `None` at the end, or where [one is clipped](VertexCache::clipped). Of that, whoever asks
    /// says piece by piece what is [next](VertexCache::set_piece).
    ///
    /// By functions without type parameters, which are compiled with this crate, at its level of optimisation and not at that of the
    /// program.
    #[inline]
    pub(crate) fn next<'c>(
        &self,
        cache: &'c mut VertexCache<'_>,
        stats: &mut impl Count,
    ) -> Option<Oriented<'c>> {
        match stats.stats() {
            Some(stats) => self.next_counted(cache, stats),
            None => self.next_uncounted(cache),
        }
    }

    #[inline(never)]
    fn next_counted<'c>(&self, cache: &'c mut VertexCache<'_>, stats: &mut Stats) -> Option<Oriented<'c>> {
        self.find_next(cache, stats)
    }

    #[inline(never)]
    fn next_uncounted<'c>(&self, cache: &'c mut VertexCache<'_>) -> Option<Oriented<'c>> {
        self.find_next(cache, &mut ())
    }

    /// This loop is as far as culled triangles get, more than half of those of a closed mesh. A vertex that only culled triangles have is
    /// transformed, but never gets attributes.
    #[inline(always)]
    fn find_next<'c>(&self, cache: &'c mut VertexCache<'_>, stats: &mut impl Count) -> Option<Oriented<'c>> {
        if cache.clipped != Clipped::None {
            return self.piece(cache);
        }
        loop {
            let indices = cache.left.next()?;
            stats.count(|stats| &mut stats.triangles);
            let Some(slots) = self.place(indices, cache, stats) else {
                cache.clipped = Clipped::Uncut;
                return None;
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

    /// The slots of a triangle's vertices, whose attributes may be [`MISSING`]; `None` if the triangle has to be clipped.
    #[inline(always)]
    fn place(
        &self,
        [a, b, c]: [u16; 3],
        cache: &mut VertexCache<'_>,
        stats: &mut impl Count,
    ) -> Option<[usize; 3]> {
        // A vertex that is found needs no clip test: where one lies outside, the cache is emptied.
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

    /// Transforms a vertex into a slot that is not in the bit set `used`, and returns the slot; or [`CACHED`] if the vertex lies
    /// beyond a plane or outside the guard band. Then the triangle has to be clipped, and that has to empty the cache, in which
    /// the slot bears this vertex's index already.
    #[inline(never)]
    fn place_vertex(
        &self,
        index: u16,
        used: u32,
        cache: &mut VertexCache<'_>,
        stats: &mut impl Count,
    ) -> usize {
        stats.count(|stats| &mut stats.transformed);
        let slot = cache.give(index, used);
        let to = &mut cache.vertices[slot];
        to.u = MISSING;
        let vertex = self.mesh.vertex(index);
        if self.placing.place_bare(vertex, to) { slot } else { CACHED }
    }

    /// Gives a vertex its attributes.
    #[inline(never)]
    fn complete(&self, index: u16, to: &mut ScreenVertex) {
        to.set_attributes(self.mesh.vertex(index), &self.coloring);
    }

    /// The indices of the triangle last looked at.
    fn last(&self, cache: &VertexCache<'_>) -> [u16; 3] {
        self.mesh.triangle(self.mesh.triangle_count() - cache.left.len() - 1).unwrap_or_default()
    }

    /// Its vertices in the mesh.
    fn corners(&self, cache: &VertexCache<'_>) -> [&Vertex; 3] {
        self.last(cache).map(|index| self.mesh.vertex(index))
    }

    /// Clips the triangle last looked at, to a polygon in the cache's memory.
    #[cold]
    #[inline(never)]
    pub(crate) fn cut(&self, cache: &mut VertexCache<'_>, stats: &mut impl Count) {
        stats.count(|stats| &mut stats.clipped);
        cache.clipped = Clipped::None;
        for (index, to) in self.last(cache).into_iter().zip(&mut cache.vertices) {
            self.complete(index, to);
        }
        let corners = self.corners(cache);
        // The hints' memory is free meanwhile.
        let upper = cache.hints.get_mut(..size_of::<Upper>()).unwrap_or_default();
        let upper: Option<&mut Upper> =
            bytemuck::try_cast_slice_mut(upper).ok().and_then(|upper| upper.first_chunk_mut());
        let (count, is_folded) = match (self.placing.clipping(), upper) {
            (Some((to_clip, clip)), Some(upper)) => clip.cut(to_clip, corners, &mut cache.vertices, upper),
            _ => (0, false),
        };
        cache.forget();
        if let Some(light_face) = self.light_face {
            light_face(self, cache, count);
        }
        cache.piece = count.saturating_sub(2) as u8;
        cache.clipped = if is_folded { Clipped::Folded(count as u8) } else { Clipped::Pieces(count as u8) };
    }

    /// Goes on to the next piece of the clipped triangle that is not culled, from the last to the first: its polygon is a fan around the
    /// first vertex. Where there is none, the triangle is done.
    #[cold]
    #[inline(never)]
    pub(crate) fn find_piece(&self, cache: &mut VertexCache<'_>, stats: &mut impl Count) {
        while cache.piece > 0 {
            let number = cache.piece - 1;
            cache.set_piece(number.into());
            if self.piece(cache).is_some() {
                // It is still to come: that was to see whether it is culled.
                cache.has_piece = true;
                return;
            }
            stats.count(|stats| &mut stats.culled);
        }
        (cache.has_piece, cache.clipped) = (false, Clipped::None);
    }

    /// The piece of the clipped triangle that comes next, once.
    #[cold]
    #[inline(never)]
    fn piece<'c>(&self, cache: &'c mut VertexCache<'_>) -> Option<Oriented<'c>> {
        if !core::mem::take(&mut cache.has_piece) {
            return None;
        }
        Oriented::new(piece(cache.polygon(), cache.piece.into())?, self.cull)
    }
}

/// Multiplies the colours of the triangle last looked at by the light on its face. `polygon_corners` is 0 if it was not
/// clipped. Then its vertices in the cache get their attributes anew first, since they may have the light of another
/// triangle. If it was clipped, the corners of its polygon are the first so many vertices.
pub(super) fn light_face(assembler: &Assembler<'_>, cache: &mut VertexCache<'_>, polygon_corners: usize) {
    let indices = assembler.last(cache);
    let Some(light) = assembler.coloring.on_face(assembler.corners(cache)) else {
        return;
    };
    // The cache may hold a vertex twice: both are lit.
    for (i, (owner, vertex)) in cache.owners.iter().zip(&mut cache.vertices).enumerate() {
        if polygon_corners == 0 && indices.contains(owner) {
            vertex.set_attributes(assembler.mesh.vertex(*owner), &assembler.coloring);
            dim(&mut vertex.color, light);
        } else if i < polygon_corners {
            dim(&mut vertex.color, light);
        }
    }
}
