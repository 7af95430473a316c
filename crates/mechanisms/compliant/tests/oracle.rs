//! Closed forms and laws, at the level of the project file.

mod common;
#[path = "common/drawing.rs"]
mod drawing;

use common::{NODES, check, close, near, outcome, solve, understand};
use drawing::{Drawing, guide};
use forcewright_base::maths;
use forcewright_compliant::{Compliant, Design};
use forcewright_contract::family::Mechanism;
use forcewright_model::{CheckState, StatusKind};

const UP: [f64; 2] = [0.0, 1.0];
const INEXTENSIBLE: &str = "model.beam=inextensible";

/// Length, EI, shear flexibility L/κGA of the first beam.
fn data(design: &Design) -> (f64, f64, f64) {
    let beam = &design.network.beams[0];
    (beam.shape.length_m(), beam.section.bending_stiffness_n_m2(), beam.shape.length_m() / beam.section.shear_stiffness_n())
}

#[test]
fn guided_beam_at_small_deflection() {
    let text = Drawing::straight(&guide(UP), UP, "0.001 mm", "reissner").text();
    let solved = solve(&text, &[]);
    let (length, ei, shear) = data(&solved.design);
    close(ei, 2e9 * 1e-9 * 1e-2 / 12.0, 1e-18, "EI");
    let bending = length * length * length / (12.0 * ei);
    near(solved.get("stiffness_initial"), 1.0 / (bending + shear), 1e-11, "12EI/L³ with Timoshenko's shear");
    near(solved.get("force_at_end"), solved.get("stiffness_initial") * 1e-6, 1e-6, "force");
    near(solved.get("stiffness_initial"), 12.0 * ei / (length * length * length), 3.3e-4, "12EI/L³");
}

#[test]
fn guided_beam_stiffens_by_stretching() {
    // With the shape of small deflections the strain is 3/5 (Δ/L)², so F = kΔ + 18/25 EA (Δ/L)³ + …
    let text = Drawing::straight(&guide(UP), UP, "0.02 mm", "reissner").text();
    let solved = solve(&text, &[]);
    let (length, ..) = data(&solved.design);
    let stretch = |x: f64| (solved.behaviour.path.at(x).unwrap().force - solved.get("stiffness_initial") * x) / (x * x * x);
    let limit = (4.0 * stretch(1e-5) - stretch(2e-5)) / 3.0;
    let ea = solved.design.network.beams[0].section.axial_stiffness_n();
    near(limit, 18.0 / 25.0 * ea / (length * length * length), 5e-4, "cubic term");
}

#[test]
fn an_inextensible_straight_beam_across_its_guide_is_over_constrained() {
    let text = Drawing::straight(&guide(UP), UP, "1 mm", "inextensible").text();
    let result = outcome(&text, &[]);
    assert_eq!(result.status.kind, StatusKind::NotConverged);
    assert!(result.status.message.contains("`b1`") && result.status.message.contains("over-constrained"), "{}", result.status.message);
    assert!(result.status.advice.as_deref().is_some_and(|a| a.contains("reissner")), "{:?}", result.status.advice);
    assert!(result.metric("force_at_end").is_none());
    assert!(!result.requirements_met());
    // The advice works.
    assert_eq!(outcome(&text, &["model.beam=reissner"]).status.kind, StatusKind::Complete);
    assert_eq!(outcome(&text, &["design.beams.b1={between=[\"n1\",\"n2\"],straight=false,bend=[0.2]}"]).status.kind, StatusKind::Complete);
}

#[test]
fn cantilever_with_a_moved_end() {
    let text = |travel: &str, model| Drawing::straight("", UP, travel, model).text();
    let solved = solve(&text("1 mm", "inextensible"), &[]);
    let (length, ei, shear) = data(&solved.design);
    let bending = length * length * length / (3.0 * ei);
    near(solved.get("stiffness_initial"), 1.0 / bending, 1e-11, "3EI/L³");
    let solved = solve(&text("1 mm", "reissner"), &[]);
    near(solved.get("stiffness_initial"), 1.0 / (bending + shear), 1e-11, "with Timoshenko's shear");
    near(solved.get("stress_max"), 0.3e6, 2e-4, "σ = 3 E w Δ/2 L² at the clamp, small deflection");
    // K. Mattiasson, "Numerical results from large deflection beam and frame problems analysed by means of elliptic integrals", Int. J.
    // Numer. Meth. Engng 17 (1981): P L²/EI and w/L to five digits.
    for (load, deflection) in [(1.0, 0.30172), (5.0, 0.71379), (10.0, 0.81061)] {
        let solved = solve(&text(&format!("{} mm", 100.0 * deflection), "inextensible"), &[]);
        let slope = solved.behaviour.path.points.last().unwrap().stiffness * 5e-6 * length;
        close(solved.get("force_at_end"), load * ei / (length * length), 1.1 * slope, "elliptic integrals");
    }
}

#[test]
fn hinges_and_turning_sliders_carry_no_moment() {
    let guided = Drawing::straight(&guide(UP), UP, "0.001 mm", "reissner").text();
    let hinged = guided.replace("straight = true", "straight = true\nhinged = [\"n2\"]");
    let turning = guided.replace("support = \"slider\"", "support = \"slider\", rotation = \"free\"");
    assert!(hinged != guided && turning != guided);
    for text in [hinged, turning] {
        let solved = solve(&text, &[]);
        let (length, ei, shear) = data(&solved.design);
        near(solved.get("stiffness_initial"), 1.0 / (length * length * length / (3.0 * ei) + shear), 1e-11, "3EI/L³ with shear");
        close(solved.behaviour.path.points.last().unwrap().beams[0].end_moment_nm, 0.0, 1e-12, "moment at the end");
    }
    // Two halves of a beam on pins, pushed in the middle: 48 EI/L³ of the whole.
    let mut pinned = Drawing::straight(&guide(UP), UP, "0.001 mm", "reissner");
    pinned.nodes[0].2 = "support = \"pinned\"".to_owned();
    pinned.mirror = Some("x = 100 mm".to_owned());
    let solved = solve(&pinned.text(), &[]);
    let (length, ei, shear) = data(&solved.design);
    near(solved.get("stiffness_initial"), 2.0 / (length * length * length / (3.0 * ei) + shear), 1e-11, "48 EI/(2L)³ with shear");
}

#[test]
fn energy_is_the_work_of_the_force() {
    for set in [&[][..], &[INEXTENSIBLE], &["load.travel=17 mm", "design.thickness=0.85 mm"]] {
        let solved = solve(NODES, set);
        let points = &solved.behaviour.path.points;
        // Trapezoids with the slopes at both ends: exact for the cubic between stations.
        let piece = |a: &forcewright_beam::Point, b: &forcewright_beam::Point| {
            let h = b.displacement - a.displacement;
            0.5 * h * (a.force + b.force) + h * h / 12.0 * (a.stiffness - b.stiffness)
        };
        let work: f64 = points.windows(2).map(|w| piece(&w[0], &w[1])).sum();
        near(solved.get("energy_at_end"), 2.0 * work, 1e-9, "work");
        // F = dU/dΔ, by differences of fifth order.
        let energy = |x: f64| solved.behaviour.path.at(x).unwrap().energy_j;
        for x in [1e-3, 5e-3, 1.1e-2] {
            let h = 5e-5;
            let slope = (energy(x - 2.0 * h) - 8.0 * energy(x - h) + 8.0 * energy(x + h) - energy(x + 2.0 * h)) / (12.0 * h);
            near(slope, solved.behaviour.path.at(x).unwrap().force, 1e-8, "dU/dΔ");
        }
    }
}

#[test]
fn scaling_law_of_the_paper() {
    // Eq. (6): F Lx²/EI depends on Δ/Lx alone, for any section.
    let base = Drawing { model: "inextensible", ..Drawing::table3() };
    let scaled = Drawing { travel: "34 mm".to_owned(), ..base.clone() }.moved(|[x, y]| [2.5 * x, 2.5 * y]);
    let (a, b) = (
        solve(&base.text(), &[]),
        solve(&scaled.text(), &["design.thickness=1.3 mm", "design.depth=7 mm", "material.young_modulus=3 GPa"]),
    );
    let factor = 1.5 * 1.3 * 1.3 * 1.3 * 0.7 / (2.5 * 2.5);
    near(b.get("force_at_end"), factor * a.get("force_at_end"), 1e-12, "force");
    near(b.get("range_ratio"), a.get("range_ratio"), 1e-12, "range");
    near(b.get("stiffness_min"), factor / 2.5 * a.get("stiffness_min"), 1e-8, "stiffness");
    near(b.get("stress_max"), 1.5 * 1.3 / 2.5 * a.get("stress_max"), 1e-12, "stress");
    near(b.get("energy_at_end"), 2.5 * factor * a.get("energy_at_end"), 1e-12, "energy");
}

#[test]
fn similar_mechanisms_with_stretching() {
    // With every length doubled, thickness and depth too, forces grow by four and stresses stay.
    let base = Drawing::table3();
    let scaled = Drawing { travel: "27.2 mm".to_owned(), ..base.clone() }.moved(|[x, y]| [2.0 * x, 2.0 * y]);
    let (a, b) = (solve(&base.text(), &[]), solve(&scaled.text(), &["design.thickness=2 mm", "design.depth=20 mm"]));
    near(b.get("force_at_end"), 4.0 * a.get("force_at_end"), 1e-12, "force");
    near(b.get("stress_max"), a.get("stress_max"), 1e-12, "stress");
    near(b.get("mass"), 8.0 * a.get("mass"), 1e-13, "mass");
    near(b.get("length_ratio_max"), a.get("length_ratio_max"), 1e-14, "length ratio");
}

#[test]
fn force_is_proportional_to_depth_and_modulus() {
    let a = solve(NODES, &[]);
    for (set, factor, stress) in [
        ("design.depth=20 mm", 2.0, 1.0),
        ("design.depth=13 mm", 1.3, 1.0),
        ("design.depth=0.37 mm", 0.037, 1.0),
        ("material.young_modulus=7 GPa", 3.5, 3.5),
    ] {
        let b = solve(NODES, &[set]);
        for (metric, factor) in [("force_at_end", factor), ("energy_at_end", factor), ("stress_max", stress), ("range_start", 1.0)] {
            near(b.get(metric), factor * a.get(metric), 2e-14, &format!("{metric} with {set}"));
        }
        // Found by a search, to the square root of rounding.
        near(b.get("stiffness_min"), factor * a.get("stiffness_min"), 1e-12, set);
    }
}

#[test]
fn force_of_inextensible_beams_is_proportional_to_the_cube_of_thickness() {
    let a = solve(NODES, &[INEXTENSIBLE]);
    for (typed, w) in [("design.thickness=2 mm", 2.0), ("design.thickness=0.85 mm", 0.85)] {
        let b = solve(NODES, &[INEXTENSIBLE, typed]);
        near(b.get("force_at_end"), w * w * w * a.get("force_at_end"), 1e-13, "force");
        near(b.get("stress_max"), w * a.get("stress_max"), 1e-13, "stress");
        near(b.get("range_start"), a.get("range_start"), 1e-12, "range");
    }
}

/// Half of two curved beams that meet in a guided node on the line x = 0.
fn half() -> Drawing {
    Drawing {
        nodes: vec![("n1", [30.0, 0.0], "support = \"clamped\"".to_owned()), ("n2", [0.0, 20.0], guide(UP))],
        beams: vec![("b1", ["n1", "n2"], vec![0.8, -1.1])],
        load_node: "n2",
        load_direction: [0.0, -1.0],
        travel: "8 mm".to_owned(),
        mirror: None,
        model: "reissner",
    }
}

#[test]
fn a_mirrored_layout_is_twice_its_half_and_the_whole_drawn() {
    let half = half();
    let mirrored = Drawing { mirror: Some("x = 0".to_owned()), ..half.clone() };
    let mut whole = half.clone();
    whole.nodes.push(("n3", [-30.0, 0.0], "support = \"clamped\"".to_owned()));
    // The mirror image turns the other way.
    whole.beams.push(("b2", ["n3", "n2"], vec![-0.8, 1.1]));
    // Nothing guides the node of the whole: its symmetry does.
    let mut free = whole.clone();
    free.nodes[1].2 = String::new();
    for model in ["reissner", "inextensible"] {
        let solve = |d: &Drawing| solve(&Drawing { model, ..d.clone() }.text(), &[]);
        let (one, two, drawn, unguided) = (solve(&half), solve(&mirrored), solve(&whole), solve(&free));
        for metric in ["force_at_end", "energy_at_end", "stiffness_initial", "mass"] {
            near(two.get(metric), 2.0 * one.get(metric), 1e-15, metric);
            near(drawn.get(metric), two.get(metric), 1e-11, metric);
            near(unguided.get(metric), two.get(metric), 1e-11, metric);
        }
        for metric in ["stress_max", "range_start", "flat_ratio", "length_ratio_max"] {
            near(drawn.get(metric), two.get(metric), 1e-9, metric);
            assert!(two.get(metric).to_bits() == one.get(metric).to_bits(), "{metric}");
        }
        let node = unguided.behaviour.path.points.last().unwrap().nodes[1];
        close(node.rotation_rad, 0.0, 1e-12, "rotation on the mirror line");
        close(node.displacement_m[0], 0.0, 1e-15, "displacement across the mirror line");
    }
}

#[test]
fn a_mirror_line_anywhere_is_as_good() {
    let at = |line: &str| {
        let drawing = Drawing { mirror: Some(line.to_owned()), ..half() };
        solve(&drawing.text(), &[]).get("force_at_end").to_bits()
    };
    assert!(at("x = 0") == at("x = 7 mm") && at("x = 0") == at("x = -0.3 in"));
}

#[test]
fn mirrored_turned_and_moved_mechanisms_are_the_same() {
    let base = Drawing::table3();
    let negated = |d: Drawing| {
        let beams = d.beams.iter().map(|(n, b, bend)| (*n, *b, bend.iter().map(|c| -c).collect())).collect();
        Drawing { beams, ..d }
    };
    // x and y swapped: a reflection, which turns bends round.
    let mut swapped = negated(base.clone().moved(|[x, y]| [y, x]));
    swapped.nodes[4].2 = guide([1.0, 0.0]);
    (swapped.load_direction, swapped.mirror) = ([-1.0, 0.0], Some("y = 0".to_owned()));
    // Reflected about x = 0.
    let reflected = negated(base.clone().moved(|[x, y]| [-x, y]));
    // Turned by an angle: no mirror line is parallel to an axis, so the half is compared.
    let (sin, cos) = maths::sin_cos(0.6);
    let mut turned = base.clone().moved(|[x, y]| [cos * x - sin * y, sin * x + cos * y]);
    turned.nodes[4].2 = guide([-sin, cos]);
    (turned.load_direction, turned.mirror) = ([3.0 * sin, -3.0 * cos], None);
    let mut moved = base.clone().moved(|[x, y]| [x + 100.0, y - 1000.0]);
    moved.mirror = Some("x = 100 mm".to_owned());
    let a = solve(&base.text(), &[]);
    for (drawing, copies, what) in
        [(swapped, 2.0, "swapped"), (reflected, 2.0, "reflected"), (turned, 1.0, "turned"), (moved, 2.0, "moved")]
    {
        let b = solve(&drawing.text(), &[]);
        for (metric, want) in
            [("force_at_end", 0.5 * copies), ("energy_at_end", 0.5 * copies), ("stress_max", 1.0), ("length_ratio_max", 1.0)]
        {
            near(b.get(metric), want * a.get(metric), 2e-11, &format!("{what}: {metric}"));
        }
        near(b.get("stiffness_min"), 0.5 * copies * a.get("stiffness_min"), 1e-8, what);
        near(b.get("flat_ratio"), a.get("flat_ratio"), 1e-9, what);
    }
}

#[test]
fn a_beam_may_be_drawn_from_either_end() {
    let a = solve(&Drawing::table3().text(), &[]);
    for turned in 0..4 {
        let mut drawing = Drawing::table3();
        let (_, between, bend) = &mut drawing.beams[turned];
        between.reverse();
        // η(1 − v) of a quadratic.
        *bend = vec![-bend[0] - 2.0 * bend[1], bend[1]];
        let b = solve(&drawing.text(), &[]);
        for metric in ["force_at_end", "energy_at_end", "stress_max", "stiffness_initial"] {
            near(b.get(metric), a.get(metric), 1e-10, metric);
        }
        near(b.get("stiffness_min"), a.get("stiffness_min"), 1e-8, "least stiffness");
    }
}

#[test]
fn an_arc_is_a_bend_of_one_coefficient() {
    let text = half().text();
    let arc = text.replace("bend = [0.8, -1.1]", "arc = \"45 deg\"");
    let bend = text.replace("bend = [0.8, -1.1]", &format!("bend = [{:?}]", std::f64::consts::FRAC_PI_4));
    assert!(arc != text && bend != text);
    near(solve(&arc, &[]).get("force_at_end"), solve(&bend, &[]).get("force_at_end"), 1e-14, "force");
    // 30 deg over a chord of 36 mm: length over chord is (φ/2)/sin(φ/2).
    let arc = solve(&arc, &[]);
    let half_angle = std::f64::consts::FRAC_PI_8;
    near(arc.get("length_ratio_max"), half_angle / maths::sin(half_angle), 1e-14, "length over chord");
}

#[test]
fn mass_counts_every_copy() {
    let solved = solve(NODES, &["material.density=1400 kg/m^3"]);
    let length: f64 = solved.design.network.beams.iter().map(|b| b.shape.length_m()).sum();
    near(solved.get("mass"), 2.0 * 1400.0 * 1e-3 * 1e-2 * length, 1e-14, "mass");
}

#[test]
fn a_load_across_the_mirror_line_is_refused() {
    let text = Drawing { load_direction: [1e-3, -1.0], ..Drawing::table3() }.text();
    let (design, diagnostics) = understand(&text, &[]);
    assert!(design.is_none());
    assert_eq!(diagnostics.in_file_order().iter().map(|d| d.code).collect::<Vec<_>>(), ["E0508"]);
}

#[test]
fn the_analysis_can_be_stopped() {
    let design = common::design(NODES, &[]);
    let mut calls = 0;
    let analysis = Compliant::analyse(&design, &mut |_| {
        calls += 1;
        calls < 20
    });
    assert_eq!(analysis.outcome.status.kind, StatusKind::Interrupted);
    assert!(analysis.outcome.metric("force_at_end").is_none(), "the travel was not reached");
    assert!(!analysis.outcome.requirements_met());
}

/// One beam from a clamp at the origin to the node b, which is pushed down.
fn one_beam(thickness: &str, b: &str, shape: &str, travel: &str) -> String {
    format!(
        r#"
schema = 1
mechanism = "compliant"
[material]
young_modulus = "2 GPa"
poisson_ratio = 0.3
[design]
thickness = "{thickness}"
depth = "10 mm"
nodes.a = {{ at = ["0 mm", "0 mm"], support = "clamped" }}
nodes.b = {{ {b} }}
[[design.beams]]
name = "beam"
between = ["a", "b"]
{shape}
[load]
node = "b"
direction = [0, -1]
travel = "{travel}"
"#
    )
}

/// A perfectly straight column between its guide and the ground: beyond Euler's load the straight state is unstable, and the result says
/// so. Both ends keep their angle, so the load is 4π²EI/L²; with the stretching of the Reissner model the displacement there is
/// known: Δ = F·L/EA.
#[test]
fn a_column_beyond_eulers_load_is_reported_as_unstable() {
    let b = "at = [\"0 mm\", \"60 mm\"], support = \"slider\", direction = [0, 1]";
    let text = &one_beam("1 mm", b, "straight = true", "0.1 mm");
    let solved = solve(text, &[]);
    let (ei, ea, length) = (2e9 * 1e-9 * 1e-2 / 12.0, 2e9 * 1e-5, 60e-3);
    let euler_n = 4.0 * std::f64::consts::PI * std::f64::consts::PI * ei / (length * length);
    let shortening_m = euler_n * length / ea;
    let found = &solved.behaviour.path.bifurcations;
    assert!(!found.is_empty(), "buckling at {shortening_m} m is inside the travel");
    // Stretching and shear move the load by about F/EA and F/kGA, a few per mille here.
    near(found[0].displacement, shortening_m, 1e-2, "displacement at buckling");
    let result = outcome(text, &[]);
    assert_eq!(result.status.kind, StatusKind::UnstableBeyond);
    assert!(result.warnings.iter().any(|w| w.code == "W0506"));
    let before = outcome(text, &["load.travel=0.05 mm"]);
    assert_eq!(before.status.kind, StatusKind::Complete);
    // What is asked for is judged up to there: a limit broken before is missed, one that is kept so far is not assessed.
    let asked = text.replace(
        "[material]\n",
        "[requirements]\nstress = { max = \"50 MPa\" }\n[requirements.limits]\nforce_at_end = { min = \"1 N\" }\n[material]\n",
    );
    let state = |set: &[&str], code: &str| check(&outcome(&asked, set), code).state;
    for (set, stress, rest) in [
        (&["load.travel=0.05 mm"][..], CheckState::Met, CheckState::Met),
        (&[], CheckState::NotAssessed, CheckState::NotAssessed),
        // Compressed by 2 GPa·Δ/60 mm.
        (&["requirements.stress.max=1.5 MPa"], CheckState::Missed, CheckState::NotAssessed),
    ] {
        assert_eq!((state(set, "COMP002"), state(set, "COMP006")), (stress, rest), "{set:?}");
        assert_eq!(state(set, "COMP004"), rest, "{set:?}");
    }
    let unassessed = outcome(&asked, &[]);
    assert!(
        check(&unassessed, "COMP004").advice.as_ref().is_some_and(|a| a.contains("branches at Δ"))
            && unassessed.metric("force_at_end").is_none()
    );
}

/// A quarter ring, pushed: thickness over radius is exact, and so is what W0502 makes of it.
#[test]
fn a_strongly_curved_beam_is_named_with_its_ratio() {
    let text = &one_beam("2 mm", "at = [\"10 mm\", \"10 mm\"]", "arc = \"90 deg\"", "0.5 mm");
    let warning = |set: &[&str], code: &str| outcome(text, set).warnings.into_iter().find(|w| w.code == code).map(|w| w.message);
    // Radius 10 mm: w/R = 0.2, and 0.2/3 = 6.7 % more stress at the inner face.
    let message = warning(&[], "W0502").expect("0.2 is strongly curved");
    assert!(message.contains("up to 0.2)") && message.contains("6.7 % higher"), "{message}");
    assert_eq!(warning(&["design.thickness=0.9 mm"], "W0502"), None);
    // Length 15.7 mm over 2 mm is not slender.
    assert!(warning(&[], "W0501").is_some_and(|m| m.contains("7.85 times")));
    assert_eq!(warning(&["design.thickness=1.5 mm"], "W0501"), None);
}
