//! The camera: where from and how wide a scene is seen.

use super::Mesh;
use crate::math::{Pose, Turn, Vec3};
use crate::num::{I2F14, I16F16, bits_from_f32};
use crate::pipeline::{self, Shader};
use crate::target::{Band, DepthFormat, PixelFormat};
use embedded_graphics::geometry::Size;

/// A perspective camera and its place in the world.
///
/// Unless placed otherwise it stands at the origin and looks along −z, with +x right and +y up.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Camera {
    projection: Projection,
    /// The camera's axes in the world, as columns of the rotation; its scale is not used.
    pose: Pose,
}

/// How eye space is put on the screen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Projection {
    /// Focal length in pixels, 1/16 … 8191.
    pub(crate) focal: I16F16,
    /// Screen size in pixels, at most 1023 × 1023; the centre is the vanishing point of −z.
    pub(crate) width: u16,
    pub(crate) height: u16,
    /// Distance of the near plane, above 0.
    pub(crate) near: I16F16,
}

const MIN_FOCAL: i32 = 1 << 12;
const MAX_FOCAL: i32 = 8191 << 16;

impl Camera {
    /// A camera whose picture is `vertical` high, as an angle, on a screen of `size` pixels.
    ///
    /// The angle is limited to what gives a focal length of 1/16 to 8191 pixels, the size
    /// to 1023 × 1023.
    #[must_use]
    pub const fn perspective(vertical: Turn, size: Size) -> Self {
        // f = h/2 · cos(a/2) / sin(a/2), in I16F16.
        let half = Turn::from_raw(vertical.raw() / 2);
        let (sin, cos) = (half.sin().to_bits() as i64, half.cos().to_bits() as i64);
        let height = limited(size.height) as i64;
        let focal = if sin > 0 { (height << 15) * cos / sin } else { MAX_FOCAL as i64 };
        Self::with_focal(if focal > MAX_FOCAL as i64 { MAX_FOCAL } else { focal as i32 }, size)
    }

    /// A camera whose screen is `pixels` pixels away from the eye: an object as far away as it
    /// is wide is that many pixels wide.
    ///
    /// Limited to 1/16 … 8191, the size to 1023 × 1023; NaN is 1/16.
    #[must_use]
    pub const fn focal(pixels: f32, size: Size) -> Self {
        Self::with_focal(bits_from_f32(pixels, 16), size)
    }

    const fn with_focal(focal: i32, size: Size) -> Self {
        let focal = if focal < MIN_FOCAL {
            MIN_FOCAL
        } else if focal > MAX_FOCAL {
            MAX_FOCAL
        } else {
            focal
        };
        Self {
            projection: Projection {
                focal: I16F16::from_bits(focal),
                width: limited(size.width),
                height: limited(size.height),
                near: I16F16::from_bits(1 << 12),
            },
            pose: Pose::IDENTITY,
        }
    }

    /// The same with the near plane at this distance, 1/16 before; at least 2⁻¹⁶, also for NaN.
    ///
    /// Depth is near/w in 16 bits: the nearer the plane, the coarser the depth of what is far.
    #[must_use]
    pub const fn near(mut self, distance: f32) -> Self {
        let bits = bits_from_f32(distance, 16);
        self.projection.near = I16F16::from_bits(if bits < 1 { 1 } else { bits });
        self
    }

    /// The same, standing at `position`.
    #[must_use]
    pub const fn at(mut self, position: Vec3) -> Self {
        self.pose.translation = position;
        self
    }

    /// The same, standing and turned as `pose` says; the pose of an object that the camera is
    /// mounted on. Its scale is not used.
    #[must_use]
    pub const fn pose(mut self, pose: Pose) -> Self {
        self.pose = pose;
        self
    }

    /// The same, turned to look at `target`, with `up` upwards on the screen.
    ///
    /// Where that says nothing (`target` is where the camera stands, or `up` points along the
    /// line of sight) the turn stays as it was.
    #[must_use]
    pub const fn look_at(mut self, target: Vec3, up: Vec3) -> Self {
        let (from, to, up) = (self.pose.translation.bits(), target.bits(), up.bits());
        let back = normalized(difference(from, to));
        let up = normalized([up[0] as i64, up[1] as i64, up[2] as i64]);
        if let (Some(back), Some(up)) = (back, up)
            && let Some(right) = normalized(cross(up, back))
            && let Some(up) = normalized(cross(back, right))
        {
            let mut i = 0;
            while i < 3 {
                self.pose.rotation[i] = [unit14(right[i]), unit14(up[i]), unit14(back[i])];
                i += 1;
            }
        }
        self
    }

    /// Draws a mesh, standing as `pose` says, into a band.
    ///
    /// Triangles that cross the near plane or leave the guard band are clipped; those that turn
    /// away are culled as the shader says. Whatever the numbers, it draws or leaves out, and
    /// never fails.
    pub fn draw<F, D, S>(&self, mesh: &Mesh<'_>, pose: &Pose, shader: &S, band: &mut Band<'_, F, D>)
    where
        F: PixelFormat,
        D: DepthFormat,
        S: Shader<F>,
    {
        pipeline::draw(mesh, &self.projection, &self.pose, pose, shader, band);
    }
}

const fn limited(side: u32) -> u16 {
    if side > 1023 { 1023 } else { side as u16 }
}

const fn difference(a: [i32; 3], b: [i32; 3]) -> [i64; 3] {
    [a[0] as i64 - b[0] as i64, a[1] as i64 - b[1] as i64, a[2] as i64 - b[2] as i64]
}

const fn cross(a: [i32; 3], b: [i32; 3]) -> [i64; 3] {
    [
        a[1] as i64 * b[2] as i64 - a[2] as i64 * b[1] as i64,
        a[2] as i64 * b[0] as i64 - a[0] as i64 * b[2] as i64,
        a[0] as i64 * b[1] as i64 - a[1] as i64 * b[0] as i64,
    ]
}

/// The direction of a vector as a unit vector of 30 fraction bits; `None` for one without.
const fn normalized(v: [i64; 3]) -> Option<[i32; 3]> {
    let largest = v[0].unsigned_abs() | v[1].unsigned_abs() | v[2].unsigned_abs();
    if largest == 0 {
        return None;
    }
    // 30 bits, so that the sum of squares fits 62.
    let zeros = largest.leading_zeros();
    let mut n = [0i64; 3];
    let mut squares = 0u64;
    let mut i = 0;
    while i < 3 {
        n[i] = if zeros >= 34 { v[i] << (zeros - 34) } else { v[i] >> (34 - zeros) };
        squares += (n[i] * n[i]) as u64;
        i += 1;
    }
    let length = squares.isqrt() as i64;
    Some([((n[0] << 30) / length) as i32, ((n[1] << 30) / length) as i32, ((n[2] << 30) / length) as i32])
}

/// A component of a unit vector, 30 fraction bits down to 14.
const fn unit14(component: i32) -> I2F14 {
    I2F14::from_bits(((component + (1 << 15)) >> 16) as i16)
}

#[cfg(test)]
mod tests {
    use super::*;

    const SIZE: Size = Size::new(160, 120);

    #[test]
    fn a_right_angle_sees_a_screen_as_high_as_twice_the_focal_length() {
        assert_eq!(Camera::perspective(Turn::from_degrees(90), SIZE).projection.focal, 60);
    }

    #[test]
    fn look_at_makes_right_handed_axes() {
        let camera = Camera::perspective(Turn::from_degrees(60), SIZE)
            .at(Vec3::lit(5.0, 0.0, 0.0))
            .look_at(Vec3::ZERO, Vec3::lit(0.0, 1.0, 0.0));
        // Looking along −x from +x: right is −z, up is y, back is +x.
        let r = camera.pose.rotation;
        assert_eq!([r[0][0], r[1][0], r[2][0]], [I2F14::ZERO, I2F14::ZERO, -I2F14::ONE]);
        assert_eq!([r[0][1], r[1][1], r[2][1]], [I2F14::ZERO, I2F14::ONE, I2F14::ZERO]);
        assert_eq!([r[0][2], r[1][2], r[2][2]], [I2F14::ONE, I2F14::ZERO, I2F14::ZERO]);
    }

    #[test]
    fn nothing_panics_on_numbers_that_are_none() {
        for bad in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, 0.0, -1.0, f32::MAX, f32::MIN_POSITIVE] {
            let camera = Camera::focal(bad, SIZE)
                .near(bad)
                .at(Vec3::lit(bad, bad, bad))
                .look_at(Vec3::lit(bad, 0.0, bad), Vec3::lit(0.0, bad, bad));
            assert!(camera.projection.focal.to_bits() >= MIN_FOCAL && camera.projection.near > 0);
        }
        let _ = Camera::perspective(Turn::ZERO, Size::new(0, u32::MAX));
        let same = Camera::focal(80.0, SIZE);
        assert_eq!(same.look_at(Vec3::ZERO, Vec3::ZERO), same);
    }
}
