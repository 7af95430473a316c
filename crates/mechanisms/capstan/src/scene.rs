//! The drive as pictures: along its axes over the torque, and in space over its travel.

use std::f64::consts::{PI, TAU};

use forcewright_base::maths;
use forcewright_base::units::{Dimension, format_si};
use forcewright_model::{Axis, ColourScale, Film, Frame, Item, Look, Role, Scene};

use crate::analysis::Behaviour;
use crate::design::Design;
use crate::geometry::{CentreLine, Drum, Piece};
use crate::statics::Loaded;
use crate::tension::Along;
use crate::whole::count;

/// Frames of a film.
const FRAMES: usize = 21;
/// Points of a turn.
const PER_TURN: usize = 60;
/// Direction of view in space: how far the axes are turned from the line of sight, and how far it looks down, rad.
const VIEW: [f64; 2] = [0.9, 0.45];

type Point = [f64; 2];

fn line(points: Vec<Point>, width_m: f64, role: Role, values: Option<Vec<f64>>) -> Item {
    Item::Line { points, width_m, role, values }
}

fn arc(centre: Point, radii_m: [f64; 2], from_rad: f64, sweep_rad: f64) -> Vec<Point> {
    let intervals = count((sweep_rad.abs() / TAU * PER_TURN as f64).ceil()).clamp(2, 20 * PER_TURN);
    let at = |i: usize| {
        let u = i as f64 / intervals as f64;
        let (sin, cos) = maths::sin_cos(from_rad + u * sweep_rad);
        let r = radii_m[0] + u * (radii_m[1] - radii_m[0]);
        [centre[0] + r * cos, centre[1] + r * sin]
    };
    (0..=intervals).map(at).collect()
}

/// The drive seen along its axes, under growing torque; `None` where nothing could be computed.
pub(crate) fn drive(design: &Design, behaviour: &Behaviour, axis: Axis) -> Option<Film> {
    let last = behaviour.stations.len().checked_sub(1).filter(|last| *last > 0)?;
    let line = behaviour.geometry.centre_line(0, 0.5 * design.built.travel_rad).ok()?;
    let most_n = behaviour.stations.iter().filter_map(|s| s.tensions_n.first()).flatten().copied().fold(0.0, f64::max);
    let places: Vec<usize> = (0..FRAMES).map(|i| i * last / (FRAMES - 1)).collect();
    let frames = places.iter().filter_map(|i| loaded_frame(design, behaviour, &line, &behaviour.stations[*i])).collect::<Vec<_>>();
    let stage = Scene {
        items: drums_side(design, behaviour),
        scale: Some(ColourScale { label: "T".to_owned(), display: design.units.force.clone(), max: most_n, limit: None }),
        words: ["as made", "moved"],
        display: design.units.length.clone(),
        description:
            "Two drums seen along their axes and the cable around them, coloured by its tension, with the zones in which it slips."
                .to_owned(),
    };
    let torque_nm = design.requirements.as_ref().map_or(f64::INFINITY, |r| r.torque_nm);
    let chosen = frames.iter().rposition(|f: &Frame| f.at <= torque_nm * 1.001).unwrap_or(frames.len() / 2);
    Some(Film { axis, stage, chosen, frames })
}

fn drums_side(design: &Design, behaviour: &Behaviour) -> Vec<Item> {
    let cable_m = design.built.cable_m();
    let one = |drum: Drum| {
        let centre = [behaviour.geometry.axis_m(drum), 0.0];
        [
            Item::Disc { centre, radius_m: behaviour.geometry.radius_m(drum) - 0.5 * cable_m, role: Role::Named(Look::Plate, "drums") },
            Item::Disc { centre, radius_m: 0.12 * behaviour.geometry.radius_m(Drum::Input), role: Role::Named(Look::Moving, "shafts") },
        ]
    };
    [one(Drum::Output), one(Drum::Input)].concat()
}

fn loaded_frame(design: &Design, behaviour: &Behaviour, centre: &CentreLine, loaded: &Loaded) -> Option<Frame> {
    let along = Along::of(design, behaviour, loaded, 0)?;
    let cable_m = design.built.cable_m();
    let [taut_rad, input_rad, slack_rad] = along.wraps_rad();
    let mut items = Vec::new();
    // Wraps first, the ends next to the spans last: they lie on top.
    for (index, piece) in centre.pieces.iter().enumerate() {
        let Piece::Helix(helix) = piece else { continue };
        let points = arc([helix.axis_m, 0.0], [helix.radius_m; 2], helix.start_rad, helix.sweep_rad);
        let count = points.len() as f64 - 1.0;
        let value = |i: usize| {
            let u = i as f64 / count;
            match index {
                0 => along.tension_n(0, 0, (1.0 - u) * taut_rad),
                2 => along.input_n(u * input_rad),
                _ => along.tension_n(1, 0, u * slack_rad),
            }
        };
        let values = (0..points.len()).map(value).collect();
        items.push(line(points, cable_m, Role::Deformed, Some(values)));
    }
    for (side, index) in [(0, 1), (1, 3)] {
        if let Piece::Span(span) = &centre.pieces[index] {
            let points = vec![[span.from_m[0], span.from_m[1]], [span.to_m[0], span.to_m[1]]];
            items.push(line(points, cable_m, Role::Deformed, Some(vec![loaded.tensions_n.first()?[side]; 2])));
        }
    }
    items.extend(slip_zones(centre, &along, cable_m));
    let force = |n: f64| format_si(n, &design.units.force, 4);
    let [taut_n, slack_n] = *loaded.tensions_n.first()?;
    let turn = format_si(loaded.turn_rad, &design.units.small_angle, 3);
    Some(Frame { at: loaded.torque_nm, note: format!("φ = {turn}, tensions {} and {}", force(taut_n), force(slack_n)), items })
}

/// Zones of slip as spirals outside the drums: from each end of each span inwards.
fn slip_zones(centre: &CentreLine, along: &Along, cable_m: f64) -> Vec<Item> {
    let [taut, slack] = along.slip_rad();
    let wraps = along.wraps_rad();
    let zone = |index: usize, at_end: bool, slip_rad: f64, wrap_rad: f64, text: &'static str| {
        let Piece::Helix(helix) = &centre.pieces[index] else { return None };
        let angle_rad = slip_rad.min(wrap_rad);
        if angle_rad < 1e-3 {
            return None;
        }
        let sense = helix.sweep_rad.signum();
        let (from_rad, sweep_rad) =
            if at_end { (helix.start_rad + helix.sweep_rad, -sense * angle_rad) } else { (helix.start_rad, sense * angle_rad) };
        let near_m = helix.radius_m + 1.6 * cable_m;
        let far_m = near_m + 1.2 * cable_m * angle_rad / TAU;
        let look = if text.starts_with("slip of the taut") { Look::Limit } else { Look::Track };
        Some(line(arc([helix.axis_m, 0.0], [near_m, far_m], from_rad, sweep_rad), 0.0, Role::Named(look, text), None))
    };
    let (first, second) = ("slip of the taut side", "slip of the slack side");
    [
        zone(0, true, taut[0], wraps[0], first),
        zone(2, false, taut[1], wraps[1], first),
        zone(2, true, slack[1], wraps[1], second),
        zone(4, false, slack[0], wraps[2], second),
    ]
    .into_iter()
    .flatten()
    .collect()
}

/// A view from outside: axes of the picture in space.
struct View {
    right: [f64; 3],
    up: [f64; 3],
    towards: [f64; 3],
}

impl View {
    fn new() -> Self {
        let [turn, down] = VIEW;
        let ((st, ct), (sd, cd)) = (maths::sin_cos(turn), maths::sin_cos(down));
        // The axes of the drums run to the right and back, the output beside the input.
        let right = [ct, 0.0, st];
        let towards = [st * cd, sd, -ct * cd];
        let up = [-st * sd, cd, ct * sd];
        Self { right, up, towards }
    }

    fn at(&self, point: [f64; 3]) -> Point {
        let dot = |a: &[f64; 3]| (0..3).map(|i| a[i] * point[i]).sum();
        [dot(&self.right), dot(&self.up)]
    }

    /// Whether what lies on a drum at an angle faces the reader.
    fn faces(&self, angle_rad: f64) -> bool {
        let (sin, cos) = maths::sin_cos(angle_rad);
        self.towards[0] * cos + self.towards[1] * sin >= 0.0
    }
}

/// The drums and cables in space over the travel; `None` where there are none.
pub(crate) fn drums(design: &Design, behaviour: &Behaviour) -> Option<Film> {
    let built = &design.built;
    let view = View::new();
    let frames: Vec<Frame> = (0..FRAMES)
        .filter_map(|i| {
            let output_rad = built.travel_rad * i as f64 / (FRAMES - 1) as f64;
            space_frame(design, behaviour, &view, output_rad)
        })
        .collect();
    let stage = Scene {
        items: cylinders(design, behaviour, &view),
        scale: None,
        words: ["as made", "moved"],
        display: design.units.length.clone(),
        description: "Both drums in space with their cables, which wind from one to the other as the output turns.".to_owned(),
    };
    let axis =
        Axis { name: "output", label: "Turn of the output".to_owned(), dimension: Dimension::Angle, display: design.units.angle.clone() };
    (!frames.is_empty()).then_some(Film { axis, stage, chosen: frames.len() / 2, frames })
}

/// The section of a drum along its axis, m.
fn section_m(design: &Design, behaviour: &Behaviour, drum: Drum) -> [f64; 2] {
    let band = behaviour.geometry.band(drum);
    [band.from_m - design.making.margin_m, band.to_m + design.making.margin_m]
}

fn circle(view: &View, axis_m: f64, radius_m: f64, z_m: f64) -> Vec<Point> {
    let at = |i: usize| {
        let (sin, cos) = maths::sin_cos(TAU * i as f64 / PER_TURN as f64);
        view.at([axis_m + radius_m * cos, radius_m * sin, z_m])
    };
    (0..=PER_TURN).map(at).collect()
}

/// Silhouettes of both drums: the back face, what connects it, and the front face.
fn cylinders(design: &Design, behaviour: &Behaviour, view: &View) -> Vec<Item> {
    let cable_m = design.built.cable_m();
    let mut items = Vec::new();
    for drum in [Drum::Output, Drum::Input] {
        let axis_m = behaviour.geometry.axis_m(drum);
        let radius_m = behaviour.geometry.radius_m(drum) - 0.5 * cable_m;
        let [low_m, high_m] = section_m(design, behaviour, drum);
        // The outline: half circles of both faces, joined along the edges seen from the side.
        let edge_rad = maths::atan2(view.towards[1], view.towards[0]) + 0.5 * PI;
        let half = |z_m: f64, from_rad: f64| {
            (0..=PER_TURN / 2).map(move |i| {
                let (sin, cos) = maths::sin_cos(from_rad + PI * i as f64 / (PER_TURN / 2) as f64);
                [axis_m + radius_m * cos, radius_m * sin, z_m]
            })
        };
        let near_m = if view.towards[2] > 0.0 { high_m } else { low_m };
        let far_m = if view.towards[2] > 0.0 { low_m } else { high_m };
        // The side is seen as far as it faces the reader: up to the far face there, to the near one on the other side.
        let outline: Vec<Point> = half(far_m, edge_rad + PI).chain(half(near_m, edge_rad)).map(|p| view.at(p)).collect();
        items.push(Item::Body { corners: outline, role: Role::Named(Look::Plate, "drums") });
        items.push(Item::Body { corners: circle(view, axis_m, radius_m, near_m), role: Role::Named(Look::Plate, "") });
    }
    items
}

fn space_frame(design: &Design, behaviour: &Behaviour, view: &View, output_rad: f64) -> Option<Frame> {
    let built = &design.built;
    let mut items = Vec::new();
    let turned = behaviour.geometry.turned_rad(output_rad).ok()?;
    items.extend(marks(design, behaviour, view, turned));
    for cable in 0..built.cables.len() {
        let centre = behaviour.geometry.centre_line(cable, output_rad).ok()?;
        for piece in &centre.pieces {
            match piece {
                Piece::Span(span) => {
                    let points = vec![view.at(span.from_m), view.at(span.to_m)];
                    items.push(line(points, 0.0, Role::Named(Look::Wire, "cables"), None));
                }
                Piece::Helix(helix) => items.extend(wound(view, helix)),
            }
        }
    }
    let wraps = behaviour.geometry.output_wraps_rad(output_rad).ok()?;
    let [one, other] = wraps.map(|rad| format_si(rad, &design.units.angle, 3));
    Some(Frame { at: output_rad, note: format!("wraps before the terminations {one} and {other}"), items })
}

/// A part of a cable on a drum, cut where it passes to the back.
fn wound(view: &View, helix: &crate::geometry::Helix) -> Vec<Item> {
    let intervals = count((helix.sweep_rad.abs() / TAU * PER_TURN as f64).ceil()).clamp(2, 200 * PER_TURN);
    let mut items = Vec::new();
    let mut run: Vec<Point> = Vec::new();
    let mut front = None;
    for i in 0..=intervals {
        let u = i as f64 / intervals as f64;
        let angle_rad = helix.start_rad + u * helix.sweep_rad;
        let (sin, cos) = maths::sin_cos(angle_rad);
        let point = view.at([helix.axis_m + helix.radius_m * cos, helix.radius_m * sin, helix.start_m + u * helix.rise_m]);
        let faces = view.faces(angle_rad);
        run.push(point);
        if front.is_some_and(|f| f != faces) || i == intervals {
            items.push(run_item(std::mem::take(&mut run), front.unwrap_or(faces)));
            run.push(point);
        }
        front = Some(faces);
    }
    items
}

fn run_item(points: Vec<Point>, front: bool) -> Item {
    let (look, text) = if front { (Look::Wire, "cables") } else { (Look::Track, "behind a drum") };
    line(points, 0.0, Role::Named(look, text), None)
}

/// A mark on the near face of each drum, which turns with it.
fn marks(design: &Design, behaviour: &Behaviour, view: &View, turned_rad: [f64; 2]) -> Vec<Item> {
    [Drum::Input, Drum::Output]
        .into_iter()
        .zip(turned_rad)
        .map(|(drum, angle_rad)| {
            let [low_m, high_m] = section_m(design, behaviour, drum);
            let z_m = if view.towards[2] > 0.0 { high_m } else { low_m };
            let (sin, cos) = maths::sin_cos(angle_rad + 0.5 * PI);
            let axis_m = behaviour.geometry.axis_m(drum);
            let radius_m = behaviour.geometry.radius_m(drum) - 0.5 * design.built.cable_m();
            let tip = view.at([axis_m + radius_m * cos, radius_m * sin, z_m]);
            line(vec![view.at([axis_m, 0.0, z_m]), tip], 0.0, Role::Named(Look::Rail, "marks that turn with the drums"), None)
        })
        .collect()
}
