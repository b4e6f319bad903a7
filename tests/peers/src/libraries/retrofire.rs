//! retrofire-core: shaders over f32, perspective-correct at every pixel, clipped at the whole frustum.

use crate::library::{Library, Painter};
use crate::model::{FAR, FLAT, FOCAL, HEIGHT, Light, Model, NEAR, TEXTURE, WIDTH};
use crate::scene::{Scene, Surface};
use fixel_firmware::bench;
use retrofire_core::geom::{Tri, Vertex, Vertex3, vertex};
use retrofire_core::math::color::gray;
use retrofire_core::math::mat::{Mat4, ProjMat3, perspective, viewport};
use retrofire_core::math::{Color3, Color3f, ProjVec3, Vary, pt2, pt3, rgb};
use retrofire_core::render::ctx::FaceCull;
use retrofire_core::render::shader::{self, FragmentShader, Shader, VertexShader};
use retrofire_core::render::tex::SamplerRepeatPot;
use retrofire_core::render::{
    Colorbuf, Context, Frag, Framebuf, Model as MeshSpace, TexCoord, Texture, View, render, uv,
};
use retrofire_core::util::pixfmt::Rgb565;
use retrofire_core::util::{Buf2, Dims};

#[derive(Debug)]
pub(super) struct Retrofire;

impl Library for Retrofire {
    fn name(&self) -> &'static str {
        "retrofire-core"
    }

    fn version(&self) -> &'static str {
        "0.4"
    }

    fn difference(&self) -> Option<&'static str> {
        Some(
            "f32, depth too; allocates in every draw call; colours are not perspective-correct; a shader's colour \
             has 8 bits a channel and is converted to RGB565 when it is written; its `floor` is a call unless \
             compiled for SSE4.1 (`RUSTFLAGS=-Ctarget-cpu=native`)",
        )
    }

    fn painter(&self, scene: &Scene) -> Result<Box<dyn Painter>, &'static str> {
        let model = Model::new(scene);
        let light = Light::new().in_mesh_space(&model.to_eye);
        let to_clip = to_clip(&model);
        let texture = texture();
        let repeat = SamplerRepeatPot::new(&texture);
        Ok(match scene.surface {
            Surface::Textured => {
                let shader = shader::new(
                    move |v: Vertex3<TexCoord>, ()| vertex(to_clip.apply(&v.pos), v.attrib),
                    move |frag: Frag<TexCoord>, ()| repeat.sample_abs(&texture, frag.var).to_rgba(),
                );
                painter(scene, &model, shader, |i| uv(model.uvs[i][0], model.uvs[i][1]))
            }
            Surface::Lit => {
                let shader = shader::new(
                    move |v: Vertex3<[f32; 3]>, ()| vertex(to_clip.apply(&v.pos), gray(light.at(v.attrib))),
                    |frag: Frag<Color3f>, ()| frag.var.to_color4(),
                );
                painter(scene, &model, shader, |i| model.normals[i])
            }
            Surface::TexturedLit => {
                let texture = texture_f32();
                let shader = shader::new(
                    move |v: Vertex3<([f32; 3], TexCoord)>, ()| {
                        let (normal, uv) = v.attrib;
                        vertex(to_clip.apply(&v.pos), (gray(light.at(normal)), uv))
                    },
                    move |frag: Frag<(Color3f, TexCoord)>, ()| {
                        let (light, uv) = frag.var;
                        (repeat.sample_abs(&texture, uv) * light).to_color4()
                    },
                );
                painter(scene, &model, shader, |i| (model.normals[i], uv(model.uvs[i][0], model.uvs[i][1])))
            }
            Surface::Flat => {
                let color = color(FLAT).to_rgba();
                let shader = shader::new(
                    move |v: Vertex3<()>, ()| vertex(to_clip.apply(&v.pos), ()),
                    move |_: Frag<()>, ()| color,
                );
                painter(scene, &model, shader, |_| ())
            }
        })
    }
}

/// From the mesh to clip space: the library looks along +z.
fn to_clip(model: &Model) -> ProjMat3<MeshSpace> {
    let [x, y, z] = model.to_eye;
    let to_view: Mat4<MeshSpace, View> = Mat4::new([x, y, z.map(|element| -element), [0.0, 0.0, 0.0, 1.0]]);
    to_view.then(&perspective(2.0 * FOCAL / WIDTH as f32, WIDTH as f32 / HEIGHT as f32, NEAR..FAR))
}

fn texture() -> Texture<Buf2<Color3>> {
    Buf2::new_from(Dims(TEXTURE as u32, TEXTURE as u32), bench::TEXELS.map(color)).into()
}

/// What is multiplied by light need not be converted at every pixel.
fn texture_f32() -> Texture<Buf2<Color3f>> {
    let texel = |texel| {
        let [red, green, blue] = color(texel).0.map(|channel| f32::from(channel) / 255.0);
        rgb(red, green, blue)
    };
    Buf2::new_from(Dims(TEXTURE as u32, TEXTURE as u32), bench::TEXELS.map(texel)).into()
}

fn color(word: u16) -> Color3 {
    let (red, green, blue) = (word >> 11, word >> 5 & 63, word & 31);
    rgb((red << 3 | red >> 2) as u8, (green << 2 | green >> 4) as u8, (blue << 3 | blue >> 2) as u8)
}

/// A painter of the model with or without depth, as the scene asks.
fn painter<A, V, Vs, Fs>(
    scene: &Scene,
    model: &Model,
    shader: Shader<Vs, Fs>,
    attribute: impl Fn(usize) -> A,
) -> Box<dyn Painter>
where
    A: Clone + 'static,
    V: Vary + 'static,
    Vs: VertexShader<Vertex3<A>, (), Output = Vertex<ProjVec3, V>> + 'static,
    Fs: FragmentShader<V, ()> + 'static,
{
    let faces: Vec<Tri<usize>> = model.faces().into_iter().map(Tri).collect();
    let place = |(i, &[x, y, z]): (usize, &[f32; 3])| vertex(pt3(x, y, z), attribute(i));
    let vertices: Vec<Vertex3<A>> = model.positions.iter().enumerate().map(place).collect();
    let to_screen = viewport(pt2(0, HEIGHT as u32)..pt2(WIDTH as u32, 0));
    // With y down and z forward the handedness is that of a mirror.
    let context = Context { face_cull: Some(FaceCull::Front), ..Context::default() };
    let dims = Dims(WIDTH as u32, HEIGHT as u32);
    let color_buf = Colorbuf { buf: Buf2::new(dims), fmt: Rgb565 };
    if scene.depth {
        let target = Framebuf { color_buf, depth_buf: Buf2::new(dims) };
        Box::new(Canvas {
            target,
            draw: move |target: &mut Deep| {
                render(&faces[..], &vertices[..], &shader, (), to_screen, target, &context);
            },
        })
    } else {
        Box::new(Canvas {
            target: color_buf,
            draw: move |target: &mut Flat| {
                render(&faces[..], &vertices[..], &shader, (), to_screen, target, &context);
            },
        })
    }
}

type Flat = Colorbuf<Buf2<u16>, Rgb565>;
type Deep = Framebuf<Flat, Buf2<f32>>;

struct Canvas<T, F> {
    target: T,
    draw: F,
}

impl<F: FnMut(&mut Flat)> Painter for Canvas<Flat, F> {
    fn clear(&mut self, ground: u16) {
        self.target.buf.fill(ground);
    }

    fn draw(&mut self) {
        (self.draw)(&mut self.target);
    }

    fn words(&self) -> Vec<u16> {
        self.target.buf.data().to_vec()
    }
}

impl<F: FnMut(&mut Deep)> Painter for Canvas<Deep, F> {
    fn clear(&mut self, ground: u16) {
        self.target.color_buf.buf.fill(ground);
        // It holds reciprocals of distances.
        self.target.depth_buf.fill(0.0);
    }

    fn draw(&mut self) {
        (self.draw)(&mut self.target);
    }

    fn words(&self) -> Vec<u16> {
        self.target.color_buf.buf.data().to_vec()
    }
}
