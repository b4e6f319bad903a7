//! From a triangle on the screen to runs of pixels.

mod attribute;
mod depth;
mod plane;
mod rows;
mod setup;
mod small;
mod span;
mod straight;

pub(crate) use attribute::{Attribute, short_inverse, towards_zero};
pub(crate) use depth::visible;
pub(crate) use rows::Rows;
pub(crate) use setup::{Needs, TriangleSetup};
pub(crate) use small::STRAIGHT;
pub(crate) use span::Span;
pub(crate) use straight::Straight;
