//! Sections of grooves, as typed and as friction sees them.

use forcewright_base::diagnostics::{Diagnostic, Diagnostics, Severity, Span};
use forcewright_base::maths;
use forcewright_contract::describe::Section;
use forcewright_elements::grooves::{Groove, Pressure};

use super::{place_of, si};
use crate::spec::{self, Spec};

/// Radius of a round seat over the diameter of a new cable (`feyrer-2015`: the endurance is largest there).
const SEAT_RADIUS: f64 = 0.53;

/// The section of a groove.
#[derive(Clone, Debug, PartialEq)]
pub struct Seat {
    /// As friction sees it.
    pub groove: Groove,
    /// Radius of a round seat, or of the bottom of a V, m; `None` of a flat drum and where nothing was said.
    pub radius_m: Option<f64>,
    /// Depth, m, if given.
    pub depth_m: Option<f64>,
}

impl Seat {
    /// Effective over plain friction; of a section that was resolved.
    pub fn friction_factor(&self) -> f64 {
        self.groove.friction_factor().unwrap_or(1.0)
    }

    /// Radius of the seat for a cable, m.
    pub fn radius_for_m(&self, cable_m: f64) -> f64 {
        self.radius_m.unwrap_or(SEAT_RADIUS * cable_m)
    }

    /// Depth of the groove for a cable, m, from the surface of the drum to where the cable lies lowest: what is given, else what the seat needs.
    pub fn depth_for_m(&self, cable_m: f64) -> f64 {
        let radius_m = self.radius_for_m(cable_m);
        self.depth_m.unwrap_or_else(|| match &self.groove {
            Groove::Flat => 0.0,
            Groove::Round { half_angle_rad, .. } => radius_m * (1.0 - maths::cos(*half_angle_rad)),
            Groove::Undercut { opening_rad, .. } => radius_m * (1.0 - maths::sin(0.5 * opening_rad)),
            // Up to the height at which the flanks touch, and as much again.
            Groove::Vee { half_angle_rad } => cable_m * (1.0 - maths::sin(*half_angle_rad)),
        })
    }

    /// Width of the groove at the surface of the drum for a cable, m; 0 of a flat drum.
    pub fn width_for_m(&self, cable_m: f64) -> f64 {
        let (depth_m, radius_m) = (self.depth_for_m(cable_m), self.radius_for_m(cable_m));
        match &self.groove {
            Groove::Flat => 0.0,
            // Below its middle the circle widens; above, the walls are upright.
            Groove::Round { .. } | Groove::Undercut { .. } => {
                let above_m = (radius_m - depth_m).max(0.0);
                2.0 * (radius_m * radius_m - above_m * above_m).sqrt()
            }
            // The cable's lowest point lies r (1/sin − 1) above the tip.
            Groove::Vee { half_angle_rad } => {
                let (sin, cos) = maths::sin_cos(*half_angle_rad);
                2.0 * (depth_m + 0.5 * cable_m * (1.0 / sin - 1.0)) * sin / cos
            }
        }
    }
}

/// E0702: reads the section; keys of another section are refused, and those that it needs asked for.
pub(super) fn seat_of(spec: &Spec, diagnostics: &mut Diagnostics) -> Option<Seat> {
    let typed = &spec.design.groove;
    let profile = typed.profile.as_ref()?;
    let table = typed.pressure.as_ref().is_some_and(|p| p.value == "table");
    let given = [
        ("seat_angle", typed.seat_angle.as_ref().map(|l| l.span)),
        ("angle", typed.angle.as_ref().map(|l| l.span)),
        ("undercut", typed.undercut.as_ref().map(|l| l.span)),
        ("radius", typed.radius.as_ref().map(|l| l.span)),
        ("depth", typed.depth.as_ref().map(|l| l.span)),
        ("pressure_table", typed.pressure_table.as_ref().map(|l| l.span)),
    ];
    let of: &[&str] = match profile.value {
        "flat" => &[],
        "round" if table => &["radius", "depth", "pressure_table"],
        "round" => &["seat_angle", "radius", "depth"],
        "v" => &["angle", "depth"],
        _ => &["seat_angle", "undercut", "radius", "depth"],
    };
    let before = diagnostics.errors();
    for (key, span) in given {
        if let Some(span) = span.filter(|_| !of.contains(&key)) {
            let error = Diagnostic::error("E0702", span, format!("a {} groove has no `{key}` here", profile.value));
            diagnostics.push(error.label("not used").help(if of.is_empty() {
                "remove it".to_owned()
            } else {
                format!("it has {}", listed(of))
            }));
        }
        let needed = of.contains(&key) && !matches!(key, "radius" | "depth");
        if needed && span.is_none() && !refused_in(typed, diagnostics) {
            let error = Diagnostic::error("E0702", place_of(typed), format!("a {} groove needs `{key}`", profile.value));
            diagnostics.push(error.label("in this table").help(example(key)));
        }
    }
    if diagnostics.errors() > before {
        return None;
    }
    let half = |rad: Option<f64>| rad.map(|rad| 0.5 * rad);
    let groove = match profile.value {
        "flat" => Groove::Flat,
        "v" => Groove::Vee { half_angle_rad: half(si(&typed.angle))? },
        "round" if table => {
            let points: Vec<[f64; 2]> = typed.pressure_table.as_ref()?.value.iter().map(|p| [p.value[0].si, p.value[1].si]).collect();
            let half_angle_rad = points.last().map_or(0.0, |p| p[0]);
            Groove::Round { half_angle_rad, pressure: Pressure::Table(points) }
        }
        "round" => {
            let pressure = if typed.pressure.as_ref().is_some_and(|p| p.value == "uniform") { Pressure::Uniform } else { Pressure::Cosine };
            Groove::Round { half_angle_rad: half(si(&typed.seat_angle))?, pressure }
        }
        _ => Groove::Undercut { undercut_rad: si(&typed.undercut)?, opening_rad: std::f64::consts::PI - si(&typed.seat_angle)? },
    };
    if let Err(error) = groove.friction_factor() {
        let at = typed.pressure_table.as_ref().map_or_else(|| place_of(typed), |t| t.span);
        let refused = Diagnostic::error("E0702", at, format!("there is no such groove: {error}"));
        diagnostics.push(refused.label("this section").help("see `forcewright explain E0702`"));
        return None;
    }
    Some(Seat { groove, radius_m: si(&typed.radius), depth_m: si(&typed.depth) })
}

/// Whether a value was given and refused in the table, or behind its heading, or by a setting: a key that has none for that is not missing.
fn refused_in(typed: &Section<spec::Groove>, diagnostics: &Diagnostics) -> bool {
    let table = place_of(typed);
    let here = |at: Span| at.source != table.source || at.start >= table.start;
    let refused = |d: &&Diagnostic| d.severity == Severity::Error && d.code.starts_with("E02") && d.span.is_some_and(here);
    diagnostics.in_file_order().iter().any(refused)
}

fn listed(keys: &[&str]) -> String {
    keys.iter().map(|k| format!("`{k}`")).collect::<Vec<_>>().join(", ")
}

fn example(key: &str) -> &'static str {
    match key {
        "seat_angle" => "makers' seats touch over 120 to 150 degrees: `seat_angle = \"135 deg\"`",
        "angle" => "`angle = \"45 deg\"`",
        "undercut" => "`undercut = \"90 deg\"`",
        _ => "`pressure_table = [[\"0 deg\", 1], [\"60 deg\", 0.5]]`",
    }
}
