//! Texture coordinates packed in one word, so that one addition steps both, and the texels at them.

use super::curve::Linear;
use super::fill::{Steps, draw_row};
use crate::raster::{ATTRIBUTES, WIDEST};
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

/// `FillRow::longest` of texels. Packed, a step is cut to 8 bits for 256 texels: after 15 it is off by 1/17 texel, and carries have
/// moved v as far as [`Packing`](crate::raster::Packing) has room for.
#[inline]
pub(crate) fn longest_of(texture: &Texture<'_>, is_packed: bool) -> usize {
    if is_packed && texture.is_large() { 16 } else { WIDEST }
}

/// Draws a row of a small triangle with texels, u and v in I16F16. `other` is whatever else a word is made of, and steps as well.
///
/// For 4096 and 1024 texels the compiler knows that no index lies outside: nothing is checked.
#[inline(always)]
pub(crate) fn draw_texels<W, P: Steps>(
    texture: &Texture<'_>,
    is_packed: bool,
    pixels: &mut [W],
    (at, other): ([i32; 2], P),
    (step, other_step): ([i32; 2], P),
    word: impl Fn(u16, P) -> W,
) {
    if !is_packed {
        return draw_row(pixels, (at, other), (step, other_step), |([u, v], other)| {
            word(texture.fetch_repeat(u >> 16, v >> 16), other)
        });
    }
    let [a, b] = texture.log2().map(|log2| log2 & 31);
    let at = (packed_from([at[0] >> a, at[1] >> b], step[0]), other);
    let step = (packed_step([shifted(step[0], a), shifted(step[1], b)]), other_step);
    if let Ok(texels) = <&[u16; 0x1000]>::try_from(texture.texels()) {
        let texel = sized(texture, texels);
        draw_row(pixels, at, step, |(at, other)| word(texel(at), other));
    } else if let Ok(texels) = <&[u16; 0x400]>::try_from(texture.texels()) {
        let texel = sized(texture, texels);
        draw_row(pixels, at, step, |(at, other)| word(texel(at), other));
    } else {
        draw_row(pixels, at, step, |(at, other)| word(texture.fetch_packed(at), other));
    }
}
