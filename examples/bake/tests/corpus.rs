//! Every OBJ and glTF file of Debian's package `assimp-testmodels`: models of many makers, broken ones among them. Each is baked and drawn,
//! or refused with a message that names the file and the fault; what is baked agrees with an independent reader, `trimesh`; and the
//! modules of Rust compile, and draw the same picture as what is in memory.
//!
//! `RESULTS.md` and `contact-sheet.png` are held to what comes out. `FIXEL_UPDATE_RESULTS=1 cargo test --test corpus` makes them anew.

use fixel_bake::{Bake, Baked, view, write_module};
use image::{Rgb, RgbImage, imageops};
use std::collections::{BTreeMap, HashMap};
use std::fmt::Write as _;
use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::{OnceLock, mpsc};
use std::time::Duration;

const MODELS: &str = "/usr/share/assimp/models";
/// The version that RESULTS.md is of.
const VERSION: &str = "5.2.5";
const PYTHON_PACKAGES: [&str; 3] = ["trimesh==4.6.8", "numpy", "networkx"];
const SIDE: u32 = 96;
const COLUMNS: u32 = 10;

/// Past the capture of a test's output: nobody reads what a test prints that passes.
fn loudly(text: &str) {
    let _ = writeln!(std::io::stderr(), "\n!!! NOT RUN: {text}\n");
}

fn package() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR"))
}

fn temporary() -> PathBuf {
    PathBuf::from(env!("CARGO_TARGET_TMPDIR"))
}

/// All models, by path below [`MODELS`]; none if the package cannot be installed.
fn models() -> Vec<PathBuf> {
    if !Path::new(MODELS).is_dir() {
        for command in
            ["apt-get update -q", "apt-get install -y -q --no-install-recommends assimp-testmodels"]
        {
            let command =
                format!("if [ $(id -u) = 0 ]; then {command}; else sudo -n {command}; fi >/dev/null 2>&1");
            let _ = Command::new("sh").args(["-c", &command]).status();
        }
    }
    let mut found = Vec::new();
    let mut left = vec![PathBuf::from(MODELS)];
    while let Some(folder) = left.pop() {
        for entry in std::fs::read_dir(folder).into_iter().flatten().flatten() {
            let path = entry.path();
            if path.is_dir() {
                left.push(path);
            } else if path.extension().is_some_and(|ending| {
                ["obj", "gltf", "glb"].iter().any(|known| ending.eq_ignore_ascii_case(known))
            }) {
                found.push(path);
            }
        }
    }
    found.sort();
    if found.is_empty() {
        loudly(
            "the corpus of models: Debian's package assimp-testmodels is not here, and could not be installed",
        );
    }
    found
}

type Outcome = Result<Baked, String>;

/// What became of each model, by its path below [`MODELS`]. Baked once for all tests.
fn outcomes() -> &'static BTreeMap<String, Outcome> {
    static OUTCOMES: OnceLock<BTreeMap<String, Outcome>> = OnceLock::new();
    OUTCOMES.get_or_init(|| {
        let bake_one = |path: PathBuf| {
            let name = path.strip_prefix(MODELS).expect("below the folder").display().to_string();
            let (sender, receiver) = mpsc::channel();
            let baking = std::thread::spawn(move || {
                let _ = sender.send(Bake::new(path).bake().map_err(|error| error.to_string()));
            });
            let outcome = receiver.recv_timeout(Duration::from_secs(120));
            // One that hangs is not waited for; one that panics has said why.
            let outcome =
                outcome.unwrap_or_else(|_| panic!("{name} hangs, or panics: {}", baking.is_finished()));
            (name, outcome)
        };
        models().into_iter().map(bake_one).collect()
    })
}

/// From one side, above or below: flat models are seen from one side only.
fn best_view(baked: &Baked) -> (RgbImage, view::Frame) {
    let plain = view::draw(baked, SIDE, [30.0, 20.0]);
    if plain.1.covered > 900 {
        return plain;
    }
    let views = [
        [30.0, 20.0],
        [-30.0, 20.0],
        [150.0, 20.0],
        [210.0, 20.0],
        [30.0, -35.0],
        [210.0, -35.0],
        [30.0, 70.0],
    ];
    let views = views.map(|view| view::draw(baked, SIDE, view));
    views.into_iter().max_by_key(|(_, frame)| frame.covered).expect("some views")
}

#[test]
fn each_model_is_baked_and_drawn_or_refused_by_name() {
    let outcomes = outcomes();
    if outcomes.is_empty() {
        return;
    }
    let (mut baked_count, mut refused_count) = (0, 0);
    for (name, outcome) in outcomes {
        match outcome {
            Ok(baked) => {
                baked_count += 1;
                assert!(baked.report.triangles > 0, "{name}");
                let (_, frame) = best_view(baked);
                assert!(frame.covered > 100, "{name} covers {} pixels", frame.covered);
                // The order is never worse than the file's, and no frame transforms more: culling comes after.
                assert!(baked.report.transforms <= baked.report.transforms_before, "{name}");
                let drawn: u32 = frame.stats.iter().map(|stats| stats.transformed).sum();
                let clipped: u32 = frame.stats.iter().map(|stats| stats.clipped).sum();
                assert!(
                    clipped > 0 || drawn as usize == baked.report.transforms,
                    "{name}: {drawn} {clipped}"
                );
            }
            Err(message) => {
                refused_count += 1;
                let file = Path::new(name).file_name().expect("a file").to_string_lossy();
                assert!(message.contains(&*file), "{name}: {message}");
                assert!(message.len() > file.len() + 20, "{name}: {message}");
            }
        }
    }
    println!("{baked_count} baked, {refused_count} refused");
    assert!(baked_count >= 40 && refused_count >= 20);
}

/// What has to be refused, and why.
#[test]
fn broken_models_are_refused_with_what_is_wrong() {
    let outcomes = outcomes();
    if outcomes.is_empty() {
        return;
    }
    for (name, wanted) in [
        ("invalid/malformed.obj", "malformed.obj:23: a face names vertex 12, and there are 8 so far"),
        ("invalid/empty.obj", "there is no triangle in it"),
        ("OBJ/number_formats.obj", "number_formats.obj:11: `3.1+e2` is no number"),
        ("OBJ/testpoints.obj", "24 points and 0 lines are left out"),
        ("glTF/TwoBoxes/TwoBoxes.gltf", "is glTF 1.0"),
        ("glTF/BoxTextured-glTF-Binary/BoxTextured.glb", "is GLB 1"),
        (
            "glTF2/BoxWithInfinites-glTF-Binary/BoxWithInfinites.glb",
            "vertex 0 at [-inf, -0.5, 0.5], which is not finite",
        ),
        ("glTF2/IndexOutOfRange/IndexOutOfRange.gltf", "mesh 0, primitive 0 names vertex 255, and has 24"),
        ("glTF2/MissingBin/BoxTextured.gltf", "`BoxTextured0.bin`, which cannot be read"),
        ("glTF2/RecursiveNodes/RecursiveNodes.gltf", "node 0 stands below itself"),
        ("glTF2/SchemaFailures/sceneWrongType.gltf", "sceneWrongType.gltf:6: invalid type"),
        ("glTF2/draco/2CylinderEngine.gltf", "wants the extension KHR_draco_mesh_compression"),
        ("glTF2/wrongTypes/badUint.gltf", "badUint.gltf:128: invalid type: integer `-1`"),
    ] {
        match &outcomes[name] {
            Err(message) => assert!(message.contains(wanted), "{name}: {message}"),
            Ok(_) => panic!("{name} is baked"),
        }
    }
}

const READER: &str = r#"
import json, sys, warnings, logging
warnings.simplefilter("ignore"); logging.disable(logging.CRITICAL)
import numpy, trimesh
for path in sys.stdin.read().split("\n"):
    if not path: continue
    try:
        options = {"skip_materials": True} if path.lower().endswith(".obj") else {}
        scene = trimesh.load_scene(path, process=False, **options)
        meshes = [m for m in scene.dump() if isinstance(m, trimesh.Trimesh)]
        mesh = trimesh.util.concatenate(meshes)
        t = mesh.triangles
        edges = numpy.linalg.norm(t - numpy.roll(t, 1, axis=1), axis=2).sum()
        low, high = t.reshape(-1, 3).min(axis=0), t.reshape(-1, 3).max(axis=0)
        numbers = [len(t), mesh.area, edges, *low, *high]
        assert numpy.isfinite(numbers).all()
        print(path, *[repr(float(n)) for n in numbers], sep="\t")
    except BaseException as error:
        print(path, "refused", repr(error).replace("\n", " ")[:200], sep="\t")
"#;

/// The Python that has `trimesh`.
fn python() -> Option<PathBuf> {
    let folder = temporary().join("venv");
    let python = folder.join("bin/python");
    let works = || {
        Command::new(&python)
            .args(["-c", "import trimesh, numpy, networkx"])
            .output()
            .is_ok_and(|output| output.status.success())
    };
    if !works() {
        let made = Command::new("python3").args(["-m", "venv"]).arg(&folder).output();
        if made.is_ok_and(|output| output.status.success()) {
            let _ = Command::new(&python)
                .args(["-m", "pip", "install", "--quiet"])
                .args(PYTHON_PACKAGES)
                .output();
        }
    }
    works().then_some(python)
}

#[test]
fn what_is_baked_agrees_with_trimesh() {
    let outcomes = outcomes();
    let Some(python) = python() else {
        return loudly(
            "the comparison with trimesh: there is no Python for it, or the package could not be installed",
        );
    };
    let mut child = Command::new(python)
        .args(["-c", READER])
        .stdin(std::process::Stdio::piped())
        .stdout(std::process::Stdio::piped())
        .spawn()
        .expect("Python starts");
    let paths: Vec<_> = outcomes.keys().map(|name| format!("{MODELS}/{name}")).collect();
    child.stdin.take().expect("it reads").write_all(paths.join("\n").as_bytes()).expect("it reads");
    let output = child.wait_with_output().expect("it ends");
    let text = String::from_utf8(output.stdout).expect("text");
    let (mut both, mut only_here, mut only_there) = (0, Vec::new(), Vec::new());
    for line in text.lines() {
        let mut words = line.split('\t');
        let name =
            words.next().and_then(|path| path.strip_prefix(MODELS)).expect("a path").trim_start_matches('/');
        let numbers: Vec<f64> = words.clone().filter_map(|word| word.parse().ok()).collect();
        let baked = match (&outcomes[name], numbers.len()) {
            (Ok(baked), 9) => baked,
            (Ok(_), _) => {
                only_here.push(name);
                continue;
            }
            (Err(_), 9) => {
                only_there.push(name);
                continue;
            }
            _ => continue,
        };
        both += 1;
        let report = &baked.report;
        // A box with a corner of each polygon that is not convex differs by how it is cut, and trimesh cuts fans.
        let is_concave = ["OBJ/concave_polygon.obj", "OBJ/space_in_material_name.obj"].contains(&name);
        assert_eq!(report.triangles_read, numbers[0] as usize, "{name}: triangles");
        let slack =
            report.largest_error + 1e-6 * numbers[3..].iter().fold(0.0, |most: f64, at| most.max(at.abs()));
        for i in 0..3 {
            assert!(
                (report.bounds[0][i] - numbers[3 + i]).abs() <= slack,
                "{name}: {:?} {numbers:?}",
                report.bounds
            );
            assert!(
                (report.bounds[1][i] - numbers[6 + i]).abs() <= slack,
                "{name}: {:?} {numbers:?}",
                report.bounds
            );
        }
        // A triangle's area changes by at most half its edges times what a corner moves, and the square of that.
        let area_slack = numbers[2] * slack + numbers[0] * slack * slack + 1e-6 * numbers[1];
        assert!(
            is_concave || (report.area - numbers[1]).abs() <= area_slack,
            "{name}: {} {}",
            report.area,
            numbers[1]
        );
    }
    println!("{both} agree; baked here only: {only_here:?}; read there only: {only_there:?}");
    assert!(outcomes.is_empty() || both >= 30, "only {both} are read by both");
}

/// A row of the table.
fn row(name: &str, baked: &Baked) -> String {
    let report = &baked.report;
    let each = |count: usize| count as f64 / report.triangles as f64;
    let (cycles, _) = fixel_bake::cost::of_a_frame(baked, 160);
    let size = (0..3).map(|i| report.bounds[1][i] - report.bounds[0][i]).fold(0.0, f64::max);
    format!(
        "| `{name}` | {} | {} | {} | {:.2} → {:.2} | {:.4} % | {:.1} | {:.1} / {:.1} |",
        report.triangles,
        report.vertices,
        baked.meshes.len(),
        each(report.transforms_before),
        each(report.transforms),
        100.0 * report.largest_error / size,
        baked.flash() as f64 / 1024.0,
        cycles[0] / 1e6,
        cycles[1] / 1e6,
    )
}

#[test]
fn the_table_and_the_contact_sheet_are_what_comes_out() {
    let outcomes = outcomes();
    if outcomes.is_empty() {
        return;
    }
    let baked: Vec<_> = outcomes
        .iter()
        .filter_map(|(name, outcome)| outcome.as_ref().ok().map(|baked| (name, baked)))
        .collect();
    let mut table = format!(
        "# What bake makes of a corpus\n\n\
         All OBJ and glTF files of Debian's package `assimp-testmodels` {VERSION}: {} are baked, {} refused. `tests/corpus.rs` makes this page and the\n\
         contact sheet, in the order of the table, and holds them to what comes out.\n\n\
         ![All of them, drawn by fixel](contact-sheet.png)\n\n\
         - Order: vertices that are transformed for a triangle, in the order of the file, vertices welded, and as baked.\n\
         - Error: the largest distance of a vertex from where the file has it, of the model's longest side.\n\
         - Frame: millions of cycles to expect on a Cortex-M0+ / Cortex-M4F for 160 × 160 pixels that show the whole model.\n\n\
         | model | triangles | vertices | draws | order | error | flash, KiB | frame |\n|---|---|---|---|---|---|---|---|\n",
        baked.len(),
        outcomes.len() - baked.len()
    );
    for (name, baked) in &baked {
        let _ = writeln!(table, "{}", row(name, baked));
    }
    let total =
        |count: fn(&Baked) -> usize| baked.iter().map(|(_, baked)| count(baked)).sum::<usize>() as f64;
    let triangles = total(|baked| baked.report.triangles);
    let _ = writeln!(
        table,
        "| all | {triangles:.0} | {:.0} | {:.0} | {:.2} → {:.2} | | {:.1} | |\n\n## Refused\n\n| file | message |\n|---|---|",
        total(|baked| baked.report.vertices),
        total(|baked| baked.meshes.len()),
        total(|baked| baked.report.transforms_before) / triangles,
        total(|baked| baked.report.transforms) / triangles,
        total(Baked::flash) / 1024.0,
    );
    for (name, outcome) in outcomes {
        if let Err(message) = outcome {
            let folder = Path::new(name).parent().expect("a folder").display();
            let message = message.replace(&format!("{MODELS}/{folder}/"), "").replace('|', "\\|");
            let _ = writeln!(table, "| `{name}` | {message} |");
        }
    }
    let rows = (baked.len() as u32).div_ceil(COLUMNS);
    let mut sheet = RgbImage::from_pixel(COLUMNS * SIDE, rows * SIDE, Rgb([40, 44, 56]));
    for (number, (_, baked)) in baked.iter().enumerate() {
        let (picture, _) = best_view(baked);
        let (x, y) = (number as u32 % COLUMNS * SIDE, number as u32 / COLUMNS * SIDE);
        imageops::replace(&mut sheet, &picture, x.into(), y.into());
    }
    let (page, picture) = (package().join("RESULTS.md"), package().join("contact-sheet.png"));
    if std::env::var_os("FIXEL_UPDATE_RESULTS").is_some() {
        std::fs::write(&page, &table).expect("the page can be written");
        sheet.save(&picture).expect("the picture can be written");
        return;
    }
    let installed = Command::new("dpkg-query").args(["-W", "-f", "${Version}", "assimp-testmodels"]).output();
    if !installed.is_ok_and(|output| String::from_utf8_lossy(&output.stdout).starts_with(VERSION)) {
        return loudly(&format!("the comparison with RESULTS.md: it is of assimp-testmodels {VERSION}"));
    }
    let known = std::fs::read_to_string(&page).expect("RESULTS.md");
    for (line, (known, found)) in known.lines().zip(table.lines()).enumerate() {
        assert_eq!(known, found, "line {} of RESULTS.md", line + 1);
    }
    assert_eq!(known.lines().count(), table.lines().count());
    let known = image::open(&picture).expect("contact-sheet.png").into_rgb8();
    assert!(known == sheet, "contact-sheet.png is not what comes out");
}

/// Runs a build of a small project, in one folder for all of them, so that fixel is compiled once.
fn run(project: &Path) -> String {
    let output = Command::new(env!("CARGO"))
        .args(["run", "--quiet", "--release", "--offline"])
        .current_dir(project)
        .env("CARGO_TARGET_DIR", temporary().join("projects"))
        .env_remove("RUSTFLAGS")
        .output()
        .expect("cargo runs");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).expect("text")
}

/// A checksum of words.
fn sum(words: &[u16]) -> u64 {
    words
        .iter()
        .fold(0xcbf2_9ce4_8422_2325, |sum, word| (sum ^ u64::from(*word)).wrapping_mul(0x0100_0000_01b3))
}

#[test]
fn modules_compile_and_draw_what_is_in_memory() {
    use fixel::embedded_graphics::{pixelcolor::Rgb565, prelude::*};
    use fixel::{Band, Camera, Depth16, Light, Lights, Turn, Vec3};
    let outcomes = outcomes();
    let project = temporary().join("modules");
    let mut expected = HashMap::new();
    let (mut modules, mut calls) = (String::new(), String::new());
    let mut count = 0;
    // The four largest would take most of the time.
    for (name, baked) in outcomes.iter().filter_map(|(name, outcome)| Some((name, outcome.as_ref().ok()?))) {
        if baked.report.triangles > 6000 {
            continue;
        }
        count += 1;
        let paths =
            write_module(baked, project.join(format!("m{count}"))).expect("the module can be written");
        let _ = writeln!(modules, "mod m{count} {{ include!({:?}); }}", paths[0]);
        let _ = writeln!(calls, "    show!(m{count});");
        let (mut pixels, mut depth) = (vec![0; 4096], vec![0; 4096]);
        let mut band =
            Band::<Rgb565, Depth16>::new(Size::new(64, 64), &mut pixels, &mut depth).expect("a band");
        let reach = (baked.fit.scale * 8.0) as f32;
        let camera =
            Camera::perspective(Turn::from_degrees(40), band.size()).at(Vec3::lit(0.0, 0.0, 3.0 * reach));
        let suns = [Light::directional(Vec3::lit(-0.5, -0.8, -0.6), [190, 185, 175])];
        let lights = Lights::new([75, 78, 85], &suns);
        let pose = fixel::Pose::IDENTITY.scaled_lit(baked.fit.scale as f32).rotated_y(Turn::from_degrees(30));
        let mut order: Vec<_> = baked.meshes.iter().collect();
        order.sort_by_key(|mesh| baked.materials[mesh.material].alpha.is_some());
        for mesh in order {
            let surface = view::surface(baked, &baked.materials[mesh.material]).expect("a surface");
            camera.lit_by(&lights).draw(&mesh.mesh().expect("a mesh"), &pose, surface, &mut band);
        }
        expected.insert(format!("m{count}"), (name, sum(band.pixels())));
    }
    let main = format!(
        r#"#![deny(warnings)]
#![allow(dead_code, reason = "not all of each module is used")]
use fixel::embedded_graphics::{{pixelcolor::Rgb565, prelude::*}};
use fixel::{{Band, Camera, Depth16, DisplayList, Light, Lights, ListMemory, Turn, Vec3}};
{modules}
fn sum(words: &[u16]) -> u64 {{
    words.iter().fold(0xcbf2_9ce4_8422_2325, |sum, word| (sum ^ u64::from(*word)).wrapping_mul(0x0100_0000_01b3))
}}
macro_rules! show {{
    ($name:ident) => {{{{
        let (mut pixels, mut depth) = (vec![0; 4096], vec![0; 4096]);
        let mut band = Band::<Rgb565, Depth16>::new(Size::new(64, 64), &mut pixels, &mut depth).unwrap();
        let reach = f32::from_bits($name::POSE.scale[0].to_num::<f32>().to_bits()) * 8.0;
        let camera = Camera::perspective(Turn::from_degrees(40), band.size()).at(Vec3::lit(0.0, 0.0, 3.0 * reach));
        let suns = [Light::directional(Vec3::lit(-0.5, -0.8, -0.6), [190, 185, 175])];
        let lights = Lights::new([75, 78, 85], &suns);
        let pose = $name::POSE.rotated_y(Turn::from_degrees(30));
        $name::draw(&camera.lit_by(&lights), &pose, &mut band);
        println!("{{}} {{}}", stringify!($name), sum(band.pixels()));
        let memory = Box::leak(Box::new(ListMemory::<{{ 2 * $name::LIST_VERTICES + 64 }}, {{ 2 * $name::LIST_TRIANGLES + 64 }}>::new()));
        let mut list = DisplayList::<Rgb565, Depth16, {{ $name::DRAWS }}>::new(memory);
        $name::draw_in_list(&camera.lit_by(&lights), &pose, &mut list).unwrap();
    }}}};
}}
fn main() {{
{calls}}}
"#
    );
    let manifest = format!(
        "[package]\nname = \"modules\"\nversion = \"0.1.0\"\nedition = \"2024\"\n\n[dependencies]\nfixel = {{ path = {:?} }}\n\n\
         [profile.release]\nopt-level = 1\ndebug = false\n\n[workspace]\n",
        package().join("../..").canonicalize().expect("the library is there")
    );
    std::fs::create_dir_all(project.join("src")).expect("a folder");
    std::fs::write(project.join("Cargo.toml"), manifest).expect("a manifest");
    std::fs::write(project.join("src/main.rs"), main).expect("a program");
    std::fs::copy(package().join("Cargo.lock"), project.join("Cargo.lock")).expect("a lock file");
    let shown = run(&project);
    let mut lines = 0;
    for line in shown.lines() {
        let (module, found) = line.split_once(' ').expect("a name and a sum");
        let (name, expected) = &expected[module];
        assert_eq!(found, expected.to_string(), "{name} is another as a module");
        lines += 1;
    }
    assert_eq!(lines, expected.len());
}
