//! The promises of perspective and range, where materials really draw: in words of RGB565, with depth and without, in the loops that a
//! program gets. Textures say where they are, so that a picture's words tell the coordinates that were sampled, in whole texels: of
//! those that the texel stands for, the one nearest to the exact coordinate is measured. White texels tell light.
//!
//! Where a pixel is many texels a texel tells a small part of a pixel, and where a texel is many pixels how exact its border is.
//!
//! `cargo test decoded:: -- --nocapture` prints the largest errors by quality, family and texture: repeated, clamped and mirrored.
#![allow(clippy::float_arithmetic, reason = "errors are measured in f64")]

use crate::{common, reference};

use std::cell::{Cell, RefCell};
use std::ops::RangeInclusive;

use common::decoded::{
    Beyond, Case, Chart, FAMILIES, RATIOS, SURFACES, Shows, Surface, TEXTURES, Truth, case, colors, words,
};
use common::{cases, for_all};
use fixel::{Affine, Exact, Material, Quality, QuarterPixel, Texture};
use proptest::prelude::*;
use reference::UNIT;

/// The largest errors met.
#[derive(Clone, Copy, Debug, Default)]
struct Worst {
    /// In pixels; without end if what is shown is out of range.
    error: f64,
    pixels: u64,
    /// Of these: an error of the bound, and twice that, is not taken for another repetition of the texture or for its border.
    telling: u64,
    /// Of these: an error of the bound is a texel or more.
    fine: u64,
}

impl Worst {
    fn join(&mut self, other: Self) {
        self.error = self.error.max(other.error);
        self.pixels += other.pixels;
        self.telling += other.telling;
        self.fine += other.fine;
    }
}

/// How texels along an axis are decoded.
struct Decoder {
    side: i64,
    beyond: Beyond,
    /// The first and the last texel that may be sampled, of a texture without end.
    range: (i64, i64),
}

impl Decoder {
    fn new(case: &Case, axis: usize) -> Self {
        let (low, high) = case.triangle.range(axis);
        let scaled = |bits: i32| i64::from(bits) << case.scale;
        let range = (scaled(low) >> 16, scaled(high - 1).max(scaled(low)));
        // Below the largest there is always 2⁻¹⁶, which scale does not make a texel.
        let last = if high > low { (scaled(high) - 1) >> 16 } else { range.1 >> 16 };
        Self { side: 1 << TEXTURES[case.texture][axis], beyond: case.beyond, range: (range.0, last) }
    }

    /// How far the nearest of the coordinates that a texel may stand for is from `exact`, in texels. `None` if all of them are out of
    /// range.
    fn off(&self, texel: i64, exact: f64) -> Option<f64> {
        let (first, last) = self.range;
        let distance = |from: i64, end: i64| (from as f64 - exact).max(exact - end as f64).max(0.0);
        if self.beyond == Beyond::Clamped {
            let from = if texel == 0 { first.min(0) } else { texel };
            let end = if texel == self.side - 1 { last.max(texel) + 1 } else { texel + 1 };
            return (from <= last && end > first).then(|| distance(from, end));
        }
        let mirrored = self.beyond == Beyond::Mirrored;
        let period = if mirrored { 2 * self.side } else { self.side };
        let seen = if mirrored { vec![texel, period - 1 - texel] } else { vec![texel] };
        let turn = (exact / period as f64).floor() as i64;
        // Two more on either side: `exact` may be the end of the range.
        let places = seen.into_iter().flat_map(|at| (-2..=2).map(move |more| at + (turn + more) * period));
        places
            .filter(|place| (first..=last).contains(place))
            .map(|place| distance(place, place + 1))
            .reduce(f64::min)
    }

    /// Whether twice the bound is seen, in texels.
    fn tells(&self, texel: i64, bound: f64) -> bool {
        match self.beyond {
            Beyond::Repeated => 4.0 * bound < (self.side - 1) as f64,
            Beyond::Clamped => 0 < texel && texel < self.side - 1,
            // Farther from where it is seen in the mirror.
            Beyond::Mirrored => 4.0 * bound < (2 * texel.min(self.side - 1 - texel)) as f64,
        }
    }
}

/// Draws a case in a quality and decodes it: the largest error, and where it is.
fn measure<Q: Quality>(case: &Case, charts: &[Chart], truth: &Truth, bound: f64) -> (Worst, String) {
    let (mut worst, mut place) = (Worst::default(), String::new());
    for (texture, axes) in charts[case.texture].textures() {
        let scale = case.scale as u8;
        let textured = Material::textured(&texture).texture_scale(scale).quality::<Q>();
        let clamped = Material::clamped(&texture).texture_scale(scale).quality::<Q>();
        let mirrored = Material::mirrored(&texture).texture_scale(scale).quality::<Q>();
        let words = match (case.surface, case.beyond) {
            (Surface::Plain, Beyond::Repeated) => words(case, &textured),
            (Surface::Plain, Beyond::Clamped) => words(case, &clamped),
            (Surface::Plain, Beyond::Mirrored) => words(case, &mirrored),
            (_, Beyond::Repeated) => words(case, &textured.lit()),
            (_, Beyond::Clamped) => words(case, &clamped.lit()),
            (_, Beyond::Mirrored) => words(case, &mirrored.lit()),
        };
        for (axis, shift) in axes {
            let (decoder, field) = (Decoder::new(case, axis), truth.field(axis));
            let units = f64::from(1 << case.scale) / UNIT;
            for (((x, y), word), shows) in case.strip.pixels().zip(&words).zip(&truth.pixels) {
                if *shows != Shows::Triangle {
                    assert!(*word == 0, "{word} at {x}, {y}, where {shows:?} is to be seen");
                    continue;
                }
                let texel = i64::from(word >> shift) & (decoder.side - 1);
                let exact = field.at(x, y) * units;
                let off = decoder.off(texel, exact).unwrap_or(f64::INFINITY);
                let pixel = (field.step(x, y) * units).max(1.0);
                let telling = decoder.tells(texel, bound * pixel);
                worst.pixels += 1;
                worst.telling += u64::from(telling);
                worst.fine += u64::from(telling && bound * pixel >= 1.0);
                let error = off / pixel;
                if error > worst.error {
                    worst.error = error;
                    place = format!(
                        "axis {axis} at {x}, {y}: texel {texel} of {} is {off} texels from {exact} in {:?}, of which \
                         {pixel} are a pixel: {error} pixels",
                        decoder.side, decoder.range
                    );
                }
            }
        }
    }
    (worst, place)
}

/// What was met, by what.
struct Table {
    by_family: Vec<[[Worst; 3]; TEXTURES.len()]>,
    by_ratio: [Worst; RATIOS.len()],
    by_scale: [Worst; 9],
    by_surface: [Worst; SURFACES.len()],
}

impl Table {
    fn new() -> Self {
        Self {
            by_family: vec![Default::default(); FAMILIES.len()],
            by_ratio: Default::default(),
            by_scale: Default::default(),
            by_surface: Default::default(),
        }
    }

    fn add(&mut self, family: usize, case: &Case, found: Worst) {
        self.by_family[family][case.texture][case.beyond as usize].join(found);
        self.by_ratio[case.ratio].join(found);
        self.by_scale[case.scale as usize].join(found);
        let surface = SURFACES.iter().position(|surface| *surface == case.surface);
        self.by_surface[surface.expect("it is one of these")].join(found);
    }

    fn family(&self, family: usize) -> Worst {
        let mut worst = Worst::default();
        self.by_family[family].iter().flatten().for_each(|found| worst.join(*found));
        worst
    }

    fn print(&self, name: &str) {
        println!("{name}: largest errors in pixels: repeated, clamped, mirrored");
        let textures = TEXTURES.map(|[a, b]| format!("{:>19}", format!("{}×{}", 1 << a, 1 << b)));
        println!("{:9}{}     all     pixels    telling       fine", "", textures.concat());
        for (i, (family, found)) in FAMILIES.iter().zip(&self.by_family).enumerate() {
            let cells = found.map(|[repeat, clamp, mirror]| {
                format!(" {:.4}/{:.3}/{:.3}", repeat.error, clamp.error, mirror.error)
            });
            let Worst { error, pixels, telling, fine } = self.family(i);
            println!(
                "{:9}{}  {error:.4} {pixels:10} {telling:10} {fine:10}",
                format!("{family:?}"),
                cells.concat()
            );
        }
        let ratios =
            RATIOS.iter().zip(&self.by_ratio).map(|(ratio, found)| format!("  {ratio}: {:.4}", found.error));
        println!("by w 1 … {}", ratios.collect::<String>());
        let scales = (0..)
            .zip(&self.by_scale)
            .map(|(scale, found): (u32, _)| format!("  {scale}: {:.4}", found.error));
        println!("by texture_scale {}", scales.collect::<String>());
        let surfaces = SURFACES
            .iter()
            .zip(&self.by_surface)
            .map(|(surface, found)| format!("  {surface:?}: {:.4}", found.error));
        println!("by surface {}", surfaces.collect::<String>());
    }
}

/// How much of a picture has to be seen.
struct Seen {
    /// The largest error in each family.
    error: f64,
    /// Pixels a picture of which an error is seen, and seen finely.
    telling: u64,
    fine: u64,
}

/// Every family within a bound, with perspective or without.
fn hold<Q: Quality>(name: &str, usual: u32, straight: bool, bound: f64, seen: &Seen) {
    let charts = TEXTURES.map(Chart::new);
    let table = RefCell::new(Table::new());
    let mut broken = Vec::new();
    for (index, family) in FAMILIES.into_iter().enumerate() {
        let label = format!("{name}, {family:?}");
        let found = |case: &Case| {
            let truth = Truth::new(case, 0..2);
            measure::<Q>(case, &charts, &truth, bound)
        };
        let times = Cell::new(0);
        let all = std::panic::AssertUnwindSafe(|| {
            for_all(&label, usual, case(family, straight), |case| {
                let (found, _) = found(&case);
                times.set(times.get() + u32::from(found.error > bound));
                table.borrow_mut().add(index, &case, found);
                Ok(())
            });
        });
        if std::panic::catch_unwind(all).is_err() {
            broken.push(format!("{label}: it panics"));
            continue;
        }
        if times.get() > 0 {
            broken.push(format!("{label}: {} pictures", times.get()));
            // Again, for the smallest.
            let smallest = std::panic::AssertUnwindSafe(|| {
                for_all(&label, usual, case(family, straight), |case| {
                    let (found, place) = found(&case);
                    if found.error > bound { Err(TestCaseError::fail(place)) } else { Ok(()) }
                });
            });
            assert!(std::panic::catch_unwind(smallest).is_err(), "the cases are the same again");
        }
    }
    let table = table.into_inner();
    table.print(name);
    assert!(broken.is_empty(), "{name}, broken promises:\n{}", broken.join("\n"));
    // A quick look at a part of the cases need not see all.
    let each = u64::from(cases(usual));
    for (index, family) in FAMILIES.into_iter().enumerate().filter(|_| cases(usual) >= usual) {
        let Worst { error, telling, fine, .. } = table.family(index);
        assert!(telling > seen.telling * each, "{family:?}: {telling} pixels tell");
        assert!(fine > seen.fine * each, "{family:?}: {fine} pixels tell finely");
        assert!(error > seen.error, "{family:?}: {error} is the largest error seen");
    }
}

const SEEN: Seen = Seen { error: 0.01, telling: 10, fine: 2 };

#[test]
fn quarter_pixel_textures_are_within_a_quarter_of_a_pixel_in_5_000_pictures() {
    hold::<QuarterPixel>("QuarterPixel", 500, false, 0.25, &SEEN);
}

#[test]
fn exact_textures_are_within_a_fiftieth_of_a_pixel_in_5_000_pictures() {
    hold::<Exact>("Exact", 500, false, 0.02, &Seen { error: 1e-6, ..SEEN });
}

#[test]
fn quarter_pixel_is_within_a_quarter_of_a_pixel_on_straight_textures_in_2_000_pictures() {
    hold::<QuarterPixel>("straight, QuarterPixel", 200, true, 0.25, &Seen { error: 0.0, ..SEEN });
}

#[test]
fn exact_is_within_a_fiftieth_of_a_pixel_on_straight_textures_in_2_000_pictures() {
    hold::<Exact>("straight, Exact", 200, true, 0.02, &Seen { error: 0.0, ..SEEN });
}

#[test]
fn affine_is_within_a_quarter_of_a_pixel_on_straight_textures_in_2_000_pictures() {
    hold::<Affine>("straight, Affine", 200, true, 0.25, &Seen { error: 0.0, ..SEEN });
}

/// Red, green and blue of a word: 31, 63 and 31 are full.
fn channels(word: u16) -> [i32; 3] {
    [word >> 11, word >> 5 & 63, word & 31].map(i32::from)
}

/// What is shown of a channel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Levels {
    /// Of the vertices' colours: the step nearest to the channel, or to its whole part, as suits the loop.
    Gouraud,
    /// Likewise, always to its whole part.
    Whole,
    /// Of a white texel in that light: the same.
    Light,
}

impl Levels {
    /// The step nearest to a channel of 0 … 255, of which `full` is the most.
    fn nearest(level: f64, full: i32) -> i32 {
        (level * f64::from(full) / 255.0).round() as i32
    }

    /// What may be shown of a channel, at least and at most.
    fn shown(self, level: f64, full: i32) -> RangeInclusive<i32> {
        let most = if self == Self::Gouraud { level } else { level.floor() };
        Self::nearest(level.floor(), full)..=Self::nearest(most, full)
    }

    /// From which level on, and up to which, something is shown.
    fn of(self, shown: i32, full: i32) -> Option<(f64, f64)> {
        let mut levels = (0..256).map(f64::from).filter(|level| Self::nearest(*level, full) == shown);
        let first = levels.next()?;
        let least = (f64::from(shown) - 0.5) * 255.0 / f64::from(full);
        Some((if self == Self::Gouraud { least } else { first }, levels.next_back().unwrap_or(first) + 1.0))
    }
}

/// The largest errors of colours.
#[derive(Clone, Copy, Debug, Default)]
struct Off {
    /// In pixels.
    pixels: f64,
    /// In steps of the target's channel, where that is more than the bound.
    steps: f64,
    count: u64,
}

/// Draws colours, or white in a light, and decodes them.
fn measure_colors<Q: Quality>(case: &Case, levels: Levels, bound: f64) -> Result<Off, TestCaseError> {
    let white = [0xffff; 64];
    let texture = Texture::new(&white, 3, 3);
    let words = match levels {
        Levels::Gouraud | Levels::Whole => words(case, &Material::gouraud().quality::<Q>()),
        Levels::Light => match case.beyond {
            Beyond::Repeated => words(case, &Material::textured(&texture).lit().quality::<Q>()),
            Beyond::Clamped => words(case, &Material::clamped(&texture).lit().quality::<Q>()),
            Beyond::Mirrored => words(case, &Material::mirrored(&texture).lit().quality::<Q>()),
        },
    };
    let truth = Truth::new(case, 2..5);
    let mut off = Off::default();
    for channel in 0..3 {
        let full = if channel == 1 { 63 } else { 31 };
        let (low, high) = case.triangle.range(2 + channel);
        let [least, most] = [low, high].map(|bits| levels.shown(f64::from(bits) / UNIT, full));
        let range = *least.start()..=*most.end();
        let field = truth.field(2 + channel);
        for (((x, y), word), shows) in case.strip.pixels().zip(&words).zip(&truth.pixels) {
            let shown = channels(*word)[channel];
            if *shows != Shows::Triangle {
                prop_assert_eq!(shown, 0, "at {}, {}, where {:?} is to be seen", x, y, shows);
                continue;
            }
            prop_assert!(
                range.contains(&shown),
                "channel {channel} at {x}, {y}: {shown} is not in {range:?}"
            );
            let exact = field.at(x, y) / UNIT;
            let (from, end) = levels.of(shown, full).expect("a channel has all levels");
            let error = (from - exact).max(exact - end).max(0.0);
            let by_pixel = error / (field.step(x, y) / UNIT).max(1.0);
            let by_step = if by_pixel > bound { error * f64::from(full) / 255.0 } else { 0.0 };
            prop_assert!(
                by_step <= 1.0,
                "channel {channel} at {x}, {y}: {shown} of {full} is {error} from {exact}: {by_pixel} pixels"
            );
            off.pixels = off.pixels.max(by_pixel);
            off.steps = off.steps.max(by_step);
            off.count += 1;
        }
    }
    Ok(off)
}

/// Every family within a bound, with perspective and some without; the largest error of each is at least `seen`.
fn hold_colors<Q: Quality>(name: &str, usual: u32, gouraud: Levels, bound: f64, seen: f64) {
    println!(
        "{name}: largest errors in pixels, (in steps if beyond the bound), grey and not, of gouraud and of light"
    );
    for family in FAMILIES {
        let worst = RefCell::new([Off::default(); 4]);
        let pictures =
            (case(family, false), case(family, true), prop::bool::weighted(0.1), colors(), any::<bool>());
        for_all(
            &format!("{name}, {family:?}"),
            usual,
            pictures,
            |(bent, straight, is_straight, colors, light)| {
                let mut case = if is_straight { straight } else { bent };
                for (corner, color) in case.triangle.0.iter_mut().zip(colors) {
                    corner.attributes[2..].copy_from_slice(&color);
                }
                let found = measure_colors::<Q>(&case, if light { Levels::Light } else { gouraud }, bound)?;
                let is_gray = colors.iter().all(|color| color[1..] == [color[0]; 2]);
                let off = &mut worst.borrow_mut()[2 * usize::from(light) + usize::from(!is_gray)];
                off.pixels = off.pixels.max(found.pixels);
                off.steps = off.steps.max(found.steps);
                off.count += found.count;
                Ok(())
            },
        );
        let worst = worst.into_inner();
        let cells =
            worst.map(|Off { pixels, steps, count }| format!("  {pixels:.4} ({steps:.3}) of {count:7}"));
        println!("{:9}{}", format!("{family:?}"), cells.concat());
        let each = u64::from(cases(usual));
        let is_part = cases(usual) < usual;
        assert!(is_part || worst.iter().all(|off| off.count > 5 * each), "{family:?}: too few channels");
        let largest = worst.iter().fold(0_f64, |all, off| all.max(off.pixels));
        assert!(is_part || largest >= seen, "{family:?}: {largest} is the largest error seen");
    }
}

#[test]
fn quarter_pixel_colors_and_light_are_within_the_bound_in_3_000_pictures() {
    hold_colors::<QuarterPixel>("colours, QuarterPixel", 300, Levels::Gouraud, 0.25, 0.01);
}

#[test]
fn exact_colors_and_light_are_within_the_bound_in_2_000_pictures() {
    hold_colors::<Exact>("colours, Exact", 200, Levels::Whole, 0.02, 0.0);
}

/// What truth is read from here is what the reference says of every pixel.
#[test]
fn truth_is_the_references_in_400_pictures() {
    let compared = Cell::new(0_u64);
    for family in FAMILIES {
        for_all(&format!("truth, {family:?}"), 40, case(family, false), |case| {
            let truth = Truth::new(&case, 0..2);
            for (((x, y), shows), axis) in
                case.strip.pixels().zip(&truth.pixels).zip([0, 1].into_iter().cycle())
            {
                if *shows != Shows::Nothing {
                    let (exact, field) = (case.triangle.at(x, y), truth.field(axis));
                    prop_assert_eq!(field.at(x, y), exact.attribute(axis));
                    prop_assert_eq!(field.step(x, y), exact.change(axis).step);
                    compared.set(compared.get() + 1);
                }
            }
            Ok(())
        });
    }
    assert!(compared.get() > 10_000 || cases(40) < 40, "{} pixels", compared.get());
}
