//! A tip on a surface: closed forms of friction, energy, symmetry, offset curves, and what no tip can follow.

#![allow(clippy::disallowed_methods, reason = "the closed forms are computed in another way than the program")]

mod common;

use std::path::Path;

use common::{Random, close, near, outcome, solve, understand};
use forcewright_base::diagnostics::Diagnostics;
use forcewright_compliant::{Compliant, Contact, Design, ForceCurve, Join, Profile, Spec, Surface, SurfaceRun, TipPath, Why};
use forcewright_contract::family::Mechanism;
use forcewright_contract::project::{Choices, DiskFiles, FileError, Files, Project};
use forcewright_contract::read;
use forcewright_model::CheckState;

/// Stiffness of the spring of most tests, N/m, and its travel, m.
const K: f64 = 2000.0;
const TRAVEL: f64 = 10e-3;

/// A linear spring.
fn spring() -> ForceCurve {
    ForceCurve::new(vec![0.0, TRAVEL], vec![0.0, K * TRAVEL], vec![K, K])
}

/// A surface by points in mm, with friction of guide and tip.
fn surface(points: &[[f64; 2]], join: Join, [guide, tip]: [f64; 2]) -> Surface {
    let column = |i: usize| points.iter().map(|p| 1e-3 * p[i]).collect();
    Surface {
        path: TipPath::new(Profile::new(column(0), column(1), join), 0.0),
        preload_m: 1e-3,
        guide_friction: guide,
        guide_load: 1.0,
        tip_friction: tip,
        there_and_back: true,
    }
}

fn rounded(surface: &Surface, radius_m: f64) -> Surface {
    let path = TipPath::new(surface.path.profile().clone(), radius_m);
    Surface { path, ..surface.clone() }
}

fn run(surface: &Surface) -> SurfaceRun {
    SurfaceRun::of(surface, &spring(), TRAVEL)
}

/// On a plane the contact force makes the friction angle φ with the normal: T = A·tan(α ± φ), and the guide adds its drag times that.
#[test]
fn an_inclined_plane_is_that_of_the_textbook() {
    for (slope, guide, tip) in [(0.2, 0.0, 0.0), (0.5, 0.1, 0.0), (0.5, 0.0, 0.3), (0.4, 0.2, 0.15), (0.05, 0.3, 0.4)] {
        let plane = surface(&[[0.0, 0.0], [10.0, 10.0 * slope]], Join::Linear, [guide, tip]);
        let found = run(&plane);
        let back = found.back.as_ref().expect("it comes back");
        let (angle, friction) = (f64::atan(slope), f64::atan(tip));
        for (states, sense) in [(&found.forth.states, 1.0), (&back.states, -1.0)] {
            for c in states {
                close(c.delta_m, 1e-3 + slope * c.position_m, 1e-15, "Δ");
                near(c.elastic_n, K * c.delta_m, 1e-12, "F");
                let aside = f64::tan(angle + sense * friction);
                near(c.axial_n, K * c.delta_m / (1.0 - sense * guide * aside.abs()), 1e-12, "axial");
                close(c.transverse_n, c.axial_n * aside, 1e-12 * c.axial_n, "transverse");
                near(c.normal_n, c.axial_n * friction.cos() / (angle + sense * friction).cos(), 1e-12, "normal");
            }
        }
        let [least, largest] = found.axial_n().expect("it comes to the end");
        near(largest, found.forth.states.last().expect("states").axial_n, 1e-12, "largest");
        near(least, back.states.last().expect("states").axial_n, 1e-12, "least");
        let mean = |states: &[Contact]| f64::midpoint(states[0].axial_n, states[states.len() - 1].axial_n);
        near(found.mean_n().expect("a mean"), f64::midpoint(mean(&found.forth.states), mean(&back.states)), 1e-12, "mean");
    }
}

/// A cosine that rises by `height` mm and falls again.
fn bump(height: f64, length: f64, count: usize) -> Vec<[f64; 2]> {
    let one = |i: usize| {
        let u = i as f64 / count as f64;
        [length * u, 0.5 * height * (1.0 - (std::f64::consts::TAU * u).cos())]
    };
    (0..=count).map(one).collect()
}

/// States without those at the same place, cut where the force jumps: where the block turns.
fn smooth_runs(states: &[Contact]) -> Vec<Vec<Contact>> {
    let mut all = vec![vec![states[0]]];
    for next in &states[1..] {
        let run = all.last_mut().expect("a run");
        let last = run[run.len() - 1];
        if (next.position_m - last.position_m).abs() > 1e-12 {
            run.push(*next);
        } else if (next.axial_n / last.axial_n - 1.0).abs() > 1e-9 {
            all.push(vec![*next]);
        }
    }
    all
}

/// What friction takes: that of the tip along its way, that of the bearings along the guide. Trapezoids over all states and over every
/// second one, extrapolated.
fn losses(states: &[Contact], surface: &Surface) -> f64 {
    let between = |l: &Contact, r: &Contact| {
        let way = f64::hypot(r.position_m - l.position_m, r.delta_m - l.delta_m);
        let mean = |f: fn(&Contact) -> f64| f64::midpoint(f(l), f(r));
        let guide = surface.guide_friction * surface.guide_load * mean(|c| c.transverse_n.abs());
        surface.tip_friction * mean(|c| c.normal_n) * way + guide * (r.delta_m - l.delta_m).abs()
    };
    let one = |run: &Vec<Contact>| {
        assert!(run.len() % 2 == 1, "{} states", run.len());
        let fine: f64 = run.windows(2).map(|p| between(&p[0], &p[1])).sum();
        let coarse: f64 = run.windows(3).step_by(2).map(|p| between(&p[0], &p[2])).sum();
        fine + (fine - coarse) / 3.0
    };
    smooth_runs(states).iter().map(one).sum()
}

#[test]
fn the_stage_gives_what_the_spring_stores_and_friction_takes() {
    let stored = |m: f64| 0.5 * K * m * m;
    // Stations lie at the points of the profile, where the curvature jumps, but not where a round tip touches them; and |T| has a corner
    // where T passes zero. There the sums are of second order: 1024 points show what is left with 256.
    for (radius, free_accuracy, count, accuracy) in [(0.0, 1e-12, 256, 1e-5), (0.0, 1e-12, 1024, 6e-7), (1e-3, 1e-7, 256, 1e-5)] {
        let rise: Vec<[f64; 2]> = bump(6.0, 40.0, 256).into_iter().take(129).collect();
        let free = run(&rounded(&surface(&rise, Join::Smooth, [0.0, 0.0]), radius));
        let (first, last) = (free.forth.states[0].delta_m, free.forth.states[free.forth.states.len() - 1].delta_m);
        near(free.forth.work_j, stored(last) - stored(first), free_accuracy, "work on the way up");
        close(free.work_j(), 0.0, 1e-14, "there and back without friction");
        for friction in [[0.1, 0.0], [0.0, 0.2], [0.15, 0.25]] {
            let rough = Surface { guide_load: 1.8, ..rounded(&surface(&bump(6.0, 40.0, count), Join::Smooth, friction), radius) };
            let found = run(&rough);
            assert!(found.stop.is_none(), "{:?}", found.stop);
            let lost: f64 = found.passes().map(|p| losses(&p.states, &rough)).sum();
            assert!(lost > 1e-3, "{lost}");
            near(found.work_j(), lost, accuracy, &format!("work of a cycle, {radius} m, {friction:?}, {count} points"));
        }
    }
}

#[test]
fn a_symmetric_bump_is_the_same_from_either_side() {
    let length = 40e-3;
    for (join, radius) in [(Join::Linear, 0.0), (Join::Smooth, 0.0), (Join::Smooth, 2e-3)] {
        let found = run(&rounded(&surface(&bump(5.0, 40.0, 64), join, [0.1, 0.2]), radius));
        let back = found.back.as_ref().expect("it comes back");
        let total = |states: &[Contact], value: fn(&Contact) -> f64| states.iter().map(value).fold(0.0, f64::max);
        for value in [|c: &Contact| c.axial_n, |c: &Contact| c.normal_n, |c: &Contact| c.transverse_n.abs()] {
            near(total(&found.forth.states, value), total(&back.states, value), 1e-9, "largest");
        }
        near(found.forth.work_j, back.work_j, 1e-9, "work");
        if radius <= 0.0 {
            for (f, b) in found.forth.states.iter().zip(&back.states) {
                close(f.position_m, length - b.position_m, 1e-14, "position");
                close(f.axial_n, b.axial_n, 1e-9, "axial");
                close(f.transverse_n, -b.transverse_n, 1e-9, "transverse");
            }
        }
    }
}

/// On a line the way of a round tip is a line r(√(1 + s²) − 1) above it; around a circle it is a circle of the sum of the radii.
#[test]
fn a_round_tip_follows_the_offset_curve() {
    let (slope, r) = (0.75, 2e-3);
    let line = TipPath::new(Profile::new(vec![0.0, 40e-3], vec![0.0, 40e-3 * slope], Join::Linear), r);
    for x in [0.0, 7e-3, 31e-3] {
        let touch = line.at(x);
        close(touch.height_m, slope * x + r * (1.25 - 1.0), 1e-16, "line");
        close(touch.slope, slope, 1e-15, "slope");
        close(touch.at_m, x + r * 0.6, 1e-16, "touching point");
    }
    let circle = 30e-3;
    let arc = |x: f64| (circle * circle - x * x).sqrt() - circle;
    let wide: Vec<f64> = (-100..=100).map(|i| 15e-3 * f64::from(i) / 100.0).collect();
    let high: Vec<f64> = wide.iter().map(|x| arc(*x)).collect();
    let both = circle + r;
    let offset = |s: f64| (both * both - s * s).sqrt() - both;
    let linear = TipPath::new(Profile::new(wide.clone(), high.clone(), Join::Linear), r);
    for x in &wide {
        // Over a corner of the polygon, which lies on the arc.
        let s = x * both / circle;
        if s.abs() <= 15e-3 {
            close(linear.at(s).height_m, offset(s), 1e-15, "corner");
        }
    }
    let smooth = TipPath::new(Profile::new(wide, high, Join::Smooth), r);
    for i in -90..=90 {
        let s = 15e-3 * f64::from(i) / 100.0 + 1.234e-5;
        close(smooth.at(s).height_m, offset(s), 2e-8, "arc");
        close(smooth.at(s).slope, -s / (both * both - s * s).sqrt(), 2e-3, "slope of the arc");
    }
}

/// In a valley a round tip touches both sides and never the bottom; its way has a corner there, and so has the force.
#[test]
fn a_round_tip_does_not_reach_the_bottom_of_a_valley() {
    let (slope, r) = (0.75, 2e-3);
    let valley = rounded(&surface(&[[0.0, 7.5], [10.0, 0.0], [20.0, 7.5]], Join::Linear, [0.1, 0.1]), r);
    close(valley.path.at(10e-3).height_m, r * 0.25, 1e-15, "above the bottom");
    let found = run(&valley);
    let corner: Vec<&Contact> = found.forth.states.iter().filter(|c| (c.position_m - 10e-3).abs() < 1e-10).collect();
    let friction = f64::atan(0.1);
    let down = f64::tan(f64::atan(-slope) + friction);
    let up = f64::tan(f64::atan(slope) + friction);
    let force = K * (1e-3 + r * 0.25);
    near(corner[0].axial_n, force / (1.0 + 0.1 * down.abs()), 1e-6, "before the corner");
    near(corner[corner.len() - 1].axial_n, force / (1.0 - 0.1 * up), 1e-6, "behind the corner");
}

/// tan α = (1 − m·μ)/(m + μ).
#[test]
fn a_tip_locks_where_its_friction_says() {
    let (guide, tip) = (0.5, 0.3);
    let limit = (1.0 - guide * tip) / (guide + tip);
    for (part, locks) in [(1.0 - 1e-9, false), (1.0 + 1e-9, true)] {
        let slope = part * limit;
        let plane = surface(&[[0.0, 0.0], [2.0, 0.0], [4.0, 2.0 * slope]], Join::Linear, [guide, tip]);
        let stop = run(&plane).stop;
        assert_eq!(stop.is_some(), locks, "{stop:?}");
        if let Some(stop) = stop {
            assert_eq!(stop.why, Why::Locks);
            close(stop.position_m, 2e-3, 1e-15, "where");
            near(stop.slope, slope, 1e-12, "slope");
        }
        near(plane.locking_slope(), limit, 1e-15, "limit");
        // Downwards nothing locks.
        let down = surface(&[[0.0, 2.0 * slope], [2.0, 0.0]], Join::Linear, [guide, tip]);
        assert!(SurfaceRun::of(&Surface { there_and_back: false, ..down }, &spring(), TRAVEL).stop.is_none());
    }
    // On a cosine, where its slope passes the limit.
    let wave = Surface { guide_load: 2.0, ..surface(&bump(8.0, 20.0, 2000), Join::Smooth, [0.3, 0.4]) };
    let stop = run(&wave).stop.expect("it locks");
    let steepest = 4.0 * std::f64::consts::TAU / 20.0;
    let at = (0.76 / 1.0 / steepest).asin() / std::f64::consts::TAU * 20e-3;
    close(stop.position_m, at, 2e-7, "on the cosine");
    assert!(run(&Surface { guide_friction: 0.0, tip_friction: 0.0, ..wave }).stop.is_none());
}

/// Before it has moved the block hangs in its balance; after a rise the bearings hold it back at their limit, until the stage turns.
#[test]
fn friction_stays_at_a_constant_height_until_the_stage_turns() {
    let (guide, tip) = (0.3, 0.2);
    let table = surface(&[[0.0, 0.0], [5.0, 0.0], [10.0, 2.0], [15.0, 2.0]], Join::Linear, [guide, tip]);
    let found = run(&table);
    let back = &found.back.as_ref().expect("it comes back").states;
    let (low, high) = (K * 1e-3, K * 3e-3);
    near(found.forth.states[0].axial_n, low, 1e-12, "at the start");
    near(found.forth.states.last().expect("states").axial_n, high / (1.0 - guide * tip), 1e-12, "after the rise");
    near(back[0].axial_n, high, 1e-12, "after the turn");
    near(back[back.len() - 1].axial_n, low / (1.0 + guide * tip), 1e-12, "after the fall");
    assert_eq!(found.flats.len(), 2);
    for (flat, force) in found.flats.iter().zip([low, high]) {
        near(flat.axial_n[0], force / (1.0 + guide * tip), 1e-12, "band");
        near(flat.axial_n[1], force / (1.0 - guide * tip), 1e-12, "band");
    }
    assert!(run(&Surface { tip_friction: 0.0, ..table }).flats.is_empty(), "without friction at the tip nothing is open");
}

#[test]
fn what_the_mechanism_does_not_reach_is_a_result() {
    // A ditch deeper than the preload: 1 mm of 2.
    let ditch = surface(&[[0.0, 0.0], [10.0, -2.0], [20.0, 0.0]], Join::Linear, [0.0, 0.0]);
    let found = run(&ditch);
    close(found.lifts_at_m().expect("it lifts"), 5e-3, 1e-12, "where the tip leaves");
    let [least, largest] = found.axial_n().expect("it comes to the end");
    assert!(least.abs() < 1e-9, "{least}");
    near(largest, K * 1e-3, 1e-12, "largest");
    near(found.mean_n().expect("a mean"), 0.5 * K * 1e-3, 1e-9, "mean in contact");
    near(found.forth.contact_m, 10e-3, 1e-9, "way in contact");
    // A hill beyond the travel.
    let hill = surface(&[[0.0, 0.0], [20.0, 12.0]], Join::Linear, [0.0, 0.0]);
    let found = run(&hill);
    let stop = found.stop.expect("it stops");
    assert_eq!(stop.why, Why::Beyond);
    close(stop.position_m, 9e-3 / 0.6, 1e-12, "where the travel ends");
    assert!(found.axial_n().is_none() && found.back.is_none() && found.mean_n().is_none());
    // A mechanism that pulls from 4 mm on: F = k·Δ·(1 − Δ/4 mm).
    let x: Vec<f64> = (0..=64).map(|i| 10e-3 * f64::from(i) / 64.0).collect();
    let force = |x: &f64| K * x * (1.0 - x / 4e-3);
    let slope = |x: &f64| K * (1.0 - 2.0 * x / 4e-3);
    let bistable = ForceCurve::new(x.clone(), x.iter().map(force).collect(), x.iter().map(slope).collect());
    let stop = SurfaceRun::of(&hill, &bistable, TRAVEL).stop.expect("it stops");
    assert_eq!(stop.why, Why::LetsGo);
    close(stop.position_m, 3e-3 / 0.6, 1e-10, "where the force ends");
    // Never in contact.
    let gap = Surface { preload_m: -10e-3, ..hill };
    let stop = run(&gap);
    assert!(stop.stop.is_none() && stop.axial_n().is_some(), "it touches at 10 of 12 mm");
    assert!(run(&Surface { preload_m: -13e-3, ..gap }).axial_n().is_none());
}

/// Positions far from zero have few digits left between them.
#[test]
fn a_narrow_surface_far_away_is_followed() {
    let far = surface(&[[9e4, 1.0], [9e4 + 1e-7, 1.0 + 1e-8], [9e4 + 2e-7, 1.0]], Join::Smooth, [0.1, 0.1]);
    assert!(run(&rounded(&far, 1e-6)).axial_n().is_some());
}

/// Any profile gives a result: finite forces, positions in order.
#[test]
fn nothing_on_any_profile_panics() {
    let mut random = Random(7);
    for case in 0..400_usize {
        let count = 2 + case % 8;
        let mut x = 0.0;
        let points: Vec<[f64; 2]> = (0..count)
            .map(|_| {
                x += 10.0_f64.powf(random.between(-4.0, 1.0));
                [x, if random.unit() < 0.3 { 1.0 } else { random.between(-3.0, 12.0) }]
            })
            .collect();
        let join = if random.unit() < 0.5 { Join::Linear } else { Join::Smooth };
        let friction = [random.between(0.0, 0.3), random.between(0.0, 0.3)];
        let radius = if random.unit() < 0.3 { 0.0 } else { 10.0_f64.powf(random.between(-6.0, -1.0)) };
        let found = run(&rounded(&surface(&points, join, friction), radius));
        for (pass, sense) in found.passes().zip([1.0, -1.0]) {
            assert!(pass.states.windows(2).all(|p| sense * (p[1].position_m - p[0].position_m) >= 0.0), "case {case}: positions turn");
            let all = |c: &Contact| [c.axial_n, c.normal_n, c.transverse_n, c.delta_m].iter().all(|v| v.is_finite()) && c.axial_n >= 0.0;
            assert!(pass.states.iter().all(all) && pass.work_j.is_finite(), "case {case}: {pass:?}");
        }
        if let Some([least, largest]) = found.axial_n() {
            let mean = found.mean_n().expect("a mean");
            assert!(least <= mean * (1.0 + 1e-9) && mean <= largest * (1.0 + 1e-9), "case {case}: {least} {mean} {largest}");
        }
    }
}

// ------------------------------------------------------------------------------------------------------------------- the project file

/// A leaf spring between a clamp and a guided block.
const LEAF: &str = r#"
schema = 1
mechanism = "compliant"
[material]
young_modulus = "200 GPa"
poisson_ratio = 0.3
yield_stress = "1000 MPa"
[design]
thickness = "0.5 mm"
depth = "10 mm"
[design.nodes]
foot = { at = ["0 mm", "0 mm"], support = "clamped" }
block = { at = ["50 mm", "0 mm"], support = "slider", direction = [0, 1] }
[[design.beams]]
name = "leaf"
between = ["foot", "block"]
straight = true
[load]
node = "block"
direction = [0, 1]
travel = "0.01 mm"
[scenario.surface]
preload = "0.001 mm"
"#;

/// The leaf with more lines of its scenario.
fn leaf(lines: &str) -> String {
    format!("{LEAF}{lines}\n")
}

const PLANE: &str = "profile = [[\"0 mm\", \"0 mm\"], [\"0.01 mm\", \"0.005 mm\"]]";

/// F = kΔ with Timoshenko's stiffness of a guided beam, on a plane with friction in two bearings.
#[test]
fn a_leaf_spring_on_a_plane_has_the_closed_form() {
    let lines = "guide_friction = 0.1\nguide_span = \"20 mm\"\noverhang = \"15 mm\"\ntip_friction = 0.2\nreturn = true";
    let found = outcome(&leaf(&format!("{PLANE}\n{lines}")), &[]);
    let (e, i, area, length) = (200e9, 10e-3 * 0.5e-3_f64.powi(3) / 12.0, 5e-6, 50e-3_f64);
    let shear = 5.0 / 6.0 * area * e / 2.6;
    let k = 12.0 * e * i / length.powi(3) / (1.0 + 12.0 * e * i / (shear * length * length));
    // Bearing forces T(1 + a/b) and T·a/b with a/b = 3/4.
    let drag = 0.1 * 2.5;
    let aside = |sense: f64| f64::tan(0.5_f64.atan() + sense * 0.2_f64.atan());
    let metric = |name: &str| found.metrics.iter().find(|m| m.name == name).unwrap_or_else(|| panic!("no {name}")).value;
    // The membrane stiffens the leaf by some (Δ/w)², here 1e-4.
    near(metric("contact_force_max"), k * 6e-6 / (1.0 - drag * aside(1.0)), 4e-4, "largest");
    near(metric("contact_force_min"), k * 1e-6 / (1.0 + drag * aside(-1.0).abs()), 4e-4, "least");
    near(metric("transverse_force_max"), aside(1.0) * metric("contact_force_max"), 1e-9, "aside");
    let (least, most) = (metric("contact_force_min"), metric("contact_force_max"));
    near(metric("contact_force_spread"), (most - least) / (most + least), 1e-12, "spread");
    assert!(metric("contact_force_mean") > least && metric("contact_force_mean") < most);
    let contact = found.curves.iter().find(|c| c.name == "contact").expect("a curve");
    assert_eq!(contact.branches.iter().map(|b| b.name.as_str()).collect::<Vec<_>>(), ["forth", "back"]);
    assert!(found.warnings.iter().all(|w| !w.code.starts_with("W052")), "{:?}", found.warnings);
}

#[test]
fn limits_on_the_contact_are_checked() {
    let with = |limit: &str, lines: &str| {
        let text = leaf(lines).replace("[material]", &format!("[requirements.limits]\n{limit}\n[material]"));
        let found = outcome(&text, &[]);
        let check = common::check(&found, "COMP006");
        (check.state, check.advice.clone().unwrap_or_default(), found.status.message.clone())
    };
    let most = "contact_force_max = { max = \"100 N\" }";
    assert_eq!(with(most, PLANE).0, CheckState::Met);
    assert_eq!(with("contact_force_min = { min = \"100 N\" }", PLANE).0, CheckState::Missed);
    // Where the tip locks, the force grows without limit, but a smallest force is not known.
    let (state, advice, status) = with(most, &format!("{PLANE}\nguide_friction = 2"));
    assert!(state == CheckState::Missed && advice.contains("locks") && status.contains("locks"), "{state:?} {advice} {status}");
    assert_eq!(with("contact_force_min = { min = \"1e-9 N\" }", &format!("{PLANE}\nguide_friction = 2")).0, CheckState::NotAssessed);
    let (state, advice, _) = with(most, "profile = [[\"0 mm\", \"0 mm\"], [\"1 mm\", \"1 mm\"]]");
    assert!(state == CheckState::NotAssessed && advice.contains("asks for more"), "{state:?} {advice}");
    let text = LEAF.split("[scenario").next().expect("a text").replace("[material]", &format!("[requirements.limits]\n{most}\n[material]"));
    let found = outcome(&text, &[]);
    assert!(common::check(&found, "COMP006").advice.as_ref().is_some_and(|a| a.contains("scenario.surface")));
    let solved = solve(&text, &[]);
    assert!(solved.measured.surface.is_none() && solved.measured.get("contact_force_max").is_none());
}

#[test]
fn warnings_say_what_the_tip_does() {
    let codes = |lines: &str, set: &[&str]| -> Vec<&str> {
        let found = outcome(&leaf(lines), set);
        found.warnings.iter().map(|w| w.code).filter(|c| c.starts_with("W052")).collect()
    };
    assert_eq!(codes(&format!("{PLANE}\nguide_friction = 2"), &[]), ["W0520"]);
    assert_eq!(codes(PLANE, &["scenario.surface.preload=-0.002 mm"]), ["W0521"]);
    assert_eq!(codes(PLANE, &["scenario.surface.preload=0.009 mm"]), ["W0522"]);
    assert!(codes(PLANE, &[]).is_empty());
    assert!(codes(PLANE, &["scenario.surface.preload=0 mm"]).is_empty(), "it touches everywhere but at a point");
}

struct Pair<'a>(&'a str, &'a str);

impl Files for Pair<'_> {
    fn read(&self, path: &Path) -> Result<String, FileError> {
        match path.to_str() {
            Some("test.toml") => Ok(self.0.to_owned()),
            Some("bump.csv") => Ok(self.1.to_owned()),
            _ => Err(FileError::NotFound),
        }
    }
}

/// A project with a file beside it: its design, or its codes with line and file.
fn beside(text: &str, csv: &str) -> Result<Design, Vec<(&'static str, String)>> {
    let mut project = Project::load(&Pair(text, csv), Path::new("test.toml"), &Choices::default());
    let mut spec: Spec = read::read(&project.tree, project.root, &mut project.diagnostics);
    let design = Compliant::resolve(&mut spec, &mut project.diagnostics);
    if let Some(design) = design.filter(|_| !project.diagnostics.has_errors()) {
        return Ok(design);
    }
    let rendered = |d: &forcewright_base::diagnostics::Diagnostic| {
        let mut one = Diagnostics::default();
        one.push(d.clone());
        (d.code, one.render(&project.sources, false))
    };
    Err(project.diagnostics.in_file_order().into_iter().map(rendered).collect())
}

#[test]
fn a_profile_stands_in_a_file_with_units() {
    let text = leaf("profile_file = \"bump.csv\"\njoin = \"smooth\"");
    let csv = "# a cam\nposition / µm; height / mm\n0; 0\n4; 0.001\n10; 0.005\n";
    let design = beside(&text, csv).expect("understood");
    let path = &design.surface.as_ref().expect("a surface").path;
    assert_eq!(path.profile().positions_m(), [0.0, 4e-6, 10e-6]);
    assert_eq!(path.profile().heights_m(), [0.0, 1e-6, 5e-6]);
    let wrong = [
        ("position / mm, height / mm\n0, 0\n2, 1\n1, 1\n", "E0520", "bump.csv:4"),
        ("position / mm, height / mm\n0, 0\n1, 0\n1, 1\n2, 1\n", "E0520", "bump.csv:4"),
        ("position / mm, height / mm\n0, 0\n", "E0520", "bump.csv:2"),
        ("position / mm, height / mm\n0, 0\n1, nan\n", "E0205", "bump.csv:3"),
        ("position / mm, height / mm\n0, 0\n1, 1e9\n", "E0520", "bump.csv:3"),
        ("position / mm, height / N\n0, 0\n1, 1\n", "E0201", "bump.csv:1"),
        ("position, height\n0, 0\n1, 1\n", "E0208", "bump.csv:1"),
        ("position / mm, height / mm\n", "E0112", "bump.csv"),
        ("", "E0112", "bump.csv"),
    ];
    for (csv, code, place) in wrong {
        let found = beside(&text, csv).expect_err(csv);
        assert!(found.iter().any(|(c, text)| *c == code && text.contains(place)), "{csv:?} {found:?}");
    }
}

#[test]
fn a_scenario_that_cannot_be_played_is_refused() {
    let refused = |text: &str| -> Vec<&'static str> {
        let (design, diagnostics) = understand(text, &[]);
        assert!(design.is_none(), "{text}");
        diagnostics.in_file_order().iter().map(|d| d.code).collect()
    };
    assert_eq!(refused(&leaf("")), ["E0302"]);
    assert_eq!(refused(&leaf(PLANE).replace("preload = \"0.001 mm\"", "")), ["E0302"]);
    assert_eq!(refused(&leaf(PLANE).replace("[scenario.surface]", "[scenario]")), ["E0301", "E0301"]);
    assert_eq!(refused(&leaf("profile = []")), ["E0520"]);
    assert_eq!(refused(&leaf("profile = [[\"0 mm\", \"0 mm\"]]")), ["E0520"]);
    assert_eq!(refused(&leaf("profile = [[\"1 mm\", \"0 mm\"], [\"0 mm\", \"0 mm\"]]")), ["E0520"]);
    assert_eq!(refused(&leaf(&format!("{PLANE}\noverhang = \"3 mm\""))), ["E0302"]);
    assert_eq!(refused(&leaf(&format!("{PLANE}\nguide_span = \"3 mm\""))), ["E0302"]);
    assert_eq!(refused(&leaf(&format!("{PLANE}\nprofile_file = \"none.csv\""))), ["E0101"]);
    assert_eq!(refused(&leaf(PLANE).replace("travel = \"0.01 mm\"", "force = \"1 N\"")), ["E0521"]);
    assert_eq!(refused(&leaf(PLANE).replace(", support = \"slider\", direction = [0, 1]", "")), ["E0521"]);
    assert_eq!(refused(&leaf(&format!("{PLANE}\nguide_friction = -0.1"))), ["E0204"]);
    let both = leaf(&format!("{PLANE}\nprofile_file = \"bump.csv\""));
    let found = beside(&both, "position / mm, height / mm\n0, 0\n1, 1\n").expect_err("both");
    assert_eq!(found.iter().map(|f| f.0).collect::<Vec<_>>(), ["E0305"]);
}

/// Section IV says 8 N to 8.59 N over a cam of 5 mm. With the largest force at the top the foot has none; with the foot at 8 N the top has
/// far more; 3.2 mm are what the legs of Table 4 follow, and plain bearings and a metal tip leave even that.
#[test]
fn the_end_effector_of_the_paper_follows_three_millimetres() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../examples/compliant/lan-end-effector-surface.toml");
    let range = |variant: Option<&str>| {
        let choices = Choices { variant: variant.map(str::to_owned), set: Vec::new() };
        let mut project = Project::load(&DiskFiles, &path, &choices);
        let mut spec: Spec = read::read(&project.tree, project.root, &mut project.diagnostics);
        let design = Compliant::resolve(&mut spec, &mut project.diagnostics);
        let design = design.unwrap_or_else(|| panic!("{}", project.diagnostics.render(&project.sources, false)));
        let metrics = Compliant::analyse(&design, &mut |_| true).outcome.metrics;
        let of = |name: &str| metrics.iter().find(|m| m.name == name).unwrap_or_else(|| panic!("no {name}")).value;
        [of("contact_force_min"), of("contact_force_max")]
    };
    let [foot, top] = range(None);
    // COMP-7: the force of eight legs at 5 mm.
    assert!(foot.abs() < 1e-9, "{foot}");
    near(top, 8.5648, 1e-5, "top of the cam");
    let [foot, top] = range(Some("preloaded"));
    assert!(foot > 8.0 && top > 13.0, "{foot} {top}");
    let [least, largest] = range(Some("low"));
    assert!(least > 8.0 && largest < 8.59, "{least} {largest}");
    let [least, largest] = range(Some("low-rough"));
    assert!(least < 7.95 && largest > 8.9, "{least} {largest}");
}
