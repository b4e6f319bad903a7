//! Packing: how far packed texture coordinates may be off along a run.

/// How [packed texture coordinates](crate::Texture) are drawn, before they are scaled. Of others a unit is 1, and a run has no
/// steps that add up.
pub(crate) struct Packing {
    /// The larger unit of the two, I16F16: at a run's first pixel they are rounded down to it, and their steps are cut to it.
    pub(super) unit: u32,
    /// The most steps before a run starts anew.
    pub(super) steps: u32,
    /// Log₂ of where u repeats, I16F16. There it carries into v.
    pub(super) turn_log2: u32,
}

impl Packing {
    /// Of a texture with sides of these log₂.
    #[inline(never)]
    pub(crate) fn new(log2: Option<[u32; 2]>, scale_log2: u32) -> Self {
        let Some([a, b]) = log2 else {
            return Self { unit: 1, steps: 0, turn_log2: 31 };
        };
        let steps = if a.max(b) > 6 { 15 } else { 63 };
        let unit = 1 << (a.max(b).wrapping_sub(scale_log2) & 31);
        Self { unit, steps, turn_log2: 16 + a - scale_log2 }
    }

    /// How far carries can take v where u does not repeat within four pixels, at least 1.
    pub(crate) fn inset(&self) -> u32 {
        if self.steps == 0 { 1 } else { self.unit * (self.steps / 4 + 3) }
    }

    /// As whole turns of u are left out of a step, it repeats after two steps at the soonest, and once more where it begins. And there
    /// v may be one unit too large for what a falling u is to borrow from it.
    const fn most_carries(steps: u32) -> u32 {
        steps / 2 + 2
    }

    /// Likewise, where u changes by no more than this.
    pub(super) fn carries(&self, u_step: u32, steps: u32) -> u32 {
        let turns = ((u_step >> 8) * steps) >> (self.turn_log2 - 8);
        (turns + 3).min(Self::most_carries(steps))
    }
}
