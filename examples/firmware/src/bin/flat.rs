//! A turning cube of one colour, and nothing else: what the flash of the least program is.

#![cfg_attr(target_os = "none", no_std, no_main)]

#[path = "../screen.rs"]
mod screen;

use fixel::Turn;
use fixel::embedded_graphics::{pixelcolor::Rgb565, prelude::*};
use fixel::prelude::Material;
use fixel_firmware::cube::{CAMERA, CUBE, Screen, pose};

fn draw(turn: Turn, screen: &mut Screen<'_>) {
    let material = Material::flat(Rgb565::CSS_TOMATO);
    CAMERA.draw(&CUBE, &pose(turn), &material, screen);
}

#[cfg(not(target_os = "none"))]
fn main() {
    screen::print();
}
