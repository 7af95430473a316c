//! What a cam is cut for: the paths on which the centres of the two rollers have to run so that given springs give a given force.
//!
//! The parameter of the paths is λ, by how much the springs are deformed beyond their length at the start. Each side is drawn in
//! coordinates of its own: x outwards from the axis of the slider, y along its travel, so that both sides look alike.
//!
//! Without friction the work of the slider is the energy of the springs, W(s) = E(λ), and no differential equation is needed: with
//! constant force s = E/F (`docs/theory/cam.md`, eqs. 1–3). With friction in one direction the equation (2) of Sánchez-Salinas et al.,
//! in the form that is regular at the start, is integrated once and tabulated.

use std::sync::Arc;

use forcewright_base::roots;

use crate::jet::Jet;
use crate::law::ForceLaw;
use crate::springs::Bank;

/// Right and left.
pub const SIDES: usize = 2;

/// One side of the mechanism as it was designed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CutSide {
    /// Length l of the brace, m.
    pub brace_m: f64,
    /// Its part of the springs' deformation; those of both sides add up to one.
    pub share: f64,
}

/// What the cam is cut for.
#[derive(Clone, Debug)]
pub struct Purpose {
    /// The force over the travel.
    pub law: ForceLaw,
    /// The springs that were meant.
    pub springs: Bank,
    /// Length of the springs at the start of the path, m.
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
    /// √(l² − x²) of each side at the start, m.
    rise_m: [f64; SIDES],
    /// Only with friction.
    table: Option<Arc<Table>>,
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

/// Solution of the differential equation: λ; s and its slope; ξ and its slope for both sides.
#[derive(Debug)]
struct Table {
    rows: Vec<Row>,
}

#[derive(Clone, Copy, Debug)]
struct Row {
    at: f64,
    value: State,
    slope: State,
}

/// s, ξ of the right, ξ of the left: ξ is the way outwards (inwards with compression springs) since the start.
type State = [f64; 3];

/// Steps of the table over the stroke.
const STEPS: usize = 1024;
/// How far the paths go on beyond the stroke, relative to it.
const BEYOND: f64 = 0.05;

impl Cut {
    /// Finds the paths.
    ///
    /// # Errors
    /// [`CutError`] says up to which travel there is one.
    pub fn new(purpose: Purpose) -> Result<Self, CutError> {
        let mut cut = Self { purpose, range_m: [0.0; 2], rise_m: [0.0; SIDES], table: None };
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
            cut.rise_m[i] = (side.brace_m * side.brace_m - x * x).sqrt();
        }
        let stroke = cut.purpose.stroke_m;
        let work = cut.purpose.law.work_j(stroke);
        if cut.purpose.friction == 0.0 {
            cut.range_m[1] = cut.deformation_m(work).ok_or(CutError::SpringsGiveNoForce { travel_m: stroke })?;
            cut.within_braces(stroke)?;
        } else {
            let table = cut.integrate()?;
            cut.range_m[1] = table.rows.iter().find(|r| r.value[0] >= stroke).map_or(0.0, |r| r.at);
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

    /// Height of the slider's joint above the origin of a side where s = 0: √(l² − x0²), m.
    pub fn rise_m(&self, side: usize) -> f64 {
        self.rise_m[side]
    }

    /// The paths' point of one side with three derivatives over λ.
    #[inline]
    pub fn at(&self, side: usize, lambda_m: f64) -> PathPoint {
        let Purpose { springs, start_length_m, sides, .. } = &self.purpose;
        let sense = springs.sense();
        let CutSide { brace_m, share } = sides[side];
        let (s, x) = match &self.table {
            None => (self.travel(lambda_m), Jet([0.5 * start_length_m + sense * share * lambda_m, sense * share, 0.0, 0.0])),
            Some(table) => {
                let [s, xi] = self.tabulated(table, side, lambda_m);
                (s, xi * sense + 0.5 * start_length_m)
            }
        };
        let rise = (x * x * -1.0 + brace_m * brace_m).sqrt();
        PathPoint { x, y: s - rise + self.rise_m[side], s }
    }

    /// λ at a travel of the mechanism as it was designed, m: where to look for the true one.
    pub fn expected_m(&self, travel_m: f64) -> f64 {
        match &self.table {
            None => self.deformation_m(self.purpose.law.work_j(travel_m.max(0.0))).unwrap_or(self.range_m[0]),
            Some(table) => table.inverse(travel_m),
        }
    }

    /// What [`Self::expected_m`] grows by per travel, at a travel and its λ: F/P, eq. (2), nearly so with friction. Not finite where the
    /// springs have no force.
    pub(crate) fn expected_slope(&self, travel_m: f64, lambda_m: f64) -> f64 {
        self.purpose.law.force_n(travel_m)[0] / self.spring_n(lambda_m)[0]
    }

    /// Half the springs' length at the start and what the deformation adds to it on one side, m.
    fn outwards_m(&self, side: usize, lambda_m: f64) -> f64 {
        let p = &self.purpose;
        0.5 * p.start_length_m + p.springs.sense() * p.sides[side].share * lambda_m
    }

    /// Force P of the springs where they are deformed by λ, and its slope.
    fn spring_n(&self, lambda_m: f64) -> [f64; 2] {
        let sense = self.purpose.springs.sense();
        let [tension, rate] = self.purpose.springs.tension_n(self.purpose.start_length_m + sense * lambda_m);
        [sense * tension, rate]
    }

    /// Energy of the springs beyond that at the start, J.
    fn energy_j(&self, lambda_m: f64) -> f64 {
        let start = self.purpose.start_length_m;
        self.purpose.springs.energy_j(start, start + self.purpose.springs.sense() * lambda_m)
    }

    /// The deformation at which so much energy is stored, m.
    fn deformation_m(&self, energy_j: f64) -> Option<f64> {
        if energy_j <= 0.0 {
            return Some(0.0);
        }
        if self.purpose.springs.is_straight() {
            let [force, rate] = self.spring_n(0.0);
            let force = force.max(0.0);
            let discriminant = force * force + 2.0 * rate * energy_j;
            return Some(2.0 * energy_j / (force + discriminant.max(0.0).sqrt())).filter(|l| l.is_finite() && discriminant >= 0.0);
        }
        let mut most = 0.1 * self.purpose.start_length_m;
        let far = 20.0 * self.purpose.start_length_m;
        while self.energy_j(most) < energy_j {
            most *= 2.0;
            if most > far {
                return None;
            }
        }
        let guess = roots::root(|l| self.energy_j(l) - energy_j, 0.0, most, 1e-14).ok()?;
        Some(guess)
    }

    /// Travel over deformation without friction: W(s) = E(λ), s′ = P/F(s).
    #[inline]
    fn travel(&self, lambda_m: f64) -> Jet {
        let [force, rate] = self.spring_n(lambda_m);
        let spring = Jet([force, rate, 0.0, 0.0]);
        let law = &self.purpose.law;
        if law.is_constant() {
            let over = 1.0 / law.force_n(0.0)[0];
            return Jet([self.energy_j(lambda_m) * over, force * over, 0.5 * rate * over, 0.0]);
        }
        let place = law.place_m(self.energy_j(lambda_m));
        let [level, slope] = law.force_n(place);
        let mut s = Jet::constant(place);
        // Each round makes one more derivative exact.
        for order in 1..4 {
            let demanded = (s + -place) * slope + level;
            s.0[order] = (spring / demanded).0[order - 1] / order as f64;
        }
        s
    }

    /// How much travel a side gives per way outwards: g = (μ + f)/(1 − μ f) − σ tan α with f = P/(ϱ F) + σ tan α, from eq. (2).
    fn gear(&self, side: usize, lambda: Jet, s: Jet, xi: Jet) -> Jet {
        let p = &self.purpose;
        let sense = p.springs.sense();
        let CutSide { brace_m, share } = p.sides[side];
        let x = xi * sense + 0.5 * p.start_length_m;
        let slope = x / (x * x * -1.0 + brace_m * brace_m).sqrt() * sense;
        let [force, rate] = self.spring_n(lambda.value());
        let spring = (lambda + -lambda.value()) * rate + force;
        let [level, change] = p.law.force_n(s.value());
        let demanded = (s + -s.value()) * change + level;
        let f = spring / (demanded * share) + slope;
        (f + p.friction) / (f * -p.friction + 1.0) - slope
    }

    /// Slopes of s and of both ξ over λ.
    fn slopes(&self, lambda_m: f64, state: State) -> State {
        let gear = |side: usize| self.gear(side, Jet::constant(lambda_m), Jet::constant(state[0]), Jet::constant(state[1 + side])).value();
        let [right, left] = [gear(0), gear(1)];
        let sum = right + left;
        [right * left / sum, left / sum, right / sum]
    }

    /// The least deformation at which both sides move the right way in spite of friction that is compensated on the way down.
    fn start_without_locking(&self) -> Option<f64> {
        let least = |lambda: f64| {
            let gear = |side: usize| {
                let xi = self.purpose.sides[side].share * lambda;
                self.gear(side, Jet::constant(lambda), Jet::constant(0.0), Jet::constant(xi)).value()
            };
            gear(0).min(gear(1))
        };
        let mut most = 1e-3 * self.purpose.start_length_m;
        while least(most).is_nan() || least(most) <= 0.0 {
            most *= 2.0;
            if most > self.purpose.start_length_m {
                return None;
            }
        }
        if least(0.0) >= 0.0 {
            return Some(0.0);
        }
        let root = roots::root(least, 0.0, most, 1e-15).ok()?;
        // A little beyond: at the root itself the roller would run along the travel without stretching the springs.
        Some(root * (1.0 + 1e-9))
    }

    /// Integrates up to a little beyond the stroke, with a row at every kink.
    fn integrate(&self) -> Result<Table, CutError> {
        let end = (1.0 + BEYOND) * self.purpose.stroke_m;
        let energy = self.purpose.law.work_j(end) + self.energy_j(self.range_m[0]);
        let guess = self.deformation_m(energy).ok_or(CutError::SpringsGiveNoForce { travel_m: 0.0 })?;
        let step = (guess - self.range_m[0]) / STEPS as f64;
        let share = |side: usize| self.purpose.sides[side].share * self.range_m[0];
        let mut state = [0.0, share(0), share(1)];
        let mut at = self.range_m[0];
        let row = |at: f64, value: State| Row { at, value, slope: self.slopes(at, value) };
        let mut rows = vec![row(at, state)];
        let kinks: Vec<f64> = self.purpose.law.kinks_m().filter(|k| *k > 0.0).collect();
        while state[0] < end {
            let mut next = self.stepped(at, state, step);
            let mut reached = at + step;
            if let Some(kink) = kinks.iter().find(|k| state[0] < **k - 1e-12 && next[0] > **k) {
                let part = |h: f64| self.stepped(at, state, h)[0] - kink;
                if let Ok(h) = roots::root(part, 0.0, step, 1e-16) {
                    next = self.stepped(at, state, h);
                    reached = at + h;
                }
            }
            let (side_out, moved) = (|i: usize| 0.5 * self.purpose.start_length_m + self.purpose.springs.sense() * next[1 + i], next[0]);
            let fits = (0..SIDES).all(|i| side_out(i) > 0.0 && side_out(i) < self.purpose.sides[i].brace_m);
            if !fits || rows.len() > 8 * STEPS {
                return Err(CutError::BraceTooShort { travel_m: state[0] });
            }
            if moved <= state[0] || moved.is_nan() {
                return Err(CutError::Locks { travel_m: state[0] });
            }
            (at, state) = (reached, next);
            rows.push(row(at, state));
        }
        Ok(Table { rows })
    }

    /// One step of Dormand and Prince's fifth order.
    fn stepped(&self, at: f64, y: State, h: f64) -> State {
        const C: [f64; 6] = [0.0, 0.2, 0.3, 0.8, 8.0 / 9.0, 1.0];
        const A: [[f64; 5]; 6] = [
            [0.0; 5],
            [0.2, 0.0, 0.0, 0.0, 0.0],
            [3.0 / 40.0, 9.0 / 40.0, 0.0, 0.0, 0.0],
            [44.0 / 45.0, -56.0 / 15.0, 32.0 / 9.0, 0.0, 0.0],
            [19372.0 / 6561.0, -25360.0 / 2187.0, 64448.0 / 6561.0, -212.0 / 729.0, 0.0],
            [9017.0 / 3168.0, -355.0 / 33.0, 46732.0 / 5247.0, 49.0 / 176.0, -5103.0 / 18656.0],
        ];
        const B: [f64; 6] = [35.0 / 384.0, 0.0, 500.0 / 1113.0, 125.0 / 192.0, -2187.0 / 6784.0, 11.0 / 84.0];
        let mut k = [[0.0; 3]; 6];
        for i in 0..6 {
            let inner = std::array::from_fn(|c| y[c] + h * (0..i).map(|j| A[i][j] * k[j][c]).sum::<f64>());
            k[i] = self.slopes(at + C[i] * h, inner);
        }
        std::array::from_fn(|c| y[c] + h * (0..6).map(|i| B[i] * k[i][c]).sum::<f64>())
    }

    /// s and ξ of a side with derivatives: values from the table, derivatives from the equation itself.
    fn tabulated(&self, table: &Table, side: usize, lambda_m: f64) -> [Jet; 2] {
        let value = table.at(lambda_m);
        let lambda = Jet::variable(lambda_m);
        let mut jets = value.map(Jet::constant);
        for order in 1..4 {
            let [right, left] = [0, 1].map(|i| self.gear(i, lambda, jets[0], jets[1 + i]));
            let sum = right + left;
            let slopes = [right * left / sum, left / sum, right / sum];
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
            let inside = self.deformation_m(self.purpose.law.work_j(middle)).is_some_and(reaches);
            (low, high) = if inside { (middle, high) } else { (low, middle) };
        }
        Err(CutError::BraceTooShort { travel_m: low })
    }
}

impl Table {
    fn row_before(&self, lambda_m: f64) -> usize {
        self.rows.partition_point(|r| r.at <= lambda_m).clamp(1, self.rows.len() - 1) - 1
    }

    /// Cubic between the rows: with a thousand of them as exact as the rows themselves.
    fn at(&self, lambda_m: f64) -> State {
        let i = self.row_before(lambda_m);
        let (a, b) = (&self.rows[i], &self.rows[i + 1]);
        let h = b.at - a.at;
        let t = (lambda_m - a.at) / h;
        let (t2, u) = (t * t, 1.0 - t);
        std::array::from_fn(|c| {
            a.value[c] * (1.0 + 2.0 * t) * u * u + b.value[c] * t2 * (3.0 - 2.0 * t) + h * t * u * (a.slope[c] * u - b.slope[c] * t)
        })
    }

    fn inverse(&self, travel_m: f64) -> f64 {
        let i = self.rows.partition_point(|r| r.value[0] <= travel_m).clamp(1, self.rows.len() - 1) - 1;
        let (a, b) = (&self.rows[i], &self.rows[i + 1]);
        let part = (travel_m - a.value[0]) / (b.value[0] - a.value[0]);
        a.at + part.max(0.0) * (b.at - a.at)
    }
}
