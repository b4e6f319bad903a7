//! Counts the scenes by SysTick on an MPS2 board, and prints one line a scene.

#[path = "../../systick.rs"]
mod systick;

use crate::{
    deep::{bench_clear, bench_covered},
    scenes::SCENES,
};
use semihosting::{println, process};

#[cortex_m_rt::entry]
fn main() -> ! {
    systick::start();
    for (name, scene) in SCENES {
        // Through a pointer that the compiler does not see through: the function stays.
        core::hint::black_box(bench_clear as extern "C" fn())();
        let (promised, instructions) = systick::count(|| scene(0));
        let covered = bench_covered();
        assert_eq!(covered, promised, "pixels of {name}");
        println!("{name} pixels {covered} instructions {instructions}");
    }
    process::exit(0)
}
