//! The ST7789: a controller of 240×320 panels, on a 4-wire SPI bus that it has for itself.
//!
//! It is sent whole frames, row after row: the window is the whole panel, set once.

use embedded_hal::{delay::DelayNs, digital::OutputPin, spi::SpiBus};

use crate::frames::SCREEN;

const SOFTWARE_RESET: u8 = 0x01;
const SLEEP_OUT: u8 = 0x11;
const INVERSION_ON: u8 = 0x21;
const DISPLAY_ON: u8 = 0x29;
const COLUMNS: u8 = 0x2a;
const ROWS: u8 = 0x2b;
const WRITE_MEMORY: u8 = 0x2c;
const MEMORY_ACCESS: u8 = 0x36;
const PIXEL_FORMAT: u8 = 0x3a;

/// What failed on the way to the display.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Error<Spi, Pin> {
    /// The SPI bus.
    Spi(Spi),
    /// The data/command line.
    DataCommand(Pin),
}

/// The display but for its bus, which a DMA channel owns most of the time.
#[derive(Debug)]
pub(crate) struct St7789<Pin> {
    /// High for pixels and parameters, low for commands.
    data_command: Pin,
}

impl<Pin: OutputPin> St7789<Pin> {
    /// Resets the controller, switches the panel on, and opens all of it for pixels.
    pub(crate) fn new<Spi: SpiBus>(
        spi: &mut Spi,
        data_command: Pin,
        delay: &mut impl DelayNs,
    ) -> Result<Self, Error<Spi::Error, Pin::Error>> {
        let mut display = Self { data_command };
        let last = |side: u32| {
            let [high, low] = (side as u16 - 1).to_be_bytes();
            [0, 0, high, low]
        };
        display.command(spi, SOFTWARE_RESET, &[])?;
        delay.delay_ms(150);
        display.command(spi, SLEEP_OUT, &[])?;
        delay.delay_ms(120);
        display.command(spi, PIXEL_FORMAT, &[0x55])?; // 16 bits
        display.command(spi, MEMORY_ACCESS, &[0x00])?; // upright, red first
        display.command(spi, INVERSION_ON, &[])?; // as IPS panels are wired
        display.command(spi, COLUMNS, &last(SCREEN.width))?;
        display.command(spi, ROWS, &last(SCREEN.height))?;
        display.command(spi, DISPLAY_ON, &[])?;
        Ok(display)
    }

    /// The next bytes on the bus are pixels, from the panel's first on.
    pub(crate) fn start_frame<Spi: SpiBus>(
        &mut self,
        spi: &mut Spi,
    ) -> Result<(), Error<Spi::Error, Pin::Error>> {
        self.command(spi, WRITE_MEMORY, &[])
    }

    /// Leaves the line high, for pixels.
    fn command<Spi: SpiBus>(
        &mut self,
        spi: &mut Spi,
        command: u8,
        parameters: &[u8],
    ) -> Result<(), Error<Spi::Error, Pin::Error>> {
        // The line is read with a byte's last bit: it has to stand until all of them are out, the last frame's pixels too.
        spi.flush().map_err(Error::Spi)?;
        self.data_command.set_low().map_err(Error::DataCommand)?;
        spi.write(&[command]).map_err(Error::Spi)?;
        spi.flush().map_err(Error::Spi)?;
        self.data_command.set_high().map_err(Error::DataCommand)?;
        spi.write(parameters).map_err(Error::Spi)?;
        spi.flush().map_err(Error::Spi)
    }
}
