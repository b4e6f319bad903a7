//! fixel beside its peers: other Rust rasterizers draw the same [`scene`]s on the machine that
//! builds them, in one run.
//!
//! Every library of [`libraries`] is a [`Library`](library::Library) that makes a
//! [`Painter`](library::Painter) for a scene, or says why it cannot. Before anything is timed a test compares
//! each [`picture`] with fixel's. [`measure`] times the painters, [`table`] and [`chart`] show the result.

#![forbid(unsafe_code)]

pub mod chart;
pub mod frame;
pub mod libraries;
pub mod library;
pub mod measure;
pub mod model;
pub mod picture;
pub mod scene;
pub mod table;
