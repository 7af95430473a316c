//! Two thousand random networks of every kind: each path ends with a result or a named reason, obeys the balance of energy, and
//! agrees with an independent formulation, through limit points as well.

mod common;

use std::collections::BTreeMap;

use common::{
    generator::{Case, case, snapping},
    shooting::Shooting,
};
use forcewright_base::quadrature::GaussLegendre;
use forcewright_beam::{BeamState, Drive, Follow, Network, Path, PathError, Point, Settings, Status, Theory, trace};

/// Asked of the engine, relative to the largest force of a path.
const ACCURACY: f64 = 1e-9;
/// Largest difference from shooting, relative to the largest of a path.
const AGREEMENT: f64 = 1e-8;

/// Force in a beam, in units that bend it by about 1 rad, at which inextensible beams are all but straight: forces have no limit then.
const STRAIGHT: f64 = 1e3;
/// Largest difference between the work of the drive and the energy.
const BALANCE: f64 = 2e-6;

/// The same for forces inside: those along beams that are almost straight and inextensible amplify rounding.
const INSIDE: f64 = 1e-7;

/// What was seen.
#[derive(Debug, Default)]
struct Tally {
    /// How each ended.
    ends: BTreeMap<String, usize>,
    compared: usize,
    /// Points not compared because a beam is pulled straight.
    straight: usize,
    /// Largest differences of force, displacement, and force and moment in beams.
    differences: [f64; 3],
    /// Largest difference between work and energy.
    work: f64,
    /// Networks with limit points, and points beyond the first that were compared.
    folded: usize,
    beyond: usize,
}

impl Tally {
    fn add(&mut self, other: Self) {
        for (end, count) in other.ends {
            *self.ends.entry(end).or_default() += count;
        }
        self.compared += other.compared;
        self.straight += other.straight;
        for (mine, theirs) in self.differences.iter_mut().zip(other.differences) {
            *mine = mine.max(theirs);
        }
        self.work = self.work.max(other.work);
        self.folded += other.folded;
        self.beyond += other.beyond;
    }

    fn end(&mut self, kind: &str, what: &impl std::fmt::Debug) {
        let name = format!("{what:?}");
        let name = name.split([' ', '{', '(']).next().unwrap_or_default();
        *self.ends.entry(format!("{kind}{name}")).or_default() += 1;
    }
}

/// Every number of a result is one.
fn assert_sound(index: u64, points: &[Point]) {
    for point in points {
        let mut all = vec![point.control, point.displacement, point.force, point.energy_j];
        for node in &point.nodes {
            all.extend([node.displacement_m[0], node.displacement_m[1], node.rotation_rad]);
        }
        for beam in &point.beams {
            all.extend([beam.force_n[0], beam.force_n[1], beam.start_moment_nm, beam.end_moment_nm]);
            all.extend([beam.start_rotation_rad, beam.end_rotation_rad, beam.peak_stress().stress_pa, beam.peak_stress().u]);
            all.extend([0.2, 0.5, 0.9].map(|u| beam.rotation_rad(u)));
            all.extend(beam.shape_m(0.37));
            all.extend(beam.stress_pa(0.37));
        }
        assert!(all.iter().all(|v| v.is_finite()), "{index}: {all:?}");
        assert!(!point.stiffness.is_nan(), "{index}: stiffness at {}", point.control);
    }
}

/// Units of displacement and force along the drive: the longest beam (or 1 rad), and the force that bends it by about 1 rad.
fn units(network: &Network) -> (f64, f64) {
    let length = network.beams.iter().map(|b| b.shape.length_m()).fold(0.0, f64::max);
    let stiffness = network.beams.iter().map(|b| b.section.bending_stiffness_n_m2()).fold(0.0, f64::max);
    match network.drive {
        Drive::Displacement { .. } | Drive::Force { .. } => (length, stiffness / (length * length)),
        Drive::Rotation { .. } | Drive::Moment { .. } => (1.0, stiffness / length),
    }
}

/// Largest force and displacement along the drive, and force in a beam, of a path; not less than a millionth of the unit of displacement and a ten-thousandth of that of force, which is
/// where rounding begins.
fn scales(network: &Network, points: &[Point]) -> [f64; 3] {
    let (displacement, force) = units(network);
    let largest = |f: &dyn Fn(&Point) -> f64, least: f64| points.iter().fold(1e-6 * least, |m, p| m.max(f(p).abs()));
    let length = network.beams.iter().map(|b| b.shape.length_m()).fold(0.0, f64::max);
    let most = |b: &BeamState| [b.force_n[0], b.force_n[1], b.start_moment_nm / length].iter().fold(0.0_f64, |m, f| m.max(f.abs()));
    let inside = |p: &Point| p.beams.iter().map(most).fold(0.0, f64::max);
    let beam = if matches!(network.drive, Drive::Displacement { .. } | Drive::Force { .. }) { force } else { force / length };
    [largest(&|p| p.force, 1e2 * force), largest(&|p| p.displacement, displacement), largest(&inside, 1e4 * beam)]
}

/// Compares a point with shooting; `None` if that finds nothing.
fn differences(network: &Network, theory: Theory, point: &Point, scales: &[f64; 3]) -> Option<[f64; 3]> {
    let shot = Shooting::new(network, theory, point).solve(point)?;
    let length = network.beams.iter().map(|b| b.shape.length_m()).fold(0.0, f64::max);
    let mut inside = 0.0_f64;
    for (beam, (force, moment)) in point.beams.iter().zip(shot.beam_force_n.iter().zip(&shot.start_moment_nm)) {
        for (ours, theirs) in beam.force_n.iter().zip(force) {
            inside = inside.max((ours - theirs).abs());
        }
        inside = inside.max((beam.start_moment_nm - moment).abs() / length);
    }
    // The stiffness turns rounding of places into forces.
    let rounding = if network.drive.is_kinematic() { 1e-15 * (point.stiffness * units(network).0).abs() } else { 0.0 };
    let along =
        [((point.force - shot.force).abs() - rounding).max(0.0) / scales[0], (point.displacement - shot.displacement).abs() / scales[1]];
    Some([along[0], along[1], inside / scales[2]])
}

/// Work of the drive from rest to the last point less the energy there, relative to the largest of both kinds of work.
///
/// ∫ F dΔ by Gauss's rule between stations, from states that the path finds there; under a load, F Δ − ∫ Δ dF.
fn work_gap(path: &Path, kinematic: bool, units: (f64, f64), panels: u32) -> Result<f64, PathError> {
    let rule = GaussLegendre::new(6);
    let (Some(first), Some(last)) = (path.points.first(), path.points.last()) else { return Ok(0.0) };
    let (mut integral, mut variation) = (0.0, 0.0_f64);
    for pair in path.points.windows(2) {
        let width = (pair[1].control - pair[0].control) / f64::from(panels);
        for (u, weight) in (0..panels).flat_map(|i| rule.nodes().iter().map(move |u| f64::from(i) + u).zip(rule.weights())) {
            let point = path.at(pair[0].control + u * width)?;
            let term = weight * width * if kinematic { point.force } else { point.displacement };
            integral += term;
            variation += term.abs();
        }
    }
    let whole = last.force * last.displacement;
    let work = if kinematic { integral } else { whole - integral };
    let (displacement, force) = units;
    let scale = variation.max(whole.abs()).max(1e-9 * displacement * force);
    Ok((work - (last.energy_j - first.energy_j)).abs() / scale)
}

/// The gap by as many panels as it takes.
fn balance(index: u64, path: &Path, network: &Network) -> f64 {
    let gap = |panels| work_gap(path, network.drive.is_kinematic(), units(network), panels).unwrap_or_else(|e| panic!("{index}: {e}"));
    // Next to a limit point that is just avoided, displacements change quickly.
    let gap = [1, 8, 64, 256].into_iter().map(gap).find(|g| *g < BALANCE).unwrap_or_else(|| gap(1024));
    assert!(gap < BALANCE, "{index}: {gap:e}");
    gap
}

fn examine(index: u64, case: &Case, tally: &mut Tally) {
    let Case { network, settings, stations } = case;
    let path = match trace(network, stations, settings, &mut |_| true) {
        Ok(path) => path,
        Err(error) => {
            assert!(!error.to_string().is_empty());
            return tally.end("refused: ", &error);
        }
    };
    tally.end("", &path.status);
    assert_sound(index, &path.points);
    assert!(!path.status.to_string().is_empty() && path.counters.newton_iterations <= 2 * settings.iteration_limit, "{index}");
    assert!(path.error_estimate.is_none_or(|e| !e.is_nan()), "{index}: {}", path.status);
    let scales = scales(network, &path.points);
    if path.status.is_complete() {
        tally.work = tally.work.max(balance(index, &path, network));
    }
    if matches!(path.status, Status::Complete | Status::NoEquilibriumBeyond { .. }) {
        for point in path.points.iter().skip(1).step_by(4) {
            compare(index, case, point, &scales, tally);
        }
    }
    if matches!(path.status, Status::NoEquilibriumBeyond { .. }) {
        // Inextensible beams that are pulled straight have an infinite force, not a limit point.
        if path.at(path.reach()).is_ok_and(|p| p.force.abs() > STRAIGHT * units(network).1) {
            *tally.ends.entry("of these pulled straight".into()).or_default() += 1;
            return;
        }
        beyond_limits(index, case, tally);
    }
}

fn compare(index: u64, case: &Case, point: &Point, scales: &[f64; 3], tally: &mut Tally) -> bool {
    let force = units(&case.network).1;
    if point.beams.iter().flat_map(|b| b.force_n).any(|f| f.abs() > STRAIGHT * force) {
        tally.straight += 1;
        return false;
    }
    let found = differences(&case.network, case.settings.theory, point, scales);
    let found = found.unwrap_or_else(|| panic!("{index}: shooting finds nothing at {} on {}", point.control, point.branch));
    let agrees = found[0] <= AGREEMENT && found[1] <= AGREEMENT && found[2] <= INSIDE;
    assert!(agrees, "{index}: {found:?} at {} on {}, {scales:?}", point.control, point.branch);
    for (largest, d) in tally.differences.iter_mut().zip(found) {
        *largest = largest.max(d);
    }
    tally.compared += 1;
    true
}

/// Points past the first limit point, away from limit points, where the control does not determine a state well.
fn beyond_limits(index: u64, case: &Case, tally: &mut Tally) {
    let settings = Settings { follow: Follow::ToEnd, accuracy: 1e-8, iteration_limit: 4_000, ..case.settings };
    let path = trace(&case.network, &case.stations, &settings, &mut |_| true).expect("a sound network");
    assert_sound(index, &path.whole);
    tally.end("followed: ", &path.whole_status);
    if !path.whole_status.is_complete() {
        return;
    }
    let Some(first) = path.folds.first() else { return };
    let scales = scales(&case.network, &path.whole);
    let clear = |i: usize| i > first.index && path.folds.iter().all(|f| i.abs_diff(f.index) > 2);
    let candidates: Vec<usize> = (0..path.whole.len()).filter(|i| clear(*i)).collect();
    let before = tally.beyond;
    for i in candidates.iter().step_by(1 + candidates.len() / 6) {
        tally.beyond += usize::from(compare(index, case, &path.whole[*i], &scales, tally));
    }
    tally.folded += usize::from(tally.beyond > before);
}

/// The cases of two threads: each is a pure function of its number.
fn survey(cases: &[u64], make: fn(u64, f64) -> Case) -> Tally {
    let half = |odd: usize| {
        let mut tally = Tally::default();
        for index in cases.iter().skip(odd).step_by(2) {
            examine(*index, &make(*index, ACCURACY), &mut tally);
        }
        tally
    };
    std::thread::scope(|scope| {
        let second = scope.spawn(|| half(1));
        let mut all = half(0);
        all.add(second.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic)));
        all
    })
}

fn share(tally: &Tally, name: &str) -> usize {
    tally.ends.get(name).copied().unwrap_or_default()
}

/// Only these reasons occur, and most networks have a path.
fn assert_ends(tally: &Tally, cases: usize) {
    let known = [
        "Complete",
        "NoEquilibriumBeyond",
        "PulledStraight",
        "NotResolved",
        "OverConstrained",
        "Mechanism",
        "StepTooSmall",
        "IterationLimit",
        "TooLong",
    ];
    for end in tally.ends.keys() {
        let name = end.rsplit(' ').next().unwrap_or_default();
        assert!(end == "of these pulled straight" || known.contains(&name) || name == "DriveBlocked", "{end}");
    }
    assert!(share(tally, "Complete") * 10 > cases * 6, "{} of {cases} complete", share(tally, "Complete"));
    assert!(share(tally, "NotResolved") * 50 < cases && share(tally, "StepTooSmall") * 100 < cases);
}

#[test]
fn random_networks_of_every_kind() {
    let cases: Vec<u64> = (0..2000).step_by(20).collect();
    let tally = survey(&cases, case);
    println!("{tally:#?}");
    assert_ends(&tally, cases.len());
    assert!(tally.compared > 200, "{}", tally.compared);
}

#[test]
fn random_networks_that_snap() {
    let tally = survey(&(0..45).collect::<Vec<u64>>(), snapping);
    assert!(tally.folded >= 10 && tally.beyond >= 60, "{} {}", tally.folded, tally.beyond);
}

#[test]
#[ignore = "minutes: cargo test --release -p forcewright-beam --test networks -- --ignored --nocapture"]
fn two_thousand_random_networks() {
    let cases: Vec<u64> = (0..2000).collect();
    let tally = survey(&cases, case);
    println!("{tally:#?}");
    assert_ends(&tally, cases.len());
}

#[test]
#[ignore = "minutes: cargo test --release -p forcewright-beam --test networks -- --ignored --nocapture"]
fn two_hundred_random_networks_beyond_their_limits() {
    let snapping = survey(&(0..700).collect::<Vec<u64>>(), snapping);
    println!("{snapping:#?}");
    assert!(snapping.folded >= 200 && snapping.beyond >= 1000, "{} {}", snapping.folded, snapping.beyond);
}
