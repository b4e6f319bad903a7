//! The promise: `examples/probe.rs` writes what the pipeline did at every pixel, which is what the reference says within
//! the contract's bounds; and a bad file gets a message and exit code 2, never a panic.
//!
//! `cargo test probe:: -- --nocapture` prints the largest errors by quality and ratio of w.
#![allow(clippy::float_arithmetic, reason = "errors are measured in f64")]

use crate::{common, reference};

use std::collections::HashMap;
use std::env::{self, consts::EXE_SUFFIX};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use std::sync::OnceLock;
use std::sync::atomic::{AtomicU32, Ordering};

use common::{cases, for_all};
use proptest::prelude::*;
use reference::view::{Facet, Lens, Placement, View};
use reference::{Corner, DEPTH_STEP, Facing, Triangle, UNIT};

// --- Cases ---

#[derive(Clone, Copy, Debug)]
struct Vertex {
    x: i32,
    y: i32,
    w: f32,
    u: f32,
    v: f32,
    color: [f32; 3],
}

#[derive(Clone, Debug)]
struct Case {
    width: u32,
    height: u32,
    rule: u32,
    cull: u32,
    triangles: Vec<[Vertex; 3]>,
}

impl Case {
    fn bytes(&self) -> Vec<u8> {
        let mut bytes = b"TRI1".to_vec();
        for word in [self.width, self.height, self.rule, self.cull, self.triangles.len() as u32] {
            bytes.extend(word.to_le_bytes());
        }
        for Vertex { x, y, w, u, v, color: [r, g, b] } in self.triangles.as_flattened() {
            bytes.extend([x, y].map(|at| at.to_le_bytes()).as_flattened());
            bytes.extend([w, u, v, r, g, b].map(|value| value.to_le_bytes()).as_flattened());
        }
        bytes
    }
}

/// Random numbers, after Marsaglia.
struct Dice(u64);

impl Dice {
    /// 0 … 1.
    fn fraction(&mut self) -> f64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 11) as f64 / 2f64.powi(53)
    }

    fn within(&mut self, low: i32, high: i32) -> i32 {
        low + (self.fraction() * f64::from(high - low + 1)) as i32
    }

    /// Triangles of all shapes, with vertices up to a `reach` in 1/16 pixel from some place on the screen; the first
    /// has the smallest w, 3/8, and the largest.
    fn case(&mut self, (width, height): (u32, u32), count: usize, reach: [i32; 5], ratio: f64) -> Case {
        let triangles = (0..count).map(|index| {
            let reach = reach[self.within(0, 4) as usize];
            let lattice = [1, 1, 8, 16][self.within(0, 3) as usize];
            let middle = [width, height].map(|side| self.within(0, 16 * side as i32));
            let spread = if self.within(0, 2) == 0 { 2000 } else { [1, 16, 256][self.within(0, 2) as usize] };
            let base = [self.within(spread - 2000, 2000 - spread), self.within(spread - 2000, 2000 - spread)];
            let level = self.within(0, 3) == 0;
            let w = self.fraction();
            let mut vertices = [0, 1, 2].map(|_| {
                let [x, y] = middle.map(|at| {
                    let at = at + self.within(-reach, reach);
                    (at / lattice * lattice).clamp(-1023 * 16 - 8, 1023 * 16 + 8)
                });
                let w = if level { w } else { self.fraction() };
                let mut texels =
                    |base: i32| base as f32 + self.within(-16 * spread, 16 * spread) as f32 / 16.0;
                let (u, v) = (texels(base[0]), texels(base[1]));
                let w = (0.375 * ratio.powf(w)) as f32;
                Vertex { x, y, w, u, v, color: [f32::NAN, f32::INFINITY, -1.0] }
            });
            if index == 0 {
                (vertices[1].w, vertices[2].w) = (0.375, 0.375 * ratio as f32);
            }
            vertices
        });
        Case { width, height, rule: 0, cull: 0, triangles: triangles.collect() }
    }
}

/// Reaches that leave some pixels bare, and reaches to the ends of the guard band.
const SMALL: [i32; 5] = [8, 60, 150, 200, 250];
const ALL: [i32; 5] = [8, 60, 400, 4000, 40_000];

/// A small case in which everything is right.
fn small() -> Case {
    Dice(0x0123_4567_89ab_cdef).case((24, 16), 5, SMALL, 100.0)
}

// --- Running it ---

/// The example, which cargo puts next to the tests. It is built here where it is missing or too old, as
/// `cargo test probe::` leaves it.
fn executable() -> &'static Path {
    static EXECUTABLE: OnceLock<PathBuf> = OnceLock::new();
    EXECUTABLE.get_or_init(|| {
        let this = env::current_exe().expect("a test has a path");
        let profile = this.ancestors().nth(2).expect("a test lies in target/profile/deps");
        let executable = profile.join("examples").join(format!("probe{EXE_SUFFIX}"));
        let changed = |path: &Path| fs::metadata(path).and_then(|data| data.modified()).ok();
        let source = |name: &str| changed(&Path::new(env!("CARGO_MANIFEST_DIR")).join("examples").join(name));
        let newest = source("probe.rs").max(source("support/probe_mesh.rs")).max(changed(&this));
        if changed(&executable) < newest {
            let name = profile.file_name().and_then(|name| name.to_str()).expect("a profile's name");
            let status = Command::new(env!("CARGO"))
                .args(["build", "--quiet", "--example", "probe", "--manifest-path"])
                .arg(Path::new(env!("CARGO_MANIFEST_DIR")).join("Cargo.toml"))
                .args(["--profile", if name == "debug" { "dev" } else { name }, "--target-dir"])
                .arg(profile.parent().expect("a profile lies in target"))
                .status();
            assert!(status.is_ok_and(|status| status.success()), "the example does not build");
        }
        executable
    })
}

/// A file for one run, of this process alone.
fn scratch(name: &str) -> PathBuf {
    static NEXT: AtomicU32 = AtomicU32::new(0);
    let number = NEXT.fetch_add(1, Ordering::Relaxed);
    Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("probe-{}-{number}-{name}", std::process::id()))
}

fn run(args: &[&Path]) -> Output {
    Command::new(executable()).args(args).output().expect("the example runs")
}

/// Writes a case, runs the probe on it, reads what it wrote.
fn probe(case: &[u8], quality: &str) -> (Output, Option<Vec<u8>>) {
    let (path, out) = (scratch("case"), scratch("out"));
    fs::write(&path, case).expect("the case is written");
    let output = run(&[&path, &out, Path::new(quality)]);
    let report = fs::read(&out).ok();
    let _ = fs::remove_file(path);
    let _ = fs::remove_file(out);
    (output, report)
}

fn code(output: &Output) -> Option<i32> {
    output.status.code()
}

fn message(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

/// One pixel of a report.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Pixel {
    count: u16,
    index: u16,
    uv: [f32; 2],
    inverse_w: f32,
}

/// A pixel that no triangle covers.
const BARE: Pixel = Pixel { count: 0, index: u16::MAX, uv: [0.0; 2], inverse_w: 0.0 };

fn report(case: &Case, quality: &str) -> Vec<Pixel> {
    let (output, report) = probe(&case.bytes(), quality);
    assert_eq!(code(&output), Some(0), "{}", message(&output));
    pixels(&report.expect("a report"), (case.width * case.height) as usize)
}

fn pixels(report: &[u8], count: usize) -> Vec<Pixel> {
    let (pixels, rest) = report.as_chunks::<16>();
    assert_eq!((pixels.len(), rest), (count, &[][..]));
    let pixel = |bytes: &[u8; 16]| {
        let (shorts, _) = bytes.as_chunks();
        let (words, _) = bytes.as_chunks();
        let float = |i: usize| f32::from_le_bytes(words[i]);
        Pixel {
            count: u16::from_le_bytes(shorts[0]),
            index: u16::from_le_bytes(shorts[1]),
            uv: [float(1), float(2)],
            inverse_w: float(3),
        }
    };
    pixels.iter().map(pixel).collect()
}

// --- Well-formed cases ---

/// A case as the reference sees it.
struct Truth {
    triangles: Vec<Triangle>,
    /// For each pixel the triangles that cover it, in order, with their 16-bit depths.
    covering: Vec<Vec<(usize, i128)>>,
    near: f64,
    width: i32,
    /// What is known so far of a triangle at a pixel.
    exact: HashMap<(usize, usize), Exact>,
}

/// A triangle at a pixel centre, in texels and units of 2⁻³¹.
#[derive(Clone, Copy)]
struct Exact {
    uv: [f64; 2],
    affine: [f64; 2],
    /// The largest change over one pixel step, at least 1.
    change: [f64; 2],
    q: f64,
}

impl Truth {
    fn new(case: &Case) -> Self {
        let near = f64::from(case.triangles.as_flattened().iter().map(|v| v.w).fold(f32::INFINITY, f32::min));
        let corner = |vertex: Vertex| Corner {
            x: vertex.x,
            y: vertex.y,
            q: (near / f64::from(vertex.w) * 2f64.powi(31)).round().min(2f64.powi(31) - 1.0) as u32,
            attributes: [(vertex.u * 65536.0) as i32, (vertex.v * 65536.0) as i32, 0, 0, 0],
        };
        let triangles: Vec<_> =
            case.triangles.iter().map(|vertices| Triangle(vertices.map(corner))).collect();
        let (width, height) = (case.width as i32, case.height as i32);
        let mut covering = vec![Vec::new(); (width * height) as usize];
        for (index, triangle) in triangles.iter().enumerate() {
            let span = |at: fn(&Corner) -> i32, side: i32| {
                let all = triangle.0.each_ref().map(at);
                let low = all.into_iter().min().unwrap_or(0).div_euclid(16).max(0);
                low..all.into_iter().max().unwrap_or(0).div_euclid(16).min(side - 1) + 1
            };
            for y in span(|corner| corner.y, height) {
                for x in span(|corner| corner.x, width) {
                    if triangle.covers(x, y) {
                        covering[(y * width + x) as usize].push((index, triangle.at(x, y).depth_word()));
                    }
                }
            }
        }
        Self { triangles, covering, near, width, exact: HashMap::new() }
    }

    fn exact(&mut self, index: usize, pixel: usize) -> Exact {
        let (triangles, width) = (&self.triangles, self.width);
        *self.exact.entry((index, pixel)).or_insert_with(|| {
            let here = triangles[index].at(pixel as i32 % width, pixel as i32 / width);
            Exact {
                uv: [0, 1].map(|i| here.attribute(i) / UNIT),
                affine: [0, 1].map(|i| here.affine_attribute(i) / UNIT),
                change: [0, 1].map(|i| (here.change(i).step / UNIT).max(1.0)),
                q: here.q(),
            }
        })
    }

    /// Which triangles cover a pixel after culling, with their depths.
    fn surviving(&self, pixel: usize, cull: u32) -> Vec<(usize, i128)> {
        let culled = match cull {
            0 => Facing::Edge,
            1 => Facing::Back,
            _ => Facing::Front,
        };
        let covering = self.covering[pixel].iter().copied();
        covering.filter(|(index, _)| self.triangles[*index].facing() != culled).collect()
    }
}

/// The largest errors of a quality.
#[derive(Clone, Copy, Default)]
struct Worst {
    /// By the contract's measure.
    uv: f64,
    /// In texels.
    texels: f64,
    /// In depth steps.
    depth: f64,
    pixels: u32,
    /// Pixels that no triangle covers.
    bare: u32,
    /// Pixels where another triangle is seen than by the exact 16-bit depths.
    other_seen: u32,
}

/// Coordinates are rounded to 1/256 texel by the probe, by at most half of that.
const PACKING: f64 = 1.0 / 512.0;

/// The bound on u and v by the contract's measure, for the exact value that the quality stands for.
fn bound(quality: &str) -> f64 {
    match quality {
        "default" => 0.25 + PACKING,
        // Of affine, this is what straight interpolation is held to.
        _ => 0.02 + PACKING,
    }
}

fn compare(case: &Case, quality: &str, truth: &mut Truth, worst: &mut Worst) {
    let (rule, cull) = (case.rule, case.cull);
    for (place, pixel) in report(case, quality).into_iter().enumerate() {
        let about = || {
            format!(
                "rule {rule}, cull {cull}, {quality}: {pixel:?} at {place}, {:?}",
                case.triangles.get(usize::from(pixel.index))
            )
        };
        let surviving = truth.surviving(place, cull);
        assert_eq!(usize::from(pixel.count), surviving.len(), "{}", about());
        let Some((last, _)) = surviving.last() else {
            assert_eq!(pixel, BARE);
            worst.bare += 1;
            continue;
        };
        let index = usize::from(pixel.index);
        if rule == 0 {
            assert_eq!(index, *last, "{}", about());
        } else {
            let seen = surviving.iter().find(|(other, _)| *other == index);
            let (_, depth) = seen.unwrap_or_else(|| panic!("not there: {}", about()));
            // Both depths may be one step off; of equals the first stays.
            for (other, nearer) in &surviving {
                let slack = if *other < index { 1 } else { 2 };
                assert!(*nearer <= depth + slack, "{other} is nearer: {}", about());
            }
            let first_nearest = surviving.iter().rev().max_by_key(|(_, depth)| *depth);
            worst.other_seen += u32::from(first_nearest.is_none_or(|(nearest, _)| *nearest != index));
        }

        worst.pixels += 1;
        let exact = truth.exact(index, place);
        let steps =
            (f64::from(pixel.inverse_w) * truth.near * 2f64.powi(31) - exact.q).abs() / DEPTH_STEP as f64;
        assert!(steps <= 1.0, "1/w is {steps} depth steps off: {}", about());
        worst.depth = worst.depth.max(steps);
        for attribute in [0, 1] {
            let value = f64::from(pixel.uv[attribute]);
            let error = if quality == "affine" {
                // Whole turns of the texture say where perspective would be.
                let error = value - exact.affine[attribute];
                (error - 256.0 * (error / 256.0).round()).abs()
            } else {
                let (low, high) = truth.triangles[index].range(attribute);
                // Which of two turns is nearer may hang on the rounding of q, where the step is over 256 texels.
                if exact.change[attribute] < 256.0 {
                    let within = f64::from(low) / UNIT..=f64::from(high) / UNIT;
                    assert!(within.contains(&value), "{attribute} is out of range: {}", about());
                }
                (value - exact.uv[attribute]).abs()
            };
            let measured = error / exact.change[attribute];
            assert!(measured <= bound(quality), "{attribute} is {measured} pixels off: {}", about());
            worst.uv = worst.uv.max(measured);
            worst.texels = worst.texels.max(error);
        }
    }
}

/// Every depth rule, cull and quality on random scenes of 300 triangles.
fn hold(ratio: f64) {
    let mut worst = ["exact", "default", "affine"].map(|quality| (quality, Worst::default()));
    let scenes = 2 * cases(1);
    for (scene, reach) in (0..scenes).zip([SMALL, ALL].into_iter().cycle()) {
        let seed = 0x9e37_79b9_7f4a_7c15 ^ ratio.to_bits() ^ u64::from(scene);
        let mut case = Dice(seed).case((96, 64), 300, reach, ratio);
        let mut truth = Truth::new(&case);
        for (rule, cull) in [(0, 0), (0, 1), (0, 2), (1, 0), (1, 1), (1, 2)] {
            (case.rule, case.cull) = (rule, cull);
            for (quality, worst) in &mut worst {
                compare(&case, quality, &mut truth, worst);
            }
        }
    }
    for (quality, Worst { uv, texels, depth, pixels, bare, other_seen }) in worst {
        println!(
            "w 1 … {ratio}, {quality}: {uv:.4} pixel, {texels:.3} texels, {depth:.3} depth steps off at most, over {pixels} \
             pixels of {scenes} scenes of 300 triangles x 6 cases; {bare} bare, {other_seen} show another triangle that \
             is within a depth step"
        );
        assert!(pixels > 25_000 * scenes && bare > 1000 && other_seen <= pixels / 200);
    }
}

#[test]
fn two_scenes_of_300_triangles_at_one_distance_are_as_the_reference_says() {
    hold(1.0);
}

#[test]
fn two_scenes_of_300_triangles_with_w_to_10_are_as_the_reference_says() {
    hold(10.0);
}

#[test]
fn two_scenes_of_300_triangles_with_w_to_1000_are_as_the_reference_says() {
    hold(1000.0);
}

#[test]
fn two_scenes_of_300_triangles_with_w_to_65536_are_as_the_reference_says() {
    hold(65536.0);
}

/// Three triangles over the whole of a 4 × 3 screen: clockwise at w = 2, then counter-clockwise and clockwise at 1.
fn layers() -> Case {
    let vertex = |x, y, w| Vertex { x, y, w, u: -7.25, v: 2000.0, color: [0.0; 3] };
    let [a, b, c] = [(-160, -160), (1600, -160), (-160, 1600)].map(|(x, y)| move |w| vertex(x, y, w));
    let triangles = vec![[a(2.0), b(2.0), c(2.0)], [a(1.0), c(1.0), b(1.0)], [a(1.0), b(1.0), c(1.0)]];
    Case { width: 4, height: 3, rule: 0, cull: 0, triangles }
}

#[test]
fn the_nearest_wins_the_first_of_equals_stays_and_culling_goes_by_the_screen() {
    // (rule, cull) → (how many, which, 1/w)
    let seen = [
        ((0, 0), (3, 2, 1.0)),
        ((0, 1), (1, 1, 1.0)),
        ((0, 2), (2, 2, 1.0)),
        ((1, 0), (3, 1, 1.0)),
        ((1, 1), (1, 1, 1.0)),
        ((1, 2), (2, 2, 1.0)),
    ];
    for ((rule, cull), (count, index, inverse_w)) in seen {
        for quality in ["exact", "default", "affine"] {
            let case = Case { rule, cull, ..layers() };
            for pixel in report(&case, quality) {
                assert_eq!((pixel.count, pixel.index, pixel.uv), (count, index, [-7.25, 2000.0]), "{case:?}");
                assert!((pixel.inverse_w - inverse_w).abs() < 1e-6, "{pixel:?}");
            }
        }
    }
    let far =
        Case { triangles: vec![layers().triangles[1], layers().triangles[0]], rule: 0, cull: 0, ..layers() };
    assert!(
        report(&far, "exact").iter().all(|pixel| (pixel.inverse_w - 0.5).abs() < 1e-6 && pixel.index == 1)
    );
}

#[test]
fn the_quality_is_the_default_one_if_none_is_named() {
    let case = small().bytes();
    let (path, out) = (scratch("case"), scratch("out"));
    fs::write(&path, &case).expect("the case is written");
    let output = run(&[&path, &out]);
    assert_eq!(code(&output), Some(0), "{}", message(&output));
    assert_eq!(fs::read(&out).ok(), probe(&case, "default").1);
    assert_ne!(fs::read(&out).ok(), probe(&case, "affine").1);
    let _ = fs::remove_file(path);
    let _ = fs::remove_file(out);
}

#[test]
fn the_ends_of_every_range_are_taken() {
    let mut case = small();
    case.triangles[0][0] =
        Vertex { x: -16376, y: 16376, w: 65536.0, u: 2000.0, v: -2000.0, color: [f32::NAN; 3] };
    case.triangles[0][1] = Vertex { x: 16376, y: -16376, w: 1.0, u: -0.0, v: 1.0 / 16.0, color: [0.0; 3] };
    for vertex in case.triangles.as_flattened_mut() {
        vertex.w = vertex.w.clamp(1.0, 65536.0);
    }
    report(&case, "default");
    // The smallest and the largest f32 are in order on their own.
    for w in [f32::from_bits(1), f32::MAX] {
        for vertex in case.triangles.as_flattened_mut() {
            vertex.w = w;
        }
        report(&case, "exact");
    }
    let (width, height) = (1023, 1023);
    report(&Case { width, height, ..case.clone() }, "affine");
    let empty = Case { width: 1, height: 1, triangles: Vec::new(), ..case };
    assert_eq!(report(&empty, "exact"), [BARE]);
}

#[test]
fn as_many_triangles_as_an_index_can_tell_apart() {
    let case = Case { triangles: vec![layers().triangles[0]; 65535], ..layers() };
    for pixel in report(&case, "default") {
        assert_eq!((pixel.count, pixel.index), (65535, 65534));
    }
}

// --- Meshes ---

/// An `MSH1` case.
#[derive(Clone, Debug)]
struct MeshCase {
    size: [u32; 2],
    cull: u32,
    focal: f32,
    near: f32,
    matrix: [[f32; 4]; 3],
    vertices: Vec<[f32; 5]>,
    triangles: Vec<[u32; 3]>,
}

impl MeshCase {
    fn bytes(&self) -> Vec<u8> {
        let [width, height] = self.size;
        let counts = [self.vertices.len() as u32, self.triangles.len() as u32];
        let mut bytes = b"MSH1".to_vec();
        bytes.extend([width, height, self.cull, counts[0], counts[1]].map(u32::to_le_bytes).as_flattened());
        bytes.extend([self.focal, self.near].map(f32::to_le_bytes).as_flattened());
        bytes.extend(self.matrix.iter().flatten().flat_map(|element| element.to_le_bytes()));
        bytes.extend(self.vertices.iter().flatten().flat_map(|value| value.to_le_bytes()));
        bytes.extend(self.triangles.iter().flatten().flat_map(|index| index.to_le_bytes()));
        bytes
    }
}

impl Dice {
    fn between(&mut self, low: f64, high: f64) -> f64 {
        low + self.fraction() * (high - low)
    }

    /// Triangles that share their vertices, some before the eye and some behind it. Every number but the rotation is
    /// one that the crate's formats hold; the rotation is given as it is rounded.
    fn mesh(&mut self, (width, height): (u32, u32), count: u32) -> MeshCase {
        let unit = self.within(-6, 6);
        let scale = 2f64.powi(self.within(-5, 5));
        let steps = 2f64.powi(unit - 12);
        let vertices = (0..count / 2 + 3).map(|i| {
            // The first has a coordinate that fixes the unit.
            let mut at = || f64::from(self.within(-32767, 32767)) * steps;
            let place = [if i == 0 { 32000.0 * steps } else { at() }, at(), at()];
            let [u, v] = [self.within(-2047 * 16, 2047 * 16), self.within(-500, 500)];
            [place[0] as f32, place[1] as f32, place[2] as f32, u as f32 / 16.0, v as f32 / 16.0]
        });
        let vertices: Vec<_> = vertices.collect();
        let triangles =
            (0..count).map(|_| [0; 3].map(|_: i32| self.within(0, vertices.len() as i32 - 1) as u32));
        let triangles = triangles.collect();
        let [yaw, pitch] = [0, 1].map(|_| self.between(0.0, std::f64::consts::TAU));
        let ((s, c), (t, d)) = (yaw.sin_cos(), pitch.sin_cos());
        let rotation = [[c, 0.0, s], [t * s, d, -t * c], [-d * s, t, d * c]];
        let size = 8.0 * 2f64.powi(unit) * scale;
        let matrix = rotation.map(|row| {
            let [a, b, c] = row.map(|element| ((element * 16384.0).round() / 16384.0 * scale) as f32);
            // A few bits, so that any format holds them.
            [a, b, c, (self.between(-64.0, 64.0).round() / 64.0 * size) as f32]
        });
        let near = (size * 2f64.powi(self.within(-9, -2))) as f32;
        let focal = self.within(10 * 16, 120 * 16) as f32 / 16.0;
        MeshCase {
            size: [width, height],
            cull: self.within(0, 2) as u32,
            focal,
            near,
            matrix,
            vertices,
            triangles,
        }
    }
}

fn report_of_mesh(case: &MeshCase, quality: &str) -> Vec<Pixel> {
    let (output, report) = probe(&case.bytes(), quality);
    assert_eq!(code(&output), Some(0), "{}", message(&output));
    let [width, height] = case.size;
    pixels(&report.expect("a report"), (width * height) as usize)
}

/// The reference's view of it. The scale is a power of two, the rotation of 14 fraction bits.
fn view_of(case: &MeshCase) -> View {
    let squares: f64 = case.matrix.iter().flat_map(|row| &row[..3]).map(|at| f64::from(*at).powi(2)).sum();
    let scale = 2f64.powi(((squares / 3.0).log2() / 2.0).round() as i32);
    let pose = Placement {
        rotation: case.matrix.map(|[a, b, c, _]| [a, b, c].map(|at| f64::from(at) / scale)),
        scale: [scale; 3],
        translation: case.matrix.map(|row| f64::from(row[3])),
    };
    let rotation = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    let eye = Placement { rotation, scale: [1.0; 3], translation: [0.0; 3] };
    let center = case.size.map(|side| f64::from(side) / 2.0);
    let (focal, near) = (f64::from(case.focal), f64::from(case.near));
    View::new(Lens { focal, center, near, far: f64::INFINITY, orthographic: false }, eye, pose)
}

/// The smallest and the largest.
fn ends(values: impl Iterator<Item = f64>) -> (f64, f64) {
    values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), at| (low.min(at), high.max(at)))
}

/// How far snapping may move the corners, and the outline, in pixels: see `tests/views.rs`.
const SNAPPING: f64 = 1.0 / 16.0;
const MARGIN: f64 = 1.0 / 8.0;

/// Every pixel of a mesh against the reference; the largest errors of u and v, how many were measured, and
/// how many pixels are covered.
fn compare_mesh(case: &MeshCase, facets: &[Facet], quality: &str) -> (f64, u32, u32) {
    let (mut worst, mut clear, mut covered) = (0.0_f64, 0, 0);
    let near = f64::from(case.near);
    let faces = |facet: &Facet| match case.cull {
        0 => true,
        1 => facet.turn < 0.0,
        _ => facet.turn > 0.0,
    };
    for (place, pixel) in report_of_mesh(case, quality).into_iter().enumerate() {
        let [x, y] = [place as u32 % case.size[0], place as u32 / case.size[0]].map(|at| f64::from(at) + 0.5);
        let about = || format!("at {x}, {y}, {quality}: {pixel:?}");
        let candidates = facets.iter().filter(|facet| faces(facet)).map(|facet| (facet.depth([x, y]), facet));
        let candidates: Vec<_> = candidates.filter(|(depth, _)| *depth >= -MARGIN).collect();
        let certain = || candidates.iter().filter(|(depth, _)| *depth >= MARGIN);
        let counts = certain().count()..=candidates.len();
        assert!(counts.contains(&usize::from(pixel.count)), "{counts:?} {}", about());
        if pixel.count == 0 {
            assert_eq!(pixel, BARE);
            continue;
        }
        covered += 1;
        let facet = &facets[usize::from(pixel.index)];
        assert!(candidates.iter().any(|(_, other)| std::ptr::eq(*other, facet)), "{}", about());

        // Whatever is within the snapping.
        let r = SNAPPING;
        let square = [(0.0, 0.0), (-r, -r), (r, -r), (-r, r), (r, r)];
        let around = |facet: &Facet| square.map(|(dx, dy)| facet.at([x + dx, y + dy]));
        let [Some(here), Some(a), Some(b), Some(c), Some(d)] = around(facet) else { continue };
        let hits = [here, a, b, c, d];
        let (low, high) = ends(hits.iter().map(|hit| near / hit.w));
        let step = DEPTH_STEP as f64 / 2f64.powi(31);
        let q = f64::from(pixel.inverse_w) * near;
        assert!((low.min(1.0) - step..=high + step).contains(&q), "{low} to {high} {}", about());
        for (_, other) in certain() {
            let (least, _) = ends(around(other).iter().flatten().map(|hit| near / hit.w));
            assert!(least.min(1.0) <= high + 2.0 * step, "{least} is nearer than {high} {}", about());
        }

        let vertices = case.triangles[usize::from(pixel.index)].map(|i| case.vertices[i as usize]);
        for axis in [0, 1] {
            let texels = vertices.map(|vertex| f64::from(vertex[3 + axis]));
            let value = f64::from(pixel.uv[axis]);
            let neighbours = [(1.0, 0.0), (-1.0, 0.0), (0.0, 1.0), (0.0, -1.0)];
            let steps = neighbours.iter().filter_map(|(dx, dy)| facet.at([x + dx, y + dy]));
            let step = steps.map(|hit| (hit.of(texels) - here.of(texels)).abs()).fold(1.0, f64::max);
            let (low, high) = ends(hits.iter().map(|hit| hit.of(texels)));
            // Which of two turns is nearer may hang on the snapping.
            if step < 256.0 && high - low < 64.0 {
                let error = (low - value).max(value - high).max(0.0) / step;
                assert!(error <= bound(quality), "{axis} is {error} pixels off {}", about());
                worst = worst.max(error);
                clear += 1;
            }
        }
    }
    (worst, clear, covered)
}

#[test]
fn forty_meshes_of_100_triangles_that_cross_the_near_plane_are_as_the_reference_says() {
    let (mut worst, mut clear, mut covered, mut clipped) = ([0.0_f64; 2], 0, 0, 0);
    for number in 0..cases(40) {
        let mut case = Dice(0x1234_5678_9abc_def1 ^ (u64::from(number) << 20)).mesh((64, 48), 100);
        case.cull = number % 3;
        let view = view_of(&case);
        let corner = |i: u32| {
            let [x, y, z, ..] = case.vertices[i as usize].map(f64::from);
            [x, y, z]
        };
        let facets: Vec<_> = case.triangles.iter().map(|corners| view.facet(corners.map(corner))).collect();
        let cut = |facet: &&Facet| facet.outline.iter().any(|side| side.edge.is_none());
        clipped += facets.iter().filter(cut).count();
        let which = number as usize % 2;
        let measured = compare_mesh(&case, &facets, ["default", "exact"][which]);
        worst[which] = measured.0.max(worst[which]);
        (clear, covered) = (clear + measured.1, covered + measured.2);
    }
    println!(
        "meshes: {} of 100 triangles, {clipped} triangles clipped, {covered} pixels covered; u and v of {} pixels off by \
         {:.4} (default) and {:.4} (exact) at most beside the snapping",
        cases(40),
        clear / 2,
        worst[0],
        worst[1]
    );
    assert!(covered > 1000 * cases(40) && clipped > 10 * cases(40) as usize && clear > covered);
}

/// A square 2 units wide, 4 units before the eye, at 32 pixels a unit.
fn square() -> MeshCase {
    let vertices = vec![
        [-1.0, -1.0, 0.0, 0.0, 64.0],
        [1.0, -1.0, 0.0, 64.0, 64.0],
        [1.0, 1.0, 0.0, 64.0, 0.0],
        [-1.0, 1.0, 0.0, 0.0, 0.0],
    ];
    MeshCase {
        size: [80, 72],
        cull: 1,
        focal: 128.0,
        near: 0.5,
        matrix: [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, -4.0]],
        vertices,
        triangles: vec![[0, 1, 2], [0, 2, 3]],
    }
}

#[test]
fn a_mesh_stands_where_its_matrix_says_at_any_scale() {
    for scale in [1.0, 1e-30, 1e-6, 0.001, 0.3, 1000.0, 1e6, 1e30_f32] {
        let mut case = square();
        case.near *= scale;
        for element in case.matrix.as_flattened_mut() {
            *element *= scale;
        }
        for (place, pixel) in report_of_mesh(&case, "exact").into_iter().enumerate() {
            let (x, y) = (place as i32 % 80 - 8, place as i32 / 80 - 4);
            if !((0..64).contains(&x) && (0..64).contains(&y)) {
                assert_eq!(pixel, BARE, "{scale}: {x}, {y}");
                continue;
            }
            assert_eq!(pixel.count, 1, "{scale}: {x}, {y}");
            assert_eq!(pixel.uv, [x as f32 + 0.5, y as f32 + 0.5], "{scale}: {x}, {y}");
            let w = 1.0 / pixel.inverse_w / scale;
            assert!((w - 4.0).abs() < 1e-4, "{scale}: w is {w}");
        }
    }
    // Seen from behind, and drawn behind something: the first stays where both are as near.
    let back = MeshCase { cull: 2, ..square() };
    assert!(report_of_mesh(&back, "default").iter().all(|pixel| *pixel == BARE));
    let twice = MeshCase { cull: 0, triangles: vec![[0, 1, 2], [0, 2, 3], [0, 1, 2], [0, 2, 3]], ..square() };
    assert!(
        report_of_mesh(&twice, "default")
            .iter()
            .all(|pixel| [0, 2].contains(&pixel.count) && (pixel.index < 2) == (pixel.count > 0))
    );
    // Nothing at all.
    let nothing = MeshCase { vertices: Vec::new(), triangles: Vec::new(), ..square() };
    assert!(report_of_mesh(&nothing, "default").iter().all(|pixel| *pixel == BARE));
    let point = MeshCase { vertices: vec![[0.0; 5]; 3], triangles: vec![[0, 1, 2]], ..square() };
    assert!(report_of_mesh(&point, "default").iter().all(|pixel| *pixel == BARE));
}

#[test]
fn what_became_of_a_meshs_numbers_is_printed() {
    let printed = |case: &MeshCase| {
        let (output, report) = probe(&case.bytes(), "default");
        assert_eq!((code(&output), report.is_some()), (Some(0), true), "{}", message(&output));
        String::from_utf8_lossy(&output.stdout).into_owned()
    };
    let text = printed(&square());
    // ±1 fits ±2 only, as 1 is just not below 8/8.
    assert!(
        text.contains("positions: steps of 6.103515625e-5 mesh units")
            && text.contains("moved by at most 0e0"),
        "{text}"
    );
    assert!(text.contains("near plane as drawn: 5e-1") && !text.contains("texels"), "{text}");
    let mut case = square();
    case.vertices[1] = [500.0, -0.01, 0.0, 0.1, 64.0];
    let text = printed(&case);
    assert!(
        text.contains("steps of 1.5625e-2 mesh units") && text.contains("texels: of 1 vertices"),
        "{text}"
    );
}

#[test]
fn every_malformed_field_of_a_mesh_is_named() {
    let good = square().bytes();
    let with = |at: usize, bytes: [u8; 4]| {
        let mut case = good.clone();
        case[at..at + 4].copy_from_slice(&bytes);
        case
    };
    refused(&good[..4], &["header", "4 of 80"]);
    refused(&good[..79], &["header", "79 of 80"]);
    refused(&good[..good.len() - 1], &["ends", "4 vertices", "2 triangles", "103 bytes", "104"]);
    refused(&[&good[..], &[0]].concat(), &["goes on", "105 bytes"]);
    for (at, name) in [(4, "width"), (8, "height")] {
        for side in [0, 1024, u32::MAX] {
            refused(&with(at, side.to_le_bytes()), &[name, &side.to_string(), "1023"]);
        }
    }
    refused(&with(12, 3u32.to_le_bytes()), &["cull is 3"]);
    refused(&with(16, 65537u32.to_le_bytes()), &["65537 vertices", "65536"]);
    refused(&with(16, u32::MAX.to_le_bytes()), &["4294967295 vertices"]);
    refused(&with(20, 65536u32.to_le_bytes()), &["65536 triangles", "65535"]);
    refused(&with(20, u32::MAX.to_le_bytes()), &["4294967295 triangles"]);
    for focal in [0.0, -1.0, 0.06, 8192.0, f32::NAN, f32::INFINITY] {
        refused(&with(24, focal.to_le_bytes()), &["focal length is"]);
    }
    for near in [0.0, -1.0, f32::NAN, f32::INFINITY, 1e-10] {
        refused(&with(28, near.to_le_bytes()), &["near plane is at"]);
    }
    for value in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
        for element in 0..12 {
            refused(&with(32 + 4 * element, value.to_le_bytes()), &["matrix", "not finite"]);
        }
        for (field, name) in [(0, "x is"), (1, "y is"), (2, "z is"), (3, "u is"), (4, "v is")] {
            refused(&with(80 + 20 + 4 * field, value.to_le_bytes()), &["vertex 1", name]);
        }
    }
    for value in [2048.0, -2048.0, 1e30_f32] {
        refused(&with(80 + 12, value.to_le_bytes()), &["vertex 0", "u is", "2047"]);
    }
    for index in [4, 65536, u32::MAX] {
        refused(
            &with(80 + 4 * 20 + 12 + 8, index.to_le_bytes()),
            &["triangle 1", &format!("vertex {index}"), "4"],
        );
    }
    let matrix = |change: &dyn Fn(&mut [[f32; 4]; 3])| {
        let mut case = square();
        change(&mut case.matrix);
        case.bytes()
    };
    refused(&matrix(&|rows| rows[0][0] = 1.001), &["not a rotation"]);
    refused(&matrix(&|rows| rows[0][1] = 0.0002), &["not a rotation"]);
    refused(&matrix(&|rows| rows[0][0] = -1.0), &["mirror"]);
    refused(&matrix(&|rows| rows[2][2] = 0.0), &["not a rotation"]);
    refused(&matrix(&|rows| *rows = [[0.0; 4]; 3]), &["scale of 0"]);
    refused(&matrix(&|rows| rows[2][3] = 1e30), &["near plane is at"]);
    // Within the tolerance.
    let (output, _) = probe(&matrix(&|rows| rows[0][1] = 0.00009), "default");
    assert_eq!(code(&output), Some(0), "{}", message(&output));
}

#[test]
fn changed_bytes_of_a_mesh_never_panic_in_400_cases() {
    let case = square().bytes();
    let at = prop_oneof![1 => 4..80_usize, 1 => 80..case.len()];
    let flips = prop::collection::vec((at, prop_oneof![(0..8).prop_map(|bit| 1u8 << bit), 1..=255_u8]), 1..4);
    let counts = std::cell::Cell::new([0, 0]);
    for_all("changed bytes of a mesh", 400, flips, |flips| {
        let mut case = case.clone();
        for (at, flip) in flips {
            case[at] ^= flip;
        }
        let (output, report) = probe(&case, "default");
        let [taken, not] = counts.get();
        if report.is_some() {
            prop_assert_eq!(code(&output), Some(0), "{}", message(&output));
            counts.set([taken + 1, not]);
        } else {
            prop_assert_eq!(code(&output), Some(2), "{}", message(&output));
            prop_assert!(message(&output).starts_with("probe: ") && message(&output).lines().count() == 1);
            counts.set([taken, not + 1]);
        }
        Ok(())
    });
    println!("changed bytes of a mesh: {:?} taken and refused", counts.get());
}

// --- Malformed cases ---

/// Exit code 2, a message with these words, and nothing written.
fn refused(case: &[u8], words: &[&str]) {
    let (output, report) = probe(case, "default");
    let message = message(&output);
    assert_eq!((code(&output), report), (Some(2), None), "{words:?}: {message}");
    assert!(message.starts_with("probe: ") && message.lines().count() == 1, "{message}");
    for word in words {
        assert!(message.contains(word), "{word:?} is not in: {message}");
    }
}

#[test]
fn every_malformed_field_is_named() {
    let good = small().bytes();
    let with = |at: usize, bytes: [u8; 4]| {
        let mut case = good.clone();
        case[at..at + 4].copy_from_slice(&bytes);
        case
    };
    refused(b"", &["TRI1"]);
    refused(b"TRI", &["TRI1"]);
    refused(&with(0, *b"TRI2"), &["TRI1"]);
    refused(&good[..4], &["header", "4 of 24"]);
    refused(&good[..23], &["header", "23 of 24"]);
    for (at, name) in [(4, "width"), (8, "height")] {
        for side in [0, 1024, u32::MAX] {
            refused(&with(at, side.to_le_bytes()), &[name, &side.to_string(), "1023"]);
        }
    }
    refused(&with(12, 2u32.to_le_bytes()), &["depth rule is 2"]);
    refused(&with(16, 3u32.to_le_bytes()), &["cull is 3"]);
    refused(&with(20, 65536u32.to_le_bytes()), &["65536 triangles", "65535"]);
    refused(&with(20, u32::MAX.to_le_bytes()), &["4294967295 triangles"]);
    refused(&with(20, 6u32.to_le_bytes()), &["ends", "triangle 5", "480 bytes", "576"]);
    refused(&with(20, 4u32.to_le_bytes()), &["goes on", "4 triangles"]);
    refused(&good[..good.len() - 1], &["ends", "triangle 4"]);
    refused(&[&good[..], &[0]].concat(), &["goes on", "5 triangles"]);

    // Triangle 3, vertex 1.
    let field = |number: usize| 24 + 3 * 96 + 32 + 4 * number;
    let place = "triangle 3, vertex 1";
    for (number, name) in [(0, "x is"), (1, "y is")] {
        for at in [-16377, 16377, i32::MIN, i32::MAX] {
            refused(&with(field(number), at.to_le_bytes()), &[place, name, &at.to_string(), "guard band"]);
        }
    }
    for w in [0.0, -0.0, -1.0, f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
        refused(&with(field(2), w.to_le_bytes()), &[place, "w is", &w.to_string()]);
    }
    for w in [0.375 * 65537.0, f32::MAX] {
        refused(&with(field(2), w.to_le_bytes()), &[place, "w is", "65536 times", "0.375"]);
    }
    for (number, name) in [(3, "u is"), (4, "v is")] {
        for texels in [2000.0625, -2000.0625, 1.0 / 32.0, 0.1, f32::NAN, f32::INFINITY, f32::MIN_POSITIVE] {
            refused(&with(field(number), texels.to_le_bytes()), &[place, name, &texels.to_string(), "1/16"]);
        }
    }
}

#[test]
fn wrong_arguments_and_files_that_cannot_be_read_or_written_are_named() {
    let (case, out) = (scratch("case"), scratch("out"));
    fs::write(&case, small().bytes()).expect("the case is written");
    let missing = scratch("missing");
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR"));
    let not_there = missing.join("out");
    let exact = Path::new("exact");
    let wrong: [(i32, &str, &[&Path]); 8] = [
        (2, "usage", &[]),
        (2, "usage", &[&case]),
        (2, "usage", &[&case, &out, exact, exact]),
        (2, "usage", &[&case, &out, Path::new("Exact")]),
        (2, "missing", &[&missing, &out]),
        (2, "tmp", &[folder, &out]),
        (1, "missing", &[&case, &not_there]),
        (1, "tmp", &[&case, folder, exact]),
    ];
    for (expected, words, args) in wrong {
        let output = run(args);
        assert_eq!(code(&output), Some(expected), "{args:?}: {}", message(&output));
        assert!(message(&output).contains(words), "{args:?}: {}", message(&output));
        assert!(!out.exists());
    }
    let _ = fs::remove_file(case);
}

/// Whether a file is what the format asks for, by its description.
fn well_formed(bytes: &[u8]) -> bool {
    let word = |at: usize| bytes.get(at..at + 4).and_then(|word| word.try_into().ok()).unwrap_or([0; 4]);
    let number = |at: usize| u32::from_le_bytes(word(at));
    let float = |at: usize| f64::from(f32::from_le_bytes(word(at)));
    let count = number(20) as usize;
    let header = bytes.get(..4) == Some(b"TRI1")
        && [4, 8].iter().all(|at| (1..1024).contains(&number(*at)))
        && number(12) < 2
        && number(16) < 3
        && count < 65536
        && bytes.len() == 24 + 96 * count;
    let vertices = || (24..bytes.len()).step_by(32);
    let texels = |at: usize| float(at).abs() <= 2000.0 && float(at) * 16.0 % 1.0 == 0.0;
    let place = |at: usize| (-16376..=16376).contains(&i32::from_le_bytes(word(at)));
    let w = || vertices().map(|at| float(at + 8));
    header
        && vertices().all(|at| place(at) && place(at + 4) && texels(at + 12) && texels(at + 16))
        && w().all(|w| w > 0.0 && w < f64::INFINITY)
        && w().fold(0.0, f64::max) <= 65536.0 * w().fold(f64::INFINITY, f64::min)
}

/// Taken if it is well-formed and refused with a message if not.
fn judged(case: &[u8]) -> Result<(), TestCaseError> {
    let (output, report) = probe(case, "default");
    let message = message(&output);
    if well_formed(case) {
        prop_assert_eq!((code(&output), report.is_some()), (Some(0), true), "{}", message);
    } else {
        prop_assert_eq!((code(&output), report.is_some()), (Some(2), false), "{}", message);
        prop_assert!(message.starts_with("probe: ") && message.len() > 20, "{}", message);
    }
    Ok(())
}

#[test]
fn truncations_are_refused_in_200_cases() {
    let case = small().bytes();
    for_all("truncations", 200, 0..case.len(), |length| {
        prop_assert!(!well_formed(&case[..length]));
        judged(&case[..length])
    });
}

#[test]
fn changed_bytes_are_taken_or_refused_and_never_panic_in_600_cases() {
    let case = small().bytes();
    // Headers more often than their size would have it; single bits, which leave more files in order, and bytes.
    let at = prop_oneof![1 => 0..24_usize, 3 => 24..case.len()];
    let flip = prop_oneof![(0..8).prop_map(|bit| 1u8 << bit), 1..=255_u8];
    let flips = prop::collection::vec((at, flip), 1..4);
    for_all("changed bytes", 600, flips, |flips| {
        let mut case = case.clone();
        for (at, flip) in flips {
            case[at] ^= flip;
        }
        judged(&case)
    });
}

#[test]
fn any_bytes_after_a_header_are_taken_or_refused_in_100_cases() {
    let bytes = prop::collection::vec(any::<u8>(), 0..400);
    let header = prop_oneof![Just(0), Just(4), Just(20), Just(24)];
    for_all("any bytes", 100, (header, 0..5_u32, bytes), |(kept, count, bytes)| {
        let mut header = small().bytes();
        header.splice(20..24, count.to_le_bytes());
        judged(&[&header[..kept], &bytes].concat())
    });
}
