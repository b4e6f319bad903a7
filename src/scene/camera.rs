//! The camera: where from and how wide a scene is seen.

use super::Mesh;
use super::projection::{MIN_NEAR, Projection, clamped, limited};
use crate::math::{Pose, Turn, Vec3, normalized};
use crate::num::{I2F14, I12F4, I16F16, U1F31, bits_from_f32};
use crate::pipeline::{self, Stats};
use crate::target::Canvas;
use core::fmt;
use embedded_graphics::geometry::{Point, Size};

/// A camera and its place in the world.
///
/// Unless placed otherwise it stands at the origin and looks along −z, with +x right and +y up.
///
/// ```
/// use fixel::prelude::*;
/// use fixel::embedded_graphics::geometry::Size;
/// const CAMERA: Camera = Camera::perspective(Turn::from_degrees(60), Size::new(240, 240))
///     .near(0.25)
///     .at(Vec3::lit(0.0, 1.0, 5.0))
///     .look_at(Vec3::ZERO, Vec3::lit(0.0, 1.0, 0.0));
/// // The origin is in the middle of the screen.
/// let middle = CAMERA.project(Vec3::ZERO).unwrap();
/// assert_eq!([middle.x, middle.y], [120, 120]);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Camera {
    projection: Projection,
    /// The camera's axes in the world, as columns of the rotation; its scale is not used.
    pose: Pose,
}

/// A point of the world on the screen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Projected {
    /// Pixels from the left edge; pixel centres are at +½.
    pub x: I12F4,
    /// Pixels from the top edge, down.
    pub y: I12F4,
    /// near/w (perspective) or 1 at the near and 0 at the far plane (orthographic), to compare with depth.
    pub q: U1F31,
}

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
        let focal = if sin > 0 { (height << 15) * cos / sin } else { i64::MAX };
        Self::new(focal, false, size)
    }

    /// A camera whose screen is `pixels` pixels away from the eye: an object as far away as it
    /// is wide is that many pixels wide.
    ///
    /// Limited to 1/16 … 8191, the size to 1023 × 1023; NaN is 1/16.
    #[must_use]
    pub const fn focal(pixels: f32, size: Size) -> Self {
        Self::new(bits_from_f32(pixels, 16) as i64, false, size)
    }

    /// A camera without perspective: everything is `pixels_per_unit` pixels a world unit, near or far.
    ///
    /// It sees from 1/16 to 256 in front of it; depth is linear between. Limited as [`Camera::focal`].
    #[must_use]
    pub const fn orthographic(pixels_per_unit: f32, size: Size) -> Self {
        Self::new(bits_from_f32(pixels_per_unit, 16) as i64, true, size)
    }

    const fn new(focal: i64, orthographic: bool, size: Size) -> Self {
        Self { projection: Projection::new(focal, orthographic, size), pose: Pose::IDENTITY }
    }

    /// The same with the near plane at this distance, 1/16 before.
    ///
    /// Limited to 1/256 … 32767.99998, of orthographic cameras too; NaN is 1/256. [`Camera::try_near`] says so instead.
    ///
    /// Depth is near/w in 16 bits: the nearer the plane, the coarser the depth of what is far.
    #[must_use]
    pub const fn near(mut self, distance: f32) -> Self {
        let bits = bits_from_f32(distance, 16);
        self.projection.near = I16F16::from_bits(if bits < MIN_NEAR { MIN_NEAR } else { bits });
        self
    }

    /// As [`Camera::near`], for a distance that is not known to be one that a near plane can have.
    ///
    /// ```
    /// use fixel::{Camera, PlaneError, embedded_graphics::geometry::Size};
    /// let camera = Camera::focal(100.0, Size::new(160, 120));
    /// assert_eq!(camera.try_near(0.25), Ok(camera.near(0.25)));
    /// assert_eq!(camera.try_near(0.001), Err(PlaneError::TooNear));
    /// ```
    ///
    /// # Errors
    ///
    /// [`PlaneError`] if [`Camera::near`] would have to limit it.
    pub const fn try_near(self, distance: f32) -> Result<Self, PlaneError> {
        match PlaneError::of(distance, MIN_NEAR) {
            Some(error) => Err(error),
            None => Ok(self.near(distance)),
        }
    }

    /// The same with a far plane at this distance, beyond which nothing is drawn: nothing at all, unless the near plane is nearer.
    ///
    /// Limited to 2⁻¹⁶ … 32767.99998, which is none for a camera with perspective; NaN is 2⁻¹⁶. [`Camera::try_far`] says so
    /// instead.
    #[must_use]
    pub const fn far(mut self, distance: f32) -> Self {
        let bits = bits_from_f32(distance, 16);
        self.projection.far = I16F16::from_bits(if bits < 1 { 1 } else { bits });
        self
    }

    /// As [`Camera::far`], for a distance that is not known to be one that a far plane can have.
    ///
    /// # Errors
    ///
    /// [`PlaneError`] if [`Camera::far`] would have to limit it.
    pub const fn try_far(self, distance: f32) -> Result<Self, PlaneError> {
        match PlaneError::of(distance, 1) {
            Some(error) => Err(error),
            None => Ok(self.far(distance)),
        }
    }

    /// The same picture with its top left corner elsewhere on the screen (at most ±1023): `size` is then that of a part
    /// of the screen. Outside it nothing is drawn.
    #[must_use]
    pub const fn viewport(mut self, top_left: Point) -> Self {
        self.projection = self.projection.moved_to(top_left.x, top_left.y);
        self
    }

    /// The same with the line of sight meeting the screen off its middle, by so many pixels (at most ±511): an off-axis
    /// projection, for stereo pairs and for mirrors.
    #[must_use]
    pub const fn off_axis(mut self, right: I12F4, down: I12F4) -> Self {
        let projection = &mut self.projection;
        let viewport = projection.viewport;
        projection.center = [
            viewport.left as i32 * 16 + viewport.width as i32 * 8 + clamped(right.to_bits() as i32, 511 * 16),
            viewport.top as i32 * 16 + viewport.height as i32 * 8 + clamped(down.to_bits() as i32, 511 * 16),
        ];
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

    /// The same on a sphere around `target`, looking at it: at `yaw` 0 and `pitch` 0 from +z, with yaw
    /// to the right and with pitch upwards.
    #[must_use]
    pub fn orbit(mut self, target: Vec3, distance: I16F16, yaw: Turn, pitch: Turn) -> Self {
        self.pose.rotation = Pose::IDENTITY.rotated_x(-pitch).rotated_y(yaw).rotation;
        self.pose.translation = target;
        self.pose.translation = moved(&self.pose, [0, 0, distance.to_bits().into()]);
        self
    }

    /// The same, flown by so much to the right, upwards and forwards as it is turned now.
    #[must_use]
    pub fn flown(mut self, right: I16F16, up: I16F16, forward: I16F16) -> Self {
        let step = [right.to_bits().into(), up.to_bits().into(), -i64::from(forward.to_bits())];
        self.pose.translation = moved(&self.pose, step);
        self
    }

    /// The same in a level flight's attitude: turned left by `yaw` from −z, then nose up by `pitch`, then its right wing up
    /// by `roll`.
    #[must_use]
    pub const fn heading(mut self, yaw: Turn, pitch: Turn, roll: Turn) -> Self {
        self.pose.rotation = Pose::IDENTITY.rotated_z(roll).rotated_x(pitch).rotated_y(yaw).rotation;
        self
    }

    pub(crate) const fn projection(&self) -> &Projection {
        &self.projection
    }

    /// Where the camera stands and how it is turned.
    #[must_use]
    pub const fn placement(&self) -> &Pose {
        &self.pose
    }

    /// The focal length in pixels, or the pixels of a world unit of an orthographic camera, as it is used.
    #[must_use]
    pub const fn focal_length(&self) -> I16F16 {
        self.projection.focal
    }

    /// Whether the camera is without perspective.
    #[must_use]
    pub const fn is_orthographic(&self) -> bool {
        self.projection.orthographic
    }

    /// The distances of the near and the far plane; a perspective camera without a far plane has `I16F16::MAX`.
    #[must_use]
    pub const fn planes(&self) -> (I16F16, I16F16) {
        (self.projection.near, self.projection.far)
    }

    /// Where on the screen the line of sight meets it, in pixels.
    #[must_use]
    pub const fn center(&self) -> (I12F4, I12F4) {
        let [x, y] = self.projection.center;
        (I12F4::from_bits(x as i16), I12F4::from_bits(y as i16))
    }

    /// Where a point of the world is on the screen; `None` if it is not between the planes or not
    /// within ±1022¾ px, where clipping cuts.
    #[must_use]
    pub fn project(&self, point: Vec3) -> Option<Projected> {
        let at = pipeline::project(&self.projection, &self.pose, point)?;
        Some(Projected { x: at.x, y: at.y, q: at.q })
    }

    /// The point of the world that is seen at a place of the screen, at a distance along the line of sight (its w);
    /// saturated at the world's ends. Where on the ground a pixel lies, say, follows from two of them.
    #[must_use]
    pub fn unproject(&self, x: I12F4, y: I12F4, distance: I16F16) -> Vec3 {
        let projection = &self.projection;
        let focal = i64::from(projection.focal.to_bits());
        let offset = |at: I12F4, axis: usize| {
            let pixels = i64::from(at.to_bits()) - i64::from(projection.center[axis]); // 1/16 px
            let depth = if projection.orthographic { 1 << 16 } else { i64::from(distance.to_bits()) };
            // Far beyond the world's ends, but sums of three still fit.
            (((pixels * depth) << 12) / focal).clamp(-1 << 46, 1 << 46)
        };
        moved(&self.pose, [offset(x, 0), -offset(y, 1), -i64::from(distance.to_bits())])
    }

    /// Draws a mesh, standing as `pose` says: into a band at once, or into a display list, which keeps mesh and shader
    /// borrowed and may be full.
    ///
    /// Triangles that cross the near plane or leave the guard band are clipped; those that turn
    /// away are culled as the shader says.
    ///
    /// A vertex is placed as the numbers of mesh, pose and camera say, rounded to 1/16 px. Before rounding it is off by at most 1/1024
    /// px, and nearer than ¼ of a unit (of the mesh or of the world, whichever is longer) by ¼/w of that as much, but not by more than
    /// 1/128 px, up to the near plane: for focal lengths of up to 1024 pixels and scales of up to 100, at any distance from the
    /// world's origin. At the largest scale it may be 1/22 px there. So it is with the corners at which planes cut a triangle; and
    /// none that is seen is left out, at any scale.
    ///
    /// Whatever the numbers, it draws or leaves out, and never fails but for want of room in a list: coordinates at the ends of
    /// every format, vertices that coincide, scale 0, rotations that are none, everything behind the eye, a vertex in the eye,
    /// targets of 0 × 0 or 1 × 1 pixels, viewports beyond the target, far planes before near ones. What is
    /// left out is what [`Stats`] counts.
    pub fn draw<'a, S, C>(&self, mesh: &Mesh<'a>, pose: &Pose, shader: &'a S, canvas: &mut C) -> C::Output
    where
        C: Canvas<'a, S>,
    {
        canvas.draw_mesh(self, mesh, pose, shader, &mut ())
    }

    /// As [`Camera::draw`], and counts what became of the mesh.
    pub fn draw_counted<'a, S, C>(
        &self,
        mesh: &Mesh<'a>,
        pose: &Pose,
        shader: &'a S,
        canvas: &mut C,
        stats: &mut Stats,
    ) -> C::Output
    where
        C: Canvas<'a, S>,
    {
        canvas.draw_mesh(self, mesh, pose, shader, stats)
    }
}

/// A distance that a clipping plane cannot have.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PlaneError {
    /// Below 1/256 for a near plane, below 2⁻¹⁶ for a far one.
    TooNear,
    /// 32768 or more.
    TooFar,
    /// Not a number.
    NotANumber,
}

impl PlaneError {
    const fn of(distance: f32, least: i32) -> Option<Self> {
        if distance.is_nan() {
            Some(Self::NotANumber)
        } else if distance >= 32768.0 {
            Some(Self::TooFar)
        } else if bits_from_f32(distance, 16) < least {
            Some(Self::TooNear)
        } else {
            None
        }
    }
}

impl fmt::Display for PlaneError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::TooNear => "a near plane is at least 1/256 away, a far one 1/65536",
            Self::TooFar => "a clipping plane is less than 32768 away",
            Self::NotANumber => "the distance of a clipping plane is not a number",
        })
    }
}

impl core::error::Error for PlaneError {}

/// The point of the world at a place in the space of an eye (within ±2⁴⁶, I16F16), saturated at the world's ends.
fn moved(pose: &Pose, eye: [i64; 3]) -> Vec3 {
    let along = |axis: usize| {
        let sum: i64 = pose.rotation[axis].iter().zip(eye).map(|(r, e)| i64::from(r.to_bits()) * e).sum();
        let at = ((sum + (1 << 13)) >> 14) + i64::from(pose.translation.bits()[axis]);
        I16F16::from_bits(at.clamp(i32::MIN.into(), i32::MAX.into()) as i32)
    };
    Vec3::new(along(0), along(1), along(2))
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
    fn near_planes_are_at_least_a_256th_away_and_try_near_says_so() {
        for camera in [Camera::focal(80.0, SIZE), Camera::orthographic(8.0, SIZE)] {
            for (distance, error) in [
                (0.0, PlaneError::TooNear),
                (-1.0, PlaneError::TooNear),
                (f32::NEG_INFINITY, PlaneError::TooNear),
                (1.0 / 65536.0, PlaneError::TooNear),
                (255.0 / 65536.0, PlaneError::TooNear),
                (f32::NAN, PlaneError::NotANumber),
            ] {
                assert_eq!(camera.near(distance).planes().0.to_bits(), 256, "{distance}");
                assert_eq!(camera.try_near(distance), Err(error), "{distance}");
            }
            for distance in [32768.0, f32::INFINITY, f32::MAX] {
                assert_eq!(camera.near(distance).planes().0, I16F16::MAX);
                assert_eq!(camera.try_near(distance), Err(PlaneError::TooFar));
                assert_eq!(camera.try_far(distance), Err(PlaneError::TooFar));
            }
            for (distance, bits) in [(1.0 / 256.0, 256), (257.0 / 65536.0, 257), (32767.0, 32767 << 16)] {
                let near = camera.try_near(distance).expect("near enough and far enough");
                assert_eq!((near.planes().0.to_bits(), near), (bits, camera.near(distance)));
            }
            assert_eq!(camera.try_far(1.0 / 65536.0), Ok(camera.far(1.0 / 65536.0)));
            assert_eq!(camera.try_far(0.0), Err(PlaneError::TooNear));
            assert_eq!(camera.try_far(f32::NAN), Err(PlaneError::NotANumber));
        }
    }

    #[test]
    fn nothing_panics_on_numbers_that_are_none() {
        for bad in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, 0.0, -1.0, f32::MAX, f32::MIN_POSITIVE] {
            let camera = Camera::focal(bad, SIZE)
                .near(bad)
                .at(Vec3::lit(bad, bad, bad))
                .look_at(Vec3::lit(bad, 0.0, bad), Vec3::lit(0.0, bad, bad));
            assert!(camera.projection.focal.to_bits() >= 1 << 12 && camera.projection.near >= 1.0 / 256.0);
        }
        let _ = Camera::perspective(Turn::ZERO, Size::new(0, u32::MAX));
        let same = Camera::focal(80.0, SIZE);
        assert_eq!(same.look_at(Vec3::ZERO, Vec3::ZERO), same);
    }
}
