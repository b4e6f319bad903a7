//! The display list: meshes are recorded once a frame, as screen vertices and triangles, and rendered band by band.
//!
//! - In: what a camera draws.
//! - Out: bands of a few rows, with the bytes of a whole frame.
//! - Assumes: the bands of one frame share its width.

use super::capacity::{CapacityError, Full};
use super::entries::{ListTriangle, ListVertex, ListView, MOST_SLOTS};
use super::extent::Extent;
use super::index::{BLOCK, Index, Touching, rows_of, sort, steps_of, touch};
use super::record::record;
use super::style::Style;
use crate::draw::canvas::Canvas;
use crate::draw::canvas::sealed::Sealed;
use crate::draw::triangle::Raster;
use crate::frame::{Background, Band, DepthFormat, PixelFormat, Window};
use crate::geometry::{Count, Cull, Inputs, MOST_CORNERS, ScreenVertex};
use crate::math::Pose;
use crate::scene::{Camera, Mesh, Vertex, Viewport};
use crate::shade::{Material, Shader};
use core::fmt;
use core::marker::PhantomData;
use embedded_graphics::geometry::Dimensions;
use embedded_graphics::pixelcolor::Rgb565;
use embedded_graphics::primitives::Rectangle;
use heapless::Vec;

/// A scene bigger than RAM: what [`Camera::draw`] drew, kept as at most `V` vertices, `T` triangles and `D` draws, to be
/// rendered into bands of a few rows, each with its own depth.
///
/// A vertex takes 16 bytes and a triangle 10. Of a mesh only the vertices of triangles that are seen stay in the list, but while
/// it is drawn there has to be room for all from the first to the last that it names. (A corner that clipping makes takes a
/// vertex, and two if it has both colour and texture; a triangle that is lit as a face takes three of its own.) Triangles that are
/// culled or out of the viewport take nothing. Draws of one mesh and one shader in a row count as one.
///
/// The picture is the same bytes for every height of the bands, and as drawn at once into a whole frame. Rendering takes `&self`:
/// two cores can render two bands.
///
/// `S` is the type of shader and `F` the pixel format. `DisplayList::<8, 4, 1>` is a list of [`Material`]s in the default quality
/// for bands of `Rgb565`: those are the defaults, and nothing is inferred where the two are left out. For anything else name
/// them, or write `_` and they are inferred from what is drawn to the list and into which band it is rendered:
///
/// ```
/// use fixel::embedded_graphics::{pixelcolor::Rgb565, prelude::*};
/// use fixel::{BigEndian, Textured, prelude::*};
/// # fn main() -> Result<(), fixel::CapacityError> {
/// # const TRIANGLE: Mesh = Mesh::new(
/// #     &[Vertex::new(-1.0, -1.0, 0.0), Vertex::new(1.0, -1.0, 0.0), Vertex::new(0.0, 1.0, 0.0)],
/// #     &[[0, 1, 2]],
/// # );
/// # static CHECKS: Texture = Texture::new(&[0xffdf, 0x4a69, 0x4a69, 0xffdf], 1, 1);
/// # let camera = Camera::perspective(Turn::from_degrees(60), Size::new(64, 64)).at(Vec3::lit(0.0, 0.0, 2.5));
/// # let mut pixels = [0; 64 * 64];
/// # let mut band = Band::<BigEndian<Rgb565>, NoDepth>::new(Size::new(64, 64), &mut pixels, &mut []).unwrap();
/// let checks = Textured::new(&CHECKS);
/// let mut list = DisplayList::<8, 4, 1, _, _>::new();
/// camera.draw(&TRIANGLE, &Pose::IDENTITY, &checks, &mut list)?; // so S is Textured
/// list.render(0, &mut band); // a band of BigEndian<Rgb565>, so F is that
/// # assert!(band.pixels().iter().any(|&word| word != 0));
/// # Ok(())
/// # }
/// ```
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
/// let material = Material::gouraud();
/// let mut list = DisplayList::<8, 4, 1>::new(); // vertices, triangles, draws
/// camera.draw(&TRIANGLE, &Pose::IDENTITY, &material, &mut list)?;
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
pub struct DisplayList<
    'a,
    const V: usize,
    const T: usize,
    const D: usize,
    S = Material<'a>,
    F: PixelFormat = Rgb565,
> {
    vertices: Vec<ListVertex, V>,
    triangles: Vec<ListTriangle, T>,
    /// Back to front: the triangles. As drawn: the rows that each [`BLOCK`] of them touch, as [`ListTriangle::rows`] has them.
    index: Vec<u16, T>,
    is_sorted: bool,
    draws: Vec<Draw<'a, S>, D>,
    format: PhantomData<fn() -> F>,
}

/// What triangles have in common.
struct Draw<'a, S> {
    shader: &'a S,
    /// The mesh's.
    vertices: &'a [Vertex],
    viewport: Viewport,
    /// The triangle behind the last.
    end: u16,
    inputs: Inputs,
    /// Of the mesh as it is seen, perhaps mirrored.
    cull: Cull,
    is_orthographic: bool,
    /// Whether all colours are grey.
    is_gray: bool,
}

impl<'a, const V: usize, const T: usize, const D: usize, S, F: PixelFormat> DisplayList<'a, V, T, D, S, F> {
    /// An empty list. Nothing but its lengths is written.
    #[must_use]
    pub const fn new() -> Self {
        const { assert!(V <= MOST_SLOTS && T <= MOST_SLOTS, "a list has at most 65535 vertices and triangles") };
        Self {
            vertices: Vec::new(),
            triangles: Vec::new(),
            index: Vec::new(),
            is_sorted: false,
            draws: Vec::new(),
            format: PhantomData,
        }
    }

    /// The bytes that a list of these capacities takes.
    #[must_use]
    pub const fn bytes() -> usize {
        size_of::<Self>()
    }

    /// Forgets all.
    pub fn clear(&mut self) {
        self.vertices.clear();
        self.triangles.clear();
        self.index.clear();
        self.is_sorted = false;
        self.draws.clear();
    }

    /// How many vertices, triangles and draws it holds.
    #[must_use]
    pub fn lengths(&self) -> [usize; 3] {
        [self.vertices.len(), self.triangles.len(), self.draws.len()]
    }

    /// Changes the order from that of drawing to back to front, by the depth (near/w) of triangles' middles on the screen, and as
    /// drawn where it is the same: for bands with [`NoDepth`](crate::NoDepth). Call it after the last draw; another changes it
    /// back.
    ///
    /// Where triangles cut through each other, or long ones overlap in a circle, no order is right: that takes depth.
    pub fn sort_back_to_front(&mut self) {
        let view = ListView { vertices: &self.vertices, triangles: &self.triangles };
        let key =
            |id: u16| (self.triangles.get(usize::from(id)).map_or(0, |triangle| view.nearness(triangle)), id);
        self.index.clear();
        self.index.extend(0..self.triangles.len() as u16);
        sort(&mut self.index, key);
        self.is_sorted = true;
    }

    /// Draws rows `top` … `top` + height − 1 of the screen into a band, which becomes the band of these rows. What it holds it
    /// keeps, as with [`Camera::draw`]: clear it first, see [`Band::clear_to`].
    pub fn render<Z: DepthFormat>(&self, top: u32, band: &mut Band<'_, F, Z>)
    where
        S: Shader<F>,
    {
        band.move_to(top);
        let view = ListView { vertices: &self.vertices, triangles: &self.triangles };
        let index = if self.is_sorted { Index::Order(&self.index) } else { Index::Rows(&self.index) };
        render(&view, index, &self.draws, band);
    }

    /// Draws a screen of `height` rows (at most 1023) from the top down, as many at a time as the band has, and hands each
    /// to `flush`, with its area. In the last there may be fewer rows. A DMA channel can send them while the next is drawn:
    /// [`Band::swap_pixels`] in `flush`. (Swap pixels there, not bands.)
    ///
    /// # Errors
    ///
    /// The first of `flush`; the rest is not drawn then.
    pub fn render_bands<'b, Z: DepthFormat, E>(
        &self,
        height: u32,
        background: &impl Background<F>,
        band: &mut Band<'b, F, Z>,
        mut flush: impl FnMut(Rectangle, &mut Band<'b, F, Z>) -> Result<(), E>,
    ) -> Result<(), E>
    where
        S: Shader<F>,
    {
        let mut top = 0;
        while band.move_to_part(top, height) {
            band.clear_to(background);
            self.render(top, band);
            let area = band.bounding_box();
            if let Err(error) = flush(area, band) {
                band.all_rows();
                return Err(error);
            }
            top += area.size.height;
        }
        Ok(())
    }

    /// The bounding box of what the list draws of some rows and columns.
    pub(crate) fn extent(&self, window: &Window) -> Extent {
        let view = ListView { vertices: &self.vertices, triangles: &self.triangles };
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

impl<S> Draw<'_, S> {
    /// Whether another draw's triangles may count as this one's.
    fn is_like(&self, other: &Self) -> bool {
        core::ptr::eq(self.shader, other.shader)
            && core::ptr::eq(self.vertices, other.vertices)
            && self.viewport == other.viewport
            && self.inputs == other.inputs
            && self.cull == other.cull
            && self.is_orthographic == other.is_orthographic
    }
}

/// What a list holds of the rows of a band. Compiled once for all capacities.
fn render<F: PixelFormat, Z: DepthFormat, S: Shader<F>>(
    view: &ListView<'_>,
    index: Index<'_>,
    draws: &[Draw<'_, S>],
    band: &mut Band<'_, F, Z>,
) {
    let window = band.window();
    let Some(mut draw) = draws.first() else {
        return;
    };
    if window.is_empty() {
        return;
    }
    let rows = steps_of(&window);
    let within = |draw: &Draw<'_, S>| window.clone().within(&draw.viewport);
    let kind = |draw: &Draw<'_, S>| [draw.is_orthographic, draw.is_gray];
    // Its first triangle, and how many it has.
    let (mut first, mut count) = (0, draw.end);
    let mut raster = Raster::new(draw.shader, kind(draw), within(draw), band);
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
            raster.change(draw.shader, kind(draw), within(draw));
        }
        if triangle.is_folded() {
            draw_folded(view, triangle, draw, &mut raster);
            continue;
        }
        view.corners(triangle, draw.inputs, draw.vertices, &mut corners);
        raster.draw_in_order(corners.each_ref());
    }
}

/// A polygon that rounding folded. Its corners are not on the stack while others are drawn.
#[cold]
#[inline(never)]
fn draw_folded<F: PixelFormat, Z: DepthFormat, S: Shader<F>>(
    view: &ListView<'_>,
    folded: &ListTriangle,
    draw: &Draw<'_, S>,
    raster: &mut Raster<'_, '_, F, Z, S>,
) {
    let mut corners = [ScreenVertex::default(); MOST_CORNERS];
    let polygon = view.polygon(folded, draw.inputs, draw.vertices, &mut corners);
    raster.draw_folded(polygon, draw.cull, &mut ());
}

impl<'a, const V: usize, const T: usize, const D: usize, S, F> Canvas<'a, S>
    for DisplayList<'a, V, T, D, S, F>
where
    S: Shader<F>,
    F: PixelFormat,
{
    type Output = Result<(), CapacityError>;

    fn draw_mesh(
        &mut self,
        camera: &Camera,
        mesh: &Mesh<'a>,
        pose: &Pose,
        shader: &'a S,
        stats: &mut impl Count,
    ) -> Result<(), CapacityError> {
        let style = Style::new::<F, S>(shader, camera.placement(), pose);
        let [vertices, triangles, draws] = self.lengths();
        let recorded = record(
            &mut self.vertices,
            &mut self.triangles,
            mesh,
            [camera.placement(), pose],
            camera.projection(),
            &style,
            stats,
        );
        let draw = Draw {
            shader,
            vertices: mesh.vertices(),
            viewport: camera.projection().viewport,
            end: self.triangles.len() as u16,
            inputs: style.inputs,
            cull: style.cull,
            is_orthographic: camera.is_orthographic(),
            is_gray: *recorded.as_ref().unwrap_or(&false),
        };
        let result = match recorded {
            Ok(_) if self.triangles.len() == triangles => Ok(()),
            Ok(_) => match self.draws.last_mut() {
                Some(last) if last.is_like(&draw) => {
                    last.end = draw.end;
                    last.is_gray &= draw.is_gray;
                    Ok(())
                }
                _ => self.draws.push(draw).map_err(|_| CapacityError::Draws { capacity: D }),
            },
            Err(Full::Vertices) => Err(CapacityError::Vertices { capacity: V }),
            Err(Full::Triangles) => Err(CapacityError::Triangles { capacity: T }),
        };
        if result.is_err() {
            self.vertices.truncate(vertices);
            self.triangles.truncate(triangles);
            self.draws.truncate(draws);
            return result;
        }
        if self.is_sorted {
            self.index.clear();
            self.is_sorted = false;
        }
        let complete = self.index.len().min(triangles / BLOCK);
        self.index.truncate(complete);
        for block in self.triangles.get(complete * BLOCK..).unwrap_or_default().chunks(BLOCK) {
            // There is room: as much as for triangles.
            let _ = self.index.push(u16::from_le_bytes(rows_of(block)));
        }
        Ok(())
    }
}

impl<const V: usize, const T: usize, const D: usize, S, F: PixelFormat> Sealed
    for DisplayList<'_, V, T, D, S, F>
{
}

impl<const V: usize, const T: usize, const D: usize, S, F: PixelFormat> Default
    for DisplayList<'_, V, T, D, S, F>
{
    fn default() -> Self {
        Self::new()
    }
}

impl<const V: usize, const T: usize, const D: usize, S, F: PixelFormat> fmt::Debug
    for DisplayList<'_, V, T, D, S, F>
{
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [vertices, triangles, draws] = self.lengths();
        f.debug_struct("DisplayList")
            .field("vertices", &vertices)
            .field("triangles", &triangles)
            .field("draws", &draws)
            .finish_non_exhaustive()
    }
}
