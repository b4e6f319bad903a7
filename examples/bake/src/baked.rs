//! What comes out: meshes, textures and materials in the formats of fixel, in memory.

use crate::check::Surfaces;
use crate::error::Warning;
use crate::fit::Fit;
use fixel::embedded_graphics::prelude::Size;
use fixel::{AssetError, Mask, Mesh, MeshError, Texture, TextureError, Vertex};
use std::path::PathBuf;

/// A model in the formats of fixel.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Baked {
    /// The file's name without its ending.
    pub name: String,
    /// All files that were read: a build depends on them.
    pub files: Vec<PathBuf>,
    /// The scale for a pose.
    pub fit: Fit,
    /// Each is drawn with one material.
    pub meshes: Vec<BakedMesh>,
    /// What they look like.
    pub materials: Vec<BakedMaterial>,
    /// Those of the materials.
    pub textures: Vec<BakedTexture>,
    /// What may not be as it was meant.
    pub warnings: Vec<Warning>,
    /// What was found wrong with the surfaces of each object.
    pub surfaces: Vec<Surfaces>,
    /// Counts and measures.
    pub report: Report,
}

/// A mesh: vertices and triangles, of at most 65 535 each.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct BakedMesh {
    /// For people and constants.
    pub name: String,
    /// Which of the [materials](Baked::materials) it has.
    pub material: usize,
    /// In the order in which the triangles need them.
    pub vertices: Vec<Vertex>,
    /// In an order in which few vertices are transformed twice.
    pub triangles: Vec<[u16; 3]>,
    /// How many vertices fixel would transform for the triangles in the order of the file.
    pub transforms_before: usize,
    /// How many it does, where nothing is clipped.
    pub transforms: usize,
}

impl BakedMesh {
    /// Whether an index takes one byte.
    #[must_use]
    pub fn has_short_indices(&self) -> bool {
        self.vertices.len() <= 256
    }

    /// Bytes of flash.
    #[must_use]
    pub fn flash(&self) -> usize {
        16 * self.vertices.len() + self.triangles.len() * if self.has_short_indices() { 3 } else { 6 }
    }

    /// The mesh, to draw it.
    ///
    /// # Errors
    ///
    /// None, unless fields were changed: an index that is out of range.
    pub fn mesh(&self) -> Result<Mesh<'_>, MeshError> {
        Mesh::try_new(&self.vertices, &self.triangles)
    }

    /// The file that [`Mesh::from_bytes`] reads.
    #[must_use]
    pub fn bytes(&self, order: ByteOrder) -> Vec<u8> {
        let index_bytes = if self.has_short_indices() { 1 } else { 2 };
        let mut bytes =
            header(order, b'M', index_bytes, [self.vertices.len() as u32, self.triangles.len() as u32]);
        for vertex in &self.vertices {
            let words =
                vertex.position.map(|at| at.to_bits()).into_iter().chain(vertex.uv.map(|at| at.to_bits()));
            words.for_each(|word| bytes.extend(order.word(word as u16)));
            bytes.extend(vertex.color);
            bytes.extend(vertex.normal.map(|component| component as u8));
        }
        for index in self.triangles.as_flattened() {
            if index_bytes == 1 { bytes.push(*index as u8) } else { bytes.extend(order.word(*index)) }
        }
        bytes
    }
}

/// What shows on a mesh.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Paint {
    /// One colour, RGB565.
    Flat(u16),
    /// The vertices' colours.
    Gouraud,
    /// One of the [textures](Baked::textures).
    Texture {
        /// Which one.
        texture: usize,
        /// Whether its border is seen beyond it; else it repeats.
        is_clamped: bool,
        /// Whether some texels are cut out.
        is_masked: bool,
    },
}

/// A material.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct BakedMaterial {
    /// For people and constants.
    pub name: String,
    /// What shows.
    pub paint: Paint,
    /// Whether light falls on it.
    pub is_lit: bool,
    /// How opaque it is, if it is not.
    pub alpha: Option<u8>,
    /// Whether its backs are seen.
    pub is_two_sided: bool,
}

/// A texture, and its mask.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct BakedTexture {
    /// For people and constants.
    pub name: String,
    /// log₂ of width and height.
    pub log2: [u32; 2],
    /// RGB565.
    pub texels: Vec<u16>,
    /// A bit a texel, if some are cut out.
    pub mask: Option<Vec<u8>>,
    /// Width and height of the picture that it was made of.
    pub source: [u32; 2],
}

impl BakedTexture {
    /// Bytes of flash.
    #[must_use]
    pub fn flash(&self) -> usize {
        2 * self.texels.len() + self.mask.as_ref().map_or(0, Vec::len)
    }

    /// Width and height.
    #[must_use]
    pub fn size(&self) -> Size {
        Size::new(1 << self.log2[0], 1 << self.log2[1])
    }

    /// The texture, to draw with it.
    ///
    /// # Errors
    ///
    /// None, unless fields were changed: a wrong number of texels.
    pub fn texture(&self) -> Result<Texture<'_>, TextureError> {
        Texture::try_new(&self.texels, self.log2[0], self.log2[1])
    }

    /// Its mask, if some texels are cut out.
    ///
    /// # Errors
    ///
    /// None, unless fields were changed: a wrong number of bytes.
    pub fn mask(&self) -> Result<Option<Mask<'_>>, AssetError> {
        let mask = self.mask.as_ref().map(|bits| Mask::try_new(bits, self.log2[0], self.log2[1]));
        mask.transpose().map_err(AssetError::Mask)
    }

    /// The file that [`Texture::from_bytes`] reads.
    #[must_use]
    pub fn bytes(&self, order: ByteOrder) -> Vec<u8> {
        let mut bytes = header(order, b'T', 0, self.log2);
        self.texels.iter().for_each(|texel| bytes.extend(order.word(*texel)));
        bytes
    }

    /// The file that [`Mask::from_bytes`] reads.
    #[must_use]
    pub fn mask_bytes(&self, order: ByteOrder) -> Option<Vec<u8>> {
        let bits = self.mask.as_ref()?;
        Some([header(order, b'K', 0, self.log2), bits.clone()].concat())
    }
}

/// The order of bytes in words of the machine that reads a file.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ByteOrder {
    /// The lower byte first: nearly all microcontrollers.
    #[default]
    Little,
    /// The upper byte first.
    Big,
}

impl ByteOrder {
    fn word(self, word: u16) -> [u8; 2] {
        match self {
            Self::Little => word.to_le_bytes(),
            Self::Big => word.to_be_bytes(),
        }
    }
}

fn header(order: ByteOrder, kind: u8, detail: u8, sizes: [u32; 2]) -> Vec<u8> {
    let mut bytes = b"fxl1".to_vec();
    bytes.extend(order.word(0x0102));
    bytes.extend([kind, detail]);
    for size in sizes {
        bytes.extend(match order {
            ByteOrder::Little => size.to_le_bytes(),
            ByteOrder::Big => size.to_be_bytes(),
        });
    }
    bytes
}

/// Counts and measures of a model.
#[derive(Clone, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct Report {
    /// Triangles of the file, faces of more corners cut into them.
    pub triangles_read: usize,
    /// … that were left out, because two corners of them, or all on a line, fell on the same step of positions.
    pub collapsed: usize,
    /// Triangles of the file that were cut because their texture coordinates span more than a format holds.
    pub cut: usize,
    /// Triangles that are baked.
    pub triangles: usize,
    /// Vertices that are baked.
    pub vertices: usize,
    /// Vertices of the file that no triangle has.
    pub unused_vertices: usize,
    /// Corners of triangles whose normal was computed.
    pub computed_normals: usize,
    /// The largest distance of a vertex from where the file has it, in model units.
    pub largest_error: f64,
    /// The least and the greatest coordinates that are baked, in model units.
    pub bounds: [[f64; 3]; 2],
    /// What all baked triangles cover, in square model units.
    pub area: f64,
    /// Vertices that fixel would transform in the order of the file.
    pub transforms_before: usize,
    /// Vertices that it does.
    pub transforms: usize,
}

impl Baked {
    /// Bytes of flash of all meshes, textures and masks.
    #[must_use]
    pub fn flash(&self) -> usize {
        let meshes: usize = self.meshes.iter().map(BakedMesh::flash).sum();
        meshes + self.textures.iter().map(BakedTexture::flash).sum::<usize>()
    }

    /// Vertices and triangles that a display list wants for one draw of the whole model, from any side, where no plane cuts it.
    #[must_use]
    pub fn in_list(&self) -> [usize; 2] {
        [self.report.vertices, self.report.triangles]
    }

    /// The same whatever cuts it: [`Mesh::most_in_list`].
    #[must_use]
    pub fn most_in_list(&self) -> [usize; 2] {
        let meshes = self.meshes.iter().filter_map(|mesh| mesh.mesh().ok());
        meshes.map(|mesh| mesh.most_in_list()).fold([0; 2], |a, b| [a[0] + b[0], a[1] + b[1]])
    }
}
