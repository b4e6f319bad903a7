//! The main job: a turning, depth-tested, textured cube over a textured floor, with a line of text
//! on top, at 240 × 240.
//!
//! `cargo run --release --example cube` writes `out/cube.gif` (one full turn) and `out/cube.png` (its
//! first frame), and prints where they are and what was drawn. Both can be sent elsewhere:
//! `cargo run --release --example cube -- DIRECTORY [PICTURE]`, PICTURE being a PNG of
//! 2^n × 2^m pixels for the faces.

#![expect(clippy::float_arithmetic, reason = "shares of time, on a desktop")]

#[path = "support/picture.rs"]
mod picture;

use embedded_graphics::mono_font::{MonoTextStyleBuilder, ascii::FONT_8X13_BOLD};
use embedded_graphics::{pixelcolor::Rgb565, prelude::*, text::Text};
use fixel::prelude::*;
use indicatif::{ProgressBar, ProgressStyle};
use std::error::Error;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::{Duration, Instant};

const SIZE: Size = Size::new(240, 240);
const FRAMES: u16 = 72;
const BRICK: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/assets/brick.png");
const NIGHT: Rgb565 = Rgb565::new(2, 5, 6);

/// A face's four corners counter-clockwise, as seen from outside, with the whole texture on it, lying
/// on its side: in `brick.png` the bricks stand.
const fn face(corners: [[f32; 3]; 4]) -> [Vertex; 4] {
    let mut vertices = [Vertex::new(0.0, 0.0, 0.0); 4];
    let mut i = 0;
    while i < 4 {
        let [x, y, z] = corners[i];
        let (u, v) = ((i < 2) as i16 * 256, (i == 0 || i == 3) as i16 * 256);
        vertices[i] = Vertex::new(x, y, z).uv(u, v);
        i += 1;
    }
    vertices
}

const SQUARES: [[u16; 3]; 4] = [[0, 1, 2], [0, 2, 3], [4, 5, 6], [4, 6, 7]];

/// Front and back, right and left, top and bottom: a mesh each, for a shade of its own.
const SIDES: [Mesh; 3] = [
    Mesh::new(
        [
            face([[-1.0, -1.0, 1.0], [1.0, -1.0, 1.0], [1.0, 1.0, 1.0], [-1.0, 1.0, 1.0]]),
            face([[1.0, -1.0, -1.0], [-1.0, -1.0, -1.0], [-1.0, 1.0, -1.0], [1.0, 1.0, -1.0]]),
        ]
        .as_flattened(),
        &SQUARES,
    ),
    Mesh::new(
        [
            face([[1.0, -1.0, 1.0], [1.0, -1.0, -1.0], [1.0, 1.0, -1.0], [1.0, 1.0, 1.0]]),
            face([[-1.0, -1.0, -1.0], [-1.0, -1.0, 1.0], [-1.0, 1.0, 1.0], [-1.0, 1.0, -1.0]]),
        ]
        .as_flattened(),
        &SQUARES,
    ),
    Mesh::new(
        [
            face([[-1.0, 1.0, 1.0], [1.0, 1.0, 1.0], [1.0, 1.0, -1.0], [-1.0, 1.0, -1.0]]),
            face([[-1.0, -1.0, -1.0], [1.0, -1.0, -1.0], [1.0, -1.0, 1.0], [-1.0, -1.0, 1.0]]),
        ]
        .as_flattened(),
        &SQUARES,
    ),
];
const SHADES: [f32; 3] = [1.0, 0.72, 1.25];

/// A floor that goes on behind the camera, the texture six times across: −768 … 768 texels.
const FLOOR: Mesh = Mesh::new(
    &[
        Vertex::new(-6.0, 0.0, 6.0).uv(-768, 768),
        Vertex::new(6.0, 0.0, 6.0).uv(768, 768),
        Vertex::new(6.0, 0.0, -6.0).uv(768, -768),
        Vertex::new(-6.0, 0.0, -6.0).uv(-768, -768),
    ],
    &[[0, 1, 2], [0, 2, 3]],
);

/// Where the time of all frames went.
#[derive(Default)]
struct Times {
    clear: Duration,
    floor: Duration,
    cube: Duration,
    text: Duration,
}

/// The scene's assets.
struct Scene {
    camera: Camera,
    /// For each of [`SIDES`].
    bricks: [picture::Picture; 3],
    paving: picture::Picture,
}

impl Scene {
    fn draw(
        &self,
        frame: u16,
        band: &mut Band<'_, Rgb565, Depth16>,
        times: &mut Times,
    ) -> Result<(), Box<dyn Error>> {
        let start = Instant::now();
        band.clear(NIGHT)?;
        times.clear += start.elapsed();

        let start = Instant::now();
        let floor = Pose::IDENTITY.scaled_lit(2.0).at(Vec3::lit(0.0, -1.75, 0.0));
        self.camera.draw(&FLOOR, &floor, &Material::textured(&self.paving.texture()?), band);
        times.floor += start.elapsed();

        let start = Instant::now();
        let turn = Turn::from_raw((u32::from(frame) * 65536 / u32::from(FRAMES)) as u16);
        let pose = Pose::IDENTITY.rotated_x(Turn::from_degrees(25)).rotated_y(turn);
        for (side, bricks) in SIDES.iter().zip(&self.bricks) {
            self.camera.draw(side, &pose, &Material::textured(&bricks.texture()?), band);
        }
        times.cube += start.elapsed();

        let start = Instant::now();
        let style = MonoTextStyleBuilder::new()
            .font(&FONT_8X13_BOLD)
            .text_color(Rgb565::WHITE)
            .background_color(NIGHT);
        Text::new(" fixel: 3D in integers ", Point::new(28, 18), style.build()).draw(band)?;
        times.text += start.elapsed();
        Ok(())
    }
}

fn main() -> ExitCode {
    match run() {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("cube: {error}");
            ExitCode::FAILURE
        }
    }
}

fn run() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args_os().skip(1);
    let directory = arguments.next().map_or_else(|| PathBuf::from("out"), PathBuf::from);
    let faces = arguments.next().map_or_else(|| PathBuf::from(BRICK), PathBuf::from);

    let bricks =
        |shade| picture::Picture::open(&faces, [1.25, 0.66, 0.48].map(|channel: f32| channel * shade));
    let scene = Scene {
        camera: Camera::perspective(Turn::from_degrees(50), SIZE)
            .at(Vec3::lit(0.0, 1.2, 5.0))
            .look_at(Vec3::lit(0.0, -0.2, 0.0), Vec3::lit(0.0, 1.0, 0.0)),
        bricks: [bricks(SHADES[0])?, bricks(SHADES[1])?, bricks(SHADES[2])?],
        paving: picture::Picture::open(Path::new(BRICK), [0.5, 0.62, 0.7])?,
    };
    let area = (SIZE.width * SIZE.height) as usize;
    let (mut pixels, mut depth) = (vec![0; area], vec![0; area]);
    let mut band = Band::new(SIZE, &mut pixels, &mut depth)?;

    std::fs::create_dir_all(&directory)?;
    let (gif, png) = (directory.join("cube.gif"), directory.join("cube.png"));
    let mut film = picture::Film::create(&gif, SIZE, 40)?;
    let progress = ProgressBar::new(FRAMES.into())
        .with_style(ProgressStyle::with_template("{bar:40} frame {pos}/{len}, {elapsed}")?);
    let mut times = Times::default();
    let mut covered = 0;
    for frame in 0..FRAMES {
        scene.draw(frame, &mut band, &mut times)?;
        covered += band.depth().iter().filter(|&&depth| depth != 0).count();
        let picture = picture::Rgba::of(&band);
        if frame == 0 {
            picture.save(&png)?;
        }
        film.frame(picture)?;
        progress.inc(1);
    }
    progress.finish();

    let triangles = SIDES.iter().chain([&FLOOR]).map(|mesh| mesh.triangles().len()).sum::<usize>();
    let total = times.clear + times.floor + times.cube + times.text;
    let percent = |time: Duration| 100.0 * time.as_secs_f64() / total.as_secs_f64().max(1e-9);
    println!("wrote {}", gif.display());
    println!("wrote {}", png.display());
    println!(
        "{FRAMES} frames of {}x{}: {triangles} triangles and {} covered pixels a frame, {:.0} us a frame on this machine",
        SIZE.width,
        SIZE.height,
        covered / usize::from(FRAMES),
        total.as_secs_f64() * 1e6 / f64::from(FRAMES),
    );
    println!(
        "time: clear {:.0} %, floor {:.0} %, cube {:.0} %, text {:.0} %",
        percent(times.clear),
        percent(times.floor),
        percent(times.cube),
        percent(times.text),
    );
    Ok(())
}
