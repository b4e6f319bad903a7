//! From the triangles of a mesh to triangles on the screen.

mod assembly;
mod clip;
mod coloring;
mod cut;
mod fan;
mod stats;
mod transform;

pub use assembly::{RangeError, draw_triangle};
pub(crate) use assembly::{Raster, draw, needs, project};
pub(crate) use clip::Clip;
pub use clip::ScreenVertex;
pub use coloring::Coloring;
pub(crate) use coloring::{dim, is_gray};
pub(crate) use cut::MOST_CORNERS;
pub(crate) use stats::Count;
pub use stats::Stats;
pub(crate) use transform::ToClip;
