//! Folded polygons: which pixels a clipped polygon draws if rounding has folded it.
//!
//! - In: the corners of a folded polygon (see `geometry::fan`), and a window.
//! - Out: runs of pixels, row by row; with each run the triangle of the polygon's fan that draws it.
//! - Assumes: the corners lie in the guard band.
//!
//! Each triangle of the fan goes around the pixels that it covers, clockwise (+1) or counter-clockwise (−1). The sum over the
//! triangles is how often the polygon's outline goes around a pixel. A triangle draws a pixel that it covers if the sum has
//! the triangle's own sign and no earlier triangle of that sign covers it. So each pixel is drawn at most once. Triangles of
//! either sign come out: culling is left to whoever draws them.

use super::rows::centers_left;
use crate::frame::{Window, first_center};
use crate::geometry::{MOST_CORNERS, ScreenVertex, piece};
use core::hint::black_box;
use core::ops::Range;

/// The rows of a window in which a folded polygon has pixel centres.
#[cold]
#[inline(never)]
pub(crate) fn rows_of_folded(polygon: &[ScreenVertex], window: &Window) -> Range<i32> {
    let (mut low, mut high) = (i32::MAX, i32::MIN);
    for vertex in polygon {
        let at = i32::from(vertex.y.to_bits());
        (low, high) = (low.min(at), high.max(at));
        // Not unrolled.
        black_box(());
    }
    first_center(low).max(window.rows.start)..first_center(high).min(window.rows.end)
}

/// How far the runs of a folded polygon in a window were looked for. They come row by row, in a row triangle by triangle, and each
/// from left to right.
pub(crate) struct Runs {
    /// The columns and the rows of the window. (16 bits each: it is on the stack while a run is drawn.)
    columns: [i16; 2],
    rows: [i16; 2],
    row: i16,
    /// The column in which the current triangle continues.
    column: i16,
    /// The current triangle of the fan.
    number: u8,
}

impl Runs {
    /// None yet.
    pub(crate) fn new(polygon: &[ScreenVertex], window: &Window) -> Self {
        let bits = |range: &Range<i32>| [range.start as i16, range.end as i16];
        let (columns, rows) = (bits(&window.columns), bits(&window.rows));
        let mut runs = Self { columns, rows, row: 0, column: 0, number: 0 };
        runs.start_row(rows_of_folded(polygon, window).start);
        runs
    }

    /// The window in which they are looked for.
    pub(crate) fn window(&self) -> Window {
        let range = |[start, end]: [i16; 2]| start.into()..end.into();
        Window { columns: range(self.columns), rows: range(self.rows) }
    }

    /// Which triangle of the fan draws the last run.
    pub(crate) fn number(&self) -> usize {
        self.number.into()
    }

    /// The next run, as a window, and the corners of the triangle that draws it.
    ///
    /// The row's sides are found anew with each run: kept, they would be on the stack while a run is drawn.
    #[cold]
    #[inline(never)]
    pub(crate) fn next<'a>(
        &mut self,
        polygon: &'a [ScreenVertex],
    ) -> Option<(Window, [&'a ScreenVertex; 3])> {
        let end_of_rows = rows_of_folded(polygon, &self.window()).end;
        let mut sides = [[0; 2]; MOST_CORNERS - 2];
        let sides = sides.get_mut(..polygon.len().checked_sub(2)?)?;
        loop {
            let row = i32::from(self.row);
            if row >= end_of_rows {
                return None;
            }
            set_sides(sides, polygon, row);
            while usize::from(self.number) < sides.len() {
                if let Some(columns) = self.next_in_row(sides) {
                    let corners = piece(polygon, self.number.into())?;
                    return Some((Window { columns, rows: row..row + 1 }, corners));
                }
            }
            self.start_row(row + 1);
        }
    }

    /// Looks at some more columns of the current triangle, or goes on to the next one. They are returned if it draws them.
    #[inline]
    fn next_in_row(&mut self, sides: &[[i32; 2]]) -> Option<Range<i32>> {
        let number = usize::from(self.number);
        let &[up, down] = sides.get(number)?;
        let (start, mut end) =
            (i32::from(self.column).max(up.min(down)), up.max(down).min(self.columns[1].into()));
        if start >= end {
            (self.number, self.column) = (self.number + 1, self.columns[0]);
            return None;
        }
        // Up to `end` the same triangles cover all pixels: it is moved to the left where one of them begins or ends
        // before. `around` is their sum; `is_first` says that none with a lower number has the sign of this one.
        let (mut around, mut is_first) = (0, true);
        for (i, &[left, right]) in sides.iter().enumerate() {
            let (first, behind) = (left.min(right), left.max(right));
            if start < first {
                end = end.min(first);
            } else if start < behind {
                end = end.min(behind);
                around += if left < right { 1 } else { -1 };
                is_first &= i >= number || (left < right) != (up < down);
            }
        }
        self.column = end as i16;
        (is_first && (if up < down { around } else { -around }) > 0).then_some(start..end)
    }

    /// Begins at the left end of a row.
    fn start_row(&mut self, row: i32) {
        (self.row, self.column, self.number) = (row as i16, self.columns[0], 0);
    }
}

/// Sets the sides of all triangles of a polygon's fan in a row: how many pixel centres lie left of its edge that goes up, and of the
/// one that goes down. The triangle covers the centres between these two columns. It runs clockwise if the first is less.
#[inline(never)]
fn set_sides(sides: &mut [[i32; 2]], polygon: &[ScreenVertex], row: i32) {
    // A slice of a length that is hidden, so that the loop is not unrolled.
    for (number, sides) in black_box(sides).iter_mut().enumerate() {
        if let Some(corners) = piece(polygon, number) {
            *sides = [side(row, corners, true), side(row, corners, false)];
        }
    }
}

/// How many pixel centres of a row lie left of the edge of a triangle that crosses the row upwards, or downwards. 0 if none
/// does: then there is none in the other direction either.
#[inline(never)]
fn side(row: i32, corners: [&ScreenVertex; 3], upwards: bool) -> i32 {
    let row_of = |vertex: &ScreenVertex| first_center(vertex.y.to_bits().into());
    let mut from = corners[2];
    // A slice of a length that is hidden, so that the loop is not unrolled.
    for &to in black_box(&corners[..]) {
        let [top, bottom] = if upwards { [to, from] } else { [from, to] };
        if row_of(top) <= row && row < row_of(bottom) {
            return centers_left(top, bottom, row);
        }
        from = to;
    }
    0
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::{Cull, area, polygon, position};
    use std::vec::Vec;

    /// How often a polygon goes around a pixel's centre, clockwise, by the edges that cross the row left of it; and the
    /// centres on edges as if they lay a little further to the right, and less down.
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
                while let Some((run, corners)) = runs.next(&polygon) {
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
