//! From runs of pixels to colours.

mod colors;
mod fill;
mod material;
mod patch;
mod shader;
mod walk;

pub(crate) use fill::Fill;
pub use material::{Material, Textured};
pub(crate) use patch::{Patch, STRAIGHT};
pub(crate) use shader::sealed::Sealed;
pub use shader::{Affine, Exact, Inputs, Pixels, Quality, QuarterPixel, Shader, Varying};
