//! What happens to a triangle, in order:
//!
//! ```text
//!            transform         clip            setup            span      shade
//! Vertex[3] ──────────▶ ClipVertex ──▶ ScreenVertex ──▶ TriangleSetup ──▶ Span ──▶ pixel word
//!                                                               └──────▶ Patch ──▶
//! ```
//!
//! [`draw`] takes a mesh through all of it; [`record`] as far as to screen vertices, which a display list keeps.

mod attribute;
mod clip;
mod color;
mod colors;
mod direct;
mod draw;
mod fan;
mod fill;
mod listed;
mod patch;
mod record;
mod setup;
mod shade;
mod small;
mod span;
mod stats;
mod straight;
mod transform;
mod walk;

pub(crate) use clip::MOST_CORNERS;
pub use clip::ScreenVertex;
pub use color::Coloring;
pub(crate) use colors::{Colors, Gray, LitTexels, RedBlueGreen, color, lit};
pub(crate) use direct::{Direct, Quad, Side};
pub use draw::{RangeError, draw_triangle};
pub(crate) use draw::{Raster, draw, project};
pub(crate) use fill::Texels;
pub(crate) use listed::{ListTriangle, ListVertex, ListView, MOST_SLOTS, ROWS_LOG2};
pub(crate) use patch::Patch;
pub(crate) use record::{Full, Style, record};
pub use setup::Cull;
pub(crate) use setup::TriangleSetup;
pub use shade::{Affine, Exact, Inputs, Pixels, Quality, QuarterPixel, Shader, Varying};
pub(crate) use span::{Rows, Run, Span, Window};
pub(crate) use stats::Count;
pub use stats::Stats;
