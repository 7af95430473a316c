use super::{Global, Hold, NEARBY, Progress, Reserve, Search, Settings, search};
use crate::evaluator::{Evaluation, Evaluator, Failure, Measure, Output, Variable, Workspace};
use crate::posing::Posing;
use crate::task::{Band, Goal, Limit, Step, Task};

/// Values (x² − 1)² + x/5, x and 2x of one number in [−2, 2]: a deep well at x = −1.024 and a shallow one at x = 0.974.
struct Wells {
    variables: Vec<Variable>,
    outputs: Vec<Output>,
    smooth: bool,
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
        if derivatives && !self.smooth {
            return Err(Failure { reason: "no derivatives".to_owned() });
        }
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
    well(true)
}

/// The same, with derivatives or without.
fn well(smooth: bool) -> Task {
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
        evaluator: Box::new(Wells { variables, outputs, smooth }),
        title: "the deepest well".to_owned(),
        steps: vec![Step { goal: Goal::Values(vec![(0, 1.0)]), bands: Vec::new(), held: Vec::new() }],
        limits: vec![limit(0..2), limit(2..3)],
        sought: Vec::new(),
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
    for run in search.runs[4..8].iter().chain(&search.runs[12..]) {
        let off = ends.iter().map(|end| (run.start[0] - end).abs()).fold(f64::INFINITY, f64::min);
        assert!(off > 0.0 && off <= NEARBY * 2.0 + 1e-2, "{} is {off} away", run.start[0]);
    }
    // More starts have the same first ones, whose ends they have too.
    let all = found(60, Vec::new());
    let course = |search: &Search, count: usize| search.runs[..count].iter().map(|r| (r.start.clone(), r.x.clone())).collect::<Vec<_>>();
    for few in [1, 5, 8, 9, 15, 16, 20, 24, 31, 50] {
        assert_eq!(course(&found(few, Vec::new()), few), course(&all, few), "{few}");
    }
    // With few starts all are spread over the range.
    let few = found(4, Vec::new());
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

fn everywhere() -> Settings {
    Settings { starts: 0, global: Some(Global { evaluations: 2000 }), ..Settings::default() }
}

/// From the design downhill is the shallow well; a search of the whole range finds both, and the deeper one is the best.
#[test]
fn the_whole_range_has_the_deeper_well() {
    let task = task();
    let near = search(&task, &Settings::default(), &|_| true);
    assert!((near.runs[0].x[0] - 0.974).abs() < 1e-2 && near.explored.is_none());
    let found = search(&task, &everywhere(), &|_| true);
    let explored = found.explored.as_ref().expect("asked for");
    assert_eq!(found.runs.len(), 1 + explored.places.len());
    assert!((explored.places[0].x[0] + 1.024).abs() < 1e-2, "{:?}", explored.places);
    let best = &found.runs[found.best.expect("one")];
    // Where 4x³ − 4x + 1/5 = 0.
    let x = best.x[0];
    assert!((4.0 * x * x * x - 4.0 * x + 0.2).abs() < 1e-4 && x < -1.0, "{x}");
    assert!(best.feasible(1e-6) && found.evaluations() > explored.evaluations && explored.failed == 0);
    let members: usize = explored.places.iter().map(|p| p.members.len()).sum();
    assert_eq!(members, explored.runs.len(), "each run ends somewhere");
    // The design itself is searched on from as well.
    assert!((found.runs[0].x[0] - 0.974).abs() < 1e-2);
    let with = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
        let found = pool.install(|| search(&task, &everywhere(), &|_| true));
        found.runs.iter().map(|run| (run.start[0].to_bits(), run.x[0].to_bits())).collect::<Vec<_>>()
    };
    assert_eq!(with(1), with(3));
}

/// Where there are no derivatives the place that was found is the design.
#[test]
fn without_derivatives_the_place_found_stays() {
    let task = well(false);
    let found = search(&task, &everywhere(), &|_| true);
    let best = &found.runs[found.best.expect("one")];
    assert!((best.x[0] + 1.0241).abs() < 1e-3 && best.feasible(1e-6) && best.kkt_residual.is_infinite(), "{best:?}");
}

/// Interrupted on its way, the search keeps the best that it has seen.
#[test]
fn an_interrupted_search_of_the_whole_range_keeps_the_best() {
    let task = task();
    let stop = |p: &Progress| p.global.is_some_and(|g| g.evaluations < 60);
    let found = search(&task, &everywhere(), &stop);
    let best = &found.runs[found.best.expect("one")];
    assert!(found.interrupted && found.explored.as_ref().is_some_and(|e| e.runs.len() == 1));
    let place = &found.explored.as_ref().expect("asked for").places[0];
    assert!(best.goal <= place.goal && best.feasible(1e-4), "{best:?}");
}

/// Levels and half widths follow from values as the search by gradients begins with them.
#[test]
fn what_follows_from_values_is_not_searched_for() {
    let mut task = task();
    let band = |level, half_width| Band { values: 0..3, level, half_width, checks: Vec::new() };
    task.limits.clear();
    for (goal, bands) in [
        (Goal::HalfWidth, vec![band(None, None)]),
        (Goal::HalfWidth, vec![band(Some(2.0), None)]),
        (Goal::Largest { values: 0..3, scale: 4.0 }, Vec::new()),
        (Goal::Squares { values: 1..3, targets: vec![1.0, 0.5], scale: 2.0 }, Vec::new()),
        (Goal::Variables(vec![(0, 3.0)]), vec![band(None, Some(0.1))]),
        (Goal::Values(vec![(1, 2.0), (2, -1.5)]), vec![band(Some(3.0), Some(0.2))]),
    ] {
        task.steps = vec![Step { goal, bands, held: Vec::new() }];
        for x in [0.3, 0.9, 1.4] {
            let (goal, violation) = super::global::standing(&task, &[x]).expect("values");
            let posed = Posing::new(&task, &task.steps[0], &[x], &Reserve::default()).and_then(|mut p| p.standing()).expect("values");
            assert!((goal - posed.0).abs() < 1e-12, "{:?} at {x}: {goal}, {}", task.steps[0], posed.0);
            // A half width that is given is missed by values in units of the level, at its best.
            assert!((violation - posed.1).abs() < 1e-12, "{:?} at {x}: {violation}, {}", task.steps[0], posed.1);
        }
    }
    // A middle at or below zero is worse the lower it is.
    task.steps = vec![Step { goal: Goal::HalfWidth, bands: vec![band(None, None)], held: Vec::new() }];
    let goals: Vec<f64> = [-0.3, -0.6, -0.9, -1.2].iter().map(|x| super::global::standing(&task, &[*x]).expect("values").0).collect();
    assert!(goals.iter().all(|g| g.is_finite() && *g > 1.0), "{goals:?}");
}

/// A bound is said to hold a design back only where the design is at it; a variable that a step holds is held, not at an end.
#[test]
fn only_ends_that_are_met_are_named() {
    let mut task = task();
    task.limits.clear();
    // Down a slope the end of the range holds it back.
    task.steps = vec![Step { goal: Goal::Values(vec![(1, 1.0)]), bands: Vec::new(), held: Vec::new() }];
    let found = |task: &Task, limit: usize| {
        let nlp = crate::nlp::Settings { iteration_limit: limit, ..Settings::default().nlp };
        search(task, &Settings { nlp, ..Settings::default() }, &|_| true).runs.remove(0)
    };
    let ended = found(&task, 50);
    assert!((ended.x[0] + 2.0).abs() < 1e-9 && ended.active.len() == 1, "{ended:?}");
    assert!(ended.active[0].hold == Hold::Range && (ended.active[0].bound + 2.0).abs() < 1e-12);
    // Where it began, far from any end, none does, although multipliers are estimated there too.
    let begun = found(&task, 0);
    assert!((begun.x[0] - 1.5).abs() < 1e-12 && begun.active.is_empty(), "{begun:?}");
    task.steps[0].held = vec![0];
    let held = found(&task, 50);
    assert!((held.x[0] - 1.5).abs() < 1e-12 && held.active.len() == 1, "{held:?}");
    assert!(held.active[0].hold == Hold::Size && (held.active[0].bound - 1.5).abs() < 1e-12);
}
