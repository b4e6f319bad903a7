//! Kept set-ups: what was computed of a triangle, as words, for the next band that it reaches into.
//!
//! - In: a triangle that is set up, and its rows; or the words that were made of it.
//! - Out: words; or the triangle as it was set up, and its rows in the next band.
//! - Assumes: what is read was written here, and is used with the same needs. It is no sliver: these are rare.

use super::needs::Needs;
use super::plane::Plane;
use super::rows::Rows;
use super::triangle::{Planes, TriangleSetup};
use crate::frame::Window;
use bytemuck::{Pod, Zeroable, cast_slice, cast_slice_mut, must_cast, must_cast_mut, must_cast_ref};
use core::hint::black_box;

/// What comes first.
#[derive(Clone, Copy, Pod, Zeroable)]
#[repr(C)]
struct Head {
    /// The number of the triangle; from bit 16 on [`TriangleSetup::longest`]; from bit 21 on the end of its rows in their table, or 0 if
    /// they are not kept; and the flags [`GRAY`] and [`PLAIN`].
    bits: u32,
    /// Of the table.
    row_and_column: [i16; 2],
    z: Plane,
}

const GRAY: u32 = 1 << 30;
/// It is small and neither held nor bent, as most are: no [`Rest`] follows.
const PLAIN: u32 = 1 << 31;

/// What follows of any other, before the attributes.
#[derive(Clone, Copy, Pod, Zeroable)]
#[repr(C)]
struct Rest {
    bends: [[i32; 3]; 2],
    /// [`TriangleSetup::q_step_zeros`], and from bit 8 on flags.
    bits: u32,
}

/// The number of a triangle, from the first word.
#[inline]
pub(crate) fn number(first: u32) -> u32 {
    first & 0xffff
}

/// Whether its rows were kept.
#[inline]
pub(crate) fn has_rows(first: u32) -> bool {
    first >> 21 & 63 != 0
}

impl TriangleSetup {
    #[inline]
    fn is_plain(&self) -> bool {
        self.planes.is_small() && !(self.is_held | self.is_bent)
    }

    /// How many colours are kept.
    #[inline]
    fn kept_colors(&self, needs: &Needs) -> usize {
        if !needs.reads_color() {
            0
        } else if self.gray {
            1
        } else {
            3
        }
    }

    /// Writes itself, with a number, and those of its rows that lie below the window. Returns what is left of the words, of which it takes
    /// at most 68; `None` if there are not enough.
    ///
    /// Inlined, as the reverse is: together they take 15 000 cycles less of s4 in bands of 16 rows on a Cortex-M4.
    #[inline(always)]
    pub(crate) fn keep<'w>(
        &self,
        id: u16,
        rows: &Rows,
        needs: &Needs,
        to: &'w mut [u32],
    ) -> Option<&'w mut [u32]> {
        let (row_and_column, last, below) = rows.below();
        let mut bits = u32::from(id) | u32::from(self.longest) << 16 | u32::from(last) << 21;
        if self.gray {
            bits |= GRAY;
        }
        let is_plain = self.is_plain();
        if is_plain {
            bits |= PLAIN;
        }
        let (head, to) = to.split_first_chunk_mut::<5>()?;
        *head = must_cast(Head { bits, row_and_column, z: self.z });
        let (of_rows, mut to) = to.split_at_mut_checked(below.len())?;
        copy(below, of_rows);
        if !is_plain {
            return self.keep_rest(needs, to);
        }
        let mut colors = &self.attributes[..];
        if needs.reads_uv() {
            let [u, v, others @ ..] = &self.attributes;
            let (uv, left) = to.split_first_chunk_mut::<8>()?;
            *uv = must_cast([u.plain(), v.plain()]);
            (to, colors) = (left, others);
        }
        for color in colors.iter().take(self.kept_colors(needs)) {
            let (plane, left) = to.split_first_chunk_mut::<3>()?;
            *plane = must_cast(color.plane);
            to = left;
        }
        Some(to)
    }

    #[inline(never)]
    fn keep_rest<'w>(&self, needs: &Needs, to: &'w mut [u32]) -> Option<&'w mut [u32]> {
        let (rest, to) = to.split_first_chunk_mut::<7>()?;
        self.write_rest(must_cast_mut(rest));
        let from = self.attributes.get(..self.kept_attributes(needs))?;
        let (attributes, to) = to.split_at_mut_checked(8 * from.len())?;
        copy(cast_slice(from), attributes.as_chunks_mut::<4>().0);
        Some(to)
    }

    #[inline]
    fn kept_attributes(&self, needs: &Needs) -> usize {
        self.kept_colors(needs) + if needs.reads_uv() { 2 } else { 0 }
    }

    /// Becomes what was written, and so do its rows, as far as they lie in this window, the next one below. Returns the words behind it.
    #[inline(always)]
    pub(crate) fn take<'w>(
        &mut self,
        rows: &mut Rows,
        needs: &Needs,
        window: &Window,
        from: &'w [u32],
    ) -> Option<&'w [u32]> {
        let (head, from) = from.split_first_chunk::<5>()?;
        let &Head { bits, row_and_column, z } = must_cast_ref(head);
        self.z = z;
        self.longest = (bits >> 16 & 31) as u8;
        self.gray = bits & GRAY != 0;
        let last = (bits >> 21 & 63) as u8;
        let of_rows = if last > 0 { rows.go_on(row_and_column, last, window) } else { &mut [] };
        let (words, mut from) = from.split_at_checked(of_rows.len())?;
        copy(words, of_rows);
        self.set_first_pixel(row_and_column);
        if bits & PLAIN == 0 {
            return self.take_rest(needs, from);
        }
        (self.planes, self.is_held, self.is_bent) = (Planes::Small, false, false);
        let count = self.kept_colors(needs);
        let mut colors = &mut self.attributes[..];
        if needs.reads_uv() {
            let [u, v, others @ ..] = &mut self.attributes;
            for attribute in [u, v] {
                let (words, left) = from.split_first_chunk()?;
                attribute.set_plain(words);
                from = left;
            }
            colors = others;
        }
        for color in colors.iter_mut().take(count) {
            let (plane, left) = from.split_first_chunk::<3>()?;
            color.plane = must_cast(*plane);
            from = left;
        }
        Some(from)
    }

    #[inline(never)]
    fn take_rest<'w>(&mut self, needs: &Needs, from: &'w [u32]) -> Option<&'w [u32]> {
        let (rest, from) = from.split_first_chunk::<7>()?;
        self.set_rest(must_cast_ref(rest));
        let count = self.kept_attributes(needs);
        let attributes = self.attributes.get_mut(..count)?;
        let (words, from) = from.split_at_checked(8 * count)?;
        copy(words.as_chunks::<4>().0, cast_slice_mut(attributes));
        Some(from)
    }

    #[inline]
    fn write_rest(&self, to: &mut Rest) {
        let mut bits = u32::from(self.q_rises);
        for flag in [
            self.is_level,
            self.planes.is_small(),
            self.is_held,
            self.is_bent,
            self.straight,
            self.leans,
            self.is_extreme,
        ] {
            bits = bits << 1 | u32::from(flag);
        }
        to.bits = bits << 8 | u32::from(self.q_step_zeros);
        copy(must_cast_ref::<_, [u32; 6]>(&self.bends), must_cast_mut::<_, [u32; 6]>(&mut to.bends));
    }

    #[inline]
    fn set_rest(&mut self, rest: &Rest) {
        copy(must_cast_ref::<_, [u32; 6]>(&rest.bends), must_cast_mut::<_, [u32; 6]>(&mut self.bends));
        self.q_step_zeros = rest.bits as u8;
        let flag = |number: u32| rest.bits >> (8 + number) & 1 != 0;
        (self.is_extreme, self.leans, self.straight) = (flag(0), flag(1), flag(2));
        (self.is_bent, self.is_held) = (flag(3), flag(4));
        self.planes = if flag(5) { Planes::Small } else { Planes::Screen };
        (self.is_level, self.q_rises) = (flag(6), flag(7));
    }
}

/// As many as both have. Not inlined: there it would be unrolled.
#[inline(never)]
fn copy<T: Copy>(from: &[T], to: &mut [T]) {
    for (from, to) in from.iter().zip(to) {
        *to = *from;
        // Not as a call.
        black_box(());
    }
}

#[cfg(test)]
mod tests {
    use super::super::attribute::Attribute;
    use super::super::needs::InputCode;
    use super::super::packing::Packing;
    use super::super::prepare::from_top;
    use super::super::rows::{LongRows, Small};
    use super::super::straight::Straight;
    use super::*;
    use crate::geometry::{Inputs, ScreenVertex, area, position};
    use crate::num::I12F4;
    use proptest::prelude::*;
    use std::vec;

    fn needs(inputs: Inputs) -> Needs {
        Needs {
            code: InputCode::of(inputs),
            straight: Straight::Always,
            every_pixel: false,
            scale: 0,
            unscaled_packing: Packing::default(),
            packing: Packing::default(),
            margins: [0; 2],
            color_step: 1,
            depth: true,
            gray: false,
            rows_below: true,
        }
    }

    /// A set-up of any numbers.
    fn any_setup(words: &[[u32; 4]], flags: u32) -> TriangleSetup {
        let flag = |number: u32| flags >> number & 1 != 0;
        let [a, b, c, d] = words[0].map(|word| word as i32);
        let [e, f, bits, _] = words[1].map(|word| word as i32);
        let mut setup = TriangleSetup {
            corners: [[bits as i16, e as i16], [a as i16, b as i16], [c as i16, d as i16]],
            z: Plane { origin: words[0][3], steps: [b, c] },
            bends: [[a, b, c], [d, e, f]],
            longest: (bits & 31) as u8,
            q_step_zeros: (bits >> 8 & 31) as u8,
            q_rises: flag(0),
            is_level: flag(1),
            gray: flag(2),
            planes: if flag(3) { Planes::Small } else { Planes::Screen },
            is_held: flag(4),
            is_bent: flag(5),
            straight: flag(6),
            leans: flag(7),
            is_extreme: flag(8),
            ..TriangleSetup::new()
        };
        let attributes: &[Attribute] = bytemuck::cast_slice(&words[2..]);
        setup.attributes.copy_from_slice(attributes);
        setup
    }

    /// Of a colour that is plain there is but its plane, and of a texture coordinate its plane and the texels of its range.
    fn of_pixels(setup: &TriangleSetup, uv: usize, colors: usize) -> vec::Vec<[u32; 4]> {
        let plane = |attribute: &Attribute| -> [u32; 3] { must_cast(attribute.plane) };
        let (of_uv, others) = setup.attributes.split_at(uv);
        let of_uv = of_uv.iter().map(|attribute| {
            let [a, b, c] = plane(attribute);
            let texels =
                [attribute.least, attribute.least.wrapping_add_unsigned(attribute.range)].map(|at| at >> 16);
            assert_eq!(attribute.scale_log2(), 0);
            [a, b, c, (texels[0] * 7919 + texels[1]) as u32]
        });
        let of_colors = others.iter().take(colors).map(|attribute| {
            let [a, b, c] = plane(attribute);
            [a, b, c, 0]
        });
        of_uv.chain(of_colors).collect()
    }

    fn rows_of(mut rows: Rows, window: &Window) -> vec::Vec<(i32, i32, i32)> {
        let mut all = vec![];
        rows.each(window, |row, start, end| all.push((row, start, end)));
        all
    }

    /// Corners of a triangle of up to 32 pixels on the screen, in 1/16 px.
    fn small_corners() -> impl Strategy<Value = [ScreenVertex; 3]> {
        let at = || (0..500_i16, 0..500_i16);
        ((-160..160_i16, -160..160_i16), [at(), at(), at()]).prop_map(|((x, y), corners)| {
            corners.map(|(dx, dy)| ScreenVertex {
                x: I12F4::from_bits(x + dx),
                y: I12F4::from_bits(y + dy),
                ..ScreenVertex::ZERO
            })
        })
    }

    proptest! {
        #![proptest_config(ProptestConfig { cases: 2_000, max_global_rejects: 20_000, failure_persistence: None, ..ProptestConfig::default() })]
        #[test]
        fn rows_go_on_in_the_window_below_as_if_they_began_there_in_2_000_cases(
            corners in small_corners(),
            top in -12..12_i32,
            heights in [1..24_i32, 0..24_i32],
            columns in [-20..20_i32, 1..60_i32],
            words in prop::collection::vec(any::<[u32; 4]>(), 12),
        ) {
            let [a, b, c] = corners.each_ref();
            let vertices = if area([a, b, c].map(position)) < 0 { [a, c, b] } else { [a, b, c] };
            prop_assume!(area(vertices.map(position)) > 0);
            let first = from_top(vertices);
            let columns = columns[0]..columns[0] + columns[1];
            let middle = top + heights[0];
            let windows = [top..middle, middle..middle + heights[1]].map(|rows| Window { columns: columns.clone(), rows });
            let mut above = Rows::NONE;
            prop_assume!(matches!(above.start_small(&first, &windows[0], true), Small::Rows));
            let needs = needs(Inputs::UvColor);
            let mut setup = any_setup(&words, 1 << 3);
            setup.set_first_corner(first[0]);
            let mut kept = [0; 70];
            setup.keep(0, &above, &needs, &mut kept).unwrap();
            // Whatever was there.
            let mut below = Rows::Long(LongRows::default());
            if !above.end_in_window() {
                prop_assert!(has_rows(kept[0]));
                let mut read = TriangleSetup::new();
                read.take(&mut below, &needs, &windows[1], &kept).unwrap();
                prop_assert_eq!(read.first_pixel(), setup.first_pixel());
            }
            let mut anew = Rows::NONE;
            let is_seen = matches!(anew.start_small(&first, &windows[1], false), Small::Rows);
            let expected = if is_seen { rows_of(anew, &windows[1]) } else { vec![] };
            prop_assert_eq!(rows_of(below, &windows[1]), expected);
        }

        #[test]
        fn what_is_read_is_what_was_written_in_2_000_cases(
            words in prop::collection::vec(any::<[u32; 4]>(), 24),
            flags in any::<[u32; 2]>(),
            inputs in prop::sample::select(vec![Inputs::None, Inputs::Uv, Inputs::Color, Inputs::UvColor]),
            id in 0..u16::MAX,
        ) {
            let (needs, setup) = (needs(inputs), any_setup(&words[..12], flags[0]));
            let window = Window { columns: 0..100, rows: 0..100 };
            let mut rows = Rows::NONE;
            let mut to = [7; 70];
            let left = setup.keep(id, &rows, &needs, &mut to).unwrap().len();
            let count = to.len() - left;
            prop_assert!(count <= 68 - 16 && to[count..].iter().all(|&word| word == 7));
            prop_assert_eq!(number(to[0]), u32::from(id));
            prop_assert!(!has_rows(to[0]));
            prop_assert!(setup.keep(id, &rows, &needs, &mut [0; 70][..count - 1]).is_none());
            let mut read = any_setup(&words[12..], flags[1]);
            prop_assert_eq!(read.take(&mut rows, &needs, &window, &to).unwrap().len(), left);

            let kind = |setup: &TriangleSetup| (setup.planes, setup.is_held, setup.is_bent, setup.gray);
            prop_assert_eq!(kind(&read), kind(&setup));
            prop_assert_eq!(read.longest, setup.longest);
            prop_assert_eq!((read.z.origin, read.z.steps), (setup.z.origin, setup.z.steps));
            let uv = if needs.reads_uv() { 2 } else { 0 };
            let colors = match (needs.reads_color(), setup.gray) {
                (false, _) => 0,
                (true, true) => 1,
                (true, false) => 3,
            };
            if setup.is_plain() {
                let plain = |setup: &TriangleSetup| {
                    let mut setup = TriangleSetup { attributes: setup.attributes, ..TriangleSetup::new() };
                    setup.attributes.iter_mut().for_each(|attribute| attribute.set_scale_log2(0));
                    of_pixels(&setup, uv, colors)
                };
                prop_assert_eq!(of_pixels(&read, uv, colors), plain(&setup));
                return Ok(());
            }
            let form = |setup: &TriangleSetup| {
                [setup.q_rises, setup.is_level, setup.straight, setup.leans, setup.is_extreme]
            };
            prop_assert_eq!(form(&read), form(&setup));
            prop_assert_eq!((read.bends, read.q_step_zeros), (setup.bends, setup.q_step_zeros));
            let attributes = |setup: &TriangleSetup| {
                must_cast_ref::<_, [[u32; 8]; 5]>(&setup.attributes)[..uv + colors].to_vec()
            };
            prop_assert_eq!(attributes(&read), attributes(&setup));
        }
    }
}
