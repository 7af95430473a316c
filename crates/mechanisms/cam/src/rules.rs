//! Rules that are the same for every cam: limits, springs, contact.

use forcewright_base::units::{Dimension, Unit, format_number, format_si};
use forcewright_contract::judge::{Comparison, limited};
use forcewright_elements::hertz::first_yield_pressure_pa;
use forcewright_model::{Check, Sense};

use crate::analysis::Measured;
use crate::design::{Design, DisplayUnits, Material, Requirements};
use crate::metrics::{CamMetrics, METRICS};

/// The unit in which people are shown a metric.
pub(crate) fn display_unit(requirements: Option<&Requirements>, units: &DisplayUnits, index: usize) -> Unit {
    use Dimension as D;
    let Some(info) = METRICS.get(index) else { return Unit::si(D::Ratio) };
    let limit = requirements.iter().flat_map(|r| &r.limits).find(|l| l.metric == index).map(|l| l.unit.clone());
    let named = |symbol: &str| Unit::parse(symbol).unwrap_or_else(|_| Unit::si(info.dimension));
    limit.unwrap_or_else(|| match info.dimension {
        D::Length if info.name == "undercut_travel" => units.travel.clone(),
        D::Torque => units.torque.clone(),
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

pub(crate) fn percent() -> Unit {
    Unit::parse("%").unwrap_or_else(|_| Unit::si(Dimension::Ratio))
}

/// Whether a metric is about a motion.
fn needs_motion(name: &str) -> bool {
    name.contains("motion") || name.starts_with("peak") || ["speed_max", "turn_speed_max", "work_in", "energy_lost"].contains(&name)
}

/// What the rules look at.
pub(crate) struct Rules<'a> {
    pub requirements: Option<&'a Requirements>,
    pub units: &'a DisplayUnits,
    pub measured: &'a Measured,
    /// Why values are missing, where the analysis did not come to its end.
    pub unreached: Option<String>,
    /// Whether a motion is asked for, and whether it came to its end.
    pub moves: [bool; 2],
    /// Arm of the rolling resistance, m.
    pub arm_m: f64,
    /// Lengths at which the springs are solid and over-extended, m.
    pub lengths_m: [Option<f64>; 2],
    /// Friction that is there between roller and cam.
    pub friction: Option<f64>,
    /// Of cam and roller.
    pub materials: &'a [Option<Material>; 2],
}

impl<'a> Rules<'a> {
    /// Of a cam with a slider.
    pub(crate) fn of(design: &'a Design, measured: &'a Measured, unreached: Option<String>, moved: bool) -> Self {
        Self {
            requirements: design.requirements.as_ref(),
            units: &design.units,
            measured,
            unreached,
            moves: [design.moves(), moved],
            arm_m: design.built.arm_m,
            lengths_m: [design.built.min_length_m, design.built.max_length_m],
            friction: design.friction,
            materials: &design.materials,
        }
    }

    pub(crate) fn base(&self, code: &'static str, name: &str, title: &str, metric: &str) -> Comparison {
        let display = |i| display_unit(self.requirements, self.units, i);
        Comparison::of_metric(code, [name, title], metric, self.measured, display, self.why_missing(metric))
    }

    /// CAM004: work lost between up and down.
    pub(crate) fn hysteresis(&self, requirements: &Requirements) -> Option<Check> {
        let limit = requirements.hysteresis?;
        let base = self.base("CAM004", "hysteresis", "Hysteresis", "hysteresis");
        let fix = match self.measured.get("hysteresis") {
            Some(value) if self.arm_m > 0.0 => {
                let arm = self.arm_m * limit / value;
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
    pub(crate) fn limits(&self, requirements: &Requirements) -> Vec<Check> {
        limited::<CamMetrics>(&requirements.limits, "change the design, or the limit", |name, title| self.base("CAM012", name, title, name))
    }

    /// Why a metric has no value.
    fn why_missing(&self, name: &str) -> String {
        if let Some(unreached) = &self.unreached {
            return unreached.clone();
        }
        let why = match name {
            _ if needs_motion(name) && !self.moves[0] => "there is no motion; give `[motion]`",
            _ if needs_motion(name) && !self.moves[1] => "the motion does not come to its end; see the status",
            "contact_life" => "give `brinell` of both materials, steels of 100 to 400, and what the pressure needs",
            "profile_error_rms" | "profile_error_max" => "the profile has no errors; give `errors.measured_profile`",
            "hertz_pressure_max" => "give `material.cam`, `material.roller` and `design.cam_thickness`",
            "force_deviation" => "no force is required; give `requirements.force`",
            "torque_deviation" => "no torque is required; give `requirements.torque`",
            "time_to_end" | "speed_end" => "the slider is not let go, or does not come to a stop in time",
            "slack_time" => "no mass hangs on the slider; give `motion.hanging_mass`",
            "peak_force_ratio_to" => "there is no slower motion to compare with; give `motion.reference_duration`",
            "peak_force_ratio" | "peak_torque_ratio" => {
                "what is needed at rest comes to zero on the way, so that nothing is in proportion to it"
            }
            _ => "the design has no such value; see the meaning of the metric",
        };
        why.to_owned()
    }

    /// CAM005: springs within their lengths.
    pub(crate) fn springs(&self) -> Vec<Check> {
        let mut all = Vec::new();
        if let Some(max) = self.lengths_m[1] {
            let base = self.base("CAM005", "spring_length", "Springs not over-extended", "spring_length_max");
            let fix = "choose springs that may be longer, or a shorter stroke".to_owned();
            all.push(Comparison { limit: Some(max), fix, ..base }.judge());
        }
        if let Some(min) = self.lengths_m[0] {
            let base = self.base("CAM006", "spring_solid", "Springs not solid", "spring_length_min");
            let fix = "choose springs that may be shorter, or a shorter stroke".to_owned();
            all.push(Comparison { limit: Some(min), sense: Sense::AtLeast, fix, ..base }.judge());
        }
        all
    }

    /// CAM007: rollers stay on the cam, at rest and in a motion.
    pub(crate) fn contact(&self, moves: bool) -> Vec<Check> {
        let mut all = Vec::new();
        for (metric, name, title) in [
            ("contact_force_min", "contact", "Rollers stay on the cam"),
            ("contact_force_min_motion", "contact_motion", "Rollers stay on the cam in the motion"),
        ] {
            if metric.ends_with("motion") && !moves {
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

    /// CAM010: nothing yields below the contact.
    pub(crate) fn pressure(&self) -> Option<Check> {
        let allowed = |m: &Option<Material>| {
            let m = m.as_ref()?;
            first_yield_pressure_pa(m.yield_pa?, m.poisson?)
        };
        let [cam, roller] = self.materials;
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

    /// CAM009: friction needed for rolling against what is there.
    pub(crate) fn rolling(&self) -> Option<Check> {
        let there = self.friction?;
        let base = self.base("CAM009", "rolling", "Friction needed for rolling", "friction_needed_max");
        let fix = "the rollers slide: use rollers with less inertia or rolling resistance, or a rougher pair of materials".to_owned();
        Some(Comparison { required: false, limit: Some(there), display: percent(), fix, ..base }.judge())
    }
}
