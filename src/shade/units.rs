//! What a fill wants of perspective: which attributes, and in which units.
//!
//! - In: an attribute in I16F16.
//! - Out: how many bits to shift it left for the fill.
//! - Assumes: nothing.

use crate::raster::{ATTRIBUTES, Attribute, TriangleSetup};
use core::hint::black_box;

/// How a fill takes attributes that follow perspective.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Form {
    /// A texture's period, or the 256 values of a colour, are all of 32 bits: so it repeats by overflow.
    Modular,
    /// As I16F16, within 1/8 pixel and the set-up's share.
    General,
    /// As I16F16, within 0.02 pixel.
    Exact,
}

/// A function of a triangle, an attribute of it and a pixel.
type InSliver = fn(&TriangleSetup, &Attribute, i32, i32) -> i32;

/// How many attributes a fill takes, and in which units.
///
/// In the modular form an attribute that repeats after 2^a has a integer bits and 32 − a fraction bits: what repeats needs no
/// further care, and colours, 0 … 255.996, are a texture of 256 texels.
#[derive(Clone, Copy, Debug)]
pub struct Units {
    /// Of the exact form: an attribute at a pixel of a sliver, I16F16. By reference, so that programs without it do not link it.
    pub(super) in_sliver: Option<InSliver>,
    pub(crate) form: Form,
    count: u8,
    /// By how much I16F16 is to be shifted left: 16 − a. Not of the general forms.
    up: [u8; ATTRIBUTES],
}

const _: () = assert!(size_of::<Units>() <= 8 + size_of::<usize>());

impl Units {
    /// I16F16.
    #[inline(always)]
    pub(crate) const fn general(count: usize, is_exact: bool) -> Self {
        let (form, in_sliver): (_, Option<InSliver>) = if is_exact {
            (Form::Exact, Some(TriangleSetup::resolve_in_sliver))
        } else {
            (Form::General, None)
        };
        Self { in_sliver, form, count: count as u8, up: [0; ATTRIBUTES] }
    }

    /// Modular, with these numbers of integer bits.
    pub(crate) fn modular<const N: usize>(integer_bits: [u32; N]) -> Self {
        let mut up = [0; ATTRIBUTES];
        for (up, bits) in up.iter_mut().zip(integer_bits) {
            *up = 16 - bits as u8;
        }
        Self { in_sliver: None, form: Form::Modular, count: N as u8, up }
    }

    /// How many attributes.
    #[inline(always)]
    pub(crate) fn count(&self) -> usize {
        self.count.into()
    }

    /// Makes them those for attributes that come out without their `scale_log2`. Returns whether none of these is shifted left by more
    /// than `most` then, and the horizon of each is given to the last bit.
    #[inline]
    pub(crate) fn scale(&mut self, attributes: &[Attribute; ATTRIBUTES], most: u32) -> bool {
        // Slices of a length that is hidden, so that the loop is not unrolled.
        let (ups, attributes): (&mut [u8], &[Attribute]) = (black_box(&mut self.up), black_box(attributes));
        let mut fits = true;
        for (up, attribute) in ups.iter_mut().zip(attributes).take(self.count.into()) {
            *up = (*up + attribute.scale_log2() as u8) & 31;
            fits &= attribute.horizon().1 == 0 && u32::from(*up) <= most;
            black_box(());
        }
        fits
    }

    /// Bits to shift attribute `i` left to the unit of the fill.
    #[inline]
    pub(crate) fn up(&self, i: usize) -> u32 {
        self.up.get(i).copied().unwrap_or(0).into()
    }
}
