//! The SSD0323: a controller of 128×64 OLED panels with sixteen grey levels, on a 4-wire SPI bus.
//!
//! Two pixels share a byte of its memory, which cannot be read back over SPI. The driver keeps a copy in
//! memory that its owner lends (4 KiB), so that any pixel can be set alone, and sends only the bytes
//! inside the drawn rectangle.

use embedded_graphics::{Pixel, pixelcolor::Gray4, prelude::*, primitives::Rectangle};
use embedded_hal::{digital::OutputPin, spi::SpiDevice};

use crate::gray4;

/// Width of the panel in pixels.
pub const WIDTH: usize = 128;
/// Height of the panel in pixels.
pub const HEIGHT: usize = 64;
/// Bytes of a row.
const STRIDE: usize = WIDTH / 2;
/// The copy of the controller's memory.
pub type Memory = [u8; STRIDE * HEIGHT];
/// A black one, for a `static`.
pub const BLANK: Memory = [0; STRIDE * HEIGHT];

const SET_COLUMN_ADDRESS: u8 = 0x15;
const SET_ROW_ADDRESS: u8 = 0x75;

/// Commands after power-up, for the panel's own supply and timing as its maker recommends them.
const INIT: &[u8] = &[
    0xAE, // display off
    0x81, 0x32, // contrast
    0x85, // half of the current range
    0xA0, 0x52, // left pixel in the high half of a byte, rows top down, split COM lines
    0xA1, 0x00, // first row of the memory on top
    0xA2, 0x4C, // COM line of the first row
    0xA4, // normal, not inverse
    0xA8, 0x3F, // 64 rows
    0xB1, 0x22, // phase lengths
    0xB2, 0x46, // row period
    0xB3, 0xF1, // clock
    0xBF, 0x0D, // segment low voltage
    0xBE, 0x02, // COM high voltage
    0xBC, 0x10, // precharge voltage
    0xB8, 0x01, 0x11, 0x22, 0x32, 0x43, 0x54, 0x65, 0x76, // grey levels
    0xAD, 0x03, // DC-DC converter on
];
const DISPLAY_ON: &[u8] = &[0xAF];

/// What failed on the way to the display.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Error<Spi, Pin> {
    /// The SPI bus or its chip select.
    Spi(Spi),
    /// The data/command line.
    DataCommand(Pin),
}

/// The display, as an embedded-graphics target.
#[derive(Debug)]
pub struct Ssd0323<'a, Spi, Pin> {
    spi: Spi,
    /// High for pixels, low for commands.
    data_command: Pin,
    memory: &'a mut Memory,
}

impl<'a, Spi: SpiDevice, Pin: OutputPin> Ssd0323<'a, Spi, Pin> {
    /// Sets up the controller, clears its memory and then switches the panel on.
    ///
    /// # Errors
    ///
    /// When the bus or the data/command line fails.
    pub fn new(
        spi: Spi,
        data_command: Pin,
        memory: &'a mut Memory,
    ) -> Result<Self, Error<Spi::Error, Pin::Error>> {
        memory.fill(0);
        let mut display = Self { spi, data_command, memory };
        display.command(INIT)?;
        display.flush(&display.bounding_box())?;
        display.command(DISPLAY_ON)?;
        Ok(display)
    }

    fn command(&mut self, bytes: &[u8]) -> Result<(), Error<Spi::Error, Pin::Error>> {
        self.data_command.set_low().map_err(Error::DataCommand)?;
        self.spi.write(bytes).map_err(Error::Spi)
    }

    /// Sends the bytes that hold the pixels of `area`, which lies within the panel.
    fn flush(&mut self, area: &Rectangle) -> Result<(), Error<Spi::Error, Pin::Error>> {
        let Some(Point { x: right, y: bottom }) = area.bottom_right() else {
            return Ok(());
        };
        let (left, right) = (area.top_left.x as usize / 2, right as usize / 2);
        let (top, bottom) = (area.top_left.y as usize, bottom as usize);
        self.command(&[
            SET_COLUMN_ADDRESS,
            left as u8,
            right as u8,
            SET_ROW_ADDRESS,
            top as u8,
            bottom as u8,
        ])?;
        self.data_command.set_high().map_err(Error::DataCommand)?;
        let rows = &self.memory[top * STRIDE..(bottom + 1) * STRIDE];
        if (left, right) == (0, STRIDE - 1) {
            return self.spi.write(rows).map_err(Error::Spi);
        }
        for row in rows.chunks_exact(STRIDE) {
            self.spi.write(&row[left..=right]).map_err(Error::Spi)?;
        }
        Ok(())
    }

    /// Sets a pixel of the copy; `x` and `y` lie within the panel.
    fn set(&mut self, x: usize, y: usize, level: Gray4) {
        let byte = &mut self.memory[y * STRIDE + x / 2];
        *byte =
            if x.is_multiple_of(2) { *byte & 0x0F | level.luma() << 4 } else { *byte & 0xF0 | level.luma() };
    }
}

impl<Spi, Pin> OriginDimensions for Ssd0323<'_, Spi, Pin> {
    fn size(&self) -> Size {
        Size::new(WIDTH as u32, HEIGHT as u32)
    }
}

impl<Spi: SpiDevice, Pin: OutputPin> DrawTarget for Ssd0323<'_, Spi, Pin> {
    type Color = Gray4;
    type Error = Error<Spi::Error, Pin::Error>;

    /// Sends the rectangle around all the pixels once.
    fn draw_iter<I>(&mut self, pixels: I) -> Result<(), Self::Error>
    where
        I: IntoIterator<Item = Pixel<Gray4>>,
    {
        let panel = self.bounding_box();
        let (mut first, mut last) = (Point::new(i32::MAX, i32::MAX), Point::new(i32::MIN, i32::MIN));
        for Pixel(point, level) in pixels {
            if panel.contains(point) {
                self.set(point.x as usize, point.y as usize, level);
                first = first.component_min(point);
                last = last.component_max(point);
            }
        }
        if first.x > last.x {
            return Ok(());
        }
        self.flush(&Rectangle::with_corners(first, last))
    }

    /// Sends the rectangle in one go, without a look at the position of each pixel.
    fn fill_contiguous<I>(&mut self, area: &Rectangle, levels: I) -> Result<(), Self::Error>
    where
        I: IntoIterator<Item = Gray4>,
    {
        let visible = area.intersection(&self.bounding_box());
        if visible != *area {
            return self.draw_iter(area.points().zip(levels).map(|(point, level)| Pixel(point, level)));
        }
        let mut levels = levels.into_iter().fuse();
        let (left, width) = (area.top_left.x as usize, area.size.width as usize);
        'rows: for y in area.rows() {
            let y = y as usize;
            if left.is_multiple_of(2) && width.is_multiple_of(2) {
                let start = y * STRIDE + left / 2;
                for byte in &mut self.memory[start..start + width / 2] {
                    let (Some(a), b) = (levels.next(), levels.next()) else {
                        break 'rows;
                    };
                    *byte = gray4::pack(a, b.unwrap_or(Gray4::new(*byte & 0x0F)));
                }
            } else {
                for x in left..left + width {
                    let Some(level) = levels.next() else {
                        break 'rows;
                    };
                    self.set(x, y, level);
                }
            }
        }
        self.flush(area)
    }

    fn fill_solid(&mut self, area: &Rectangle, level: Gray4) -> Result<(), Self::Error> {
        let visible = area.intersection(&self.bounding_box());
        self.fill_contiguous(&visible, core::iter::repeat(level))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use core::{cell::RefCell, convert::Infallible};
    use embedded_graphics::{
        mock_display::MockDisplay,
        mono_font::{MonoTextStyle, ascii::FONT_4X6},
        primitives::{Circle, PrimitiveStyle},
        text::Text,
    };
    use embedded_hal::{digital, spi};

    /// A controller's memory and address counters behind a bus, as its data sheet describes them.
    #[derive(Debug)]
    struct Controller {
        data: bool,
        command: Vec<u8>,
        columns: (usize, usize),
        rows: (usize, usize),
        at: (usize, usize),
        memory: [[u8; STRIDE]; 80],
        on: bool,
        written: usize,
        broken: bool,
    }

    impl Controller {
        fn new() -> RefCell<Self> {
            RefCell::new(Self {
                data: false,
                command: Vec::new(),
                columns: (0, STRIDE - 1),
                rows: (0, 79),
                at: (0, 0),
                memory: [[0x5A; STRIDE]; 80],
                on: false,
                written: 0,
                broken: false,
            })
        }

        fn take(&mut self, byte: u8) {
            if self.data {
                self.memory[self.at.1][self.at.0] = byte;
                self.written += 1;
                self.at.0 += 1;
                if self.at.0 > self.columns.1 {
                    self.at.0 = self.columns.0;
                    self.at.1 += 1;
                }
                if self.at.1 > self.rows.1 {
                    self.at.1 = self.rows.0;
                }
                return;
            }
            self.command.push(byte);
            match *self.command {
                [SET_COLUMN_ADDRESS, first, last] => {
                    self.columns = (first.into(), last.into());
                    self.at.0 = first.into();
                }
                [SET_ROW_ADDRESS, first, last] => {
                    self.rows = (first.into(), last.into());
                    self.at.1 = first.into();
                }
                [0xAE] => self.on = false,
                [0xAF] => self.on = true,
                [0xA4..=0xA7 | 0x84..=0x86] => {}
                [0x81 | 0xA0..=0xA2 | 0xA8 | 0xAD | 0xB1..=0xB3 | 0xBC | 0xBE | 0xBF, _] => {}
                [0xB8, _, _, _, _, _, _, _, _] => {}
                _ => return, // not complete yet
            }
            self.command.clear();
        }

        fn level(&self, x: usize, y: usize) -> u8 {
            let byte = self.memory[y][x / 2];
            if x.is_multiple_of(2) { byte >> 4 } else { byte & 15 }
        }
    }

    #[derive(Debug)]
    struct Bus<'a>(&'a RefCell<Controller>);
    #[derive(Debug)]
    struct DataCommand<'a>(&'a RefCell<Controller>);

    impl spi::ErrorType for Bus<'_> {
        type Error = spi::ErrorKind;
    }

    impl SpiDevice for Bus<'_> {
        fn transaction(&mut self, operations: &mut [spi::Operation<'_, u8>]) -> Result<(), spi::ErrorKind> {
            let mut controller = self.0.borrow_mut();
            if controller.broken {
                return Err(spi::ErrorKind::ModeFault);
            }
            for operation in operations {
                let spi::Operation::Write(bytes) = operation else { panic!("the controller cannot be read") };
                bytes.iter().for_each(|&byte| controller.take(byte));
            }
            Ok(())
        }
    }

    impl digital::ErrorType for DataCommand<'_> {
        type Error = Infallible;
    }

    impl OutputPin for DataCommand<'_> {
        fn set_low(&mut self) -> Result<(), Infallible> {
            self.0.borrow_mut().data = false;
            Ok(())
        }

        fn set_high(&mut self) -> Result<(), Infallible> {
            let mut controller = self.0.borrow_mut();
            assert!(controller.command.is_empty(), "a command lacks bytes: {:x?}", controller.command);
            controller.data = true;
            Ok(())
        }
    }

    fn display<'a>(
        controller: &'a RefCell<Controller>,
        memory: &'a mut Memory,
    ) -> Ssd0323<'a, Bus<'a>, DataCommand<'a>> {
        Ssd0323::new(Bus(controller), DataCommand(controller), memory).expect("the bus works")
    }

    /// Every pixel of the controller's memory is what an ordinary picture of the same drawing holds.
    fn assert_same(controller: &RefCell<Controller>, expected: impl Fn(usize, usize) -> u8) {
        let controller = controller.borrow();
        for y in 0..HEIGHT {
            for x in 0..WIDTH {
                assert_eq!(controller.level(x, y), expected(x, y), "at ({x}, {y})");
            }
        }
    }

    #[test]
    fn starts_cleared_and_switched_on() {
        let (controller, mut memory) = (Controller::new(), [0xFF; STRIDE * HEIGHT]);
        let _display = display(&controller, &mut memory);
        assert_same(&controller, |_, _| 0);
        assert!(controller.borrow().on);
        assert!(controller.borrow().command.is_empty());
        assert_eq!(controller.borrow().written, STRIDE * HEIGHT);
    }

    #[test]
    fn a_row_aligned_band_is_sent_once_and_nothing_else() {
        let (controller, mut memory) = (Controller::new(), [0xFF; STRIDE * HEIGHT]);
        let mut display = display(&controller, &mut memory);
        controller.borrow_mut().written = 0;
        let area = Rectangle::new(Point::new(0, 16), Size::new(128, 16));
        let level = |x: usize, y: usize| (x * 3 + y * 5) as u8 % 16;
        display
            .fill_contiguous(&area, area.points().map(|p| Gray4::new(level(p.x as usize, p.y as usize))))
            .expect("the bus works");
        assert_same(&controller, |x, y| if (16..32).contains(&y) { level(x, y) } else { 0 });
        assert_eq!(controller.borrow().written, STRIDE * 16);
    }

    #[test]
    fn any_rectangle_keeps_its_neighbours() {
        for (x, y, width, height) in [
            (1, 2, 5, 3),
            (2, 0, 5, 1),
            (3, 60, 4, 4),
            (-3, -2, 6, 5),
            (125, 62, 9, 9),
            (127, 0, 1, 64),
            (0, 0, 0, 0),
            (-5, 70, 3, 3),
        ] {
            let (controller, mut memory) = (Controller::new(), [0xFF; STRIDE * HEIGHT]);
            let mut display = display(&controller, &mut memory);
            display.clear(Gray4::new(9)).expect("the bus works");
            let area = Rectangle::new(Point::new(x, y), Size::new(width, height));
            let level = |p: Point| (p.x * 7 + p.y * 3).rem_euclid(16) as u8;
            display
                .fill_contiguous(&area, area.points().map(|p| Gray4::new(level(p))))
                .expect("the bus works");
            assert_same(&controller, |x, y| {
                let p = Point::new(x as i32, y as i32);
                if area.contains(p) { level(p) } else { 9 }
            });
        }
    }

    #[test]
    fn too_few_colours_leave_the_rest() {
        for (left, width) in [(0, 128), (10, 4), (11, 4)] {
            let (controller, mut memory) = (Controller::new(), [0xFF; STRIDE * HEIGHT]);
            let mut display = display(&controller, &mut memory);
            let area = Rectangle::new(Point::new(left, 0), Size::new(width, 4));
            let count = width as usize + 1;
            display.fill_contiguous(&area, core::iter::repeat_n(Gray4::WHITE, count)).expect("the bus works");
            let lit = area.points().take(count).collect::<Vec<_>>();
            assert_same(
                &controller,
                |x, y| {
                    if lit.contains(&Point::new(x as i32, y as i32)) { 15 } else { 0 }
                },
            );
        }
    }

    #[test]
    fn drawings_and_text_are_those_of_the_mock_display() {
        let (controller, mut memory) = (Controller::new(), [0xFF; STRIDE * HEIGHT]);
        let mut display = display(&controller, &mut memory);
        let mut mock = MockDisplay::<Gray4>::new();
        mock.set_allow_overdraw(true);
        let circle = Circle::new(Point::new(5, 9), 31).into_styled(PrimitiveStyle::with_fill(Gray4::new(6)));
        let text = Text::new("fixel", Point::new(11, 27), MonoTextStyle::new(&FONT_4X6, Gray4::WHITE));
        circle.draw(&mut display).expect("the bus works");
        circle.draw(&mut mock).expect("a mock never fails");
        text.draw(&mut display).expect("the bus works");
        text.draw(&mut mock).expect("a mock never fails");
        assert_same(&controller, |x, y| {
            let point = Point::new(x as i32, y as i32);
            let inside = x < 64;
            inside.then(|| mock.get_pixel(point)).flatten().map_or(0, |level| level.luma())
        });
    }

    #[test]
    fn pixels_outside_the_panel_are_ignored() {
        let (controller, mut memory) = (Controller::new(), [0xFF; STRIDE * HEIGHT]);
        let mut display = display(&controller, &mut memory);
        controller.borrow_mut().written = 0;
        let outside = [(-1, 0), (0, -1), (128, 0), (0, 64), (i32::MIN, i32::MAX)];
        display
            .draw_iter(outside.map(|(x, y)| Pixel(Point::new(x, y), Gray4::WHITE)))
            .expect("the bus works");
        assert_eq!(controller.borrow().written, 0);
        assert_same(&controller, |_, _| 0);
    }

    #[test]
    fn a_broken_bus_is_an_error() {
        let (controller, mut memory) = (Controller::new(), [0xFF; STRIDE * HEIGHT]);
        controller.borrow_mut().broken = true;
        let error = Ssd0323::new(Bus(&controller), DataCommand(&controller), &mut memory).err();
        assert_eq!(error, Some(Error::Spi(spi::ErrorKind::ModeFault)));
    }
}
