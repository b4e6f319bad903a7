//! Rendering only what changed since the last frame: on a serial display the bus is slower than the chip.
//!
//! - In: a display list, and the areas that the last frame drew to.
//! - Out: the bands in which something may have changed, each with the rectangle around it.
//! - Assumes: all that is not in the list, the background and 2D on top, stays as it was unless it is marked.
//!
//! No pixels are compared. Of each band the area that this frame or the last drew to is drawn and sent again; the rest is not.

use super::display_list::DisplayList;
use super::extent::Extent;
use crate::frame::{Background, Band, DepthFormat, PixelFormat};
use embedded_graphics::geometry::Size;
use embedded_graphics::primitives::Rectangle;

/// What the last frame drew to, for [`DisplayList::render_changed`]: 8 bytes for each of `BANDS` bands.
///
/// A display keeps what it was sent. Where neither this frame nor the last has a triangle, it shows the background already:
/// only the rest is drawn and sent. That is exact as long as all else stays the same. If the background changes, or if
/// anything else was sent to the display, call [`Changes::everything`]. If what you draw on top changes, [`Changes::mark`]
/// both where it was and where it is.
///
/// ```
/// use fixel::embedded_graphics::{pixelcolor::Rgb565, prelude::*};
/// use fixel::{Changes, prelude::*, shapes};
/// static CUBE: shapes::Shape<24, 12> = shapes::cube(1.0, [2, 2]);
/// const CUBE_MESH: Mesh = CUBE.mesh();
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// let (mut pixels, mut depth) = ([0; 64 * 8], [0; 64 * 8]);
/// let mut band = Band::<Rgb565, Depth16>::new(Size::new(64, 8), &mut pixels, &mut depth)?;
/// let camera = Camera::perspective(Turn::from_degrees(60), Size::new(64, 64)).at(Vec3::lit(0.0, 0.0, 5.0));
/// let mut memory = ListMemory::<24, 12>::new();
/// let mut changes = Changes::<8>::new(); // as many bands as the screen has
/// let mut flushed = Default::default();
/// for degrees in [0, 5] {
///     let pose = Pose::IDENTITY.rotated_y(Turn::from_degrees(degrees));
///     let mut list = DisplayList::<Rgb565, Depth16, 1>::new(&mut memory);
///     camera.draw(&CUBE_MESH, &pose, &Material::flat(Rgb565::RED), &mut list)?;
///     flushed = list.render_changed(64, &Rgb565::BLACK, &mut band, &mut changes, |area, band| {
///         // display.fill_contiguous(&area, band.colors_in(&area))
/// #       assert_eq!(band.colors_in(&area).count() as u32, area.size.width * area.size.height);
///         Ok::<_, core::convert::Infallible>(())
///     })?;
/// }
/// assert!(flushed.bands <= 3); // of the second frame: those with the cube
/// assert!(flushed.pixels < 500); // of 4096
/// # Ok(())
/// # }
/// ```
#[derive(Clone, Debug)]
pub struct Changes<const BANDS: usize> {
    /// For each band the area that the last frame drew to.
    last: [Extent; BANDS],
    /// The area that is to be sent with the next frame in any case.
    marked: Extent,
    /// The size of a band, and the height of the screen.
    shape: (Size, u32),
}

/// How much of a screen [`DisplayList::render_changed`] drew and flushed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Flushed {
    /// Bands that were drawn.
    pub bands: u32,
    /// Bands of the screen.
    pub all_bands: u32,
    /// Pixels in the areas that were flushed.
    pub pixels: u32,
    /// Pixels of the screen.
    pub all_pixels: u32,
}

impl<const BANDS: usize> Changes<BANDS> {
    /// Before the first frame: everything is to be sent.
    #[must_use]
    pub const fn new() -> Self {
        Self { last: [Extent::NONE; BANDS], marked: Extent::ALL, shape: (Size::zero(), 0) }
    }

    /// Has the next frame drawn and sent whole.
    pub const fn everything(&mut self) {
        self.marked = Extent::ALL;
    }

    /// Has an area of the screen sent with the next frame, whatever is drawn there. Of several areas it is the smallest rectangle
    /// around all of them.
    pub fn mark(&mut self, area: &Rectangle) {
        let side = |start: i32, length: u32| {
            let end = (i64::from(start) + i64::from(length)).clamp(0, i16::MAX.into());
            (start.clamp(0, i16::MAX.into()) as i16, end as i16)
        };
        let (left, right) = side(area.top_left.x, area.size.width);
        let (top, bottom) = side(area.top_left.y, area.size.height);
        self.marked = self.marked.union(Extent { left, right, top, bottom });
    }
}

impl<const BANDS: usize> Default for Changes<BANDS> {
    fn default() -> Self {
        Self::new()
    }
}

impl<F: PixelFormat, D: DepthFormat, const N: usize> DisplayList<'_, F, D, N> {
    /// As [`DisplayList::render_bands`], without what is on the display already. Bands in which nothing changed are skipped.
    /// For each of the others `flush` gets the rectangle that changed; [`Band::colors_in`] and [`Band::rows_in`] give its
    /// pixels.
    ///
    /// Bands beyond the first `BANDS` are drawn and flushed whole.
    ///
    /// # Errors
    ///
    /// The first of `flush`. The rest is not drawn then; the next frame is drawn and sent whole.
    pub fn render_changed<'b, const BANDS: usize, E>(
        &self,
        height: u32,
        background: &impl Background<F>,
        band: &mut Band<'b, F, D>,
        changes: &mut Changes<BANDS>,
        mut flush: impl FnMut(Rectangle, &mut Band<'b, F, D>) -> Result<(), E>,
    ) -> Result<Flushed, E> {
        let shape = (band.size(), height);
        if changes.shape != shape {
            changes.shape = shape;
            changes.everything();
        }
        let (mut flushed, mut top, mut number) = (Flushed::default(), 0, 0);
        while band.move_to_part(top, height) {
            let window = band.window();
            let size = band.size();
            let drawn = self.extent(&window);
            let last = changes.last.get_mut(number);
            let changed = last.as_deref().copied().unwrap_or(Extent::ALL);
            let changed = changed.union(drawn).union(changes.marked.within(&window)).within(&window);
            flushed.all_bands += 1;
            flushed.all_pixels += size.width * size.height;
            let area = changed.rectangle();
            if !changed.is_empty() {
                flushed.bands += 1;
                flushed.pixels += area.size.width * area.size.height;
                band.clear_to(background);
                self.render(top, band);
                if let Err(error) = flush(area, band) {
                    changes.everything();
                    band.all_rows();
                    return Err(error);
                }
            }
            if let Some(last) = last {
                *last = drawn;
            }
            top += size.height;
            number += 1;
        }
        changes.marked = Extent::NONE;
        Ok(flushed)
    }
}
