//! Parts by chance: nothing panics, and what is sound is written whole.

use std::f64::consts::TAU;

use forcewright_curves::{Profile, Segment, Spline};
use forcewright_fabricate::{Format, Options, write};
use forcewright_model::{Hole, Part};
use proptest::prelude::*;

#[allow(dead_code, unreachable_pub, missing_docs, reason = "shared with an example and other tests, which use all of it")]
mod common;
#[allow(dead_code, reason = "shared with other tests, which use all of it")]
#[allow(clippy::unwrap_used, reason = "test code")]
mod reading;

/// Any number, most often one that could be meant.
fn number() -> impl Strategy<Value = f64> {
    prop_oneof![4 => -0.1..0.1, 2 => prop::sample::select(vec![0.0, 0.01, 0.02, -0.01, 1e-9, 999.0]), 1 => any::<f64>()]
}

fn point() -> impl Strategy<Value = [f64; 2]> {
    [number(), number()]
}

fn segment() -> impl Strategy<Value = Segment> {
    let knots = prop_oneof![prop::collection::vec(number(), 0..14), (4..12_usize).prop_map(|n| (0..n).map(|k| k as f64).collect())];
    let curve = (prop::collection::vec(point(), 0..9), knots).prop_map(|(control_m, mut knots)| {
        knots.sort_by(f64::total_cmp);
        if let (Some(&first), Some(&last)) = (knots.first(), knots.last()) {
            knots = [first; 3].into_iter().chain(knots).chain([last; 3]).collect();
        }
        Segment::Spline(Spline { control_m, knots })
    });
    prop_oneof![
        point().prop_map(|to_m| Segment::Line { to_m }),
        (point(), point(), any::<bool>()).prop_map(|(to_m, centre_m, counterclockwise)| Segment::Arc { to_m, centre_m, counterclockwise }),
        curve,
    ]
}

fn profile() -> impl Strategy<Value = Profile> {
    (point(), prop::collection::vec(segment(), 0..6), any::<bool>()).prop_map(|(start_m, mut segments, closes)| {
        if closes {
            segments.push(Segment::Line { to_m: start_m });
        }
        Profile { start_m, segments }
    })
}

fn any_part() -> impl Strategy<Value = Part> {
    let hole = (point(), number()).prop_map(|(centre_m, diameter_m)| Hole { centre_m, diameter_m, purpose: String::new() });
    let cut = (prop::collection::vec(profile(), 0..2), prop::collection::vec(hole, 0..3));
    (any::<String>(), number(), profile(), cut).prop_map(|(title, depth_m, outline, (cutouts, holes))| {
        let mut part = common::part("any", depth_m, outline);
        part.title = title;
        let plate = common::plate_mut(&mut part);
        (plate.cutouts, plate.holes) = (cutouts, holes);
        part
    })
}

/// A star of lines, arcs and splines around a round hole.
fn star() -> impl Strategy<Value = Part> {
    (prop::collection::vec((0.01..0.03, 0..3_u8), 3..24), 0.001..0.008, -0.05..0.05).prop_map(|(spikes, radius, shift)| {
        let place = |share: f64, r: f64| {
            let [x, y] = common::polar(r, share * TAU / spikes.len() as f64);
            [x + shift, y]
        };
        let start_m = place(0.0, spikes[0].0);
        let mut segments = Vec::new();
        for (k, &(r, kind)) in spikes.iter().enumerate() {
            let next = spikes[(k + 1) % spikes.len()].0;
            let at = k as f64;
            let to_m = if k + 1 == spikes.len() { start_m } else { place(at + 1.0, next) };
            match kind {
                0 => segments.push(Segment::Line { to_m }),
                1 => {
                    // Along the radius to the circle of the next spike, then along that.
                    let turn = place(at, next);
                    segments.push(Segment::Line { to_m: turn });
                    segments.push(common::arc(to_m, [shift, 0.0], true));
                }
                _ => {
                    let control = vec![place(at, r), place(at + 0.3, 0.9 * r), place(at + 0.7, 1.1 * next), to_m];
                    segments.push(Segment::Spline(common::spline(control, &[])));
                }
            }
        }
        let mut part = common::part("star", 0.004, Profile { start_m, segments });
        common::plate_mut(&mut part).cutouts = vec![common::circle([shift, 0.0], 0.4 * radius, false)];
        part
    })
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 300, ..ProptestConfig::default() })]

    #[test]
    fn no_part_makes_a_writer_panic(part in any_part()) {
        for format in Format::ALL {
            let _ = write(&part, format, &Options { arc_error_m: 1e-4, facet_error_m: 1e-4, element_m: Some(1e-3) });
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 60, ..ProptestConfig::default() })]

    #[test]
    fn stars_are_written_whole(part in star()) {
        // Two equal radii leave no line along the radius.
        let Ok(stl) = write(&part, Format::Stl, &Options::default()) else { return Ok(()) };
        let mesh = reading::Mesh::of_stl(&stl);
        mesh.check_closed("star");
        let plate = common::plate_of(&part);
        let [area, length] = [&plate.outline, &plate.cutouts[0]].map(common::integrals).iter().fold([0.0; 2], |sum, each| [sum[0] + each[0], sum[1] + each[1]]);
        let strip = 5.01e-6 * length;
        prop_assert!((mesh.volume_mm3() * 1e-9 - area * plate.depth_m).abs() < strip * plate.depth_m);
        let (polylines, _) = reading::dxf(&reading::text(&part, Format::Dxf));
        let drawn: f64 = polylines.iter().map(|corners| reading::area_of_bulges(corners)).sum();
        prop_assert!((drawn * 1e-6 - area).abs() < 1.01e-6 * length);
    }
}
