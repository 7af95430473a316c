//! Rows of joints, drivers and the skate. Notation: r a point, d its arm from the centre of mass, k× a quarter turn, e a unit vector.

use super::Sink;
use crate::body::BodyId;
use crate::frames::{Frames, Marker};
use crate::path::{cross, dot, minus, turn};

/// `r_a − r_b = 0`; γ is the difference of the biases −ω² d, of b less of a. Haug 1989, chapter 3.
pub(super) fn pin(a: &Marker, b: &Marker, frames: &Frames, out: &mut Sink<'_>) {
    let (pa, pb) = (frames.place(a), frames.place(b));
    let (da, db) = (turn(pa.arm), turn(pb.arm));
    out.row(0, pa.r[0] - pb.r[0], 0.0, pb.bias[0] - pa.bias[0]);
    out.row(1, pa.r[1] - pb.r[1], 0.0, pb.bias[1] - pa.bias[1]);
    out.body(0, a.body, [1.0, 0.0, da[0]]);
    out.body(1, a.body, [0.0, 1.0, da[1]]);
    out.body(0, b.body, [-1.0, 0.0, -db[0]]);
    out.body(1, b.body, [0.0, -1.0, -db[1]]);
}

/// `e·(r_a − r_b) − f(t) = 0` with e fixed to b.
pub(super) fn along(a: &Marker, b: &Marker, direction: [f64; 2], [f, f1, f2]: [f64; 3], frames: &Frames, out: &mut Sink<'_>) {
    let (pa, pb, on) = (frames.place(a), frames.place(b), frames.body(b.body));
    let e = on.turned(direction);
    let ke = turn(e);
    let (gap, gap_rate) = (minus(pa.r, pb.r), minus(pa.v, pb.v));
    let bias = dot(e, minus(pa.bias, pb.bias)) + 2.0 * on.w * dot(ke, gap_rate) - on.w * on.w * dot(e, gap);
    out.row(0, dot(e, gap) - f, -f1, f2 - bias);
    out.body(0, a.body, [e[0], e[1], cross(pa.arm, e)]);
    out.body(0, b.body, [-e[0], -e[1], dot(ke, gap) - cross(pb.arm, e)]);
}

/// `θ_a − ratio·θ_b − f(t) = 0`.
pub(super) fn angle((a, b, ratio): (BodyId, BodyId, f64), [f, f1, f2]: [f64; 3], frames: &Frames, out: &mut Sink<'_>) {
    out.row(0, frames.body(a).angle - ratio * frames.body(b).angle - f, -f1, f2);
    out.body(0, a, [0.0, 0.0, 1.0]);
    out.body(0, b, [0.0, 0.0, -ratio]);
}

/// `(Δ·Δ − L²)/(2L) = 0` with Δ from b to a; divided by 2L so that the multiplier is the tension.
pub(super) fn rod(a: &Marker, b: &Marker, length: f64, frames: &Frames, out: &mut Sink<'_>) {
    let (pa, pb) = (frames.place(a), frames.place(b));
    let (gap, gap_rate) = (minus(pa.r, pb.r), minus(pa.v, pb.v));
    let e = [gap[0] / length, gap[1] / length];
    let bias = dot(e, minus(pa.bias, pb.bias)) + dot(gap_rate, gap_rate) / length;
    out.row(0, 0.5 * (dot(gap, gap) / length - length), 0.0, -bias);
    out.body(0, a.body, [e[0], e[1], cross(pa.arm, e)]);
    out.body(0, b.body, [-e[0], -e[1], -cross(pb.arm, e)]);
}

/// `e·v = 0` with e fixed to the body: a velocity row that no position row can replace.
pub(super) fn skate(at: &Marker, direction: [f64; 2], frames: &Frames, out: &mut Sink<'_>) {
    let (place, on) = (frames.place(at), frames.body(at.body));
    let e = on.turned(direction);
    out.row(0, 0.0, 0.0, -dot(e, place.bias) - on.w * dot(turn(e), place.v));
    out.body(0, at.body, [e[0], e[1], cross(place.arm, e)]);
}
