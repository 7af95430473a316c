//! The tension of a cable on a drum, with the memory of sticking and slipping.
//!
//! The logarithm of the tension is piecewise linear in the angle, with slopes −μ, 0 or μ: exact, no discretisation. A new tension at the
//! span lays a line of slope ∓μ over it as far as the old field lies on the other side; the rest sticks.

use forcewright_base::maths::{exp, exp_m1};
use forcewright_base::quadrature::GaussLegendre;

/// Difference of the logarithm of the tension that counts as none.
const SLIVER: f64 = 1e-12;

/// The field begins here and goes on to the next knot, or to the end of the wrap.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Knot {
    pub(super) angle_rad: f64,
    /// `ln(T/T_p)`.
    pub(super) log: f64,
    /// Slope of the logarithm over μ: −1, 0 or 1.
    pub(super) slope: i8,
}

/// Tension over a wrap; angle 0 is at a free span.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Field {
    friction: f64,
    wrap_rad: f64,
    preload_n: f64,
    /// `r/AE`, m/N.
    strain_m_per_n: f64,
    knots: Vec<Knot>,
}

/// What a new tension at the span does.
#[derive(Clone, Copy, Debug)]
pub(super) struct Probe {
    /// Further elongation, m.
    pub(super) elongation_m: f64,
    /// Its derivative by the logarithm of the tension, m.
    pub(super) per_log_m: f64,
    /// Angle that slips, rad.
    pub(super) front_rad: f64,
    pub(super) at_end: bool,
}

/// How far a new line reaches.
struct Front {
    segment: usize,
    angle_rad: f64,
    at_end: bool,
}

impl Field {
    pub(super) fn at_rest(radius_m: f64, friction: f64, wrap_rad: f64, axial_stiffness_n: f64, preload_n: f64) -> Self {
        let knots = vec![Knot { angle_rad: 0.0, log: 0.0, slope: 0 }];
        Self { friction, wrap_rad, preload_n, strain_m_per_n: radius_m / axial_stiffness_n, knots }
    }

    /// The same seen from the other end.
    pub(super) fn turned(&self) -> Self {
        let seen = |i: usize| {
            let angle_rad = self.wrap_rad - self.end_rad(i);
            Knot { angle_rad, log: self.log_in(i, self.end_rad(i)), slope: -self.knots[i].slope }
        };
        Self { knots: (0..self.knots.len()).rev().map(seen).collect(), ..*self }
    }

    pub(super) fn knots(&self) -> &[Knot] {
        &self.knots
    }

    pub(super) fn tension_n(&self, angle_rad: f64) -> f64 {
        let angle_rad = angle_rad.clamp(0.0, self.wrap_rad);
        let segment = self.knots.iter().rposition(|knot| knot.angle_rad <= angle_rad).unwrap_or(0);
        self.preload_n * exp(self.log_in(segment, angle_rad))
    }

    fn log_at_span(&self) -> f64 {
        self.knots[0].log
    }

    fn end_rad(&self, segment: usize) -> f64 {
        self.knots.get(segment + 1).map_or(self.wrap_rad, |knot| knot.angle_rad)
    }

    fn log_in(&self, segment: usize, angle_rad: f64) -> f64 {
        let knot = self.knots[segment];
        knot.log + f64::from(knot.slope) * self.friction * (angle_rad - knot.angle_rad)
    }

    /// Where the line from `log` inwards, falling for `sign` 1 and rising for −1, meets the field.
    fn front(&self, log: f64, sign: f64) -> Front {
        for (segment, knot) in self.knots.iter().enumerate() {
            let gap = (sign * (log - knot.log) - self.friction * knot.angle_rad).max(0.0);
            let closing = self.friction * (1.0 + sign * f64::from(knot.slope));
            // Parallel to the line where it slipped this way before: then only the next segment can meet it.
            let angle_rad = knot.angle_rad + if gap > 0.0 { gap / closing } else { 0.0 };
            if angle_rad <= self.end_rad(segment) && (closing > 0.0 || gap <= 0.0) {
                let at_end = angle_rad >= self.wrap_rad;
                return Front { segment, angle_rad, at_end };
            }
        }
        Front { segment: self.knots.len() - 1, angle_rad: self.wrap_rad, at_end: true }
    }

    /// `∫T dθ` of a piece of slope `slope · μ`, over the tension it begins with, rad.
    fn reduced(&self, slope: i8, length_rad: f64) -> f64 {
        let rise = f64::from(slope) * self.friction;
        if slope == 0 { length_rad } else { exp_m1(rise * length_rad) / rise }
    }

    /// The wrap, prepared for many candidate tensions at its span.
    pub(super) fn candidates(&self) -> Candidates<'_> {
        let mut sum = 0.0;
        let ratios: Vec<f64> = self.knots.iter().map(|knot| exp(knot.log)).collect();
        let mut before = Vec::with_capacity(self.knots.len());
        for (i, (knot, ratio)) in self.knots.iter().zip(&ratios).enumerate() {
            before.push(sum);
            sum += ratio * self.reduced(knot.slope, self.end_rad(i) - knot.angle_rad);
        }
        Candidates { field: self, ratios, before, scale_m: self.strain_m_per_n * self.preload_n }
    }

    /// Takes the new tension at the span; returns the energy that friction takes, J.
    pub(super) fn apply(&mut self, log: f64, rule: &GaussLegendre) -> f64 {
        let change = log - self.log_at_span();
        if change == 0.0 {
            return 0.0;
        }
        let sign = change.signum();
        let lost_j = self.friction_work_j(log, sign, rule);
        let front = self.front(log, sign);
        let mut knots = vec![Knot { angle_rad: 0.0, log, slope: against(sign) }];
        if !front.at_end {
            // The line's own value, so that the field has no step.
            let met = log - sign * self.friction * front.angle_rad;
            let left = self.friction * (self.end_rad(front.segment) - front.angle_rad);
            let goes_on = self.knots.get(front.segment + 1).is_some_and(|next| next.slope == against(sign));
            if left < SLIVER && goes_on {
                // Back where the last step in this direction ended: rounding leaves no trace.
                knots.extend_from_slice(&self.knots[front.segment + 2..]);
            } else {
                knots.push(Knot { angle_rad: front.angle_rad, log: met, slope: self.knots[front.segment].slope });
                knots.extend_from_slice(&self.knots[front.segment + 1..]);
            }
        }
        self.knots = knots;
        lost_j
    }

    /// While the logarithm λ of the tension T at the span moves with the tension T* at the front, friction takes
    /// `r (T − T*)²/(2μ AE) |dλ|`: its force is μT dθ, and a point slips by `r/(μ AE) |T(θ) − T*| |dλ|`.
    fn friction_work_j(&self, log: f64, sign: f64, rule: &GaussLegendre) -> f64 {
        let scale_j = 0.5 * self.strain_m_per_n / self.friction * self.preload_n * self.preload_n;
        let mut sum = 0.0;
        let mut from = self.log_at_span();
        for segment in 0..self.knots.len() {
            let knot = self.knots[segment];
            if knot.slope == against(sign) {
                // The front runs through a parallel piece at once.
                continue;
            }
            let end_rad = self.end_rad(segment);
            let last = self.log_in(segment, end_rad) + sign * self.friction * end_rad;
            let to = if sign * (log - last) < 0.0 { log } else { last };
            let slope = f64::from(knot.slope);
            let ratio = |lambda: f64| {
                let gap = (sign * (lambda - knot.log) - self.friction * knot.angle_rad) / (1.0 + sign * slope);
                knot.log + slope * gap
            };
            sum += squares(from, to, ratio, rule);
            from = to;
            if to.to_bits() == log.to_bits() {
                return scale_j * sum;
            }
        }
        // The whole wrap slips against its end.
        scale_j * (sum + squares(from, log, |lambda| lambda - sign * self.friction * self.wrap_rad, rule))
    }

    /// Elastic energy of the cable on the drum, J.
    pub(super) fn energy_j(&self) -> f64 {
        let squared = |i: usize| {
            let (knot, length_rad) = (self.knots[i], self.end_rad(i) - self.knots[i].angle_rad);
            let rise = 2.0 * f64::from(knot.slope) * self.friction;
            exp(2.0 * knot.log) * if knot.slope == 0 { length_rad } else { exp_m1(rise * length_rad) / rise }
        };
        0.5 * self.strain_m_per_n * self.preload_n * self.preload_n * (0..self.knots.len()).map(squared).sum::<f64>()
    }
}

/// A wrap whose old tensions are integrated once, for many candidate tensions at the span.
#[derive(Clone, Debug)]
pub(super) struct Candidates<'a> {
    field: &'a Field,
    /// `T/T_p` at each knot.
    ratios: Vec<f64>,
    /// `∫T dθ/T_p` from the span to each knot, rad.
    before: Vec<f64>,
    /// `r T_p/AE`, m.
    scale_m: f64,
}

impl Candidates<'_> {
    /// What a tension at the span does that is `ratio` = exp(`log`) times the preload.
    pub(super) fn probe(&self, log: f64, ratio: f64) -> Probe {
        let field = self.field;
        let change = log - field.log_at_span();
        if change == 0.0 {
            return Probe { elongation_m: 0.0, per_log_m: 0.0, front_rad: 0.0, at_end: false };
        }
        let sign = change.signum();
        let front = field.front(log, sign);
        let knot = field.knots[front.segment];
        let new = ratio * field.reduced(against(sign), front.angle_rad);
        let old = self.before[front.segment] + self.ratios[front.segment] * field.reduced(knot.slope, front.angle_rad - knot.angle_rad);
        let scale_m = self.scale_m;
        Probe { elongation_m: scale_m * (new - old), per_log_m: scale_m * new, front_rad: front.angle_rad, at_end: front.at_end }
    }
}

/// Slope of the line of a tension that rises (`sign` 1) or falls at the span.
fn against(sign: f64) -> i8 {
    if sign > 0.0 { -1 } else { 1 }
}

/// `|∫(e^λ − e^f(λ))² dλ|` by quadrature in pieces of at most 2: the integrand is entire, 12 points are exact to rounding.
fn squares(from: f64, to: f64, front: impl Fn(f64) -> f64, rule: &GaussLegendre) -> f64 {
    let pieces = (0.5 * (to - from).abs()).ceil().max(1.0);
    let width = (to - from) / pieces;
    let (mut sum, mut done) = (0.0, 0.0);
    // Logarithms of tensions differ by less than twice 745.
    while done < pieces.min(1e3) {
        let start = from + done * width;
        sum += rule.integrate(|u| {
            let lambda = start + u * width;
            let f = front(lambda);
            let difference = exp(f) * exp_m1(lambda - f);
            difference * difference
        });
        done += 1.0;
    }
    sum * width.abs()
}
