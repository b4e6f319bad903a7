//! glTF 2.0 files, as text with files beside them or as one binary file.
//!
//! - In: a file whose every index, length and number may be wrong.
//! - Out: its default scene as triangles in the scene's space: what stands still.
//! - Assumes: nothing.

use crate::error::{BakeError, Place, read as read_file};
use crate::model::{Corner, Model, Part, RawMaterial, RawPicture, Smoothing, Triangle, Wrap};
use crate::obj::unit;
use crate::{accessor, picture};
use base64::Engine;
use gltf::json::deserialize;
use gltf::json::validation::Validate;
use gltf::material::AlphaMode;
use gltf::mesh::Mode;
use gltf::texture::WrappingMode;
use gltf::{Gltf, Semantic, buffer, json};
use std::collections::HashMap;
use std::path::Path;

/// Columns: x, y, z axis and translation.
type Matrix = [[f64; 3]; 4];

const IDENTITY: Matrix = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [0.0; 3]];

/// More triangles than are read from one file, however often it shows a mesh.
const MOST_TRIANGLES: usize = 1 << 24;

fn transformed(matrix: &Matrix, point: [f64; 3], w: f64) -> [f64; 3] {
    [0, 1, 2].map(|i| (0..3).map(|axis| matrix[axis][i] * point[axis]).sum::<f64>() + matrix[3][i] * w)
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

struct Reader<'p> {
    path: &'p Path,
    buffers: Vec<Vec<u8>>,
    /// By material of the file, and set of texture coordinates.
    materials: HashMap<Option<usize>, (usize, u32)>,
    pictures: HashMap<usize, Option<usize>>,
    /// Where each picture is: a URI, or bytes of a buffer.
    images: Vec<(Option<String>, Option<Vec<u8>>)>,
    model: Model,
    /// Points and lines.
    left_out: usize,
    shown_unused: HashMap<usize, usize>,
}

/// Reads a glTF or GLB file.
pub(crate) fn read(path: &Path) -> Result<Model, BakeError> {
    let bytes = read_file(path)?;
    let error = |problem: String| Place::file(path).error(problem);
    let (text, blob) = if bytes.starts_with(b"glTF") {
        chunks(&bytes).map_err(|problem| Place::file(path).error(problem))?
    } else {
        (bytes.as_slice(), None)
    };
    let version = |value: &json::Value| value.get("asset")?.get("version")?.as_str().map(str::to_owned);
    let value: json::Value = deserialize::from_slice(text).map_err(|problem| json_error(path, &problem))?;
    match version(&value) {
        Some(version) if version.starts_with("2.") => {}
        Some(version) => return Err(error(format!("is glTF {version}; 2.0 can be read"))),
        // Files of version 1.0 need not say so.
        None if value.get("techniques").is_some()
            || value.get("meshes").is_some_and(json::Value::is_object) =>
        {
            return Err(error("is glTF 1.0; 2.0 can be read".into()));
        }
        None => return Err(error("says no `asset.version`, so it is no glTF".into())),
    }
    let Gltf { document, .. } =
        Gltf::from_slice_without_validation(text).map_err(|problem| match problem {
            gltf::Error::Deserialize(problem) => json_error(path, &problem),
            problem => error(problem.to_string()),
        })?;
    validate(path, document.as_json())?;
    let mut reader = Reader {
        path,
        buffers: Vec::new(),
        materials: HashMap::new(),
        pictures: HashMap::new(),
        images: Vec::new(),
        model: Model::default(),
        left_out: 0,
        shown_unused: HashMap::new(),
    };
    reader.model.files.push(path.to_owned());
    reader.read_buffers(&document, blob)?;
    reader.images = document
        .as_json()
        .images
        .iter()
        .map(|image| {
            let view = image.buffer_view.and_then(|view| document.views().nth(view.value()));
            let bytes = view.and_then(|view| accessor::bytes(&view, &reader.buffers).map(<[u8]>::to_vec));
            (image.uri.clone(), bytes)
        })
        .collect();
    reader.scene(&document)?;
    reader.warn_of_what_moves(&document);
    reader.model.unused_vertices = reader.shown_unused.values().sum();
    Ok(reader.model)
}

/// Whether all indices are in range, and all that there has to be is there: the crate `gltf` counts on it. That positions say between
/// which numbers they lie is left to the file: nothing here needs it.
fn validate(path: &Path, root: &json::Root) -> Result<(), BakeError> {
    // It does not look at these before it takes what they name.
    for (number, mesh) in root.meshes.iter().enumerate() {
        let named = mesh.primitives.iter().flat_map(|primitive| primitive.attributes.values());
        if let Some(bad) = named.map(|index| index.value()).find(|index| *index >= root.accessors.len()) {
            return Err(
                Place::file(path).error(format!("mesh {number} names accessor {bad}, which is not there"))
            );
        }
    }
    let mut problems = Vec::new();
    root.validate(root, json::Path::new, &mut |at, problem| {
        let at = at().to_string();
        let is_range =
            problem == json::validation::Error::Missing && (at.ends_with(".min") || at.ends_with(".max"));
        if !is_range {
            problems.push((at, problem));
        }
    });
    let extensions = problems.iter().filter(|(_, problem)| *problem == json::validation::Error::Unsupported);
    if let Some((at, _)) = extensions.into_iter().find(|(at, _)| at.starts_with("extensionsRequired")) {
        let name = at.split('"').nth(1).unwrap_or(at);
        return Err(Place::file(path).error(format!("wants the extension {name}, which cannot be read")));
    }
    if problems.is_empty() {
        return Ok(());
    }
    let texts: Vec<_> = problems.iter().take(5).map(|(at, problem)| format!("{at}: {problem}")).collect();
    let more = problems.len().saturating_sub(texts.len());
    let more = if more > 0 { format!(", and {more} more") } else { String::new() };
    Err(Place::file(path).error(format!("{}{more}", texts.join(", "))))
}

/// The text and the data of a binary file. Its lengths may be anything, which the crate `gltf` does not expect.
fn chunks(bytes: &[u8]) -> Result<(&[u8], Option<&[u8]>), String> {
    let word = |at: usize| bytes.get(at..)?.first_chunk().copied().map(u32::from_le_bytes);
    let chunk = |at: usize, kind: &[u8; 4]| {
        let length = word(at)? as usize;
        let data = bytes.get(at + 8..)?;
        (bytes.get(at + 4..at + 8)? == kind).then(|| data.get(..length))
    };
    match word(4) {
        Some(2) => {}
        Some(version) => return Err(format!("is GLB {version}; version 2 can be read")),
        None => return Err("ends within its header".into()),
    }
    let text =
        chunk(12, b"JSON").ok_or("does not begin with its text, `JSON`")?.ok_or("ends within its text")?;
    let data = match chunk(20 + text.len().next_multiple_of(4), b"BIN\0") {
        Some(Some(data)) => Some(data),
        Some(None) => return Err("ends within its binary part".into()),
        None => None,
    };
    Ok((text, data))
}

fn json_error(path: &Path, problem: &json::Error) -> BakeError {
    let text = problem.to_string();
    let text = text.rsplit_once(" at line ").map_or(text.as_str(), |(text, _)| text).to_owned();
    let line = (problem.line() > 0).then(|| problem.line());
    Place { path: path.to_owned(), line }.error(text)
}

impl Reader<'_> {
    fn error(&self, problem: impl Into<String>) -> BakeError {
        Place::file(self.path).error(problem)
    }

    fn warn(&mut self, text: impl Into<String>) {
        let warning = Place::file(self.path).warning(text);
        if !self.model.warnings.contains(&warning) {
            self.model.warnings.push(warning);
        }
    }

    /// What a URI names: bytes in it, or a file beside this one.
    fn fetch(&mut self, uri: &str) -> Result<Vec<u8>, BakeError> {
        if let Some(data) = uri.strip_prefix("data:") {
            let (_, text) =
                data.split_once(";base64,").ok_or_else(|| self.error("has data that are not in base64"))?;
            let decoded = base64::engine::general_purpose::STANDARD.decode(text.trim());
            return decoded.map_err(|problem| self.error(format!("has wrong base64 in it: {problem}")));
        }
        if uri.contains("://") {
            return Err(self.error(format!("names `{uri}`: only files beside it are read")));
        }
        let name = percent_encoding::percent_decode_str(uri).decode_utf8_lossy();
        let file = self.path.parent().unwrap_or(Path::new("")).join(&*name);
        let bytes = std::fs::read(&file)
            .map_err(|problem| self.error(format!("names `{uri}`, which cannot be read: {problem}")))?;
        self.model.files.push(file);
        Ok(bytes)
    }

    fn read_buffers(&mut self, document: &gltf::Document, blob: Option<&[u8]>) -> Result<(), BakeError> {
        for buffer in document.buffers() {
            let bytes = match buffer.source() {
                buffer::Source::Bin => {
                    blob.ok_or_else(|| self.error("has no binary part, and names it"))?.to_vec()
                }
                buffer::Source::Uri(uri) => self.fetch(uri)?,
            };
            if bytes.len() < buffer.length() {
                let (index, expected, found) = (buffer.index(), buffer.length(), bytes.len());
                return Err(self.error(format!("buffer {index} has {found} bytes of {expected}")));
            }
            self.buffers.push(bytes);
        }
        Ok(())
    }

    fn scene(&mut self, document: &gltf::Document) -> Result<(), BakeError> {
        let mut left: Vec<(gltf::Node<'_>, Matrix)> = Vec::new();
        let scene = document.default_scene().or_else(|| document.scenes().next());
        if let Some(scene) = scene {
            left.extend(scene.nodes().map(|node| (node, IDENTITY)));
        } else {
            let mut is_child = vec![false; document.nodes().len()];
            for node in document.nodes() {
                node.children().for_each(|child| is_child[child.index()] = true);
            }
            left.extend(document.nodes().filter(|node| !is_child[node.index()]).map(|node| (node, IDENTITY)));
        }
        left.reverse();
        let mut is_seen = vec![false; document.nodes().len()];
        while let Some((node, above)) = left.pop() {
            if std::mem::replace(&mut is_seen[node.index()], true) {
                return Err(
                    self.error(format!("node {} stands below itself, or in two places", node.index()))
                );
            }
            let own = node.transform().matrix();
            let own: Matrix = own.map(|[x, y, z, _]| [x, y, z].map(f64::from));
            let matrix = [0, 1, 2, 3]
                .map(|column| transformed(&above, own[column], if column == 3 { 1.0 } else { 0.0 }));
            if let Some(mesh) = node.mesh() {
                let name = node.name().or_else(|| mesh.name()).unwrap_or_default();
                for primitive in mesh.primitives() {
                    self.primitive(&primitive, mesh.index(), name, &matrix)?;
                }
            }
            let mut children: Vec<_> = node.children().map(|child| (child, matrix)).collect();
            children.reverse();
            left.append(&mut children);
        }
        if self.left_out > 0 {
            self.warn(format!(
                "{} groups of points or lines are left out: only triangles are drawn",
                self.left_out
            ));
        }
        Ok(())
    }

    fn numbers<const N: usize>(&self, accessor: &gltf::Accessor<'_>) -> Result<Vec<[f64; N]>, BakeError> {
        accessor::read(accessor, &self.buffers).map_err(|problem| self.error(problem))
    }

    fn primitive(
        &mut self,
        primitive: &gltf::Primitive<'_>,
        mesh: usize,
        name: &str,
        matrix: &Matrix,
    ) -> Result<(), BakeError> {
        if matches!(primitive.mode(), Mode::Points | Mode::Lines | Mode::LineLoop | Mode::LineStrip) {
            self.left_out += 1;
            return Ok(());
        }
        let at = format!("mesh {mesh}, primitive {}", primitive.index());
        let Some(accessor) = primitive.get(&Semantic::Positions) else {
            return Err(self.error(format!("{at} has no positions")));
        };
        let (material, uv_set) = self.material(&primitive.material())?;
        let positions = self.numbers::<3>(&accessor)?;
        let count = positions.len();
        let same_count = |what: &str, found: usize| {
            if found == count {
                Ok(())
            } else {
                Err(self.error(format!("{at} has {count} positions and {found} {what}")))
            }
        };
        let normals = match primitive.get(&Semantic::Normals) {
            Some(accessor) => Some(self.numbers::<3>(&accessor)?),
            None => None,
        };
        if let Some(normals) = &normals {
            same_count("normals", normals.len())?;
        }
        let has_picture = self.model.materials[material].picture.is_some();
        let uvs = match primitive.get(&Semantic::TexCoords(uv_set)).filter(|_| has_picture) {
            Some(accessor) => Some(self.numbers::<2>(&accessor)?),
            None => None,
        };
        if let Some(uvs) = &uvs {
            same_count("texture coordinates", uvs.len())?;
        }
        let colors = match primitive.get(&Semantic::Colors(0)) {
            Some(accessor) if accessor.dimensions().multiplicity() == 4 => {
                Some(self.numbers::<4>(&accessor)?.into_iter().map(|[r, g, b, _]| [r, g, b]).collect())
            }
            Some(accessor) => Some(self.numbers::<3>(&accessor)?),
            None => None,
        };
        if let Some(colors) = &colors {
            same_count("colours", Vec::len(colors))?;
        }
        let indices: Vec<usize> = match primitive.indices() {
            Some(accessor) => {
                self.numbers::<1>(&accessor)?.into_iter().map(|[index]| index as usize).collect()
            }
            None => (0..count).collect(),
        };
        if let Some(bad) = indices.iter().find(|index| **index >= count) {
            return Err(self.error(format!("{at} names vertex {bad}, and has {count}")));
        }
        let mut is_used = vec![false; count];
        indices.iter().for_each(|index| is_used[*index] = true);
        let key = accessor.index();
        let unused = is_used.iter().filter(|used| !**used).count();
        let least = self.shown_unused.get(&key).copied().unwrap_or(usize::MAX).min(unused);
        self.shown_unused.insert(key, least);

        let [x, y, z, _] = *matrix;
        let is_mirrored = cross(x, y).iter().zip(z).map(|(a, b)| a * b).sum::<f64>() < 0.0;
        // Normals go with the inverse transpose, which these are, times the determinant.
        let mut for_normals = [cross(y, z), cross(z, x), cross(x, y), [0.0; 3]];
        if is_mirrored {
            for_normals.as_flattened_mut().iter_mut().for_each(|component| *component = -*component);
        }
        let mut bad_normals = 0;
        let mut vertices = Vec::with_capacity(count);
        for (i, point) in positions.iter().enumerate() {
            let position = transformed(matrix, *point, 1.0).map(|component| component as f32);
            if !position.iter().all(|component| component.is_finite()) {
                if !is_used[i] {
                    vertices.push(Corner { position: [0.0; 3], uv: None, normal: None, color: None });
                    continue;
                }
                return Err(self.error(format!("{at} has vertex {i} at {point:?}, which is not finite")));
            }
            let normal = normals.as_ref().and_then(|normals| {
                let normal =
                    unit(transformed(&for_normals, normals[i], 0.0).map(|component| component as f32));
                bad_normals += usize::from(normal.is_none());
                normal
            });
            let uv = uvs.as_ref().map(|uvs| uvs[i].map(|component| component as f32));
            if uv.is_some_and(|uv| !uv.iter().all(|component| component.is_finite())) {
                return Err(
                    self.error(format!("{at} has vertex {i} with texture coordinates that are not finite"))
                );
            }
            let color = colors.as_ref().map(|colors| colors[i].map(|channel| picture::shown(channel as f32)));
            vertices.push(Corner { position, uv, normal, color });
        }
        if bad_normals > 0 {
            self.warn(format!("{at}: {bad_normals} normals have no direction; they are computed"));
        }
        if has_picture && uvs.is_none() {
            self.warn(format!("{at} has a picture and no texture coordinates: it shows one texel"));
        }

        let triangles: Vec<[usize; 3]> = match primitive.mode() {
            Mode::TriangleStrip => (0..indices.len().saturating_sub(2))
                .map(|i| if i % 2 == 0 { [i, i + 1, i + 2] } else { [i + 1, i, i + 2] })
                .collect(),
            Mode::TriangleFan => (1..indices.len().saturating_sub(1)).map(|i| [0, i, i + 1]).collect(),
            _ => (0..indices.len() / 3).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect(),
        };
        if primitive.mode() == Mode::Triangles && !indices.len().is_multiple_of(3) {
            self.warn(format!(
                "{at} has {} corners, which make no whole triangles: the last are left out",
                indices.len()
            ));
        }
        if self.model.triangle_count() + triangles.len() > MOST_TRIANGLES {
            return Err(self.error(format!("has more than {MOST_TRIANGLES} triangles")));
        }
        let triangles = triangles.into_iter().map(|mut corners| {
            if is_mirrored {
                corners.swap(1, 2);
            }
            Triangle { corners: corners.map(|k| vertices[indices[k]]), smoothing: Smoothing::ByAngle }
        });
        let triangles = triangles.collect();
        self.model.parts.push(Part { name: name.to_owned(), material, triangles });
        Ok(())
    }

    /// A material's number, and which texture coordinates it takes.
    fn material(&mut self, given: &gltf::Material<'_>) -> Result<(usize, u32), BakeError> {
        if let Some(known) = self.materials.get(&given.index()) {
            return Ok(*known);
        }
        let mut material = RawMaterial::new(given.name().unwrap_or_default());
        let metallic = given.pbr_metallic_roughness();
        let (factor, texture) = match given.pbr_specular_glossiness() {
            Some(specular) => (specular.diffuse_factor(), specular.diffuse_texture()),
            None => (metallic.base_color_factor(), metallic.base_color_texture()),
        };
        material.color = [factor[0], factor[1], factor[2]].map(picture::shown);
        material.two_sided = given.double_sided();
        material.lit = !given.unlit();
        match given.alpha_mode() {
            AlphaMode::Opaque => {}
            AlphaMode::Mask => material.cutoff = Some(given.alpha_cutoff().unwrap_or(0.5)),
            AlphaMode::Blend => {
                material.alpha = factor[3].clamp(0.0, 1.0);
                material.blends = true;
            }
        }
        let mut uv_set = 0;
        if let Some(texture) = texture {
            uv_set = texture.tex_coord();
            if let Some(transform) = texture.texture_transform() {
                let ([u, v], [su, sv], angle) = (transform.offset(), transform.scale(), transform.rotation());
                let (sin, cos) = angle.sin_cos();
                material.transform = Some([[cos * su, sin * sv, u], [-sin * su, cos * sv, v]]);
                uv_set = transform.tex_coord().unwrap_or(uv_set);
            }
            let sampler = texture.texture().sampler();
            material.wrap = [sampler.wrap_s(), sampler.wrap_t()].map(|wrap| match wrap {
                WrappingMode::ClampToEdge => Wrap::Clamp,
                WrappingMode::MirroredRepeat => Wrap::Mirror,
                WrappingMode::Repeat => Wrap::Repeat,
            });
            material.picture =
                self.picture(texture.texture().source().index(), given.name().unwrap_or("?"))?;
        }
        self.model.materials.push(material);
        let known = (self.model.materials.len() - 1, uv_set);
        self.materials.insert(given.index(), known);
        Ok(known)
    }

    /// A picture's number; none if it cannot be read, which is a warning.
    fn picture(&mut self, index: usize, material: &str) -> Result<Option<usize>, BakeError> {
        if let Some(known) = self.pictures.get(&index) {
            return Ok(*known);
        }
        let document = self.image_json(index)?;
        let (bytes, name) = match document {
            (Some(uri), _) if !uri.starts_with("data:") => match self.fetch(&uri) {
                Ok(bytes) => (bytes, uri),
                Err(problem) => {
                    let BakeError::Content { problem, .. } = problem else { return Err(problem) };
                    self.warn(format!("{problem}: material `{material}` has its colour"));
                    self.pictures.insert(index, None);
                    return Ok(None);
                }
            },
            (Some(uri), _) => (self.fetch(&uri)?, format!("picture {index}")),
            (None, Some(bytes)) => (bytes, format!("picture {index}")),
            (None, None) => return Err(self.error(format!("picture {index} is nowhere"))),
        };
        let is_file = !name.starts_with("picture ");
        let file = self.path.parent().unwrap_or(Path::new("")).join(&name);
        let (path, part) =
            if is_file { (file.as_path(), String::new()) } else { (self.path, format!("{name} ")) };
        let image = picture::decode(&bytes, path, &part)?;
        self.model.pictures.push(RawPicture { name, image });
        let number = self.model.pictures.len() - 1;
        self.pictures.insert(index, Some(number));
        Ok(Some(number))
    }

    fn image_json(&self, index: usize) -> Result<(Option<String>, Option<Vec<u8>>), BakeError> {
        self.images.get(index).cloned().ok_or_else(|| self.error(format!("there is no picture {index}")))
    }

    fn warn_of_what_moves(&mut self, document: &gltf::Document) {
        let moves = [
            (document.animations().len() > 0, "animations"),
            (document.skins().len() > 0, "skins"),
            (
                document
                    .meshes()
                    .flat_map(|mesh| mesh.primitives())
                    .any(|primitive| primitive.morph_targets().len() > 0),
                "morph targets",
            ),
        ];
        let moves: Vec<_> = moves.iter().filter(|(there, _)| *there).map(|(_, what)| *what).collect();
        if !moves.is_empty() {
            self.warn(format!("{} are left out: the model stands as it is stored", moves.join(" and ")));
        }
    }
}
