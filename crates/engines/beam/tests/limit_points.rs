//! Paths through limit points of the control: closed forms, and random networks whose states are checked one by one.
#![allow(clippy::float_cmp, reason = "stations and repeated values are the same numbers")]

mod common;

use std::f64::consts::{FRAC_PI_2, PI};

use common::{POM, SplitMix, VERTICAL_GUIDE, add, cantilever, close, exact, near, node, random_network, rigid};
use forcewright_base::{maths, quadrature::GaussLegendre, roots};
use forcewright_beam::{
    Beam, Drive, Follow, Joint, Network, Path, Point, Rotation, Section, Settings, Shape, Status, Support, Theory, trace,
};

fn followed(network: &Network, stations: &[f64], theory: Theory) -> Path {
    let settings = Settings { follow: Follow::ToEnd, ..exact(theory) };
    trace(network, stations, &settings, &mut |_| true).expect("a sound network")
}

/// Half span and rise of a truss of two bars, m.
const TRUSS: (f64, f64) = (0.1, 4e-4);

/// Force of the truss (R. von Mises 1923) whose tip has come down: 2 EA (1 − l/L) (h − Δ)/l.
fn truss_force(down: f64) -> f64 {
    let (a, h) = TRUSS;
    let (rest, length) = (maths::hypot(a, h), maths::hypot(a, h - down));
    2.0 * POM.axial_stiffness_n() * (1.0 - length / rest) * (h - down) / length
}

/// Its strain energy.
fn truss_energy(down: f64) -> f64 {
    let (a, h) = TRUSS;
    let rest = maths::hypot(a, h);
    let strain = maths::hypot(a, h - down) / rest - 1.0;
    POM.axial_stiffness_n() * rest * strain * strain
}

fn truss(drive: Drive) -> Network {
    let (a, h) = TRUSS;
    let places = [[-a, 0.0], [a, 0.0], [0.0, h]];
    let beam = |start: usize| {
        let shape = Shape::from_chord([-places[start][0], h], &[]).expect("a bar");
        Beam { start_joint: Joint::Rigid, end_joint: Joint::Hinged, ..rigid(start, 2, shape, POM) }
    };
    common::network(
        vec![node(places[0], Support::Pinned), node(places[1], Support::Pinned), node(places[2], Support::Free)],
        vec![beam(0), beam(1)],
        drive,
    )
}

/// dF/dΔ of the truss = 2 EA (1/L − a²/l³), negative around the flat position.
fn truss_stiffness(down: f64) -> f64 {
    let (a, h) = TRUSS;
    let (rest, length) = (maths::hypot(a, h), maths::hypot(a, h - down));
    2.0 * POM.axial_stiffness_n() * (1.0 / rest - a * a / (length * length * length))
}

/// The tip positions at which the truss has a given stiffness, on both sides of the flat position.
fn places_of_stiffness(stiffness: f64) -> [f64; 2] {
    let h = TRUSS.1;
    let place = |from: f64, to: f64| roots::root(|d| truss_stiffness(d) - stiffness, from, to, 1e-16).expect("a sign change");
    [place(0.0, h), place(h, 2.0 * h)]
}

#[test]
fn dead_load_on_a_truss_snaps_through() {
    let places = places_of_stiffness(0.0);
    let top = truss_force(places[0]);
    let stations = [0.3 * top, 0.9 * top, 1.5 * top];
    let path = followed(&truss(Drive::Force { node: 2, direction: [0.0, -1.0] }), &stations, Theory::Reissner);
    assert!(matches!(path.status, Status::NoEquilibriumBeyond { .. }) && path.points.len() == 2);
    assert_eq!(path.whole_status, Status::Complete);
    for point in &path.whole {
        close(point.force, truss_force(point.displacement), 1e-8 * top, "force");
        close(point.energy_j, truss_energy(point.displacement), 1e-8 * truss_energy(TRUSS.1), "energy");
        let fold = path.folds.iter().any(|f| path.whole[f.index].displacement == point.displacement);
        assert!(fold || point.instability == usize::from(point.branch == 1), "{} on {}", point.instability, point.branch);
    }
    assert_eq!(path.folds.len(), 2);
    for (fold, place) in path.folds.iter().zip(places) {
        near(fold.control, truss_force(place), 1e-9, "limit load");
        near(fold.displacement, place, 1e-7, "its displacement");
    }
    // Each station as often as the path passes it.
    for (station, times) in stations.iter().zip([3, 3, 1]) {
        assert_eq!(path.whole.iter().filter(|p| p.control == *station).count(), times, "{station}");
    }
    let jump = path.jumps[0];
    let landing = roots::root(|d| truss_force(d) - top, 2.0 * TRUSS.1, 4.0 * TRUSS.1, 1e-16).unwrap();
    near(jump.displacement_after, landing, 1e-8, "landing");
    assert!(path.jumps.len() == 1 && path.whole[jump.to].instability == 0 && jump.force_before == jump.control);
    let released = truss_energy(places[0]) - truss_energy(landing) + top * (landing - places[0]);
    near(jump.released_j, released, 1e-6, "energy set free");
    assert!(path.bifurcations.is_empty());
    let last = path.whole.last().unwrap();
    assert!(last.branch == 2 && last.control == stations[2]);
}

#[test]
fn snap_back_of_a_truss_behind_a_soft_bar() {
    // Δ = d + F(d)/k turns back where F'(d) = −k.
    // Soft, yet too thick to buckle when the truss pushes it back.
    let soft = Section { young_pa: 200.0, thickness_m: 5e-2, depth_m: 1e-2, poisson: None };
    let length = 0.1;
    let stiffness = soft.axial_stiffness_n() / length;
    let mut network = truss(Drive::Displacement { node: 3, direction: [0.0, -1.0] });
    network.nodes.push(node([0.0, TRUSS.1 - length], VERTICAL_GUIDE));
    network.beams.push(rigid(2, 3, Shape::new(vec![-FRAC_PI_2], length).unwrap(), soft));
    let total = |d: f64| d + truss_force(d) / stiffness;
    let places = places_of_stiffness(-stiffness);
    let path = followed(&network, &[1e-4, 1.5 * total(places[0])], Theory::Reissner);
    assert_eq!(path.whole_status, Status::Complete, "{} {:?}", path.whole_status, path.folds);
    let tip = |p: &Point| -p.nodes[2].displacement_m[1];
    for p in &path.whole {
        close(p.displacement, total(tip(p)), 1e-8 * total(places[0]), "displacement");
        close(p.force, truss_force(tip(p)), 1e-8 * truss_force(places_of_stiffness(0.0)[0]), "force");
    }
    assert_eq!(path.folds.len(), 2);
    for (fold, place) in path.folds.iter().zip(places) {
        near(fold.control, total(place), 1e-9, "limit displacement");
        near(tip(&path.whole[fold.index]), place, 1e-7, "tip there");
    }
    // The tip is unstable between the limit points only, although the truss alone softens before.
    assert!(path.whole.iter().all(|p| p.instability <= 1 && (p.branch == 1 || p.instability == 0)));
    let jump = path.jumps[0];
    assert!(jump.force_before > jump.force_after && jump.released_j > 0.0);
    near(jump.displacement_after, jump.displacement_before, 1e-10, "control held");
}

#[test]
fn euler_loads_are_bifurcations() {
    // With compression of the axis and shear P (1 + P (1/kGA − 1/EA)) = π² EI/L² (E. Reissner 1972), for a pinned column, four times
    // that for a clamped one and a quarter for a free one.
    let (length, euler) = (0.1, PI * PI * POM.bending_stiffness_n_m2() / 0.01);
    let soft = 1.0 / POM.shear_stiffness_n() - 1.0 / POM.axial_stiffness_n();
    let slider = |rotation| Support::Slider { direction: [1.0, 0.0], rotation };
    let cases = [
        (Support::Pinned, slider(Rotation::Free), 1.0),
        (Support::Clamped, slider(Rotation::Fixed), 4.0),
        (Support::Clamped, Support::Free, 0.25),
    ];
    for (start, end, factor) in cases {
        for by_force in [true, false] {
            let direction = [-1.0, 0.0];
            let drive = if by_force { Drive::Force { node: 1, direction } } else { Drive::Displacement { node: 1, direction } };
            let mut network = cantilever(length, 0.0, POM, end, drive);
            network.nodes[0].support = start;
            let critical = roots::root(|p| p * (1.0 + p * soft) - factor * euler, 0.0, 10.0 * factor * euler, 1e-14).unwrap();
            let station = if by_force { 1.5 * critical } else { 1.5 * critical * length / POM.axial_stiffness_n() };
            let path = trace(&network, &[0.2 * station, station], &exact(Theory::Reissner), &mut |_| true).unwrap();
            assert_eq!(path.status, Status::Complete);
            assert_eq!(path.bifurcations.len(), 1, "{factor}");
            let b = path.bifurcations[0];
            near(b.force, critical, 1e-6, "critical load");
            assert!((b.before, b.after) == (0, 1) && path.points[0].instability == 0 && path.points[1].instability == 1);
        }
    }
}

/// Largest violation of equilibrium of a state of the half mechanism, relative to its forces, from the results alone: forces and
/// moments at the nodes, closure of each beam by its own shape, and moment against force times lever inside.
fn violation(network: &Network, point: &Point) -> f64 {
    let size = point.beams.iter().flat_map(|b| b.force_n).fold(1e-3, |m: f64, f| m.max(f.abs()));
    let length = network.beams.iter().map(|b| b.shape.length_m()).fold(0.0, f64::max);
    let mut worst = 0.0_f64;
    let mut note = |error: f64, scale: f64| worst = worst.max(error.abs() / scale);
    let [one, two, three, four] = [0, 1, 2, 3].map(|i| &point.beams[i]);
    for axis in 0..2 {
        note(one.force_n[axis] + two.force_n[axis] - three.force_n[axis], size);
        note(three.force_n[axis] - four.force_n[axis], size);
    }
    note(one.end_moment_nm + two.end_moment_nm - three.start_moment_nm, size * length);
    note(three.end_moment_nm - four.start_moment_nm, size * length);
    note(point.force + four.force_n[1], size);
    for (beam, state) in network.beams.iter().zip(&point.beams) {
        let [start, end] = [state.shape_m(0.0), state.shape_m(1.0)];
        let want = add(network.nodes[beam.end].position_m, point.nodes[beam.end].displacement_m, 1.0);
        note(end[0] - want[0], length);
        note(end[1] - want[1], length);
        for u in [0.3, 0.7] {
            let place = state.shape_m(u);
            let lever = [place[0] - start[0], place[1] - start[1]];
            let moment = state.start_moment_nm - (lever[0] * state.force_n[1] - lever[1] * state.force_n[0]);
            note(state.moment_nm(u) - moment, size * length);
        }
    }
    worst
}

/// ∫ F dΔ against the energy along the whole path, by the trapezoidal rule, relative to the total variation of the energy.
fn energy_gap(path: &Path) -> f64 {
    let (mut gap, mut variation) = (0.0_f64, 1e-12_f64);
    for pair in path.whole.windows(2) {
        let (a, b) = (&pair[0], &pair[1]);
        let step = b.displacement - a.displacement;
        let trapezoid = 0.5 * step * (a.force + b.force);
        gap += b.energy_j - a.energy_j - trapezoid;
        variation += (b.energy_j - a.energy_j).abs();
    }
    gap.abs() / variation
}

#[test]
fn a_thousand_random_networks_are_followed() {
    let mut random = SplitMix(1979);
    // Displacements of 30 mm at a height of 40 mm, and dead loads of 40 N.
    let travel: Vec<f64> = (1..=10).map(|i| f64::from(i) * 3e-3).collect();
    let loads: Vec<f64> = (1..=10).map(|i| f64::from(i) * 4.0).collect();
    let (mut complete, mut folded, mut jumps, mut branched, mut reasons) = (0, 0, 0, 0, Vec::new());
    let (mut worst, mut worst_energy) = (0.0_f64, 0.0_f64);
    for index in 0..1000 {
        let (nodes, bend) = if index % 4 < 2 { (8.0, 6.0) } else { (3.0, 1.5) };
        let Ok(mut network) = random_network(&mut random, nodes, bend) else { continue };
        let by_force = index % 3 == 0;
        if by_force {
            network.drive = Drive::Force { node: 4, direction: [0.0, -1.0] };
        }
        let stations = if by_force { &loads } else { &travel };
        let theory = if index % 2 == 0 { Theory::Inextensible } else { Theory::Reissner };
        // Under a dead load, bends of 6 rad uncoil to ten times their chord (F L²/EI in the thousands): degree 48 leaves 1e-5 to 6e-3.
        let settings = Settings { accuracy: 1e-4, follow: Follow::ToEnd, iteration_limit: 20_000, ..exact(theory) };
        let path = trace(&network, stations, &settings, &mut |_| true).unwrap();
        assert!(path.counters.newton_iterations < 40_000, "{index}: {:?}", path.counters);
        if path.whole_status == Status::Complete {
            complete += 1;
            assert_eq!(path.folds.len() % 2, 0, "{index}: {:?}", path.folds);
            assert!(path.whole.last().map(|p| p.control) == stations.last().copied());
        } else {
            reasons.push((index, path.whole_status));
        }
        folded += usize::from(!path.folds.is_empty());
        jumps += path.jumps.len();
        branched += usize::from(!path.bifurcations.is_empty());
        for point in &path.whole {
            assert!(point.force.is_finite() && point.energy_j.is_finite() && !point.stiffness.is_nan(), "{index}");
            let error = violation(&network, point);
            assert!(error < 1e-4, "{index}: {error} at {} on {}", point.control, point.branch);
            worst = worst.max(error);
        }
        let gap = energy_gap(&path);
        worst_energy = worst_energy.max(gap);
        assert!(gap < 0.05, "{index}: {gap}");
        if index % 20 == 0 {
            let again = trace(&network, stations, &settings, &mut |_| true).unwrap();
            let bits = |p: &Path| p.whole.iter().flat_map(|p| [p.force.to_bits(), p.energy_j.to_bits()]).collect::<Vec<_>>();
            assert!(bits(&path) == bits(&again) && path.counters == again.counters && path.jumps == again.jumps);
            let stopped = trace(&network, stations, &Settings { follow: Follow::StopAtLimit, ..settings }, &mut |_| true).unwrap();
            assert_eq!((path.status, path.points.len()), (stopped.status, stopped.points.len()), "{index}");
        }
    }
    println!("{complete} complete, {folded} with folds, {jumps} jumps, {branched} with bifurcations; {worst:.1e} {worst_energy:.1e}");
    println!("{} {reasons:?}", reasons.len());
    assert!(complete > 900 && folded > 20);
}

#[test]
fn work_along_the_arc_is_the_energy() {
    // Snapping under a dead load: the path is a function of the displacement, so that the integral can be done exactly.
    let (mut random, mut checked) = (SplitMix(3), 0);
    while checked < 5 {
        let mut network = random_network(&mut random, 3.0, 1.5).expect("mild");
        network.drive = Drive::Force { node: 4, direction: [0.0, -1.0] };
        let path = followed(&network, &[15.0], Theory::Reissner);
        if path.folds.is_empty() || path.whole_status != Status::Complete {
            continue;
        }
        let end = path.whole.last().unwrap().clone();
        network.drive = Drive::Displacement { node: 4, direction: [0.0, -1.0] };
        let prescribed = trace(&network, &[end.displacement], &exact(Theory::Reissner), &mut |_| true).unwrap();
        if !prescribed.status.is_complete() {
            continue;
        }
        let rule = GaussLegendre::new(24);
        let panels = 4.0;
        let mut work = 0.0;
        for i in 0..4 {
            let width = end.displacement / panels;
            work += width * rule.integrate(|s| prescribed.at((f64::from(i) + s) * width).unwrap().force);
        }
        near(end.energy_j, work, 1e-6, "work");
        near(prescribed.points[0].force, end.force, 1e-7, "both drives meet");
        for fold in &path.folds {
            let at = prescribed.at(fold.displacement).unwrap();
            near(at.force, fold.force, 1e-7, "limit load");
            close(at.stiffness, 0.0, 1e-3 * prescribed.at(0.0).unwrap().stiffness, "stiffness there");
        }
        checked += 1;
    }
}
