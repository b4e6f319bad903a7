//! A contact sheet of all surfaces: each kind of material with each way to lay it over what is there, in light and in fog.
//!
//! `cargo run --release --example surfaces` writes `out/surfaces.png`; `cargo run --release --example surfaces -- DIRECTORY` writes
//! elsewhere.
//!
//! Every tile shows two things from one list: an opaque pillar, and a ball or a card before it that has the surface.

#[allow(dead_code, reason = "pictures are written here, not read")]
#[path = "support/picture.rs"]
mod picture;

use embedded_graphics::draw_target::DrawTargetExt;
use embedded_graphics::mono_font::{MonoTextStyle, ascii::FONT_5X8};
use embedded_graphics::pixelcolor::{Rgb565, Rgb888};
use embedded_graphics::prelude::*;
use embedded_graphics::primitives::Rectangle;
use embedded_graphics::text::{Baseline, Text};
use fixel::num::I16F16;
use fixel::prelude::*;
use fixel::shapes::{self, Counts, Shape};
use fixel::{Fog, Fragment, Gradient, Inputs, Mask, QuarterPixel, Reach, Shader, Surface, Varying};
use std::convert::Infallible;
use std::error::Error;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

const TILE: Size = Size::new(96, 96);
const COLUMNS: u32 = 6;
const COUNTS: Counts = Counts::uv_sphere(24, 12);
static BALL: Shape<{ COUNTS.vertices }, { COUNTS.triangles }> = shapes::uv_sphere(1.0, 24, 12, [96, 48]);
static PILLAR: Shape<24, 12> = shapes::cube(0.9, [16, 16]);

/// Bricks of 16 × 16 texels, four of them, with mortar that can be left out.
const MORTAR: u16 = 0xbdd7;
static BRICKS: [u16; 1024] = {
    let mut texels = [0; 1024];
    let mut i = 0;
    while i < 1024 {
        let (x, y) = (i % 32, i / 32);
        let shifted = if y / 8 % 2 == 0 { x } else { x + 8 };
        let is_mortar = y % 8 == 0 || shifted % 16 == 0;
        let noise = (i * 7919 % 31 / 8) as u16;
        texels[i] = if is_mortar { MORTAR } else { (20 + noise) << 11 | (18 + 2 * noise) << 5 | 8 };
        i += 1;
    }
    texels
};
static WALL: Texture = Texture::new(&BRICKS, 5, 5);

/// A lattice.
static LATTICE: [u8; 32] = {
    let mut bits = [0; 32];
    let mut y = 0;
    while y < 16 {
        bits[2 * y] = if y % 8 < 3 { 0xff } else { 0b1110_0000 };
        bits[2 * y + 1] = bits[2 * y];
        y += 1;
    }
    bits
};

/// Rings around the pole, every other one left out.
struct Rings;

impl Shader<Rgb565> for Rings {
    type Quality = QuarterPixel;
    const REACH: Reach = Reach::Place;

    fn inputs(&self) -> Inputs {
        Inputs::UvColor
    }

    fn color(&self, at: &Varying) -> u16 {
        let [red, green, _] = at.color.map(|channel| channel.to_num::<u16>());
        (red / 8) << 11 | (green / 8) << 5 | (31 - red / 8)
    }

    fn fragment(&self, fragment: &Fragment<u16>) -> Option<u16> {
        (fragment.varying.v.to_num::<i32>() / 4 % 2 == 0).then(|| self.color(&fragment.varying))
    }
}

/// Shows what is behind it in grey.
struct Gray;

impl Shader<Rgb565> for Gray {
    type Quality = QuarterPixel;
    const REACH: Reach = Reach::Target;

    fn inputs(&self) -> Inputs {
        Inputs::None
    }

    fn color(&self, _: &Varying) -> u16 {
        0
    }

    fn fragment(&self, fragment: &Fragment<u16>) -> Option<u16> {
        let (red, green, blue) = (fragment.target >> 11, fragment.target >> 5 & 63, fragment.target & 31);
        let gray = (red + green + blue) / 4;
        Some(gray << 11 | gray << 6 | gray)
    }
}

/// Each surface with its name.
fn surfaces(wall: &Texture<'static>) -> Vec<(&'static str, Surface<'static, Rgb565, Depth16>)> {
    let lattice = Mask::new(&LATTICE, 4, 4);
    let mortar = embedded_graphics::pixelcolor::raw::RawU16::new(MORTAR).into();
    let blue = Material::flat(Rgb565::CSS_CORNFLOWER_BLUE);
    let (gouraud, bricks) = (Material::gouraud(), Material::textured(wall));
    let clamped = Material::clamped(wall);
    vec![
        ("flat", blue.surface()),
        ("flat lit", blue.lit().surface()),
        ("faceted", blue.lit().faceted().surface()),
        ("gouraud", gouraud.surface()),
        ("gouraud lit", gouraud.lit().surface()),
        ("textured", bricks.surface()),
        ("textured lit", bricks.lit().surface()),
        ("textured exact", bricks.exact().surface()),
        ("textured affine", bricks.affine().surface()),
        ("texture scale 1", bricks.texture_scale(1).surface()),
        ("clamped", clamped.surface()),
        ("clamped lit", clamped.lit().surface()),
        ("alpha", blue.lit().alpha(128).surface()),
        ("alpha textured", bricks.lit().alpha(160).surface()),
        ("vertex alpha", blue.vertex_alpha().surface()),
        ("additive", blue.lit().additive().surface()),
        ("additive alpha", bricks.additive().alpha(100).surface()),
        ("multiply", Material::flat(Rgb565::CSS_LIGHT_SALMON).multiply().surface()),
        ("door 1/4", blue.lit().alpha(64).screen_door().surface()),
        ("door 3/4", bricks.lit().alpha(191).screen_door().surface()),
        ("vertices' door", bricks.screen_door().vertex_alpha().surface()),
        ("cut out", bricks.lit().cut_out(mortar).two_sided().surface()),
        ("masked", bricks.lit().masked(&lattice).two_sided().surface()),
        ("masked alpha", bricks.lit().masked(&lattice).alpha(150).surface()),
        ("untested", blue.lit().depth(false, true).surface()),
        ("nearer", blue.lit().depth_bias(4000).surface()),
        ("leaves out", Surface::new(&Rings)),
        ("reads target", Surface::new(&Gray)),
    ]
}

/// The ball's vertices in colours of their own: red, which some take for alpha, is most at the top.
#[expect(clippy::float_arithmetic, reason = "on a desktop")]
fn colored_ball() -> Vec<Vertex> {
    let mut vertices = BALL.mesh().vertices().to_vec();
    for vertex in &mut vertices {
        let level = |axis: usize| (vertex.position[axis].to_num::<f32>() * 127.0 + 128.0) as u8;
        vertex.color = [level(1), level(0), 255 - level(1)];
    }
    vertices
}

/// Draws a tile in bands of 16 rows.
fn tile(name: &str, surface: Surface<'static, Rgb565, Depth16>, in_fog: bool) -> Vec<Rgb565> {
    let sky = Gradient::new(Rgb888::new(60, 70, 110), Rgb888::new(220, 190, 170), TILE.height);
    let sun = [Light::directional(Vec3::lit(-0.5, -0.6, -0.8), [190; 3])];
    let lights = Lights::new([60; 3], &sun);
    let fog = Fog::linear(Rgb565::WHITE, I16F16::lit("2.5"), I16F16::lit("6")).towards(&sky);
    let camera = Camera::perspective(Turn::from_degrees(50), TILE).near(0.25).at(Vec3::lit(0.0, 0.0, 4.0));
    let view = camera.lit_by(&lights);
    let ball = Pose::IDENTITY.rotated_y(Turn::from_degrees(30)).rotated_x(Turn::from_degrees(25));
    let pillar = Pose::IDENTITY.stretched_lit(0.6, 3.0, 0.6).rotated_y(Turn::from_degrees(20));
    let pillar = pillar.at(Vec3::lit(0.4, 0.0, -1.2));
    let (vertices, ball_triangles) = (colored_ball(), BALL.mesh().triangles().collect::<Vec<_>>());
    let of_ball = Mesh::try_new(&vertices, &ball_triangles).expect("a ball");
    let of_pillar = PILLAR.mesh();
    let mut memory = Box::new(ListMemory::<2000, 700>::new());
    let mut list = DisplayList::<Rgb565, Depth16, 2>::new(&mut *memory);
    let stone = Material::textured(&WALL).lit();
    if in_fog {
        let view = view.in_fog(&fog);
        view.draw(&of_ball, &ball, surface, &mut list).expect("there is room");
        view.draw(&of_pillar, &pillar, &stone, &mut list).expect("there is room");
    } else {
        view.draw(&of_ball, &ball, surface, &mut list).expect("there is room");
        view.draw(&of_pillar, &pillar, &stone, &mut list).expect("there is room");
    }
    let (mut pixels, mut depth) = ([0; 96 * 16], [0; 96 * 16]);
    let mut band = Band::new(Size::new(96, 16), &mut pixels, &mut depth).expect("the band is small");
    let (mut colors, style) = (Vec::new(), MonoTextStyle::new(&FONT_5X8, Rgb565::WHITE));
    let Ok(()) = list.render_bands(TILE.height, &sky, &mut band, |_, band| {
        let Ok(_) = Text::with_baseline(name, Point::new(2, 1), style, Baseline::Top).draw(band);
        colors.extend(band.colors());
        Ok::<_, Infallible>(())
    });
    colors
}

fn run(directory: &Path) -> Result<(), Box<dyn Error>> {
    std::fs::create_dir_all(directory)?;
    let path = directory.join("surfaces.png");
    let surfaces = surfaces(&WALL);
    // Those of the last row again, and some others, in fog.
    let foggy =
        ["flat lit", "textured", "alpha", "additive", "multiply", "cut out", "gouraud lit", "door 3/4"];
    let in_fog = surfaces.iter().filter(|(name, _)| foggy.contains(name)).map(|tile| (tile, true));
    let tiles: Vec<_> = surfaces.iter().map(|tile| (tile, false)).chain(in_fog).collect();
    let size = Size::new(COLUMNS * TILE.width, (tiles.len() as u32).div_ceil(COLUMNS) * TILE.height);
    let mut pixels = vec![0; (size.width * size.height) as usize];
    let mut sheet = Band::<Rgb565, NoDepth>::new(size, &mut pixels, &mut [])?;
    for (number, ((name, surface), in_fog)) in (0..).zip(tiles) {
        let name = if in_fog { format!("{name}, fog") } else { (*name).to_owned() };
        let corner =
            Point::new((number % COLUMNS * TILE.width) as i32, (number / COLUMNS * TILE.height) as i32);
        let area = Rectangle::new(corner, TILE);
        let Ok(()) = sheet.clipped(&area).fill_contiguous(&area, tile(&name, *surface, in_fog));
    }
    picture::Rgba::of(&sheet).save(&path)?;
    println!("Written: {}", path.display());
    Ok(())
}

fn main() -> ExitCode {
    let directory = std::env::args_os().nth(1).map_or_else(|| PathBuf::from("out"), PathBuf::from);
    match run(&directory) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::FAILURE
        }
    }
}
