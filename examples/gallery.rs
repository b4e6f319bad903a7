//! Holds README's pictures to what the other examples draw.
//!
//! ```sh
//! cargo run --release --example gallery             # fails if a picture in examples/assets is not what was drawn
//! cargo run --release --example gallery -- --write  # puts there what was drawn, to be looked at and committed
//! ```
//!
//! Run the examples first whose pictures these are: they write to `out`. Of moving pictures every third frame is taken, and of each of
//! them what differs from the one before: a page loads them sooner.

use std::error::Error;
use std::fs::{self, File};
use std::path::Path;

/// Each picture, and whether it moves.
const PICTURES: [(&str, bool); 6] = [
    ("cube.gif", true),
    ("forest.gif", true),
    ("surfaces.png", false),
    ("flythrough.png", false),
    ("cards.png", false),
    ("displays.png", false),
];

/// Of so many frames one is taken.
const EVERY: usize = 3;

fn main() -> Result<(), Box<dyn Error>> {
    let (out, assets) = (Path::new("out"), Path::new(env!("CARGO_MANIFEST_DIR")).join("assets"));
    let is_write = std::env::args().any(|word| word == "--write");
    let mut old = Vec::new();
    for (name, moves) in PICTURES {
        let drawn = out.join(name);
        let hint =
            |error: &dyn std::fmt::Display| format!("{}: {error}: run its example first", drawn.display());
        let now = if moves { fewer(&drawn) } else { fs::read(&drawn).map_err(Into::into) };
        let now = now.map_err(|error| hint(&error))?;
        if is_write {
            fs::write(assets.join(name), &now)?;
            println!("{name}: {} bytes", now.len());
        } else if fs::read(assets.join(name)).ok().as_ref() != Some(&now) {
            old.push(name);
        }
    }
    if !old.is_empty() {
        return Err(format!("not what the examples draw: {}", old.join(", ")).into());
    }
    println!("README's {} pictures are what the examples draw", PICTURES.len());
    Ok(())
}

/// A moving picture of every third frame of one.
fn fewer(path: &Path) -> Result<Vec<u8>, Box<dyn Error>> {
    let mut options = gif::DecodeOptions::new();
    options.set_color_output(gif::ColorOutput::RGBA);
    let mut all = options.read_info(File::open(path)?)?;
    let [width, height] = [all.width(), all.height()];
    let mut bytes = Vec::new();
    let mut encoder = gif::Encoder::new(&mut bytes, width, height, &[])?;
    encoder.set_repeat(gif::Repeat::Infinite)?;
    let (mut number, mut shown) = (0, Vec::new());
    while let Some(frame) = all.read_next_frame()? {
        number += 1;
        if (number - 1) % EVERY != 0 {
            continue;
        }
        if (frame.width, frame.height) != (width, height) {
            return Err("a frame that is not of the whole picture".into());
        }
        let mut changed = changed(&frame.buffer, &shown, width.into());
        changed.delay = frame.delay * EVERY as u16;
        encoder.write_frame(&changed)?;
        shown = frame.buffer.to_vec();
    }
    drop(encoder);
    Ok(bytes)
}

/// What of a picture differs from the one before: the rectangle around it, and in that what stays is transparent.
fn changed(now: &[u8], before: &[u8], width: usize) -> gif::Frame<'static> {
    let (now, _) = now.as_chunks::<4>();
    let (before, _) = before.as_chunks::<4>();
    let differs = |i: usize| before.get(i) != now.get(i);
    let of_all = |axis: fn(usize, usize) -> usize| {
        let places = (0..now.len()).filter(|&i| differs(i)).map(|i| axis(i, width));
        places.fold((usize::MAX, 0), |(first, last), at| (first.min(at), last.max(at)))
    };
    let ((left, right), (top, bottom)) = (of_all(|i, width| i % width), of_all(|i, width| i / width));
    if left > right {
        return gif::Frame::from_rgba(1, 1, &mut [0; 4]);
    }
    let mut pixels = Vec::new();
    for y in top..=bottom {
        for x in left..=right {
            let i = y * width + x;
            pixels.extend(if differs(i) { now[i] } else { [0; 4] });
        }
    }
    let [columns, rows] = [right - left + 1, bottom - top + 1].map(|size| size as u16);
    let frame = gif::Frame::from_rgba(columns, rows, &mut pixels);
    gif::Frame { left: left as u16, top: top as u16, dispose: gif::DisposalMethod::Keep, ..frame }
}
