//! Tension along a cable that was loaded from rest.

use forcewright_base::maths;

use crate::analysis::Behaviour;
use crate::design::Design;
use crate::statics::Loaded;

/// A cable from its taut to its slack termination: wrap, span, wrap on the input, span, wrap.
#[derive(Clone, Debug)]
pub(crate) struct Along {
    /// Tension at rest, in the taut and in the slack span, N.
    preload_n: f64,
    spans_n: [f64; 2],
    /// μ, per angle of a drum.
    friction: f64,
    /// Wraps: output taut, input, output slack, rad.
    wraps_rad: [f64; 3],
    /// Cable per angle: output, input, m.
    per_rad_m: [f64; 2],
    span_m: f64,
    /// Where the input drum holds each side apart: pinned in the middle, or shared.
    slip_rad: [[f64; 2]; 2],
}

/// A place on a cable.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Point {
    /// From the taut termination, m.
    pub at_m: f64,
    /// N.
    pub tension_n: f64,
}

impl Along {
    /// Of a cable (by its index) in the middle of the travel.
    pub(crate) fn of(design: &Design, behaviour: &Behaviour, loaded: &Loaded, cable: usize) -> Option<Self> {
        let built = &design.built;
        let place = built.place(&behaviour.geometry, built.middle_rad());
        let cos = if built.helix_correction { maths::cos(place.helix_rad) } else { 1.0 };
        let [taut_rad, slack_rad] = *place.output_wraps_rad.get(cable)?;
        Some(Self {
            preload_n: built.cables.get(cable)?.preload_left_n(built),
            spans_n: *loaded.tensions_n.get(cable)?,
            friction: built.friction * built.groove_factor * cos,
            wraps_rad: [taut_rad, place.input_wraps_rad.iter().sum(), slack_rad],
            per_rad_m: [built.radii_m[1] / cos, built.radii_m[0] / cos],
            span_m: place.span_m,
            slip_rad: *loaded.slip_rad.get(cable)?,
        })
    }

    /// Tension at an angle from the span on a drum, N: of a side (0 taut), on the output (0) or the input (1).
    pub(crate) fn tension_n(&self, side: usize, drum: usize, angle_rad: f64) -> f64 {
        if angle_rad >= self.slip_rad[side][drum] {
            return self.preload_n;
        }
        let sign = if side == 0 { -1.0 } else { 1.0 };
        self.spans_n[side] * maths::exp(sign * self.friction * angle_rad)
    }

    /// Tension on the input drum at an angle from the taut span, N.
    pub(crate) fn input_n(&self, angle_rad: f64) -> f64 {
        if angle_rad <= self.slip_rad[0][1] { self.tension_n(0, 1, angle_rad) } else { self.tension_n(1, 1, self.wraps_rad[1] - angle_rad) }
    }

    /// Wraps: output taut, input, output slack, rad.
    pub(crate) fn wraps_rad(&self) -> [f64; 3] {
        self.wraps_rad
    }

    /// Slip angles by side, on the output and the input, rad.
    pub(crate) fn slip_rad(&self) -> [[f64; 2]; 2] {
        self.slip_rad
    }

    /// Lengths of the five parts, m.
    fn lengths_m(&self) -> [f64; 5] {
        let [taut, input, slack] = self.wraps_rad;
        [taut * self.per_rad_m[0], self.span_m, input * self.per_rad_m[1], self.span_m, slack * self.per_rad_m[0]]
    }

    /// Tensions at so many places of each wrap.
    pub(crate) fn points(&self, intervals: usize) -> Vec<Point> {
        let span_m = self.span_m;
        let mut start_m = 0.0;
        let mut all = Vec::with_capacity(3 * intervals + 3);
        for (part, wrap_rad) in self.wraps_rad.into_iter().enumerate() {
            let per_rad_m = self.per_rad_m[usize::from(part == 1)];
            for i in 0..=intervals {
                let angle_rad = wrap_rad * i as f64 / intervals as f64;
                let tension_n = match part {
                    0 => self.tension_n(0, 0, wrap_rad - angle_rad),
                    1 => self.input_n(angle_rad),
                    _ => self.tension_n(1, 0, angle_rad),
                };
                all.push(Point { at_m: start_m + angle_rad * per_rad_m, tension_n });
            }
            start_m += wrap_rad * per_rad_m + span_m;
        }
        all
    }

    /// Where the free spans are: from, to (m), and what they are.
    pub(crate) fn spans(&self) -> Vec<(f64, f64, String)> {
        let [first, span, input, _, _] = self.lengths_m();
        let second = first + span + input;
        vec![(first, first + span, "taut span".to_owned()), (second, second + span, "slack span".to_owned())]
    }
}
