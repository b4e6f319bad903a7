//! The promise: depth is 16-bit near/w, 1 … 65535, 0 is cleared; larger is nearer, strictly nearer wins, ties keep
//! what was drawn first. And the same bytes for every band height.

use crate::{common, reference};

use std::cell::Cell;

use common::generate::{strip, triangle};
use common::{Canvas, Counting, Drawn, Record, Recorder, Recording, Strip, cases, for_all};
use fixel::{
    Affine, Cull, Depth16, DepthFormat, Exact, Inputs, NoDepth, QuarterPixel, Shader, Surface, Varying,
};
use proptest::prelude::*;
use reference::{ATTRIBUTES, Triangle};

/// Writes which triangle it is.
#[derive(Clone, Copy, Debug)]
struct Numbered(i32);

impl Shader<Recording> for Numbered {
    type Quality = QuarterPixel;

    fn inputs(&self) -> Inputs {
        Inputs::None
    }

    fn color(&self, _: &Varying) -> Drawn {
        let mut attributes = [0; ATTRIBUTES];
        attributes[0] = self.0;
        Drawn { attributes, written: true }
    }
}

/// Draws the triangles in order, each with its number.
fn draw<D>(strip: Strip, triangles: &[Triangle]) -> Canvas<Drawn, D::Word>
where
    D: DepthFormat,
{
    let mut canvas = Canvas::new::<D>(strip);
    for (number, triangle) in (0..).zip(triangles) {
        canvas
            .draw::<Recording, D, _>(triangle, Cull::None, Surface::new(&Numbered(number)))
            .expect("the triangle is within range");
    }
    canvas
}

fn visible(drawn: Drawn) -> Option<i32> {
    drawn.written.then_some(drawn.attributes[0])
}

/// A few triangles, some of them twice.
fn triangles(strip: Strip) -> impl Strategy<Value = Vec<Triangle>> {
    let twice = prop::collection::vec((any::<prop::sample::Index>(), any::<prop::sample::Index>()), 0..3);
    (prop::collection::vec(triangle(strip), 1..=8), twice).prop_map(|(mut triangles, twice)| {
        for (which, to) in twice {
            let copy = *which.get(&triangles);
            triangles.insert(to.index(triangles.len() + 1), copy);
        }
        triangles
    })
}

fn scene() -> impl Strategy<Value = (Strip, Vec<Triangle>)> {
    strip().prop_flat_map(|strip| (Just(strip), triangles(strip)))
}

#[test]
fn in_6_000_scenes_strictly_nearer_wins_and_ties_keep_the_first() {
    let (contested, ties) = (Cell::new(0_u64), Cell::new(0_u64));
    for_all("depth order", 6_000, scene(), |(strip, triangles)| {
        let together = draw::<Depth16>(strip, &triangles);
        // What each triangle stores on its own, from the q that it brings to the depth test.
        let alone: Vec<_> = triangles.iter().map(|triangle| draw::<Counting>(strip, &[*triangle])).collect();
        for (index, (x, y)) in strip.pixels().enumerate() {
            let mut nearest = (0, None);
            let mut exact: Vec<(i128, i32)> = Vec::new();
            for (number, (triangle, alone)) in (0..).zip(triangles.iter().zip(&alone)) {
                let met = alone.depth[index];
                prop_assert_eq!(met.times, u32::from(triangle.covers(x, y)));
                if met.times == 0 {
                    continue;
                }
                exact.push((triangle.at(x, y).depth_word(), number));
                let word = (met.q >> 15).max(1);
                ties.set(ties.get() + u64::from(word == nearest.0));
                if word > nearest.0 {
                    nearest = (word, Some(number));
                }
            }
            let (word, drawn) = (u32::from(together.depth[index]), visible(together.pixels[index]));
            prop_assert_eq!((word, drawn), nearest, "depth and number at {}, {}", x, y);
            // And whoever is ahead by more than two steps of rounding, by the exact depths, is seen.
            exact.sort_unstable();
            if let [.., (behind, _), (ahead, number)] = exact[..] {
                contested.set(contested.get() + 1);
                prop_assert!(
                    ahead <= behind + 2 || drawn == Some(number),
                    "exact depths {:?} at {}, {}",
                    exact,
                    x,
                    y
                );
            }
        }
        Ok(())
    });
    println!("{} contested pixels, {} ties", contested.get(), ties.get());
    assert!(contested.get() > 10 * u64::from(cases(6_000)) && ties.get() > u64::from(cases(6_000)));
}

#[test]
fn in_2_000_scenes_without_depth_the_last_triangle_stays() {
    for_all("no depth", 2_000, scene(), |(strip, triangles)| {
        let canvas = draw::<NoDepth>(strip, &triangles);
        for ((x, y), drawn) in strip.pixels().zip(&canvas.pixels) {
            let last = (0..).zip(&triangles).filter(|(_, triangle)| triangle.covers(x, y)).last();
            prop_assert_eq!(visible(*drawn), last.map(|(number, _)| number), "at {}, {}", x, y);
        }
        Ok(())
    });
}

#[test]
fn the_farthest_depth_is_nearer_than_cleared_and_the_nearest_is_the_largest() {
    let wall = |q| {
        Triangle([(-16, -16), (-16, 1600), (1600, -16)].map(|(x, y)| reference::Corner {
            x,
            y,
            q,
            attributes: [0; ATTRIBUTES],
        }))
    };
    let strip = Strip::new(4, 4, 0);
    let stored = |q| draw::<Depth16>(strip, &[wall(q)]).depth;
    assert_eq!(Depth16::CLEAR, 0);
    assert_eq!(stored(1), [1; 16]);
    assert_eq!(stored(1 << 15), [1; 16]);
    assert!(stored((1 << 31) - 1).iter().all(|word| *word >= 65534));
    // The same wall twice, and one nearer by two steps.
    let canvas = draw::<Depth16>(strip, &[wall(5 << 20), wall(5 << 20), wall((5 << 20) + (2 << 15))]);
    assert!(canvas.pixels.iter().all(|drawn| visible(*drawn) == Some(2)));
    let canvas = draw::<Depth16>(strip, &[wall((5 << 20) + (2 << 15)), wall(5 << 20), wall(5 << 20)]);
    assert!(canvas.pixels.iter().all(|drawn| visible(*drawn) == Some(0)));
}

/// Draws the triangles in bands of so many rows and puts the bands' words together again.
fn in_bands(strip: Strip, triangles: &[Triangle], rows: u32, quality: u8) -> (Canvas<Drawn, u16>, Record) {
    let mut whole = (Canvas::new::<Depth16>(strip), Record::blank(strip));
    let mut done = 0;
    while done < strip.height {
        let band = Strip::new(strip.width, rows.min(strip.height - done), strip.row + done);
        let mut depth16 = Canvas::new::<Depth16>(band);
        let mut counted = Record::blank(band);
        for triangle in triangles {
            let all = Inputs::UvColor;
            match quality {
                0 => {
                    let shader = Recorder::<QuarterPixel>::new(all);
                    depth16.draw::<Recording, Depth16, _>(triangle, Cull::None, Surface::new(&shader))
                }
                1 => depth16.draw::<Recording, Depth16, _>(
                    triangle,
                    Cull::None,
                    Surface::new(&Recorder::<Exact>::new(all)),
                ),
                _ => depth16.draw::<Recording, Depth16, _>(
                    triangle,
                    Cull::None,
                    Surface::new(&Recorder::<Affine>::new(all)),
                ),
            }
            .expect("the triangle is within range");
            match quality {
                0 => counted.record::<QuarterPixel>(triangle, Cull::None, Inputs::Uv),
                1 => counted.record::<Exact>(triangle, Cull::None, Inputs::Color),
                _ => counted.record::<Affine>(triangle, Cull::None, Inputs::Color),
            }
        }
        let words = (strip.width * done) as usize..(strip.width * done) as usize + band.len();
        whole.0.pixels[words.clone()].copy_from_slice(&depth16.pixels);
        whole.0.depth[words.clone()].copy_from_slice(&depth16.depth);
        whole.1.pixels[words.clone()].copy_from_slice(&counted.pixels);
        whole.1.depth[words].copy_from_slice(&counted.depth);
        done += band.height;
    }
    whole
}

#[test]
fn in_3_000_scenes_bands_of_1_2_7_and_16_rows_give_the_words_of_the_whole() {
    let scenes = (scene(), 0..3_u8);
    for_all("band heights", 3_000, scenes, |((strip, triangles), quality)| {
        let whole = in_bands(strip, &triangles, strip.height, quality);
        for rows in [1, 2, 7, 16] {
            prop_assert!(in_bands(strip, &triangles, rows, quality) == whole, "in bands of {} rows", rows);
        }
        Ok(())
    });
}

/// A triangle of a mesh, all of it on a strip of at most 64 pixels, one in two less than two pixels thick. Its depth is all but the
/// nearest, or the farthest, where rounding could take it out of its range; or changes by any amount, across a thin one too.
fn small_triangle() -> impl Strategy<Value = (Strip, Triangle)> {
    let places = (1..=64_u32, 1..=64_u32).prop_flat_map(|(width, height)| {
        let place = move || (0..=16 * width as i32, 0..=16 * height as i32);
        let thin = (place(), place(), 0..=16_i32, -30..=30_i32, -30..=30_i32).prop_map(
            move |(a, b, along, dx, dy)| {
                let between = |a: i32, b: i32| a + (b - a) * along / 16;
                let x = (between(a.0, b.0) + dx).clamp(0, 16 * width as i32);
                [a, b, (x, (between(a.1, b.1) + dy).clamp(0, 16 * height as i32))]
            },
        );
        (Just(Strip::new(width, height, 0)), prop_oneof![[place(), place(), place()], thin])
    });
    let off =
        |most: u32| (0..=most, any::<u32>()).prop_map(|(size, bits)| bits & ((1_u64 << size) - 1) as u32);
    let q = prop_oneof![
        [off(12), off(12), off(12)].prop_map(|off| off.map(|off| (1 << 31) - 1 - off)),
        [off(12), off(12), off(12)].prop_map(|off| off.map(|off| (1 << 15) - 2048 + off)),
        (20..31_u32, any::<u32>(), [off(31), off(31), off(31)]).prop_map(|(size, bits, off)| {
            let most = 1 << size | bits & ((1 << size) - 1);
            off.map(|off| most.saturating_sub(off).max(1))
        }),
    ];
    (places, q).prop_map(|((strip, places), q)| {
        let corner = |i: usize| {
            let (x, y) = places[i];
            reference::Corner { x, y, q: q[i], attributes: [0; ATTRIBUTES] }
        };
        (strip, Triangle([0, 1, 2].map(corner)))
    })
}

#[test]
fn depth_is_within_a_step_and_in_range_on_10_000_small_triangles() {
    let pixels = Cell::new(0_u64);
    for_all("depth of small triangles", 10_000, small_triangle(), |(strip, triangle)| {
        let stored = draw::<Depth16>(strip, &[triangle]);
        let asked = draw::<Counting>(strip, &[triangle]);
        for ((x, y), (word, met)) in strip.pixels().zip(stored.depth.iter().zip(&asked.depth)) {
            if !triangle.covers(x, y) {
                prop_assert_eq!(*word, 0, "at {}, {}", x, y);
                continue;
            }
            let exactly = triangle.at(x, y);
            prop_assert!(
                *word >= 1 && u32::from(*word) == (met.q >> 15).max(1) && exactly.depth_error(met.q) <= 1.0,
                "at {}, {}: {} of q = {}, exactly {} of {}",
                x,
                y,
                word,
                met.q,
                exactly.depth_word(),
                exactly.q()
            );
            pixels.set(pixels.get() + 1);
        }
        Ok(())
    });
    println!("depth of small triangles: {} pixels", pixels.get());
    assert!(pixels.get() > 20 * u64::from(cases(10_000)));
}
