//! Assembly: the triangles of a mesh, one after the other, with their corners on the screen.
//!
//! - In: a mesh, and how its vertices get to the screen.
//! - Out: triangles that are not culled, oriented, lit, cut where a plane cuts them.
//! - Assumes: triangles before each other share vertices: a cache of nine keeps them.

use super::clip::Clip;
use super::coloring::{Coloring, dim};
use super::cut::MOST_CORNERS;
use super::orient::{Cull, Oriented, area, position};
use super::screen::ScreenVertex;
use super::stats::Count;
use super::transform::ToClip;
use crate::num::I16F16;
use crate::scene::{Mesh, Vertex};

/// How many screen vertices are kept, the oldest making room for the newest: neighbours in a mesh share most of theirs.
/// (Clipping borrows the memory for the corners of a polygon.)
const CACHED: usize = MOST_CORNERS;
const HINTS: usize = 64;
/// u of a vertex that has no attributes yet.
const MISSING: I16F16 = I16F16::MIN;

/// The vertices that were placed last. In this order, in which Armv6-M needs the fewest registers to reach them.
#[repr(C)]
pub(crate) struct VertexCache {
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

impl VertexCache {
    pub(crate) const ZERO: Self = Self {
        owners: [0; CACHED],
        newest: 0,
        pieces: 0,
        triangles: 0,
        hints: [0; HINTS],
        vertices: [ScreenVertex::ZERO; CACHED],
    };

    /// Nothing is found then: there is 0 in all slots but that to which the hint for 0 leads, and 1 in no other than that.
    pub(crate) fn forget(&mut self) {
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
pub(crate) struct Assembler<'a> {
    pub(crate) mesh: &'a Mesh<'a>,
    pub(crate) to_clip: &'a ToClip,
    pub(crate) clip: &'a Clip,
    pub(crate) coloring: &'a Coloring,
    pub(crate) cull: Cull,
    /// [`Assembler::light_face`] if there is something to do for it: a pointer, so that a program without lights has it not.
    pub(crate) light_face: Option<fn(&Self, &mut VertexCache, usize)>,
}

impl Assembler<'_> {
    /// The next triangle, or piece of one that was cut, that is not left out. Those that are, more than half of a closed mesh,
    /// get no further than this loop, and vertices that only they have need nothing but a position.
    #[inline(never)]
    pub(crate) fn next<'c>(
        &self,
        cache: &'c mut VertexCache,
        stats: &mut impl Count,
    ) -> Option<Oriented<'c>> {
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
    fn place(
        &self,
        [a, b, c]: [u16; 3],
        cache: &mut VertexCache,
        stats: &mut impl Count,
    ) -> Option<[usize; 3]> {
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
    fn place_vertex(&self, index: u16, used: u32, cache: &mut VertexCache, stats: &mut impl Count) -> usize {
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
    pub(crate) fn light_face(&self, cache: &mut VertexCache, cut: usize) {
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
    fn last(&self, cache: &VertexCache) -> [u16; 3] {
        self.mesh.triangle(cache.triangles - 1).unwrap_or_default()
    }

    fn corners(&self, cache: &VertexCache) -> [&Vertex; 3] {
        self.last(cache).map(|index| self.mesh.vertex(index))
    }

    /// Cuts the triangle last looked at, in the cache's memory.
    #[cold]
    #[inline(never)]
    fn cut(&self, cache: &mut VertexCache, stats: &mut impl Count) {
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
    fn find_piece(&self, cache: &mut VertexCache, stats: &mut impl Count) -> bool {
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
    fn piece<'c>(&self, cache: &'c VertexCache) -> Option<Oriented<'c>> {
        let [first, rest @ ..] = &cache.vertices;
        let [second, third, ..] = rest.get(usize::from(cache.pieces)..)? else { return None };
        Oriented::new([first, second, third], self.cull)
    }
}
