//! What the documentation promises, against f64 and i128.

use super::super::quaternion::tests::{exact, matrix, measured, nearer, rotations, slerp, vec3};
use super::*;
use proptest::prelude::*;

#[test]
fn turns_are_right_handed() {
    let quarter = Turn::from_degrees(90);
    // A turn about x takes y to z: the column of y is (0, 0, 1).
    assert_eq!(Pose::IDENTITY.rotated_x(quarter).rotation[2][1], 1);
    assert_eq!(Pose::IDENTITY.rotated_y(quarter).rotation[0][2], 1);
    assert_eq!(Pose::IDENTITY.rotated_z(quarter).rotation[1][0], 1);
    for (axis, turned) in [
        (Vec3::lit(0.01, 0.0, 0.0), Pose::IDENTITY.rotated_x(quarter)),
        (Vec3::lit(0.0, 9.0, 0.0), Pose::IDENTITY.rotated_y(quarter)),
        (Vec3::lit(0.0, 0.0, 30_000.0), Pose::IDENTITY.rotated_z(quarter)),
    ] {
        assert_eq!(Pose::from_axis_turn(axis, quarter), turned);
    }
    assert_eq!(Pose::from_axis_turn(Vec3::ZERO, quarter), Pose::IDENTITY);
}

type Bits = ([[i16; 3]; 3], [u32; 3], [i32; 3]);

fn pose((rotation, scale, to): Bits) -> Pose {
    Pose {
        rotation: rotation.map(|row| row.map(I2F14::from_bits)),
        scale: scale.map(U10F22::from_bits),
        translation: vec3(to),
    }
}

/// Rotations with a scale of 2⁻⁹ … 2⁹ and a translation within ±1000.
fn sound() -> impl Strategy<Value = Pose> {
    (
        rotations(),
        0u32..19,
        0u32..1 << 13,
        proptest::array::uniform3(-1000i32 << 16..1000 << 16).prop_map(vec3),
    )
        .prop_map(|(q, shift, low, to)| {
            Pose::from_quaternion(q).scaled(U10F22::from_bits(((1 << 13) | low) << shift)).at(to)
        })
}

fn elements(rotation: &[[I2F14; 3]; 3]) -> [[f64; 3]; 3] {
    rotation.map(|row| row.map(|e| f64::from(e.to_bits())))
}

/// The largest difference of two elements, in 2⁻¹⁴.
fn error(ours: &[[I2F14; 3]; 3], exact: [[f64; 3]; 3]) -> f64 {
    let (ours, exact) = (elements(ours), exact.map(|row| row.map(|e| e * 16384.0)));
    (0..9).map(|i| (ours[i / 3][i % 3] - exact[i / 3][i % 3]).abs()).fold(0.0, f64::max)
}

fn product(a: [[f64; 3]; 3], b: [[f64; 3]; 3]) -> [[f64; 3]; 3] {
    a.map(|row| core::array::from_fn(|c| (0..3).map(|k| row[k] * b[k][c]).sum()))
}

/// Rounded to nearest, halves up, and limited to the range of what it is compared with.
fn rounded(value: i128, shift: u32, min: i128, max: i128) -> i128 {
    ((value + (1 << (shift - 1))) >> shift).clamp(min, max)
}

#[test]
fn points_directions_and_products_of_any_bits_are_exact_but_for_one_rounding_in_20_000_cases() {
    let samples = (any::<[Bits; 2]>(), 0u32..32, 0u32..32, any::<bool>());
    measured("poses of any bits against i128", samples, [0.0], |(bits, shift, shift_2, is_even)| {
        let [mut a, mut b] = bits;
        a.1 = a.1.map(|scale| if is_even { a.1[0] >> shift } else { scale >> shift });
        b.2 = b.2.map(|c| c >> shift_2);
        let (outer, inner) = (pose(a), pose(b));
        let product = outer * inner;
        assert_eq!(product, inner.then(outer));
        let sum = |row: usize, by: [i128; 3]| (0..3).map(|k| i128::from(a.0[row][k]) * by[k]).sum::<i128>();
        let (min, max) = (i32::MIN.into(), i32::MAX.into());
        let (moved, pointed) = (outer.transform_point(vec3(b.2)), outer.transform_direction(vec3(b.2)));
        for i in 0..3 {
            let turned = sum(i, b.2.map(i128::from));
            let scaled = [0, 1, 2].map(|k| i128::from(b.2[k]) * i128::from(a.1[k]));
            let placed = rounded(sum(i, scaled), 36, i128::MIN, i128::MAX) + i128::from(a.2[i]);
            assert_eq!(i128::from(moved.bits()[i]), placed.clamp(min, max));
            assert_eq!(i128::from(pointed.bits()[i]), rounded(turned, 14, min, max));
            for c in if is_even { 0..3 } else { 0..0 } {
                let exact =
                    rounded(sum(i, b.0.map(|row| row[c].into())), 14, i16::MIN.into(), i16::MAX.into());
                assert_eq!(i128::from(product.rotation[i][c].to_bits()), exact);
                let scale = rounded(i128::from(a.1[c]) * i128::from(b.1[c]), 22, 0, u32::MAX.into());
                assert_eq!(i128::from(product.scale[c].to_bits()), scale);
            }
        }
        assert_eq!(product.translation, moved);
        [0.0]
    });
}

#[test]
fn rotating_rounds_once_in_20_000_cases() {
    let samples = (rotations(), sound(), any::<[u16; 4]>());
    measured(
        "rotated, from Euler turns, from three turns, 2^-14",
        samples,
        [0.501, 0.501, 2.8],
        |(q, pose, raw)| {
            let [yaw, pitch, roll, _] = raw.map(Turn::from_raw);
            let turned = pose.rotated(q);
            assert_eq!((turned.scale, turned.translation), (pose.scale, pose.translation));
            let by = elements(&pose.rotation).map(|row| row.map(|e| e / 16384.0));
            let half = |t: Turn| (f64::from(t.raw()) / 65536.0 * core::f64::consts::PI).sin_cos();
            let ((ys, yc), (xs, xc), (zs, zc)) = (half(yaw), half(pitch), half(roll));
            let euler = product(
                matrix([yc, 0.0, ys, 0.0]),
                product(matrix([xc, xs, 0.0, 0.0]), matrix([zc, 0.0, 0.0, zs])),
            );
            let steps = Pose::IDENTITY.rotated_z(roll).rotated_x(pitch).rotated_y(yaw);
            [
                error(&turned.rotation, product(matrix(exact(q)), by)),
                error(&Pose::from_euler(yaw, pitch, roll).rotation, euler),
                error(&steps.rotation, euler),
            ]
        },
    );
}

#[test]
fn inverse_undoes_within_its_bounds_in_20_000_cases() {
    let samples = (sound(), proptest::array::uniform3(-1000i32 << 16..1000 << 16), 0u32..26);
    let bounds = [2.3, 1.0001, 1.0];
    measured("inverse: turn in 2^-14; scale, points of their bounds", samples, bounds, |(pose, x, shift)| {
        let x = x.map(|c| c >> shift);
        let inverse = pose.inverse();
        let both = pose.then(inverse);
        let turn = error(&both.rotation, matrix([1.0, 0.0, 0.0, 0.0]));
        // Half a bit of the reciprocal.
        let unit = 2f64.powi(-22);
        let (scale, back) =
            (f64::from(pose.scale[0].to_bits()) * unit, f64::from(inverse.scale[0].to_bits()) * unit);
        let wrong = (scale * back - 1.0).abs() / (scale * unit / 2.0);
        // A point: the scale's error, RᵀR's, and three roundings, of which the scale back enlarges the first.
        let ours = inverse.transform_point(pose.transform_point(vec3(x))).bits();
        let sum = x.iter().map(|&c| f64::from(c).abs()).sum::<f64>();
        let saturates = back * 1733.0 > 32_767.0 || scale * 1733.0 + 1000.0 > 32_767.0;
        let of_bound = (0..3).map(|i| {
            let x = f64::from(x[i]);
            let bound =
                scale * unit / 2.0 * x.abs() + 1.0002 * 1.74 / 16384.0 * sum + 0.5 * 1.74 * back + 1.0;
            (f64::from(ours[i]) - x).abs() / bound
        });
        [turn, wrong, if saturates { 0.0 } else { of_bound.fold(0.0, f64::max) }]
    });
}

#[test]
fn scales_without_a_reciprocal_saturate() {
    for (scale, back) in
        [(0, u32::MAX), (1, u32::MAX), (1 << 12, u32::MAX), (4097, 4_293_918_976), (u32::MAX, 1 << 12)]
    {
        assert_eq!(
            Pose::IDENTITY.scaled(U10F22::from_bits(scale)).inverse().scale.map(U10F22::to_bits),
            [back; 3],
            "{scale}"
        );
    }
}

#[test]
fn interpolation_is_slerp_and_straight_lines_in_20_000_cases() {
    let samples = (rotations(), rotations(), sound(), sound(), 1..65536i32);
    measured(
        "interpolation: turn in 2^-14, the rest in bits",
        samples,
        [2.0, 0.5],
        |(p, q, from, to, raw)| {
            let (from, to) = (from.rotated_to(p), to.rotated_to(q));
            let t = I16F16::from_bits(raw);
            let ours = from.interpolate(&to, t);
            assert_eq!(from.interpolate(&to, I16F16::ZERO), from);
            assert_eq!(from.interpolate(&to, I16F16::ONE), to);
            let t = f64::from(raw) / 65536.0;
            // Half a turn apart the two matrices may choose the other way.
            let near: f64 = exact(p).iter().zip(exact(q)).map(|(a, b)| a * b).sum();
            let turn = error(&ours.rotation, matrix(slerp(exact(p), exact(nearer(p, q)), t)));
            let line = |a: f64, b: f64, ours: f64| (a + (b - a) * t - ours).abs();
            let mut rest = 0f64;
            for i in 0..3 {
                let [a, b, c] = [from, to, ours].map(|pose| f64::from(pose.scale[i].to_bits()));
                rest = rest.max(line(a, b, c));
                let [a, b, c] = [from, to, ours].map(|pose| f64::from(pose.translation.bits()[i]));
                rest = rest.max(line(a, b, c));
            }
            [if near.abs() < 0.001 { 0.0 } else { turn }, rest]
        },
    );
}

impl Pose {
    fn rotated_to(self, q: Quaternion) -> Self {
        Self { rotation: q.rotation(), ..self }
    }
}

#[test]
fn orthonormalizing_mends_1_000_turns_of_a_little() {
    let mut pose = Pose::IDENTITY;
    for i in 0..1000u16 {
        pose = pose.rotated_x(Turn::from_raw(301)).rotated_y(Turn::from_raw(i));
    }
    let skew = |pose: &Pose| {
        let rows = elements(&pose.rotation).map(|row| row.map(|e| e / 16384.0));
        let columns = core::array::from_fn(|r| core::array::from_fn(|c| rows[c][r]));
        let unit = product(columns, rows);
        (0..9).map(|i| (unit[i / 3][i % 3] - f64::from(u8::from(i % 4 == 0))).abs()).fold(0.0, f64::max)
            * 16384.0
    };
    let mended = pose.orthonormalized();
    std::println!("2000 turns: skewed by {:.1} · 2^-14, mended {:.2}", skew(&pose), skew(&mended));
    assert!(skew(&mended) <= 1.74);
    assert!(
        error(&mended.rotation, elements(&pose.rotation).map(|row| row.map(|e| e / 16384.0))) < skew(&pose)
    );
}

#[test]
fn nothing_panics_on_20_000_bit_patterns() {
    let samples = any::<([Bits; 2], [i32; 3], i32)>();
    measured("poses from any bits", samples, [1.74], |([a, b], point, t)| {
        let (a, b, t) = (pose(a), pose(b), I16F16::from_bits(t));
        let between = a.interpolate(&b, t).interpolate(&a, I16F16::from_bits(t.to_bits() & 0xffff));
        for pose in [a.inverse(), a.inverse().inverse(), a.then(b).inverse() * between, between] {
            let _ = (pose.transform_point(vec3(point)), pose.transform_direction(vec3(point)));
            let _ = pose.rotated(b.quaternion()).rotated_x(Turn::from_raw(t.to_bits() as u16));
        }
        let rows = elements(&a.orthonormalized().rotation);
        let length = |row: [f64; 3]| row.iter().map(|e| e * e).sum::<f64>() / 16384.0 - 16384.0;
        [rows.map(length).into_iter().fold(0.0, |worst, length| worst.max(length.abs()))]
    });
    for bits in [i16::MIN, 0, i16::MAX] {
        for (scale, to) in [(0, i32::MIN), (u32::MAX, i32::MIN), (u32::MAX, i32::MAX)] {
            for scales in [[scale; 3], [scale, 1, u32::MAX]] {
                let pose = pose(([[bits; 3]; 3], scales, [to; 3]));
                let both = (pose * pose.inverse()).interpolate(&pose.orthonormalized(), I16F16::lit("0.5"));
                let _ = (both.transform_point(vec3([to; 3])), both.rotated(pose.quaternion()));
            }
        }
    }
}

/// Sound poses with a scale for each axis, and some mirrored.
fn stretched() -> impl Strategy<Value = Pose> {
    let scale =
        || (0u32..10, 0u32..1 << 18).prop_map(|(shift, low)| U10F22::from_bits((1 << 18 | low) << shift));
    (sound(), [scale(), scale(), scale()], any::<bool>()).prop_map(|(pose, scales, mirror)| {
        let pose = pose.stretched(scales);
        if mirror { Pose { rotation: turned_round(pose.rotation), ..pose } } else { pose }
    })
}

/// Rotation times scale.
fn linear(pose: &Pose) -> [[f64; 3]; 3] {
    elements(&pose.rotation).map(|row| {
        core::array::from_fn(|i| row[i] / 16384.0 * f64::from(pose.scale[i].to_bits()) / 4_194_304.0)
    })
}

fn column(matrix: [[f64; 3]; 3], i: usize) -> [f64; 3] {
    matrix.map(|row| row[i])
}

fn long(v: [f64; 3]) -> f64 {
    v.iter().map(|c| c * c).sum::<f64>().sqrt()
}

/// The largest difference of two columns, of what rounding each of the first's elements and lengths may make of it.
fn columns_off(ours: [[f64; 3]; 3], exact: [[f64; 3]; 3]) -> f64 {
    let columns = (0..3).map(|i| {
        let (ours, exact) = (column(ours, i), column(exact, i));
        let off = long(core::array::from_fn(|k| ours[k] - exact[k]));
        let bound = long(exact) * (0.501 * 3f64.sqrt() / 16384.0 + 2f64.powi(-27)) + 0.51 * 2f64.powi(-22);
        off / bound
    });
    columns.fold(0.0, f64::max)
}

#[test]
fn a_child_of_a_stretched_parent_is_where_both_matrices_put_it_in_20_000_cases() {
    let samples = (stretched(), stretched());
    measured("stretched, then stretched: of the bound", samples, [1.0], |(inner, outer)| {
        let both = inner.then(outer);
        let exact = product(linear(&outer), linear(&inner));
        if (0..3).any(|i| long(column(exact, i)) > 1023.0) {
            return [0.0];
        }
        // Columns of length 1 almost in a plane may change sides of it as they are rounded.
        let determinant: f64 = [inner, outer].iter().flat_map(|pose| pose.scale).map(f64::from).product();
        let lengths: f64 = (0..3).map(|i| long(column(exact, i))).product();
        if determinant / lengths > 1e-3 {
            assert_eq!(both.is_mirrored(), inner.is_mirrored() != outer.is_mirrored());
        }
        [columns_off(linear(&both), exact)]
    });
}

#[test]
fn quarter_turns_in_a_stretched_parent_shear_nothing() {
    let quarter = Turn::from_degrees(90);
    let parent = Pose::IDENTITY.stretched_lit(2.0, 3.0, 1000.1).rotated_x(Turn::from_degrees(20));
    let [x, y, z] = parent.scale;
    let child = Pose::IDENTITY.rotated_y(quarter).rotated_x(quarter);
    // x goes to y, y to z, z to x.
    let both = parent * child;
    assert_eq!(both.scale, [y, z, x]);
    assert_eq!(both.rotation, child.then(Pose { scale: Pose::IDENTITY.scale, ..parent }).rotation);
    assert_eq!((parent * Pose::IDENTITY), parent);
}

#[test]
fn inverse_undoes_stretch_shear_and_mirrors_in_20_000_cases() {
    let samples = (stretched(), stretched());
    measured("inverse of any matrix: of the bound", samples, [1.0], |(inner, outer)| {
        let mut worst = 0f64;
        for pose in [inner, inner.then(outer)] {
            let (inverse, matrix) = (pose.inverse(), linear(&pose));
            // By Cramer's rule.
            let [a, b, c] = matrix;
            let cross = |a: [f64; 3], b: [f64; 3]| -> [f64; 3] {
                core::array::from_fn(|i| a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3])
            };
            let columns = [cross(b, c), cross(c, a), cross(a, b)];
            let determinant: f64 = (0..3).map(|i| a[i] * columns[0][i]).sum();
            let exact: [[f64; 3]; 3] =
                core::array::from_fn(|row| core::array::from_fn(|i| columns[i][row] / determinant));
            if (0..3).any(|i| long(column(exact, i)) > 1023.0) {
                continue;
            }
            // Columns of length 1 almost in a plane may change sides of it as they are rounded.
            let lengths: f64 = (0..3).map(|i| long(column(exact, i))).product();
            if (determinant * lengths).recip().abs() > 1e-3 {
                assert_eq!(inverse.is_mirrored(), pose.is_mirrored());
            }
            worst = worst.max(columns_off(linear(&inverse), exact));
        }
        [worst]
    });
}

#[test]
fn what_is_flat_has_an_inverse_of_the_largest_scale() {
    let flat = Pose::IDENTITY.stretched_lit(1.0, 0.0, 1.0).inverse();
    assert_eq!(flat.scale, [U10F22::ONE, U10F22::MAX, U10F22::ONE]);
    let singular = Pose { rotation: [[I2F14::ONE; 3]; 3], ..Pose::IDENTITY }.inverse();
    assert_eq!(singular.scale, [U10F22::ZERO; 3], "all cofactors are 0");
    let tiny = Pose::IDENTITY.stretched([U10F22::from_bits(1), U10F22::MAX, U10F22::ONE]);
    assert_eq!(tiny.inverse().scale, [U10F22::MAX, U10F22::from_bits(1 << 12), U10F22::ONE]);
}

#[test]
fn a_pose_with_one_axis_turned_round_is_mirrored_in_20_000_cases() {
    measured("mirrored", (stretched(), 0usize..3, rotations()), [0.51], |(pose, axis, q)| {
        let mut other = pose;
        other.rotation.iter_mut().for_each(|row| row[axis] = -row[axis]);
        assert_ne!(pose.is_mirrored(), other.is_mirrored());
        assert_eq!(pose.rotated(q).is_mirrored(), pose.is_mirrored());
        let mended = pose.orthonormalized();
        assert_eq!((mended.is_mirrored(), mended.scale), (pose.is_mirrored(), pose.scale));
        assert!(pose.scaled(U10F22::ONE).keeps_angles() && other.scaled(U10F22::MAX).keeps_angles());
        // It was rounded from one, and is rounded to one that is as near.
        [error(&mended.rotation, elements(&pose.rotation).map(|row| row.map(|e| e / 16384.0))) / 3.0]
    });
}

#[test]
fn between_mirrored_poses_all_are_and_from_one_to_another_it_turns_inside_out_when_flat() {
    let half = I16F16::lit("0.5");
    let mirror = |pose: Pose| Pose { rotation: turned_round(pose.rotation), ..pose };
    let (from, to) = (Pose::IDENTITY, Pose::IDENTITY.rotated_y(Turn::from_degrees(90)).scaled_lit(3.0));
    let between = mirror(from).interpolate(&mirror(to), half);
    assert_eq!(between, mirror(from.interpolate(&to, half)));
    for (t, x, is_mirrored) in [(0.125, 0.5, true), (0.25, 0.0, true), (0.5, 1.0, false), (0.75, 2.0, false)]
    {
        let between = mirror(from).interpolate(&to, I16F16::from_num(t));
        assert_eq!(between.scale[0], U10F22::from_num(x), "at {t}");
        // Along y and z it is as between any two.
        assert_eq!(between.scale[1..], from.interpolate(&to, I16F16::from_num(t)).scale[1..]);
        assert_eq!(between.is_mirrored(), is_mirrored, "at {t}");
    }
}

#[test]
fn scales_that_are_none_are_errors() {
    for bad in [-1.0, -1e-9, 1024.0, f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
        for (i, [x, y, z]) in [[bad, 1.0, 1.0], [1.0, bad, 2000.0], [0.0, 1.0, bad]].into_iter().enumerate() {
            let error = Pose::IDENTITY.try_stretched_lit(x, y, z).expect_err("it is none");
            assert_eq!(error.scale.to_bits(), bad.to_bits(), "{i}");
        }
    }
    let pose = Pose::IDENTITY.try_stretched_lit(0.0, 1e-3, 1023.999).map(|pose| pose.scale);
    assert_eq!(pose, Ok([0.0, 1e-3f32, 1023.999].map(U10F22::from_num)));
    assert_eq!(Pose::IDENTITY.stretched_lit(-0.0, 1.0, 1.0).scale[0], 0);
}
