//! Opaque surfaces: what is visible of them is written straight to the band.
//!
//! - In: a cover.
//! - Out: words and depths where the triangle is in front.
//! - Assumes: nothing shows through the surface, and no pixel of it is left out.
//!
//! (A small triangle is drawn at one go instead, see [`patch`](super::patch).)

use super::cover::Cover;
use super::even::fill;
use super::fill::Fill;
use super::fog::Fogging;
use super::perspective::Perspective;
use super::visible::{DrawRun, draw_rows};
use crate::frame::{DepthFormat, PixelFormat};
use crate::raster::TriangleSetup;

/// By a fill.
struct Filled<'l, 'f, W> {
    line: &'l mut Perspective<'f>,
    fill: &'f dyn Fill<W>,
}

impl<'f, W> DrawRun<W> for Filled<'_, 'f, W> {
    type Again<'r>
        = Filled<'r, 'f, W>
    where
        Self: 'r;

    #[inline(always)]
    fn draw_run(&mut self, x: i32, y: i32, pixels: &mut [W]) {
        self.line.draw(x, y, pixels, self.fill);
    }

    #[inline(always)]
    fn again(&mut self) -> Filled<'_, 'f, W> {
        Filled { line: self.line, fill: self.fill }
    }
}

/// One word everywhere: a program that draws nothing else links no perspective.
struct Even<W>(W);

impl<W: Copy> DrawRun<W> for Even<W> {
    type Again<'r>
        = Self
    where
        W: 'r;

    #[inline(always)]
    fn draw_run(&mut self, _: i32, _: i32, pixels: &mut [W]) {
        fill(pixels, self.0);
    }

    #[inline(always)]
    fn again(&mut self) -> Self {
        Self(self.0)
    }
}

/// By a fill, and fog on it in place.
struct Fogged<'l, 'f, F: PixelFormat> {
    filled: Filled<'l, 'f, F::Word>,
    setup: &'f TriangleSetup,
    fog: &'f Fogging<'f, F>,
}

impl<'f, F: PixelFormat> DrawRun<F::Word> for Fogged<'_, 'f, F> {
    type Again<'r>
        = Fogged<'r, 'f, F>
    where
        Self: 'r;

    fn draw_run(&mut self, x: i32, y: i32, pixels: &mut [F::Word]) {
        self.filled.draw_run(x, y, pixels);
        self.fog.lay_over([x, y], self.setup.at(&self.setup.z, x, y), None, pixels);
    }

    fn again(&mut self) -> Fogged<'_, 'f, F> {
        Fogged { filled: self.filled.again(), setup: self.setup, fog: self.fog }
    }
}

/// Draws an opaque triangle.
#[inline(never)]
pub(super) fn draw<F: PixelFormat, D: DepthFormat>(cover: Cover<'_, '_, F, D>, fill: &dyn Fill<F::Word>) {
    let line = &mut Perspective::new(cover.setup, fill);
    draw_rows::<true, F, D>(cover, Filled { line, fill });
}

/// Draws an opaque triangle all in one word.
#[inline(never)]
pub(super) fn draw_evenly<F: PixelFormat, D: DepthFormat>(cover: Cover<'_, '_, F, D>, word: F::Word) {
    draw_rows::<true, F, D>(cover, Even(word));
}

/// Draws an opaque triangle that is in fog.
#[inline(never)]
pub(super) fn draw_in_fog<F: PixelFormat, D: DepthFormat>(
    cover: Cover<'_, '_, F, D>,
    fill: &dyn Fill<F::Word>,
) {
    let (setup, line) = (cover.setup, &mut Perspective::new(cover.setup, fill));
    if let Some(fog) = cover.target.fog {
        draw_rows::<true, F, D>(cover, Fogged { filled: Filled { line, fill }, setup, fog: &fog.fogging });
    }
}
