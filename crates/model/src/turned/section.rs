//! Half planes through the axis of a turned body.

use std::f64::consts::TAU;

use forcewright_curves::vector::distance;
use forcewright_curves::{Profile, Segment};

use super::{Grooved, SAME_M, Section, Turned};

/// A body that was checked in the half plane at an angle: (z, radius), counterclockwise.
pub(super) fn half(turned: &Turned, angle_rad: f64) -> Profile {
    let bore_m = 0.5 * turned.bore_diameter_m;
    let start_m = [0.0, bore_m];
    let mut walk = Walk { here: start_m, segments: Vec::new() };
    for (section, z_m) in turned.sections.iter().zip(turned.steps_m()) {
        match section {
            Section::Plain { length_m, radius_m } => {
                walk.line([z_m, *radius_m]);
                walk.line([z_m + length_m, *radius_m]);
            }
            Section::Grooved(grooved) => along(grooved, z_m, angle_rad, &mut walk),
        }
    }
    walk.line([turned.length_m(), bore_m]);
    walk.segments.push(Segment::Line { to_m: start_m });
    // Passed with the material on its right.
    Profile { start_m, segments: walk.segments }.reversed()
}

/// A chain that begins somewhere.
struct Walk {
    here: [f64; 2],
    segments: Vec<Segment>,
}

impl Walk {
    fn line(&mut self, to_m: [f64; 2]) {
        if distance(self.here, to_m) > SAME_M {
            self.segments.push(Segment::Line { to_m });
            self.here = to_m;
        }
    }

    fn segment(&mut self, from: [f64; 2], segment: Segment) {
        self.line(from);
        self.here = segment.end_m();
        self.segments.push(segment);
    }
}

/// The grooves of a section that begins at `z_m`, as they pass the half plane.
fn along(grooved: &Grooved, z_m: f64, angle_rad: f64, walk: &mut Walk) {
    let (spacing_m, end_m) = (grooved.spacing_m(), z_m + grooved.length_m);
    // Where the start of the first chain lies that ends above the lower end of the section.
    let shift_m = ((angle_rad - grooved.phase_rad) / TAU * grooved.lead_m + grooved.groove.start_m[0]).rem_euclid(spacing_m);
    let first_m = z_m + shift_m - spacing_m - grooved.groove.start_m[0];
    let mut count = 0;
    let shift_of = |count: u32| first_m + f64::from(count) * spacing_m;
    while shift_of(count) + grooved.groove.start_m[0] < end_m {
        let shift_m = shift_of(count);
        count += 1;
        for (from, segment) in grooved.groove.spans() {
            let moved = |point: [f64; 2]| [point[0] + shift_m, point[1]];
            add_clipped(moved(from), segment, moved, [z_m, end_m], walk);
        }
    }
    // A radius at each end, even where a segment was too short to be kept.
    walk.line([end_m, walk.here[1]]);
}

/// Adds what lies of a segment between two planes across the axis.
fn add_clipped(from: [f64; 2], segment: &Segment, moved: impl Fn([f64; 2]) -> [f64; 2], [low_m, high_m]: [f64; 2], walk: &mut Walk) {
    let to = moved(segment.end_m());
    if to[0] - from[0] <= SAME_M {
        if low_m + SAME_M < from[0] && from[0] < high_m - SAME_M {
            walk.line(from);
            walk.line(to);
        }
        return;
    }
    let (first, last) = (from[0].max(low_m), to[0].min(high_m));
    if last - first <= SAME_M {
        return;
    }
    let (at, kept): (Box<dyn Fn(f64) -> f64>, _) = match segment {
        Segment::Arc { centre_m, counterclockwise, .. } => {
            let centre_m = moved(*centre_m);
            let radius_m = distance(from, centre_m);
            let side = if *counterclockwise { -1.0 } else { 1.0 };
            let at = move |z: f64| {
                let x = z - centre_m[0];
                centre_m[1] + side * (radius_m * radius_m - x * x).max(0.0).sqrt()
            };
            (Box::new(at), Some((centre_m, *counterclockwise)))
        }
        _ => (Box::new(move |z: f64| from[1] + (to[1] - from[1]) * (z - from[0]) / (to[0] - from[0])), None),
    };
    let begin = if first > from[0] { [first, at(first)] } else { from };
    let to_m = if last < to[0] { [last, at(last)] } else { to };
    if let Some((centre_m, counterclockwise)) = kept {
        walk.segment(begin, Segment::Arc { to_m, centre_m, counterclockwise });
    } else {
        walk.line(begin);
        walk.line(to_m);
    }
}
