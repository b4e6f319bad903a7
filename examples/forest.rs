//! A forest at dawn: trees that are cut out of their textures, a glass house, and fog that turns into the sky.
//!
//! `cargo run --release --example forest` writes an animation, `out/forest.gif`, and its first frame, `out/forest.png`. `cargo run
//! --release --example forest -- DIRECTORY` writes elsewhere.
//!
//! All of it is drawn as a display of 240×160 with 16 KiB for a band would get it: a list in bands of 16 rows, on memory that
//! outlives the frames, with a lantern that is made in each frame.

#[allow(dead_code, reason = "pictures are written here, not read")]
#[path = "support/picture.rs"]
mod picture;

use embedded_graphics::pixelcolor::{Rgb565, Rgb888};
use embedded_graphics::prelude::*;
use fixel::num::{I16F16, U10F22};
use fixel::prelude::*;
use fixel::shapes::{self, Shape};
use fixel::{Fog, Gradient, Mask};
use std::convert::Infallible;
use std::error::Error;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

const SCREEN: Size = Size::new(240, 160);
const ROWS: u32 = 16;
const FRAMES: u32 = 96;

/// Side of a tree's texture, in texels.
const SIDE: usize = 64;

/// Two crossed cards, each as wide and high as 2 units, that stand on y = 0.
static TREE: Mesh = Mesh::new(
    &[
        Vertex::new(-1.0, 2.0, 0.0).uv(0, 0),
        Vertex::new(-1.0, 0.0, 0.0).uv(0, 64),
        Vertex::new(1.0, 0.0, 0.0).uv(64, 64),
        Vertex::new(1.0, 2.0, 0.0).uv(64, 0),
        Vertex::new(0.0, 2.0, -1.0).uv(0, 0),
        Vertex::new(0.0, 0.0, -1.0).uv(0, 64),
        Vertex::new(0.0, 0.0, 1.0).uv(64, 64),
        Vertex::new(0.0, 2.0, 1.0).uv(64, 0),
    ],
    &[[0, 1, 2], [0, 2, 3], [4, 5, 6], [4, 6, 7]],
);

/// 128 units wide and long, in a pose that is scaled by 16.
static GROUND: Mesh = Mesh::new(
    &[
        Vertex::new(-4.0, 0.0, -4.0).uv(-256, -256).normal(0.0, 1.0, 0.0),
        Vertex::new(-4.0, 0.0, 4.0).uv(-256, 256).normal(0.0, 1.0, 0.0),
        Vertex::new(4.0, 0.0, 4.0).uv(256, 256).normal(0.0, 1.0, 0.0),
        Vertex::new(4.0, 0.0, -4.0).uv(256, -256).normal(0.0, 1.0, 0.0),
    ],
    &[[0, 1, 2], [0, 2, 3]],
);

/// A pane of 2 × 2, seen from both sides.
static PANE: Mesh = Mesh::new(
    &[
        Vertex::new(-1.0, 2.0, 0.0),
        Vertex::new(-1.0, 0.0, 0.0),
        Vertex::new(1.0, 0.0, 0.0),
        Vertex::new(1.0, 2.0, 0.0),
    ],
    &[[0, 1, 2], [0, 2, 3]],
);

/// What a lantern lights of the air: bright in the middle, nothing at the rim.
static GLOW: Mesh = Mesh::new(
    &[
        Vertex::new(0.0, 0.0, 0.0).alpha(255),
        Vertex::new(1.0, 0.0, 0.0).alpha(0),
        Vertex::new(0.707, 0.707, 0.0).alpha(0),
        Vertex::new(0.0, 1.0, 0.0).alpha(0),
        Vertex::new(-0.707, 0.707, 0.0).alpha(0),
        Vertex::new(-1.0, 0.0, 0.0).alpha(0),
        Vertex::new(-0.707, -0.707, 0.0).alpha(0),
        Vertex::new(0.0, -1.0, 0.0).alpha(0),
        Vertex::new(0.707, -0.707, 0.0).alpha(0),
    ],
    &[[0, 1, 2], [0, 2, 3], [0, 3, 4], [0, 4, 5], [0, 5, 6], [0, 6, 7], [0, 7, 8], [0, 8, 1]],
);

static LAMP: Shape<42, 80> = shapes::icosphere(0.12, 2);

/// A number that looks random.
fn hash(x: u32, y: u32) -> u32 {
    let mut n = x.wrapping_mul(0x9e37_79b1) ^ y.wrapping_mul(0x85eb_ca6b);
    n = (n ^ n >> 15).wrapping_mul(0x2c1b_3c6d);
    n ^ n >> 12
}

/// A fir: its texels, and which of them are there.
fn fir() -> (Vec<u16>, Vec<u8>) {
    let (mut texels, mut mask) = (vec![0; SIDE * SIDE], vec![0; SIDE * SIDE / 8]);
    for y in 0..SIDE {
        for x in 0..SIDE {
            let from_middle = x.abs_diff(SIDE / 2);
            // Tiers of branches, each wider than the one above.
            let width = (y / 2).saturating_sub(y % 12 / 2) * 5 / 6;
            let noise = hash(x as u32, y as u32) % 5;
            let is_branch = y < 56 && from_middle + noise as usize <= width;
            let is_trunk = y >= 54 && from_middle < 3;
            if is_branch || is_trunk {
                mask[(y * SIDE + x) / 8] |= 0x80 >> (x % 8);
            }
            let shade = (hash(x as u32 / 2, y as u32) % 10) as u16 + (y % 12) as u16;
            let green = Rgb565::new((2 + shade / 6) as u8, (14 + shade) as u8, (4 + shade / 5) as u8);
            let color = if is_trunk { Rgb565::new(9, 12, 4) } else { green };
            texels[y * SIDE + x] = color.into_storage();
        }
    }
    (texels, mask)
}

/// What no texel of a birch is.
const KEY: Rgb565 = Rgb565::CSS_MAGENTA;

/// A birch whose empty texels have the colour [`KEY`].
fn birch() -> Vec<u16> {
    let texel = |x: usize, y: usize| {
        let (dx, dy) = (x as i32 - 32, (y as i32 - 22) * 5 / 4);
        let noise = hash(x as u32 / 2, y as u32 / 2) % 300;
        let is_leaf = dx * dx + dy * dy < 560 + noise as i32 && !hash(x as u32, y as u32).is_multiple_of(8);
        if is_leaf {
            let shade = (hash(x as u32, y as u32 / 2) % 12) as u8;
            Rgb565::new(14 + shade / 2, 34 + shade, 3 + shade / 4)
        } else if dx.abs() < 2 && y > 20 {
            if hash(0, y as u32 / 2).is_multiple_of(4) {
                Rgb565::new(6, 12, 6)
            } else {
                Rgb565::new(27, 54, 26)
            }
        } else {
            KEY
        }
    };
    (0..SIDE * SIDE).map(|i| texel(i % SIDE, i / SIDE).into_storage()).collect()
}

/// Moss and earth.
fn moss() -> Vec<u16> {
    let texel = |x: u32, y: u32| {
        let patch = (hash(x / 8, y / 8) % 8) as u8;
        let grain = (hash(x, y) % 8) as u8;
        Rgb565::new(5 + patch / 2 + grain / 4, 18 + patch + grain, 4 + grain / 3)
    };
    (0..SIDE * SIDE).map(|i| texel((i % SIDE) as u32, (i / SIDE) as u32).into_storage()).collect()
}

/// Where a point is after a turn about the middle of the clearing.
fn around(turn: Turn, point: Vec3) -> Vec3 {
    Pose::IDENTITY.rotated_y(turn).transform_point(point)
}

/// All that stays from frame to frame.
struct Forest {
    fir: (Vec<u16>, Vec<u8>),
    birch: Vec<u16>,
    moss: Vec<u16>,
    sky: Gradient,
}

impl Forest {
    fn new() -> Self {
        let sky = Gradient::new(Rgb888::new(90, 120, 170), Rgb888::new(235, 205, 190), SCREEN.height);
        Self { fir: fir(), birch: birch(), moss: moss(), sky }
    }

    /// Draws a frame to a list.
    fn draw<'a>(
        &'a self,
        frame: u32,
        list: &mut DisplayList<'a, Rgb565, Depth16, 64>,
    ) -> Result<(), Box<dyn Error + 'a>> {
        let of = |texels: &'a [u16]| Texture::try_new(texels, 6, 6);
        let fir = Material::textured(&of(&self.fir.0)?).masked(&Mask::try_new(&self.fir.1, 6, 6)?);
        let birch = Material::textured(&of(&self.birch)?).cut_out(KEY);
        let (fir, birch) = (fir.two_sided(), birch.two_sided());
        let moss = Material::textured(&of(&self.moss)?).texture_scale(2).lit();
        let glass = Material::flat(Rgb565::CSS_SKY_BLUE).alpha(70).two_sided();
        let red_glass = Material::flat(Rgb565::new(31, 24, 14)).multiply().two_sided();
        let glow = Material::flat(Rgb565::new(31, 42, 12)).vertex_alpha().additive();

        let circle = Turn::from_raw(((frame << 16) / FRAMES) as u16);
        let camera = Camera::perspective(Turn::from_degrees(62), SCREEN).near(0.25);
        let eye = around(circle, Vec3::lit(0.0, 1.4, 4.6));
        let camera = camera.at(eye).heading(circle, Turn::from_degrees(-4), Turn::ZERO);

        // A lantern that goes around the house: made in this frame, and gone with it.
        let lamp = around(circle + circle, Vec3::lit(2.2, 0.9, 0.0));
        let lantern = [Light::point(lamp, [255, 190, 90], I16F16::lit("5"))];
        let lights = Lights::new([150, 160, 170], &lantern);
        let fog = Fog::linear(Rgb565::WHITE, I16F16::lit("4"), I16F16::lit("20")).towards(&self.sky);
        let view = camera.lit_by(&lights).in_fog(&fog);

        view.draw(&GROUND, &Pose::IDENTITY.scaled_lit(16.0), &moss, list)?;
        for i in 0..56 {
            // In a ring around the clearing, never twice in a place.
            let turn = Turn::from_raw((i * 1171) as u16);
            let far = I16F16::from_num(6 + hash(i, 3) % 12) + I16F16::from_num(hash(i, 4) % 8) / 8;
            let at = around(turn, Vec3::new(far, I16F16::ZERO, I16F16::ZERO));
            let size = U10F22::from_num(10 + hash(i, 5) % 8) / 8;
            let pose = Pose::IDENTITY.rotated_y(Turn::from_raw(hash(i, 6) as u16)).scaled(size);
            let pose = pose.at(at);
            if i % 3 == 0 {
                view.draw(&TREE, &pose, &birch, list)?;
            } else {
                view.draw(&TREE, &pose, &fir, list)?;
            }
        }
        for (i, turn) in (0..4).map(|i| (i, Turn::from_degrees(90 * i))) {
            let wall = Pose::IDENTITY.rotated_y(turn).at(around(turn, Vec3::lit(0.0, 0.0, 1.0)));
            if i == 2 {
                view.draw(&PANE, &wall, &red_glass, list)?;
            } else {
                view.draw(&PANE, &wall, &glass, list)?;
            }
        }
        view.draw(&LAMP.mesh(), &Pose::IDENTITY.at(lamp), &Material::flat(Rgb565::CSS_LEMON_CHIFFON), list)?;
        // It faces the camera.
        let halo = Pose::IDENTITY.rotated_y(circle).at(lamp);
        view.draw(&GLOW, &halo, &glow, list)?;
        Ok(())
    }
}

fn run(directory: &Path) -> Result<(), Box<dyn Error>> {
    std::fs::create_dir_all(directory)?;
    let (film, still) = (directory.join("forest.gif"), directory.join("forest.png"));
    let mut gif = picture::Film::create(&film, SCREEN, 50)?;
    let forest = Forest::new();
    let words = (SCREEN.width * ROWS) as usize;
    let (mut pixels, mut depth) = (vec![0; words], vec![0; words]);
    let mut band = Band::<Rgb565, Depth16>::new(Size::new(SCREEN.width, ROWS), &mut pixels, &mut depth)?;
    let mut memory = Box::new(ListMemory::<600, 500>::new());
    for frame in 0..FRAMES {
        let mut list = DisplayList::new(&mut *memory);
        forest.draw(frame, &mut list).map_err(|error| error.to_string())?;
        let mut colors = Vec::new();
        let Ok(()) = list.render_bands(SCREEN.height, &forest.sky, &mut band, |_, band| {
            colors.extend(band.colors());
            Ok::<_, Infallible>(())
        });
        let picture = picture::Rgba::new(SCREEN, colors.into_iter());
        if frame == 0 {
            let [vertices, triangles, draws] = list.lengths();
            println!("The first frame: {triangles} triangles with {vertices} vertices in {draws} draws");
            picture.save(&still)?;
        }
        gif.frame(picture)?;
    }
    println!("Written: {} and {}", film.display(), still.display());
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
