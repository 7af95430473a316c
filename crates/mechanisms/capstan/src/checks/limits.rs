//! CAPS004 and CAPS015 to CAPS018: limits on metrics, with what moves each of them and, where it can be told, the number that just meets it.

use forcewright_base::roots::root;
use forcewright_base::units::{Dimension, Unit, format_number, format_si};
use forcewright_contract::judge::Comparison;
use forcewright_model::{Check, Sense};

use super::Context;
use crate::design::{Built, Requirements};
use crate::losses::{Losses, shaft_load_n, unknown};
use crate::metrics::METRICS;
use crate::statics::Statics;

/// Least part to which a preload or a friction is lowered in search of a limit.
const LEAST_PART: f64 = 1e-3;

/// The code of a limit on a metric, and its title: what the trade has a name for has its own.
fn code_of(name: &'static str) -> (&'static str, &'static str) {
    match name {
        "shaft_load" => ("CAPS015", "Load of the shafts"),
        "torsional_frequency" | "torsional_frequency_free" => ("CAPS016", "Resonance"),
        "reflected_inertia_output" => ("CAPS017", "Reflected inertia"),
        "backdrive_torque_output" | "efficiency_backward" => ("CAPS018", "Backdriving"),
        _ => ("CAPS004", name),
    }
}

/// What moves a metric.
fn moved_by(name: &str) -> &'static str {
    match name {
        "stiffness_tangent_output" | "stiffness_secant_output" | "wind_up_output" => {
            "preload, friction in the grooves, shorter spans, a stiffer cable, more cables and a larger output drum move it"
        }
        "stiffness_tangent_input" | "stiffness_secant_input" => {
            "preload, friction in the grooves, shorter spans, a stiffer cable, more cables and a larger input drum move it"
        }
        "stiffness_initial_output" | "stiffness_initial_input" => {
            "length of the spans (centre distance), stiffness and number of the cables and the radius of the drum move it; preload and friction do not"
        }
        "lost_motion_output" | "loss_per_cycle" => "it falls as preload, friction and stiffness of the cables rise",
        "gross_slip_torque_output" => "it is in proportion to the preload; `extra_turns` and friction raise it too",
        "taut_tension" => "preload, a larger output drum and more cables move it",
        "slack_tension" | "preload_left" => "preload, its losses (`preload_loss`) and the change of temperature move it",
        "slip_angle_taut" | "slip_angle_slack" => "it falls as preload and friction rise",
        "slip_used" => "it falls as preload, friction and `extra_turns` rise",
        "efficiency_forward" | "torque_input" => {
            "friction and bores of the bearings, bending loss of the cables, drags and preload move it"
        }
        "ratio" => "the diameters of the drums make it",
        "friction_effective" => "`design.friction` and the section of the grooves make it",
        "free_span" => "centre distance and diameters make it: √(d² − (r₁ ± r₂)²)",
        "input_wrap" => "`extra_turns` make it, 360 deg each",
        "output_wrap_min" => "`output_anchor_wrap` is it",
        "helix_angle" => "pitch over the circumference of the input drum makes it",
        "alignment_mismatch" | "fleet_angle" => "centre distance, `groove_phase` and the ratio of the diameters move it; see CAPS009",
        "occupancy_clearance" | "rope_clearance" => "pitch, `lines` of the cables, turns and travel move it; see CAPS010",
        "input_drum_length" | "output_drum_length" => {
            "pitch, `extra_turns`, travel, number of cables, `output_anchor_wrap` and `parts.margin` move it"
        }
        "output_drum_diameter" => "`output_diameter` and the diameter of the cable make it",
        "length_over_drums" => "centre distance, both diameters and that of the cable make it",
        "cable_length" | "preload_travel" => {
            "diameters, turns, travel and `parts.anchor_length` move it; the travel of the tensioner also preload over stiffness"
        }
        "bending_ratio" | "wire_bending_stress" => "larger drums, a thinner cable or one of finer wires move it",
        "cable_safety_factor" => "a thicker cable, more cables, larger drums and less preload move it; see CAPS005",
        _ => "change the design, or the limit",
    }
}

impl Context<'_> {
    /// CAPS004, CAPS015 to CAPS018: limits on metrics.
    pub(super) fn limits(&self, requirements: &Requirements) -> Vec<Check> {
        let mut all = Vec::new();
        for limit in &requirements.limits {
            let Some(info) = METRICS.get(limit.metric) else { continue };
            for (bound, sense, suffix) in [(limit.min, Sense::AtLeast, "at least"), (limit.max, Sense::AtMost, "at most")] {
                let Some(bound) = bound else { continue };
                let (code, title) = code_of(info.name);
                let base = self.base(code, info.name, &format!("{title} ({suffix})"), info.name);
                let missed = base.value.is_some_and(|value| if sense == Sense::AtLeast { value < bound } else { value > bound });
                let fix = if missed { self.mended(info.name, sense, bound) } else { String::new() };
                let missing = self.missing_metric(info.name);
                all.push(Comparison { limit: Some(bound), sense, missing, fix, ..base }.judge());
            }
        }
        all
    }

    /// What a metric that has no value needs.
    pub(super) fn missing_metric(&self, name: &str) -> String {
        let built = &self.design.built;
        match name {
            "backdrive_torque_output" | "efficiency_forward" | "efficiency_backward" | "torque_input" => {
                let unknown = unknown(built);
                if unknown.is_empty() { self.missing() } else { format!("not known: {}", unknown.join(", ")) }
            }
            "torsional_frequency" if built.inertia_kg_m2[1].is_none() => "not known: inertia.output".to_owned(),
            "torsional_frequency_free" | "reflected_inertia_output" if built.inertia_kg_m2.contains(&None) => {
                let names = ["inertia.input", "inertia.output"].into_iter().zip(built.inertia_kg_m2);
                let unknown: Vec<&str> = names.filter(|(_, known)| known.is_none()).map(|(name, _)| name).collect();
                format!("not known: {}", unknown.join(", "))
            }
            "wire_bending_stress" => "give `wire_diameter` and `wire_modulus` of the cables".to_owned(),
            "cable_safety_factor" if built.cables.iter().any(|c| c.breaking_n.is_none()) => {
                "give `breaking_force` of the cables".to_owned()
            }
            "gross_slip_torque_output" => "fastened cables do not slip as a whole".to_owned(),
            _ => self.missing(),
        }
    }

    /// What would keep a limit that is missed.
    fn mended(&self, name: &'static str, sense: Sense, bound: f64) -> String {
        let upper = sense == Sense::AtMost;
        match name {
            "shaft_load" if upper => self.lighter(bound),
            "torsional_frequency" | "torsional_frequency_free" if !upper => self.faster(name, bound),
            "reflected_inertia_output" if upper => self.nimbler(bound),
            "backdrive_torque_output" if upper => self.looser(bound),
            "shaft_load" => "preload, torque over the radius of the output drum and the angle of the spans make it".to_owned(),
            "torsional_frequency" | "torsional_frequency_free" => "stiffness over inertia makes it".to_owned(),
            "reflected_inertia_output" => "the inertias and the square of the ratio make it".to_owned(),
            "backdrive_torque_output" | "efficiency_backward" => {
                "friction and bores of the bearings, bending loss of the cables, drags and preload move it".to_owned()
            }
            other => moved_by(other).to_owned(),
        }
    }

    /// The statics with something of the drive changed, in the middle of the travel.
    fn changed(&self, change: impl FnOnce(&mut Built)) -> Option<(Built, Statics)> {
        let mut built = self.design.built.clone();
        change(&mut built);
        let statics = Statics::new(&built, &built.place(&self.behaviour.geometry, built.middle_rad()), self.design.source).ok()?;
        Some((built, statics))
    }

    /// The part of the preloads, below 1, with which a value that grows with them is a bound.
    fn part_of_preload(&self, bound: f64, value: impl Fn(&Built, &Statics) -> Option<f64>) -> Option<f64> {
        let of = |part: f64| {
            let (built, statics) = self.changed(|built| built.cables.iter_mut().for_each(|c| c.preload_n *= part))?;
            value(&built, &statics)
        };
        // With less than what is held there is no value, and the limit is not met.
        root(|part| of(part).map_or(-bound, |x| x - bound), LEAST_PART, 1.0, 1e-7).ok().filter(|part| of(*part * (1.0 - 1e-5)).is_some())
    }

    /// A shaft that carries less.
    fn lighter(&self, bound: f64) -> String {
        let torque_nm = self.behaviour.at_torque().map(|l| l.torque_nm);
        let span = self.behaviour.span();
        let load = |built: &Built, statics: &Statics| {
            let at_rest: Vec<[f64; 2]> = built.cables.iter().map(|c| [c.preload_left_n(built); 2]).collect();
            let loaded = torque_nm.map(|t| statics.under(t)).transpose().ok()?;
            Some(shaft_load_n(&at_rest, span).max(loaded.map_or(0.0, |l| shaft_load_n(&l.tensions_n, span))))
        };
        match self.part_of_preload(bound, load) {
            Some(part) => format!(
                "a preload {} times as high gives it, if the torque is still held at the ends of the travel; a larger output drum carries the torque with less force",
                format_number(0.9995 * part, 4)
            ),
            None => {
                "less preload alone does not give it, as the torque must be held: a larger output drum, or more turns with less preload"
                    .to_owned()
            }
        }
    }

    /// A higher resonance.
    fn faster(&self, name: &str, bound: f64) -> String {
        let found = self.measured.get(name).unwrap_or(bound);
        let factor = (bound / found) * (bound / found);
        let [input, output] = self.design.built.inertia_kg_m2;
        let reduced = match (name, input, output) {
            ("torsional_frequency", _, Some(output)) => {
                format!(", or an inertia of the output of at most {}", inertia(output / factor / 1.0005))
            }
            _ => ", or inertias smaller in that ratio".to_owned(),
        };
        format!(
            "it grows as the root of the stiffness over the inertia: {} times the stiffness (see CAPS002){reduced}",
            format_number(1.0005 * factor, 4)
        )
    }

    /// Less inertia at the output.
    fn nimbler(&self, bound: f64) -> String {
        let [Some(input), Some(output)] = self.design.built.inertia_kg_m2 else { return moved_by("").to_owned() };
        let ratio = self.design.built.ratio();
        if output >= bound {
            return format!("the output alone has {}: make that lighter", inertia(output));
        }
        format!(
            "the input counts with the square of the ratio, {}: an inertia of the input of at most {}, or a ratio of at most {} (a larger input drum)",
            format_number(ratio * ratio, 4),
            inertia(0.9995 * (bound - output) / (ratio * ratio)),
            format_number(0.9995 * ((bound - output) / input).sqrt(), 4)
        )
    }

    /// Less torque to turn it from the output.
    fn looser(&self, bound: f64) -> String {
        let value = |built: &Built, statics: &Statics| Losses::of(built, &self.behaviour.geometry, statics)?.backdrive_nm().ok();
        let built = &self.design.built;
        let with = |part: f64| {
            let (built, statics) = self.changed(|built| built.bearings.friction = built.bearings.friction.map(|mu| part * mu))?;
            value(&built, &statics)
        };
        let bearings = root(|part| with(part).unwrap_or(f64::NAN) - bound, 0.0, 1.0, 1e-7).ok().zip(built.bearings.friction);
        let bearings = bearings.filter(|(part, _)| *part > 0.0).map_or_else(
            || "friction of the bearings alone is not enough: bending of the cables and drags take more".to_owned(),
            |(part, mu)| format!("bearings with a friction of at most {} give it", format_number(0.9995 * part * mu, 4)),
        );
        let preload = self.part_of_preload(bound, value).map_or_else(String::new, |part| {
            format!("; a preload {} times as high does too, if the torque is still held", format_number(0.9995 * part, 4))
        });
        format!("{bearings}{preload}; smaller bores, a cable that bends more easily and smaller drags help")
    }
}

fn inertia(kg_m2: f64) -> String {
    let unit = Unit::parse("kg*m^2").unwrap_or_else(|_| Unit::si(Dimension::Inertia));
    format_si(kg_m2, &unit, 4)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// No metric has the advice of those that nobody thought of.
    #[test]
    fn every_metric_says_what_moves_it() {
        for info in METRICS {
            assert!(code_of(info.name).0 != "CAPS004" || moved_by(info.name) != moved_by(""), "{}", info.name);
        }
    }
}
