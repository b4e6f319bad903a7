//! The promise, seen through the crate's own materials and the loops they are drawn with: the texel that is fetched is
//! one that lies within the contract's bound of the exact texture coordinates, repeated, clamped or mirrored, and the colour is
//! within that bound of the exact one. Never one from outside the range of the triangle's three vertices.
#![allow(clippy::float_arithmetic, reason = "errors are measured in f64")]

use crate::{common, reference};

use std::cell::Cell;

use common::decoded::Beyond;
use common::generate::{strip, triangle};
use common::{Canvas, Drawn, Record, Recording, Strip, for_all};
use fixel::embedded_graphics::pixelcolor::Rgb565;
use fixel::embedded_graphics::pixelcolor::raw::RawU16;
use fixel::material::LitKind;
use fixel::{
    Affine, Cull, Exact, Inputs, Material, NoDepth, Pixels, Quality, QuarterPixel, Shader, Surface, Texture,
    TextureError, Varying,
};
use proptest::prelude::*;
use reference::{Corner, Sample, Triangle, UNIT};

/// log₂ of width and height.
const SIZES: [(u32, u32); 10] =
    [(0, 0), (0, 10), (10, 0), (1, 3), (3, 1), (4, 4), (5, 8), (8, 8), (9, 2), (10, 10)];

/// How far ahead of itself a straight coordinate may be seen, in units of 2⁻¹⁶ before it is multiplied by 2^`scale_log2`: the
/// stated error of the paths. Packed coordinates leave 1/8 texel at the most, a plane 1/24 on the largest screen, and 1/256 of
/// what it changes over a pixel.
fn ahead(triangle: &Triangle, axis: usize, scale_log2: u32) -> i128 {
    let straight = |x, y| triangle.at(x, y).straight(axis).value();
    let change = (straight(1, 0) - straight(0, 0)).abs() + (straight(0, 1) - straight(0, 0)).abs();
    (8192 >> scale_log2) + 2731 + (change / 256.0) as i128
}

/// A texture whose texels say in which column they are, and one for the rows.
struct Chart {
    log2: (u32, u32),
    columns: Vec<u16>,
    rows: Vec<u16>,
}

impl Chart {
    fn new(log2: (u32, u32)) -> Self {
        let (width, height) = (1 << log2.0, 1 << log2.1);
        Self {
            log2,
            columns: (0..height).flat_map(|_| 0..width).collect(),
            rows: (0..height).flat_map(|row| (0..width).map(move |_| row)).collect(),
        }
    }

    fn textures(&self) -> [(Texture<'_>, u32); 2] {
        [(&self.columns, self.log2.0), (&self.rows, self.log2.1)]
            .map(|(texels, log2)| (Texture::new(texels, self.log2.0, self.log2.1), log2))
    }
}

/// From where to where an attribute may be, in units of 2⁻¹⁶.
fn tolerated(triangle: &Triangle, exact: &Sample<'_>, attribute: usize, bound: f64) -> (f64, f64) {
    let off = bound * exact.change(attribute).step.max(UNIT);
    let (low, high) = triangle.sampled(attribute);
    let value = exact.attribute(attribute);
    ((value - off).max(f64::from(low)), (value + off).min(f64::from(high)))
}

/// A surface that writes down what it shows.
type Recorded<'a> = Surface<'a, Recording, NoDepth>;

fn of_texture<'a, Q: Quality>(texture: &Texture<'a>, beyond: Beyond) -> Recorded<'a> {
    scaled_texture::<Q>(texture, beyond, 0, false)
}

fn scaled_texture<'a, Q: Quality>(
    texture: &Texture<'a>,
    beyond: Beyond,
    scale_log2: u32,
    is_lit: bool,
) -> Recorded<'a> {
    fn of<'a, K: LitKind, Q: Quality>(material: Material<'a, K, Q>, is_lit: bool) -> Recorded<'a> {
        if is_lit { (&material.lit()).into() } else { (&material).into() }
    }
    let scale_log2 = scale_log2 as u8;
    match beyond {
        Beyond::Repeated => of(Material::textured(texture).texture_scale(scale_log2).quality::<Q>(), is_lit),
        Beyond::Clamped => of(Material::clamped(texture).texture_scale(scale_log2).quality::<Q>(), is_lit),
        Beyond::Mirrored => of(Material::mirrored(texture).texture_scale(scale_log2).quality::<Q>(), is_lit),
    }
}

/// Whether a texel is met between two coordinates.
fn met(texel: i64, side: i64, beyond: Beyond, (low, high): (f64, f64)) -> bool {
    let (first, last) = ((low / UNIT).floor() as i64, (high / UNIT).floor() as i64);
    if beyond == Beyond::Clamped {
        return (first.clamp(0, side - 1)..=last.clamp(0, side - 1)).contains(&texel);
    }
    last - first >= 2 * side || (first..=last).any(|place| beyond.texel(place, side) == texel)
}

fn draw<'a>(strip: Strip, triangle: &Triangle, surface: impl Into<Recorded<'a>>) -> Vec<Drawn> {
    let mut canvas = Canvas::new::<NoDepth>(strip);
    canvas
        .draw::<Recording, NoDepth, _>(triangle, Cull::None, surface)
        .expect("the triangle is within range");
    canvas.pixels
}

/// With u and v divided by 2^`log2`.
fn stretched(mut triangle: Triangle, log2: u32) -> Triangle {
    for corner in &mut triangle.0 {
        for texel in &mut corner.attributes[..2] {
            *texel >>= log2;
        }
    }
    triangle
}

/// Whether all texels along one axis that a triangle shows are within the bound.
fn fetches_within<'a>(
    strip: Strip,
    triangle: &Triangle,
    surface: impl Into<Recorded<'a>>,
    (axis, log2, beyond, bound): (usize, u32, Beyond, f64),
    mut tells: impl FnMut(f64, f64),
) -> Result<(), TestCaseError> {
    for ((x, y), drawn) in strip.pixels().zip(draw(strip, triangle, surface)) {
        prop_assert_eq!(drawn.written, triangle.covers(x, y));
        if !drawn.written {
            continue;
        }
        let texel = i64::from(drawn.attributes[0]);
        let within = tolerated(triangle, &triangle.at(x, y), axis, bound);
        let fits = met(texel, 1 << log2, beyond, within);
        let (low, high) = (within.0 / UNIT, within.1 / UNIT);
        prop_assert!(
            fits,
            "axis {} at {}, {}: texel {} of {} for a coordinate of {} … {}",
            axis,
            x,
            y,
            texel,
            1 << log2,
            low,
            high
        );
        tells(low, high);
    }
    Ok(())
}

fn textured<Q: Quality>(name: &str, usual: u32, bound: f64) {
    let charts: &'static [Chart] = Vec::leak(SIZES.map(Chart::new).into());
    let (fetched, telling) = (Cell::new(0_u64), Cell::new(0_u64));
    // Textures that are stretched show more of an error than those of which each pixel sees another texel.
    let cases = strip()
        .prop_flat_map(|strip| (Just(strip), triangle(strip), 0..9_u32, 0..SIZES.len(), Beyond::any()));
    for_all(name, usual, cases, |(strip, triangle, stretch, chart, beyond)| {
        let triangle = stretched(triangle, stretch);
        for (attribute, (texture, log2)) in charts[chart].textures().into_iter().enumerate() {
            let surface = of_texture::<Q>(&texture, beyond);
            let tells = |low: f64, high: f64| {
                fetched.set(fetched.get() + 1);
                telling.set(telling.get() + u64::from(high - low < f64::from(1 << log2) / 2.0));
            };
            fetches_within(strip, &triangle, surface, (attribute, log2, beyond, bound), tells)?;
        }
        Ok(())
    });
    println!(
        "{name}: {} texels fetched, {} of them with at most half the texture to choose from",
        fetched.get(),
        telling.get()
    );
    assert!(telling.get() > 10 * u64::from(common::cases(usual)));
}

#[test]
fn quarter_pixel_fetches_a_texel_within_the_bound_for_4_000_triangles() {
    textured::<QuarterPixel>("texels, QuarterPixel", 4000, 0.25);
}

#[test]
fn exact_fetches_a_texel_within_the_bound_for_4_000_triangles() {
    textured::<Exact>("texels, Exact", 4000, 0.02);
}

/// Found by hill climbing: a row of 31 pixels, in which 8 fraction bits of a step were too few.
#[test]
fn a_small_triangle_with_a_large_texture_is_within_the_bound() {
    let chart = Chart::new((8, 8));
    let corner = |(x, y), q, u| Corner { x, y, q, attributes: [u, 0, 0, 0, 0] };
    let triangle = Triangle([
        corner((509, 437), 622_582_660, 385_027),
        corner((504, 1), 654_830_733, 1_328_034),
        corner((3, 201), 632_578_662, 58_456),
    ]);
    let (texture, log2) = chart.textures()[0];
    let at = (0, log2, Beyond::Repeated, 0.25);
    fetches_within(Strip::new(40, 40, 0), &triangle, &Material::textured(&texture), at, |_, _| ())
        .expect("it is within the bound");
}

/// Packed, each repeat of u along a row moves v by its last bit, 1/256 texel of 256. Here u repeats up to seven times in a row of 32
/// pixels, and v is a whole number at each corner: so it is close to a texel that it must not show.
#[test]
fn rows_in_which_u_repeats_often_keep_v_in_its_range_3_000_cases() {
    let chart: &'static Chart = Box::leak(Box::new(Chart::new((8, 8))));
    let position = || (0..512_i32, 0..512_i32);
    let q = || 600_000_000..660_000_000_u32;
    let corner = || (position(), q(), 0..4_i32);
    let cases = ((corner(), corner(), corner()), -60..=60_i32, -60..=60_i32, any::<bool>());
    let telling = Cell::new(0_u32);
    for_all("u repeats in rows", 3000, cases, |((a, b, c), right, down, is_level)| {
        let corner = |((x, y), q, v): ((i32, i32), u32, i32)| {
            // In units of 2⁻¹⁶, of texels a pixel and 1/16 px.
            let u = (right * x + down * y) << 12;
            let q = if is_level { 610_000_000 } else { q };
            Corner { x, y, q, attributes: [u, v << 16, 0, 0, 0] }
        };
        let triangle = Triangle([corner(a), corner(b), corner(c)]);
        let (texture, log2) = chart.textures()[1];
        let at = (1, log2, Beyond::Repeated, 0.25);
        let tells = |low: f64, high: f64| telling.set(telling.get() + u32::from(high - low < 2.0));
        fetches_within(Strip::new(32, 32, 0), &triangle, &Material::textured(&texture), at, tells)
    });
    assert!(telling.get() > 10 * common::cases(3000));
}

/// Level and slow: nothing but a step's bits makes an error.
#[test]
fn level_rows_of_textures_are_within_the_bound_600_cases() {
    let charts = [2, 5, 6, 7, 8, 9].map(|log2| Chart::new((log2, log2)));
    let cases = (0..6_usize, 20..1000_i32, 0.01..1.0_f64, 0..1 << 24_i32);
    for_all("level rows", 600, cases, |(chart, width, slope, start)| {
        let end = start + (f64::from(width) * slope * 65536.0) as i32;
        let corner = |x, y, u| Corner { x: x * 16, y: y * 16, q: 1 << 29, attributes: [u, 0, 0, 0, 0] };
        let triangle = Triangle([corner(0, 0, start), corner(0, 4, start), corner(width, 2, end)]);
        let strip = Strip::new(1000, 4, 0);
        let (texture, log2) = charts[chart].textures()[0];
        let at = |bound| (0, log2, Beyond::Repeated, bound);
        let material = Material::textured(&texture);
        fetches_within(strip, &triangle, &material, at(0.25), |_, _| ())?;
        fetches_within(strip, &triangle, &material.exact(), at(0.02), |_, _| ())
    });
}

/// Whether all texels along one axis of a straight triangle are those at its coordinates, on the right side of whole ones and
/// never beyond the vertices' range.
fn straight_texels(
    strip: Strip,
    triangle: &Triangle,
    surface: Recorded<'_>,
    (axis, log2, beyond): (usize, u32, Beyond),
    (scale_log2, ahead): (u32, i128),
) -> Result<u32, TestCaseError> {
    let side = 1 << log2;
    let shows = |right: &std::ops::RangeInclusive<i128>, texel: i128| {
        if beyond == Beyond::Clamped {
            return (*right.start()).clamp(0, side - 1) <= texel
                && texel <= (*right.end()).clamp(0, side - 1);
        }
        right
            .clone()
            .take(2 * side as usize)
            .any(|right| i128::from(beyond.texel(right as i64, side as i64)) == texel)
    };
    let mut telling = 0;
    for ((x, y), drawn) in strip.pixels().zip(draw(strip, triangle, surface)) {
        if !drawn.written {
            continue;
        }
        let texel = i128::from(drawn.attributes[0]);
        let straight = triangle.at(x, y).straight(axis);
        let right = straight.texels(scale_log2, ahead);
        prop_assert!(
            shows(&right, texel),
            "axis {} at {}, {}: texel {} of {} ({:?}) for {} · 2^{}, which is one of {:?}",
            axis,
            x,
            y,
            texel,
            side,
            beyond,
            straight.value() / UNIT,
            scale_log2,
            right
        );
        telling += u32::from(right.start() == right.end());
    }
    Ok(telling)
}

/// Gradients that make coordinates whole at many pixel centres, in 1/16 texels a pixel.
fn gradient() -> impl Strategy<Value = i32> {
    prop_oneof![
        4 => prop::sample::select(&[0, 0, 16, -16, 32, -32, 8, -8, 1, -1, 4, 64][..]),
        1 => -40..=40,
        1 => -4000..=4000,
    ]
}

/// Of a triangle: u and v that are exact at every 1/16 pixel, and whole at many centres.
fn on_lattice(triangle: &Triangle, gradients: [[i32; 2]; 2], starts: [i32; 2]) -> Option<Triangle> {
    let mut triangle = *triangle;
    for corner in &mut triangle.0 {
        for axis in 0..2 {
            let [right, down] = gradients[axis];
            // 1/16 texel a pixel is 2⁸ units of 2⁻¹⁶ a 1/16 pixel.
            let value =
                (i64::from(right) * i64::from(corner.x - 8) + i64::from(down) * i64::from(corner.y - 8)) << 8;
            let value = value + (i64::from(starts[axis]) << 12);
            if value.abs() > 8000 << 16 {
                return None;
            }
            corner.attributes[axis] = value as i32;
        }
    }
    Some(triangle)
}

/// Straight triangles with textures of all sizes, in every quality.
fn straight_triangles(name: &str, usual: u32, lattice: bool) {
    let charts: &'static [Chart] = Vec::leak(SIZES.map(Chart::new).into());
    let start = || prop_oneof![Just(0), -300..=300];
    let cases = strip().prop_flat_map(move |strip| {
        let plane = ([[gradient(), gradient()], [gradient(), gradient()]], [start(), start()]);
        // The nearest possible, and far away.
        let q = prop::sample::select(&[(1_u32 << 31) - 1, 1 << 30, 1 << 20, 7][..]);
        let texture = (0..SIZES.len(), Beyond::any(), prop_oneof![2 => Just(0), 1 => 0..=8_u32]);
        (Just(strip), triangle(strip), plane, (q, 0..9_u32), texture)
    });
    let telling = Cell::new(0_u64);
    for_all(name, usual, cases, |(strip, triangle, (gradients, starts), (q, stretch), texture)| {
        let (chart, beyond, scale_log2) = texture;
        // Beyond ±32768 texels coordinates begin anew, which no texture that repeats shows.
        let scale_log2 = if beyond == Beyond::Repeated { scale_log2 } else { 0 };
        let mut triangle = if !lattice {
            stretched(triangle, stretch)
        } else if let Some(triangle) = on_lattice(&triangle, gradients, starts) {
            triangle
        } else {
            return Ok(());
        };
        for (axis, (texture, log2)) in charts[chart].textures().into_iter().enumerate() {
            let [affine, quarter_pixel, exact] =
                [scaled_texture::<Affine>, scaled_texture::<QuarterPixel>, scaled_texture::<Exact>]
                    .map(|make| [false, true].map(|is_lit| make(&texture, beyond, scale_log2, is_lit)));
            let by = (axis, log2, beyond);
            let error = (scale_log2, ahead(&triangle, axis, scale_log2));
            // Full light, grey or not, leaves texels as they are.
            for corner in &mut triangle.0 {
                let blue = if stretch & 1 == 0 { 255 << 16 } else { 0xff_80_00 };
                corner.attributes[2..].copy_from_slice(&[255 << 16, 255 << 16, blue]);
            }
            let mut all = 0;
            for surface in affine {
                all += straight_texels(strip, &triangle, surface, by, error)?;
            }
            for corner in &mut triangle.0 {
                corner.q = q;
            }
            for surface in [quarter_pixel, exact].into_iter().flatten() {
                all += straight_texels(strip, &triangle, surface, by, error)?;
            }
            telling.set(telling.get() + u64::from(all));
        }
        Ok(())
    });
    println!("{name}: {} texels that are the only right one", telling.get());
    assert!(telling.get() > 100 * u64::from(common::cases(usual)));
}

#[test]
fn straight_triangles_sample_right_of_centres_and_within_their_range_4_000_cases() {
    straight_triangles("straight texels, whole at centres", 2000, true);
    straight_triangles("straight texels, anywhere", 2000, false);
}

/// Top left, bottom left, bottom right, top right, of a sprite between two places (1/16 px) with textures coordinates between
/// others (2⁻¹⁶), mirrored and turned in one of 8 ways.
fn sprite([left, top, right, bottom]: [i32; 4], [u0, v0, u1, v1]: [i32; 4], way: usize) -> [Corner; 4] {
    let places = [[left, top], [left, bottom], [right, bottom], [right, top]];
    let mut uv = [[u0, v0], [u0, v1], [u1, v1], [u1, v0]];
    if way >= 4 {
        uv.reverse();
    }
    uv.rotate_left(way % 4);
    std::array::from_fn(|i| {
        let ([x, y], [u, v]) = (places[i], uv[i]);
        Corner { x, y, q: (1 << 31) - 1, attributes: [u, v, 255 << 16, 255 << 16, 255 << 16] }
    })
}

/// Its two triangles, by either diagonal.
fn halves([a, b, c, d]: [Corner; 4], other: bool) -> [Triangle; 2] {
    if other {
        [Triangle([b, c, d]), Triangle([b, d, a])]
    } else {
        [Triangle([a, b, c]), Triangle([a, c, d])]
    }
}

/// What both show together.
fn draw_both<'a>(strip: Strip, halves: &[Triangle; 2], surface: impl Into<Recorded<'a>>) -> Vec<Drawn> {
    let surface = surface.into();
    let mut canvas = Canvas::new::<NoDepth>(strip);
    for half in halves {
        canvas.draw::<Recording, NoDepth, _>(half, Cull::None, surface).expect("within range");
    }
    canvas.pixels
}

/// The texel that every pixel of a sprite has to show along an axis.
fn sprite_texels(halves: &[Triangle; 2], strip: Strip, axis: usize, scale_log2: u32) -> Vec<Option<i128>> {
    let texel = |(x, y)| {
        let half = halves.iter().find(|half| half.covers(x, y))?;
        Some(*half.at(x, y).straight(axis).texels(scale_log2, 0).start())
    };
    strip.pixels().map(texel).collect()
}

#[test]
fn sprites_show_every_texel_as_often_as_they_should_2_000_cases() {
    let charts: &'static [Chart] =
        Vec::leak([0, 2, 3, 5, 6, 7, 8, 9].map(|log2| Chart::new((log2, log2))).into());
    // How many texels for how many pixels.
    let ratios = prop::sample::select(&[(1, 1), (1, 1), (1, 1), (2, 1), (1, 2), (3, 1), (4, 1)][..]);
    let place = || {
        prop_oneof![(0..40_i32).prop_map(|px| 16 * px), (0..40_i32).prop_map(|px| 16 * px + 8), 0..640_i32]
    };
    let size = || prop_oneof![3 => 1..20_i32, 1 => 1..130_i32, 1 => prop::sample::select(&[1, 2, 4, 8, 16, 32, 64, 128, 256][..])];
    let cases = (
        ([place(), place()], [size(), size()], ratios),
        ([-100..300_i32, -100..300_i32], 0..8_usize, any::<bool>()),
        (
            0..charts.len(),
            Beyond::any(),
            prop_oneof![3 => Just(0), 1 => 0..4_u32],
            prop::sample::select(&[1 << 30, (1_u32 << 31) - 1][..]),
        ),
    );
    let shown = Cell::new(0_usize);
    for_all(
        "sprites",
        2000,
        cases,
        |(([x, y], [w, h], (texels, px)), (from, way, diagonal), (chart, beyond, scale_log2, q))| {
            // Coordinates at centres are whole, or 1/16 texel away from that, of which 2^`scale_log2` times as much is seen.
            let grid = if scale_log2 > 0 { 8 } else { px };
            let [x, y] = [x, y].map(|at| at / grid * grid);
            // Whole texels, on as many pixels; turned by 90° what was its width is its height.
            let from = if beyond == Beyond::Clamped { [0; 2] } else { from };
            let on_screen = if way % 2 == 0 { [w, h] } else { [h, w] };
            let to = [x + 16 * px * on_screen[0], y + 16 * px * on_screen[1]];
            let uv = [from[0], from[1], from[0] + texels * w, from[1] + texels * h]
                .map(|texel| texel << (16 - scale_log2));
            let corners = sprite([x, y, to[0], to[1]], uv, way).map(|corner| Corner { q, ..corner });
            let halves = halves(corners, diagonal);
            let strip = Strip::new((to[0] as u32).div_ceil(16), (to[1] as u32).div_ceil(16), 0);
            for (axis, (texture, log2)) in charts[chart].textures().into_iter().enumerate() {
                let side = 1 << log2;
                let expected: Vec<_> = sprite_texels(&halves, strip, axis, scale_log2)
                    .into_iter()
                    .map(|texel| texel.map(|texel| i128::from(beyond.texel(texel as i64, side))))
                    .collect();
                let pictures = [
                    scaled_texture::<QuarterPixel>(&texture, beyond, scale_log2, false),
                    scaled_texture::<Affine>(&texture, beyond, scale_log2, false),
                    scaled_texture::<Exact>(&texture, beyond, scale_log2, false),
                    scaled_texture::<QuarterPixel>(&texture, beyond, scale_log2, true),
                ]
                .map(|surface| draw_both(strip, &halves, surface));
                for (kind, picture) in pictures.into_iter().enumerate() {
                    for (((x, y), drawn), texel) in strip.pixels().zip(picture).zip(&expected) {
                        let seen = drawn.written.then_some(i128::from(drawn.attributes[0]));
                        prop_assert_eq!(seen, *texel, "axis {}, kind {}, at {}, {}", axis, kind, x, y);
                    }
                }
                // 1:1, every column or row of texels is seen as often as the other side is long, whatever the rule says.
                if (texels, px) == (1, 1) && beyond == Beyond::Repeated {
                    let mut times = vec![0; side as usize];
                    for texel in expected.iter().flatten() {
                        times[*texel as usize] += 1;
                    }
                    let (count, other) = if axis == 0 { (w, h) } else { (h, w) };
                    let mut right = vec![0; side as usize];
                    for texel in from[axis]..from[axis] + count {
                        right[texel.rem_euclid(side as i32) as usize] += other;
                    }
                    prop_assert_eq!(times, right);
                }
                shown.set(shown.get() + expected.iter().flatten().count());
            }
            Ok(())
        },
    );
    println!("sprites: {} texels seen", shown.get());
}

#[test]
fn a_sprite_of_16_texels_by_hand() {
    // 4 × 4 texels on 4 × 4 pixels from 264/16, 1224/16: coordinates are whole at the centres of 16 pixels.
    let chart = Chart::new((2, 2));
    let strip = Strip::new(24, 8, 74);
    let halves = halves(sprite([264, 1224, 264 + 64, 1224 + 64], [0, 0, 4 << 16, 4 << 16], 0), false);
    let [columns, rows] = chart.textures().map(|(texture, _)| {
        let picture = draw_both(strip, &halves, &Material::textured(&texture));
        let at = |x: u32, y: u32| picture[((76 + y - strip.row) * strip.width + 16 + x) as usize];
        [0, 1, 2, 3].map(|y| [0, 1, 2, 3].map(|x| at(x, y).attributes[0]))
    });
    assert_eq!(columns, [[0, 1, 2, 3]; 4]);
    assert_eq!(rows, [[0; 4], [1; 4], [2; 4], [3; 4]]);
}

/// Outside case: the opposite border at one pixel.
#[test]
fn a_wall_of_64_texels_shows_no_opposite_border() {
    let chart = Chart::new((6, 6));
    let corner = |x, y, u, v| Corner { x, y, q: 1 << 30, attributes: [u << 16, v << 16, 0, 0, 0] };
    let triangle = Triangle([corner(566, 684, 0, 0), corner(706, 615, 64, 0), corner(243, 130, 64, 64)]);
    let strip = Strip::new(60, 60, 0);
    let mut record = Record::blank(strip);
    record.record::<QuarterPixel>(&triangle, Cull::None, Inputs::Uv);
    let at = (9 * strip.width + 16) as usize;
    // 63.99936 exactly, and to the right more: so from there on, but not 64.
    let u = f64::from(record.pixels[at].attributes[0]) / UNIT;
    assert!((63.999_36..64.0).contains(&u), "{u}");
    assert_eq!(triangle.at(16, 9).straight(0).texels(0, 0), 63..=63);
    let picture = draw(strip, &triangle, &Material::textured(&chart.textures()[0].0));
    assert_eq!(picture[at].attributes[0], 63);
}

fn gouraud(name: &str, bound: f64, surface: Recorded<'_>) {
    let cases = strip().prop_flat_map(|strip| (Just(strip), triangle(strip)));
    for_all(name, 3000, cases, |(strip, triangle)| {
        for ((x, y), drawn) in strip.pixels().zip(draw(strip, &triangle, surface)) {
            prop_assert_eq!(drawn.written, triangle.covers(x, y));
            for channel in if drawn.written { 2..5 } else { 0..0 } {
                let (low, high) = tolerated(&triangle, &triangle.at(x, y), channel, bound);
                // A whole number of 1/255, rounded either way.
                let within = (low / UNIT).floor()..=(high / UNIT).ceil();
                let value = drawn.attributes[channel];
                prop_assert!(
                    within.contains(&f64::from(value)),
                    "{} at {}, {}: {} in {:?}",
                    channel,
                    x,
                    y,
                    value,
                    within
                );
            }
        }
        Ok(())
    });
}

#[test]
fn gouraud_blends_colors_within_the_bound_for_6_000_triangles() {
    gouraud("colours, QuarterPixel", 0.25, (&Material::gouraud()).into());
    gouraud("colours, Exact", 0.02, (&Material::gouraud().exact()).into());
}

#[test]
fn affine_materials_stay_within_range_for_4_000_triangles() {
    textured_within_range();
    let cases = strip().prop_flat_map(|strip| (Just(strip), triangle(strip)));
    for_all("colours, Affine", 2000, cases, |(strip, triangle)| {
        for drawn in draw(strip, &triangle, &Material::gouraud().affine()) {
            for channel in if drawn.written { 2..5 } else { 0..0 } {
                let (low, high) = triangle.range(channel);
                prop_assert!((low >> 16..=high >> 16).contains(&drawn.attributes[channel]));
            }
        }
        Ok(())
    });
}

fn textured_within_range() {
    let chart = Chart::new((10, 10));
    let cases = strip().prop_flat_map(|strip| (Just(strip), triangle(strip)));
    for_all("texels, Affine", 2000, cases, |(strip, triangle)| {
        for (attribute, (texture, log2)) in chart.textures().into_iter().enumerate() {
            for beyond in Beyond::ALL {
                let (low, high) = triangle.sampled(attribute);
                let within = (f64::from(low), f64::from(high));
                for drawn in draw(strip, &triangle, of_texture::<Affine>(&texture, beyond)) {
                    let texel = i64::from(drawn.attributes[0]);
                    prop_assert!(!drawn.written || met(texel, 1 << log2, beyond, within));
                }
            }
        }
        Ok(())
    });
}

#[test]
fn flat_is_one_color_in_every_quality() {
    let cases = strip().prop_flat_map(|strip| (Just(strip), triangle(strip), any::<u16>()));
    for_all("flat", 1000, cases, |(strip, triangle, word)| {
        let material = Material::flat(Rgb565::from(RawU16::new(word)));
        let pictures = [
            draw(strip, &triangle, &material),
            draw(strip, &triangle, &material.exact()),
            draw(strip, &triangle, &material.affine()),
        ];
        for ((x, y), index) in strip.pixels().zip(0..) {
            let expected = if triangle.covers(x, y) { Some(i32::from(word)) } else { None };
            for picture in &pictures {
                let drawn = picture[index];
                prop_assert_eq!(drawn.written.then_some(drawn.attributes[0]), expected);
            }
        }
        Ok(())
    });
}

#[test]
fn textures_of_a_wrong_length_are_typed_errors() {
    let sizes = (prop_oneof![0..12_u32, any::<u32>()], prop_oneof![0..12_u32, any::<u32>()], 0..3000_usize);
    for_all("texture size", 10_000, sizes, |(width, height, slip)| {
        let needed = (width <= 10 && height <= 10).then(|| 1_usize << (width + height));
        let found = needed
            .map_or(slip, |needed| (needed + slip / 2 * (slip % 2)).saturating_sub(slip / 3 * (slip % 2)));
        let texels = vec![0; found];
        let made = Texture::try_new(&texels, width, height).map(|_| ());
        let expected = match needed {
            None => Err(TextureError::TooLarge),
            Some(expected) if expected != found => Err(TextureError::Length { expected, found }),
            Some(_) => Ok(()),
        };
        prop_assert_eq!(made, expected);
        Ok(())
    });
}

#[test]
fn pictures_of_4_texels_by_hand() {
    // One texel a pixel, without perspective: repeated, the chart itself; clamped, its border around it;
    // mirrored, the chart turned round.
    let chart = Chart::new((1, 1));
    let corner = |x: i32, y: i32| reference::Corner {
        x: 16 * x,
        y: 16 * y,
        q: 1 << 30,
        attributes: [x << 16, y << 16, 0, 0, 0],
    };
    let triangle = Triangle([corner(-20, -20), corner(-20, 40), corner(40, -20)]);
    let strip = Strip::new(5, 1, 1);
    let fetch = |beyond| {
        let (texture, _) = chart.textures()[0];
        let drawn = draw(strip, &triangle, of_texture::<QuarterPixel>(&texture, beyond));
        drawn.iter().map(|drawn| drawn.attributes[0]).collect::<Vec<_>>()
    };
    assert_eq!(fetch(Beyond::Repeated), [0, 1, 0, 1, 0]);
    assert_eq!(fetch(Beyond::Clamped), [0, 1, 1, 1, 1]);
    assert_eq!(fetch(Beyond::Mirrored), [0, 1, 1, 0, 0]);
    let mut record = Record::blank(strip);
    record.record::<Exact>(&triangle, Cull::Back, fixel::Inputs::Uv);
    let column = record.pixels.iter().map(|drawn| f64::from(drawn.attributes[0]) / UNIT);
    for (value, expected) in column.zip([0.5, 1.5, 2.5, 3.5, 4.5]) {
        assert!((value - expected).abs() < 0.02);
    }
}

/// Texels of one axis, by `color` alone or painted many at once.
struct Painted {
    axis: usize,
    at_once: bool,
}

impl Shader<Recording> for Painted {
    type Quality = QuarterPixel;

    fn inputs(&self) -> Inputs {
        Inputs::Uv
    }

    fn color(&self, at: &Varying) -> Drawn {
        texel([at.u, at.v][self.axis].to_bits())
    }

    fn paint<P: Pixels<Drawn, QuarterPixel>>(&self, pixels: P) {
        match (self.axis, self.at_once) {
            (0, true) => pixels.shade(|[u]| texel(u)),
            (_, true) => pixels.shade(|[_, v]| texel(v)),
            (axis, false) => pixels.shade(|at: [i32; 2]| texel(at[axis])),
        }
    }
}

/// The default of `Shader::paint`.
struct Plain(Painted);

impl Shader<Recording> for Plain {
    type Quality = QuarterPixel;

    fn inputs(&self) -> Inputs {
        Inputs::Uv
    }

    fn color(&self, at: &Varying) -> Drawn {
        self.0.color(at)
    }
}

fn texel(bits: i32) -> Drawn {
    Drawn { attributes: [bits, 0, 0, 0, 0], written: true }
}

#[test]
fn a_shader_that_paints_many_pixels_at_once_shows_what_its_color_says_1_000_cases() {
    let seen = Cell::new(0_u64);
    let cases = strip().prop_flat_map(|strip| (Just(strip), triangle(strip), 0..2_usize));
    for_all("painted", 1000, cases, |(strip, triangle, axis)| {
        let mut pictures = [0, 1, 2].map(|_| Canvas::new::<NoDepth>(strip));
        let [plain, each, at_once] = &mut pictures;
        let painted = |at_once| Painted { axis, at_once };
        plain
            .draw::<Recording, NoDepth, _>(&triangle, Cull::None, Surface::new(&Plain(painted(false))))
            .expect("it is within range");
        each.draw::<Recording, NoDepth, _>(&triangle, Cull::None, Surface::new(&painted(false)))
            .expect("it is within range");
        at_once
            .draw::<Recording, NoDepth, _>(&triangle, Cull::None, Surface::new(&painted(true)))
            .expect("it is within range");
        prop_assert_eq!(&plain.pixels, &each.pixels);
        prop_assert_eq!(&plain.pixels, &at_once.pixels);
        seen.set(seen.get() + plain.pixels.iter().filter(|drawn| drawn.written).count() as u64);
        Ok(())
    });
    assert!(seen.get() > 10_000, "{} pixels", seen.get());
}
