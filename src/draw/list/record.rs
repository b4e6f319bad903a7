//! Recording: one mesh is transformed, culled, clipped and lit, and appended to a display list.
//!
//! - In: a mesh, its pose, a camera's pose and projection.
//! - Out: list vertices and list triangles: those that are neither culled nor outside the viewport.
//! - Assumes: after an error the caller truncates the list to the lengths that it had.
//!
//! It does for a list what assembly does for a band that is drawn at once, but without a cache. First the mesh's vertices are
//! transformed, each into a *slot*, a place in the list's array of vertices. Those that turn out to be used are kept and lit.
//! After the last triangle the slots of the others are freed.

use super::capacity::CapacityError;
use super::compact::move_together;
use super::entries::{CUT_OFF, IN_NEXT, KEPT, ListTriangle, ListVertex, MOST_SLOTS, ROWS_LOG2};
use super::style::Style;
use crate::frame::Window;
use crate::geometry::{
    Count, Inputs, MOST_CORNERS, Placing, ScreenVertex, Stats, Upper, area, clockwise, dim, set_attributes,
};
use crate::math::Pose;
use crate::num::{I16F16, U1F31, U8F8};
use crate::raster::rows_of_folded;
use crate::scene::{Mesh, Projection, Vertex};
use core::hint::black_box;
use heapless::VecView;

/// Adds one mesh to a list.
///
/// At first every vertex of the mesh has a slot. So each is transformed once, and found by adding `to_slot` to its index. At
/// the end the slots of vertices that no recorded triangle uses are freed, and the others are compacted.
struct Recorder<'l, 'm> {
    vertices: &'l mut VecView<ListVertex>,
    triangles: &'l mut VecView<ListTriangle>,
    mesh: &'l Mesh<'m>,
    placing: Placing,
    style: &'l Style<'l>,
    window: Window,
    /// What is added to a vertex's index, wrapping, to get its slot.
    to_slot: usize,
    /// The slots of the mesh's vertices. After them come corners that clipping or flat shading makes.
    own: core::ops::Range<usize>,
    /// Whether any vertex has to be clipped: see [`CUT_OFF`].
    is_any_cut_off: bool,
    /// How many vertices and triangles found no room. They are counted to the end, so that the error can say what was
    /// needed.
    missing: [usize; 2],
}

/// Appends what is in view of a mesh to a list, whose lengths the caller restores after an error. Returns whether all colours
/// that it recorded are grey: false in a style without colours, but true of a mesh that is out of view as a whole.
pub(crate) fn record(
    vertices: &mut VecView<ListVertex>,
    triangles: &mut VecView<ListTriangle>,
    mesh: &Mesh<'_>,
    [camera, pose]: [&Pose; 2],
    projection: &Projection,
    style: &Style<'_>,
    stats: &mut impl Count,
) -> Result<bool, CapacityError> {
    stats.count(|stats| &mut stats.meshes);
    let window = Window::LARGEST.within(&projection.viewport);
    let mut placing = Placing::ZERO;
    placing.set(projection, camera, pose);
    if window.is_empty() || !placing.sees(projection, mesh.bounds()) {
        stats.count(|stats| &mut stats.meshes_out_of_sight);
        return Ok(true);
    }
    let (start, most) = (vertices.len(), vertices.capacity().min(MOST_SLOTS));
    let Some([first, last]) = named(mesh, most - start) else {
        return Ok(true);
    };
    let count = usize::from(last - first) + 1;
    if start + count > most {
        return Err(CapacityError::Vertices { capacity: most, needed: start + count });
    }
    let to_slot = start.wrapping_sub(first.into());
    let own = start..start + count;
    let first_triangle = triangles.len();
    let mut recorder = Recorder {
        vertices,
        triangles,
        mesh,
        placing,
        style,
        window,
        to_slot,
        own,
        is_any_cut_off: false,
        missing: [0; 2],
    };
    match stats.stats() {
        Some(stats) => recorder.record_counted(first, stats),
        None => recorder.record_uncounted(first),
    }
    recorder.fits()?;
    let Recorder { vertices, triangles, own, .. } = recorder;
    let triangles = triangles.get_mut(first_triangle..).unwrap_or_default();
    Ok(move_together(vertices, triangles, (mesh, first), style.inputs, own))
}

/// Keeps a vertex for the first time.
#[inline(never)]
fn keep_first(style: &Style<'_>, of_mesh: &Vertex, vertex: &mut ListVertex) {
    vertex.q |= KEPT;
    if style.has_color()
        && let Some(color) = vertex.attributes.first_chunk_mut::<3>()
    {
        style.coloring.of_vertex(of_mesh, bytemuck::must_cast_mut(color));
    }
}

/// The first and the last vertex that get a slot, with all between them; `None` if no vertex does. There are `most` slots.
///
/// If the mesh is a part of a larger one, whose vertices it shares, these are the first and the last that its triangles use.
/// To find them takes as long as to transform a tenth of the vertices. A mesh with at least as many triangles as vertices is
/// most likely a whole one: all its vertices get slots, if there are so many, and nothing is searched.
#[inline(never)]
fn named(mesh: &Mesh<'_>, most: usize) -> Option<[u16; 2]> {
    let count = mesh.vertices().len();
    if count <= mesh.triangles().len() && count <= most {
        return count.checked_sub(1).map(|last| [0, last as u16]);
    }
    let (mut first, mut last) = (u16::MAX, 0);
    for [a, b, c] in mesh.triangles() {
        first = first.min(a).min(b).min(c);
        last = last.max(a).max(b).max(c);
        // Not unrolled: 500 bytes less.
        black_box(());
    }
    (first <= last).then_some([first, last])
}

impl Recorder<'_, '_> {
    /// Records the mesh, from its vertex `first` on. As the next one without type parameters, so that it is compiled with this crate, at
    /// its level of optimisation and not at that of the program.
    #[inline(never)]
    fn record_counted(&mut self, first: u16, stats: &mut Stats) {
        self.place(first, stats);
        self.add_triangles(stats);
    }

    #[inline(never)]
    fn record_uncounted(&mut self, first: u16) {
        self.place(first, &mut ());
        self.add_triangles(&mut ());
    }

    /// Transforms vertices into their slots, from the mesh's vertex `first` on. The caller has checked that there is room.
    #[inline(never)]
    fn place(&mut self, first: u16, stats: &mut impl Count) {
        let _ = self.vertices.resize_default(self.own.end);
        let slots = self.vertices.get_mut(self.own.clone()).unwrap_or_default();
        let of_mesh = self.mesh.vertices().get(usize::from(first)..).unwrap_or_default();
        for (slot, vertex) in slots.iter_mut().zip(of_mesh) {
            stats.count(|stats| &mut stats.transformed);
            if !self.placing.place(vertex, (&mut slot.x, &mut slot.y, &mut slot.q)) {
                slot.x = CUT_OFF;
                self.is_any_cut_off = true;
            }
        }
    }

    /// Where a vertex of the mesh is on the screen, x and y in 1/16 px.
    #[inline]
    fn at(&self, index: u16) -> [i32; 2] {
        let slot = usize::from(index).wrapping_add(self.to_slot);
        self.vertices.get(slot).map_or([0; 2], ListVertex::position)
    }

    /// Culls, clips and records the mesh's triangles.
    #[inline(never)]
    fn add_triangles(&mut self, stats: &mut impl Count) {
        let is_faceted = self.style.coloring.is_faceted();
        let cut_off = i32::from(CUT_OFF.to_bits());
        let mesh = self.mesh;
        for indices in mesh.triangles() {
            stats.count(|stats| &mut stats.triangles);
            let [a, b, c] = indices.map(|index| self.at(index));
            if self.is_any_cut_off && (a[0] == cut_off || b[0] == cut_off || c[0] == cut_off) {
                // One by one, not as an array, which would be in memory for every triangle.
                let [a, b, c] = indices;
                self.add_cut(a, b, c, stats);
                continue;
            }
            let area = area([a, b, c]);
            if self.style.cull.leaves_out(area) {
                stats.count(|stats| &mut stats.culled);
                continue;
            }
            let Some(rows) = self.rows_if_seen([a, b, c], stats) else {
                continue;
            };
            if is_faceted {
                self.add_faceted(indices, area, rows);
            } else {
                let corners = indices.map(|index| self.keep(index));
                self.add(corners, area, rows);
            }
        }
    }

    /// The first and the last row of a triangle in the viewport, in units of 4 rows (see [`ROWS_LOG2`]). `None` if no pixel
    /// centre of the viewport lies in the triangle's bounding box. Counts which of the two it is.
    #[inline]
    fn rows_if_seen(&self, [a, b, c]: [[i32; 2]; 3], stats: &mut impl Count) -> Option<[u8; 2]> {
        let within = |axis: usize, range: &core::ops::Range<i32>| {
            let [start, end] = Window::centers(a[axis], b[axis], c[axis]);
            (start.max(range.start), end.min(range.end))
        };
        let (left, right) = within(0, &self.window.columns);
        let (top, bottom) = within(1, &self.window.rows);
        if left >= right || top >= bottom {
            stats.count(|stats| &mut stats.out_of_sight);
            return None;
        }
        stats.count(|stats| &mut stats.drawn);
        Some([(top >> ROWS_LOG2) as u8, ((bottom - 1) >> ROWS_LOG2) as u8])
    }

    /// Records a triangle, from the slots of its corners.
    #[inline(always)]
    fn add(&mut self, corners: [u16; 3], area: i32, rows: [u8; 2]) {
        self.push_triangle(ListTriangle { corners: clockwise(corners, area), rows });
    }

    #[inline(always)]
    fn push_triangle(&mut self, triangle: ListTriangle) {
        if self.triangles.push(triangle).is_err() {
            self.missing[1] += 1;
        }
    }

    /// Whether all found room.
    fn fits(&self) -> Result<(), CapacityError> {
        let [vertices, triangles] = self.missing;
        if vertices > 0 {
            let capacity = self.vertices.len();
            return Err(CapacityError::Vertices { capacity, needed: capacity + vertices });
        }
        if triangles > 0 {
            let capacity = self.triangles.len();
            return Err(CapacityError::Triangles { capacity, needed: capacity + triangles });
        }
        Ok(())
    }

    /// Keeps a vertex of the mesh; returns its slot, which [`move_together`] will change. When it is kept for the first time it gets its
    /// colour.
    #[inline]
    fn keep(&mut self, index: u16) -> u16 {
        let slot = usize::from(index).wrapping_add(self.to_slot);
        if let Some(vertex) = self.vertices.get_mut(slot).filter(|vertex| vertex.q & KEPT == U1F31::ZERO) {
            keep_first(self.style, self.mesh.vertex(index), vertex);
        }
        slot as u16
    }

    /// Records a triangle with flat shading. Its colours are its own, so its corners are too: they are appended.
    #[inline(never)]
    fn add_faceted(&mut self, indices: [u16; 3], area: i32, rows: [u8; 2]) {
        let mut corners = [0; 3];
        let light = self.style.coloring.on_face(indices.map(|index| self.mesh.vertex(index)));
        for (corner, index) in corners.iter_mut().zip(indices) {
            let slot = usize::from(index).wrapping_add(self.to_slot);
            let of_mesh = self.mesh.vertex(index);
            let mut vertex = ScreenVertex::default();
            if let Some(at) = self.vertices.get(slot) {
                (vertex.x, vertex.y, vertex.q) = (at.x, at.y, at.q);
            }
            [vertex.u, vertex.v] = of_mesh.uv.map(I16F16::from);
            self.style.coloring.of_vertex(of_mesh, &mut vertex.color);
            if let Some(light) = light {
                dim(&mut vertex.color, light);
            }
            *corner = self.push(&vertex);
        }
        self.add(corners, area, rows);
    }

    /// Clips a triangle and records its pieces, a fan around the polygon's first corner. Pieces share the corners that they
    /// append.
    #[cold]
    #[inline(never)]
    fn add_cut(&mut self, a: u16, b: u16, c: u16, stats: &mut impl Count) {
        let indices = [a, b, c];
        stats.count(|stats| &mut stats.clipped);
        let Some((to_clip, clip)) = self.placing.clipping() else {
            return;
        };
        let mut polygon = [ScreenVertex::default(); MOST_CORNERS];
        let corners = indices.map(|index| self.mesh.vertex(index));
        set_attributes(corners, &self.style.coloring, &mut polygon);
        let (count, is_folded) = clip.cut(to_clip, corners, &mut polygon, &mut Upper::default());
        if let Some(light) = self.style.coloring.on_face(corners) {
            polygon.iter_mut().take(count).for_each(|corner| dim(&mut corner.color, light));
        }
        let seen = polygon.get(..count).unwrap_or_default();
        if is_folded {
            return self.add_folded(seen, stats);
        }
        let mut slots = [None; MOST_CORNERS];
        for piece in 1..count.saturating_sub(1).min(MOST_CORNERS - 1) {
            let fan = [0, piece, piece + 1];
            let position = |i: usize| [polygon[i].x, polygon[i].y].map(|at| i32::from(at.to_bits()));
            let area = area(fan.map(position));
            if self.style.cull.leaves_out(area) {
                stats.count(|stats| &mut stats.culled);
                continue;
            }
            let Some(rows) = self.rows_if_seen(fan.map(position), stats) else {
                continue;
            };
            let mut corners = [0; 3];
            for (corner, i) in corners.iter_mut().zip(fan) {
                *corner = match slots[i] {
                    Some(slot) => slot,
                    None => self.push(&polygon[i]),
                };
                slots[i] = Some(*corner);
            }
            self.add(corners, area, rows);
        }
    }

    /// A polygon that is folded: all its corners, one after the other.
    #[cold]
    #[inline(never)]
    fn add_folded(&mut self, polygon: &[ScreenVertex], stats: &mut impl Count) {
        let rows = rows_of_folded(polygon, &self.window);
        if rows.is_empty() {
            stats.count(|stats| &mut stats.out_of_sight);
            return;
        }
        stats.count(|stats| &mut stats.drawn);
        let mut ends = [None, None];
        for corner in polygon {
            let slot = self.push(corner);
            ends = [ends[0].or(Some(slot)), Some(slot)];
        }
        let [first, last] = ends.map(Option::unwrap_or_default);
        let rows = [rows.start, rows.end - 1].map(|row| (row >> ROWS_LOG2) as u8);
        let corners = [first, first, last];
        self.push_triangle(ListTriangle { corners, rows });
    }

    /// Appends a corner that clipping or flat shading made. Returns its slot, which [`move_together`] will shift down.
    fn push(&mut self, at: &ScreenVertex) -> u16 {
        let slot = self.vertices.len();
        let uv = ListVertex::attributes_of([at.u, at.v]);
        let [red, green, blue] = at.color.map(U8F8::to_bits);
        let vertex = ListVertex::new(at);
        match self.style.inputs {
            Inputs::Uv => self.push_slot(ListVertex { attributes: uv, ..vertex }),
            inputs => self.push_slot(ListVertex {
                attributes: [red, green, blue, if inputs == Inputs::UvColor { IN_NEXT } else { 0 }],
                ..vertex
            }),
        }
        if self.style.inputs == Inputs::UvColor {
            self.push_slot(ListVertex { x: CUT_OFF, attributes: uv, ..ListVertex::default() });
        }
        slot as u16
    }

    fn push_slot(&mut self, slot: ListVertex) {
        if self.vertices.len() >= MOST_SLOTS || self.vertices.push(slot).is_err() {
            self.missing[0] += 1;
        }
    }
}
