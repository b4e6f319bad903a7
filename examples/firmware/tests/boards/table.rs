//! What the committed tables of counts and of flash have in common.

use std::{cmp::Ordering, env};

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
pub(super) fn change(before: u64, now: u64) -> Ordering {
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
pub(super) fn made_with(table: &str) -> &str {
    table.lines().find_map(|line| line.strip_prefix("# Made with ")).unwrap_or("some rustc")
}

#[test]
fn two_percent_are_no_change_and_more_are() {
    for now in [98_000, 100_000, 102_000] {
        assert_eq!(change(100_000, now), Ordering::Equal);
    }
    assert_eq!(change(100_000, 102_001), Ordering::Greater);
    assert_eq!(change(100_000, 97_999), Ordering::Less);
}
