//! The promise: what is drawn straight to a display is what a band without depth holds, byte for byte; whatever part of
//! the screen a target shows, nothing outside it is drawn, and no pixel twice; a display's error ends the drawing.
#![allow(clippy::float_arithmetic, reason = "errors are measured in f64")]

use crate::{common, reference};

use common::generate::{Family, GUARD_BAND, place, places, triangle};
use common::{Strip, for_all, perspective, screen_vertex};
use fixel::embedded_graphics::mock_display::MockDisplay;
use fixel::embedded_graphics::pixelcolor::raw::RawU32;
use fixel::embedded_graphics::pixelcolor::{IntoStorage, PixelColor, Rgb565};
use fixel::embedded_graphics::prelude::*;
use fixel::embedded_graphics::primitives::Rectangle;
use fixel::fixed::types::{I2F14, I12F4, I16F16, U1F31, U8F8, U10F22};
use fixel::material::Kind;
use fixel::{
    Affine, Band, Camera, CornersError, Cull, DisplayList, Exact, Inputs, ListMemory, Material, Mesh,
    NoDepth, PerspectiveImage, PixelFormat, Pose, Quality, QuarterPixel, RangeError, ScreenVertex,
    ShadedTriangle, Shader, Surface, Texture, Turn, Varying, Vec3, Vertex,
};
use proptest::prelude::*;
use reference::{Triangle, UNIT};
use std::collections::HashMap;
use std::convert::Infallible;
use std::marker::PhantomData;

/// A display without a buffer's comforts: it takes rows, and takes offence.
struct Screen<C> {
    area: Rectangle,
    pixels: Pixels<C>,
    rows: usize,
    /// How many rows it takes before it fails.
    patience: usize,
    /// Whether it takes a pixel twice.
    takes_twice: bool,
}

#[derive(Debug, PartialEq, Eq)]
struct Refused(usize);

impl<C> Screen<C> {
    fn new(area: Rectangle) -> Self {
        Self { area, pixels: HashMap::new(), rows: 0, patience: usize::MAX, takes_twice: false }
    }

    fn of(width: u32, height: u32) -> Self {
        Self::new(Rectangle::new(Point::zero(), Size::new(width, height)))
    }
}

impl<C> Dimensions for Screen<C> {
    fn bounding_box(&self) -> Rectangle {
        self.area
    }
}

impl<C: PixelColor> DrawTarget for Screen<C> {
    type Color = C;
    type Error = Refused;

    fn draw_iter<I: IntoIterator<Item = Pixel<C>>>(&mut self, _: I) -> Result<(), Refused> {
        panic!("pixel by pixel");
    }

    fn fill_contiguous<I: IntoIterator<Item = C>>(
        &mut self,
        area: &Rectangle,
        colors: I,
    ) -> Result<(), Refused> {
        self.rows += 1;
        if self.rows > self.patience {
            return Err(Refused(self.rows));
        }
        assert!(area.size.height == 1 && area.size.width > 0, "{area:?} is no row");
        let mut colors = colors.into_iter();
        assert_eq!(colors.size_hint(), (area.size.width as usize, Some(area.size.width as usize)));
        for i in 0..area.size.width as i32 {
            let (x, y) = (area.top_left.x + i, area.top_left.y);
            let inside = |at: i32, start: i32, length: u32| {
                (i64::from(start)..i64::from(start) + i64::from(length)).contains(&i64::from(at))
            };
            let Rectangle { top_left, size } = self.area;
            assert!(
                inside(x, top_left.x, size.width) && inside(y, top_left.y, size.height),
                "{x}, {y} is outside"
            );
            let color = colors.next().expect("a colour for each pixel");
            let first = self.pixels.insert((x, y), color).is_none();
            assert!(first || self.takes_twice, "{x}, {y} is drawn twice");
        }
        assert!(colors.next().is_none() && colors.next().is_none(), "more colours than pixels");
        Ok(())
    }
}

/// A format whose words and colours are the bits of u.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Bits(i32);

impl PixelColor for Bits {
    type Raw = RawU32;
}

impl PixelFormat for Bits {
    type Word = i32;
    type Color = Self;

    fn encode(color: Self) -> i32 {
        color.0
    }

    fn decode(word: i32) -> Self {
        Self(word)
    }

    fn rgb565(bits: u16) -> i32 {
        bits.into()
    }

    fn rgb888(red: u8, green: u8, blue: u8) -> i32 {
        i32::from_be_bytes([0, red, green, blue])
    }
}

/// A shader of a caller's own.
struct ShowU<Q>(PhantomData<fn() -> Q>);

impl<Q: Quality> Shader<Bits> for ShowU<Q> {
    type Quality = Q;

    fn inputs(&self) -> Inputs {
        Inputs::Uv
    }

    fn color(&self, at: &Varying) -> i32 {
        at.u.to_bits()
    }
}

/// What drawing into a band covers, by drawing over two grounds.
fn in_band<F>(strip: Strip, draw: impl Fn(&mut Band<'_, F, NoDepth>)) -> Pixels<F::Color>
where
    F: PixelFormat<Word: PartialEq + Copy>,
{
    let on = |ground: F::Word| {
        let (mut pixels, mut depth) = (vec![ground; strip.len()], vec![(); strip.len()]);
        let band = Band::<F, NoDepth>::new(strip.size(), &mut pixels, &mut depth);
        draw(&mut band.expect("the slices are long enough").starting_at(strip.row));
        pixels
    };
    let both = on(F::rgb565(0x0000)).into_iter().zip(on(F::rgb565(0x5a5a)));
    let drawn = strip.pixels().zip(both).filter(|(_, (a, b))| a == b);
    drawn.map(|(at, (word, _))| (at, F::decode(word))).collect()
}

type Pixels<C> = HashMap<(i32, i32), C>;

/// Names the first pixel that differs.
fn same<C: PartialEq + std::fmt::Debug>(
    drawn: &Pixels<C>,
    expected: &Pixels<C>,
) -> Result<(), TestCaseError> {
    let mut places: Vec<_> = drawn.keys().chain(expected.keys()).collect();
    places.sort();
    for at in places {
        prop_assert_eq!(drawn.get(at), expected.get(at), "at {:?}", at);
    }
    Ok(())
}

fn texels(log2: u32) -> Vec<u16> {
    (0..1_u32 << log2).map(|i| (i.wrapping_mul(0x9e37_79b9) >> 16) as u16).collect()
}

/// Through a run as long as the screen all rows are as in a band; through one of 64 pixels those that are not longer.
fn same_as_band<'a, F, S>(
    triangle: &[ScreenVertex; 3],
    strip: Strip,
    shader: &S,
    surface: impl Into<Surface<'a, F, NoDepth>>,
) -> Result<(), TestCaseError>
where
    F: PixelFormat<Word: PartialEq + Copy, Color: PartialEq + std::fmt::Debug>,
    S: Shader<F>,
{
    let surface = surface.into();
    let expected = in_band::<F>(strip, |band| {
        fixel::draw_triangle(triangle, Cull::None, surface, band).expect("within range");
    });
    let drawn = ShadedTriangle::new(triangle, Cull::None, shader).expect("within range").format::<F>();
    let area = Rectangle::new(Point::new(0, strip.row as i32), strip.size());
    let (mut screen, mut by_runs) = (Screen::new(area), Screen::new(area));
    drawn.run::<1023>().draw(&mut screen).expect("patience");
    drawn.draw(&mut by_runs).expect("patience");
    same(&screen.pixels, &expected)?;
    let mut lengths = HashMap::new();
    for (_, y) in expected.keys() {
        *lengths.entry(*y).or_insert(0) += 1;
    }
    prop_assert_eq!(by_runs.pixels.len(), expected.len());
    for (at, color) in &by_runs.pixels {
        prop_assert!(expected.contains_key(at), "{:?} is not covered", at);
        prop_assert!(lengths[&at.1] > 64 || expected[at] == *color, "another colour at {:?}", at);
    }
    Ok(())
}

fn material_as_in_band<K: Kind, Q: Quality>(
    triangle: &[ScreenVertex; 3],
    strip: Strip,
    material: &Material<'_, K, Q>,
) -> Result<(), TestCaseError> {
    same_as_band::<Rgb565, _>(triangle, strip, material, material)
}

fn shader_as_in_band(
    triangle: &[ScreenVertex; 3],
    strip: Strip,
    shader: &(impl Shader<Bits> + Sync),
) -> Result<(), TestCaseError> {
    same_as_band::<Bits, _>(triangle, strip, shader, Surface::new(shader))
}

#[test]
fn a_triangle_is_a_bands_byte_for_byte_800_cases() {
    // As wide as a screen may be, so that the band's right border cuts no row shorter than the display's.
    let strips =
        (0..=1000_u32, 1..=24_u32).prop_map(|(row, height)| Strip::new(1023, height, row.min(1023 - height)));
    let cases = strips.prop_flat_map(|strip| {
        let narrow = Strip::new(60, strip.height, strip.row);
        (Just(strip), prop_oneof![triangle(strip), triangle(narrow)], 0..7_u8)
    });
    let (small, large) = (texels(10), texels(15));
    let (small, large) = (Texture::new(&small, 5, 5), Texture::new(&large, 8, 7));
    for_all("direct: triangles", 800, cases, |(strip, triangle, kind)| {
        let corners = triangle.0.map(screen_vertex);
        match kind {
            0 => material_as_in_band(&corners, strip, &Material::textured(&small)),
            1 => material_as_in_band(&corners, strip, &Material::textured(&large)),
            2 => material_as_in_band(&corners, strip, &Material::clamped(&large)),
            3 => material_as_in_band(&corners, strip, &Material::gouraud()),
            4 => material_as_in_band(&corners, strip, &Material::gouraud().exact()),
            5 => shader_as_in_band(&corners, strip, &ShowU::<QuarterPixel>(PhantomData)),
            _ => shader_as_in_band(&corners, strip, &ShowU::<Affine>(PhantomData)),
        }
    });
}

/// The largest error of u by the contract's measure, in runs of `RUN` pixels.
fn largest_error<Q: Quality, const RUN: usize>(triangle: &Triangle, strip: Strip) -> f64 {
    let corners = triangle.0.map(screen_vertex);
    let shader = ShowU::<Q>(PhantomData);
    let drawn = ShadedTriangle::new(&corners, Cull::None, &shader).expect("within range");
    let mut screen = Screen::new(Rectangle::new(Point::new(0, strip.row as i32), strip.size()));
    drawn.format::<Bits>().run::<RUN>().draw(&mut screen).expect("patience");
    let (low, high) = triangle.sampled(0);
    let error = |(&(x, y), &Bits(u)): (&(i32, i32), &Bits)| {
        assert!((low..=high).contains(&u), "{x}, {y} shows what no corner does");
        let exact = triangle.at(x, y);
        let off = (f64::from(u) - exact.attribute(0)).abs() / UNIT;
        off / (exact.change(0).step / UNIT).max(1.0)
    };
    screen.pixels.iter().map(error).fold(0.0, f64::max)
}

#[test]
fn runs_begin_anew_within_a_quarter_pixel_600_cases() {
    let families = prop::sample::select(&perspective::FAMILIES[..]);
    let ratios = prop::sample::select(&perspective::RATIOS[..]);
    let cases = (families, ratios).prop_flat_map(|(family, ratio)| perspective::case(family, ratio));
    for_all("direct: runs", 600, cases, |case| {
        let (triangle, strip) = (&case.triangle, case.strip);
        prop_assert!(largest_error::<QuarterPixel, 64>(triangle, strip) <= 0.25);
        prop_assert!(largest_error::<QuarterPixel, 7>(triangle, strip) <= 0.25);
        prop_assert!(largest_error::<QuarterPixel, 1>(triangle, strip) <= 0.25);
        prop_assert!(largest_error::<Exact, 64>(triangle, strip) <= 0.02);
        Ok(())
    });
}

/// Which part of a display a drawing gets to see.
#[derive(Clone, Copy, Debug)]
enum View {
    Clipped(Rectangle),
    Cropped(Rectangle),
    Translated(Point),
}

const MOCK: Rectangle = Rectangle::new(Point::zero(), Size::new(64, 64));

impl View {
    /// Draws on embedded-graphics' mock display, which panics on a pixel drawn twice or outside.
    fn draw<D: Drawable<Color = Rgb565, Output = ()>>(self, drawable: &D) -> MockDisplay<Rgb565> {
        let mut display = MockDisplay::new();
        let Ok(()) = match self {
            Self::Clipped(area) => drawable.draw(&mut display.clipped(&area)),
            Self::Cropped(area) => drawable.draw(&mut display.cropped(&area)),
            Self::Translated(by) => drawable.draw(&mut display.translated(by)),
        };
        display
    }

    /// The part of the display, and where on it the drawing's origin is.
    fn part(self) -> (Rectangle, Point) {
        match self {
            Self::Clipped(area) => (area.intersection(&MOCK), Point::zero()),
            Self::Cropped(area) => (area.intersection(&MOCK), area.intersection(&MOCK).top_left),
            Self::Translated(by) => (MOCK, by),
        }
    }
}

fn view() -> impl Strategy<Value = View> {
    let area = || {
        ((-20..80_i32, -20..80_i32), (0..70_u32, 0..70_u32))
            .prop_map(|((x, y), (w, h))| Rectangle::new(Point::new(x, y), Size::new(w, h)))
    };
    prop_oneof![
        area().prop_map(View::Clipped),
        area().prop_map(View::Cropped),
        (-40..40_i32, -40..40_i32).prop_map(|(x, y)| View::Translated(Point::new(x, y))),
    ]
}

/// Four corners of any shape: some do not lie in a plane, some cross.
fn corners() -> impl Strategy<Value = [ScreenVertex; 4]> {
    let strip = Strip::new(64, 64, 0);
    let q = || prop_oneof![2 => 1 << 26..1_u32 << 31, 1 => Just(1 << 30)];
    let corner = move || {
        (place(strip, 800), q()).prop_map(|((x, y), q)| ScreenVertex {
            x: I12F4::from_bits(x as i16),
            y: I12F4::from_bits(y as i16),
            q: U1F31::from_bits(q),
            ..ScreenVertex::default()
        })
    };
    [corner(), corner(), corner(), corner()]
}

/// Where in a texture of 2^`log2` texels a side the corners of a picture are.
fn with_texels(corners: &[ScreenVertex; 4], log2: u32) -> [ScreenVertex; 4] {
    let (low, high) = (0, 1 << (log2 + 16));
    let uv = [[low, low], [low, high], [high, high], [high, low]];
    std::array::from_fn(|i| {
        let [u, v] = uv[i].map(I16F16::from_bits);
        ScreenVertex { u, v, ..corners[i] }
    })
}

fn halves<T: Copy>(quad: &[T; 4]) -> [[T; 3]; 2] {
    [[quad[0], quad[1], quad[2]], [quad[0], quad[2], quad[3]]]
}

/// Whether its halves do not overlap: else both sides are seen at once, and pixels drawn twice.
fn is_unfolded(quad: &[ScreenVertex; 4]) -> bool {
    let place = |i: usize| (i32::from(quad[i].x.to_bits()), i32::from(quad[i].y.to_bits()));
    let area = |[a, b, c]: [usize; 3]| {
        let ((ax, ay), (bx, by), (cx, cy)) = (place(a), place(b), place(c));
        (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)
    };
    area([0, 1, 2]).signum() * area([0, 2, 3]).signum() >= 0
}

/// The same, or a parallelogram instead.
fn unfolded(mut quad: [ScreenVertex; 4]) -> [ScreenVertex; 4] {
    if !is_unfolded(&quad) {
        quad[3].x = quad[0].x + quad[2].x - quad[1].x;
        quad[3].y = quad[0].y + quad[2].y - quad[1].y;
    }
    quad
}

#[test]
fn a_picture_is_a_bands_in_every_part_of_a_display_1500_cases() {
    let texels = texels(10);
    let texture = Texture::new(&texels, 5, 5);
    for_all("direct: pictures", 1500, (corners(), view()), |(corners, view)| {
        let image = PerspectiveImage::new(&texture, &corners).expect("within range");
        let whole = if matches!(view, View::Translated(by) if by.x > 0) {
            // Rows begin left of the screen.
            let mut screen = Screen::new(Rectangle::new(Point::new(-1024, -1024), Size::new(2047, 2047)));
            image.run::<2047>().draw(&mut screen).expect("patience");
            screen.pixels
        } else {
            let shader = Material::textured(&texture);
            in_band::<Rgb565>(Strip::new(1023, 120, 0), |band| {
                for half in halves(&with_texels(&corners, 5)) {
                    fixel::draw_triangle(&half, Cull::Back, &shader, band).expect("within range");
                }
            })
        };
        let display = view.draw(&image.run::<2047>());
        let (part, origin) = view.part();
        for at in MOCK.points() {
            let from = at - origin;
            // The band has no rows above the screen.
            if from.y < 0 && !matches!(view, View::Translated(by) if by.x > 0) {
                continue;
            }
            let expected = whole.get(&(from.x, from.y)).filter(|_| part.contains(at));
            prop_assert_eq!(display.get_pixel(at), expected.copied(), "at {}", at);
        }
        Ok(())
    });
}

#[test]
fn what_a_pixel_shows_does_not_depend_on_what_else_is_shown_400_cases() {
    let texels = texels(10);
    let texture = Texture::new(&texels, 5, 5);
    let area = ((0..500_i32, 0..100_i32), (1..300_u32, 1..60_u32))
        .prop_map(|((x, y), (w, h))| Rectangle::new(Point::new(x, y), Size::new(w, h)));
    let strip = Strip::new(480, 100, 0);
    let triangles = (places(Family::Ordinary, strip), [1 << 26..1_u32 << 31, 1 << 26..1_u32 << 31]);
    for_all("direct: parts", 400, (triangles, area), |((places, [p, q]), area)| {
        let vertex = |(x, y): (i32, i32), q: u32, u: i32| ScreenVertex {
            x: I12F4::from_bits(x as i16),
            y: I12F4::from_bits(y as i16),
            q: U1F31::from_bits(q),
            u: I16F16::from_num(u),
            v: I16F16::from_num(u / 3),
            ..ScreenVertex::default()
        };
        let triangle = [vertex(places[0], p, 0), vertex(places[1], q, 400), vertex(places[2], p, 90)];
        let shader = Material::textured(&texture);
        let drawn = ShadedTriangle::new(&triangle, Cull::None, &shader).expect("within range").run::<24>();
        let (mut whole, mut part) = (Screen::of(u32::MAX, u32::MAX), Screen::new(area));
        drawn.draw(&mut whole).expect("patience");
        drawn.draw(&mut part).expect("patience");
        whole.pixels.retain(|&(x, y), _| area.contains(Point::new(x, y)));
        same(&part.pixels, &whole.pixels)
    });
}

/// A card of 64 × 64 texels and the same as a mesh, for its front or its back.
fn as_mesh(size: [I16F16; 2], is_back: bool) -> ([Vertex; 4], [[u16; 3]; 2]) {
    // As large as a mesh can be, which is where a card ends too.
    let [x, y] = size.map(|side| (side.to_num::<f32>() / 2.0).clamp(-7.999_756, 7.999_756));
    let (low, high) = (I12F4::ZERO, I12F4::from_bits(64 * 16));
    let (left, right) = if is_back { (high, low) } else { (low, high) };
    let vertices = [
        Vertex::new(-x, y, 0.0).uv_sixteenths(left, low),
        Vertex::new(-x, -y, 0.0).uv_sixteenths(left, high),
        Vertex::new(x, -y, 0.0).uv_sixteenths(right, high),
        Vertex::new(x, y, 0.0).uv_sixteenths(right, low),
    ];
    (vertices, [[0, 1, 2], [0, 2, 3]])
}

/// Whether a picture is seen so exactly from its edge that some of it shows its front, and some its back: rounded to 1/16 px it
/// is folded.
fn is_folded(camera: &Camera, pose: &Pose, size: [I16F16; 2]) -> bool {
    let (vertices, triangles) = as_mesh(size, false);
    let mesh = Mesh::try_new(&vertices, &triangles).expect("the indices are in range");
    [Cull::Back, Cull::Front].into_iter().all(|cull| {
        let material = Material::flat(Rgb565::RED).cull(cull);
        let mut memory = ListMemory::<32, 32>::new();
        let mut list = DisplayList::<Rgb565, NoDepth, 1>::new(&mut memory);
        camera.draw(&mesh, pose, &material, &mut list).expect("there is room for what clipping makes of two");
        list.lengths()[1] > 0
    })
}

#[test]
fn a_posed_picture_is_its_mesh_in_a_band_also_clipped_1000_cases() {
    let (front, back) = (texels(12), texels(13)[1 << 12..].to_vec());
    let (front, back) = (Texture::new(&front, 6, 6), Texture::new(&back, 6, 6));
    let poses = ([any::<u16>(), any::<u16>(), any::<u16>()], [-1.5..1.5_f32, -1.5..1.5, -4.0..0.3]);
    let sides = || (1..2 * 2048_i32).prop_map(|half| I16F16::from_bits(half << 5));
    let cameras = (20.0..200.0_f32, prop::bool::weighted(0.2), -20..20_i32);
    let (clipped, seen) = (std::cell::Cell::new(0), std::cell::Cell::new(0));
    let view = prop::option::of(((0..50_i32, 0..40_i32), (0..60_u32, 0..60_u32)));
    let scale = || prop_oneof![4 => Just(1.0), 1 => 0.2..2.0_f64].prop_map(U10F22::from_num);
    let scales = ([scale(), scale(), scale()], prop::option::weighted(0.3, 0..3_usize));
    let cases = ((poses, scales), [sides(), sides()], cameras, view);
    for_all("direct: poses", 1000, cases, |(poses, size, (focal, orthographic, left), view)| {
        let ((turns, [x, y, z]), (stretch, mirror)) = poses;
        // The camera's picture ends within the band.
        let (strip, screen) = (Strip::new(120, 64, 0), Size::new(96, 64));
        let camera = if orthographic {
            Camera::orthographic(focal / 4.0, screen)
        } else {
            Camera::focal(focal, screen)
        };
        let camera = camera.near(0.3).viewport(Point::new(left, 0));
        let [yaw, pitch, roll] = turns.map(Turn::from_raw);
        let pose = Pose::from_euler(yaw, pitch, roll).at(Vec3::lit(x, y, z)).stretched(stretch);
        let pose = mirrored(pose, mirror);
        let mut stats = fixel::Stats::default();
        let mut expected = in_band::<Rgb565>(strip, |band| {
            for (texture, cull, is_back) in [(&front, Cull::Back, false), (&back, Cull::Front, true)] {
                let (vertices, triangles) = as_mesh(size, is_back);
                let mesh = Mesh::new(&vertices, &triangles);
                camera.draw(&mesh, &pose, &Material::textured(texture).cull(cull), band);
            }
        });
        let (vertices, triangles) = as_mesh(size, false);
        let (mut pixels, mut depth) = (vec![0; strip.len()], vec![(); strip.len()]);
        let mut band = Band::<Rgb565, NoDepth>::new(strip.size(), &mut pixels, &mut depth).expect("it fits");
        let mesh = Mesh::new(&vertices, &triangles);
        camera.draw_counted(&mesh, &pose, &Material::textured(&front).two_sided(), &mut band, &mut stats);
        clipped.set(clipped.get() + u32::from(stats.clipped > 0 && stats.drawn > 0));
        seen.set(seen.get() + u32::from(!expected.is_empty()));

        let mut area = Rectangle::new(Point::zero(), strip.size());
        if let Some(((x, y), (width, height))) = view {
            area = area.intersection(&Rectangle::new(Point::new(x, y), Size::new(width, height)));
        }
        expected.retain(|&(x, y), _| area.contains(Point::new(x, y)));
        let mut screen = Screen { takes_twice: is_folded(&camera, &pose, size), ..Screen::new(area) };
        let image = PerspectiveImage::posed(&front, &camera, &pose, size).back(&back);
        image.run::<96>().draw(&mut screen).expect("patience");
        same(&screen.pixels, &expected)
    });
    println!("direct: {} seen, {} of them clipped", seen.get(), clipped.get());
    assert!(seen.get() > common::cases(1000) / 3 && clipped.get() > common::cases(1000) / 20);
}

/// With one axis turned round.
fn mirrored(mut pose: Pose, axis: Option<usize>) -> Pose {
    if let Some(axis) = axis {
        pose.rotation.iter_mut().for_each(|row| row[axis] = row[axis].saturating_neg());
    }
    pose
}

/// A card around the middle of the mock display, turned about its vertical axis.
fn turned(degrees: i32) -> (Camera, Pose, [I16F16; 2]) {
    let camera = Camera::perspective(Turn::from_degrees(40), MOCK.size);
    let pose = Pose::IDENTITY.rotated_y(Turn::from_degrees(degrees)).at(Vec3::lit(0.0, 0.0, -4.0));
    (camera, pose, [I16F16::from_num(2); 2])
}

const WHITE: u16 = 0xffff;

#[test]
fn a_flipped_card_shows_its_back_upright_or_itself_mirrored_or_nothing() {
    static FRONT: Texture = Texture::new(&[WHITE, 0xf800, WHITE, 0xf800], 1, 1);
    static BACK: Texture = Texture::new(&[0x001f, 0x07e0, 0x001f, 0x07e0], 1, 1);
    let shown = |degrees: i32, sides: fn(PerspectiveImage<'static>) -> PerspectiveImage<'static>| {
        let (camera, pose, size) = turned(degrees);
        let mut display = MockDisplay::<Rgb565>::new();
        let Ok(()) = sides(PerspectiveImage::posed(&FRONT, &camera, &pose, size)).draw(&mut display);
        [24, 40].map(|x| display.get_pixel(Point::new(x, 32)).map(IntoStorage::into_storage))
    };
    assert_eq!(shown(10, |image| image), [Some(WHITE), Some(0xf800)]);
    assert_eq!(shown(170, |image| image), [None, None]);
    assert_eq!(shown(10, |image| image.back(&BACK)), [Some(WHITE), Some(0xf800)]);
    assert_eq!(shown(170, |image| image.back(&BACK)), [Some(0x001f), Some(0x07e0)]);
    assert_eq!(shown(10, PerspectiveImage::two_sided), [Some(WHITE), Some(0xf800)]);
    assert_eq!(shown(170, PerspectiveImage::two_sided), [Some(0xf800), Some(WHITE)]);
}

#[test]
fn a_card_in_a_mirror_shows_the_same_side_mirrored() {
    static FRONT: Texture = Texture::new(&[WHITE, 0xf800, WHITE, 0xf800], 1, 1);
    static BACK: Texture = Texture::new(&[0x001f, 0x07e0, 0x001f, 0x07e0], 1, 1);
    // The card's axis and the camera's that are negated.
    let shown = |axes: [Option<usize>; 2],
                 sides: fn(PerspectiveImage<'static>) -> PerspectiveImage<'static>| {
        let (camera, pose, size) = turned(10);
        let camera = camera.pose(mirrored(*camera.placement(), axes[1]));
        let pose = mirrored(pose, axes[0]);
        let mut display = MockDisplay::<Rgb565>::new();
        let Ok(()) = sides(PerspectiveImage::posed(&FRONT, &camera, &pose, size)).draw(&mut display);
        [24, 40].map(|x| display.get_pixel(Point::new(x, 32)).map(IntoStorage::into_storage))
    };
    let (plain, backed): (fn(_) -> _, fn(PerspectiveImage<'static>) -> _) =
        (|image| image, |image| image.back(&BACK));
    // Left and right change places; the front is seen as before.
    assert_eq!(shown([Some(0), None], plain), [Some(0xf800), Some(WHITE)]);
    assert_eq!(shown([Some(0), None], backed), [Some(0xf800), Some(WHITE)]);
    assert_eq!(shown([None, Some(0)], backed), [Some(0xf800), Some(WHITE)]);
    assert_eq!(shown([Some(0), Some(0)], backed), [Some(WHITE), Some(0xf800)]);
    // Top and bottom.
    assert_eq!(shown([Some(1), None], backed), [Some(WHITE), Some(0xf800)]);
    // The front is turned away: the back is seen, and what is written on it in a mirror.
    assert_eq!(shown([Some(2), None], plain), [None, None]);
    assert_eq!(shown([Some(2), None], backed), [Some(0x07e0), Some(0x001f)]);
    assert_eq!(shown([Some(2), None], PerspectiveImage::two_sided), [Some(WHITE), Some(0xf800)]);
}

#[test]
fn a_part_of_a_texture_shows_nothing_of_the_rest_1000_cases() {
    let sides = || (0..64_i32, 1..64_u32).prop_map(|(start, length)| (start, length.min(64 - start as u32)));
    let log2 = 5..9_u32; // packed coordinates with many and with few fraction bits
    let cases = (corners(), sides(), sides(), log2);
    for_all("direct: parts of textures", 1000, cases, |(corners, (x, width), (y, height), log2)| {
        let corners = unfolded(corners);
        let part = Rectangle::new(Point::new(x, y), Size::new(width, height));
        // Of a texture of 32 texels some of it lies beyond: there it shows again.
        let side = 1 << log2;
        let wrapped = |at: i32| at % side;
        let mut texels = vec![0x0000; (side * side) as usize];
        for Point { x, y } in part.points() {
            texels[(wrapped(y) * side + wrapped(x)) as usize] = WHITE;
        }
        let texture = Texture::new(&texels, log2, log2);
        let image = PerspectiveImage::new(&texture, &corners).expect("within range").part(&part);
        let mut screen = Screen::of(200, 200);
        image.back_part(&texture, &part).draw(&mut screen).expect("patience");
        prop_assert!(screen.pixels.values().all(|color| color.into_storage() == WHITE));
        Ok(())
    });
}

/// Which texel of a picture every pixel shows, as column + 256 · row.
fn shown(draw: impl Fn(&mut Screen<Rgb565>, &Texture<'_>), log2: [u32; 2]) -> HashMap<(i32, i32), usize> {
    // Their columns in one picture, and their rows in another.
    let side = |log2: u32| 0..1_u16 << log2;
    let columns: Vec<_> = side(log2[1]).flat_map(|_| side(log2[0])).collect();
    let rows: Vec<_> = side(log2[1]).flat_map(|row| side(log2[0]).map(move |_| row)).collect();
    let [columns, rows] = [columns, rows].map(|texels| {
        let mut screen = Screen::of(700, 700);
        draw(&mut screen, &Texture::new(&texels, log2[0], log2[1]));
        screen.pixels
    });
    let word = |color: &Rgb565| usize::from(color.into_storage());
    columns.iter().map(|(at, column)| (*at, word(column) + 256 * word(&rows[at]))).collect()
}

#[test]
fn a_picture_of_a_texel_a_pixel_shows_each_texel_once_800_cases() {
    let log2 = || prop_oneof![3 => 0..=6_u32, 1 => Just(7), 1 => Just(8)];
    let place = || prop_oneof![(0..200_i32).prop_map(|at| 2 * at), 0..400_i32];
    let cases = ([log2(), log2()], [place(), place()], 0..8_usize, 0..3_u8, any::<bool>());
    for_all("direct: 1:1", 800, cases, |(log2, [x, y], way, kind, shift)| {
        // Turned by so many quarters, and its back seen in half of the ways: then it is mirrored about its diagonal, too.
        let sides = if (way % 2 == 0) == (way < 4) { [log2[0], log2[1]] } else { [log2[1], log2[0]] };
        let sides = sides.map(|log2| 1 << log2);
        // From whole pixels on, or half ones: then coordinates are whole at the pixels' centres.
        let off = if shift { 8 } else { 0 };
        let at = [x * 16 + off, y * 16 + off];
        let to = [at[0] + 16 * sides[0], at[1] + 16 * sides[1]];
        let mut corners = [[at[0], at[1]], [at[0], to[1]], [to[0], to[1]], [to[0], at[1]]]
            .map(|at| at.map(|at| I12F4::from_bits(at as i16)));
        if way >= 4 {
            corners.swap(1, 3);
        }
        corners.rotate_left(way % 4);
        let texels = shown(
            |screen, texture| {
                let image = if kind == 0 {
                    let corners = corners.map(|[x, y]| ScreenVertex { x, y, ..ScreenVertex::default() });
                    PerspectiveImage::new(
                        texture,
                        &corners.map(|corner| ScreenVertex { q: U1F31::MAX >> 1, ..corner }),
                    )
                    .expect("within range")
                } else {
                    PerspectiveImage::between(texture, corners).expect("a rectangle")
                };
                let image = if kind == 2 { image.two_sided() } else { image.back(texture) };
                image.draw(screen).expect("patience");
            },
            log2,
        );
        let mut found: Vec<_> = texels.values().copied().collect();
        found.sort_unstable();
        let all = (0..1_usize << log2[1])
            .flat_map(|row| (0..1_usize << log2[0]).map(move |column| column + 256 * row));
        prop_assert!(found.into_iter().eq(all));
        Ok(())
    });
}

#[test]
fn a_posed_picture_of_a_texel_a_pixel_shows_each_texel_once() {
    for log2 in 0..=8 {
        let side = 1 << log2;
        for size in [Size::new(135, 240), Size::new(240, 240), Size::new(320, 241), Size::new(64, 65)] {
            // A pixel is 1/256 unit at a distance of 1: all of this is exact.
            let camera = Camera::focal(256.0, size);
            for quarter in 0..4 {
                for turned in [0, 180] {
                    let pose = Pose::IDENTITY
                        .rotated_y(Turn::from_degrees(turned))
                        .rotated_z(Turn::from_degrees(90 * quarter))
                        .at(Vec3::lit(0.0, 0.0, -1.0));
                    let extent = [I16F16::from_num(side) / 256; 2];
                    let texels = shown(
                        |screen, texture| {
                            let image = PerspectiveImage::posed(texture, &camera, &pose, extent);
                            image.back(texture).draw(screen).expect("patience");
                        },
                        [log2; 2],
                    );
                    let visible = (side.min(size.width as i32) * side.min(size.height as i32)) as usize;
                    let mut found: Vec<_> = texels.values().copied().collect();
                    found.sort_unstable();
                    found.dedup();
                    let all = (side as usize).pow(2);
                    // What the screen cuts off is a row or column more on one side, where the middle is between two pixels.
                    assert_eq!(found.len(), texels.len(), "{side}, {size:?}, {quarter}, {turned}");
                    assert_eq!(texels.len(), visible, "{side}, {size:?}, {quarter}, {turned}");
                    assert!(visible < all || found.iter().all(|texel| texel % 256 < side as usize));
                }
            }
        }
    }
}

#[test]
fn a_picture_between_four_points_lies_in_the_plane_that_looks_so_500_cases() {
    // A texel's word says where it is.
    let texels: Vec<u16> = (0..64 * 32).map(|i| (i / 32) << 5 | (i % 32)).collect();
    let texture = Texture::new(&texels, 5, 6);
    let cases = ([-60..60_i32, -60..60, 0..360], 2.0..5.0_f32);
    let (worst, all) = (std::cell::Cell::new(0), std::cell::Cell::new(0));
    for_all("direct: between points", 500, cases, |([yaw, pitch, roll], away)| {
        let [yaw, pitch, roll] = [yaw, pitch, roll].map(Turn::from_degrees);
        let camera = Camera::focal(300.0, Size::new(256, 256)).near(0.5);
        let pose = Pose::from_euler(yaw, pitch, roll).at(Vec3::lit(0.1, 0.2, -away));
        let size = [I16F16::from_num(2); 2];
        let place = |x: i32, y: i32| {
            let at = pose.transform_point(Vec3::new(I16F16::from_num(x), I16F16::from_num(y), I16F16::ZERO));
            camera.project(at).map(|at| [at.x, at.y])
        };
        let (Some(a), Some(b), Some(c), Some(d)) = (place(-1, 1), place(-1, -1), place(1, -1), place(1, 1))
        else {
            return Err(TestCaseError::reject("a corner is before the near plane"));
        };
        let (mut posed, mut between) = (Screen::of(256, 256), Screen::of(256, 256));
        PerspectiveImage::posed(&texture, &camera, &pose, size).draw(&mut posed).expect("patience");
        let image = PerspectiveImage::between(&texture, [a, b, c, d]).expect("a convex quadrilateral");
        image.draw(&mut between).expect("patience");
        for (at, color) in &posed.pixels {
            let Some(other) = between.pixels.get(at) else { continue };
            let (one, other) = (color.into_storage(), other.into_storage());
            let off = (one & 31).abs_diff(other & 31).max((one >> 5).abs_diff(other >> 5));
            worst.set(worst.get().max(off));
            all.set(all.get() + 1);
        }
        Ok(())
    });
    println!("direct: at most {} texels off at {} pixels", worst.get(), all.get());
    // Where texels meet.
    assert!(worst.get() <= 1 && all.get() > common::cases(500) * 1000);
}

#[test]
fn corners_that_no_picture_has_are_errors() {
    let texture = Texture::new(&[0; 4], 1, 1);
    let at = |points: [(i16, i16); 4]| points.map(|(x, y)| [I12F4::from_bits(x), I12F4::from_bits(y)]);
    let between = |points| PerspectiveImage::between(&texture, at(points)).err();
    assert_eq!(between([(0, 0), (0, 90), (90, 90), (90, 0)]), None);
    assert_eq!(between([(0, 0), (90, 0), (90, 90), (0, 90)]), None, "from behind");
    assert_eq!(between([(0, 0), (0, 90), (90, 0), (90, 90)]), Some(CornersError::NotConvex), "crossed");
    assert_eq!(between([(0, 0), (0, 90), (10, 10), (90, 0)]), Some(CornersError::NotConvex), "concave");
    assert_eq!(between([(0, 0), (0, 45), (0, 90), (90, 0)]), Some(CornersError::NotConvex), "straight");
    assert_eq!(between([(5, 5); 4]), Some(CornersError::NotConvex), "in one place");
    let (low, high) = (*GUARD_BAND.start() as i16, *GUARD_BAND.end() as i16);
    assert_eq!(between([(low, low), (low, high), (high, high), (high, low)]), None, "all of the guard band");
    assert_eq!(between([(low - 1, low), (low, high), (high, high), (high, low)]), Some(CornersError::Range));
    let corner = |x: i16, y: i16| ScreenVertex {
        x: I12F4::from_bits(x),
        y: I12F4::from_bits(y),
        u: I16F16::MAX, // not looked at
        ..ScreenVertex::default()
    };
    let good = [corner(low, low), corner(low, high), corner(high, high), corner(high, low)];
    assert!(PerspectiveImage::new(&texture, &good).is_ok());
    for bad in [corner(high + 1, 0), corner(0, low - 1)] {
        assert_eq!(
            PerspectiveImage::new(&texture, &[good[0], good[1], good[2], bad]).err(),
            Some(RangeError)
        );
        let triangle = [ScreenVertex::default(), ScreenVertex::default(), bad];
        assert_eq!(ShadedTriangle::new(&triangle, Cull::None, &Material::gouraud()).err(), Some(RangeError));
    }
    let triangle = [ScreenVertex { u: I16F16::MAX, ..ScreenVertex::default() }; 3];
    assert_eq!(ShadedTriangle::new(&triangle, Cull::None, &Material::gouraud()).err(), Some(RangeError));
}

#[test]
fn a_displays_error_ends_the_drawing_and_is_passed_on() {
    let texture = Texture::new(&[WHITE; 4], 1, 1);
    let (camera, pose, size) = turned(180);
    let image = PerspectiveImage::posed(&texture, &camera, &pose, size).two_sided();
    let mut whole = Screen::of(64, 64);
    assert_eq!(image.draw(&mut whole), Ok(()));
    assert!(whole.rows > 60, "two triangles of more than 30 rows");
    for patience in 0..whole.rows {
        let mut screen = Screen { patience, ..Screen::of(64, 64) };
        assert_eq!(image.draw(&mut screen), Err(Refused(patience + 1)));
        assert_eq!(screen.rows, patience + 1, "it was asked again");
    }
}

/// Areas that a target may say it has: of nothing, at the ends of the coordinates, of everything.
fn area() -> impl Strategy<Value = Rectangle> {
    let ends = || prop::sample::select(vec![i32::MIN, -1025, -1024, -3, 0, 5, 1020, 1022, 1023, i32::MAX]);
    let sides = || prop_oneof![40 => 0..12_u32, 1 => Just(u32::MAX), 1 => Just(1 << 31), 4 => 0..2000_u32];
    (ends(), ends(), sides(), sides())
        .prop_map(|(x, y, w, h)| Rectangle::new(Point::new(x, y), Size::new(w, h)))
}

#[test]
fn nothing_is_too_extreme_on_the_screen_1000_cases() {
    let (small, large) = (texels(2), texels(20));
    let (small, large) = (Texture::new(&small, 1, 1), Texture::new(&large, 10, 10));
    let place = || {
        let ends = vec![*GUARD_BAND.start(), *GUARD_BAND.end(), -8, 0, 8, 1023 * 16 - 8];
        prop_oneof![2 => GUARD_BAND, 2 => prop::sample::select(ends), 1 => -40..200_i32]
    };
    let vertex = move || {
        (place(), place(), any::<u32>(), 0..33_u32, -8192..=8192_i32, any::<[u16; 3]>()).prop_map(
            |(x, y, q, shift, u, color)| ScreenVertex {
                x: I12F4::from_bits(x as i16),
                y: I12F4::from_bits(y as i16),
                q: U1F31::from_bits(q.checked_shr(shift).unwrap_or(0)),
                u: I16F16::from_num(u),
                v: I16F16::from_num(-u),
                color: color.map(U8F8::from_bits),
            },
        )
    };
    let part = (any::<i32>(), any::<i32>(), any::<u32>(), any::<u32>());
    let cases = ([vertex(), vertex(), vertex(), vertex()], area(), part);
    for_all("direct: extremes on the screen", 1000, cases, |(corners, area, (x, y, w, h))| {
        let part = Rectangle::new(Point::new(x, y), Size::new(w, h));
        for half in halves(&corners) {
            let textured = Material::textured(&large).cull(Cull::None).texture_scale(8);
            let triangle = ShadedTriangle::new(&half, Cull::None, &textured).expect("within range");
            prop_assert_eq!(triangle.draw(&mut Screen::new(area)), Ok(()));
            let shaded = Material::gouraud();
            let triangle = ShadedTriangle::new(&half, Cull::None, &shaded).expect("within range").run::<1>();
            prop_assert_eq!(triangle.draw(&mut Screen::new(area)), Ok(()));
        }
        if is_unfolded(&corners) {
            let image = PerspectiveImage::new(&small, &corners).expect("within range");
            prop_assert_eq!(image.part(&part).back_part(&large, &part).draw(&mut Screen::new(area)), Ok(()));
        }
        let places = corners.map(|corner| [corner.x, corner.y]);
        if let Ok(image) = PerspectiveImage::between(&large, places) {
            prop_assert_eq!(image.two_sided().draw(&mut Screen::new(area)), Ok(()));
        }
        Ok(())
    });
}

#[test]
fn a_small_triangle_shows_nothing_on_a_target_at_an_end_of_all_coordinates() {
    let at = |x: i32, y: i32| ScreenVertex {
        x: I12F4::from_num(x),
        y: I12F4::from_num(y),
        q: U1F31::from_num(0.5),
        ..ScreenVertex::default()
    };
    let (shader, ends) =
        (Material::gouraud(), [i32::MIN, i32::MIN + 1, -2000, 2000, i32::MAX - 20, i32::MAX]);
    let mut draws = 0;
    for (x, y) in [(-900, -900), (-900, 900), (900, -900), (900, 900), (-3, -3)] {
        let corners = [at(x, y), at(x, y + 9), at(x + 9, y)];
        let triangle = ShadedTriangle::new(&corners, Cull::None, &shader).expect("within range");
        // Beyond a side, and as wide or high as all columns or rows, or neither.
        let areas = ends
            .into_iter()
            .flat_map(|end| [((end, -1023), (9, 2047)), ((-1023, end), (2047, 9)), ((end, end), (9, 9))]);
        for ((left, top), (width, height)) in areas {
            let mut screen = Screen::new(Rectangle::new(Point::new(left, top), Size::new(width, height)));
            assert_eq!(triangle.draw(&mut screen), Ok(()));
            assert!(screen.pixels.is_empty(), "{x}, {y} on {left}, {top}");
            draws += 1;
        }
        // And on one that has them all.
        let mut screen = Screen::new(Rectangle::new(Point::new(-1023, -1023), Size::new(u32::MAX, u32::MAX)));
        assert_eq!(triangle.draw(&mut screen), Ok(()));
        // Centres at or right of the left side, and left of the other: 9 + 8 + … or one less a row.
        assert!([36, 45].contains(&screen.pixels.len()), "{}", screen.pixels.len());
    }
    assert_eq!(draws, 90);
}

#[test]
fn nothing_is_too_extreme_in_the_world_3000_cases() {
    let texels = texels(10);
    let texture = Texture::new(&texels, 5, 5);
    let bits = || {
        prop_oneof![
            3 => -4 << 16..4 << 16_i32,
            1 => prop::sample::select(vec![i32::MIN, i32::MIN + 1, -1, 0, 1, i32::MAX]),
            1 => any::<i32>(),
        ]
    };
    let rotation =
        prop_oneof![2 => any::<[u16; 3]>().prop_map(Ok), 1 => any::<[[i16; 3]; 3]>().prop_map(Err)];
    let scale = || prop_oneof![2 => Just(1 << 22), 1 => any::<u32>(), 1 => Just(0)];
    let scale = prop_oneof![2 => scale().prop_map(|scale| [scale; 3]), 1 => [scale(), scale(), scale()]];
    let number = || {
        prop_oneof![
            3 => 0.01..300.0_f32,
            1 => prop::sample::select(vec![0.0, f32::NAN, f32::INFINITY, -1.0, 1e-9]),
        ]
    };
    let lens = (number(), number(), number(), any::<bool>(), (0..80_u32, 0..80_u32));
    let cases = (rotation, scale, [bits(), bits(), bits()], [bits(), bits()], lens, area());
    for_all("direct: extremes in the world", 3000, cases, |(rotation, scale, at, size, lens, area)| {
        let (focal, near, far, orthographic, (width, height)) = lens;
        let screen = Size::new(width, height);
        let camera =
            if orthographic { Camera::orthographic(focal, screen) } else { Camera::focal(focal, screen) };
        let [x, y, z] = at.map(I16F16::from_bits);
        let pose = match rotation {
            Ok(turns) => {
                let [yaw, pitch, roll] = turns.map(Turn::from_raw);
                Pose::from_euler(yaw, pitch, roll)
            }
            Err(bits) => Pose { rotation: bits.map(|row| row.map(I2F14::from_bits)), ..Pose::IDENTITY },
        };
        let pose = pose.at(Vec3::new(x, y, z)).stretched(scale.map(U10F22::from_bits));
        let size = size.map(I16F16::from_bits);
        for camera in [camera, camera.near(near), camera.near(near).far(far)] {
            let image = PerspectiveImage::posed(&texture, &camera, &pose, size).two_sided();
            let takes_twice = is_folded(&camera, &pose, size);
            prop_assert_eq!(image.draw(&mut Screen { takes_twice, ..Screen::new(area) }), Ok(()));
            let mut seen = Screen { takes_twice, ..Screen::of(80, 80) };
            prop_assert_eq!(image.draw(&mut seen), Ok(()));
            prop_assert!(seen.pixels.keys().all(|&(x, y)| x < width as i32 && y < height as i32));
        }
        Ok(())
    });
}

/// A display that does with the colours what it likes.
struct Careless(usize);

impl Dimensions for Careless {
    fn bounding_box(&self) -> Rectangle {
        MOCK
    }
}

impl DrawTarget for Careless {
    type Color = Rgb565;
    type Error = Infallible;

    fn draw_iter<I: IntoIterator<Item = Pixel<Rgb565>>>(&mut self, _: I) -> Result<(), Infallible> {
        Ok(())
    }

    fn fill_contiguous<I: IntoIterator<Item = Rgb565>>(
        &mut self,
        area: &Rectangle,
        colors: I,
    ) -> Result<(), Infallible> {
        let taken = colors.into_iter().take(self.0).count();
        assert_eq!(taken, self.0.min(area.size.width as usize));
        Ok(())
    }
}

#[test]
fn a_display_may_leave_colours_and_ask_for_more() {
    let texture = Texture::new(&[WHITE; 4], 1, 1);
    let (camera, pose, size) = turned(20);
    let image = PerspectiveImage::posed(&texture, &camera, &pose, size);
    for taken in [0, 1, 3, 64, usize::MAX] {
        assert_eq!(image.run::<3>().draw(&mut Careless(taken)), Ok(()));
    }
}

#[test]
fn a_posed_picture_fills_the_largest_displays_up_to_the_last_row_and_column() {
    let texture = Texture::new(&[WHITE; 4], 1, 1);
    for (width, height) in [(1, 1023), (1023, 1), (1023, 200), (200, 1023)] {
        let size = Size::new(width, height);
        for pixels in [512.0, 523.0, 1500.0, 8000.0] {
            for camera in [Camera::focal(pixels, size), Camera::orthographic(pixels, size)] {
                let camera = camera.at(Vec3::lit(0.0, 0.0, 1.0));
                let square = [I16F16::from_num(2); 2];
                for pose in [Pose::IDENTITY, Pose::IDENTITY.rotated_z(Turn::from_degrees(45)).scaled_lit(1.5)]
                {
                    let mut screen = Screen::of(width, height);
                    PerspectiveImage::posed(&texture, &camera, &pose, square)
                        .draw(&mut screen)
                        .expect("patience");
                    let missing = (0..height as i32)
                        .flat_map(|y| (0..width as i32).map(move |x| (x, y)))
                        .find(|place| !screen.pixels.contains_key(place));
                    assert_eq!(missing, None, "{size:?}, {camera:?}, {pose:?}");
                }
            }
        }
    }
    // And columns and rows −1023 … 1022 of a larger one, from corners at the ends of the guard band.
    let (low, high) = (*GUARD_BAND.start() as i16, *GUARD_BAND.end() as i16);
    let corners = [(low, low), (low, high), (high, high), (high, low)].map(|(x, y)| ScreenVertex {
        x: I12F4::from_bits(x),
        y: I12F4::from_bits(y),
        q: U1F31::MAX,
        ..ScreenVertex::default()
    });
    let image = PerspectiveImage::new(&texture, &corners).expect("within range");
    for (x, y, width, height) in [(-2000, 7, 4000, 1), (7, -2000, 1, 4000)] {
        let mut screen = Screen::new(Rectangle::new(Point::new(x, y), Size::new(width, height)));
        image.draw(&mut screen).expect("patience");
        let ends = |axis: fn(&(i32, i32)) -> i32| {
            (screen.pixels.keys().map(axis).min(), screen.pixels.keys().map(axis).max(), screen.pixels.len())
        };
        let found = if height == 1 { ends(|place| place.0) } else { ends(|place| place.1) };
        assert_eq!(found, (Some(-1023), Some(1022), 2046));
    }
}
