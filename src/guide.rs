//! From nothing to your own model on your own display, page by page.
//!
#![doc = include_str!("guide/guide.md")]

#[doc = include_str!("guide/coordinates.md")]
pub mod coordinates {}

#[doc = include_str!("guide/engines.md")]
pub mod engines {}

#[doc = include_str!("guide/assets.md")]
pub mod assets {}

#[doc = include_str!("guide/memory.md")]
pub mod memory {}

#[doc = include_str!("guide/surfaces.md")]
pub mod surfaces {}

#[doc = include_str!("guide/interface.md")]
pub mod interface {}

#[doc = include_str!("guide/parallel.md")]
pub mod parallel {}

#[doc = include_str!("guide/speed.md")]
pub mod speed {}

#[doc = include_str!("guide/troubleshooting.md")]
pub mod troubleshooting {}

#[doc = include_str!("guide/cost.md")]
pub mod cost {}

#[doc = include_str!("guide/pixel.md")]
pub mod pixel {}
