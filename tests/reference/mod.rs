//! The slow, obviously right rasterizer that the crate is held against.
//!
//! It is written from the definitions alone and shares no code with the crate: not even its types. Positions are
//! integers in 1/16 pixel, y down, and everything that decides a pixel is an exact integer in `i128`; `f64` comes
//! in only where an exact fraction is at last read as a number.
//!
//! Its own tests are in `tests/yardstick.rs`.

#![allow(clippy::float_arithmetic, reason = "exact fractions are at last read as f64")]

pub(crate) mod field;
pub(crate) mod view;

/// What a vertex carries beside its place: u, v, red, green, blue, each in units of 2⁻¹⁶.
pub(crate) const ATTRIBUTES: usize = 5;

/// 1.0 in the units of an attribute: a texel for u and v, 1/255 of full intensity for a colour.
pub(crate) const UNIT: f64 = 65536.0;

/// One depth step in the units of q = near/w, where 1.0 is 2³¹.
pub(crate) const DEPTH_STEP: i128 = 1 << 15;

/// A vertex on the screen, in plain integers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Corner {
    /// To the right, in 1/16 pixel.
    pub(crate) x: i32,
    /// Down, in 1/16 pixel.
    pub(crate) y: i32,
    /// near / w in units of 2⁻³¹.
    pub(crate) q: u32,
    /// u, v (texels) and red, green, blue (0 … 255), in units of 2⁻¹⁶.
    pub(crate) attributes: [i32; ATTRIBUTES],
}

/// Three vertices, in any order and place.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Triangle(pub(crate) [Corner; 3]);

/// Which way round the vertices go, as seen on the screen with y down.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Facing {
    /// Counter-clockwise.
    Front,
    /// Clockwise.
    Back,
    /// All three on one line: such a triangle covers nothing.
    Edge,
}

/// Where pixel `p`'s centre is, in 1/16 pixel.
const fn centre(p: i32) -> i128 {
    16 * p as i128 + 8
}

/// Twice the signed area of the triangle a, b, p: positive if it goes clockwise as seen on the screen.
fn cross(a: (i128, i128), b: (i128, i128), p: (i128, i128)) -> i128 {
    (b.0 - a.0) * (p.1 - a.1) - (b.1 - a.1) * (p.0 - a.0)
}

/// On which side of the line a → b the point p lies after an infinitely small step to the right and a step
/// infinitely smaller than that one down: the sign of `cross(a, b, p + (ε, ε²))`. It is never 0 for a ≠ b.
///
/// This step *is* the top-left rule. A centre on a left edge steps into the triangle, on a right edge out of it; on
/// a horizontal edge the step to the right decides nothing, and the one down steps into the triangle under a top
/// edge and out of it over a bottom edge. A stepped centre lies on no edge of any triangle, so of triangles that
/// tile the plane exactly one has it.
fn side(a: (i128, i128), b: (i128, i128), p: (i128, i128)) -> i128 {
    let still = cross(a, b, p).signum();
    let right = -(b.1 - a.1).signum();
    let down = (b.0 - a.0).signum();
    [still, right, down].into_iter().find(|sign| *sign != 0).unwrap_or(0)
}

impl Triangle {
    fn points(&self) -> [(i128, i128); 3] {
        self.0.map(|corner| (corner.x.into(), corner.y.into()))
    }

    /// Twice the area, in (1/16 pixel)²: positive for clockwise.
    pub(crate) fn twice_area(&self) -> i128 {
        let [a, b, c] = self.points();
        cross(a, b, c)
    }

    pub(crate) fn facing(&self) -> Facing {
        match self.twice_area() {
            0 => Facing::Edge,
            area if area < 0 => Facing::Front,
            _ => Facing::Back,
        }
    }

    /// Whether the pixel belongs to the triangle, seen from either side.
    pub(crate) fn covers(&self, x: i32, y: i32) -> bool {
        let area = self.twice_area().signum();
        let p = (centre(x), centre(y));
        let [a, b, c] = self.points();
        area != 0 && [(a, b), (b, c), (c, a)].into_iter().all(|(from, to)| side(from, to, p) == area)
    }

    /// The triangle as it is at the centre of a pixel, which need not be inside.
    ///
    /// A triangle without area has no plane to look up.
    pub(crate) fn at(&self, x: i32, y: i32) -> Sample<'_> {
        let p = (centre(x), centre(y));
        let [a, b, c] = self.points();
        let sign = self.twice_area().signum();
        Sample {
            triangle: self,
            x,
            y,
            weights: [cross(b, c, p), cross(c, a, p), cross(a, b, p)].map(|weight| weight * sign),
        }
    }

    /// The smallest and the largest of the three vertices' values.
    pub(crate) fn range(&self, attribute: usize) -> (i32, i32) {
        let [a, b, c] = self.0.map(|corner| corner.attributes[attribute]);
        (a.min(b).min(c), a.max(b).max(c))
    }

    /// The smallest and the largest value that may be sampled: of a texture coordinate all that is below the largest of the
    /// vertices', but one that is the same all over stays what it is.
    pub(crate) fn sampled(&self, attribute: usize) -> (i32, i32) {
        let (low, high) = self.range(attribute);
        (low, if attribute < 2 { (high - 1).max(low) } else { high })
    }
}

/// A triangle at one pixel centre.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Sample<'a> {
    triangle: &'a Triangle,
    x: i32,
    y: i32,
    /// Barycentric weights times twice the area; none is negative inside.
    weights: [i128; 3],
}

/// An attribute that is straight on the screen, at one pixel centre: exact, with the side on which it is sampled.
///
/// That side is found as coverage finds its own: an infinitely small step to the right, and one infinitely smaller than that
/// down. So of a coordinate that is whole at a centre the step says which texel it is, and of all triangles of a sprite it says
/// the same.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Straight {
    /// Its value in units of 2⁻¹⁶, times `area`.
    sum: i128,
    area: i128,
    /// 1 if the step makes it more, −1 if less, 0 if it is the same all over the triangle.
    pub(crate) direction: i128,
    /// The smallest and the largest of the three vertices' values.
    range: (i32, i32),
}

impl Straight {
    /// In units of 2⁻¹⁶.
    pub(crate) fn value(&self) -> f64 {
        self.sum as f64 / self.area as f64
    }

    /// The whole number of `unit`s below it after the step, if it is `ahead` further in the direction of the step (both in units
    /// of 2⁻¹⁶).
    fn whole(&self, ahead: i128, unit: i128) -> i128 {
        let (sum, unit) = (self.sum + self.direction * ahead * self.area, unit * self.area);
        // Below a whole number is the one before: ceil − 1.
        if self.direction < 0 { -(-sum).div_euclid(unit) - 1 } else { sum.div_euclid(unit) }
    }

    /// The texels that may be seen: that of the coordinate times 2^`scale_log2`, and what lies up to `ahead` units of 2⁻¹⁶
    /// (before scaling) in the direction of the step, as far as the vertices' range goes: from its least value to below its
    /// largest.
    pub(crate) fn texels(&self, scale_log2: u32, ahead: i128) -> std::ops::RangeInclusive<i128> {
        let unit = 1 << (16 - scale_log2);
        let (low, high) = (i128::from(self.range.0), i128::from(self.range.1));
        let first = low.div_euclid(unit);
        let last = (high - 1).max(low).div_euclid(unit);
        let [here, there] = [0, ahead].map(|ahead| self.whole(ahead, unit));
        assert!((first..=last).contains(&here), "a step into the triangle stays in its range");
        let there = there.clamp(first, last);
        here.min(there)..=here.max(there)
    }

    /// The same in units of 2⁻¹⁶: for whom sees coordinates and not texels.
    pub(crate) fn values(&self, ahead: i128) -> std::ops::RangeInclusive<i128> {
        self.texels(16, ahead)
    }
}

/// How much an attribute changes over one pixel, in units of 2⁻¹⁶: the two ways to read the contract.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Change {
    /// max(|∂/∂x|, |∂/∂y|) at the centre.
    pub(crate) derivative: f64,
    /// The largest difference from the four neighbouring centres, of those in front of the eye (q > 0). With none
    /// there, the derivative.
    pub(crate) step: f64,
}

impl Sample<'_> {
    /// q times twice the area: exact, and linear on the screen.
    fn q_sum(&self) -> i128 {
        self.sum(|corner| corner.q.into())
    }

    fn sum(&self, value: impl Fn(&Corner) -> i128) -> i128 {
        let corners = self.triangle.0.iter();
        corners.zip(self.weights).map(|(corner, weight)| weight * value(corner)).sum()
    }

    /// attribute · q times twice the area: exact, and linear on the screen. Its bits: 2 + 31 for the weight over the
    /// whole guard band, 31 for q, 31 for the attribute.
    fn attribute_sum(&self, attribute: usize) -> i128 {
        self.sum(|corner| i128::from(corner.q) * i128::from(corner.attributes[attribute]))
    }

    fn area(&self) -> i128 {
        self.triangle.twice_area().abs()
    }

    /// q = near / w in units of 2⁻³¹.
    pub(crate) fn q(&self) -> f64 {
        self.q_sum() as f64 / self.area() as f64
    }

    /// How far `q`, in units of 2⁻³¹, is from the exact one, in depth steps.
    pub(crate) fn depth_error(&self, q: u32) -> f64 {
        let difference = i128::from(q) * self.area() - self.q_sum();
        difference.abs() as f64 / (self.area() * DEPTH_STEP) as f64
    }

    /// What a 16-bit depth buffer holds: max(1, ⌊q / 2¹⁵⌋), in exact integers.
    pub(crate) fn depth_word(&self) -> i128 {
        self.q_sum().div_euclid(self.area() * DEPTH_STEP).max(1)
    }

    /// Perspective-correct: Σ λ·q·a / Σ λ·q, in units of 2⁻¹⁶, rounded only as the quotient becomes an `f64`.
    pub(crate) fn attribute(&self, attribute: usize) -> f64 {
        self.attribute_sum(attribute) as f64 / self.q_sum() as f64
    }

    /// Straight on the screen: Σ λ·a, in units of 2⁻¹⁶.
    pub(crate) fn affine_attribute(&self, attribute: usize) -> f64 {
        self.sum(|corner| corner.attributes[attribute].into()) as f64 / self.area() as f64
    }

    /// The attribute, straight on the screen.
    pub(crate) fn straight(&self, attribute: usize) -> Straight {
        let sum = |sample: &Sample<'_>| sample.sum(|corner| corner.attributes[attribute].into());
        let here = sum(self);
        let step = |dx, dy| (sum(&self.triangle.at(self.x + dx, self.y + dy)) - here).signum();
        let (right, down) = (step(1, 0), step(0, 1));
        Straight {
            sum: here,
            area: self.area(),
            direction: if right == 0 { down } else { right },
            range: self.triangle.range(attribute),
        }
    }

    /// How much the attribute changes over one pixel here.
    pub(crate) fn change(&self, attribute: usize) -> Change {
        let here = self.attribute(attribute);
        let neighbour = |dx, dy| self.triangle.at(self.x + dx, self.y + dy);
        // (n / q)′ = (n′ − (n / q)·q′) / q, and the change of a linear n over a pixel is exactly n′.
        let along = |next: Sample<'_>| {
            let slope = (next.attribute_sum(attribute) - self.attribute_sum(attribute)) as f64;
            let q_slope = (next.q_sum() - self.q_sum()) as f64;
            ((slope - here * q_slope) / self.q_sum() as f64).abs()
        };
        let derivative = along(neighbour(1, 0)).max(along(neighbour(0, 1)));
        let step = [(1, 0), (-1, 0), (0, 1), (0, -1)]
            .into_iter()
            .map(|(dx, dy)| neighbour(dx, dy))
            .filter(|next| next.q_sum() > 0)
            .map(|next| (next.attribute(attribute) - here).abs())
            .reduce(f64::max)
            .unwrap_or(derivative);
        Change { derivative, step }
    }
}
