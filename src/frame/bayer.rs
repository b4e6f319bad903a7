//! Bayer's pattern of 8×8: in which order the pixels of a square are lit, the more of it is to be lit.
//!
//! - In: nothing.
//! - Out: a threshold for each place of the screen, whose column and row are taken modulo 8.
//! - Assumes: nothing.

/// 64 thresholds of an 8-bit level: a pixel is lit where its level is greater. Entry t of 0 … 63 is 255·(t + ½) / 64, rounded down: of
/// each 64 pixels are lit as many as the level has 64ths, to the nearest. Level 0 lights none, 254 and 255 all.
pub(crate) static BAYER: [[u8; 8]; 8] = {
    let mut pattern = [[0; 8]; 8];
    let mut i = 0;
    while i < 64 {
        let (x, y) = (i % 8, i / 8);
        // Bits of x ^ y and y, the lowest first, are the highest of t.
        let (mut t, mut bit) = (0, 0);
        while bit < 3 {
            t = t << 2 | ((x ^ y) >> bit & 1) << 1 | y >> bit & 1;
            bit += 1;
        }
        pattern[y][x] = (255 * (2 * t + 1) / 128) as u8;
        i += 1;
    }
    pattern
};
