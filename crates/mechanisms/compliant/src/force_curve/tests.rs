use super::brute::Brute;
use super::*;
use forcewright_base::maths;

/// F = f(x) with slopes from `g`, at `n` stations over [0, end].
fn curve(f: impl Fn(f64) -> f64, g: impl Fn(f64) -> f64, end: f64, n: usize) -> ForceCurve {
    let x: Vec<f64> = (0..=n).map(|i| end * i as f64 / n as f64).collect();
    ForceCurve::new(x.clone(), x.iter().map(|x| f(*x)).collect(), x.iter().map(|x| g(*x)).collect())
}

/// A cubic is its own interpolant: local maximum 2 at 1, local minimum 1.8 at 2 (x in any unit).
fn cubic() -> ForceCurve {
    // F = a(2x³ − 9x² + 12x) + c with F(1) − F(2) = a.
    let (a, c) = (0.2, 2.0 - 0.2 * 5.0);
    curve(|x| a * (2.0 * x * x * x - 9.0 * x * x + 12.0 * x) + c, |x| a * (6.0 * x * x - 18.0 * x + 12.0), 3.0, 30)
}

#[test]
fn extrema_of_a_cubic() {
    let turns = cubic().turns();
    let [max, min] = turns[..] else { panic!("{turns:?}") };
    assert!(max.is_max && (max.at - 1.0).abs() < 1e-12 && (cubic().force(max.at) - 2.0).abs() < 1e-14);
    assert!(!min.is_max && (min.at - 2.0).abs() < 1e-12 && (cubic().force(min.at) - 1.8).abs() < 1e-14);
}

#[test]
fn interpolation_error_is_of_fourth_order_and_estimated() {
    let truth = |n: usize| {
        let c = curve(maths::sin, maths::cos, 1.5, n);
        let real = (0..1000).map(|i| f64::from(i) * 0.0015).fold(0.0_f64, |m, x| m.max((c.force(x) - maths::sin(x)).abs()));
        (real, c.error_n())
    };
    let ((coarse, guess), (fine, _)) = (truth(10), truth(20));
    assert!((coarse / fine - 16.0).abs() < 1.0, "order: {}", coarse / fine);
    assert!(guess > 0.3 * coarse && guess < 3.0 * coarse, "{guess} estimates {coarse}");
}

#[test]
fn longest_interval_within_levels() {
    // F = sin x on [0, π]: above ½ from π/6 to 5π/6.
    let c = curve(maths::sin, maths::cos, std::f64::consts::PI, 400);
    let i = c.longest_within(0.5, 2.0).unwrap();
    assert!((i.start - std::f64::consts::FRAC_PI_6).abs() < 1e-9);
    assert!((i.length() - 2.0 / 3.0 * std::f64::consts::PI).abs() < 1e-9);
    assert_eq!(c.longest_within(1.5, 2.0), None);
}

#[test]
fn flat_interval_of_a_sine_starts_where_its_peak_allows() {
    let c = curve(maths::sin, maths::cos, std::f64::consts::PI, 400);
    // Peak 1, so the interval is F ≥ 1/r, symmetric about the peak.
    let r = 1.05 / 0.95;
    let start = maths::asin(1.0 / r);
    let i = c.longest_flat(0.05).unwrap();
    assert!((i.start - start).abs() < 1e-8, "{} {start}", i.start);
    assert!((i.end - (std::f64::consts::PI - start)).abs() < 1e-8);
}

#[test]
fn flat_interval_of_a_monotone_curve_is_where_it_is_least_steep() {
    // F = x on [1, 2] shifted: ratio r from the end backwards is longest at the end.
    let c = curve(|x| 1.0 + x, |_| 1.0, 1.0, 50);
    let i = c.longest_flat(0.1).unwrap();
    assert!((i.end - 1.0).abs() < 1e-12 && (i.start - (2.0 * 0.9 / 1.1 - 1.0)).abs() < 1e-9);
}

#[test]
fn range_start_is_the_last_upward_crossing() {
    let c = cubic();
    // F(3) = 0.2·9 + 1 = 2.8; 0.95 of it is passed once, on the last rise.
    let x = c.range_start(0.95).unwrap();
    assert!((c.force(x) - 0.95 * 2.8).abs() < 1e-12 && x > 2.0);
}

#[test]
fn best_window_of_a_cubic_spans_its_flat() {
    let c = cubic();
    // By the point symmetry of a cubic the best window with a free level is not centred on the inflection alone, but its deviation
    // can be no smaller than that of the exact extent; compare with a brute-force scan.
    let (_, got) = c.best_window(1.5, None).unwrap();
    let scan = (0..=15_000)
        .map(|i| {
            let start = f64::from(i) * 1e-4;
            let (hi, lo) = c.extent(Interval { start, end: start + 1.5 });
            (hi - lo) / (hi + lo)
        })
        .fold(f64::INFINITY, f64::min);
    assert!(got <= scan + 1e-12 && got > scan - 1e-4);
    assert!(c.best_window(4.0, None).is_none());
}

/// A curve of a few waves over [0, 1] around a level, at unevenly spread stations; some fall below zero, some are plainly monotone.
fn random(seed: u64, n: usize) -> ForceCurve {
    let mut state = seed.wrapping_mul(0x9E37_79B9_7F4A_7C15);
    let mut around = |range: f64| {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        range * ((state >> 11) as f64 / (1_u64 << 52) as f64 - 1.0)
    };
    let (level, rise) = (4.0 + around(5.0), around(3.0));
    let waves: Vec<[f64; 3]> = (1..5).map(|i| [around(1.5) / f64::from(i), 2.0 * f64::from(i) + around(1.0), around(3.0)]).collect();
    let mut x: Vec<f64> = (0..=n).map(|i| (i as f64 + if i % n == 0 { 0.0 } else { around(0.3) }) / n as f64).collect();
    x[n] = 1.0;
    let f = |x: f64| level + rise * x + waves.iter().map(|[a, w, p]| a * maths::sin(w * x + p)).sum::<f64>();
    let k = |x: f64| rise + waves.iter().map(|[a, w, p]| a * w * maths::cos(w * x + p)).sum::<f64>();
    ForceCurve::new(x.clone(), x.iter().map(|x| f(*x)).collect(), x.iter().map(|x| k(*x)).collect())
}

fn brute(c: &ForceCurve) -> Brute {
    Brute { x: c.x.clone(), f: c.f.clone(), k: c.k.clone() }
}

fn same(a: f64, b: f64, what: &str) {
    assert!((a - b).abs() <= 1e-11 * (1.0 + a.abs()), "{what}: {a} {b}");
}

/// Whatever has one answer only is the answer of the slow way.
#[test]
fn values_turns_and_crossings_are_those_of_the_slow_way() {
    let (mut turns, mut crossings) = (0, 0);
    for seed in 0..400 {
        let c = random(seed, 40);
        let slow = brute(&c);
        for i in 0..=50 {
            let x = f64::from(i) / 50.0;
            same(c.force(x), slow.force(x), "force");
            same(c.slope(x), slow.slope(x), "slope");
        }
        same(c.least_slope(), slow.least_slope(), "least slope");
        same(c.error_n(), slow.error_n(), "error");
        let pairs: Vec<(Turn, Turn)> = c.turns().into_iter().zip(slow.turns()).collect();
        assert_eq!((c.turns().len(), pairs.len()), (slow.turns().len(), slow.turns().len()));
        for (a, b) in pairs {
            same(a.at, b.at, "turn");
            assert_eq!(a.is_max, b.is_max);
            turns += 1;
        }
        for level in [c.force(0.3), c.f[7], 4.0, 0.0] {
            let (a, b) = (c.crossings(level), slow.crossings(level));
            assert_eq!(a.len(), b.len(), "{seed} {level}: {a:?} {b:?}");
            crossings += a.len();
            // Next to an extremum the place of a level is known to the root of the rounding.
            a.iter().zip(b).for_each(|(a, b)| assert!((a - b).abs() * c.slope(*a).abs().max(1e-7) < 1e-13, "{seed}: {a} {b}"));
        }
        match (c.range_start(0.95), slow.range_start(0.95)) {
            (Some(a), Some(b)) => same(a, b, "range"),
            (a, b) => assert_eq!(a, b),
        }
    }
    assert!(turns > 400 && crossings > 1000, "{turns} {crossings}");
}

/// An interval has the length of the one that the slow way finds; where that looked on the wrong side of a kink, it is longer, and then
/// it keeps to the band all the same. The slow way uses up the slack, which moves an end on a gentle slope.
#[test]
fn intervals_are_at_least_as_long_as_those_of_the_slow_way() {
    let (mut equal, mut longer) = (0, 0);
    for seed in 0..400 {
        let c = random(seed, 40);
        let slow = brute(&c);
        let middle = c.force(0.5);
        for band in [0.01, 0.05, 0.3] {
            let (lo, hi) = (middle - band * middle.abs(), middle + band * middle.abs());
            let (a, b) = (c.longest_within(lo, hi), slow.longest_within(lo, hi));
            let length = |i: Option<Interval>| i.map_or(0.0, |i| i.length());
            same(length(a), length(b), "within");
            let (a, b) = (c.longest_flat(band), slow.longest_flat(band));
            assert_eq!(a.is_some(), b.is_some(), "{seed} {band}: {a:?} {b:?}");
            let (Some(a), Some(b)) = (a, b) else { continue };
            assert!(a.length() > b.length() - 1e-9, "{seed} {band}: {a:?} {b:?}");
            let (high, low) = c.extent(a);
            assert!(low > 0.0 && high <= low * (1.0 + band) / (1.0 - band) * (1.0 + 1e-11), "{seed} {band}: {a:?}");
            if a.length() < b.length() + 1e-9 { equal += 1 } else { longer += 1 }
        }
    }
    println!("{equal} equal, {longer} longer");
    assert!(equal > 900 && longer * 20 < equal, "{equal} {longer}");
}

/// The same for windows; the deviation is that of the window.
#[test]
fn windows_deviate_at_most_as_the_slow_way_finds() {
    let (mut equal, mut less) = (0, 0);
    for seed in 0..400 {
        let c = random(seed, 40);
        let slow = brute(&c);
        for length in [0.013, 0.3, 0.8, 1.0] {
            for nominal in [Some(c.force(0.4)), None] {
                let ((window, a), (_, b)) = (c.best_window(length, nominal).unwrap(), slow.best_window(length, nominal).unwrap());
                assert!(a.is_infinite() && b.is_infinite() || a < b + 1e-9 * (1.0 + b.abs()), "{seed} {length} {nominal:?}: {a} {b}");
                let (hi, lo) = c.extent(window);
                let own = match nominal {
                    Some(level) => (hi / level - 1.0).abs().max((lo / level - 1.0).abs()),
                    None if hi + lo > 0.0 => (hi - lo) / (hi + lo),
                    None => f64::INFINITY,
                };
                assert!(own.to_bits() == a.to_bits() || (own - a).abs() < 1e-11 * (1.0 + a.abs()), "{seed}: {own} {a}");
                if a > b - 1e-8 * (1.0 + b.abs()) { equal += 1 } else { less += 1 }
            }
        }
    }
    println!("{equal} equal, {less} less");
    assert!(equal > 2500 && less * 5 < equal, "{equal} {less}");
}

/// Room that is used again changes nothing, and nothing makes it panic.
#[test]
fn a_curve_in_the_room_of_another_is_its_own() {
    let mut room = random(1, 57);
    let c = random(2, 40);
    room.set(&c.x, &c.f, &c.k);
    assert_eq!(
        (room.longest_flat(0.1), room.best_window(0.3, None), room.turns()),
        (c.longest_flat(0.1), c.best_window(0.3, None), c.turns())
    );
    for bad in [f64::NAN, f64::INFINITY, 0.0, -1.0] {
        for at in [0, 20, 40] {
            let (mut f, mut k) = (c.f.clone(), c.k.clone());
            (f[at], k[at]) = (bad, bad);
            room.set(&c.x, &f, &k);
            let _ = (room.longest_flat(0.1), room.best_window(0.3, None), room.best_window(0.3, Some(2.0)), room.turns());
            let _ = (room.longest_within(1.0, 2.0), room.range_start(0.95), room.least_slope());
        }
    }
}
