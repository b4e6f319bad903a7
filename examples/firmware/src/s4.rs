//! The scene s4, of a display's size: 240×320 RGB565 with depth, drawn from a list in bands of a few rows. The ground of
//! s1_ground, above it the torus of s3_tex and the cube of s2, behind them a sky, and on top a line of text.
//!
//! The focal length is 120 px: as many of the width's as in the other scenes.

use embedded_graphics::{
    mono_font::{MonoTextStyle, ascii::FONT_6X10},
    pixelcolor::{Rgb565, Rgb888},
    prelude::*,
    primitives::Rectangle,
    text::{Baseline, Text},
};
use fixel::prelude::*;
use fixel::{CapacityError, Gradient, Surface};

use crate::bench::{CUBE, Deep, GROUND, GROUND_POSE, LIGHTS, TEXELS, TEXTURED_TORUS_MESH, WALL};

/// The screen.
pub const SIZE: Size = Size::new(240, 320);
/// Pixels of a whole frame.
pub const PIXELS: usize = 240 * 320;

/// Pitched down 9.8°, as in s1_ground.
const CAMERA: Camera = Camera::focal(120.0, SIZE)
    .near(0.1)
    .pose(Pose::IDENTITY.rotated_x(Turn::from_raw(1784u16.wrapping_neg())));

/// A mesh, where it stands, and its surface, which is made when it is drawn.
struct Thing(&'static Mesh<'static>, Pose, fn() -> Surface<'static, Rgb565, Depth16>);

/// The torus is first: while a mesh goes into a list there has to be room for all its vertices, and half of them stay.
static THINGS: [Thing; 3] = [
    Thing(&TEXTURED_TORUS_MESH, TORUS_POSE, || Material::textured(&WALL).lit().surface()),
    Thing(&CUBE, CUBE_POSE, || Material::textured(&WALL).surface()),
    Thing(&GROUND, GROUND_POSE, || Material::textured(&PAVING).surface()),
];

/// The wall's bricks as slabs of stone.
static SLABS: [u16; 4096] = slabs();
static PAVING: Texture = Texture::new(&SLABS, 6, 6);

const fn slabs() -> [u16; 4096] {
    let mut texels = TEXELS;
    let mut i = 0;
    while i < texels.len() {
        let (red, green) = (texels[i] >> 11, texels[i] >> 5 & 63);
        let grey = (2 * red + green) / 5; // 0 … 25
        texels[i] = grey << 11 | (2 * grey + 4) << 5 | grey;
        i += 1;
    }
    texels
}

/// Turned as in s3.
const TORUS_POSE: Pose = Pose::IDENTITY
    .rotated_x(Turn::from_degrees(-50))
    .rotated_y(Turn::from_degrees(-25))
    .at(Vec3::lit(0.35, 0.9, -2.6));
/// Turned as in s2.
const CUBE_POSE: Pose = Pose::IDENTITY
    .rotated_x(Turn::from_degrees(-30))
    .rotated_y(Turn::from_degrees(-40))
    .scaled_lit(0.5)
    .at(Vec3::lit(-0.75, -0.5, -1.7));

const CAPTION: MonoTextStyle<'static, Rgb565> = MonoTextStyle::new(&FONT_6X10, Rgb565::WHITE);
const CAPTION_TEXT: &str = "fixel: 240x320 in bands of a few rows";
/// Where the text is: elsewhere its pixels need not be tried.
const CAPTION_AREA: Rectangle =
    Rectangle::new(Point::new(6, 4), Size::new(6 * CAPTION_TEXT.len() as u32, 10));

const VERTICES: usize = 546;
const TRIANGLES: usize = 429;

/// Room for what is seen, and for all of the torus while it goes in.
pub type Memory = ListMemory<VERTICES, TRIANGLES>;
/// The list on it.
pub type List<'a> = DisplayList<'a, Rgb565, Depth16, { THINGS.len() }>;

/// What is behind everything.
#[must_use]
pub fn sky() -> Gradient {
    Gradient::new(Rgb888::new(24, 72, 152), Rgb888::new(232, 240, 255), SIZE.height / 2)
}

/// Puts the scene into a list.
///
/// # Errors
///
/// Never: the list has as much room as the scene takes.
pub fn record(list: &mut List<'_>) -> Result<(), CapacityError> {
    list.clear();
    let view = CAMERA.lit_by(&LIGHTS);
    THINGS.iter().try_for_each(|Thing(mesh, pose, surface)| view.draw(mesh, pose, surface(), list))
}

/// Draws the listed scene from the top down, as many rows at a time as the band has, and hands them to `show`.
///
/// # Errors
///
/// The first of `show`; the rest is not drawn then.
pub fn render<E>(
    list: &mut List<'_>,
    band: &mut Deep<'_>,
    mut show: impl FnMut(&Deep<'_>) -> Result<(), E>,
) -> Result<(), E> {
    list.render_bands(SIZE.height, &sky(), band, |_, band| {
        write(band);
        show(band)
    })
}

/// Draws the same without a list, at once, into a frame of the whole screen.
pub fn draw(frame: &mut Deep<'_>) {
    frame.clear_to(&sky());
    for Thing(mesh, pose, surface) in &THINGS {
        CAMERA.lit_by(&LIGHTS).draw(mesh, pose, surface(), frame);
    }
    write(frame);
}

/// The text, as far as it is in the band.
fn write(band: &mut Deep<'_>) {
    if !band.bounding_box().intersection(&CAPTION_AREA).is_zero_sized() {
        let text = Text::with_baseline(CAPTION_TEXT, CAPTION_AREA.top_left, CAPTION, Baseline::Top);
        let Ok(_) = text.draw(band);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use core::convert::Infallible;

    #[test]
    fn every_height_shows_the_bytes_of_a_frame_drawn_at_once() {
        let (mut pixels, mut depth) = (vec![0; PIXELS], vec![0; PIXELS]);
        let mut whole = Deep::new(SIZE, &mut pixels, &mut depth).expect("the slices hold it");
        draw(&mut whole);
        let mut memory = Memory::new();
        let mut list = List::new(&mut memory);
        record(&mut list).expect("the list holds the scene");
        for rows in [1, 2, 7, 8, 16, 64, SIZE.height] {
            let count = (SIZE.width * rows) as usize;
            let (mut pixels, mut depth) = (vec![0; count], vec![0; count]);
            let mut band =
                Deep::new(Size::new(SIZE.width, rows), &mut pixels, &mut depth).expect("the slices hold it");
            let mut shown = Vec::new();
            let Ok(()) = render(&mut list, &mut band, |band| {
                shown.extend_from_slice(band.pixels());
                Ok::<_, Infallible>(())
            });
            assert!(shown == whole.pixels(), "{rows} rows at a time");
        }
    }

    #[test]
    fn the_list_has_no_more_room_than_the_scene_takes() {
        let mut memory = Memory::new();
        let mut list = List::new(&mut memory);
        record(&mut list).expect("the list holds the scene");
        let [vertices, triangles, draws] = list.lengths();
        let bytes = Memory::BYTES + List::BYTES;
        println!("s4: {vertices} vertices, {triangles} triangles, {draws} draws in {bytes} bytes");
        assert_eq!([triangles, draws], [TRIANGLES, THINGS.len()]);
        // All of the torus, while it goes in.
        assert_eq!(TEXTURED_TORUS_MESH.vertices().len(), VERTICES);
    }
}
