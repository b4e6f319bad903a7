//! Surfaces that are equally transparent everywhere: colours are made on the stack and blended run by run.
//!
//! - In: a cover whose layers blend.
//! - Out: words, and depths if they are written, where the triangle is in front.
//! - Assumes: nothing. It is for an alpha that is the same everywhere, with the usual test and no depth written; all else goes the
//!   [general way](super::layered).

use super::cover::{BlendEvenly, Cover, InFog};
use super::fill::Fill;
use super::layered::{BLOCK, draw_filled};
use super::perspective::Perspective;
use super::visible::{DrawRun, draw_rows};
use crate::frame::{DepthFormat, PixelFormat};
use crate::raster::TriangleSetup;

/// By a fill, in blocks, each of which is blended.
struct Blended<'l, 'f, F: PixelFormat, D: DepthFormat> {
    line: &'l mut Perspective<'f>,
    fill: &'f dyn Fill<F::Word>,
    setup: &'f TriangleSetup,
    fog: Option<&'f InFog<'f, F, D>>,
    fades_to: Option<u16>,
    blend: BlendEvenly<F>,
    alpha: u8,
}

impl<'f, F: PixelFormat, D: DepthFormat> DrawRun<F::Word> for Blended<'_, 'f, F, D> {
    type Again<'r>
        = Blended<'r, 'f, F, D>
    where
        Self: 'r;

    fn draw_run(&mut self, x: i32, y: i32, pixels: &mut [F::Word]) {
        for (x, pixels) in (x..).step_by(BLOCK).zip(pixels.chunks_mut(BLOCK)) {
            let mut words = [F::rgb565(0); BLOCK];
            let Some(words) = words.get_mut(..pixels.len()) else {
                return;
            };
            self.line.draw(x, y, words, self.fill);
            if let Some(fog) = self.fog {
                fog.fogging.lay_over([x, y], self.setup.at(&self.setup.z, x, y), self.fades_to, words);
            }
            (self.blend)(pixels, words, self.alpha);
        }
    }

    fn again(&mut self) -> Blended<'_, 'f, F, D> {
        Blended { line: self.line, ..*self }
    }
}

/// Draws a triangle whose colours a fill makes, and blends it.
pub(super) fn draw<F: PixelFormat, D: DepthFormat>(cover: Cover<'_, '_, F, D>, fill: &dyn Fill<F::Word>) {
    let layers = cover.target.layers;
    let layering = &layers.layering;
    let is_usual = layering.tests_depth && layering.depth_bias == 0 && !layers.writes_depth();
    let Some(blend) = layers.code.blend_evenly.filter(|_| is_usual && layers.opacity.is_none()) else {
        return draw_filled(cover, fill);
    };
    let (setup, fog) = (cover.setup, cover.target.fog);
    let line = &mut Perspective::new(setup, fill);
    let (fades_to, alpha) = (layers.code.fades_to, layering.alpha);
    draw_rows::<false, F, D>(cover, Blended { line, fill, setup, fog, fades_to, blend, alpha });
}
