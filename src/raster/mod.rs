//! From a triangle on the screen to runs of pixels.

mod attribute;
mod course;
mod depth;
mod folded;
mod gradients;
mod held;
mod inputs;
mod kept;
mod lean;
mod needs;
mod packing;
mod plane;
mod prepare;
mod rows;
mod scaling;
mod setup;
mod slopes;
mod small;
mod span;
mod spans;
mod straight;
mod triangle;

pub(crate) use attribute::{Attribute, Place, short_inverse, towards_zero};
pub(crate) use depth::{first_visible, visible};
pub(crate) use folded::{Runs, rows_of_folded};
pub(crate) use kept::{has_rows, number};
pub(crate) use needs::{InputCode, Needs};
pub(crate) use packing::Packing;
#[cfg(test)]
pub(crate) use rows::LongRows;
pub(crate) use rows::Rows;
pub(crate) use span::Span;
pub(crate) use spans::{Spans, WIDEST};
pub(crate) use straight::Straight;
#[cfg(test)]
pub(crate) use triangle::Planes;
pub(crate) use triangle::{ATTRIBUTES, TriangleSetup};
