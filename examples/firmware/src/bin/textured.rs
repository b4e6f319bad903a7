//! A turning cube with a texture that repeats, and nothing else: no light, no blended colours, nothing clamped.

#![cfg_attr(target_os = "none", no_std, no_main)]

#[path = "../screen.rs"]
mod screen;

use fixel::{Material, Turn};
use fixel_firmware::cube::{BRICK, CAMERA, CUBE, Screen, pose};

fn draw(turn: Turn, screen: &mut Screen<'_>) {
    let material = Material::textured(&BRICK);
    CAMERA.draw(&CUBE, &pose(turn), &material, screen);
}

#[cfg(not(target_os = "none"))]
fn main() {
    screen::print();
}
