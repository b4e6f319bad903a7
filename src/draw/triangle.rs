//! One triangle on the screen: set-up, rows, depth and shading, down to the words in a band.
//!
//! - In: three screen vertices.
//! - Out: words and depths in the band, within a window of it.
//! - Assumes: the vertices lie in the guard band.

use crate::frame::{Band, DepthFormat, PixelFormat, Window};
use crate::geometry::{
    Clipped, Count, Cull, Oriented, RangeError, ScreenVertex, VertexCache, area, position,
};
use crate::raster::{Needs, Rows, Runs, TriangleSetup};
use crate::shade::{Cover, InFog, Look, Memory, Surface, Target};

/// Draws one triangle that is on the screen already: the door for callers with their own vertices.
///
/// Positions within ±1023½ px may be given: columns and rows −1023 … 1022 lie inside. Only the rows of `band` are drawn, and only
/// what `cull` does not leave out.
///
/// ```
/// use fixel::embedded_graphics::{pixelcolor::Rgb565, prelude::*};
/// use fixel::num::U1F31;
/// use fixel::{Band, Cull, Depth16, Material, ScreenVertex, draw_triangle};
/// let at = |x: &str, y: &str| ScreenVertex {
///     x: x.parse().unwrap(), // pixels, in steps of 1/16
///     y: y.parse().unwrap(),
///     q: U1F31::lit("0.5"), // twice as far away as the near plane
///     ..Default::default()
/// };
/// let (mut pixels, mut depth) = ([0; 16 * 16], [0; 16 * 16]);
/// let mut band = Band::<Rgb565, Depth16>::new(Size::new(16, 16), &mut pixels, &mut depth)?;
/// let corners = [at("0", "0"), at("0", "12.5"), at("12.5", "0")]; // counter-clockwise: the front
/// draw_triangle(&corners, Cull::Back, &Material::flat(Rgb565::CSS_GOLD), &mut band)?;
/// assert_eq!(band.depth()[0], 1 << 15); // near/w in 16 bits
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
///
/// [`RangeError`] if a vertex lies outside the guard band of ±1023½ px or a texture coordinate beyond ±8192
/// texels; nothing is drawn then.
pub fn draw_triangle<'a, F: PixelFormat, D: DepthFormat>(
    vertices: &[ScreenVertex; 3],
    cull: Cull,
    surface: impl Into<Surface<'a, F, D>>,
    band: &mut Band<'_, F, D>,
) -> Result<(), RangeError> {
    if !vertices.iter().all(ScreenVertex::in_range) {
        return Err(RangeError);
    }
    let window = band.window();
    Raster::new((&surface.into().look, None), [false; 2], window, band).draw(vertices.each_ref(), cull);
    Ok(())
}

/// The stages from set-up on.
pub(crate) struct Raster<'a, F: PixelFormat, D: DepthFormat> {
    look: &'a Look<'a, F, D>,
    pub(super) needs: Needs,
    pub(super) setup: TriangleSetup,
    pub(super) target: Target<'a, F, D>,
}

impl<'a, F: PixelFormat, D: DepthFormat> Raster<'a, F, D> {
    /// For a camera that may be orthographic, and colours that may all be grey.
    ///
    /// Not inlined: it takes as much of the caller's stack as it returns, and no more.
    #[inline(never)]
    pub(crate) fn new(
        (look, fog): (&'a Look<'a, F, D>, Option<&'a InFog<'a, F, D>>),
        kind: [bool; 2],
        window: Window,
        band: &'a mut Band<'_, F, D>,
    ) -> Self {
        let needs = look.needs(kind, fog.is_some());
        let (top, width) = (usize::from(band.top), usize::from(band.width));
        let mut raster = Self {
            look,
            needs,
            setup: TriangleSetup::new(),
            target: Target {
                memory: Memory {
                    rows: Rows::NONE,
                    window,
                    origin: 0usize.wrapping_sub(top * width),
                    width,
                    pixels: band.pixels,
                    depth: band.depth,
                },
                layers: &look.layers,
                fog,
            },
        };
        // Here: inside of `new` it would split what is set to zero, and link two more routines.
        raster.setup.forget_longest();
        raster
    }

    /// The same for another surface, perhaps in fog, and window.
    pub(crate) fn change(
        &mut self,
        (look, fog): (&'a Look<'a, F, D>, Option<&'a InFog<'a, F, D>>),
        kind: [bool; 2],
        window: Window,
    ) {
        (self.look, self.target.layers) = (look, &look.layers);
        (self.target.fog, self.target.memory.window) = (fog, window);
        self.needs = look.needs(kind, fog.is_some());
        self.setup.forget_longest();
    }

    #[inline]
    pub(crate) fn draw(&mut self, vertices: [&ScreenVertex; 3], cull: Cull) {
        if let Some(triangle) = Oriented::new(vertices, cull) {
            self.draw_oriented(&triangle);
        }
    }

    /// A triangle that is clockwise on the screen. False if it has no pixels in the window.
    #[inline]
    pub(crate) fn draw_clockwise(&mut self, vertices: [&ScreenVertex; 3]) -> bool {
        let area = area(vertices.map(position)) as u32;
        self.draw_oriented(&Oriented { vertices, area })
    }

    /// A triangle that is not culled. False if it has no pixels in the window.
    #[inline(always)]
    pub(crate) fn draw_oriented(&mut self, triangle: &Oriented<'_>) -> bool {
        let Self { needs, setup, target, .. } = self;
        let Memory { rows, window, .. } = &mut target.memory;
        let is_seen = setup.prepare(rows, triangle, window, needs);
        if is_seen {
            self.paint();
        }
        is_seen
    }

    /// One that is clockwise, not small, and set up already.
    #[inline]
    pub(super) fn draw_set_up(&mut self, vertices: [&ScreenVertex; 3]) -> bool {
        let Memory { rows, window, .. } = &mut self.target.memory;
        let is_seen = rows.start_any(vertices, window);
        if is_seen {
            self.paint();
        }
        is_seen
    }

    /// The triangle that is set up, in its rows.
    #[inline]
    pub(super) fn paint(&mut self) {
        let Self { look, setup, target, .. } = self;
        look.paint(Cover { setup, target });
    }

    /// A polygon that is folded.
    #[cold]
    #[inline(never)]
    pub(crate) fn draw_folded(&mut self, polygon: &[ScreenVertex], cull: Cull) {
        let mut runs = Runs::new(polygon, &self.target.memory.window);
        while let Some((run, corners)) = runs.next(polygon) {
            self.target.memory.window = run;
            self.draw(corners, cull);
        }
        self.target.memory.window = runs.window();
    }

    /// Goes on to the next run of the folded polygon in a mesh's cache, and to a window that is just that. Where there is none, the
    /// polygon is done. It counts as drawn if it has any.
    #[cold]
    #[inline(never)]
    pub(crate) fn find_run(
        &mut self,
        cache: &mut VertexCache<'_>,
        cull: Cull,
        runs: &mut Option<Runs>,
        stats: &mut impl Count,
    ) {
        let polygon = cache.polygon();
        let mut is_first = runs.is_none();
        let found = runs.get_or_insert_with(|| Runs::new(polygon, &self.target.memory.window));
        while let Some((run, corners)) = found.next(polygon) {
            if core::mem::take(&mut is_first) {
                stats.count(|stats| &mut stats.drawn);
            }
            if !cull.leaves_out(area(corners.map(position))) {
                self.target.memory.window = run;
                return cache.set_piece(found.number());
            }
        }
        if is_first {
            stats.count(|stats| &mut stats.out_of_sight);
        }
        self.target.memory.window = found.window();
        (*runs, cache.clipped) = (None, Clipped::None);
    }
}
