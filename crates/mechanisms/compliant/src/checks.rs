//! Requirements against what was found.

mod endurance;

use forcewright_base::units::{Dimension, Unit, format_number, format_si};
use forcewright_beam::Theory;
use forcewright_contract::judge::Comparison;
use forcewright_model::{Check, CheckState, Sense};

use crate::analysis::{Behaviour, Measured, display_unit};
use crate::design::{Design, Requirements, StressLimit};
use crate::loads::Control;
use crate::metrics::METRICS;
use crate::pads;
use crate::scenario;

/// Every requirement of the project, in the order of the language.
pub(crate) fn checks(design: &Design, behaviour: &Behaviour, measured: &Measured) -> Vec<Check> {
    let Some(requirements) = &design.requirements else { return Vec::new() };
    let mut all = Vec::new();
    let context = Context { design, behaviour, measured, requirements };
    all.extend(context.force());
    all.extend(context.travel());
    all.extend(context.stress());
    all.extend(context.stress_moved());
    all.extend(context.stiffness());
    all.extend(context.envelope());
    all.extend(context.layers());
    all.extend(context.fatigue());
    all.extend(context.hold());
    all.extend(context.limits());
    // Pads that nobody has drawn are worth a word only where they are in the way.
    all.extend(pads::check(design, behaviour, design.making.is_drawn()).filter(|c| c.required || c.state == CheckState::Missed));
    all
}

struct Context<'a> {
    design: &'a Design,
    behaviour: &'a Behaviour,
    measured: &'a Measured,
    requirements: &'a Requirements,
}

/// The metric that is known although its value may not be finite.
const LATERAL: &str = "lateral_stiffness_min";

/// Thinner than this part of itself, a beam is another design: such advice helps nobody.
const PLAUSIBLE: f64 = 0.4;

fn percent() -> Unit {
    Unit::parse("%").unwrap_or_else(|_| Unit::si(Dimension::Ratio))
}

/// A positive value cut to so many digits: advice that is followed to the letter must not overshoot.
pub(crate) fn rounded_down(value: f64, digits: i32) -> f64 {
    let place = forcewright_base::maths::log10(value).floor();
    if !place.is_finite() {
        return value;
    }
    #[allow(clippy::cast_possible_truncation, reason = "the decimal exponent of a double")]
    let shift = digits - 1 - place as i32;
    let ten = |n: i32| forcewright_base::maths::powi(10.0, n);
    // Multiplying by a power of ten and dividing by it again gives the decimal; by its inverse it may not.
    if shift >= 0 { (value * ten(shift)).floor() / ten(shift) } else { (value / ten(-shift)).floor() * ten(-shift) }
}

/// A displacement for people, cut to four digits.
fn shown_below(x_m: f64, unit: &Unit) -> String {
    format!("{} {}", format_number(rounded_down(unit.from_si(x_m), 4), 4), unit.pretty())
}

impl Context<'_> {
    /// Why a check over the whole travel has no value, or no final one.
    fn unreached(&self) -> String {
        if self.behaviour.branching_load.is_some() {
            return "a real part leaves the computed shape before the last load begins; see the status".to_owned();
        }
        if let Some(from) = self.behaviour.unstable_from_m {
            let from = format_si(from, &self.design.units.displacement, 4);
            return format!("the path branches at Δ = {from}: beyond, a real part leaves the computed shape; see the status");
        }
        let reach = self.behaviour.path.points.last().map_or(0.0, |p| self.behaviour.delta_m(p));
        format!("the path ends at Δ = {}, before the full travel; see the status", format_si(reach, &self.design.units.displacement, 4))
    }

    /// Said behind a value of a path that ends early, or is followed only up to where it branches.
    fn so_far(&self) -> &'static str {
        match (self.behaviour.whole, self.behaviour.unstable_from_m) {
            (true, _) => "",
            (false, Some(_)) => ", before the path branches",
            (false, None) => ", on the computed part",
        }
    }

    /// COMP001: the band needed over the best window of the required stroke.
    fn force(&self) -> Option<Check> {
        let (band, nominal) = self.requirements.force?;
        let curve = self.behaviour.curve.as_ref().filter(|_| self.behaviour.whole);
        // A band without a stroke is refused when the file is read.
        let window_m = self.requirements.travel_m?;
        let best = curve.and_then(|c| c.best_window(window_m, nominal)).filter(|(_, d)| d.is_finite());
        let units = &self.design.units;
        let stroke = format_si(window_m, &units.displacement, 4);
        let around = nominal.map_or_else(|| "around a free level".to_owned(), |f| format!("around {}", format_si(f, &units.force, 4)));
        let fix = best
            .zip(nominal)
            .and_then(|((_, deviation), level)| self.depth_advice(level, band, deviation))
            .unwrap_or_else(|| "ask for a shorter `travel` or a wider `band`, or change the shape".to_owned());
        let missing =
            if self.behaviour.whole { format!("the force is not positive over any stroke of {stroke}") } else { self.unreached() };
        let comparison = Comparison {
            code: "COMP001",
            name: "force".to_owned(),
            title: format!("Force deviation {around} over the best {stroke}"),
            required: true,
            value: best.map(|(_, deviation)| deviation),
            limit: Some(band),
            sense: Sense::AtMost,
            dimension: Dimension::Ratio,
            display: percent(),
            scale: None,
            basis: "largest |F/level − 1| over the stroke, at the place of the travel where it is smallest".to_owned(),
            fix,
            missing,
            partial: false,
            broken: false,
        };
        Some(comparison.judge())
    }

    /// What `design.depth` can do for a missed band around a nominal level: move the flattest stroke to that level.
    fn depth_advice(&self, level: f64, band: f64, deviation: f64) -> Option<String> {
        let curve = self.behaviour.curve.as_ref()?;
        let flattest = curve.best_window(self.requirements.travel_m?, None).filter(|(_, d)| d.is_finite())?.0;
        let (hi, lo) = curve.extent(flattest);
        let (middle, free) = (f64::midpoint(hi, lo), (hi - lo) / (hi + lo));
        let rest =
            if free > band { "; that alone is not enough: a wider `band`, a shorter `travel` or another shape is needed too" } else { "" };
        let factor = level / middle;
        if !(0.2..=5.0).contains(&factor) {
            return None;
        }
        Some(format!(
            "the best stroke needs ±{} %; the flattest one has its own level of {} with ±{} %. Force is proportional to `design.depth`: multiply it by {}{rest}",
            format_number(100.0 * deviation, 3),
            format_si(middle, &self.design.units.force, 4),
            format_number(100.0 * free, 3),
            format_number(factor, 5),
        ))
    }

    /// COMP003: the longest stroke within the band.
    fn travel(&self) -> Option<Check> {
        let wanted = self.requirements.travel_m?;
        let usable = self.measured.usable.map(|i| i.length());
        // No interval at all is a stroke of zero, if the path was computed.
        let value = self.behaviour.whole.then_some(usable.unwrap_or(0.0));
        let show = |x: f64| format_si(x, &self.design.units.displacement, 4);
        let comparison = Comparison {
            code: "COMP003",
            name: "travel".to_owned(),
            title: "Usable stroke inside the band".to_owned(),
            required: true,
            value,
            limit: Some(wanted),
            sense: Sense::AtLeast,
            dimension: Dimension::Length,
            display: self.design.units.displacement.clone(),
            scale: None,
            basis: "longest displacement interval on which the force stays inside the band".to_owned(),
            fix: format!(
                "the band holds over {} of {}; COMP001 says what would move the force into the band",
                show(usable.unwrap_or(0.0)),
                show(wanted)
            ),
            missing: self.unreached(),
            partial: false,
            broken: false,
        };
        Some(comparison.judge())
    }

    /// COMP002: the largest stress.
    fn stress(&self) -> Option<Check> {
        let wanted = self.requirements.stress?;
        // One stress for all beams, or the yield stress of each.
        let found = if matches!(wanted, StressLimit::Stress(_)) { self.measured.stress } else { self.measured.loaded };
        let allowable_pa = found.and_then(|s| self.design.allowable_pa(s.beam)).or(self.design.common_allowable_pa());
        let unknown = (0..self.design.network.beams.len()).find(|beam| self.design.allowable_pa(*beam).is_none());
        let show = |x: f64| format_si(x, &self.design.units.displacement, 4);
        let place = found.map_or_else(String::new, |s| {
            let beam = self.design.beam_names.get(s.beam).map_or("?", String::as_str);
            format!(" (beam {beam}, u = {}, Δ = {}{})", format_number(s.peak.u, 3), show(s.at_m), self.so_far())
        });
        // A travel below the stroke asked for is no way out.
        let useful = |x: &f64| self.requirements.travel_m.is_none_or(|t| *x >= t);
        let until = self.measured.get("travel_at_allowable_stress").filter(useful).map_or_else(String::new, |x| {
            let (key, units) = (&self.design.load_key, &self.design.units);
            match (self.design.control, &self.behaviour.curve) {
                (Control::Force, Some(curve)) => format!("keep `{key}` at or below {}, or ", shown_below(curve.force(x), &units.force)),
                _ => format!("keep `{key}` at or below {}, or ", shown_below(x, &units.displacement)),
            }
        });
        let ratio = found.zip(allowable_pa).map_or(1.0, |(s, allowed)| s.peak.stress_pa / allowed);
        // Stretching changes with the thickness at equal bending stiffness, and the shape with it: 2 % to spare.
        let spare = if self.design.theory == Theory::Reissner { 0.98 } else { 1.0 };
        let thinner = rounded_down(spare / ratio, 3);
        let of = match found.and_then(|s| self.design.material_of(s.beam)).map(|m| m.name.as_deref()) {
            Some(name) if self.design.materials.len() > 1 => {
                format!(
                    "yield stress of {}, the beam that is nearest to its own",
                    name.map_or("`material`".to_owned(), |n| format!("`material.{n}`"))
                )
            }
            _ => "yield stress".to_owned(),
        };
        let basis = match wanted {
            StressLimit::Yield => format!("{of}, since no `stress` requirement is given"),
            StressLimit::SafetyFactor(factor) => {
                format!("{of} over {}; Lan, Wang & Chen 2010, eq. (5) and constraint (iv)", format_number(factor, 4))
            }
            StressLimit::Stress(_) => "stress given in the requirements; Lan, Wang & Chen 2010, eq. (5)".to_owned(),
        };
        let comparison = Comparison {
            code: "COMP002",
            name: "stress".to_owned(),
            title: format!("Largest stress{place}"),
            required: true,
            value: found.map(|s| s.peak.stress_pa),
            limit: allowable_pa,
            sense: Sense::AtMost,
            dimension: Dimension::Stress,
            display: self.design.units.stress.clone(),
            scale: None,
            basis,
            fix: if thinner >= PLAUSIBLE {
                format!(
                    "{until}make all beams thinner: stress follows the thickness (× {}), and `design.depth` × {} keeps the force",
                    format_number(thinner, 3),
                    format_number(1.0 / (thinner * thinner * thinner), 4)
                )
            } else {
                format!(
                    "{until}change the shape, shorten the travel or choose another material: the stress is {} times what is allowed",
                    format_number(ratio, 3)
                )
            },
            missing: match unknown.map(|beam| self.design.material_of(beam).and_then(|m| m.name.as_ref())) {
                Some(None) => "the yield stress is not known; give `material.yield_stress`".to_owned(),
                Some(Some(name)) => format!("the yield stress of {name} is not known; give `material.{name}.yield_stress`"),
                None => self.unreached(),
            },
            partial: !self.behaviour.whole || unknown.is_some(),
            broken: false,
        };
        Some(comparison.judge())
    }

    /// COMP002 where the tip is also moved sideways.
    fn stress_moved(&self) -> Option<Check> {
        let (design, map) = (self.design, self.behaviour.lateral.as_ref()?);
        self.requirements.stress?;
        let worst = map.worst_stress(|beam| design.allowable_pa(beam));
        let unknown = (0..design.network.beams.len()).any(|beam| design.allowable_pa(beam).is_none());
        let show = |x: f64| format_si(x, &design.units.displacement, 4);
        let place = worst.map_or_else(String::new, |([axial_m, lateral_m], beam, ..)| {
            let beam = design.beam_names.get(beam).map_or("?", String::as_str);
            format!(" (beam {beam}, Δ = {}, δ = {})", show(axial_m), show(lateral_m))
        });
        let comparison = Comparison {
            code: "COMP002",
            name: "stress_lateral".to_owned(),
            title: format!("Largest stress with the tip moved sideways{place}"),
            required: true,
            value: worst.map(|(.., stress_pa, _)| stress_pa),
            limit: worst.and_then(|(_, beam, ..)| design.allowable_pa(beam)),
            sense: Sense::AtMost,
            dimension: Dimension::Stress,
            display: design.units.stress.clone(),
            scale: None,
            basis: "what is allowed along the load alone, over all places of the map".to_owned(),
            fix: "narrow `scenario.lateral`, or make the beams thinner that bend as the tip moves".to_owned(),
            missing: if worst.is_none() {
                "the yield stress is not known; give `material.yield_stress`"
            } else {
                "the map has gaps; see the status"
            }
            .to_owned(),
            partial: unknown || map.shortfall().is_some(),
            broken: false,
        };
        Some(comparison.judge())
    }

    /// COMP004 and COMP005: slopes of the force.
    fn stiffness(&self) -> Vec<Check> {
        let scale = self.measured.get("stiffness_initial").map_or(1.0, f64::abs);
        let slope = |code, name: &str, title: String, value, limit, sense, fix: String| {
            Comparison {
            code,
            name: name.to_owned(),
            title,
            required: true,
            value,
            limit: Some(limit),
            sense,
            dimension: Dimension::Stiffness,
            display: self.design.units.stiffness.clone(),
            scale: Some(scale),
            basis: "dF/dΔ from the tangent of the equilibrium equations; where the limit is zero, the margin is relative to the initial stiffness".to_owned(),
            fix,
            missing: self.unreached(),
            partial: !self.behaviour.whole,
            broken: false,
        }
        };
        let show = |x: f64| format_si(x, &self.design.units.displacement, 4);
        let at = self.measured.stiffness.map_or_else(String::new, |(_, x)| format!(" (Δ = {}{})", show(x), self.so_far()));
        let jump = match self.behaviour.jump() {
            Some((from, Some(to))) => format!("a force-driven device jumps from Δ = {} to {}; ", show(from), show(to)),
            Some((from, None)) => format!("a force-driven device jumps from Δ = {} to a place beyond the travel; ", show(from)),
            None => String::new(),
        };
        let least = self.measured.stiffness.map(|(k, _)| k);
        let mut all = vec![
            slope(
                "COMP004",
                "stiffness",
                format!("Least stiffness{at}"),
                least,
                self.requirements.stiffness_min,
                Sense::AtLeast,
                format!("{jump}where that is no harm, allow it by `stiffness = {{ min = … }}`; otherwise change the shape"),
            )
            .judge(),
        ];
        if let Some(limit) = self.requirements.stiffness_max {
            let largest = self.behaviour.largest_stiffness();
            all.push(
                slope(
                    "COMP005",
                    "stiffness_max",
                    format!("Largest stiffness{}", largest.map_or_else(String::new, |(_, x)| format!(" (Δ = {})", show(x)))),
                    largest.map(|(k, _)| k),
                    limit,
                    Sense::AtMost,
                    "change the shape, or allow it".to_owned(),
                )
                .judge(),
            );
        }
        all
    }

    /// COMP007: inside the envelope.
    fn envelope(&self) -> Option<Check> {
        let asked = self.requirements.asked_envelope?;
        let found = self.measured.margin;
        let units = &self.design.units;
        let place = found.map_or_else(String::new, |m| {
            let beam = self.design.beam_names.get(m.beam).map_or("?", String::as_str);
            let at = format_si(m.at_m, &units.displacement, 4);
            format!(" (beam {beam}, u = {}, Δ = {at}{})", format_number(m.u, 3), self.so_far())
        });
        let sides = (0..2).map(|k| asked.high_m[k] - asked.low_m[k]).filter(|s| s.is_finite());
        let comparison = Comparison {
            code: "COMP007",
            name: "envelope".to_owned(),
            title: format!("Distance to the envelope{place}"),
            required: true,
            value: found.map(|m| m.margin_m),
            limit: Some(0.0),
            sense: Sense::AtLeast,
            dimension: Dimension::Length,
            display: units.length.clone(),
            scale: sides.reduce(f64::min),
            basis: "surfaces of the beams and their copies in the plane, at rest and over the travel; the margin is relative to the smaller side of the envelope"
                .to_owned(),
            fix: if found.is_some_and(|m| m.u <= 0.0 || m.u >= 1.0) {
                "the end of a beam is round: it reaches half the thickness beyond its node; widen the envelope by that, or move the node"
            } else {
                "move or reshape that beam, shorten the travel, or widen the envelope there"
            }
            .to_owned(),
            missing: self.unreached(),
            partial: !self.behaviour.whole,
            broken: false,
        };
        Some(comparison.judge())
    }

    /// COMP008: layers in series move alike.
    fn layers(&self) -> Option<Check> {
        let stack = self.behaviour.stack.as_ref()?;
        let units = &self.design.units;
        let end_m = self.behaviour.curve.as_ref()?.end();
        let jumps = match stack.jumps {
            0 => "one layer runs ahead of the others".to_owned(),
            1 => "a layer jumps ahead of the others once".to_owned(),
            n => format!("layers jump ahead of the others, {n} times in all"),
        };
        let comparison = Comparison {
            code: "COMP008",
            name: "layers".to_owned(),
            title: format!("Layers move alike up to Δ{}", self.so_far()),
            required: true,
            value: Some(stack.apart_from_m.unwrap_or(end_m)),
            limit: Some(if self.behaviour.whole { end_m } else { self.design.layers() * self.design.load_end }),
            sense: Sense::AtLeast,
            dimension: Dimension::Length,
            display: units.displacement.clone(),
            scale: None,
            basis:
                "layers in series at equal force, followed from minimum to minimum of their energy; they part where the force of one falls"
                    .to_owned(),
            fix: format!(
                "where the force falls, {jumps}; change the shape so that it rises, shorten the travel, or let a linkage share it out"
            ),
            missing: self.unreached(),
            partial: !self.behaviour.whole,
            broken: false,
        };
        Some(comparison.judge())
    }

    /// What mends a broken limit on a metric.
    fn limit_fix(&self, name: &str, broken: bool) -> String {
        if let Some(fix) = scenario::fix(self.design, self.measured, name, broken) {
            return fix;
        }
        if let Some(fix) = scenario::lateral::fix(name) {
            return fix;
        }
        let sways = self.behaviour.sway.and_then(|s| s.from_m).filter(|_| name == LATERAL);
        let Some(from) = sways else { return "change the design, or relax the limit".to_owned() };
        let from = format_si(from, &self.design.units.displacement, 4);
        let how = if broken { "free to turn, the block is not held at all" } else { "the block sways" };
        format!("without a guide {how} from Δ = {from} on (W0510): guide it, shorten the travel, or change the shape")
    }

    /// Why a metric of a scenario has no value; `None` for other metrics.
    fn missing_of_scenarios(&self, name: &str) -> Option<String> {
        scenario::missing(self.design, self.measured, name).or_else(|| scenario::lateral::missing(self.design, self.behaviour, name))
    }

    /// COMP006: limits on metrics.
    fn limits(&self) -> Vec<Check> {
        let mut all = Vec::new();
        for asked in &self.requirements.limits {
            let info = &METRICS[asked.metric];
            for (limit, sense, suffix) in [(asked.min, Sense::AtLeast, "at least"), (asked.max, Sense::AtMost, "at most")] {
                let Some(limit) = limit else { continue };
                let (value, partial, broken) = match self.behaviour.sway {
                    // Known as far as the path goes, and below any limit where the block turns over.
                    Some(sway) if info.name == LATERAL => {
                        (sway.least_n_per_m, !self.behaviour.whole, sense == Sense::AtLeast && sway.least_n_per_m.is_none())
                    }
                    _ => {
                        let broken = sense == Sense::AtMost && scenario::never_ends(self.measured, info.name);
                        (self.measured.value(asked.metric), false, broken)
                    }
                };
                let comparison = Comparison {
                    code: "COMP006",
                    name: info.name.to_owned(),
                    title: format!("{} ({suffix})", info.name),
                    required: true,
                    value,
                    limit: Some(limit),
                    sense,
                    dimension: info.dimension,
                    display: display_unit(self.design, asked.metric),
                    scale: None,
                    basis: info.doc.to_owned(),
                    fix: self.limit_fix(info.name, broken),
                    missing: self.missing_of_scenarios(info.name).unwrap_or_else(|| match info.name {
                        "mass" => "the density of a material is not known; give `density` in its table".to_owned(),
                        _ if !self.behaviour.whole => self.unreached(),
                        LATERAL if value.is_none() && !broken && self.behaviour.sway.is_some() => {
                            "free to turn, the block is not held at all at some displacement; there is no largest value".to_owned()
                        }
                        "envelope_margin" => "there is no envelope; give `requirements.envelope`".to_owned(),
                        "clearance_min" => "no two surfaces of this design face each other; remove the limit".to_owned(),
                        _ => "the design has no such value; see the status and the meaning of the metric".to_owned(),
                    }),
                    partial,
                    broken,
                };
                all.push(comparison.judge());
            }
        }
        all
    }
}
