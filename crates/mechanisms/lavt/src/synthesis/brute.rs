//! The grid without any shortcut: what the search must find.

use std::collections::BTreeSet;
use std::sync::atomic::{AtomicUsize, Ordering};

use forcewright_base::diagnostics::Diagnostics;
use forcewright_contract::project::{Choices, Project};
use forcewright_contract::read::read;
use forcewright_elements::wrap_spring::WrapSpring;

use super::asked::Asked;
use super::front::{Point, as_good};
use super::gears::{Book, GearSet};
use super::limits::{Knob, loosened, nearest};
use super::search::{designed, everything, search};
use super::{SKELETON, written};
use crate::analysis::{Behaviour, corners_of, measure};
use crate::design::{Built, Design, Source};
use crate::spec::Spec;
use crate::statics::{State, Statics, clutch};

const WATCH: super::Watch<'static> = &|_| true;

fn read_text(text: &str) -> (Spec, Option<Design>, Diagnostics) {
    let mut project = Project::from_text("asked.toml", text, &Choices::default());
    let mut spec: Spec = read(&project.tree, project.root, &mut project.diagnostics);
    let design = crate::design::resolve(&mut spec, &mut project.diagnostics);
    (spec, design, project.diagnostics)
}

fn with_skeleton(requirements: &str) -> String {
    format!("schema = 1\nmechanism = \"lavt\"\ntitle = \"Asked for\"\n{requirements}\n{}", SKELETON.sections)
}

/// What a text asks for.
fn asked_of(requirements: &str) -> Asked {
    let (spec, design, mut diagnostics) = read_text(&with_skeleton(requirements));
    let asked = super::asked::asked(&spec, &design.expect("resolved"), &mut diagnostics);
    assert!(!diagnostics.has_errors(), "{diagnostics:?}");
    asked.expect("asked")
}

/// The requirements of Butin et al. 2023, section 3.5.
const PAPER: &str = r#"
[requirements]
input_torque = "100 N*mm"
transition_torque = { min = "15 N*mm" }
output_torque = { min = "400 N*mm" }
speed_drop = { max = 5 }
efficiency = { min = "80 %" }
[material.spring]
use = "EN 10270-1 SH"
young_modulus = "210 GPa"
"#;

/// Coarse grids: of the paper's requirements, with losses and a room, with other friction in the bore and a limit on a metric, and of little input
/// torque, for which the blocked interval decides.
fn grids() -> [String; 4] {
    [
        format!(
            "{PAPER}[synthesise]\nfriction = \"0.16 ± 0.03\"\nwire_diameters = [\"0.8 mm\", \"1 mm\", \"1.1 mm\"]\n\
             mean_radius = {{ min = \"6 mm\", max = \"9 mm\", step = \"0.5 mm\" }}\nbore_gap = {{ min = \"0.3 mm\", max = \"0.6 mm\", step = \"0.1 mm\" }}\n\
             gap_differences = [\"0.1 mm\", \"0.2 mm\", \"0.3 mm\"]\nhub_turns = {{ min = 2, max = 6, step = 2 }}\n\
             bore_turns = {{ min = 2, max = 6, step = 2 }}\nsun = {{ min = 16, max = 20 }}\nplanet = {{ min = 18, max = 30 }}\n"
        ),
        "[requirements]\ninput_torque = \"0.2 N*m\"\ntransition_torque = { min = \"20 N*mm\", max = \"80 N*mm\" }\n\
         output_torque = { min = \"0.5 N*m\" }\nefficiency = { min = \"65 %\" }\nsafety_factor = 1.2\n\
         [material.spring]\nuse = \"EN 10270-1 DH\"\n[losses]\nmode_1 = { proportional = 0.03, constant = \"2 N*mm\" }\n\
         mode_2 = { proportional = 0.05, constant = \"3 N*mm\" }\n[synthesise]\nfriction = \"0.16 ± 0.02\"\n\
         wire_diameters = [\"1 mm\", \"1.2 mm\", \"1.4 mm\"]\nmean_radius = { min = \"7 mm\", max = \"10 mm\", step = \"1.5 mm\" }\n\
         bore_gap = { min = \"0.3 mm\", max = \"0.9 mm\", step = \"0.2 mm\" }\ngap_differences = [\"0.05 mm\", \"0.1 mm\", \"0.2 mm\", \"0.3 mm\"]\n\
         hub_turns = { min = 3, max = 6, step = 1.5 }\nbore_turns = { min = 2, max = 6, step = 1 }\n\
         sun = { min = 15, max = 18 }\nplanet = { min = 15, max = 24 }\nmodules = [\"0.4 mm\", \"0.5 mm\"]\n\
         envelope = { diameter = \"39 mm\", length = \"33 mm\" }\nflank_friction = 0.08\n"
            .to_owned(),
        format!(
            "{PAPER}[requirements.limits]\nspring_safety_factor = {{ min = 1.6 }}\ndead_turns_input = {{ max = 1.6 }}\n\
             [synthesise]\nfriction = \"0.14 ± 0.02\"\nbore_friction = \"0.2 ± 0.04\"\nwire_diameters = [\"0.8 mm\", \"1 mm\"]\n\
             mean_radius = {{ min = \"6 mm\", max = \"10 mm\", step = \"0.5 mm\" }}\nbore_gap = {{ min = \"0.3 mm\", max = \"0.5 mm\", step = \"0.1 mm\" }}\n\
             gap_differences = [\"0.1 mm\", \"0.15 mm\"]\nhub_turns = {{ min = 3, max = 6, step = 3 }}\n\
             bore_turns = {{ min = 2, max = 4, step = 1 }}\nsun = {{ min = 18, max = 20 }}\nplanet = {{ min = 22, max = 30 }}\n\
             tolerances = {{ wire = \"0.005 mm\", spring = \"0 mm\", hub = \"0.01 mm\", bore = \"H6\" }}\n"
        ),
        "[requirements]\ninput_torque = \"30 N*mm\"\n[material.spring]\nuse = \"EN 10270-1 SH\"\n[synthesise]\nfriction = \"0.16 ± 0.03\"\n\
         wire_diameters = [\"1 mm\", \"1.1 mm\", \"1.2 mm\"]\nmean_radius = { min = \"6 mm\", max = \"9 mm\", step = \"0.5 mm\" }\n\
         bore_gap = { min = \"0.3 mm\", max = \"0.6 mm\", step = \"0.1 mm\" }\ngap_differences = [\"0.1 mm\", \"0.2 mm\", \"0.3 mm\"]\n\
         hub_turns = { min = 2, max = 6, step = 2 }\nbore_turns = { min = 2, max = 6, step = 2 }\nsun = { min = 16, max = 18 }\n\
         planet = { min = 20, max = 24 }\n[parts]\nchassis_diameter = \"21 mm\"\n"
            .to_owned(),
    ]
}

/// Every place in the grid of springs.
fn places(asked: &Asked) -> Vec<[usize; 6]> {
    let lists = [asked.wires.len(), asked.radii_m.len(), asked.gaps_m.len(), asked.differences_m.len()];
    let lengths = [lists[0], lists[1], lists[2], lists[3], asked.hub_turns.len(), asked.bore_turns.len()];
    let all: usize = lengths.iter().product();
    (0..all)
        .map(|mut i| {
            let mut place = [0; 6];
            for axis in (0..6).rev() {
                place[axis] = i % lengths[axis];
                i /= lengths[axis];
            }
            place
        })
        .collect()
}

/// Whether statics at a corner with a friction keep what is asked.
fn keeps(asked: &Asked, statics: &Statics) -> bool {
    let inside = 1.0 + 1e-9;
    let (state, output_nm) = statics.output(asked.input_nm * inside);
    let transition_nm = statics.transition_output_nm();
    state == State::ModeII
        && statics.hub_nm > statics.transition_nm * inside
        && output_nm >= asked.output_nm
        && transition_nm >= asked.transition_nm[0] * inside
        && transition_nm * inside <= asked.transition_nm[1]
        && statics.efficiency(asked.input_nm * inside).is_some_and(|e| e >= asked.efficiency * inside)
        && 1.0 / statics.ratio <= asked.speed_drop
}

/// A gear set and a spring through the family's own statics, at every corner with the least, the usual and the largest friction; through the
/// full analysis what is not torque.
fn sound(asked: &Asked, book: &Book, set: GearSet, place: [usize; 6]) -> Option<Design> {
    let gears = book.sound(asked, set)?;
    let design = designed(asked, &gears, place.map(|i| u16::try_from(i).expect("small")));
    for built in corners_of(&design.built, &design.scatter) {
        let spring = clutch(&built, Source::Corrected).ok()?;
        if !asked.frictions().iter().all(|f| keeps(asked, &Statics::new(&built, &spring, *f, gears.loss).expect("friction"))) {
            return None;
        }
        let stresses = spring.stresses();
        let most_pa = stresses.hub_pa.max(stresses.bore_pa);
        if 0.7 * design.wire.tensile_pa? < asked.safety * most_pa || most_pa > asked.stress_pa {
            return None;
        }
    }
    let measured = measure(&design, &Behaviour::of(&design).ok()?);
    let size = [measured.get("outer_diameter")?, measured.get("length")?];
    // A chassis of its own diameter keeps a wall around the bore.
    if design
        .making
        .chassis_m
        .is_some_and(|chassis_m| chassis_m < design.built.bore_m + 2.0 * design.making.wall_m(design.built.gears.module_m))
    {
        return None;
    }
    (size[0] <= asked.envelope_m[0] && size[1] <= asked.envelope_m[1]).then_some(design)
}

/// Every gear set of the grid that can be put together.
fn sets(asked: &Asked) -> Vec<GearSet> {
    let mut all = Vec::new();
    for module in 0..asked.modules_m.len() {
        for sun in asked.suns[0]..=asked.suns[1] {
            for planet in asked.planets[0]..=asked.planets[1] {
                for number in asked.numbers[0]..=asked.numbers[1] {
                    if (2 * sun + 2 * planet) % number == 0 {
                        all.push(GearSet { sun, planet, number, module });
                    }
                }
            }
        }
    }
    all
}

fn key(set: GearSet, place: [usize; 6]) -> (GearSet, [usize; 6]) {
    (set, place)
}

#[test]
fn the_search_is_every_combination() {
    for text in grids() {
        let asked = asked_of(&text);
        let book = Book::default();
        let mut all = BTreeSet::new();
        let mut springs = vec![false; places(&asked).len()];
        for set in sets(&asked) {
            // What no spring could mend need not be tried with every one.
            let ratio = f64::from(set.sun) / f64::from(2 * (set.sun + set.planet));
            if asked.input_nm / ratio < asked.output_nm || 1.0 / ratio > asked.speed_drop {
                continue;
            }
            for (i, place) in places(&asked).into_iter().enumerate() {
                if sound(&asked, &book, set, place).is_some() {
                    all.insert(key(set, place));
                    springs[i] = true;
                }
            }
        }
        let (points, sounds) = everything(&asked, &book);
        let found: BTreeSet<_> = points.iter().map(|p| key(sounds[p.set as usize].set, p.place.map(usize::from))).collect();
        assert!(all.len() > 30 && all.len() < places(&asked).len() * sets(&asked).len() / 4, "{} in\n{text}", all.len());
        assert_eq!(found.len(), points.len());
        assert_eq!(found, all, "{text}");
        let whole = search(&asked, &book, WATCH);
        assert_eq!(whole.feasible, all.len() as u64);
        assert!(whole.springs >= springs.iter().filter(|s| **s).count() as u64);
        fronts_agree(&asked, &whole.front.iter().map(|p| p.objectives).collect::<Vec<_>>(), points, &sounds);
    }
}

/// The front of the search against every pair of designs, limits on metrics by the full analysis of every design.
fn fronts_agree(asked: &Asked, front: &[[f64; 5]], points: Vec<Point>, sounds: &[super::gears::Sound]) {
    let within = |p: &Point| {
        let design = designed(asked, &sounds[p.set as usize], p.place);
        let measured = measure(&design, &Behaviour::of(&design).expect("analysed"));
        asked
            .limits
            .iter()
            .all(|l| measured.value(l.metric).is_some_and(|x| l.min.is_none_or(|min| x >= min) && l.max.is_none_or(|max| x <= max)))
    };
    let before = points.len();
    let points: Vec<Point> = points.into_iter().filter(within).collect();
    assert!(
        asked.limits.is_empty() || (points.len() < before && !points.is_empty()),
        "the limits should take some: {} of {before}",
        points.len()
    );
    let bits = |o: &[f64; 5]| o.map(f64::to_bits);
    let beaten = |p: &Point| points.iter().any(|o| as_good(&o.objectives, &p.objectives) && bits(&o.objectives) != bits(&p.objectives));
    let expected: BTreeSet<_> = points.iter().filter(|p| !beaten(p)).map(|p| bits(&p.objectives)).collect();
    let found: BTreeSet<_> = front.iter().map(bits).collect();
    assert!(expected.len() > 3 && expected.len() < points.len(), "{} of {}", expected.len(), points.len());
    assert_eq!(found.len(), front.len());
    assert_eq!(found, expected);
}

/// The objectives of designs against the metrics of their full analysis, the solver of `least_friction_to_grip` and a bisection by statics.
#[test]
fn objectives_are_those_of_the_analysis() {
    for text in grids().iter().take(2) {
        let asked = asked_of(text);
        let book = Book::default();
        let (points, sounds) = everything(&asked, &book);
        for point in points.iter().step_by(points.len() / 40 + 1) {
            let design = designed(&asked, &sounds[point.set as usize], point.place);
            let behaviour = Behaviour::of(&design).expect("analysed");
            let measured = measure(&design, &behaviour);
            let [volume, output, efficiency, friction, gap] = point.objectives;
            for (name, ours) in [("envelope_volume", volume), ("output_torque_max", -output), ("efficiency_max", -efficiency)] {
                let theirs = measured.get(name).expect(name);
                assert!((ours / theirs - 1.0).abs() < 1e-8, "{name}: {ours} {theirs}");
            }
            let needed_nm = behaviour.statics.leverage() * asked.input_nm;
            let needs = |built: &Built| {
                let spring: WrapSpring = clutch(built, Source::Corrected).expect("a spring");
                spring.least_friction_to_grip(needed_nm).expect("a torque").expect("enough")
            };
            let most = corners_of(&design.built, &design.scatter).map(|b| needs(&b)).fold(0.0, f64::max);
            assert!((friction * asked.frictions()[0][0] / most - 1.0).abs() < 1e-7, "{friction} {most}");
            assert!((bisected_gap_m(&design, &asked, needed_nm) / -gap - 1.0).abs() < 1e-4, "{gap}");
        }
    }
}

/// By how much the hub may shrink on the radius until some corner no longer holds, by bisection.
fn bisected_gap_m(design: &Design, asked: &Asked, needed_nm: f64) -> f64 {
    let holds = |less_m: f64| {
        corners_of(&design.built, &design.scatter).all(|mut built| {
            built.hub_m -= 2.0 * less_m;
            let Ok(spring) = clutch(&built, Source::Corrected) else { return false };
            Statics::new(&built, &spring, asked.frictions()[0], 0.0).expect("friction").grip_nm.is_some_and(|nm| nm >= needed_nm)
        })
    };
    let (mut low, mut high) = (0.0, 1e-3);
    assert!(holds(low) && !holds(high));
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if holds(middle) {
            low = middle;
        } else {
            high = middle;
        }
    }
    low
}

/// Every proposal's file, read and analysed as any project, meets everything; its numbers are those of the search, to the last bit.
#[test]
fn files_are_what_was_found() {
    for text in grids() {
        let asked = asked_of(&text);
        let found = search(&asked, &Book::default(), WATCH);
        let proposals = written(&asked, &found, 8);
        assert!(proposals.len() >= 4, "{}", proposals.len());
        for proposal in &proposals {
            let sections = &proposal.sections;
            let file = format!("schema = 1\nmechanism = \"lavt\"\ntitle = \"Asked for\"\n{text}\n{sections}");
            let (_, design, diagnostics) = read_text(&file);
            let design = design.unwrap_or_else(|| panic!("{diagnostics:?}\n{file}"));
            let outcome = <crate::Lavt as forcewright_contract::family::Mechanism>::analyse(&design, &mut |_| true).outcome;
            let missed: Vec<_> =
                outcome.checks.iter().filter(|c| c.state == forcewright_model::CheckState::Missed).map(|c| c.code).collect();
            assert!(outcome.requirements_met() && missed.iter().all(|c| super::MAY_MISS.contains(c)), "{missed:?}\n{sections}");
            let there = found.front.iter().any(|p| {
                let ours = designed(&asked, &found.sets[p.set as usize], p.place);
                ours.built == design.built && ours.scatter == design.scatter && ours.making == design.making
            });
            assert!(there, "{sections}");
        }
    }
}

/// The numbers of the raw grid are those of the theory note, and its whole is looked at.
#[test]
fn the_raw_grid() {
    let asked = asked_of(&format!("{PAPER}[synthesise]\nfriction = \"0.15 ± 0.03\"\n"));
    let [gears, springs] = asked.raw();
    assert_eq!([gears.to_bits(), springs.to_bits()], [1530.0_f64.to_bits(), 6_775_758.0_f64.to_bits()]);
    let found = search(&asked, &Book::default(), WATCH);
    let slow = |set: &GearSet| f64::from(2 * (set.sun + set.planet)) / f64::from(set.sun) <= 5.0;
    assert_eq!(found.assembled, sets(&asked).iter().filter(|set| slow(set)).count());
    // Some springs of the grid reach the bore at all corners, some do not, and designs that keep everything are few.
    assert!(found.springs > 1_000_000 && found.springs < 6_775_758 && found.feasible < 1_000_000);
    assert!(!found.front.is_empty() && !found.interrupted && !found.cut);
    let at = AtomicUsize::new(0);
    let stopped = search(&asked, &Book::default(), &|_| at.fetch_add(1, Ordering::Relaxed) < 200);
    assert!(stopped.interrupted && stopped.springs < found.springs);
}

/// Springs of the grid with R = 1/5 and a friction of 0.2 that pass the paper's equations (20), (24), (17), (18), (26) and (28), and those of
/// them that slip by the corrected ones. The counts are those of a separate program that writes the equations out.
#[test]
fn seven_of_ten_springs_that_the_paper_passes_slip() {
    let text = format!(
        "{PAPER}[synthesise]\nfriction = 0.2\nwire_diameters = [{}]\n",
        (6..15).map(|i| format!("\"{} mm\"", f64::from(i) / 10.0)).collect::<Vec<_>>().join(", ")
    );
    let asked = asked_of(&text);
    let teeth = crate::design::Gears { teeth: [12, 18, 48], ..asked.template.built.gears };
    let [mut paper, mut both] = [0_u32; 2];
    for place in places(&asked).into_iter().filter(|p| p[5] == 0) {
        let built = Built { gears: teeth, ..asked.spring(place) };
        let one = clutch(&built, Source::Paper).expect("a spring");
        let lasts = |spring: &WrapSpring| spring.stresses().hub_pa.max(spring.stresses().bore_pa) <= 1.4e9;
        if !lasts(&one) {
            continue;
        }
        for turns in &asked.bore_turns {
            let mut built = built;
            built.spring.bore_turns = *turns;
            built.spring.free_turns = asked.free_turns + *turns;
            let [one, other] = [Source::Paper, Source::Corrected].map(|source| clutch(&built, source).expect("a spring"));
            let does = |s: &Statics| {
                let (state, output_nm) = s.output(0.1);
                // Configuration 1 has no blocked interval: the paper's mode II begins where mode I ends.
                let enough = state == State::ModeII && output_nm >= 0.4 * (1.0 - 1e-12) && s.grip_nm.is_some_and(|nm| nm > 0.4);
                enough && s.transition_output_nm() >= 0.015
            };
            let by_paper = Statics::new(&built, &one, [0.2; 2], 0.0).expect("friction");
            let holds_slip =
                by_paper.hub_nm < by_paper.transition_nm * (forcewright_base::maths::exp(std::f64::consts::TAU * turns * 0.2) - 1.0);
            if does(&by_paper) && holds_slip {
                paper += 1;
                both += u32::from(lasts(&other) && does(&Statics::new(&built, &other, [0.2; 2], 0.0).expect("friction")));
            }
        }
    }
    let near = |ours: u32, theirs: f64| (f64::from(ours) / theirs - 1.0).abs() < 1e-4;
    assert!(near(paper, 514_448.0) && near(both, 145_500.0), "{paper} {both}");
    assert!((1.0 - f64::from(both) / f64::from(paper) - 0.7172).abs() < 2e-4);
}

/// The nearest value of each limit lets something be found, and a hair beyond it nothing.
#[test]
fn nearest_values_are_the_edge() {
    let hard = [
        (Knob::Transition, 0.5),
        (Knob::TransitionMost, 1e-3),
        (Knob::Output, 0.9),
        (Knob::SpeedDrop, 2.5),
        (Knob::Efficiency, 0.99),
        (Knob::Safety, 5.0),
        (Knob::Stress, 1e8),
        (Knob::Diameter, 5e-3),
        (Knob::Length, 5e-3),
        (Knob::Friction, 0.02),
    ];
    let asked = asked_of(&grids()[0]);
    let book = Book::default();
    let mut seen = 0;
    for (knob, value) in hard {
        let blocked = knob.with(&asked, value);
        assert!(search(&blocked, &book, WATCH).front.is_empty(), "{knob:?}");
        let Some(edge) = nearest(&blocked, knob, &book, WATCH) else { continue };
        seen += 1;
        let there = knob.with(&blocked, loosened(knob, edge, 0.0));
        assert!(!search(&there, &book, WATCH).front.is_empty(), "{knob:?} {edge}");
        let beyond = if loosened(knob, 1.0, 0.1) < 1.0 { 1.0 + 1e-4 } else { 1.0 - 1e-4 };
        assert!(search(&knob.with(&blocked, edge * beyond), &book, WATCH).front.is_empty(), "{knob:?} {edge}");
    }
    assert_eq!(seen, hard.len());
    // Two limits that both block have no nearest value alone.
    let both = Knob::Length.with(&Knob::Diameter.with(&asked, 5e-3), 5e-3);
    assert!(Knob::ALL.iter().all(|knob| nearest(&both, *knob, &book, WATCH).is_none()));
}

/// All lengths twice, all torques eightfold: the same designs, twice as large.
#[test]
fn twice_as_large_is_twice_as_large() {
    let text =
        format!("{}tolerances = {{ wire = \"0.01 mm\", spring = \"0.04 mm\", hub = \"0.01 mm\", bore = \"0.01 mm\" }}\n", grids()[0])
            .replace("use = \"EN 10270-1 SH\"", "tensile_strength = \"2200 MPa\"");
    let small = asked_of(&text);
    let large = asked_of(
        &text
            .replace("100 N*mm", "800 N*mm")
            .replace("15 N*mm", "120 N*mm")
            .replace("400 N*mm", "3200 N*mm")
            .replace("[\"0.8 mm\", \"1 mm\", \"1.1 mm\"]", "[\"1.6 mm\", \"2 mm\", \"2.2 mm\"]")
            .replace("min = \"6 mm\", max = \"9 mm\", step = \"0.5 mm\"", "min = \"12 mm\", max = \"18 mm\", step = \"1 mm\"")
            .replace("min = \"0.3 mm\", max = \"0.6 mm\", step = \"0.1 mm\"", "min = \"0.6 mm\", max = \"1.2 mm\", step = \"0.2 mm\"")
            .replace("[\"0.1 mm\", \"0.2 mm\", \"0.3 mm\"]", "[\"0.2 mm\", \"0.4 mm\", \"0.6 mm\"]")
            .replace(
                "wire = \"0.01 mm\", spring = \"0.04 mm\", hub = \"0.01 mm\", bore = \"0.01 mm\"",
                "wire = \"0.02 mm\", spring = \"0.08 mm\", hub = \"0.02 mm\", bore = \"0.02 mm\"",
            )
            .replace("sun = {", "modules = [\"1 mm\"]\nsun = {"),
    );
    let [one, other] = [small, large].map(|asked| search(&asked, &Book::default(), WATCH));
    assert!(one.feasible > 30 && one.feasible == other.feasible && one.front.len() == other.front.len());
    for (a, b) in one.front.iter().zip(&other.front) {
        assert_eq!(a.place, b.place);
        for ((x, y), power) in a.objectives.iter().zip(&b.objectives).zip([8.0, 8.0, 1.0, 1.0, 2.0]) {
            assert!((x * power / y - 1.0).abs() < 1e-9, "{a:?} {b:?}");
        }
    }
}

#[test]
fn faults_are_named() {
    let text = format!("{}\n", grids()[0]);
    let codes = |text: &str| {
        let (spec, design, mut diagnostics) = read_text(&with_skeleton(text));
        assert!(!diagnostics.has_errors(), "{diagnostics:?}");
        let none = super::synthesiser(&spec, &design.expect("resolved"), &mut diagnostics).is_none();
        assert_eq!(none, diagnostics.has_errors());
        diagnostics.in_file_order().iter().map(|d| d.code).collect::<Vec<_>>()
    };
    assert!(codes(&text).is_empty());
    assert_eq!(codes(&text.replace("friction = \"0.16 ± 0.03\"\n", "")), ["E0840"]);
    assert_eq!(codes(&text.replace("max = \"9 mm\"", "max = \"5 mm\"")), ["E0841"]);
    assert_eq!(codes(&text.replace("step = \"0.5 mm\"", "step = \"1e-5 mm\"")), ["E0841"]);
    assert_eq!(codes(&text.replace("max = 30", "max = 10")), ["E0841"]);
    let endless = text.replace("step = \"0.5 mm\"", "step = \"0.002 mm\"").replace("step = \"0.1 mm\"", "step = \"0.0002 mm\"");
    assert_eq!(codes(&endless.replace("step = 2", "step = 0.1")), ["E0841"]);
    assert_eq!(codes(&format!("{text}tolerances = {{ hub = \"k77\" }}\n")), ["E0842"]);
    assert_eq!(codes(&text.replace("\"0.8 mm\", ", "\"0.2 mm\", ")), ["E0843"]);
    assert_eq!(codes(&text.replace("[material", "limits = { closing_time = { max = \"1 s\" } }\n[material")), ["E0844"]);
    assert_eq!(codes(&text.replace("[synthesise]", "[model]\nsource = \"paper\"\n[synthesise]")), ["E0845"]);
}
