//! From a triangle on the screen to runs of pixels.

mod attribute;
mod rows;
mod setup;
mod small;
mod straight;

pub(crate) use attribute::{Attribute, short_inverse, towards_zero};
pub(crate) use rows::{Rows, Run, Span, Window};
pub use setup::Cull;
pub(crate) use setup::{Needs, Oriented, TriangleSetup, area, in_order, position};
pub(crate) use straight::Straight;
