//! What the examples share: pictures in, pictures out.

use embedded_graphics::{
    pixelcolor::{Rgb565, Rgb888},
    prelude::*,
};
use fixel::{Band, DepthFormat, Texture};
use std::error::Error;
use std::fs::File;
use std::io::{BufReader, BufWriter};
use std::path::Path;

/// A decoded picture as RGB565 words.
pub struct Picture {
    texels: Vec<u16>,
    log2_width: u32,
    log2_height: u32,
}

impl Picture {
    /// Decodes a PNG, or a JPEG that is named so, each channel times `tint`.
    #[expect(clippy::float_arithmetic, reason = "on a desktop")]
    pub fn open(path: &Path, tint: [f32; 3]) -> Result<Self, Box<dyn Error>> {
        let in_file = |error: &dyn std::fmt::Display| format!("{}: {error}", path.display());
        let is_jpeg = path.extension().is_some_and(|extension| extension == "jpg");
        let decoded = if is_jpeg { decode_jpeg(path) } else { decode_png(path) };
        let (width, height, pixels) = decoded.map_err(|error| in_file(&error))?;
        if !width.is_power_of_two() || !height.is_power_of_two() {
            return Err(in_file(&format!("{width}x{height}: a texture's sides are powers of two")).into());
        }
        let texels = pixels.iter().map(|pixel| {
            let channel =
                |i: usize, max: f32| (f32::from(pixel[i]) / 255.0 * tint[i] * max).round().min(max) as u16;
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

/// Width, height, and red, green and blue of each pixel.
type Decoded = (u32, u32, Vec<[u8; 3]>);

fn decode_png(path: &Path) -> Result<Decoded, Box<dyn Error>> {
    let mut decoder = png::Decoder::new(BufReader::new(File::open(path)?));
    decoder.set_transformations(png::Transformations::normalize_to_color8());
    let mut reader = decoder.read_info()?;
    let mut bytes = vec![0; reader.output_buffer_size().ok_or("too large")?];
    let info = reader.next_frame(&mut bytes)?;
    let bytes = bytes.get(..info.buffer_size()).unwrap_or_default();
    let pixels = bytes.chunks_exact(info.color_type.samples()).map(|pixel| match *pixel {
        [red, green, blue, ..] => [red, green, blue],
        [gray, ..] => [gray; 3],
        [] => [0; 3],
    });
    Ok((info.width, info.height, pixels.collect()))
}

fn decode_jpeg(path: &Path) -> Result<Decoded, Box<dyn Error>> {
    let mut decoder = zune_jpeg::JpegDecoder::new(BufReader::new(File::open(path)?));
    let bytes = decoder.decode()?; // red, green and blue unless told otherwise
    let (width, height) = decoder.dimensions().ok_or("no size")?;
    Ok((width.try_into()?, height.try_into()?, bytes.as_chunks().0.to_vec()))
}

/// A picture to be saved: red, green, blue and 255 of each pixel.
pub struct Rgba {
    size: Size,
    bytes: Vec<u8>,
}

impl Rgba {
    /// From as many colours as `size` has pixels.
    pub fn new(size: Size, colors: impl Iterator<Item = Rgb565>) -> Self {
        let widen = |value: u8, bits: u32| (u32::from(value) * 255 / ((1 << bits) - 1)) as u8;
        let bytes = colors.flat_map(|c| [widen(c.r(), 5), widen(c.g(), 6), widen(c.b(), 5), 255]);
        Self { size, bytes: bytes.collect() }
    }

    /// The same of 8 bits a channel.
    #[allow(dead_code, reason = "most examples draw RGB565")]
    pub fn of_rgb888(size: Size, colors: impl Iterator<Item = Rgb888>) -> Self {
        Self { size, bytes: colors.flat_map(|c| [c.r(), c.g(), c.b(), 255]).collect() }
    }

    /// What a band shows.
    #[allow(dead_code, reason = "cards are drawn to no band")]
    pub fn of<D: DepthFormat>(band: &Band<'_, Rgb565, D>) -> Self {
        Self::new(band.size(), band.colors())
    }

    /// Writes a PNG.
    pub fn save(&self, path: impl AsRef<Path>) -> Result<(), Box<dyn Error>> {
        let file = create(path.as_ref())?;
        let mut encoder = png::Encoder::new(file, self.size.width, self.size.height);
        encoder.set_color(png::ColorType::Rgba);
        let mut writer = encoder.write_header()?;
        writer.write_image_data(&self.bytes)?;
        Ok(writer.finish()?)
    }
}

fn create(path: &Path) -> Result<BufWriter<File>, Box<dyn Error>> {
    let file = File::create(path).map_err(|error| format!("{}: {error}", path.display()))?;
    Ok(BufWriter::new(file))
}

/// An animated GIF that repeats.
pub struct Film {
    encoder: gif::Encoder<BufWriter<File>>,
    /// In 10 ms.
    delay: u16,
}

impl Film {
    pub fn create(path: &Path, size: Size, milliseconds_a_frame: u16) -> Result<Self, Box<dyn Error>> {
        let (width, height) = (size.width.try_into()?, size.height.try_into()?);
        let mut encoder = gif::Encoder::new(create(path)?, width, height, &[])?;
        encoder.set_repeat(gif::Repeat::Infinite)?;
        Ok(Self { encoder, delay: milliseconds_a_frame / 10 })
    }

    pub fn frame(&mut self, mut picture: Rgba) -> Result<(), Box<dyn Error>> {
        let (width, height) = (picture.size.width.try_into()?, picture.size.height.try_into()?);
        // 10 of 1 … 30 for how fast the palette of 256 colours is found.
        let mut frame = gif::Frame::from_rgba_speed(width, height, &mut picture.bytes, 10);
        frame.delay = self.delay;
        Ok(self.encoder.write_frame(&frame)?)
    }
}
