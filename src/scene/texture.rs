//! Textures: power-of-two pictures in flash.

use core::fmt;

/// A borrowed RGB565 picture of 2^w × 2^h texels, rows from the top, w and h from 0 to 10.
///
/// Texel (i, j) covers the coordinates i … i + 1, j … j + 1: [`coordinates`](crate::guide::coordinates) has a drawing. What lies
/// beyond the borders is the material's choice: the texture again and again ([`Material::textured`](crate::Material::textured)), its
/// border texels ([`Material::clamped`](crate::Material::clamped)), or the texture turned round at each border
/// ([`Material::mirrored`](crate::Material::mirrored)).
///
/// ```
/// use fixel::{Texture, texels};
/// // In firmware the bytes come from `include_bytes!`, and this runs in the compiler.
/// static CHECKS: Texture = Texture::new(&texels::<4>(&[0xff, 0xff, 0, 0, 0, 0, 0xff, 0xff]), 1, 1);
/// assert_eq!(CHECKS.size().width, 2);
/// ```
///
/// A wrong length does not compile:
///
/// ```compile_fail
/// # use fixel::Texture;
/// const BAD: Texture = Texture::new(&[0; 63], 3, 3);
/// # let _ = BAD;
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Texture<'a> {
    /// Native-endian RGB565 words.
    texels: &'a [u16],
    log2_width: u8,
    log2_height: u8,
    /// Coordinates may be packed if they are scaled by less than 2^this. (Of 16 bits, so that there is no gap behind it, and copies are
    /// made word by word.)
    packed_scales: u16,
    /// For packed coordinates, see the shaders of [`Material`](crate::Material).
    mask: u32,
    multiplier: u32,
}

/// The same texels in memory, seen in the same size: their values are not compared.
impl PartialEq for Texture<'_> {
    fn eq(&self, other: &Self) -> bool {
        core::ptr::eq(self.texels, other.texels) && self.log2() == other.log2()
    }
}

impl Eq for Texture<'_> {}

/// The largest log₂ of a side.
const MAX_LOG2: u32 = 10;

impl<'a> Texture<'a> {
    /// A texture in a `const` or `static`: a wrong length is a compile error.
    ///
    /// # Panics
    ///
    /// Outside a `const`, as [`Texture::try_new`] fails.
    #[must_use]
    pub const fn new(texels: &'a [u16], log2_width: u32, log2_height: u32) -> Self {
        match Self::try_new(texels, log2_width, log2_height) {
            Ok(texture) => texture,
            Err(TextureError::TooLarge) => panic!("a side of a texture is at most 1024 texels"),
            Err(TextureError::Length { .. }) => panic!("the number of texels is not width times height"),
        }
    }

    /// A texture from data that comes at run time.
    ///
    /// # Errors
    ///
    /// [`TextureError`] if a side is longer than 1024 or `texels` is not width × height long.
    pub const fn try_new(texels: &'a [u16], log2_width: u32, log2_height: u32) -> Result<Self, TextureError> {
        if log2_width > MAX_LOG2 || log2_height > MAX_LOG2 {
            return Err(TextureError::TooLarge);
        }
        let expected = 1 << (log2_width + log2_height);
        if texels.len() != expected {
            return Err(TextureError::Length { expected, found: texels.len() });
        }
        let (least, most) =
            if log2_width < log2_height { (log2_width, log2_height) } else { (log2_height, log2_width) };
        Ok(Self {
            texels,
            log2_width: log2_width as u8,
            log2_height: log2_height as u8,
            packed_scales: if least >= 1 && most <= 8 { least as u16 + 1 } else { 0 },
            mask: (0xffff_0000 << (16 - log2_height)) | (((1 << log2_width) - 1) << (16 - log2_width)),
            multiplier: 1 + (1 << (16 - log2_height)),
        })
    }

    /// Width and height in texels.
    #[must_use]
    pub const fn size(&self) -> embedded_graphics::geometry::Size {
        embedded_graphics::geometry::Size::new(1 << self.log2_width, 1 << self.log2_height)
    }

    /// log₂ of width and height.
    pub(crate) const fn log2(&self) -> [u32; 2] {
        [self.log2_width as u32, self.log2_height as u32]
    }

    pub(crate) const fn texels(&self) -> &'a [u16] {
        self.texels
    }

    /// What leaves of packed coordinates their integer bits, and what brings those side by side.
    pub(crate) const fn mask_and_multiplier(&self) -> [u32; 2] {
        [self.mask, self.multiplier]
    }

    /// Whether coordinates times 2^`scale_log2` fit 16 bits each and repeat by themselves: sides of 2 … 256 texels, of
    /// at least 2^`scale_log2`.
    #[inline]
    pub(crate) const fn is_packable(&self, scale_log2: u32) -> bool {
        scale_log2 < self.packed_scales as u32
    }

    /// Whether a side has more than 64 texels, so that packed coordinates have less than 10 fraction bits.
    #[inline]
    pub(crate) const fn is_large(&self) -> bool {
        self.log2_width > 6 || self.log2_height > 6
    }

    /// The texel at whole texel coordinates of any size, repeated.
    #[inline]
    pub(crate) fn fetch_repeat(&self, u: i32, v: i32) -> u16 {
        let u = u as u32 & ((1 << self.log2_width) - 1);
        let v = v as u32 & ((1 << self.log2_height) - 1);
        self.texel(u, v)
    }

    /// The texel at whole texel coordinates of any size, the border beyond it.
    #[inline]
    pub(crate) fn fetch_clamp(&self, u: i32, v: i32) -> u16 {
        let [u, v] = self.clamped(u, v).map(|at| at as u32);
        self.texel(u, v)
    }

    /// The texel at whole texel coordinates of any size, of the texture turned round at each border.
    #[inline]
    pub(crate) fn fetch_mirror(&self, u: i32, v: i32) -> u16 {
        let [u, v] = self.mirrored(u, v);
        self.fetch_repeat(u, v)
    }

    /// The texel of the texture that is seen at whole coordinates if it is turned round at each border, modulo its size.
    #[inline]
    pub(crate) fn mirrored(&self, u: i32, v: i32) -> [i32; 2] {
        let turned = |at: i32, log2: u8| if at >> log2 & 1 == 0 { at } else { !at };
        [turned(u, self.log2_width), turned(v, self.log2_height)]
    }

    /// The nearest texel of the texture.
    #[inline]
    pub(crate) fn clamped(&self, u: i32, v: i32) -> [i32; 2] {
        [u.clamp(0, (1 << self.log2_width) - 1), v.clamp(0, (1 << self.log2_height) - 1)]
    }

    /// The texel at packed coordinates, of a texture that is packable.
    #[inline]
    pub(crate) fn fetch_packed(&self, packed: u32) -> u16 {
        let shift = 32 - u32::from(self.log2_width) - u32::from(self.log2_height);
        let index = (packed & self.mask).wrapping_mul(self.multiplier) >> (shift & 31);
        self.texels.get(index as usize).copied().unwrap_or(0)
    }

    #[inline]
    fn texel(&self, u: u32, v: u32) -> u16 {
        // Always inside: u and v were wrapped and the length was checked.
        self.texels.get(((v << self.log2_width) + u) as usize).copied().unwrap_or(0)
    }
}

/// What is wrong with a texture's data.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TextureError {
    /// A side is longer than 1024 texels.
    TooLarge,
    /// The number of texels is not width × height.
    Length {
        /// Width × height.
        expected: usize,
        /// The number of texels given.
        found: usize,
    },
}

impl fmt::Display for TextureError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::TooLarge => write!(f, "a side of a texture is at most 1024 texels"),
            Self::Length { expected, found } => {
                write!(f, "the texture needs {expected} texels, but {found} were given")
            }
        }
    }
}

impl core::error::Error for TextureError {}

/// Turns the little-endian bytes of an RGB565 picture into its `N` texels, in the compiler:
/// `texels::<1024>(include_bytes!("brick.rgb565"))`.
///
/// The largest, of 1024 × 1024 texels, takes the compiler a fraction of a second for a little-endian target, and some seconds
/// for a big-endian one. The bytes may lie at odd addresses.
///
/// # Panics
///
/// If there are not 2·`N` bytes; in a `const` or `static` that is a compile error.
#[must_use]
#[track_caller]
pub const fn texels<const N: usize>(bytes: &[u8]) -> [u16; N] {
    let (pairs, odd) = bytes.as_chunks::<2>();
    let texels = match pairs.first_chunk::<N>() {
        Some(texels) if pairs.len() == N && odd.is_empty() => texels,
        _ => panic!("an RGB565 picture has two bytes for each texel"),
    };
    // One move: turns of a loop, one for each texel, take the compiler a minute. It denies two million of them
    // (`long_running_const_eval`), in the crate of whoever has the picture.
    let texels = bytemuck::must_cast::<[[u8; 2]; N], [u16; N]>(*texels);
    if cfg!(target_endian = "big") { swapped(texels) } else { texels }
}

/// The texels with their bytes swapped. A turn of the loop for each and no call, which counts as much: the largest stays below
/// those two million.
#[cfg_attr(target_endian = "little", allow(dead_code, reason = "for others, and tested here"))]
#[expect(clippy::manual_rotate, reason = "`rotate_left` would be a call")]
const fn swapped<const N: usize>(mut texels: [u16; N]) -> [u16; N] {
    let mut i = 0;
    while i < N {
        texels[i] = (texels[i] << 8) | (texels[i] >> 8);
        i += 1;
    }
    texels
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn wraps_negative_and_huge_coordinates() {
        let texels: [u16; 8] = core::array::from_fn(|i| i as u16);
        let texture = Texture::new(&texels, 2, 1);
        assert_eq!(texture.fetch_repeat(-1, 0), 3);
        assert_eq!(texture.fetch_repeat(-4, -1), 4);
        assert_eq!(texture.fetch_repeat(5, 2), 1);
        assert_eq!(texture.fetch_repeat(i32::MIN, i32::MAX), 4);
        assert_eq!([-5, -1, 0, 3, 4, 7, 8].map(|u| texture.fetch_mirror(u, 0)), [3, 0, 0, 3, 3, 0, 0]);
        assert_eq!([-2, -1, 0, 1, 2, 3].map(|v| texture.fetch_mirror(0, v)), [4, 0, 0, 4, 4, 0]);
        assert_eq!(texture.fetch_mirror(i32::MIN, i32::MAX), 0);
        assert_eq!(texture.fetch_clamp(-1, 0), 0);
        assert_eq!(texture.fetch_clamp(i32::MAX, i32::MAX), 7);
        assert_eq!(texture.fetch_clamp(i32::MIN, 1), 4);
    }

    /// 0, 1, 2, … in bytes that are not aligned: of an array that begins with another byte.
    const fn bytes<const N: usize>() -> [u8; N] {
        let mut bytes = [0; N];
        let mut i = 0;
        while i < N {
            bytes[i] = i as u8;
            i += 1;
        }
        bytes
    }

    #[test]
    fn bytes_of_any_place_and_number_become_texels() {
        const BYTES: [u8; 16] = bytes();
        for first in 0..4 {
            let of = |n: usize| &BYTES[first..first + 2 * n];
            let word = |i: usize| (first + 2 * i + ((first + 2 * i + 1) << 8)) as u16;
            assert_eq!(texels::<0>(of(0)), [0; 0]);
            assert_eq!(texels::<1>(of(1)), [word(0)]);
            assert_eq!(texels::<5>(of(5)), [0, 1, 2, 3, 4].map(word));
        }
        // In the compiler, too, as its machines' bytes run.
        const FIVE: [u16; 5] = texels(BYTES.split_at(1).1.split_at(10).0);
        assert_eq!(FIVE, [0x0201, 0x0403, 0x0605, 0x0807, 0x0a09]);
        const SWAPPED: [u16; 5] = swapped(FIVE);
        assert_eq!(SWAPPED, [0x0102, 0x0304, 0x0506, 0x0708, 0x090a]);
    }

    #[test]
    fn a_wrong_number_of_bytes_is_no_picture() {
        for wrong in [0, 1, 7, 9, 10] {
            let made = std::panic::catch_unwind(|| texels::<4>(&bytes::<10>()[..wrong]));
            assert!(made.is_err(), "{wrong} bytes for 4 texels");
        }
    }

    #[test]
    fn errors_are_typed() {
        assert_eq!(
            Texture::try_new(&[0; 3], 1, 1).unwrap_err(),
            TextureError::Length { expected: 4, found: 3 }
        );
        assert_eq!(Texture::try_new(&[0; 4], 11, 0).unwrap_err(), TextureError::TooLarge);
        assert_eq!(Texture::try_new(&[0; 4], u32::MAX, u32::MAX).unwrap_err(), TextureError::TooLarge);
    }
}
