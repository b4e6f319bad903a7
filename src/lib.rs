//! fixel draws perspective-correct, textured 3D triangles on microcontrollers, in integers, into
//! any [embedded-graphics](embedded_graphics) display.
#![no_std]
#![warn(unreachable_pub)]

#[cfg(test)]
extern crate std;

mod math;
pub mod num;
mod pipeline;
mod scene;
mod target;

pub use embedded_graphics;
pub use fixed;

pub use math::{Pose, Turn, Vec3};
pub use pipeline::{
    Affine, Cull, Exact, Inputs, Quality, QuarterPixel, RangeError, ScreenVertex, Shader, Span, Varying,
    draw_triangle,
};
pub use scene::{Camera, Material, Mesh, MeshError, Texture, TextureError, Vertex, Wrap, texels};
pub use target::{Band, BigEndian, Depth16, DepthFormat, NoDepth, PixelFormat, TargetError};

/// What most programs use: `use fixel::prelude::*;`.
pub mod prelude {
    pub use crate::{
        Band, Camera, Cull, Depth16, Material, Mesh, NoDepth, Pose, Texture, Turn, Vec3, Vertex, Wrap, texels,
    };
}
