//! euc: shaders over f32, perspective-correct at every pixel of a triangle's bounding box.

use crate::library::{Library, Painter};
use crate::model::{FLAT, HEIGHT, Light, Model, TEXTURE, WIDTH, project};
use crate::scene::{Scene, Surface};
use ::euc::buffer::Buffer2d;
use ::euc::rasterizer::Triangles;
use ::euc::{DepthStrategy, Interpolate, Pipeline, Target};
use fixel_firmware::bench;
use std::marker::PhantomData;
use vek::{Rgb, Vec2};

#[derive(Debug)]
pub(super) struct Euc;

impl Library for Euc {
    fn name(&self) -> &'static str {
        "euc"
    }

    fn version(&self) -> &'static str {
        "0.5.3"
    }

    fn difference(&self) -> Option<&'static str> {
        Some(
            "f32, depth too; no index buffer: each corner of each triangle runs the vertex shader; no clipping at \
             the near plane; a pixel centre on a shared edge is drawn twice; its `mul_add` is a call unless \
             compiled for FMA (`RUSTFLAGS=-Ctarget-cpu=native`)",
        )
    }

    fn painter(&self, scene: &Scene) -> Result<Box<dyn Painter>, &'static str> {
        if scene.crosses_near_plane {
            return Err("nothing is clipped at the near plane");
        }
        Ok(match scene.surface {
            Surface::Textured => Box::new(Canvas::<Textured>::new(scene)),
            Surface::Lit => Box::new(Canvas::<Lit>::new(scene)),
            Surface::TexturedLit => Box::new(Canvas::<TexturedLit>::new(scene)),
            Surface::Flat => Box::new(Canvas::<Flat>::new(scene)),
        })
    }
}

/// What a vertex passes on, and the colour that a pixel makes of it.
trait Shading {
    type Varying: Clone + Interpolate;

    fn vertex(model: &Model, light: &Light, index: usize) -> Self::Varying;

    fn pixel(varying: &Self::Varying) -> u16;
}

struct Textured;
struct Lit;
struct TexturedLit;
struct Flat;

impl Shading for Textured {
    type Varying = Vec2<f32>;

    #[inline(always)]
    fn vertex(model: &Model, _: &Light, index: usize) -> Vec2<f32> {
        model.uvs[index].into()
    }

    #[inline(always)]
    fn pixel(uv: &Vec2<f32>) -> u16 {
        texel(uv)
    }
}

impl Shading for Lit {
    type Varying = Rgb<f32>;

    #[inline(always)]
    fn vertex(model: &Model, light: &Light, index: usize) -> Rgb<f32> {
        Rgb::broadcast(light.at(model.normals[index]))
    }

    #[inline(always)]
    fn pixel(light: &Rgb<f32>) -> u16 {
        word((light.r * 31.99) as u16, (light.g * 63.99) as u16, (light.b * 31.99) as u16)
    }
}

impl Shading for TexturedLit {
    type Varying = (Rgb<f32>, Vec2<f32>);

    #[inline(always)]
    fn vertex(model: &Model, light: &Light, index: usize) -> Self::Varying {
        (Lit::vertex(model, light, index), Textured::vertex(model, light, index))
    }

    #[inline(always)]
    fn pixel((light, uv): &Self::Varying) -> u16 {
        let texel = texel(uv);
        let times = |channel: u16, light: f32| (f32::from(channel) * light) as u16;
        word(times(texel >> 11, light.r), times(texel >> 5 & 63, light.g), times(texel & 31, light.b))
    }
}

impl Shading for Flat {
    type Varying = ();

    #[inline(always)]
    fn vertex(_: &Model, _: &Light, _: usize) {}

    #[inline(always)]
    fn pixel((): &()) -> u16 {
        FLAT
    }
}

#[inline(always)]
fn texel(uv: &Vec2<f32>) -> u16 {
    // What is sampled is never negative: the one scene with such coordinates is not drawn.
    let (u, v) = (uv.x as usize % TEXTURE, uv.y as usize % TEXTURE);
    bench::TEXELS[v * TEXTURE + u]
}

#[inline(always)]
fn word(red: u16, green: u16, blue: u16) -> u16 {
    red << 11 | green << 5 | blue
}

struct Canvas<S> {
    scene: DrawCall<S>,
    /// The corners of all triangles, as indices.
    corners: Vec<usize>,
    color: Buffer2d<u16>,
    depth: Option<Buffer2d<f32>>,
}

impl<S: Shading> Canvas<S> {
    fn new(scene: &Scene) -> Self {
        let model = Model::new(scene);
        let size = [WIDTH, HEIGHT];
        Self {
            corners: model.faces().into_flattened(),
            color: Buffer2d::new(size, 0),
            depth: scene.depth.then(|| Buffer2d::new(size, 1.0)),
            scene: DrawCall {
                to_clip: model.to_clip(),
                light: Light::new().in_mesh_space(&model.to_eye),
                depth: scene.depth,
                model,
                shading: PhantomData,
            },
        }
    }
}

impl<S: Shading> Painter for Canvas<S> {
    fn clear(&mut self, ground: u16) {
        self.color.clear(ground);
        if let Some(depth) = &mut self.depth {
            depth.clear(1.0);
        }
    }

    fn draw(&mut self) {
        self.scene.draw::<Triangles<'_, Buffer2d<f32>>, _>(
            &self.corners,
            &mut self.color,
            self.depth.as_mut(),
        );
    }

    fn words(&self) -> Vec<u16> {
        self.color.as_ref().to_vec()
    }
}

/// What does not change during a draw call.
struct DrawCall<S> {
    model: Model,
    to_clip: [[f32; 4]; 4],
    light: Light,
    depth: bool,
    shading: PhantomData<S>,
}

impl<S: Shading> Pipeline for DrawCall<S> {
    type Vertex = usize;
    type VsOut = S::Varying;
    type Pixel = u16;

    #[inline(always)]
    fn vert(&self, &index: &usize) -> ([f32; 4], S::Varying) {
        (project(&self.to_clip, self.model.positions[index]), S::vertex(&self.model, &self.light, index))
    }

    #[inline(always)]
    fn frag(&self, varying: &S::Varying) -> u16 {
        S::pixel(varying)
    }

    fn get_depth_strategy(&self) -> DepthStrategy {
        if self.depth { DepthStrategy::IfLessWrite } else { DepthStrategy::None }
    }
}
