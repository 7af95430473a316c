//! From what was typed to a design: references checked, catalogue values in place, SI numbers.

mod kind;
pub(crate) mod motion;
pub(crate) mod profile;
pub(crate) mod springs;

use std::sync::Arc;

use forcewright_base::diagnostics::{Diagnostic, Diagnostics, Span};
use forcewright_base::units::{Dimension, Quantity, Unit};
use forcewright_contract::catalogue::{Named, source_keys};
use forcewright_contract::describe::{Located, Origin, Section, Slot};
use forcewright_contract::metrics::Limit;

use crate::cut::{Cut, CutError, CutSide, Purpose, SIDES};
use crate::law::ForceLaw;
use crate::measured::{Measured as MeasuredProfile, RandomProfile, together};
use crate::mechanism::{Bodies, Mechanism, SpringMass};
use crate::motion::Motion;
use crate::parts::Making;
use crate::path::{Flaws, NormalError, SidePath};
use crate::release::Release;
use crate::spec::{self, Spec};
use crate::springs::{Bank, Spring};
use crate::study::Scatter;
pub(crate) use kind::of_disc;
use profile::{LawSlots, LawWords};

/// A design, ready to be analysed. SI units.
#[derive(Clone, Debug)]
pub struct Design {
    /// The project's title.
    pub title: String,
    /// What the cam was cut for.
    pub purpose: Purpose,
    /// Radius of the rollers for which it was cut, m.
    pub cut_roller_m: f64,
    /// The mechanism as it is built.
    pub built: Built,
    /// How the slider moves, where that is asked for.
    pub motion: Option<Motion>,
    /// What lets the slider go, where that is asked for.
    pub release: Option<Release>,
    /// How the parts are made.
    pub making: Making,
    /// Whether the slider is free to move sideways.
    pub free_guide: bool,
    /// Pitch of the screw that stretches the springs, m.
    pub adjust_pitch_m: Option<f64>,
    /// Materials of cam and roller.
    pub materials: [Option<Material>; 2],
    /// Friction that is there between roller and cam.
    pub friction: Option<f64>,
    /// What it must do; `None` if the project asks for nothing.
    pub requirements: Option<Requirements>,
    /// Where means are taken, from and to, m; by default the stroke without undercut.
    pub window_m: Option<[f64; 2]>,
    /// The numbers that have a `±`, for what each of them does.
    pub(crate) scatter: Option<Arc<Scatter>>,
    /// Units in which people are shown results.
    pub units: DisplayUnits,
}

/// The mechanism as it is built: what tolerances and errors change.
#[derive(Clone, Debug)]
pub struct Built {
    /// Right and left brace, m.
    pub brace_m: [f64; SIDES],
    /// Radius of the rollers, m.
    pub roller_m: f64,
    /// Arm of the rolling resistance, m.
    pub arm_m: f64,
    /// Thickness of the cam, m, if known.
    pub thickness_m: Option<f64>,
    /// The springs.
    pub springs: Vec<Spring>,
    /// Whether they are extension springs.
    pub extension: bool,
    /// Length beyond which they are over-extended, m.
    pub max_length_m: Option<f64>,
    /// Length below which they are solid, m.
    pub min_length_m: Option<f64>,
    /// Masses.
    pub bodies: Bodies,
    /// Against the travel, m/s².
    pub gravity_m_per_s2: f64,
    /// Angle between the travel and the axis of the cam, rad.
    pub tilt_rad: f64,
    /// Angle by which each profile is turned towards the axis, rad.
    pub turn_rad: [f64; SIDES],
    /// Shift of each profile outwards, m.
    pub offset_m: [f64; SIDES],
    /// Shift of both along the travel, m.
    pub height_m: f64,
    /// What was measured of the profiles.
    pub measured: Option<Arc<MeasuredProfile>>,
    /// A random error of the profiles.
    pub random: Option<RandomProfile>,
}

/// A material for the contact.
#[derive(Clone, Debug, PartialEq)]
pub struct Material {
    /// What it is called.
    pub name: String,
    /// Young's modulus, Pa.
    pub young_pa: Option<f64>,
    /// Poisson's ratio.
    pub poisson: Option<f64>,
    /// Yield stress, Pa.
    pub yield_pa: Option<f64>,
    /// Density, kg/m³.
    pub density_kg_per_m3: Option<f64>,
    /// Brinell hardness.
    pub brinell: Option<f64>,
    /// Keys of the works that catalogue values were taken from.
    pub sources: Vec<&'static str>,
}

/// What the mechanism must do, SI.
#[derive(Clone, Debug)]
pub struct Requirements {
    /// The force over the travel, and the half width of the band around it.
    pub force: Option<(ForceLaw, f64)>,
    /// Travel that is needed, m.
    pub stroke_m: Option<f64>,
    /// Largest hysteresis.
    pub hysteresis: Option<f64>,
    /// Limits on metrics.
    pub limits: Vec<Limit>,
}

/// Units in which people are shown results: those that they typed.
#[derive(Clone, Debug)]
pub struct DisplayUnits {
    /// Travel.
    pub travel: Unit,
    /// Lengths of the drawing.
    pub length: Unit,
    /// Forces.
    pub force: Unit,
    /// Torques.
    pub torque: Unit,
    /// Spring rates.
    pub stiffness: Unit,
    /// Angles.
    pub angle: Unit,
    /// Durations.
    pub time: Unit,
}

impl Design {
    /// Thickness of the cam, m: as given, or as it is drawn without.
    pub(crate) fn drawn_thickness_m(&self) -> f64 {
        self.built.thickness_m.unwrap_or(0.5 * self.cut_roller_m)
    }

    /// The cam's paths.
    ///
    /// # Errors
    /// [`CutError`] where there are none; for a design that was resolved there are.
    pub fn cut(&self) -> Result<Arc<Cut>, CutError> {
        Cut::new(self.purpose.clone()).map(Arc::new)
    }

    /// Whether a motion is asked for.
    pub fn moves(&self) -> bool {
        self.motion.is_some() || self.release.is_some()
    }

    /// The paths of both rollers as they were meant, on a cam that was cut.
    pub fn paths(&self, cut: &Arc<Cut>) -> [SidePath; SIDES] {
        SidePath::both(cut, self.cut_roller_m)
    }

    /// The mechanism on a cam that was cut.
    pub fn mechanism(&self, cut: &Arc<Cut>) -> Mechanism {
        self.mechanism_on(&self.paths(cut))
    }

    /// The same with the paths of that cam at hand: of another design with the same cam, they may have any flaws.
    pub fn mechanism_on(&self, paths: &[SidePath; SIDES]) -> Mechanism {
        let built = &self.built;
        let flaws = |side: usize| {
            let tilt = if side == 0 { built.tilt_rad } else { -built.tilt_rad };
            Flaws {
                turn_rad: built.turn_rad[side] + tilt,
                shift_m: [built.offset_m[side], built.height_m],
                swell_m: built.roller_m - self.cut_roller_m,
                error: built.profile_error(side, &paths[side]),
            }
        };
        Mechanism {
            paths: [0, 1].map(|side| paths[side].with(&flaws(side))),
            brace_m: built.brace_m,
            roller_m: built.roller_m,
            arm_m: built.arm_m,
            springs: Bank::new(built.springs.clone(), built.extension),
            bodies: built.bodies,
            gravity_m_per_s2: built.gravity_m_per_s2,
            rise_m: paths[0].cut().rise_m(),
        }
    }
}

impl Built {
    /// Whether nothing is turned, shifted or measured.
    pub(crate) fn is_as_meant(&self) -> bool {
        let all = [self.tilt_rad, self.height_m].into_iter().chain(self.turn_rad).chain(self.offset_m);
        all.into_iter().all(|error| error == 0.0) && self.measured.is_none() && self.random.is_none()
    }

    /// What the profile of a side deviates along its normal.
    fn profile_error(&self, side: usize, path: &SidePath) -> Option<Arc<dyn NormalError>> {
        let measured = self.measured.as_ref().and_then(|m| m.errors[side].clone()).map(|e| e as Arc<dyn NormalError>);
        together(measured, self.random.and_then(|r| r.along(side, path.length_m())))
    }
}

#[expect(clippy::ref_option, reason = "a slot as it stands in the description")]
pub(crate) fn si(slot: &Slot<Quantity>) -> Option<f64> {
    slot.as_ref().map(|l| l.value.si)
}

pub(crate) fn unit_or(slot: Option<&Located<Quantity>>, symbol: &str, dimension: Dimension) -> Unit {
    slot.map(|l| l.value.unit.clone()).or_else(|| Unit::parse(symbol).ok()).unwrap_or_else(|| Unit::si(dimension))
}

/// Reads a design from what was typed. Everything wrong goes into `diagnostics`.
pub(crate) fn resolve(spec: &mut Spec, diagnostics: &mut Diagnostics) -> Option<Design> {
    kind::of_slider(spec, diagnostics);
    let materials = materials_of(spec, diagnostics);
    let extension = spec.design.arrangement.as_ref().is_none_or(|a| a.value == "tension");
    let purpose = profile::purpose_of(spec, extension, diagnostics);
    let springs = springs::mounted(spec, diagnostics);
    let arm = rolling_arm(spec, diagnostics);
    let requirements = requirements_of(spec, diagnostics);
    let motion = motion::prescribed(spec, diagnostics);
    let release = motion::released(spec, diagnostics);
    if diagnostics.has_errors() {
        return None;
    }
    let (purpose, springs) = (purpose?, springs?);
    let cut = match Cut::new(purpose.clone()) {
        Ok(cut) => cut,
        Err(error) => {
            diagnostics.push(cannot_be_cut(&error, spec));
            return None;
        }
    };
    let window_m = window_of(spec, &purpose, diagnostics);
    let ends = motion.map(|m| [m.start_m, m.start_m + m.rise_m]).or(release.map(|r| [r.start_m; 2]));
    motion::check_ends(spec, &purpose, ends, diagnostics);
    let roller_m = 0.5 * si(&spec.design.roller_diameter)?;
    check_rollers(spec, &cut, roller_m, diagnostics);
    if diagnostics.has_errors() {
        return None;
    }
    let mut built = built_of(spec, springs, extension, (roller_m, arm?))?;
    built.measured = profile::measured_of(spec, &cut, roller_m, diagnostics);
    motion::check_mass(spec, &built, release.as_ref(), diagnostics);
    if diagnostics.has_errors() {
        return None;
    }
    Some(Design {
        title: spec.header.title.as_ref().map_or_else(|| "Cam mechanism".to_owned(), |t| t.value.clone()),
        purpose,
        cut_roller_m: roller_m,
        built,
        motion,
        release,
        making: making_of(spec, roller_m)?,
        free_guide: spec.motion.guide.as_ref().is_some_and(|g| g.value == "free"),
        adjust_pitch_m: si(&spec.design.springs.adjust.pitch),
        materials,
        friction: si(&spec.design.friction),
        requirements,
        window_m,
        scatter: Scatter::of(spec).map(Arc::new),
        units: display_units(spec),
    })
}

fn built_of(spec: &Spec, springs: Vec<Spring>, extension: bool, (roller_m, arm_m): (f64, f64)) -> Option<Built> {
    let (design, errors) = (&spec.design, &spec.errors);
    let brace = si(&design.brace_length)?;
    let sum = |both: &Slot<Quantity>, one: &Slot<Quantity>| si(both).unwrap_or(0.0) + si(one).unwrap_or(0.0);
    let mass = |slot: &Slot<Quantity>| si(slot).unwrap_or(0.0);
    let bodies = &design.bodies;
    Some(Built {
        brace_m: [brace; SIDES],
        roller_m,
        arm_m,
        thickness_m: si(&design.cam_thickness),
        springs,
        extension,
        max_length_m: si(&design.springs.max_length),
        min_length_m: si(&design.springs.min_length),
        bodies: Bodies {
            slider_kg: mass(&bodies.slider_mass),
            brace_kg: mass(&bodies.brace_mass),
            brace_kg_m2: mass(&bodies.brace_inertia),
            roller_kg: mass(&bodies.roller_mass),
            roller_kg_m2: mass(&bodies.roller_inertia),
            springs: match spec.model.spring_mass.as_ref().map(|m| m.value) {
                Some("halves") => SpringMass::Halves,
                _ => SpringMass::Bar,
            },
        },
        gravity_m_per_s2: si(&spec.environment.gravity).unwrap_or(0.0),
        tilt_rad: mass(&errors.tilt),
        turn_rad: [
            sum(&errors.profile_rotation, &errors.profile_rotation_right),
            sum(&errors.profile_rotation, &errors.profile_rotation_left),
        ],
        offset_m: [sum(&errors.profile_offset, &errors.profile_offset_right), sum(&errors.profile_offset, &errors.profile_offset_left)],
        height_m: mass(&errors.profile_height),
        measured: None,
        random: random_of(spec),
    })
}

fn making_of(spec: &Spec, roller_m: f64) -> Option<Making> {
    let parts = &spec.parts;
    let pin_m = si(&parts.pin_diameter).unwrap_or(0.5 * roller_m);
    Some(Making {
        chord_error_m: si(&parts.chord_error)?,
        base_m: si(&parts.base).unwrap_or(2.0 * roller_m),
        wall_m: si(&parts.wall).unwrap_or(2.0 * roller_m),
        pin_m,
        brace_width_m: si(&parts.brace_width).unwrap_or(2.5 * pin_m),
        brace_thickness_m: si(&parts.brace_thickness).unwrap_or(0.5 * pin_m),
        hole_m: si(&parts.hole),
    })
}

fn random_of(spec: &Spec) -> Option<RandomProfile> {
    let random = &spec.errors.random_profile;
    random.present.as_ref()?;
    Some(RandomProfile {
        deviation_m: si(&random.deviation)?,
        correlation_m: si(&random.correlation_length)?,
        seed: whole(si(&random.seed).unwrap_or(1.0)),
    })
}

/// A seed that was typed or drawn.
#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "whole, from 0 to 1e9")]
pub(crate) fn whole(seed: f64) -> u64 {
    seed.round().clamp(0.0, 1e9) as u64
}

/// Both keys say the same thing.
#[expect(clippy::ref_option, reason = "a slot as it stands in the description")]
pub(crate) fn exclude<A, B>(first: &Slot<A>, second: &Slot<B>, names: [&str; 2], diagnostics: &mut Diagnostics) {
    if let (Some(first), Some(second)) = (first, second) {
        diagnostics.push(
            Diagnostic::error("E0305", second.span, format!("`{}` and `{}` exclude each other", names[0], names[1]))
                .label("the second of two")
                .related(first.span, "the first")
                .help("keep one"),
        );
    }
}

pub(crate) fn missing(span: Span, what: &str, help: &str) -> Diagnostic {
    Diagnostic::error("E0302", span, format!("{what} is missing")).label("from this table").help(help)
}

pub(crate) fn place_of<T>(section: &Section<T>) -> Span {
    section.present.as_ref().map(|p| p.span).unwrap_or_default()
}

/// The arm of the rolling resistance, m; without one there is no friction.
pub(crate) fn rolling_arm(spec: &Spec, diagnostics: &mut Diagnostics) -> Option<f64> {
    let design = &spec.design;
    exclude(&design.rolling_arm, &design.rolling_friction, ["rolling_arm", "rolling_friction"], diagnostics);
    let radius = 0.5 * si(&design.roller_diameter)?;
    Some(si(&design.rolling_arm).or(si(&design.rolling_friction).map(|mu| mu * radius)).unwrap_or(0.0))
}

fn requirements_of(spec: &Spec, diagnostics: &mut Diagnostics) -> Option<Requirements> {
    let requirements = &spec.requirements;
    let wanted = Wanted {
        slots: LawSlots { level: &requirements.force.nominal, typed: &requirements.profile, file: &requirements.profile_file },
        words: &profile::FORCE,
        present: requirements.force.present.as_ref().map(|p| p.span),
        band: &requirements.force.band,
        total: &requirements.stroke,
        keys: ["force", "profile", "profile_file"],
        example: "50 N",
    };
    required(spec, &wanted, diagnostics)
}

/// What a kind of cam must do, as typed.
pub(crate) struct Wanted<'a> {
    pub slots: LawSlots<'a>,
    pub words: &'a LawWords,
    /// Where the table of level and band begins.
    pub present: Option<Span>,
    pub band: &'a Slot<Quantity>,
    /// Travel or turn that is needed.
    pub total: &'a Slot<Quantity>,
    /// Of the table, the profile and its file.
    pub keys: [&'static str; 3],
    /// A level.
    pub example: &'static str,
}

/// Requirements of either kind.
pub(crate) fn required(spec: &Spec, wanted: &Wanted<'_>, diagnostics: &mut Diagnostics) -> Option<Requirements> {
    spec.requirements.present.as_ref()?;
    let [table, key, file] = wanted.keys;
    let Wanted { slots, words, .. } = wanted;
    exclude(slots.typed, slots.file, [key, file], diagnostics);
    let profile = profile::law_of(slots.typed, slots.file, words, diagnostics);
    let given = slots.typed.is_some() || slots.file.is_some();
    if let (true, Some(nominal)) = (given, slots.level) {
        diagnostics.push(
            Diagnostic::error("E0305", nominal.span, "`nominal` and a profile exclude each other").label("one level").help("keep one"),
        );
    }
    let level = profile.or_else(|| slots.level.as_ref().map(|n| ForceLaw::constant(n.value.si)));
    let sound = !diagnostics.has_errors();
    let band = si(wanted.band);
    if let (true, Some(span), None) = (sound, wanted.present, &level) {
        let help = format!("give `nominal = \"{}\"`, or a `{key}` in `[requirements]`", wanted.example);
        diagnostics.push(missing(span, "`nominal`", &help));
    }
    if let (true, Some(located), None) = (sound, slots.typed, band) {
        let what = format!("how far the {table} may be from this profile");
        diagnostics.push(missing(located.span, &what, &format!("add `{table} = {{ band = \"2 %\" }}`")));
    }
    Some(Requirements {
        force: level.zip(band),
        stroke_m: si(wanted.total),
        hysteresis: si(&spec.requirements.hysteresis),
        limits: spec.requirements.limits.resolve(diagnostics),
    })
}

fn window_of(spec: &Spec, purpose: &Purpose, diagnostics: &mut Diagnostics) -> Option<[f64; 2]> {
    let words = ["the stroke", "the travel of the slider", "travel"];
    window_within(&spec.requirements.window, (&spec.design.stroke, purpose.stroke_m), words, diagnostics)
}

/// E0606: a window lies in the whole, which is called by the first word, in what the second says; the third is what it is made of.
#[expect(clippy::ref_option, reason = "slots as they stand in the description")]
pub(crate) fn window_within(
    window: &Slot<[Quantity; 2]>,
    (typed, whole): (&Slot<Quantity>, f64),
    [name, place, kind]: [&str; 3],
    diagnostics: &mut Diagnostics,
) -> Option<[f64; 2]> {
    let window = window.as_ref()?;
    let [from, to] = window.value.each_ref().map(|q| q.si);
    if from < to && to <= whole * (1.0 + 1e-9) {
        return Some([from, to.min(whole)]);
    }
    diagnostics.push(
        Diagnostic::error("E0606", window.span, format!("the window does not lie in {name}"))
            .label(format!("from and to, in {place}"))
            .help(format!("give a smaller and a larger {kind} up to {}", typed.as_ref().map_or_else(String::new, |s| s.value.to_string()))),
    );
    None
}

/// Rollers must find room beside the axis and beside each other.
fn check_rollers(spec: &Spec, cut: &Cut, roller_m: f64, diagnostics: &mut Diagnostics) {
    let [from, to] = cut.range_m();
    let reach = |side: usize, at: f64| cut.at(side, at).x.value();
    let least = [from, to].into_iter().flat_map(|at| [reach(0, at), reach(1, at)]).fold(f64::INFINITY, f64::min);
    if least < roller_m {
        let place = spec.design.roller_diameter.as_ref().map_or_else(Span::default, |r| r.span);
        diagnostics.push(
            Diagnostic::error("E0607", place, "the rollers run into each other")
                .label("where they come closest to the axis")
                .help("choose longer springs or smaller rollers, and with compression springs a shorter stroke"),
        );
    }
}

fn cannot_be_cut(error: &CutError, spec: &Spec) -> Diagnostic {
    let place = place_of(&spec.design.profile);
    let shown = |travel_m: &f64| {
        let unit = unit_or(spec.design.stroke.as_ref(), "mm", Dimension::Length);
        forcewright_base::units::format_si(*travel_m, &unit, 4)
    };
    match error {
        CutError::BraceTooShort { travel_m } => Diagnostic::error("E0601", place, "the path of a roller leaves the reach of its brace")
            .label("for this force and these springs")
            .help(format!("it does not beyond a stroke of {}; choose longer braces, stiffer springs or a shorter stroke", shown(travel_m))),
        CutError::Locks { travel_m } => Diagnostic::error("E0602", place, "with the friction that is compensated the rollers lock")
            .label("for this force and these springs")
            .help(format!("they do from a travel of {} on; compensate less friction, or shorten the stroke", shown(travel_m))),
        CutError::SpringsGiveNoForce { travel_m } => Diagnostic::error("E0603", place, "these springs cannot do the work that is asked for")
            .label("for this force and these springs")
            .help(format!(
                "at a travel of {} they give no force: their length at the start must be at least the rest length (at most, with compression springs)",
                shown(travel_m)
            )),
    }
}

fn display_units(spec: &Spec) -> DisplayUnits {
    let design = &spec.design;
    let force = spec.requirements.force.nominal.as_ref().or(design.profile.for_force.as_ref());
    let rate = design.profile.for_rate.as_ref().or(design.springs.rate.as_ref());
    DisplayUnits {
        travel: unit_or(design.stroke.as_ref(), "mm", Dimension::Length),
        length: unit_or(design.brace_length.as_ref(), "mm", Dimension::Length),
        force: unit_or(force, "N", Dimension::Force),
        torque: unit_or(None, "N*m", Dimension::Torque),
        stiffness: unit_or(rate, "N/mm", Dimension::Stiffness),
        angle: unit_or(spec.errors.tilt.as_ref().filter(|t| t.origin == Origin::File), "deg", Dimension::Angle),
        time: unit_or(spec.motion.duration.as_ref(), "s", Dimension::Time),
    }
}

/// Materials of cam and roller, filled from the catalogue.
pub(crate) fn materials_of(spec: &mut Spec, diagnostics: &mut Diagnostics) -> [Option<Material>; 2] {
    let spec::Materials { cam, roller } = &mut spec.material.body;
    [cam, roller].map(|section| {
        section.present.as_ref()?;
        Some(fill(&mut section.body, diagnostics))
    })
}

fn fill(material: &mut spec::Material, diagnostics: &mut Diagnostics) -> Material {
    let named = material.catalogue.as_ref().and_then(|name| Named::find(name, diagnostics));
    let mut sources = Vec::new();
    if let Some(named) = named {
        let entry = named.entry;
        named.fill(&mut material.young_modulus, entry.young_modulus_pa.as_ref(), "GPa");
        named.fill(&mut material.poisson_ratio, entry.poisson_ratio.as_ref(), "");
        named.fill(&mut material.yield_stress, entry.yield_stress_pa.as_ref(), "MPa");
        named.fill(&mut material.density, entry.density_kg_per_m3.as_ref(), "kg/m^3");
        sources = source_keys([
            (&material.young_modulus, entry.young_modulus_pa.as_ref()),
            (&material.poisson_ratio, entry.poisson_ratio.as_ref()),
            (&material.yield_stress, entry.yield_stress_pa.as_ref()),
            (&material.density, entry.density_kg_per_m3.as_ref()),
        ]);
    }
    Material {
        name: named.map_or_else(|| "given by its values".to_owned(), |n| n.entry.name.clone()),
        young_pa: si(&material.young_modulus),
        poisson: si(&material.poisson_ratio),
        yield_pa: si(&material.yield_stress),
        density_kg_per_m3: si(&material.density),
        brinell: si(&material.brinell),
        sources,
    }
}

/// One side of a cut.
fn cut_sides(spec: &Spec) -> Option<[CutSide; SIDES]> {
    let brace = si(&spec.design.brace_length)?;
    let share = si(&spec.design.profile.share_right)?;
    Some([CutSide { brace_m: brace, share }, CutSide { brace_m: brace, share: 1.0 - share }])
}
