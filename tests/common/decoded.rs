//! Textures that say where they are, and random triangles to see them on: sizes, scales, borders and gradients for which the texels
//! of a picture tell texture coordinates.

use fixel::embedded_graphics::pixelcolor::Rgb565;
use fixel::material::Kind;
use fixel::{Cull, Depth16, Material, NoDepth, Quality, Texture};
use proptest::prelude::*;

use super::generate::{Family as Shape, GUARD_BAND, Place, place, places};
use super::{Canvas, Strip};
use crate::reference::field::Field;
use crate::reference::{Corner, Triangle};

/// log₂ of width and height. Sides of 2 … 256 texels may be packed, and 1024 and 4096 texels in all have loops of their own.
pub(crate) const TEXTURES: [[u32; 2]; 12] =
    [[1, 1], [2, 3], [5, 5], [3, 7], [6, 6], [8, 4], [7, 7], [8, 8], [0, 8], [10, 6], [9, 9], [10, 10]];

/// A texture whose texels are the numbers of their places. If they are too many for a word there are two: the first says the column
/// and the second the row.
pub(crate) struct Chart {
    pub(crate) log2: [u32; 2],
    parts: Vec<Vec<u16>>,
}

impl Chart {
    pub(crate) fn new(log2: [u32; 2]) -> Self {
        let [width, height] = log2.map(|log2| 1_u32 << log2);
        let make = |word: &dyn Fn(u32, u32) -> u32| {
            (0..height).flat_map(|v| (0..width).map(move |u| word(u, v) as u16)).collect()
        };
        let parts = if log2[0] + log2[1] <= 16 {
            vec![make(&|u, v| v << log2[0] | u)]
        } else {
            vec![make(&|u, _| u), make(&|_, v| v)]
        };
        Self { log2, parts }
    }

    /// Each texture, with the axes of which it tells: which, and where its bits begin.
    pub(crate) fn textures(&self) -> impl Iterator<Item = (Texture<'_>, Vec<(usize, u32)>)> {
        let [a, b] = self.log2;
        self.parts.iter().enumerate().map(move |(part, words)| {
            let axes = if self.parts.len() == 1 { vec![(0, 0), (1, a)] } else { vec![(part, 0)] };
            (Texture::new(words, a, b), axes)
        })
    }
}

/// Ways to choose a triangle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Family {
    Ordinary,
    /// Distances change along rows alone, as on a wall.
    Rows,
    /// Distances change along columns alone, as on a floor.
    Columns,
    /// A floor seen by a camera that is rolled by 45°.
    Rolled,
    /// At most 40 pixels wide and high, as in a mesh: these have loops of their own.
    Small,
    /// Rows of up to 1023 pixels.
    Wide,
    Sliver,
    /// Distances change a little along a row.
    Level,
    /// It leaves the target, to the ends of the guard band.
    Leaving,
    /// Whole coordinates at the corners, from 0 to at most as many as the texture has.
    Whole,
}

pub(crate) const FAMILIES: [Family; 10] = [
    Family::Ordinary,
    Family::Rows,
    Family::Columns,
    Family::Rolled,
    Family::Small,
    Family::Wide,
    Family::Sliver,
    Family::Level,
    Family::Leaving,
    Family::Whole,
];

/// Largest w of a triangle over its smallest.
pub(crate) const RATIOS: [f64; 8] = [1.0, 1.02, 1.3, 3.0, 12.0, 50.0, 200.0, 65536.0];

/// Which word of light leaves texels as they are, and how a texture is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Surface {
    Plain,
    /// In full light whose channels are the same.
    Gray,
    /// In full light whose channels differ by less than is seen.
    Colored,
}

pub(crate) const SURFACES: [Surface; 3] = [Surface::Plain, Surface::Gray, Surface::Colored];

/// A triangle to decode.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Case {
    pub(crate) strip: Strip,
    /// With texture coordinates as vertices have them, before `scale`.
    pub(crate) triangle: Triangle,
    /// The index of its ratio of w.
    pub(crate) ratio: usize,
    /// The index of its texture.
    pub(crate) texture: usize,
    pub(crate) scale: u32,
    pub(crate) beyond: Beyond,
    pub(crate) surface: Surface,
    pub(crate) depth: bool,
    /// Which pixels something nearer hides, in pieces of so many pixels.
    pub(crate) hidden: (u64, i32),
}

/// What is seen beyond a texture's borders.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Beyond {
    Repeated,
    Clamped,
    Mirrored,
}

impl Beyond {
    pub(crate) const ALL: [Self; 3] = [Self::Repeated, Self::Clamped, Self::Mirrored];

    /// Most often the first.
    pub(crate) fn any() -> impl Strategy<Value = Self> {
        prop::sample::select(&[0, 0, 0, 1, 2][..]).prop_map(|i: usize| Self::ALL[i])
    }

    /// The texel at a place in a texture without end, along an axis.
    pub(crate) fn texel(self, place: i64, side: i64) -> i64 {
        match self {
            Self::Repeated => place.rem_euclid(side),
            Self::Clamped => place.clamp(0, side - 1),
            Self::Mirrored => {
                let place = place.rem_euclid(2 * side);
                place.min(2 * side - 1 - place)
            }
        }
    }
}

impl Case {
    pub(crate) fn hides(&self, x: i32, y: i32) -> bool {
        let (pattern, piece) = self.hidden;
        self.depth && pattern >> ((x / piece + 7 * y) & 63) & 1 != 0
    }
}

fn strips(family: Family) -> BoxedStrategy<Strip> {
    let wide = (200..=1023_u32, 1..=3_u32);
    let sizes = match family {
        Family::Small => (4..=40_u32, 4..=40_u32).boxed(),
        Family::Wide => wide.boxed(),
        Family::Columns => prop_oneof![(1..=3_u32, 200..=1023_u32), (20..=90_u32, 20..=40_u32)].boxed(),
        _ => prop_oneof![2 => (20..=90_u32, 20..=40_u32), 1 => wide].boxed(),
    };
    (sizes, prop_oneof![Just(0), 0..=1023_u32])
        .prop_map(|((width, height), row)| Strip::new(width, height, row.min(1023 - height)))
        .boxed()
}

fn shape(family: Family, strip: Strip) -> BoxedStrategy<[Place; 3]> {
    let around = |margin| [place(strip, margin), place(strip, margin), place(strip, margin)];
    match family {
        Family::Small => around(0).boxed(),
        Family::Sliver => (around(100), 0.0..1.0_f64, -40..=40, -40..=40)
            .prop_map(|([a, b, _], along, dx, dy)| {
                let between = |a: i32, b: i32| a + (f64::from(b - a) * along) as i32;
                let near = |at: i32, by: i32| (at + by).clamp(*GUARD_BAND.start(), *GUARD_BAND.end());
                [a, b, (near(between(a.0, b.0), dx), near(between(a.1, b.1), dy))]
            })
            .boxed(),
        Family::Leaving => places(Shape::Huge, strip),
        Family::Whole => prop_oneof![around(0), around(300)].boxed(),
        _ => prop_oneof![around(200), around(5000)].boxed(),
    }
}

/// In which direction distances change, as an angle from that of rows.
fn direction(family: Family) -> BoxedStrategy<f64> {
    let quarter = std::f64::consts::FRAC_PI_2;
    let turns = (0..4_i32).prop_map(move |turn| f64::from(turn) * quarter);
    match family {
        Family::Rows => turns.prop_map(move |turn| 2.0 * turn).boxed(),
        Family::Columns => turns.prop_map(move |turn| 2.0 * turn + quarter).boxed(),
        Family::Rolled => turns.prop_map(move |turn| turn + quarter / 2.0).boxed(),
        Family::Level => {
            (turns, 3.0..12.0_f64).prop_map(move |(turn, off)| 2.0 * turn + quarter + (-off).exp2()).boxed()
        }
        _ => (0.0..4.0 * quarter).boxed(),
    }
}

/// near / w at the corners: linear on the screen along a direction, with the ratio between the nearest and the farthest.
fn distances(places: [Place; 3], angle: f64, ratio: f64, farther: f64) -> [u32; 3] {
    let along = places.map(|(x, y)| f64::from(x) * angle.cos() + f64::from(y) * angle.sin());
    let low = along.into_iter().fold(f64::INFINITY, f64::min);
    let high = along.into_iter().fold(f64::NEG_INFINITY, f64::max);
    // The farthest is a depth step from infinity at the most.
    let near = (65536.0 / ratio).powf(-farther) * (2_f64.powi(31) - 1.0);
    along.map(|at| {
        let share = if high - low < 0.5 { 1.0 } else { (at - low) / (high - low) };
        (near * (1.0 / ratio + (1.0 - 1.0 / ratio) * share)) as u32
    })
}

/// What makes texture coordinates along one axis.
#[derive(Clone, Copy, Debug)]
struct Texels {
    /// log₂ of how many texels change over a pixel, where it is 1 at most for all that is repeated.
    slope: f64,
    /// Where between the least and the greatest the third corner is, and in which order they come.
    third: f64,
    order: usize,
    /// Where they begin.
    base: [f64; 2],
    anywhere: bool,
    /// How many fraction bits the vertices have.
    bits: u32,
}

fn texels() -> impl Strategy<Value = Texels> {
    let bits = prop_oneof![4 => Just(16), 2 => Just(4), 1 => Just(0)];
    let third = prop_oneof![1 => Just(0.0), 1 => Just(1.0), 4 => 0.0..=1.0_f64];
    (0.0..=1.0_f64, third, 0..6_usize, [0.0..=1.0_f64, 0.0..=1.0_f64], any::<bool>(), bits).prop_map(
        |(slope, third, order, base, anywhere, bits)| Texels { slope, third, order, base, anywhere, bits },
    )
}

impl Texels {
    /// At the corners, in units of 2⁻¹⁶.
    fn corners(&self, extent: f64, side_log2: u32, scale: u32, beyond: Beyond, whole: bool) -> [i32; 3] {
        let (side, scaled) = (f64::from(1 << side_log2), f64::from(1 << scale));
        // `texture_scale` is for textures that repeat. Others are shown where the whole range fits 32768 texels: beyond that
        // coordinates begin anew.
        let repeats = beyond == Beyond::Repeated;
        let limit = if !repeats { f64::min(8192.0, 16000.0 / scaled) } else { 8192.0 };
        let slope = (self.slope * f64::from(side_log2 + 6) - 5.0).exp2();
        // One in 16 is the same all over.
        let range = if self.third == 1.0 && self.slope < 0.3 { 0.0 } else { slope * extent / scaled };
        let range = range.min(2.0 * limit);
        let low = if self.anywhere && repeats {
            -limit + (2.0 * limit - range) * self.base[0]
        } else {
            side / scaled * self.base[0] - range * self.base[1]
        };
        let (low, range, bits) = if whole {
            (0.0, (side / scaled * [1.0, self.base[0]][usize::from(self.anywhere)]).ceil(), 0)
        } else {
            (low, range, self.bits)
        };
        let mut at = [0.0, 1.0, self.third];
        at.rotate_left(self.order % 3);
        if self.order >= 3 {
            at.swap(0, 1);
        }
        let grid = f64::from(1 << bits);
        at.map(|at| {
            let coordinate = ((low + range * at) * grid).round() / grid;
            (coordinate.clamp(-limit, limit) * 65536.0) as i32
        })
    }
}

/// A triangle of a family, at one distance or not.
pub(crate) fn case(family: Family, straight: bool) -> impl Strategy<Value = Case> {
    let shapes = strips(family).prop_flat_map(move |strip| (Just(strip), shape(family, strip)));
    let ratios = if straight { 0..1 } else { 1..RATIOS.len() };
    let near = (direction(family), ratios, prop_oneof![Just(0.0), 0.0..=1.0_f64]);
    let kind = (0..TEXTURES.len(), 0..=8_u32, Beyond::any(), 0..SURFACES.len());
    let pieces = prop::sample::select(&[1, 2, 5, 12, 40, 200][..]);
    let hidden = (prop_oneof![Just(0_u64), any::<u64>()], pieces, any::<bool>());
    (shapes, near, [texels(), texels()], kind, hidden).prop_map(
        move |((strip, places), (angle, ratio, farther), uv, kind, (pattern, piece, depth))| {
            let (texture, scale, beyond, surface) = kind;
            // Others than those that repeat have loops of their own where they are not scaled.
            let scale = if beyond == Beyond::Repeated { scale } else { scale.saturating_sub(6) };
            let q = distances(places, angle, RATIOS[ratio], farther);
            let span = |of: fn(Place) -> i32| {
                let at = places.map(of);
                at[0].max(at[1]).max(at[2]) - at[0].min(at[1]).min(at[2])
            };
            let extent = f64::from(span(|(x, _)| x).max(span(|(_, y)| y)).max(16)) / 16.0;
            let whole = family == Family::Whole;
            let [u, v] =
                [0, 1].map(|axis| uv[axis].corners(extent, TEXTURES[texture][axis], scale, beyond, whole));
            let blue = if SURFACES[surface] == Surface::Colored { 0xff_8000 } else { 0xff_0000 };
            let corner = |i: usize| {
                let (x, y) = places[i];
                Corner { x, y, q: q[i], attributes: [u[i], v[i], 0xff_0000, 0xff_0000, blue] }
            };
            let triangle = Triangle([0, 1, 2].map(corner));
            let (surface, hidden) = (SURFACES[surface], (pattern, piece));
            Case { strip, triangle, ratio, texture, scale, beyond, surface, depth, hidden }
        },
    )
}

/// Colours in units of 2⁻¹⁶ of 1/255, grey or not.
pub(crate) fn colors() -> impl Strategy<Value = [[i32; 3]; 3]> {
    let channel = || prop_oneof![2 => 0..=0xffff_i32, 1 => Just(0), 1 => Just(0xff00)];
    let color = || [channel(), channel(), channel()];
    let near = (0..=0xf000_i32, [0..=0xfff_i32, 0..=0xfff_i32, 0..=0xfff_i32])
        .prop_map(|(base, more)| more.map(|more| [base + more; 3]));
    let colors = prop_oneof![
        3 => [color(), color(), color()],
        2 => color().prop_map(|gray| gray.map(|gray| [gray; 3])),
        1 => near,
    ];
    colors.prop_map(|colors| colors.map(|color| color.map(|channel| channel << 8)))
}

/// The words of a triangle. What is hidden is behind something as near as can be, and stays 0.
pub(crate) fn words<K: Kind, Q: Quality>(case: &Case, material: &Material<'_, K, Q>) -> Vec<u16> {
    let in_range = "the triangle is within range";
    if !case.depth {
        let mut canvas = Canvas::<u16, ()>::new::<NoDepth>(case.strip);
        canvas.draw::<Rgb565, NoDepth, _>(&case.triangle, Cull::None, material).expect(in_range);
        return canvas.pixels;
    }
    let mut canvas = Canvas::<u16, u16>::new::<Depth16>(case.strip);
    for ((x, y), depth) in case.strip.pixels().zip(&mut canvas.depth) {
        *depth = if case.hides(x, y) { u16::MAX } else { 0 };
    }
    canvas.draw::<Rgb565, Depth16, _>(&case.triangle, Cull::None, material).expect(in_range);
    canvas.pixels
}

/// What a pixel of a triangle is to show.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Shows {
    Nothing,
    Hidden,
    Triangle,
}

/// What is true of a case.
pub(crate) struct Truth {
    pub(crate) pixels: Vec<Shows>,
    /// By attribute, if it was asked for.
    fields: Vec<Field>,
    first: usize,
}

impl Truth {
    pub(crate) fn new(case: &Case, attributes: std::ops::Range<usize>) -> Self {
        let Case { strip, triangle, .. } = case;
        let pixels = strip.pixels().map(|(x, y)| match (triangle.covers(x, y), case.hides(x, y)) {
            (false, _) => Shows::Nothing,
            (true, true) => Shows::Hidden,
            (true, false) => Shows::Triangle,
        });
        Self {
            pixels: pixels.collect(),
            first: attributes.start,
            fields: attributes.map(|attribute| field(triangle, *strip, attribute)).collect(),
        }
    }

    pub(crate) fn field(&self, attribute: usize) -> &Field {
        &self.fields[attribute - self.first]
    }
}

fn field(triangle: &Triangle, strip: Strip, attribute: usize) -> Field {
    let row = strip.row as i32;
    Field::new(triangle, attribute, 0..strip.width as i32, row..row + strip.height as i32)
}
