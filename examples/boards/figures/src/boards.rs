//! The boards, and how long a frame takes on each.

use std::ops::Range;

use crate::cycles::Cycles;

/// A program on a board.
#[derive(Debug)]
pub(crate) struct Board {
    /// Of its package, which has its name.
    pub(crate) folder: &'static str,
    pub(crate) target: &'static str,
    pub(crate) chip: &'static str,
    /// Hertz.
    pub(crate) clock: u32,
    /// As in `cycles.txt`.
    pub(crate) core: &'static str,
    pub(crate) display: &'static str,
    pub(crate) bus: Bus,
    pub(crate) way: Way,
    /// Where the chip has RAM: for data, and for code if it is at another address there.
    pub(crate) ram: [Range<u64>; 2],
}

/// A display's bus.
#[derive(Debug)]
pub(crate) struct Bus {
    /// Bits a second, as the program sets it.
    pub(crate) bits: u32,
    /// Of a frame, on the wires: what examples/drivers counts.
    frame: u32,
    /// Cycles a byte that it stands still, as the processor feeds it: an estimate from what the HAL does for each.
    gap: f64,
}

/// What happens at once.
#[derive(Debug)]
pub(crate) enum Way {
    /// A band is drawn, made bytes of by mipidsi, and sent.
    DriverInTurns,
    /// A band is drawn, and sent.
    InTurns,
    /// The same, on a display of 128×64 pixels of 1 bit.
    OledInTurns,
    /// A band is drawn while the one before is sent; the last of a frame while nothing is drawn.
    WhileSent,
    /// The same, and the next frame's list is recorded meanwhile.
    AlwaysWhileSent,
    /// The same, by two cores.
    TwoCores,
}

const ST7789: &str = "ST7789, 240×320";
/// A frame in bands of 32 rows, each with its window.
const IN_WINDOWS: u32 = 2 * 240 * 320 + 10 * 11;
/// … or in one window.
const AT_ONCE: u32 = 2 * 240 * 320 + 11;

const RP2040: [Range<u64>; 2] = [0x2000_0000..0x2004_2000, 0..0];

pub(crate) const BOARDS: [Board; 6] = [
    Board {
        folder: "pico",
        target: "thumbv6m-none-eabi",
        chip: "RP2040, Cortex-M0+",
        clock: 125_000_000,
        core: "m0plus",
        display: ST7789,
        // The loop of `Busy` is about 19 cycles long, and a byte 16.
        bus: Bus { bits: 62_500_000, frame: IN_WINDOWS, gap: 3.0 },
        way: Way::DriverInTurns,
        ram: RP2040,
    },
    Board {
        folder: "pico-embassy",
        target: "thumbv6m-none-eabi",
        chip: "RP2040, Cortex-M0+",
        clock: 125_000_000,
        core: "m0plus",
        display: ST7789,
        bus: Bus { bits: 62_500_000, frame: AT_ONCE, gap: 0.0 },
        way: Way::WhileSent,
        ram: RP2040,
    },
    Board {
        folder: "pico-two-cores",
        target: "thumbv6m-none-eabi",
        chip: "RP2040, two Cortex-M0+",
        clock: 125_000_000,
        core: "m0plus",
        display: ST7789,
        bus: Bus { bits: 62_500_000, frame: AT_ONCE, gap: 0.0 },
        way: Way::TwoCores,
        ram: RP2040,
    },
    Board {
        folder: "pico2",
        target: "thumbv8m.main-none-eabihf",
        chip: "RP2350, Cortex-M33",
        clock: 150_000_000,
        core: "m33",
        display: ST7789,
        bus: Bus { bits: 37_500_000, frame: AT_ONCE, gap: 0.0 },
        way: Way::AlwaysWhileSent,
        ram: [0x2000_0000..0x2008_2000, 0..0],
    },
    Board {
        folder: "esp32c3",
        target: "riscv32imc-unknown-none-elf",
        chip: "ESP32-C3, RV32IMC",
        clock: 160_000_000,
        core: "rv32",
        display: ST7789,
        // esp-hal fills 64 bytes, starts, and waits until they are out: about 250 cycles for the three.
        bus: Bus { bits: 40_000_000, frame: IN_WINDOWS, gap: 4.0 },
        way: Way::InTurns,
        ram: [0x3fc8_0000..0x3fce_0000, 0x4037_c000..0x403e_0000],
    },
    Board {
        folder: "microbit",
        target: "thumbv7em-none-eabihf",
        chip: "nRF52833, Cortex-M4F",
        clock: 64_000_000,
        core: "m4",
        display: "SSD1306, 128×64, 1 bit",
        // With the bit that acknowledges a byte, and two that start and stop each of 64 transactions.
        bus: Bus { bits: 400_000, frame: 1152 * 9 / 8 + 64 * 2 / 8, gap: 0.0 },
        way: Way::OledInTurns,
        ram: [0x2000_0000..0x2002_0000, 0..0],
    },
];

impl Board {
    /// Cycles of a frame: the list and its bands. With two cores those of one, which draws half of the bands.
    pub(crate) fn drawn(&self, cycles: &Cycles) -> u64 {
        match self.way {
            Way::OledInTurns => cycles.oled_list + cycles.oled_bands,
            Way::TwoCores => cycles.list + cycles.bands16 / 2,
            _ => cycles.list + cycles.bands32,
        }
    }

    /// Seconds until a frame's bytes are out, mipidsi's work on them included.
    pub(crate) fn sent(&self, cycles: &Cycles) -> f64 {
        let Bus { bits, frame, gap } = self.bus;
        let driver = if matches!(self.way, Way::DriverInTurns) { cycles.driver as f64 } else { 0.0 };
        f64::from(8 * frame) / f64::from(bits) + (driver + gap * f64::from(frame)) / f64::from(self.clock)
    }

    /// Seconds from frame to frame.
    pub(crate) fn frame(&self, cycles: &Cycles) -> f64 {
        let (drawn, sent) = (self.drawn(cycles) as f64 / f64::from(self.clock), self.sent(cycles));
        let list = cycles.list as f64 / f64::from(self.clock);
        match self.way {
            Way::DriverInTurns | Way::InTurns | Way::OledInTurns => drawn + sent,
            // The first of ten bands is drawn before anything is sent, and the last is sent when all is drawn.
            Way::WhileSent => {
                let bands = drawn - list;
                list + bands.max(sent) + bands.min(sent) / 10.0
            }
            Way::AlwaysWhileSent | Way::TwoCores => drawn.max(sent),
        }
    }
}
