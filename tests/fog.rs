//! The promise: fog is what its formula says of the view depth, to one step of the target's channel, at every pixel.

#![allow(clippy::float_arithmetic, reason = "only the crate is to do without")]

use crate::common;

use common::for_all;
use fixel::embedded_graphics::pixelcolor::{Rgb565, Rgb888};
use fixel::embedded_graphics::prelude::*;
use fixel::num::{I4F12, I16F16};
use fixel::{
    Background, Band, Camera, Cull, Depth16, DepthFormat, Fog, Gradient, Material, Mesh, NoDepth, Pose,
    Vertex,
};
use proptest::prelude::*;

const SIZE: Size = Size::new(96, 64);
const WORDS: usize = 96 * 64;

/// The formula of some fog.
#[derive(Clone, Debug)]
enum Formula {
    Linear { start: f64, end: f64 },
    Exponential { density: f64 },
    Table { far: f64, entries: Vec<u8> },
}

impl Formula {
    fn fog(&self) -> Fog<'_> {
        let color = Rgb565::new(FOG[0] as u8, FOG[1] as u8, FOG[2] as u8);
        match self {
            Self::Linear { start, end } => {
                Fog::linear(color, I16F16::from_num(*start), I16F16::from_num(*end))
            }
            Self::Exponential { density } => Fog::exponential(color, I16F16::from_num(*density)),
            Self::Table { far, entries } => Fog::table(color, I16F16::from_num(*far), entries),
        }
    }

    /// 0 … 1 at a view depth.
    fn at(&self, w: f64) -> f64 {
        match self {
            Self::Linear { start, end } => ((w - start) / (end - start)).clamp(0.0, 1.0),
            Self::Exponential { density } => 1.0 - (-density * w).exp(),
            Self::Table { far, entries } => {
                let place = (w / far * (entries.len() - 1) as f64).min((entries.len() - 1) as f64);
                let entry = |i: usize| f64::from(entries[i.min(entries.len() - 1)]);
                let (whole, rest) = (place as usize, place.fract());
                (entry(whole) + (entry(whole + 1) - entry(whole)) * rest) / 255.0
            }
        }
    }
}

fn formula() -> impl Strategy<Value = Formula> {
    // All are numbers of I16F16.
    let number = |range: std::ops::Range<f64>| range.prop_map(|at| (at * 65536.0).round() / 65536.0);
    prop_oneof![
        (number(0.0..30.0), number(0.05..40.0)).prop_map(|(start, length)| {
            let end = start + length.max(start / 31.0);
            Formula::Linear { start, end: (end * 65536.0).round() / 65536.0 }
        }),
        number(0.001..2.0).prop_map(|density| Formula::Exponential { density }),
        (number(1.0..60.0), prop::collection::vec(any::<u8>(), 2..24))
            .prop_map(|(far, entries)| Formula::Table { far, entries }),
    ]
}

/// The fog's colour and the surface's, as channels.
const FOG: [u16; 3] = [31, 5, 12];
const SURFACE: [u16; 3] = [2, 60, 20];

/// A corner that projects exactly to a place in 1/16 px, at a distance of 2^log2.
#[derive(Clone, Copy, Debug)]
struct Corner {
    place: [i32; 2],
    log2: u32,
}

impl Corner {
    fn w(&self) -> f64 {
        f64::from(1_u32 << self.log2)
    }

    /// In mesh units, of which one is 8 of the world's: with a focal length of 64 px, or 8 px a unit without perspective.
    fn vertex(&self, orthographic: bool) -> Vertex {
        // 1/16 px at this distance is w/8192 of a mesh unit, and 1/1024 without perspective.
        let unit = if orthographic { 4 } else { 1 << self.log2 >> 1 };
        let at = |place: i32, middle: i32| I4F12::from_bits(((place - middle) * unit) as i16);
        Vertex {
            position: [
                at(self.place[0], 48 * 16),
                -at(self.place[1], 32 * 16),
                I4F12::from_bits(-(512 << self.log2) as i16),
            ],
            ..Vertex::default()
        }
    }
}

fn corner() -> impl Strategy<Value = Corner> {
    ([-500..2000_i32, -500..1500_i32], 1..6_u32).prop_map(|(place, log2)| Corner { place, log2 })
}

/// 1/w, or w without perspective, at a pixel's centre, and whether that lies inside.
fn depth_at(corners: &[Corner; 3], orthographic: bool, x: usize, y: usize) -> Option<f64> {
    let [a, b, c] = corners.map(|corner| corner.place.map(|at| f64::from(at) / 16.0));
    let p = [x as f64 + 0.5, y as f64 + 0.5];
    let cross =
        |a: [f64; 2], b: [f64; 2], p: [f64; 2]| (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0]);
    let area = cross(a, b, c);
    let weights = [cross(b, c, p), cross(c, a, p), cross(a, b, p)].map(|weight| weight / area);
    if weights.iter().any(|weight| weight.is_nan() || *weight < 0.0) {
        return None;
    }
    let of = |f: fn(f64) -> f64| (0..3).map(|i| weights[i] * f(corners[i].w())).sum::<f64>();
    Some(if orthographic { of(|w| w) } else { 1.0 / of(|w| 1.0 / w) })
}

fn channels(word: u16) -> [u16; 3] {
    [word >> 11, word >> 5 & 63, word & 31]
}

fn off_by<D: DepthFormat>(
    corners: &[Corner; 3],
    formula: &Formula,
    orthographic: bool,
) -> Result<(f64, usize), TestCaseError> {
    let vertices = corners.map(|corner| corner.vertex(orthographic));
    let mesh = Mesh::try_new(&vertices, &[[0, 1, 2]]).expect("a triangle");
    let (mut pixels, mut depth) = (vec![0; WORDS], vec![D::CLEAR; WORDS]);
    let mut band = Band::<Rgb565, D>::new(SIZE, &mut pixels, &mut depth).expect("a band");
    let camera = if orthographic { Camera::orthographic(8.0, SIZE) } else { Camera::focal(64.0, SIZE) };
    let color = Rgb565::new(SURFACE[0] as u8, SURFACE[1] as u8, SURFACE[2] as u8);
    let material = Material::flat(color).cull(Cull::None);
    let fog = formula.fog();
    camera.near(0.5).in_fog(&fog).draw(&mesh, &Pose::IDENTITY.scaled_lit(8.0), &material, &mut band);
    let (mut worst, mut count) = (0.0_f64, 0);
    for (i, &word) in pixels.iter().enumerate() {
        if word == 0 {
            continue;
        }
        // Pixels on an edge may lie outside by rounding here.
        let Some(w) = depth_at(corners, orthographic, i % 96, i / 96) else {
            continue;
        };
        count += 1;
        let fog = formula.at(w);
        for (out, (fog_color, color)) in channels(word).into_iter().zip(FOG.into_iter().zip(SURFACE)) {
            let exact = f64::from(color) + (f64::from(fog_color) - f64::from(color)) * fog;
            worst = worst.max((f64::from(out) - exact).abs());
        }
    }
    prop_assert!(worst < 1.0, "{} steps", worst);
    Ok((worst, count))
}

#[test]
fn fog_is_within_a_step_of_its_formula_at_every_pixel() {
    let worst = std::cell::Cell::new((0.0_f64, 0));
    for_all(
        "fog",
        1_500,
        ([corner(), corner(), corner()], formula(), any::<bool>()),
        |(corners, formula, orthographic)| {
            let (off, count) = off_by::<Depth16>(&corners, &formula, orthographic)?;
            let (most, all) = worst.get();
            worst.set((most.max(off), all + count));
            // Without depth, too: what is drawn is the same.
            off_by::<NoDepth>(&corners, &formula, orthographic)?;
            Ok(())
        },
    );
    let (most, pixels) = worst.get();
    println!("fog: at most {most:.3} steps off at {pixels} pixels");
    assert!(pixels > 100_000 && most > 0.5);
}

#[test]
fn what_is_far_away_vanishes_in_the_gradient_behind_it() {
    let sky = Gradient::new(Rgb888::new(10, 90, 200), Rgb888::new(250, 180, 120), 64);
    let fog = Fog::linear(Rgb565::BLACK, I16F16::lit("2"), I16F16::lit("8")).towards(&sky);
    let camera = Camera::focal(64.0, SIZE).near(0.5);
    let corners = [[-400, -400], [2000, 400], [300, 1400]].map(|place| Corner { place, log2: 4 });
    let vertices = corners.map(|corner| corner.vertex(false));
    let mesh = Mesh::try_new(&vertices, &[[0, 1, 2]]).expect("a triangle");
    let (mut pixels, mut depth) = (vec![0; WORDS], vec![0; WORDS]);
    let mut band = Band::<Rgb565, Depth16>::new(SIZE, &mut pixels, &mut depth).expect("a band");
    band.clear_to(&sky);
    let before = band.pixels().to_vec();
    let red = Material::flat(Rgb565::RED).cull(Cull::None);
    camera.in_fog(&fog).draw(&mesh, &Pose::IDENTITY.scaled_lit(8.0), &red, &mut band);
    assert!(band.depth().iter().filter(|&&depth| depth != 0).count() > 1000, "it is there");
    assert_eq!(band.pixels(), before);
    let mut row = [0; 1];
    Background::<Rgb565>::fill_row(&sky, 63, &mut row);
    assert_eq!(pixels[WORDS - 1], row[0]);
}

#[test]
fn lights_fade_to_nothing_and_glass_to_clear_in_fog() {
    let fog = Fog::linear(Rgb565::WHITE, I16F16::lit("2"), I16F16::lit("8"));
    let camera = Camera::focal(64.0, SIZE).near(0.5);
    let corners = [[-400, -400], [2000, 400], [300, 1400]].map(|place| Corner { place, log2: 4 });
    let vertices = corners.map(|corner| corner.vertex(false));
    let mesh = Mesh::try_new(&vertices, &[[0, 1, 2]]).expect("a triangle");
    let before: Vec<u16> = (0..WORDS).map(|i| (i as u16).wrapping_mul(40_503)).collect();
    let (mut pixels, mut depth) = (before.clone(), vec![0; WORDS]);
    let mut band = Band::<Rgb565, Depth16>::new(SIZE, &mut pixels, &mut depth).expect("a band");
    let pose = Pose::IDENTITY.scaled_lit(8.0);
    let (view, red) = (camera.in_fog(&fog), Material::flat(Rgb565::RED).cull(Cull::None));
    view.draw(&mesh, &pose, &red.additive(), &mut band);
    view.draw(&mesh, &pose, &red.multiply(), &mut band);
    assert_eq!(band.pixels(), before);
    view.draw(&mesh, &pose, &red.alpha(255), &mut band);
    let white = band.pixels().iter().filter(|&&word| word == 0xffff).count();
    assert!(white > 1000, "{white}");
}
