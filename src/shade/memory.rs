//! Memory that triangles are drawn to: words of pixels and of depths, and the rows that are drawn.
//!
//! - In: a band's memory.
//! - Out: the same, whatever its formats; or as that of known formats, if it is.
//! - Assumes: the rows lie in the window, and that in the memory.
//!
//! Loops of [`Rgb565`](embedded_graphics::pixelcolor::Rgb565) and [`Depth16`](crate::Depth16) take memory of these formats, and have no
//! type parameters: so they are compiled with this crate, at its level of optimisation and not at that of the program.

use crate::frame::{DepthFormat, OfWords, PixelFormat, Window};
use crate::raster::Rows;
use core::marker::PhantomData;

/// The rows of the triangle that is set up, within a window of a band's memory: words of pixels and of depths.
#[doc(hidden)]
#[expect(missing_debug_implementations, reason = "it is passed on at once")]
pub struct Memory<'a, P, Z> {
    pub(crate) rows: Rows,
    pub(crate) window: Window,
    /// The index of column 0 of row 0 among `pixels`, which wraps as it may lie before them. A row further it is `width` more.
    pub(crate) origin: usize,
    pub(crate) width: usize,
    pub(crate) pixels: &'a mut [P],
    /// Empty if it is never tested.
    pub(crate) depth: &'a mut [Z],
}

impl<'a, P: 'static, Z: 'static> Memory<'a, P, Z> {
    /// Of one row without depths, whose words begin at a column.
    pub(crate) fn of_row(rows: Rows, window: Window, column: i32, pixels: &'a mut [P]) -> Self {
        Self { rows, window, origin: (column as usize).wrapping_neg(), width: 0, pixels, depth: &mut [] }
    }

    /// The same, if its formats are [`Rgb565`](embedded_graphics::pixelcolor::Rgb565) and [`Depth16`](crate::Depth16).
    #[inline(always)]
    pub(super) fn in_rgb565<F, D>(&mut self) -> Option<&mut Memory<'a, u16, u16>>
    where
        F: PixelFormat<Word = P>,
        D: DepthFormat<Word = Z>,
    {
        F::in_rgb565::<OfPixels<'_, 'a, Z>>(self).and_then(D::in_depth16::<OfDepths<'_, 'a>>)
    }
}

/// Memory of any pixels, and memory of any depths.
struct OfPixels<'m, 'a, Z>(PhantomData<&'m mut &'a mut [Z]>);
struct OfDepths<'m, 'a>(PhantomData<&'m mut &'a mut [u16]>);

impl<'m, 'a: 'm, Z: 'a> OfWords for OfPixels<'m, 'a, Z> {
    type Of<W: 'static> = &'m mut Memory<'a, W, Z>;
}

impl<'m, 'a: 'm> OfWords for OfDepths<'m, 'a> {
    type Of<W: 'static> = &'m mut Memory<'a, u16, W>;
}
