//! Counts s4 by SysTick on an MPS2 board, as `bench` does its scenes, and prints one line a way of drawing it.

use crate::functions::{bench_s4, bench_s4_whole};
use cortex_m::peripheral::{Peripherals, SYST, syst::SystClkSource};
use fixel_firmware::s4::SIZE;
use semihosting::{println, process};

#[cortex_m_rt::entry]
fn main() -> ! {
    if let Some(mut peripherals) = Peripherals::take() {
        let syst = &mut peripherals.SYST;
        syst.set_clock_source(SystClkSource::Core);
        syst.set_reload(0x00ff_ffff);
        syst.clear_current();
        syst.enable_counter();
    }
    let ways: [(&str, extern "C" fn(u32) -> u32, u32); 3] =
        [("s4_whole", bench_s4_whole, 0), ("s4_16", bench_s4, 16), ("s4_8", bench_s4, 8)];
    for (name, draw, argument) in ways {
        let before = SYST::get_current();
        let rows = draw(argument);
        let ticks = before.wrapping_sub(SYST::get_current()) & 0x00ff_ffff;
        println!("{name} pixels {} instructions {}", rows * SIZE.width, ticks * 40);
    }
    process::exit(0)
}
