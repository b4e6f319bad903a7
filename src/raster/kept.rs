//! Kept set-ups: what was computed of a triangle, as words, for the next band that it reaches into.
//!
//! - In: a triangle that is set up; or the words that were made of it.
//! - Out: words, four at a time; or the triangle as it was set up.
//! - Assumes: what is read was written here, and is used with the same needs. It is no sliver: these are rare.

use super::needs::Needs;
use super::plane::Plane;
use super::triangle::{Planes, TriangleSetup};
use bytemuck::{Pod, Zeroable, must_cast, must_cast_mut, must_cast_ref};
use core::hint::black_box;

/// Four words.
pub(crate) type Words = [u32; 4];

/// What comes first.
#[derive(Clone, Copy, Pod, Zeroable)]
#[repr(C)]
struct Head {
    z: Plane,
    /// The number of the triangle; from bit 16 on [`TriangleSetup::longest`]; from bit 24 on how many [`Words`] there are; and the flags
    /// [`GRAY`] and [`PLAIN`].
    bits: u32,
}

const GRAY: u32 = 1 << 30;
/// It is small and neither held nor bent, as most are: no [`Rest`] follows.
const PLAIN: u32 = 1 << 31;

/// What follows, before the attributes.
#[derive(Clone, Copy, Pod, Zeroable)]
#[repr(C)]
struct Rest {
    bends: [[i32; 3]; 2],
    /// The first.
    corner: [i16; 2],
    /// [`TriangleSetup::q_step_zeros`], and from bit 8 on flags.
    bits: u32,
}

/// The number of a triangle, and how many words there are, from the first.
#[inline]
pub(crate) fn number_and_count(&[_, _, _, bits]: &Words) -> (u32, usize) {
    (bits & 0xffff, (bits >> 24 & 15) as usize)
}

impl TriangleSetup {
    #[inline]
    fn is_plain(&self) -> bool {
        self.planes.is_small() && !(self.is_held | self.is_bent)
    }

    /// How many [`Words`] it is: at most 13.
    #[inline]
    pub(crate) fn words(&self, needs: &Needs) -> usize {
        let mut attributes = if needs.reads_uv() { 2 } else { 0 };
        if needs.reads_color() {
            attributes += if self.gray { 1 } else { 3 };
        }
        // Of a plain colour there is but a plane: the last half stays away.
        let apart = if !self.is_plain() {
            3
        } else if needs.reads_color() {
            0
        } else {
            1
        };
        apart + 2 * attributes
    }

    /// Writes itself as so many words, with a number.
    #[inline]
    pub(crate) fn write(&self, id: u16, to: &mut [Words]) {
        let count = to.len() as u32;
        let Some((head, mut left)) = to.split_first_mut() else {
            return;
        };
        let mut bits = u32::from(id) | u32::from(self.longest) << 16 | count << 24 | PLAIN;
        if self.gray {
            bits |= GRAY;
        }
        if !self.is_plain() {
            let Some((rest, behind)) = left.split_first_chunk_mut::<2>() else {
                return;
            };
            self.write_rest(must_cast_mut(rest));
            (left, bits) = (behind, bits & !PLAIN);
        }
        *head = must_cast(Head { z: self.z, bits });
        copy(must_cast_ref::<_, [Words; 10]>(&self.attributes), left);
    }

    /// Becomes what was written.
    #[inline]
    pub(crate) fn read(&mut self, from: &[Words]) {
        let Some((head, mut left)) = from.split_first() else {
            return;
        };
        let Head { z, bits } = must_cast(*head);
        self.z = z;
        self.longest = (bits >> 16) as u8;
        self.gray = bits & GRAY != 0;
        (self.planes, self.is_held, self.is_bent) = (Planes::Small, false, false);
        if bits & PLAIN == 0 {
            let Some((rest, behind)) = left.split_first_chunk::<2>() else {
                return;
            };
            self.set_rest(must_cast_ref(rest));
            left = behind;
        }
        copy(left, must_cast_mut::<_, [Words; 10]>(&mut self.attributes));
    }

    #[inline]
    fn write_rest(&self, to: &mut Rest) {
        (to.bends, to.corner) = (self.bends, self.corners[0]);
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
    }

    #[inline]
    fn set_rest(&mut self, rest: &Rest) {
        (self.bends, self.corners[0]) = (rest.bends, rest.corner);
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
fn copy(from: &[Words], to: &mut [Words]) {
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
    use super::super::straight::Straight;
    use super::*;
    use crate::geometry::Inputs;
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

    proptest! {
        #![proptest_config(ProptestConfig { cases: 2_000, failure_persistence: None, ..ProptestConfig::default() })]
        #[test]
        fn what_is_read_is_what_was_written_in_2_000_cases(
            words in prop::collection::vec(any::<[u32; 4]>(), 24),
            flags in any::<[u32; 2]>(),
            inputs in prop::sample::select(vec![Inputs::None, Inputs::Uv, Inputs::Color, Inputs::UvColor]),
            id in any::<u16>(),
        ) {
            let (needs, setup) = (needs(inputs), any_setup(&words[..12], flags[0]));
            let count = setup.words(&needs);
            prop_assert!(count <= 13);
            // One more, which stays what it was.
            let mut to = vec![[7; 4]; count + 1];
            setup.write(id, &mut to[..count]);
            prop_assert_eq!(to[count], [7; 4]);
            prop_assert_eq!(number_and_count(&to[0]), (id.into(), count));
            let mut read = any_setup(&words[12..], flags[1]);
            read.read(&to[..count]);

            let kind = |setup: &TriangleSetup| (setup.planes, setup.is_held, setup.is_bent, setup.gray);
            prop_assert_eq!(kind(&read), kind(&setup));
            prop_assert_eq!(read.longest, setup.longest);
            prop_assert_eq!((read.z.origin, read.z.steps), (setup.z.origin, setup.z.steps));
            if !setup.is_plain() {
                let form = |setup: &TriangleSetup| {
                    [setup.q_rises, setup.is_level, setup.straight, setup.leans, setup.is_extreme]
                };
                prop_assert_eq!(form(&read), form(&setup));
                prop_assert_eq!((read.bends, read.q_step_zeros), (setup.bends, setup.q_step_zeros));
                prop_assert_eq!(read.corners()[0], setup.corners()[0]);
            }
            let attributes = |setup: &TriangleSetup| {
                must_cast_ref::<_, [Words; 10]>(&setup.attributes)[..count - if setup.is_plain() { 1 } else { 3 }].to_vec()
            };
            prop_assert_eq!(attributes(&read), attributes(&setup));
            // Of all that are read, or of a plain colour its plane.
            let read_by_shader = match inputs {
                Inputs::None => 0,
                Inputs::Uv => 2,
                Inputs::Color => if setup.gray { 1 } else { 3 },
                Inputs::UvColor => if setup.gray { 3 } else { 5 },
            };
            let plane_only = setup.is_plain() && needs.reads_color();
            prop_assert_eq!(attributes(&setup).len(), 2 * read_by_shader - usize::from(plane_only));
        }
    }
}
