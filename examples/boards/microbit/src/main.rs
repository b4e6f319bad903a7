//! The Earth turns on an SSD1306, an OLED of 128×64 pixels of 1 bit, in dots that stand still. README.md has the wiring.

#![no_std]
#![no_main]

#[path = "../../pico/src/scene.rs"]
mod scene;

use fixel::embedded_graphics::pixelcolor::{BinaryColor, Gray8};
use fixel::embedded_graphics::prelude::*;
use fixel::{Band, Depth16};
use nrf52833_hal::twim::{Frequency, Pins, Twim};
use nrf52833_hal::{Clocks, gpio, pac};
use panic_halt as _;
use scene::{List, Memory, Scene};
use ssd1306::prelude::*;
use ssd1306::{I2CDisplayInterface, Ssd1306};
use static_cell::ConstStaticCell;

const SCREEN: Size = Size::new(128, 64);
const ROWS: u32 = 16; // of a band, two of the display's pages of 8
const PIXELS_OF_BAND: usize = (SCREEN.width * ROWS) as usize;
static PIXELS: ConstStaticCell<[u8; PIXELS_OF_BAND]> = ConstStaticCell::new([0; PIXELS_OF_BAND]);
static DEPTH: ConstStaticCell<[u16; PIXELS_OF_BAND]> = ConstStaticCell::new([0; PIXELS_OF_BAND]);
static MEMORY: ConstStaticCell<Memory> = ConstStaticCell::new(Memory::new());

#[cortex_m_rt::entry]
fn main() -> ! {
    let chip = pac::Peripherals::take().expect("main is called once");
    Clocks::new(chip.CLOCK).enable_ext_hfosc();

    // The external I²C bus, on the edge connector: clock on pin 19, data on pin 20.
    let port0 = gpio::p0::Parts::new(chip.P0);
    let port1 = gpio::p1::Parts::new(chip.P1);
    let wires = Pins {
        scl: port0.p0_26.into_floating_input().degrade(),
        sda: port1.p1_00.into_floating_input().degrade(),
    };
    let bus = Twim::new(chip.TWIM0, wires, Frequency::K400);
    let interface = I2CDisplayInterface::new(bus);
    let mut display = Ssd1306::new(interface, DisplaySize128x64, DisplayRotation::Rotate0);
    display.init_with_addr_mode(ssd1306::command::AddrMode::Horizontal).expect("the display answers");
    // The window is the whole screen, set once: its bands follow each other, and after its last byte comes its first.
    display.set_draw_area((0, 0), (128, 64)).expect("the display answers");

    let size = Size::new(SCREEN.width, ROWS);
    let band = Band::<Gray8, Depth16>::new(size, PIXELS.take(), DEPTH.take());
    let mut band = band.expect("its memory is of its size");
    let (memory, scene) = (MEMORY.take(), Scene::for_black_and_white(SCREEN));
    for frame in (0..=u32::MAX).cycle() {
        let mut list = List::new(memory);
        scene.record(frame, &mut list).expect("it has room for the globe");
        let shown = list.render_bands(SCREEN.height, &scene.sky, &mut band, |_, band| {
            let mut pages = [0; PIXELS_OF_BAND / 8];
            let pages = band.dithered::<BinaryColor>().pack_pages(&mut pages);
            display.draw(pages.expect("bands are of whole pages"))
        });
        shown.expect("the display answers");
    }
    unreachable!("there is always another frame")
}
