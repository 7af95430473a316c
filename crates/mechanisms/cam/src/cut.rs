//! What a cam is cut for: the paths on which the centres of the two rollers have to run so that given springs give a given force.
//!
//! The parameter of the paths is λ, by how much both axles together have moved outwards since the start: between level axles the springs are
//! deformed by it. Each side is drawn in coordinates of its own: x outwards from the axis of the slider, y along its travel, so that both
//! sides look alike; their origins stand level.
//!
//! Without friction and with equal sides the work of the slider is the energy of the springs, W(s) = E(λ), and no differential equation is needed: with
//! constant force s = E/F (`docs/theory/cam.md`, eqs. 1–3). With friction in one direction, or where one side carries more of the force and
//! the springs slant, the balance of both rollers (eq. (2) of Sánchez-Salinas et al., in a form that is regular at the start) is integrated
//! once and tabulated.

use std::sync::Arc;

use crate::jet::Jet;
use crate::law::ForceLaw;
use crate::springs::Bank;
use crate::store::Store;
use crate::table::{Table, Way, start_without_locking};

/// Right and left.
pub const SIDES: usize = 2;

/// One side of the mechanism as it was designed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CutSide {
    /// Length l of the brace, m.
    pub brace_m: f64,
    /// Its part ϱ of the force on the slider; those of both sides add up to one.
    pub share: f64,
}

/// What the cam is cut for.
#[derive(Clone, Debug)]
pub struct Purpose {
    /// The force over the travel.
    pub law: ForceLaw,
    /// The springs that were meant.
    pub springs: Bank,
    /// Length of the springs at the start of the path, across the travel, m.
    pub start_length_m: f64,
    /// Right and left.
    pub sides: [CutSide; SIDES],
    /// Coefficient of rolling friction that is compensated: above zero the force is exact on the way up, below zero on the way down.
    pub friction: f64,
    /// Travel s for which the cam is cut, m.
    pub stroke_m: f64,
}

/// Why no path can be found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum CutError {
    /// At this travel a roller would be as far out as its brace is long, or in the middle: m.
    BraceTooShort {
        /// Travel reached, m.
        travel_m: f64,
    },
    /// At this travel friction locks the rollers in the direction that is compensated.
    Locks {
        /// Travel reached, m.
        travel_m: f64,
    },
    /// The springs do no work at the start or lose their force on the way.
    SpringsGiveNoForce {
        /// Travel reached, m.
        travel_m: f64,
    },
}

/// The paths of both rollers.
#[derive(Clone, Debug)]
pub struct Cut {
    purpose: Purpose,
    /// λ at the start of the paths and at the end of the stroke, m.
    range_m: [f64; 2],
    /// Height of the slider's joint at the start above the origin of both sides, m.
    rise_m: f64,
    /// Only with friction or unequal sides.
    table: Option<Arc<Table<3>>>,
}

/// A point of a path with its derivatives over λ.
#[derive(Clone, Copy, Debug)]
pub struct PathPoint {
    /// Outwards, m.
    pub x: Jet,
    /// Along the travel, m.
    pub y: Jet,
    /// Travel s of the slider that belongs to it, m.
    pub s: Jet,
}

/// s, ξ of the right, ξ of the left: ξ is the way outwards (inwards with compression springs) since the start.
type State = [f64; 3];

/// Steps of the table over the stroke.
pub(crate) const STEPS: usize = 1024;
/// How far the paths go on beyond the stroke, relative to it.
pub(crate) const BEYOND: f64 = 0.05;

impl Cut {
    /// Finds the paths.
    ///
    /// # Errors
    /// [`CutError`] says up to which travel there is one.
    pub fn new(purpose: Purpose) -> Result<Self, CutError> {
        let mut cut = Self { purpose, range_m: [0.0; 2], rise_m: 0.0, table: None };
        let nowhere = CutError::SpringsGiveNoForce { travel_m: 0.0 };
        let sense = cut.purpose.springs.sense();
        let force = sense * cut.purpose.springs.tension_n(cut.purpose.start_length_m)[0];
        if force < -1e-9 || force.is_nan() {
            return Err(nowhere);
        }
        if cut.purpose.friction < 0.0 {
            cut.range_m[0] = cut.start_without_locking().ok_or(nowhere)?;
        }
        for (i, side) in cut.purpose.sides.iter().enumerate() {
            let x = cut.outwards_m(i, cut.range_m[0]);
            if !(x > 0.0 && x < side.brace_m) {
                return Err(CutError::BraceTooShort { travel_m: 0.0 });
            }
            if i == 0 {
                cut.rise_m = (side.brace_m * side.brace_m - x * x).sqrt();
            }
        }
        let stroke = cut.purpose.stroke_m;
        let work = cut.purpose.law.work_j(stroke);
        let [right, left] = cut.purpose.sides;
        if cut.purpose.friction == 0.0 && right == left {
            cut.range_m[1] = cut.store().deformation_m(work).ok_or(CutError::SpringsGiveNoForce { travel_m: stroke })?;
            cut.within_braces(stroke)?;
        } else {
            let table = cut.integrate()?;
            cut.range_m[1] = table.first_at(stroke).unwrap_or(0.0);
            cut.table = Some(Arc::new(table));
        }
        Ok(cut)
    }

    /// What it was cut for.
    pub fn purpose(&self) -> &Purpose {
        &self.purpose
    }

    /// λ at the start of the path and at the end of the stroke, m.
    pub fn range_m(&self) -> [f64; 2] {
        self.range_m
    }

    /// Height of the slider's joint above the origin where s = 0: √(l² − x0²) of the right side, m.
    pub fn rise_m(&self) -> f64 {
        self.rise_m
    }

    /// The paths' point of one side with three derivatives over λ.
    #[inline]
    pub fn at(&self, side: usize, lambda_m: f64) -> PathPoint {
        let Purpose { springs, start_length_m, sides, .. } = &self.purpose;
        let sense = springs.sense();
        let CutSide { brace_m, share } = sides[side];
        let (s, x) = match &self.table {
            None => (
                self.store().travel(&self.purpose.law, lambda_m),
                Jet([0.5 * start_length_m + sense * share * lambda_m, sense * share, 0.0, 0.0]),
            ),
            Some(table) => {
                let [s, xi] = self.tabulated(table, side, lambda_m);
                (s, xi * sense + 0.5 * start_length_m)
            }
        };
        let rise = (x * x * -1.0 + brace_m * brace_m).sqrt();
        PathPoint { x, y: s - rise + self.rise_m, s }
    }

    /// λ at a travel of the mechanism as it was designed, m: where to look for the true one.
    pub fn expected_m(&self, travel_m: f64) -> f64 {
        match &self.table {
            None => self.store().deformation_m(self.purpose.law.work_j(travel_m.max(0.0))).unwrap_or(self.range_m[0]),
            Some(table) => table.inverse(travel_m),
        }
    }

    /// What [`Self::expected_m`] grows by per travel, at a travel and its λ: F/P, eq. (2), nearly so with friction. Not finite where the
    /// springs have no force.
    pub(crate) fn expected_slope(&self, travel_m: f64, lambda_m: f64) -> f64 {
        self.purpose.law.force_n(travel_m)[0] / self.store().force_n(lambda_m)[0]
    }

    /// Half the springs' length at the start and what the deformation adds to it on one side, m.
    fn outwards_m(&self, side: usize, lambda_m: f64) -> f64 {
        let p = &self.purpose;
        0.5 * p.start_length_m + p.springs.sense() * p.sides[side].share * lambda_m
    }

    fn store(&self) -> Store<'_> {
        Store { springs: &self.purpose.springs, start_length_m: self.purpose.start_length_m }
    }

    /// How much travel s each side gives per way outwards: g = (μ + f)/(1 − μ f) − t with t = σ tan α, from the balance of its roller, eqs. (4)
    /// and (4a) of `docs/theory/cam.md`. The springs pull level where both axles stand level, and then f = P/(ϱ F) + t; else the roller that stands higher is drawn down,
    ///
    /// f = (P cos β + ϱ F t)/(ϱ F ∓ σ P sin β).
    ///
    /// The first number is a factor of both that may vanish: without friction the force P of the springs, which is zero at the start of a path
    /// without preload.
    fn gears(&self, s: Jet, xi: [Jet; SIDES]) -> (Jet, [Jet; SIDES]) {
        let p = &self.purpose;
        let sense = p.springs.sense();
        let x = xi.map(|xi| xi * sense + 0.5 * p.start_length_m);
        let rise = [0, 1].map(|i| (x[i] * x[i] * -1.0 + p.sides[i].brace_m * p.sides[i].brace_m).sqrt());
        let (across, above) = (x[0] + x[1], rise[1] - rise[0]);
        let length = (across * across + above * above).sqrt();
        let [tension, rate] = p.springs.tension_n(length.value());
        let spring = ((length + -length.value()) * rate + tension) * sense;
        let [level, change] = p.law.force_n(s.value());
        let demanded = (s + -s.value()) * change + level;
        let sides = [0, 1].map(|i| {
            let slant = if i == 0 { sense } else { -sense };
            let t = x[i] / rise[i] * sense;
            let load = demanded * p.sides[i].share - spring * above / length * slant;
            // (f − t)/P
            let lift = (across + t * above * slant) / (length * load);
            if p.friction == 0.0 {
                return lift;
            }
            let f = spring * lift + t;
            (spring * lift + (f * t + 1.0) * p.friction) / (f * -p.friction + 1.0)
        });
        (if p.friction == 0.0 { spring } else { Jet::constant(1.0) }, sides)
    }

    /// Slopes of s and of both ξ over λ, which is the sum of both ξ.
    fn slopes_at(&self, [s, right, left]: [Jet; 3]) -> [Jet; 3] {
        let (factor, [r, l]) = self.gears(s, [right, left]);
        let sum = r + l;
        [factor * r * l / sum, l / sum, r / sum]
    }

    /// The least deformation at which both sides move the right way in spite of friction that is compensated on the way down.
    fn start_without_locking(&self) -> Option<f64> {
        let least = |lambda: f64| {
            let xi = self.purpose.sides.map(|side| Jet::constant(side.share * lambda));
            let (_, [right, left]) = self.gears(Jet::constant(0.0), xi);
            right.value().min(left.value())
        };
        start_without_locking(least, self.purpose.start_length_m)
    }

    /// Integrates up to a little beyond the stroke, with a row at every kink.
    fn integrate(&self) -> Result<Table<3>, CutError> {
        let end = (1.0 + BEYOND) * self.purpose.stroke_m;
        let energy = self.purpose.law.work_j(end) + self.store().energy_j(self.range_m[0]);
        let guess = self.store().deformation_m(energy).ok_or(CutError::SpringsGiveNoForce { travel_m: 0.0 })?;
        let step = (guess - self.range_m[0]) / STEPS as f64;
        let share = |side: usize| self.purpose.sides[side].share * self.range_m[0];
        let kinks: Vec<f64> = self.purpose.law.kinks_m().filter(|k| *k > 0.0).collect();
        let admit = |rows: usize, state: &State, next: &State| {
            let side_out = |i: usize| 0.5 * self.purpose.start_length_m + self.purpose.springs.sense() * next[1 + i];
            let fits = (0..SIDES).all(|i| side_out(i) > 0.0 && side_out(i) < self.purpose.sides[i].brace_m);
            if !fits {
                return Err(CutError::BraceTooShort { travel_m: state[0] });
            }
            // Rollers that hardly move the slider any more will not get it to the end.
            if next[0] <= state[0] || next[0].is_nan() || rows > 8 * STEPS {
                return Err(CutError::Locks { travel_m: state[0] });
            }
            Ok(())
        };
        let slopes = |_: f64, state: State| self.slopes_at(state.map(Jet::constant)).map(|slope| slope.value());
        Table::integrate(self.range_m[0], [0.0, share(0), share(1)], &Way { step, end, kinks: &kinks }, &slopes, admit)
    }

    /// s and ξ of a side with derivatives: values from the table, derivatives from the equation itself.
    fn tabulated(&self, table: &Table<3>, side: usize, lambda_m: f64) -> [Jet; 2] {
        let mut jets = table.at(lambda_m).map(Jet::constant);
        for order in 1..4 {
            let slopes = self.slopes_at(jets);
            for (jet, slope) in jets.iter_mut().zip(slopes) {
                jet.0[order] = slope.0[order - 1] / order as f64;
            }
        }
        [jets[0], jets[1 + side]]
    }

    fn within_braces(&self, stroke_m: f64) -> Result<(), CutError> {
        let reaches = |lambda: f64| {
            (0..SIDES).all(|i| {
                let x = self.outwards_m(i, lambda);
                x > 0.0 && x < self.purpose.sides[i].brace_m
            })
        };
        if reaches(self.range_m[1]) {
            return Ok(());
        }
        // The travel up to which it would do, by halving.
        let (mut low, mut high) = (0.0, stroke_m);
        for _ in 0..60 {
            let middle = f64::midpoint(low, high);
            let inside = self.store().deformation_m(self.purpose.law.work_j(middle)).is_some_and(reaches);
            (low, high) = if inside { (middle, high) } else { (low, middle) };
        }
        Err(CutError::BraceTooShort { travel_m: low })
    }
}
