//! The reference itself, held against cases done by hand and against what the definitions imply: an error here would
//! make every other test agree with a mistake.
#![allow(clippy::float_arithmetic, reason = "the reference reads its exact fractions as f64")]

mod reference;

use reference::{ATTRIBUTES, Corner, Facing, Sample, Triangle, UNIT};

/// Vertices in 1/16 pixel, with q = 1 and no attributes.
fn plain(points: [(i32, i32); 3]) -> Triangle {
    Triangle(points.map(|(x, y)| Corner { x, y, q: 1 << 30, attributes: [0; ATTRIBUTES] }))
}

/// One line of text a row, `#` for a covered pixel.
fn picture(triangle: &Triangle, width: i32, height: i32) -> Vec<String> {
    let symbol = |x, y| if triangle.covers(x, y) { '#' } else { '.' };
    (0..height).map(|y| (0..width).map(|x| symbol(x, y)).collect()).collect()
}

/// The usual way to write the rule: on an edge of a clockwise triangle (y down) a centre counts if the edge goes up
/// (left) or is horizontal and goes right (top).
fn covers_by_the_book(triangle: &Triangle, x: i32, y: i32) -> bool {
    let mut points = triangle.0.map(|corner| (i64::from(corner.x), i64::from(corner.y)));
    if triangle.twice_area() < 0 {
        points.swap(1, 2);
    }
    let (px, py) = (i64::from(16 * x + 8), i64::from(16 * y + 8));
    let inside = |a: (i64, i64), b: (i64, i64)| {
        let (dx, dy) = (b.0 - a.0, b.1 - a.1);
        let edge = dx * (py - a.1) - dy * (px - a.0);
        edge > 0 || edge == 0 && (dy < 0 || dy == 0 && dx > 0)
    };
    triangle.twice_area() != 0
        && inside(points[0], points[1])
        && inside(points[1], points[2])
        && inside(points[2], points[0])
}

#[test]
fn coverage_of_small_cases_by_hand() {
    // Vertices on pixel corners; the diagonal goes through centres and is a right edge: they are out.
    let half = plain([(0, 0), (64, 0), (0, 64)]);
    assert_eq!(picture(&half, 5, 5), ["###..", "##...", "#....", ".....", "....."]);
    // The other half of the square has the diagonal as a left edge: they are in.
    let other = plain([(64, 0), (64, 64), (0, 64)]);
    assert_eq!(picture(&other, 5, 5), ["...#.", "..##.", ".###.", "####.", "....."]);
    // Vertices on pixel centres: top and left edges count, the diagonal and the lowest vertex do not.
    let centred = plain([(8, 8), (8 + 48, 8), (8, 8 + 48)]);
    assert_eq!(picture(&centred, 5, 5), ["###..", "##...", "#....", ".....", "....."]);
    // A bottom edge on centres does not count, a right edge neither.
    let lower = plain([(8 + 48, 8), (8 + 48, 8 + 48), (8, 8 + 48)]);
    assert_eq!(
        picture(&lower, 5, 5),
        [".....", "..#..", ".##..", ".....", "....."].map(|row| row.to_string())
    );
    // Smaller than a pixel, around a centre, and beside it.
    assert_eq!(picture(&plain([(7, 7), (10, 7), (7, 10)]), 2, 1), ["#."]);
    assert_eq!(picture(&plain([(9, 7), (12, 7), (9, 12)]), 2, 1), [".."]);
}

#[test]
fn facing_by_hand() {
    // Right, then down: clockwise as seen with y down.
    let clockwise = [(0, 0), (16, 0), (16, 16)];
    assert_eq!(plain(clockwise).facing(), Facing::Back);
    assert_eq!(plain([clockwise[0], clockwise[2], clockwise[1]]).facing(), Facing::Front);
    assert_eq!(plain([(0, 0), (5, 5), (-9, -9)]).facing(), Facing::Edge);
    assert!(!plain([(8, 8), (24, 24), (40, 40)]).covers(0, 0));
    assert_eq!(plain([(0, 0), (16, 0), (0, 16)]).twice_area(), 256);
}

#[test]
fn coverage_is_the_top_left_rule_for_every_triangle_on_a_lattice() {
    // Every triangle with vertices on a 7 × 7 lattice of quarter pixels around pixel centres: 117,649.
    let place = |index: i32| (4 * (index % 7), 4 * (index / 7));
    let mut covered = 0;
    for (a, b, c) in (0..49).flat_map(|a| (0..49).flat_map(move |b| (0..49).map(move |c| (a, b, c)))) {
        let triangle = plain([place(a), place(b), place(c)]);
        let turned = plain([place(b), place(c), place(a)]);
        let flipped = plain([place(b), place(a), place(c)]);
        for (x, y) in [(0, 0), (1, 0), (0, 1), (1, 1), (-1, 0), (0, -1), (2, 2)] {
            let inside = triangle.covers(x, y);
            covered += u32::from(inside);
            assert_eq!(inside, covers_by_the_book(&triangle, x, y), "{triangle:?} at {x}, {y}");
            assert_eq!(inside, turned.covers(x, y));
            assert_eq!(inside, flipped.covers(x, y));
        }
    }
    assert!(covered > 10_000, "only {covered} pixels covered");
}

#[test]
fn a_fan_around_any_lattice_point_covers_each_pixel_once() {
    let rim =
        [(-100, -100), (8, -120), (140, -100), (140, 40), (140, 140), (24, 150), (-100, 140), (-110, 8)];
    for centre in (0..40).flat_map(|y| (0..40).map(move |x| (x, y))) {
        let fan: Vec<_> = (0..8).map(|i| plain([centre, rim[i], rim[(i + 1) % 8]])).collect();
        for (x, y) in (-4..6).flat_map(|y| (-4..6).map(move |x| (x, y))) {
            let times = fan.iter().filter(|triangle| triangle.covers(x, y)).count();
            assert_eq!(times, 1, "around {centre:?} at {x}, {y}");
        }
    }
}

#[test]
fn attributes_of_a_wall_by_hand() {
    // u = x/w and q = 1/w along a wall from w = 1 at x = 0 to w = 4 at x = 30 pixels, u from 0 to 90 texels. In the
    // middle q = 5/8 and u·q = 90/4/2, so u = 18.
    let corner = |x: i32, y: i32, q: u32, u: i32| Corner {
        x: 16 * x + 8,
        y: 16 * y + 8,
        q,
        attributes: [u << 16, 7 << 16, 0, 0, 255 << 16],
    };
    let wall = Triangle([corner(0, 0, 1 << 30, 0), corner(30, 0, 1 << 28, 90), corner(0, 30, 1 << 30, 0)]);
    let middle = wall.at(15, 0);
    assert_eq!(middle.q(), 0.625 * f64::from(1 << 30));
    assert_eq!(middle.attribute(0), 18.0 * UNIT);
    assert_eq!(middle.affine_attribute(0), 45.0 * UNIT);
    assert_eq!(middle.attribute(1), 7.0 * UNIT);
    assert_eq!(middle.attribute(4), 255.0 * UNIT);
    assert_eq!(wall.at(0, 0).attribute(0), 0.0);
    assert_eq!(wall.at(30, 0).attribute(0), 90.0 * UNIT);
    // u(x) = (90/4)(x/30) / (1 − x/40) = 0.75·x / (1 − x/40): u′(15) = 0.75 / 0.625² = 1.92.
    let change = middle.change(0);
    assert!((change.derivative / UNIT - 1.92).abs() < 1e-12);
    let next = 0.75 * 16.0 / (1.0 - 16.0 / 40.0);
    assert!((change.step / UNIT - (next - 18.0)).abs() < 1e-9);
    // The depth word: 5/8 of 2³⁰ is 20480 steps of 2¹⁵.
    assert_eq!(middle.depth_word(), 20480);
    assert_eq!(middle.depth_error(20480 << 15), 0.0);
    assert_eq!(middle.depth_error(20482 << 15), 2.0);
    assert_eq!(wall.range(0), (0, 90 << 16));
}

#[test]
fn winding_does_not_matter_to_the_planes() {
    let corner = |x, y, q, u| Corner { x, y, q, attributes: [u, -u, 3, 2 * u, 1] };
    let [a, b, c] =
        [corner(-99, 7, 5_000, 77), corner(130, -61, 2_000_000_000, -900), corner(45, 200, 123_456, 8)];
    let values = |triangle: Triangle| {
        let sample: Sample<'_> = triangle.at(2, 3);
        (
            sample.q(),
            sample.depth_word(),
            sample.attribute(0),
            sample.change(0).step,
            sample.change(3).derivative,
        )
    };
    assert_eq!(values(Triangle([a, b, c])), values(Triangle([a, c, b])));
}

#[test]
fn the_side_of_a_straight_coordinate_by_hand() {
    // u goes from 0 to 4 texels over 4 pixels to the right, v from 4 to 0 downwards; vertices on pixel centres.
    let corner = |x: i32, y: i32| Corner {
        x: 16 * x + 8,
        y: 16 * y + 8,
        q: 1 << 30,
        attributes: [x << 16, (4 - y) << 16, 5 << 16, (4 - x) << 16, 0],
    };
    let triangle = Triangle([corner(0, 0), corner(4, 0), corner(0, 4)]);
    let texel = |attribute, x, y| triangle.at(x, y).straight(attribute).texels(0, 0);
    // Whole at every centre: u goes on to the right, v falls below the row, and so does the fourth to the right.
    assert_eq!([0, 1, 2].map(|x| texel(0, x, 0)), [0..=0, 1..=1, 2..=2]);
    assert_eq!([0, 1, 2].map(|y| texel(1, 0, y)), [3..=3, 2..=2, 1..=1]);
    assert_eq!([0, 1, 2].map(|x| texel(3, x, 1)), [3..=3, 2..=2, 1..=1]);
    // The same all over: it stays.
    assert_eq!(texel(2, 1, 1), 5..=5);
    // A tenth of a texel ahead changes nothing of whole ones that rise, nor of those that fall.
    assert_eq!(triangle.at(1, 1).straight(0).texels(0, 6554), 1..=1);
    assert_eq!(triangle.at(1, 1).straight(1).texels(0, 6554), 2..=2);
    // A texel ahead is the next, but at the end of the range.
    assert_eq!(triangle.at(1, 1).straight(0).texels(0, 65536), 1..=2);
    assert_eq!(triangle.at(0, 3).straight(1).texels(0, 65536), 0..=0);
    // Times four: u is 4 at the second pixel.
    assert_eq!(triangle.at(1, 1).straight(0).texels(2, 0), 4..=4);
    assert_eq!(triangle.at(1, 1).straight(1).texels(2, 0), 11..=11);
    // As units of 2⁻¹⁶.
    assert_eq!(triangle.at(1, 1).straight(0).values(3), 65536..=65539);
    assert_eq!(triangle.at(1, 1).straight(1).values(3), (3 << 16) - 4..=(3 << 16) - 1);
}
