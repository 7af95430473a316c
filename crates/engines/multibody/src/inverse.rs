//! Inverse dynamics: the motion is prescribed by drivers, forces follow.
//!
//! The procedure of Sánchez-Salinas et al. 2022, section 4: positions from a first-order system stabilised after Baumgarte, (19)–(22),
//! or algebraically at each instant; accelerations (23)–(25); multipliers (26)–(28).

use forcewright_base::dense::Lu;
use forcewright_base::quadrature::GaussLegendre;

use crate::error::Stop;
use crate::forces::Power;
use crate::frames::{Frames, Snapshot};
use crate::history::History;
use crate::model::System;
use crate::rows::{Constraint, Rows};

/// Most states that may be asked for: more would fill the memory by mistake.
pub(crate) const MOST_INSTANTS: usize = 10_000_000;

/// Equal steps over an interval of time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Grid {
    /// First instant, s.
    pub start_s: f64,
    /// Last instant, s, after the first.
    pub end_s: f64,
    /// Number of steps, 1 to ten million; there is one instant more.
    pub steps: usize,
}

impl Grid {
    /// Instant by number.
    pub(crate) fn time_s(&self, index: usize) -> f64 {
        if index == self.steps { self.end_s } else { self.start_s + (self.end_s - self.start_s) * index as f64 / self.steps as f64 }
    }

    pub(crate) fn is_valid(&self) -> bool {
        (1..=MOST_INSTANTS).contains(&self.steps) && self.end_s > self.start_s && self.start_s.is_finite() && self.end_s.is_finite()
    }
}

/// How positions are found.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Kinematics {
    /// Velocities that satisfy `ċ + β c = 0` are integrated by the classical Runge–Kutta method. Takes every kind of row; the error falls
    /// with the fourth power of the step. A β of about ten over the duration is ample, a large one harms (β times the step ≪ 1).
    Baumgarte {
        /// β, 1/s, ≥ 0.
        rate_per_s: f64,
    },
    /// Newton's method at every instant, to rounding. Rolling is taken by its integral, the length of the path; a skate has none and is
    /// refused.
    Algebraic,
}

/// What inverse dynamics found.
#[derive(Debug, Clone, PartialEq)]
pub struct Inverse {
    /// States at all instants that were reached.
    pub history: History,
    /// How it ended.
    pub stop: Stop,
    /// Rows that follow from the rows before them; their multipliers are given as 0.
    pub redundant: Vec<String>,
    /// Largest miss of a position row over its scale (a length of the mechanism, 1 rad).
    pub worst_miss: f64,
}

impl System {
    /// Motion and forces of a mechanism that is driven in all its freedoms, from coordinates near those of the first instant.
    /// The start is assembled on the branch nearest to them. Gravity and all forces act.
    pub fn inverse(&self, start: &[f64], grid: Grid, kinematics: Kinematics) -> Inverse {
        let mut run = Run::new(self, if grid.is_valid() { grid.steps + 1 } else { 0 });
        let outcome = if grid.is_valid() { run.follow(start, grid, kinematics) } else { Err(Stop::Settings) };
        let redundant = (0..self.rows).filter(|row| !run.kept.contains(row)).map(|row| self.row_name(row)).collect();
        Inverse { history: run.history, stop: outcome.err().unwrap_or(Stop::Reached), redundant, worst_miss: run.worst_miss }
    }
}

/// Buffers of one run; nothing is allocated between instants.
struct Run<'a> {
    system: &'a System,
    history: History,
    kept: Vec<usize>,
    frames: Frames,
    rows: Rows,
    lu: Lu,
    q: Vec<f64>,
    velocity: Vec<f64>,
    acceleration: Vec<f64>,
    multipliers: Vec<f64>,
    worst_miss: f64,
}

impl<'a> Run<'a> {
    fn new(system: &'a System, instants: usize) -> Self {
        let n = system.coordinates();
        Self {
            system,
            history: History::new(system, instants),
            kept: (0..system.rows).collect(),
            frames: system.new_frames(),
            rows: Rows::default(),
            lu: Lu::new(),
            q: vec![0.0; n],
            velocity: vec![0.0; n],
            acceleration: vec![0.0; n],
            multipliers: vec![0.0; n],
            worst_miss: 0.0,
        }
    }

    fn follow(&mut self, start: &[f64], grid: Grid, kinematics: Kinematics) -> Result<(), Stop> {
        let system = self.system;
        self.q = system.assemble(grid.start_s, start, &[]).map_err(Stop::NotAssembled)?.q;
        self.choose_rows(grid.start_s)?;
        match kinematics {
            Kinematics::Baumgarte { rate_per_s } if rate_per_s >= 0.0 && rate_per_s.is_finite() => self.integrate(grid, rate_per_s),
            Kinematics::Baumgarte { .. } => Err(Stop::Settings),
            Kinematics::Algebraic => self.solve_all(grid),
        }
    }

    /// Keeps independent rows; they must fix every coordinate.
    fn choose_rows(&mut self, time_s: f64) -> Result<(), Stop> {
        let system = self.system;
        self.frames.set_positions(&self.q);
        self.rows.evaluate(&system.constraints, system.coordinates(), system.rows, &self.frames, time_s);
        let basis = system.scaled_basis(&self.rows);
        self.kept = basis.independent().to_vec();
        let freedom = system.coordinates() - basis.rank();
        if freedom == 0 {
            return Ok(());
        }
        let most = (0..system.coordinates()).fold(0, |most, k| if basis.freedom(k) > basis.freedom(most) + 1e-9 { k } else { most });
        Err(Stop::NotDriven { freedom, coordinate: system.coordinate_name(most) })
    }

    fn evaluate(&mut self, time_s: f64) {
        let system = self.system;
        self.rows.evaluate(&system.constraints, system.coordinates(), system.rows, &self.frames, time_s);
        self.rows.keep(&self.kept);
    }

    fn factor(&mut self) -> Result<(), Stop> {
        let n = self.system.coordinates();
        self.lu.factor(n, n, &self.rows.jacobian).map_err(|singular| {
            if self.rows.jacobian.iter().all(|entry| entry.is_finite()) {
                Stop::Singular { part: self.system.coordinate_name(singular.column) }
            } else {
                Stop::NotFinite
            }
        })
    }

    /// Rows and factors at a position.
    fn prepare(&mut self, q: &[f64], time_s: f64) -> Result<(), Stop> {
        self.frames.set_positions(q);
        self.evaluate(time_s);
        self.factor()
    }

    /// (19)–(22) by the classical Runge–Kutta method.
    fn integrate(&mut self, grid: Grid, beta: f64) -> Result<(), Stop> {
        let n = self.system.coordinates();
        let (mut rate, mut sum, mut stage) = (vec![0.0; n], vec![0.0; n], vec![0.0; n]);
        for index in 0..=grid.steps {
            let time = grid.time_s(index);
            let q = std::mem::take(&mut self.q);
            let prepared = self.prepare(&q, time);
            self.q = q;
            prepared?;
            self.state(time)?;
            if index == grid.steps {
                break;
            }
            let step = grid.time_s(index + 1) - time;
            // The factors of `state` are those of the first stage.
            self.stabilised(beta, &mut rate);
            sum.copy_from_slice(&rate);
            for (part, weight, at) in [(0.5, 2.0, 0.5), (0.5, 2.0, 0.5), (1.0, 1.0, 1.0)] {
                for ((stage, q), rate) in stage.iter_mut().zip(&self.q).zip(&rate) {
                    *stage = q + part * step * rate;
                }
                let time = if at < 1.0 { time + at * step } else { grid.time_s(index + 1) };
                self.prepare(&stage, time)?;
                self.stabilised(beta, &mut rate);
                for (sum, rate) in sum.iter_mut().zip(&rate) {
                    *sum += weight * rate;
                }
            }
            for (q, sum) in self.q.iter_mut().zip(&sum) {
                *q += step / 6.0 * sum;
            }
        }
        Ok(())
    }

    /// `D q̇ = −∂c/∂t − β c`; velocity rows have no value.
    fn stabilised(&mut self, beta: f64, rate: &mut [f64]) {
        for ((rate, by_time), value) in rate.iter_mut().zip(&self.rows.by_time).zip(&self.rows.value) {
            *rate = -by_time - beta * value;
        }
        self.lu.solve(rate);
    }

    /// Velocities, accelerations and multipliers at the prepared position, added to the history. Keeps rows and factors.
    fn state(&mut self, time_s: f64) -> Result<(), Stop> {
        let system = self.system;
        self.worst_miss = self.worst_miss.max(system.worst_row(&self.rows.value, &self.kept).1);
        for (velocity, by_time) in self.velocity.iter_mut().zip(&self.rows.by_time) {
            *velocity = -by_time;
        }
        self.lu.solve(&mut self.velocity);
        self.frames.set_velocities(&self.velocity);
        self.evaluate(time_s);
        self.acceleration.copy_from_slice(&self.rows.gamma);
        self.lu.solve(&mut self.acceleration);
        system.generalised_forces(&Snapshot { time_s, system, frames: &self.frames }, &mut self.multipliers);
        for ((force, mass), acceleration) in self.multipliers.iter_mut().zip(&system.mass).zip(&self.acceleration) {
            *force -= mass * acceleration;
        }
        self.lu.solve_transposed(&mut self.multipliers);
        if !self.multipliers.iter().chain(&self.acceleration).all(|value| value.is_finite()) {
            return Err(Stop::NotFinite);
        }
        self.history.push(time_s, [&self.q, &self.velocity, &self.acceleration], &self.multipliers, &self.kept);
        Ok(())
    }

    /// Newton's method at every instant, from the Taylor series of the one before.
    fn solve_all(&mut self, grid: Grid) -> Result<(), Stop> {
        let system = self.system;
        if let Some(row) = (0..system.rows).find(|row| system.velocity_rows[*row] && !system.is_rolling(*row)) {
            return Err(Stop::NotIntegrable { row: system.row_name(row) });
        }
        let mut rolled = Rolled::new(system, &self.q);
        for index in 0..=grid.steps {
            let time = grid.time_s(index);
            if index > 0 {
                let step = time - grid.time_s(index - 1);
                for ((q, v), a) in self.q.iter_mut().zip(&self.velocity).zip(&self.acceleration) {
                    *q += step * (v + 0.5 * step * a);
                }
                self.newton(time, &rolled)?;
            }
            let q = std::mem::take(&mut self.q);
            let prepared = self.prepare(&q, time);
            self.q = q;
            prepared?;
            self.state(time)?;
            rolled.last.copy_from_slice(&self.q);
        }
        Ok(())
    }

    fn newton(&mut self, time_s: f64, rolled: &Rolled) -> Result<(), Stop> {
        let system = self.system;
        let mut change = vec![0.0; system.coordinates()];
        let mut before = f64::INFINITY;
        for _ in 0..30 {
            self.frames.set_positions(&self.q);
            self.evaluate(time_s);
            rolled.fill(system, &self.q, &self.kept, &mut self.rows.value);
            let miss = system.worst_row(&self.rows.value, &self.kept).1;
            // At rounding the miss no longer falls.
            if miss == 0.0 || (miss <= system.closing_limit(&self.q) && miss >= 0.1 * before) {
                return Ok(());
            }
            before = miss;
            self.factor()?;
            for (change, value) in change.iter_mut().zip(&self.rows.value) {
                *change = -value;
            }
            self.lu.solve(&mut change);
            for (q, change) in self.q.iter_mut().zip(&change) {
                *q += change;
            }
            if !self.q.iter().all(|q| q.is_finite()) {
                return Err(Stop::NotFinite);
            }
        }
        let row = system.worst_row(&self.rows.value, &self.kept).0;
        Err(Stop::Drift { row: system.row_name(row) })
    }
}

/// Rolling by its integral: between instants the path's length grows by what the roller's circumference turns.
struct Rolled {
    rule: GaussLegendre,
    /// Row, and the contact's place among the constraints.
    contacts: Vec<(usize, usize)>,
    /// Coordinates of the last instant.
    last: Vec<f64>,
}

impl Rolled {
    fn new(system: &System, q: &[f64]) -> Self {
        let mut contacts = Vec::new();
        for (k, constraint) in system.constraints.iter().enumerate() {
            if let Constraint::Contact(contact) = constraint
                && contact.rolling
            {
                contacts.push((system.first_rows[k] + 2, k));
            }
        }
        Self { rule: GaussLegendre::new(10), contacts, last: q.to_vec() }
    }

    /// Values of the rolling rows since the last instant.
    fn fill(&self, system: &System, q: &[f64], kept: &[usize], value: &mut [f64]) {
        let bodies = system.mass.len();
        for &(row, k) in &self.contacts {
            let (Constraint::Contact(contact), Ok(place)) = (&system.constraints[k], kept.binary_search(&row)) else { continue };
            let (from, to) = (self.last[bodies + contact.index], q[bodies + contact.index]);
            let length = (to - from) * self.rule.integrate(|s| contact.speed(from + s * (to - from)));
            let turned = |body: crate::BodyId| body.column().map_or(0.0, |c| q[c + 2] - self.last[c + 2]);
            let angle = turned(contact.centre.body) - turned(contact.cam.body);
            value[place] = length - contact.cam_side * contact.radius_m * angle;
        }
    }
}

impl System {
    fn is_rolling(&self, row: usize) -> bool {
        let joint = self.first_rows.partition_point(|first| *first <= row) - 1;
        matches!(self.constraints[joint], Constraint::Contact(_))
    }

    /// Applied forces with gravity, by coordinate, and their power.
    pub(crate) fn generalised_forces(&self, snapshot: &Snapshot<'_>, q: &mut [f64]) -> Power {
        q.fill(0.0);
        for (force, mass) in q.chunks_exact_mut(3).zip(self.mass.chunks_exact(3)) {
            force[0] = mass[0] * self.gravity[0];
            force[1] = mass[0] * self.gravity[1];
        }
        let mut power = Power::default();
        for element in &self.elements {
            let part = element.apply(snapshot, q);
            power.dissipated += part.dissipated;
            power.applied += part.applied;
        }
        power
    }
}
