//! Plots of lines over axes.

use forcewright_base::units::format_si;
use forcewright_model::{Axis, Plot, Series, Stroke};

use super::canvas::{Anchor, Canvas, Drawing, Style};
use super::colour::Paint;
use super::legend::{self, Entry, Swatch, dashed};
use super::place::{BESIDE, Placer, Rect, distance, from_edge};
use super::text;
use super::ticks::{self, Ticks};
use crate::words::{over_unit, with_minus};

/// Size of a plot in drawing units; about a CSS pixel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlotSize {
    /// Of the whole drawing.
    pub width: f64,
    /// Of the region between the axes; titles, labels and legend are added.
    pub height: f64,
}

impl Default for PlotSize {
    fn default() -> Self {
        Self { width: 760.0, height: 360.0 }
    }
}

impl PlotSize {
    fn sane(self) -> Self {
        let side = |v: f64, least: f64, usual: f64| if v.is_finite() { v.clamp(least, 4000.0) } else { usual };
        Self { width: side(self.width, 280.0, 760.0), height: side(self.height, 120.0, 360.0) }
    }
}

const TICK: Style = Style::muted(13.0);
const TITLE: Style = Style { size: 14.0, bold: true, paint: Paint::Ink, halo: false };
const SPAN: Style = Style::label(13.0, Paint::Span);
/// Radius of a marked point.
const MARKER: f64 = 4.5;
const SPAN_ROW: f64 = 20.0;
const EDGE: f64 = 14.0;

/// How a stroke is painted: colour, thickness, dashes, squares along it.
pub(super) fn look(stroke: Stroke) -> (Paint, f64, &'static str, bool) {
    match stroke {
        Stroke::Main => (Paint::Main, 2.6, "", false),
        Stroke::Second => (Paint::Second, 1.8, "", true),
        Stroke::Third => (Paint::Third, 2.2, "11 4 2.5 4", false),
        Stroke::Fourth => (Paint::Third, 2.2, "2.2 4", false),
        Stroke::Reference => (Paint::Reference, 1.8, "6 4", false),
        Stroke::Limit => (Paint::Limit, 2.0, "10 5", false),
        Stroke::Area => (Paint::Reference, 0.0, "", false),
        Stroke::Points => (Paint::Second, 0.0, "", false),
        Stroke::OpenPoints => (Paint::Third, 0.0, "", false),
    }
}

/// What stands for a series in the legend.
fn swatch(stroke: Stroke) -> Swatch {
    let (paint, width, dash, squares) = look(stroke);
    match stroke {
        Stroke::Area => Swatch::Area { paint },
        Stroke::Points => Swatch::Dots { paint, open: false },
        Stroke::OpenPoints => Swatch::Dots { paint, open: true },
        _ => Swatch::Line { paint, width, dash, squares },
    }
}

/// Where values lie in the drawing.
pub(super) struct Frame<'a> {
    plot: &'a Plot,
    area: Rect,
    x: Ticks,
    y: Ticks,
}

fn part(value: f64, ticks: &Ticks) -> f64 {
    // Halves first: the difference of two huge numbers stays finite.
    ((0.5 * value - 0.5 * ticks.low) / (0.5 * ticks.high - 0.5 * ticks.low)).clamp(0.0, 1.0)
}

impl Frame<'_> {
    fn at_x(&self, si: f64) -> Option<f64> {
        shown(&self.plot.x, si).map(|v| self.area.x0 + part(v, &self.x) * self.area.width())
    }

    fn at_y(&self, si: f64) -> Option<f64> {
        shown(&self.plot.y, si).map(|v| self.area.y1 - part(v, &self.y) * self.area.height())
    }

    pub(super) fn at(&self, x: f64, y: f64) -> Option<[f64; 2]> {
        Some([self.at_x(x)?, self.at_y(y)?])
    }

    /// Whether a level lies on the axis.
    fn holds(&self, si: f64) -> bool {
        shown(&self.plot.y, si).is_some_and(|v| v >= self.y.low && v <= self.y.high)
    }
}

/// A value in the unit shown, if it can be drawn.
fn shown(axis: &Axis, si: f64) -> Option<f64> {
    ticks::sane(si).and_then(|v| ticks::sane(axis.display.from_si(v)))
}

fn axis_title(axis: &Axis) -> String {
    over_unit(&axis.label, &axis.display)
}

/// The frame of a plot: its axes, and the area between them.
pub(super) fn frame_of(plot: &Plot, size: PlotSize) -> Frame<'_> {
    let size = size.sane();
    let (xs, ys) = ranges(plot);
    let x = ticks::cover(xs.0, xs.1, whole(size.width / 90.0));
    let y = ticks::cover(ys.0, ys.1, whole(size.height / 55.0));
    let widest = y.labels.iter().map(|l| TICK.width(l)).fold(0.0, f64::max);
    let half = |label: Option<&String>| 0.5 * label.map_or(0.0, |l| TICK.width(l));
    let left = EDGE + (widest + 10.0).max(half(x.labels.first()));
    let right = EDGE + half(x.labels.last());
    let spans = span_rows(plot, &x, left, size.width - right);
    let rows = spans.iter().map(|s| s.row + 1).max().unwrap_or(0);
    let top = 8.0 + y_title(plot, size).len() as f64 * 19.0 + 8.0 + rows as f64 * SPAN_ROW;
    Frame { plot, area: Rect::sized(left, top, size.width - left - right, size.height), x, y }
}

fn y_title(plot: &Plot, size: PlotSize) -> Vec<String> {
    text::wrap(&axis_title(&plot.y), TITLE.size * 1.13, size.width - 2.0 * EDGE)
}

/// The title of the ordinate, above everything.
pub(super) fn head(canvas: &mut Canvas, plot: &Plot, size: PlotSize) {
    for (i, line) in y_title(plot, size.sane()).iter().enumerate() {
        canvas.text(line, [EDGE, 22.0 + 19.0 * i as f64], Anchor::Start, TITLE);
    }
}

/// Draws a plot.
pub(super) fn draw(plot: &Plot, size: PlotSize, title: &str, caption: &str) -> Drawing {
    let size = size.sane();
    let frame = frame_of(plot, size);
    let left = frame.area.x0;
    let spans = span_rows(plot, &frame.x, left, frame.area.x1);
    let mut canvas = Canvas::default();
    head(&mut canvas, plot, size);
    grounds(&mut canvas, &frame, &spans);
    grid(&mut canvas, &frame);
    let mut placer = Placer::new(frame.area.grown(-3.0));
    lines(&mut canvas, &frame, &mut placer);
    let beyond = levels(&mut canvas, &frame, &mut placer);
    let below = axes(&mut canvas, &frame, size.width);
    markers(&mut canvas, &frame, &mut placer);
    let bottom = legend::draw(&mut canvas, &entries(plot, &beyond), left, size.width - EDGE, below);
    canvas.finish(size.width, bottom + 6.0, title, &description(plot, caption))
}

fn whole(value: f64) -> usize {
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped to 2…20")]
    let whole = value.clamp(2.0, 20.0) as usize;
    whole
}

/// Smallest and largest of some numbers.
fn extent(values: impl Iterator<Item = f64>) -> Option<(f64, f64)> {
    values.fold(None, |found, v| Some(found.map_or((v, v), |(low, high): (f64, f64)| (low.min(v), high.max(v)))))
}

/// What both axes must show, in the units shown.
fn ranges(plot: &Plot) -> ((f64, f64), (f64, f64)) {
    let x = |si: f64| shown(&plot.x, si);
    let y = |si: f64| shown(&plot.y, si);
    let pairs =
        || plot.series.iter().flat_map(|s| s.x.iter().zip(&s.y)).map(|(a, b)| (*a, *b)).chain(plot.markers.iter().map(|m| (m.x, m.y)));
    let xs = pairs()
        .filter(|(_, b)| y(*b).is_some())
        .filter_map(|(a, _)| x(a))
        .chain(plot.spans.iter().flat_map(|s| [s.from, s.to]).filter_map(x))
        .chain(plot.bands.iter().filter_map(|b| b.extent).flat_map(|(a, b)| [a, b]).filter_map(x));
    let ys = pairs()
        .filter(|(a, _)| x(*a).is_some())
        .filter_map(|(_, b)| y(b))
        .chain(plot.bands.iter().flat_map(|b| [b.from, b.to]).filter_map(y))
        .chain(plot.from_zero.then_some(0.0));
    let (low, high) = extent(ys).unwrap_or_else(|| extent(plot.levels.iter().filter_map(|l| y(l.at))).unwrap_or((0.0, 1.0)));
    // A level far beyond the data would flatten it: such a level is told below the plot.
    let reach = (0.5 * high - 0.5 * low).max(0.05 * high.abs().max(low.abs()));
    let near = plot.levels.iter().filter_map(|l| y(l.at)).filter(|v| 0.5 * v - 0.5 * high <= reach && 0.5 * low - 0.5 * v <= reach);
    let with_levels = extent(near.chain([low, high])).unwrap_or((low, high));
    // Room for the label of a level at the upper end.
    let room = 0.06 * (with_levels.1 - with_levels.0);
    let crowded = plot.levels.iter().filter_map(|l| y(l.at)).any(|v| v > high && v >= with_levels.1);
    let top = if crowded && room.is_finite() { with_levels.1 + room } else { with_levels.1 };
    (extent(xs).unwrap_or((0.0, 1.0)), (with_levels.0, top))
}

/// A vertical span with the place of its label.
pub(super) struct SpanLabel {
    x0: f64,
    x1: f64,
    text: String,
    text_rect: Rect,
    row: usize,
    hatched: bool,
}

fn span_rows(plot: &Plot, x: &Ticks, left: f64, right: f64) -> Vec<SpanLabel> {
    let mut out: Vec<SpanLabel> = Vec::new();
    for span in &plot.spans {
        let (Some(a), Some(b)) = (shown(&plot.x, span.from), shown(&plot.x, span.to)) else { continue };
        let at = |v: f64| left + part(v, x) * (right - left);
        let (x0, x1) = (at(a.min(b)), at(a.max(b)));
        let text = SPAN.fit(&span.label, right - left);
        let width = SPAN.width(&text);
        let start = (0.5 * (x0 + x1 - width)).clamp(left, (right - width).max(left));
        let text_rect = Rect::sized(start, 0.0, width, SPAN.height());
        // As many rows as spans are always enough.
        let row =
            (0..plot.spans.len()).find(|r| !out.iter().any(|o| o.row == *r && o.text_rect.overlaps(&text_rect.grown(6.0)))).unwrap_or(0);
        out.push(SpanLabel { x0, x1, text, text_rect, row, hatched: span.hatched });
    }
    out
}

/// What lies under the grid: bands and spans.
pub(super) fn grounds(canvas: &mut Canvas, frame: &Frame, spans: &[SpanLabel]) {
    let area = &frame.area;
    for s in spans {
        let r = Rect { x0: s.x0, y0: area.y0, x1: s.x1, y1: area.y1 };
        canvas.rect(&r, &format!(r#"{} fill-opacity="0.10""#, Paint::Span.attributes("fill")));
        if s.hatched {
            canvas.open_stroke(Paint::Span, 1.0, "");
            canvas.hatch(&r, 8.0, r#"stroke-opacity="0.5""#);
            canvas.close();
        }
        let y = area.y0 - 5.0 - s.row as f64 * SPAN_ROW;
        canvas.open_stroke(Paint::Span, 1.4, "");
        canvas.segments(&[[[s.x0, y], [s.x1, y]], [[s.x0, y - 4.0], [s.x0, area.y0]], [[s.x1, y - 4.0], [s.x1, area.y0]]], "");
        canvas.segments(&[[[s.x0, area.y0], [s.x0, area.y1]], [[s.x1, area.y0], [s.x1, area.y1]]], r#"stroke-dasharray="3 4""#);
        canvas.close();
    }
    for s in spans {
        canvas.text(&s.text, [s.text_rect.x0, area.y0 - 10.0 - s.row as f64 * SPAN_ROW], Anchor::Start, SPAN);
    }
    for band in &frame.plot.bands {
        let (Some(a), Some(b)) = (frame.at_y(band.from), frame.at_y(band.to)) else { continue };
        let (x0, x1) = match band.extent {
            None => (area.x0, area.x1),
            Some((from, to)) => (frame.at_x(from).unwrap_or(area.x0), frame.at_x(to).unwrap_or(area.x1)),
        };
        legend::band(canvas, &Rect { x0: x0.min(x1), y0: a.min(b), x1: x0.max(x1), y1: a.max(b) });
    }
}

pub(super) fn grid(canvas: &mut Canvas, frame: &Frame) {
    let area = &frame.area;
    let step = |count: usize, length: f64| length / (count.max(2) - 1) as f64;
    let mut lines = Vec::new();
    for i in 0..frame.x.values.len() {
        let x = area.x0 + i as f64 * step(frame.x.values.len(), area.width());
        lines.push([[x, area.y0], [x, area.y1]]);
    }
    for i in 0..frame.y.values.len() {
        let y = area.y1 - i as f64 * step(frame.y.values.len(), area.height());
        lines.push([[area.x0, y], [area.x1, y]]);
    }
    canvas.open_stroke(Paint::Grid, 1.0, "");
    canvas.segments(&lines, "");
    canvas.close();
}

/// Axis lines, tick labels and the title of the abscissa; returns the place below them.
pub(super) fn axes(canvas: &mut Canvas, frame: &Frame, width: f64) -> f64 {
    let area = &frame.area;
    canvas.open_stroke(Paint::Muted, 1.3, "");
    canvas.segments(&[[[area.x0, area.y0], [area.x0, area.y1]], [[area.x0, area.y1], [area.x1, area.y1]]], "");
    if frame.y.low < 0.0 && frame.y.high > 0.0 {
        let zero = area.y1 - part(0.0, &frame.y) * area.height();
        canvas.segments(&[[[area.x0, zero], [area.x1, zero]]], r#"stroke-width="1""#);
    }
    canvas.close();
    let (nx, ny) = (frame.x.labels.len(), frame.y.labels.len());
    let dx = area.width() / (nx.max(2) - 1) as f64;
    let widest = frame.x.labels.iter().map(|l| TICK.width(l)).fold(0.0, f64::max);
    let every = whole_above((widest + 8.0) / dx);
    for (i, label) in frame.x.labels.iter().enumerate().step_by(every) {
        canvas.text(label, [area.x0 + i as f64 * dx, area.y1 + 20.0], Anchor::Middle, TICK);
    }
    let dy = area.height() / (ny.max(2) - 1) as f64;
    let every = whole_above((TICK.height() + 3.0) / dy);
    for (i, label) in frame.y.labels.iter().enumerate().step_by(every) {
        canvas.text(label, [area.x0 - 8.0, area.y1 - i as f64 * dy + 4.5], Anchor::End, TICK);
    }
    let mut y = area.y1 + 43.0;
    for line in text::wrap(&axis_title(&frame.plot.x), TITLE.size * 1.13, width - 2.0 * EDGE) {
        let half = 0.5 * TITLE.width(&line);
        let middle = (0.5 * (area.x0 + area.x1)).clamp(EDGE + half, (width - EDGE - half).max(EDGE + half));
        canvas.text(&line, [middle, y], Anchor::Middle, TITLE);
        y += 19.0;
    }
    y - 4.0
}

fn whole_above(value: f64) -> usize {
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped to 1…100")]
    let whole = value.clamp(1.0, 100.0).ceil() as usize;
    whole
}

/// Connected pieces of a series in the drawing; points that are not numbers interrupt it.
fn pieces(frame: &Frame, series: &Series) -> Vec<Vec<[f64; 2]>> {
    let mut out: Vec<Vec<[f64; 2]>> = vec![Vec::new()];
    let count = series.x.len().min(series.y.len());
    for (i, (x, y)) in series.x.iter().zip(&series.y).enumerate() {
        match (frame.at(*x, *y), out.last_mut()) {
            (Some(p), Some(piece)) => {
                // Points closer than can be seen only make the file long.
                if i + 1 == count || piece.last().is_none_or(|last| distance(*last, p) > 0.4) {
                    piece.push(p);
                }
            }
            _ => out.push(Vec::new()),
        }
    }
    out.retain(|p| !p.is_empty());
    out
}

fn lines(canvas: &mut Canvas, frame: &Frame, placer: &mut Placer) {
    for series in &frame.plot.series {
        let (paint, width, dash, squares) = look(series.stroke);
        let pieces = pieces(frame, series);
        if series.stroke == Stroke::Area {
            for piece in &pieces {
                canvas.polygon(piece, &format!(r#"{} fill-opacity="{}""#, paint.attributes("fill"), legend::AREA));
            }
            continue;
        }
        if matches!(series.stroke, Stroke::Points | Stroke::OpenPoints) {
            canvas.open(&legend::dots(paint, series.stroke == Stroke::OpenPoints));
            for piece in &pieces {
                for p in piece {
                    canvas.circle(*p, legend::DOT, "");
                }
                placer.add_line(piece, 2.0 * legend::DOT, 1.0);
            }
            canvas.close();
            continue;
        }
        canvas.open_stroke(paint, width, &format!(r#"stroke-linejoin="round" {}"#, dashed(dash)));
        for piece in &pieces {
            canvas.polyline(piece, "");
            placer.add_line(piece, width, 1.0);
        }
        canvas.close();
        canvas.open(&paint.attributes("fill"));
        for piece in &pieces {
            if let [only] = piece.as_slice() {
                canvas.circle(*only, 3.0, "");
            } else if squares {
                for p in along(piece, 80.0) {
                    canvas.rect(&Rect::sized(p[0] - 3.0, p[1] - 3.0, 6.0, 6.0), "");
                }
            }
        }
        canvas.close();
    }
}

/// Points at equal distances along a line.
fn along(points: &[[f64; 2]], spacing: f64) -> Vec<[f64; 2]> {
    let mut out = Vec::new();
    let mut left = 0.5 * spacing;
    for w in points.windows(2) {
        let length = distance(w[0], w[1]);
        let mut at = left;
        while at < length && out.len() < 500 {
            let t = at / length;
            out.push([w[0][0] + t * (w[1][0] - w[0][0]), w[0][1] + t * (w[1][1] - w[0][1])]);
            at += spacing;
        }
        left = at - length;
    }
    out
}

/// Levels with their labels; returns what could not be said in the plot.
fn levels(canvas: &mut Canvas, frame: &Frame, placer: &mut Placer) -> Vec<Entry> {
    let area = frame.area;
    let mut beyond = Vec::new();
    let drawn: Vec<_> = frame.plot.levels.iter().filter_map(|l| Some((l, frame.at_y(l.at)?))).collect();
    for (level, y) in &drawn {
        if frame.holds(level.at) {
            placer.add_line(&[[area.x0, *y], [area.x1, *y]], 2.0, 1.0);
        }
    }
    for (level, y) in drawn {
        let (paint, width, dash, _) = look(level.stroke);
        let swatch = Swatch::Line { paint, width, dash, squares: false };
        if !frame.holds(level.at) {
            let text = format!("{} ({}, beyond the scale)", level.label, with_minus(&format_si(level.at, &frame.plot.y.display, 4)));
            beyond.push(Entry { swatch, text });
            continue;
        }
        canvas.open_stroke(paint, width, &dashed(dash));
        canvas.polyline(&[[area.x0, y], [area.x1, y]], "");
        canvas.close();
        let style = Style::label(13.0, paint);
        let text = style.fit(&level.label, area.width() - 12.0);
        match level_label(placer, &area, y, style.width(&text), style.height()) {
            Some(rect) => {
                placer.add_text(rect);
                canvas.text_in(&text, &rect, style);
            }
            None => beyond.push(Entry { swatch, text: level.label.clone() }),
        }
    }
    beyond
}

/// The place along a level, above or below it, where its label covers least.
fn level_label(placer: &Placer, area: &Rect, y: f64, width: f64, height: f64) -> Option<Rect> {
    let mut best: Option<(f64, Rect)> = None;
    for (side, top) in [y - height - 4.5, y + 4.5].into_iter().enumerate() {
        for i in 0..=10_u8 {
            let x = area.x1 - 6.0 - width - f64::from(i) / 10.0 * (area.width() - width - 12.0);
            let rect = Rect::sized(x, top, width, height);
            let cost = placer.covered(&rect) + 2.0 * f64::from(i) + 4.0 * side as f64;
            if placer.can_hold(&rect) && best.is_none_or(|(least, _)| cost < least) {
                best = Some((cost, rect));
            }
        }
    }
    best.map(|b| b.1)
}

fn markers(canvas: &mut Canvas, frame: &Frame, placer: &mut Placer) {
    let points: Vec<_> = frame.plot.markers.iter().filter_map(|m| Some((m, frame.at(m.x, m.y)?))).collect();
    for (_, p) in &points {
        placer.add_solid(Rect::sized(p[0] - 6.0, p[1] - 6.0, 12.0, 12.0));
    }
    let attributes = format!(r#"{} stroke-width="2""#, Paint::fill_and_stroke(Paint::Paper, Paint::Ink));
    for (_, p) in &points {
        canvas.circle(*p, MARKER, &attributes);
    }
    let style = Style::label(14.0, Paint::Ink);
    for (marker, p) in points {
        let text = style.fit(&marker.label, 0.6 * frame.area.width());
        if text.is_empty() {
            continue;
        }
        if let Some(placed) = placer.place(p, style.width(&text), style.height(), BESIDE) {
            if let Some(leader) = placed.leader.and_then(|l| from_edge(l, MARKER + 1.0)) {
                canvas.segments(&[leader], &format!(r#"fill="none" {} stroke-width="1""#, Paint::Ink.attributes("stroke")));
            }
            canvas.text_in(&text, &placed.rect, style);
        }
    }
}

fn entries(plot: &Plot, beyond: &[Entry]) -> Vec<Entry> {
    let mut out = Vec::new();
    for series in plot.series.iter().filter(|s| !s.label.is_empty()) {
        out.push(Entry { swatch: swatch(series.stroke), text: series.label.clone() });
    }
    out.extend(plot.bands.iter().map(|b| Entry { swatch: Swatch::Band, text: b.label.clone() }));
    out.extend(beyond.iter().cloned());
    out.extend(plot.markers.iter().filter(|m| !m.note.is_empty()).map(|m| Entry { swatch: Swatch::Point, text: m.note.clone() }));
    out
}

/// The plot in words, for those who cannot see it.
fn description(plot: &Plot, caption: &str) -> String {
    let number = |axis: &Axis, si: f64| {
        if axis.display.from_si(si).is_finite() { with_minus(&format_si(si, &axis.display, 4)) } else { "unknown".to_owned() }
    };
    let mut out = String::from(caption);
    let mut say = |text: String| {
        if !out.is_empty() {
            out.push(' ');
        }
        out.push_str(&text);
    };
    say(format!("Ordinate: {}. Abscissa: {}.", axis_title(&plot.y), axis_title(&plot.x)));
    for s in plot.series.iter().filter(|s| s.stroke != Stroke::Area) {
        if let Some((low, high)) = extent(s.y.iter().copied().filter(|v| v.is_finite())) {
            say(format!("{}: from {} to {}.", s.label, number(&plot.y, low), number(&plot.y, high)));
        }
    }
    for b in &plot.bands {
        say(format!("{}: {} to {}.", b.label, number(&plot.y, b.from), number(&plot.y, b.to)));
    }
    for l in &plot.levels {
        say(format!("{}: {}.", l.label, number(&plot.y, l.at)));
    }
    for s in &plot.spans {
        say(format!("{}: {} to {}.", s.label, number(&plot.x, s.from), number(&plot.x, s.to)));
    }
    for m in plot.markers.iter().filter(|m| !m.note.is_empty()) {
        say(format!("{}.", m.note.trim_end_matches('.')));
    }
    out
}
