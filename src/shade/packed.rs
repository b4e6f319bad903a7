//! Texture coordinates packed in one word, so that one addition steps both, and the texels at them.

use crate::raster::STRAIGHT;
use crate::scene::Texture;

/// The texel at packed coordinates of a texture of so many.
#[inline]
pub(crate) fn sized<const COUNT: usize>(texture: &Texture<'_>, texels: &[u16; COUNT]) -> impl Fn(u32) -> u16 {
    let [mask, multiplier] = texture.mask_and_multiplier();
    move |packed| texels[((packed & mask).wrapping_mul(multiplier) >> (32 - COUNT.trailing_zeros())) as usize]
}

/// `Fill::longest_row` of texels. Packed, a step is cut to 8 bits for 256 texels: after 15 it is off by 1/17 texel.
#[inline]
pub(crate) fn longest_row_of(texture: &Texture<'_>, is_packed: bool) -> i32 {
    if is_packed && texture.is_large() { 15 } else { STRAIGHT }
}

/// u (`i` = 0) or v of I16F16 times 2^`scale_log2`, without the bits for which packed coordinates have no room.
#[inline]
pub(crate) fn uv_in_units(
    texture: &Texture<'_>,
    is_packed: bool,
    i: usize,
    value: i32,
    scale_log2: u32,
) -> i32 {
    if is_packed { value >> (texture.log2()[i].wrapping_sub(scale_log2) & 31) } else { value << scale_log2 }
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
