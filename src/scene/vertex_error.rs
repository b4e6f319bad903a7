//! The ranges of a vertex's numbers, and what is said of others.

use crate::num::bits_or_max;
use core::fmt;

/// A number of a [`Vertex`](crate::Vertex) that its format cannot hold.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum VertexError {
    /// A coordinate is not a number within −8 … 7.9998.
    Position {
        /// x, y or z.
        axis: char,
        /// What was given.
        value: f32,
    },
    /// A texture coordinate is not within −2048 … 2047 texels.
    TextureCoordinate {
        /// u or v.
        axis: char,
        /// What was given.
        value: i16,
    },
    /// The normal is longer than 1 by more than 1/64, or no number.
    Normal {
        /// What was given.
        normal: [f32; 3],
    },
}

impl VertexError {
    /// Which coordinate it is, of a position that no vertex can have.
    #[cold]
    pub(super) const fn of_position(x: f32, y: f32, z: f32) -> Self {
        if !is_coordinate(x) {
            Self::Position { axis: 'x', value: x }
        } else if !is_coordinate(y) {
            Self::Position { axis: 'y', value: y }
        } else {
            Self::Position { axis: 'z', value: z }
        }
    }

    /// Which one it is, of texture coordinates that no vertex can have.
    #[cold]
    pub(super) const fn of_texels(u: i16, v: i16) -> Self {
        if !is_texels(u) {
            Self::TextureCoordinate { axis: 'u', value: u }
        } else {
            Self::TextureCoordinate { axis: 'v', value: v }
        }
    }

    /// What a compile error says: formatting of numbers is not to be had there.
    pub(super) const fn in_plain_words(self) -> &'static str {
        match self {
            Self::Position { axis: 'x', .. } => "x of a vertex is not a number within −8 … 7.9998",
            Self::Position { axis: 'y', .. } => "y of a vertex is not a number within −8 … 7.9998",
            Self::Position { .. } => "z of a vertex is not a number within −8 … 7.9998",
            Self::TextureCoordinate { axis: 'u', .. } => "u of a vertex is not within −2048 … 2047 texels",
            Self::TextureCoordinate { .. } => "v of a vertex is not within −2048 … 2047 texels",
            Self::Normal { .. } => "the normal of a vertex is longer than 1, or no number",
        }
    }
}

/// Whether it is a coordinate of a position when rounded.
#[inline]
pub(super) const fn is_coordinate(value: f32) -> bool {
    let bits = bits_or_max(value, 12);
    bits == bits as i16 as i64
}

/// Whether it is a texture coordinate.
#[inline]
pub(super) const fn is_texels(value: i16) -> bool {
    -2048 <= value && value <= 2047
}

impl fmt::Display for VertexError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.in_plain_words())?;
        match self {
            Self::Position { value, .. } => write!(f, ": {value}"),
            Self::TextureCoordinate { value, .. } => write!(f, ": {value}"),
            Self::Normal { normal: [x, y, z] } => write!(f, ": ({x}, {y}, {z})"),
        }
    }
}

impl core::error::Error for VertexError {}
