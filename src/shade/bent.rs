//! Rows in perspective that neither `near_horizon` nor `level` of [`perspective`](super::perspective) takes.
//!
//! - In: a row of a triangle that is set up, or a part of one.
//! - Out: its curve, in whichever form takes it; or none, if it is too long for any.
//! - Assumes: q is above 0 along the row.
//!
//! Here each row is looked at: which form takes it, and whether its slope comes from the horizon or from the values at both ends.

use super::curve::{CHORD_LOG2, Linear, MOST_IN_CHORDS, distance, fraction_bits};
use super::inverses::{ONE_LOG2, inverse};
use super::packed::shifted;
use super::perspective::{NEAR_STEP, Perspective, Way};
use super::units::Form;
use crate::math::recip::{Reciprocal, looked_up};
use crate::num::{IS_ARMV6M, mul_high, mul_high_signed, normalise, wide};
use crate::raster::{Attribute, Place, TriangleSetup};
use core::hint::black_box;

/// The most steps in the general forms: so that n/w fits 16 bits, and the table is off by 63/1024 pixel at most.
const MOST_GENERAL: u32 = 63;

/// An end of a part of a row of an extreme triangle: 1/q there, and in a sliver by how much corners 1 and 2 count.
struct End {
    place: Place,
    weights: [u32; 2],
}

/// Which end of a part that is; both if it is one pixel.
#[derive(Clone, Copy)]
enum Which {
    Near,
    Far,
    Both,
}

impl Perspective<'_> {
    /// Sets the curve of a part of a row, `steps` + 1 pixels from (x, y) on. Not of an extreme triangle.
    #[inline(never)]
    pub(super) fn bent(&mut self, x: i32, y: i32, steps: u32) -> Way {
        let near = &self.near(x, y, steps);
        let Some((way, (size, down))) = self.start(near, steps) else {
            return Way::None;
        };
        let is_table = way == Way::Table && self.units.form == Form::Modular;
        self.set_lines(steps, way, |attribute, _| {
            let above = attribute.at(near);
            let (from_horizon, log2) = from_horizon(attribute, above);
            let log2 = log2 as i32;
            if is_table {
                (above, from_horizon, log2 - ONE_LOG2 as i32)
            } else {
                (above, mul_high(from_horizon, size << 1), log2 - 1 - down)
            }
        });
        way
    }

    /// Likewise, where planes may leave the range: slopes come from both ends.
    #[cold]
    #[inline(never)]
    pub(super) fn extreme(&mut self, x: i32, y: i32, steps: u32) -> Way {
        let near = if self.setup.q_rises { x + steps as i32 } else { x };
        let mut end = End { place: Place { x: near, y, reciprocal: 0, zeros: 0 }, weights: [0; 2] };
        self.arrive(&mut end);
        let Some((way, _)) = self.start(&end.place, steps) else {
            return Way::None;
        };
        self.set_ends(&end, if steps == 0 { Which::Both } else { Which::Near });
        if steps > 0 {
            end.place.x += if self.setup.q_rises { -(steps as i32) } else { steps as i32 };
            self.arrive(&mut end);
            self.set_ends(&end, Which::Far);
            self.set_by_ends(steps, way);
        }
        way
    }

    /// One pixel of a sliver in the exact form.
    #[cold]
    #[inline(never)]
    pub(super) fn exact_in_sliver(&mut self, x: i32, y: i32, steps: u32) -> Way {
        let Some(resolve) = self.units.in_sliver else {
            return Way::None;
        };
        if steps > 0 {
            return Way::None;
        }
        for (setup, attribute, line) in self.each() {
            *line = pixel(attribute, resolve(setup, attribute, x, y));
        }
        Way::Straight
    }

    /// Sets w and n of a part that starts at a place. Returns the way it is drawn, if any, and (size, down): the step of w is
    /// size / 2^(32 + down).
    #[inline(always)]
    fn start(&mut self, near: &Place, steps: u32) -> Option<(Way, (u32, i32))> {
        if steps == 0 {
            return Some((Way::Straight, (0, 0)));
        }
        let (setup, rises) = (self.setup, self.setup.q_rises);
        let (q_step, q_step_zeros) = setup.q_step();
        let size = mul_high_signed((q_step >> 1) as i32, near.reciprocal) as u32;
        let down = q_step_zeros.wrapping_sub(near.zeros).wrapping_sub(3) as i32;
        if down < -3 || down == -3 && size > 7 << 26 {
            return None;
        }
        let w_step = if down >= 0 { size >> down.min(31) } else { size << -down };
        self.curve.set_w(rises, w_step, steps);
        self.curve.set_distances(rises, steps);
        match way_of(self.units.form, w_step, steps) {
            Way::None => None,
            way => Some((way, (size, down))),
        }
    }

    /// All attributes that are taken, and their lines. As slices of a length that is hidden, so that loops are not unrolled.
    #[inline(always)]
    fn each(&mut self) -> impl Iterator<Item = (&TriangleSetup, &Attribute, &mut Linear)> {
        let setup = self.setup;
        let (attributes, lines): (&[Attribute], &mut [Linear]) =
            (black_box(&setup.attributes), black_box(&mut self.curve.lines));
        attributes
            .iter()
            .zip(lines)
            .take(self.units.count())
            .map(move |(attribute, line)| (setup, attribute, line))
    }

    /// The lines of a part. Of each attribute, and what its line holds, `of` says how much more than the least it is at the near end; and
    /// how it changes in t away from that, or along a straight way over a pixel: as a number and log2 of its unit.
    #[inline(always)]
    fn set_lines(&mut self, steps: u32, way: Way, of: impl Fn(&Attribute, &Linear) -> (i32, i32, i32)) {
        let Self { setup, units, curve, .. } = self;
        let lines = curve.lines.iter_mut().zip(&mut curve.down);
        for (i, (attribute, (line, line_down))) in
            setup.attributes.iter().zip(lines).enumerate().take(units.count())
        {
            let (above, slope, log2) = of(attribute, line);
            // Hidden, so that there is one loop for all ways, and not unrolled.
            let way = if IS_ARMV6M { *black_box(&way) } else { way };
            if units.form != Form::Modular && way == Way::Table {
                (*line, *line_down) = general(units.form, attribute, above, slope, log2);
                continue;
            }
            let up = units.up(i) as i32;
            let slope = scaled(
                slope,
                log2 + match way {
                    Way::Table => up,
                    Way::Chords => up - CHORD_LOG2 as i32,
                    _ => 0,
                },
            );
            let u = attribute.least.wrapping_add(above) << up;
            *line = match way {
                Way::Table => Linear { at: u.wrapping_sub(slope << ONE_LOG2) as u32, slope },
                Way::Chords => Linear { at: u as u32, slope },
                _ => straight(attribute, above, setup.q_rises, slope, (steps, setup.inset(i))),
            };
        }
    }

    /// Sets what there is at an end of a part, where it is said to be.
    #[cold]
    #[inline(never)]
    fn arrive(&mut self, End { place, weights }: &mut End) {
        if self.setup.planes.is_sliver() {
            *weights = self.setup.weights(place.x, place.y);
        }
        let (m, zeros) =
            self.mantissa_of(self.setup.at_or_weighted(&self.setup.q(), [place.x, place.y], weights));
        (place.reciprocal, place.zeros) = (looked_up(m) as i32, zeros);
    }

    /// Leaves in each line how much more than the least there is at one end of a part: as `at` of the near end, as `slope` of the far one.
    /// If it is both, it is one pixel, and the lines are set.
    #[cold]
    #[inline(never)]
    fn set_ends(&mut self, End { place, weights }: &End, which: Which) {
        for (setup, attribute, line) in self.each() {
            let value = setup.at_or_weighted(&attribute.plane, [place.x, place.y], weights);
            let above = attribute.divided(value as i32, place.reciprocal, place.zeros);
            match which {
                Which::Near => line.at = above as u32,
                Which::Far => line.slope = above,
                Which::Both => *line = pixel(attribute, above),
            }
        }
    }

    /// From the [values at both ends](Self::set_ends): so that the far one stays in the range, whatever the planes say.
    #[cold]
    #[inline(never)]
    fn set_by_ends(&mut self, steps: u32, way: Way) {
        // w at the far end.
        let w = if self.setup.q_rises {
            self.curve.w
        } else {
            self.curve.w.wrapping_add(self.curve.w_step.wrapping_mul(steps))
        };
        let (t, unit_log2) = match (way, self.units.form) {
            (Way::Straight, _) => (steps, 0),
            (Way::Table, Form::Modular) => (inverse(w) - (1 << ONE_LOG2), 0),
            (_, form) => (distance(form, w, steps), fraction_bits(form) as i32),
        };
        let t = Reciprocal::coarse(t);
        let mantissa = t.mantissa_below();
        self.set_lines(steps, way, |_, line| {
            let (above, above_far) = (line.at as i32, line.slope);
            // rise/t is the product times 2^(zeros − 62). Its upper half, cut towards zero.
            let product = wide(above_far - above, mantissa);
            let size = (product.unsigned_abs() >> 32) as i32;
            (above, if product < 0 { -size } else { size }, t.zeros as i32 - 30 + unit_log2)
        });
    }
}

/// The line of one pixel, from how much more than the least there is.
#[inline]
fn pixel(attribute: &Attribute, above: i32) -> Linear {
    let u = attribute.least.wrapping_add(above);
    Linear { at: (u << attribute.scale_log2()) as u32, slope: 0 }
}

/// A straight way, from how much more than the least there is at its near end, the change over a pixel, I16F16, and what it keeps from the
/// ends of its range.
#[inline(never)]
fn straight(
    attribute: &Attribute,
    above: i32,
    rises: bool,
    slope: i32,
    (steps, inset): (u32, u32),
) -> Linear {
    let steps = steps as i32;
    let far = above.wrapping_add(slope.wrapping_mul(steps));
    let (first, step) = if rises { (far, slope.wrapping_neg()) } else { (above, slope) };
    let (at, step) = attribute.along_inside((first as u32, step), steps, inset);
    Linear { at: (at << attribute.scale_log2()) as u32, slope: step << attribute.scale_log2() }
}

/// A line in the general forms, and how far what it makes is shifted. The change over a pixel is `slope` · 2^`log2`; it is kept as 15
/// bits and a shift, as t has 16.
#[inline(never)]
fn general(form: Form, attribute: &Attribute, above: i32, slope: i32, log2: i32) -> (Linear, u8) {
    let log2 = log2 + attribute.scale_log2() as i32;
    let (_, zeros) = normalise(slope.unsigned_abs().max(1));
    let dropped = 17u32.saturating_sub(zeros) as i32;
    let down = fraction_bits(form) as i32 - dropped - log2;
    let slope = scaled(slope, -dropped);
    let (slope, down) = match down {
        ..0 => (slope.checked_shl(down.unsigned_abs()).unwrap_or(0), 0),
        0..32 => (slope, down as u8),
        _ => (0, 0),
    };
    let u = attribute.least.wrapping_add(above);
    (Linear { at: (u << attribute.scale_log2()) as u32, slope }, down)
}

/// How a part of so many steps is drawn, over each of which w changes by `w_step`, 32 fraction bits.
#[inline(always)]
fn way_of(form: Form, w_step: u32, steps: u32) -> Way {
    let upper = (w_step >> 10) * steps;
    if w_step >= NEAR_STEP && form == Form::Modular {
        return if upper <= 7 << 19 { Way::Table } else { Way::None };
    }
    if form == Form::Exact {
        return if steps <= MOST_GENERAL && upper <= 1 << 21 { Way::Table } else { Way::None };
    }
    // n²/D ≤ 1/8, which is n² · w_step ≤ 2²⁹.
    let is_straight = if w_step < 1 << 16 {
        steps * steps * (w_step >> 4) <= 1 << 25
    } else {
        steps < 64 && steps * steps * (w_step >> 12) <= 1 << 17
    };
    if is_straight {
        return Way::Straight;
    }
    if form == Form::General {
        return if steps <= MOST_GENERAL && upper <= 7 << 19 { Way::Table } else { Way::None };
    }
    // The horizon is 64 pixels from the far end or more: 64 · w_step is at most w there.
    let is_far = steps <= MOST_IN_CHORDS && w_step <= !(w_step * steps) >> 6;
    if is_far { Way::Chords } else { Way::None }
}

/// u less its value at the horizon, in units of 2^k of I16F16, and k. `above` is u less the least.
#[inline]
fn from_horizon(attribute: &Attribute, above: i32) -> (i32, u32) {
    let (horizon, log2) = attribute.horizon();
    ((above >> log2.min(31)).wrapping_sub(horizon), log2)
}

/// `value` · 2^`log2`, cut towards zero, modulo 2³².
#[inline]
fn scaled(value: i32, log2: i32) -> i32 {
    if log2 >= 0 { value << log2.min(31) } else { shifted(value, (-log2).min(31) as u32) }
}

#[cfg(test)]
#[expect(clippy::float_arithmetic, reason = "the truth in f64")]
mod tests {
    use super::super::curve::{Chords, Curve};
    use super::*;
    use std::println;

    /// How far, in pixels, a form displaces what is `n` pixels from the near end, at most over `steps` + 1 pixels.
    fn displacement(form: Form, way: &Way, w_step: u32, steps: u32) -> f64 {
        let w = |n: u32| 1.0 - f64::from(w_step) * f64::from(n) / 2f64.powi(32);
        // u = n/w: its change over a pixel is 1/w².
        let pixels = |n: u32, u: f64| (u - f64::from(n) / w(n)).abs() * w(n) * w(n);
        let at = |n: u32| u32::MAX.wrapping_sub(w_step.wrapping_mul(n));
        let horizon = 2f64.powi(32) / f64::from(w_step);
        let mut worst = 0f64;
        match way {
            Way::Straight => worst = pixels(steps, f64::from(steps)),
            Way::Table if form == Form::Modular => {
                for n in 0..=steps {
                    // n/w = D·(1/w − 1)
                    let t = f64::from(inverse(at(n))) / 2f64.powi(13);
                    worst = worst.max(pixels(n, horizon * (t - 1.0)));
                }
            }
            Way::Table => {
                for n in 0..=steps {
                    let t = f64::from(distance(form, at(n), n));
                    worst = worst.max(pixels(n, t / 2f64.powi(fraction_bits(form) as i32)));
                }
            }
            Way::Chords => {
                let mut curve = Curve { w: u32::MAX, w_step: 0u32.wrapping_sub(w_step), ..Curve::default() };
                curve.set_distances(false, steps);
                let mut chords = Chords::new(&curve);
                let mut n = 0;
                while n <= steps {
                    let left = steps - n;
                    let (t, rise) = if left >= 8 { chords.next() } else { chords.last(left) };
                    for i in 0..(left + 1).min(8) {
                        let u = f64::from(t) / 2f64.powi(7)
                            + f64::from(i) * f64::from(rise as i32) / 2f64.powi(13);
                        worst = worst.max(pixels(n + i, u));
                    }
                    n += 8;
                }
            }
            Way::None | Way::Bent => {}
        }
        worst
    }

    /// Of the quarter pixel that is promised set-up needs 0.014.
    #[test]
    fn forms_displace_by_less_than_a_quarter_pixel_and_exact_by_a_hundredth() {
        for (form, bound) in [(Form::Modular, 0.236), (Form::General, 0.14), (Form::Exact, 0.01)] {
            let mut worst = [0f64; 3];
            // The horizon from 1.5 to 10⁶ pixels away, and closely where chords begin.
            let distances = (0..400).map(|i| 1.5 * 1.0341_f64.powi(i));
            for distance in distances.chain((0..1400).map(|i| 176.0 + f64::from(i) / 100.0)) {
                let w_step = (2f64.powi(32) / distance) as u32;
                for steps in (1..=127).chain((128..1023).step_by(17)) {
                    let way = way_of(form, w_step, steps);
                    let index = match way {
                        Way::Straight => 0,
                        Way::Table => 1,
                        Way::Chords => 2,
                        Way::None | Way::Bent => continue,
                    };
                    worst[index] = worst[index].max(displacement(form, &way, w_step, steps));
                }
            }
            println!("{form:?}: straight {:.4}, table {:.4}, chords {:.4} px", worst[0], worst[1], worst[2]);
            assert!(worst.into_iter().all(|worst| worst <= bound), "{form:?}: {worst:?}");
            assert!(worst[1] > bound / 4.0);
        }
    }

    #[test]
    fn the_longest_rows_are_asked_for_their_form_without_overflow() {
        for w_step in (0..32).flat_map(|bit| [1 << bit, (1_u32 << bit).wrapping_mul(2).wrapping_sub(1)]) {
            for steps in [1, 2, 7, 63, 64, 127, 128, 511, 1022] {
                for form in [Form::Modular, Form::General, Form::Exact] {
                    // Whatever the form: w stays above 1/8 in it.
                    let is_none = matches!(way_of(form, w_step, steps), Way::None);
                    assert!(
                        is_none || u64::from(w_step) * u64::from(steps) <= 7 << 29,
                        "{w_step:#x} · {steps}"
                    );
                }
            }
        }
    }
}
