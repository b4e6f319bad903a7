//! Straight triangles: those whose attributes may be interpolated linearly on the screen, without a division by q.
//!
//! - In: the edges of a triangle and q at its corners.
//! - Out: whether linear interpolation is exact enough for any attribute. [`course`](super::course) asks for a single one.
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
//! Here |Δqᵢⱼ|/q_min is called the *fall* of an edge.

use crate::math::recip::short_of;
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
        })
    }

    /// Whether linear interpolation will do for any attribute: 4 · error ≤ `limit`, which has 16 fraction bits.
    #[inline]
    pub(crate) fn is_straight(&self, limit: u32) -> bool {
        // In 1/16 px with 16 fraction bits: 2¹⁶ · 2¹⁴ at most.
        self.lengths.iter().zip(self.falls).all(|(length, fall)| length * fall <= limit << 4)
    }
}
