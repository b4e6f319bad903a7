//! fixel on both cores of an RP2040: the Earth turns on an ST7789 of 240×320 pixels.
//!
//! Core 0 records each frame as a display list. Then both cores render its bands, core 0 the even ones and core 1 the odd ones,
//! while a DMA channel sends those that are drawn. See README.md for the wiring.

#![no_std]
#![no_main]

mod bus;
mod frames;
#[path = "../../pico/src/scene.rs"]
mod scene;

use core::sync::atomic::{AtomicU32, Ordering};

use embedded_hal::spi::MODE_0;
use fixel::embedded_graphics::prelude::*;
use fixel::{Band, Depth16};
use panic_halt as _;
use rp2040_hal::clocks::{Clock, init_clocks_and_plls};
use rp2040_hal::dma::DMAExt;
use rp2040_hal::fugit::RateExtU32;
use rp2040_hal::gpio::Pins;
use rp2040_hal::multicore::{Multicore, Stack};
use rp2040_hal::{Sio, Spi, Timer, Watchdog, pac};
use static_cell::ConstStaticCell;

use frames::{Format, SCREEN};
use scene::Scene;

const CORES: usize = 2;
/// Rows of a band.
const ROWS: usize = 16;
const BANDS: usize = SCREEN.height as usize / ROWS;
/// Pixels of a band.
const WORDS: usize = SCREEN.width as usize * ROWS;

// All of one height: bands are sent whole.
const _: () = assert!(SCREEN.height as usize == BANDS * ROWS);

/// Hertz of the crystal on a Pico.
const CRYSTAL: u32 = 12_000_000;
/// Bits a second on the display's bus: half of the chip's clock of 125 MHz.
const BUS: u32 = 62_500_000;

/// The second-stage boot loader for the Pico's flash, W25Q080.
#[expect(unsafe_code, reason = "the ROM looks for it in a section of its own")]
// SAFETY: The section takes nothing else.
#[unsafe(link_section = ".boot2")]
#[used]
static BOOT2: [u8; 256] = rp2040_boot2::BOOT_LOADER_W25Q080;

/// Two bands for each core.
static PIXELS: [ConstStaticCell<[u16; WORDS]>; 2 * CORES] =
    [const { ConstStaticCell::new([0; WORDS]) }; 2 * CORES];
/// The depth of what a core draws.
static DEPTH: [ConstStaticCell<[u16; WORDS]>; CORES] = [const { ConstStaticCell::new([0; WORDS]) }; CORES];

/// Rendering takes up to 1.5 KiB of it.
static CORE1_STACK: Stack<1024> = Stack::new();

/// How many frames are recorded.
static RECORDED: AtomicU32 = AtomicU32::new(0);
/// How many frames core 1 has drawn its bands of.
static DRAWN: AtomicU32 = AtomicU32::new(0);

/// Waits until a counter shows this number; whoever counts wakes the other core.
fn wait_for(counter: &AtomicU32, number: u32) {
    while counter.load(Ordering::Acquire) != number {
        cortex_m::asm::wfe();
    }
}

/// Counts to this number.
fn report(counter: &AtomicU32, number: u32) {
    counter.store(number, Ordering::Release);
    cortex_m::asm::sev();
}

/// What a core draws with.
struct Painter {
    core: usize,
    band: Band<'static, Format, Depth16>,
    scene: Scene,
}

impl Painter {
    fn new(core: usize) -> Self {
        let size = Size::new(SCREEN.width, ROWS as u32);
        let band =
            Band::new(size, PIXELS[core].take(), DEPTH[core].take()).expect("the memory is of this size");
        Self { core, band, scene: Scene::new(SCREEN) }
    }

    /// Draws this core's bands of the frame, one while the one before is sent.
    fn frame(&mut self) {
        let list = frames::list().read();
        for number in (self.core..BANDS).step_by(CORES) {
            let top = (number * ROWS) as u32;
            self.band.move_to(top);
            self.band.clear_to(&self.scene.sky);
            list.render(top, &mut self.band);
            let mut pixels = bus::free(self.core);
            self.band.swap_pixels(&mut pixels).expect("all bands are of one size");
            bus::send(self.core, pixels);
        }
    }
}

/// Core 1 draws its half of whatever is recorded.
fn core1() {
    let mut painter = Painter::new(1);
    for frame in (1..=u32::MAX).cycle() {
        wait_for(&RECORDED, frame);
        painter.frame();
        report(&DRAWN, frame);
    }
}

#[rp2040_hal::entry]
fn main() -> ! {
    let mut chip = pac::Peripherals::take().expect("main is called once");
    let mut watchdog = Watchdog::new(chip.WATCHDOG);
    let Ok(clocks) = init_clocks_and_plls(
        CRYSTAL,
        chip.XOSC,
        chip.CLOCKS,
        chip.PLL_SYS,
        chip.PLL_USB,
        &mut chip.RESETS,
        &mut watchdog,
    ) else {
        panic!("the Pico's crystal is of 12 MHz");
    };
    let mut sio = Sio::new(chip.SIO);
    let pins = Pins::new(chip.IO_BANK0, chip.PADS_BANK0, sio.gpio_bank0, &mut chip.RESETS);
    let mut delay = Timer::new(chip.TIMER, &mut chip.RESETS, &clocks);

    let lines = (pins.gpio19.into_function(), pins.gpio18.into_function());
    let wire =
        Spi::new(chip.SPI0, lines).init(&mut chip.RESETS, clocks.peripheral_clock.freq(), BUS.Hz(), MODE_0);
    let data_command = pins.gpio16.into_push_pull_output();
    let select = pins.gpio17.into_push_pull_output();
    let channel = chip.DMA.split(&mut chip.RESETS).ch0;
    let spare = [2, 3].map(|i| PIXELS[i].take().as_mut_slice());
    bus::start(channel, wire, (data_command, select), &mut delay, spare);
    #[expect(unsafe_code, reason = "unmasking an interrupt is")]
    // SAFETY: Nothing here relies on the interrupt being masked: what its handler shares is behind a critical section.
    unsafe {
        cortex_m::peripheral::NVIC::unmask(pac::Interrupt::DMA_IRQ_0);
    }

    let mut multicore = Multicore::new(&mut chip.PSM, &mut chip.PPB, &mut sio.fifo);
    let [_, other] = multicore.cores() else {
        panic!("there are two cores");
    };
    let stack = CORE1_STACK.take().expect("it is taken once");
    other.spawn(stack, core1).expect("core 1 starts");

    let mut painter = Painter::new(0);
    for frame in (1..=u32::MAX).cycle() {
        // Core 1 waits: nobody reads the list.
        let mut list = frames::list().write();
        list.clear();
        painter.scene.record(frame, &mut list).expect("it has room for the globe");
        drop(list);
        report(&RECORDED, frame);
        painter.frame();
        wait_for(&DRAWN, frame);
    }
    unreachable!("there is always another frame")
}
