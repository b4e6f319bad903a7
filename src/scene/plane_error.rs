//! What is wrong with the distance of a near or far plane.

use crate::num::bits_from_f32;
use core::fmt;

/// A distance that a clipping plane cannot have.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PlaneError {
    /// Below 1/256 for a near plane, below 2⁻¹⁶ for a far one.
    TooNear,
    /// 32768 or more.
    TooFar,
    /// Not a number.
    NotANumber,
}

impl PlaneError {
    pub(super) const fn of(distance: f32, least: i32) -> Option<Self> {
        if distance.is_nan() {
            Some(Self::NotANumber)
        } else if distance >= 32768.0 {
            Some(Self::TooFar)
        } else if bits_from_f32(distance, 16) < least {
            Some(Self::TooNear)
        } else {
            None
        }
    }
}

impl fmt::Display for PlaneError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::TooNear => "a near plane is at least 1/256 away, a far one 1/65536",
            Self::TooFar => "a clipping plane is less than 32768 away",
            Self::NotANumber => "the distance of a clipping plane is not a number",
        })
    }
}

impl core::error::Error for PlaneError {}
