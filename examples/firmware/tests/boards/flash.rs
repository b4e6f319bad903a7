//! The flash of the small programs, against the table `flash.txt`; and what they must not link, by the names of their functions.

use std::{collections::BTreeSet, fmt::Write as _, fs, path::Path};

use object::{Object, ObjectSection, ObjectSymbol, SymbolKind};

use super::{
    cargo::{self, rustc_version},
    emulator::skipped,
    table::{self, conclude, is_updated, number, percent},
};

const TABLE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/flash.txt");

const UPDATE: &str = "FIXEL_UPDATE_COUNTS=1 cargo test --test boards flash";

const PROGRAMS: [&str; 5] = ["flat", "textured", "textured_lit", "glass", "all"];

const TARGETS: [&str; 2] = ["thumbv6m-none-eabi", "thumbv7em-none-eabihf"];

/// With these a function's name has its type arguments. They change no code.
const FLAGS: &str = "-C symbol-mangling-version=v0";

/// All that is of one kind is in the functions whose names contain this. What light arrives, all lighting asks here.
const LIGHT: &str = "fixel::scene::light::lights::Lighting>::arriving";
const LIT_OR_GOURAUD: &str = "fixel::shade::colors::";
const EXACT: &str = "fixel::shade::quality::Exact";
const AFFINE: &str = "fixel::shade::quality::Affine";
const CLAMPED: &str = "fixel::scene::texture::Texture>::fetch_clamp";
const BLENDED: &str = "fixel::shade::layered::";
const CUT_OUT: &str = "fixel::shade::cut_out::CutOut";
const FOG: &str = "fixel::shade::fog::lay_over";
const UV: &str = "fixel::raster::triangle::TriangleSetup>::set_small_uv";
const LEANING: &str = "fixel::raster::triangle::TriangleSetup>::lean_by";
const COLORS: &str = "fixel::raster::triangle::TriangleSetup>::set_small_colors";
const PERSPECTIVE: &str = "fixel::shade::perspective::Perspective>::near_horizon";
const EXACT_IN_SLIVERS: &str = "fixel::raster::triangle::TriangleSetup>::resolve_in_sliver";

/// Nothing that a program draws at once can panic: what would begin one is not linked.
const PANIC: &str = "core::panicking::panic";

/// What a program must not link. `all` has each of them, which shows that they are still called so.
const FORBIDDEN: [(&str, &[&str]); 4] = [
    (
        "flat",
        &[
            LIGHT,
            LIT_OR_GOURAUD,
            EXACT,
            AFFINE,
            CLAMPED,
            BLENDED,
            CUT_OUT,
            FOG,
            UV,
            LEANING,
            COLORS,
            PERSPECTIVE,
            EXACT_IN_SLIVERS,
        ],
    ),
    (
        "textured",
        &[LIGHT, LIT_OR_GOURAUD, EXACT, AFFINE, CLAMPED, BLENDED, CUT_OUT, FOG, COLORS, EXACT_IN_SLIVERS],
    ),
    ("textured_lit", &[EXACT, AFFINE, CLAMPED, BLENDED, CUT_OUT, FOG, EXACT_IN_SLIVERS]),
    ("glass", &[LIGHT, LIT_OR_GOURAUD, EXACT, AFFINE, CLAMPED, CUT_OUT, FOG, COLORS, EXACT_IN_SLIVERS]),
];

/// What a program takes of a chip's flash, in bytes.
#[derive(Debug, PartialEq, Eq)]
struct Row {
    program: String,
    target: String,
    code: u64,
    constants: u64,
    assets: u64,
}

impl Row {
    /// What the table holds.
    fn held(&self) -> u64 {
        self.code + self.constants
    }
}

/// A program's row of the table, and the names of its functions.
fn read(program: &str, target: &str, path: &Path) -> (Row, BTreeSet<String>) {
    let elf = fs::read(path).expect("the program was built");
    let elf = object::File::parse(&*elf).expect("it is an ELF file");
    let section = |name: &str| elf.section_by_name(name).map_or(0, |section| section.size());
    let demangled = |name: &str| format!("{:#}", rustc_demangle::demangle(name));
    let symbols = || elf.symbols().map(|symbol| (demangled(symbol.name().expect("it is text")), symbol));
    let assets = symbols()
        .filter(|(name, symbol)| {
            symbol.kind() == SymbolKind::Data && name.starts_with("fixel_firmware::cube::")
        })
        .map(|(_, symbol)| symbol.size())
        .sum();
    let row = Row {
        program: program.into(),
        target: target.into(),
        code: section(".text"),
        constants: section(".rodata") + section(".data") - assets,
        assets,
    };

    // A function that is inlined wherever it is called is no symbol, but what is left of it is still named for debuggers.
    let debug = elf.section_by_name(".debug_str").expect("the profile has debug information");
    let debug = debug.data().expect("the section is whole");
    let inlined = debug
        .split(|&byte| byte == 0)
        .filter_map(|name| str::from_utf8(name).ok())
        .filter(|name| name.starts_with("_R"))
        .map(demangled);
    let functions = symbols().filter(|(_, symbol)| symbol.kind() == SymbolKind::Text).map(|(name, _)| name);
    (row, functions.chain(inlined).collect())
}

fn measured() -> Vec<(Row, BTreeSet<String>)> {
    let mut all = Vec::new();
    for target in TARGETS {
        let directory = cargo::build(&PROGRAMS, "bare", target, FLAGS);
        all.extend(PROGRAMS.map(|program| read(program, target, &directory.join(program))));
    }
    all
}

const HEAD: [&str; 5] = ["program", "target", "code", "constants", "assets"];

fn table<'a>(rows: impl IntoIterator<Item = &'a Row>) -> String {
    let mut table = format!(
        "# Bytes of flash that the small programs take, without start-up code; `cargo test` holds code and constants together.\n\
         # Rewritten by\n\
         # {UPDATE}\n\
         # Made with {}\n\
         # code: `.text`. assets: the cube's vertices and triangles, its texels, its lights. constants: the rest of `.rodata` and\n\
         # `.data`, most of it fixel's tables.\n",
        rustc_version()
    );
    let [program, target, code, constants, assets] = HEAD;
    let _ = writeln!(table, "{program:12}  {target:21}  {code:>6}  {constants:>9}  {assets:>6}");
    for Row { program, target, code, constants, assets } in rows {
        let _ = writeln!(table, "{program:12}  {target:21}  {code:>6}  {constants:>9}  {assets:>6}");
    }
    table
}

fn parsed(table: &str) -> Vec<Row> {
    let lines = table.lines().filter(|line| !line.starts_with('#'));
    let mut lines = lines.map(|line| line.split_whitespace().collect::<Vec<_>>());
    assert_eq!(lines.next().expect("the table has a head"), HEAD);
    lines
        .map(|words| {
            let [program, target, code, constants, assets] = *words else {
                panic!("{words:?} is not a row of the table")
            };
            let [code, constants, assets] = [code, constants, assets].map(number);
            Row { program: program.into(), target: target.into(), code, constants, assets }
        })
        .collect()
}

/// What is wrong with a program's flash, if anything.
fn judged(before: &Row, now: &Row) -> Option<String> {
    let what = format!("{} for {}", now.program, now.target);
    table::judged(&what, "bytes", ["larger", "smaller"], before.held(), now.held())
}

/// One test for both, as they read the same programs.
#[test]
fn the_flash_of_the_small_programs_is_that_of_the_table_and_they_link_only_what_they_name() {
    if skipped() {
        return;
    }
    let now = measured();
    if is_updated() {
        fs::write(TABLE, table(now.iter().map(|(row, _)| row))).expect("the table can be written");
    }
    let text = fs::read_to_string(TABLE).expect("the table is in this package");
    let before = parsed(&text);

    let mut report = String::from("\nBytes of flash, and the change against flash.txt:\n");
    let mut wrong = Vec::new();
    for (row, _) in &now {
        let Row { program, target, .. } = row;
        let _ = write!(report, "{program:12}  {target:21}  {:>6}", row.held());
        match before.iter().find(|old| (&old.program, &old.target) == (program, target)) {
            Some(old) => {
                let _ = write!(report, " {:+6.2} %", percent(old.held(), row.held()));
                wrong.extend(judged(old, row));
            }
            None => wrong.push(format!("{program} for {target} is not in the table")),
        }
        report.push('\n');
    }
    let is_row_of =
        |old: &Row| now.iter().any(|(row, _)| (&row.program, &row.target) == (&old.program, &old.target));
    for old in before.iter().filter(|old| !is_row_of(old)) {
        wrong.push(format!("{} for {} is in the table, but not built", old.program, old.target));
    }
    conclude(&report, &wrong, &text, UPDATE);

    for target in TARGETS {
        let linked = |program: &str, what: &str| -> Vec<&str> {
            let is_it = |row: &Row| (&*row.program, &*row.target) == (program, target);
            let (_, names) = now.iter().find(|(row, _)| is_it(row)).expect("it was built");
            names.iter().map(|name| &**name).filter(|name| name.contains(what)).collect()
        };
        for program in PROGRAMS {
            let names = linked(program, PANIC);
            assert!(names.is_empty(), "{program} for {target} can panic:\n{}", names.join("\n"));
        }
        for (program, forbidden) in FORBIDDEN {
            for what in forbidden {
                let names = linked(program, what);
                assert!(
                    names.is_empty(),
                    "{program} for {target} links {what}, which it does not name:\n{}\n\
                     What no material of a program names must not be in its flash.",
                    names.join("\n")
                );
                assert!(
                    !linked("all", what).is_empty(),
                    "`all` has no {what} for {target}: its name in {} is out of date",
                    file!()
                );
            }
        }
    }
}

#[test]
fn the_table_of_flash_reads_as_it_is_written() {
    let row = |program: &str, code| Row {
        program: program.into(),
        target: TARGETS[0].into(),
        code,
        constants: 7,
        assets: 1234,
    };
    let rows = [row("flat", 1), row("textured_lit", 123_456)];
    assert_eq!(parsed(&table(&rows)), rows);
}

#[test]
fn a_program_that_grows_or_shrinks_is_seen() {
    let row =
        |code| Row { program: "flat".into(), target: "a chip".into(), code, constants: 40_000, assets: 0 };
    assert_eq!(judged(&row(60_000), &row(62_000)), None);
    assert!(judged(&row(60_000), &row(62_001)).is_some_and(|what| what.contains("larger")));
    assert!(judged(&row(60_000), &row(57_999)).is_some_and(|what| what.contains("smaller")));
}
