//! From runs of pixels to colours.

mod bent;
mod blend;
mod blended;
mod channels;
mod colors;
mod cover;
mod curve;
mod cut_out;
mod fill;
mod fog;
mod fragment;
mod inverses;
mod kinds;
mod layered;
mod light;
mod lit_texels;
mod material;
mod opaque;
mod packed;
mod paint;
mod patch;
mod perspective;
mod quality;
mod recipe;
mod row;
mod run;
mod shader;
mod surface;
mod texels;
mod traits;
mod units;
mod visible;

pub use blend::{Additive, Layer, LayerIn, Masked, Multiply, Opaque, Over, ScreenDoor};
pub(crate) use cover::{Cover, InFog, Layers};
pub use cut_out::{CutOut, VertexAlpha};
pub use fog::Fog;
pub use kinds::{
    Clamped, ColorlessKind, Flat, Gouraud, Kind, LitClamped, LitKind, LitTextured, TexelKind, Textured,
};
pub use material::Material;
pub(crate) use patch::is_small;
pub use quality::{Affine, Exact, Quality, QuarterPixel};
pub(crate) use run::Run;
pub use shader::{Fragment, Pixels, Reach, Shader, Varying};
pub(crate) use surface::Look;
pub use surface::Surface;
pub(crate) use traits::Traits;
