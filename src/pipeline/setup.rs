//! Stage 3: what a triangle's spans and pixels need, computed once.
//!
//! An edge function is the signed area of an edge and a point, in 1/256 px²:
//!
//! ```text
//! E_ab(p) = (b.x − a.x)(p.y − a.y) − (b.y − a.y)(p.x − a.x)
//! ```
//!
//! Divided by the triangle's own area it is the barycentric weight of the corner opposite. In a guard
//! band 2047 px wide no difference exceeds 2047·16 = 32752, so no edge function exceeds
//! 2·32752² = 2 145 387 008 < 2³¹: they are exact in an `i32`.
//!
//! # Attributes, and why they are exact enough
//!
//! After projection u is not linear on the screen, but q and u·q are. Both are held as integers
//! that use all bits of this triangle's range: q scaled so that the nearest corner has 31 bits, and
//! U = (u − u₀)·q with 30, u₀ being the u of the **nearest** corner. With d the triangle's extent in pixels
//! and M the largest change of u per pixel step at p:
//!
//! - u is a quotient of linear functions, so u(corner) − u(p) = (q(p)/q(corner)) · ∇u(p)·(corner − p):
//!   |u₀ − u(p)| ≤ 2·M·d · q(p)/q₀, and |U(corner)| ≤ 4·M·d · q(p).
//! - An error of k units in q (of 2⁻³⁰·q₀ or less) moves u by k·2⁻³⁰·q₀·|u₀ − u|/q ≤ k·2⁻²⁹·M·d.
//! - An error of k units in U (of 2⁻²⁹·max|U|) moves u by k·2⁻²⁹·max|U|/q ≤ k·2⁻²⁷·M·d.
//! - The reciprocal's 2⁻²⁰ moves u by 2⁻¹⁹·M·d; the 17 bits of it that the default quality takes, by 2⁻¹⁶·M·d, 0.031 px at most.
//!
//! Each is kept as a plane: a value at pixel (0, 0) and one rounded step a column and a row, **in wrapping
//! integers**. What the plane says far outside the triangle wraps, and wraps back: inside, where the true value fits 32
//! bits, only the rounding of the steps remains, k ≤ (n + m)/2 + 16 after n columns and m rows from the nearest corner (or
//! from where the screen begins, if it lies outside). With n, m ≤ 1023 and d ≤ 2047 the sum of all is 0.024 px in the very
//! worst case for any ratio of w, and measured a tenth of it.
//!
//! In a sliver the steps are large and nearly cancel, and where distances differ more than 4096-fold q has too few bits at
//! the far corner for [`Exact`](super::Exact). Then a plane holds the values at the corners instead, and is
//! evaluated by weights from the exact edge functions, which never cancel; `Exact` mixes attributes at every pixel, by weights
//! from the exact products of edge functions and q. Both are slower, rare, and out of line.

use super::attribute::Attribute;
use super::clip::ScreenVertex;
use super::color::is_gray;
use super::patch::STRAIGHT;
use super::shade::Inputs;
use super::straight::{Bend, Straight};
use crate::math::recip::Reciprocal;
use crate::num::{mul_high, mul_round, shift_round, wide};

/// Which side of a triangle is left out.
///
/// Of a mesh that is seen in a mirror (its pose or the camera's [is mirrored](crate::Pose::is_mirrored), but not both) fronts are
/// those that run clockwise on the screen: what is outside stays outside.
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
    /// What to leave out of a mesh of which a mirror image may be seen, so that its fronts are clockwise on the screen.
    #[inline]
    pub(super) fn of_mesh(self, is_mirrored: bool) -> Self {
        match self {
            Self::Back if is_mirrored => Self::Front,
            Self::Front if is_mirrored => Self::Back,
            _ => self,
        }
    }

    /// By twice the area, positive clockwise on the screen.
    #[inline]
    pub(super) fn leaves_out(self, area: i32) -> bool {
        match self {
            _ if area == 0 => true,
            Self::Back => area > 0,
            Self::Front => area < 0,
            Self::None => false,
        }
    }
}

/// The most attributes that a shader can read: u, v, red, green, blue.
pub(super) const ATTRIBUTES: usize = 5;

/// A triangle ready to be cut into spans: corners clockwise on the screen, the nearest first.
#[derive(Debug)]
pub(crate) struct TriangleSetup {
    /// x and y in 1/16 px.
    pub(super) corners: [[i32; 2]; 3],
    /// 1 / (twice the area in 1/256 px²); not of small triangles.
    area: Reciprocal,
    /// Whether all colours at the corners are greys, so that one channel stands for three.
    pub(super) gray: bool,
    /// Whether planes hold values at corners: a sliver, or of very different distances.
    pub(super) sliver: bool,
    /// Whether it is set up as a small one: no sliver, and its depth never below 1 of 2¹⁶.
    pub(super) is_small: bool,
    /// Whether attributes are linear on the screen, or nearly, or with what they bend by: planes hold them as they are.
    pub(super) straight: bool,
    /// near/w with 31 fraction bits; for depth.
    pub(super) z: Plane,
    /// near/w scaled to 31 bits; for the division. Not of straight triangles.
    pub(super) q: Plane,
    /// Of a bent triangle: how many steps along a row attributes are nearly linear.
    pub(super) longest: i32,
    /// The least q of the corners.
    pub(super) q_min: u32,
    pub(super) attributes: [Attribute; ATTRIBUTES],
}

const _: () = assert!(size_of::<TriangleSetup>() <= 304);

/// A linear function on the screen, in integers that wrap.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Plane {
    /// At pixel (0, 0); of a sliver, at corner 0.
    pub(super) origin: u32,
    /// One column to the right, one row down; of a sliver, from corner 0 to corners 1 and 2.
    pub(super) steps: [i32; 2],
}

/// How weights of corners 1 and 2 change over the screen, and where planes begin: for set-up only.
struct Slopes {
    /// Over one column, over one row, in units of 2^−(32 + `fraction_bits`).
    of_weights: [[i32; 2]; 2],
    fraction_bits: i32,
    /// Corner 0's pixel.
    pixel: [i32; 2],
    /// From corner 0 to the centre of that pixel, −7 … 8 sixteenths.
    to_center: [i32; 2],
    /// From that pixel to the nearest on the screen.
    to_screen: [i32; 2],
}

/// What a shader wants of a triangle.
pub(super) struct Needs {
    pub(super) inputs: Inputs,
    pub(super) straight: Straight,
    /// Whether it divides at every pixel.
    pub(super) every_pixel: bool,
    /// u and v are multiplied by 2^this, 0 … 8.
    pub(super) texture_scale: u32,
    /// Whether depth is tested.
    pub(super) depth: bool,
    /// Whether all colours are known to be grey.
    pub(super) gray: bool,
}

impl Needs {
    /// Hands on the attributes in use, with the corners' values in I16F16 and the scale's log₂, until one returns false: u and
    /// v, then colours, of which there is one in a grey triangle.
    #[inline]
    pub(super) fn each_attribute(
        &self,
        triangle: &Oriented<'_>,
        gray: bool,
        mut set: impl FnMut(usize, [i32; 3], u32) -> bool,
    ) -> bool {
        let vertices = triangle.vertices;
        let uv = matches!(self.inputs, Inputs::Uv | Inputs::UvColor);
        let color = matches!(self.inputs, Inputs::Color | Inputs::UvColor);
        let first = if uv { 0 } else { 2 };
        let end = if !color {
            2
        } else if gray {
            3
        } else {
            5
        };
        (first..end).all(|i| {
            let at = |vertex: &ScreenVertex| match i {
                0 => vertex.u.to_bits(),
                1 => vertex.v.to_bits(),
                _ => i32::from(vertex.color[i - 2].to_bits()) << 8,
            };
            set(i - first, vertices.map(at), if i < 2 { self.texture_scale } else { 0 })
        })
    }
}

/// A triangle's vertices clockwise on the screen, the nearest first, and twice its area in 1/256 px².
pub(super) struct Oriented<'a> {
    pub(super) vertices: [&'a ScreenVertex; 3],
    pub(super) area: u32,
}

impl<'a> Oriented<'a> {
    /// `None` for a triangle without area or culled.
    #[inline]
    pub(super) fn new(vertices: [&'a ScreenVertex; 3], cull: Cull) -> Option<Self> {
        let area = area(vertices.map(position));
        (!cull.leaves_out(area)).then(|| Self::of_area(vertices, area))
    }

    /// Of a triangle's [`area`], which is not 0.
    #[inline(always)]
    pub(super) fn of_area(vertices: [&'a ScreenVertex; 3], area: i32) -> Self {
        Self { vertices: in_order(vertices, area, |vertex| vertex.q.to_bits()), area: area.unsigned_abs() }
    }
}

/// Twice the area of a triangle between positions in 1/16 px, positive clockwise on the screen.
#[inline(always)]
pub(super) fn area([[ax, ay], [bx, by], [cx, cy]]: [[i32; 2]; 3]) -> i32 {
    (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)
}

/// The corners of a triangle of this [`area`], which is not 0, as set-up takes them: clockwise, the nearest first.
#[inline(always)]
pub(super) fn in_order<T: Copy>([a, b, c]: [T; 3], area: i32, q: impl Fn(T) -> u32) -> [T; 3] {
    let [b, c] = if area < 0 { [c, b] } else { [b, c] };
    if q(b) > q(a) && q(b) >= q(c) {
        [b, c, a]
    } else if q(c) > q(a) {
        [c, a, b]
    } else {
        [a, b, c]
    }
}

impl TriangleSetup {
    /// Of no triangle. (One is used for all triangles of a draw: setting it to zero takes 240 cycles.)
    pub(super) fn new() -> Self {
        Self {
            corners: [[0; 2]; 3],
            area: Reciprocal { mantissa: 0, zeros: 0 },
            gray: false,
            sliver: false,
            is_small: false,
            straight: false,
            z: Plane::default(),
            q: Plane::default(),
            longest: 0,
            q_min: 0,
            attributes: [Attribute::default(); ATTRIBUTES],
        }
    }

    #[inline]
    pub(super) fn set(&mut self, triangle: &Oriented<'_>, needs: &Needs, simple: bool) {
        self.sliver = false;
        self.is_small = true;
        self.longest = STRAIGHT;
        if needs.inputs == Inputs::None && !needs.depth {
            self.straight = true;
            return;
        }
        if matches!(needs.inputs, Inputs::Color | Inputs::UvColor) {
            self.gray = needs.gray || triangle.vertices.into_iter().all(|vertex| is_gray(vertex.color));
        }
        if !self.set_small_planes(triangle, needs, simple) {
            self.set_any_planes(triangle, needs);
        }
    }

    #[inline(never)]
    fn set_any_planes(&mut self, triangle: &Oriented<'_>, needs: &Needs) {
        self.is_small = false;
        let vertices = triangle.vertices;
        self.area = Reciprocal::precise(triangle.area);
        let slopes = self.slopes(triangle.area);
        let near_w = vertices.map(|vertex| vertex.q.to_bits());
        // The nearest corner gets all 31 bits.
        let q = near_w.map(|q| q.clamp(1, i32::MAX as u32));
        let q = q.map(|near_w| near_w << (q[0].leading_zeros() - 1));
        self.q_min = q[1].min(q[2]);
        // Where the far corner is left with few of them, the rounding of steps would be too much for `Exact`: no planes.
        let is_perspective = matches!(needs.straight, Straight::Below(_));
        self.sliver |= needs.every_pixel && self.q_min < 1 << 19 && is_perspective;
        if needs.depth {
            // Depth must not wrap where rounding takes it out of 0 … 2³¹: 2048 units, 1/16 of a depth step, are room
            // for that.
            let z = near_w.map(|q| q.clamp(2048, (1 << 31) - 2048));
            self.z = self.plane(&slopes, z[0], [1, 2].map(|i| z[i].wrapping_sub(z[0]) as i32));
        }
        if needs.inputs == Inputs::None {
            self.straight = true;
            return;
        }
        self.straight = match needs.straight {
            Straight::Always => true,
            Straight::Below(limit) => {
                Bend::new(&edges(&self.corners), q, self.q_min).is_some_and(|bend| bend.is_straight(limit))
            }
        };
        if !self.straight {
            self.q = self.plane(&slopes, q[0], [1, 2].map(|i| q[i].wrapping_sub(q[0]) as i32));
        }
        let mixed = self.sliver && needs.every_pixel;
        needs.each_attribute(triangle, self.gray, |i, at, scale_log2| {
            self.attributes[i] = self.attribute(&slopes, at, scale_log2, &q, mixed);
            true
        });
    }

    /// A plane's value at a pixel's centre, and its step to the right. Inside the triangle only.
    #[inline]
    pub(super) fn at(&self, plane: &Plane, x: i32, y: i32) -> (u32, i32) {
        let [right, down] = plane.steps;
        if self.sliver {
            return self.at_in_sliver(plane, x, y);
        }
        (plane.origin.wrapping_add_signed(x.wrapping_mul(right).wrapping_add(y.wrapping_mul(down))), right)
    }

    /// By weights: exact edge functions times 1/area.
    #[cold]
    #[inline(never)]
    fn at_in_sliver(&self, plane: &Plane, x: i32, y: i32) -> (u32, i32) {
        let [[ax, ay], [bx, by], [cx, cy]] = self.corners;
        let (px, py) = (x * 16 + 8 - ax, y * 16 + 8 - ay);
        let weighted = |edge_function: i32, rise: i32| {
            // Up to the area: below 2³¹ after this shift, and 1/area has as many zeros.
            let weight = wide(edge_function << (self.area.zeros - 1), self.area.mantissa) >> 30;
            mul_round::<31>(weight.min(i64::from(i32::MAX)) as i32, rise)
        };
        let [b, c] = plane.steps;
        let value = plane
            .origin
            .wrapping_add_signed(weighted((ax - cx) * py - (ay - cy) * px, b))
            .wrapping_add_signed(weighted((bx - ax) * py - (by - ay) * px, c));
        // 16 · (b·(y₂ − y₀) − c·(y₁ − y₀)) / area, with 31 bits of the sum. It may be too large for an i32: then no span has
        // two pixels, since the value stays within 32 bits.
        let sum = wide(cy - ay, b) - wide(by - ay, c);
        let magnitude = sum.unsigned_abs();
        let excess = 33u32.saturating_sub(magnitude.leading_zeros());
        let product = wide((magnitude >> excess) as i32, self.area.mantissa);
        let step = shift_round(product, 58 - self.area.zeros - excess).min(i64::from(i32::MAX)) as i32;
        (value, if sum < 0 { -step } else { step })
    }

    /// The first `N` attributes of a sliver at a pixel's centre, I16F16, with weights edge function · q / sum of both
    /// at each corner: exact products, divided to 30 bits.
    #[cold]
    #[inline(never)]
    pub(super) fn resolve_in_sliver<const N: usize>(
        &self,
        attributes: &[Attribute; N],
        x: i32,
        y: i32,
    ) -> [i32; N] {
        let [[ax, ay], [bx, by], [cx, cy]] = self.corners;
        let (px, py) = (x * 16 + 8 - ax, y * 16 + 8 - ay);
        let (b, c) = ((ax - cx) * py - (ay - cy) * px, (bx - ax) * py - (by - ay) * px);
        let a = (bx - ax) * (cy - ay) - (by - ay) * (cx - ax) - b - c;
        let q = |rise: i32| self.q.origin.wrapping_add_signed(rise) as i32;
        // Together at most area · 2³¹.
        let (b, c) = (wide(b, q(self.q.steps[0])), wide(c, q(self.q.steps[1])));
        let sum = (wide(a, q(0)) + b + c).max(1);
        // Their upper 31 bits.
        let excess = 33 - sum.leading_zeros() as i32;
        let upper = |product: i64| (if excess >= 0 { product >> excess } else { product << -excess }) as i32;
        let reciprocal = Reciprocal::precise(upper(sum) as u32);
        let weights = [b, c].map(|product| {
            let weight = wide(upper(product), reciprocal.mantissa) >> 30;
            weight.min(i64::from(i32::MAX)) as i32
        });
        attributes.each_ref().map(|attribute| {
            let [b, c] = attribute.plane.steps;
            attribute.finish(mul_round::<31>(weights[0], b) + mul_round::<31>(weights[1], c))
        })
    }

    /// Finds out whether it is a sliver, too.
    fn slopes(&mut self, area: u32) -> Slopes {
        let (edges, a) = (edges(&self.corners), self.corners[0]);
        let spread = |e: [i32; 2]| (e[0].abs() + e[1].abs()) as u32; // below 2¹⁶
        let (height, width) = (spread(edges[0]), spread(edges[1]));
        // The largest difference to 30 bits, times 1/area.
        let largest = edges.as_flattened().iter().fold(1, |all, e| all | e.unsigned_abs());
        let shift = largest.leading_zeros() - 2;
        // Steps must fit 32 bits: at least a pixel wide and high. And their errors, three units of 2^−`fraction_bits` a
        // pixel, must not exceed 512 units over the triangle's extent of 2^(30 − `shift`) sixteenths.
        self.sliver = height.max(width) * 16 > area || 2 * shift < 23 + self.area.zeros;
        let pixel = a.map(|at| at >> 4);
        Slopes {
            of_weights: edges.map(|edge| edge.map(|e| (wide(e << shift, self.area.mantissa) >> 31) as i32)),
            // (e·2^shift · mantissa / 2³¹) · 2^−(32 + n) = 16·e·mantissa·2^(zeros − 62)
            fraction_bits: shift as i32 - 5 - self.area.zeros as i32,
            pixel,
            to_center: [pixel[0] * 16 + 8 - a[0], pixel[1] * 16 + 8 - a[1]],
            to_screen: pixel.map(|at| at.clamp(0, 1023) - at),
        }
    }

    /// From the value at corner 0 and the rise from there to corners 1 and 2.
    #[inline(never)]
    fn plane(&self, slopes: &Slopes, origin: u32, rise: [i32; 2]) -> Plane {
        if self.sliver {
            return Plane { origin, steps: rise };
        }
        let mut plane = Plane { origin, steps: [0; 2] };
        for axis in 0..2 {
            let [b, c] = slopes.of_weights[axis];
            let slope = mul_high(rise[0], b).wrapping_add(mul_high(rise[1], c));
            let bits = slopes.fraction_bits;
            let (step, rest) = if bits > 0 {
                let step = ((slope >> (bits - 1)) + 1) >> 1;
                // What rounding leaves, with at most 12 of its bits, over as far as the screen is away.
                let rest = slope.wrapping_sub(step << bits);
                (
                    step,
                    if bits > 12 {
                        ((rest >> (bits - 12)) * slopes.to_screen[axis]) >> 12
                    } else {
                        (rest * slopes.to_screen[axis]) >> bits
                    },
                )
            } else {
                (slope << -bits, 0)
            };
            plane.steps[axis] = step;
            plane.origin = plane
                .origin
                .wrapping_add_signed((step >> 4) * slopes.to_center[axis])
                .wrapping_sub((slopes.pixel[axis].wrapping_mul(step)) as u32)
                .wrapping_add_signed(rest);
        }
        plane
    }

    /// An attribute from its I16F16 values at the corners (within ±2²⁹), and q there; `mixed` for
    /// [`resolve_in_sliver`](Self::resolve_in_sliver).
    #[inline(never)]
    fn attribute(
        &self,
        slopes: &Slopes,
        at: [i32; 3],
        scale_log2: u32,
        q: &[u32; 3],
        mixed: bool,
    ) -> Attribute {
        let (mut attribute, rise) = Attribute::between(at, scale_log2);
        if self.straight || mixed {
            let origin = if mixed && !self.straight { 0 } else { attribute.origin() };
            attribute.plane = self.plane(slopes, origin, rise);
            return attribute;
        }
        let products = [wide(rise[0], q[1] as i32), wide(rise[1], q[2] as i32)];
        let largest = products[0].unsigned_abs() | products[1].unsigned_abs();
        // 30 bits of the larger, and not quite 2³⁰.
        let exponent = 34u32.saturating_sub((largest + (largest >> 15)).leading_zeros()).max(1);
        let scaled = products.map(|product| shift_round(product, exponent) as i32);
        attribute.plane = self.plane(slopes, 0, scaled);
        attribute.shift = 32 - exponent as i32;
        attribute
    }
}

/// By how much the edge functions of corners 1 and 2 change a column, and a row, of 1/16 px.
#[inline]
pub(super) fn edges([a, b, c]: &[[i32; 2]; 3]) -> [[i32; 2]; 2] {
    [[c[1] - a[1], a[1] - b[1]], [a[0] - c[0], b[0] - a[0]]]
}

pub(super) fn position(vertex: &ScreenVertex) -> [i32; 2] {
    [vertex.x.to_bits().into(), vertex.y.to_bits().into()]
}
