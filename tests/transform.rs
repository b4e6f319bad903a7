//! The promise: a vertex is drawn within 1/16 pixel of where the same mesh, pose and camera put it in `f64`, and where it
//! is nearer than ¼ unit the error grows no faster than 1/w; `Camera::project` and `Camera::unproject` agree with that;
//! nothing that is seen is left out with its bounding sphere; the counts of `Stats` add up.
//!
//! `cargo test transform:: -- --nocapture` prints the largest errors, and transforms per vertex.
#![allow(clippy::float_arithmetic, reason = "errors are measured in f64")]

use crate::{common, reference};

use std::cell::RefCell;
use std::collections::HashMap;
use std::marker::PhantomData;

use common::view::{Model, Numbered, lens, placement, position, view};
use common::{Counting, Drawn, Record, Recording, Strip, for_all};
use fixel::embedded_graphics::pixelcolor::Rgb565;
use fixel::embedded_graphics::prelude::{Point, Size};
use fixel::fixed::types::{I2F14, I4F12, I12F4, I16F16, U10F22};
use fixel::shapes::{Shape, cube, grid, icosphere, torus};
use fixel::{
    Band, Camera, Cull, Exact, Inputs, Light, Lights, Material, Mesh, Pose, Quaternion, Shader, Stats,
    Surface, Turn, Varying, Vec3, Vertex,
};
use proptest::prelude::*;
use reference::view::{Lens, Placement};

const STRIP: Strip = Strip::new(160, 120, 0);
const SCREEN: Size = STRIP.size();

fn turns() -> impl Strategy<Value = [Turn; 3]> {
    any::<[u16; 3]>().prop_map(|turns| turns.map(Turn::from_raw))
}

fn world(at: [f64; 3]) -> Vec3 {
    let [x, y, z] = at.map(|at| I16F16::saturating_from_num(at));
    Vec3::new(x, y, z)
}

fn numbers(at: Vec3) -> [f64; 3] {
    [at.x, at.y, at.z].map(|at| f64::from(at.to_bits()) / 65536.0)
}

/// A camera, and what it does not say of itself.
#[derive(Clone, Copy, Debug)]
struct Eye {
    camera: Camera,
    orthographic: bool,
    /// Of the viewport.
    corner: [i32; 2],
}

/// A camera of any kind: perspective or orthographic, off-axis or not, with a viewport that is all of the screen or not.
fn eyes() -> impl Strategy<Value = Eye> {
    prop_oneof![2 => eyes_of(false), 1 => eyes_of(true)]
}

fn eyes_of(orthographic: bool) -> impl Strategy<Value = Eye> {
    let off = || prop_oneof![2 => Just(0_i16), 1 => -1600..1600_i16];
    let corner = || prop_oneof![2 => Just(0), 1 => -100..100_i32];
    let lens = (10.0..600.0_f32, [off(), off()], [corner(), corner()]);
    let reach = prop_oneof![1 => Just(1.0), 1 => Just(1000.0), 1 => Just(20_000.0_f64)];
    (lens, turns(), reach, [-1.0..1.0_f64, -1.0..1.0, -1.0..1.0]).prop_map(
        move |((focal, off, corner), [yaw, pitch, roll], reach, at)| {
            let camera = if orthographic {
                Camera::orthographic(focal / 16.0, SCREEN)
            } else {
                // As near as it goes.
                Camera::focal(focal, SCREEN).near(0.0)
            };
            let [right, down] = off.map(I12F4::from_bits);
            let camera = camera.viewport(Point::new(corner[0], corner[1])).off_axis(right, down);
            let camera = camera.heading(yaw, pitch, roll).at(world(at.map(|at| at * reach)));
            Eye { camera, orthographic, corner }
        },
    )
}

impl Eye {
    fn lens(&self) -> Lens {
        lens(&self.camera, self.orthographic)
    }

    /// Where a place before it (right, up, w) is in the world.
    fn place(&self, [right, up, w]: [f64; 3]) -> [f64; 3] {
        let Placement { rotation, translation, .. } = placement(self.camera.placement());
        [0, 1, 2].map(|i| rotation[i][0] * right + rotation[i][1] * up - rotation[i][2] * w + translation[i])
    }

    /// So many pixels to the right of and above the line of sight, and so far away.
    fn beside(&self, [x, y]: [f64; 2], w: f64) -> [f64; 3] {
        let divisor = if self.orthographic { 1.0 } else { w };
        let [right, up] = [x, y].map(|at| at / self.lens().focal * divisor);
        [right, up, w]
    }

    /// Whether the viewport has this pixel.
    fn shows(&self, (x, y): (i32, i32)) -> bool {
        let inside = |at: i32, corner: i32, side: u32| (corner..corner + side as i32).contains(&at);
        inside(x, self.corner[0], SCREEN.width) && inside(y, self.corner[1], SCREEN.height)
    }
}

#[test]
fn points_in_perspective_are_within_a_32th_of_a_pixel_and_come_back_in_50_000_cases() {
    projected("points in perspective", 50_000, false);
}

#[test]
fn points_without_perspective_are_within_a_32th_of_a_pixel_and_depth_is_linear_in_10_000_cases() {
    projected("points without perspective", 10_000, true);
}

fn projected(name: &str, cases: u32, orthographic: bool) {
    // By the distance: nearer than 2⁻⁸, 2⁻⁶, ¼, 16, and beyond. (Errors in 1/16 pixel.)
    let worst = RefCell::new([0.0_f64; 5]);
    let back = RefCell::new(0.0_f64);
    let place = ([-600.0..600.0_f64, -400.0..400.0], -14.0..12.0_f64);
    for_all(name, cases, (eyes_of(orthographic), place), |(eye, (at, w))| {
        let w = 2_f64.powf(w);
        let Eye { camera, orthographic, .. } = eye;
        let point = world(eye.place(eye.beside(at, w)));
        let exact = view(&camera, &Pose::IDENTITY.at(point), orthographic);
        let Some((at, w)) = exact.screen([0.0; 3]) else { return Ok(()) };
        let (near, far) = (eye.lens().near, eye.lens().far);
        let Some(projected) = camera.project(point) else {
            let inside =
                at.iter().all(|at| (-1022.7..1022.7).contains(at)) && w > near * 1.001 && w < far * 0.999;
            prop_assert!(!inside, "{:?} at {:?}, w {}, is not projected", point, at, w);
            return Ok(());
        };
        let drawn = [projected.x, projected.y].map(|at| f64::from(at.to_bits()));
        let error = (drawn[0] - at[0] * 16.0).abs().max((drawn[1] - at[1] * 16.0).abs());
        let class = [2_f64.powi(-8), 2_f64.powi(-6), 0.25, 16.0].iter().filter(|limit| w >= **limit).count();
        let class = if orthographic { 4 } else { class };
        let worst = &mut worst.borrow_mut()[class];
        *worst = worst.max(error);
        // Rounded, and not much else: 1/32 pixel and 1/1024.
        let room = 0.5 + 16.0 / 1024.0 * if orthographic { 1.0 } else { (0.25 / w).max(1.0) };
        prop_assert!(error <= room, "{} of 1/16 pixel at w {}, {:?} {:?}", error, w, at, camera);
        let q = f64::from(projected.q.to_bits()) / 2_f64.powi(31);
        // A depth step. Of w the last bit is 2⁻²⁴ (times the scale, which is 1 here): half of that is more nearer than 2⁻⁹,
        // and 2⁻²⁰ of q, by which the table of reciprocals is off, is 1/16 of a step.
        let steps =
            if orthographic { 1.0 } else { (exact.q(w) * (2_f64.powi(-9) / w + 1.0 / 16.0)).max(1.0) };
        prop_assert!(
            (q - exact.q(w).min(1.0)).abs() < steps / 65536.0,
            "q {} of {} at w {}",
            q,
            exact.q(w),
            w
        );

        // And back, at that distance along the line of sight: a few of the world's last bits off.
        let distance = I16F16::from_num(w);
        let found = numbers(camera.unproject(projected.x, projected.y, distance));
        let center = eye.lens().center;
        let [right, up] = [drawn[0] / 16.0 - center[0], center[1] - drawn[1] / 16.0];
        let before = eye.beside([right, up], distance.to_num());
        let wanted = eye.place(before);
        // The world ends at 32768, and so does what is before the camera.
        let camera = placement(camera.placement()).translation;
        let moved = [0, 1, 2].map(|i| wanted[i] - camera[i]);
        if before.iter().chain(&wanted).chain(&moved).all(|at| at.abs() < 32767.0) {
            let away = (0..3).map(|i| (found[i] - wanted[i]).abs()).fold(0.0, f64::max) * 65536.0;
            prop_assert!(away <= 3.0, "unprojected {} of 2^-16 away from {:?}", away, wanted);
            let back = &mut back.borrow_mut();
            **back = back.max(away);
        }
        Ok(())
    });
    println!(
        "{name}: off by at most {:.4?} of 1/16 pixel at w below 2^-8, 2^-6, 1/4, 16 and beyond; back within {:.2} of \
         2^-16",
        worst.into_inner(),
        back.into_inner()
    );
}

/// What a mesh leaves on a screen.
fn draw(eye: &Eye, pose: &Pose, mesh: &Mesh<'_>, cull: Cull, stats: &mut Stats) -> Record {
    let mut drawn = Record::blank(STRIP);
    let mut band = Band::<Recording, Counting>::new(SCREEN, &mut drawn.pixels, &mut drawn.depth)
        .expect("the sizes agree");
    let shader = Numbered::<Exact> { number: 0, cull, quality: PhantomData };
    eye.camera.draw_counted(mesh, pose, Surface::new(&shader), &mut band, stats);
    drawn
}

#[test]
fn vertices_are_drawn_where_f64_puts_them_at_scales_of_a_thousandth_to_a_thousand_in_10_000_cases() {
    let counts = RefCell::new([0_u32; 3]);
    let place = || ([-90.0..90.0_f64, -70.0..70.0], 0.3..1.7_f64);
    let cases = (eyes(), [place(), place(), place()], -3.0..3.0_f64, turns());
    for_all("drawn vertices", 10_000, cases, |(eye, places, scale, [a, b, c])| {
        // The mesh stands before the camera three times as far away as its unit is long.
        let scale = U10F22::from_num(10_f64.powf(scale).min(1000.0));
        let size = scale.to_num::<f64>();
        let stands = world(eye.place([0.0, 0.0, 3.0 * size]));
        let pose = Pose::from_quaternion(Quaternion::from_euler(a, b, c)).scaled(scale).at(stands);
        let Placement { rotation, translation, .. } = placement(&pose);
        let vertices = places.map(|(at, w)| {
            let place = eye.place(eye.beside(at, w * 3.0 * size));
            let away = [0, 1, 2].map(|i| place[i] - translation[i]);
            let turned = [0, 1, 2].map(|i| (0..3).map(|k| rotation[k][i] * away[k]).sum::<f64>() / size);
            Vertex { position: turned.map(|at| I4F12::saturating_from_num(at)), ..Vertex::default() }
        });
        let exact = view(&eye.camera, &pose, eye.orthographic);
        let mut corners =
            [reference::Corner { x: 0, y: 0, q: 1 << 20, attributes: [0; reference::ATTRIBUTES] }; 3];
        for (corner, vertex) in corners.iter_mut().zip(&vertices) {
            let lens = eye.lens();
            let on_screen = exact.screen(position(vertex)).filter(|(at, w)| {
                let between = *w > lens.near * 1.01 && *w < lens.far * 0.99;
                between && at.iter().all(|at| at.abs() < 1020.0)
            });
            let Some((at, w)) = on_screen else {
                counts.borrow_mut()[1] += 1;
                return Ok(());
            };
            // Where the middle between two places is so close, either is right: 1/256 pixel.
            let doubt = 1.0 / 16.0 * if eye.orthographic { 1.0 } else { (0.25 / w).max(1.0) };
            if at.iter().any(|at| ((at * 16.0).rem_euclid(1.0) - 0.5).abs() < doubt) {
                counts.borrow_mut()[2] += 1;
                return Ok(());
            }
            [corner.x, corner.y] = at.map(|at| (at * 16.0).round() as i32);
        }
        counts.borrow_mut()[0] += 1;
        let triangle = reference::Triangle(corners);
        let drawn = draw(&eye, &pose, &Mesh::new(&vertices, &[[0, 1, 2]]), Cull::None, &mut Stats::default());
        for ((x, y), _, met) in drawn.iter() {
            let inside = eye.shows((x, y)) && triangle.covers(x, y);
            prop_assert_eq!(met.times, u32::from(inside), "at {}, {} of {:?}, scale {}", x, y, corners, size);
        }
        Ok(())
    });
    let [held, out, unsure] = counts.into_inner();
    println!(
        "drawn vertices: {held} triangles drawn pixel for pixel as snapped from f64; {out} out of the picture, {unsure} \
         within 1/256 pixel of the middle between two places"
    );
    assert!(held > common::cases(10_000) / 5);
}

static GRID: Shape<1089, 2048> = grid(15.0, 15.0, 32, 32, [256, 256]);
static RING: Shape<500, 1000> = torus(5.0, 2.0, 25, 20);
static BALL: Shape<642, 1280> = icosphere(7.9, 8);
static CUBE: Shape<24, 12> = cube(12.0, [64, 64]);

#[test]
fn no_mesh_is_left_out_that_has_a_pixel_and_counts_add_up_in_4_000_cases() {
    seen_or_left_out("left out", 4_000, eyes(), turned());
}

#[test]
fn no_stretched_or_mirrored_mesh_is_left_out_and_fronts_stay_fronts_in_4_000_cases() {
    seen_or_left_out("stretched, mirrored", 4_000, mirrored_eyes(), stretched());
}

/// A pose at the origin that turns and scales, and how long an axis of it is.
fn turned() -> impl Strategy<Value = (Pose, f64)> {
    (-3.0..3.0_f64, turns()).prop_map(|(scale, [a, b, c])| {
        let scale = U10F22::from_num(10_f64.powf(scale));
        (Pose::from_quaternion(Quaternion::from_euler(a, b, c)).scaled(scale), scale.to_num())
    })
}

/// As [`turned`], with other sizes and signs along the axes of the mesh.
fn stretched() -> impl Strategy<Value = (Pose, f64)> {
    let factor = || prop_oneof![1 => Just(1.0), 2 => 0.05..1.9_f64];
    let factors = ([factor(), factor(), factor()], any::<[bool; 3]>(), any::<bool>());
    (turned(), factors).prop_map(|((pose, size), (factors, signs, by_matrix))| {
        // Half by the matrix, half by the scales.
        let rotation = pose.rotation.map(|row| {
            [0, 1, 2].map(|axis| {
                let sign = if signs[axis] { -1.0 } else { 1.0 };
                let factor = if by_matrix { factors[axis] } else { 1.0 };
                I2F14::saturating_from_num(row[axis].to_num::<f64>() * factor * sign)
            })
        });
        let scale = pose.scale[0].to_num::<f64>();
        let scales =
            factors.map(|factor| U10F22::from_num(if by_matrix { scale } else { scale * factor * 0.5 }));
        (Pose { rotation, ..pose }.stretched(scales), size)
    })
}

/// Cameras of which half show a mirror image.
fn mirrored_eyes() -> impl Strategy<Value = Eye> {
    (eyes(), prop::option::of(0..3_usize)).prop_map(|(eye, column)| match column {
        Some(column) => Eye { camera: eye.camera.pose(mirrored(eye.camera.placement(), column)), ..eye },
        None => eye,
    })
}

fn mirrored(pose: &Pose, column: usize) -> Pose {
    let mut pose = *pose;
    for row in &mut pose.rotation {
        row[column] = row[column].saturating_neg();
    }
    pose
}

/// A cube that is seen, or not, in so many poses: drawn where `f64` says, its fronts, its backs or both.
fn seen_or_left_out(
    name: &str,
    cases: u32,
    eyes: impl Strategy<Value = Eye>,
    poses: impl Strategy<Value = (Pose, f64)>,
) {
    let counts = RefCell::new([0_u32; 4]);
    let model = Model::new(&CUBE.mesh());
    let mesh = model.mesh();
    let place = ([-400.0..400.0_f64, -300.0..300.0], -4.0..20.0_f64);
    let all = (eyes, place, poses, 0..3_usize, prop::option::weighted(0.3, 0.5..30.0_f64));
    for_all(name, cases, all, |(eye, (at, w), (pose, size), cull, far)| {
        let eye = match far {
            Some(far) => Eye { camera: eye.camera.far((far * size) as f32), ..eye },
            None => eye,
        };
        let pose = pose.at(world(eye.place(eye.beside(at, w * size))));
        let cull = [Cull::None, Cull::Back, Cull::Front][cull];
        let mut stats = Stats::default();
        let drawn = draw(&eye, &pose, &mesh, cull, &mut stats);
        let exact = view(&eye.camera, &pose, eye.orthographic);
        // In a mirror image fronts are clockwise.
        let hand = (exact.handedness()).signum();
        let facets = model
            .triangles
            .iter()
            .map(|corners| exact.facet(corners.map(|i| position(&model.vertices[usize::from(i)]))));
        let facets: Vec<_> = facets
            .filter(|facet| match cull {
                Cull::None => facet.turn != 0.0,
                Cull::Back => facet.turn * hand < 0.0,
                Cull::Front => facet.turn * hand > 0.0,
            })
            .collect();
        let mut seen = false;
        for ((x, y), _, met) in drawn.iter() {
            seen |= met.times > 0;
            // A part of the pixels, as facets may fill the screen.
            if (x + 3 * y) % 7 != 0 {
                continue;
            }
            let depths = || facets.iter().map(|facet| facet.depth([f64::from(x) + 0.5, f64::from(y) + 0.5]));
            let shown = eye.shows((x, y));
            let most = depths().filter(|depth| *depth >= -0.125).count();
            let least = depths().filter(|depth| *depth >= 0.125).count();
            let range = if shown { least..=most } else { 0..=0 };
            prop_assert!(
                range.contains(&(met.times as usize)),
                "{:?} at {}, {}: {:?} {:?}",
                range,
                x,
                y,
                met,
                stats
            );
        }
        let Stats {
            meshes,
            meshes_out_of_sight,
            triangles,
            transformed,
            clipped,
            culled,
            out_of_sight,
            drawn,
        } = stats;
        prop_assert_eq!((meshes, triangles), (1, if meshes_out_of_sight == 1 { 0 } else { 12 }));
        prop_assert!(meshes_out_of_sight <= 1 && clipped <= triangles && transformed <= 3 * triangles);
        // Each triangle ends up in one of these, a clipped one in up to seven parts or in none.
        let ends = culled + out_of_sight + drawn;
        prop_assert!(ends >= triangles - clipped && ends <= triangles + 6 * clipped, "{:?}", stats);
        prop_assert!(drawn > 0 || !seen);
        let mut counts = counts.borrow_mut();
        counts[0] += u32::from(seen);
        counts[1] += meshes_out_of_sight;
        counts[2] += u32::from(meshes_out_of_sight == 0 && !seen);
        counts[3] += u32::from(clipped > 0);
        Ok(())
    });
    let [seen, out, nothing, clipped] = counts.into_inner();
    println!(
        "{name}: {seen} cubes seen, {clipped} of them or of the others clipped, {out} left out whole, {nothing} drawn in vain"
    );
    assert!(seen > common::cases(cases) / 10 && out > common::cases(cases) / 10);
}

/// ±1 across and ±0.2 up and down, in the plane z = 0.
static STRIP_OF_QUAD: [Vertex; 4] = [
    Vertex::new(-1.0, -0.2, 0.0),
    Vertex::new(1.0, -0.2, 0.0),
    Vertex::new(1.0, 0.2, 0.0),
    Vertex::new(-1.0, 0.2, 0.0),
];

#[test]
fn a_quad_that_a_matrix_stretches_into_the_picture_is_drawn() {
    let screen = Strip::new(64, 64, 0);
    let camera = Camera::perspective(Turn::from_degrees(60), screen.size());
    let mesh = Mesh::new(&STRIP_OF_QUAD, &[[0, 1, 2], [0, 2, 3]]);
    let mut rotation = Pose::IDENTITY.rotation;
    rotation[0][0] = I2F14::lit("1.9");
    for (x, near_side) in [(2.2, 0.3), (2.4, 0.5)] {
        let pose = Pose { rotation, ..Pose::IDENTITY }.at(Vec3::lit(x, 0.0, -2.0));
        let mut drawn = Record::blank(screen);
        let mut band = Band::<Recording, Counting>::new(screen.size(), &mut drawn.pixels, &mut drawn.depth)
            .expect("the sizes agree");
        let shader = Numbered::<Exact> { number: 0, cull: Cull::Back, quality: PhantomData };
        camera.draw(&mesh, &pose, Surface::new(&shader), &mut band);
        // 32 px of half a screen are tan 30° of a half; from x = 2.4 - 1.9 to the right border, 0.2 up and down.
        let focal = 32.0 * 3.0_f64.sqrt();
        let (left, half) = (32.0 + focal * near_side / 2.0, focal * 0.2 / 2.0);
        let columns = (0..64).filter(|x| f64::from(*x) + 0.5 > left).count();
        let rows = (0..64).filter(|y| (f64::from(*y) + 0.5 - 32.0).abs() < half).count();
        let count = drawn.iter().filter(|(_, _, met)| met.times == 1).count();
        assert_eq!(count, columns * rows, "at x = {x}");
    }
}

#[test]
fn a_pillar_beside_the_picture_is_left_out_whole() {
    let screen = Strip::new(64, 64, 0);
    // It sees 10 · tan 30° = 5.77 to each side there. 8 units of the pillar are 800 up and down, and 0.8 wide.
    let camera = Camera::perspective(Turn::from_degrees(60), screen.size());
    let pillar = Pose::IDENTITY.stretched_lit(0.1, 100.0, 0.1);
    for (x, is_seen) in [(6.0, true), (-6.0, true), (8.0, false), (-8.0, false)] {
        let mut drawn = Record::blank(screen);
        let mut band = Band::<Recording, Counting>::new(screen.size(), &mut drawn.pixels, &mut drawn.depth)
            .expect("the sizes agree");
        let shader = Numbered::<Exact> { number: 0, cull: Cull::Back, quality: PhantomData };
        let mut stats = Stats::default();
        let pose = pillar.at(Vec3::lit(x, 0.0, -10.0));
        camera.draw_counted(&CUBE.mesh(), &pose, Surface::new(&shader), &mut band, &mut stats);
        assert_eq!(stats.meshes_out_of_sight, u32::from(!is_seen), "at {x}");
        assert_eq!(drawn.iter().any(|(_, _, met)| met.times > 0), is_seen, "at {x}");
    }
}

/// How much light of a source arrives at a place of the world that faces so: 0 … 1.
fn arrives(light: &Source, place: [f64; 3], normal: [f64; 3]) -> f64 {
    let dot = |a: [f64; 3], b: [f64; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    let length = |a: [f64; 3]| dot(a, a).sqrt();
    let (to_light, attenuation) = match *light {
        Source::Direction(direction) => (numbers(direction).map(|at| -at), 1.0),
        Source::Point(at, range) => {
            let at = numbers(at);
            let offset = [0, 1, 2].map(|i| at[i] - place[i]);
            let left = 1.0 - (length(offset) / range.to_num::<f64>()).powi(2);
            (offset, left.max(0.0).powi(2))
        }
    };
    let cosine = dot(normal, to_light) / (length(normal) * length(to_light));
    if cosine.is_nan() { 0.0 } else { cosine * attenuation }
}

/// A light, known to the test.
#[derive(Clone, Copy, Debug)]
enum Source {
    Direction(Vec3),
    Point(Vec3, I16F16),
}

#[test]
fn faces_of_stretched_and_mirrored_cubes_have_the_light_of_their_outer_sides_in_1_000_cases() {
    let model = Model::new(&CUBE.mesh());
    let mesh = model.mesh();
    let direction = || [-1.0..1.0_f64, -1.0..1.0, -1.0..1.0];
    let around = ([-60.0..60.0_f64, -40.0..40.0], 16.0..60.0_f64);
    let cases = (mirrored_eyes(), around, stretched(), any::<bool>(), direction(), 0..3_usize);
    let (pixels, bright, worst) = (RefCell::new(0_u32), RefCell::new(0_u32), RefCell::new(0.0_f64));
    for_all("light on faces", 1_000, cases, |(eye, (at, w), (pose, size), point, light, cull)| {
        let pose = pose.at(world(eye.place(eye.beside(at, w * size))));
        let stands = numbers(pose.translation);
        let source = if point {
            // Somewhere around it, as far as it is large.
            let at = [0, 1, 2].map(|i| stands[i] + light[i] * 20.0 * size);
            Source::Point(world(at), I16F16::saturating_from_num(60.0 * size))
        } else {
            Source::Direction(world(light))
        };
        let lights = [match source {
            Source::Point(at, range) => Light::point(at, [255; 3], range),
            Source::Direction(direction) => Light::directional(direction, [255; 3]),
        }];
        let lights = Lights::new([0; 3], &lights);
        let white = Material::flat(Rgb565::new(31, 63, 31)).lit().faceted().exact();
        let (material, two_sided) = match cull {
            0 => (white, false),
            1 => (white.cull(Cull::Front), false),
            _ => (white.two_sided().cull(Cull::Back), true),
        };
        let mut drawn = Record::blank(STRIP);
        let mut band = Band::<Recording, Counting>::new(SCREEN, &mut drawn.pixels, &mut drawn.depth)
            .expect("the sizes agree");
        eye.camera.lit_by(&lights).draw(&mesh, &pose, &material, &mut band);
        let exact = view(&eye.camera, &pose, eye.orthographic);
        let hand = exact.handedness().signum() * if cull == 1 { -1.0 } else { 1.0 };
        let facets: Vec<_> = model
            .triangles
            .iter()
            .map(|corners| corners.map(|i| position(&model.vertices[usize::from(i)])))
            .map(|corners| (corners, exact.facet(corners)))
            .filter(|(_, facet)| facet.turn * hand < 0.0)
            .collect();
        let to_world = placement(&pose);
        for ((x, y), color, met) in drawn.iter() {
            let point = [f64::from(x) + 0.5, f64::from(y) + 0.5];
            let here = facets.iter().find(|(_, facet)| facet.depth(point) > 0.125);
            let Some((corners, _)) = here.filter(|_| eye.shows((x, y))) else { continue };
            prop_assert!(met.times > 0, "nothing at {}, {}", x, y);
            let middle = [0, 1, 2].map(|i| (corners[0][i] + corners[1][i] + corners[2][i]) / 3.0);
            let truth = arrives(&source, to_world.point(middle), to_world.outwards(*corners));
            let truth = 255.0 * if two_sided { truth.abs() } else { truth.max(0.0) };
            // Whole steps, rounded down.
            let off = truth - f64::from(color.attributes[2]);
            prop_assert!((-1.0..2.0).contains(&off), "{} of {} at {}, {}", color.attributes[2], truth, x, y);
            *pixels.borrow_mut() += 1;
            *bright.borrow_mut() += u32::from(truth > 20.0);
            let worst = &mut *worst.borrow_mut();
            *worst = worst.max((off - 0.5).abs() - 0.5);
        }
        Ok(())
    });
    let (pixels, bright, worst) = (pixels.into_inner(), bright.into_inner(), worst.into_inner());
    println!(
        "light on faces: {pixels} pixels, {bright} of them lit, off by {worst:.3} steps beside rounding"
    );
    assert!(bright > common::cases(1_000) * 100);
}

#[test]
fn a_vertex_is_transformed_about_as_often_as_neighbours_are_apart() {
    let eye = Eye { camera: Camera::focal(200.0, SCREEN), orthographic: false, corner: [0, 0] };
    let pose = Pose::IDENTITY.at(Vec3::lit(0.0, 0.0, -30.0));
    for (name, mesh) in [
        ("grid of 32 x 32 squares", GRID.mesh()),
        ("torus of 25 x 20", RING.mesh()),
        ("icosphere of 1280", BALL.mesh()),
    ] {
        let mut stats = Stats::default();
        draw(&eye, &pose, &mesh, Cull::Back, &mut stats);
        let triangles = mesh.triangles().len();
        assert_eq!((stats.triangles, stats.clipped), (triangles as u32, 0));
        let per_vertex = f64::from(stats.transformed) / mesh.vertices().len() as f64;
        let per_triangle = f64::from(stats.transformed) / triangles as f64;
        println!("{name}: {per_vertex:.2} transforms a vertex, {per_triangle:.2} a triangle");
        // Strips of four squares take five vertices for eight triangles, and one row more at their beginnings.
        assert!(per_vertex >= 1.0 && per_triangle < 0.75, "{stats:?}");
    }
}

/// Another shader's texture, repeated more often.
struct Scaled(Numbered<Exact>, u32);

impl Shader<Recording> for Scaled {
    type Quality = Exact;

    fn inputs(&self) -> Inputs {
        Inputs::Uv
    }

    fn color(&self, varying: &Varying) -> Drawn {
        self.0.color(varying)
    }

    fn texture_scale(&self) -> u32 {
        self.1
    }
}

#[test]
fn one_byte_indices_and_parts_draw_the_same_and_a_texture_scale_multiplies_in_300_cases() {
    let model = Model::new(&CUBE.mesh());
    let bytes: Vec<_> = model.triangles.iter().map(|corners| corners.map(|i| i as u8)).collect();
    let (wide, narrow) =
        (model.mesh(), Mesh::try_new_u8(&model.vertices, &bytes).expect("the indices are in range"));
    let place = ([-100.0..100.0_f64, -80.0..80.0], 0.0..40.0_f64);
    for_all(
        "the same picture",
        300,
        (eyes(), place, turns(), 0..14_usize, 0..=8_u32),
        |(eye, (at, w), [a, b, c], cut, log2)| {
            let pose = Pose::from_quaternion(Quaternion::from_euler(a, b, c))
                .at(world(eye.place(eye.beside(at, w))));
            let (mut once, mut again) = (Stats::default(), Stats::default());
            let picture = draw(&eye, &pose, &wide, Cull::Back, &mut once);
            prop_assert!(picture == draw(&eye, &pose, &narrow, Cull::Back, &mut again));
            prop_assert_eq!(once, again);

            let mut parts = Record::blank(STRIP);
            let mut scaled = Record::blank(STRIP);
            let mut band = Band::<Recording, Counting>::new(SCREEN, &mut parts.pixels, &mut parts.depth)
                .expect("the sizes agree");
            let shader = Numbered::<Exact> { number: 0, cull: Cull::Back, quality: PhantomData };
            for mesh in [wide.part(0, cut), narrow.part(cut, usize::MAX)] {
                eye.camera.draw(&mesh, &pose, Surface::new(&shader), &mut band);
            }
            prop_assert!(picture == parts);
            let mut band = Band::<Recording, Counting>::new(SCREEN, &mut scaled.pixels, &mut scaled.depth)
                .expect("the sizes agree");
            eye.camera.draw(&wide, &pose, Surface::new(&Scaled(shader, log2)), &mut band);
            // Planes hold scaled coordinates, so these are exacter than what is multiplied at the end: both are within 0.02 of the
            // change over a pixel. The latter are rounded before, and lean by up to 21 + (160 + 120)/4 units where surfaces are straight.
            let drawn = picture.iter().filter(|(_, _, met)| met.times > 0);
            let seen: HashMap<_, _> = drawn.map(|(pixel, plain, _)| (pixel, plain.attributes)).collect();
            for ((x, y), scaled, _) in scaled.iter().filter(|(_, _, met)| met.times > 0) {
                for i in 0..2 {
                    let plain = seen[&(x, y)][i];
                    let change = |at| seen.get(&at).map_or(0, |beside: &[i32; 5]| (beside[i] - plain).abs());
                    let change =
                        [(x + 1, y), (x - 1, y), (x, y + 1), (x, y - 1)].map(change).into_iter().max();
                    let off = (plain << log2).wrapping_sub(scaled.attributes[i]).abs();
                    let allowed = (96 + change.unwrap_or(0) / 25) << log2;
                    prop_assert!(off <= allowed, "{} at {:?}: {} units of {}", i, (x, y), off, allowed);
                }
            }
            Ok(())
        },
    );
}

#[test]
fn a_mesh_at_the_worlds_end_is_drawn_where_it_reaches_beyond() {
    // 32 700 away and 800 deep: its back is further than any number of the world.
    let camera = Camera::focal(2000.0, SCREEN);
    let pose = Pose::IDENTITY.scaled(U10F22::from_num(400)).at(world([0.0, 0.0, -32_700.0]));
    let eye = Eye { camera, orthographic: false, corner: [0; 2] };
    let vertices = [Vertex::new(-7.0, -7.0, -7.0), Vertex::new(7.0, -7.0, -7.0), Vertex::new(0.0, 7.0, -7.0)];
    let mut stats = Stats::default();
    let drawn = draw(&eye, &pose, &Mesh::new(&vertices, &[[0, 1, 2]]), Cull::None, &mut stats);
    // Twice the area: base and height are both 14 · 400 units at a distance of 32 700 + 2800.
    let side = 2000.0 * 14.0 * 400.0 / 35_500.0;
    let seen = drawn.iter().filter(|(_, _, met)| met.times > 0).count();
    let inside = drawn.iter().filter(|((x, y), ..)| {
        let (across, down) = (f64::from(*x) + 0.5 - 80.0, f64::from(*y) + 0.5 - 60.0);
        let share = (down + side / 2.0) / side;
        (0.0..1.0).contains(&share) && across.abs() < side / 2.0 * share
    });
    let inside = inside.count();
    assert!(inside > 5000 && seen.abs_diff(inside) < 60, "{seen} of {inside} pixels: {stats:?}");
}
