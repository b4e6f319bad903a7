//! Ready-made meshes, built by the compiler.
//!
//! A shape's size is in its type, so it can stand in flash: [`Shape`] has the counts, [`Counts`]
//! computes them, and wrong ones are a compile error that names the right ones.
//!
//! ```
//! use fixel::Mesh;
//! use fixel::shapes::{Counts, Shape, torus, uv_sphere};
//!
//! static RING: Shape<500, 1000> = torus(1.0, 0.45, 25, 20);
//! const RING_MESH: Mesh = RING.mesh();
//!
//! const N: Counts = Counts::uv_sphere(24, 12);
//! static GLOBE: Shape<{ N.vertices }, { N.triangles }> = uv_sphere(1.0, 24, 12, [512, 256]);
//! # assert_eq!(RING_MESH.vertices().len(), 500);
//! # assert_eq!(GLOBE.mesh().triangles().len(), 528);
//! ```
//!
//! A torus of 25 × 20 squares is not a `Shape<526, 1000>` ("this shape is a Shape<500, 1000>"):
//!
//! ```compile_fail,E0080
//! # use fixel::shapes::{Shape, torus};
//! static RING: Shape<526, 1000> = torus(1.0, 0.45, 25, 20);
//! # let _ = RING.mesh();
//! ```
//!
//! All shapes have the origin in their middle and are closed (but for [`quad`] and [`grid`]); their
//! triangles run counter-clockwise seen from outside, their normals point outward, their colour is white.
//! Lengths are in mesh units, above 0; no vertex may leave −8 … 7.9998. A shape some units large keeps more
//! of its form in 12 fraction bits than a small one; the pose scales it. Textures read from
//! left to right seen from outside; the parameter `texels` says how many of them, 0 … 2047, go across and
//! down: the texture's size, times how often it is to be repeated.
//!
//! A shape of 65 535 triangles compiles in some seconds. One of about twice as many is a constant that takes the compiler too long,
//! unless it is told to `allow(long_running_const_eval)`.
//!
//! # Panics
//!
//! All functions here are meant for `const` and `static`, where a parameter that makes no such shape, or
//! counts that do not fit, are a compile error. Elsewhere they panic, and compute in soft float
//! where there is no FPU.

#![expect(clippy::float_arithmetic, reason = "meant to be evaluated by the compiler")]

mod builder;
mod flat;
mod icosphere;
mod round;
mod shape;

pub use flat::{cube, grid, quad};
pub use icosphere::icosphere;
pub use round::{cylinder, torus, torus_textured, uv_sphere};
pub use shape::{Counts, Shape};

#[cfg(test)]
mod tests;
