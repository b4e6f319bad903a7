//! One mesh drawn at once: from its vertices to the words in a band.
//!
//! - In: a mesh, its pose, a camera's projection, a shader.
//! - Out: words and depths in the band.
//! - Assumes: nothing: a mesh that is out of sight is left out whole.

use super::triangle::Raster;
use crate::frame::{Band, DepthFormat, PixelFormat};
use crate::geometry::{Assembler, Clip, Coloring, Count, ToClip, VertexCache};
use crate::math::Pose;
use crate::scene::{Mesh, Projection};
use crate::shade::Shader;

/// Draws a mesh in one pose before one camera, from vertex to pixel.
pub(crate) fn draw<F, D, S>(
    mesh: &Mesh<'_>,
    projection: &Projection,
    camera: &Pose,
    pose: &Pose,
    shader: &S,
    band: &mut Band<'_, F, D>,
    stats: &mut impl Count,
) where
    F: PixelFormat,
    D: DepthFormat,
    S: Shader<F>,
{
    stats.count(|stats| &mut stats.meshes);
    let cull = shader.cull().of_mesh(camera.is_mirrored() != pose.is_mirrored());
    let to_clip = ToClip::new(projection, camera, pose);
    let clip = Clip::new(projection, to_clip.unit_bits());
    let is_seen = clip.sees(&to_clip, mesh.bounds(), projection);
    let window = band.window().within(&projection.viewport);
    if window.is_empty() || !is_seen {
        stats.count(|stats| &mut stats.meshes_out_of_sight);
        return;
    }
    let lit;
    let coloring = if S::LIT {
        lit = coloring::<F, S>(shader, pose);
        &lit
    } else {
        &Coloring::OWN
    };
    let light_face = if S::LIT && coloring.is_faceted() { Some(Assembler::light_face as _) } else { None };
    let assembler = Assembler { mesh, to_clip: &to_clip, clip: &clip, coloring, cull, light_face };
    let mut raster = Raster::new(shader, [projection.orthographic, false], window, band);
    let mut cache = VertexCache::ZERO;
    cache.forget();
    loop {
        while let Some(triangle) = assembler.next(&mut cache, stats) {
            raster.draw_oriented(&triangle, stats);
        }
        let Some(polygon) = cache.take_folded() else {
            return;
        };
        raster.draw_folded(polygon, cull, stats);
    }
}

/// Not inlined: what it takes is not on the stack while pixels are drawn.
#[inline(never)]
fn coloring<'p, F: PixelFormat, S: Shader<F>>(shader: &S, pose: &'p Pose) -> Coloring<'p> {
    shader.coloring(pose)
}
