//! Fan: a clipped polygon as triangles around one of its vertices.
//!
//! - In: the polygon that clipping left of a triangle, its corners rounded to 1/16 px.
//! - Out: the vertex around which no triangle of the fan is turned over; or that there is none, and the polygon is *folded*.
//! - Assumes: the polygon was convex before rounding.
//!
//! A convex polygon may be divided into a fan around any of its vertices. But rounding may move two corners that lie close
//! together so that a triangle of the fan gets the other winding:
//!
//! ```text
//!   0 ───────────────── 3          1 should lie below the line from 0 to 2. Rounding took it above: 0 1 2 is turned over, and
//!     ╲   1             │          0 2 3 covers pixels beyond 0 1 and 1 2, which are the neighbours'.
//!        ╲ ╲            │          The fan around 1 has the triangles 1 2 3 and 1 3 0, which cover just the polygon.
//!            ──── 2 ────┘
//! ```
//!
//! Sometimes no vertex will do: sides cross, or no vertex sees all others any more. Then the polygon is **folded**:
//!
//! ```text
//!   0 ─────────────── 3            0 1 and 2 3 cross, and beyond the crossing the polygon shows its back. Neighbours have
//!      ╲           ╱               these edges too, with the same rounded ends, and overlap there. The triangles 0 1 2 and
//!          ╲   ╱                   0 2 3 have opposite windings, and each covers some pixels that are the neighbours'.
//!            ╳
//!         2 ─── 1
//! ```
//!
//! # Which pixels a folded polygon draws
//!
//! Its outline says. Let n be the outline's winding number around a pixel's centre: clockwise turns count +1,
//! counter-clockwise ones −1. A centre on an edge counts to the side that the top-left rule gives it to. Two triangles of a
//! mesh walk the edge that they share in opposite directions, so it cancels in the sum of n over the mesh, wherever rounding
//! took its ends. If every triangle draws what its n says there are neither cracks nor double pixels. A triangle that is not
//! clipped does so: its n is 1 or 0, or −1 if rounding turned it over, and then it is culled. **So a clipped triangle draws a
//! pixel, once, if its outline goes around that in the direction that is not culled.** (It never goes around more than once:
//! from the topmost corner of a convex polygon two chains of sides lead down only. Rounding keeps them so, and a row meets
//! each of them once.)
//!
//! The numbers of a fan's triangles always add up to n. If they have one winding each triangle draws what it covers. If not,
//! `raster::folded` finds row by row what each draws. That is slow, and rare: only what is thinner than 1/8 px can fold.

use super::screen::ScreenVertex;
use core::hint::black_box;

/// The vertex around which no triangle of the fan is turned over, or the least area is; and whether any area is, so that the
/// polygon is folded.
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

/// Twice the area, in 1/256 px², of those triangles of the fan around a vertex whose winding is not that of the whole
/// polygon: of the two windings that of the lesser area.
#[inline(never)]
fn turned_over(polygon: &[ScreenVertex], first: usize) -> u64 {
    let place =
        |i: usize| polygon.get(i).map(|vertex| [vertex.x, vertex.y].map(|at| i32::from(at.to_bits())));
    let Some([x, y]) = place(first) else {
        return 0;
    };
    // Those of either winding.
    let (mut left, mut right) = (0_u64, 0_u64);
    let (mut last, mut i) = ([x, y], first);
    for _ in 1..polygon.len() {
        i = if i + 1 < polygon.len() { i + 1 } else { 0 };
        let Some([bx, by]) = place(i) else {
            return 0;
        };
        let [ax, ay] = last;
        let area = (ax - x) * (by - y) - (ay - y) * (bx - x);
        *(if area < 0 { &mut left } else { &mut right }) += u64::from(area.unsigned_abs());
        last = [bx, by];
        // Not unrolled.
        black_box(());
    }
    left.min(right)
}

/// The corners of a triangle of the fan around the first vertex; `number` is 0 … corners − 3. `None` beyond that.
#[inline]
pub(crate) fn piece(polygon: &[ScreenVertex], number: usize) -> Option<[&ScreenVertex; 3]> {
    let (first, rest) = polygon.split_first()?;
    match rest.get(number..)? {
        [second, third, ..] => Some([first, second, third]),
        _ => None,
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use crate::num::I12F4;
    use std::vec::Vec;

    /// Of vertices at these places, in 1/16 px.
    pub(crate) fn polygon(places: &[[i16; 2]]) -> Vec<ScreenVertex> {
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
}
