//! What both cores draw: a lit torus that turns over a gradient.

use fixel::embedded_graphics::pixelcolor::{Rgb565, Rgb888};
use fixel::embedded_graphics::prelude::*;
use fixel::material::Gouraud;
use fixel::prelude::*;
use fixel::shapes::{self, Counts, Shape};
use fixel::{BigEndian, CapacityError, Gradient};
use spin::{Once, RwLock};
use static_cell::ConstStaticCell;

/// The display, upright.
pub(crate) const SCREEN: Size = Size::new(240, 320);

/// Pixels as the display's bus wants them.
pub(crate) type Format = BigEndian<Rgb565>;

const COUNTS: Counts = Counts::torus(32, 16);
static TORUS: Shape<{ COUNTS.vertices }, { COUNTS.triangles }> =
    shapes::torus(1.0, 0.42, 32, 16).color(235, 150, 60);
static MESH: Mesh = TORUS.mesh();

static SUN: [Light; 1] = [Light::directional(Vec3::lit(-0.5, -0.7, -0.5), [220, 210, 190])];
static LIGHTS: Lights = Lights::new([40, 45, 60], &SUN);
static LACQUER: Material<Gouraud> = Material::gouraud().lit();

/// Room for all of it.
type Memory = ListMemory<{ COUNTS.vertices }, { COUNTS.triangles }>;
pub(crate) type List = DisplayList<'static, Format, Depth16, 1>;

static MEMORY: ConstStaticCell<Memory> = ConstStaticCell::new(Memory::new());
static LIST: Once<RwLock<List>> = Once::new();

/// The frame that is being drawn. Core 0 writes it while core 1 waits; then both read it, for rendering takes `&List`.
pub(crate) fn list() -> &'static RwLock<List> {
    LIST.call_once(|| RwLock::new(List::new(MEMORY.take())))
}

/// What stands behind it.
pub(crate) fn sky() -> Gradient {
    Gradient::new(Rgb888::CSS_MIDNIGHT_BLUE, Rgb888::CSS_SLATE_GRAY, SCREEN.height)
}

/// Records a frame; a turn takes 256.
pub(crate) fn record(frame: u32, list: &mut List) -> Result<(), CapacityError> {
    let turn = Turn::from_raw((frame << 8) as u16);
    let pose = Pose::IDENTITY.rotated_x(Turn::from_degrees(60)).rotated_y(turn);
    let camera = Camera::perspective(Turn::from_degrees(50), SCREEN).at(Vec3::lit(0.0, 0.0, 4.5));
    list.clear();
    camera.lit_by(&LIGHTS).draw(&MESH, &pose, &LACQUER, list)
}
