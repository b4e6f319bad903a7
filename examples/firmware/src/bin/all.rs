//! Turning cubes with every surface, light, quality and way to blend, some in fog: what a program links that names all of them.

#![cfg_attr(target_os = "none", no_std, no_main)]

#[path = "../screen.rs"]
mod screen;

use fixel::embedded_graphics::{pixelcolor::Rgb565, prelude::*};
use fixel::{Fog, Surface, num::I16F16, prelude::*};
use fixel_firmware::cube::{BRICK, CAMERA, CUBE, LIGHTS, Screen, pose};

static FOG: Fog = Fog::linear(Rgb565::WHITE, I16F16::lit("8"), I16F16::lit("16"));

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
    cube(8, turn, &textured.lit().cut_out(Rgb565::BLACK), screen);
    cube(9, turn, &Material::flat(Rgb565::CSS_SKY_BLUE).alpha(96), screen);
    cube(10, turn, &textured.additive().vertex_alpha(), screen);
    cube(11, turn, &Material::gouraud().multiply(), screen);
}

/// One of twelve in three rows, the last of them in fog.
fn cube<'a>(
    number: i16,
    turn: Turn,
    surface: impl Into<Surface<'a, Rgb565, Depth16>>,
    screen: &mut Screen<'_>,
) {
    let [x, y, z] = [3 * (number % 4) - 4, 3 * (number / 4) - 3, -8].map(I16F16::from_num);
    let (view, pose) = (CAMERA.lit_by(&LIGHTS), pose(turn).at(Vec3::new(x, y, z)));
    if number < 8 {
        view.draw(&CUBE, &pose, surface, screen);
    } else {
        view.in_fog(&FOG).draw(&CUBE, &pose, surface, screen);
    }
}

#[cfg(not(target_os = "none"))]
fn main() {
    screen::print();
}
