//! What a user describes: meshes, textures, lights, a camera. Nothing here knows a pixel in memory.

mod camera;
mod light;
mod mesh;
mod projection;
pub mod shapes;
mod texture;

pub use camera::Camera;
pub use light::{Light, Lighting, Lights, LightsError, Normal};
pub(crate) use mesh::Bounds;
pub use mesh::{Mesh, MeshError, Vertex};
pub(crate) use projection::{Projection, Viewport};
pub use texture::{Texture, TextureError, Wrap, texels};
