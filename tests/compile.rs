//! The promise: bad assets are a compile error that says what is wrong and where, and the largest good ones compile in seconds,
//! with no lint allowed.
//!
//! Each test compiles a small crate against the library that this test is linked to.
#![cfg(unix)]
#![expect(clippy::float_arithmetic, reason = "seconds of the compiler")]

use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::SystemTime;

/// What became of a crate.
struct Compiled {
    is_good: bool,
    /// What the compiler said.
    said: String,
    /// User and system time of the compiler.
    seconds: f64,
}

/// The library as it was built last: with the sources as they are now, since this test is linked to it.
fn library(among: &Path) -> PathBuf {
    let built = std::fs::read_dir(among).expect("the test stands among what cargo has built");
    let libraries = built.flatten().filter(|file| {
        let name = file.file_name();
        name.to_str().is_some_and(|name| name.starts_with("libfixel-") && name.ends_with(".rlib"))
    });
    let time = |file: &std::fs::DirEntry| {
        file.metadata().and_then(|about| about.modified()).unwrap_or(SystemTime::UNIX_EPOCH)
    };
    libraries.max_by_key(time).expect("cargo has built the library").path()
}

/// Compiles a crate named `name`, beside which lie files.
fn compile(name: &str, source: &str, files: &[(&str, &[u8])]) -> Compiled {
    let directory = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    std::fs::create_dir_all(&directory).expect("a directory for the crate");
    let path = directory.join("lib.rs");
    std::fs::write(&path, source).expect("the crate can be written");
    for (name, bytes) in files {
        std::fs::write(directory.join(name), bytes).expect("its files can be written");
    }
    let test = std::env::current_exe().expect("the test knows where it stands");
    let dependencies = test.parent().expect("it stands in a directory");
    // The shell's `times` says, in its second line, how long what it started has run.
    let output = Command::new("sh")
        .args(["-c", "\"$@\"; result=$?; times; exit $result", "sh"])
        .arg(std::env::var_os("RUSTC").unwrap_or_else(|| "rustc".into()))
        .args(["--edition=2024", "--crate-type=rlib", "--color=never", "-L"])
        .arg(format!("dependency={}", dependencies.display()))
        .arg(format!("--extern=fixel={}", library(dependencies).display()))
        .arg("--out-dir")
        .args([&directory, &path])
        .output()
        .expect("there is a shell");
    let times = String::from_utf8_lossy(&output.stdout);
    let of_children = times.lines().nth(1).expect("`times` has two lines");
    let seconds = of_children.split_whitespace().map(|time| {
        let (minutes, seconds) = time.trim_end_matches('s').split_once('m').expect("minutes and seconds");
        60.0 * minutes.parse::<f64>().expect("minutes") + seconds.parse::<f64>().expect("seconds")
    });
    Compiled {
        is_good: output.status.success(),
        said: String::from_utf8_lossy(&output.stderr).into_owned(),
        seconds: seconds.sum(),
    }
}

/// Compiles, or fails with what the compiler said.
fn must_compile(name: &str, source: &str, files: &[(&str, &[u8])]) -> f64 {
    let compiled = compile(name, source, files);
    assert!(compiled.is_good, "{name} does not compile:\n{}", compiled.said);
    println!("{name} compiles in {:.1} s of processor time", compiled.seconds);
    compiled.seconds
}

/// The largest texture, of bytes that follow one more, so that they are not aligned.
#[test]
fn the_largest_texture_compiles_in_6_s() {
    let bytes: Vec<u8> = (0..=1 << 21).map(|i: u32| (i >> 9 ^ i) as u8).collect();
    let source = r#"
        #![no_std]
        use fixel::{Texture, texels};
        const BYTES: &[u8] = include_bytes!("bytes").split_at(1).1;
        pub static LARGE: Texture = Texture::new(&texels::<{ 1024 * 1024 }>(BYTES), 10, 10);
        // The last one is where it belongs.
        const _: () = {
            let [.., low, high] = *BYTES else { panic!() };
            assert!(texels::<{ 1024 * 1024 }>(BYTES)[1024 * 1024 - 1] == low as u16 | (high as u16) << 8);
        };
    "#;
    let seconds = must_compile("large_texture", source, &[("bytes", &bytes)]);
    assert!(seconds < 6.0, "{seconds} s");
}

/// As many vertices as a mesh can have, and triangles as many as bytes of an index.
#[test]
fn a_mesh_of_65_535_triangles_and_65_536_vertices_compiles_in_6_s() {
    let source = "
        #![no_std]
        use fixel::{Mesh, Vertex};
        static VERTICES: [Vertex; 65_536] = {
            const LOW: Vertex = Vertex::new(-8.0, -8.0, 1.0).uv(1, 2).normal(0.0, 0.0, 1.0);
            let mut vertices = [LOW; 65_536];
            vertices[65_535] = Vertex::new(7.0, 7.0, -1.0);
            vertices
        };
        static TRIANGLES: [[u16; 3]; 65_535] = {
            let mut triangles = [[0; 3]; 65_535];
            let mut i = 0;
            while i < 65_535 {
                triangles[i] = [i as u16, 65_535, i as u16 + 1];
                i += 1;
            }
            triangles
        };
        pub static LARGE: Mesh = Mesh::new(&VERTICES, &TRIANGLES);
    ";
    let seconds = must_compile("large_mesh", source, &[]);
    assert!(seconds < 6.0, "{seconds} s");
    let source = source.replace("65_535, i as u16 + 1]", "65_535, 65_535]").replace("65_536", "65_535");
    let compiled = compile("large_bad_mesh", &source.replace("vertices[65_535]", "vertices[65_534]"), &[]);
    assert!(
        !compiled.is_good && compiled.said.contains("names a vertex that is not there"),
        "{}",
        compiled.said
    );
}

/// As many vertices as a mesh can have, each of its own numbers: what an asset's conversion writes.
#[test]
fn vertices_of_65_536_literals_compile_without_a_lint() {
    let source = "
        #![no_std]
        use fixel::Vertex;
        pub static VERTICES: [Vertex; 65_536] = {
            let mut vertices = [Vertex::new(0.0, 0.0, 0.0); 65_536];
            let mut i = 0;
            while i < 65_536 {
                let (x, y) = ((i % 256) as i16, (i / 256) as i16);
                vertices[i] = Vertex::new(x as f32 / 32.0 - 4.0, y as f32 / 32.0 - 4.0, 0.5).uv(x, y).normal(0.0, 0.6, 0.8);
                i += 1;
            }
            vertices
        };
    ";
    must_compile("many_vertices", source, &[]);
}

#[test]
fn a_number_out_of_range_is_a_compile_error_in_plain_words_at_the_line() {
    let lines = [
        ("Vertex::new(100.0, -20.0, 0.0)", "x of a vertex is not a number within −8 … 7.9998"),
        ("Vertex::new(0.0, -20.0, 0.0)", "y of a vertex is not a number within −8 … 7.9998"),
        ("Vertex::new(0.0, 7.999, f32::NAN)", "z of a vertex is not a number within −8 … 7.9998"),
        ("Vertex::new(0.0, 0.0, 8.0)", "z of a vertex is not a number within −8 … 7.9998"),
        ("ZERO.uv(5120, 0)", "u of a vertex is not within −2048 … 2047 texels"),
        ("ZERO.uv(0, -2049)", "v of a vertex is not within −2048 … 2047 texels"),
        ("ZERO.normal(1.0, 1.0, 1.0)", "the normal of a vertex is longer than 1, or no number"),
        ("ZERO.normal(0.0, f32::NAN, 1.0)", "the normal of a vertex is longer than 1, or no number"),
        (
            "Pose::IDENTITY.scaled_lit(5000.0)",
            "the scale of a pose is not a number of 0 or more and below 1024",
        ),
        (
            "Pose::IDENTITY.scaled_lit(-1.0)",
            "the scale of a pose is not a number of 0 or more and below 1024",
        ),
        (
            "Pose::IDENTITY.scaled_lit(f32::NAN)",
            "the scale of a pose is not a number of 0 or more and below 1024",
        ),
        ("texels::<4>(&[0; 7])", "an RGB565 picture has two bytes for each texel"),
    ];
    let mut source =
        "#![no_std]\nuse fixel::{Pose, Vertex, texels};\nconst ZERO: Vertex = Vertex::new(0.0, 0.0, 0.0);\n"
            .to_owned();
    for (i, (line, _)) in lines.iter().enumerate() {
        let kind = ["Vertex", "Pose", "[u16; 4]"]
            [usize::from(line.starts_with('P')) + 2 * usize::from(line.starts_with('t'))];
        source += &format!("pub const C{i}: {kind} = {line};\n");
    }
    let compiled = compile("out_of_range", &source, &[]);
    assert!(!compiled.is_good, "it compiles");
    for (i, (line, message)) in lines.iter().enumerate() {
        let place = format!("lib.rs:{}:", 4 + i);
        // "error[E0080]: evaluation panicked: …" and then "--> …/lib.rs:4:23".
        let mut errors = compiled.said.split("\nerror");
        let found = errors.any(|error| error.contains(message) && error.contains(&place));
        assert!(found, "{line} should say “{message}” at {place}\n{}", compiled.said);
    }
}

#[test]
fn what_is_no_pixel_format_says_what_to_do_instead() {
    let source = "
        use fixel::embedded_graphics::pixelcolor::{BinaryColor, Gray8, Rgb555, Rgb565};
        use fixel::embedded_graphics::prelude::*;
        use fixel::{Band, Depth16, NoDepth};
        pub fn no_pixels() { let _ = Band::<BinaryColor, NoDepth>::new(Size::new(1, 1), &mut [], &mut []); }
        pub fn no_depths(pixels: &mut [u16]) { let _ = Band::<Rgb565, Rgb565>::new(Size::new(1, 1), pixels, &mut []); }
        pub fn not_sent(band: &Band<'_, Gray8, Depth16>) { band.dithered::<Rgb555>(); }
    ";
    let compiled = compile("no_format", source, &[]);
    assert!(!compiled.is_good, "it compiles");
    let errors: Vec<_> = compiled.said.split("\nerror").collect();
    let expected: [(&str, &[&str]); 3] = [
        (
            "lib.rs:5:",
            &[
                "`BinaryColor` is not a format that pixels are drawn in",
                "a band's pixels are `Rgb565`, `Bgr565`, `Rgb666`, `Rgb888`, `Bgr888` or `Gray8`",
                "for a display of fewer bits (`BinaryColor`, `Gray2`, `Gray4`) draw in `Gray8` and send `band.dithered::<BinaryColor>()`",
                "pass `&mut display.color_converted()`",
            ],
        ),
        ("lib.rs:6:", &["`Rgb565` is not a format of depths", "depths are `Depth16`, or none, `NoDepth`"]),
        ("lib.rs:7:", &["a band cannot be sent in `Rgb555`", "implement `Quantize` for its colour type"]),
    ];
    for (place, messages) in expected {
        // A message may be broken into lines.
        let said = |error: &str, message: &str| {
            let words: Vec<_> = error.split_whitespace().filter(|word| *word != "|").collect();
            words.join(" ").contains(message)
        };
        let found = errors
            .iter()
            .any(|error| error.contains(place) && messages.iter().all(|message| said(error, message)));
        assert!(found, "{place} should say {messages:#?}\n{}", compiled.said);
    }
}
