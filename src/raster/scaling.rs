//! Scaling: where the scale of texture coordinates is applied, before planes are made of them or at the end.
//!
//! - In: what the shader wants, and how much of the scale there is room for before.
//! - Out: values at the corners for planes, what is left of the scale, and how they are packed then.
//! - Assumes: nothing. What is beyond ±32768 wraps, as it would if it were scaled at the end.

use super::packing::Packing;
use super::triangle::Needs;
use crate::geometry::ScreenVertex;

/// How u and v of one triangle are scaled. A scale multiplies by 2^0 … 2^8.
pub(crate) struct Scaling {
    /// Log₂ of what u and v are multiplied by before planes are made of them.
    finer: [u8; 2],
    /// Log₂ of the rest.
    rest: [u8; 2],
    /// How they are packed, before they are multiplied by the rest.
    packings: [Packing; 2],
}

impl Needs {
    /// All of the scale at the end, or for a scale of 1.
    #[inline]
    pub(super) fn scaled_at_the_end(&self) -> Scaling {
        self.scaled([0; 2])
    }

    /// All of it before planes are made.
    #[inline]
    pub(super) fn scaled_at_once(&self) -> Scaling {
        self.scaled([self.scale as u8; 2])
    }

    /// As much before planes are made as there is room for: their rounding is multiplied by the rest.
    #[cold]
    #[inline(never)]
    pub(super) fn scaled_for(&self, vertices: &[&ScreenVertex; 3]) -> Scaling {
        let [a, b, c] = vertices.map(|vertex| [vertex.u, vertex.v].map(|uv| uv.to_bits()));
        self.scaled([0, 1].map(|i| {
            let size =
                (b[i] - a[i]).unsigned_abs() | (c[i] - a[i]).unsigned_abs() | (c[i] - b[i]).unsigned_abs();
            // Differences stay below 2²⁹.
            size.leading_zeros().saturating_sub(3).min(self.scale) as u8
        }))
    }

    #[inline(never)]
    fn scaled(&self, finer: [u8; 2]) -> Scaling {
        let rest = finer.map(|finer| self.scale as u8 - finer);
        Scaling { finer, rest, packings: [0, 1].map(|i| self.unscaled_packing.finer(finer[i].into())) }
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
        (first..end).all(|i| {
            let at = match i {
                0 | 1 => scaling.uv(vertices, i),
                _ => vertices.map(|vertex| i32::from(vertex.color[i - 2].to_bits()) << 8),
            };
            set(i - first, at, if i < 2 { scaling.rest(i) } else { 0 })
        })
    }
}

impl Scaling {
    /// u or v at the corners, as planes have it.
    #[inline]
    pub(super) fn uv(&self, vertices: &[&ScreenVertex; 3], i: usize) -> [i32; 3] {
        let finer = u32::from(self.finer[i & 1]) & 31;
        vertices.map(|vertex| (if i == 0 { vertex.u } else { vertex.v }).to_bits() << finer)
    }

    /// Log₂ of what is left of the scale, of u or v.
    #[inline]
    pub(super) fn rest(&self, i: usize) -> u32 {
        self.rest[i & 1].into()
    }

    /// How u or v is packed.
    #[inline]
    pub(super) fn packing(&self, i: usize) -> &Packing {
        &self.packings[i & 1]
    }
}
