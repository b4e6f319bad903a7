//! Assets as bytes: meshes, textures and masks that are borrowed from where they lie, and checked.
//!
//! - In: bytes of any origin.
//! - Out: what their header says, and the data behind it; or what is wrong with them.
//! - Assumes: nothing.
//!
//! [`Mesh::from_bytes`] describes the format for whoever writes it.

use super::{Mask, MaskError, Mesh, MeshError, Texture, TextureError};
use core::fmt;

/// How long the header is.
const HEADER: usize = 16;
/// What all assets begin with. The last is the version.
const MAGIC: [u8; 4] = *b"fxl1";
/// As the machine that reads an asset has it, if it is for such machines.
const ORDER_MARK: u16 = 0x0102;

/// Puts bytes at an address that is a multiple of 4, for [`Mesh::from_bytes`] and
/// [`Texture::from_bytes`]: those of `include_bytes!` may lie at any.
///
/// ```
/// use fixel::Aligned;
/// # macro_rules! include_bytes { ($path:literal) => { &[0; 24] } }
/// static SHIP: &Aligned<[u8]> = &Aligned(*include_bytes!("ship.mesh"));
/// assert_eq!(SHIP.0.as_ptr() as usize % 4, 0);
/// ```
#[derive(Clone, Copy, Debug)]
#[repr(C, align(4))]
pub struct Aligned<T: ?Sized>(
    /// The bytes.
    pub T,
);

/// What an asset is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AssetKind {
    /// A [`Mesh`].
    Mesh,
    /// A [`Texture`].
    Texture,
    /// A [`Mask`].
    Mask,
}

impl AssetKind {
    const fn code(self) -> u8 {
        match self {
            Self::Mesh => b'M',
            Self::Texture => b'T',
            Self::Mask => b'K',
        }
    }
}

/// A header that was checked, with what follows it.
#[derive(Debug)]
struct Asset<'a> {
    /// Of a mesh how many bytes an index has, else 0.
    detail: u8,
    /// How many vertices and triangles; or log₂ of width and height.
    sizes: [u32; 2],
    data: &'a [u8],
}

impl<'a> Asset<'a> {
    fn of(bytes: &'a [u8], kind: AssetKind) -> Result<Self, AssetError> {
        let Some((header, data)) = bytes.split_first_chunk::<HEADER>() else {
            return Err(AssetError::NoAsset);
        };
        let [m0, m1, m2, m3, order0, order1, code, detail, sizes @ ..] = *header;
        if [m0, m1, m2, m3] != MAGIC {
            return Err(AssetError::NoAsset);
        }
        let order = u16::from_ne_bytes([order0, order1]);
        if order == ORDER_MARK.swap_bytes() {
            return Err(AssetError::ByteOrder);
        } else if order != ORDER_MARK {
            return Err(AssetError::NoAsset);
        }
        if code != kind.code() {
            return Err(AssetError::Kind { expected: kind });
        }
        let [a0, a1, a2, a3, b0, b1, b2, b3] = sizes;
        let sizes = [[a0, a1, a2, a3], [b0, b1, b2, b3]].map(u32::from_ne_bytes);
        Ok(Self { detail, sizes, data })
    }

    /// The data, cut in two behind so many bytes, if it is as long as both parts together.
    fn split(&self, first: u64, second: u64) -> Result<(&'a [u8], &'a [u8]), AssetError> {
        // At most 2³² · 22.
        let expected = first + second;
        if self.data.len() as u64 != expected {
            let [expected, found] = [expected, self.data.len() as u64].map(|length| length + HEADER as u64);
            return Err(AssetError::Length { expected, found });
        }
        self.data.split_at_checked(first as usize).ok_or(AssetError::NoAsset)
    }

    /// log₂ of width and height of what has nothing else in its header.
    fn log2(&self) -> Result<[u32; 2], AssetError> {
        if self.detail == 0 { Ok(self.sizes) } else { Err(AssetError::NoAsset) }
    }
}

/// The same bytes as values of another type, if they lie at an address for it.
fn cast<T: bytemuck::AnyBitPattern>(bytes: &[u8]) -> Result<&[T], AssetError> {
    bytemuck::try_cast_slice(bytes).map_err(|_| AssetError::Address)
}

impl<'a> Mesh<'a> {
    /// A mesh from bytes that are in memory already: in flash that is mapped there, or read from a card. Nothing is copied; the
    /// bytes are checked.
    ///
    /// `examples/bake` in the repository writes such files from models. The format, all numbers in the byte order of the machine that
    /// reads them:
    ///
    /// | bytes | what |
    /// |---|---|
    /// | 0 … 3 | `fxl1` |
    /// | 4, 5 | `0x0102`, which tells the byte order |
    /// | 6 | `M` (a [texture](Texture::from_bytes) has `T`, a [mask](Mask::from_bytes) `K`) |
    /// | 7 | how many bytes an index has, 1 or 2 |
    /// | 8 … 11, 12 … 15 | how many vertices, how many triangles |
    /// | from 16 on | the vertices, 16 bytes each, as the fields of [`Vertex`](crate::Vertex) stand |
    /// | behind them | the triangles, three indices each |
    ///
    /// Looks at each triangle once and at each vertex twice, so make it once, not in each frame.
    ///
    /// ```
    /// use fixel::{Aligned, AssetError, Mesh};
    /// # macro_rules! include_bytes { ($path:literal) => { b"fxl1\x02\x01M\x01\0\0\0\0\0\0\0\0" } }
    /// static SHIP: &Aligned<[u8]> = &Aligned(*include_bytes!("ship.mesh"));
    /// # #[cfg(target_endian = "little")] {
    /// let ship = Mesh::from_bytes(&SHIP.0)?;
    /// # let _ = ship; }
    /// # Ok::<(), AssetError>(())
    /// ```
    ///
    /// # Errors
    ///
    /// [`AssetError`] for whatever is no mesh: no bytes panic, here or later.
    pub fn from_bytes(bytes: &'a [u8]) -> Result<Self, AssetError> {
        let asset = Asset::of(bytes, AssetKind::Mesh)?;
        let [vertices, triangles] = asset.sizes.map(u64::from);
        if !matches!(asset.detail, 1 | 2) {
            return Err(AssetError::NoAsset);
        }
        let (vertices, triangles) = asset.split(16 * vertices, 3 * u64::from(asset.detail) * triangles)?;
        let vertices = cast(vertices)?;
        let mesh = match asset.detail {
            1 => Mesh::try_new_u8(vertices, triangles.as_chunks().0),
            _ => Mesh::try_new(vertices, cast(triangles)?),
        };
        mesh.map_err(AssetError::Mesh)
    }
}

impl<'a> Texture<'a> {
    /// A texture from bytes that are in memory already, without copying its texels; as [`Mesh::from_bytes`],
    /// which has the format's header. Bytes 8 … 11 and 12 … 15 hold log₂ of width and height, byte 7 is 0, and the texels follow, as
    /// [`Texture::new`] takes them. Takes as long whatever the size.
    ///
    /// # Errors
    ///
    /// [`AssetError`] for whatever is no texture: no bytes panic, here or later.
    pub fn from_bytes(bytes: &'a [u8]) -> Result<Self, AssetError> {
        let asset = Asset::of(bytes, AssetKind::Texture)?;
        let [log2_width, log2_height] = asset.log2()?;
        if log2_width > 10 || log2_height > 10 {
            return Err(AssetError::Texture(TextureError::TooLarge));
        }
        let (texels, _) = asset.split(2 << (log2_width + log2_height), 0)?;
        Self::try_new(cast(texels)?, log2_width, log2_height).map_err(AssetError::Texture)
    }
}

impl<'a> Mask<'a> {
    /// A mask from bytes that are in memory already, at any address, without copying its bits; as
    /// [`Texture::from_bytes`].
    ///
    /// # Errors
    ///
    /// [`AssetError`] for whatever is no mask: no bytes panic, here or later.
    pub fn from_bytes(bytes: &'a [u8]) -> Result<Self, AssetError> {
        let asset = Asset::of(bytes, AssetKind::Mask)?;
        let [log2_width, log2_height] = asset.log2()?;
        Self::try_new(asset.data, log2_width, log2_height).map_err(AssetError::Mask)
    }
}

/// Why bytes are no mesh, no texture or no mask.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AssetError {
    /// They do not begin with the header of an asset, of this version of the format.
    NoAsset,
    /// They were written for machines of the other byte order.
    ByteOrder,
    /// They are an asset of another kind.
    Kind {
        /// What was asked for.
        expected: AssetKind,
    },
    /// There are more or fewer bytes than the header says.
    Length {
        /// As many as the header says.
        expected: u64,
        /// As many as were given.
        found: u64,
    },
    /// They begin at an odd address: [`Aligned`] puts them at another.
    Address,
    /// A triangle names a vertex that is not there.
    Mesh(MeshError),
    /// The header's size is no texture's.
    Texture(TextureError),
    /// The header's size is no mask's.
    Mask(MaskError),
}

impl fmt::Display for AssetError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NoAsset => f.write_str("the bytes do not begin with the header of an asset, `fxl1`"),
            Self::ByteOrder => f.write_str("the asset was written for machines of the other byte order"),
            Self::Kind { expected } => write!(f, "the asset is of another kind, and no {expected:?}"),
            Self::Length { expected, found } => {
                write!(f, "the asset has {expected} bytes by its header, but {found} were given")
            }
            Self::Address => f.write_str("the asset begins at an odd address"),
            Self::Mesh(error) => error.fmt(f),
            Self::Texture(error) => error.fmt(f),
            Self::Mask(error) => error.fmt(f),
        }
    }
}

impl core::error::Error for AssetError {}
