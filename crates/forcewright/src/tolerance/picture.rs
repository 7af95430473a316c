//! Figures of a tolerance study.

use forcewright_base::units::{Dimension, format_si};
use forcewright_model::{Axis, BarRow, Bars, Figure, FigureContent, HorizontalBand, Plot, Series, Stroke};

use super::Toleranced;

/// Identifiers of the figures: as many tornados as are drawn.
const TORNADOS: [&str; 4] = ["tornado-1", "tornado-2", "tornado-3", "tornado-4"];
/// Bars of a tornado.
const BARS: usize = 10;

impl Toleranced {
    /// The fan of an output over its stations: median, nominal design, half and nine tenths of all designs.
    pub(super) fn fan(&self, index: usize) -> Option<Figure> {
        let (study, output) = (&self.study, self.study.outputs.get(index)?);
        let curve = self.nominal.outcome.curves.iter().find(|c| c.name == output.name)?;
        let x = study.stations.get(index).filter(|x| x.len() == output.values.len())?;
        let at = |p: f64| -> Vec<f64> { output.values.clone().map(|i| study.fan.quantile(i, p)).collect() };
        let series = |label: &str, y: Vec<f64>, stroke| Series { label: label.to_owned(), x: x.clone(), y, stroke };
        let mut all: Vec<Series> = [(0.05, "5 %"), (0.95, "95 %")].map(|(p, label)| series(label, at(p), Stroke::Reference)).into();
        all.extend([(0.25, "25 %"), (0.75, "75 %")].map(|(p, label)| series(label, at(p), Stroke::Third)));
        all.push(series("nominal", output.values.clone().filter_map(|i| study.nominal.get(i).copied()).collect(), Stroke::Second));
        all.push(series("median", at(0.5), Stroke::Main));
        let plot = Plot {
            x: curve.x.clone(),
            y: curve.y.clone(),
            series: all,
            bands: self.required_bands(curve.name),
            levels: Vec::new(),
            spans: Vec::new(),
            markers: Vec::new(),
            from_zero: false,
        };
        Some(Figure {
            id: curve.name,
            title: format!("{} of {} designs", curve.y.label, study.all.samples),
            caption: "Quantiles at each place by itself, which no single design need follow; the nominal design beside them.".to_owned(),
            content: FigureContent::Plot(plot),
        })
    }

    /// The bands that the report of the nominal design draws into the same figure.
    fn required_bands(&self, id: &str) -> Vec<HorizontalBand> {
        let plot = self.nominal.figures.iter().find(|f| f.id == id).and_then(|f| match &f.content {
            FigureContent::Plot(plot) => Some(plot.bands.clone()),
            _ => None,
        });
        plot.unwrap_or_default()
    }

    /// Bars from the nominal value of a limiting measure to those with one parameter at the ends of its tolerance, longest at the top.
    pub(super) fn tornado_figure(&self, place: usize) -> Option<Figure> {
        let study = &self.study;
        let (id, measure) = (*TORNADOS.get(place)?, *study.limiting.get(place)?);
        let name = &study.measures.get(measure)?.name;
        let nominal = study.nominal_measures.get(measure).copied().flatten()?;
        let mut bars: Vec<_> = study.tornado.iter().filter(|t| t.reach(place, Some(nominal)).is_finite()).collect();
        bars.sort_by(|a, b| b.reach(place, Some(nominal)).total_cmp(&a.reach(place, Some(nominal))));
        bars.retain(|t| t.reach(place, Some(nominal)) > 0.0);
        bars.truncate(BARS);
        if bars.is_empty() {
            return None;
        }
        let rows = bars.iter().filter_map(|bar| {
            let variable = study.variables.get(bar.variable)?;
            let unit = self.units.get(bar.variable)?;
            let [low, high] = bar.ends.map(|end| format_si(end, unit, 4));
            let to = |side: usize| bar.values.get(place).and_then(|v| v[side]).map_or(f64::NAN, |value| value - nominal);
            Some(BarRow { label: format!("{}, {low} … {high}", variable.path), ends: vec![[to(0), to(1)]] })
        });
        let unit = self.unit_of(measure);
        let dimension = unit.dimension().unwrap_or(Dimension::Ratio);
        let at = format_si(nominal, &unit, 4);
        let axis = Axis { name: "measure", label: format!("Change of {name} from {at}"), dimension, display: unit };
        let series = vec![("lower end of the tolerance outlined, upper end filled".to_owned(), Stroke::Main)];
        let rows: Vec<BarRow> = rows.collect();
        Some(Figure {
            id,
            title: format!("What each parameter does to {name}"),
            caption: "What one parameter at the ends of its tolerance changes, all others nominal; the longest bar at the top.".to_owned(),
            content: FigureContent::Bars(Bars { axis, series, rows }),
        })
    }
}
