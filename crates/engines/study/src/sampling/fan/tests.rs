#![allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "counts and places in small samples")]

use forcewright_base::maths::{cos, sin};

use super::*;
use crate::sampling::{Sobol, normal};

/// Scores of normal curves, evenly spread, in the order of the sequence.
fn scores(n: u64) -> Vec<f64> {
    let mut u = vec![0.0; n as usize];
    Sobol::scrambled(1, 11).unwrap().fill(0, &mut u);
    u.into_iter().map(normal::quantile).collect()
}

/// Whole numbers 0 … n − 1 in a shuffled order: mean (n−1)/2, variance n(n+1)/12, quantile (n−1) p.
#[test]
fn statistics_of_whole_numbers_in_closed_form() {
    for n in [2_u64, 101, 4096, 4097, 100_003] {
        let mut fan = Fan::new(1);
        (0..n).for_each(|i| fan.add(&[(i * 7919 % n) as f64]));
        let (found, size) = (fan.station(0), n as f64);
        assert_eq!((found.count, found.missing, found.min, found.max), (n, 0, 0.0, size - 1.0));
        assert!((found.mean - 0.5 * (size - 1.0)).abs() < 1e-10 * size);
        assert!((found.sd / (size * (size + 1.0) / 12.0).sqrt() - 1.0).abs() < 1e-12);
        let error = fan.quantile_error(0);
        assert!(if n <= 4096 { error == 0.0 } else { error <= (size - 1.0) / 2047.0 }, "{n}: {error}");
        for p in [0.0, 0.05, 0.25, 0.5, 0.75, 0.95, 1.0] {
            assert!((fan.quantile(0, p) - p * (size - 1.0)).abs() <= error + 1e-9, "{n} {p}");
        }
    }
}

/// `a sin t + b cos t` with independent standard normal `a`, `b` is standard normal at every `t`.
#[test]
fn a_fan_of_normal_curves() {
    let stations = 5;
    let mut fan = Fan::new(stations);
    let mut point = [0.0; 2];
    let sobol = Sobol::scrambled(2, 4).unwrap();
    for i in 0..16_384 {
        sobol.point(i, &mut point);
        let [a, b] = point.map(normal::quantile);
        let curve: Vec<f64> = (0..stations).map(|s| a * sin(s as f64) + b * cos(s as f64)).collect();
        fan.add(&curve);
    }
    for station in 0..stations {
        let found = fan.station(station);
        assert!(found.mean.abs() < 1e-3 && (found.sd - 1.0).abs() < 1e-3, "{found:?}");
        assert!(fan.quantile_error(station) < 0.005);
        for p in [0.05, 0.25, 0.5, 0.75, 0.95] {
            assert!((fan.quantile(station, p) - normal::quantile(p)).abs() < 0.012, "{station} {p}");
        }
    }
}

/// Curves of any length, with values that are none, station by station or one after the other: the same bits, before and after the values
/// themselves are given up.
#[test]
fn many_curves_at_once_are_as_one_after_the_other() {
    let (stations, scores) = (21, scores(30 * 5000));
    let curve = |i: usize| {
        let mut curve = scores[30 * i..30 * i + i % 30].to_vec();
        curve.iter_mut().skip(i % 7).step_by(11).for_each(|v| *v = f64::NAN);
        curve
    };
    let curves: Vec<Vec<f64>> = (0..5000).map(curve).collect();
    let (mut one, mut all) = (Fan::new(stations), Fan::new(stations));
    for curve in &curves {
        one.add(curve);
    }
    for part in curves.chunks(999) {
        all.add_all(&part.iter().map(Vec::as_slice));
    }
    assert_eq!(format!("{one:?}"), format!("{all:?}"));
    assert!(all.curves() == 5000 && all.quantile_error(0) > 0.0 && all.quantile_error(20) == 0.0 && all.station(20).missing > 0);
}

/// The bins depend on the values only: any order gives the same bits. And they keep the promised bound, far from zero, too.
#[test]
fn quantiles_do_not_depend_on_the_order() {
    for (offset, scale) in [(0.0, 1.0), (1e6, 1e-3), (-5.0, 1e-200), (0.0, 1e140), (1.0, 1e-14), (-8.0, 1e-13)] {
        let values: Vec<f64> = scores(9000).into_iter().map(|z| offset + scale * z).collect();
        let mut sorted = values.clone();
        sorted.sort_by(f64::total_cmp);
        let fan_of = |values: &mut dyn Iterator<Item = f64>| {
            let mut fan = Fan::new(1);
            values.for_each(|v| fan.add(&[v]));
            fan
        };
        let forward = fan_of(&mut values.iter().copied());
        let range = sorted[8999] - sorted[0];
        let error = forward.quantile_error(0);
        assert!(error <= range / 2047.0 + 4.0 * f64::EPSILON * offset.abs(), "{error:e} {range:e}");
        for other in [fan_of(&mut sorted.iter().copied()), fan_of(&mut sorted.iter().rev().copied())] {
            assert_eq!(error.to_bits(), other.quantile_error(0).to_bits());
            for k in 0..=40 {
                let p = f64::from(k) / 40.0;
                let found = forward.quantile(0, p);
                assert_eq!(found.to_bits(), other.quantile(0, p).to_bits(), "{p}");
                let rank = 8999.0 * p;
                let (low, part) = (rank.floor() as usize, rank - rank.floor());
                let exact = sorted[low] + part * (sorted[(low + 1).min(8999)] - sorted[low]);
                assert!((found - exact).abs() <= error, "{p}: {found} {exact}");
            }
        }
    }
}

#[test]
fn an_outlier_after_many_equal_values_is_taken_in() {
    let mut fan = Fan::new(2);
    (0..5000).for_each(|_| fan.add(&[3.25, 0.0]));
    assert!((fan.quantile(0, 0.3) - 3.25).abs() < 1e-14 && fan.quantile(1, 0.9).abs() < 1e-140);
    assert!(fan.station(0).sd == 0.0);
    fan.add(&[-1e149, 1e-300]);
    assert!((fan.quantile(0, 0.0) + 1e149).abs() <= fan.quantile_error(0));
    assert!(fan.quantile_error(0) <= 1e149 / 2047.0);
    assert_eq!(fan.station(0).count, 5001);
}

#[test]
fn missing_values_are_counted_and_left_out() {
    let mut fan = Fan::new(3);
    assert!(fan.quantile(0, 0.5).is_nan() && fan.station(0).mean.is_nan());
    fan.add(&[1.0, f64::NAN]);
    fan.add(&[2.0, f64::INFINITY, 5.0, 9.0]);
    fan.add(&[4.0, -1e200, 7.0]);
    let [a, b, c] = [0, 1, 2].map(|s| fan.station(s));
    assert_eq!((a.count, a.missing, b.count, b.missing, c.count, c.missing), (3, 0, 0, 3, 2, 1));
    assert!((c.mean - 6.0).abs() < 1e-15 && (c.sd - 2.0_f64.sqrt()).abs() < 1e-15 && b.sd.is_nan());
    assert_eq!((fan.quantile(0, 0.75), fan.stations(), fan.curves()), (3.0, 3, 3));
    assert!([-0.1, 1.1, f64::NAN].iter().all(|p| fan.quantile(0, *p).is_nan()) && fan.quantile(3, 0.5).is_nan());
    assert_eq!(fan.station(3).missing, 3);
    let mut one = Fan::new(1);
    one.add(&[2.0]);
    assert!(one.station(0).sd.is_nan() && (one.quantile(0, 0.7) - 2.0).abs() < 1e-15);
}
