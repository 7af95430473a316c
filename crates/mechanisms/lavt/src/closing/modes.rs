//! What sticks, slips and touches, and the events at which that changes. Each state keeps until its own event, so nothing chatters.

use std::convert::Infallible;

use forcewright_multibody::Ode;

use super::plant::{CARRIER_RATE, Forces, InBore, Modes, OnHub, Plant, SLIP, SUN_RATE, UNKNOWNS, WAY, Way};

/// Events by index.
const AT_SUN: usize = 0;
const AT_CARRIER: usize = 1;
const AT_HUB: usize = 2;
const AT_BORE: usize = 3;
const AT_RELEASE: usize = 4;
pub(super) const AT_LIMIT: usize = 5;
pub(super) const AT_TOUCH: usize = 6;
pub(super) const AT_TARGET: usize = 7;
pub(super) const AT_CREEP: usize = 8;
const EVENTS: usize = 9;
/// Those that change what sticks and slips.
const SWITCHES: usize = 5;

/// Part of the speed without load below which a motor stands.
const CREEP: f64 = 1e-5;
/// Rounding of torques and speeds relative to their sizes, and what an event may be off by, over the accuracy.
const ROUNDING: f64 = 1e-11;
const EVENT_ERROR: f64 = 0.1;
/// Torque that anything at rest bears, over that of the standing motor.
const GRAIN: f64 = 1e-9;
/// Most changes that one event may bring with it.
const MOST_CHANGES: usize = 16;
/// Time by which a state is moved on to see where it goes, over that of the motor.
const AHEAD: f64 = 1e-7;

/// The equations with their modes.
pub(super) struct System<'a> {
    pub(super) plant: &'a Plant<'a>,
    pub(super) modes: Modes,
    /// Force at which the grasp is done, N.
    pub(super) target_n: f64,
    /// Time from which on the voltage stays, s.
    pub(super) steady_s: f64,
    idle_rad_per_s: f64,
    torque_nm: f64,
    rounding: f64,
    /// Time in which the motor follows a voltage, s.
    pub(super) response_s: f64,
}

impl Ode for System<'_> {
    type Error = Infallible;

    fn rate(&mut self, time_s: f64, y: &[f64], out: &mut [f64]) -> Result<(), Infallible> {
        self.plant.rate(self.modes, time_s, y, out);
        Ok(())
    }

    fn events(&self) -> usize {
        EVENTS
    }

    fn event(&mut self, index: usize, time_s: f64, y: &[f64]) -> f64 {
        self.guard(index, time_s, y)
    }
}

/// The smaller number; of nothing, nothing.
fn least(values: &[f64]) -> f64 {
    values.iter().copied().fold(f64::INFINITY, f64::min)
}

/// Index of the smallest.
fn first_of(values: &[f64]) -> usize {
    let all = values.iter().enumerate();
    all.min_by(|a, b| a.1.total_cmp(b.1)).map_or(0, |(i, _)| i)
}

impl<'a> System<'a> {
    pub(super) fn new(plant: &'a Plant<'a>, target_n: f64, accuracy: f64) -> Self {
        let motor = plant.motor;
        let bore = if plant.coupling.has_coil() { InBore::Free } else { InBore::Sticks };
        let response_s = plant.sun_kg_m2 * motor.resistance_ohm / (plant.torque_nm_per_a * plant.torque_nm_per_a);
        Self {
            plant,
            modes: Modes { sun: Way::Rest, carrier: Way::Rest, hub: OnHub::Sticks, bore, limited: false, touching: plant.touch_m <= 0.0 },
            target_n,
            steady_s: motor.supply.last().map_or(0.0, |p| p[0]).max(0.0),
            idle_rad_per_s: plant.idle_rad_per_s(),
            torque_nm: plant.stall_nm(),
            rounding: ROUNDING.max(EVENT_ERROR * accuracy),
            response_s,
        }
    }

    fn forces(&self, time_s: f64, y: &[f64]) -> Forces {
        self.plant.forces(self.modes, time_s, y)
    }

    /// Above zero while nothing changes.
    fn guard(&self, index: usize, time_s: f64, y: &[f64]) -> f64 {
        let Modes { sun, carrier, hub, bore, limited, touching } = self.modes;
        let coupling = &self.plant.coupling;
        let f = || self.forces(time_s, y);
        let sticks = bore == InBore::Sticks;
        match index {
            AT_SUN if sun != Way::Rest => sun.sign() * y[SUN_RATE],
            AT_SUN if sticks => least(&self.plant.all_stays_nm(&f())) + self.grain_nm(),
            AT_SUN => least(&self.plant.sun_stays_nm(&f())) + self.grain_nm(),
            AT_CARRIER if sticks => f64::NAN,
            AT_CARRIER if carrier != Way::Rest => carrier.sign() * y[CARRIER_RATE],
            AT_CARRIER => least(&self.plant.carrier_stays_nm(self.modes, &f())) + self.grain_nm(),
            AT_HUB | AT_BORE | AT_RELEASE if !coupling.has_coil() => f64::NAN,
            AT_HUB => match hub {
                OnHub::Sticks => least(&self.hub_stays_nm(y)),
                OnHub::Opens => y[CARRIER_RATE] - f().ring_rate,
                OnHub::Locks => f().ring_rate - y[CARRIER_RATE],
            },
            AT_BORE => match bore {
                InBore::Free if coupling.grips => coupling.transition_nm - self.plant.hub_nm(self.modes, y),
                InBore::Free => f64::NAN,
                InBore::Back => -f().ring_rate,
                InBore::Ahead => f().ring_rate,
                InBore::Sticks if sun == Way::Rest => f64::NAN,
                InBore::Sticks => least(&self.bore_stays_nm(&f())) + self.grain_nm(),
            },
            AT_RELEASE if bore == InBore::Free => f64::NAN,
            AT_RELEASE => self.plant.hub_nm(self.modes, y) - coupling.transition_nm,
            AT_LIMIT => {
                let room_a = self.plant.motor.limit_a - f().wanted_a;
                if limited { -room_a } else { room_a }
            }
            AT_TOUCH => {
                let left_m = self.plant.touch_m - y[WAY];
                if touching { -left_m } else { left_m }
            }
            // An impact is no grasp: the transmission must give the force, too.
            AT_TARGET if touching => self.target_n - self.plant.object_n(touching, y[WAY]).min(self.plant.given_n(self.modes, &f())),
            AT_TARGET => f64::NAN,
            _ => self.creep(time_s, y, &f()),
        }
    }

    /// Torque that anything at rest bears: without it what has no friction would leave its rest from a guard of zero, which is no event.
    fn grain_nm(&self) -> f64 {
        GRAIN * self.torque_nm
    }

    /// Speeds, and what they gain in the time of the motor, over the speed without load.
    fn creep(&self, time_s: f64, y: &[f64], f: &Forces) -> f64 {
        if time_s < self.steady_s || self.modes.sun == Way::Rest {
            return f64::NAN;
        }
        let gain = (f.sun_acceleration * self.response_s).abs();
        let drift = y[CARRIER_RATE].abs().max((f.carrier_acceleration * self.response_s).abs());
        let turning = if self.slips() { 0.0 } else { y[SUN_RATE].abs() };
        turning.max(gain).max(drift) / self.idle_rad_per_s - CREEP
    }

    /// Whether it creeps already, as where a change brought everything but the sun to rest.
    pub(super) fn has_crept(&self, time_s: f64, y: &[f64]) -> bool {
        self.creep(time_s, y, &self.forces(time_s, y)) <= 0.0
    }

    /// Whether the clutch lets the sun turn while the carrier stands.
    pub(super) fn slips(&self) -> bool {
        self.modes.hub == OnHub::Opens && self.modes.bore != InBore::Sticks
    }

    fn hub_stays_nm(&self, y: &[f64]) -> [f64; 2] {
        let hub_nm = self.plant.hub_nm(self.modes, y);
        [self.plant.coupling.hub_nm - hub_nm, self.plant.coupling.lock_nm + hub_nm]
    }

    fn bore_stays_nm(&self, f: &Forces) -> [f64; 2] {
        let [low, high] = self.plant.coupling.held_nm(f.hub_nm);
        [high - f.ring_nm, f.ring_nm - low]
    }

    /// Whether everything stands and nothing will change that.
    pub(super) fn stands(&self, time_s: f64) -> bool {
        self.modes.sun == Way::Rest && self.modes.carrier == Way::Rest && time_s >= self.steady_s
    }

    /// What follows from an event, until the state agrees with itself. False where it does not.
    pub(super) fn switch(&mut self, index: usize, time_s: f64, y: &mut [f64]) -> bool {
        match index {
            AT_LIMIT => self.modes.limited = !self.modes.limited,
            AT_TOUCH => self.modes.touching = !self.modes.touching,
            _ => self.change(index, time_s, y),
        }
        self.settle(time_s, y)
    }

    /// Changes what the state contradicts.
    pub(super) fn settle(&mut self, time_s: f64, y: &mut [f64]) -> bool {
        for _ in 0..MOST_CHANGES {
            self.modes.limited = self.is_limited(time_s, y);
            let at_rest = self.modes.sun == Way::Rest && self.modes.carrier == Way::Rest;
            if at_rest && matches!(self.modes.bore, InBore::Back | InBore::Ahead) {
                self.modes.bore = InBore::Sticks;
            }
            let Some(index) = (0..SWITCHES).find(|i| self.contradicts(*i, time_s, y)) else { return true };
            self.change(index, time_s, y);
        }
        false
    }

    fn is_limited(&self, time_s: f64, y: &[f64]) -> bool {
        let room_a = self.plant.motor.limit_a - self.forces(time_s, y).wanted_a;
        // At the limit itself what was decided stays.
        if room_a.abs() <= ROUNDING * self.plant.motor.limit_a { self.modes.limited } else { room_a < 0.0 }
    }

    /// Whether a guard is below zero, or at zero and about to fall.
    fn contradicts(&self, index: usize, time_s: f64, y: &[f64]) -> bool {
        let now = self.guard(index, time_s, y);
        let speed = matches!(
            (index, self.modes.sun, self.modes.carrier, self.modes.hub, self.modes.bore),
            (AT_SUN, Way::Back | Way::Ahead, _, _, _)
                | (AT_CARRIER, _, Way::Back | Way::Ahead, _, _)
                | (AT_HUB, _, _, OnHub::Opens | OnHub::Locks, _)
                | (AT_BORE, _, _, _, InBore::Back | InBore::Ahead)
        );
        let small = self.rounding * if speed { self.idle_rad_per_s } else { self.torque_nm };
        if now.is_nan() || now > small {
            return false;
        }
        if now < -small {
            return true;
        }
        let mut rate = [0.0; UNKNOWNS];
        self.plant.rate(self.modes, time_s, y, &mut rate);
        let step_s = AHEAD * self.response_s;
        let mut moved = [0.0; UNKNOWNS];
        for (m, (y, r)) in moved.iter_mut().zip(y.iter().zip(&rate)) {
            *m = y + step_s * r;
        }
        let next = self.guard(index, time_s + step_s, &moved);
        next < now.min(0.0) - 1e-4 * ROUNDING * if speed { self.idle_rad_per_s } else { self.torque_nm }
    }

    /// The change that an event brings.
    fn change(&mut self, index: usize, time_s: f64, y: &mut [f64]) {
        let f = self.forces(time_s, y);
        let sticks = self.modes.bore == InBore::Sticks;
        match index {
            AT_SUN if self.modes.sun != Way::Rest => {
                (self.modes.sun, y[SUN_RATE]) = (Way::Rest, 0.0);
                if sticks {
                    (self.modes.carrier, y[CARRIER_RATE]) = (Way::Rest, 0.0);
                }
            }
            AT_SUN if sticks => self.start(&f),
            AT_SUN => self.modes.sun = [Way::Ahead, Way::Back][first_of(&self.plant.sun_stays_nm(&f))],
            AT_CARRIER if self.modes.carrier != Way::Rest => (self.modes.carrier, y[CARRIER_RATE]) = (Way::Rest, 0.0),
            AT_CARRIER => self.modes.carrier = [Way::Ahead, Way::Back][first_of(&self.plant.carrier_stays_nm(self.modes, &f))],
            AT_HUB => self.change_hub(&f, y),
            AT_BORE => self.change_bore(&f, y),
            AT_RELEASE => self.modes.bore = InBore::Free,
            _ => {}
        }
    }

    /// From rest with a held ring.
    fn start(&mut self, f: &Forces) {
        match first_of(&self.plant.all_stays_nm(f)) {
            0 if self.plant.sun_follows(f, Way::Ahead) => (self.modes.sun, self.modes.carrier) = (Way::Ahead, Way::Ahead),
            0 => (self.modes.carrier, self.modes.bore) = (Way::Ahead, InBore::Ahead),
            1 if self.plant.sun_follows(f, Way::Back) => (self.modes.sun, self.modes.carrier) = (Way::Back, Way::Back),
            1 => (self.modes.carrier, self.modes.bore) = (Way::Back, InBore::Back),
            2 => (self.modes.sun, self.modes.bore) = (Way::Ahead, InBore::Back),
            _ => (self.modes.sun, self.modes.bore) = (Way::Back, InBore::Ahead),
        }
    }

    fn change_hub(&mut self, f: &Forces, y: &mut [f64]) {
        let coupling = &self.plant.coupling;
        let winding_rad = self.plant.winding_rad(y);
        // Exactly at the torque of slip, so that nothing jumps.
        let opened_rad = winding_rad - coupling.hub_nm / coupling.rate_nm_per_rad;
        match self.modes.hub {
            OnHub::Sticks if first_of(&self.hub_stays_nm(y)) == 0 => {
                (self.modes.hub, y[SLIP]) = (OnHub::Opens, opened_rad);
                // Where both torques are equal, as the paper has it in its first configuration, it is a shift.
                if self.modes.bore == InBore::Free && coupling.grips && coupling.hub_nm <= coupling.transition_nm {
                    self.modes.bore = if f.ring_rate > 0.0 { InBore::Ahead } else { InBore::Back };
                }
            }
            OnHub::Sticks => (self.modes.hub, y[SLIP]) = (OnHub::Locks, winding_rad + coupling.lock_nm / coupling.rate_nm_per_rad),
            OnHub::Opens => {
                (self.modes.hub, y[SLIP]) = (OnHub::Sticks, opened_rad);
                if coupling.hub_nm <= coupling.transition_nm {
                    self.modes.bore = InBore::Free;
                }
            }
            OnHub::Locks => (self.modes.hub, y[SLIP]) = (OnHub::Sticks, winding_rad + coupling.lock_nm / coupling.rate_nm_per_rad),
        }
    }

    fn change_bore(&mut self, f: &Forces, y: &mut [f64]) {
        self.modes.bore = match self.modes.bore {
            InBore::Free if f.ring_rate > 0.0 => InBore::Ahead,
            InBore::Free => InBore::Back,
            InBore::Sticks => [InBore::Back, InBore::Ahead][first_of(&self.bore_stays_nm(f))],
            InBore::Back | InBore::Ahead => {
                let rest = self.modes.sun == Way::Rest || self.modes.carrier == Way::Rest;
                if rest {
                    (self.modes.sun, self.modes.carrier) = (Way::Rest, Way::Rest);
                    (y[SUN_RATE], y[CARRIER_RATE]) = (0.0, 0.0);
                } else {
                    y[CARRIER_RATE] = self.plant.coupling.ratio * y[SUN_RATE];
                }
                InBore::Sticks
            }
        };
    }
}
