//! The mechanism of Lan, Wang & Chen, from its project file to its metrics, against converged values of an independent solution
//! (`reference/lan2010-converged.toml`: spectral Ritz with p = 20 and DOP853 shooting, agreeing to 4e-13 in force) and against the
//! numbers that the paper prints (`reference/lan2010.toml`).

mod common;

use common::{NODES, SHAPES, close, near, solve};
use forcewright_base::diagnostics::{Diagnostics, Span};
use forcewright_base::units::{Dimension, Quantity};
use forcewright_compliant::Compliant;
use forcewright_contract::family::Mechanism;
use forcewright_contract::reproduction::{Finding, ReproductionRow};
use forcewright_contract::tree::{self, Table, Value};

/// One leg of Table 4 by its shapes.
const LEG: &str = include_str!("../../../../reference/lan2010-table4.toml");
const CONVERGED: &str = include_str!("../../../../reference/lan2010-converged.toml");
const PRINTED: &str = include_str!("../../../../reference/lan2010.toml");

fn parsed(text: &str) -> Table {
    let mut diagnostics = Diagnostics::default();
    let table = tree::parse(text, Span::default().source, &mut diagnostics);
    assert!(diagnostics.is_empty());
    table
}

/// One table of the converged values.
struct Converged(Table);

impl Converged {
    fn of(name: &str) -> Self {
        match parsed(CONVERGED).take(name).map(|e| e.item.value) {
            Some(Value::Table(table)) => Self(table),
            _ => panic!("no table {name}"),
        }
    }

    fn list(&self, key: &str, dimension: Dimension) -> Vec<f64> {
        let read = |value: &Value| match value {
            Value::Text(text) => Quantity::parse(text, dimension).unwrap_or_else(|e| panic!("{key}: {e:?}")).si,
            Value::Number(number) => *number,
            _ => panic!("{key} is no number"),
        };
        match &self.0.get(key).unwrap_or_else(|| panic!("no {key}")).item.value {
            Value::List(items) => items.iter().map(|i| read(&i.value)).collect(),
            one => vec![read(one)],
        }
    }

    fn force(&self, key: &str) -> f64 {
        self.list(key, Dimension::Force)[0]
    }

    fn length(&self, key: &str) -> f64 {
        self.list(key, Dimension::Length)[0]
    }

    fn stress(&self, key: &str) -> f64 {
        self.list(key, Dimension::Stress)[0]
    }

    fn stiffness(&self, key: &str) -> f64 {
        self.list(key, Dimension::Stiffness)[0]
    }
}

/// Settings that give the example the paper's model.
const PAPER_MODEL: &str = "model.beam=inextensible";
/// A travel beyond the paper's, so that the local minimum at 13.72 mm is inside.
const LONGER: &str = "load.travel=17 mm";

#[test]
fn metrics_of_the_printed_shapes() {
    let (solved, want) = (solve(SHAPES, &[]), Converged::of("shapes"));
    near(solved.get("force_at_end"), want.force("force_at_end"), 1e-12, "force");
    // Read off the interpolant between 129 stations.
    near(solved.get("range_start"), want.length("range_start"), 2e-9, "c");
    let travel = solved.design.load_end;
    close(solved.get("range_ratio"), (travel - want.length("range_start")) / travel, 2e-9, "range");
    // The independent solution finds places by comparing forces, to about half of its digits.
    near(solved.get("force_local_max"), want.force("local_max"), 1e-12, "local maximum");
    near(solved.get("force_local_max_at"), want.length("local_max_at"), 1e-7, "place of the maximum");
    assert_eq!(solved.measured.get("force_local_min"), None, "the minimum is beyond the travel");
    near(solved.force(8.8e-3), want.force("force_a"), 1e-9, "F(a)");
    near(solved.force(4e-3), want.force("force_b"), 4e-9, "F(b)");
    // Refined by exact solutions between stations.
    near(solved.get("stress_max"), want.stress("stress_max"), 1e-12, "stress");
    near(solved.get("travel_at_allowable_stress"), want.length("travel_at_allowable_stress"), 1e-11, "travel at the allowed stress");
    near(solved.get("safety_factor"), 76e6 / want.stress("stress_max"), 1e-12, "safety factor");
    let stress = solved.measured.stress.unwrap();
    assert_eq!(solved.design.beam_names[stress.beam], "b4");
    close(stress.peak.u, want.list("stress_u", Dimension::Ratio)[0], 1e-6, "place on the beam");
    close(stress.at_m, travel, 0.0, "at the end of the travel");
    // The independent solution gives six digits.
    let (least, at) = solved.measured.stiffness.unwrap();
    near(least, want.stiffness("stiffness_min"), 3e-6, "least stiffness");
    near(at, want.length("stiffness_min_at"), 2e-5, "its place");
    assert!(least.to_bits() == solved.get("stiffness_min").to_bits());
}

#[test]
fn stiffness_at_rest_is_the_limit_of_the_secant() {
    let (solved, want) = (solve(SHAPES, &[]), Converged::of("shapes"));
    let step = 1e-6;
    let secant = 2.0 * solved.behaviour.path.at(step).unwrap().force / step;
    near(secant, want.stiffness("stiffness_secant"), 2e-8, "secant to 1e-4 cm");
    // The tangent differs from it by half a step's curvature; Richardson's extrapolation of two secants gives it back.
    let half = 2.0 * solved.behaviour.path.at(0.5 * step).unwrap().force / (0.5 * step);
    near(solved.get("stiffness_initial"), 2.0 * half - secant, 1e-7, "tangent");
    near(solved.get("stiffness_initial"), 3114.513, 1e-6, "tangent");
}

#[test]
fn beyond_the_travel_of_the_printed_shapes() {
    let (solved, want) = (solve(SHAPES, &[LONGER]), Converged::of("shapes"));
    near(solved.get("force_local_max"), want.force("local_max"), 1e-12, "local maximum");
    near(solved.get("force_local_min"), want.force("local_min"), 1e-12, "local minimum");
    near(solved.get("force_local_min_at"), want.length("local_min_at"), 1e-8, "place of the minimum");
    let (from, to) = solved.behaviour.jump().unwrap();
    near(from, want.length("local_max_at"), 1e-7, "start of the jump");
    near(to.unwrap(), want.length("jump_to"), 2e-9, "end of the jump");
}

#[test]
fn force_and_stress_over_the_displacement() {
    let (solved, want) = (solve(SHAPES, &["load.travel=19 mm"]), Converged::of("shapes"));
    let displacements = want.list("displacement", Dimension::Length);
    let forces = want.list("force", Dimension::Force);
    let stresses = want.list("stress", Dimension::Stress);
    assert!(displacements.len() == 11 && forces.len() == 11 && stresses.len() == 11);
    for ((x, force), stress) in displacements.iter().zip(forces).zip(stresses) {
        // Next to rest the force bends most: 2e-8 of the force there, 4e-9 of the largest force.
        near(solved.force(*x), force, if *x < 2e-3 { 3e-8 } else { 4e-9 }, "interpolated force");
        let exact = solved.behaviour.path.at(*x).unwrap();
        near(2.0 * exact.force, force, 1e-11, "force");
        near(exact.peak_stress().unwrap().1.stress_pa, stress, 1e-10, "stress");
    }
}

#[test]
fn metrics_of_the_printed_nodes() {
    let want = Converged::of("nodes");
    let set = [PAPER_MODEL, "requirements.stress.safety_factor=1.58"];
    let solved = solve(NODES, &set);
    near(solved.get("force_at_end"), want.force("force_at_end"), 1e-11, "force");
    near(solved.get("range_start"), want.length("range_start"), 2e-9, "c");
    near(solved.get("force_local_max"), want.force("local_max"), 1e-12, "local maximum");
    near(solved.get("force_local_max_at"), want.length("local_max_at"), 1e-7, "place of the maximum");
    near(solved.get("stress_max"), want.stress("stress_max"), 1e-10, "stress");
    near(solved.get("travel_at_allowable_stress"), want.length("travel_at_allowable_stress"), 1e-10, "travel at the allowed stress");
    let longer = solve(NODES, &[PAPER_MODEL, LONGER]);
    near(longer.get("force_local_min"), want.force("local_min"), 1e-12, "local minimum");
    near(longer.get("force_local_min_at"), want.length("local_min_at"), 1e-7, "place of the minimum");
}

#[test]
fn thin_and_deep_variant() {
    let want = Converged::of("thin");
    let thin = ["design.thickness=0.85 mm", "design.depth=16.28 mm"];
    let solved = solve(SHAPES, &[&thin[..], &["load.travel=16.8 mm"]].concat());
    near(solved.get("force_at_end"), want.force("force_at_end"), 1e-12, "force");
    near(solved.get("range_start"), want.length("range_start"), 5e-9, "c");
    let longer = solve(SHAPES, &[&thin[..], &[LONGER]].concat());
    near(longer.get("travel_at_allowable_stress"), want.length("travel_at_allowable_stress"), 1e-11, "travel at the allowed stress");
}

#[test]
fn with_stretching_and_shear() {
    let want = Converged::of("reissner");
    let solved = solve(SHAPES, &["model.beam=reissner", "load.travel=16.8 mm"]);
    for (x, force) in want.list("displacement", Dimension::Length).into_iter().zip(want.list("force", Dimension::Force)) {
        near(solved.force(x), force, 1e-9, "interpolated force");
        near(2.0 * solved.behaviour.path.at(x).unwrap().force, force, 1e-12, "force");
    }
}

#[test]
fn bands_of_the_paper_design() {
    // Longest stroke inside a band over the travel, inextensible; from an independent design study, to the digits given: ±2.5 % 47.6 %
    // and ±5 % 55.9 % with the level free, 42 % at ±2.5 % around 9.736 N.
    // They are those of the printed nodes; the printed shapes differ by 0.1 %.
    for (text, tolerance) in [(NODES, 5e-4), (SHAPES, 1.1e-3)] {
        let at = |band: &str| {
            let band = format!("requirements.force.band={band}");
            solve(text, &[PAPER_MODEL, &band, "requirements.force.nominal=9.736 N", "requirements.travel=1 mm"])
        };
        let (narrow, wide) = (at("2.5 %"), at("5 %"));
        close(narrow.get("flat_ratio"), 0.476, tolerance, "±2.5 %, level free");
        close(wide.get("flat_ratio"), 0.559, tolerance, "±5 %, level free");
        close(narrow.get("band_ratio"), 0.42, 5e-3, "±2.5 % around 9.736 N");
        // The free level is never worse than a given one.
        assert!(wide.get("flat_ratio") > wide.get("band_ratio") && narrow.get("flat_ratio") > narrow.get("band_ratio"));
        // An interval is as flat as it claims, and its ends are where it stops being so.
        for (solved, band) in [(&narrow, 0.025), (&wide, 0.05)] {
            let curve = solved.behaviour.curve.as_ref().unwrap();
            let interval = forcewright_compliant::Interval { start: solved.get("flat_start"), end: solved.get("flat_end") };
            let (hi, lo) = curve.extent(interval);
            near(hi / lo, (1.0 + band) / (1.0 - band), 1e-9, "flatness");
            near(solved.get("flat_force"), 0.5 * (hi + lo), 1e-12, "level");
            near(solved.force(solved.get("band_start")), 9.736 * (1.0 - band), 1e-12, "start of the band");
        }
    }
}

fn rows() -> Vec<ReproductionRow> {
    let all = Compliant::reproductions();
    assert_eq!(all.len(), 1);
    (all[0].run)(&mut |_| true)
}

#[test]
fn every_printed_number_is_reproduced_or_explained() {
    let rows = rows();
    let printed = rows.iter().filter(|r| r.paper.is_some()).count();
    assert!(rows.len() >= 36 && printed >= 21, "{} rows, {printed} printed", rows.len());
    for row in &rows {
        let name = format!("{} ({})", row.quantity, row.place);
        assert!(row.ours.is_finite(), "{name}: no value");
        assert!(!row.why.is_empty() && !row.quantity.is_empty() && !row.place.is_empty() && !row.unit.is_empty(), "{name}");
        assert!(row.paper.is_some() || row.explained.is_none(), "{name}: only a printed number can be explained");
        assert_ne!(row.finding(), Finding::Fails, "{name}: {row:?}");
    }
    // The numbers that depart from the paper for no known reason: few, and small but for the stroke of the end-effector and what follows
    // from it on the cam.
    let departures: Vec<_> = rows.iter().filter(|r| r.paper.is_some() && r.explained.is_none()).collect();
    assert_eq!(departures.len(), 8, "{departures:?}");
    for row in departures {
        let paper = row.paper.unwrap_or(f64::NAN);
        let allowed = match row.quantity.as_str() {
            "end-effector: stroke over which F is 8 to 8.59 N" => 1.8,
            "end-effector: least contact force over a cam of 5 mm from Δ = 0" => 8.0 + 1e-9,
            "distance of the axis of beam 4 at rest to side f4 of the design box" => 0.05,
            _ => 0.06 * paper.abs(),
        };
        assert!((row.ours - paper).abs() < allowed, "{}: {row:?}", row.quantity);
    }
}

#[test]
fn explained_differences_are_not_padded() {
    for row in rows() {
        let (Some(paper), Some(explained)) = (row.paper, row.explained) else { continue };
        let difference = (row.ours - paper).abs();
        let by_digits = ["round", "printed to"].iter().any(|word| row.why.contains(word));
        // What rounding explains is small in any case.
        let rounding = if paper == 0.0 { 1e-10 } else { 2.5e-3 * paper.abs() };
        let fair = explained <= 6.0 * difference || (by_digits && explained <= rounding);
        assert!(fair, "{}: {explained} is explained, {difference} is needed", row.quantity);
    }
}

#[test]
fn every_row_of_the_data_is_computed() {
    let table = parsed(PRINTED);
    let Value::List(items) = &table.get("row").unwrap().item.value else { panic!("rows") };
    assert_eq!(items.len(), rows().len());
    let mut ids: Vec<&str> = Vec::new();
    for item in items {
        let Value::Table(row) = &item.value else { panic!("a row") };
        for entry in &row.entries {
            let known = ["id", "quantity", "where", "paper", "kind", "unit", "explained", "why"];
            assert!(known.contains(&entry.key.as_str()), "`{}` is no key of a row", entry.key);
        }
        let Some(Value::Text(id)) = row.get("id").map(|e| &e.item.value) else { panic!("a row without id") };
        ids.push(id);
    }
    let count = ids.len();
    ids.sort_unstable();
    ids.dedup();
    assert_eq!(ids.len(), count, "an id is given twice");
}

#[test]
fn rows_without_print_against_the_independent_solution() {
    let want = Converged::of("shapes");
    let rows = rows();
    let ours = |quantity: &str| rows.iter().find(|r| r.quantity.starts_with(quantity)).unwrap_or_else(|| panic!("no row {quantity}")).ours;
    near(ours("local maximum"), want.force("local_max"), 1e-12, "local maximum");
    near(ours("local minimum"), want.force("local_min"), 1e-12, "local minimum");
    near(ours("displacement to which it jumps"), 1e3 * want.length("jump_to"), 2e-9, "jump");
    near(ours("least stiffness"), 1e-2 * want.stiffness("stiffness_min"), 3e-6, "least stiffness");
    near(ours("objective (1)"), want.force("force_a") / want.force("force_b") - 1.0, 1e-8, "objective");
    near(ours("F·Lx²/EI"), 5.981_058_94, 1e-8, "invariant of eq. (6)");
    // Supports that are not the paper's, computed by the independent solution to three digits.
    close(ours("F at 13.6 mm if n5"), 10.65, 5e-3, "slider that turns");
    close(ours("F at 13.6 mm if n1"), 8.97, 5e-3, "pinned ground");
    close(ours("beam 4 as printed (c2"), 13.6, 0.05, "sign error");
    close(ours("beam 4 as printed: angle"), 43.0, 0.5, "sign error");
    // The end-effector, to the digits of another computation.
    for (row, want, digits) in [
        ("F of eight legs at Δ = 1 mm", 6.0846, 5e-5),
        ("F of eight legs at Δ = 2 mm", 8.2092, 5e-5),
        ("F of eight legs at Δ = 3 mm", 8.4574, 5e-5),
        ("F of eight legs at Δ = 4 mm", 8.2108, 5e-5),
        ("F of eight legs at Δ = 5 mm", 8.5648, 6e-5),
        ("F of eight legs at Δ = 6 mm", 10.4652, 5e-5),
        ("largest stress at Δ = 5 mm", 64.2, 0.05),
        ("76 MPa over it", 1.18, 5e-3),
    ] {
        close(ours(&format!("end-effector: {row}")), want, digits, row);
    }
    let window = rows.iter().position(|r| r.quantity.contains("stroke over which F is 8")).unwrap();
    close(rows[window + 1].ours, 1.81, 5e-3, "start of the window");
    close(rows[window + 2].ours, 5.03, 5e-3, "end of the window");
}

#[test]
fn forces_of_the_beams() {
    let want = Converged::of("beam_forces");
    let displacements = Converged::of("shapes").list("displacement", Dimension::Length);
    let solved = solve(SHAPES, &["load.travel=19 mm"]);
    for (beam, key) in ["vertical_1", "vertical_2", "vertical_3", "vertical_4"].into_iter().enumerate() {
        for (x, force) in displacements.iter().zip(want.list(key, Dimension::Force)) {
            let state = solved.behaviour.path.at(*x).unwrap();
            close(-state.beams[beam].force_n[1], force, 1e-10, key);
        }
    }
    // What the paper says about Fig. 8, by its rows: extremes of beams 1 and 2 inside the range, the force of beam 3 nearly constant.
    let rows = rows();
    let row = |start: &str| rows.iter().position(|r| r.quantity.starts_with(start)).unwrap();
    for (start, largest) in [("vertical force of beam 1 on its way", -3.485), ("vertical force of beam 2: its extreme", 8.32)] {
        let at = row(start);
        close(rows[at].ours, largest, 0.02, start);
        assert!((7.0..13.6).contains(&rows[at + 1].ours), "{:?}", rows[at + 1]);
    }
    near(rows[row("vertical force of beam 3 at")].ours, 0.5 * Converged::of("shapes").force("force_at_end"), 1e-10, "half of F");
    close(rows[row("vertical force of beam 3 over")].ours, 2.75, 0.1, "spread");
}

#[test]
fn the_leg_of_the_end_effector() {
    let want = Converged::of("table4");
    let solved = solve(LEG, &[]);
    for (node, key) in solved.design.network.nodes.iter().zip(["n1", "n2", "n3"]) {
        for (value, wanted) in node.position_m.into_iter().zip(want.list(key, Dimension::Length)) {
            near(value, wanted, 1e-11, key);
        }
    }
    let (forces, stresses) = (want.list("force", Dimension::Force), want.list("stress", Dimension::Stress));
    for ((x, force), stress) in want.list("displacement", Dimension::Length).iter().zip(forces).zip(stresses) {
        let exact = solved.behaviour.path.at(*x).unwrap();
        near(8.0 * exact.force, force, 1e-11, "force of eight legs");
        near(exact.peak_stress().unwrap().1.stress_pa, stress, 1e-9, "stress");
    }
}

#[test]
fn the_example_is_a_quarter_of_the_end_effector() {
    let example = include_str!("../../../../examples/compliant/lan-sub-cfm.toml");
    let (leg, pair) = (solve(LEG, &["load.travel=5 mm"]), solve(example, &[PAPER_MODEL]));
    near(pair.get("force_at_end"), 2.0 * leg.get("force_at_end"), 1e-12, "two legs of eight");
    near(pair.get("stress_max"), leg.get("stress_max"), 1e-10, "stress");
}

#[test]
fn data_files_say_where_they_come_from() {
    for text in [CONVERGED, PRINTED] {
        let table = parsed(text);
        assert!(matches!(&table.get("source").unwrap().item.value, Value::Text(s) if s == "lan2010"));
        assert!(text.starts_with('#'), "the provenance is the first thing");
    }
    assert!(CONVERGED.contains("p = 20") && CONVERGED.contains("DOP853") && CONVERGED.contains("4e-13"));
}
