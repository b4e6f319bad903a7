//! The promise: what is sent to a display of few bits is dithered by a pattern that stays on the screen, so that black, white and all
//! that the display has stay what they are, and the mean of a square is what was drawn; and its bytes are those of the display's memory.

#![allow(clippy::float_arithmetic, reason = "only the crate is to do without")]

use crate::common;

use std::convert::Infallible;

use common::for_all;
use common::scenes::{LIGHTS, TEXELS, draw, meshes, scene, surfaces};
use fixel::embedded_graphics::pixelcolor::{
    Bgr565, Bgr888, BinaryColor, Gray2, Gray4, Gray8, Rgb565, Rgb666, Rgb888,
};
use fixel::embedded_graphics::prelude::*;
use fixel::embedded_graphics::primitives::Rectangle;
use fixel::{
    Band, Depth16, DisplayList, ListMemory, Material, Mesh, NoDepth, PackError, PixelFormat, Pose, Quantize,
    QuarterPixel, Texture, Threshold, Vec3, Vertex,
};
use proptest::prelude::*;

/// Bayer's matrix as its recursion has it.
fn bayer(side: usize, x: usize, y: usize) -> usize {
    if side == 1 {
        return 0;
    }
    let half = side / 2;
    4 * bayer(half, x % half, y % half) + [[0, 2], [3, 1]][y / half][x / half]
}

/// The greatest levels of displays.
const MOSTS: [u8; 6] = [1, 3, 15, 31, 63, 255];

/// The nearest 8-bit level of a display's level.
fn in_8_bits(level: u8, most: u8) -> u8 {
    (f64::from(level) * 255.0 / f64::from(most)).round() as u8
}

#[test]
fn a_level_is_rounded_to_one_of_its_neighbours_and_whole_ones_stay_for_all_thresholds() {
    for (most, threshold) in MOSTS.into_iter().flat_map(|most| (0..=255).map(move |t| (most, t))) {
        let at = |level: u8| Threshold::new(threshold).level(level, most);
        for level in 0..=255_u8 {
            let exact = f64::from(level) * f64::from(most) / 255.0;
            assert!((f64::from(at(level)) - exact).abs() < 1.0, "{level} of {most} at {threshold}");
            assert!(level == 255 || at(level) <= at(level + 1));
        }
        for level in 0..=most {
            assert_eq!(at(in_8_bits(level, most)), level, "of {most} at {threshold}");
        }
    }
    for (most, level) in MOSTS.into_iter().flat_map(|most| (0..=255_u8).map(move |level| (most, level))) {
        let exact = f64::from(level) * f64::from(most) / 255.0;
        let nearest = Threshold::new(127).level(level, most);
        assert!((f64::from(nearest) - exact).abs() <= 0.5, "{level} of {most}");
        assert_eq!(Threshold::new(127).is_below(level), level > 127);
    }
}

/// A colour's levels, and the greatest of each.
trait Levels: Quantize + PartialEq + std::fmt::Debug {
    const MOST: &'static [u8];
    fn levels(self) -> Vec<u8>;
}

macro_rules! levels {
    ($($color:ident: $most:expr, |$this:ident| $levels:expr;)*) => {$(
        impl Levels for $color {
            const MOST: &'static [u8] = &$most;
            fn levels(self) -> Vec<u8> {
                let $this = self;
                $levels.to_vec()
            }
        }
    )*};
}

levels! {
    BinaryColor: [1], |c| [u8::from(c.is_on())];
    Gray2: [3], |c| [c.luma()];
    Gray4: [15], |c| [c.luma()];
    Gray8: [255], |c| [c.luma()];
    Rgb565: [31, 63, 31], |c| [c.r(), c.g(), c.b()];
    Bgr565: [31, 63, 31], |c| [c.r(), c.g(), c.b()];
    Rgb666: [63, 63, 63], |c| [c.r(), c.g(), c.b()];
    Rgb888: [255, 255, 255], |c| [c.r(), c.g(), c.b()];
    Bgr888: [255, 255, 255], |c| [c.r(), c.g(), c.b()];
}

/// The mean over every square of 8 × 8 of a plain colour.
fn mean_is_exact<C: Levels>(name: &str) {
    const SIDE: usize = 24;
    let (mut pixels, mut worst) = ([[0; 3]; SIDE * SIDE], 0.0_f64);
    let size = Size::new(SIDE as u32, SIDE as u32);
    for level in 0..=255_u8 {
        let others = if C::MOST.len() == 1 { [level; 2] } else { [!level, level.wrapping_mul(5)] };
        let rgb = [level, others[0], others[1]];
        let mut band =
            Band::<Rgb888, NoDepth>::new(size, &mut pixels, &mut []).expect("a band").starting_at(13);
        let Ok(()) = band.clear(Rgb888::new(rgb[0], rgb[1], rgb[2]));
        let colors: Vec<Vec<u8>> = band.dithered::<C>().into_iter().map(C::levels).collect();
        for (left, top) in [(0, 0), (1, 0), (5, 3), (16, 16), (7, 9)] {
            for (channel, &most) in C::MOST.iter().enumerate() {
                let of_square = |i: usize| f64::from(colors[(top + i / 8) * SIDE + left + i % 8][channel]);
                let mean = (0..64).map(of_square).sum::<f64>() / 64.0;
                let exact = f64::from(rgb[channel]) * f64::from(most) / 255.0;
                // What 8 bits leave open, where the display's levels are not among them.
                let open = if 255 % u32::from(most) == 0 { 0.0 } else { f64::from(most) / 255.0 / 2.0 };
                let distance = (mean - exact).abs();
                worst = worst.max(distance - open);
                assert!(distance <= 1.0 / 128.0 + open, "{name}: {mean}, not {exact}");
                if in_8_bits((exact + 0.5) as u8, most) == rgb[channel] {
                    assert!((0..64).all(|i| of_square(i) == of_square(0)), "{name}: {exact} is not plain");
                }
            }
        }
    }
    println!("{name}: the mean is {worst:.5} steps off, beside what 8 bits leave open");
}

#[test]
fn the_mean_of_a_square_is_what_was_drawn_and_what_a_display_has_stays_for_all_levels() {
    mean_is_exact::<BinaryColor>("BinaryColor");
    mean_is_exact::<Gray2>("Gray2");
    mean_is_exact::<Gray4>("Gray4");
    mean_is_exact::<Gray8>("Gray8");
    mean_is_exact::<Rgb565>("Rgb565");
    mean_is_exact::<Bgr565>("Bgr565");
    mean_is_exact::<Rgb666>("Rgb666");
    mean_is_exact::<Rgb888>("Rgb888");
    mean_is_exact::<Bgr888>("Bgr888");
}

const SCREEN: Size = Size::new(50, 45);

/// A list in bands, dithered.
fn dithered_in_bands<F, C>(draws: &[common::scenes::Draw], rows: u32) -> Vec<C>
where
    F: PixelFormat,
    F::Color: Into<Rgb888>,
    C: Quantize,
{
    let mut memory = Box::new(ListMemory::<3000, 1500>::new());
    let mut list = DisplayList::<F, Depth16, 16>::new(&mut *memory);
    let surfaces = surfaces::<QuarterPixel, F, Depth16>();
    for draw in draws {
        draw.draw(SCREEN, &surfaces, &mut list).expect("there is room");
    }
    let words = (SCREEN.width * rows) as usize;
    let (mut pixels, mut depth) = (vec![F::rgb565(0); words], vec![0; words]);
    let mut band = Band::new(Size::new(SCREEN.width, rows), &mut pixels, &mut depth).expect("a band");
    let mut colors = Vec::new();
    let Ok(()) = list.render_bands(SCREEN.height, &Rgb888::CSS_SLATE_GRAY, &mut band, |area, band| {
        let dithered = band.dithered::<C>();
        assert_eq!(dithered.into_iter().len(), (area.size.width * area.size.height) as usize);
        colors.extend(dithered);
        Ok::<_, Infallible>(())
    });
    colors
}

#[test]
fn the_pattern_stays_on_the_screen_for_every_height_of_bands() {
    for_all("dithered in bands", 60, (scene(4), 1..46_u32), |(draws, rows)| {
        let whole = dithered_in_bands::<Gray8, BinaryColor>(&draws, SCREEN.height);
        prop_assert_eq!(&whole, &dithered_in_bands::<Gray8, BinaryColor>(&draws, rows));
        let whole = dithered_in_bands::<Rgb888, Rgb565>(&draws, SCREEN.height);
        prop_assert_eq!(&whole, &dithered_in_bands::<Rgb888, Rgb565>(&draws, rows));
        Ok(())
    });
}

/// A band of random words, somewhere on a screen.
#[derive(Clone, Debug)]
struct Random {
    size: Size,
    top: u32,
    words: Vec<u8>,
}

fn random() -> impl Strategy<Value = Random> {
    (0..40_u32, 0..20_u32, 0..60_u32, any::<u64>()).prop_map(|(width, height, top, seed)| {
        let mut state = seed | 1;
        let words = (0..width * height)
            .map(|_| {
                state ^= state << 13;
                state ^= state >> 7;
                state ^= state << 17;
                // Some are dark, some white.
                if state >> 60 == 0 { 255 } else { (state >> 40) as u8 }
            })
            .collect();
        Random { size: Size::new(width, height), top, words }
    })
}

impl Random {
    /// What it is, as some format.
    fn band<'a>(&self, words: &'a mut Vec<u8>) -> Band<'a, Gray8, NoDepth> {
        words.clone_from(&self.words);
        Band::new(self.size, words, &mut []).expect("the sizes agree").starting_at(self.top)
    }

    /// The level of a display at a pixel of the screen.
    fn level(&self, x: u32, y: u32, most: u8, is_dithered: bool) -> u8 {
        let word = f64::from(self.words[((y - self.top) * self.size.width + x) as usize]);
        let exact = word * f64::from(most) / 255.0;
        let t = bayer(8, x as usize % 8, y as usize % 8) as f64;
        let threshold = if is_dithered { (t + 0.5) / 64.0 } else { 0.5 };
        exact as u8 + u8::from(exact.fract() > threshold)
    }

    /// Sets bits one by one: of a pixel's level those from the most significant on, at the places that `place` says.
    fn packed(
        &self,
        bits: u32,
        is_dithered: bool,
        bytes: usize,
        place: impl Fn(u32, u32, u32) -> (usize, u32),
    ) -> Vec<u8> {
        let mut packed = vec![0; bytes];
        for (x, y) in (0..self.size.height).flat_map(|y| (0..self.size.width).map(move |x| (x, y))) {
            let level = self.level(x, y + self.top, ((1_u32 << bits) - 1) as u8, is_dithered);
            for bit in 0..bits {
                if level >> bit & 1 != 0 {
                    let (byte, at) = place(x, y, bit);
                    packed[byte] |= 1 << at;
                }
            }
        }
        packed
    }
}

/// Packs into a buffer that is longer or shorter than it has to be.
fn checked(
    needed: usize,
    found: usize,
    pack: impl Fn(&mut [u8]) -> Result<Vec<u8>, PackError>,
    expected: &[u8],
) -> Result<(), TestCaseError> {
    let mut bytes = vec![0xa5; found];
    let packed = pack(&mut bytes);
    if found < needed {
        prop_assert_eq!(packed, Err(PackError::TooShort { needed, found }));
        prop_assert!(bytes.iter().all(|byte| *byte == 0xa5));
    } else {
        prop_assert_eq!(packed.as_deref(), Ok(expected));
        prop_assert_eq!(&bytes[..needed], expected);
        prop_assert!(bytes[needed..].iter().all(|byte| *byte == 0xa5));
    }
    Ok(())
}

fn rows_are_packed<C>(random: &Random, bits: u32, slack: i32) -> Result<(), TestCaseError>
where
    C: Quantize + IntoStorage<Storage = u8>,
{
    let bytes_a_row = (random.size.width * bits).div_ceil(8);
    let needed = (bytes_a_row * random.size.height) as usize;
    let found = needed.saturating_add_signed(slack as isize);
    let byte = |x: u32, y: u32| (y * bytes_a_row + x * bits / 8) as usize;
    let of_byte = |x: u32| x * bits % 8;
    let mut words = Vec::new();
    let band = random.band(&mut words);
    let msb = |x, y, bit| (byte(x, y), 8 - bits - of_byte(x) + bit);
    let lsb = |x, y, bit| (byte(x, y), of_byte(x) + bit);
    let (dithered, plain) = (band.dithered::<C>(), band.quantized::<C>());
    let expected = random.packed(bits, true, needed, msb);
    checked(needed, found, |bytes| dithered.pack_rows(bytes).map(|bytes| bytes.to_vec()), &expected)?;
    let expected = random.packed(bits, true, needed, lsb);
    checked(
        needed,
        found,
        |bytes| dithered.pack_rows_lsb_first(bytes).map(|bytes| bytes.to_vec()),
        &expected,
    )?;
    let expected = random.packed(bits, false, needed, msb);
    checked(needed, found, |bytes| plain.pack_rows(bytes).map(|bytes| bytes.to_vec()), &expected)
}

#[test]
fn rows_of_every_width_are_packed_bit_by_bit_in_2_000_cases() {
    for_all("packed rows", 2_000, (random(), -3..4_i32), |(random, slack)| {
        rows_are_packed::<BinaryColor>(&random, 1, slack)?;
        rows_are_packed::<Gray2>(&random, 2, slack)?;
        rows_are_packed::<Gray4>(&random, 4, slack)?;
        rows_are_packed::<Gray8>(&random, 8, slack)
    });
}

#[test]
fn pages_of_every_size_are_packed_bit_by_bit_in_4_000_cases() {
    for_all(
        "packed pages",
        4_000,
        (random(), -3..4_i32, any::<bool>()),
        |(mut random, slack, is_on_page)| {
            if is_on_page {
                random.top &= !7;
            }
            let width = random.size.width;
            let needed = (width * random.size.height.div_ceil(8)) as usize;
            let found = needed.saturating_add_signed(slack as isize);
            let mut words = Vec::new();
            let band = random.band(&mut words);
            if !random.top.is_multiple_of(8) {
                let error = PackError::BetweenPages { row: random.top as usize };
                let mut bytes = vec![0; found];
                prop_assert_eq!(band.dithered::<BinaryColor>().pack_pages(&mut bytes), Err(error));
                return Ok(());
            }
            for is_dithered in [true, false] {
                let expected =
                    random.packed(1, is_dithered, needed, |x, y, _| ((y / 8 * width + x) as usize, y % 8));
                let pack = |bytes: &mut [u8]| {
                    let pixels = if is_dithered { band.dithered() } else { band.quantized::<BinaryColor>() };
                    pixels.pack_pages(bytes).map(|bytes| bytes.to_vec())
                };
                checked(needed, found, pack, &expected)?;
            }
            Ok(())
        },
    );
}

#[test]
fn any_part_of_a_band_is_what_it_is_in_the_whole_in_4_000_cases() {
    let coordinate = || prop_oneof![4 => -10..90_i32, 1 => any::<i32>()];
    let length = || prop_oneof![4 => 0..60_u32, 1 => any::<u32>()];
    let parts = (random(), coordinate(), coordinate(), length(), length());
    for_all("parts of bands", 4_000, parts, |(random, x, y, width, height)| {
        let area = Rectangle::new(Point::new(x, y), Size::new(width, height));
        let mut words = Vec::new();
        let band = random.band(&mut words);
        // (`Rectangle::contains` overflows at the ends of the range of coordinates.)
        let is_in = |x: i64, y: i64| {
            let [dx, dy] = [x - i64::from(area.top_left.x), y - i64::from(area.top_left.y)];
            (0..i64::from(width)).contains(&dx) && (0..i64::from(height)).contains(&dy)
        };
        let places =
            (0..random.size.height).flat_map(|y| (0..random.size.width).map(move |x| (x, y + random.top)));
        let places: Vec<_> = places.filter(|&(x, y)| is_in(x.into(), y.into())).collect();
        let expected = places.iter().map(|&(x, y)| Gray4::new(random.level(x, y, 15, true)));
        let part = band.dithered::<Gray4>().within(&area);
        let mut colors = part.into_iter();
        prop_assert_eq!(colors.len(), places.len());
        prop_assert!(colors.by_ref().eq(expected.clone()), "{:?}", area);
        prop_assert_eq!((colors.len(), colors.next()), (0, None));
        // Packed, too, and within a part of it.
        let columns = places.iter().map(|(x, _)| x).collect::<std::collections::BTreeSet<_>>().len();
        let mut bytes = vec![0; 40 * 20];
        let packed = part.within(&area).pack_rows(&mut bytes).expect("it is long enough");
        let levels: Vec<_> = expected.map(|color| color.luma()).collect();
        let rows = levels.chunks(columns.max(1));
        let naive: Vec<u8> = rows
            .flat_map(|row| row.chunks(2).map(|two| two[0] << 4 | two.get(1).copied().unwrap_or_default()))
            .collect();
        prop_assert_eq!(packed, naive);
        Ok(())
    });
}

/// A square that fills the screen of a camera without perspective, a texel a pixel.
const SQUARE: Mesh = Mesh::new(
    &[
        Vertex::new(-1.0, 1.0, 0.0).uv(0, 0),
        Vertex::new(-1.0, -1.0, 0.0).uv(0, 16),
        Vertex::new(1.0, -1.0, 0.0).uv(16, 16),
        Vertex::new(1.0, 1.0, 0.0).uv(16, 0),
    ],
    &[[0, 1, 2], [0, 2, 3]],
);

/// Textures, flat colours and clear ones are RGB565: through 8 bits a channel they come out as they are, in the words that a band of
/// RGB565 holds.
#[test]
fn rgb565_comes_back_through_8_bits_a_channel() {
    let texture = Texture::new(&TEXELS, 4, 4);
    for_all("RGB565 through 8 bits", 200, draw(), |draw| {
        fn shown<F: PixelFormat, C: Quantize>(draw: &common::scenes::Draw, texture: &Texture<'_>) -> Vec<C>
        where
            F::Color: Into<Rgb888>,
        {
            let words = (SCREEN.width * SCREEN.height) as usize;
            let (mut pixels, mut depth) = (vec![F::rgb565(0x1234); words], vec![0; words]);
            let mut band = Band::<F, Depth16>::new(SCREEN, &mut pixels, &mut depth).expect("a band");
            let camera = draw.camera(SCREEN);
            camera.lit_by(&LIGHTS).draw(
                &meshes()[draw.mesh],
                &draw.pose,
                &Material::textured(texture),
                &mut band,
            );
            band.dithered::<C>().into_iter().collect()
        }
        let expected = shown::<Rgb565, Rgb565>(&draw, &texture);
        prop_assert_eq!(&shown::<Rgb888, Rgb565>(&draw, &texture), &expected);
        prop_assert_eq!(&shown::<Bgr888, Rgb565>(&draw, &texture), &expected);
        prop_assert!(
            shown::<Bgr565, Bgr565>(&draw, &texture)
                .into_iter()
                .eq(expected.iter().map(|c| Bgr565::from(*c)))
        );
        Ok(())
    });
    for bits in 0..=u16::MAX {
        let mut pixels = [<Rgb888 as PixelFormat>::rgb565(bits); 1];
        let band = Band::<Rgb888, NoDepth>::new(Size::new(1, 1), &mut pixels, &mut []).expect("a band");
        assert_eq!(
            band.dithered::<Rgb565>().into_iter().next().map(|color| color.into_storage()),
            Some(bits)
        );
    }
}

#[test]
fn a_screen_door_leaves_out_what_dithering_leaves_dark() {
    let size = Size::new(16, 16);
    let camera = fixel::Camera::orthographic(8.0, size);
    for level in 0..=255_u8 {
        let (mut door, mut plain) = ([0; 256], [level; 256]);
        let mut band = Band::<Gray8, NoDepth>::new(size, &mut door, &mut []).expect("a band");
        let white = Material::flat(Rgb565::WHITE).alpha(level).screen_door();
        camera.draw(&SQUARE, &Pose::IDENTITY.at(Vec3::lit(0.0, 0.0, -2.0)), &white, &mut band);
        let plain = Band::<Gray8, NoDepth>::new(size, &mut plain, &mut []).expect("a band");
        assert!(
            band.quantized::<BinaryColor>().into_iter().eq(plain.dithered::<BinaryColor>()),
            "at {level}"
        );
    }
}

#[test]
fn colors_of_any_band_are_dithered_by_their_luma() {
    for_all("luma", 300, (any::<[u8; 3]>(), 0..8_u32, 0..8_u32), |(rgb, x, y)| {
        let [red, green, blue] = rgb.map(f64::from);
        let luma = 0.299 * red + 0.587 * green + 0.114 * blue;
        let mut pixels = [rgb; 64];
        let band = Band::<Rgb888, NoDepth>::new(Size::new(8, 8), &mut pixels, &mut []).expect("a band");
        let colors: Vec<_> = band.dithered::<Gray8>().into_iter().collect();
        prop_assert!((f64::from(colors[(y * 8 + x) as usize].luma()) - luma).abs() <= 0.5001);
        let mut grays = [colors[0].luma(); 64];
        let gray = Band::<Gray8, NoDepth>::new(Size::new(8, 8), &mut grays, &mut []).expect("a band");
        prop_assert!(band.dithered::<Gray2>().into_iter().eq(gray.dithered::<Gray2>()));
        prop_assert!(band.dithered::<BinaryColor>().into_iter().eq(gray.dithered::<BinaryColor>()));
        Ok(())
    });
}
