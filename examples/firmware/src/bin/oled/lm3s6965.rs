//! The board's registers that lead to the OLED: SSI0 on port A, the data/command line on port C.
//! The only unsafe code of the firmware is in [`Register`].
#![allow(unsafe_code)]

use core::convert::Infallible;

use embedded_hal::{
    digital::{self, OutputPin},
    spi::{self, Operation, SpiDevice},
};

/// After reset the chip runs from its internal oscillator.
const CLOCK_MHZ: u32 = 12;

/// A 32-bit register of a peripheral.
struct Register(usize);

impl Register {
    /// `base` and `offset` are constants of this module, from the LM3S6965's data sheet.
    const fn new(base: usize, offset: usize) -> Self {
        Self(base + offset)
    }

    fn read(&self) -> u32 {
        // SAFETY: the address is that of an aligned register, whose reading has no effect on memory.
        unsafe { (self.0 as *const u32).read_volatile() }
    }

    fn write(&self, value: u32) {
        // SAFETY: as above; the peripherals in use have no DMA, so nothing else is written.
        unsafe { (self.0 as *mut u32).write_volatile(value) }
    }

    fn set(&self, bits: u32) {
        self.write(self.read() | bits);
    }
}

const PORT_A: usize = 0x4000_4000;
const PORT_C: usize = 0x4000_6000;
const PORT_D: usize = 0x4000_7000;
const GPIODIR: usize = 0x400;
const GPIOAFSEL: usize = 0x420;
const GPIODEN: usize = 0x51C;

const SSI0: usize = 0x4000_8000;
const SSICR0: Register = Register::new(SSI0, 0x00);
const SSICR1: Register = Register::new(SSI0, 0x04);
const SSIDR: Register = Register::new(SSI0, 0x08);
const SSISR: Register = Register::new(SSI0, 0x0C);
const SSICPSR: Register = Register::new(SSI0, 0x10);
/// SSISR: the receive FIFO is not empty.
const RNE: u32 = 1 << 2;

const SYSTEM_CONTROL: usize = 0x400F_E000;
const RCGC1: Register = Register::new(SYSTEM_CONTROL, 0x104);
const RCGC2: Register = Register::new(SYSTEM_CONTROL, 0x108);

/// A pin that is an output.
pub(crate) struct Pin {
    /// The data register's window onto this pin alone: address bits 2 to 9 are the mask.
    data: Register,
}

impl Pin {
    /// Makes pin `number` of a port an output that is high from the start.
    fn output_high(port: usize, number: u32) -> Self {
        let pin = Self { data: Register::new(port, 4 << number) };
        Register::new(port, GPIODIR).set(1 << number);
        pin.data.write(u32::MAX);
        Register::new(port, GPIODEN).set(1 << number);
        pin
    }
}

impl digital::ErrorType for Pin {
    type Error = Infallible;
}

impl OutputPin for Pin {
    fn set_low(&mut self) -> Result<(), Infallible> {
        self.data.write(0);
        Ok(())
    }

    fn set_high(&mut self) -> Result<(), Infallible> {
        self.data.write(u32::MAX);
        Ok(())
    }
}

/// The OLED on SSI0, with its chip select.
pub(crate) struct Oled {
    select: Pin,
}

impl Oled {
    /// Sends a byte and returns the one that arrived meanwhile; when it is there, the line is idle.
    fn exchange(&mut self, byte: u8) -> u8 {
        SSIDR.write(byte.into());
        while SSISR.read() & RNE == 0 {}
        SSIDR.read() as u8
    }
}

impl spi::ErrorType for Oled {
    type Error = Infallible;
}

impl SpiDevice for Oled {
    fn transaction(&mut self, operations: &mut [Operation<'_, u8>]) -> Result<(), Infallible> {
        self.select.set_low()?;
        for operation in operations {
            match operation {
                Operation::Write(bytes) => bytes.iter().for_each(|&byte| {
                    self.exchange(byte);
                }),
                Operation::Read(bytes) => bytes.iter_mut().for_each(|byte| *byte = self.exchange(0)),
                Operation::TransferInPlace(bytes) => {
                    bytes.iter_mut().for_each(|byte| *byte = self.exchange(*byte));
                }
                Operation::Transfer(read, write) => {
                    for i in 0..read.len().max(write.len()) {
                        let byte = self.exchange(write.get(i).copied().unwrap_or(0));
                        if let Some(place) = read.get_mut(i) {
                            *place = byte;
                        }
                    }
                }
                Operation::DelayNs(ns) => cortex_m::asm::delay(*ns / 1000 * CLOCK_MHZ + CLOCK_MHZ),
            }
        }
        self.select.set_high()
    }
}

/// Sets up SSI0 and the pins, and returns the OLED's bus and its data/command line.
pub(crate) fn oled() -> (Oled, Pin) {
    RCGC1.set(1 << 4); // SSI0
    RCGC2.set(1 << 0 | 1 << 2 | 1 << 3); // ports A, C and D
    // A block may be touched three clocks after its clock is on.
    cortex_m::asm::delay(3);

    // The SD card shares the bus. Its select is also the one that the emulator knows for the OLED.
    Pin::output_high(PORT_D, 0);
    let select = Pin::output_high(PORT_A, 3);
    let data_command = Pin::output_high(PORT_C, 7);
    Register::new(PORT_A, GPIOAFSEL).set(1 << 2 | 1 << 5); // clock and transmit
    Register::new(PORT_A, GPIODEN).set(1 << 2 | 1 << 5);

    SSICR1.write(0); // off, main mode
    SSICPSR.write(4); // 12 MHz / 4; the controller takes 4 MHz
    SSICR0.write(1 << 6 | 7); // clock high when idle, 8 bits
    SSICR1.write(1 << 1); // on
    (Oled { select }, data_command)
}
