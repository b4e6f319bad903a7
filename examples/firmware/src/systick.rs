//! SysTick as a counter of instructions, on a board that QEMU emulates with `-icount shift=0`: to 40 of them, 25 MHz of 1 GHz.
//! A part of the programs that count, not of the library.

use cortex_m::peripheral::{Peripherals, SYST, syst::SystClkSource};

/// Starts it.
pub(crate) fn start() {
    if let Some(mut peripherals) = Peripherals::take() {
        let syst = &mut peripherals.SYST;
        syst.set_clock_source(SystClkSource::Core);
        syst.set_reload(0x00ff_ffff);
        syst.clear_current();
        syst.enable_counter();
    }
}

/// What a function returns, and its instructions.
#[inline(always)]
pub(crate) fn count(work: impl FnOnce() -> u32) -> (u32, u32) {
    let before = SYST::get_current();
    let result = work();
    let ticks = before.wrapping_sub(SYST::get_current()) & 0x00ff_ffff;
    (result, ticks * 40)
}
