//! What geometry passes to the rasterizer: a vertex on the screen, and the ranges of its numbers.
//!
//! - In: a position that was projected, with what the mesh says of the vertex.
//! - Out: a `ScreenVertex`, and which of its attributes a shader reads.
//! - Assumes: nothing; `in_range` checks vertices that come from the user.
//!
//! The *q* of a vertex is near/w, w being its distance along the line of sight: 1 at the near plane, less beyond it. So
//! greater q is nearer. Without perspective q is (far − w)/(far − near): 1 at the near plane too, and 0 at the far one. q
//! serves as depth and for perspective-correct interpolation.
//!
//! The *guard band* is the area around the screen in which positions have to lie. Triangles that reach out of it are clipped.

use super::vertex_colors::VertexColors;
use crate::num::{I12F4, I16F16, U1F31, U8F8};
use crate::scene::Vertex;
use core::fmt;
use core::mem;
use core::ops::RangeInclusive;

/// A vertex on the screen. q is linear on the screen. u, v and colour are linear in space: interpolation has to correct for
/// perspective.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ScreenVertex {
    /// Pixels from the left edge, −1023½ … 1023½; pixel centres are at +½.
    pub x: I12F4,
    /// Pixels from the top edge, down, −1023½ … 1023½.
    pub y: I12F4,
    /// near/w: 1 at the near plane, less beyond it, so greater is nearer. 0 counts as 2⁻³¹, 1 and more as 1 − 2⁻³¹.
    pub q: U1F31,
    /// Texture coordinate to the right, in texels, −8192 … 8192.
    pub u: I16F16,
    /// Texture coordinate downwards, in texels, −8192 … 8192.
    pub v: I16F16,
    /// Red, green and blue, 0 … 255.
    pub color: [U8F8; 3],
}

const _: () = assert!(size_of::<ScreenVertex>() == 24);

/// The guard band of [`ScreenVertex`] positions, ±1023½ px, in 1/16 px: its width and height of 2047 px are the most with which
/// every edge function fits an `i32`. (No difference of two positions exceeds 32 752, so |a·b − c·d| ≤ 2·32752² = 2 145 387 008
/// < 2³¹.)
pub(super) const GUARD_BAND: RangeInclusive<i32> = -GUARD..=GUARD;
pub(super) const GUARD: i32 = 1023 * 16 + 8;

/// The largest texture coordinate, I16F16.
const MAX_TEXELS: i32 = 8192 << 16;

impl ScreenVertex {
    /// [`Default::default`] as a constant.
    pub(crate) const ZERO: Self = Self {
        x: I12F4::ZERO,
        y: I12F4::ZERO,
        q: U1F31::ZERO,
        u: I16F16::ZERO,
        v: I16F16::ZERO,
        color: [U8F8::ZERO; 3],
    };

    /// Whether position and texture coordinates are in range. (q and colour are by their types.)
    pub(crate) fn in_range(&self) -> bool {
        [self.x, self.y].iter().all(|at| GUARD_BAND.contains(&i32::from(at.to_bits())))
            && [self.u, self.v].iter().all(|t| (-MAX_TEXELS..=MAX_TEXELS).contains(&t.to_bits()))
    }

    /// Sets all but position and q: u and v from a vertex of a mesh, and the colour that it gets.
    #[inline]
    pub(crate) fn set_attributes(&mut self, vertex: &Vertex, coloring: &VertexColors<'_>) {
        [self.u, self.v] = vertex.uv.map(I16F16::from);
        coloring.of_vertex(vertex, &mut self.color);
    }

    /// Swaps two vertices. A function of its own, so that the compiler knows that they are two, and swaps them by words; number by number,
    /// so that none is on the stack.
    #[inline(never)]
    pub(super) fn exchange(&mut self, other: &mut Self) {
        mem::swap(&mut self.x, &mut other.x);
        mem::swap(&mut self.y, &mut other.y);
        mem::swap(&mut self.q, &mut other.q);
        mem::swap(&mut self.u, &mut other.u);
        mem::swap(&mut self.v, &mut other.v);
        mem::swap(&mut self.color, &mut other.color);
    }
}

/// Sets the attributes of a triangle's corners, before it is cut.
#[cold]
pub(crate) fn set_attributes(corners: [&Vertex; 3], coloring: &VertexColors<'_>, to: &mut [ScreenVertex]) {
    for (vertex, to) in corners.into_iter().zip(to) {
        set_attributes_of(vertex, coloring, to);
    }
}

/// Not inlined, as loops of three are unrolled.
#[inline(never)]
fn set_attributes_of(vertex: &Vertex, coloring: &VertexColors<'_>, to: &mut ScreenVertex) {
    to.set_attributes(vertex, coloring);
}

/// Which attributes of the vertices a shader reads.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Inputs {
    /// None.
    None,
    /// u and v.
    Uv,
    /// Red, green and blue.
    Color,
    /// u, v, red, green and blue.
    UvColor,
}

/// A vertex lies outside the guard band of ±1023½ px, or its texture coordinates are out of range.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RangeError;

impl fmt::Display for RangeError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "a screen vertex lies outside -1023.5 to 1023.5 px or its texture coordinates outside ±8192 texels"
        )
    }
}

impl core::error::Error for RangeError {}
