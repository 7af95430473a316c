//! Where the states of a batch lie, and all weights of prediction and interpolation: the same for every design, so computed once.

use crate::fast::hermite::Hermite;

/// Weights of the values and slopes of some consecutive states.
#[derive(Clone, Debug)]
pub(super) struct Weights {
    /// States and their weights (value, slope).
    pub(super) states: Vec<(usize, [f64; 2])>,
}

/// A place between two states.
#[derive(Clone, Debug)]
pub(super) struct Station {
    /// The states before and after.
    pub(super) around: [usize; 2],
    /// For the force, and for its slope.
    pub(super) force: Weights,
    pub(super) slope: Weights,
    /// For stress: value and slope of the states before and after.
    pub(super) stress: [[f64; 2]; 2],
}

/// One step from state to state.
#[derive(Clone, Debug)]
pub(super) struct Step {
    pub(super) prediction: Weights,
    pub(super) length: f64,
    pub(super) iterations: usize,
}

/// States at fixed parts of the travel.
#[derive(Clone, Debug, Default)]
pub(super) struct Schedule {
    /// From 0 to 1.
    pub(super) places: Vec<f64>,
    /// To each state but the first.
    pub(super) steps: Vec<Step>,
    pub(super) stations: Vec<Station>,
    /// Each inner state from those around it: force, stress.
    pub(super) left_out: Vec<[Weights; 2]>,
}

/// States used to interpolate the force.
const FORCE_STATES: usize = 4;
/// States used to predict the next one.
const PREDICTING: usize = 3;

impl Schedule {
    /// `intervals` steps to the last of the stations.
    pub(super) fn new(stations_m: &[f64], intervals: usize) -> Self {
        let travel_m = stations_m.last().copied().unwrap_or(0.0);
        let places = places(intervals);
        let mut hermite = Hermite::default();
        hermite.reset(false);
        let steps = (1..=intervals).map(|i| {
            hermite.last(&places[..i], PREDICTING);
            hermite.place(places[i]);
            Step {
                prediction: Weights::of(&hermite),
                length: places[i] - places[i - 1],
                iterations: if i + ONCE <= intervals { 2 } else { 1 },
            }
        });
        let steps = steps.collect();
        let mut interval = 0;
        let mut stations = Vec::new();
        let mut near = Hermite::default();
        near.reset(false);
        hermite.reset(false);
        for station in stations_m {
            let at = station / travel_m;
            while interval + 2 < places.len() && places[interval + 1] < at {
                interval += 1;
            }
            hermite.around(&places, interval, FORCE_STATES);
            hermite.place(at);
            near.around(&places, interval, 2);
            near.place(at);
            stations.push(Station {
                around: [interval, interval + 1],
                force: Weights::of(&hermite),
                slope: Weights { states: hermite.indices().zip(hermite.slope).collect() },
                stress: [near.value[0], near.value[1]],
            });
        }
        let left_out = (1..intervals).map(|j| {
            [FORCE_STATES, 2].map(|count| {
                hermite.without(&places, j, count);
                hermite.place(places[j]);
                Weights::of(&hermite)
            })
        });
        let left_out = left_out.collect();
        Self { places, steps, stations, left_out }
    }
}

/// Parts of the travel: closer together at the beginning, where the force of such mechanisms bends and predictions have few states
/// behind them, and at the end, where interpolation has neighbours on one side only.
fn places(intervals: usize) -> Vec<f64> {
    let length = |i: usize| match (i, intervals - 1 - i) {
        (0, _) => 0.75,
        (1, _) => 0.8,
        (2, _) => 0.9,
        (_, 0) => 0.85,
        _ => 1.0,
    };
    let mut sums = vec![0.0];
    let mut sum = 0.0;
    for i in 0..intervals {
        sum += length(i);
        sums.push(sum);
    }
    sums.iter().map(|s| s / sum).collect()
}

impl Weights {
    fn of(hermite: &Hermite) -> Self {
        Self { states: hermite.weights().collect() }
    }
}

/// The last steps, with one iteration; the others have two, as all later predictions rest on their tangents.
const ONCE: usize = 3;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn weights_reproduce_polynomials() {
        let stations: Vec<f64> = (0..=20).map(|i| 0.6e-3 * f64::from(i)).collect();
        let schedule = Schedule::new(&stations, 8);
        assert!(schedule.places[0] == 0.0 && (schedule.places[8] - 1.0).abs() < 1e-15 && schedule.steps.len() == 8);
        // Of degree 3, with its slope: exact by two states.
        let f = |t: f64| 1.0 + t * (0.3 - t * (0.7 - 1.9 * t));
        let g = |t: f64| 0.3 - t * (1.4 - 5.7 * t);
        let sum = |w: &Weights| w.states.iter().map(|(i, [a, b])| a * f(schedule.places[*i]) + b * g(schedule.places[*i])).sum::<f64>();
        for (station, at) in schedule.stations.iter().zip(&stations) {
            let t = at / stations[20];
            assert!((sum(&station.force) - f(t)).abs() < 1e-12 && (sum(&station.slope) - g(t)).abs() < 1e-11);
            let near = Weights { states: station.around.into_iter().zip(station.stress).collect() };
            assert!((sum(&near) - f(t)).abs() < 1e-12);
            let [before, after] = station.around.map(|i| schedule.places[i]);
            assert!(before <= t + 1e-12 && t <= after + 1e-12);
        }
        for (j, both) in schedule.left_out.iter().enumerate() {
            for weights in both {
                assert!((sum(weights) - f(schedule.places[j + 1])).abs() < 1e-12);
                assert!(weights.states.iter().all(|(i, _)| *i != j + 1));
            }
        }
        for (i, step) in schedule.steps.iter().enumerate().skip(1) {
            assert!((sum(&step.prediction) - f(schedule.places[i + 1])).abs() < 1e-12);
            assert!(step.prediction.states.iter().all(|(from, _)| *from <= i));
        }
    }
}
