//! The cube on a picture of 128×128, twice as large as the micro:bit's 16 KiB of RAM: from a list, in bands. On a
//! Cortex-M0, which has no divide and no long multiply.
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

use embedded_graphics::prelude::*;
use fixel_firmware::scene::{BAND_ROWS, FRAMES, List, MICROBIT, Memory, Scene, Strip};

/// What is drawn at a time.
const STRIP: Size = Size::new(MICROBIT.width, BAND_ROWS as u32);
const PIXELS: usize = MICROBIT.width as usize * BAND_ROWS;

#[cfg(target_os = "none")]
#[cortex_m_rt::entry]
fn main() -> ! {
    // `entry` hands these out as `&mut`: it runs once.
    static mut COLORS: [u16; PIXELS] = [0; PIXELS];
    static mut DEPTH: [u16; PIXELS] = [0; PIXELS];
    static mut MEMORY: Memory = Memory::new();

    use semihosting::{experimental::env, println, process};

    let arguments = env::args::<64>().expect("the command line fits");
    let hold = (&arguments).into_iter().any(|argument| argument == Ok("hold"));

    let scene = Scene::new(MICROBIT);
    let mut list = List::new(MEMORY);
    let mut strip = Strip::new(STRIP, COLORS, DEPTH).expect("the buffers hold it");
    for frame in 0..FRAMES {
        let rgb565 = scene.listed(frame, &mut list, &mut strip).expect("the list holds the scene");
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
    let (mut pixels, mut depth) = ([0; PIXELS], [0; PIXELS]);
    let mut memory = Memory::new();
    let mut list = List::new(&mut memory);
    let scene = Scene::new(MICROBIT);
    let mut strip = Strip::new(STRIP, &mut pixels, &mut depth).expect("the buffers hold it");
    for frame in 0..FRAMES {
        let rgb565 = scene.listed(frame, &mut list, &mut strip).expect("the list holds the scene");
        println!("frame {frame} rgb565 {rgb565:08X}");
    }
}
