//! The scenes by which speed is judged, each an exported function `bench_NAME(frame) -> covered pixels` that any
//! counter of instructions can call, with `bench_clear()` before it.
//!
//! With the feature `mps2` it runs on an MPS2 board in QEMU, and prints one line a scene with its instructions. With
//! `bare`, and always on RISC-V, it is the functions and nothing else, for every core; with `only-s1` just the first of
//! them, to see what flash it takes.

#![cfg_attr(target_os = "none", no_std, no_main)]

#[cfg(all(target_os = "none", not(any(board = "mps2", board = "bare"))))]
compile_error!("`bench` runs on MPS2 boards or none: build it with --features mps2 or --features bare");

#[cfg(board = "bare")]
#[expect(unsafe_code, reason = "exported symbols")]
mod bare;
#[cfg(all(target_os = "none", not(feature = "only-s1")))]
#[expect(unsafe_code, reason = "exported symbols, and frames that are too large for a stack")]
mod deep;
#[cfg(target_os = "none")]
#[expect(unsafe_code, reason = "exported symbols, and frames that are too large for a stack")]
mod frames;
#[cfg(board = "mps2")]
mod mps2;
#[cfg(target_os = "none")]
#[expect(unsafe_code, reason = "exported symbols")]
mod scenes;

#[cfg(not(target_os = "none"))]
fn main() {
    let [s1, all] = fixel_firmware::bench::data_bytes();
    println!("bench counts instructions on boards; see README.md. Bytes of its meshes and its texture:");
    println!("s1 {s1}\nall {all}");
}
