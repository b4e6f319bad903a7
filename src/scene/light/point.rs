//! A point light around one mesh: how much of it arrives at a place.

use super::normal::{Direction, Normal, facing, magnitude64};
use super::stretch::Stretch;
use crate::math::recip::Reciprocal;
use crate::math::{Pose, Vec3};
use crate::num::{I2F14, I4F12, I16F16, leading_zeros, wide, zeros_of};
use core::{array, num::NonZeroU16};

/// The functions of point lights. A light that is one refers to them: so only programs that make one link them.
#[derive(Debug)]
pub(super) struct PointCode {
    pub(super) bring: BringPoint,
    pub(super) at: PointAt,
}

/// Brings one to a mesh that stands as a pose says, and may be stretched: from its place and range, and its colour. `None` if its light
/// reaches nothing.
type BringPoint = fn(&Pose, Option<&Stretch<'_>>, (Vec3, I16F16), [u8; 3]) -> Option<LocalPoint>;

/// [`LocalPoint::at`].
pub(super) type PointAt = fn(&LocalPoint, Option<&Stretch<'_>>, [I4F12; 3], Normal, bool) -> u32;

pub(super) const POINT: &PointCode = &PointCode { bring, at: LocalPoint::at };

/// There is but one.
impl PartialEq for PointCode {
    fn eq(&self, _: &Self) -> bool {
        true
    }
}

impl Eq for PointCode {}

fn bring(
    pose: &Pose,
    stretch: Option<&Stretch<'_>>,
    (position, range): (Vec3, I16F16),
    color: [u8; 3],
) -> Option<LocalPoint> {
    let (axes, unit) = match stretch {
        None => (&pose.rotation, (pose.scale[0].to_bits().max(1), 0)),
        Some(stretch) => (stretch.axes(), (1 << 22, stretch.unit_log2())),
    };
    (range > 0)
        .then(|| LocalPoint::new(position_in_axes(axes, pose.translation, position), unit, range, color))
}

/// A point light in mesh space, or around a stretched mesh in the axes of the world.
#[derive(Clone, Copy, Debug)]
pub(super) struct LocalPoint {
    /// In units of 2^−`unit_bits`, within ±2²⁹.
    position: [i32; 3],
    /// −14 … 26: as fine as the light's distance from the mesh's origin allows.
    unit_bits: i8,
    /// (Unit / range)² is `inverse` · 2^(2 · `unit_bits` − 32 − `shift`), 2¹⁵ … 2¹⁶ − 1.
    inverse: NonZeroU16,
    shift: i16,
    pub(super) color: [u8; 3],
}

impl LocalPoint {
    /// At a place in units of the world (27 fraction bits, below 2⁴⁷); its own unit is `scale` (22 fraction bits, not 0) times
    /// 2^`log2` of these (−19 … 12).
    #[inline(never)]
    fn new(from_origin: [i64; 3], (scale, log2): (u32, i32), range: I16F16, color: [u8; 3]) -> Self {
        let range = range.to_bits().unsigned_abs();
        // Of 29 bits, over the unit: position = numerator · 2^(excess − 27) · 2²² / scale / 2^log2.
        let excess = 64 - leading_zeros(magnitude64(from_origin)) as i32 - 29;
        let numerator = from_origin
            .map(|component| (if excess >= 0 { component >> excess } else { component << -excess }) as i32);
        // `precise` takes 31 bits.
        let halved = scale >> 31;
        let Reciprocal { mantissa, zeros } = Reciprocal::precise(scale >> halved);
        let exponent = 36 - excess - zeros as i32 + halved as i32 + log2;
        let unit_bits = exponent.min(26);
        let position = numerator
            .map(|component| (wide(component, mantissa) >> 31) as i32 >> (exponent - unit_bits).min(31));

        // scale / range = ratio · 2^(zeros of range − zeros of scale − 36), 2²⁹ … 2³¹ − 1.
        let Reciprocal { mantissa, zeros } = Reciprocal::coarse(range);
        let scale_zeros = zeros_of(scale);
        let ratio = (wide(((scale << scale_zeros) >> 1) as i32, mantissa) >> 31) as i32;
        let square = (wide(ratio, ratio) >> 31) as u32;
        let square_zeros = zeros_of(square);
        // Its first bit is set anyway; the type's unused 0 saves room.
        let inverse = NonZeroU16::MIN | ((square << square_zeros) >> 16) as u16;
        let inverse_exponent = 2 * (zeros as i32 - scale_zeros as i32 + log2) - 25 - square_zeros as i32;
        let shift = 2 * unit_bits - 32 - inverse_exponent;

        // −14 … 26; −110 … 148.
        Self { position, unit_bits: unit_bits as i8, inverse, shift: shift as i16, color }
    }

    /// The cosine that counts times the attenuation, 14 fraction bits.
    fn at(
        &self,
        stretch: Option<&Stretch<'_>>,
        position: [I4F12; 3],
        normal: Normal,
        two_sided: bool,
    ) -> u32 {
        // 26 fraction bits, within ±2²⁹·⁶.
        let place = match stretch {
            None => position.map(|at| i32::from(at.to_bits()) << 14),
            Some(stretch) => stretch.place(position),
        };
        let coarser = (26 - i32::from(self.unit_bits)).min(31);
        let offset: [i32; 3] = array::from_fn(|i| self.position[i] - (place[i] >> coarser));
        let Some(direction) = Direction::of(offset) else { return 0 };
        let cosine = facing(normal.dot(direction.vector), two_sided);

        // d²/range² in 16 bits; from the range on it has more.
        let shift = i32::from(self.shift) - 2 * direction.exponent;
        let quotient = (direction.squares >> 16) * u32::from(self.inverse.get());
        if cosine == 0 || shift < 0 {
            return 0;
        }
        let Some(left) = 0xffffu32.checked_sub(quotient.checked_shr(shift as u32).unwrap_or(0)) else {
            return 0;
        };
        let attenuation = (left * left) >> 16;

        // 16 × 15 bits.
        let (inverse, shift) = direction.inverse_length();
        ((((cosine >> 15) * inverse) >> shift) * attenuation) >> 16
    }
}

/// Where a place in the world is as seen from the mesh's origin along axes, but in units of the world; 27
/// fraction bits, below 2⁴⁷.
///
/// The transpose of a rotation of 14 fraction bits is its inverse only to 2⁻¹³, which would show on a
/// surface close to the light. One step of refinement, x += Rᵀ(p − R·x), squares that.
#[inline(never)]
fn position_in_axes(axes: &[[I2F14; 3]; 3], origin: Vec3, position: Vec3) -> [i64; 3] {
    let rotation = |row: usize, column: usize| i64::from(axes[row][column].to_bits());
    let turned_back = |v: [i64; 3], column: usize| {
        rotation(0, column) * v[0] + rotation(1, column) * v[1] + rotation(2, column) * v[2]
    };
    let (to, from) = (position.bits(), origin.bits());
    let offset: [i64; 3] = array::from_fn(|i| i64::from(to[i]) - i64::from(from[i])); // below 2³²
    // 30 fraction bits to 27: below 2⁴⁵·⁶.
    let estimate: [i64; 3] = array::from_fn(|i| turned_back(offset, i) >> 3);
    let residual: [i64; 3] = array::from_fn(|i| {
        // 41 fraction bits, below 2⁶²·².
        let turned =
            rotation(i, 0) * estimate[0] + rotation(i, 1) * estimate[1] + rotation(i, 2) * estimate[2];
        // Below 2³⁴ if the rotation is one.
        (((offset[i] << 25) - turned) >> 14).clamp(-1 << 40, 1 << 40)
    });
    array::from_fn(|i| estimate[i] + (turned_back(residual, i) >> 14))
}
