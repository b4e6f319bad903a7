//! Which triangles of a list touch a band, and in which order they are drawn.
//!
//! - In: a list's triangles, each with its rows; and its index: either the rows of each block of 32, or an order of drawing.
//! - Out: the triangles that touch the band, one after another, with their numbers.
//! - Assumes: the index was made after the last change of the list.
//!
//! In the order in which they were recorded, whole blocks of triangles are skipped that do not touch the band. A list that is
//! sorted has an order instead of blocks: there every triangle is tested. Rows are in units of 4 here (see `ROWS_LOG2`), and
//! ranges of them are inclusive: the first and the last.

use super::entries::{ListTriangle, ROWS_LOG2};
use crate::frame::Window;

/// How a list finds the triangles of a band.
pub(crate) enum Index<'l> {
    /// The numbers of all triangles, in the order of drawing. Each triangle is tested.
    Order(&'l [u16]),
    /// The first (lower byte) and the last row (upper byte) of each block of [`BLOCK`] triangles. They are drawn as they were
    /// recorded.
    Rows(&'l [u16]),
}

/// How many triangles have one entry in the index. In bands of 16 rows of the benchmark scene s4 (`examples/firmware/src/s4.rs`)
/// 32 cost least, by 0.1 to 0.5 %.
pub(crate) const BLOCK: usize = 32;

/// The first and the last row that a block of triangles touches.
pub(crate) fn rows_of(block: &[ListTriangle]) -> [u8; 2] {
    block.iter().fold([u8::MAX, 0], |[first, last], triangle| {
        [first.min(triangle.rows[0]), last.max(triangle.rows[1])]
    })
}

/// A window's first and last row, in units of 4 rows. Of no meaning for an empty window.
pub(crate) fn steps_of(window: &Window) -> [u8; 2] {
    [window.rows.start, window.rows.end - 1].map(|row| (row.clamp(0, 1023) >> ROWS_LOG2) as u8)
}

/// Whether two ranges of rows, each from its first to its last, overlap.
#[inline]
pub(crate) fn touch([first, last]: [u8; 2], [start, end]: [u8; 2]) -> bool {
    // Neither difference is negative: both signs in one branch.
    ((i32::from(end) - i32::from(first)) | (i32::from(last) - i32::from(start))) >= 0
}

/// The triangles of a list that touch some rows, one after another.
pub(crate) struct Touching<'l> {
    triangles: &'l [ListTriangle],
    index: Index<'l>,
    rows: [u8; 2],
    /// The next place in the order; without one, the number of the next triangle.
    at: usize,
    /// Without an order: those of the current block that are still to be tested, and those behind it.
    of_block: core::slice::Iter<'l, ListTriangle>,
    behind: &'l [ListTriangle],
}

impl<'l> Touching<'l> {
    pub(crate) fn new(triangles: &'l [ListTriangle], index: Index<'l>, rows: [u8; 2]) -> Self {
        Self { triangles, index, rows, at: 0, of_block: [].iter(), behind: triangles }
    }

    /// The number of the next triangle that touches the rows, and the triangle.
    #[inline(always)]
    pub(crate) fn next(&mut self) -> Option<(u16, &'l ListTriangle)> {
        if let Index::Order(order) = self.index {
            let (after, id, triangle) = next_in_order(self.triangles, order, self.rows, self.at)?;
            self.at = after;
            return Some((id, triangle));
        }
        loop {
            for triangle in self.of_block.by_ref() {
                self.at += 1;
                if touch(triangle.rows, self.rows) {
                    return Some((self.at as u16 - 1, triangle));
                }
            }
            self.start_block()?;
        }
    }

    /// Goes on to the next block that touches the rows.
    #[inline(always)]
    fn start_block(&mut self) -> Option<()> {
        let Index::Rows(blocks) = &mut self.index else {
            return None;
        };
        loop {
            let (block, left) = blocks.split_first()?;
            *blocks = left;
            // The last block may be shorter.
            let (of_block, behind) = self.behind.split_at_checked(BLOCK).unwrap_or((self.behind, &[]));
            self.behind = behind;
            if touch(block.to_le_bytes(), self.rows) {
                self.of_block = of_block.iter();
                return Some(());
            }
            self.at += BLOCK;
        }
    }
}

/// Finds the next triangle that touches `rows`, from the place `at` in the order on. Returns the place after it, its number,
/// and the triangle. It takes no reference to [`Touching`], so that the caller can keep that in registers.
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

/// Sorts by key, the least first. A heap sort: in place and without recursion, where the library's sort takes 4 KiB of stack.
/// It is not stable, so all keys have to differ.
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
