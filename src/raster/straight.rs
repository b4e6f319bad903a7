//! Straight triangles: those whose attributes may be interpolated linearly on the screen, without a division by q.
//!
//! - In: the edges of a triangle and q at its corners; to ask for one attribute, also how that changes along the edges.
//! - Out: whether linear interpolation is exact enough; else the numbers of which [`small`](super::small) makes a quadratic.
//! - Assumes: q is below 2³¹.
//!
//! Where q varies by a quarter of its least value or more, a triangle never counts as straight (except in
//! [`Affine`](crate::Affine), where all do).
//!
//! # The error of linear interpolation
//!
//! Let α be the barycentric weights of a pixel. Linear interpolation gives Σ αᵢuᵢ. Exact is Σ αᵢuᵢqᵢ / q, with q = Σ αᵢqᵢ.
//! The two differ by the covariance of u and q under the weights α, divided by q:
//!
//! ```text
//! u_exact − u_linear = (Σ αᵢαⱼ·Δuᵢⱼ·Δqᵢⱼ) / q,   summed over the three edges ij
//! ```
//!
//! The sum is at most ¼·max |Δuᵢⱼ·Δqᵢⱼ|:
//!
//! - If no two of the three products have opposite signs, u and q put the corners in the same order, or in opposite ones. The
//!   largest product is then that of the two ranges, and no covariance exceeds a quarter of that.
//! - Else two products have one sign and the third has the other. Those two edges share a corner i, so their sum is at most
//!   αᵢ(1 − αᵢ) ≤ ¼ of the larger. The third is weighted with at most ¼, and takes away from that sum.
//!
//! In pixels the error is that divided by M, the largest change of u over one pixel to the right or down. Along an edge
//! |Δuᵢⱼ| ≤ M·(|Δxᵢⱼ| + |Δyᵢⱼ|). So u cancels, and one bound holds for all attributes:
//!
//! ```text
//! error ≤ ¼ · max (|Δxᵢⱼ| + |Δyᵢⱼ|) · |Δqᵢⱼ|/q_min   pixels
//! ```
//!
//! Here |Δqᵢⱼ|/q_min is called the *fall* of an edge. For a single attribute M counts as at least one texel, or one of 255
//! levels of a colour: what is off by less does not show.

use crate::math::recip::short_of;
use crate::num::mul_16;
use core::num::NonZeroU32;

/// Which triangles a quality draws as straight ones.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Straight {
    /// All.
    Always,
    /// Those with 4 · error ≤ this, in pixels with 16 fraction bits, at most 1.0.
    Below(NonZeroU32),
}

impl Straight {
    /// The limit of which [`Straight::Below`] is made. 0 is taken as 1.
    pub(crate) const fn below(limit: u32) -> Self {
        Self::Below(NonZeroU32::MIN.saturating_add(limit.saturating_sub(1)))
    }
}

// The number that is not used says that it is the other one.
const _: () = assert!(size_of::<Straight>() == 4);

/// What the error of linear interpolation depends on, apart from the attribute. The edges are 01, 02 and 12, in this order.
pub(crate) struct Bend {
    /// |Δx| + |Δy| of each edge in 1/16 px, below 2¹⁶.
    lengths: [u32; 3],
    /// |Δq|/q_min of each edge, 16 fraction bits, rounded up from less than ¼.
    falls: [u32; 3],
    /// Whether q rises from corner 0 to corner 1, and to corner 2.
    rises: [bool; 2],
    /// 1/q_min = `reciprocal` · 2^(`zeros` − 48); 2¹⁶ … 2¹⁷.
    reciprocal: u32,
    /// The leading zeros of q_min.
    zeros: u32,
}

impl Bend {
    /// From the edges as [`edges`](super::triangle::edges) has them, and q at the corners, below 2³¹. `None` if q varies by a
    /// quarter of the least or more.
    ///
    /// Entry 0 of `across` and `down` is the gradient of corner 1's weight. That is made of the differences of the opposite
    /// edge, 02. Likewise entry 1 has those of edge 01, and the sum of both is edge 12.
    ///
    /// Not inlined on Armv6-M, where it is long.
    #[cfg_attr(all(target_arch = "arm", not(target_has_atomic = "32")), inline(never))]
    #[cfg_attr(not(all(target_arch = "arm", not(target_has_atomic = "32"))), inline)]
    pub(crate) fn new([across, down]: &[[i32; 2]; 2], [q0, q1, q2]: [u32; 3]) -> Option<Self> {
        let (least, most) = (q0.min(q1).min(q2), q0.max(q1).max(q2));
        if most - least >= least >> 2 {
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
            // 14 bits of Δq times 17 bits of the reciprocal.
            falls: [q0.abs_diff(q1), q0.abs_diff(q2), q1.abs_diff(q2)]
                .map(|fall| (((((fall << zeros) >> 16) + 1) * reciprocal) >> 16) + 1),
            rises: [q1 > q0, q2 > q0],
            reciprocal,
            zeros,
        })
    }

    /// A quick test that saves [`Bend::new`]: true only where linear interpolation will do for any attribute, and for most
    /// such triangles. Parameters as in `new`, and the limit; q varies by less than 2²⁷, and |Δx| + |Δy| of all edges is
    /// below 2¹² sixteenths.
    ///
    /// length · Δq/q_min ≤ limit is tested as length · Δq ≤ limit · q_min, with Δq rounded up and q_min down.
    #[inline(always)]
    pub(crate) fn is_needless([across, down]: &[[i32; 2]; 2], [q0, q1, q2]: [u32; 3], limit: u32) -> bool {
        // Both sides in 1/16 px · 2¹² units of q. This one: 15 bits times 16. The other one: 12 bits times 15 and a bit.
        let most = ((q0.min(q1).min(q2) >> 16) * limit) >> 8;
        let is_short =
            |x: i32, y: i32, fall: u32| (x.unsigned_abs() + y.unsigned_abs()) * ((fall >> 12) + 1) <= most;
        is_short(across[1], down[1], q0.abs_diff(q1))
            && is_short(across[0], down[0], q0.abs_diff(q2))
            && is_short(across[0] + across[1], down[0] + down[1], q1.abs_diff(q2))
    }

    /// Whether linear interpolation will do for any attribute: 4 · error ≤ `limit`, which has 16 fraction bits.
    #[inline]
    pub(crate) fn is_straight(&self, limit: u32) -> bool {
        // In 1/16 px with 16 fraction bits: 2¹⁶ · 2¹⁴ at most.
        self.lengths.iter().zip(self.falls).all(|(length, fall)| length * fall <= limit << 4)
    }

    /// Whether linear interpolation will do for a texture coordinate: more exact than [`Bend::is_straight`],
    /// which has to be right for all.
    ///
    /// `rise` is its change from corner 0 to corners 1 and 2, I16F16, below 2²⁷. |Δx| + |Δy| of all edges is below 2¹² sixteenths.
    #[inline(never)]
    pub(crate) fn is_straight_for(&self, limit: u32, rise: [i32; 2]) -> bool {
        let rises = [rise[0], rise[1], rise[1] - rise[0]].map(i32::unsigned_abs);
        // 4 · error as a difference of u: the largest |Δu| · fall, so at most a quarter of a rise. Then 8 fraction bits,
        // rounded up.
        let error = (0..3).fold(0, |all, i| all.max(mul_16(rises[i] as i32, self.falls[i]))) as u32;
        let error = (error >> 8) + 1;
        let range = rises[0].max(rises[1]).max(rises[2]) as i32;
        // The exact u changes by (Δu·q̄ + (ū − u)·Δq) / q per length of an edge, where q̄ and ū are the means of its ends.
        // The error is divided by the same q, so that cancels; the rest is at least (|Δu| − range · fall) · q_min.
        let least = |i: usize| rises[i].saturating_sub(mul_16(range, self.falls[i]) as u32);
        // A texel, which M counts as at least.
        error <= limit >> 8
            || (0..3).any(|i| error * self.lengths[i] <= ((least(i) >> 8) * (limit >> 8)) >> 4)
    }

    /// By how much q rises from corner 0 to corner `i` + 1, divided by q_mid = (q_min + q_max)/2; 16 fraction bits.
    #[inline]
    pub(crate) fn rise(&self, i: usize) -> i32 {
        let size = ((self.falls[i] * self.to_middle()) >> 15) as i32;
        if self.rises[i] { size } else { -size }
    }

    /// The largest fall of an edge: what q varies by.
    #[inline]
    fn most(&self) -> u32 {
        self.falls[0].max(self.falls[1]).max(self.falls[2])
    }

    /// q_min/q_mid with 15 fraction bits: 1/(1 + f/2) ≈ 1 − f/2, f being what q varies by. At most 1/64 too small.
    #[inline]
    fn to_middle(&self) -> u32 {
        (1 << 15) - (self.most() >> 2)
    }

    /// From the change of q per column and per row: the same divided by q_mid, 16 fraction bits, within ±¼. `None` where a
    /// quadratic is not exact enough, or where q changes by more than a quarter of q_min per pixel (for some q_min, an
    /// eighth).
    #[inline]
    pub(crate) fn slopes(&self, steps: [i32; 2]) -> Option<[i32; 2]> {
        let most = self.most();
        // The quadratic is off by length · fall²/8 (see `small`). That has to be 3/32 pixel at most: length · fall² ≤ 3/4
        // pixel, in 1/16 px with 16 fraction bits. Any edge may be the one that counts: so the longest with the largest fall.
        let longest = self.lengths[0].max(self.lengths[1]).max(self.lengths[2]);
        let is_exact = longest * ((most * most) >> 16) <= 12 << 16;
        // At most q_min, so that a quarter of it leaves `step << zeros` within ±2²⁹.
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
