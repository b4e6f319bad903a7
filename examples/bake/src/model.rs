//! A model as files have it: triangles, materials and pictures, of whatever format.

use crate::error::{BakeError, Place, Warning};
use image::RgbaImage;
use std::path::{Path, PathBuf};

/// A corner of a triangle, in model units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Corner {
    pub(crate) position: [f32; 3],
    /// (0, 0) is the top left corner of the picture, (1, 1) the bottom right one.
    pub(crate) uv: Option<[f32; 2]>,
    /// Of length 1.
    pub(crate) normal: Option<[f32; 3]>,
    /// As shown, not linear.
    pub(crate) color: Option<[u8; 3]>,
}

/// Which triangles a smooth surface is made of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Smoothing {
    /// Those that meet at less than the crease angle.
    ByAngle,
    /// None.
    Flat,
    /// Those of the same group.
    Group(u32),
}

#[derive(Clone, Copy, Debug)]
pub(crate) struct Triangle {
    pub(crate) corners: [Corner; 3],
    pub(crate) smoothing: Smoothing,
}

/// Triangles of one object and one material.
#[derive(Clone, Debug)]
pub(crate) struct Part {
    pub(crate) name: String,
    pub(crate) material: usize,
    pub(crate) triangles: Vec<Triangle>,
}

/// What is seen beyond the borders of a picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) enum Wrap {
    Repeat,
    Mirror,
    Clamp,
}

#[derive(Clone, Debug)]
pub(crate) struct RawMaterial {
    pub(crate) name: String,
    /// Which of the model's pictures.
    pub(crate) picture: Option<usize>,
    /// As shown, not linear; what a picture is multiplied by.
    pub(crate) color: [u8; 3],
    pub(crate) alpha: f32,
    /// Texels of less alpha are cut out.
    pub(crate) cutoff: Option<f32>,
    /// Whether alpha of the picture is meant to be blended.
    pub(crate) blends: bool,
    pub(crate) two_sided: bool,
    pub(crate) lit: bool,
    pub(crate) wrap: [Wrap; 2],
    /// u, v → what is written here times (u, v, 1).
    pub(crate) transform: Option<[[f32; 3]; 2]>,
}

impl RawMaterial {
    pub(crate) fn new(name: &str) -> Self {
        Self {
            name: name.to_owned(),
            picture: None,
            color: [255; 3],
            alpha: 1.0,
            cutoff: None,
            blends: false,
            two_sided: false,
            lit: true,
            wrap: [Wrap::Repeat; 2],
            transform: None,
        }
    }
}

#[derive(Clone, Debug)]
pub(crate) struct RawPicture {
    pub(crate) name: String,
    pub(crate) image: RgbaImage,
}

#[derive(Clone, Debug, Default)]
pub(crate) struct Model {
    pub(crate) parts: Vec<Part>,
    pub(crate) materials: Vec<RawMaterial>,
    pub(crate) pictures: Vec<RawPicture>,
    pub(crate) warnings: Vec<Warning>,
    /// Vertices that no triangle has.
    pub(crate) unused_vertices: usize,
    /// All files that were read.
    pub(crate) files: Vec<PathBuf>,
}

impl Model {
    /// Reads a model, by the ending of its name.
    pub(crate) fn open(path: &Path) -> Result<Self, BakeError> {
        let ending = path.extension().unwrap_or_default().to_string_lossy().to_ascii_lowercase();
        let mut model = match ending.as_str() {
            "obj" => crate::obj::read(path)?,
            "gltf" | "glb" => crate::gltf_file::read(path)?,
            _ => return Err(Place::file(path).error("is no model that can be read: OBJ, glTF and GLB can")),
        };
        model.parts.retain(|part| !part.triangles.is_empty());
        if model.parts.is_empty() {
            let lines =
                model.warnings.iter().map(|warning| format!(" ({})", warning.text)).collect::<String>();
            return Err(Place::file(path).error(format!("there is no triangle in it{lines}")));
        }
        Ok(model)
    }

    pub(crate) fn triangle_count(&self) -> usize {
        self.parts.iter().map(|part| part.triangles.len()).sum()
    }
}
