//! What a user describes: meshes, textures, lights, a camera. Nothing here knows a pixel in memory.

mod asset;
mod camera;
mod lens_error;
mod light;
mod mask;
mod mesh;
mod plane_error;
mod projection;
pub mod shapes;
mod texture;
mod vertex;
mod vertex_error;

pub use asset::{Aligned, AssetError, AssetKind};
pub use camera::Camera;
pub use lens_error::LensError;
pub use light::{Light, Lighting, Lights, LightsError, Normal};
pub use mask::{Mask, MaskError};
pub(crate) use mesh::{Bounds, Triangles};
pub use mesh::{Mesh, MeshError};
pub use plane_error::PlaneError;
pub(crate) use projection::{Projection, Viewport};
pub use texture::{Texture, TextureError, texels};
pub use vertex::Vertex;
pub(crate) use vertex::is_gray;
pub use vertex_error::VertexError;
