//! Drivers on recording buses: what a display shows of a frame that is sent in bands is the frame as it is drawn at once, and how
//! much is written for it is what README.md says.
//!
//! `FIXEL_UPDATE_TABLE=1 cargo test` writes the table anew.

mod bus;
mod panels;
mod scene;

use std::cell::RefCell;
use std::fmt::Write as _;
use std::rc::Rc;
use std::{env, fs};

use bus::{Count, DataCommand, Still, Wire};
use display_interface_spi::SPIInterface;
use embassy_futures::block_on;
use epd_waveshare::{epd4in2::Epd4in2, prelude::WaveshareDisplay};
use fixel::BigEndian;
use fixel::embedded_graphics::pixelcolor::{BinaryColor, Gray8, Rgb565, raw::RawU16};
use fixel::embedded_graphics::{prelude::*, primitives::Rectangle};
use fixel_drivers::{AsyncRows, Memory, Rows};
use panels::{Colors, Paper, Ssd1306};
use scene::{ROWS, at_once, in_bands, on_top, with_list};
use ssd1306::prelude::*;
use weact_studio_epd::WeActStudio290BlackWhiteDriver;

const LCD: Size = Size::new(240, 320);
const COLOR_OLED: Size = Size::new(128, 128);
const OLED: Size = Size::new(128, 64);
const PAPER: Size = Size::new(128, 296);
const LARGE_PAPER: Size = Size::new(400, 300);

type Wired<P> = (Wire<P>, Wire<P>, DataCommand<P>);

/// A bus with a panel, to be asked and to be given to a driver, with its pin.
fn wired<P: bus::Panel>(panel: P) -> Wired<P> {
    let wire = Wire::new(panel);
    (wire.clone(), wire.clone(), DataCommand(wire))
}

/// The RGB565 numbers of a frame that is drawn at once.
fn colors(screen: Size) -> Vec<u16> {
    at_once::<Rgb565, _>(screen, |band| band.colors().map(|color| RawU16::from(color).into_inner()).collect())
}

/// The bits of a frame that is drawn at once, in grey, and dithered.
fn bits(screen: Size) -> Vec<bool> {
    at_once::<Gray8, _>(screen, |band| {
        band.dithered::<BinaryColor>().into_iter().map(BinaryColor::is_on).collect()
    })
}

/// Where `shown` differs from what it should be is said by its first pixel: a picture does not fit a message.
fn assert_same<T: PartialEq + std::fmt::Debug>(shown: &[T], expected: &[T], width: u32) {
    assert_eq!(shown.len(), expected.len());
    if let Some(i) = (0..shown.len()).find(|&i| shown[i] != expected[i]) {
        let width = width as usize;
        panic!("({}, {}) is {:?}, not {:?}", i % width, i / width, shown[i], expected[i]);
    }
}

fn st7789_shows_the_frame(wire: &Wire<Colors>) {
    wire.panel(|panel| assert_same(&panel.memory, &colors(LCD), LCD.width));
}

/// A ST7789 by mipidsi, which gathers so many bytes to a write.
fn mipidsi(buffer: &mut [u8]) -> Count {
    let (wire, spi, pin) = wired(Colors::st7789());
    let interface = mipidsi::interface::SpiInterface::new(spi, pin, buffer);
    let builder = mipidsi::Builder::new(mipidsi::models::ST7789, interface);
    let mut display = builder.init(&mut Still { is_high: false }).expect("the bus takes all");
    wire.count();
    in_bands::<Rgb565>(LCD, |band| {
        display.fill_contiguous(&band.bounding_box(), band.colors()).expect("the bus takes all");
    });
    st7789_shows_the_frame(&wire);
    wire.count()
}

fn mipidsi_rows() -> Count {
    let (wire, spi, pin) = wired(Colors::st7789());
    let mut buffer = [0; 16];
    let interface = mipidsi::interface::SpiInterface::new(spi, pin, &mut buffer);
    let builder = mipidsi::Builder::new(mipidsi::models::ST7789, interface);
    let display = builder.init(&mut Still { is_high: false }).expect("the bus takes all");
    let (spi, pin) = display.release().0.release();
    let mut rows = Rows::new(spi, pin);
    wire.count();
    in_bands::<BigEndian<Rgb565>>(LCD, |band| {
        rows.show(band.bounding_box(), band.as_bytes()).expect("the bus takes all");
    });
    st7789_shows_the_frame(&wire);
    wire.count()
}

fn mipidsi_one_window() -> Count {
    let (wire, spi, pin) = wired(Colors::st7789());
    let mut rows = Rows::new(spi, pin); // as left by any driver
    rows.open(Rectangle::new(Point::zero(), LCD)).expect("the bus takes all");
    in_bands::<BigEndian<Rgb565>>(LCD, |band| rows.send(band.as_bytes()).expect("the bus takes all"));
    st7789_shows_the_frame(&wire);
    wire.count()
}

type Lcd = lcd_async::Display<
    lcd_async::interface::SpiInterface<Wire<Colors>, DataCommand<Colors>>,
    lcd_async::models::ST7789,
    lcd_async::NoResetPin,
>;

fn lcd_async(spi: Wire<Colors>, pin: DataCommand<Colors>) -> Lcd {
    let interface = lcd_async::interface::SpiInterface::new(spi, pin);
    let builder = lcd_async::Builder::new(lcd_async::models::ST7789, interface);
    block_on(builder.init(&mut Still { is_high: false })).expect("the bus takes all")
}

fn lcd_async_raw_data() -> Count {
    let (wire, spi, pin) = wired(Colors::st7789());
    let mut display = lcd_async(spi, pin);
    wire.count();
    in_bands::<BigEndian<Rgb565>>(LCD, |band| {
        let Rectangle { top_left, size } = band.bounding_box();
        let (top, width, height) = (top_left.y as u16, size.width as u16, size.height as u16);
        block_on(display.show_raw_data(0, top, width, height, band.as_bytes())).expect("the bus takes all");
    });
    st7789_shows_the_frame(&wire);
    wire.count()
}

/// Draws a frame while it is sent; tells what begins and ends: a write with true and false, the drawing of a band as a pair of these
/// in brackets.
fn lcd_async_rows(events: Rc<RefCell<String>>, rows_of_band: u32) -> Count {
    let (wire, spi, pin) = wired(Colors::st7789());
    let (spi, pin) = lcd_async(spi, pin).release().0.release();
    let mut rows = AsyncRows::new(spi, pin);
    wire.count();
    let sends = Rc::clone(&events);
    wire.watch(move |begins| sends.borrow_mut().push(if begins { '<' } else { '>' }));
    let words = (LCD.width * rows_of_band) as usize;
    let [mut one, mut other] = [vec![0; words], vec![0; words]];
    let mut depth = vec![0; words];
    let mut memory = Memory {
        size: Size::new(LCD.width, rows_of_band),
        pixels: [&mut one, &mut other],
        depth: &mut depth,
    };
    with_list::<BigEndian<Rgb565>, _>(LCD, |list, sky| {
        let frame = rows.frame(list, LCD.height, sky, &mut memory, |band| {
            events.borrow_mut().push('d');
            on_top(band);
        });
        block_on(frame).expect("the bus takes all");
    });
    st7789_shows_the_frame(&wire);
    wire.count()
}

fn ssd1351_shows_the_frame(wire: &Wire<Colors>) {
    wire.panel(|panel| assert_same(&panel.memory, &colors(COLOR_OLED), COLOR_OLED.width));
}

fn ssd1351_graphics() -> Count {
    let (wire, spi, pin) = wired(Colors::ssd1351());
    let mode = ssd1351::builder::Builder::new().connect_interface(SPIInterface::new(spi, pin));
    let mut display: ssd1351::mode::GraphicsMode<_> = mode.into();
    display.init().expect("the bus takes all");
    wire.count();
    in_bands::<Rgb565>(COLOR_OLED, |band| {
        display.fill_contiguous(&band.bounding_box(), band.colors()).expect("the bus takes all");
    });
    ssd1351_shows_the_frame(&wire);
    wire.count()
}

fn ssd1351_raw() -> Count {
    let (wire, spi, pin) = wired(Colors::ssd1351());
    let mode = ssd1351::builder::Builder::new().connect_interface(SPIInterface::new(spi, pin));
    let mut display = mode.display.display;
    display.init().expect("the bus takes all");
    wire.count();
    in_bands::<BigEndian<Rgb565>>(COLOR_OLED, |band| {
        let top = band.bounding_box().top_left.y as u8;
        display.set_draw_area((0, top), (128, top + ROWS as u8)).expect("the bus takes all");
        display.draw(band.as_bytes()).expect("the bus takes all");
    });
    ssd1351_shows_the_frame(&wire);
    wire.count()
}

fn ssd1306_shows_the_frame(wire: &Wire<Ssd1306>) {
    wire.panel(|panel| assert_same(&panel.shown(), &bits(OLED), OLED.width));
}

/// Two frames, of which the second is counted: the window is set once.
fn ssd1306_pages<I: display_interface::WriteOnlyDataCommand>(wire: &Wire<Ssd1306>, interface: I) -> Count {
    let mut display = ssd1306::Ssd1306::new(interface, DisplaySize128x64, DisplayRotation::Rotate0);
    display.init_with_addr_mode(ssd1306::command::AddrMode::Horizontal).expect("the bus takes all");
    display.set_draw_area((0, 0), (128, 64)).expect("the bus takes all");
    for _ in 0..2 {
        wire.count();
        in_bands::<Gray8>(OLED, |band| {
            let mut pages = [0; (OLED.width * ROWS / 8) as usize];
            let pages =
                band.dithered::<BinaryColor>().pack_pages(&mut pages).expect("bands are of whole pages");
            display.draw(pages).expect("the bus takes all");
        });
        ssd1306_shows_the_frame(wire);
    }
    wire.count()
}

fn ssd1306_buffered() -> Count {
    let (wire, spi, pin) = wired(Ssd1306::new());
    let display =
        ssd1306::Ssd1306::new(SPIInterface::new(spi, pin), DisplaySize128x64, DisplayRotation::Rotate0);
    let mut display = display.into_buffered_graphics_mode();
    display.init().expect("the bus takes all");
    wire.count();
    in_bands::<Gray8>(OLED, |band| {
        display
            .fill_contiguous(&band.bounding_box(), band.dithered::<BinaryColor>())
            .expect("the buffer takes all");
    });
    display.flush().expect("the bus takes all");
    ssd1306_shows_the_frame(&wire);
    wire.count()
}

fn weact_paper() -> Count {
    let (wire, spi, pin) = wired(Paper::ssd1680());
    let [busy, reset, delay] = [false; 3].map(|is_high| Still { is_high });
    let mut display = WeActStudio290BlackWhiteDriver::new(SPIInterface::new(spi, pin), busy, reset, delay);
    display.init().expect("the bus takes all");
    wire.count();
    in_bands::<Gray8>(PAPER, |band| {
        let mut bytes = [0; (PAPER.width / 8 * ROWS) as usize];
        let bytes = band.dithered::<BinaryColor>().pack_rows(&mut bytes).expect("it is large enough");
        let Rectangle { top_left, size } = band.bounding_box();
        display
            .write_partial_bw_buffer(bytes, 0, top_left.y as u32, size.width, size.height)
            .expect("the bus takes all");
    });
    let count = wire.count();
    display.full_refresh().expect("the bus takes all");
    wire.panel(|panel| assert_same(&panel.shown, &bits(PAPER), PAPER.width));
    count
}

fn waveshare_paper() -> Count {
    let (wire, mut spi, pin) = wired(Paper::il0398());
    // Not busy is high.
    let [busy, reset, mut delay] = [true, false, false].map(|is_high| Still { is_high });
    let mut display = Epd4in2::new(&mut spi, busy, pin, reset, &mut delay, None).expect("the bus takes all");
    wire.count();
    in_bands::<Gray8>(LARGE_PAPER, |band| {
        let mut bytes = [0; (LARGE_PAPER.width / 8 * ROWS) as usize];
        let bytes = band.dithered::<BinaryColor>().pack_rows(&mut bytes).expect("it is large enough");
        let Rectangle { top_left, size } = band.bounding_box();
        let top = top_left.y as u32;
        display
            .update_partial_frame(&mut spi, &mut delay, bytes, 0, top, size.width, size.height)
            .expect("the bus takes all");
    });
    let count = wire.count();
    display.display_frame(&mut spi, &mut delay).expect("the bus takes all");
    wire.panel(|panel| assert_same(&panel.shown, &bits(LARGE_PAPER), LARGE_PAPER.width));
    count
}

/// All ways, with what each writes: every one of them shows the frame.
fn table() -> String {
    let (oled, spi, pin) = wired(Ssd1306::new());
    let ssd1306_spi = ssd1306_pages(&oled, SPIInterface::new(spi, pin));
    let oled = Wire::new(Ssd1306::new());
    let ssd1306_i2c = ssd1306_pages(&oled, ssd1306::I2CDisplayInterface::new(oled.clone()));
    let lcd = 2 * LCD.width * LCD.height;
    let color_oled = 2 * COLOR_OLED.width * COLOR_OLED.height;
    let [oled, paper, large_paper] = [OLED, PAPER, LARGE_PAPER].map(|size| size.width * size.height / 8);
    let ways = [
        (
            "mipidsi 0.10, ST7789",
            "`fill_contiguous(&area, band.colors())`, its buffer of 64 bytes",
            mipidsi(&mut [0; 64]),
            lcd,
        ),
        ("", "… of 512 bytes", mipidsi(&mut [0; 512]), lcd),
        ("", "… of 7680 bytes", mipidsi(&mut [0; 7680]), lcd),
        ("", "set up by mipidsi, then `Rows::show`", mipidsi_rows(), lcd),
        ("", "… `Rows::open` once a frame, `Rows::send`", mipidsi_one_window(), lcd),
        ("lcd-async 0.1, ST7789", "`show_raw_data`", lcd_async_raw_data(), lcd),
        ("", "set up by lcd-async, then `AsyncRows::frame`", lcd_async_rows(Rc::default(), ROWS), lcd),
        ("ssd1351 0.5", "`fill_contiguous(&area, band.colors())`", ssd1351_graphics(), color_oled),
        ("", "raw mode: `set_draw_area`, `draw`", ssd1351_raw(), color_oled),
        ("ssd1306 0.10, SPI", "`set_draw_area` once, `draw` of pages", ssd1306_spi, oled),
        ("", "buffered mode, 1 KiB of RAM: `fill_contiguous`, `flush`", ssd1306_buffered(), oled),
        ("ssd1306 0.10, I²C", "`set_draw_area` once, `draw` of pages", ssd1306_i2c, oled),
        ("weact-studio-epd 0.1, 2.9″", "`write_partial_bw_buffer`, rows of bits", weact_paper(), paper),
        ("epd-waveshare 0.6, 4.2″", "`update_partial_frame`, rows of bits", waveshare_paper(), large_paper),
    ];
    let mut table =
        String::from("| driver | way | pixels, bytes | writes | bytes |\n|---|---|---|---|---|\n");
    for (driver, way, Count { writes, bytes }, pixels) in ways {
        let _ = writeln!(table, "| {driver} | {way} | {pixels} | {writes} | {bytes} |");
    }
    table
}

#[test]
fn every_way_shows_the_frame_and_writes_what_the_readme_says() {
    const README: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/README.md");
    let table = table();
    let text = fs::read_to_string(README).expect("it is in this package");
    let start = text.find("| driver | way |").expect("the table is there");
    let end = start + text[start..].find("\n\n").map_or(text.len() - start, |end| end + 1);
    if env::var_os("FIXEL_UPDATE_TABLE").is_some() {
        fs::write(README, format!("{}{table}{}", &text[..start], &text[end..])).expect("it can be written");
    } else {
        assert_eq!(&text[start..end], table, "FIXEL_UPDATE_TABLE=1 cargo test writes it anew");
    }
}

#[test]
fn a_band_is_drawn_while_the_one_before_is_sent() {
    let events = Rc::new(RefCell::new(String::new()));
    lcd_async_rows(Rc::clone(&events), 64);
    // The first band, the five writes that open the screen, then four in the last of which nothing is drawn.
    assert_eq!(*events.borrow(), ["d", "<><><><><>", "<d>", "<d>", "<d>", "<d>", "<>"].concat());
}

#[test]
fn a_last_band_of_fewer_rows_is_sent_as_far_as_the_screen_goes() {
    for rows in [48, 100, 320, 400] {
        let Count { writes, bytes } = lcd_async_rows(Rc::default(), rows);
        assert_eq!((writes, bytes), (5 + 320_usize.div_ceil(rows as usize), 11 + 2 * 240 * 320));
    }
}

#[test]
fn a_panel_that_is_smaller_than_its_controllers_memory_shows_the_same_as_by_its_driver() {
    let area = Rectangle::new(Point::new(3, 5), Size::new(100, 30));
    let pixels: Vec<u16> = (0..3000).collect();
    let offset = (52, 40); // of panels of 135×240

    let (by_driver, spi, pin) = wired(Colors::st7789());
    let mut buffer = [0; 64];
    let interface = mipidsi::interface::SpiInterface::new(spi, pin, &mut buffer);
    let builder = mipidsi::Builder::new(mipidsi::models::ST7789, interface);
    let builder = builder.display_size(135, 240).display_offset(offset.0, offset.1);
    let mut display = builder.init(&mut Still { is_high: false }).expect("the bus takes all");
    let colors = pixels.iter().map(|&word| Rgb565::from(RawU16::new(word)));
    display.fill_contiguous(&area, colors).expect("the bus takes all");

    let (by_rows, spi, pin) = wired(Colors::st7789());
    let mut rows = Rows::new(spi, pin).with_offset(Point::new(offset.0.into(), offset.1.into()));
    let words: Vec<u16> = pixels.iter().map(|word| word.to_be()).collect();
    rows.show(area, bytemuck::cast_slice(&words)).expect("the bus takes all");

    by_driver
        .panel(|expected| by_rows.panel(|shown| assert_same(&shown.memory, &expected.memory, LCD.width)));
}

/// Not a promise of fixel's: why README.md says to give epd-waveshare's smaller panels a column and a row fewer.
#[test]
fn epd_waveshares_small_panels_take_a_window_that_is_a_byte_too_wide() {
    use epd_waveshare::epd1in54_v2::Epd1in54;
    let window = |width, height| {
        let (wire, mut spi, pin) = wired(Paper::ssd1680());
        let [busy, reset, mut delay] = [false; 3].map(|is_high| Still { is_high });
        let mut display =
            Epd1in54::new(&mut spi, busy, pin, reset, &mut delay, None).expect("the bus takes all");
        display
            .update_partial_frame(&mut spi, &mut delay, &[], 0, 0, width, height)
            .expect("the bus takes all");
        wire.panel(Paper::window)
    };
    assert_eq!(window(200, 16), [26, 17]);
    assert_eq!(window(199, 15), [25, 16]);
}
