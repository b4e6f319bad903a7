//! Whole: meshes that lie wholly in view of the planes and the guard band, and how their vertices are placed in half the time.
//!
//! - In: a mesh's bounding sphere, its transform to clip space and the planes; then positions.
//! - Out: x, y and q of a screen vertex, without any test: within 1/128 px of exact before rounding, as
//!   [`least_w`](super::transform::least_w) promises of all vertices; or no, and then the mesh takes the general way.
//! - Assumes: every vertex lies in the sphere.
//!
//! Each row of the matrix gets a unit of its own, x and y a common one: the finest in which no vertex of the sphere overflows. So
//! one product of 32 bits for each element is enough, and sums may wrap around in between. 1/w is taken to 20 bits, so that a
//! product with it is two short ones.
//!
//! # How exact it is
//!
//! The numbers are exact for the sphere's centre. R steps of 2⁻¹² unit away from it, the radius, a coordinate is off by at most
//! ½·√3·R + 1 of its last bits, as each element is rounded by at most ½. With D px, the farthest from the line of sight that the
//! sphere may reach, with x within ±A and w at least B, in last bits, that is on the screen
//!
//! ```text
//! √¾ · (R + 1) · D · (1/A + 1/B) px     at most 1/256: the mesh is too coarse otherwise
//! D · (2⁻¹⁹ + 2⁻²¹) px                  of 1/w, its table, and what a product with it drops; D is at most 640: below 1/650
//! 1/512 px                              of the clip coordinates that it is made from: w is at least four times `least_w`
//! ```
//!
//! The sum is below 1/128. q is at most ¼, off by these (R + 1)/B of itself, which may be 1/8 step of a 16-bit depth, and by 2⁻¹⁹,
//! another 1/32 step.

use super::clip::{CUT_AT, Clip, FINER, Shifts};
use super::screen::ScreenVertex;
use super::transform::ToClip;
use crate::math::Pose;
use crate::math::recip::looked_up;
use crate::num::{I12F4, U1F31, mul_20, normalise, normalised, zeros_of};
use crate::scene::{Bounds, Projection, Vertex};

/// Places the vertices of one mesh.
#[repr(C)]
pub(crate) struct Placing {
    /// Its rows are narrow if the mesh is whole.
    to_clip: ToClip,
    clip: Clip,
}

/// Most leading zeros of w: the farthest may be that power of two times as far as the nearest.
const MOST_ZEROS: u32 = 6;
/// The most fraction bits of clip units that a row gets: as many as its elements have.
const MOST_BITS: u32 = 15;
/// The farthest that the sphere may reach from the line of sight, 640 px, in 1/16 px.
const FARTHEST: i32 = 640 * 16;

impl Placing {
    /// Of no mesh.
    pub(crate) const ZERO: Self = Self { to_clip: ToClip::ZERO, clip: Clip::ZERO };

    /// Sets one that is [`ZERO`](Self::ZERO), in place, so that nothing is copied.
    #[inline]
    pub(crate) fn set(&mut self, projection: &Projection, camera: &Pose, pose: &Pose) {
        let unit_bits = self.to_clip.set(projection, camera, pose);
        self.clip.set(projection, unit_bits);
    }

    /// Whether anything within a mesh's bounds may be seen. If so the mesh is placed from now on in the fastest way.
    #[inline(never)]
    pub(crate) fn sees(&mut self, projection: &Projection, bounds: &Bounds) -> bool {
        let center = self.clip.sees(&self.to_clip, bounds, projection);
        if let Some(center) = center {
            self.narrow(bounds, center);
        }
        center.is_some()
    }

    /// What clips triangles, if that may be needed.
    #[inline]
    pub(crate) fn clipping(&self) -> Option<(&ToClip, &Clip)> {
        self.clip.whole.is_none().then_some((&self.to_clip, &self.clip))
    }

    /// Makes rows of a mesh's matrix narrow, unless the sphere reaches too far, or is so large that its vertices would be too coarse.
    #[inline(never)]
    fn narrow(&mut self, bounds: &Bounds, center: [i32; 3]) {
        let Self { to_clip, clip } = self;
        if clip.flat() != 0 {
            return;
        }
        let radius = bounds.radius.unsigned_abs();
        let reach = to_clip.reach(2, radius);
        let nearest = center[2].saturating_sub(reach);
        // Center and reach are within 31 bits without the sign, so that sums of their sizes fit 32.
        const MOST: u32 = i32::MAX as u32;
        let farthest = center[2].unsigned_abs().wrapping_add(reach as u32).min(MOST);
        if nearest >> 2 < clip.least || farthest as i32 > clip.far {
            return;
        }
        let across =
            |axis: usize| center[axis].unsigned_abs().wrapping_add(to_clip.reach(axis, radius) as u32);
        let across = across(0).max(across(1)).min(MOST);
        // Positive, so that one bit is left for the sign of x and y.
        let bits = (zeros_of(across) - 1).min(MOST_BITS);
        let bits_of_w = zeros_of(farthest).min(MOST_BITS);

        // Of the nearest vertex.
        let (w, zeros) = normalise((nearest as u32) << bits_of_w);
        let inverse = looked_up(w);
        let shift = 18 + bits as i32 - bits_of_w as i32 - clip.scale();
        let depth_shift = clip.depth_zeros() - 2 - bits_of_w as i32;
        let fits = |shift: i32| (zeros as i32..30).contains(&shift);
        if zeros > MOST_ZEROS || !fits(shift) || !fits(depth_shift) {
            return;
        }
        let most =
            |of: i32, shift: i32| (mul_20(of, (inverse >> 11) + 1) >> (shift as u32 - zeros)) as u32 + 1;
        // 1/16 px from the line of sight.
        let distance = (most((across << bits) as i32, shift) >> FINER) + 1;
        let room = clip.center.iter().fold(FARTHEST, |room, at| room.min(CUT_AT - (at >> FINER).abs() - 1));
        if room < 0 || distance > room as u32 {
            return;
        }
        // The radius has 17 bits, the distance 14. 1/A is at most 2⁻³⁰ (or elements are not rounded), and 1/B is the inverse times
        // 2^(zeros − 62): (1/A + 1/B) · 2³⁸ has 14 bits. Times error without √¾ it is to be below 2³⁴ · √4/3.
        let error = (radius + 1) * distance;
        let per_bit = 256 + (inverse >> (24 - zeros));
        // 15 bits of q, at most 2¹³. Times (R + 1)/B it is to be below 2⁻¹⁹ · √4/3.
        let q = (most(clip.depth_mantissa, depth_shift) >> 17) + 1;
        let is_coarse = error >= 1 << 26 || (error >> 8) * per_bit > (1 << 26) / 13 * 15;
        if is_coarse || (((radius + 1) * q) >> 13) * (inverse >> 17) > ((1 << 28) / 13 * 15) >> zeros {
            return;
        }
        for axis in 0..3 {
            to_clip.narrow(axis, if axis == 2 { bits_of_w } else { bits }, bounds);
        }
        clip.whole = Some(Shifts { depth: depth_shift as u8, position: shift as u8 });
    }

    /// Puts a vertex on the screen, its position and q alone; false, and `to` of no use, if it has to be clipped.
    #[inline(always)]
    pub(crate) fn place_bare(&self, vertex: &Vertex, to: &mut ScreenVertex) -> bool {
        match self.clip.whole {
            Some(shifts) => {
                self.place_narrow(shifts, vertex, (&mut to.x, &mut to.y, &mut to.q));
                true
            }
            None => self.clip.place_bare(&self.to_clip, vertex, to),
        }
    }

    /// As [`Placing::place_bare`].
    #[inline(always)]
    pub(crate) fn place(&self, vertex: &Vertex, to: (&mut I12F4, &mut I12F4, &mut U1F31)) -> bool {
        match self.clip.whole {
            Some(shifts) => {
                self.place_narrow(shifts, vertex, to);
                true
            }
            None => self.clip.locate(&self.to_clip, vertex, to),
        }
    }

    /// Puts a vertex of a mesh that is whole on the screen: 15 short products.
    #[inline(always)]
    fn place_narrow(
        &self,
        shifts: Shifts,
        vertex: &Vertex,
        (to_x, to_y, to_q): (&mut I12F4, &mut I12F4, &mut U1F31),
    ) {
        let position = vertex.position.map(|at| i32::from(at.to_bits()));
        let (w, zeros) = normalised(self.to_clip.place_narrow(position, 2) as u32);
        let inverse = (looked_up(w) + (1 << 10)) >> 11;
        let shifted = |by: u8| u32::from(by).wrapping_sub(zeros) & 31;
        let q = (mul_20(self.clip.depth_mantissa, inverse) as u32) >> shifted(shifts.depth);
        *to_q = U1F31::from_bits((q + 1) >> 1);
        let shift = shifted(shifts.position);
        let screen = |axis: usize| {
            let at = mul_20(self.to_clip.place_narrow(position, axis), inverse) >> shift;
            I12F4::from_bits(((at + self.clip.center[axis]) >> FINER) as i16)
        };
        *to_x = screen(0);
        *to_y = screen(1);
    }
}

#[cfg(test)]
#[expect(clippy::float_arithmetic, reason = "the truth in f64")]
mod tests {
    use super::*;
    use crate::math::{Quaternion, Turn, Vec3};
    use crate::num::{I4F12, I16F16, U10F22};
    use crate::scene::{Camera, Mesh};
    use embedded_graphics::geometry::Size;
    use proptest::prelude::*;
    use std::cell::Cell;
    use std::println;
    use std::vec::Vec;

    /// A place of a mesh in this pose before this camera: right, up and away from it.
    fn before(camera: &Pose, pose: &Pose, at: [I4F12; 3]) -> [f64; 3] {
        let number = |pose: &Pose, row: usize, column: usize| pose.rotation[row][column].to_num::<f64>();
        let world = [0, 1, 2].map(|row| {
            let turned =
                |i: usize| number(pose, row, i) * pose.scale[i].to_num::<f64>() * at[i].to_num::<f64>();
            let places = [pose, camera].map(|pose| f64::from(pose.translation.bits()[row]) / 65536.0);
            turned(0) + turned(1) + turned(2) + places[0] - places[1]
        });
        let eye = [0, 1, 2].map(|axis| (0..3).map(|row| number(camera, row, axis) * world[row]).sum::<f64>());
        [eye[0], eye[1], -eye[2]]
    }

    proptest! {
        #![proptest_config(ProptestConfig { cases: 20_000, failure_persistence: None, ..ProptestConfig::default() })]
        fn each_of_20_000_cases(
            (turns, towards) in (any::<[u16; 6]>(), [-1.0..1.0_f64, -1.0..1.0]),
            // How large the mesh is among the numbers that it may have, in its own unit and in the world's.
            (extent, scale, middle) in (6.0..15.0_f64, -2.0..9.0_f64, [-1.0..1.0_f64, -1.0..1.0, -1.0..1.0]),
            // In radii, and in nearest distances.
            (distance, focal, near) in (1.0..9.0_f64, 10.0..800.0_f32, 0.5..5.0_f64),
            corners in prop::collection::vec([-1.0..=1.0_f64, -1.0..=1.0, -1.0..=1.0], 1..8),
        ) {
            let [a, b, c, d, e, f] = turns.map(Turn::from_raw);
            // The farthest that it has any place, and corners that reach it.
            let extent = extent.exp2() / 4096.0;
            let scale = U10F22::from_num((scale.exp2() / extent).min(1000.0));
            let steps = |at: f64| I4F12::saturating_from_num(at);
            let room = 7.99 - extent;
            let place = |corner: [f64; 3]| {
                [0, 1, 2].map(|i| steps(middle[i] * room + extent * (corner[i] * 1.5).clamp(-1.0, 1.0)))
            };
            let vertices: Vec<_> =
                corners.iter().map(|corner| Vertex { position: place(*corner), ..Vertex::default() }).collect();
            let mesh = Mesh::new(&vertices, &[]);
            let radius = f64::from(mesh.bounds().radius) / 4096.0 * scale.to_num::<f64>();
            let away = radius * (1.0 + distance.exp2() / 16.0);
            let camera = Camera::focal(focal, Size::new(320, 240)).heading(a, b, c);
            let camera = camera.near(((away - radius) / near.exp2() / 2.0) as f32);
            // The middle of the sphere is before the camera.
            let pose = Pose::from_quaternion(Quaternion::from_euler(d, e, f)).scaled(scale);
            let rotation = camera.placement().rotation.map(|row| row.map(|to| to.to_num::<f64>()));
            let here = before(&Pose::IDENTITY, &pose, mesh.bounds().center);
            let aside = towards.map(|to| to * away * 200.0 / f64::from(focal));
            let there = [aside[0], aside[1], -away];
            let stands = [0, 1, 2].map(|i| {
                let turned: f64 = (0..3).map(|k| rotation[i][k] * there[k]).sum();
                I16F16::saturating_from_num(turned - if i == 2 { -here[2] } else { here[i] })
            });
            let pose = pose.at(Vec3::new(stands[0], stands[1], stands[2]));

            let projection = camera.projection();
            let mut placing = Placing::ZERO;
            placing.set(projection, camera.placement(), &pose);
            if !placing.sees(projection, mesh.bounds()) || placing.clip.whole.is_none() {
                return Ok(());
            }
            WHOLE.set(WHOLE.get() + 1);
            for vertex in &vertices {
                let mut to = ScreenVertex::default();
                prop_assert!(placing.place_bare(vertex, &mut to));
                let [right, up, w] = before(camera.placement(), &pose, vertex.position);
                let focal = projection.focal.to_num::<f64>();
                let center = projection.center.map(f64::from);
                let exact = [center[0] + focal * right / w * 16.0, center[1] - focal * up / w * 16.0];
                for (at, exact) in [to.x, to.y].into_iter().zip(exact) {
                    let off = (f64::from(at.to_bits()) - exact).abs() - 0.5;
                    prop_assert!(off <= 16.0 / 128.0, "{} of 1/16 px beside rounding", off);
                    WORST.set([WORST.get()[0].max(off), WORST.get()[1]]);
                }
                let q = projection.near.to_num::<f64>() / w;
                let off = (to.q.to_num::<f64>() - q).abs() * 65536.0;
                prop_assert!(off <= 0.25, "{} steps of depth at q {}", off, q);
                WORST.set([WORST.get()[0], WORST.get()[1].max(off)]);
            }
        }
    }

    std::thread_local! {
        static WHOLE: Cell<u32> = const { Cell::new(0) };
        static WORST: Cell<[f64; 2]> = const { Cell::new([0.0; 2]) };
    }

    #[test]
    fn vertices_of_whole_meshes_are_within_a_128th_of_a_pixel_and_depth_within_a_quarter_step_in_20_000_cases()
     {
        each_of_20_000_cases();
        let [position, depth] = WORST.get();
        println!(
            "{} whole meshes: off by at most {position:.3} of 1/16 px beside rounding, {depth:.3} steps of depth",
            WHOLE.get()
        );
        assert!(WHOLE.get() > 5_000);
    }
}
