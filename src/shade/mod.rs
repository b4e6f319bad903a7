//! From runs of pixels to colours.

mod bent;
mod channels;
mod colors;
mod cover;
mod curve;
mod fill;
mod inverses;
mod kinds;
mod lit_texels;
mod material;
mod packed;
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

pub(crate) use cover::Cover;
pub use kinds::{Clamped, Flat, Gouraud, Kind, LitClamped, LitTextured, Textured};
pub use material::Material;
pub(crate) use patch::is_small;
pub use quality::{Affine, Exact, Quality, QuarterPixel};
pub(crate) use run::Run;
pub use shader::{Pixels, Shader, Varying};
pub(crate) use surface::Look;
pub use surface::Surface;
pub(crate) use traits::Traits;
