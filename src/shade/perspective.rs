//! Perspective along a row: attributes of a run of pixels as a product with 1/w, which a table has.
//!
//! - In: a triangle that is set up, and a run of pixels of one of its rows.
//! - Out: the run, or parts of it, handed to a fill with what its attributes are made of: a [`Curve`].
//! - Assumes: q is above 0 along the run.
//!
//! Along a row both q and (u − u₀)·q are linear. So u = A + B/q. A is the value that u tends to at the horizon, the same in all
//! rows of a triangle: u₀ and the quotient of the steps of the two. Let the *near* end of a run be the one with the greater q,
//! and w be q divided by that: it falls from 1 and, other than in the rest of the crate, is no vertex's w. Then
//!
//! ```text
//! u = A + (u_near − A)/w
//! ```
//!
//! A run takes one division, at its near end: by a reciprocal of q that is off by 2⁻²⁰ of itself. Where q falls by g of itself a
//! pixel, D = 1/g pixels on it would be 0: that is how far away the *horizon* is. There are four ways to draw a run:
//!
//! - *Table* (D up to 176): 1/w from a table at every pixel. The table has an entry for every 1/1024 of w, so u is off by D/1024
//!   pixels on the screen, 0.17, and rounding.
//! - *Chords* (D above 176, and the far end 64 pixels or more from the horizon): with n the number of pixels from the
//!   near end, n/w from the same table at every eighth pixel, and a straight line between. u = u_near + s·n/w, s
//!   being its change over the first pixel. A chord of L pixels is off by L²/4h, h being how far the horizon is
//!   there: by up to ¼, of which the errors of its ends take some.
//! - *Distances* (shaders of users, and [`Exact`](super::Exact)): n/w at every pixel. It
//!   is off by n/1024 pixels at most, and n is at most 63; for `Exact` one step of Newton's iteration makes that
//!   0.005.
//! - *Straight*, where w changes so little that the tangent at the near end is off by n²/D ≤ 1/8 pixel.
//!
//! A run that is too long for any is cut in two. How far each way displaces a pixel at most a test of
//! [`bent`](super::bent) computes.
//!
//! # Range
//!
//! The table is never too large, and slopes are cut towards zero. So attributes lie between u_near, which is kept in
//! the corners' range, and what the plane says at the far end. That may be off: see [`TriangleSetup::contract`] for
//! how far, and why it stays in the range. Where it would not, a slope is made from the values at both ends: in
//! slivers, in `Exact`, and where distances differ much for the triangle's size, 62-fold at 100×100 pixels and 8-fold
//! at 1024×1024.

use super::curve::{Curve, Linear};
use super::fill::Fill;
use super::inverses::ONE_LOG2;
use super::level::{level, level_further};
use super::units::{Form, Units};
use crate::math::recip::looked_up;
use crate::num::{IS_ARMV6M, mul_high_signed, normalise};
use crate::raster::{ATTRIBUTES, Attribute, Place, TriangleSetup, towards_zero};
use core::hint::black_box;

/// The step of w, 32 fraction bits, where the horizon is 176 pixels away.
pub(super) const NEAR_STEP: u32 = u32::MAX / 176;

/// How a part of a row is drawn. `Table` looks 1/w up at every pixel; in the general forms n/w, which the head calls distances.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Way {
    Straight,
    Table,
    Chords,
    /// Not at one go: it is too long.
    None,
    /// As [`Perspective::bent`] says.
    Bent,
}

/// The rows of a triangle, for a fill. The fields are in the order in which Armv6-M reaches them with the fewest registers.
#[repr(C)]
pub(crate) struct Perspective<'a> {
    pub(super) setup: &'a TriangleSetup,
    /// Sets the curve of a part of a row, `steps` + 1 pixels from (x, y) on: in the way that all rows of the triangle
    /// have in common. A part of one pixel is never too long.
    way: fn(&mut Self, x: i32, y: i32, steps: u32) -> Way,
    /// Of bent triangles [scaled](Units::scaled).
    pub(super) units: Units,
    pub(super) curve: Curve,
}

impl<'a> Perspective<'a> {
    /// For a fill. It asks for the units itself, so that they are not on the stack twice.
    #[inline(never)]
    pub(crate) fn new<W>(setup: &'a TriangleSetup, fill: &dyn Fill<W>) -> Self {
        let mut units = fill.units();
        let way = Self::way_of(setup, &mut units);
        Self { setup, way, units, curve: Curve { zeros: 1, ..Curve::default() } }
    }

    /// The way of all rows of a triangle.
    #[inline(never)]
    fn way_of(setup: &TriangleSetup, units: &mut Units) -> fn(&mut Self, i32, i32, u32) -> Way {
        if setup.planes.is_small() {
            return Self::small;
        }
        if setup.straight {
            return Self::straight;
        }
        let mut fits_table = units.form == Form::Modular && !setup.is_level && !setup.is_extreme;
        if units.form == Form::Modular {
            fits_table &= units.scale(&setup.attributes, ONE_LOG2);
        }
        if fits_table {
            Self::near_horizon
        } else if setup.is_level {
            Self::level
        } else if setup.planes.is_sliver() && units.in_sliver.is_some() {
            Self::exact_in_sliver
        } else if setup.is_extreme {
            Self::extreme
        } else {
            Self::bent
        }
    }

    /// q's mantissa at a pixel, 2³¹ … 2³² − 1, and its leading zeros. Not of a sliver.
    #[inline(always)]
    fn q_at(&mut self, x: i32, y: i32) -> (u32, u32) {
        self.mantissa_of(self.setup.q().at([x, y]))
    }

    /// A pixel and 1/q there. Not of a sliver.
    #[inline(always)]
    pub(super) fn place(&mut self, x: i32, y: i32) -> Place {
        let (m, zeros) = self.q_at(x, y);
        Place { x, y, reciprocal: looked_up(m) as i32, zeros }
    }

    /// The near end of a part of a row, `steps` + 1 pixels from (x, y) on. Not of a sliver.
    #[inline(always)]
    pub(super) fn near(&mut self, x: i32, y: i32, steps: u32) -> Place {
        self.place(if self.setup.q_rises { x + steps as i32 } else { x }, y)
    }

    #[inline(always)]
    pub(super) fn mantissa_of(&mut self, q: u32) -> (u32, u32) {
        let q = self.setup.bounded(q);
        let zeros = u32::from(self.curve.zeros);
        let mantissa = q << (zeros & 31);
        // Most often q has as many leading zeros as at the last division. Armv6-M has no instruction that counts them.
        if IS_ARMV6M && (mantissa as i32) < 0 && mantissa >> (zeros & 31) == q {
            return (mantissa, zeros);
        }
        let (mantissa, zeros) = normalise(q);
        if IS_ARMV6M {
            self.curve.zeros = zeros as u8;
        }
        (mantissa, zeros)
    }

    /// Draws pixels of a row, the first of which is (x, y).
    #[inline(always)]
    pub(crate) fn draw<W>(&mut self, x: i32, y: i32, pixels: &mut [W], fill: &dyn Fill<W>) {
        // One after another: a table of jumps takes longer.
        let mut way = (self.way)(self, x, y, pixels.len().wrapping_sub(1) as u32);
        loop {
            if way == Way::Table {
                return fill.table(pixels, &self.curve);
            }
            if way == Way::Straight {
                return fill.straight(pixels, &self.curve);
            }
            if way == Way::Chords {
                return fill.chords(pixels, &self.curve);
            }
            if !IS_ARMV6M || way != Way::Bent {
                return self.draw_parts(x, y, pixels, fill);
            }
            // From here: so it is not on the stack together with what asks for it. (The length is hidden, so that it is not kept.)
            way = self.bent(x, y, black_box(pixels.len()).wrapping_sub(1) as u32);
        }
    }

    /// Draws pixels of a row that are too many to be drawn at one go, in parts, from the near end on.
    #[cold]
    #[inline(never)]
    fn draw_parts<W>(&mut self, mut x: i32, y: i32, mut pixels: &mut [W], fill: &dyn Fill<W>) {
        let mut count = pixels.len().div_ceil(2);
        while !pixels.is_empty() {
            let all = core::mem::take(&mut pixels);
            let near_is_right = !self.setup.planes.is_small() && !self.setup.straight && self.setup.q_rises;
            let way = loop {
                let skipped = if near_is_right { all.len() - count } else { 0 };
                let (x, steps) = (x + skipped as i32, count as u32 - 1);
                let way = match (self.way)(self, x, y, steps) {
                    Way::Bent if IS_ARMV6M => self.bent(x, y, steps),
                    way => way,
                };
                if way != Way::None {
                    break way;
                }
                count = count.div_ceil(2);
            };
            let at = if near_is_right { all.len() - count } else { count };
            let Some((run, rest)) = all.split_at_mut_checked(at) else {
                return;
            };
            let (run, rest) = if near_is_right { (rest, run) } else { (run, rest) };
            if !near_is_right {
                x += count as i32;
            }
            match way {
                Way::Table => fill.table(run, &self.curve),
                Way::Chords => fill.chords(run, &self.curve),
                _ => fill.straight(run, &self.curve),
            }
            (count, pixels) = (rest.len(), rest);
        }
    }

    /// Where q is the same all along.
    #[inline(never)]
    fn level(&mut self, x: i32, y: i32, steps: u32) -> Way {
        let (m, zeros) = self.q_at(x, y);
        let q_step = self.setup.q().steps[0];
        let mut bends = false;
        if q_step != 0 {
            // The tangent is off by n²·q′/q pixels. Beyond 1/8 `bent` decides.
            let fall = steps * q_step.unsigned_abs();
            if steps * fall > m >> zeros >> 3 {
                return if self.setup.is_extreme { Way::None } else { self.ask_bent(x, y, steps) };
            }
            // Taken as constant, q moves a row by at most 2 · 2047 · n·q′/q pixels, where q is 2³⁰ or more: by 2⁻⁶.
            bends = fall > 1 << 12;
        }
        // `mul_17` takes steps below 2³⁰. Only a row of two pixels can have a greater one: it is drawn as two.
        let is_steep = |attribute: &Attribute| attribute.plane.steps[0].unsigned_abs() >> 30 != 0;
        if steps == 1 && self.setup.attributes.iter().take(self.units.count()).any(is_steep) {
            return Way::None;
        }
        let reciprocal = looked_up(m) as i32;
        let (count, place) = (self.units.count(), Place { x, y, reciprocal, zeros });
        if bends {
            self.level_bending(&place, q_step, steps);
            return Way::Straight;
        }
        let (attributes, lines) = (&self.setup.attributes, &mut self.curve.lines);
        level(&attributes[0], &place, 0, steps, None, &mut lines[0]);
        if count > 1 {
            level(&attributes[1], &place, 0, steps, Some(self.setup.inset(1)), &mut lines[1]);
        }
        for i in 2..count.min(ATTRIBUTES) {
            level_further(&attributes[i], &place, 0, steps, None, &mut lines[i]);
        }
        Way::Straight
    }

    /// Where q is nearly the same all along a long row.
    #[cold]
    #[inline(never)]
    fn level_bending(&mut self, place: &Place, q_step: i32, steps: u32) {
        // Slices of a length that is hidden, so that the loop is not unrolled.
        let (attributes, lines): (&[Attribute], &mut [Linear]) =
            (black_box(&self.setup.attributes), black_box(&mut self.curve.lines));
        for (i, (attribute, line)) in attributes.iter().zip(lines).enumerate().take(self.units.count()) {
            let inset = (black_box(i) == 1).then(|| self.setup.inset(1));
            level_further(attribute, place, q_step, steps, inset, line);
        }
    }

    /// What [`bent`](Self::bent) says. A Cortex-M4 jumps there, and leaves the stack to it; on Armv6-M, which cannot, the caller asks.
    #[inline(always)]
    fn ask_bent(&mut self, x: i32, y: i32, steps: u32) -> Way {
        if IS_ARMV6M { Way::Bent } else { self.bent(x, y, steps) }
    }

    /// Where the horizon is near.
    #[inline(never)]
    fn near_horizon(&mut self, x: i32, y: i32, steps: u32) -> Way {
        let setup = self.setup;
        let near = self.near(x, y, steps);
        let (q_step, q_step_zeros) = setup.q_step();
        let size = mul_high_signed((q_step >> 1) as i32, near.reciprocal) as u32;
        let down = q_step_zeros.wrapping_sub(near.zeros).wrapping_sub(3);
        // What does not fit is for `bent`.
        let w_step = if down < 32 { size >> down } else { 0 };
        // w is to stay above 1/8: its whole fall, 22 fraction bits, is at most 7/8.
        if w_step < NEAR_STEP || (w_step >> 10) * steps > 7 << 19 {
            return self.ask_bent(x, y, steps);
        }
        self.curve.set_w(setup.q_rises, w_step, steps);
        self.set_tables(&near);
        Way::Table
    }

    /// Sets lines in 1/w.
    #[inline(always)]
    fn set_tables(&mut self, near: &Place) {
        // Two without a loop, which would take as long as what is in it.
        let (attributes, units, lines) = (&self.setup.attributes, &self.units, &mut self.curve.lines);
        set_table(&attributes[0], near, units.up(0), &mut lines[0]);
        let count = units.count();
        if count > 1 {
            set_table(&attributes[1], near, units.up(1), &mut lines[1]);
        }
        if count > 2 {
            for i in 2..count.min(ATTRIBUTES) {
                set_table_further(&attributes[i], near, units.up(i), &mut lines[i]);
            }
        }
    }

    /// Of a small triangle.
    #[inline(never)]
    fn small(&mut self, x: i32, y: i32, steps: u32) -> Way {
        let (setup, steps) = (self.setup, steps as i32);
        if (setup.is_held || setup.is_bent) && steps > i32::from(setup.longest) {
            return Way::None;
        }
        // A slice of a length that is hidden, so that the loop is not unrolled.
        let lines: &mut [Linear] = black_box(&mut self.curve.lines);
        let place = setup.beyond_first([x, y]);
        for (i, line) in lines.iter_mut().enumerate().take(self.units.count()) {
            let (at, slope) = setup.along(black_box(i), place, steps);
            *line = Linear { at: at as u32, slope };
        }
        Way::Straight
    }

    #[inline(never)]
    fn straight(&mut self, x: i32, y: i32, steps: u32) -> Way {
        let setup = self.setup;
        // Not unrolled.
        for (attribute, line) in setup.attributes.iter().zip(&mut self.curve.lines).take(self.units.count()) {
            let plane = setup.at(&attribute.plane, x, y);
            if setup.leans && steps > 0 && attribute.leaves(plane, steps as i32) {
                // Up to where it leaves its range an exact attribute stays so.
                return Way::None;
            }
            let (at, step) = attribute.along(plane, steps as i32);
            *line =
                Linear { at: (at << attribute.scale_log2()) as u32, slope: step << attribute.scale_log2() };
            black_box(());
        }
        Way::Straight
    }
}

/// Sets an attribute's line in 1/w, shifted left by `up`; of a triangle that is no sliver, where the horizon is near
/// and `up` is at most 13.
///
/// Not inlined on Armv6-M, where it needs all registers.
#[inline(always)]
fn set_table(attribute: &Attribute, near: &Place, up: u32, line: &mut Linear) {
    let value = attribute.plane.at([near.x, near.y]) as i32;
    let above = attribute.divided(value, near.reciprocal, near.zeros);
    let (u, way) = (attribute.least.wrapping_add(above), above.wrapping_sub(attribute.horizon().0));
    // Cut towards zero.
    let slope = towards_zero(way >> ((ONE_LOG2 - up) & 31));
    *line = Linear { at: (u << (up & 31)).wrapping_sub(slope << ONE_LOG2) as u32, slope };
}

/// As [`set_table`], in a loop.
#[inline(never)]
fn set_table_further(attribute: &Attribute, near: &Place, up: u32, line: &mut Linear) {
    set_table(attribute, near, up, line);
}
