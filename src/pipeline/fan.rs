//! Stage 2, after clipping: a polygon on the screen as a fan of triangles around its first vertex.
//!
//! In clip space the polygon is convex. On the screen its corners are rounded to 1/16 px, and where two of them lie close
//! together that may turn one of the fan's triangles over:
//!
//! ```text
//!   0 ───────────────── 3          1 should lie left of the line from 0 to 2. Rounded to its right, the triangle 0 1 2
//!     ╲   1             │          is turned over, and the triangle 0 2 3 covers what is the neighbour's.
//!        ╲ ╲            │          Around 1 there are 1 2 3 and 1 3 0 instead, which cover just the polygon.
//!            ──── 2 ────┘
//! ```
//!
//! Where no vertex will do, because sides cross or because the polygon is no fan any more, it is **folded**:
//!
//! ```text
//!   0 ─────────────── 3            0 1 and 2 3 cross, and beyond that the polygon shows its other side. Both are edges that
//!      ╲           ╱               neighbours have too, with the same rounded ends, so the neighbours overlap there. Each of the
//!          ╲   ╱                   triangles 0 1 2 and 0 2 3 covers a part of what is theirs; there the two have different
//!            ╳                     senses.
//!         2 ─── 1
//! ```
//!
//! What is right follows from the outline alone. Walked once around, it goes around a pixel's centre n times: clockwise counts
//! +1, counter-clockwise −1, and a centre on an edge is on the side that the top-left rule says. Of two triangles that share an edge the
//! one walks it up and the other down, so that over all triangles of a mesh these numbers add up to what they would be without
//! rounding: that is what no crack and no double pixel mean for a mesh, and what a triangle that is not clipped does, whose number is
//! 1 or 0 (or −1, turned over by rounding, and is then culled). **A clipped triangle therefore draws a pixel where its
//! outline goes around it in the sense that is not culled, and once.** (Clipping leaves a convex polygon, from whose topmost corner the two
//! sides go down only. Rounding keeps that, so a row meets each side once: n is never 2.)
//!
//! The numbers of a fan's triangles add up to n, whatever the polygon. So where all have one sense each draws what it covers.
//! In a folded one a triangle draws, of what it covers, the pixels where the sum has its own sense, and that no earlier one drew:
//! [`Runs`] finds them row by row. That takes a while, and is rare: what folds is thinner than 1/8 px.

use super::clip::{MOST_CORNERS, ScreenVertex};
use super::setup::position;
use super::span::{Window, centers_left, first_row};
use core::ops::Range;

/// The vertex around which no triangle is turned over, or the least of them, and whether any is: whether the polygon is folded.
#[inline(never)]
pub(super) fn center(polygon: &[ScreenVertex]) -> (usize, bool) {
    let mut best = (u64::MAX, 0);
    if polygon.is_empty() {
        return (0, false);
    }
    for first in 0..polygon.len() {
        let turned = turned_over(polygon, first);
        if turned < best.0 {
            best = (turned, first);
        }
        if turned == 0 {
            break;
        }
    }
    (best.1, best.0 > 0)
}

/// Twice the area, in 1/256 px², of the triangles around a vertex that run the other way than the polygon.
#[inline(never)]
fn turned_over(polygon: &[ScreenVertex], first: usize) -> u64 {
    let (before, from) = polygon.split_at(first);
    let mut around =
        from.iter().chain(before).map(|vertex| [vertex.x, vertex.y].map(|at| i32::from(at.to_bits())));
    let Some([x, y]) = around.next() else {
        return 0;
    };
    let (mut sum, mut size) = (0_i64, 0);
    let mut last = [x, y];
    for [bx, by] in around {
        let [ax, ay] = last;
        let area = i64::from((ax - x) * (by - y) - (ay - y) * (bx - x));
        (sum, size, last) = (sum + area, size + area.unsigned_abs(), [bx, by]);
    }
    (size - sum.unsigned_abs()) / 2
}

/// The corners of the fan's triangle number 0 … corners − 3.
#[inline]
pub(super) fn piece(polygon: &[ScreenVertex], number: usize) -> Option<[&ScreenVertex; 3]> {
    let (first, rest) = polygon.split_first()?;
    match rest.get(number..)? {
        [second, third, ..] => Some([first, second, third]),
        _ => None,
    }
}

/// The rows of a folded polygon within a window's.
#[cold]
#[inline(never)]
pub(super) fn rows(polygon: &[ScreenVertex], window: &Window) -> Range<i32> {
    let ends = polygon.iter().map(|vertex| i32::from(vertex.y.to_bits()));
    let (low, high) = ends.fold((i32::MAX, i32::MIN), |(low, high), at| (low.min(at), high.max(at)));
    first_row(low).max(window.rows.start)..first_row(high).min(window.rows.end)
}

/// Where in a window a triangle of a folded polygon's fan is drawn: one part of one row after the other.
pub(super) struct Runs<'a> {
    polygon: &'a [ScreenVertex],
    number: usize,
    window: Window,
    rows: Range<i32>,
    /// In the row above: of each triangle how many pixel centres lie left of the edge that goes up, and of the one that goes down.
    /// Between them lie those that the triangle goes around, clockwise if the first is the less.
    sides: [[i32; 2]; MOST_CORNERS - 2],
    /// The column that is next in it.
    column: i32,
}

impl<'a> Runs<'a> {
    #[inline(always)]
    pub(super) fn new(polygon: &'a [ScreenVertex], window: &Window) -> Self {
        let mut runs = Self {
            polygon,
            number: 0,
            window: window.clone(),
            rows: 0..0,
            sides: [[0; 2]; MOST_CORNERS - 2],
            column: 0,
        };
        runs.rows = rows(polygon, window);
        runs.start_row();
        runs
    }

    /// The next run, as a window, and the corners of the triangle that is drawn there.
    #[cold]
    #[inline(never)]
    pub(super) fn next(&mut self) -> Option<(Window, [&'a ScreenVertex; 3])> {
        loop {
            let corners = match piece(self.polygon, self.number) {
                Some(corners) if !self.rows.is_empty() => corners,
                _ => return None,
            };
            let row = self.rows.start;
            let sides = self.sides.get(..self.polygon.len() - 2)?;
            let &[up, down] = sides.get(self.number)?;
            let (start, mut end) = (self.column.max(up.min(down)), up.max(down).min(self.window.columns.end));
            if start >= end {
                self.number += 1;
                self.column = self.window.columns.start;
                if self.number == sides.len() {
                    self.number = 0;
                    self.rows.start += 1;
                    self.start_row();
                }
                continue;
            }
            let (mut around, mut is_first) = (0, true);
            for (i, &[left, right]) in sides.iter().enumerate() {
                let (first, behind) = (left.min(right), left.max(right));
                if start < first {
                    end = end.min(first);
                } else if start < behind {
                    end = end.min(behind);
                    around += if left < right { 1 } else { -1 };
                    is_first &= i >= self.number || (left < right) != (up < down);
                }
            }
            self.column = end;
            if is_first && (if up < down { around } else { -around }) > 0 {
                return Some((Window { columns: start..end, rows: row..row + 1 }, corners));
            }
        }
    }

    #[inline(never)]
    fn set_sides(&mut self, number: usize, corners: [&ScreenVertex; 3]) {
        if let Some(sides) = self.sides.get_mut(number) {
            *sides = [side(self.rows.start, corners, true), side(self.rows.start, corners, false)];
        }
    }

    #[inline(never)]
    fn start_row(&mut self) {
        self.column = self.window.columns.start;
        let mut number = 0;
        while let Some(corners) = piece(self.polygon, number) {
            self.set_sides(number, corners);
            number += 1;
        }
    }
}

/// How many centres of a row lie left of the edge of a triangle that crosses it upwards, or downwards; 0 if none does.
#[inline(never)]
fn side(row: i32, corners: [&ScreenVertex; 3], upwards: bool) -> i32 {
    let [a, b, c] = corners.map(position);
    for [from, to] in [[a, b], [b, c], [c, a]] {
        let [top, bottom] = if upwards { [to, from] } else { [from, to] };
        if first_row(top[1]) <= row && row < first_row(bottom[1]) {
            return centers_left(&top, &bottom, row);
        }
    }
    0
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::num::I12F4;
    use crate::pipeline::setup::{Cull, area};
    use std::vec::Vec;

    fn polygon(places: &[[i16; 2]]) -> Vec<ScreenVertex> {
        let place = |&[x, y]: &[i16; 2]| {
            let [x, y] = [x, y].map(I12F4::from_bits);
            ScreenVertex { x, y, ..Default::default() }
        };
        places.iter().map(place).collect()
    }

    fn arrange(polygon: &mut [ScreenVertex]) {
        polygon.rotate_left(center(polygon).0);
    }

    #[test]
    fn polygons_that_clipping_made_are_covered_once() {
        let met: [&[[i16; 2]]; 4] = [
            &[[41, 12], [39, -1], [26, 0], [40, 11]],
            &[[17, -56], [-4, -36], [-3, -35], [-3, -36]],
            &[[11623, 525], [7372, -1248], [8111, -1318], [11619, 523]],
            &[[11318, 607], [11911, 661], [11913, 661], [13634, 1380]],
        ];
        for places in met {
            let mut arranged = polygon(places);
            assert!(turned_over(&arranged, 0) > 0, "{places:?} needs nothing");
            arrange(&mut arranged);
            assert_eq!(turned_over(&arranged, 0), 0, "{places:?}");
            // The same polygon, from another corner.
            let original = polygon(places);
            let first = original.iter().position(|vertex| *vertex == arranged[0]).expect("one of them");
            let around: Vec<_> = original[first..].iter().chain(&original[..first]).copied().collect();
            assert_eq!(arranged, around);
        }
    }

    #[test]
    fn where_sides_cross_the_least_is_turned_over() {
        let places = [[8551, 525], [5072, -1248], [5039, -1318], [8547, 523]];
        let mut arranged = polygon(&places);
        let least = (0..4).map(|first| turned_over(&arranged, first)).min();
        arrange(&mut arranged);
        assert_eq!(Some(turned_over(&arranged, 0)), least);
        assert!(least < Some(turned_over(&polygon(&places), 0)));
    }

    #[test]
    fn a_convex_polygon_stays_as_it_is() {
        for places in [&[][..], &[[0, 0]], &[[0, 0], [16, 0]], &[[0, 0], [16, 0], [16, 16], [0, 16]]] {
            let mut arranged = polygon(places);
            arrange(&mut arranged);
            assert_eq!(arranged, polygon(places));
        }
    }

    /// How often a polygon goes around a pixel's centre, clockwise, by the edges that cross the row left of it; and the centres on
    /// edges as if they lay a little further to the right, and less down.
    fn winding(places: &[[i16; 2]], x: i32, y: i32) -> i32 {
        let next = places.iter().cycle().skip(1);
        let edges = places.iter().zip(next).map(|(a, b)| [a, b].map(|place| place.map(i64::from)));
        let [px, py] = [x, y].map(|at| i64::from(at) * 16 + 8);
        edges
            .map(|[[ax, ay], [bx, by]]| {
                let side = (bx - ax) * (py - ay) - (by - ay) * (px - ax);
                // Going up left of the centre, or down.
                match (ay <= py, by <= py) {
                    (false, true) if side >= 0 => 1,
                    (true, false) if side <= 0 => -1,
                    _ => 0,
                }
            })
            .sum()
    }

    #[test]
    fn runs_of_polygons_of_any_shape_are_the_pixels_that_they_go_around_in_20_000_cases() {
        let mut seed = 1_u64;
        let mut random = |range: i64| {
            seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            ((seed >> 33) as i64 % range) as i16
        };
        let (mut drawn, mut twice_around) = (0, 0);
        for case in 0..20_000 {
            let count = 3 + case % 7;
            // Any polygon, or a thin one; on pixel corners and centres or anywhere.
            let lattice = [1, 8][case / 7 % 2];
            let thin = case / 14 % 2 == 0;
            let places: Vec<[i16; 2]> = (0..count)
                .map(|_| {
                    let x = random(320 / i64::from(lattice)) * lattice;
                    let y = if thin { x / 3 + random(5) } else { random(320 / i64::from(lattice)) * lattice };
                    [x - 30, y - 30]
                })
                .collect();
            let polygon = polygon(&places);
            let window = Window { columns: 0..16, rows: 1..15 };
            for cull in [Cull::Back, Cull::Front, Cull::None] {
                let mut times = [[0; 16]; 16];
                let mut runs = Runs::new(&polygon, &window);
                while let Some((run, corners)) = runs.next() {
                    assert!(run.rows.len() == 1 && !run.columns.is_empty());
                    if cull.leaves_out(area(corners.map(position))) {
                        continue;
                    }
                    for x in run.columns {
                        times[run.rows.start as usize][x as usize] += 1;
                    }
                }
                for (y, row) in times.iter().enumerate() {
                    for (x, times) in row.iter().enumerate() {
                        let around = winding(&places, x as i32, y as i32);
                        let wanted = match cull {
                            _ if !window.rows.contains(&(y as i32)) => false,
                            Cull::Back => around < 0,
                            Cull::Front => around > 0,
                            Cull::None => around != 0,
                        };
                        assert_eq!(
                            *times,
                            i32::from(wanted),
                            "{places:?} at {x}, {y}: {around} times around"
                        );
                        drawn += times;
                        twice_around += i32::from(around.abs() > 1);
                    }
                }
            }
        }
        std::println!("runs: {drawn} pixels, {twice_around} that a polygon goes around more than once");
        assert!(drawn > 500_000 && twice_around > 10_000);
    }
}
