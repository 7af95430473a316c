//! The same bits whoever else computes, and the same results in other units and other orders.

mod common;

use common::{
    SplitMix,
    generator::{Case, case, snapping},
    joined, network, node,
};
use forcewright_base::maths;
use forcewright_beam::{CurveSolver, Drive, Follow, Network, Path, Point, Response, Section, Settings, Shape, Theory, trace};

/// Designs of every kind, a third of them followed through limit points.
fn designs() -> Vec<Case> {
    let mut all: Vec<Case> = (0..14).map(|i| case(5000 + i, 1e-6)).filter(|c| c.network.check().is_ok()).collect();
    all.extend((0..12).map(|i| snapping(5000 + i, 1e-6)));
    for (index, design) in all.iter_mut().enumerate() {
        if index % 3 == 0 {
            design.settings = Settings { follow: Follow::ToEnd, iteration_limit: 1_500, ..design.settings };
        }
    }
    all
}

fn bits_of_points(points: &[Point], out: &mut Vec<u64>) {
    for point in points {
        out.extend([point.control, point.displacement, point.force, point.stiffness, point.energy_j].map(f64::to_bits));
        for beam in &point.beams {
            let inside = [0.2, 0.5, 0.9].map(|u| beam.rotation_rad(u));
            out.extend(inside.iter().chain(&beam.force_n).map(|v| v.to_bits()));
            out.push(beam.peak_stress().stress_pa.to_bits());
        }
    }
}

/// Every number of a path and the work it took.
fn bits(path: &Path) -> Vec<u64> {
    let c = path.counters;
    let mut out = vec![c.newton_iterations, c.residual_evaluations, c.factorisations, c.steps, c.rejected_steps, path.degree as u64];
    bits_of_points(&path.points, &mut out);
    bits_of_points(&path.whole, &mut out);
    out.extend(path.folds.iter().flat_map(|f| [f.control.to_bits(), f.force.to_bits(), f.displacement.to_bits()]));
    out.extend(path.jumps.iter().map(|j| j.released_j.to_bits()));
    out.extend(path.bifurcations.iter().map(|b| b.force.to_bits()));
    out
}

fn run(design: &Case) -> Path {
    trace(&design.network, &design.stations, &design.settings, &mut |_| true).expect("a sound network")
}

#[test]
fn threads_and_order_do_not_change_a_bit() {
    let all = designs();
    let in_threads = |threads: usize| {
        let mut results: Vec<Vec<u64>> = vec![Vec::new(); all.len()];
        std::thread::scope(|scope| {
            let work = |first: usize| {
                let all = &all;
                // Each thread backwards, so that neighbours in time differ as well.
                scope.spawn(move || (first..all.len()).step_by(threads).rev().map(|i| (i, bits(&run(&all[i])))).collect::<Vec<_>>())
            };
            let handles: Vec<_> = (0..threads).map(work).collect();
            for handle in handles {
                for (i, bits) in handle.join().expect("no panic") {
                    results[i] = bits;
                }
            }
        });
        results
    };
    let alone: Vec<Vec<u64>> = all.iter().map(|d| bits(&run(d))).collect();
    assert!(alone.iter().filter(|b| b.len() > 100).count() > 18, "{}", alone.len());
    for threads in [1, 2, 4] {
        assert!(in_threads(threads) == alone, "{threads} threads");
    }
}

fn response_bits(response: &Response) -> Vec<u64> {
    let lists = [&response.force_n, &response.stress_pa];
    let mut out: Vec<u64> = lists.iter().flat_map(|l| l.iter().map(|v| v.to_bits())).collect();
    out.push(response.error_estimate.to_bits());
    out.push(response.counters.newton_iterations);
    out
}

#[test]
fn a_curve_does_not_depend_on_the_curves_before_it() {
    let mut random = SplitMix(12);
    let stations: Vec<f64> = (1..=20).map(|i| f64::from(i) * 0.7e-3).collect();
    let count = 30;
    let mut networks: Vec<Network> = Vec::new();
    while networks.len() < count {
        networks.extend(common::random_network(&mut random, 3.0, 1.5));
    }
    for accuracy in [1e-4, 1e-8] {
        let mut solver = CurveSolver::new();
        let solve = |solver: &mut CurveSolver, i: usize| {
            let theory = if i.is_multiple_of(2) { Theory::Inextensible } else { Theory::Reissner };
            let settings = Settings { theory, accuracy, ..Settings::default() };
            response_bits(solver.solve(&networks[i], &stations, &settings).expect("a sound network"))
        };
        let fresh: Vec<Vec<u64>> = (0..count).map(|i| solve(&mut CurveSolver::new(), i)).collect();
        // 7 and 11 have no factor in common with 30: each order visits every design.
        for stride in [1, 7, 11, 29] {
            for i in (0..count).map(|k| (k * stride + 3) % count) {
                assert!(solve(&mut solver, i) == fresh[i], "design {i} in order {stride}");
            }
        }
    }
}

/// The same network with nodes and beams in another order, and every second beam run backwards.
fn renumbered(network_: &Network, random: &mut SplitMix) -> Network {
    let shuffle = |random: &mut SplitMix, count: usize| {
        let mut order: Vec<usize> = (0..count).collect();
        for i in (1..count).rev() {
            order.swap(i, random.below(i + 1));
        }
        order
    };
    let place = shuffle(random, network_.nodes.len());
    let mut nodes = network_.nodes.clone();
    for (old, node) in network_.nodes.iter().enumerate() {
        nodes[place[old]] = *node;
    }
    let beams = shuffle(random, network_.beams.len()).into_iter().enumerate().map(|(i, old)| {
        let b = &network_.beams[old];
        if i % 2 == 0 {
            joined(place[b.end], place[b.start], b.shape.reversed(), b.section, [b.end_joint, b.start_joint])
        } else {
            joined(place[b.start], place[b.end], b.shape.clone(), b.section, [b.start_joint, b.end_joint])
        }
    });
    let drive = match network_.drive {
        Drive::Displacement { node, direction } => Drive::Displacement { node: place[node], direction },
        Drive::Force { node, direction } => Drive::Force { node: place[node], direction },
        Drive::Rotation { node } => Drive::Rotation { node: place[node] },
        Drive::Moment { node } => Drive::Moment { node: place[node] },
    };
    network(nodes, beams.collect(), drive)
}

/// Units in which a second network is measured, as multiples of those of the first.
#[derive(Clone, Copy)]
struct Units {
    length: f64,
    force: f64,
}

impl Units {
    /// Of displacement and force along a drive.
    fn of(&self, drive: Drive) -> (f64, f64) {
        match drive {
            Drive::Displacement { .. } | Drive::Force { .. } => (self.length, self.force),
            Drive::Rotation { .. } | Drive::Moment { .. } => (1.0, self.force * self.length),
        }
    }
}

/// Largest difference of two paths relative to the largest force and displacement; `None` if either ended early.
fn compare(a: &Path, b: &Path, drive: Drive, units: Units) -> Option<f64> {
    assert_eq!(std::mem::discriminant(&a.status), std::mem::discriminant(&b.status), "{} {}", a.status, b.status);
    if !a.whole_status.is_complete() || !b.whole_status.is_complete() {
        return None;
    }
    assert_eq!((a.folds.len(), a.jumps.len(), a.points.len()), (b.folds.len(), b.jumps.len(), b.points.len()));
    let (length, force) = units.of(drive);
    let all = |p: &Path| {
        p.points.iter().map(|p| [p.displacement, p.force]).chain(p.folds.iter().map(|f| [f.displacement, f.force])).collect::<Vec<_>>()
    };
    let (a, b) = (all(a), all(b));
    let largest = |k: usize| a.iter().fold(1e-9, |m: f64, v| m.max(v[k].abs()));
    let mut worst = 0.0_f64;
    for (a_, b_) in a.iter().zip(&b) {
        worst = worst.max((a_[0] - b_[0] / length).abs() / largest(0)).max((a_[1] - b_[1] / force).abs() / largest(1));
    }
    Some(worst)
}

#[test]
fn numbering_does_not_matter() {
    let mut random = SplitMix(4);
    let (mut compared, mut folded, mut worst) = (0, 0, 0.0_f64);
    for design in designs() {
        let settings = Settings { follow: Follow::ToEnd, iteration_limit: 1_500, ..design.settings };
        let other = Case { network: renumbered(&design.network, &mut random), settings, ..design.clone() };
        let (a, b) = (run(&Case { settings, ..design.clone() }), run(&other));
        if let Some(difference) = compare(&a, &b, design.network.drive, Units { length: 1.0, force: 1.0 }) {
            (compared, folded) = (compared + 1, folded + usize::from(!a.folds.is_empty()));
            worst = worst.max(difference);
        }
    }
    println!("{compared} compared, {folded} with limit points, worst {worst:.1e}");
    assert!(compared >= 18 && folded >= 3 && worst < 1e-9, "{compared} {folded} {worst:e}");
}

/// The same network made larger, of another material and depth; the thickness grows with the size where slenderness matters.
fn scaled(network_: &Network, size: f64, young: f64, depth: f64, thickness: f64) -> Network {
    let nodes: Vec<_> = network_.nodes.iter().map(|n| node(n.position_m.map(|p| size * p), n.support)).collect();
    let beams = network_.beams.iter().map(|b| {
        let shape = Shape::new(b.shape.angle_rad().to_vec(), size * b.shape.length_m()).expect("a shape");
        let s = b.section;
        let section = Section { young_pa: young * s.young_pa, depth_m: depth * s.depth_m, thickness_m: thickness * s.thickness_m, ..s };
        joined(b.start, b.end, shape, section, [b.start_joint, b.end_joint])
    });
    network(nodes, beams.collect(), network_.drive)
}

#[test]
fn force_length_squared_per_bending_stiffness_is_invariant() {
    // Lan, Wang & Chen 2010, eq. (6), through limit points as well: F L²/EI at the same Δ/L.
    let mut random = SplitMix(6);
    let (mut compared, mut folded, mut worst) = (0, 0, 0.0_f64);
    for design in designs() {
        let settings = Settings { follow: Follow::ToEnd, iteration_limit: 1_500, ..design.settings };
        let factor = |random: &mut SplitMix, decades: f64| maths::powf(10.0, random.around(decades));
        let (size, young, depth) = (factor(&mut random, 2.0), factor(&mut random, 2.0), factor(&mut random, 1.0));
        let thickness = if settings.theory == Theory::Inextensible { factor(&mut random, 1.0) } else { size };
        let force = young * depth * thickness * thickness * thickness / (size * size);
        let units = Units { length: size, force };
        let drive = design.network.drive;
        let (displacement, load) = units.of(drive);
        let control = if drive.is_kinematic() { displacement } else { load };
        let stations = design.stations.iter().map(|s| control * s).collect();
        let other = Case { network: scaled(&design.network, size, young, depth, thickness), settings, stations };
        let (a, b) = (run(&Case { settings, ..design.clone() }), run(&other));
        if let Some(difference) = compare(&a, &b, drive, units) {
            (compared, folded) = (compared + 1, folded + usize::from(!a.folds.is_empty()));
            worst = worst.max(difference);
        }
    }
    println!("{compared} compared, {folded} with limit points, worst {worst:.1e}");
    assert!(compared >= 18 && folded >= 3 && worst < 1e-9, "{compared} {folded} {worst:e}");
}
