//! The probe's second kind of case: a mesh before a camera.

use std::fmt::Write;

use embedded_graphics::prelude::Size;
use fixel::fixed::types::{I2F14, I4F12, I12F4, I16F16, U10F22};
use fixel::{Affine, Camera, Cull, Exact, Mesh, Pose, Quality, QuarterPixel, Surface, Vec3, Vertex};

use super::{Counting, MOST_TRIANGLES, Picture, Pixels, draw_all, report, words};

pub(super) const MAGIC: &[u8; 4] = b"MSH1";

const HEADER: usize = 80;
const VERTEX: usize = 20;
const TRIANGLE: usize = 12;
const MOST_VERTICES: u32 = 1 << 16;

/// The most bytes that a case has.
pub(super) const LONGEST: usize =
    HEADER + MOST_VERTICES as usize * VERTEX + MOST_TRIANGLES as usize * TRIANGLE;

/// How far the matrix may miss a rotation times a scale, in each element of its product with its transpose, over the
/// scale's square.
const TOLERANCE: f64 = 1e-4;

pub(super) struct Case {
    size: Size,
    cull: Cull,
    camera: Camera,
    pose: Pose,
    vertices: Vec<Vertex>,
    triangles: Vec<[u16; 3]>,
    /// Lengths of eye space are this many times those of the file, as log₂.
    enlarged: i32,
    /// What became of the file's numbers, in words.
    rounded: String,
}

type Rows = [[f64; 4]; 3];

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// The scale of a matrix that is a rotation times a scale.
fn scale(rows: &Rows) -> Result<f64, String> {
    if !rows.as_flattened().iter().all(|element| element.is_finite()) {
        return Err("its matrix has an element that is not finite".into());
    }
    let rows = rows.map(|[x, y, z, _]| [x, y, z]);
    let scale = rows.map(|row| dot(row, row).sqrt()).iter().sum::<f64>() / 3.0;
    if scale == 0.0 {
        return Err("its matrix has a scale of 0".into());
    }
    let unit = rows.map(|row| row.map(|element| element / scale));
    for (i, j) in [(0, 0), (1, 1), (2, 2), (0, 1), (1, 2), (2, 0)] {
        let miss = (dot(unit[i], unit[j]) - if i == j { 1.0 } else { 0.0 }).abs();
        if miss > TOLERANCE {
            return Err(format!(
                "its matrix is not a rotation times one scale: rows {i} and {j} miss that by {miss:.6}, more than {TOLERANCE}"
            ));
        }
    }
    if dot(unit[0], cross(unit[1], unit[2])) < 0.0 {
        return Err("its matrix is a mirror image, not a rotation".into());
    }
    Ok(scale)
}

impl Case {
    pub(super) fn parse(bytes: &[u8]) -> Result<Self, String> {
        let Some((header, data)) = bytes.split_first_chunk::<HEADER>() else {
            return Err(format!("it ends within its header: {} of {HEADER} bytes", bytes.len()));
        };
        let header = words::<HEADER, { HEADER / 4 }>(header);
        let [width, height, cull, vertex_count, triangle_count] =
            [1, 2, 3, 4, 5].map(|i: usize| u32::from_le_bytes(header[i]));
        let float = |i: usize| f64::from(f32::from_le_bytes(header[i]));
        let size = super::size(width, height)?;
        let cull = super::cull(cull)?;
        if vertex_count > MOST_VERTICES {
            return Err(format!("it has {vertex_count} vertices, but a mesh has at most {MOST_VERTICES}"));
        }
        if triangle_count > MOST_TRIANGLES {
            return Err(format!(
                "it has {triangle_count} triangles, but at most {MOST_TRIANGLES} can be told apart"
            ));
        }
        let (focal, near) = (float(6), float(7));
        if !(1.0 / 16.0..=8191.0).contains(&focal) {
            return Err(format!("its focal length is {focal}, not 1/16 to 8191 pixels"));
        }
        if !(near > 0.0 && near.is_finite()) {
            return Err(format!("its near plane is at {near}, not finite and above 0"));
        }
        let matrix: Rows = [0, 1, 2].map(|row| [0, 1, 2, 3].map(|column| float(8 + 4 * row + column)));
        let scale = scale(&matrix)?;

        let (in_vertices, in_triangles) =
            (vertex_count as usize * VERTEX, triangle_count as usize * TRIANGLE);
        let (found, needed) = (data.len(), in_vertices + in_triangles);
        if found != needed {
            let how = if found < needed { "ends within" } else { "goes on after" };
            return Err(format!(
                "it {how} its {vertex_count} vertices and {triangle_count} triangles: {found} bytes after the header, not {needed}"
            ));
        }
        let (vertices, triangles) = data.split_at(in_vertices);
        let (vertices, _) = vertices.as_chunks::<VERTEX>();
        let places = vertices.iter().enumerate().map(|(vertex, bytes)| {
            let place = words::<VERTEX, 5>(bytes).map(f32::from_le_bytes);
            for (name, value) in ["x", "y", "z"].into_iter().zip(place) {
                if !value.is_finite() {
                    return Err(format!("vertex {vertex}: {name} is {value}, not finite"));
                }
            }
            for (name, texels) in ["u", "v"].into_iter().zip(&place[3..]) {
                if !(-2047.0..=2047.0).contains(texels) {
                    return Err(format!("vertex {vertex}: {name} is {texels}, not within -2047 to 2047"));
                }
            }
            Ok(place.map(f64::from))
        });
        let places = places.collect::<Result<Vec<_>, String>>()?;
        let (triangles, _) = triangles.as_chunks::<TRIANGLE>();
        let triangles = triangles.iter().enumerate().map(|(triangle, bytes)| {
            let corners = words::<TRIANGLE, 3>(bytes).map(u32::from_le_bytes);
            match corners.iter().find(|index| **index >= vertex_count) {
                None => Ok(corners.map(|index| index as u16)),
                Some(index) => {
                    Err(format!("triangle {triangle} names vertex {index}, of {vertex_count} there are"))
                }
            }
        });
        let triangles = triangles.collect::<Result<Vec<_>, String>>()?;
        Numbers { size, cull, focal, near, matrix, scale }.in_the_crate(&places, triangles)
    }

    pub(super) fn picture(&self, quality: &str) -> Result<Picture, String> {
        let pixels = match quality {
            "exact" => self.draw::<Exact>(),
            "affine" => self.draw::<Affine>(),
            _ => self.draw::<QuarterPixel>(),
        }?;
        let near = self.camera.planes().0.to_num::<f64>() * 2f64.powi(-self.enlarged);
        let report = report(self.size, &pixels, near, |index, x, y| self.perspective(index, x, y));
        let drawn = format!("{} triangles\n{}", self.triangles.len(), self.rounded);
        Ok(Picture { size: self.size, report, drawn })
    }

    fn draw<Q: Quality>(&self) -> Result<Pixels, String> {
        let mesh = Mesh::try_new(&self.vertices, &self.triangles).map_err(|error| error.to_string())?;
        draw_all::<Q, Counting<true>>(self.size, self.cull, self.triangles.len(), |index, shader, band| {
            self.camera.draw(&mesh.part(index, index + 1), &self.pose, Surface::new(shader), band);
            Ok(())
        })
    }

    /// u and v of a triangle where a pixel centre's ray meets its plane, within the range of its corners.
    fn perspective(&self, index: u16, x: u32, y: u32) -> [f64; 2] {
        let focal = self.camera.focal_length().to_num::<f64>();
        let across = f64::from(x) + 0.5 - f64::from(self.size.width) / 2.0;
        let down = f64::from(y) + 0.5 - f64::from(self.size.height) / 2.0;
        let ray = [across / focal, -down / focal, -1.0];
        let corners = self.triangles[usize::from(index)].map(|i| &self.vertices[usize::from(i)]);
        let [a, b, c] = corners.map(|vertex| {
            let at: [f64; 3] =
                [0, 1, 2].map(|i| vertex.position[i].to_num::<f64>() * self.pose.scale[i].to_num::<f64>());
            let to = [self.pose.translation.x, self.pose.translation.y, self.pose.translation.z];
            [0, 1, 2].map(|row: usize| {
                let turn = self.pose.rotation[row].map(|element| element.to_num::<f64>());
                dot(turn, at) + to[row].to_num::<f64>()
            })
        });
        let shares = [dot(ray, cross(b, c)), dot(ray, cross(c, a)), dot(ray, cross(a, b))];
        let sum: f64 = shares.iter().sum();
        [0, 1].map(|axis: usize| {
            let texels = corners.map(|vertex| vertex.uv[axis].to_num::<f64>());
            let (low, high) = texels.iter().fold((texels[0], texels[0]), |(l, h), t| (l.min(*t), h.max(*t)));
            let exact = dot(shares, texels) / sum;
            if exact.is_finite() { exact.clamp(low, high) } else { texels[0] }
        })
    }
}

/// The header's numbers.
struct Numbers {
    size: Size,
    cull: Cull,
    focal: f64,
    near: f64,
    matrix: Rows,
    scale: f64,
}

impl Numbers {
    fn in_the_crate(self, places: &[[f64; 5]], triangles: Vec<[u16; 3]>) -> Result<Case, String> {
        // A mesh unit is 2^unit of the file's.
        let reach = places.iter().flat_map(|place| &place[..3]).fold(0.0, |most: f64, at| most.max(at.abs()));
        let step = |unit: i32| 2f64.powi(unit - 12);
        let fits = |unit: &i32| (reach / step(*unit)).round() < 32768.0;
        let unit = if reach > 0.0 { (-160..160).find(fits).unwrap_or(0) } else { 0 };
        let step = step(unit);

        let scale = self.scale * 2f64.powi(unit);
        let translation = self.matrix.map(|row| row[3]);
        let farthest = translation.iter().fold(self.near, |most: f64, at| most.max(at.abs()));
        let in_range = |enlarged: &i32| {
            let factor = 2f64.powi(*enlarged);
            scale * factor < 1023.0 && farthest * factor < 32767.0
        };
        let enlarged = (-320..320).rev().find(in_range).unwrap_or(0);
        let factor = 2f64.powi(enlarged);
        let near = self.near * factor;
        if near < 2f64.powi(-16) {
            return Err(format!(
                "its near plane is at {}, less than 2^-31 of the mesh's size or of its distance",
                self.near
            ));
        }
        if scale * factor < 2f64.powi(-22) {
            return Err(format!("its scale is {}, less than 2^-31 of its distance", self.scale));
        }

        let mut texels_rounded = 0;
        let vertices = places.iter().map(|&[x, y, z, u, v]| {
            let uv = [u, v].map(|texels| (texels * 16.0).round());
            texels_rounded += usize::from(uv != [u * 16.0, v * 16.0]);
            Vertex {
                position: [x, y, z].map(|at| I4F12::from_bits((at / step).round() as i16)),
                uv: uv.map(|texels| I12F4::from_bits(texels as i16)),
                ..Vertex::default()
            }
        });
        let vertices: Vec<_> = vertices.collect();
        let moved = vertices.iter().zip(places).flat_map(|(vertex, place)| {
            [0, 1, 2].map(|i: usize| (f64::from(vertex.position[i].to_bits()) * step - place[i]).abs())
        });
        let moved = moved.fold(0.0, f64::max);

        let [x, y, z] = translation.map(|at| I16F16::from_num(at * factor));
        let rotation =
            self.matrix.map(|[a, b, c, _]| [a, b, c].map(|element| I2F14::from_num(element / self.scale)));
        let pose = Pose { rotation, translation: Vec3::new(x, y, z), ..Pose::IDENTITY }
            .scaled(U10F22::from_num(scale * factor));
        let camera = Camera::focal(self.focal as f32, self.size).near(near as f32);

        let mut rounded = format!(
            "positions: steps of {step:e} mesh units, {:e} in eye space; moved by at most {moved:e} mesh units\n\
             matrix as drawn, from mesh to eye space:",
            step * self.scale
        );
        let as_drawn = pose.scale[0].to_num::<f64>() * 2f64.powi(-unit) / factor;
        for (row, to) in pose.rotation.iter().zip([x, y, z]) {
            let [a, b, c] = row.map(|element| element.to_num::<f64>() * as_drawn);
            let _ = write!(rounded, "\n  {a:e} {b:e} {c:e} {:e}", to.to_num::<f64>() / factor);
        }
        let near = camera.planes().0.to_num::<f64>() / factor;
        let _ = write!(rounded, "\nnear plane as drawn: {near:e}");
        if texels_rounded > 0 {
            let _ = write!(rounded, "\ntexels: of {texels_rounded} vertices rounded to 1/16");
        }
        let Self { size, cull, .. } = self;
        Ok(Case { size, cull, camera, pose, vertices, triangles, enlarged, rounded })
    }
}
