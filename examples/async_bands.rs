//! Two bands and an async display: one is sent while the other is drawn, as with `lcd-async` and a HAL whose SPI is async.
//!
//! `cargo run --release --example async_bands` sends a frame over a simulated SPI bus to a simulated ST7789, with one band and
//! with two, says how long both took, and writes what the display shows to `out/async.png`.
//!
//! On a board the bus is the HAL's `SpiDevice`, the display a driver like [`Display`] here, and the executor that of embassy or
//! RTIC; [`frame`] stays as it is. `examples/drivers` has it as `AsyncRows`, for displays that `lcd-async` sets up.

#[path = "support/picture.rs"]
#[expect(dead_code, reason = "this example makes its own texture and no film")]
mod picture;

use embassy_futures::{block_on, join::join, yield_now};
use embedded_graphics::mono_font::{MonoTextStyle, ascii::FONT_10X20};
use embedded_graphics::pixelcolor::{Rgb565, Rgb888};
use embedded_graphics::{prelude::*, primitives::Rectangle, text::Text};
use embedded_hal_async::spi::{ErrorType, Operation, SpiDevice};
use fixel::prelude::*;
use fixel::{BigEndian, CapacityError, Gradient};
use std::cell::Cell;
use std::convert::Infallible;
use std::error::Error;

const SCREEN: Size = Size::new(240, 320);
const ROWS: u32 = 16;
const WORDS: usize = (SCREEN.width * ROWS) as usize;

type Pixels = BigEndian<Rgb565>;
type Frame<'a> = DisplayList<'a, Pixels, Depth16, 1>;

/// A display in the style of `lcd-async`: pixels are drawn elsewhere, and sent as bytes.
struct Display<Spi> {
    spi: Spi,
}

impl<Spi: SpiDevice> Display<Spi> {
    /// What is sent next goes to this area.
    async fn set_window(&mut self, area: Rectangle) -> Result<(), Spi::Error> {
        let ends = |start: i32, length: u32| {
            let [a, b] = (start as u16).to_be_bytes();
            let [c, d] = (start as u16 + length as u16 - 1).to_be_bytes();
            [a, b, c, d]
        };
        let columns = ends(area.top_left.x, area.size.width);
        let rows = ends(area.top_left.y, area.size.height);
        for (command, parameters) in [(COLUMNS, &columns[..]), (LINES, &rows[..]), (WRITE_MEMORY, &[])] {
            self.spi.transaction(&mut [Operation::Write(&[command]), Operation::Write(parameters)]).await?;
        }
        Ok(())
    }

    /// Pixels for the window, row after row. From the first poll on the DMA channel does the work.
    async fn send(&mut self, pixels: &[u8]) -> Result<(), Spi::Error> {
        self.spi.write(pixels).await
    }
}

const COLUMNS: u8 = 0x2a;
const LINES: u8 = 0x2b;
const WRITE_MEMORY: u8 = 0x2c;

/// Draws a frame and sends it: each band while the one before is on its way.
async fn frame<'m, Spi: SpiDevice>(
    list: &Frame<'_>,
    display: &mut Display<Spi>,
    [one, mut sent]: [&'m mut [u16]; 2],
    depth: &'m mut [u16],
    clock: &Clock,
) -> Result<(), Spi::Error> {
    let size = Size::new(SCREEN.width, ROWS);
    let mut band = Band::<Pixels, Depth16>::new(size, one, depth).expect("the memory is of this size");
    draw(list, 0, &mut band, clock);
    for top in (0..SCREEN.height).step_by(ROWS as usize) {
        band.swap_pixels(&mut sent).expect("both are of one size");
        display.set_window(Rectangle::new(Point::new(0, top as i32), size)).await?;
        // The borrow checker keeps the pixels from being drawn into while they are sent. A draw does not yield: the future that
        // sends stands first, so that it is under way, and it is one transfer with no command before it, which would wait for
        // the draw to end. (An executor that is driven by interrupts may send all it likes meanwhile.)
        let next = top + ROWS;
        let sending = display.send(bytemuck::must_cast_slice(sent));
        let drawing = async {
            if next < SCREEN.height {
                draw(list, next, &mut band, clock);
            }
        };
        join(sending, drawing).await.0?;
    }
    Ok(())
}

/// The same with one band: drawn, sent, drawn.
async fn frame_in_turns<Spi: SpiDevice>(
    list: &Frame<'_>,
    display: &mut Display<Spi>,
    pixels: &mut [u16],
    depth: &mut [u16],
    clock: &Clock,
) -> Result<(), Spi::Error> {
    let size = Size::new(SCREEN.width, ROWS);
    let mut band = Band::<Pixels, Depth16>::new(size, pixels, depth).expect("the memory is of this size");
    for top in (0..SCREEN.height).step_by(ROWS as usize) {
        draw(list, top, &mut band, clock);
        display.set_window(band.bounding_box()).await?;
        display.send(band.as_bytes()).await?;
    }
    Ok(())
}

/// Draws the band from row `top` on, with a line of text on top.
fn draw(list: &Frame<'_>, top: u32, band: &mut Band<'_, Pixels, Depth16>, clock: &Clock) {
    band.move_to(top);
    band.clear_to(&Gradient::new(Rgb888::CSS_STEEL_BLUE, Rgb888::CSS_MIDNIGHT_BLUE, SCREEN.height));
    list.render(top, band);
    let style = MonoTextStyle::new(&FONT_10X20, Rgb565::CSS_GOLD);
    let Ok(_) = Text::new("drawn while sent", Point::new(40, 30), style).draw(band);
    // What a chip would take: 6 cycles to clear a pixel and its depth, 50 to draw it.
    let drawn = band.depth().iter().filter(|depth| **depth > 0).count();
    clock.pass(6 * WORDS as u64 + 50 * drawn as u64);
}

static CHECKS: Texture = Texture::new(&[0xffdf, 0x4a69, 0x4a69, 0xffdf], 1, 1);
const FLOOR: Mesh = Mesh::new(
    &[
        Vertex::new(-4.0, 0.0, 4.0).uv(-16, 16),
        Vertex::new(4.0, 0.0, 4.0).uv(16, 16),
        Vertex::new(4.0, 0.0, -4.0).uv(16, -16),
        Vertex::new(-4.0, 0.0, -4.0).uv(-16, -16),
    ],
    &[[0, 1, 2], [0, 2, 3]],
);

fn record(list: &mut Frame<'_>) -> Result<(), CapacityError> {
    let camera = Camera::perspective(Turn::from_degrees(60), SCREEN)
        .at(Vec3::lit(0.0, 1.2, 0.0))
        .look_at(Vec3::lit(0.0, 0.0, -2.2), Vec3::lit(0.0, 1.0, 0.0));
    let pose = Pose::IDENTITY.rotated_y(Turn::from_degrees(20)).at(Vec3::lit(0.0, 0.0, -3.0));
    camera.draw(&FLOOR, &pose, &Material::textured(&CHECKS), list)
}

fn main() -> Result<(), Box<dyn Error>> {
    let mut vertices_and_triangles = ListMemory::<32, 16>::new();
    let mut list = Frame::new(&mut vertices_and_triangles);
    record(&mut list)?;

    let memory = || -> &'static mut [u16] { Box::leak(Box::new([0; WORDS])) }; // on a board from a `StaticCell`
    let clock = Clock::default();
    let mut display = Display { spi: Bus::new(&clock) };
    block_on(frame_in_turns(&list, &mut display, memory(), memory(), &clock))?;
    let (one, sent) = (clock.now(), display.spi.sent);
    let in_turns = display.spi.panel.clone();

    let clock = Clock::default();
    let mut display = Display { spi: Bus::new(&clock) };
    block_on(frame(&list, &mut display, [memory(), memory()], memory(), &clock))?;
    let two = clock.now();
    if display.spi.panel != in_turns {
        return Err("one band and two show different pictures".into());
    }

    let ms = |cycles: u64| format!("{}.{} ms", cycles / 125_000, cycles / 12_500 % 10);
    println!("a frame at 125 MHz on a bus of 62.5 MHz, of which sending takes {}:", ms(sent));
    println!("  {} with one band, {} with two", ms(one), ms(two));
    std::fs::create_dir_all("out")?;
    let area = (SCREEN.width * SCREEN.height) as usize;
    let mut depth = vec![0; area];
    let shown = Band::<Rgb565, Depth16>::new(SCREEN, &mut display.spi.panel, &mut depth)?;
    picture::Rgba::of(&shown).save("out/async.png")?;
    println!("wrote out/async.png");
    Ok(())
}

/// Virtual time, in cycles of the chip.
#[derive(Default)]
struct Clock(Cell<u64>);

impl Clock {
    fn now(&self) -> u64 {
        self.0.get()
    }

    fn pass(&self, cycles: u64) {
        self.0.set(self.0.get() + cycles);
    }
}

/// The simulated bus, with an ST7789 at its end. Of a transaction with several writes the first is a command.
struct Bus<'a> {
    clock: &'a Clock,
    /// Cycles that it was busy.
    sent: u64,
    command: u8,
    columns: [u16; 2],
    rows: [u16; 2],
    /// The display's memory, and how many pixels of the window are in it.
    panel: Vec<u16>,
    filled: usize,
}

impl<'a> Bus<'a> {
    /// At half of the chip's clock.
    const CYCLES_A_BYTE: u64 = 16;

    fn new(clock: &'a Clock) -> Self {
        let panel = vec![0; (SCREEN.width * SCREEN.height) as usize];
        Self { clock, sent: 0, command: 0, columns: [0; 2], rows: [0; 2], panel, filled: 0 }
    }

    fn take(&mut self, bytes: &[u8]) {
        let words = bytes.chunks_exact(2).map(|pair| u16::from_be_bytes([pair[0], pair[1]]));
        match self.command {
            WRITE_MEMORY => {
                let width = usize::from(self.columns[1] - self.columns[0] + 1);
                for word in words {
                    let (x, y) = (self.filled % width, self.filled / width);
                    let (x, y) = (x + usize::from(self.columns[0]), y + usize::from(self.rows[0]));
                    self.panel[y * SCREEN.width as usize + x] = word;
                    self.filled += 1;
                }
            }
            COLUMNS => self.columns = std::array::from_fn(|i| words.clone().nth(i).unwrap_or(0)),
            LINES => self.rows = std::array::from_fn(|i| words.clone().nth(i).unwrap_or(0)),
            _ => {}
        }
    }
}

impl ErrorType for Bus<'_> {
    type Error = Infallible;
}

impl SpiDevice for Bus<'_> {
    async fn transaction(&mut self, operations: &mut [Operation<'_, u8>]) -> Result<(), Infallible> {
        for (i, operation) in operations.iter().enumerate() {
            let Operation::Write(bytes) = operation else {
                continue;
            };
            // It starts now and needs nobody. When this is polled again it is over, or there is nothing else to do but wait.
            let cycles = Self::CYCLES_A_BYTE * bytes.len() as u64;
            let end = self.clock.now() + cycles;
            yield_now().await;
            self.clock.0.set(self.clock.now().max(end));
            self.sent += cycles;
            if i == 0 && operations.len() > 1 {
                self.command = bytes[0];
                self.filled = 0;
            } else {
                self.take(bytes);
            }
        }
        Ok(())
    }
}
