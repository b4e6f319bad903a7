//! Texture coordinates packed in one word, so that one addition steps both, and the texels at them.

use super::curve::Linear;
use super::fill::{Steps, draw_row};
use crate::frame::PixelFormat;
use crate::num::IS_ARMV6M;
use crate::raster::{ATTRIBUTES, TriangleSetup};
use crate::scene::Texture;

/// The texel at packed coordinates of a texture of so many.
#[inline]
pub(crate) fn sized<const COUNT: usize>(texture: &Texture<'_>, texels: &[u16; COUNT]) -> impl Fn(u32) -> u16 {
    let [mask, multiplier] = texture.mask_and_multiplier();
    move |packed| texels[((packed & mask).wrapping_mul(multiplier) >> (32 - COUNT.trailing_zeros())) as usize]
}

/// The integer bits of u and v in units of 32 bits. For one texel 0 would do, but a shift by 32 is none: it has 1.
#[inline]
pub(crate) fn integer_bits(texture: &Texture<'_>) -> [u32; 2] {
    texture.log2().map(|log2| log2.max(1))
}

/// The fraction bits of u and v in units of 32 bits: by so much to the right they are whole texels.
#[inline]
pub(crate) fn downs(texture: &Texture<'_>) -> [u32; 2] {
    integer_bits(texture).map(|bits| (32 - bits) & 31)
}

/// The lines of u and v, in units of 32 bits. That of a side of one texel is 0 all along, as the one integer bit is to be.
#[inline]
pub(crate) fn lines_of(texture: &Texture<'_>, [u, v, ..]: &[Linear; ATTRIBUTES]) -> [Linear; 2] {
    let [a, b] = texture.log2();
    let none = Linear { at: 0, slope: 0 };
    [if a == 0 { none } else { *u }, if b == 0 { none } else { *v }]
}

/// The place of a run, whose first step of u is negative or not.
#[inline]
pub(crate) fn packed_from([u, v]: [i32; 2], u_step: i32) -> u32 {
    // A negative step of u borrows from v where u starts anew: lend it the last bit.
    ((v as u32) << 16 | (u as u32 & 0xffff)).wrapping_add((u_step as u32 >> 31) << 16)
}

/// A difference: u may be negative, and then borrows from v.
#[inline]
pub(crate) fn packed_step([u, v]: [i32; 2]) -> u32 {
    ((v as u32) << 16).wrapping_add(u as u32)
}

/// A step of u without whole turns, which would be carried into v.
#[inline]
pub(crate) fn turned(u_step: i32) -> i32 {
    (u_step as i16).into()
}

/// A step without its last bits, cut towards zero.
#[inline]
pub(crate) fn shifted(step: i32, log2: u32) -> i32 {
    (step + ((step >> 31) & ((1 << log2) - 1))) >> log2
}

/// By how much I16F16 is to be shifted right to be packed.
#[inline(always)]
fn shifts(texture: &Texture<'_>) -> [u32; 2] {
    let [a, b] = texture.log2();
    [a & 31, b & 31]
}

/// The step of u and v along the rows that [`draw_texels`] draws, from I16F16: packed if they are, in the first word.
#[inline(always)]
pub(crate) fn step_of(texture: &Texture<'_>, is_packed: bool, step: [i32; 2]) -> [i32; 2] {
    if !is_packed {
        return step;
    }
    let [a, b] = shifts(texture);
    [packed_step([shifted(step[0], a), shifted(step[1], b)]) as i32, 0]
}

/// The place of u and v where such a row begins, likewise, from I16F16.
#[inline(always)]
pub(crate) fn place_of(texture: &Texture<'_>, is_packed: bool, [u, v]: [i32; 2], step: [i32; 2]) -> [i32; 2] {
    if !is_packed {
        return [u, v];
    }
    let [a, b] = shifts(texture);
    // The sign of u's step is that of the lower half, unless u repeats within two pixels, and then a row is one pixel.
    [packed_from([u >> a, v >> b], step[0] << 16) as i32, 0]
}

/// Place and step of u and v along a row of a bent triangle, likewise.
#[inline(always)]
pub(crate) fn bent(
    texture: &Texture<'_>,
    is_packed: bool,
    setup: &TriangleSetup,
    (place, steps): ([i32; 2], i32),
) -> ([i32; 2], [i32; 2]) {
    if is_packed {
        let (at, step) = packed_bent(texture, setup, place, steps);
        return ([at as i32, 0], [step as i32, 0]);
    }
    let [u, v] = [0, 1].map(|i| setup.along(i, place, steps));
    ([u.0, v.0], [u.1, v.1])
}

#[inline(never)]
fn packed_bent(texture: &Texture<'_>, setup: &TriangleSetup, place: [i32; 2], steps: i32) -> (u32, u32) {
    let [(u, u_step), (v, v_step)] = setup.along_bent(place, steps);
    let [a, b] = shifts(texture);
    let u_step = shifted(u_step, a);
    (packed_from([u >> a, v >> b], u_step), packed_step([u_step, shifted(v_step, b)]))
}

/// Draws a row of a small triangle with texels, u and v as `place_of` and `step_of` have them. `other` is whatever else a word is made of,
/// and steps as well.
///
/// For 4096 texels, of a square texture but on Armv6-M, the compiler knows that no index lies outside: nothing is checked. On Armv6-M all
/// other textures share a function, which takes a call more for a row, so that their loops are not in that of each surface.
#[inline(always)]
pub(crate) fn draw_texels<W, P: Steps>(
    texture: &Texture<'_>,
    is_packed: bool,
    pixels: &mut [W],
    (at, other): ([i32; 2], P),
    (step, other_step): ([i32; 2], P),
    word: impl Fn(u16, P) -> W,
) {
    if !IS_ARMV6M && !is_packed {
        return draw_unpacked(texture, pixels, (at, other), (step, other_step), word);
    }
    if is_packed
        && let Ok(texels) = <&[u16; 0x1000]>::try_from(texture.texels())
        && (IS_ARMV6M || texture.log2()[0] == 6)
    {
        let (at, step) = ((at[0] as u32, other), (step[0] as u32, other_step));
        let texel = squared::<6, _>(texture, texels);
        return draw_row(pixels, at, step, |(at, other)| word(texel(at), other));
    }
    draw_others(texture, is_packed, pixels, &(at, other), &(step, other_step), word);
}

/// The texels alone: one copy, whatever comes after them.
#[inline(always)]
pub(crate) fn draw_texels_alone<F: PixelFormat>(
    texture: &Texture<'_>,
    is_packed: bool,
    pixels: &mut [F::Word],
    at: [i32; 2],
    step: [i32; 2],
) {
    draw_texels(texture, is_packed, pixels, (at, ()), (step, ()), |texel, ()| F::rgb565(texel));
}

/// As [`draw_texels`], of textures of any size. Out of line on Armv6-M, where texels are drawn before anything `other`: one copy does.
#[cfg_attr(all(target_arch = "arm", not(target_has_atomic = "32")), inline(never))]
#[cfg_attr(not(all(target_arch = "arm", not(target_has_atomic = "32"))), inline(always))]
fn draw_others<W, P: Steps>(
    texture: &Texture<'_>,
    is_packed: bool,
    pixels: &mut [W],
    &(at, other): &([i32; 2], P),
    &(step, other_step): &([i32; 2], P),
    word: impl Fn(u16, P) -> W,
) {
    if !is_packed {
        return draw_unpacked(texture, pixels, (at, other), (step, other_step), word);
    }
    let (at, step) = ((at[0] as u32, other), (step[0] as u32, other_step));
    let texels = texture.texels();
    if let Ok(texels) = <&[u16; 0x400]>::try_from(texels)
        && (IS_ARMV6M || texture.log2()[0] == 5)
    {
        let texel = squared::<5, _>(texture, texels);
        return draw_row(pixels, at, step, |(at, other)| word(texel(at), other));
    }
    draw_row(pixels, at, step, |(at, other)| word(texture.fetch_packed(at), other));
}

#[inline(always)]
fn draw_unpacked<W, P: Steps>(
    texture: &Texture<'_>,
    pixels: &mut [W],
    at: ([i32; 2], P),
    step: ([i32; 2], P),
    word: impl Fn(u16, P) -> W,
) {
    draw_row(pixels, at, step, |([u, v], other)| word(texture.fetch_repeat(u >> 16, v >> 16), other));
}

/// As [`sized`], of a square texture of sides of 2^`A` texels: so that mask and multiplier are constants. On a Cortex-M4 these are part of
/// instructions: 24.5 cycles a pixel with light instead of 27.5, and 10 cycles a chord less. On a Cortex-M0+ they would have to be loaded as well: there it is
/// `sized`, for any texture of so many texels.
#[inline(always)]
pub(super) fn squared<'a, const A: u32, const COUNT: usize>(
    texture: &Texture<'_>,
    texels: &'a [u16; COUNT],
) -> impl Fn(u32) -> u16 + use<'a, A, COUNT> {
    let [mask, multiplier] = if IS_ARMV6M {
        texture.mask_and_multiplier()
    } else {
        [0x1_0001 * (0xffff & !0 << (16 - A)), 1 + (1 << (16 - A))]
    };
    move |packed| texels[((packed & mask).wrapping_mul(multiplier) >> (32 - COUNT.trailing_zeros())) as usize]
}
