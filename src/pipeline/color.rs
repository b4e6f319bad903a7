//! What colour a vertex has: its own, a material's, times light.

use crate::num::U8F8;
use crate::scene::{Lighting, Vertex};
use core::array;

/// Where the colour of a mesh's vertices comes from, during one draw call. The default is the vertices' own.
#[derive(Debug, Default)]
pub struct Coloring {
    base: Option<[u8; 3]>,
    light: Option<Light>,
}

#[derive(Debug)]
struct Light {
    lighting: Lighting,
    faceted: bool,
    two_sided: bool,
}

impl Coloring {
    /// `base`, or the vertices' own colour without it, times light: once a vertex, or if `faceted` once a triangle.
    #[must_use]
    pub const fn lit(base: Option<[u8; 3]>, lighting: Lighting, faceted: bool, two_sided: bool) -> Self {
        Self { base, light: Some(Light { lighting, faceted, two_sided }) }
    }

    /// A vertex's colour, without the light of its triangle.
    #[inline(never)]
    pub(super) fn of_vertex(&self, vertex: &Vertex, to: &mut [U8F8; 3]) {
        let color = match &self.base {
            Some(base) => base,
            None => &vertex.color,
        };
        match &self.light {
            Some(light) if !light.faceted => {
                light.lighting.at_vertex(vertex, light.two_sided, to);
                if color[0] & color[1] & color[2] != 255 {
                    for i in 0..3 {
                        to[i] = over_255(u32::from(color[i]) * u32::from(to[i].to_bits()));
                    }
                }
            }
            _ => *to = color.map(U8F8::from_num),
        }
    }

    /// Whether colours are still to be multiplied by [`Coloring::on_triangle`].
    pub(super) fn is_faceted(&self) -> bool {
        matches!(self.light, Some(Light { faceted: true, .. }))
    }

    /// A vertex's colour of [`Coloring::of_vertex`] times the light of its triangle.
    #[inline(never)]
    pub(super) fn on_triangle(&self, color: [U8F8; 3], corners: [&Vertex; 3]) -> [U8F8; 3] {
        match &self.light {
            Some(light) => {
                let positions = corners.map(|vertex| vertex.position);
                times(color, light.lighting.at_face(positions, light.two_sided))
            }
            None => color,
        }
    }
}

/// Channel by channel.
fn times(color: [U8F8; 3], light: [U8F8; 3]) -> [U8F8; 3] {
    array::from_fn(|i| over_255((u32::from(color[i].to_bits()) * u32::from(light[i].to_bits())) >> 8))
}

/// `product` / 255, within 1/256; exact if one of the factors is 255 and the other at most that.
#[inline]
fn over_255(product: u32) -> U8F8 {
    // 1/255 less 2⁻¹⁶ of it; 255 · 255.0 just fits.
    U8F8::from_bits(((product * 257 + 0xffff) >> 16) as u16)
}
