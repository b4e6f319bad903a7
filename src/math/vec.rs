//! Points and directions in the world.

use crate::num::{I16F16, bits_from_f32};
use core::ops::{Add, Neg, Sub};
use micromath::vector::F32x3;

/// A point or direction in the world, in units of the world, [`I16F16`] per axis: −32768 … 32767.99998. Sums saturate.
///
/// ```
/// use fixel::Vec3;
/// const DOOR: Vec3 = Vec3::lit(2.0, 0.0, -7.5);
/// assert_eq!(DOOR + Vec3::lit(0.0, 1.0, 0.0), Vec3::lit(2.0, 1.0, -7.5));
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Vec3 {
    /// Right.
    pub x: I16F16,
    /// Up.
    pub y: I16F16,
    /// Towards the viewer.
    pub z: I16F16,
}

impl Vec3 {
    /// The origin.
    pub const ZERO: Self = Self::new(I16F16::ZERO, I16F16::ZERO, I16F16::ZERO);

    /// From fixed-point coordinates.
    #[must_use]
    pub const fn new(x: I16F16, y: I16F16, z: I16F16) -> Self {
        Self { x, y, z }
    }

    /// From literals, folded by the compiler in a `const`: rounded to nearest, saturated, NaN is 0.
    #[must_use]
    pub const fn lit(x: f32, y: f32, z: f32) -> Self {
        Self::new(
            I16F16::from_bits(bits_from_f32(x, 16)),
            I16F16::from_bits(bits_from_f32(y, 16)),
            I16F16::from_bits(bits_from_f32(z, 16)),
        )
    }

    pub(crate) const fn bits(self) -> [i32; 3] {
        [self.x.to_bits(), self.y.to_bits(), self.z.to_bits()]
    }
}

/// From [`micromath`]'s vector, as [`Vec3::lit`].
impl From<F32x3> for Vec3 {
    fn from(v: F32x3) -> Self {
        Self::lit(v.x, v.y, v.z)
    }
}

impl Add for Vec3 {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self::new(
            self.x.saturating_add(other.x),
            self.y.saturating_add(other.y),
            self.z.saturating_add(other.z),
        )
    }
}

impl Sub for Vec3 {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        Self::new(
            self.x.saturating_sub(other.x),
            self.y.saturating_sub(other.y),
            self.z.saturating_sub(other.z),
        )
    }
}

impl Neg for Vec3 {
    type Output = Self;
    fn neg(self) -> Self {
        Self::ZERO - self
    }
}
