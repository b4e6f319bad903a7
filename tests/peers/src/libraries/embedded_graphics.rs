//! embedded-graphics' own `Triangle`: 2D, filled in one colour, between whole pixels.
//!
//! The caller brings the third dimension: vertices are transformed and projected here, in f32, and backs
//! left out by the sign of their area.

use crate::frame::Frame;
use crate::library::{Library, Painter};
use crate::model::{FLAT, FOCAL, HEIGHT, Model, WIDTH, transform};
use crate::scene::{Scene, Surface};
use ::embedded_graphics::pixelcolor::{Rgb565, raw::RawU16};
use ::embedded_graphics::prelude::*;
use ::embedded_graphics::primitives::{PrimitiveStyle, Triangle};

#[derive(Debug)]
pub(super) struct EmbeddedGraphics;

impl Library for EmbeddedGraphics {
    fn name(&self) -> &'static str {
        "embedded-graphics"
    }

    fn version(&self) -> &'static str {
        "0.8"
    }

    fn difference(&self) -> Option<&'static str> {
        Some(
            "the 2D `Triangle` primitive: one colour, no depth, vertices rounded to whole pixels, all pixels of its \
         edges drawn; the caller transforms, projects and culls, in f32",
        )
    }

    fn painter(&self, scene: &Scene) -> Result<Box<dyn Painter>, &'static str> {
        if scene.surface != Surface::Flat {
            return Err("its triangles have neither texture nor shade nor depth");
        }
        let model = Model::new(scene);
        Ok(Box::new(Canvas {
            frame: Frame::new(),
            style: PrimitiveStyle::with_fill(RawU16::new(FLAT).into()),
            projected: vec![[0.0; 2]; model.positions.len()],
            model,
        }))
    }
}

struct Canvas {
    frame: Frame,
    style: PrimitiveStyle<Rgb565>,
    /// The vertices on the screen.
    projected: Vec<[f32; 2]>,
    model: Model,
}

impl Painter for Canvas {
    fn clear(&mut self, ground: u16) {
        self.frame.clear_to(ground);
    }

    fn draw(&mut self) {
        for (projected, &position) in self.projected.iter_mut().zip(&self.model.positions) {
            let [x, y, z] = transform(&self.model.to_eye, position);
            let scale = -FOCAL / z;
            *projected = [WIDTH as f32 / 2.0 + x * scale, HEIGHT as f32 / 2.0 - y * scale];
        }
        for triangle in &self.model.triangles {
            let [a, b, c] = triangle.map(|index| self.projected[usize::from(index)]);
            let area = (b[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (b[1] - a[1]);
            // Counter-clockwise where y points down.
            if area < 0.0 {
                // The pixel in which a point lies.
                let [a, b, c] = [a, b, c].map(|[x, y]| Point::new(x.floor() as i32, y.floor() as i32));
                let Ok(()) = Triangle::new(a, b, c).into_styled(self.style).draw(&mut self.frame);
            }
        }
    }

    fn words(&self) -> Vec<u16> {
        self.frame.words()
    }
}
