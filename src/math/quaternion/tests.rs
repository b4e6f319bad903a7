//! What the documentation promises, against f64 and i128.

use super::*;
use proptest::prelude::*;
use std::println;

const BIT: f64 = 1.0 / (1u64 << 30) as f64;

/// What the bits stand for, at length 1.
pub(in crate::math) fn exact(q: Quaternion) -> [f64; 4] {
    unit(q.bits.map(f64::from))
}

fn unit<const N: usize>(v: [f64; N]) -> [f64; N] {
    let length = v.iter().map(|c| c * c).sum::<f64>().sqrt();
    v.map(|c| c / length)
}

fn product([aw, ax, ay, az]: [f64; 4], [bw, bx, by, bz]: [f64; 4]) -> [f64; 4] {
    [
        aw * bw - ax * bx - ay * by - az * bz,
        aw * bx + ax * bw + ay * bz - az * by,
        aw * by - ax * bz + ay * bw + az * bx,
        aw * bz + ax * by - ay * bx + az * bw,
    ]
}

pub(in crate::math) fn matrix([w, x, y, z]: [f64; 4]) -> [[f64; 3]; 3] {
    [
        [1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - w * z), 2.0 * (x * z + w * y)],
        [2.0 * (x * y + w * z), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - w * x)],
        [2.0 * (x * z - w * y), 2.0 * (y * z + w * x), 1.0 - 2.0 * (x * x + y * y)],
    ]
}

/// `b` or `−b`, whichever is nearer to `a`; `b` in a tie.
pub(in crate::math) fn nearer(a: Quaternion, b: Quaternion) -> Quaternion {
    let dot: i128 = a.bits.iter().zip(b.bits).map(|(&a, b)| i128::from(a) * i128::from(b)).sum();
    if dot < 0 { Quaternion { bits: b.bits.map(|c| -c) } } else { b }
}

/// Slerp the textbook's way, with the angle from the chord, which is exact for near pairs too.
pub(in crate::math) fn slerp(a: [f64; 4], b: [f64; 4], t: f64) -> [f64; 4] {
    let length = |sign: f64| (0..4).map(|i| (a[i] + sign * b[i]).powi(2)).sum::<f64>().sqrt();
    let angle = 2.0 * length(-1.0).atan2(length(1.0));
    let weight = |t: f64| if angle < 1e-150 { t } else { (t * angle).sin() / angle.sin() };
    core::array::from_fn(|i| weight(1.0 - t) * a[i] + weight(t) * b[i])
}

/// The largest difference of two components, in 2⁻³⁰; of `q` and `−q` the nearer counts.
fn error(ours: Quaternion, exact: [f64; 4]) -> f64 {
    let error = |sign: f64| {
        ours.bits.iter().zip(exact).map(|(&o, e)| (f64::from(o) - sign * e / BIT).abs()).fold(0.0, f64::max)
    };
    error(1.0).min(error(-1.0))
}

/// How far the length is from 1, in 2⁻³⁰.
fn stretch(q: Quaternion) -> f64 {
    (q.bits.iter().map(|&c| (f64::from(c) * BIT).powi(2)).sum::<f64>().sqrt() - 1.0).abs() / BIT
}

pub(in crate::math) fn vec3([x, y, z]: [i32; 3]) -> Vec3 {
    Vec3::new(I16F16::from_bits(x), I16F16::from_bits(y), I16F16::from_bits(z))
}

fn about(axis: [f64; 3], turn: Turn) -> [f64; 4] {
    let half = f64::from(turn.raw()) / 65536.0 * core::f64::consts::PI;
    let [x, y, z] = unit(axis);
    [half.cos(), x * half.sin(), y * half.sin(), z * half.sin()]
}

/// Spread over all rotations, and every so often one with zeros in it.
pub(in crate::math) fn rotations() -> impl Strategy<Value = Quaternion> {
    let number = || prop_oneof![8 => any::<i32>(), 1 => -3..4i32, 1 => Just(0)];
    [number(), number(), number(), number()].prop_map(|[w, x, y, z]| {
        Quaternion::new(I2F30::from_bits(w), I2F30::from_bits(x), I2F30::from_bits(y), I2F30::from_bits(z))
    })
}

/// Two rotations: any, nearly equal, nearly half a turn apart, equal, and all these with −b for b.
fn pair() -> impl Strategy<Value = (Quaternion, Quaternion)> {
    (rotations(), rotations(), 0u32..31, 0u8..4, any::<bool>()).prop_map(|(a, b, shift, kind, negative)| {
        let [x, y, z] = [1, 2, 3].map(|i| i64::from(b.bits[i] >> shift));
        let step = |w| Quaternion { bits: normalized([w, x, y, z]).unwrap() };
        let b = match kind {
            0 => b,
            1 => a.then(step(i64::from(ONE))),
            2 if [x, y, z] != [0; 3] => a.then(step(0)).then(step(i64::from(ONE))),
            _ => a,
        };
        (a, if negative { Quaternion { bits: b.bits.map(|c| -c) } } else { b })
    })
}

/// Runs `measure` on 20,000 samples and reports the largest of each of its results against its bound.
pub(in crate::math) fn measured<S: Strategy, const N: usize>(
    what: &str,
    samples: S,
    bounds: [f64; N],
    measure: impl Fn(S::Value) -> [f64; N],
) where
    S::Value: Clone,
{
    let config = ProptestConfig { cases: 20_000, failure_persistence: None, ..ProptestConfig::default() };
    let worst = core::cell::Cell::new([0f64; N]);
    let result = proptest::test_runner::TestRunner::new(config).run(&samples, |sample| {
        let errors = measure(sample);
        worst.set(core::array::from_fn(|i| worst.get()[i].max(errors[i])));
        prop_assert!((0..N).all(|i| errors[i] <= bounds[i]), "{:.3?}, bounds {:?}", errors, bounds);
        Ok(())
    });
    println!("{what}: 20,000 cases, errors within {:.3?}, bounds {bounds:?}", worst.get());
    result.unwrap_or_else(|error| panic!("{error}"));
}

#[test]
fn axis_and_turn_are_exact_to_30_bits_in_20_000_cases() {
    let samples = (any::<[i32; 3]>(), 0u32..32, any::<u16>());
    measured("quaternion from axis and turn, 2^-30", samples, [3.0, 1.001], |(axis, shift, raw)| {
        let axis = axis.map(|c| c >> shift);
        let turn = Turn::from_raw(raw);
        let q = Quaternion::from_axis_turn(vec3(axis), turn);
        if axis == [0; 3] {
            assert_eq!(q, Quaternion::IDENTITY);
            return [0.0; 2];
        }
        [error(q, about(axis.map(f64::from), turn)), stretch(q)]
    });
}

#[test]
fn euler_turns_are_exact_to_30_bits_in_20_000_cases() {
    measured("quaternion from Euler turns, 2^-30", any::<[u16; 3]>(), [4.0, 1.001], |raw| {
        let [yaw, pitch, roll] = raw.map(Turn::from_raw);
        let exact = product(
            about([0.0, 1.0, 0.0], yaw),
            product(about([1.0, 0.0, 0.0], pitch), about([0.0, 0.0, 1.0], roll)),
        );
        let q = Quaternion::from_euler(yaw, pitch, roll);
        [error(q, exact), stretch(q)]
    });
}

#[test]
fn composition_is_the_f64_product_in_20_000_cases() {
    measured("quaternion composition, 2^-30", (rotations(), rotations()), [1.5, 1.001], |(a, b)| {
        assert_eq!(a * b, b.then(a));
        let q = a * b;
        assert!(error(q * b.inverse(), exact(a)) <= 3.0);
        [error(q, product(exact(a), exact(b))), stretch(q)]
    });
}

#[test]
fn a_rotation_composed_1_000_000_times_is_still_one() {
    let step = Quaternion::from_euler(Turn::from_raw(77), Turn::from_raw(991), Turn::from_raw(13));
    let (mut q, mut worst) = (Quaternion::IDENTITY, 0f64);
    for _ in 0..1_000_000 {
        q = q.then(step);
        worst = worst.max(stretch(q));
    }
    println!("quaternion composed 1,000,000 times: length within {worst:.3} · 2^-30 of 1");
    assert!(worst <= 1.001);
}

#[test]
fn matrix_is_within_0_501_bits_and_back_within_0_58_in_20_000_cases() {
    let bounds = [0.501, 4.0, 0.58, 1.001];
    measured("quaternion to matrix in 2^-14, in 2^-30; and back in 2^-14", rotations(), bounds, |q| {
        let (rows, fine, exact_rows) = (q.rotation(), q.matrix(), matrix(exact(q)));
        let mut worst = [0f64; 2];
        for i in 0..9 {
            let (r, c) = (i / 3, i % 3);
            worst[0] = worst[0].max((f64::from(rows[r][c].to_bits()) - exact_rows[r][c] * 16384.0).abs());
            worst[1] = worst[1].max((f64::from(fine[r][c]) - exact_rows[r][c] / BIT).abs());
        }
        let back = Quaternion::from_rotation(&rows);
        [worst[0], worst[1], error(back, exact(q)) / 65536.0, stretch(back)]
    });
}

#[test]
fn quarter_turns_are_exact_matrices() {
    let quarters = [0, 1, 2, 3].map(|quarters| Turn::from_degrees(90 * quarters));
    for (yaw, pitch, roll) in
        quarters.iter().flat_map(|&y| quarters.iter().flat_map(move |&p| quarters.map(|r| (y, p, r))))
    {
        let ours = Quaternion::from_euler(yaw, pitch, roll).rotation();
        let turned = crate::Pose::IDENTITY.rotated_z(roll).rotated_x(pitch).rotated_y(yaw);
        assert_eq!(ours, turned.rotation);
    }
}

#[test]
fn slerp_is_the_f64_one_in_20_000_cases() {
    measured("slerp, 2^-30", (pair(), 0..=65536i32), [5.0, 1.001], |((a, b), t)| {
        let q = a.slerp(b, I16F16::from_bits(t));
        [error(q, slerp(exact(a), exact(nearer(a, b)), f64::from(t) / 65536.0)), stretch(q)]
    });
}

#[test]
fn slerp_is_exact_at_its_ends_in_20_000_cases() {
    measured("slerp, ends", (pair(), any::<i32>()), [0.0], |((a, b), t)| {
        let t = I16F16::from_bits(t);
        let q = a.slerp(b, t);
        if t <= 0 {
            assert_eq!(q, a);
        } else if t >= 1 {
            assert!(q == b || q.bits == b.bits.map(|c| -c));
        }
        [0.0]
    });
}

#[test]
fn slerp_advances_at_every_one_of_65536_steps() {
    let axis = Vec3::lit(0.3, -0.8, 0.5);
    let start =
        Quaternion::from_euler(Turn::from_degrees(20), Turn::from_degrees(-70), Turn::from_degrees(200));
    for (raw, back) in
        [(1, 0.5), (16, 0.0), (256, 0.0), (5461, 0.0), (16384, 0.0), (32767, 0.0), (32768, 0.0), (40000, 0.0)]
    {
        let end = start.then(Quaternion::from_axis_turn(axis, Turn::from_raw(raw)));
        let (from, to) = (exact(start), exact(nearer(start, end)));
        // Along the arc: the angle to the start, by the chord.
        let angle = |q: Quaternion| {
            let chord = |sign: f64| {
                exact(q).iter().zip(from).map(|(a, b)| (a + sign * b).powi(2)).sum::<f64>().sqrt()
            };
            2.0 * chord(-1.0).atan2(chord(1.0)) / BIT
        };
        let (mut last, mut retreat, mut off) = (0.0, 0f64, 0f64);
        for t in 0..=65536 {
            let q = start.slerp(end, I16F16::from_bits(t));
            let here = angle(q);
            retreat = retreat.max(last - here);
            off = off.max(error(q, slerp(from, to, f64::from(t) / 65536.0)));
            last = here;
        }
        println!(
            "slerp over {raw}/65536 turn, all 65537 t: error {off:.3} · 2^-30, largest step back {retreat:.3}"
        );
        assert!(off <= 5.0 && retreat <= back);
    }
}

#[test]
fn nothing_panics_on_20_000_bit_patterns() {
    measured(
        "quaternions from any bits",
        any::<([i32; 4], [[i16; 3]; 3], [i32; 3], [u16; 3], i32)>(),
        [1.001],
        |(q, m, axis, turns, t)| {
            let [w, x, y, z] = q.map(I2F30::from_bits);
            let q = Quaternion::new(w, x, y, z);
            let m = Quaternion::from_rotation(&m.map(|row| row.map(I2F14::from_bits)));
            let [yaw, pitch, roll] = turns.map(Turn::from_raw);
            let axis = vec3(axis);
            let e = Quaternion::from_euler(yaw, pitch, roll) * Quaternion::from_axis_turn(axis, yaw);
            let s = q.slerp(m, I16F16::from_bits(t)).slerp(e, I16F16::from_bits(t & 0xffff));
            let _ = s.rotation();
            [stretch(q).max(stretch(m)).max(stretch(e)).max(stretch(s))]
        },
    );
    for bits in [i16::MIN, -1, 0, 1, i16::MAX] {
        let _ = Quaternion::from_rotation(&[[I2F14::from_bits(bits); 3]; 3]);
    }
    assert_eq!(Quaternion::new(I2F30::ZERO, I2F30::ZERO, I2F30::ZERO, I2F30::ZERO), Quaternion::IDENTITY);
}
