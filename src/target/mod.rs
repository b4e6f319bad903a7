//! Where pixels end up: pixel and depth formats, the band of rows that is drawn into, and the list of what is drawn later.

mod background;
mod band;
mod canvas;
mod changes;
mod depth;
mod drawing;
mod format;
mod index;
mod list;

pub use background::{Background, Gradient, Picture};
pub use band::{Band, TargetError};
pub use canvas::Canvas;
pub use changes::{Changes, Flushed};
pub use depth::{Depth16, DepthFormat, NoDepth};
pub use format::{BigEndian, PixelFormat};
pub use list::{CapacityError, DisplayList};
