//! Scaling: where the scale of texture coordinates is applied, before planes are made of them or at the end.
//!
//! - In: what the shader wants, and how much of the scale there is room for before.
//! - Out: values at the corners for planes, what is left of the scale, and how they are packed then.
//! - Assumes: nothing. What is beyond ±32768 wraps, as it would if it were scaled at the end.

use super::packing::Packing;
use crate::geometry::ScreenVertex;

/// How u and v of one triangle are scaled. A scale multiplies by 2^0 … 2^8.
#[derive(Default)]
pub(crate) struct Scaling {
    /// Log₂ of what u and v are multiplied by before planes are made of them.
    finer: [u8; 2],
    /// Log₂ of the rest.
    rest: [u8; 2],
    /// How they are packed, before they are multiplied by the rest.
    packings: [Packing; 2],
}

impl Scaling {
    #[inline]
    pub(super) fn new(finer: [u8; 2], rest: [u8; 2], unscaled: &Packing) -> Self {
        Self { finer, rest, packings: finer.map(|finer| unscaled.finer(finer.into())) }
    }

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
