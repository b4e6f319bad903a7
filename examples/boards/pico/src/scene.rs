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

static SUN: [Light; 1] = [Light::directional(Vec3::lit(-0.8, -0.3, -0.6), [230, 225, 215])];
static LIGHTS: Lights = Lights::new([28, 30, 40], &SUN);

/// What stands behind the globe.
pub fn sky(screen: Size) -> Gradient {
    Gradient::new(Rgb888::CSS_MIDNIGHT_BLUE, Rgb888::BLACK, screen.height)
}

/// Records a frame; a turn takes 256.
pub fn record<F: PixelFormat>(
    frame: u32,
    screen: Size,
    list: &mut List<'_, F>,
) -> Result<(), CapacityError> {
    let camera = Camera::perspective(Turn::from_degrees(50), screen).at(Vec3::lit(0.0, 0.0, 4.2));
    let turn = Turn::from_raw((frame << 8) as u16);
    let pose = globe::POSE.rotated_y(turn).rotated_z(Turn::from_degrees(-23));
    globe::draw_in_list(&camera.lit_by(&LIGHTS), &pose, list)
}
