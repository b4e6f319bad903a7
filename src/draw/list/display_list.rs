//! The display list: meshes are recorded once a frame, as screen vertices and triangles, and rendered band by band.
//!
//! - In: what a camera draws.
//! - Out: bands of a few rows, with the bytes of a whole frame.
//! - Assumes: the bands of one frame share its width.

use super::capacity::CapacityError;
use super::entries::{ListTriangle, ListVertex, ListView, ROWS_LOG2};
use super::extent::Extent;
use super::index::{Index, Touching, steps_of, touch};
use super::kept::Kept;
use super::memory::ListMemory;
use super::order::Order;
use super::record::record;
use super::style::Style;
use crate::draw::canvas::Canvas;
use crate::draw::canvas::sealed::Sealed;
use crate::draw::sight::Sight;
use crate::draw::triangle::Raster;
use crate::frame::{Background, Band, DepthFormat, PixelFormat, Window};
use crate::geometry::{Count, Cull, MOST_CORNERS, ScreenVertex};
use crate::math::Pose;
use crate::scene::{Mesh, Vertex, Viewport};
use crate::shade::{InFog, Look, Memory, Surface};
use core::fmt;
use embedded_graphics::geometry::Dimensions;
use embedded_graphics::primitives::Rectangle;
use heapless::{Vec, VecView};

/// A scene bigger than RAM: what views drew in a frame, as vertices and triangles in a [`ListMemory`] and at most `N` draws, to be
/// rendered band by band.
///
/// It takes materials and surfaces of any kind and quality, for bands of the pixel format `F` and the depth format `D`. A list is made
/// for a frame, on memory that stays, and is gone with it: lights, meshes and materials may be as short-lived. Where all that is
/// drawn is `'static`, a list can stay too, and be [cleared](DisplayList::clear).
///
/// Of a mesh only the vertices of triangles that are seen stay in the list, but while
/// it is drawn there has to be room for all from the first to the last that it names. (A corner that clipping makes takes a
/// vertex, and two if it has both colour and texture; a triangle that is lit as a face takes three of its own.) Triangles that are
/// culled or out of the viewport take nothing. Draws of one mesh with one material or shader in a row count as one. A draw that does
/// not fit is an error, and leaves the list as it was.
///
/// Transparent triangles, those that show what is behind them, are drawn last, from back to front; all others as they were drawn to
/// the list. They are sorted by one number, near/w in their middle: long ones that lie across each other want to be cut into pieces.
/// Cameras of other near planes do not compare: draw a transparent overlay from a list of its own, after the scene's.
///
/// A draw takes 148 bytes, besides, on a chip with pointers of 32 bits. [`memory`](crate::guide::memory) has a recipe for all of it.
///
/// The picture is the same bytes for every height of the bands, and as drawn at once into a whole frame in the same order.
/// [`render`](DisplayList::render) takes `&self`, and a list is `Send` and `Sync`: two cores can render two bands.
///
/// ```
/// use fixel::embedded_graphics::{pixelcolor::Rgb565, prelude::*};
/// use fixel::prelude::*;
/// # fn main() -> Result<(), fixel::CapacityError> {
/// # const TRIANGLE: Mesh = Mesh::new(
/// #     &[Vertex::new(-1.0, -1.0, 0.0), Vertex::new(1.0, -1.0, 0.0), Vertex::new(0.0, 1.0, 0.0)],
/// #     &[[0, 1, 2]],
/// # );
/// # let mut display = Vec::new();
/// let screen = Size::new(240, 320);
/// let camera = Camera::perspective(Turn::from_degrees(60), screen).at(Vec3::lit(0.0, 0.0, 2.5));
/// let mut memory = ListMemory::<8, 4>::new(); // at most so many vertices and triangles
/// let mut list = DisplayList::<Rgb565, Depth16, 2>::new(&mut memory); // and draws
/// camera.draw(&TRIANGLE, &Pose::IDENTITY, &Material::gouraud(), &mut list)?;
///
/// let (mut pixels, mut depth) = ([0; 240 * 16], [0; 240 * 16]);
/// let mut band = Band::<Rgb565, Depth16>::new(Size::new(240, 16), &mut pixels, &mut depth).unwrap();
/// let Ok(()) = list.render_bands(screen.height, &Rgb565::BLUE, &mut band, |area, band| {
///     // 2D on top, then to the display: display.fill_contiguous(&area, band.colors())
/// #   display.extend(band.colors());
/// #   Ok::<_, core::convert::Infallible>(())
/// });
/// # assert_eq!(display.len(), 240 * 320);
/// # Ok(())
/// # }
/// ```
pub struct DisplayList<'a, F: PixelFormat, D: DepthFormat, const N: usize> {
    vertices: &'a mut VecView<ListVertex>,
    triangles: &'a mut VecView<ListTriangle>,
    order: Order<'a>,
    draws: Vec<Draw<'a, F, D>, N>,
}

/// What triangles have in common.
struct Draw<'a, F: PixelFormat, D: DepthFormat> {
    look: Look<'a, F, D>,
    fog: Option<InFog<'a, F, D>>,
    /// The mesh's.
    vertices: &'a [Vertex],
    viewport: Viewport,
    /// The triangle behind the last.
    end: u16,
    /// Of the mesh as it is seen, perhaps mirrored.
    cull: Cull,
    is_orthographic: bool,
    /// Whether all colours are grey.
    is_gray: bool,
}

impl<'a, F: PixelFormat, D: DepthFormat, const N: usize> DisplayList<'a, F, D, N> {
    /// The bytes that it takes, without its memory: see [`ListMemory::BYTES`].
    pub const BYTES: usize = size_of::<Self>();

    /// An empty list.
    #[must_use]
    pub fn new<const V: usize, const T: usize>(memory: &'a mut ListMemory<V, T>) -> Self {
        let ListMemory { vertices, triangles, index } = memory;
        let mut list = Self { vertices, triangles, order: Order::new(index), draws: Vec::new() };
        list.clear();
        list
    }

    /// Forgets all.
    pub fn clear(&mut self) {
        self.vertices.clear();
        self.triangles.clear();
        self.order.clear();
        self.draws.clear();
    }

    /// How many vertices, triangles and draws it holds.
    #[must_use]
    pub fn lengths(&self) -> [usize; 3] {
        [self.vertices.len(), self.triangles.len(), self.draws.len()]
    }

    /// Changes the order of all triangles, transparent or not, to back to front, by the depth (near/w) of triangles' middles on
    /// the screen, and as drawn where it is the same: for bands with [`NoDepth`](crate::NoDepth). Call it after the last draw;
    /// another changes it back.
    ///
    /// Where triangles cut through each other, or long ones overlap in a circle, no order is right: that takes depth.
    pub fn sort_back_to_front(&mut self) {
        let view = ListView { vertices: self.vertices, triangles: self.triangles };
        self.order.sort_back_to_front(&view);
    }

    /// Draws rows `top` … `top` + height − 1 of the screen into a band, which becomes the band of these rows. What it holds it
    /// keeps, as with [`Camera::draw`](crate::Camera::draw): clear it first, see [`Band::clear_to`].
    pub fn render(&self, top: u32, band: &mut Band<'_, F, D>) {
        band.move_to(top);
        let view = self.view();
        render(&view, self.order.index(), &self.draws, band, &mut Kept::new(&mut []));
    }

    /// Draws a screen of `height` rows (at most 1023) from the top down, as many at a time as the band has, and hands each
    /// to `flush`, with its area. In the last there may be fewer rows. A DMA channel can send them while the next is drawn:
    /// [`Band::swap_pixels`] in `flush`. (Swap pixels there, not bands.)
    ///
    /// It takes `&mut self` for memory: slots of vertices that the list does not need keep the set-up of triangles that reach into the
    /// next band, and the rows that they have there. A triangle takes 24 to 272 bytes, most often about 80. One that finds no room is set
    /// up again in the next band, as [`DisplayList::render`] does; the picture is the same. On a Cortex-M0+ a triangle takes about 2500
    /// cycles less if it is kept, on a Cortex-M4 1300.
    ///
    /// # Errors
    ///
    /// The first of `flush`; the rest is not drawn then.
    pub fn render_bands<'b, E>(
        &mut self,
        height: u32,
        background: &impl Background<F>,
        band: &mut Band<'b, F, D>,
        mut flush: impl FnMut(Rectangle, &mut Band<'b, F, D>) -> Result<(), E>,
    ) -> Result<(), E> {
        let length = self.vertices.len();
        let _ = self.vertices.resize_default(self.vertices.capacity());
        let (vertices, free) = self.vertices.split_at_mut_checked(length).unwrap_or_default();
        let (view, mut kept) = (ListView { vertices, triangles: self.triangles }, Kept::new(free));
        let (mut top, mut result) = (0, Ok(()));
        while band.move_to_part(top, height) {
            band.clear_to(background);
            render(&view, self.order.index(), &self.draws, band, &mut kept);
            let area = band.bounding_box();
            result = flush(area, band);
            if result.is_err() {
                band.all_rows();
                break;
            }
            top += area.size.height;
        }
        self.vertices.truncate(length);
        result
    }

    fn view(&self) -> ListView<'_> {
        ListView { vertices: self.vertices, triangles: self.triangles }
    }

    /// The bounding box of what the list draws of some rows and columns.
    pub(crate) fn extent(&self, window: &Window) -> Extent {
        let view = self.view();
        let (rows, mut first, mut all) = (steps_of(window), 0, Extent::NONE);
        for draw in &self.draws {
            let window = window.clone().within(&draw.viewport);
            let end = usize::from(draw.end);
            let triangles = self.triangles.get(first..end).unwrap_or_default().iter();
            all = triangles
                .filter(|triangle| touch(triangle.rows, rows))
                .fold(all, |all, triangle| all.union(Extent::new(view.bounds(triangle)).within(&window)));
            first = end;
        }
        all
    }
}

impl<F: PixelFormat, D: DepthFormat> Draw<'_, F, D> {
    /// Whether another draw's triangles may count as this one's.
    fn is_like(&self, other: &Self) -> bool {
        self.look.is_like(&other.look)
            && self.fog == other.fog
            && core::ptr::eq(self.vertices, other.vertices)
            && self.viewport == other.viewport
            && self.cull == other.cull
            && self.is_orthographic == other.is_orthographic
    }
}

/// What a list holds of the rows of a band. Compiled once for all capacities.
///
/// Not inlined: it would share registers with what clears a band.
#[inline(never)]
fn render<F: PixelFormat, D: DepthFormat>(
    view: &ListView<'_>,
    index: Index<'_>,
    draws: &[Draw<'_, F, D>],
    band: &mut Band<'_, F, D>,
    kept: &mut Kept<'_>,
) {
    let window = band.window();
    let Some(mut draw) = draws.first() else {
        return;
    };
    if window.is_empty() {
        return;
    }
    let rows = steps_of(&window);
    let end = window.rows.end;
    let within = |draw: &Draw<'_, F, D>| window.clone().within(&draw.viewport);
    let kind = |draw: &Draw<'_, F, D>| [draw.is_orthographic, draw.is_gray];
    // Its first triangle, and how many it has.
    let (mut first, mut count) = (0, draw.end);
    let mut raster = Raster::new((&draw.look, draw.fog.as_ref()), kind(draw), within(draw), band);
    raster.needs.rows_below = kept.has_room();
    let mut corners = [ScreenVertex::default(); 3];
    let mut seen = Touching::new(view.triangles, index, rows);
    while let Some((id, triangle)) = seen.next() {
        if id.wrapping_sub(first) >= count {
            let number = draws.partition_point(|draw| draw.end <= id);
            first = number.checked_sub(1).and_then(|before| draws.get(before)).map_or(0, |draw| draw.end);
            let Some(other) = draws.get(number) else {
                return;
            };
            (draw, count) = (other, other.end - first);
            raster.change((&draw.look, draw.fog.as_ref()), kind(draw), within(draw));
            raster.needs.rows_below = kept.has_room();
        }
        if triangle.is_folded() {
            draw_folded(view, triangle, draw, &mut raster);
            continue;
        }
        let Raster { setup, needs, target, .. } = &mut raster;
        let Memory { rows, window, .. } = &mut target.memory;
        let is_seen = if !kept.has(id) {
            view.corners(triangle, draw.look.traits.inputs(), draw.vertices, &mut corners);
            raster.draw_clockwise(corners.each_ref())
        } else if kept.take(setup, rows, needs, window) {
            raster.paint();
            true
        } else {
            view.positions(triangle, &mut corners);
            raster.draw_set_up(corners.each_ref())
        };
        // Its rows are in units of 4.
        if is_seen && i32::from(triangle.rows[1]) >= end >> ROWS_LOG2 {
            let Raster { setup, needs, target, .. } = &raster;
            let Memory { rows, window, .. } = &target.memory;
            // Where a viewport ends the next window does not begin where this one does.
            if window.rows.end == end {
                kept.put(id, setup, rows, needs);
            }
        }
    }
}

/// A polygon that rounding folded. Its corners are not on the stack while others are drawn.
#[cold]
#[inline(never)]
fn draw_folded<F: PixelFormat, D: DepthFormat>(
    view: &ListView<'_>,
    folded: &ListTriangle,
    draw: &Draw<'_, F, D>,
    raster: &mut Raster<'_, F, D>,
) {
    let mut corners = [ScreenVertex::default(); MOST_CORNERS];
    let polygon = view.polygon(folded, draw.look.traits.inputs(), draw.vertices, &mut corners);
    raster.draw_folded(polygon, draw.cull);
}

impl<'a, F: PixelFormat, D: DepthFormat, const N: usize> Canvas<'a> for DisplayList<'a, F, D, N> {
    type Format = F;
    type Depth = D;
    type Output = Result<(), CapacityError>;

    fn draw_mesh(
        &mut self,
        sight: &Sight<'_, 'a, F, D>,
        mesh: &Mesh<'a>,
        pose: &Pose,
        surface: &Surface<'a, F, D>,
        stats: &mut impl Count,
    ) -> Result<(), CapacityError> {
        let &Sight { camera, lights, fog } = sight;
        let style = Style::new(surface, camera.placement(), pose, lights);
        let [vertices, triangles, draws] = self.lengths();
        let recorded = record(
            self.vertices,
            self.triangles,
            mesh,
            [camera.placement(), pose],
            camera.projection(),
            &style,
            stats,
        );
        let result = recorded.and_then(|is_gray| {
            if self.triangles.len() == triangles {
                return Ok(());
            }
            let draw = Draw {
                look: surface.look,
                fog: fog.copied(),
                vertices: mesh.vertices(),
                viewport: camera.projection().viewport,
                end: self.triangles.len() as u16,
                cull: style.cull,
                is_orthographic: camera.is_orthographic(),
                is_gray,
            };
            if let Some(last) = self.draws.last_mut().filter(|last| last.is_like(&draw)) {
                last.end = draw.end;
                last.is_gray &= draw.is_gray;
                return Ok(());
            }
            let needed = draws + 1;
            self.draws.push(draw).map_err(|_| CapacityError::Draws { capacity: N, needed })
        });
        if result.is_err() {
            self.vertices.truncate(vertices);
            self.triangles.truncate(triangles);
            return result;
        }
        let view = ListView { vertices: self.vertices, triangles: self.triangles };
        self.order.add(&view, triangles, surface.look.layers.code.reads_target, || {
            self.draws.iter().map(|draw| (draw.end, draw.look.layers.code.reads_target))
        });
        Ok(())
    }
}

impl<F: PixelFormat, D: DepthFormat, const N: usize> Sealed for DisplayList<'_, F, D, N> {}

impl<F: PixelFormat, D: DepthFormat, const N: usize> fmt::Debug for DisplayList<'_, F, D, N> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [vertices, triangles, draws] = self.lengths();
        f.debug_struct("DisplayList")
            .field("vertices", &vertices)
            .field("triangles", &triangles)
            .field("draws", &draws)
            .finish_non_exhaustive()
    }
}
