//! A material's recipe: the numbers that its loops read.
//!
//! - In: what a material says.
//! - Out: the same, without its type.
//! - Assumes: nothing.

use crate::scene::{Mask, Texture};

/// What the loops of a material read. A display list keeps it by value.
#[doc(hidden)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Recipe<'a> {
    /// Of one texel where there is none.
    pub(crate) texture: Texture<'a>,
    /// Which texels of a cut-out texture are there; `None`: all but those of the colour `color`.
    pub(crate) mask: Option<Mask<'a>>,
    /// RGB565: the colour of all, where there is no texture, or that of texels that are left out.
    pub(crate) color: u16,
    /// Texture coordinates are multiplied by 2^this, 0 … 8.
    pub(crate) scale_log2: u8,
}

impl Recipe<'_> {
    /// Without a texture.
    pub(crate) const fn plain(color: u16) -> Self {
        Self { texture: Texture::new(&[0], 0, 0), mask: None, color, scale_log2: 0 }
    }
}
