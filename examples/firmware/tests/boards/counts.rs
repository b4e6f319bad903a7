//! The instructions that the scenes of `bench` and `bands` take, against the table `counts.txt`: a change of speed is seen when it is made.

use std::{fmt::Write as _, fs};

use super::{
    cargo::rustc_version,
    emulator::{Board, skipped},
    table::{conclude, is_updated, judged, number, percent},
};

const TABLE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/counts.txt");

const UPDATE: &str = "FIXEL_UPDATE_COUNTS=1 cargo test --test boards counts";

/// The MPS2 boards run an instruction a nanosecond by `-icount`; the one with a Cortex-M3 runs Armv6-M code.
const BOARDS: [[Board; 2]; 2] = [
    [mps2("bench", "mps2-an385", "thumbv6m-none-eabi"), mps2("bands", "mps2-an385", "thumbv6m-none-eabi")],
    [
        mps2("bench", "mps2-an386", "thumbv7em-none-eabihf"),
        mps2("bands", "mps2-an386", "thumbv7em-none-eabihf"),
    ],
];
/// What the boards' code is made for: the table's columns.
const TARGETS: [&str; BOARDS.len()] = [BOARDS[0][0].target, BOARDS[1][0].target];

const fn mps2(program: &'static str, machine: &'static str, target: &'static str) -> Board {
    let options = &["-icount", "shift=0"];
    Board { machine, options, program, features: "mps2", target, ram: 4 << 20 }
}

/// A scene with the pixels that it covers and its instructions on each board.
#[derive(Debug, PartialEq, Eq)]
struct Row {
    scene: String,
    pixels: u64,
    instructions: [u64; BOARDS.len()],
}

/// What the boards print: `s1 pixels 12510 instructions 272080`.
fn measured() -> Vec<Row> {
    let mut rows = Vec::<Row>::new();
    for (i, programs) in BOARDS.iter().enumerate() {
        for (scene, line) in programs.iter().flat_map(Board::run).enumerate() {
            let words = line.split_whitespace().collect::<Vec<_>>();
            let [name, "pixels", pixels, "instructions", instructions] = *words else {
                panic!("{}: {line:?} is not a scene's line", TARGETS[i]);
            };
            if i == 0 {
                rows.push(Row {
                    scene: name.into(),
                    pixels: number(pixels),
                    instructions: [0; BOARDS.len()],
                });
            }
            let row = &mut rows[scene];
            assert_eq!((&*row.scene, row.pixels), (name, number(pixels)), "the boards draw the same scenes");
            row.instructions[i] = number(instructions);
        }
    }
    rows
}

fn table(rows: &[Row]) -> String {
    let mut table = format!(
        "# Instructions that a frame of each scene takes, counted under QEMU; `cargo test` compares. Rewritten by\n\
         # {UPDATE}\n\
         # Made with {}\n\
         scene      pixels",
        rustc_version()
    );
    for target in TARGETS {
        let _ = write!(table, "  {target:>21}");
    }
    for Row { scene, pixels, instructions } in rows {
        let _ = write!(table, "\n{scene:10} {pixels:6}");
        for instructions in instructions {
            let _ = write!(table, "  {instructions:>21}");
        }
    }
    table + "\n"
}

fn parsed(table: &str) -> Vec<Row> {
    let mut lines = table.lines().filter(|line| !line.starts_with('#'));
    let head = lines.next().expect("the table has a head").split_whitespace().collect::<Vec<_>>();
    assert_eq!(head, ["scene", "pixels", TARGETS[0], TARGETS[1]]);
    lines
        .map(|line| {
            let words = line.split_whitespace().collect::<Vec<_>>();
            let [scene, pixels, first, second] = *words else { panic!("{line:?} is not a row of the table") };
            Row { scene: scene.into(), pixels: number(pixels), instructions: [number(first), number(second)] }
        })
        .collect()
}

#[test]
fn the_counts_of_the_scenes_are_those_of_the_table() {
    if skipped() {
        return;
    }
    let now = measured();
    if is_updated() {
        fs::write(TABLE, table(&now)).expect("the table can be written");
    }
    let text = fs::read_to_string(TABLE).expect("the table is in this package");
    let before = parsed(&text);

    let mut report = String::from("\nInstructions a frame, and the change against counts.txt:\n");
    let mut wrong = Vec::new();
    for row in &now {
        let _ = write!(report, "{:10} {:6} px", row.scene, row.pixels);
        let old = before.iter().find(|old| old.scene == row.scene);
        if old.is_none_or(|old| old.pixels != row.pixels) {
            wrong.push(format!("{} with {} px is not in the table", row.scene, row.pixels));
        }
        for (i, target) in TARGETS.iter().enumerate() {
            let count = row.instructions[i];
            let _ = write!(report, "  {target} {count:>9}");
            if let Some(old) = old.map(|old| old.instructions[i]) {
                let _ = write!(report, " {:+6.2} %", percent(old, count));
                let what = format!("{} on {target}", row.scene);
                wrong.extend(judged(&what, "instructions", ["slower", "faster"], old, count));
            }
        }
        report.push('\n');
    }
    for old in before.iter().filter(|old| now.iter().all(|row| row.scene != old.scene)) {
        wrong.push(format!("{} is in the table, but not drawn", old.scene));
    }
    conclude(&report, &wrong, &text, UPDATE);
}

#[test]
fn the_table_reads_as_it_is_written() {
    let row = |scene: &str, pixels| Row { scene: scene.into(), pixels, instructions: [1, 23_456_789] };
    let rows = [row("s1", 12_510), row("s1_ground", 7)];
    assert_eq!(parsed(&table(&rows)), rows);
}
