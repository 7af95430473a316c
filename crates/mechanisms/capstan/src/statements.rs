//! What a report says in words: status, model, limits, sources, warnings.

use forcewright_base::units::{format_number, format_si};
use forcewright_elements::grooves::{Groove, Pressure};
use forcewright_model::{Citation, Statement, Status, StatusKind, Warning};

use crate::analysis::{Behaviour, Measured};
use crate::design::{Design, Source};
use crate::losses::unknown;

/// A groove that gives more friction than this is worth a word.
const HIGH_FACTOR: f64 = 1.4;

fn statement(title: &str, text: impl Into<String>) -> Statement {
    Statement { title: title.to_owned(), text: text.into() }
}

/// How the analysis ended.
pub(crate) fn status(design: &Design, behaviour: &Behaviour) -> Status {
    let torque = |nm: f64| format_si(nm, &design.units.torque, 4);
    let complete = |message: String| Status { kind: StatusKind::Complete, message, advice: None };
    match (&behaviour.required, &design.requirements) {
        (Some(Ok(loaded)), _) => {
            complete(format!("computed from rest to {}, and the loop between that torque both ways", torque(loaded.torque_nm)))
        }
        (Some(Err(error)), Some(requirements)) => {
            let most = behaviour.stations.last().map_or(0.0, |s| s.torque_nm);
            Status {
                kind: StatusKind::NoEquilibriumBeyond,
                message: format!("computed up to {}; {} is not held: {error}", torque(most), torque(requirements.torque_nm)),
                advice: Some(
                    "raise `preload`, `extra_turns` or `friction`, or fasten the cables with `input_hold = \"fastened\"`".to_owned(),
                ),
            }
        }
        _ => {
            let most = behaviour.stations.last().map_or(0.0, |s| s.torque_nm);
            complete(format!("computed from rest to {}; no torque is required", torque(most)))
        }
    }
}

/// Which equations were solved and how.
pub(crate) fn model(design: &Design) -> Vec<Statement> {
    let built = &design.built;
    let statics = match design.source {
        Source::Corrected => {
            "Coulomb friction on both drums, dT/dθ = ±μT where the cable slips; both sides of each cable share one displacement, and all cables the same turn. Loops remember where the torque turned back. All in the middle of the travel."
        }
        Source::Paper => {
            "As Longval & Gosselin have it: both sides change their tension by half of the force, which is not compatible. Their tangent stiffness is also taken for the secant."
        }
    };
    let factor = format_number(built.groove_factor, 4);
    let seat = match &built.seat.groove {
        Groove::Flat => "a smooth drum".to_owned(),
        Groove::Round { pressure: Pressure::Uniform, .. } => "a round seat under uniform pressure".to_owned(),
        Groove::Round { pressure: Pressure::Cosine, .. } => "a round seat worn evenly (cosine pressure)".to_owned(),
        Groove::Round { .. } => "a round seat under the pressure given".to_owned(),
        Groove::Vee { .. } => "two flanks".to_owned(),
        Groove::Undercut { .. } => "an undercut seat".to_owned(),
    };
    vec![
        statement("Statics", statics),
        statement("Grooves", format!("Friction on the drums is {factor} times the plain one: {seat}, μ′/μ = ∫p dφ/∫p cos φ dφ.")),
        statement(
            "Geometry",
            "One helix on the input, several on the output with the same angle: spans stay in line while the drums turn. Radii are to the middle of the cable. The return span lands n + 1 + (1 + R) inv γ/π pitches from the outgoing groove.",
        ),
        statement(
            "Losses",
            "Bearings take μ_b F D/2 under the load of the cables; bending takes a part of the tension at each drum. Both with the tensions of the drive at rest.",
        ),
    ]
}

/// What is not modelled.
pub(crate) fn limits(design: &Design) -> Vec<Statement> {
    let mut all = vec![
        statement(
            "Cable",
            "Linear elastic, without weight and without bending stiffness: its stiffness is that after bedding in. One coefficient of friction for sticking and slipping; no creep but what `preload_loss` says.",
        ),
        statement("Preload", "The same along the whole cable at rest: friction left from assembly is not modelled."),
        statement("Rigid parts", "Drums, shafts and bearings do not give way."),
        statement(
            "Life",
            "Broken wires and wear are not predicted: the ratio of diameters and the bending stress of the wires say what to expect.",
        ),
    ];
    let unknown = unknown(&design.built);
    if !unknown.is_empty() {
        all.push(statement("Backdriving", format!("Not assessed, as these are not known: {}.", unknown.join(", "))));
    }
    all
}

/// Works that were used.
pub(crate) fn sources(design: &Design) -> Vec<Citation> {
    let mut all = vec![Citation {
        key: "longval-gosselin",
        text: "J. M. Longval, C. Gosselin, grooved multi-helix high-stiffness capstan drive",
        used_for: "slip angles, elongations, stiffness, effective friction in grooves",
    }];
    if design.built.cables.iter().any(|c| c.wire_m.is_some() && c.breaking_n.is_some()) {
        all.push(Citation {
            key: "sava-pulleys",
            text: "Carl Stahl Sava, technical information on pulleys",
            used_for: "strength of a bent cable",
        });
    }
    let mut keys: Vec<&'static str> = Vec::new();
    for key in design.built.cables.iter().flat_map(|c| c.sources.iter().copied()) {
        if !keys.contains(&key) {
            keys.push(key);
        }
    }
    all.extend(keys.into_iter().map(|key| Citation { key, text: "see REFERENCES.bib", used_for: "data of the cable" }));
    all
}

/// Things to know about a result.
pub(crate) fn warnings(design: &Design, behaviour: &Behaviour, measured: &Measured) -> Vec<Warning> {
    let mut all = Vec::new();
    let built = &design.built;
    if built.groove_factor > HIGH_FACTOR {
        all.push(Warning {
            code: "W0701",
            message: format!(
                "the groove gives {} times the plain friction; makers' seats of 120 to 150° give 1.17 to 1.36 once they are worn in",
                format_number(built.groove_factor, 4)
            ),
        });
    }
    for (reaches, place, feels) in
        [(behaviour.reaches_end(), "a termination", "anchor"), (behaviour.reaches_pin(), "the pin on the input drum", "pin")]
    {
        if reaches {
            all.push(Warning {
                code: "W0702",
                message: format!("slip reaches {place}: there the drive is stiffer than on a longer wrap, and the {feels} feels the load"),
            });
        }
    }
    let unknown = unknown(built);
    if !unknown.is_empty() {
        all.push(Warning {
            code: "W0703",
            message: format!("backdriving and efficiency are not assessed: not known are {}", unknown.join(", ")),
        });
    }
    if let Some(mismatch) = measured.get("alignment_mismatch").filter(|m| *m > 0.25) {
        all.push(Warning {
            code: "W0704",
            message: format!(
                "the return span lands {} pitches from its groove: see the figure of the alignment for distances and phases that fit",
                format_number(mismatch, 3)
            ),
        });
    }
    let nearest = (built.ratio() - f64::from(built.starts)).abs();
    if nearest > 0.5 {
        all.push(Warning {
            code: "W0705",
            message: format!(
                "{} helices on an output of ratio {}: their spacing differs much from the pitch on the input",
                built.starts,
                format_number(built.ratio(), 4)
            ),
        });
    }
    let loose = measured.get("slack_tension").is_some_and(|n| n <= 0.0);
    if loose {
        let torque = behaviour.at_torque().map_or_else(String::new, |l| format_si(l.torque_nm, &design.units.torque, 4));
        all.push(Warning { code: "W0706", message: format!("under {torque} the slack side of a cable is loose") });
    }
    all
}
