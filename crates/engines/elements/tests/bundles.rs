//! Cables in parallel with memory, against single cables, the model without memory, and work.

use forcewright_elements::wrap::{Bundle, BundleHistory, Drive, DriveSpec, Drum, History, Hold, WrapError};

fn near(ours: f64, exact: f64, relative: f64) {
    assert!((ours - exact).abs() <= relative * exact.abs(), "{ours} instead of {exact}");
}

fn drive(preload_n: f64, axial_stiffness_n: f64) -> Drive {
    let drum = |radius_m| Drum { radius_m, friction: 0.15 };
    Drive::new(&DriveSpec {
        input: drum(0.010),
        output: drum(0.050),
        hold: Hold::Friction { wrap_rad: 24.3 },
        output_wraps_rad: [20.0, 14.0],
        spans_m: [0.025; 2],
        axial_stiffness_n,
        preload_n,
    })
    .expect("a drive")
}

fn uneven() -> Bundle {
    Bundle::new(vec![drive(220.0, 50e3), drive(140.0, 65e3), drive(220.0, 50e3)]).expect("three")
}

#[test]
fn first_loading_is_that_without_memory() {
    let bundle = uneven();
    for force_n in [1.0, 60.0, 300.0, -500.0, 700.0] {
        let mut history = BundleHistory::new(&bundle).expect("finite wraps");
        let (ours, plain) = (history.load_to(force_n).expect("held"), bundle.at_force(force_n).expect("held"));
        near(ours.displacement_m, plain.displacement_m, 1e-9);
        near(ours.tangent_n_per_m, plain.tangent_n_per_m, 1e-8);
        near(ours.force_n, force_n, 1e-12);
    }
}

#[test]
fn each_cable_goes_its_own_way() {
    // The same displacements, cable by cable.
    let bundle = uneven();
    let mut together = BundleHistory::new(&bundle).expect("finite wraps");
    let mut alone: Vec<History> = bundle.cables().iter().map(|c| History::new(c).expect("finite wraps")).collect();
    for displacement_m in [80e-6, 20e-6, 55e-6, -120e-6, 300e-6, 290e-6, -10e-6] {
        let ours = together.move_to(displacement_m).expect("finite");
        let sum: f64 = alone.iter_mut().map(|h| h.move_to(displacement_m).expect("finite").force_n).sum();
        near(ours.force_n, sum, 1e-12);
        near(together.friction_j(), alone.iter().map(History::friction_j).sum(), 1e-12);
    }
}

#[test]
fn loops_work_as_much_as_friction_takes() {
    let bundle = uneven();
    let mut history = BundleHistory::new(&bundle).expect("finite wraps");
    let force_n = 350.0;
    let cycle = history.cycle(force_n).expect("held");
    let [high_m, low_m] = cycle.displacements_m;
    near(history.displacement_m(), high_m, 1e-12);
    // Simpson's rule along both branches; both begin with the slope of the spans.
    let work = |history: &BundleHistory, from_m: f64, to_m: f64| {
        let n = 4000;
        let places: Vec<f64> = (0..=n).map(|i| from_m + (to_m - from_m) * f64::from(i) / f64::from(n)).collect();
        let steps = history.along(&places).expect("finite");
        let weight = |i: usize| {
            if i == 0 || i + 1 == places.len() {
                1.0
            } else if i % 2 == 1 {
                4.0
            } else {
                2.0
            }
        };
        steps.iter().enumerate().map(|(i, s)| weight(i) * s.force_n).sum::<f64>() * (to_m - from_m) / (3.0 * f64::from(n))
    };
    let back_j = work(&history, high_m, low_m);
    let reached = history.load_to(-force_n).expect("held");
    near(reached.displacement_m, low_m, 1e-11);
    let forth_j = work(&history, low_m, high_m);
    near(back_j + forth_j, cycle.lost_j, 1e-5);
    assert!(cycle.lost_motion_m > 0.0);
}

#[test]
fn what_is_ahead_is_what_is_reached() {
    let mut history = BundleHistory::new(&uneven()).expect("finite wraps");
    history.move_to(150e-6).expect("finite");
    let ahead = history.along(&[120e-6, -60e-6]).expect("finite");
    assert_eq!(history.along(&[120e-6]).expect("finite")[0], ahead[0]);
    near(history.clone().move_to(-60e-6).expect("finite").force_n, ahead[1].force_n, 1e-12);
    // In any order, near or far, to rounding.
    let mut places: Vec<f64> = (0..200).map(|i| 1e-6 * f64::from((i * 37) % 200 - 50)).collect();
    // What the last few foretell of a place far away is nonsense.
    places.extend([1e-4, 2e-4, 3e-4, 3e-2, 1e-4, 1.000_001e-4, 1.000_002e-4, 5e-2, -4e-4, -5e-4, -6e-4, -3e-2, 0.0]);
    for (step, place) in history.along(&places).expect("finite").iter().zip(&places) {
        near(step.force_n, history.clone().move_to(*place).expect("finite").force_n, 1e-11);
    }
}

#[test]
fn gross_slip_is_told_and_changes_nothing() {
    let bundle = uneven();
    let capacity_n = bundle.capacities_n()[0].expect("held by friction");
    let mut history = BundleHistory::new(&bundle).expect("finite wraps");
    let before = history.clone().load_to(10.0).expect("held");
    match history.load_to(1.01 * capacity_n) {
        Err(WrapError::GrossSlip { capacity_n: told_n }) => near(told_n, capacity_n, 1e-6),
        other => panic!("{other:?}"),
    }
    assert_eq!(history.load_to(10.0).expect("held"), before);
    near(history.load_to(0.999 * capacity_n).expect("held").force_n, 0.999 * capacity_n, 1e-9);
    assert!(history.load_to(f64::NAN).is_err());
}
