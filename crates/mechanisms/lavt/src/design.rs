//! From what was typed to a transmission: references checked, catalogue values in place, SI numbers.

mod material;
mod outside;

use std::sync::Arc;

use forcewright_base::diagnostics::{Diagnostic, Diagnostics, Span};
use forcewright_base::units::{Dimension, Quantity, Unit, format_number, format_si};
use forcewright_contract::describe::{Located, Origin, Section, Slot};
use forcewright_contract::metrics::{Limit, check_order};
use forcewright_elements::gears::Rack;

use crate::bench::{Bench, bench_of};
use crate::spec::{self, Spec};

pub use material::{GearMaterial, WireMaterial};
pub use outside::{Battery, Hand, Lever, Motor};

/// A two-speed transmission, ready to be analysed. SI units.
#[derive(Clone, Debug)]
pub struct Design {
    /// The project's title.
    pub title: String,
    /// The transmission as it is built.
    pub built: Built,
    /// Ends of what scatters.
    pub scatter: Scatter,
    /// Model of the clutch.
    pub source: Source,
    /// What it must do; `None` if the project asks for nothing.
    pub requirements: Option<Requirements>,
    /// Wire of the spring.
    pub wire: WireMaterial,
    /// Material of the gears.
    pub gear_material: Option<GearMaterial>,
    /// What the output drives.
    pub hand: Option<Hand>,
    /// The motor at the input.
    pub motor: Option<Motor>,
    /// How the parts are made.
    pub making: Making,
    /// What was measured on a bench.
    pub bench: Option<Arc<Bench>>,
    /// Units in which people are shown results.
    pub units: DisplayUnits,
}

/// Which model of the clutch.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Source {
    /// Exact opening, finite turns, grip of what exceeds the transition torque.
    Corrected,
    /// As Butin et al. have it.
    Paper,
}

/// The transmission as it is built: what tolerances change.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Built {
    /// The planetary gears.
    pub gears: Gears,
    /// The spring.
    pub spring: Spring,
    /// Diameter of surface A, m.
    pub hub_m: f64,
    /// Diameter of surface B, m.
    pub bore_m: f64,
    /// Friction on hub and in bore.
    pub friction: [f64; 2],
    /// Losses in mode I and mode II.
    pub losses: [Loss; 2],
}

/// The planetary gears.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gears {
    /// Teeth of sun, planet and ring.
    pub teeth: [u32; 3],
    /// Number of planets.
    pub planets: u32,
    /// Module, m.
    pub module_m: f64,
    /// Basic rack.
    pub rack: Rack,
    /// Profile shift of sun, planet and ring, modules.
    pub shift: [f64; 3],
    /// Tip shortening of sun, planet and ring, modules.
    pub shortening: [f64; 3],
    /// Width, m.
    pub face_m: f64,
    /// Circumferential backlash of each mesh, m.
    pub backlash_m: f64,
    /// Friction between flanks.
    pub friction: Option<f64>,
    /// Load of the most loaded planet over the mean.
    pub sharing: f64,
}

/// The spring.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spring {
    /// Wire diameter, m.
    pub wire_m: f64,
    /// Inner diameter, free, m.
    pub inner_m: f64,
    /// Turns on the hub.
    pub hub_turns: f64,
    /// Turns off the hub, those in the bore among them.
    pub free_turns: f64,
    /// Turns in the bore.
    pub bore_turns: f64,
    /// Turns beyond the bore that nothing supports.
    pub unsupported_turns: f64,
    /// Whether it is wound as a common screw.
    pub right_hand: bool,
    /// Young's modulus of the wire, Pa.
    pub young_pa: f64,
}

/// Losses of a mode, at the output.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Loss {
    /// Part of the torque; `None` in mode II: that of the meshes.
    pub proportional: Option<f64>,
    /// At any load, N·m.
    pub constant_nm: f64,
}

/// Lower and upper deviations of what scatters around the design, SI; zero where nothing is said.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scatter {
    /// Wire diameter.
    pub wire_m: [f64; 2],
    /// Inner diameter of the spring.
    pub inner_m: [f64; 2],
    /// Hub.
    pub hub_m: [f64; 2],
    /// Bore.
    pub bore_m: [f64; 2],
    /// Friction on the hub.
    pub hub_friction: [f64; 2],
    /// Friction in the bore.
    pub bore_friction: [f64; 2],
}

/// How the parts are made, SI; `None` where the project does not say.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Making {
    /// Ring outside the roots of its teeth, m: [`Making::wall_m`].
    pub ring_wall_m: Option<f64>,
    /// Hole through the sun, m.
    pub sun_bore_m: Option<f64>,
    /// Holes through the planets, m.
    pub planet_bore_m: Option<f64>,
    /// Hole through the hub, m.
    pub hub_bore_m: Option<f64>,
    /// Plates of carrier and chassis, m: [`Making::plate_m`].
    pub plate_m: Option<f64>,
    /// Outer diameter of the chassis, m.
    pub chassis_m: Option<f64>,
    /// Of the turned parts, kg/m³.
    pub density_kg_per_m3: Option<f64>,
}

impl Making {
    /// Ring outside the roots of its teeth, by default 3 modules, m.
    pub fn wall_m(&self, module_m: f64) -> f64 {
        self.ring_wall_m.unwrap_or(3.0 * module_m)
    }

    /// Plates of carrier and chassis, by default 4 modules, m.
    pub fn plate_m(&self, module_m: f64) -> f64 {
        self.plate_m.unwrap_or(4.0 * module_m)
    }
}

/// What the transmission must do, SI.
#[derive(Clone, Debug)]
pub struct Requirements {
    /// Torque at the input, N·m.
    pub input_nm: f64,
    /// Torque at the output at which it shifts, from and to, N·m.
    pub transition_nm: [Option<f64>; 2],
    /// Torque at the output, N·m.
    pub output_nm: Option<f64>,
    /// Speed in mode I over mode II.
    pub speed_drop: Option<f64>,
    /// Efficiency with the torque at the input.
    pub efficiency: Option<f64>,
    /// Permissible over largest stress of the wire.
    pub safety_factor: Option<f64>,
    /// Limits on metrics.
    pub limits: Vec<Limit>,
}

/// Units in which people are shown results: those that they typed.
#[derive(Clone, Debug)]
pub struct DisplayUnits {
    /// Diameters and gaps.
    pub length: Unit,
    /// Torques.
    pub torque: Unit,
    /// Stress.
    pub stress: Unit,
    /// Forces.
    pub force: Unit,
    /// Speeds of the motor.
    pub speed: Unit,
}

impl Design {
    /// Least and largest friction on hub and bore.
    pub fn frictions(&self) -> [[f64; 2]; 2] {
        let [hub, bore] = self.built.friction;
        [0, 1].map(|i| [(hub + self.scatter.hub_friction[i]).max(0.0), (bore + self.scatter.bore_friction[i]).max(0.0)])
    }

    /// Whether anything is given with a range or a tolerance.
    pub fn scatters(&self) -> bool {
        let Scatter { wire_m, inner_m, hub_m, bore_m, hub_friction, bore_friction } = self.scatter;
        [wire_m, inner_m, hub_m, bore_m, hub_friction, bore_friction].iter().any(|[low, high]| low < high)
    }

    /// Whether friction is given as a range.
    pub fn friction_scatters(&self) -> bool {
        let Scatter { hub_friction: [low, high], .. } = self.scatter;
        low < high
    }
}

impl Built {
    /// R, speed of the output over that of the input in mode II.
    pub fn ratio(&self) -> f64 {
        let [sun, _, ring] = self.gears.teeth.map(f64::from);
        sun / (sun + ring)
    }

    /// Radial interference δa and radial opening δb, m.
    pub fn gaps_m(&self) -> [f64; 2] {
        let Spring { wire_m, inner_m, .. } = self.spring;
        [0.5 * (self.hub_m - inner_m), 0.5 * (self.bore_m - inner_m) - wire_m]
    }
}

#[expect(clippy::ref_option, reason = "a slot as it stands in the description")]
pub(crate) fn si(slot: &Slot<Quantity>) -> Option<f64> {
    slot.as_ref().map(|l| l.value.si)
}

pub(crate) fn unit_or(slot: Option<&Located<Quantity>>, symbol: &str, dimension: Dimension) -> Unit {
    let typed = slot.filter(|l| l.origin == Origin::File).map(|l| l.value.unit.clone());
    typed.or_else(|| Unit::parse(symbol).ok()).unwrap_or_else(|| Unit::si(dimension))
}

pub(crate) fn place_of<T>(section: &Section<T>) -> Span {
    section.present.as_ref().map(|p| p.span).unwrap_or_default()
}

fn span_of<T>(slot: Option<&Located<T>>, section: Span) -> Span {
    slot.map_or(section, |l| l.span)
}

/// Reads a transmission from what was typed. Everything wrong goes into `diagnostics`.
pub(crate) fn resolve(spec: &mut Spec, diagnostics: &mut Diagnostics) -> Option<Design> {
    let wire = material::wire_of(spec, diagnostics);
    let gear_material = material::gears_of(spec, diagnostics);
    let requirements = requirements_of(spec, diagnostics);
    let hand = outside::hand_of(spec, diagnostics);
    let motor = outside::motor_of(spec, diagnostics);
    if diagnostics.has_errors() {
        return None;
    }
    let wire = wire?;
    let built = built_of(spec, &wire)?;
    check_gears(spec, &built, diagnostics);
    check_spring(spec, &built, diagnostics);
    let bench = bench_of(spec, built.ratio(), diagnostics).map(Arc::new);
    if diagnostics.has_errors() {
        return None;
    }
    Some(Design {
        title: spec.header.title.as_ref().map_or_else(|| "Two-speed transmission".to_owned(), |t| t.value.clone()),
        scatter: scatter_of(spec),
        source: if spec.model.source.as_ref().is_some_and(|s| s.value == "paper") { Source::Paper } else { Source::Corrected },
        requirements,
        wire,
        gear_material,
        hand,
        motor,
        making: making_of(spec),
        bench,
        built,
        units: display_units(spec),
    })
}

fn built_of(spec: &Spec, wire: &WireMaterial) -> Option<Built> {
    let design = &spec.design;
    let gears = &design.gears;
    let (sun, planet) = (gears.sun.as_ref()?.value, gears.planet.as_ref()?.value);
    let ring = gears.ring.as_ref().map_or(sun + 2 * planet, |r| r.value);
    let module_m = si(&gears.module)?;
    let rack = match gears.rack.as_ref().map(|r| r.value) {
        Some("B") => Rack::ISO_53_B,
        Some("C") => Rack::ISO_53_C,
        Some("D") => Rack::ISO_53_D,
        _ => Rack::ISO_53_A,
    };
    let each = |of: &spec::Shifts| [&of.sun, &of.planet, &of.ring].map(|slot| si(slot).unwrap_or(0.0));
    let spring = &design.spring;
    let loss = |of: &spec::Loss| Loss { proportional: si(&of.proportional), constant_nm: si(&of.constant).unwrap_or(0.0) };
    Some(Built {
        gears: Gears {
            teeth: [sun, planet, ring],
            planets: gears.planets.as_ref()?.value,
            module_m,
            rack: Rack { pressure_angle_rad: si(&gears.pressure_angle)?, ..rack },
            shift: each(&gears.profile_shift),
            shortening: each(&gears.tip_shortening),
            face_m: si(&gears.face_width).unwrap_or(8.0 * module_m),
            backlash_m: si(&gears.backlash).unwrap_or(0.0),
            friction: si(&gears.friction),
            sharing: si(&gears.load_sharing).unwrap_or(1.0),
        },
        spring: Spring {
            wire_m: si(&spring.wire_diameter)?,
            inner_m: si(&spring.inner_diameter)?,
            hub_turns: si(&spring.hub_turns)?,
            free_turns: si(&spring.free_turns)?,
            bore_turns: si(&spring.bore_turns)?,
            unsupported_turns: si(&spring.unsupported_turns).unwrap_or(0.0),
            right_hand: spring.hand.as_ref().is_none_or(|h| h.value == "right"),
            young_pa: wire.young_pa,
        },
        hub_m: si(&design.hub.diameter)?,
        bore_m: si(&design.bore.diameter)?,
        friction: [si(&design.friction.hub)?, si(&design.friction.bore)?],
        losses: [loss(&spec.losses.mode_1), loss(&spec.losses.mode_2)],
    })
}

/// Deviations of a number by its tolerance.
#[expect(clippy::ref_option, reason = "a slot as it stands in the description")]
fn deviations(slot: &Slot<Quantity>) -> [f64; 2] {
    slot.as_ref().and_then(|l| l.value.tolerance.as_ref()?.deviations_si(l.value.si)).unwrap_or_default()
}

fn scatter_of(spec: &Spec) -> Scatter {
    let design = &spec.design;
    Scatter {
        wire_m: deviations(&design.spring.wire_diameter),
        inner_m: deviations(&design.spring.inner_diameter),
        hub_m: deviations(&design.hub.diameter),
        bore_m: deviations(&design.bore.diameter),
        hub_friction: deviations(&design.friction.hub),
        bore_friction: deviations(&design.friction.bore),
    }
}

fn requirements_of(spec: &Spec, diagnostics: &mut Diagnostics) -> Option<Requirements> {
    spec.requirements.present.as_ref()?;
    let requirements = &spec.requirements;
    let limits = requirements.limits.resolve(diagnostics);
    let transition = &requirements.transition_torque;
    check_order("requirements.transition_torque.", transition.min.as_ref(), transition.max.as_ref(), diagnostics);
    Some(Requirements {
        input_nm: si(&requirements.input_torque)?,
        transition_nm: [si(&transition.min), si(&transition.max)],
        output_nm: si(&requirements.output_torque.min),
        speed_drop: si(&requirements.speed_drop.max),
        efficiency: si(&requirements.efficiency.min),
        safety_factor: si(&requirements.safety_factor),
        limits,
    })
}

fn making_of(spec: &Spec) -> Making {
    let parts = &spec.parts;
    Making {
        ring_wall_m: si(&parts.ring_wall),
        sun_bore_m: si(&parts.sun_bore),
        planet_bore_m: si(&parts.planet_bore),
        hub_bore_m: si(&parts.hub_bore),
        plate_m: si(&parts.plate_thickness),
        chassis_m: si(&parts.chassis_diameter),
        density_kg_per_m3: si(&parts.density),
    }
}

/// E0801, E0802: the gears run about one axis and can be put together.
fn check_gears(spec: &Spec, built: &Built, diagnostics: &mut Diagnostics) {
    let Gears { teeth: [sun, planet, ring], planets, .. } = built.gears;
    let place = place_of(&spec.design.gears);
    // Shifts make up for a tooth or two.
    if ring.abs_diff(sun + 2 * planet) > 2 {
        let at = span_of(spec.design.gears.ring.as_ref(), place);
        let message = format!("sun, planet and ring of {sun}, {planet} and {ring} teeth have no common axis");
        diagnostics.push(
            Diagnostic::error("E0801", at, message)
                .label("this ring")
                .help(format!("the ring needs sun + 2 planet teeth: `ring = {}`", sun + 2 * planet)),
        );
        return;
    }
    if (sun + ring) % planets != 0 {
        let fits: Vec<String> = (1..=12).filter(|n| (sun + ring) % n == 0 && *n > 1).map(|n| n.to_string()).collect();
        let at = span_of(spec.design.gears.planets.as_ref(), place);
        diagnostics.push(
            Diagnostic::error("E0802", at, format!("{planets} equally spaced planets cannot be put between this sun and this ring"))
                .label("this number of planets")
                .help(format!(
                    "sun + ring, {}, must be a multiple of it: {}",
                    sun + ring,
                    if fits.is_empty() { "change the teeth".to_owned() } else { format!("planets = {}", fits.join(", ")) }
                )),
        );
    }
}

/// E0803, E0804: the spring sits on the hub and in the bore.
fn check_spring(spec: &Spec, built: &Built, diagnostics: &mut Diagnostics) {
    let [hub_m, bore_m] = built.gaps_m();
    let length = |m: f64| format_si(m, &unit_or(spec.design.spring.inner_diameter.as_ref(), "mm", Dimension::Length), 6);
    let Spring { wire_m, inner_m, .. } = built.spring;
    if hub_m <= 0.0 {
        let at = span_of(spec.design.hub.diameter.as_ref(), place_of(&spec.design.hub));
        diagnostics.push(
            Diagnostic::error("E0803", at, "the spring is loose on the hub")
                .label("this hub")
                .help(format!("it must be larger than the inner diameter of the free spring, {}", length(inner_m))),
        );
    }
    if bore_m <= 0.0 {
        let at = span_of(spec.design.bore.diameter.as_ref(), place_of(&spec.design.bore));
        diagnostics.push(
            Diagnostic::error("E0804", at, "the spring is in the bore before it is loaded")
                .label("this bore")
                .help(format!("it must be larger than the outer diameter of the free spring, {}", length(inner_m + 2.0 * wire_m))),
        );
    }
    if built.spring.free_turns < built.spring.bore_turns {
        let at = span_of(spec.design.spring.free_turns.as_ref(), place_of(&spec.design.spring));
        diagnostics.push(
            Diagnostic::error("E0808", at, "more turns in the bore than off the hub")
                .label("these turns")
                .help("`free_turns` counts all turns off the hub, those in the bore too: at least `bore_turns`"),
        );
    }
    let index = 1.0 + inner_m / wire_m;
    if index < 4.0 {
        let at = span_of(spec.design.spring.wire_diameter.as_ref(), place_of(&spec.design.spring));
        diagnostics.push(
            Diagnostic::error("E0805", at, format!("a coil of index {} cannot be wound", format_number(index, 3)))
                .label("this wire")
                .help("mean diameter over wire diameter of at least 4"),
        );
    }
}

fn display_units(spec: &Spec) -> DisplayUnits {
    let design = &spec.design;
    DisplayUnits {
        length: unit_or(design.spring.inner_diameter.as_ref(), "mm", Dimension::Length),
        torque: unit_or(spec.requirements.input_torque.as_ref(), "N*mm", Dimension::Torque),
        stress: Unit::parse("MPa").unwrap_or_else(|_| Unit::si(Dimension::Stress)),
        force: unit_or(spec.hand.force.as_ref(), "N", Dimension::Force),
        speed: unit_or(spec.motor.max_speed.as_ref(), "rpm", Dimension::AngularSpeed),
    }
}
