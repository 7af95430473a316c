//! From requirements to designs: springs of a catalogue or free ones, rollers, braces and preload, each with the cam that gives the
//! force exactly, without undercut, ranked by the room that they take.

mod limits;
mod section;
mod sizing;
mod write;

pub(crate) use section::Synthesise;

use forcewright_base::diagnostics::{Diagnostic, Diagnostics};
use forcewright_base::units::{Dimension, Unit};
use forcewright_contract::data::{Column, rows};
use forcewright_contract::synthesis::{Judgement, Proposal, Relaxation, Skeleton, Synthesiser, Watch};
use forcewright_model::{Outcome, ParameterRow, StatusKind};

use crate::design::{Design, si};
use crate::metrics::CamMetrics;
use crate::spec::Spec;
use limits::Knob;
use sizing::{Asked, Offer, Size, sizes, wound};

/// A mechanism of no particular size, for files that have none.
pub(crate) const SKELETON: Skeleton = Skeleton {
    roots: &["design", "errors", "optimise", "variants"],
    sections: r#"
[design]
brace_length = "10 m"
roller_diameter = "1 mm"
stroke = "10 m"
profile = { for_force = "1 mN", for_rate = "1 N/mm", for_rest_length = "100 mm" }
springs = { rate = "1 N/mm", rest_length = "100 mm" }
"#,
};

/// Files written where the project does not say.
const CANDIDATES: u32 = 5;
/// Proposals analysed for each file wanted.
const TRIED_PER_FILE: usize = 2;
/// Two designs with the same springs and rollers are different if their room differs by this part.
const DIFFERENT: f64 = 0.1;
/// Outer diameters of small ball bearings that serve as rollers, mm: 623, 624, 625, 626, 608, 6000, 6001, 6002 (ISO 15).
const BEARINGS_MM: [f64; 8] = [10.0, 13.0, 16.0, 19.0, 22.0, 26.0, 28.0, 32.0];
/// Rows of a catalogue of springs.
const MOST_SPRINGS: usize = 300;

struct Synthesis {
    asked: Asked,
    wanted: usize,
    length: Unit,
}

/// The synthesis that a file asks for. What is missing for it goes into `diagnostics`.
pub(crate) fn synthesiser(spec: &Spec, design: &Design, diagnostics: &mut Diagnostics) -> Option<Box<dyn Synthesiser>> {
    let place = spec.requirements.present.as_ref().map(|p| p.span).unwrap_or_default();
    let requirements = design.requirements.as_ref();
    let force = requirements.and_then(|r| r.force.clone());
    let stroke = spec.requirements.stroke.as_ref();
    for (lacks, key, help) in [
        (force.is_none(), "requirements.force", "add `force = { nominal = \"50 N\", band = \"3 %\" }` to `[requirements]`"),
        (stroke.is_none(), "requirements.stroke", "add `stroke = \"200 mm\"` to `[requirements]`"),
    ] {
        if lacks {
            let message = format!("a synthesis needs `{key}`");
            diagnostics.push(Diagnostic::error("E0630", place, message).label("asked for here").help(help));
        }
    }
    let offers = offers(spec, diagnostics)?;
    if diagnostics.has_errors() {
        return None;
    }
    let ((law, band), stroke) = (force?, stroke?);
    let section = &spec.synthesise;
    let millimetres = |mm: &f64| 1e-3 * mm;
    let rollers_m = section
        .roller_diameters
        .as_ref()
        .map_or_else(|| BEARINGS_MM.iter().map(millimetres).collect(), |typed| typed.value.iter().map(|q| q.si).collect());
    let limit = |name: &str| requirements?.limits.iter().find(|l| l.name::<CamMetrics>() == name)?.max;
    let asked = Asked {
        law,
        band,
        stroke_m: stroke.value.si,
        window_m: design.window_m,
        hysteresis: requirements.and_then(|r| r.hysteresis),
        room_m: section.room.as_ref().map_or([limit("width").unwrap_or(f64::INFINITY), limit("height").unwrap_or(f64::INFINITY)], |room| {
            [room.value[0].si, room.value[1].si]
        }),
        arm_m: si(&section.rolling_arm).unwrap_or(0.0),
        gravity_m_per_s2: design.built.gravity_m_per_s2,
        offers,
        most_springs: section.springs_max.as_ref().map_or(6, |c| c.value),
        rollers_m,
        grade: section.wire_grade.as_ref().map_or_else(String::new, |g| g.value.to_owned()),
    };
    Some(Box::new(Synthesis {
        asked,
        wanted: section.candidates.as_ref().map_or(CANDIDATES, |c| c.value) as usize,
        length: stroke.value.unit.clone(),
    }))
}

/// The springs that there are: those of the file, or any that may be stretched to so many times their rest length.
fn offers(spec: &Spec, diagnostics: &mut Diagnostics) -> Option<Vec<Offer>> {
    let section = &spec.synthesise;
    let Some(file) = &section.springs_file else {
        let ratio = si(&section.extension_max).unwrap_or(2.0);
        return Some(vec![Offer::Free { extension: ratio }]);
    };
    let column = |name, dimension| Column { name, dimension };
    let columns = [
        column("rate", Dimension::Stiffness),
        column("rest length", Dimension::Length),
        column("largest length", Dimension::Length),
        column("mass", Dimension::Mass),
    ];
    let found = rows(&file.value, &columns, MOST_SPRINGS, diagnostics)?;
    let mut offers = Vec::new();
    for [rate, rest, most, mass] in found {
        if !(rate.si > 0.0 && rest.si > 0.0 && most.si > rest.si && mass.si >= 0.0) {
            diagnostics.push(
                Diagnostic::error("E0631", rate.span, "this row is no extension spring")
                    .label("in this row")
                    .help("rate, rest length and mass are above zero, and the largest length is above the rest length"),
            );
            return None;
        }
        offers.push(Offer::Spring { rate_n_per_m: rate.si, rest_m: rest.si, most_m: most.si, mass_kg: mass.si });
    }
    Some(offers)
}

impl Synthesis {
    fn written(&self, asked: &Asked, most: usize) -> Vec<Proposal> {
        picked(asked, most).iter().map(|size| write::proposal(asked, size, &self.length)).collect()
    }
}

/// The cheapest of each kind, the best first.
fn picked(asked: &Asked, most: usize) -> Vec<Size> {
    let mut found = sizes(asked);
    found.sort_by(|a, b| a.cost_m3().total_cmp(&b.cost_m3()));
    let mut kept: Vec<Size> = Vec::new();
    for size in found {
        if !kept.iter().any(|k| k.is_near(&size)) {
            kept.extend(wound(asked, size));
        }
        if kept.len() == most {
            break;
        }
    }
    kept
}

impl Synthesiser for Synthesis {
    fn wanted(&self) -> usize {
        self.wanted
    }

    fn proposals(&self, _: Watch<'_>) -> Vec<Proposal> {
        self.written(&self.asked, TRIED_PER_FILE * self.wanted)
    }

    fn judge(&self, _: &Proposal, outcome: &Outcome) -> Judgement {
        if outcome.status.kind == StatusKind::Complete { Judgement::Keep } else { Judgement::Reject(outcome.status.message.clone()) }
    }

    fn searched(&self, proposal: &Proposal, _: &[ParameterRow]) -> Proposal {
        // Its files have nothing that a search could change.
        proposal.clone()
    }

    fn alike(&self, a: &Proposal, b: &Proposal) -> bool {
        write::read(&a.state).zip(write::read(&b.state)).is_some_and(|(a, b)| a.is_near(&b))
    }

    fn relaxations(&self, slack: f64, _: Watch<'_>) -> Vec<Relaxation> {
        Knob::ALL
            .iter()
            .filter_map(|knob| limits::relaxed(&self.asked, *knob, slack, &self.length))
            .map(|(relaxation, _)| relaxation)
            .collect()
    }

    fn nearest(&self, _: Watch<'_>) -> Vec<Proposal> {
        let found = Knob::ALL.iter().find_map(|knob| limits::relaxed(&self.asked, *knob, 0.0, &self.length));
        found.map_or_else(Vec::new, |(_, asked)| {
            // Only what an analysis tests is given up: the file still asks for what it asked.
            let proposals = self.written(&asked, self.wanted.min(2));
            proposals.into_iter().map(|p| Proposal { settings: write::room(self.asked.room_m), ..p }).collect()
        })
    }
}
