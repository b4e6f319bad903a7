//! A plane: a quantity that is linear on the screen, as its value at a triangle's first pixel and its steps per column and per row.
//!
//! - In: the value and the steps, which set-up computes.
//! - Out: for texture coordinates, steps moved to round numbers, and by how much the plane misses the values at the corners.
//! - Assumes: inside the triangle values fit 32 bits. Far outside they may wrap, and wrap back on the way in.

use crate::num::mul_round;
use core::hint::black_box;

/// A linear function on the screen, in integers that wrap. A sliver (see [`setup`](super::setup)) keeps values at its corners
/// in the same fields.
#[derive(Clone, Copy, Debug, Default, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
pub(crate) struct Plane {
    /// The change over one column to the right, and over one row down. In a sliver: from corner 0 to corner 1, and to corner
    /// 2.
    pub(crate) steps: [i32; 2],
    /// The value at the centre of the [first pixel](super::triangle::TriangleSetup::first_pixel). In a sliver: at corner 0.
    pub(crate) origin: u32,
}

impl Plane {
    /// The value m columns right and n rows below the first pixel. Not of a sliver.
    #[inline]
    pub(crate) fn at(&self, [m, n]: [i32; 2]) -> u32 {
        let [right, down] = self.steps;
        self.origin.wrapping_add_signed(m.wrapping_mul(right).wrapping_add(n.wrapping_mul(down)))
    }

    /// The value at a pixel of a sliver, from the weights of corners 1 and 2, 31 fraction bits.
    #[inline(never)]
    pub(crate) fn weighted(&self, weights: &[u32; 2]) -> u32 {
        let [b, c] = [0, 1].map(|i| mul_round::<31>(weights[i] as i32, self.steps[i]));
        self.origin.wrapping_add_signed(b).wrapping_add_signed(c)
    }

    /// For a texture coordinate, in I16F16: moves each step to the nearest multiple of 2⁻¹² if that is at most `error` units
    /// away. Steps of a small triangle may be off by 2⁻¹⁶ of themselves more. The value stays what it is at the first pixel.
    ///
    /// Sprites have such steps: a whole texel per pixel, a half or a quarter. If rounding left one a unit too small, packed
    /// coordinates, which cut steps to *their* unit, would lose one of theirs at every pixel.
    pub(super) fn snap(&mut self, error: u32, is_small: bool) {
        for step in &mut self.steps {
            let change = (step.wrapping_add(8) & !15).wrapping_sub(*step);
            let error = error + if is_small { step.unsigned_abs() >> 16 } else { 0 };
            if change.unsigned_abs() <= error {
                *step = step.wrapping_add(change);
            }
        }
    }

    /// The plane's errors at the corners, in 1/16 of its unit: the least, or 0 if none is negative, and the greatest, or 0 if
    /// none is positive. The plane is one of u − `least`; `values` are the right u at the corners, whose positions are in
    /// 1/16 px.
    #[inline(never)]
    pub(super) fn errors(
        &self,
        corners: &[[i16; 2]; 3],
        first: [i32; 2],
        values: &[i32; 3],
        least: i32,
    ) -> [i32; 2] {
        let ([right, down], [left, top]) = (self.steps, first.map(|at| at * 16 + 8));
        let mut errors = [0; 2];
        // Slices of lengths that are hidden, so that the loop is not unrolled.
        for (&[x, y], value) in black_box(&corners[..]).iter().zip(black_box(&values[..])) {
            black_box(());
            let (x, y) = (i32::from(x), i32::from(y));
            // From the centre of the first pixel, 16 times.
            let way = right.wrapping_mul(x - left).wrapping_add(down.wrapping_mul(y - top));
            let error =
                ((self.origin.wrapping_sub(value.wrapping_sub(least) as u32) << 4) as i32).wrapping_add(way);
            errors = [errors[0].min(error), errors[1].max(error)];
        }
        errors
    }
}
