//! A turning cube with a texture that repeats, in the light of the sun and of a lamp.

#![cfg_attr(target_os = "none", no_std, no_main)]

#[path = "../screen.rs"]
mod screen;

use fixel::prelude::*;
use fixel_firmware::cube::{BRICK, CAMERA, CUBE, LIGHTS, Screen, pose};

fn draw(turn: Turn, screen: &mut Screen<'_>) {
    let material = Material::textured(&BRICK).lit();
    CAMERA.lit_by(&LIGHTS).draw(&CUBE, &pose(turn), &material, screen);
}

#[cfg(not(target_os = "none"))]
fn main() {
    screen::print();
}
