//! Pictures: from files to texels of RGB565 and masks.

use crate::error::{BakeError, Place, read};
use crate::model::{Model, RawPicture};
use image::metadata::Orientation;
use image::{DynamicImage, ImageDecoder, ImageFormat, ImageReader, Rgba, Rgba32FImage, RgbaImage, imageops};
use std::io::Cursor;
use std::path::Path;

/// The longest side that is read.
const LONGEST: u32 = 16384;
/// The longest side of a texture.
pub(crate) const LONGEST_TEXTURE: u32 = 1024;

/// Reads a picture into a model, once.
pub(crate) fn add(path: &Path, model: &mut Model) -> Result<usize, BakeError> {
    let name = path.display().to_string();
    if let Some(known) = model.pictures.iter().position(|picture| picture.name == name) {
        return Ok(known);
    }
    let image = decode(&read(path)?, path, "")?;
    model.files.push(path.to_owned());
    model.pictures.push(RawPicture { name, image });
    Ok(model.pictures.len() - 1)
}

/// One picture with another as its alpha: that one's alpha if it has some, else how light it is.
pub(crate) fn add_with_alpha(colors: usize, alpha: usize, model: &mut Model) -> usize {
    let [colors, alpha] = [colors, alpha].map(|number| &model.pictures[number]);
    let mut image = colors.image.clone();
    let mask = imageops::resize(&alpha.image, image.width(), image.height(), imageops::FilterType::Triangle);
    let has_alpha = mask.pixels().any(|pixel| pixel[3] != 255);
    for (pixel, mask) in image.pixels_mut().zip(mask.pixels()) {
        pixel[3] = if has_alpha { mask[3] } else { mask.0[..3].iter().copied().max().unwrap_or(255) };
    }
    let name = format!("{} with {}", colors.name, alpha.name);
    model.pictures.push(RawPicture { name, image });
    model.pictures.len() - 1
}

/// Decodes a file's bytes; `part` says which part of the file they are.
pub(crate) fn decode(bytes: &[u8], path: &Path, part: &str) -> Result<RgbaImage, BakeError> {
    let error = |problem: String| Place::file(path).error(format!("{part}{problem}"));
    let format = image::guess_format(bytes).ok().or_else(|| {
        // TGA says nowhere what it is.
        ImageFormat::from_path(path).ok().filter(|format| *format == ImageFormat::Tga)
    });
    let Some(format) = format else { return Err(error("is no PNG, JPEG, BMP or TGA".into())) };
    if !format.reading_enabled() {
        return Err(error(format!("is {format:?}; PNG, JPEG, BMP and TGA can be read")));
    }
    let mut reader = ImageReader::with_format(Cursor::new(bytes), format);
    let mut limits = image::Limits::default();
    (limits.max_image_width, limits.max_image_height) = (Some(LONGEST), Some(LONGEST));
    reader.limits(limits);
    let decoded = reader.into_decoder().and_then(|mut decoder| {
        let orientation = decoder.orientation().unwrap_or(Orientation::NoTransforms);
        let mut image = DynamicImage::from_decoder(decoder)?;
        image.apply_orientation(orientation);
        Ok(image.into_rgba8())
    });
    let image = decoded.map_err(|problem| error(format!("cannot be decoded: {problem}")))?;
    if image.width() == 0 || image.height() == 0 {
        return Err(error("has no pixels".into()));
    }
    Ok(image)
}

/// What a picture becomes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) struct Recipe {
    pub(crate) picture: usize,
    /// What its colours are multiplied by, as shown, not linear.
    pub(crate) color: [u8; 3],
    /// Texels of less alpha, of 255, are cut out.
    pub(crate) cutoff: Option<u8>,
    /// Along u and v: a mirror image follows.
    pub(crate) mirrored: [bool; 2],
    /// Whether coordinates leave the picture and it repeats there, so that no border may be put around it.
    pub(crate) repeats: bool,
    pub(crate) longest: u32,
}

/// Texels, and how a picture lies in them.
#[derive(Clone, Debug)]
pub(crate) struct Texels {
    pub(crate) size: [u32; 2],
    /// How many texels the picture has, of which a border may be left over.
    pub(crate) extent: [u32; 2],
    pub(crate) words: Vec<u16>,
    /// A bit a texel, if some are cut out.
    pub(crate) mask: Option<Vec<u8>>,
    /// Whether some alpha is neither 0 nor 255.
    pub(crate) is_translucent: bool,
}

pub(crate) fn texels(source: &RgbaImage, recipe: &Recipe) -> Texels {
    let mut image = source.clone();
    if recipe.mirrored[0] {
        let (width, height) = image.dimensions();
        let mut twice = RgbaImage::new(2 * width, height);
        imageops::replace(&mut twice, &image, 0, 0);
        imageops::replace(&mut twice, &imageops::flip_horizontal(&image), width.into(), 0);
        image = twice;
    }
    if recipe.mirrored[1] {
        let (width, height) = image.dimensions();
        let mut twice = RgbaImage::new(width, 2 * height);
        imageops::replace(&mut twice, &image, 0, 0);
        imageops::replace(&mut twice, &imageops::flip_vertical(&image), 0, height.into());
        image = twice;
    }
    let longest = 1 << recipe.longest.clamp(1, LONGEST_TEXTURE).ilog2();
    let given = [image.width(), image.height()];
    let fits = given.iter().all(|side| side.next_power_of_two() <= longest);
    let (size, extent) = if fits && !recipe.repeats {
        // All pixels stay as they are, and the last ones go on to the border.
        (given.map(u32::next_power_of_two), given)
    } else {
        let most = given[0].max(given[1]);
        let size = given.map(|side| {
            // Of the same shape, as far as powers of two can be.
            let ideal = f64::from(side) * (f64::from(longest) / f64::from(most)).min(1.0);
            (1 << (ideal.log2().round().max(0.0) as u32)).min(longest)
        });
        (size, size)
    };
    if extent != given {
        image = resized(&image, extent);
    }
    let factor = recipe.color.map(linear);
    let is_tinted = recipe.color != [255; 3];
    let is_translucent = image.pixels().any(|pixel| !matches!(pixel[3], 0 | 255));
    let [width, height] = size;
    let (mut words, mut bits) = (Vec::new(), Vec::new());
    let mut is_cut = false;
    for y in 0..height {
        let mut byte = 0;
        for x in 0..width {
            let Rgba([red, green, blue, alpha]) =
                *image.get_pixel(x.min(extent[0] - 1), y.min(extent[1] - 1));
            let mut color = [red, green, blue];
            if is_tinted {
                color = [0, 1, 2].map(|i| shown(linear(color[i]) * factor[i]));
            }
            words.push(rgb565(color));
            let is_there = recipe.cutoff.is_none_or(|cutoff| alpha >= cutoff);
            is_cut |= !is_there;
            byte |= u8::from(is_there) << (7 - x % 8);
            if x % 8 == 7 || x == width - 1 {
                bits.push(byte);
                byte = 0;
            }
        }
    }
    Texels { size, extent, words, mask: is_cut.then_some(bits), is_translucent }
}

/// The nearest colour of RGB565.
pub(crate) fn rgb565([red, green, blue]: [u8; 3]) -> u16 {
    let nearest = |channel: u8, most: u16| (u16::from(channel) * most + 127) / 255;
    nearest(red, 31) << 11 | nearest(green, 63) << 5 | nearest(blue, 31)
}

/// How bright a channel of sRGB is, 0 … 1.
fn linear(channel: u8) -> f32 {
    let channel = f32::from(channel) / 255.0;
    if channel <= 0.04045 { channel / 12.92 } else { ((channel + 0.055) / 1.055).powf(2.4) }
}

/// The channel of sRGB that is so bright.
pub(crate) fn shown(linear: f32) -> u8 {
    let linear = linear.clamp(0.0, 1.0);
    let channel = if linear <= 0.003_130_8 { 12.92 * linear } else { 1.055 * linear.powf(1.0 / 2.4) - 0.055 };
    (channel * 255.0).round() as u8
}

/// The same picture in another size: light is averaged, not its code, and what is transparent counts for nothing.
fn resized(image: &RgbaImage, [width, height]: [u32; 2]) -> RgbaImage {
    let table: Vec<f32> = (0..=255).map(linear).collect();
    let light = Rgba32FImage::from_fn(image.width(), image.height(), |x, y| {
        let Rgba([red, green, blue, alpha]) = *image.get_pixel(x, y);
        let alpha = f32::from(alpha) / 255.0;
        let [red, green, blue] = [red, green, blue].map(|channel| table[usize::from(channel)] * alpha);
        Rgba([red, green, blue, alpha])
    });
    let new = imageops::resize(&light, width, height, imageops::FilterType::CatmullRom);
    RgbaImage::from_fn(width, height, |x, y| {
        let Rgba([red, green, blue, alpha]) = *new.get_pixel(x, y);
        if alpha <= 0.0 {
            return Rgba([0; 4]);
        }
        let [red, green, blue] = [red, green, blue].map(|channel| shown(channel / alpha));
        Rgba([red, green, blue, (alpha.min(1.0) * 255.0).round() as u8])
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    const PLAIN: Recipe = Recipe {
        picture: 0,
        color: [255; 3],
        cutoff: None,
        mirrored: [false; 2],
        repeats: true,
        longest: 128,
    };

    #[test]
    fn colours_are_rounded_to_the_nearest() {
        for value in 0..=255_u8 {
            let red = rgb565([value, 0, 0]) >> 11;
            let exact = f64::from(value) / 255.0 * 31.0;
            assert!((f64::from(red) - exact).abs() <= 0.5, "{value}");
            assert_eq!(shown(linear(value)), value);
        }
        assert_eq!(rgb565([255; 3]), 0xffff);
    }

    #[test]
    fn repeated_pictures_become_powers_of_two_and_others_get_a_border() {
        let image = RgbaImage::from_fn(48, 20, |x, y| Rgba([(x * 5) as u8, (y * 12) as u8, 0, 255]));
        let repeated = texels(&image, &PLAIN);
        assert_eq!((repeated.size, repeated.extent), ([64, 16], [64, 16]));
        let once = texels(&image, &Recipe { repeats: false, ..PLAIN });
        assert_eq!((once.size, once.extent), ([64, 32], [48, 20]));
        for (x, y) in [(0, 0), (47, 19), (13, 7)] {
            let Rgba([r, g, b, _]) = *image.get_pixel(x, y);
            assert_eq!(once.words[(y * 64 + x) as usize], rgb565([r, g, b]));
        }
        let large = RgbaImage::from_pixel(3000, 500, Rgba([10, 20, 30, 255]));
        let small = texels(&large, &Recipe { repeats: false, ..PLAIN });
        assert_eq!((small.size, small.extent), ([128, 16], [128, 16]));
        assert!(small.words.iter().all(|word| *word == rgb565([10, 20, 30])));
        let mirrored = texels(&image, &Recipe { mirrored: [true, false], repeats: false, ..PLAIN });
        assert_eq!((mirrored.size, mirrored.extent), ([128, 32], [96, 20]));
        assert_eq!(mirrored.words[95], mirrored.words[0]);
    }

    #[test]
    fn light_is_averaged_and_what_is_transparent_counts_for_nothing() {
        // A fine pattern of black and white is half the light: 188, not 128.
        let image = RgbaImage::from_fn(64, 64, |x, y| {
            Rgba([if (x + y) % 2 == 0 { 255 } else { 0 }; 3].map(|c| c).into_rgba(255))
        });
        let small = texels(&image, &Recipe { longest: 8, ..PLAIN });
        let middle = small.words[8 * 4 + 4];
        assert!((i32::from(middle >> 11) - 188 * 31 / 255).abs() <= 1, "{}", middle >> 11);
        // Red beside what is transparent and green stays red.
        let image = RgbaImage::from_fn(64, 64, |x, _| {
            if x % 2 == 0 { Rgba([255, 0, 0, 255]) } else { Rgba([0, 255, 0, 0]) }
        });
        let small = texels(&image, &Recipe { longest: 8, cutoff: Some(64), ..PLAIN });
        assert_eq!(small.words[8 * 4 + 4], 0xf800);
        assert!(small.mask.is_none() && small.is_translucent);
    }

    trait IntoRgba {
        fn into_rgba(self, alpha: u8) -> [u8; 4];
    }

    impl IntoRgba for [u8; 3] {
        fn into_rgba(self, alpha: u8) -> [u8; 4] {
            [self[0], self[1], self[2], alpha]
        }
    }

    #[test]
    fn a_mask_has_a_bit_for_each_texel_that_is_there() {
        let image = RgbaImage::from_fn(4, 4, |x, y| Rgba([1, 2, 3, if x == y { 0 } else { 255 }]));
        let found = texels(&image, &Recipe { cutoff: Some(128), ..PLAIN });
        assert_eq!(found.mask, Some(vec![0b0111_0000, 0b1011_0000, 0b1101_0000, 0b1110_0000]));
        let image = RgbaImage::from_fn(16, 1, |x, _| Rgba([1, 2, 3, if x == 9 { 0 } else { 255 }]));
        let found = texels(&image, &Recipe { cutoff: Some(128), ..PLAIN });
        assert_eq!(found.mask, Some(vec![0xff, 0b1011_1111]));
    }
}
