//! A turned part in STEP: strips of B-splines between helices, plain cylinders, and planes across the axis.

use forcewright_model::Part;

use super::spline::{self, DEGREE, fitted, places, product, spans_of_turn};
use super::{Helical, Side, Span, Stack, polar};
use crate::shape::{Circle, Point};
use crate::step::{Entity, INNER, OUTER, Ring, Step, document};

pub(crate) fn write(part: &Part, stack: &Stack) -> String {
    document(part, |step| faces(step, stack))
}

/// All faces: those of the sections, of the bore, then those across the axis from z = 0 upwards.
fn faces(step: &mut Step, stack: &Stack) -> Vec<Entity> {
    let rings: Vec<Ring> = stack
        .sides
        .iter()
        .zip(stack.levels.windows(2))
        .map(|(side, ends)| match side {
            Side::Round { radius } => step.ring(&Circle { centre: [0.0; 2], radius: *radius }.as_outline(), [ends[0], ends[1]]),
            Side::Helical(helical) => helix(step, helical, [ends[0], ends[1]]),
        })
        .collect();
    let bore = Circle { centre: [0.0; 2], radius: stack.bore };
    let bore = (stack.bore > 0.0).then(|| step.ring(&bore.as_loop(0), [0.0, stack.height()]));
    let mut faces: Vec<Entity> = rings.iter().chain(&bore).flat_map(|ring| ring.walls.iter().cloned()).collect();
    let last = rings.len();
    for (level, &z) in stack.levels.iter().enumerate() {
        let mut bounds = Vec::new();
        let is_up = level == last || level > 0 && stack.is_larger_below(level);
        if level > 0 {
            bounds.push(step.over(&rings[level - 1], if is_up { OUTER } else { INNER }));
        }
        if level < last {
            bounds.push(step.under(&rings[level], if is_up { INNER } else { OUTER }));
        }
        if let Some(bore) = &bore {
            if level == 0 {
                bounds.push(step.under(bore, INNER));
            } else if level == last {
                bounds.push(step.over(bore, INNER));
            }
        }
        faces.push(step.flat(&bounds, z, if is_up { 1.0 } else { -1.0 }));
    }
    faces
}

/// The knots 0, 1, 2, … of a spline and how often each counts, as STEP has them.
pub(crate) fn knots(control: usize) -> (String, String) {
    let spans = control - DEGREE;
    let counts = (0..=spans).map(|k| if k == 0 || k == spans { DEGREE + 1 } else { 1 }.to_string());
    let knots = (0..=spans).map(|k| format!("{k}."));
    (counts.collect::<Vec<_>>().join(","), knots.collect::<Vec<_>>().join(","))
}

pub(crate) fn curve(step: &mut Step, points: &[Entity]) -> Entity {
    let (counts, knots) = knots(points.len());
    let points = points.join(",");
    step.add(format_args!("B_SPLINE_CURVE_WITH_KNOTS('',{DEGREE},({points}),.UNSPECIFIED.,.F.,.F.,({counts}),({knots}),.UNSPECIFIED.)"))
}

/// A line along a groove: its control points, its edge, and the vertices at its ends.
struct Rail {
    points: Vec<Entity>,
    edge: Entity,
    ends: [Entity; 2],
}

/// The walls of grooves between two heights: for each segment of each groove a strip, counterclockwise.
fn helix(step: &mut Step, helical: &Helical, [low, high]: [f64; 2]) -> Ring {
    let angle = helical.winding * (high - low);
    let spans = spans_of_turn(angle, helical.radii[1]);
    let turn = spline::turn(angle, spans);
    let heights: Vec<f64> = places(spans).into_iter().map(|x| low + (high - low) * x / spans as f64).collect();
    let along = |step: &mut Step, foot: Point| -> Vec<Entity> {
        let points = turn.iter().zip(&heights);
        points
            .map(|(&turned, &z)| {
                let [x, y] = product(foot, turned);
                step.point(&[x, y, z])
            })
            .collect()
    };
    // Right-handed grooves are passed against the axis.
    let mut order: Vec<&Span> = helical.spans.iter().collect();
    if helical.winding > 0.0 {
        order.reverse();
    }
    let strips: Vec<Vec<Point>> = order.iter().map(|span| foot(helical, span)).collect();
    let rotated = |start: u32, point: Point| product(point, polar(1.0, helical.angle(start)));
    let each = || (0..helical.starts).flat_map(|start| strips.iter().map(move |strip| (start, strip)));
    let of_corner = |(start, strip): (u32, &Vec<Point>)| {
        let points = along(step, rotated(start, strip[0]));
        rail(step, points)
    };
    let rails: Vec<Rail> = each().map(of_corner).collect();
    let mut ring = Ring { walls: Vec::new(), bottom: Vec::new(), top: Vec::new() };
    for (index, (start, strip)) in each().enumerate() {
        let (left, right) = (&rails[index], &rails[(index + 1) % rails.len()]);
        let mut net = vec![left.points.clone()];
        for &point in &strip[1..strip.len() - 1] {
            net.push(along(step, rotated(start, point)));
        }
        net.push(right.points.clone());
        let across = |step: &mut Step, k: usize, end: usize| {
            let points: Vec<Entity> = net.iter().map(|row| row[k].clone()).collect();
            let curve = curve(step, &points);
            step.add(format_args!("EDGE_CURVE('',{},{},{curve},.T.)", left.ends[end], right.ends[end]))
        };
        let (bottom, top) = (across(step, 0, 0), across(step, heights.len() - 1, 1));
        let bound = step.bound(&[(&bottom, true), (&right.edge, true), (&top, false), (&left.edge, false)], OUTER);
        let surface = surface(step, &net);
        ring.walls.push(step.face(&[bound], &surface, true));
        ring.bottom.push(bottom);
        ring.top.push(top);
    }
    ring
}

fn rail(step: &mut Step, points: Vec<Entity>) -> Rail {
    let curve = curve(step, &points);
    let ends = [&points[0], &points[points.len() - 1]].map(|point| step.add(format_args!("VERTEX_POINT('',{point})")));
    let edge = step.add(format_args!("EDGE_CURVE('',{},{},{curve},.T.)", ends[0], ends[1]));
    Rail { points, edge, ends }
}

/// Control points of a segment of a groove in the plane z = 0, counterclockwise, if the groove's middle lies at the angle 0.
fn foot(helical: &Helical, span: &Span) -> Vec<Point> {
    let is_backward = helical.winding > 0.0;
    let at = |share: f64| {
        let [along, radius] = span.at(if is_backward { 1.0 - share } else { share });
        polar(radius, -helical.winding * along)
    };
    fitted(at)
}

/// The surface over a net of control points; its own normal points out of the material.
fn surface(step: &mut Step, net: &[Vec<Entity>]) -> Entity {
    let ((counts, knots), (counts_up, knots_up)) = (knots(net.len()), knots(net[0].len()));
    let rows: Vec<String> = net.iter().map(|row| format!("({})", row.join(","))).collect();
    step.add(format_args!(
        "B_SPLINE_SURFACE_WITH_KNOTS('',{DEGREE},{DEGREE},({}),.UNSPECIFIED.,.F.,.F.,.F.,({counts}),({counts_up}),({knots}),({knots_up}),\
         .UNSPECIFIED.)",
        rows.join(",")
    ))
}
