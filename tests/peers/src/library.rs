//! What a library is here.

use crate::scene::Scene;
use std::fmt;

/// Draws one scene into a frame of its own, everything prepared that does not change from frame to frame.
pub trait Painter {
    /// Makes the frame ready, in one colour (RGB565) and with nothing near: not timed.
    fn clear(&mut self, ground: u16);

    /// Draws the scene: vertices, culling, set-up, pixels.
    fn draw(&mut self);

    /// The frame as words of RGB565, row after row.
    fn words(&self) -> Vec<u16>;
}

/// A published rasterizer.
pub trait Library: fmt::Debug {
    /// The crate's name.
    fn name(&self) -> &'static str;

    /// The crate's version; none for fixel, which is of this very tree.
    fn version(&self) -> &'static str {
        ""
    }

    /// What it does less or otherwise than fixel in all scenes, in one sentence.
    fn difference(&self) -> Option<&'static str> {
        None
    }

    /// What it does otherwise in this scene alone.
    fn difference_in(&self, _scene: &Scene) -> Option<&'static str> {
        None
    }

    /// A painter of a scene.
    ///
    /// # Errors
    ///
    /// Why the library cannot draw it, in one sentence.
    fn painter(&self, scene: &Scene) -> Result<Box<dyn Painter>, &'static str>;
}
