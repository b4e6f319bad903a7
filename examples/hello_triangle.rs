//! The front page's dozen lines: one textured triangle and a line of text, drawn at once.
//!
//! `cargo run --example hello_triangle` writes `out/hello_triangle.png`.

#[path = "support/picture.rs"]
#[expect(dead_code, reason = "this example makes its own texture and no film")]
mod picture;

use embedded_graphics::mono_font::{MonoTextStyle, ascii::FONT_10X20};
use embedded_graphics::{pixelcolor::Rgb565, prelude::*, text::Text};
use fixel::prelude::*;

static CHECKS: Texture = Texture::new(&[0xffdf, 0x4a69, 0x4a69, 0xffdf], 1, 1); // 2 × 2 texels of RGB565
const TRIANGLE: Mesh = Mesh::new(
    &[
        Vertex::new(-1.0, -1.0, 0.0).uv(0, 16),
        Vertex::new(1.0, -1.0, 0.0).uv(16, 16),
        Vertex::new(0.0, 1.0, 0.0).uv(8, 0),
    ],
    &[[0, 1, 2]], // a bad index here does not compile
);

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let (mut pixels, mut depth) = ([0; 240 * 240], [0; 240 * 240]);
    let mut band = Band::<Rgb565, Depth16>::new(Size::new(240, 240), &mut pixels, &mut depth)?;

    let camera = Camera::perspective(Turn::from_degrees(60), band.size()).at(Vec3::lit(0.0, 0.0, 2.5));
    let pose = Pose::IDENTITY.rotated_y(Turn::from_degrees(50));
    camera.draw(&TRIANGLE, &pose, &Material::textured(&CHECKS), &mut band);

    let gold = MonoTextStyle::new(&FONT_10X20, Rgb565::CSS_GOLD);
    Text::new("hello", Point::new(8, 24), gold).draw(&mut band)?; // 2D on top just works

    std::fs::create_dir_all("out")?;
    picture::rgba(&band).save("out/hello_triangle.png")?;
    println!("wrote out/hello_triangle.png");
    Ok(())
}
