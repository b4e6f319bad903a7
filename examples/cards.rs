//! Cards that tilt and flip over a 2D interface, drawn straight to a display: no buffer at all.
//!
//! `cargo run --release --example cards` writes `out/cards.gif` and `out/cards.png` (one of its frames), and prints where
//! they are and how much was sent. `cargo run --release --example cards -- DIRECTORY` writes elsewhere.

#[allow(dead_code, reason = "the display here is no band, and the cards are drawn, not loaded")]
#[path = "support/picture.rs"]
mod picture;

use embedded_graphics::mono_font::ascii::{FONT_6X10, FONT_9X18_BOLD, FONT_10X20};
use embedded_graphics::mono_font::{MonoFont, MonoTextStyle};
use embedded_graphics::primitives::{Circle, Line, PrimitiveStyle, Rectangle, RoundedRectangle, Triangle};
use embedded_graphics::text::{Alignment, Text};
use embedded_graphics::{pixelcolor::Rgb565, prelude::*};
use fixel::prelude::*;
use fixel::{PerspectiveImage, num::I16F16};
use std::convert::Infallible;
use std::error::Error;
use std::path::PathBuf;
use std::process::ExitCode;

const SIZE: Size = Size::new(320, 240);
const FRAMES: u16 = 90;
/// Width and height of a card in texels.
const CARD: Size = Size::new(64, 96);
/// The sheet that all cards' pictures are on: 256 × 128 texels.
const SHEET: Size = Size::new(256, 128);
const SHEET_LOG2: [u32; 2] = [8, 7];
const BACK: i32 = 3;

const TABLE: Rgb565 = Rgb565::new(3, 15, 9);
const EDGE: Rgb565 = Rgb565::new(2, 10, 6);
const INK: Rgb565 = Rgb565::new(3, 6, 4);
const RED: Rgb565 = Rgb565::new(26, 6, 5);
const PAPER: Rgb565 = Rgb565::new(30, 60, 28);
const NIGHT: Rgb565 = Rgb565::new(4, 10, 12);

/// What a display on a bus does: it is told a window, and then colours. Here it counts them, and keeps what is seen.
struct Panel {
    glass: Vec<Rgb565>,
    windows: usize,
    sent: usize,
}

impl OriginDimensions for Panel {
    fn size(&self) -> Size {
        SIZE
    }
}

impl DrawTarget for Panel {
    type Color = Rgb565;
    type Error = Infallible;

    fn draw_iter<I: IntoIterator<Item = Pixel<Rgb565>>>(&mut self, pixels: I) -> Result<(), Infallible> {
        for Pixel(at, color) in pixels {
            self.fill_contiguous(&Rectangle::new(at, Size::new(1, 1)), [color])?;
        }
        Ok(())
    }

    fn fill_contiguous<I>(&mut self, area: &Rectangle, colors: I) -> Result<(), Infallible>
    where
        I: IntoIterator<Item = Rgb565>,
    {
        self.windows += 1;
        let all = self.bounding_box();
        for (at, color) in area.points().zip(colors).filter(|(at, _)| all.contains(*at)) {
            self.glass[at.y as usize * SIZE.width as usize + at.x as usize] = color;
            self.sent += 1;
        }
        Ok(())
    }
}

/// The part of the sheet with picture `i`.
fn part(i: i32) -> Rectangle {
    Rectangle::new(Point::new(CARD.width as i32 * i, 0), CARD)
}

fn fill(color: Rgb565) -> PrimitiveStyle<Rgb565> {
    PrimitiveStyle::with_fill(color)
}

fn text<D>(words: &str, at: Point, font: &MonoFont<'_>, color: Rgb565, target: &mut D) -> Result<(), D::Error>
where
    D: DrawTarget<Color = Rgb565>,
{
    let style = MonoTextStyle::new(font, color);
    Text::with_alignment(words, at, style, Alignment::Center).draw(target).map(|_| ())
}

/// A heart, a diamond or a spade, 28 × 28 around a place.
fn suit<D>(kind: i32, center: Point, target: &mut D) -> Result<(), D::Error>
where
    D: DrawTarget<Color = Rgb565>,
{
    let at = |x, y| center + Point::new(x, y);
    let color = if kind == 2 { INK } else { RED };
    if kind == 1 {
        Triangle::new(at(-12, 0), at(12, 0), at(0, -17)).into_styled(fill(color)).draw(target)?;
        return Triangle::new(at(-12, 0), at(12, 0), at(0, 17)).into_styled(fill(color)).draw(target);
    }
    let (tip, lobes) = if kind == 2 { (-16, 4) } else { (16, -5) };
    for x in [-7, 7] {
        Circle::with_center(at(x, lobes), 15).into_styled(fill(color)).draw(target)?;
    }
    Circle::with_center(at(0, lobes), 11).into_styled(fill(color)).draw(target)?;
    let shoulder = lobes + (tip - lobes).signum() * 4;
    Triangle::new(at(-13, shoulder), at(13, shoulder), at(0, tip)).into_styled(fill(color)).draw(target)?;
    if kind == 2 {
        Triangle::new(at(-6, 16), at(6, 16), at(0, 2)).into_styled(fill(color)).draw(target)?;
    }
    Ok(())
}

/// Draws the sheet's pictures: three faces and the back that they share.
fn draw_sheet(sheet: &mut Band<'_, Rgb565, NoDepth>) -> Result<(), Infallible> {
    for (i, rank) in (0..).zip(["Q", "7", "A"]) {
        let target = &mut sheet.cropped(&part(i));
        target.clear(PAPER)?;
        let frame = Rectangle::new(Point::new(2, 2), CARD - Size::new(4, 4));
        frame.into_styled(PrimitiveStyle::with_stroke(Rgb565::new(22, 44, 20), 1)).draw(target)?;
        let color = if i == 2 { INK } else { RED };
        text(rank, Point::new(12, 20), &FONT_10X20, color, target)?;
        text(rank, Point::new(52, 89), &FONT_10X20, color, target)?;
        suit(i, Point::new(32, 47), target)?;
    }
    let target = &mut sheet.cropped(&part(BACK));
    target.clear(Rgb565::new(6, 16, 20))?;
    let inside = Rectangle::new(Point::new(5, 5), CARD - Size::new(10, 10));
    let lines = &mut target.clipped(&inside);
    for x in (-96..64).step_by(8) {
        let thin = PrimitiveStyle::with_stroke(Rgb565::new(14, 34, 28), 1);
        Line::new(Point::new(x, 0), Point::new(x + 96, 96)).into_styled(thin).draw(lines)?;
        Line::new(Point::new(x + 96, 0), Point::new(x, 96)).into_styled(thin).draw(lines)?;
    }
    inside.into_styled(PrimitiveStyle::with_stroke(PAPER, 2)).draw(target)?;
    Circle::with_center(Point::new(32, 48), 30).into_styled(fill(Rgb565::new(6, 16, 20))).draw(target)?;
    text("fixel", Point::new(32, 51), &FONT_6X10, PAPER, target)
}

/// The interface below the cards.
fn draw_interface<D>(target: &mut D) -> Result<(), D::Error>
where
    D: DrawTarget<Color = Rgb565>,
{
    Rectangle::new(Point::zero(), SIZE).into_styled(fill(TABLE)).draw(target)?;
    Rectangle::new(Point::zero(), Size::new(SIZE.width, 30)).into_styled(fill(NIGHT)).draw(target)?;
    text("Your hand", Point::new(160, 20), &FONT_9X18_BOLD, PAPER, target)?;
    text("12:41", Point::new(292, 18), &FONT_6X10, PAPER, target)?;
    for x in PLACES {
        let slot = Rectangle::with_center(Point::new(160 + x, 124), Size::new(86, 126));
        RoundedRectangle::with_equal_corners(slot, Size::new(8, 8)).into_styled(fill(EDGE)).draw(target)?;
    }
    let button = Rectangle::with_center(Point::new(160, 218), Size::new(92, 26));
    RoundedRectangle::with_equal_corners(button, Size::new(13, 13)).into_styled(fill(NIGHT)).draw(target)?;
    text("Deal again", Point::new(160, 221), &FONT_6X10, PAPER, target)
}

/// Where the cards lie, in pixels from the middle.
const PLACES: [i32; 3] = [-100, 0, 100];

/// Card `i` at a time of 0 … 65535: it turns over, one card after another, and each sways a little.
fn pose(i: i32, time: u16) -> Pose {
    // 0 … 1 in 16 bits: at rest, over in a quarter of the time, at rest, and back.
    let eased = |time: u32| {
        let t = (time * 4).min(0xffff);
        let half = Turn::from_raw((t / 2) as u16).cos().to_bits(); // 1 … −1 in 14 bits
        (0x4000 - i32::from(half)) as u32 // 0 … 2¹⁵
    };
    let late = u32::from(time).saturating_sub(0x1000 * i as u32);
    let turned = eased(late) + eased(late.saturating_sub(0x8000));
    let sway = Turn::from_raw(time.wrapping_mul(2).wrapping_add(i as u16 * 0x5000));
    let tilt =
        |size: i32, turn: Turn| Turn::from_raw(((i32::from(turn.sin().to_bits()) * size) >> 14) as u16);
    // The camera is 4 away and has a pixel a 1/80.
    let place = Vec3::new(
        I16F16::from_num(PLACES[i as usize]) / 80,
        I16F16::from_bits(-(4 << 16) / 80),
        I16F16::ZERO,
    );
    Pose::IDENTITY
        .rotated_y(Turn::from_raw(0x8000_u16.wrapping_add(turned as u16)) + tilt(1800, sway))
        .rotated_x(tilt(2600, sway + Turn::from_degrees(60)))
        .rotated_z(tilt(700, sway + Turn::from_degrees(120)))
        .at(place)
}

fn main() -> ExitCode {
    match run() {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("cards: {error}");
            ExitCode::FAILURE
        }
    }
}

fn run() -> Result<(), Box<dyn Error>> {
    let directory = std::env::args_os().nth(1).map_or_else(|| PathBuf::from("out"), PathBuf::from);
    std::fs::create_dir_all(&directory)?;
    let (gif, png) = (directory.join("cards.gif"), directory.join("cards.png"));

    // On a microcontroller this is a constant in flash.
    let area = (SHEET.width * SHEET.height) as usize;
    let (mut sheet, mut no_depth) = (vec![0; area], vec![(); area]);
    draw_sheet(&mut Band::new(SHEET, &mut sheet, &mut no_depth)?)?;
    let sheet = Texture::try_new(&sheet, SHEET_LOG2[0], SHEET_LOG2[1])?;

    let camera = Camera::focal(320.0, SIZE).at(Vec3::lit(0.0, 0.0, 4.0));
    let size = [I16F16::lit("1"), I16F16::lit("1.5")];
    let mut panel = Panel { glass: vec![TABLE; (SIZE.width * SIZE.height) as usize], windows: 0, sent: 0 };
    draw_interface(&mut panel)?;
    let cards = Rectangle::new(Point::new(0, 40), Size::new(SIZE.width, 162));
    let (mut windows, mut sent) = (0, 0);
    let mut film = picture::Film::create(&gif, SIZE, 40)?;
    for frame in 0..FRAMES {
        let time = (u32::from(frame) * 65536 / u32::from(FRAMES)) as u16;
        // The interface anew where cards were.
        draw_interface(&mut panel.clipped(&cards))?;
        (panel.windows, panel.sent) = (0, 0);
        for i in 0..3 {
            PerspectiveImage::posed(&sheet, &camera, &pose(i, time), size)
                .part(&part(i))
                .back_part(&sheet, &part(BACK))
                .draw(&mut panel)?;
        }
        (windows, sent) = (windows + panel.windows, sent + panel.sent);
        let picture = picture::Rgba::new(SIZE, panel.glass.iter().copied());
        if frame == 14 {
            picture.save(&png)?;
        }
        film.frame(picture)?;
    }
    println!("wrote {}", gif.display());
    println!("wrote {}", png.display());
    let frames = usize::from(FRAMES);
    println!(
        "{FRAMES} frames of {}x{}: {} rows with {} pixels a frame for the cards, and no buffer",
        SIZE.width,
        SIZE.height,
        windows / frames,
        sent / frames
    );
    Ok(())
}
