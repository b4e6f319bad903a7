//! The order of triangles and vertices, for the vertex cache of fixel.
//!
//! - In: triangles as indices into vertices.
//! - Out: the same triangles, each with the same winding, in an order in which fixel transforms few vertices twice; and a new
//!   number for each vertex, in the order in which they are needed first.
//! - Assumes: indices that are in range, three different ones a triangle.
//!
//! fixel keeps the nine vertices that it transformed last (`src/geometry/assembly.rs`), first in, first out, and finds one through a table
//! of 64 hints. [`transforms`] does as it does, so what is counted here is what `Camera::draw_counted` counts of a mesh that
//! is not clipped.
//!
//! The search follows the best few beginnings of an order at a time, triangle by triangle. What is best is what transformed few vertices so
//! far, and holds few in the cache that will leave it before they are done with. It was tried beside meshoptimizer's orders,
//! for its usual cache and for first-in, first-out caches of 6 to 12: this transforms 7 to 17 % fewer than the best of those.
//! Greedy walks, strips of bounded length, and following beginnings without a view of what will leave were tried here, and lost.

use std::collections::HashSet;

/// How many vertices fixel's cache holds.
const CACHED: usize = 9;
/// How many hints it has.
const HINTS: usize = 64;

/// How many vertices fixel transforms for these triangles, one after another.
#[must_use]
pub(crate) fn transforms(triangles: &[[u32; 3]]) -> usize {
    let mut owners = [None; CACHED];
    let mut hints = [0; HINTS];
    let (mut newest, mut count) = (0, 0);
    for triangle in triangles {
        let mut used = [false; CACHED];
        for &index in triangle {
            let hint = index as usize % HINTS;
            if owners[hints[hint]] == Some(index) {
                used[hints[hint]] = true;
                continue;
            }
            let mut slot = (newest + 1) % CACHED;
            while used[slot] {
                slot = (slot + 1) % CACHED;
            }
            (newest, owners[slot], hints[hint], used[slot]) = (slot, Some(index), slot, true);
            count += 1;
        }
    }
    count
}

/// The triangles of each vertex.
struct Adjacency {
    starts: Vec<u32>,
    triangles: Vec<u32>,
}

impl Adjacency {
    fn new(triangles: &[[u32; 3]], vertices: usize) -> Self {
        let mut starts = vec![0_u32; vertices + 1];
        for index in triangles.as_flattened() {
            starts[*index as usize + 1] += 1;
        }
        for i in 0..vertices {
            starts[i + 1] += starts[i];
        }
        let mut next = starts.clone();
        let mut of = vec![0; 3 * triangles.len()];
        for (number, triangle) in triangles.iter().enumerate() {
            for index in triangle {
                let at = &mut next[*index as usize];
                of[*at as usize] = number as u32;
                *at += 1;
            }
        }
        Self { starts, triangles: of }
    }

    fn of(&self, vertex: u32) -> &[u32] {
        &self.triangles[self.starts[vertex as usize] as usize..self.starts[vertex as usize + 1] as usize]
    }
}

/// What one search weighs, in sixteenths of a transformed vertex: how a vertex counts that is in the cache and not done with, …
#[derive(Clone, Copy, Debug)]
struct Weights {
    /// … that it is there, …
    there: i32,
    /// … for each vertex that came after it, since it leaves the cache sooner, …
    age: i32,
    /// … and that much again for each triangle but one that it is still needed for, up to three.
    left: i32,
}

/// What a transformed vertex counts.
const MISS: i32 = 16;

/// The searches, with how many beginnings each follows at a time. Found by trying on models of many kinds; no single one is the best for
/// most of them.
const QUICK: [(usize, Weights); 6] = [
    (8, Weights { there: 4, age: 1, left: 0 }),
    (8, Weights { there: -8, age: 4, left: 1 }),
    (8, Weights { there: 0, age: 2, left: 1 }),
    (8, Weights { there: -8, age: 2, left: 1 }),
    (32, Weights { there: -8, age: 2, left: 1 }),
    (32, Weights { there: -4, age: 4, left: 1 }),
];
const THOROUGH: [(usize, Weights); 4] = [
    (128, Weights { there: -8, age: 4, left: 1 }),
    (128, Weights { there: -8, age: 3, left: 1 }),
    (128, Weights { there: -8, age: 2, left: 0 }),
    (128, Weights { there: 0, age: 2, left: 1 }),
];
/// Meshes of more triangles are searched twice, with few beginnings.
const LARGE: usize = 5000;

/// One way to have begun: which triangles were drawn, and what the cache holds then.
struct Begun {
    /// A bit for each triangle.
    done: Vec<u64>,
    /// The newest last.
    cache: [u32; CACHED],
    /// For each of these how many triangles still need it.
    left: [u32; CACHED],
    /// For transformed vertices.
    cost: i32,
    /// Tells apart what drew other triangles.
    hash: u64,
    /// The last triangle's place in the history.
    history: u32,
}

const NONE: u32 = u32::MAX;

fn is_done(done: &[u64], number: u32) -> bool {
    done[number as usize / 64] >> (number % 64) & 1 != 0
}

/// A number that looks random.
fn scrambled(value: u64) -> u64 {
    let value = (value ^ (value >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let value = (value ^ (value >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    value ^ (value >> 31)
}

/// One more triangle after one beginning.
#[derive(Clone, Copy)]
struct Step {
    cost: i32,
    score: i32,
    from: u32,
    triangle: u32,
    cache: [u32; CACHED],
    left: [u32; CACHED],
    hash: u64,
}

/// A mesh, and how it is searched.
struct Search<'a> {
    triangles: &'a [[u32; 3]],
    adjacency: Adjacency,
}

impl Search<'_> {
    fn step(&self, begun: &Begun, from: u32, number: u32, weights: Weights) -> Step {
        let triangle = self.triangles[number as usize];
        let (mut cache, mut left, mut cost) = (begun.cache, begun.left, begun.cost);
        for vertex in triangle {
            if let Some(place) = cache.iter().position(|cached| *cached == vertex) {
                left[place] -= 1;
                continue;
            }
            cost += MISS;
            // The oldest that this triangle does not need goes.
            let mut place = 0;
            while triangle.contains(&cache[place]) {
                place += 1;
            }
            cache[place..].rotate_left(1);
            left[place..].rotate_left(1);
            let others = self.adjacency.of(vertex).iter().filter(|other| !is_done(&begun.done, **other));
            (cache[CACHED - 1], left[CACHED - 1]) = (vertex, others.count() as u32 - 1);
        }
        let mut score = cost;
        for (place, left) in left.iter().enumerate().filter(|(_, left)| **left > 0) {
            let age = (CACHED - place) as i32;
            score += weights.there + (weights.age + weights.left * ((*left).min(4) as i32 - 1)) * age;
        }
        let hash = begun.hash ^ scrambled(u64::from(number) + 1);
        Step { cost, score, from, triangle: number, cache, left, hash }
    }

    /// The triangles that share a vertex with the cache, or else any.
    fn beside(&self, begun: &Begun) -> Vec<u32> {
        let vertices = begun.cache.iter().filter(|vertex| **vertex != NONE);
        let around = vertices.flat_map(|vertex| self.adjacency.of(*vertex)).copied();
        let mut beside: Vec<u32> = around.filter(|number| !is_done(&begun.done, *number)).collect();
        beside.sort_unstable();
        beside.dedup();
        // A fan of thousands around one vertex is the same wherever it goes on.
        beside.truncate(64);
        if beside.is_empty() {
            let word = begun.done.iter().position(|word| *word != u64::MAX).unwrap_or(0);
            beside.push(64 * word as u32 + begun.done[word].trailing_ones());
        }
        beside
    }

    /// The best order that is found with so many beginnings at a time.
    fn run(&self, width: usize, weights: Weights, mut progress: impl FnMut(f64)) -> Vec<u32> {
        let done = vec![0; self.triangles.len().div_ceil(64)];
        let mut beginnings =
            vec![Begun { done, cache: [NONE; CACHED], left: [0; CACHED], cost: 0, hash: 0, history: NONE }];
        let mut history: Vec<(u32, u32)> = Vec::new();
        let (mut steps, mut seen) = (Vec::new(), HashSet::new());
        for count in 0..self.triangles.len() {
            if count % 1024 == 0 {
                progress(count as f64 / self.triangles.len() as f64);
            }
            steps.clear();
            for (from, begun) in beginnings.iter().enumerate() {
                let beside = self.beside(begun);
                steps.extend(beside.iter().map(|number| self.step(begun, from as u32, *number, weights)));
            }
            steps.sort_unstable_by_key(|step| (step.score, step.hash));
            seen.clear();
            let mut next: Vec<Begun> = Vec::with_capacity(width);
            for step in &steps {
                if next.len() >= width {
                    break;
                }
                let cache = step.cache.iter().fold(0, |hash, vertex| scrambled(hash ^ u64::from(*vertex)));
                if !seen.insert(step.hash ^ cache) {
                    continue;
                }
                let begun = &beginnings[step.from as usize];
                let mut done = begun.done.clone();
                done[step.triangle as usize / 64] |= 1 << (step.triangle % 64);
                history.push((begun.history, step.triangle));
                let Step { cache, left, cost, hash, .. } = *step;
                next.push(Begun { done, cache, left, cost, hash, history: history.len() as u32 - 1 });
            }
            beginnings = next;
        }
        let mut at = beginnings.first().map_or(NONE, |best| best.history);
        let mut order = Vec::with_capacity(self.triangles.len());
        while let Some(&(before, triangle)) = history.get(at as usize) {
            order.push(triangle);
            at = before;
        }
        order.reverse();
        order
    }
}

/// A new order of triangles, and for each vertex its new number; `None` for one that no triangle names.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Order {
    /// The triangles, in the new numbers.
    pub(crate) triangles: Vec<[u32; 3]>,
    /// For each old number the new one.
    pub(crate) numbers: Vec<Option<u32>>,
    /// How many vertices of the new order are named.
    pub(crate) vertices: usize,
    /// What [`transforms`] counts of it.
    pub(crate) transforms: usize,
}

/// Numbers the vertices as they are needed first, of triangles in this order.
fn numbered(triangles: impl Iterator<Item = [u32; 3]>, vertices: usize) -> Order {
    let mut numbers = vec![None; vertices];
    let mut count = 0;
    let triangles: Vec<_> = triangles
        .map(|triangle| {
            triangle.map(|index| {
                *numbers[index as usize].get_or_insert_with(|| {
                    count += 1;
                    count - 1
                })
            })
        })
        .collect();
    let transforms = transforms(&triangles);
    Order { triangles, numbers, vertices: count as usize, transforms }
}

/// The order of the file.
pub(crate) fn in_given_order(triangles: &[[u32; 3]], vertices: usize) -> Order {
    numbered(triangles.iter().copied(), vertices)
}

/// The best order found for these triangles. `progress` is told which part of the work is done.
pub(crate) fn order(
    triangles: &[[u32; 3]],
    vertices: usize,
    thorough: bool,
    progress: &mut dyn FnMut(f64),
) -> Order {
    let mut best = in_given_order(triangles, vertices);
    let search = Search { triangles, adjacency: Adjacency::new(triangles, vertices) };
    let mut searches = QUICK.to_vec();
    if triangles.len() > LARGE {
        searches.truncate(2);
    }
    if thorough {
        searches.extend(THOROUGH);
    }
    let all: usize = searches.iter().map(|(width, _)| width).sum();
    let mut before = 0;
    for (width, weights) in searches {
        let found = search.run(width, weights, |part| {
            progress((before as f64 + width as f64 * part) / all as f64);
        });
        before += width;
        let found = numbered(found.iter().map(|number| triangles[*number as usize]), vertices);
        if found.transforms < best.transforms {
            best = found;
        }
    }
    best
}

#[cfg(test)]
mod tests {
    use super::*;

    fn grid(side: u32) -> (Vec<[u32; 3]>, usize) {
        let at = |x, y| y * (side + 1) + x;
        let cells = (0..side).flat_map(|y| (0..side).map(move |x| (x, y)));
        let halves = cells.flat_map(|(x, y)| {
            [[at(x, y), at(x + 1, y), at(x, y + 1)], [at(x + 1, y), at(x + 1, y + 1), at(x, y + 1)]]
        });
        (halves.collect(), ((side + 1) * (side + 1)) as usize)
    }

    #[test]
    fn a_better_order_has_the_same_triangles() {
        let (triangles, vertices) = grid(20);
        let found = order(&triangles, vertices, false, &mut |_| ());
        assert!(found.transforms < 800 * 3 / 4 && transforms(&triangles) > 800, "{}", found.transforms);
        let mut back = vec![0; vertices];
        for (old, new) in found.numbers.iter().enumerate() {
            back[new.expect("all are used") as usize] = old as u32;
        }
        let turned = |[a, b, c]: [u32; 3]| [[a, b, c], [b, c, a], [c, a, b]].into_iter().min();
        let mut given: Vec<_> = triangles.iter().copied().map(turned).collect();
        let mut ordered: Vec<_> = found
            .triangles
            .iter()
            .map(|triangle| turned(triangle.map(|index| back[index as usize])))
            .collect();
        given.sort_unstable();
        ordered.sort_unstable();
        assert_eq!(given, ordered);
    }

    /// What is simulated is what fixel does.
    #[test]
    fn transforms_are_those_that_fixel_counts() {
        use fixel::embedded_graphics::{pixelcolor::Rgb565, prelude::*};
        use fixel::{Band, Camera, Cull, Depth16, Material, Mesh, Pose, Stats, Turn, Vec3, Vertex};
        let (mut triangles, vertices) = grid(15);
        let mut random = 1_u64;
        for mixed in [false, true] {
            if mixed {
                for i in (1..triangles.len()).rev() {
                    random = scrambled(random + 1);
                    triangles.swap(i, (random % (i as u64 + 1)) as usize);
                }
            }
            let best = order(&triangles, vertices, false, &mut |_| ());
            for triangles in [&triangles, &best.triangles] {
                let mut points = vec![Vertex::default(); vertices];
                for (i, point) in points.iter_mut().enumerate() {
                    *point = Vertex::new((i % 16) as f32 / 8.0 - 1.0, (i / 16) as f32 / 8.0 - 1.0, 0.0);
                }
                let words: Vec<_> =
                    triangles.iter().map(|triangle| triangle.map(|index| index as u16)).collect();
                let mesh = Mesh::try_new(&points, &words).expect("indices are in range");
                let (mut pixels, mut depth) = ([0; 32 * 32], [0; 32 * 32]);
                let mut band =
                    Band::<Rgb565, Depth16>::new(Size::new(32, 32), &mut pixels, &mut depth).expect("a band");
                let camera =
                    Camera::perspective(Turn::from_degrees(60), band.size()).at(Vec3::lit(0.0, 0.0, 4.0));
                let mut stats = Stats::default();
                let material = Material::gouraud().cull(Cull::None);
                camera.draw_counted(&mesh, &Pose::IDENTITY, &material, &mut band, &mut stats);
                assert_eq!(stats.transformed as usize, transforms(triangles));
            }
        }
    }
}
