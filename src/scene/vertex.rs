//! Vertices of meshes: numbers from literals, checked.

use super::vertex_error::{VertexError, is_coordinate, is_texels};
use crate::num::{I4F12, I12F4, bits_or_max};

/// A vertex of a mesh, 16 bytes.
///
/// Any bytes are one, and it is [`Pod`](bytemuck::Pod): `bytemuck` casts bytes to vertices, and back.
///
/// ```
/// use fixel::Vertex;
/// // Mesh units; texels, v down; a direction of length 1; red, green and blue.
/// const CORNER: Vertex = Vertex::new(-1.0, 0.5, 0.0).uv(0, 32).normal(0.0, 0.6, 0.8).color(255, 200, 40);
/// assert_eq!(CORNER.position[1], 0.5);
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
pub struct Vertex {
    /// Position in mesh units; the pose places and scales it.
    pub position: [I4F12; 3],
    /// Texture coordinates in texels, (0, 0) the texture's first texel's outer corner.
    pub uv: [I12F4; 2],
    /// Red, green, blue, for [`Material::gouraud`](crate::Material::gouraud); red is alpha for
    /// [`Material::vertex_alpha`](crate::Material::vertex_alpha).
    pub color: [u8; 3],
    /// The direction that lights see, of length 1.0 = 127 in mesh space.
    pub normal: [i8; 3],
}

const _: () = assert!(size_of::<Vertex>() == 16);

/// Whether a colour's channels are the same.
pub(crate) const fn is_gray([red, green, blue]: [u8; 3]) -> bool {
    red == green && green == blue
}

impl Vertex {
    /// A vertex at a position from literals, −8 … 7.9998, each rounded to 1/4096. It is white, its texture
    /// coordinates and its normal are 0.
    ///
    /// In a `const` or `static` a coordinate outside that, or NaN, is a compile error:
    ///
    /// ```compile_fail,E0080
    /// # use fixel::Vertex;
    /// const FAR: Vertex = Vertex::new(100.0, -20.0, 0.0);
    /// # let _ = FAR;
    /// ```
    ///
    /// # Panics
    ///
    /// Elsewhere it panics then. See [`Vertex::try_new`].
    #[must_use]
    #[inline]
    #[track_caller]
    pub const fn new(x: f32, y: f32, z: f32) -> Self {
        // Straight on, without loops and arrays: no function is evaluated more often in constants, and the compiler's interpreter
        // takes half the time so.
        let (x_bits, y_bits, z_bits) = (bits_or_max(x, 12), bits_or_max(y, 12), bits_or_max(z, 12));
        if x_bits != x_bits as i16 as i64 || y_bits != y_bits as i16 as i64 || z_bits != z_bits as i16 as i64
        {
            panic!("{}", VertexError::of_position(x, y, z).in_plain_words());
        }
        Self {
            position: [
                I4F12::from_bits(x_bits as i16),
                I4F12::from_bits(y_bits as i16),
                I4F12::from_bits(z_bits as i16),
            ],
            uv: [I12F4::ZERO; 2],
            color: [255; 3],
            normal: [0; 3],
        }
    }

    /// As [`Vertex::new`], for numbers that come at run time; in software where there is no FPU.
    ///
    /// # Errors
    ///
    /// [`VertexError::Position`] for the first coordinate that is not within −8 … 7.9998.
    #[inline]
    pub const fn try_new(x: f32, y: f32, z: f32) -> Result<Self, VertexError> {
        if is_coordinate(x) && is_coordinate(y) && is_coordinate(z) {
            Ok(Self::new(x, y, z))
        } else {
            Err(VertexError::of_position(x, y, z))
        }
    }

    /// The same as opaque as `alpha` says, of 255, for [`Material::vertex_alpha`](crate::Material::vertex_alpha): that is red of
    /// [`Vertex::color`], which such materials need for nothing else. (All three channels are set.)
    #[must_use]
    pub const fn alpha(self, alpha: u8) -> Self {
        Self { color: [alpha; 3], ..self }
    }

    /// The same with texture coordinates in whole texels, −2048 … 2047. In a `const` or `static` one outside that is a compile
    /// error.
    ///
    /// # Panics
    ///
    /// Elsewhere it panics then. See [`Vertex::try_uv`].
    #[must_use]
    #[inline]
    #[track_caller]
    pub const fn uv(mut self, u: i16, v: i16) -> Self {
        if !is_texels(u) || !is_texels(v) {
            panic!("{}", VertexError::of_texels(u, v).in_plain_words());
        }
        self.uv = [I12F4::from_bits(u * 16), I12F4::from_bits(v * 16)];
        self
    }

    /// As [`Vertex::uv`], for numbers that come at run time.
    ///
    /// # Errors
    ///
    /// [`VertexError::TextureCoordinate`] for the first that is not within −2048 … 2047.
    #[inline]
    pub const fn try_uv(self, u: i16, v: i16) -> Result<Self, VertexError> {
        if is_texels(u) && is_texels(v) { Ok(self.uv(u, v)) } else { Err(VertexError::of_texels(u, v)) }
    }

    /// The same with texture coordinates in texels, in steps of 1/16: every number of the format is one.
    #[must_use]
    pub const fn uv_sixteenths(mut self, u: I12F4, v: I12F4) -> Self {
        self.uv = [u, v];
        self
    }

    /// The same with a normal from literals: a vector of length 1, each component rounded to 1/127.
    ///
    /// Two digits behind the point are enough: it may be up to 1/64 longer than 1 (a component above 1 is 1 then). It may be
    /// shorter, too, which makes the light weaker; of length 0 it faces nowhere. In a `const` or `static` one that is longer, or
    /// NaN, is a compile error: `.normal(1.0, 1.0, 1.0)` is no direction of length 1.
    ///
    /// # Panics
    ///
    /// Elsewhere it panics then. See [`Vertex::try_normal`].
    #[must_use]
    #[inline]
    #[track_caller]
    pub const fn normal(mut self, x: f32, y: f32, z: f32) -> Self {
        if !is_direction(x, y, z) {
            panic!("{}", VertexError::Normal { normal: [x, y, z] }.in_plain_words());
        }
        self.normal = [unit127(x), unit127(y), unit127(z)];
        self
    }

    /// As [`Vertex::normal`], for numbers that come at run time; in software where there is no FPU.
    ///
    /// # Errors
    ///
    /// [`VertexError::Normal`] if its length is more than 1 + 1/64, or no number.
    #[inline]
    pub const fn try_normal(self, x: f32, y: f32, z: f32) -> Result<Self, VertexError> {
        if is_direction(x, y, z) {
            Ok(self.normal(x, y, z))
        } else {
            Err(VertexError::Normal { normal: [x, y, z] })
        }
    }

    /// The same with a colour.
    #[must_use]
    pub const fn color(mut self, red: u8, green: u8, blue: u8) -> Self {
        self.color = [red, green, blue];
        self
    }
}

/// Whether it is not much longer than 1; not for NaN.
#[inline]
#[expect(clippy::float_arithmetic, reason = "set-up convenience, folded in constants")]
const fn is_direction(x: f32, y: f32, z: f32) -> bool {
    const LONGEST: f32 = 1.0 + 1.0 / 64.0;
    x * x + y * y + z * z <= LONGEST * LONGEST
}

/// A component of a direction.
#[inline]
#[expect(clippy::float_arithmetic, reason = "set-up convenience, folded in constants")]
const fn unit127(component: f32) -> i8 {
    let scaled = component * 127.0;
    // `as` saturates: −128 is −127.
    let bits = (if scaled < 0.0 { scaled - 0.5 } else { scaled + 0.5 }) as i8;
    if bits == -128 { -127 } else { bits }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::panic::catch_unwind;
    use std::string::ToString;

    const PLAIN: Vertex = Vertex::new(0.0, 0.0, 0.0);

    /// What is no position, and what is one: within half of the last bit, 1/8192, of −8 … 7.999756.
    const BAD: [f32; 9] =
        [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, f32::MAX, 100.0, -20.0, 8.0, 7.999_878, -8.000_123];
    const GOOD: [(f32, i16); 6] =
        [(-8.0, -32768), (-8.000_121, -32768), (7.999_877, 32767), (1.5, 6144), (-0.0, 0), (1e-40, 0)];

    #[test]
    fn a_coordinate_out_of_range_is_a_typed_error_and_panics_elsewhere() {
        for (good, bits) in GOOD {
            assert_eq!(Vertex::new(good, 1.0, -1.0).position.map(I4F12::to_bits), [bits, 4096, -4096]);
            assert_eq!(Vertex::try_new(good, 1.0, -1.0), Ok(Vertex::new(good, 1.0, -1.0)));
        }
        for bad in BAD {
            for (axis, [x, y, z]) in [('x', [bad, 0.0, bad]), ('y', [0.0, bad, bad]), ('z', [0.0, 0.0, bad])]
            {
                let error = Vertex::try_new(x, y, z).expect_err("it does not fit");
                let VertexError::Position { axis: found, value } = error else { panic!("{error:?}") };
                assert_eq!((found, value.to_bits()), (axis, bad.to_bits()));
                assert!(catch_unwind(|| Vertex::new(x, y, z)).is_err(), "{x}, {y}, {z}");
            }
        }
        let error = Vertex::try_new(0.0, -20.0, 0.0).unwrap_err();
        assert_eq!(error.to_string(), "y of a vertex is not a number within −8 … 7.9998: -20");
    }

    #[test]
    fn a_texture_coordinate_out_of_range_is_a_typed_error_and_panics_elsewhere() {
        for good in [-2048, -1, 0, 2047] {
            let vertex = PLAIN.uv(good, 3);
            assert_eq!(vertex.uv.map(|c| f64::from(c.to_num::<f32>())), [f64::from(good), 3.0]);
            assert_eq!(PLAIN.try_uv(good, 3), Ok(vertex));
        }
        for bad in [i16::MIN, -2049, 2048, 5120, i16::MAX] {
            let error = |axis| Err(VertexError::TextureCoordinate { axis, value: bad });
            assert_eq!(PLAIN.try_uv(bad, 0), error('u'));
            assert_eq!(PLAIN.try_uv(0, bad), error('v'));
            assert!(catch_unwind(|| PLAIN.uv(bad, 0)).is_err() && catch_unwind(|| PLAIN.uv(0, bad)).is_err());
        }
        let error = PLAIN.try_uv(5120, 0).unwrap_err();
        assert_eq!(error.to_string(), "u of a vertex is not within −2048 … 2047 texels: 5120");
    }

    #[test]
    fn a_normal_longer_than_1_is_a_typed_error_and_panics_elsewhere() {
        let good: [([f32; 3], [i8; 3]); 7] = [
            ([0.0, 0.0, 1.0], [0, 0, 127]),
            ([-1.0, 0.0, 0.0], [-127, 0, 0]),
            ([0.6, 0.0, -0.8], [76, 0, -102]),  // 76.2, −101.6
            ([0.58, 0.58, 0.58], [74, 74, 74]), // of length 1.0046, from two digits
            ([0.577, 0.577, -0.577], [73, 73, -73]),
            ([0.0, 1.0156, 0.0], [0, 127, 0]),
            ([0.0, 0.25, 0.0], [0, 32, 0]), // 31.75
        ];
        for ([x, y, z], bits) in good {
            assert_eq!(PLAIN.normal(x, y, z).normal, bits);
            assert_eq!(PLAIN.try_normal(x, y, z), Ok(PLAIN.normal(x, y, z)));
        }
        for [x, y, z] in [
            [f32::NAN, 0.0, 0.0],
            [0.0, f32::INFINITY, 0.0],
            [0.0, 0.0, f32::NEG_INFINITY],
            [f32::MAX, f32::MAX, f32::MAX],
            [1.0, 1.0, 1.0],
            [0.0, -1.016, 0.0],
            [0.0, 5.0, 0.0],
        ] {
            let error = PLAIN.try_normal(x, y, z).expect_err("it is too long");
            let VertexError::Normal { normal } = error else { panic!("{error:?}") };
            assert_eq!(normal.map(f32::to_bits), [x, y, z].map(f32::to_bits));
            assert!(catch_unwind(|| PLAIN.normal(x, y, z)).is_err());
        }
        let error = PLAIN.try_normal(1.0, 1.0, 1.0).unwrap_err();
        assert_eq!(error.to_string(), "the normal of a vertex is longer than 1, or no number: (1, 1, 1)");
    }
}
