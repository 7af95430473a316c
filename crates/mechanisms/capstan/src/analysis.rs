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
    /// The same at an end of the travel, where the wrap before one termination is shortest.
    pub end: Option<Statics>,
    /// Under growing torque at the output, from zero on.
    pub stations: Vec<Loaded>,
    /// Under the required torque; else what keeps it from being held.
    pub required: Option<Result<Loaded, WrapError>>,
    /// The loop between the required torque and its opposite; not of the paper's model, which has no unloading.
    pub cycle: Option<Loop>,
    /// Whether slip reaches a termination where the wrap before it is shortest, under the required torque.
    pub reaches_end: Option<bool>,
    /// Neighbouring turns, nearest first.
    pub neighbours: Vec<Nearest>,
    /// States computed.
    pub states: u64,
}

/// Why a design has no behaviour.
#[derive(Clone, Debug, PartialEq)]
pub enum NoDrive {
    /// There is no such geometry.
    Geometry(GeometryError),
    /// There is no such wrap.
    Wrap(WrapError),
}

impl std::fmt::Display for NoDrive {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Geometry(error) => write!(f, "{error}"),
            Self::Wrap(error) => write!(f, "{error}"),
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
        let statics = Statics::new(built, &built.place(&geometry, built.middle_wraps_rad()), design.source).map_err(NoDrive::Wrap)?;
        let end = at_end(built, &geometry, design.source);
        let torque_nm = design.requirements.as_ref().map(|r| r.torque_nm);
        let required = torque_nm.map(|t| statics.under(t));
        let stations = stations(&statics, built, torque_nm);
        let cycle = match (torque_nm, &required, design.source) {
            (Some(torque_nm), Some(Ok(_)), Source::Corrected) => statics.cycle(torque_nm, LOOP_POINTS).ok(),
            _ => None,
        };
        let reaches_end = match &required {
            Some(Ok(loaded)) => Some(reaches_end(end.as_ref(), loaded.torque_nm)),
            _ => None,
        };
        let states = (stations.len() + 2 * LOOP_POINTS) as u64;
        let neighbours = geometry.occupancy();
        Ok(Self { geometry, statics, end, stations, required, cycle, reaches_end, neighbours, states })
    }

    /// The state under the required torque.
    pub fn at_torque(&self) -> Option<&Loaded> {
        self.required.as_ref()?.as_ref().ok()
    }

    /// sin γ and cos γ.
    pub fn span(&self) -> [f64; 2] {
        let (sin, cos) = maths::sin_cos(self.geometry.tangent_angle_rad());
        [sin, cos]
    }
}

/// States under even torques up to somewhat more than the required one, or to where the drive slips.
fn stations(statics: &Statics, built: &Built, torque_nm: Option<f64>) -> Vec<Loaded> {
    let slips_nm = statics.gross_slip_nm();
    let preload_n: f64 = built.cables.iter().map(|c| c.preload_left_n(built)).sum();
    let usual_nm = torque_nm.map_or_else(|| 2.0 * preload_n * statics.levers_m()[1], |t| BEYOND * t);
    let top_nm = slips_nm.map_or(usual_nm, |slips_nm| usual_nm.min(SHORT_OF_SLIP * slips_nm));
    (0..=STATIONS).map_while(|i| statics.under(top_nm * i as f64 / STATIONS as f64).ok()).collect()
}

/// The drive at an end of its travel; the other end is its mirror image.
fn at_end(built: &Built, geometry: &Drive, source: Source) -> Option<Statics> {
    // Without a guard nothing is wrapped there; a wrap must have some angle.
    let shortest = built.guard_rad.max(1e-9);
    Statics::new(built, &built.place(geometry, [shortest, shortest + built.travel_rad]), source).ok()
}

/// Whether slip reaches a termination at an end of the travel, loaded either way; a torque that is not held there slips through.
fn reaches_end(end: Option<&Statics>, torque_nm: f64) -> bool {
    let at = |torque_nm: f64| end.and_then(|s| s.under(torque_nm).ok()).is_none_or(|l| l.at_end);
    at(torque_nm) || at(-torque_nm)
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
    let ends_nm = behaviour.end.as_ref().and_then(Statics::gross_slip_nm);
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
    m.set("slack_tension", loaded.tensions_n.iter().map(|t| t[1]).fold(f64::INFINITY, f64::min));
    let most = |side: usize| loaded.slip_rad.iter().flat_map(|s| s[side]).fold(0.0, f64::max);
    m.set("slip_angle_taut", most(0));
    m.set("slip_angle_slack", most(1));
    m.set("slip_used", loaded.slip_rad.iter().map(|s| slip_used(built, behaviour, s)).fold(0.0, f64::max));
    let stiffness = statics.torsional(loaded.tangent_n_per_m, 1);
    let [input, output] = built.inertia_kg_m2;
    let hertz = |inverse: f64| (stiffness * inverse).sqrt() / TAU;
    m.set("torsional_frequency", output.map(|output| hertz(1.0 / output)));
    let reflected = input.map(|input| input * built.ratio() * built.ratio());
    m.set("torsional_frequency_free", reflected.zip(output).map(|(input, output)| hertz(1.0 / input + 1.0 / output)));
}

/// Largest tension of each cable under the required torque, in the middle of the travel and at its ends, N.
fn taut_n(behaviour: &Behaviour, loaded: &Loaded) -> Vec<f64> {
    let torque_nm = loaded.torque_nm;
    let ends = [torque_nm, -torque_nm].map(|t| behaviour.end.as_ref().and_then(|s| s.under(t).ok()));
    let places = || std::iter::once(loaded).chain(ends.iter().flatten());
    (0..loaded.tensions_n.len()).map(|i| places().flat_map(|l| l.tensions_n[i]).fold(f64::NEG_INFINITY, f64::max)).collect()
}

/// Part of the wrap on the input drum on which a cable slips.
fn slip_used(built: &Built, behaviour: &Behaviour, slip_rad: &[[f64; 2]; 2]) -> f64 {
    let wrap_rad = behaviour.geometry.input_wrap_rad();
    let [one, other] = slip_rad.map(|side| side[1]);
    if built.fastened { one.max(other) / (0.5 * wrap_rad) } else { (one + other) / wrap_rad }
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
