//! Stretch: normals and positions for light on a mesh whose pose does not keep angles.
//!
//! - In: the pose; normals and positions in the mesh.
//! - Out: normals of the stretched surface and positions, along the axes in which the lights are given.
//! - Assumes: nothing; no pose makes anything overflow.
//!
//! Let S be the pose's scales and R its matrix. A position p goes to R·S·p. A normal n goes along (R·S)⁻ᵀ·n, the inverse
//! transpose. That is cof(R)·cof(S)·n divided by the determinant, cof being the matrix of cofactors. Only its direction
//! counts, and scales are never negative. So nothing is divided, and the sign is turned if det(R) < 0. Cofactors also exist
//! of a matrix that makes things flat.
//!
//! Most often R is a rotation or a reflection. Then the lights are turned back by R, once per mesh, and a normal takes cof(S)
//! alone, three short products. For any other R the lights stay in the axes of the world, and normals take cof(R) too.

use super::normal::{Direction, Normal, magnitude};
use crate::math::{Pose, dot};
use crate::num::{I2F14, I4F12, leading_zeros, wide, wide_unsigned, zeros_of};
use core::array;

/// A pose that does not keep angles.
#[derive(Clone, Copy, Debug)]
pub(super) struct Stretch<'p> {
    pose: &'p Pose,
    /// The diagonal of cof(S): for each axis the product of the other two scales, as 16 bits / 2^shift, in a common unit.
    factors: [u16; 3],
    /// The shifts, 0 … 31, in five bits each, x in the lowest. Bit 15 says that R is neither a rotation nor a reflection.
    shifts: u16,
}

impl<'p> Stretch<'p> {
    /// `None` if the pose keeps angles.
    #[inline(never)]
    pub(super) fn of(pose: &'p Pose) -> Option<Self> {
        if pose.keeps_angles() {
            return None;
        }
        let scales = pose.scale.map(|scale| scale.to_bits());
        let products: [u64; 3] = array::from_fn(|i| wide_unsigned(scales[(i + 1) % 3], scales[(i + 2) % 3]));
        let zeros = leading_zeros(products.iter().fold(1, |all, product| all | product));
        let mut stretch = Self { pose, factors: [0; 3], shifts: u16::from(!pose.is_orthonormal()) << 15 };
        for (i, product) in products.into_iter().enumerate() {
            let own = leading_zeros(product);
            stretch.factors[i] = (product << (own & 63) >> 48) as u16;
            stretch.shifts |= ((own - zeros).min(31) as u16) << (5 * i);
        }
        Some(stretch)
    }

    /// Whether R is neither a rotation nor a reflection.
    fn is_of_any_matrix(&self) -> bool {
        self.shifts >> 15 != 0
    }

    /// The axes, as columns, along which the lights have to be given: those of R, or of the world.
    pub(super) fn axes(&self) -> &'p [[I2F14; 3]; 3] {
        const UNTURNED: [[I2F14; 3]; 3] = Pose::IDENTITY.rotation;
        if self.is_of_any_matrix() { &UNTURNED } else { &self.pose.rotation }
    }

    /// How many bits the largest scale has as U10F22, at least 1.
    fn bits(&self) -> u32 {
        32 - zeros_of(self.pose.scale.iter().fold(1, |all, scale| all | scale.to_bits()))
    }

    /// Log₂ of the unit of [`Stretch::place`] in units of the world: 4 to 8 times the largest scale. p is at
    /// most 8·√3 long, and a row of R at most 2·√3. So a component of R·S·p is within 48 times the largest scale: 12 in this
    /// unit.
    pub(super) fn unit_log2(&self) -> i32 {
        self.bits() as i32 - 20
    }

    /// A position from the mesh's origin, along [the axes](Stretch::axes) of the lights, in [this unit](Stretch::unit_log2)
    /// with 26 fraction bits: within ±2²⁹·⁶.
    #[cold]
    #[inline(never)]
    pub(super) fn place(&self, position: [I4F12; 3]) -> [i32; 3] {
        let bits = self.bits();
        let scaled = array::from_fn(|i| {
            // Shifted so that the largest scale has 31 bits. 15 bits and a sign times 31 make 46; 30 are kept.
            let scale = (self.pose.scale[i].to_bits() << (32 - bits) >> 1) as i32;
            (wide(position[i].to_bits().into(), scale) >> 16) as i32
        });
        if self.is_of_any_matrix() {
            self.pose.rotation.map(|row| (dot(row.map(|at| at.to_bits().into()), scaled) >> 17) as i32)
        } else {
            scaled.map(|at| at >> 3)
        }
    }

    /// The normal of the stretched surface, from a vertex normal of the mesh, and as long as that.
    #[cold]
    #[inline(never)]
    pub(super) fn normal(&self, normal: Normal) -> Normal {
        self.across(normal.bits(), [0; 3]).times_length_of(normal)
    }

    /// The normal of a face of the stretched mesh, from a vector of any length at right angles to the face in the mesh.
    #[cold]
    #[inline(never)]
    pub(super) fn face_normal(&self, across: [i32; 3]) -> Normal {
        // 15 bits of each component, with an exponent of its own: a small one may become the largest.
        let excess = across.map(|at| 17 - zeros_of(at.unsigned_abs()) as i32);
        let mantissas = array::from_fn(|i| {
            if excess[i] > 0 { across[i] >> excess[i] } else { across[i] << (-excess[i]).min(15) }
        });
        self.across(mantissas, excess)
    }

    /// The unit normal of the stretched surface, from `vector` · 2^`exponents`, a normal in the mesh. Components of `vector`
    /// have 15 bits and a sign.
    #[inline(never)]
    fn across(&self, vector: [i32; 3], exponents: [i32; 3]) -> Normal {
        let exponents: [i32; 3] = array::from_fn(|i| exponents[i] - i32::from(self.shifts >> (5 * i) & 31));
        // cof(S)·n: 15 bits times 16.
        let scaled: [i32; 3] = array::from_fn(|i| vector[i] * i32::from(self.factors[i]));
        // To the largest exponent, all three.
        let most = (0..3).filter(|&i| scaled[i] != 0).map(|i| exponents[i]).max().unwrap_or(0);
        let scaled = array::from_fn(|i| scaled[i] >> (most - exponents[i]).clamp(0, 31));
        if self.is_of_any_matrix() { self.turned(scaled) } else { Normal::along(scaled) }
    }

    /// cof(R)·v as a unit normal, its sign turned if R mirrors.
    #[cold]
    #[inline(never)]
    fn turned(&self, vector: [i32; 3]) -> Normal {
        let Some(Direction { vector, .. }) = Direction::of(vector) else {
            return Normal::along([0; 3]);
        };
        let cofactors = self.pose.cofactors();
        let all = magnitude(array::from_fn(|i| magnitude(cofactors[i]) as i32));
        // Cofactors are shortened alike, to 14 bits for the largest; the vector has 15: three products are below 3·2²⁹.
        let excess = 18 - zeros_of(all) as i32;
        // Without a choice, of which there would be copies.
        let (up, down) = ((-excess).max(0), excess.max(0));
        let sign = -i32::from(self.pose.is_mirrored());
        Normal::along(cofactors.map(|row| {
            let sum = (0..3).map(|i| (row[i] << up >> down) * vector[i]).sum::<i32>();
            (sum ^ sign) - sign
        }))
    }
}
