//! The Earth turns on an ST7789 of 240×320 pixels. README.md has the wiring.

#![no_std]
#![no_main]

#[path = "../../pico/src/scene.rs"]
mod scene;

use embedded_hal_bus::spi::ExclusiveDevice;
use esp_hal::clock::CpuClock;
use esp_hal::delay::Delay;
use esp_hal::gpio::{Level, Output, OutputConfig};
use esp_hal::spi::Mode;
use esp_hal::spi::master::{Config, Spi};
use esp_hal::time::Rate;
use fixel::embedded_graphics::{pixelcolor::Rgb565, prelude::*};
use fixel::{Band, BigEndian, Depth16};
use fixel_drivers::Rows;
use mipidsi::{Builder, interface::SpiInterface, models::ST7789, options::ColorInversion};
use panic_halt as _;
use scene::{List, Memory, Scene};
use static_cell::ConstStaticCell;

esp_bootloader_esp_idf::esp_app_desc!();

const BUS: u32 = 40_000_000; // bits a second

const SCREEN: Size = Size::new(240, 320);
const ROWS: u32 = 32; // of a band
const WORDS: usize = (SCREEN.width * ROWS) as usize;
static PIXELS: ConstStaticCell<[u16; WORDS]> = ConstStaticCell::new([0; WORDS]);
static DEPTH: ConstStaticCell<[u16; WORDS]> = ConstStaticCell::new([0; WORDS]);
static MEMORY: ConstStaticCell<Memory> = ConstStaticCell::new(Memory::new());

#[esp_hal::main]
fn main() -> ! {
    let chip = esp_hal::init(esp_hal::Config::default().with_cpu_clock(CpuClock::max())); // 160 MHz

    // SPI 2, with clock on GPIO 6 and data on GPIO 7. Select and data/command on GPIO 10 and GPIO 4.
    let config = Config::default().with_frequency(Rate::from_hz(BUS)).with_mode(Mode::_3);
    let bus = Spi::new(chip.SPI2, config).expect("the clock can be divided so");
    let bus = bus.with_sck(chip.GPIO6).with_mosi(chip.GPIO7);
    let select = Output::new(chip.GPIO10, Level::High, OutputConfig::default());
    let data_command = Output::new(chip.GPIO4, Level::Low, OutputConfig::default());
    let Ok(device) = ExclusiveDevice::new_no_delay(bus, select);

    // mipidsi sets the display up, and gives the bus back.
    let mut buffer = [0; 16];
    let interface = SpiInterface::new(device, data_command, &mut buffer);
    let builder = Builder::new(ST7789, interface).invert_colors(ColorInversion::Inverted);
    let display = builder.init(&mut Delay::new()).expect("the bus takes all bytes");
    let (device, data_command) = display.release().0.release();
    let mut rows = Rows::new(device, data_command);

    let size = Size::new(SCREEN.width, ROWS);
    let band = Band::<BigEndian<Rgb565>, Depth16>::new(size, PIXELS.take(), DEPTH.take());
    let mut band = band.expect("its memory is of its size");
    let (memory, scene) = (MEMORY.take(), Scene::new(SCREEN));
    for frame in (0..=u32::MAX).cycle() {
        let mut list = List::new(memory);
        scene.record(frame, &mut list).expect("it has room for the globe");
        let shown = list.render_bands(SCREEN.height, &scene.sky, &mut band, |area, band| {
            // 2D on top: draw it into `band` here.
            rows.show(area, band.as_bytes())
        });
        shown.expect("the bus takes all bytes");
    }
    unreachable!("there is always another frame")
}
