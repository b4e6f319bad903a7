//! Memory of pixels: how a pixel and its depth are stored, the band of rows that is drawn to, what it is cleared to, and how it is
//! dithered and packed for a display of few bits.
//!
//! Nothing here knows what a triangle is.

mod background;
mod band;
mod bayer;
mod blend;
mod channel;
mod depth;
mod draw_target;
mod format;
mod formats;
mod pack;
mod quantize;
mod threshold;
mod window;

pub use background::{Background, Gradient, Picture};
pub use band::{Band, TargetError};
pub(crate) use bayer::BAYER;
pub use blend::BlendFormat;
pub use depth::{Depth16, DepthFormat, NoDepth};
pub use format::{BigEndian, PixelFormat};
pub(crate) use format::{OfWords, Single, SliceOf};
pub use pack::PackError;
pub use quantize::{Quantized, QuantizedColors};
pub use threshold::{Quantize, Threshold};
pub(crate) use window::{Window, first_center};
