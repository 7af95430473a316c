//! Which measured points count, and which output of the evaluator describes each.

use forcewright_base::units::format_si;
use forcewright_contract::calibration::{Direction, Record};
use forcewright_model::Axis;
use forcewright_study::calibrate::{Bench, Branch};
use forcewright_study::evaluator::Evaluator;

/// A place this far beyond an end of a curve, over its length, is that end.
const AT_THE_END: f64 = 1e-9;

/// Measured points, branch by branch, SI.
#[derive(Clone, Debug)]
pub struct Points {
    /// Outputs with their places.
    pub branches: Vec<Branch>,
    /// Name of each branch for people.
    pub names: Vec<&'static str>,
    /// Abscissae of all, in the order of the branches.
    pub x: Vec<f64>,
    /// Ordinates, filtered.
    pub y: Vec<f64>,
    /// Ordinates as measured.
    pub raw: Vec<f64>,
    /// Points of the record that do not count.
    pub left_out: usize,
    /// Where the design's curve is computed, SI.
    pub computed: [f64; 2],
}

impl Points {
    /// The points of a record that lie on the branch asked for, where the curve is computed. Where the family tells loading from unloading
    /// (outputs `…_up` and `…_down`), each is compared with its own; else one curve is compared with both.
    pub(super) fn of(record: &Record, evaluator: &dyn Evaluator, bench: &Bench, branch: &str) -> Self {
        let outputs = evaluator.outputs();
        let two = match outputs {
            [up, down, ..] => {
                let base = up.name.strip_suffix("_up");
                base.is_some() && base == down.name.strip_suffix("_down") && up.unit == down.unit
            }
            _ => false,
        };
        let stations = evaluator.stations(0);
        let computed = stations.iter().fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], s| [a.min(*s), b.max(*s)]);
        let inside = |i: &usize| within(computed, place(bench, record.x[*i], record.raw[*i]));
        let ways = [(Direction::Loading, "loading", 0), (Direction::Unloading, "unloading", usize::from(two))];
        let mut found =
            Self { branches: Vec::new(), names: Vec::new(), x: Vec::new(), y: Vec::new(), raw: Vec::new(), left_out: 0, computed };
        for (direction, name, output) in ways.into_iter().filter(|(_, name, _)| branch == "both" || branch == *name) {
            let own: Vec<usize> = (0..record.x.len()).filter(|i| record.directions[*i] == direction).filter(inside).collect();
            if own.is_empty() {
                continue;
            }
            let take = |from: &[f64]| own.iter().map(|i| from[*i]).collect::<Vec<f64>>();
            let x = take(&record.x);
            found.x.extend(&x);
            found.y.extend(take(&record.y));
            found.raw.extend(take(&record.raw));
            found.branches.push(Branch { output, x });
            found.names.push(name);
        }
        found.left_out = record.x.len() - found.x.len();
        found
    }

    /// How many of the points lie beyond the ends of the curve on a bench.
    pub(super) fn beyond(&self, bench: &Bench) -> usize {
        self.x.iter().zip(&self.raw).filter(|(x, raw)| !within(self.computed, place(bench, **x, **raw))).count()
    }

    /// How many of the points repeat another one of their branch exactly.
    pub(super) fn copies(&self) -> usize {
        let mut first = 0;
        let of_branch = |branch: &Branch| {
            let own = first..first + branch.x.len();
            first = own.end;
            let mut each: Vec<[u64; 2]> = own.map(|i| [self.x[i].to_bits(), self.raw[i].to_bits()]).collect();
            each.sort_unstable();
            each.dedup();
            branch.x.len() - each.len()
        };
        self.branches.iter().map(of_branch).sum()
    }

    /// Where points count, and where they were measured.
    pub(super) fn ranges(&self, record: &Record, [x, _]: &[Axis; 2], branch: &str) -> String {
        let show = |si: f64| format_si(si, &record.units[0], 4);
        let [low, high] = record.x.iter().fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], v| [a.min(*v), b.max(*v)]);
        let part = if branch == "both" { String::new() } else { format!(", while {branch} only") };
        let [from, to] = self.computed.map(show);
        format!("the curve is computed for {} from {from} to {to}{part}, and was measured from {} to {}", x.label, show(low), show(high))
    }
}

/// Where the mechanism is when a bench shows these, without what the bench takes itself.
fn place(bench: &Bench, x: f64, y: f64) -> f64 {
    x - bench.offset[0] - bench.compliance * (y - bench.offset[1])
}

/// Whether a place lies between the ends of a curve.
fn within([from, to]: [f64; 2], at: f64) -> bool {
    let slack = AT_THE_END * (to - from);
    at >= from - slack && at <= to + slack
}

/// What decides on it.
pub(super) const REACH: &str = "see `offset`, `branch` and the travel of the design";
