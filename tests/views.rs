//! The promise: no viewpoint breaks the picture. A camera is flown at random around, into and through meshes, and every
//! pixel is held against what a mathematician says of the same mesh, pose and camera, read back from the crate's numbers.
//!
//! # What is exact and what has room
//!
//! Corners are snapped to 1/16 pixel and may be off by that much, so the picture's outline may be off by less
//! than 1/8 pixel. Hence for each pixel centre:
//!
//! - it must be covered if no place within 1/8 pixel is outside the picture, and must not if none is inside;
//! - where the snapped picture of a mesh is exact whatever the rounding, it is held exactly: what is closed has as
//!   many fronts as backs at every pixel, and of a plane cut into many triangles just one more;
//! - a convex mesh covers a pixel once. A triangle or a piece of one that is thinner than 3/16 pixel may be turned over by
//!   snapping: within 1/8 pixel of such a one nothing is said of how often a pixel is covered.
//!
//! Attributes: a pixel of a snapped triangle has shares λ of its corners. With the same shares of the exact corners one
//! gets to another place, at most as far away as any corner was moved, and there the exact attribute is what the
//! snapped triangle's is here. The same goes for the pieces of a clipped triangle, whose new corners lie on the exact
//! edges up to the same snapping. So a drawn attribute must be one of those that the exact triangle has within 1/16 pixel
//! to the left, right, up and down (at the corners of this square are the extremes, as it is a quotient of linear
//! functions), give or take the contract's bound. What it is off by from the exact one at the centre is printed as well.
//!
//! Of a triangle that is not clipped, whose corners do not lie so close to the middle between two places that either would be
//! right, the snapped corners are known. There the pixels must be exactly those of the exact integer
//! rasterizer, and attributes within the contract's bound with nothing taken off.
//!
//! `cargo test views:: -- --nocapture` prints how many pixels were decided, and the largest errors.
#![allow(clippy::float_arithmetic, reason = "errors are measured in f64")]

use crate::{common, reference};

use std::cell::RefCell;
use std::marker::PhantomData;

use common::view::{Model, Numbered, position, texel, view};
use common::{Counting, Drawn, Record, Recording, Strip, for_all};
use fixel::embedded_graphics::prelude::Size;
use fixel::fixed::types::{I2F14, I4F12, I12F4, I16F16, U10F22};
use fixel::shapes::{Shape, cube, grid, icosphere, quad, torus, uv_sphere};
use fixel::{
    Band, Camera, Cull, DisplayList, Exact, ListMemory, Mesh, Pose, Quality, QuarterPixel, Quaternion, Stats,
    Surface, Turn, Vec3, Vertex,
};
use proptest::prelude::*;
use reference::view::{Facet, Placement, View};
use reference::{Corner, Triangle, UNIT};

const SCREEN: Strip = Strip::new(48, 40, 0);

/// How far, in pixels, a corner may be from where it belongs, along x and along y.
const SNAPPING: f64 = 1.0 / 16.0;
/// How far, in pixels, the outline may be from where it belongs.
const MARGIN: f64 = 1.0 / 8.0;
/// A triangle thinner than this many pixels may be turned over when its corners are snapped.
const THIN: f64 = 3.0 / 16.0;

/// How much closer to one place than to the next, in 1/16 pixel, a corner must be for its place to be known.
const DOUBT: f64 = 0.1;

/// What may be said of a mesh.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    /// Closed, and no line meets it more than twice.
    Convex,
    /// As that, turned inside out.
    Room,
    Closed,
    /// In one plane.
    Plane,
    Any,
}

struct Scene {
    name: &'static str,
    kind: Kind,
    model: Model,
    /// How far from the origin the camera flies, in mesh units.
    reach: [f64; 3],
}

/// One view of a scene.
#[derive(Clone, Debug)]
struct Flight {
    /// Mesh units to the world, log₁₀.
    scale: f64,
    /// How much shorter each of the mesh's axes is, log₂.
    stretch: [f64; 3],
    /// Which of the mesh's axes, and of the camera's, is turned round, so that a mirror image is seen.
    mirrors: [Option<usize>; 2],
    /// Of the mesh, in turns.
    attitude: [u16; 3],
    /// The mesh's place in the world, in parts of what the world has room for.
    place: [f64; 3],
    /// The camera's place in parts of the reach, from −1 to 1.
    eye: [f64; 3],
    heading: [u16; 3],
    /// Look at this vertex instead.
    target: Option<usize>,
    focal: f32,
    /// In mesh units, log₁₀.
    near: f64,
    exact: bool,
}

fn flights() -> impl Strategy<Value = Flight> {
    let place = prop_oneof![1 => Just(0.0), 1 => -1.0..1.0_f64];
    let eye = || prop_oneof![3 => -1.0..1.0_f64, 1 => -0.1..0.1_f64];
    let lens = (prop_oneof![4 => 15.0..80.0_f32, 1 => 80.0..2000.0_f32], -3.0..0.5_f64);
    let scale = prop_oneof![2 => -3.0..3.0_f64, 1 => Just(0.0)];
    let places = ([place.clone(), place.clone(), place], [eye(), eye(), eye()]);
    let turns = (any::<[u16; 3]>(), any::<[u16; 3]>(), prop::option::weighted(0.6, 0..2000_usize));
    let shorter = || prop_oneof![2 => Just(0.0), 1 => -4.0..0.0_f64];
    let stretch = prop_oneof![2 => Just([0.0; 3]).boxed(), 1 => [shorter(), shorter(), shorter()].boxed()];
    let mirror = || prop::option::weighted(0.2, 0..3_usize);
    let kind = (any::<bool>(), stretch, [mirror(), mirror()]);
    (scale, places, turns, lens, kind).prop_map(
        |(scale, (place, eye), (attitude, heading, target), (focal, near), (exact, stretch, mirrors))| {
            Flight { scale, stretch, mirrors, attitude, place, eye, heading, target, focal, near, exact }
        },
    )
}

fn world(at: [f64; 3]) -> Vec3 {
    let [x, y, z] = at.map(|at| I16F16::saturating_from_num(at));
    Vec3::new(x, y, z)
}

impl Flight {
    fn pose(&self) -> Pose {
        let scale = U10F22::saturating_from_num(10_f64.powf(self.scale));
        let [yaw, pitch, roll] = self.attitude.map(Turn::from_raw);
        // The mesh and the camera around it within ±32768.
        let room = 32000.0 - 24.0 * scale.to_num::<f64>();
        let attitude = Quaternion::from_euler(yaw, pitch, roll);
        let pose = mirrored(Pose::from_quaternion(attitude), self.mirrors[0]);
        let scales =
            self.stretch.map(|log2| U10F22::saturating_from_num(scale.to_num::<f64>() * 2_f64.powf(log2)));
        pose.stretched(scales).at(world(self.place.map(|at| at * room)))
    }

    fn camera(&self, scene: &Scene, pose: &Pose) -> Camera {
        let to_world = common::view::placement(pose);
        let in_world = |at: [f64; 3]| world(to_world.point(at));
        let scale = to_world.scale.iter().copied().fold(0.0, f64::max);
        let near = (10_f64.powf(self.near) * scale) as f32;
        let camera = Camera::focal(self.focal, Size::new(SCREEN.width, SCREEN.height))
            .near(near)
            .at(in_world([0, 1, 2].map(|i| self.eye[i] * scene.reach[i])));
        let [yaw, pitch, roll] = self.heading.map(Turn::from_raw);
        let camera = camera.heading(yaw, pitch, roll);
        let camera = match self.target {
            Some(vertex) => {
                let vertex = &scene.model.vertices[vertex % scene.model.vertices.len()];
                camera.look_at(
                    in_world(position(vertex)),
                    camera.unproject(I12F4::ZERO, I12F4::MIN, I16F16::ONE),
                )
            }
            None => camera,
        };
        camera.pose(mirrored(*camera.placement(), self.mirrors[1]))
    }
}

/// With one axis turned round.
fn mirrored(mut pose: Pose, axis: Option<usize>) -> Pose {
    if let Some(axis) = axis {
        pose.rotation.iter_mut().for_each(|row| row[axis] = row[axis].saturating_neg());
    }
    pose
}

/// What the reference says of a pixel.
#[derive(Clone, Copy, Debug, Default)]
struct Said {
    /// Inside the picture, as is all around it.
    must: bool,
    /// Inside the picture or almost.
    may: bool,
    /// Near something that snapping may turn over.
    thin: bool,
    inside: bool,
    near_contour: bool,
}

impl Said {
    fn must(&self) -> bool {
        self.must || self.inside && !self.near_contour
    }
}

fn centre((x, y): (i32, i32)) -> [f64; 2] {
    [f64::from(x) + 0.5, f64::from(y) + 0.5]
}

/// The pixels within `margin` of a box around these points.
fn around(points: impl Iterator<Item = [f64; 2]>) -> impl Iterator<Item = (i32, i32)> {
    let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
    for point in points {
        for axis in 0..2 {
            low[axis] = low[axis].min(point[axis]);
            high[axis] = high[axis].max(point[axis]);
        }
    }
    let range = |axis: usize, side: u32| {
        let start = (low[axis] - 1.0).floor().clamp(0.0, f64::from(side)) as i32;
        start..(high[axis] + 1.0).ceil().clamp(0.0, f64::from(side)) as i32
    };
    let (columns, rows) = (range(0, SCREEN.width), range(1, SCREEN.height));
    rows.flat_map(move |y| columns.clone().map(move |x| (x, y)))
}

fn index((x, y): (i32, i32)) -> usize {
    (y * SCREEN.width as i32 + x) as usize
}

/// What is to be seen of the facets that `drawn` is true of.
fn say(model: &Model, facets: &[Facet], drawn: &[bool]) -> Vec<Said> {
    let mut said = vec![Said::default(); SCREEN.len()];
    for (number, facet) in facets.iter().enumerate() {
        let thin = facet.thickness() < THIN || facet.turn == 0.0;
        if !(drawn[number] || thin) {
            continue;
        }
        for pixel in around(facet.outline.iter().map(|side| side.from)) {
            let depth = facet.depth(centre(pixel));
            let said = &mut said[index(pixel)];
            if depth >= -MARGIN {
                said.may = true;
                said.thin |= thin;
            }
            if drawn[number] {
                said.inside |= depth >= 0.0;
                said.must |= depth >= MARGIN;
            }
        }
        if !drawn[number] {
            continue;
        }
        for side in &facet.outline {
            // Where the picture goes on beyond: another facet that is drawn, on the other side.
            let beyond = side.edge.and_then(|edge| model.beyond[number][edge]);
            if beyond.is_some_and(|beyond| drawn[beyond] && facets[beyond].turn * facet.turn > 0.0) {
                continue;
            }
            for pixel in around([side.from, side.to].into_iter()) {
                said[index(pixel)].near_contour |= side.distance(centre(pixel)) <= MARGIN;
            }
        }
    }
    said
}

/// What was measured.
#[derive(Clone, Copy, Debug, Default)]
struct Measured {
    views: u32,
    /// With at least one pixel.
    seen: u32,
    clipped: u32,
    pixels: u64,
    must: u64,
    must_not: u64,
    thin: u64,
    /// Pixels covered more often than an exact picture has it, near something thin.
    turned_over: u64,
    /// Largest errors in attributes, `QuarterPixel` and `Exact`: with the corners' snapping taken off, and with it.
    attribute: [f64; 2],
    raw: [f64; 2],
    attributes: u64,
    /// The same of snapped triangles, with nothing taken off.
    whole: [f64; 2],
    wholes: u64,
    /// In depth steps, with the corners' snapping taken off.
    depth: f64,
    /// Largest ratio of w in a triangle whose attributes were measured.
    ratio: f64,
}

fn draw_all<Q: Quality>(
    camera: &Camera,
    mesh: &Mesh<'_>,
    pose: &Pose,
    cull: Cull,
    stats: &mut Stats,
) -> Record {
    let mut record = Record::blank(SCREEN);
    let mut band = Band::<Recording, Counting>::new(SCREEN.size(), &mut record.pixels, &mut record.depth)
        .expect("the sizes agree");
    let shader = Numbered::<Q> { number: 0, cull, quality: PhantomData };
    camera.draw_counted(mesh, pose, Surface::new(&shader), &mut band, stats);
    record
}

fn draw_parts<Q: Quality>(camera: &Camera, mesh: &Mesh<'_>, pose: &Pose, cull: Cull) -> Record {
    let mut record = Record::blank(SCREEN);
    let mut band = Band::<Recording, Counting>::new(SCREEN.size(), &mut record.pixels, &mut record.depth)
        .expect("the sizes agree");
    for number in 0..mesh.triangles().len() {
        let shader = Numbered::<Q> { number: number as i32, cull, quality: PhantomData };
        camera.draw(&mesh.part(number, number + 1), pose, Surface::new(&shader), &mut band);
    }
    record
}

fn hold<Q: Quality>(scene: &Scene, flight: &Flight, measured: &mut Measured) -> Result<(), TestCaseError> {
    let Scene { kind, model, .. } = scene;
    let (mesh, pose) = (model.mesh(), flight.pose());
    let camera = flight.camera(scene, &pose);
    let exact = view(&camera, &pose, false);
    let cull = if *kind == Kind::Plane { Cull::None } else { Cull::Back };
    let mut stats = Stats::default();
    let record = draw_all::<Q>(&camera, &mesh, &pose, cull, &mut stats);
    let parts = draw_parts::<Q>(&camera, &mesh, &pose, cull);

    let places: Vec<_> = model.vertices.iter().map(position).collect();
    let facets: Vec<_> =
        model.triangles.iter().map(|corners| exact.facet(corners.map(|i| places[usize::from(i)]))).collect();
    // In a mirror image fronts are clockwise.
    let hand = exact.handedness().signum();
    let drawn: Vec<_> = facets
        .iter()
        .map(|facet| if cull == Cull::None { facet.turn != 0.0 } else { facet.turn * hand < 0.0 })
        .collect();
    let said = say(model, &facets, &drawn);
    let snapped: Vec<_> = facets
        .iter()
        .zip(&model.triangles)
        .map(|(facet, corners)| snapped(&exact, model, facet, *corners))
        .collect();

    measured.views += 1;
    measured.clipped += u32::from(stats.clipped > 0);
    let mut seen = false;
    for (pixel, value, met) in record.iter() {
        let said = said[index(pixel)];
        let (alone, alone_met) = (parts.pixels[index(pixel)], parts.depth[index(pixel)]);
        let same = value.attributes[..2] == alone.attributes[..2] && met == alone_met;
        prop_assert!(
            same,
            "drawn whole or triangle by triangle: {:?} {:?}, {:?} {:?} at {:?}",
            value,
            met,
            alone,
            alone_met,
            pixel
        );
        prop_assert!(!said.must() || met.times > 0, "{:?} is missing: {:?} {:?}", pixel, said, camera);
        prop_assert!(
            said.may || met.times == 0,
            "{:?} is drawn {} times: {:?} {:?}",
            pixel,
            met.times,
            said,
            camera
        );
        if matches!(kind, Kind::Convex | Kind::Room | Kind::Plane) && met.times > 1 {
            measured.turned_over += 1;
            prop_assert!(said.thin, "{:?} is covered {} times: {:?} {:?}", pixel, met.times, said, camera);
        }
        seen |= met.times > 0;
        measured.pixels += u64::from(met.times > 0);
        measured.must += u64::from(said.must());
        measured.must_not += u64::from(!said.may);
        measured.thin += u64::from(said.thin);
        if met.times > 0 {
            let number = alone.attributes[2] as usize;
            if let Some(triangle) = &snapped[number] {
                whole(triangle, pixel, &alone, flight.exact, measured)?;
            }
            attribute(
                &exact,
                model,
                number,
                &facets[number],
                pixel,
                (&alone, met.q),
                flight.exact,
                measured,
            )?;
        }
    }
    measured.seen += u32::from(seen);

    let closed = stats.clipped == 0 && matches!(kind, Kind::Convex | Kind::Room | Kind::Closed);
    if closed || *kind == Kind::Plane {
        let [fronts, backs] = [Cull::Back, Cull::Front]
            .map(|cull| draw_all::<Q>(&camera, &mesh, &pose, cull, &mut Stats::default()));
        for ((pixel, _, front), (_, _, back)) in fronts.iter().zip(backs.iter()) {
            let said = said[index(pixel)];
            let more = front.times.abs_diff(back.times);
            if closed {
                prop_assert!(more == 0, "{} fronts and {} backs at {:?}", front.times, back.times, pixel);
            } else {
                prop_assert!(
                    !said.must() || more == 1,
                    "{} fronts, {} backs at {:?}: {:?}",
                    front.times,
                    back.times,
                    pixel,
                    said
                );
                prop_assert!(said.may || more == 0);
            }
        }
    }
    Ok(())
}

/// A triangle that is not clipped as it stands on the screen, if there is no doubt where its corners go.
fn snapped(exact: &View, model: &Model, facet: &Facet, corners: [u16; 3]) -> Option<Triangle> {
    let within = facet.outline.len() == 3 && facet.outline.iter().all(|side| side.edge.is_some());
    let corner = |i: u16| {
        let vertex = &model.vertices[usize::from(i)];
        let (at, w) = exact.screen(position(vertex))?;
        let at = at.map(|at| at * 16.0);
        let sure = at.iter().all(|at| (at - at.floor() - 0.5).abs() > DOUBT);
        let [u, v] = texel(vertex).map(|texel| (texel * UNIT) as i32);
        let q = (exact.q(w) * 2_f64.powi(31)).round().min(2_f64.powi(31) - 1.0) as u32;
        let [x, y] = at.map(|at| at.round() as i32);
        sure.then_some(Corner { x, y, q, attributes: [u, v, 0, 0, 0] })
    };
    let [a, b, c] = corners.map(|i| if within { corner(i) } else { None });
    Some(Triangle([a?, b?, c?]))
}

/// Against the exact integer rasterizer.
fn whole(
    triangle: &Triangle,
    pixel @ (x, y): (i32, i32),
    drawn: &Drawn,
    is_exact: bool,
    measured: &mut Measured,
) -> Result<(), TestCaseError> {
    prop_assert!(triangle.covers(x, y), "{:?} is not of {:?}", pixel, triangle);
    let here = triangle.at(x, y);
    let (quality, bound) = if is_exact { (1, 0.02) } else { (0, 0.25) };
    for axis in 0..2 {
        let step = here.change(axis).step.max(UNIT);
        let error = (f64::from(drawn.attributes[axis]) - here.attribute(axis)).abs() / step;
        prop_assert!(
            error <= bound,
            "attribute {} is {} pixels off at {:?} of {:?}",
            axis,
            error,
            pixel,
            triangle
        );
        measured.whole[quality] = measured.whole[quality].max(error);
    }
    measured.wholes += 1;
    Ok(())
}

#[expect(clippy::too_many_arguments, reason = "a step of `hold`")]
fn attribute(
    exact: &View,
    model: &Model,
    number: usize,
    facet: &Facet,
    pixel: (i32, i32),
    (drawn, q): (&Drawn, u32),
    is_exact: bool,
    measured: &mut Measured,
) -> Result<(), TestCaseError> {
    let [x, y] = centre(pixel);
    let corners = model.triangles[number].map(|i| texel(&model.vertices[usize::from(i)]));
    for axis in 0..2 {
        let at_corners = corners.map(|texel| texel[axis]);
        let value = f64::from(drawn.attributes[axis]) / UNIT;
        let (low, high) =
            at_corners.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), at| (l.min(*at), h.max(*at)));
        prop_assert!((low..=high).contains(&value), "{} is not of {:?} at {:?}", value, at_corners, pixel);
    }
    let Some(here) = facet.at([x, y]) else { return Ok(()) };
    let square = [(-1.0, -1.0), (1.0, -1.0), (-1.0, 1.0), (1.0, 1.0)];
    let square = square.map(|(dx, dy)| facet.at([x + dx * SNAPPING, y + dy * SNAPPING]));
    // Where the plane vanishes, or so thin a triangle that it is seen from both sides at once.
    let [Some(a), Some(b), Some(c), Some(d)] = square else { return Ok(()) };
    if facet.thickness() < 1e-6 {
        return Ok(());
    }
    let square = [here, a, b, c, d];
    let neighbours: Vec<_> = [(1.0, 0.0), (-1.0, 0.0), (0.0, 1.0), (0.0, -1.0)]
        .into_iter()
        .filter_map(|(dx, dy)| facet.at([x + dx, y + dy]))
        .collect();
    let (quality, bound) = if is_exact { (1, 0.02) } else { (0, 0.25) };
    let ends = |values: &dyn Fn(&reference::view::Hit) -> f64| {
        square
            .iter()
            .map(values)
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), at| (l.min(at), h.max(at)))
    };
    for axis in 0..2 {
        let at_corners = corners.map(|texel| texel[axis]);
        let value = f64::from(drawn.attributes[axis]) / UNIT;
        let exact_value = here.of(at_corners);
        let step =
            neighbours.iter().map(|next| (next.of(at_corners) - exact_value).abs()).fold(1.0, f64::max);
        let (low, high) = ends(&|hit| hit.of(at_corners));
        let error = (low - value).max(value - high).max(0.0) / step;
        prop_assert!(
            error <= bound,
            "attribute {} of triangle {} is {} at {:?}, not {} to {} (step {}): {} pixels off; w {}, ratio {}, {:?}",
            axis,
            number,
            value,
            pixel,
            low,
            high,
            step,
            error,
            here.w,
            facet.w_ratio(),
            facet
        );
        measured.attribute[quality] = measured.attribute[quality].max(error);
        measured.raw[quality] = measured.raw[quality].max((value - exact_value).abs() / step);
        measured.attributes += 1;
    }
    let (low, high) = ends(&|hit| exact.q(hit.w));
    let steps = |q: f64| q * 65536.0;
    let q = f64::from(q) / 2_f64.powi(31);
    let error = steps((low - q).max(q - high).max(0.0));
    // q ends at 1.
    let error = if low > 1.0 { error.min(steps((1.0 - q).abs())) } else { error };
    prop_assert!(error <= 1.0, "q of triangle {} is {} at {:?}, not {} to {}", number, q, pixel, low, high);
    measured.depth = measured.depth.max(error);
    measured.ratio = measured.ratio.max(facet.w_ratio());
    Ok(())
}

fn fly(scene: &Scene, views: u32) {
    let measured = RefCell::new(Measured::default());
    for_all(scene.name, views, flights(), |flight| {
        let measured = &mut measured.borrow_mut();
        if flight.exact {
            hold::<Exact>(scene, &flight, measured)
        } else {
            hold::<QuarterPixel>(scene, &flight, measured)
        }
    });
    let m = measured.into_inner();
    println!(
        "{}: {} views, {} with pixels, {} clipped; {} pixels, {} had to be, {} had not to be, {} near thin triangles, {} \
         turned over; attributes of {} pixels off by {:.4} and exact ones by {:.4} ({:.3} and {:.3} with snapping), of {} \
         in snapped triangles by {:.4} and {:.4}; depth by {:.3} steps, w to 1:{:.0}",
        scene.name,
        m.views,
        m.seen,
        m.clipped,
        m.pixels,
        m.must,
        m.must_not,
        m.thin,
        m.turned_over,
        m.attributes / 2,
        m.attribute[0],
        m.attribute[1],
        m.raw[0],
        m.raw[1],
        m.wholes,
        m.whole[0],
        m.whole[1],
        m.depth,
        m.ratio
    );
    assert!(m.seen > m.views / 4 && m.clipped > m.views / 50, "not much was seen of {}", scene.name);
}

static BALL: Shape<162, 320> = icosphere(7.9, 4);
static GLOBE: Shape<151, 224> = uv_sphere(7.9, 16, 8, [512, 256]);
static CUBE: Shape<24, 12> = cube(15.0, [64, 64]);
static GROUND: Shape<4, 2> = quad(15.625, 15.625, [2000, 2000]);
static GRID: Shape<169, 288> = grid(15.0, 15.0, 12, 12, [1200, 1200]);
static RING: Shape<192, 384> = torus(5.5, 2.0, 16, 12);

#[test]
fn a_convex_ball_from_2_500_viewpoints() {
    fly(
        &Scene { name: "icosphere", kind: Kind::Convex, model: Model::new(&BALL.mesh()), reach: [20.0; 3] },
        2500,
    );
}

#[test]
fn a_globe_from_1_500_viewpoints() {
    let model = Model::with_texels(GLOBE.mesh().vertices().to_vec(), GLOBE.mesh().triangles().collect());
    fly(&Scene { name: "globe", kind: Kind::Convex, model, reach: [20.0; 3] }, 1500);
}

#[test]
fn a_cube_from_1_500_viewpoints() {
    fly(&Scene { name: "cube", kind: Kind::Convex, model: Model::new(&CUBE.mesh()), reach: [16.0; 3] }, 1500);
}

#[test]
fn a_room_from_1_500_viewpoints_inside() {
    fly(
        &Scene {
            name: "room",
            kind: Kind::Room,
            model: Model::new(&CUBE.mesh()).inside_out(),
            reach: [7.4; 3],
        },
        1500,
    );
}

#[test]
fn a_ground_of_two_triangles_from_1_500_viewpoints() {
    let model = Model::with_texels(GROUND.mesh().vertices().to_vec(), GROUND.mesh().triangles().collect());
    fly(&Scene { name: "ground", kind: Kind::Plane, model, reach: [7.0, 7.0, 0.5] }, 1500);
}

#[test]
fn a_plane_of_288_triangles_from_1_500_viewpoints() {
    let model = Model::with_texels(GRID.mesh().vertices().to_vec(), GRID.mesh().triangles().collect());
    fly(&Scene { name: "grid", kind: Kind::Plane, model, reach: [8.0, 8.0, 2.0] }, 1500);
}

#[test]
fn a_torus_from_1_000_viewpoints() {
    fly(
        &Scene { name: "torus", kind: Kind::Closed, model: Model::new(&RING.mesh()), reach: [12.0; 3] },
        1000,
    );
}

/// The teapot is 15 units long, and smaller in its mesh.
fn teapot() -> Model {
    let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("examples/assets/teapot.obj");
    let (models, _) = tobj::load_obj(path, &tobj::GPU_LOAD_OPTIONS).expect("the teapot is there");
    let mesh = &models.first().expect("one mesh").mesh;
    let (places, _) = mesh.positions.as_chunks::<3>();
    let most = mesh.positions.iter().fold(0.0_f32, |most, at| most.max(at.abs()));
    let vertices: Vec<_> = places
        .iter()
        .map(|place| place.map(|at| at * 7.9 / most))
        .map(|[x, y, z]| Vertex::new(x, y, z))
        .collect();
    let (triangles, _) = mesh.indices.as_chunks::<3>();
    let triangles: Vec<_> = triangles.iter().map(|corners| corners.map(|index| index as u16)).collect();
    Model::new(&Mesh::try_new(&vertices, &triangles).expect("the indices are in range"))
}

#[test]
fn the_teapot_from_600_viewpoints() {
    fly(&Scene { name: "teapot", kind: Kind::Any, model: teapot(), reach: [14.0; 3] }, 600);
}

/// A rotation, a scale and a translation in the bits of their formats.
fn pose_of_bits(rotation: [[i16; 3]; 3], scale: u32, [x, y, z]: [i32; 3]) -> Pose {
    Pose {
        rotation: rotation.map(|row| row.map(I2F14::from_bits)),
        scale: [U10F22::from_bits(scale); 3],
        translation: Vec3::new(I16F16::from_bits(x), I16F16::from_bits(y), I16F16::from_bits(z)),
    }
}

fn vertex_of_bits(place: [i16; 3]) -> Vertex {
    Vertex { position: place.map(I4F12::from_bits), ..Vertex::default() }
}

/// One triangle on one screen: the pixels whose centres lie more than 1/16 px inside what is seen of it, those more than 1/16 px
/// outside, and how often each is drawn.
fn lone(camera: &Camera, strip: Strip, pose: &Pose, corners: &[Vertex; 3]) -> (Record, Facet, Stats) {
    let mut record = Record::blank(strip);
    let mut stats = Stats::default();
    let mut band = Band::<Recording, Counting>::new(strip.size(), &mut record.pixels, &mut record.depth)
        .expect("the sizes agree");
    let shader = Numbered::<QuarterPixel> { number: 0, cull: Cull::None, quality: PhantomData };
    camera.draw_counted(
        &Mesh::new(corners, &[[0, 1, 2]]),
        pose,
        Surface::new(&shader),
        &mut band,
        &mut stats,
    );
    let facet = view(camera, pose, camera.is_orthographic()).facet(corners.each_ref().map(position));
    (record, facet, stats)
}

#[test]
fn a_triangle_that_the_near_plane_cuts_at_a_scale_of_831_is_drawn() {
    let strip = Strip::new(82, 8, 0);
    let camera = Camera::focal(214.064_06, strip.size()).near(237.0 / 65536.0);
    let pose = pose_of_bits(
        [[13287, 8644, 4145], [-9585, 12125, 5437], [-199, -6834, 14889]],
        3_485_801_480,
        [458_415, 1_397_395, 3_281_504],
    );
    let corners = [[-11367, -15509, -19767], [-741, 10729, -28795], [5667, 3171, 19744]].map(vertex_of_bits);
    let (record, facet, stats) = lone(&camera, strip, &pose, &corners);
    let drawn = record.iter().filter(|(.., met)| met.times > 0).count();
    println!("scale 831: {drawn} px, {stats:?}");
    for (pixel, _, met) in record.iter() {
        let depth = facet.depth(centre(pixel));
        assert!(
            met.times <= 1 && (depth < SNAPPING || met.times == 1),
            "{pixel:?} {met:?}, {depth} px inside"
        );
        assert!(depth > -SNAPPING || met.times == 0, "{pixel:?} {met:?}, {depth} px inside");
    }
    assert!((322..=328).contains(&drawn), "{drawn} px");
}

#[test]
fn a_floor_from_a_near_plane_of_almost_nothing_at_a_scale_of_512() {
    // 60° high, standing where near = 2⁻¹⁶ put a pixel 5.06 px off; and at every other scale.
    let [low, high] = [-7.9_f32, 7.9];
    let texel = |at: f32| if at < 0.0 { -2000 } else { 2000 };
    let corner = |x: f32, z: f32| Vertex::new(x, 0.0, z).uv(texel(x), texel(z));
    let vertices = vec![corner(low, high), corner(high, high), corner(high, low), corner(low, low)];
    let model = Model::with_texels(vertices, vec![[0, 1, 2], [0, 2, 3]]);
    let strip = Strip::new(96, 64, 0);
    let mut worst = 0.0_f64;
    for (number, log2) in (-10..=9).chain([10]).enumerate() {
        let scale = U10F22::saturating_from_num(2_f64.powi(log2));
        for near in [1.0 / 65536.0, 1.0 / 256.0, 0.004, 0.01] {
            let camera = Camera::perspective(Turn::from_degrees(60), strip.size())
                .near(near)
                .at(Vec3::lit(0.5, 1.0, -0.5))
                .heading(Turn::from_degrees(210), Turn::from_degrees(-30), Turn::ZERO);
            let pose = Pose::IDENTITY.scaled(scale);
            let exact = view(&camera, &pose, false);
            let mesh = model.mesh();
            for triangle in 0..2 {
                let facet =
                    exact.facet(model.triangles[triangle].map(|i| position(&model.vertices[usize::from(i)])));
                let mut record = Record::blank(strip);
                let mut band =
                    Band::<Recording, Counting>::new(strip.size(), &mut record.pixels, &mut record.depth)
                        .expect("the sizes agree");
                let shader = Numbered::<QuarterPixel> {
                    number: number as i32,
                    cull: Cull::None,
                    quality: PhantomData,
                };
                camera.draw(&mesh.part(triangle, triangle + 1), &pose, Surface::new(&shader), &mut band);
                let mut measured = Measured::default();
                for (pixel, drawn, met) in record.iter() {
                    let depth = facet.depth(centre(pixel));
                    assert!(met.times <= 1, "{pixel:?} {met:?}");
                    assert!(
                        depth < SNAPPING || met.times == 1,
                        "{pixel:?} {met:?}, {depth} px inside, {scale}"
                    );
                    assert!(
                        depth > -SNAPPING || met.times == 0,
                        "{pixel:?} {met:?}, {depth} px inside, {scale}"
                    );
                    if met.times > 0 {
                        attribute(
                            &exact,
                            &model,
                            triangle,
                            &facet,
                            pixel,
                            (&drawn, met.q),
                            false,
                            &mut measured,
                        )
                        .unwrap_or_else(|error| panic!("scale {scale}, near {near}: {error}"));
                    }
                }
                worst = worst.max(measured.raw[0]);
            }
        }
    }
    println!("a floor at scales of 2^-10 to 2^10: {worst:.3} px off, snapping included");
}
#[test]
fn a_clipped_triangle_that_rounding_folds_covers_no_pixel_twice() {
    let strip = Strip::new(53, 8, 0);
    let camera = Camera::focal(478_464.0 / 65536.0, strip.size()).near(8192.0 / 65536.0);
    let pose = pose_of_bits(
        [[-7882, -4222, 0], [0, -5334, -15491], [4464, -14905, 5132]],
        2_838_528,
        [65536, 126_976, -38443],
    );
    let corners =
        [[-24576, -23384, -18859], [25088, 30720, 19456], [25216, 30720, 19520]].map(vertex_of_bits);
    let (record, facet, stats) = lone(&camera, strip, &pose, &corners);
    let (mut drawn, mut nearest) = (0, f64::NEG_INFINITY);
    for (pixel, _, met) in record.iter() {
        let depth = facet.depth(centre(pixel));
        assert!(met.times <= 1, "{pixel:?} is drawn {} times", met.times);
        assert!(depth >= -MARGIN || met.times == 0, "{pixel:?} is drawn, {depth} px inside");
        (drawn, nearest) = (drawn + met.times, nearest.max(depth));
    }
    // 0.06 px thick, and no centre is inside: the nearest, which was drawn twice, is 0.003 px outside.
    println!("folded: {drawn} px, the nearest {nearest:.4} px inside; {stats:?}");
    assert!((-0.01..0.0).contains(&nearest));
}

/// Four triangles between a quadrilateral's corners and a place on its diagonal, or a little beside it: one of them is a sliver.
#[derive(Clone, Debug)]
struct Slivers {
    /// On both sides of the diagonal; the diagonal; how far along it the fifth vertex lies, and how far beside it; bits.
    places: [[i16; 2]; 4],
    along: f64,
    beside: [i16; 2],
    attitude: [u16; 3],
    scale: f64,
    /// What the camera looks at, by the shares of the corners, and from how far away; where it stands, off that line.
    eye: ([f64; 4], f64, [f64; 2]),
    roll: u16,
    focal: f32,
    near: f64,
}

fn slivers() -> impl Strategy<Value = Slivers> {
    let place = || [-10000..10000_i16, -10000..10000_i16];
    let beside = [-6..=6_i16, -6..=6_i16];
    let share = || 0.0..1.0_f64;
    let eye = ([share(), share(), share(), share()], -3.0..1.0_f64, [-1.0..1.0_f64, -1.0..1.0]);
    let lens = (prop_oneof![3 => 2.0..60.0_f32, 1 => 60.0..3000.0_f32], -2.4..0.5_f64, -2.0..3.0_f64);
    let shape = (place(), place(), place(), 0.05..0.95_f64, beside);
    (shape, any::<[u16; 3]>(), eye, any::<u16>(), lens).prop_map(
        |((p, q, r, along, beside), attitude, eye, roll, (focal, near, scale))| {
            // The fourth corner opposite to the second.
            let s = [0, 1].map(|i| (i32::from(p[i]) + i32::from(r[i]) - i32::from(q[i])) as i16);
            Slivers { places: [p, q, r, s], along, beside, attitude, scale, eye, roll, focal, near }
        },
    )
}

impl Slivers {
    fn model(&self) -> Model {
        let [p, q, r, s] = self.places;
        let m = [0, 1].map(|i| {
            let (from, to) = (f64::from(p[i]), f64::from(r[i]));
            (from + (to - from) * self.along).round() as i16 + self.beside[i]
        });
        let vertices = [p, q, r, s, m].map(|[x, y]| vertex_of_bits([x, y, 0])).to_vec();
        Model::with_texels(vertices, vec![[0, 1, 4], [1, 2, 4], [0, 4, 2], [0, 2, 3]])
    }

    fn pose(&self) -> Pose {
        let [yaw, pitch, roll] = self.attitude.map(Turn::from_raw);
        let scale = U10F22::saturating_from_num(10_f64.powf(self.scale));
        Pose::from_quaternion(Quaternion::from_euler(yaw, pitch, roll)).scaled(scale)
    }

    fn camera(&self, size: Size) -> Camera {
        let Placement { rotation, scale: [scale, ..], .. } = common::view::placement(&self.pose());
        let (shares, height, beside) = self.eye;
        let sum: f64 = shares.iter().sum::<f64>().max(1e-3);
        let at = [0, 1]
            .map(|i| (0..4).map(|k| f64::from(self.places[k][i]) / 4096.0 * shares[k] / sum).sum::<f64>());
        let height = 10_f64.powf(height);
        let in_world = |at: [f64; 3]| {
            world([0, 1, 2].map(|i| (0..3).map(|k| rotation[i][k] * at[k]).sum::<f64>() * scale))
        };
        let roll = Turn::from_raw(self.roll);
        let camera = Camera::focal(self.focal, size).near((10_f64.powf(self.near) * scale.min(1.0)) as f32);
        let camera = camera.at(in_world([at[0] + beside[0], at[1] + beside[1], height]));
        let camera = camera.heading(Turn::from_raw(self.roll.wrapping_mul(7)), Turn::ZERO, roll);
        camera.look_at(in_world([at[0], at[1], 0.0]), camera.unproject(I12F4::ZERO, I12F4::MIN, I16F16::ONE))
    }
}

#[test]
fn clipped_slivers_cover_each_pixel_once_and_what_neighbours_leave_in_40_000_cases() {
    let strip = Strip::new(48, 40, 0);
    let counts = RefCell::new([0_u32; 5]);
    for_all("clipped slivers", 40_000, slivers(), |slivers| {
        let (model, pose, camera) = (slivers.model(), slivers.pose(), slivers.camera(strip.size()));
        let mesh = model.mesh();
        let draw = |mesh: &Mesh<'_>, cull| {
            let mut record = Record::blank(strip);
            let mut band =
                Band::<Recording, Counting>::new(strip.size(), &mut record.pixels, &mut record.depth)
                    .expect("the sizes agree");
            let mut stats = Stats::default();
            let shader = Numbered::<QuarterPixel> { number: 0, cull, quality: PhantomData };
            camera.draw_counted(mesh, &pose, Surface::new(&shader), &mut band, &mut stats);
            (record, stats)
        };
        // Each alone: no pixel twice, from a list the same, and what is front or back of it is all of it.
        let mut clipped = 0;
        for number in 0..4 {
            let triangle = mesh.part(number, number + 1);
            let (both, stats) = draw(&triangle, Cull::None);
            clipped += stats.clipped;
            let [front, back] = [Cull::Back, Cull::Front].map(|cull| draw(&triangle, cull).0);
            for (i, (pixel, _, met)) in both.iter().enumerate() {
                prop_assert!(
                    met.times <= 1,
                    "triangle {} is drawn {} times at {:?}",
                    number,
                    met.times,
                    pixel
                );
                prop_assert_eq!(front.depth[i].times + back.depth[i].times, met.times, "{:?}", pixel);
            }
            let shader = Numbered::<QuarterPixel> { number: 0, cull: Cull::None, quality: PhantomData };
            let mut memory = ListMemory::<40, 20>::new();
            let mut list = DisplayList::<Recording, Counting, 1>::new(&mut memory);
            camera.draw(&triangle, &pose, Surface::new(&shader), &mut list).expect("there is room");
            let mut listed = Record::blank(strip);
            for rows in 0..8 {
                let range = rows * 5 * 48..(rows + 1) * 5 * 48;
                let (pixels, depth) = (&mut listed.pixels[range.clone()], &mut listed.depth[range]);
                let mut band = Band::<Recording, Counting>::new(Size::new(48, 5), pixels, depth)
                    .expect("the sizes agree");
                list.render(rows as u32 * 5, &mut band);
            }
            prop_assert!(listed == both, "from a list triangle {} is another", number);
            // A polygon that is kept whole.
            let [corners, kept, _] = list.lengths();
            counts.borrow_mut()[2] += u32::from(stats.clipped > 0 && corners > 3 && kept == 1);
        }
        // All together: what goes around each pixel is what goes around it without rounding.
        let [front, back] = [Cull::Back, Cull::Front].map(|cull| draw(&mesh, cull).0);
        let exact = view(&camera, &pose, false);
        let place = |i: usize| position(&model.vertices[i]);
        let halves =
            [exact.facet([place(0), place(1), place(2)]), exact.facet([place(0), place(2), place(3)])];
        let sides = || {
            halves
                .iter()
                .zip([2, 0])
                .flat_map(|(half, shared)| half.outline.iter().filter(move |side| side.edge != Some(shared)))
        };
        let mut seen = false;
        for ((pixel, _, front), (_, _, back)) in front.iter().zip(back.iter()) {
            let at = centre(pixel);
            if sides().map(|side| side.distance(at)).fold(f64::INFINITY, f64::min) <= MARGIN {
                continue;
            }
            let is_inside = halves.iter().any(|half| half.depth(at) >= -SNAPPING);
            seen |= is_inside;
            let around = front.times as i32 - back.times as i32;
            let wanted = if is_inside { -(halves[0].turn.signum() as i32) } else { 0 };
            prop_assert_eq!(around, wanted, "{} fronts, {} backs at {:?}", front.times, back.times, pixel);
        }
        let mut counts = counts.borrow_mut();
        counts[0] += u32::from(seen);
        counts[1] += clipped;
        Ok(())
    });
    let [seen, clipped, folded, ..] = counts.into_inner();
    println!(
        "clipped slivers: {seen} views with pixels, {clipped} triangles clipped, {folded} of them kept whole"
    );
    assert!(seen > common::cases(40_000) / 4 && clipped > common::cases(40_000) / 2);
}

/// A triangle of any size, seen from close by through any lens.
#[derive(Clone, Debug)]
struct Close {
    places: [[i16; 3]; 3],
    attitude: [u16; 3],
    /// log₂.
    scale: f64,
    /// Where on it the camera looks, from where, and from how far away in log₂ world units.
    shares: [f64; 3],
    from: [u16; 2],
    distance: f64,
    /// log₂.
    focal: f64,
    near: f64,
    orthographic: bool,
    /// At the screen's corner, or at the last row and column of the largest.
    is_last: bool,
}

fn closes() -> impl Strategy<Value = Close> {
    let place = || prop_oneof![4 => any::<[i16; 3]>(), 1 => [-300..300_i16, -300..300_i16, -300..300_i16]];
    let scale = prop_oneof![3 => -10.0..10.0_f64, 1 => Just(10.0)];
    let share = || 0.01..1.0_f64;
    let near = prop_oneof![2 => Just(-8.0), 2 => -8.0..-6.0_f64, 1 => -6.0..4.0_f64];
    let lens =
        (prop_oneof![6 => 1.0..11.0_f64, 1 => Just(13.0), 1 => Just(-4.0)], near, prop::bool::weighted(0.2));
    let eye =
        ([share(), share(), share()], any::<[u16; 2]>(), prop_oneof![2 => -8.0..0.0_f64, 1 => 0.0..10.0]);
    ([place(), place(), place()], any::<[u16; 3]>(), scale, eye, lens, any::<bool>()).prop_map(
        |(places, attitude, scale, (shares, from, distance), (focal, near, orthographic), is_last)| Close {
            places,
            attitude,
            scale,
            shares,
            from,
            distance,
            focal,
            near,
            orthographic,
            is_last,
        },
    )
}

#[test]
fn no_visible_triangle_is_left_out_at_any_scale_and_near_distance_in_30_000_cases() {
    let counts = RefCell::new([0_u64; 4]);
    let worst = RefCell::new(0.0_f64);
    for_all("close", 30_000, closes(), |close| {
        let strip = if close.is_last { Strip::new(1023, 2, 1021) } else { Strip::new(48, 40, 0) };
        let size = Size::new(strip.width, strip.row + strip.height);
        let [yaw, pitch, roll] = close.attitude.map(Turn::from_raw);
        let pose = Pose::from_quaternion(Quaternion::from_euler(yaw, pitch, roll))
            .scaled(U10F22::saturating_from_num(2_f64.powf(close.scale)));
        let Placement { rotation, scale: [scale, ..], .. } = common::view::placement(&pose);
        let corners = close.places.map(vertex_of_bits);
        let sum: f64 = close.shares.iter().sum();
        let at: [f64; 3] = [0, 1, 2].map(|i| {
            let at = [0, 1, 2]
                .map(|axis| (0..3).map(|k| position(&corners[k])[axis] * close.shares[k] / sum).sum::<f64>());
            (0..3).map(|k| rotation[i][k] * at[k]).sum::<f64>() * scale
        });
        let lens = 2_f64.powf(close.focal) as f32;
        let camera = if close.orthographic {
            Camera::orthographic(lens, size).far(30_000.0)
        } else {
            Camera::focal(lens, size)
        };
        let [yaw, pitch] = close.from.map(Turn::from_raw);
        let camera = camera.near(2_f64.powf(close.near) as f32).orbit(
            world(at),
            I16F16::from_num(2_f64.powf(close.distance)),
            yaw,
            pitch,
        );
        let mut record = Record::blank(strip);
        let mut band = Band::<Recording, Counting>::new(strip.size(), &mut record.pixels, &mut record.depth)
            .expect("the sizes agree")
            .starting_at(strip.row);
        let shader = Numbered::<QuarterPixel> { number: 0, cull: Cull::None, quality: PhantomData };
        let mut stats = Stats::default();
        camera.draw_counted(
            &Mesh::new(&corners, &[[0, 1, 2]]),
            &pose,
            Surface::new(&shader),
            &mut band,
            &mut stats,
        );

        let facet = view(&camera, &pose, close.orthographic).facet(corners.each_ref().map(position));
        // As the crate states it: w in 2^-38 and less, as a mesh has it that is larger than 1.
        let (near, _) = camera.planes();
        let w = if close.orthographic { 1.0 } else { near.to_num::<f64>() };
        let units = w * 2_f64.powf(38.0 - scale.log2().ceil().max(0.0));
        let focal = camera.focal_length().to_num::<f64>();
        let before = ((9.0 * 2.0 * focal + 17.0 * 1023.0 + 20480.0) / units).max(1.0 / 128.0);
        // Along both axes.
        let margin = (before + 1.0 / 32.0) * 2_f64.sqrt();
        let mut counts = counts.borrow_mut();
        let mut seen = false;
        for (pixel, _, met) in record.iter() {
            let depth = facet.depth(centre(pixel));
            prop_assert!(met.times <= 1, "{:?} is drawn {} times", pixel, met.times);
            prop_assert!(
                depth < margin || met.times == 1,
                "{:?} is missing, {} px inside, {:?}",
                pixel,
                depth,
                stats
            );
            prop_assert!(depth > -margin || met.times == 0, "{:?} is drawn, {} px outside", pixel, -depth);
            if (depth > 0.0) != (met.times > 0) && depth.is_finite() {
                let worst = &mut worst.borrow_mut();
                **worst = worst.max(depth.abs());
            }
            seen |= depth >= margin;
            counts[1] += u64::from(depth >= margin);
        }
        counts[0] += u64::from(seen);
        counts[2] += u64::from(seen && stats.clipped > 0);
        counts[3] += u64::from(seen && scale > 500.0);
        Ok(())
    });
    let [seen, pixels, clipped, large] = counts.into_inner();
    println!(
        "close: {seen} triangles seen, {clipped} clipped, {large} at scales of more than 500; {pixels} pixels had to be; outlines off by \
         {:.4} px",
        worst.into_inner()
    );
    assert!(seen > u64::from(common::cases(30_000)) / 3 && clipped > u64::from(common::cases(30_000)) / 5);
}
