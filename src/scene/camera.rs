//! The camera: where from and how wide a scene is seen.

use super::projection::{MIN_NEAR, Projection, clamped, limited};
use super::{LensError, PlaneError};
use crate::math::{Pose, Turn, Vec3, normalized};
use crate::num::{I2F14, I12F4, I16F16, bits_from_f32, bits_or_max};
use embedded_graphics::geometry::{Point, Size};

/// A camera and its place in the world.
///
/// Unless placed otherwise it stands at the origin and looks along −z, with +x right and +y up:
/// [`coordinates`](crate::guide::coordinates) has drawings.
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

impl Camera {
    /// A camera whose picture is `vertical` high, as an angle, on a screen of `size` pixels.
    ///
    /// The angle is limited to what gives a focal length of 1/16 to 8191 pixels, the size
    /// to 1023 × 1023: [`Camera::try_perspective`] says so.
    #[must_use]
    pub const fn perspective(vertical: Turn, size: Size) -> Self {
        Self::new(focal_of(vertical, size), false, size)
    }

    /// As [`Camera::perspective`], if nothing has to be limited.
    ///
    /// ```
    /// use fixel::embedded_graphics::geometry::Size;
    /// use fixel::{Camera, LensError, Turn};
    /// let size = Size::new(1280, 720);
    /// assert_eq!(Camera::try_perspective(Turn::from_degrees(60), size), Err(LensError::Size(size)));
    /// ```
    ///
    /// # Errors
    ///
    /// [`LensError::Size`] or [`LensError::Angle`].
    pub const fn try_perspective(vertical: Turn, size: Size) -> Result<Self, LensError> {
        if Projection::limits_size(size) {
            Err(LensError::Size(size))
        } else if Projection::limits_focal(focal_of(vertical, size)) {
            Err(LensError::Angle { vertical, height: size.height })
        } else {
            Ok(Self::perspective(vertical, size))
        }
    }

    /// A camera whose screen is `pixels` pixels away from the eye: an object as far away as it
    /// is wide is that many pixels wide.
    ///
    /// Limited to 1/16 … 8191, the size to 1023 × 1023; NaN is 1/16. [`Camera::try_focal`] says so.
    #[must_use]
    pub const fn focal(pixels: f32, size: Size) -> Self {
        Self::new(bits_from_f32(pixels, 16) as i64, false, size)
    }

    /// As [`Camera::focal`], if nothing has to be limited.
    ///
    /// # Errors
    ///
    /// [`LensError::Size`] or [`LensError::Focal`].
    pub const fn try_focal(pixels: f32, size: Size) -> Result<Self, LensError> {
        match limits(pixels, size) {
            Some(error) => Err(error),
            None => Ok(Self::focal(pixels, size)),
        }
    }

    /// A camera without perspective: everything is `pixels_per_unit` pixels a world unit, near or far.
    ///
    /// It sees from 1/16 to 256 in front of it; depth is linear between. Limited as [`Camera::focal`]:
    /// [`Camera::try_orthographic`] says so.
    #[must_use]
    pub const fn orthographic(pixels_per_unit: f32, size: Size) -> Self {
        Self::new(bits_from_f32(pixels_per_unit, 16) as i64, true, size)
    }

    /// As [`Camera::orthographic`], if nothing has to be limited.
    ///
    /// # Errors
    ///
    /// [`LensError::Size`] or [`LensError::Focal`].
    pub const fn try_orthographic(pixels_per_unit: f32, size: Size) -> Result<Self, LensError> {
        match limits(pixels_per_unit, size) {
            Some(error) => Err(error),
            None => Ok(Self::orthographic(pixels_per_unit, size)),
        }
    }

    const fn new(focal: i64, orthographic: bool, size: Size) -> Self {
        Self { projection: Projection::new(focal, orthographic, size), pose: Pose::IDENTITY }
    }

    /// The same with the near plane at this distance, in units of the world; 1/16 before.
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

    /// The same with a far plane at this distance, in units of the world, beyond which nothing is drawn: nothing at all, unless the near plane is nearer.
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
    ///
    /// A [mirrored](Pose::is_mirrored) pose shows the mirror image, a rear-view mirror's, of which fronts are seen as before. Of a
    /// matrix that is neither a rotation nor mirrors one the rows are what it is, not the inverse.
    #[must_use]
    pub const fn pose(mut self, pose: Pose) -> Self {
        self.pose = pose;
        self
    }

    /// The same, turned to look at `target`, with `up` upwards on the screen.
    ///
    /// The target is in the middle of the picture from everywhere. Only what is upwards may be left open: where `up` is 0 or points
    /// along the line of sight, there or back, within two millionths of a radian. Then +y of the world is upwards. Where that
    /// lies along the line of sight too, −z is upwards if the camera looks down, and +z if it looks up, as after a level flight
    /// towards −z ([`Camera::heading`] with a yaw of 0).
    ///
    /// Where the camera stands in its target, it stays turned as it was.
    #[must_use]
    pub const fn look_at(mut self, target: Vec3, up: Vec3) -> Self {
        let (from, to, up) = (self.pose.translation.bits(), target.bits(), up.bits());
        let Some(back) = normalized(difference(from, to)) else {
            return self;
        };
        let ahead = if back[1] > 0 { -UNIT } else { UNIT };
        let choices = [up, [0, UNIT, 0], [0, 0, ahead]];
        let mut choice = 0;
        while choice < choices.len() {
            if let Some(right) = to_the_right(choices[choice], back)
                && let Some(up) = normalized(cross(back, right))
            {
                let mut i = 0;
                while i < 3 {
                    self.pose.rotation[i] = [unit14(right[i]), unit14(up[i]), unit14(back[i])];
                    i += 1;
                }
                return self;
            }
            choice += 1;
        }
        self
    }

    /// The same on a sphere around `target`, looking at it from `distance` units of the world away: at `yaw` 0 and `pitch` 0
    /// from +z, with yaw to the right and with pitch upwards.
    ///
    /// ```
    /// use fixel::{embedded_graphics::geometry::Size, num::I16F16, prelude::*};
    /// let camera = Camera::focal(100.0, Size::new(160, 120));
    /// let right = camera.orbit(Vec3::ZERO, I16F16::lit("5"), Turn::from_degrees(90), Turn::ZERO);
    /// assert_eq!(right.placement().translation, Vec3::lit(5.0, 0.0, 0.0));
    /// ```
    #[must_use]
    pub fn orbit(mut self, target: Vec3, distance: I16F16, yaw: Turn, pitch: Turn) -> Self {
        self.pose.rotation = Pose::IDENTITY.rotated_x(-pitch).rotated_y(yaw).rotation;
        self.pose.translation = target;
        self.pose.translation = moved(&self.pose, [0, 0, distance.to_bits().into()]);
        self
    }

    /// The same, flown by so many units of the world to the right, upwards and forwards as it is turned now.
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

    /// The distances of the near and the far plane, in units of the world; a perspective camera without a far plane has `I16F16::MAX`.
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

    /// The point of the world that is seen at a place of the screen, at a distance along the line of sight (its w, in
    /// units of the world); saturated at the world's ends. Where on the ground a pixel lies, say, follows from two of them.
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
}

/// f = h/2 · cos(a/2) / sin(a/2), in I16F16 and not yet limited.
const fn focal_of(vertical: Turn, size: Size) -> i64 {
    let half = Turn::from_raw(vertical.raw() / 2);
    let (sin, cos) = (half.sin().to_bits() as i64, half.cos().to_bits() as i64);
    let height = limited(size.height) as i64;
    if sin > 0 { (height << 15) * cos / sin } else { i64::MAX }
}

/// What has to be limited of a focal length, or of pixels a world unit.
const fn limits(pixels: f32, size: Size) -> Option<LensError> {
    if Projection::limits_size(size) {
        Some(LensError::Size(size))
    } else if Projection::limits_focal(bits_or_max(pixels, 16)) {
        Some(LensError::Focal(pixels))
    } else {
        None
    }
}

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

/// 1.0 with 30 fraction bits.
const UNIT: i32 = 1 << 30;

/// At right angles to what is upwards, of any length, and to a unit vector backwards: a unit vector. `None` where these two lie in one
/// line, or so nearly that their rounding would decide: within 2⁻²⁰ radians, about.
///
/// (At right angles to `back` it is exactly, before it is rounded: the product of what is rounded already is exact.)
const fn to_the_right(up: [i32; 3], back: [i32; 3]) -> Option<[i32; 3]> {
    let Some(up) = normalized([up[0] as i64, up[1] as i64, up[2] as i64]) else {
        return None;
    };
    let [x, y, z] = cross(up, back); // 60 fraction bits
    let least = 1 << 40;
    if x.unsigned_abs() < least && y.unsigned_abs() < least && z.unsigned_abs() < least {
        return None;
    }
    normalized([x, y, z])
}

/// A component of a unit vector, 30 fraction bits down to 14.
const fn unit14(component: i32) -> I2F14 {
    I2F14::from_bits(((component + (1 << 15)) >> 16) as i16)
}

#[cfg(test)]
#[expect(clippy::float_arithmetic, reason = "the f64 truth of the tests")]
mod tests {
    use super::*;

    const SIZE: Size = Size::new(160, 120);

    #[test]
    fn a_right_angle_sees_a_screen_as_high_as_twice_the_focal_length() {
        assert_eq!(Camera::perspective(Turn::from_degrees(90), SIZE).projection.focal, 60);
    }

    #[test]
    fn what_a_camera_has_to_limit_is_a_typed_error_beside_it() {
        let degrees = Turn::from_degrees;
        for size in [SIZE, Size::new(1, 1), Size::new(1023, 1023)] {
            for vertical in [degrees(40), degrees(90)] {
                assert_eq!(Camera::try_perspective(vertical, size), Ok(Camera::perspective(vertical, size)));
            }
            for pixels in [0.0625, 1.0, 8191.0] {
                assert_eq!(Camera::try_focal(pixels, size), Ok(Camera::focal(pixels, size)));
                assert_eq!(Camera::try_orthographic(pixels, size), Ok(Camera::orthographic(pixels, size)));
            }
        }
        for size in [Size::new(1024, 1), Size::new(1, 1024), Size::new(u32::MAX, u32::MAX)] {
            let error = LensError::Size(size);
            assert_eq!(Camera::try_perspective(degrees(60), size), Err(error));
            assert_eq!(Camera::try_focal(100.0, size), Err(error));
            assert_eq!(Camera::try_orthographic(100.0, size), Err(error));
        }
        for pixels in [0.0, -1.0, 0.0624, 8191.1, f32::NAN, f32::INFINITY] {
            for tried in [Camera::try_focal(pixels, SIZE), Camera::try_orthographic(pixels, SIZE)] {
                let Err(LensError::Focal(found)) = tried else { panic!("{tried:?}") };
                assert_eq!(found.to_bits(), pixels.to_bits());
            }
        }
        // 60 px / tan(a/2) is 8191 px at 0.84°, and 1/16 px at 179.88°; beyond 180° there is no picture.
        for (vertical, fits) in [
            (Turn::ZERO, false),
            (Turn::from_raw(150), false), // 0.824°
            (Turn::from_raw(156), true),  // 0.857°
            (degrees(179), true),
            (degrees(180), false),
            (degrees(300), false),
        ] {
            let expected = if fits {
                Ok(Camera::perspective(vertical, SIZE))
            } else {
                Err(LensError::Angle { vertical, height: SIZE.height })
            };
            assert_eq!(Camera::try_perspective(vertical, SIZE), expected, "{vertical:?}");
        }
        assert_eq!(
            std::string::ToString::to_string(&LensError::Size(Size::new(1280, 720))),
            "a side of a camera's screen is at most 1023 pixels: 1280 × 720"
        );
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

    /// How far, in 1/16 px, the middle of the screen is from where the camera shows a point.
    fn off_the_middle(camera: &Camera, point: Vec3) -> Option<i32> {
        let at = camera.project(point)?;
        let [x, y] = camera.projection.center;
        Some((i32::from(at.x.to_bits()) - x).abs().max((i32::from(at.y.to_bits()) - y).abs()))
    }

    #[test]
    fn what_is_looked_at_from_straight_above_or_below_is_in_the_middle() {
        let up = Vec3::lit(0.0, 1.0, 0.0);
        for height in [30.0, -30.0] {
            let target = Vec3::lit(100.0, 0.0, 100.0);
            for yaw in [0, 77] {
                let camera = Camera::perspective(Turn::from_degrees(60), SIZE)
                    .heading(Turn::from_degrees(yaw), Turn::ZERO, Turn::ZERO)
                    .at(Vec3::lit(100.0, height, 100.0))
                    .look_at(target, up);
                assert_eq!(off_the_middle(&camera, target), Some(0), "from {height}");
                // As flown there from a level flight towards -z: what was before is up on the screen, from below it is down.
                let pitch = Turn::from_degrees(if height > 0.0 { -90 } else { 90 });
                assert_eq!(camera.pose.rotation, camera.heading(Turn::ZERO, pitch, Turn::ZERO).pose.rotation);
            }
        }
    }

    #[test]
    fn along_any_up_the_y_axis_is_up() {
        let camera = Camera::focal(80.0, SIZE).near(0.01);
        for target in [[0.0, 0.0, -3.0], [5.0, 0.0, 0.0], [1.0, 2.0, 3.0], [-0.01, 0.0, 0.02]] {
            let [x, y, z] = target;
            let target = Vec3::lit(x, y, z);
            let right = camera.look_at(target, Vec3::lit(0.0, 1.0, 0.0));
            for up in [target, -target, Vec3::ZERO, target + target] {
                assert_eq!(camera.look_at(target, up), right);
            }
        }
    }

    #[test]
    fn what_is_looked_at_is_in_the_middle_with_any_up_in_20_000_cases() {
        use proptest::prelude::*;
        let bits =
            || prop_oneof![any::<i32>(), -1000..1000i32, -2..=2i32, Just(0), (0..31u32).prop_map(|b| 1 << b)];
        let vector = || [bits(), bits(), bits()].prop_map(|bits| bits.map(I16F16::from_bits));
        let vector = || vector().prop_map(|[x, y, z]| Vec3::new(x, y, z));
        let cases = (
            vector(),
            vector(),
            prop_oneof![vector(), Just(Vec3::lit(0.0, 1.0, 0.0))],
            any::<bool>(),
            bits(),
        );
        let config = ProptestConfig { cases: 20_000, failure_persistence: None, ..ProptestConfig::default() };
        proptest!(config, |((at, target, up, along, bits) in cases)| {
            // An up that is almost along the line of sight, too.
            let up = if along { target - at + Vec3::new(I16F16::ZERO, I16F16::ZERO, I16F16::from_bits(bits % 3)) } else { up };
            let camera = Camera::focal(100.0, SIZE).near(0.0).at(at).look_at(target, up);
            let away = difference(target.bits(), at.bits());
            prop_assume!(away != [0; 3]);
            // Seen by f64: the rotation's elements are rounded to 2⁻¹⁴.
            let seen: [f64; 3] = core::array::from_fn(|axis| {
                (0..3).map(|i| f64::from(camera.pose.rotation[i][axis].to_bits()) / 16384.0 * away[i] as f64).sum()
            });
            let length = away.iter().map(|&c| (c as f64).powi(2)).sum::<f64>().sqrt();
            let most = length * 0.51 * 3f64.sqrt() / 16384.0;
            prop_assert!(seen[0].abs() <= most && seen[1].abs() <= most && seen[2] < 0.0, "{:?} {:?}", seen, camera.pose);
            // A rotation, and with `up` upwards or level.
            let pose = camera.pose;
            prop_assert!(pose.keeps_angles() && !pose.is_mirrored());
            let towards: f64 = (0..3)
                .map(|i| f64::from(pose.rotation[i][1].to_bits()) / 16384.0 * f64::from(up.bits()[i]))
                .sum();
            let long = up.bits().iter().map(|&c| f64::from(c).powi(2)).sum::<f64>().sqrt();
            prop_assert!(towards >= -long * 1e-4, "{} of {}: {:?}", towards, long, pose);
        });
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
