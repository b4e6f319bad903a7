//! What colour a vertex has: its own, a material's, times light.

use crate::num::U8F8;
use crate::scene::{Lighting, Normal, Vertex};

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
    pub(super) fn of_vertex(&self, vertex: &Vertex) -> [U8F8; 3] {
        let color = self.base.unwrap_or(vertex.color).map(U8F8::from_num);
        match &self.light {
            Some(light) if !light.faceted => {
                times(color, light.lighting.at(vertex.position, Normal::from(vertex.normal), light.two_sided))
            }
            _ => color,
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

/// Channel by channel, 255 · 255 being 255; less than 1/256 too low.
fn times(color: [U8F8; 3], light: [U8F8; 3]) -> [U8F8; 3] {
    core::array::from_fn(|i| {
        let product = (u32::from(color[i].to_bits()) * u32::from(light[i].to_bits())) >> 8;
        // 1/255 = 1/256 + 1/256² + 1/256³ + …
        U8F8::from_bits(((product + (product >> 8) + (product >> 16) + 1) >> 8).min(0xffff) as u16)
    })
}
