//! Figures of a calibration.

use forcewright_model::{Figure, FigureContent, HorizontalBand, HorizontalLine, Plot, Series, Stroke, VerticalSpan};

use super::Calibrated;

/// Most points of a line that is drawn.
const MOST_POINTS: usize = 400;

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
        let t = self.fit.quantile(self.confidence);
        let x = |order: &[usize]| -> Vec<f64> { order.iter().map(|i| self.points.x[*i]).collect() };
        let (mut areas, mut lines) = (Vec::new(), Vec::new());
        for (branch, order) in self.orders().iter().enumerate() {
            let wide = |i: &usize| {
                let error = self.fit.curve_error[*i];
                t * (self.fit.noise * self.fit.noise + error * error).sqrt()
            };
            let upper = order.iter().map(|i| (self.points.x[*i], self.fit.after[*i] + wide(i)));
            let lower = order.iter().rev().map(|i| (self.points.x[*i], self.fit.after[*i] - wide(i)));
            let (edge_x, edge_y) = upper.chain(lower).unzip();
            let share = format!("where {:.0} % of further points would lie", 100.0 * self.confidence.level());
            let share = if branch == 0 { share } else { String::new() };
            // Beside an optimum tangents say nothing of further points.
            if self.fit.ended {
                areas.push(Series { label: share, x: edge_x, y: edge_y, stroke: Stroke::Area });
            }
            let of = |values: &[f64]| order.iter().map(|i| values[*i]).collect::<Vec<f64>>();
            let (points, line) = if branch == 0 { (Stroke::Points, Stroke::Main) } else { (Stroke::OpenPoints, Stroke::Third) };
            for (what, values, stroke) in [
                ("measured", &self.points.raw, points),
                ("computed before", &self.fit.before, Stroke::Reference),
                ("computed with the estimates", &self.fit.after, line),
            ] {
                let label = match (stroke, branch) {
                    (Stroke::Reference, 0) => what.to_owned(),
                    (Stroke::Reference, _) => String::new(),
                    _ => self.label(what, branch),
                };
                lines.push(Series { label, x: x(order), y: of(values), stroke });
            }
        }
        areas.extend(lines);
        let caption = "Every measured point, the curve of the project file, and the curve with the estimates.";
        self.figure(("overlay", "Measured and computed", caption), areas, Vec::new(), Vec::new(), Vec::new())
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
