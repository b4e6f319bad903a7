//! What models become, worked out by hand; and that no bytes of a model panic.

use fixel::embedded_graphics::pixelcolor::{Rgb565, raw::RawU16};
use fixel::embedded_graphics::prelude::*;
use fixel::{Band, Camera, Depth16, Pose, Turn, Vec3};
use fixel_bake::{Bake, BakeError, Baked, ByteOrder, Paint, view, write_binaries};
use image::{Rgba, RgbaImage};
use proptest::prelude::*;
use proptest::test_runner::{Config, RngAlgorithm, TestRng, TestRunner};
use std::fmt::Write as _;
use std::path::PathBuf;

/// Writes files into a folder of their own, and gives the first one's path.
fn files(folder: &str, files: &[(&str, &[u8])]) -> PathBuf {
    let folder = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join("models").join(folder);
    std::fs::create_dir_all(&folder).expect("a folder");
    for (name, bytes) in files {
        std::fs::write(folder.join(name), bytes).expect("the file can be written");
    }
    folder.join(files[0].0)
}

fn png(image: &RgbaImage) -> Vec<u8> {
    let mut bytes = std::io::Cursor::new(Vec::new());
    image.write_to(&mut bytes, image::ImageFormat::Png).expect("it can be encoded");
    bytes.into_inner()
}

/// Red, green over blue, white.
fn corners() -> RgbaImage {
    RgbaImage::from_fn(16, 16, |x, y| match (x < 8, y < 8) {
        (true, true) => Rgba([255, 0, 0, 255]),
        (false, true) => Rgba([0, 255, 0, 255]),
        (true, false) => Rgba([0, 0, 255, 255]),
        (false, false) => Rgba([255; 4]),
    })
}

const CARD: &str = "mtllib card.mtl\nv -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nusemtl paper\nf 1/1 2/2 3/3 4/4\n";

/// Seen straight on, ±1 fills the picture.
fn straight(baked: &Baked, size: u32) -> Vec<u16> {
    let mut pixels = vec![0; (size * size) as usize];
    let mut depth = pixels.clone();
    let mut band =
        Band::<Rgb565, Depth16>::new(Size::new(size, size), &mut pixels, &mut depth).expect("a band");
    let camera = Camera::perspective(Turn::from_degrees(90), band.size()).at(Vec3::lit(0.0, 0.0, 1.0));
    let pose = Pose::IDENTITY.scaled_lit(baked.fit.scale as f32);
    for mesh in &baked.meshes {
        let surface = view::surface(baked, &baked.materials[mesh.material]).expect("a surface");
        camera.draw(&mesh.mesh().expect("a mesh"), &pose, surface, &mut band);
    }
    pixels
}

#[test]
fn a_picture_stands_upright_on_a_card_texel_by_texel() {
    let mtl = "newmtl paper\nKd 0 0 0\nmap_Kd card.png\n";
    let path = files(
        "card",
        &[("card.obj", CARD.as_bytes()), ("card.mtl", mtl.as_bytes()), ("card.png", &png(&corners()))],
    );
    let baked = Bake::new(path).bake().expect("it can be baked");
    assert!(
        baked.warnings.iter().all(|warning| warning.text.contains("edges are open")),
        "{:?}",
        baked.warnings
    );
    let pixels = straight(&baked, 16);
    for (y, row) in pixels.chunks(16).enumerate() {
        for (x, pixel) in row.iter().enumerate() {
            let Rgba([r, g, b, _]) = *corners().get_pixel(x as u32, y as u32);
            let expected = RawU16::from(Rgb565::new(r >> 3, g >> 2, b >> 3)).into_inner();
            assert_eq!(*pixel, expected, "({x}, {y})");
        }
    }
    // (16, 0), (0, 16) and so on in sixteenths, v downwards.
    let mut uvs: Vec<_> =
        baked.meshes[0].vertices.iter().map(|vertex| vertex.uv.map(|at| at.to_bits())).collect();
    uvs.sort_unstable();
    assert_eq!(uvs, [[0, 0], [0, 256], [256, 0], [256, 256]]);
}

#[test]
fn holes_of_a_picture_become_a_mask_and_opacity_alpha() {
    let mut image = corners();
    image.pixels_mut().filter(|pixel| pixel.0[0] == 0).for_each(|pixel| pixel[3] = 0);
    let mtl = "newmtl paper\nd 0.5\nmap_Kd card.png\n";
    let path = files(
        "holes",
        &[("card.obj", CARD.as_bytes()), ("card.mtl", mtl.as_bytes()), ("card.png", &png(&image))],
    );
    let baked = Bake::new(path).bake().expect("it can be baked");
    let material = &baked.materials[0];
    assert_eq!(material.paint, Paint::Texture { texture: 0, is_clamped: false, is_masked: true });
    assert_eq!(material.alpha, Some(128));
    let pixels = straight(&baked, 16);
    let there = |x: usize, y: usize| pixels[16 * y + x] != 0;
    assert!(there(3, 3) && !there(12, 3) && !there(3, 12) && there(12, 12));
}

#[test]
fn what_repeats_too_often_is_cut_and_shows_the_same() {
    // 100 times along u: 1600 texels fit; 300 times: 4800 do not.
    let mtl = "newmtl paper\nmap_Kd card.png\n";
    let picture = png(&corners());
    let baked = |times: u32| {
        let obj =
            CARD.replace("vt 1 0", &format!("vt {times} 0")).replace("vt 1 1", &format!("vt {times} 1"));
        let name = format!("often{times}");
        let path = files(
            &name,
            &[("card.obj", obj.as_bytes()), ("card.mtl", mtl.as_bytes()), ("card.png", &picture)],
        );
        Bake::new(path).unlit().bake().expect("it can be baked")
    };
    assert_eq!((baked(100).report.cut, baked(100).report.triangles), (0, 2));
    let often = baked(300);
    assert!(often.report.cut >= 2 && often.report.triangles > 2);
    assert!((often.report.area - 4.0).abs() < 1e-3);
    for corner in often.meshes[0].vertices.iter().flat_map(|vertex| vertex.uv) {
        assert!(corner.to_bits().unsigned_abs() <= 2047 * 16);
    }
    // Each pixel of the upper half is red or green, of the lower half blue or white; of 300 repeats both are seen.
    let pixels = straight(&often, 200);
    assert!(pixels[..100 * 200].iter().all(|pixel| [0xf800, 0x07e0].contains(pixel)));
    assert!(pixels[100 * 200..].iter().all(|pixel| [0x001f, 0xffff].contains(pixel)));
}

#[test]
fn a_large_mesh_is_split() {
    let side = 264;
    let mut obj = String::new();
    for y in 0..side {
        for x in 0..side {
            let _ = writeln!(obj, "v {x} {y} {}", (x * 7 + y * 3) % 11);
        }
    }
    for y in 0..side - 1 {
        for x in 0..side - 1 {
            let a = y * side + x + 1;
            let _ = writeln!(obj, "f {a} {} {} {}", a + 1, a + side + 1, a + side);
        }
    }
    let baked =
        Bake::new(files("large", &[("large.obj", obj.as_bytes())])).unlit().bake().expect("it can be baked");
    assert_eq!(baked.report.triangles, 2 * (side - 1) * (side - 1));
    assert!(baked.meshes.len() == 3 && baked.meshes.iter().all(|mesh| mesh.vertices.len() <= 65_535));
    assert!(baked.report.transforms < baked.report.triangles * 17 / 20, "{}", baked.report.transforms);
}

#[test]
fn the_largest_error_is_half_a_step_and_centring_makes_steps_finer() {
    let obj = "v 1000.1 0.3 0.7\nv 1001.7 0.1 0.2\nv 1000.4 1.9 0.1\nf 1 2 3\n";
    let path = files("far", &[("far.obj", obj.as_bytes())]);
    let far = Bake::new(&path).bake().expect("it can be baked");
    let step = far.fit.scale / 4096.0;
    assert_eq!(far.fit.scale, 128.0);
    assert!(far.report.largest_error <= step / 2.0 * 3.0_f64.sqrt() && far.report.largest_error > step / 8.0);
    assert!(far.warnings.iter().any(|warning| warning.text.contains("centre it")));
    let centered = Bake::new(&path).center().bake().expect("it can be baked");
    assert_eq!(
        (centered.fit.scale, centered.fit.origin[0]),
        (0.125, f64::midpoint(f64::from(1000.1_f32), f64::from(1001.7_f32)))
    );
    assert!(centered.report.largest_error < 0.125 / 4096.0);
    let small = Bake::new(&path).unit(0.001).bake().expect("it can be baked");
    assert_eq!((small.fit.scale, small.fit.unit), (0.25, 0.001));
    let sized = Bake::new(&path).center().size(3.0).bake().expect("it can be baked");
    let bounds = sized.report.bounds;
    let longest = (0..3).map(|i| bounds[1][i] - bounds[0][i]).fold(0.0, f64::max) * sized.fit.unit;
    assert!((longest - 3.0).abs() < 0.001, "{longest}");
    let message = Bake::new(&path).unit(100.0).bake().expect_err("it does not fit").to_string();
    assert!(message.contains("far.obj: reaches 1001.7"), "{message}");
}

#[test]
fn faults_of_an_obj_file_have_their_line() {
    for (text, wanted) in [
        ("v 1 2\n", "a.obj:1: a vertex of 2 coordinates"),
        ("# no\nv 1 2 x\n", "a.obj:2: `x` is no number"),
        ("v 1 2 nan\n", "a.obj:1: `nan` is not finite"),
        ("v 0 0 0\nf 1 1 2\n", "a.obj:2: a face names vertex 2, and there are 1 so far"),
        ("v 0 0 0\nf 1 1 0\n", "a.obj:2: a face names vertex 0"),
        ("v 0 0 0\nf 1 1 -2\n", "a.obj:2: a face names vertex -2"),
        ("v 0 0 0\n\\\nf 1/1 1 1\n", "a face names texture coordinate 1, and there are 0 so far"),
        ("v 0 0 0\nf a 1 1\n", "a.obj:2: `a` is no corner of a face"),
        ("v 0 0 0\nf 1 1 1\n", "all 1 triangles are without area"),
        ("s many\n", "a.obj:1: `many` is no number of a smoothing group"),
        ("<html>\n", "a.obj:1: is no line of an OBJ file"),
        ("", "a.obj: there is no triangle in it"),
        ("mtllib b.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", "b.mtl:2: `red` is no number"),
    ] {
        let path = files("faults", &[("a.obj", text.as_bytes()), ("b.mtl", b"newmtl x\nKd red 0 0\n")]);
        let message = Bake::new(path).bake().expect_err(text).to_string();
        assert!(message.contains(wanted), "{text:?}: {message}");
    }
    assert!(matches!(Bake::new("none.obj").bake(), Err(BakeError::Read { .. })));
    let message = Bake::new("model.stl").bake().expect_err("it is no OBJ").to_string();
    assert_eq!(message, "model.stl: is no model that can be read: OBJ, glTF and GLB can");
    let path = files("strict", &[("a.obj", b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")]);
    let message = Bake::new(path).strict().bake().expect_err("it is open").to_string();
    assert!(message.starts_with("1 of these warning") && message.contains("3 edges are open"), "{message}");
}

/// A glTF file with its numbers in it: one triangle, on a node below another.
fn gltf(parent: &str, child: &str, more: &str) -> String {
    use base64::Engine;
    let positions: [f32; 9] = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0];
    let normals: [f32; 9] = [0.0, 0.0, 1.0, 0.0, 0.0, 1.0, 0.0, 0.0, 1.0];
    let colors: [u8; 12] = [255, 0, 0, 0, 0, 255, 0, 0, 0, 0, 255, 0];
    let mut bytes: Vec<u8> =
        positions.iter().chain(&normals).flat_map(|number| number.to_le_bytes()).collect();
    bytes.extend(colors);
    bytes.extend([0, 1, 2, 0]);
    let data = base64::engine::general_purpose::STANDARD.encode(&bytes);
    format!(
        r#"{{"asset": {{"version": "2.0"}}, "scene": 0, "scenes": [{{"nodes": [0]}}],
        "nodes": [{{"children": [1] {parent}}}, {{"mesh": 0, "name": "leaf" {child}}}],
        "meshes": [{{"primitives": [{{"attributes": {{"POSITION": 0, "NORMAL": 1, "COLOR_0": 2}}, "indices": 3 {more}}}]}}],
        "materials": [{{"name": "paint"}}],
        "buffers": [{{"byteLength": {}, "uri": "data:application/octet-stream;base64,{data}"}}],
        "bufferViews": [
            {{"buffer": 0, "byteOffset": 0, "byteLength": 36}}, {{"buffer": 0, "byteOffset": 36, "byteLength": 36}},
            {{"buffer": 0, "byteOffset": 72, "byteLength": 12, "byteStride": 4}}, {{"buffer": 0, "byteOffset": 84, "byteLength": 4}}],
        "accessors": [
            {{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 0]}},
            {{"bufferView": 1, "componentType": 5126, "count": 3, "type": "VEC3"}},
            {{"bufferView": 2, "componentType": 5121, "normalized": true, "count": 3, "type": "VEC3"}},
            {{"bufferView": 3, "componentType": 5121, "count": 3, "type": "SCALAR"}}]
        }}"#,
        bytes.len()
    )
}

#[test]
fn nodes_place_turn_and_mirror_what_stands_below_them() {
    // The parent turns y to z, the child mirrors x and moves.
    let turned = r#", "rotation": [0.70710678, 0, 0, 0.70710678], "translation": [0, 0, 5]"#;
    let text = gltf(turned, r#", "scale": [-2, 1, 1], "translation": [1, 2, 3]"#, r#", "material": 0"#);
    let baked = Bake::new(files("nodes", &[("a.gltf", text.as_bytes())])).bake().expect("it can be baked");
    assert_eq!((baked.materials[0].name.as_str(), baked.materials[0].paint), ("paint", Paint::Gouraud));
    let mesh = &baked.meshes[0];
    // (x, y, z) → (1 − 2x, 2 + y, 3 + z) → (·, −(3 + z), 2 + y + 5).
    let expected =
        [([1.0, -3.0, 7.0], [255, 0, 0]), ([-1.0, -3.0, 7.0], [0, 255, 0]), ([1.0, -3.0, 8.0], [0, 0, 255])];
    for (position, color) in expected {
        let found =
            mesh.vertices.iter().find(|vertex| vertex.color == color).expect("a corner of that colour");
        let at = baked.fit.model(found.position.map(|at| at.to_bits()));
        assert!(at.iter().zip(position).all(|(a, b): (&f64, f64)| (a - b).abs() < 1e-3), "{at:?}");
        // +z of the file is −y here.
        assert_eq!(found.normal, [0, -127, 0]);
    }
    // Mirrored, and still the front is where the normal points.
    let [a, b, c] = mesh.triangles[0]
        .map(|index| mesh.vertices[usize::from(index)].position.map(|at| f64::from(at.to_bits())));
    let (p, q) = ([0, 1, 2].map(|i| b[i] - a[i]), [0, 1, 2].map(|i| c[i] - a[i]));
    assert!(p[2] * q[0] - p[0] * q[2] < 0.0, "it faces −y");
}

#[test]
fn faults_of_a_gltf_file_are_named() {
    let good = gltf("", "", "");
    for (from, to, wanted) in [
        ("\"version\": \"2.0\"", "\"version\": \"1.0\"", "is glTF 1.0"),
        ("\"byteLength\": 88", "\"byteLength\": 8800", "buffer 0 has 88 bytes of 8800"),
        (
            "\"byteOffset\": 84, \"byteLength\": 4",
            "\"byteOffset\": 86, \"byteLength\": 4",
            "accessor 3 reaches beyond its buffer",
        ),
        (
            "\"componentType\": 5126, \"count\": 3, \"type\": \"VEC3\"}",
            "\"componentType\": 5126, \"count\": 4, \"type\": \"VEC3\"}",
            "accessor 1 reaches",
        ),
        ("\"POSITION\": 0", "\"POSITION\": 9", "mesh 0 names accessor 9, which is not there"),
        (
            "\"POSITION\": 0",
            "\"POSITION\": 3",
            "accessor 3 has elements of Scalar, where 3 numbers are meant",
        ),
        ("\"children\": [1]", "\"children\": [1, 1]", "node 1 stands below itself, or in two places"),
        ("\"scene\": 0", "\"scene\" 0", "a.gltf:1: expected `:`"),
        ("base64,", "base64,!", "has wrong base64 in it"),
    ] {
        assert!(good.contains(from), "{from}");
        let text = good.replacen(from, to, 1);
        let message =
            Bake::new(files("faulty", &[("a.gltf", text.as_bytes())])).bake().expect_err(to).to_string();
        assert!(message.contains("a.gltf") && message.contains(wanted), "{to}: {message}");
    }
}

#[test]
fn files_of_bytes_are_the_meshes_in_memory() {
    let path = files("bytes", &[("card.obj", CARD.replace("mtllib card.mtl\n", "").as_bytes())]);
    let baked = Bake::new(path).bake().expect("it can be baked");
    let order = if cfg!(target_endian = "big") { ByteOrder::Big } else { ByteOrder::Little };
    let out = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join("models/bytes/out");
    let written = write_binaries(&baked, &out, order).expect("they can be written");
    let bytes = std::fs::read(&written[0]).expect("it is there");
    assert_eq!(bytes.len(), 16 + 4 * 16 + 2 * 3);
    let words: Vec<u16> = bytes.as_chunks().0.iter().map(|pair| u16::from_ne_bytes(*pair)).collect();
    let mesh = fixel::Mesh::from_bytes(bytemuck::must_cast_slice(&words)).expect("a mesh");
    assert_eq!(mesh.vertices(), baked.meshes[0].vertices);
    assert!(mesh.triangles().eq(baked.meshes[0].triangles.iter().copied()));
}

/// Files with changed bytes, lines and words.
#[test]
fn of_3_000_broken_files_none_panics_and_each_that_is_refused_is_named() {
    let mtl = "newmtl paper\nd 0.5\nTr 0.2\nmap_Kd -s 1 1 1 card.png\nmap_d card.png\n";
    let picture = png(&corners());
    let good = gltf(r#", "scale": [1, 2, 3]"#, "", r#", "material": 0, "mode": 5"#);
    let json = good.as_bytes();
    let mut glb = b"glTF\x02\0\0\0".to_vec();
    let padded = json.len().next_multiple_of(4);
    glb.extend(((12 + 8 + padded) as u32).to_le_bytes());
    glb.extend((padded as u32).to_le_bytes());
    glb.extend(b"JSON");
    glb.extend(json);
    glb.resize(20 + padded, b' ');
    let whole = [
        ("a.obj", CARD.as_bytes().to_vec()),
        ("card.mtl", mtl.as_bytes().to_vec()),
        ("a.gltf", json.to_vec()),
        ("a.glb", glb),
        ("card.png", picture.clone()),
    ];
    let odd = prop::sample::select(vec![
        "-1",
        "0",
        "1e39",
        "99999999999",
        "nan",
        "\0",
        "\u{e9}",
        "/",
        "//",
        "[",
        "}",
        "\"",
        "-",
        "4294967295",
        "\\",
        "\n",
        "f",
        "5125",
        "true",
    ]);
    let change = (any::<prop::sample::Index>(), any::<prop::sample::Index>(), odd, 0..3_u8);
    let strategy = (0..whole.len(), proptest::collection::vec(change, 1..4));
    let config = Config { cases: 3000, failure_persistence: None, ..Config::default() };
    let mut runner = TestRunner::new_with_rng(config, TestRng::from_seed(RngAlgorithm::ChaCha, &[7; 32]));
    let mut baked_count = 0;
    let counted = std::cell::RefCell::new(&mut baked_count);
    let ran = runner.run(&strategy, |(which, changes)| {
        let mut files_now = whole.clone();
        let bytes = &mut files_now[which].1;
        for (at, length, with, kind) in changes {
            let at = at.index(bytes.len() + 1);
            match kind {
                // Something else in the place of some bytes; some bytes gone; cut off.
                0 => {
                    let end = (at + length.index(6)).min(bytes.len());
                    bytes.splice(at..end, with.bytes());
                }
                1 => {
                    let end = (at + length.index(40)).min(bytes.len());
                    bytes.drain(at..end);
                }
                _ if length.index(4) == 0 => bytes.truncate(at),
                _ => {
                    if let Some(byte) = bytes.get_mut(at) {
                        *byte = with.as_bytes()[0];
                    }
                }
            }
        }
        let model = match which {
            2 => "a.gltf",
            3 => "a.glb",
            _ => "a.obj",
        };
        let listed: Vec<_> = files_now.iter().map(|(name, bytes)| (*name, bytes.as_slice())).collect();
        let path = files("fuzzed", &listed).with_file_name(model);
        match Bake::new(path).longest_side(16).bake() {
            Ok(baked) => {
                **counted.borrow_mut() += 1;
                let _ = view::draw(&baked, 16, [30.0, 20.0]);
                for mesh in &baked.meshes {
                    prop_assert!(mesh.mesh().is_ok());
                }
            }
            Err(error) => {
                let message = error.to_string();
                prop_assert!(whole.iter().any(|(name, _)| message.contains(name)), "{message}");
            }
        }
        Ok(())
    });
    ran.unwrap_or_else(|failure| panic!("{failure}"));
    println!("{baked_count} of 3000 are baked all the same");
    assert!(baked_count > 300 && baked_count < 2700);
}

#[test]
fn the_summary_says_what_a_program_has_to_reckon_with() {
    let path = files("summary", &[("card.obj", CARD.replace("mtllib card.mtl\n", "").as_bytes())]);
    let baked = Bake::new(path).bake().expect("it can be baked");
    let text = baked.to_string();
    for wanted in [
        "triangles        2 of 2 read",
        "2.000 transforms a triangle",
        "scale 0.25",
        "flash            70 B",
        "display list     84 B of RAM",
        "cycles on a Cortex-M0+",
    ] {
        assert!(text.contains(wanted), "{wanted} is not in\n{text}");
    }
}
