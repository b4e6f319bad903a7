//! Bakes the model, and names esp-hal's linker script.

use std::error::Error;

fn main() -> Result<(), Box<dyn Error>> {
    fixel_bake::Bake::new("../../assets/globe.obj").size(2.0).for_cargo()?;
    println!("cargo:rustc-link-arg-bins=-Tlinkall.x");
    Ok(())
}
