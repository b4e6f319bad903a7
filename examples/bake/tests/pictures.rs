//! Pictures of every kind that can be read become the texels that they should.

use fixel_bake::Picture;
use image::{DynamicImage, GrayImage, ImageBuffer, Luma, Rgb, RgbImage, Rgba, RgbaImage};
use std::path::{Path, PathBuf};

fn folder() -> PathBuf {
    let folder = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join("pictures");
    std::fs::create_dir_all(&folder).expect("a folder");
    folder
}

/// The nearest of RGB565, worked out in floating point.
fn nearest([red, green, blue]: [u8; 3]) -> u16 {
    let channel = |value: u8, most: f64| (f64::from(value) * most / 255.0).round() as u16;
    channel(red, 31.0) << 11 | channel(green, 63.0) << 5 | channel(blue, 31.0)
}

/// A picture with many colours.
fn colors(width: u32, height: u32) -> RgbImage {
    RgbImage::from_fn(width, height, |x, y| {
        Rgb([(x * 255 / width) as u8, (y * 255 / height) as u8, ((x ^ y) * 3) as u8])
    })
}

fn save(name: &str, image: &DynamicImage) -> PathBuf {
    let path = folder().join(name);
    image.save(&path).expect("the picture can be written");
    path
}

/// What is read is the same, pixel by pixel.
fn assert_exact(path: &Path, expected: impl Fn(u32, u32) -> [u8; 3]) {
    let baked = Picture::new(path).longest_side(1024).bake().expect("it can be read");
    let size = baked.size();
    assert_eq!([size.width, size.height], baked.source, "{}", path.display());
    for y in 0..size.height {
        for x in 0..size.width {
            let found = baked.texels[(y * size.width + x) as usize];
            assert_eq!(found, nearest(expected(x, y)), "{} at ({x}, {y})", path.display());
        }
    }
    assert!(baked.texture().is_ok());
}

#[test]
fn formats_without_loss_are_exact() {
    let image = colors(64, 32);
    let rgb = DynamicImage::from(image.clone());
    let at = |x, y| image.get_pixel(x, y).0;
    for name in ["rgb.png", "rgb.bmp", "rgb.tga"] {
        assert_exact(&save(name, &rgb), at);
    }
    let with_alpha = DynamicImage::from(rgb.to_rgba8());
    for name in ["rgba.png", "rgba.bmp", "rgba.tga"] {
        assert_exact(&save(name, &with_alpha), at);
    }
    // 16 bits a channel: the upper byte and its like.
    let deep = ImageBuffer::from_fn(64, 32, |x, y| {
        Rgb(image.get_pixel(x, y).0.map(|channel| u16::from(channel) * 257))
    });
    assert_exact(&save("rgb16.png", &DynamicImage::ImageRgb16(deep)), at);
    let gray = GrayImage::from_fn(64, 32, |x, y| Luma([(x * 3 + y) as u8]));
    let at_gray = |x: u32, y: u32| [(x * 3 + y) as u8; 3];
    for name in ["gray.png", "gray.tga"] {
        assert_exact(&save(name, &DynamicImage::from(gray.clone())), at_gray);
    }
    let deep = ImageBuffer::from_fn(64, 32, |x, y| Luma([(x * 3 + y) as u16 * 257]));
    assert_exact(&save("gray16.png", &DynamicImage::ImageLuma16(deep)), at_gray);
}

#[test]
fn palettes_of_1_2_4_and_8_bits_are_exact_and_may_be_transparent() {
    let palette: Vec<[u8; 3]> =
        (0..=255_u8).map(|i| [i.wrapping_mul(7), 255 - i, i.wrapping_mul(31)]).collect();
    for (bits, depth) in [
        (1, png::BitDepth::One),
        (2, png::BitDepth::Two),
        (4, png::BitDepth::Four),
        (8, png::BitDepth::Eight),
    ] {
        let count = 1_usize << bits;
        let index = |x: u32, y: u32| (x as usize * 5 + y as usize * 3) % count;
        let path = folder().join(format!("palette{bits}.png"));
        let file = std::fs::File::create(&path).expect("a file");
        let mut encoder = png::Encoder::new(file, 32, 16);
        encoder.set_color(png::ColorType::Indexed);
        encoder.set_depth(depth);
        encoder.set_palette(palette[..count].as_flattened().to_vec());
        // The first colour is transparent.
        encoder.set_trns(vec![0_u8]);
        let mut data = Vec::new();
        for y in 0..16 {
            let mut row = vec![0_u8; 32 * bits / 8];
            for x in 0..32 {
                let bit = x as usize * bits;
                row[bit / 8] |= (index(x, y) << (8 - bits - bit % 8)) as u8;
            }
            data.extend(row);
        }
        encoder
            .write_header()
            .and_then(|mut writer| writer.write_image_data(&data))
            .expect("it can be written");
        assert_exact(&path, |x, y| palette[index(x, y)]);
        let mask = Picture::new(&path).bake().expect("it can be read").mask.expect("holes");
        for y in 0..16 {
            for x in 0..32 {
                let is_there = mask[(y * 4 + x / 8) as usize] << (x % 8) & 0x80 != 0;
                assert_eq!(is_there, index(x, y) != 0);
            }
        }
    }
}

#[test]
fn progressive_jpeg_of_odd_size_is_read_and_resized() {
    let image = RgbImage::from_fn(100, 70, |x, y| Rgb([(x * 2) as u8, (y * 3) as u8, 90]));
    let path = folder().join("progressive.jpg");
    let mut encoder = jpeg_encoder::Encoder::new_file(&path, 95).expect("a file");
    encoder.set_progressive(true);
    encoder.encode(image.as_raw(), 100, 70, jpeg_encoder::ColorType::Rgb).expect("it can be written");
    assert!(
        std::fs::read(&path).expect("it is there").windows(2).any(|marker| marker == [0xff, 0xc2]),
        "it is progressive"
    );
    let baked = Picture::new(&path).bake().expect("it can be read");
    assert_eq!((baked.size().width, baked.size().height), (128, 64));
    for (x, y) in [(10, 10), (64, 32), (120, 60)] {
        let found = baked.texels[(y * 128 + x) as usize];
        // The same place of the picture, within what JPEG loses.
        let [red, green] = [(x as f64 + 0.5) * 100.0 / 128.0 * 2.0, (y as f64 + 0.5) * 70.0 / 64.0 * 3.0];
        let channels = [f64::from(found >> 11) * 255.0 / 31.0, f64::from(found >> 5 & 63) * 255.0 / 63.0];
        assert!(
            (channels[0] - red).abs() < 10.0 && (channels[1] - green).abs() < 10.0,
            "({x}, {y}): {channels:?}"
        );
    }
}

#[test]
fn pictures_of_other_sizes_are_resized_or_get_a_border() {
    let image =
        RgbaImage::from_fn(50, 20, |x, _| if x < 25 { Rgba([255, 0, 0, 255]) } else { Rgba([0, 0, 255, 0]) });
    let path = save("odd.png", &DynamicImage::from(image));
    let resized = Picture::new(&path).bake().expect("it can be read");
    assert_eq!((resized.size().width, resized.size().height), (64, 16));
    assert_eq!((resized.texels[0], resized.texels[30]), (0xf800, 0xf800));
    let mask = resized.mask.expect("half of it is not there");
    assert_eq!(&mask[..8], [0xff, 0xff, 0xff, 0xff, 0, 0, 0, 0]);
    let whole = Picture::new(&path).unresized().bake().expect("it can be read");
    assert_eq!((whole.size().width, whole.size().height), (64, 32));
    assert_eq!((whole.texels[24], whole.texels[25]), (0xf800, 0x001f));
    let small = Picture::new(&path).longest_side(8).bake().expect("it can be read");
    assert_eq!((small.size().width, small.size().height), (8, 4));
}

#[test]
fn files_of_bytes_are_read_back_by_fixel() {
    let image =
        RgbaImage::from_fn(16, 8, |x, y| Rgba([x as u8 * 16, y as u8 * 32, 7, if x == y { 0 } else { 255 }]));
    let path = save("bytes.png", &DynamicImage::from(image));
    let order =
        if cfg!(target_endian = "big") { fixel_bake::ByteOrder::Big } else { fixel_bake::ByteOrder::Little };
    let out = folder().join("out");
    let baked = Picture::new(&path).write_binaries(&out, order).expect("it can be written");
    let bytes = std::fs::read(out.join("bytes.texture")).expect("it is there");
    // At an even address.
    let words: Vec<u16> = bytes.as_chunks().0.iter().map(|pair| u16::from_ne_bytes(*pair)).collect();
    let texture = fixel::Texture::from_bytes(bytemuck::must_cast_slice(&words)).expect("a texture");
    assert_eq!(texture.size(), baked.size());
    assert!(fixel::Mask::from_bytes(&std::fs::read(out.join("bytes.mask")).expect("it is there")).is_ok());
    let other = baked.bytes(match order {
        fixel_bake::ByteOrder::Little => fixel_bake::ByteOrder::Big,
        fixel_bake::ByteOrder::Big => fixel_bake::ByteOrder::Little,
    });
    assert_eq!(fixel::Texture::from_bytes(&other).err(), Some(fixel::AssetError::ByteOrder));
}

#[test]
fn what_is_no_picture_is_refused_by_name() {
    let path = folder().join("broken.png");
    let whole = save("whole.png", &DynamicImage::from(colors(16, 16)));
    let bytes = std::fs::read(whole).expect("it is there");
    for (bytes, wanted) in [
        (&bytes[..60], "broken.png: cannot be decoded"),
        (b"hello", "broken.png: is no PNG, JPEG, BMP or TGA"),
        (b"GIF89a\x01\0\x01\0", "broken.png: is Gif; PNG, JPEG, BMP and TGA can be read"),
    ] {
        std::fs::write(&path, bytes).expect("it can be written");
        let message = Picture::new(&path).bake().expect_err("it is no picture").to_string();
        assert!(message.contains(wanted), "{message}");
    }
    let message = Picture::new(folder().join("none.png")).bake().expect_err("it is not there").to_string();
    assert!(message.contains("none.png: No such file"), "{message}");
}
