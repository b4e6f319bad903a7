//! Colours of few bits on the way out: each is rounded up or down by a pattern that stays on the screen.
//!
//! - In: a band, and the colour type of a display.
//! - Out: the display's colours, row after row.
//! - Assumes: nothing.
//!
//! Dithering comes last, when rows are sent. So all surfaces, blending, fog and 2D drawing are dithered alike, and none of them
//! knows of it.

use super::band::Band;
use super::bayer::BAYER;
use super::depth::DepthFormat;
use super::format::PixelFormat;
use super::threshold::{Quantize, Threshold};
use super::window::overlap;
use core::fmt;
use core::marker::PhantomData;
use embedded_graphics::geometry::Point;
use embedded_graphics::pixelcolor::Rgb888;
use embedded_graphics::primitives::Rectangle;

/// Rounds to the nearest, everywhere.
static NEAREST: [[u8; 8]; 8] = [[127; 8]; 8];

/// The pixels of a band as a display of fewer bits has them: [`Band::dithered`] and [`Band::quantized`] make it.
///
/// It turns into an iterator of colours, row after row, for `fill_contiguous` of any display. For a display that takes bytes
/// [`pack_rows`](Self::pack_rows) and [`pack_pages`](Self::pack_pages) write them.
pub struct Quantized<'b, F: PixelFormat, C> {
    /// From the first pixel of the first row on.
    words: &'b [F::Word],
    /// From a row to the next, in words.
    stride: usize,
    /// Where it lies on the screen.
    pub(super) x: usize,
    pub(super) y: usize,
    pub(super) width: usize,
    pub(super) height: usize,
    pattern: &'static [[u8; 8]; 8],
    color: PhantomData<fn() -> C>,
}

impl<F: PixelFormat, D: DepthFormat> Band<'_, F, D> {
    /// The pixels in the colours of a display that has fewer bits, by ordered dithering: with Bayer's pattern of 8×8, which stays on the
    /// screen, whatever the band's height. What the display can show exactly it shows; black and white stay what they are.
    ///
    /// ```
    /// use fixel::{Band, Depth16};
    /// use fixel::embedded_graphics::{framebuffer::{Framebuffer, buffer_size}, prelude::*};
    /// use fixel::embedded_graphics::pixelcolor::{BinaryColor, Gray8, raw::{LittleEndian, RawU1}};
    /// # let mut display = Framebuffer::<BinaryColor, RawU1, LittleEndian, 128, 64, { buffer_size::<BinaryColor>(128, 64) }>::new();
    /// let (mut pixels, mut depth) = ([0; 128 * 8], [0; 128 * 8]); // 3 KiB
    /// let mut band = Band::<Gray8, Depth16>::new(Size::new(128, 8), &mut pixels, &mut depth)?;
    /// let Ok(()) = band.clear(Gray8::new(128));
    /// display.fill_contiguous(&band.bounding_box(), band.dithered::<BinaryColor>())?; // to any monochrome display
    /// let mut page = [0; 128];
    /// let bytes = band.dithered::<BinaryColor>().pack_pages(&mut page)?; // or to an SSD1306, as its memory has it
    /// assert_eq!(bytes.iter().map(|byte| byte.count_ones()).sum::<u32>(), 128 * 8 / 2);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// A curve for contrast is one line before it, in a band of `Gray8`: `for level in band.pixels_mut() { *level = CURVE[*level as
    /// usize]; }`, with a `static CURVE: [u8; 256]`.
    #[inline]
    #[must_use]
    pub fn dithered<C: Quantize>(&self) -> Quantized<'_, F, C>
    where
        F::Color: Into<Rgb888>,
    {
        self.by(&BAYER)
    }

    /// The pixels in the nearest colours of a display that has fewer bits, undithered: of [`BinaryColor`](embedded_graphics::pixelcolor::BinaryColor) what is brighter than 127 of 255
    /// is lit. For line drawings and text.
    #[inline]
    #[must_use]
    pub fn quantized<C: Quantize>(&self) -> Quantized<'_, F, C>
    where
        F::Color: Into<Rgb888>,
    {
        self.by(&NEAREST)
    }

    #[inline]
    fn by<C>(&self, pattern: &'static [[u8; 8]; 8]) -> Quantized<'_, F, C> {
        let [width, height] = [self.size().width, self.size().height].map(|side| side as usize);
        let (words, y) = (self.pixels(), usize::from(self.top));
        Quantized { words, stride: width, x: 0, y, width, height, pattern, color: PhantomData }
    }
}

impl<'b, F: PixelFormat, C> Quantized<'b, F, C> {
    /// That part of it that lies in an area of the screen, such as one that changed. Each pixel is what it was.
    #[must_use]
    pub fn within(self, area: &Rectangle) -> Self {
        let Point { x, y } = area.top_left;
        let columns = overlap(x, area.size.width, self.x as i32..(self.x + self.width) as i32);
        let rows = overlap(y, area.size.height, self.y as i32..(self.y + self.height) as i32);
        let (Some(columns), Some(rows)) = (columns, rows) else {
            return Self { words: &[], width: 0, height: 0, ..self };
        };
        let (x, y) = (columns.start as usize, rows.start as usize);
        let words = self.words.get((y - self.y) * self.stride + (x - self.x)..).unwrap_or_default();
        Self { words, x, y, width: columns.len(), height: rows.len(), ..self }
    }

    /// The rows: words, and the thresholds of their pixels, of the first pixel first.
    #[inline]
    pub(super) fn rows(&self) -> impl Iterator<Item = (&'b [F::Word], [u8; 8])> + use<'b, F, C> {
        let Self { mut words, stride, x, y, width, height, pattern, .. } = *self;
        (y..y + height).map(move |y| {
            let row = words.get(..width).unwrap_or_default();
            words = words.get(stride..).unwrap_or_default();
            let pattern = pattern[y & 7];
            (row, core::array::from_fn(|i| pattern[(x + i) & 7]))
        })
    }
}

impl<'b, F: PixelFormat, C: Quantize> IntoIterator for Quantized<'b, F, C>
where
    F::Color: Into<Rgb888>,
{
    type Item = C;
    type IntoIter = QuantizedColors<'b, F, C>;

    #[inline]
    fn into_iter(self) -> QuantizedColors<'b, F, C> {
        QuantizedColors { row: [].iter(), thresholds: [0; 8], column: 0, rest: self }
    }
}

/// The colours of a [`Quantized`], row after row.
pub struct QuantizedColors<'b, F: PixelFormat, C> {
    /// What is left of a row, and the thresholds of it.
    row: core::slice::Iter<'b, F::Word>,
    thresholds: [u8; 8],
    column: usize,
    /// The rows below.
    rest: Quantized<'b, F, C>,
}

impl<F: PixelFormat, C: Quantize> Iterator for QuantizedColors<'_, F, C>
where
    F::Color: Into<Rgb888>,
{
    type Item = C;

    #[inline]
    fn next(&mut self) -> Option<C> {
        let word = match self.row.next() {
            Some(word) => word,
            None => {
                let (row, thresholds) = self.rest.rows().next()?;
                self.rest.words = self.rest.words.get(self.rest.stride..).unwrap_or_default();
                (self.rest.y, self.rest.height) = (self.rest.y + 1, self.rest.height - 1);
                (self.row, self.thresholds, self.column) = (row.iter(), thresholds, 0);
                self.row.next()?
            }
        };
        let threshold = self.thresholds[self.column & 7];
        self.column += 1;
        Some(F::quantize(*word, Threshold(threshold)))
    }

    #[inline]
    fn size_hint(&self) -> (usize, Option<usize>) {
        let left = self.row.len() + self.rest.width * self.rest.height;
        (left, Some(left))
    }
}

impl<F: PixelFormat, C: Quantize> ExactSizeIterator for QuantizedColors<'_, F, C> where F::Color: Into<Rgb888> {}

impl<F: PixelFormat, C> Clone for Quantized<'_, F, C> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<F: PixelFormat, C> Copy for Quantized<'_, F, C> {}

impl<F: PixelFormat, C> Clone for QuantizedColors<'_, F, C> {
    fn clone(&self) -> Self {
        Self { row: self.row.clone(), ..*self }
    }
}

impl<F: PixelFormat, C> fmt::Debug for Quantized<'_, F, C> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Quantized")
            .field("x", &self.x)
            .field("y", &self.y)
            .field("width", &self.width)
            .field("height", &self.height)
            .finish_non_exhaustive()
    }
}

impl<F: PixelFormat, C> fmt::Debug for QuantizedColors<'_, F, C> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("QuantizedColors").field("rest", &self.rest).finish_non_exhaustive()
    }
}
