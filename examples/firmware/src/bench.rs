//! The scenes by which speed and size are judged: 160×120 RGB565, a focal length of 80 pixels, the
//! camera at the origin looking along −z, near = 0.1, a 64×64 texture, backs culled.
//!
//! What they are made of is public, so that `tests/peers` can draw the same with other libraries.

use embedded_graphics::{pixelcolor::Rgb565, prelude::*};
use fixel::material::Textured;
use fixel::prelude::*;
use fixel::shapes::{self, Shape};

/// Width and height of every scene.
pub const SIZE: Size = Size::new(160, 120);
/// Pixels of a frame.
pub const PIXELS: usize = 160 * 120;

/// 64×64 texels of a brick wall with a border, so that a wrong repeat would show.
pub static TEXELS: [u16; 4096] = wall();
pub(crate) static WALL: Texture = Texture::new(&TEXELS, 6, 6);

const fn wall() -> [u16; 4096] {
    let mut texels = [0; 4096];
    let mut i = 0;
    while i < 4096 {
        let (u, v) = (i % 64, i / 64);
        let course = v / 8;
        let joint = v % 8 == 0 || (u + course % 2 * 8) % 16 == 0;
        let grain = ((u * 7 + v * 13) ^ (u * v)) % 8;
        texels[i] = if joint {
            0xbdd7
        } else {
            ((18 + grain % 4 + course % 3 * 2) << 11 | (16 + grain) << 5 | (6 + grain / 2)) as u16
        };
        i += 1;
    }
    texels
}

const QUAD: [[u16; 3]; 2] = [[0, 1, 2], [0, 2, 3]];

/// s1, in half units: mesh positions reach to ±8.
pub const FLOOR: Mesh = Mesh::new(
    &[
        Vertex::new(-2.25, -0.725, -1.0).uv(0, 0),
        Vertex::new(2.25, -0.725, -1.0).uv(64, 0),
        Vertex::new(2.25, 3.2, -8.0).uv(64, 64),
        Vertex::new(-2.25, 3.2, -8.0).uv(0, 64),
    ],
    &QUAD,
);

/// The ground, in eighths: x ±40, z +0.1 … −30, the texture 20 times across.
pub const GROUND: Mesh = Mesh::new(
    &[
        Vertex::new(-5.0, -0.125, 0.0125).uv(-640, 0),
        Vertex::new(5.0, -0.125, 0.0125).uv(640, 0),
        Vertex::new(5.0, -0.125, -3.75).uv(640, 482),
        Vertex::new(-5.0, -0.125, -3.75).uv(-640, 482),
    ],
    &QUAD,
);

const fn face(corners: [[f32; 3]; 4]) -> [Vertex; 4] {
    let mut vertices = [Vertex::new(0.0, 0.0, 0.0); 4];
    let mut i = 0;
    while i < 4 {
        let [x, y, z] = corners[i];
        vertices[i] = Vertex::new(x, y, z).uv((i == 1 || i == 2) as i16 * 64, (i < 2) as i16 * 64);
        i += 1;
    }
    vertices
}

const FACES: [[Vertex; 4]; 6] = [
    face([[-1.0, -1.0, 1.0], [1.0, -1.0, 1.0], [1.0, 1.0, 1.0], [-1.0, 1.0, 1.0]]),
    face([[1.0, -1.0, -1.0], [-1.0, -1.0, -1.0], [-1.0, 1.0, -1.0], [1.0, 1.0, -1.0]]),
    face([[1.0, -1.0, 1.0], [1.0, -1.0, -1.0], [1.0, 1.0, -1.0], [1.0, 1.0, 1.0]]),
    face([[-1.0, -1.0, -1.0], [-1.0, -1.0, 1.0], [-1.0, 1.0, 1.0], [-1.0, 1.0, -1.0]]),
    face([[-1.0, 1.0, 1.0], [1.0, 1.0, 1.0], [1.0, 1.0, -1.0], [-1.0, 1.0, -1.0]]),
    face([[-1.0, -1.0, -1.0], [1.0, -1.0, -1.0], [1.0, -1.0, 1.0], [-1.0, -1.0, 1.0]]),
];

const fn cube_triangles() -> [[u16; 3]; 12] {
    let mut triangles = [[0; 3]; 12];
    let mut face = 0;
    while face < 6 {
        let first = face * 4;
        triangles[face as usize * 2] = [first, first + 1, first + 2];
        triangles[face as usize * 2 + 1] = [first, first + 2, first + 3];
        face += 1;
    }
    triangles
}

/// s2: ±1, each face the whole texture.
pub const CUBE: Mesh = Mesh::new(FACES.as_flattened(), &cube_triangles());

/// The camera of all scenes but the ground's.
pub const CAMERA: Camera = Camera::focal(80.0, SIZE).near(0.1);
/// The ground's, pitched down 9.8°.
pub const GROUND_CAMERA: Camera =
    CAMERA.pose(Pose::IDENTITY.rotated_x(Turn::from_raw(1784u16.wrapping_neg())));
/// Where the ground lies.
pub const GROUND_POSE: Pose = Pose::IDENTITY.scaled_lit(8.0);
/// How the cube stands.
pub const S2: Pose = Pose::IDENTITY
    .rotated_x(Turn::from_degrees(-30))
    .rotated_y(Turn::from_degrees(-40))
    .at(Vec3::lit(0.0, 0.0, -2.62));

static TORUS: Shape<500, 1000> = shapes::torus(1.0, 0.45, 25, 20);
static TEXTURED_TORUS: Shape<546, 1000> = shapes::torus_textured(1.0, 0.45, 25, 20, [256, 64]);
/// s3's torus, checked once, by the compiler.
pub static TORUS_MESH: Mesh = TORUS.mesh();
/// s3_tex's torus.
pub static TEXTURED_TORUS_MESH: Mesh = TEXTURED_TORUS.mesh();
/// How the torus stands.
pub const S3: Pose = Pose::IDENTITY
    .rotated_x(Turn::from_degrees(-50))
    .rotated_y(Turn::from_degrees(-25))
    .at(Vec3::lit(0.0, 0.0, -2.44));
/// Where the sun shines to.
pub const SUN_DIRECTION: Vec3 = Vec3::lit(-0.4, -0.6, -0.7);
/// What arrives from it where a surface faces it.
pub const SUN_COLOR: [u8; 3] = [208; 3];
/// What arrives everywhere.
pub const AMBIENT: [u8; 3] = [40; 3];
static SUN: [Light; 1] = [Light::directional(SUN_DIRECTION, SUN_COLOR)];
pub(crate) static LIGHTS: Lights = Lights::new(AMBIENT, &SUN);

static BRICKS: Material<Textured> = Material::textured(&WALL);

/// A frame without depth.
pub type Flat<'a> = Band<'a, Rgb565, NoDepth>;
/// A frame with depth.
pub type Deep<'a> = Band<'a, Rgb565, Depth16>;

/// Where the floor lies, turned about the view axis.
#[must_use]
pub const fn floor_pose(roll: Turn) -> Pose {
    Pose::IDENTITY.rotated_z(roll).scaled_lit(2.0)
}

/// s1: the floor, turned about the view axis.
#[inline(always)]
pub fn s1(roll: Turn, frame: &mut Flat<'_>) {
    CAMERA.draw(&FLOOR, &floor_pose(roll), &BRICKS, frame);
}

/// s1_ground: the ground of a game, clipped by the near plane and beyond every edge of the screen.
#[inline(always)]
pub fn s1_ground(frame: &mut Flat<'_>) {
    GROUND_CAMERA.draw(&GROUND, &GROUND_POSE, &BRICKS, frame);
}

/// s2: the cube.
#[inline(always)]
pub fn s2(frame: &mut Deep<'_>) {
    CAMERA.draw(&CUBE, &S2, &BRICKS, frame);
}

/// s3: the torus, Gouraud shaded.
#[inline(always)]
pub fn s3(frame: &mut Deep<'_>) {
    CAMERA.lit_by(&LIGHTS).draw(&TORUS_MESH, &S3, &Material::gouraud().lit(), frame);
}

/// s3_tex: the same, its light on a texture.
#[inline(always)]
pub fn s3_tex(frame: &mut Deep<'_>) {
    CAMERA.lit_by(&LIGHTS).draw(&TEXTURED_TORUS_MESH, &S3, &Material::textured(&WALL).lit(), frame);
}

/// Pixels that s1 covers.
pub const S1_PIXELS: u32 = 12_510;
/// Pixels that s1_roll30 covers.
pub const S1_ROLL30_PIXELS: u32 = 11_366;
/// Pixels that s1_roll90 covers.
pub const S1_ROLL90_PIXELS: u32 = 9_996;
/// Pixels that s1_ground covers.
pub const S1_GROUND_PIXELS: u32 = 11_360;
/// Pixels that s2 covers.
pub const S2_PIXELS: u32 = 6_744;
/// Pixels that s3 and s3_tex cover.
pub const S3_PIXELS: u32 = 6_826;

/// Bytes of the meshes and the texture of s1, and of those of all scenes: what of a program's flash is no code.
#[must_use]
pub fn data_bytes() -> [usize; 2] {
    let texture = size_of_val(&TEXELS);
    let [s1, others @ ..] = [&FLOOR, &GROUND, &CUBE, &TORUS_MESH, &TEXTURED_TORUS_MESH]
        .map(|mesh| size_of_val(mesh.vertices()) + mesh.triangles().len() * size_of::<[u16; 3]>());
    [texture + s1, texture + s1 + others.iter().sum::<usize>()]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Pixels that a scene covers, counted where it changes one of two grounds.
    fn covered(scene: impl Fn(&mut Flat<'_>)) -> u32 {
        let grounds = [0, 0xffff].map(|ground| {
            let mut pixels = vec![ground; PIXELS];
            scene(&mut Band::new(SIZE, &mut pixels, &mut [(); PIXELS]).expect("the size fits"));
            pixels
        });
        grounds[0].iter().zip(&grounds[1]).filter(|(a, b)| a == b).count() as u32
    }

    fn covered_deep(scene: impl Fn(&mut Deep<'_>)) -> u32 {
        let (mut pixels, mut depth) = (vec![0; PIXELS], vec![0; PIXELS]);
        scene(&mut Band::new(SIZE, &mut pixels, &mut depth).expect("the size fits"));
        depth.iter().filter(|&&depth| depth != 0).count() as u32
    }

    #[test]
    fn the_scenes_cover_what_bench_returns() {
        assert_eq!(
            [
                covered(|frame| s1(Turn::ZERO, frame)),
                covered(|frame| s1(Turn::from_degrees(30), frame)),
                covered(|frame| s1(Turn::from_degrees(90), frame)),
                covered(s1_ground),
                covered_deep(s2),
                covered_deep(s3),
                covered_deep(s3_tex),
            ],
            [
                S1_PIXELS,
                S1_ROLL30_PIXELS,
                S1_ROLL90_PIXELS,
                S1_GROUND_PIXELS,
                S2_PIXELS,
                S3_PIXELS,
                S3_PIXELS
            ]
        );
    }
}
