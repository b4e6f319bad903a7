//! What a display list keeps: screen vertices and triangles.

use super::clip::ScreenVertex;
use super::color::is_gray;
use super::shade::Inputs;
use super::span::Window;
use crate::num::{I12F4, I16F16, U1F31, U8F8};
use crate::scene::Vertex;

/// A screen vertex in a list.
///
/// What is beyond position and q are the attributes that its shader reads: u and v; or a colour; or a colour and the vertex of
/// the mesh that has u and v. A corner that clipping made, with colour *and* texture, takes the slot behind it too, for u and v.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct ListVertex {
    pub(super) x: I12F4,
    pub(super) y: I12F4,
    /// While a mesh is recorded the top bit is [`KEPT`].
    pub(super) q: U1F31,
    pub(super) attributes: [u16; 4],
}

const _: () = assert!(size_of::<ListVertex>() == 16);

/// A triangle that is drawn has this vertex. (q is below 1.)
pub(super) const KEPT: U1F31 = U1F31::from_bits(1 << 31);
/// x of a vertex that has to be cut off, and of a slot that is none.
pub(super) const CUT_OFF: I12F4 = I12F4::MIN;
/// In the place of a mesh's vertex: u and v are in the next slot, if that is none for itself.
pub(super) const IN_NEXT: u16 = u16::MAX;
/// The most slots and triangles.
pub(crate) const MOST_SLOTS: usize = u16::MAX as usize;

/// A triangle in a list.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ListTriangle {
    /// Slots, of the corners clockwise on the screen, the nearest first. Of a polygon that is [folded](super::fan): the first
    /// corner's twice, and the last one's, between which all others stand.
    pub(super) corners: [u16; 3],
    /// The first and the last row that it touches, in [`ROWS_LOG2`].
    pub(crate) rows: [u8; 2],
}

const _: () = assert!(size_of::<ListTriangle>() == 8);

/// The index by rows has steps of 4 rows: 1023 fit a byte.
pub(crate) const ROWS_LOG2: u32 = 2;

impl ListTriangle {
    /// Whether it is a polygon that is [folded](super::fan).
    #[inline]
    pub(crate) fn is_folded(&self) -> bool {
        self.corners[0] == self.corners[1]
    }
}

impl ListVertex {
    pub(super) fn new(at: &ScreenVertex) -> Self {
        Self { x: at.x, y: at.y, q: at.q, attributes: [0; 4] }
    }

    /// u and v as attributes: for each its fraction and its whole texels.
    pub(super) fn attributes_of([u, v]: [I16F16; 2]) -> [u16; 4] {
        let [u, v] = [u, v].map(|t| t.to_bits() as u32);
        [u as u16, (u >> 16) as u16, v as u16, (v >> 16) as u16]
    }

    fn uv(&self) -> [I16F16; 2] {
        let [u, u_whole, v, v_whole] = self.attributes.map(u32::from);
        [u | u_whole << 16, v | v_whole << 16].map(|bits| I16F16::from_bits(bits as i32))
    }

    /// Of a vertex with colour.
    pub(super) fn is_gray(&self) -> bool {
        let [red, green, blue, _] = self.attributes;
        is_gray([red, green, blue])
    }

    pub(super) fn position(&self) -> [i32; 2] {
        [self.x, self.y].map(|at| at.to_bits().into())
    }
}

/// A list as far as it does not depend on the shader.
#[derive(Clone, Copy)]
pub(crate) struct ListView<'l> {
    pub(crate) vertices: &'l [ListVertex],
    pub(crate) triangles: &'l [ListTriangle],
}

impl ListView<'_> {
    /// A triangle's corners for set-up, as they went into the list; attributes not among the inputs are left as they are.
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

    /// Three times how near a triangle's middle is, in near/w with 29 fraction bits.
    pub(crate) fn nearness(&self, triangle: &ListTriangle) -> u32 {
        let q = |slot: u16| self.vertices.get(usize::from(slot)).map_or(0, |vertex| vertex.q.to_bits() >> 2);
        triangle.corners.iter().map(|&slot| q(slot)).sum()
    }

    /// The columns and rows of the pixel centres within a triangle's bounding box: the first, and the one behind the last.
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
