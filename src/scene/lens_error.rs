//! What a camera has to limit.

use crate::math::Turn;
use core::fmt;
use embedded_graphics::geometry::Size;

/// What a [`Camera`](crate::Camera) would have to limit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LensError {
    /// A side of the screen is longer than 1023 pixels.
    Size(Size),
    /// The focal length, or the pixels of a world unit, are not a number of 1/16 … 8191 pixels.
    Focal(f32),
    /// The focal length that the angle gives is not within 1/16 … 8191 pixels.
    Angle {
        /// The angle that the picture was to be high.
        vertical: Turn,
        /// The height of the screen in pixels.
        height: u32,
    },
}

impl fmt::Display for LensError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Size(Size { width, height }) => {
                write!(f, "a side of a camera's screen is at most 1023 pixels: {width} × {height}")
            }
            Self::Focal(pixels) => {
                write!(f, "a camera's focal length is not a number of 1/16 … 8191 pixels: {pixels}")
            }
            Self::Angle { vertical, height } => write!(
                f,
                "a camera's focal length is not within 1/16 … 8191 pixels: {}/65536 of a turn over {height} pixels",
                vertical.raw()
            ),
        }
    }
}

impl core::error::Error for LensError {}
