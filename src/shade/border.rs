//! What is seen beyond the borders of a texture that does not just repeat: it is clamped or mirrored.
//!
//! - In: a coordinate.
//! - Out: the texel, or the cell that it is in, and what it is inside the texture.
//! - Assumes: nothing.
//!
//! A texture divides the plane of u and v into cells, and in each of them it is seen as if it repeated, but for a change that is the
//! same all over the cell: a coordinate is constant, or it is turned round.

use super::curve::Linear;
use crate::raster::TriangleSetup;
use crate::scene::Texture;

/// What is seen beyond the borders of a texture.
pub(crate) trait Border: 'static {
    /// Whether each cell shows the texture turned round once more.
    const IS_MIRROR: bool;

    /// The texel at whole coordinates of any size.
    fn texel(texture: &Texture<'_>, u: i32, v: i32) -> u16;

    /// The cell of a coordinate that has the integer bits of `side`.
    fn cell(at: u32, side: &Side) -> i32;

    /// Where the cell after this one begins, or if coordinates fall, where this one does.
    fn border(cell: i32, rises: bool, side: &Side) -> i32;

    /// A coordinate as it is in the texture, of which a texel is 2^`texel_log2`.
    fn inside(line: Linear, cell: i32, side_log2: u32, texel_log2: u32) -> Linear;
}

/// The border texels go on.
pub(crate) enum Clamp {}

/// The texture is turned round at each border.
pub(crate) enum Mirror {}

/// One axis of a texture.
#[derive(Clone, Copy)]
pub(crate) struct Side {
    pub(super) log2: u32,
    /// The integer bits of coordinates, with a sign; of these the texture has `own_bits`.
    pub(super) bits: u32,
    pub(super) own_bits: u32,
    /// Half a texel after the texture's beginning, and half a texel before its end.
    first: i32,
    last: i32,
}

impl Side {
    pub(super) fn new(log2: u32, own_bits: u32, uv_bits: u32) -> Self {
        let bits = uv_bits.max(own_bits + 1);
        let half = 1_u32 << ((31 - bits) & 31);
        let last = (half << ((log2 + 1) & 31)).wrapping_sub(half) as i32;
        Self { log2, bits, own_bits, first: half as i32, last }
    }
}

impl Border for Clamp {
    const IS_MIRROR: bool = false;

    #[inline]
    fn texel(texture: &Texture<'_>, u: i32, v: i32) -> u16 {
        texture.fetch_clamp(u, v)
    }

    /// Below 0 to half a texel after the border, likewise above 0: there it is all the same texel. So what rounding makes of
    /// coordinates that are inside does not leave the texture.
    #[inline(always)]
    fn cell(at: u32, side: &Side) -> i32 {
        i32::from(at as i32 >= side.last) - i32::from((at as i32) < side.first)
    }

    #[inline(always)]
    fn border(cell: i32, rises: bool, side: &Side) -> i32 {
        if (cell < 0) | (cell == 0) & !rises { side.first } else { side.last }
    }

    #[inline(always)]
    fn inside(line: Linear, cell: i32, side_log2: u32, texel_log2: u32) -> Linear {
        let last = if cell < 0 { 0 } else { ((1 << side_log2) - 1) << texel_log2 };
        if cell == 0 { line } else { Linear { at: last + (1 << texel_log2 >> 1), slope: 0 } }
    }
}

impl Border for Mirror {
    const IS_MIRROR: bool = true;

    #[inline]
    fn texel(texture: &Texture<'_>, u: i32, v: i32) -> u16 {
        texture.fetch_mirror(u, v)
    }

    #[inline(always)]
    fn cell(at: u32, side: &Side) -> i32 {
        at as i32 >> ((32 + side.own_bits - side.bits) & 31)
    }

    #[inline(always)]
    fn border(cell: i32, rises: bool, side: &Side) -> i32 {
        cell.wrapping_add(rises.into()) << ((32 + side.own_bits - side.bits) & 31)
    }

    #[inline(always)]
    fn inside(line: Linear, cell: i32, _: u32, _: u32) -> Linear {
        if cell & 1 == 0 { line } else { line.turned() }
    }
}

/// The integer bits, with a sign, that u and v of a triangle take, and a texel more on each side; 32 if they wrap.
pub(super) fn uv_bits(setup: &TriangleSetup) -> [u32; 2] {
    let [u, v, ..] = &setup.attributes;
    [u, v].map(|attribute| match attribute.least.checked_add_unsigned(attribute.range) {
        Some(most) if attribute.scale_log2() == 0 => {
            let farthest = (most >> 16).saturating_add(1).max(1 - (attribute.least >> 16));
            33 - farthest.leading_zeros()
        }
        _ => 32,
    })
}
