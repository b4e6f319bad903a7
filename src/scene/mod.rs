//! What a user describes: meshes, textures, materials, a camera.

mod camera;
mod drawables;
mod light;
mod material;
mod mesh;
mod projection;
pub mod shapes;
mod texture;

pub use camera::{Camera, PlaneError, Projected};
pub use drawables::{CornersError, PerspectiveImage, ShadedTriangle};
pub use light::{Light, Lighting, Lights, LightsError, Normal};
pub use material::{Material, Textured};
pub(crate) use mesh::Bounds;
pub use mesh::{Mesh, MeshError, Vertex};
pub(crate) use projection::{Projection, Viewport};
pub use texture::{Texture, TextureError, Wrap, texels};
