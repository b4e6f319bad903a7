//! The bytes of the OLED's sixteen grey levels.

use embedded_graphics::{pixelcolor::Gray4, prelude::*};

/// Two neighbouring pixels in the byte that the display takes: the left one in the high half.
#[must_use]
pub fn pack(left: Gray4, right: Gray4) -> u8 {
    left.luma() << 4 | right.luma()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn left_pixel_is_the_high_half() {
        assert_eq!(pack(Gray4::new(0xA), Gray4::new(0x3)), 0xA3);
    }
}
