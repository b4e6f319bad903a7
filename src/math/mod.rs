//! Angles, vectors, poses, and the reciprocal table.

mod pose;
pub(crate) mod recip;
mod turn;
mod vec;

pub use pose::Pose;
pub use turn::Turn;
pub use vec::Vec3;
