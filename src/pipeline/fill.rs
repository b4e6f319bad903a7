//! Fills: runs of pixels along which attributes are linear.

use crate::scene::Texture;
use crate::target::PixelFormat;
use core::marker::PhantomData;

/// How the pixels of a run get their words from `N` attributes in I16F16.
pub(crate) trait Fill<const N: usize> {
    type Word;

    /// The longest run, log₂, over which [`Fill::run`] is exact enough, and beyond which nothing is gained.
    #[inline]
    fn max_log2(&self) -> u32 {
        5
    }

    /// One pixel.
    fn pixel(&self, at: [i32; N]) -> Self::Word;

    /// Any number of pixels side by side, likewise.
    #[inline]
    fn run_long(&self, pixels: &mut [Self::Word], at: [i32; N], step: [i32; N]) {
        self.run(pixels, at, step);
    }

    /// At most 2^`max_log2` pixels side by side, the first at `at`, each `step` further.
    #[inline]
    fn run(&self, pixels: &mut [Self::Word], mut at: [i32; N], step: [i32; N]) {
        for pixel in pixels {
            *pixel = self.pixel(at);
            for (value, step) in at.iter_mut().zip(step) {
                *value = value.wrapping_add(step);
            }
        }
    }
}

/// Pixel by pixel.
pub(crate) struct Each<W, C>(pub(crate) C, pub(crate) PhantomData<fn() -> W>);

impl<W, const N: usize, C: Fn([i32; N]) -> W> Fill<N> for Each<W, C> {
    type Word = W;

    #[inline]
    fn pixel(&self, at: [i32; N]) -> W {
        (self.0)(at)
    }
}

/// Texels of a texture that repeats, u and v packed in one word.
///
/// For 2^a × 2^b texels the lower half of the word holds u with a integer and 16 − a fraction bits, the upper half v with b
/// and 16 − b: one addition steps both, and both repeat by themselves. Masking leaves the integer bits, and one
/// multiplication moves those of u below those of v:
///
/// ```text
///   vvvvvv00 00000000 uuuuuu00 00000000  · (1 + 2^(16 − b))  >> (32 − a − b)  =  vvvvvvuu uuuu
/// ```
///
/// With the number of texels an array's, the compiler sees that the index cannot be outside it: 9 cycles a pixel on a
/// Cortex-M0+ where a bounds check would make it 20.
///
/// A carry from u moves v by its last bit; a step is cut to its last bit towards zero. So a run is at most 2^(11 − max(a, b))
/// long before it starts anew from 32 bits, which keeps it within 1/32 texel.
pub(crate) struct Texels<'a, F, const COUNT: usize> {
    texels: &'a [u16; COUNT],
    log2: [u32; 2],
    mask: u32,
    multiplier: u32,
    format: PhantomData<F>,
}

impl<'a, F: PixelFormat, const COUNT: usize> Texels<'a, F, COUNT> {
    /// `None` for a texture of another size, or with a side of one texel or of more than 2⁸.
    #[inline]
    pub(crate) fn new(texture: &Texture<'a>) -> Option<Self> {
        let log2 = texture.log2();
        let [a, b] = log2;
        let texels = texture.texels().first_chunk::<COUNT>()?;
        if texture.texels().len() != COUNT || a == 0 || b == 0 || a > 8 || b > 8 {
            return None;
        }
        let mask = !0 << (32 - b) | ((1 << a) - 1) << (16 - a);
        Some(Self { texels, log2, mask, multiplier: 1 + (1 << (16 - b)), format: PhantomData })
    }

    #[inline]
    fn texel(&self, packed: u32) -> F::Word {
        let index = (packed & self.mask).wrapping_mul(self.multiplier) >> (32 - COUNT.trailing_zeros());
        F::rgb565(self.texels[index as usize])
    }
}

impl<F: PixelFormat, const COUNT: usize> Fill<2> for Texels<'_, F, COUNT> {
    type Word = F::Word;

    #[inline]
    fn max_log2(&self) -> u32 {
        11 - self.log2[0].max(self.log2[1]).max(6)
    }

    #[inline]
    fn pixel(&self, [u, v]: [i32; 2]) -> F::Word {
        let packed = (((v >> self.log2[1]) as u32) << 16) | ((u >> self.log2[0]) as u32 & 0xffff);
        self.texel(packed)
    }

    #[inline]
    fn run_long(&self, pixels: &mut [F::Word], [mut u, mut v]: [i32; 2], step: [i32; 2]) {
        let log2 = self.max_log2();
        for block in pixels.chunks_mut(1 << log2) {
            self.run(block, [u, v], step);
            (u, v) = (u.wrapping_add(step[0] << log2), v.wrapping_add(step[1] << log2));
        }
    }

    #[inline]
    fn run(&self, pixels: &mut [F::Word], [u, v]: [i32; 2], [u_step, v_step]: [i32; 2]) {
        let [a, b] = self.log2;
        let towards_zero = |step: i32, log2: u32| (step + ((step >> 31) & ((1 << log2) - 1))) >> log2;
        let step = ((towards_zero(v_step, b) as u32) << 16).wrapping_add(towards_zero(u_step, a) as u32);
        // A negative step of u borrows from v where u starts anew: lend it the last bit.
        let packed = (((v >> b) as u32) << 16) | ((u >> a) as u32 & 0xffff);
        let mut packed = packed.wrapping_add((u_step as u32 >> 31) << 16);
        let (blocks, rest) = pixels.as_chunks_mut::<4>();
        for block in blocks {
            for pixel in block {
                *pixel = self.texel(packed);
                packed = packed.wrapping_add(step);
            }
        }
        for pixel in rest {
            *pixel = self.texel(packed);
            packed = packed.wrapping_add(step);
        }
    }
}
