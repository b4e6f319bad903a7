//! A view, for canvases of one format.
//!
//! - In: a camera, lights and fog.
//! - Out: the same, with what fog does in this format.
//! - Assumes: nothing.

use crate::frame::{DepthFormat, PixelFormat};
use crate::scene::{Camera, Lights};
use crate::shade::InFog;

/// What a canvas needs to know of a view.
#[doc(hidden)]
#[expect(missing_debug_implementations, reason = "it is passed on at once")]
pub struct Sight<'v, 'a, F: PixelFormat, D: DepthFormat> {
    pub(super) camera: &'v Camera,
    pub(super) lights: Option<&'v Lights<'v>>,
    pub(super) fog: Option<&'v InFog<'a, F, D>>,
}
