//! A turning cube with a texture that repeats, in a cube of glass: what blending takes beside what `textured` has.

#![cfg_attr(target_os = "none", no_std, no_main)]

#[path = "../screen.rs"]
mod screen;

use fixel::embedded_graphics::{pixelcolor::Rgb565, prelude::*};
use fixel::{Material, Turn};
use fixel_firmware::cube::{BRICK, CAMERA, CUBE, Screen, pose};

fn draw(turn: Turn, screen: &mut Screen<'_>) {
    let pose = pose(turn);
    CAMERA.draw(&CUBE, &pose.scaled_lit(0.5), &Material::textured(&BRICK), screen);
    CAMERA.draw(&CUBE, &pose, &Material::flat(Rgb565::CSS_SKY_BLUE).alpha(96), screen);
}

#[cfg(not(target_os = "none"))]
fn main() {
    screen::print();
}
