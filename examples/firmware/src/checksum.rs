//! Checksums of a frame, fed band by band from the top: CRC-32 as in IEEE 802.3, zlib and PNG.

use core::fmt;

use crc::{CRC_32_ISO_HDLC, Crc, Digest, Table};
use embedded_graphics::pixelcolor::Gray4;

use crate::gray4;

static CRC: Crc<u32, Table<1>> = Crc::<u32, Table<1>>::new(&CRC_32_ISO_HDLC);

/// The checksum of a frame's RGB565 words as little-endian bytes, whatever the machine's own order.
pub struct Rgb565Sum(Digest<'static, u32, Table<1>>);

/// The checksum of a frame's grey levels as the display gets them, two pixels a byte.
pub struct Gray4Sum(Digest<'static, u32, Table<1>>);

impl Rgb565Sum {
    /// Begins a frame.
    #[must_use]
    pub fn new() -> Self {
        Self(CRC.digest())
    }

    /// Takes in the frame's next rows.
    pub fn add(&mut self, words: &[u16]) {
        for word in words {
            self.0.update(&word.to_le_bytes());
        }
    }

    /// Ends the frame.
    #[must_use]
    pub fn finish(self) -> u32 {
        self.0.finalize()
    }
}

impl Gray4Sum {
    /// Begins a frame.
    #[must_use]
    pub fn new() -> Self {
        Self(CRC.digest())
    }

    /// Takes in the frame's next rows; their width is even, so that a byte holds two pixels of a row.
    pub fn add(&mut self, levels: impl IntoIterator<Item = Gray4>) {
        let mut levels = levels.into_iter();
        while let (Some(left), Some(right)) = (levels.next(), levels.next()) {
            self.0.update(&[gray4::pack(left, right)]);
        }
    }

    /// Ends the frame.
    #[must_use]
    pub fn finish(self) -> u32 {
        self.0.finalize()
    }
}

impl Default for Rgb565Sum {
    fn default() -> Self {
        Self::new()
    }
}

impl Default for Gray4Sum {
    fn default() -> Self {
        Self::new()
    }
}

impl fmt::Debug for Rgb565Sum {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Rgb565Sum").finish_non_exhaustive()
    }
}

impl fmt::Debug for Gray4Sum {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Gray4Sum").finish_non_exhaustive()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The check value of the CRC catalogue: the sum of the digits "123456789" is CBF43926.
    #[test]
    fn the_polynomial_is_that_of_ieee_802_3() {
        let mut sum = Gray4Sum::new();
        for byte in b"123456789" {
            sum.add([Gray4::new(byte >> 4), Gray4::new(byte & 15)]);
        }
        assert_eq!(sum.finish(), 0xCBF4_3926);
    }

    #[test]
    fn words_are_summed_as_little_endian_bytes() {
        let mut words = Rgb565Sum::new();
        words.add(&[0x3231, 0x3433]);
        words.add(&[0x3635]);
        let mut bytes = CRC.digest();
        bytes.update(b"123456");
        assert_eq!(words.finish(), bytes.finalize());
    }
}
