//! An SPI bus that is kept busy: rp2040-hal's own `write` waits for each byte to come back before it writes the next.

use embedded_hal::spi::{ErrorType, SpiBus};
use embedded_hal_nb::{nb::block, spi::FullDuplex};

/// A bus of rp2040-hal for what says nothing, such as a display: what comes back while it is written to is lost.
pub struct Busy<B>(pub B);

impl<B: ErrorType> ErrorType for Busy<B> {
    type Error = B::Error;
}

impl<B: SpiBus + FullDuplex> SpiBus for Busy<B> {
    fn write(&mut self, words: &[u8]) -> Result<(), B::Error> {
        words.iter().try_for_each(|&word| block!(FullDuplex::write(&mut self.0, word)))
    }

    fn read(&mut self, words: &mut [u8]) -> Result<(), B::Error> {
        SpiBus::read(&mut self.0, words)
    }

    fn transfer(&mut self, read: &mut [u8], write: &[u8]) -> Result<(), B::Error> {
        self.0.transfer(read, write)
    }

    fn transfer_in_place(&mut self, words: &mut [u8]) -> Result<(), B::Error> {
        self.0.transfer_in_place(words)
    }

    fn flush(&mut self) -> Result<(), B::Error> {
        self.0.flush()
    }
}
