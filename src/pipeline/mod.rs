//! What happens to a triangle, in order:
//!
//! ```text
//!            transform         clip            setup            span      shade
//! Vertex[3] ──────────▶ ClipVertex ──▶ ScreenVertex ──▶ TriangleSetup ──▶ Span ──▶ pixel word
//!                                                               └──────▶ Patch ──▶
//! ```

mod attribute;
mod clip;
mod color;
mod colors;
mod draw;
mod fill;
mod patch;
mod setup;
mod shade;
mod small;
mod span;
mod stats;
mod straight;
mod transform;
mod walk;

pub use clip::ScreenVertex;
pub use color::Coloring;
pub(crate) use colors::{Colors, Gray, LitTexels, RedBlueGreen, color, lit};
pub use draw::{RangeError, draw_triangle};
pub(crate) use draw::{draw, project};
pub(crate) use fill::Texels;
pub(crate) use patch::Patch;
pub use setup::Cull;
pub(crate) use setup::TriangleSetup;
pub(crate) use shade::Pixels;
pub use shade::{Affine, Exact, Inputs, Quality, QuarterPixel, Shader, Varying};
pub(crate) use span::{Rows, Run, Span, Window};
pub use stats::Stats;
