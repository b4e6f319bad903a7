//! Set-ups that are kept from one band to the next, in that part of a list's memory that no vertex needs.
//!
//! - In: triangles of a band that reach below it, as they were set up, in the order in which they are drawn.
//! - Out: the same in the next band.
//! - Assumes: bands are drawn from the top down, and triangles in the same order in each of them.
//!
//! It is a queue: what a band takes it takes in the order in which the band before put it in, and puts it in again for the next
//! one. An entry is a few words side by side. The first of them has the triangle's number.
//!
//! ```text
//!   slots   ░░░░░░ first ▓▓▓▓▓▓▓▓▓▓ last ░░░░░░░░       or       ▓▓▓▓ last ░░░░░░░░ first ▓▓▓▓▓▓▓▓ end ░
//! ```
//!
//! A triangle for which there is no room is set up again in the next band, as are all if the list has no memory left.

use super::entries::ListVertex;
use crate::frame::Window;
use crate::raster::{Needs, Rows, TriangleSetup, has_rows, number};
use bytemuck::must_cast_slice_mut;

/// A queue of set-ups.
pub(super) struct Kept<'l> {
    words: &'l mut [u32],
    /// The first word of the triangle that comes first, or [`NONE`].
    next: u32,
    /// Where it is.
    first: usize,
    /// Where the next one will be.
    last: usize,
    /// Where the entries end of which those before `last` are the continuation.
    end: usize,
}

/// No triangle: there are less than 65 535.
const NONE: u32 = u32::MAX;

impl<'l> Kept<'l> {
    /// In these slots, whatever they hold.
    pub(super) fn new(slots: &'l mut [ListVertex]) -> Self {
        let words: &mut [u32] = must_cast_slice_mut(slots);
        Self { next: NONE, first: 0, last: 0, end: words.len(), words }
    }

    /// Whether it may hold anything.
    #[inline]
    pub(super) fn has_room(&self) -> bool {
        !self.words.is_empty()
    }

    /// Whether a triangle comes first.
    #[inline]
    pub(super) fn has(&self, id: u16) -> bool {
        number(self.next) == u32::from(id)
    }

    /// Takes the first one out. False if its rows were not kept.
    #[inline(always)]
    pub(super) fn take(
        &mut self,
        setup: &mut TriangleSetup,
        rows: &mut Rows,
        needs: &Needs,
        window: &Window,
    ) -> bool {
        let has_rows = has_rows(self.next);
        let from = self.words.get(self.first..).unwrap_or_default();
        let Some(left) = setup.take(rows, needs, window, from) else {
            return false;
        };
        self.first = self.words.len() - left.len();
        if self.first == self.last {
            self.next = NONE;
            return has_rows;
        }
        if self.first == self.end {
            (self.first, self.end) = (0, self.words.len());
        }
        if let Some(&word) = self.words.get(self.first) {
            self.next = word;
        }
        has_rows
    }

    /// Puts one in, if there is room.
    #[inline(always)]
    pub(super) fn put(&mut self, id: u16, setup: &TriangleSetup, rows: &Rows, needs: &Needs) {
        if !self.has_room() || setup.planes.is_sliver() || rows.end_in_window() {
            return;
        }
        if self.next == NONE {
            (self.first, self.last, self.end) = (0, 0, self.words.len());
        }
        // Behind the last one, or, if that is too short, from the start again. A loop, so that the code is there once.
        let (mut at, mut end) = (self.last, self.end);
        let mut most = if at >= self.first { self.words.len() } else { self.first - 1 };
        loop {
            let to = self.words.get_mut(at..most).unwrap_or_default();
            if let Some(left) = setup.keep(id, rows, needs, to) {
                (self.last, self.end) = (most - left.len(), end);
                break;
            }
            if at < self.first || self.first == 0 {
                return;
            }
            (at, end, most) = (0, at, self.first - 1);
        }
        if self.next == NONE {
            self.next = self.words.first().copied().unwrap_or(NONE);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Inputs;
    use crate::raster::{InputCode, LongRows, Packing, Planes, Straight};
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
            rows_below: true,
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
            let garbage = bytemuck::must_cast([(garbage % 60) | 3 << 30; 4]);
            let (slots, needs) = (&mut vec![garbage; room], needs());
            // Of a triangle that is not small: its rows are not kept. (Of others, see `raster::kept`.)
            let (rows, window) = (Rows::Long(LongRows::default()), Window { columns: 0..1, rows: 0..1 });
            let mut kept = Kept::new(slots);
            let (mut found, mut looked_for) = (0, 0);
            for band in 0..24 {
                for (id, &(top, bands)) in triangles.iter().enumerate() {
                    let reaches = top..top + bands;
                    if !reaches.contains(&band) {
                        continue;
                    }
                    let id = id as u16;
                    let mut setup = of_triangle(id);
                    looked_for += usize::from(band > top);
                    if kept.has(id) {
                        prop_assert!(band > top);
                        found += 1;
                        setup = TriangleSetup::new();
                        prop_assert!(!kept.take(&mut setup, &mut rows.clone(), &needs, &window));
                    }
                    let right = of_triangle(id);
                    let colors = if right.gray { 1 } else { 3 };
                    let marks = |setup: &TriangleSetup| {
                        (setup.z.origin, setup.attributes[1 + colors].plane.origin, setup.planes, setup.gray)
                    };
                    prop_assert_eq!(marks(&setup), marks(&right));
                    if band + 1 < reaches.end {
                        kept.put(id, &setup, &rows, &needs);
                    }
                }
            }
            prop_assert!(found <= looked_for);
            // An entry takes 52 words at most: with room for all of two bands and a gap none is lost.
            if room * 4 > (2 * triangles.len() + 1) * 52 {
                prop_assert_eq!(found, looked_for);
            }
            if room < 4 {
                prop_assert_eq!(found, 0);
            }
        }
    }
}
