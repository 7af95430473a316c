//! The study as a document for scripts: SI values with their units named.

use forcewright_study::sampling::{Estimate, Fan, Interval, SobolIndices, Yield, YieldBasis};
use forcewright_study::tolerance::{Kept, MOST_SCALE};
use serde_json::{Value, json};

use super::Toleranced;

/// Version of the document's shape.
const SCHEMA: u32 = 1;
/// Quantiles that are told.
pub(super) const QUANTILES: [f64; 7] = [0.01, 0.05, 0.25, 0.5, 0.75, 0.95, 0.99];

impl Toleranced {
    /// The result document: yields, distributions of measures, fans, indices and needed tolerances. Numbers that do not exist are `null`.
    pub fn document(&self) -> Value {
        let (study, outcome) = (&self.study, &self.nominal.outcome);
        json!({
            "schema": SCHEMA,
            "forcewright": self.nominal.version,
            "mechanism": outcome.mechanism,
            "study": "tolerance",
            "title": outcome.title,
            "input_sha256": self.nominal.input_sha256,
            "status": { "kind": if study.interrupted { "interrupted" } else { "complete" } },
            "samples": study.all.samples,
            "seed": self.seed,
            "target": study.target,
            "target_met": study.target_met(),
            "yield": of_yield(&study.all),
            "requirements": self.kept(&study.kept),
            "failures": study.failures.iter().map(|f| json!({ "reason": f.text, "designs": f.count })).collect::<Vec<_>>(),
            "parameters": self.parameters(),
            "measures": self.measures(),
            "outputs": self.outputs(),
            "linear": study.linear.as_ref().map(|linear| json!({
                "yield": of_yield(&linear.all),
                "requirements": self.kept(&linear.kept),
                "agrees": !study.linear_is_off(),
            })),
            "tornado": self.tornado(),
            "indices": self.indices(),
            "warnings": self.diagnostics.warnings().iter().map(|w| json!({ "code": w.code, "message": w.message })).collect::<Vec<_>>(),
        })
    }

    fn name(&self, measure: usize) -> &str {
        self.study.measures.get(measure).map_or("", |m| &m.name)
    }

    fn path(&self, variable: usize) -> &str {
        self.study.variables.get(variable).map_or("", |v| &v.path)
    }

    fn kept(&self, kept: &[Kept]) -> Vec<Value> {
        let one = |k: &Kept| {
            let mut out = of_yield(&k.found);
            out["measure"] = self.name(k.measure).into();
            out
        };
        kept.iter().map(one).collect()
    }

    fn parameters(&self) -> Vec<Value> {
        let study = &self.study;
        let needed = |i: usize| study.linear.as_ref().and_then(|l| l.needed.iter().find(|n| n.variable == i)).cloned();
        let each = study.variables.iter().zip(self.population.marginals()).enumerate();
        each.map(|(i, (variable, marginal))| {
            let needed = needed(i);
            let scale = needed.as_ref().and_then(|n| n.scale);
            json!({
                "path": variable.path,
                "unit": variable.unit,
                "nominal": number(variable.nominal),
                "mean": number(marginal.mean()),
                "sd": number(marginal.sd()),
                "half_width": number(marginal.half_width()),
                "needed": needed.map(|_| json!({
                    "scale": scale,
                    "half_width": scale.map(|s| number(s * marginal.half_width())),
                    "at_least": scale.is_some_and(|s| s >= MOST_SCALE),
                })),
            })
        })
        .collect()
    }

    fn measures(&self) -> Vec<Value> {
        let study = &self.study;
        let finite = |v: f64| v.is_finite().then_some(v);
        let one = |(i, measure): (usize, &forcewright_study::evaluator::Measure)| {
            let mut out = station(&study.spread, i);
            out["name"] = measure.name.as_str().into();
            out["unit"] = measure.unit.into();
            out["nominal"] = study.nominal_measures.get(i).copied().flatten().map_or(Value::Null, number);
            out["lower"] = json!(finite(measure.lower));
            out["upper"] = json!(finite(measure.upper));
            out
        };
        study.measures.iter().enumerate().map(one).collect()
    }

    fn outputs(&self) -> Vec<Value> {
        let study = &self.study;
        let one = |(index, output): (usize, &forcewright_study::evaluator::Output)| {
            let all = || output.values.clone();
            let quantiles: Vec<Value> = QUANTILES
                .iter()
                .map(|p| json!({ "p": p, "values": all().map(|i| number(study.fan.quantile(i, *p))).collect::<Vec<_>>() }))
                .collect();
            json!({
                "name": output.name,
                "unit": output.unit,
                "stations": study.stations.get(index),
                "nominal": all().map(|i| study.nominal.get(i).copied()).collect::<Vec<_>>(),
                "mean": all().map(|i| number(study.fan.station(i).mean)).collect::<Vec<_>>(),
                "sd": all().map(|i| number(study.fan.station(i).sd)).collect::<Vec<_>>(),
                "quantiles": quantiles,
            })
        };
        study.outputs.iter().enumerate().map(one).collect()
    }

    fn tornado(&self) -> Vec<Value> {
        let study = &self.study;
        let one = |t: &forcewright_study::tolerance::Tornado| {
            let values: Vec<Value> =
                study.limiting.iter().zip(&t.values).map(|(m, ends)| json!({ "measure": self.name(*m), "values": ends })).collect();
            json!({ "path": self.path(t.variable), "ends": t.ends, "measures": values })
        };
        study.tornado.iter().map(one).collect()
    }

    fn indices(&self) -> Vec<Value> {
        let study = &self.study;
        let of_factors = |indices: &SobolIndices| -> Vec<Value> {
            let each = study.factors.iter().zip(indices.first.iter().zip(&indices.total));
            each.map(|(factor, (first, total))| {
                let paths: Vec<&str> = factor.iter().map(|i| self.path(*i)).collect();
                json!({ "paths": paths, "first": estimate(first), "total": estimate(total) })
            })
            .collect()
        };
        study.shares.iter().map(|s| json!({ "measure": self.name(s.measure), "factors": of_factors(&s.indices) })).collect()
    }
}

/// A number; a zero has no sign, and none is `null`.
fn number(value: f64) -> Value {
    (value + 0.0).into()
}

fn interval(interval: Interval) -> Value {
    json!([number(interval.low), number(interval.high)])
}

fn estimate(found: &Estimate) -> Value {
    json!({ "value": number(found.value), "interval": interval(found.interval) })
}

pub(crate) fn of_yield(found: &Yield) -> Value {
    let basis = match found.basis {
        YieldBasis::Replicates => "replicates",
        YieldBasis::Count => "count",
    };
    let mut out = estimate(&found.estimate);
    (out["good"], out["samples"], out["basis"]) = (found.good.into(), found.samples.into(), basis.into());
    out
}

/// The distribution of the values at a station.
fn station(fan: &Fan, index: usize) -> Value {
    let own = fan.station(index);
    let quantiles: Vec<Value> = QUANTILES.iter().map(|p| json!({ "p": p, "value": number(fan.quantile(index, *p)) })).collect();
    json!({
        "count": own.count,
        "missing": own.missing,
        "mean": number(own.mean),
        "sd": number(own.sd),
        "min": number(own.min),
        "max": number(own.max),
        "quantiles": quantiles,
    })
}
