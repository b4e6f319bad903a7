//! Rows to a display on a blocking bus.

use crate::window::{self, Error};
use embedded_hal::{digital::OutputPin, spi::SpiDevice};
use fixel::embedded_graphics::{prelude::*, primitives::Rectangle};

/// A display that a driver has set up, as a window and bytes on an SPI bus.
///
/// A band takes six writes: five of 11 bytes together for the window, and one of its pixels.
#[derive(Debug)]
pub struct Rows<Spi, Pin> {
    spi: Spi,
    /// High for pixels and parameters, low for commands.
    data_command: Pin,
    offset: Point,
}

impl<Spi: SpiDevice, Pin: OutputPin> Rows<Spi, Pin> {
    /// Of the bus and the data/command pin that a driver gives back: in mipidsi `display.release().0.release()`.
    pub fn new(spi: Spi, data_command: Pin) -> Self {
        Self { spi, data_command, offset: Point::zero() }
    }

    /// For a panel that is smaller than its controller's memory: where in that the panel's first pixel is.
    #[must_use]
    pub fn with_offset(mut self, offset: Point) -> Self {
        self.offset = offset;
        self
    }

    /// Opens an area: what is sent next goes there, row after row, and after its last pixel to its first again.
    ///
    /// # Errors
    ///
    /// Those of the bus and the pin.
    pub fn open(&mut self, area: Rectangle) -> Result<(), Error<Spi::Error, Pin::Error>> {
        for (command, parameters) in window::commands(area, self.offset) {
            self.data_command.set_low().map_err(Error::DataCommand)?;
            self.spi.write(&[command]).map_err(Error::Spi)?;
            self.data_command.set_high().map_err(Error::DataCommand)?;
            if !parameters.bytes().is_empty() {
                self.spi.write(parameters.bytes()).map_err(Error::Spi)?;
            }
        }
        Ok(())
    }

    /// Sends pixels as they stand in memory, to what is open.
    ///
    /// # Errors
    ///
    /// Those of the bus.
    pub fn send(&mut self, pixels: &[u8]) -> Result<(), Error<Spi::Error, Pin::Error>> {
        self.spi.write(pixels).map_err(Error::Spi)
    }

    /// Sends pixels to an area: of a band `rows.show(area, band.as_bytes())`.
    ///
    /// # Errors
    ///
    /// Those of the bus and the pin.
    pub fn show(&mut self, area: Rectangle, pixels: &[u8]) -> Result<(), Error<Spi::Error, Pin::Error>> {
        self.open(area)?;
        self.send(pixels)
    }

    /// The bus and the pin.
    pub fn release(self) -> (Spi, Pin) {
        (self.spi, self.data_command)
    }
}
