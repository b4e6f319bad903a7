//! A band: some rows of the screen, or all of them, in memory that the user owns.
//!
//! - In: memory for pixels and depths, and which rows of the screen they are.
//! - Out: the words of these rows, as pixels, colours or bytes, for a display.
//! - Assumes: nothing; memory that is too short is an error.
//!
//! A *word* is one pixel in memory, in the band's pixel format.

use super::background::Background;
use super::depth::DepthFormat;
use super::format::PixelFormat;
use super::window::Window;
use core::fmt;
use embedded_graphics::geometry::Size;

/// A strip of rows of a screen, or the whole screen, in memory that the user owns.
///
/// It is an embedded-graphics [`DrawTarget`](embedded_graphics::draw_target::DrawTarget) in the coordinates of the whole screen:
/// what lies outside its rows is not drawn. At first it contains what the memory did. Begin each picture with
/// [`clear`](embedded_graphics::draw_target::DrawTarget::clear) or [`Band::clear_to`], which forget depths too. (The `clear` of a
/// part, of a target that is `clipped` or `cropped`, is a `fill_solid` in embedded-graphics: it keeps depth.) To send one band by
/// DMA while another is drawn, see [`Band::swap_pixels`]. [`memory`](crate::guide::memory) has how many rows it wants.
///
/// ```
/// use fixel::{Band, Depth16};
/// use fixel::embedded_graphics::{pixelcolor::Rgb565, prelude::*};
/// let (mut pixels, mut depth) = ([0; 64 * 16], [0; 64 * 16]);
/// let mut band = Band::<Rgb565, Depth16>::new(Size::new(64, 16), &mut pixels, &mut depth)?.starting_at(32);
/// let Ok(()) = band.clear(Rgb565::BLUE);
/// assert_eq!(band.bounding_box().top_left, Point::new(0, 32));
/// # Ok::<(), fixel::TargetError>(())
/// ```
pub struct Band<'a, F: PixelFormat, D: DepthFormat> {
    /// The pixels, row after row: `width` · `rows` words.
    pub(crate) pixels: &'a mut [F::Word],
    /// The depths, row after row: as many words, or any number if depth is never tested.
    pub(crate) depth: &'a mut [D::Word],
    pub(crate) width: u16,
    /// How many rows there is memory for.
    rows: u16,
    /// How many of them are in use: all, but at the bottom of a screen there may be fewer.
    height: u16,
    /// The screen row of the first row.
    pub(crate) top: u16,
}

/// The longest side of a target, in pixels. Edge functions have to fit an `i32`. That limits the guard band, and so the screen.
const MAX_SIDE: u32 = 1023;

impl<'a, F: PixelFormat, D: DepthFormat> Band<'a, F, D> {
    /// A band of `size` pixels in the first width × height words of the two slices.
    ///
    /// [`NoDepth`](super::NoDepth) takes any slice of `()`: `&mut []`.
    ///
    /// # Errors
    ///
    /// [`TargetError`] if a side is longer than 1023 or a slice too short.
    pub fn new(size: Size, pixels: &'a mut [F::Word], depth: &'a mut [D::Word]) -> Result<Self, TargetError> {
        if size.width > MAX_SIDE || size.height > MAX_SIDE {
            return Err(TargetError::TooLarge);
        }
        let needed = (size.width * size.height) as usize;
        let found = pixels.len();
        let pixels = pixels.get_mut(..needed).ok_or(TargetError::Pixels { needed, found })?;
        let found = depth.len();
        // Depth that is never tested needs no memory.
        let needed = if D::ALWAYS_PASSES { needed.min(found) } else { needed };
        let depth = depth.get_mut(..needed).ok_or(TargetError::Depth { needed, found })?;
        let (width, rows) = (size.width as u16, size.height as u16);
        Ok(Self { pixels, depth, width, rows, height: rows, top: 0 })
    }

    /// Makes this the band of the rows from `row` on (at most 1023) of a taller screen; the contents stay.
    #[must_use]
    pub fn starting_at(mut self, row: u32) -> Self {
        self.move_to(row);
        self
    }

    /// As [`Band::starting_at`], in place.
    pub fn move_to(&mut self, row: u32) {
        self.top = row.min(MAX_SIDE) as u16;
    }

    /// Width and height in pixels.
    #[must_use]
    pub const fn size(&self) -> Size {
        Size::new(self.width as u32, self.height as u32)
    }

    /// Forgets all depths: what is drawn next is in front. Colours stay.
    pub fn clear_depth(&mut self) {
        D::clear(self.depth);
    }

    /// The pixels' words, row after row.
    #[must_use]
    pub fn pixels(&self) -> &[F::Word] {
        self.pixels.get(..self.len()).unwrap_or_default()
    }

    /// The pixels' words, row after row, to be changed.
    pub fn pixels_mut(&mut self) -> &mut [F::Word] {
        let length = self.len();
        self.pixels.get_mut(..length).unwrap_or_default()
    }

    /// The depths, as [`Band::depth`] has them, to be changed.
    pub fn depth_mut(&mut self) -> &mut [D::Word] {
        let length = self.len().min(self.depth.len());
        self.depth.get_mut(..length).unwrap_or_default()
    }

    /// How many pixels are in use.
    fn len(&self) -> usize {
        usize::from(self.width) * usize::from(self.height)
    }

    /// The depths, row after row. If depth is never tested there may be fewer than pixels: those that [`Band::new`] was given.
    #[must_use]
    pub fn depth(&self) -> &[D::Word] {
        self.depth.get(..self.len()).unwrap_or(self.depth)
    }

    /// The pixels' colours, row after row, for
    /// [`fill_contiguous`](embedded_graphics::draw_target::DrawTarget::fill_contiguous) of a display.
    #[must_use]
    pub fn colors(&self) -> impl ExactSizeIterator<Item = F::Color> {
        self.pixels().iter().map(|&word| F::decode(word))
    }

    /// The pixels' bytes as they stand in memory, for a display's bus.
    #[must_use]
    pub fn as_bytes(&self) -> &[u8]
    where
        F::Word: bytemuck::NoUninit,
    {
        bytemuck::must_cast_slice(self.pixels())
    }

    /// Clears the pixels to a background, and all depths.
    pub fn clear_to(&mut self, background: &impl Background<F>) {
        let top = u32::from(self.top);
        let mut rest = &mut *self.pixels;
        // Not by `chunks_exact_mut`, which divides.
        for y in top..top + u32::from(self.height) {
            let Some((row, others)) = rest.split_at_mut_checked(self.width.into()) else {
                break;
            };
            background.fill_row(y, row);
            rest = others;
        }
        self.clear_depth();
    }

    /// Makes this the band of the rows from `top` on of a screen of `height` rows: as many as there is memory for, or as are left
    /// of the screen. If none is left it returns false, and all rows that there is memory for are in use again.
    pub(crate) fn move_to_part(&mut self, top: u32, height: u32) -> bool {
        let rows = height.min(MAX_SIDE).saturating_sub(top).min(self.rows.into());
        self.move_to(top);
        self.height = if rows > 0 { rows as u16 } else { self.rows };
        rows > 0
    }

    /// Takes all rows into use again that there is memory for, after [`Band::move_to_part`].
    pub(crate) fn all_rows(&mut self) {
        self.height = self.rows;
    }

    /// It is an embedded-graphics [`DrawTarget`](embedded_graphics::draw_target::DrawTarget) in the coordinates of the whole screen:
    /// what lies outside its rows is not drawn. At first it contains what the memory did. Begin each picture with
    /// [`clear`](embedded_graphics::draw_target::DrawTarget::clear) or [`Band::clear_to`], which forget depths too. (The `clear` of a
    /// part, of a target that is `clipped` or `cropped`, is a `fill_solid` in embedded-graphics: it keeps depth.) To send one band by
    /// DMA while another is drawn, see [`Band::swap_pixels`].
    ///
    /// In a band of static memory both are a `&'static mut [u16]`, which a channel may own until it is done. As bytes in
    /// [`BigEndian`](super::BigEndian) order that is a `ReadBuffer` of `embedded-dma`, with no bytes to be swapped on the way.
    /// For a channel that moves words of 4 bytes, put the array in a `#[repr(align(4))]` struct.
    ///
    /// ```
    /// use fixel::embedded_graphics::{pixelcolor::Rgb565, prelude::*};
    /// use fixel::{Band, BigEndian, NoDepth};
    /// # let memory = || &mut *Box::leak(Box::new([0; 240 * 16]));
    /// # let (one, other) = (memory(), memory());
    /// let mut free: &'static mut [u16] = other; // from a `StaticCell`, say, as is `one`
    /// let mut band = Band::<BigEndian<Rgb565>, NoDepth>::new(Size::new(240, 16), one, &mut [])?;
    /// let Ok(()) = band.clear(Rgb565::RED);
    /// band.swap_pixels(&mut free)?;
    /// let bytes: &'static mut [u8] = bytemuck::cast_slice_mut(free); // for the channel
    /// assert_eq!(bytes[..4], [0xf8, 0x00, 0xf8, 0x00]);
    /// # Ok::<(), fixel::TargetError>(())
    /// ```
    ///
    /// # Errors
    ///
    /// [`TargetError::Pixels`] if `pixels` has fewer words than the band has memory for; nothing has changed then. If it has
    /// more, only the first so many are taken, and come back later.
    pub fn swap_pixels(&mut self, pixels: &mut &'a mut [F::Word]) -> Result<(), TargetError> {
        let (needed, found) = (self.pixels.len(), pixels.len());
        if found < needed {
            return Err(TargetError::Pixels { needed, found });
        }
        let (others, _) = core::mem::take(pixels).split_at_mut(needed);
        *pixels = core::mem::replace(&mut self.pixels, others);
        Ok(())
    }

    /// The memory of pixels and depths, for another use. That of a static band is `'static` still, as a DMA channel needs it.
    #[must_use]
    pub fn into_slices(self) -> (&'a mut [F::Word], &'a mut [D::Word]) {
        (self.pixels, self.depth)
    }

    /// The part of the screen that is in use.
    pub(crate) fn window(&self) -> Window {
        let top = i32::from(self.top);
        Window { columns: 0..i32::from(self.width), rows: top..top + i32::from(self.height) }
    }
}

impl<F: PixelFormat, D: DepthFormat> fmt::Debug for Band<'_, F, D> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Band")
            .field("width", &self.width)
            .field("height", &self.height)
            .field("top", &self.top)
            .finish_non_exhaustive()
    }
}

/// What is wrong with a target's size or memory.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TargetError {
    /// A side is longer than 1023 pixels.
    TooLarge,
    /// There are too few pixel words.
    Pixels {
        /// Width × height.
        needed: usize,
        /// The words given.
        found: usize,
    },
    /// There are too few depth words.
    Depth {
        /// Width × height.
        needed: usize,
        /// The words given.
        found: usize,
    },
}

impl fmt::Display for TargetError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::TooLarge => write!(f, "a side of a target is at most 1023 pixels"),
            Self::Pixels { needed, found } => {
                write!(f, "the target needs {needed} pixels, but {found} were given")
            }
            Self::Depth { needed, found } => {
                write!(f, "the target needs {needed} depths, but {found} were given")
            }
        }
    }
}

impl core::error::Error for TargetError {}
