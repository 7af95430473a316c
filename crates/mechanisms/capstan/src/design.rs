//! From what was typed to a drive: references checked, catalogue values in place, SI numbers.

pub(crate) mod cables;
mod groove;

use std::f64::consts::TAU;

use forcewright_base::diagnostics::{Diagnostic, Diagnostics, Span};
use forcewright_base::maths;
use forcewright_base::units::{Dimension, Quantity, Unit, format_number, format_si};
use forcewright_contract::describe::{Located, Origin, Section, Slot};
use forcewright_contract::metrics::Limit;
use forcewright_elements::grooves::Groove;

use crate::geometry::{Belt, Drive, GeometryError, Hand, Layout, Setting, Surface};
use crate::spec::Spec;
use crate::statics::{Place, Statics};
use crate::whole::few;

pub use cables::Cable;
pub use groove::Seat;

/// A cable drive, ready to be analysed. SI units.
#[derive(Clone, Debug)]
pub struct Design {
    /// The project's title.
    pub title: String,
    /// The drive as it is built.
    pub built: Built,
    /// What diameters of drums in the file lack to the middle of the cable, m.
    pub added_m: f64,
    /// Model of the statics.
    pub source: Source,
    /// How the drums are made.
    pub making: Making,
    /// What it must do; `None` if the project asks for nothing.
    pub requirements: Option<Requirements>,
    /// Units in which people are shown results.
    pub units: DisplayUnits,
}

/// Which statics.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Source {
    /// Both sides of a cable share one displacement.
    Corrected,
    /// Both change their tension by the same amount.
    Paper,
}

/// The drive as it is built: what tolerances change.
#[derive(Clone, Debug)]
pub struct Built {
    /// Radii of input and output drum to the middle of the cable, m.
    pub radii_m: [f64; 2],
    /// Distance of the axes, m.
    pub distance_m: f64,
    /// How the spans run.
    pub belt: Belt,
    /// Whole turns on the input beyond one.
    pub extra_turns: u32,
    /// Turn of the output over its travel, rad.
    pub travel_rad: f64,
    /// Of the helix on the input.
    pub hand: Hand,
    /// Distance of turns on the input drum, m.
    pub pitch_m: f64,
    /// Helices on the output.
    pub starts: u32,
    /// Turn of the second group of output grooves, rad.
    pub phase_rad: f64,
    /// Wrap that stays before each termination, rad.
    pub guard_rad: f64,
    /// How the input drum is set against the output drum.
    pub setting: Setting,
    /// Section of the grooves.
    pub seat: Seat,
    /// Effective over plain friction, by the groove.
    pub groove_factor: f64,
    /// Plain friction.
    pub friction: f64,
    /// Whether the cables are pinned to the input drum.
    pub fastened: bool,
    /// Whether statics are those of the helix.
    pub helix_correction: bool,
    /// The cables, of one diameter.
    pub cables: Vec<Cable>,
    /// What the shafts turn in.
    pub bearings: Bearings,
    /// Moments of inertia of input and output, kg·m².
    pub inertia_kg_m2: [Option<f64>; 2],
    /// Warmer than at assembly by, K.
    pub warmer_k: f64,
    /// Expansion of drums and frame, 1/K.
    pub expansion_per_k: Option<f64>,
}

/// What the shafts turn in.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Bearings {
    /// `μ_b`.
    pub friction: Option<f64>,
    /// Bores of input and output, m.
    pub bores_m: [Option<f64>; 2],
    /// Torques without load, N·m.
    pub drags_nm: [f64; 2],
}

/// How the drums are made, SI.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Making {
    /// Drum beyond the outermost groove line, m.
    pub margin_m: f64,
    /// Cable beyond each termination, m.
    pub anchor_m: f64,
    /// Holes through input and output drum, m.
    pub bores_m: [Option<f64>; 2],
    /// Holes for the anchors, m.
    pub hole_m: f64,
    /// Least wall that the process leaves, m, and whether the project says so.
    pub least_wall: (f64, bool),
    /// By how much printed grooves are wider, m.
    pub clearance_m: Option<f64>,
    /// Of the drums, kg/m³.
    pub density_kg_per_m3: Option<f64>,
}

/// What the drive must do, SI.
#[derive(Clone, Debug)]
pub struct Requirements {
    /// At the output, N·m.
    pub torque_nm: f64,
    /// Tangent stiffness at the output, N·m/rad.
    pub stiffness_nm_per_rad: Option<f64>,
    /// Full width, rad.
    pub lost_motion_rad: Option<f64>,
    /// Breaking force over tension.
    pub safety_factor: Option<f64>,
    /// Limits on metrics.
    pub limits: Vec<Limit>,
}

/// Units in which people are shown results: those that they typed.
#[derive(Clone, Debug)]
pub struct DisplayUnits {
    /// Diameters and distances.
    pub length: Unit,
    /// Tensions.
    pub force: Unit,
    /// Torques.
    pub torque: Unit,
    /// Stiffness of a shaft.
    pub stiffness: Unit,
    /// Travel and wraps.
    pub angle: Unit,
    /// Lost motion and twist.
    pub small_angle: Unit,
}

/// Least wall where the project has no `[parts]`, m: as described there.
const LEAST_WALL_M: f64 = 0.2e-3;
/// In place of no wrap at all, rad.
const LEAST_WRAP_RAD: f64 = 1e-9;

impl Built {
    /// Where the cables lie.
    ///
    /// # Errors
    /// [`GeometryError`] where there is no such drive.
    pub fn geometry(&self) -> Result<Drive, GeometryError> {
        Drive::new(self.layout())
    }

    /// What the geometry is built from.
    pub fn layout(&self) -> Layout {
        Layout {
            input_radius_m: self.radii_m[0],
            output_radius_m: self.radii_m[1],
            centre_distance_m: self.distance_m,
            belt: self.belt,
            pitch_m: self.pitch_m,
            hand: self.hand,
            starts: self.starts,
            extra_turns: self.extra_turns,
            second_phase_rad: self.phase_rad,
            travel_rad: self.travel_rad,
            guard_rad: [self.guard_rad; 2],
            rope_diameter_m: self.cable_m(),
            surface: if self.seat.groove == Groove::Flat { Surface::Flat } else { Surface::Grooved },
            setting: self.setting,
            cables: self.cables.iter().map(|c| c.lines).collect(),
        }
    }

    /// Nominal diameter of the cables, m.
    pub fn cable_m(&self) -> f64 {
        self.cables.first().map_or(0.0, |c| c.diameter_m)
    }

    /// What statics need at an angle of the output, rad from 0 to the travel. As it grows, end 0 winds up on the output; a pin on the input
    /// turns towards the span of that end, `R` times as fast: `Θ/2 ± R(τ/2 − α)` of its wrap are left on either side.
    pub fn place(&self, geometry: &Drive, output_rad: f64) -> Place {
        let helix_rad = geometry.helix_angle_rad();
        let span_m = geometry.free_span_m();
        let half_rad = 0.5 * geometry.input_wrap_rad();
        let turned_rad = if self.fastened { self.ratio() * (0.5 * self.travel_rad - output_rad) } else { 0.0 };
        // Without a guard nothing is wrapped at an end; a wrap must have some angle.
        let output_wraps_rad = [output_rad, self.travel_rad - output_rad].map(|rad| (self.guard_rad + rad).max(LEAST_WRAP_RAD));
        Place {
            span_m: if self.helix_correction { span_m / maths::cos(helix_rad) } else { span_m },
            helix_rad,
            input_wraps_rad: [half_rad + turned_rad, half_rad - turned_rad],
            output_wraps_rad: vec![output_wraps_rad; self.cables.len()],
        }
    }

    /// Angle of the output in the middle of the travel, rad.
    pub fn middle_rad(&self) -> f64 {
        0.5 * self.travel_rad
    }

    /// Wrap between a pin on the input and the nearer span at an end of the travel, rad; not above 0 where the travel unwinds it.
    pub fn least_pin_wrap_rad(&self, geometry: &Drive) -> f64 {
        0.5 * (geometry.input_wrap_rad() - self.ratio() * self.travel_rad)
    }

    /// How far lands stand above the surface of the cable, m; 0 where they do not.
    pub fn land_m(&self) -> f64 {
        (self.seat.depth_for_m(self.cable_m()) - self.cable_m()).max(0.0)
    }

    /// Gap between the drums on the line of centres, to the surface of the cables or of the lands, m.
    pub fn gap_m(&self) -> f64 {
        self.distance_m - self.radii_m[0] - self.radii_m[1] - self.cable_m() - 2.0 * self.land_m()
    }

    /// Turns of the input over turns of the output.
    pub fn ratio(&self) -> f64 {
        self.radii_m[1] / self.radii_m[0]
    }
}

#[expect(clippy::ref_option, reason = "a slot as it stands in the description")]
pub(crate) fn si(slot: &Slot<Quantity>) -> Option<f64> {
    slot.as_ref().map(|l| l.value.si)
}

fn unit_or(slot: Option<&Located<Quantity>>, symbol: &str, dimension: Dimension) -> Unit {
    let typed = slot.filter(|l| l.origin == Origin::File).map(|l| l.value.unit.clone());
    typed.or_else(|| Unit::parse(symbol).ok()).unwrap_or_else(|| Unit::si(dimension))
}

fn place_of<T>(section: &Section<T>) -> Span {
    section.present.as_ref().map(|p| p.span).unwrap_or_default()
}

fn span_of<T>(slot: Option<&Located<T>>, spec: &Spec) -> Span {
    slot.map_or_else(|| place_of(&spec.design), |l| l.span)
}

/// Reads a drive from what was typed. Everything wrong goes into `diagnostics`.
pub(crate) fn resolve(spec: &mut Spec, diagnostics: &mut Diagnostics) -> Option<Design> {
    let cables = cables::cables_of(spec, diagnostics);
    let seat = groove::seat_of(spec, diagnostics);
    let requirements = requirements_of(spec, diagnostics);
    if diagnostics.has_errors() {
        return None;
    }
    let (seat, cables) = (seat?, cables?);
    let mut built = built_of(spec, seat, cables)?;
    cables::place_lines(spec, &mut built, diagnostics);
    let source = if spec.model.source.as_ref().is_some_and(|s| s.value == "paper") { Source::Paper } else { Source::Corrected };
    check(spec, &built, source, diagnostics);
    if diagnostics.has_errors() {
        return None;
    }
    let cable_m = built.cable_m();
    let parts = &spec.parts;
    Some(Design {
        title: spec.header.title.as_ref().map_or_else(|| "Cable drive".to_owned(), |t| t.value.clone()),
        making: Making {
            margin_m: si(&parts.margin).unwrap_or(built.pitch_m),
            anchor_m: si(&parts.anchor_length).unwrap_or(20.0 * cable_m),
            bores_m: [si(&parts.input_bore), si(&parts.output_bore)],
            hole_m: si(&parts.anchor_hole).unwrap_or(1.2 * cable_m),
            least_wall: parts.least_wall.as_ref().map_or((LEAST_WALL_M, false), |l| (l.value.si, l.origin == Origin::File)),
            clearance_m: si(&parts.print_clearance),
            density_kg_per_m3: si(&parts.density),
        },
        added_m: if spec.design.diameters.as_ref().is_none_or(|d| d.value == "drum") { cable_m } else { 0.0 },
        built,
        source,
        requirements,
        units: display_units(spec),
    })
}

fn built_of(spec: &Spec, seat: Seat, cables: Vec<Cable>) -> Option<Built> {
    let design = &spec.design;
    let cable_m = cables.first().map_or(0.0, |c| c.diameter_m);
    // Diameters of the drum end where the cable begins.
    let added_m = if design.diameters.as_ref().is_some_and(|d| d.value == "rope centre") { 0.0 } else { cable_m };
    let radii_m = [0.5 * (si(&design.input_diameter)? + added_m), 0.5 * (si(&design.output_diameter)? + added_m)];
    let nearest = few((radii_m[1] / radii_m[0]).clamp(1.0, 64.0));
    let bearings = &design.bearings;
    Some(Built {
        radii_m,
        distance_m: si(&design.centre_distance)?,
        belt: if design.belt.as_ref().is_some_and(|b| b.value == "open") { Belt::Open } else { Belt::Crossed },
        extra_turns: design.extra_turns.as_ref()?.value,
        travel_rad: si(&design.travel)?,
        hand: if design.hand.as_ref().is_some_and(|h| h.value == "left") { Hand::Left } else { Hand::Right },
        pitch_m: si(&design.groove.pitch)?,
        starts: design.starts.as_ref().map_or(nearest, |s| s.value),
        phase_rad: si(&design.groove_phase).unwrap_or(0.0),
        guard_rad: si(&design.output_anchor_wrap)?,
        setting: if design.input_setting.as_ref().is_some_and(|s| s.value == "outgoing") { Setting::Outgoing } else { Setting::Shared },
        groove_factor: seat.friction_factor(),
        seat,
        friction: si(&design.friction)?,
        fastened: design.input_hold.as_ref().is_some_and(|h| h.value == "fastened"),
        helix_correction: spec.model.helix_correction.as_ref().is_none_or(|h| h.value),
        cables,
        bearings: Bearings {
            friction: si(&bearings.friction),
            bores_m: [si(&bearings.input_bore), si(&bearings.output_bore)],
            drags_nm: [si(&bearings.input_drag).unwrap_or(0.0), si(&bearings.output_drag).unwrap_or(0.0)],
        },
        inertia_kg_m2: [si(&spec.inertia.input), si(&spec.inertia.output)],
        warmer_k: si(&spec.environment.temperature_change).unwrap_or(0.0),
        expansion_per_k: si(&design.expansion),
    })
}

fn requirements_of(spec: &Spec, diagnostics: &mut Diagnostics) -> Option<Requirements> {
    spec.requirements.present.as_ref()?;
    let requirements = &spec.requirements;
    let limits = requirements.limits.resolve(diagnostics);
    Some(Requirements {
        torque_nm: si(&requirements.torque)?,
        stiffness_nm_per_rad: si(&requirements.stiffness.min),
        lost_motion_rad: si(&requirements.lost_motion.max),
        safety_factor: si(&requirements.safety_factor),
        limits,
    })
}

/// E0701, E0702, E0705 to E0707: what the numbers give together is a drive.
fn check(spec: &Spec, built: &Built, source: Source, diagnostics: &mut Diagnostics) {
    let geometry = match built.geometry() {
        Ok(geometry) => geometry,
        Err(error) => {
            diagnostics.push(no_geometry(&error, spec, built));
            return;
        }
    };
    if built.warmer_k != 0.0 && (built.expansion_per_k.is_none() || built.cables.iter().any(|c| c.expansion_per_k.is_none())) {
        let at = span_of(spec.environment.temperature_change.as_ref(), spec);
        diagnostics.push(
            Diagnostic::error("E0706", at, "what the change of temperature does to the preload is not known")
                .label("this change")
                .help("give `design.expansion` of drums and frame, about 23e-6 1/K for aluminium, and `expansion` of the cables, about 12e-6 1/K for carbon steel"),
        );
        return;
    }
    for (index, cable) in built.cables.iter().enumerate() {
        if cable.preload_left_n(built) <= 0.0 {
            let at = spec.design.cables.get(index).map_or_else(|| place_of(&spec.design), |c| span_of(c.value.preload.as_ref(), spec));
            let left = format_si(cable.preload_left_n(built), &Unit::si(Dimension::Force), 3);
            diagnostics.push(
                Diagnostic::error("E0706", at, format!("nothing is left of the preload: {left}"))
                    .label("after bedding in and at the temperature given")
                    .help("raise the preload"),
            );
            return;
        }
    }
    let first = &built.cables[0];
    let same = |a: f64, b: f64| a.to_bits() == b.to_bits();
    let equal = built
        .cables
        .iter()
        .all(|c| same(c.axial_stiffness_n, first.axial_stiffness_n) && same(c.preload_left_n(built), first.preload_left_n(built)));
    if source == Source::Paper && !equal {
        let at = span_of(spec.model.source.as_ref(), spec);
        diagnostics.push(
            Diagnostic::error("E0705", at, "the paper's model has no cables of different preload or stiffness")
                .label("this model")
                .help("use `source = \"corrected\"`, or make the cables equal"),
        );
    }
    let deepest_m = built.distance_m - built.radii_m[0] - built.radii_m[1] + built.cable_m();
    if built.seat.depth_m.is_some_and(|depth_m| depth_m >= deepest_m) {
        let at = span_of(spec.design.groove.depth.as_ref(), spec);
        let length = format_si(0.9995 * deepest_m, &unit_or(spec.design.groove.depth.as_ref(), "mm", Dimension::Length), 4);
        let error = Diagnostic::error("E0702", at, "the lands of one drum reach the bottom of the grooves of the other");
        diagnostics.push(
            error
                .label("this depth")
                .help(format!("at this centre distance less than {length}; what the seat needs is taken without `depth`")),
        );
        return;
    }
    if built.fastened && built.least_pin_wrap_rad(&geometry) <= 0.0 {
        diagnostics.push(unwinds(&geometry, spec, built));
        return;
    }
    if let Err(error) = Statics::new(built, &built.place(&geometry, built.middle_rad()), source) {
        diagnostics.push(
            Diagnostic::error("E0701", place_of(&spec.design), format!("the cables cannot be computed: {error}"))
                .label("this drive")
                .help("look for a number that is much too small or too large"),
        );
    }
}

/// E0707: the travel unwinds a fastened cable down to its pin.
fn unwinds(geometry: &Drive, spec: &Spec, built: &Built) -> Diagnostic {
    let angle = |rad: f64| format_si(rad, &unit_or(spec.design.travel.as_ref(), "deg", Dimension::Angle), 4);
    let (wrap_rad, turned_rad) = (geometry.input_wrap_rad(), built.ratio() * built.travel_rad);
    let more = ((turned_rad - wrap_rad) / TAU).floor() + 1.0;
    Diagnostic::error(
        "E0707",
        span_of(spec.design.travel.as_ref(), spec),
        "the travel unwinds the cable from the input drum down to its pin",
    )
    .label(format!("the input turns by {}, the wrap is {}", angle(turned_rad), angle(wrap_rad)))
    .help(format!(
        "a pin in the middle of the wrap allows a travel below {}; or `extra_turns = {}`, or `input_hold = \"friction\"`",
        angle(wrap_rad / built.ratio()),
        few(f64::from(built.extra_turns) + more)
    ))
}

fn no_geometry(error: &GeometryError, spec: &Spec, built: &Built) -> Diagnostic {
    let length = |m: f64| format_si(m, &unit_or(spec.design.centre_distance.as_ref(), "mm", Dimension::Length), 4);
    match error {
        GeometryError::DrumsOverlap { above_m, .. } => {
            let at = span_of(spec.design.centre_distance.as_ref(), spec);
            Diagnostic::error("E0701", at, "the drums overlap").label("this distance of the axes").help(format!(
                "the radii to the middle of the cable add up to {}: choose a larger distance, or smaller drums",
                length(*above_m)
            ))
        }
        GeometryError::Lines { cable, off_lines, nearest } => {
            let typed = spec.design.cables.get(*cable).and_then(|c| c.value.lines.as_ref());
            let first = built.cables.get(*cable).map_or(0, |c| c.lines[0]);
            Diagnostic::error("E0704", span_of(typed, spec), "the cable does not come back to this groove line")
                .label(format!("it lands {} lines from the second", format_number(off_lines.abs(), 3)))
                .help(format!("the line next to where it lands: `lines = [{first}, {nearest}]`"))
        }
        other => {
            let at = place_of(&spec.design);
            Diagnostic::error("E0701", at, format!("there is no such drive: {other}")).label("this drive").help("change the number named")
        }
    }
}

fn display_units(spec: &Spec) -> DisplayUnits {
    let design = &spec.design;
    let requirements = &spec.requirements;
    let preload = design.cables.first().and_then(|c| c.value.preload.as_ref());
    DisplayUnits {
        length: unit_or(design.centre_distance.as_ref(), "mm", Dimension::Length),
        force: unit_or(preload, "N", Dimension::Force),
        torque: unit_or(requirements.torque.as_ref(), "N*m", Dimension::Torque),
        stiffness: unit_or(requirements.stiffness.min.as_ref(), "N*m/rad", Dimension::RotationalStiffness),
        angle: unit_or(design.travel.as_ref(), "deg", Dimension::Angle),
        small_angle: unit_or(requirements.lost_motion.max.as_ref(), "deg", Dimension::Angle),
    }
}
