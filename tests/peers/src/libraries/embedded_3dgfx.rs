//! embedded-3dgfx: an engine with meshes, recorded into a command buffer and then executed.

use crate::frame::Frame;
use crate::library::{Library, Painter};
use crate::model::{FAR, FLAT, FOCAL, HEIGHT, Light, Model, NEAR, PIXELS, TEXTURE, WIDTH};
use crate::scene::{Scene, Surface};
use ::embedded_3dgfx::pipeline::command_buffer::RenderCommand;
use ::embedded_3dgfx::prelude::*;
use embedded_graphics::pixelcolor::{Rgb565, raw::RawU16};
use fixel_firmware::bench;
use nalgebra::{Matrix3, Matrix4, Point2, Rotation3, UnitQuaternion, Vector3, Vector4};

#[derive(Debug)]
pub(super) struct Embedded3dgfx;

impl Library for Embedded3dgfx {
    fn name(&self) -> &'static str {
        "embedded-3dgfx"
    }

    fn version(&self) -> &'static str {
        "0.7"
    }

    fn difference(&self) -> Option<&'static str> {
        Some(
            "vertices are transformed in f32 and cut to whole pixels; along a triangle's edges 1/w and the texture \
             are not perspective-correct, so that textures bend; rows include both their ends; depth is always \
             tested, with as many steps as the far plane is units away; ambient light is a tenth, always",
        )
    }

    fn difference_in(&self, scene: &Scene) -> Option<&'static str> {
        own_vertices(scene).then_some(
            "leaves out textured triangles with a vertex off the screen, so the caller transforms and \
             records them",
        )
    }

    fn painter(&self, scene: &Scene) -> Result<Box<dyn Painter>, &'static str> {
        if scene.crosses_near_plane {
            return Err("textured triangles are not clipped at the near plane");
        }
        Ok(Box::new(Canvas::new(scene)))
    }
}

/// Whether the engine would leave out triangles: the floor's and the cube's reach beyond the screen.
fn own_vertices(scene: &Scene) -> bool {
    scene.surface == Surface::Textured
}

struct Canvas {
    engine: K3dengine,
    mesh: K3dMesh<'static>,
    textures: TextureManager<1>,
    commands: Box<CommandBuffer<1024>>,
    depth: Vec<ZDepth>,
    frame: Frame,
    own_vertices: bool,
}

impl Canvas {
    fn new(scene: &Scene) -> Self {
        let model = Model::new(scene);
        let mut engine = K3dengine::new(WIDTH as u16, HEIGHT as u16);
        engine.camera.set_fovy(2.0 * (HEIGHT as f32 / 2.0 / FOCAL).atan());
        engine.camera.set_near_far(NEAR, FAR);
        // Clearing is not timed for any library.
        engine.set_depth_clear_enabled(false);
        let mut textures = TextureManager::new();
        let texture = textures.add_texture(texture()).unwrap_or_default();
        Self {
            engine,
            mesh: mesh(&model, scene.surface, texture),
            textures,
            commands: Box::default(),
            depth: vec![Z_MAX_VALUE; PIXELS],
            frame: Frame::new(),
            own_vertices: own_vertices(scene),
        }
    }

    /// Projects and records textured triangles as the engine does, those too whose vertices are off the screen.
    fn record(&mut self) -> Result<(), RenderError> {
        let Geometry { vertices, faces, uvs, texture_id: Some(texture_id), .. } = self.mesh.geometry else {
            return Ok(());
        };
        let camera = &self.engine.camera;
        let to_clip: Matrix4<f32> = camera.vp_matrix * self.mesh.model_matrix;
        self.commands.clear();
        for face in faces {
            let corners = face.map(|i| {
                let [x, y, z] = vertices[i];
                let clip = to_clip * Vector4::new(x, y, z, 1.0);
                let x = (1.0 + clip.x / clip.w) * 0.5 * WIDTH as f32;
                let y = (1.0 - clip.y / clip.w) * 0.5 * HEIGHT as f32;
                let depth = clip.z / clip.w * (camera.far - camera.near) + camera.near;
                (Point2::new(x as i32, y as i32), depth.trunc(), clip.w)
            });
            let [a, b, c] = corners.map(|(point, ..)| point);
            if (b - a).perp(&(c - a)) < 0 {
                self.commands.push(RenderCommand::Draw(DrawPrimitive::TexturedTriangleWithDepth {
                    points: [a, b, c],
                    depths: corners.map(|(_, depth, _)| depth),
                    ws: corners.map(|(.., w)| w),
                    uvs: face.map(|i| uvs[i]),
                    texture_id,
                }))?;
            }
        }
        Ok(())
    }

    fn try_draw(&mut self) -> Result<(), RenderError> {
        if self.own_vertices {
            self.record()?;
        } else {
            self.engine.record([&self.mesh], &mut self.commands, None)?;
        }
        let frame = &mut FrameCtx { zbuffer: &mut self.depth, width: WIDTH, height: HEIGHT };
        self.engine.execute_with_textures(&mut self.frame, frame, &self.commands, &self.textures, None)?;
        Ok(())
    }
}

impl Painter for Canvas {
    fn clear(&mut self, ground: u16) {
        self.frame.clear_to(ground);
        self.depth.fill(Z_MAX_VALUE);
    }

    fn draw(&mut self) {
        self.try_draw().expect("the command buffer holds every scene");
    }

    fn words(&self) -> Vec<u16> {
        self.frame.words()
    }
}

/// A mesh borrows, and a texture must live as long as the program: so does all of this.
fn mesh(model: &Model, surface: Surface, texture: u32) -> K3dMesh<'static> {
    let vertices = model.positions.clone().leak();
    let faces = model.faces().leak();
    let normals = vec![[0.0; 3]; faces.len()].leak();
    Geometry::compute_face_normals_into(vertices, faces, normals);
    let mut geometry = Geometry::new(vertices, faces).with_normals(normals);
    if surface.is_textured() {
        let relative = |uv: &[f32; 2]| uv.map(|coordinate| coordinate / TEXTURE as f32);
        let uvs: Vec<[f32; 2]> = model.uvs.iter().map(relative).collect();
        geometry = geometry.with_uvs(uvs.leak()).with_texture(texture);
    }
    if matches!(surface, Surface::Lit | Surface::TexturedLit) {
        geometry = geometry.with_vertex_normals(model.normals.clone().leak());
    }
    let mut mesh = K3dMesh::new(geometry);
    place(&mut mesh, model);
    mesh.set_render_mode(match surface {
        Surface::Textured => RenderMode::Textured,
        Surface::Lit => RenderMode::GouraudLightDir(light()),
        Surface::TexturedLit => RenderMode::TexturedGouraud(light()),
        Surface::Flat => RenderMode::Solid,
    });
    if surface == Surface::Flat {
        mesh.set_color(RawU16::new(FLAT).into());
    }
    mesh
}

fn place(mesh: &mut K3dMesh<'_>, model: &Model) {
    let [x, y, z] = model.to_eye;
    let rotation = Matrix3::from_rows(&[x, y, z].map(|row| Vector3::new(row[0], row[1], row[2]).transpose()));
    let scale = rotation.row(0).norm();
    let rotation = Rotation3::from_matrix_unchecked(rotation / scale);
    mesh.set_position(x[3], y[3], z[3]);
    mesh.set_rotation(UnitQuaternion::from_rotation_matrix(&rotation));
    mesh.set_scale(scale);
}

/// Towards the light, with z turned round, and as long as the light is strong, so that a surface that faces it is
/// as bright as fixel's: the engine adds a tenth of ambient light and takes 31 for 32/32.
fn light() -> Vector3<f32> {
    let light = Light::new();
    let [x, y, z] = light.towards;
    Vector3::new(x, y, -z) * ((light.sun + light.ambient) * 32.0 / 31.0 - 0.1)
}

fn texture() -> Texture {
    let texels: Vec<Rgb565> = bench::TEXELS.iter().map(|&texel| RawU16::new(texel).into()).collect();
    Texture::new(texels.leak(), TEXTURE as u32, TEXTURE as u32)
}
