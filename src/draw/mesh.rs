//! One mesh drawn at once: from its vertices to the words in a band.
//!
//! - In: a mesh, its pose, a view and a surface.
//! - Out: words and depths in the band.
//! - Assumes: nothing: a mesh that is out of sight is left out whole.

use super::sight::Sight;
use super::triangle::Raster;
use crate::frame::{Band, DepthFormat, PixelFormat};
use crate::geometry::{Assembler, Clipped, Count, Placing, VertexCache};
use crate::math::Pose;
use crate::scene::Mesh;
use crate::shade::Surface;
use core::hint::black_box;

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
    let mut assembler = Assembler {
        mesh,
        placing: Placing::ZERO,
        coloring: surface.coloring.unlit(),
        cull: surface.cull,
        light_face: surface.coloring.light_face(sight.lights),
    };
    let is_seen = assembler.stand(projection, camera, pose);
    let window = band.window().within(&projection.viewport);
    if window.is_empty() || !is_seen {
        stats.count(|stats| &mut stats.meshes_out_of_sight);
        return;
    }
    surface.coloring.light(&mut assembler.coloring, sight.lights, pose);
    let mut raster = Raster::new(
        (&surface.look, sight.fog),
        [projection.orthographic, assembler.coloring.are_gray(mesh.bounds().is_gray)],
        window,
        band,
    );
    let mut cache = VertexCache::new(mesh);
    cache.forget();
    let mut runs = None;
    loop {
        while let Some(triangle) = assembler.next(&mut cache, stats) {
            let is_drawn = raster.draw_oriented(&triangle);
            if runs.is_none() {
                stats.count(|stats| if is_drawn { &mut stats.drawn } else { &mut stats.out_of_sight });
            }
        }
        // What is rare is reached through hidden references, whose addresses are not kept on the stack in the meantime.
        match black_box(&cache).clipped {
            Clipped::None => return,
            Clipped::Uncut => assembler.cut(&mut cache, stats),
            Clipped::Pieces(_) => assembler.find_piece(&mut cache, stats),
            Clipped::Folded(_) => raster.find_run(&mut cache, black_box(&assembler).cull, &mut runs, stats),
        }
    }
}
