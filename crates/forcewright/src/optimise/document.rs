//! What an optimisation found, as JSON: values in SI with their units named.

use forcewright_study::nlp::Stop;
use forcewright_study::optimise::{Active, Hold, Run};
use serde_json::{Map, Value, json};

use super::{Optimised, Robust, Robustness, pages};
use crate::tolerance::document::of_yield;

impl Optimised {
    /// The object `study` of the result document. Numbers that are not finite become `null`.
    pub fn document(&self) -> Value {
        let (name, unit, [before, after]) = self.goal();
        let best = self.best.as_ref();
        let variables = self.variables.iter().enumerate().map(|(i, v)| {
            let x = best.and_then(|b| b.x.get(i)).copied();
            json!({
                "path": v.path, "unit": v.unit, "before": v.nominal, "after": x, "lower": v.lower, "upper": v.upper,
                "at": x.and_then(|x| pages::end_of_range(v, x)),
            })
        });
        let basins = self.search.basins.iter().map(
            |b| json!({ "goal": self.search.runs.get(b.best).map(|r| self.wording.value(r.goal)), "best": b.best, "members": b.members }),
        );
        json!({
            "kind": "optimise",
            "title": self.title,
            "goal": {
                "name": name, "sense": if self.wording.large { "maximise" } else { "minimise" },
                "unit": unit.dimension().map_or("1", |d| d.si_symbol()), "before": before, "after": after,
            },
            "met": self.met(),
            "unseen": self.unseen,
            "search": self.search_document(),
            "variables": variables.collect::<Vec<_>>(),
            "stop": best.map(|b| word(b.stop)),
            "kkt_residual": best.map(|b| b.kkt_residual),
            "violation": best.map(|b| b.violation),
            "margin": self.reserve.margin,
            "tightened": self.tightened.iter().map(|(name, by, unit)| json!({ "name": name, "by": by, "unit": unit })).collect::<Vec<_>>(),
            "robust": self.robustness.as_ref().map(robust),
            "rounded": self.rounded.as_ref().map(|r| json!({
                "numbers": r.numbers.iter().map(|(path, before, after)| json!({ "path": path, "before": before, "after": after })).collect::<Vec<_>>(),
                "goal": r.goal.map(|goal| self.wording.value(goal)),
                "tried": r.tried,
                "met": r.met,
            })),
            "active": best.map_or_else(Vec::new, |b| pages::both_sides(b).iter().map(|a| self.active(b, a)).collect()),
            "interrupted": self.search.interrupted,
            "best": self.search.best,
            "runs": self.search.runs.iter().map(|r| self.run(r)).collect::<Vec<_>>(),
            "basins": basins.collect::<Vec<_>>(),
            "counters": {
                "starts": self.search.runs.len(),
                "iterations": self.search.runs.iter().map(|r| r.iterations).sum::<usize>(),
                "evaluations": self.search.evaluations(),
            },
        })
    }

    fn active(&self, best: &Run, active: &Active) -> Value {
        let now = self.wording.value(best.goal);
        json!({
            "kind": match active.hold {
                Hold::Limit => "limit",
                Hold::Range => "range",
                Hold::Size => "size",
            },
            "name": active.name, "key": active.key, "bound": active.bound, "unit": active.unit, "places": active.places,
            "one_percent": self.wording.value(best.goal - active.gain) - now,
        })
    }

    fn run(&self, run: &Run) -> Value {
        let at = |x: &[f64]| self.variables.iter().zip(x).map(|(v, x)| (v.path.clone(), json!(x))).collect::<Map<_, _>>();
        json!({
            "start": at(&run.start), "end": at(&run.x), "goal": self.wording.value(run.goal), "violation": run.violation,
            "kkt_residual": run.kkt_residual, "stop": word(run.stop), "iterations": run.iterations, "evaluations": run.evaluations,
        })
    }
}

/// What limits were kept against.
fn robust(found: &Robustness) -> Value {
    let (against, percentile) = match found.against {
        Robust::Percentile(part) => ("percentile", Some(part)),
        Robust::WorstCase => ("worst_case", None),
    };
    let [before, after] = [0, 1].map(|i| found.yields[i].as_ref().map(of_yield));
    json!({
        "against": against, "percentile": percentile, "numbers": found.scattering, "looks": found.rounds, "settled": found.settled,
        "yield_before": before, "yield_after": after,
    })
}

/// A way to end, for scripts.
pub(crate) fn word(stop: Stop) -> &'static str {
    match stop {
        Stop::Converged => "converged",
        Stop::Settled => "settled",
        Stop::Stalled => "stalled",
        Stop::StalledInfeasible => "stalled infeasible",
        Stop::Infeasible => "infeasible",
        Stop::IterationLimit => "iteration limit",
        Stop::Interrupted => "interrupted",
        Stop::StartRejected => "start rejected",
        Stop::Unbounded => "unbounded",
        Stop::Malformed => "malformed",
    }
}
