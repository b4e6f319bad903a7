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

    /// Whether from one coordinate to another the texture is seen as if it repeated.
    fn is_inside(ends: [u32; 2], side: &Side) -> bool;

    /// How the texture is seen in the cell of a coordinate, and how far it is to the cell after it, or if coordinates fall, before it;
    /// beyond all if there is none.
    fn enter(at: u32, falls: bool, side: &Side) -> (Seen, u32);

    /// How many borders there are between two coordinates.
    fn borders(ends: [u32; 2], side: &Side) -> u32;
}

/// How a texture is seen in a cell along one axis.
#[derive(Clone, Copy)]
pub(crate) enum Seen {
    Same,
    Turned,
    Constant(i32),
}

impl Seen {
    /// A line as it is in the texture.
    #[inline(always)]
    pub(super) fn of(self, line: Linear) -> Linear {
        match self {
            Self::Same => line,
            Self::Turned => line.turned(),
            Self::Constant(at) => Linear { at: at as u32, slope: 0 },
        }
    }
}

/// The border texels go on.
pub(crate) enum Clamp {}

/// The texture is turned round at each border.
pub(crate) enum Mirror {}

/// One axis of a texture, in units in which coordinates have so many integer bits, with a sign.
#[derive(Clone, Copy)]
pub(crate) struct Side {
    pub(super) bits: u8,
    /// Of these bits the texture has all but so many.
    spare_bits: u8,
    /// Half a texel after the texture's beginning, and half a texel before its end.
    first: i32,
    last: i32,
}

impl Side {
    pub(super) fn new(log2: u32, own_bits: u32, bits: u32) -> Self {
        let half = 1_u32 << ((31 - bits) & 31);
        let last = (half << ((log2 + 1) & 31)).wrapping_sub(half) as i32;
        Self { bits: bits as u8, spare_bits: (bits - own_bits) as u8, first: half as i32, last }
    }

    /// By how much a coordinate is to be shifted left so that it repeats with the texture.
    #[inline(always)]
    pub(super) fn spare_bits(&self) -> u32 {
        self.spare_bits.into()
    }

    #[inline(always)]
    fn cell_log2(&self) -> u32 {
        (32 - self.spare_bits()) & 31
    }

    #[inline(always)]
    fn cell(&self, at: u32) -> i32 {
        at as i32 >> self.cell_log2()
    }
}

impl Border for Clamp {
    const IS_MIRROR: bool = false;

    #[inline]
    fn texel(texture: &Texture<'_>, u: i32, v: i32) -> u16 {
        texture.fetch_clamp(u, v)
    }

    #[inline(always)]
    fn is_inside(ends: [u32; 2], side: &Side) -> bool {
        let range = side.last.wrapping_sub(side.first) as u32;
        ends.iter().all(|at| at.wrapping_sub(side.first as u32) < range)
    }

    /// Below 0 to half a texel after the border, likewise above 0: there it is all the same texel. So what rounding makes of
    /// coordinates that are inside does not leave the texture.
    #[inline(always)]
    fn enter(at: u32, falls: bool, &Side { first, last, .. }: &Side) -> (Seen, u32) {
        let at = at as i32;
        let rise_to = |border: i32| border.wrapping_sub(at) as u32;
        // To what is below a border, which itself is above it.
        let fall_below = |border: i32| at.wrapping_sub(border) as u32 + 1;
        if at < first {
            (Seen::Constant(first), if falls { u32::MAX } else { rise_to(first) })
        } else if at >= last {
            (Seen::Constant(last), if falls { fall_below(last) } else { u32::MAX })
        } else {
            (Seen::Same, if falls { fall_below(first) } else { rise_to(last) })
        }
    }

    #[inline(always)]
    fn borders(_: [u32; 2], _: &Side) -> u32 {
        0
    }
}

impl Border for Mirror {
    const IS_MIRROR: bool = true;

    #[inline]
    fn texel(texture: &Texture<'_>, u: i32, v: i32) -> u16 {
        texture.fetch_mirror(u, v)
    }

    #[inline(always)]
    fn is_inside([from, to]: [u32; 2], side: &Side) -> bool {
        let cell = side.cell(from);
        cell == side.cell(to) && cell & 1 == 0
    }

    #[inline(always)]
    fn enter(at: u32, falls: bool, side: &Side) -> (Seen, u32) {
        let seen = if side.cell(at) & 1 == 0 { Seen::Same } else { Seen::Turned };
        let last = (1 << side.cell_log2()) - 1;
        let at = if falls { !at } else { at };
        (seen, last + 1 - (at & last))
    }

    #[inline(always)]
    fn borders(ends: [u32; 2], side: &Side) -> u32 {
        let [from, to] = ends.map(|at| side.cell(at));
        from.abs_diff(to)
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
