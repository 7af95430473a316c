//! Requirements and rules against what was found.

mod limits;

use std::fmt::Write as _;

use forcewright_base::maths;
use forcewright_base::roots::root;
use forcewright_base::units::{Dimension, Unit, format_number, format_si};
use forcewright_contract::judge::Comparison;
use forcewright_elements::cables::strength_left;
use forcewright_elements::grooves::Groove;
use forcewright_elements::wrap::WrapError;
use forcewright_model::{Check, Sense};

use crate::analysis::{Behaviour, Measured};
use crate::design::{Design, DisplayUnits, Requirements, Source};
use crate::metrics::METRICS;
use crate::statics::Statics;

/// Largest angle between a span and its groove, rad: 1.5°, the rule of drum makers; no standard was at hand.
pub(crate) const LARGEST_FLEET_RAD: f64 = 0.026_179_938_779_914_944;
/// Radius of a seat over the diameter of the cable: below the first it pinches, at the second steel cables endure two thirds of what they do
/// at 0.53 (`feyrer-2015`).
const SEAT: [f64; 2] = [0.5, 0.6];
/// Most that a preload is raised in search of a stiffness.
const MOST_PRELOAD: f64 = 64.0;

/// The unit in which people are shown a metric.
pub(crate) fn display_unit(requirements: Option<&Requirements>, units: &DisplayUnits, index: usize) -> Unit {
    use Dimension as D;
    let Some(info) = METRICS.get(index) else { return Unit::si(D::Ratio) };
    let limit = requirements.iter().flat_map(|r| &r.limits).find(|l| l.metric == index).map(|l| l.unit.clone());
    let named = |symbol: &str| Unit::parse(symbol).unwrap_or_else(|_| Unit::si(info.dimension));
    limit.unwrap_or_else(|| match info.dimension {
        D::Length => units.length.clone(),
        D::Force => units.force.clone(),
        D::Torque => units.torque.clone(),
        D::RotationalStiffness => units.stiffness.clone(),
        D::Angle if matches!(info.name, "lost_motion_output" | "wind_up_output" | "fleet_angle") => units.small_angle.clone(),
        D::Angle => units.angle.clone(),
        D::Stress => named("MPa"),
        D::Energy => named("mJ"),
        D::Inertia => named("kg*m^2"),
        D::Ratio if info.name.starts_with("efficiency") || info.name == "slip_used" => named("%"),
        other => Unit::si(other),
    })
}

/// Requirements in the order of the language, then the family's own rules.
pub(crate) fn checks(design: &Design, behaviour: &Behaviour, measured: &Measured) -> Vec<Check> {
    let context = Context { design, behaviour, measured };
    let mut all = Vec::new();
    if let Some(requirements) = &design.requirements {
        all.push(context.capacity(requirements));
        all.extend(context.stiffness(requirements));
        all.extend(context.lost_motion(requirements));
        all.extend(context.limits(requirements));
    }
    all.extend(context.strength());
    all.push(context.bending());
    all.extend(context.slack());
    all.extend(context.termination());
    all.extend(context.pin());
    all.push(context.fleet());
    all.push(context.turns());
    all.extend(context.grooves());
    all.extend(context.seat());
    all.push(context.gap());
    all
}

struct Context<'a> {
    design: &'a Design,
    behaviour: &'a Behaviour,
    measured: &'a Measured,
}

impl Context<'_> {
    fn base(&self, code: &'static str, name: &str, title: &str, metric: &str) -> Comparison {
        let display = |i| display_unit(self.design.requirements.as_ref(), &self.design.units, i);
        Comparison::of_metric(code, [name, title], metric, self.measured, display, self.missing())
    }

    fn torque(&self, nm: f64) -> String {
        format_si(nm, &self.design.units.torque, 4)
    }

    fn length(&self, m: f64) -> String {
        format_si(m, &self.design.units.length, 4)
    }

    /// Why a value is missing that nothing else explains.
    fn missing(&self) -> String {
        match &self.behaviour.required {
            Some(Err(error)) => self.not_held(error),
            Some(Ok(_)) => "the design has no such value; see the meaning of the metric".to_owned(),
            None => "no torque is required; give `requirements.torque`".to_owned(),
        }
    }

    fn not_held(&self, error: &WrapError) -> String {
        let lever_m = self.behaviour.statics.levers_m()[1];
        match error {
            WrapError::GrossSlip { capacity_n } => {
                format!("the cables slip over the whole input drum from {} on", self.torque(capacity_n * lever_m))
            }
            WrapError::Slack { limit_n } => {
                format!(
                    "in the paper's model the slack side is loose from {} on",
                    self.torque(limit_n * self.design.built.cables.len() as f64 * lever_m)
                )
            }
            other => other.to_string(),
        }
    }

    /// CAPS001: the cables hold the torque.
    fn capacity(&self, requirements: &Requirements) -> Check {
        let value = self.measured.get("gross_slip_torque_output");
        let base = self.base("CAPS001", "torque", "Cables hold the torque", "gross_slip_torque_output");
        let fix = value.map_or_else(String::new, |held_nm| {
            format!(
                "it grows in proportion to the preload: {} times as much holds the torque; another turn on the input drum multiplies the ratio of the tensions by {}",
                format_number(1.006 * requirements.torque_nm / held_nm, 3),
                format_number(maths::exp(std::f64::consts::TAU * self.design.built.friction * self.design.built.groove_factor), 3)
            )
        });
        let basis = "gross slip: ln(T_taut/T_slack) = μΘ on the input drum, both sides with one displacement, in the middle of the travel and at its ends; in the paper's model 2 T_p tanh(μΘ/2)";
        let missing = "fastened cables do not slip as a whole; see the slack side".to_owned();
        let limit = Some(requirements.torque_nm);
        Comparison { limit, sense: Sense::AtLeast, fix, missing, basis: basis.to_owned(), required: !self.design.built.fastened, ..base }
            .judge()
    }

    /// CAPS002: tangent stiffness at the output.
    fn stiffness(&self, requirements: &Requirements) -> Option<Check> {
        let wanted = requirements.stiffness_nm_per_rad?;
        let base = self.base("CAPS002", "stiffness", "Stiffness at the output", "stiffness_tangent_output");
        let missed = base.value.is_none_or(|v| v < wanted);
        let fix = if missed { self.stiffer(requirements.torque_nm, wanted) } else { String::new() };
        let basis = "tangent dτ/dφ under the required torque, input held, from rest; K_t = K r²";
        Some(Comparison { limit: Some(wanted), sense: Sense::AtLeast, fix, basis: basis.to_owned(), ..base }.judge())
    }

    /// What would make the output stiff enough.
    fn stiffer(&self, torque_nm: f64, wanted: f64) -> String {
        let initial = self.behaviour.statics.initial_nm_per_rad();
        let unit = &self.design.units.stiffness;
        if initial <= wanted {
            return format!(
                "the free spans alone give {}: use shorter spans, a stiffer cable, more cables or larger drums",
                format_si(initial, unit, 4)
            );
        }
        let at = |factor: f64| {
            let mut built = self.design.built.clone();
            built.cables.iter_mut().for_each(|c| c.preload_n *= factor);
            let statics = Statics::new(&built, &built.place(&self.behaviour.geometry, built.middle_rad()), self.design.source).ok()?;
            Some(statics.torsional(statics.under(torque_nm).ok()?.tangent_n_per_m, 1))
        };
        let gap = |log: f64| at(maths::exp(log)).unwrap_or(0.0) - wanted;
        match root(gap, 0.0, maths::ln(MOST_PRELOAD), 1e-6) {
            Ok(log) => {
                let factor = maths::exp(log);
                format!(
                    "a preload {} times as high gives it; a shorter span, more cables or grooves with more friction help too",
                    format_number(1.0005 * factor, 4)
                )
            }
            Err(_) => "more preload alone does not give it: use shorter spans, a stiffer cable or more cables".to_owned(),
        }
    }

    /// CAPS003: what is lost at zero torque.
    fn lost_motion(&self, requirements: &Requirements) -> Option<Check> {
        let limit = requirements.lost_motion_rad?;
        let base = self.base("CAPS003", "lost_motion", "Lost motion", "lost_motion_output");
        let fix = base.value.map_or_else(String::new, |value| {
            format!(
                "it falls about as the preload rises: {} times as much; more friction and a stiffer cable help in the same way",
                format_number(value / limit, 3)
            )
        });
        let missing = if self.design.source == Source::Paper {
            "the paper's model has no unloading: use `model.source = \"corrected\"`".to_owned()
        } else {
            self.missing()
        };
        Some(Comparison { limit: Some(limit), fix, missing, ..base }.judge())
    }

    /// CAPS005: breaking force over the largest tension.
    fn strength(&self) -> Option<Check> {
        let wanted = self.design.requirements.as_ref().and_then(|r| r.safety_factor);
        if wanted.is_none() && self.behaviour.required.is_none() {
            return None;
        }
        let base = self.base("CAPS005", "strength", "Strength of the cables", "cable_safety_factor");
        let limit = wanted.unwrap_or(1.0);
        let fix = base.value.map_or_else(String::new, |value| self.stronger(limit / value));
        let basis = "breaking force over the largest tension under the required torque, of steel less what bending takes; without `requirements.safety_factor` against 1, where it breaks";
        let missing = self.missing_metric("cable_safety_factor");
        Some(
            Comparison {
                required: wanted.is_some(),
                limit: Some(limit),
                sense: Sense::AtLeast,
                fix,
                missing,
                basis: basis.to_owned(),
                ..base
            }
            .judge(),
        )
    }

    /// What makes the cables so many times as strong. Tensions do not depend on AE where it is the same all along, so that on the same drums
    /// the strength of a cable f times as thick is f² times what bending leaves of it.
    fn stronger(&self, missing: f64) -> String {
        let built = &self.design.built;
        let ratio = 2.0 * built.radii_m[0].min(built.radii_m[1]) / built.cable_m();
        let bends = built.cables.iter().any(|c| c.wire_m.is_some());
        let kept = |ratio: f64| if bends { strength_left(ratio) } else { Some(1.0) };
        let Some(now) = kept(ratio) else { return "the drums are smaller than the cable is thick".to_owned() };
        let gain = |f: f64| f * f * kept(ratio / f).unwrap_or(0.0) / now;
        // Bending is not tabled below a drum as thick as the cable.
        let most = if bends { ratio } else { 1e3 };
        let thicker = root(|f| gain(f) - 1.003 * missing, 1.0, most.max(1.0), 1e-6).ok();
        let thicker = thicker.map_or_else(
            || "no thicker cable alone does it on these drums, as they bend it more: larger drums".to_owned(),
            |f| {
                // Rounded up to three digits.
                let f = (1e3 * f).ceil() / 1e3;
                format!(
                    "the strength grows as the square of the diameter, less what bending takes: {} times as thick a cable, of {}, on the same drums",
                    format_number(f, 4),
                    self.length(f * built.cable_m())
                )
            },
        );
        format!("{thicker}; or more cables, larger drums, less preload")
    }

    /// CAPS006: drum over cable diameter.
    fn bending(&self) -> Check {
        let least = self.design.built.cables.iter().map(|c| c.least_ratio).collect::<Option<Vec<_>>>();
        let limit = least.and_then(|all| all.into_iter().reduce(f64::max));
        let base = self.base("CAPS006", "bending", "Drum diameter over cable diameter", "bending_ratio");
        let fix = limit.map_or_else(String::new, |limit| {
            let cable_m = self.design.built.cable_m();
            format!(
                "the wires tire early: drums of at least {} to the middle of the cable, or a cable of finer wires",
                self.length(limit * cable_m)
            )
        });
        let missing = "give `min_bend_ratio` of the cables".to_owned();
        let basis = "D/d of the smaller drum against the least ratio of the construction (maker's data)";
        Comparison { required: false, limit, sense: Sense::AtLeast, fix, missing, basis: basis.to_owned(), ..base }.judge()
    }

    /// CAPS007: the slack side keeps some tension.
    fn slack(&self) -> Option<Check> {
        let fastened = self.design.built.fastened;
        let held = self.behaviour.at_torque().is_some();
        self.behaviour.required.as_ref().filter(|_| held || fastened)?;
        let base = self.base("CAPS007", "slack", "Slack side stays taut", "slack_tension");
        let scale = self.measured.get("preload_left");
        let fix = "raise the preload: a slack cable leaves its groove, and the taut side carries alone".to_owned();
        let basis = if fastened {
            "smallest tension under the required torque over the travel; a fastened cable does not slip as a whole, this is what it holds; the margin is relative to the preload"
        } else {
            "smallest tension under the required torque over the travel; the margin is relative to the preload"
        };
        // A loose side carries exactly nothing.
        let loose = base.value.is_some_and(|n| n <= 0.0);
        let value = if loose { Some(-f64::MIN_POSITIVE) } else { base.value };
        Some(
            Comparison {
                required: fastened,
                value,
                limit: Some(0.0),
                sense: Sense::AtLeast,
                scale,
                fix,
                basis: basis.to_owned(),
                broken: !held,
                ..base
            }
            .judge(),
        )
    }

    /// CAPS008: slip ends before the terminations.
    fn termination(&self) -> Option<Check> {
        self.behaviour.at_torque()?;
        let base = self.base("CAPS008", "termination", "Slip ends before the terminations", "output_wrap_min");
        let needed = self.measured.get("slip_angle_slack").into_iter().chain(self.measured.get("slip_angle_taut")).fold(0.0, f64::max);
        let unit = &self.design.units.angle;
        let fix = format!(
            "the anchor carries part of the change of the tension: `output_anchor_wrap` of at least {}",
            format_si(needed, unit, 4)
        );
        let basis = "smallest wrap before a termination over the travel against the largest slip angle under the required torque";
        Some(Comparison { required: false, limit: Some(needed), sense: Sense::AtLeast, fix, basis: basis.to_owned(), ..base }.judge())
    }

    /// CAPS014: slip ends before the pin on the input.
    fn pin(&self) -> Option<Check> {
        let built = &self.design.built;
        if !built.fastened {
            return None;
        }
        self.behaviour.at_torque()?;
        let base = self.base("CAPS014", "pin_wrap", "Slip ends before the pin", "slip_used");
        let fix = base.value.map_or_else(
            || "a side is loose: raise the preload".to_owned(),
            |used| {
                let least_rad = built.least_pin_wrap_rad(&self.behaviour.geometry);
                let turns = (2.0 * (used - 1.0).max(0.0) * least_rad / std::f64::consts::TAU).ceil();
                format!(
                    "the pin carries part of the change of the tension: about {} more `extra_turns`, less travel or more preload",
                    format_number(turns.max(1.0), 3)
                )
            },
        );
        let basis =
            "angle |ln(T/T_p)|/μ that slip needs on the input drum over the wrap up to the pin, where the travel leaves the least of it";
        let broken = self.behaviour.reaches_pin();
        Some(Comparison { required: false, limit: Some(1.0), fix, basis: basis.to_owned(), broken, ..base }.judge())
    }

    /// CAPS009: spans against their grooves.
    fn fleet(&self) -> Check {
        let base = self.base("CAPS009", "fleet", "Fleet angle", "fleet_angle");
        let built = &self.design.built;
        let distance = self.behaviour.geometry.aligned_distances(0.9 * built.distance_m, 1.2 * built.distance_m).unwrap_or_default();
        let nearest = distance
            .into_iter()
            .map(|a| a.centre_distance_m)
            .min_by(|a, b| (a - built.distance_m).abs().total_cmp(&(b - built.distance_m).abs()));
        let phase = self.behaviour.geometry.aligning_phase_rad(0).ok();
        if built.seat.groove == Groove::Flat {
            let basis = "smooth drums have no groove to be out of line with: the spans slant by the angle of the helix, against 1.5°, makers' rule for smooth running";
            let pitch_m = std::f64::consts::TAU * built.radii_m[0] * maths::tan(LARGEST_FLEET_RAD);
            let fix = format!("a pitch of at most {}, or a larger input drum; or grooves", self.length(0.999 * pitch_m));
            return Comparison { required: false, limit: Some(LARGEST_FLEET_RAD), fix, basis: basis.to_owned(), ..base }.judge();
        }
        let mut fix = "the cable climbs out of its groove".to_owned();
        if let Some(distance_m) = nearest {
            let _ = write!(fix, ": both spans are in line at a centre distance of {}", self.length(distance_m));
        }
        if let Some(phase) = phase {
            let _ = write!(fix, ", or with `groove_phase = \"{}\"`", format_si(phase, &self.design.units.angle, 5));
        }
        let basis = "largest angle between a span and its groove, against 1.5°, makers' rule for smooth running";
        Comparison { required: false, limit: Some(LARGEST_FLEET_RAD), fix, basis: basis.to_owned(), ..base }.judge()
    }

    /// CAPS010: neighbouring turns do not touch.
    fn turns(&self) -> Check {
        let base = self.base("CAPS010", "turns", "Turns do not touch", "rope_clearance");
        let cable_m = self.design.built.cable_m();
        let nearest = self.behaviour.neighbours.first();
        let fix = match nearest {
            Some(nearest) if nearest.pitches < 0.5 => {
                "two turns meet on one groove: place the cables on other lines, with fewer turns or less travel".to_owned()
            }
            _ => format!(
                "a pitch of at least {} keeps them apart",
                self.length(self.design.built.pitch_m + (-base.value.unwrap_or(0.0)).max(0.0) + 0.05 * cable_m)
            ),
        };
        let basis = "smallest gap between the surfaces of neighbouring turns and of passing spans over the travel; the margin is relative to the cable's diameter";
        let missing = "no turn has a neighbour".to_owned();
        Comparison {
            required: false,
            limit: Some(0.0),
            sense: Sense::AtLeast,
            scale: Some(cable_m),
            fix,
            missing,
            basis: basis.to_owned(),
            ..base
        }
        .judge()
    }

    /// CAPS011: grooves do not run into each other.
    fn grooves(&self) -> Option<Check> {
        let built = &self.design.built;
        if built.seat.groove == Groove::Flat {
            return None;
        }
        let width_m = built.seat.width_for_m(built.cable_m());
        let apart_m = self.behaviour.geometry.groove_distance_m().unwrap_or(f64::INFINITY).min(built.pitch_m);
        let base = self.base("CAPS011", "grooves", "Grooves do not run into each other", "rope_clearance");
        let fix = format!(
            "the land between two grooves is gone: a pitch of at least {}, or shallower grooves",
            self.length(built.pitch_m * width_m / apart_m)
        );
        let basis = "smallest axial distance of different grooves on a drum against the width of a groove at the surface";
        Some(
            Comparison {
                required: false,
                value: Some(apart_m),
                limit: Some(width_m),
                sense: Sense::AtLeast,
                fix,
                basis: basis.to_owned(),
                ..base
            }
            .judge(),
        )
    }

    /// CAPS012: a round seat that fits the cable.
    fn seat(&self) -> Option<Check> {
        let built = &self.design.built;
        let radius_m = built.seat.radius_m.filter(|_| matches!(built.seat.groove, Groove::Round { .. } | Groove::Undercut { .. }))?;
        let cable_m = built.cable_m();
        let base = self.base("CAPS012", "seat", "Radius of the seat", "rope_clearance");
        let narrow = radius_m < SEAT[0] * cable_m;
        let (limit, sense) = if narrow { (SEAT[0] * cable_m, Sense::AtLeast) } else { (SEAT[1] * cable_m, Sense::AtMost) };
        let fix = format!("the usual one is 0.53 of the cable's diameter: {}", self.length(0.53 * cable_m));
        let basis = "radius of the seat against half the cable's diameter, and 0.6 of it, where steel cables endure two thirds of what they do at 0.53";
        Some(Comparison { required: false, value: Some(radius_m), limit: Some(limit), sense, fix, basis: basis.to_owned(), ..base }.judge())
    }

    /// CAPS013: the drums with their cables clear each other.
    fn gap(&self) -> Check {
        let base = self.base("CAPS013", "gap", "Drums clear each other", "rope_clearance");
        let built = &self.design.built;
        let (gap_m, cable_m) = (built.gap_m(), built.cable_m());
        // Rounded to four digits it must still clear.
        let mut fix = format!("a centre distance of at least {}", self.length(1.0005 * (built.distance_m - gap_m)));
        if built.land_m() > 0.0 {
            fix += ", or shallower grooves";
        }
        let basis = "gap between both drums on the line of centres, to the surface of the cable or of a land that stands higher; the margin is relative to the cable's diameter";
        Comparison {
            required: false,
            value: Some(gap_m),
            limit: Some(0.0),
            sense: Sense::AtLeast,
            scale: Some(cable_m),
            fix,
            basis: basis.to_owned(),
            ..base
        }
        .judge()
    }
}
