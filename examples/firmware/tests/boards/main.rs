//! The boards against the desktop: the programs run under `qemu-system-arm`, and have to print the
//! checksums and to leave the picture that this machine computes.
//!
//! The instructions of `bench`'s scenes and the flash of the small programs are held against tables.
//!
//! Needs QEMU and rustup's targets thumbv6m-none-eabi, thumbv7m-none-eabi and thumbv7em-none-eabihf, and fails without;
//! `FIXEL_SKIP_BOARDS=1` skips it.

mod bands;
mod cargo;
mod counts;
mod emulator;
mod flash;
mod table;

use std::{
    fs,
    io::{BufReader, Read},
    path::Path,
};

use embedded_graphics::{
    framebuffer::{Framebuffer, buffer_size},
    image::GetPixel,
    pixelcolor::{
        Gray4,
        raw::{BigEndian, RawU4},
    },
    prelude::*,
};
use emulator::{Board, scratch, skipped};
use fixel_firmware::{
    checksum::Gray4Sum,
    scene::{BAND_ROWS, FRAMES, MICROBIT, OLED, Scene},
};

const LM3S6965EVB: Board = Board {
    machine: "lm3s6965evb",
    options: &[],
    program: "oled",
    features: "",
    target: "thumbv7m-none-eabi",
    ram: 64 << 10,
};

const MICROBIT_BOARD: Board = Board {
    machine: "microbit",
    options: &[],
    program: "microbit",
    features: "",
    target: "thumbv6m-none-eabi",
    ram: 16 << 10,
};

/// A picture in memory in the display's own format.
type Picture = Framebuffer<
    Gray4,
    RawU4,
    BigEndian,
    { OLED.width as usize },
    { OLED.height as usize },
    { buffer_size::<Gray4>(OLED.width as usize, OLED.height as usize) },
>;

/// The lines of the `oled` program and its last picture, as this machine computes them.
fn expected_oled() -> (Vec<String>, Picture) {
    let scene = Scene::new(OLED);
    let count = OLED.width as usize * BAND_ROWS;
    let (mut pixels, mut depth) = (vec![0; count], vec![0; count]);
    let mut picture = Picture::new();
    let lines = (0..FRAMES)
        .map(|frame| {
            let Ok((rgb565, gray4)) = scene.show(frame, &mut pixels, &mut depth, &mut picture);
            let mut sum = Gray4Sum::new();
            sum.add(picture.bounding_box().points().map(|point| picture.pixel(point).expect("it is inside")));
            assert_eq!(sum.finish(), gray4, "the checksum is that of what was drawn");
            format!("frame {frame} rgb565 {rgb565:08X} gray4 {gray4:08X}")
        })
        .collect();
    (lines, picture)
}

/// Width, height and RGB bytes of a binary PPM with one space or line feed between its numbers.
fn read_ppm(path: &Path) -> (u32, u32, Vec<u8>) {
    let mut file = BufReader::new(fs::File::open(path).expect("QEMU wrote the picture"));
    let mut header = Vec::<u8>::new();
    while header.iter().filter(|byte| byte.is_ascii_whitespace()).count() < 4 {
        let mut byte = [0];
        file.read_exact(&mut byte).expect("the header is whole");
        header.push(byte[0]);
    }
    let header = String::from_utf8(header).expect("the header is text");
    let fields = header.split_ascii_whitespace().collect::<Vec<_>>();
    let ["P6", width, height, "255"] = *fields else { panic!("not a PPM of 8 bits: {header:?}") };
    let mut bytes = Vec::new();
    file.read_to_end(&mut bytes).expect("the picture is whole");
    (width.parse().expect("a number"), height.parse().expect("a number"), bytes)
}

#[test]
fn the_oled_program_prints_the_desktops_checksums() {
    if skipped() {
        return;
    }
    assert_eq!(LM3S6965EVB.run(), expected_oled().0);
}

#[test]
fn the_oled_shows_the_desktops_picture() {
    if skipped() {
        return;
    }
    let (lines, expected) = expected_oled();
    let mut emulator = LM3S6965EVB.start(Some("hold"));
    for line in lines {
        assert_eq!(emulator.read_line(), Some(line));
    }
    // The program prints a frame after its last byte is in the display's memory, then waits for ever.
    emulator.execute(r#"{"execute":"screendump","arguments":{"filename":"oled.ppm"}}"#);
    let (used, size) = LM3S6965EVB.stack(&mut emulator);
    println!("oled: {used} bytes of a stack of {size} used");
    assert!(used + 1024 <= size);

    // QEMU draws each pixel as a square of 4×4, and level n as the grey 17·n.
    const MAGNIFY: u32 = 4;
    let path = scratch().join("oled.ppm");
    let (width, height, shown) = read_ppm(&path);
    assert_eq!((width, height), (OLED.width * MAGNIFY, OLED.height * MAGNIFY));
    assert_eq!(shown.len(), (width * height * 3) as usize);
    for (i, rgb) in (0..).zip(shown.chunks_exact(3)) {
        let (x, y) = (i % width / MAGNIFY, i / width / MAGNIFY);
        let level = expected.pixel(Point::new(x as i32, y as i32)).expect("it is inside");
        assert_eq!(rgb, [level.luma() * 17; 3], "pixel ({x}, {y}) of {}", path.display());
    }
    println!("{} shows the picture", path.display());
}

#[test]
fn the_microbit_program_prints_the_desktops_checksums() {
    if skipped() {
        return;
    }
    let scene = Scene::new(MICROBIT);
    // The whole frame at once, where the board draws strips.
    let count = (MICROBIT.width * MICROBIT.height) as usize;
    let (mut pixels, mut depth) = (vec![0; count], vec![0; count]);
    let expected = (0..FRAMES)
        .map(|frame| {
            let Ok(rgb565) =
                scene.frame(frame, &mut pixels, &mut depth, |_| Ok::<_, core::convert::Infallible>(()));
            format!("frame {frame} rgb565 {rgb565:08X}")
        })
        .collect::<Vec<_>>();
    assert_eq!(MICROBIT_BOARD.run(), expected);

    let mut emulator = MICROBIT_BOARD.start(Some("hold"));
    for line in expected {
        assert_eq!(emulator.read_line(), Some(line));
    }
    let (used, size) = MICROBIT_BOARD.stack(&mut emulator);
    let (_, statics) = MICROBIT_BOARD.statics();
    println!("microbit: {statics} bytes of statics, {used} of a stack of {size} used");
    assert!(used + 1024 <= size);
}
