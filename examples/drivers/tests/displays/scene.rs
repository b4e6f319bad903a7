//! What is drawn: a lit torus before a gradient, with a line of text on top; from a list in bands, or at once.

use fixel::embedded_graphics::mono_font::{MonoTextStyle, ascii::FONT_6X10};
use fixel::embedded_graphics::pixelcolor::Rgb888;
use fixel::embedded_graphics::{prelude::*, text::Text};
use fixel::prelude::*;
use fixel::shapes::{self, Counts, Shape};
use fixel::{Gradient, PixelFormat};

const COUNTS: Counts = Counts::torus(24, 12);
static TORUS: Shape<{ COUNTS.vertices }, { COUNTS.triangles }> =
    shapes::torus(1.0, 0.45, 24, 12).color(235, 150, 60);
static MESH: Mesh = TORUS.mesh();
static SUN: [Light; 1] = [Light::directional(Vec3::lit(-0.5, -0.7, -0.5), [220, 210, 190])];
static LIGHTS: Lights = Lights::new([40, 45, 60], &SUN);

type List<'a, F> = DisplayList<'a, F, Depth16, 1>;

fn draw<'a, F: PixelFormat, C: fixel::Canvas<'a, Format = F>>(screen: Size, canvas: &mut C) -> C::Output {
    let camera = Camera::perspective(Turn::from_degrees(50), screen).at(Vec3::lit(0.0, 0.0, 3.6));
    let pose = Pose::IDENTITY.rotated_x(Turn::from_degrees(50)).rotated_y(Turn::from_degrees(20));
    camera.lit_by(&LIGHTS).draw(&MESH, &pose, &Material::gouraud().lit(), canvas)
}

fn sky(screen: Size) -> Gradient {
    Gradient::new(Rgb888::CSS_STEEL_BLUE, Rgb888::CSS_MIDNIGHT_BLUE, screen.height)
}

/// Draws what comes on top of a band.
pub(crate) fn on_top<F: PixelFormat<Color: From<Rgb888>>>(band: &mut Band<'_, F, Depth16>) {
    let style = MonoTextStyle::new(&FONT_6X10, Rgb888::CSS_GOLD.into());
    let Ok(_) = Text::new("by the fastest way", Point::new(5, 15), style).draw(band);
}

/// A scene in a list.
pub(crate) fn with_list<F: PixelFormat, R>(
    screen: Size,
    work: impl FnOnce(&mut List<'_, F>, &Gradient) -> R,
) -> R {
    let mut memory = Box::new(ListMemory::<{ COUNTS.vertices }, { COUNTS.triangles }>::new());
    let mut list = List::new(&mut memory);
    draw(screen, &mut list).expect("the list has room for the torus");
    work(&mut list, &sky(screen))
}

/// Hands the frame to `show`, in bands of 16 rows.
pub(crate) fn in_bands<F>(screen: Size, mut show: impl FnMut(&Band<'_, F, Depth16>))
where
    F: PixelFormat<Word: Default, Color: From<Rgb888>>,
{
    let words = (screen.width * ROWS) as usize;
    let (mut pixels, mut depth) = (vec![F::Word::default(); words], vec![0; words]);
    let mut band =
        Band::new(Size::new(screen.width, ROWS), &mut pixels, &mut depth).expect("it is of this size");
    with_list(screen, |list, sky| {
        let Ok(()) = list.render_bands(screen.height, sky, &mut band, |_, band| {
            on_top(band);
            show(band);
            Ok::<_, std::convert::Infallible>(())
        });
    });
}

/// Of a band.
pub(crate) const ROWS: u32 = 16;

/// The same without list and bands.
pub(crate) fn at_once<F, R>(screen: Size, look: impl FnOnce(&Band<'_, F, Depth16>) -> R) -> R
where
    F: PixelFormat<Word: Default, Color: From<Rgb888>>,
{
    let words = (screen.width * screen.height) as usize;
    let (mut pixels, mut depth) = (vec![F::Word::default(); words], vec![0; words]);
    let mut band = Band::<F, Depth16>::new(screen, &mut pixels, &mut depth).expect("it is of this size");
    band.clear_to(&sky(screen));
    draw(screen, &mut band);
    on_top(&mut band);
    look(&band)
}
