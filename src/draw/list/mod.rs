//! The display list: a frame is recorded once, and rendered in bands.

mod capacity;
mod changes;
mod compact;
mod display_list;
mod entries;
mod extent;
mod index;
mod kept;
mod memory;
mod order;
mod record;
mod style;

pub use capacity::CapacityError;
pub use changes::{Changes, Flushed};
pub use display_list::DisplayList;
pub use memory::ListMemory;
