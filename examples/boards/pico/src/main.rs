//! The Earth turns on an ST7789 of 240×320 pixels. README.md has the wiring; `scene.rs` is what is drawn.

#![no_std]
#![no_main]

mod bus;
mod scene;

use bus::Busy;
use embedded_hal_bus::spi::ExclusiveDevice;
use fixel::embedded_graphics::{pixelcolor::Rgb565, prelude::*};
use fixel::{Band, Depth16};
use mipidsi::{Builder, interface::SpiInterface, models::ST7789, options::ColorInversion};
use panic_halt as _;
use rp2040_hal::fugit::RateExtU32;
use rp2040_hal::{Clock, Sio, Spi, Timer, Watchdog, clocks, gpio::Pins, pac};
use scene::{List, Memory, Scene};
use static_cell::ConstStaticCell;

const CRYSTAL: u32 = 12_000_000; // hertz, on a Pico
const BUS: u32 = 62_500_000; // bits a second, half of the chip's clock: take less for long wires

const SCREEN: Size = Size::new(240, 320);
const ROWS: u32 = 32; // of a band
const WORDS: usize = (SCREEN.width * ROWS) as usize;
static PIXELS: ConstStaticCell<[u16; WORDS]> = ConstStaticCell::new([0; WORDS]);
static DEPTH: ConstStaticCell<[u16; WORDS]> = ConstStaticCell::new([0; WORDS]);
static MEMORY: ConstStaticCell<Memory> = ConstStaticCell::new(Memory::new());

/// The second stage of the boot loader, for the flash on a Pico.
#[unsafe(link_section = ".boot2")]
#[used]
static BOOT2: [u8; 256] = rp2040_boot2::BOOT_LOADER_W25Q080;

#[rp2040_hal::entry]
fn main() -> ! {
    let mut chip = pac::Peripherals::take().expect("main is called once");
    let mut watchdog = Watchdog::new(chip.WATCHDOG);
    let (xosc, plls) = (chip.XOSC, (chip.PLL_SYS, chip.PLL_USB));
    let clocks = clocks::init_clocks_and_plls(
        CRYSTAL,
        xosc,
        chip.CLOCKS,
        plls.0,
        plls.1,
        &mut chip.RESETS,
        &mut watchdog,
    );
    let clocks = clocks.expect("the crystal is of 12 MHz");
    let mut timer = Timer::new(chip.TIMER, &mut chip.RESETS, &clocks);
    let sio = Sio::new(chip.SIO);
    let pins = Pins::new(chip.IO_BANK0, chip.PADS_BANK0, sio.gpio_bank0, &mut chip.RESETS);

    // The bus: SPI 0, with clock on GP18 and data on GP19. Select and data/command on GP17 and GP16.
    let wires = (pins.gpio19.into_function(), pins.gpio18.into_function());
    let bus = Spi::<_, _, _, 8>::new(chip.SPI0, wires);
    let mode = embedded_hal::spi::MODE_3;
    let bus = bus.init(&mut chip.RESETS, clocks.peripheral_clock.freq(), BUS.Hz(), mode);
    let Ok(device) = ExclusiveDevice::new_no_delay(Busy(bus), pins.gpio17.into_push_pull_output());
    let mut buffer = [0; 512];
    let interface = SpiInterface::new(device, pins.gpio16.into_push_pull_output(), &mut buffer);

    let builder = Builder::new(ST7789, interface).invert_colors(ColorInversion::Inverted);
    let mut display = builder.init(&mut timer).expect("the bus takes all bytes");

    let size = Size::new(SCREEN.width, ROWS);
    let band = Band::<Rgb565, Depth16>::new(size, PIXELS.take(), DEPTH.take());
    let mut band = band.expect("its memory is of its size");
    let (memory, scene) = (MEMORY.take(), Scene::new(SCREEN));
    for frame in (0..=u32::MAX).cycle() {
        let mut list = List::new(memory);
        scene.record(frame, &mut list).expect("it has room for the globe");
        let shown = list.render_bands(SCREEN.height, &scene.sky, &mut band, |area, band| {
            // 2D on top: draw it into `band` here.
            display.fill_contiguous(&area, band.colors())
        });
        shown.expect("the bus takes all bytes");
    }
    unreachable!("there is always another frame")
}
