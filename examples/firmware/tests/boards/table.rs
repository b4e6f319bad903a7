//! What the committed tables of counts and of flash have in common.

use std::{
    cmp::Ordering,
    env,
    io::{self, Write as _},
};

use super::cargo::rustc_version;

/// More than this is more than what another layout of the same code makes.
const TOLERANCE_PERCENT: u64 = 2;

/// True when the tables are to be written anew.
pub(super) fn is_updated() -> bool {
    env::var_os("FIXEL_UPDATE_COUNTS").is_some_and(|value| value == "1")
}

pub(super) fn number(text: &str) -> u64 {
    text.parse().unwrap_or_else(|_| panic!("{text:?} is not a number"))
}

/// Whether a number is no longer that of the table, and how it compares.
fn change(before: u64, now: u64) -> Ordering {
    if now * 100 > before * (100 + TOLERANCE_PERCENT) {
        Ordering::Greater
    } else if now * 100 < before * (100 - TOLERANCE_PERCENT) {
        Ordering::Less
    } else {
        Ordering::Equal
    }
}

pub(super) fn percent(before: u64, now: u64) -> f64 {
    (now as f64 / before as f64 - 1.0) * 100.0
}

/// The compiler that a table says it was made with.
fn made_with(table: &str) -> &str {
    table.lines().find_map(|line| line.strip_prefix("# Made with ")).unwrap_or("some rustc")
}

/// What is wrong with a number of `what`, if anything; more of it is `worse`, less is `better`.
pub(super) fn judged(
    what: &str,
    unit: &str,
    [worse, better]: [&str; 2],
    before: u64,
    now: u64,
) -> Option<String> {
    let numbers = format!("{before} → {now} {unit}");
    match change(before, now) {
        Ordering::Greater => Some(format!("{what} got {worse}: {numbers}")),
        Ordering::Less => {
            Some(format!("{what} got {better}: {numbers}; update the table, to keep what is won"))
        }
        Ordering::Equal => None,
    }
}

/// Prints the report, and fails if something is wrong. `update` is the command that writes the table anew.
pub(super) fn conclude(report: &str, wrong: &[String], table: &str, update: &str) {
    // Past the test harness's capture: the numbers are worth a look when all is well, too.
    let _ = io::stderr().write_all(report.as_bytes());
    assert!(
        wrong.is_empty(),
        "{}\n{report}The table was made with {}; this is {}. If the change is meant, in examples/firmware:\n    {update}",
        wrong.join("\n"),
        made_with(table),
        rustc_version(),
    );
}

#[test]
fn two_percent_are_no_change_and_more_are() {
    for now in [98_000, 100_000, 102_000] {
        assert_eq!(change(100_000, now), Ordering::Equal);
    }
    assert_eq!(change(100_000, 102_001), Ordering::Greater);
    assert_eq!(change(100_000, 97_999), Ordering::Less);
}
