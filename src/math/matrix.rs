//! 3×3 matrices of 14 fraction bits, and vectors: what poses are computed with.

use super::Vec3;
use crate::num::{I2F14, I16F16, IS_ARMV6M, shift_round, wide};

pub(super) const fn bits(row: [I2F14; 3]) -> [i32; 3] {
    [row[0].to_bits() as i32, row[1].to_bits() as i32, row[2].to_bits() as i32]
}

pub(super) const fn column_of(rows: &[[I2F14; 3]; 3], column: usize) -> [i32; 3] {
    bits([rows[0][column], rows[1][column], rows[2][column]])
}

/// The same with its x column the other way round: the mirror image of what is turned.
pub(super) const fn turned_round(mut rotation: [[I2F14; 3]; 3]) -> [[I2F14; 3]; 3] {
    let mut row = 0;
    while row < 3 {
        rotation[row][0] = rotation[row][0].saturating_neg();
        row += 1;
    }
    rotation
}

/// Of vectors of 16 bits: each difference is at most 2³⁰ + 2¹⁵ · (2¹⁵ − 1), which fits.
pub(super) const fn cross(a: [i32; 3], b: [i32; 3]) -> [i32; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// Of vectors of 16 bits, its low 32 bits.
pub(super) const fn wrapping_dot(a: [i32; 3], b: [i32; 3]) -> i32 {
    (a[0] * b[0]).wrapping_add(a[1] * b[1]).wrapping_add(a[2] * b[2])
}

pub(super) const fn off(value: i32, from: i32) -> u32 {
    value.wrapping_sub(from).unsigned_abs()
}

/// Of a vector of 16 bits and one of 32. Not inlined: on Armv6-M it is long.
///
/// There each product is two short ones: 66 cycles in all instead of 130.
#[inline(never)]
pub(crate) const fn dot(a: [i32; 3], b: [i32; 3]) -> i64 {
    if !IS_ARMV6M {
        return wide(a[0], b[0]) + wide(a[1], b[1]) + wide(a[2], b[2]);
    }
    let [x, y, z] = [halves(a[0], b[0]), halves(a[1], b[1]), halves(a[2], b[2])];
    let upper = x[0] as i64 + y[0] as i64 + z[0] as i64;
    (upper << 16) + (x[1] + y[1] + z[1]) as i64
}

/// The product of 16 and 32 bits: what is above its last 16 bits, and these.
#[inline(always)]
const fn halves(a: i32, b: i32) -> [i32; 2] {
    let lower = a * (b & 0xffff);
    [a * (b >> 16) + (lower >> 16), lower & 0xffff]
}

pub(super) const fn saturated(v: [i64; 3]) -> Vec3 {
    const fn coordinate(bits: i64) -> I16F16 {
        I16F16::from_bits(if bits > i32::MAX as i64 {
            i32::MAX
        } else if bits < i32::MIN as i64 {
            i32::MIN
        } else {
            bits as i32
        })
    }
    Vec3::new(coordinate(v[0]), coordinate(v[1]), coordinate(v[2]))
}

/// A sum of products with 14 fraction bits and `fraction_bits` more as an `I2F14`, rounded and saturated.
pub(super) const fn round14(sum: i64, fraction_bits: u32) -> I2F14 {
    let rounded = shift_round(sum, fraction_bits);
    I2F14::from_bits(if rounded > i16::MAX as i64 {
        i16::MAX
    } else if rounded < i16::MIN as i64 {
        i16::MIN
    } else {
        rounded as i16
    })
}

/// A sum of two products with 14 fraction bits each as an `I2F14`, rounded and saturated.
pub(super) const fn round14_short(sum: i32) -> I2F14 {
    let rounded = ((sum >> 13) + 1) >> 1;
    I2F14::from_bits(if rounded > i16::MAX as i32 {
        i16::MAX
    } else if rounded < i16::MIN as i32 {
        i16::MIN
    } else {
        rounded as i16
    })
}
