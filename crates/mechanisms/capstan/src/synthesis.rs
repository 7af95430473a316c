//! From requirements to cable drives: constructions, diameters, drums, turns, cables, centre distances in line and the smallest preload,
//! ranked by the room that they take.

#[cfg(test)]
mod brute;
mod front;
mod limits;
mod rivals;
mod section;
mod sizing;
mod write;

pub(crate) use section::Synthesise;

use std::sync::OnceLock;

use forcewright_base::diagnostics::{Diagnostic, Diagnostics};
use forcewright_base::maths;
use forcewright_base::units::{format_number, format_si};
use forcewright_contract::metrics::Limit;
use forcewright_contract::synthesis::{Judgement, Proposal, Relaxation, Skeleton, Synthesiser, Watch};
use forcewright_elements::cables;
use forcewright_elements::grooves::{Groove, Pressure};
use forcewright_model::{CheckState, Outcome, ParameterRow, StatusKind, StudyColumn, StudyTable};

use crate::design::{Bearings, Design, Seat, Source, si};
use crate::geometry::Belt;
use crate::metrics::CapstanMetrics;
use crate::spec::Spec;
use limits::Knob;
use sizing::{Asked, Found, Merits, Rope, Size, merits, search};

/// A drive of no particular size, for files that have none.
pub(crate) const SKELETON: Skeleton = Skeleton {
    roots: &["design", "optimise", "tolerance"],
    sections: r#"
[design]
input_diameter = "20 mm"
output_diameter = "100 mm"
diameters = "rope centre"
centre_distance = "65 mm"
extra_turns = 3
travel = "90 deg"
groove = { profile = "round", seat_angle = "135 deg", pitch = "2 mm" }
friction = 0.15
expansion = "1e-5 1/K"

[[design.cables]]
use = "7x19 stainless 1.5 mm"
lines = [0, 4]
preload = "1 N"
expansion = "1e-5 1/K"
"#,
};

/// Files written where the project does not say.
const CANDIDATES: u32 = 5;
/// Designs analysed for each file wanted.
const TRIED_PER_FILE: usize = 2;
/// Diameters of cable that shops have, mm.
const CABLES_MM: [f64; 14] = [0.5, 0.6, 0.8, 1.0, 1.2, 1.5, 1.8, 2.0, 2.5, 3.0, 3.2, 4.0, 5.0, 6.0];
/// Ends of the default series of input drums, 1/40 of a decade from 1 mm: 6.0 mm and 200 mm.
const INPUTS_R40: [i32; 2] = [31, 92];
/// Ends of the preloads, 1/40 of a decade from 1 N: to 100 kN.
const PRELOADS_R40: [i32; 2] = [0, 200];
/// Angles of grooves where the project does not say, rad: 135° of a round seat, 60° between flanks.
const ROUND_RAD: f64 = 0.75 * std::f64::consts::PI;
const VEE_RAD: f64 = std::f64::consts::FRAC_PI_3;

struct Synthesis {
    asked: Asked,
    wanted: usize,
    found: OnceLock<Found>,
    factors: OnceLock<Vec<(Knob, f64)>>,
}

/// A term of the series R40 (ISO 3), computed and rounded to three digits.
fn r40(i: i32) -> f64 {
    let exact = maths::powf(10.0, f64::from(i) / 40.0);
    let place = maths::powf(10.0, maths::log10(exact).floor() - 2.0);
    (exact / place).round() * place
}

/// The synthesis that a file asks for. What is missing for it goes into `diagnostics`.
pub(crate) fn synthesiser(spec: &Spec, design: &Design, diagnostics: &mut Diagnostics) -> Option<Box<dyn Synthesiser>> {
    let section = &spec.synthesise;
    let place = section.present.as_ref().or(spec.requirements.present.as_ref()).map(|p| p.span).unwrap_or_default();
    for (lacks, key, help) in [
        (design.requirements.is_none(), "requirements.torque", "add `[requirements]` with `torque = \"10 N*m\"`, at the output"),
        (section.ratio.is_none(), "synthesise.ratio", "add `ratio = 5` to `[synthesise]`"),
        (section.travel.is_none(), "synthesise.travel", "add `travel = \"270 deg\"` to `[synthesise]`"),
        (section.friction.is_none(), "synthesise.friction", "add `friction = 0.15` to `[synthesise]`, as measured of cable and drum"),
    ] {
        if lacks {
            let message = format!("a synthesis needs `{key}`");
            diagnostics.push(Diagnostic::error("E0720", place, message).label("not here").help(help));
        }
    }
    if design.source == Source::Paper || design.built.warmer_k != 0.0 {
        let message = "a synthesis knows neither the paper's model nor a change of temperature";
        let help = "leave out `model.source` and `environment.temperature_change`, and put them into the files written";
        diagnostics.push(Diagnostic::error("E0722", place, message).label("asked for here").help(help));
    }
    let ropes = ropes(spec, diagnostics);
    if diagnostics.has_errors() {
        return None;
    }
    let asked = asked(spec, design, ropes)?;
    for limit in &asked.limits {
        refuse_unknown(spec, &asked, limit, diagnostics);
    }
    if diagnostics.has_errors() {
        return None;
    }
    let wanted = section.candidates.as_ref().map_or(CANDIDATES, |c| c.value) as usize;
    Some(Box::new(Synthesis { asked, wanted, found: OnceLock::new(), factors: OnceLock::new() }))
}

/// E0723: limits on metrics that no design of this synthesis has a value of.
fn refuse_unknown(spec: &Spec, asked: &Asked, limit: &Limit, diagnostics: &mut Diagnostics) {
    let built = &asked.template.built;
    let bearings = &built.bearings;
    let needs_bore = bearings.friction != Some(0.0);
    let losses = [
        ("synthesise.bearings.friction", bearings.friction.is_none()),
        ("synthesise.bearings.input_bore", needs_bore && bearings.bores_m[0].is_none()),
        ("synthesise.bearings.output_bore", needs_bore && bearings.bores_m[1].is_none()),
        ("synthesise.bending_loss", asked.bending_loss.is_none()),
    ];
    let [input, output] = built.inertia_kg_m2.map(|i| i.is_none());
    let inertias = [("inertia.input", input), ("inertia.output", output)];
    let alone = asked.most_cables == 1 && asked.most_turns == 0;
    let needs: Vec<(&str, bool)> = match limit.name::<CapstanMetrics>() {
        "backdrive_torque_output" | "efficiency_forward" | "efficiency_backward" | "torque_input" => losses.to_vec(),
        "torsional_frequency_free" | "reflected_inertia_output" => inertias.to_vec(),
        "torsional_frequency" => inertias[1..].to_vec(),
        "wire_bending_stress" => vec![("synthesise.constructions with wires", asked.ropes.iter().all(|r| r.construction.wires.is_none()))],
        // A single wrap of a single cable has no neighbour.
        "occupancy_clearance" => vec![("synthesise.extra_turns_max or cables_max above it", alone)],
        _ => return,
    };
    let missing: Vec<&str> = needs.iter().filter(|(_, lacks)| *lacks).map(|(key, _)| *key).collect();
    if missing.is_empty() {
        return;
    }
    let name = limit.name::<CapstanMetrics>();
    let bounds = &spec.requirements.limits.bounds;
    let at = bounds.get(limit.metric).and_then(|b| b.present.as_ref()).map(|p| p.span).unwrap_or_default();
    let message = format!("no design of this synthesis has a value of `{name}`: the limit can never be met");
    let help = format!("not known: {}; give it, or take the limit out", missing.join(", "));
    diagnostics.push(Diagnostic::error("E0723", at, message).label("this limit").help(help));
}

/// E0721: the cables that there are, of which all is known.
fn ropes(spec: &Spec, diagnostics: &mut Diagnostics) -> Vec<Rope> {
    let section = &spec.synthesise;
    let diameters_m: Vec<f64> = section
        .cable_diameters
        .as_ref()
        .map_or_else(|| CABLES_MM.map(|mm| 1e-3 * mm).to_vec(), |typed| typed.value.iter().map(|q| q.si).collect());
    let complete = |construction: &'static cables::Construction| {
        let rope = |d: &f64| {
            Some(Rope {
                construction,
                diameter_m: *d,
                axial_n: construction.axial_stiffness_n(*d)?,
                breaking_n: construction.breaking_force_n(*d)?,
                least_ratio: construction.least_ratio.as_ref()?.value,
            })
        };
        diameters_m.iter().filter_map(rope).collect::<Vec<_>>()
    };
    let Some(names) = &section.constructions else { return cables::catalogue().iter().flat_map(complete).collect() };
    let mut all = Vec::new();
    for name in &names.value {
        let found = cables::find(&name.value).map(complete).unwrap_or_default();
        if found.is_empty() {
            let message = format!("no cable of \"{}\" can be used", name.value);
            let usable: Vec<&str> = cables::catalogue().iter().filter(|c| !complete(c).is_empty()).map(|c| c.name.as_str()).collect();
            let help = format!("in these diameters stiffness, strength and least drum are known of: {}", usable.join(", "));
            diagnostics.push(Diagnostic::error("E0721", name.span, message).label("not complete").help(help));
        }
        all.extend(found);
    }
    all
}

fn asked(spec: &Spec, design: &Design, ropes: Vec<Rope>) -> Option<Asked> {
    let section = &spec.synthesise;
    let requirements = design.requirements.as_ref()?;
    let groove_rad = si(&section.groove_angle);
    let groove = if section.groove.as_ref().is_some_and(|g| g.value == "v") {
        Groove::Vee { half_angle_rad: 0.5 * groove_rad.unwrap_or(VEE_RAD) }
    } else {
        Groove::Round { half_angle_rad: 0.5 * groove_rad.unwrap_or(ROUND_RAD), pressure: Pressure::Cosine }
    };
    let seat = Seat { groove, radius_m: None, depth_m: None };
    let belt = if section.belt.as_ref().is_some_and(|b| b.value == "open") { Belt::Open } else { Belt::Crossed };
    let typed = &section.bearings;
    let bearings = Bearings {
        friction: si(&typed.friction),
        bores_m: [si(&typed.input_bore), si(&typed.output_bore)],
        drags_nm: [si(&typed.input_drag).unwrap_or(0.0), si(&typed.output_drag).unwrap_or(0.0)],
    };
    let [from, to] = INPUTS_R40;
    let mut inputs_m: Vec<f64> = section
        .input_diameters
        .as_ref()
        .map_or_else(|| (from..=to).map(|i| 0.5e-3 * r40(i)).collect(), |typed| typed.value.iter().map(|q| 0.5 * q.si).collect());
    inputs_m.sort_by(f64::total_cmp);
    inputs_m.dedup();
    let side = |slot| si(slot).unwrap_or(f64::INFINITY);
    let [first, last] = PRELOADS_R40;
    Some(Asked {
        torque_nm: requirements.torque_nm,
        stiffness_nm_per_rad: requirements.stiffness_nm_per_rad.unwrap_or(0.0),
        lost_motion_rad: requirements.lost_motion_rad.unwrap_or(f64::INFINITY),
        safety: requirements.safety_factor.unwrap_or(1.0),
        limits: requirements.limits.clone(),
        ratio: si(&section.ratio)?,
        travel_rad: si(&section.travel)?,
        envelope_m: [side(&section.envelope.diameter), side(&section.envelope.width), side(&section.envelope.length)],
        pitch_ratio: si(&section.pitch_ratio).unwrap_or(1.25),
        preload_loss: si(&section.preload_loss).unwrap_or(0.0),
        bending_loss: si(&section.bending_loss),
        most_turns: section.extra_turns_max.as_ref().map_or(9, |c| c.value),
        most_cables: section.cables_max.as_ref().map_or(6, |c| c.value),
        ropes,
        inputs_m,
        preloads_n: (first..=last).map(r40).collect(),
        template: sizing::template(design, (belt, si(&section.friction)?, seat, si(&section.anchor_wrap)?), bearings),
    })
}

/// Proposals for sizes, with what no other one of them is better in.
fn written(asked: &Asked, sizes: &[Size]) -> Vec<Proposal> {
    let all: Vec<(&Size, Merits)> = sizes.iter().filter_map(|s| Some((s, merits(asked, s)?))).collect();
    let kept = |m: &Merits| !all.iter().any(|(_, other)| other.dominates(m));
    all.iter().map(|(size, m)| write::proposal(asked, size, m, kept(m))).collect()
}

impl Synthesis {
    fn found(&self, watch: Watch<'_>) -> &Found {
        self.found.get_or_init(|| search(&self.asked, TRIED_PER_FILE * self.wanted, watch))
    }

    fn factors(&self, watch: Watch<'_>) -> &[(Knob, f64)] {
        let all = Knob::ALL.len() as f64;
        let factor = |(i, knob): (usize, &Knob)| Some((*knob, limits::factor(&self.asked, *knob, &|part| watch((i as f64 + part) / all))?));
        self.factors.get_or_init(|| Knob::ALL.iter().enumerate().filter_map(factor).collect())
    }

    /// The best design with its cables arranged otherwise.
    fn arrangements(&self, best: &Size) -> StudyTable {
        let asked = &self.asked;
        let units = &asked.template.units;
        let starts = asked.starts();
        let share = best.preload_n * f64::from(best.frame.cables);
        let force = |n: f64| format_si(n, &units.force, 4);
        let mut wanted = vec![(best.frame.cables, best.preload_n), (1, share), (2, 0.5 * share), (2, share)];
        if starts > 2 {
            wanted.push((starts, share / f64::from(starts)));
        }
        let mut rows = Vec::new();
        let mut seen: Vec<(u32, f64)> = Vec::new();
        for (cables, preload_n) in wanted {
            if seen.contains(&(cables, preload_n)) {
                continue;
            }
            seen.push((cables, preload_n));
            let name = format!("{cables} × {}", force(preload_n));
            let mut free = asked.clone();
            free.envelope_m[1] = f64::INFINITY;
            let frame = sizing::Frame { cables, ..best.frame };
            let there = sizing::placed(&free, &frame, f64::INFINITY)
                .and_then(|(between, width_m)| merits(asked, &Size { frame, between, preload_n, width_m, ..*best }));
            rows.push(there.map_or_else(
                || {
                    let mut row = vec![name.clone(), "slips, or its cables touch".to_owned()];
                    row.resize(7, "–".to_owned());
                    row
                },
                |m| write::row(name.clone(), &m, asked.torque_nm, units),
            ));
        }
        let head = ["Cables and preload", "Stiffness", "Lost motion", "Slip torque over torque", "Safety factor", "Shaft load", "Width"];
        let column =
            |(i, name): (usize, &str)| if i == 0 { StudyColumn::Text(name.to_owned()) } else { StudyColumn::Number(name.to_owned()) };
        StudyTable {
            caption: "The drums and turns of the first design with other numbers of cables: the same preload in all, or the same in each"
                .to_owned(),
            columns: head.into_iter().enumerate().map(column).collect(),
            rows,
        }
    }
}

impl Synthesiser for Synthesis {
    fn wanted(&self) -> usize {
        self.wanted
    }

    fn proposals(&self, watch: Watch<'_>) -> Vec<Proposal> {
        written(&self.asked, &self.found(watch).sizes)
    }

    fn judge(&self, _: &Proposal, outcome: &Outcome) -> Judgement {
        if outcome.status.kind != StatusKind::Complete {
            return Judgement::Reject(outcome.status.message.clone());
        }
        let missed = outcome.checks.iter().find(|c| !c.required && c.state == CheckState::Missed);
        missed.map_or(Judgement::Keep, |check| Judgement::Reject(check.title.clone()))
    }

    fn searched(&self, proposal: &Proposal, _: &[ParameterRow]) -> Proposal {
        // Its files have nothing that a search could change.
        proposal.clone()
    }

    fn alike(&self, a: &Proposal, b: &Proposal) -> bool {
        let kind = |p: &Proposal| write::read(&p.state).map(|s| (s.frame.rope, s.frame.cables));
        kind(a).is_some() && kind(a) == kind(b)
    }

    fn relaxations(&self, slack: f64, watch: Watch<'_>) -> Vec<Relaxation> {
        self.factors(watch).iter().filter_map(|(knob, factor)| limits::relaxation(&self.asked, *knob, factor * (1.0 + slack))).collect()
    }

    fn nearest(&self, watch: Watch<'_>) -> Vec<Proposal> {
        // What must be loosened least.
        let least = self.factors(watch).iter().min_by(|a, b| a.1.total_cmp(&b.1));
        let loosened = least.and_then(|(knob, factor)| limits::loosened(&self.asked, *knob, *factor));
        loosened.map_or_else(Vec::new, |other| {
            let found = search(&other, 2, watch);
            // The file still asks for what it asked.
            let kept = Asked { envelope_m: self.asked.envelope_m, ..other };
            written(&kept, &found.sizes)
        })
    }

    fn effort(&self) -> Option<String> {
        let found = self.found.get()?;
        let cut = if found.cut { " The search was cut short: there may be better ones." } else { "" };
        Some(format!(
            "{} million combinations; what cannot be better was left out, {} loaded states and {} arrangements in space were computed.{cut}",
            format_number(1e-6 * found.candidates, 3),
            found.states,
            found.placed
        ))
    }

    fn tables(&self, best: &Proposal, watch: Watch<'_>) -> Vec<StudyTable> {
        let Some(size) = write::read(&best.state) else { return Vec::new() };
        let rivals = merits(&self.asked, &size).map(|merits| rivals::table(&self.asked, &size.frame, &merits));
        let known = self.found.get().map_or(&[][..], |found| &found.sizes[..]);
        let had = front::front(&self.asked, known, watch);
        std::iter::once(self.arrangements(&size)).chain(rivals).chain([front::table(&self.asked, &had)]).collect()
    }
}
