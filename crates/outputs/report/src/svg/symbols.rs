//! Symbols of mechanisms: supports, arrows, marked points.

use forcewright_base::maths;
use forcewright_model::SupportKind;

use super::canvas::Canvas;
use super::colour::Paint;
use super::place::Rect;

/// A frame in the drawing: origin, `along` the ground and `out` of the mechanism; unit vectors, y downwards.
#[derive(Clone, Copy, Debug)]
struct Local {
    at: [f64; 2],
    along: [f64; 2],
    out: [f64; 2],
}

impl Local {
    fn point(&self, along: f64, out: f64) -> [f64; 2] {
        [0, 1].map(|i| self.at[i] + along * self.along[i] + out * self.out[i])
    }
}

/// A unit vector of the drawing from one of the model (y upwards); `usual` if it has no direction.
fn unit(v: [f64; 2], usual: [f64; 2]) -> [f64; 2] {
    let length = maths::hypot(v[0], v[1]);
    if length.is_finite() && length > 1e-12 { [v[0] / length, -v[1] / length] } else { usual }
}

/// Draws a support; `size` is the half-length of its ground line. Returns the box that it covers.
pub(super) fn support(canvas: &mut Canvas, at: [f64; 2], kind: SupportKind, outward: [f64; 2], size: f64) -> Rect {
    if kind == SupportKind::Parallel {
        return parallel_guide(canvas, at, size);
    }
    let out = unit(outward, [0.0, 1.0]);
    let mut local = Local { at, along: [-out[1], out[0]], out };
    if let SupportKind::Slider { direction, .. } = kind {
        let along = unit(direction, local.along);
        // The ground lies on the side of `outward`, across the direction of motion.
        let across = [-along[1], along[0]];
        let side = if across[0] * out[0] + across[1] * out[1] < 0.0 { -1.0 } else { 1.0 };
        local = Local { at, along, out: across.map(|c| side * c) };
    }
    canvas.open(&format!(r#"{} stroke-width="1.6" stroke-linejoin="round""#, Paint::fill_and_stroke(Paint::Paper, Paint::Ink)));
    let ground = match kind {
        SupportKind::Clamped | SupportKind::Parallel => 0.0,
        SupportKind::Pinned => {
            triangle(canvas, &local, size, 1.15 * size);
            1.15 * size
        }
        SupportKind::Slider { rotates, .. } => {
            let radius = 0.2 * size;
            let foot = if rotates {
                triangle(canvas, &local, 0.8 * size, 0.9 * size);
                0.9 * size
            } else {
                let block = [[-0.8, -0.22], [0.8, -0.22], [0.8, 0.22], [-0.8, 0.22]].map(|[a, o]| local.point(a * size, o * size));
                canvas.polygon(&block, "");
                0.22 * size
            };
            for along in [-0.45, 0.45] {
                canvas.circle(local.point(along * size, foot + radius), radius, "");
            }
            foot + 2.0 * radius
        }
    };
    ground_line(canvas, &local, size * if matches!(kind, SupportKind::Slider { .. }) { 1.35 } else { 1.0 }, ground);
    if matches!(kind, SupportKind::Pinned | SupportKind::Slider { rotates: true, .. }) {
        canvas.circle(at, 0.2 * size, "");
    }
    canvas.close();
    let reach = 1.35 * size;
    let corners = [(-reach, -0.3 * size), (reach, -0.3 * size), (reach, ground + 0.5 * size), (-reach, ground + 0.5 * size)];
    around(&corners.map(|(a, o)| local.point(a, o)))
}

/// A block that goes anywhere without turning: arrows in both directions on a square.
fn parallel_guide(canvas: &mut Canvas, at: [f64; 2], size: f64) -> Rect {
    let local = Local { at, along: [1.0, 0.0], out: [0.0, 1.0] };
    let corners = [[-0.9, -0.9], [0.9, -0.9], [0.9, 0.9], [-0.9, 0.9]].map(|[a, o]| local.point(a * size, o * size));
    canvas.open(&format!(r#"{} stroke-width="1.6" stroke-linejoin="round""#, Paint::fill_and_stroke(Paint::Paper, Paint::Ink)));
    canvas.polygon(&corners, "");
    let mut strokes = Vec::new();
    for [x, y] in [[1.0, 0.0], [-1.0, 0.0], [0.0, 1.0], [0.0, -1.0]] {
        let tip = local.point(0.7 * size * x, 0.7 * size * y);
        strokes.push([at, tip]);
        for side in [-1.0, 1.0] {
            // A head of two strokes.
            let back = [tip[0] - 0.22 * size * (x + side * y), tip[1] - 0.22 * size * (y - side * x)];
            strokes.push([tip, back]);
        }
    }
    canvas.segments(&strokes, r#"stroke-width="1.2""#);
    canvas.close();
    around(&corners)
}

fn triangle(canvas: &mut Canvas, local: &Local, half: f64, height: f64) {
    canvas.polygon(&[local.point(0.0, 0.0), local.point(0.7 * half, height), local.point(-0.7 * half, height)], "");
}

/// The ground: a line with hatching behind it.
fn ground_line(canvas: &mut Canvas, local: &Local, half: f64, out: f64) {
    let depth = 0.42 * half.min(18.0);
    let hatches: Vec<_> = (0..=5_u8)
        .map(|i| -half + f64::from(i) / 5.0 * 2.0 * half)
        .map(|a| [local.point(a, out), local.point(a - depth, out + depth)])
        .collect();
    canvas.segments(&hatches, r#"stroke-width="1.1""#);
    canvas.segments(&[[local.point(-half, out), local.point(half, out)]], r#"stroke-width="2.4""#);
}

/// The box around some points.
pub(super) fn around(points: &[[f64; 2]]) -> Rect {
    let nothing = Rect { x0: f64::INFINITY, y0: f64::INFINITY, x1: f64::NEG_INFINITY, y1: f64::NEG_INFINITY };
    points.iter().fold(nothing, |r, p| Rect { x0: r.x0.min(p[0]), y0: r.y0.min(p[1]), x1: r.x1.max(p[0]), y1: r.y1.max(p[1]) })
}

/// Draws an arrow with a filled head.
pub(super) fn arrow(canvas: &mut Canvas, from: [f64; 2], to: [f64; 2]) {
    let d = [to[0] - from[0], to[1] - from[1]];
    let length = maths::hypot(d[0], d[1]);
    if length < 0.5 {
        return;
    }
    let along = d.map(|c| c / length);
    let head = 13.0_f64.min(length);
    let local = Local { at: to, along: [-along[1], along[0]], out: along };
    canvas.open(&format!(r#"{} stroke-linejoin="round""#, Paint::fill_and_stroke(Paint::Ink, Paint::Ink)));
    canvas.segments(&[[from, local.point(0.0, -0.8 * head)]], r#"stroke-width="2.6""#);
    canvas.polygon(&[to, local.point(0.42 * head, -head), local.point(-0.42 * head, -head)], r#"stroke-width="0.5""#);
    canvas.close();
}

/// Draws a hinge: a pin in its eye.
pub(super) fn hinge(canvas: &mut Canvas, at: [f64; 2], size: f64) {
    canvas.circle(at, 0.34 * size, &format!(r#"{} stroke-width="1.8""#, Paint::fill_and_stroke(Paint::Paper, Paint::Ink)));
    canvas.circle(at, 0.1 * size, &Paint::Ink.attributes("fill"));
}

/// Radius of a marked point, to the middle of its line.
pub(super) const RING: f64 = 8.0;

/// Draws a marked point: a ring with a halo.
pub(super) fn ring(canvas: &mut Canvas, at: [f64; 2]) {
    canvas.circle(at, RING, &format!(r#"fill="none" {} stroke-width="4.5""#, Paint::Paper.attributes("stroke")));
    canvas.circle(at, RING, &format!(r#"fill="none" {} stroke-width="2.2""#, Paint::Limit.attributes("stroke")));
}
