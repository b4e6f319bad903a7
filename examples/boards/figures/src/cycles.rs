//! `cycles.txt`: what was counted.

use std::collections::HashMap;
use std::fs;

use crate::folder;

/// Of a frame, on a core.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Cycles {
    /// Recording the list of 240×320 pixels.
    pub(crate) list: u64,
    /// Its bands of 16 rows.
    pub(crate) bands16: u64,
    /// Its bands of 32 rows.
    pub(crate) bands32: u64,
    /// mipidsi's `fill_contiguous` of these, without the bus.
    pub(crate) driver: u64,
    /// Recording the list of 128×64 pixels.
    pub(crate) oled_list: u64,
    /// Its bands of 16 rows, dithered and packed.
    pub(crate) oled_bands: u64,
}

impl Cycles {
    /// By core.
    pub(crate) fn read() -> HashMap<String, Self> {
        let text = fs::read_to_string(folder().join("cycles.txt")).expect("it is there");
        let mut lines = text.lines().filter(|line| !line.starts_with('#'));
        let head = lines.next().expect("it has a head");
        assert_eq!(head, "core list bands:16 bands:32 driver:32 oled_list oled_bands:16 stack");
        lines
            .map(|line| {
                let (core, numbers) = line.split_once(' ').expect("a line has a core and numbers");
                let numbers: Vec<u64> =
                    numbers.split(' ').map(|word| word.parse().expect("it is a number")).collect();
                let [list, bands16, bands32, driver, oled_list, oled_bands, _] = *numbers else {
                    panic!("{line:?} is not a line of it");
                };
                (core.to_owned(), Self { list, bands16, bands32, driver, oled_list, oled_bands })
            })
            .collect()
    }
}
