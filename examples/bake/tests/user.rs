//! README to the letter: a new project with a model that was not made for fixel builds, and shows it.

use std::path::Path;
use std::process::Command;

const README: &str = include_str!("../README.md");

/// The first block of a language behind a heading or a sentence.
fn block(after: &str, language: &str) -> &'static str {
    let from = README.split_once(after).unwrap_or_else(|| panic!("README has no `{after}`")).1;
    let from = from.split_once(&format!("```{language}\n")).expect("there is a block").1;
    from.split_once("```").expect("it ends").0
}

#[test]
fn readmes_build_script_and_program_show_a_globe() {
    let package = Path::new(env!("CARGO_MANIFEST_DIR"));
    let root = package.join("../..").canonicalize().expect("the library is there");
    let project = Path::new(env!("CARGO_TARGET_TMPDIR")).join("user");
    for folder in ["src", "assets"] {
        std::fs::create_dir_all(project.join(folder)).expect("a folder");
    }
    // What `cargo new` writes, with README's lines; without those that only make the build script faster, as they take the compiler longer.
    let manifest = block("In `Cargo.toml`", "toml").split("\n# Ordering").next().expect("the dependencies");
    let manifest = manifest.replace("../fixel", &root.display().to_string());
    let manifest = format!(
        "[package]\nname = \"user\"\nversion = \"0.1.0\"\nedition = \"2024\"\n\n{manifest}\n[workspace]\n"
    );
    let write = |name: &str, text: &str| std::fs::write(project.join(name), text).expect("it can be written");
    write("Cargo.toml", &manifest);
    write("build.rs", block("In `build.rs`", "rust"));
    write("src/main.rs", block("In the program", "rust"));
    std::fs::copy(package.join("Cargo.lock"), project.join("Cargo.lock")).expect("a lock file");
    for (from, to) in [("globe.obj", "ship.obj"), ("globe.mtl", "globe.mtl"), ("earth.jpg", "earth.jpg")] {
        std::fs::copy(root.join("examples/assets").join(from), project.join("assets").join(to))
            .expect("an asset");
    }
    let output = Command::new(env!("CARGO"))
        .args(["run", "--quiet", "--offline", "--target-dir", "target"])
        .current_dir(&project)
        .env_remove("RUSTFLAGS")
        .output()
        .expect("cargo runs");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let shown = String::from_utf8(output.stdout).expect("text");
    let numbers: Vec<u8> = shown
        .lines()
        .skip(1)
        .flat_map(str::split_whitespace)
        .map(|word| word.parse().expect("a channel"))
        .collect();
    let pixels: Vec<_> = numbers.as_chunks::<3>().0.iter().collect();
    assert_eq!(pixels.len(), 120 * 120);
    // The globe is 2 across the middle: the Earth is mostly blue, and there is land.
    let globe: Vec<_> =
        pixels.iter().filter(|pixel| ***pixel != [24, 24, 112] && ***pixel != [24, 24, 104]).collect();
    assert!(globe.len() > 1500, "{} pixels", globe.len());
    let blue = globe.iter().filter(|[red, _, blue]| blue > red).count();
    assert!(blue > globe.len() / 4 && blue < globe.len(), "{blue} of {} are blue", globe.len());
    std::fs::write(project.join("globe.ppm"), &shown).expect("it can be written");
}
