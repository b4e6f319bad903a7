//! A display on a simulated bus with a DMA channel, in virtual time.

use std::ops::Deref;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

use embedded_dma::ReadBuffer;
use fixel::embedded_graphics::pixelcolor::Rgb565;
use fixel::embedded_graphics::prelude::*;
use fixel::embedded_graphics::primitives::Rectangle;
use fixel::{Band, BigEndian, DepthFormat};

/// Virtual time, in cycles. The bus, the shaders and who draws share it.
#[derive(Clone, Debug, Default)]
pub(crate) struct Clock(Arc<AtomicU64>);

impl Clock {
    pub(crate) fn now(&self) -> u64 {
        self.0.load(Ordering::Relaxed)
    }

    pub(crate) fn pass(&self, cycles: u64) {
        self.0.fetch_add(cycles, Ordering::Relaxed);
    }

    pub(crate) fn wait_until(&self, time: u64) {
        self.0.fetch_max(time, Ordering::Relaxed);
    }
}

/// A bus with a DMA channel, and the display behind it.
#[derive(Debug)]
pub(crate) struct Bus {
    pub(crate) clock: Clock,
    pub(crate) cycles_a_byte: u64,
    /// What the display shows, as bytes in their order on the bus.
    pub(crate) shown: Vec<u8>,
    /// How many bytes it was sent.
    pub(crate) sent: usize,
}

/// Memory on its way, which the channel owns meanwhile, as HALs have it: nobody else can write to it.
#[derive(Debug)]
pub(crate) struct Transfer<B> {
    pub(crate) bus: Bus,
    pub(crate) buffer: B,
    /// Where the display puts the first byte.
    pub(crate) start: usize,
    pub(crate) end: u64,
}

impl Bus {
    pub(crate) fn new(screen: Size, clock: &Clock, cycles_a_byte: u64) -> Self {
        let shown = vec![0x55; 2 * (screen.width * screen.height) as usize];
        Self { clock: clock.clone(), cycles_a_byte, shown, sent: 0 }
    }

    /// Whole rows, to an area as wide as the display.
    pub(crate) fn send<B: ReadBuffer<Word = u8> + Deref<Target = [u8]>>(
        self,
        area: Rectangle,
        buffer: B,
    ) -> Transfer<B> {
        assert_eq!((area.top_left.x, 2 * area.size.width * area.size.height), (0, buffer.len() as u32));
        let start = 2 * area.size.width as usize * area.top_left.y as usize;
        let end = self.clock.now() + self.cycles_a_byte * buffer.len() as u64;
        Transfer { bus: self, buffer, start, end }
    }
}

impl<B: Deref<Target = [u8]>> Transfer<B> {
    /// The bytes are read at the very end: had anyone written to them, it would show.
    pub(crate) fn wait(mut self) -> (Bus, B) {
        self.bus.clock.wait_until(self.end);
        self.bus.sent += self.buffer.len();
        self.bus.shown[self.start..self.start + self.buffer.len()].copy_from_slice(&self.buffer);
        (self.bus, self.buffer)
    }
}

pub(crate) fn bytes(words: &'static mut [u16]) -> &'static mut [u8] {
    bytemuck::must_cast_slice_mut(words)
}

pub(crate) fn words(bytes: &'static mut [u8]) -> &'static mut [u16] {
    bytemuck::cast_slice_mut(bytes)
}

pub(crate) fn memory(words: usize) -> &'static mut [u16] {
    Box::leak(vec![0; words].into_boxed_slice())
}

/// What the DMA channel does.
pub(crate) enum Channel {
    Idle(Bus, &'static mut [u16]),
    Sends(Transfer<&'static mut [u8]>),
}

impl Channel {
    pub(crate) fn wait(self) -> (Bus, &'static mut [u16]) {
        match self {
            Self::Idle(bus, free) => (bus, free),
            Self::Sends(transfer) => {
                let (bus, sent) = transfer.wait();
                (bus, words(sent))
            }
        }
    }

    /// Sends a band that is drawn, and gives it what was sent before to be drawn into.
    pub(crate) fn send<D: DepthFormat>(self, band: &mut Band<'static, BigEndian<Rgb565>, D>) -> Self {
        let (bus, mut pixels) = self.wait();
        band.swap_pixels(&mut pixels).expect("both are of one size");
        Self::Sends(bus.send(band.bounding_box(), bytes(pixels)))
    }
}
