//! What is wrong with the surfaces of a model: counted and named.
//!
//! - In: triangles as the file has them.
//! - Out: for each object what will not look right.
//! - Assumes: finite positions.

use crate::model::{Part, Triangle};
use crate::normals::{across, place};
use std::collections::HashMap;

/// What was found in one object.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Surfaces {
    /// The object's name in the file.
    pub object: String,
    /// Triangles without area: they are not baked.
    pub degenerate: usize,
    /// Edges that only one triangle has: the surface is open, and its back can be seen.
    pub open_edges: usize,
    /// Edges along which two triangles run the same way: one of them shows its back.
    pub wound_against: usize,
    /// Edges that more than two triangles have.
    pub crowded_edges: usize,
    /// Closed surfaces that face inwards: from outside they are not seen.
    pub inside_out: usize,
    /// Triangles that face away from the normals of all of their corners.
    pub against_normals: usize,
}

/// What there is to say of all objects; for each kind of fault in how many places and in which objects.
pub(crate) fn texts(surfaces: &[Surfaces]) -> Vec<String> {
    type Count = fn(&Surfaces) -> usize;
    let kinds: [(Count, &str); 6] = [
        (|found| found.degenerate, "triangles without area are left out"),
        (
            |found| found.open_edges,
            "edges are open: backs can be seen there, and are not drawn unless the material is two-sided",
        ),
        (
            |found| found.wound_against,
            "edges are between triangles that are wound against each other: one of them shows its back",
        ),
        (|found| found.crowded_edges, "edges have more than two triangles"),
        (|found| found.inside_out, "closed surfaces face inwards: they are not seen from outside"),
        (|found| found.against_normals, "triangles face away from their normals"),
    ];
    let mut texts = Vec::new();
    for (count, what) in kinds {
        let objects: Vec<_> = surfaces.iter().filter(|found| count(found) > 0).collect();
        let total: usize = objects.iter().map(|found| count(found)).sum();
        if total == 0 {
            continue;
        }
        let named: Vec<_> = objects.iter().filter(|found| !found.object.is_empty()).collect();
        let names: Vec<_> = named.iter().take(4).map(|found| format!("`{}`", found.object)).collect();
        let more = if named.len() > 4 { format!(" and {} more", named.len() - 4) } else { String::new() };
        let place = if names.is_empty() { String::new() } else { format!(" ({}{more})", names.join(", ")) };
        let (count, rest) = what.split_once(' ').unwrap_or((what, ""));
        texts.push(format!("{total} {count}{place} {rest}"));
    }
    texts
}

/// A triangle's number, and whether it runs along the edge from the lower to the higher vertex.
type Side = (u32, bool);

fn root(parents: &mut [u32], mut of: u32) -> u32 {
    while parents[of as usize] != of {
        parents[of as usize] = parents[parents[of as usize] as usize];
        of = parents[of as usize];
    }
    of
}

/// What there is to say of each object.
pub(crate) fn surfaces(parts: &[Part]) -> Vec<Surfaces> {
    let mut order: Vec<&str> = Vec::new();
    let mut by_object: HashMap<&str, Vec<&Triangle>> = HashMap::new();
    for part in parts {
        by_object.entry(&part.name).or_insert_with(|| {
            order.push(&part.name);
            Vec::new()
        });
        by_object.entry(&part.name).or_default().extend(&part.triangles);
    }
    order.iter().map(|name| object(name, &by_object[name])).collect()
}

fn object(name: &str, triangles: &[&Triangle]) -> Surfaces {
    let mut found = Surfaces { object: name.to_owned(), ..Surfaces::default() };
    let mut numbers = HashMap::new();
    let mut edges: HashMap<(u32, u32), Vec<Side>> = HashMap::new();
    let mut volumes = Vec::new();
    for triangle in triangles {
        let corners = triangle.corners.map(|corner| corner.position);
        let normal = across(corners);
        if normal.iter().all(|component| *component == 0.0) {
            found.degenerate += 1;
            continue;
        }
        let faces_away = triangle.corners.iter().all(|corner| {
            corner
                .normal
                .is_some_and(|n| n.iter().zip(normal).map(|(a, b)| f64::from(*a) * b).sum::<f64>() < 0.0)
        });
        found.against_normals += usize::from(faces_away);
        let number = volumes.len() as u32;
        let [a, b, c] = corners.map(|corner| {
            let next = numbers.len() as u32;
            *numbers.entry(place(corner)).or_insert(next)
        });
        for (from, to) in [(a, b), (b, c), (c, a)] {
            edges.entry((from.min(to), from.max(to))).or_default().push((number, from < to));
        }
        let [x, y, z] = corners[0].map(f64::from);
        volumes.push(x * normal[0] + y * normal[1] + z * normal[2]);
    }
    let mut parents: Vec<u32> = (0..volumes.len() as u32).collect();
    for sides in edges.values() {
        for pair in sides.windows(2) {
            let [a, b] = [pair[0].0, pair[1].0].map(|number| root(&mut parents, number));
            parents[a as usize] = b;
        }
    }
    let mut is_open = vec![false; volumes.len()];
    for sides in edges.values() {
        let is_good = match sides[..] {
            [_] => {
                found.open_edges += 1;
                false
            }
            [(_, a), (_, b)] => {
                found.wound_against += usize::from(a == b);
                a != b
            }
            _ => {
                found.crowded_edges += 1;
                // Surfaces that only touch along an edge: as many this way as that.
                2 * sides.iter().filter(|(_, up)| *up).count() == sides.len()
            }
        };
        if !is_good {
            let of = root(&mut parents, sides[0].0);
            is_open[of as usize] = true;
        }
    }
    let mut sums: HashMap<u32, f64> = HashMap::new();
    for (number, volume) in volumes.iter().enumerate() {
        *sums.entry(root(&mut parents, number as u32)).or_default() += volume;
    }
    found.inside_out = sums.iter().filter(|(of, sum)| !is_open[**of as usize] && **sum < 0.0).count();
    found
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::{Corner, Smoothing};

    /// A tetrahedron, wound outwards.
    fn tetrahedron(at: f32) -> Vec<Triangle> {
        let points = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        let corner = |k: usize| {
            let [x, y, z] = points[k];
            Corner { position: [x + at, y, z], uv: None, normal: None, color: None }
        };
        let faces = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
        faces.map(|face| Triangle { corners: face.map(corner), smoothing: Smoothing::ByAngle }).to_vec()
    }

    fn found(triangles: Vec<Triangle>) -> Surfaces {
        surfaces(&[Part { name: "it".into(), material: 0, triangles }]).remove(0)
    }

    #[test]
    fn faults_of_surfaces_are_counted() {
        let good = tetrahedron(100.0);
        let well = Surfaces { object: "it".into(), ..Surfaces::default() };
        assert_eq!(found(good.clone()), well);
        assert!(texts(std::slice::from_ref(&well)).is_empty());
        let open = good[1..].to_vec();
        assert_eq!(found(open), Surfaces { open_edges: 3, ..well.clone() });
        let texts = texts(&[found(good[1..].to_vec())]);
        assert!(texts[0].starts_with("3 edges (`it`) are open"), "{texts:?}");
        let mut turned = good.clone();
        turned.iter_mut().for_each(|triangle| triangle.corners.swap(0, 1));
        assert_eq!(found(turned), Surfaces { inside_out: 1, ..well.clone() });
        let mut one = good.clone();
        one[2].corners.swap(0, 1);
        assert_eq!(found(one), Surfaces { wound_against: 3, ..well.clone() });
        let mut flat = good.clone();
        flat.push(Triangle { corners: [good[0].corners[0]; 3], smoothing: Smoothing::Flat });
        assert_eq!(found(flat), Surfaces { degenerate: 1, ..well.clone() });
        let mut away = good.clone();
        away[3].corners.iter_mut().for_each(|corner| corner.normal = Some([-1.0, 0.0, 0.0]));
        assert_eq!(found(away), Surfaces { against_normals: 1, ..well.clone() });
        assert_eq!(found([good.clone(), tetrahedron(0.0)].concat()), well);
    }
}
