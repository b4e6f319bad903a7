//! From a model to what fixel draws.
//!
//! - In: a model as its file has it, and what was asked for.
//! - Out: meshes, materials and textures.
//! - Assumes: finite numbers.

use crate::baked::{Baked, BakedMaterial, BakedMesh, BakedTexture, Paint, Report};
use crate::cut::{MOST as MOST_TEXELS, MOST_CLAMPED, TexelCorner, TexelTriangle};
use crate::error::{BakeError, Place};
use crate::fit::Fit;
use crate::model::{Model, RawMaterial, Wrap};
use crate::picture::{Recipe, Texels};
use crate::{Options, check, cut, normals, order, picture};
use fixel::Vertex;
use fixel::fixed::types::{I4F12, I12F4};
use std::collections::{BTreeMap, HashMap};
use std::path::Path;

/// The most vertices, and triangles, of a mesh.
const MOST: usize = 65_535;

/// How a material's texture coordinates become texels.
#[derive(Clone, Copy)]
struct Placing {
    extent: [f64; 2],
    period: [f64; 2],
    is_clamped: bool,
    /// Whether they stay inside the picture, but for rounding.
    stays: [bool; 2],
}

pub(crate) fn bake(
    mut model: Model,
    path: &Path,
    options: &Options,
    progress: &mut dyn FnMut(&str, usize, usize),
) -> Result<Baked, BakeError> {
    let mut warnings = std::mem::take(&mut model.warnings);
    let mut warn = |text: String| warnings.push(Place::file(path).warning(text));
    let name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
    let surfaces = check::surfaces(&model.parts);
    check::texts(&surfaces).into_iter().for_each(&mut warn);
    if model.unused_vertices > 0 {
        warn(format!("{} vertices that no triangle has are left out", model.unused_vertices));
    }
    if options.unlit {
        model.materials.iter_mut().for_each(|material| material.lit = false);
    }
    let mut report = Report {
        triangles_read: model.triangle_count(),
        unused_vertices: model.unused_vertices,
        ..Report::default()
    };
    progress("normals", 0, 1);
    if model.parts.iter().any(|part| model.materials[part.material].lit) {
        report.computed_normals = normals::complete(&mut model.parts, options.crease);
    }

    let fit = fit(&model, options, path, &mut warn)?;

    // Which triangles go together: those of one material, unless objects were asked for.
    let mut groups: BTreeMap<(usize, &str), Vec<usize>> = BTreeMap::new();
    for (number, part) in model.parts.iter().enumerate() {
        let object = if options.objects { part.name.as_str() } else { "" };
        groups.entry((part.material, object)).or_default().push(number);
    }
    let mut groups: Vec<_> = groups.into_iter().collect();
    groups.sort_by_key(|(_, parts)| parts[0]);

    progress("pictures", 0, model.pictures.len().max(1));
    let mut textures = Textures::default();
    let mut placings = HashMap::new();
    let mut paints = HashMap::new();
    for (number, material) in model.materials.iter().enumerate() {
        let own =
            || model.parts.iter().filter(|part| part.material == number).flat_map(|part| &part.triangles);
        if own().next().is_none() {
            continue;
        }
        let has_colors = own().flat_map(|triangle| &triangle.corners).any(|corner| corner.color.is_some());
        let paint = match material.picture {
            Some(at) => {
                let uvs = own()
                    .flat_map(|triangle| &triangle.corners)
                    .map(|corner| transformed_uv(material, corner.uv));
                let (paint, placing) = textures.of(material, at, uvs, &model, options, &mut warn);
                placings.insert(number, placing);
                if has_colors {
                    warn(format!("`{}` has a picture: its vertices' colours are left out", material.name));
                }
                paint
            }
            None if has_colors => Paint::Gouraud,
            None => Paint::Flat(picture::rgb565(material.color)),
        };
        paints.insert(number, paint);
    }

    let mut parts: Vec<Vec<TexelTriangle>> = Vec::new();
    for ((material, _), numbers) in &groups {
        let material_of = &model.materials[*material];
        let placing = placings.get(material);
        let triangles = numbers.iter().flat_map(|number| &model.parts[*number].triangles);
        let with_texels = triangles.map(|triangle| {
            triangle.corners.map(|corner| TexelCorner {
                corner,
                texels: placing.map_or([0.0; 2], |placing| texels_of(material_of, corner.uv, placing)),
            })
        });
        parts.push(with_texels.collect());
    }
    let most: Vec<f64> = groups
        .iter()
        .map(|((material, _), _)| placings.get(material).filter(|placing| placing.is_clamped))
        .map(|clamped| if clamped.is_some() { MOST_CLAMPED } else { MOST_TEXELS })
        .collect();
    let Some(count) = cut::cut(&mut parts, &most) else {
        let problem = "texture coordinates repeat a picture too often over one triangle: they would be cut into a million";
        return Err(Place::file(path).error(problem));
    };
    report.cut = count;
    if count > 0 {
        warn(format!(
            "{count} times a triangle was cut whose texture coordinates span more than {MOST_TEXELS} texels"
        ));
    }

    let mut baked = Baked {
        name,
        files: std::mem::take(&mut model.files),
        fit,
        meshes: Vec::new(),
        materials: Vec::new(),
        textures: textures.baked,
        warnings: Vec::new(),
        surfaces,
        report,
    };
    let mut materials = HashMap::new();
    let mut chunks = Vec::new();
    let mut area = 0.0;
    let mut bounds = [[f64::MAX; 3], [f64::MIN; 3]];
    let mut collapsed_to_nothing = 0;
    for (((material, object), _), mut triangles) in groups.iter().zip(parts) {
        let given = &model.materials[*material];
        let paint = paints[material];
        if let Some(placing) = placings.get(material).filter(|placing| !placing.is_clamped) {
            cut::shift(&mut triangles, placing.period);
        }
        let mut found: Vec<[Vertex; 3]> = Vec::with_capacity(triangles.len());
        for triangle in &triangles {
            let corners = triangle.map(|corner| vertex(&corner, &fit, given, paint));
            for (corner, vertex) in triangle.iter().zip(&corners) {
                let exact = corner.corner.position.map(f64::from);
                let is = fit.model(vertex.position.map(I4F12::to_bits));
                let error = (0..3).map(|i| (exact[i] - is[i]).powi(2)).sum::<f64>().sqrt();
                baked.report.largest_error = baked.report.largest_error.max(error);
            }
            let points = corners.map(|corner| fit.model(corner.position.map(I4F12::to_bits)));
            for point in points {
                for i in 0..3 {
                    bounds[0][i] = bounds[0][i].min(point[i]);
                    bounds[1][i] = bounds[1][i].max(point[i]);
                }
            }
            if is_flat(&corners) {
                baked.report.collapsed += 1;
                continue;
            }
            area += area_of(points);
            found.push(corners);
        }
        if found.is_empty() {
            collapsed_to_nothing += 1;
            continue;
        }
        let material_number = *materials.entry(*material).or_insert_with(|| {
            baked.materials.push(BakedMaterial {
                name: given.name.clone(),
                paint,
                is_lit: given.lit,
                alpha: Some((given.alpha * 255.0).round() as u8).filter(|alpha| *alpha < 255),
                is_two_sided: given.two_sided,
            });
            baked.materials.len() - 1
        });
        let name = if object.is_empty() { given.name.as_str() } else { *object };
        let pieces = split(&found);
        let many = pieces.len() > 1;
        for (number, piece) in pieces.into_iter().enumerate() {
            let name = if many { format!("{name} {}", number + 1) } else { name.to_owned() };
            chunks.push((name, material_number, piece));
        }
    }
    if chunks.is_empty() {
        let text = format!("all {} triangles are without area", baked.report.triangles_read);
        return Err(Place::file(path).error(text));
    }
    if collapsed_to_nothing > 0 {
        warn(format!(
            "{collapsed_to_nothing} parts are smaller than a step of positions, {}",
            fit.scale / fit.unit / 4096.0
        ));
    }
    let total: usize = chunks.iter().map(|(_, _, piece)| piece.triangles.len()).sum();
    let mut done = 0;
    for (name, material, piece) in chunks {
        let count = piece.triangles.len();
        let before = order::in_given_order(&piece.triangles, piece.vertices.len()).transforms;
        let best = order::order(&piece.triangles, piece.vertices.len(), options.thorough, &mut |part| {
            progress("order", done + (count as f64 * part) as usize, total);
        });
        done += count;
        let mut vertices = vec![Vertex::default(); best.vertices];
        for (old, new) in best.numbers.iter().enumerate() {
            if let Some(new) = new {
                vertices[*new as usize] = piece.vertices[old];
            }
        }
        let triangles = best.triangles.iter().map(|triangle| triangle.map(|index| index as u16)).collect();
        baked.report.transforms_before += before;
        baked.report.transforms += best.transforms;
        baked.report.vertices += vertices.len();
        baked.report.triangles += count;
        let mesh = BakedMesh {
            name,
            material,
            vertices,
            triangles,
            transforms_before: before,
            transforms: best.transforms,
        };
        baked.meshes.push(mesh);
    }
    baked.report.area = area;
    baked.report.bounds = bounds;
    baked.warnings = warnings;
    Ok(baked)
}

/// Finds the scale, or says that the model does not fit the one that was asked for.
fn fit(
    model: &Model,
    options: &Options,
    path: &Path,
    warn: &mut impl FnMut(String),
) -> Result<Fit, BakeError> {
    let (mut low, mut high) = ([f64::MAX; 3], [f64::MIN; 3]);
    let corners = model.parts.iter().flat_map(|part| &part.triangles).flat_map(|triangle| &triangle.corners);
    for corner in corners {
        for i in 0..3 {
            low[i] = low[i].min(corner.position[i].into());
            high[i] = high[i].max(corner.position[i].into());
        }
    }
    let middle = [0, 1, 2].map(|i| f64::midpoint(low[i], high[i]));
    let longest = (0..3).map(|i| high[i] - low[i]).fold(0.0, f64::max);
    let unit = options.size.filter(|_| longest > 0.0).map(|size| size / longest).or(options.unit);
    let centered = Fit::new(low, high, middle, unit);
    if options.center {
        return check_fit(centered, low, high, path, warn, options);
    }
    let fit = Fit::new(low, high, [0.0; 3], unit);
    if fit.scale / fit.unit > 4.0 * centered.scale / centered.unit {
        warn(format!(
            "the model stands so far from its origin that it has {:.0} times as coarse steps as it could: centre it",
            fit.scale / fit.unit / (centered.scale / centered.unit)
        ));
    }
    check_fit(fit, low, high, path, warn, options)
}

fn check_fit(
    fit: Fit,
    low: [f64; 3],
    high: [f64; 3],
    path: &Path,
    warn: &mut impl FnMut(String),
    options: &Options,
) -> Result<Fit, BakeError> {
    if !fit.holds(low, high) {
        let reach = (0..3).map(|i| (high[i] - fit.origin[i]).max(fit.origin[i] - low[i])).fold(0.0, f64::max);
        let problem = format!(
            "reaches {reach} units, and with a unit of {} only {} can be held",
            fit.unit,
            4095.0 / fit.unit
        );
        return Err(Place::file(path).error(problem));
    }
    if options.unit.is_none() && options.size.is_none() && fit.unit != 1.0 {
        warn(format!(
            "the model is larger than a pose can make it: a unit of the model is 1/{} unit of the world",
            1.0 / fit.unit
        ));
    }
    Ok(fit)
}

fn transformed_uv(material: &RawMaterial, uv: Option<[f32; 2]>) -> [f64; 2] {
    let [u, v] = uv.unwrap_or_default();
    let (u, v) = (f64::from(u), f64::from(v));
    match material.transform {
        Some(rows) => rows.map(|[a, b, c]| f64::from(a) * u + f64::from(b) * v + f64::from(c)),
        None => [u, v],
    }
}

fn texels_of(material: &RawMaterial, uv: Option<[f32; 2]>, placing: &Placing) -> [f64; 2] {
    let uv = transformed_uv(material, uv);
    [0, 1].map(|i| {
        let at = if placing.stays[i] { uv[i].clamp(0.0, 1.0) } else { uv[i] };
        at * placing.extent[i]
    })
}

/// Textures of pictures, each made once for what it is needed as.
#[derive(Default)]
struct Textures {
    known: HashMap<Recipe, (usize, [u32; 2], [u32; 2])>,
    baked: Vec<BakedTexture>,
}

impl Textures {
    fn of(
        &mut self,
        material: &RawMaterial,
        at: usize,
        uvs: impl Iterator<Item = [f64; 2]>,
        model: &Model,
        options: &Options,
        warn: &mut impl FnMut(String),
    ) -> (Paint, Placing) {
        let source = &model.pictures[at];
        // Within a five-hundredth of the picture: files round.
        let mut leaves = [false; 2];
        for uv in uvs {
            leaves = [0, 1].map(|i| leaves[i] || uv[i] < -0.002 || uv[i] > 1.002);
        }
        let does = |wrap: Wrap| [0, 1].map(|i| leaves[i] && material.wrap[i] == wrap);
        let (clamps, mirrors) = (does(Wrap::Clamp), does(Wrap::Mirror));
        let repeats = does(Wrap::Repeat) != [false; 2] || mirrors != [false; 2];
        let is_clamped = clamps != [false; 2] && !repeats;
        if clamps != [false; 2] && repeats {
            warn(format!(
                "`{}` repeats its picture along one side and not along the other: it repeats along both",
                material.name
            ));
        }
        let has_holes = source.image.pixels().any(|pixel| pixel[3] < 255);
        let cutoff = match material.cutoff {
            Some(cutoff) => Some((cutoff * 255.0).ceil().clamp(0.0, 255.0) as u8),
            None if material.blends && has_holes => Some(128),
            None => None,
        };
        let recipe = Recipe {
            picture: at,
            color: material.color,
            cutoff,
            mirrored: mirrors,
            repeats,
            longest: options.longest,
        };
        let (texture, size, extent) = *self.known.entry(recipe).or_insert_with(|| {
            let made: Texels = picture::texels(&source.image, &recipe);
            if cutoff.is_some() && made.is_translucent && material.blends {
                warn(format!(
                    "{} is translucent in places: it is cut out where it is less than half opaque",
                    source.name
                ));
            }
            let name = source.name.rsplit(['/', '\\']).next().unwrap_or_default();
            let name = name.rsplit_once('.').map_or(name, |(name, _)| name).to_owned();
            self.baked.push(BakedTexture {
                name,
                log2: made.size.map(u32::ilog2),
                texels: made.words,
                mask: made.mask,
                source: source.image.dimensions().into(),
            });
            (self.baked.len() - 1, made.size, made.extent)
        });
        let halved = |i: usize, texels: f64| if mirrors[i] { texels / 2.0 } else { texels };
        let placing = Placing {
            extent: [0, 1].map(|i| halved(i, extent[i].into())),
            period: size.map(f64::from),
            is_clamped,
            stays: leaves.map(|leaves| !leaves),
        };
        let is_masked = self.baked[texture].mask.is_some();
        (Paint::Texture { texture, is_clamped, is_masked }, placing)
    }
}

fn vertex(corner: &TexelCorner, fit: &Fit, material: &RawMaterial, paint: Paint) -> Vertex {
    // What is beyond a clamped texture is its border, however far: that was cut so that none reaches into the texture.
    let uv = corner.texels.map(|at| I12F4::from_bits((at * 16.0).round().clamp(-32768.0, 32767.0) as i16));
    let normal = corner.corner.normal.filter(|_| material.lit).unwrap_or_default();
    let color = match paint {
        Paint::Gouraud => {
            let own = corner.corner.color.unwrap_or([255; 3]);
            [0, 1, 2].map(|i| ((u16::from(own[i]) * u16::from(material.color[i]) + 127) / 255) as u8)
        }
        _ => [255; 3],
    };
    Vertex {
        position: fit.bits(corner.corner.position).map(I4F12::from_bits),
        uv: if matches!(paint, Paint::Texture { .. }) { uv } else { [I12F4::ZERO; 2] },
        color,
        normal: normal.map(|component| (component * 127.0).round().clamp(-127.0, 127.0) as i8),
    }
}

/// Whether a triangle has no area, in steps of positions.
fn is_flat(corners: &[Vertex; 3]) -> bool {
    let [a, b, c] = corners.map(|corner| corner.position.map(|at| i64::from(at.to_bits())));
    let (p, q) = ([0, 1, 2].map(|i| b[i] - a[i]), [0, 1, 2].map(|i| c[i] - a[i]));
    [(0, 1), (1, 2), (2, 0)].iter().all(|(i, j)| p[*i] * q[*j] == p[*j] * q[*i])
}

fn area_of([a, b, c]: [[f64; 3]; 3]) -> f64 {
    let (p, q) = ([0, 1, 2].map(|i| b[i] - a[i]), [0, 1, 2].map(|i| c[i] - a[i]));
    let cross = [(0, 1), (1, 2), (2, 0)].map(|(i, j)| p[i] * q[j] - p[j] * q[i]);
    cross.iter().map(|component| component * component).sum::<f64>().sqrt() / 2.0
}

/// Vertices, each once, and triangles.
struct Piece {
    vertices: Vec<Vertex>,
    triangles: Vec<[u32; 3]>,
}

/// Welds vertices, into as many pieces as it takes for none to have too many.
fn split(triangles: &[[Vertex; 3]]) -> Vec<Piece> {
    let new = || Piece { vertices: Vec::new(), triangles: Vec::new() };
    let mut pieces = vec![new()];
    let mut numbers: HashMap<[u8; 16], u32> = HashMap::new();
    for corners in triangles {
        let piece = pieces.last().map(|piece| (piece.vertices.len(), piece.triangles.len()));
        if piece.is_some_and(|(vertices, triangles)| vertices + 3 > MOST || triangles + 1 > MOST) {
            pieces.push(new());
            numbers.clear();
        }
        let Some(piece) = pieces.last_mut() else { break };
        let triangle = corners.map(|vertex| {
            *numbers.entry(bytemuck::must_cast(vertex)).or_insert_with(|| {
                piece.vertices.push(vertex);
                piece.vertices.len() as u32 - 1
            })
        });
        piece.triangles.push(triangle);
    }
    pieces
}
