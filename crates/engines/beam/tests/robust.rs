//! Nonsense in, a reason out: no panic, and always an end.

mod common;

use common::{POM, VERTICAL_GUIDE, cantilever, elastica, exact, near, node, rigid, table3_by_nodes};
use forcewright_beam::{
    Drive, Joint, Network, NetworkError, Path, PathError, Rotation, Section, Settings, Shape, ShapeError, Status, Support, Theory, trace,
};

const UP: [f64; 2] = [0.0, 1.0];

fn run(network: &Network) -> Result<Path, NetworkError> {
    trace(network, &[0.001, 0.002], &Settings::default(), &mut |_| true)
}

/// The fault that one change to a sound network causes.
fn fault(change: impl FnOnce(&mut Network)) -> NetworkError {
    let mut network = table3_by_nodes(POM);
    change(&mut network);
    let error = run(&network).expect_err("a fault");
    assert!(!error.to_string().is_empty());
    error
}

#[test]
fn every_fault_is_named() {
    assert_eq!(fault(|n| n.beams.clear()), NetworkError::NoBeams);
    assert_eq!(fault(|n| n.nodes.clear()), NetworkError::NodeOutOfRange { beam: 0, node: 0 });
    assert_eq!(fault(|n| n.beams[2].end = 9), NetworkError::NodeOutOfRange { beam: 2, node: 9 });
    assert_eq!(fault(|n| n.beams[2].end = 2), NetworkError::BeamOnOneNode { beam: 2 });
    assert_eq!(fault(|n| n.drive = Drive::Moment { node: 5 }), NetworkError::DriveOutOfRange { node: 5 });
    assert_eq!(fault(|n| n.nodes.push(node([0.0, 0.0], Support::Free))), NetworkError::LooseNode { node: 5 });
    assert_eq!(fault(|n| n.nodes[3].position_m[1] = f64::NAN), NetworkError::Position { node: 3 });
    assert!(matches!(fault(|n| n.nodes[3].position_m[1] += 1e-6), NetworkError::DoesNotClose { beam: 2, .. }));
    let slider = |direction| Support::Slider { direction, rotation: Rotation::Fixed };
    assert_eq!(fault(|n| n.nodes[4].support = slider([0.0, 0.0])), NetworkError::Direction { node: 4 });
    assert_eq!(fault(|n| n.nodes[4].support = slider([f64::INFINITY, 1.0])), NetworkError::Direction { node: 4 });
    assert_eq!(fault(|n| n.nodes[4].support = slider([1.0, 0.0])), NetworkError::DriveBlocked { node: 4 });
    let drive = |node, direction| Drive::Displacement { node, direction };
    assert_eq!(fault(|n| n.drive = drive(4, [0.0, f64::NAN])), NetworkError::Direction { node: 4 });
    assert_eq!(fault(|n| n.drive = drive(0, UP)), NetworkError::DriveBlocked { node: 0 });
    assert_eq!(fault(|n| n.drive = Drive::Rotation { node: 4 }), NetworkError::DriveBlocked { node: 4 });
    assert_eq!(fault(|n| n.drive = Drive::Moment { node: 0 }), NetworkError::DriveBlocked { node: 0 });
    let section = |change: &dyn Fn(&mut Section)| fault(|n| change(&mut n.beams[1].section));
    for error in [
        section(&|s| s.young_pa = 0.0),
        section(&|s| s.thickness_m = -1.0),
        section(&|s| s.depth_m = f64::INFINITY),
        section(&|s| s.poisson = Some(0.6)),
        section(&|s| s.poisson = Some(f64::NAN)),
        section(&|s| s.young_pa = 1e300),
    ] {
        assert!(matches!(error, NetworkError::Section { beam: 1, .. }), "{error}");
    }
    let many = |n: &mut Network| n.beams = vec![n.beams[0].clone(); 1000];
    assert_eq!(fault(many), NetworkError::TooLarge { count: 1000 });
}

#[test]
fn stations_and_settings_are_checked() {
    let network = table3_by_nodes(POM);
    let stations = |s: &[f64]| trace(&network, s, &Settings::default(), &mut |_| true).map(|p| p.points.len());
    assert_eq!(stations(&[]), Ok(0));
    assert_eq!(stations(&[0.0]), Ok(1));
    assert_eq!(stations(&[-1e-3]), Err(NetworkError::Stations { index: 0 }));
    assert_eq!(stations(&[1e-3, 1e-3]), Err(NetworkError::Stations { index: 1 }));
    assert_eq!(stations(&[1e-3, f64::NAN]), Err(NetworkError::Stations { index: 1 }));
    assert_eq!(stations(&[f64::INFINITY]), Err(NetworkError::Stations { index: 0 }));
    for accuracy in [0.0, -1.0, 1.0, f64::NAN] {
        let settings = Settings { accuracy, ..Settings::default() };
        assert!(matches!(trace(&network, &[1e-3], &settings, &mut |_| true), Err(NetworkError::Accuracy { .. })));
    }
}

#[test]
fn parts_that_move_freely_are_named() {
    // Nothing holds it.
    let free = |n: &mut Network| {
        for i in [0, 1, 4] {
            n.nodes[i].support = Support::Free;
        }
    };
    assert_eq!(fault(free), NetworkError::Mechanism { node: 0 });
    // One pin and a force: it swings.
    let mut swing = cantilever(0.1, 0.3, POM, Support::Free, Drive::Force { node: 1, direction: UP });
    swing.nodes[0].support = Support::Pinned;
    assert_eq!(run(&swing).unwrap_err(), NetworkError::Mechanism { node: 0 });
    // A second part without any support.
    let mut two = cantilever(0.1, 0.0, POM, Support::Free, Drive::Force { node: 1, direction: UP });
    two.nodes.extend([node([1.0, 0.0], Support::Free), node([1.1, 0.0], Support::Free)]);
    two.beams.push(rigid(2, 3, Shape::new(vec![0.0], 0.1).unwrap(), POM));
    assert_eq!(run(&two).unwrap_err(), NetworkError::Mechanism { node: 2 });
    // Hinges: a four-bar linkage, and a chain that is straight.
    let bar = |start, end, angle: f64| {
        let mut b = rigid(start, end, Shape::new(vec![angle], 0.1).unwrap(), POM);
        (b.start_joint, b.end_joint) = (Joint::Hinged, Joint::Hinged);
        b
    };
    let up = std::f64::consts::FRAC_PI_2;
    let linkage = common::network(
        vec![
            node([0.0, 0.0], Support::Clamped),
            node([0.0, 0.1], Support::Free),
            node([0.1, 0.1], Support::Free),
            node([0.1, 0.0], Support::Clamped),
        ],
        vec![bar(0, 1, up), bar(1, 2, 0.0), bar(3, 2, up)],
        Drive::Force { node: 1, direction: UP },
    );
    for theory in [Theory::Inextensible, Theory::Reissner] {
        let path = trace(&linkage, &[0.01], &exact(theory), &mut |_| true).unwrap();
        assert!(matches!(path.status, Status::Mechanism { node: 1 | 2 }), "{}", path.status);
        assert!(path.points.is_empty() && matches!(path.at(0.0), Err(PathError::OutOfReach { .. })));
    }
}

#[test]
fn straight_inextensible_beams() {
    let across = |support| cantilever(0.1, 0.7, POM, support, Drive::Displacement { node: 1, direction: [-0.7, 0.8] });
    let free = trace(&across(Support::Free), &[0.01], &elastica(), &mut |_| true).unwrap();
    assert_eq!(free.status, Status::Complete);
    // Guided exactly across: no way to move without stretching.
    let (sin, cos) = forcewright_base::maths::sin_cos(0.7);
    let guide = Support::Slider { direction: [-sin, cos], rotation: Rotation::Fixed };
    let guided = trace(&across(guide), &[0.01], &elastica(), &mut |_| true).unwrap();
    assert_eq!(guided.status, Status::OverConstrained { beam: 0 });
    let stretching = trace(&across(guide), &[0.01], &exact(Theory::Reissner), &mut |_| true).unwrap();
    assert_eq!(stretching.status, Status::Complete);
}

#[test]
fn pulled_beyond_its_length_an_inextensible_beam_has_no_equilibrium() {
    let shape = Shape::from_chord([0.08, 0.0], &[3.0]).unwrap();
    let length = shape.length_m();
    let network = common::network(
        vec![node([0.0, 0.0], Support::Pinned), node([0.08, 0.0], Support::Slider { direction: [1.0, 0.0], rotation: Rotation::Free })],
        vec![rigid(0, 1, shape, POM)],
        Drive::Displacement { node: 1, direction: [1.0, 0.0] },
    );
    let path = trace(&network, &[0.5], &Settings { theory: Theory::Inextensible, ..Settings::default() }, &mut |_| true).unwrap();
    assert!(!path.status.is_complete(), "{}", path.status);
    assert!(path.reach() < length - 0.08 && path.reach() > 0.9 * (length - 0.08), "{} of {}: {}", path.reach(), length - 0.08, path.status);
    near(path.at(0.01).unwrap().control, 0.01, 0.0, "control");
}

#[test]
fn hostile_shapes_end_in_bounded_time() {
    let bends: [&[f64]; 6] = [&[1e3], &[1e3, -1e3], &[-40.0, 90.0, -70.0], &[1e6], &[f64::NAN], &[60.0]];
    for bend in bends {
        let shape = match Shape::from_chord([0.02, 0.01], bend) {
            Ok(shape) => shape,
            Err(error) => {
                assert!(matches!(error, ShapeError::TurnsTooMuch { .. } | ShapeError::NotFinite | ShapeError::ClosedLoop { .. }));
                continue;
            }
        };
        for theory in [Theory::Inextensible, Theory::Reissner] {
            let network = common::network(
                vec![node([0.0, 0.0], Support::Clamped), node([0.02, 0.01], VERTICAL_GUIDE)],
                vec![rigid(0, 1, shape.clone(), POM)],
                Drive::Displacement { node: 1, direction: UP },
            );
            let settings = Settings { theory, iteration_limit: 2_000, ..Settings::default() };
            let path = trace(&network, &[0.001, 0.01], &settings, &mut |_| true).unwrap();
            assert!(path.points.iter().all(|p| p.force.is_finite()));
            println!("{bend:?} {theory:?}: {}", path.status);
        }
    }
}

#[test]
fn the_budget_and_the_caller_can_stop_a_path() {
    let network = table3_by_nodes(POM);
    let stations: Vec<f64> = (1..=100).map(|i| f64::from(i) * 1e-4).collect();
    let settings = Settings { iteration_limit: 60, ..Settings::default() };
    let path = trace(&network, &stations, &settings, &mut |_| true).unwrap();
    assert!(matches!(path.status, Status::IterationLimit { limit: 60, .. }), "{}", path.status);
    assert!(path.counters.newton_iterations <= 60 && !path.points.is_empty());

    let mut fractions = Vec::new();
    let mut stop_late = |f: f64| {
        fractions.push(f);
        fractions.len() < 10
    };
    let path = trace(&network, &stations, &Settings::default(), &mut stop_late).unwrap();
    assert!(matches!(path.status, Status::Stopped { .. }) && fractions.len() == 10);
    let mut last = 0.0;
    let mut grows = |f: f64| {
        assert!(f >= last && f <= 1.0);
        last = f;
        true
    };
    assert!(trace(&network, &stations, &Settings::default(), &mut grows).unwrap().status.is_complete());
    // A range that no computer can walk.
    let settings = Settings { theory: Theory::Reissner, iteration_limit: 3_000, ..Settings::default() };
    let path = trace(&network, &[1e9], &settings, &mut |_| true).unwrap();
    assert!(!path.status.is_complete());
}

#[test]
fn points_beyond_the_path_are_refused() {
    let path = run(&table3_by_nodes(POM)).unwrap();
    near(path.reach(), 0.002, 1e-15, "reach");
    for control in [-1e-3, 0.0021, f64::NAN, f64::INFINITY] {
        assert!(matches!(path.at(control), Err(PathError::OutOfReach { .. })));
    }
    near(path.at(0.002).unwrap().force, path.points[1].force, 1e-13, "force");
    assert!(path.at(0.0).unwrap().force.abs() < 1e-12);
}
