//! The centre line of a cable in space.

use forcewright_base::maths::{acos, hypot, sin_cos};

use super::{Drive, Drum, GeometryError};

/// Most points of a polyline.
const MOST_POINTS: usize = 1_000_000;

/// A part of a centre line on a drum.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Helix {
    /// Which drum.
    pub drum: Drum,
    /// x of the drum's axis, m; y is 0.
    pub axis_m: f64,
    /// To the middle of the rope, m.
    pub radius_m: f64,
    /// Angle about the drum's axis where the part begins, rad, in space.
    pub start_rad: f64,
    /// Angle from beginning to end, rad, positive anticlockwise about +z.
    pub sweep_rad: f64,
    /// z of the beginning, m.
    pub start_m: f64,
    /// z from beginning to end, m.
    pub rise_m: f64,
}

/// A free span.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Span {
    /// Where it leaves one drum, m.
    pub from_m: [f64; 3],
    /// Where it reaches the other, m.
    pub to_m: [f64; 3],
}

/// A part of a centre line.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Piece {
    /// On a drum.
    Helix(Helix),
    /// Between the drums.
    Span(Span),
}

/// A place on a centre line.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Station {
    /// Which piece, 0 to 4.
    pub piece: usize,
    /// Where, m.
    pub point_m: [f64; 3],
    /// Direction from end 0 to end 1, of length 1.
    pub tangent: [f64; 3],
}

impl Piece {
    /// Arc length, m.
    pub fn length_m(&self) -> f64 {
        match self {
            Self::Helix(h) => hypot(h.radius_m * h.sweep_rad, h.rise_m),
            Self::Span(s) => {
                let [x, y, z] = difference(s.to_m, s.from_m);
                hypot(hypot(x, y), z)
            }
        }
    }

    /// The point at a fraction of the piece's length, m.
    pub fn point_m(&self, fraction: f64) -> [f64; 3] {
        match self {
            Self::Helix(h) => {
                let (sin, cos) = sin_cos(h.start_rad + fraction * h.sweep_rad);
                [h.axis_m + h.radius_m * cos, h.radius_m * sin, h.start_m + fraction * h.rise_m]
            }
            Self::Span(s) => std::array::from_fn(|i| s.from_m[i] + fraction * (s.to_m[i] - s.from_m[i])),
        }
    }

    /// The direction at a fraction of the piece's length, of length 1; 0 for a piece without length.
    pub fn tangent(&self, fraction: f64) -> [f64; 3] {
        let along = match self {
            Self::Helix(h) => {
                let (sin, cos) = sin_cos(h.start_rad + fraction * h.sweep_rad);
                let arc = h.radius_m * h.sweep_rad;
                [-arc * sin, arc * cos, h.rise_m]
            }
            Self::Span(s) => difference(s.to_m, s.from_m),
        };
        let length = self.length_m();
        if length > 0.0 { along.map(|x| x / length) } else { [0.0; 3] }
    }
}

/// The centre line of one cable at one output angle: from end 0 on the output over the input to end 1 on the output.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CentreLine {
    /// Output, span, input, span, output.
    pub pieces: [Piece; 5],
}

impl CentreLine {
    /// Arc length between the anchors, m.
    pub fn length_m(&self) -> f64 {
        self.pieces.iter().map(Piece::length_m).sum()
    }

    /// The place at an arc length from end 0; beyond an end the end itself.
    pub fn at(&self, arc_length_m: f64) -> Station {
        let mut left = arc_length_m.max(0.0);
        for (piece, part) in self.pieces.iter().enumerate() {
            let length = part.length_m();
            if left <= length || piece + 1 == self.pieces.len() {
                let fraction = if length > 0.0 { (left / length).min(1.0) } else { 0.0 };
                return Station { piece, point_m: part.point_m(fraction), tangent: part.tangent(fraction) };
            }
            left -= length;
        }
        Station { piece: 0, point_m: self.pieces[0].point_m(0.0), tangent: self.pieces[0].tangent(0.0) }
    }

    /// Points for drawing, m: no chord is farther than `chord_error_m` from the line.
    ///
    /// # Errors
    /// [`GeometryError::Number`] unless the error is above 0; [`GeometryError::TooMany`] for more than a million points.
    pub fn polyline_m(&self, chord_error_m: f64) -> Result<Vec<[f64; 3]>, GeometryError> {
        if chord_error_m.is_nan() || chord_error_m <= 0.0 {
            return Err(GeometryError::Number { name: "chord error", value: chord_error_m });
        }
        let mut points = vec![self.pieces[0].point_m(0.0)];
        for piece in &self.pieces {
            let steps = match piece {
                // Sagitta r (1 − cos(step/2)) of the circle; with the climb a chord is nearer.
                Piece::Helix(h) => {
                    let step = 2.0 * acos((1.0 - chord_error_m / h.radius_m).max(0.0));
                    (h.sweep_rad.abs() / step).ceil().max(1.0)
                }
                Piece::Span(_) => 1.0,
            };
            let count = points.len() as f64 + steps;
            if count.is_nan() || count > MOST_POINTS as f64 {
                return Err(GeometryError::TooMany { count, limit: MOST_POINTS });
            }
            let mut i = 1.0;
            while i <= steps {
                points.push(piece.point_m(i / steps));
                i += 1.0;
            }
        }
        Ok(points)
    }
}

impl Drive {
    /// The centre line of a cable at an output angle.
    ///
    /// # Errors
    /// [`GeometryError::NoSuchCable`], [`GeometryError::OutsideTravel`].
    pub fn centre_line(&self, cable: usize, output_rad: f64) -> Result<CentreLine, GeometryError> {
        let [first_wrap, second_wrap] = self.output_wraps_rad(output_rad)?;
        let climbs = self.climbs_m(cable)?.map(|climb| climb + self.walk_climb_m(output_rad));
        let [first_tangent, second_tangent] = self.output_tangents_rad();
        let against = self.layout.belt.sign();
        let up = self.layout.hand.sign();
        let helix = |drum: Drum, start_rad: f64, sweep_rad: f64, start_climb_m: f64| {
            Piece::Helix(Helix {
                drum,
                axis_m: self.axis_m(drum),
                radius_m: self.radius_m(drum),
                start_rad,
                sweep_rad,
                start_m: up * start_climb_m,
                rise_m: up * self.lead_m_per_rad(drum) * sweep_rad.abs(),
            })
        };
        let first_climb = climbs[0] - self.lead_m_per_rad(Drum::Output) * first_wrap;
        let first = helix(Drum::Output, first_tangent + against * first_wrap, -against * first_wrap, first_climb);
        let input = helix(Drum::Input, self.tangent_rad, self.input_wrap_rad(), climbs[1]);
        let second = helix(Drum::Output, second_tangent, -against * second_wrap, climbs[3]);
        let spans =
            [(first, input), (input, second)].map(|(from, to)| Piece::Span(Span { from_m: from.point_m(1.0), to_m: to.point_m(0.0) }));
        Ok(CentreLine { pieces: [first, spans[0], input, spans[1], second] })
    }

    /// Length of a cable between its anchors, m; the same at every output angle, as one end winds up what the other lets go:
    /// (r2 ΣΘ + r1 Θ1)/cos β + Σ √(`L_f`² + (`L_f` tan β + x)²) with the deviations x of the spans.
    ///
    /// # Errors
    /// [`GeometryError::NoSuchCable`].
    pub fn cable_length_m(&self, cable: usize) -> Result<f64, GeometryError> {
        let l = &self.layout;
        let wraps = l.output_radius_m * (l.guard_rad[0] + l.guard_rad[1] + l.travel_rad) + l.input_radius_m * self.input_wrap_rad();
        let spans: f64 = self.deviations_m(cable)?.iter().map(|x| hypot(self.free_span_m, self.span_rise_m() + x)).sum();
        Ok(wraps * hypot(1.0, self.slope()) + spans)
    }

    /// Length to cut, m: at the preload T the cable between the anchors is [`cable_length_m`](Self::cable_length_m) long, hence shorter by
    /// 1 + T/AE without tension; the lengths within the anchors are added.
    ///
    /// # Errors
    /// [`GeometryError::NoSuchCable`]; [`GeometryError::Number`] for an anchor length or a preload below 0 or a stiffness AE that is not
    /// above 0.
    pub fn cut_length_m(
        &self,
        cable: usize,
        anchor_lengths_m: [f64; 2],
        preload_n: f64,
        axial_stiffness_n: f64,
    ) -> Result<f64, GeometryError> {
        for (name, value) in [("anchor length", anchor_lengths_m[0]), ("anchor length", anchor_lengths_m[1]), ("preload", preload_n)] {
            if !(value >= 0.0 && value.is_finite()) {
                return Err(GeometryError::Number { name, value });
            }
        }
        if axial_stiffness_n.is_nan() || axial_stiffness_n <= 0.0 {
            return Err(GeometryError::Number { name: "axial stiffness", value: axial_stiffness_n });
        }
        Ok(self.cable_length_m(cable)? / (1.0 + preload_n / axial_stiffness_n) + anchor_lengths_m[0] + anchor_lengths_m[1])
    }

    /// x of a drum's axis, m.
    pub fn axis_m(&self, drum: Drum) -> f64 {
        match drum {
            Drum::Input => 0.0,
            Drum::Output => self.layout.centre_distance_m,
        }
    }

    /// Climb at the start of the travel of the four tangent points from end 0 to end 1, m: output, input, input, output. The first one of
    /// line 0 is at 0.
    pub(super) fn climbs_m(&self, cable: usize) -> Result<[f64; 4], GeometryError> {
        let [first, _] = self.lines(cable)?;
        let [outgoing, back] = self.deviations_m(cable)?;
        let leaves = first * self.line_spacing_m();
        let reaches = leaves + self.span_rise_m() + outgoing;
        let returns = reaches + self.lead_m_per_rad(Drum::Input) * self.input_wrap_rad();
        Ok([leaves, reaches, returns, returns + self.span_rise_m() + back])
    }
}

/// a − b.
pub(super) fn difference(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|i| a[i] - b[i])
}

/// Distance of two straight spans, m, and where on each it is least, as fractions.
///
/// Least squares of two parameters, then clamped one after the other (C. Ericson, "Real-Time Collision Detection", 2005, section 5.1.9).
pub(super) fn span_distance(a: Span, b: Span) -> (f64, [f64; 2]) {
    let dot = |a: [f64; 3], b: [f64; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    let (u, v, w) = (difference(a.to_m, a.from_m), difference(b.to_m, b.from_m), difference(a.from_m, b.from_m));
    let (uu, uv, vv, uw, vw) = (dot(u, u), dot(u, v), dot(v, v), dot(u, w), dot(v, w));
    let determinant = uu * vv - uv * uv;
    let mut s = if determinant > f64::EPSILON * uu * vv { ((uv * vw - uw * vv) / determinant).clamp(0.0, 1.0) } else { 0.0 };
    let mut t = if vv > 0.0 { (uv * s + vw) / vv } else { 0.0 };
    if !(0.0..=1.0).contains(&t) {
        t = t.clamp(0.0, 1.0);
        s = if uu > 0.0 { ((uv * t - uw) / uu).clamp(0.0, 1.0) } else { 0.0 };
    }
    let gap: [f64; 3] = std::array::from_fn(|i| w[i] + s * u[i] - t * v[i]);
    (hypot(hypot(gap[0], gap[1]), gap[2]), [s, t])
}
