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
//! - The reciprocal's 2⁻²⁰ moves u by 2⁻¹⁹·M·d.
//!
//! A span starts with weights from the exact edge functions, which never cancel, not even in a
//! sliver, and then adds a rounded step: k ≤ n/2 + 4 after n pixels. With d ≤ 2047 and n ≤ 1023 this is
//! at most 0.02 px in the very worst case for any ratio of w, and a hundredth of it in ordinary ones.
//!
//! A step may be too large for an `i32`. Then no span of the triangle has two pixels, since q and U stay
//! within 2³¹ inside it, and the step is not used.

use super::clip::ScreenVertex;
use super::shade::Inputs;
use crate::math::recip::Reciprocal;
use crate::num::{mul_round, shift_round, wide};

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

/// The most attributes that a shader can read: u, v, red, green, blue.
pub(super) const ATTRIBUTES: usize = 5;

/// A triangle ready to be cut into spans: corners clockwise on the screen, the nearest first.
#[derive(Debug)]
pub(crate) struct TriangleSetup {
    /// x and y in 1/16 px.
    pub(super) corners: [[i32; 2]; 3],
    /// 1 / (twice the area in 1/256 px²).
    area: Reciprocal,
    /// near/w with 31 fraction bits; for depth.
    pub(super) z: Plane,
    /// near/w scaled to 31 bits; for the division. All the same without perspective.
    pub(super) q: Plane,
    /// The least q of the corners.
    pub(super) q_min: u32,
    pub(super) attributes: [Attribute; ATTRIBUTES],
}

/// A linear function on the screen.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Plane {
    /// At corner 0, as an unsigned number.
    origin: u32,
    /// From corner 0 to corners 1 and 2.
    rise: [i32; 2],
    /// One pixel to the right.
    pub(super) step: i32,
}

/// (u − u₀)·q, and the way back to u.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Attribute {
    /// (u − u₀)·q at corners 1 and 2 (it is 0 at corner 0), in units of 2^`exponent` · (I16F16 · unit of q).
    rise: [i32; 2],
    /// One pixel to the right.
    pub(super) step: i32,
    exponent: i32,
    /// u₀, I16F16.
    base: i32,
    /// The range of u − u₀ at the corners, I16F16.
    low: i32,
    high: i32,
    /// What comes out is times 2^this, modulo 2³².
    scale_log2: u32,
}

impl Attribute {
    /// (u − u₀)·q where the weights are taken.
    #[inline]
    pub(super) fn at(&self, weights: Weights) -> i32 {
        weights.of(self.rise)
    }

    /// The attribute in I16F16 from its plane's value and 1/q; never outside the corners' range.
    #[inline]
    pub(super) fn resolve(&self, value: i32, q: Reciprocal) -> i32 {
        let product = ((wide(value, q.mantissa) + (1 << 31)) >> 32) as i32; // below 2³⁰
        let exponent = self.exponent + q.zeros as i32 - 30;
        let offset = if exponent < 0 {
            let shift = (-exponent).min(31) as u32;
            ((product >> (shift - 1)) + 1) >> 1
        } else {
            let exponent = exponent.min(31);
            product.clamp(self.low >> exponent, self.high >> exponent) << exponent
        };
        (self.base + offset.clamp(self.low, self.high)) << self.scale_log2
    }
}

/// Barycentric weights of corners 1 and 2, 1.0 = 2³¹ (saturated).
#[derive(Clone, Copy, Debug)]
pub(super) struct Weights([i32; 2]);

const _: () = assert!(size_of::<TriangleSetup>() == 228);

impl Plane {
    /// The value where the weights are taken.
    #[inline]
    pub(super) fn at(&self, weights: Weights) -> u32 {
        self.origin.wrapping_add_signed(weights.of(self.rise))
    }
}

impl Weights {
    #[inline]
    fn of(self, rise: [i32; 2]) -> i32 {
        mul_round::<31>(self.0[0], rise[0]).wrapping_add(mul_round::<31>(self.0[1], rise[1]))
    }
}

/// What a shader wants of a triangle.
pub(super) struct Needs {
    pub(super) inputs: Inputs,
    pub(super) perspective: bool,
    /// u and v are multiplied by 2^this, 0 … 8.
    pub(super) texture_scale: u32,
}

/// A triangle's vertices clockwise on the screen, the nearest first, and twice its area in 1/256 px².
pub(super) struct Oriented<'a> {
    pub(super) vertices: [&'a ScreenVertex; 3],
    area: u32,
}

impl<'a> Oriented<'a> {
    /// `None` for a triangle without area or culled.
    #[inline]
    pub(super) fn new([a, b, c]: &'a [ScreenVertex; 3], cull: Cull) -> Option<Self> {
        let ([ax, ay], [bx, by], [cx, cy]) = (position(a), position(b), position(c));
        let area = (bx - ax) * (cy - ay) - (by - ay) * (cx - ax); // positive: clockwise on the screen
        match cull {
            _ if area == 0 => return None,
            Cull::Back if area > 0 => return None,
            Cull::Front if area < 0 => return None,
            _ => {}
        }
        let [a, b, c] = if area < 0 { [a, c, b] } else { [a, b, c] };
        let vertices = if b.q > a.q && b.q >= c.q {
            [b, c, a]
        } else if c.q > a.q {
            [c, a, b]
        } else {
            [a, b, c]
        };
        Some(Self { vertices, area: area.unsigned_abs() })
    }
}

impl TriangleSetup {
    /// With its place and area; its planes are to be set. (In two steps, in place: a struct of this size that is
    /// returned when all is done stands on the stack twice.)
    #[inline]
    pub(super) fn new(triangle: &Oriented<'_>) -> Self {
        Self {
            corners: triangle.vertices.map(position),
            area: Reciprocal::precise(triangle.area),
            z: Plane::default(),
            q: Plane::default(),
            q_min: 0,
            attributes: [Attribute::default(); ATTRIBUTES],
        }
    }

    #[inline(never)]
    pub(super) fn set_planes(&mut self, triangle: &Oriented<'_>, needs: &Needs) {
        let Needs { inputs, perspective, texture_scale } = *needs;
        let vertices = triangle.vertices;
        let near_w = vertices.map(|vertex| vertex.q.to_bits());
        self.z = self.depth_plane(near_w);
        let q = if perspective {
            // The nearest corner gets all 31 bits.
            let near_w = near_w.map(|q| q.clamp(1, i32::MAX as u32));
            near_w.map(|q| q << (near_w[0].leading_zeros() - 1))
        } else {
            [1 << 30; 3]
        };
        let rise = [1, 2].map(|i| q[i].wrapping_sub(q[0]) as i32);
        self.q = Plane { origin: q[0], rise, step: self.step(rise, true) };
        self.q_min = q[1].min(q[2]).min(q[0]);

        let colors = if matches!(inputs, Inputs::Uv | Inputs::UvColor) {
            self.attributes[0] = self.attribute(vertices.map(|vertex| vertex.u.to_bits()), &q, texture_scale);
            self.attributes[1] = self.attribute(vertices.map(|vertex| vertex.v.to_bits()), &q, texture_scale);
            2
        } else {
            0
        };
        if matches!(inputs, Inputs::Color | Inputs::UvColor) {
            for channel in 0..3 {
                let at = vertices.map(|vertex| i32::from(vertex.color[channel].to_bits()) << 8);
                self.attributes[colors + channel] = self.attribute(at, &q, 0);
            }
        }
    }

    /// The weights at a pixel centre inside the triangle: exact edge functions times 1/area.
    #[inline]
    pub(super) fn weights(&self, x: i32, y: i32) -> Weights {
        let [[ax, ay], [bx, by], [cx, cy]] = self.corners;
        let (px, py) = (x * 16 + 8 - ax, y * 16 + 8 - ay);
        let weight = |edge_function: i32| {
            // Up to the area: below 2³¹ after this shift, and 1/area has as many zeros.
            wide(edge_function << (self.area.zeros - 1), self.area.mantissa) >> 30
        };
        let b = weight((ax - cx) * py - (ay - cy) * px);
        let c = weight((bx - ax) * py - (by - ay) * px);
        Weights([b, c].map(|weight| weight.min(i64::from(i32::MAX)) as i32))
    }

    /// Depth must not leave 0 … 2³¹ however far it is stepped: its step is rounded towards
    /// zero, and the last 64 units at both ends (1/512 of a depth step) are room for errors.
    fn depth_plane(&self, near_w: [u32; 3]) -> Plane {
        let [origin, b, c] = near_w.map(|q| q.clamp(64, (1 << 31) - 64));
        let rise = [b, c].map(|z| z.wrapping_sub(origin) as i32);
        Plane { origin, rise, step: self.step(rise, false) }
    }

    /// The change over one pixel to the right of what rises so from corner 0 to corners 1 and 2:
    /// 16 · (rise₁·(y₂ − y₀) − rise₂·(y₁ − y₀)) / area, rounded to nearest or towards zero, saturated.
    fn step(&self, rise: [i32; 2], nearest: bool) -> i32 {
        let [[_, ay], [_, by], [_, cy]] = self.corners;
        let sum = wide(cy - ay, rise[0]) - wide(by - ay, rise[1]);
        // 31 bits of it, times 31 bits of 1/area.
        let magnitude = sum.unsigned_abs();
        let excess = 33u32.saturating_sub(magnitude.leading_zeros());
        let product = wide((magnitude >> excess) as i32, self.area.mantissa);
        let shift = 58 - self.area.zeros - excess;
        let quotient = if nearest { shift_round(product, shift) } else { product >> shift };
        let step = quotient.min(i64::from(i32::MAX)) as i32;
        if sum < 0 { -step } else { step }
    }

    /// An attribute from its I16F16 values at the corners (within ±2²⁹), and q there.
    #[inline(never)]
    fn attribute(&self, at: [i32; 3], q: &[u32; 3], scale_log2: u32) -> Attribute {
        let rise = [at[1] - at[0], at[2] - at[0]];
        let products = [wide(rise[0], q[1] as i32), wide(rise[1], q[2] as i32)];
        let largest = products[0].unsigned_abs() | products[1].unsigned_abs();
        // 30 bits of the larger.
        let exponent = 34 - largest.leading_zeros() as i32;
        let scaled = products.map(|product| {
            (if exponent >= 0 { shift_round(product, exponent as u32) } else { product << -exponent }) as i32
        });
        Attribute {
            rise: scaled,
            step: self.step(scaled, true),
            exponent,
            base: at[0],
            low: rise[0].min(rise[1]).min(0),
            high: rise[0].max(rise[1]).max(0),
            scale_log2,
        }
    }
}

fn position(vertex: &ScreenVertex) -> [i32; 2] {
    [vertex.x.to_bits().into(), vertex.y.to_bits().into()]
}
