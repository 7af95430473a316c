//! Classical problems of large deflections and snapping. Where a published number has few digits, the digits are tested and an
//! independent computation, elliptic integrals or shooting along the beams, gives the rest. Each test names what was seen of its source.

mod common;

use std::f64::consts::{FRAC_PI_2, PI};

use common::{
    VERTICAL_GUIDE, cantilever, close, elastica, integral, near, network, node, rigid,
    shooting::{Shooting, Shot},
    solve,
};
use forcewright_base::{maths, roots};
use forcewright_beam::{Drive, Fold, Follow, Network, Path, Point, Rotation, Section, Settings, Shape, Status, Support, Theory, trace};

/// EI = 1 N·m².
const UNIT: Section = Section { young_pa: 12e6, thickness_m: 1e-2, depth_m: 1.0, poisson: None };
const DOWN: [f64; 2] = [0.0, -1.0];

fn followed(network: &Network, stations: &[f64], theory: Theory) -> Path {
    let settings = Settings { theory, accuracy: 1e-8, follow: Follow::ToEnd, ..Settings::default() };
    let path = trace(network, stations, &settings, &mut |_| true).expect("a sound network");
    assert_eq!(path.whole_status, Status::Complete, "{:?}", path.folds);
    path
}

/// What shooting finds next to a point of a path.
fn shot(network: &Network, theory: Theory, point: &Point) -> Shot {
    Shooting::new(network, theory, point).solve(point).expect("shooting finds it as well")
}

/// Every state of a followed path against shooting, except next to limit points, where the load does not determine the state.
fn agrees_with_shooting(network: &Network, path: &Path, theory: Theory) -> usize {
    let scale = path.whole.iter().fold(0.0_f64, |m, p| m.max(p.displacement.abs()));
    let clear = |p: &&Point| path.folds.iter().all(|f| (f.displacement - p.displacement).abs() > 0.02 * scale);
    let mut compared = 0;
    for point in path.whole.iter().filter(clear) {
        close(shot(network, theory, point).displacement, point.displacement, 1e-7 * scale, "displacement");
        compared += 1;
    }
    compared
}

/// A limit load by shooting: prescribing the displacement there, the force is that load, and it is stationary.
fn stationary_by_shooting(network: &Network, path: &Path, fold: &Fold, theory: Theory) {
    let Drive::Force { node, direction } = network.drive else { panic!("a dead load") };
    let prescribed = Network { drive: Drive::Displacement { node, direction }, ..network.clone() };
    let scale = path.folds.iter().fold(0.0_f64, |m, f| m.max(f.displacement));
    let force = |offset: f64| {
        let mut point = path.whole[fold.index].clone();
        point.control = fold.displacement + offset;
        shot(&prescribed, theory, &point).force
    };
    let (h, here) = (1e-4 * scale, force(0.0));
    near(here, fold.force, 1e-7, "limit load");
    let (slope, secant) = ((force(h) - force(-h)) / (2.0 * h), here / scale);
    close(slope, 0.0, 1e-3 * secant.abs(), "stiffness at a limit point");
}

/// Clamped column with a dead load that is turned by ε from its axis, p = P L²/(E I): (angle of the tip from the line of the load,
/// place of the tip along that line, across it), length 1.
///
/// The pendulum: EI θ″ = −P sin ψ with ψ = ε at the clamp and ψ′ = 0 at the tip, in elliptic integrals. A. E. H. Love, "A Treatise on
/// the Mathematical Theory of Elasticity", §262–263.
fn column(p: f64, turned: f64) -> (f64, f64, f64) {
    let start = |k: f64| maths::asin(maths::sin(0.5 * turned) / k);
    let root = |k: f64, a: f64| (1.0 - k * k * maths::sin(a) * maths::sin(a)).sqrt();
    let load = |tip: f64| {
        let k = maths::sin(0.5 * tip);
        integral(start(k), FRAC_PI_2, |a| 1.0 / root(k, a))
    };
    let tip = roots::root(|tip| load(tip) - p.sqrt(), turned * 1.000_001, 3.0, 1e-15).expect("a sign change");
    let k = maths::sin(0.5 * tip);
    let along = 2.0 * integral(start(k), FRAC_PI_2, |a| root(k, a)) / p.sqrt() - 1.0;
    (tip, along, 2.0 * k * maths::cos(start(k)) / p.sqrt())
}

#[test]
fn post_buckling_of_a_column() {
    // `timoshenko-gere1961`, section 2.7, prints three digits for a tip angle of 60°: 1.152 times
    // the critical load, 0.741 along, 0.593 across. They follow from the integrals, so they check that the oracle is coded right:
    // (2 K(sin 30°)/π)² = 1.1517, 2 E/K − 1 = 0.7410, 2 sin 30°/K = 0.5932 with K = 1.685750, E = 1.467462.
    let critical = 0.25 * PI * PI;
    let (tip, along, across) = column(1.152 * critical, 1e-9);
    assert!((tip * 180.0 / PI - 60.0).abs() < 0.2 && (along - 0.741).abs() < 2e-3 && (across - 0.593).abs() < 2e-3);

    for turned in [1e-2, 1e-4] {
        let (sin, cos) = maths::sin_cos(turned);
        let drive = Drive::Force { node: 1, direction: [-cos, sin] };
        let loads = [0.5, 0.95, 1.05, 1.5, 3.0].map(|f| f * critical);
        let path = solve(&cantilever(1.0, 0.0, UNIT, Support::Free, drive), &loads, &elastica());
        for (point, load) in path.points.iter().zip(loads) {
            let (tip, along, across) = column(load, turned);
            let n = point.nodes[1];
            let place = [1.0 + n.displacement_m[0], n.displacement_m[1]];
            // Next to the critical load the deflection is the imperfection magnified, and so is every error.
            close(n.rotation_rad + turned, tip, 1e-8, "angle");
            close(cos * place[0] - sin * place[1], along, 1e-8, "along");
            close(sin * place[0] + cos * place[1], across, 1e-8, "across");
            assert_eq!(point.instability, 0);
        }
        assert!(path.bifurcations.is_empty() && path.folds.is_empty());
    }
}

/// Complete elliptic integrals K and E of the modulus k.
fn complete(k: f64) -> (f64, f64) {
    let root = |a: f64| (1.0 - k * k * maths::sin(a) * maths::sin(a)).sqrt();
    (integral(0.0, FRAC_PI_2, |a| 1.0 / root(a)), integral(0.0, FRAC_PI_2, root))
}

#[test]
fn post_buckling_of_pinned_and_clamped_columns() {
    // A pinned column is two clamped and free ones of half its length, a clamped one four of a quarter (A. E. H. Love, §262–263): with the
    // largest slope α and k = sin α/2, P L²/EI = (2K)² or (4K)², the ends approach by 2 (1 − E/K) L and the middle moves by k/K L. A little
    // bent, they have no bifurcation; the error is in proportion to the bend, so that two bends give the perfect column.
    // Lengths and stiffness 1.
    let approach = |alpha: f64| {
        let (k_, e) = complete(maths::sin(0.5 * alpha));
        (2.0 * (1.0 - e / k_), k_, maths::sin(0.5 * alpha) / k_)
    };
    let slider = |rotation| Support::Slider { direction: [1.0, 0.0], rotation };
    // Bends with the symmetry of the first mode.
    let cases: [(Support, Support, f64, &[f64]); 2] =
        [(Support::Pinned, slider(Rotation::Free), 2.0, &[1.0]), (Support::Clamped, slider(Rotation::Fixed), 4.0, &[1.0, -3.0, 2.0])];
    for (start, end, waves, bend) in cases {
        let angles = [0.3, 0.8, 1.5, 2.2];
        let stations = angles.map(|a| approach(a).0);
        let bent = |size: f64| {
            let bends: Vec<f64> = bend.iter().map(|b| b * size).collect();
            let beam = rigid(0, 1, Shape::from_chord([1.0, 0.0], &bends).unwrap(), UNIT);
            let nodes = vec![node([0.0, 0.0], start), node([1.0, 0.0], end)];
            solve(&network(nodes, vec![beam], Drive::Displacement { node: 1, direction: [-1.0, 0.0] }), &stations, &elastica())
        };
        let [large, small] = [2e-3, 1e-3].map(bent);
        for (i, angle) in angles.iter().enumerate() {
            let (_, k_, middle) = approach(*angle);
            let want = waves * waves * k_ * k_;
            let (a, b) = (&large.points[i], &small.points[i]);
            near(2.0 * b.force - a.force, want, 1e-5, "load");
            assert!((b.force - want).abs() < 0.6 * (a.force - want).abs(), "in proportion to the bend");
            let across = |p: &Point| p.beams[0].shape_m(0.5)[1].abs();
            near(2.0 * across(b) - across(a), middle, 1e-5, "the middle");
            assert_eq!(b.instability, 0);
        }
    }
}

#[test]
fn williams_toggle() {
    // F. W. Williams, "An approach to the non-linear behaviour of the members of a rigid jointed plane framework with finite
    // deflections", Q. J. Mech. Appl. Math. 17 (1964): two bars 0.243 × 0.753 in, E = 1.03e7 psi (EA = 1.885e6 lb, EI = 9.27e3 lb in²),
    // half span 12.943 in, rise 0.386 in, clamped. Inches and pounds here. His results are a figure, and no printed limit load was found,
    // so the test rests on shooting alone: 33.870 and 31.282 lb.
    let bar = common::elastic(1.03e7, 0.243, 0.753, None);
    near(bar.axial_stiffness_n(), 1.885e6, 1e-3, "EA");
    near(bar.bending_stiffness_n_m2(), 9.27e3, 1e-3, "EI");
    let shape = Shape::from_chord([12.943, 0.386], &[]).unwrap();
    let nodes = vec![node([0.0, 0.0], Support::Clamped), node(shape.chord_m(), VERTICAL_GUIDE)];
    let toggle = network(nodes, vec![rigid(0, 1, shape, bar)], Drive::Force { node: 1, direction: DOWN });
    let path = followed(&toggle, &[5.0, 10.0, 15.0, 30.0], Theory::Reissner);
    assert!(agrees_with_shooting(&toggle, &path, Theory::Reissner) >= 8);
    // Both halves carry the load.
    let limits = path.folds.iter().map(|f| 2.0 * f.force).collect::<Vec<_>>();
    println!("limit loads of Williams' toggle, lb: {limits:?} at {:?}", path.folds.iter().map(|f| f.displacement).collect::<Vec<_>>());
    assert!(limits.len() == 2 && limits[0] > limits[1]);
    for fold in &path.folds {
        stationary_by_shooting(&toggle, &path, fold, Theory::Reissner);
    }
}

#[test]
fn lees_frame() {
    // S.-L. Lee, F. S. Manuel, E. C. Rossow, "Large deflections and stability of elastic frames", J. Eng. Mech. Div. ASCE 94 (1968): an
    // L of two equal members, hinged to the ground, loaded at a fifth of the beam. Members of length 1, EI = 1. Seen: C. Kadapa, Eng.
    // Struct. 234 (2021) 111755, whose points (load, u, −v, with L = 120 and EI/L² = 0.1, 20 linear elements that stretch and shear) peak
    // at (1.877, 25.7, 47.8) and (−0.981, 89.9, 57.3), and the curve that the tests of AeroBeams.jl read off a figure: 18.8 and −9.5 with EI/L² = 1. The limits of the inextensible frame, 18.559 and −9.421, rest on shooting.
    let piece = |start: usize, angle: f64, length: f64| rigid(start, start + 1, Shape::new(vec![angle], length).unwrap(), UNIT);
    let supports = [Support::Pinned, Support::Free, Support::Free, Support::Pinned];
    let places = [[0.0, 0.0], [0.0, 1.0], [0.2, 1.0], [1.0, 1.0]];
    let frame = network(
        places.iter().zip(supports).map(|(p, s)| node(*p, s)).collect(),
        vec![piece(0, FRAC_PI_2, 1.0), piece(1, 0.0, 0.2), piece(2, 0.0, 0.8)],
        Drive::Force { node: 2, direction: DOWN },
    );
    let path = followed(&frame, &[10.0, 30.0], Theory::Inextensible);
    println!("limit loads of Lee's frame, EI/L²: {:?}", path.folds.iter().map(|f| (f.control, f.displacement)).collect::<Vec<_>>());
    assert_eq!(path.folds.len(), 2);
    for (fold, (load, across, down)) in path.folds.iter().zip([(18.77, 0.2145, 0.398), (-9.81, 0.749, 0.4775)]) {
        near(fold.control, load, 0.05, "limit load of coarse elements");
        close(fold.displacement, down, 0.02, "down");
        close(path.whole[fold.index].nodes[2].displacement_m[0], across, 0.03, "across");
        stationary_by_shooting(&frame, &path, fold, Theory::Inextensible);
    }
    near(path.folds[0].control, 18.8, 0.02, "figure");
    near(path.folds[1].control, -9.5, 0.02, "figure");
    assert!(agrees_with_shooting(&frame, &path, Theory::Inextensible) > 20);
    let stable = path.whole.iter().filter(|p| p.branch != 1).all(|p| p.instability == 0);
    assert!(stable && path.jumps.len() == 1);
}

#[test]
fn deep_circular_arch() {
    // D. A. DaDeppo & R. Schmidt, "Instability of clamped-hinged circular arches subjected to a point load", J. Appl. Mech. 42 (1975): an
    // inextensible arch of 215° collapses under a crown load of 8.97 EI/R². Seen as printed by others: A. Ibrahimbegović, Comput. Methods
    // Appl. Mech. Eng. 122 (1995), circular arch (reference 897, with 20 curved elements 897.3; EI = 1e6, R = 100), and C. Kadapa, Eng.
    // Struct. 234 (2021) 111755: largest point (899.3, −61.3, −114.1).
    let half = 107.5 * PI / 180.0;
    let arc = |start: usize, from: f64| rigid(start, start + 1, Shape::new(vec![from, -half], half).unwrap(), UNIT);
    let beams = vec![arc(0, half), arc(1, 0.0)];
    let crown = beams[0].shape.chord_m();
    let foot = common::add(crown, beams[1].shape.chord_m(), 1.0);
    let nodes = vec![node([0.0, 0.0], Support::Clamped), node(crown, Support::Free), node(foot, Support::Pinned)];
    let arch = network(nodes, beams, Drive::Force { node: 1, direction: DOWN });
    let settings = Settings { accuracy: 1e-7, ..elastica() };
    let stopped = trace(&arch, &[4.0, 12.0], &settings, &mut |_| true).unwrap();
    let Status::NoEquilibriumBeyond { control } = stopped.status else { panic!("{}", stopped.status) };
    close(control, 8.97, 0.005, "collapse load");
    let path = trace(&arch, &[4.0, 12.0], &Settings { follow: Follow::ToEnd, ..settings }, &mut |_| true).unwrap();
    println!("{} {:?}", path.whole_status, path.folds.iter().map(|f| (f.control, f.displacement)).collect::<Vec<_>>());
    assert!(path.whole_status.is_complete());
    near(path.folds[0].control, control, 1e-7, "both ways to the limit");
    close(path.folds[0].displacement, 1.141, 0.01, "crown at collapse");
    close(path.whole[path.folds[0].index].nodes[1].displacement_m[0].abs(), 0.613, 0.01, "across");
    for fold in &path.folds {
        stationary_by_shooting(&arch, &path, fold, Theory::Inextensible);
    }
    assert!(agrees_with_shooting(&arch, &path, Theory::Inextensible) > 20);
}

#[test]
fn a_clamped_and_pinned_beam_turned_by_a_moment() {
    // A curved beam clamped at one end and turned by 1 rad at its pinned end. No source: against shooting.
    let shape = Shape::from_chord([1.0, 0.1], &[0.8]).unwrap();
    for (theory, thickness) in [(Theory::Reissner, 0.06), (Theory::Inextensible, 0.01)] {
        let nodes = vec![node([0.0, 0.0], Support::Clamped), node([1.0, 0.1], Support::Pinned)];
        let beams = vec![rigid(0, 1, shape.clone(), Section { thickness_m: thickness, ..UNIT })];
        let beam = network(nodes, beams, Drive::Rotation { node: 1 });
        let settings = Settings { follow: Follow::ToEnd, theory, ..Settings::default() };
        let path = trace(&beam, &[0.3, 0.6, 1.0], &settings, &mut |_| true).unwrap();
        assert_eq!(path.whole_status, Status::Complete);
        let last = path.whole[path.whole.len() - 1].force;
        for point in path.whole.iter().filter(|p| p.control > 0.05) {
            let found = shot(&beam, theory, point);
            close(found.force, point.force, 1e-8 * last, "moment");
            // Axial stress is a tenth of the stress that the accuracy is measured by.
            near(found.beam_force_n[0][0], point.beams[0].force_n[0], 1e-6, "axial force");
        }
    }
}

#[test]
fn a_straight_beam_turned_at_its_pinned_end() {
    // Clamped, with an axially free pinned end that is turned: M = 4 EI α/L at first (slope deflection), −V = 6 EI α/L². Then large turns,
    // against shooting; with nothing along the axis, the force is across it at all turns.
    let guide = Support::Slider { direction: [1.0, 0.0], rotation: Rotation::Free };
    let beam = cantilever(1.0, 0.0, UNIT, guide, Drive::Rotation { node: 1 });
    let path = solve(&beam, &[0.0, 1e-4, 0.5, 1.0, 1.8], &elastica());
    near(path.points[0].stiffness, 4.0, 1e-10, "4 EI/L");
    near(path.points[1].beams[0].force_n[1].abs(), 6.0 * 1e-4, 1e-6, "6 EI/L²");
    for point in &path.points[1..] {
        close(point.beams[0].force_n[0], 0.0, 1e-9 * point.force, "along");
        let found = shot(&beam, Theory::Inextensible, point);
        near(found.force, point.force, 1e-8, "moment");
        near(found.beam_force_n[0][1], point.beams[0].force_n[1], 1e-8, "across");
    }
}

#[test]
fn accuracy_asked_is_accuracy_got_and_pieces_do_not_matter() {
    // The column bent to a tip angle beyond a right angle, whole and in pieces: spectral convergence in the degree, and none needed in
    // the length of the pieces.
    let (load, turned) = (2.0 * 0.25 * PI * PI, 0.1);
    let (sin, cos) = maths::sin_cos(turned);
    let want = column(load, turned).0 - turned;
    let tip = |pieces: usize, accuracy: f64| {
        let length = 1.0 / pieces as f64;
        let place = |i: usize| [i as f64 * length, 0.0];
        let support = |i: usize| if i == 0 { Support::Clamped } else { Support::Free };
        let network = network(
            (0..=pieces).map(|i| node(place(i), support(i))).collect(),
            (0..pieces).map(|i| rigid(i, i + 1, Shape::new(vec![0.0], length).unwrap(), UNIT)).collect(),
            Drive::Force { node: pieces, direction: [-cos, sin] },
        );
        let settings = Settings { theory: Theory::Inextensible, accuracy, ..Settings::default() };
        let path = trace(&network, &[load], &settings, &mut |_| true).unwrap();
        assert!(path.status.is_complete());
        ((path.points[0].nodes[pieces].rotation_rad - want).abs(), path.degree)
    };
    let mut before = 0;
    for accuracy in [1e-3, 1e-5, 1e-8, 1e-11] {
        let (error, degree) = tip(1, accuracy);
        println!("accuracy {accuracy:.0e}: error {error:.1e} at degree {degree}");
        assert!(error < 10.0 * accuracy.max(1e-13) && degree >= before);
        before = degree;
    }
    for pieces in [2, 3, 5] {
        let (error, degree) = tip(pieces, 1e-8);
        println!("{pieces} pieces: error {error:.1e} at degree {degree}");
        assert!(error < 1e-9);
    }
}
