//! Meshes from OBJ files.

use fixel::fixed::types::I12F4;
use fixel::{Mesh, MeshError, Vertex};
use std::collections::HashMap;
use std::error::Error;
use std::path::Path;

/// A decoded mesh.
pub struct Model {
    vertices: Vec<Vertex>,
    triangles: Vec<[u16; 3]>,
}

impl Model {
    /// Decodes an OBJ file. Its longest side is made `size` mesh units long and its middle the origin; texture
    /// coordinates are times `texels`; normals are made where the file has none.
    #[expect(clippy::float_arithmetic, reason = "on a desktop")]
    pub fn open(path: &Path, size: f32, texels: [f32; 2]) -> Result<Self, Box<dyn Error>> {
        let in_file = |error: &dyn std::fmt::Display| format!("{}: {error}", path.display());
        let options = tobj::LoadOptions { triangulate: true, single_index: true, ..Default::default() };
        let (models, _) = tobj::load_obj(path, &options).map_err(|error| in_file(&error))?;
        let mesh = &models.first().ok_or_else(|| in_file(&"no mesh in it"))?.mesh;

        let (points, rest) = mesh.positions.as_chunks::<3>();
        if !rest.is_empty() || points.len() > 1 << 16 {
            return Err(in_file(&format!("{} coordinates", mesh.positions.len())).into());
        }
        let (faces, _) = mesh.indices.as_chunks::<3>();
        if faces.is_empty() || !points.as_flattened().iter().all(|coordinate| coordinate.is_finite()) {
            return Err(in_file(&"no triangles, or coordinates that are no numbers").into());
        }
        let corner = |index: u32| points.get(index as usize).copied();
        let (mut low, mut high) = ([f32::MAX; 3], [f32::MIN; 3]);
        for point in points {
            for axis in 0..3 {
                low[axis] = low[axis].min(point[axis]);
                high[axis] = high[axis].max(point[axis]);
            }
        }
        let longest = (0..3).map(|axis| high[axis] - low[axis]).fold(0.0, f32::max);
        let scale = if longest > 0.0 { size / longest } else { 0.0 };

        // The normal at a place is the sum of its faces', each as long as the face is large; patches of a surface have
        // vertices of their own at the same places.
        let mut at_place = HashMap::new();
        let place = |point: &[f32; 3]| point.map(f32::to_bits);
        let mut triangles = Vec::new();
        for face in faces {
            let [Some(a), Some(b), Some(c)] = face.map(corner) else {
                return Err(in_file(&format!("a face of vertices {face:?}")).into());
            };
            let [p, q] = [b, c].map(|end| [0, 1, 2].map(|axis| end[axis] - a[axis]));
            for axis in 0..3 {
                let [i, j] = [(axis + 1) % 3, (axis + 2) % 3];
                for corner in [a, b, c] {
                    at_place.entry(place(&corner)).or_insert([0.0f32; 3])[axis] += p[i] * q[j] - p[j] * q[i];
                }
            }
            triangles.push(face.map(|index| index as u16));
        }
        let mut normals: Vec<_> =
            points.iter().map(|point| at_place.get(&place(point)).copied().unwrap_or_default()).collect();
        if let (given, []) = mesh.normals.as_chunks::<3>()
            && given.len() == normals.len()
        {
            normals.copy_from_slice(given);
        }

        let vertices = points.iter().zip(&normals).enumerate().map(|(i, (point, normal))| {
            let [x, y, z] = [0, 1, 2].map(|axis| (point[axis] - (low[axis] + high[axis]) / 2.0) * scale);
            // No square of an f32 is 0 or too large in f64.
            let length =
                normal.iter().map(|n| f64::from(*n).powi(2)).sum::<f64>().sqrt().max(f64::MIN_POSITIVE);
            let [nx, ny, nz] = normal.map(|n| (f64::from(n) / length) as f32);
            let [u, v] = match mesh.texcoords.get(2 * i..2 * i + 2) {
                // v runs upwards in the file.
                Some(&[u, v]) => [u * texels[0], (1.0 - v) * texels[1]],
                _ => [0.0; 2],
            };
            let [Some(u), Some(v)] = [u, v].map(I12F4::checked_from_num) else {
                return Err(in_file(&format!("texture coordinates of ({u}, {v}) texels")).into());
            };
            let vertex = Vertex::try_new(x, y, z).and_then(|vertex| vertex.try_normal(nx, ny, nz));
            Ok(vertex.map_err(|error| in_file(&error))?.uv_sixteenths(u, v))
        });
        let vertices = vertices.collect::<Result<_, Box<dyn Error>>>()?;
        let model = Self { vertices, triangles };
        model.mesh().map_err(|error| in_file(&error))?;
        Ok(model)
    }

    /// The mesh that borrows it.
    pub fn mesh(&self) -> Result<Mesh<'_>, MeshError> {
        Mesh::try_new(&self.vertices, &self.triangles)
    }
}
