//! Surfaces that are not opaque: colours are made in a block on the stack, and laid over what the band holds.
//!
//! - In: a cover with layers, and what makes the colours of a block.
//! - Out: words, and depths if they are written, where something of the surface is seen.
//! - Assumes: nothing.
//!
//! A span is cut into blocks of at most [`BLOCK`] pixels. Each block goes through the same steps, with a byte for each pixel that
//! says how opaque it is, 0 … 255:
//!
//! 1. depth: alpha where the surface is visible, else 0;
//! 2. colours are made; a pixel that the surface leaves out gets 0;
//! 3. vertices: times their alpha;
//! 4. screen door: 0 or 255, by a pattern that stays on the screen;
//! 5. fog is laid over the colours;
//! 6. colours are blended, and depths written, where it is not 0.

use super::cover::{Cover, Layers, Target};
use super::fill::Fill;
use super::memory::Memory;
use super::perspective::Perspective;
use crate::frame::{BAYER, DepthFormat, PixelFormat};
use crate::num::U1F31;
use core::hint::black_box;

/// The most pixels that are on the stack.
pub(super) const BLOCK: usize = 32;

/// Pixels side by side, from (x, y) on.
pub(super) struct Block<'b, W> {
    pub(super) x: i32,
    pub(super) y: i32,
    /// near/w at the first pixel, 31 fraction bits, and its step.
    pub(super) near_w: (u32, i32),
    /// What the band holds.
    pub(super) target: &'b [W],
    /// The colours to be made.
    pub(super) words: &'b mut [W],
    /// How opaque each is. Where it is 0 no colour is needed.
    pub(super) opacity: &'b mut [u8],
}

/// What makes the colours of a block.
pub(super) trait Colors<W> {
    fn make(&mut self, block: &mut Block<'_, W>);
}

/// A fill makes them.
struct Filled<'f, W> {
    line: Perspective<'f>,
    fill: &'f dyn Fill<W>,
}

impl<W> Colors<W> for Filled<'_, W> {
    fn make(&mut self, block: &mut Block<'_, W>) {
        self.line.draw(block.x, block.y, block.words, self.fill);
    }
}

/// A fill makes those that are not left out.
struct Partial<'f, W> {
    line: Perspective<'f>,
    fill: &'f dyn Fill<Option<W>>,
}

impl<W: Copy> Colors<W> for Partial<'_, W> {
    fn make(&mut self, block: &mut Block<'_, W>) {
        let mut made = [None; BLOCK];
        let Some(made) = made.get_mut(..block.words.len()) else {
            return;
        };
        self.line.draw(block.x, block.y, made, self.fill);
        for ((made, word), opacity) in made.iter().zip(&mut *block.words).zip(&mut *block.opacity) {
            match made {
                Some(made) => *word = *made,
                None => *opacity = 0,
            }
        }
    }
}

/// Draws a triangle whose colours a fill makes.
pub(super) fn draw_filled<F: PixelFormat, D: DepthFormat>(
    cover: Cover<'_, '_, F, D>,
    fill: &dyn Fill<F::Word>,
) {
    let line = Perspective::new(cover.setup, fill);
    draw(cover, &mut Filled { line, fill });
}

/// Draws a triangle some pixels of which its fill leaves out.
pub(super) fn draw_some<F: PixelFormat, D: DepthFormat>(
    cover: Cover<'_, '_, F, D>,
    fill: &dyn Fill<Option<F::Word>>,
) {
    let line = Perspective::new(cover.setup, fill);
    draw(cover, &mut Partial { line, fill });
}

/// Draws a triangle, block by block.
#[inline(never)]
pub(super) fn draw<F: PixelFormat, D: DepthFormat>(
    cover: Cover<'_, '_, F, D>,
    colors: &mut dyn Colors<F::Word>,
) {
    let Cover { setup, target } = cover;
    let Target { memory, layers, fog } = target;
    let Memory { rows, window, origin, width, pixels, depth } = memory;
    let (origin, width, fog) = (*origin, *width, *fog);
    rows.each(window, |y, start, end| {
        let first = origin.wrapping_add((y as usize).wrapping_mul(width)).wrapping_add(start as usize);
        let count = (end - start) as usize;
        let of_row = |all| <[_]>::get_mut(all, first..).and_then(|rest| rest.get_mut(..count));
        let Some(pixels) = of_row(&mut *pixels) else {
            return;
        };
        let depth = depth.get_mut(first..).and_then(|rest| rest.get_mut(..count)).unwrap_or_default();
        let (mut near_w, step) = setup.near_w_of(start, y, count);
        let mut depth = depth.chunks_mut(BLOCK);
        for (x, pixels) in (start..).step_by(BLOCK).zip(pixels.chunks_mut(BLOCK)) {
            let depth = depth.next().unwrap_or_default();
            let (mut words, mut opacity) = ([F::rgb565(0); BLOCK], [0; BLOCK]);
            let (Some(words), Some(opacity)) =
                (words.get_mut(..pixels.len()), opacity.get_mut(..pixels.len()))
            else {
                return;
            };
            let nearness = Nearness { first: near_w, step };
            let is_seen = test::<F, D>(layers, nearness, depth, opacity);
            near_w = near_w.wrapping_add_signed(step.wrapping_mul(pixels.len() as i32));
            if !is_seen {
                continue;
            }
            colors.make(&mut Block { x, y, near_w: (nearness.first, step), target: pixels, words, opacity });
            if let Some(of_vertices) = layers.opacity {
                let mut vertices = [0; BLOCK];
                if let Some(vertices) = vertices.get_mut(..opacity.len()) {
                    of_vertices(setup, [x, y], vertices);
                    for (opacity, vertex) in opacity.iter_mut().zip(vertices) {
                        *opacity = times(*opacity, *vertex);
                    }
                }
            }
            if layers.code.is_screen_door {
                let pattern = BAYER[(y & 7) as usize];
                for (x, opacity) in (x as usize..).zip(&mut *opacity) {
                    *opacity = if *opacity > pattern[x & 7] { 255 } else { 0 };
                }
            }
            if let Some(fog) = fog {
                fog.fogging.lay_over([x, y], (nearness.first, step), layers.code.fades_to, words);
            }
            store::<F, D>(layers, nearness, (words, opacity), (pixels, depth));
        }
    });
}

/// near/w along a block, 31 fraction bits.
#[derive(Clone, Copy)]
struct Nearness {
    first: u32,
    step: i32,
}

impl Nearness {
    /// Hands on each pixel's as depth takes it: with the surface's bias.
    #[inline(always)]
    fn each<A, B>(self, bias: i16, pixels: impl Iterator<Item = (A, B)>, mut take: impl FnMut(A, B, U1F31)) {
        let (Self { first: mut near_w, step }, bias) = (self, i32::from(bias) << 15);
        for (a, b) in pixels {
            let mut biased = near_w;
            if bias != 0 {
                biased = near_w.saturating_add_signed(bias).min(i32::MAX as u32);
            }
            take(a, b, U1F31::from_bits(biased));
            near_w = near_w.wrapping_add_signed(step);
            black_box(());
        }
    }
}

/// Makes those pixels as opaque as the surface that are not hidden. Whether there are any.
///
/// Not inlined, as it needs all registers of a Cortex-M0+.
#[inline(never)]
fn test<F: PixelFormat, D: DepthFormat>(
    layers: &Layers<F, D>,
    nearness: Nearness,
    depth: &[D::Word],
    opacity: &mut [u8],
) -> bool {
    let layering = &layers.layering;
    if D::ALWAYS_PASSES || !layering.tests_depth {
        opacity.fill(layering.alpha);
        return true;
    }
    let (alpha, mut any) = (layering.alpha, 0);
    nearness.each(layering.depth_bias, opacity.iter_mut().zip(depth), |opacity, stored, near_w| {
        if D::test(stored, near_w) {
            *opacity = alpha;
            any = 1;
        }
    });
    any != 0
}

/// Lays colours over pixels, and writes depths.
#[inline(never)]
fn store<F: PixelFormat, D: DepthFormat>(
    layers: &Layers<F, D>,
    nearness: Nearness,
    (words, opacity): (&[F::Word], &[u8]),
    (pixels, depth): (&mut [F::Word], &mut [D::Word]),
) {
    match layers.code.blend {
        Some(blend) => blend(pixels, words, opacity),
        None => {
            for ((pixel, word), opacity) in pixels.iter_mut().zip(words).zip(opacity) {
                if *opacity != 0 {
                    *pixel = *word;
                }
                black_box(());
            }
        }
    }
    if !D::ALWAYS_PASSES && layers.writes_depth() {
        nearness.each(
            layers.layering.depth_bias,
            depth.iter_mut().zip(opacity),
            |stored, opacity, near_w| {
                if *opacity != 0 {
                    D::store(stored, near_w);
                }
            },
        );
    }
}

/// a·b / 255, rounded to nearest.
fn times(a: u8, b: u8) -> u8 {
    let product = u32::from(a) * u32::from(b) + 128;
    ((product + (product >> 8)) >> 8) as u8
}
