//! Models and pictures as meshes, textures and materials for [fixel]: in a build script, or by the program `fixel-bake`.
//!
//! In `build.rs`:
//!
//! ```no_run
//! fn main() -> Result<(), fixel_bake::BakeError> {
//!     fixel_bake::Bake::new("assets/ship.obj").for_cargo()?; // or .gltf, .glb
//!     Ok(())
//! }
//! ```
//!
//! In the program: `mod ship { include!(concat!(env!("OUT_DIR"), "/ship.rs")); }`, and then `ship::draw(…)`. The package's README shows all
//! of it.
//!
//! Pictures alone, for a [`Texture`](fixel::Texture), are [`Picture`]s.

mod accessor;
mod bake;
mod baked;
mod check;
/// What a frame takes.
pub mod cost;
mod cut;
mod error;
mod fit;
mod gltf_file;
mod model;
mod mtl;
mod normals;
mod obj;
mod options;
mod order;
mod picture;
mod polygon;
mod single;
mod summary;
mod text;
/// Draws what was baked, with fixel itself.
pub mod view;
mod write;

pub use baked::{Baked, BakedMaterial, BakedMesh, BakedTexture, ByteOrder, Paint, Report};
pub use check::Surfaces;
pub use error::{BakeError, Place, Warning};
pub use fit::Fit;
pub use single::Picture;

use options::Options;
use std::path::{Path, PathBuf};

/// A model to be baked.
#[derive(Clone, Debug)]
#[must_use]
pub struct Bake {
    path: PathBuf,
    options: Options,
}

impl Bake {
    /// A model in a file: OBJ, glTF or GLB, by its ending.
    pub fn new(path: impl Into<PathBuf>) -> Self {
        Self { path: path.into(), options: Options::default() }
    }

    /// Puts the middle of the model at the origin, about which it turns. Without this its origin stays where it is.
    pub fn center(mut self) -> Self {
        self.options.center = true;
        self
    }

    /// How many world units a model unit is: 0.01 for a model in centimetres, in a world of metres. Without this it is 1, if the model
    /// is not larger than a pose can make it.
    pub fn unit(mut self, unit: f64) -> Self {
        self.options.unit = Some(unit);
        self
    }

    /// How long the model's longest side is in the world, whatever its unit. In place of [`Bake::unit`].
    pub fn size(mut self, size: f64) -> Self {
        self.options.size = Some(size);
        self
    }

    /// Where normals are computed: triangles that meet at more than this many degrees have an edge between them. 40 without this.
    pub fn crease(mut self, degrees: f64) -> Self {
        self.options.crease = degrees;
        self
    }

    /// The longest side of textures, a power of two, up to 1024. 128 without this: 32 KiB of flash.
    pub fn longest_side(mut self, texels: u32) -> Self {
        self.options.longest = texels;
        self
    }

    /// Materials on which no light falls. It saves flash and cycles where there are no lights.
    pub fn unlit(mut self) -> Self {
        self.options.unlit = true;
        self
    }

    /// A mesh for each object of the file, where without this there is one for each material, which takes fewer draws.
    pub fn by_object(mut self) -> Self {
        self.options.objects = true;
        self
    }

    /// Searches ten times as long for an order of triangles that transforms a percent or two fewer vertices.
    pub fn thorough(mut self) -> Self {
        self.options.thorough = true;
        self
    }

    /// Makes warnings an error.
    pub fn strict(mut self) -> Self {
        self.options.strict = true;
        self
    }

    /// Bakes it, in memory.
    ///
    /// # Errors
    ///
    /// [`BakeError`], which says what is wrong in which file, and where it can in which line.
    pub fn bake(&self) -> Result<Baked, BakeError> {
        self.bake_with(&mut |_, _, _| ())
    }

    /// Bakes it, and says what it does: the work, how much of it is done, and how much there is.
    ///
    /// # Errors
    ///
    /// As [`Bake::bake`].
    pub fn bake_with(&self, progress: &mut dyn FnMut(&str, usize, usize)) -> Result<Baked, BakeError> {
        let wrong = |problem: &str| Err(Place::file(&self.path).error(problem));
        if !self.options.crease.is_finite() {
            return wrong("the crease angle is no number");
        }
        let lengths = [self.options.unit, self.options.size];
        if lengths.into_iter().flatten().any(|length| !(length.is_finite() && length > 0.0)) {
            return wrong("the unit or the size is no number above 0");
        }
        progress("read", 0, 1);
        let model = model::Model::open(&self.path)?;
        let baked = bake::bake(model, &self.path, &self.options, progress)?;
        if self.options.strict && !baked.warnings.is_empty() {
            return Err(BakeError::Warnings(baked.warnings));
        }
        Ok(baked)
    }

    /// Bakes it into a folder, as a module of Rust with the name of the file: `My Ship.obj` becomes `my_ship.rs`, with files of texels
    /// beside it, which it includes. Returns the paths of all files that were written, the module's first.
    ///
    /// # Errors
    ///
    /// As [`Bake::bake`], and if a file cannot be written.
    pub fn write(&self, folder: impl AsRef<Path>) -> Result<(Baked, Vec<PathBuf>), BakeError> {
        let baked = self.bake()?;
        let paths = write_module(&baked, folder)?;
        Ok((baked, paths))
    }

    /// Bakes it in a build script, into cargo's `OUT_DIR`, and tells cargo on which files that depends, and what may be wrong.
    ///
    /// # Errors
    ///
    /// As [`Bake::write`].
    pub fn for_cargo(&self) -> Result<Baked, BakeError> {
        println!("cargo:rerun-if-changed={}", self.path.display());
        let (baked, _) = self.write(out_dir(&self.path)?)?;
        for file in &baked.files {
            println!("cargo:rerun-if-changed={}", file.display());
        }
        for warning in &baked.warnings {
            println!("cargo:warning={warning}");
        }
        Ok(baked)
    }
}

fn out_dir(path: &Path) -> Result<PathBuf, BakeError> {
    let folder = std::env::var_os("OUT_DIR").map(PathBuf::from);
    folder.ok_or_else(|| Place::file(path).error("there is no `OUT_DIR`: this is no build script"))
}

/// Writes a module of Rust into a folder, as [`Bake::write`] does.
///
/// # Errors
///
/// If a file cannot be written.
pub fn write_module(baked: &Baked, folder: impl AsRef<Path>) -> Result<Vec<PathBuf>, BakeError> {
    let source = baked.files.first().and_then(|path| path.file_name()).unwrap_or_default().to_string_lossy();
    let module = write::snake(&baked.name);
    write::save(folder.as_ref(), &write::module(baked, &module, &source))
}

/// Writes files that [`Mesh::from_bytes`](fixel::Mesh::from_bytes), [`Texture::from_bytes`](fixel::Texture::from_bytes) and
/// [`Mask::from_bytes`](fixel::Mask::from_bytes) read.
///
/// # Errors
///
/// If a file cannot be written.
pub fn write_binaries(
    baked: &Baked,
    folder: impl AsRef<Path>,
    order: ByteOrder,
) -> Result<Vec<PathBuf>, BakeError> {
    write::save(folder.as_ref(), &write::binaries(baked, &write::snake(&baked.name), order))
}
