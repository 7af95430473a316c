//! One-step integrators of `ẏ = f(t, y)` with dense output: Dormand & Prince 5(4), and the classical Runge–Kutta method.
//!
//! E. Hairer, S. P. Nørsett & G. Wanner, "Solving Ordinary Differential Equations I", 2nd ed., table II.5.2 and section II.6 (continuous
//! extension of order 4); J. R. Dormand & P. J. Prince, "A family of embedded Runge–Kutta formulae", J. Comput. Appl. Math. 6 (1980).

/// Equations to integrate.
pub(crate) trait Equations {
    type Error;
    /// Writes `f(t, y)`.
    fn rate(&mut self, time_s: f64, y: &[f64], out: &mut [f64]) -> Result<(), Self::Error>;
}

/// Stage times and rows of the Dormand–Prince tableau; the last row is the solution of order 5.
const NODES: [f64; 6] = [0.2, 0.3, 0.8, 8.0 / 9.0, 1.0, 1.0];
const TABLEAU: [[f64; 6]; 6] = [
    [0.2, 0.0, 0.0, 0.0, 0.0, 0.0],
    [3.0 / 40.0, 9.0 / 40.0, 0.0, 0.0, 0.0, 0.0],
    [44.0 / 45.0, -56.0 / 15.0, 32.0 / 9.0, 0.0, 0.0, 0.0],
    [19372.0 / 6561.0, -25360.0 / 2187.0, 64448.0 / 6561.0, -212.0 / 729.0, 0.0, 0.0],
    [9017.0 / 3168.0, -355.0 / 33.0, 46732.0 / 5247.0, 49.0 / 176.0, -5103.0 / 18656.0, 0.0],
    [35.0 / 384.0, 0.0, 500.0 / 1113.0, 125.0 / 192.0, -2187.0 / 6784.0, 11.0 / 84.0],
];
/// Difference of the solutions of order 5 and 4.
const ERROR: [f64; 7] = [71.0 / 57600.0, 0.0, -71.0 / 16695.0, 71.0 / 1920.0, -17253.0 / 339_200.0, 22.0 / 525.0, -1.0 / 40.0];
/// Fifth coefficient of the continuous extension.
const DENSE: [f64; 7] = [
    -12_715_105_075.0 / 11_282_082_432.0,
    0.0,
    87_487_479_700.0 / 32_700_410_799.0,
    -10_690_763_975.0 / 1_880_347_072.0,
    701_980_252_875.0 / 199_316_789_632.0,
    -1_453_857_185.0 / 822_651_844.0,
    69_997_945.0 / 29_380_423.0,
];
/// The classical method, with the rate at the end of the step as last row for the continuous extension.
const CLASSICAL_NODES: [f64; 4] = [0.5, 0.5, 1.0, 1.0];
const CLASSICAL: [[f64; 4]; 4] =
    [[0.5, 0.0, 0.0, 0.0], [0.0, 0.5, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0], [1.0 / 6.0, 1.0 / 3.0, 1.0 / 3.0, 1.0 / 6.0]];

/// A step, with what lies between its ends.
#[derive(Debug, Clone)]
pub(crate) struct Stepper {
    adaptive: bool,
    /// Stage rates, one after the other; the first is given by the caller, the last is the rate at the end.
    pub(crate) stages: Vec<Vec<f64>>,
    pub(crate) start: Vec<f64>,
    /// End of the step before any projection.
    pub(crate) end: Vec<f64>,
    pub(crate) error: Vec<f64>,
    pub(crate) time_s: f64,
    pub(crate) step_s: f64,
}

impl Stepper {
    /// Of Dormand and Prince, or the classical one.
    pub(crate) fn new(size: usize, adaptive: bool) -> Self {
        let zero = vec![0.0; size];
        let stages = vec![zero.clone(); if adaptive { 7 } else { 5 }];
        Self { adaptive, stages, start: zero.clone(), end: zero.clone(), error: zero, time_s: 0.0, step_s: 0.0 }
    }

    /// A step from `start` with `stages[0]` the rate there.
    pub(crate) fn step<E: Equations>(&mut self, equations: &mut E, time_s: f64, step_s: f64) -> Result<(), E::Error> {
        (self.time_s, self.step_s) = (time_s, step_s);
        let count = self.stages.len();
        for row in 0..count - 1 {
            let (node, weights): (f64, &[f64]) =
                if self.adaptive { (NODES[row], &TABLEAU[row]) } else { (CLASSICAL_NODES[row], &CLASSICAL[row]) };
            let (done, rest) = self.stages.split_at_mut(row + 1);
            self.end.copy_from_slice(&self.start);
            for (weight, stage) in weights.iter().zip(done.iter()) {
                if *weight != 0.0 {
                    for (y, k) in self.end.iter_mut().zip(stage) {
                        *y += step_s * weight * k;
                    }
                }
            }
            equations.rate(time_s + node * step_s, &self.end, &mut rest[0])?;
        }
        if self.adaptive {
            self.error.fill(0.0);
            for (weight, stage) in ERROR.iter().zip(&self.stages) {
                for (error, k) in self.error.iter_mut().zip(stage) {
                    *error += step_s * weight * k;
                }
            }
        }
        Ok(())
    }

    /// State between the ends, at a share in [0, 1] of the step: order 4 after Dormand and Prince, cubic after the classical method.
    pub(crate) fn between(&self, share: f64, out: &mut [f64]) {
        let (h, rest) = (self.step_s, 1.0 - share);
        let last = self.stages.len() - 1;
        for (k, y) in out.iter_mut().enumerate() {
            let rise = self.end[k] - self.start[k];
            let bow = h * self.stages[0][k] - rise;
            let twist = rise - h * self.stages[last][k] - bow;
            let fifth = if self.adaptive { h * DENSE.iter().zip(&self.stages).map(|(d, stage)| d * stage[k]).sum::<f64>() } else { 0.0 };
            *y = self.start[k] + share * (rise + rest * (bow + share * (twist + rest * fifth)));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use forcewright_base::maths;

    /// ẏ = −y + cos t + sin t; from y(0) = 1: y = sin t + exp(−t).
    struct Relaxation;

    impl Equations for Relaxation {
        type Error = ();
        fn rate(&mut self, t: f64, y: &[f64], out: &mut [f64]) -> Result<(), ()> {
            out[0] = -y[0] + maths::cos(t) + maths::sin(t);
            Ok(())
        }
    }

    fn exact(t: f64) -> f64 {
        maths::sin(t) + maths::exp(-t)
    }

    /// Errors at the end of [0, 2] and the largest inside steps, with so many steps.
    fn errors(adaptive: bool, steps: u32) -> [f64; 2] {
        let mut stepper = Stepper::new(1, adaptive);
        stepper.start[0] = 1.0;
        let h = 2.0 / f64::from(steps);
        let mut inside = 0.0_f64;
        for k in 0..steps {
            let t = h * f64::from(k);
            let (y, mut rate) = (stepper.start.clone(), [0.0]);
            Relaxation.rate(t, &y, &mut rate).unwrap();
            stepper.stages[0][0] = rate[0];
            stepper.step(&mut Relaxation, t, h).unwrap();
            for share in [0.2, 0.5, 0.83] {
                let mut y = [0.0];
                stepper.between(share, &mut y);
                inside = inside.max((y[0] - exact(t + share * h)).abs());
            }
            stepper.start = stepper.end.clone();
        }
        [(stepper.start[0] - exact(2.0)).abs(), inside]
    }

    #[test]
    fn orders_at_the_ends_and_between() {
        for (adaptive, end_order, dense_order) in [(true, 5.0, 5.0), (false, 4.0, 4.0)] {
            let (coarse, fine) = (errors(adaptive, 10), errors(adaptive, 20));
            let order = |k: usize| maths::ln(coarse[k] / fine[k]) / std::f64::consts::LN_2;
            assert!((order(0) - end_order).abs() < 0.3, "{} {coarse:?} {fine:?}", order(0));
            // A local error of order p + 1 of the extension; over a fixed interval it shows as its own order.
            assert!((order(1) - dense_order).abs() < 0.6, "{} {coarse:?} {fine:?}", order(1));
        }
    }
}
