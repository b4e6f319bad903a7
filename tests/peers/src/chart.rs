//! The chart: bars on a logarithmic axis, as SVG on a ground of its own, so that it reads on light and dark pages.

use crate::library::Library;
use crate::measure::Row;
use crate::table::digits;
use plotters::coord::Shift;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};
use std::error::Error;
use std::path::Path;

const WIDTH: u32 = 860;
const BAR: i32 = 13;
const GAP: i32 = 16;
const TOP: i32 = 84;
const BOTTOM: i32 = 40;
/// Where the axis begins and ends.
const LEFT: i32 = 180;
const RIGHT: i32 = 810;

const INK: RGBColor = RGBColor(36, 41, 47);
const PALE: RGBColor = RGBColor(216, 222, 228);
/// Told apart by those too who are colour-blind.
const COLORS: [RGBColor; 5] = [
    RGBColor(213, 94, 0),
    RGBColor(0, 114, 178),
    RGBColor(86, 180, 233),
    RGBColor(0, 158, 115),
    RGBColor(140, 149, 159),
];

type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;

/// Draws the chart into a file.
///
/// # Errors
///
/// If it cannot be written.
pub fn chart(libraries: &[&dyn Library], rows: &[Row], path: &Path) -> Result<(), Box<dyn Error>> {
    let bars: usize = rows.iter().map(|row| row.micros.iter().flatten().count()).sum();
    let height = TOP + bars as i32 * BAR + rows.len() as i32 * GAP + BOTTOM;
    let area = SVGBackend::new(path, (WIDTH, height as u32)).into_drawing_area();
    area.fill(&WHITE)?;
    let title = text(16, HPos::Left, VPos::Top).color(&INK);
    area.draw_text(
        "Time of a frame of 160 × 120 pixels, µs, on a logarithmic axis: shorter is faster",
        &title,
        (16, 14),
    )?;
    legend(&area, libraries)?;
    let axis = Axis::new(rows);
    axis.draw(&area, height - BOTTOM)?;
    let mut y = TOP;
    for row in rows {
        y += GAP / 2;
        let top = y;
        for (i, micros) in row.micros.iter().enumerate() {
            let Ok(micros) = micros else { continue };
            let end = axis.x(*micros);
            area.draw(&Rectangle::new(
                [(LEFT, y + 1), (end, y + BAR - 1)],
                COLORS[i % COLORS.len()].filled(),
            ))?;
            let value = text(11, HPos::Left, VPos::Center).color(&INK);
            area.draw_text(&digits(*micros), &value, (end + 4, y + BAR / 2))?;
            y += BAR;
        }
        let (name, what) = (text(13, HPos::Right, VPos::Bottom), text(11, HPos::Right, VPos::Top));
        let (x, middle) = (LEFT - 8, (top + y) / 2);
        area.draw_text(row.scene.name, &name.color(&INK), (x, middle - 1))?;
        area.draw_text(row.scene.what, &what.color(&INK), (x, middle + 4))?;
        y += GAP / 2;
    }
    area.present()?;
    Ok(())
}

fn text(size: i32, horizontal: HPos, vertical: VPos) -> TextStyle<'static> {
    ("sans-serif", size).into_text_style(&(WIDTH, WIDTH)).pos(Pos::new(horizontal, vertical))
}

fn legend(area: &Area<'_>, libraries: &[&dyn Library]) -> Result<(), Box<dyn Error>> {
    let mut x = 16;
    for (library, color) in libraries.iter().zip(COLORS) {
        let name = format!("{} {}", library.name(), library.version());
        let name = name.trim_end();
        area.draw(&Rectangle::new([(x, 46), (x + 12, 58)], color.filled()))?;
        area.draw_text(name, &text(13, HPos::Left, VPos::Center).color(&INK), (x + 18, 52))?;
        // Letters of this size are about 7 wide.
        x += 44 + name.len() as i32 * 7;
    }
    Ok(())
}

/// From a round time below all others to where the longest bar and its figure end.
struct Axis {
    first: f64,
    last: f64,
}

impl Axis {
    fn new(rows: &[Row]) -> Self {
        let times = || rows.iter().flat_map(|row| row.micros.iter().flatten().copied());
        let (least, most) = (times().fold(f64::MAX, f64::min), times().fold(1.0, f64::max));
        let round = ticks().filter(|&tick| tick <= least).last();
        Self { first: round.unwrap_or(least), last: most * 1.2 }
    }

    fn x(&self, micros: f64) -> i32 {
        let share = (micros / self.first).ln() / (self.last / self.first).ln();
        LEFT + (share * f64::from(RIGHT - LEFT)).round() as i32
    }

    fn draw(&self, area: &Area<'_>, bottom: i32) -> Result<(), Box<dyn Error>> {
        for micros in ticks().filter(|micros| (self.first..=self.last).contains(micros)) {
            let x = self.x(micros);
            area.draw(&PathElement::new([(x, TOP), (x, bottom)], PALE))?;
            let label = text(12, HPos::Center, VPos::Top).color(&INK);
            area.draw_text(&micros.to_string(), &label, (x, bottom + 6))?;
        }
        Ok(())
    }
}

/// Round times in microseconds, from short to long.
fn ticks() -> impl Iterator<Item = f64> {
    [0.01, 0.1, 1.0, 10.0, 100.0, 1e3, 1e4]
        .into_iter()
        .flat_map(|power| [1.0, 2.0, 5.0].map(|digit| digit * power))
}
