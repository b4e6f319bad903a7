//! The colour of a vertex during one draw: its own or a material's, times the light that arrives there.
//!
//! - In: a vertex, or the corners of a face.
//! - Out: the vertex's colour, or the light on the face; in U8F8 per channel, 0 … 255.
//! - Assumes: lights were brought to mesh space.
//!
//! Light is computed per vertex (smooth shading) or per triangle (flat shading). With flat shading a vertex's colour comes out
//! unlit. The caller multiplies it by the light on the face, anew for each face that the vertex belongs to.

use crate::math::Pose;
use crate::num::U8F8;
use crate::scene::{Lighting, Lights, Vertex};

/// The functions that compute light, by reference: the linker drops lighting from programs that do not name it.
#[derive(Debug)]
pub(super) struct LightCode {
    bring: for<'l, 'p> fn(&Lights<'l>, &'p Pose, &mut Lighting<'p>) -> bool,
    shading: Shading,
}

/// Per vertex (smooth) or per face (flat).
#[derive(Debug)]
enum Shading {
    Smooth(fn(&Light<'_>, &[u8; 3], &Vertex, &mut [U8F8; 3])),
    Faceted(fn(&Light<'_>, [&Vertex; 3]) -> [U8F8; 3]),
}

/// Light per vertex.
pub(super) const SMOOTH: &LightCode = &LightCode { bring, shading: Shading::Smooth(at_vertex) };
/// Light per face.
pub(super) const FACETED: &LightCode = &LightCode { bring, shading: Shading::Faceted(at_face) };

/// The colours of a mesh's vertices during one draw.
#[derive(Debug, Default)]
pub(crate) struct VertexColors<'p> {
    base: Option<[u8; 3]>,
    light: Option<Light<'p>>,
}

/// Light as it falls on one mesh.
#[derive(Debug)]
// In this order, for short instructions, as `Lighting`.
#[repr(C)]
pub(super) struct Light<'p> {
    shading: &'static Shading,
    lighting: Lighting<'p>,
    /// Whether light from behind counts as if it came from in front.
    two_sided: bool,
    is_gray: bool,
}

/// Brings lights to a mesh in this pose, and says whether they are grey.
fn bring<'p>(lights: &Lights<'_>, pose: &'p Pose, to: &mut Lighting<'p>) -> bool {
    lights.bring(pose, to)
}

/// A colour times the light at its vertex. (White is the light itself.)
fn at_vertex(light: &Light<'_>, color: &[u8; 3], vertex: &Vertex, to: &mut [U8F8; 3]) {
    light.lighting.at_vertex(vertex, [light.two_sided, light.is_gray], to);
    if color[0] & color[1] & color[2] != 255 {
        for i in 0..3 {
            to[i] = over_255(u32::from(color[i]) * u32::from(to[i].to_bits()));
        }
    }
}

/// The light on a face.
fn at_face(light: &Light<'_>, corners: [&Vertex; 3]) -> [U8F8; 3] {
    light.lighting.at_face(corners.map(|vertex| vertex.position), light.two_sided)
}

impl<'p> VertexColors<'p> {
    /// `base`, or the vertices' own colour if that is `None`.
    pub(super) fn unlit(base: Option<[u8; 3]>) -> Self {
        Self { base, light: None }
    }

    /// Adds the light on a mesh in this pose. In place, so that nothing is copied.
    pub(super) fn light(
        &mut self,
        code: &'static LightCode,
        lights: &Lights<'_>,
        pose: &'p Pose,
        two_sided: bool,
    ) {
        let light = self.light.insert(Light {
            lighting: lights.ambient_alone(),
            shading: &code.shading,
            two_sided,
            is_gray: false,
        });
        light.is_gray = (code.bring)(lights, pose, &mut light.lighting);
    }

    /// Whether all of them are grey, if those of the mesh's vertices are, or are not.
    #[inline(never)]
    pub(crate) fn are_gray(&self, is_mesh_gray: bool) -> bool {
        self.base.map_or(is_mesh_gray, is_gray) && self.light.as_ref().is_none_or(|light| light.is_gray)
    }

    /// A vertex's colour; with flat shading without light, which is still to come [from its face](VertexColors::on_face).
    #[inline]
    pub(crate) fn of_vertex(&self, vertex: &Vertex, to: &mut [U8F8; 3]) {
        let color = self.base.as_ref().unwrap_or(&vertex.color);
        match &self.light {
            Some(light @ Light { shading: Shading::Smooth(at_vertex), .. }) => {
                at_vertex(light, color, vertex, to);
            }
            _ => *to = color.map(U8F8::from_num),
        }
    }

    /// Whether shading is flat: colours are still to be multiplied by the light [on their face](VertexColors::on_face).
    #[inline]
    pub(crate) fn is_faceted(&self) -> bool {
        matches!(self.light, Some(Light { shading: Shading::Faceted(_), .. }))
    }

    /// The light on a triangle with flat shading, which its colours are to be [multiplied](dim) by; else `None`.
    pub(crate) fn on_face(&self, corners: [&Vertex; 3]) -> Option<[U8F8; 3]> {
        match &self.light {
            Some(light @ Light { shading: Shading::Faceted(at_face), .. }) => Some(at_face(light, corners)),
            _ => None,
        }
    }
}

/// Whether a colour's channels are the same.
#[inline]
pub(crate) fn is_gray<T: PartialEq>([red, green, blue]: [T; 3]) -> bool {
    red == green && green == blue
}

/// Multiplies a colour by light, of which 255 is full.
#[inline(never)]
pub(crate) fn dim(color: &mut [U8F8; 3], light: [U8F8; 3]) {
    for (channel, light) in color.iter_mut().zip(light) {
        *channel = over_255((u32::from(channel.to_bits()) * u32::from(light.to_bits())) >> 8);
    }
}

/// `product` / 255, both with 8 fraction bits, off by less than 1/256. Exact if one factor is 255 and the other at most that.
#[inline]
fn over_255(product: u32) -> U8F8 {
    // 257/2¹⁶ = (1 − 2⁻¹⁶)/255, so the quotient is a little low: it is rounded up. The largest product, 255 · 255.0, just fits.
    U8F8::from_bits(((product * 257 + 0xffff) >> 16) as u16)
}
