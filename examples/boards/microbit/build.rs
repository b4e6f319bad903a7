//! Bakes the model, and hands the memory map to the linker script of cortex-m-rt.

use std::{env, error::Error, fs, path::Path};

fn main() -> Result<(), Box<dyn Error>> {
    fixel_bake::Bake::new("../../assets/globe.obj").size(2.0).for_cargo()?;

    println!("cargo:rerun-if-changed=memory.x");
    let out = env::var("OUT_DIR")?;
    fs::copy("memory.x", Path::new(&out).join("memory.x"))?;
    println!("cargo:rustc-link-search={out}");
    println!("cargo:rustc-link-arg-bins=--nmagic"); // sections need no alignment to a desktop's pages
    println!("cargo:rustc-link-arg-bins=-Tlink.x");
    Ok(())
}
