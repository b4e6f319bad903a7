//! The cube in the micro:bit's 16 KiB of RAM, on a Cortex-M0, which has no divide and no long multiply.
//!
//! Prints one line a frame, `frame N rgb565 XXXXXXXX`, through semihosting, and exits after a full turn;
//! with the argument `hold` (QEMU's `-semihosting-config …,arg=microbit,arg=hold`) it never exits.
//!
//! Built for a desktop it prints the lines that the board has to print.

#![cfg_attr(target_os = "none", no_std, no_main)]

#[cfg(all(target_os = "none", not(board = "microbit")))]
compile_error!(
    "`microbit` runs on the microbit board: build it with --bin microbit --target thumbv6m-none-eabi"
);

use core::convert::Infallible;

use fixel_firmware::scene::{BAND_ROWS, FRAMES, MICROBIT, Scene};

/// Pixels that are drawn at a time.
const STRIP: usize = MICROBIT.width as usize * BAND_ROWS;

#[cfg(target_os = "none")]
#[cortex_m_rt::entry]
fn main() -> ! {
    // `entry` hands these out as `&mut`: it runs once.
    static mut PIXELS: [u16; STRIP] = [0; STRIP];
    static mut DEPTH: [u16; STRIP] = [0; STRIP];

    use semihosting::{experimental::env, println, process};

    let arguments = env::args::<64>().expect("the command line fits");
    let hold = (&arguments).into_iter().any(|argument| argument == Ok("hold"));

    let scene = Scene::new(MICROBIT);
    for frame in 0..FRAMES {
        let Ok(rgb565) = scene.frame(frame, PIXELS, DEPTH, |_| Ok::<_, Infallible>(()));
        println!("frame {frame} rgb565 {rgb565:08X}");
    }
    if hold {
        loop {
            cortex_m::asm::wfi();
        }
    }
    process::exit(0)
}

#[cfg(not(target_os = "none"))]
fn main() {
    let (mut pixels, mut depth) = ([0; STRIP], [0; STRIP]);
    let scene = Scene::new(MICROBIT);
    for frame in 0..FRAMES {
        let Ok(rgb565) = scene.frame(frame, &mut pixels, &mut depth, |_| Ok::<_, Infallible>(()));
        println!("frame {frame} rgb565 {rgb565:08X}");
    }
}
