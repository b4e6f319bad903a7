//! Memory of pixels: how a pixel and its depth are stored, the band of rows that is drawn to, and what it is cleared to.
//!
//! Nothing here knows what a triangle is.

mod background;
mod band;
mod blend;
mod depth;
mod draw_target;
mod format;
mod window;

pub use background::{Background, Gradient, Picture};
pub use band::{Band, TargetError};
pub use blend::BlendFormat;
pub use depth::{Depth16, DepthFormat, NoDepth};
pub use format::{BigEndian, PixelFormat};
pub(crate) use window::{Window, first_center};
