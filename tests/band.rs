//! The promise: a `Band` is an embedded-graphics `DrawTarget`, so whatever draws on any display draws the same pixels
//! on a band's rows; its bytes are in the order that the format names; and sizes that do not fit are typed errors.
//!
//! embedded-graphics' own mock display says what the pixels are.

use crate::common;

use common::{Counting, Recording, Strip, for_all};
use fixel::embedded_graphics::geometry::AngleUnit;
use fixel::embedded_graphics::image::GetPixel;
use fixel::embedded_graphics::mock_display::MockDisplay;
use fixel::embedded_graphics::mono_font::MonoTextStyleBuilder;
use fixel::embedded_graphics::mono_font::ascii::{FONT_4X6, FONT_6X10};
use fixel::embedded_graphics::pixelcolor::{IntoStorage, Rgb565, Rgb888};
use fixel::embedded_graphics::prelude::*;
use fixel::embedded_graphics::primitives::{
    Arc, Circle, Ellipse, Line, PrimitiveStyle, PrimitiveStyleBuilder, Rectangle, RoundedRectangle, Triangle,
};
use fixel::embedded_graphics::text::Text;
use fixel::{
    Band, BigEndian, Camera, Depth16, DepthFormat, Material, Mesh, NoDepth, PixelFormat, Pose, TargetError,
    Turn, Vec3, Vertex,
};
use proptest::prelude::*;

/// The side of embedded-graphics' mock display.
const SIDE: u32 = 64;

fn color() -> impl Strategy<Value = Rgb565> {
    (0..32_u8, 0..64_u8, 0..32_u8).prop_map(|(r, g, b)| Rgb565::new(r, g, b))
}

fn point() -> impl Strategy<Value = Point> {
    prop_oneof![4 => (-20..84_i32, -20..84_i32), 1 => (-200..300_i32, -200..300_i32)]
        .prop_map(|(x, y)| Point::new(x, y))
}

/// Not far outside: embedded-graphics' own stroke of a triangle multiplies what it is given in an `i32`.
fn near_point() -> impl Strategy<Value = Point> {
    (-20..84_i32, -20..84_i32).prop_map(|(x, y)| Point::new(x, y))
}

fn size() -> impl Strategy<Value = Size> {
    prop_oneof![4 => (0..40_u32, 0..40_u32), 1 => (0..200_u32, 0..200_u32)].prop_map(|(w, h)| Size::new(w, h))
}

fn area() -> impl Strategy<Value = Rectangle> {
    (point(), size()).prop_map(|(corner, size)| Rectangle::new(corner, size))
}

fn style() -> impl Strategy<Value = PrimitiveStyle<Rgb565>> {
    (prop::option::of(color()), prop::option::of((color(), 1..6_u32))).prop_map(|(fill, stroke)| {
        let mut style = PrimitiveStyleBuilder::new();
        if let Some(fill) = fill {
            style = style.fill_color(fill);
        }
        if let Some((color, width)) = stroke {
            style = style.stroke_color(color).stroke_width(width);
        }
        style.build()
    })
}

/// Something to draw.
#[derive(Clone, Debug)]
enum Step {
    Arc(Point, u32, i32, i32, PrimitiveStyle<Rgb565>),
    Circle(Point, u32, PrimitiveStyle<Rgb565>),
    Ellipse(Point, Size, PrimitiveStyle<Rgb565>),
    Line(Point, Point, PrimitiveStyle<Rgb565>),
    Rectangle(Rectangle, PrimitiveStyle<Rgb565>),
    Rounded(Rectangle, Size, PrimitiveStyle<Rgb565>),
    Triangle(Point, Point, Point, PrimitiveStyle<Rgb565>),
    Text(String, Point, Rgb565, Option<Rgb565>, bool),
    Solid(Rectangle, Rgb565),
    /// With so many colours, which may be more or fewer than the area has pixels.
    Contiguous(Rectangle, Vec<Rgb565>),
    Pixels(Vec<(Point, Rgb565)>),
    Clear(Rgb565),
    /// Through embedded-graphics' adapters, which call the same methods.
    Clipped(Rectangle, Rectangle, Rgb565),
    Translated(Point, Rectangle, Rgb565),
}

fn contiguous() -> impl Strategy<Value = Step> {
    let few = (point(), (0..24_u32, 0..24_u32))
        .prop_map(|(corner, (w, h))| Rectangle::new(corner, Size::new(w, h)));
    (few, 0..4_u8, any::<u32>(), color()).prop_map(|(area, kind, salt, color)| {
        let exact = (area.size.width * area.size.height) as usize;
        let count = match kind {
            0 => exact / 2,
            1 => exact + 7,
            _ => exact,
        };
        let mixed = |i: usize| {
            let word = (i as u32).wrapping_mul(0x9e37_79b9).wrapping_add(salt) >> 16;
            Rgb565::new(word as u8 & 31, color.g(), (word >> 5) as u8 & 31)
        };
        Step::Contiguous(area, (0..count).map(mixed).collect())
    })
}

fn step() -> impl Strategy<Value = Step> {
    let sixteenth = || (-40..40_i32).prop_map(|degrees| degrees * 10);
    prop_oneof![
        (point(), 0..60_u32, sixteenth(), sixteenth(), style()).prop_map(
            |(corner, diameter, from, sweep, style)| Step::Arc(corner, diameter, from, sweep, style)
        ),
        (point(), 0..60_u32, style())
            .prop_map(|(corner, diameter, style)| Step::Circle(corner, diameter, style)),
        (point(), size(), style()).prop_map(|(corner, size, style)| Step::Ellipse(corner, size, style)),
        (point(), point(), style()).prop_map(|(from, to, style)| Step::Line(from, to, style)),
        (area(), style()).prop_map(|(area, style)| Step::Rectangle(area, style)),
        (area(), size(), style()).prop_map(|(area, radius, style)| Step::Rounded(area, radius, style)),
        (near_point(), near_point(), near_point(), style())
            .prop_map(|(a, b, c, style)| Step::Triangle(a, b, c, style)),
        ("[ -~]{0,12}", point(), color(), prop::option::of(color()), any::<bool>())
            .prop_map(|(text, at, color, ground, small)| Step::Text(text, at, color, ground, small)),
        (area(), color()).prop_map(|(area, color)| Step::Solid(area, color)),
        contiguous(),
        contiguous(),
        prop::collection::vec((point(), color()), 0..40).prop_map(Step::Pixels),
        color().prop_map(Step::Clear),
        (area(), area(), color()).prop_map(|(clip, area, color)| Step::Clipped(clip, area, color)),
        (point(), area(), color()).prop_map(|(by, area, color)| Step::Translated(by, area, color)),
    ]
}

impl Step {
    fn draw<T: DrawTarget<Color = Rgb565>>(&self, target: &mut T) -> Result<(), T::Error> {
        match self.clone() {
            Self::Arc(corner, diameter, from, sweep, style) => {
                let (from, sweep) = ((from as f32).deg(), (sweep as f32).deg());
                Arc::new(corner, diameter, from, sweep).into_styled(style).draw(target)
            }
            Self::Circle(corner, diameter, style) => {
                Circle::new(corner, diameter).into_styled(style).draw(target)
            }
            Self::Ellipse(corner, size, style) => Ellipse::new(corner, size).into_styled(style).draw(target),
            Self::Line(from, to, style) => Line::new(from, to).into_styled(style).draw(target),
            Self::Rectangle(area, style) => area.into_styled(style).draw(target),
            Self::Rounded(area, radius, style) => {
                RoundedRectangle::with_equal_corners(area, radius).into_styled(style).draw(target)
            }
            Self::Triangle(a, b, c, style) => Triangle::new(a, b, c).into_styled(style).draw(target),
            Self::Text(text, at, color, ground, small) => {
                let font = if small { &FONT_4X6 } else { &FONT_6X10 };
                let mut style = MonoTextStyleBuilder::new().font(font).text_color(color);
                if let Some(ground) = ground {
                    style = style.background_color(ground);
                }
                Text::new(&text, at, style.build()).draw(target).map(|_| ())
            }
            Self::Solid(area, color) => target.fill_solid(&area, color),
            Self::Contiguous(area, colors) => target.fill_contiguous(&area, colors),
            Self::Pixels(pixels) => {
                target.draw_iter(pixels.into_iter().map(|(point, color)| Pixel(point, color)))
            }
            Self::Clear(color) => target.clear(color),
            Self::Clipped(clip, area, color) => target.clipped(&clip).fill_solid(&area, color),
            Self::Translated(by, area, color) => target.translated(by).fill_solid(&area, color),
        }
    }
}

/// A strip of the mock display's screen, of any size from nothing to all of it.
fn strip() -> impl Strategy<Value = Strip> {
    prop_oneof![
        1 => Just(Strip::new(SIDE, SIDE, 0)),
        6 => (0..=SIDE, 0..=SIDE, 0..=SIDE)
            .prop_map(|(width, height, row)| Strip::new(width, height, row.min(SIDE - height))),
    ]
}

/// What the strip of a mock display shows after the steps, on a ground.
fn expected(strip: Strip, ground: Rgb565, steps: &[Step]) -> Vec<Rgb565> {
    let mut mock = MockDisplay::new();
    mock.set_allow_overdraw(true);
    mock.set_allow_out_of_bounds_drawing(true);
    for step in steps {
        step.draw(&mut mock).expect("a mock display takes everything");
    }
    strip.pixels().map(|(x, y)| mock.get_pixel(Point::new(x, y)).unwrap_or(ground)).collect()
}

fn in_format<F>(
    strip: Strip,
    ground: Rgb565,
    steps: &[Step],
    bytes: impl Fn(u16) -> [u8; 2],
) -> Result<(), TestCaseError>
where
    F: PixelFormat<Word = u16, Color = Rgb565>,
{
    let mut pixels = vec![F::encode(ground); strip.len()];
    let mut none = vec![(); strip.len()];
    let mut band = Band::<F, NoDepth>::new(strip.size(), &mut pixels, &mut none)
        .expect("the sizes agree")
        .starting_at(strip.row);
    prop_assert_eq!(band.bounding_box(), Rectangle::new(Point::new(0, strip.row as i32), strip.size()));
    for step in steps {
        let Ok(()) = step.draw(&mut band);
    }
    let expected = expected(strip, ground, steps);
    for ((x, y), color) in strip.pixels().zip(&expected) {
        prop_assert_eq!(band.pixel(Point::new(x, y)), Some(*color), "at {}, {}", x, y);
    }
    prop_assert!(band.colors().eq(expected.iter().copied()), "colors() differs");
    let words: Vec<u16> = expected.iter().map(|color| F::encode(*color)).collect();
    prop_assert_eq!(band.pixels(), words);
    let in_order: Vec<u8> = expected.iter().flat_map(|color| bytes(color.into_storage())).collect();
    prop_assert_eq!(band.as_bytes(), in_order);
    // Nothing is to be seen outside.
    let (right, bottom) = (strip.width as i32, (strip.row + strip.height) as i32);
    for outside in [(-1, strip.row as i32), (right, strip.row as i32), (0, strip.row as i32 - 1), (0, bottom)]
    {
        prop_assert_eq!(band.pixel(outside.into()), None);
    }
    prop_assert_eq!(band.pixel(Point::new(i32::MIN, i32::MIN)), None);
    prop_assert_eq!(band.pixel(Point::new(i32::MAX, i32::MAX)), None);
    Ok(())
}

#[test]
fn in_4_000_random_drawings_a_band_shows_the_rows_of_the_mock_display() {
    let drawings = (strip(), color(), prop::collection::vec(step(), 0..12));
    for_all("drawing, native and big-endian", 4_000, drawings, |(strip, ground, steps)| {
        in_format::<Rgb565>(strip, ground, &steps, u16::to_ne_bytes)?;
        in_format::<BigEndian<Rgb565>>(strip, ground, &steps, u16::to_be_bytes)
    });
}

#[test]
fn each_of_4_000_single_steps_draws_what_the_mock_display_shows() {
    for_all("one step", 4_000, (strip(), color(), step()), |(strip, ground, step)| {
        in_format::<BigEndian<Rgb565>>(strip, ground, &[step], u16::to_be_bytes)
    });
}

#[test]
fn all_65_536_colors_keep_their_bits_in_both_formats() {
    for word in 0..=u16::MAX {
        let color = Rgb565::from(fixel::embedded_graphics::pixelcolor::raw::RawU16::new(word));
        assert_eq!(<Rgb565 as PixelFormat>::encode(color), word);
        assert_eq!(<Rgb565 as PixelFormat>::rgb565(word), word);
        assert_eq!(<Rgb565 as PixelFormat>::decode(word), color);
        let swapped = <BigEndian<Rgb565> as PixelFormat>::encode(color);
        assert_eq!(swapped.to_ne_bytes(), word.to_be_bytes());
        assert_eq!(<BigEndian<Rgb565> as PixelFormat>::rgb565(word), swapped);
        assert_eq!(<BigEndian<Rgb565> as PixelFormat>::decode(swapped), color);
    }
}

/// Areas as large and as far away as their numbers go.
fn wild_area() -> impl Strategy<Value = Rectangle> {
    let place = || prop_oneof![any::<i32>(), Just(i32::MIN), Just(i32::MAX), -70..70_i32];
    let length = || prop_oneof![any::<u32>(), Just(u32::MAX), Just(i32::MAX as u32), 0..140_u32];
    (place(), place(), length(), length())
        .prop_map(|(x, y, width, height)| Rectangle::new(Point::new(x, y), Size::new(width, height)))
}

#[test]
fn in_10_000_fills_of_any_area_exactly_the_pixels_inside_change() {
    let fills = (strip(), wild_area(), color(), color(), 0..200_usize);
    for_all("wild fill", 10_000, fills, |(strip, area, ground, color, count)| {
        // Where a pixel is in the area, counted along its rows.
        let index = |x: i32, y: i32| {
            let (dx, dy) =
                (i64::from(x) - i64::from(area.top_left.x), i64::from(y) - i64::from(area.top_left.y));
            let (width, height) = (i64::from(area.size.width), i64::from(area.size.height));
            let inside = (0..width).contains(&dx) && (0..height).contains(&dy);
            inside.then(|| i128::from(dy) * i128::from(width) + i128::from(dx))
        };
        let blank = vec![<Rgb565 as PixelFormat>::encode(ground); strip.len()];
        let fill = |contiguous: bool| {
            let mut pixels = blank.clone();
            let mut none = vec![(); strip.len()];
            let mut band = Band::<Rgb565, NoDepth>::new(strip.size(), &mut pixels, &mut none)
                .expect("the sizes agree")
                .starting_at(strip.row);
            let Ok(()) = if contiguous {
                band.fill_contiguous(&area, std::iter::repeat_n(color, count))
            } else {
                band.fill_solid(&area, color)
            };
            pixels
        };
        let expected = |limit: i128| -> Vec<u16> {
            let filled = |(x, y)| index(x, y).is_some_and(|index| index < limit);
            strip
                .pixels()
                .map(|place| <Rgb565 as PixelFormat>::encode(if filled(place) { color } else { ground }))
                .collect()
        };
        prop_assert!(fill(false) == expected(i128::MAX), "fill_solid");
        prop_assert!(fill(true) == expected(count as i128), "fill_contiguous with {} colours", count);
        Ok(())
    });
}

#[test]
fn in_10_000_sizes_and_slices_a_band_is_made_or_a_typed_error() {
    let length = || prop_oneof![0..6_u32, 1020..1026_u32, any::<u32>()];
    let slips = || prop_oneof![3 => Just(0_i64), 2 => -2..=2_i64];
    for_all("size", 10_000, (length(), length(), slips(), slips()), |(width, height, pixels, depth)| {
        let area = u64::from(width) * u64::from(height);
        let fits = width <= 1023 && height <= 1023;
        // Where the area is out of reach any slice will do.
        let length = |slip: i64| if fits { area.saturating_add_signed(slip) as usize } else { 4 };
        let (pixels, depth) = (length(pixels), length(depth));
        let mut words = (vec![0_u16; pixels], vec![9_u16; depth]);
        let needed = area as usize;
        let expected = match (fits, pixels < needed, depth < needed) {
            (false, ..) => Err(TargetError::TooLarge),
            (_, true, _) => Err(TargetError::Pixels { needed, found: pixels }),
            (_, _, true) => Err(TargetError::Depth { needed, found: depth }),
            _ => Ok(()),
        };
        let band = Band::<Rgb565, Depth16>::new(Size::new(width, height), &mut words.0, &mut words.1);
        let made = band.map(|mut band| {
            let Ok(()) = band.clear(Rgb565::WHITE);
        });
        prop_assert_eq!(made, expected, "{} × {} with {} pixels, {} depths", width, height, pixels, depth);
        // What is more than the band needs is left alone, and all of it where there is no band.
        let used = if expected.is_ok() { needed } else { 0 };
        prop_assert!(words.0[..used].iter().all(|word| *word == 0xffff));
        prop_assert!(words.0[used..].iter().all(|word| *word == 0));
        prop_assert!(words.1[..used].iter().all(|word| *word == 0));
        prop_assert!(words.1[used..].iter().all(|word| *word == 9));
        Ok(())
    });
}

#[test]
fn nothing_and_one_pixel_are_targets_too() {
    for (width, height) in [(0, 0), (0, 5), (5, 0)] {
        let mut band =
            Band::<Rgb565, Depth16>::new(Size::new(width, height), &mut [], &mut []).expect("nothing fits");
        let Ok(()) = band.clear(Rgb565::WHITE);
        let Ok(()) = band.fill_solid(&Rectangle::new(Point::zero(), Size::new(9, 9)), Rgb565::WHITE);
        let Ok(()) =
            band.fill_contiguous(&Rectangle::new(Point::zero(), Size::new(9, 9)), [Rgb565::WHITE; 81]);
        band.clear_depth();
        assert_eq!((band.pixels().len(), band.colors().count(), band.as_bytes().len()), (0, 0, 0));
        assert_eq!(band.pixel(Point::zero()), None);
    }
    let (mut pixels, mut depth) = ([0], [7]);
    let mut band = Band::<BigEndian<Rgb565>, Depth16>::new(Size::new(1, 1), &mut pixels, &mut depth)
        .expect("one pixel fits")
        .starting_at(3);
    let Ok(()) = band.clear(Rgb565::RED);
    band.clear_depth();
    assert_eq!(band.pixel(Point::new(0, 3)), Some(Rgb565::RED));
    assert_eq!(band.pixel(Point::new(0, 0)), None);
    assert_eq!(band.as_bytes(), [0xf8, 0x00]);
    assert_eq!(depth, [0]);
}

/// What a band shows and its depths after the front page's triangle, turned by so many degrees, was drawn to it.
fn turned_triangle(band: &mut Band<'_, Rgb565, Depth16>, degrees: i32) -> (Vec<u16>, Vec<u16>) {
    const TRIANGLE: Mesh = Mesh::new(
        &[Vertex::new(-1.0, -1.0, 0.0), Vertex::new(1.0, -1.0, 0.0), Vertex::new(0.0, 1.0, 0.0)],
        &[[0, 1, 2]],
    );
    let camera = Camera::perspective(Turn::from_degrees(60), band.size()).at(Vec3::lit(0.0, 0.0, 2.5));
    let pose = Pose::IDENTITY.rotated_y(Turn::from_degrees(degrees));
    camera.draw(&TRIANGLE, &pose, &Material::flat(Rgb565::RED), band);
    (band.pixels().to_vec(), band.depth().to_vec())
}

const SCREEN: Size = Size::new(240, 240);
const AREA: usize = 240 * 240;

#[test]
fn clear_begins_a_new_picture_in_every_frame() {
    let drawn = |pixels: &[u16]| pixels.iter().filter(|&&word| word == Rgb565::RED.into_storage()).count();
    let (mut pixels, mut depth) = (vec![0; AREA], vec![0; AREA]);
    let mut band = Band::<Rgb565, Depth16>::new(SCREEN, &mut pixels, &mut depth).expect("they fit");
    for degrees in [50, 60, 70] {
        let Ok(()) = band.clear(Rgb565::BLUE);
        let found = turned_triangle(&mut band, degrees);
        // What memory shows that nothing was ever drawn to.
        let (mut pixels, mut depth) = (vec![Rgb565::BLUE.into_storage(); AREA], vec![0; AREA]);
        let mut fresh = Band::new(SCREEN, &mut pixels, &mut depth).expect("they fit");
        let expected = turned_triangle(&mut fresh, degrees);
        assert_eq!(drawn(&found.0), drawn(&expected.0), "pixels of the triangle, turned by {degrees}°");
        assert!(found == expected);
    }
    // So it does through a target that only moves or converts.
    for wrapped in [true, false] {
        let Ok(()) = if wrapped {
            band.translated(Point::new(7, -9)).clear(Rgb565::BLUE)
        } else {
            band.color_converted::<Rgb888>().clear(Rgb888::BLUE)
        };
        assert!(band.pixels().iter().all(|&word| word == Rgb565::BLUE.into_storage()));
        assert!(band.depth().iter().all(|&depth| depth == 0));
        turned_triangle(&mut band, 50);
    }
}

#[test]
fn fills_and_clears_of_a_part_keep_depth() {
    let (mut pixels, mut depth) = (vec![0; AREA], vec![0; AREA]);
    let mut band = Band::<Rgb565, Depth16>::new(SCREEN, &mut pixels, &mut depth).expect("they fit");
    let (_, depth) = turned_triangle(&mut band, 50);
    let inside = Rectangle::new(Point::new(100, 90), Size::new(30, 40));
    let all = band.bounding_box();
    let Ok(()) = band.fill_solid(&all, Rgb565::BLUE);
    assert_eq!(band.depth(), depth, "fill_solid");
    let Ok(()) = band.clipped(&inside).clear(Rgb565::GREEN);
    assert_eq!(band.depth(), depth, "clear of a clipped target");
    let Ok(()) = band.cropped(&Rectangle::new(inside.top_left, Size::new(30, 20))).clear(Rgb565::RED);
    assert_eq!(band.depth(), depth, "clear of a cropped target");
    for point in all.points() {
        let expected = match (inside.contains(point), point.y < 110) {
            (false, _) => Rgb565::BLUE,
            (true, false) => Rgb565::GREEN,
            (true, true) => Rgb565::RED,
        };
        assert_eq!(band.pixel(point), Some(expected), "{point}");
    }
}

#[test]
fn a_format_of_ones_own_works_without_bytes() {
    let strip = Strip::new(3, 2, 1);
    let mut canvas = common::Record::blank(strip);
    let mut band = Band::<Recording, Counting>::new(strip.size(), &mut canvas.pixels, &mut canvas.depth)
        .expect("the sizes agree")
        .starting_at(strip.row);
    let Ok(()) = band.fill_solid(&Rectangle::new(Point::new(1, 0), Size::new(1, 2)), Rgb565::GREEN);
    let written: Vec<bool> = canvas.pixels.iter().map(|drawn| drawn.written).collect();
    assert_eq!(written, [false, true, false, false, false, false]);
    assert!(canvas.depth.iter().all(|met| *met == Counting::CLEAR));
}
