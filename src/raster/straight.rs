//! Which triangles are straight: those whose attributes count as linear on the screen.
//!
//! - In: the edges of a triangle, and q and attributes at its corners.
//! - Out: whether linear interpolation is exact enough, or by how much it has to bend.
//! - Assumes: q differs by less than a quarter of the least.
//!
//! Linear interpolation and the exact one differ by the covariance of u and q under the weights α, divided by q:
//!
//! ```text
//! u_exact − u_linear = (Σ αᵢαⱼ·Δuᵢⱼ·Δqᵢⱼ) / q,   over the edges ij
//! ```
//!
//! That is at most ¼·max |Δuᵢⱼ·Δqᵢⱼ| / q_min: if all three products have one sign, u and q rise together, the largest is that of
//! the whole range, and a covariance is at most a quarter of the product of the ranges; else the two of one sign share a
//! corner i, and αᵢ(1 − αᵢ) ≤ ¼. To be pixels it is divided by the change of u over a pixel, which on each edge is at least
//! |Δuᵢⱼ| / (|Δxᵢⱼ| + |Δyᵢⱼ|), and counts as at least 1 texel or 1/255.

use crate::math::recip::short_of;
use crate::num::mul_16;

/// Which triangles are straight in some quality.
#[derive(Clone, Copy, Debug)]
pub enum Straight {
    /// All.
    Always,
    /// Those with 4 · error ≤ this, in pixels of 16 fraction bits, where distances differ by less than a quarter.
    Below(u32),
}

/// What the error of linear interpolation depends on, but for the attribute.
pub(crate) struct Bend {
    /// |Δx| + |Δy| of the edges 01, 02, 12 in 1/16 px, below 2¹⁷.
    lengths: [u32; 3],
    /// |Δq|/q_min along them, 16 fraction bits, below ¼.
    falls: [u32; 3],
    /// 1/q_min = `reciprocal` · 2^(`zeros` − 48).
    reciprocal: u32,
    zeros: u32,
}

impl Bend {
    /// From the edges as [`edges`](super::setup::edges) has them and q at the corners, below 2³¹, the first being the greatest,
    /// and the least.
    /// `None` if distances differ by a quarter.
    #[inline]
    pub(crate) fn new([across, down]: &[[i32; 2]; 2], [q0, q1, q2]: [u32; 3], least: u32) -> Option<Self> {
        if q0 - least >= least >> 2 {
            return None;
        }
        let (reciprocal, zeros) = short_of(least);
        let length = |x: i32, y: i32| x.unsigned_abs() + y.unsigned_abs();
        Some(Self {
            lengths: [
                length(across[1], down[1]),
                length(across[0], down[0]),
                length(across[0] + across[1], down[0] + down[1]),
            ],
            // Rounded up; falls are less than a quarter: at most 2¹⁴ times 2¹⁷.
            falls: [q0 - q1, q0 - q2, q1.abs_diff(q2)]
                .map(|fall| (((((fall << zeros) >> 16) + 1) * reciprocal) >> 16) + 1),
            reciprocal,
            zeros,
        })
    }

    /// As [`Bend::new`] and [`Bend::is_straight`], without a division: it finds most of those that are, where q falls by less than
    /// 2²⁷ and edges are shorter than 2¹².
    #[inline(always)]
    pub(crate) fn is_needless(
        [across, down]: &[[i32; 2]; 2],
        [q0, q1, q2]: [u32; 3],
        least: u32,
        limit: u32,
    ) -> bool {
        // 15 bits times 16; 12 times 15 and a bit. Falls are rounded up.
        if q0 - least >= least >> 2 {
            return false;
        }
        let most = ((least >> 16) * limit) >> 8;
        let is_short =
            |x: i32, y: i32, fall: u32| (x.unsigned_abs() + y.unsigned_abs()) * ((fall >> 12) + 1) <= most;
        is_short(across[1], down[1], q0 - q1)
            && is_short(across[0], down[0], q0 - q2)
            && is_short(across[0] + across[1], down[0] + down[1], q1.abs_diff(q2))
    }

    /// Whether all attributes are straight.
    #[inline]
    pub(crate) fn is_straight(&self, limit: u32) -> bool {
        // 2¹⁷ · 2¹⁴, in 1/16 px.
        self.lengths.iter().zip(self.falls).all(|(length, fall)| length * fall <= limit << 4)
    }

    /// Whether an attribute is that rises so from corner 0 to 1 and 2, by less than 2²⁸; an error of `unit` is one pixel's at
    /// most. The edges are shorter than 2¹².
    #[inline]
    pub(crate) fn is_straight_for(&self, limit: u32, rise: [i32; 2], unit: u32) -> bool {
        let rises = [rise[0], rise[1], rise[1] - rise[0]].map(i32::unsigned_abs);
        // 4 · error, at most a quarter of a rise.
        let error = (0..3).fold(0, |all, i| all.max(mul_16(rises[i] as i32, self.falls[i]))) as u32;
        let error = (error >> 8) + 1;
        let range = rises[0].max(rises[1]).max(rises[2]) as i32;
        // Elsewhere u may change that much less along an edge.
        let least = |i: usize| rises[i].saturating_sub(mul_16(range, self.falls[i]) as u32);
        error <= ((unit >> 8) * (limit >> 8)) >> 8
            || (0..3).any(|i| error * self.lengths[i] <= ((least(i) >> 8) * (limit >> 8)) >> 4)
    }

    /// |Δq| from corner 0 to 1 or 2 by the middle of the least and the greatest q, 16 fraction bits.
    #[inline]
    pub(crate) fn fall(&self, i: usize) -> u32 {
        (self.falls[i] * self.to_middle()) >> 15
    }

    /// q_min by the middle of the least and the greatest, 15 fraction bits, nearly.
    #[inline]
    fn to_middle(&self) -> u32 {
        (1 << 15) - (self.falls[0].max(self.falls[1]) >> 2)
    }

    /// By how much of the middle of the least and the greatest q it changes a column and a row, 16 fraction bits. `None` where a
    /// quadratic would not do.
    #[inline]
    pub(crate) fn slopes(&self, steps: [i32; 2]) -> Option<[i32; 2]> {
        let most = self.falls[0].max(self.falls[1]);
        // In 1/16 px. Of the longest edge: along that u changes the most.
        let longest = self.lengths[0].max(self.lengths[1]).max(self.lengths[2]);
        let is_exact = longest * ((most * most) >> 16) <= 12 << 16;
        let least = (1u32 << 31) >> self.zeros;
        if !is_exact || steps.iter().any(|step| step.unsigned_abs() > least >> 2) {
            return None;
        }
        let middle = self.to_middle();
        Some(steps.map(|step| {
            let slope = (((step << self.zeros) >> 16) * self.reciprocal as i32) >> 16;
            (slope * middle as i32) >> 15
        }))
    }
}
