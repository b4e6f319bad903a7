//! fixel ("fixed-point pixels") draws perspective-correct, textured, lit 3D triangles on
//! microcontrollers, in integers, into any [embedded-graphics](embedded_graphics) display.
//!
//! The [`guide`] begins at the beginning: [coordinates](guide::coordinates) with drawings, coming from
//! [other engines](guide::engines), your [model](guide::assets), [RAM](guide::memory), [light and fog](guide::surfaces),
//! [labels and touch](guide::interface), [DMA and two cores](guide::parallel), [speed](guide::speed), and what to do when
//! [something looks wrong](guide::troubleshooting).
//!
//! # The contract
//!
//! | | promise |
//! |---|---|
//! | axes | right-handed; +x right, +y up, the camera looks along −z; screen (0, 0) top left, y down, pixel centres at +½ |
//! | facing | counter-clockwise on the screen is the front; [`Cull`] leaves out backs (default), fronts, or none; a mirrored pose keeps fronts fronts, and a mirrored camera too |
//! | positions | snapped to 1/16 pixel; no vertex is rounded to whole pixels, anywhere |
//! | coverage | top-left rule, exact: of the triangles that share an edge or a vertex exactly one covers a pixel centre that lies on it. No cracks, no double pixels, also after clipping (a triangle draws a pixel where its rounded outline goes around it, once), up to the last row and column of the largest target, for every scale and every near distance; near distances below 1/256 are limited to it |
//! | perspective | [`QuarterPixel`], the default: every attribute is within ¼ pixel of exact, that is, its error divided by its largest exact change over one pixel step in x or y (or by 1 texel, or 1/255, if that is more); a colour channel is within that or one step of the format's finest channel ([`PixelFormat::COLOR_STEP`]). [`Exact`]: within 0.02. [`Affine`]: unbounded |
//! | range | no whole level of a colour leaves the range of its triangle's three vertices. A sampled texture coordinate lies in [min, max) of the corners (one that is the same at all three is floored), on every path: a wall with coordinates 0 … 64 shows texels 0 … 63 and never the opposite border. Straight surfaces (q equal at the corners, orthographic, [`Affine`]) sample infinitesimally right of the pixel's centre, then below, as in the top-left rule: a coordinate that is whole at a centre takes the side to which it changes to the right, else downwards. (A path adds its error in that direction, at most 1/8 texel where the coordinates of a texture that repeats are packed in one word, 1/24 elsewhere, and then keeps to the range; a coordinate that close to whole may take that neighbour.) So all triangles of a sprite choose alike, and no texel of a sprite drawn 1:1, mirrored or turned by 90° is doubled or missed |
//! | depth | 16-bit near/w, 1 … 65535, 0 is cleared; larger is nearer, strictly nearer wins, ties keep what was drawn first |
//! | determinism | the same bytes on every machine and for every band height |
//! | arithmetic | no float per vertex or per pixel (only in set-up conveniences); no 64-bit multiply and no divide per pixel |
//! | memory | no `alloc`, no recursion; every capacity is a constant |
//! | safety | no `unsafe`; no input panics a release build (what draws into a [`Band`] at once does not even link a panic), none writes outside the target; nothing overflows in a debug build of any target, Armv6-M included |
//! | failure | running out of a capacity is a [`CapacityError`] that names it and leaves the list as it was; bad assets, numbers out of range included, are a compile error through `const fn`s meant for `const` ([`Mesh::new`], [`Texture::new`], [`Vertex::new`], [`Vertex::uv`], [`Vertex::normal`], [`Pose::scaled_lit`]; elsewhere they panic, documented, the only exception) and a typed error through their `try_…`; cameras, [`Vec3::lit`] and everything else limit, documented, with `try_…` beside where one may want to know; targets are at most 1023 × 1023, a typed error beyond |
//!
//! # Example
//!
//! One textured triangle and a word, drawn at once into a [`Band`] that is the whole screen:
//!
//! ```
//! use fixel::embedded_graphics::mono_font::{MonoTextStyle, ascii::FONT_6X10};
//! use fixel::embedded_graphics::pixelcolor::Rgb565;
//! use fixel::embedded_graphics::{prelude::*, text::Text};
//! use fixel::prelude::*;
//!
//! static CHECKS: Texture = Texture::new(&[0xffdf, 0x4a69, 0x4a69, 0xffdf], 1, 1); // 2 × 2 texels of RGB565
//! const TRIANGLE: Mesh = Mesh::new(
//!     &[
//!         Vertex::new(-1.0, -1.0, 0.0).uv(0, 8),
//!         Vertex::new(1.0, -1.0, 0.0).uv(8, 8),
//!         Vertex::new(0.0, 1.0, 0.0).uv(4, 0),
//!     ],
//!     &[[0, 1, 2]], // counter-clockwise is the front; a bad index here does not compile
//! );
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let (mut pixels, mut depth) = ([0; 64 * 64], [0; 64 * 64]);
//! let mut band = Band::<Rgb565, Depth16>::new(Size::new(64, 64), &mut pixels, &mut depth)?;
//!
//! let camera = Camera::perspective(Turn::from_degrees(60), band.size()).at(Vec3::lit(0.0, 0.0, 2.5));
//! let pose = Pose::IDENTITY.rotated_y(Turn::from_degrees(50));
//! band.clear(Rgb565::BLACK)?; // a new picture: colours and depth
//! camera.draw(&TRIANGLE, &pose, &Material::textured(&CHECKS), &mut band);
//!
//! let gold = MonoTextStyle::new(&FONT_6X10, Rgb565::CSS_GOLD);
//! Text::new("hello", Point::new(2, 8), gold).draw(&mut band)?; // 2D on top just works
//!
//! # assert_eq!(band.depth().iter().filter(|&&depth| depth > 0).count(), 698);
//! # Ok(())
//! # }
//! ```
//!
//! What a frame takes, and how to estimate it: [`guide::cost`]; its pictures' exactness is derived in the source, where it arises.
//!
//! # How it works
//!
//! Data flows one way, and every arrow between two stages is one small struct. The folders of the source have the stages' names:
//!
//! ```text
//!  scene      a Mesh of Vertex, a Pose, a Camera, a Texture, Lights
//!    │
//!  geometry   transform ─▶ ClipVertex ─▶ clip, cut ─▶ ScreenVertex ─▶ orient, cull
//!    │
//!  raster     set-up ─▶ TriangleSetup ─▶ rows ─▶ depth
//!    │
//!  shade      Curve ─▶ fill ─▶ words of pixels
//!    │
//!  frame      a Band of rows, which goes to the display
//! ```
//!
//! - **transform** multiplies mesh positions by one matrix whose numbers share an exponent.
//! - **clip** divides by w with one reciprocal. A triangle that crosses the near plane, or a guard band far outside the screen,
//!   is cut there first. The vertices of a mesh whose bounding sphere reaches neither need no test, and half the products.
//! - **set-up** holds, for every attribute u, the integers q = near/w and (u − u₀)·q, which are linear on the screen where u
//!   itself is not.
//! - **rows** finds the first and the last covered pixel of each row exactly, from the edge functions of the triangle (signed
//!   areas: divided by the triangle's own they are the barycentric weights). There is no coverage test per pixel.
//! - **perspective** takes one division for each run of visible pixels. From there an attribute is A + B/w, and 1/w comes from a table of
//!   1024 reciprocals: at every pixel, or at every eighth where it changes little. A small triangle is drawn at one go, without any
//!   division: its attributes are linear on the screen, or one quadratic. [`guide::pixel`] tells it step by step.
//!
//! `draw` joins them. A [`DisplayList`] cuts this in two behind **geometry**: it keeps the screen vertices and the triangles that are
//! seen, each vertex transformed and lit once, and sends them through the rest as often as there are bands.
//!
//! # Transparent, cut out, in fog
//!
//! A material is a value: it says by its type what it is, and a program links the loops of what it names. `.lit()` puts it in the
//! light of the view; `.alpha(96)`, `.additive()`, `.multiply()` and `.screen_door()` lay it over what is there; `.cut_out(color)` and
//! `.masked(&mask)` leave texels out; `.depth(tests, writes)` and `.depth_bias(steps)` change what it does with depth. Lights and fog
//! belong to the view. A list takes all of it, and draws what is transparent last, from back to front:
//!
//! ```
//! # use embedded_graphics::{mock_display::MockDisplay, pixelcolor::{Rgb565, Rgb888}, prelude::*};
//! # use fixel::{prelude::*, Gradient, num::I16F16};
//! # static TEXELS: [u16; 4] = [0x07e0, 0xf81f, 0xf81f, 0x0400];
//! # static LEAVES: Texture = Texture::new(&TEXELS, 1, 1);
//! # const QUAD: Mesh = Mesh::new(
//! #     &[
//! #         Vertex::new(-1.0, 1.0, 0.0).uv(0, 0), Vertex::new(-1.0, -1.0, 0.0).uv(0, 2),
//! #         Vertex::new(1.0, -1.0, 0.0).uv(2, 2), Vertex::new(1.0, 1.0, 0.0).uv(2, 0),
//! #     ],
//! #     &[[0, 1, 2], [0, 2, 3]],
//! # );
//! # const ROOM: Mesh = QUAD;
//! # const TREE: Mesh = QUAD;
//! # const PANE: Mesh = QUAD;
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! # let mut display = MockDisplay::new();
//! # display.set_allow_overdraw(true);
//! # let camera = Camera::perspective(Turn::from_degrees(60), display.size()).at(Vec3::lit(0.0, 0.0, 2.5));
//! # let (mut pixels, mut depth) = ([0; 64 * 16], [0; 64 * 16]);
//! # let mut band = Band::<Rgb565, Depth16>::new(Size::new(64, 16), &mut pixels, &mut depth)?;
//! # let mut memory = ListMemory::<32, 16>::new();
//! # let sky = Gradient::new(Rgb888::CSS_SKY_BLUE, Rgb888::CSS_MIDNIGHT_BLUE, display.size().height);
//! # let (tree, pane) = (Pose::IDENTITY, Pose::IDENTITY.at(Vec3::lit(0.0, 0.0, 1.0)));
//! let torch = [Light::point(Vec3::lit(0.5, 0.5, 1.0), [255, 200, 120], I16F16::lit("4"))]; // made in the frame
//! let lights = Lights::new([40; 3], &torch);
//! let fog = Fog::linear(Rgb565::WHITE, I16F16::lit("2"), I16F16::lit("9")).towards(&sky);
//! let view = camera.lit_by(&lights).in_fog(&fog);
//! let mut list = DisplayList::<Rgb565, Depth16, 8>::new(&mut memory);
//! view.draw(&PANE, &pane, &Material::flat(Rgb565::CSS_SKY_BLUE).alpha(96), &mut list)?;
//! view.draw(&ROOM, &Pose::IDENTITY, &Material::gouraud().lit(), &mut list)?;
//! view.draw(&TREE, &tree, &Material::textured(&LEAVES).cut_out(Rgb565::CSS_MAGENTA), &mut list)?;
//! list.render_bands(display.size().height, &sky, &mut band, |area, band| {
//!     display.fill_contiguous(&area, band.colors())
//! })?;
//! # Ok(())
//! # }
//! ```
//!
//! # A scene bigger than RAM
//!
//! 240 × 320 pixels with depth are 300 KiB as a frame, and 15 KiB as a band of 16 rows. A [`DisplayList`] keeps what a camera drew
//! in 16 bytes a vertex and 10 a triangle, and is rendered band by band:
//!
//! ```
//! # use embedded_graphics::{mock_display::MockDisplay, pixelcolor::{Rgb565, Rgb888}, prelude::*};
//! # use fixel::{prelude::*, Gradient};
//! # const TRIANGLE: Mesh = Mesh::new(
//! #     &[Vertex::new(-1.0, -1.0, 0.0), Vertex::new(1.0, -1.0, 0.0), Vertex::new(0.0, 1.0, 0.0)],
//! #     &[[0, 1, 2]],
//! # );
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! # let mut display = MockDisplay::new();
//! # let camera = Camera::perspective(Turn::from_degrees(60), display.size()).at(Vec3::lit(0.0, 0.0, 2.5));
//! # let (mut pixels, mut depth) = ([0; 64 * 16], [0; 64 * 16]);
//! # let mut band = Band::<Rgb565, Depth16>::new(Size::new(64, 16), &mut pixels, &mut depth)?;
//! let sky = Gradient::new(Rgb888::CSS_SKY_BLUE, Rgb888::CSS_MIDNIGHT_BLUE, display.size().height);
//! let mut memory = ListMemory::<8, 4>::new(); // at most so many vertices and triangles: in a `static`, say
//! let mut list = DisplayList::<Rgb565, Depth16, 2>::new(&mut memory); // this frame's, of at most two draws
//! camera.draw(&TRIANGLE, &Pose::IDENTITY, &Material::flat(Rgb565::CSS_GOLD), &mut list)?;
//! list.render_bands(display.size().height, &sky, &mut band, |area, band| {
//!     display.fill_contiguous(&area, band.colors()) // 2D on top: draw it into `band` before
//! })?;
//! # Ok(())
//! # }
//! ```
//!
//! [`DisplayList::render_changed`] draws and sends only what changed since the last frame; without depth
//! [`DisplayList::sort_back_to_front`] settles what is in front; two cores can render two bands of one list.
//!
//! # Displays of other colours
//!
//! A band is in any of these formats: [`Rgb565`](embedded_graphics::pixelcolor::Rgb565), the fastest, `Bgr565`, both also as
//! [`BigEndian`]; `Rgb888`, `Bgr888` and `Rgb666`, three bytes a pixel in the order of the wire; and `Gray8`. Textures, flat colours and
//! fog stay RGB565: no asset has to be made anew. For a display that has fewer bits the band is dithered when it is sent. So surfaces, fog,
//! blending and text are dithered alike, and no loop of a surface knows of it:
//!
//! | display | band | what is sent |
//! |---|---|---|
//! | SSD1306, SH1106, ST7567: 1 bit in pages | `Gray8`, 8 or 16 rows | `band.dithered::<BinaryColor>().pack_pages(&mut bytes)?` |
//! | most e-paper, ST7920: 1 bit in rows | `Gray8` | `band.dithered::<BinaryColor>().pack_rows(&mut bytes)?` |
//! | Sharp's memory LCDs, bytes with the least bit first | `Gray8` | `….pack_rows_lsb_first(&mut bytes)?` |
//! | e-paper of 4 greys; SSD1322, SSD1327: 16 greys | `Gray8` | `band.dithered::<Gray2>()`, `<Gray4>()`, and `.pack_rows(…)` |
//! | 16 or 18 bits, as smooth as they go | `Rgb888` | `band.dithered::<Rgb565>()`, `<Rgb666>()` |
//! | 18 or 24 bits, as they are | `Rgb666`, `Rgb888`, `Bgr888` | `band.as_bytes()` |
//! | any of them, by a driver that is a `DrawTarget` | | `display.fill_contiguous(&area, band.dithered::<C>())` |
//!
//! ```
//! # use embedded_graphics::{pixelcolor::{BinaryColor, Gray8, Rgb565}, prelude::*};
//! # use fixel::{prelude::*, PackError};
//! # const TRIANGLE: Mesh = Mesh::new(
//! #     &[Vertex::new(-1.0, -1.0, 0.0), Vertex::new(1.0, -1.0, 0.0), Vertex::new(0.0, 1.0, 0.0)],
//! #     &[[0, 1, 2]],
//! # );
//! # fn send(_: &[u8]) {}
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! const OLED: Size = Size::new(128, 64);
//! let (mut pixels, mut depth, mut page) = ([0; 128 * 8], [0; 128 * 8], [0; 128]); // 1, 2 and ⅛ KiB
//! let mut band = Band::<Gray8, Depth16>::new(Size::new(128, 8), &mut pixels, &mut depth)?;
//! let camera = Camera::perspective(Turn::from_degrees(50), OLED).at(Vec3::lit(0.0, 0.0, 2.5));
//! let mut memory = ListMemory::<8, 4>::new();
//! let mut list = DisplayList::<Gray8, Depth16, 2>::new(&mut memory);
//! camera.draw(&TRIANGLE, &Pose::IDENTITY, &Material::flat(Rgb565::CSS_GOLD), &mut list)?;
//! list.render_bands(OLED.height, &Rgb565::BLACK, &mut band, |_, band| {
//!     send(band.dithered::<BinaryColor>().pack_pages(&mut page)?); // one page, by I2C or SPI
//!     Ok::<_, PackError>(())
//! })?;
//! # Ok(())
//! # }
//! ```
//!
//! 3D is readable in 1 bit where there is contrast: a black sky with fog that ends in it, light from one side, a light floor of few large
//! squares, textures of few large texels. `examples/displays.rs` shows one scene on five displays. [`Quantize`] makes the colours of others,
//! [`PixelFormat`] other words in memory.
//!
//! What is particular to a display is a type: [`PixelFormat`] and [`DepthFormat`] of the [`Band`]. What is
//! particular to a surface is a [`Material`], or a [`Shader`] of yours.
//!
//! [`PerspectiveImage`] and [`ShadedTriangle`] need no band: they hand their rows straight to a display.
#![no_std]
#![forbid(unsafe_code)]
#![warn(unreachable_pub)]

#[cfg(test)]
extern crate std;

mod draw;
mod frame;
mod geometry;
#[cfg(any(doc, doctest))]
pub mod guide;
mod math;
pub mod num;
mod raster;
mod scene;
mod shade;

pub use embedded_graphics;
pub use fixed;

pub use draw::{
    Air, Canvas, CapacityError, Changes, Clear, CornersError, DisplayList, Flushed, ListMemory,
    PerspectiveImage, Projected, ShadedTriangle, View, draw_triangle,
};
pub use frame::{
    Background, Band, BigEndian, BlendFormat, Depth16, DepthFormat, Gradient, NoDepth, PackError, Picture,
    PixelFormat, Quantize, Quantized, QuantizedColors, TargetError, Threshold,
};
pub use geometry::{Coloring, Cull, Inputs, RangeError, ScreenVertex, Stats};
pub use math::{Pose, Quaternion, ScaleError, Turn, Vec3};
pub use scene::{
    Aligned, AssetError, AssetKind, Camera, LensError, Light, Lighting, Lights, LightsError, Mask, MaskError,
    Mesh, MeshError, Normal, PlaneError, Texture, TextureError, Vertex, VertexError, shapes, texels,
};
pub use shade::{
    Affine, Exact, Fog, Fragment, Material, Pixels, Quality, QuarterPixel, Reach, Shader, Surface, Varying,
};

/// The kinds of [`Material`], where a type has to be named.
pub mod material {
    pub use crate::shade::{
        Additive, Clamped, ColorlessKind, CutOut, Flat, Gouraud, Kind, Layer, LayerIn, LitClamped, LitKind,
        LitMirrored, LitTextured, Masked, Mirrored, Multiply, Opaque, Over, ScreenDoor, TexelKind, Textured,
        VertexAlpha,
    };
}

/// What most programs use: `use fixel::prelude::*;`.
pub mod prelude {
    pub use crate::{
        Band, Camera, Cull, Depth16, DisplayList, Fog, Light, Lights, ListMemory, Material, Mesh, NoDepth,
        Pose, Quaternion, Surface, Texture, Turn, Vec3, Vertex, View, texels,
    };
}

/// README's code is compiled and run too.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
