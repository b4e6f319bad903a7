//! Buses that record: what is written goes to a panel, and is counted.

use std::cell::RefCell;
use std::convert::Infallible;
use std::rc::Rc;

use embassy_futures::yield_now;
use embedded_hal::delay::DelayNs;
use embedded_hal::digital::{self, InputPin, OutputPin};
use embedded_hal::i2c::{self, I2c};
use embedded_hal::spi::{self, Operation, SpiDevice};

/// A display's controller at the end of a bus.
pub(crate) trait Panel {
    /// A byte while the data/command pin is low.
    fn command(&mut self, byte: u8);

    /// A byte while it is high.
    fn data(&mut self, byte: u8);
}

/// How much was written.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Count {
    /// Calls of the HAL: each selects the display, or is a transaction of I²C.
    pub(crate) writes: usize,
    /// On the wires, with commands, addresses and control bytes.
    pub(crate) bytes: usize,
}

struct Line<P> {
    panel: P,
    is_data: bool,
    count: Count,
    /// Called when an asynchronous write begins, with true, and when it ends, with false.
    watcher: Box<dyn FnMut(bool)>,
}

/// A bus, its pins and the panel, shared by who has one of them.
pub(crate) struct Wire<P>(Rc<RefCell<Line<P>>>);

impl<P> Clone for Wire<P> {
    fn clone(&self) -> Self {
        Self(Rc::clone(&self.0))
    }
}

impl<P: Panel> Wire<P> {
    pub(crate) fn new(panel: P) -> Self {
        let line = Line { panel, is_data: false, count: Count::default(), watcher: Box::new(|_| ()) };
        Self(Rc::new(RefCell::new(line)))
    }

    /// What was written since the last time that this was asked.
    pub(crate) fn count(&self) -> Count {
        std::mem::take(&mut self.0.borrow_mut().count)
    }

    pub(crate) fn panel<R>(&self, look: impl FnOnce(&P) -> R) -> R {
        look(&self.0.borrow().panel)
    }

    pub(crate) fn watch(&self, watcher: impl FnMut(bool) + 'static) {
        self.0.borrow_mut().watcher = Box::new(watcher);
    }

    fn put(&self, bytes: &[u8]) {
        let line = &mut *self.0.borrow_mut();
        line.count.writes += 1;
        line.count.bytes += bytes.len();
        for &byte in bytes {
            if line.is_data {
                line.panel.data(byte);
            } else {
                line.panel.command(byte);
            }
        }
    }
}

impl<P> spi::ErrorType for Wire<P> {
    type Error = Infallible;
}

fn written<'a>(operation: &'a Operation<'_, u8>) -> &'a [u8] {
    let Operation::Write(bytes) = operation else { panic!("displays are written to") };
    bytes
}

impl<P: Panel> SpiDevice for Wire<P> {
    fn transaction(&mut self, operations: &mut [Operation<'_, u8>]) -> Result<(), Infallible> {
        operations.iter().for_each(|operation| self.put(written(operation)));
        Ok(())
    }
}

impl<P: Panel> embedded_hal_async::spi::SpiDevice for Wire<P> {
    async fn transaction(&mut self, operations: &mut [Operation<'_, u8>]) -> Result<(), Infallible> {
        for operation in operations {
            (self.0.borrow_mut().watcher)(true);
            // The channel reads the bytes until it is done, which somebody else's work may come before.
            yield_now().await;
            self.put(written(operation));
            (self.0.borrow_mut().watcher)(false);
        }
        Ok(())
    }
}

impl<P> i2c::ErrorType for Wire<P> {
    type Error = Infallible;
}

impl<P: Panel> I2c for Wire<P> {
    /// The first byte says what the others are.
    fn transaction(&mut self, address: u8, operations: &mut [i2c::Operation<'_>]) -> Result<(), Infallible> {
        assert_eq!(address, 0x3c);
        for operation in operations {
            let i2c::Operation::Write([control, bytes @ ..]) = operation else {
                panic!("displays are written to")
            };
            self.0.borrow_mut().is_data = match control {
                0x00 => false,
                0x40 => true,
                _ => panic!("{control:#x} is no control byte"),
            };
            self.put(bytes);
            self.0.borrow_mut().count.bytes += 2;
        }
        Ok(())
    }
}

/// The data/command pin of a bus.
pub(crate) struct DataCommand<P>(pub(crate) Wire<P>);

impl<P> digital::ErrorType for DataCommand<P> {
    type Error = Infallible;
}

impl<P> OutputPin for DataCommand<P> {
    fn set_low(&mut self) -> Result<(), Infallible> {
        self.0.0.borrow_mut().is_data = false;
        Ok(())
    }

    fn set_high(&mut self) -> Result<(), Infallible> {
        self.0.0.borrow_mut().is_data = true;
        Ok(())
    }
}

/// Pins that nobody looks at, one that always says the same, and delays that take no time.
pub(crate) struct Still {
    pub(crate) is_high: bool,
}

impl digital::ErrorType for Still {
    type Error = Infallible;
}

impl OutputPin for Still {
    fn set_low(&mut self) -> Result<(), Infallible> {
        Ok(())
    }

    fn set_high(&mut self) -> Result<(), Infallible> {
        Ok(())
    }
}

impl InputPin for Still {
    fn is_high(&mut self) -> Result<bool, Infallible> {
        Ok(self.is_high)
    }

    fn is_low(&mut self) -> Result<bool, Infallible> {
        Ok(!self.is_high)
    }
}

impl DelayNs for Still {
    fn delay_ns(&mut self, _: u32) {}
}

impl embedded_hal_async::delay::DelayNs for Still {
    async fn delay_ns(&mut self, _: u32) {}
}
