//! From runs of pixels to colours.

mod bent;
mod channels;
mod colors;
mod cover;
mod curve;
mod fill;
mod inverses;
mod lit_texels;
mod material;
mod packed;
mod patch;
mod perspective;
mod quality;
mod row;
mod run;
mod shader;
mod texels;
mod units;

pub(crate) use cover::Cover;
pub use material::{Material, Textured};
pub use quality::{Affine, Exact, Quality, QuarterPixel};
pub(crate) use run::Run;
pub use shader::{Pixels, Shader, Varying};
