//! What to expect of each board: the table in README.md.
//!
//! Prints it from cycles that were counted (`cycles.txt`), the buses' clocks, and the programs as they are linked. The test holds
//! README.md to it.

mod boards;
mod cycles;
mod elf;

use std::fmt::Write as _;
use std::path::Path;

use boards::{BOARDS, Board};
use cycles::Cycles;
use elf::Sizes;

/// The folder of all boards.
fn folder() -> &'static Path {
    Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/.."))
}

const HEAD: &str = "\
| board | chip, MHz | display | bus, Mbit/s | a frame drawn, thousands of cycles | … and sent, ms | frames a second | flash, bytes | RAM without stack, bytes |
|---|---|---|---|---|---|---|---|---|
";

/// A line of the table, but for what follows the linked program.
fn figures(board: &Board, cycles: &Cycles) -> String {
    let drawn = board.drawn(cycles);
    let ms = |seconds: f64| format!("{:.1}", 1000.0 * seconds);
    format!(
        "| [{0}]({0}) | {1}, {2} | {3} | {4} | {5}: {6} ms | {7} | {8:.0} |",
        board.folder,
        board.chip,
        board.clock / 1_000_000,
        board.display,
        board.bus.bits as f64 / 1e6,
        (drawn + 500) / 1000,
        ms(drawn as f64 / f64::from(board.clock)),
        ms(board.sent(cycles)),
        1.0 / board.frame(cycles),
    )
}

fn main() {
    let cycles = Cycles::read();
    let mut table = HEAD.to_owned();
    for board in &BOARDS {
        let Sizes { flash, ram } = Sizes::of(board);
        let _ = writeln!(table, "{} {flash} | {ram} |", figures(board, &cycles[board.core]));
    }
    print!("{table}");
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::{env, fs};

    /// Flash and RAM in the table may be off by so many percent: another release of the compiler changes them a little.
    const PERCENT: f64 = 3.0;

    #[test]
    fn the_table_in_the_readme_is_what_is_counted_and_linked() {
        let path = folder().join("README.md");
        let text = fs::read_to_string(&path).expect("it is there");
        let start = text.find("| board | chip, MHz |").expect("the table is there");
        let end = start + text[start..].find("\n\n").expect("something follows") + 1;
        let cycles = Cycles::read();
        if env::var_os("FIXEL_UPDATE_TABLE").is_some() {
            let mut table = HEAD.to_owned();
            for board in &BOARDS {
                let Sizes { flash, ram } = Sizes::of(board);
                let _ = writeln!(table, "{} {flash} | {ram} |", figures(board, &cycles[board.core]));
            }
            fs::write(path, format!("{}{table}{}", &text[..start], &text[end..])).expect("it can be written");
            return;
        }
        let lines = text[start..end].strip_prefix(HEAD).expect("its head is this").lines();
        assert_eq!(lines.clone().count(), BOARDS.len());
        let mut wrong = String::new();
        for (board, line) in BOARDS.iter().zip(lines) {
            let expected = figures(board, &cycles[board.core]);
            let Some(sizes) = line.strip_prefix(&*expected) else {
                let _ = writeln!(wrong, "{line}\nis not\n{expected} …");
                continue;
            };
            let written: Vec<f64> = sizes.split('|').filter_map(|cell| cell.trim().parse().ok()).collect();
            let Sizes { flash, ram } = Sizes::of(board);
            println!("{}: {flash} bytes of flash, {ram} of RAM", board.folder);
            let near = |&written: &f64, now: u64| (written - now as f64).abs() * 100.0 <= PERCENT * written;
            if !matches!(&*written, [f, r] if near(f, flash) && near(r, ram)) {
                let _ = writeln!(
                    wrong,
                    "{}: {flash} and {ram} bytes now, {written:?} in the table",
                    board.folder
                );
            }
        }
        assert!(wrong.is_empty(), "{wrong}FIXEL_UPDATE_TABLE=1 cargo test -p figures writes the table anew");
    }
}
