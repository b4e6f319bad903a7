//! From RGB565 to the sixteen grey levels of the OLED, in integers.

use embedded_graphics::{
    pixelcolor::{Gray4, Rgb565},
    prelude::*,
};

/// Weight of a channel's step in 1/65536 of a grey level: 15 levels × its share of the luma of
/// ITU-R BT.601 (0.299, 0.587, 0.114) ÷ the channel's maximum (31, 63, 31), rounded to nearest.
const WEIGHT: [u32; 3] = [9482, 9159, 3615];

/// The grey level of a colour: its luma, rounded to the nearest of the sixteen levels.
///
/// Black is 0 and white is 15; three multiplies and a shift.
#[must_use]
pub fn luma(color: Rgb565) -> Gray4 {
    let sum = u32::from(color.r()) * WEIGHT[0]
        + u32::from(color.g()) * WEIGHT[1]
        + u32::from(color.b()) * WEIGHT[2];
    // At most 983 024 + 32 768 < 16 << 16: the cast loses nothing.
    Gray4::new(((sum + (1 << 15)) >> 16) as u8)
}

/// Two neighbouring pixels in the byte that the display takes: the left one in the high half.
#[must_use]
pub fn pack(left: Gray4, right: Gray4) -> u8 {
    left.luma() << 4 | right.luma()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn luma_is_the_nearest_level_of_every_colour() {
        let mut worst = 0.0f64;
        for raw in 0..=u16::MAX {
            let color = Rgb565::from(embedded_graphics::pixelcolor::raw::RawU16::new(raw));
            let exact = 15.0
                * (0.299 * f64::from(color.r()) / 31.0
                    + 0.587 * f64::from(color.g()) / 63.0
                    + 0.114 * f64::from(color.b()) / 31.0);
            worst = worst.max((f64::from(luma(color).luma()) - exact).abs());
        }
        println!("largest distance from the exact luma: {worst} levels");
        assert!(worst <= 0.5005);
        assert_eq!(luma(Rgb565::BLACK), Gray4::BLACK);
        assert_eq!(luma(Rgb565::WHITE), Gray4::WHITE);
    }

    #[test]
    fn left_pixel_is_the_high_half() {
        assert_eq!(pack(Gray4::new(0xA), Gray4::new(0x3)), 0xA3);
    }
}
