//! Channels of a colour: from one number of levels to another, to the nearest, and to luma.
//!
//! - In: whole levels of a channel.
//! - Out: whole levels of another.
//! - Assumes: a level is at most the greatest one that its function names.

/// A level of 0 … `N` as one of 0 … `M`: n · M / N to the nearest.
#[inline(always)]
pub(super) const fn nearest<const N: u32, const M: u32>(n: u32) -> u32 {
    if N == M {
        return n;
    }
    let (factor, half, bits) = const {
        match (N, M) {
            // The smallest factors that do for all n: they take no load, or one.
            (31, 63) => (33, 0, 4),
            (31, 255) => (527, 23, 6),
            (63, 255) => (259, 33, 6),
            (255, 31) => (249, 1024, 11),
            (255, 63) => (253, 512, 10),
            // It is so for N up to 63 · 255: the factor is off by less than 1/1000, and no quotient comes closer to a half.
            _ => {
                assert!(N <= 63 * 255 && M <= 255);
                (((M << 23) + N / 2) / N, 1 << 22, 23)
            }
        }
    };
    (n * factor + half) >> bits
}

/// The luma of ITU-R BT.601, 0.299 red + 0.587 green + 0.114 blue, as a level of 0 … 255, to the nearest by 1/1000; of red and blue
/// of 0 … `N` and green of 0 … `G`.
#[inline(always)]
pub(super) fn luma<const N: u32, const G: u32>([red, green, blue]: [u32; 3]) -> u8 {
    // With 24 fraction bits: 255 of them and a half fit into 32. Rounded, so that N of each make 255.
    const fn weight(thousandths: u64, most: u32) -> u32 {
        let whole = 1000 * most as u64;
        ((((thousandths * 255) << 24) + whole / 2) / whole) as u32
    }
    let [of_red, of_green, of_blue] = const { [weight(299, N), weight(587, G), weight(114, N)] };
    ((red * of_red + green * of_green + blue * of_blue + (1 << 23)) >> 24) as u8
}

/// Red, green and blue of an RGB565 number.
#[inline(always)]
pub(super) fn split(bits: u16) -> [u32; 3] {
    let bits = u32::from(bits);
    [bits >> 11, bits >> 5 & 63, bits & 31]
}

/// A texel's channels times those of light, 0 … 31 · 255 for red and blue, 0 … 63 · 255 for green.
#[inline(always)]
pub(super) fn products(texel: u16, light: [u32; 3]) -> [u32; 3] {
    let texel = split(texel);
    core::array::from_fn(|i| texel[i] * light[i])
}
