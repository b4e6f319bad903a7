//! Bakes the model, and names the linker script.

use std::{env, error::Error};

fn main() -> Result<(), Box<dyn Error>> {
    fixel_bake::Bake::new("../../assets/globe.obj").size(2.0).for_cargo()?;
    println!("cargo:rerun-if-changed=bare.x");
    println!("cargo:rustc-link-arg-bins=--nmagic");
    println!("cargo:rustc-link-arg-bins=-T{}/bare.x", env::var("CARGO_MANIFEST_DIR")?);
    Ok(())
}
