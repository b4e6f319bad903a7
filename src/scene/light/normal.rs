//! Normals and other directions, scaled so that products with them are short.

use crate::num::{I2F14, I4F12, leading_zeros, wide, zeros_of};
use core::array;

/// The direction in which a surface faces, in mesh space, of length 1.0 or, where it faces nowhere, 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Normal([i16; 3]);

impl Normal {
    /// The normal of a face from its corners: of the side from which they run counter-clockwise.
    ///
    /// Within 2⁻¹³ of exact however small or thin the face; 0 if the corners lie on one line. Costs 9 short
    /// products, a reciprocal square root, and 6 long products more if an edge is 8 units or longer.
    #[must_use]
    pub fn of_face(corners: [[I4F12; 3]; 3]) -> Self {
        Self::along(across_face(corners))
    }

    /// Of length 1, as a vector; 0 for 0.
    #[inline(never)]
    pub(super) fn along(vector: [i32; 3]) -> Self {
        let Some(direction) = Direction::of(vector) else { return Self([0; 3]) };
        let (inverse, shift) = direction.inverse_length();
        Self(direction.vector.map(|component| {
            let product = component * inverse as i32; // 2³⁰ at most
            (((product >> shift) + 1) >> 1) as i16
        }))
    }

    /// The same direction, as long as this times another.
    pub(super) fn times_length_of(self, other: Self) -> Self {
        let Some(direction) = Direction::of(other.0.map(i32::from)) else { return Self([0; 3]) };
        let (inverse, shift) = direction.inverse_length();
        // |v|² / |v|: 17 by 15 bits, below 2³². Components of 14 bits and a sign are 15 bits after at most 15 shifts to the left.
        let length = (((direction.squares >> 15) * inverse) >> shift) as i32;
        let length = length >> (-direction.exponent).clamp(0, 31);
        Self(self.0.map(|component| ((i32::from(component) * length + (1 << 13)) >> 14) as i16))
    }

    pub(super) fn bits(self) -> [i32; 3] {
        self.0.map(i32::from)
    }

    /// The components.
    #[must_use]
    pub fn components(self) -> [I2F14; 3] {
        self.0.map(I2F14::from_bits)
    }

    /// n·v for a `v` of at most 16 bits a component: below 3·16513·2¹⁵ < 2³¹.
    #[inline]
    pub(super) fn dot(self, v: [i32; 3]) -> i32 {
        let [x, y, z] = self.0.map(i32::from);
        x * v[0] + y * v[1] + z * v[2]
    }
}

/// From the normal of a [`Vertex`](crate::Vertex), 1.0 = 127.
impl From<[i8; 3]> for Normal {
    #[inline]
    fn from(normal: [i8; 3]) -> Self {
        // 16384/127 = 16513.01/128.
        Self(normal.map(|component| ((i32::from(component) * 16513 + 64) >> 7) as i16))
    }
}

/// A vector scaled to 15 bits, so that products of its components are short.
pub(super) struct Direction {
    /// The largest component is 2¹⁴ … 2¹⁵.
    pub(super) vector: [i32; 3],
    /// The vector it was made from is this one times 2^`exponent`.
    pub(super) exponent: i32,
    /// The sum of the squares, 2²⁸ … 3·2³⁰.
    pub(super) squares: u32,
}

impl Direction {
    /// `None` for 0.
    #[inline]
    pub(super) fn of(vector: [i32; 3]) -> Option<Self> {
        let magnitude = magnitude(vector);
        if magnitude == 0 {
            return None;
        }
        let exponent = 32 - zeros_of(magnitude) as i32 - 15;
        // One of them is 0.
        let (up, down) = ((-exponent).max(0), exponent.max(0));
        let vector = vector.map(|component| component << up >> down);
        let squares = vector.iter().map(|component| (component * component) as u32).sum();
        Some(Self { vector, exponent, squares })
    }

    /// 1/length as `inverse` / 2^(15 + `shift`), within 2⁻¹⁴ of it; `inverse` is 2¹⁴ … 2¹⁵, `shift` 14 or 15.
    ///
    /// A straight line and three steps of Newton's y·(3 − m·y²)/2, whose errors are 0.13, 0.026, 0.001,
    /// 2·10⁻⁶: on Armv6-M a tenth of what an integer square root and a reciprocal cost.
    #[inline(never)]
    pub(super) fn inverse_length(&self) -> (u32, u32) {
        // m = 1 … 4 in 14 fraction bits.
        let (m, shift) =
            if self.squares < 1 << 30 { (self.squares >> 14, 14) } else { (self.squares >> 16, 15) };
        // 1.1034 − m/6, 15 fraction bits.
        let mut y = 36156 - ((m * 21845) >> 16);
        for _ in 0..3 {
            let y_squared = (y * y + (1 << 13)) >> 14; // 16 fraction bits
            let product = (m * y_squared + (1 << 14)) >> 15; // 15; m·y² < 1.2
            y = (y * ((3 << 15) - product) + (1 << 15)) >> 16;
        }
        (y.min(1 << 15), shift)
    }
}

/// Across a face, from the side from which its corners run counter-clockwise: exact, or of 30 bits where an edge is 8 units or
/// longer.
#[inline(never)]
pub(super) fn across_face([a, b, c]: [[I4F12; 3]; 3]) -> [i32; 3] {
    let edge = |to: [I4F12; 3]| -> [i32; 3] {
        array::from_fn(|i| i32::from(to[i].to_bits()) - i32::from(a[i].to_bits()))
    };
    let (p, q) = (edge(b), edge(c));
    if (magnitude(p) | magnitude(q)) < 1 << 15 {
        // Below 2³¹.
        array::from_fn(|i| {
            let (j, k) = ((i + 1) % 3, (i + 2) % 3);
            p[j] * q[k] - p[k] * q[j]
        })
    } else {
        long_cross(p, q)
    }
}

/// The cross product of vectors of 17 bits, over a power of two so that it fits 30 bits.
#[cold]
fn long_cross(p: [i32; 3], q: [i32; 3]) -> [i32; 3] {
    let cross: [i64; 3] = array::from_fn(|i| {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        wide(p[j], q[k]) - wide(p[k], q[j])
    });
    let shift = (64 - leading_zeros(magnitude64(cross))).saturating_sub(30);
    cross.map(|component| (component >> shift) as i32)
}

/// As many bits as the largest magnitude has.
#[inline(never)]
pub(super) fn magnitude(vector: [i32; 3]) -> u32 {
    vector.iter().fold(0, |all, component| all | component.unsigned_abs())
}

/// Likewise.
pub(super) fn magnitude64(vector: [i64; 3]) -> u64 {
    vector.iter().fold(0, |all, component| all | component.unsigned_abs())
}

/// How much of a cosine counts.
#[inline]
pub(super) fn facing(cosine: i32, two_sided: bool) -> u32 {
    if two_sided { cosine.unsigned_abs() } else { cosine.max(0) as u32 }
}
