//! The table: Markdown that reads well in a terminal too.

use crate::library::Library;
use crate::measure::Row;
use comfy_table::{CellAlignment, Table, presets::ASCII_MARKDOWN};
use std::fmt::Write as _;

/// Times and their ratios to the first library's, with footnotes.
#[must_use]
pub fn table(libraries: &[&dyn Library], rows: &[Row]) -> String {
    let mut footnotes = Footnotes::default();
    let mut table = Table::new();
    table.load_preset(ASCII_MARKDOWN);
    let mut header = vec!["scene".to_owned(), "what".to_owned()];
    header.extend(libraries.iter().map(|library| {
        let mark = library.difference().map(|text| footnotes.mark(library.name(), text));
        format!("{} {}{}", library.name(), library.version(), mark.unwrap_or_default()).trim_end().to_owned()
    }));
    table.set_header(header);
    for row in rows {
        let ours = row.micros.first().and_then(|micros| micros.ok());
        let mut cells = vec![row.scene.name.to_owned(), row.scene.what.to_owned()];
        cells.extend(libraries.iter().zip(&row.micros).enumerate().map(
            |(i, (library, micros))| match micros {
                Ok(micros) => {
                    let mark =
                        library.difference_in(row.scene).map(|text| footnotes.mark(library.name(), text));
                    let ratio = ours.filter(|_| i > 0).map(|ours| format!(" ({:.1}×)", micros / ours));
                    format!("{}{}{}", digits(*micros), ratio.unwrap_or_default(), mark.unwrap_or_default())
                }
                Err(reason) => footnotes.mark(library.name(), reason),
            },
        ));
        table.add_row(cells);
    }
    for column in table.column_iter_mut().skip(2) {
        column.set_cell_alignment(CellAlignment::Right);
    }
    format!(
        "µs a frame (the median of the calmest of three rounds), and how many times fixel's.\n\n{table}\n\n{}",
        footnotes.text()
    )
}

/// Three significant digits.
#[must_use]
pub fn digits(micros: f64) -> String {
    let decimals = if micros < 10.0 { 2 } else { usize::from(micros < 100.0) };
    format!("{micros:.decimals$}")
}

#[derive(Default)]
struct Footnotes {
    texts: Vec<String>,
}

impl Footnotes {
    /// The number of a footnote, raised.
    fn mark(&mut self, library: &str, text: &str) -> String {
        let text = format!("{library}: {text}.");
        let number = self.texts.iter().position(|known| *known == text).unwrap_or_else(|| {
            self.texts.push(text);
            self.texts.len() - 1
        });
        (number + 1).to_string().chars().map(raised).collect()
    }

    fn text(&self) -> String {
        self.texts.iter().enumerate().fold(String::new(), |mut text, (i, footnote)| {
            let _ = writeln!(text, "{}. {footnote}", i + 1);
            text
        })
    }
}

fn raised(digit: char) -> char {
    match digit {
        '1' => '¹',
        '2' => '²',
        '3' => '³',
        _ => char::from_u32(0x2070 + digit.to_digit(10).unwrap_or_default()).unwrap_or(digit),
    }
}
