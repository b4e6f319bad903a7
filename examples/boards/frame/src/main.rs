//! The boards' frames as functions that a counter calls by name, for any core and no board.
//!
//! `frame_list(frame)` records a frame of 240×320 and returns its triangles, `frame_bands(rows)` draws it in bands of so many rows
//! (at most 80), and `frame_driver(rows)` is what mipidsi's `fill_contiguous` takes to make bytes of a frame's colours, without the
//! bus. `frame_oled_list(frame)` and `frame_oled_bands(rows)` are the same for 128×64 pixels of 1 bit, dithered and packed. Functions
//! that draw return the rows that they drew.

#![no_std]
#![no_main]

#[path = "../../pico/src/scene.rs"]
mod scene;

use core::convert::Infallible;
use core::hint::black_box;
use core::ptr::addr_of_mut;

use embedded_hal::digital::{self, OutputPin};
use embedded_hal::spi::{self, Operation, SpiDevice};
use fixel::embedded_graphics::pixelcolor::{BinaryColor, Gray8, Rgb565};
use fixel::embedded_graphics::prelude::*;
use fixel::{Band, BigEndian, Depth16};
use mipidsi::{Builder, interface::SpiInterface, models::ST7789};
use scene::Scene;

const SCREEN: Size = Size::new(240, 320);
const OLED: Size = Size::new(128, 64);
const MOST_ROWS: u32 = 80; // of a band
const WORDS: usize = (SCREEN.width * MOST_ROWS) as usize;

type Rgb = BigEndian<Rgb565>;

static mut PIXELS: [u16; WORDS] = [0; WORDS];
static mut GRAYS: [u8; WORDS] = [0; WORDS];
static mut DEPTH: [u16; WORDS] = [0; WORDS];
static mut MEMORY: scene::Memory = scene::Memory::new();
static mut OLED_MEMORY: scene::Memory = scene::Memory::new();
static mut LIST: Option<scene::List<'static, Rgb>> = None;
static mut OLED_LIST: Option<scene::List<'static, Gray8>> = None;

// SAFETY, of all below: one thread, no interrupts, and no reference outlives a function of this program; but for those that the lists
// have to their memory, which is borrowed once.

#[unsafe(no_mangle)]
extern "C" fn frame_list(frame: u32) -> u32 {
    let list = unsafe { &mut *addr_of_mut!(LIST) };
    let list = list.get_or_insert_with(|| scene::List::new(unsafe { &mut *addr_of_mut!(MEMORY) }));
    list.clear();
    Scene::new(SCREEN).record(frame, list).map_or(0, |()| list.lengths()[1] as u32)
}

#[unsafe(no_mangle)]
extern "C" fn frame_bands(rows: u32) -> u32 {
    let (list, pixels, depth) =
        unsafe { (&mut *addr_of_mut!(LIST), &mut *addr_of_mut!(PIXELS), &mut *addr_of_mut!(DEPTH)) };
    let mut drawn = 0;
    if let (Some(list), Ok(mut band)) =
        (list, Band::<Rgb, Depth16>::new(Size::new(SCREEN.width, rows), pixels, depth))
    {
        let Ok(()) = list.render_bands(SCREEN.height, &Scene::new(SCREEN).sky, &mut band, |area, band| {
            black_box(band.as_bytes());
            drawn += area.size.height;
            Ok::<_, Infallible>(())
        });
    }
    drawn
}

#[unsafe(no_mangle)]
extern "C" fn frame_driver(rows: u32) -> u32 {
    let (pixels, depth) = unsafe { (&mut *addr_of_mut!(PIXELS), &mut *addr_of_mut!(DEPTH)) };
    let mut buffer = [0; 512];
    let builder = Builder::new(ST7789, SpiInterface::new(Nothing, Nothing, &mut buffer));
    let (Ok(mut display), Ok(mut band)) = (
        builder.init(&mut Nothing),
        Band::<Rgb565, Depth16>::new(Size::new(SCREEN.width, rows), pixels, depth),
    ) else {
        return 0;
    };
    let mut sent = 0;
    while sent < SCREEN.height {
        band.move_to(sent);
        let Ok(()) = display.fill_contiguous(&band.bounding_box(), band.colors());
        sent += rows;
    }
    sent
}

#[unsafe(no_mangle)]
extern "C" fn frame_oled_list(frame: u32) -> u32 {
    let list = unsafe { &mut *addr_of_mut!(OLED_LIST) };
    let list = list.get_or_insert_with(|| scene::List::new(unsafe { &mut *addr_of_mut!(OLED_MEMORY) }));
    list.clear();
    Scene::for_black_and_white(OLED).record(frame, list).map_or(0, |()| list.lengths()[1] as u32)
}

#[unsafe(no_mangle)]
extern "C" fn frame_oled_bands(rows: u32) -> u32 {
    let (list, pixels, depth) =
        unsafe { (&mut *addr_of_mut!(OLED_LIST), &mut *addr_of_mut!(GRAYS), &mut *addr_of_mut!(DEPTH)) };
    let mut drawn = 0;
    if let (Some(list), Ok(mut band)) =
        (list, Band::<Gray8, Depth16>::new(Size::new(OLED.width, rows), pixels, depth))
    {
        let Ok(()) =
            list.render_bands(OLED.height, &Scene::for_black_and_white(OLED).sky, &mut band, |area, band| {
                let mut pages = [0; (OLED.width * OLED.height / 8) as usize];
                if let Ok(pages) = band.dithered::<BinaryColor>().pack_pages(&mut pages) {
                    black_box(pages);
                    drawn += area.size.height;
                }
                Ok::<_, Infallible>(())
            });
    }
    drawn
}

/// A bus, a pin and a delay that take no time.
struct Nothing;

impl spi::ErrorType for Nothing {
    type Error = Infallible;
}

impl SpiDevice for Nothing {
    fn transaction(&mut self, operations: &mut [Operation<'_, u8>]) -> Result<(), Infallible> {
        black_box(operations);
        Ok(())
    }
}

impl digital::ErrorType for Nothing {
    type Error = Infallible;
}

impl OutputPin for Nothing {
    fn set_low(&mut self) -> Result<(), Infallible> {
        Ok(())
    }

    fn set_high(&mut self) -> Result<(), Infallible> {
        Ok(())
    }
}

impl embedded_hal::delay::DelayNs for Nothing {
    fn delay_ns(&mut self, _: u32) {}
}

/// What the linker takes for the beginning. Nothing starts by itself.
#[unsafe(no_mangle)]
extern "C" fn _start() -> ! {
    loop {
        core::hint::spin_loop();
    }
}

#[panic_handler]
fn panic(_: &core::panic::PanicInfo<'_>) -> ! {
    loop {
        core::hint::spin_loop();
    }
}
