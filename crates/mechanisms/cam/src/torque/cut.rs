//! What a torque cam is cut for: the path of a roller's centre on the disc, so that given springs give a given torque.
//!
//! The parameter is λ, by how much the springs are deformed beyond their length at the start, as for cams with a slider; both rollers share
//! it, ρ = ρ₀ + σλ/2. Without friction the work of the torque is the energy of the springs, ∫T dθ = E(λ), in closed form. With friction in
//! one direction the balance of the torques is integrated once and tabulated (`docs/theory/cam.md`, eqs. 13–16).

use std::sync::Arc;

use crate::cut::{BEYOND, STEPS};
use crate::jet::Jet;
use crate::law::ForceLaw;
use crate::path::{Place, place};
use crate::springs::Bank;
use crate::store::Store;
use crate::table::{Table, Way, start_without_locking};

/// What the disc is cut for.
#[derive(Clone, Debug)]
pub struct Purpose {
    /// The torque over the turn, N·m over rad: a law whose travel is an angle.
    pub law: ForceLaw,
    /// The springs that were meant.
    pub springs: Bank,
    /// Distance ρ₀ of the rollers' centres from the shaft's middle at the start, m: half the length of the springs there.
    pub start_radius_m: f64,
    /// Coefficient of rolling friction that is compensated: above zero the torque is exact on the way up, below zero on the way down.
    pub friction: f64,
    /// Friction of the guides that is compensated, of the same sign.
    pub guide_friction: f64,
    /// Turn θ for which the disc is cut, rad.
    pub turn_rad: f64,
}

/// Why no path can be found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum CutError {
    /// At this turn the rollers would meet in the middle: compression springs only, rad.
    Meets {
        /// Turn reached, rad.
        turn_rad: f64,
    },
    /// At this turn friction locks the disc in the direction that is compensated.
    Locks {
        /// Turn reached, rad.
        turn_rad: f64,
    },
    /// The springs do no work at the start or lose their force on the way.
    SpringsGiveNoForce {
        /// Zero where they give none at the start; else the turn whose work they do not store, rad.
        turn_rad: f64,
    },
}

/// The path of both rollers on the disc.
#[derive(Clone, Debug)]
pub struct Cut {
    purpose: Purpose,
    /// λ at the start of the path and at the end of the turn, m.
    range_m: [f64; 2],
    /// Only with friction.
    table: Option<Arc<Table<1>>>,
}

impl Cut {
    /// Finds the path.
    ///
    /// # Errors
    /// [`CutError`] says up to which turn there is one.
    pub fn new(purpose: Purpose) -> Result<Self, CutError> {
        let mut cut = Self { purpose, range_m: [0.0; 2], table: None };
        let nowhere = CutError::SpringsGiveNoForce { turn_rad: 0.0 };
        let [force, _] = cut.store().force_n(0.0);
        if force < -1e-9 || force.is_nan() {
            return Err(nowhere);
        }
        let Purpose { friction, guide_friction, turn_rad, .. } = cut.purpose;
        if friction < 0.0 || guide_friction < 0.0 {
            let gear = |lambda: f64| cut.gear(Jet::constant(lambda), Jet::constant(0.0)).value();
            cut.range_m[0] = start_without_locking(gear, 2.0 * cut.purpose.start_radius_m).ok_or(nowhere)?;
        }
        if friction == 0.0 && guide_friction == 0.0 {
            let work = cut.purpose.law.work_j(turn_rad);
            cut.range_m[1] = cut.store().deformation_m(work).ok_or(CutError::SpringsGiveNoForce { turn_rad })?;
            cut.apart()?;
        } else {
            let table = cut.integrate()?;
            cut.range_m[1] = table.first_at(turn_rad).unwrap_or(0.0);
            cut.table = Some(Arc::new(table));
            cut.range_m[1] = cut.expected_m(turn_rad);
        }
        Ok(cut)
    }

    /// What it was cut for.
    pub fn purpose(&self) -> &Purpose {
        &self.purpose
    }

    /// λ at the start of the path and at the end of the turn, m.
    pub fn range_m(&self) -> [f64; 2] {
        self.range_m
    }

    /// Sign of the side of the path on which the cam lies, as [`crate::frame`] and [`crate::curvature_per_m`] want it: the path is passed
    /// clockwise about the shaft.
    pub fn sense(&self) -> f64 {
        -self.purpose.springs.sense()
    }

    /// Turn θ of the disc and radius ρ of the rollers' centres, each with three derivatives over λ.
    pub fn at(&self, lambda_m: f64) -> [Jet; 2] {
        let half = 0.5 * self.purpose.springs.sense();
        let radius = Jet([self.purpose.start_radius_m + half * lambda_m, half, 0.0, 0.0]);
        let Some(table) = &self.table else { return [self.store().travel(&self.purpose.law, lambda_m), radius] };
        let lambda = Jet::variable(lambda_m);
        let mut turn = table.at(lambda_m).map(Jet::constant)[0];
        for order in 1..4 {
            turn.0[order] = self.gear(lambda, turn).0[order - 1] / order as f64;
        }
        [turn, radius]
    }

    /// The path in the coordinates of the disc, in which the disc's turn by θ carries the roller to the polar angle −θ.
    pub fn point(&self, lambda_m: f64) -> [Jet; 2] {
        let [turn, radius] = self.at(lambda_m);
        let [sin, cos] = turn.sin_cos();
        [radius * cos, -(radius * sin)]
    }

    /// The same as a place.
    pub fn place(&self, lambda_m: f64) -> Place {
        place(self.point(lambda_m))
    }

    /// λ at a turn of the disc as it was designed, m.
    pub fn expected_m(&self, turn_rad: f64) -> f64 {
        let Some(table) = &self.table else {
            return self.store().deformation_m(self.purpose.law.work_j(turn_rad.max(0.0))).unwrap_or(self.range_m[0]);
        };
        // Straight between the rows, and Newton's method from there.
        let mut lambda = table.inverse(turn_rad);
        for _ in 0..4 {
            let [turn, _] = self.at(lambda);
            let change = (turn.value() - turn_rad) / turn.derivative(1);
            if !change.is_finite() {
                break;
            }
            lambda -= change;
        }
        lambda
    }

    fn store(&self) -> Store<'_> {
        Store { springs: &self.purpose.springs, start_length_m: 2.0 * self.purpose.start_radius_m }
    }

    /// Turn per deformation with friction that is compensated: eq. (16) of `docs/theory/cam.md`.
    fn gear(&self, lambda: Jet, turn: Jet) -> Jet {
        let Purpose { friction, guide_friction, .. } = self.purpose;
        let radius = lambda * (0.5 * self.purpose.springs.sense()) + self.purpose.start_radius_m;
        let [force, rate] = self.store().force_n(lambda.value());
        let spring = (lambda + -lambda.value()) * rate + force;
        let [level, change] = self.purpose.law.force_n(turn.value());
        let torque = (turn + -turn.value()) * change + level;
        let arm = spring * radius * 2.0;
        (arm + torque * (friction + guide_friction)) / (radius * 2.0 * (torque * (1.0 - friction * guide_friction) - arm * friction))
    }

    /// Integrates up to a little beyond the turn, with a row at every kink.
    fn integrate(&self) -> Result<Table<1>, CutError> {
        let end = (1.0 + BEYOND) * self.purpose.turn_rad;
        let energy = self.purpose.law.work_j(end) + self.store().energy_j(self.range_m[0]);
        let guess = self.store().deformation_m(energy).ok_or(CutError::SpringsGiveNoForce { turn_rad: self.purpose.turn_rad })?;
        let step = (guess - self.range_m[0]) / STEPS as f64;
        let kinks: Vec<f64> = self.purpose.law.kinks_m().filter(|k| *k > 0.0).collect();
        let admit = |rows: usize, state: &[f64; 1], next: &[f64; 1]| {
            let most = 2.0 * self.purpose.start_radius_m;
            if self.purpose.springs.sense() < 0.0 && self.range_m[0] + rows as f64 * step >= most {
                return Err(CutError::Meets { turn_rad: state[0] });
            }
            if next[0] <= state[0] || next[0].is_nan() || rows > 8 * STEPS {
                return Err(CutError::Locks { turn_rad: state[0] });
            }
            Ok(())
        };
        let slopes = |at: f64, state: [f64; 1]| [self.gear(Jet::constant(at), Jet::constant(state[0])).value()];
        Table::integrate(self.range_m[0], [0.0], &Way { step, end, kinks: &kinks }, &slopes, admit)
    }

    /// Rollers that are pushed apart come closer: they must not meet.
    fn apart(&self) -> Result<(), CutError> {
        let fits = |lambda: f64| self.purpose.springs.sense() > 0.0 || lambda < 2.0 * self.purpose.start_radius_m;
        if fits(self.range_m[1]) {
            return Ok(());
        }
        let turn = |work: f64| self.purpose.law.place_m(work);
        Err(CutError::Meets { turn_rad: turn(self.store().energy_j(2.0 * self.purpose.start_radius_m)) })
    }
}
