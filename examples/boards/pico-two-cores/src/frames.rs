//! The frame that both cores draw.

use fixel::BigEndian;
use fixel::embedded_graphics::pixelcolor::Rgb565;
use fixel::embedded_graphics::prelude::*;
use spin::{Once, RwLock};
use static_cell::ConstStaticCell;

use crate::scene;

/// The display, upright.
pub(crate) const SCREEN: Size = Size::new(240, 320);

/// Pixels as the display's bus wants them.
pub(crate) type Format = BigEndian<Rgb565>;

pub(crate) type List = scene::List<'static, Format>;

static MEMORY: ConstStaticCell<scene::Memory> = ConstStaticCell::new(scene::Memory::new());
static LIST: Once<RwLock<List>> = Once::new();

/// The frame that is being drawn. Core 0 writes it while core 1 waits; then both read it, for rendering takes `&List`.
pub(crate) fn list() -> &'static RwLock<List> {
    LIST.call_once(|| RwLock::new(List::new(MEMORY.take())))
}
