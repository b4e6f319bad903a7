//! README's first program: one textured triangle and a word, drawn at once, shown in the terminal.
//!
//! `cargo run --example hello_triangle`; the terminal has to know 24-bit colours, as most do.

use fixel::embedded_graphics::mono_font::{MonoTextStyle, ascii::FONT_6X10};
use fixel::embedded_graphics::pixelcolor::{Rgb565, Rgb888};
use fixel::embedded_graphics::{prelude::*, text::Text};
use fixel::prelude::*;

static CHECKS: Texture = Texture::new(&[0xffdf, 0x4a69, 0x4a69, 0xffdf], 1, 1); // 2 × 2 texels of RGB565
const TRIANGLE: Mesh = Mesh::new(
    &[
        Vertex::new(-1.0, -1.0, 0.0).uv(0, 8),
        Vertex::new(1.0, -1.0, 0.0).uv(8, 8),
        Vertex::new(0.0, 1.0, 0.0).uv(4, 0),
    ],
    &[[0, 1, 2]], // counter-clockwise is the front; a bad index here does not compile
);

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let (mut pixels, mut depth) = ([0; 64 * 64], [0; 64 * 64]);
    let mut band = Band::<Rgb565, Depth16>::new(Size::new(64, 64), &mut pixels, &mut depth)?;

    let camera = Camera::perspective(Turn::from_degrees(60), band.size()).at(Vec3::lit(0.0, 0.0, 2.5));
    let pose = Pose::IDENTITY.rotated_y(Turn::from_degrees(50));
    band.clear(Rgb565::BLACK)?; // a new picture: colours and depth
    camera.draw(&TRIANGLE, &pose, &Material::textured(&CHECKS), &mut band);

    let gold = MonoTextStyle::new(&FONT_6X10, Rgb565::CSS_GOLD);
    Text::new("hello", Point::new(2, 8), gold).draw(&mut band)?; // 2D on top just works

    // A display takes `band.colors()` by `fill_contiguous`. A terminal takes two rows of pixels a line.
    let colors: Vec<_> = band.colors().map(Rgb888::from).collect();
    for rows in colors.chunks(2 * 64) {
        for (above, below) in rows[..64].iter().zip(&rows[64..]) {
            print!("\x1b[38;2;{};{};{}m", above.r(), above.g(), above.b());
            print!("\x1b[48;2;{};{};{}m▀", below.r(), below.g(), below.b());
        }
        println!("\x1b[0m");
    }
    Ok(())
}
