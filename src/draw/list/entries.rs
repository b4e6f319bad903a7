//! What a display list keeps: vertices of 16 bytes and triangles of 8.
//!
//! - In: the slots of a triangle's corners, and the mesh that they came from.
//! - Out: the corners as screen vertices, for set-up; a key to sort by; a bounding box.
//! - Assumes: the inputs are those of the shader that the triangle was recorded with.
//!
//! A *slot* is a place in a list's array of vertices. The attributes of a vertex depend on its shader's inputs:
//!
//! | inputs | attributes, four words of 16 bits |
//! |---|---|
//! | none | not used |
//! | u, v | fraction of u, whole texels of u, the same of v |
//! | colour | red, green, blue, not used |
//! | u, v, colour | red, green, blue, the index of the mesh's vertex that has u and v |
//!
//! Clipping and flat shading make corners that are no vertices of a mesh. With both colour and texture such a corner takes two
//! slots: [`IN_NEXT`] is in place of the index, and u and v are in the next slot, whose x is [`CUT_OFF`].

use crate::frame::Window;
use crate::geometry::{Inputs, ScreenVertex, is_gray};
use crate::num::{I12F4, I16F16, U1F31, U8F8};
use crate::scene::Vertex;

/// A screen vertex in a list: position, q and the attributes that its shader reads.
#[derive(Clone, Copy, Debug, Default, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
pub(crate) struct ListVertex {
    pub(crate) x: I12F4,
    pub(crate) y: I12F4,
    /// near/w. While a mesh is recorded the top bit is [`KEPT`].
    pub(crate) q: U1F31,
    /// While a mesh is recorded the last one, in a vertex that is kept, is the slot that it will have at the end.
    pub(crate) attributes: [u16; 4],
}

const _: () = assert!(size_of::<ListVertex>() == 16);

/// A flag in [`ListVertex::q`]: a recorded triangle has this vertex. (The bit is free, since q is below 1.)
pub(crate) const KEPT: U1F31 = U1F31::from_bits(1 << 31);
/// x of a slot without a position: while a mesh is recorded, of a vertex that has to be clipped; in a list, of a slot that
/// holds u and v of the slot before.
pub(crate) const CUT_OFF: I12F4 = I12F4::MIN;
/// In place of the index of a mesh's vertex: u and v are in the next slot, if x is [`CUT_OFF`] there. (If not, it is an index.)
pub(crate) const IN_NEXT: u16 = u16::MAX;
/// The most slots of a list, and its most triangles.
pub(crate) const MOST_SLOTS: usize = u16::MAX as usize;

/// A triangle in a list.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ListTriangle {
    /// The slots of the corners, clockwise on the screen.
    pub(crate) corners: [u16; 3],
    /// The first and the last row that it touches, in units of 4 rows (see [`ROWS_LOG2`]).
    pub(crate) rows: [u8; 2],
}

const _: () = assert!(size_of::<ListTriangle>() == 8);

/// Rows are kept in units of 2² = 4: those of the tallest screen, 0 … 1022, fit a byte.
pub(crate) const ROWS_LOG2: u32 = 2;

impl ListTriangle {
    /// Whether it is a polygon that is folded.
    #[inline]
    pub(crate) fn is_folded(&self) -> bool {
        self.corners[0] == self.corners[1]
    }
}

impl ListVertex {
    /// A vertex whose attributes are still to be set.
    pub(crate) fn new(at: &ScreenVertex) -> Self {
        Self { x: at.x, y: at.y, q: at.q, attributes: [0; 4] }
    }

    /// u and v as attributes: for each its fraction and its whole texels.
    pub(crate) fn attributes_of([u, v]: [I16F16; 2]) -> [u16; 4] {
        let [u, v] = [u, v].map(|t| t.to_bits() as u32);
        [u as u16, (u >> 16) as u16, v as u16, (v >> 16) as u16]
    }

    /// u and v from attributes: the reverse of [`ListVertex::attributes_of`].
    fn uv(&self) -> [I16F16; 2] {
        let [u, u_whole, v, v_whole] = self.attributes.map(u32::from);
        [u | u_whole << 16, v | v_whole << 16].map(|bits| I16F16::from_bits(bits as i32))
    }

    /// Whether red, green and blue are the same, in a vertex that has a colour.
    pub(crate) fn is_gray(&self) -> bool {
        let [red, green, blue, _] = self.attributes;
        is_gray([red, green, blue])
    }

    /// x and y in 1/16 px.
    pub(crate) fn position(&self) -> [i32; 2] {
        [self.x, self.y].map(|at| at.to_bits().into())
    }
}

/// The vertices and triangles of a list, which do not depend on the type of its shader.
#[derive(Clone, Copy)]
pub(crate) struct ListView<'l> {
    pub(crate) vertices: &'l [ListVertex],
    pub(crate) triangles: &'l [ListTriangle],
}

impl ListView<'_> {
    /// Writes a triangle's corners to `to`, for set-up: position, q and those attributes that are among the inputs. Any
    /// others are of no use.
    #[inline]
    pub(crate) fn corners(
        &self,
        triangle: &ListTriangle,
        inputs: Inputs,
        mesh: &[Vertex],
        to: &mut [ScreenVertex; 3],
    ) {
        for (to, slot) in to.iter_mut().zip(triangle.corners) {
            self.fetch(slot, inputs, mesh, to);
        }
    }

    /// Likewise, but the positions alone.
    #[inline]
    pub(crate) fn positions(&self, triangle: &ListTriangle, to: &mut [ScreenVertex; 3]) {
        for (to, slot) in to.iter_mut().zip(triangle.corners) {
            if let Some(at) = self.vertices.get(usize::from(slot)) {
                (to.x, to.y) = (at.x, at.y);
            }
        }
    }

    /// The corners of a polygon that is folded.
    #[cold]
    #[inline(never)]
    pub(crate) fn polygon<'p>(
        &self,
        folded: &ListTriangle,
        inputs: Inputs,
        mesh: &[Vertex],
        to: &'p mut [ScreenVertex],
    ) -> &'p [ScreenVertex] {
        let mut count = 0;
        for slot in self.slots(folded) {
            self.fetch_to(slot, inputs, mesh, to, count);
            count += 1;
        }
        to.get(..count).unwrap_or_default()
    }

    #[inline(never)]
    fn fetch_to(&self, slot: u16, inputs: Inputs, mesh: &[Vertex], to: &mut [ScreenVertex], i: usize) {
        if let Some(to) = to.get_mut(i) {
            self.fetch(slot, inputs, mesh, to);
        }
    }

    /// Slots of the corners of a polygon that is folded.
    fn slots(&self, folded: &ListTriangle) -> impl Iterator<Item = u16> {
        let [first, _, last] = folded.corners;
        let is_corner =
            |slot: &u16| self.vertices.get(usize::from(*slot)).is_some_and(|vertex| vertex.x != CUT_OFF);
        (first..=last).filter(is_corner)
    }

    /// Writes the vertex in a slot to `to`, as [`ListView::corners`].
    #[inline]
    fn fetch(&self, slot: u16, inputs: Inputs, mesh: &[Vertex], to: &mut ScreenVertex) {
        let Some(at) = self.vertices.get(usize::from(slot)) else {
            return;
        };
        (to.x, to.y, to.q) = (at.x, at.y, at.q);
        if inputs == Inputs::Uv {
            [to.u, to.v] = at.uv();
            return;
        }
        let [red, green, blue, of_mesh] = at.attributes;
        to.color = [red, green, blue].map(U8F8::from_bits);
        if inputs != Inputs::UvColor {
            return;
        }
        let next = || self.vertices.get(usize::from(slot) + 1).filter(|next| next.x == CUT_OFF);
        if of_mesh == IN_NEXT
            && let Some(next) = next()
        {
            [to.u, to.v] = next.uv();
        } else if let Some(of_mesh) = mesh.get(usize::from(of_mesh)) {
            [to.u, to.v] = of_mesh.uv.map(I16F16::from);
        }
    }

    /// The sum of near/w at a triangle's corners, with 29 fraction bits: three times that at its middle. Greater is nearer.
    pub(crate) fn nearness(&self, triangle: &ListTriangle) -> u32 {
        let q = |slot: u16| self.vertices.get(usize::from(slot)).map_or(0, |vertex| vertex.q.to_bits() >> 2);
        triangle.corners.iter().map(|&slot| q(slot)).sum()
    }

    /// The pixel centres within a triangle's bounding box: [start, end] of the columns and [start, end] of the rows, both ends
    /// exclusive.
    pub(crate) fn bounds(&self, triangle: &ListTriangle) -> [[i32; 2]; 2] {
        let at = |slot: u16| self.vertices.get(usize::from(slot)).map_or([0; 2], ListVertex::position);
        let [a, b, c] = triangle.corners.map(at);
        let centers = [0, 1].map(|axis| Window::centers(a[axis], b[axis], c[axis]));
        if !triangle.is_folded() {
            return centers;
        }
        self.slots(triangle).map(at).fold(centers, |all, at| {
            [0, 1].map(|axis| {
                let [start, end] = Window::centers(at[axis], at[axis], at[axis]);
                [all[axis][0].min(start), all[axis][1].max(end)]
            })
        })
    }
}
