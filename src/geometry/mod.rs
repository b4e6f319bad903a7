//! From the triangles of a mesh to triangles on the screen.

mod assembly;
mod clip;
mod coloring;
mod cut;
mod fan;
mod orient;
mod ratio;
mod screen;
mod split;
mod stats;
mod transform;
mod vertex_colors;
mod whole;

pub(crate) use assembly::{Assembler, Clipped, VertexCache};
pub(crate) use clip::Clip;
pub use coloring::Coloring;
pub(crate) use cut::{MOST_CORNERS, Upper};
pub(crate) use fan::piece;
#[cfg(test)]
pub(crate) use fan::tests::polygon;
pub use orient::Cull;
pub(crate) use orient::{Oriented, area, clockwise, nearest_first, position};
pub(crate) use screen::set_attributes;
pub use screen::{Inputs, RangeError, ScreenVertex};
pub(crate) use stats::Count;
pub use stats::Stats;
pub(crate) use transform::ToClip;
pub(crate) use vertex_colors::{VertexColors, dim, is_gray};
pub(crate) use whole::Placing;
