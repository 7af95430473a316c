use super::{NEARBY, Reserve, Search, Settings, search};
use crate::evaluator::{Evaluation, Evaluator, Failure, Measure, Output, Variable, Workspace};
use crate::task::{Goal, Limit, Step, Task};

/// Values (x² − 1)² + x/5, x and 2x of one number in [−2, 2]: a deep well at x = −1.024 and a shallow one at x = 0.974.
struct Wells {
    variables: Vec<Variable>,
    outputs: Vec<Output>,
}

impl Evaluator for Wells {
    fn variables(&self) -> &[Variable] {
        &self.variables
    }

    fn outputs(&self) -> &[Output] {
        &self.outputs
    }

    fn measures(&self) -> &[Measure] {
        &[]
    }

    fn workspace(&self) -> Workspace {
        Workspace::new(())
    }

    fn evaluate(&self, x: &[f64], derivatives: bool, out: &mut Evaluation, _: &mut Workspace) -> Result<(), Failure> {
        let [x] = *x else { return Err(Failure { reason: "one number".to_owned() }) };
        let off = x * x - 1.0;
        out.values = vec![off * off + 0.2 * x, x, 2.0 * x];
        out.jacobian = if derivatives { vec![4.0 * x * off + 0.2, 1.0, 2.0] } else { Vec::new() };
        Ok(())
    }

    fn measure(&self, _: &[f64], _: &[f64], out: &mut Vec<f64>, _: &mut Workspace) {
        out.clear();
    }
}

/// The deepest well.
fn task() -> Task {
    let variables = vec![Variable { path: "design.x".to_owned(), unit: "m", nominal: 1.5, lower: -2.0, upper: 2.0 }];
    let outputs = vec![Output { name: "well".to_owned(), unit: "m", values: 0..3 }];
    let limit = |values: std::ops::Range<usize>| Limit {
        name: "well".to_owned(),
        key: "requirements.well".to_owned(),
        checks: Vec::new(),
        values,
        lower: -5.0,
        upper: 30.0,
        scale: 1.0,
        unit: "m",
        in_band: false,
    };
    Task {
        evaluator: Box::new(Wells { variables, outputs }),
        title: "the deepest well".to_owned(),
        steps: vec![Step { goal: Goal::Values(vec![(0, 1.0)]), bands: Vec::new(), held: Vec::new() }],
        limits: vec![limit(0..2), limit(2..3)],
    }
}

fn found(starts: usize, more_starts: Vec<Vec<f64>>) -> Search {
    search(&task(), &Settings { starts, more_starts, ..Settings::default() }, &|_| true)
}

/// Each limit and the bands are measured by the largest distance of their own.
#[test]
#[expect(clippy::float_cmp, reason = "quarters and halves are exact")]
fn a_reserve_lacks_the_largest_part_of_any_limit_or_band() {
    let task = task();
    let reserve = |limits: [f64; 3], bands: [f64; 2]| Reserve { margin: 0.0, limits: limits.to_vec(), bands: bands.to_vec() };
    let own = reserve([4.0, 1.0, 100.0], [0.01, 0.02]);
    let lacking = |limits, bands| own.lacking(&reserve(limits, bands), &task);
    assert_eq!(own.lacking(&own, &task), 0.0);
    assert_eq!(lacking([9.0, 1.5, 200.0], [0.01, 0.03]), 0.0, "what is more than enough lacks nothing");
    assert_eq!(lacking([4.0, 0.0, 100.0], [0.01, 0.02]), 0.25, "1 of at most 4");
    assert_eq!(lacking([4.0, 0.0, 50.0], [0.01, 0.02]), 0.5, "50 of at most 100, of another limit");
    assert_eq!(lacking([4.0, 0.0, 50.0], [0.01, 0.005]), 0.75, "0.015 of at most 0.02, of the bands");
    assert_eq!(own.lacking(&Reserve::default(), &task), 1.0, "nothing is all that it lacks");
    assert_eq!(Reserve::default().lacking(&own, &task), 0.0);
}

#[test]
fn half_of_the_starts_begin_near_the_best_of_the_others() {
    let search = found(16, Vec::new());
    assert_eq!(search.runs.len(), 16);
    let ends: Vec<f64> = search.basins.iter().map(|b| search.runs[b.best].x[0]).collect();
    assert!(ends.len() == 2 && (ends[0] + 1.024).abs() < 1e-2 && (ends[1] - 0.974).abs() < 1e-2, "{ends:?}");
    for (index, run) in search.runs[8..].iter().enumerate() {
        let off = (run.start[0] - ends[index % 2]).abs();
        assert!(off > 0.0 && off <= NEARBY * 2.0 + 1e-2, "{} is {off} away", run.start[0]);
    }
    // With few starts all are spread over the range.
    let few = found(7, Vec::new());
    assert!(few.runs.iter().zip(&search.runs).all(|(few, many)| few.start == many.start));
}

#[test]
fn starts_that_are_given_stay_what_they_are() {
    let given: Vec<Vec<f64>> = [0.123, -1.9, 1.7, 5.0].iter().map(|x| vec![*x]).collect();
    for starts in [0, 1, 8] {
        let search = found(starts, given.clone());
        assert_eq!(search.runs.len(), starts + given.len());
        for x in [0.123, -1.9, 1.7, 2.0] {
            assert!(search.runs.iter().any(|run| run.start == [x]), "{x} of {starts} starts and four more");
        }
    }
}

#[test]
fn any_number_of_threads_finds_the_same_bits() {
    let with = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
        let search = pool.install(|| found(16, vec![vec![0.5]]));
        search.runs.iter().map(|run| (run.start[0].to_bits(), run.x[0].to_bits())).collect::<Vec<_>>()
    };
    assert_eq!(with(1), with(3));
}
