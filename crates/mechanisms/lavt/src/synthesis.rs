//! From requirements to transmissions: every gear set and every spring of a grid, kept at both ends of the friction and at all corners of
//! the tolerances; of what remains the designs that no other one beats.

mod asked;
#[cfg(test)]
mod brute;
mod front;
mod gears;
mod limits;
mod search;
mod section;
mod springs;
mod write;

pub(crate) use section::Synthesise;

use std::sync::OnceLock;

use forcewright_base::diagnostics::{Diagnostic, Diagnostics};
use forcewright_base::units::format_number;
use forcewright_contract::synthesis::{Judgement, Proposal, Relaxation, Skeleton, Synthesiser, Watch};
use forcewright_model::{CheckState, Outcome, ParameterRow, StatusKind, StudyColumn, StudyTable};

use crate::analysis::{Behaviour, measure};
use crate::design::{Design, Source, place_of};
use crate::metrics::METRICS;
use crate::spec::Spec;
use asked::Asked;
use front::chosen;
use gears::Book;
use limits::Knob;
use search::{Found, search};
use write::{Row, percent, torque, volume};

/// A transmission of no particular size, for files that have none: it shifts with any friction that is usual.
pub(crate) const SKELETON: Skeleton = Skeleton {
    roots: &["design", "optimise", "tolerance"],
    sections: r#"
[design.gears]
sun = 18
planet = 27
planets = 3
module = "0.5 mm"

[design.spring]
wire_diameter = "1 mm"
inner_diameter = "16.4 mm"
hub_turns = 6
free_turns = 6
bore_turns = 6

[design.hub]
diameter = "18 mm"

[design.bore]
diameter = "19.4 mm"

[design.friction]
hub = 0.2
bore = 0.2
"#,
};

/// Files written where the project does not say.
const CANDIDATES: u32 = 5;
/// Codes of advice that a proposal may miss: only needed where the hand opens against the torque, or must be fast again by itself.
const MAY_MISS: [&str; 2] = ["LAVT009", "LAVT018"];

struct Synthesis {
    asked: Asked,
    wanted: usize,
    book: Book,
    found: OnceLock<Found>,
    nearest: OnceLock<Vec<(Knob, f64)>>,
}

/// The synthesis that a file asks for. What is missing for it goes into `diagnostics`.
pub(crate) fn synthesiser(spec: &Spec, design: &Design, diagnostics: &mut Diagnostics) -> Option<Box<dyn Synthesiser>> {
    let section = &spec.synthesise;
    let place = section.present.as_ref().or(spec.requirements.present.as_ref()).map(|p| p.span).unwrap_or_default();
    for (lacks, key, help) in [
        (design.requirements.is_none(), "requirements.input_torque", "add `[requirements]` with `input_torque = \"100 N*mm\"`"),
        (
            section.friction.is_none(),
            "synthesise.friction",
            "add `friction = \"0.15 ± 0.03\"` to `[synthesise]`: nobody knows it without a range",
        ),
    ] {
        if lacks {
            let message = format!("a synthesis needs `{key}`");
            diagnostics.push(Diagnostic::error("E0840", place, message).label("not here").help(help));
        }
    }
    if design.source == Source::Paper {
        let message = "a synthesis does not know the paper's model: most of what that passes slips";
        let error = Diagnostic::error("E0845", place_of(&spec.model), message).label("asked for here");
        diagnostics.push(error.help("leave out `model.source`, and put it into the files written"));
    }
    refuse_unknown(spec, design, diagnostics);
    let asked = asked::asked(spec, design, diagnostics).filter(|_| !diagnostics.has_errors())?;
    let wanted = section.candidates.as_ref().map_or(CANDIDATES, |c| c.value) as usize;
    Some(Box::new(Synthesis { asked, wanted, book: Book::default(), found: OnceLock::new(), nearest: OnceLock::new() }))
}

/// E0844: limits on metrics that no design of this file has.
fn refuse_unknown(spec: &Spec, design: &Design, diagnostics: &mut Diagnostics) {
    let Some(required) = &design.requirements else { return };
    let mut probe = design.clone();
    probe.built.gears.friction = spec.synthesise.flank_friction.as_ref().map(|l| l.value.si);
    let Ok(behaviour) = Behaviour::of(&probe) else { return };
    // With an input torque at which this one is in mode II, whatever the file asks for.
    if let Some(asked) = &mut probe.requirements {
        let statics = &behaviour.statics;
        asked.input_nm = 0.5 * (statics.plateau_end_nm(statics.transition_output_nm()) + statics.held_input_nm());
    }
    let measured = measure(&probe, &behaviour);
    for limit in &required.limits {
        if measured.value(limit.metric).is_some() {
            continue;
        }
        let name = METRICS.get(limit.metric).map_or("", |m| m.name);
        let at = spec.requirements.limits.bounds.get(limit.metric).map(place_of).unwrap_or_default();
        let message = format!("no design of this file has `{name}`, so that its limit cannot be kept");
        let help =
            "leave the limit out, or add what the metric needs: `[motor]`, `[hand]`, `[material.gears]`, `synthesise.flank_friction`";
        diagnostics.push(Diagnostic::error("E0844", at, message).label("limited here").help(help));
    }
}

/// Proposals for what was found.
fn written(asked: &Asked, found: &Found, wanted: usize) -> Vec<Proposal> {
    chosen(&found.front, wanted).into_iter().map(|(i, role)| write::proposal(asked, found, &found.front[i], role)).collect()
}

impl Synthesis {
    fn found(&self, watch: Watch<'_>) -> &Found {
        self.found.get_or_init(|| search(&self.asked, &self.book, watch))
    }

    fn nearest_values(&self, watch: Watch<'_>) -> &[(Knob, f64)] {
        let all = Knob::ALL.len() as f64;
        let one = |(i, knob): (usize, &Knob)| {
            let part = |part: f64| watch((i as f64 + part) / all);
            Some((*knob, limits::nearest(&self.asked, *knob, &self.book, &part)?))
        };
        self.nearest.get_or_init(|| Knob::ALL.iter().enumerate().filter_map(one).collect())
    }

    /// The designs proposed beside each other.
    fn trade_offs(&self, found: &Found) -> StudyTable {
        let units = &self.asked.template.units;
        let row = |(i, role): (usize, usize)| {
            let row = Row::new(&self.asked, &found.front[i], units);
            vec![write::ROLES[role].1.to_owned(), row.volume, row.output, row.efficiency, row.friction, row.gap]
        };
        let head = ["Chosen for", "Volume", "Output torque", "Efficiency", "Friction needed", "Room between the gaps"];
        StudyTable {
            caption: format!(
                "Trade-offs: of {} designs none of which is beaten in everything by another. Friction needed: the least with which the bore still holds at every corner of the tolerances. Room between the gaps: by how much the hub may be less tight, on the radius, beyond the worst corner",
                found.front.len()
            ),
            columns: columns(&head),
            rows: chosen(&found.front, self.wanted).into_iter().map(row).collect(),
        }
    }

    /// What there is for each ratio.
    fn speeds(&self, found: &Found) -> StudyTable {
        let units = &self.asked.template.units;
        let least = self.asked.frictions()[0][0];
        let row = |s: &search::Speed| {
            vec![
                format_number(1.0 / s.ratio, 4),
                s.sets.to_string(),
                s.springs.to_string(),
                volume(s.least_m3),
                torque(s.most_output_nm, units),
                percent(s.ratio * s.most_output_nm / self.asked.input_nm),
                format_number(s.least_friction * least, 3),
            ]
        };
        let head = ["Speed drop", "Gear sets", "Springs", "Smallest volume", "Largest output", "Best efficiency", "Least friction"];
        StudyTable {
            caption: "What keeps everything, by the ratio of the gears".to_owned(),
            columns: columns(&head),
            rows: found.speeds.iter().rev().map(row).collect(),
        }
    }
}

fn columns(head: &[&str]) -> Vec<StudyColumn> {
    let column = |(i, name): (usize, &&str)| {
        if i == 0 { StudyColumn::Text((*name).to_owned()) } else { StudyColumn::Number((*name).to_owned()) }
    };
    head.iter().enumerate().map(column).collect()
}

impl Synthesiser for Synthesis {
    fn wanted(&self) -> usize {
        self.wanted
    }

    fn proposals(&self, watch: Watch<'_>) -> Vec<Proposal> {
        written(&self.asked, self.found(watch), self.wanted)
    }

    fn judge(&self, _: &Proposal, outcome: &Outcome) -> Judgement {
        if outcome.status.kind != StatusKind::Complete {
            return Judgement::Reject(outcome.status.message.clone());
        }
        let missed = |c: &&forcewright_model::Check| !c.required && c.state == CheckState::Missed && !MAY_MISS.contains(&c.code);
        outcome.checks.iter().find(missed).map_or(Judgement::Keep, |check| Judgement::Reject(check.title.clone()))
    }

    fn searched(&self, proposal: &Proposal, _: &[ParameterRow]) -> Proposal {
        // Its files have nothing that a search could change.
        proposal.clone()
    }

    fn alike(&self, a: &Proposal, b: &Proposal) -> bool {
        let bits = |p: &Proposal| p.state.iter().map(|x| x.to_bits()).collect::<Vec<_>>();
        bits(a) == bits(b)
    }

    fn relaxations(&self, slack: f64, watch: Watch<'_>) -> Vec<Relaxation> {
        let all = self.nearest_values(watch).iter();
        all.filter_map(|(knob, value)| limits::relaxation(&self.asked, *knob, limits::loosened(*knob, *value, slack))).collect()
    }

    fn nearest(&self, watch: Watch<'_>) -> Vec<Proposal> {
        // What must be loosened least.
        let far =
            |(knob, value): &(Knob, f64)| knob.now(&self.asked).map_or(f64::INFINITY, |now| forcewright_base::maths::ln(value / now).abs());
        let least = self.nearest_values(watch).iter().min_by(|a, b| far(a).total_cmp(&far(b)));
        least.map_or_else(Vec::new, |(knob, value)| {
            let value = limits::loosened(*knob, *value, 0.0);
            let other = knob.with(&self.asked, value);
            let found = search(&other, &self.book, watch);
            // The file still asks for what it asked, and may keep it as drawn, if not at every corner.
            let kept = Asked { envelope_m: self.asked.envelope_m, stress_pa: self.asked.stress_pa, ..other };
            let text = limits::relaxation(&self.asked, *knob, value).map_or_else(String::new, |r| r.text);
            let named = |p: Proposal| {
                let title = format!("nearest, with {} of {text} at the corners: {}", knob.named().1, p.title);
                Proposal { topology: "nearest", title, ..p }
            };
            written(&kept, &found, 2).into_iter().map(named).collect()
        })
    }

    fn effort(&self) -> Option<String> {
        let found = self.found.get()?;
        let [gears, springs] = found.raw;
        let cut = if found.cut { " The search was cut short at the limits on metrics: there may be better ones." } else { "" };
        Some(format!(
            "{} gear sets × {} springs: {} million combinations, all of them looked at. {} gear sets can be put together and keep the speed. {} springs reach the bore at the least friction and every corner of the tolerances; {} designs keep everything, {} of them are not beaten in everything by another. Of {} gear sets with such springs {} cannot be made to run by profile shift, and {} have no room.{cut}",
            format_number(gears, 12),
            format_number(springs, 12),
            format_number(1e-6 * gears * springs, 4),
            found.assembled,
            found.springs,
            found.feasible,
            found.front.len(),
            found.sound + found.large + found.blocked,
            found.blocked,
            found.large,
        ))
    }

    fn tables(&self, _: &Proposal, watch: Watch<'_>) -> Vec<StudyTable> {
        let found = self.found(watch);
        vec![self.trade_offs(found), self.speeds(found)]
    }
}
