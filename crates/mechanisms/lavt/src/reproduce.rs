//! The paper's numbers beside ours. The others are data (`reference/butin2023.toml`); ours are computed in the run.

use std::f64::consts::TAU;

use forcewright_base::diagnostics::Span;
use forcewright_base::maths::{exp, ln_1p};
use forcewright_base::roots;
use forcewright_base::units::{Dimension, Quantity};
use forcewright_contract::family::Progress;
use forcewright_contract::project::{Choices, Project};
use forcewright_contract::read;
use forcewright_contract::reproduction::{Reproduction, ReproductionRow, rows};
use forcewright_elements::gears::interference::{least_shift, trimming_rad, trochoid_rad, wheel_tip_limit_m};
use forcewright_elements::gears::planetary::{PlanetarySet, Teeth, TeethSearch};
use forcewright_elements::wrap_spring::{Dimensions, WrapSpring, grip_nm, linear_moment_nm, opening_slip_nm};

use crate::analysis::{Behaviour, measure};
use crate::bench::{Bench, Mode, Run};
use crate::design::{self, Design, Source};
use crate::gears::wheels;
use crate::spec::Spec;
use crate::statics::{Statics, clutch};

/// The papers of this family.
pub(crate) const ALL: &[Reproduction] =
    &[Reproduction { key: "butin2023", title: "Butin et al.: two-speed load-adaptive variable transmission", run: butin }];

const ROWS: &str = include_str!("../../../../reference/butin2023.toml");
const PROJECTS: [&str; 3] = [
    include_str!("../../../../examples/lavt/butin-1.toml"),
    include_str!("../../../../examples/lavt/butin-2.toml"),
    include_str!("../../../../examples/lavt/butin-3.toml"),
];
/// Fits of Table 2: slopes and constants (N·mm) of mode I and II.
const FITS: [[[f64; 2]; 2]; 3] = [[[0.79, 0.56], [3.79, 50.4]], [[0.87, 1.84], [4.09, 65.0]], [[0.80, 0.38], [4.07, 64.5]]];
/// Input torque of Table 1, N·m.
const INPUT_NM: f64 = 0.1;

/// A configuration as the paper has it: gears without shift, nothing lost but the slip. The text is embedded and tested, so a failure gives
/// rows that cannot agree.
fn configuration(text: &str) -> Option<Design> {
    let project = Project::from_text("embedded", text, &Choices { variant: None, set: Vec::new() });
    let mut diagnostics = project.diagnostics;
    let mut spec: Spec = read::read(&project.tree, Span::default(), &mut diagnostics);
    let mut design = design::resolve(&mut spec, &mut diagnostics)?;
    let gears = &mut design.built.gears;
    (gears.shift, gears.shortening, gears.backlash_m, gears.friction) = ([0.0; 3], [0.0; 3], 0.0, None);
    design.built.losses = Default::default();
    Some(design)
}

fn butin(progress: Progress<'_>) -> Vec<ReproductionRow> {
    let all = PROJECTS.map(configuration);
    rows(ROWS, progress, |id| {
        let (name, number) = id.rsplit_once('_').and_then(|(name, n)| Some((name, n.parse::<usize>().ok()?))).unwrap_or((id, 1));
        let value = || {
            if name == "gap" {
                return gap(all[0].as_ref()?, number);
            }
            let index = number.checked_sub(1)?;
            let design = all.get(index)?.as_ref()?;
            match name.strip_prefix("fit_") {
                Some(name) => fit(design, &FITS[index], name),
                None => value(design, name),
            }
        };
        value().unwrap_or(f64::NAN)
    })
}

/// The number of a row, in its unit.
fn value(design: &Design, name: &str) -> Option<f64> {
    if let Some(name) = name.strip_prefix("paper_") {
        return torque(&Design { source: Source::Paper, ..design.clone() }, name);
    }
    gears(design, name).or_else(|| section_2(design, name)).or_else(|| friction(design, name)).or_else(|| torque(design, name))
}

/// Torques, stresses and turns with the model of the design.
fn torque(design: &Design, name: &str) -> Option<f64> {
    let behaviour = Behaviour::of(design).ok()?;
    let metric = |name: &str| measure(design, &behaviour).get(name);
    let (scale, metric_name) = match name {
        "ratio" => (1.0, "ratio"),
        "drop" => (1.0, "speed_drop"),
        "tt" => (1e3, "spring_transition_torque"),
        "tb" => (1e3, "hub_torque"),
        "tin" => (1e3, "transition_torque_input"),
        "end" => (1e3, "plateau_end_input"),
        "eta" => (100.0, "efficiency_max"),
        "max" => (1e3, "output_torque_max"),
        "hubstress" => (1e-6, "spring_stress_hub"),
        "borestress" => (1e-6, "spring_stress_bore"),
        "dead" => (1.0, "dead_turns_input"),
        "moment" => return Some(1e3 * behaviour.clutch.hub_moment_nm()),
        "alone" => return Some(1e-6 * behaviour.clutch.unsupported_pa(0.4).ok()?),
        _ => return None,
    };
    // The paper's optimum holds the input torque only above a friction, which its table does not ask for.
    if ["max", "eta"].contains(&name) {
        let statics = gripping(&behaviour);
        let output_nm = statics.output(INPUT_NM).1;
        return Some(if name == "max" { 1e3 * output_nm } else { 100.0 * statics.efficiency(INPUT_NM)? });
    }
    Some(scale * metric(metric_name)?)
}

/// Statics with a bore that holds whatever comes.
fn gripping(behaviour: &Behaviour) -> Statics {
    // The gears of these designs lose nothing.
    let plain = behaviour.statics;
    Statics { grip_nm: plain.grip_nm.map(|_| f64::INFINITY), ..plain }
}

/// The clutch in the corrected and in the paper's model. Its gaps are those of the table: the diameters of the files give them but for a
/// rounding, which decides where both are equal.
fn springs(design: &Design) -> Option<[WrapSpring; 2]> {
    let of = |source| {
        let typed = clutch(&design.built, source).ok()?;
        let plain = |gap_m: f64| (gap_m * 1e9).round() / 1e9;
        let d = *typed.dimensions();
        let dimensions = Dimensions { hub_interference_m: plain(d.hub_interference_m), bore_opening_m: plain(d.bore_opening_m), ..d };
        WrapSpring::new(&dimensions, typed.options()).ok()
    };
    Some([of(Source::Corrected)?, of(Source::Paper)?])
}

/// What friction is needed, and what it holds.
fn friction(design: &Design, name: &str) -> Option<f64> {
    let [corrected, paper] = springs(design)?;
    let turns = paper.dimensions().bore_turns;
    let spring_nm = INPUT_NM * 4.0;
    // Never is a friction without end.
    let inverse = |mu: Option<f64>| mu.map_or(0.0, |mu| 1.0 / mu);
    Some(match name {
        "eq27" | "eq26" => turns * paper.least_friction_to_reach()?,
        "eq28" => paper.least_friction_to_grip(spring_nm).ok()??,
        "eq29" => paper.least_friction_to_lock(spring_nm).ok()??,
        "reach" => corrected.least_friction_to_reach()?,
        "hold" | "hold28" => corrected.least_friction_to_grip(spring_nm).ok()??,
        "inverse_reach" => inverse(corrected.least_friction_to_reach()),
        "inverse_hold" => inverse(corrected.least_friction_to_grip(spring_nm).ok()?),
        "linear_reach" => -ln_1p(-paper.transition_nm() / paper.hub_moment_nm()) / (TAU * paper.dimensions().hub_turns),
        "linear_hold" => linear_hold(&paper, spring_nm)?,
        "grip" => 1e3 * corrected.limits(0.2).ok()?.grip_nm.unwrap_or(0.0),
        "beam" | "beam_paper" => {
            // Over EI/r², so that a moment is a length: mm.
            let moment = |delta_mm: f64| linear_moment_nm(1.0, 1.0, delta_mm);
            grip_nm(moment(0.4), opening_slip_nm(moment(0.6), TAU * 2.0 * 0.12), TAU * 3.0 * 0.12)
        }
        _ => return None,
    })
}

/// Friction at which the bore holds a torque, with linear opening and all turns of the hub.
fn linear_hold(paper: &WrapSpring, spring_nm: f64) -> Option<f64> {
    let (moment_nm, transition_nm) = (paper.hub_moment_nm(), paper.transition_nm());
    let [hub, bore] = [paper.dimensions().hub_turns, paper.dimensions().bore_turns].map(|turns| TAU * turns);
    let beyond = |mu: f64| opening_slip_nm(moment_nm, hub * mu) - transition_nm - (spring_nm - transition_nm) * exp(-bore * mu);
    roots::root(beyond, 0.01, 2.0, 1e-12).ok()
}

/// Table 2, from runs on its lines that are fitted as those of a bench.
fn fit(design: &Design, lines: &[[f64; 2]; 2], name: &str) -> Option<f64> {
    let ratio = design.built.ratio();
    let runs = (0..=95).map(|i| {
        let output_nm = 1e-3 * f64::from(i);
        // Both lines rise, the second less: the lower one is the mode that it is in.
        let [one, two] = lines.map(|[slope, constant]| (output_nm + 1e-3 * constant) / slope);
        Run { mass_kg: 0.0, output_nm, input_nm: one.min(two), turns: None, repeat_nm: None, wave: None }
    });
    let bench = Bench::of(runs.collect(), ratio)?;
    let (one, two) = (bench.modes[0]?, bench.modes[1]?);
    let gain = |mode: &Mode| (1.0 - mode.proportional.value) / ratio;
    let most_nm = gain(&two) * INPUT_NM - two.constant_nm.value;
    let [corrected, paper] = springs(design)?;
    let part = two.constant_nm.value / paper.hub_moment_nm();
    Some(match name {
        "loss1" => 100.0 * one.proportional.value,
        "const1" => 1e3 * one.constant_nm.value,
        "loss2" => 100.0 * two.proportional.value,
        "const2" => 1e3 * two.constant_nm.value,
        "max" => 1e3 * most_nm,
        "cross" => 1e3 * bench.shift?.crossing_nm.value,
        "cross_in" => 1e3 * bench.shift?.crossing_input_nm.value,
        "ratio" => part,
        "mu" => -ln_1p(-part) / (TAU * paper.dimensions().hub_turns),
        "mu_exact" => bench.friction(&corrected, 0.0)?.value?,
        "gain" => most_nm / INPUT_NM,
        "energy" => most_nm * most_nm / (INPUT_NM * INPUT_NM),
        _ => return None,
    })
}

/// Energy and requirements: sections 2, 3.5 and 5.
fn section_2(design: &Design, name: &str) -> Option<f64> {
    let paper = Design { source: Source::Paper, ..design.clone() };
    let behaviour = Behaviour::of(&paper).ok()?;
    let hand = design.hand.as_ref()?;
    let metric = |name: &str| measure(&paper, &behaviour).get(name);
    let typed = |text: &str, dimension| Quantity::parse(text, dimension).ok().map(|q| q.si);
    let output = |input_nm: f64| gripping(&behaviour).output(input_nm).1;
    let gain = output(INPUT_NM) / INPUT_NM;
    Some(match name {
        "work" => metric("squeeze_work")?,
        "stiffness" => 80.0 / 30.0,
        "battery" => 1e-3 * typed("7.2 V", Dimension::Voltage)? * typed("1000 mAh", Dimension::Charge)?,
        "grasps" => typed("7.2 V", Dimension::Voltage)? * typed("1000 mAh", Dimension::Charge)? / metric("squeeze_work")?,
        "mean_power" => metric("squeeze_work")? / 0.3,
        "index" => metric("performance_index")?,
        "required" => 1e3 * hand.force_n? * hand.lever.at_m(0.0) / hand.reduction,
        "speed_out" => hand.speed_m_per_s? / hand.lever.at_m(0.0) * hand.reduction * 60.0 / TAU,
        "ideal_gain" => 1.0 / (behaviour.statics.ratio * behaviour.statics.ratio),
        "gain" => gain * gain,
        "force" => gain,
        // Twice the speed by half of the reduction before the transmission: half of the torque at its input.
        "double" => output(0.5 * INPUT_NM) / INPUT_NM,
        _ => return None,
    })
}

/// The gap between so many planets, modules.
fn gap(design: &Design, planets: usize) -> Option<f64> {
    let mut set = planetary(design)?;
    set.planets = u32::try_from(planets).ok()?;
    Some(set.neighbour_gap_m() / design.built.gears.module_m)
}

fn planetary(design: &Design) -> Option<PlanetarySet> {
    let [sun, planet, ring] = wheels(&design.built.gears).ok()?;
    PlanetarySet::new(sun, planet, ring, design.built.gears.planets).ok()
}

/// Gears, and the design space.
fn gears(design: &Design, name: &str) -> Option<f64> {
    let set = planetary(design)?;
    let teeth = set.teeth();
    let path = set.sun_planet.path();
    let module_m = design.built.gears.module_m;
    Some(match name {
        "labels" => Teeth { sun: 18, planet: 48, ring: 12 }.reduction(),
        "ring" => f64::from(Teeth::standard(teeth.sun, teeth.planet).ring),
        "assembly" => f64::from((teeth.sun + teeth.ring) % set.planets),
        "wrongly" => f64::from(judged()[0]),
        "wrongly_taken" => f64::from(judged()[1]),
        "undercut_sun" => least_shift(&set.sun_planet.pinion),
        "undercut_planet" => least_shift(&set.planet_ring.pinion),
        "ring_addendum" => 0.5 * f64::from(teeth.ring) - wheel_tip_limit_m(&set.planet_ring) / module_m,
        "contact" => path.contact_ratio(path.tips),
        "contact_cut" => path.contact_ratio(path.between_interference_points()),
        "trochoid" => trochoid_rad(&set.planet_ring)?,
        "trimming" => trimming_rad(&set.planet_ring),
        "sets" => space().sets().count() as f64,
        _ => return None,
    })
}

/// Gears of the paper's requirements, before any rule.
fn space() -> TeethSearch {
    TeethSearch {
        sun: 10..=24,
        planet: 10..=60,
        planets: 3..=4,
        excess: 0..=0,
        reduction: [0.0, 1.0],
        most_ring: u32::MAX,
        least_gap: f64::NEG_INFINITY,
        equal_angles: false,
    }
}

/// Sets of sun 8 to 30, planets 8 to 60, 2 to 6 of them: rejected by the paper's condition although they go together, and accepted although
/// they do not.
fn judged() -> [u32; 2] {
    let mut wrong = [0; 2];
    for (sun, planet) in (8..=30).flat_map(|sun| (8..=60).map(move |planet| (sun, planet))) {
        for planets in 2..=6 {
            let fits = Teeth::standard(sun, planet).fit_equally(planets);
            let paper = (sun + planet) % planets == 0;
            wrong[0] += u32::from(fits && !paper);
            wrong[1] += u32::from(paper && !fits);
        }
    }
    wrong
}
