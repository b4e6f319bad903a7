//! Lights: how much arrives at a vertex or a face.
//!
//! Lambert's law: each light adds its colour times the cosine n·l between the surface's normal and the
//! direction to the light. The cosine is taken in mesh space: the lights are brought there once a draw, so that no
//! normal is ever turned.
//!
//! That is right as long as the pose keeps angles. A pose that stretches or shears the mesh turns normals otherwise than the
//! surface: there each normal and place that is lit is brought to where it stands ([`stretch`](super::stretch)).

use super::normal::{Normal, across_face, facing};
use super::point::{LocalPoint, POINT, PointAt, PointCode};
use super::stretch::Stretch;
use crate::math::{Pose, Vec3, dot, normalized};
use crate::num::{I2F14, I4F12, I16F16, U8F8};
use crate::scene::{Vertex, is_gray};
use core::{array, fmt, hint::black_box};

const MAX: usize = 4;

/// A light in the world: a sun or a lamp. Its colour is red, green and blue, 0 … 255, of what arrives where a surface faces it;
/// places and ranges are in units of the world.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Light {
    source: Source,
    color: [u8; 3],
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Source {
    /// Towards the light, of length 1.0 = 2³⁰; 0 if there is no direction.
    Directional([i32; 3]),
    Point {
        position: Vec3,
        range: I16F16,
        code: &'static PointCode,
    },
}

impl Light {
    /// Light that shines everywhere in one direction, (0, −1, 0) being straight down; `color` is what
    /// arrives where a surface faces it.
    ///
    /// The direction may have any length but 0, which gives no light. Costs one 64-bit integer square root and
    /// three 64-bit divides, in a `const` nothing.
    #[must_use]
    pub const fn directional(direction: Vec3, color: [u8; 3]) -> Self {
        Self { source: Source::Directional(towards(direction.bits())), color }
    }

    /// Light from a point; `color` is what arrives where a surface faces it from close by.
    ///
    /// At a distance d (as `range` in units of the world) that is multiplied by (1 − d²/`range`²)²: 1 at the light, 9/16 at half the range, exactly 0
    /// from `range` on, without an edge. A range of 0 or less gives no light, and the place where
    /// the light itself is gets none.
    #[must_use]
    pub const fn point(position: Vec3, color: [u8; 3], range: I16F16) -> Self {
        Self { source: Source::Point { position, range, code: POINT }, color }
    }
}

/// The opposite of a direction as a unit vector of 30 fraction bits; 0 for 0.
const fn towards([x, y, z]: [i32; 3]) -> [i32; 3] {
    match normalized([-(x as i64), -(y as i64), -(z as i64)]) {
        Some(unit) => unit,
        None => [0; 3],
    }
}

/// The lights of a scene: one that is everywhere, and at most [`Lights::MAX`] that shine from somewhere.
///
/// ```
/// use fixel::{Light, Lights, Vec3};
/// const SUN: Light = Light::directional(Vec3::lit(-1.0, -2.0, -1.0), [255, 250, 230]);
/// const DAY: Lights = Lights::new([40, 45, 60], &[SUN]);
/// # let _ = DAY;
/// ```
///
/// Too many do not compile:
///
/// ```compile_fail
/// # use fixel::{Light, Lights, Vec3};
/// # const SUN: Light = Light::directional(Vec3::lit(-1.0, -2.0, -1.0), [255, 250, 230]);
/// const BAD: Lights = Lights::new([40, 45, 60], &[SUN; 5]);
/// # let _ = BAD;
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Lights<'a> {
    ambient: [u8; 3],
    lights: &'a [Light],
}

impl<'a> Lights<'a> {
    /// How many lights there can be beside the ambient one.
    pub const MAX: usize = MAX;

    /// Lights in a `const`: too many are a compile error.
    ///
    /// # Panics
    ///
    /// Outside a `const`, on more than [`Lights::MAX`]. See [`Lights::try_new`].
    #[must_use]
    pub const fn new(ambient: [u8; 3], lights: &'a [Light]) -> Self {
        match Self::try_new(ambient, lights) {
            Ok(lights) => lights,
            Err(_) => panic!("more than four lights"),
        }
    }

    /// Lights whose number is known at run time.
    ///
    /// # Errors
    ///
    /// [`LightsError`] for more than [`Lights::MAX`].
    pub const fn try_new(ambient: [u8; 3], lights: &'a [Light]) -> Result<Self, LightsError> {
        if lights.len() > MAX {
            Err(LightsError { count: lights.len() })
        } else {
            Ok(Self { ambient, lights })
        }
    }

    /// Brings the lights to a mesh that stands as `pose` says: once a draw.
    ///
    /// A directional light costs 9 products, a point light 27 of 64 bits, and no divide.
    #[must_use]
    #[inline]
    pub fn in_mesh_space<'p>(&self, pose: &'p Pose) -> Lighting<'p> {
        let mut lighting = self.ambient_alone();
        self.bring(pose, &mut lighting);
        lighting
    }

    /// The ambient light around a mesh whose pose keeps angles.
    #[inline]
    pub(crate) fn ambient_alone<'p>(&self) -> Lighting<'p> {
        Lighting {
            count: 0,
            ambient: self.ambient,
            lights: [Local::NONE; MAX],
            stretch: None,
            point_at: |_, _, _, _, _| 0,
        }
    }

    /// As [`Lights::in_mesh_space`], to [ambient light alone](Self::ambient_alone). Returns whether all lights are grey.
    #[inline(never)]
    pub(crate) fn bring<'p>(&self, pose: &'p Pose, to: &mut Lighting<'p>) -> bool {
        let mut are_gray = is_gray(self.ambient);
        to.stretch = Stretch::of(pose);
        let stretch = to.stretch.as_ref();
        for &Light { source, color } in self.lights {
            are_gray &= is_gray(color);
            // There is room: `try_new` counted.
            let Some(place) = to.lights.get_mut(usize::from(to.count)) else {
                break;
            };
            match source {
                Source::Directional(towards) => {
                    let axes = stretch.map_or(&pose.rotation, Stretch::axes);
                    *place = Local::Directional { towards: turned_back(axes, towards), color };
                }
                Source::Point { position, range, code } => {
                    let Some(point) = (code.bring)(pose, stretch, (position, range), color) else {
                        continue;
                    };
                    to.point_at = code.at;
                    *place = Local::Point(point);
                }
            }
            to.count += 1;
        }
        are_gray
    }
}

/// More lights than [`Lights::MAX`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LightsError {
    /// How many there were.
    pub count: usize,
}

impl fmt::Display for LightsError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} lights, of which there can be {MAX}", self.count)
    }
}

impl core::error::Error for LightsError {}

/// [`Lights`] as they stand around one mesh, in its pose: for those who light vertices of their own. [Lit](crate::Material::lit)
/// materials do it by themselves.
///
/// ```
/// use fixel::{Light, Lights, Normal, Pose, Vec3, Vertex};
/// let suns = [Light::directional(Vec3::lit(0.0, -1.0, 0.0), [150; 3])]; // straight down
/// let lights = Lights::new([50; 3], &suns);
/// let pose = Pose::IDENTITY;
/// let around = lights.in_mesh_space(&pose);
/// let lit = |vertex: Vertex| around.at(vertex.position, Normal::from(vertex.normal), false)[0].to_num::<u8>();
/// let floor = Vertex::new(0.0, 0.0, 0.0).normal(0.0, 1.0, 0.0);
/// assert_eq!(lit(floor), 200); // it faces the light
/// assert_eq!(lit(floor.normal(0.0, -1.0, 0.0)), 50); // a ceiling: ambient light alone
/// ```
#[derive(Clone, Debug)]
// In this order, so that what a vertex in one light reads lies where short instructions reach.
#[repr(C)]
pub struct Lighting<'p> {
    /// How many lights there are, beside the ambient one.
    count: u8,
    ambient: [u8; 3],
    lights: [Local; MAX],
    /// If the pose does not keep angles.
    stretch: Option<Stretch<'p>>,
    /// What computes the light of a point light.
    point_at: PointAt,
}

const _: () = assert!(size_of::<Lighting<'_>>() <= 88 + 3 * size_of::<usize>());

#[derive(Clone, Copy, Debug)]
enum Local {
    Directional {
        /// 128/127 of a unit vector, I2F14, each within ±128/127: the product with the normal of a [`Vertex`](crate::Vertex)
        /// has 21 fraction bits.
        towards: [i16; 3],
        color: [u8; 3],
    },
    Point(LocalPoint),
}

impl Local {
    const NONE: Self = Self::Directional { towards: [0; 3], color: [0; 3] };
}

impl Lighting<'_> {
    /// The light that arrives at a place that faces the direction of `normal`: ambient + Σ max(0, n·l) ·
    /// colour · attenuation, limited to 255.0; `two_sided`: |n·l|.
    ///
    /// `normal` is one of the mesh; where the pose stretches the mesh, the light is that on the stretched surface. It is taken as it
    /// is: one that is too short gives less light.
    ///
    /// Within ¼ (of 255) of exact from the quantised normal, pose and lights, if the pose's matrix is a rotation or mirrors one, or
    /// at least stretches no direction more than 8 times as much as another (the scales do not count), and no point light is
    /// nearer than 1/1000 of a mesh unit (the longest, if scales differ) and 2⁻¹⁴ of a unit of the world. A rotation worn by
    /// many turns, but not yet by so much that its normals are treated as stretched: within 1. Whatever the numbers,
    /// within 0 … 255.
    ///
    /// A directional light costs 6 short products (about 170 cycles on a Cortex-M0+, at a vertex that has no other 100), a
    /// point light 20 and a reciprocal square root (400), less if it does not reach. Where the pose does not keep angles, a vertex with
    /// one directional light takes 800 more.
    #[must_use]
    pub fn at(&self, position: [I4F12; 3], normal: Normal, two_sided: bool) -> [U8F8; 3] {
        let normal = match &self.stretch {
            None => normal,
            Some(stretch) => stretch.normal(normal),
        };
        self.arriving(position, normal, two_sided)
    }

    /// As [`Lighting::at`], with a normal along the axes that the lights are in.
    #[inline(never)]
    fn arriving(&self, position: [I4F12; 3], normal: Normal, two_sided: bool) -> [U8F8; 3] {
        let mut sum = self.ambient.map(|channel| u32::from(channel) << 14);
        for light in self.lights() {
            // Hidden, so that there is one loop, not one for each.
            let two_sided = black_box(two_sided);
            let (cosine, color) = match light {
                Local::Directional { towards, color } => {
                    let cosine = facing(normal.dot(towards.map(i32::from)), two_sided);
                    let cosine = (cosine + (1 << 13)) >> 14;
                    // 127/128: 16513 to 16384.
                    (cosine - (cosine >> 7), color)
                }
                Local::Point(light) => {
                    let stretch = self.stretch.as_ref();
                    ((self.point_at)(light, stretch, position, normal, two_sided), &light.color)
                }
            };
            for (sum, &channel) in sum.iter_mut().zip(color) {
                // Four times 3.1 · 255 at most, for numbers that are no unit vectors.
                *sum += cosine * u32::from(channel);
            }
        }
        sum.map(limited)
    }

    /// [`Lighting::at`] a vertex, but for rounding. If all lights are [grey](Lights::bring) that may be said: it saves 20 cycles.
    #[inline(always)]
    pub(crate) fn at_vertex(&self, vertex: &Vertex, [two_sided, is_gray]: [bool; 2], to: &mut [U8F8; 3]) {
        // What there is most often, without the loop, whose invariants would be computed and kept on the stack.
        if let Self { count: 1, lights: [Local::Directional { towards, color }, ..], stretch: None, .. } =
            self
        {
            let [x, y, z] = vertex.normal.map(i32::from);
            let [to_x, to_y, to_z] = towards.map(i32::from);
            // 127 · 16513 is 16384 in 14 fraction bits.
            let cosine = (facing(x * to_x + y * to_y + z * to_z, two_sided) + (1 << 6)) >> 7;
            let arriving =
                |i: usize| limited((u32::from(self.ambient[i]) << 14) + cosine * u32::from(color[i]));
            let red = arriving(0);
            *to = if is_gray { [red; 3] } else { [red, arriving(1), arriving(2)] };
        } else {
            self.set_at(vertex, two_sided, to);
        }
    }

    /// Out of line, so that [`Lighting::at_vertex`] needs little stack.
    #[inline(never)]
    fn set_at(&self, vertex: &Vertex, two_sided: bool, to: &mut [U8F8; 3]) {
        *to = self.at(vertex.position, vertex.normal.into(), two_sided);
    }

    /// The light that arrives in the middle of a face, for flat shading: [`Lighting::at`] with
    /// [`Normal::of_face`], or, where the pose stretches it, with the normal of the stretched face, as exactly.
    #[must_use]
    pub fn at_face(&self, corners: [[I4F12; 3]; 3], two_sided: bool) -> [U8F8; 3] {
        let middle = array::from_fn(|i| {
            let sum: i32 = corners.iter().map(|corner| i32::from(corner[i].to_bits())).sum();
            // A third less 2·10⁻⁵ of it; below 2³¹.
            I4F12::from_bits(((sum * 21845) >> 16) as i16)
        });
        let across = across_face(corners);
        let normal = match &self.stretch {
            None => Normal::along(across),
            Some(stretch) => stretch.face_normal(across),
        };
        self.arriving(middle, normal, two_sided)
    }

    #[inline(always)]
    fn lights(&self) -> &[Local] {
        self.lights.get(..usize::from(self.count)).unwrap_or_default()
    }
}

/// Light of 14 fraction bits.
#[inline]
fn limited(light: u32) -> U8F8 {
    U8F8::from_bits((light.min(255 << 14) >> 6) as u16)
}

/// 128/127 of a direction of the world in mesh space, 30 fraction bits to 14: the rotation's inverse is its transpose.
#[inline(never)]
fn turned_back(rotation: &[[I2F14; 3]; 3], direction: [i32; 3]) -> [i16; 3] {
    array::from_fn(|column| turned_back_along(rotation, column, &direction))
}

/// One component of that. Not inlined: it is there once.
#[inline(never)]
fn turned_back_along(rotation: &[[I2F14; 3]; 3], column: usize, direction: &[i32; 3]) -> i16 {
    let axis = rotation.map(|row| row.get(column).map_or(0, |at| at.to_bits().into()));
    // 15 bits; beyond ±1 only if the rotation is none.
    let component = ((dot(axis, *direction) + (1 << 28)) >> 29).clamp(-1 << 15, 1 << 15) as i32;
    ((component * 16513 + (1 << 14)) >> 15) as i16
}

#[cfg(test)]
mod tests;
