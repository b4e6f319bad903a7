//! Truth for many pixels at once: what [`Sample`](super::Sample) says of each, in a fraction of its time.
//!
//! The sums are the same exact integers. From pixel to pixel they change by the same integers, so one addition makes the next.

use std::ops::Range;

use super::Triangle;

/// An attribute at the centres of a rectangle of pixels and of those around it, perspective-correct, in units of 2⁻¹⁶.
pub(crate) struct Field {
    triangle: Triangle,
    attribute: usize,
    /// The column and the row of the first value.
    from: (i32, i32),
    width: usize,
    /// Not a number behind the eye.
    values: Vec<f64>,
}

impl Field {
    pub(crate) fn new(triangle: &Triangle, attribute: usize, columns: Range<i32>, rows: Range<i32>) -> Self {
        let from = (columns.start - 1, rows.start - 1);
        let width = (columns.end + 1 - from.0) as usize;
        let sums = |dx, dy| {
            let sample = triangle.at(from.0 + dx, from.1 + dy);
            [sample.attribute_sum(attribute), sample.q_sum()]
        };
        let first = sums(0, 0);
        let minus = |to: [i128; 2]| [to[0] - first[0], to[1] - first[1]];
        let (right, down) = (minus(sums(1, 0)), minus(sums(0, 1)));
        let mut values = Vec::with_capacity(width * (rows.len() + 2));
        let mut row = first;
        for _ in 0..rows.len() + 2 {
            let mut at = row;
            for _ in 0..width {
                values.push(if at[1] > 0 { at[0] as f64 / at[1] as f64 } else { f64::NAN });
                at = [at[0] + right[0], at[1] + right[1]];
            }
            row = [row[0] + down[0], row[1] + down[1]];
        }
        Self { triangle: *triangle, attribute, from, width, values }
    }

    fn index(&self, x: i32, y: i32) -> usize {
        (y - self.from.1) as usize * self.width + (x - self.from.0) as usize
    }

    /// The attribute at a pixel's centre.
    pub(crate) fn at(&self, x: i32, y: i32) -> f64 {
        self.values[self.index(x, y)]
    }

    /// Its largest change over one pixel step from there.
    pub(crate) fn step(&self, x: i32, y: i32) -> f64 {
        let (index, here) = (self.index(x, y), self.at(x, y));
        let neighbours = [index - 1, index + 1, index - self.width, index + self.width];
        // `max` leaves out what is not a number.
        let step = neighbours.into_iter().fold(f64::NAN, |all, at| all.max((self.values[at] - here).abs()));
        if step.is_nan() { self.triangle.at(x, y).change(self.attribute).step } else { step }
    }
}
