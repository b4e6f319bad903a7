//! fixel: the scenes as `examples/firmware` draws them, and the flat ones.

use crate::library::{Library, Painter};
use crate::model::{FLAT, Model, PIXELS};
use crate::scene::{Scene, Surface, Thing};
use ::embedded_graphics::pixelcolor::{Rgb565, raw::RawU16};
use ::fixel::{Band, Depth16, Material, Mesh, NoDepth, Turn};
use fixel_firmware::bench::{self, Deep, Flat, SIZE};

#[derive(Debug)]
pub(super) struct Fixel;

impl Library for Fixel {
    fn name(&self) -> &'static str {
        "fixel"
    }

    fn painter(&self, scene: &Scene) -> Result<Box<dyn Painter>, &'static str> {
        Ok(match scene.thing {
            _ if scene.surface == Surface::Flat => in_one_color(scene),
            Thing::Floor(roll) => {
                let roll = Turn::from_degrees(roll);
                without_depth(move |frame| bench::s1(roll, frame))
            }
            Thing::Ground => without_depth(bench::s1_ground),
            Thing::Cube => with_depth(bench::s2),
            Thing::Torus => with_depth(bench::s3),
            Thing::TexturedTorus => with_depth(bench::s3_tex),
        })
    }
}

/// The flat scenes, which the firmware does not draw.
fn in_one_color(scene: &Scene) -> Box<dyn Painter> {
    let (mesh, pose) = scene.thing.placed();
    // In the order in which all libraries draw them; a mesh borrows.
    let sorted = Mesh::new(mesh.vertices(), Model::new(scene).triangles.leak());
    let material = Material::flat(RawU16::new(FLAT).into());
    without_depth(move |frame| bench::CAMERA.draw(&sorted, &pose, &material, frame))
}

fn without_depth(draw: impl Fn(&mut Flat<'_>) + 'static) -> Box<dyn Painter> {
    Box::new(Shallow { pixels: vec![0; PIXELS], draw })
}

fn with_depth(draw: impl Fn(&mut Deep<'_>) + 'static) -> Box<dyn Painter> {
    Box::new(Deeper { pixels: vec![0; PIXELS], depth: vec![0; PIXELS], draw })
}

/// A frame without depth.
struct Shallow<F> {
    pixels: Vec<u16>,
    draw: F,
}

impl<F: Fn(&mut Flat<'_>)> Painter for Shallow<F> {
    fn clear(&mut self, ground: u16) {
        self.pixels.fill(ground);
    }

    fn draw(&mut self) {
        if let Ok(mut frame) = Band::<Rgb565, NoDepth>::new(SIZE, &mut self.pixels, &mut [(); PIXELS]) {
            (self.draw)(&mut frame);
        }
    }

    fn words(&self) -> Vec<u16> {
        self.pixels.clone()
    }
}

/// A frame with 16-bit depth.
struct Deeper<F> {
    pixels: Vec<u16>,
    depth: Vec<u16>,
    draw: F,
}

impl<F: Fn(&mut Deep<'_>)> Painter for Deeper<F> {
    fn clear(&mut self, ground: u16) {
        self.pixels.fill(ground);
        self.depth.fill(0);
    }

    fn draw(&mut self) {
        if let Ok(mut frame) = Band::<Rgb565, Depth16>::new(SIZE, &mut self.pixels, &mut self.depth) {
            (self.draw)(&mut frame);
        }
    }

    fn words(&self) -> Vec<u16> {
        self.pixels.clone()
    }
}
