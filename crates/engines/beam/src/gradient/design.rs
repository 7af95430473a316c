//! From derivatives by pieces to derivatives by the quantities of the network.

use forcewright_base::{maths, quadrature::GaussLegendre};

use super::{BeamGradient, Gradient, compute::Design, compute::Gradients};
use crate::{model::BeamModel, state::BeamLine};

/// Derivatives by one beam while they are collected, SI.
struct Collected {
    angle: Vec<f64>,
    length: f64,
    /// By a thickness that does not vary.
    thickness: f64,
    profile: Vec<f64>,
    depth: f64,
    young: f64,
    poisson: f64,
    arms: [[f64; 2]; 2],
    /// By the places where the flexible part begins and ends, the arms held.
    flexible: [f64; 2],
}

impl Gradients<'_> {
    /// From logarithmic derivatives by dimensionless constants to the quantities of the network.
    pub(super) fn in_si(&self, design: &Design, unit: f64) -> Gradient {
        let shift: Vec<[f64; 2]> = design.shift.iter().map(|s| s.map(|v| v * unit / self.model.length_m)).collect();
        let mut beams: Vec<Collected> = (0..self.model.spans.len()).map(|beam| self.collect(beam, design, unit)).collect();
        for beam in 0..beams.len() {
            self.resolve_zones(beam, &mut beams);
        }
        self.close(beams, shift)
    }

    fn collect(&self, beam: usize, design: &Design, unit: f64) -> Collected {
        let (span, line) = &self.model.spans[beam];
        let pieces = &self.model.beams[span.clone()];
        let length_m = line.shape.length_m();
        let varies = pieces.iter().any(|p| p.info.thickness_m.is_some());
        let mut sum = Collected {
            angle: vec![0.0; line.shape.angle_rad().len()],
            length: 0.0,
            thickness: 0.0,
            profile: vec![0.0; line.profile.len()],
            depth: 0.0,
            young: 0.0,
            poisson: 0.0,
            arms: [[0.0; 2]; 2],
            flexible: [0.0; 2],
        };
        for (number, (piece, s)) in pieces.iter().zip(&design.pieces[span.clone()]).enumerate() {
            let section = &piece.info.section;
            for (target, value) in sum.angle.iter_mut().zip(&s.angles) {
                *target += unit * value;
            }
            // EI/L ∝ E w³ b/L, 1/EA ∝ 1/(E w b), 1/kGA ∝ (1 + ν)/(E w b).
            let soft = s.axial + s.shear;
            let by_length = unit * (s.length - s.bending);
            sum.length += (by_length + unit * s.beam_length) / length_m;
            sum.thickness += unit * (3.0 * s.bending - soft + s.thickness) / section.thickness_m;
            sum.depth += unit * (s.bending - soft + s.depth) / section.depth_m;
            sum.young += unit * (s.bending - soft) / section.young_pa;
            sum.poisson += section.poisson.map_or(0.0, |nu| unit * s.shear / (1.0 + nu));
            if varies {
                self.add_profile(beam, piece, s.profile.map(|v| unit * v / section.thickness_m), &mut sum);
            }
            let [from, to] = piece.info.range;
            let by_edge = [-1.0, 1.0].map(|sign| sign * by_length / (to - from));
            let outer = [number == 0, number + 1 == pieces.len()];
            for end in (0..2).filter(|end| outer[*end]) {
                sum.arms[end] = s.arms[end].map(|v| v * unit / self.model.length_m);
                sum.flexible[end] += by_edge[end] + unit * s.range[end];
            }
        }
        if varies {
            sum.thickness = sum.profile.iter().sum();
        }
        sum
    }

    /// Distributes derivatives by the thickness at the ends of a piece to the places where it is given.
    fn add_profile(&self, beam: usize, piece: &BeamModel, by_ends: [f64; 2], sum: &mut Collected) {
        let places = &self.model.spans[beam].1.profile;
        let [from, to] = piece.info.range;
        // All of the piece is between two places.
        let middle = 0.5 * (from + to);
        let after = places.partition_point(|p| p[0] <= middle).clamp(1, places.len() - 1);
        let (a, b) = (places[after - 1], places[after]);
        for ((end, u), value) in [from, to].into_iter().enumerate().zip(by_ends) {
            let share = (u - a[0]) / (b[0] - a[0]);
            sum.profile[after - 1] += (1.0 - share) * value;
            sum.profile[after] += share * value;
            if (end == 0 && u > 0.0 && u > a[0]) || (end == 1 && u < 1.0 && u < b[0]) {
                // Where a zone cuts the profile, its edge moves along the taper.
                sum.flexible[end] += value * (b[1] - a[1]) / (b[0] - a[0]);
            }
        }
    }

    /// Replaces what depends on rigid zones by what the zones depend on.
    fn resolve_zones(&self, beam: usize, beams: &mut [Collected]) {
        let line = &self.model.spans[beam].1;
        let (length_m, [from, to]) = (line.shape.length_m(), line.flexible);
        for (end, u) in [from, to].into_iter().enumerate() {
            let zone = self.zones.at[beam][end];
            let Some(cause) = zone.cause else { continue };
            let by_arm = beams[beam].arms[end];
            // The arm reaches from the end of the beam to the edge of the zone.
            let (sin, cos) = maths::sin_cos(line.shape.angle_at(u));
            let by_edge = beams[beam].flexible[end] + length_m * (by_arm[0] * cos + by_arm[1] * sin);
            let arm = arm_moments(line, end as f64, u);
            for (k, by_angle) in arm.iter().enumerate() {
                // By c_k the arm changes by the quarter turn of L ∫ uᵏ t du.
                beams[beam].angle[k] += length_m * (by_arm[1] * by_angle[0] - by_arm[0] * by_angle[1]);
            }
            beams[beam].length += by_arm[0] * arm[0][0] + by_arm[1] * arm[0][1];
            // u = s/L at the start, 1 − s/L at the end.
            let sign = if end == 0 { 1.0 } else { -1.0 };
            beams[beam].length -= by_edge * sign * zone.length_m / (length_m * length_m);
            let by_zone = sign * by_edge / length_m;
            add_direction(&mut beams[beam], end, by_zone * cause.by_angle);
            add_direction(&mut beams[cause.beam], cause.end, -by_zone * cause.by_angle);
            add_thickness(&mut beams[beam], end, by_zone * cause.by_own_thickness);
            add_thickness(&mut beams[cause.beam], cause.end, by_zone * cause.by_other_thickness);
        }
    }

    /// Beams that stay closed.
    fn close(&self, collected: Vec<Collected>, shift: Vec<[f64; 2]>) -> Gradient {
        let mut nodes = shift.clone();
        let mut beams = Vec::with_capacity(collected.len());
        for ((c, closure), (span, _)) in collected.into_iter().zip(&self.closures).zip(&self.model.spans) {
            let ends = [self.model.beams[span.start].nodes[0], self.model.beams[span.end - 1].nodes[1]];
            let mut arms = c.arms;
            for (i, (by_angle, by_length)) in closure.angle_by_chord_rad_per_m.iter().zip(closure.length_by_chord).enumerate() {
                let by_chord = c.angle[0] * by_angle + c.length * by_length;
                nodes[ends[0]][i] -= by_chord;
                nodes[ends[1]][i] += by_chord;
                arms[0][i] -= by_chord;
                arms[1][i] += by_chord;
            }
            let closed = closure.angle_by_bend.iter().zip(&closure.length_by_bend_m);
            beams.push(BeamGradient {
                bend: c.angle[1..].iter().zip(closed).map(|(own, (a, l))| own + c.angle[0] * a + c.length * l).collect(),
                angle: c.angle,
                length: c.length,
                thickness: c.thickness,
                profile: c.profile,
                arms,
                depth: c.depth,
                young: c.young,
                poisson: c.poisson,
            });
        }
        Gradient { beams, nodes, shift }
    }
}

/// Changes the direction of a beam at one of its ends.
fn add_direction(beam: &mut Collected, end: usize, value: f64) {
    let coefficients = if end == 0 { 1 } else { beam.angle.len() };
    for target in beam.angle.iter_mut().take(coefficients) {
        *target += value;
    }
}

/// Changes the thickness of a beam at one of its ends.
fn add_thickness(beam: &mut Collected, end: usize, value: f64) {
    beam.thickness += value;
    let place = if end == 0 { beam.profile.first_mut() } else { beam.profile.last_mut() };
    if let Some(place) = place {
        *place += value;
    }
}

/// ∫ uᵏ (cos η, sin η) du from one place of a beam to another, k = 0 … m.
pub(super) fn arm_moments(line: &BeamLine, from: f64, to: f64) -> Vec<[f64; 2]> {
    // A zone turns little: one panel does.
    let rule = GaussLegendre::new(16);
    let mut sums = vec![[0.0; 2]; line.shape.angle_rad().len()];
    for (&v, &weight) in rule.nodes().iter().zip(rule.weights()) {
        let u = from + (to - from) * v;
        let (sin, cos) = maths::sin_cos(line.shape.angle_at(u));
        let mut factor = weight * (to - from);
        for sum in &mut sums {
            sum[0] += factor * cos;
            sum[1] += factor * sin;
            factor *= u;
        }
    }
    sums
}
