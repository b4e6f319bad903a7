//! Level: attributes along a row where q is the same all along, or nearly.
//!
//! - In: an attribute of a bent triangle, and a pixel and 1/q there.
//! - Out: a straight line, held in the range of the triangle's corners.
//! - Assumes: q is above 0 along the row, and changes by less than 2¹² a pixel.

use super::curve::Linear;
use crate::num::mul_high;
use crate::raster::{Attribute, Place};

/// An attribute's straight line where q is the same all along, or with its step where it nearly is; v keeps an inset from its ends.
#[inline(always)]
pub(super) fn level(
    attribute: &Attribute,
    place: &Place,
    q_step: i32,
    steps: u32,
    inset: Option<u32>,
    line: &mut Linear,
) {
    let plane = &attribute.plane;
    // 17 bits of 1/q do: the ends are held in the range.
    let reciprocal = (place.reciprocal as u32 + (1 << 13)) >> 14;
    let value = plane.at([place.x, place.y]) as i32;
    // Of three pixels or more, whose values are within ±2³⁰, a step is less than that.
    let mut step = if steps > 0 { plane.steps[0] } else { 0 };
    if q_step != 0 {
        let (above, _) = attribute.above((value, 0), reciprocal, place.zeros);
        step = step.wrapping_sub(bend_of_level(attribute, above, q_step));
    }
    let line_above = attribute.above((value, step), reciprocal, place.zeros);
    let (at, step) = match inset {
        Some(inset) => attribute.along_inside(line_above, steps as i32, inset),
        None => attribute.along(line_above, steps as i32),
    };
    let scale_log2 = attribute.scale_log2();
    *line = Linear { at: (at << scale_log2) as u32, slope: step << scale_log2 };
}

/// (u − u₀)·q′ in units of the plane: what the step of (u − u₀)·q is more than q times the step of u. q′ is less than 2¹².
#[cold]
#[inline(never)]
fn bend_of_level(attribute: &Attribute, above: u32, q_step: i32) -> i32 {
    let offset = (above as i32).max(0).min(attribute.range as i32).wrapping_add(attribute.low);
    let up = attribute.shift().clamp(0, 19);
    let size = mul_high(offset << (attribute.shift() - up), q_step.unsigned_abs() << up);
    if q_step < 0 { -size } else { size }
}

/// As [`level`], in a loop.
#[inline(never)]
pub(super) fn level_further(
    attribute: &Attribute,
    place: &Place,
    q_step: i32,
    steps: u32,
    inset: Option<u32>,
    line: &mut Linear,
) {
    level(attribute, place, q_step, steps, inset, line);
}
