//! The Earth turns on an ST7789 of 240×320 pixels, while other tasks run: a band is drawn while a DMA channel sends the one before.

#![no_std]
#![no_main]

#[path = "../../pico/src/scene.rs"]
mod scene;

use embassy_executor::Spawner;
use embassy_rp::gpio::{Level, Output};
use embassy_rp::peripherals::DMA_CH0;
use embassy_rp::spi::{self, Phase, Polarity, Spi};
use embassy_rp::{bind_interrupts, dma};
use embassy_time::{Delay, Timer};
use embedded_hal_bus::spi::ExclusiveDevice;
use fixel::BigEndian;
use fixel::embedded_graphics::{pixelcolor::Rgb565, prelude::*};
use fixel_drivers::{AsyncRows, Memory};
use lcd_async::{Builder, interface::SpiInterface, models::ST7789, options::ColorInversion};
use panic_halt as _;
use scene::{List, Scene};
use static_cell::ConstStaticCell;

const BUS: u32 = 62_500_000; // bits a second, half of the chip's clock: take less for long wires

const SCREEN: Size = Size::new(240, 320);
const ROWS: u32 = 32; // of a band
const WORDS: usize = (SCREEN.width * ROWS) as usize;
static PIXELS: [ConstStaticCell<[u16; WORDS]>; 2] = [const { ConstStaticCell::new([0; WORDS]) }; 2];
static DEPTH: ConstStaticCell<[u16; WORDS]> = ConstStaticCell::new([0; WORDS]);
static MEMORY: ConstStaticCell<scene::Memory> = ConstStaticCell::new(scene::Memory::new());

bind_interrupts!(struct Interrupts {
    DMA_IRQ_0 => dma::InterruptHandler<DMA_CH0>;
});

/// Another task: it runs between two bands.
#[embassy_executor::task]
async fn blink(mut light: Output<'static>) {
    loop {
        light.toggle();
        Timer::after_millis(500).await;
    }
}

#[embassy_executor::main]
async fn main(spawner: Spawner) {
    let chip = embassy_rp::init(embassy_rp::config::Config::default());
    spawner.spawn(blink(Output::new(chip.PIN_25, Level::Low)).expect("it is spawned once"));

    // SPI 0, with clock on GP18 and data on GP19. Select and data/command on GP17 and GP16.
    let mut config = spi::Config::default();
    config.frequency = BUS;
    config.polarity = Polarity::IdleHigh;
    config.phase = Phase::CaptureOnSecondTransition;
    let bus = Spi::new_txonly(chip.SPI0, chip.PIN_18, chip.PIN_19, chip.DMA_CH0, Interrupts, config);
    let Ok(device) = ExclusiveDevice::new_no_delay(bus, Output::new(chip.PIN_17, Level::High));
    let interface = SpiInterface::new(device, Output::new(chip.PIN_16, Level::Low));

    // lcd-async sets the display up, and gives the bus back.
    let builder = Builder::new(ST7789, interface).invert_colors(ColorInversion::Inverted);
    let display = builder.init(&mut Delay).await.expect("the bus takes all bytes");
    let (device, data_command) = display.release().0.release();
    let mut rows = AsyncRows::new(device, data_command);

    let pixels = PIXELS.each_ref().map(|pixels| pixels.take().as_mut_slice());
    let mut bands = Memory { size: Size::new(SCREEN.width, ROWS), pixels, depth: DEPTH.take() };
    let (memory, scene) = (MEMORY.take(), Scene::new(SCREEN));
    for frame in (0..=u32::MAX).cycle() {
        let mut list = List::<BigEndian<Rgb565>>::new(memory);
        scene.record(frame, &mut list).expect("it has room for the globe");
        let shown = rows.frame(&list, SCREEN.height, &scene.sky, &mut bands, |_band| {
            // 2D on top: draw it into the band here.
        });
        shown.await.expect("the bus takes all bytes");
    }
}
