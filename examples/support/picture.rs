//! What the examples share: pictures in, pictures out.

use embedded_graphics::{geometry::Dimensions, pixelcolor::Rgb565, prelude::RgbColor};
use fixel::{Band, DepthFormat, Texture};
use image::codecs::gif::{GifEncoder, Repeat};
use image::{Delay, Frame, ImageResult, RgbaImage};
use std::error::Error;
use std::fs::File;
use std::io::BufWriter;
use std::path::Path;
use std::time::Duration;

/// A decoded picture as RGB565 words.
pub struct Picture {
    texels: Vec<u16>,
    log2_width: u32,
    log2_height: u32,
}

impl Picture {
    /// Decodes a PNG, each channel times `tint`.
    #[expect(clippy::float_arithmetic, reason = "on a desktop")]
    pub fn open(path: &Path, tint: [f32; 3]) -> Result<Self, Box<dyn Error>> {
        let in_file = |error: &dyn std::fmt::Display| format!("{}: {error}", path.display());
        let image = image::open(path).map_err(|error| in_file(&error))?.into_rgb8();
        let (width, height) = image.dimensions();
        if !width.is_power_of_two() || !height.is_power_of_two() {
            return Err(in_file(&format!("{width}x{height}: a texture's sides are powers of two")).into());
        }
        let texels = image.pixels().map(|pixel| {
            let channel =
                |i: usize, max: f32| (f32::from(pixel.0[i]) / 255.0 * tint[i] * max).round().min(max) as u16;
            channel(0, 31.0) << 11 | channel(1, 63.0) << 5 | channel(2, 31.0)
        });
        let picture = Self {
            texels: texels.collect(),
            log2_width: width.trailing_zeros(),
            log2_height: height.trailing_zeros(),
        };
        picture.texture().map_err(|error| in_file(&error))?;
        Ok(picture)
    }

    /// The picture half as wide and high, so many times: each texel is the mean of four.
    #[allow(dead_code, reason = "not every example makes pictures smaller")]
    pub fn halved(mut self, times: u32) -> Result<Self, Box<dyn Error>> {
        for _ in 0..times {
            if self.log2_width == 0 || self.log2_height == 0 {
                return Err("a picture of one row or column cannot be halved".into());
            }
            let width = 1 << self.log2_width;
            let mean = |pair: &[u16], below: &[u16]| {
                let channel = |shift: u32, mask: u16| {
                    let sum: u16 = pair.iter().chain(below).map(|texel| texel >> shift & mask).sum();
                    ((sum + 2) / 4) << shift
                };
                channel(11, 31) | channel(5, 63) | channel(0, 31)
            };
            let rows = self.texels.chunks_exact(2 * width).map(|rows| rows.split_at(width));
            let halved = rows.flat_map(|(upper, lower)| {
                upper.chunks_exact(2).zip(lower.chunks_exact(2)).map(|(pair, below)| mean(pair, below))
            });
            self.texels = halved.collect();
            self.log2_width -= 1;
            self.log2_height -= 1;
        }
        Ok(self)
    }

    /// The texture that borrows it.
    pub fn texture(&self) -> Result<Texture<'_>, fixel::TextureError> {
        Texture::try_new(&self.texels, self.log2_width, self.log2_height)
    }
}

/// A band as a picture with 8 bits a channel.
pub fn rgba<D: DepthFormat>(band: &Band<'_, Rgb565, D>) -> RgbaImage {
    let size = band.bounding_box().size;
    let widen = |value: u8, bits: u32| (u32::from(value) * 255 / ((1 << bits) - 1)) as u8;
    let bytes = band.colors().flat_map(|c| [widen(c.r(), 5), widen(c.g(), 6), widen(c.b(), 5), 255]);
    RgbaImage::from_raw(size.width, size.height, bytes.collect()).unwrap_or_default()
}

/// An animated GIF that repeats.
pub struct Film {
    encoder: GifEncoder<BufWriter<File>>,
    delay: Delay,
}

impl Film {
    pub fn create(path: &Path, milliseconds_a_frame: u64) -> Result<Self, Box<dyn Error>> {
        let file = File::create(path).map_err(|error| format!("{}: {error}", path.display()))?;
        let mut encoder = GifEncoder::new_with_speed(BufWriter::new(file), 10);
        encoder.set_repeat(Repeat::Infinite)?;
        let delay = Delay::from_saturating_duration(Duration::from_millis(milliseconds_a_frame));
        Ok(Self { encoder, delay })
    }

    pub fn frame(&mut self, picture: RgbaImage) -> ImageResult<()> {
        self.encoder.encode_frame(Frame::from_parts(picture, 0, 0, self.delay))
    }
}
