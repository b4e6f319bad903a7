//! Cameras and poses read back for the reference, and meshes to look at.

use fixel::fixed::types::{I4F12, I12F4, I16F16};
use fixel::{Camera, Inputs, Mesh, Pose, Quality, Shader, Varying, Vertex};
use std::marker::PhantomData;

use super::{Drawn, Recording};
use crate::reference::view::{Lens, Placement, View};

pub(crate) fn placement(pose: &Pose) -> Placement {
    Placement {
        rotation: pose.rotation.map(|row| row.map(|element| f64::from(element.to_bits()) / 16384.0)),
        scale: pose.scale.map(|scale| f64::from(scale.to_bits()) / 4_194_304.0),
        translation: [pose.translation.x, pose.translation.y, pose.translation.z].map(number),
    }
}

fn number(value: I16F16) -> f64 {
    f64::from(value.to_bits()) / 65536.0
}

/// What the camera says of itself, but whether it is orthographic, which it does not.
pub(crate) fn lens(camera: &Camera, orthographic: bool) -> Lens {
    let (near, far) = camera.planes();
    let (x, y) = camera.center();
    Lens {
        focal: number(camera.focal_length()),
        center: [x, y].map(|at| f64::from(at.to_bits()) / 16.0),
        near: number(near),
        far: if far == I16F16::MAX { f64::INFINITY } else { number(far) },
        orthographic,
    }
}

pub(crate) fn view(camera: &Camera, pose: &Pose, orthographic: bool) -> View {
    View::new(lens(camera, orthographic), placement(camera.placement()), placement(pose))
}

pub(crate) fn position(vertex: &Vertex) -> [f64; 3] {
    vertex.position.map(|at| f64::from(at.to_bits()) / 4096.0)
}

pub(crate) fn texel(vertex: &Vertex) -> [f64; 2] {
    vertex.uv.map(|at| f64::from(at.to_bits()) / 16.0)
}

/// A mesh that owns its vertices, and what is true of it.
#[derive(Clone, Debug)]
pub(crate) struct Model {
    pub(crate) vertices: Vec<Vertex>,
    pub(crate) triangles: Vec<[u16; 3]>,
    /// Of triangles on other sides of each edge: for edge i of a triangle the one triangle beyond, if there is just one.
    pub(crate) beyond: Vec<[Option<usize>; 3]>,
}

impl Model {
    /// The mesh with texture coordinates from −1000 to 1000 texels that depend on the place and on nothing else.
    pub(crate) fn new(mesh: &Mesh<'_>) -> Self {
        let mut vertices = mesh.vertices().to_vec();
        for vertex in &mut vertices {
            let [x, y, z] = vertex.position.map(|at| i32::from(at.to_bits()));
            // Slopes that differ, and the ends of the range at −8 and 8.
            let uv = [(3 * x + 2 * z - y) / 12, (2 * y - 3 * z + x) / 12];
            vertex.uv = uv.map(|at| I12F4::from_bits(at as i16));
        }
        Self::with_texels(vertices, mesh.triangles().collect())
    }

    pub(crate) fn with_texels(vertices: Vec<Vertex>, triangles: Vec<[u16; 3]>) -> Self {
        let place = |index: u16| vertices[usize::from(index)].position.map(I4F12::to_bits);
        let mut owners = std::collections::HashMap::<_, Vec<usize>>::new();
        let edges = |corners: &[u16; 3]| {
            let [a, b, c] = corners.map(place);
            [(a.min(b), a.max(b)), (b.min(c), b.max(c)), (c.min(a), c.max(a))]
        };
        for (index, corners) in triangles.iter().enumerate() {
            for edge in edges(corners) {
                owners.entry(edge).or_default().push(index);
            }
        }
        let beyond = triangles.iter().enumerate().map(|(index, corners)| {
            edges(corners).map(|edge| match owners[&edge][..] {
                [a, b] if a != b => Some(a + b - index),
                _ => None,
            })
        });
        let beyond = beyond.collect();
        Self { vertices, triangles, beyond }
    }

    pub(crate) fn mesh(&self) -> Mesh<'_> {
        Mesh::try_new(&self.vertices, &self.triangles).expect("the indices are in range")
    }

    /// Seen from inside.
    pub(crate) fn inside_out(mut self) -> Self {
        for corners in &mut self.triangles {
            corners.swap(1, 2);
        }
        Self::with_texels(self.vertices, self.triangles)
    }
}

/// A shader that writes down u, v and a number, which stands where red would.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Numbered<Q> {
    pub(crate) number: i32,
    pub(crate) cull: fixel::Cull,
    pub(crate) quality: PhantomData<fn() -> Q>,
}

impl<Q: Quality> Shader<Recording> for Numbered<Q> {
    type Quality = Q;

    fn cull(&self) -> fixel::Cull {
        self.cull
    }

    fn inputs(&self) -> Inputs {
        Inputs::Uv
    }

    fn color(&self, varying: &Varying) -> Drawn {
        Drawn { attributes: [varying.u.to_bits(), varying.v.to_bits(), self.number, 0, 0], written: true }
    }
}
