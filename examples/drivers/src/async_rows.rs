//! Rows to a display on an asynchronous bus: one band is sent while the next is drawn.

use crate::window::{self, Error};
use embassy_futures::join::join;
use embedded_hal::digital::OutputPin;
use embedded_hal_async::spi::SpiDevice;
use fixel::embedded_graphics::{prelude::*, primitives::Rectangle};
use fixel::{Background, Band, DepthFormat, DisplayList, PixelFormat, TargetError};

/// As [`Rows`](crate::Rows), on an asynchronous bus.
///
/// `lcd_async::Display::show_raw_data` sends a band by six writes. Of these only the first is under way while the next band is drawn,
/// since drawing does not wait for anything. [`AsyncRows::frame`] opens the screen once, and then a band is one write.
#[derive(Debug)]
pub struct AsyncRows<Spi, Pin> {
    spi: Spi,
    /// High for pixels and parameters, low for commands.
    data_command: Pin,
    offset: Point,
}

/// What a frame is drawn in: two bands of `size` pixels each, of which one is drawn while the other is sent.
#[derive(Debug)]
pub struct Memory<'m, P, D> {
    /// Of a band: as wide as the screen.
    pub size: Size,
    /// Width × height words each.
    pub pixels: [&'m mut [P]; 2],
    /// Width × height words, or none for [`NoDepth`](fixel::NoDepth).
    pub depth: &'m mut [D],
}

impl<Spi: SpiDevice, Pin: OutputPin> AsyncRows<Spi, Pin> {
    /// Of the bus and the data/command pin that a driver gives back: in lcd-async `display.release().0.release()`.
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
    pub async fn open(&mut self, area: Rectangle) -> Result<(), Error<Spi::Error, Pin::Error>> {
        for (command, parameters) in window::commands(area, self.offset) {
            self.data_command.set_low().map_err(Error::DataCommand)?;
            self.spi.write(&[command]).await.map_err(Error::Spi)?;
            self.data_command.set_high().map_err(Error::DataCommand)?;
            if !parameters.bytes().is_empty() {
                self.spi.write(parameters.bytes()).await.map_err(Error::Spi)?;
            }
        }
        Ok(())
    }

    /// Sends pixels as they stand in memory, to what is open. With a DMA channel behind the bus the first poll starts it.
    ///
    /// # Errors
    ///
    /// Those of the bus.
    pub async fn send(&mut self, pixels: &[u8]) -> Result<(), Error<Spi::Error, Pin::Error>> {
        self.spi.write(pixels).await.map_err(Error::Spi)
    }

    /// Draws a screen of `height` rows from a list and sends it, each band while the next is drawn: together as long as the slower of
    /// the two, and a band. `on_top` draws what comes on top of each band. (Rows of a screen that is no multiple of a band's are drawn
    /// in a last band that is as high as the others, and not sent.)
    ///
    /// # Errors
    ///
    /// Those of the bus and the pin.
    ///
    /// # Panics
    ///
    /// If the memory is not of the size that it says.
    pub async fn frame<F, D, const N: usize>(
        &mut self,
        list: &DisplayList<'_, F, D, N>,
        height: u32,
        background: &impl Background<F>,
        memory: &mut Memory<'_, F::Word, D::Word>,
        mut on_top: impl FnMut(&mut Band<'_, F, D>),
    ) -> Result<(), Error<Spi::Error, Pin::Error>>
    where
        F: PixelFormat<Word: bytemuck::NoUninit>,
        D: DepthFormat,
    {
        let Memory { size, pixels: [one, other], depth } = memory;
        let (mut sent, size) = (&mut **other, *size);
        let band: Result<Band<'_, F, D>, TargetError> = Band::new(size, one, depth);
        let mut band = band.expect("the memory is of its size");
        let row = size.width as usize * size_of::<F::Word>();
        let mut draw = |top: u32, band: &mut Band<'_, F, D>| {
            band.move_to(top);
            band.clear_to(background);
            list.render(top, band);
            on_top(band);
        };

        draw(0, &mut band);
        self.open(Rectangle::new(Point::zero(), Size::new(size.width, height))).await?;
        let mut top = 0;
        while top < height {
            band.swap_pixels(&mut sent).expect("both bands are of one size");
            let rows = size.height.min(height - top) as usize;
            top += size.height;
            let bytes = bytemuck::cast_slice::<F::Word, u8>(sent);
            // First in `join`, so that it is under way while the other draws, which does not wait for anything.
            let sending = self.send(bytes.get(..rows * row).unwrap_or(bytes));
            let drawing = async {
                if top < height {
                    draw(top, &mut band);
                }
            };
            join(sending, drawing).await.0?;
        }
        Ok(())
    }

    /// The bus and the pin.
    pub fn release(self) -> (Spi, Pin) {
        (self.spi, self.data_command)
    }
}
