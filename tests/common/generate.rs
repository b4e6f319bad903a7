//! Random triangles, by family: each family is a way in which rasterizers go wrong.

use proptest::prelude::*;

use super::Strip;
use crate::reference::{ATTRIBUTES, Corner, Triangle};

/// A place on the screen in 1/16 pixel.
pub(crate) type Place = (i32, i32);

/// The guard band of ±1023½ pixels, in 1/16 pixel.
pub(crate) const GUARD_BAND: std::ops::RangeInclusive<i32> = -(1023 * 16 + 8)..=1023 * 16 + 8;

/// Ways to place three vertices.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Family {
    /// Anywhere around the strip.
    Ordinary,
    /// Two vertices apart, the third within a few 1/16 pixels of the line through them.
    Sliver,
    /// All on one line: nothing to draw.
    Flat,
    /// Around a pixel or smaller.
    Tiny,
    /// To the ends of the guard band.
    Huge,
    /// On pixel centres, where edges and vertices hit the sampled points.
    Centres,
    /// On pixel corners.
    Corners,
    /// Two or three vertices in one place, or in one row or column.
    Duplicates,
}

pub(crate) const FAMILIES: [Family; 8] = [
    Family::Ordinary,
    Family::Sliver,
    Family::Flat,
    Family::Tiny,
    Family::Huge,
    Family::Centres,
    Family::Corners,
    Family::Duplicates,
];

/// Small strips, anywhere on a screen of up to 1023 rows.
pub(crate) fn strip() -> BoxedStrategy<Strip> {
    let sizes = prop_oneof![
        6 => (1..=40_u32, 1..=40_u32),
        1 => (300..=1023_u32, 1..=2_u32),
        1 => (1..=2_u32, 300..=1023_u32),
    ];
    (sizes, prop_oneof![3 => Just(0), 1 => 0..=1023_u32])
        .prop_map(|((width, height), row)| Strip::new(width, height, row.min(1023 - height)))
        .boxed()
}

/// A place in or around the strip, up to `margin` 1/16 pixels outside.
pub(crate) fn place(strip: Strip, margin: i32) -> impl Strategy<Value = Place> {
    let (left, right) = (-margin, 16 * strip.width as i32 + margin);
    let (top, bottom) = (16 * strip.row as i32 - margin, 16 * (strip.row + strip.height) as i32 + margin);
    (within(left, right), within(top, bottom))
}

fn within(low: i32, high: i32) -> impl Strategy<Value = i32> {
    low.max(*GUARD_BAND.start())..=high.min(*GUARD_BAND.end())
}

fn clamped((x, y): Place) -> Place {
    let (low, high) = (*GUARD_BAND.start(), *GUARD_BAND.end());
    (x.clamp(low, high), y.clamp(low, high))
}

/// Three places of a family, around a strip.
pub(crate) fn places(family: Family, strip: Strip) -> BoxedStrategy<[Place; 3]> {
    let near = place(strip, 200);
    let anywhere = || (GUARD_BAND, GUARD_BAND);
    match family {
        Family::Ordinary => [place(strip, 200), place(strip, 200), near].boxed(),
        Family::Huge => {
            let far = || prop_oneof![2 => anywhere(), 1 => place_on_rim()];
            [far(), far(), far()].prop_map(|places| places.map(clamped)).boxed()
        }
        Family::Tiny => {
            let step = || (-20..=20, -20..=20);
            (place(strip, 0), step(), step())
                .prop_map(|((x, y), (ax, ay), (bx, by))| {
                    [(x, y), (x + ax, y + ay), (x + bx, y + by)].map(clamped)
                })
                .boxed()
        }
        Family::Sliver => {
            let ends = prop_oneof![
                (place(strip, 200), near).boxed(),
                (anywhere(), anywhere()).boxed(),
                (place(strip, 20), place(strip, 2000)).boxed(),
            ];
            (ends, -0.2..1.2_f64, -3..=3, -3..=3)
                .prop_map(|((a, b), along, dx, dy)| {
                    let between = |a: i32, b: i32| a + ((b - a) as f64 * along).round() as i32;
                    [a, b, (between(a.0, b.0) + dx, between(a.1, b.1) + dy)].map(clamped)
                })
                .boxed()
        }
        Family::Flat => (place(strip, 200), -300..=300, -300..=300, -9..=9, -9..=9)
            .prop_map(|((x, y), dx, dy, m, n)| {
                // Where the guard band would bend the line, fold it back towards the first vertex.
                let on_line = |k: i32| (x + dx * k, y + dy * k);
                let inside = |p: Place| clamped(p) == p;
                [on_line(0), on_line(m), on_line(n)].map(|p| if inside(p) { p } else { (x, y) })
            })
            .boxed(),
        Family::Centres => [place(strip, 100), place(strip, 100), near]
            .prop_map(|places| places.map(|(x, y)| ((x & !15) + 8, (y & !15) + 8)).map(on_guard_lattice))
            .boxed(),
        Family::Corners => [place(strip, 100), place(strip, 100), near]
            .prop_map(|places| places.map(|(x, y)| clamped((x & !15, y & !15))))
            .boxed(),
        Family::Duplicates => ([place(strip, 200), place(strip, 200), near], 0..6_u8)
            .prop_map(|([a, b, c], kind)| match kind {
                0 => [a, a, b],
                1 => [a, b, a],
                2 => [a, a, a],
                3 => [a, (a.0, b.1), c],
                4 => [a, (b.0, a.1), c],
                _ => [(a.0, b.1), a, (c.0, a.1)],
            })
            .boxed(),
    }
}

// Of two of the last pixel centres only the first is within the guard band.
fn on_guard_lattice((x, y): Place) -> Place {
    (x.min(1022 * 16 + 8), y.min(1022 * 16 + 8))
}

/// The guard band's corners and sides.
fn place_on_rim() -> impl Strategy<Value = Place> {
    let ends = || prop_oneof![Just(*GUARD_BAND.start()), Just(*GUARD_BAND.end())];
    prop_oneof![(ends(), ends()).boxed(), (ends(), GUARD_BAND).boxed(), (GUARD_BAND, ends()).boxed()]
}

/// The triangle with these vertices, at one distance and without attributes.
pub(crate) fn plain(places: [Place; 3]) -> Triangle {
    Triangle(places.map(|(x, y)| Corner { x, y, q: 1 << 30, attributes: [0; ATTRIBUTES] }))
}

/// A triangle of any family with any distances within a depth buffer's reach and any attributes.
pub(crate) fn triangle(strip: Strip) -> impl Strategy<Value = Triangle> {
    let shape = prop_oneof![
        6 => places(Family::Ordinary, strip),
        1 => places(Family::Sliver, strip),
        1 => places(Family::Tiny, strip),
        2 => places(Family::Huge, strip),
        1 => places(Family::Centres, strip),
        1 => places(Family::Corners, strip),
    ];
    let q = || prop_oneof![2 => 1 << 15..1_u32 << 31, 1 => (15..31_u32).prop_map(|bit| 1 << bit)];
    let q = prop_oneof![[q(), q(), q()].boxed(), q().prop_map(|q| [q; 3]).boxed()];
    let texel = || -2000 << 16..=2000 << 16;
    let channel = || (0..=255).prop_map(|channel| channel << 16);
    let attributes =
        || [texel().boxed(), texel().boxed(), channel().boxed(), channel().boxed(), channel().boxed()];
    (shape, q, [attributes(), attributes(), attributes()]).prop_map(|(places, q, attributes)| {
        Triangle([0, 1, 2].map(|i| {
            let (x, y) = places[i];
            Corner { x, y, q: q[i], attributes: attributes[i] }
        }))
    })
}
