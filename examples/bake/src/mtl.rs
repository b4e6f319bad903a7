//! MTL files: materials of OBJ files.

use crate::error::{BakeError, Place, read as read_file};
use crate::model::{Model, RawMaterial, Wrap};
use crate::{picture, text};
use std::path::{Path, PathBuf};

/// Reads the materials of a file. Pictures and warnings go to the model.
pub(crate) fn read(path: &Path, model: &mut Model) -> Result<Vec<RawMaterial>, BakeError> {
    let bytes = read_file(path)?;
    model.files.push(path.to_owned());
    let text = text::decode(&bytes, path)?;
    let mut materials: Vec<RawMaterial> = Vec::new();
    for (line, content) in text::lines(&text) {
        let place = || Place::line(path, line);
        let (keyword, rest) = content.split_once(char::is_whitespace).unwrap_or((&content, ""));
        let rest = rest.trim();
        if keyword == "newmtl" {
            materials.push(RawMaterial::new(rest));
            continue;
        }
        let Some(material) = materials.last_mut() else { continue };
        let number = |word: &str| -> Result<f32, BakeError> {
            let number = word.parse::<f32>().ok().filter(|number| number.is_finite());
            number.ok_or_else(|| place().error(format!("`{word}` is no number")))
        };
        match keyword {
            "Kd" if rest.starts_with("spectral") || rest.starts_with("xyz") => {
                model.warnings.push(place().warning("a colour that is not red, green and blue: it is white"));
            }
            "Kd" => {
                let channels = rest.split_whitespace().map(number).collect::<Result<Vec<_>, _>>()?;
                let color = match channels[..] {
                    [gray] => [gray; 3],
                    [red, green, blue, ..] => [red, green, blue],
                    _ => return Err(place().error(format!("a colour of {} channels", channels.len()))),
                };
                material.color = color.map(|channel| (channel * 255.0).round() as u8);
            }
            "d" | "Tr" => {
                let word = rest.split_whitespace().last().unwrap_or_default();
                let number = number(word)?;
                let alpha = if keyword == "d" { number } else { 1.0 - number };
                // Some programs write `d 0` and mean the other.
                if alpha > 0.0 {
                    material.alpha = alpha.min(1.0);
                } else {
                    let text = format!("material `{}` would not be seen at all: it is opaque", material.name);
                    model.warnings.push(place().warning(text));
                }
            }
            "map_Kd" | "map_kd" => {
                let (file, is_clamped) = map(rest);
                match find(path, file) {
                    Some(found) => {
                        material.picture = Some(picture::add(&found, model)?);
                        // Where the picture has holes.
                        material.blends = true;
                    }
                    None => {
                        let text = format!(
                            "there is no picture `{file}`: material `{}` has its colour",
                            material.name
                        );
                        model.warnings.push(place().warning(text));
                    }
                }
                if is_clamped {
                    material.wrap = [Wrap::Clamp; 2];
                }
            }
            "map_d" => {
                let (file, _) = map(rest);
                match (find(path, file), material.picture) {
                    (Some(found), Some(colors)) => {
                        let mask = picture::add(&found, model)?;
                        if mask != colors {
                            material.picture = Some(picture::add_with_alpha(colors, mask, model));
                        }
                        material.cutoff = Some(0.5);
                    }
                    _ => {
                        let text = format!(
                            "`map_d {file}` is left out: it wants a picture, and a `map_Kd` before it"
                        );
                        model.warnings.push(place().warning(text));
                    }
                }
            }
            _ => {}
        }
    }
    for material in &mut materials {
        if material.picture.is_some() {
            // Programs write any colour beside a picture, black too.
            material.color = [255; 3];
        }
    }
    Ok(materials)
}

/// The file's name behind options, and whether one of them is to clamp.
fn map(rest: &str) -> (&str, bool) {
    let mut rest = rest.trim();
    let mut is_clamped = false;
    while let Some(option) = rest.strip_prefix('-') {
        let (name, mut after) = option.split_once(char::is_whitespace).unwrap_or((option, ""));
        let (least, most) = match name {
            "o" | "s" | "t" => (1, 3),
            "mm" => (2, 2),
            _ => (1, 1),
        };
        for count in 0..most {
            let (word, further) =
                after.trim_start().split_once(char::is_whitespace).unwrap_or((after.trim_start(), ""));
            if count >= least && word.parse::<f32>().is_err() {
                break;
            }
            is_clamped |= name == "clamp" && word == "on";
            after = further;
        }
        rest = after.trim_start();
    }
    (rest, is_clamped)
}

/// A picture where the file says, or beside it: names are often those of another machine.
fn find(path: &Path, name: &str) -> Option<PathBuf> {
    let beside = path.parent().unwrap_or(Path::new(""));
    let name = name.trim_matches('"').replace('\\', "/");
    let last = name.rsplit('/').next().unwrap_or_default();
    let here = [beside.join(&name), beside.join(last)].into_iter().find(|path| path.is_file());
    here.or_else(|| {
        let entries = std::fs::read_dir(beside).ok()?.flatten();
        let mut alike: Vec<_> =
            entries.filter(|entry| entry.file_name().to_string_lossy().eq_ignore_ascii_case(last)).collect();
        alike.sort_by_key(std::fs::DirEntry::file_name);
        alike.first().map(std::fs::DirEntry::path)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn options_of_maps_are_left_out() {
        assert_eq!(map("wood.png"), ("wood.png", false));
        assert_eq!(map("-s 2 2 1 -clamp on my wood.png"), ("my wood.png", true));
        assert_eq!(map("-o 0.5 a.png"), ("a.png", false));
        assert_eq!(map("-mm 0 1 -bm 0.3 a b.png"), ("a b.png", false));
    }
}
