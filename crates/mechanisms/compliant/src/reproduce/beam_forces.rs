//! Fig. 8: the vertical forces v1, v2, v3 of the beams that meet at n3, of the drawn half. The paper plots them and prints no number;
//! what it says about them in words is computed. Positive is the direction of F, upwards on the mechanism's end.

use forcewright_base::roots;

use super::Solved;

/// The number of a row; `id` without its `v_`. `solved` goes beyond the paper's travel `d_m`.
pub(super) fn value(solved: &Solved, start_m: f64, d_m: f64, id: &str) -> f64 {
    let of = |beam: usize, at: f64| {
        let force_n = solved.behaviour.path.at(at).ok().and_then(|p| p.beams.get(beam).map(|b| -b.force_n[1]));
        force_n.unwrap_or(f64::NAN)
    };
    // The extreme value: v1 pulls down and has a minimum, v2 a maximum.
    let extreme = |beam: usize, sign: f64| roots::minimise(|x| sign * of(beam, x), start_m, d_m, 1e-9).x;
    match id {
        "1_extreme" => of(0, extreme(0, 1.0)),
        "1_extreme_at" => 1e3 * extreme(0, 1.0),
        "1_end" => of(0, d_m),
        "2_extreme" => of(1, extreme(1, -1.0)),
        "2_extreme_at" => 1e3 * extreme(1, -1.0),
        "2_end" => of(1, d_m),
        "3_end" => of(2, d_m),
        "3_spread" => 100.0 * spread(solved, start_m, d_m),
        "balance" => {
            let points = solved.behaviour.path.points.iter();
            points.map(|p| (p.beams[0].force_n[1] + p.beams[1].force_n[1] - p.beams[2].force_n[1]).abs()).fold(0.0, f64::max)
        }
        _ => f64::NAN,
    }
}

/// Half the range of v3 between two displacements over its middle.
fn spread(solved: &Solved, start_m: f64, d_m: f64) -> f64 {
    let inside = solved.behaviour.path.points.iter().filter(|p| p.displacement >= start_m && p.displacement <= d_m);
    let ends = [start_m, d_m].into_iter().filter_map(|x| solved.behaviour.path.at(x).ok());
    let all: Vec<f64> = inside.map(|p| -p.beams[2].force_n[1]).chain(ends.map(|p| -p.beams[2].force_n[1])).collect();
    let (low, high) = all.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), v| (low.min(*v), high.max(*v)));
    (high - low) / (high + low)
}
