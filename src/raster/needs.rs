//! Needs: what a shader wants of a triangle, and the code that sets its inputs up.
//!
//! - In: the traits of a shader.
//! - Out: numbers that set-up reads, and functions that it calls.
//! - Assumes: nothing.
//!
//! Set-up calls what belongs to texture coordinates and to colours through [`InputCode`]. There is one of these for each set of inputs
//! (see [`inputs`](super::inputs)), which a shader's type names. So a program links what its shaders read.

use super::gradients::Gradients;
use super::packing::Packing;
use super::scaling::Scaling;
use super::straight::Straight;
use super::triangle::TriangleSetup;
use crate::geometry::{Inputs, ScreenVertex};
use crate::num::zeros_of;
use core::fmt;
use core::hint::black_box;

/// The functions that set up what a shader reads.
pub(crate) struct InputCode {
    pub(crate) inputs: Inputs,
    /// All planes of a small triangle, twice its area given. False, and they are of no use, if the general way has to.
    pub(super) small: fn(&mut TriangleSetup, &[&ScreenVertex; 3], u32, &Needs) -> bool,
    /// All planes of any triangle.
    pub(super) any: fn(&mut TriangleSetup, &[&ScreenVertex; 3], u32, &Needs),
    pub(super) uv: Option<UvCode>,
    /// Whether all colours of a triangle are grey, if they are read.
    pub(super) are_gray: Option<fn(&[&ScreenVertex; 3]) -> bool>,
    /// Colours of a small triangle, as plain. Returns as `small` does.
    pub(super) small_color: Option<fn(&mut TriangleSetup, &SmallTriangle<'_>, ColorBend) -> bool>,
}

/// Those for texture coordinates.
pub(super) struct UvCode {
    /// Of a small triangle, as plain. Returns as [`InputCode::small`] does.
    pub(super) small: fn(&mut TriangleSetup, &SmallTriangle<'_>) -> bool,
    /// Lets them follow perspective, if that takes more. Likewise.
    pub(super) bend: fn(&mut TriangleSetup, &SmallTriangle<'_>) -> bool,
    /// Completes those that are held and linear; exactly so, or nearly.
    pub(super) complete_held: fn(&mut TriangleSetup, &SmallTriangle<'_>, &Scaling, bool),
    /// Completes those of any triangle whose attributes are linear; with the fraction bits of slopes if they are exactly so.
    pub(super) complete: fn(&mut TriangleSetup, &[&ScreenVertex; 3], &Scaling, Option<i32>),
    /// How they are packed: with sides of 2^this texels, if they are.
    pub(super) pack: fn(&mut Needs, Option<[u8; 2]>),
    /// Where their scale is applied.
    pub(super) scale: fn(&Needs, &[&ScreenVertex; 3], &mut Scaling),
}

impl PartialEq for InputCode {
    fn eq(&self, other: &Self) -> bool {
        self.inputs == other.inputs
    }
}

impl Eq for InputCode {}

impl fmt::Debug for InputCode {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.inputs.fmt(f)
    }
}

/// A small triangle, on the way through its set-up.
pub(crate) struct SmallTriangle<'a> {
    pub(super) vertices: &'a [&'a ScreenVertex; 3],
    pub(super) needs: &'a Needs,
    pub(super) gradients: Gradients,
    pub(super) q: [u32; 3],
}

/// Which ranges of colours are too large for straight lines: those with range · `fall` > `most`.
#[derive(Clone, Copy)]
pub(crate) struct ColorBend {
    fall: u32,
    most: u32,
}

/// What a shader wants of a triangle.
pub(crate) struct Needs {
    pub(crate) code: &'static InputCode,
    pub(crate) straight: Straight,
    /// Whether perspective is exact at every pixel.
    pub(crate) every_pixel: bool,
    /// u and v are multiplied by 2^this, 0 … 8.
    pub(crate) scale: u8,
    /// How u and v are packed, before they are scaled.
    pub(crate) unscaled_packing: Packing,
    /// How they are packed with all of the scale, as small triangles have it.
    pub(crate) packing: Packing,
    /// How far u and v of small triangles keep from the ends of their range, 1/256 texel.
    pub(crate) margins: [u8; 2],
    /// How much a colour may be off by, in levels of 1/255: a step of the format's finest channel.
    pub(crate) color_step: u8,
    /// Whether depth is tested.
    pub(crate) depth: bool,
    /// Whether all colours are known to be grey.
    pub(crate) gray: bool,
    /// Whether the rows of a small triangle that lie below the window are found as well: in the next one they are [kept](super::kept).
    pub(crate) rows_below: bool,
}

const _: () = assert!(size_of::<Needs>() <= 24 + size_of::<usize>());

impl Needs {
    /// Whether attributes are exactly linear on the screen where a triangle's corners have these least and greatest q.
    #[inline]
    pub(crate) fn is_exactly_straight(&self, least: u32, most: u32) -> bool {
        least == most || matches!(self.straight, Straight::Always)
    }

    /// Sets how u and v are packed, if they are read: with sides of 2^this texels, or `None`. Needs have no packing before.
    #[inline]
    pub(crate) fn pack(&mut self, log2: Option<[u8; 2]>) {
        if let Some(uv) = &self.code.uv {
            (uv.pack)(self, log2);
        }
    }

    /// [`UvCode::pack`].
    #[inline(never)]
    pub(super) fn pack_uv(&mut self, log2: Option<[u8; 2]>) {
        let log2 = log2.map(|log2| log2.map(u32::from));
        self.unscaled_packing = Packing::new(log2, self.scale.into(), Inputs::Uv);
        self.packing = self.unscaled_packing.finer(self.scale.into());
        self.margins = self.packing.margins();
    }

    /// Whether u and v are read.
    #[inline]
    pub(crate) fn reads_uv(&self) -> bool {
        matches!(self.code.inputs, Inputs::Uv | Inputs::UvColor)
    }

    /// Finds out whether all colours are grey, if they are read and that is not known.
    #[inline]
    pub(super) fn set_gray(&self, setup: &mut TriangleSetup, vertices: &[&ScreenVertex; 3]) {
        if let Some(are_gray) = self.code.are_gray {
            setup.gray = self.gray || are_gray(vertices);
        }
    }

    /// Whether the colour is read.
    #[inline]
    pub(crate) fn reads_color(&self) -> bool {
        matches!(self.code.inputs, Inputs::Color | Inputs::UvColor)
    }

    /// u or v of a vertex, I16F16, with all of the scale. What is beyond ±32768 wraps.
    #[inline(always)]
    pub(super) fn scaled_uv(&self, vertex: &ScreenVertex, i: usize) -> i32 {
        (if i == 0 { vertex.u } else { vertex.v }).to_bits() << (self.scale & 31)
    }

    /// Whether texture coordinates vary by so little that with all of the scale they stay below 2²⁷.
    #[cold]
    #[inline(never)]
    pub(super) fn are_narrow(&self, vertices: &[&ScreenVertex; 3]) -> bool {
        let size = size_of_uv(vertices, 0) | size_of_uv(vertices, 1);
        size >> (27 - self.scale) == 0
    }

    /// All of the scale at the end, or for a scale of 1.
    #[inline]
    pub(super) fn scaled_at_the_end(&self) -> Scaling {
        self.scaled([0; 2])
    }

    /// All of it before planes are made.
    #[inline]
    pub(super) fn scaled_at_once(&self) -> Scaling {
        self.scaled([self.scale; 2])
    }

    /// As much before planes are made as there is room for: their rounding is multiplied by the rest.
    #[cold]
    #[inline(never)]
    pub(super) fn scale_for(&self, vertices: &[&ScreenVertex; 3], scaling: &mut Scaling) {
        // Differences stay below 2²⁹.
        let fitting = |size: u32| zeros_of(size).saturating_sub(3).min(self.scale.into()) as u8;
        let finer = [fitting(size_of_uv(vertices, 0)), fitting(size_of_uv(vertices, 1))];
        self.set_scaled(finer, scaling);
    }

    #[inline]
    fn scaled(&self, finer: [u8; 2]) -> Scaling {
        let mut scaling = Scaling::default();
        self.set_scaled(finer, &mut scaling);
        scaling
    }

    /// In place, so that nothing is copied.
    #[inline(never)]
    fn set_scaled(&self, finer: [u8; 2], to: &mut Scaling) {
        *to = Scaling::new(finer, finer.map(|finer| self.scale - finer), &self.unscaled_packing);
    }

    /// Hands on the attributes in use, with the corners' values in I16F16 and what is left of the scale, as log₂, until one returns
    /// false: u and v, then colours, of which there is one in a grey triangle. Values may have wrapped; differences of them have not.
    #[inline]
    pub(super) fn each_attribute(
        &self,
        scaling: &Scaling,
        vertices: &[&ScreenVertex; 3],
        gray: bool,
        mut set: impl FnMut(usize, [i32; 3], u32) -> bool,
    ) -> bool {
        let first = if self.reads_uv() { 0 } else { 2 };
        let end = if !self.reads_color() {
            2
        } else if gray {
            3
        } else {
            5
        };
        let mut i = first;
        while i < end {
            if !set(i - first, values(scaling, vertices, i), if i < 2 { scaling.rest(i) } else { 0 }) {
                return false;
            }
            // Hidden, so that the loop is not unrolled.
            i = black_box(i) + 1;
        }
        true
    }
}

/// The bits that are in any difference of u or of v between corners.
#[cold]
#[inline(never)]
fn size_of_uv(vertices: &[&ScreenVertex; 3], i: usize) -> u32 {
    let [a, b, c] = vertices.map(|vertex| (if i == 0 { vertex.u } else { vertex.v }).to_bits());
    a.abs_diff(b) | a.abs_diff(c) | b.abs_diff(c)
}

/// Input `i` at the corners, I16F16: u, v or a channel.
#[cfg_attr(all(target_arch = "arm", not(target_has_atomic = "32")), inline(never))]
#[cfg_attr(not(all(target_arch = "arm", not(target_has_atomic = "32"))), inline)]
fn values(scaling: &Scaling, vertices: &[&ScreenVertex; 3], i: usize) -> [i32; 3] {
    match i {
        0 | 1 => scaling.uv(vertices, i),
        _ => vertices
            .map(|vertex| vertex.color.get(i - 2).map_or(0, |channel| i32::from(channel.to_bits()) << 8)),
    }
}

impl ColorBend {
    /// None.
    pub(super) const NONE: Self = Self { fall: 0, most: 0 };

    /// Whether it is not none.
    pub(super) fn is_needed(self) -> bool {
        self.fall != 0
    }

    /// Linear interpolation is off by ¼ · range · fall / least at most (see [`straight`](super::straight)). That has to be
    /// at most one `step`, in whole levels of 1/255, 1 … 8. `fall` is that of q, below 2²⁷, and ranges are below 2¹⁶ units of
    /// 1/256 level.
    pub(super) fn new(fall: u32, least: u32, step: u32) -> Self {
        Self { fall: (fall >> 16) + 1, most: (step << 10) * (least >> 16) }
    }

    #[inline]
    pub(super) fn is_too_large(self, range: i32) -> bool {
        range as u32 * self.fall > self.most
    }
}
