//! Random scenes of several meshes, poses, cameras and materials.

use fixel::embedded_graphics::prelude::*;
use fixel::fixed::types::{I2F14, I16F16, U10F22};
use fixel::material::Kind;
use fixel::shapes::{self, Shape};
use fixel::{
    Camera, Canvas, Cull, DepthFormat, Light, Lights, Material, Mesh, PixelFormat, Pose, Quality, Surface,
    Texture, Turn, Vec3, Vertex,
};
use proptest::prelude::*;
use std::marker::PhantomData;

static TORUS: Shape<63, 96> = shapes::torus_textured(1.0, 0.45, 8, 6, [256, 64]);
static BALL: Shape<12, 20> = shapes::icosphere(0.8, 1);

/// Larger than the world of a camera at the origin: it is cut at the near plane and at the guard band.
static GROUND: [Vertex; 4] = [
    Vertex::new(-5.0, -0.125, 0.1).uv(-640, 0).color(200, 10, 10),
    Vertex::new(5.0, -0.125, 0.1).uv(640, 0).color(10, 200, 10),
    Vertex::new(5.0, -0.125, -3.75).uv(640, 482).color(10, 10, 200),
    Vertex::new(-5.0, -0.125, -3.75).uv(-640, 482),
];

/// How many meshes there are. The last is the ground.
pub(crate) const MESHES: usize = 4;

/// The meshes of all scenes.
pub(crate) fn meshes() -> [Mesh<'static>; MESHES] {
    let torus = TORUS.mesh();
    let ground = Mesh::try_new(&GROUND, &[[0, 1, 2], [0, 2, 3]]).expect("the indices are in range");
    [torus, torus.part(30, 55), BALL.mesh(), ground]
}

/// The texture of all scenes: each texel differs from its neighbours.
pub(crate) static TEXELS: [u16; 256] = {
    let mut texels = [0; 256];
    let mut i = 0;
    while i < 256 {
        texels[i] = (i as u16).wrapping_mul(40_503) ^ 0x5555;
        i += 1;
    }
    texels
};
static SUN: [Light; 2] = [
    Light::directional(Vec3::lit(-0.4, -0.6, -0.7), [208, 190, 150]),
    Light::point(Vec3::lit(1.0, 1.0, -1.0), [90, 20, 200], I16F16::lit("3")),
];
/// The lights of all scenes.
pub(crate) static LIGHTS: Lights = Lights::new([30, 40, 50], &SUN);

/// How many materials there are.
pub(crate) const MATERIALS: usize = 8;

/// What makes one thing of a material of any kind.
pub(crate) trait Maker {
    type Made;
    fn make<K: Kind>(&self, material: Material<'static, K>) -> Self::Made;
}

/// What is made of the materials, of which there is one in each way to draw.
pub(crate) fn of_materials<M: Maker>(maker: &M) -> [M::Made; MATERIALS] {
    let texture = Texture::new(&TEXELS, 4, 4);
    let textured = Material::textured(&texture);
    [
        maker.make(Material::flat(fixel::embedded_graphics::pixelcolor::Rgb565::CSS_GOLD)),
        maker.make(textured.cull(Cull::None)),
        maker.make(Material::gouraud()),
        maker.make(Material::gouraud().lit()),
        maker.make(textured.lit()),
        maker.make(textured.texture_scale(1).lit().faceted().two_sided()),
        maker.make(Material::flat(fixel::embedded_graphics::pixelcolor::Rgb565::CSS_TEAL).lit().faceted()),
        maker.make(textured),
    ]
}

/// A surface of each material, in a quality.
pub(crate) type Surfaces<F, D> = [Surface<'static, F, D>; MATERIALS];

struct InQuality<Q, F, D>(PhantomData<(Q, F, D)>);

impl<Q: Quality, F: PixelFormat, D: DepthFormat> Maker for InQuality<Q, F, D> {
    type Made = Surface<'static, F, D>;

    fn make<K: Kind>(&self, material: Material<'static, K>) -> Surface<'static, F, D> {
        (&material.quality::<Q>()).into()
    }
}

pub(crate) fn surfaces<Q: Quality, F: PixelFormat, D: DepthFormat>() -> Surfaces<F, D> {
    of_materials(&InQuality::<Q, F, D>(PhantomData))
}

/// One call of `Camera::draw`, by numbers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Draw {
    pub(crate) mesh: usize,
    pub(crate) material: usize,
    pub(crate) pose: Pose,
    /// Whether in a viewport that is a part of the screen.
    pub(crate) inset: bool,
    pub(crate) orthographic: bool,
}

impl Draw {
    pub(crate) fn camera(&self, screen: Size) -> Camera {
        let size = if self.inset { screen / 2 } else { screen };
        let focal = size.width.max(8) as f32 / 2.0;
        let camera = if self.orthographic {
            Camera::orthographic(focal / 2.0, size)
        } else {
            Camera::focal(focal, size).near(0.1)
        };
        camera.viewport(if self.inset { Point::new(3, 5) } else { Point::zero() })
    }

    /// Into a list or a band.
    pub(crate) fn draw<'a, C: Canvas<'a>>(
        &self,
        screen: Size,
        surfaces: &Surfaces<C::Format, C::Depth>,
        canvas: &mut C,
    ) -> C::Output {
        let (camera, mesh) = (self.camera(screen), &meshes()[self.mesh]);
        camera.lit_by(&LIGHTS).draw(mesh, &self.pose, surfaces[self.material], canvas)
    }
}

/// Somewhere before or around the eye.
pub(crate) fn draw() -> impl Strategy<Value = Draw> {
    let turns = any::<[u16; 3]>();
    // Some are mirrored, some stretched.
    let scale = || prop_oneof![2 => Just(U10F22::ONE), 1 => (0.3..2.0_f64).prop_map(U10F22::from_num)];
    let scales = prop_oneof![2 => Just([U10F22::ONE; 3]).boxed(), 1 => [scale(), scale(), scale()].boxed()];
    let shape = (scales, prop::option::weighted(0.2, 0..3_usize));
    let place = ([-30..30_i16, -20..20_i16], -60..-5_i16);
    let kind = (prop_oneof![4 => Just(false), 1 => Just(true)], 0..5_u8);
    (0..4_usize, 0..MATERIALS, turns, place, shape, kind).prop_map(
        |(mesh, material, [x, y, z], ([right, up], away), (scales, mirror), (inset, kind))| {
            let at = |tenths: i16| I16F16::from_num(tenths) / 10;
            let turn = Turn::from_raw;
            let mut turned = Pose::IDENTITY.stretched(scales);
            if let Some(axis) = mirror {
                turned.rotation[axis][axis] = -I2F14::ONE;
            }
            let turned = turned.rotated_x(turn(x)).rotated_y(turn(y)).rotated_z(turn(z));
            // The ground stays level, and is larger.
            let turned = if mesh == 3 { Pose::IDENTITY.rotated_y(turn(y)).scaled_lit(8.0) } else { turned };
            let place = if mesh == 3 {
                Vec3::new(at(0), at(up / 10), at(0))
            } else {
                Vec3::new(at(right), at(up), at(away))
            };
            Draw { mesh, material, pose: turned.at(place), inset, orthographic: kind == 0 && mesh != 3 }
        },
    )
}

/// Some draws.
pub(crate) fn scene(most: usize) -> impl Strategy<Value = Vec<Draw>> {
    prop::collection::vec(draw(), 0..=most)
}
