//! In which order a list's triangles are drawn, and the index that it is kept in.
//!
//! - In: the triangles of a list, and which of them are transparent: they show what is behind them.
//! - Out: an [`Index`], by which the triangles of a band are found.
//! - Assumes: it is told of every draw.

use super::entries::{ListTriangle, ListView};
use super::index::{BLOCK, Index, rows_of, sort};
use heapless::VecView;

/// The order of a list's triangles. There is room for as many numbers as for triangles.
pub(super) struct Order<'a> {
    /// As recorded: for each [`BLOCK`] of triangles the rows that they touch, as [`ListTriangle::rows`] has them. In any other
    /// order: the triangles' numbers, the first to be drawn first.
    index: &'a mut VecView<u16>,
    kind: Kind,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    /// As they were recorded.
    AsRecorded,
    /// So many opaque ones as they were recorded, then the others from back to front.
    TransparentLast(u16),
    /// All from back to front.
    BackToFront,
}

impl<'a> Order<'a> {
    pub(super) fn new(index: &'a mut VecView<u16>) -> Self {
        Self { index, kind: Kind::AsRecorded }
    }

    /// Of no triangles.
    pub(super) fn clear(&mut self) {
        self.index.clear();
        self.kind = Kind::AsRecorded;
    }

    pub(super) fn index(&self) -> Index<'_> {
        match self.kind {
            Kind::AsRecorded => Index::Rows(self.index),
            Kind::TransparentLast(_) | Kind::BackToFront => Index::Order(self.index),
        }
    }

    /// Back to front.
    pub(super) fn sort_back_to_front(&mut self, list: &ListView<'_>) {
        self.index.clear();
        self.index.extend(0..list.triangles.len() as u16);
        self.sort_from(0, list.triangles.len(), list);
        self.kind = Kind::BackToFront;
    }

    /// Sorts what comes from a place of the index on: back to front, and as recorded where that is the same. But for the
    /// last so many it is sorted already.
    fn sort_from(&mut self, start: usize, last: usize, list: &ListView<'_>) {
        let key =
            |id: u16| (list.triangles.get(usize::from(id)).map_or(0, |triangle| list.nearness(triangle)), id);
        let ids = self.index.get_mut(start..).unwrap_or_default();
        if last > ids.len() / 8 {
            return sort(ids, key);
        }
        // A few go to their places one by one.
        for end in ids.len() - last..ids.len() {
            let Some((&mut id, sorted)) = ids.get_mut(..=end).and_then(<[_]>::split_last_mut) else {
                return;
            };
            let place = sorted.partition_point(|&other| key(other) < key(id));
            if let Some(behind) = ids.get_mut(place..=end) {
                behind.rotate_right(1);
            }
        }
    }

    /// Takes in the triangles from the `first` on, those of a draw. `draws` are all draws: the triangle behind the last of
    /// each, and whether it is transparent.
    pub(super) fn add<D: Iterator<Item = (u16, bool)>>(
        &mut self,
        list: &ListView<'_>,
        first: usize,
        is_transparent: bool,
        draws: impl Fn() -> D,
    ) {
        if self.kind == Kind::BackToFront {
            self.forget_sorting(list, first as u16, draws);
        }
        let (start, end) = (first as u16, list.triangles.len() as u16);
        if start == end {
            return;
        }
        if is_transparent && self.kind == Kind::AsRecorded {
            self.index.clear();
            self.index.extend(0..start);
            self.kind = Kind::TransparentLast(start);
        }
        match self.kind {
            Kind::TransparentLast(opaque) => {
                self.index.extend(start..end);
                if is_transparent {
                    self.sort_from(opaque.into(), (end - start).into(), list);
                } else {
                    let moved = self.index.get_mut(opaque.into()..).unwrap_or_default();
                    moved.rotate_right((end - start).into());
                    self.kind = Kind::TransparentLast(opaque + (end - start));
                }
            }
            _ => self.index_blocks(list.triangles, first / BLOCK),
        }
    }

    /// Rebuilds the order that the draws alone give, of the triangles before `end`.
    #[cold]
    #[inline(never)]
    fn forget_sorting<D: Iterator<Item = (u16, bool)>>(
        &mut self,
        list: &ListView<'_>,
        end: u16,
        draws: impl Fn() -> D,
    ) {
        self.clear();
        for transparent in [false, true] {
            let (opaque, mut start) = (self.index.len(), 0);
            for (draw_end, is_transparent) in draws() {
                if is_transparent == transparent {
                    self.index.extend(start..draw_end.min(end));
                }
                start = draw_end;
            }
            if transparent && self.index.len() > opaque {
                self.kind = Kind::TransparentLast(opaque as u16);
                return self.sort_from(opaque, self.index.len() - opaque, list);
            }
        }
        self.index.clear();
        self.index_blocks(list.triangles, 0);
    }

    /// The rows of the blocks from one on.
    fn index_blocks(&mut self, triangles: &[ListTriangle], first: usize) {
        let complete = self.index.len().min(first);
        self.index.truncate(complete);
        for block in triangles.get(complete * BLOCK..).unwrap_or_default().chunks(BLOCK) {
            let _ = self.index.push(u16::from_le_bytes(rows_of(block)));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::entries::ListVertex;
    use super::*;
    use crate::num::U1F31;
    use heapless::Vec;
    use proptest::prelude::*;
    use std::vec;

    proptest! {
        #![proptest_config(ProptestConfig { cases: 2_000, failure_persistence: None, ..ProptestConfig::default() })]
        #[test]
        fn transparent_triangles_are_in_order_after_each_draw_in_2_000_cases(
            draws in prop::collection::vec((1..24_u16, any::<bool>()), 1..24),
            near_w in prop::collection::vec(0..40_u32, 600),
        ) {
            // Many are equally far away.
            let vertex = |near_w: &u32| ListVertex { q: U1F31::from_bits(near_w << 20), ..ListVertex::default() };
            let vertices: std::vec::Vec<_> = near_w.iter().map(vertex).collect();
            let all = draws.iter().map(|(count, _)| count).sum::<u16>();
            let triangle = |id: u16| ListTriangle { corners: [id, (id + 1) % 600, (id * 7) % 600], rows: [0; 2] };
            let triangles: std::vec::Vec<_> = (0..all).map(triangle).collect();
            let mut index = Vec::<u16, 600>::new();
            let mut order = Order::new(&mut index);
            let (mut start, mut ends) = (0, vec![]);
            let (mut opaque, mut transparent) = (vec![], vec![]);
            for &(count, is_transparent) in &draws {
                let end = start + count;
                ends.push((end, is_transparent));
                let list = ListView { vertices: &vertices, triangles: &triangles[..end.into()] };
                order.add(&list, start.into(), is_transparent, || ends.iter().copied());
                (if is_transparent { &mut transparent } else { &mut opaque }).extend(start..end);
                transparent.sort_by_key(|&id: &u16| (list.nearness(&triangles[usize::from(id)]), id));
                match order.index() {
                    Index::Order(ids) => prop_assert_eq!(ids, [&opaque[..], &transparent[..]].concat()),
                    Index::Rows(_) => prop_assert!(transparent.is_empty()),
                }
                start = end;
            }
        }
    }
}
