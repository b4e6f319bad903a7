//! Hands the memory map to the linker script of cortex-m-rt.

use std::{env, fs, path::Path};

fn main() {
    println!("cargo:rerun-if-changed=build.rs");
    println!("cargo:rerun-if-changed=memory.x");
    let out = env::var("OUT_DIR").expect("cargo sets it for build scripts");
    fs::copy("memory.x", Path::new(&out).join("memory.x")).expect("the memory map is in this package");
    println!("cargo:rustc-link-search={out}");
    // Sections need no alignment to a desktop's pages.
    println!("cargo:rustc-link-arg-bins=--nmagic");
    println!("cargo:rustc-link-arg-bins=-Tlink.x");
}
