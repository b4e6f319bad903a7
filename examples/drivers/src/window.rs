//! The commands that open a window.

use core::fmt;
use fixel::embedded_graphics::{prelude::*, primitives::Rectangle};

const COLUMNS: u8 = 0x2a;
const LINES: u8 = 0x2b;
const WRITE_MEMORY: u8 = 0x2c;

/// What failed on the way to the display: the SPI bus, or the pin that tells data from commands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Error<Spi, Pin> {
    /// The SPI bus.
    Spi(Spi),
    /// The data/command pin.
    DataCommand(Pin),
}

impl<Spi: fmt::Debug, Pin: fmt::Debug> fmt::Display for Error<Spi, Pin> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Spi(error) => write!(f, "the SPI bus failed: {error:?}"),
            Self::DataCommand(error) => write!(f, "the data/command pin failed: {error:?}"),
        }
    }
}

impl<Spi: fmt::Debug, Pin: fmt::Debug> core::error::Error for Error<Spi, Pin> {}

/// The commands that open an area for pixels, with the parameters of each. `offset` is where the panel's first pixel is in the
/// controller's memory.
pub(crate) fn commands(area: Rectangle, offset: Point) -> [(u8, Parameters); 3] {
    let start = area.top_left + offset;
    [
        (COLUMNS, Parameters::ends(start.x, area.size.width)),
        (LINES, Parameters::ends(start.y, area.size.height)),
        (WRITE_MEMORY, Parameters { bytes: [0; 4], length: 0 }),
    ]
}

/// At most four bytes.
pub(crate) struct Parameters {
    bytes: [u8; 4],
    length: usize,
}

impl Parameters {
    /// The first and the last column or row.
    fn ends(start: i32, length: u32) -> Self {
        let [a, b] = (start as u16).to_be_bytes();
        let [c, d] = (start as u16).wrapping_add(length as u16).wrapping_sub(1).to_be_bytes();
        Self { bytes: [a, b, c, d], length: 4 }
    }

    pub(crate) fn bytes(&self) -> &[u8] {
        &self.bytes[..self.length]
    }
}
