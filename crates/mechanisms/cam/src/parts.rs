//! What is made of a design: the cam plate, rollers, braces and pins, as plates.
//!
//! The profile of the cam is drawn with arcs that share their tangents, within a stated distance of the exact offset of the path. The
//! force follows the slope of the profile, so that distance has a price, which is computed: δF = d(P δL)/ds, with δL the lengthening
//! of the springs by the deviation.

use forcewright_base::maths;
use forcewright_base::units::{Dimension, Unit, format_number, format_si};
use forcewright_contract::judge::Comparison;
use forcewright_curves::fit::{Arcs, Oriented, arcs};
use forcewright_curves::{Profile, Segment};
use forcewright_model::{Body, Check, Hole, NoPart, Part, PartSet, Plate, Sense, Sheet};

use crate::analysis::Behaviour;
use crate::cut::SIDES;
use crate::design::Design;
use crate::path::{SidePath, Vector, frame};
use crate::springs::{Bank, Spring, SpringLaw};

/// How the parts are made, SI.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Making {
    /// Largest distance between the cam's arcs and its exact profile, m.
    pub chord_error_m: f64,
    /// Height of the plate below the start of the profile, m.
    pub base_m: f64,
    /// Wall behind the profile of a cam for compression springs, m.
    pub wall_m: f64,
    /// Diameter of the axles, and of the holes for them, m.
    pub pin_m: f64,
    /// Width of the braces, m.
    pub brace_width_m: f64,
    /// Thickness of the braces, m.
    pub brace_thickness_m: f64,
    /// Diameter of the mounting holes of the cam plate, m.
    pub hole_m: Option<f64>,
}

/// Places at which the arcs are compared with the profile.
const PROBES: usize = 2000;

/// Why no finite elements of it are of use.
pub(crate) const RIGID: &str = "the parts of a cam mechanism are taken as rigid";

/// Intervals between the places of a side to be measured.
const INSPECTED: u32 = 24;

/// A profile as it is drawn.
pub(crate) struct Drawn {
    /// Which side.
    pub side: usize,
    /// λ at its ends, m.
    pub range_m: [f64; 2],
    /// Where it begins, m.
    pub first: Vector,
    /// Where the plate ends sideways below that, m.
    pub relief_m: f64,
    /// The arcs from the lower end to the upper one, in the coordinates of the side.
    pub arcs: Arcs,
}

/// The profiles of both sides as arcs.
pub(crate) fn drawn(design: &Design, behaviour: &Behaviour) -> Result<[Drawn; SIDES], NoPart> {
    let one = |side: usize| {
        let path = &behaviour.mechanism.paths[side];
        let [from, to] = behaviour.cut.range_m();
        let start = behaviour.corners[side].map_or(from, |c| c.lambda_m + 1e-7 * (to - from));
        let curve = |u: f64| surface(design, path, start + (to - start) * u);
        let arcs = arcs(&curve, design.making.chord_error_m).map_err(|error| NoPart {
            code: "E0609",
            message: format!("the profile of the cam cannot be drawn with arcs: {error}"),
            help: "allow a larger `parts.chord_error`".to_owned(),
        })?;
        Ok(Drawn { side, range_m: [start, to], first: curve(0.0).point_m, relief_m: relief_m(behaviour, side), arcs })
    };
    Ok([one(0)?, one(1)?])
}

/// Room between the lowest roller and the plate beside it, in roller radii.
const ROOM: f64 = 0.1;

/// Where the plate ends sideways below its profile, m: the path begins aslant, so the lowest roller hangs below the first point of the
/// profile, and a plate straight down from there would be in its way.
pub(crate) fn relief_m(behaviour: &Behaviour, side: usize) -> f64 {
    let [from, _] = behaviour.cut.range_m();
    let [x, _] = behaviour.mechanism.paths[side].at(from).at;
    let sense = behaviour.mechanism.springs.sense();
    // Between rollers near each other something must be left.
    (x - sense * (1.0 + ROOM) * behaviour.mechanism.roller_m).max(0.1 * x)
}

/// The exact profile: the path offset by the roller.
fn surface(design: &Design, path: &SidePath, lambda_m: f64) -> Oriented {
    let sense = path.cut().purpose().springs.sense();
    let place = path.designed(lambda_m);
    let [along, normal] = frame(&place, sense);
    let r = design.cut_roller_m;
    Oriented { point_m: [place.at[0] - r * normal[0], place.at[1] - r * normal[1]], tangent: along }
}

/// Distance of arcs from the exact profile at a place of it, along its normal outwards, m.
pub(crate) fn deviation(arcs: &[(Vector, Segment)], near: &mut usize, place: &Oriented, normal: Vector) -> f64 {
    // The profile is passed once, and so are the arcs: the piece moves on while its end lies behind.
    while *near + 1 < arcs.len() {
        let end = arcs[*near].1.end_m();
        let behind = (place.point_m[0] - end[0]) * place.tangent[0] + (place.point_m[1] - end[1]) * place.tangent[1];
        if behind <= 0.0 {
            break;
        }
        *near += 1;
    }
    let (from, segment) = &arcs[*near];
    if let Segment::Arc { centre_m, to_m, .. } = segment {
        let radius = maths::hypot(to_m[0] - centre_m[0], to_m[1] - centre_m[1]);
        // Where the line along the normal meets the circle: e² + 2e(d·n) + |d|² = ϱ², the root near zero.
        let d = [place.point_m[0] - centre_m[0], place.point_m[1] - centre_m[1]];
        let b = d[0] * normal[0] + d[1] * normal[1];
        let c = d[0] * d[0] + d[1] * d[1] - radius * radius;
        let root = (b * b - c).max(0.0).sqrt();
        return -c / (b + root.copysign(b));
    }
    let end = segment.end_m();
    let along = [end[0] - from[0], end[1] - from[1]];
    let across = [-along[1], along[0]];
    let d = [from[0] - place.point_m[0], from[1] - place.point_m[1]];
    (d[0] * across[0] + d[1] * across[1]) / (normal[0] * across[0] + normal[1] * across[1])
}

/// What drawing the profile with arcs changes of the force, relative to it: the largest over the profile.
pub(crate) fn cost_of_arcs(design: &Design, behaviour: &Behaviour, profiles: &[Drawn; SIDES]) -> f64 {
    let cut = &behaviour.cut;
    let springs = &cut.purpose().springs;
    let sense = springs.sense();
    // P δL over the travel, both sides.
    let mut most = 0.0_f64;
    let mut sums: Vec<[f64; 3]> = Vec::with_capacity(PROBES + 1);
    let mut near = [0; SIDES];
    let pieces: [Vec<(Vector, Segment)>; SIDES] = [0, 1].map(|side| {
        let first = surface(design, &behaviour.mechanism.paths[side], profiles[side].range_m[0]).point_m;
        let segments = &profiles[side].arcs.segments;
        let starts = std::iter::once(first).chain(segments.iter().map(Segment::end_m));
        starts.zip(segments.iter().cloned()).collect()
    });
    let from = profiles[0].range_m[0].max(profiles[1].range_m[0]);
    let to = profiles[0].range_m[1];
    for i in 0..=PROBES {
        let u = i as f64 / PROBES as f64;
        let lambda = from + (to - from) * u;
        let point = cut.at(0, lambda);
        let tension = springs.tension_n(cut.purpose().start_length_m + sense * lambda)[0];
        let mut lengthening = 0.0;
        for side in 0..SIDES {
            let path = &behaviour.mechanism.paths[side];
            let place = path.designed(lambda);
            let [_, normal] = frame(&place, sense);
            let on_cam = surface(design, path, lambda);
            let e = deviation(&pieces[side], &mut near[side], &on_cam, normal);
            // δx of the roller for a fixed slider: e/(n_x + n_y tan α) (docs/theory/cam.md, eq. 9).
            let brace = cut.purpose().sides[side].brace_m;
            let tan = place.at[0] / (brace * brace - place.at[0] * place.at[0]).sqrt();
            lengthening += e / (normal[0] + normal[1] * tan);
        }
        sums.push([point.s.value(), tension * lengthening, cut.purpose().law.force_n(point.s.value())[0]]);
    }
    for pair in sums.windows(2) {
        let change = (pair[1][1] - pair[0][1]) / (pair[1][0] - pair[0][0]);
        most = most.max((change / pair[0][2]).abs());
    }
    most
}

/// The parts of a design.
///
/// # Errors
/// [`NoPart`] where the cam cannot be cut or drawn.
pub(crate) fn parts(design: &Design) -> Result<PartSet, NoPart> {
    let behaviour = Behaviour::of(design).map_err(|error| NoPart {
        code: "E0609",
        message: format!("the cam cannot be cut: {error:?}"),
        help: "see `forcewright check`".to_owned(),
    })?;
    let profiles = drawn(design, &behaviour)?;
    let making = &design.making;
    let thickness_m = design.drawn_thickness_m();
    let cost = cost_of_arcs(design, &behaviour, &profiles);
    let notes = cam_notes(design, &behaviour, &profiles, cost);
    let material = |index: usize| design.materials[index].as_ref().map(|m| m.name.clone());
    let density = |index: usize| design.materials[index].as_ref().and_then(|m| m.density_kg_per_m3);
    let mut parts = Vec::new();
    if design.built.extension {
        parts.push(Part {
            name: "cam".to_owned(),
            title: "Cam plate".to_owned(),
            count: 1,
            material: material(0),
            density_kg_per_m3: density(0),
            notes,
            body: Body::Plate(Plate {
                depth_m: thickness_m,
                outline: plate(making, &profiles),
                cutouts: Vec::new(),
                fillets: None,
                trial: Err(RIGID.to_owned()),
                holes: mounting_holes(making, &profiles),
            }),
        });
    } else {
        for (drawn, name) in profiles.iter().zip(["cam-right", "cam-left"]) {
            parts.push(Part {
                name: name.to_owned(),
                title: format!("Cam plate, {}", ["right", "left"][drawn.side]),
                count: 1,
                material: material(0),
                density_kg_per_m3: density(0),
                notes: notes.clone(),
                body: Body::Plate(Plate {
                    depth_m: thickness_m,
                    outline: outer_plate(making, drawn),
                    cutouts: Vec::new(),
                    fillets: None,
                    trial: Err(RIGID.to_owned()),
                    holes: Vec::new(),
                }),
            });
        }
    }
    parts.push(roller([design.cut_roller_m, design.making.pin_m, thickness_m], material(1), density(1)));
    parts.extend(braces(design));
    parts.push(pin(design, thickness_m));
    let checks = vec![chord_check(design, cost)];
    let sheets = vec![inspection(design, &behaviour), order(design, &behaviour)];
    Ok(PartSet { parts, marks: Vec::new(), sheets, display: design.units.length.clone(), checks })
}

fn cam_notes(design: &Design, behaviour: &Behaviour, profiles: &[Drawn; SIDES], cost: f64) -> Vec<String> {
    let unit = Unit::parse("µm").unwrap_or_else(|_| Unit::si(Dimension::Length));
    let count: usize = profiles.iter().map(|p| p.arcs.segments.len()).sum();
    let error = profiles.iter().map(|p| p.arcs.error_m).fold(0.0, f64::max);
    let mut notes = vec![
        format!(
            "Profile: {count} arcs that share their tangents, within {} of the exact offset of the rollers' path; that changes the force by at most {} %.",
            format_si(error, &unit, 3),
            format_number(100.0 * cost, 2)
        ),
        "The origin is where the path of the rollers' centres starts on the axis; y points along the travel.".to_owned(),
    ];
    if let Some(corner) = behaviour.corners.iter().flatten().next() {
        notes.push(format!(
            "The cam is undercut: its profile begins with a corner, on which the rollers turn below a travel of {}.",
            format_si(corner.travel_m, &design.units.travel, 3)
        ));
    }
    notes
}

/// Places of the cam to be measured: the exact profile, its normal, and what the measured deviation does to the force.
fn inspection(design: &Design, behaviour: &Behaviour) -> Sheet {
    let cut = &behaviour.cut;
    let sense = cut.purpose().springs.sense();
    let [from, to] = cut.range_m();
    let number = |value: f64, digits: usize| format!("{value:.digits$}");
    let mut rows = Vec::new();
    for side in 0..SIDES {
        let path = &behaviour.mechanism.paths[side];
        let start = behaviour.corners[side].map_or(from, |c| c.lambda_m);
        for i in 0..=INSPECTED {
            let u = f64::from(i) / f64::from(INSPECTED);
            let lambda = start + (to - start) * u;
            let place = path.designed(lambda);
            let [_, normal] = frame(&place, sense);
            let on_cam = surface(design, path, lambda).point_m;
            let sign = if side == 0 { 1.0 } else { -1.0 };
            let brace = cut.purpose().sides[side].brace_m;
            let tan = place.at[0] / (brace * brace - place.at[0] * place.at[0]).sqrt();
            let point = cut.at(side, lambda);
            let tension = cut.purpose().springs.tension_n(cut.purpose().start_length_m + sense * lambda)[0].abs();
            // A slope of 1 µm/mm along the travel on this side: δF = P d(δx)/ds.
            let per_slope = 1e-3 * tension / (normal[0] + normal[1] * tan).abs();
            rows.push(vec![
                ["right", "left"][side].to_owned(),
                number(1e3 * point.s.value(), 3),
                number(sign * 1e3 * on_cam[0], 4),
                number(1e3 * on_cam[1], 4),
                number(sign * normal[0], 5),
                number(normal[1], 5),
                number(per_slope, 4),
            ]);
        }
    }
    let columns = ["side", "travel / mm", "x / mm", "y / mm", "normal x", "normal y", "force per slope of 1 µm/mm / N"];
    Sheet {
        name: "inspection".to_owned(),
        caption: "Places of the cam to be measured, with the normal outwards; the last column is the force that a deviation along the normal adds for each micrometre that it grows per millimetre of travel.".to_owned(),
        columns: columns.map(str::to_owned).to_vec(),
        rows,
    }
}

/// The springs to order, and what a turn of the adjusting screw does.
fn order(design: &Design, behaviour: &Behaviour) -> Sheet {
    let stations = &behaviour.stations;
    springs_to_order(&Order {
        springs: &design.built.springs,
        extension: design.built.extension,
        lengths_m: Behaviour::extent(stations, |s| s.still.spring_m),
        pitch_m: design.adjust_pitch_m,
        middle: stations.get(stations.len() / 2).map(|s| [s.still.spring_m, s.still.force_n]),
        per_turn: "force of the mechanism per turn in mid-stroke / N",
        gives: "force",
    })
}

/// What a sheet of springs follows from.
pub(crate) struct Order<'a> {
    pub springs: &'a [Spring],
    pub extension: bool,
    /// Shortest and longest, m.
    pub lengths_m: [f64; 2],
    /// Of the adjusting screw, m.
    pub pitch_m: Option<f64>,
    /// Length of the springs in the middle of the way, m, and the force or torque of the mechanism there.
    pub middle: Option<[f64; 2]>,
    /// Heading of what a turn adds.
    pub per_turn: &'static str,
    /// What the mechanism gives.
    pub gives: &'static str,
}

/// Springs with the lengths and forces that they need, and what a turn of the adjusting screw of each does.
pub(crate) fn springs_to_order(order: &Order<'_>) -> Sheet {
    let number = |value: f64| format_number(value, 5);
    let [shortest, longest] = order.lengths_m;
    let one = |(i, spring): (usize, &Spring)| {
        let bank = Bank::new(vec![spring.clone()], order.extension);
        let force = |length: f64| bank.tension_n(length)[0].abs();
        // F = P dL/ds: a turn changes P by the rate times the pitch.
        let turn = order.pitch_m.zip(order.middle).map(|(pitch_m, [length, level])| {
            let [total, _] = Bank::new(order.springs.to_vec(), order.extension).tension_n(length);
            level * bank.tension_n(length)[1] * pitch_m / total.abs()
        });
        let (rate, rest) = match &spring.law {
            SpringLaw::Linear { rate_n_per_m, rest_m } => (number(1e-3 * rate_n_per_m), number(1e3 * rest_m)),
            SpringLaw::Table(_) => ("by its curve".to_owned(), "by its curve".to_owned()),
        };
        let lengths = [number(1e3 * shortest), number(1e3 * longest), number(force(shortest)), number(force(longest))];
        let turn = turn.map_or_else(|| "–".to_owned(), number);
        [(i + 1).to_string(), rate, rest].into_iter().chain(lengths).chain([turn]).collect()
    };
    let columns = [
        "spring",
        "rate / N/mm",
        "rest length / mm",
        "shortest / mm",
        "longest / mm",
        "force there / N",
        "largest force / N",
        order.per_turn,
    ];
    Sheet {
        name: "springs".to_owned(),
        caption: format!(
            "Springs to order, lengths between the axles; and what one turn of the adjusting screw of a spring adds to the {} of the mechanism.",
            order.gives
        ),
        columns: columns.map(str::to_owned).to_vec(),
        rows: order.springs.iter().enumerate().map(one).collect(),
    }
}

fn mirrored([x, y]: Vector) -> Vector {
    [-x, y]
}

/// A segment of the left side, in its place in the picture.
fn mirror(segment: &Segment) -> Segment {
    match segment {
        Segment::Arc { to_m, centre_m, counterclockwise } => {
            Segment::Arc { to_m: mirrored(*to_m), centre_m: mirrored(*centre_m), counterclockwise: !counterclockwise }
        }
        other => Segment::Line { to_m: mirrored(other.end_m()) },
    }
}

fn ends(drawn: &Drawn) -> [Vector; 2] {
    let segments = &drawn.arcs.segments;
    let last = segments.last().map_or([0.0; 2], Segment::end_m);
    [drawn.first, last]
}

/// The plate between the rollers.
fn plate(making: &Making, profiles: &[Drawn; SIDES]) -> Profile {
    let [right, left] = [ends(&profiles[0]), ends(&profiles[1]).map(mirrored)];
    let bottom = right[0][1].min(left[0][1]) - making.base_m;
    let [right_foot, left_foot] = [profiles[0].relief_m.min(right[0][0]), (-profiles[1].relief_m).max(left[0][0])];
    let start_m = [left_foot, bottom];
    let line = |to_m: Vector| Segment::Line { to_m };
    let mut segments = vec![line([right_foot, bottom]), line([right_foot, right[0][1]]), line(right[0])];
    segments.extend(profiles[0].arcs.segments.iter().cloned());
    segments.push(line(left[1]));
    // Down the left side: its profile the other way round.
    let up = Profile { start_m: left[0], segments: profiles[1].arcs.segments.iter().map(mirror).collect() };
    segments.extend(up.reversed().segments);
    segments.extend([line([left_foot, left[0][1]]), line(start_m)]);
    Profile { start_m, segments }
}

/// A plate outside one roller.
fn outer_plate(making: &Making, drawn: &Drawn) -> Profile {
    let [low, high] = ends(drawn);
    let out = low[0].max(high[0]) + making.wall_m;
    let bottom = low[1] - making.base_m;
    let line = |to_m: Vector| Segment::Line { to_m };
    let up = Profile { start_m: low, segments: drawn.arcs.segments.clone() };
    // A thin wall is left in any case.
    let foot = drawn.relief_m.max(low[0]).min(out - 0.1 * making.wall_m);
    let mut segments = vec![line([out, bottom]), line([out, high[1]]), line(high)];
    segments.extend(up.reversed().segments);
    segments.extend([line([foot, low[1]]), line([foot, bottom])]);
    let right = Profile { start_m: [foot, bottom], segments };
    if drawn.side == 0 {
        return right;
    }
    let mirrored_segments = right.segments.iter().map(mirror).collect();
    Profile { start_m: mirrored(right.start_m), segments: mirrored_segments }.reversed()
}

/// Two on the axis, near the ends of the plate.
fn mounting_holes(making: &Making, profiles: &[Drawn; SIDES]) -> Vec<Hole> {
    let Some(diameter_m) = making.hole_m else { return Vec::new() };
    let [low, high] = ends(&profiles[0]);
    [low[1] - 0.5 * making.base_m, high[1] - 1.5 * diameter_m]
        .map(|y| Hole { centre_m: [0.0, y], diameter_m, purpose: "mounting".to_owned() })
        .to_vec()
}

/// A roller of a radius, with a hole of a diameter, so thick.
pub(crate) fn roller([radius_m, pin_m, depth_m]: [f64; 3], material: Option<String>, density_kg_per_m3: Option<f64>) -> Part {
    Part {
        name: "roller".to_owned(),
        title: "Roller".to_owned(),
        count: 2,
        material,
        density_kg_per_m3,
        notes: vec!["A ball bearing of this outer diameter does as well.".to_owned()],
        body: Body::Plate(Plate {
            depth_m,
            outline: Profile::circle([0.0; 2], radius_m),
            cutouts: Vec::new(),
            fillets: None,
            trial: Err(RIGID.to_owned()),
            holes: vec![Hole { centre_m: [0.0; 2], diameter_m: pin_m, purpose: "axle".to_owned() }],
        }),
    }
}

/// One kind, or two where the sides differ; a brace stands on either face of the plate.
fn braces(design: &Design) -> Vec<Part> {
    let sides = &design.purpose.sides;
    let same = sides[0].brace_m.to_bits() == sides[1].brace_m.to_bits();
    let making = &design.making;
    let one = |name: &str, title: &str, length_m: f64| {
        let half = 0.5 * making.brace_width_m;
        let round = |to_m: Vector, centre_m: Vector| Segment::Arc { to_m, centre_m, counterclockwise: true };
        let outline = Profile {
            start_m: [0.0, -half],
            segments: vec![
                Segment::Line { to_m: [length_m, -half] },
                round([length_m + half, 0.0], [length_m, 0.0]),
                round([length_m, half], [length_m, 0.0]),
                Segment::Line { to_m: [0.0, half] },
                round([-half, 0.0], [0.0; 2]),
                round([0.0, -half], [0.0; 2]),
            ],
        };
        let hole = |x: f64, purpose: &str| Hole { centre_m: [x, 0.0], diameter_m: making.pin_m, purpose: purpose.to_owned() };
        Part {
            name: name.to_owned(),
            title: title.to_owned(),
            count: if same { 2 } else { 1 },
            material: None,
            density_kg_per_m3: None,
            notes: vec![
                "The distance of the holes is the brace length: it moves the force little, the two of a pair should be equal.".to_owned(),
                "Twice as many where they stand in pairs on both faces of the rollers.".to_owned(),
            ],
            body: Body::Plate(Plate {
                depth_m: making.brace_thickness_m,
                outline,
                cutouts: Vec::new(),
                fillets: None,
                trial: Err(RIGID.to_owned()),
                holes: vec![hole(0.0, "axle of the roller"), hole(length_m, "joint of the slider")],
            }),
        }
    };
    if same {
        return vec![one("brace", "Brace", sides[0].brace_m)];
    }
    vec![one("brace-right", "Brace, right", sides[0].brace_m), one("brace-left", "Brace, left", sides[1].brace_m)]
}

/// Round, as long as roller and a brace on either side are thick.
fn pin(design: &Design, thickness_m: f64) -> Part {
    let making = &design.making;
    Part {
        name: "pin".to_owned(),
        title: "Axle, without what carries the springs".to_owned(),
        count: 2,
        material: None,
        density_kg_per_m3: None,
        notes: vec!["Longer where several springs stand side by side on it.".to_owned()],
        body: Body::Plate(Plate {
            depth_m: thickness_m + 2.0 * making.brace_thickness_m,
            outline: Profile::circle([0.0; 2], 0.5 * making.pin_m),
            cutouts: Vec::new(),
            fillets: None,
            trial: Err(RIGID.to_owned()),
            holes: Vec::new(),
        }),
    }
}

/// CAM011: what the arcs cost of the force band.
fn chord_check(design: &Design, cost: f64) -> Check {
    let band = design.requirements.as_ref().and_then(|r| r.force.as_ref()).map(|f| f.1);
    let percent = Unit::parse("%").unwrap_or_else(|_| Unit::si(Dimension::Ratio));
    Comparison {
        code: "CAM011",
        name: "chord_error".to_owned(),
        title: "Force error of the arcs of the cam".to_owned(),
        required: false,
        value: Some(cost),
        limit: band.map(|b| 0.1 * b),
        sense: Sense::AtMost,
        dimension: Dimension::Ratio,
        display: percent,
        scale: None,
        basis: "δF/F = d(P δL)/ds over F: the slope of the deviation counts; a tenth of the force band is allowed".to_owned(),
        fix: "make `parts.chord_error` smaller: the force error follows about its 2/3 power".to_owned(),
        missing: "no force band is required".to_owned(),
        partial: false,
        broken: false,
    }
    .judge()
}
