//! Springs in pictures of parts: the wire from the side, axis upright, as a line as wide as it is, the halves behind before those in
//! front. The edge of such a line with round joints is the silhouette of the wire.

use std::f64::consts::TAU;

use forcewright_curves::Bounds;
use forcewright_model::{Coil, WireStation};

use super::canvas::Canvas;
use super::colour::Paint;
use super::place::{Placer, Rect};

/// Steps of a turn.
const STEPS: f64 = 72.0;
/// Width of the edges of the wire, in drawing units.
const EDGE: f64 = 1.0;

/// A spring beside an upright axis, m.
pub(super) struct Wire {
    width_m: f64,
    /// Its middle, in pieces behind the axis and in front of it.
    back_m: Vec<Vec<[f64; 2]>>,
    front_m: Vec<Vec<[f64; 2]>>,
    /// Across both ends.
    ends_m: Vec<[[f64; 2]; 2]>,
    pub(super) bounds: Bounds,
}

impl Wire {
    /// A spring that can be made, its lower left corner at a point; with the ends of its centre line.
    pub(super) fn new(coil: &Coil, corner_m: [f64; 2]) -> Option<(Self, [[f64; 2]; 2])> {
        coil.check().ok()?;
        let [low, high] = coil.extent_m();
        let at = |[x, _, z]: [f64; 3]| [corner_m[0] + x - low[0], corner_m[1] + z - low[2]];
        let line = coil.line();
        let laid = line.pieces().iter().enumerate().flat_map(|(index, piece)| {
            let count = (STEPS * piece.turned_rad() / TAU).ceil().max(1.0);
            let mut stations = Vec::new();
            let mut k = if index == 0 { 0.0 } else { 1.0 };
            while k <= count {
                stations.push(piece.at(k / count));
                k += 1.0;
            }
            stations
        });
        let stations: Vec<WireStation> = laid.collect();
        let [mut back_m, mut front_m] = [Vec::new(), Vec::new()];
        let mut begin = 0;
        for k in 1..=stations.len() {
            // Away from the eye, which is at −y, or towards it.
            let is_back = |k: usize| stations[k].point_m[1] > 0.0;
            if k == stations.len() || is_back(k) != is_back(begin) {
                // Pieces overlap by a step on both sides, so that no gap is between them.
                let piece = &stations[begin.saturating_sub(1)..(k + 1).min(stations.len())];
                let points = piece.iter().map(|station| at(station.point_m)).collect();
                if is_back(begin) {
                    back_m.push(points);
                } else {
                    front_m.push(points);
                }
                begin = k;
            }
        }
        let across = |station: &WireStation| {
            let [x, _, z] = station.tangent;
            let [u, v] = at(station.point_m);
            let half_m = 0.5 * coil.wire_m / (x * x + z * z).sqrt().max(1e-3);
            [[u - half_m * z, v + half_m * x], [u + half_m * z, v - half_m * x]]
        };
        let ends_m = stations.first().into_iter().chain(stations.last()).map(across).collect();
        let axis_m = [low[2], high[2]].map(|z| at([0.0, 0.0, z]));
        let bounds = Bounds::of([corner_m, at(high)]);
        Some((Self { width_m: coil.wire_m, back_m, front_m, ends_m, bounds }, axis_m))
    }

    /// Draws it; `at` takes metres to the drawing, `scale` is its measure.
    pub(super) fn draw(&self, canvas: &mut Canvas, placer: &mut Placer, scale: f64, at: impl Fn([f64; 2]) -> [f64; 2]) {
        let width = (self.width_m * scale).max(2.0 * EDGE);
        for pieces in [&self.back_m, &self.front_m] {
            for (paint, width) in [(Paint::Ink, width + EDGE), (Paint::Body, width - EDGE)] {
                canvas.open_stroke(paint, width, r#"stroke-linejoin="round""#);
                for piece in pieces {
                    let points: Vec<[f64; 2]> = piece.iter().map(|&p| at(p)).collect();
                    canvas.polyline(&points, "");
                }
                canvas.close();
            }
        }
        canvas.open_stroke(Paint::Ink, EDGE, "");
        let ends: Vec<[[f64; 2]; 2]> = self.ends_m.iter().map(|end| end.map(&at)).collect();
        canvas.segments(&ends, "");
        canvas.close();
        let [low, high] = [at(self.bounds.min_m), at(self.bounds.max_m)];
        placer.add_solid(Rect::sized(low[0], high[1], high[0] - low[0], low[1] - high[1]));
    }
}

#[cfg(test)]
mod tests {
    use forcewright_model::{CoilEnd, Winding};

    use super::*;

    fn coil() -> Coil {
        Coil {
            wire_m: 1e-3,
            radius_m: 5e-3,
            windings: vec![Winding::even(6.25, 1.2e-3)],
            is_right_handed: true,
            start_rad: 0.3,
            ends: [CoilEnd::Cut, CoilEnd::Axial { bend_m: 1.5e-3, length_m: 3e-3 }],
        }
    }

    #[test]
    fn the_wire_is_drawn_once_behind_and_once_in_front() {
        let (wire, axis) = Wire::new(&coil(), [0.1, 0.2]).unwrap();
        // It begins behind, and ends in front with its leg: from 0.3 rad over 6¼ turns to a little beyond half a turn.
        assert_eq!((wire.back_m.len(), wire.front_m.len()), (7, 6));
        let x = |point: &[f64; 2]| point[0] - axis[0][0];
        for piece in wire.front_m.iter().skip(1).take(4).chain(wire.back_m.iter().skip(1).take(4)) {
            // From side to side, where each overlaps the next.
            let (from, to) = (x(&piece[0]), x(&piece[piece.len() - 1]));
            assert!(from * to < 0.0 && from.abs() > 4.9e-3 && to.abs() > 4.9e-3, "{from} {to}");
        }
        let size = [0, 1].map(|k| wire.bounds.max_m[k] - wire.bounds.min_m[k]);
        assert!((size[0] - coil().outer_diameter_m()).abs() < 2e-5 && (size[1] - coil().length_m()).abs() < 1e-12);
        assert!((wire.bounds.min_m[0] - 0.1).abs() < 1e-15 && (axis[1][1] - axis[0][1] - size[1]).abs() < 1e-12);
    }

    #[test]
    fn what_cannot_be_wound_is_not_drawn() {
        assert!(Wire::new(&Coil { radius_m: 1e-4, ..coil() }, [0.0; 2]).is_none());
    }
}
