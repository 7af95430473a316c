//! From a design to what it does: geometry, tensions, stiffness, loop, losses.

use std::f64::consts::TAU;

use forcewright_base::maths;
use forcewright_contract::metrics::Values;
use forcewright_elements::cables::{strength_left, wire_bending_stress_pa};
use forcewright_elements::wrap::WrapError;

use crate::design::{Built, Design, Source};
use crate::geometry::{Drive, Drum, GeometryError, Nearest, preload_travel_m};
use crate::losses::{Losses, shaft_load_n};
use crate::metrics::CapstanMetrics;
use crate::statics::{Loaded, Loop, Statics};

/// Torques at which curves are computed.
const STATIONS: usize = 200;
/// Points on each branch of a loop.
const LOOP_POINTS: usize = 200;
/// How far beyond the required torque curves go, over it.
const BEYOND: f64 = 1.25;
/// How near to gross slip they go.
const SHORT_OF_SLIP: f64 = 0.999;

/// Values of this family's metrics.
pub type Measured = Values<CapstanMetrics>;

/// What a design does.
#[derive(Clone, Debug)]
pub struct Behaviour {
    /// Where the cables lie.
    pub geometry: Drive,
    /// Tensions and stiffness in the middle of the travel.
    pub statics: Statics,
    /// The same at an end of the travel, where the wrap before one termination, and before one side of a pin on the input, is shortest. The
    /// other end is its mirror image.
    pub end: Statics,
    /// Under growing torque at the output, from zero on.
    pub stations: Vec<Loaded>,
    /// Under the required torque; else what keeps it from being held.
    pub required: Option<Result<Loaded, WrapError>>,
    /// At the end of the travel, under the required torque and its opposite.
    pub ends: Option<[Result<Loaded, WrapError>; 2]>,
    /// The loop between the required torque and its opposite; not of the paper's model, which has no unloading.
    pub cycle: Option<Loop>,
    /// Neighbouring turns, nearest first.
    pub neighbours: Vec<Nearest>,
    /// States of the loaded drive computed: of the curves, the loop and at the ends of the travel.
    pub states: u64,
}

/// Why a design has no behaviour.
#[derive(Clone, Debug, PartialEq)]
pub enum NoDrive {
    /// There is no such geometry.
    Geometry(GeometryError),
    /// There is no such wrap.
    Wrap(WrapError),
    /// The travel unwinds a fastened cable down to its pin: so much is missing, rad.
    Unwound(f64),
}

impl std::fmt::Display for NoDrive {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Geometry(error) => write!(f, "{error}"),
            Self::Wrap(error) => write!(f, "{error}"),
            Self::Unwound(rad) => write!(f, "the travel unwinds the cable down to its pin: {rad} rad of wrap are missing on either side"),
        }
    }
}

impl Behaviour {
    /// Analyses a design.
    ///
    /// # Errors
    /// [`NoDrive`]; a design that was resolved has a behaviour.
    pub fn of(design: &Design) -> Result<Self, NoDrive> {
        let built = &design.built;
        let geometry = built.geometry().map_err(NoDrive::Geometry)?;
        if built.fastened && built.least_pin_wrap_rad(&geometry) <= 0.0 {
            return Err(NoDrive::Unwound(-built.least_pin_wrap_rad(&geometry)));
        }
        let at = |output_rad: f64| Statics::new(built, &built.place(&geometry, output_rad), design.source).map_err(NoDrive::Wrap);
        let (statics, end) = (at(built.middle_rad())?, at(0.0)?);
        let torque_nm = design.requirements.as_ref().map(|r| r.torque_nm);
        let mut states = 0;
        let mut under = |statics: &Statics, torque_nm: f64| {
            states += 1;
            statics.under(torque_nm)
        };
        let required = torque_nm.map(|t| under(&statics, t));
        let ends = torque_nm.map(|t| [under(&end, t), under(&end, -t)]);
        let stations: Vec<Loaded> = torques_nm(&statics, built, torque_nm).into_iter().map_while(|t| under(&statics, t).ok()).collect();
        let cycle = match (torque_nm, &required, design.source) {
            (Some(torque_nm), Some(Ok(_)), Source::Corrected) => statics.cycle(torque_nm, LOOP_POINTS).ok(),
            _ => None,
        };
        states += cycle.as_ref().map_or(0, |l: &Loop| l.branches.iter().map(Vec::len).sum::<usize>() as u64);
        let neighbours = geometry.occupancy();
        Ok(Self { geometry, statics, end, stations, required, ends, cycle, neighbours, states })
    }

    /// The state under the required torque.
    pub fn at_torque(&self) -> Option<&Loaded> {
        self.required.as_ref()?.as_ref().ok()
    }

    /// The states under the required torque over the travel: in its middle, and at its end both ways where it is held there.
    fn over_travel(&self) -> impl Iterator<Item = &Loaded> {
        self.at_torque().into_iter().chain(self.ends.iter().flatten().filter_map(|end| end.as_ref().ok()))
    }

    /// Whether slip reaches a termination over the travel under the required torque; a torque that is not held at an end slips through.
    pub fn reaches_end(&self) -> bool {
        self.reaches(|loaded| loaded.at_end)
    }

    /// Whether slip reaches the pin of a fastened cable over the travel under the required torque.
    pub fn reaches_pin(&self) -> bool {
        self.reaches(|loaded| loaded.at_pin)
    }

    fn reaches(&self, at: impl Fn(&Loaded) -> bool) -> bool {
        let states = self.required.iter().chain(self.ends.iter().flatten());
        self.at_torque().is_some() && states.into_iter().any(|state| state.as_ref().map_or(true, &at))
    }

    /// sin γ and cos γ.
    pub fn span(&self) -> [f64; 2] {
        let (sin, cos) = maths::sin_cos(self.geometry.tangent_angle_rad());
        [sin, cos]
    }
}

/// Even torques up to somewhat more than the required one, or to where the drive slips, N·m.
fn torques_nm(statics: &Statics, built: &Built, torque_nm: Option<f64>) -> Vec<f64> {
    let slips_nm = statics.gross_slip_nm();
    let preload_n: f64 = built.cables.iter().map(|c| c.preload_left_n(built)).sum();
    let usual_nm = torque_nm.map_or_else(|| 2.0 * preload_n * statics.levers_m()[1], |t| BEYOND * t);
    let top_nm = slips_nm.map_or(usual_nm, |slips_nm| usual_nm.min(SHORT_OF_SLIP * slips_nm));
    (0..=STATIONS).map(|i| top_nm * i as f64 / STATIONS as f64).collect()
}

/// Every metric that the behaviour has.
pub fn measure(design: &Design, behaviour: &Behaviour) -> Measured {
    let mut m = Measured::none();
    let built = &design.built;
    measure_statics(&mut m, built, behaviour);
    if let Some(loaded) = behaviour.at_torque() {
        measure_loaded(&mut m, built, behaviour, loaded);
    }
    measure_losses(&mut m, built, behaviour);
    measure_geometry(&mut m, design, behaviour);
    measure_cables(&mut m, built, behaviour);
    m
}

fn measure_statics(m: &mut Measured, built: &Built, behaviour: &Behaviour) {
    let statics = &behaviour.statics;
    let initial = statics.initial_nm_per_rad();
    m.set("stiffness_initial_output", initial);
    m.set("stiffness_initial_input", initial / (built.ratio() * built.ratio()));
    let ends_nm = behaviour.end.gross_slip_nm();
    m.set("gross_slip_torque_output", statics.gross_slip_nm().map(|nm| nm.min(ends_nm.unwrap_or(nm))));
    m.set("preload_left", built.cables.iter().map(|c| c.preload_left_n(built)).fold(f64::INFINITY, f64::min));
    m.set("ratio", built.ratio());
    m.set("friction_effective", built.friction * built.groove_factor);
    if let Some(cycle) = &behaviour.cycle {
        m.set("lost_motion_output", cycle.lost_motion_rad);
        m.set("loss_per_cycle", cycle.lost_j);
    }
}

fn measure_loaded(m: &mut Measured, built: &Built, behaviour: &Behaviour, loaded: &Loaded) {
    let statics = &behaviour.statics;
    for (shaft, names) in [["stiffness_tangent_input", "stiffness_secant_input"], ["stiffness_tangent_output", "stiffness_secant_output"]]
        .into_iter()
        .enumerate()
    {
        m.set(names[0], statics.torsional(loaded.tangent_n_per_m, shaft));
        m.set(names[1], statics.torsional(loaded.secant_n_per_m, shaft));
    }
    m.set("wind_up_output", loaded.turn_rad);
    m.set("taut_tension", taut_n(behaviour, loaded).into_iter().reduce(f64::max));
    m.set("slack_tension", behaviour.over_travel().flat_map(|l| l.tensions_n.iter().flatten()).copied().fold(f64::INFINITY, f64::min));
    let most = |side: usize| loaded.slip_rad.iter().flat_map(|s| s[side]).fold(0.0, f64::max);
    m.set("slip_angle_taut", most(0));
    m.set("slip_angle_slack", most(1));
    m.set("slip_used", if built.fastened { pin_used(built, behaviour) } else { slip_used(behaviour, loaded) });
    let stiffness = statics.torsional(loaded.tangent_n_per_m, 1);
    let [input, output] = built.inertia_kg_m2;
    let hertz = |inverse: f64| (stiffness * inverse).sqrt() / TAU;
    m.set("torsional_frequency", output.map(|output| hertz(1.0 / output)));
    let reflected = input.map(|input| input * built.ratio() * built.ratio());
    m.set("torsional_frequency_free", reflected.zip(output).map(|(input, output)| hertz(1.0 / input + 1.0 / output)));
}

/// Largest tension of each cable under the required torque, in the middle of the travel and at its ends, N.
fn taut_n(behaviour: &Behaviour, loaded: &Loaded) -> Vec<f64> {
    let most = |i: usize| behaviour.over_travel().flat_map(|l| l.tensions_n[i]).fold(f64::NEG_INFINITY, f64::max);
    (0..loaded.tensions_n.len()).map(most).collect()
}

/// Part of the wrap on the input drum on which a cable slips.
fn slip_used(behaviour: &Behaviour, loaded: &Loaded) -> f64 {
    let wrap_rad = behaviour.geometry.input_wrap_rad();
    loaded.slip_rad.iter().map(|[one, other]| (one[1] + other[1]) / wrap_rad).fold(0.0, f64::max)
}

/// Angle that slip needs on the input drum, `|ln(T/T_p)|/μ`, over the wrap up to the pin: the largest over the travel; above 1 the pin feels
/// the load, infinite where a side is loose.
fn pin_used(built: &Built, behaviour: &Behaviour) -> f64 {
    let geometry = &behaviour.geometry;
    let place = |output_rad: f64| built.place(geometry, output_rad);
    let (middle, end) = (place(built.middle_rad()), place(0.0));
    let cos = if built.helix_correction { maths::cos(end.helix_rad) } else { 1.0 };
    let friction = built.friction * built.groove_factor * cos;
    let used = |loaded: &Loaded, wraps_rad: [f64; 2]| {
        let needed = |(tensions_n, cable): (&[f64; 2], &crate::design::Cable)| {
            let of = |side: usize| maths::ln(tensions_n[side] / cable.preload_left_n(built)).abs() / friction / wraps_rad[side];
            of(0).max(of(1))
        };
        loaded.tensions_n.iter().zip(&built.cables).map(needed).fold(0.0, f64::max)
    };
    let ends = behaviour.ends.iter().flatten().filter_map(|end| end.as_ref().ok()).map(|l| used(l, end.input_wraps_rad));
    behaviour.at_torque().map(|l| used(l, middle.input_wraps_rad)).into_iter().chain(ends).fold(0.0, f64::max)
}

fn measure_losses(m: &mut Measured, built: &Built, behaviour: &Behaviour) {
    let [input, output] = built.inertia_kg_m2;
    m.set(
        "reflected_inertia_output",
        input.map(|i| i * built.ratio() * built.ratio() + output.unwrap_or(0.0)).filter(|_| output.is_some()),
    );
    let at_rest: Vec<[f64; 2]> = built.cables.iter().map(|c| [c.preload_left_n(built); 2]).collect();
    let loaded = behaviour.at_torque().map_or(0.0, |l| shaft_load_n(&l.tensions_n, behaviour.span()));
    m.set("shaft_load", shaft_load_n(&at_rest, behaviour.span()).max(loaded));
    let torque_nm = behaviour.at_torque().map(|l| l.torque_nm);
    let Some(losses) = Losses::of(built, &behaviour.geometry, &behaviour.statics) else { return };
    m.set("backdrive_torque_output", losses.backdrive_nm().ok());
    let Some(torque_nm) = torque_nm else { return };
    if let Ok(forward) = losses.forward(torque_nm) {
        m.set("torque_input", forward.input_nm);
        m.set("efficiency_forward", forward.output_nm / (forward.input_nm * built.ratio()));
    }
    if let Ok(backward) = losses.backward(torque_nm) {
        m.set("efficiency_backward", backward.input_nm * built.ratio() / backward.output_nm);
    }
}

fn measure_geometry(m: &mut Measured, design: &Design, behaviour: &Behaviour) {
    let (built, geometry) = (&design.built, &behaviour.geometry);
    m.set("free_span", geometry.free_span_m());
    m.set("input_wrap", geometry.input_wrap_rad());
    m.set("output_wrap_min", geometry.least_output_wraps_rad().into_iter().fold(f64::INFINITY, f64::min));
    m.set("helix_angle", geometry.helix_angle_rad());
    let cables = 0..built.cables.len();
    let largest = |value: &dyn Fn(usize) -> Option<f64>| cables.clone().filter_map(value).map(f64::abs).reduce(f64::max);
    m.set("alignment_mismatch", largest(&|i| geometry.mismatch_pitches(i).ok()));
    m.set("fleet_angle", largest(&|i| geometry.fleet(i).ok().map(|f| f.largest_rad())));
    let on_drums = behaviour.neighbours.iter().filter(|n| matches!(n.place, crate::geometry::Place::On(_)));
    m.set("occupancy_clearance", on_drums.map(|n| n.pitches).reduce(f64::min));
    m.set("rope_clearance", behaviour.neighbours.iter().map(|n| n.clearance_m).reduce(f64::min));
    let margins_m = [design.making.margin_m; 2];
    m.set("input_drum_length", geometry.drum_length_m(Drum::Input, margins_m).ok());
    m.set("output_drum_length", geometry.drum_length_m(Drum::Output, margins_m).ok());
    let beyond_m = 0.5 * built.cable_m() + built.land_m();
    m.set("output_drum_diameter", 2.0 * (built.radii_m[1] + beyond_m));
    m.set("length_over_drums", built.distance_m + built.radii_m[0] + built.radii_m[1] + 2.0 * beyond_m);
    let cut = |i: usize| {
        let cable = &built.cables[i];
        geometry.cut_length_m(i, [design.making.anchor_m; 2], cable.preload_n, cable.axial_stiffness_n).ok()
    };
    m.set("cable_length", largest(&cut));
    let travel = |i: usize| {
        let cable = &built.cables[i];
        preload_travel_m(geometry.cable_length_m(i).ok()?, cable.preload_n, cable.axial_stiffness_n).ok()
    };
    m.set("preload_travel", largest(&travel));
}

fn measure_cables(m: &mut Measured, built: &Built, behaviour: &Behaviour) {
    let drum_m = 2.0 * built.radii_m[0].min(built.radii_m[1]);
    m.set("bending_ratio", drum_m / built.cable_m());
    let stress = |c: &crate::design::Cable| Some(wire_bending_stress_pa(c.wire_pa?, c.wire_m?, drum_m));
    m.set(
        "wire_bending_stress",
        built.cables.iter().map(stress).collect::<Option<Vec<_>>>().and_then(|all| all.into_iter().reduce(f64::max)),
    );
    let taut = behaviour.at_torque().map(|l| taut_n(behaviour, l));
    let factor = |(cable, taut_n): (&crate::design::Cable, f64)| Some(cable.breaking_n? * kept(built, cable, drum_m)? / taut_n);
    m.set(
        "cable_safety_factor",
        taut.and_then(|taut| built.cables.iter().zip(taut).map(factor).collect::<Option<Vec<_>>>())
            .and_then(|all| all.into_iter().reduce(f64::min)),
    );
}

/// Part of its strength that a cable keeps over the smaller drum: by the table for steel cables; of others it is not known and taken as whole.
fn kept(built: &Built, cable: &crate::design::Cable, drum_m: f64) -> Option<f64> {
    if cable.wire_m.is_none() { Some(1.0) } else { strength_left(drum_m / built.cable_m()) }
}
