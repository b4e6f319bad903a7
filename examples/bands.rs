//! What the height of bands costs: a scene of 429 visible triangles on 240×320 pixels with depth, from a display list, in
//! bands of 1 row up to the whole screen.
//!
//! `cargo run --release --example bands` prints RAM and cycles for each height as a table, and writes a chart of them,
//! `out/bands.svg`, and the picture, `out/bands.png`. `cargo run --release --example bands -- DIRECTORY` writes elsewhere.
//!
//! The scene is `s4` of `examples/firmware`. It is drawn here at every height, and every height has to show the same bytes as
//! a frame that is drawn at once. The cycles and the bytes of the list are those of Cortex-M0+ and M4F, counted on the same
//! program: `examples/firmware/bands.txt`.

#[allow(dead_code, reason = "of the scenes it is the last that is drawn here")]
#[path = "firmware/src/bench.rs"]
mod bench;
#[allow(dead_code, reason = "pictures are written here, not read")]
#[path = "support/picture.rs"]
mod picture;
#[allow(dead_code, reason = "shared with the boards")]
#[path = "firmware/src/s4.rs"]
mod s4;

use embedded_graphics::prelude::*;
use plotters::prelude::*;
use std::convert::Infallible;
use std::error::Error;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

/// Of bands of one height, or of a frame that is drawn at once.
struct Line {
    /// `None`: at once.
    rows: Option<u32>,
    /// Pixels, depth and list, in bytes.
    ram: u32,
    m0plus: u32,
    m4f: u32,
}

fn counted() -> Result<Vec<Line>, Box<dyn Error>> {
    let lines = include_str!("firmware/bands.txt").lines().filter(|line| !line.starts_with('#'));
    lines
        .map(|line| {
            let words: Vec<&str> = line.split_whitespace().collect();
            let [rows, ram, m0plus, m4f] = words[..] else {
                return Err(format!("bands.txt: {line:?} has not four columns").into());
            };
            let rows = if rows == "whole" { None } else { Some(rows.parse()?) };
            Ok(Line { rows, ram: ram.parse()?, m0plus: m0plus.parse()?, m4f: m4f.parse()? })
        })
        .collect()
}

/// The picture in bands of some height.
fn drawn(list: &mut s4::List<'_>, rows: u32) -> Result<Vec<u16>, Box<dyn Error>> {
    let words = (s4::SIZE.width * rows) as usize;
    let (mut pixels, mut depth) = (vec![0; words], vec![0; words]);
    let mut band = bench::Deep::new(Size::new(s4::SIZE.width, rows), &mut pixels, &mut depth)?;
    let mut shown = Vec::with_capacity(s4::PIXELS);
    let Ok(()) = s4::render(list, &mut band, |band| {
        shown.extend_from_slice(band.pixels());
        Ok::<_, Infallible>(())
    });
    Ok(shown)
}

fn run(directory: &Path) -> Result<(), Box<dyn Error>> {
    std::fs::create_dir_all(directory)?;
    let (mut pixels, mut depth) = (vec![0; s4::PIXELS], vec![0; s4::PIXELS]);
    let mut frame = bench::Deep::new(s4::SIZE, &mut pixels, &mut depth)?;
    s4::draw(&mut frame);
    let mut memory = s4::Memory::new();
    let mut list = s4::List::new(&mut memory);
    s4::record(&mut list)?;
    let [vertices, triangles, draws] = list.lengths();
    println!("240 x 320 with depth: {triangles} triangles with {vertices} vertices in {draws} draws");

    let lines = counted()?;
    let whole = lines.iter().find(|line| line.rows.is_none()).ok_or("bands.txt has no whole frame")?;
    let head = ["rows", "pixels", "depth", "list", "together", "M0+, M cycles", "M4F, M cycles"];
    println!(
        "\n{:>8} {:>9} {:>9} {:>9} {:>9} {:>21} {:>21}",
        head[0], head[1], head[2], head[3], head[4], head[5], head[6]
    );
    for line in &lines {
        let rows = line.rows.unwrap_or(s4::SIZE.height);
        let shown = drawn(&mut list, rows)?;
        if shown != frame.pixels() {
            return Err(format!("bands of {rows} rows show another picture than a whole frame").into());
        }
        let pixels = s4::SIZE.width * rows * 2;
        println!(
            "{:>8} {pixels:>9} {pixels:>9} {:>9} {:>9} {:>21} {:>21}",
            line.rows.map_or("at once".into(), |rows| rows.to_string()),
            line.ram - 2 * pixels,
            line.ram,
            against(line.m0plus, whole.m0plus),
            against(line.m4f, whole.m4f),
        );
    }
    println!("\nBytes; the stack comes to that, less than 1.9 KB. Every height showed the same picture.");

    let (picture, chart) = (directory.join("bands.png"), directory.join("bands.svg"));
    picture::Rgba::of(&frame).save(&picture)?;
    draw_chart(&lines, &chart)?;
    println!("Written: {} and {}", picture.display(), chart.display());
    Ok(())
}

/// Millions of cycles, and how many more than at once.
#[expect(clippy::float_arithmetic, reason = "on a desktop")]
fn against(cycles: u32, whole: u32) -> String {
    let (cycles, whole) = (f64::from(cycles), f64::from(whole));
    format!("{:.2} ({:+.1} %)", cycles / 1e6, (cycles / whole - 1.0) * 100.0)
}

const INK: RGBColor = RGBColor(36, 41, 47);
const PALE: RGBColor = RGBColor(216, 222, 228);
/// Told apart by those too who are colour-blind.
const RAM: RGBColor = RGBColor(213, 94, 0);
const M0PLUS: RGBColor = RGBColor(0, 114, 178);
const M4F: RGBColor = RGBColor(86, 180, 233);

/// RAM, to the left, and cycles, to the right, by the height of bands.
#[expect(clippy::float_arithmetic, reason = "on a desktop")]
fn draw_chart(lines: &[Line], path: &Path) -> Result<(), Box<dyn Error>> {
    let bands: Vec<(f64, &Line)> =
        lines.iter().filter_map(|line| Some((f64::from(line.rows?), line))).collect();
    let last = bands.last().ok_or("bands.txt is empty")?.0;
    let most = |of: fn(&Line) -> u32| lines.iter().map(of).max().map_or(1.0, f64::from);
    let area = SVGBackend::new(path, (760, 420)).into_drawing_area();
    area.fill(&WHITE)?;
    let mut chart = ChartBuilder::on(&area)
        .caption("A frame of 240 × 320 with depth by the height of bands", ("sans-serif", 17).with_color(INK))
        .margin(14)
        .x_label_area_size(38)
        .y_label_area_size(52)
        .right_y_label_area_size(52)
        .build_cartesian_2d((1.0..last).log_scale().base(2.0), 0.0..most(|line| line.ram) / 1024.0 * 1.05)?
        .set_secondary_coord((1.0..last).log_scale().base(2.0), 0.0..most(|line| line.m0plus) / 1e6 * 1.05);
    let font = ("sans-serif", 13).into_text_style(&area).color(&INK);
    chart
        .configure_mesh()
        .light_line_style(WHITE)
        .bold_line_style(PALE)
        .label_style(font.clone())
        .x_desc("rows of a band")
        .y_desc("RAM without stack, KiB")
        .x_labels(10)
        .x_label_formatter(&|rows| format!("{rows:.0}"))
        .y_label_formatter(&|ram| format!("{ram:.0}"))
        .draw()?;
    chart
        .configure_secondary_axes()
        .label_style(font.clone())
        .y_label_formatter(&|cycles| format!("{cycles:.0}"))
        .y_desc("millions of cycles")
        .draw()?;
    let dots = |color: RGBColor| move |at: (f64, f64)| Circle::new(at, 3, color.filled());
    let key = |color: RGBColor| move |(x, y)| PathElement::new([(x, y), (x + 18, y)], color.stroke_width(2));
    let ram = || bands.iter().map(|(rows, line)| (*rows, f64::from(line.ram) / 1024.0));
    chart
        .draw_series(LineSeries::new(ram(), RAM.stroke_width(2)))?
        .label("RAM: pixels, depth, list")
        .legend(key(RAM));
    chart.draw_series(ram().map(dots(RAM)))?;
    let cycles = [
        (M0PLUS, "cycles, Cortex-M0+", (|line| line.m0plus) as fn(&Line) -> u32),
        (M4F, "cycles, Cortex-M4F", |line| line.m4f),
    ];
    for (color, name, of) in cycles {
        let points = || bands.iter().map(|(rows, line)| (*rows, f64::from(of(line)) / 1e6));
        chart
            .draw_secondary_series(LineSeries::new(points(), color.stroke_width(2)))?
            .label(name)
            .legend(key(color));
        chart.draw_secondary_series(points().map(dots(color)))?;
    }
    chart
        .configure_series_labels()
        .position(SeriesLabelPosition::UpperMiddle)
        .background_style(WHITE.filled())
        .border_style(PALE)
        .label_font(font)
        .draw()?;
    area.present()?;
    Ok(())
}

fn main() -> ExitCode {
    let directory = std::env::args_os().nth(1).map_or_else(|| PathBuf::from("out"), PathBuf::from);
    match run(&directory) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::FAILURE
        }
    }
}
