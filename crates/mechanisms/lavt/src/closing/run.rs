//! From rest to the grasp: integration from event to event.

use forcewright_multibody::{Ended, OdeSettings, integrate};

use super::modes::{AT_CREEP, AT_TARGET, AT_TOUCH, System};
use super::plant::{
    BORE, CARRIER, CARRIER_RATE, ELECTRIC, HUB, InBore, JOULE, MOTOR, OUTPUT, OnHub, Plant, SLIP, SUN, SUN_RATE, UNKNOWNS, WAY, Way,
};
use super::{ClosingSettings, Ending, Energies, Grasp, Instant, Phase};

/// Times between states that are kept: at least this, s, and this part of the time passed.
const GRID_S: f64 = 2e-3;
const GRID: f64 = 0.01;
/// Longest stretch that is integrated at once, over the time passed, and its least, s: the first step goes with it.
const STRETCH: f64 = 0.5;
const LEAST_STRETCH_S: f64 = 0.1;
/// Most events of a closing.
const MOST_EVENTS: usize = 2000;

/// Closes the hand. `None` where the supply ends without voltage or a number makes no sense.
pub(super) fn closed(plant: &Plant<'_>, target_n: f64, settings: &ClosingSettings) -> Option<Grasp> {
    let coupling = &plant.coupling;
    let sound = plant.idle_rad_per_s() > 0.0
        && plant.stall_nm() > 0.0
        && plant.sun_kg_m2 > 0.0
        && plant.carrier_kg_m2 > 0.0
        && settings.accuracy > 0.0
        && settings.accuracy <= 1e-3
        && coupling.ratio.is_finite();
    sound.then(|| Run::new(plant, target_n, settings.accuracy).go(settings))
}

struct Run<'a> {
    system: System<'a>,
    y: [f64; UNKNOWNS],
    time_s: f64,
    grasp: Grasp,
}

impl<'a> Run<'a> {
    fn new(plant: &'a Plant<'a>, target_n: f64, accuracy: f64) -> Self {
        let grasp = Grasp {
            trace: Vec::with_capacity(512),
            phases: Vec::new(),
            touch_s: (plant.touch_m <= 0.0).then_some(0.0),
            shift_s: None,
            ending: Ending::Unfinished,
            energies: Energies::default(),
            changes: 0,
            evaluations: 0,
        };
        Self { system: System::new(plant, target_n, accuracy), y: [0.0; UNKNOWNS], time_s: 0.0, grasp }
    }

    fn go(mut self, settings: &ClosingSettings) -> Grasp {
        let sizes = self.sizes();
        let give_up_s = self.system.steady_s + settings.patience_s;
        let mut outputs_s = Vec::new();
        let mut agrees = self.system.settle(0.0, &mut self.y);
        self.keep_state();
        while agrees && self.time_s < give_up_s && self.grasp.changes < MOST_EVENTS {
            if self.system.stands(self.time_s) {
                self.grasp.ending = Ending::Stalled;
                break;
            }
            if self.system.has_crept(self.time_s, &self.y) {
                self.grasp.ending = if self.system.slips() { Ending::Slips } else { Ending::Stalled };
                break;
            }
            let end_s = self.stretch_end(give_up_s);
            self.outputs(end_s, &mut outputs_s);
            let ode = OdeSettings {
                start_s: self.time_s,
                end_s,
                accuracy: settings.accuracy,
                sizes: &sizes,
                outputs_s: &outputs_s,
                max_steps: settings.max_steps,
            };
            let run = integrate(&mut self.system, &self.y, &ode);
            self.grasp.evaluations += run.evaluations;
            for (time_s, state) in &run.kept {
                let instant = self.instant(*time_s, state);
                self.grasp.trace.push(instant);
            }
            self.y.copy_from_slice(&run.state);
            self.time_s = run.time_s;
            match run.ended {
                Ended::Time => agrees = self.system.settle(self.time_s, &mut self.y),
                Ended::Event(index) => {
                    self.keep_state();
                    if let Some(ending) = self.ends(index) {
                        self.grasp.ending = ending;
                        break;
                    }
                    agrees = self.switched(index);
                }
                Ended::Failed(_) | Ended::Steps | Ended::Settings => break,
            }
            self.note_phase();
        }
        self.keep_state();
        self.grasp.energies = self.energies();
        self.grasp
    }

    /// What an event ends.
    fn ends(&mut self, index: usize) -> Option<Ending> {
        match index {
            AT_TARGET => Some(Ending::Reached),
            AT_CREEP if self.system.slips() => Some(Ending::Slips),
            AT_CREEP => Some(Ending::Stalled),
            AT_TOUCH if !self.system.modes.touching => {
                self.grasp.touch_s.get_or_insert(self.time_s);
                (self.system.plant.object_n_per_m <= 0.0).then_some(Ending::Touched)
            }
            _ => None,
        }
    }

    fn switched(&mut self, index: usize) -> bool {
        let before = self.system.modes;
        let agrees = self.system.switch(index, self.time_s, &mut self.y);
        let after = self.system.modes;
        let mechanical = |m: super::plant::Modes| (m.sun, m.carrier, m.hub, m.bore);
        self.grasp.changes += usize::from(mechanical(before) != mechanical(after));
        if before.bore == InBore::Free && after.bore != InBore::Free {
            self.grasp.shift_s.get_or_insert(self.time_s);
        }
        self.keep_state();
        agrees
    }

    fn phase(&self) -> Phase {
        let modes = &self.system.modes;
        if modes.sun == Way::Rest && modes.carrier == Way::Rest {
            return Phase::Stands;
        }
        if !self.system.plant.coupling.has_coil() {
            return Phase::OneSpeed;
        }
        match (modes.bore, modes.hub) {
            (InBore::Free, OnHub::Sticks) => Phase::ModeI,
            (InBore::Free, _) => Phase::SlipsOnHub,
            (InBore::Sticks, _) => Phase::ModeII,
            (InBore::Back, OnHub::Opens) => Phase::SlipsInBore,
            _ => Phase::Shifts,
        }
    }

    fn note_phase(&mut self) {
        let phase = self.phase();
        if self.grasp.phases.last().is_none_or(|(_, last)| *last != phase) {
            self.grasp.phases.push((self.time_s, phase));
        }
    }

    fn keep_state(&mut self) {
        let instant = self.instant(self.time_s, &self.y);
        self.grasp.trace.push(instant);
        self.note_phase();
    }

    fn instant(&self, time_s: f64, y: &[f64]) -> Instant {
        let System { plant, modes, .. } = &self.system;
        let f = plant.forces(*modes, time_s, y);
        let slope = plant.motor.supply_slope(time_s);
        let limited = modes.limited || f.wanted_a.abs() > plant.motor.limit_a;
        let back_emf_rate = plant.torque_nm_per_a * f.sun_acceleration;
        Instant {
            time_s,
            phase: self.phase(),
            current_a: f.current_a,
            current_rate: if limited { 0.0 } else { (slope - back_emf_rate) / plant.motor.resistance_ohm },
            input_rad_per_s: y[SUN_RATE],
            input_rate: f.sun_acceleration,
            output_rad_per_s: y[CARRIER_RATE],
            input_nm: f.input_nm,
            hub_nm: f.hub_nm,
            way_m: y[WAY],
            way_rate: f.lever_m * y[CARRIER_RATE],
            force_n: plant.object_n(modes.touching, y[WAY]),
            electric_j: y[ELECTRIC],
            electric_w: (plant.motor.resistance_ohm * f.current_a + plant.torque_nm_per_a * y[SUN_RATE]) * f.current_a,
        }
    }

    /// Sizes that matter of the unknowns.
    fn sizes(&self) -> [f64; UNKNOWNS] {
        let plant = self.system.plant;
        let idle = plant.idle_rad_per_s();
        let coil_rad = if plant.coupling.has_coil() {
            plant.coupling.transition_nm / plant.coupling.rate_nm_per_rad
        } else {
            idle * self.system.response_s
        };
        let mut sizes = [plant.sun_kg_m2 * idle * idle; UNKNOWNS];
        sizes[SUN] = coil_rad * plant.coupling.leverage.max(1.0);
        sizes[CARRIER] = sizes[SUN];
        (sizes[SUN_RATE], sizes[CARRIER_RATE]) = (idle, idle);
        sizes[WAY] = plant.touch_m.max(1e-3);
        sizes[SLIP] = coil_rad;
        sizes
    }

    /// Up to the next bend of the supply, or a stretch.
    fn stretch_end(&self, give_up_s: f64) -> f64 {
        let end_s = (self.time_s + (STRETCH * self.time_s).max(LEAST_STRETCH_S)).min(give_up_s);
        let bends = self.system.plant.motor.supply.iter().map(|p| p[0]);
        bends.filter(|t| *t > self.time_s).fold(end_s, f64::min)
    }

    /// Times at which states are kept.
    fn outputs(&self, end_s: f64, outputs_s: &mut Vec<f64>) {
        outputs_s.clear();
        let mut next_s = self.time_s;
        loop {
            next_s += GRID_S.max(GRID * next_s);
            if next_s >= end_s {
                return;
            }
            outputs_s.push(next_s);
        }
    }

    fn energies(&self) -> Energies {
        let (y, plant) = (&self.y, self.system.plant);
        let half = |factor: f64, x: f64| 0.5 * factor * x * x;
        let coil_rad = if plant.coupling.has_coil() { plant.winding_rad(y) - y[SLIP] } else { 0.0 };
        let pressed_m = if self.system.modes.touching { y[WAY] - plant.touch_m } else { 0.0 };
        Energies {
            electric: y[ELECTRIC],
            joule: y[JOULE],
            motor: y[MOTOR],
            hub: y[HUB],
            bore: y[BORE],
            output: y[OUTPUT],
            kinetic: half(plant.sun_kg_m2, y[SUN_RATE]) + half(plant.carrier_kg_m2, y[CARRIER_RATE]),
            elastic: half(plant.coupling.rate_nm_per_rad, coil_rad) + half(plant.hand.glove_n_per_m, y[WAY]),
            object: half(plant.object_n_per_m, pressed_m),
        }
    }
}
