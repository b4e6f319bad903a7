//! The libraries, one a file.

mod embedded_3dgfx;
mod embedded_graphics;
mod euc;
mod fixel;
mod retrofire;

use crate::library::Library;

/// All libraries, fixel first.
pub const LIBRARIES: [&dyn Library; 5] = [
    &fixel::Fixel,
    &embedded_3dgfx::Embedded3dgfx,
    &retrofire::Retrofire,
    &euc::Euc,
    &embedded_graphics::EmbeddedGraphics,
];
