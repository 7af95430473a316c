//! What a report says in words: status, model, limits, sources, warnings.

use forcewright_base::units::{format_number, format_si};
use forcewright_model::{Citation, Statement, Status, StatusKind, Warning};

use crate::analysis::Behaviour;
use crate::closing::{Ending, target_n};
use crate::design::{Design, Source};
use crate::statics::{State, Statics, clutch};

fn statement(title: &str, text: impl Into<String>) -> Statement {
    Statement { title: title.to_owned(), text: text.into() }
}

/// How the analysis ended.
pub(crate) fn status(design: &Design, behaviour: &Behaviour) -> Status {
    let torque = |nm: f64| format_si(nm, &design.units.torque, 4);
    let message = match &design.requirements {
        Some(required) => {
            let (state, output_nm) = behaviour.statics.output(required.input_nm);
            format!("with {} at the input: {}, {} at the output", torque(required.input_nm), state.word(), torque(output_nm))
        }
        None => "computed; no torque is required".to_owned(),
    };
    Status { kind: StatusKind::Complete, message, advice: None }
}

/// Which equations were solved and how.
pub(crate) fn model(design: &Design) -> Vec<Statement> {
    let clutch = match design.source {
        Source::Corrected => {
            "Opening moments EI δ/(r (r + δ)); the hub slips at M_A (1 − exp(−2π (N_A − 0.2) μ)); the bore holds τ_t + (τ_b − τ_t) exp(2π N_B μ), as only what exceeds τ_t presses on it. Confirmed by a curved beam in frictional contact."
        }
        Source::Paper => {
            "As Butin et al. have it: moments EI δ/r², slip on the hub without the factor of finite turns, and a bore that the whole of τ_b presses on. Designs that this calls sound may slip before they shift."
        }
    };
    let mut all = vec![
        statement("Clutch", clutch),
        statement(
            "Gears",
            "Involutes of the rack with profile shift. In mode I all turns as one; in mode II the ring stands, and τ_out = τ_in/R − τ_b. The torque on the spring is τ_in (1 − R)/R in both.",
        ),
        statement(
            "Losses",
            "Slip on the hub in mode II; besides it what `[losses]` gives, at the output, or the friction between flanks. Nothing else is lost.",
        ),
    ];
    if design.motor.is_some() && design.hand.is_some() {
        all.push(statement(
            "Closing",
            "Sun and carrier turn by the motor (R, K, its friction and inertia, the limit of its current) and by the finger (inertia, glove, object); between them the coil winds as a spring, sticks and slips on the hub, and drags, grips and lets go in the bore with the friction that its pressure allows. Changes are located, not smoothed. Inductance, the ring's mass and damping in the coil are left out.",
        ));
    }
    all
}

/// What is not modelled.
pub(crate) fn limits(design: &Design) -> Vec<Statement> {
    let mut all = vec![
        statement(
            "Coaxial",
            "Hub, spring and bore are coaxial: an eccentric spring touches the bore early on one side, which a bench sees as a torque that varies once per turn.",
        ),
        statement(
            "Friction",
            "Coulomb friction with one coefficient on each surface, the same for sticking and slipping; stick–slip of the hub is not computed.",
        ),
        statement(
            "Statics",
            "Torques are those of slow motion; what the closing of a hand adds is simulated where motor and hand are given.",
        ),
    ];
    if design.built.gears.friction.is_none() && design.built.losses[1].proportional.is_none() {
        all.push(statement(
            "Efficiency",
            "Neither friction of the flanks nor measured losses are given: efficiencies are those of ideal gears.",
        ));
    }
    all
}

/// Works that were used.
pub(crate) fn sources(design: &Design) -> Vec<Citation> {
    let mut all = vec![Citation {
        key: "butin2023",
        text: "C. Butin, D. Chablat, Y. Aoustin, D. Gouaillier, J. Mechanisms Robotics 15(1), 2023",
        used_for: "architecture, both modes, clutch",
    }];
    if design.bench.is_some() {
        let text = "E. C. Fieller, J. Royal Statistical Society B 16(2), 1954";
        all.push(Citation { key: "fieller1954", text, used_for: "intervals of the bench" });
    }
    let keys = design.wire.sources.iter().chain(design.gear_material.iter().flat_map(|g| &g.sources));
    let mut seen: Vec<&'static str> = Vec::new();
    for key in keys {
        if !seen.contains(key) {
            seen.push(key);
            all.push(Citation { key, text: "see REFERENCES.bib", used_for: "data of the material" });
        }
    }
    all
}

/// Things to know about a result.
pub(crate) fn warnings(design: &Design, behaviour: &Behaviour) -> Vec<Warning> {
    let mut all = Vec::new();
    let Some(required) = &design.requirements else { return closing(design, behaviour) };
    let torque = |nm: f64| format_si(nm, &design.units.torque, 4);
    // The paper's model and the corrected one do not agree on what happens.
    if design.source == Source::Paper
        && let Ok(spring) = clutch(&design.built, Source::Corrected)
        && let Ok(corrected) = Statics::new(&design.built, &spring, design.built.friction, behaviour.train.mesh_loss())
    {
        let (state, output_nm) = corrected.output(required.input_nm);
        if state != State::ModeII {
            all.push(Warning {
                code: "W0801",
                message: format!("the corrected model does not confirm it: {}, {} at the output", state.word(), torque(output_nm)),
            });
        }
    }
    let [low, high] = behaviour.slippery.each_ref().map(|s| s.output(required.input_nm).0);
    if low != high {
        all.push(Warning {
            code: "W0802",
            message: format!(
                "what happens depends on the friction: at {} {}, at {} {}",
                format_number(design.frictions()[0][0], 3),
                low.word(),
                format_number(design.frictions()[1][0], 3),
                high.word()
            ),
        });
    }
    all.extend(closing(design, behaviour));
    if !design.friction_scatters() {
        let message = "friction is given without a range; nobody knows it that well: write `\"0.12 ± 0.03\"`".to_owned();
        all.push(Warning { code: "W0803", message });
    }
    all
}

/// What the closing of the hand shows.
fn closing(design: &Design, behaviour: &Behaviour) -> Vec<Warning> {
    let mut all = Vec::new();
    let Some(grasp) = &behaviour.grasp else { return all };
    let force = |n: f64| format_si(n, &design.units.force, 4);
    let seconds = |s: f64| format_number(s, 3);
    match (grasp.touch_s, grasp.shift_s) {
        (Some(touch_s), Some(shift_s)) if shift_s < touch_s => all.push(Warning {
            code: "W0811",
            message: format!(
                "it shifts after {} s and touches the object after {} s: the rest of the way is slow",
                seconds(shift_s),
                seconds(touch_s)
            ),
        }),
        (None, _) => all.push(Warning { code: "W0812", message: "the hand does not reach the object".to_owned() }),
        _ => {}
    }
    if grasp.ending == Ending::Unfinished {
        let end_s = grasp.last().map_or(0.0, |l| l.time_s);
        all.push(Warning {
            code: "W0813",
            message: format!("the closing was given up after {} s: its metrics are missing", seconds(end_s)),
        });
    }
    let wanted_n = target_n(design);
    if let Some(force_n) = grasp.force_n().filter(|_| wanted_n.is_finite() && grasp.ending != Ending::Reached) {
        let verb = if grasp.ending == Ending::Slips { "slips" } else { "stalls" };
        all.push(Warning { code: "W0814", message: format!("the hand {verb} at {}; wanted are {}", force(force_n), force(wanted_n)) });
    }
    all
}
