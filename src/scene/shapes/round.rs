//! Shapes that go round: sphere, torus, cylinder.

use super::builder::{Builder, in_strips, length, part};
use super::shape::{Counts, Shape};
use crate::num::I12F4;

/// A sphere with a pole at each end of the y axis, `segments` ≥ 3 around it and `rings` ≥ 2 from pole to pole.
///
/// The texture is wrapped around it as a map of the world is around a globe: once from left to right and from
/// pole to pole, its middle towards +z, its ends joined at −z. Both vertices along the joint are there, and a
/// pole's for each segment: (`segments` + 1)(`rings` − 1) + 2 · `segments` vertices, 2 · `segments`
/// (`rings` − 1) triangles.
#[must_use]
pub const fn uv_sphere<const V: usize, const T: usize>(
    radius: f32,
    segments: usize,
    rings: usize,
    texels: [u16; 2],
) -> Shape<V, T> {
    assert!(segments >= 3 && rings >= 2, "a sphere has at least 3 segments and 2 rings");
    let radius = length(radius);
    let mut shape = Builder::new(Counts::uv_sphere(segments, rings));

    let mut ring = 1;
    while ring < rings {
        let (sin, cos) = sin_cos(ring, 2 * rings);
        let mut segment = 0;
        while segment <= segments {
            let (s, c) = sin_cos(segment, segments);
            let normal = [-s * sin, cos, -c * sin];
            let uv = [part(texels[0], segment, segments), part(texels[1], ring, rings)];
            shape.vertex(scaled(normal, radius), normal, uv);
            segment += 1;
        }
        ring += 1;
    }
    shape.squares(0, segments, rings - 2);

    // A pole's vertices have the texture's column in the middle of their segment.
    let last_ring = (rings - 2) * (segments + 1);
    let mut segment = 0;
    while segment < segments {
        let u = part(texels[0], 2 * segment + 1, 2 * segments);
        let pole = shape.next_vertex;
        shape.vertex([0.0, radius, 0.0], [0.0, 1.0, 0.0], [u, I12F4::ZERO]);
        shape.triangle(pole, segment, segment + 1);
        shape.vertex([0.0, -radius, 0.0], [0.0, -1.0, 0.0], [u, part(texels[1], 1, 1)]);
        shape.triangle(pole + 1, last_ring + segment + 1, last_ring + segment);
        segment += 1;
    }
    shape.finish()
}

/// A torus around the z axis, without texture coordinates: `rings` ≥ 3 of `sides` ≥ 3 vertices each, the first in
/// the half plane of +x; `major` from the middle to the middle of the tube, `minor` the tube's radius, in mesh units.
///
/// `rings` · `sides` vertices, 2 · `rings` · `sides` triangles: no vertex is there twice.
#[must_use]
pub const fn torus<const V: usize, const T: usize>(
    major: f32,
    minor: f32,
    rings: usize,
    sides: usize,
) -> Shape<V, T> {
    assert!(rings >= 3 && sides >= 3, "a torus has at least 3 rings and 3 sides");
    let mut shape = Builder::new(Counts::torus(rings, sides));
    torus_vertices(&mut shape, [major, minor], [rings, sides], [rings - 1, sides - 1], [0; 2]);
    let mut i = 0;
    while i < rings * sides {
        let (side, ring) = in_strips(i, sides, rings);
        let (here, there) = (ring * sides, (ring + 1) % rings * sides);
        let next = (side + 1) % sides;
        shape.square(here + side, there + side, there + next, here + next);
        i += 1;
    }
    shape.finish()
}

/// A [`torus`] with a texture: from left to right along the large circle, from its beginning in the half plane of
/// +x; from top to bottom around the tube, both ends on the outermost circle.
///
/// Where the texture's ends meet there are two vertices: (`rings` + 1)(`sides` + 1) vertices, 2 · `rings` · `sides`
/// triangles.
#[must_use]
pub const fn torus_textured<const V: usize, const T: usize>(
    major: f32,
    minor: f32,
    rings: usize,
    sides: usize,
    texels: [u16; 2],
) -> Shape<V, T> {
    assert!(rings >= 3 && sides >= 3, "a torus has at least 3 rings and 3 sides");
    let mut shape = Builder::new(Counts::torus_textured(rings, sides));
    torus_vertices(&mut shape, [major, minor], [rings, sides], [rings, sides], texels);
    let mut i = 0;
    while i < rings * sides {
        let (side, ring) = in_strips(i, sides, rings);
        let (here, there) = (ring * (sides + 1), (ring + 1) * (sides + 1));
        shape.square(here + side, there + side, there + side + 1, here + side + 1);
        i += 1;
    }
    shape.finish()
}

/// The vertices of rings 0 … `last[0]` and sides 0 … `last[1]`.
const fn torus_vertices<const V: usize, const T: usize>(
    shape: &mut Builder<V, T>,
    [major, minor]: [f32; 2],
    [rings, sides]: [usize; 2],
    last: [usize; 2],
    texels: [u16; 2],
) {
    assert!(minor < major, "a torus has a hole: minor < major");
    let (major, minor) = (length(major), length(minor));
    let mut ring = 0;
    while ring <= last[0] {
        let (s, c) = sin_cos(ring, rings);
        let mut side = 0;
        while side <= last[1] {
            let (up, out) = sin_cos(side, sides);
            let radius = major + minor * out;
            let uv = [part(texels[0], ring, rings), part(texels[1], sides - side, sides)];
            shape.vertex([radius * c, radius * s, minor * up], [out * c, out * s, up], uv);
            side += 1;
        }
        ring += 1;
    }
}

/// A cylinder around the y axis with `sides` ≥ 3 and two flat caps; `radius` and `height` in mesh units.
///
/// The texture goes once around it, its middle towards +z, its ends joined at −z. A cap shows the largest circle in
/// the texture, of `cap` texels, with the edge towards −z (above) and +z (below) uppermost.
/// 4 · `sides` + 2 vertices, 4 · `sides` − 4 triangles.
#[must_use]
pub const fn cylinder<const V: usize, const T: usize>(
    radius: f32,
    height: f32,
    sides: usize,
    texels: [u16; 2],
    cap: [u16; 2],
) -> Shape<V, T> {
    assert!(sides >= 3, "a cylinder has at least 3 sides");
    let (radius, half) = (length(radius), length(height) / 2.0);
    let mut shape = Builder::new(Counts::cylinder(sides));

    let mut row = 0;
    while row <= 1 {
        let y = if row == 0 { half } else { -half };
        let mut side = 0;
        while side <= sides {
            let (s, c) = sin_cos(side, sides);
            let uv = [part(texels[0], side, sides), part(texels[1], row, 1)];
            shape.vertex([-s * radius, y, -c * radius], [-s, 0.0, -c], uv);
            side += 1;
        }
        row += 1;
    }
    shape.squares(0, sides, 1);

    let mut row = 0;
    while row <= 1 {
        let up = if row == 0 { 1.0 } else { -1.0 };
        let first = shape.next_vertex;
        let mut side = 0;
        while side < sides {
            let (s, c) = sin_cos(side, sides);
            let uv = [share(cap[0], 0.5 - 0.5 * s), share(cap[1], 0.5 - 0.5 * c * up)];
            shape.vertex([-s * radius, up * half, -c * radius], [0.0, up, 0.0], uv);
            if side >= 2 {
                // Counter-clockwise seen from above.
                let (b, c) = if row == 0 { (side - 1, side) } else { (side, side - 1) };
                shape.triangle(first, first + b, first + c);
            }
            side += 1;
        }
        row += 1;
    }
    shape.finish()
}

pub(super) const fn scaled(v: [f64; 3], by: f64) -> [f64; 3] {
    [v[0] * by, v[1] * by, v[2] * by]
}

/// A share, 0 … 1, of so many texels.
const fn share(texels: u16, share: f64) -> I12F4 {
    assert!(texels < 2048, "texture coordinates end at 2047");
    I12F4::from_bits((texels as f64 * 16.0 * share + 0.5) as i16)
}

/// Sine and cosine of `i`/`n` of a turn, to 2·10⁻¹⁵: exactly −1, 0 and 1 where they are that, and exactly as
/// symmetric as a circle is.
pub(super) const fn sin_cos(i: usize, n: usize) -> (f64, f64) {
    // A quarter turn is `n` units.
    let units = i % n * 4;
    let (quarter, rest) = (units / n, units % n);
    let mirrored = 2 * rest > n;
    let rest = if mirrored { n - rest } else { rest };
    let (s, c) = taylor(rest as f64 / n as f64 * core::f64::consts::FRAC_PI_2);
    let (s, c) = if mirrored { (c, s) } else { (s, c) };
    match quarter {
        0 => (s, c),
        1 => (c, -s),
        2 => (-s, -c),
        _ => (-c, s),
    }
}

/// Sine and cosine of 0 … π/4, the first terms left out being x¹⁷/17! and x¹⁶/16! < 10⁻¹⁵.
const fn taylor(x: f64) -> (f64, f64) {
    let y = x * x;
    let s = 1.0 - y / 72.0 * (1.0 - y / 110.0 * (1.0 - y / 156.0 * (1.0 - y / 210.0)));
    let s = x * (1.0 - y / 6.0 * (1.0 - y / 20.0 * (1.0 - y / 42.0 * s)));
    let c = 1.0 - y / 56.0 * (1.0 - y / 90.0 * (1.0 - y / 132.0 * (1.0 - y / 182.0)));
    let c = 1.0 - y / 2.0 * (1.0 - y / 12.0 * (1.0 - y / 30.0 * c));
    (s, c)
}
