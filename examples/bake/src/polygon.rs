//! Polygons to triangles: fans where they are convex, else ears.

use earcut::Earcut;

/// The triangles of a polygon, as numbers of its corners, in its own winding: two fewer than it has corners. One that crosses itself is
/// a fan.
pub(crate) fn triangles(corners: &[[f32; 3]]) -> Vec<[usize; 3]> {
    let count = corners.len();
    if count < 3 {
        return Vec::new();
    }
    let fan = || (1..count - 1).map(|i| [0, i, i + 1]).collect();
    if count == 3 {
        return fan();
    }
    let normal = newell(corners);
    let Some(axis) = (0..3).max_by(|a, b| normal[*a].abs().total_cmp(&normal[*b].abs())) else {
        return fan();
    };
    if normal[axis] == 0.0 {
        return fan();
    }
    // Seen along the axis on which it is largest, counter-clockwise.
    let (mut i, mut j) = ((axis + 1) % 3, (axis + 2) % 3);
    if normal[axis] < 0.0 {
        (i, j) = (j, i);
    }
    let flat: Vec<[f64; 2]> = corners.iter().map(|at| [f64::from(at[i]), f64::from(at[j])]).collect();
    let turn =
        |a: [f64; 2], b: [f64; 2], c: [f64; 2]| (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
    if (0..count).all(|k| turn(flat[k], flat[(k + 1) % count], flat[(k + 2) % count]) >= 0.0)
        && (1..count - 1).all(|k| turn(flat[0], flat[k], flat[k + 1]) >= 0.0)
    {
        return fan();
    }
    let mut ears: Vec<usize> = Vec::new();
    Earcut::new().earcut(flat.iter().copied(), &[], &mut ears);
    let ears = ears.as_chunks::<3>().0;
    if ears.len() != count - 2 {
        // It crosses itself, as seen from there.
        return fan();
    }
    // Ears come in either winding.
    ears.iter()
        .map(|&[a, b, c]| if turn(flat[a], flat[b], flat[c]) < 0.0 { [a, c, b] } else { [a, b, c] })
        .collect()
}

/// Across a polygon, as long as twice its area.
fn newell(corners: &[[f32; 3]]) -> [f64; 3] {
    let mut normal = [0.0; 3];
    for (k, a) in corners.iter().enumerate() {
        let b = &corners[(k + 1) % corners.len()];
        for (axis, sum) in normal.iter_mut().enumerate() {
            let (i, j) = ((axis + 1) % 3, (axis + 2) % 3);
            *sum += (f64::from(a[i]) - f64::from(b[i])) * (f64::from(a[j]) + f64::from(b[j]));
        }
    }
    normal
}

#[cfg(test)]
mod tests {
    use super::*;

    fn area(corners: &[[f32; 3]], triangles: &[[usize; 3]]) -> f64 {
        triangles.iter().map(|t| newell(&t.map(|k| corners[k]))[2] / 2.0).sum()
    }

    #[test]
    fn concave_polygons_keep_their_area_and_winding() {
        let arrow = [[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [4.0, 4.0, 0.0], [3.0, 1.0, 0.0]];
        let found = triangles(&arrow);
        assert_eq!(found.len(), 2);
        assert!((area(&arrow, &found) - 4.0).abs() < 1e-9);
        let turned: Vec<_> = arrow.iter().rev().copied().collect();
        assert!((area(&turned, &triangles(&turned)) + 4.0).abs() < 1e-9);
        assert_eq!(triangles(&[[1.0; 3]; 5]).len(), 3);
        assert_eq!(triangles(&arrow[..2]), [[0; 3]; 0]);
    }
}
