//! Set-ups that are kept from one band to the next, in that part of a list's memory that no vertex needs.
//!
//! - In: triangles of a band that reach below it, as they were set up, in the order in which they are drawn.
//! - Out: the same in the next band.
//! - Assumes: bands are drawn from the top down, and triangles in the same order in each of them.
//!
//! It is a queue: what a band takes it takes in the order in which the band before put it in, and puts it in again for the next
//! one. An entry is a few slots side by side. The first of them has the triangle's number.
//!
//! ```text
//!   slots   ░░░░░░ first ▓▓▓▓▓▓▓▓▓▓ last ░░░░░░░░       or       ▓▓▓▓ last ░░░░░░░░ first ▓▓▓▓▓▓▓▓ end ░
//! ```
//!
//! A triangle for which there is no room is set up again in the next band, as are all if the list has no memory left.

use super::entries::ListVertex;
use crate::raster::{Needs, TriangleSetup, Words, number_and_count};
use bytemuck::must_cast_slice_mut;

/// A queue of set-ups.
pub(super) struct Kept<'l> {
    slots: &'l mut [Words],
    /// The number of the triangle that comes first, or [`NONE`].
    next: u32,
    /// Where it is.
    first: usize,
    /// Where the next one will be.
    last: usize,
    /// Where the entries end of which those before `last` are the continuation.
    end: usize,
}

/// No triangle.
const NONE: u32 = u32::MAX;

impl<'l> Kept<'l> {
    /// In these slots, whatever they hold.
    pub(super) fn new(slots: &'l mut [ListVertex]) -> Self {
        Self { next: NONE, first: 0, last: 0, end: slots.len(), slots: must_cast_slice_mut(slots) }
    }

    /// Whether a triangle comes first.
    #[inline]
    pub(super) fn has(&self, id: u16) -> bool {
        self.next == u32::from(id)
    }

    /// Takes the first one out.
    #[inline(always)]
    pub(super) fn take(&mut self, setup: &mut TriangleSetup) {
        let Some(slots) = self.slots.get(self.first..) else {
            return;
        };
        let Some(head) = slots.first() else {
            return;
        };
        let (_, count) = number_and_count(head);
        setup.read(slots.get(..count).unwrap_or_default());
        self.first += count;
        if self.first == self.end {
            (self.first, self.end) = (0, self.slots.len());
        }
        self.next = match self.slots.get(self.first) {
            Some(head) if self.first != self.last => number_and_count(head).0,
            _ => NONE,
        };
    }

    /// Puts one in, if there is room.
    #[inline(always)]
    pub(super) fn put(&mut self, id: u16, setup: &TriangleSetup, needs: &Needs) {
        if setup.planes.is_sliver() {
            return;
        }
        let count = setup.words(needs);
        if self.next == NONE {
            (self.first, self.last, self.end) = (0, 0, self.slots.len());
        }
        let most = if self.last < self.first { self.first - 1 } else { self.slots.len() };
        if self.last + count > most {
            // From the start again?
            if self.last < self.first || count >= self.first {
                return;
            }
            (self.end, self.last) = (self.last, 0);
        }
        if let Some(slots) = self.slots.get_mut(self.last..self.last + count) {
            setup.write(id, slots);
        }
        self.last += count;
        if self.next == NONE {
            self.next = id.into();
        }
    }
}
