//! Programs, built for a chip.

use std::{
    env,
    path::{Path, PathBuf},
    process::Command,
};

fn rustc() -> Command {
    Command::new(env::var_os("RUSTC").unwrap_or_else(|| "rustc".into()))
}

/// Number and no hash.
pub(super) fn rustc_version() -> String {
    let version = rustc().arg("--version").output().expect("rustc runs").stdout;
    String::from_utf8_lossy(&version).split_whitespace().take(2).collect::<Vec<_>>().join(" ")
}

/// Compiles programs with features of the package and flags for rustc, in a target directory of their own: the outer cargo may
/// hold the lock of its. Returns the folder where the programs are.
pub(super) fn build(programs: &[&str], features: &str, target: &str, flags: &str) -> PathBuf {
    let directory = Path::new(env!("CARGO_TARGET_TMPDIR")).join("boards");
    let mut cargo = Command::new(env!("CARGO"));
    cargo
        .args(["build", "--release", "--locked", "--target", target, "--features", features])
        .args(programs.iter().flat_map(|program| ["--bin", program]))
        .args(["--manifest-path", concat!(env!("CARGO_MANIFEST_DIR"), "/Cargo.toml")])
        .arg("--target-dir")
        .arg(&directory);
    if !flags.is_empty() {
        cargo.env("RUSTFLAGS", env::var("RUSTFLAGS").unwrap_or_default() + " " + flags);
    }

    let sysroot = rustc().args(["--print", "sysroot"]).output();
    let sysroot = sysroot.expect("rustc runs").stdout;
    let rustlib = Path::new(String::from_utf8_lossy(&sysroot).trim()).join("lib/rustlib");
    if !rustlib.join(target).join("lib").exists() {
        // Where rustup cannot add the target, `core` may still be there as source.
        assert!(
            rustlib.join("src/rust/library/core").exists(),
            "this machine cannot build for {target}: run `rustup target add {target}`, \
             or skip the boards by FIXEL_SKIP_BOARDS=1"
        );
        cargo.env("RUSTC_BOOTSTRAP", "1").env("CARGO_UNSTABLE_BUILD_STD", "core");
    }

    let output = cargo.output().expect("cargo runs");
    assert!(
        output.status.success(),
        "{} does not build for {target}:\n{}",
        programs.join(", "),
        String::from_utf8_lossy(&output.stderr)
    );
    directory.join(target).join("release")
}
