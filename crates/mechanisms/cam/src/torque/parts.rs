//! What is made of a design: the disc or the ring, rollers and axles, as plates.
//!
//! As for cams with a slider the lobe is drawn with arcs that share their tangents, within a stated distance of the exact offset of the path,
//! and what that costs of the torque is computed: δT = 2 d(P δρ)/dθ, with δρ what the deviation moves a roller along its guide.

use std::sync::Arc;

use forcewright_base::maths;
use forcewright_base::units::{Dimension, Unit, format_number, format_si};
use forcewright_contract::judge::Comparison;
use forcewright_curves::fit::{Arcs, Oriented, arcs};
use forcewright_curves::{Profile, Segment};
use forcewright_model::{Body, Check, Hole, NoPart, Part, PartSet, Plate, Sheet};

use super::cut::Cut;
use super::design::Design;
use super::mechanism::Mechanism;
use super::outline::{Closing, closing, reach_m, start_m, surface};
use crate::mechanism::Sense;
use crate::parts::{Order, RIGID, deviation, roller, springs_to_order};
use crate::path::{Vector, frame};

/// Places at which the arcs are compared with the profile.
const PROBES: usize = 2000;
/// Intervals between the places to be measured.
const INSPECTED: u32 = 24;

fn opposite([x, y]: Vector) -> Vector {
    [-x, -y]
}

/// Half a turn about the shaft.
fn half_turn(segment: &Segment) -> Segment {
    match segment {
        Segment::Arc { to_m, centre_m, counterclockwise } => {
            Segment::Arc { to_m: opposite(*to_m), centre_m: opposite(*centre_m), counterclockwise: *counterclockwise }
        }
        other => Segment::Line { to_m: opposite(other.end_m()) },
    }
}

/// A lobe as it is drawn.
struct Lobe {
    /// λ at its ends, m.
    range_m: [f64; 2],
    from_m: Vector,
    arcs: Arcs,
}

fn oriented(mechanism: &Mechanism, lambda_m: f64) -> Oriented {
    let place = mechanism.at(lambda_m);
    let [along, _] = frame(&place, mechanism.cut.sense());
    Oriented { point_m: surface(mechanism, &place), tangent: along }
}

fn no_part(message: String, help: &str) -> NoPart {
    NoPart { code: "E0609", message, help: help.to_owned() }
}

fn lobe(design: &Design, mechanism: &Mechanism, start: f64) -> Result<Lobe, NoPart> {
    let [from, to] = mechanism.cut.range_m();
    // On a corner the profile has no length: the lobe begins beyond it.
    let from = mechanism.corner.map_or(start, |c| c.lambda_m.max(start) + 1e-7 * (to - from));
    let curve = |u: f64| oriented(mechanism, from + (to - from) * u);
    let arcs = arcs(&curve, design.making.chord_error_m).map_err(|error| {
        no_part(format!("the profile of the cam cannot be drawn with arcs: {error}"), "allow a larger `parts.chord_error`")
    })?;
    Ok(Lobe { range_m: [from, to], from_m: curve(0.0).point_m, arcs })
}

/// The whole outline, passed clockwise: both lobes and what joins them.
fn outline(lobe: &Lobe, closing: &Closing) -> Profile {
    // The closing ends at the contact of the roller at the start, which on a corner lies a hair before the lobe.
    let last = closing.segments.len().saturating_sub(1);
    let mut half: Vec<Segment> = lobe.arcs.segments.clone();
    for (i, segment) in closing.segments.iter().enumerate() {
        half.push(segment.clone());
        let gap = [0, 1].map(|k| segment.end_m()[k] + lobe.from_m[k]);
        if i == last && maths::hypot(gap[0], gap[1]) > 1e-12 {
            half.push(Segment::Line { to_m: opposite(lobe.from_m) });
        }
    }
    let other: Vec<Segment> = half.iter().map(half_turn).collect();
    Profile { start_m: lobe.from_m, segments: half.into_iter().chain(other).collect() }
}

/// What drawing the lobe with arcs changes of the torque, relative to it: the largest over the lobe.
fn cost_of_arcs(mechanism: &Mechanism, lobe: &Lobe) -> f64 {
    let cut = &mechanism.cut;
    let springs = &cut.purpose().springs;
    let starts = std::iter::once(lobe.from_m).chain(lobe.arcs.segments.iter().map(Segment::end_m));
    let pieces: Vec<(Vector, Segment)> = starts.zip(lobe.arcs.segments.iter().cloned()).collect();
    let [from, to] = lobe.range_m;
    let mut near = 0;
    let sums: Vec<[f64; 3]> = (0..=PROBES)
        .map(|i| {
            let lambda = from + (to - from) * i as f64 / PROBES as f64;
            let place = mechanism.at(lambda);
            let [_, normal] = frame(&place, cut.sense());
            let e = deviation(&pieces, &mut near, &oriented(mechanism, lambda), normal);
            let [turn, radius] = cut.at(lambda);
            // Along the guide: e over the part of the normal that lies in it.
            let radial = (place.at[0] * normal[0] + place.at[1] * normal[1]) / radius.value();
            let [tension, _] = springs.tension_n(2.0 * radius.value());
            [turn.value(), 2.0 * tension * e / radial, cut.purpose().law.force_n(turn.value())[0]]
        })
        .collect();
    let changes = sums.windows(2).map(|p| ((p[1][1] - p[0][1]) / (p[1][0] - p[0][0]) / p[0][2]).abs());
    changes.fold(0.0, f64::max)
}

/// The parts of a design.
///
/// # Errors
/// [`NoPart`] where the disc cannot be cut or drawn.
pub(crate) fn parts(design: &Design) -> Result<PartSet, NoPart> {
    let cut = Cut::new(design.purpose.clone()).map_err(|e| no_part(format!("the disc cannot be cut: {e:?}"), "see `forcewright check`"))?;
    let cut = Arc::new(cut);
    let mechanism = design.mechanism(&cut);
    let start = start_m(&mechanism);
    let joined = closing(&mechanism, start, cut.range_m()[1])
        .ok_or_else(|| no_part("the outline does not find back from a lobe to the other".to_owned(), "see `forcewright check`"))?;
    let lobe = lobe(design, &mechanism, start)?;
    let cost = cost_of_arcs(&mechanism, &lobe);
    let thickness_m = design.drawn_thickness_m();
    let whole = outline(&lobe, &joined);
    let material = |index: usize| design.materials[index].as_ref().map(|m| m.name.clone());
    let density = |index: usize| design.materials[index].as_ref().and_then(|m| m.density_kg_per_m3);
    let [_, far] = reach_m(&mechanism, [start, cut.range_m()[1]], &joined);
    let (name, title, outline, cutouts) = if design.built.extension {
        ("disc", "Cam disc", whole.reversed(), Vec::new())
    } else {
        ("ring", "Cam ring", Profile::circle([0.0; 2], far + design.making.wall_m), vec![whole])
    };
    let hole = design.shaft_m.map(|diameter_m| Hole { centre_m: [0.0; 2], diameter_m, purpose: "shaft".to_owned() });
    let disc = Part {
        name: name.to_owned(),
        title: title.to_owned(),
        count: 1,
        material: material(0),
        density_kg_per_m3: density(0),
        notes: notes(design, &mechanism, &lobe, cost),
        body: Body::Plate(Plate {
            depth_m: thickness_m,
            outline,
            cutouts,
            fillets: None,
            trial: Err(RIGID.to_owned()),
            holes: hole.into_iter().collect(),
        }),
    };
    let pin_m = design.making.pin_m;
    let axle = Part {
        name: "pin".to_owned(),
        title: "Axle, without what carries follower and springs".to_owned(),
        count: 2,
        material: None,
        density_kg_per_m3: None,
        notes: vec!["Longer where several springs stand side by side on it.".to_owned()],
        body: Body::Plate(Plate {
            depth_m: 2.0 * thickness_m,
            outline: Profile::circle([0.0; 2], 0.5 * pin_m),
            cutouts: Vec::new(),
            fillets: None,
            trial: Err(RIGID.to_owned()),
            holes: Vec::new(),
        }),
    };
    let rollers = roller([design.cut_roller_m, pin_m, thickness_m], material(1), density(1));
    Ok(PartSet {
        parts: vec![disc, rollers, axle],
        marks: Vec::new(),
        sheets: vec![inspection(&mechanism, &lobe), order(design, &mechanism)],
        display: design.units.length.clone(),
        checks: vec![chord_check(design, cost)],
    })
}

fn notes(design: &Design, mechanism: &Mechanism, lobe: &Lobe, cost: f64) -> Vec<String> {
    let unit = Unit::parse("µm").unwrap_or_else(|_| Unit::si(Dimension::Length));
    let mut notes = vec![
        format!(
            "Lobes: {} arcs each that share their tangents, within {} of the exact offset of the rollers' path; that changes the torque by at most {} %.",
            lobe.arcs.segments.len(),
            format_si(lobe.arcs.error_m, &unit, 3),
            format_number(100.0 * cost, 2)
        ),
        "The origin is the middle of the shaft. At the start a roller stands at the right on the x axis; seen so, the disc turns counterclockwise against the springs.".to_owned(),
        "Nose, line and seat between the lobes are used by no roller.".to_owned(),
    ];
    if let Some(corner) = &mechanism.corner {
        notes.push(format!(
            "The cam is undercut: its lobes begin with a corner, on which the rollers turn below a turn of {}.",
            format_si(corner.turn_rad, &design.units.travel, 3)
        ));
    }
    notes
}

/// The springs to order, and what a turn of the adjusting screw does.
fn order(design: &Design, mechanism: &Mechanism) -> Sheet {
    let whole = design.purpose.turn_rad;
    let at = |turn: f64| mechanism.pose(turn).ok().map(|pose| mechanism.at_rest(&pose, Sense::Frictionless));
    let start = mechanism.at(start_m(mechanism)).at;
    let ends = [2.0 * maths::hypot(start[0], start[1]), at(whole).map_or(f64::NAN, |i| i.spring_m)];
    springs_to_order(&Order {
        springs: &design.built.springs,
        extension: design.built.extension,
        lengths_m: [ends[0].min(ends[1]), ends[0].max(ends[1])],
        pitch_m: design.adjust_pitch_m,
        middle: at(0.5 * whole).map(|i| [i.spring_m, i.torque_nm]),
        per_turn: "torque of the mechanism per turn of the screw at half the way / N*m",
        gives: "torque",
    })
}

/// Places of a lobe to be measured: the exact profile, its normal, and what the measured deviation does to the torque.
fn inspection(mechanism: &Mechanism, lobe: &Lobe) -> Sheet {
    let cut = &mechanism.cut;
    let [from, to] = lobe.range_m;
    let number = |value: f64, digits: usize| format!("{value:.digits$}");
    let rows = (0..=INSPECTED).map(|i| {
        let lambda = from + (to - from) * f64::from(i) / f64::from(INSPECTED);
        let place = mechanism.at(lambda);
        let [_, normal] = frame(&place, cut.sense());
        let [x, y] = surface(mechanism, &place);
        let [turn, radius] = cut.at(lambda);
        let radial = (place.at[0] * normal[0] + place.at[1] * normal[1]) / radius.value();
        let [tension, _] = cut.purpose().springs.tension_n(2.0 * radius.value());
        // A slope of 1 µm per degree on one lobe: δT = P d(δρ)/dθ.
        let per_slope = (1e-6 / 1f64.to_radians() * tension / radial).abs();
        vec![
            number(turn.value().to_degrees(), 3),
            number(1e3 * x, 4),
            number(1e3 * y, 4),
            number(normal[0], 5),
            number(normal[1], 5),
            number(per_slope, 5),
        ]
    });
    let columns = ["turn / deg", "x / mm", "y / mm", "normal x", "normal y", "torque per slope of 1 µm/deg / N*m"];
    Sheet {
        name: "inspection".to_owned(),
        caption: "Places of a lobe to be measured, with the normal towards the roller; the other lobe is the same half a turn away. The last column is the torque that a deviation of one lobe along the normal adds for each micrometre that it grows per degree.".to_owned(),
        columns: columns.map(str::to_owned).to_vec(),
        rows: rows.collect(),
    }
}

/// CAM011: what the arcs cost of the torque band.
fn chord_check(design: &Design, cost: f64) -> Check {
    let band = design.requirements.as_ref().and_then(|r| r.force.as_ref()).map(|f| f.1);
    Comparison {
        code: "CAM011",
        name: "chord_error".to_owned(),
        title: "Torque error of the arcs of the cam".to_owned(),
        required: false,
        value: Some(cost),
        limit: band.map(|b| 0.1 * b),
        sense: forcewright_model::Sense::AtMost,
        dimension: Dimension::Ratio,
        display: crate::rules::percent(),
        scale: None,
        basis: "δT/T = 2 d(P δρ)/dθ over T: the slope of the deviation counts; a tenth of the torque band is allowed".to_owned(),
        fix: "make `parts.chord_error` smaller: the torque error follows about its 2/3 power".to_owned(),
        missing: "no torque band is required".to_owned(),
        partial: false,
        broken: false,
    }
    .judge()
}
