//! What a stage does with the mechanism: it carries it sideways along a surface (section IV of the paper), or moves its tip sideways while
//! that is pushed.

mod keys;
pub(crate) mod lateral;
mod path;
mod profile;
mod results;
mod run;

use forcewright_base::diagnostics::{Diagnostic, Diagnostics, Span};
use forcewright_base::units::Dimension;
use forcewright_beam::{Network, Rotation, Support};
use forcewright_contract::data::{self, Column};
use forcewright_contract::describe::{Located, Slot};

use crate::design::si;
use crate::loads::{Control, Loads};
use crate::spec::Spec;

pub(crate) use keys::Scenario;
pub use lateral::{Lateral, LateralMap, Row, Shortfall, Summary, TipState};
pub use path::{TipPath, Touch};
pub use profile::{Join, Profile};
pub(crate) use results::{curves, figures, fix, limits, missing, model, never_ends, sources, status, warnings};
pub use run::{Contact, Flat, Pass, Stop, SurfaceRun, Why};

/// Most rows of a profile from a file.
const MOST_ROWS: usize = 2000;

/// A surface, and the tip that is drawn along it. SI.
#[derive(Clone, Debug)]
pub struct Surface {
    /// Where the tip goes.
    pub path: TipPath,
    /// Displacement Δ of the mechanism where the height is zero, m.
    pub preload_m: f64,
    /// Coulomb coefficient of the bearings.
    pub guide_friction: f64,
    /// Sum of the normal forces of the bearings over the transverse force: 1 + 2a/b of two bearings at a distance b, the tip a beyond.
    pub guide_load: f64,
    /// Coulomb coefficient between tip and surface.
    pub tip_friction: f64,
    /// Whether the stage comes back.
    pub there_and_back: bool,
}

impl Surface {
    /// The friction of the guide per transverse force: the coefficient times the load of its bearings.
    pub fn guide_drag(&self) -> f64 {
        self.guide_friction * self.guide_load
    }

    /// The steepest rise that the tip climbs, as a slope: (1 − m·μ)/(m + μ) with the drag m of the guide and the friction μ of the tip;
    /// infinite without friction.
    pub fn locking_slope(&self) -> f64 {
        let (guide, tip) = (self.guide_drag(), self.tip_friction);
        if guide + tip > 0.0 { (1.0 - guide * tip) / (guide + tip) } else { f64::INFINITY }
    }
}

/// The surface of a project, if it has one. Faults are reported.
pub(crate) fn resolve(spec: &Spec, network: &Network, loads: &Loads, diagnostics: &mut Diagnostics) -> Option<Surface> {
    check_given(spec, diagnostics);
    let typed = &spec.scenario.surface;
    let place = typed.present.as_ref()?.span;
    check_drive(network, loads, place, diagnostics);
    let points = points(typed, place, diagnostics)?;
    let join = if typed.join.as_ref().is_some_and(|j| j.value == "smooth") { Join::Smooth } else { Join::Linear };
    let profile = profile_of(&points, place, join, diagnostics)?;
    let guide_load = guide_load(typed, diagnostics)?;
    let or_zero = |slot: &Slot<_>| si(slot.as_ref()).unwrap_or(0.0);
    Some(Surface {
        path: TipPath::new(profile, or_zero(&typed.tip_radius)),
        preload_m: si(typed.preload.as_ref())?,
        guide_friction: or_zero(&typed.guide_friction),
        guide_load,
        tip_friction: or_zero(&typed.tip_friction),
        there_and_back: typed.there_and_back.as_ref().is_some_and(|f| f.value),
    })
}

/// A scenario without anything in it is a slip.
fn check_given(spec: &Spec, diagnostics: &mut Diagnostics) {
    let scenario = &spec.scenario;
    let nothing = scenario.surface.present.is_none() && scenario.lateral.present.is_none();
    // A table that was given but not understood has been reported.
    if let Some(present) = scenario.present.as_ref().filter(|_| nothing && !diagnostics.has_errors()) {
        diagnostics.push(
            Diagnostic::error("E0302", present.span, "nothing happens: `scenario` is empty")
                .label("what does a robot do with it?")
                .help("describe `[scenario.surface]` or `[scenario.lateral]`"),
        );
    }
}

/// The scenario takes the force from a curve over a prescribed displacement from rest, of a block that its bearings guide along it.
fn check_drive(network: &Network, loads: &Loads, place: Span, diagnostics: &mut Diagnostics) {
    let mut refuse = |message: &str, help: String| {
        diagnostics.push(Diagnostic::error("E0521", place, message).label("this scenario").help(help));
    };
    if loads.control != Control::Travel || !loads.before.is_empty() {
        let help = "give `travel` instead of `force`, and no load before it; `preload` says where on the curve the tip begins".to_owned();
        refuse("a surface needs one load that prescribes a displacement", help);
        return;
    }
    let [dx, dy] = loads.direction;
    let support = network.nodes.get(loads.drive.node()).map(|n| &n.support);
    let guided =
        matches!(support, Some(Support::Slider { direction: [x, y], rotation: Rotation::Fixed }) if (x * dy - y * dx).abs() < 1e-9);
    if !guided {
        let show = |v: f64| forcewright_base::units::format_number(v, 4);
        let help = format!("hold the load node by `support = \"slider\"` with `direction = [{}, {}]`", show(dx), show(dy));
        refuse("the bearings of the tip guide the block along the load without turning; the load node is not held so", help);
    }
}

/// A point of the surface as typed: position and height, m, and where it stands.
type Typed = (f64, f64, Span);

fn points(typed: &keys::Surface, place: Span, diagnostics: &mut Diagnostics) -> Option<Vec<Typed>> {
    match (&typed.profile, &typed.profile_file) {
        (Some(own), Some(file)) => {
            diagnostics.push(
                Diagnostic::error("E0305", own.span, "`profile` and `profile_file` exclude each other")
                    .label("one of two")
                    .related(file.span, "the other")
                    .help("keep one of them"),
            );
            None
        }
        (Some(own), None) => Some(own.value.iter().map(|p| (p.value[0].si, p.value[1].si, p.span)).collect()),
        (None, Some(file)) => {
            let column = |name| Column { name, dimension: Dimension::Length };
            let rows = data::rows(&file.value, &[column("position"), column("height")], MOST_ROWS, diagnostics)?;
            Some(rows.into_iter().map(|[x, z]| (x.si, z.si, x.span)).collect())
        }
        (None, None) => {
            // A value that was given but not understood has been reported.
            if !diagnostics.has_errors() {
                diagnostics.push(
                    Diagnostic::error("E0302", place, "`surface` has no profile")
                        .label("of which shape?")
                        .help("give `profile_file = \"bump.csv\"`, or `profile = [[\"0 mm\", \"0 mm\"], [\"10 mm\", \"3 mm\"]]`"),
                );
            }
            None
        }
    }
}

/// Largest position and height, m.
const LARGEST_M: f64 = 100.0;
/// Steeper than this, a rise is a step.
const STEEPEST: f64 = 1e6;

fn profile_of(points: &[Typed], place: Span, join: Join, diagnostics: &mut Diagnostics) -> Option<Profile> {
    let before = diagnostics.errors();
    let mut refuse = |span: Span, message: &str, label: &str, help: &str| {
        diagnostics.push(Diagnostic::error("E0520", span, message).label(label).help(help));
    };
    if points.len() < 2 {
        refuse(
            points.first().map_or(place, |p| p.2),
            "a surface has at least two points",
            "too few",
            "give positions and heights in ascending order of the positions",
        );
    }
    for (x, z, span) in points {
        if !(x.abs() <= LARGEST_M && z.abs() <= LARGEST_M) {
            refuse(*span, "a position or a height of more than 100 m", "out of range", "check the unit");
        }
    }
    for pair in points.windows(2) {
        let [(x0, z0, _), (x1, z1, span)] = pair else { continue };
        if x1.total_cmp(x0).is_lt() {
            refuse(
                *span,
                "positions go back",
                "before the position above it",
                "sort the points by their positions; `return = true` brings the tip back",
            );
        } else if (z1 - z0).abs() >= STEEPEST * (x1 - x0) {
            refuse(
                *span,
                "a vertical step, or a position twice",
                "at the position of the point above it",
                "give each position once; no tip climbs a vertical step: write the slope that it has",
            );
        }
    }
    (diagnostics.errors() == before).then(|| Profile::new(points.iter().map(|p| p.0).collect(), points.iter().map(|p| p.1).collect(), join))
}

/// Two bearings at a distance b carry a side load T at a distance a beyond the nearer one by T(1 + a/b) and T·a/b.
fn guide_load(typed: &keys::Surface, diagnostics: &mut Diagnostics) -> Option<f64> {
    let mut lonely = |given: &Located<_>, what: &str, other: &str| {
        diagnostics.push(
            Diagnostic::error("E0302", given.span, format!("`{what}` alone says nothing: the load of the bearings follows from both"))
                .label("one of two")
                .help(format!("give `{other}` too, or leave out both: the bearings then carry the transverse force without a couple")),
        );
        None
    };
    match (&typed.overhang, &typed.guide_span) {
        (None, None) => Some(1.0),
        (Some(overhang), Some(span)) => Some(1.0 + 2.0 * overhang.value.si / span.value.si),
        (Some(overhang), None) => lonely(overhang, "overhang", "guide_span"),
        (None, Some(span)) => lonely(span, "guide_span", "overhang"),
    }
}
