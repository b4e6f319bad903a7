//! Packing: how far packed texture coordinates may be off along a run of pixels.
//!
//! - In: the sides of a texture, whether it can be packed, and which inputs the shader reads.
//! - Out: the numbers with which [`lean`](super::lean) keeps these errors from showing.
//! - Assumes: sides of 2 … 256 texels, powers of two, if the texture is packed.
//!
//! Packed, u and v of a texture that repeats share one word, u in its lower half, v in its upper one. One addition steps
//! both. For a side of 2^n texels a coordinate has n integer bits and 16 − n fraction bits. Three errors come with that:
//!
//! - At the first pixel of a run a coordinate is rounded down to its last fraction bit, here called a *unit*.
//! - A step is cut to units, towards zero. That adds up from pixel to pixel.
//! - Where u repeats, its half of the word overflows: the *carry* moves v by one of its units.
//!
//! Therefore runs are short. After so many `steps` a run starts anew from coordinates of 32 bits.

use crate::geometry::Inputs;

/// What the plane of a [small](super::small) triangle may be off by, in units of 1/256 of a texel: 2⁻¹⁷ of a range of 2¹⁹ units, and half of one.
pub(super) const PLANE_MARGIN: u8 = 5;
/// With what packing rounds down, a unit of 256 texels. From this on coordinates are packed.
pub(super) const PACKED_MARGIN: u8 = PLANE_MARGIN + 1;

/// How many steps a run may have, with sides of more than 64 texels. A step is cut to 8 bits for 256 texels: after 15 it is off by 1/17
/// texel, and carries have moved v as far as there is room for.
pub(super) const LARGE: u8 = 15;

/// How far texture coordinates may be off in the runs of one shader. All lengths are in I16F16, before coordinates are scaled
/// by `Attribute::scale_log2`. If they are not packed the unit is 1, and no error adds up.
#[derive(Clone, Copy, Default)]
pub(crate) struct Packing {
    /// Log₂ of the larger one of the units of u and v, I16F16.
    unit_log2: u8,
    /// How far v stays inside its range, I16F16, where it does not [lean](super::triangle::TriangleSetup::lean): as far as
    /// carries can take it in a run, if u does not repeat within four pixels. At least 1; 0 if u and v are not among the
    /// inputs.
    pub(crate) inset: u16,
    /// The most steps before a run starts anew; 0 if coordinates are not packed.
    pub(super) steps: u8,
    /// Log₂ of the length after which u repeats, I16F16.
    pub(super) turn_log2: u8,
}

const _: () = assert!(size_of::<Packing>() == 6);

impl Packing {
    /// Where u and v are not read.
    pub(crate) const NONE: Self = Self { unit_log2: 0, inset: 0, steps: 0, turn_log2: 31 };

    /// For a texture with sides of 2^`log2` texels, or `None` if it is not packed. The scale is no larger than that.
    #[inline]
    pub(crate) fn new(log2: Option<[u32; 2]>, scale_log2: u32, inputs: Inputs) -> Self {
        if !matches!(inputs, Inputs::Uv | Inputs::UvColor) {
            return Self::NONE;
        }
        let Some([a, b]) = log2 else {
            return Self { inset: 1, ..Self::NONE };
        };
        let steps = if a.max(b) > 6 { LARGE.into() } else { 63 };
        let unit_log2 = (a.max(b).wrapping_sub(scale_log2) & 15) as u8;
        let turn_log2 = (16 + a).wrapping_sub(scale_log2) as u8;
        Self { unit_log2, inset: (steps / 4 + 3) << unit_log2, steps: steps as u8, turn_log2 }
    }

    /// How far u and v of plain small triangles keep from the ends of their range, in 1/256 texel: as much as their planes may be off by;
    /// packed, what that rounds down, and for v as far as carries can take it. Of a texture without scale.
    pub(crate) fn margins(&self) -> [u8; 2] {
        if self.steps == 0 {
            return [PLANE_MARGIN; 2];
        }
        let carries = (self.inset >> 8) as u8 + 1;
        [PACKED_MARGIN, PACKED_MARGIN + carries]
    }

    /// The same for coordinates with `log2` more fraction bits.
    #[inline]
    pub(super) fn finer(&self, log2: u32) -> Self {
        if log2 == 0 || self.steps == 0 {
            return Self { ..*self };
        }
        let turn_log2 = self.turn_log2 + log2 as u8;
        Self { unit_log2: self.unit_log2 + log2 as u8, inset: self.inset << log2, turn_log2, ..*self }
    }

    /// Whether a side has more than 64 texels, so that runs may be off by more of a texel.
    #[inline]
    pub(super) fn is_large(&self) -> bool {
        self.steps == LARGE
    }

    /// The larger one of the units of u and v, I16F16.
    #[inline]
    pub(super) fn unit(&self) -> u32 {
        1 << (self.unit_log2 & 31)
    }

    /// Log₂ of 32 units, of a packed texture of which no side has more than 64 texels; of any other 0.
    #[inline]
    pub(super) fn contraction_log2(&self) -> u32 {
        if self.steps == 63 { u32::from(self.unit_log2) + 5 } else { 0 }
    }

    /// Whether u repeats within four pixels if it changes by this per pixel, I16F16.
    #[inline]
    pub(super) fn is_steep(&self, u_step: i32) -> bool {
        u_step.unsigned_abs() >> ((self.turn_log2 - 2) & 31) != 0
    }

    /// How many units of v the carries of u may come to in a run. `u_step` is the size of u's step, I16F16.
    ///
    /// Each time that u repeats is one carry. That may be once more than the run has whole periods, and the number of periods
    /// is rounded down here. A third unit is for a falling u, which borrows from v: v starts one unit too large then.
    ///
    /// But u repeats at every second step at most: whole periods are taken out of a step, which leaves at most half
    /// a period in either direction.
    pub(super) fn carries(&self, u_step: u32, steps: u32) -> u32 {
        let turns = ((u_step >> 8) * steps) >> (self.turn_log2 - 8);
        (turns + 3).min(steps / 2 + 2)
    }
}
