//! Compacting: after a mesh was recorded, the vertices that no triangle uses give their slots back.
//!
//! - In: the slots of a mesh's vertices, of which those that are kept say where they go, and its triangles.
//! - Out: the kept vertices side by side, with all their attributes, and after them the corners that were appended.
//! - Assumes: a kept vertex has [`KEPT`] in q and its final slot as its last attribute.

use super::entries::{CUT_OFF, KEPT, ListTriangle, ListVertex};
use crate::geometry::Inputs;
use crate::num::{I16F16, U1F31};
use crate::scene::Mesh;
use core::ops::Range;
use heapless::VecView;

/// Compacts the kept vertices of a mesh, whose slots are `own`, in the order in which they were kept: `next` is the slot after the
/// last of them, and the mesh's vertex `first` is that of the first slot. They also get what is still missing: u
/// and v, or the index of the mesh's vertex that has them. Then shifts the corners that were appended after them. Returns
/// whether all colours are grey.
#[inline(never)]
pub(super) fn move_together(
    vertices: &mut VecView<ListVertex>,
    triangles: &mut [ListTriangle],
    (mesh, first): (&Mesh<'_>, u16),
    inputs: Inputs,
    (own, next): (Range<usize>, u16),
) -> bool {
    let mut all_gray = matches!(inputs, Inputs::Color | Inputs::UvColor);
    for first_of_cycle in own.clone() {
        let Some(place) = vertices.get_mut(first_of_cycle) else {
            break;
        };
        if place.q & KEPT == U1F31::ZERO {
            continue;
        }
        let mut vertex = *place;
        place.q &= !KEPT;
        // A cycle: the vertex goes to its final slot, then the one that was there to its own. It ends at a slot whose vertex
        // was not kept or has been moved.
        let mut from = first_of_cycle;
        while vertex.q & KEPT != U1F31::ZERO {
            let to = usize::from(vertex.attributes[3]);
            all_gray &= vertex.is_gray();
            let index = first + (from - own.start) as u16;
            if inputs == Inputs::Uv {
                vertex.attributes = ListVertex::attributes_of(mesh.vertex(index).uv.map(I16F16::from));
            } else {
                vertex.attributes[3] = index;
            }
            vertex.q &= !KEPT;
            let Some(place) = vertices.get_mut(to) else {
                break;
            };
            vertex = core::mem::replace(place, vertex);
            from = to;
        }
    }
    let freed = own.end - usize::from(next);
    if vertices.len() > own.end {
        all_gray &= move_down(vertices, own.end, freed);
        for corner in triangles.iter_mut().flat_map(|t| &mut t.corners) {
            if usize::from(*corner) >= own.end {
                *corner -= freed as u16;
            }
        }
    }
    vertices.truncate(vertices.len() - freed);
    all_gray
}

/// Moves the vertices in the slots from `start` on down by `by` slots. Returns whether all their colours are grey.
#[cold]
#[inline(never)]
fn move_down(vertices: &mut VecView<ListVertex>, start: usize, by: usize) -> bool {
    let mut all_gray = true;
    for from in start..vertices.len() {
        let Some(&vertex) = vertices.get(from) else {
            break;
        };
        all_gray &= vertex.is_gray() || vertex.x == CUT_OFF;
        if let Some(place) = vertices.get_mut(from - by) {
            *place = vertex;
        }
    }
    all_gray
}
