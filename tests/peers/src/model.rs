//! The geometry of a scene in floating point, as the peers take it: the same numbers as fixel's, exactly.

use crate::scene::Scene;
use fixel::num::{I4F12, I12F4};
use fixel::{Pose, Vec3, Vertex};
use fixel_firmware::bench;

/// Width of every frame.
pub const WIDTH: usize = bench::SIZE.width as usize;
/// Height of every frame.
pub const HEIGHT: usize = bench::SIZE.height as usize;
/// Pixels of every frame.
pub const PIXELS: usize = bench::PIXELS;
/// Distance of the screen from the eye, in pixels.
pub const FOCAL: f32 = 80.0;
/// Distance of the near plane.
pub const NEAR: f32 = 0.1;
/// A far plane behind everything, for the peers that must have one.
pub const FAR: f32 = 100.0;
/// Sides of the texture.
pub const TEXTURE: usize = 64;
/// The colour of the flat scenes, RGB565.
pub const FLAT: u16 = 0xfd20;

/// What a scene draws.
#[derive(Clone, Debug)]
pub struct Model {
    /// Positions in mesh units.
    pub positions: Vec<[f32; 3]>,
    /// Vertex normals of length 1; zero where there are none.
    pub normals: Vec<[f32; 3]>,
    /// Texture coordinates in texels.
    pub uvs: Vec<[f32; 2]>,
    /// Counter-clockwise seen from the front; without a depth buffer back to front.
    pub triangles: Vec<[u16; 3]>,
    /// Rows of the matrix from mesh units to the eye, which looks along −z.
    pub to_eye: [[f32; 4]; 3],
}

impl Model {
    /// The geometry of a scene.
    #[must_use]
    pub fn new(scene: &Scene) -> Self {
        let (mesh, pose) = scene.thing.placed();
        let vertices = mesh.vertices();
        let mut model = Self {
            positions: vertices.iter().map(|vertex| vertex.position.map(I4F12::to_num)).collect(),
            normals: vertices.iter().map(normal).collect(),
            uvs: vertices.iter().map(|vertex| vertex.uv.map(I12F4::to_num)).collect(),
            triangles: mesh.triangles().collect(),
            to_eye: rows(&pose),
        };
        if !scene.depth {
            model.sort();
        }
        model
    }

    /// Puts the triangles in order from back to front.
    fn sort(&mut self) {
        let depths: Vec<f32> =
            self.positions.iter().map(|&position| transform(&self.to_eye, position)[2]).collect();
        let depth = |triangle: &[u16; 3]| triangle.iter().map(|&i| depths[usize::from(i)]).sum::<f32>();
        self.triangles.sort_by(|a, b| depth(a).total_cmp(&depth(b)));
    }

    /// Three indices a triangle, as most peers want them.
    #[must_use]
    pub fn faces(&self) -> Vec<[usize; 3]> {
        self.triangles.iter().map(|triangle| triangle.map(usize::from)).collect()
    }

    /// The matrix from mesh units to OpenGL's clip space, row by row: y up, −w ≤ z ≤ w.
    #[must_use]
    pub fn to_clip(&self) -> [[f32; 4]; 4] {
        let [x, y, z] = self.to_eye;
        let across = 2.0 * FOCAL / WIDTH as f32;
        let up = 2.0 * FOCAL / HEIGHT as f32;
        let (scale, offset) = ((FAR + NEAR) / (NEAR - FAR), 2.0 * FAR * NEAR / (NEAR - FAR));
        let mut depth = z.map(|element| element * scale);
        depth[3] += offset;
        [x.map(|element| element * across), y.map(|element| element * up), depth, z.map(|element| -element)]
    }
}

fn normal(vertex: &Vertex) -> [f32; 3] {
    normalized(vertex.normal.map(|component| f32::from(component) / 127.0))
}

fn normalized(vector: [f32; 3]) -> [f32; 3] {
    let length = vector.iter().map(|component| component * component).sum::<f32>().sqrt();
    vector.map(|component| if length > 0.0 { component / length } else { 0.0 })
}

fn rows(pose: &Pose) -> [[f32; 4]; 3] {
    let scale = pose.scale.map(|scale| scale.to_num::<f32>());
    let translation = floats(pose.translation);
    [0, 1, 2].map(|row| {
        let [x, y, z] = [0, 1, 2].map(|axis| pose.rotation[row][axis].to_num::<f32>() * scale[axis]);
        [x, y, z, translation[row]]
    })
}

fn floats(vector: Vec3) -> [f32; 3] {
    [vector.x.to_num(), vector.y.to_num(), vector.z.to_num()]
}

/// A point times a matrix of three rows.
#[inline]
#[must_use]
pub fn transform(rows: &[[f32; 4]; 3], [x, y, z]: [f32; 3]) -> [f32; 3] {
    rows.map(|row| row[0] * x + row[1] * y + row[2] * z + row[3])
}

/// A direction times the rotation of a matrix of three rows.
#[inline]
#[must_use]
pub fn rotate(rows: &[[f32; 4]; 3], [x, y, z]: [f32; 3]) -> [f32; 3] {
    rows.map(|row| row[0] * x + row[1] * y + row[2] * z)
}

/// A point times a matrix of four rows.
#[inline]
#[must_use]
pub fn project(rows: &[[f32; 4]; 4], [x, y, z]: [f32; 3]) -> [f32; 4] {
    rows.map(|row| row[0] * x + row[1] * y + row[2] * z + row[3])
}

/// The one light of the lit scenes: white, 0 … 1.
#[derive(Clone, Copy, Debug)]
pub struct Light {
    /// Towards the light, of length 1, before the eye.
    pub towards: [f32; 3],
    /// What arrives where a surface faces it.
    pub sun: f32,
    /// What arrives everywhere.
    pub ambient: f32,
}

impl Light {
    /// The light of the scenes.
    #[must_use]
    pub fn new() -> Self {
        Self {
            towards: normalized(floats(bench::SUN_DIRECTION).map(|component| -component)),
            sun: f32::from(bench::SUN_COLOR[0]) / 255.0,
            ambient: f32::from(bench::AMBIENT[0]) / 255.0,
        }
    }

    /// The light in mesh space, where no normal need be turned.
    #[must_use]
    pub fn in_mesh_space(self, to_eye: &[[f32; 4]; 3]) -> Self {
        let column = |j: usize| (0..3).map(|i| to_eye[i][j] * self.towards[i]).sum();
        Self { towards: normalized([column(0), column(1), column(2)]), ..self }
    }

    /// What arrives at a surface with this normal.
    #[inline]
    #[must_use]
    pub fn at(&self, normal: [f32; 3]) -> f32 {
        let [a, b] = [self.towards, normal];
        let cosine = a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
        self.ambient + self.sun * cosine.max(0.0)
    }
}

impl Default for Light {
    fn default() -> Self {
        Self::new()
    }
}
