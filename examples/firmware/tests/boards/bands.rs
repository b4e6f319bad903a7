//! s4 on a board without room for a frame: its picture against the desktop's, its RAM against what was promised.

use std::fs;

use embedded_graphics::{
    pixelcolor::{Rgb565, Rgb888, raw::RawU16},
    prelude::*,
};
use fixel_firmware::{
    bench::Deep,
    checksum::Rgb565Sum,
    s4::{self, List, Memory},
};
use image::{Rgb, RgbImage};

use super::emulator::{Board, scratch, skipped};

const fn lm3s6965evb(features: &'static str) -> Board {
    Board {
        machine: "lm3s6965evb",
        options: &[],
        program: "bands",
        features,
        target: "thumbv7m-none-eabi",
        ram: 64 << 10,
    }
}

/// The words of a whole frame, drawn at once.
fn whole() -> Vec<u16> {
    let (mut pixels, mut depth) = (vec![0; s4::PIXELS], vec![0; s4::PIXELS]);
    s4::draw(&mut Deep::new(s4::SIZE, &mut pixels, &mut depth).expect("the slices hold it"));
    pixels
}

/// `bands.txt`: of each height of the bands, and of the frame drawn at once (0), bytes of RAM and cycles on two cores.
fn table() -> Vec<(u64, u64, [u64; 2])> {
    let text = fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/bands.txt"));
    let number = |word: &str| word.parse().unwrap_or_else(|_| panic!("{word:?} is not a number"));
    let text = text.expect("the table is in this package");
    let lines = text.lines().filter(|line| !line.starts_with('#')).map(|line| {
        let words = line.split_whitespace().collect::<Vec<_>>();
        let [rows, ram, m0plus, m4f] = *words else { panic!("{line:?} is not a row of the table") };
        (if rows == "whole" { 0 } else { number(rows) }, number(ram), [m0plus, m4f].map(number))
    });
    lines.collect()
}

#[test]
fn bands_of_16_rows_take_at_most_12_percent_more_cycles_than_a_frame_drawn_at_once_and_of_8_rows_25() {
    let cycles = |rows: u64| table().iter().find(|row| row.0 == rows).expect("the table has the height").2;
    for (rows, most) in [(16, 112), (8, 125)] {
        for (bands, whole) in cycles(rows).iter().zip(cycles(0)) {
            assert!(bands * 100 <= whole * most, "{rows} rows: {bands} cycles, and {whole} at once");
        }
    }
}

/// One test for both, as they are one program, built twice.
#[test]
fn the_bands_program_shows_a_whole_frame_in_little_ram() {
    let pixels = whole();
    let picture = RgbImage::from_fn(s4::SIZE.width, s4::SIZE.height, |x, y| {
        let color = Rgb888::from(Rgb565::from(RawU16::new(pixels[(y * s4::SIZE.width + x) as usize])));
        Rgb([color.r(), color.g(), color.b()])
    });
    fs::create_dir_all(scratch()).expect("the directory can be made");
    let path = scratch().join("s4.png");
    picture.save(&path).expect("the picture can be written");
    println!("{} shows the picture", path.display());

    if skipped() {
        return;
    }
    let mut sum = Rgb565Sum::new();
    sum.add(&pixels);
    let expected = format!("s4 rgb565 {:08X}", sum.finish());
    for (rows, features, limit) in [(16, "", 32 << 10), (8, "rows-8", 24 << 10)] {
        let board = lm3s6965evb(features);
        assert_eq!(board.run(), [&*expected], "{rows} rows");

        let mut emulator = board.start(Some("hold"));
        assert_eq!(emulator.read_line().as_ref(), Some(&expected));
        let (stack, _) = board.stack(&mut emulator);
        let (variables, statics) = board.statics();
        println!("bands of {rows} rows: {statics} bytes of statics, {stack} of stack");
        for (name, bytes) in &variables {
            println!("{bytes:>8} {name}");
        }
        // Nothing else is in RAM. The list has pointers, which are smaller there.
        let size = |what: &str| {
            let mut named = variables.iter().filter(|(name, _)| name.ends_with(what));
            named.next().unwrap_or_else(|| panic!("no {what} among the symbols")).1
        };
        let band = u64::from(s4::SIZE.width) * rows * 2;
        assert_eq!([size("::COLORS"), size("::DEPTH")], [band; 2]);
        assert!(size("::MEMORY") <= Memory::BYTES as u64);
        assert!(size("::LIST") <= List::BYTES as u64);
        assert_eq!(["::COLORS", "::DEPTH", "::MEMORY", "::LIST"].map(size).iter().sum::<u64>(), statics);
        let row = table().into_iter().find(|row| row.0 == rows).expect("the table has the height");
        assert_eq!(row.1, statics, "bytes of {rows} rows in bands.txt");
        assert!(statics + stack as u64 <= limit, "{statics} + {stack} bytes are more than {limit}");
    }
}
