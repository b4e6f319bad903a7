//! A band as embedded-graphics sees it: a target to draw 2D on, and pixels to read.
//!
//! - In: areas and points in the coordinates of the screen, and colours.
//! - Out: the words of those that lie in the band; or, read back, their colours.
//! - Assumes: nothing; what lies outside the band is left alone.

use super::band::Band;
use super::depth::DepthFormat;
use super::format::PixelFormat;
use super::window::{Window, overlap};
use core::convert::Infallible;
use core::ops::Range;
use embedded_graphics::Pixel;
use embedded_graphics::draw_target::DrawTarget;
use embedded_graphics::geometry::{Dimensions, Point};
use embedded_graphics::image::GetPixel;
use embedded_graphics::primitives::Rectangle;

impl<F: PixelFormat, D: DepthFormat> Band<'_, F, D> {
    /// The colours of that part of an area of the screen that lies in the band, row after row.
    pub fn colors_in(&self, area: &Rectangle) -> impl Iterator<Item = F::Color> {
        self.rows_in(area).flatten().map(|&word| F::decode(word))
    }

    /// The rows of words of that part of an area of the screen that lies in the band.
    pub fn rows_in(&self, area: &Rectangle) -> impl Iterator<Item = &[F::Word]> {
        let (columns, rows) = self.within(area).unwrap_or((0..0, 0..0));
        rows.map(move |y| {
            let row = (y - i32::from(self.top)) as usize * usize::from(self.width);
            self.pixels.get(row + columns.start as usize..row + columns.end as usize).unwrap_or_default()
        })
    }

    /// The columns and the rows of an area that lie in the band.
    fn within(&self, area: &Rectangle) -> Option<(Range<i32>, Range<i32>)> {
        let Window { columns, rows } = self.window();
        let columns = overlap(area.top_left.x, area.size.width, columns)?;
        Some((columns, overlap(area.top_left.y, area.size.height, rows)?))
    }

    /// `width` words of row `y` of the screen, from column `x` on. All of them lie in the band.
    fn row_mut(&mut self, x: i32, y: i32, width: u32) -> &mut [F::Word] {
        let start = (y - i32::from(self.top)) as usize * usize::from(self.width) + x as usize;
        self.pixels.get_mut(start..start + width as usize).unwrap_or_default()
    }
}

impl<F: PixelFormat, D: DepthFormat> Dimensions for Band<'_, F, D> {
    fn bounding_box(&self) -> Rectangle {
        Rectangle::new(Point::new(0, self.top.into()), self.size())
    }
}

impl<F: PixelFormat, D: DepthFormat> DrawTarget for Band<'_, F, D> {
    type Color = F::Color;
    type Error = Infallible;

    fn draw_iter<I>(&mut self, pixels: I) -> Result<(), Infallible>
    where
        I: IntoIterator<Item = Pixel<F::Color>>,
    {
        let area = self.bounding_box();
        for Pixel(point, color) in pixels {
            if area.contains(point) {
                self.row_mut(point.x, point.y, 1).fill(F::encode(color));
            }
        }
        Ok(())
    }

    fn fill_contiguous<I>(&mut self, area: &Rectangle, colors: I) -> Result<(), Infallible>
    where
        I: IntoIterator<Item = F::Color>,
    {
        let mut colors = colors.into_iter();
        let Some((columns, rows)) = self.within(area) else {
            return Ok(());
        };
        let inside = (columns.end - columns.start) as u32;
        let width = area.size.width as usize;
        // How many colours lie outside the band before the next row: first those above it and left of it, then, from row to row,
        // those right of it and those left of it in the next row.
        let before = columns.start.wrapping_sub(area.top_left.x) as u32 as usize;
        let above = rows.start.wrapping_sub(area.top_left.y) as u32 as usize;
        let mut gap = above.saturating_mul(width).saturating_add(before);
        for y in rows {
            if gap > 0 && colors.nth(gap - 1).is_none() {
                return Ok(());
            }
            for (word, color) in self.row_mut(columns.start, y, inside).iter_mut().zip(&mut colors) {
                *word = F::encode(color);
            }
            gap = width - inside as usize;
        }
        Ok(())
    }

    fn fill_solid(&mut self, area: &Rectangle, color: F::Color) -> Result<(), Infallible> {
        if let Some((columns, rows)) = self.within(area) {
            for y in rows {
                self.row_mut(columns.start, y, (columns.end - columns.start) as u32).fill(F::encode(color));
            }
        }
        Ok(())
    }

    /// Begins a new picture: all pixels have this colour, and all depths are forgotten.
    ///
    /// `fill_solid` colours an area and keeps its depth, and so does the `clear` of a part: of what
    /// [`clipped`](embedded_graphics::draw_target::DrawTargetExt::clipped) and
    /// [`cropped`](embedded_graphics::draw_target::DrawTargetExt::cropped) return, which embedded-graphics makes a `fill_solid`.
    fn clear(&mut self, color: F::Color) -> Result<(), Infallible> {
        self.pixels.fill(F::encode(color));
        self.clear_depth();
        Ok(())
    }
}

impl<F: PixelFormat, D: DepthFormat> GetPixel for Band<'_, F, D> {
    type Color = F::Color;

    fn pixel(&self, point: Point) -> Option<F::Color> {
        if !self.bounding_box().contains(point) {
            return None;
        }
        let index = (point.y as usize - usize::from(self.top)) * usize::from(self.width) + point.x as usize;
        self.pixels.get(index).map(|&word| F::decode(word))
    }
}
