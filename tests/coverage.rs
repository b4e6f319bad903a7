//! The promise: the top-left rule, exact. Of the triangles that share an edge or a vertex exactly one covers a pixel
//! centre that lies on it; no cracks, no double pixels.
//!
//! Every pixel of every strip is compared with the reference, and what triangles do together is compared with what
//! their common outline says, which no triangle takes part in.
#![allow(clippy::float_arithmetic, reason = "one kind of surface is turned and projected in f64")]

use crate::{common, reference};

use std::cell::Cell;

use common::generate::{FAMILIES, Family, GUARD_BAND, Place, place, places, plain, strip};
use common::{Record, Strip, cases, for_all, survives};
use fixel::{Affine, Cull, Exact, Inputs, QuarterPixel};
use proptest::prelude::*;
use reference::{Facing, Triangle};

/// How often each pixel is asked for and whether it is written, with the quality that `quality` names.
fn record(strip: Strip, triangles: &[Triangle], cull: Cull, quality: u8) -> Record {
    let mut record = Record::blank(strip);
    for triangle in triangles {
        match quality {
            0 => record.record::<QuarterPixel>(triangle, cull, Inputs::None),
            1 => record.record::<Exact>(triangle, cull, Inputs::UvColor),
            2 => record.record::<QuarterPixel>(triangle, cull, Inputs::Uv),
            _ => record.record::<Affine>(triangle, cull, Inputs::UvColor),
        }
    }
    record
}

/// Fails unless every pixel was asked for as often as `expected` says, and written if that is at all.
fn compare(record: &Record, mut expected: impl FnMut(i32, i32) -> u32) -> Result<(), TestCaseError> {
    let mut wrong = 0;
    let mut first = None;
    for ((x, y), drawn, met) in record.iter() {
        let times = expected(x, y);
        if met.times != times || drawn.written != (times > 0) {
            wrong += 1;
            first.get_or_insert((x, y, met.times, drawn.written, times));
        }
    }
    prop_assert!(
        wrong == 0,
        "{wrong} pixels differ; the first is (x, y, times tested, written, times by the reference) = {first:?}"
    );
    Ok(())
}

/// How often an outline goes around a pixel's centre, clockwise as seen on the screen (y down), with the centre a
/// step of (ε, ε²) aside as in the reference: the edges that a ray to the right crosses.
fn winding(outline: &[Place], x: i32, y: i32) -> i32 {
    let (px, py) = (i64::from(16 * x + 8), i64::from(16 * y + 8));
    let ends = outline.iter().zip(outline.iter().cycle().skip(1));
    ends.map(|(&from, &to)| {
        let (from, to) = ((i64::from(from.0), i64::from(from.1)), (i64::from(to.0), i64::from(to.1)));
        // The ray runs infinitely little below py: a vertex at py is above it.
        let (upper, lower, turn) = if from.1 < to.1 { (from, to, -1) } else { (to, from, 1) };
        let crosses = upper.1 <= py && py < lower.1;
        // And the edge has to be at the right of the centre, which is infinitely little right of px.
        let right = (upper.0 - px) * (lower.1 - upper.1) + (lower.0 - upper.0) * (py - upper.1) > 0;
        if crosses && right { turn } else { 0 }
    })
    .sum::<i32>()
    // Down on the right is clockwise.
    .wrapping_neg()
}

fn one_triangle(family: Family) -> impl Strategy<Value = (Strip, [Place; 3], u8)> {
    strip().prop_flat_map(move |strip| (Just(strip), places(family, strip), 0..4_u8))
}

#[test]
fn of_112_000_random_triangles_no_pixel_differs_from_the_reference() {
    let (mut triangles, mut pixels) = (0_u64, 0_u64);
    for family in FAMILIES {
        let covered = Cell::new(0_u64);
        let runs = Cell::new(0_u64);
        for_all(
            &format!("one triangle, {family:?}"),
            14_000,
            one_triangle(family),
            |(strip, places, quality)| {
                let triangle = plain(places);
                let inside: Vec<bool> = strip.pixels().map(|(x, y)| triangle.covers(x, y)).collect();
                covered.set(covered.get() + inside.iter().filter(|inside| **inside).count() as u64);
                runs.set(runs.get() + 1);
                for cull in [Cull::None, Cull::Back, Cull::Front] {
                    let drawn = survives(triangle.facing(), cull);
                    let mut inside = inside.iter();
                    compare(&record(strip, &[triangle], cull, quality), |_, _| {
                        u32::from(drawn && *inside.next().expect("one for each pixel"))
                    })?;
                }
                Ok(())
            },
        );
        assert!(covered.get() > 0 || family == Family::Flat, "{family:?} triangles covered no pixel");
        triangles += runs.get();
        pixels += covered.get();
    }
    println!("{triangles} random triangles with each cull mode, {pixels} covered pixels, 0 differences");
}

#[test]
fn of_24_triangles_on_the_largest_target_no_pixel_differs() {
    let strip = Strip::new(1023, 1023, 0);
    let far = (GUARD_BAND, GUARD_BAND);
    for_all("one triangle over 1023 × 1023 pixels", 24, [far.clone(), far.clone(), far], |places| {
        let triangle = plain(places);
        compare(&record(strip, &[triangle], Cull::None, 0), |x, y| u32::from(triangle.covers(x, y)))
    });
}

/// The triangles from a hub to the sides of an outline, all the same way round as the outline.
fn fan(hub: Place, outline: &[Place]) -> Vec<Triangle> {
    let sides = outline.iter().zip(outline.iter().cycle().skip(1));
    sides.map(|(&from, &to)| plain([hub, from, to])).collect()
}

/// The places in the order in which a clockwise turn around the hub meets them, one for each direction, or none if
/// there is a gap of half a turn or more.
fn around(hub: Place, mut rim: Vec<Place>) -> Option<Vec<Place>> {
    let from_hub = |p: Place| (i64::from(p.0 - hub.0), i64::from(p.1 - hub.1));
    let cross = |a: (i64, i64), b: (i64, i64)| a.0 * b.1 - a.1 * b.0;
    let half = |p: (i64, i64)| p.1 < 0 || p.1 == 0 && p.0 < 0;
    rim.retain(|p| *p != hub);
    rim.sort_by(|a, b| {
        let (a, b) = (from_hub(*a), from_hub(*b));
        half(a).cmp(&half(b)).then(0.cmp(&cross(a, b)))
    });
    rim.dedup_by(|a, b| {
        let (a, b) = (from_hub(*a), from_hub(*b));
        half(a) == half(b) && cross(a, b) == 0
    });
    let mut gaps = rim.iter().zip(rim.iter().cycle().skip(1));
    (rim.len() > 2 && gaps.all(|(a, b)| cross(from_hub(*a), from_hub(*b)) > 0)).then_some(rim)
}

/// A place around the strip: anywhere, on a pixel centre or on a pixel corner.
fn hub(strip: Strip) -> impl Strategy<Value = Place> {
    (place(strip, 0), 0..3).prop_map(|((x, y), kind)| match kind {
        0 => (x, y),
        1 => (((x & !15) + 8).min(1022 * 16 + 8), ((y & !15) + 8).min(1022 * 16 + 8)),
        _ => (x & !15, y & !15),
    })
}

fn rim(strip: Strip, count: std::ops::RangeInclusive<usize>) -> impl Strategy<Value = Vec<Place>> {
    let one = || prop_oneof![4 => place(strip, 300).boxed(), 2 => hub(strip).boxed(), 1 => (GUARD_BAND, GUARD_BAND).boxed()];
    prop::collection::vec(one(), count)
}

#[test]
fn in_8_000_random_fans_every_pixel_is_covered_exactly_once() {
    let inside = Cell::new(0_u64);
    let fans = strip().prop_flat_map(|strip| {
        (Just(strip), hub(strip), rim(strip, 5..=16), prop::collection::vec(any::<bool>(), 16), 0..4_u8)
    });
    let fans = fans.prop_filter_map("the rim goes around the hub", |(strip, hub, rim, flips, quality)| {
        around(hub, rim).map(|rim| (strip, hub, rim, flips, quality))
    });
    for_all("fan", 8_000, fans, |(strip, hub, rim, flips, quality)| {
        let mut triangles = fan(hub, &rim);
        // Which way round each of them is given must not matter.
        for (triangle, flip) in triangles.iter_mut().zip(flips) {
            if flip {
                triangle.0.swap(0, 1);
            }
        }
        compare(&record(strip, &triangles, Cull::None, quality), |x, y| {
            let times = triangles.iter().filter(|triangle| triangle.covers(x, y)).count() as u32;
            assert_eq!(times as i32, winding(&rim, x, y), "the reference against the outline at {x}, {y}");
            assert!(times <= 1);
            inside.set(inside.get() + u64::from(times));
            times
        })
    });
    println!("fans: {} pixels inside, each covered once", inside.get());
    assert!(inside.get() > 20 * u64::from(cases(8000)));
}

#[test]
fn in_8_000_folded_fans_front_less_back_is_how_often_the_rim_goes_round() {
    let fans = strip().prop_flat_map(|strip| (Just(strip), hub(strip), rim(strip, 3..=12)));
    for_all("folded fan", 8_000, fans, |(strip, hub, rim)| {
        let triangles = fan(hub, &rim);
        let front = record(strip, &triangles, Cull::Back, 0);
        let back = record(strip, &triangles, Cull::Front, 0);
        for (((x, y), _, front), (_, _, back)) in front.iter().zip(back.iter()) {
            prop_assert_eq!(back.times as i32 - front.times as i32, winding(&rim, x, y), "at {}, {}", x, y);
        }
        Ok(())
    });
}

#[derive(Clone, Debug)]
struct Grid {
    columns: usize,
    rows: usize,
    points: Vec<Place>,
    diagonals: Vec<bool>,
}

impl Grid {
    fn point(&self, column: usize, row: usize) -> Place {
        self.points[row * (self.columns + 1) + column]
    }

    /// Two triangles a cell, divided one way or the other.
    fn triangles(&self) -> Vec<Triangle> {
        let cells = (0..self.rows).flat_map(|row| (0..self.columns).map(move |column| (column, row)));
        cells
            .zip(&self.diagonals)
            .flat_map(|((column, row), diagonal)| {
                let [a, b] = [self.point(column, row), self.point(column + 1, row)];
                let [c, d] = [self.point(column, row + 1), self.point(column + 1, row + 1)];
                if *diagonal { [[a, b, d], [a, d, c]] } else { [[a, b, c], [c, b, d]] }
            })
            .map(plain)
            .collect()
    }

    /// Clockwise.
    fn outline(&self) -> Vec<Place> {
        let top = (0..self.columns).map(|column| self.point(column, 0));
        let right = (0..self.rows).map(|row| self.point(self.columns, row));
        let bottom = (1..=self.columns).rev().map(|column| self.point(column, self.rows));
        let left = (1..=self.rows).rev().map(|row| self.point(0, row));
        top.chain(right).chain(bottom).chain(left).collect()
    }
}

/// A lattice of cells, each vertex off by less than a quarter of a cell, so that no triangle turns over.
fn grid(strip: Strip) -> impl Strategy<Value = Grid> {
    let spacing = prop_oneof![4 => 5..=160_i32, 2 => Just(16), 1 => 160..=4000_i32];
    (1..=7_usize, 1..=7_usize, spacing, hub(strip), any::<bool>())
        .prop_flat_map(|(columns, rows, spacing, at, jitter)| {
            let count = (columns + 1) * (rows + 1);
            let off = if jitter { (spacing - 1) / 4 } else { 0 };
            let off = prop::collection::vec((-off..=off, -off..=off), count);
            let diagonals = prop::collection::vec(any::<bool>(), columns * rows);
            (off, diagonals).prop_map(move |(off, diagonals)| {
                let lattice =
                    (0..=rows as i32).flat_map(|row| (0..=columns as i32).map(move |column| (column, row)));
                let points = lattice.zip(off).map(|((column, row), (dx, dy))| {
                    let x = at.0 + (column - columns as i32 / 2) * spacing + dx;
                    let y = at.1 + (row - rows as i32 / 2) * spacing + dy;
                    (x, y)
                });
                Grid { columns, rows, points: points.collect(), diagonals }
            })
        })
        .prop_filter("within the guard band", |grid| {
            grid.points.iter().all(|(x, y)| GUARD_BAND.contains(x) && GUARD_BAND.contains(y))
        })
}

#[test]
fn in_4_000_random_grids_every_pixel_is_covered_exactly_once() {
    let inside = Cell::new(0_u64);
    let grids = strip().prop_flat_map(|strip| (Just(strip), grid(strip), 0..4_u8));
    for_all("grid", 4_000, grids, |(strip, grid, quality)| {
        let triangles = grid.triangles();
        let outline = grid.outline();
        prop_assert!(triangles.iter().all(|triangle| triangle.facing() == Facing::Back));
        compare(&record(strip, &triangles, Cull::Front, quality), |x, y| {
            let times = triangles.iter().filter(|triangle| triangle.covers(x, y)).count() as u32;
            assert_eq!(
                times as i32,
                winding(&outline, x, y),
                "the reference against the outline at {x}, {y}"
            );
            inside.set(inside.get() + u64::from(times));
            times
        })
    });
    println!("grids: {} pixels inside, each covered once", inside.get());
    assert!(inside.get() > 20 * u64::from(cases(4000)));
}

/// The faces of the convex hull of points in space, each clockwise as seen from outside along +z on the screen, or
/// none if four points lie in one plane.
fn hull(points: &[(Place, i32)]) -> Option<Vec<[usize; 3]>> {
    let volume = |[a, b, c, d]: [usize; 4]| {
        let to = |i: usize| {
            let ((x, y), z) = points[i];
            let ((ax, ay), az) = points[a];
            [x - ax, y - ay, z - az].map(i128::from)
        };
        let ([bx, by, bz], [cx, cy, cz], [dx, dy, dz]) = (to(b), to(c), to(d));
        bx * (cy * dz - cz * dy) - by * (cx * dz - cz * dx) + bz * (cx * dy - cy * dx)
    };
    let count = points.len();
    let mut faces = Vec::new();
    for (a, b, c) in (0..count).flat_map(|a| (0..a).flat_map(move |b| (0..b).map(move |c| (a, b, c)))) {
        let rest = (0..count).filter(|d| ![a, b, c].contains(d));
        let sides: Vec<i128> = rest.map(|d| volume([a, b, c, d])).collect();
        if sides.contains(&0) {
            return None;
        }
        if sides.iter().all(|side| *side > 0) {
            faces.push([a, b, c]);
        } else if sides.iter().all(|side| *side < 0) {
            faces.push([a, c, b]);
        }
    }
    Some(faces)
}

#[test]
fn on_3_000_convex_solids_front_and_back_cover_every_pixel_once() {
    let inside = Cell::new(0_u64);
    let solids = strip().prop_flat_map(|strip| {
        let point = (prop_oneof![2 => place(strip, 300).boxed(), 1 => hub(strip).boxed()], -3000..=3000);
        (Just(strip), prop::collection::vec(point, 4..=9), 0..4_u8)
    });
    let solids = solids.prop_filter_map("no four points in one plane", |(strip, points, quality)| {
        hull(&points).map(|faces| (strip, points, faces, quality))
    });
    for_all("convex solid", 3_000, solids, |(strip, points, faces, quality)| {
        // Seen straight along z, so that the projection of a convex solid is exactly convex.
        let triangles: Vec<_> = faces.iter().map(|face| plain(face.map(|index| points[index].0))).collect();
        let count = points.len();
        let all = (0..count).flat_map(|a| (0..a).flat_map(move |b| (0..b).map(move |c| [a, b, c])));
        let all: Vec<_> = all.map(|corners| plain(corners.map(|index| points[index].0))).collect();
        // A pixel is in the outline of the points if it is in some triangle of them.
        let inside_outline: Vec<u32> = strip
            .pixels()
            .map(|(x, y)| u32::from(all.iter().any(|triangle| triangle.covers(x, y))))
            .collect();
        inside.set(inside.get() + inside_outline.iter().map(|times| u64::from(*times)).sum::<u64>());
        for cull in [Cull::Back, Cull::Front] {
            let mut expected = inside_outline.iter();
            compare(&record(strip, &triangles, cull, quality), |_, _| {
                *expected.next().expect("one for each pixel")
            })?;
        }
        Ok(())
    });
    println!(
        "convex solids: {} pixels inside, each covered once by the front and once by the back",
        inside.get()
    );
    assert!(inside.get() > 20 * u64::from(cases(3000)));
}

/// The faces of a torus of m × n vertices, all the same way round.
fn torus_faces(m: usize, n: usize) -> Vec<[usize; 3]> {
    let at = move |i: usize, j: usize| (i % m) * n + j % n;
    let cells = (0..m).flat_map(|i| (0..n).map(move |j| (i, j)));
    cells
        .flat_map(|(i, j)| {
            let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
            [[a, b, c], [a, c, d]]
        })
        .collect()
}

/// A ring as seen in perspective, snapped to the lattice as a camera would.
fn ring(strip: Strip, m: usize, n: usize) -> impl Strategy<Value = Vec<Place>> {
    let turn = || 0.0..std::f64::consts::TAU;
    (place(strip, 0), 20.0..400.0_f64, 0.1..0.9_f64, turn(), turn(), 1.05..4.0_f64).prop_map(
        move |((x, y), radius, tube, tilt, roll, distance)| {
            let vertices = (0..m).flat_map(|i| (0..n).map(move |j| (i, j)));
            vertices
                .map(|(i, j)| {
                    let (long, short) = (i as f64 / m as f64, j as f64 / n as f64);
                    let (ls, lc) = (long * std::f64::consts::TAU).sin_cos();
                    let (ss, sc) = (short * std::f64::consts::TAU).sin_cos();
                    let out = 1.0 + tube * sc;
                    let (px, py, pz) = (out * lc, out * ls, tube * ss);
                    let (py, pz) = (py * tilt.cos() - pz * tilt.sin(), py * tilt.sin() + pz * tilt.cos());
                    let (px, py) = (px * roll.cos() - py * roll.sin(), px * roll.sin() + py * roll.cos());
                    let scale = radius * distance / (2.0 * distance + pz);
                    (x + (px * scale).round() as i32, y + (py * scale).round() as i32)
                })
                .map(|(x, y)| (x.clamp(-16384, 16368), y.clamp(-16384, 16368)))
                .collect()
        },
    )
}

#[test]
fn on_6_000_closed_surfaces_the_front_covers_every_pixel_as_often_as_the_back() {
    let covered = Cell::new(0_u64);
    let tetrahedra = |strip| {
        prop::collection::vec(rim(strip, 4..=4), 1..=6).prop_map(|solids| {
            let faces = [[0, 1, 2], [0, 2, 3], [0, 3, 1], [1, 3, 2]];
            let solid = |corners: Vec<Place>| faces.map(|face| face.map(|index| corners[index]));
            solids.into_iter().flat_map(solid).collect::<Vec<_>>()
        })
    };
    let tori = |strip| {
        (3..=5_usize, 3..=5_usize).prop_flat_map(move |(m, n)| {
            let places = prop_oneof![rim(strip, m * n..=m * n).boxed(), ring(strip, m, n).boxed()];
            places.prop_map(move |places| {
                torus_faces(m, n).into_iter().map(|face| face.map(|index| places[index])).collect::<Vec<_>>()
            })
        })
    };
    let surfaces = strip().prop_flat_map(move |strip| {
        (Just(strip), prop_oneof![tetrahedra(strip).boxed(), tori(strip).boxed()], 0..4_u8)
    });
    for_all("closed surface", 6_000, surfaces, |(strip, faces, quality)| {
        let triangles: Vec<_> = faces.into_iter().map(plain).collect();
        let front = record(strip, &triangles, Cull::Back, quality);
        let back = record(strip, &triangles, Cull::Front, quality);
        compare(&front, |x, y| {
            let fronts = triangles.iter().filter(|triangle| triangle.facing() == Facing::Front);
            let times = fronts.filter(|triangle| triangle.covers(x, y)).count() as u32;
            covered.set(covered.get() + u64::from(times));
            times
        })?;
        for (((x, y), _, front), (_, _, back)) in front.iter().zip(back.iter()) {
            prop_assert_eq!(front.times, back.times, "front and back at {}, {}", x, y);
        }
        Ok(())
    });
    println!("closed surfaces: {} pixels covered by fronts", covered.get());
    assert!(covered.get() > 20 * u64::from(cases(6000)));
}
