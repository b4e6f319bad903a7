//! Writes what was baked: a module of Rust with constants, or binary files.
//!
//! Vertices and triangles stand in the module as numbers, exactly as they are in flash; texels and masks in files beside it, which
//! compile in no time.

use crate::baked::{Baked, BakedMaterial, BakedMesh, ByteOrder, Paint};
use crate::error::BakeError;
use std::collections::HashSet;
use std::fmt::Write;
use std::path::{Path, PathBuf};

/// Names of constants, each once.
#[derive(Default)]
struct Names(HashSet<String>);

impl Names {
    fn new() -> Self {
        Self(["POSE", "DRAWS", "LIST_VERTICES", "LIST_TRIANGLES"].map(str::to_owned).into())
    }

    /// `wood, dark` → `WOOD_DARK`, with a number if there is one of that name.
    fn take(&mut self, name: &str, kind: &str) -> String {
        let mut words = String::new();
        for character in name.chars() {
            if character.is_ascii_alphanumeric() {
                words.push(character.to_ascii_uppercase());
            } else if !words.is_empty() && !words.ends_with('_') {
                words.push('_');
            }
        }
        let words = words.trim_end_matches('_');
        let plain = match (words.is_empty(), kind.is_empty()) {
            (true, _) => kind.to_owned(),
            (false, true) => words.to_owned(),
            (false, false) => format!("{words}_{kind}"),
        };
        let plain = if plain.starts_with(|c: char| c.is_ascii_digit()) { format!("N{plain}") } else { plain };
        let mut name = plain.clone();
        let mut number = 2;
        while !self.0.insert(name.clone()) {
            name = format!("{plain}_{number}");
            number += 1;
        }
        name
    }
}

/// The name of a file or a module.
pub(crate) fn snake(name: &str) -> String {
    Names::default().take(name, "MODEL").trim_end_matches("_MODEL").to_ascii_lowercase()
}

/// The files of a module: its text, and what it includes; by name.
pub(crate) fn module(baked: &Baked, module: &str, source: &str) -> Vec<(String, Vec<u8>)> {
    let mut names = Names::new();
    let mut files = Vec::new();
    let mut text = String::new();
    let report = &baked.report;
    // `write!` to a string does not fail.
    let _ = writeln!(
        text,
        "// Baked by fixel-bake from {source}: {} triangles, {} vertices, {} bytes of flash.\n",
        report.triangles,
        report.vertices,
        baked.flash()
    );
    let _ = writeln!(
        text,
        "/// Where the model stands as it was made: turn it with `POSE.rotated_y(…)`, place it with `.at(…)`.\n\
         ///\n/// {}\n\
         pub const POSE: ::fixel::Pose = ::fixel::Pose::IDENTITY.scaled_lit({:?});\n",
        pose_text(baked),
        baked.fit.scale as f32
    );
    let [vertices, triangles] = baked.in_list();
    let _ = writeln!(
        text,
        "/// How many draws [`draw`] and [`draw_in_list`] make.\npub const DRAWS: usize = {};\n\
         /// Vertices that a display list wants for the model, where nothing cuts it.\npub const LIST_VERTICES: usize = {vertices};\n\
         /// Triangles likewise.\npub const LIST_TRIANGLES: usize = {triangles};\n",
        baked.meshes.len()
    );
    let mut textures = Vec::new();
    for texture in &baked.textures {
        let name = names.take(&texture.name, "TEXTURE");
        let [log2_width, log2_height] = texture.log2;
        let [width, height] = texture.source;
        let file = format!("{module}_{}.rgb565", name.to_ascii_lowercase());
        let size = texture.size();
        let _ = writeln!(
            text,
            "/// {} × {} texels, of a picture of {width} × {height}.\n\
             pub static {name}: ::fixel::Texture<'static> =\n    \
             ::fixel::Texture::new(&::fixel::texels::<{}>(include_bytes!({file:?})), {log2_width}, {log2_height});\n",
            size.width,
            size.height,
            texture.texels.len()
        );
        files.push((file, texture.texels.iter().flat_map(|texel| texel.to_le_bytes()).collect()));
        let mask = texture.mask.as_ref().map(|bits| {
            let name = names.take(&texture.name, "MASK");
            let file = format!("{module}_{}.bits", name.to_ascii_lowercase());
            let _ = writeln!(
                text,
                "/// Which of its texels are there.\n\
                 pub static {name}: ::fixel::Mask<'static> =\n    \
                 ::fixel::Mask::new(include_bytes!({file:?}), {log2_width}, {log2_height});\n"
            );
            files.push((file, bits.clone()));
            name
        });
        textures.push((name, mask));
    }
    let mut materials = Vec::new();
    for material in &baked.materials {
        let name = names.take(&material.name, "MATERIAL");
        let (kind, value) = material_text(material, &textures);
        let _ = writeln!(text, "/// {}\npub const {name}: {kind} =\n    {value};\n", material_doc(material));
        materials.push(name);
    }
    let mut draws = Vec::new();
    for mesh in &baked.meshes {
        let name = names.take(&mesh.name, "MESH");
        mesh_text(mesh, &name, &mut text);
        draws.push((name, &materials[mesh.material]));
    }
    // What can be seen through comes last.
    let mut order: Vec<_> = (0..draws.len()).collect();
    order.sort_by_key(|number| baked.materials[baked.meshes[*number].material].alpha.is_some());
    let blends = baked.materials.iter().any(|material| material.alpha.is_some());
    let format = if blends { "BlendFormat" } else { "PixelFormat" };
    let _ = writeln!(
        text,
        "/// Draws the model into a band, at once.\n\
         pub fn draw<'a, A, F, D>(view: &::fixel::View<'_, A>, pose: &::fixel::Pose, band: &mut ::fixel::Band<'_, F, D>)\n\
         where\n    A: Copy + ::fixel::Air<'a, F>,\n    F: ::fixel::{format},\n    D: ::fixel::DepthFormat,\n{{"
    );
    for number in &order {
        let (mesh, material) = &draws[*number];
        let _ = writeln!(text, "    view.draw(&{mesh}, pose, &{material}, band);");
    }
    let _ = writeln!(
        text,
        "}}\n\n/// Draws the model into a display list, which may be full.\n///\n/// # Errors\n///\n\
         /// [`CapacityError`](::fixel::CapacityError) if it is: what was drawn before stays.\n\
         pub fn draw_in_list<'a, A, F, D, const N: usize>(\n    view: &::fixel::View<'_, A>,\n    pose: &::fixel::Pose,\n    \
         list: &mut ::fixel::DisplayList<'a, F, D, N>,\n) -> Result<(), ::fixel::CapacityError>\n\
         where\n    A: Copy + ::fixel::Air<'a, F>,\n    F: ::fixel::{format},\n    D: ::fixel::DepthFormat,\n{{"
    );
    for number in &order {
        let (mesh, material) = &draws[*number];
        let _ = writeln!(text, "    view.draw(&{mesh}, pose, &{material}, list)?;");
    }
    let _ = writeln!(text, "    Ok(())\n}}");
    files.insert(0, (format!("{module}.rs"), text.into_bytes()));
    files
}

fn pose_text(baked: &Baked) -> String {
    let fit = &baked.fit;
    let mut text = format!(
        "Vertices are within {} model units of where the file has them.",
        short(baked.report.largest_error)
    );
    if fit.unit != 1.0 {
        let _ = write!(text, " A model unit is {} world units.", fit.unit);
    }
    if fit.origin != [0.0; 3] {
        let [x, y, z] = fit.origin.map(short);
        let _ = write!(text, " Its origin is ({x}, {y}, {z}) of the model.");
    }
    text
}

/// With four digits.
pub(crate) fn short(number: f64) -> String {
    if number == 0.0 {
        return "0".into();
    }
    let digits = 3 - (number.abs().log10().floor() as i32);
    if (0..12).contains(&digits) {
        let text = format!("{number:.*}", digits as usize);
        if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text }
    } else if digits < 0 {
        format!("{number:.0}")
    } else {
        format!("{number:.3e}")
    }
}

/// A material's type and value.
fn material_text(material: &BakedMaterial, textures: &[(String, Option<String>)]) -> (String, String) {
    let (mut kind, mut value) = match material.paint {
        Paint::Flat(color) => ("Flat".to_owned(), format!("::fixel::Material::flat_bits({color:#06x})")),
        Paint::Gouraud => ("Gouraud".to_owned(), "::fixel::Material::gouraud()".to_owned()),
        Paint::Texture { texture, is_clamped, .. } => {
            let (kind, function) = if is_clamped { ("Clamped", "clamped") } else { ("Textured", "textured") };
            (kind.to_owned(), format!("::fixel::Material::{function}(&{})", textures[texture].0))
        }
    };
    if material.is_lit {
        kind = match kind.as_str() {
            "Flat" | "Gouraud" => "Gouraud".to_owned(),
            kind => format!("Lit{kind}"),
        };
        value.push_str(".lit()");
    }
    let mut kind = format!("::fixel::material::{kind}");
    let mut layer = "Opaque";
    if let Paint::Texture { texture, is_masked: true, .. } = material.paint
        && let Some(mask) = &textures[texture].1
    {
        kind = format!("::fixel::material::CutOut<{kind}>");
        layer = "Masked";
        let _ = write!(value, ".masked(&{mask})");
    }
    if let Some(alpha) = material.alpha {
        layer = "Over";
        let _ = write!(value, ".alpha({alpha})");
    }
    if material.is_two_sided {
        value.push_str(".two_sided()");
    }
    let layer = format!("::fixel::material::{layer}");
    (format!("::fixel::Material<'static, {kind}, ::fixel::QuarterPixel, {layer}>"), value)
}

fn material_doc(material: &BakedMaterial) -> String {
    let mut text = match material.paint {
        Paint::Flat(_) => "One colour".to_owned(),
        Paint::Gouraud => "The vertices' colours".to_owned(),
        Paint::Texture { .. } => "A texture".to_owned(),
    };
    if material.is_lit {
        text.push_str(", in light");
    }
    if material.is_two_sided {
        text.push_str(", seen from both sides");
    }
    text.push('.');
    text
}

fn mesh_text(mesh: &BakedMesh, name: &str, text: &mut String) {
    let (vertices, triangles) = (mesh.vertices.len(), mesh.triangles.len());
    let _ = writeln!(
        text,
        "/// {triangles} triangles, {vertices} vertices; {:.2} vertices are transformed a triangle.",
        mesh.transforms as f64 / triangles as f64
    );
    let (index, new) = if mesh.has_short_indices() { ("u8", "new_u8") } else { ("u16", "new") };
    let _ = writeln!(
        text,
        "pub const {name}: ::fixel::Mesh<'static> = {{\n    \
         const fn v(x: i16, y: i16, z: i16, u: i16, v: i16, color: [u8; 3], normal: [i8; 3]) -> ::fixel::Vertex {{\n        \
         use ::fixel::num::{{I4F12, I12F4}};\n        \
         let position = [I4F12::from_bits(x), I4F12::from_bits(y), I4F12::from_bits(z)];\n        \
         ::fixel::Vertex {{ position, uv: [I12F4::from_bits(u), I12F4::from_bits(v)], color, normal }}\n    }}\n    \
         static VERTICES: [::fixel::Vertex; {vertices}] = ["
    );
    for vertex in &mesh.vertices {
        let ([x, y, z], [u, v]) = (vertex.position.map(|at| at.to_bits()), vertex.uv.map(|at| at.to_bits()));
        let _ =
            writeln!(text, "        v({x}, {y}, {z}, {u}, {v}, {:?}, {:?}),", vertex.color, vertex.normal);
    }
    let _ = writeln!(text, "    ];\n    static TRIANGLES: [[{index}; 3]; {triangles}] = [");
    for triangles in mesh.triangles.chunks(8) {
        let line: Vec<_> = triangles.iter().map(|triangle| format!("{triangle:?},")).collect();
        let _ = writeln!(text, "        {}", line.join(" "));
    }
    let _ = writeln!(text, "    ];\n    ::fixel::Mesh::{new}(&VERTICES, &TRIANGLES)\n}};\n");
}

/// Binary files, by name.
pub(crate) fn binaries(baked: &Baked, module: &str, order: ByteOrder) -> Vec<(String, Vec<u8>)> {
    let mut names = Names::default();
    let mut files = Vec::new();
    let mut file = |name: &str, kind: &str, ending: &str, bytes: Vec<u8>| {
        let name = names.take(name, kind).to_ascii_lowercase();
        files.push((format!("{module}_{name}.{ending}"), bytes));
    };
    for mesh in &baked.meshes {
        file(&mesh.name, "MESH", "mesh", mesh.bytes(order));
    }
    for texture in &baked.textures {
        file(&texture.name, "TEXTURE", "texture", texture.bytes(order));
        if let Some(bytes) = texture.mask_bytes(order) {
            file(&texture.name, "MASK", "mask", bytes);
        }
    }
    files
}

/// Writes files into a folder, those that are not there as they should be.
pub(crate) fn save(folder: &Path, files: &[(String, Vec<u8>)]) -> Result<Vec<PathBuf>, BakeError> {
    let error = |path: &Path| {
        let path = path.to_owned();
        move |source| BakeError::Write { path, source }
    };
    std::fs::create_dir_all(folder).map_err(error(folder))?;
    let mut paths = Vec::new();
    for (name, bytes) in files {
        let path = folder.join(name);
        if std::fs::read(&path).ok().as_ref() != Some(bytes) {
            std::fs::write(&path, bytes).map_err(error(&path))?;
        }
        paths.push(path);
    }
    Ok(paths)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_of_constants_are_words_and_each_is_there_once() {
        let mut names = Names::new();
        assert_eq!(names.take("wood, dark!", "TEXTURE"), "WOOD_DARK_TEXTURE");
        assert_eq!(names.take("Wood Dark", "TEXTURE"), "WOOD_DARK_TEXTURE_2");
        assert_eq!(names.take("", "MESH"), "MESH");
        assert_eq!(names.take("木", "MESH"), "MESH_2");
        assert_eq!(names.take("3 hulls", "MESH"), "N3_HULLS_MESH");
        assert_eq!(snake("My Ship-2"), "my_ship_2");
        assert_eq!(snake("木"), "model");
    }

    #[test]
    fn numbers_are_short() {
        let shown = [0.0, 1.0, 0.000123456, 12345.6, 2.34567, -0.5, 1e-20].map(short);
        assert_eq!(shown, ["0", "1", "0.0001235", "12346", "2.346", "-0.5", "1.000e-20"]);
    }
}
