//! Counts s4 by SysTick on an MPS2 board, as `bench` does its scenes, and prints one line a way of drawing it.

#[path = "../../systick.rs"]
mod systick;

use crate::functions::{bench_s4, bench_s4_whole};
use fixel_firmware::s4::SIZE;
use semihosting::{println, process};

#[cortex_m_rt::entry]
fn main() -> ! {
    systick::start();
    let ways: [(&str, extern "C" fn(u32) -> u32, u32); 3] =
        [("s4_whole", bench_s4_whole, 0), ("s4_16", bench_s4, 16), ("s4_8", bench_s4, 8)];
    for (name, draw, argument) in ways {
        let (rows, instructions) = systick::count(|| draw(argument));
        println!("{name} pixels {} instructions {instructions}", rows * SIZE.width);
    }
    process::exit(0)
}
