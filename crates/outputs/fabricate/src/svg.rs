//! True-size drawings for laser cutters.

use std::fmt::Write as _;

use forcewright_model::Part;

use crate::coil::{Line, Views};
use crate::shape::{Circle, Curve, Edge, Loop, Point, Shape};
use crate::text::{length, remarks, xml};

/// Room around the part, mm.
const MARGIN: f64 = 1.0;

/// The drawing. One user unit is one millimetre; lines are thin, for they are where the tool goes.
pub(crate) fn write(part: &Part, shape: &Shape) -> String {
    let mut out = head(part, shape.extent());
    out.push_str("<g fill=\"none\" stroke-width=\"0.1\">\n<g id=\"outline\" stroke=\"#000000\">\n");
    let _ = writeln!(out, "<path d=\"{}\"/>", path(&shape.outline));
    out.push_str("</g>\n<g id=\"cutouts\" stroke=\"#ff0000\">\n");
    for cutout in &shape.cutouts {
        let _ = writeln!(out, "<path d=\"{}\"/>", path(cutout));
    }
    out.push_str("</g>\n<g id=\"holes\" stroke=\"#0000ff\">\n");
    for (hole, told) in shape.holes.iter().zip(part.plate().map_or(&[][..], |plate| &plate.holes)) {
        let ([x, y], r) = (coordinates(hole.centre), length(hole.radius));
        let _ = writeln!(out, "<circle cx=\"{x}\" cy=\"{y}\" r=\"{r}\"><title>{}</title></circle>", xml(&told.purpose));
    }
    out.push_str("</g>\n");
    if let Some(axis) = shape.axis {
        let [[x, y], [u, v]] = axis.map(coordinates);
        let line = format!("<line x1=\"{x}\" y1=\"{y}\" x2=\"{u}\" y2=\"{v}\"/>");
        let _ = writeln!(out, "<g id=\"centre\" stroke=\"#008000\" stroke-dasharray=\"4 1 0.5 1\">\n{line}\n</g>");
    }
    out.push_str("</g>\n</svg>\n");
    out
}

/// The views of a spring.
pub(crate) fn write_views(part: &Part, views: &Views) -> String {
    let mut out = head(part, views.extent);
    out.push_str("<g fill=\"none\" stroke-width=\"0.1\">\n<g id=\"outline\" stroke=\"#000000\">\n");
    out.extend(views.outline.iter().map(chain));
    out.push_str("</g>\n<g id=\"end\" stroke=\"#0000ff\">\n");
    out.extend(views.end.iter().map(circle));
    out.push_str("</g>\n<g id=\"centre\" stroke=\"#008000\" stroke-dasharray=\"4 1 0.5 1\">\n");
    out.extend(views.centre.iter().map(chain));
    out.push_str(&circle(&views.mean));
    out.push_str("</g>\n</g>\n</svg>\n");
    out
}

fn chain(line: &Line) -> String {
    let points = line.points.iter().map(|&point| coordinates(point).join(" "));
    format!("<path d=\"M{}\"/>\n", points.collect::<Vec<_>>().join("L"))
}

fn circle(circle: &Circle) -> String {
    let [x, y] = coordinates(circle.centre);
    format!("<circle cx=\"{x}\" cy=\"{y}\" r=\"{}\"/>\n", length(circle.radius))
}

/// The beginning of a drawing, up to its first group.
fn head(part: &Part, [low, high]: [Point; 2]) -> String {
    // SVG counts y downwards; it stays where it is and changes its sign.
    let (left, top) = (low[0] - MARGIN, -high[1] - MARGIN);
    let (width, height) = (high[0] - low[0] + 2.0 * MARGIN, high[1] - low[1] + 2.0 * MARGIN);
    let [left, top, width, height] = [left, top, width, height].map(|mm| format!("{mm:.3}"));
    let mut out = String::from("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n");
    let _ = writeln!(
        out,
        "<svg xmlns=\"http://www.w3.org/2000/svg\" version=\"1.1\" width=\"{width}mm\" height=\"{height}mm\" \
         viewBox=\"{left} {top} {width} {height}\">"
    );
    let _ = writeln!(out, "<title>{}</title>", xml(&part.title));
    let _ = writeln!(out, "<desc>{}</desc>", xml(&remarks(part)[1..].join(" ")));
    out
}

fn path(boundary: &Loop) -> String {
    let [x, y] = coordinates(boundary.edges[0].from);
    let mut out = format!("M{x} {y}");
    for edge in &boundary.edges {
        add_edge(edge, &mut out);
    }
    out.push('Z');
    out
}

fn add_edge(edge: &Edge, out: &mut String) {
    match &edge.curve {
        Curve::Line => {
            let [x, y] = coordinates(edge.to);
            let _ = write!(out, "L{x} {y}");
        }
        Curve::Arc { radius, sweep_rad, .. } => {
            // The middle of an arc near the half circle does not follow from its ends; that of two halves does.
            let count = if sweep_rad.abs() > 3.0 { 2 } else { 1 };
            let (r, flag) = (length(*radius), u8::from(*sweep_rad < 0.0));
            for (to, _) in edge.arc_ends(count) {
                let [x, y] = coordinates(to);
                let _ = write!(out, "A{r} {r} 0 0 {flag} {x} {y}");
            }
        }
        Curve::Spline(_) => {
            for piece in edge.beziers() {
                let [_, p, q, to] = piece.map(|point| coordinates(point).join(" "));
                let _ = write!(out, "C{p} {q} {to}");
            }
        }
    }
}

fn coordinates(point: Point) -> [String; 2] {
    [length(point[0]), length(-point[1])]
}
