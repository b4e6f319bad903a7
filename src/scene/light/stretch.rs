//! Light on a mesh whose pose does not keep angles: its normals and places are brought to where they stand.
//!
//! Of a pose that scales by S and then takes what is left through a matrix R, a place p goes to R·S·p. What is at right angles to a
//! surface goes to (R·S)⁻ᵀ·n, which is cof(R)·cof(S)·n but for its length, and for its sign if R mirrors: a cofactor
//! matrix needs no division, and there is one of a flat matrix, too.
//!
//! If R is a rotation or mirrors one, as most often, the lights are turned back by it, and only S is left to do: three short
//! products a normal. If not, the lights stay in the axes of the world.
//!
//! In: the pose, and vectors in the mesh. Out: the same in the axes that the lights are in. Nothing overflows whatever the numbers.

use super::normal::{Direction, Normal, magnitude};
use crate::math::{Pose, dot};
use crate::num::{I2F14, I4F12, wide};
use core::array;

/// A pose that does not keep angles.
#[derive(Clone, Copy, Debug)]
pub(super) struct Stretch<'p> {
    pose: &'p Pose,
    /// cof(S), that is, for each axis the product of the other two's scales: 16 bits over 2^shift, in a common unit.
    factors: [u16; 3],
    /// The shifts, at most 31, in five bits each. In the last bit whether R is neither a rotation nor mirrors one.
    shifts: u16,
}

impl<'p> Stretch<'p> {
    /// `None` if the pose keeps angles.
    #[inline(never)]
    pub(super) fn of(pose: &'p Pose) -> Option<Self> {
        if pose.keeps_angles() {
            return None;
        }
        let scales = pose.scale.map(|scale| u64::from(scale.to_bits()));
        let products: [u64; 3] = array::from_fn(|i| scales[(i + 1) % 3] * scales[(i + 2) % 3]);
        let zeros = products.iter().fold(1, |all, product| all | product).leading_zeros();
        let mut stretch = Self { pose, factors: [0; 3], shifts: u16::from(!pose.is_orthonormal()) << 15 };
        for (i, product) in products.into_iter().enumerate() {
            let own = product.leading_zeros();
            stretch.factors[i] = (product << (own & 63) >> 48) as u16;
            stretch.shifts |= ((own - zeros).min(31) as u16) << (5 * i);
        }
        Some(stretch)
    }

    fn is_of_any_matrix(&self) -> bool {
        self.shifts >> 15 != 0
    }

    /// The axes that lights are brought to.
    pub(super) fn axes(&self) -> &'p [[I2F14; 3]; 3] {
        const UNTURNED: [[I2F14; 3]; 3] = Pose::IDENTITY.rotation;
        if self.is_of_any_matrix() { &UNTURNED } else { &self.pose.rotation }
    }

    /// How many bits the largest scale has, at least 1.
    fn bits(&self) -> u32 {
        32 - self.pose.scale.iter().fold(1, |all, scale| all | scale.to_bits()).leading_zeros()
    }

    /// The unit of [`Stretch::place`] in units of the world, as log₂: 4 to 8 times the largest scale. So a place has room: no
    /// matrix in I2F14 makes a vector more than 6 times as long.
    pub(super) fn unit_log2(&self) -> i32 {
        self.bits() as i32 - 20
    }

    /// A place of the mesh as seen from its origin, in [its unit](Stretch::unit_log2), 26 fraction bits, within ±2²⁹·⁶.
    #[cold]
    #[inline(never)]
    pub(super) fn place(&self, position: [I4F12; 3]) -> [i32; 3] {
        let bits = self.bits();
        let scaled = array::from_fn(|i| {
            // A unit in which the largest scale has 31 bits; 15 by 31 bits, to 30.
            let scale = (self.pose.scale[i].to_bits() << (32 - bits) >> 1) as i32;
            (wide(position[i].to_bits().into(), scale) >> 16) as i32
        });
        if self.is_of_any_matrix() {
            self.pose.rotation.map(|row| (dot(row.map(|at| at.to_bits().into()), scaled) >> 17) as i32)
        } else {
            scaled.map(|at| at >> 3)
        }
    }

    /// A normal of the mesh at right angles to the stretched surface, as long as it was.
    #[cold]
    #[inline(never)]
    pub(super) fn normal(&self, normal: Normal) -> Normal {
        self.across(normal.bits(), [0; 3]).times_length_of(normal)
    }

    /// The normal of a face of the stretched mesh, from any vector at right angles to it in the mesh.
    #[cold]
    #[inline(never)]
    pub(super) fn face_normal(&self, across: [i32; 3]) -> Normal {
        // 15 bits of each component by itself: what is small of it may become what is large.
        let excess = across.map(|at| 17 - at.unsigned_abs().leading_zeros() as i32);
        let mantissas = array::from_fn(|i| {
            if excess[i] > 0 { across[i] >> excess[i] } else { across[i] << (-excess[i]).min(15) }
        });
        self.across(mantissas, excess)
    }

    /// The unit vector at right angles to the stretched surface, from one in the mesh: numbers of 16 bits times powers of two.
    #[inline(never)]
    fn across(&self, vector: [i32; 3], exponents: [i32; 3]) -> Normal {
        let exponents: [i32; 3] = array::from_fn(|i| exponents[i] - i32::from(self.shifts >> (5 * i) & 31));
        let scaled: [i32; 3] = array::from_fn(|i| vector[i] * i32::from(self.factors[i])); // below 2³¹
        let most = (0..3).filter(|&i| scaled[i] != 0).map(|i| exponents[i]).max().unwrap_or(0);
        let scaled = array::from_fn(|i| scaled[i] >> (most - exponents[i]).clamp(0, 31));
        if self.is_of_any_matrix() { self.turned(scaled) } else { Normal::along(scaled) }
    }

    /// By a matrix that is no rotation.
    #[cold]
    #[inline(never)]
    fn turned(&self, vector: [i32; 3]) -> Normal {
        let Some(Direction { vector, .. }) = Direction::of(vector) else {
            return Normal::along([0; 3]);
        };
        let cofactors = self.pose.cofactors();
        let all = magnitude(array::from_fn(|i| magnitude(cofactors[i]) as i32));
        // 14 bits: sums of three products are below 3 · 2²⁹.
        let excess = 18 - all.leading_zeros() as i32;
        let shortened = |cofactor: i32| if excess > 0 { cofactor >> excess } else { cofactor << -excess };
        let turned = cofactors.map(|row| (0..3).map(|i| shortened(row[i]) * vector[i]).sum::<i32>());
        Normal::along(if self.pose.is_mirrored() { turned.map(|at| -at) } else { turned })
    }
}
