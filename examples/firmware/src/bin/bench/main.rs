//! The scenes by which speed is judged, each an exported function `bench_NAME(frame) -> covered pixels` that any
//! counter of instructions can call, with `bench_clear()` before it.
//!
//! Run on an MPS2 board in QEMU with `-icount shift=0` it prints one line a scene with its instructions, counted by SysTick
//! (to 40 instructions: 25 MHz of 1 GHz).

#![cfg_attr(target_os = "none", no_std, no_main)]

#[cfg(target_os = "none")]
#[expect(unsafe_code, reason = "exported symbols, and frames that are too large for a stack")]
#[expect(unreachable_pub, reason = "reached from outside the program")]
mod board {
    use core::ptr::addr_of_mut;
    use cortex_m::peripheral::{Peripherals, SYST, syst::SystClkSource};
    use fixel::{Band, Turn};
    use fixel_firmware::bench::{self, Deep, Flat, PIXELS, SIZE};
    use semihosting::{println, process};

    /// What is drawn into, for a debugger or an emulator to read.
    #[unsafe(no_mangle)]
    pub static mut FRAMEBUFFER: [u16; PIXELS] = [0; PIXELS];
    static mut DEPTH: [u16; PIXELS] = [0; PIXELS];
    static mut NO_DEPTH: [(); PIXELS] = [(); PIXELS];

    fn with_flat(draw: impl FnOnce(&mut Flat<'_>)) {
        // SAFETY: one thread, no interrupts, and no reference outlives a scene.
        let (pixels, depth) = unsafe { (&mut *addr_of_mut!(FRAMEBUFFER), &mut *addr_of_mut!(NO_DEPTH)) };
        if let Ok(mut frame) = Band::new(SIZE, pixels, depth) {
            draw(&mut frame);
        }
    }

    fn with_deep(draw: impl FnOnce(&mut Deep<'_>)) {
        // SAFETY: as in `with_flat`.
        let (pixels, depth) = unsafe { (&mut *addr_of_mut!(FRAMEBUFFER), &mut *addr_of_mut!(DEPTH)) };
        if let Ok(mut frame) = Band::new(SIZE, pixels, depth) {
            draw(&mut frame);
        }
    }

    /// Colour and depth as before a frame.
    #[unsafe(no_mangle)]
    pub extern "C" fn bench_clear() {
        // SAFETY: as in `with_flat`.
        let (pixels, depth) = unsafe { (&mut *addr_of_mut!(FRAMEBUFFER), &mut *addr_of_mut!(DEPTH)) };
        pixels.fill(0);
        depth.fill(0);
    }

    macro_rules! scenes {
        ($($name:literal $function:ident $covered:ident $target:ident $draw:expr;)*) => {
            $(
                #[doc = concat!("Draws ", $name, "; returns how many pixels it covers.")]
                #[unsafe(no_mangle)]
                pub extern "C" fn $function(_frame: u32) -> u32 {
                    $target($draw);
                    bench::$covered
                }
            )*
            const SCENES: &[(&str, extern "C" fn(u32) -> u32)] = &[$(($name, $function)),*];
        };
    }

    scenes! {
        "s1" bench_s1 S1_PIXELS with_flat |frame| bench::s1(Turn::ZERO, frame);
        "s1_roll30" bench_s1_roll30 S1_ROLL30_PIXELS with_flat |frame| bench::s1(Turn::from_degrees(30), frame);
        "s1_roll90" bench_s1_roll90 S1_ROLL90_PIXELS with_flat |frame| bench::s1(Turn::from_degrees(90), frame);
        "s1_ground" bench_s1_ground S1_GROUND_PIXELS with_flat |frame| bench::s1_ground(frame);
        "s2" bench_s2 S2_PIXELS with_deep |frame| bench::s2(frame);
        "s3" bench_s3 S3_PIXELS with_deep |frame| bench::s3(frame);
        "s3_tex" bench_s3_tex S3_PIXELS with_deep |frame| bench::s3_tex(frame);
    }

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
            let covered = scene(0);
            let ticks = before.wrapping_sub(SYST::get_current()) & 0x00ff_ffff;
            println!("{name} pixels {covered} instructions {}", ticks * 40);
        }
        process::exit(0)
    }
}

#[cfg(not(target_os = "none"))]
fn main() {
    println!("bench counts instructions on an MPS2 board; see README.md");
}
