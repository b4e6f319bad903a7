//! Which triangles of a list touch a band, and in which order they are drawn.
//!
//! - In: the rows of each triangle, or an order of them.
//! - Out: one triangle after the other.
//! - Assumes: the index is as new as the list.

use super::entries::{ListTriangle, ROWS_LOG2};
use crate::frame::Window;

/// How a list finds the triangles of a band.
pub(crate) enum Index<'l> {
    /// All are looked at, in this order.
    Order(&'l [u16]),
    /// Those of blocks that touch the band.
    Rows(&'l [u16]),
}

/// How many triangles have one entry in the index: of s4 in bands of 16 rows 32 cost least, by 0.1 to 0.5 %.
pub(crate) const BLOCK: usize = 32;

/// The rows that some triangles touch.
pub(crate) fn rows_of(block: &[ListTriangle]) -> [u8; 2] {
    block.iter().fold([u8::MAX, 0], |[first, last], triangle| {
        [first.min(triangle.rows[0]), last.max(triangle.rows[1])]
    })
}

/// A window's rows in steps of the index: the first and the last. Of an empty window nonsense.
pub(crate) fn steps_of(window: &Window) -> [u8; 2] {
    [window.rows.start, window.rows.end - 1].map(|row| (row.clamp(0, 1023) >> ROWS_LOG2) as u8)
}

/// Whether rows of the index, from the first to the last, touch others.
#[inline]
pub(crate) fn touch([first, last]: [u8; 2], [start, end]: [u8; 2]) -> bool {
    // One branch.
    ((i32::from(end) - i32::from(first)) | (i32::from(last) - i32::from(start))) >= 0
}

/// The triangles that touch some rows.
pub(crate) struct Touching<'l> {
    triangles: &'l [ListTriangle],
    index: Index<'l>,
    rows: [u8; 2],
    /// The next place in the order or among the triangles, and the end of its block.
    at: usize,
    end: usize,
}

impl<'l> Touching<'l> {
    pub(crate) fn new(triangles: &'l [ListTriangle], index: Index<'l>, rows: [u8; 2]) -> Self {
        Self { triangles, index, rows, at: 0, end: 0 }
    }

    /// The next, with its number.
    #[inline(always)]
    pub(crate) fn next(&mut self) -> Option<(u16, &'l ListTriangle)> {
        let blocks = match self.index {
            Index::Rows(blocks) => blocks,
            Index::Order(order) => {
                let (behind, id, triangle) = next_in_order(self.triangles, order, self.rows, self.at)?;
                self.at = behind;
                return Some((id, triangle));
            }
        };
        loop {
            while self.at == self.end {
                let block = blocks.get(self.at / BLOCK)?;
                self.end += BLOCK;
                if !touch(block.to_le_bytes(), self.rows) {
                    self.at = self.end;
                }
            }
            // Of the last block there may be less.
            let triangle = self.triangles.get(self.at)?;
            self.at += 1;
            if touch(triangle.rows, self.rows) {
                return Some((self.at as u16 - 1, triangle));
            }
        }
    }
}

/// The place behind the next of the order that touches, from `at` on, its number, and itself. It knows nothing of [`Touching`], so
/// that that stays in registers.
#[inline(never)]
fn next_in_order<'l>(
    triangles: &'l [ListTriangle],
    order: &[u16],
    rows: [u8; 2],
    at: usize,
) -> Option<(usize, u16, &'l ListTriangle)> {
    order.iter().enumerate().skip(at).find_map(|(at, &id)| {
        let triangle = triangles.get(usize::from(id)).filter(|triangle| touch(triangle.rows, rows))?;
        Some((at + 1, id, triangle))
    })
}

/// By keys that all differ: a heap sort, in place and without the recursion of the library's, which takes 4 KiB of stack.
pub(crate) fn sort(ids: &mut [u16], key: impl Fn(u16) -> (u32, u16)) {
    let sift = |ids: &mut [u16], mut root: usize| {
        while 2 * root + 1 < ids.len() {
            let mut child = 2 * root + 1;
            if child + 1 < ids.len() && key(ids[child]) < key(ids[child + 1]) {
                child += 1;
            }
            if key(ids[root]) >= key(ids[child]) {
                return;
            }
            ids.swap(root, child);
            root = child;
        }
    };
    for root in (0..ids.len() / 2).rev() {
        sift(ids, root);
    }
    for end in (1..ids.len()).rev() {
        ids.swap(0, end);
        sift(&mut ids[..end], 0);
    }
}
