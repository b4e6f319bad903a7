//! Orientation: which way round a triangle runs on the screen, whether that is culled, and its corners in the order of set-up.
//!
//! - In: three screen vertices.
//! - Out: the same clockwise, the nearest first, with twice the area.
//! - Assumes: differences of positions fit the guard band, so that the area fits an i32.

use super::screen::ScreenVertex;

/// Which side of a triangle is left out.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Cull {
    /// Triangles that run clockwise on the screen.
    #[default]
    Back,
    /// Triangles that run counter-clockwise on the screen.
    Front,
    /// None.
    None,
}

impl Cull {
    /// By twice the area, positive clockwise on the screen.
    #[inline]
    pub(crate) fn leaves_out(self, area: i32) -> bool {
        match self {
            _ if area == 0 => true,
            Self::Back => area > 0,
            Self::Front => area < 0,
            Self::None => false,
        }
    }
}

/// A triangle's vertices clockwise on the screen, the nearest first, and twice its area in 1/256 px².
pub(crate) struct Oriented<'a> {
    pub(crate) vertices: [&'a ScreenVertex; 3],
    pub(crate) area: u32,
}

impl<'a> Oriented<'a> {
    /// `None` for a triangle without area or culled.
    #[inline]
    pub(crate) fn new(vertices: [&'a ScreenVertex; 3], cull: Cull) -> Option<Self> {
        let area = area(vertices.map(position));
        (!cull.leaves_out(area)).then(|| Self::of_area(vertices, area))
    }

    /// Of a triangle's [`area`], which is not 0.
    #[inline(always)]
    pub(crate) fn of_area(vertices: [&'a ScreenVertex; 3], area: i32) -> Self {
        Self { vertices: in_order(vertices, area, |vertex| vertex.q.to_bits()), area: area.unsigned_abs() }
    }
}

/// Twice the area of a triangle between positions in 1/16 px, positive clockwise on the screen.
#[inline(always)]
pub(crate) fn area([[ax, ay], [bx, by], [cx, cy]]: [[i32; 2]; 3]) -> i32 {
    (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)
}

/// The corners of a triangle of this [`area`], which is not 0, as set-up takes them: clockwise, the nearest first.
#[inline(always)]
pub(crate) fn in_order<T: Copy>([a, b, c]: [T; 3], area: i32, q: impl Fn(T) -> u32) -> [T; 3] {
    let [b, c] = if area < 0 { [c, b] } else { [b, c] };
    if q(b) > q(a) && q(b) >= q(c) {
        [b, c, a]
    } else if q(c) > q(a) {
        [c, a, b]
    } else {
        [a, b, c]
    }
}

pub(crate) fn position(vertex: &ScreenVertex) -> [i32; 2] {
    [vertex.x.to_bits().into(), vertex.y.to_bits().into()]
}
