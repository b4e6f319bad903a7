//! Chooses the board by the target: its memory map, for the linker script of cortex-m-rt.

use std::{env, fs, path::Path};

fn main() {
    println!("cargo:rerun-if-changed=build.rs");
    println!("cargo:rerun-if-changed=memory");
    println!("cargo:rustc-check-cfg=cfg(board, values(\"bare\", \"lm3s6965evb\", \"microbit\", \"mps2\"))");
    let var = |name| env::var(name).expect("cargo sets it for build scripts");
    let bare = env::var_os("CARGO_FEATURE_BARE").is_some();
    let (board, memory) = match var("TARGET").as_str() {
        // No board: a counter calls the functions of `bench` and `cost`.
        target if target.starts_with("riscv32") || bare && target.starts_with("thumb") => {
            println!("cargo:rustc-cfg=board=\"bare\"");
            println!("cargo:rustc-link-arg-bins=--nmagic");
            println!("cargo:rustc-link-arg-bins=-T{}/memory/bare.x", var("CARGO_MANIFEST_DIR"));
            return;
        }
        // The boards on which every core's code can be counted.
        target if target.starts_with("thumb") && env::var_os("CARGO_FEATURE_MPS2").is_some() => {
            ("mps2", "memory/mps2.x")
        }
        "thumbv7m-none-eabi" => ("lm3s6965evb", "memory/lm3s6965.x"),
        "thumbv6m-none-eabi" => ("microbit", "memory/nrf51822.x"),
        // A desktop: the library, its tests and the programs' host halves need no linker script.
        _ => return,
    };
    let out = var("OUT_DIR");
    fs::copy(memory, Path::new(&out).join("memory.x")).expect("the memory map is in this package");
    println!("cargo:rustc-cfg=board=\"{board}\"");
    println!("cargo:rustc-link-search={out}");
    // Sections need no alignment to a desktop's pages.
    println!("cargo:rustc-link-arg-bins=--nmagic");
    println!("cargo:rustc-link-arg-bins=-Tlink.x");
}
