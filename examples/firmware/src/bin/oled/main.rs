//! The cube on the 128×64 OLED of the LM3S6965EVB board.
//!
//! Prints one line a frame, `frame N rgb565 XXXXXXXX gray4 XXXXXXXX`, through semihosting, and exits
//! after a full turn. An argument (QEMU's `-semihosting-config …,arg=oled,arg=hold`) changes that:
//! `hold` leaves the last frame on the display and never exits, `forever` turns on and prints nothing.
//!
//! Built for a desktop it prints the lines that the board has to print.

#![cfg_attr(target_os = "none", no_std, no_main)]

#[cfg(all(target_os = "none", not(board = "lm3s6965evb")))]
compile_error!("`oled` runs on the lm3s6965evb board: build it with --bin oled --target thumbv7m-none-eabi");

use fixel_firmware::scene::{BAND_ROWS, FRAMES, OLED, Scene};

/// Pixels that are drawn at a time.
const STRIP: usize = OLED.width as usize * BAND_ROWS;

#[cfg(target_os = "none")]
mod lm3s6965;

#[cfg(target_os = "none")]
use fixel_firmware::ssd0323;

#[cfg(target_os = "none")]
#[cortex_m_rt::entry]
fn main() -> ! {
    // `entry` hands these out as `&mut`: it runs once.
    static mut PIXELS: [u16; STRIP] = [0; STRIP];
    static mut DEPTH: [u16; STRIP] = [0; STRIP];
    static mut MEMORY: ssd0323::Memory = ssd0323::BLANK;

    use semihosting::{experimental::env, println, process};

    let arguments = env::args::<64>().expect("the command line fits");
    let (mut hold, mut forever) = (false, false);
    for argument in &arguments {
        hold |= argument == Ok("hold");
        forever |= argument == Ok("forever");
    }

    let (bus, data_command) = lm3s6965::oled();
    let Ok(mut display) = ssd0323::Ssd0323::new(bus, data_command, MEMORY);
    let scene = Scene::new(OLED);
    for frame in 0.. {
        let Ok((rgb565, gray4)) = scene.show(frame, PIXELS, DEPTH, &mut display);
        if forever {
            continue;
        }
        println!("frame {frame} rgb565 {rgb565:08X} gray4 {gray4:08X}");
        if frame + 1 == FRAMES {
            break;
        }
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
    use embedded_graphics::{
        framebuffer::{Framebuffer, buffer_size},
        pixelcolor::{
            Gray4,
            raw::{BigEndian, RawU4},
        },
    };

    let (mut pixels, mut depth) = ([0; STRIP], [0; STRIP]);
    let mut display = Framebuffer::<
        Gray4,
        RawU4,
        BigEndian,
        { OLED.width as usize },
        { OLED.height as usize },
        { buffer_size::<Gray4>(OLED.width as usize, OLED.height as usize) },
    >::new();
    let scene = Scene::new(OLED);
    for frame in 0..FRAMES {
        let Ok((rgb565, gray4)) = scene.show(frame, &mut pixels, &mut depth, &mut display);
        println!("frame {frame} rgb565 {rgb565:08X} gray4 {gray4:08X}");
    }
}
