//! The display list: a frame is recorded once, and rendered in bands.

mod capacity;
mod changes;
mod display_list;
mod entries;
mod extent;
mod index;
mod memory;
mod record;
mod style;

pub use capacity::CapacityError;
pub use changes::{Changes, Flushed};
pub use display_list::DisplayList;
pub use memory::ListMemory;
