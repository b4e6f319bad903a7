//! Lights, and how much of their light arrives at a vertex or a face.

mod lights;
mod normal;
mod point;
mod stretch;

pub use lights::{Light, Lighting, Lights, LightsError};
pub use normal::Normal;
