//! A roller on a path: its centre keeps to the path, and it rolls without slip.
//!
//! The parameter u of the path is a coordinate without mass, as in Sánchez-Salinas et al. 2022, eqs. (4)–(6). With the centre's path
//! p(u) in the frame R of the cam, rows 0 and 1 are `r − x_cam − R p(u) = 0`. Row 2 is eq. (15): the roller's point at the contact
//! moves with the cam's, along the tangent t. With the cam at σ r n from the centre (n to the left of t) that is
//! `g u̇ − σ r (ω − ω_cam) = 0`, p′ = g t. The equation of motion of u makes the tangential part of the force in rows 0 and 1 equal
//! to the multiplier of row 2, the traction.

use super::Sink;
use crate::frames::{Frames, Marker};
use crate::path::{Path, centre_path, cross, dot, minus, turn};

/// A contact of a built model.
#[derive(Debug, Clone)]
pub(crate) struct ContactRows {
    pub(crate) centre: Marker,
    /// The cam's centre of mass, from its frame.
    pub(crate) cam: Marker,
    pub(crate) path: Path,
    /// Distance of the centre's path to the left of the given one.
    pub(crate) offset_m: f64,
    pub(crate) radius_m: f64,
    /// +1 if the cam is to the left of the centre's path.
    pub(crate) cam_side: f64,
    pub(crate) rolling: bool,
    /// Which of the path parameters is its own.
    pub(crate) index: usize,
}

impl ContactRows {
    pub(super) fn evaluate(&self, frames: &Frames, out: &mut Sink<'_>) {
        let [u, rate] = frames.parameters[self.index];
        let path = centre_path(&self.path, u, self.offset_m);
        let (place, cam) = (frames.place(&self.centre), frames.body(self.cam.body));
        // `cam.p` is the origin of the cam's frame relative to its centre of mass.
        let arm = cam.turned([path.point[0] + self.cam.p[0], path.point[1] + self.cam.p[1]]);
        let (first, second) = (cam.turned(path.first), cam.turned(path.second));
        let value = minus(minus(place.r, cam.r), arm);
        let (arm_turned, first_turned, centre_turned) = (turn(arm), turn(first), turn(place.arm));
        for k in 0..2 {
            let bias = place.bias[k] + cam.w * cam.w * arm[k] - 2.0 * cam.w * rate * first_turned[k] - second[k] * rate * rate;
            out.row(k, value[k], 0.0, -bias);
            let mut unit = [0.0; 3];
            unit[k] = 1.0;
            unit[2] = centre_turned[k];
            out.body(k, self.centre.body, unit);
            unit[k] = -1.0;
            unit[2] = -arm_turned[k];
            out.body(k, self.cam.body, unit);
            out.parameter(k, self.index, -first[k]);
        }
        if self.rolling {
            let lever = self.cam_side * self.radius_m;
            out.row(2, 0.0, 0.0, -path.speed_rate * rate * rate);
            out.parameter(2, self.index, path.speed);
            out.body(2, self.centre.body, [0.0, 0.0, -lever]);
            out.body(2, self.cam.body, [0.0, 0.0, lever]);
        }
    }

    /// Normal force that presses the roller on the cam and traction along the rising parameter on the roller, from the multipliers of
    /// rows 0 and 1.
    pub(crate) fn forces(&self, frames: &Frames, multipliers: [f64; 2]) -> [f64; 2] {
        let [u, _] = frames.parameters[self.index];
        let tangent = frames.body(self.cam.body).turned(centre_path(&self.path, u, self.offset_m).tangent);
        [self.cam_side * cross(tangent, multipliers), -dot(tangent, multipliers)]
    }

    /// Rate of the path's length by its parameter.
    pub(crate) fn speed(&self, u: f64) -> f64 {
        centre_path(&self.path, u, self.offset_m).speed
    }
}
