//! Shaders that see more of a pixel than its attributes: they are asked for each pixel by itself.
//!
//! - In: a cover, and a shader.
//! - Out: words, and depths, where the shader draws something.
//! - Assumes: nothing.

use super::cover::Cover;
use super::fill::{Each, Fill};
use super::layered::{self, BLOCK, Block, Colors};
use super::perspective::Perspective;
use super::shader::{Fragment, Shader, Varying};
use crate::frame::{DepthFormat, PixelFormat};
use crate::geometry::Inputs;
use crate::num::U1F31;

/// A shader makes colours, of attributes that a fill writes down.
struct Fragments<'f, S> {
    line: Perspective<'f>,
    fill: &'f dyn Fill<[i32; 5]>,
    shader: &'f S,
}

/// The most pixels whose attributes are on the stack.
const PART: usize = 8;
const _: () = assert!(BLOCK.is_multiple_of(PART));

impl<S> Fragments<'_, S> {
    fn make<F: PixelFormat>(&mut self, block: &mut Block<'_, F::Word>)
    where
        S: Shader<F>,
    {
        let (mut x, (mut near_w, step)) = (block.x, block.near_w);
        let parts = block.words.chunks_mut(PART).zip(block.opacity.chunks_mut(PART));
        for ((words, opacity), targets) in parts.zip(block.target.chunks(PART)) {
            let mut attributes = [[0; 5]; PART];
            let Some(attributes) = attributes.get_mut(..words.len()) else {
                return;
            };
            self.line.draw(x, block.y, attributes, self.fill);
            let pixels = words.iter_mut().zip(opacity).zip(targets).zip(attributes);
            for (((word, opacity), &target), attributes) in pixels {
                if *opacity != 0 {
                    let fragment = Fragment {
                        varying: Varying::new(*attributes),
                        place: [x, block.y],
                        near_w: U1F31::from_bits(near_w),
                        target,
                    };
                    match self.shader.fragment(&fragment) {
                        Some(made) => *word = made,
                        None => *opacity = 0,
                    }
                }
                (x, near_w) = (x + 1, near_w.wrapping_add_signed(step));
            }
        }
    }
}

/// For one format: a shader may be for several.
struct In<'f, F, S>(Fragments<'f, S>, core::marker::PhantomData<F>);

impl<F: PixelFormat, S: Shader<F>> Colors<F::Word> for In<'_, F, S> {
    fn make(&mut self, block: &mut Block<'_, F::Word>) {
        self.0.make::<F>(block);
    }
}

/// Draws a triangle with a shader that sees pixels.
pub(super) fn draw<F: PixelFormat, D: DepthFormat, S: Shader<F>>(shader: &S, cover: Cover<'_, '_, F, D>) {
    let setup = cover.setup;
    let draw = |fill: &dyn Fill<[i32; 5]>| {
        let line = Perspective::new(setup, fill);
        let fragments = Fragments { line, fill, shader };
        layered::draw(cover, &mut In::<F, S>(fragments, core::marker::PhantomData));
    };
    match (shader.inputs(), setup.gray) {
        (Inputs::None, _) => draw(&Each::<0, S::Quality, _, _>::new(|[]: [i32; 0]| [0; 5])),
        (Inputs::Uv, _) => draw(&Each::<2, S::Quality, _, _>::new(|[u, v]: [i32; 2]| [u, v, 0, 0, 0])),
        (Inputs::Color, true) => draw(&Each::<1, S::Quality, _, _>::new(|[c]: [i32; 1]| [0, 0, c, c, c])),
        (Inputs::Color, false) => {
            draw(&Each::<3, S::Quality, _, _>::new(|[r, g, b]: [i32; 3]| [0, 0, r, g, b]))
        }
        (Inputs::UvColor, true) => {
            draw(&Each::<3, S::Quality, _, _>::new(|[u, v, c]: [i32; 3]| [u, v, c, c, c]))
        }
        (Inputs::UvColor, false) => draw(&Each::<5, S::Quality, _, _>::new(|all: [i32; 5]| all)),
    }
}
