//! What joins the rooms: a mesh drawn at once, a list of meshes drawn band by band, pictures drawn straight to a display.

mod camera;
mod canvas;
mod direct;
mod list;
mod mesh;
mod pictures;
mod sight;
mod triangle;
mod view;

pub use camera::Projected;
pub use canvas::Canvas;
pub use list::{CapacityError, Changes, DisplayList, Flushed, ListMemory};
pub use pictures::{CornersError, PerspectiveImage, ShadedTriangle};
pub use triangle::draw_triangle;
pub use view::{Air, Clear, View};
