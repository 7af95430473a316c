//! Ordinary differential equations with few unknowns, up to a time or to where an event ends them: for mechanisms that were reduced to
//! their own coordinates. Steps of Dormand and Prince, chosen by the local error.

use forcewright_base::{maths, roots};

use crate::integrator::{Equations, Stepper};

/// Equations `ẏ = f(t, y)` and the events that end them.
pub trait Ode {
    /// Why there is no rate.
    type Error;

    /// Writes `f(t, y)`.
    ///
    /// # Errors
    /// Where the state cannot be; the step is then tried shorter, down to rounding.
    fn rate(&mut self, time_s: f64, y: &[f64], out: &mut [f64]) -> Result<(), Self::Error>;

    /// Number of events.
    fn events(&self) -> usize {
        0
    }

    /// Value of an event; the motion ends where it falls from above zero to zero or below. Where a state cannot be: not a number, which is
    /// no event.
    fn event(&mut self, _index: usize, _time_s: f64, _y: &[f64]) -> f64 {
        f64::NAN
    }
}

/// How equations are integrated.
#[derive(Debug, Clone, Copy)]
pub struct OdeSettings<'a> {
    /// From, s.
    pub start_s: f64,
    /// To, s, after the start.
    pub end_s: f64,
    /// Local error of a step, relative to the sizes; 1e-4 … 1e-13.
    pub accuracy: f64,
    /// Size of each unknown that matters, above zero.
    pub sizes: &'a [f64],
    /// Times at which states are kept, s, rising; those outside the interval are left out.
    pub outputs_s: &'a [f64],
    /// Most steps, accepted and refused.
    pub max_steps: usize,
}

/// How an integration ended.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Ended<E> {
    /// At the end time.
    Time,
    /// At an event.
    Event(usize),
    /// The state came to where there is no rate.
    Failed(E),
    /// The steps were used up, or became shorter than rounding allows.
    Steps,
    /// Sizes, times or values that are not finite or out of range.
    Settings,
}

/// A solution.
#[derive(Debug, Clone, PartialEq)]
pub struct Trajectory<E> {
    /// Times and states that were asked for, as far as it came.
    pub kept: Vec<(f64, Vec<f64>)>,
    /// When it ended, s.
    pub time_s: f64,
    /// The state there.
    pub state: Vec<f64>,
    /// How it ended.
    pub ended: Ended<E>,
    /// Times the rate was computed.
    pub evaluations: u64,
}

/// Counts evaluations and passes them on.
struct Counted<'a, O> {
    ode: &'a mut O,
    evaluations: u64,
}

impl<O: Ode> Equations for Counted<'_, O> {
    type Error = O::Error;

    fn rate(&mut self, time_s: f64, y: &[f64], out: &mut [f64]) -> Result<(), O::Error> {
        self.evaluations += 1;
        self.ode.rate(time_s, y, out)
    }
}

/// Integrates from a state.
///
/// ```
/// use forcewright_multibody::{Ended, Ode, OdeSettings, integrate};
///
/// /// A fall of one metre.
/// struct Fall;
///
/// impl Ode for Fall {
///     type Error = ();
///     fn rate(&mut self, _time_s: f64, y: &[f64], out: &mut [f64]) -> Result<(), ()> {
///         (out[0], out[1]) = (y[1], -9.81);
///         Ok(())
///     }
///     fn events(&self) -> usize {
///         1
///     }
///     fn event(&mut self, _index: usize, _time_s: f64, y: &[f64]) -> f64 {
///         y[0]
///     }
/// }
///
/// let settings = OdeSettings { start_s: 0.0, end_s: 9.0, accuracy: 1e-10, sizes: &[1.0, 1.0], outputs_s: &[], max_steps: 1000 };
/// let fall = integrate(&mut Fall, &[1.0, 0.0], &settings);
/// assert_eq!(fall.ended, Ended::Event(0));
/// assert!((fall.time_s - (2.0_f64 / 9.81).sqrt()).abs() < 1e-14);
/// ```
pub fn integrate<O: Ode>(ode: &mut O, start: &[f64], settings: &OdeSettings<'_>) -> Trajectory<O::Error> {
    let mut run = Run::new(ode, start, settings);
    let ended = if run.is_valid() { run.go() } else { Ended::Settings };
    Trajectory { kept: run.kept, time_s: run.time_s, state: run.stepper.start, ended, evaluations: run.counted.evaluations }
}

struct Run<'a, O: Ode> {
    counted: Counted<'a, O>,
    settings: &'a OdeSettings<'a>,
    stepper: Stepper,
    time_s: f64,
    kept: Vec<(f64, Vec<f64>)>,
    next_output: usize,
    /// Values of the events at the start of the step.
    before: Vec<f64>,
}

impl<'a, O: Ode> Run<'a, O> {
    fn new(ode: &'a mut O, start: &[f64], settings: &'a OdeSettings<'a>) -> Self {
        let mut stepper = Stepper::new(start.len(), true);
        stepper.start.copy_from_slice(start);
        let before = vec![f64::NAN; ode.events()];
        let counted = Counted { ode, evaluations: 0 };
        Self { counted, settings, stepper, time_s: settings.start_s, kept: Vec::new(), next_output: 0, before }
    }

    fn is_valid(&self) -> bool {
        let s = self.settings;
        s.sizes.len() == self.stepper.start.len()
            && s.sizes.iter().all(|size| *size > 0.0 && size.is_finite())
            && s.start_s.is_finite()
            && s.end_s.is_finite()
            && s.end_s > s.start_s
            && s.accuracy > 0.0
            && s.accuracy < 1.0
            && self.stepper.start.iter().all(|y| y.is_finite())
    }

    fn go(&mut self) -> Ended<O::Error> {
        let OdeSettings { end_s, max_steps, .. } = *self.settings;
        let mut rate = vec![0.0; self.stepper.start.len()];
        let state = self.stepper.start.clone();
        if let Err(error) = self.counted.rate(self.time_s, &state, &mut rate) {
            return Ended::Failed(error);
        }
        self.stepper.stages[0].copy_from_slice(&rate);
        for k in 0..self.before.len() {
            self.before[k] = self.counted.ode.event(k, self.time_s, &state);
        }
        while let Some(&time) = self.settings.outputs_s.get(self.next_output).filter(|t| **t <= self.time_s) {
            if time.to_bits() == self.time_s.to_bits() {
                self.kept.push((time, state.clone()));
            }
            self.next_output += 1;
        }
        let mut length = 1e-3 * (end_s - self.time_s);
        for _ in 0..max_steps {
            let left = end_s - self.time_s;
            let last = length >= left * (1.0 - 1e-12);
            let step = if last { left } else { length };
            if step <= 4.0 * f64::EPSILON * self.time_s.abs().max(end_s.abs()) {
                return Ended::Steps;
            }
            let error = match self.counted_step(step) {
                Ok(error) => error,
                // A stage looked where there is no state: nearer by, there may be.
                Err(failed) => {
                    if step <= 1e-12 * (end_s - self.settings.start_s) {
                        return Ended::Failed(failed);
                    }
                    length = 0.25 * step;
                    continue;
                }
            };
            // Not a number is too much, too.
            if error.is_nan() || error > 1.0 {
                length = step * if error.is_finite() { (0.9 * maths::powf(error, -0.2)).clamp(0.1, 0.9) } else { 0.1 };
                continue;
            }
            let reached = if last { end_s } else { self.time_s + step };
            if let Some(ended) = self.accept(reached) {
                return ended;
            }
            if last {
                return Ended::Time;
            }
            length = step * (0.9 * maths::powf(error.max(1e-10), -0.2)).clamp(0.2, 5.0);
        }
        Ended::Steps
    }

    /// A step; its error over what is allowed.
    fn counted_step(&mut self, step: f64) -> Result<f64, O::Error> {
        self.stepper.step(&mut self.counted, self.time_s, step)?;
        let sum: f64 = self.stepper.error.iter().zip(self.settings.sizes).map(|(e, size)| (e / size) * (e / size)).sum();
        Ok((sum / self.settings.sizes.len().max(1) as f64).sqrt() / self.settings.accuracy)
    }

    /// Outputs and events of the step; moves on.
    fn accept(&mut self, reached: f64) -> Option<Ended<O::Error>> {
        let event = self.first_event(reached);
        let stop = event.map_or(reached, |(_, share)| self.time_s + share * self.stepper.step_s);
        let mut inside = vec![0.0; self.stepper.start.len()];
        while let Some(&time) = self.settings.outputs_s.get(self.next_output).filter(|t| **t <= stop) {
            self.stepper.between(((time - self.time_s) / self.stepper.step_s).clamp(0.0, 1.0), &mut inside);
            self.kept.push((time, inside.clone()));
            self.next_output += 1;
        }
        if let Some((index, share)) = event {
            // The state at the event by a step of its own: of the order of the method, not of the dense output.
            let exact = self.counted_step(share * self.stepper.step_s).is_ok();
            if !exact {
                return Some(Ended::Steps);
            }
            self.stepper.start.clone_from(&self.stepper.end);
            self.time_s = stop;
            return Some(Ended::Event(index));
        }
        let last = self.stepper.stages.len() - 1;
        self.stepper.start.clone_from(&self.stepper.end);
        let (first, rest) = self.stepper.stages.split_at_mut(1);
        first[0].clone_from(&rest[last - 1]);
        self.time_s = reached;
        None
    }

    /// Looks for falls through zero in quarters of the step: the earliest event and its share of the step.
    fn first_event(&mut self, reached: f64) -> Option<(usize, f64)> {
        let mut first: Option<(usize, f64)> = None;
        let mut inside = vec![0.0; self.stepper.start.len()];
        for k in 0..self.before.len() {
            let mut before = (0.0, self.before[k]);
            for quarter in 1..=4 {
                let share = 0.25 * f64::from(quarter);
                let value = self.event_at(k, share, reached, &mut inside);
                if before.1 > 0.0 && value <= 0.0 {
                    if let Ok(root) = roots::root(|x| self.event_at(k, x, reached, &mut inside), before.0, share, 1e-15)
                        && first.is_none_or(|(_, earliest)| root < earliest)
                    {
                        first = Some((k, root));
                    }
                    break;
                }
                before = (share, value);
            }
            self.before[k] = before.1;
        }
        first
    }

    fn event_at(&mut self, index: usize, share: f64, reached: f64, inside: &mut [f64]) -> f64 {
        if share >= 1.0 {
            inside.copy_from_slice(&self.stepper.end);
            return self.counted.ode.event(index, reached, inside);
        }
        self.stepper.between(share, inside);
        self.counted.ode.event(index, self.time_s + share * self.stepper.step_s, inside)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A swing ẍ = −x, which is nowhere beyond x = `wall`; its event is x falling through zero.
    struct Swing {
        wall: f64,
    }

    impl Ode for Swing {
        type Error = &'static str;

        fn rate(&mut self, _time_s: f64, y: &[f64], out: &mut [f64]) -> Result<(), Self::Error> {
            (out[0], out[1]) = (y[1], -y[0]);
            if y[0] > self.wall { Err("wall") } else { Ok(()) }
        }

        fn events(&self) -> usize {
            1
        }

        fn event(&mut self, _index: usize, _time_s: f64, y: &[f64]) -> f64 {
            y[0]
        }
    }

    fn settings(outputs_s: &[f64]) -> OdeSettings<'_> {
        OdeSettings { start_s: 0.0, end_s: 3.0, accuracy: 1e-12, sizes: &[1.0, 1.0], outputs_s, max_steps: 10_000 }
    }

    #[test]
    fn an_event_ends_a_swing_at_a_quarter_turn_and_outputs_lie_on_it() {
        let run = integrate(&mut Swing { wall: 2.0 }, &[1.0, 0.0], &settings(&[0.0, 0.5, 1.0, 2.0]));
        assert_eq!(run.ended, Ended::Event(0));
        assert!((run.time_s - std::f64::consts::FRAC_PI_2).abs() < 1e-11, "{}", run.time_s);
        assert!((run.state[1] + 1.0).abs() < 1e-11);
        assert_eq!(run.kept.len(), 3, "beyond the event there is nothing");
        for (time, state) in &run.kept {
            assert!((state[0] - maths::cos(*time)).abs() < 1e-10, "{time}");
        }
    }

    #[test]
    fn a_state_without_a_rate_is_approached_and_named() {
        let run = integrate(&mut Swing { wall: 0.5 }, &[0.0, 1.0], &settings(&[]));
        assert_eq!(run.ended, Ended::Failed("wall"));
        assert!((run.time_s - maths::asin(0.5)).abs() < 1e-10, "{}", run.time_s);
    }

    #[test]
    fn settings_out_of_range_are_refused() {
        let wrong = OdeSettings { end_s: f64::NAN, ..settings(&[]) };
        assert_eq!(integrate(&mut Swing { wall: 2.0 }, &[1.0, 0.0], &wrong).ended, Ended::Settings);
        let wrong = OdeSettings { sizes: &[1.0], ..settings(&[]) };
        assert_eq!(integrate(&mut Swing { wall: 2.0 }, &[1.0, 0.0], &wrong).ended, Ended::Settings);
    }
}
