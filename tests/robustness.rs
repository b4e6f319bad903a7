//! The promise: no input panics, none writes outside the target, none overflows. These tests run with overflow checks
//! and debug assertions, and feed everything that a type can hold.

use crate::{common, reference};

use common::generate::{GUARD_BAND, strip};
use common::perspective::mesh_case;
use common::{Canvas, Counting, Drawn, Met, Record, Recorder, Recording, Strip, for_all, survives};
use fixel::embedded_graphics::pixelcolor::Rgb565;
use fixel::embedded_graphics::prelude::*;
use fixel::fixed::types::{I2F14, I4F12, I12F4, I16F16, U1F31, U8F8, U10F22};
use fixel::material::Kind;
use fixel::{
    Affine, Band, BigEndian, Camera, Cull, Depth16, DepthFormat, DisplayList, Exact, Inputs, Light, Lights,
    ListMemory, Material, Mesh, MeshError, NoDepth, PerspectiveImage, PixelFormat, Pose, Quality,
    QuarterPixel, RangeError, ScreenVertex, Surface, Texture, Turn, Vec3, Vertex,
};
use proptest::prelude::*;
use reference::{Corner, Triangle};

const CULLS: [Cull; 3] = [Cull::None, Cull::Back, Cull::Front];
const INPUTS: [Inputs; 4] = [Inputs::None, Inputs::Uv, Inputs::Color, Inputs::UvColor];

/// Any bits, the ends of the type and of its promised range more often.
fn position() -> impl Strategy<Value = i16> {
    let (low, high) = (*GUARD_BAND.start() as i16, *GUARD_BAND.end() as i16);
    prop_oneof![
        2 => any::<i16>(),
        8 => low..=high,
        4 => -200..1500_i16,
        1 => prop_oneof![Just(i16::MIN), Just(i16::MAX), Just(low), Just(low - 1), Just(high), Just(high + 1), Just(0)],
    ]
}

fn q() -> impl Strategy<Value = u32> {
    prop_oneof![
        3 => any::<u32>(),
        3 => (any::<u32>(), 0..32_u32).prop_map(|(bits, shift)| bits >> shift),
        1 => prop_oneof![Just(0), Just(1), Just(u32::MAX), Just(1 << 31), Just((1 << 31) - 1), Just((1 << 31) + 1)],
    ]
}

fn texel() -> impl Strategy<Value = i32> {
    let limit = 8192 << 16;
    prop_oneof![
        1 => any::<i32>(),
        12 => -limit..=limit,
        4 => -(64 << 16)..=64 << 16,
        1 => prop_oneof![Just(i32::MIN), Just(i32::MAX), Just(limit + 1), Just(-limit - 1)],
        2 => prop_oneof![Just(limit), Just(-limit), Just(0)],
    ]
}

/// A vertex of any bits whatever.
fn vertex() -> impl Strategy<Value = ScreenVertex> {
    (position(), position(), q(), texel(), texel(), any::<[u16; 3]>()).prop_map(|(x, y, q, u, v, color)| {
        ScreenVertex {
            x: I12F4::from_bits(x),
            y: I12F4::from_bits(y),
            q: U1F31::from_bits(q),
            u: I16F16::from_bits(u),
            v: I16F16::from_bits(v),
            color: color.map(U8F8::from_bits),
        }
    })
}

fn in_range(vertex: &ScreenVertex) -> bool {
    let place = [vertex.x, vertex.y].map(|value| i32::from(value.to_bits()));
    let texel = [vertex.u, vertex.v].map(|value| value.to_bits().unsigned_abs());
    place.iter().all(|value| GUARD_BAND.contains(value)) && texel.iter().all(|value| *value <= 8192 << 16)
}

/// The same vertex for the reference. Distances saturate as `ScreenVertex` says.
fn corner(vertex: &ScreenVertex) -> Corner {
    let [r, g, b] = vertex.color.map(|channel| i32::from(channel.to_bits()) << 8);
    Corner {
        x: vertex.x.to_bits().into(),
        y: vertex.y.to_bits().into(),
        q: vertex.q.to_bits().clamp(1, (1 << 31) - 1),
        attributes: [vertex.u.to_bits(), vertex.v.to_bits(), r, g, b],
    }
}

/// Targets of few pixels, of none, and of one row or column.
fn target() -> impl Strategy<Value = (Strip, u32)> {
    let sizes = prop_oneof![
        1 => (Just(0), 0..=1023_u32),
        1 => (0..=1023_u32, Just(0)),
        1 => (Just(1), 0..=1023_u32),
        1 => (0..=1023_u32, Just(1)),
        4 => (0..=60_u32, 0..=60_u32),
        1 => strip().prop_map(|strip| (strip.width, strip.height)),
    ];
    let row = prop_oneof![4 => Just(0), 2 => 0..=1023_u32, 1 => any::<u32>()];
    // A screen is at most 1023 rows high: the row of a band saturates there.
    (sizes, row).prop_map(|((width, height), row)| (Strip::new(width, height, row.min(1023)), row))
}

/// More words than the target needs, to see that these stay as they are.
const SPARE: usize = 70;

/// What `draw_triangle` says, the pixels and the depths.
type Outcome<P, D> = (Result<(), RangeError>, Vec<P>, Vec<D>);

fn draw<'a, F, D, S>(
    (strip, row): (Strip, u32),
    blank: (F::Word, D::Word),
    vertices: &[ScreenVertex; 3],
    cull: Cull,
    surface: S,
) -> Outcome<F::Word, D::Word>
where
    F: PixelFormat,
    D: DepthFormat,
    S: Into<Surface<'a, F, D>>,
{
    let (mut pixels, mut depth) = (vec![blank.0; strip.len() + SPARE], vec![blank.1; strip.len() + SPARE]);
    let mut band = Band::<F, D>::new(strip.size(), &mut pixels, &mut depth)
        .expect("the slices are long enough")
        .starting_at(row);
    let result = fixel::draw_triangle(vertices, cull, surface, &mut band);
    (result, pixels, depth)
}

fn recorded<Q: Quality>(
    target: (Strip, u32),
    vertices: &[ScreenVertex; 3],
    cull: Cull,
    inputs: Inputs,
) -> Result<(), TestCaseError> {
    let blank = (Drawn::default(), Counting::CLEAR);
    let shader = Recorder::<Q>::new(inputs);
    let (result, pixels, depth) =
        draw::<Recording, Counting, _>(target, blank, vertices, cull, Surface::new(&shader));
    let good = vertices.iter().all(in_range);
    prop_assert_eq!(result.is_ok(), good);
    let strip = target.0;
    prop_assert!(
        pixels[strip.len()..].iter().all(|drawn| *drawn == Drawn::default()),
        "pixels past the target"
    );
    prop_assert!(depth[strip.len()..].iter().all(|met| *met == Counting::CLEAR), "depths past the target");
    let triangle = Triangle([0, 1, 2].map(|i| corner(&vertices[i])));
    let drawn = good && survives(triangle.facing(), cull);
    let record = Record { strip, pixels, depth };
    for ((x, y), pixel, met) in record.iter() {
        let inside = drawn && triangle.covers(x, y);
        prop_assert_eq!((pixel.written, met.times), (inside, u32::from(inside)), "at {}, {}", x, y);
        if !inside {
            prop_assert_eq!((pixel, met), (Drawn::default(), Met::default()));
            continue;
        }
        prop_assert!(triangle.at(x, y).depth_error(met.q) <= 1.0, "q is {} at {}, {}", met.q, x, y);
        let reads = match inputs {
            Inputs::None => 0..0,
            Inputs::Uv => 0..2,
            Inputs::Color => 2..5,
            Inputs::UvColor => 0..5,
        };
        for (attribute, value) in pixel.attributes.into_iter().enumerate() {
            let (low, high) = if reads.contains(&attribute) { triangle.sampled(attribute) } else { (0, 0) };
            prop_assert!(
                (low..=high).contains(&value),
                "attribute {} is {} at {}, {}, not {} … {}",
                attribute,
                value,
                x,
                y,
                low,
                high
            );
        }
    }
    Ok(())
}

#[test]
fn triangles_of_any_bits_are_drawn_within_range_or_refused_30_000_cases() {
    let vertices = prop_oneof![
        6 => [vertex(), vertex(), vertex()],
        // One vertex near another: slivers and small triangles with wild attributes.
        3 => ([vertex(), vertex(), vertex()], -20..=20_i16, -20..=20_i16).prop_map(|([a, b, mut c], dx, dy)| {
            c.x = I12F4::from_bits(b.x.to_bits().saturating_add(dx));
            c.y = I12F4::from_bits(b.y.to_bits().saturating_add(dy));
            [a, b, c]
        }),
    ];
    let cases = (target(), vertices, 0..CULLS.len(), 0..INPUTS.len(), 0..3_u8);
    for_all("vertices of any bits", 30_000, cases, |(target, vertices, cull, inputs, quality)| {
        let (cull, inputs) = (CULLS[cull], INPUTS[inputs]);
        match quality {
            0 => recorded::<QuarterPixel>(target, &vertices, cull, inputs),
            1 => recorded::<Exact>(target, &vertices, cull, inputs),
            _ => recorded::<Affine>(target, &vertices, cull, inputs),
        }
    });
}

/// Every kind of material, in every quality, on every built-in format.
fn on_all_formats<K: Kind, Q: Quality>(
    target: (Strip, u32),
    vertices: &[ScreenVertex; 3],
    material: &Material<'_, K, Q>,
) -> Result<(), TestCaseError> {
    let good = vertices.iter().all(in_range);
    let native = draw::<Rgb565, Depth16, _>(target, (0x1234, 0), vertices, Cull::None, material);
    let swapped = draw::<BigEndian<Rgb565>, Depth16, _>(target, (0x3412, 0), vertices, Cull::None, material);
    let flat = draw::<Rgb565, NoDepth, _>(target, (0x1234, ()), vertices, Cull::None, material);
    prop_assert_eq!([native.0.is_ok(), swapped.0.is_ok(), flat.0.is_ok()], [good; 3]);
    let triangle = Triangle([0, 1, 2].map(|i| corner(&vertices[i])));
    // Depth or none, one byte order or the other: the same picture.
    prop_assert_eq!(&native.1, &flat.1);
    prop_assert_eq!(&native.2, &swapped.2);
    if cfg!(target_endian = "little") {
        prop_assert!(native.1.iter().map(|word| word.swap_bytes()).eq(swapped.1.iter().copied()));
    }
    for ((x, y), (word, depth)) in target.0.pixels().zip(native.1.iter().zip(&native.2)) {
        let inside = good && triangle.covers(x, y);
        prop_assert_eq!(*depth != 0, inside);
        prop_assert!(inside || *word == 0x1234);
    }
    prop_assert!(native.1[target.0.len()..].iter().all(|word| *word == 0x1234), "pixels past the target");
    prop_assert!(native.2[target.0.len()..].iter().all(|word| *word == 0), "depths past the target");
    Ok(())
}

#[test]
fn materials_on_triangles_of_any_bits_10_000_cases() {
    let texels: Vec<u16> = (0..=u16::MAX).collect();
    let sizes = [(0, 0), (8, 8), (10, 6), (6, 10), (3, 5)];
    let cases = (target(), [vertex(), vertex(), vertex()], 0..5_u8, 0..3_u8, 0..sizes.len());
    for_all("materials on vertices of any bits", 10_000, cases, |(target, vertices, kind, quality, size)| {
        let (width, height) = sizes[size];
        let texture = Texture::new(&texels[..1 << (width + height)], width, height);
        match kind {
            0 => in_a_quality(quality, target, &vertices, Material::flat(Rgb565::MAGENTA)),
            1 => in_a_quality(quality, target, &vertices, Material::gouraud()),
            2 => in_a_quality(quality, target, &vertices, Material::textured(&texture)),
            3 => in_a_quality(quality, target, &vertices, Material::mirrored(&texture)),
            _ => in_a_quality(quality, target, &vertices, Material::clamped(&texture)),
        }
    });
}

fn in_a_quality(
    quality: u8,
    target: (Strip, u32),
    vertices: &[ScreenVertex; 3],
    material: Material<'_, impl Kind>,
) -> Result<(), TestCaseError> {
    match quality {
        0 => on_all_formats(target, vertices, &material),
        1 => on_all_formats(target, vertices, &material.exact()),
        _ => on_all_formats(target, vertices, &material.affine()),
    }
}

#[test]
fn small_triangles_are_the_same_in_bands_of_one_row_20_000_cases() {
    let texels: Vec<u16> = (0..=u16::MAX).collect();
    let cases = (mesh_case(), 0..6_u8, 0..3_u8, any::<bool>());
    for_all("small triangles in bands", 20_000, cases, |(case, kind, quality, gray)| {
        let texture = Texture::new(&texels[..1 << 12], 6, 6);
        let mut vertices = case.triangle.0.map(common::screen_vertex);
        if gray {
            for vertex in &mut vertices {
                vertex.color = [vertex.color[0]; 3];
            }
        }
        match kind {
            0 => in_bands_and_a_quality(quality, case.strip, &vertices, Material::flat(Rgb565::MAGENTA)),
            1 => in_bands_and_a_quality(quality, case.strip, &vertices, Material::gouraud()),
            2 => in_bands_and_a_quality(quality, case.strip, &vertices, Material::textured(&texture)),
            3 => in_bands_and_a_quality(quality, case.strip, &vertices, Material::clamped(&texture)),
            4 => in_bands_and_a_quality(quality, case.strip, &vertices, Material::textured(&texture).lit()),
            _ => in_bands_and_a_quality(quality, case.strip, &vertices, Material::clamped(&texture).lit()),
        }
    });
}

fn in_bands_and_a_quality(
    quality: u8,
    strip: Strip,
    vertices: &[ScreenVertex; 3],
    material: Material<'_, impl Kind>,
) -> Result<(), TestCaseError> {
    match quality {
        0 => in_bands(strip, vertices, &material),
        1 => in_bands(strip, vertices, &material.exact()),
        _ => in_bands(strip, vertices, &material.affine()),
    }
}

/// The whole strip, with and without depth, against every row for itself.
fn in_bands<K: Kind, Q: Quality>(
    strip: Strip,
    vertices: &[ScreenVertex; 3],
    material: &Material<'_, K, Q>,
) -> Result<(), TestCaseError> {
    on_all_formats((strip, strip.row), vertices, material)?;
    let target = |row: u32, height: u32| (Strip::new(strip.width, height, row), row);
    let whole = draw::<Rgb565, Depth16, _>(
        target(strip.row, strip.height),
        (0x1234, 0),
        vertices,
        Cull::None,
        material,
    );
    let width = strip.width as usize;
    for i in 0..strip.height {
        let row =
            draw::<Rgb565, Depth16, _>(target(strip.row + i, 1), (0x1234, 0), vertices, Cull::None, material);
        let from = i as usize * width;
        prop_assert_eq!(&row.1[..width], &whole.1[from..from + width]);
        prop_assert_eq!(&row.2[..width], &whole.2[from..from + width]);
    }
    Ok(())
}

// The strategies below are boxed: nested ones of so many parts would not fit a test's stack otherwise.

/// Any `f32`: ordinary ones, and what is not a number or too large.
fn number() -> BoxedStrategy<f32> {
    let special =
        [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, 0.0, -0.0, f32::MAX, f32::MIN, f32::MIN_POSITIVE];
    prop_oneof![
        4 => -20.0..20.0_f32,
        1 => prop::num::f32::ANY,
        1 => prop::sample::select(special.to_vec()),
        1 => prop_oneof![Just(32767.99), Just(32768.0), Just(-32768.0), Just(8.0), Just(-8.0)],
    ]
    .boxed()
}

fn vec3() -> BoxedStrategy<Vec3> {
    prop_oneof![
        3 => [number(), number(), number()].prop_map(|[x, y, z]| Vec3::lit(x, y, z)),
        1 => any::<[i32; 3]>().prop_map(|bits| {
            let [x, y, z] = bits.map(I16F16::from_bits);
            Vec3::new(x, y, z)
        }),
    ]
    .boxed()
}

fn turn() -> BoxedStrategy<Turn> {
    prop_oneof![
        any::<u16>().prop_map(Turn::from_raw),
        any::<i32>().prop_map(Turn::from_degrees),
        number().prop_map(Turn::from_radians),
    ]
    .boxed()
}

/// Any turn.
fn turned() -> BoxedStrategy<Pose> {
    [turn(), turn(), turn()]
        .prop_map(|[x, y, z]| Pose::IDENTITY.rotated_x(x).rotated_y(y).rotated_z(z))
        .boxed()
}

fn wild_pose() -> BoxedStrategy<Pose> {
    let scale = || {
        prop_oneof![
            2 => number().prop_map(|scale| Pose::IDENTITY.try_scaled_lit(scale).map_or(U10F22::MAX, |pose| pose.scale[0])),
            1 => any::<u32>().prop_map(U10F22::from_bits),
            2 => Just(U10F22::ONE),
        ]
    };
    let scale = prop_oneof![2 => scale().prop_map(|scale| [scale; 3]), 1 => [scale(), scale(), scale()]];
    let wild = any::<[[i16; 3]; 3]>().prop_map(|rows| rows.map(|row| row.map(I2F14::from_bits)));
    let rotation = prop_oneof![3 => turned().prop_map(|pose| pose.rotation), 1 => wild];
    (rotation, scale, vec3())
        .prop_map(|(rotation, scale, translation)| Pose { rotation, scale, translation })
        .boxed()
}

/// Any turn, a few units before a camera that stands where it is unless told otherwise.
fn tame_pose() -> BoxedStrategy<Pose> {
    (turned(), [-3.0..3.0_f32, -3.0..3.0, -9.0..1.0_f32], 0.1..8.0_f32)
        .prop_map(|(pose, [x, y, z], scale)| pose.scaled_lit(scale).at(Vec3::lit(x, y, z)))
        .boxed()
}

fn wild_camera() -> BoxedStrategy<Camera> {
    let side = || prop_oneof![4 => 0..100_u32, 1 => any::<u32>(), 1 => 1000..1100_u32];
    let size = || (side(), side()).prop_map(|(width, height)| Size::new(width, height));
    let lens = prop_oneof![
        (turn(), size()).prop_map(|(turn, size)| Camera::perspective(turn, size)),
        (number(), size()).prop_map(|(focal, size)| Camera::focal(focal, size)),
    ];
    let looking = prop::option::of((vec3(), vec3(), vec3()));
    (lens, prop::option::of(number()), looking, prop::option::of(wild_pose()))
        .prop_map(|(mut camera, near, looking, pose)| {
            if let Some(near) = near {
                camera = camera.near(near);
            }
            if let Some(pose) = pose {
                camera = camera.pose(pose);
            }
            if let Some((at, target, up)) = looking {
                camera = camera.at(at).look_at(target, up);
            }
            camera
        })
        .boxed()
}

fn tame_camera() -> BoxedStrategy<Camera> {
    (20..120_i32, (1..100_u32, 1..100_u32), 0.001..1.0_f32)
        .prop_map(|(vertical, (width, height), near)| {
            Camera::perspective(Turn::from_degrees(vertical), Size::new(width, height)).near(near)
        })
        .boxed()
}

fn mesh_vertex() -> BoxedStrategy<Vertex> {
    let place = prop_oneof![
        1 => [number(), number(), number()].prop_map(|[x, y, z]| {
            // What is no position is one at an end of the format.
            let nearest = |value| I4F12::saturating_from_num(if f32::is_nan(value) { 0.0 } else { value });
            let at_the_ends = || Vertex { position: [x, y, z].map(nearest), ..Vertex::new(0.0, 0.0, 0.0) };
            Vertex::try_new(x, y, z).unwrap_or_else(|_| at_the_ends())
        }),
        4 => [-1.0..1.0_f32, -1.0..1.0, -1.0..1.0].prop_map(|[x, y, z]| Vertex::new(x, y, z)),
        1 => any::<[i16; 3]>().prop_map(|bits| {
            Vertex { position: bits.map(I4F12::from_bits), ..Vertex::new(0.0, 0.0, 0.0) }
        }),
    ];
    (place, any::<[u8; 3]>(), any::<[i16; 2]>(), any::<bool>())
        .prop_map(|(vertex, [r, g, b], [u, v], whole)| {
            let vertex = vertex.color(r, g, b);
            let sixteenths = Vertex { uv: [u, v].map(I12F4::from_bits), ..vertex };
            if whole { vertex.try_uv(u, v).unwrap_or(sixteenths) } else { sixteenths }
        })
        .boxed()
}

#[test]
fn meshes_poses_and_cameras_of_any_numbers_20_000_cases() {
    let texels: Vec<u16> = (0..=u16::MAX).collect();
    let indices = prop::collection::vec(any::<[u16; 3]>(), 0..6);
    let meshes = (prop::collection::vec(mesh_vertex(), 1..12), indices).prop_map(|(vertices, indices)| {
        let count = vertices.len() as u16;
        let indices: Vec<_> = indices.into_iter().map(|corners| corners.map(|index| index % count)).collect();
        (vertices, indices)
    });
    let camera = prop_oneof![wild_camera(), tame_camera()];
    let pose = prop_oneof![wild_pose(), tame_pose()];
    let seeing = (40..=100_u32, 40..=100_u32).prop_map(|(width, height)| (Strip::new(width, height, 0), 0));
    let target = prop_oneof![target().boxed(), seeing.boxed()];
    let cases = (meshes.boxed(), camera, pose, target, 0..4_u8, 0..3_u8, 0..CULLS.len());
    let seen = std::cell::Cell::new(0_u32);
    for_all(
        "camera.draw with any numbers",
        20_000,
        cases,
        |(mesh, camera, pose, (strip, row), kind, quality, cull)| {
            let mesh = Mesh::try_new(&mesh.0, &mesh.1).expect("the indices are in range");
            let texture = Texture::new(&texels, 8, 8);
            // Flat, Gouraud, repeated and clamped: see `surface`.
            let (kind, cull) = ([0, 1, 10, 4][usize::from(kind)], CULLS[cull]);
            let surface = match quality {
                0 => surface::<QuarterPixel, _>(kind, &texture, cull),
                1 => surface::<Exact, _>(kind, &texture, cull),
                _ => surface::<Affine, _>(kind, &texture, cull),
            };
            let (mut pixels, mut depth) =
                (vec![0x1234_u16; strip.len() + SPARE], vec![0_u16; strip.len() + SPARE]);
            let mut band = Band::<Rgb565, Depth16>::new(strip.size(), &mut pixels, &mut depth)
                .expect("the slices are long enough")
                .starting_at(row);
            camera.draw(&mesh, &pose, surface, &mut band);
            seen.set(seen.get() + u32::from(depth.iter().any(|depth| *depth > 0)));
            prop_assert!(pixels[strip.len()..].iter().all(|word| *word == 0x1234), "pixels past the target");
            prop_assert!(depth[strip.len()..].iter().all(|word| *word == 0), "depths past the target");
            // What has no depth was not drawn.
            prop_assert!(pixels.iter().zip(&depth).all(|(word, depth)| *depth > 0 || *word == 0x1234));
            Ok(())
        },
    );
    println!("camera.draw with any numbers: {} of the scenes have a pixel to show", seen.get());
    assert!(seen.get() > common::cases(20_000) / 20);
}

#[test]
fn a_mesh_with_a_bad_index_is_a_typed_error_5_000_cases() {
    let cases = (0..9_usize, prop::collection::vec([0..10_u16, 0..10_u16, 0..10_u16], 0..6));
    for_all("indices", 5_000, cases, |(count, triangles)| {
        let vertices = vec![Vertex::new(0.0, 0.0, 0.0); count];
        let bad = triangles.iter().enumerate().find_map(|(triangle, corners)| {
            let index = corners.iter().find(|index| usize::from(**index) >= count)?;
            Some(MeshError { triangle, index: *index })
        });
        prop_assert_eq!(Mesh::try_new(&vertices, &triangles).err(), bad);
        Ok(())
    });
}

#[test]
fn a_canvas_of_nothing_takes_a_triangle() {
    let corner = |x, y| Corner { x, y, q: 1 << 30, attributes: [0; reference::ATTRIBUTES] };
    let triangle = Triangle([corner(-500, -500), corner(-500, 900), corner(900, -500)]);
    let mut canvas = Canvas::<Drawn, u16>::new::<Depth16>(Strip::new(0, 0, 0));
    canvas
        .draw::<Recording, Depth16, _>(
            &triangle,
            Cull::None,
            Surface::new(&Recorder::<Exact>::new(Inputs::Uv)),
        )
        .expect("the triangle is within range");
}

// What could overflow. Numbers of all orders of magnitude: terms that cancel, nearly cancel, or meet at the end of a format are
// far more frequent than chance would have them. Nothing is asked of the picture here, so that there can be many cases; they
// are run with the arithmetic of Armv6-M too (`--cfg fixel_armv6m`, see src/num.rs).

/// Of either sign, as many numbers below 2 as from there to 4, from there to 8, and so on up to `limit`; and its ends.
fn of_any_size(limit: i32) -> impl Strategy<Value = i32> + Clone {
    let bits = 32 - limit.leading_zeros();
    let value = (0..=bits, any::<u32>(), any::<bool>()).prop_map(move |(size, bits, negative)| {
        let value = (((1_u64 << size) - 1) as u32 & (bits | 1 << (size.max(1) - 1))).min(limit as u32) as i32;
        if negative { -value } else { value }
    });
    prop_oneof![6 => value, 1 => Just(0), 1 => Just(limit), 1 => Just(-limit)]
}

/// A part of a screen, and a triangle in or around it.
fn triangle_of_any_size() -> BoxedStrategy<((Strip, u32), [ScreenVertex; 3])> {
    let sizes = prop_oneof![6 => (1..=48_u32, 1..=24_u32), 1 => (Just(1023), 1..=2_u32)];
    let first = (sizes, 0..=1000_u32).prop_flat_map(|((width, height), row)| {
        let strip = Strip::new(width, height, row.min(1023 - height));
        (Just(strip), common::generate::place(strip, 100))
    });
    let sides = [of_any_size(0x7fff), of_any_size(0x7fff), of_any_size(0x7fff), of_any_size(0x7fff)];
    let nearest =
        (0..32_u32, any::<u32>()).prop_map(|(size, bits)| (1_u64 << size) as u32 | bits >> (31 - size));
    let falls = || prop_oneof![1 => Just(0), 2 => of_any_size(i32::MAX), 1 => any::<i32>()];
    let texel = || of_any_size(8192 << 16);
    let texels = [[texel(), texel()], [texel(), texel()], [texel(), texel()]];
    let channel = || prop_oneof![2 => any::<u16>(), 1 => Just(0), 1 => Just(u16::MAX)];
    let color = || [channel(), channel(), channel()];
    (first, sides, (nearest, [falls(), falls()]), texels, [color(), color(), color()])
        .prop_map(|((strip, (x, y)), [bx, by, cx, cy], (q, falls), texels, colors)| {
            let fallen = falls.map(|fall| q.saturating_sub(fall.unsigned_abs()));
            let vertex = |i: usize| {
                let [x, y] = [[x, y], [x + bx, y + by], [x + cx, y + cy]][i]
                    .map(|at| at.clamp(*GUARD_BAND.start(), *GUARD_BAND.end()) as i16);
                ScreenVertex {
                    x: I12F4::from_bits(x),
                    y: I12F4::from_bits(y),
                    q: U1F31::from_bits([q, fallen[0], fallen[1]][i]),
                    u: I16F16::from_bits(texels[i][0]),
                    v: I16F16::from_bits(texels[i][1]),
                    color: colors[i].map(U8F8::from_bits),
                }
            };
            ((strip, strip.row), [0, 1, 2].map(vertex))
        })
        .boxed()
}

/// Every loop that there is: one of 14 surfaces.
fn surface<'a, Q: Quality, D: DepthFormat>(
    kind: u8,
    texture: &Texture<'a>,
    cull: Cull,
) -> Surface<'a, Rgb565, D> {
    fn of<'a, Q: Quality, D: DepthFormat>(
        material: Material<'a, impl Kind>,
        cull: Cull,
    ) -> Surface<'a, Rgb565, D> {
        (&material.quality::<Q>().cull(cull)).into()
    }
    let textured = Material::textured(texture);
    match kind {
        0 => of::<Q, D>(Material::flat(Rgb565::MAGENTA), cull),
        1 => of::<Q, D>(Material::gouraud(), cull),
        2 => of::<Q, D>(Material::gouraud().lit().faceted(), cull),
        3 => of::<Q, D>(Material::flat(Rgb565::YELLOW).lit().two_sided(), cull),
        4 => of::<Q, D>(Material::clamped(texture), cull),
        5 => of::<Q, D>(Material::clamped(texture).lit(), cull),
        6 => of::<Q, D>(textured.lit().two_sided().texture_scale(3), cull),
        7 => of::<Q, D>(textured.lit().faceted().texture_scale(8), cull),
        8 => of::<Q, D>(textured.lit(), cull),
        9 => of::<Q, D>(Material::mirrored(texture), cull),
        kind => of::<Q, D>(textured.texture_scale([0, 1, 5, 8, u8::MAX][usize::from(kind) % 5]), cull),
    }
}

const SURFACES: u8 = 14;
/// log₂ of the sides of textures: those for which there is a loop, others, and one that is not packed.
const TEXTURES: [(u32, u32); 8] = [(6, 6), (5, 5), (0, 0), (8, 8), (10, 6), (3, 5), (1, 8), (4, 8)];

fn overflows_nowhere<D: DepthFormat>(
    target: (Strip, u32),
    vertices: &[ScreenVertex; 3],
    surface: Surface<'_, Rgb565, D>,
) -> Result<(), TestCaseError> {
    let blank = (0x1234, D::CLEAR);
    let (result, pixels, _) = draw::<Rgb565, D, _>(target, blank, vertices, Cull::None, surface);
    prop_assert!(result.is_ok());
    prop_assert!(pixels[target.0.len()..].iter().all(|word| *word == 0x1234), "pixels past the target");
    Ok(())
}

#[test]
fn triangles_of_numbers_of_all_sizes_overflow_nowhere_200_000_cases() {
    let texels: Vec<u16> = (0..=u16::MAX).collect();
    let how = (0..SURFACES, 0..TEXTURES.len(), 0..3_u8, any::<bool>(), any::<bool>());
    let cases = (triangle_of_any_size(), how);
    for_all("triangles of numbers of all sizes", 200_000, cases, |((target, mut vertices), how)| {
        let (kind, size, quality, gray, with_depth) = how;
        let (width, height) = TEXTURES[size];
        let texture = Texture::new(&texels[..1 << (width + height)], width, height);
        if gray {
            vertices.iter_mut().for_each(|vertex| vertex.color = [vertex.color[0]; 3]);
        }
        if with_depth {
            let surface = quality_of_any_size::<Depth16>(quality, gray, kind, &texture);
            overflows_nowhere(target, &vertices, surface)
        } else {
            let surface = quality_of_any_size::<NoDepth>(quality, gray, kind, &texture);
            overflows_nowhere(target, &vertices, surface)
        }
    });
}

fn quality_of_any_size<'a, D: DepthFormat>(
    quality: u8,
    gray: bool,
    kind: u8,
    texture: &Texture<'a>,
) -> Surface<'a, Rgb565, D> {
    match quality {
        0 | 1 => surface::<QuarterPixel, D>(kind, texture, Cull::Back),
        2 if gray => surface::<Affine, D>(kind, texture, Cull::Back),
        _ => surface::<Exact, D>(kind, texture, Cull::Back),
    }
}

/// An `f32` of any size, as [`of_any_size`].
fn number_of_any_size() -> BoxedStrategy<f32> {
    prop_oneof![
        4 => of_any_size(i32::MAX).prop_map(|bits| I16F16::from_bits(bits).to_num()),
        2 => of_any_size(16 << 16).prop_map(|bits| I16F16::from_bits(bits).to_num()),
        1 => number(),
    ]
    .boxed()
}

fn vec3_of_any_size() -> BoxedStrategy<Vec3> {
    let bits = || prop_oneof![4 => of_any_size(i32::MAX), 2 => of_any_size(20 << 16), 1 => Just(i32::MIN)];
    [bits(), bits(), bits()]
        .prop_map(|bits| bits.map(I16F16::from_bits))
        .prop_map(|[x, y, z]| Vec3::new(x, y, z))
        .boxed()
}

fn pose_of_any_size() -> BoxedStrategy<Pose> {
    let element = || prop_oneof![3 => of_any_size(0x7fff), 1 => Just(0), 1 => Just(i32::from(i16::MIN)), 1 => Just(1 << 14)];
    let row = || [element(), element(), element()];
    let matrix =
        [row(), row(), row()].prop_map(|rows| rows.map(|row| row.map(|bits| I2F14::from_bits(bits as i16))));
    let rotation = prop_oneof![
        6 => turned().prop_map(|pose| pose.rotation),
        2 => matrix,
        1 => Just([[I2F14::ZERO; 3]; 3]),
    ];
    let one = || {
        prop_oneof![
            4 => Just(U10F22::ONE),
            2 => of_any_size(i32::MAX).prop_map(|bits| U10F22::from_bits(bits.unsigned_abs())),
            1 => Just(U10F22::MAX),
            1 => any::<u32>().prop_map(U10F22::from_bits),
        ]
    };
    let scale = prop_oneof![3 => one().prop_map(|scale| [scale; 3]), 1 => [one(), one(), one()]];
    let before =
        of_any_size(8 << 16).prop_map(|z| Vec3::new(I16F16::ZERO, I16F16::ZERO, I16F16::from_bits(-z.abs())));
    let translation = prop_oneof![1 => vec3_of_any_size(), 3 => before];
    (rotation, scale, translation)
        .prop_map(|(rotation, scale, translation)| Pose { rotation, scale, translation })
        .boxed()
}

fn camera_of_any_size(width: u32, height: u32) -> BoxedStrategy<Camera> {
    let size = Size::new(width, height);
    let lens = prop_oneof![
        4 => (1..180_i32).prop_map(move |vertical| Camera::perspective(Turn::from_degrees(vertical), size)),
        2 => number_of_any_size().prop_map(move |focal| Camera::focal(focal, size)),
        2 => number_of_any_size().prop_map(move |pixels| Camera::orthographic(pixels, size)),
    ];
    let planes = (
        prop::option::weighted(0.3, number_of_any_size()),
        prop::option::weighted(0.2, number_of_any_size()),
    );
    let axis = || of_any_size(0x7fff).prop_map(|bits| I12F4::from_bits(bits as i16));
    let off_axis = prop::option::weighted(0.3, (axis(), axis()));
    let viewport = prop::option::weighted(0.2, (of_any_size(i32::MAX), of_any_size(i32::MAX)));
    let pose = prop::option::weighted(0.2, pose_of_any_size());
    (lens, planes, off_axis, viewport, pose)
        .prop_map(|(mut camera, (near, far), off_axis, viewport, pose)| {
            camera = near.map_or(camera, |near| camera.near(near));
            camera = far.map_or(camera, |far| camera.far(far));
            camera = viewport.map_or(camera, |(left, top)| camera.viewport(Point::new(left, top)));
            camera = off_axis.map_or(camera, |(right, down)| camera.off_axis(right, down));
            pose.map_or(camera, |pose| camera.pose(pose))
        })
        .boxed()
}

fn lights_of_any_size() -> BoxedStrategy<Vec<Light>> {
    let light = prop_oneof![
        (vec3_of_any_size(), any::<[u8; 3]>())
            .prop_map(|(direction, color)| Light::directional(direction, color)),
        (vec3_of_any_size(), any::<[u8; 3]>(), of_any_size(i32::MAX))
            .prop_map(|(place, color, range)| Light::point(place, color, I16F16::from_bits(range))),
    ];
    prop::collection::vec(light, 0..=Lights::MAX).boxed()
}

fn vertex_of_any_size() -> BoxedStrategy<Vertex> {
    let bits = || {
        prop_oneof![3 => of_any_size(0x7fff), 3 => -0x7fff..=0x7fff_i32, 1 => Just(i32::from(i16::MIN))]
            .prop_map(|bits| bits as i16)
    };
    ([bits(), bits(), bits()], [bits(), bits()], any::<[u8; 3]>(), any::<[i8; 3]>())
        .prop_map(|(position, uv, color, normal)| Vertex {
            position: position.map(I4F12::from_bits),
            uv: uv.map(I12F4::from_bits),
            color,
            normal,
        })
        .boxed()
}

/// A display that counts the colours it is handed.
struct Counter(Size, u32);

impl OriginDimensions for Counter {
    fn size(&self) -> Size {
        self.0
    }
}

impl DrawTarget for Counter {
    type Color = Rgb565;
    type Error = core::convert::Infallible;

    fn draw_iter<I: IntoIterator<Item = Pixel<Rgb565>>>(&mut self, pixels: I) -> Result<(), Self::Error> {
        self.1 += pixels.into_iter().count() as u32;
        Ok(())
    }
}

#[test]
fn scenes_of_numbers_of_all_sizes_overflow_nowhere_30_000_cases() {
    let texels: Vec<u16> = (0..=u16::MAX).collect();
    let mesh =
        (prop::collection::vec(vertex_of_any_size(), 3..8), prop::collection::vec(any::<[u16; 3]>(), 2..9));
    let sizes = prop_oneof![6 => (1..=48_u32, 1..=24_u32), 1 => (Just(1023), 1..=2_u32), 1 => (1..=2_u32, Just(1023))];
    let cameras = sizes.prop_flat_map(|(width, height)| {
        (
            Just((width, height)),
            prop_oneof![4 => Just(0), 1 => 0..=1023 - height],
            camera_of_any_size(width, height),
        )
    });
    let how = (0..SURFACES, 0..TEXTURES.len(), 0..3_u8, 0..CULLS.len());
    let cases = (mesh, cameras, pose_of_any_size(), lights_of_any_size(), vec3_of_any_size(), how);
    let seen = std::cell::Cell::new(0_u32);
    for_all(
        "scenes of numbers of all sizes",
        30_000,
        cases,
        |((vertices, corners), camera, pose, lights, point, how)| {
            let ((width, height), row, camera) = camera;
            let (kind, size, quality, cull) = how;
            let corners: Vec<_> =
                corners.iter().map(|corners| corners.map(|index| index % vertices.len() as u16)).collect();
            let mesh = Mesh::try_new(&vertices, &corners).expect("the indices are in range");
            let lights = Lights::try_new([255; 3], &lights).expect("few enough");
            let (log2_width, log2_height) = TEXTURES[size];
            let texture = Texture::new(&texels[..1 << (log2_width + log2_height)], log2_width, log2_height);
            let (view, cull) = (camera.lit_by(&lights), CULLS[cull]);
            let quarter_pixel = surface::<QuarterPixel, Depth16>(kind, &texture, cull);
            let surface = match quality {
                0 => quarter_pixel,
                1 => surface::<Exact, _>(kind, &texture, cull),
                _ => surface::<Affine, _>(kind, &texture, cull),
            };
            let words = (width * height) as usize;
            let (mut pixels, mut depth) = (vec![0x1234_u16; words + SPARE], vec![0_u16; words + SPARE]);
            let mut band = Band::<Rgb565, Depth16>::new(Size::new(width, height), &mut pixels, &mut depth)
                .expect("the slices are long enough")
                .starting_at(row);
            view.draw(&mesh, &pose, surface, &mut band);
            let mut memory = ListMemory::<48, 32>::new();
            let mut list = DisplayList::<Rgb565, Depth16, 1>::new(&mut memory);
            let _ = view.draw(&mesh, &pose, quarter_pixel, &mut list);
            list.sort_back_to_front();
            list.render(row, &mut band);
            seen.set(seen.get() + u32::from(depth.iter().any(|depth| *depth > 0)));
            prop_assert!(pixels[words..].iter().all(|word| *word == 0x1234), "pixels past the target");
            prop_assert!(depth[words..].iter().all(|word| *word == 0), "depths past the target");
            // Straight to a display.
            let mut display = Counter(Size::new(width, height), 0);
            let sides = [point.x, point.y];
            let Ok(()) =
                PerspectiveImage::posed(&texture, &camera, &pose, sides).two_sided().draw(&mut display);
            // And what stands beside drawing.
            let at = camera.project(point).map_or(Vec3::ZERO, |at| camera.unproject(at.x, at.y, point.z));
            let eye = camera.look_at(point, at).orbit(point, point.x, Turn::from_raw(row as u16), Turn::ZERO);
            let eye = eye.flown(point.x, point.y, point.z);
            let other = Pose { translation: point, ..*eye.placement() };
            let _ = (
                pose * other,
                pose.then(other).inverse(),
                pose.orthonormalized(),
                pose.transform_direction(point),
            );
            let _ = pose.interpolate(&other, point.x);
            let _ = pose.interpolate(&other, I16F16::from_bits(point.x.to_bits() & 0xffff));
            Ok(())
        },
    );
    println!("scenes of numbers of all sizes: {} have a pixel to show", seen.get());
    assert!(seen.get() > common::cases(30_000) / 20);
}

/// Two corners ½ px apart, with all the texels of a row between them: from one pixel of it to the next there is none.
#[test]
fn a_step_that_leads_beyond_the_triangle_is_not_multiplied() {
    let corner = |x: i32, y: i32, q, u| Corner { x, y, q, attributes: [u, 0, 0, 0, 0] };
    let triangle = Triangle([
        corner(376, 120, 1_394_987_008, 0),
        corner(384, 120, 1_394_987_008, -1),
        corner(0, 0, 0, 0),
    ]);
    let vertices = triangle.0.map(common::screen_vertex);
    let strip = Strip::new(32, 8, 0);
    let texture = Texture::new(&[0xf800; 4], 1, 1);
    let material = Material::textured(&texture);
    let (result, pixels, depth) =
        draw::<Rgb565, Depth16, _>((strip, 0), (0x1234, 0), &vertices, Cull::None, &material);
    assert_eq!(result, Ok(()));
    for ((x, y), (word, depth)) in strip.pixels().zip(pixels.iter().zip(&depth)) {
        let inside = triangle.covers(x, y);
        assert_eq!((*word, *depth > 0), (if inside { 0xf800 } else { 0x1234 }, inside), "at {x}, {y}");
    }
}
