//! Random triangles in perspective, with attributes: each family is a way in which interpolation goes wrong.

use proptest::prelude::*;

use fixel::Inputs;

use super::Strip;
use super::generate::{self, Family as Shape, GUARD_BAND, place, places};
use crate::reference::{Corner, Triangle};

/// Ways to choose a triangle that interpolation may find hard.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Family {
    Ordinary,
    Sliver,
    Tiny,
    Huge,
    /// Long rows, up to the widest target.
    Wide,
    /// Thousands of texels over a few pixels.
    Steep,
    /// A few texels over many pixels.
    Mild,
    /// Two vertices at the same distance: q does not change along one edge.
    EqualPair,
    /// u is the same at all three vertices.
    ConstantU,
    /// Far behind the near plane: q has few bits left, down to one depth step.
    Far,
    /// One vertex far away in the picture, the two others near and outside: a floor or a wall at its end.
    Horizon,
    /// Farther than a 16-bit depth buffer can tell.
    Beyond,
}

pub(crate) const FAMILIES: [Family; 12] = [
    Family::Ordinary,
    Family::Sliver,
    Family::Tiny,
    Family::Huge,
    Family::Wide,
    Family::Steep,
    Family::Mild,
    Family::EqualPair,
    Family::ConstantU,
    Family::Far,
    Family::Horizon,
    Family::Beyond,
];

/// Largest w of a triangle over its smallest.
pub(crate) const RATIOS: [u32; 5] = [1, 10, 100, 1000, 65536];

const INPUTS: [Inputs; 3] = [Inputs::UvColor, Inputs::Uv, Inputs::Color];

fn strips(family: Family) -> BoxedStrategy<Strip> {
    match family {
        Family::Wide => {
            (200..=1023_u32, 1..=3_u32).prop_map(|(width, height)| Strip::new(width, height, 0)).boxed()
        }
        Family::Huge => prop_oneof![
            (200..=1023_u32, 1..=3_u32).prop_map(|(width, height)| Strip::new(width, height, 0)),
            generate::strip(),
        ]
        .boxed(),
        _ => generate::strip(),
    }
}

fn shape(family: Family, strip: Strip) -> BoxedStrategy<[generate::Place; 3]> {
    match family {
        Family::Sliver => places(Shape::Sliver, strip),
        Family::Tiny => places(Shape::Tiny, strip),
        Family::Huge => places(Shape::Huge, strip),
        Family::Wide => [place(strip, 500), place(strip, 500), place(strip, 500)].boxed(),
        Family::Steep => prop_oneof![
            places(Shape::Tiny, strip),
            places(Shape::Ordinary, strip),
            places(Shape::Sliver, strip)
        ]
        .boxed(),
        Family::Horizon => {
            let outside = || prop_oneof![place(strip, 2000).boxed(), (GUARD_BAND, GUARD_BAND).boxed()];
            (outside(), place(strip, 20), outside()).prop_map(|(a, far, b)| [a, far, b]).boxed()
        }
        Family::Mild => prop_oneof![places(Shape::Ordinary, strip), places(Shape::Huge, strip)].boxed(),
        _ => prop_oneof![
            4 => places(Shape::Ordinary, strip),
            1 => places(Shape::Centres, strip),
            1 => places(Shape::Corners, strip),
        ]
        .boxed(),
    }
}

/// The three vertices' distances, 1 … `ratio` and both of these among them.
fn distances(family: Family, ratio: u32) -> BoxedStrategy<[f64; 3]> {
    let ratio = f64::from(ratio);
    let third = match family {
        Family::EqualPair => prop_oneof![Just(0.0), Just(1.0)].boxed(),
        _ => prop_oneof![1 => Just(0.0), 1 => Just(1.0), 6 => 0.0..=1.0_f64].boxed(),
    };
    let (turns, swap) = match family {
        Family::Horizon => (Just(0).boxed(), Just(false).boxed()),
        _ => ((0..3_usize).boxed(), any::<bool>().boxed()),
    };
    (third, turns, swap)
        .prop_map(move |(third, turns, swap)| {
            let mut distances = [1.0, ratio, ratio.powf(third)];
            if swap {
                distances.swap(0, 1);
            }
            distances.rotate_left(turns);
            distances
        })
        .boxed()
}

/// near over the smallest w.
fn nearest(family: Family, ratio: u32) -> BoxedStrategy<f64> {
    match family {
        Family::Far => Just((f64::from(ratio) / 65536.0).min(1.0)).boxed(),
        Family::Beyond => {
            (0.0..=1.0_f64).prop_map(move |depth| f64::from(ratio) / 65536.0 * 32768_f64.powf(-depth)).boxed()
        }
        // Down to where the farthest vertex is a depth step from infinity.
        _ => prop_oneof![
            1 => Just(1.0),
            1 => (0.0..=1.0_f64).prop_map(move |depth| (f64::from(ratio) / 65536.0).powf(depth).min(1.0)),
        ]
        .boxed(),
    }
}

/// Texels in units of 2⁻¹⁶.
fn texels(family: Family) -> BoxedStrategy<[i32; 3]> {
    let within = |limit: i32| [-limit..=limit, -limit..=limit, -limit..=limit];
    let whole = |limit: i32| within(limit).prop_map(|texels| texels.map(|texel| texel << 16));
    let mild =
        (-2000..=2000_i32, within(4 << 16)).prop_map(|(base, off)| off.map(|off| (base << 16) + off)).boxed();
    match family {
        Family::Steep => {
            let ends = prop_oneof![Just(-2000), Just(2000)];
            [ends.clone(), ends.clone(), ends].prop_map(|texels| texels.map(|texel| texel << 16)).boxed()
        }
        Family::Mild => mild,
        _ => prop_oneof![
            within(2000 << 16).boxed(),
            within(2000 << 4).prop_map(|texels| texels.map(|texel| texel << 12)).boxed(),
            whole(2000).boxed(),
            whole(64).boxed(),
            whole(1).boxed(),
            mild,
        ]
        .boxed(),
    }
}

/// Colours in units of 2⁻¹⁶ of 1/255.
fn colors() -> impl Strategy<Value = [i32; 3]> {
    prop_oneof![
        [0..=255_i32, 0..=255_i32, 0..=255_i32].prop_map(|color| color.map(|channel| channel << 16)),
        [0..=0xff00_i32, 0..=0xff00_i32, 0..=0xff00_i32].prop_map(|color| color.map(|channel| channel << 8)),
        prop::bool::weighted(0.5).prop_map(|on| [i32::from(on) * (255 << 16), 0, 255 << 16]),
    ]
}

/// A triangle to measure.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Case {
    pub(crate) strip: Strip,
    pub(crate) triangle: Triangle,
    pub(crate) inputs: Inputs,
    /// Which pixels are hidden, over and over.
    pub(crate) hidden: u64,
}

/// A triangle of a family, with this ratio of w.
pub(crate) fn case(family: Family, ratio: u32) -> impl Strategy<Value = Case> {
    let shapes = strips(family).prop_flat_map(move |strip| (Just(strip), shape(family, strip)));
    let planes = [texels(family), texels(family)];
    let colors = [colors(), colors(), colors()];
    let hidden = prop_oneof![2 => Just(0), 1 => any::<u64>(), 1 => (any::<u64>(), any::<u64>()).prop_map(|(a, b)| a & b)];
    let reads = (0..INPUTS.len(), hidden);
    (shapes, distances(family, ratio), nearest(family, ratio), planes, colors, reads).prop_map(
        move |((strip, places), distances, near, [u, v], colors, (inputs, hidden))| {
            let corner = |i: usize| {
                let (x, y) = places[i];
                let q =
                    (near / distances[i] * 2_f64.powi(31)).round().clamp(1.0, 2_f64.powi(31) - 1.0) as u32;
                let u = if family == Family::ConstantU { u[0] } else { u[i] };
                let [r, g, b] = [0, 1, 2].map(|channel| colors[i][channel]);
                Corner { x, y, q, attributes: [u, v[i], r, g, b] }
            };
            Case { strip, triangle: Triangle([0, 1, 2].map(corner)), inputs: INPUTS[inputs], hidden }
        },
    )
}

/// Whatever `draw_triangle` takes: ±8192 texels, and any distances up to a ratio of w.
pub(crate) fn any_case(log2_ratio: u32) -> impl Strategy<Value = Case> {
    let shape = generate::strip().prop_flat_map(|strip| {
        let places = prop_oneof![
            places(Shape::Ordinary, strip),
            places(Shape::Sliver, strip),
            places(Shape::Tiny, strip),
            places(Shape::Huge, strip),
            places(Shape::Centres, strip),
        ];
        (Just(strip), places)
    });
    let q = (0..31_u32).prop_flat_map(move |top| {
        let q = move || {
            (0..1_u32 << top, 0..=log2_ratio.min(top))
                .prop_map(move |(bits, shift)| (1 << top | bits) >> shift)
        };
        [q(), q(), q()]
    });
    let texel =
        || prop_oneof![4 => -(8192 << 16)..=8192 << 16, 1 => Just(8192 << 16), 1 => Just(-(8192 << 16))];
    let texels = [[texel(), texel()], [texel(), texel()], [texel(), texel()]];
    (shape, q, texels, [colors(), colors(), colors()], any::<u64>(), any::<bool>()).prop_map(
        |((strip, places), q, texels, colors, hidden, hides)| {
            let corner = |i: usize| {
                let ([u, v], [r, g, b]) = (texels[i], colors[i]);
                Corner { x: places[i].0, y: places[i].1, q: q[i], attributes: [u, v, r, g, b] }
            };
            let hidden = if hides { hidden } else { 0 };
            Case { strip, triangle: Triangle([0, 1, 2].map(corner)), inputs: Inputs::UvColor, hidden }
        },
    )
}

/// A mesh's triangle: all of it on a strip of at most 40 pixels, and distances that differ by less than a third.
pub(crate) fn mesh_case() -> impl Strategy<Value = Case> {
    let strips = (4..=40_u32, 4..=40_u32, 0..=900_u32).prop_map(|(w, h, row)| Strip::new(w, h, row));
    let shapes = strips.prop_flat_map(|strip| {
        let place = || {
            let (width, height, top) = (strip.width as i32, strip.height as i32, 16 * strip.row as i32);
            (0..=16 * width, top..=top + 16 * height)
        };
        (Just(strip), [place(), place(), place()])
    });
    let distances = prop_oneof![3 => 1.0..1.3_f64, 1 => 1.0..1.03_f64];
    let distances = (distances, 0.0..=1.0_f64, 0..3_usize).prop_map(|(farthest, third, turns)| {
        let mut distances = [1.0, farthest, farthest.powf(third)];
        distances.rotate_left(turns);
        distances
    });
    let texels = || {
        let within = |limit: i32| [-limit..=limit, -limit..=limit, -limit..=limit];
        prop_oneof![within(32 << 16), within(2000 << 16), within(2 << 16)]
    };
    let reads = (0..INPUTS.len(), prop_oneof![Just(0), any::<u64>()]);
    let attributes = ([texels(), texels()], [colors(), colors(), colors()]);
    (shapes, distances, 0.0..=14.0_f64, attributes, reads).prop_map(
        |((strip, places), distances, near, ([u, v], colors), (inputs, hidden))| {
            let corner = |i: usize| {
                let q = ((-near).exp2() / distances[i] * 2_f64.powi(31)).min(2_f64.powi(31) - 1.0) as u32;
                let [r, g, b] = [0, 1, 2].map(|channel| colors[i][channel]);
                Corner { x: places[i].0, y: places[i].1, q, attributes: [u[i], v[i], r, g, b] }
            };
            Case { strip, triangle: Triangle([0, 1, 2].map(corner)), inputs: INPUTS[inputs], hidden }
        },
    )
}
