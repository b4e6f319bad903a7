//! Masks: which texels of a cut-out texture are there.

use core::fmt;

/// A borrowed picture of one bit a texel, of 2^w × 2^h texels, w and h from 0 to 10: a texel is there where its bit is 1.
///
/// Rows go from the top, each in whole bytes, the leftmost texel in the upper bit: as embedded-graphics' `ImageRaw<BinaryColor>`
/// has them. A mask repeats as textures do. It may be smaller than the texture that it cuts.
///
/// ```
/// use fixel::Mask;
/// static HOLES: Mask = Mask::new(&[0b1010_0000, 0b0101_0000, 0b1010_0000, 0b0101_0000], 2, 2);
/// # let _ = HOLES;
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Mask<'a> {
    bits: &'a [u8],
    log2_width: u8,
    log2_height: u8,
}

impl<'a> Mask<'a> {
    /// A mask in a `const` or `static`: a wrong length is a compile error.
    ///
    /// # Panics
    ///
    /// Outside a `const`, as [`Mask::try_new`] fails.
    #[must_use]
    pub const fn new(bits: &'a [u8], log2_width: u32, log2_height: u32) -> Self {
        match Self::try_new(bits, log2_width, log2_height) {
            Ok(mask) => mask,
            Err(MaskError::TooLarge) => panic!("a side of a mask is at most 1024 texels"),
            Err(MaskError::Length { .. }) => panic!("the number of bytes is not that of the mask's rows"),
        }
    }

    /// A mask from data that comes at run time.
    ///
    /// # Errors
    ///
    /// [`MaskError`] if a side is longer than 1024, or `bits` is not ⌈width / 8⌉ × height bytes long.
    pub const fn try_new(bits: &'a [u8], log2_width: u32, log2_height: u32) -> Result<Self, MaskError> {
        if log2_width > 10 || log2_height > 10 {
            return Err(MaskError::TooLarge);
        }
        let expected = (((1usize << log2_width) + 7) >> 3) << log2_height;
        if bits.len() != expected {
            return Err(MaskError::Length { expected, found: bits.len() });
        }
        Ok(Self { bits, log2_width: log2_width as u8, log2_height: log2_height as u8 })
    }

    /// Whether the texel at whole texel coordinates of any size is there, repeated.
    #[inline]
    pub(crate) fn is_there(&self, u: i32, v: i32) -> bool {
        let u = u as u32 & ((1 << self.log2_width) - 1);
        let v = v as u32 & ((1 << self.log2_height) - 1);
        let byte = (v << self.log2_width.saturating_sub(3)) + (u >> 3);
        let bits = self.bits.get(byte as usize).copied().unwrap_or_default();
        bits << (u & 7) & 0x80 != 0
    }
}

/// The same bits in memory, seen in the same size: their values are not compared.
impl PartialEq for Mask<'_> {
    fn eq(&self, other: &Self) -> bool {
        core::ptr::eq(self.bits, other.bits)
            && self.log2_width == other.log2_width
            && self.log2_height == other.log2_height
    }
}

impl Eq for Mask<'_> {}

/// What is wrong with the bits of a mask.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MaskError {
    /// A side is longer than 1024 texels.
    TooLarge,
    /// There are too few or too many bytes.
    Length {
        /// ⌈width / 8⌉ × height.
        expected: usize,
        /// The number of bytes given.
        found: usize,
    },
}

impl fmt::Display for MaskError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::TooLarge => write!(f, "a side of a mask is at most 1024 texels"),
            Self::Length { expected, found } => {
                write!(f, "the mask needs {expected} bytes, but {found} were given")
            }
        }
    }
}

impl core::error::Error for MaskError {}
