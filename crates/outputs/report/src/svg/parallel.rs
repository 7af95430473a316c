//! Designs as lines over parallel axes, one for each number: what goes with what.

use forcewright_base::units::format_si;

use super::canvas::{Anchor, Canvas, Drawing, Style, n};
use super::colour::Paint;
use super::legend::{self, Entry, Swatch, dashed};
use super::plot::PlotSize;
use super::text;
use super::ticks::{self, Ticks};
use crate::escape::escape;
use crate::study::{Parallel, ParallelAxis, ParallelLine, ParallelRank, ParallelScale};
use crate::words::with_minus;

const NAME: Style = Style { size: 13.0, bold: true, paint: Paint::Ink, halo: false };
const UNIT: Style = Style::muted(12.0);
const TICK: Style = Style { size: 12.0, bold: false, paint: Paint::Muted, halo: true };
const EDGE: f64 = 14.0;
/// Height of a line of text above the axes.
const ROW: f64 = 17.0;
/// Least distance of two axes: with more of them the picture grows.
const GAP: f64 = 92.0;
/// Most lines of a name.
const MOST_ROWS: usize = 3;
/// Radius of the region that a pointer or a finger meets, and of a point of the design of the file.
const REACH: f64 = 12.0;
const DOT: f64 = 4.5;
/// Ticks of an axis.
const TICKS: usize = 5;

/// An axis in the drawing.
struct Placed<'a> {
    own: &'a ParallelAxis,
    x: f64,
    ticks: Ticks,
}

/// Draws it: a group of links, as the cloud of points is.
pub(crate) fn draw(parallel: &Parallel, size: PlotSize) -> Drawing {
    let count = parallel.axes.len();
    let ticks: Vec<Ticks> = (0..count).map(|i| ticks_of(parallel, i)).collect();
    let widest = |t: &Ticks| t.labels.iter().map(|l| TICK.width(l)).fold(0.0, f64::max);
    let left = EDGE + ticks.first().map_or(0.0, widest).max(0.45 * GAP) + 8.0;
    let width = size.width.max(left + GAP * count as f64);
    let right = width - EDGE - 0.45 * GAP;
    let step = if count > 1 { (right - left) / (count - 1) as f64 } else { 0.0 };
    let room = if count > 1 { step } else { right - left } - 8.0;
    let heads: Vec<Vec<String>> = parallel.axes.iter().map(|axis| head(axis, room)).collect();
    let rows = heads.iter().map(Vec::len).max().unwrap_or(0);
    let (top, bottom) = (16.0 + ROW * rows as f64 + 12.0, 16.0 + ROW * rows as f64 + 12.0 + 0.8 * size.height);
    let placed: Vec<Placed<'_>> =
        parallel.axes.iter().zip(ticks).enumerate().map(|(i, (own, ticks))| Placed { own, x: left + step * i as f64, ticks }).collect();
    let mut canvas = Canvas::default();
    for (axis, head) in placed.iter().zip(&heads) {
        let last = head.len() - 1;
        for (i, line) in head.iter().enumerate() {
            let y = top - 12.0 - ROW * (last - i) as f64;
            let style = if i == last { UNIT } else { NAME };
            // Beside the outer axes there is less room than between two.
            let half = 0.5 * style.width(line);
            let x = axis.x.min(width - 2.0 - half).max(2.0 + half);
            canvas.text(line, [x, y], Anchor::Middle, style);
        }
    }
    // What matters most lies on top.
    for rank in [ParallelRank::Others, ParallelRank::Picked, ParallelRank::Present] {
        for line in parallel.lines.iter().filter(|l| l.rank == rank) {
            draw_line(&mut canvas, &placed, line, [top, bottom]);
        }
    }
    for axis in &placed {
        draw_axis(&mut canvas, axis, room, [top, bottom]);
    }
    let below = legend::draw(&mut canvas, &entries(parallel), EDGE, width - EDGE, bottom + 22.0);
    let drawing = canvas.finish(width, below + 6.0, &parallel.title, &description(parallel));
    Drawing { svg: drawing.svg.replacen("role=\"img\"", "role=\"group\"", 1), ..drawing }
}

/// Name and, in the last row, unit and sense of an axis.
fn head(axis: &ParallelAxis, room: f64) -> Vec<String> {
    // A path may break behind its dots and strokes.
    let spaced = axis.name.replace('.', ". ").replace('_', "_ ");
    let wrapped = text::wrap(&spaced, NAME.size * 1.13, room);
    let mut rows: Vec<String> = wrapped.iter().map(|row| NAME.fit(&row.replace(". ", ".").replace("_ ", "_"), room)).collect();
    if rows.len() > MOST_ROWS {
        // The end of a path says most.
        rows.drain(..rows.len() - MOST_ROWS);
        rows[0].insert(0, '…');
    }
    let unit = match &axis.scale {
        ParallelScale::Number(display) => display.pretty(),
        ParallelScale::Words(_) => String::new(),
    };
    let last = match (axis.sense.as_str(), unit.as_str()) {
        ("", unit) => unit.to_owned(),
        (sense, "") => sense.to_owned(),
        (sense, unit) => format!("{unit}, {sense}"),
    };
    rows.push(UNIT.fit(&last, room + 8.0));
    rows
}

/// What an axis must show, in its unit.
fn ticks_of(parallel: &Parallel, index: usize) -> Ticks {
    match parallel.axes.get(index).map(|axis| &axis.scale) {
        Some(ParallelScale::Number(unit)) => {
            let shown = parallel.lines.iter().filter_map(|l| l.values.get(index).copied().flatten()).filter_map(ticks::sane);
            let [low, high] = shown.map(|v| unit.from_si(v)).fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], v| [a.min(v), b.max(v)]);
            ticks::cover(low, high, TICKS)
        }
        Some(ParallelScale::Words(words)) => {
            let values = (0..words.len()).map(|i| i as f64).collect();
            Ticks { low: 0.0, high: (words.len().max(2) - 1) as f64, values, labels: words.clone() }
        }
        None => ticks::cover(0.0, 1.0, TICKS),
    }
}

impl Placed<'_> {
    /// The place of a value, SI or the number of a word.
    fn at(&self, value: f64, [top, bottom]: [f64; 2]) -> Option<[f64; 2]> {
        let shown = match &self.own.scale {
            ParallelScale::Number(unit) => ticks::sane(unit.from_si(ticks::sane(value)?))?,
            ParallelScale::Words(_) => value,
        };
        let part = (shown - self.ticks.low) / (self.ticks.high - self.ticks.low);
        Some([self.x, bottom - part.clamp(0.0, 1.0) * (bottom - top)])
    }
}

fn draw_line(canvas: &mut Canvas, axes: &[Placed<'_>], line: &ParallelLine, ends: [f64; 2]) {
    let places: Vec<Option<[f64; 2]>> = axes.iter().zip(&line.values).map(|(axis, v)| axis.at((*v)?, ends)).collect();
    let (paint, width, dash, opacity) = look(line.rank);
    if let Some(to) = &line.leads_to {
        canvas.raw(&format!("<a class=\"pick\" href=\"#{}\" aria-label=\"{}\">", escape(to), escape(&line.label)));
    } else {
        canvas.raw("<g>");
    }
    canvas.raw(&format!("<title>{}</title>", escape(&line.label)));
    // A value that an axis cannot show interrupts the line.
    for piece in places.split(Option::is_none).filter(|piece| !piece.is_empty()) {
        let points: Vec<[f64; 2]> = piece.iter().copied().flatten().collect();
        if line.leads_to.is_some() {
            canvas.polyline(&points, &format!(r#"fill="none" stroke="none" stroke-width="{}" pointer-events="stroke""#, n(REACH)));
        }
        let stroke = paint.attributes("stroke");
        let more = dashed(dash);
        canvas.polyline(
            &points,
            &format!(r#"fill="none" {stroke} stroke-width="{}" stroke-opacity="{opacity}" stroke-linejoin="round" {more}"#, n(width)),
        );
    }
    if line.rank == ParallelRank::Present {
        for at in places.iter().flatten() {
            canvas.circle(*at, DOT, &format!(r#"{} stroke-width="1.5""#, Paint::fill_and_stroke(paint, Paint::Paper)));
        }
    }
    canvas.raw(if line.leads_to.is_some() { "</a>" } else { "</g>" });
}

fn look(rank: ParallelRank) -> (Paint, f64, &'static str, f64) {
    match rank {
        ParallelRank::Others => (Paint::Reference, 1.0, "", 0.55),
        ParallelRank::Picked => (Paint::Main, 1.8, "", 0.85),
        ParallelRank::Present => (Paint::Second, 2.8, "7 4", 1.0),
    }
}

fn draw_axis(canvas: &mut Canvas, axis: &Placed<'_>, room: f64, [top, bottom]: [f64; 2]) {
    canvas.open_stroke(Paint::Ink, 1.3, "");
    canvas.segments(&[[[axis.x, top], [axis.x, bottom]]], "");
    let count = axis.ticks.values.len().max(2) - 1;
    let place = |i: usize| {
        let part = if axis.ticks.values.len() < 2 { 0.0 } else { i as f64 / count as f64 };
        bottom - part * (bottom - top)
    };
    let marks: Vec<[[f64; 2]; 2]> = (0..axis.ticks.labels.len()).map(|i| [[axis.x - 4.0, place(i)], [axis.x, place(i)]]).collect();
    canvas.segments(&marks, "");
    canvas.close();
    for (i, label) in axis.ticks.labels.iter().enumerate() {
        canvas.text(&TICK.fit(label, room.max(40.0)), [axis.x - 7.0, place(i) + 4.2], Anchor::End, TICK);
    }
}

fn entries(parallel: &Parallel) -> Vec<Entry> {
    let named = [
        (ParallelRank::Others, &parallel.names[0]),
        (ParallelRank::Picked, &parallel.names[1]),
        (ParallelRank::Present, &parallel.names[2]),
    ];
    let there = named.into_iter().filter(|(rank, _)| parallel.lines.iter().any(|l| l.rank == *rank));
    there
        .map(|(rank, name)| {
            let (paint, width, dash, _) = look(rank);
            Entry { swatch: Swatch::Line { paint, width, dash, squares: false }, text: name.clone() }
        })
        .collect()
}

/// The picture in words, for those who cannot see it.
fn description(parallel: &Parallel) -> String {
    let range = |(index, axis): (usize, &ParallelAxis)| match &axis.scale {
        ParallelScale::Words(words) => format!("{}: {}", axis.name, words.join(", ")),
        ParallelScale::Number(unit) => {
            let all = parallel.lines.iter().filter_map(|l| l.values.get(index).copied().flatten());
            let [low, high] = all.fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], v| [a.min(v), b.max(v)]);
            let show = |si: f64| with_minus(&format_si(si, unit, 4));
            format!("{} from {} to {}", axis.name, show(low), show(high))
        }
    };
    let axes: Vec<String> = parallel.axes.iter().enumerate().map(range).collect();
    format!("{} {} lines over {} axes: {}.", parallel.caption, parallel.lines.len(), parallel.axes.len(), axes.join("; "))
}
