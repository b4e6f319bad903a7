//! A brick cube that turns above a floor: the same frames on every board and on a desktop.

use core::convert::Infallible;

use embedded_graphics::{
    mono_font::{MonoTextStyle, ascii::FONT_4X6},
    pixelcolor::{Gray4, Rgb565},
    prelude::*,
    text::Text,
};
use fixel::material::{Gouraud, Textured};
use fixel::prelude::*;
use fixel::{CapacityError, Surface};

use crate::checksum::{Gray4Sum, Rgb565Sum};

/// Frames of one full turn of the cube.
pub const FRAMES: u32 = 32;
/// The picture of the OLED.
pub const OLED: Size = Size::new(128, 64);
/// The picture of the micro:bit, for which no display is emulated: its checksums are printed.
pub const MICROBIT: Size = Size::new(128, 128);
/// Rows that boards draw at a time.
pub const BAND_ROWS: usize = 16;

/// 32 × 32 texels; `tests/assets.rs` makes the file.
const BRICK: [u16; 1024] = texels(include_bytes!("../assets/brick.rgb565"));

/// The same in darker shades, so that the cube's faces differ.
static SHADES: [[u16; 1024]; 3] = [BRICK, shade(&BRICK, 6), shade(&BRICK, 4)];
static TEXTURES: [Texture; 3] =
    [Texture::new(&SHADES[0], 5, 5), Texture::new(&SHADES[1], 5, 5), Texture::new(&SHADES[2], 5, 5)];

static BRICKS: [Material<Textured>; 3] =
    [Material::textured(&TEXTURES[0]), Material::textured(&TEXTURES[1]), Material::textured(&TEXTURES[2])];
static GRASS: Material<Gouraud> = Material::gouraud();

/// Darkens each channel to `eighths` of what it is, at compile time.
const fn shade(texels: &[u16; 1024], eighths: u16) -> [u16; 1024] {
    let mut shaded = [0; 1024];
    let mut i = 0;
    while i < shaded.len() {
        let (r, g, b) = (texels[i] >> 11, texels[i] >> 5 & 63, texels[i] & 31);
        shaded[i] = (r * eighths / 8) << 11 | (g * eighths / 8) << 5 | (b * eighths / 8);
        i += 1;
    }
    shaded
}

/// The faces of a cube of two units that look along +z and −z; turned, they are its other faces.
const FACES: Mesh = Mesh::new(
    &[
        Vertex::new(-1.0, -1.0, 1.0).uv(0, 32),
        Vertex::new(1.0, -1.0, 1.0).uv(32, 32),
        Vertex::new(1.0, 1.0, 1.0).uv(32, 0),
        Vertex::new(-1.0, 1.0, 1.0).uv(0, 0),
        Vertex::new(1.0, -1.0, -1.0).uv(0, 32),
        Vertex::new(-1.0, -1.0, -1.0).uv(32, 32),
        Vertex::new(-1.0, 1.0, -1.0).uv(32, 0),
        Vertex::new(1.0, 1.0, -1.0).uv(0, 0),
    ],
    &[[0, 1, 2], [0, 2, 3], [4, 5, 6], [4, 6, 7]],
);

/// The floor, darker with distance; it reaches behind the camera, so that it is clipped.
const FLOOR: Mesh = Mesh::new(
    &[
        Vertex::new(-4.0, 0.0, 2.0).color(24, 128, 48),
        Vertex::new(4.0, 0.0, 2.0).color(24, 80, 144),
        Vertex::new(4.0, 0.0, -4.0).color(0, 4, 24),
        Vertex::new(-4.0, 0.0, -4.0).color(0, 4, 24),
    ],
    &[[0, 1, 2], [0, 2, 3]],
);

const SKY: Rgb565 = Rgb565::new(1, 2, 6);
const CAPTION: MonoTextStyle<'static, Rgb565> = MonoTextStyle::new(&FONT_4X6, Rgb565::WHITE);

/// A strip of rows of the picture.
pub type Strip<'a> = Band<'a, Rgb565, Depth16>;

/// Room for any frame.
pub type Memory = ListMemory<24, 12>;
/// The list on it.
pub type List<'a> = DisplayList<'a, Rgb565, Depth16, 4>;

/// A mesh, where it stands, and its surface.
type Thing = (&'static Mesh<'static>, Pose, Surface<'static, Rgb565, Depth16>);

/// What there is to draw in a frame.
fn things(frame: u32) -> [Thing; 4] {
    let floor = Pose::IDENTITY.scaled_lit(4.0).at(Vec3::lit(0.0, -1.5, 0.0));
    // The binary angle makes a frame's turn exact, and the next turn the same as the first.
    let turn = Turn::from_raw((frame % FRAMES * (65536 / FRAMES)) as u16);
    let quarter = Turn::from_degrees(90);
    let faces = |pose: Pose| pose.rotated_y(turn).rotated_x(Turn::from_degrees(12));
    [
        (&FLOOR, floor, (&GRASS).into()),
        (&FACES, faces(Pose::IDENTITY.rotated_x(quarter)), (&BRICKS[0]).into()),
        (&FACES, faces(Pose::IDENTITY), (&BRICKS[1]).into()),
        (&FACES, faces(Pose::IDENTITY.rotated_y(quarter)), (&BRICKS[2]).into()),
    ]
}

fn write(strip: &mut Strip<'_>) {
    let Ok(_) = Text::new("fixel", Point::new(2, 6), CAPTION).draw(strip);
}

/// The scene, seen by a camera for a picture of some size.
#[derive(Debug)]
pub struct Scene {
    camera: Camera,
    size: Size,
}

impl Scene {
    /// The scene for a picture of `size` pixels.
    #[must_use]
    pub fn new(size: Size) -> Self {
        let camera = Camera::perspective(Turn::from_degrees(50), size)
            .near(0.25)
            .at(Vec3::lit(0.0, 1.5, 4.2))
            .look_at(Vec3::lit(0.0, -0.1, 0.0), Vec3::lit(0.0, 1.0, 0.0));
        Self { camera, size }
    }

    /// Draws the rows of frame `frame` that the strip holds.
    pub fn draw(&self, frame: u32, strip: &mut Strip<'_>) {
        let Ok(()) = strip.clear(SKY);
        for (mesh, pose, surface) in things(frame) {
            self.camera.draw(mesh, &pose, surface, strip);
        }
        write(strip);
    }

    /// Draws a whole frame from a list, which it fills first, in strips of as many rows as `strip` has; returns the checksum of
    /// the RGB565 words.
    ///
    /// # Errors
    ///
    /// Never: the list has room for any frame.
    pub fn listed(
        &self,
        frame: u32,
        list: &mut List<'_>,
        strip: &mut Strip<'_>,
    ) -> Result<u32, CapacityError> {
        list.clear();
        for (mesh, pose, surface) in things(frame) {
            self.camera.draw(mesh, &pose, surface, list)?;
        }
        let mut sum = Rgb565Sum::new();
        let Ok(()) = list.render_bands(self.size.height, &SKY, strip, |_, strip| {
            write(strip);
            sum.add(strip.pixels());
            Ok::<_, Infallible>(())
        });
        Ok(sum.finish())
    }

    /// Draws a whole frame, strip by strip from the top, each from the meshes, hands each to `show`, and returns the checksum
    /// of the RGB565 words. The height of a strip is the number of rows that both slices hold.
    ///
    /// # Errors
    ///
    /// The first of `show`; the rest of the frame is then not drawn.
    ///
    /// # Panics
    ///
    /// When the slices do not hold one row, or not the same number of pixels.
    pub fn frame<E>(
        &self,
        frame: u32,
        pixels: &mut [u16],
        depth: &mut [u16],
        mut show: impl FnMut(&Strip<'_>) -> Result<(), E>,
    ) -> Result<u32, E> {
        assert_eq!(pixels.len(), depth.len());
        let Size { width, height } = self.size;
        let rows = pixels.len() as u32 / width;
        assert!(rows > 0, "no room for a row");
        let mut sum = Rgb565Sum::new();
        for top in (0..height).step_by(rows as usize) {
            let size = Size::new(width, rows.min(height - top));
            let count = (size.width * size.height) as usize;
            let mut strip = Strip::new(size, &mut pixels[..count], &mut depth[..count])
                .expect("the slices hold the strip")
                .starting_at(top);
            self.draw(frame, &mut strip);
            sum.add(strip.pixels());
            show(&strip)?;
        }
        Ok(sum.finish())
    }

    /// Draws a whole frame on a grey display, dithered, and returns the checksums of its RGB565 and Gray4 forms.
    ///
    /// # Errors
    ///
    /// The display's first; the rest of the frame is then not drawn.
    ///
    /// # Panics
    ///
    /// As [`frame`](Self::frame).
    pub fn show<D: DrawTarget<Color = Gray4>>(
        &self,
        frame: u32,
        pixels: &mut [u16],
        depth: &mut [u16],
        display: &mut D,
    ) -> Result<(u32, u32), D::Error> {
        let mut sum = Gray4Sum::new();
        let rgb565 = self.frame(frame, pixels, depth, |strip| {
            sum.add(strip.dithered::<Gray4>());
            display.fill_contiguous(&strip.bounding_box(), strip.dithered::<Gray4>())
        })?;
        Ok((rgb565, sum.finish()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sum(size: Size, frame: u32, rows: u32) -> u32 {
        let count = (size.width * rows) as usize;
        let (mut pixels, mut depth) = (vec![0; count], vec![0; count]);
        let Ok(sum) = Scene::new(size).frame(frame, &mut pixels, &mut depth, |_| Ok::<_, Infallible>(()));
        sum
    }

    #[test]
    fn every_height_of_the_strips_gives_the_same_frame() {
        for size in [OLED, MICROBIT] {
            for frame in [0, 1, FRAMES / 3, FRAMES - 1] {
                let whole = sum(size, frame, size.height);
                for rows in [1, 3, 16, 24, 63] {
                    assert_eq!(sum(size, frame, rows), whole, "{rows} rows of {size}, frame {frame}");
                }
            }
        }
    }

    #[test]
    fn a_list_shows_the_frame_that_is_drawn_at_once() {
        let scene = Scene::new(MICROBIT);
        let mut memory = Memory::new();
        let mut list = List::new(&mut memory);
        let mut most = [0; 3];
        for rows in [1, 7, 16, 128] {
            let count = (MICROBIT.width * rows) as usize;
            let (mut pixels, mut depth) = (vec![0; count], vec![0; count]);
            let mut strip = Strip::new(Size::new(MICROBIT.width, rows), &mut pixels, &mut depth)
                .expect("the slices hold the strip");
            for frame in 0..FRAMES {
                let listed = scene.listed(frame, &mut list, &mut strip);
                assert_eq!(listed, Ok(sum(MICROBIT, frame, MICROBIT.height)), "{rows} rows, frame {frame}");
                most = core::array::from_fn(|i| most[i].max(list.lengths()[i]));
            }
        }
        let bytes = Memory::BYTES + List::BYTES;
        println!("{most:?} vertices, triangles and draws at most, in {bytes} bytes");
    }

    #[test]
    fn a_turn_returns_to_its_first_frame_and_the_cube_moves_between() {
        assert_eq!(sum(OLED, 0, 16), sum(OLED, FRAMES, 16));
        assert_ne!(sum(OLED, 0, 16), sum(OLED, 1, 16));
    }
}
