//! Requirements and rules against what was found.

use std::fmt::Write as _;

use forcewright_base::units::{format_number, format_si};
use forcewright_contract::judge::Comparison;
use forcewright_model::{Check, Sense};

use crate::analysis::{Behaviour, Measured, Station};
use crate::cut::Cut;
use crate::design::{Design, Requirements};
use crate::mechanism::Stop;
use crate::path::curvature_per_m;
use crate::rules::{Rules, percent};

/// Requirements in the order of the language, then the family's own rules.
pub(crate) fn checks(design: &Design, behaviour: &Behaviour, measured: &Measured) -> Vec<Check> {
    let context = Context {
        design,
        behaviour,
        measured,
        rules: Rules::of(design, measured, unreached(design, behaviour), behaviour.motion.is_some()),
    };
    let mut all = Vec::new();
    if let Some(requirements) = &design.requirements {
        all.extend(context.force(requirements));
        all.extend(context.stroke(requirements));
        all.extend(context.rules.hysteresis(requirements));
        all.extend(context.rules.limits(requirements));
    }
    all.extend(context.undercut());
    all.extend(context.rules.springs());
    all.extend(context.contact());
    all.extend(context.slack());
    all.extend(context.rules.rolling());
    all.extend(context.rules.pressure());
    all
}

struct Context<'a> {
    design: &'a Design,
    behaviour: &'a Behaviour,
    measured: &'a Measured,
    rules: Rules<'a>,
}

/// Why values are missing, where the analysis did not come to its end.
fn unreached(design: &Design, behaviour: &Behaviour) -> Option<String> {
    let (s, why) = behaviour.stopped?;
    let travel = format_si(s, &design.units.travel, 4);
    let what = if matches!(why, Stop::Locks(_)) { "friction locks the mechanism" } else { "the mechanism cannot be assembled" };
    Some(format!("{what} at a travel of {travel}; see the status"))
}

impl Context<'_> {
    fn travel(&self, s_m: f64) -> String {
        format_si(s_m, &self.design.units.travel, 4)
    }

    fn force_of(&self, force_n: f64) -> String {
        format_si(force_n, &self.design.units.force, 4)
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
        let base = self.rules.base("CAM001", "force", "Force inside its band, up and down", "force_deviation");
        Some(Comparison { limit: Some(*band), display: percent(), fix, basis: basis.to_owned(), ..base }.judge())
    }

    /// CAM002: the stroke that can be assembled, undercut or not.
    fn stroke(&self, requirements: &Requirements) -> Option<Check> {
        let wanted = requirements.stroke_m?;
        let start = self.behaviour.stations.first().map_or(0.0, |s| s.travel_m);
        let reached = self.behaviour.stopped.map_or(self.design.purpose.stroke_m, |(s, _)| s) - start;
        let base = self.rules.base("CAM002", "stroke", "Stroke", "undercut_travel");
        let comparison = Comparison {
            value: Some(reached),
            limit: Some(wanted * (1.0 - 1e-12)),
            sense: Sense::AtLeast,
            display: self.design.units.travel.clone(),
            basis: "travel for which the cam is cut and the mechanism can be assembled and moved".to_owned(),
            fix: match self.behaviour.stopped {
                None if start > 0.0 && self.behaviour.mechanism.pose([0.0, 0.0]).is_ok() => format!(
                    "friction locks the first {}: less of it, springs stretched more at the start, or a larger `design.stroke`",
                    self.travel(start)
                ),
                None => "raise `design.stroke`; spring length, cam length and pressure angle grow with it".to_owned(),
                Some((_, Stop::Locks(_))) => "friction locks the rollers on the way: less of it, or longer braces".to_owned(),
                Some((_, Stop::NotAssembled(_))) => "the mechanism comes apart on the way; the status says what to do".to_owned(),
            },
            ..base
        };
        Some(comparison.judge())
    }

    /// CAM003: a roller larger than the path allows cuts the start of the cam away.
    fn undercut(&self) -> Option<Check> {
        let radius = self.measured.get("path_curvature_radius_min")?;
        let base = self.rules.base(
            "CAM003",
            "undercut",
            "Undercut: roller radius against the path's radius of curvature",
            "path_curvature_radius_min",
        );
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

    /// CAM007: rollers stay on the cam, at rest and in the motion.
    fn contact(&self) -> Vec<Check> {
        self.rules.contact(self.behaviour.motion.is_some())
    }

    /// CAM008: a cable that pulls the slider stays taut.
    fn slack(&self) -> Option<Check> {
        self.behaviour.motion.as_ref()?;
        if self.behaviour.release.is_some() {
            return self.hangs();
        }
        let base = self.rules.base("CAM008", "slack", "A pulling cable stays taut in the motion", "force_min_motion");
        let scale = self.measured.get("force_mean").filter(|f| *f > 0.0);
        let fix = format!(
            "the slider would run ahead of what pulls it, by up to {}: move more slowly or with less mass; a rod pushes as well",
            self.force_of(self.measured.get("force_min_motion").map_or(0.0, f64::abs))
        );
        let basis = "a cable can only pull: the force must not fall below zero; the margin is relative to the mean force at rest";
        Some(Comparison { required: false, limit: Some(0.0), sense: Sense::AtLeast, scale, fix, basis: basis.to_owned(), ..base }.judge())
    }

    /// CAM013: after a release slack is computed, not excluded.
    fn hangs(&self) -> Option<Check> {
        self.design.release.filter(|r| r.weight_kg > 0.0)?;
        let base = self.rules.base("CAM013", "hanging", "The cable of the hanging mass stays taut", "slack_time");
        let scale = self.design.release.map(|r| r.duration_s);
        let fix = "the slider runs ahead of the falling mass: pull less by other means, or damp it".to_owned();
        let basis = "time over which the mass falls freely; it ends with a jerk in which energy is lost; the margin is relative to the time watched";
        Some(Comparison { required: false, limit: Some(0.0), scale, fix, basis: basis.to_owned(), ..base }.judge())
    }
}
