//! What the boards draw: the Earth, baked of `globe.obj` by `build.rs`, turns in the light of the sun.

use fixel::embedded_graphics::pixelcolor::Rgb888;
use fixel::embedded_graphics::prelude::*;
use fixel::prelude::*;
use fixel::{CapacityError, Gradient, PixelFormat};

#[allow(dead_code, reason = "it could be drawn without a list, too")]
mod globe {
    include!(concat!(env!("OUT_DIR"), "/globe.rs"));
}

/// A frame, and the memory that it is recorded in: about 14 KiB.
pub type List<'a, F> = DisplayList<'a, F, Depth16, { globe::DRAWS }>;
pub type Memory = ListMemory<{ globe::LIST_VERTICES }, { globe::LIST_TRIANGLES }>;

static SUN: [Light; 1] = [Light::directional(Vec3::lit(-0.8, -0.3, -0.6), [255, 250, 240])];

/// The globe before a sky.
pub struct Scene {
    camera: Camera,
    lights: Lights<'static>,
    pub sky: Gradient,
}

#[allow(dead_code, reason = "a board has a display of one kind")]
impl Scene {
    /// For a display of colours.
    pub fn new(screen: Size) -> Self {
        Self {
            camera: Camera::perspective(Turn::from_degrees(50), screen).at(Vec3::lit(0.0, 0.0, 4.2)),
            lights: Lights::new([28, 30, 40], &SUN),
            sky: Gradient::new(Rgb888::CSS_MIDNIGHT_BLUE, Rgb888::BLACK, screen.height),
        }
    }

    /// For a display of black and white, which few dots of dark blue say nothing on: nearer, brighter, in front of black.
    pub fn for_black_and_white(screen: Size) -> Self {
        Self {
            camera: Camera::perspective(Turn::from_degrees(50), screen).at(Vec3::lit(0.0, 0.0, 2.6)),
            lights: Lights::new([190; 3], &SUN),
            sky: Gradient::new(Rgb888::BLACK, Rgb888::BLACK, screen.height),
        }
    }

    /// Records a frame; a turn takes 256.
    pub fn record<F: PixelFormat>(&self, frame: u32, list: &mut List<'_, F>) -> Result<(), CapacityError> {
        let turn = Turn::from_raw((frame << 8) as u16);
        let pose = globe::POSE.rotated_y(turn).rotated_z(Turn::from_degrees(-23));
        globe::draw_in_list(&self.camera.lit_by(&self.lights), &pose, list)
    }
}
