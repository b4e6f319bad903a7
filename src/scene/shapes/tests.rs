use super::*;
use crate::num::{I4F12, I12F4};
use crate::scene::{Mesh, Vertex};
use std::collections::{BTreeMap, BTreeSet};
use std::{println, vec::Vec};

type V3 = [f64; 3];

/// The three vertices of each triangle.
fn corners<'a>(mesh: &Mesh<'a>) -> impl Iterator<Item = [&'a Vertex; 3]> {
    let vertices = mesh.vertices();
    mesh.triangles().map(move |triangle| triangle.map(|index| &vertices[usize::from(index)]))
}

fn dot(a: V3, b: V3) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross(a: V3, b: V3) -> V3 {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

fn minus(a: V3, b: V3) -> V3 {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

fn unit(v: V3) -> V3 {
    scale(v, 1.0 / dot(v, v).sqrt())
}

fn scale(v: V3, by: f64) -> V3 {
    v.map(|component| component * by)
}

fn place(vertex: &Vertex) -> V3 {
    vertex.position.map(f64::from)
}

fn normal(vertex: &Vertex) -> V3 {
    vertex.normal.map(|component| f64::from(component) / 127.0)
}

/// A face's normal, and twice its area.
fn face(corners: [&Vertex; 3]) -> (V3, f64) {
    let [a, b, c] = corners.map(place);
    let n = cross(minus(b, a), minus(c, a));
    (unit(n), dot(n, n).sqrt())
}

/// What holds for every shape: sizes, every vertex used, normals, coordinates' ranges, directions. `steepest` is
/// the smallest cosine between a corner's normal and the face's.
fn check(name: &str, mesh: &Mesh<'_>, counts: Counts, texels: [u16; 2], steepest: f64) {
    assert_eq!(mesh.vertices().len(), counts.vertices, "{name}");
    assert_eq!(mesh.triangles().len(), counts.triangles, "{name}");
    let used: BTreeSet<u16> = mesh.triangles().flatten().collect();
    assert_eq!(used.len(), counts.vertices, "{name}: vertices that no triangle uses");

    for vertex in mesh.vertices() {
        let n = normal(vertex);
        assert!((dot(n, n).sqrt() - 1.0).abs() < 1.0 / 127.0, "{name}: {vertex:?}");
        assert_eq!(vertex.color, [255; 3]);
    }
    for (axis, texels) in texels.into_iter().enumerate() {
        let all = || mesh.vertices().iter().map(|vertex| vertex.uv[axis]);
        assert_eq!(all().min(), Some(I12F4::ZERO), "{name}");
        assert_eq!(all().max(), Some(I12F4::from_num(texels)), "{name}");
    }
    let mut worst = 1f64;
    for corners in corners(mesh) {
        let (n, area) = face(corners);
        assert!(area > 0.0, "{name}: a triangle without area");
        for corner in corners {
            worst = worst.min(dot(n, normal(corner)));
        }
    }
    println!("{name}: {counts:?}, cosine of normals to faces at least {worst:.3}");
    assert!(worst > steepest, "{name}: {worst}");
}

/// Every edge is there once in each direction, and the volume, positive if faces look outward, is about `volume`.
fn check_closed(name: &str, mesh: &Mesh<'_>, volume: f64) {
    let mut edges = BTreeMap::new();
    let mut sum = 0.0;
    for [a, b, c] in corners(mesh) {
        for (from, to) in [(a, b), (b, c), (c, a)] {
            assert_ne!(from.position, to.position, "{name}");
            *edges.entry((from.position, to.position)).or_insert(0) += 1;
        }
        sum += dot(place(a), cross(place(b), place(c))) / 6.0;
    }
    for (&(from, to), &times) in &edges {
        assert_eq!((times, edges.get(&(to, from))), (1, Some(&1)), "{name}: {from:?} {to:?}");
    }
    println!("{name}: closed, {} edges, volume {sum:.4} of {volume:.4}", edges.len() / 2);
    assert!((sum / volume - 1.0).abs() < 2e-3, "{name}: volume {sum}, {volume}");
    // Euler: V − E + F = 2 − 2 · holes.
    let places = edges.keys().map(|&(from, _)| from).collect::<BTreeSet<_>>().len() as i32;
    let euler = places - edges.len() as i32 / 2 + mesh.triangles().len() as i32;
    assert_eq!(euler, if name.starts_with("torus") { 0 } else { 2 }, "{name}");
}

/// Seen from outside, no triangle has its texture mirrored, and some of it.
fn check_not_mirrored(name: &str, mesh: &Mesh<'_>) {
    for [a, b, c] in corners(mesh) {
        let uv = |vertex: &Vertex| vertex.uv.map(f64::from);
        let ([au, av], [bu, bv], [cu, cv]) = (uv(a), uv(b), uv(c));
        // v points down: counter-clockwise is negative.
        let area = (bu - au) * (cv - av) - (cu - au) * (bv - av);
        assert!(area < 0.0, "{name}: {a:?} {b:?} {c:?}");
    }
}

const PI: f64 = core::f64::consts::PI;

/// The volume of a prism of `n` sides, relative to a cylinder's.
fn polygon(n: f64) -> f64 {
    (2.0 * PI / n).sin() * n / (2.0 * PI)
}

static TORUS: Shape<500, 1000> = torus(1.0, 0.45, 25, 20);
const TORUS_MESH: Mesh<'_> = TORUS.mesh();
static TEXTURED: Shape<546, 1000> = torus_textured(1.0, 0.45, 25, 20, [256, 64]);

#[test]
fn tori_are_closed_smooth_and_as_large_as_they_should_be() {
    // Pappus, with the areas of polygons.
    let volume = 2.0 * PI * PI * 0.45 * 0.45 * polygon(20.0) * polygon(25.0);
    check("torus", &TORUS_MESH, Counts { vertices: 500, triangles: 1000 }, [0; 2], 0.9);
    check_closed("torus", &TORUS_MESH, volume);
    let textured = TEXTURED.mesh();
    check("torus_textured", &textured, Counts { vertices: 26 * 21, triangles: 1000 }, [256, 64], 0.9);
    check_closed("torus_textured", &textured, volume);
    check_not_mirrored("torus_textured", &textured);

    for vertex in TORUS.vertices.iter().chain(&TEXTURED.vertices) {
        let [x, y, z] = place(vertex);
        let across = x.hypot(y);
        let exact = unit([x / across * (across - 1.0), y / across * (across - 1.0), z]);
        assert!(((across - 1.0).hypot(z) - 0.45).abs() < 3e-4);
        assert!((0..3).all(|i| (normal(vertex)[i] - exact[i]).abs() < 0.75 / 127.0), "{vertex:?}");
    }
    assert_eq!(TORUS.vertices[0].position, [1.45, 0.0, 0.0].map(I4F12::from_num));
    // The two tori have the same triangles, in the same order.
    let same = corners(&TORUS_MESH).zip(corners(&textured));
    assert!(same.into_iter().all(|(a, b)| a.map(|v| v.position) == b.map(|v| v.position)));
}

/// The benchmark's scene s3: 420 of the triangles face the camera.
#[test]
fn the_torus_is_that_of_the_benchmark() {
    let turn = |[x, y, z]: V3| {
        let (s, c) = (-50f64).to_radians().sin_cos();
        let (y, z) = (y * c - z * s, y * s + z * c);
        let (s, c) = (-25f64).to_radians().sin_cos();
        [z * s + x * c, y, z * c - x * s - 2.44]
    };
    let fronts = corners(&TORUS_MESH).filter(|corners| {
        let [a, b, c] = corners.map(place).map(turn);
        dot(cross(minus(b, a), minus(c, a)), a) < 0.0
    });
    assert_eq!(fronts.count(), 420);
}

#[test]
fn uv_spheres_are_closed_smooth_and_as_large_as_they_should_be() {
    static GLOBE: Shape<{ Counts::uv_sphere(24, 12).vertices }, 528> = uv_sphere(2.0, 24, 12, [512, 256]);
    static LEAST: Shape<10, 6> = uv_sphere(1.0, 3, 2, [1, 1]);
    let mesh = GLOBE.mesh();
    check("uv_sphere 24 × 12", &mesh, Counts::uv_sphere(24, 12), [512, 256], 0.97);
    // Slices of the solid of revolution of a half 24-gon: frusta.
    let frusta: f64 = (0..12)
        .map(|i| {
            let [(s, c), (t, d)] = [i, i + 1].map(|i| (f64::from(i) / 12.0 * PI).sin_cos());
            PI / 3.0 * (c - d) * (s * s + s * t + t * t)
        })
        .sum();
    check_closed("uv_sphere 24 × 12", &mesh, 8.0 * frusta * polygon(24.0));
    check_not_mirrored("uv_sphere 24 × 12", &mesh);
    check("uv_sphere 3 × 2", &LEAST.mesh(), Counts { vertices: 10, triangles: 6 }, [1, 1], 0.2);
    check_closed("uv_sphere 3 × 2", &LEAST.mesh(), polygon(3.0) * PI * 2.0 / 3.0);
    on_sphere(&mesh, 2.0);
    // The middle of the texture faces +z, and what is right of it +x.
    let at = |u: i32, v: i32| {
        GLOBE.vertices.iter().find(|vertex| vertex.uv == [u, v].map(I12F4::from_num::<i32>)).map(place)
    };
    assert_eq!(at(256, 128), Some([0.0, 0.0, 2.0]));
    assert_eq!(at(384, 128), Some([2.0, 0.0, 0.0]));
    assert_eq!(at(0, 128), Some([0.0, 0.0, -2.0]));
}

fn on_sphere(mesh: &Mesh<'_>, radius: f64) {
    for vertex in mesh.vertices() {
        let p = place(vertex);
        assert!((dot(p, p).sqrt() - radius).abs() < 3e-4);
        let exact = unit(p);
        assert!((0..3).all(|i| (normal(vertex)[i] - exact[i]).abs() < 0.6 / 127.0), "{vertex:?}");
    }
}

#[test]
fn icospheres_are_closed_smooth_and_even() {
    static TWENTY: Shape<12, 20> = icosphere(1.0, 1);
    static FINE: Shape<642, 1280> = icosphere(1.0, 8);
    static ODD: Shape<{ Counts::icosphere(7).vertices }, { Counts::icosphere(7).triangles }> =
        icosphere(3.0, 7);
    for (name, mesh, frequency, radius, least) in [
        ("icosphere 1", TWENTY.mesh(), 1, 1.0, 0.78),
        ("icosphere 8", FINE.mesh(), 8, 1.0, 0.98),
        ("icosphere 7", ODD.mesh(), 7, 3.0, 0.97),
    ] {
        check(name, &mesh, Counts::icosphere(frequency), [0; 2], least);
        // The icosahedron's is 2.5362; the others' by their areas, as heights are close to 1.
        let pyramids: f64 = corners(&mesh)
            .map(|corners| {
                let (n, area) = face(corners);
                area / 6.0 * dot(n, place(corners[0]))
            })
            .sum();
        check_closed(name, &mesh, if frequency == 1 { 2.536_150 } else { pyramids });
        on_sphere(&mesh, radius);
        let areas: Vec<f64> = corners(&mesh).map(|corners| face(corners).1).collect();
        let (low, high) =
            areas.iter().fold((f64::MAX, 0f64), |(low, high), &area| (low.min(area), high.max(area)));
        println!("{name}: largest to smallest triangle {:.2}", high / low);
        assert!(
            high / low < 2.0
                && pyramids > (if frequency == 1 { 0.6 } else { 0.96 }) * 4.18879 * radius.powi(3)
        );
    }
}

#[test]
fn cylinders_are_closed_and_their_caps_flat() {
    static CAN: Shape<66, 60> = cylinder(1.0, 3.0, 16, [128, 64], [32, 32]);
    static ODD: Shape<{ Counts::cylinder(5).vertices }, { Counts::cylinder(5).triangles }> =
        cylinder(2.0, 1.0, 5, [128, 64], [32, 32]);
    for (name, mesh, n, volume, least) in
        [("cylinder 16", CAN.mesh(), 16, 3.0, 0.97), ("cylinder 5", ODD.mesh(), 5, 4.0, 0.8)]
    {
        check(name, &mesh, Counts::cylinder(n), [128, 64], least);
        check_closed(name, &mesh, volume * PI * polygon(n as f64));
        check_not_mirrored(name, &mesh);
        for corners in corners(&mesh) {
            let (n, _) = face(corners);
            let flat = corners.iter().all(|corner| corner.normal[0] == 0 && corner.normal[2] == 0);
            assert_eq!(flat, n[1].abs() > 0.5);
            assert!(
                !flat || corners.iter().all(|corner| f64::from(corner.normal[1]) == (127.0 * n[1]).round())
            );
        }
    }
}

#[test]
fn cubes_are_closed_and_flat_with_the_texture_on_every_face() {
    static CUBE: Shape<24, 12> = cube(2.0, [64, 32]);
    let mesh = CUBE.mesh();
    check("cube", &mesh, Counts { vertices: 24, triangles: 12 }, [64, 32], 0.999_999);
    check_closed("cube", &mesh, 8.0);
    check_not_mirrored("cube", &mesh);
    assert!(mesh.vertices().iter().flat_map(|vertex| vertex.position).all(|p| p == 1 || p == -1));
}

#[test]
fn quads_and_grids_face_the_viewer() {
    static QUAD: Shape<4, 2> = quad(2.0, 1.0, [64, 32]);
    static GRID: Shape<20, 24> = grid(15.0, 15.0, 4, 3, [2047, 100]);
    for (name, mesh, counts, texels) in [
        ("quad", QUAD.mesh(), Counts::grid(1, 1), [64, 32]),
        ("grid", GRID.mesh(), Counts::grid(4, 3), [2047, 100]),
    ] {
        check(name, &mesh, counts, texels, 0.999_999);
        check_not_mirrored(name, &mesh);
        assert!(mesh.vertices().iter().all(|vertex| vertex.normal == [0, 0, 127]));
    }
    // Top left.
    assert_eq!(place(&QUAD.vertices[0]), [-1.0, 0.5, 0.0]);
    assert_eq!(QUAD.vertices[0].uv, [I12F4::ZERO; 2]);
    assert_eq!(QUAD.clone().color(1, 2, 3).vertices[3].color, [1, 2, 3]);
}

#[test]
fn sines_are_exact_to_2_in_10_pow_15() {
    let mut worst = 0f64;
    for n in 1..400 {
        for i in 0..=n {
            let (s, c) = round::sin_cos(i, n);
            let exact = (i as f64 / n as f64 * 2.0 * PI).sin_cos();
            worst = worst.max((s - exact.0).abs()).max((c - exact.1).abs());
        }
    }
    println!("sine in const: error within {worst:.2e}");
    assert!(worst < 2e-15);
}

fn message(make: impl FnOnce() + std::panic::UnwindSafe) -> std::string::String {
    let error = std::panic::catch_unwind(make).err();
    error
        .and_then(|e| {
            e.downcast_ref::<std::string::String>().cloned().or(e.downcast_ref::<&str>().map(|&s| s.into()))
        })
        .unwrap_or_default()
}

#[test]
fn what_makes_no_shape_is_refused_by_name() {
    assert_eq!(message(|| drop(torus::<500, 999>(1.0, 0.45, 25, 20))), "this shape is a Shape<500, 1000>");
    assert_eq!(message(|| drop(icosphere::<1, 1>(1.0, 64))), "this shape is a Shape<40962, 81920>");
    assert_eq!(message(|| drop(icosphere::<1, 1>(1.0, 100))), "a shape has at most 65536 vertices");
    assert_eq!(message(|| drop(torus::<4, 8>(1.0, 0.45, 2, 2))), "a torus has at least 3 rings and 3 sides");
    assert_eq!(message(|| drop(torus::<9, 18>(1.0, 1.45, 3, 3))), "a torus has a hole: minor < major");
    for bad in [f32::NAN, 0.0, -1.0, f32::INFINITY] {
        assert_eq!(message(|| drop(cube(bad, [1, 1]))), "a length of the shape is not above 0 and below 16");
    }
    assert_eq!(
        message(|| drop(uv_sphere::<10, 6>(8.5, 3, 2, [1, 1]))),
        "a vertex of the shape is not within −8 … 7.9998"
    );
    assert_eq!(message(|| drop(quad(1.0, 1.0, [2048, 1]))), "texture coordinates end at 2047");
}
