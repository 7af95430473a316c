//! Motor, transmission and finger as equations of two coordinates: the angles of sun and carrier.
//!
//! The ring has no mass: its turn follows from both angles, ψ = (φ − Rθ)/(1 − R), and the coil between it and the carrier is wound by
//! q = φ − ψ = (θ − φ)/k with k = (1 − R)/R. Torques: `τ_H` at the hub end of the coil, `τ_S` at its ring end, `τ_in` = `τ_S`/k at the sun,
//! and `τ_in`/R − `τ_H` at the carrier. `docs/theory/lavt-closing.md`.

use std::f64::consts::TAU;

use forcewright_base::maths::exp;
use forcewright_elements::wrap_spring::{Model, WrapSpring};

use crate::design::{Built, Hand, Motor};
use crate::statics::Statics;

/// Places of the unknowns: angle and speed of sun and carrier, way of the finger, slip on the hub, then energies that have passed.
pub(super) const SUN: usize = 0;
pub(super) const SUN_RATE: usize = 1;
pub(super) const CARRIER: usize = 2;
pub(super) const CARRIER_RATE: usize = 3;
pub(super) const WAY: usize = 4;
pub(super) const SLIP: usize = 5;
pub(super) const ELECTRIC: usize = 6;
pub(super) const JOULE: usize = 7;
pub(super) const MOTOR: usize = 8;
pub(super) const HUB: usize = 9;
pub(super) const BORE: usize = 10;
pub(super) const OUTPUT: usize = 11;
/// Number of unknowns.
pub(super) const UNKNOWNS: usize = 12;

/// Largest exponent of the friction in the bore: beyond it a bore that holds and a rigid one differ by less than rounding shows.
const MOST_EXPONENT: f64 = 20.0;

/// Which way something turns.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Way {
    Back,
    Rest,
    Ahead,
}

impl Way {
    pub(super) fn sign(self) -> f64 {
        match self {
            Self::Back => -1.0,
            Self::Rest => 0.0,
            Self::Ahead => 1.0,
        }
    }
}

/// The coil on the hub.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum OnHub {
    Sticks,
    /// Slips in the sense that opens the coil, at `τ_b`.
    Opens,
    /// Slips in the other sense, at the torque at which it locks.
    Locks,
}

/// The coil in the bore.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum InBore {
    /// Not touched.
    Free,
    /// The ring stands.
    Sticks,
    /// The ring turns against the sense of the input.
    Back,
    /// The ring turns with the input, and the coil drags in the bore.
    Ahead,
}

/// What sticks, slips and touches. It changes at events only.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Modes {
    pub(super) sun: Way,
    pub(super) carrier: Way,
    pub(super) hub: OnHub,
    pub(super) bore: InBore,
    /// The electronics hold the current.
    pub(super) limited: bool,
    /// The finger touches the object.
    pub(super) touching: bool,
}

/// What couples sun and carrier.
#[derive(Clone, Copy, Debug)]
pub(super) struct Coupling {
    /// R.
    pub(super) ratio: f64,
    /// k = (1 − R)/R.
    pub(super) leverage: f64,
    /// Torque over winding of the free coil, N·m/rad; 0 without a coil.
    pub(super) rate_nm_per_rad: f64,
    pub(super) transition_nm: f64,
    pub(super) hub_nm: f64,
    pub(super) lock_nm: f64,
    /// exp(2π `N_B` μ).
    amplification: f64,
    paper: bool,
    /// Whether the bore can be reached.
    pub(super) grips: bool,
    proportional: [f64; 2],
    constant_nm: [f64; 2],
}

impl Coupling {
    /// A two-speed transmission; `None` for a coil without free turns.
    pub(super) fn two_speed(built: &Built, statics: &Statics, clutch: &WrapSpring) -> Option<Self> {
        let dead_rad = TAU * clutch.dead_turns();
        let [_, bore_friction] = built.friction;
        (dead_rad > 0.0).then(|| Self {
            ratio: statics.ratio,
            leverage: statics.leverage(),
            rate_nm_per_rad: statics.transition_nm / dead_rad,
            transition_nm: statics.transition_nm,
            hub_nm: statics.hub_nm,
            lock_nm: statics.lock_nm,
            amplification: exp((TAU * built.spring.bore_turns * bore_friction).min(MOST_EXPONENT)),
            paper: clutch.options().model == Model::Paper,
            grips: statics.grip_nm.is_some(),
            proportional: statics.proportional,
            constant_nm: statics.constant_nm,
        })
    }

    /// A reduction of one speed, `reduction` turns of the input for one of the output.
    pub(super) fn one_speed(reduction: f64, proportional: f64, constant_nm: f64) -> Self {
        let ratio = 1.0 / reduction;
        Self {
            ratio,
            leverage: (1.0 - ratio) / ratio,
            rate_nm_per_rad: 0.0,
            transition_nm: 0.0,
            hub_nm: 0.0,
            lock_nm: 0.0,
            amplification: 1.0,
            paper: false,
            grips: false,
            proportional: [proportional; 2],
            constant_nm: [constant_nm; 2],
        }
    }

    /// Whether there is a coil that slips and opens.
    pub(super) fn has_coil(&self) -> bool {
        self.rate_nm_per_rad > 0.0
    }

    /// Least and largest torque on the ring with which friction in the bore holds it, for a torque at the hub.
    pub(super) fn held_nm(&self, hub_nm: f64) -> [f64; 2] {
        let from_nm = self.transition_nm;
        if self.paper {
            return [from_nm, (hub_nm * (self.amplification - 1.0)).max(from_nm)];
        }
        let pressing_nm = (hub_nm - from_nm).max(0.0);
        [from_nm + pressing_nm / self.amplification, from_nm + pressing_nm * self.amplification]
    }

    /// Torque that is lost at the carrier.
    fn loss_nm(&self, input_nm: f64, engaged: bool) -> f64 {
        let (mode, geared_nm) = if engaged { (1, input_nm / self.ratio) } else { (0, input_nm) };
        self.proportional[mode] * geared_nm.abs() + self.constant_nm[mode]
    }
}

/// Motor, coupling, finger and object, SI.
#[derive(Clone, Debug)]
pub(super) struct Plant<'a> {
    pub(super) motor: &'a Motor,
    pub(super) hand: &'a Hand,
    pub(super) coupling: Coupling,
    /// K times the reduction of the motor.
    pub(super) torque_nm_per_a: f64,
    /// Friction of the motor at the sun.
    friction_nm: f64,
    /// Rotor at the sun, finger at the carrier.
    pub(super) sun_kg_m2: f64,
    pub(super) carrier_kg_m2: f64,
    opening_m: f64,
    /// Way to the object.
    pub(super) touch_m: f64,
    /// Stiffness of the object; 0 where it is not known.
    pub(super) object_n_per_m: f64,
}

/// Torques, accelerations and rates in a state.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Forces {
    pub(super) current_a: f64,
    /// Current that the voltage would drive.
    pub(super) wanted_a: f64,
    pub(super) input_nm: f64,
    pub(super) ring_nm: f64,
    pub(super) hub_nm: f64,
    /// Torque at the carrier before losses, and the losses.
    gross_nm: f64,
    loss_nm: f64,
    pub(super) sun_acceleration: f64,
    pub(super) carrier_acceleration: f64,
    /// Turning of the ring, rad/s.
    pub(super) ring_rate: f64,
    /// Way of the finger over turn of the carrier, m/rad, and the forces of glove and object, N.
    pub(super) lever_m: f64,
    elastic_n: f64,
}

impl<'a> Plant<'a> {
    /// `None` where inertias or the opening are not known.
    pub(super) fn new(motor: &'a Motor, hand: &'a Hand, coupling: Coupling) -> Option<Self> {
        let square = |x: f64| x * x;
        let opening_m = hand.opening_m?;
        Some(Self {
            motor,
            hand,
            coupling,
            torque_nm_per_a: motor.constant_nm_per_a * motor.reduction,
            friction_nm: motor.constant_nm_per_a * motor.reduction * motor.no_load_a,
            sun_kg_m2: motor.inertia_kg_m2? * square(motor.reduction),
            carrier_kg_m2: hand.inertia_kg_m2? / square(hand.reduction),
            opening_m,
            touch_m: (opening_m - hand.object_width_m).max(0.0),
            object_n_per_m: hand.object_n_per_m.unwrap_or(0.0),
        })
    }

    /// Speed of the sun without load with the voltage in the end, rad/s.
    pub(super) fn idle_rad_per_s(&self) -> f64 {
        self.motor.final_v() / self.torque_nm_per_a
    }

    /// Torque of the standing motor at the sun, N·m.
    pub(super) fn stall_nm(&self) -> f64 {
        self.torque_nm_per_a * (self.motor.final_v() / self.motor.resistance_ohm).min(self.motor.limit_a)
    }

    /// Force on the object, N.
    pub(super) fn object_n(&self, touching: bool, way_m: f64) -> f64 {
        if touching { self.object_n_per_m * (way_m - self.touch_m) } else { 0.0 }
    }

    /// Force at the finger that the transmission gives, N, without that of its inertia.
    pub(super) fn given_n(&self, modes: Modes, f: &Forces) -> f64 {
        let sign = modes.carrier.sign();
        let output_nm = f.gross_nm - sign * f.loss_nm;
        let efficiency = if output_nm * sign < 0.0 { 1.0 / self.hand.efficiency } else { self.hand.efficiency };
        output_nm * efficiency / f.lever_m
    }

    /// Surplus of torque that speeds the sun up, N·m, for a way of turning; losses oppose it.
    fn sun_net_nm(&self, way: Way, drive_nm: f64, input_nm: f64) -> f64 {
        let sign = way.sign();
        let efficiency = self.motor.efficiency;
        let share = if input_nm * sign > 0.0 { 1.0 / efficiency } else { efficiency };
        drive_nm - sign * self.friction_nm - share * input_nm
    }

    /// Input torques between which a standing sun stays: what it overcomes, and what overcomes it.
    fn sun_holds_nm(&self, drive_nm: f64) -> [f64; 2] {
        let efficiency = self.motor.efficiency;
        let scaled = |nm: f64, up: f64| if nm > 0.0 { nm * up } else { nm / up };
        [scaled(drive_nm - self.friction_nm, efficiency), scaled(drive_nm + self.friction_nm, 1.0 / efficiency)]
    }

    /// The same of the carrier.
    fn carrier_net_nm(&self, way: Way, gross_nm: f64, loss_nm: f64, forces: &Forces) -> f64 {
        let sign = way.sign();
        let output_nm = gross_nm - sign * loss_nm;
        let efficiency = self.hand.efficiency;
        let given_nm = if output_nm * sign > 0.0 { output_nm * efficiency } else { output_nm / efficiency };
        given_nm - forces.lever_m * (forces.elastic_n + sign * self.hand.glove_friction_n)
    }

    /// Surplus of torque at a carrier that begins to turn with this input torque. A reduction that holds alone is not turned back.
    fn carrier_start_nm(&self, way: Way, input_nm: f64, engaged: bool, forces: &Forces) -> f64 {
        if way == Way::Back && self.hand.non_backdrivable {
            return f64::INFINITY;
        }
        let gross_nm = self.gross_nm(input_nm, forces.hub_nm, engaged);
        self.carrier_net_nm(way, gross_nm, self.coupling.loss_nm(input_nm, engaged), forces)
    }

    fn gross_nm(&self, input_nm: f64, hub_nm: f64, engaged: bool) -> f64 {
        if engaged { input_nm / self.coupling.ratio - hub_nm } else { input_nm }
    }

    /// Torque at the hub end of the coil.
    pub(super) fn hub_nm(&self, modes: Modes, y: &[f64]) -> f64 {
        let coupling = &self.coupling;
        match modes.hub {
            _ if !coupling.has_coil() => 0.0,
            OnHub::Opens => coupling.hub_nm,
            OnHub::Locks => -coupling.lock_nm,
            OnHub::Sticks => coupling.rate_nm_per_rad * (self.winding_rad(y) - y[SLIP]),
        }
    }

    /// q, winding of the coil between ring and carrier.
    pub(super) fn winding_rad(&self, y: &[f64]) -> f64 {
        (y[SUN] - y[CARRIER]) / self.coupling.leverage
    }

    /// All torques and accelerations of a state.
    pub(super) fn forces(&self, modes: Modes, time_s: f64, y: &[f64]) -> Forces {
        let motor = self.motor;
        let limit_a = motor.limit_a;
        let wanted_a = (motor.supply_v(time_s) - self.torque_nm_per_a * y[SUN_RATE]) / motor.resistance_ohm;
        let current_a = if modes.limited { limit_a } else { wanted_a.clamp(-limit_a, limit_a) };
        let coupling = &self.coupling;
        let mut f = Forces {
            current_a,
            wanted_a,
            hub_nm: self.hub_nm(modes, y),
            ring_rate: if coupling.has_coil() { (y[CARRIER_RATE] - coupling.ratio * y[SUN_RATE]) / (1.0 - coupling.ratio) } else { 0.0 },
            lever_m: self.hand.lever.at_m(self.opening_m - y[WAY]) / self.hand.reduction,
            elastic_n: self.hand.glove_n_per_m * y[WAY] + self.object_n(modes.touching, y[WAY]),
            ..Forces::default()
        };
        let drive_nm = self.torque_nm_per_a * current_a;
        if modes.bore == InBore::Sticks {
            self.rigid(modes, drive_nm, &mut f);
            return f;
        }
        f.ring_nm = match modes.bore {
            InBore::Back => coupling.held_nm(f.hub_nm)[1],
            InBore::Ahead => coupling.held_nm(f.hub_nm)[0],
            _ => f.hub_nm,
        };
        let engaged = modes.bore != InBore::Free;
        f.input_nm = f.ring_nm / coupling.leverage;
        f.gross_nm = self.gross_nm(f.input_nm, f.hub_nm, engaged);
        f.loss_nm = coupling.loss_nm(f.input_nm, engaged);
        if modes.sun != Way::Rest {
            f.sun_acceleration = self.sun_net_nm(modes.sun, drive_nm, f.input_nm) / self.sun_kg_m2;
        }
        if modes.carrier != Way::Rest {
            f.carrier_acceleration = self.carrier_net_nm(modes.carrier, f.gross_nm, f.loss_nm, &f) / self.carrier_kg_m2;
        }
        f
    }

    /// The ring stands: sun and carrier turn as one, and the input torque is what makes them.
    fn rigid(&self, modes: Modes, drive_nm: f64, f: &mut Forces) {
        let coupling = &self.coupling;
        let way = modes.sun;
        if way == Way::Rest {
            // Between what the sun overcomes and what overcomes it everything is at rest: the least that holds.
            let [least, most] = coupling.held_nm(f.hub_nm).map(|nm| nm / coupling.leverage);
            let [low, _] = self.sun_holds_nm(drive_nm);
            f.input_nm = if coupling.has_coil() { low.clamp(least, most.max(least)) } else { low };
        } else {
            f.input_nm = self.rigid_input_nm(way, drive_nm, f);
            f.sun_acceleration = self.sun_net_nm(way, drive_nm, f.input_nm) / self.sun_kg_m2;
            f.carrier_acceleration = coupling.ratio * f.sun_acceleration;
        }
        f.ring_nm = coupling.leverage * f.input_nm;
        f.gross_nm = self.gross_nm(f.input_nm, f.hub_nm, true);
        f.loss_nm = coupling.loss_nm(f.input_nm, true);
    }

    /// Input torque with which the carrier keeps up with the sun. Both accelerations are straight in it between two bends: where the sun
    /// is driven instead of driving, and where the finger is.
    fn rigid_input_nm(&self, way: Way, drive_nm: f64, f: &Forces) -> f64 {
        let coupling = &self.coupling;
        let sign = way.sign();
        let excess = |input_nm: f64| {
            let gross_nm = self.gross_nm(input_nm, f.hub_nm, true);
            let carrier = self.carrier_net_nm(way, gross_nm, coupling.loss_nm(input_nm, true), f) / self.carrier_kg_m2;
            carrier - coupling.ratio * self.sun_net_nm(way, drive_nm, input_nm) / self.sun_kg_m2
        };
        let needed_nm = f.hub_nm + sign * coupling.constant_nm[1];
        let turned = coupling.ratio * needed_nm / (1.0 - sign * coupling.proportional[1] * needed_nm.signum());
        let (low, high) = (turned.min(0.0), turned.max(0.0));
        let span = self.stall_nm();
        let [at_low, at_high] = [excess(low), excess(high)];
        let (a, b) = if at_low >= 0.0 {
            ((low, at_low), (low - span, excess(low - span)))
        } else if at_high <= 0.0 {
            ((high, at_high), (high + span, excess(high + span)))
        } else {
            ((low, at_low), (high, at_high))
        };
        a.0 - a.1 * (b.0 - a.0) / (b.1 - a.1)
    }

    /// Above zero while a standing sun stays, where the ring is free to turn.
    pub(super) fn sun_stays_nm(&self, f: &Forces) -> [f64; 2] {
        let [low, high] = self.sun_holds_nm(self.torque_nm_per_a * f.current_a);
        [f.input_nm - low, high - f.input_nm]
    }

    /// Above zero while a standing carrier stays, where the ring is free to turn: against turning ahead, and back.
    pub(super) fn carrier_stays_nm(&self, modes: Modes, f: &Forces) -> [f64; 2] {
        let engaged = modes.bore != InBore::Free;
        [-self.carrier_start_nm(Way::Ahead, f.input_nm, engaged, f), self.carrier_start_nm(Way::Back, f.input_nm, engaged, f)]
    }

    /// Everything stands and the ring is held: above zero while nothing begins to turn. In this order: the carrier
    /// ahead, the carrier back, the sun ahead with the ring back, the sun back with the ring ahead.
    pub(super) fn all_stays_nm(&self, f: &Forces) -> [f64; 4] {
        let coupling = &self.coupling;
        let [low, high] = self.sun_holds_nm(self.torque_nm_per_a * f.current_a);
        let [least, most] = if coupling.has_coil() {
            coupling.held_nm(f.hub_nm).map(|nm| nm / coupling.leverage)
        } else {
            [f64::NEG_INFINITY, f64::INFINITY]
        };
        [
            -self.carrier_start_nm(Way::Ahead, low.max(least), true, f),
            self.carrier_start_nm(Way::Back, high.min(most), true, f),
            most - low,
            high - least,
        ]
    }

    /// How the carrier begins to turn from rest with a held ring: with the sun, or, where the sun stays, with the ring.
    pub(super) fn sun_follows(&self, f: &Forces, way: Way) -> bool {
        let coupling = &self.coupling;
        let [low, high] = self.sun_holds_nm(self.torque_nm_per_a * f.current_a);
        let [least, most] = coupling.held_nm(f.hub_nm).map(|nm| nm / coupling.leverage);
        !coupling.has_coil() || if way == Way::Ahead { low >= least } else { high <= most }
    }

    /// Rates of all unknowns.
    pub(super) fn rate(&self, modes: Modes, time_s: f64, y: &[f64], out: &mut [f64]) {
        let f = self.forces(modes, time_s, y);
        let (sun, carrier) = (y[SUN_RATE], y[CARRIER_RATE]);
        out[SUN] = sun;
        out[SUN_RATE] = f.sun_acceleration;
        out[CARRIER] = carrier;
        out[CARRIER_RATE] = f.carrier_acceleration;
        let way_rate = f.lever_m * carrier;
        out[WAY] = way_rate;
        let slips = modes.hub != OnHub::Sticks;
        out[SLIP] = if slips { carrier - f.ring_rate } else { 0.0 };
        let joule_w = self.motor.resistance_ohm * f.current_a * f.current_a;
        let shaft_w = self.torque_nm_per_a * f.current_a * sun;
        out[ELECTRIC] = joule_w + shaft_w;
        out[JOULE] = joule_w;
        // Each loss from its own law, not as a difference: their sum is then a check.
        let share = if f.input_nm * sun > 0.0 { 1.0 / self.motor.efficiency } else { self.motor.efficiency };
        out[MOTOR] = self.friction_nm * sun.abs() + (share - 1.0) * f.input_nm * sun;
        out[HUB] = f.hub_nm * out[SLIP];
        out[BORE] = if modes.bore == InBore::Free { 0.0 } else { (f.hub_nm - f.ring_nm) * f.ring_rate };
        let output_w = f.gross_nm * carrier - f.loss_nm * carrier.abs();
        let given_w = if output_w > 0.0 { output_w * self.hand.efficiency } else { output_w / self.hand.efficiency };
        out[OUTPUT] = f.loss_nm * carrier.abs() + (output_w - given_w) + self.hand.glove_friction_n * way_rate.abs();
    }
}
