//! Draws what was baked, with fixel itself: to look at it, and to count what a frame takes.

use crate::baked::{Baked, BakedMaterial, Paint};
use fixel::embedded_graphics::pixelcolor::{Rgb565, Rgb888};
use fixel::embedded_graphics::prelude::*;
use fixel::num::U10F22;
use fixel::{
    Band, Camera, Depth16, Gradient, Light, Lights, Mask, Material, Mesh, Pose, Stats, Surface, Texture,
    Turn, Vec3, View,
};
use image::RgbImage;

/// What was counted of one frame.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Frame {
    /// For each mesh what became of it.
    pub stats: Vec<Stats>,
    /// For each mesh how many pixels its triangles covered when they were drawn, hidden later or not.
    pub pixels: Vec<usize>,
    /// How many pixels the model covers.
    pub covered: usize,
}

type Screen<'b> = Band<'b, Rgb565, Depth16>;

/// Where the model stands before the camera: turned about the vertical axis, then tilted.
fn pose(baked: &Baked, yaw: f64, pitch: f64) -> Option<(Pose, f64)> {
    let bounds = baked.report.bounds;
    let fit = &baked.fit;
    let middle = [0, 1, 2].map(|i| f64::midpoint(bounds[0][i], bounds[1][i]));
    let far = |point: [f64; 3]| (0..3).map(|i| (point[i] - middle[i]).powi(2)).sum::<f64>().sqrt();
    let vertices = baked.meshes.iter().flat_map(|mesh| &mesh.vertices);
    let radius =
        vertices.map(|vertex| far(fit.model(vertex.position.map(|at| at.to_bits())))).fold(0.0, f64::max);
    if radius <= 0.0 {
        return None;
    }
    // One unit of the world is the model's radius.
    let scale = fit.scale / fit.unit / radius;
    let turned = Pose::IDENTITY
        .scaled(U10F22::saturating_from_num(scale))
        .rotated_y(Turn::from_degrees(yaw.round() as i32))
        .rotated_x(Turn::from_degrees(pitch.round() as i32));
    let center = [0, 1, 2].map(|i| ((middle[i] - fit.origin[i]) * fit.unit / fit.scale) as f32);
    let moved = turned.transform_point(Vec3::lit(center[0], center[1], center[2]));
    Some((turned.at(-moved), scale))
}

/// Draws the model, seen whole, turned by `yaw` degrees and from `pitch` degrees above, into a picture, and counts what that takes.
#[must_use]
pub fn draw(baked: &Baked, size: u32, [yaw, pitch]: [f64; 2]) -> (RgbImage, Frame) {
    let size = size.clamp(1, 1023);
    let screen = Size::new(size, size);
    let mut frame = Frame::default();
    let mut pixels = vec![0; (size * size) as usize];
    let mut depth = vec![0; (size * size) as usize];
    let background = Gradient::new(Rgb888::new(96, 112, 136), Rgb888::new(40, 44, 56), size);
    let Ok(mut band) = Screen::new(screen, &mut pixels, &mut depth) else {
        return (RgbImage::new(size, size), frame);
    };
    band.clear_to(&background);
    // 40° high: a ball of radius 1 fills 90 % of it from 3.25 away.
    let camera = Camera::perspective(Turn::from_degrees(40), screen).at(Vec3::lit(0.0, 0.0, 3.25)).near(0.25);
    let suns = [Light::directional(Vec3::lit(-0.5, -0.8, -0.6), [190, 185, 175])];
    let lights = Lights::new([75, 78, 85], &suns);
    if let Some((pose, _)) = pose(baked, yaw, pitch) {
        // What can be seen through comes last.
        let mut order: Vec<_> = (0..baked.meshes.len()).collect();
        order.sort_by_key(|number| baked.materials[baked.meshes[*number].material].alpha.is_some());
        frame.stats = vec![Stats::default(); baked.meshes.len()];
        frame.pixels = vec![0; baked.meshes.len()];
        for number in order {
            let baked_mesh = &baked.meshes[number];
            let material = &baked.materials[baked_mesh.material];
            let Ok(mesh) = baked_mesh.mesh() else { continue };
            let Some(surface) = surface(baked, material) else { continue };
            let view = if material.is_lit { camera.lit_by(&lights) } else { View::of(&camera) };
            view.draw_counted(&mesh, &pose, surface, &mut band, &mut frame.stats[number]);
            frame.pixels[number] = covered_alone(&mesh, &pose, &camera, size);
        }
        frame.covered = band.depth().iter().filter(|depth| **depth != 0).count();
    }
    let colors: Vec<_> = band.colors().collect();
    let picture = RgbImage::from_fn(size, size, |x, y| {
        let color = Rgb888::from(colors[(y * size + x) as usize]);
        image::Rgb([color.r(), color.g(), color.b()])
    });
    (picture, frame)
}

/// How many pixels a mesh covers without the others.
fn covered_alone(mesh: &Mesh<'_>, pose: &Pose, camera: &Camera, size: u32) -> usize {
    let mut pixels = vec![0; (size * size) as usize];
    let mut depth = vec![0; (size * size) as usize];
    let Ok(mut band) = Screen::new(Size::new(size, size), &mut pixels, &mut depth) else { return 0 };
    camera.draw(mesh, pose, &Material::flat(Rgb565::WHITE), &mut band);
    band.depth().iter().filter(|depth| **depth != 0).count()
}

/// The surface of a baked material; one on which no light falls is to be drawn in a view without lights, as [`draw`] does.
///
/// Each kind of material and layer is a loop of its own, which takes the compiler seconds: so there are no more here than these.
#[must_use]
pub fn surface<'a>(baked: &'a Baked, material: &BakedMaterial) -> Option<Surface<'a, Rgb565, Depth16>> {
    macro_rules! finished {
        ($made:expr) => {{
            let made = if material.is_two_sided { $made.two_sided() } else { $made };
            match material.alpha {
                Some(alpha) => Surface::from(&made.alpha(alpha)),
                None => Surface::from(&made),
            }
        }};
    }
    Some(match material.paint {
        Paint::Flat(color) => finished!(Material::flat_bits(color).lit()),
        Paint::Gouraud => finished!(Material::gouraud().lit()),
        Paint::Texture { texture, is_clamped, is_masked } => {
            let baked = baked.textures.get(texture)?;
            let texture: Texture<'a> = baked.texture().ok()?;
            let mask: Option<Mask<'a>> = baked.mask().ok()?.filter(|_| is_masked);
            match (mask, is_clamped) {
                (Some(mask), true) => finished!(Material::clamped(&texture).lit().masked(&mask)),
                (Some(mask), false) => finished!(Material::textured(&texture).lit().masked(&mask)),
                (None, true) => finished!(Material::clamped(&texture).lit()),
                (None, false) => finished!(Material::textured(&texture).lit()),
            }
        }
    })
}
