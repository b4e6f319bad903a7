//! What the pipeline does at every pixel, so that any independent rasterizer can be held against it.
//!
//! `cargo run --release --example probe -- CASE OUT [exact|default|affine]`
//!
//! CASE is one of two, all little-endian: triangles on the screen (`TRI1`), or a mesh before a camera (`MSH1`).
//!
//! # TRI1
//!
//! The bytes `TRI1`; u32 width and height (1 … 1023); u32 depth rule (0 none: the last
//! triangle stays, 1 strictly nearer wins); u32 cull (0 none, 1 clockwise, 2 counter-clockwise, as seen on the screen
//! with y down); u32 triangle count (at most 65535). Then three vertices a triangle, 32 bytes each:
//!
//! | type | field | range |
//! |---|---|---|
//! | i32 | x, y in 1/16 pixel, y down, pixel centres at +8/16 | −16376 … 16376, the guard band |
//! | f32 | w | finite, above 0; the largest of the file at most 65536 times the smallest |
//! | f32 | u, v in texels | multiples of 1/16 within ±2000 |
//! | f32 | r, g, b | carried for other readers, ignored here |
//!
//! # MSH1
//!
//! The bytes `MSH1`; u32 width and height (1 … 1023), u32 cull (as above), u32 vertex count (at most 65536), u32 triangle
//! count (at most 65535); f32 focal length in pixels (1/16 … 8191), f32 distance of the near plane (above 0); twelve f32,
//! the rows of a 3 × 4 matrix from mesh to eye space, right-handed with +x right, +y up and −z forward: a rotation times
//! one scale, and a translation. Then f32 x, y, z, u, v for each vertex and three u32 for each triangle. u and v
//! are texels within ±2047. The line of sight meets the screen in its middle; there is no far plane; what is strictly nearer
//! is seen, as the file has no depth rule.
//!
//! The triangles go through `Camera::draw`, one at a time as parts of one mesh, with all that implies: the transform,
//! the clipping at the near plane and at the guard band, culling, snapping to 1/16 pixel. The file's numbers first
//! become the crate's, and how is printed:
//!
//! - positions are rounded to multiples of 2ⁿ/4096 of a mesh unit, with the least 2ⁿ that lets the mesh fit ±8 · 2ⁿ.
//!   Vertices that are such multiples already are drawn where they are;
//! - the matrix may miss a rotation times a scale by 0.0001 of that scale in any element of its product with its
//!   transpose, and is rounded to 2⁻¹⁴ for each element of the rotation;
//! - lengths of eye space (the scale, the translation, near) are multiplied by the largest power of two that leaves them
//!   within the crate's range, which the picture does not show, then rounded: the scale to 2⁻²², the others to 2⁻¹⁶; a near
//!   plane nearer than 2⁻⁸ then, the crate's limit, is drawn there, which the message says;
//! - the focal length is rounded to 2⁻¹⁶, u and v to 1/16.
//!
//! # Output
//!
//! OUT: 16 bytes a pixel, rows from the top, little-endian: u16 how many triangles cover it, whatever their depth;
//! u16 the index of the visible one; f32 u, v, 1/w of that one. A pixel that none covers is 0, 65535, 0, 0, 0.
//!
//! The triangles of `TRI1` go through `draw_triangle` and the span loops that materials use, with q = near/w rounded to 31
//! bits, where near is the smallest w of the file. (Of a q of 2⁻¹⁶, the farthest allowed, that leaves 15 bits: the
//! rounding alone moves the texture of such a triangle by up to 0.03 pixel if it fills the guard band.)
//!
//! Only the fetch is replaced: it returns the coordinate on a texture of 256 × 256 texels, 8 bits of texel and 8 of
//! fraction each for u and v. So whole turns of 256 are lost, and put back as those that bring it nearest to the
//! perspective-correct value, computed from the file (of a mesh: from the numbers it was rounded to) in `f64`. For `affine` too: an error of more than 128 texels
//! shows only modulo 256.
//!
//! The fraction is rounded to nearest. A fetch truncates, but to whole texels; truncated to 1/256, every coordinate
//! would read 1/512 texel too low on average. Rounded, it is off by at most 1/512 (0.002) texel and by 0 on average,
//! and still within the range of the vertices, whose coordinates are multiples of 1/256.
//!
//! 1/w is q/near from the depth test's own q, as an f32 (infinite where near is below 2⁻¹²⁸), in units of the file.
//!
//! Exit codes: 0, written; 1, OUT could not be written; 2, wrong arguments or a CASE that cannot be read, is malformed
//! or out of range.
#![expect(clippy::float_arithmetic, reason = "the file has floats, and the whole turns are found in f64")]

#[path = "support/probe_mesh.rs"]
mod mesh;

use std::env;
use std::ffi::OsString;
use std::fs::{self, File};
use std::io::{self, Read, Write};
use std::marker::PhantomData;
use std::path::Path;
use std::process::ExitCode;

use embedded_graphics::pixelcolor::BinaryColor;
use embedded_graphics::prelude::Size;
use fixel::fixed::types::{I12F4, I16F16, U1F31, U8F8};
use fixel::{
    Affine, Band, Cull, DepthFormat, Exact, Inputs, PixelFormat, Quality, QuarterPixel, ScreenVertex, Shader,
    Surface, Varying, draw_triangle,
};

const USAGE: &str = "usage: probe CASE OUT [exact|default|affine]";

fn main() -> ExitCode {
    let args: Vec<OsString> = env::args_os().skip(1).collect();
    let (code, message) = match run(&args) {
        Ok(message) => {
            // The file is written: whether anybody reads this does not matter.
            let _ = writeln!(io::stdout(), "{message}");
            return ExitCode::SUCCESS;
        }
        Err(Failure::Case(message)) => (2, message),
        Err(Failure::Output(message)) => (1, message),
    };
    let _ = writeln!(io::stderr(), "probe: {message}");
    ExitCode::from(code)
}

enum Failure {
    /// Wrong arguments or a bad case.
    Case(String),
    Output(String),
}

fn run(args: &[OsString]) -> Result<String, Failure> {
    let (case, out, quality) = match args {
        [case, out] => (Path::new(case), Path::new(out), "default"),
        [case, out, quality] => (Path::new(case), Path::new(out), quality.to_str().unwrap_or_default()),
        _ => return Err(Failure::Case(USAGE.into())),
    };
    if !["exact", "default", "affine"].contains(&quality) {
        return Err(Failure::Case(format!("no such quality; {USAGE}")));
    }
    let in_case = |error: String| Failure::Case(format!("{}: {error}", case.display()));
    let bytes = read(case).map_err(in_case)?;
    let picture = if bytes.starts_with(mesh::MAGIC) {
        mesh::Case::parse(&bytes).and_then(|case| case.picture(quality))
    } else {
        Case::parse(&bytes).and_then(|case| case.picture(quality))
    };
    let Picture { size, report, drawn } = picture.map_err(in_case)?;
    fs::write(out, &report).map_err(|error| Failure::Output(format!("{}: {error}", out.display())))?;
    let covered = report.chunks_exact(PIXEL).filter(|pixel| pixel[..2] != [0; 2]).count();
    Ok(format!(
        "{}: {} x {} pixels, {covered} of them covered by {drawn}",
        out.display(),
        size.width,
        size.height
    ))
}

/// A case, drawn.
struct Picture {
    size: Size,
    /// The bytes of the output.
    report: Vec<u8>,
    /// What was drawn, in words.
    drawn: String,
}

// --- The case ---

const HEADER: usize = 24;
const TRIANGLE: usize = 3 * 32;

/// Bytes of a pixel of the output.
const PIXEL: usize = 16;

/// The index of the triangle at a pixel that none covers.
const NONE: u16 = u16::MAX;
const MOST_TRIANGLES: u32 = NONE as u32;

/// The guard band, in 1/16 pixel.
const GUARD_BAND: std::ops::RangeInclusive<i32> = -(1023 * 16 + 8)..=1023 * 16 + 8;

struct Case {
    size: Size,
    nearer_wins: bool,
    cull: Cull,
    /// The smallest w.
    near: f32,
    triangles: Vec<[Vertex; 3]>,
}

#[derive(Clone, Copy)]
struct Vertex {
    x: i32,
    y: i32,
    w: f32,
    u: f32,
    v: f32,
}

/// The bytes of a file; of one too long to be a case, as many as show it.
fn read(path: &Path) -> Result<Vec<u8>, String> {
    let longest = (HEADER + MOST_TRIANGLES as usize * TRIANGLE).max(mesh::LONGEST);
    let mut bytes = Vec::new();
    File::open(path)
        .and_then(|file| file.take(longest as u64 + 1).read_to_end(&mut bytes))
        .map_err(|error| error.to_string())?;
    Ok(bytes)
}

impl Case {
    fn parse(bytes: &[u8]) -> Result<Self, String> {
        if !bytes.starts_with(b"TRI1") {
            return Err("it begins with neither TRI1 nor MSH1: not a case".into());
        }
        let Some((header, data)) = bytes.split_first_chunk::<HEADER>() else {
            return Err(format!("it ends within its header: {} of {HEADER} bytes", bytes.len()));
        };
        let [_, width, height, rule, cull, count] = words(header).map(u32::from_le_bytes);
        let size = size(width, height)?;
        let nearer_wins = match rule {
            0 => false,
            1 => true,
            _ => return Err(format!("its depth rule is {rule}, not 0 or 1")),
        };
        let cull = self::cull(cull)?;
        if count > MOST_TRIANGLES {
            return Err(format!("it has {count} triangles, but at most {MOST_TRIANGLES} can be told apart"));
        }
        let (found, needed) = (data.len(), count as usize * TRIANGLE);
        if found < needed {
            let (whole, triangle) = (found / TRIANGLE, count - 1);
            return Err(format!(
                "it ends within triangle {whole} of 0 to {triangle}: {found} bytes after the header, not {needed}"
            ));
        }
        if found > needed {
            return Err(format!("it goes on after its {count} triangles, beyond byte {}", HEADER + needed));
        }

        let (triangles, _) = data.as_chunks::<TRIANGLE>();
        let triangles = triangles.iter().enumerate().map(|(triangle, bytes)| {
            let (vertices, _) = bytes.as_chunks::<{ TRIANGLE / 3 }>();
            let vertex = |i: usize| {
                Vertex::parse(&vertices[i])
                    .map_err(|error| format!("triangle {triangle}, vertex {i}: {error}"))
            };
            Ok([vertex(0)?, vertex(1)?, vertex(2)?])
        });
        let triangles = triangles.collect::<Result<Vec<_>, String>>()?;
        Ok(Self { size, nearer_wins, cull, near: smallest_w(&triangles)?, triangles })
    }
}

fn size(width: u32, height: u32) -> Result<Size, String> {
    for (name, side) in [("width", width), ("height", height)] {
        if !(1..=1023).contains(&side) {
            return Err(format!("its {name} is {side}, not 1 to 1023"));
        }
    }
    Ok(Size::new(width, height))
}

fn cull(cull: u32) -> Result<Cull, String> {
    match cull {
        0 => Ok(Cull::None),
        1 => Ok(Cull::Back),
        2 => Ok(Cull::Front),
        _ => Err(format!("its cull is {cull}, not 0, 1 or 2")),
    }
}

/// The 4-byte words of some bytes.
fn words<const BYTES: usize, const WORDS: usize>(bytes: &[u8; BYTES]) -> [[u8; 4]; WORDS] {
    const { assert!(BYTES == 4 * WORDS) };
    let (words, _) = bytes.as_chunks();
    std::array::from_fn(|i| words[i])
}

impl Vertex {
    fn parse(bytes: &[u8; TRIANGLE / 3]) -> Result<Self, String> {
        // The last three are the colour.
        let [x, y, w, u, v, _, _, _] = words(bytes);
        let [x, y] = [x, y].map(i32::from_le_bytes);
        let [w, u, v] = [w, u, v].map(f32::from_le_bytes);
        for (name, at) in [("x", x), ("y", y)] {
            if !GUARD_BAND.contains(&at) {
                return Err(format!(
                    "{name} is {at}/16 pixel, outside the guard band of {} to {}",
                    GUARD_BAND.start(),
                    GUARD_BAND.end()
                ));
            }
        }
        if !(w > 0.0 && w.is_finite()) {
            return Err(format!("w is {w}, not finite and above 0"));
        }
        for (name, texels) in [("u", u), ("v", v)] {
            if !((-2000.0..=2000.0).contains(&texels) && (texels * 16.0).fract() == 0.0) {
                return Err(format!("{name} is {texels}, not a multiple of 1/16 within -2000 to 2000"));
            }
        }
        Ok(Self { x, y, w, u, v })
    }
}

/// near, if the largest w is not too far from it. Without triangles it is never used.
fn smallest_w(triangles: &[[Vertex; 3]]) -> Result<f32, String> {
    let all = || {
        let vertex = |i: usize| (i / 3, i % 3, triangles[i / 3][i % 3].w);
        (0..3 * triangles.len()).map(vertex)
    };
    let by_w = |a: &(usize, usize, f32), b: &(usize, usize, f32)| a.2.total_cmp(&b.2);
    let (Some(small), Some(large)) = (all().min_by(by_w), all().max_by(by_w)) else {
        return Ok(1.0);
    };
    if f64::from(large.2) > 65536.0 * f64::from(small.2) {
        return Err(format!(
            "triangle {}, vertex {}: w is {}, more than 65536 times the smallest w, {} at triangle {}, vertex {}",
            large.0, large.1, large.2, small.2, small.0, small.1
        ));
    }
    Ok(small.2)
}

// --- The probe ---

/// What the shader drew last into a pixel.
#[derive(Clone, Copy)]
struct Drawn {
    /// u and v with 8 fraction bits, modulo 256 texels.
    uv: [u16; 2],
    triangle: u16,
}

/// A pixel format whose word is what was drawn. No colour is.
struct Recording;

impl Recording {
    const BLANK: Drawn = Drawn { uv: [0; 2], triangle: NONE };
}

impl PixelFormat for Recording {
    type Word = Drawn;
    type Color = BinaryColor;

    fn encode(_: BinaryColor) -> Drawn {
        Self::BLANK
    }

    fn decode(_: Drawn) -> BinaryColor {
        BinaryColor::Off
    }

    fn rgb565(_: u16) -> Drawn {
        Self::BLANK
    }

    fn rgb888(_: u8, _: u8, _: u8) -> Drawn {
        Self::BLANK
    }
}

/// What the depth test met at a pixel.
#[derive(Clone, Copy)]
struct Met {
    /// How many triangles; with [`MOST_TRIANGLES`] it cannot overflow.
    count: u16,
    /// max(1, q · 2¹⁶) of the visible one, 0 for none.
    depth: u16,
    /// Its q = near/w with 31 fraction bits.
    q: u32,
}

/// A depth format that counts, and takes what is strictly nearer or everything.
struct Counting<const NEARER_WINS: bool>;

impl<const NEARER_WINS: bool> DepthFormat for Counting<NEARER_WINS> {
    type Word = Met;
    const CLEAR: Met = Met { count: 0, depth: 0, q: 0 };

    fn test(stored: &Met, near_w: U1F31) -> bool {
        !NEARER_WINS || depth(near_w) > stored.depth
    }

    fn store(stored: &mut Met, near_w: U1F31) {
        (stored.depth, stored.q) = (depth(near_w), near_w.to_bits());
    }

    fn test_and_store(stored: &mut Met, near_w: U1F31) -> bool {
        stored.count = stored.count.saturating_add(1);
        let visible = Self::test(stored, near_w);
        if visible {
            Self::store(stored, near_w);
        }
        visible
    }
}

fn depth(near_w: U1F31) -> u16 {
    ((near_w.to_bits() >> 15) as u16).max(1)
}

/// A texture whose texels are their coordinates. Spans are drawn by the trait's own method: the loops of materials.
struct Coordinates<Q> {
    triangle: u16,
    cull: Cull,
    quality: PhantomData<fn() -> Q>,
}

impl<Q: Quality> Shader<Recording> for Coordinates<Q> {
    type Quality = Q;

    fn inputs(&self) -> Inputs {
        Inputs::Uv
    }

    fn cull(&self) -> Cull {
        self.cull
    }

    fn color(&self, varying: &Varying) -> Drawn {
        // The 16 bits kept are the texel modulo 256 and 8 of the fraction, rounded to nearest.
        let uv = [varying.u, varying.v].map(|texels| ((texels.to_bits() + (1 << 7)) >> 8) as u16);
        Drawn { uv, triangle: self.triangle }
    }
}

type Pixels = Vec<(Drawn, Met)>;

/// Draws numbered triangles one after another: `draw` takes the shader that writes down the number.
fn draw_all<Q: Quality, D: DepthFormat<Word = Met>>(
    size: Size,
    cull: Cull,
    count: usize,
    draw: impl Fn(usize, &Coordinates<Q>, &mut Band<'_, Recording, D>) -> Result<(), String>,
) -> Result<Pixels, String> {
    let pixels = (size.width * size.height) as usize;
    let (mut pixels, mut depth) = (vec![Recording::BLANK; pixels], vec![D::CLEAR; pixels]);
    let mut band =
        Band::<Recording, D>::new(size, &mut pixels, &mut depth).map_err(|error| error.to_string())?;
    for index in 0..count {
        let shader = Coordinates { triangle: index as u16, cull, quality: PhantomData };
        draw(index, &shader, &mut band).map_err(|error| format!("triangle {index}: {error}"))?;
    }
    Ok(pixels.into_iter().zip(depth).collect())
}

impl Case {
    fn picture(&self, quality: &str) -> Result<Picture, String> {
        let pixels = match quality {
            "exact" => self.draw::<Exact>(),
            "affine" => self.draw::<Affine>(),
            _ => self.draw::<QuarterPixel>(),
        }?;
        let exact = |index: u16, x, y| perspective(&self.triangles[usize::from(index)], x, y);
        let report = report(self.size, &pixels, f64::from(self.near), exact);
        Ok(Picture { size: self.size, report, drawn: format!("{} triangles", self.triangles.len()) })
    }

    fn draw<Q: Quality>(&self) -> Result<Pixels, String> {
        if self.nearer_wins {
            self.draw_into::<Q, Counting<true>>()
        } else {
            self.draw_into::<Q, Counting<false>>()
        }
    }

    fn draw_into<Q: Quality, D: DepthFormat<Word = Met>>(&self) -> Result<Pixels, String> {
        draw_all::<Q, D>(self.size, self.cull, self.triangles.len(), |index, shader, band| {
            let vertices = self.triangles[index].map(|vertex| screen_vertex(vertex, self.near));
            draw_triangle(&vertices, self.cull, Surface::new(shader), band).map_err(|error| error.to_string())
        })
    }
}

/// The vertex in the crate's numbers: all of these fit them, as `Vertex::parse` saw to.
fn screen_vertex(vertex: Vertex, near: f32) -> ScreenVertex {
    let q = f64::from(near) / f64::from(vertex.w) * 2f64.powi(31);
    ScreenVertex {
        x: I12F4::from_bits(vertex.x as i16),
        y: I12F4::from_bits(vertex.y as i16),
        q: U1F31::from_bits((q.round() as u32).min((1 << 31) - 1)),
        u: I16F16::from_num(vertex.u),
        v: I16F16::from_num(vertex.v),
        color: [U8F8::ZERO; 3],
    }
}

// --- The report ---

/// The bytes of the output. `exact` says what u and v of a triangle should be at a pixel.
fn report(size: Size, pixels: &Pixels, near: f64, exact: impl Fn(u16, u32, u32) -> [f64; 2]) -> Vec<u8> {
    let mut bytes = Vec::with_capacity(PIXEL * pixels.len());
    for (i, (drawn, met)) in (0..).zip(pixels) {
        let [u, v, inverse_w] = if drawn.triangle == NONE {
            [0.0; 3]
        } else {
            let [u, v] = exact(drawn.triangle, i % size.width, i / size.width);
            let inverse_w = f64::from(met.q) / 2f64.powi(31) / near;
            [nearest_turn(drawn.uv[0], u), nearest_turn(drawn.uv[1], v), inverse_w]
        };
        bytes.extend(met.count.to_le_bytes());
        bytes.extend(drawn.triangle.to_le_bytes());
        bytes.extend([u, v, inverse_w].map(|value| (value as f32).to_le_bytes()).as_flattened());
    }
    bytes
}

/// u and v at a pixel centre: Σ λ·u/w over Σ λ/w, with λ the exact edge functions.
fn perspective(triangle: &[Vertex; 3], x: u32, y: u32) -> [f64; 2] {
    let [x, y] = [x, y].map(|pixel| i64::from(pixel) * 16 + 8);
    let weight = |i: usize| {
        let (a, b) = (&triangle[(i + 1) % 3], &triangle[(i + 2) % 3]);
        let [ax, ay, bx, by] = [a.x, a.y, b.x, b.y].map(i64::from);
        let edge_function = (bx - ax) * (y - ay) - (by - ay) * (x - ax);
        edge_function as f64 / f64::from(triangle[i].w)
    };
    let weights = [weight(0), weight(1), weight(2)];
    let sum = |value: fn(&Vertex) -> f64| -> f64 {
        triangle.iter().zip(weights).map(|(vertex, weight)| value(vertex) * weight).sum()
    };
    let total = sum(|_| 1.0);
    [sum(|vertex| vertex.u.into()) / total, sum(|vertex| vertex.v.into()) / total]
}

/// The coordinate (8 fraction bits) plus the multiple of 256 texels that brings it nearest to `exact`.
fn nearest_turn(coordinate: u16, exact: f64) -> f64 {
    let texels = f64::from(coordinate) / 256.0;
    texels + 256.0 * ((exact - texels) / 256.0).round()
}
