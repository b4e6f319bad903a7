//! Packing: how far packed texture coordinates may be off along a run.

use crate::geometry::Inputs;

/// How [packed texture coordinates](crate::Texture) are drawn, before they are scaled. Of others a unit is 1, and a run has no
/// steps that add up.
pub(crate) struct Packing {
    /// The larger unit of the two, I16F16: at a run's first pixel they are rounded down to it, and their steps are cut to it.
    pub(super) unit: u16,
    /// How far from the ends of their range u and v stay if they may not be [exactly straight](super::triangle::TriangleSetup::lean), I16F16: as far as
    /// carries can take v where u does not repeat within four pixels, and 1 at least. 0 if they are not among the inputs.
    pub(crate) inset: u16,
    /// The most steps before a run starts anew.
    pub(super) steps: u8,
    /// Log₂ of where u repeats, I16F16. There it carries into v.
    pub(super) turn_log2: u8,
}

const _: () = assert!(size_of::<Packing>() == 6);

impl Packing {
    /// Of a texture with sides of these log₂, if it is packed, for these inputs.
    #[inline(never)]
    pub(crate) fn new(log2: Option<[u32; 2]>, scale_log2: u32, inputs: Inputs) -> Self {
        if !matches!(inputs, Inputs::Uv | Inputs::UvColor) {
            return Self { unit: 1, inset: 0, steps: 0, turn_log2: 31 };
        }
        let Some([a, b]) = log2 else {
            return Self { unit: 1, inset: 1, steps: 0, turn_log2: 31 };
        };
        let steps = if a.max(b) > 6 { 15 } else { 63 };
        let unit = 1 << (a.max(b).wrapping_sub(scale_log2) & 15);
        let turn_log2 = (16 + a).wrapping_sub(scale_log2) as u8;
        Self { unit, inset: unit * (steps / 4 + 3), steps: steps as u8, turn_log2 }
    }

    /// Whether a step makes u repeat within four pixels.
    #[inline]
    pub(super) fn is_steep(&self, u_step: i32) -> bool {
        u_step.unsigned_abs() >> ((self.turn_log2 - 2) & 31) != 0
    }

    /// How many units of v carries may come to in so many steps of u: one where it begins, one for each time it repeats, which is
    /// every second step at the most, as whole turns of u are left out; and v may be one unit too large for what a falling u is to
    /// borrow from it.
    pub(super) fn carries(&self, u_step: u32, steps: u32) -> u32 {
        let turns = ((u_step >> 8) * steps) >> (self.turn_log2 - 8);
        (turns + 3).min(steps / 2 + 2)
    }
}
