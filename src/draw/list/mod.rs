//! The display list: a frame is recorded once, and rendered in bands.

mod changes;
mod display_list;
mod entries;
mod extent;
mod index;
mod record;

pub use changes::{Changes, Flushed};
pub use display_list::{CapacityError, DisplayList};
