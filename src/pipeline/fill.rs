//! Fills: runs of pixels along which attributes are linear.

use crate::scene::Texture;
use crate::target::PixelFormat;
use core::marker::PhantomData;

/// How the pixels of a run get their words from `N` attributes in I16F16.
pub(crate) trait Fill<const N: usize> {
    type Word;

    /// The longest bent run that is exact enough.
    #[inline]
    fn longest(&self) -> i32 {
        16
    }

    /// Attribute `i` of I16F16 times 2^`scale_log2` in the units of bent runs.
    #[inline]
    fn in_units(&self, _i: usize, value: i32, scale_log2: u32) -> i32 {
        value << scale_log2
    }

    /// One pixel.
    fn pixel(&self, at: [i32; N]) -> Self::Word;

    /// Any number of pixels side by side, the first at `at`, each `step` further.
    #[inline]
    fn run_long(&self, pixels: &mut [Self::Word], mut at: [i32; N], step: [i32; N]) {
        for pixel in pixels {
            *pixel = self.pixel(at);
            for (value, step) in at.iter_mut().zip(step) {
                *value = value.wrapping_add(step);
            }
        }
    }

    /// At most `longest` pixels and one side by side, the first at `at`, each `step` further, `bend` being added to that
    /// each time; in the units of bent runs.
    #[inline]
    fn bent(&self, pixels: &mut [Self::Word], mut at: [i32; N], mut step: [i32; N], bend: [i32; N]) {
        for pixel in pixels {
            *pixel = self.pixel(at);
            for i in 0..N {
                at[i] = at[i].wrapping_add(step[i]);
                step[i] = step[i].wrapping_add(bend[i]);
            }
        }
    }

    /// As [`Fill::bent`] a number of pixels that the compiler knows.
    #[inline]
    fn block<const LENGTH: usize>(
        &self,
        pixels: &mut [Self::Word; LENGTH],
        at: [i32; N],
        step: [i32; N],
        bend: [i32; N],
    ) {
        self.bent(pixels, at, step, bend);
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
    /// `None` for a texture of another size, with a side of one texel, of more than 2⁸, or less than 2^`scale_log2`.
    #[inline]
    pub(crate) fn new(texture: &Texture<'a>, scale_log2: u32) -> Option<Self> {
        let log2 = texture.log2();
        let [a, b] = log2;
        let texels = texture.texels().first_chunk::<COUNT>()?;
        let sides = scale_log2.max(1)..=8;
        if texture.texels().len() != COUNT || !sides.contains(&a) || !sides.contains(&b) {
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
    fn longest(&self) -> i32 {
        if self.log2[0] > 6 || self.log2[1] > 6 { 8 } else { 16 }
    }

    #[inline]
    fn in_units(&self, i: usize, value: i32, scale_log2: u32) -> i32 {
        value >> (self.log2[i].wrapping_sub(scale_log2) & 31)
    }

    #[inline]
    fn pixel(&self, [u, v]: [i32; 2]) -> F::Word {
        self.texel(packed([u >> self.log2[0], v >> self.log2[1]]))
    }

    #[inline]
    fn run_long(&self, pixels: &mut [F::Word], [mut u, mut v]: [i32; 2], [u_step, v_step]: [i32; 2]) {
        let [a, b] = self.log2;
        let log2 = 11 - a.max(b).max(6);
        let towards_zero = |step: i32, log2: u32| (step + ((step >> 31) & ((1 << log2) - 1))) >> log2;
        let step = packed_step([towards_zero(u_step, a), towards_zero(v_step, b)]);
        for block in pixels.chunks_mut(1 << log2) {
            let mut packed = packed([u >> a, v >> b]).wrapping_add((u_step as u32 >> 31) << 16);
            let (fours, rest) = block.as_chunks_mut::<4>();
            for four in fours {
                for pixel in four {
                    *pixel = self.texel(packed);
                    packed = packed.wrapping_add(step);
                }
            }
            for pixel in rest {
                *pixel = self.texel(packed);
                packed = packed.wrapping_add(step);
            }
            (u, v) = (u.wrapping_add(u_step << log2), v.wrapping_add(v_step << log2));
        }
    }

    #[inline]
    fn bent(&self, pixels: &mut [F::Word], at: [i32; 2], step: [i32; 2], bend: [i32; 2]) {
        // A negative step of u borrows from v where u starts anew: lend it the last bit.
        let falls = step[0].wrapping_mul(2).wrapping_add(bend[0]) as u32 >> 31;
        let mut packed = packed(at).wrapping_add(falls << 16);
        let (mut step, bend) = (packed_step(step), packed_step(bend));
        for pixel in pixels {
            *pixel = self.texel(packed);
            packed = packed.wrapping_add(step);
            step = step.wrapping_add(bend);
        }
    }
}

#[inline]
fn packed([u, v]: [i32; 2]) -> u32 {
    (v as u32) << 16 | (u as u32 & 0xffff)
}

/// A difference: u may be negative, and then borrows from v.
#[inline]
fn packed_step([u, v]: [i32; 2]) -> u32 {
    ((v as u32) << 16).wrapping_add(u as u32)
}
