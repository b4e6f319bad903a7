//! Spans: which pixels of each row a small triangle covers, exactly, as a table of bytes.
//!
//! - In: the edges of a triangle that is at most 32 pixels wide and less high, and a window.
//! - Out: for each row the first column that it covers and the end (exclusive); [`rows`](super::rows) has the rule.
//! - Assumes: the corners run clockwise, from the uppermost on.
//!
//! Rows and columns count from a pixel so far up and left that all numbers are positive. Each edge is walked once, from its
//! upper end down, and writes its side of the rows that it bounds:
//!
//! ```text
//!            top                 table
//!             ·            0    10  10     empty: no centre lies between the edges
//!            ╱ ╲           1     9  11
//!   left    ╱   ╲  right   2     8  12
//!          ·     ╲         3     9  12     from here on the lower edge
//!            ─────·        4    11  12
//! ```
//!
//! The number of centres left of an edge has 20 fraction bits, and one addition takes it to the next row. That is exact: see
//! [`side`].

use crate::frame::{Window, first_center};
use crate::math::recip::quotient_of_10_bits;
use crate::num::IS_ARMV6M;
use bytemuck::{must_cast_mut, must_cast_ref};

/// The most rows of a small triangle, and its most columns.
pub(crate) const WIDEST: usize = 32;
/// The fraction bits of columns along an edge.
const FRACTION: u32 = 20;

/// A small triangle on the screen: where its uppermost corner is, and from there the other two, clockwise. All in 1/16 px.
pub(crate) struct SmallEdges {
    pub(super) top: [i32; 2],
    /// x within ±512, y 0 … 511; and so is what these two differ by.
    pub(super) next: [i32; 2],
    pub(super) last: [i32; 2],
}

impl SmallEdges {
    /// Of corners in 1/16 px that run clockwise from the uppermost on; `None` if the triangle is more than 32 pixels wide, or 32 or more
    /// high.
    #[inline(always)]
    pub(crate) fn of([top, [bx, by], [cx, cy]]: [[i32; 2]; 3]) -> Option<Self> {
        let [x, y] = top;
        let (next, last) = ([bx - x, by - y], [cx - x, cy - y]);
        // A difference of −512 … 511 becomes 0 … 1023: no bit from 2¹⁰ on is set.
        let biased = |dx: i32| dx + (1 << 9);
        let wide = biased(next[0]) | biased(last[0]) | biased(last[0] - next[0]);
        ((wide >> 1 | next[1] | last[1]) as u32 >> 9 == 0).then_some(Self { top, next, last })
    }
}

/// The rows of a small triangle in a window. One serves all small triangles of a draw, one after another.
#[derive(Clone, Debug)]
pub(crate) struct Spans {
    /// The table, two rows a word: so they are [kept](super::kept).
    words: [u32; WIDEST / 2],
    /// The screen's row and column from which the table counts: [`WIDEST`] columns left of the triangle's
    /// [first pixel](super::triangle::TriangleSetup::first_pixel). So the column may be left of the screen.
    pub(crate) row: i16,
    pub(crate) column: i16,
    /// The rows of the table that lie in the window.
    start: u8,
    end: u8,
    /// The end of the table, which may have rows below the window.
    pub(super) last: u8,
}

impl Spans {
    pub(crate) const NONE: Self =
        Self { words: [0; WIDEST / 2], row: 0, column: 0, start: 0, end: 0, last: 0 };

    /// Of each row the first column and the end (exclusive), which may be less.
    #[inline(always)]
    fn table(&mut self) -> &mut [[u8; 2]; WIDEST] {
        must_cast_mut(&mut self.words)
    }

    /// Starts a triangle. False if it has no pixels in the window. (True does not mean that it has.)
    #[inline(always)]
    pub(crate) fn start(&mut self, edges: &SmallEdges, window: &Window, and_below: bool) -> bool {
        let SmallEdges { top: [ax, ay], next: [bx, by], last: [cx, cy] } = *edges;
        let (row, column) = (first_center(ay), (ax >> 4) - WIDEST as i32);
        (self.row, self.column) = (row as i16, column as i16);
        // From the row's centre up to the corner.
        let above = row * 16 + 8 - ay;
        let rows_to = |y: i32| (y - above + 15) >> 4;
        let (mut first, mut next, mut last) = (0, rows_to(by), rows_to(cy));
        let (is_next_lower, is_last_lower) = (next > last, last > next);
        let mut end = next.max(last);
        let mut last_row = end;
        let (top, bottom) = (window.rows.start - row, window.rows.end - row);
        if (-top | (bottom - end)) < 0 {
            first = top.max(0);
            end = end.min(bottom).max(first);
            if !and_below {
                last_row = end;
            }
            (next, last) = (next.min(last_row).max(first), last.min(last_row).max(first));
        }
        (self.start, self.end, self.last) = (first as u8, end as u8, last_row as u8);
        if first >= end {
            return false;
        }
        let x = (ax & 15) + (WIDEST as i32 * 16 + 8);
        let corners = [[x, -above, first], [x + bx, by - above, next], [x + cx, cy - above, last]];
        let table = self.table();
        side::<1>(table, &corners[0], &corners[1]);
        side::<0>(table, &corners[0], &corners[2]);
        if is_last_lower {
            side::<1>(table, &corners[1], &corners[2]);
        } else if is_next_lower {
            side::<0>(table, &corners[2], &corners[1]);
        }
        // All columns lie within 32 pixels of the top.
        if (column - window.columns.start) | (window.columns.end - column - 2 * WIDEST as i32 - 1) < 0 {
            return self.clip(window);
        }
        // One or two rows are empty as often as not, in a band. Of more it would take longer to ask than it saves.
        let [left, right] = self.span(first as usize);
        left < right
            || end - first > 2
            || end - first == 2 && {
                let [left, right] = self.span(first as usize + 1);
                left < right
            }
    }

    /// Clips spans to the window's columns. False if none is left.
    #[cold]
    #[inline(never)]
    fn clip(&mut self, window: &Window) -> bool {
        let within = |column: i32| (column - i32::from(self.column)).clamp(0, 255) as u8;
        let (left, right) = (within(window.columns.start), within(window.columns.end));
        let mut any = false;
        let rows = usize::from(self.start)..usize::from(self.last);
        for [start, end] in self.table().get_mut(rows).unwrap_or_default() {
            (*start, *end) = ((*start).max(left), (*end).min(right));
            any |= *start < *end;
            // Not unrolled.
            core::hint::black_box(());
        }
        any
    }

    /// The rows of the table that lie in the window.
    #[inline]
    pub(crate) fn rows(&self) -> core::ops::Range<usize> {
        usize::from(self.start)..usize::from(self.end)
    }

    /// The first column and the end of a row of the table.
    #[inline]
    pub(crate) fn span(&self, row: usize) -> [u8; 2] {
        must_cast_ref::<_, [[u8; 2]; WIDEST]>(&self.words)[row & (WIDEST - 1)]
    }

    /// Leaves of a row of the table what begins at a column. Returns the row behind it.
    #[inline]
    pub(crate) fn leave(&mut self, row: usize, column: usize) -> usize {
        self.table()[row & (WIDEST - 1)][0] = column as u8;
        row + 1
    }

    /// A row of the table on the screen: the row, and its span's start and end (exclusive).
    #[inline]
    pub(crate) fn on_screen(&self, row: usize) -> [i32; 3] {
        let [start, end] = self.span(row);
        let (first, column) = (i32::from(self.row), i32::from(self.column));
        [first + row as i32, column + i32::from(start), column + i32::from(end)]
    }

    /// Whether no row lies below the window.
    #[inline]
    pub(super) fn end_in_window(&self) -> bool {
        self.last <= self.end
    }

    /// The rows below the window, two a word.
    #[inline]
    pub(super) fn below(&self) -> &[u32] {
        self.words.get(usize::from(self.end) / 2..usize::from(self.last).div_ceil(2)).unwrap_or_default()
    }

    /// Goes on with those in the window below, which begins where the last one ended, of a triangle that was at this row and column, and
    /// ended at `last`. Returns where they belong.
    #[inline]
    pub(super) fn go_on(&mut self, [row, column]: [i16; 2], last: u8, window: &Window) -> &mut [u32] {
        let in_table = |at: i32, least: i32| (at - i32::from(row)).clamp(least, last.into());
        let start = in_table(window.rows.start, 0);
        let end = in_table(window.rows.end, start);
        // One by one: together with the words it would be a copy of all.
        (self.row, self.column) = (row, column);
        (self.start, self.end, self.last) = (start as u8, end as u8, last);
        self.words.get_mut(start as usize / 2..usize::from(last).div_ceil(2)).unwrap_or_default()
    }

    /// With one row only.
    pub(crate) fn only(&self, row: usize) -> Self {
        Self { start: row as u8, end: row as u8 + 1, ..self.clone() }
    }

    /// The next row, and its span's start and end (exclusive), on the screen. The span may be empty.
    #[inline(always)]
    pub(super) fn next(&mut self) -> Option<(i32, i32, i32)> {
        if self.start == self.end {
            return None;
        }
        let [row, start, end] = self.on_screen(self.start.into());
        self.start += 1;
        Some((row, start, end))
    }
}

/// Writes one side of the rows between two corners, the upper one first. Of each corner: its column plus ½, and its y from the
/// first row's centre on, in 1/16 px; and the first row that lies at it or below.
///
/// Why 20 bits are enough: let X be the column of the edge plus ½. The number of centres left of the edge is ceil(X − 1). X
/// is a multiple of 1/16dy, which is more than 2⁻¹³. So the number is floor(X − δ) with any δ above 0 and up to 2⁻¹³. δ =
/// 2⁻¹⁴ is the middle: it may be wrong by up to 2⁻¹⁴ either way. The reciprocal's relative error of 2⁻²⁰ moves X by at most
/// |dx|·2⁻²⁴ ≤ 2⁻¹⁵. The slope's rounding moves it by 2⁻²¹ in every row, by 2⁻¹⁶ in 32 rows. What is left, 2⁻¹⁶, is more than
/// the last bits of the line with `below`.
///
/// One copy for both sides on Armv6-M, where it takes as long as one for each. On a Cortex-M4 it would take 5 cycles more.
#[cfg_attr(all(target_arch = "arm", not(target_has_atomic = "32")), inline(always))]
#[cfg_attr(not(all(target_arch = "arm", not(target_has_atomic = "32"))), inline(never))]
fn side<const SIDE: usize>(table: &mut [[u8; 2]; WIDEST], from: &[i32; 3], to: &[i32; 3]) {
    if IS_ARMV6M { either_side(table, SIDE, from, to) } else { walk(table, SIDE, from, to) }
}

/// As [`side`], of a side that is a number.
#[inline(never)]
fn either_side(table: &mut [[u8; 2]; WIDEST], which: usize, from: &[i32; 3], to: &[i32; 3]) {
    walk(table, which, from, to);
}

#[inline(always)]
fn walk(table: &mut [[u8; 2]; WIDEST], which: usize, from: &[i32; 3], to: &[i32; 3]) {
    let Some(rows) = table.get_mut(from[2] as usize..to[2] as usize) else {
        return;
    };
    if rows.is_empty() {
        return;
    }
    let slope = quotient_of_10_bits(to[0] - from[0], to[1] - from[1]);
    let below = from[2] * 16 - from[1];
    let mut x = (from[0] << (FRACTION - 4)) + ((below * slope) >> 4) - ((1 << (FRACTION - 14)) + 1);
    for row in rows {
        row[which & 1] = (x >> FRACTION) as u8;
        x += slope;
        core::hint::black_box(());
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn edges_of_all_sizes_count_exactly_in_every_row() {
        let mut seed = 1_u32;
        for dy in 1..1 << 9 {
            for dx in -512..=512 {
                seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
                // Within a pixel of the middle of the table, and at most a row above its first centre.
                let [x, y] = [512 + 8 + (seed >> 16 & 15) as i32, -((seed >> 4) as i32 & 15)];
                let end = (y + dy + 15) >> 4;
                // A window may begin at any row: half of the edges start in the middle.
                let first = (seed >> 10 & 1) as i32 * (end / 2);
                if first >= end {
                    continue;
                }
                let mut table = [[0; 2]; WIDEST];
                side::<1>(&mut table, &[x, y, first], &[x + dx, y + dy, end]);
                for row in first..end {
                    // The column plus ½ in 1/16 px is (x·dy + (16·row − y)·dx)/dy; of that less 1, rounded up.
                    let exactly = x * dy + (row * 16 - y) * dx - 16 * dy + 16 * dy - 1;
                    let exactly = exactly.div_euclid(16 * dy);
                    assert_eq!(i32::from(table[row as usize][1]), exactly, "{dx} × {dy}, row {row}");
                }
            }
        }
    }
}
