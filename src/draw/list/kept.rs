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
        if self.first == self.last {
            self.next = NONE;
            return;
        }
        if self.first == self.end {
            (self.first, self.end) = (0, self.slots.len());
        }
        if let Some(head) = self.slots.get(self.first) {
            self.next = number_and_count(head).0;
        }
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Inputs;
    use crate::raster::{InputCode, Packing, Planes, Straight};
    use proptest::prelude::*;
    use std::vec;

    fn needs() -> Needs {
        let packing = || Packing::new(None, 0, Inputs::None);
        Needs {
            code: InputCode::of(Inputs::UvColor),
            straight: Straight::Always,
            every_pixel: false,
            scale: 0,
            unscaled_packing: packing(),
            packing: packing(),
            margins: [0; 2],
            color_step: 1,
            depth: true,
            gray: false,
        }
    }

    /// A set-up that tells of which triangle it is, in its first and in its last part.
    fn of_triangle(id: u16) -> TriangleSetup {
        let mut setup = TriangleSetup::new();
        setup.planes = if id.is_multiple_of(3) { Planes::Screen } else { Planes::Small };
        setup.gray = !id.is_multiple_of(5);
        setup.z.origin = id.into();
        let colors = if setup.gray { 1 } else { 3 };
        setup.attributes[1 + colors].plane.origin = id.into();
        setup
    }

    proptest! {
        #![proptest_config(ProptestConfig { cases: 2_000, failure_persistence: None, ..ProptestConfig::default() })]
        #[test]
        fn a_band_finds_what_the_one_before_kept_in_2_000_cases(
            triangles in prop::collection::vec((0..12_usize, 1..12_usize), 1..60),
            room in 0..400_usize,
            garbage in any::<u32>(),
        ) {
            // What looks like an entry of any of them.
            let garbage = bytemuck::must_cast([0, 0, 0, (garbage % 60) | 6 << 24 | 3 << 30]);
            let (slots, needs) = (&mut vec![garbage; room], needs());
            let mut kept = Kept::new(slots);
            let (mut found, mut looked_for) = (0, 0);
            for band in 0..24 {
                for (id, &(top, bands)) in triangles.iter().enumerate() {
                    let rows = top..top + bands;
                    if !rows.contains(&band) {
                        continue;
                    }
                    let id = id as u16;
                    let mut setup = of_triangle(id);
                    looked_for += usize::from(band > top);
                    if kept.has(id) {
                        prop_assert!(band > top);
                        found += 1;
                        setup = TriangleSetup::new();
                        kept.take(&mut setup);
                    }
                    let right = of_triangle(id);
                    let colors = if right.gray { 1 } else { 3 };
                    let marks = |setup: &TriangleSetup| {
                        (setup.z.origin, setup.attributes[1 + colors].plane.origin, setup.planes, setup.gray)
                    };
                    prop_assert_eq!(marks(&setup), marks(&right));
                    if band + 1 < rows.end {
                        kept.put(id, &setup, &needs);
                    }
                }
            }
            prop_assert!(found <= looked_for);
            // An entry takes 13 slots at most: with room for all of two bands and a gap none is lost.
            if room > (2 * triangles.len() + 1) * 13 {
                prop_assert_eq!(found, looked_for);
            }
            if room < 6 {
                prop_assert_eq!(found, 0);
            }
        }
    }
}
