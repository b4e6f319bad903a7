//! Bands on their way to the display: a DMA channel sends one after the other, as they are drawn, and their memory comes back.
//!
//! Each core has two bands' worth of pixels: one that it draws, one that waits or is sent. The memory is owned by whoever works on
//! it, as `&'static mut`, so that nobody can draw what the channel still reads.

use core::cell::RefCell;

use critical_section::Mutex;
use embedded_hal::delay::DelayNs;
use embedded_hal::digital::OutputPin;
use embedded_hal::spi::SpiBus;
use embedded_hal_bus::spi::{ExclusiveDevice, NoDelay};
use fixel::embedded_graphics::{prelude::*, primitives::Rectangle};
use fixel_drivers::Rows;
use heapless::Deque;
use mipidsi::{Builder, interface::SpiInterface, models::ST7789, options::ColorInversion};
use rp2040_hal::dma::single_buffer::{Config, Transfer};
use rp2040_hal::dma::{CH0, Channel, SingleChannel};
use rp2040_hal::gpio::bank0::{Gpio16, Gpio17, Gpio18, Gpio19};
use rp2040_hal::gpio::{FunctionSio, FunctionSpi, Pin, PullDown, SioOutput};
use rp2040_hal::pac::{SPI0, interrupt};
use rp2040_hal::spi::{Enabled, Spi};

use crate::frames::SCREEN;
use crate::{BANDS, CORES};

/// The pixels of a band.
pub(crate) type Pixels = &'static mut [u16];

/// Data out and clock.
type Lines = (Pin<Gpio19, FunctionSpi, PullDown>, Pin<Gpio18, FunctionSpi, PullDown>);
pub(crate) type Wire = Spi<Enabled, SPI0, Lines, 8>;
pub(crate) type DataCommand = Pin<Gpio16, FunctionSio<SioOutput>, PullDown>;
pub(crate) type Select = Pin<Gpio17, FunctionSio<SioOutput>, PullDown>;

/// What the channel does.
enum State {
    Idle(Channel<CH0>, Wire),
    /// Sends a band that a core drew.
    Sends(Transfer<Channel<CH0>, &'static mut [u8], Wire>, usize),
}

struct Bus {
    /// Always there between two calls.
    state: Option<State>,
    data_command: DataCommand,
    select: Select,
    /// The band of the frame that is sent next.
    next: usize,
    /// For each core what it has drawn, in order.
    drawn: [Deque<Pixels, 2>; CORES],
    /// For each core what it can draw into.
    free: [Deque<Pixels, 2>; CORES],
}

static BUS: Mutex<RefCell<Option<Bus>>> = Mutex::new(RefCell::new(None));

/// Both cores and the interrupt take turns.
fn with_bus<R>(work: impl FnOnce(&mut Bus) -> R) -> Option<R> {
    critical_section::with(|section| BUS.borrow_ref_mut(section).as_mut().map(work))
}

/// The display on its bus, for a driver or for [`Rows`].
fn device<'a>(
    wire: &'a mut Wire,
    select: &'a mut Select,
) -> ExclusiveDevice<&'a mut Wire, &'a mut Select, NoDelay> {
    let Ok(device) = ExclusiveDevice::new_no_delay(wire, select);
    device
}

/// Sets up the display and takes charge of it, with memory for a second band of each core.
///
/// The core that calls this has to unmask `DMA_IRQ_0`.
pub(crate) fn start(
    mut channel: Channel<CH0>,
    mut wire: Wire,
    (mut data_command, mut select): (DataCommand, Select),
    delay: &mut impl DelayNs,
    spare: [Pixels; CORES],
) {
    let mut buffer = [0; 16];
    let interface = SpiInterface::new(device(&mut wire, &mut select), &mut data_command, &mut buffer);
    let builder = Builder::new(ST7789, interface).invert_colors(ColorInversion::Inverted);
    builder.init(delay).expect("the bus takes all bytes");
    channel.enable_irq0();
    let mut free = [const { Deque::new() }; CORES];
    for (free, pixels) in free.iter_mut().zip(spare) {
        let _ = free.push_back(pixels); // it is empty
    }
    let state = Some(State::Idle(channel, wire));
    let bus = Bus { state, data_command, select, next: 0, drawn: [const { Deque::new() }; CORES], free };
    critical_section::with(|section| BUS.replace(section, Some(bus)));
}

/// Memory for a core to draw its next band into: waits until one of its bands is sent.
pub(crate) fn free(core: usize) -> Pixels {
    loop {
        if let Some(Some(pixels)) = with_bus(|bus| bus.free[core].pop_front()) {
            return pixels;
        }
        // Woken by `Bus::proceed`; if that was in between, at once.
        cortex_m::asm::wfe();
    }
}

/// Sends a band when its turn comes. A core hands in its bands from the top down.
pub(crate) fn send(core: usize, pixels: Pixels) {
    with_bus(|bus| {
        let _ = bus.drawn[core].push_back(pixels); // there are only two
        bus.proceed();
    });
}

impl Bus {
    /// Takes back what is sent and starts what is next, if it is drawn.
    fn proceed(&mut self) {
        let (channel, mut wire) = match self.state.take() {
            Some(State::Sends(mut transfer, core)) => {
                // First: what ends after this interrupts again.
                transfer.check_irq0();
                if !transfer.is_done() {
                    self.state = Some(State::Sends(transfer, core));
                    return;
                }
                let (channel, bytes, wire) = transfer.wait();
                let _ = self.free[core].push_back(bytemuck::cast_slice_mut(bytes)); // there are only two
                cortex_m::asm::sev();
                (channel, wire)
            }
            Some(State::Idle(channel, wire)) => (channel, wire),
            None => return,
        };
        let core = self.next % CORES;
        self.state = Some(match self.drawn[core].pop_front() {
            Some(pixels) => {
                if self.next == 0 {
                    // The window is the whole screen: its bands follow each other, with the display selected.
                    let Ok(()) = wire.flush(); // the channel is done before the last bits are out
                    let mut rows = Rows::new(device(&mut wire, &mut self.select), &mut self.data_command);
                    let screen = Rectangle::new(Point::zero(), SCREEN);
                    rows.open(screen).expect("the bus takes all bytes");
                    let Ok(()) = self.select.set_low();
                }
                self.next = (self.next + 1) % BANDS;
                let bytes: &'static mut [u8] = bytemuck::cast_slice_mut(pixels);
                State::Sends(Config::new(channel, bytes, wire).start(), core)
            }
            None => State::Idle(channel, wire),
        });
    }
}

/// A band is sent.
#[interrupt]
fn DMA_IRQ_0() {
    with_bus(Bus::proceed);
}
