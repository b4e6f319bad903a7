//! Fan: a polygon on the screen as triangles around one of its vertices.
//!
//! - In: a polygon that clipping left, its corners rounded to 1/16 px.
//! - Out: the vertex around which no triangle is turned over.
//! - Assumes: the polygon was convex before rounding.
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
//! `raster::folded` finds them row by row. That takes a while, and is rare: what folds is thinner than 1/8 px.

use super::screen::ScreenVertex;

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
pub(crate) fn piece(polygon: &[ScreenVertex], number: usize) -> Option<[&ScreenVertex; 3]> {
    let (first, rest) = polygon.split_first()?;
    match rest.get(number..)? {
        [second, third, ..] => Some([first, second, third]),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::num::I12F4;
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
}
