//! Layers in series under a slowly growing displacement: whether they move alike, and what happens where they do not.
//!
//! Layers carry the same force and share the displacement. All alike is an equilibrium, but a stable one only while the stiffness of a
//! layer is positive: where the force falls, one layer runs ahead and the others spring back. The quasi-static motion is followed from
//! minimum to minimum of the energy Σ W(δᵢ) at Σ δᵢ = Δ, forth and back; a layer that reaches the end of its computed curve stays there,
//! as at a stop.

use crate::force_curve::ForceCurve;

/// Displacements at which the layers are looked at, each way.
const STEPS: usize = 400;
/// Differences of the layers, as part of the travel of one, that start them off where they are not stable: parts are never alike.
const IMPERFECTION: f64 = 1e-6;
/// Layers that differ by more than this part of the travel of one do not move alike.
const APART: f64 = 1e-2;
/// A layer that moves by more than this part of its travel in one step has jumped.
const JUMP: f64 = 0.03;
/// Longest step of a layer to a minimum of the energy, as part of its travel, and the most steps.
const STRIDE: f64 = 5e-3;
const MOST_STRIDES: usize = 4000;
/// Forces that differ by less than this part of the largest are equal.
const EQUAL: f64 = 1e-9;
/// Stiffnesses below this part of the largest count as this in a step.
const SOFT: f64 = 1e-2;

/// What layers in series do.
#[derive(Clone, Debug, PartialEq)]
pub struct Stack {
    /// Displacement of the whole from which the layers do not move alike, m; `None` if they do up to the end.
    pub apart_from_m: Option<f64>,
    /// Jumps of a layer on the way there.
    pub jumps: usize,
    /// Displacement of the whole, m, and force, N, on the way there.
    pub loading: [Vec<f64>; 2],
    /// And on the way back.
    pub unloading: [Vec<f64>; 2],
}

/// The layers and the force of each over its displacement, from the curve of the whole.
struct Layers<'a> {
    curve: &'a ForceCurve,
    count: f64,
    travel_m: f64,
    stiffest_n_per_m: f64,
    largest_n: f64,
    at_m: Vec<f64>,
}

impl Stack {
    /// Follows a stack of at least two layers by the curve that holds while all move alike.
    pub(crate) fn of(curve: &ForceCurve, count: u32) -> Self {
        let mut layers = Layers::new(curve, count);
        let (mut apart_from_m, mut jumps) = (None, 0);
        let mut way = |down: bool| {
            let mut path = [Vec::new(), Vec::new()];
            for step in 0..=STEPS {
                let part = step as f64 / STEPS as f64;
                let whole_m = layers.count * layers.travel_m * if down { 1.0 - part } else { part };
                let before = layers.at_m.clone();
                layers.carry_to(whole_m);
                let largest = before.iter().zip(&layers.at_m).map(|(a, b)| (b - a).abs()).fold(0.0, f64::max);
                let spread = layers.at_m.iter().fold(0.0_f64, |m, x| m.max(*x)) - layers.at_m.iter().fold(f64::INFINITY, |m, x| m.min(*x));
                if !down {
                    jumps += usize::from(largest > JUMP * layers.travel_m);
                    apart_from_m = apart_from_m.or((spread > APART * layers.travel_m).then_some(whole_m));
                }
                path[0].push(whole_m);
                path[1].push(layers.force_n());
            }
            path
        };
        let loading = way(false);
        let unloading = way(true);
        Self { apart_from_m, jumps, loading, unloading }
    }
}

impl<'a> Layers<'a> {
    fn new(curve: &'a ForceCurve, count: u32) -> Self {
        let layers = (0..count).map(|_| 0.0).collect();
        let count = f64::from(count);
        let place = |i: usize| curve.start() + (curve.end() - curve.start()) * i as f64 / STEPS as f64;
        let largest = |f: &dyn Fn(f64) -> f64| (0..=STEPS).map(|i| f(place(i)).abs()).fold(f64::MIN_POSITIVE, f64::max);
        Self {
            curve,
            count,
            travel_m: curve.end() / count,
            stiffest_n_per_m: count * largest(&|x| curve.slope(x)),
            largest_n: largest(&|x| curve.force(x)),
            at_m: layers,
        }
    }

    /// Force of a layer, N, at its displacement.
    fn force_of(&self, at_m: f64) -> f64 {
        self.curve.force(self.count * at_m)
    }

    /// Force that all carry, N: the mean, which rounding and imperfection keep.
    fn force_n(&self) -> f64 {
        let free: Vec<f64> = self.at_m.iter().copied().filter(|x| *x > 0.0 && *x < self.travel_m).collect();
        let of = if free.is_empty() { &self.at_m } else { &free };
        of.iter().map(|x| self.force_of(*x)).sum::<f64>() / of.len() as f64
    }

    /// Moves the whole to a displacement, each layer by the same amount, and lets the layers settle.
    fn carry_to(&mut self, whole_m: f64) {
        let middle = 0.5 * (self.count - 1.0);
        let missing = (whole_m - self.at_m.iter().sum::<f64>()) / self.count;
        for (i, x) in self.at_m.iter_mut().enumerate() {
            let apart = if whole_m > 0.0 { IMPERFECTION * self.travel_m * (i as f64 - middle) } else { 0.0 };
            *x = (*x + missing + apart).clamp(0.0, self.travel_m);
        }
        for _ in 0..MOST_STRIDES {
            if !self.stride(whole_m) {
                return;
            }
        }
    }

    /// A step of Newton's method that goes down the energy where that is curved downwards; false if all carry the same force.
    fn stride(&mut self, whole_m: f64) -> bool {
        let force: Vec<f64> = self.at_m.iter().map(|x| self.force_of(*x)).collect();
        let give = |i: usize| 1.0 / (self.count * self.curve.slope(self.count * self.at_m[i])).abs().max(SOFT * self.stiffest_n_per_m);
        let give: Vec<f64> = (0..force.len()).map(give).collect();
        // Layers at an end of their curve push against it; the others share what is missing.
        let mut free = vec![true; force.len()];
        let missing = whole_m - self.at_m.iter().sum::<f64>();
        let step = loop {
            let all = || (0..free.len()).filter(|i| free[*i]);
            let sum: f64 = all().map(|i| give[i]).sum();
            if sum <= 0.0 {
                return false;
            }
            let level = (all().map(|i| give[i] * force[i]).sum::<f64>() + missing) / sum;
            let step: Vec<f64> = (0..free.len()).map(|i| if free[i] { give[i] * (level - force[i]) } else { 0.0 }).collect();
            let held = |i: usize| (self.at_m[i] <= 0.0 && step[i] < 0.0) || (self.at_m[i] >= self.travel_m && step[i] > 0.0);
            let Some(stopped) = (0..free.len()).find(|i| free[*i] && held(*i)) else {
                let open = all().map(|i| (level - force[i]).abs()).fold(0.0, f64::max);
                if open <= EQUAL * self.largest_n {
                    return false;
                }
                break step;
            };
            free[stopped] = false;
        };
        let longest = step.iter().fold(0.0_f64, |m, s| m.max(s.abs()));
        let part = (STRIDE * self.travel_m / longest).min(1.0);
        for (x, s) in self.at_m.iter_mut().zip(&step) {
            *x = (*x + part * s).clamp(0.0, self.travel_m);
        }
        true
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// F = 3x − 4.5x² + 2x³ on [0, 1.2]: falls between its turns.
    fn curve(layers: f64, cubic: [f64; 3]) -> ForceCurve {
        let [a, b, c] = cubic;
        let x: Vec<f64> = (0..=240).map(|i| 1.2 * f64::from(i) / 240.0).collect();
        let force = x.iter().map(|x| a * x + b * x * x + c * x * x * x).collect();
        let slope = x.iter().map(|x| (a + 2.0 * b * x + 3.0 * c * x * x) / layers).collect();
        ForceCurve::new(x.iter().map(|x| layers * x).collect(), force, slope)
    }

    #[test]
    fn layers_of_rising_force_move_alike() {
        for count in [2, 3] {
            let curve = curve(f64::from(count), [3.0, -2.9, 1.0]);
            let stack = Stack::of(&curve, count);
            assert_eq!((stack.apart_from_m, stack.jumps), (None, 0));
            for [x, f] in [&stack.loading, &stack.unloading] {
                let worst = x.iter().zip(f).map(|(x, f)| (curve.force(*x) - f).abs()).fold(0.0, f64::max);
                assert!(worst < 1e-6, "{worst}");
            }
        }
    }

    /// F = 3x − 4.5x² + 2x³ rises to 0.625 at ½, falls to 0.5 at 1. Two layers part where the force is largest, at Δ = 1. Up to there both
    /// carry the same; then one runs ahead at a force that falls. Forces are those of the curve, and the way back is another one.
    #[test]
    fn layers_of_falling_force_part_at_the_maximum() {
        let curve = curve(2.0, [3.0, -4.5, 2.0]);
        let stack = Stack::of(&curve, 2);
        let apart = stack.apart_from_m.expect("they part");
        assert!((apart - 1.0).abs() < 0.03, "{apart}");
        let [x, f] = &stack.loading;
        let at = |x: &[f64], f: &[f64], place: f64| f[x.iter().position(|x| (x - place).abs() < 4e-3).expect("a station")];
        assert!((at(x, f, 0.9) - curve.force(0.9)).abs() < 1e-6);
        assert!(f.iter().all(|f| *f <= 0.625 + 1e-6), "more than the curve has");
        // Both beyond the minimum move alike again.
        assert!((f[STEPS] - curve.force(2.4)).abs() < 1e-6);
        let [x, back] = &stack.unloading;
        assert!(back.iter().zip(x).all(|(f, x)| *x > 2.3 || *f >= -1e-9));
        assert!((at(x, back, 0.42) - curve.force(0.42)).abs() < 1e-6, "alike again at the beginning");
    }

    /// The part of a state in which one of two layers is beyond the maximum: equal forces, and the stiffness of one may be negative only if
    /// its size is less than that of the other.
    #[test]
    fn states_are_stable() {
        let curve = curve(2.0, [3.0, -4.5, 2.0]);
        let mut layers = Layers::new(&curve, 2);
        for step in 0..=STEPS {
            layers.carry_to(2.4 * step as f64 / STEPS as f64);
            let [a, b] = [layers.at_m[0], layers.at_m[1]];
            let slope = |x: f64| 3.0 - 9.0 * x + 6.0 * x * x;
            let inside = [a, b].iter().all(|x| *x > 1e-6 && *x < 1.2 - 1e-6);
            if inside {
                assert!((layers.force_of(a) - layers.force_of(b)).abs() < 1e-6 * layers.largest_n);
                assert!(slope(a) + slope(b) > -1e-3, "{a} {b}");
            }
        }
    }
}
