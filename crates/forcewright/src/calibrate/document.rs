//! The calibration as a document for scripts: SI values with their units named.

use forcewright_study::calibrate::{Against, Bound, SignTest, Stop};
use serde_json::{Value, json};

use super::Calibrated;
use super::wording::HARDLY;

/// Version of the document's shape.
const SCHEMA: u32 = 1;

impl Calibrated {
    /// The result document: parameters with intervals, what is determined, what is left. Numbers that do not exist are `null`.
    pub fn document(&self) -> Value {
        let (fit, outcome) = (&self.fit, &self.before.outcome);
        let kind = match &fit.stop {
            Stop::Converged => "complete",
            Stop::Interrupted => "interrupted",
            Stop::Stalled | Stop::RoundLimit | Stop::NoStart(_) => "not converged",
        };
        json!({
            "schema": SCHEMA,
            "forcewright": self.before.version,
            "mechanism": outcome.mechanism,
            "study": "calibrate",
            "title": outcome.title,
            "input_sha256": self.before.input_sha256,
            "status": { "kind": kind, "intervals_unknown": self.unknown() },
            "sound": self.sound(),
            "measurement": self.measurement,
            "points": self.points.x.len(),
            "left_out": self.points.left_out,
            "beyond": self.beyond,
            "copied_rows": self.copied_rows,
            "far": self.fit.residuals.far.iter().map(|i| json!({
                "x": number(self.points.x[*i]),
                "residual": number(self.fit.residuals.values[*i]),
            })).collect::<Vec<_>>(),
            "hardly_counting": self.fit.weights.iter().filter(|w| **w < HARDLY).count(),
            "confidence": self.confidence.level(),
            "noise": { "value": number(fit.noise), "unit": self.axes[1].dimension.si_symbol() },
            "degrees_of_freedom": number(fit.degrees),
            "parameters": self.parameters(),
            "variant": self.variant,
            "covariance": self.covariance(),
            "correlations": fit.correlations.chunks(fit.parameters.len().max(1)).map(<[f64]>::to_vec).collect::<Vec<_>>(),
            "not_determined": fit.identified.loose.iter().map(|loose| json!({
                "deviation": number(loose.deviation),
                "changes": loose.changes.iter().map(|(i, change)| json!({ "path": self.path(*i), "change": number(*change) })).collect::<Vec<_>>(),
            })).collect::<Vec<_>>(),
            "residuals": self.left(),
            "curve": self.curve(),
            "warnings": self.diagnostics.warnings().iter().map(|w| json!({ "code": w.code, "message": w.message })).collect::<Vec<_>>(),
        })
    }

    fn path(&self, parameter: usize) -> &str {
        self.fit.parameters.get(parameter).map_or("", |p| &p.parameter.name)
    }

    fn parameters(&self) -> Vec<Value> {
        let pair = |low: f64, high: f64| json!({ "low": number(low), "high": number(high) });
        let each = self.fit.parameters.iter().zip(self.units.iter().zip(&self.unit_sizes));
        each.map(|(found, (unit, size))| {
            json!({
                "path": found.parameter.name,
                "display_unit": unit,
                "display_size": size,
                "before": number(found.parameter.start),
                "value": number(found.estimate.value),
                "error": number(found.error),
                "interval": pair(found.estimate.interval.low, found.estimate.interval.high),
                "likelihood": found.profile.map(|p| pair(p.low, p.high)),
                "prior": found.parameter.prior.map(|p| json!({ "mean": p.mean, "sd": p.sd })),
                "at_bound": found.at.map(|b| if b == Bound::Lower { "lower" } else { "upper" }),
            })
        })
        .collect()
    }

    /// Row by row, SI; `null` where nothing is known.
    fn covariance(&self) -> Vec<Vec<Value>> {
        let errors: Vec<f64> = self.fit.parameters.iter().map(|p| p.error).collect();
        let row = |(i, row): (usize, &[f64])| row.iter().zip(&errors).map(|(r, error)| number(r * error * errors[i])).collect();
        self.fit.correlations.chunks(errors.len().max(1)).enumerate().map(row).collect()
    }

    fn left(&self) -> Value {
        let residuals = &self.fit.residuals;
        json!({
            "unexplained": residuals.unexplained,
            "alternates": residuals.alternates,
            "judged": residuals.judged,
            "places": residuals.places,
            "systematic": number(residuals.systematic),
            "scatter": number(residuals.scatter),
            "autocorrelation": number(residuals.autocorrelation),
            "runs": {
                "test": if residuals.runs.test == SignTest::Runs { "runs" } else { "side" },
                "observed": residuals.runs.observed,
                "expected": number(residuals.runs.expected),
                "above": residuals.runs.sides[0],
                "below": residuals.runs.sides[1],
                "p": number(residuals.runs.p),
                "p_many": number(residuals.runs.p_many),
            },
            "lack_of_fit": residuals.lack.map(|l| json!({
                "against": if l.against == Against::Repeats { "repeats" } else { "smooth" },
                "ratio": number(l.ratio),
                "degrees": l.degrees,
                "p": number(l.p),
                "p_small": number(l.p_small),
            })),
            "stretch": residuals.stretch.map(|s| json!({
                "branch": self.points.names.get(s.branch),
                "from": number(s.from),
                "to": number(s.to),
                "mean": number(s.mean),
                "points": s.points,
            })),
        })
    }

    fn curve(&self) -> Value {
        let [x, y] = &self.axes;
        let mut first = 0;
        let each = self.points.branches.iter().zip(&self.points.names).zip(&self.lines);
        let branches = each.map(|((branch, name), line)| {
            let own = first..first + branch.x.len();
            first = own.end;
            let of = |values: &[f64]| values[own.clone()].iter().map(|v| number(*v)).collect::<Vec<_>>();
            json!({
                "name": name,
                "x": of(&self.points.x),
                "weights": of(&self.fit.weights),
                "measured": of(&self.points.raw),
                "before": of(&self.fit.before),
                "after": of(&self.fit.after),
                // As it is drawn, between the points too.
                "drawn": line.document(),
            })
        });
        json!({
            "x": { "name": x.name, "unit": x.dimension.si_symbol() },
            "y": { "name": y.name, "unit": y.dimension.si_symbol() },
            "branches": branches.collect::<Vec<_>>(),
        })
    }
}

/// A number, or `null` where there is none.
pub(super) fn number(value: f64) -> Value {
    if value.is_finite() { json!(value) } else { Value::Null }
}
