//! Pictures that belong to no model: sprites, walls, labels.

use crate::baked::{BakedTexture, ByteOrder};
use crate::error::{BakeError, read};
use crate::picture::{Recipe, decode, texels};
use crate::{out_dir, write};
use std::path::{Path, PathBuf};

/// A picture to be made a texture: PNG, JPEG, BMP or TGA.
#[derive(Clone, Debug)]
#[must_use]
pub struct Picture {
    path: PathBuf,
    longest: u32,
    repeats: bool,
    cutoff: u8,
}

impl Picture {
    /// A picture in a file.
    pub fn new(path: impl Into<PathBuf>) -> Self {
        Self { path: path.into(), longest: 128, repeats: true, cutoff: 128 }
    }

    /// The longest side of the texture, a power of two, up to 1024. 128 without this.
    pub fn longest_side(mut self, texels: u32) -> Self {
        self.longest = texels;
        self
    }

    /// Keeps its pixels as they are, in the top left of a texture with sides of powers of two, if it is not too large: for sprites and
    /// labels, which do not repeat. Without this it is resized so that it fills the texture.
    pub fn unresized(mut self) -> Self {
        self.repeats = false;
        self
    }

    /// Texels of less alpha than this, of 255, are cut out. 128 without this.
    pub fn cut_out_below(mut self, alpha: u8) -> Self {
        self.cutoff = alpha;
        self
    }

    /// Makes the texture, in memory.
    ///
    /// # Errors
    ///
    /// [`BakeError`] if it is no picture that can be read.
    pub fn bake(&self) -> Result<BakedTexture, BakeError> {
        let image = decode(&read(&self.path)?, &self.path, "")?;
        let recipe = Recipe {
            picture: 0,
            color: [255; 3],
            cutoff: Some(self.cutoff),
            mirrored: [false; 2],
            repeats: self.repeats,
            longest: self.longest,
        };
        let made = texels(&image, &recipe);
        let name = self.path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        let source = image.dimensions().into();
        Ok(BakedTexture {
            name,
            log2: made.size.map(u32::ilog2),
            texels: made.words,
            mask: made.mask,
            source,
        })
    }

    /// Makes files in a folder that are texels for [`fixel::texels`], `brick.rgb565`, and, where some are cut out, bits for
    /// [`Mask::new`](fixel::Mask::new), `brick.bits`.
    ///
    /// # Errors
    ///
    /// As [`Picture::bake`], and if a file cannot be written.
    pub fn write(&self, folder: impl AsRef<Path>) -> Result<BakedTexture, BakeError> {
        let baked = self.bake()?;
        let name = write::snake(&baked.name);
        let mut files = vec![(
            format!("{name}.rgb565"),
            baked.texels.iter().flat_map(|texel| texel.to_le_bytes()).collect(),
        )];
        files.extend(baked.mask.iter().map(|bits| (format!("{name}.bits"), bits.clone())));
        write::save(folder.as_ref(), &files)?;
        Ok(baked)
    }

    /// Makes files that [`Texture::from_bytes`](fixel::Texture::from_bytes) and [`Mask::from_bytes`](fixel::Mask::from_bytes) read:
    /// `brick.texture`, `brick.mask`.
    ///
    /// # Errors
    ///
    /// As [`Picture::write`].
    pub fn write_binaries(
        &self,
        folder: impl AsRef<Path>,
        order: ByteOrder,
    ) -> Result<BakedTexture, BakeError> {
        let baked = self.bake()?;
        let name = write::snake(&baked.name);
        let mut files = vec![(format!("{name}.texture"), baked.bytes(order))];
        files.extend(baked.mask_bytes(order).map(|bytes| (format!("{name}.mask"), bytes)));
        write::save(folder.as_ref(), &files)?;
        Ok(baked)
    }

    /// [`Picture::write`] in a build script, into cargo's `OUT_DIR`.
    ///
    /// # Errors
    ///
    /// As [`Picture::write`].
    pub fn for_cargo(&self) -> Result<BakedTexture, BakeError> {
        println!("cargo:rerun-if-changed={}", self.path.display());
        self.write(out_dir(&self.path)?)
    }
}
