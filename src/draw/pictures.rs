//! Pictures in perspective and single triangles as embedded-graphics drawables.
//!
//! - In: a texture and where its corners are; or a triangle and a shader.
//! - Out: colours on any display, without a buffer.

use super::direct::{Direct, Quad, Side};
use crate::frame::PixelFormat;
use crate::geometry::{Cull, RangeError, ScreenVertex};
use crate::math::Pose;
use crate::num::{I4F12, I12F4, I16F16, U1F31};
use crate::scene::{Camera, Projection, Texture};
use crate::shade::{Material, Reach, Shader};
use core::fmt;
use core::marker::PhantomData;
use embedded_graphics::Drawable;
use embedded_graphics::draw_target::DrawTarget;
use embedded_graphics::pixelcolor::Rgb565;
use embedded_graphics::primitives::Rectangle;

/// A picture that lies in perspective, as an embedded-graphics [`Drawable`]: cards that tilt and flip.
///
/// It goes **straight to any [`DrawTarget`]**, with neither a band nor a frame of memory: each row of its two triangles is one
/// [`fill_contiguous`](DrawTarget::fill_contiguous), whose colours are computed as the display asks for them. Nothing is
/// drawn outside the target's bounding box, and no pixel twice (but a picture seen exactly from its edge, which rounding to 1/16 px
/// may fold); the display's first error ends the drawing and is
/// returned as it is.
///
/// ```
/// use embedded_graphics::{pixelcolor::Rgb565, prelude::*};
/// use fixel::prelude::*;
/// use fixel::{PerspectiveImage, num::I16F16};
/// static QUEEN: Texture = Texture::new(&[0xf800; 64], 3, 3);
/// static BACK: Texture = Texture::new(&[0x001f; 4], 1, 1);
///
/// # let mut display = embedded_graphics::mock_display::MockDisplay::<Rgb565>::new();
/// let camera = Camera::perspective(Turn::from_degrees(40), display.bounding_box().size);
/// // 2 wide, 3 high, 5 away, and turned by 150°: its back is seen.
/// let pose = Pose::IDENTITY.rotated_y(Turn::from_degrees(150)).at(Vec3::lit(0.0, 0.0, -5.0));
/// let size = [I16F16::lit("2"), I16F16::lit("3")];
/// PerspectiveImage::posed(&QUEEN, &camera, &pose, size).back(&BACK).draw(&mut display)?;
/// # assert_eq!(display.get_pixel(Point::new(32, 32)), Some(Rgb565::BLUE));
/// # Ok::<(), core::convert::Infallible>(())
/// ```
///
/// # The picture
///
/// All of the texture, or a [part](Self::part) of it, from border to border. Nothing of what is beyond shows: neither
/// other parts of the texture nor its opposite border. A part that reaches beyond the texture shows it again there,
/// as [`Material::textured`] does. Where a texel is a pixel, seen straight and from whole pixels on, each texel shows once.
///
/// Its back is not seen, unless there is a picture on it ([`Self::back`]) or it is transparent ([`Self::two_sided`]).
///
/// # Which pixels, and which colours
///
/// Coverage is that of [`draw_triangle`](crate::draw_triangle). Columns and rows from −1023 to 1022 are drawn, as far as the
/// target's bounding box has them, which need not begin at (0, 0): `clipped`, `cropped` and `translated` targets do.
///
/// The colours are the same whatever part of the screen the target shows (if it begins left of column 0 there are
/// columns left of it, and rows begin there; else they begin at column 0). They are those of two triangles in a
/// [`Band`](crate::Band) of 1023 columns without depth, byte for byte, in rows of at most [`run`](Self::run) pixels
/// if that is 32 or more; in longer ones perspective begins anew after every run, as exact (¼ pixel), though not
/// always with the same last bits. From [`posed`](Self::posed) the same goes for every band as wide as the camera's
/// picture.
///
/// # Cost
///
/// On a Cortex-M0+ a pixel takes 15 cycles more than in a [`Band`](crate::Band) (see [`cost`](crate::guide::cost)), a row of a triangle
/// 85 more, and then what the display does with them, for which each row is a window. Drawing takes up to 2 KiB of stack, the
/// picture itself and a run of 64 words (128 bytes) included; nothing is kept between two calls.
#[derive(Clone, Copy, Debug)]
pub struct PerspectiveImage<'a, F = Rgb565, const RUN: usize = 64> {
    place: Place,
    front: Picture<'a>,
    back: Back<'a>,
    format: PhantomData<fn() -> F>,
}

/// Where a picture's corners are, counter-clockwise from its top left.
#[derive(Clone, Copy, Debug)]
enum Place {
    OnScreen([ScreenVertex; 4]),
    /// Half of width and height, around the pose's origin.
    Posed {
        projection: Projection,
        camera: Pose,
        pose: Pose,
        half: [I4F12; 2],
    },
}

#[derive(Clone, Copy, Debug)]
enum Back<'a> {
    Hidden,
    /// The front's picture, as if seen through.
    Transparent,
    Picture(Picture<'a>),
}

/// A part of a texture.
#[derive(Clone, Copy, Debug)]
struct Picture<'a> {
    texture: Texture<'a>,
    /// Left, top, right, bottom.
    sides: [I12F4; 4],
}

impl<'a> Picture<'a> {
    fn new(texture: &Texture<'a>, part: &Rectangle) -> Self {
        let side = |start: i32, length: u32| {
            let start = i64::from(start).clamp(-2047, 2046);
            let end = (start + i64::from(length.max(1))).min(2047);
            [start, end].map(|at| I12F4::from_bits(at as i16 * 16))
        };
        let [left, right] = side(part.top_left.x, part.size.width);
        let [top, bottom] = side(part.top_left.y, part.size.height);
        Self { texture: *texture, sides: [left, top, right, bottom] }
    }

    fn whole(texture: &Texture<'a>) -> Self {
        Self::new(texture, &Rectangle::new(Default::default(), texture.size()))
    }

    /// On the corners of the front, as seen from there, or from behind.
    fn side(&self, cull: Cull, mirrored: bool) -> Side<'a> {
        let [left, top, right, bottom] = self.sides;
        let [left, right] = if mirrored { [right, left] } else { [left, right] };
        Side {
            shader: Material::textured(&self.texture),
            uv: [[left, top], [left, bottom], [right, bottom], [right, top]],
            cull,
        }
    }
}

impl<'a> PerspectiveImage<'a> {
    fn at(texture: &Texture<'a>, place: Place) -> Self {
        Self { place, front: Picture::whole(texture), back: Back::Hidden, format: PhantomData }
    }

    /// A texture between four corners on the screen, counter-clockwise from the picture's top left; where they run clockwise
    /// its back is seen.
    ///
    /// Of a corner x, y (pixels, within ±1023½) and q (near/w, so 1 for the nearest and ½ for what is twice as far away)
    /// are used. Four corners that do not lie in one plane make a fold along the diagonal from the first to the third.
    ///
    /// # Errors
    ///
    /// [`RangeError`] if a corner lies outside the guard band.
    pub fn new(texture: &Texture<'a>, corners: &[ScreenVertex; 4]) -> Result<Self, RangeError> {
        let corners =
            corners.map(|ScreenVertex { x, y, q, .. }| ScreenVertex { x, y, q, ..Default::default() });
        if !corners.iter().all(ScreenVertex::in_range) {
            return Err(RangeError);
        }
        Ok(Self::at(texture, Place::OnScreen(corners)))
    }

    /// A texture between four corners on the screen, as [`PerspectiveImage::new`], of which nobody knows how far away they
    /// are: the only plane picture that looks so.
    ///
    /// A corner's distance is as the area of the triangle of the other three. That takes four divisions, here and not when it
    /// is drawn.
    ///
    /// # Errors
    ///
    /// [`CornersError`] if a corner lies outside the guard band of ±1023½ px, or the quadrilateral has a corner
    /// of 180° or more, or a side of no length.
    pub fn between(texture: &Texture<'a>, corners: [[I12F4; 2]; 4]) -> Result<Self, CornersError> {
        let mut vertices = corners.map(|[x, y]| ScreenVertex { x, y, ..Default::default() });
        if !vertices.iter().all(ScreenVertex::in_range) {
            return Err(CornersError::Range);
        }
        // Twice the area without a corner, in 1/256 px²: below 2³¹.
        let areas = [[1, 2, 3], [0, 2, 3], [0, 1, 3], [0, 1, 2]].map(|others| {
            let [a, b, c] = others.map(|i: usize| corners[i].map(|at| i32::from(at.to_bits())));
            (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
        });
        if !areas.iter().all(|&area| area > 0) && !areas.iter().all(|&area| area < 0) {
            return Err(CornersError::NotConvex);
        }
        let areas = areas.map(|area| u64::from(area.unsigned_abs()));
        let least = areas.into_iter().fold(u64::MAX, u64::min);
        for (vertex, area) in vertices.iter_mut().zip(areas) {
            let q = ((least << 31) / area).min((1 << 31) - 1);
            vertex.q = U1F31::from_bits(q as u32);
        }
        Ok(Self::at(texture, Place::OnScreen(vertices)))
    }

    /// A texture in a pose before a camera.
    ///
    /// `size` is width and height in the units of the pose, whose scales along x and y multiply them (0 … 15.99,
    /// saturated; steps of 1/2048). The picture stands around the pose's origin; unturned it faces +z, where the
    /// camera is, with its top towards +y. In a [mirrored](Pose::is_mirrored) pose it is the picture in a mirror: the
    /// front faces where the pose turns +z, and what is written on either side is seen the wrong way round.
    ///
    /// Whatever the numbers, it draws or leaves out, as [`Camera::draw`] does: what crosses the near plane or
    /// leaves the guard band is clipped, and nothing is drawn outside the camera's picture.
    #[must_use]
    pub fn posed(texture: &Texture<'a>, camera: &Camera, pose: &Pose, size: [I16F16; 2]) -> Self {
        let half = size.map(|side| I4F12::from_bits((side.to_bits() >> 5).clamp(0, i16::MAX.into()) as i16));
        let (projection, camera) = (*camera.projection(), *camera.placement());
        Self::at(texture, Place::Posed { projection, camera, pose: *pose, half })
    }
}

impl<'a, F, const RUN: usize> PerspectiveImage<'a, F, RUN> {
    /// The same with a rectangle of the texture (in texels) on its front: a picture from a sheet of them.
    ///
    /// Limited to −2047 … 2047; what lies outside the texture shows it again. Of an empty rectangle one texel is shown.
    #[must_use]
    pub fn part(self, part: &Rectangle) -> Self {
        Self { front: Picture::new(&self.front.texture, part), ..self }
    }

    /// The same with a picture on its back, which reads right if it is turned about its vertical axis.
    #[must_use]
    pub fn back(self, texture: &Texture<'a>) -> Self {
        Self { back: Back::Picture(Picture::whole(texture)), ..self }
    }

    /// The same with a rectangle of a texture on its back, as [`Self::part`] on its front.
    #[must_use]
    pub fn back_part(self, texture: &Texture<'a>, part: &Rectangle) -> Self {
        Self { back: Back::Picture(Picture::new(texture, part)), ..self }
    }

    /// The same seen from behind too, as if painted on glass.
    #[must_use]
    pub fn two_sided(self) -> Self {
        Self { back: Back::Transparent, ..self }
    }

    /// The same for displays of another colour; without this, RGB565.
    #[must_use]
    pub fn format<G>(self) -> PerspectiveImage<'a, G, RUN> {
        let Self { place, front, back, .. } = self;
        PerspectiveImage { place, front, back, format: PhantomData }
    }

    /// The same with `N` pixels on the stack, at least 1. Memory against divisions: every run of a row begins with one.
    #[must_use]
    pub fn run<const N: usize>(self) -> PerspectiveImage<'a, F, N> {
        let Self { place, front, back, format } = self;
        PerspectiveImage { place, front, back, format }
    }

    fn side(&self, is_back: bool) -> Option<Side<'a>> {
        match &self.back {
            _ if !is_back => Some(self.front.side(Cull::Back, false)),
            Back::Hidden => None,
            Back::Transparent => Some(self.front.side(Cull::Front, false)),
            Back::Picture(picture) => Some(picture.side(Cull::Front, true)),
        }
    }
}

impl<F: PixelFormat, const RUN: usize> Drawable for PerspectiveImage<'_, F, RUN> {
    type Color = F::Color;
    type Output = ();

    fn draw<D: DrawTarget<Color = F::Color>>(&self, target: &mut D) -> Result<(), D::Error> {
        let quad = match &self.place {
            Place::OnScreen(corners) => Some(Quad::on_screen(*corners)),
            Place::Posed { projection, camera, pose, half } => Quad::posed(projection, camera, pose, *half),
        };
        match quad {
            Some(mut quad) => quad.draw::<F, D, RUN>(target, |is_back| self.side(is_back)),
            None => Ok(()),
        }
    }
}

/// One triangle on the screen with any [`Shader`], as an embedded-graphics [`Drawable`]: textured, shaded, or the caller's own.
///
/// It goes straight to any [`DrawTarget`], as [`PerspectiveImage`] does and with the same promises. As nothing is kept, it has no
/// depth; triangles that share an edge share no pixel. Nothing can be read back either: it takes opaque materials, and a shader
/// whose [`REACH`](Shader::REACH) is attributes. Any other does not compile:
///
/// ```compile_fail,E0080
/// # use embedded_graphics::{mock_display::MockDisplay, pixelcolor::Rgb565, prelude::*};
/// # use fixel::{Cull, Inputs, QuarterPixel, Reach, ScreenVertex, ShadedTriangle, Shader, Varying};
/// struct Holes;
/// impl Shader<Rgb565> for Holes {
///     type Quality = QuarterPixel;
///     const REACH: Reach = Reach::Place;
/// #   fn inputs(&self) -> Inputs { Inputs::None }
/// #   fn color(&self, _: &Varying) -> u16 { 0 }
/// }
/// # let mut display = MockDisplay::<Rgb565>::new();
/// ShadedTriangle::new(&[ScreenVertex::default(); 3], Cull::None, &Holes).unwrap().draw(&mut display).unwrap();
/// ```
///
/// ```
/// use embedded_graphics::{pixelcolor::Rgb565, prelude::*};
/// use fixel::num::{I12F4, U8F8};
/// use fixel::{Cull, Material, ScreenVertex, ShadedTriangle};
/// # let mut display = embedded_graphics::mock_display::MockDisplay::<Rgb565>::new();
/// let at = |x: i32, y: i32, color: [u8; 3]| ScreenVertex {
///     x: I12F4::from_num(x), // pixels
///     y: I12F4::from_num(y),
///     color: color.map(U8F8::from),
///     ..Default::default()
/// };
/// let rainbow = Material::gouraud();
/// let corners = [at(5, 5, [255, 0, 0]), at(8, 60, [0, 255, 0]), at(60, 20, [0, 0, 255])];
/// ShadedTriangle::new(&corners, Cull::None, &rainbow)?.draw(&mut display)?;
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug)]
pub struct ShadedTriangle<'a, S, F = Rgb565, const RUN: usize = 64> {
    vertices: [ScreenVertex; 3],
    cull: Cull,
    shader: &'a S,
    format: PhantomData<fn() -> F>,
}

impl<S, F, const RUN: usize> Clone for ShadedTriangle<'_, S, F, RUN> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<S, F, const RUN: usize> Copy for ShadedTriangle<'_, S, F, RUN> {}

impl<'a, S> ShadedTriangle<'a, S> {
    /// Arguments as of [`draw_triangle`](crate::draw_triangle).
    ///
    /// # Errors
    ///
    /// [`RangeError`] if a vertex lies outside the guard band of ±1023½ px or a texture coordinate beyond ±8192 texels.
    pub fn new(vertices: &[ScreenVertex; 3], cull: Cull, shader: &'a S) -> Result<Self, RangeError> {
        if !vertices.iter().all(ScreenVertex::in_range) {
            return Err(RangeError);
        }
        Ok(Self { vertices: *vertices, cull, shader, format: PhantomData })
    }
}

impl<'a, S, F, const RUN: usize> ShadedTriangle<'a, S, F, RUN> {
    /// As [`PerspectiveImage::format`].
    #[must_use]
    pub fn format<G>(self) -> ShadedTriangle<'a, S, G, RUN> {
        let Self { vertices, cull, shader, .. } = self;
        ShadedTriangle { vertices, cull, shader, format: PhantomData }
    }

    /// As [`PerspectiveImage::run`].
    #[must_use]
    pub fn run<const N: usize>(self) -> ShadedTriangle<'a, S, F, N> {
        let Self { vertices, cull, shader, format } = self;
        ShadedTriangle { vertices, cull, shader, format }
    }
}

impl<F: PixelFormat, S: Shader<F>, const RUN: usize> Drawable for ShadedTriangle<'_, S, F, RUN> {
    type Color = F::Color;
    type Output = ();

    fn draw<D: DrawTarget<Color = F::Color>>(&self, target: &mut D) -> Result<(), D::Error> {
        const {
            assert!(
                matches!(S::REACH, Reach::Attributes),
                "a shader that sees more than attributes needs a band"
            )
        };
        let mut direct = Direct::<F, D, RUN>::new(target, None);
        direct.draw(self.vertices.each_ref(), self.cull, false, self.shader)
    }
}

/// Between these corners [`PerspectiveImage::between`] has no picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CornersError {
    /// A corner lies outside the guard band.
    Range,
    /// No plane picture looks so: a corner has 180° or more, sides cross, or corners coincide.
    NotConvex,
}

impl fmt::Display for CornersError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Range => write!(f, "a corner lies outside -1023.5 to 1023.5 px"),
            Self::NotConvex => write!(f, "the corners are not those of a convex quadrilateral"),
        }
    }
}

impl core::error::Error for CornersError {}
