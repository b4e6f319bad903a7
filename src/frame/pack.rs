//! Packing: pixels of 4, 2 and 1 bit as the bytes that a display's memory takes.
//!
//! - In: the pixels of a band in colours of few bits, and the caller's buffer.
//! - Out: bytes, row after row or in pages of eight rows.
//! - Assumes: nothing; a buffer that is too short is an error.

use super::format::PixelFormat;
use super::quantize::Quantized;
use super::threshold::{Quantize, Threshold};
use core::fmt;
use embedded_graphics::pixelcolor::{BinaryColor, IntoStorage, Rgb888};
use embedded_graphics::prelude::RawData;

/// Rows in a page.
const PAGE: usize = 8;

impl<F: PixelFormat, C: Quantize> Quantized<'_, F, C>
where
    F::Color: Into<Rgb888>,
{
    /// Writes rows of bytes, the left pixel of each in the most significant bits, and returns those that were written. For displays
    /// of 4 bits a pixel (SSD1322, SSD1327), of 2, and of 1 (most e-paper: SSD1680, UC8151; ST7920).
    ///
    /// A row begins with a byte. So it takes width · bits / 8 bytes, rounded up; what is left of its last byte is 0.
    ///
    /// # Errors
    ///
    /// [`PackError::TooShort`] if the buffer is; nothing is written then.
    pub fn pack_rows<'m>(&self, bytes: &'m mut [u8]) -> Result<&'m mut [u8], PackError>
    where
        C: IntoStorage<Storage = u8>,
    {
        self.pack::<false>(bytes)
    }

    /// As [`Quantized::pack_rows`], with the left pixel in the least significant bits: for what sends these first (Sharp's memory
    /// LCDs), and the XBM format.
    ///
    /// # Errors
    ///
    /// As [`Quantized::pack_rows`].
    pub fn pack_rows_lsb_first<'m>(&self, bytes: &'m mut [u8]) -> Result<&'m mut [u8], PackError>
    where
        C: IntoStorage<Storage = u8>,
    {
        self.pack::<true>(bytes)
    }

    #[inline]
    fn pack<'m, const LSB_FIRST: bool>(&self, bytes: &'m mut [u8]) -> Result<&'m mut [u8], PackError>
    where
        C: IntoStorage<Storage = u8>,
    {
        let bits = <C::Raw as RawData>::BITS_PER_PIXEL;
        const { assert!(8 % <C::Raw as RawData>::BITS_PER_PIXEL == 0, "a pixel is packed in 1, 2, 4 or 8 bits") };
        let bytes_a_row = (self.width * bits).div_ceil(8);
        let bytes = part(bytes, bytes_a_row * self.height)?;
        let mut rest = &mut *bytes;
        for (row, thresholds) in self.rows() {
            let Some((line, others)) = rest.split_at_mut_checked(bytes_a_row) else {
                break;
            };
            // Eight pixels are as many bytes as a pixel has bits.
            let (eights, last) = row.as_chunks::<8>();
            let mut line = line.chunks_mut(bits);
            for (pixels, bytes) in eights.iter().zip(&mut line) {
                Self::pack_eight::<LSB_FIRST>(pixels, &thresholds, bytes);
            }
            if let (false, Some(bytes)) = (last.is_empty(), line.next()) {
                Self::pack_eight::<LSB_FIRST>(last, &thresholds, bytes);
            }
            rest = others;
        }
        Ok(bytes)
    }

    /// Packs eight pixels, or fewer.
    #[inline(always)]
    fn pack_eight<const LSB_FIRST: bool>(pixels: &[F::Word], thresholds: &[u8; 8], bytes: &mut [u8])
    where
        C: IntoStorage<Storage = u8>,
    {
        let bits = <C::Raw as RawData>::BITS_PER_PIXEL;
        let in_byte = 8 / bits;
        let pixels = pixels.chunks(in_byte).zip(thresholds.chunks(in_byte));
        for (byte, (pixels, thresholds)) in bytes.iter_mut().zip(pixels) {
            let mut packed = 0;
            for (i, (word, threshold)) in pixels.iter().zip(thresholds).enumerate() {
                let color: C = F::quantize(*word, Threshold(*threshold));
                let at = if LSB_FIRST { i } else { in_byte - 1 - i };
                packed |= color.into_storage() << (at * bits);
            }
            *byte = packed;
        }
    }
}

impl<F: PixelFormat> Quantized<'_, F, BinaryColor>
where
    F::Color: Into<Rgb888>,
{
    /// Writes pages of eight rows, a byte for each column, the upper pixel of the eight in the least significant bit; and returns what
    /// was written. For SSD1306, SH1106, ST7565, ST7567, PCD8544 and their like.
    ///
    /// It takes a width of bytes a page. Bits of rows below the last one are 0. The first row has to be that of a page, so that no
    /// byte has rows of two bands: make bands of 8, 16, … rows, and with
    /// [`render_changed`](crate::DisplayList::render_changed) send all rows of a band.
    ///
    /// # Errors
    ///
    /// [`PackError::BetweenPages`] if the first row of the screen that this is is no multiple of 8, [`PackError::TooShort`] if the
    /// buffer is; nothing is written then.
    pub fn pack_pages<'m>(&self, bytes: &'m mut [u8]) -> Result<&'m mut [u8], PackError> {
        if !self.y.is_multiple_of(PAGE) {
            return Err(PackError::BetweenPages { row: self.y });
        }
        let bytes = part(bytes, self.width * self.height.div_ceil(PAGE))?;
        bytes.fill(0);
        let mut rest = &mut *bytes;
        let mut bit = 0;
        for (row, thresholds) in self.rows() {
            // Eight at a time, so that each has its threshold at a place that is known.
            let (words, last_words) = row.as_chunks::<8>();
            let (bytes, last_bytes) = rest.get_mut(..self.width).unwrap_or_default().as_chunks_mut::<8>();
            let light = |bytes: &mut [u8], words: &[F::Word]| {
                for ((byte, word), threshold) in bytes.iter_mut().zip(words).zip(&thresholds) {
                    let color: BinaryColor = F::quantize(*word, Threshold(*threshold));
                    *byte |= u8::from(color.is_on()) << bit;
                }
            };
            bytes.iter_mut().zip(words).for_each(|(bytes, words)| light(bytes, words));
            light(last_bytes, last_words);
            bit += 1;
            if bit == PAGE {
                (rest, bit) = (rest.get_mut(self.width..).unwrap_or_default(), 0);
            }
        }
        Ok(bytes)
    }
}

/// The first bytes of a buffer.
fn part(bytes: &mut [u8], needed: usize) -> Result<&mut [u8], PackError> {
    let found = bytes.len();
    bytes.get_mut(..needed).ok_or(PackError::TooShort { needed, found })
}

/// Why pixels cannot be packed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PackError {
    /// The buffer is too short.
    TooShort {
        /// The bytes that the pixels take.
        needed: usize,
        /// The bytes given.
        found: usize,
    },
    /// Pages are of eight rows, and the first row to be packed begins none.
    BetweenPages {
        /// That row of the screen.
        row: usize,
    },
}

impl fmt::Display for PackError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::TooShort { needed, found } => {
                write!(f, "the pixels take {needed} bytes, but the buffer has {found}")
            }
            Self::BetweenPages { row } => {
                write!(f, "row {row} of the screen begins no page of eight rows")
            }
        }
    }
}

impl core::error::Error for PackError {}
