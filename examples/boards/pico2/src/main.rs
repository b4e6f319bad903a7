//! The Earth turns on an ST7789 of 240×320 pixels: one core draws a band while a DMA channel sends the one before.

#![no_std]
#![no_main]

#[path = "../../pico/src/scene.rs"]
mod scene;

use core::convert::Infallible;

use embedded_hal::digital::OutputPin;
use embedded_hal::spi::{MODE_3, SpiBus};
use embedded_hal_bus::spi::{ExclusiveDevice, NoDelay};
use fixel::embedded_graphics::{pixelcolor::Rgb565, prelude::*, primitives::Rectangle};
use fixel::{Band, BigEndian, Depth16};
use fixel_drivers::Rows;
use mipidsi::{Builder, interface::SpiInterface, models::ST7789, options::ColorInversion};
use panic_halt as _;
use rp235x_hal::block::ImageDef;
use rp235x_hal::dma::single_buffer::{Config, Transfer};
use rp235x_hal::dma::{CH0, Channel, DMAExt};
use rp235x_hal::fugit::RateExtU32;
use rp235x_hal::gpio::bank0::{Gpio17, Gpio18, Gpio19};
use rp235x_hal::gpio::{FunctionSio, FunctionSpi, Pin, Pins, PullDown, SioOutput};
use rp235x_hal::pac::{self, SPI0};
use rp235x_hal::spi::Enabled;
use rp235x_hal::{Clock, Sio, Spi, Timer, Watchdog, clocks};
use scene::{List, Memory, Scene};
use static_cell::ConstStaticCell;

const CRYSTAL: u32 = 12_000_000; // hertz, on a Pico 2
/// Bits a second: a quarter of the chip's clock. Half of it, 75 MHz, is more than the ST7789's data sheet allows (62.5), though
/// many take it.
const BUS: u32 = 37_500_000;

const SCREEN: Size = Size::new(240, 320);
const ROWS: u32 = 32; // of a band
const WORDS: usize = (SCREEN.width * ROWS) as usize;
static PIXELS: [ConstStaticCell<[u16; WORDS]>; 2] = [const { ConstStaticCell::new([0; WORDS]) }; 2];
static DEPTH: ConstStaticCell<[u16; WORDS]> = ConstStaticCell::new([0; WORDS]);
static MEMORY: ConstStaticCell<Memory> = ConstStaticCell::new(Memory::new());

/// What the ROM looks for.
#[unsafe(link_section = ".start_block")]
#[used]
static IMAGE: ImageDef = ImageDef::secure_exe();

type Select = Pin<Gpio17, FunctionSio<SioOutput>, PullDown>;
type Wires = (Pin<Gpio19, FunctionSpi, PullDown>, Pin<Gpio18, FunctionSpi, PullDown>);
type Bus = Spi<Enabled, SPI0, Wires, 8>;

/// The bus, the channel that sends, and the pixels that nobody draws into.
enum Line {
    Idle(Channel<CH0>, Bus, &'static mut [u16]),
    Sends(Transfer<Channel<CH0>, &'static mut [u8], Bus>),
}

impl Line {
    /// What it consists of, when all is sent.
    fn wait(self) -> (Channel<CH0>, Bus, &'static mut [u16]) {
        match self {
            Self::Idle(channel, bus, pixels) => (channel, bus, pixels),
            Self::Sends(transfer) => {
                let (channel, bytes, bus) = transfer.wait();
                (channel, bus, bytemuck::cast_slice_mut(bytes))
            }
        }
    }
}

/// The display on its bus, for a driver or for [`Rows`].
fn device<'a>(
    bus: &'a mut Bus,
    select: &'a mut Select,
) -> ExclusiveDevice<&'a mut Bus, &'a mut Select, NoDelay> {
    let Ok(device) = ExclusiveDevice::new_no_delay(bus, select);
    device
}

#[rp235x_hal::entry]
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
    let mut timer = Timer::new_timer0(chip.TIMER0, &mut chip.RESETS, &clocks);
    let sio = Sio::new(chip.SIO);
    let pins = Pins::new(chip.IO_BANK0, chip.PADS_BANK0, sio.gpio_bank0, &mut chip.RESETS);

    // SPI 0, with clock on GP18 and data on GP19. Select and data/command on GP17 and GP16.
    let wires = (pins.gpio19.into_function(), pins.gpio18.into_function());
    let bus = Spi::<_, _, _, 8>::new(chip.SPI0, wires);
    let mut bus = bus.init(&mut chip.RESETS, clocks.peripheral_clock.freq(), BUS.Hz(), MODE_3);
    let mut select = pins.gpio17.into_push_pull_output().into_pull_type();
    let mut data_command = pins.gpio16.into_push_pull_output();

    // mipidsi sets the display up. Then its bus is the DMA channel's.
    let mut buffer = [0; 16];
    let interface = SpiInterface::new(device(&mut bus, &mut select), &mut data_command, &mut buffer);
    let builder = Builder::new(ST7789, interface).invert_colors(ColorInversion::Inverted);
    builder.init(&mut timer).expect("the bus takes all bytes");

    let [pixels, spare] = PIXELS.each_ref().map(|pixels| pixels.take().as_mut_slice());
    let band = Band::<BigEndian<Rgb565>, Depth16>::new(Size::new(SCREEN.width, ROWS), pixels, DEPTH.take());
    let mut band = band.expect("its memory is of its size");
    let (memory, scene) = (MEMORY.take(), Scene::new(SCREEN));
    let mut line = Line::Idle(chip.DMA.split(&mut chip.RESETS).ch0, bus, spare);
    for frame in (0..=u32::MAX).cycle() {
        let mut list = List::new(memory);
        scene.record(frame, &mut list).expect("it has room for the globe");
        let mut next = Some(line);
        let Ok(()) = list.render_bands(SCREEN.height, &scene.sky, &mut band, |area, band| {
            // 2D on top: draw it into `band` here.
            next = next.take().map(|line| {
                let (channel, mut bus, mut pixels) = line.wait();
                if area.top_left == Point::zero() {
                    // The window is the whole screen: its bands follow each other, with the display selected.
                    let Ok(()) = bus.flush(); // the channel is done before the last bits are out
                    let mut rows = Rows::new(device(&mut bus, &mut select), &mut data_command);
                    rows.open(Rectangle::new(area.top_left, SCREEN)).expect("the bus takes all bytes");
                    let Ok(()) = select.set_low();
                }
                // The channel has what was drawn, and the band what was sent before.
                band.swap_pixels(&mut pixels).expect("both are of one size");
                Line::Sends(Config::new(channel, bytemuck::cast_slice_mut(pixels), bus).start())
            });
            Ok::<_, Infallible>(())
        });
        line = next.expect("it is put back");
    }
    unreachable!("there is always another frame")
}
