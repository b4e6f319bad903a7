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
use crate::num::{mul_high, normalised, wide};
use crate::raster::{Attribute, Place};

/// The most steps in the general forms: so that n/w fits 16 bits, and the table is off by 63/1024 pixel at most.
const MOST_GENERAL: u32 = 63;

impl Perspective<'_> {
    /// Sets the curve of a part of a row, `steps` + 1 pixels from (x, y) on. Not of a sliver.
    #[inline(never)]
    pub(super) fn bent(&mut self, x: i32, y: i32, steps: u32) -> Way {
        let near = self.near(x, y, steps);
        let way = self.bent_from(&near, steps);
        if self.setup.is_extreme && matches!(way, Way::Table | Way::Chords) {
            self.set_by_far_end(&near, steps, &way);
        }
        way
    }

    /// Likewise, from its near end. Of an extreme triangle lines are set if they are straight, which are held in the range by themselves;
    /// others are still to be set [from both ends](Self::set_by_far_end).
    #[inline(never)]
    pub(super) fn bent_from(&mut self, near: &Place, steps: u32) -> Way {
        let Some((way, w_step)) = self.start(near, steps) else {
            return Way::None;
        };
        if self.setup.is_extreme && way != Way::Straight {
            // Not by slopes.
        } else if way == Way::Table && self.units.form == Form::Modular {
            self.set_table(near);
        } else if steps > 0 {
            self.set_by_slope(near, self.setup.q_rises, steps, w_step, &way);
        } else {
            self.set_pixel(near, None);
        }
        way
    }

    /// In 1/w, from the horizon.
    #[inline(never)]
    fn set_table(&mut self, near: &Place) {
        let all = self.setup.attributes.iter().zip(&mut self.curve.lines).enumerate();
        for (i, (attribute, line)) in all.take(self.units.count()) {
            let (above, up) = (attribute.at(near), self.units.up(i));
            let (from_horizon, log2) = from_horizon(attribute, above);
            let u = attribute.least.wrapping_add(above);
            let slope = scaled(from_horizon, log2 as i32 + up as i32 - ONE_LOG2 as i32);
            let at = (u << up).wrapping_sub(slope << ONE_LOG2) as u32;
            *line = Linear { at, slope };
        }
    }

    /// A sliver has no planes: its values at both ends come from weights.
    #[cold]
    #[inline(never)]
    pub(super) fn bent_in_sliver(&mut self, x: i32, y: i32, steps: u32) -> Way {
        if self.units.in_sliver.is_some() {
            if steps > 0 {
                return Way::None;
            }
            self.resolve_in_sliver(x, y);
            return Way::Straight;
        }
        let [to_near, to_far] = if self.setup.q_rises { [steps as i32, 0] } else { [0, steps as i32] };
        let (mut place, mut weights) = (Place { x, y, reciprocal: 0, zeros: 0 }, [0; 2]);
        self.place_in_sliver(x + to_near, &mut place, &mut weights);
        let Some((way, _)) = self.start(&place, steps) else {
            return Way::None;
        };
        if steps == 0 {
            self.set_pixel(&place, Some(&weights));
            return way;
        }
        self.set_ends(&place, Some(&weights), true);
        self.place_in_sliver(x + to_far, &mut place, &mut weights);
        self.set_ends(&place, Some(&weights), false);
        self.set_by_ends(steps, &way);
        way
    }

    /// One pixel of a sliver in the exact form.
    #[inline(never)]
    fn resolve_in_sliver(&mut self, x: i32, y: i32) {
        let Some(resolve) = self.units.in_sliver else {
            return;
        };
        for i in 0..self.units.count() {
            if let Some(attribute) = self.setup.attributes.get(i) {
                self.set_pixel_of(i, attribute, resolve(self.setup, attribute, x, y));
            }
        }
    }

    /// Goes to another pixel of the same row of a sliver: 1/q there, and by how much corners 1 and 2 count.
    #[inline(never)]
    fn place_in_sliver(&mut self, x: i32, place: &mut Place, weights: &mut [u32; 2]) {
        *weights = self.setup.weights(x, place.y);
        let (m, zeros) = self.mantissa_of(self.setup.q().weighted(weights));
        *place = Place { x, y: place.y, reciprocal: looked_up(m), zeros };
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
        let size = mul_high((q_step >> 1) as i32, near.reciprocal) as u32;
        let down = q_step_zeros.wrapping_sub(near.zeros).wrapping_sub(3) as i32;
        if down < -3 || down == -3 && size > 7 << 26 {
            return None;
        }
        let w_step = if down >= 0 { size >> down.min(31) } else { size << -down };
        self.curve.set_w(rises, w_step, steps);
        (self.curve.n, self.curve.n_step) = if rises { (steps, u32::MAX) } else { (0, 1) };
        match way_of(self.units.form, w_step, steps) {
            Way::None => None,
            way => Some((way, (size, down))),
        }
    }

    /// Sets the line of attribute `i`, of which there are as many as lines.
    #[inline]
    fn set_line(&mut self, i: usize, line: Linear) {
        if let Some(of_attribute) = self.curve.lines.get_mut(i) {
            *of_attribute = line;
        }
    }

    /// One pixel, which has weights in a sliver.
    #[inline(never)]
    fn set_pixel(&mut self, place: &Place, weights: Option<&[u32; 2]>) {
        for i in 0..self.units.count() {
            if let Some(attribute) = self.setup.attributes.get(i) {
                self.set_pixel_of(i, attribute, at(attribute, place, weights));
            }
        }
    }

    #[inline]
    fn set_pixel_of(&mut self, i: usize, attribute: &Attribute, above: i32) {
        let u = attribute.least.wrapping_add(above);
        self.set_line(i, Linear { at: (u << attribute.scale_log2()) as u32, slope: 0 });
    }

    /// The forms that take the change over a pixel: all but the table's.
    #[inline]
    fn set_by_slope(&mut self, near: &Place, rises: bool, steps: u32, (size, down): (u32, i32), way: &Way) {
        for (i, attribute) in self.setup.attributes.iter().enumerate().take(self.units.count()) {
            let above = attribute.at(near);
            let u = attribute.least.wrapping_add(above);
            // Over a pixel, away from the near end, times 2^−`log2`.
            let (from_horizon, log2) = from_horizon(attribute, above);
            let slope = mul_high(from_horizon, size << 1);
            let log2 = log2 as i32 - 1 - down;
            match way {
                Way::Straight => self.set_straight(i, attribute, above, rises, scaled(slope, log2), steps),
                Way::Chords => {
                    let up = self.units.up(i);
                    let slope = scaled(slope, log2 + up as i32 - CHORD_LOG2 as i32);
                    self.set_line(i, Linear { at: (u << up) as u32, slope });
                }
                _ => self.set_general(i, u, attribute.scale_log2(), slope, log2),
            }
        }
    }

    /// A straight way, from how much more than the least there is at its near end, and the change over a pixel, I16F16.
    #[inline(always)]
    fn set_straight(
        &mut self,
        i: usize,
        attribute: &Attribute,
        above: i32,
        rises: bool,
        slope: i32,
        steps: u32,
    ) {
        let steps = steps as i32;
        let far = above.wrapping_add(slope.wrapping_mul(steps));
        let (first, step) = if rises { (far, slope.wrapping_neg()) } else { (above, slope) };
        let (at, step) = attribute.along_inside((first as u32, step), steps, self.setup.inset(i));
        self.set_line(
            i,
            Linear { at: (at << attribute.scale_log2()) as u32, slope: step << attribute.scale_log2() },
        );
    }

    /// The general forms. The change over a pixel is `slope` · 2^−`log2`; it is kept as 15 bits and a shift, as t has 16.
    #[inline(never)]
    fn set_general(&mut self, i: usize, u: i32, scale_log2: u32, slope: i32, log2: i32) {
        let log2 = log2 + scale_log2 as i32;
        let (_, zeros) = normalised(slope.unsigned_abs().max(1));
        let dropped = 17u32.saturating_sub(zeros) as i32;
        let down = fraction_bits(self.units.form) as i32 - dropped - log2;
        let slope = scaled(slope, -dropped);
        let (slope, down) = match down {
            ..0 => (slope.checked_shl(down.unsigned_abs()).unwrap_or(0), 0),
            0..32 => (slope, down as u8),
            _ => (0, 0),
        };
        self.set_line(i, Linear { at: (u << scale_log2) as u32, slope });
        if let Some(of_line) = self.curve.down.get_mut(i) {
            *of_line = down;
        }
    }

    /// Where planes may leave the range: slopes come from both ends.
    #[cold]
    #[inline(never)]
    fn set_by_far_end(&mut self, near: &Place, steps: u32, way: &Way) {
        self.set_ends(near, None, true);
        let x = if self.setup.q_rises { near.x - steps as i32 } else { near.x + steps as i32 };
        let far = self.place(x, near.y);
        self.set_ends(&far, None, false);
        self.set_by_ends(steps, way);
    }

    /// Leaves in each line how much more than the least there is at one end of a part: as `at` of the near end, as `slope` of the far one.
    #[cold]
    #[inline(never)]
    fn set_ends(&mut self, place: &Place, weights: Option<&[u32; 2]>, is_near: bool) {
        let all = self.setup.attributes.iter().zip(&mut self.curve.lines);
        for (attribute, line) in all.take(self.units.count()) {
            let above = at(attribute, place, weights);
            if is_near {
                line.at = above as u32;
            } else {
                line.slope = above;
            }
        }
    }

    /// From the [values at both ends](Self::set_ends): so that the far one stays in the range, whatever the planes say.
    #[cold]
    #[inline(never)]
    fn set_by_ends(&mut self, steps: u32, way: &Way) {
        let rises = self.setup.q_rises;
        // w at the far end.
        let w = if rises {
            self.curve.w
        } else {
            self.curve.w.wrapping_add(self.curve.w_step.wrapping_mul(steps))
        };
        let t = match (way, self.units.form) {
            (Way::Straight, _) => steps,
            (Way::Table, Form::Modular) => inverse(w) - (1 << ONE_LOG2),
            (_, form) => distance(form, w, steps),
        };
        let t = Reciprocal::coarse(t);
        for i in 0..self.units.count() {
            let (Some(attribute), Some(line)) = (self.setup.attributes.get(i), self.curve.lines.get(i))
            else {
                return;
            };
            let (above, above_far) = (line.at as i32, line.slope);
            let (u, rise) = (attribute.least.wrapping_add(above), above_far - above);
            // rise/t is the product times 2^(zeros − 62). Its upper half, cut towards zero.
            let product = wide(rise, t.mantissa_below());
            let quotient = scaled_wide(product, -32);
            let log2 = t.zeros as i32 - 30;
            match way {
                Way::Straight => self.set_straight(i, attribute, above, rises, scaled(quotient, log2), steps),
                _ if self.units.form != Form::Modular => {
                    let log2 = log2 + fraction_bits(self.units.form) as i32;
                    self.set_general(i, u, attribute.scale_log2(), quotient, log2);
                }
                _ => {
                    let up = self.units.up(i);
                    let slope = scaled_wide(product, t.zeros as i32 - 62 + up as i32);
                    let one = if matches!(way, Way::Table) { slope << ONE_LOG2 } else { 0 };
                    self.set_line(i, Linear { at: (u << up).wrapping_sub(one) as u32, slope });
                }
            }
        }
    }
}

/// How much more than the least an attribute is at a pixel: by its planes, or in a sliver by how much corners 1 and 2 count there.
#[inline(never)]
fn at(attribute: &Attribute, place: &Place, weights: Option<&[u32; 2]>) -> i32 {
    match weights {
        None => attribute.at(place),
        Some(weights) => {
            attribute.divided(attribute.plane.weighted(weights) as i32, place.reciprocal, place.zeros)
        }
    }
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
#[inline(always)]
fn scaled(value: i32, log2: i32) -> i32 {
    if log2 >= 0 { value << log2.min(31) } else { shifted(value, (-log2).min(31) as u32) }
}

/// As [`scaled`], from 64 bits, to the right.
fn scaled_wide(value: i64, log2: i32) -> i32 {
    let size = (value.unsigned_abs() >> (-log2).clamp(0, 63)) as i32;
    if value < 0 { size.wrapping_neg() } else { size }
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
                let curve = Curve {
                    w: u32::MAX,
                    w_step: 0u32.wrapping_sub(w_step),
                    n: 0,
                    n_step: 1,
                    ..Curve::default()
                };
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
