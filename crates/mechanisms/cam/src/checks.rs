//! Requirements and rules against what was found.

use std::fmt::Write as _;

use forcewright_base::units::{Dimension, Unit, format_number, format_si};
use forcewright_contract::judge::Comparison;
use forcewright_elements::hertz::first_yield_pressure_pa;
use forcewright_model::{Check, Sense};

use crate::analysis::{Behaviour, Measured, Station};
use crate::cut::Cut;
use crate::design::{Design, Requirements};
use crate::metrics::METRICS;
use crate::path::curvature_per_m;

/// Requirements in the order of the language, then the family's own rules.
pub(crate) fn checks(design: &Design, behaviour: &Behaviour, measured: &Measured) -> Vec<Check> {
    let context = Context { design, behaviour, measured };
    let mut all = Vec::new();
    if let Some(requirements) = &design.requirements {
        all.extend(context.force(requirements));
        all.extend(context.stroke(requirements));
        all.extend(context.hysteresis(requirements));
        all.extend(context.limits(requirements));
    }
    all.extend(context.undercut());
    all.extend(context.springs());
    all.extend(context.contact());
    all.extend(context.slack());
    all.extend(context.rolling());
    all.extend(context.pressure());
    all
}

struct Context<'a> {
    design: &'a Design,
    behaviour: &'a Behaviour,
    measured: &'a Measured,
}

/// The unit in which people are shown a metric.
pub(crate) fn display_unit(design: &Design, index: usize) -> Unit {
    use Dimension as D;
    let Some(info) = METRICS.get(index) else { return Unit::si(D::Ratio) };
    let limit = design.requirements.iter().flat_map(|r| &r.limits).find(|l| l.metric == index).map(|l| l.unit.clone());
    let named = |symbol: &str| Unit::parse(symbol).unwrap_or_else(|_| Unit::si(info.dimension));
    let units = &design.units;
    limit.unwrap_or_else(|| match info.dimension {
        D::Length if info.name == "undercut_travel" => units.travel.clone(),
        D::Length => units.length.clone(),
        D::Force => units.force.clone(),
        D::Stiffness => units.stiffness.clone(),
        D::Stress => named("MPa"),
        D::Angle => units.angle.clone(),
        D::Energy => named("J"),
        D::Mass => named("kg"),
        D::Ratio => named("%"),
        D::Time => units.time.clone(),
        other => Unit::si(other),
    })
}

fn percent() -> Unit {
    Unit::parse("%").unwrap_or_else(|_| Unit::si(Dimension::Ratio))
}

impl Context<'_> {
    fn unreached(&self) -> String {
        match self.behaviour.stopped {
            Some((s, _)) => format!("the mechanism cannot be assembled at a travel of {}; see the status", self.travel(s)),
            None => "the design has no such value; see the meaning of the metric".to_owned(),
        }
    }

    fn travel(&self, s_m: f64) -> String {
        format_si(s_m, &self.design.units.travel, 4)
    }

    fn force_of(&self, force_n: f64) -> String {
        format_si(force_n, &self.design.units.force, 4)
    }

    fn base(&self, code: &'static str, name: &str, title: &str, metric: &str) -> Comparison {
        let index = METRICS.iter().position(|m| m.name == metric).unwrap_or(0);
        Comparison {
            code,
            name: name.to_owned(),
            title: title.to_owned(),
            required: true,
            value: self.measured.value(index),
            limit: None,
            sense: Sense::AtMost,
            dimension: METRICS[index].dimension,
            display: display_unit(self.design, index),
            scale: None,
            basis: METRICS[index].doc.to_owned(),
            fix: String::new(),
            missing: self.unreached(),
            partial: false,
            broken: false,
        }
    }

    /// CAM001: the force within its band, both ways.
    fn force(&self, requirements: &Requirements) -> Option<Check> {
        let (law, band) = requirements.force.as_ref()?;
        let window = &self.behaviour.window;
        let ratio = |pick: fn(&Station) -> f64| Behaviour::extent(window, |s| pick(s) / law.force_n(s.travel_m)[0]);
        let fix = if window.is_empty() {
            String::new()
        } else {
            let ([_, high], [low, _]) = (ratio(|s| s.up.force_n.max(s.down.force_n)), ratio(|s| s.up.force_n.min(s.down.force_n)));
            let (middle, half) = (f64::midpoint(high, low), (high - low) / (high + low));
            if half <= *band && middle > 0.0 && self.design.built.gravity_m_per_s2 == 0.0 {
                format!("springs of {} % of their rate bring the force into the middle of its band", format_number(100.0 / middle, 4))
            } else {
                format!(
                    "even in the middle of its band the force differs by ±{} %: less rolling friction, a shorter window, or a cam cut for these springs",
                    format_number(100.0 * half, 3)
                )
            }
        };
        let basis = "largest |F/F_required − 1| over the window, slider moving up or down";
        let base = self.base("CAM001", "force", "Force inside its band, up and down", "force_deviation");
        Some(Comparison { limit: Some(*band), display: percent(), fix, basis: basis.to_owned(), ..base }.judge())
    }

    /// CAM002: the stroke that can be assembled, undercut or not.
    fn stroke(&self, requirements: &Requirements) -> Option<Check> {
        let wanted = requirements.stroke_m?;
        let start = self.behaviour.stations.first().map_or(0.0, |s| s.travel_m);
        let reached = self.behaviour.stopped.map_or(self.design.purpose.stroke_m, |(s, _)| s) - start;
        let base = self.base("CAM002", "stroke", "Stroke", "undercut_travel");
        let comparison = Comparison {
            value: Some(reached),
            limit: Some(wanted * (1.0 - 1e-12)),
            sense: Sense::AtLeast,
            display: self.design.units.travel.clone(),
            basis: "travel for which the cam is cut and the mechanism can be assembled".to_owned(),
            fix: "raise `design.stroke`; spring length, cam length and pressure angle grow with it".to_owned(),
            ..base
        };
        Some(comparison.judge())
    }

    /// CAM004: work lost between up and down.
    fn hysteresis(&self, requirements: &Requirements) -> Option<Check> {
        let limit = requirements.hysteresis?;
        let base = self.base("CAM004", "hysteresis", "Hysteresis", "hysteresis");
        let fix = match self.measured.get("hysteresis") {
            Some(value) if self.design.built.arm_m > 0.0 => {
                let arm = self.design.built.arm_m * limit / value;
                let unit = Unit::parse("mm").unwrap_or_else(|_| Unit::si(Dimension::Length));
                format!(
                    "hysteresis follows the rolling friction: an arm of {} keeps it, or rollers larger by {}",
                    format_si(arm, &unit, 3),
                    format_number(value / limit, 3)
                )
            }
            _ => "reduce the rolling friction, or use larger rollers".to_owned(),
        };
        Some(Comparison { limit: Some(limit), display: percent(), fix, ..base }.judge())
    }

    /// CAM012: limits on metrics.
    fn limits(&self, requirements: &Requirements) -> Vec<Check> {
        let mut all = Vec::new();
        for limit in &requirements.limits {
            let Some(info) = METRICS.get(limit.metric) else { continue };
            for (bound, sense, suffix) in [(limit.min, Sense::AtLeast, "at least"), (limit.max, Sense::AtMost, "at most")] {
                let Some(bound) = bound else { continue };
                let base = self.base("CAM012", info.name, &format!("{} ({suffix})", info.name), info.name);
                let missing = match info.name {
                    "contact_life" => "give `brinell` of both materials, steels of 100 to 400, and what the pressure needs".to_owned(),
                    "profile_error_rms" | "profile_error_max" => "the profile has no errors; give `errors.measured_profile`".to_owned(),
                    "hertz_pressure_max" => "give `material.cam`, `material.roller` and `design.cam_thickness`".to_owned(),
                    "force_deviation" => "no force is required; give `requirements.force`".to_owned(),
                    "time_to_end" | "speed_end" => "the slider is not let go, or does not come to a stop in time".to_owned(),
                    "slack_time" => "no mass hangs on the slider; give `motion.hanging_mass`".to_owned(),
                    name if name.contains("motion") || name.starts_with("peak") => "there is no motion; give `[motion]`".to_owned(),
                    _ => self.unreached(),
                };
                let fix = "change the design, or the limit".to_owned();
                all.push(Comparison { limit: Some(bound), sense, missing, fix, ..base }.judge());
            }
        }
        all
    }

    /// CAM003: a roller larger than the path allows cuts the start of the cam away.
    fn undercut(&self) -> Option<Check> {
        let radius = self.measured.get("path_curvature_radius_min")?;
        let base =
            self.base("CAM003", "undercut", "Undercut: roller radius against the path's radius of curvature", "path_curvature_radius_min");
        let lost = self.measured.get("undercut_travel").unwrap_or(0.0);
        let unit = &self.design.units.length;
        let diameter = format_si(2.0 * radius * (1.0 - 1e-4), unit, 4);
        let mut fix = format!(
            "below a travel of {} the roller rides on a corner of the cam and the force is not the one wanted: ",
            self.travel(lost)
        );
        let _ = write!(fix, "a roller diameter of at most {diameter} removes the undercut");
        if let Some(length) = self.preloaded_start() {
            let _ = write!(fix, ", and so do springs that are {} long at the start (`for_start_length`)", format_si(length, unit, 4));
        }
        let comparison = Comparison {
            required: false,
            value: Some(self.design.cut_roller_m),
            limit: Some(radius),
            display: unit.clone(),
            basis: "the cam is the path offset by the roller's radius r; it is convex with radius ϱ − r, so r must not exceed ϱ".to_owned(),
            fix,
            ..base
        };
        Some(comparison.judge())
    }

    /// Length of the springs at the start with which the path is nowhere curved more than the roller.
    fn preloaded_start(&self) -> Option<f64> {
        let purpose = &self.design.purpose;
        let sense = purpose.springs.sense();
        let fits = |length: f64| {
            let cut = Cut::new(crate::cut::Purpose { start_length_m: length, ..purpose.clone() }).ok()?;
            let [from, to] = cut.range_m();
            let most = (0..=64)
                .map(|i| {
                    let l = from + (to - from) * (f64::from(i) / 64.0) * (f64::from(i) / 64.0);
                    let p = cut.at(0, l);
                    let pick = |order: usize| [p.x.derivative(order), p.y.derivative(order)];
                    curvature_per_m(&crate::path::Place { at: pick(0), slope: pick(1), bend: pick(2) }, sense)
                })
                .fold(0.0, f64::max);
            Some(most * self.design.cut_roller_m <= 0.999)
        };
        let (mut bad, mut good) = (purpose.start_length_m, purpose.start_length_m * (1.0 + 0.3 * sense));
        if fits(good) != Some(true) {
            return None;
        }
        for _ in 0..30 {
            let middle = f64::midpoint(bad, good);
            if fits(middle) == Some(true) {
                good = middle;
            } else {
                bad = middle;
            }
        }
        Some(good)
    }

    /// CAM005: springs within their lengths.
    fn springs(&self) -> Vec<Check> {
        let built = &self.design.built;
        let mut all = Vec::new();
        if let Some(max) = built.max_length_m {
            let base = self.base("CAM005", "spring_length", "Springs not over-extended", "spring_length_max");
            let fix = "choose springs that may be longer, or a shorter stroke".to_owned();
            all.push(Comparison { limit: Some(max), fix, ..base }.judge());
        }
        if let Some(min) = built.min_length_m {
            let base = self.base("CAM006", "spring_solid", "Springs not solid", "spring_length_min");
            let fix = "choose springs that may be shorter, or a shorter stroke".to_owned();
            all.push(Comparison { limit: Some(min), sense: Sense::AtLeast, fix, ..base }.judge());
        }
        all
    }

    /// CAM007: rollers stay on the cam, at rest and in the motion.
    fn contact(&self) -> Vec<Check> {
        let mut all = Vec::new();
        for (metric, name, title) in [
            ("contact_force_min", "contact", "Rollers stay on the cam"),
            ("contact_force_min_motion", "contact_motion", "Rollers stay on the cam in the motion"),
        ] {
            if metric.ends_with("motion") && self.behaviour.motion.is_none() {
                continue;
            }
            let base = self.base("CAM007", name, title, metric);
            let scale = self.measured.get("contact_force_max").filter(|f| *f > 0.0);
            let fix =
                "the springs do not press hard enough: move more slowly, with lighter rollers, stiffer springs or more preload".to_owned();
            let basis =
                "the cam can only push: the normal force must not fall below zero; the margin is relative to the largest one at rest";
            all.push(Comparison { limit: Some(0.0), sense: Sense::AtLeast, scale, fix, basis: basis.to_owned(), ..base }.judge());
        }
        all
    }

    /// CAM008: a cable that pulls the slider stays taut.
    fn slack(&self) -> Option<Check> {
        self.behaviour.motion.as_ref()?;
        if self.behaviour.release.is_some() {
            return self.hangs();
        }
        let base = self.base("CAM008", "slack", "A pulling cable stays taut in the motion", "force_min_motion");
        let scale = self.measured.get("force_mean").filter(|f| *f > 0.0);
        let fix = format!(
            "the slider would run ahead of what pulls it, by up to {}: move more slowly or with less mass; a rod pushes as well",
            self.force_of(self.measured.get("force_min_motion").map_or(0.0, f64::abs))
        );
        let basis = "a cable can only pull: the force must not fall below zero; the margin is relative to the mean force at rest";
        Some(Comparison { required: false, limit: Some(0.0), sense: Sense::AtLeast, scale, fix, basis: basis.to_owned(), ..base }.judge())
    }

    /// CAM010: nothing yields below the contact.
    fn pressure(&self) -> Option<Check> {
        let allowed = |m: &Option<crate::design::Material>| {
            let m = m.as_ref()?;
            first_yield_pressure_pa(m.yield_pa?, m.poisson?)
        };
        let [cam, roller] = &self.design.materials;
        if cam.is_none() && roller.is_none() {
            return None;
        }
        let limit = allowed(cam).zip(allowed(roller)).map(|(a, b)| a.min(b));
        let base = self.base("CAM010", "pressure", "Pressure between roller and cam", "hertz_pressure_max");
        let fix = match (self.measured.get("hertz_pressure_max"), limit) {
            (Some(found), Some(limit)) => format!(
                "the pressure falls with the root of the width: a cam {} times as thick carries it; larger rollers and harder materials help too",
                format_number((found / limit) * (found / limit), 3)
            ),
            _ => String::new(),
        };
        let missing = "give `material.cam` and `material.roller` with their yield stress and Poisson's ratio, and `design.cam_thickness`; on a corner of the cam there is no such pressure".to_owned();
        let basis = "largest Hertzian pressure over the window against that of first yield below the surface, 1.79 σ_y for ν = 0.3 (Johnson 1985, 6.1)";
        Some(Comparison { required: false, limit, missing, fix, basis: basis.to_owned(), ..base }.judge())
    }

    /// CAM013: after a release slack is computed, not excluded.
    fn hangs(&self) -> Option<Check> {
        self.design.release.filter(|r| r.weight_kg > 0.0)?;
        let base = self.base("CAM013", "hanging", "The cable of the hanging mass stays taut", "slack_time");
        let scale = self.design.release.map(|r| r.duration_s);
        let fix = "the slider runs ahead of the falling mass: pull less by other means, or damp it".to_owned();
        let basis = "time over which the mass falls freely; it ends with a jerk in which energy is lost; the margin is relative to the time watched";
        Some(Comparison { required: false, limit: Some(0.0), scale, fix, basis: basis.to_owned(), ..base }.judge())
    }

    /// CAM009: friction needed for rolling against what is there.
    fn rolling(&self) -> Option<Check> {
        let there = self.design.friction?;
        let base = self.base("CAM009", "rolling", "Friction needed for rolling", "friction_needed_max");
        let fix = "the rollers slide: use rollers with less inertia or rolling resistance, or a rougher pair of materials".to_owned();
        Some(Comparison { required: false, limit: Some(there), display: percent(), fix, ..base }.judge())
    }
}
