//! A flight through a room with a lit teapot in it and out to a globe, so close to all of them that walls, teapot and
//! Earth pass through the near plane.
//!
//! `cargo run --release --example flythrough` writes `out/flythrough.gif` and `out/flythrough.png` (one of its frames),
//! and prints where they are and what became of the triangles. `-- DIRECTORY [ASSETS]` takes other folders to write to
//! and to read from.

#![expect(clippy::float_arithmetic, reason = "a flight planned on a desktop")]

#[path = "support/model.rs"]
mod model;
#[path = "support/picture.rs"]
mod picture;

use embedded_graphics::{pixelcolor::Rgb565, prelude::*};
use fixel::fixed::types::I16F16;
use fixel::prelude::*;
use fixel::shapes::{self, Shape};
use fixel::{Stats, shapes::Counts};
use indicatif::{ProgressBar, ProgressStyle};
use std::error::Error;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

const SIZE: Size = Size::new(240, 180);
const FRAMES: u32 = 84;
/// The frame that becomes the PNG.
const SHOWN: u32 = 28;
const ASSETS: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/examples/assets");
const SKY: Rgb565 = Rgb565::new(9, 26, 24);

const fn counts(columns: usize, rows: usize) -> Counts {
    Counts::grid(columns, rows)
}

/// Walls of 8 × 3.5, in parts that the lamp lights each for itself; the bricks of the picture stand, so the picture is
/// turned on loading. 64 texels a unit.
type Wall = Shape<{ counts(8, 4).vertices }, { counts(8, 4).triangles }>;
static WALL: Wall = shapes::grid(8.0, 3.5, 8, 4, [512, 224]);
/// Beside a door 2 wide, and above it.
type Jamb = Shape<{ counts(3, 4).vertices }, { counts(3, 4).triangles }>;
static JAMB: Jamb = shapes::grid(3.0, 3.5, 3, 4, [192, 224]);
type Lintel = Shape<{ counts(2, 1).vertices }, { counts(2, 1).triangles }>;
static LINTEL: Lintel = shapes::grid(2.0, 1.0, 2, 1, [128, 64]);
type Floor = Shape<{ counts(8, 8).vertices }, { counts(8, 8).triangles }>;
static FLOOR: Floor = shapes::grid(8.0, 8.0, 8, 8, [1024, 1024]);
/// 15 × 15, to be scaled to 150 × 150: the picture 30 times across.
static GROUND: Shape<4, 2> = shapes::quad(15.0, 15.0, [1920, 1920]);

static SUN_AND_LAMP: [Light; 2] = [
    Light::directional(Vec3::lit(-0.5, -0.8, -0.35), [150, 145, 130]),
    Light::point(Vec3::lit(0.8, 2.6, 0.6), [200, 165, 110], I16F16::lit("7")),
];
static INSIDE: Lights = Lights::new([60, 58, 64], &SUN_AND_LAMP);
static OUTSIDE: Lights = Lights::new([80, 84, 96], SUN_AND_LAMP.split_at(1).0);

/// Where the camera is, what it looks at, and for how many frames it is on its way to the next.
const FLIGHT: [([f32; 3], [f32; 3], u32); 8] = [
    ([3.5, 2.6, 12.0], [0.0, 1.2, 0.0], 14),
    ([0.4, 1.5, 5.6], [0.0, 1.1, 0.0], 12),
    ([0.9, 1.2, 2.1], [0.0, 0.9, 0.0], 12),
    ([-0.55, 1.05, 1.0], [0.1, 0.75, 0.0], 12),
    ([-1.6, 1.5, -0.6], [0.0, 1.3, -4.5], 10),
    ([0.0, 1.4, -3.4], [0.0, 1.6, -9.0], 12),
    ([0.7, 1.7, -6.4], [0.0, 1.9, -9.0], 12),
    ([1.25, 2.1, -7.9], [-0.4, 1.9, -9.6], 0),
];

fn vec3([x, y, z]: [f32; 3]) -> Vec3 {
    Vec3::lit(x, y, z)
}

/// The camera's pose in a frame.
fn flight(frame: u32) -> Pose {
    let poses = FLIGHT.map(|(at, to, _)| {
        *Camera::focal(1.0, SIZE).at(vec3(at)).look_at(vec3(to), vec3([0.0, 1.0, 0.0])).placement()
    });
    let mut since = frame;
    for (i, pair) in poses.windows(2).enumerate() {
        let length = FLIGHT[i].2;
        if since < length {
            // Slow at both ends.
            let t = since as f32 / length as f32;
            return pair[0].interpolate(&pair[1], I16F16::from_num(t * t * (3.0 - 2.0 * t)));
        }
        since -= length;
    }
    poses[FLIGHT.len() - 1]
}

struct Scene {
    brick: picture::Picture,
    gravel: picture::Picture,
    grass: picture::Picture,
    earth: picture::Picture,
    teapot: model::Model,
    globe: model::Model,
}

impl Scene {
    fn load(assets: &Path) -> Result<Self, Box<dyn Error>> {
        let picture = |name: &str, tint| picture::Picture::open(&assets.join(name), tint);
        Ok(Self {
            brick: picture("brick.png", [1.5, 0.95, 0.75])?.turned()?,
            gravel: picture("gravel.png", [1.0, 0.9, 0.75])?,
            grass: picture("grass.png", [0.55, 0.95, 0.35])?,
            earth: picture("earth.jpg", [1.2, 1.2, 1.2])?,
            teapot: model::Model::open(&assets.join("teapot.obj"), 2.4, [0.0; 2])?,
            globe: model::Model::open(&assets.join("globe.obj"), 3.0, [512.0, 256.0])?,
        })
    }

    fn draw(
        &self,
        frame: u32,
        band: &mut Band<'_, Rgb565, Depth16>,
        stats: &mut Stats,
    ) -> Result<(), Box<dyn Error>> {
        let Ok(()) = band.clear(SKY);
        band.clear_depth();
        let camera = Camera::perspective(Turn::from_degrees(62), SIZE).near(0.2).pose(flight(frame));
        let mut draw = |mesh: Mesh<'_>, pose: Pose, material: Material<'_>| {
            camera.draw_counted(&mesh, &pose, &material, band, stats);
        };
        let at = |x, y, z| Pose::IDENTITY.at(Vec3::lit(x, y, z));
        let [quarter, half] = [90, 180].map(Turn::from_degrees);

        let ground = at(0.0, -0.02, 0.0).rotated_x(-quarter).scaled_lit(10.0);
        draw(
            GROUND.mesh(),
            ground,
            Material::textured(&self.grass.texture()?).texture_scale(2).lit(&OUTSIDE),
        );
        let floor = at(0.0, 0.0, 0.0).rotated_x(-quarter);
        draw(FLOOR.mesh(), floor, Material::textured(&self.gravel.texture()?).lit(&INSIDE));

        // Walls face inwards, with the lamp; their other side is in the sun.
        let wall = Material::textured(&self.brick.texture()?).two_sided().lit(&INSIDE);
        draw(WALL.mesh(), at(-4.0, 1.75, 0.0).rotated_y(quarter), wall);
        draw(WALL.mesh(), at(4.0, 1.75, 0.0).rotated_y(-quarter), wall);
        for (z, turn) in [(4.0, half), (-4.0, Turn::ZERO)] {
            draw(JAMB.mesh(), at(-2.5, 1.75, z).rotated_y(turn), wall);
            draw(JAMB.mesh(), at(2.5, 1.75, z).rotated_y(turn), wall);
            draw(LINTEL.mesh(), at(0.0, 3.0, z).rotated_y(turn), wall);
        }

        let china = Material::flat(Rgb565::new(29, 56, 26)).lit(&INSIDE);
        draw(self.teapot.mesh()?, at(0.0, 0.62, 0.0).rotated_y(Turn::from_degrees(-25)), china);
        let earth = Material::textured(&self.earth.texture()?).lit(&OUTSIDE);
        let spin = Turn::from_degrees(-60 + 2 * frame as i32);
        draw(
            self.globe.mesh()?,
            at(0.0, 1.9, -9.6).rotated_y(spin).rotated_z(Turn::from_degrees(-23)),
            earth,
        );
        Ok(())
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
    let mut film = picture::Film::create(&gif, 70)?;
    let progress = ProgressBar::new(FRAMES.into())
        .with_style(ProgressStyle::with_template("{bar:40} frame {pos}/{len}, {elapsed}")?);
    let mut stats = Stats::default();
    for frame in 0..FRAMES {
        scene.draw(frame, &mut band, &mut stats)?;
        let picture = picture::rgba(&band);
        if frame == SHOWN {
            picture.save(&png)?;
        }
        film.frame(picture)?;
        progress.inc(1);
    }
    progress.finish();

    println!("wrote {}", gif.display());
    println!("wrote {}", png.display());
    println!("{FRAMES} frames of {}x{}, a frame:", SIZE.width, SIZE.height);
    println!(
        "  {} meshes, {} of them out of sight",
        stats.meshes / FRAMES,
        stats.meshes_out_of_sight / FRAMES
    );
    println!(
        "  {} triangles of the others, {} transforms",
        stats.triangles / FRAMES,
        stats.transformed / FRAMES
    );
    println!(
        "  {} drawn, {} clipped, {} culled, {} out of sight, {} rejected",
        stats.drawn / FRAMES,
        stats.clipped / FRAMES,
        stats.culled / FRAMES,
        stats.out_of_sight / FRAMES,
        stats.rejected,
    );
    Ok(())
}
