//! The largest stress of four designs: surveyed at the states, interpolated between them.
//!
//! Of every beam the stress at both ends is interpolated, and that at the highest maximum inside of each sign. Where such a maximum
//! begins or ends between two states, is not the same at both, or moves unevenly, it is looked for at each station.

#![allow(clippy::needless_range_loop, reason = "sums over modes are read by their indices")]

use forcewright_base::maths;
use forcewright_base::quadrature::legendre_values;

use crate::element::root_of;
use crate::fast::kernel::Unknowns;
use crate::fast::lanes::{LANES, Lane};
use crate::fast::stress::{MODES, Maximum, OneBeam, StressModel};

/// A beam of four designs at one state, with derivatives by the part of the travel.
#[derive(Clone, Copy, Debug)]
pub(super) struct BeamState<const M: usize, const E: usize> {
    pub(super) at: Unknowns<M>,
    pub(super) by: Unknowns<M>,
    pub(super) beyond: [Lane; E],
    pub(super) beyond_by: [Lane; E],
    pub(super) survey: Survey,
}

/// What is known about the stress of a beam of four designs at one state.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Survey {
    /// dφ/du at the start, in the middle and at the end, and its derivative.
    pub(super) slope: [Lane; 3],
    pub(super) slope_by: [Lane; 3],
    /// Force along the beam at both ends, and its derivative; only where that makes stress.
    axial: [Lane; 2],
    axial_by: [Lane; 2],
    /// Largest stress inside with positive and with negative slope.
    inside: [Inside; 2],
}

/// A maximum of the stress inside a beam; all 0 in lanes that have none that matters.
#[derive(Clone, Copy, Debug, Default)]
struct Inside {
    stress: Lane,
    by: Lane,
    place: Lane,
    place_by: Lane,
    /// The part of the second derivative of the stress that is due to the motion of its place.
    drift: Lane,
}

impl Inside {
    fn set(&mut self, lane: usize, one: &Maximum) {
        (self.stress.0[lane], self.by.0[lane]) = (one.stress, one.by);
        (self.place.0[lane], self.place_by.0[lane], self.drift.0[lane]) = (one.place, one.place_by, one.drift);
    }
}

impl<const M: usize, const E: usize> Default for BeamState<M, E> {
    fn default() -> Self {
        let (at, beyond) = (Unknowns::default(), [Lane::ZERO; E]);
        Self { at, by: at, beyond, beyond_by: beyond, survey: Survey::default() }
    }
}

/// Maxima inside below this part of the largest stress of a state are not recorded.
const FAR: f64 = 0.6;
/// A sample is at least this part of the maximum next to it.
const SAMPLED: f64 = 0.9;
/// A maximum that is looked for between two states matters if it is at least this part of the largest stress at one of them, where it is
/// known at one only: it may have been larger before it was there.
const CLOSE: f64 = 0.7;
/// The same by its interpolated value, where it is known at both.
const CLOSE_BETWEEN: f64 = 0.95;
/// Maxima of two states are the same if the way from one to the other is the mean of both rates up to this part of the beam.
const SAME: f64 = 0.05;
/// Largest change from state to state, as part of the stress and per accuracy of the force, of what the motion of the maximum adds to the
/// second differences of its stress, so that the interpolation is as good as that of the stress at the ends; from the random designs of
/// the tests.
const UNEVEN: f64 = 200.0;

/// Slopes of the modes at Chebyshev points, of which the first half is kept: they are even or odd about the middle.
#[derive(Debug)]
pub(super) struct Sampling<const M: usize, const E: usize> {
    slope: Vec<([Lane; M], [Lane; E])>,
    place: Vec<f64>,
    /// Second derivatives at the end.
    bend: ([Lane; M], [Lane; E]),
    /// Size of the slope of the beam that was sampled last, and how fast its stress rises from both ends.
    samples: Vec<Lane>,
    start_rises: Lane,
    end_rises: Lane,
}

impl<const M: usize, const E: usize> Sampling<M, E> {
    pub(super) fn new() -> Self {
        // One point in the middle.
        let half = (M + E).div_ceil(2) + 1;
        let place = |i: usize| 0.5 - 0.5 * maths::cos(std::f64::consts::FRAC_PI_2 * i as f64 / half as f64);
        let slope = |i: usize| {
            let mut p = vec![0.0; M + E + 2];
            legendre_values(2.0 * place(i) - 1.0, &mut p);
            let factor = |k: usize| Lane::splat(root_of(k + 2) * p[k + 1]);
            (std::array::from_fn(factor), std::array::from_fn(|k| factor(M + k)))
        };
        // P_n' is n (n + 1)/2 at 1, with alternating sign at −1.
        let bend = |k: usize| Lane::splat(root_of(k + 2) * ((k + 1) * (k + 2)) as f64);
        Self {
            slope: (0..=half).map(slope).collect(),
            bend: (std::array::from_fn(bend), std::array::from_fn(|k| bend(M + k))),
            place: (0..=2 * half).map(place).collect(),
            samples: vec![Lane::ZERO; 2 * half + 1],
            start_rises: Lane::ZERO,
            end_rises: Lane::ZERO,
        }
    }

    /// dφ/du at a sampling point and at the one that mirrors it.
    #[inline(always)]
    fn pair(row: &([Lane; M], [Lane; E]), at: &Unknowns<M>, beyond: &[Lane; E]) -> [Lane; 2] {
        let (mut even, mut odd) = (at.ends[1] - at.ends[0], Lane::ZERO);
        // The slope of bubble k is a polynomial of degree k + 1.
        for k in 0..M + E {
            let part = if k < M { at.bubbles[k] * row.0[k] } else { beyond[k - M] * row.1[k - M] };
            if k % 2 == 0 {
                odd += part;
            } else {
                even += part;
            }
        }
        [even + odd, even - odd]
    }

    /// dφ/du at the start, in the middle and at the end.
    #[inline(always)]
    pub(super) fn slopes(&self, at: &Unknowns<M>, beyond: &[Lane; E]) -> [Lane; 3] {
        let [first, last] = Self::pair(&self.slope[0], at, beyond);
        let [middle, _] = Self::pair(&self.slope[self.slope.len() - 1], at, beyond);
        [first, middle, last]
    }

    /// How fast the stress rises from both ends inwards, Pa; the axial part by a bound.
    #[inline(always)]
    fn rises(&self, own: &StressModel, beam: &BeamState<M, E>) -> [Lane; 2] {
        let (mut even, mut odd) = (Lane::ZERO, Lane::ZERO);
        for k in 0..M + E {
            let part = if k < M { beam.at.bubbles[k] * self.bend.0[k] } else { beam.beyond[k - M] * self.bend.1[k - M] };
            // The other way round than the slopes themselves.
            if k % 2 == 0 {
                even += part;
            } else {
                odd += part;
            }
        }
        let force = beam.at.force[0].abs() + beam.at.force[1].abs();
        let inwards = |bend: Lane, slope: Lane, turn: Lane| {
            let signed = Lane::where_above(slope, Lane::ZERO, bend, -bend) * own.bending;
            if own.soft { signed + own.axial * force * (turn.abs() + slope.abs()) } else { signed }
        };
        let [start, _, end] = beam.survey.slope;
        [inwards(even - odd, start, own.turn[0]), inwards(-(even + odd), end, own.turn[1])]
    }

    /// Fills in what is known about the stress of all beams at a state. `angles` are the angles at rest of a beam of one design.
    #[inline(always)]
    pub(super) fn survey(
        &mut self,
        stress: &[StressModel],
        beams: &mut [BeamState<M, E>],
        angle_rad: impl Fn(usize, usize, &mut Vec<f64>),
    ) {
        let mut largest = Lane::ZERO;
        for (own, beam) in stress.iter().zip(beams.iter_mut()) {
            beam.survey.slope = self.slopes(&beam.at, &beam.beyond);
            beam.survey.slope_by = self.slopes(&beam.by, &beam.beyond_by);
            if own.soft {
                for end in 0..2 {
                    (beam.survey.axial[end], beam.survey.axial_by[end]) =
                        own.axial_force(end, (beam.at.ends[end], beam.by.ends[end]), (beam.at.force, beam.by.force));
                }
            }
            for i in [0, 2] {
                largest = largest.max(beam.survey.slope[i].abs() * own.bending);
            }
        }
        let least = largest * FAR;
        let mut angles = Vec::new();
        for (b, (own, beam)) in stress.iter().zip(beams.iter_mut()).enumerate() {
            beam.survey.inside = Default::default();
            let highest = self.sample(own, beam);
            for lane in 0..LANES {
                if highest.0[lane] > SAMPLED * least.0[lane] {
                    if own.soft {
                        angle_rad(b, lane, &mut angles);
                    }
                    self.inside(own, beam, lane, least.0[lane], &angles);
                }
            }
        }
    }

    /// Samples the slope along a beam, of which those at the ends and in the middle are known. Returns the largest stress at samples with
    /// a maximum next to them, the axial part by a bound.
    #[inline(always)]
    fn sample(&mut self, own: &StressModel, beam: &BeamState<M, E>) -> Lane {
        let last = self.samples.len() - 1;
        let [first, middle, end] = beam.survey.slope.map(Lane::abs);
        (self.samples[0], self.samples[last / 2], self.samples[last]) = (first, middle, end);
        for i in 1..last / 2 {
            let [left, right] = Self::pair(&self.slope[i], &beam.at, &beam.beyond);
            (self.samples[i], self.samples[last - i]) = (left.abs(), right.abs());
        }
        let zero = Lane::ZERO;
        // At the ends only where the stress rises inwards.
        let [start, end] = self.rises(own, beam);
        let mut highest = Lane::where_above(start, zero, self.samples[0], zero);
        highest = highest.max(Lane::where_above(end, zero, self.samples[last], zero));
        (self.start_rises, self.end_rises) = (start, end);
        let mut before = self.samples[0];
        for i in 1..last {
            let (here, after) = (self.samples[i], self.samples[i + 1]);
            // Equal neighbours count as maxima.
            let beside = before.max(after);
            highest = highest.max(Lane::where_above(beside, here, zero, here));
            before = here;
        }
        let bending = highest * own.bending;
        if own.soft { bending + own.axial * (beam.at.force[0].abs() + beam.at.force[1].abs()) } else { bending }
    }

    /// Looks for maxima inside a beam of one design that has just been sampled.
    fn inside(&self, own: &StressModel, beam: &mut BeamState<M, E>, lane: usize, least: f64, angle_rad: &[f64]) {
        let last = self.samples.len() - 1;
        let at = |i: usize| self.samples[i].0[lane];
        let rises = [self.start_rises.0[lane] > 0.0, self.end_rises.0[lane] > 0.0];
        let axial = own.axial.0[lane] * (beam.at.force[0].0[lane].abs() + beam.at.force[1].0[lane].abs());
        let floor = (SAMPLED * least - axial) / own.bending.0[lane];
        let one = one_beam(own, (&beam.at, &beam.beyond), lane, angle_rad);
        let by = one_beam(own, (&beam.by, &beam.beyond_by), lane, angle_rad);
        for i in 0..=last {
            let (left, here, right) = (at(i.saturating_sub(1)), at(i), at((i + 1).min(last)));
            let largest = here >= floor && here >= left && here >= right;
            if !largest || (i == 0 && !rises[0]) || (i == last && !rises[1]) {
                continue;
            }
            let (low, high) = (self.place[i.saturating_sub(1)], self.place[(i + 1).min(last)]);
            // From the vertex of the parabola through samples that are equally spaced in angle.
            let (bend, half) = (left - 2.0 * here + right, 0.5 * (high - low));
            let inner = i > 0 && i < last && bend < 0.0;
            let start = if inner { self.place[i] + 0.5 * half * (left - right) / bend } else { self.place[i] };
            let (u, height, side) = one.summit(start, (low, high));
            let record = &mut beam.survey.inside[usize::from(side < 0.0)];
            if height >= least && height > record.stress.0[lane] {
                record.set(lane, &one.maximum_by(&by, u));
            }
        }
    }

    /// The largest stress inside a beam, or less if that is below `floor`.
    fn largest_inside(&self, beam: &OneBeam<M, E>, tolerance: f64, floor: f64) -> f64 {
        let last = self.place.len() - 1;
        let mut samples = [0.0; MODES + 4];
        for (i, row) in self.slope.iter().enumerate() {
            let (mut even, mut odd) = (beam.ends[1] - beam.ends[0], 0.0);
            for k in 0..M + E {
                let part = if k < M { beam.bubbles[k] * row.0[k].0[0] } else { beam.beyond[k - M] * row.1[k - M].0[0] };
                if k % 2 == 0 {
                    odd += part;
                } else {
                    even += part;
                }
            }
            (samples[i], samples[last - i]) = ((even + odd).abs(), (even - odd).abs());
        }
        let axial = beam.factors[1] * (beam.force[0].abs() + beam.force[1].abs());
        let mut best = 0.0_f64;
        for i in 0..=last {
            let (before, after) = (i.saturating_sub(1), (i + 1).min(last));
            let highest = samples[i] >= samples[before] && samples[i] >= samples[after];
            if highest && samples[i] * beam.factors[0] + axial > SAMPLED * floor {
                let found = beam.maximum(self.place[i], (self.place[before], self.place[after]), tolerance, floor.max(best));
                best = best.max(found);
            }
        }
        best
    }
}

/// One beam of one design.
fn one_beam<'a, const M: usize, const E: usize>(
    own: &StressModel,
    (at, beyond): (&Unknowns<M>, &[Lane; E]),
    lane: usize,
    angle_rad: &'a [f64],
) -> OneBeam<'a, M, E> {
    OneBeam {
        ends: at.ends.map(|v| v.0[lane]),
        force: at.force.map(|v| v.0[lane]),
        bubbles: at.bubbles.map(|v| v.0[lane]),
        beyond: beyond.map(|v| v.0[lane]),
        factors: [own.bending.0[lane], own.axial.0[lane]],
        angle_rad,
    }
}

/// A maximum inside a beam of one design on the way from state to state.
#[derive(Clone, Copy, Debug)]
struct Passage {
    beam: usize,
    lane: usize,
    /// Stress and derivative at both states, where it is known at both.
    known: Option<[[f64; 2]; 2]>,
    /// Whether these tell the stress between the states.
    smooth: bool,
    /// The larger of the stresses.
    largest: f64,
}

impl Passage {
    /// Of maxima of the same sign at two states, of which one may be missing.
    fn new((beam, lane): (usize, usize), states: [&Inside; 2], (length, accuracy): (f64, f64)) -> Self {
        let of = |pick: fn(&Inside) -> Lane| states.map(|s| pick(s).0[lane]);
        let (stress, by) = (of(|s| s.stress), of(|s| s.by));
        let largest = stress[0].max(stress[1]);
        if !(stress[0] > 0.0 && stress[1] > 0.0) {
            return Self { beam, lane, known: None, smooth: false, largest };
        }
        let (place, rate, drift) = (of(|s| s.place), of(|s| s.place_by), of(|s| s.drift));
        let astray = place[1] - place[0] - 0.5 * length * (rate[0] + rate[1]);
        let uneven = length * length * (drift[1] - drift[0]);
        // Written so that NaN is not smooth.
        let smooth = astray.abs() < SAME && uneven.abs() < UNEVEN * accuracy * largest;
        Self { beam, lane, known: Some([[stress[0], by[0]], [stress[1], by[1]]]), smooth, largest }
    }
}

/// Two neighbouring states.
#[derive(Debug, Default)]
pub(super) struct Interval {
    passages: Vec<Passage>,
}

impl Interval {
    /// Notes the maxima inside beams. The states are a `length` apart, and the force is wanted to an `accuracy`.
    pub(super) fn enter<const M: usize, const E: usize>(&mut self, states: [&[BeamState<M, E>]; 2], (length, accuracy): (f64, f64)) {
        self.passages.clear();
        for (beam, (left, right)) in states[0].iter().zip(states[1]).enumerate() {
            for (left, right) in left.survey.inside.iter().zip(&right.survey.inside) {
                for lane in 0..LANES {
                    if left.stress.0[lane] > 0.0 || right.stress.0[lane] > 0.0 {
                        self.passages.push(Passage::new((beam, lane), [left, right], (length, accuracy)));
                    }
                }
            }
        }
    }

    /// Room of all buffers.
    pub(super) fn room(&self) -> usize {
        self.passages.capacity()
    }
}

/// A place between two neighbouring states: these, and the weights of their values and slopes.
#[derive(Clone, Copy)]
pub(super) struct Between<'a, const M: usize, const E: usize> {
    pub(super) states: [&'a [BeamState<M, E>]; 2],
    pub(super) weights: [[f64; 2]; 2],
}

impl<const M: usize, const E: usize> Between<'_, M, E> {
    #[inline(always)]
    fn mix(&self, beam: usize, pick: impl Fn(&Survey) -> [Lane; 2]) -> Lane {
        let [left, right] = self.states.map(|s| pick(&s[beam].survey));
        let [[a, b], [c, d]] = self.weights;
        left[0] * a + left[1] * b + right[0] * c + right[1] * d
    }

    /// The largest stress, Pa, and its beam.
    #[inline(always)]
    pub(super) fn peak(
        &self,
        sampling: &Sampling<M, E>,
        interval: &Interval,
        stress: &[StressModel],
        tolerance: f64,
        angle_rad: impl Fn(usize, usize, &mut Vec<f64>),
    ) -> (Lane, Lane) {
        let (mut best, mut which) = (Lane::ZERO, Lane::ZERO);
        for (beam, own) in stress.iter().enumerate() {
            let mut ends = [Lane::ZERO; 2];
            for end in 0..2 {
                ends[end] = self.mix(beam, |s| [s.slope[2 * end], s.slope_by[2 * end]]).abs() * own.bending;
                if own.soft {
                    ends[end] += self.mix(beam, |s| [s.axial[end], s.axial_by[end]]).abs() * own.axial;
                }
            }
            let value = ends[0].max(ends[1]);
            which = Lane::where_above(value, best, Lane::splat(beam as f64), which);
            best = best.max(value);
        }
        for p in &interval.passages {
            let floor = best.0[p.lane];
            let (mut value, mut close) = (p.largest, CLOSE);
            if let Some([[v, dv], [w, dw]]) = p.known {
                let [[a, b], [c, d]] = self.weights;
                (value, close) = (v * a + dv * b + w * c + dw * d, CLOSE_BETWEEN);
            }
            if !p.smooth {
                if value <= close * floor {
                    continue;
                }
                let mut angles = Vec::new();
                if stress[p.beam].soft {
                    angle_rad(p.beam, p.lane, &mut angles);
                }
                value = sampling.largest_inside(&self.one(&stress[p.beam], p, &angles), tolerance, floor);
            }
            if value > floor {
                (best.0[p.lane], which.0[p.lane]) = (value, p.beam as f64);
            }
        }
        (best, which)
    }

    /// The interpolated state of a beam.
    fn one<'a>(&self, own: &StressModel, passage: &Passage, angle_rad: &'a [f64]) -> OneBeam<'a, M, E> {
        let lane = passage.lane;
        let mut one = one_beam(own, (&Unknowns::<M>::default(), &[Lane::ZERO; E]), lane, angle_rad);
        for (state, [a, b]) in self.states.iter().zip(self.weights) {
            let s = &state[passage.beam];
            let mix = |target: &mut [f64], at: &[Lane], by: &[Lane]| {
                for (t, (v, d)) in target.iter_mut().zip(at.iter().zip(by)) {
                    *t += a * v.0[lane] + b * d.0[lane];
                }
            };
            mix(&mut one.ends, &s.at.ends, &s.by.ends);
            mix(&mut one.force, &s.at.force, &s.by.force);
            mix(&mut one.bubbles, &s.at.bubbles, &s.by.bubbles);
            mix(&mut one.beyond, &s.beyond, &s.beyond_by);
        }
        one
    }
}
