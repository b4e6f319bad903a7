//! The projection: how eye space is put on the screen, and on which part of it.

use crate::num::I16F16;
use embedded_graphics::geometry::Size;

/// Perspective or orthographic, from where to where, and onto which part of the screen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Projection {
    /// Perspective: the focal length in pixels. Orthographic: the pixels of one world unit. 1/16 … 8191.
    pub(crate) focal: I16F16,
    pub(crate) orthographic: bool,
    /// Distance of the near plane, [`MIN_NEAR`] or more.
    pub(crate) near: I16F16,
    /// Distance of the far plane, above the near one; for perspective `I16F16::MAX` is none.
    pub(crate) far: I16F16,
    /// The part of the screen that is drawn to.
    pub(crate) viewport: Viewport,
    /// Where on the screen the line of sight meets it, in 1/16 px.
    pub(crate) center: [i32; 2],
}

/// A rectangle of pixels, within ±2046 of the screen's corner.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Viewport {
    pub(crate) left: i16,
    pub(crate) top: i16,
    pub(crate) width: i16,
    pub(crate) height: i16,
}

/// The least distance of the near plane, 1/256, in 1/65536. Nearer than that 31 bits of q do not hold the attributes of what
/// reaches far away, nor clipping's numbers the corners of what is large.
pub(crate) const MIN_NEAR: i32 = 1 << 8;

const MIN_FOCAL: i32 = 1 << 12;
const MAX_FOCAL: i32 = 8191 << 16;
const MAX_SIDE: u32 = 1023;

impl Projection {
    pub(crate) const fn new(focal: i64, orthographic: bool, size: Size) -> Self {
        let focal = if focal < MIN_FOCAL as i64 {
            MIN_FOCAL
        } else if focal > MAX_FOCAL as i64 {
            MAX_FOCAL
        } else {
            focal as i32
        };
        let viewport = Viewport { left: 0, top: 0, width: limited(size.width), height: limited(size.height) };
        Self {
            focal: I16F16::from_bits(focal),
            orthographic,
            near: I16F16::from_bits(1 << 12),
            far: if orthographic { I16F16::from_bits(256 << 16) } else { I16F16::MAX },
            viewport,
            center: [viewport.width as i32 * 8, viewport.height as i32 * 8],
        }
    }

    /// Whether [`Projection::new`] limits a focal length.
    pub(crate) const fn limits_focal(focal: i64) -> bool {
        focal < MIN_FOCAL as i64 || focal > MAX_FOCAL as i64
    }

    /// Whether [`Projection::new`] limits the size of a screen.
    pub(crate) const fn limits_size(size: Size) -> bool {
        size.width > MAX_SIDE || size.height > MAX_SIDE
    }

    /// Moves the viewport's corner, and the line of sight with it.
    pub(crate) const fn moved_to(mut self, left: i32, top: i32) -> Self {
        let (left, top) = (clamped(left, 1023) as i16, clamped(top, 1023) as i16);
        self.center[0] += (left as i32 - self.viewport.left as i32) * 16;
        self.center[1] += (top as i32 - self.viewport.top as i32) * 16;
        self.viewport.left = left;
        self.viewport.top = top;
        self
    }
}

pub(crate) const fn limited(side: u32) -> i16 {
    if side > MAX_SIDE { MAX_SIDE as i16 } else { side as i16 }
}

pub(crate) const fn clamped(value: i32, most: i32) -> i32 {
    if value > most {
        most
    } else if value < -most {
        -most
    } else {
        value
    }
}
