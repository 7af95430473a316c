//! Figures of a calibration.

use forcewright_base::maths::hypot;
use forcewright_model::{Figure, FigureContent, HorizontalBand, HorizontalLine, Plot, Series, Stroke, VerticalSpan};

use forcewright_study::calibrate::{Branch, Curve, Model};
use forcewright_study::evaluator::Evaluation;
use serde_json::{Value, json};

use super::document::number;
use super::{Calibrated, Ready};

/// Most points of a line that is drawn.
const MOST_POINTS: usize = 400;
/// Places at which a computed curve is drawn: it may bend between measured points.
const PLACES: usize = 400;

/// The computed curve of a branch, as the bench shows it. SI.
#[derive(Default)]
pub(super) struct Line {
    /// Abscissae, ascending.
    x: Vec<f64>,
    /// With the numbers of the file.
    before: Vec<f64>,
    /// With the estimates.
    after: Vec<f64>,
}

impl Line {
    /// For scripts, SI; empty where a design has no curve.
    pub(super) fn document(&self) -> Value {
        let of = |values: &[f64]| values.iter().map(|v| number(*v)).collect::<Vec<_>>();
        json!({ "x": of(&self.x), "before": of(&self.before), "after": of(&self.after) })
    }
}

impl Ready {
    /// The curve of the file and that of the estimates over the range of the points; without points where a design has none.
    pub(super) fn lines(&self, values: &[f64]) -> Vec<Line> {
        self.computed(values).unwrap_or_else(|| self.points.branches.iter().map(|_| Line::default()).collect())
    }

    fn computed(&self, values: &[f64]) -> Option<Vec<Line>> {
        let places = |branch: &Branch| {
            let [low, high] = branch.x.iter().fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], x| [a.min(*x), b.max(*x)]);
            (0..PLACES).map(|i| low + (high - low) * i as f64 / (PLACES - 1) as f64).collect::<Vec<_>>()
        };
        let branches: Vec<Branch> = self.points.branches.iter().map(|b| Branch { output: b.output, x: places(b) }).collect();
        let free = self.wanted.bench.iter().map(|b| b.which).collect();
        let curve = Curve::new(&*self.evaluator, self.bench, free, branches.clone()).ok()?;
        let start: Vec<f64> = self.parameters().iter().map(|p| p.start).collect();
        let at = |values: &[f64]| {
            let mut out = Evaluation::default();
            curve.predict(values, false, &mut curve.room(), &mut out).ok().map(|()| out.values)
        };
        let (before, after) = (at(&start)?, at(values)?);
        let part = |all: &[f64], branch: usize| all.iter().skip(branch * PLACES).take(PLACES).copied().collect();
        let line = |(i, branch): (usize, Branch)| Line { x: branch.x, before: part(&before, i), after: part(&after, i) };
        Some(branches.into_iter().enumerate().map(line).collect())
    }
}

/// The value at `x` between points in the order of their abscissae.
fn between(points: &[[f64; 2]], x: f64) -> f64 {
    let next = points.partition_point(|p| p[0] < x);
    match (next.checked_sub(1).and_then(|i| points.get(i)), points.get(next)) {
        (Some([x0, y0]), Some([x1, y1])) => y0 + (y1 - y0) * (x - x0) / (x1 - x0),
        (Some([_, y]), None) | (None, Some([_, y])) => *y,
        (None, None) => f64::NAN,
    }
}

impl Calibrated {
    /// Points of each branch in the order of their abscissae.
    pub(super) fn sorted(&self) -> Vec<Vec<usize>> {
        let mut first = 0;
        let branches = self.points.branches.iter().map(|branch| {
            let mut own: Vec<usize> = (first..first + branch.x.len()).collect();
            first += branch.x.len();
            own.sort_by(|a, b| self.points.x[*a].total_cmp(&self.points.x[*b]));
            own
        });
        branches.collect()
    }

    /// The same, thinned out.
    fn orders(&self) -> Vec<Vec<usize>> {
        let branches = self.sorted().into_iter().map(|own| {
            let step = own.len().div_ceil(MOST_POINTS).max(1);
            let last = own.last().copied();
            let mut thin: Vec<usize> = own.into_iter().step_by(step).collect();
            if thin.last().copied() != last {
                thin.extend(last);
            }
            thin
        });
        branches.collect()
    }

    fn label(&self, what: &str, branch: usize) -> String {
        match self.points.names.get(branch) {
            Some(name) if self.points.names.len() > 1 => format!("{what}, {name}"),
            _ => what.to_owned(),
        }
    }

    /// Measured, before, after, and where points of another measurement would lie.
    pub(super) fn overlay(&self) -> Figure {
        let (mut areas, mut lines) = (Vec::new(), Vec::new());
        for (branch, (order, line)) in self.orders().iter().zip(&self.lines).enumerate() {
            // Beside an optimum tangents say nothing of further points.
            if self.fit.ended && !line.x.is_empty() {
                let share = format!("where {:.0} % of further points would lie", 100.0 * self.confidence.level());
                areas.push(self.area(order, line, if branch == 0 { share } else { String::new() }));
            }
            let (points, stroke) = if branch == 0 { (Stroke::Points, Stroke::Main) } else { (Stroke::OpenPoints, Stroke::Third) };
            let of = |values: &[f64]| order.iter().map(|i| values[*i]).collect::<Vec<f64>>();
            let before = if branch == 0 { "computed before".to_owned() } else { String::new() };
            lines.push(Series { label: self.label("measured", branch), x: of(&self.points.x), y: of(&self.points.raw), stroke: points });
            if line.x.is_empty() {
                continue;
            }
            lines.push(Series { label: before, x: line.x.clone(), y: line.before.clone(), stroke: Stroke::Reference });
            let after = self.label("computed with the estimates", branch);
            lines.push(Series { label: after, x: line.x.clone(), y: line.after.clone(), stroke });
        }
        areas.extend(lines);
        let caption = "Every measured point, the curve of the project file, and the curve with the estimates.";
        self.figure(("overlay", "Measured and computed", caption), areas, Vec::new(), Vec::new(), Vec::new())
    }

    /// Where further points of a branch would lie.
    fn area(&self, order: &[usize], line: &Line, label: String) -> Series {
        let t = self.fit.quantile(self.confidence);
        let errors: Vec<[f64; 2]> = order.iter().map(|i| [self.points.x[*i], self.fit.curve_error[*i]]).collect();
        let noise = self.fit.noise;
        let wide = |x: f64| t * hypot(noise, between(&errors, x));
        let middle = || line.x.iter().zip(&line.after);
        let upper = middle().map(|(x, y)| (*x, y + wide(*x)));
        let lower = middle().rev().map(|(x, y)| (*x, y - wide(*x)));
        let (x, y) = upper.chain(lower).unzip();
        Series { label, x, y, stroke: Stroke::Area }
    }

    /// Measured less computed, with the scatter and the stretch that is not explained.
    pub(super) fn residuals(&self) -> Figure {
        let orders = self.orders();
        let series = orders.iter().enumerate().map(|(branch, order)| Series {
            label: self.label("measured less computed", branch),
            x: order.iter().map(|i| self.points.x[*i]).collect(),
            y: order.iter().map(|i| self.fit.residuals.values[*i]).collect(),
            stroke: if branch == 0 { Stroke::Points } else { Stroke::OpenPoints },
        });
        // What is systematic is no part of the scatter.
        let scatter = if self.fit.residuals.unexplained { self.fit.residuals.scatter } else { self.fit.noise };
        let wide = self.fit.quantile(self.confidence) * scatter;
        let band = HorizontalBand {
            from: -wide,
            to: wide,
            extent: None,
            label: format!("{:.0} % of the points, if they only scattered", 100.0 * self.confidence.level()),
        };
        let stretch =
            self.fit.residuals.stretch.map(|s| VerticalSpan { from: s.from, to: s.to, label: "not explained".to_owned(), hatched: false });
        let zero = HorizontalLine { at: 0.0, label: "no difference".to_owned(), stroke: Stroke::Reference };
        let spans = stretch.into_iter().collect();
        let caption = "Measured less computed with the estimates. What is only scatter lies evenly on both sides of zero everywhere.";
        self.figure(("residuals", "What is left", caption), series.collect(), vec![band], vec![zero], spans)
    }

    fn figure(
        &self,
        (id, title, caption): (&'static str, &str, &str),
        series: Vec<Series>,
        bands: Vec<HorizontalBand>,
        levels: Vec<HorizontalLine>,
        spans: Vec<VerticalSpan>,
    ) -> Figure {
        let [x, y] = self.axes.clone();
        Figure {
            id,
            title: title.to_owned(),
            caption: caption.to_owned(),
            content: FigureContent::Plot(Plot { x, y, series, bands, levels, spans, markers: Vec::new(), from_zero: false }),
        }
    }
}
