//! What set-up has to know of a shader.
//!
//! - In: a shader.
//! - Out: the numbers that set-up needs of it, so that set-up need not know its type.
//! - Assumes: nothing.

use super::quality::Quality;
use super::shader::Shader;
use crate::frame::PixelFormat;
use crate::geometry::Inputs;
use crate::raster::{InputCode, Needs, Packing, Straight};

/// What set-up has to know of a shader.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Traits {
    /// What it reads, and what sets that up.
    code: &'static InputCode,
    straight: Straight,
    every_pixel: bool,
    /// Whether only the first channel of colours is read.
    is_gray: bool,
    /// Whether near/w is asked for at pixels.
    needs_near_w: bool,
    scale_log2: u8,
    packed_log2: Option<[u8; 2]>,
}

impl Traits {
    /// Inlined: where a shader's inputs are a constant, only their code is linked.
    #[inline(always)]
    pub(crate) fn of<F: PixelFormat, S: Shader<F>>(shader: &S) -> Self {
        Self {
            code: InputCode::of(shader.inputs()),
            straight: S::Quality::STRAIGHT,
            every_pixel: S::Quality::EVERY_PIXEL,
            is_gray: false,
            needs_near_w: false,
            scale_log2: shader.texture_scale().min(8) as u8,
            packed_log2: shader.packed_log2().map(|log2| log2.map(|log2| log2 as u8)),
        }
    }

    /// Which attributes it reads.
    #[inline]
    pub(crate) fn inputs(&self) -> Inputs {
        self.code.inputs
    }

    /// The same with near/w asked for at pixels, or not.
    pub(crate) fn with_near_w(self, needs_near_w: bool) -> Self {
        Self { needs_near_w, ..self }
    }

    /// Whether near/w is asked for at pixels.
    pub(crate) fn needs_near_w(&self) -> bool {
        self.needs_near_w
    }

    /// The same with only the first channel of colours read.
    pub(crate) fn with_gray(self) -> Self {
        Self { is_gray: true, ..self }
    }

    /// What set-up has to do, with depth or without, before a camera that may be orthographic, and with colours that
    /// may all be grey.
    #[inline(never)]
    pub(crate) fn needs<F: PixelFormat>(&self, depth: bool, is_orthographic: bool, is_gray: bool) -> Needs {
        let mut needs = Needs {
            code: self.code,
            straight: if is_orthographic { Straight::Always } else { self.straight },
            every_pixel: self.every_pixel,
            scale: self.scale_log2,
            unscaled_packing: Packing::NONE,
            margins: [0; 2],
            packing: Packing::NONE,
            color_step: F::COLOR_STEP,
            depth,
            gray: is_gray || self.is_gray,
            rows_below: false,
        };
        needs.pack(self.packed_log2);
        needs
    }
}
