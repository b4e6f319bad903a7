//! The table of reciprocals: 1/w at every pixel of a row, without a division.
//!
//! - In: w as a part of its greatest value along a run of pixels, with 32 fraction bits.
//! - Out: 1/w with 13 or 16 fraction bits, never too large.
//! - Assumes: w is at least 1/8, or at least ½ for the more exact one.
//!
//! The upper 10 bits of w choose one of 1024 entries. An entry is the reciprocal of the greatest w of its interval,
//! less one unit. So what comes out is too small by up to 1/(1024·w²) and two units, and never too large: an
//! attribute that is made of it stays between its values at the two ends of a run.

use crate::frame::PixelFormat;
use core::hint::black_box;

/// 1/w for the greatest w of each interval of 1/1024, 13 fraction bits, and a unit less; from 1/8 on. Exactly 1 in the last one.
static INVERSES: [u16; 1024] = {
    let mut inverses = [u16::MAX; 1024];
    let mut i = 128;
    while i < 1023 {
        inverses[i] = ((1u32 << 23) / (i as u32 + 1) - 1) as u16;
        i += 1;
    }
    inverses[1023] = 1 << 13;
    inverses
};

/// 1 with as many fraction bits as [`inverse`] has.
pub(crate) const ONE_LOG2: u32 = 13;

/// 1/w with 13 fraction bits: 2¹³ … 2¹⁶ − 1.
#[inline(always)]
pub(crate) fn inverse(w: u32) -> u32 {
    INVERSES[(w >> 22) as usize].into()
}

/// 1/w of a w of ½ or more with 16 fraction bits, off by at most 2⁻¹⁶·5.
///
/// A step of Newton's iteration, t + t·(1 − w·t), squares the table's relative error, which is below 2⁻⁸ there. It
/// never comes out too large.
#[inline(always)]
pub(crate) fn exact_inverse(w: u32) -> u32 {
    let t = inverse(w);
    // 16 bits of w, rounded up; t is at most 2¹⁴. What w·t lacks of 1 has 29 fraction bits, and is below 2²¹.
    let lack = (1u32 << 29).saturating_sub(((w >> 16) + 1).wrapping_mul(t));
    (t << 3) + (t.wrapping_mul(lack >> 5) >> 21)
}

/// Leaves 1/w in each pixel, for a pass that follows. `step` is added to w from pixel to pixel.
#[inline(always)]
pub(crate) fn leave<F: PixelFormat>(pixels: &mut [F::Word], mut w: u32, step: u32) {
    let mut draw = |pixel: &mut F::Word, step: u32| {
        *pixel = F::keep(inverse(w) as u16);
        w = w.wrapping_add(step);
    };
    let (blocks, rest) = pixels.as_chunks_mut::<8>();
    for block in blocks {
        // Hidden, so that the compiler does not keep eight multiples of it in memory: 8.3 cycles a pixel instead of
        // 9.9 on a Cortex-M0+.
        let step = black_box(step);
        block.iter_mut().for_each(|pixel| draw(pixel, step));
    }
    for pixel in rest {
        draw(pixel, step);
        black_box(());
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::println;

    /// Some of all w from `least` on, and those at both ends of each interval of the table.
    fn all(least: u32) -> impl Iterator<Item = u32> {
        let ends = (least >> 22..1024).flat_map(|i| [i << 22, (i << 22) + ((1 << 22) - 1)]);
        (least..=u32::MAX).step_by(997).chain(ends)
    }

    #[test]
    fn inverses_are_never_too_large_nor_further_than_an_interval_and_a_unit() {
        let mut worst = 0f64;
        for w in all(1 << 29) {
            let exactly = 2f64.powi(45) / f64::from(w);
            let below = exactly - f64::from(inverse(w));
            // An interval of 1/1024 of w, over w²; and two units of 2⁻¹³ for rounding.
            let interval = exactly * exactly / 2f64.powi(13 + 10);
            assert!(below >= 0.0 && below <= interval * 1.002 + 2.0, "{w:#x}: {below} of {exactly}");
            worst = worst.max((below - 2.0) / interval);
        }
        println!("inverse: at most {worst:.3} of an interval below, and two units");
        assert!(worst > 0.9 && inverse(u32::MAX) == 1 << ONE_LOG2);
    }

    #[test]
    fn exact_inverses_are_never_too_large_nor_6_units_of_2_pow_minus_16_too_small() {
        let mut worst = 0f64;
        for w in all(1 << 31) {
            let below = 2f64.powi(48) / f64::from(w) - f64::from(exact_inverse(w));
            assert!(below >= 0.0, "{w:#x}: {below}");
            worst = worst.max(below);
        }
        println!("exact inverse: at most {worst:.3} units of 2^-16 below");
        assert!(worst < 6.0 && worst > 1.0);
        assert_eq!(exact_inverse(u32::MAX), 1 << 16);
    }
}
