//! Split: numbers of 64 bits in two halves, for arrays of them.
//!
//! - In: a number.
//! - Out: the same.
//! - Assumes: nothing.

/// A number of 64 bits, as lower and upper half. (An `i64` is aligned to 8 bytes, and to clear some takes a routine of its own.)
#[derive(Clone, Copy)]
pub(super) struct Split([u32; 2]);

impl Split {
    pub(super) const ZERO: Self = Self([0; 2]);

    pub(super) fn new(value: i64) -> Self {
        Self([value as u32, (value >> 32) as u32])
    }

    #[inline(always)]
    pub(super) fn value(self) -> i64 {
        let Self([lower, upper]) = self;
        (u64::from(upper) << 32 | u64::from(lower)) as i64
    }

    /// Sets it, and adds the bits that are in its size to `all`. Out of line on Armv6-M, as what calls it is unrolled.
    #[cfg_attr(all(target_arch = "arm", not(target_has_atomic = "32")), inline(never))]
    #[cfg_attr(not(all(target_arch = "arm", not(target_has_atomic = "32"))), inline)]
    pub(super) fn set(&mut self, value: i64, all: &mut Self) {
        *self = Self::new(value);
        *all = Self::new(all.value() | value.unsigned_abs() as i64);
    }
}
