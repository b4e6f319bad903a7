//! Compacting: after a mesh was recorded, the vertices that no triangle uses give their slots back.
//!
//! - In: the slots of a mesh's vertices, and its triangles.
//! - Out: the vertices that are kept side by side, with all their attributes, and after them the corners that were appended.
//! - Assumes: a vertex that is kept has [`KEPT`] in q, and its last attribute is not in use yet.

use super::entries::{CUT_OFF, KEPT, ListTriangle, ListVertex};
use crate::geometry::Inputs;
use crate::num::{I16F16, IS_ARMV6M, U1F31};
use crate::scene::Mesh;
use bytemuck::{must_cast, must_cast_slice_mut};
use core::hint::black_box;
use core::ops::Range;
use heapless::VecView;

/// Compacts the kept vertices of a mesh, whose slots are `own`, in the order of the mesh, of which the vertex `first` has the first slot.
/// They also get what is still missing: u and v, or the index of the mesh's vertex that has them. Then shifts the corners that were
/// appended after them. Returns whether all colours are grey.
#[inline(never)]
pub(super) fn move_together(
    vertices: &mut VecView<ListVertex>,
    triangles: &mut [ListTriangle],
    (mesh, first): (&Mesh<'_>, u16),
    inputs: Inputs,
    own: Range<usize>,
) -> bool {
    let mut all_gray = matches!(inputs, Inputs::Color | Inputs::UvColor);
    // Each is told where it goes, and triangles are.
    let mut end = own.start;
    for vertex in vertices.get_mut(own.clone()).unwrap_or_default() {
        if vertex.q & KEPT != U1F31::ZERO {
            vertex.attributes[3] = end as u16;
            end += 1;
        }
        // Not unrolled, which makes it faster on a Cortex-M4, and long.
        if IS_ARMV6M {
            black_box(());
        }
    }
    let freed = own.end - end;
    let up_to_own = vertices.get(..own.end).unwrap_or_default();
    for triangle in triangles {
        for corner in &mut triangle.corners {
            *corner = match up_to_own.get(usize::from(*corner)) {
                Some(vertex) => vertex.attributes[3],
                None => *corner - freed as u16,
            };
            if IS_ARMV6M {
                black_box(());
            }
        }
    }
    let up_to_own = vertices.get_mut(..own.end).unwrap_or_default();
    let mut index = first;
    for from in own.clone() {
        // As words, of which several are moved at a time.
        let slots: &mut [[u32; 4]] = must_cast_slice_mut(up_to_own);
        let Some(&words) = slots.get(from) else {
            break;
        };
        let vertex: ListVertex = must_cast(words);
        let to = usize::from(vertex.attributes[3]);
        if vertex.q & KEPT != U1F31::ZERO
            && let Some(slot) = slots.get_mut(to)
        {
            *slot = words;
            if let Some(place) = up_to_own.get_mut(to) {
                all_gray &= place.is_gray();
                place.q &= !KEPT;
                if inputs == Inputs::Uv {
                    place.attributes = ListVertex::attributes_of(mesh.vertex(index).uv.map(I16F16::from));
                } else {
                    place.attributes[3] = index;
                }
            }
        }
        // Behind the last of the largest mesh it is 0, and not asked for.
        index = index.wrapping_add(1);
    }
    if vertices.len() > own.end {
        all_gray &= move_down(vertices, own.end, freed);
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
