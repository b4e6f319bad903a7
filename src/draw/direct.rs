//! One triangle on the screen, straight to a display, of which nothing is kept in memory.
//!
//! - In: three screen vertices.
//! - Out: the colours of its rows, handed to the display row by row.
//! - Assumes: the vertices lie in the guard band.
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

use crate::frame::{NoDepth, PixelFormat, Window};
use crate::geometry::{
    Cull, MOST_CORNERS, Oriented, Placing, ScreenVertex, Upper, VertexColors, piece, position, set_attributes,
};
use crate::math::Pose;
use crate::num::{I4F12, I12F4};
use crate::raster::{Needs, Rows, Runs, Span, TriangleSetup, WIDEST};
use crate::scene::{Mesh, Projection, Vertex, Viewport};
use crate::shade::{Cover, Layers, Material, Memory, Run, Shader, Target, Textured, Traits};
use core::ops::Range;
use embedded_graphics::draw_target::DrawTarget;
use embedded_graphics::geometry::{Point, Size};
use embedded_graphics::pixelcolor::Rgb565;
use embedded_graphics::primitives::Rectangle;

/// Columns and rows that may be drawn: those whose centres lie inside the guard band, and inside [`Clip`]'s planes.
const REACH: Range<i32> = -1023..1023;

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

const _: () = assert!(size_of::<Direct<'_, Rgb565, (), 64>>() <= 560);

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
        Self {
            target,
            shown,
            window,
            run: [F::rgb565(0); RUN],
            setup: TriangleSetup::new(),
            rows: Rows::NONE,
        }
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
        let Some(triangle) = Oriented::new(vertices, cull) else {
            return Ok(());
        };
        let [[a, _], [b, _], [c, _]] = triangle.vertices.map(position);
        let [left, right] = Window::centers(a, b, c);
        if left >= self.shown.columns.end || right <= self.shown.columns.start {
            return Ok(());
        }
        let needs: Needs = Traits::of::<F, S>(shader).needs::<F>(false, is_orthographic, false);
        if !self.setup.prepare(&mut self.rows, &triangle, &self.window, &needs) {
            return Ok(());
        }
        if self.setup.is_patch() && RUN >= WIDEST {
            return self.draw_small(shader);
        }
        let Self { target, shown, window, run, setup, rows } = self;
        let mut result = Ok(());
        rows.each(window, |y, start, end| {
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

    /// Draws a polygon that is folded.
    #[cold]
    #[inline(never)]
    fn draw_folded<S: Shader<F>>(
        &mut self,
        polygon: &[ScreenVertex],
        cull: Cull,
        is_orthographic: bool,
        shader: &S,
    ) -> Result<(), T::Error> {
        let mut runs = Runs::new(polygon, &self.window);
        let mut result = Ok(());
        while result.is_ok()
            && let Some((run, corners)) = runs.next(polygon)
        {
            self.window = run;
            result = self.draw(corners, cull, is_orthographic, shader);
        }
        self.window = runs.window();
        result
    }

    /// Draws a small triangle: a row at a time, which fits a run.
    #[inline(never)]
    fn draw_small<S: Shader<F>>(&mut self, shader: &S) -> Result<(), T::Error> {
        let Self { target, shown, window, run, setup, rows } = self;
        let Rows::Short(all) = rows else {
            return Ok(());
        };
        for row in all.rows() {
            let [y, start, end] = all.on_screen(row);
            let seen = start.max(shown.columns.start)..end.min(shown.columns.end);
            if seen.is_empty() {
                continue;
            }
            // Of no height, and its first column that of the span.
            let mut of_row = Target::<F, NoDepth> {
                memory: Memory::of_row(Rows::Short(all.only(row)), window.clone(), start, &mut run[..]),
                layers: &Layers::OPAQUE,
                fog: None,
            };
            shader.paint(Cover { setup, target: &mut of_row });
            let words = run.get((seen.start - start) as usize..(seen.end - start) as usize);
            let area = Rectangle::new(Point::new(seen.start, y), Size::new(seen.len() as u32, 1));
            let colors = words.unwrap_or_default().iter().map(|&word| F::decode(word));
            target.fill_contiguous(&area, colors)?;
        }
        Ok(())
    }
}

/// Of so many columns or rows from `start` on those within reach; of none an empty range that is, too.
fn within(start: i32, length: u32) -> Range<i32> {
    let end = i64::from(start) + i64::from(length);
    let reached = |at: i64| at.clamp(REACH.start.into(), REACH.end.into()) as i32;
    reached(start.into())..reached(end)
}

/// The colours of what is seen of a row.
///
/// What `next` needs for most pixels stays in registers where a display's loop has it inlined: so nothing takes a reference to
/// all of this.
struct Colors<'a, F: PixelFormat, S, const RUN: usize> {
    run: &'a mut [F::Word; RUN],
    /// Which of the run are still to be handed on.
    at: usize,
    ready: usize,
    /// What follows the run, up to the end of the row.
    span: Span<'a>,
    end: i32,
    /// The end of what is seen.
    seen_end: i32,
    shader: &'a S,
}

impl<'a, F: PixelFormat, S: Shader<F>, const RUN: usize> Colors<'a, F, S, RUN> {
    #[inline]
    fn new(
        shader: &'a S,
        run: &'a mut [F::Word; RUN],
        mut span: Span<'a>,
        end: i32,
        seen: Range<i32>,
    ) -> Self {
        while span.x + RUN as i32 <= seen.start {
            span = span.ahead(RUN);
        }
        let skipped = (seen.start - span.x) as usize;
        let mut colors = Self { run, at: 0, ready: 0, span, end, seen_end: seen.end, shader };
        if skipped > 0 {
            colors.shade();
            colors.at = skipped;
        }
        colors
    }

    /// The next run, some of which is seen.
    #[inline]
    fn shade(&mut self) {
        let x = self.span.x;
        let count = RUN.min((self.end - x) as usize);
        let span = self.span;
        shade(self.shader, &span, count, self.run);
        (self.at, self.ready) = (0, count.min((self.seen_end - x) as usize));
        self.span = self.span.ahead(count);
    }
}

/// Not inlined: displays have loops of their own around `next`.
#[inline(never)]
fn shade<F: PixelFormat, S: Shader<F>, const RUN: usize>(
    shader: &S,
    span: &Span<'_>,
    count: usize,
    run: &mut [F::Word; RUN],
) {
    if let Some(pixels) = run.get_mut(..count) {
        shader.paint(Run { span: *span, pixels });
    }
}

impl<F: PixelFormat, S: Shader<F>, const RUN: usize> Iterator for Colors<'_, F, S, RUN> {
    type Item = F::Color;

    #[inline]
    fn next(&mut self) -> Option<F::Color> {
        if self.at == self.ready {
            if self.span.x >= self.seen_end {
                return None;
            }
            self.shade();
        }
        let word = *self.run.get(self.at)?;
        self.at += 1;
        Some(F::decode(word))
    }

    #[inline]
    fn size_hint(&self) -> (usize, Option<usize>) {
        let left = self.ready - self.at + (self.seen_end - self.span.x).max(0) as usize;
        (left, Some(left))
    }
}

/// The two triangles of a quad whose corners run counter-clockwise.
const HALVES: [[usize; 3]; 2] = [[0, 1, 2], [0, 2, 3]];

/// One side of a picture: a texture, and where in it the picture's corners are.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Side<'a> {
    pub(crate) shader: Material<'a, Textured>,
    pub(crate) uv: [[I12F4; 2]; 4],
    /// Which side of the triangles it is not.
    pub(crate) cull: Cull,
}

/// Four corners on the screen, counter-clockwise from a picture's top left.
pub(crate) struct Quad {
    corners: [ScreenVertex; 4],
    posed: Option<Posed>,
}

/// Where the corners come from, and which of them are of no use because clipping cuts them off.
struct Posed {
    vertices: [Vertex; 4],
    are_cut_off: [bool; 4],
    placing: Placing,
    viewport: Viewport,
    is_orthographic: bool,
    is_mirrored: bool,
}

impl Quad {
    pub(crate) fn on_screen(corners: [ScreenVertex; 4]) -> Self {
        Self { corners, posed: None }
    }

    /// A rectangle around a pose's origin, half as wide and high, before a camera; `None` if it is out of sight.
    ///
    /// Not inlined: what it takes is not on the stack while pixels are drawn.
    #[inline(never)]
    pub(crate) fn posed(
        projection: &Projection,
        camera: &Pose,
        pose: &Pose,
        [right, top]: [I4F12; 2],
    ) -> Option<Self> {
        let corner = |x, y| Vertex { position: [x, y, I4F12::ZERO], ..Default::default() };
        // At most 7.9998, which has a negative.
        let vertices = [corner(-right, top), corner(-right, -top), corner(right, -top), corner(right, top)];
        let mut placing = Placing::ZERO;
        placing.set(projection, camera, pose);
        let bounds = Mesh::try_new(&vertices, &[]).ok().map(|mesh| *mesh.bounds())?;
        if !placing.sees(projection, &bounds) {
            return None;
        }
        let (mut corners, mut are_cut_off) = ([ScreenVertex::default(); 4], [false; 4]);
        for i in 0..4 {
            are_cut_off[i] = !placing.place_bare(&vertices[i], &mut corners[i]);
        }
        let (viewport, is_orthographic) = (projection.viewport, projection.orthographic);
        let is_mirrored = camera.is_mirrored() != pose.is_mirrored();
        let posed = Posed { vertices, are_cut_off, placing, viewport, is_orthographic, is_mirrored };
        Some(Self { corners, posed: Some(posed) })
    }

    /// Draws the sides, up to the first error of the display.
    #[inline(never)]
    pub(crate) fn draw<'s, F, T, const RUN: usize>(
        &mut self,
        target: &mut T,
        sides: impl Fn(bool) -> Option<Side<'s>>,
    ) -> Result<(), T::Error>
    where
        F: PixelFormat,
        T: DrawTarget<Color = F::Color>,
    {
        let posed = self.posed.as_ref();
        let mut direct = Direct::<F, T, RUN>::new(target, posed.map(|posed| &posed.viewport));
        let is_orthographic = posed.is_some_and(|posed| posed.is_orthographic);
        let is_mirrored = posed.is_some_and(|posed| posed.is_mirrored);
        for mut side in [false, true].into_iter().filter_map(sides) {
            side.cull = side.cull.of_mesh(is_mirrored);
            for (corner, [u, v]) in self.corners.iter_mut().zip(side.uv) {
                (corner.u, corner.v) = (u.into(), v.into());
            }
            for half in HALVES {
                match posed {
                    Some(posed) if half.iter().any(|&i| posed.are_cut_off[i]) => {
                        posed.draw_cut(half, &side, &mut direct)?;
                    }
                    _ => {
                        let corners = half.map(|i| &self.corners[i]);
                        direct.draw(corners, side.cull, is_orthographic, &side.shader)?;
                    }
                }
            }
        }
        Ok(())
    }
}

impl Posed {
    /// Draws the pieces of a triangle that crosses a plane or leaves the guard band.
    #[cold]
    #[inline(never)]
    fn draw_cut<F, T, const RUN: usize>(
        &self,
        half: [usize; 3],
        side: &Side<'_>,
        direct: &mut Direct<'_, F, T, RUN>,
    ) -> Result<(), T::Error>
    where
        F: PixelFormat,
        T: DrawTarget<Color = F::Color>,
    {
        let mut corners = [ScreenVertex::default(); MOST_CORNERS];
        let (count, is_folded) = self.cut(half, side, &mut corners);
        let polygon = corners.get(..count).unwrap_or_default();
        if is_folded {
            return direct.draw_folded(polygon, side.cull, self.is_orthographic, &side.shader);
        }
        (0..)
            .map_while(|number| piece(polygon, number))
            .try_for_each(|corners| direct.draw(corners, side.cull, self.is_orthographic, &side.shader))
    }

    /// As [`Clip::cut`].
    #[inline(never)]
    fn cut(&self, half: [usize; 3], side: &Side<'_>, to: &mut [ScreenVertex; MOST_CORNERS]) -> (usize, bool) {
        let triangle = half.map(|i| Vertex { uv: side.uv[i], ..self.vertices[i] });
        set_attributes(triangle.each_ref(), &VertexColors::default(), to);
        self.placing.clipping().map_or((0, false), |(to_clip, clip)| {
            clip.cut(to_clip, triangle.each_ref(), to, &mut Upper::default())
        })
    }
}
