//! A plane: a quantity that is linear on the screen, as a value and two steps.
//!
//! Far outside the triangle a value may not fit 32 bits. It wraps there, and wraps back on the way to where it does fit.

/// A linear function on the screen, in integers that wrap. (A sliver, see [`setup`](super::setup), keeps values at its corners
/// instead.)
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Plane {
    /// The value at the centre of pixel (0, 0). In a sliver: at corner 0.
    pub(crate) origin: u32,
    /// The change over one column to the right, and over one row down. In a sliver: from corner 0 to corner 1, and to corner 2.
    pub(crate) steps: [i32; 2],
}

impl Plane {
    /// Moves each step to the nearest multiple of 2⁻¹² if that is within its error, of a small triangle 2⁻¹⁶ of it more; around a
    /// corner.
    ///
    /// Sprites have such steps: of whole texels a pixel, of a half or a quarter. One unit less would cost a unit of packed
    /// coordinates at every pixel.
    pub(super) fn snap(&mut self, corner: &[i32; 2], error: u32, is_small: bool) {
        for (step, at) in self.steps.iter_mut().zip(corner) {
            let change = (step.wrapping_add(8) & !15).wrapping_sub(*step);
            let error = error + if is_small { step.unsigned_abs() >> 16 } else { 0 };
            if change.unsigned_abs() <= error {
                *step = step.wrapping_add(change);
                self.origin = self.origin.wrapping_sub((at >> 4).wrapping_mul(change) as u32);
            }
        }
    }

    /// By how much what it says at the corners (1/16 px), above `least`, is above the values there, in 1/16: 0 or less, and 0 or more.
    #[inline(never)]
    pub(super) fn errors(&self, corners: &[[i32; 2]; 3], values: &[i32; 3], least: i32) -> [i32; 2] {
        let [right, down] = self.steps;
        let mut errors = [0; 2];
        for ([x, y], value) in corners.iter().zip(values) {
            let way = right.wrapping_mul(x - 8).wrapping_add(down.wrapping_mul(y - 8));
            let error = ((self.origin.wrapping_sub((value - least) as u32) << 4) as i32).wrapping_add(way);
            errors = [errors[0].min(error), errors[1].max(error)];
        }
        errors
    }
}
