//! Random networks around Table 3: every path ends with a result or a named reason, and agrees with an independent formulation.

mod common;

use common::{POM, SplitMix, near, random_network};
use forcewright_base::{dense::Lu, maths};
use forcewright_beam::{Network, Path, Settings, Shape, Status, Theory, trace};

fn finite(path: &Path) -> bool {
    path.points.iter().all(|p| {
        let stress = p.peak_stress().is_some_and(|s| s.1.stress_pa.is_finite());
        p.force.is_finite() && p.stiffness.is_finite() && p.energy_j.is_finite() && stress
    })
}

#[test]
fn every_path_ends_with_a_result_or_a_reason() {
    let mut random = SplitMix(2010);
    let stations: Vec<f64> = (1..=17).map(|i| f64::from(i) * 1e-3).collect();
    let (mut complete, mut folds) = (0, 0);
    for index in 0..200 {
        let network = random_network(&mut random, 3.0, 1.5).expect("mild shapes span their chords");
        let theory = if index % 2 == 0 { Theory::Inextensible } else { Theory::Reissner };
        let path = trace(&network, &stations, &Settings { theory, ..Settings::default() }, &mut |_| true).unwrap();
        assert!(finite(&path), "{index}");
        match path.status {
            Status::Complete => {
                complete += 1;
                assert_eq!(path.points.len(), stations.len());
                assert!(path.error_estimate.unwrap() <= 1e-8);
            }
            Status::NoEquilibriumBeyond { control } => {
                folds += 1;
                assert!(path.points.iter().all(|p| p.control <= control) && control < 17e-3);
            }
            other => panic!("design {index}: {other}"),
        }
    }
    println!("{complete} complete, {folds} folds");
    assert!(complete >= 190, "{complete} complete, {folds} folds");
}

#[test]
fn wild_networks_end_too() {
    let mut random = SplitMix(7);
    let stations: Vec<f64> = (1..=10).map(|i| f64::from(i) * 3e-3).collect();
    let mut complete = 0;
    for _ in 0..40 {
        let Ok(network) = random_network(&mut random, 8.0, 6.0) else { continue };
        let path = trace(&network, &stations, &Settings { iteration_limit: 5_000, ..Settings::default() }, &mut |_| true).unwrap();
        assert!(finite(&path));
        complete += u32::from(path.status.is_complete());
        assert!(!path.status.to_string().is_empty());
    }
    assert!(complete > 10, "{complete}");
}

#[test]
fn short_steps_find_the_same_branch() {
    let mut random = SplitMix(5);
    let every: Vec<f64> = (1..=272).map(|i| f64::from(i) * 0.5e-4).collect();
    let (mut mild, mut wild) = (0, 0);
    for index in 0..24 {
        let (nodes, bend) = if index % 2 == 0 { (3.0, 1.5) } else { (6.0, 4.0) };
        let Ok(network) = random_network(&mut random, nodes, bend) else { continue };
        let settings = Settings { accuracy: 1e-5, ..Settings::default() };
        let few = trace(&network, &[13.6e-3], &settings, &mut |_| true).unwrap();
        let many = trace(&network, &every, &settings, &mut |_| true).unwrap();
        assert_eq!(std::mem::discriminant(&few.status), std::mem::discriminant(&many.status), "{} {}", few.status, many.status);
        if few.status.is_complete() {
            near(few.points[0].force, many.points[271].force, 1e-4, "force");
            *(if index % 2 == 0 { &mut mild } else { &mut wild }) += 1;
        }
    }
    assert!(mild == 12 && wild >= 6, "{mild} {wild}");
}

/// State of a beam in cm and N: angle, moment, x, y.
type State = [f64; 4];

/// Shooting along one beam: M' = L (H sin θ − V cos θ), EI (θ' − η') = M L, by the classical Runge–Kutta method and Richardson's
/// extrapolation. Forces in N, lengths in cm.
fn shoot(shape: &Shape, stiffness: f64, force: [f64; 2], start: State) -> State {
    let length = shape.length_m() * 100.0;
    let slope = |u: f64, y: State| {
        let (sin, cos) = maths::sin_cos(y[0]);
        let bend = shape.slope_at(u) + y[1] * length / stiffness;
        [bend, length * (force[0] * sin - force[1] * cos), length * cos, length * sin]
    };
    let after = |y: State, k: State, h: f64| [0, 1, 2, 3].map(|i| y[i] + h * k[i]);
    let integrate = |steps: u32| {
        let h = 1.0 / f64::from(steps);
        (0..steps).fold(start, |y, i| {
            let u = f64::from(i) * h;
            let a = slope(u, y);
            let b = slope(u + 0.5 * h, after(y, a, 0.5 * h));
            let c = slope(u + 0.5 * h, after(y, b, 0.5 * h));
            let d = slope(u + h, after(y, c, h));
            [0, 1, 2, 3].map(|i| y[i] + h / 6.0 * (a[i] + 2.0 * b[i] + 2.0 * c[i] + d[i]))
        })
    };
    let (coarse, fine) = (integrate(200), integrate(400));
    [0, 1, 2, 3].map(|i| fine[i] + (fine[i] - coarse[i]) / 15.0)
}

/// What does not fit when beams 1 and 2 leave their clamps with unknown (H, V, M): joint `n_3`, then the guide at `n_5`.
fn misfit(network: &Network, displacement_cm: f64, unknowns: &[f64; 6]) -> [f64; 6] {
    let stiffness = POM.bending_stiffness_n_m2() * 1e4;
    let shape = |i: usize| &network.beams[i].shape;
    let place = |i: usize| network.nodes[i].position_m.map(|x| x * 100.0);
    let from_clamp = |i: usize, force: [f64; 2], moment: f64| {
        let [x, y] = place(i);
        shoot(shape(i), stiffness, force, [shape(i).angle_at(0.0), moment, x, y])
    };
    let [h1, v1, m1, h2, v2, m2] = *unknowns;
    let one = from_clamp(0, [h1, v1], m1);
    let two = from_clamp(1, [h2, v2], m2);
    let rotation = one[0] - shape(0).angle_at(1.0);
    let force = [h1 + h2, v1 + v2];
    let three = shoot(shape(2), stiffness, force, [shape(2).angle_at(0.0) + rotation, one[1] + two[1], one[2], one[3]]);
    let turn = three[0] - shape(2).angle_at(1.0);
    let four = shoot(shape(3), stiffness, force, [shape(3).angle_at(0.0) + turn, three[1], three[2], three[3]]);
    let end = place(4);
    [
        two[0] - shape(1).angle_at(1.0) - rotation,
        one[2] - two[2],
        one[3] - two[3],
        four[0] - shape(3).angle_at(1.0),
        four[2] - end[0],
        four[3] - end[1] + displacement_cm,
    ]
}

/// Newton's method with central differences.
fn solve_by_shooting(network: &Network, displacement_cm: f64, mut x: [f64; 6]) -> [f64; 6] {
    let mut lu = Lu::new();
    for _ in 0..8 {
        let mut r = misfit(network, displacement_cm, &x);
        let mut jacobian = [0.0; 36];
        for column in 0..6 {
            let moved = |sign: f64| {
                let mut y = x;
                y[column] += sign * 1e-4;
                misfit(network, displacement_cm, &y)
            };
            let (above, below) = (moved(1.0), moved(-1.0));
            for row in 0..6 {
                jacobian[row * 6 + column] = (above[row] - below[row]) / 2e-4;
            }
        }
        lu.factor(6, 6, &jacobian).expect("regular");
        lu.solve(&mut r);
        for (x, r) in x.iter_mut().zip(r) {
            *x -= r;
        }
        if r.iter().all(|r| r.abs() < 1e-12) {
            return x;
        }
    }
    x
}

#[test]
fn forces_agree_with_shooting() {
    let mut random = SplitMix(44);
    let settings = Settings { theory: Theory::Inextensible, ..Settings::default() };
    let mut compared = 0;
    for _ in 0..20 {
        let network = random_network(&mut random, 3.0, 1.5).expect("mild shapes");
        let path = trace(&network, &[0.004, 0.0136], &settings, &mut |_| true).unwrap();
        for point in &path.points {
            let [one, two] = [&point.beams[0], &point.beams[1]];
            // A guess that is wrong by a thousandth: shooting must find its own way back.
            let guess =
                [one.force_n[0], one.force_n[1], 100.0 * one.start_moment_nm, two.force_n[0], two.force_n[1], 100.0 * two.start_moment_nm]
                    .map(|v| 1.001 * v);
            let x = solve_by_shooting(&network, 100.0 * point.control, guess);
            let size = (x[0] * x[0] + x[1] * x[1]).sqrt() + (x[3] * x[3] + x[4] * x[4]).sqrt();
            assert!((point.force + x[1] + x[4]).abs() < 1e-8 * size.max(point.force.abs()), "{} {}", point.force, x[1] + x[4]);
            near(one.force_n[0], x[0], 1e-7, "H of beam 1");
            near(100.0 * two.start_moment_nm, x[5], 1e-6, "moment at n2");
            compared += 1;
        }
    }
    assert!(compared >= 36, "{compared}");
}
