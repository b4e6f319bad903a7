#![expect(clippy::float_arithmetic, reason = "the f64 truth of a test")]

use super::super::normal::Direction;
use super::*;
use crate::Turn;
use crate::num::{I2F14, U10F22};
use proptest::prelude::*;
use std::{println, vec::Vec as List};

type V = [f64; 3];

fn dot(a: V, b: V) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross(a: V, b: V) -> V {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

fn minus(a: V, b: V) -> V {
    array::from_fn(|i| a[i] - b[i])
}

fn unit(v: V) -> V {
    let length = dot(v, v).sqrt();
    if length > 0.0 { v.map(|component| component / length) } else { v }
}

fn world(v: Vec3) -> V {
    v.bits().map(|bits| f64::from(bits) / 65536.0)
}

fn mesh(v: [I4F12; 3]) -> V {
    v.map(f64::from)
}

fn turned(pose: &Pose, v: V) -> V {
    pose.rotation.map(|row| dot(row.map(f64::from), v))
}

/// Along the axes of the world, in its units.
fn stretched(pose: &Pose, v: V) -> V {
    turned(pose, array::from_fn(|i| v[i] * f64::from(pose.scale[i])))
}

/// A normal of the mesh at right angles to the surface where it stands, as long as before: by the transpose of the inverse.
fn across(pose: &Pose, normal: V) -> V {
    let axes = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].map(|axis| stretched(pose, axis));
    let [x, y, z] = axes;
    let determinant = dot(x, cross(y, z));
    let columns = [cross(y, z), cross(z, x), cross(x, y)].map(|v| v.map(|c| c / determinant));
    let across: V = array::from_fn(|i| (0..3).map(|k| columns[k][i] * normal[k]).sum());
    unit(across).map(|component| component * dot(normal, normal).sqrt())
}

/// The definition, in world space.
fn exact(lights: &Lights<'_>, pose: &Pose, position: [I4F12; 3], normal: V, two_sided: bool) -> V {
    let normal = across(pose, normal);
    let place: V = {
        let (p, t) = (stretched(pose, mesh(position)), world(pose.translation));
        array::from_fn(|i| p[i] + t[i])
    };
    let mut sum = lights.ambient.map(f64::from);
    for light in lights.lights {
        let (to_light, attenuation) = match light.source {
            Source::Directional(towards) => (towards.map(|bits| f64::from(bits) / f64::from(1 << 30)), 1.0),
            Source::Point { position, range, .. } => {
                let to_light = minus(world(position), place);
                let ratio = dot(to_light, to_light) / f64::from(range).powi(2);
                (unit(to_light), if ratio < 1.0 { (1.0 - ratio).powi(2) } else { 0.0 })
            }
        };
        let cosine = dot(normal, to_light);
        let cosine = if two_sided { cosine.abs() } else { cosine.max(0.0) };
        for (sum, channel) in sum.iter_mut().zip(light.color) {
            *sum += cosine * attenuation * f64::from(channel);
        }
    }
    sum.map(|channel| channel.min(255.0))
}

/// splitmix64: the same cases in every run.
struct Random(u64);

impl Random {
    fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// −1 … 1.
    fn signed(&mut self) -> f64 {
        self.bits() as f64 / 2f64.powi(63) - 1.0
    }

    fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * (self.signed() * 0.5 + 0.5)
    }

    /// Every magnitude as often as any other.
    fn log(&mut self, low: f64, high: f64) -> f64 {
        self.between(low.ln(), high.ln()).exp()
    }

    fn direction(&mut self) -> V {
        loop {
            let v = array::from_fn(|_| self.signed());
            if (0.01..1.0).contains(&dot(v, v)) {
                return unit(v);
            }
        }
    }

    fn color(&mut self) -> [u8; 3] {
        let bits = self.bits().to_le_bytes();
        if bits[3] < 64 { [255; 3] } else { [bits[0], bits[1], bits[2]] }
    }

    fn position(&mut self) -> [I4F12; 3] {
        let shift = self.bits() % 16;
        array::from_fn(|_| I4F12::from_bits(self.bits() as i16 >> shift))
    }

    fn normal(&mut self) -> [i8; 3] {
        self.direction().map(|component| (component * 127.0).round() as i8)
    }

    fn pose(&mut self) -> Pose {
        let [a, b, c] = array::from_fn(|_| Turn::from_raw(self.bits() as u16));
        let scale = U10F22::from_num(self.log(1e-3, 1e3));
        let reach = self.log(0.01, 20000.0);
        let translation = to_world(array::from_fn(|_| self.signed() * reach));
        Pose::IDENTITY.rotated_x(a).rotated_y(b).rotated_z(c).scaled(scale).at(translation)
    }

    /// The same with a scale for each axis, and perhaps mirrored.
    fn stretched_pose(&mut self) -> Pose {
        let mut pose = self.pose();
        let ratio = self.log(1.0, 1e3);
        let scale = array::from_fn(|_| {
            let scale = f64::from(pose.scale[0]) * self.log(1.0 / ratio, ratio);
            U10F22::from_num(scale.clamp(1e-3, 1e3))
        });
        if self.bits() & 1 == 0 {
            let axis = self.bits() as usize % 3;
            pose.rotation.iter_mut().for_each(|row| row[axis] = -row[axis]);
        }
        pose.stretched(scale)
    }

    /// The same with a matrix that is no rotation, but stretches no direction more than 8 times as much as another.
    fn sheared_pose(&mut self) -> Pose {
        loop {
            let rotation = array::from_fn(|_| array::from_fn(|_| I2F14::from_num(self.signed() * 1.99)));
            let rows = rotation.map(|row: [I2F14; 3]| row.map(f64::from));
            let [x, y, z] = rows;
            let columns = [cross(y, z), cross(z, x), cross(x, y)];
            let sum = |rows: [V; 3]| rows.iter().map(|row| dot(*row, *row)).sum::<f64>();
            // √(Σσ² · Σσ⁻²) is at most √3 · σ₁/σ₃ + …, and at least σ₁/σ₃.
            if (sum(rows) * sum(columns)).sqrt() < 8.0 * dot(x, columns[0]).abs() {
                return Pose { rotation, ..self.stretched_pose() };
            }
        }
    }

    /// A light not too near to `position`, with or without the range to reach it.
    fn point(&mut self, pose: &Pose, position: [I4F12; 3], color: [u8; 3]) -> Light {
        let scale = pose.scale.iter().fold(0.0, |most: f64, scale| most.max(f64::from(*scale)));
        loop {
            // From 1/1000 of a mesh unit and 2⁻¹⁴ of the world's.
            let distance = self.log((0.001f64).max(2f64.powi(-14) / scale), 1000.0) * scale;
            let direction = self.direction();
            let (place, t) = (stretched(pose, mesh(position)), world(pose.translation));
            let range = distance * self.log(0.5, 50.0);
            let light: V = array::from_fn(|i| place[i] + direction[i] * distance + t[i]);
            if range < 32767.0 && light.iter().all(|component| component.abs() < 32767.0) {
                return Light::point(to_world(light), color, I16F16::from_num(range));
            }
        }
    }
}

fn to_world(v: V) -> Vec3 {
    let [x, y, z] = v.map(I16F16::saturating_from_num);
    Vec3::new(x, y, z)
}

const CASES: u32 = 100_000;

/// The largest error in 100,000 cases, in 1/255 of full intensity.
fn worst_of(name: &str, bound: f64, mut case: impl FnMut(&mut Random) -> ([U8F8; 3], V)) {
    let mut random = Random(1);
    let (mut worst, mut lit) = (0f64, 0);
    for _ in 0..CASES {
        let (ours, exact) = case(&mut random);
        for (ours, exact) in ours.into_iter().zip(exact) {
            worst = worst.max((f64::from(ours) - exact).abs());
        }
        lit += u32::from(exact.iter().any(|&channel| channel > 1.0 && channel < 255.0));
    }
    println!("light, {name}: {CASES} cases ({lit} neither dark nor full), error within {worst:.3}/255");
    assert!(worst < bound && lit > CASES / 3, "{worst}, {lit}");
}

/// Vertices under lights that `make` chooses.
fn worst_at_vertices(name: &str, make: impl Fn(&mut Random, &Pose, [I4F12; 3]) -> List<Light>) {
    worst_at_vertices_of(name, 0.25, Random::pose, make);
}

fn worst_at_vertices_of(
    name: &str,
    bound: f64,
    pose: fn(&mut Random) -> Pose,
    make: impl Fn(&mut Random, &Pose, [I4F12; 3]) -> List<Light>,
) {
    worst_of(name, bound, |random| {
        let (pose, position, normal) = (pose(random), random.position(), random.normal());
        let lights = make(random, &pose, position);
        let ambient = if random.bits() & 1 == 0 { [0; 3] } else { random.color().map(|c| c / 4) };
        let lights = Lights::new(ambient, &lights);
        let two_sided = random.bits() & 1 == 0;
        let ours = lights.in_mesh_space(&pose).at(position, normal.into(), two_sided);
        (ours, exact(&lights, &pose, position, normal.map(|n| f64::from(n) / 127.0), two_sided))
    });
}

fn any_directional(random: &mut Random) -> Light {
    let length = random.log(2e-4, 30000.0);
    let direction = to_world(random.direction().map(|component| component * length));
    Light::directional(direction, random.color())
}

fn any_point(random: &mut Random, pose: &Pose, position: [I4F12; 3]) -> Light {
    let color = random.color();
    random.point(pose, position, color)
}

#[test]
fn directional_light_is_within_a_quarter_of_1_in_255_in_100_000_cases() {
    worst_at_vertices("directional", |random, _, _| [any_directional(random)].into());
}

#[test]
fn point_light_is_within_a_quarter_of_1_in_255_in_100_000_cases() {
    worst_at_vertices("point", |random, pose, position| [any_point(random, pose, position)].into());
}

#[test]
fn four_lights_are_within_a_quarter_of_1_in_255_in_100_000_cases() {
    worst_at_vertices("two directional, two point", |random, pose, position| {
        [
            any_directional(random),
            any_point(random, pose, position),
            any_directional(random),
            any_point(random, pose, position),
        ]
        .map(|light| Light { color: light.color.map(|channel| channel / 2), ..light })
        .into()
    });
}

#[test]
fn light_on_stretched_and_mirrored_meshes_is_within_a_quarter_of_1_in_255_in_100_000_cases() {
    let pose = Random::stretched_pose;
    worst_at_vertices_of("stretched, directional", 0.25, pose, |random, _, _| {
        [any_directional(random)].into()
    });
    worst_at_vertices_of("stretched, point", 0.25, pose, |random, pose, position| {
        [any_point(random, pose, position)].into()
    });
    worst_at_faces_of("faces, stretched", 0.25, pose);
}

#[test]
fn light_on_sheared_meshes_is_within_a_quarter_of_1_in_255_in_100_000_cases() {
    let pose = Random::sheared_pose;
    worst_at_vertices_of("sheared, directional", 0.25, pose, |random, _, _| [any_directional(random)].into());
    worst_at_vertices_of("sheared, point", 0.25, pose, |random, pose, position| {
        [any_point(random, pose, position)].into()
    });
    worst_at_faces_of("faces, sheared", 0.25, pose);
}

#[test]
fn light_on_meshes_in_worn_poses_is_within_1_in_255_in_100_000_cases() {
    fn worn(random: &mut Random) -> Pose {
        loop {
            let mut pose = random.pose();
            for element in pose.rotation.as_flattened_mut() {
                let off = (random.signed() * 10.0).round() as i16;
                *element = I2F14::from_bits(element.to_bits() + off);
            }
            if pose.keeps_angles() {
                return pose;
            }
        }
    }
    worst_at_vertices_of("worn, directional", 1.0, worn, |random, _, _| [any_directional(random)].into());
    worst_at_vertices_of("worn, point", 1.0, worn, |random, pose, position| {
        [any_point(random, pose, position)].into()
    });
    worst_at_faces_of("faces, worn", 1.0, worn);
}

#[test]
fn stretching_by_nothing_changes_no_light_in_100_000_cases() {
    let mut random = Random(4);
    let mut worst = 0f64;
    for _ in 0..CASES {
        let (pose, position, normal) = (random.pose(), random.position(), random.normal());
        // So large that a last bit is little, and lights far away.
        let pose = pose.scaled(U10F22::from_num(random.log(0.1, 1e3)));
        let lights = [any_directional(&mut random), any_directional(&mut random)];
        let lights = Lights::new([0; 3], &lights);
        // A last bit more along one axis.
        let [x, y, z] = pose.scale;
        let other = pose.stretched([x, y, z.saturating_add(U10F22::DELTA)]);
        assert!(pose.keeps_angles() && !other.keeps_angles());
        let [ours, others] =
            [pose, other].map(|pose| lights.in_mesh_space(&pose).at(position, normal.into(), false));
        for (ours, others) in ours.into_iter().zip(others) {
            worst = worst.max((f64::from(ours) - f64::from(others)).abs());
        }
    }
    println!("light: a bit of stretch makes a difference of {worst:.3}/255");
    assert!(worst < 0.5);
}

#[test]
fn light_on_faces_is_within_a_quarter_of_1_in_255_in_100_000_cases() {
    worst_at_faces_of("faces", 0.25, Random::pose);
}

fn worst_at_faces_of(name: &str, bound: f64, pose: fn(&mut Random) -> Pose) {
    worst_of(name, bound, |random| {
        let pose = pose(random);
        let corners = array::from_fn(|_| random.position());
        let [a, b, c] = corners.map(mesh);
        let normal = unit(cross(minus(b, a), minus(c, a)));
        let middle = array::from_fn(|i| {
            I4F12::from_num(corners.iter().map(|corner| f64::from(corner[i])).sum::<f64>() / 3.0)
        });
        let lights = [any_directional(random), any_point(random, &pose, middle)];
        let lights = Lights::new([0; 3], &lights);
        let ours = lights.in_mesh_space(&pose);
        let two_sided = random.bits() & 1 == 0;
        let exact = exact(&lights, &pose, middle, normal, two_sided);
        let across = across_face(corners);
        let normal = match &ours.stretch {
            None => Normal::along(across),
            Some(stretch) => stretch.face_normal(across),
        };
        (ours.arriving(middle, normal, two_sided), exact)
    });
}

#[test]
fn directions_are_opposed_and_exact_to_2_pow_minus_29_in_100_000_cases() {
    let mut random = Random(2);
    for _ in 0..CASES {
        let shift = random.bits() % 32;
        let bits = array::from_fn(|_| random.bits() as i32 >> shift);
        let exact = unit(bits.map(|bits| -f64::from(bits)));
        for (ours, exact) in towards(bits).into_iter().zip(exact) {
            assert!((f64::from(ours) / 2f64.powi(30) - exact).abs() <= 2f64.powi(-29), "{bits:?}");
        }
    }
}

#[test]
fn face_normals_are_within_2_pow_minus_13_in_100_000_cases() {
    let mut random = Random(3);
    let mut worst = 0f64;
    for _ in 0..CASES {
        let corners = array::from_fn(|_| random.position());
        let [a, b, c] = corners.map(mesh);
        let exact = unit(cross(minus(b, a), minus(c, a)));
        for (ours, exact) in Normal::of_face(corners).components().into_iter().zip(exact) {
            worst = worst.max((f64::from(ours) - exact).abs());
        }
    }
    println!("face normal: {CASES} cases, error within 2^{:.2}", worst.log2());
    assert!(worst < 2f64.powi(-13));
}

#[test]
fn inverse_lengths_are_within_2_pow_minus_14_for_every_16_bits_of_squares() {
    let mut worst = 0f64;
    for upper in 1 << 12..3 << 14 {
        for squares in [upper << 16, upper << 16 | 0xffff] {
            let (inverse, shift) = Direction { vector: [0; 3], exponent: 0, squares }.inverse_length();
            assert!(inverse <= 1 << 15);
            let ours = f64::from(inverse) / 2f64.powi(15 + shift as i32);
            worst = worst.max((ours * f64::from(squares).sqrt() - 1.0).abs());
        }
    }
    println!("inverse length: error within 2^{:.2}", worst.log2());
    assert!(worst < 2f64.powi(-14));
}

#[test]
fn a_face_counter_clockwise_seen_from_above_faces_up() {
    let at = |x: i16, z: i16| [I4F12::from_bits(x), I4F12::ZERO, I4F12::from_bits(z)];
    let normal = Normal::of_face([at(0, 0), at(0, 1), at(1, 0)]);
    assert_eq!(normal.components(), [I2F14::ZERO, I2F14::ONE, I2F14::ZERO]);
    let line = Normal::of_face([at(-5, -5), at(0, 0), at(7, 7)]);
    assert_eq!(line.components(), [I2F14::ZERO; 3]);

    let noon = [Light::directional(Vec3::lit(0.0, -3.0, 0.0), [200, 100, 50])];
    let noon = Lights::new([5, 5, 5], &noon).in_mesh_space(&Pose::IDENTITY);
    assert_eq!(
        noon.at_face([at(0, 0), at(0, 1), at(1, 0)], false),
        [205, 105, 55].map(U8F8::from_num::<i32>)
    );
    assert_eq!(noon.at_face([at(0, 0), at(1, 0), at(0, 1)], false), [U8F8::from_num(5); 3]);
    assert_eq!(noon.at_face([at(0, 0), at(1, 0), at(0, 1)], true), [205, 105, 55].map(U8F8::from_num::<i32>));
}

#[test]
fn a_point_light_ends_exactly_at_its_range() {
    let light = [Light::point(Vec3::ZERO, [255; 3], I16F16::from_num(2))];
    let lighting = Lights::new([0; 3], &light).in_mesh_space(&Pose::IDENTITY);
    let at = |bits: i16| {
        lighting.at([I4F12::ZERO, I4F12::ZERO, I4F12::from_bits(bits)], [0, 0, -127].into(), false)[0]
    };
    let mut last = U8F8::MAX;
    for bits in 1..=i16::MAX {
        let now = at(bits);
        assert!(now.to_bits() <= last.to_bits().saturating_add(20), "at {bits} it is {now} after {last}");
        assert!(bits < 2 << 12 || now == 0);
        last = now;
    }
    assert!((f64::from(at(1 << 12)) - 255.0 * 9.0 / 16.0).abs() < 0.2);
}

#[test]
fn what_is_no_light_gives_none() {
    let none = [
        Light::directional(Vec3::ZERO, [255; 3]),
        Light::point(Vec3::ZERO, [255; 3], I16F16::ZERO),
        Light::point(Vec3::lit(0.0, 0.0, 1.0), [255; 3], I16F16::MIN),
        // At the very place that it would light.
        Light::point(Vec3::ZERO, [255; 3], I16F16::ONE),
    ];
    let lighting = Lights::new([7; 3], &none).in_mesh_space(&Pose::IDENTITY);
    assert_eq!(lighting.at([I4F12::ZERO; 3], [0, 0, 127].into(), true), [U8F8::from_num(7); 3]);
}

#[test]
fn a_fifth_light_is_an_error() {
    let five = [Light::directional(Vec3::ZERO, [255; 3]); 5];
    assert_eq!(Lights::try_new([0; 3], &five).err(), Some(LightsError { count: 5 }));
    assert_eq!(std::format!("{}", LightsError { count: 5 }), "5 lights, of which there can be 4");
    assert!(Lights::try_new([0; 3], &five[1..]).is_ok());
}

/// Any bits, the ends of the format more often than chance.
fn edgy((bits, pick): (i32, u8)) -> i32 {
    match pick % 8 {
        0 => i32::MIN,
        1 => i32::MAX,
        2 => 0,
        3 => bits % 3,
        4 => bits >> 16,
        _ => bits,
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 100_000, failure_persistence: None, ..ProptestConfig::default() })]
    #[test]
    fn no_bits_panic_in_100_000_cases(
        bits: [(i32, u8); 13],
        more: [(i32, u8); 18],
        normal: [i8; 3],
        color: [u8; 3],
    ) {
        let [scale, scale_y, scale_z, range, vectors @ ..] = bits.map(edgy);
        let [translation, direction, position] = array::from_fn(|i| {
            Vec3::new(
                I16F16::from_bits(vectors[3 * i]),
                I16F16::from_bits(vectors[3 * i + 1]),
                I16F16::from_bits(vectors[3 * i + 2]),
            )
        });
        // The upper half, so that the ends stay ends.
        let more = more.map(|bits| (edgy(bits) >> 16) as i16);
        let rotation: [[i16; 3]; 3] = array::from_fn(|i| array::from_fn(|j| more[3 * i + j]));
        let corners: [[i16; 3]; 3] = array::from_fn(|i| array::from_fn(|j| more[9 + 3 * i + j]));
        let pose = Pose {
            rotation: rotation.map(|row| row.map(I2F14::from_bits)),
            scale: [scale, scale_y, scale_z].map(|scale| U10F22::from_bits(scale as u32)),
            translation,
        };
        let range = I16F16::from_bits(range);
        let lights = [
            Light::directional(direction, color),
            Light::point(position, color, range),
            Light::point(position, [255; 3], I16F16::MAX),
            Light::directional(direction, [255; 3]),
        ];
        let lighting = Lights::new(color, &lights).in_mesh_space(&pose);
        let corners = corners.map(|corner| corner.map(I4F12::from_bits));
        for two_sided in [false, true] {
            for normal in [normal, [-128; 3], [127; 3]] {
                for light in lighting.at(corners[0], normal.into(), two_sided) {
                    prop_assert!(light <= 255);
                }
            }
            for light in lighting.at_face(corners, two_sided) {
                prop_assert!(light <= 255);
            }
        }
    }
}
