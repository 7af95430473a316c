//! The nearest place of a curve.

use crate::bounds::Bounds;
use crate::plane::{CurvePoint, PlaneCurve};
use crate::vector::{Vector, distance, dot, left, norm, sub, unit};

/// Samples of a curve, at equal steps of its parameter. A curve whose shape changes within a step may be missed.
const STEPS: usize = 512;

/// Samples in a block that is looked at together.
const BLOCK: usize = 16;

/// Samples of a curve, from which a search begins.
pub(super) struct Table {
    range: [f64; 2],
    /// Largest length per parameter of the samples, m.
    speed_m: f64,
    samples: Vec<Vector>,
    /// Boxes round the samples of each block.
    boxes: Vec<Bounds>,
}

/// The place of a curve that is nearest to a point.
pub(super) struct Nearest {
    pub(super) parameter: f64,
    pub(super) place: CurvePoint,
    /// To the left of the curve.
    pub(super) normal: Vector,
    /// Whether it is an end, and the point lies beyond.
    pub(super) is_end: bool,
}

impl Table {
    /// Absent if the range is empty or a sample is not finite.
    pub(super) fn new(curve: &dyn PlaneCurve) -> Option<Self> {
        let range = curve.range();
        if !(range[0] < range[1] && range[0].is_finite() && range[1].is_finite()) {
            return None;
        }
        let (mut samples, mut speed_m) = (Vec::with_capacity(STEPS + 1), 0.0_f64);
        for k in 0..=STEPS {
            let place = curve.at(parameter(range, k));
            if !place.is_finite() {
                return None;
            }
            samples.push(place.point_m);
            speed_m = speed_m.max(norm(place.first_m));
        }
        let boxes = samples.chunks(BLOCK).map(|block| Bounds::of(block.iter().copied())).collect();
        Some(Self { range, speed_m, samples, boxes })
    }

    pub(super) fn nearest(&self, curve: &dyn PlaneCurve, point: Vector) -> Nearest {
        let sample = self.nearest_sample(point);
        let mut low = parameter(self.range, sample.saturating_sub(1));
        let mut high = parameter(self.range, (sample + 1).min(STEPS));
        let mut at = parameter(self.range, sample);
        let mut place = curve.at(at);
        // Newton's method for (c − p)·c′ = 0 between the samples beside the nearest one; halves the bracket where it would leave it.
        for _ in 0..60 {
            let from = sub(place.point_m, point);
            let slope = dot(from, place.first_m);
            if slope > 0.0 {
                high = at;
            } else {
                low = at;
            }
            let bend = dot(place.first_m, place.first_m) + dot(from, place.second_m);
            let newton = at - slope / bend;
            let next = if bend > 0.0 && low <= newton && newton <= high { newton } else { 0.5 * (low + high) };
            let moved = (next - at).abs();
            at = next;
            place = curve.at(at);
            if moved <= 2.0 * f64::EPSILON * (self.range[0].abs().max(self.range[1].abs())) {
                break;
            }
        }
        self.finished(point, at, place)
    }

    fn finished(&self, point: Vector, parameter: f64, place: CurvePoint) -> Nearest {
        let [first, last] = self.range;
        let near = 1e-9 * (last - first);
        let away = sub(point, place.point_m);
        let speed = norm(place.first_m);
        // At an end, the point is beside the curve only if it lies on the normal; at a cusp there is none.
        let (along, aside) = (dot(away, place.first_m), 1e-6 * norm(away) * speed);
        let is_cusp = speed <= 1e-6 * self.speed_m;
        let before = parameter - first <= near && (is_cusp || along < -aside);
        let after = last - parameter <= near && (is_cusp || along > aside);
        Nearest { parameter, place, normal: left(unit(place.first_m)), is_end: before || after }
    }

    fn nearest_sample(&self, point: Vector) -> usize {
        let mut best = (f64::INFINITY, 0);
        for (block, (bounds, samples)) in self.boxes.iter().zip(self.samples.chunks(BLOCK)).enumerate() {
            let outside = |axis: usize| (bounds.min_m[axis] - point[axis]).max(point[axis] - bounds.max_m[axis]).max(0.0);
            if norm([outside(0), outside(1)]) >= best.0 {
                continue;
            }
            for (k, sample) in samples.iter().enumerate() {
                let away = distance(*sample, point);
                if away < best.0 {
                    best = (away, block * BLOCK + k);
                }
            }
        }
        best.1
    }
}

fn parameter([first, last]: [f64; 2], sample: usize) -> f64 {
    let part = sample as f64 / STEPS as f64;
    (1.0 - part) * first + part * last
}
