//! Turning cubes with every surface, light and quality: what a program links that names all of them.

#![cfg_attr(target_os = "none", no_std, no_main)]

#[path = "../screen.rs"]
mod screen;

use fixel::embedded_graphics::{pixelcolor::Rgb565, prelude::*};
use fixel::{Surface, num::I16F16, prelude::*};
use fixel_firmware::cube::{BRICK, CAMERA, CUBE, LIGHTS, Screen, pose};

fn draw(turn: Turn, screen: &mut Screen<'_>) {
    let textured = Material::textured(&BRICK);
    cube(0, turn, &Material::flat(Rgb565::CSS_TOMATO), screen);
    cube(1, turn, &textured, screen);
    cube(2, turn, &Material::clamped(&BRICK), screen);
    cube(3, turn, &textured.lit(), screen);
    cube(4, turn, &Material::gouraud(), screen);
    cube(5, turn, &Material::gouraud().lit().faceted(), screen);
    cube(6, turn, &textured.exact(), screen);
    cube(7, turn, &textured.affine(), screen);
}

/// One of eight in two rows.
fn cube<'a>(
    number: i16,
    turn: Turn,
    surface: impl Into<Surface<'a, Rgb565, Depth16>>,
    screen: &mut Screen<'_>,
) {
    let [x, y, z] = [3 * (number % 4) - 4, 3 * (number / 4) - 1, -8].map(I16F16::from_num);
    CAMERA.lit_by(&LIGHTS).draw(&CUBE, &pose(turn).at(Vec3::new(x, y, z)), surface, screen);
}

#[cfg(not(target_os = "none"))]
fn main() {
    screen::print();
}
