//! The texture in `assets` is what this test makes of `../assets/brick.png`; after a change of either,
//! `FIXEL_BLESS=1 cargo test --test assets` writes it anew.

use std::{env, fs, path::Path};

/// Texels of a side.
const SIDE: u32 = 32;
/// A texel is the mean of a block of so many pixels, squared …
const BLOCK: u32 = 3;
/// … of the part of the original whose first column and row this is.
const CROP: u32 = 20;
/// The original's grey that becomes black, and the range from there to white: it is a dark picture.
const LEVELS: (u32, u32) = (40, 140);
/// The colour of white: the warm tone of fired clay.
const TINT: [u32; 3] = [255, 192, 150];

/// The original's bricks, laid flat (it is transposed), tinted, as little-endian RGB565.
fn brick() -> Vec<u8> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../assets/brick.png");
    let image = image::open(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display())).to_luma8();
    let mut bytes = Vec::new();
    for y in 0..SIDE {
        for x in 0..SIDE {
            let pixel = |i| image.get_pixel(CROP + y * BLOCK + i % BLOCK, CROP + x * BLOCK + i / BLOCK).0[0];
            let sum = (0..BLOCK * BLOCK).map(|i| u32::from(pixel(i))).sum::<u32>();
            let (black, range) = (LEVELS.0 * BLOCK * BLOCK, LEVELS.1 * BLOCK * BLOCK);
            let grey = sum.saturating_sub(black).min(range);
            // round(grey / range · tint / 255 · maximum) in integers
            let channel =
                |tint: u32, maximum: u32| ((grey * tint * maximum * 2 + range * 255) / (range * 510)) as u16;
            let word = channel(TINT[0], 31) << 11 | channel(TINT[1], 63) << 5 | channel(TINT[2], 31);
            bytes.extend(word.to_le_bytes());
        }
    }
    bytes
}

#[test]
fn the_brick_texture_is_made_of_its_original() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("assets/brick.rgb565");
    if env::var_os("FIXEL_BLESS").is_some_and(|value| value == "1") {
        fs::write(&path, brick()).expect("the asset can be written");
    }
    assert!(
        fs::read(&path).expect("the asset is there") == brick(),
        "{} differs from what ../assets/brick.png gives; see this test's first lines",
        path.display()
    );
}
