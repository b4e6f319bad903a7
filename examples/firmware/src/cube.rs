//! A turning cube for the small programs `flat`, `textured`, `textured_lit` and `all`: what they draw, but for its surface.

use embedded_graphics::{pixelcolor::Rgb565, prelude::*};
use fixel::prelude::*;
use fixel::shapes::{self, Shape};

/// Width and height of the screen.
pub const SIZE: Size = Size::new(160, 120);
/// Pixels of the screen.
pub const PIXELS: usize = 160 * 120;
/// The screen.
pub type Screen<'a> = Band<'a, Rgb565, Depth16>;

/// What sees the cube.
pub const CAMERA: Camera = Camera::focal(120.0, SIZE).near(0.25).at(Vec3::lit(0.0, 0.0, 4.0));

static TEXELS: [u16; 1024] = texels(include_bytes!("../assets/brick.rgb565"));
/// A texture that repeats.
pub static BRICK: Texture = Texture::new(&TEXELS, 5, 5);

static SHAPE: Shape<24, 12> = shapes::cube(2.0, [64, 64]);
/// Each face twice the texture across, with normals.
pub static CUBE: Mesh = SHAPE.mesh();

static SOURCES: [Light; 2] = [
    Light::directional(Vec3::lit(-0.4, -0.6, -0.7), [160; 3]),
    Light::point(Vec3::lit(1.0, 1.0, 2.5), [128, 96, 64], fixel::num::I16F16::lit("4")),
];
/// Light from afar, and from nearby.
pub static LIGHTS: Lights = Lights::new([40; 3], &SOURCES);

/// How the cube stands.
#[must_use]
pub fn pose(turn: Turn) -> Pose {
    Pose::IDENTITY.rotated_y(turn).rotated_x(Turn::from_degrees(25))
}
