//! The promise: whatever the numbers, nothing panics, hangs, overflows or writes outside the target. These are the ends of
//! every format and the ways to describe nothing at all, each by name and in every combination; `tests/robustness.rs`
//! has random ones.

use fixel::embedded_graphics::pixelcolor::Rgb565;
use fixel::embedded_graphics::prelude::*;
use fixel::fixed::types::{I2F14, I12F4, I16F16, U10F22};
use fixel::{
    Band, Camera, Cull, Depth16, DisplayList, Light, Lights, ListMemory, Material, Mesh, Pose, Stats,
    Surface, Texture, Turn, Vec3, Vertex,
};

const CORNERS: [[f32; 3]; 4] = [[-1.0, -1.0, 0.0], [1.0, -1.0, 0.0], [1.0, 1.0, 0.5], [-1.0, 1.0, -0.5]];

/// The last bit of a mesh position.
const STEP: f32 = 0.000_244_140_63;

/// Words past the target, to see that they stay as they are.
const SPARE: usize = 64;

fn vertices(places: &[[f32; 3]]) -> Vec<Vertex> {
    let uv = [[0, 0], [i16::MAX, i16::MIN], [i16::MIN, i16::MAX], [-1, 1]];
    let vertex = |(i, [x, y, z]): (usize, &[f32; 3])| Vertex {
        uv: uv[i % 4].map(I12F4::from_bits),
        color: [255, 0, i as u8],
        normal: [[127, 0, 0], [-128, -128, -128], [0, 0, 0], [1, -1, 127]][i % 4],
        ..Vertex::new(*x, *y, *z)
    };
    places.iter().enumerate().map(vertex).collect()
}

/// Its name, vertices and triangles.
type Parts = (&'static str, Vec<Vertex>, Vec<[u16; 3]>);

/// Meshes by what is wrong with them.
fn meshes() -> Vec<Parts> {
    let (low, high) = (-8.0, 7.999_756);
    let ends = [[low, low, low], [high, high, high], [low, high, low], [high, low, high]];
    vec![
        ("ordinary", vertices(&CORNERS), vec![[0, 1, 2], [0, 2, 3]]),
        ("the ends of the format", vertices(&ends), vec![[0, 1, 2], [3, 1, 0], [2, 3, 1], [0, 3, 2]]),
        ("one corner three times", vertices(&CORNERS), vec![[0, 0, 0], [1, 1, 2], [2, 3, 2]]),
        ("four vertices in one place", vertices(&[[0.25; 3]; 4]), vec![[0, 1, 2], [1, 2, 3]]),
        ("all on a line", vertices(&[[-2.0; 3], [0.0; 3], [1.0; 3], [2.0; 3]]), vec![[0, 1, 2], [1, 3, 2]]),
        ("all in the origin", vertices(&[[0.0; 3]; 4]), vec![[0, 1, 2]]),
        (
            "a step of the format",
            vertices(&[[0.0; 3], [STEP, 0.0, 0.0], [0.0, STEP, 0.0], [0.0; 3]]),
            vec![[0, 1, 2]],
        ),
        ("no triangles", vertices(&CORNERS), Vec::new()),
        ("no vertices", Vec::new(), Vec::new()),
    ]
}

fn translation(bits: [i32; 3]) -> Vec3 {
    let [x, y, z] = bits.map(I16F16::from_bits);
    Vec3::new(x, y, z)
}

/// Poses by what is wrong with them.
fn poses() -> Vec<(&'static str, Pose)> {
    let before = Pose::IDENTITY.at(Vec3::lit(0.0, 0.0, -3.0));
    let rotation =
        |bits: [[i16; 3]; 3]| Pose { rotation: bits.map(|row| row.map(I2F14::from_bits)), ..before };
    vec![
        ("before the eye", before),
        ("a corner in the eye", Pose::IDENTITY.at(Vec3::lit(1.0, 1.0, 0.0))),
        ("around the eye", Pose::IDENTITY),
        ("behind the eye", Pose::IDENTITY.at(Vec3::lit(0.0, 0.0, 3.0))),
        ("edge on", before.rotated_y(Turn::from_degrees(90))),
        ("a scale of nothing", before.scaled(U10F22::ZERO)),
        ("the smallest scale", before.scaled(U10F22::from_bits(1))),
        ("the largest scale", before.scaled(U10F22::MAX)),
        (
            "the largest and the smallest scale",
            before.stretched([U10F22::MAX, U10F22::from_bits(1), U10F22::ONE]),
        ),
        ("flat", before.stretched([U10F22::ONE, U10F22::ZERO, U10F22::ONE])),
        ("a line", before.stretched([U10F22::ZERO, U10F22::MAX, U10F22::ZERO])),
        ("a singular matrix", rotation([[1 << 14, 0, 0], [1 << 14, 0, 0], [0, 0, 0]])),
        ("a matrix of nothing", rotation([[0; 3]; 3])),
        ("a matrix of the least", rotation([[i16::MIN; 3]; 3])),
        ("a matrix of the most", Pose { scale: [U10F22::MAX; 3], ..rotation([[i16::MAX; 3]; 3]) }),
        ("a mirror", rotation([[-(1 << 14), 0, 0], [0, 1 << 14, 0], [0, 0, 1 << 14]])),
        ("the world's low end", Pose { translation: translation([i32::MIN; 3]), ..Pose::IDENTITY }),
        (
            "the world's high end",
            Pose { translation: translation([i32::MAX; 3]), ..before.scaled(U10F22::MAX) },
        ),
        ("the world's far end", Pose::IDENTITY.at(translation([0, 0, i32::MIN])).scaled(U10F22::MAX)),
    ]
}

/// Cameras by what is wrong with them.
fn cameras(size: Size) -> Vec<(&'static str, Camera)> {
    let plain = Camera::focal(30.0, size);
    let orthographic = Camera::orthographic(8.0, size);
    let wild = Pose {
        rotation: [[I2F14::MIN; 3]; 3],
        scale: [U10F22::ZERO; 3],
        translation: translation([i32::MAX; 3]),
    };
    vec![
        ("ordinary", plain),
        ("the smallest near", plain.near(0.0)),
        ("the largest near", plain.near(f32::INFINITY)),
        ("far before near", plain.near(2.0).far(1.0)),
        ("far where near is", plain.near(2.0).far(2.0)),
        ("the smallest far", plain.far(0.0)),
        ("the shortest focal length", Camera::focal(0.0, size)),
        ("the longest focal length", Camera::focal(f32::INFINITY, size).near(0.0)),
        ("an angle of nothing", Camera::perspective(Turn::ZERO, size)),
        ("an angle of a whole turn", Camera::perspective(Turn::from_raw(u16::MAX), size)),
        ("a viewport to the left of the target", plain.viewport(Point::new(-1023, 0))),
        ("a viewport below the target", plain.viewport(Point::new(5, i32::MAX))),
        ("a viewport partly outside", plain.viewport(Point::new(-7, 9))),
        ("the line of sight far off", plain.off_axis(I12F4::MAX, I12F4::MIN)),
        (
            "both as far as they go",
            plain.viewport(Point::new(i32::MIN, i32::MIN)).off_axis(I12F4::MIN, I12F4::MIN),
        ),
        ("orthographic", orthographic),
        ("orthographic, far before near", orthographic.near(5.0).far(1.0)),
        ("orthographic, far where near is", orthographic.near(5.0).far(5.0)),
        ("orthographic, from end to end", orthographic.near(0.0).far(f32::INFINITY)),
        ("orthographic, the largest scale", Camera::orthographic(f32::INFINITY, size).near(0.0).far(1e-9)),
        ("orthographic, the smallest scale", Camera::orthographic(f32::NAN, size)),
        (
            "orthographic, off-axis",
            orthographic.viewport(Point::new(1023, -1023)).off_axis(I12F4::MIN, I12F4::MAX),
        ),
        ("no rotation at all, at the world's end", plain.pose(wild)),
        ("at the world's other end", plain.at(translation([i32::MIN; 3]))),
    ]
}

const SIZES: [(u32, u32); 7] = [(0, 0), (1, 1), (0, 9), (9, 0), (1, 40), (40, 1), (24, 20)];

/// Everything with everything; how many combinations were drawn, and how many of these left a pixel.
fn draw_all(row: u32, surfaces: &[(&str, Surface<'_, Rgb565, Depth16>)], lights: &Lights<'_>) -> (u32, u32) {
    let (mut drawn, mut seen) = (0, 0);
    for (width, height) in SIZES {
        let size = Size::new(width, height);
        let words = (width * height) as usize;
        let (mut pixels, mut depth) = (vec![0_u16; words + SPARE], vec![0_u16; words + SPARE]);
        for (mesh_name, vertices, triangles) in &meshes() {
            let mesh = Mesh::try_new(vertices, triangles).expect("the indices are in range");
            for (pose_name, pose) in &poses() {
                for (camera_name, camera) in &cameras(size) {
                    for (surface_name, surface) in surfaces {
                        let view = camera.lit_by(lights);
                        let about = || {
                            format!(
                                "{mesh_name}, {pose_name}, {camera_name}, {surface_name}, {width} x {height}"
                            )
                        };
                        pixels.fill(0x1234);
                        depth.fill(0);
                        let mut band = Band::<Rgb565, Depth16>::new(size, &mut pixels, &mut depth)
                            .expect("the slices are long enough")
                            .starting_at(row);
                        let mut stats = Stats::default();
                        view.draw_counted(&mesh, pose, surface, &mut band, &mut stats);
                        assert_eq!(stats.meshes, 1, "{}", about());
                        assert!(
                            pixels[words..].iter().all(|word| *word == 0x1234),
                            "pixels past: {}",
                            about()
                        );
                        assert!(depth[words..].iter().all(|word| *word == 0), "depths past: {}", about());
                        let touched =
                            pixels.iter().zip(&depth).any(|(word, depth)| *depth == 0 && *word != 0x1234);
                        assert!(!touched, "a pixel without depth: {}", about());
                        // Kept for later it is the same.
                        let mut memory = ListMemory::<64, 32>::new();
                        let mut list = DisplayList::<_, _, 1>::new(&mut memory);
                        let kept = view.draw(&mesh, pose, surface, &mut list);
                        assert_eq!(kept, Ok(()), "{}", about());
                        let (mut listed, mut listed_depth) = (vec![0x1234; words], vec![0; words]);
                        let mut band = Band::<Rgb565, Depth16>::new(size, &mut listed, &mut listed_depth)
                            .expect("the slices are long enough");
                        list.render(row, &mut band);
                        assert!(listed == pixels[..words], "a list: {}", about());
                        assert!(listed_depth == depth[..words], "a list: {}", about());
                        drawn += 1;
                        seen += u32::from(depth.iter().any(|depth| *depth > 0));
                    }
                }
            }
        }
    }
    (drawn, seen)
}

#[test]
fn every_mesh_pose_camera_and_target_at_its_extremes_86_184_combinations() {
    let texels: Vec<u16> = (0..1 << 10).collect();
    let texture = Texture::new(&texels, 5, 5);
    let lights = [
        Light::directional(Vec3::ZERO, [255; 3]),
        Light::directional(translation([i32::MIN; 3]), [255; 3]),
        Light::point(Vec3::ZERO, [255; 3], I16F16::MAX),
        Light::point(translation([i32::MAX; 3]), [255; 3], I16F16::ZERO),
    ];
    let lights = Lights::new([255; 3], &lights);
    let repeated = Material::textured(&texture).texture_scale(u8::MAX);
    let surfaces = [
        ("texture", (&Material::textured(&texture).cull(Cull::None)).into()),
        ("repeated and lit", (&repeated.lit().faceted()).into()),
        ("lit on both sides", (&Material::gouraud().lit().two_sided().cull(Cull::None)).into()),
    ];
    let (drawn, seen) = draw_all(0, &surfaces, &lights);
    println!("extremes: {drawn} combinations, {seen} of them with a pixel");
    assert!(drawn == 86_184 && seen > 800);
}

/// The unit of clip space follows from the matrix, the radius of a mesh's bounds from the scale alone: here they are as far apart as
/// they can be, and so is the focal length.
#[test]
fn a_matrix_of_nothing_at_the_largest_scale_and_focal_length_draws_nothing() {
    let ends = vertices(&[[-8.0, -8.0, -8.0], [7.999_756, 7.999_756, 7.999_756], [-8.0, 7.999_756, 0.0]]);
    let mesh = Mesh::try_new(&ends, &[[0, 1, 2]]).expect("the indices are in range");
    let nothing = [[I2F14::ZERO; 3]; 3];
    let size = Size::new(24, 20);
    let stood = Pose::IDENTITY.scaled(U10F22::MAX);
    let camera = Camera::focal(f32::INFINITY, size);
    for (camera, pose) in [
        (camera, Pose { rotation: nothing, ..stood }),
        (camera.pose(Pose { rotation: nothing, ..stood }), stood),
        (Camera::orthographic(f32::INFINITY, size), Pose { rotation: nothing, ..stood }),
    ] {
        let (mut pixels, mut depth) = ([0x1234; 24 * 20], [0; 24 * 20]);
        let mut band = Band::<Rgb565, Depth16>::new(size, &mut pixels, &mut depth).expect("large enough");
        camera.draw(&mesh, &pose, &Material::gouraud().cull(Cull::None), &mut band);
        assert!(pixels.iter().all(|word| *word == 0x1234) && depth.iter().all(|depth| *depth == 0));
    }
}

/// Planes at most as far apart as rounding, or the wrong way round, with a mesh that lies across both, and one that lies in the near
/// plane.
#[test]
fn between_planes_that_coincide_or_are_the_wrong_way_round_there_is_nothing() {
    let size = Size::new(40, 30);
    let tilted = |z: f32| vertices(&[[-2.0, -2.0, z], [2.0, -2.0, z], [2.0, 2.0, -z], [-2.0, 2.0, -z]]);
    let (mut cases, bit) = (0, 1.0 / 65536.0);
    for camera in [Camera::focal(30.0, size), Camera::orthographic(9.0, size)] {
        for near in [0.25, 0.3, 1.0, 1.000_015_3, 2.0, 3.7, 100.007, 3000.5] {
            for far in [near, near - bit, near - 3.0 * bit, near / 2.0] {
                for (scale, tilt) in
                    [0.01, 0.3, 1.0, 7.0, 300.0].into_iter().flat_map(|s| [(s, 0.0), (s, 0.5)])
                {
                    let corners = tilted(tilt);
                    let mesh =
                        Mesh::try_new(&corners, &[[0, 1, 2], [0, 2, 3]]).expect("the indices are in range");
                    let pose = Pose::IDENTITY.scaled_lit(scale).at(Vec3::lit(0.0, 0.0, -near));
                    let (mut pixels, mut depth) = ([0x1234; 40 * 30], [0; 40 * 30]);
                    let mut band =
                        Band::<Rgb565, Depth16>::new(size, &mut pixels, &mut depth).expect("large enough");
                    let surface = Material::gouraud().cull(Cull::None);
                    camera.near(near).far(far).draw(&mesh, &pose, &surface, &mut band);
                    let drawn = pixels.iter().filter(|word| **word != 0x1234).count();
                    assert_eq!(drawn, 0, "near {near}, far {far}, scale {scale}, tilt {tilt}");
                    cases += 1;
                }
            }
        }
    }
    println!("{cases} pairs of planes with nothing between them");
}
