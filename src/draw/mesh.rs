//! One mesh drawn at once: from its vertices to the words in a band.
//!
//! - In: a mesh, its pose, a view and a surface.
//! - Out: words and depths in the band.
//! - Assumes: nothing: a mesh that is out of sight is left out whole.

use super::sight::Sight;
use super::triangle::Raster;
use crate::frame::{Band, DepthFormat, PixelFormat};
use crate::geometry::{Assembler, Count, Placing, VertexCache};
use crate::math::Pose;
use crate::scene::Mesh;
use crate::shade::Surface;

/// Draws a mesh in one pose before one camera, from vertex to pixel.
pub(crate) fn draw<F: PixelFormat, D: DepthFormat>(
    mesh: &Mesh<'_>,
    sight: &Sight<'_, '_, F, D>,
    pose: &Pose,
    surface: &Surface<'_, F, D>,
    band: &mut Band<'_, F, D>,
    stats: &mut impl Count,
) {
    stats.count(|stats| &mut stats.meshes);
    let (projection, camera) = (sight.camera.projection(), sight.camera.placement());
    let cull = surface.cull.of_mesh(camera.is_mirrored() != pose.is_mirrored());
    let window = band.window().within(&projection.viewport);
    let mut placing = Placing::ZERO;
    placing.set(projection, camera, pose);
    if window.is_empty() || !placing.sees(projection, mesh.bounds()) {
        stats.count(|stats| &mut stats.meshes_out_of_sight);
        return;
    }
    let mut colors = surface.coloring.unlit();
    surface.coloring.light(&mut colors, sight.lights, pose);
    let light_face = surface.coloring.light_face(sight.lights);
    let assembler = Assembler { mesh, placing: &placing, coloring: &colors, cull, light_face };
    let mut raster = Raster::new(
        (&surface.look, sight.fog.as_ref()),
        [projection.orthographic, colors.are_gray(mesh.bounds().is_gray)],
        window,
        band,
    );
    let mut cache = VertexCache::new(mesh);
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
