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
use super::channel::luma;
use super::depth::DepthFormat;
use super::format::PixelFormat;
use super::window::overlap;
use core::fmt;
use core::marker::PhantomData;
use embedded_graphics::geometry::Point;
use embedded_graphics::pixelcolor::{
    Bgr565, Bgr888, BinaryColor, Gray2, Gray4, Gray8, PixelColor, Rgb565, Rgb666, Rgb888, RgbColor,
};
use embedded_graphics::primitives::Rectangle;

/// A colour of a display that has fewer bits than the pixels of a band: made of 8-bit channels by a [`Threshold`].
///
/// Of embedded-graphics' colours these are: [`BinaryColor`], [`Gray2`], [`Gray4`], [`Gray8`] (by the luma of ITU-R BT.601), [`Rgb565`],
/// [`Bgr565`], [`Rgb666`], [`Rgb888`], [`Bgr888`]. For another display, of three inks say, implement it for its colour type:
///
/// ```
/// use fixel::embedded_graphics::{pixelcolor::{Rgb888, raw::RawU2}, prelude::*};
/// use fixel::{Quantize, Threshold};
/// #[derive(Clone, Copy, PartialEq)]
/// enum Ink { White, Black, Red }
/// # impl PixelColor for Ink { type Raw = RawU2; }
/// impl Quantize for Ink {
///     fn quantize(color: Rgb888, threshold: Threshold) -> Self {
///         match [color.r(), color.g()].map(|level| threshold.is_below(level)) {
///             [true, true] => Self::White,
///             [true, false] => Self::Red,
///             _ => Self::Black,
///         }
///     }
/// }
/// ```
#[diagnostic::on_unimplemented(
    message = "a band cannot be sent in `{Self}`",
    label = "a band is sent in `BinaryColor`, `Gray2`, `Gray4`, `Gray8`, `Rgb565`, `Bgr565`, `Rgb666`, `Rgb888` or `Bgr888`",
    note = "for another display implement `Quantize` for its colour type"
)]
pub trait Quantize: PixelColor {
    /// The colour of a pixel with this threshold.
    fn quantize(color: Rgb888, threshold: Threshold) -> Self;
}

/// Whether a pixel is rounded up or down: it is up where what is left above a whole level, in 255ths, is greater.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Threshold(u8);

impl Threshold {
    /// A threshold of 0 … 254, to which it is limited: 127 rounds to the nearest.
    #[inline]
    #[must_use]
    pub const fn new(threshold: u8) -> Self {
        Self(if threshold < 254 { threshold } else { 254 })
    }

    /// Whether an 8-bit level is greater.
    #[inline]
    #[must_use]
    pub const fn is_below(self, level: u8) -> bool {
        level > self.0
    }

    /// An 8-bit level as one of 0 … `most`: level · most / 255, rounded up or down.
    ///
    /// A level that is the nearest of 255 to one of `most` becomes that one, whatever the threshold: RGB565 that was stored in 8 bits
    /// a channel comes back as it was. The mean of what [`Band::dithered`] makes is off by 1/128 of a step; and by half of 1/255, which is
    /// what 8 bits leave open, where 255 is no multiple of `most`.
    #[inline(always)]
    #[must_use]
    pub const fn level(self, level: u8, most: u8) -> u8 {
        let (most, threshold) = (most as u32, self.0 as u32);
        // How far, in 255ths of a step, a whole level may be from its nearest of 255.
        let slack = if matches!(most, 0 | 1 | 3 | 5 | 15 | 17 | 51 | 85 | 255) { 0 } else { most / 2 };
        let threshold =
            if slack == 0 { threshold } else { slack + ((threshold * (255 - 2 * slack) + 128) >> 8) };
        let sum = level as u32 * most + 254 - threshold;
        // A 255th of it, rounded down: exact for sums of 16 bits.
        ((sum + 1 + (sum >> 8)) >> 8) as u8
    }
}

impl Quantize for BinaryColor {
    #[inline]
    fn quantize(color: Rgb888, threshold: Threshold) -> Self {
        threshold.is_below(luma_of(color)).into()
    }
}

macro_rules! grays {
    ($($gray:ident $most:literal;)*) => {$(
        impl Quantize for $gray {
            #[inline]
            fn quantize(color: Rgb888, threshold: Threshold) -> Self {
                Self::new(threshold.level(luma_of(color), $most))
            }
        }
    )*};
}

macro_rules! colors {
    ($($color:ident)*) => {$(
        impl Quantize for $color {
            #[inline]
            fn quantize(color: Rgb888, threshold: Threshold) -> Self {
                Self::new(
                    threshold.level(color.r(), Self::MAX_R),
                    threshold.level(color.g(), Self::MAX_G),
                    threshold.level(color.b(), Self::MAX_B),
                )
            }
        }
    )*};
}

grays! { Gray2 3; Gray4 15; Gray8 255; }
colors! { Rgb565 Bgr565 Rgb666 Rgb888 Bgr888 }

#[inline(always)]
fn luma_of(color: Rgb888) -> u8 {
    luma::<255, 255>([color.r(), color.g(), color.b()].map(u32::from))
}

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
    /// A curve for contrast is one line before it, in a band of [`Gray8`]: `for level in band.pixels_mut() { *level = CURVE[*level as
    /// usize]; }`, with a `static CURVE: [u8; 256]`.
    #[inline]
    #[must_use]
    pub fn dithered<C: Quantize>(&self) -> Quantized<'_, F, C>
    where
        F::Color: Into<Rgb888>,
    {
        self.by(&BAYER)
    }

    /// The pixels in the nearest colours of a display that has fewer bits, undithered: of [`BinaryColor`] what is brighter than 127 of 255
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

/// A word's colour on a display, by a threshold.
#[inline(always)]
pub(super) fn quantize<F: PixelFormat, C: Quantize>(word: F::Word, threshold: u8) -> C
where
    F::Color: Into<Rgb888>,
{
    C::quantize(F::decode(word).into(), Threshold(threshold))
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
        Some(quantize::<F, C>(*word, threshold))
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
