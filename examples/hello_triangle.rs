//! The dozen lines of the front page: one textured triangle and a line of text, drawn at once.
//!
//! `cargo run --example hello_triangle` writes `out/hello_triangle.png`.

use embedded_graphics::{
    mono_font::MonoTextStyle, mono_font::ascii::FONT_10X20, pixelcolor::Rgb565, prelude::*, text::Text,
};
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
    let size = Size::new(240, 240);
    let (mut pixels, mut depth) = (vec![0; 240 * 240], vec![0; 240 * 240]);
    let mut band = Band::<Rgb565, Depth16>::new(size, &mut pixels, &mut depth)?;

    let camera = Camera::perspective(Turn::from_degrees(60), size).at(Vec3::lit(0.0, 0.0, 2.5));
    let pose = Pose::IDENTITY.rotated_y(Turn::from_degrees(50));
    camera.draw(&TRIANGLE, &pose, &Material::textured(&CHECKS), &mut band);

    let style = MonoTextStyle::new(&FONT_10X20, Rgb565::CSS_GOLD);
    Text::new("hello", Point::new(8, 24), style).draw(&mut band)?; // 2D on top just works

    let path = "out/hello_triangle.png";
    write_png(path, &band)?;
    println!("wrote {path}");
    Ok(())
}

/// The band as a picture.
fn write_png(path: &str, band: &Band<'_, Rgb565, Depth16>) -> Result<(), Box<dyn std::error::Error>> {
    let bytes = band.colors().flat_map(|color| {
        [
            (color.r() << 3) | (color.r() >> 2),
            (color.g() << 2) | (color.g() >> 4),
            (color.b() << 3) | (color.b() >> 2),
        ]
    });
    let Size { width, height } = band.bounding_box().size;
    std::fs::create_dir_all("out")?;
    image::save_buffer(path, &bytes.collect::<Vec<u8>>(), width, height, image::ColorType::Rgb8)?;
    Ok(())
}
