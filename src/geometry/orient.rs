//! Winding and culling: the sign of a triangle's area, whether it is culled, and its corners in the order of set-up.
//!
//! - In: three screen vertices.
//! - Out: the same clockwise, the nearest first, with twice the area; or none, if the triangle is culled.
//! - Assumes: the vertices lie in the guard band, so that twice the area fits an i32.
//!
//! Front faces run counter-clockwise on the screen. Set-up wants clockwise corners, so those of front faces are swapped. An
//! `area` is always twice the area here, in 1/256 px², and positive if the corners run clockwise.

use super::screen::ScreenVertex;

/// Which triangles are culled, that is, not drawn because of the way they face. Front faces run counter-clockwise on the screen.
/// Triangles without area are always culled.
///
/// Of a mesh that is seen in a mirror (its pose or the camera's [is mirrored](crate::Pose::is_mirrored), but not both) fronts are
/// those that run clockwise on the screen: what is outside stays outside.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Cull {
    /// Back faces: triangles that run clockwise on the screen.
    #[default]
    Back,
    /// Front faces: triangles that run counter-clockwise on the screen.
    Front,
    /// Neither.
    None,
}

impl Cull {
    /// What to leave out of a mesh of which a mirror image may be seen, so that its fronts are clockwise on the screen.
    #[inline]
    pub(crate) fn of_mesh(self, is_mirrored: bool) -> Self {
        match self {
            Self::Back if is_mirrored => Self::Front,
            Self::Front if is_mirrored => Self::Back,
            _ => self,
        }
    }

    /// Whether a triangle of this [`area`] is culled.
    #[inline]
    pub(crate) fn leaves_out(self, area: i32) -> bool {
        match self {
            Self::Back => area >= 0,
            Self::Front => area <= 0,
            Self::None => area == 0,
        }
    }
}

/// A triangle's vertices clockwise on the screen, and twice its area in 1/256 px².
pub(crate) struct Oriented<'a> {
    pub(crate) vertices: [&'a ScreenVertex; 3],
    pub(crate) area: u32,
}

impl<'a> Oriented<'a> {
    /// `None` if the triangle is culled.
    #[inline]
    pub(crate) fn new(vertices: [&'a ScreenVertex; 3], cull: Cull) -> Option<Self> {
        let area = area(vertices.map(position));
        (!cull.leaves_out(area)).then(|| Self::of_area(vertices, area))
    }

    /// A triangle that is not culled, and its [`area`].
    #[inline(always)]
    pub(crate) fn of_area(vertices: [&'a ScreenVertex; 3], area: i32) -> Self {
        Self { vertices: clockwise(vertices, area), area: area.unsigned_abs() }
    }
}

/// Twice the area of a triangle, in 1/256 px², from positions in 1/16 px; positive if they run clockwise on the screen.
#[inline(always)]
pub(crate) fn area([[ax, ay], [bx, by], [cx, cy]]: [[i32; 2]; 3]) -> i32 {
    (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)
}

/// A triangle's corners clockwise, by its [`area`], which is not 0.
#[inline(always)]
pub(crate) fn clockwise<T>([a, b, c]: [T; 3], area: i32) -> [T; 3] {
    if area < 0 { [a, c, b] } else { [a, b, c] }
}

/// Corners rotated so that the one with the greatest q is first. Of corners with the same q the earlier one is.
pub(crate) fn nearest_first([a, b, c]: [&ScreenVertex; 3]) -> [&ScreenVertex; 3] {
    if b.q > a.q && b.q >= c.q {
        [b, c, a]
    } else if c.q > a.q {
        [c, a, b]
    } else {
        [a, b, c]
    }
}

/// x and y in 1/16 px.
pub(crate) fn position(vertex: &ScreenVertex) -> [i32; 2] {
    [vertex.x.to_bits().into(), vertex.y.to_bits().into()]
}
