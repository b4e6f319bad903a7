//! A flight, round and round: through the door of a room without a roof, through the wall of a teapot, around the
//! Earth, into it (where the map is seen from behind) and out at its pole, and back over the wall. Teapot and Earth pass
//! through the near plane.
//!
//! `cargo run --release --example flythrough` writes `out/flythrough.gif` and `out/flythrough.png` (one of its frames),
//! and prints where they are and what became of the triangles. `-- DIRECTORY [ASSETS]` takes other folders to write to
//! and to read from.

#![expect(clippy::float_arithmetic, reason = "a scene built on a desktop")]

#[path = "support/model.rs"]
mod model;
#[path = "support/picture.rs"]
mod picture;
#[path = "support/walls.rs"]
mod walls;

use embedded_graphics::mono_font::{MonoTextStyle, ascii::FONT_5X7};
use embedded_graphics::{pixelcolor::Rgb565, prelude::*, text::Text};
use fixel::fixed::types::I16F16;
use fixel::material::LitTextured;
use fixel::prelude::*;
use fixel::shapes::{self, Counts, Shape};
use fixel::{Stats, Surface, TextureError};
use indicatif::{ProgressBar, ProgressStyle};
use std::error::Error;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use walls::{Wall, Walls};

const SIZE: Size = Size::new(256, 192);
/// Of each of the flight's parts.
const FRAMES_A_PART: u32 = 6;
const FRAMES: u32 = FRAMES_A_PART * FLIGHT.len() as u32;
/// The frame that becomes the PNG.
const SHOWN: u32 = 17;
const ASSETS: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/assets");
/// Its licence asks for it wherever the map is shown.
const CREDIT: &str = "Earth: Solar System Scope, CC BY 4.0";

const LAMP: Vec3 = Vec3::lit(1.9, 2.6, 1.6);
static LIGHTS: Lights = Lights::new(
    [66, 70, 88],
    &[
        Light::directional(Vec3::lit(-0.55, -0.9, -0.5), [190, 174, 148]),
        Light::point(LAMP, [185, 140, 80], I16F16::lit("6")),
    ],
);

/// 15 × 15, scaled to 300 × 300: the texture, of 64 texels, 150 times across.
static GROUND: Shape<4, 2> = shapes::quad(15.0, 15.0, [1200, 1200]);
static PATH: Shape<4, 2> = shapes::quad(2.0, 14.0, [160, 1120]);
const FLOOR_CELLS: Counts = Counts::grid(12, 12);
static FLOOR: Shape<{ FLOOR_CELLS.vertices }, { FLOOR_CELLS.triangles }> =
    shapes::grid(11.6, 11.6, 12, 12, [580, 580]);
static STAND: Shape<98, 92> = shapes::cylinder(0.95, 0.9, 24, [384, 64], [128, 128]);
static FOOT: Shape<98, 92> = shapes::cylinder(0.3, 0.8, 24, [128, 64], [32, 32]);
static RING: Shape<288, 576> = shapes::torus(0.42, 0.09, 24, 12);
const BALL: Counts = Counts::icosphere(4);
static SPHERE: Shape<{ BALL.vertices }, { BALL.triangles }> = shapes::icosphere(1.0, 4);

/// Models are decoded this large, which leaves them all of I4F12's bits, and made small by their poses.
const MODEL: f32 = 15.0;
const TEAPOT: Vec3 = Vec3::lit(-0.45, 1.53, 2.4);
const EARTH: Vec3 = Vec3::lit(0.0, 1.9, -1.9);

/// Where the camera is drawn towards, one after another, and where it looks from there.
enum Key {
    /// From a place to a place.
    To([f32; 3], [f32; 3]),
    /// At a distance from the Earth's middle, so many degrees around it and up.
    Orbit(f32, i32, i32),
}
use Key::{Orbit, To};
const FLIGHT: [Key; 18] = [
    To([3.4, 2.5, 14.0], [0.3, 1.6, 0.0]),
    To([1.2, 1.8, 11.0], [0.0, 1.5, 0.0]),
    To([0.0, 1.5, 7.6], [0.0, 1.5, 0.0]),
    To([0.1, 1.5, 5.2], [-0.1, 1.5, 0.0]),
    To([0.0, 1.5, 3.6], [-0.2, 1.5, 0.0]),
    To([0.0, 1.6, 2.2], [0.0, 1.7, -1.9]),
    Orbit(3.1, 8, 0),
    Orbit(2.7, 50, 4),
    Orbit(2.6, 105, 8),
    Orbit(2.6, 170, 14),
    Orbit(2.6, 235, 14),
    Orbit(2.4, 295, 12),
    Orbit(1.7, 340, 8),
    Orbit(0.3, 360, 8),
    To([0.0, 3.7, -1.4], [0.0, 1.9, -2.4]),
    To([0.6, 5.6, 2.5], [0.0, 1.0, -2.0]),
    To([3.4, 5.4, 8.6], [0.0, 1.2, 0.0]),
    To([4.6, 3.8, 13.4], [0.3, 1.5, 0.0]),
];

impl Key {
    fn pose(&self) -> Pose {
        let lit = |[x, y, z]: [f32; 3]| Vec3::lit(x, y, z);
        let camera = Camera::focal(1.0, SIZE);
        *match *self {
            To(from, to) => camera.at(lit(from)).look_at(lit(to), Vec3::lit(0.0, 1.0, 0.0)),
            Orbit(distance, yaw, pitch) => {
                let [yaw, pitch] = [yaw, pitch].map(Turn::from_degrees);
                camera.orbit(EARTH, I16F16::from_num(distance), yaw, pitch)
            }
        }
        .placement()
    }
}

/// The camera's pose in a frame: on the quadratic B-spline of the keys' poses (de Boor's algorithm), so that neither speed nor
/// turn ever jumps, not even from the last frame to the first.
fn flight(frame: u32) -> Pose {
    let key = |i: u32| FLIGHT[i as usize % FLIGHT.len()].pose();
    let (part, at) = (frame / FRAMES_A_PART, frame % FRAMES_A_PART);
    let t = I16F16::from_num(at) / FRAMES_A_PART as i32;
    let half = t / 2;
    let [before, here, after] = [key(part), key(part + 1), key(part + 2)];
    let first = before.interpolate(&here, half + I16F16::lit("0.5"));
    first.interpolate(&here.interpolate(&after, half), t)
}

/// Four walls around 11 × 11, a door in front and a window behind.
fn room() -> Walls {
    let mut room = Walls::default();
    let columns = [-5.9, -5.5, -4.6, -3.7, -2.7, -1.7, -0.8, 0.8, 1.7, 2.7, 3.7, 4.6, 5.5, 5.9];
    let rows = [-0.2, 0.7, 1.5, 2.5, 3.1, 3.6];
    let mut wall = |middle, right, opening, rows: &[f32]| {
        room.wall(&Wall { middle, right, columns: &columns, rows, opening });
    };
    wall([0.0, 0.0, 5.9], [1.0, 0.0, 0.0], Some([6..7, 0..3]), &rows);
    wall([0.0, 0.0, -5.9], [-1.0, 0.0, 0.0], Some([5..8, 2..4]), &rows);
    // The other two run through these, a little lower: tops at one height would fight for their pixels.
    let lower = [-0.2, 0.7, 1.5, 2.5, 3.1, 3.5];
    wall([5.88, 0.0, 0.0], [0.0, 0.0, -1.0], None, &lower);
    wall([-5.88, 0.0, 0.0], [0.0, 0.0, 1.0], None, &lower);
    room
}

/// A sphere's vertices, coloured from haze to a deeper blue.
fn sky() -> Vec<Vertex> {
    let colored = |vertex: &Vertex| {
        let height = f32::from(vertex.position[1]).max(0.0).sqrt();
        let [r, g, b] = [[196.0, 70.0], [212.0, 122.0], [214.0, 190.0]]
            .map(|[low, high]| (low + (high - low) * height) as u8);
        vertex.color(r, g, b)
    };
    SPHERE.mesh().vertices().iter().map(colored).collect()
}

/// A picture on a surface in the light.
fn lit(picture: &picture::Picture) -> Result<Material<'_, LitTextured>, TextureError> {
    Ok(Material::textured(&picture.texture()?).lit())
}

struct Scene {
    brick: picture::Picture,
    gravel: picture::Picture,
    paving: picture::Picture,
    grass: picture::Picture,
    earth: picture::Picture,
    teapot: model::Model,
    globe: model::Model,
    room: Walls,
    sky: Vec<Vertex>,
}

impl Scene {
    fn load(assets: &Path) -> Result<Self, Box<dyn Error>> {
        // There are no mipmaps: pictures as small as they are seen shimmer less.
        let picture =
            |name: &str, halvings, tint| picture::Picture::open(&assets.join(name), tint)?.halved(halvings);
        Ok(Self {
            brick: picture("brick.png", 1, [1.7, 1.0, 0.78])?,
            gravel: picture("gravel.png", 2, [1.25, 1.12, 0.92])?,
            paving: picture("brick.png", 1, [0.95, 1.0, 1.05])?,
            grass: picture("grass.png", 2, [0.75, 1.0, 0.45])?,
            earth: picture::Picture::open(&assets.join("earth.jpg"), [1.3, 1.3, 1.3])?,
            teapot: model::Model::open(&assets.join("teapot.obj"), MODEL, [0.0; 2])?,
            globe: model::Model::open(&assets.join("globe.obj"), MODEL, [512.0, 256.0])?,
            room: room(),
            sky: sky(),
        })
    }

    fn draw(&self, frame: u32, band: &mut Band<'_, Rgb565, Depth16>) -> Result<Stats, Box<dyn Error>> {
        band.clear_depth();
        let mut stats = Stats::default();
        let camera = Camera::perspective(Turn::from_degrees(62), SIZE).near(0.125).pose(flight(frame));
        let view = camera.lit_by(&LIGHTS);
        let mut draw = |mesh: Mesh<'_>, pose: Pose, surface: Surface<'_, Rgb565, Depth16>| {
            view.draw_counted(&mesh, &pose, surface, band, &mut stats);
        };
        let at = |x, y, z| Pose::IDENTITY.at(Vec3::lit(x, y, z));
        let painted = |red, green, blue| Material::flat(Rgb565::new(red, green, blue)).lit();
        let [left, half] = [90, 180].map(Turn::from_degrees);
        let (china, brass) = (painted(29, 57, 27), painted(28, 46, 10));
        let [brick, gravel] = [lit(&self.brick)?, lit(&self.gravel)?];
        let [paving, grass, earth] = [lit(&self.paving)?, lit(&self.grass)?, lit(&self.earth)?];

        let (ball, triangles) = (SPHERE.mesh(), SPHERE.mesh().triangles().collect::<Vec<_>>());
        let around = camera.placement().translation;
        let dome = Pose::IDENTITY.scaled_lit(200.0).at(around);
        draw(Mesh::try_new(&self.sky, &triangles)?, dome, (&Material::gouraud().cull(Cull::Front)).into());

        // Each of these lies over the next.
        draw(FLOOR.mesh(), at(0.0, 0.0, 0.0).rotated_x(-left), (&paving).into());
        draw(PATH.mesh(), at(0.0, -0.06, 12.6).rotated_x(-left), (&gravel).into());
        draw(
            GROUND.mesh(),
            at(0.0, -0.14, 0.0).rotated_x(-left).scaled_lit(20.0),
            (&grass.texture_scale(3)).into(),
        );
        draw(self.room.mesh()?, Pose::IDENTITY, (&brick).into());

        // Flown through: both have insides.
        draw(STAND.mesh(), at(-0.45, 0.45, 2.4), (&gravel).into());
        let turned = Pose::IDENTITY.rotated_y(Turn::from_degrees(-35));
        draw(self.teapot.mesh()?, turned.scaled_lit(2.6 / MODEL).at(TEAPOT), (&china.two_sided()).into());
        draw(FOOT.mesh(), at(0.0, 0.39, -1.9), (&gravel).into());
        draw(RING.mesh(), at(0.0, 0.775, -1.9).rotated_x(left), (&brass).into());
        let tilted = Pose::IDENTITY.rotated_y(half).rotated_z(Turn::from_degrees(-23));
        draw(self.globe.mesh()?, tilted.scaled_lit(2.2 / MODEL).at(EARTH), (&earth.two_sided()).into());
        draw(
            ball,
            Pose::IDENTITY.scaled_lit(0.1).at(LAMP),
            (&Material::flat(Rgb565::new(31, 60, 22))).into(),
        );

        let style = MonoTextStyle::new(&FONT_5X7, Rgb565::WHITE);
        let Ok(_) = Text::new(CREDIT, Point::new(4, SIZE.height as i32 - 5), style).draw(band);
        Ok(stats)
    }
}

fn main() -> ExitCode {
    match run() {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("flythrough: {error}");
            ExitCode::FAILURE
        }
    }
}

fn run() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args_os().skip(1);
    let directory = arguments.next().map_or_else(|| PathBuf::from("out"), PathBuf::from);
    let assets = arguments.next().map_or_else(|| PathBuf::from(ASSETS), PathBuf::from);
    let scene = Scene::load(&assets)?;

    let area = (SIZE.width * SIZE.height) as usize;
    let (mut pixels, mut depth) = (vec![0; area], vec![0; area]);
    let mut band = Band::new(SIZE, &mut pixels, &mut depth)?;
    std::fs::create_dir_all(&directory)?;
    let (gif, png) = (directory.join("flythrough.gif"), directory.join("flythrough.png"));
    let mut film = picture::Film::create(&gif, SIZE, 60)?;
    let progress = ProgressBar::new(FRAMES.into())
        .with_style(ProgressStyle::with_template("{bar:40} frame {pos}/{len}, {elapsed}")?);
    let mut all = Vec::new();
    for frame in 0..FRAMES {
        all.push(scene.draw(frame, &mut band)?);
        let picture = picture::Rgba::of(&band);
        if frame == SHOWN {
            picture.save(&png)?;
        }
        film.frame(picture)?;
        progress.inc(1);
    }
    progress.finish();

    println!("wrote {}", gif.display());
    println!("wrote {}", png.display());
    println!("{FRAMES} frames of {}x{}, a frame (and the fullest):", SIZE.width, SIZE.height);
    let print = |what: &str, count: fn(&Stats) -> u32| {
        let mean = all.iter().map(count).sum::<u32>() / FRAMES;
        println!("  {mean:5} ({:5}) {what}", all.iter().map(count).max().unwrap_or_default());
    };
    print("meshes", |stats| stats.meshes);
    print("of them out of sight", |stats| stats.meshes_out_of_sight);
    print("triangles of the others", |stats| stats.triangles);
    print("vertices transformed", |stats| stats.transformed);
    print("triangles clipped", |stats| stats.clipped);
    print("culled", |stats| stats.culled);
    print("out of sight", |stats| stats.out_of_sight);
    print("drawn", |stats| stats.drawn);
    Ok(())
}
