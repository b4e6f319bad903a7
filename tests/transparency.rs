//! The promise: blending gives the real number that its formula gives, to half a step of the channel; what is cut out or left
//! out by a screen door draws nothing and writes no depth; depth can be switched and biased by each material.

#![allow(clippy::float_arithmetic, reason = "only the crate is to do without")]

use crate::common;

use std::fmt::Debug;

use common::{cases, for_all};
use fixel::embedded_graphics::pixelcolor::Rgb565;
use fixel::embedded_graphics::prelude::*;
use fixel::{
    Band, BigEndian, BlendFormat, Camera, Cull, Depth16, Fragment, Inputs, Mask, Material, Mesh, Pose,
    QuarterPixel, Reach, ScreenVertex, Shader, Surface, Texture, Turn, Varying, Vec3, Vertex, draw_triangle,
    num::{I12F4, I16F16, U1F31, U8F8},
};
use proptest::prelude::*;

/// The greatest values of red, green and blue, and how far up they stand in a word.
const CHANNELS: [(u16, u32); 3] = [(31, 11), (63, 5), (31, 0)];

fn channels(word: u16) -> [u16; 3] {
    CHANNELS.map(|(most, shift)| word >> shift & most)
}

fn word(channels: [u16; 3]) -> u16 {
    channels[0] << 11 | channels[1] << 5 | channels[2]
}

/// Whether `out` is `numerator` / `denominator` to half a step, and so the nearest.
fn is_nearest(out: u16, numerator: i64, denominator: i64) -> bool {
    (2 * (i64::from(out) * denominator - numerator)).abs() <= denominator
}

/// Checks all pairs of a channel's values, the other two being others, with all opacities.
fn formulas_hold<F: BlendFormat<Word = u16>>(to: impl Fn(u16) -> u16, from: impl Fn(u16) -> u16) {
    let mut operands = 0_u64;
    for (i, (most, _)) in CHANNELS.into_iter().enumerate() {
        let m = i64::from(most);
        for (t, s) in (0..=most).flat_map(|t| (0..=most).map(move |s| (t, s))) {
            let (mut target, mut source) = ([t ^ 21, s ^ 42 & 31, t ^ 9], [s ^ 11, t ^ 17, s ^ 30]);
            (target[i], source[i]) = (t, s);
            let [target, source] = [target, source].map(|all| {
                let within = [0, 1, 2].map(|i| all[i] & CHANNELS[i].0);
                to(word(within))
            });
            let of = |word: u16| channels(from(word))[i];
            let (wide_t, wide_s) = (i64::from(t), i64::from(s));
            assert!(is_nearest(of(F::multiply(target, source)), wide_t * wide_s, m), "multiply {t} {s}");
            for a in 0..=255_u8 {
                let alpha = i64::from(a);
                let over = wide_s * alpha + wide_t * (255 - alpha);
                assert!(is_nearest(of(F::over(target, source, a)), over, 255), "over {t} {s} {a}");
                let sum = (255 * wide_t + wide_s * alpha).min(255 * m);
                assert!(is_nearest(of(F::add(target, source, a)), sum, 255), "add {t} {s} {a}");
                operands += 1;
            }
        }
    }
    println!("{operands} operands");
}

#[test]
fn blends_are_within_half_a_step_of_their_formulas_over_all_operands() {
    formulas_hold::<Rgb565>(|word| word, |word| word);
    formulas_hold::<BigEndian<Rgb565>>(u16::to_be, u16::from_be);
}

const SIZE: Size = Size::new(40, 24);
const WORDS: usize = 40 * 24;

/// A picture to draw over, and its depths.
#[derive(Clone)]
struct Scene {
    pixels: Vec<u16>,
    depth: Vec<u16>,
}

impl Scene {
    fn new() -> Self {
        let word = |i: usize| (i as u16).wrapping_mul(40_503) ^ (i as u16 >> 3);
        Self { pixels: (0..WORDS).map(word).collect(), depth: vec![0; WORDS] }
    }

    fn draw<'a>(&mut self, corners: &[ScreenVertex; 3], surface: impl Into<Surface<'a, Rgb565, Depth16>>) {
        let mut band = Band::new(SIZE, &mut self.pixels, &mut self.depth).expect("the scene is small");
        draw_triangle(corners, Cull::None, surface, &mut band).expect("the corners are near");
    }
}

/// A triangle that covers all of it, at a depth.
fn everywhere(q: f64) -> [ScreenVertex; 3] {
    [(-40, -24), (120, -24), (-40, 72)].map(|(x, y)| ScreenVertex {
        x: I12F4::from_num(x),
        y: I12F4::from_num(y),
        q: U1F31::from_num(q),
        ..Default::default()
    })
}

#[test]
fn materials_draw_their_formulas_and_write_no_depth() {
    for_all("materials that blend", 300, (any::<u16>(), any::<u8>(), 0..6_u8), |(color, alpha, kind)| {
        let flat =
            Material::flat(Rgb565::from(fixel::embedded_graphics::pixelcolor::raw::RawU16::new(color)));
        let (before, mut after) = (Scene::new(), Scene::new());
        let corners = everywhere(0.5);
        match kind {
            0 => after.draw(&corners, &flat.alpha(alpha)),
            1 => after.draw(&corners, &flat.alpha(alpha).additive()),
            2 => after.draw(&corners, &flat.multiply()),
            3 => after.draw(&corners, &flat.alpha(alpha).screen_door()),
            4 => after.draw(&corners, &flat.vertex_alpha().alpha(alpha)),
            _ => after.draw(&corners, &flat.depth(true, false)),
        }
        for (i, (&t, &out)) in before.pixels.iter().zip(&after.pixels).enumerate() {
            let expected = match kind {
                0 => Rgb565::over(t, color, alpha),
                1 => Rgb565::add(t, color, alpha),
                2 => Rgb565::multiply(t, color),
                3 if is_door_open(i % 40, i / 40, alpha) => color,
                5 => color,
                // The vertices' alpha is 0.
                _ => t,
            };
            prop_assert_eq!(out, expected, "pixel {}", i);
            let hides = kind == 3 && out == color && is_door_open(i % 40, i / 40, alpha);
            prop_assert_eq!(after.depth[i] != 0, hides, "depth {}", i);
        }
        Ok(())
    });
}

/// Whether a pixel is drawn that is as opaque as this: by Bayer's matrix as its recursion has it.
fn is_door_open(x: usize, y: usize, alpha: u8) -> bool {
    fn bayer(side: usize, x: usize, y: usize) -> usize {
        if side == 1 {
            return 0;
        }
        let half = side / 2;
        let quarter = [[0, 2], [3, 1]][y / half][x / half];
        4 * bayer(half, x % half, y % half) + quarter
    }
    let t = bayer(8, x % 8, y % 8);
    f64::from(alpha) > 255.0 * (t as f64 + 0.5) / 64.0
}

#[test]
fn of_64_pixels_a_screen_door_draws_as_many_as_alpha_has_64ths() {
    for alpha in 0..=255_u8 {
        let mut scene = Scene::new();
        scene.draw(&everywhere(0.5), &Material::flat(Rgb565::WHITE).alpha(alpha).screen_door());
        for (left, top) in [(0, 0), (8, 8), (3, 5), (31, 13)] {
            let drawn = (0..64).filter(|i| scene.depth[(top + i / 8) * 40 + left + i % 8] != 0).count();
            let exact = f64::from(alpha) * 64.0 / 255.0;
            assert!((drawn as f64 - exact).abs() <= 0.5, "{drawn} of alpha {alpha}");
        }
    }
}

#[test]
fn alpha_is_blended_between_vertices() {
    for_all(
        "alpha of vertices",
        200,
        (
            [[0..640_i16, 0..384_i16], [0..640_i16, 0..384_i16], [0..640_i16, 0..384_i16]],
            any::<[u8; 3]>(),
            any::<u8>(),
        ),
        |(places, alphas, alpha)| {
            let corners: [ScreenVertex; 3] = std::array::from_fn(|i| ScreenVertex {
                x: I12F4::from_bits(places[i][0]),
                y: I12F4::from_bits(places[i][1]),
                q: U1F31::from_num(0.5),
                // Blue is of no meaning.
                color: [U8F8::from(alphas[i]), U8F8::ZERO, U8F8::from(7)],
                ..Default::default()
            });
            let mut scene = Scene::new();
            scene.pixels.fill(0);
            let white = Material::flat(Rgb565::WHITE).vertex_alpha().alpha(alpha).depth(true, true);
            scene.draw(&corners, &white);
            let at = |i: usize| places[i].map(|at| f64::from(at) / 16.0);
            let [a, b, c] = [0, 1, 2].map(at);
            let cross = |a: [f64; 2], b: [f64; 2], p: [f64; 2]| {
                (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0])
            };
            let area = cross(a, b, c);
            for i in (0..WORDS).filter(|&i| scene.depth[i] != 0) {
                let p = [(i % 40) as f64 + 0.5, (i / 40) as f64 + 0.5];
                let weights = [cross(b, c, p), cross(c, a, p), cross(a, b, p)].map(|w| w / area);
                let exact = |of: [u8; 3]| (0..3).map(|i| weights[i] * f64::from(of[i])).sum::<f64>();
                // Half a level of opacity for the vertices', and half a one for the product.
                let opacity = exact(alphas) * f64::from(alpha) / 255.0;
                let most = alphas.into_iter().max().unwrap_or_default();
                let least = alphas.into_iter().min().unwrap_or_default();
                // What it changes over a pixel counts ¼, as for every attribute.
                let slope = f64::from(most - least) * 16.0 / area.abs().max(1e-9) * 64.0;
                let tolerance = 1.1 + slope.min(255.0) / 4.0;
                let green = f64::from(channels(scene.pixels[i])[1]) * 255.0 / 63.0;
                prop_assert!(
                    (green - opacity).abs() <= tolerance + 255.0 / 63.0 / 2.0,
                    "pixel {}: {} is not {}",
                    i,
                    green,
                    opacity
                );
            }
            Ok(())
        },
    );
}

/// A texture of 64 × 64 whose texels name their place: u in the lower, v in the upper bits, and bit 12, so that none is 0.
fn places() -> Vec<u16> {
    (0..64 * 64).map(|i| 1 << 12 | i).collect()
}

/// A sprite of 16 × 16 texels, a texel a pixel, from (u, v) on.
fn sprite(left: i32, top: i32, u: i32, v: i32) -> [[ScreenVertex; 3]; 2] {
    let corner = |x: i32, y: i32| ScreenVertex {
        x: I12F4::from_num(left + x),
        y: I12F4::from_num(top + y),
        q: U1F31::from_num(0.25),
        u: I16F16::from_num(u + x),
        v: I16F16::from_num(v + y),
        ..Default::default()
    };
    let [a, b, c, d] = [corner(0, 0), corner(0, 16), corner(16, 16), corner(16, 0)];
    [[a, b, c], [a, c, d]]
}

#[test]
fn sprites_are_cut_out_texel_by_texel() {
    let texels = places();
    let texture = Texture::new(&texels, 6, 6);
    for_all(
        "cut-out sprites",
        60,
        ([0..24_i32, 0..8_i32, -100..100_i32, -100..100_i32], any::<[u8; 32]>(), 0..3_u8),
        |([left, top, u, v], bits, kind)| {
            let mask = Mask::new(&bits, 4, 4);
            let key = 1 << 12 | ((v + 3).rem_euclid(64) << 6 | (u + 5).rem_euclid(64)) as u16;
            let before = Scene::new();
            let mut after = before.clone();
            let textured = Material::textured(&texture);
            let key_color = fixel::embedded_graphics::pixelcolor::raw::RawU16::new(key).into();
            for corners in &sprite(left, top, u, v) {
                match kind {
                    0 => after.draw(corners, &textured.masked(&mask)),
                    1 => after.draw(corners, &textured.masked(&mask).exact()),
                    _ => after.draw(corners, &textured.cut_out(key_color)),
                }
            }
            for i in 0..WORDS {
                let (x, y) = ((i % 40) as i32 - left, (i / 40) as i32 - top);
                let [column, row] = [u + x, v + y].map(|at| at.rem_euclid(64));
                let texel = 1 << 12 | (row << 6 | column) as u16;
                let is_there = match kind {
                    2 => texel != key,
                    _ => bits[(row % 16 * 2 + column % 16 / 8) as usize] << (column % 8) & 0x80 != 0,
                };
                let is_drawn = (0..16).contains(&x) && (0..16).contains(&y) && is_there;
                let expected = if is_drawn { texel } else { before.pixels[i] };
                prop_assert_eq!(after.pixels[i], expected, "pixel {} {}", x, y);
                prop_assert_eq!(after.depth[i] != 0, is_drawn, "depth {} {}", x, y);
            }
            Ok(())
        },
    );
}

/// Writes down what it is asked, and leaves every third column out.
struct Probe;

impl Shader<Rgb565> for Probe {
    type Quality = QuarterPixel;
    const REACH: Reach = Reach::Place;

    fn inputs(&self) -> Inputs {
        Inputs::Uv
    }

    fn color(&self, _: &Varying) -> u16 {
        unreachable!("fragments are asked for")
    }

    fn fragment(&self, fragment: &Fragment<u16>) -> Option<u16> {
        let [x, y] = fragment.place;
        let depth = (fragment.near_w.to_bits() >> 15) as u16;
        (x % 3 != 0).then_some(fragment.target ^ (x as u16) << 8 ^ y as u16 ^ depth)
    }
}

/// Inverts what is there.
struct Negative;

impl Shader<Rgb565> for Negative {
    type Quality = QuarterPixel;
    const REACH: Reach = Reach::Target;

    fn inputs(&self) -> Inputs {
        Inputs::None
    }

    fn color(&self, _: &Varying) -> u16 {
        unreachable!("fragments are asked for")
    }

    fn fragment(&self, fragment: &Fragment<u16>) -> Option<u16> {
        Some(!fragment.target)
    }
}

#[test]
fn shaders_see_place_distance_and_target() {
    let before = Scene::new();
    let mut after = before.clone();
    let corners = everywhere(0.375);
    after.draw(&corners, Surface::new(&Probe));
    for i in 0..WORDS {
        let (x, y) = (i % 40, i / 40);
        let is_drawn = x % 3 != 0;
        let expected = before.pixels[i] ^ (x as u16) << 8 ^ y as u16 ^ 0x6000;
        assert_eq!(after.pixels[i], if is_drawn { expected } else { before.pixels[i] }, "{x} {y}");
        assert_eq!(after.depth[i], if is_drawn { 0x6000 } else { 0 }, "{x} {y}");
    }
    let depth = after.depth.clone();
    let seen = after.clone();
    after.draw(&everywhere(0.3), Surface::new(&Negative));
    for (i, &stored) in depth.iter().enumerate() {
        let shown = if stored != 0 { seen.pixels[i] } else { !seen.pixels[i] };
        assert_eq!(after.pixels[i], shown);
    }
    assert_eq!(after.depth, depth, "what shows the target writes no depth");
}

#[test]
fn depth_tests_writes_and_biases_are_each_materials_own() {
    for_all(
        "depth of materials",
        300,
        (0.001..0.999_f64, 0.001..0.999_f64, any::<bool>(), any::<bool>(), any::<i16>()),
        |(there, here, tests, writes, bias)| {
            let mut scene = Scene::new();
            scene.draw(&everywhere(there), &Material::flat(Rgb565::RED));
            let stored = scene.depth[0];
            let material = Material::flat(Rgb565::BLUE).depth(tests, writes).depth_bias(bias);
            scene.draw(&everywhere(here), &material);
            let q = (here * f64::from(1_u32 << 31)) as i64;
            let depth = ((q + (i64::from(bias) << 15)).clamp(0, (1 << 31) - 1) >> 15).max(1) as u16;
            // A plane that is constant is set up without an error, but for the ends of its range.
            let is_drawn = !tests || depth > stored;
            let expected = if is_drawn && writes { depth } else { stored };
            for i in 0..WORDS {
                prop_assert_eq!(scene.pixels[i] == Rgb565::BLUE.into_storage(), is_drawn);
                prop_assert_eq!(scene.depth[i], expected);
            }
            Ok(())
        },
    );
}

/// A wall of 4 × 4, and marks that lie in its plane, of other triangles.
fn wall_and_marks() -> ([Vertex; 4], Vec<Vertex>, Vec<[u16; 3]>) {
    let corner = |x: f32, y: f32| Vertex::new(x, y, 0.0);
    let wall = [corner(-2.0, 2.0), corner(-2.0, -2.0), corner(2.0, -2.0), corner(2.0, 2.0)];
    let (mut marks, mut triangles) = (Vec::new(), Vec::new());
    for (left, bottom) in [(-1.7_f32, -1.3_f32), (0.3, 0.7), (-0.9, 0.11), (0.71, -1.61)] {
        let first = marks.len() as u16;
        let (right, top) = (left + 0.83, bottom + 0.61);
        marks.extend([corner(left, top), corner(left, bottom), corner(right, bottom), corner(right, top)]);
        triangles.extend([[first, first + 1, first + 2], [first, first + 2, first + 3]]);
    }
    (wall, marks, triangles)
}

/// How many pixels of the marks the wall hides, and how many there are: from one of many sides.
fn speckle(view: u32, bias: i16) -> (usize, usize) {
    let (wall, marks, triangles) = wall_and_marks();
    let wall = Mesh::try_new(&wall, &[[0, 1, 2], [0, 2, 3]]).expect("a wall");
    let marks = Mesh::try_new(&marks, &triangles).expect("marks");
    let screen = Size::new(160, 120);
    let yaw = Turn::from_degrees((view * 37 % 130) as i32 - 65);
    let pitch = Turn::from_degrees((view * 23 % 100) as i32 - 50);
    let pose = Pose::IDENTITY.rotated_x(pitch).rotated_y(yaw);
    let away = I16F16::from_num(-3) - I16F16::from_num(view % 29) / 4;
    let pose = pose.at(Vec3::new(I16F16::ZERO, I16F16::ZERO, away));
    let camera = Camera::perspective(Turn::from_degrees(60), screen).near(0.1);
    let drawn = |with_wall: bool| {
        let (mut pixels, mut depth) = (vec![0; 160 * 120], vec![0; 160 * 120]);
        let mut band = Band::<Rgb565, Depth16>::new(screen, &mut pixels, &mut depth).expect("a band");
        if with_wall {
            camera.draw(&wall, &pose, &Material::flat(Rgb565::BLUE).cull(Cull::None), &mut band);
        }
        let red = Material::flat(Rgb565::RED).cull(Cull::None).depth_bias(bias);
        camera.draw(&marks, &pose, &red, &mut band);
        pixels
    };
    let (alone, together) = (drawn(false), drawn(true));
    let of_marks = |pixel: &u16| *pixel == Rgb565::RED.into_storage();
    let hidden = alone.iter().zip(&together).filter(|(alone, both)| of_marks(alone) && !of_marks(both));
    (hidden.count(), alone.iter().filter(|pixel| of_marks(pixel)).count())
}

#[test]
fn marks_in_the_plane_of_a_wall_are_whole_with_a_bias_in_300_of_300_views() {
    let views = cases(300);
    let speckled = |bias| (0..views).filter(|&view| speckle(view, bias).0 > 0).count();
    let pixels: usize = (0..views).map(|view| speckle(view, 0).1).sum();
    let by_bias = [0, 2, 4, 6, 8].map(speckled);
    println!("{pixels} pixels; views that speckle, by bias in steps of 2: {by_bias:?} of {views}");
    assert!(by_bias[0] > views as usize / 2 && pixels > 100 * views as usize, "there is nothing to mend");
    assert_eq!(by_bias[4], 0, "with a bias of 8 steps");
}

#[test]
fn a_projected_point_is_seen_where_nothing_is_nearer() {
    for_all(
        "projected points",
        500,
        ([-30..30_i16, -20..20_i16, 5..80_i16], 5..80_i16),
        |([x, y, z], wall)| {
            let camera = Camera::focal(20.0, SIZE).near(0.25);
            let tenths = |at: i16| I16F16::from_num(at) / 10;
            let point = Vec3::new(tenths(x), tenths(y), -tenths(z));
            // A wall that fills the picture.
            let corner = |x: f32, y: f32| Vertex::new(x, y, 0.0);
            let corners = [corner(-7.9, 7.9), corner(-7.9, -7.9), corner(7.9, -7.9), corner(7.9, 7.9)];
            let mesh = Mesh::try_new(&corners, &[[0, 1, 2], [0, 2, 3]]).expect("a wall");
            let pose =
                Pose::IDENTITY.scaled_lit(4.0).at(Vec3::new(I16F16::ZERO, I16F16::ZERO, -tenths(wall)));
            let mut scene = Scene::new();
            let mut band =
                Band::<Rgb565, Depth16>::new(SIZE, &mut scene.pixels, &mut scene.depth).expect("a band");
            camera.draw(&mesh, &pose, &Material::flat(Rgb565::RED), &mut band);
            let Some(at) = camera.project(point) else {
                return Ok(());
            };
            let [column, row] = [at.x, at.y].map(|at| i32::from(at.to_bits()) >> 4);
            let inside = (0..40).contains(&column) && (0..24).contains(&row);
            let seen = at.is_visible_in(&band);
            prop_assert_eq!(seen.is_some(), inside);
            let Some(seen) = seen else {
                return Ok(());
            };
            let stored = band.depth()[(row * 40 + column) as usize];
            prop_assert_eq!(at.depth() > stored, seen);
            // What is equally far may be on either side of rounding.
            if z != wall {
                prop_assert_eq!(seen, z < wall, "{} before {}", z, wall);
            }
            // What was drawn can be changed by hand.
            band.depth_mut()[(row * 40 + column) as usize] = 0;
            prop_assert_eq!(at.is_visible_in(&band), Some(true));
            band.pixels_mut()[0] = 0x1234;
            prop_assert_eq!(band.pixels()[0], 0x1234);
            Ok(())
        },
    );
}

fn assert_debug<T: Debug>(_: &T) {}

#[test]
fn surfaces_and_materials_can_be_printed() {
    assert_debug(&Material::flat(Rgb565::RED).alpha(3));
    assert_debug(&Surface::<Rgb565, Depth16>::new(&Probe));
}
