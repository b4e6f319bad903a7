//! Angles, vectors, rotations, poses, and the reciprocal table.

mod compose;
mod matrix;
mod pose;
mod quaternion;
pub(crate) mod recip;
mod scale;
mod turn;
mod unit;
mod vec;

pub(crate) use matrix::dot;
pub use pose::Pose;
pub use quaternion::Quaternion;
pub use scale::ScaleError;
pub use turn::Turn;
pub(crate) use unit::normalized;
pub use vec::Vec3;
