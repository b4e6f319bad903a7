//! What joins the rooms: a mesh drawn at once, a list of meshes drawn band by band, pictures drawn straight to a display.

mod canvas;
mod direct;
mod list;
mod pictures;

pub use canvas::Canvas;
pub use list::{CapacityError, Changes, DisplayList, Flushed};
pub use pictures::{CornersError, PerspectiveImage, ShadedTriangle};
