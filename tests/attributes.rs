//! The promise: for the default quality every attribute is within ¼ pixel of exact: its error, divided by
//! max(1 texel or 1/255, its largest exact change over one pixel step in x or y), is at most ¼; at most 0.02 for
//! `Exact`; unbounded for `Affine`. No attribute leaves the range of its triangle's three vertices. And 1/w is within
//! one step of a 16-bit depth buffer.
//!
//! `cargo test attributes:: -- --nocapture` prints the largest errors by quality, ratio of w and family.
#![allow(clippy::float_arithmetic, reason = "errors are measured in f64")]

use crate::{common, reference};

use std::cell::RefCell;
use std::fmt;

use common::generate::GUARD_BAND;
use common::perspective::{Case, FAMILIES, RATIOS, any_case, case, mesh_case};
use common::{Canvas, Drawn, Record, Recorder, Recording, Strip, cases, for_all};
use fixel::{Affine, Cull, Depth16, Exact, Inputs, PixelFormat, Quality, QuarterPixel, Surface};
use proptest::prelude::*;
use reference::{ATTRIBUTES, Corner, Triangle, UNIT};

/// The largest errors met.
#[derive(Clone, Copy, Debug, Default)]
struct Worst {
    /// Of u and v, by the contract's measure.
    texels: f64,
    /// Of the colours, by the contract's measure.
    color: f64,
    /// Of the colours that are off by less than a step of the format, in levels of 1/255.
    levels: f64,
    /// Of either, measured by the derivative at the pixel's centre instead of the step to its neighbours.
    by_derivative: f64,
    /// Of 1/w, in depth steps.
    depth: f64,
    pixels: u64,
}

impl Worst {
    fn join(&mut self, other: Self) {
        self.texels = self.texels.max(other.texels);
        self.color = self.color.max(other.color);
        self.by_derivative = self.by_derivative.max(other.by_derivative);
        self.depth = self.depth.max(other.depth);
        self.pixels += other.pixels;
    }
}

impl fmt::Display for Worst {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { texels, color, by_derivative, depth, .. } = self;
        write!(out, "{texels:.4} {color:.4} ({by_derivative:.4}) {depth:.3}")
    }
}

/// Which of u, v, red, green, blue a shader reads.
fn reads(inputs: Inputs) -> [bool; ATTRIBUTES] {
    let (uv, color) = match inputs {
        Inputs::None => (false, false),
        Inputs::Uv => (true, false),
        Inputs::Color => (false, true),
        Inputs::UvColor => (true, true),
    };
    [uv, uv, color, color, color]
}

/// The exact value that a quality stands for, where it promises one.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Promise {
    /// Of a pixel; a colour may be off by so many levels of 1/255 instead.
    Within(f64, f64),
    Nothing,
}

/// Within so much of a pixel. The contract's quarter of one allows a colour a step of the format's finest channel, too.
fn within(bound: f64) -> Promise {
    Promise::Within(bound, if bound < 0.25 { 0.0 } else { f64::from(<Recording as PixelFormat>::COLOR_STEP) })
}

/// Draws a triangle and measures it, or says what promise it breaks.
fn measure<Q: Quality>(case: &Case, promise: Promise) -> Result<Worst, String> {
    let Case { strip, triangle, inputs, hidden } = case;
    let mut record = Record::blank(*strip);
    record.hide(*hidden);
    record.record::<Q>(triangle, Cull::None, *inputs);
    let mut stored = Canvas::<Drawn, u16>::new::<Depth16>(*strip);
    stored
        .draw::<Recording, Depth16, _>(triangle, Cull::None, Surface::new(&Recorder::<Q>::new(*inputs)))
        .map_err(|error| format!("{error:?}"))?;
    let mut worst = Worst::default();
    for (((x, y), drawn, met), word) in record.iter().zip(&stored.depth) {
        if met.times == 0 {
            continue;
        }
        let exact = triangle.at(x, y);
        worst.pixels += 1;
        let depth = exact.depth_error(met.q);
        let error = i128::from(*word) - exact.depth_word();
        if depth > 1.0 || error.abs() > 1 || u32::from(*word) != (met.q >> 15).max(1) {
            return Err(format!(
                "at {x}, {y}: q = {} and depth {word}, exactly {} and {}",
                met.q,
                exact.q(),
                exact.depth_word()
            ));
        }
        worst.depth = worst.depth.max(depth);
        if met.hidden == drawn.written {
            return Err(format!("at {x}, {y}: hidden is {}, and drawn is {}", met.hidden, drawn.written));
        }
        if met.hidden {
            continue;
        }
        for (attribute, reads) in reads(*inputs).into_iter().enumerate() {
            let value = drawn.attributes[attribute];
            let (low, high) = if reads { triangle.sampled(attribute) } else { (0, 0) };
            if !(low..=high).contains(&value) {
                return Err(format!(
                    "attribute {attribute} at {x}, {y}: {value} is not within {low} … {high}"
                ));
            }
            let Promise::Within(bound, levels) = promise else { continue };
            if !reads {
                continue;
            }
            let error = (f64::from(value) - exact.attribute(attribute)).abs() / UNIT;
            let largest = if attribute < 2 { &mut worst.texels } else { &mut worst.color };
            // The measure divides by at least 1, so it takes an error above the largest to raise it.
            if error <= *largest && error <= worst.by_derivative {
                continue;
            }
            if attribute >= 2 && error <= levels {
                worst.levels = worst.levels.max(error);
                continue;
            }
            let change = exact.change(attribute);
            let measured = error / (change.step / UNIT).max(1.0);
            let by_derivative = error / (change.derivative / UNIT).max(1.0);
            if measured > bound {
                return Err(format!(
                    "attribute {attribute} at {x}, {y}: {} is {error} off from {} with {change:?}: {measured} of a \
                     pixel, {by_derivative} by the derivative; q is {} against {}",
                    f64::from(value) / UNIT,
                    exact.attribute(attribute) / UNIT,
                    met.q,
                    exact.q(),
                ));
            }
            *largest = largest.max(measured);
            worst.by_derivative = worst.by_derivative.max(by_derivative);
        }
    }
    Ok(worst)
}

/// A small generator of numbers for the climb, after Marsaglia.
struct Dice(u64);

impl Dice {
    fn roll(&mut self, sides: u64) -> u64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 11) % sides
    }

    /// Within ±`reach`, small numbers more often.
    fn off(&mut self, reach: u64) -> i32 {
        let reach = 1 << self.roll(u64::from(reach.ilog2()) + 1);
        self.roll(2 * reach + 1) as i32 - reach as i32
    }

    /// The case with one thing changed a little. It keeps the ratio of w, or lowers it.
    fn changed(&mut self, case: &Case, ratio: u32) -> Option<Case> {
        let mut changed = *case;
        let corner = &mut changed.triangle.0[self.roll(3) as usize];
        let limits = GUARD_BAND;
        match self.roll(4) {
            0 => corner.x = (corner.x + self.off(256)).clamp(*limits.start(), *limits.end()),
            1 => corner.y = (corner.y + self.off(256)).clamp(*limits.start(), *limits.end()),
            2 => {
                let attribute = &mut corner.attributes[self.roll(2) as usize];
                *attribute = (*attribute + self.off(1 << 26)).clamp(-(2000 << 16), 2000 << 16);
            }
            _ => {
                let scaled = f64::from(corner.q) * (1.0 + f64::from(self.off(1 << 10)) / 1024.0 * 0.5);
                corner.q = scaled.round().clamp(1.0, 2_f64.powi(31) - 1.0) as u32;
            }
        }
        let [low, high] = [u32::min, u32::max]
            .map(|pick| changed.triangle.0.map(|corner| corner.q).into_iter().reduce(pick));
        (u64::from(high?) <= u64::from(low?) * u64::from(ratio)).then_some(changed)
    }
}

/// Changes the worst case found at random little by little, keeping what is worse still.
fn climb<Q: Quality>(mut case: Case, ratio: u32, steps: u32, bound: f64) -> Result<Worst, String> {
    let mut dice = Dice(0x9e37_79b9_7f4a_7c15 ^ u64::from(ratio));
    let mut worst = measure::<Q>(&case, within(bound))?;
    for _ in 0..steps {
        let Some(next) = dice.changed(&case, ratio) else { continue };
        let found = measure::<Q>(&next, within(bound)).map_err(|broken| format!("{broken} for {next:?}"))?;
        if found.texels >= worst.texels {
            (case, worst) = (next, found);
        }
    }
    Ok(worst)
}

/// Every family at every ratio of w within a bound: at random, then from the worst of these uphill.
fn hold<Q: Quality>(name: &str, bound: f64) {
    let each = 200;
    let header: String = RATIOS.iter().map(|ratio| format!("{:^31}", format!("w 1 … {ratio}"))).collect();
    let mut table = format!(
        "{name}: largest errors of u and v, of colours, (of either, by the derivative), of 1/w in depth steps\n\
         {:10}{header}\n",
        ""
    );
    let mut broken = Vec::new();
    let mut by_ratio = RATIOS.map(|_| Worst::default());
    for family in FAMILIES {
        let mut line = format!("{:10}", format!("{family:?}"));
        for (ratio, total) in RATIOS.into_iter().zip(&mut by_ratio) {
            let worst = RefCell::new((Worst::default(), None));
            let label = format!("{name}, {family:?}, w 1 … {ratio}");
            let run = std::panic::catch_unwind(std::panic::AssertUnwindSafe(|| {
                for_all(&label, each, case(family, ratio), |case| {
                    let found = measure::<Q>(&case, within(bound)).map_err(TestCaseError::fail)?;
                    let mut worst = worst.borrow_mut();
                    if found.texels >= worst.0.texels {
                        worst.1 = Some(case);
                    }
                    worst.0.join(found);
                    Ok(())
                });
            }));
            let (mut worst, start) = worst.into_inner();
            if run.is_err() {
                broken.push(label);
            } else if let Some(start) = start {
                match climb::<Q>(start, ratio, cases(2 * each), bound) {
                    Ok(found) => worst.join(found),
                    Err(reason) => broken.push(format!("{label}, climbing: {reason}")),
                }
            }
            total.join(worst);
            line += &format!("{:^31}", worst.to_string());
        }
        table += &format!("{line}\n");
    }
    let totals: String = by_ratio.iter().map(|worst| format!("{:^31}", worst.to_string())).collect();
    let pixels: u64 = by_ratio.iter().map(|worst| worst.pixels).sum();
    let runs = FAMILIES.len() as u32 * RATIOS.len() as u32 * cases(each);
    println!(
        "{table}{:10}{totals}\n{runs} random triangles and {} climbing, {pixels} pixels",
        "all",
        2 * runs
    );
    assert!(broken.is_empty(), "{} broken promises:\n{}", broken.len(), broken.join("\n"));
    assert!(pixels > 10 * u64::from(runs), "only {pixels} pixels measured");
}

#[test]
fn exact_is_within_a_fiftieth_of_a_pixel_for_12_000_random_triangles() {
    hold::<Exact>("Exact", 0.02);
}

#[test]
fn quarter_pixel_is_within_a_quarter_of_a_pixel_for_12_000_random_triangles() {
    hold::<QuarterPixel>("QuarterPixel", 0.25);
}

#[test]
fn affine_stays_within_range_for_12_000_random_triangles_and_is_exact_where_w_is_equal() {
    let mut flat = Worst::default();
    for family in FAMILIES {
        let total = RefCell::new(Worst::default());
        for_all(&format!("Affine, {family:?}, w 1 … 1"), 200, case(family, 1), |case| {
            total.borrow_mut().join(measure::<Affine>(&case, within(0.02)).map_err(TestCaseError::fail)?);
            Ok(())
        });
        flat.join(total.into_inner());
        for ratio in &RATIOS[1..] {
            for_all(&format!("Affine, {family:?}, w 1 … {ratio}"), 200, case(family, *ratio), |case| {
                measure::<Affine>(&case, Promise::Nothing).map_err(TestCaseError::fail)?;
                Ok(())
            });
        }
    }
    println!("Affine with equal w: {flat} over {} pixels", flat.pixels);
}

fn hold_anything<Q: Quality>(name: &str, bound: f64) {
    // Beyond a ratio of 65536 only the range is promised, and the error just printed.
    for (log2_ratio, bound) in [(15, bound), (20, f64::INFINITY), (25, f64::INFINITY), (30, f64::INFINITY)] {
        let label = format!("{name}, ±8192 texels, w 1 … 2^{}", log2_ratio + 1);
        let total = RefCell::new(Worst::default());
        for_all(&label, 5_000, any_case(log2_ratio), |case| {
            total.borrow_mut().join(measure::<Q>(&case, within(bound)).map_err(TestCaseError::fail)?);
            Ok(())
        });
        let total = total.into_inner();
        println!("{label}: {total} over {} pixels", total.pixels);
    }
}

#[test]
fn exact_holds_for_5_000_triangles_of_any_distances() {
    hold_anything::<Exact>("Exact", 0.02);
}

#[test]
fn quarter_pixel_holds_for_5_000_triangles_of_any_distances() {
    hold_anything::<QuarterPixel>("QuarterPixel", 0.25);
}

/// Small triangles, which have loops of their own.
fn hold_in_meshes<Q: Quality>(name: &str, bound: f64) {
    let total = RefCell::new(Worst::default());
    for_all(&format!("{name}, of a mesh"), 30_000, mesh_case(), |case| {
        total.borrow_mut().join(measure::<Q>(&case, within(bound)).map_err(TestCaseError::fail)?);
        Ok(())
    });
    let total = total.into_inner();
    println!("{name}, of a mesh: {total} over {} pixels", total.pixels);
}

#[test]
fn exact_holds_for_30_000_triangles_of_a_mesh() {
    hold_in_meshes::<Exact>("Exact", 0.02);
}

#[test]
fn quarter_pixel_holds_for_30_000_triangles_of_a_mesh() {
    hold_in_meshes::<QuarterPixel>("QuarterPixel", 0.25);
}

/// Texture coordinates that differ by so few last bits that a small triangle has no room for a margin inside their range, or not at all.
#[test]
fn coordinates_that_hardly_change_stay_in_range_in_4_000_triangles() {
    fn hold<Q: Quality>() {
        let bits = prop::array::uniform3(prop::array::uniform2(prop_oneof![Just(0), 0..3_i32, 0..3_000_i32]));
        let base = prop::array::uniform2(prop_oneof![
            Just(0),
            -70_000..70_000_i32,
            any::<i16>().prop_map(i32::from)
        ]);
        let cases = (0..FAMILIES.len(), 1..RATIOS.len())
            .prop_flat_map(|(family, ratio)| case(FAMILIES[family], RATIOS[ratio]));
        for_all("hardly changing", 2_000, (cases, base, bits), |(mut case, base, bits)| {
            for (corner, bits) in case.triangle.0.iter_mut().zip(bits) {
                for i in 0..2 {
                    corner.attributes[i] = base[i] + bits[i];
                }
            }
            measure::<Q>(&case, within(1.0)).map(|_| ()).map_err(TestCaseError::fail)
        });
    }
    hold::<QuarterPixel>();
    hold::<Exact>();
}

/// Rows of few pixels at one distance each, across which all texels there are go by: a wall's far end, seen from its side.
fn steep_and_level() -> impl Strategy<Value = Case> {
    let widths = prop_oneof![2 => 8..48_i32, 1 => 8..400_i32];
    let places = ((0..600_i32, 0..400_i32, -2..=2_i32), (0..640_i32, -8000..8000_i32), widths);
    let q = (12..31_u32, 0.0..1.0_f64, 0.0..4.0_f64);
    let limit = 8192 << 16;
    let end = move || prop_oneof![2 => Just(limit), 1 => limit / 2..=limit];
    let texels = (end(), end(), -limit / 4..=limit / 4, any::<bool>());
    (places, q, texels).prop_map(|(((x, y, tilt), (top_x, above), width), (size, part, fall), texels)| {
        let near = ((1.0 + part) * f64::from(1_u32 << size)).min(2_f64.powi(31) - 1.0);
        let far = (near * (-fall).exp2()).max(1.0);
        let (left, right, middle, turned) = texels;
        let (left, right) = if turned { (left, -right) } else { (-left, right) };
        let corner =
            |x: i32, y: i32, q: f64, u: i32| Corner { x, y, q: q as u32, attributes: [u, -u, 0, 0, 0] };
        let triangle = Triangle([
            corner(top_x, y - above, near, middle),
            corner(x, y, far, left),
            corner(x + width, y + tilt, far, right),
        ]);
        Case { strip: Strip::new(40, 28, 0), triangle, inputs: Inputs::Uv, hidden: 0 }
    })
}

fn hold_where_rows_are_steep<Q: Quality>(name: &str, bound: f64) {
    let total = RefCell::new(Worst::default());
    for_all(&format!("{name}, steep rows"), 20_000, steep_and_level(), |case| {
        total.borrow_mut().join(measure::<Q>(&case, within(bound)).map_err(TestCaseError::fail)?);
        Ok(())
    });
    let total = total.into_inner();
    println!("{name}, steep rows: {total} over {} pixels", total.pixels);
}

#[test]
fn quarter_pixel_holds_where_a_row_has_all_texels_20_000_cases() {
    hold_where_rows_are_steep::<QuarterPixel>("QuarterPixel", 0.25);
}

#[test]
fn exact_holds_where_a_row_has_all_texels_20_000_cases() {
    hold_where_rows_are_steep::<Exact>("Exact", 0.02);
}

/// Wide and high, of distances that change much from row to row and so little along a row that it may count as level, or not quite:
/// by a 64th of a pixel's error to 16 pixels' along the tangent.
fn nearly_level() -> impl Strategy<Value = Case> {
    let sizes = (prop_oneof![3 => 8..=200_i32, 1 => 200..=1022_i32], 2..=8_i32);
    let texels = || -(2000 << 16)..=2000_i32 << 16;
    let falls = (-8.0..=6.0_f64, any::<bool>(), 0.5..4.0_f64);
    (sizes, falls, [texels(), texels(), texels()], 0..=15_i32).prop_map(
        |((width, height), (error, rises, ratio), texels, off)| {
            // Over L pixels it is L² · q′/q in pixels.
            let fall = error.exp2() / f64::from(width);
            let nearest = if rises { 1.0 / (1.0 + fall) } else { 1.0 };
            let corner = |x: i32, y: i32, share: f64, u: i32| {
                let q = (share * nearest * (2_f64.powi(31) - 1.0)) as u32;
                Corner { x, y, q, attributes: [u, -u, 0, 0, 0] }
            };
            let along = if rises { 1.0 + fall } else { (1.0 - fall).max(1e-4) };
            let triangle = Triangle([
                corner(off, 0, 1.0, texels[0]),
                corner(16 * width + off, 0, along, texels[1]),
                corner(off, 16 * height, 1.0 / ratio.exp2(), texels[2]),
            ]);
            Case {
                strip: Strip::new(width as u32, height as u32, 0),
                triangle,
                inputs: Inputs::Uv,
                hidden: 0,
            }
        },
    )
}

#[test]
fn quarter_pixel_holds_where_rows_are_nearly_level_3_000_cases() {
    let total = RefCell::new(Worst::default());
    for_all("nearly level rows", 3_000, nearly_level(), |case| {
        let found = measure::<QuarterPixel>(&case, within(0.25)).map_err(TestCaseError::fail)?;
        total.borrow_mut().join(found);
        Ok(())
    });
    let total = total.into_inner();
    println!("nearly level rows: {total} over {} pixels", total.pixels);
}
