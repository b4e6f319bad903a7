//! What colour a vertex has: its own, a material's, times light.

use crate::num::U8F8;
use crate::scene::{Lighting, Vertex};

/// Where the colour of a mesh's vertices comes from, during one draw call. The default is the vertices' own.
#[derive(Debug, Default)]
pub struct Coloring<'p> {
    base: Option<[u8; 3]>,
    light: Option<Light<'p>>,
}

#[derive(Debug)]
struct Light<'p> {
    lighting: Lighting<'p>,
    shading: Shading,
    two_sided: bool,
}

/// Where light is computed, and what computes it: a pointer, so that a program that lights nothing does without.
#[derive(Debug)]
enum Shading {
    Smooth(fn(&Light<'_>, &[u8; 3], &Vertex, &mut [U8F8; 3])),
    Faceted(fn(&Light<'_>, [&Vertex; 3]) -> [U8F8; 3]),
}

/// A colour times the light at its vertex.
fn at_vertex(light: &Light<'_>, color: &[u8; 3], vertex: &Vertex, to: &mut [U8F8; 3]) {
    light.lighting.at_vertex(vertex, light.two_sided, to);
    if color[0] & color[1] & color[2] != 255 {
        for i in 0..3 {
            to[i] = over_255(u32::from(color[i]) * u32::from(to[i].to_bits()));
        }
    }
}

fn at_face(light: &Light<'_>, corners: [&Vertex; 3]) -> [U8F8; 3] {
    light.lighting.at_face(corners.map(|vertex| vertex.position), light.two_sided)
}

impl<'p> Coloring<'p> {
    /// The vertices' own.
    pub(super) const OWN: Self = Self { base: None, light: None };

    /// `base`, or the vertices' own colour without it, times light: once a vertex, or if `faceted` once a triangle.
    #[must_use]
    pub const fn lit(base: Option<[u8; 3]>, lighting: Lighting<'p>, faceted: bool, two_sided: bool) -> Self {
        let shading = if faceted { Shading::Faceted(at_face) } else { Shading::Smooth(at_vertex) };
        Self { base, light: Some(Light { lighting, shading, two_sided }) }
    }

    /// A vertex's colour, without the light of its triangle.
    #[inline]
    pub(super) fn of_vertex(&self, vertex: &Vertex, to: &mut [U8F8; 3]) {
        let color = self.base.as_ref().unwrap_or(&vertex.color);
        match &self.light {
            Some(light @ Light { shading: Shading::Smooth(at_vertex), .. }) => {
                at_vertex(light, color, vertex, to);
            }
            _ => *to = color.map(U8F8::from_num),
        }
    }

    /// Whether colours are still to be multiplied by the light [on their face](Coloring::on_face).
    #[inline]
    pub(super) fn is_faceted(&self) -> bool {
        matches!(self.light, Some(Light { shading: Shading::Faceted(_), .. }))
    }

    /// The light on a triangle, if colours are to be [dimmed](dim) by it.
    pub(super) fn on_face(&self, corners: [&Vertex; 3]) -> Option<[U8F8; 3]> {
        match &self.light {
            Some(light @ Light { shading: Shading::Faceted(at_face), .. }) => Some(at_face(light, corners)),
            _ => None,
        }
    }
}

/// Whether a colour's channels are the same.
#[inline]
pub(super) fn is_gray<T: PartialEq>([red, green, blue]: [T; 3]) -> bool {
    red == green && green == blue
}

/// Multiplies a colour by light.
#[inline(never)]
pub(super) fn dim(color: &mut [U8F8; 3], light: [U8F8; 3]) {
    for (channel, light) in color.iter_mut().zip(light) {
        *channel = over_255((u32::from(channel.to_bits()) * u32::from(light.to_bits())) >> 8);
    }
}

/// `product` / 255, within 1/256; exact if one of the factors is 255 and the other at most that.
#[inline]
fn over_255(product: u32) -> U8F8 {
    // 1/255 less 2⁻¹⁶ of it; 255 · 255.0 just fits.
    U8F8::from_bits(((product * 257 + 0xffff) >> 16) as u16)
}
