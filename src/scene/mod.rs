//! What a user describes: meshes, textures, materials, a camera.

mod camera;
mod material;
mod mesh;
mod texture;

pub use camera::Camera;
pub(crate) use camera::Projection;
pub use material::Material;
pub use mesh::{Mesh, MeshError, Vertex};
pub use texture::{Texture, TextureError, Wrap, texels};
