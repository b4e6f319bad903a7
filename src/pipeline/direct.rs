//! The stages from set-up on, straight to a display that nothing is kept for here.
//!
//! A row of a triangle is one rectangle for the display. Its pixels are shaded a run at a time, when the display asks for
//! the first of a run:
//!
//! ```text
//!   row of the triangle   ├─── run ───┼─── run ───┼─── run ───┼─ run ─┤
//!   seen in the target                   ├─────────────────┤              one `fill_contiguous`
//!   shaded                            ├─── run ───┼─── run ───┤
//! ```
//!
//! Runs begin where the row does, not where the target does: what a pixel shows does not depend on how much of the
//! screen the target is, so a part of a picture that is drawn anew fits the rest.

use super::clip::{Clip, MOST_CORNERS, ScreenVertex};
use super::color::Coloring;
use super::draw::needs;
use super::setup::{Cull, Needs, Oriented, TriangleSetup};
use super::shade::Shader;
use super::span::{Rows, Span, Window};
use super::transform::ToClip;
use crate::math::Pose;
use crate::num::I12F4;
use crate::scene::{Mesh, Projection, Textured, Vertex, Viewport};
use crate::target::{NoDepth, PixelFormat};
use core::ops::Range;
use embedded_graphics::draw_target::DrawTarget;
use embedded_graphics::geometry::{Point, Size};
use embedded_graphics::primitives::Rectangle;

/// Columns and rows that a triangle within the guard band may cover.
const REACH: Range<i32> = -1024..1023;

/// Draws triangles into a display. `RUN` pixels at a time are on the stack.
pub(crate) struct Direct<'a, F: PixelFormat, T, const RUN: usize> {
    target: &'a mut T,
    /// What the target shows.
    shown: Window,
    /// The rows shown, and as many columns as are shaded.
    window: Window,
    run: [F::Word; RUN],
    setup: TriangleSetup,
    rows: Rows,
}

impl<'a, F, T, const RUN: usize> Direct<'a, F, T, RUN>
where
    F: PixelFormat,
    T: DrawTarget<Color = F::Color>,
{
    /// Within a viewport, if there is one.
    #[inline(never)]
    pub(crate) fn new(target: &'a mut T, viewport: Option<&Viewport>) -> Self {
        const { assert!(RUN > 0, "a run has a pixel at least") };
        let area = target.bounding_box();
        let mut shown = Window {
            columns: within(area.top_left.x, area.size.width),
            rows: within(area.top_left.y, area.size.height),
        };
        // A band's columns begin at 0: so that its pixels are the same, runs do too, if the target does.
        let first = if shown.columns.start >= 0 { 0 } else { REACH.start };
        let mut window = Window { columns: first..REACH.end, rows: shown.rows.clone() };
        if let Some(viewport) = viewport {
            (shown, window) = (shown.within(viewport), window.within(viewport));
        }
        let (setup, rows) = (TriangleSetup::new(), Rows::default());
        Self { target, shown, window, run: [F::rgb565(0); RUN], setup, rows }
    }

    /// Draws a triangle within the guard band, up to the first error of the display.
    #[inline(never)]
    pub(crate) fn draw<S: Shader<F>>(
        &mut self,
        vertices: [&ScreenVertex; 3],
        cull: Cull,
        is_orthographic: bool,
        shader: &S,
    ) -> Result<(), T::Error> {
        match Oriented::new(vertices, cull) {
            Some(triangle) if !self.shown.is_empty() && self.shown.touches(&triangle) => {
                let needs: Needs = needs::<F, NoDepth, S>(shader, is_orthographic);
                self.setup.set(&triangle, &needs);
            }
            _ => return Ok(()),
        }
        let Self { target, shown, window, run, setup, rows } = self;
        let mut result = Ok(());
        setup.rows(rows, window, |y, start, end| {
            let seen = start.max(shown.columns.start)..end.min(shown.columns.end);
            if seen.is_empty() || result.is_err() {
                return;
            }
            let area = Rectangle::new(Point::new(seen.start, y), Size::new(seen.len() as u32, 1));
            let span = Span::new(setup, start, y);
            result = target.fill_contiguous(&area, Colors::new(shader, run, span, end, seen));
        });
        result
    }
}

/// Of so many columns or rows from `start` on those within reach.
fn within(start: i32, length: u32) -> Range<i32> {
    let end = (i64::from(start) + i64::from(length)).min(i64::from(REACH.end)) as i32;
    start.max(REACH.start)..end
}

/// The colours of what is seen of a row.
struct Colors<'a, F: PixelFormat, S> {
    shader: &'a S,
    run: &'a mut [F::Word],
    /// Which of the run are still to be handed on.
    ready: Range<usize>,
    /// What follows the run.
    span: Span<'a>,
    /// Where the row ends, and where what is seen of it does.
    end: i32,
    seen_end: i32,
}

impl<'a, F: PixelFormat, S: Shader<F>> Colors<'a, F, S> {
    fn new(shader: &'a S, run: &'a mut [F::Word], mut span: Span<'a>, end: i32, seen: Range<i32>) -> Self {
        while span.x() + run.len() as i32 <= seen.start {
            span = span.ahead(run.len());
        }
        let skipped = (seen.start - span.x()) as usize;
        let mut colors = Self { shader, run, ready: 0..0, span, end, seen_end: seen.end };
        if skipped > 0 {
            colors.shade();
            colors.ready.start = skipped;
        }
        colors
    }

    /// Shades the next run, if any of it is seen. Not inlined: displays have loops of their own around `next`.
    #[inline(never)]
    fn shade(&mut self) {
        let x = self.span.x();
        let count = self.run.len().min((self.end - x) as usize);
        if let Some(pixels) = self.run.get_mut(..count) {
            self.shader.span(&self.span, pixels);
        }
        self.ready = 0..count.min((self.seen_end - x) as usize);
        self.span = self.span.ahead(count);
    }
}

impl<F: PixelFormat, S: Shader<F>> Iterator for Colors<'_, F, S> {
    type Item = F::Color;

    #[inline]
    fn next(&mut self) -> Option<F::Color> {
        if self.ready.is_empty() {
            if self.span.x() >= self.seen_end {
                return None;
            }
            self.shade();
        }
        let word = self.run.get(self.ready.start)?;
        self.ready.start += 1;
        Some(F::decode(*word))
    }

    #[inline]
    fn size_hint(&self) -> (usize, Option<usize>) {
        let left = self.ready.len() + (self.seen_end - self.span.x()).max(0) as usize;
        (left, Some(left))
    }
}

/// The two triangles of a quad whose corners run counter-clockwise.
const HALVES: [[usize; 3]; 2] = [[0, 1, 2], [0, 2, 3]];

/// One side of a picture: a texture, and where in it the picture's corners are.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Side<'a> {
    pub(crate) shader: Textured<'a>,
    pub(crate) uv: [[I12F4; 2]; 4],
    /// Which side of the triangles it is not.
    pub(crate) cull: Cull,
}

impl<F, T, const RUN: usize> Direct<'_, F, T, RUN>
where
    F: PixelFormat,
    T: DrawTarget<Color = F::Color>,
{
    /// Draws the sides of a quad that is on the screen.
    pub(crate) fn draw_quad<'s>(
        &mut self,
        mut corners: [ScreenVertex; 4],
        sides: impl Iterator<Item = Side<'s>>,
    ) -> Result<(), T::Error> {
        for side in sides {
            side.texture_corners(&mut corners);
            for half in HALVES {
                self.draw(half.map(|i| &corners[i]), side.cull, false, &side.shader)?;
            }
        }
        Ok(())
    }

    /// Draws the sides of a quad of mesh space (four vertices in a plane) in a pose before a camera.
    pub(crate) fn draw_posed<'s>(
        &mut self,
        projection: &Projection,
        camera: &Pose,
        pose: &Pose,
        mut quad: [Vertex; 4],
        sides: impl Iterator<Item = Side<'s>>,
    ) -> Result<(), T::Error> {
        let Some(placer) = Placer::new(projection, camera, pose, &quad) else {
            return Ok(());
        };
        let mut corners = [ScreenVertex::default(); 4];
        let mut are_placed = [false; 4];
        for i in 0..4 {
            are_placed[i] = placer.place(&quad[i], &mut corners[i]);
        }
        for side in sides {
            side.texture_corners(&mut corners);
            for half in HALVES {
                if half.iter().all(|&i| are_placed[i]) {
                    self.draw(half.map(|i| &corners[i]), side.cull, projection.orthographic, &side.shader)?;
                } else {
                    for (vertex, uv) in quad.iter_mut().zip(side.uv) {
                        vertex.uv = uv;
                    }
                    self.draw_cut(&placer, half.map(|i| &quad[i]), &side, projection.orthographic)?;
                }
            }
        }
        Ok(())
    }

    /// Draws the pieces of a triangle that crosses a plane or leaves the guard band.
    #[cold]
    #[inline(never)]
    fn draw_cut(
        &mut self,
        placer: &Placer,
        triangle: [&Vertex; 3],
        side: &Side<'_>,
        is_orthographic: bool,
    ) -> Result<(), T::Error> {
        let mut corners = [ScreenVertex::default(); MOST_CORNERS];
        let count = placer.cut(triangle, &mut corners);
        let [first, rest @ ..] = &corners;
        for pair in rest.windows(2).take(count.saturating_sub(2)) {
            if let [second, third] = pair {
                self.draw([first, second, third], side.cull, is_orthographic, &side.shader)?;
            }
        }
        Ok(())
    }
}

impl Side<'_> {
    fn texture_corners(&self, corners: &mut [ScreenVertex; 4]) {
        for (corner, [u, v]) in corners.iter_mut().zip(self.uv) {
            (corner.u, corner.v) = (u.into(), v.into());
        }
    }
}

/// The stages before set-up. Their temporaries are not on the stack while pixels are drawn: that is why its functions are not
/// inlined.
struct Placer {
    to_clip: ToClip,
    clip: Clip,
}

impl Placer {
    /// `None` if the quad is out of sight.
    #[inline(never)]
    fn new(projection: &Projection, camera: &Pose, pose: &Pose, quad: &[Vertex; 4]) -> Option<Self> {
        let to_clip = ToClip::new(projection, camera, pose);
        let clip = Clip::new(projection, to_clip.unit_bits());
        let mesh = Mesh::try_new(quad, &[]).ok()?;
        clip.sees(&to_clip, mesh.bounds(), projection).then_some(Self { to_clip, clip })
    }

    /// False for a vertex that has to be cut off.
    #[inline(never)]
    fn place(&self, vertex: &Vertex, to: &mut ScreenVertex) -> bool {
        self.clip.place(&self.to_clip, &Coloring::default(), vertex, to)
    }

    /// How many corners what is left of a triangle has.
    #[inline(never)]
    fn cut(&self, triangle: [&Vertex; 3], to: &mut [ScreenVertex; MOST_CORNERS]) -> usize {
        self.clip.cut(&self.to_clip, &Coloring::default(), triangle, to).unwrap_or(0)
    }
}
