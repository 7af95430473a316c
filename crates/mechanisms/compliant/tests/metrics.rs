//! Metrics against an exhaustive scan of a densely computed curve, on perturbed designs.

mod common;
#[path = "common/drawing.rs"]
mod drawing;

use common::{Random, Solved, check, close, outcome, solve};
use drawing::{Drawing, guide};
use forcewright_beam::{Point, Settings, trace};
use forcewright_compliant::METRICS;
use forcewright_model::{CheckState, StatusKind};

/// Pieces of the scan.
const PIECES: usize = 1024;

/// Table 3 with nodes and bends moved, and other thickness, travel and model.
fn perturbed(seed: u64) -> (String, Vec<String>) {
    let mut random = Random(seed);
    let mut drawing = Drawing::table3();
    for node in &mut drawing.nodes {
        for x in &mut node.1 {
            *x += random.between(-3.0, 3.0);
        }
    }
    for beam in &mut drawing.beams {
        for c in &mut beam.2 {
            *c += random.between(-0.8, 0.8);
        }
    }
    drawing.travel = format!("{} mm", random.between(8.0, 18.0));
    drawing.model = if seed.is_multiple_of(2) { "reissner" } else { "inextensible" };
    let set = vec![
        format!("design.thickness={} mm", random.between(0.7, 1.4)),
        format!("requirements.force.band={}", random.between(0.01, 0.15)),
        "requirements.travel=1 mm".to_owned(),
    ];
    (drawing.text(), set)
}

/// Exact points of the whole travel, evenly spaced.
fn scan(solved: &Solved) -> Vec<Point> {
    let design = &solved.design;
    let stations: Vec<f64> = (0..=PIECES).map(|i| design.load_end * i as f64 / PIECES as f64).collect();
    let settings = Settings { theory: design.theory, accuracy: design.accuracy, ..Settings::default() };
    trace(&design.network, &stations, &settings, &mut |_| true).expect("a network that was checked").points
}

/// Longest run of samples that a rule accepts, as indices; the rule sees the largest and smallest force.
fn longest(forces: &[f64], rule: impl Fn(f64, f64) -> bool) -> Option<(usize, usize)> {
    let mut best: Option<(usize, usize)> = None;
    for first in 0..forces.len() {
        let (mut hi, mut lo) = (f64::NEG_INFINITY, f64::INFINITY);
        for (last, f) in forces.iter().enumerate().skip(first) {
            (hi, lo) = (hi.max(*f), lo.min(*f));
            if !rule(hi, lo) {
                break;
            }
            if last > first && best.is_none_or(|(a, b)| last - first > b - a) {
                best = Some((first, last));
            }
        }
    }
    best
}

/// A metric's interval can only be longer than the scan's, and by less than a piece at each end.
#[track_caller]
fn as_long(
    solved: &Solved,
    [start, end, ratio]: [&str; 3],
    scanned: Option<(usize, usize)>,
    forces: &[f64],
    rule: impl Fn(f64, f64) -> bool,
) {
    let step = solved.design.load_end / PIECES as f64;
    let Some((first, last)) = scanned else {
        assert!(solved.measured.get(ratio).unwrap_or(0.0) <= 2.0 / PIECES as f64, "{ratio}");
        return;
    };
    let length = solved.get(end) - solved.get(start);
    close(solved.get(ratio), length / solved.design.load_end, 1e-15, ratio);
    let found = (last - first) as f64 * step;
    assert!(length > found - 1e-9 * step && length < found + 2.0 * step, "{ratio}: {length}, the scan found {found}");
    // And it keeps the rule: every sample inside does, up to the interpolation between stations.
    let inside: Vec<f64> =
        (0..=PIECES).filter(|i| (solved.get(start)..=solved.get(end)).contains(&(*i as f64 * step))).map(|i| forces[i]).collect();
    let (hi, lo) = inside.iter().fold((f64::NEG_INFINITY, f64::INFINITY), |(hi, lo), f| (hi.max(*f), lo.min(*f)));
    assert!(rule(hi * (1.0 - 1e-6), lo * (1.0 + 1e-6)), "{ratio}: {lo} … {hi}");
}

fn intervals(solved: &Solved, forces: &[f64], band: f64, nominal: f64) {
    let flat = |hi: f64, lo: f64| lo > 0.0 && hi <= lo * (1.0 + band) / (1.0 - band);
    as_long(solved, ["flat_start", "flat_end", "flat_ratio"], longest(forces, flat), forces, flat);
    let within = |hi: f64, lo: f64| lo >= nominal * (1.0 - band) && hi <= nominal * (1.0 + band);
    as_long(solved, ["band_start", "band_end", "band_ratio"], longest(forces, within), forces, within);
}

/// c between the last two samples that the force rises through the level of the paper's rule.
fn range(solved: &Solved, forces: &[f64]) {
    let step = solved.design.load_end / PIECES as f64;
    let level = 0.95 * forces[PIECES];
    let last = (0..PIECES).rev().find(|i| forces[*i] < level && forces[i + 1] >= level);
    match (solved.measured.get("range_start"), last) {
        (Some(c), Some(i)) => assert!(c >= i as f64 * step && c <= (i + 1) as f64 * step, "c = {c}, sample {i}"),
        (None, None) => {}
        other => panic!("{other:?}"),
    }
}

fn extrema(solved: &Solved, points: &[Point], forces: &[f64]) -> bool {
    let step = solved.design.load_end / PIECES as f64;
    let top = (1..PIECES).find(|i| forces[*i] > forces[i - 1] && forces[*i] >= forces[i + 1]);
    let bottom = top.and_then(|top| (top + 1..PIECES).find(|i| forces[*i] < forces[i - 1] && forces[*i] <= forces[i + 1]));
    for (index, name, at, sign) in
        [(top, "force_local_max", "force_local_max_at", 1.0), (bottom, "force_local_min", "force_local_min_at", -1.0)]
    {
        assert_eq!(index.is_some(), solved.measured.get(name).is_some(), "{name}");
        let Some(index) = index else { continue };
        close(solved.get(at), index as f64 * step, step, at);
        let beyond = sign * (solved.get(name) - forces[index]);
        assert!(beyond >= -1e-8 * forces[index].abs() && beyond < 1e-3 * forces[index].abs(), "{name}: {beyond}");
    }
    let slopes: Vec<f64> = points.iter().map(|p| solved.behaviour.copies * p.stiffness).collect();
    let least = slopes.iter().copied().fold(f64::INFINITY, f64::min);
    let spread = slopes.iter().copied().fold(f64::NEG_INFINITY, f64::max) - least;
    let found = solved.get("stiffness_min");
    assert!(found <= least + 1e-9 * spread && found > least - 1e-4 * spread, "least stiffness {found}, scan {least}");
    let (largest, _) = solved.behaviour.largest_stiffness().expect("stations");
    assert!(largest >= least + spread * (1.0 - 1e-9) && largest < least + spread * 1.0001, "largest stiffness {largest}");
    top.is_some()
}

fn stresses(solved: &Solved, points: &[Point]) {
    let stresses: Vec<f64> = points.iter().map(|p| p.peak_stress().expect("beams").1.stress_pa).collect();
    let largest = stresses.iter().copied().fold(0.0, f64::max);
    let found = solved.get("stress_max");
    assert!(found >= largest * (1.0 - 1e-9) && found < largest * 1.001, "stress {found}, scan {largest}");
    let allowed = solved.design.common_allowable_pa().expect("a safety factor");
    let first = stresses.iter().position(|s| *s >= allowed);
    assert_eq!(first.is_some(), solved.measured.get("travel_at_allowable_stress").is_some());
    let Some(first) = first else { return };
    let (at, step) = (solved.get("travel_at_allowable_stress"), solved.design.load_end / PIECES as f64);
    assert!(at > (first as f64 - 1.0) * step && at <= first as f64 * step * (1.0 + 1e-12), "{at}, sample {first}");
    common::near(
        solved.behaviour.path.at(at).expect("on the path").peak_stress().expect("beams").1.stress_pa,
        allowed,
        1e-8,
        "stress there",
    );
}

/// The window of COMP001 against every window of samples.
fn window(text: &str, set: &[&str], solved: &Solved, forces: &[f64], nominal: Option<f64>, width: usize) {
    let travel = solved.design.load_end * width as f64 / PIECES as f64;
    let typed = format!("requirements.travel={travel:e} m");
    let outcome = outcome(text, &[set, &[typed.as_str()]].concat());
    let extents =
        forces.windows(width + 1).map(|w| w.iter().fold((f64::NEG_INFINITY, f64::INFINITY), |(hi, lo), f| (hi.max(*f), lo.min(*f))));
    let scanned = extents
        .map(|(hi, lo)| match nominal {
            Some(level) => (hi / level - 1.0).abs().max((lo / level - 1.0).abs()),
            None if lo > 0.0 => (hi - lo) / (hi + lo),
            None => f64::INFINITY,
        })
        .fold(f64::INFINITY, f64::min);
    let steepest = forces.windows(2).map(|w| (w[1] - w[0]).abs()).fold(0.0, f64::max);
    let level = nominal.unwrap_or_else(|| forces.iter().copied().fold(0.0, f64::max));
    let check = check(&outcome, "COMP001");
    if !scanned.is_finite() {
        return;
    }
    let value = check.value.expect("assessed");
    assert!(value <= scanned + 1e-5 && value > scanned - steepest / level, "window {travel}: {value}, scan {scanned}");
    // The two checks say the same: the band holds over the stroke, or the stroke fits into the band.
    let margin = check.margin.expect("assessed");
    let stroke = common::check(&outcome, "COMP003");
    assert!(margin.abs() < 1e-6 || (check.state == CheckState::Met) == (stroke.state == CheckState::Met), "{check:?} {stroke:?}");
}

#[test]
fn metrics_are_those_of_an_exhaustive_scan() {
    let (mut scanned, mut with_maximum) = (0, 0);
    for seed in 0..26 {
        let (text, set) = perturbed(seed);
        let set: Vec<&str> = set.iter().map(String::as_str).collect();
        let free = solve(&text, &set);
        if !free.behaviour.whole {
            continue;
        }
        let points = scan(&free);
        let forces: Vec<f64> = points.iter().map(|p| 2.0 * p.force).collect();
        let level = 0.9 * forces.iter().copied().fold(0.0, f64::max);
        let nominal = format!("requirements.force.nominal={level:e} N");
        let with_nominal = [&set[..], &[nominal.as_str()]].concat();
        let solved = solve(&text, &with_nominal);
        let (band, wanted) = solved.design.requirements.as_ref().and_then(|r| r.force).unwrap();
        assert!(points.len() == PIECES + 1 && wanted.is_some());
        intervals(&solved, &forces, band, wanted.unwrap());
        range(&solved, &forces);
        with_maximum += u32::from(extrema(&solved, &points, &forces));
        stresses(&solved, &points);
        for width in [32, 250, 750] {
            window(&text, &set, &free, &forces, None, width);
            window(&text, &with_nominal, &free, &forces, wanted, width);
        }
        scanned += 1;
    }
    assert!(scanned >= 20 && with_maximum >= 5, "{scanned} scanned, {with_maximum} with a maximum");
}

/// An inclined beam that snaps through, driven through a soft one: with the travel its force falls faster than the soft beam can
/// follow, so the path turns back.
fn snapping(travel: &str) -> String {
    let drawing = Drawing {
        nodes: vec![
            ("n1", [50.0, 0.0], "support = \"clamped\"".to_owned()),
            ("n2", [0.0, 5.0], guide([0.0, 1.0])),
            ("n3", [0.0, 45.0], guide([0.0, 1.0])),
        ],
        beams: vec![("arch", ["n1", "n2"], Vec::new()), ("soft", ["n2", "n3"], vec![3.0])],
        load_node: "n3",
        load_direction: [0.0, -1.0],
        travel: travel.to_owned(),
        mirror: None,
        model: "reissner",
    };
    let requirements = "[requirements]\nforce = { nominal = \"1 N\", band = 0.05 }\ntravel = \"4 mm\"\nstiffness = { max = \"1 N/mm\" }\n\
        limits = { force_at_end = { min = \"1 N\" }, mass = { max = \"1 kg\" } }\n[requirements.stress]";
    let own = "name = \"soft\"\nthickness = \"1 mm\"";
    drawing.text().replace("[requirements.stress]", requirements).replace("name = \"soft\"", own)
}

#[test]
fn metrics_of_a_curve_that_falls_below_zero_and_rises_again() {
    let mut twice = 0;
    for travel in ["6.3 mm", "7 mm", "7.4 mm", "7.8 mm", "8.2 mm", "9 mm"] {
        let set = ["design.beams.soft.thickness=2 mm", "requirements.force.band=0.2", "requirements.force.nominal=1 N"];
        let solved = solve(&snapping(travel), &set);
        let points = scan(&solved);
        let forces: Vec<f64> = points.iter().map(|p| p.force).collect();
        intervals(&solved, &forces, 0.2, 1.0);
        range(&solved, &forces);
        assert!(extrema(&solved, &points, &forces));
        let level = 0.95 * forces[PIECES];
        twice += u32::from(forces.windows(2).filter(|w| w[0] < level && w[1] >= level).count() > 1);
    }
    assert!(twice >= 2, "the force rises through the level of the paper's rule twice in {twice} of them only");
}

#[test]
fn a_path_that_turns_back() {
    let limit = |result: &forcewright_model::Outcome| {
        // It branches before: that is where a real part leaves it, and the limit point is said beside it.
        assert_eq!(result.status.kind, StatusKind::UnstableBeyond, "{:?}", result.status);
        assert!(result.status.message.contains("no neighbouring equilibrium beyond"), "{:?}", result.status);
        result.curve("force").unwrap().branches[0].x.last().copied().unwrap()
    };
    let result = outcome(&snapping("10 mm"), &[]);
    let reached = limit(&result);
    assert!(reached < 4.7e-3 && limit(&outcome(&snapping("4.71 mm"), &[])) > 4.6e-3);
    // What is about the whole travel has no value, what is about its beginning has. The force falls only where no real part comes.
    let has: Vec<&str> = result.metrics.iter().map(|m| m.name).collect();
    assert_eq!(has, ["stiffness_initial", "mass", "length_ratio_max"]);
    let all = solve(&snapping("10 mm"), &[]);
    assert!(all.get("force_local_max_at") > all.behaviour.unstable_from_m.unwrap());
    assert!(!result.warnings.iter().any(|w| w.code == "W0503") && result.warnings.iter().any(|w| w.code == "W0506"));
    for check in &result.checks {
        let about_rest = check.name == "mass";
        assert_eq!(check.state, if about_rest { CheckState::Met } else { CheckState::NotAssessed }, "{check:?}");
        assert!(about_rest || (check.value.is_none() && check.margin.is_none()), "{check:?}");
        assert!(about_rest || check.advice.as_ref().is_some_and(|a| a.contains("branches at Δ")), "{check:?}");
    }
    let codes: Vec<&str> = result.checks.iter().map(|c| c.code).collect();
    assert_eq!(codes, ["COMP001", "COMP003", "COMP002", "COMP004", "COMP005", "COMP006", "COMP006"]);
    assert!(!result.requirements_met());
    // The limit point is where it is said to be: below it the travel is complete.
    assert!(result.status.message.contains("4.69957 mm"), "{:?}", result.status);
    let turns_back = |travel: &str| outcome(&snapping(travel), &[]).status.message.contains("no neighbouring equilibrium beyond");
    assert!(!turns_back("4.6995 mm") && turns_back("4.6997 mm"));
}

#[test]
fn next_to_a_limit_point_the_largest_force_does_not_depend_on_the_stations() {
    // The soft beam is in series: it does not change the largest force of the other one.
    let stiff = solve(&snapping("20 mm"), &["design.beams.soft.thickness=2 mm"]);
    assert!(stiff.behaviour.whole);
    let place = solve(&snapping("4.699 mm"), &[]).get("force_local_max_at");
    for travel in ["5 mm", "10 mm", "30 mm"] {
        let solved = solve(&snapping(travel), &["design.beams.soft.thickness=1 mm"]);
        common::near(solved.get("force_local_max"), stiff.get("force_local_max"), 1e-7, travel);
        common::near(solved.get("force_local_max_at"), place, 1e-8, travel);
    }
}

#[test]
fn every_metric_has_a_name_once() {
    let names: Vec<&str> = METRICS.iter().map(|m| m.name).collect();
    assert!((0..names.len()).all(|i| !names[..i].contains(&names[i])));
    let solved = solve(common::NODES, &[]);
    let without: Vec<&str> = names.iter().copied().filter(|n| solved.measured.get(n).is_none()).collect();
    // Beyond the travel, or not asked for.
    let contact = ["contact_force_max", "contact_force_min", "contact_force_mean", "contact_force_spread", "transverse_force_max"];
    let of_maps = ["lateral_force_", "axial_force_", "tip_"];
    let lateral: Vec<&str> = names.iter().copied().filter(|n| of_maps.iter().any(|start| n.starts_with(start))).collect();
    assert_eq!(lateral.len(), 8);
    assert_eq!(without, [&["travel_at_allowable_stress", "envelope_margin"][..], &contact, &lateral].concat());
}
