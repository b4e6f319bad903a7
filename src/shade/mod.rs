//! From runs of pixels to colours.

mod channels;
mod colors;
mod fill;
mod material;
mod packed;
mod patch;
mod quality;
mod row;
mod run;
mod shader;
mod walk;

pub use material::{Material, Textured};
pub(crate) use patch::Patch;
pub use quality::{Affine, Exact, Quality, QuarterPixel};
pub(crate) use run::Run;
pub use shader::{Pixels, Shader, Varying};
