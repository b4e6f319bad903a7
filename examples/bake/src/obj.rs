//! OBJ files, and the MTL files that they name.
//!
//! A reader of its own: those that there are say no line where something is wrong, and one of them mixes up the coordinates of
//! vertices with a texture and those without.

use crate::error::{BakeError, Place, read as read_file};
use crate::model::{Corner, Model, Part, RawMaterial, Smoothing, Triangle};
use crate::{mtl, polygon, text};
use std::collections::HashMap;
use std::path::Path;

/// What a corner of a face names, from 0.
#[derive(Clone, Copy)]
struct Named {
    position: usize,
    uv: Option<usize>,
    normal: Option<usize>,
}

#[derive(Default)]
struct Reader {
    positions: Vec<[f32; 3]>,
    colors: HashMap<usize, [u8; 3]>,
    uvs: Vec<[f32; 2]>,
    normals: Vec<[f32; 3]>,
    is_used: Vec<bool>,
    /// By object and material.
    parts: HashMap<(String, usize), usize>,
    materials: HashMap<String, usize>,
    model: Model,
}

/// Reads an OBJ file.
pub(crate) fn read(path: &Path) -> Result<Model, BakeError> {
    let bytes = read_file(path)?;
    let text = text::decode(&bytes, path)?;
    let mut reader = Reader::default();
    reader.model.files.push(path.to_owned());
    let mut name = String::new();
    let mut material = None;
    let mut smoothing = Smoothing::ByAngle;
    let mut points_and_lines = (0, 0);
    let mut ignored: Vec<(String, usize)> = Vec::new();
    for (line, content) in text::lines(&text) {
        let place = || Place::line(path, line);
        let (keyword, rest) = content.split_once(char::is_whitespace).unwrap_or((&content, ""));
        let words: Vec<&str> = rest.split_whitespace().collect();
        match keyword {
            "v" => {
                let numbers = numbers(&words, place)?;
                let Some(&position) = numbers.first_chunk::<3>() else {
                    return Err(place().error(format!("a vertex of {} coordinates", numbers.len())));
                };
                if let Some(color) = numbers.get(3..6).filter(|_| numbers.len() > 5) {
                    let color = [color[0], color[1], color[2]].map(|channel| (channel * 255.0).round() as u8);
                    reader.colors.insert(reader.positions.len(), color);
                }
                reader.positions.push(position);
            }
            "vt" => {
                let numbers = numbers(&words, place)?;
                let Some(&u) = numbers.first() else {
                    return Err(place().error("a texture coordinate of no number"));
                };
                // v runs upwards in the file.
                reader.uvs.push([u, 1.0 - numbers.get(1).copied().unwrap_or(0.0)]);
            }
            "vn" => {
                let numbers = numbers(&words, place)?;
                let Some(&normal) = numbers.first_chunk::<3>() else {
                    return Err(place().error(format!("a normal of {} components", numbers.len())));
                };
                reader.normals.push(normal);
            }
            "f" | "fo" => {
                let corners =
                    words.iter().map(|word| reader.corner(word, place)).collect::<Result<Vec<_>, _>>()?;
                match corners.len() {
                    0 => return Err(place().error("a face without corners")),
                    1 => points_and_lines.0 += 1,
                    2 => points_and_lines.1 += 1,
                    _ => {
                        let material = *material.get_or_insert_with(|| reader.material(""));
                        reader.face(&corners, &name, material, smoothing);
                    }
                }
            }
            "p" => points_and_lines.0 += words.len(),
            "l" => points_and_lines.1 += 1,
            "o" | "g" => rest.trim().clone_into(&mut name),
            "s" => {
                smoothing = match rest.trim() {
                    "" | "off" | "0" => Smoothing::Flat,
                    "on" => Smoothing::Group(1),
                    group => Smoothing::Group(group.parse().map_err(|_| {
                        place().error(format!("`{group}` is no number of a smoothing group"))
                    })?),
                };
            }
            "usemtl" => material = Some(reader.material(rest.trim())),
            "mtllib" => reader.library(path, rest.trim(), place())?,
            _ if ignored.iter().any(|(seen, _)| seen == keyword) => {}
            _ => ignored.push((keyword.to_owned(), line)),
        }
    }
    let (points, lines) = points_and_lines;
    if points + lines > 0 {
        let text = format!("{points} points and {lines} lines are left out: only faces are drawn");
        reader.model.warnings.push(Place::file(path).warning(text));
    }
    for (keyword, line) in ignored {
        if keyword.len() > 20 || !keyword.chars().all(|c| c.is_ascii_alphanumeric() || c == '_') {
            return Err(Place::line(path, line).error("is no line of an OBJ file"));
        }
        let text = format!("`{keyword}` is left out: it is not known here");
        reader.model.warnings.push(Place::line(path, line).warning(text));
    }
    let unnamed = |material: &RawMaterial| !reader.materials.contains_key(&material.name);
    debug_assert!(!reader.model.materials.iter().any(unnamed));
    reader.model.unused_vertices =
        reader.positions.len() - reader.is_used.iter().filter(|used| **used).count();
    Ok(reader.model)
}

fn numbers(words: &[&str], place: impl Fn() -> Place) -> Result<Vec<f32>, BakeError> {
    let number = |word: &&str| match word.parse::<f32>() {
        Ok(number) if number.is_finite() => Ok(number),
        Ok(_) => Err(place().error(format!("`{word}` is not finite"))),
        Err(_) => Err(place().error(format!("`{word}` is no number"))),
    };
    words.iter().map(number).collect()
}

impl Reader {
    fn material(&mut self, name: &str) -> usize {
        let materials = &mut self.model.materials;
        *self.materials.entry(name.to_owned()).or_insert_with(|| {
            materials.push(RawMaterial::new(name));
            materials.len() - 1
        })
    }

    /// Reads what a `mtllib` names: one file, with spaces in its name, or several.
    fn library(&mut self, path: &Path, names: &str, place: Place) -> Result<(), BakeError> {
        let beside = path.parent().unwrap_or(Path::new(""));
        let whole = beside.join(names.replace('\\', "/"));
        let paths = if whole.is_file() {
            vec![whole]
        } else {
            names.split_whitespace().map(|name| beside.join(name.replace('\\', "/"))).collect()
        };
        for path in paths {
            if !path.is_file() {
                let text = format!("there is no {}: its materials are white", path.display());
                self.model.warnings.push(place.clone().warning(text));
                continue;
            }
            for material in mtl::read(&path, &mut self.model)? {
                let number = self.material(&material.name);
                self.model.materials[number] = material;
            }
        }
        Ok(())
    }

    /// `7`, `7/3`, `7//2` or `7/3/2`, from 1, or from −1 backwards.
    fn corner(&self, word: &str, place: impl Fn() -> Place) -> Result<Named, BakeError> {
        let mut parts = word.split('/');
        let mut index = |what: &str, count: usize| -> Result<Option<usize>, BakeError> {
            let Some(text) = parts.next().filter(|text| !text.is_empty()) else { return Ok(None) };
            let number: i64 =
                text.parse().map_err(|_| place().error(format!("`{word}` is no corner of a face")))?;
            let index = if number < 0 { number + count as i64 } else { number - 1 };
            if (0..count as i64).contains(&index) {
                return Ok(Some(index as usize));
            }
            Err(place().error(format!("a face names {what} {number}, and there are {count} so far")))
        };
        let position = index("vertex", self.positions.len())?;
        let uv = index("texture coordinate", self.uvs.len())?;
        let normal = index("normal", self.normals.len())?;
        let position = position.ok_or_else(|| place().error(format!("`{word}` is no corner of a face")))?;
        Ok(Named { position, uv, normal })
    }

    fn face(&mut self, corners: &[Named], name: &str, material: usize, smoothing: Smoothing) {
        self.is_used.resize(self.positions.len(), false);
        corners.iter().for_each(|corner| self.is_used[corner.position] = true);
        let points: Vec<_> = corners.iter().map(|corner| self.positions[corner.position]).collect();
        let triangles = polygon::triangles(&points);
        let next = self.model.parts.len();
        let part = *self.parts.entry((name.to_owned(), material)).or_insert(next);
        if part == next {
            self.model.parts.push(Part { name: name.to_owned(), material, triangles: Vec::new() });
        }
        let corner = |k: usize| {
            let named = corners[k];
            Corner {
                position: self.positions[named.position],
                uv: named.uv.map(|uv| self.uvs[uv]),
                normal: named.normal.and_then(|normal| unit(self.normals[normal])),
                color: self.colors.get(&named.position).copied(),
            }
        };
        let triangles =
            triangles.into_iter().map(|triangle| Triangle { corners: triangle.map(corner), smoothing });
        self.model.parts[part].triangles.extend(triangles);
    }
}

/// Of length 1; none without a direction.
pub(crate) fn unit(vector: [f32; 3]) -> Option<[f32; 3]> {
    let length = vector.iter().map(|component| f64::from(*component).powi(2)).sum::<f64>().sqrt();
    (length.is_finite() && length > 1e-30)
        .then(|| vector.map(|component| (f64::from(component) / length) as f32))
}
