//! Scenes of one kind of work each, in two sizes: what a draw call, a vertex, a triangle, a row and a pixel cost follows
//! from differences of their counts. What is drawn is chosen by numbers, so that a counter can name it.

use crate::bench::{CAMERA, Flat, LIGHTS, WALL};
use embedded_graphics::{pixelcolor::Rgb565, prelude::*};
use fixel::material::Kind;
use fixel::num::{I12F4, I16F16};
use fixel::{Affine, DepthFormat, Exact, Fog, Mask, Quality, QuarterPixel, Surface, prelude::*};

/// A surface by its number: flat, Gouraud, textured (repeated), textured (clamped), textured × light, Gouraud × light,
/// textured (mirrored), textured (clamped) × light, white in white light.
/// Sides turned to where `cull` says are left out.
fn surface<D: DepthFormat, Q: Quality>(number: u32, cull: Cull) -> Surface<'static, Rgb565, D> {
    fn of<D: DepthFormat, Q: Quality>(
        material: Material<'static, impl Kind>,
        cull: Cull,
    ) -> Surface<'static, Rgb565, D> {
        material.quality::<Q>().cull(cull).surface()
    }
    match number {
        0 => of::<D, Q>(Material::flat(Rgb565::CSS_TOMATO), cull),
        1 => of::<D, Q>(Material::gouraud(), cull),
        2 => of::<D, Q>(Material::textured(&WALL), cull),
        3 => of::<D, Q>(Material::clamped(&WALL), cull),
        4 => of::<D, Q>(Material::textured(&WALL).lit(), cull),
        5 => of::<D, Q>(Material::gouraud().lit(), cull),
        6 => of::<D, Q>(Material::mirrored(&WALL), cull),
        7 => of::<D, Q>(Material::clamped(&WALL).lit(), cull),
        _ => of::<D, Q>(Material::flat(Rgb565::WHITE).lit(), cull),
    }
}

/// A surface that is laid over what is there, or leaves pixels out, by its number: of one colour with alpha, added, multiplied,
/// with its vertices' alpha; textured with alpha, × light with alpha, by a screen door, cut out by colour and by a mask.
fn layered<D: DepthFormat>(number: u32) -> Surface<'static, Rgb565, D> {
    let (flat, textured) = (Material::flat(Rgb565::CSS_TOMATO), Material::textured(&WALL));
    match number {
        0 => flat.alpha(96).surface(),
        1 => flat.additive().surface(),
        2 => flat.multiply().surface(),
        3 => flat.vertex_alpha().surface(),
        4 => textured.alpha(96).surface(),
        5 => textured.lit().alpha(96).surface(),
        6 => textured.alpha(96).screen_door().surface(),
        // No texel has the colour, and all are in the mask: all are drawn.
        7 => textured.cut_out(Rgb565::CSS_MAGENTA).surface(),
        _ => textured.masked(&ALL).surface(),
    }
}

static ALL: Mask = Mask::new(&[0xff], 3, 0);
/// Most of it lies where the rectangles are.
static FOG: Fog = Fog::linear(Rgb565::WHITE, I16F16::lit("0.25"), I16F16::lit("4"));

/// Three corners with everything that a surface may ask for; x and y are pixels at focal length 80, before the distance w.
/// Its texture is `texels` wide and high.
const fn triangle(corners: [[f32; 3]; 3], texels: [i16; 2]) -> [Vertex; 3] {
    let [a, b, c] = corners;
    let [width, height] = texels;
    [
        corner(a).uv(-2, 34).color(255, 64, 64).normal(0.0, 0.0, 1.0),
        corner(b).uv(width - 2, 34).color(64, 255, 64).normal(0.6, 0.0, 0.8),
        corner(c).uv(-2, 34 - height).color(64, 64, 255).normal(0.0, 0.6, 0.8),
    ]
}

/// The texture of a large triangle: half a texel a pixel.
const LARGE: [i16; 2] = [136, 72];

#[expect(clippy::float_arithmetic, reason = "in constants only")]
const fn corner([x, y, w]: [f32; 3]) -> Vertex {
    Vertex::new(x * w / 80.0, y * w / 80.0, -w)
}

/// A triangle that hides all of a rectangle of 128×64, seen straight on: the viewport cuts it to one span a row.
const STRAIGHT: Mesh = Mesh::new(
    &triangle([[-68.0, -36.0, 1.0], [204.0, -36.0, 1.0], [-68.0, 108.0, 1.0]], LARGE),
    &[[0, 1, 2]],
);
/// The same on the screen, seven times as far away at the top as at the bottom: a floor seen level.
const FLOOR: Mesh = Mesh::new(
    &triangle([[-68.0, -36.0, 0.5], [204.0, -36.0, 0.5], [-68.0, 108.0, 3.5]], LARGE),
    &[[0, 1, 2]],
);
/// The same, seven times as far away at the left as at the right: a wall seen along.
const WALL_ALONG: Mesh = Mesh::new(
    &triangle([[-68.0, -36.0, 3.5], [204.0, -36.0, 0.5], [-68.0, 108.0, 3.5]], LARGE),
    &[[0, 1, 2]],
);

/// Width and height of the rectangles by their shape: bit 0 for wide, bit 1 for high. None is so narrow that a loop for
/// short rows would be worth its while.
#[must_use]
pub const fn size(shape: u32) -> Size {
    Size::new(if shape & 1 == 0 { 32 } else { 128 }, if shape & 2 == 0 { 8 } else { 64 })
}

/// A rectangle in a quality: affine, default, exact. Bits 2 and 3 of the shape are for its slope: none, a floor, a wall. Bits 4
/// and 5 say which quarter of the wide rectangle a narrow one shows: four of them are the same pixels in four times as
/// many rows.
#[inline(always)]
pub fn rectangle<D: DepthFormat>(surface: u32, quality: u32, shape: u32, frame: &mut Band<'_, Rgb565, D>) {
    let surface = match quality {
        0 => self::surface::<D, Affine>(surface, Cull::Back),
        1 => self::surface::<D, QuarterPixel>(surface, Cull::Back),
        _ => self::surface::<D, Exact>(surface, Cull::Back),
    };
    let (camera, mesh) = view(shape);
    camera.lit_by(&LIGHTS).draw(&mesh, &Pose::IDENTITY, surface, frame);
}

/// A [`rectangle`] with a [surface that is not opaque](layered), or, from number 16 on, with an opaque one in fog.
#[inline(always)]
pub fn layered_rectangle<D: DepthFormat>(number: u32, shape: u32, frame: &mut Band<'_, Rgb565, D>) {
    let (camera, mesh) = view(shape);
    if number < 16 {
        camera.lit_by(&LIGHTS).draw(&mesh, &Pose::IDENTITY, layered::<D>(number), frame);
    } else {
        let surface = self::surface::<D, QuarterPixel>(number - 16, Cull::Back);
        camera.lit_by(&LIGHTS).in_fog(&FOG).draw(&mesh, &Pose::IDENTITY, surface, frame);
    }
}

/// What sees a rectangle, and the triangle that fills it.
fn view(shape: u32) -> (Camera, Mesh<'static>) {
    let mesh = match shape >> 2 & 3 {
        0 => STRAIGHT,
        1 => FLOOR,
        _ => WALL_ALONG,
    };
    let left = if shape & 1 == 0 { (shape >> 4 & 3) as i16 * 32 } else { 0 };
    let size = size(shape);
    let middle = I12F4::from_num(64 - size.width as i16 / 2 - left);
    let camera = Camera::focal(80.0, size).near(0.1).viewport(Point::new(16 + i32::from(left), 24));
    (camera.off_axis(middle, I12F4::ZERO), mesh)
}

/// A triangle of one pixel, and one of 6 rows with 21 pixels: neither is seen straight on.
const PIXEL: [Vertex; 3] = triangle([[0.1, -0.9, 1.0], [1.1, -0.9, 1.01], [0.1, 0.2, 1.01]], [2, 2]);
const SMALL: [Vertex; 3] = triangle([[0.1, -5.9, 1.0], [6.9, -5.9, 1.03], [0.1, 0.9, 1.03]], [14, 14]);

/// How many triangles the meshes have.
pub const FEW: usize = 8;
/// See [`FEW`].
pub const MANY: usize = 64;

/// The same corners again and again, for triangles that share no vertex.
const fn apart<const V: usize>(corners: &[Vertex; 3]) -> [Vertex; V] {
    let mut vertices = [corners[0]; V];
    let mut i = 0;
    while i < V {
        vertices[i] = corners[i % 3];
        i += 1;
    }
    vertices
}

const fn one_by_one<const T: usize>() -> [[u16; 3]; T] {
    let mut triangles = [[0; 3]; T];
    let mut i = 0;
    while i < T {
        let first = i as u16 * 3;
        triangles[i] = [first, first + 1, first + 2];
        i += 1;
    }
    triangles
}

/// Few and many triangles on the same three vertices, and on three vertices each.
static SHARED: [Mesh; 2] = [Mesh::new(&PIXEL, &[[0, 1, 2]; FEW]), Mesh::new(&PIXEL, &[[0, 1, 2]; MANY])];
static APART: [Mesh; 2] = [
    Mesh::new(&apart::<{ 3 * FEW }>(&PIXEL), &one_by_one::<FEW>()),
    Mesh::new(&apart::<{ 3 * MANY }>(&PIXEL), &one_by_one::<MANY>()),
];
static SMALL_SHARED: [Mesh; 2] =
    [Mesh::new(&SMALL, &[[0, 1, 2]; FEW]), Mesh::new(&SMALL, &[[0, 1, 2]; MANY])];

/// Few (0) or many (1) triangles of a kind: 0 out of sight; 1 culled, on shared vertices; 2 culled, each on its own;
/// 3 and 4 the same, drawn, of one pixel; 5 drawn, small, on shared vertices. Other kinds draw nothing.
fn of_kind(kind: u32, many: u32) -> Option<(&'static Mesh<'static>, Pose, Cull)> {
    let many = usize::from(many != 0);
    let behind = Pose::IDENTITY.at(Vec3::lit(0.0, 0.0, 5.0));
    Some(match kind {
        0 => (&SHARED[many], behind, Cull::Back),
        1 => (&SHARED[many], Pose::IDENTITY, Cull::Front),
        2 => (&APART[many], Pose::IDENTITY, Cull::Front),
        3 => (&SHARED[many], Pose::IDENTITY, Cull::Back),
        4 => (&APART[many], Pose::IDENTITY, Cull::Back),
        5 => (&SMALL_SHARED[many], Pose::IDENTITY, Cull::Back),
        _ => return None,
    })
}

/// Triangles of a kind, in the default quality.
#[inline(always)]
pub fn triangles(kind: u32, many: u32, surface: u32, frame: &mut Flat<'_>) {
    if let Some((mesh, pose, cull)) = of_kind(kind, many) {
        let surface = self::surface::<_, QuarterPixel>(surface, cull);
        CAMERA.lit_by(&LIGHTS).draw(mesh, &pose, surface, frame);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bench::{Deep, PIXELS, SIZE};
    use fixel::Stats;

    #[test]
    fn rectangles_cover_what_their_shape_says() {
        for (surface, quality, shape) in (0..9 * 3 * 64).map(|i| (i % 9, i / 9 % 3, i / 27)) {
            let (mut pixels, mut depth) = (vec![0; PIXELS], vec![0; PIXELS]);
            let mut frame = Deep::new(SIZE, &mut pixels, &mut depth).expect("the size fits");
            rectangle(surface, quality, shape, &mut frame);
            let Size { width, height } = size(shape);
            let covered = |drawn: &[u16]| drawn.iter().filter(|&&word| word != 0).count() as u32;
            assert_eq!(
                [covered(&depth), covered(&pixels)],
                [width * height; 2],
                "{surface} {quality} {shape}"
            );
        }
    }

    #[test]
    fn triangles_are_culled_or_drawn_as_their_kind_says() {
        for (many, count) in [(0, FEW as u32), (1, MANY as u32)] {
            let none = Stats { meshes: 1, ..Stats::default() };
            let seen = Stats { triangles: count, ..none };
            for (kind, expected, covered) in [
                (0, Stats { meshes_out_of_sight: 1, ..none }, 0),
                (1, Stats { culled: count, ..seen }, 0),
                (2, Stats { culled: count, ..seen }, 0),
                (3, Stats { drawn: count, ..seen }, 1),
                (4, Stats { drawn: count, ..seen }, 1),
                (5, Stats { drawn: count, ..seen }, 21),
            ] {
                let mut pixels = vec![0; PIXELS];
                let mut no_depth = [(); PIXELS];
                let mut frame = Flat::new(SIZE, &mut pixels, &mut no_depth).expect("the size fits");
                let (mesh, pose, cull) = of_kind(kind, many).expect("the kind draws");
                let mut stats = Stats::default();
                CAMERA.draw_counted(mesh, &pose, &Material::gouraud().cull(cull), &mut frame, &mut stats);
                // How often a shared vertex is transformed is the library's own affair.
                assert_eq!(Stats { transformed: 0, ..stats }, expected, "kind {kind}");
                assert_eq!(pixels.iter().filter(|&&pixel| pixel != 0).count(), covered, "kind {kind}");
            }
        }
    }
}
