//! A plane: a quantity that is linear on the screen, as a value and two steps in integers that wrap.

/// A linear function on the screen, in integers that wrap.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Plane {
    /// At pixel (0, 0); of a sliver, at corner 0.
    pub(crate) origin: u32,
    /// One column to the right, one row down; of a sliver, from corner 0 to corners 1 and 2.
    pub(crate) steps: [i32; 2],
}
