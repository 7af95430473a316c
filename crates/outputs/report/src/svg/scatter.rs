//! A cloud of points of which each leads to a place of the page: pictures to choose from.

use forcewright_base::units::format_si;
use forcewright_model::{Axis, Plot, Series, Stroke};

use super::canvas::{Canvas, Drawing, n};
use super::colour::Paint;
use super::plot::{Frame, PlotSize, axes, frame_of, grid, grounds, head};
use crate::escape::escape;
use crate::study::{Scatter, ScatterPoint};
use crate::words::with_minus;

/// Radius of a point, and of the ring around one that stands out.
const POINT: f64 = 5.0;
const RING: f64 = 8.5;
/// Radius of the region that a pointer or a finger meets.
const REACH: f64 = 12.0;

/// Draws it. Unlike other drawings it is no picture to programs that read aloud, but a group of links.
pub(crate) fn draw(scatter: &Scatter, size: PlotSize) -> Drawing {
    // The frame that a line through all points would have.
    let (x, y) = scatter.points.iter().map(|p| (p.x, p.y)).unzip();
    let series = vec![Series { label: String::new(), x, y, stroke: Stroke::Main }];
    let (abscissa, ordinate) = (scatter.x.clone(), scatter.y.clone());
    let plot = Plot {
        x: abscissa,
        y: ordinate,
        series,
        bands: Vec::new(),
        levels: Vec::new(),
        spans: Vec::new(),
        markers: Vec::new(),
        from_zero: false,
    };
    let mut canvas = Canvas::default();
    let frame = frame_of(&plot, size);
    head(&mut canvas, &plot, size);
    grounds(&mut canvas, &frame, &[]);
    grid(&mut canvas, &frame);
    let bottom = axes(&mut canvas, &frame, size.width);
    // Points that stand out last, on top of the others.
    for outstanding in [false, true] {
        for point in scatter.points.iter().filter(|p| p.outstanding == outstanding) {
            draw_point(&mut canvas, &frame, point, &words(scatter, point));
        }
    }
    let drawing = canvas.finish(size.width, bottom + 6.0, &scatter.title, &description(scatter));
    // The children of a picture are not read; those of a group are.
    Drawing { svg: drawing.svg.replacen("role=\"img\"", "role=\"group\"", 1), ..drawing }
}

fn draw_point(canvas: &mut Canvas, frame: &Frame, point: &ScatterPoint, words: &str) {
    let Some(at) = frame.at(point.x, point.y) else { return };
    canvas.raw(&format!("<a class=\"pick\" href=\"#{}\" aria-label=\"{}\">", escape(&point.leads_to), escape(words)));
    canvas.raw(&format!("<title>{}</title>", escape(words)));
    canvas.raw(&format!("<circle cx=\"{}\" cy=\"{}\" r=\"{}\" fill-opacity=\"0\" />", n(at[0]), n(at[1]), n(REACH)));
    if point.outstanding {
        canvas.circle(at, RING, &format!(r#"fill="none" {} stroke-width="1.5""#, Paint::Main.attributes("stroke")));
    }
    canvas.circle(at, POINT, &format!(r#"{} stroke-width="1.5""#, Paint::fill_and_stroke(Paint::Main, Paint::Paper)));
    canvas.raw("</a>");
}

fn number(axis: &Axis, si: f64) -> String {
    with_minus(&format_si(si, &axis.display, 4))
}

fn words(scatter: &Scatter, point: &ScatterPoint) -> String {
    let [x, y] = [(&scatter.x, point.x), (&scatter.y, point.y)].map(|(axis, si)| format!("{} {}", axis.label, number(axis, si)));
    format!("{}: {x}, {y}", point.label)
}

/// The cloud in words, for those who cannot see it.
fn description(scatter: &Scatter) -> String {
    let range = |axis: &Axis, values: &dyn Fn(&ScatterPoint) -> f64| {
        let all = || scatter.points.iter().map(values);
        let (low, high) = (all().fold(f64::INFINITY, f64::min), all().fold(f64::NEG_INFINITY, f64::max));
        format!("{} from {} to {}", axis.label, number(axis, low), number(axis, high))
    };
    if scatter.points.is_empty() {
        return scatter.caption.clone();
    }
    let (x, y) = (range(&scatter.x, &|p| p.x), range(&scatter.y, &|p| p.y));
    format!("{} {} points: {x}; {y}. Each is a link to its row of the table.", scatter.caption, scatter.points.len())
}
