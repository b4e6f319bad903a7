//! Angles, vectors, rotations, poses, and the reciprocal table.

mod pose;
mod quaternion;
pub(crate) mod recip;
mod turn;
mod unit;
mod vec;

pub(crate) use pose::dot;
pub use pose::{Pose, ScaleError};
pub use quaternion::Quaternion;
pub use turn::Turn;
pub(crate) use unit::normalized;
pub use vec::Vec3;
