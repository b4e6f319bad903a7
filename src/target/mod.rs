//! Where pixels end up: pixel and depth formats, and the band of rows that is drawn into.

mod band;
mod depth;
mod format;

pub use band::{Band, TargetError};
pub use depth::{Depth16, DepthFormat, NoDepth};
pub use format::{BigEndian, PixelFormat};
