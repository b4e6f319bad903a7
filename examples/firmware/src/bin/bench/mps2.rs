//! Counts the scenes by SysTick on an MPS2 board that QEMU emulates with `-icount shift=0` (to 40 instructions: 25 MHz of
//! 1 GHz), and prints one line a scene.

use crate::{
    deep::{bench_clear, bench_covered},
    scenes::SCENES,
};
use cortex_m::peripheral::{Peripherals, SYST, syst::SystClkSource};
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
    for (name, scene) in SCENES {
        // Through a pointer that the compiler does not see through: the function stays.
        core::hint::black_box(bench_clear as extern "C" fn())();
        let before = SYST::get_current();
        let promised = scene(0);
        let ticks = before.wrapping_sub(SYST::get_current()) & 0x00ff_ffff;
        let covered = bench_covered();
        assert_eq!(covered, promised, "pixels of {name}");
        println!("{name} pixels {covered} instructions {}", ticks * 40);
    }
    process::exit(0)
}
