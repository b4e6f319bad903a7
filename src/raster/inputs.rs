//! Inputs: the code that sets up each set of attributes that a shader may read.
//!
//! - In: which attributes a shader reads.
//! - Out: the functions that set them up.
//! - Assumes: nothing.
//!
//! Where the inputs are known when a program is compiled, as those of materials are, only their code is linked.

use super::needs::{InputCode, Needs, UvCode};
use super::triangle::{TriangleSetup, are_gray};
use crate::geometry::Inputs;

impl InputCode {
    const NONE: Self = Self {
        inputs: Inputs::None,
        small: TriangleSetup::set_small_depth,
        any: TriangleSetup::set_depth,
        uv: None,
        are_gray: None,
        small_color: None,
    };
    const UV: Self = Self { inputs: Inputs::Uv, uv: Some(UvCode::ALL), ..Self::SOME };
    const COLOR: Self = Self {
        inputs: Inputs::Color,
        are_gray: Some(are_gray),
        small_color: Some(TriangleSetup::set_small_colors),
        ..Self::SOME
    };
    const UV_COLOR: Self = Self { inputs: Inputs::UvColor, uv: Some(UvCode::ALL), ..Self::COLOR };
    const SOME: Self = Self { small: TriangleSetup::set_small, any: TriangleSetup::set, ..Self::NONE };

    /// The code for these inputs.
    #[inline(always)]
    pub(crate) const fn of(inputs: Inputs) -> &'static Self {
        match inputs {
            Inputs::None => &Self::NONE,
            Inputs::Uv => &Self::UV,
            Inputs::Color => &Self::COLOR,
            Inputs::UvColor => &Self::UV_COLOR,
        }
    }
}

impl UvCode {
    const ALL: Self = Self {
        small: TriangleSetup::set_small_uv,
        bend: TriangleSetup::bend,
        complete_held: TriangleSetup::complete_held_uv,
        complete: TriangleSetup::settle,
        pack: Needs::pack_uv,
        scale: Needs::scale_for,
    };
}
