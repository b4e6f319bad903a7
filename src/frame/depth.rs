//! Depth formats: how the depth of a pixel is stored, and which of two surfaces is in front.
//!
//! - In: near/w of a surface at a pixel, and the depth stored there.
//! - Out: whether the surface is visible; if so its depth is stored.
//! - Assumes: near/w is 1 at the near plane and less beyond it, so greater is nearer.

use super::format::OfWords;
use crate::num::U1F31;

/// How depth is stored, and which of two surfaces is visible: a test, and a store for what was drawn.
#[diagnostic::on_unimplemented(
    message = "`{Self}` is not a format of depths",
    label = "depths are `Depth16`, or none, `NoDepth`",
    note = "with `NoDepth` what is drawn last is in front, and a band takes `&mut []` for its depths"
)]
pub trait DepthFormat: 'static {
    /// The depth of one pixel in memory.
    type Word: Copy;

    /// The depth of a pixel that nothing was drawn to.
    const CLEAR: Self::Word;

    /// Whether every test passes. Then none is made, and no memory for depths is needed.
    const ALWAYS_PASSES: bool = false;

    /// Whether a pixel with this near/w is visible where this depth is stored.
    fn test(stored: &Self::Word, near_w: U1F31) -> bool;

    /// Stores the depth of a pixel that was drawn.
    fn store(stored: &mut Self::Word, near_w: U1F31);

    /// Both: whether a pixel is visible; stores its depth if so. Called once for each pixel that a triangle covers whose surface draws
    /// all that is visible of it.
    #[inline]
    fn test_and_store(stored: &mut Self::Word, near_w: U1F31) -> bool {
        let passes = Self::test(stored, near_w);
        if passes {
            Self::store(stored, near_w);
        }
        passes
    }

    /// Sets all depths to [`DepthFormat::CLEAR`].
    #[doc(hidden)]
    #[inline]
    fn clear(depth: &mut [Self::Word]) {
        depth.fill(Self::CLEAR);
    }

    /// As [`DepthFormat::test_and_store`], where near/w is known to be 2⁻¹⁶ … 1. (That of small triangles always is.)
    #[doc(hidden)]
    #[inline]
    fn test_and_store_small(stored: &mut Self::Word, near_w: U1F31) -> bool {
        Self::test_and_store(stored, near_w)
    }

    /// What is made of this format's words, if it is [`Depth16`]: as [`PixelFormat::in_rgb565`](crate::PixelFormat::in_rgb565).
    #[doc(hidden)]
    #[inline]
    fn in_depth16<T: OfWords>(_of: T::Of<Self::Word>) -> Option<T::Of<u16>> {
        None
    }
}

/// 16-bit depth: near/w · 2¹⁶ rounded down, but at least 1; 0 where nothing was drawn. A pixel is drawn if it is strictly
/// nearer: of equals the first stays.
#[derive(Clone, Copy, Debug)]
pub struct Depth16;

impl DepthFormat for Depth16 {
    type Word = u16;
    const CLEAR: u16 = 0;

    #[inline]
    fn clear(depth: &mut [u16]) {
        // As aligned words of 32 bits: a fifth faster on a Cortex-M0+, and a seventh on an M4.
        let (first, words, last) = bytemuck::pod_align_to_mut::<u16, u32>(depth);
        first.fill(0);
        words.fill(0);
        last.fill(0);
    }

    #[inline]
    fn test(stored: &u16, near_w: U1F31) -> bool {
        depth16(near_w) > *stored
    }

    #[inline]
    fn store(stored: &mut u16, near_w: U1F31) {
        *stored = depth16(near_w);
    }

    #[inline]
    fn test_and_store_small(stored: &mut u16, near_w: U1F31) -> bool {
        // Not below 1, as it is: 4 cycles less.
        let depth = near_w.to_bits() >> 15;
        let nearer = depth > u32::from(*stored);
        if nearer {
            *stored = depth as u16;
        }
        nearer
    }

    #[inline]
    fn in_depth16<T: OfWords>(of: T::Of<u16>) -> Option<T::Of<u16>> {
        Some(of)
    }
}

#[inline]
fn depth16(near_w: U1F31) -> u16 {
    ((near_w.to_bits() >> 15) as u16).max(1)
}

/// No depth: what is drawn last is visible. It takes no memory. A [`DisplayList`](crate::DisplayList) can be
/// [sorted](crate::DisplayList::sort_back_to_front) for it.
#[derive(Clone, Copy, Debug)]
pub struct NoDepth;

impl DepthFormat for NoDepth {
    type Word = ();
    const CLEAR: () = ();
    const ALWAYS_PASSES: bool = true;

    #[inline]
    fn test((): &(), _: U1F31) -> bool {
        true
    }

    #[inline]
    fn store((): &mut (), _: U1F31) {}
}
