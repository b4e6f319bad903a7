//! One scene as displays of few bits show it: an OLED of 1 bit, e-paper of 4 greys, an OLED of 16, and colour displays of 18 and 16
//! bits.
//!
//! `cargo run --release --example displays` writes `out/displays.png`; `cargo run --release --example displays -- DIRECTORY` writes
//! elsewhere.
//!
//! Each is drawn as a microcontroller would: a list in bands of 8 rows, each dithered and packed when it is sent. What is shown is read
//! back from the bytes as the display's controller reads them.
//!
//! What makes 3D readable in 1 bit: a dark sky and a dark floor, light from one side, few and large texels; a curve for contrast; and
//! fog that ends in the sky's black.

#[allow(dead_code, reason = "the sheet is not of RGB565, and no film")]
#[path = "support/picture.rs"]
mod picture;

use embedded_graphics::mono_font::{MonoTextStyle, ascii::FONT_6X10};
use embedded_graphics::pixelcolor::{BinaryColor, Gray2, Gray4, Gray8, Rgb565, Rgb666, Rgb888};
use embedded_graphics::prelude::*;
use embedded_graphics::primitives::Rectangle;
use embedded_graphics::text::{Baseline, Text};
use fixel::num::I16F16;
use fixel::prelude::*;
use fixel::shapes::{self, Counts, Shape};
use fixel::{Background, BlendFormat, PackError};
use std::error::Error;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

/// Rows of a band: a page of an SSD1306.
const ROWS: u32 = 8;

const RING: Counts = Counts::torus(32, 16);
static TORUS: Shape<{ RING.vertices }, { RING.triangles }> = shapes::torus(0.95, 0.36, 32, 16);
static PILLAR: Shape<24, 12> = shapes::cube(1.0, [32, 32]);
static FLOOR: Mesh = Mesh::new(
    &[
        Vertex::new(-4.0, 0.0, -6.0).uv(-16, -24).normal(0.0, 1.0, 0.0),
        Vertex::new(-4.0, 0.0, 2.0).uv(-16, 8).normal(0.0, 1.0, 0.0),
        Vertex::new(4.0, 0.0, 2.0).uv(16, 8).normal(0.0, 1.0, 0.0),
        Vertex::new(4.0, 0.0, -6.0).uv(16, -24).normal(0.0, 1.0, 0.0),
    ],
    &[[0, 1, 2], [0, 2, 3]],
);
static CHECKS: [u16; 4] = [0xc618, 0x18c3, 0x18c3, 0xc618];
static TILES: Texture = Texture::new(&CHECKS, 1, 1);

/// Large bricks, 16 × 8 texels each.
static BRICKS: [u16; 1024] = {
    let mut texels = [0; 1024];
    let mut i = 0;
    while i < 1024 {
        let (x, y) = (i % 32, i / 32);
        let shifted = if y / 8 % 2 == 0 { x } else { x + 8 };
        let shade = (shifted / 16 * 5 + y / 8 * 3) as u16 % 4;
        let is_mortar = y % 8 < 2 || shifted % 16 < 2;
        texels[i] =
            if is_mortar { 0x3186 } else { (25 + shade) << 11 | (34 + 3 * shade) << 5 | (14 + shade) };
        i += 1;
    }
    texels
};
static WALL: Texture = Texture::new(&BRICKS, 5, 5);

/// What is particular to a display: how large it is, what is behind the scene, and how light the scene is.
struct Look {
    size: Size,
    /// Fog ends in it.
    sky: Rgb565,
    ambient: [u8; 3],
    ink: Rgb565,
    /// Of the camera's view, from top to bottom.
    degrees: i32,
}

const NIGHT: Look =
    Look { size: Size::new(128, 64), sky: Rgb565::BLACK, ambient: [40; 3], ink: Rgb565::WHITE, degrees: 46 };

/// Draws the scene into a band of a format, and sends each band.
fn show<F, E>(
    look: &Look,
    mut send: impl FnMut(&mut Band<'_, F, Depth16>) -> Result<(), E>,
) -> Result<(), Box<dyn Error>>
where
    F: BlendFormat<Color: From<Rgb565>>,
    E: Error + 'static,
    Rgb565: Background<F>,
{
    let sun = [Light::directional(Vec3::lit(-0.8, -0.5, -0.25), [235, 225, 200])];
    let lights = Lights::new(look.ambient, &sun);
    let fog = fixel::Fog::linear(look.sky, I16F16::lit("3.5"), I16F16::lit("13"));
    let camera = Camera::perspective(Turn::from_degrees(look.degrees), look.size)
        .at(Vec3::lit(0.0, 1.9, 4.4))
        .look_at(Vec3::lit(0.0, 0.95, 0.0), Vec3::lit(0.0, 1.0, 0.0));
    let view = camera.lit_by(&lights).in_fog(&fog);
    let mut memory = Box::new(ListMemory::<3000, 1500>::new());
    let mut list = DisplayList::<F, Depth16, 12>::new(&mut *memory);
    let stone = Material::textured(&WALL).lit();
    view.draw(&FLOOR, &Pose::IDENTITY.scaled_lit(2.0), &Material::textured(&TILES).lit(), &mut list)?;
    for row in 0..4_i16 {
        for side in [-1, 1_i16] {
            let place = [I16F16::from(side * 2), I16F16::ONE, I16F16::from(1 - 3 * row)];
            let pose = Pose::IDENTITY.stretched_lit(0.7, 2.0, 0.7).rotated_y(Turn::from_degrees(20));
            view.draw(&PILLAR.mesh(), &pose.at(Vec3::new(place[0], place[1], place[2])), &stone, &mut list)?;
        }
    }
    let ring = Pose::IDENTITY.rotated_y(Turn::from_degrees(38)).rotated_x(Turn::from_degrees(-24));
    let gold = Material::flat(Rgb565::CSS_GOLD).lit();
    view.draw(&TORUS.mesh(), &ring.at(Vec3::lit(0.0, 1.15, 1.0)), &gold, &mut list)?;

    let words = (look.size.width * ROWS) as usize;
    let (mut pixels, mut depth) = (vec![F::rgb565(0); words], vec![0; words]);
    let mut band = Band::new(Size::new(look.size.width, ROWS), &mut pixels, &mut depth)?;
    let style = MonoTextStyle::new(&FONT_6X10, look.ink.into());
    list.render_bands(look.size.height, &look.sky, &mut band, |_, band| {
        let Ok(_) = Text::with_baseline("fixel", Point::new(2, 1), style, Baseline::Top).draw(band);
        send(band)
    })?;
    Ok(())
}

/// Greys of a display with a range of its own: what is darker than the first becomes black, what is lighter than the last white.
const fn contrast(black: u32, white: u32) -> [u8; 256] {
    let mut curve = [0; 256];
    let mut level = 0;
    while level < 256 {
        let within = if level < black {
            0
        } else if level > white {
            white - black
        } else {
            level - black
        };
        curve[level as usize] = (within * 255 / (white - black)) as u8;
        level += 1;
    }
    curve
}

fn through(curve: &[u8; 256], band: &mut Band<'_, Gray8, Depth16>) {
    for level in band.pixels_mut() {
        *level = curve[usize::from(*level)];
    }
}

/// Colours of pixels, row after row.
type Shown = (Size, Vec<Rgb888>);

fn mixed(dark: [u8; 3], light: [u8; 3], level: u8, most: u8) -> Rgb888 {
    let [red, green, blue] = core::array::from_fn(|i| {
        let (dark, light) = (u32::from(dark[i]), u32::from(light[i]));
        ((dark * u32::from(most - level) + light * u32::from(level)) / u32::from(most)) as u8
    });
    Rgb888::new(red, green, blue)
}

/// 1 bit, in pages of eight rows.
fn ssd1306() -> Result<Shown, Box<dyn Error>> {
    const CURVE: [u8; 256] = contrast(20, 195);
    let mut memory = Vec::new();
    show::<Gray8, PackError>(&NIGHT, |band| {
        through(&CURVE, band);
        let mut page = [0; 128];
        memory.extend_from_slice(band.dithered::<BinaryColor>().pack_pages(&mut page)?);
        Ok(())
    })?;
    let bit = |i: usize| memory[i / 1024 * 128 + i % 128] >> (i / 128 % 8) & 1;
    Ok((NIGHT.size, (0..128 * 64).map(|i| mixed([6, 10, 16], [170, 220, 255], bit(i), 1)).collect()))
}

/// 2 bits, row after row. White paper: fog is white.
fn e_paper() -> Result<Shown, Box<dyn Error>> {
    let look = Look {
        size: Size::new(200, 200),
        sky: Rgb565::WHITE,
        ambient: [70; 3],
        ink: Rgb565::BLACK,
        degrees: 60,
    };
    let mut memory = Vec::new();
    show::<Gray8, PackError>(&look, |band| {
        let mut rows = [0; 200 / 4 * ROWS as usize];
        memory.extend_from_slice(band.dithered::<Gray2>().pack_rows(&mut rows)?);
        Ok(())
    })?;
    let level = |i: usize| memory[i / 4] >> (6 - i % 4 * 2) & 3;
    Ok((look.size, (0..200 * 200).map(|i| mixed([34, 34, 36], [226, 226, 218], level(i), 3)).collect()))
}

/// 4 bits, row after row.
fn ssd1322() -> Result<Shown, Box<dyn Error>> {
    let look = Look { size: Size::new(256, 64), ..NIGHT };
    let mut memory = Vec::new();
    show::<Gray8, PackError>(&look, |band| {
        let mut rows = [0; 256 / 2 * ROWS as usize];
        memory.extend_from_slice(band.dithered::<Gray4>().pack_rows(&mut rows)?);
        Ok(())
    })?;
    let level = |i: usize| memory[i / 2] >> (4 - i % 2 * 4) & 15;
    Ok((look.size, (0..256 * 64).map(|i| mixed([8, 6, 2], [255, 236, 150], level(i), 15)).collect()))
}

const COLOR: Look = Look {
    size: Size::new(160, 120),
    sky: Rgb565::new(5, 12, 9),
    ambient: [60, 62, 75],
    ink: Rgb565::WHITE,
    degrees: 46,
};

/// Drawn in a format, and sent in a colour, dithered or not.
fn in_color<F, C>(is_dithered: bool) -> Result<Shown, Box<dyn Error>>
where
    F: BlendFormat<Color: From<Rgb565> + Into<Rgb888>>,
    C: fixel::Quantize + Into<Rgb888>,
{
    let mut shown = Vec::new();
    show::<F, std::convert::Infallible>(&COLOR, |band| {
        let pixels = if is_dithered { band.dithered::<C>() } else { band.quantized::<C>() };
        shown.extend(pixels.into_iter().map(Into::into));
        Ok(())
    })?;
    Ok((COLOR.size, shown))
}

/// Puts what a display shows on the sheet, enlarged, with a line of text above.
fn put(sheet: &mut Band<'_, Rgb888, NoDepth>, name: &str, corner: Point, scale: u32, (size, shown): &Shown) {
    let style = MonoTextStyle::new(&FONT_6X10, Rgb888::new(220, 220, 220));
    let Ok(_) = Text::with_baseline(name, corner - Point::new(0, 14), style, Baseline::Top).draw(sheet);
    for (i, color) in (0..).zip(shown) {
        let at = Point::new((i % size.width * scale) as i32, (i / size.width * scale) as i32);
        let Ok(()) = sheet.fill_solid(&Rectangle::new(corner + at, Size::new_equal(scale)), *color);
    }
}

fn run(directory: &Path) -> Result<(), Box<dyn Error>> {
    std::fs::create_dir_all(directory)?;
    let path = directory.join("displays.png");
    let size = Size::new(1008, 736);
    let mut pixels = vec![[0; 3]; (size.width * size.height) as usize];
    let mut sheet = Band::<Rgb888, NoDepth>::new(size, &mut pixels, &mut [])?;
    let Ok(()) = sheet.clear(Rgb888::new(44, 46, 52));
    let mut at =
        |name: &str, x, y, scale, shown: &Shown| put(&mut sheet, name, Point::new(x, y), scale, shown);
    at("SSD1306: 128x64, 1 bit, in pages", 16, 32, 4, &ssd1306()?);
    at("SSD1322: 256x64, 16 greys", 16, 328, 2, &ssd1322()?);
    at("e-paper: 200x200, 4 greys", 560, 32, 2, &e_paper()?);
    at("18 bits, dithered from 24", 16, 484, 2, &in_color::<Rgb888, Rgb666>(true)?);
    at("16 bits, dithered from 24", 344, 484, 2, &in_color::<Rgb888, Rgb565>(true)?);
    at("16 bits, as drawn in Rgb565", 672, 484, 2, &in_color::<Rgb565, Rgb565>(false)?);
    picture::Rgba::of_rgb888(size, sheet.colors()).save(&path)?;
    println!("wrote {}", path.display());
    Ok(())
}

fn main() -> ExitCode {
    let directory = std::env::args_os().nth(1).map_or_else(|| PathBuf::from("out"), PathBuf::from);
    match run(&directory) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("displays: {error}");
            ExitCode::FAILURE
        }
    }
}
