//! A plane: a quantity that is linear on the screen, as a value and two steps.
//!
//! Far outside the triangle a value may not fit 32 bits. It wraps there, and wraps back on the way to where it does fit.

/// A linear function on the screen, in integers that wrap. (A sliver, see [`setup`](super::setup), keeps values at its corners
/// instead.)
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Plane {
    /// The value at the centre of pixel (0, 0). In a sliver: at corner 0.
    pub(crate) origin: u32,
    /// The change over one column to the right, and over one row down. In a sliver: from corner 0 to corner 1, and to corner 2.
    pub(crate) steps: [i32; 2],
}
