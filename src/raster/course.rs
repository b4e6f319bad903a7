//! Course: what one texture coordinate of a small triangle needs to follow perspective, and the lift of those that need little.
//!
//! - In: q at the corners of a [small](super::small) triangle and its gradient; then a coordinate's range and gradient.
//! - Out: whether the coordinate is straight, is to be lifted, or has to be bent; and how q falls, for those.
//! - Assumes: q is below 2³¹ and varies by less than 2²⁷; the planes are those of linear interpolation.
//!
//! # The error of linear interpolation, for one coordinate
//!
//! [`straight`](super::straight) has the error: cov(u, q)/q, with the covariance under a pixel's barycentric weights. Let R be the range
//! of u at the corners, and λ = 0 … 1 where the linear u lies in it. The mean of |u − λ| is the largest, for a given λ, if u takes its two
//! ends alone; so |cov(u, q)| ≤ λ(1 − λ)·R·(q_max − q_min), at most a quarter of R·(q_max − q_min).
//!
//! In pixels that is divided by M, the change of u over a pixel. Along the row from a corner P to Q on the opposite edge it is, exactly
//! and at any point p of the triangle,
//!
//! ```text
//! ∂u/∂x = ((u_Q − u_P)·q̄ + (ū − u(p))·(q_Q − q_P)) / (q(p)·width),   bars being means of P and Q
//! ```
//!
//! The error is divided by the same q(p), so that cancels. The exact u_Q is off from the linear one by ¼·R·fall at most, the *fall* being
//! (q_max − q_min)/q_min, and |ū − u(p)| ≤ R. So with L for the linear steps, and height/(2·area) for 1/width,
//!
//! ```text
//! M ≥ |L_x| − R·(|q_x|/q_min + ¼·fall·height/(2·area)),   likewise for y, and at least 1 texel: what is off by less does not show
//! ```
//!
//! One *loss* serves both: the brackets with the larger step of q, and the larger one of height and width.
//!
//! # Lifted coordinates
//!
//! Where u and q put the corners in the same order linear interpolation is too low everywhere by 4E·λ(1 − λ), E being the largest error;
//! in opposite orders it is too high. So a *lifted* coordinate's least value at the corners is raised by 9/16 of E, its greatest is kept,
//! and what lies between is raised in proportion. What is left is (1 − λ)(4λ − 9/16)·E: between −9/16 and 0.74 of E. If it is too high
//! the greatest value is lowered likewise. No value leaves the range of the corners. (The end that is moved is where q is least: there
//! nothing but q_min divides.)
//!
//! # The quarter pixel
//!
//! ```text
//!                                        u, v                  of textures of more than 64 texels a side
//! straight                               27/128, 25/128 px     23/128, 19/128
//! or inside a lifted one, 0.74 times     36/128, 34/128 px     31/128, 23/128
//! what moving corners inside adds there  1/1500, 1/400 px      1/1200, 1/230
//! the plane and rises                    1/200 texel           1/200
//! steps, cut when they are packed        1/32 texel            15/256
//! rounding down, and carries into v      1/1000, 1/85 texel    1/256, 7/256
//! ```
//!
//! The end of a lifted one that is moved is off by 9/16 of its limit; by the corners' margins, of u 1/42 texel, of v 1/23 or 1/20; and by
//! the last three lines.

use super::attribute::Attribute;
use super::plane::Plane;
use crate::math::recip::short_of;
use crate::num::mul_16;
use core::hint::black_box;

/// What a coordinate needs.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Course {
    /// Nothing: it is as good as linear.
    Straight,
    /// To be lifted, if that is possible.
    Lifted,
    /// A quadratic.
    Bent,
}

/// Which end of its range a coordinate keeps when it is lifted.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Kept {
    Greatest,
    Least,
}

/// The greatest 4 · E with which a coordinate is as good as linear, and with which it is when it is lifted, in 32nds of M: of u and of v.
pub(super) type Limits = [[i32; 2]; 2];

/// Of textures of which no side has more than 64 texels, or that are not packed.
const LIMITS: Limits = [[27, 36], [25, 34]];
/// Of larger ones, whose packed coordinates may be off by more.
const LARGE_LIMITS: Limits = [[23, 31], [19, 23]];

/// The limits of large textures or others.
#[inline]
pub(super) fn limits(is_large: bool) -> &'static Limits {
    if is_large { &LARGE_LIMITS } else { &LIMITS }
}

/// How q falls over a triangle.
pub(super) struct Fall {
    /// 1/q_min = `reciprocal` · 2^(`zeros` − 48); 2¹⁶ … 2¹⁷.
    reciprocal: u32,
    /// The leading zeros of q_min.
    zeros: u32,
    /// (q_max − q_min)/q_min, 16 fraction bits, rounded up from less than ¼.
    all: u32,
}

impl Fall {
    /// From what q varies by, and the least. `None` if the former is a quarter of the latter or more.
    #[inline]
    pub(super) fn new(difference: u32, least: u32) -> Option<Self> {
        if difference >= least >> 2 {
            return None;
        }
        let (reciprocal, zeros) = short_of(least);
        let fall = Self { reciprocal, zeros, all: 0 };
        Some(Self { all: fall.of(difference), ..fall })
    }

    /// A difference of q, at most a quarter of q_min, divided by that: 16 fraction bits, rounded up.
    #[inline]
    fn of(&self, difference: u32) -> u32 {
        // 14 bits times 17 bits.
        (((((difference << self.zeros) >> 16) + 1) * self.reciprocal) >> 16) + 1
    }

    /// How much less M may be than the larger one of a coordinate's steps, as a part of its range, in 1/px: 13 fraction bits, below 4.0.
    /// `thinness` is the larger one of height and width, divided by twice the area: in 1/px, 12 fraction bits, rounded up from at most 8.0.
    /// So the steps of q are at most 8 times what it varies by, which is below a quarter of q_min.
    #[inline]
    pub(super) fn loss(&self, steps: [i32; 2], thinness: u32) -> u32 {
        let step = steps[0].unsigned_abs().max(steps[1].unsigned_abs());
        self.of((step >> 3) + 1) + ((self.all * thinness) >> 17) + 2
    }

    /// 4 · E, in texels of 16 fraction bits.
    #[inline]
    fn error(&self, range: u32) -> i32 {
        mul_16(range as i32, self.all) + 1
    }

    /// What a coordinate of these [`Limits`] needs that is not [little](is_little). `loss` is that of M.
    #[inline]
    pub(super) fn course(&self, attribute: &Attribute, loss: u32, [straight, lifted]: [i32; 2]) -> Course {
        let error = self.error(attribute.range);
        let [right, down] = attribute.plane.steps.map(i32::abs);
        let change = right.max(down) - (mul_16(attribute.range as i32, loss) << 3);
        let part = change.max(1 << 16) >> 5;
        if error <= part * straight {
            Course::Straight
        } else if error <= part * lifted {
            Course::Lifted
        } else {
            Course::Bent
        }
    }

    /// Lifts a coordinate, whose plane is linear, from its end that is kept: a margin inside the range.
    #[inline(never)]
    pub(super) fn lift(&self, plane: &mut Plane, end: i32) {
        // 9/16 of E are 9/64 · fall of the range. Rounded to nearest, as the steps' errors add up.
        let part = |of: i32| (mul_16(of, (self.all * 9) >> 5) + 1) >> 1;
        plane.steps = plane.steps.map(|step| step - part(step));
        plane.origin = plane.origin.wrapping_add_signed(part(end.wrapping_sub(plane.origin as i32)));
    }

    /// q_min/q_mid with 15 fraction bits: 1/(1 + f/2) ≈ 1 − f/2, f being what q varies by. At most 1/64 too small.
    #[inline]
    fn to_middle(&self) -> u32 {
        (1 << 15) - (self.all >> 2)
    }

    /// By how much q rises from one corner to another, divided by q_mid = (q_min + q_max)/2; 16 fraction bits.
    #[inline]
    pub(super) fn rise(&self, from: u32, to: u32) -> i32 {
        let size = ((self.of(from.abs_diff(to)) * self.to_middle()) >> 15) as i32;
        if to > from { size } else { -size }
    }

    /// From the change of q per column and per row: the same divided by q_mid, 16 fraction bits, within ±¼. `None` where a
    /// quadratic is not exact enough, or where q changes by more than a quarter of q_min per pixel (for some q_min, an
    /// eighth). `longest` is the greatest |Δx| + |Δy| of an edge, in 1/16 px, below 2¹².
    #[inline]
    pub(super) fn slopes(&self, steps: [i32; 2], longest: u32) -> Option<[i32; 2]> {
        // The quadratic is off by length · fall²/8 (see `small`). That has to be 3/32 pixel at most: length · fall² ≤ 3/4
        // pixel, in 1/16 px with 16 fraction bits. Any edge may be the one that counts: so the longest with the largest fall.
        if longest * ((self.all * self.all) >> 16) > 12 << 16 {
            return None;
        }
        // At most q_min, so that a quarter of it leaves `step << zeros` within ±2²⁹.
        let least = (1u32 << 31) >> self.zeros;
        if steps.iter().any(|step| step.unsigned_abs() > least >> 2) {
            return None;
        }
        let middle = self.to_middle();
        Some(steps.map(|step| {
            let slope = (((step << self.zeros) >> 16) * self.reciprocal as i32) >> 16;
            (slope * middle as i32) >> 15
        }))
    }
}

/// Whether a coordinate of this range, in I16F16, below 2²⁷, is straight since its error is small beside a texel. `difference` is q_max −
/// q_min, below 2²⁷, `least` q_min, and `limit` the first of its [`Limits`].
#[inline]
pub(super) fn is_little(range: u32, difference: u32, least: u32, [limit, _]: [i32; 2]) -> bool {
    // R · (q_max − q_min) ≤ limit · q_min, both divided by 2²⁷: without 1/q_min.
    mul_16(range as i32, (difference >> 11) + 1) < limit * (least >> 16) as i32
}

/// Which end a lifted coordinate keeps, from its values at the corners and from q: the greatest if both put the corners in the same order.
/// `None` if they put them neither in the same nor in opposite orders.
#[inline(never)]
pub(super) fn kept(at: &[i32; 3], q: &[u32; 3]) -> Option<Kept> {
    let (mut same, mut opposite) = (false, false);
    for (i, j) in [(0, 1), (0, 2), (1, 2)] {
        let (rise, rise_of_q) = (at[j].wrapping_sub(at[i]), q[j].wrapping_sub(q[i]).cast_signed());
        if rise != 0 && rise_of_q != 0 {
            let differ = (rise ^ rise_of_q) < 0;
            (same, opposite) = (same | !differ, opposite | differ);
        }
        // Not unrolled.
        black_box(());
    }
    match (same, opposite) {
        (_, false) => Some(Kept::Greatest),
        (false, true) => Some(Kept::Least),
        (true, true) => None,
    }
}

#[cfg(test)]
#[expect(clippy::float_arithmetic, reason = "the truth in f64")]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use std::cell::Cell;
    use std::println;

    /// The plane through values at corners, all in whole units.
    fn through(corners: &[[f64; 2]; 3], at: [f64; 3]) -> [f64; 3] {
        let [[ax, ay], [bx, by], [cx, cy]] = *corners;
        let area = (bx - ax) * (cy - ay) - (by - ay) * (cx - ax);
        let (b, c) = (at[1] - at[0], at[2] - at[0]);
        let right = (b * (cy - ay) - c * (by - ay)) / area;
        let down = (c * (bx - ax) - b * (cx - ax)) / area;
        [at[0] - right * ax - down * ay, right, down]
    }

    std::thread_local! {
        static WORST: Cell<[f64; 2]> = const { Cell::new([0.0; 2]) };
        static COUNTS: Cell<[u32; 3]> = const { Cell::new([0; 3]) };
    }

    proptest! {
        #![proptest_config(ProptestConfig { cases: 40_000, failure_persistence: None, ..ProptestConfig::default() })]
        fn each_of_40_000_cases(
            sixteenths in prop::array::uniform3([0..512_i32, 0..512_i32]),
            // The least is 2^`nearest`, and what it varies by 2^−`fall` of that.
            (nearest, fall, others) in (16.0..30.9_f64, 2.0..7.0_f64, [0.0..=1.0_f64, 0.0..=1.0]),
            // Texels over the triangle, and where the corners are among them.
            (range, places) in (-1.0..8.0_f64, [0.0..=1.0_f64, 0.0..=1.0, 0.0..=1.0]),
            turns in 0..3_usize,
        ) {
            let corners = sixteenths.map(|corner| corner.map(|at| f64::from(at) / 16.0));
            let [[ax, ay], [bx, by], [cx, cy]] = sixteenths;
            let area = ((bx - ax) * (cy - ay) - (by - ay) * (cx - ax)).abs();
            let extent = |axis: usize| {
                let at = sixteenths.map(|corner| corner[axis]);
                at[0].max(at[1]).max(at[2]) - at[0].min(at[1]).min(at[2])
            };
            let longest = extent(0).max(extent(1));
            prop_assume!(area > 0 && longest * 2 <= area);
            let mut q = [0.0, others[0], others[1]].map(|place| (nearest.exp2() * (1.0 + place * (-fall).exp2())) as u32);
            q.rotate_left(turns);
            let (least, most) = (q[0].min(q[1]).min(q[2]), q[0].max(q[1]).max(q[2]));
            prop_assume!(most - least < 1 << 27 && most < 1 << 31);
            let Some(falling) = Fall::new(most - least, least) else { return Ok(()) };
            let at = places.map(|place| (range.exp2() * place * 65536.0) as i32);
            let least_u = at[0].min(at[1]).min(at[2]);
            let span = (at[0].max(at[1]).max(at[2]) - least_u) as u32;

            let (u, w) = (at.map(|at| f64::from(at) / 65536.0), q.map(f64::from));
            let linear = through(&corners, u);
            let steps = [1, 2].map(|i| (linear[i] * 65536.0).round() as i32);
            let mut attribute = Attribute::default();
            attribute.range = span;
            let [left, top] = sixteenths[0].map(|at| f64::from(at >> 4));
            let first = (linear[0] + linear[1] * left + linear[2] * top) * 65536.0;
            attribute.plane = Plane { origin: first.round() as i64 as u32, steps };
            let q_plane = through(&corners, w);
            let thinness = (f64::from(longest) * 16.0 / f64::from(area) * 4096.0).ceil() as u32;
            let loss = falling.loss([1, 2].map(|i| q_plane[i].round() as i32), thinness);
            let limits = LIMITS[0];
            let is_little = is_little(span, most - least, least, limits);
            let mut course = if is_little { Course::Straight } else { falling.course(&attribute, loss, limits) };
            if course == Course::Lifted {
                let end = match kept(&at, &q) {
                    Some(Kept::Greatest) => least_u.wrapping_add_unsigned(span),
                    Some(Kept::Least) => least_u,
                    None => return Ok(()),
                };
                falling.lift(&mut attribute.plane, end);
            } else if course == Course::Straight && span > 0 && kept(&at, &q).is_none() {
                course = Course::Bent; // in no order: counted apart
            }
            let kind = match course {
                Course::Straight => 0,
                Course::Lifted => 1,
                Course::Bent => 2,
            };
            let mut counts = COUNTS.get();
            counts[kind] += 1;
            COUNTS.set(counts);
            if kind == 2 && !is_little && falling.course(&attribute, loss, limits) == Course::Bent {
                return Ok(());
            }

            // Along all edges and medians, where the error is the largest.
            let products = through(&corners, [0, 1, 2].map(|i| u[i] * w[i]));
            let value = |plane: [f64; 3], [x, y]: [f64; 2]| plane[0] + plane[1] * x + plane[2] * y;
            let Plane { origin, steps: [right, down] } = attribute.plane;
            let [here, right, down] = [origin as i32, right, down].map(|of| f64::from(of) / 65536.0);
            for (i, j, k) in [(0, 1, 2), (1, 2, 0), (2, 0, 1)] {
                for (part, aside) in (0..=16).flat_map(|part| [0.0, 0.1, 1.0 / 3.0].map(|aside| (f64::from(part) / 16.0, aside))) {
                    let place = [0, 1].map(|axis| {
                        let edge = corners[i][axis] + (corners[j][axis] - corners[i][axis]) * part;
                        edge + (corners[k][axis] - edge) * aside
                    });
                    let (q, exact) = (value(q_plane, place), value(products, place) / value(q_plane, place));
                    // The change over a pixel: (n / q)′ = (n′ − (n / q)·q′) / q.
                    let change = [1, 2].map(|axis| ((products[axis] - exact * q_plane[axis]) / q).abs());
                    let drawn = value([here, right, down], [place[0] - left, place[1] - top]);
                    let error = (drawn - exact).abs() / change[0].max(change[1]).max(1.0);
                    let limit = if kind == 1 { f64::from(limits[1]) * 0.7386 } else { f64::from(limits[0]) };
                    prop_assert!(error <= limit / 128.0 + 1e-3, "{} px of {}, {:?}", error, limit / 128.0, place);
                    let mut worst = WORST.get();
                    worst[kind & 1] = worst[kind & 1].max(error);
                    WORST.set(worst);
                }
            }
        }
    }

    #[test]
    fn straight_and_lifted_coordinates_are_as_exact_as_is_said_in_40_000_triangles() {
        each_of_40_000_cases();
        let ([straight, lifted], counts) = (WORST.get(), COUNTS.get());
        println!("straight {straight:.4} px, lifted {lifted:.4} px; {counts:?} straight, lifted, and others");
        assert!(counts.iter().all(|&count| count > 200), "{counts:?}");
    }
}
