//! Many designs on all threads, handed on in their order.

use std::collections::BTreeMap;
use std::sync::{Mutex, PoisonError};

use rayon::prelude::*;

use super::{Plan, REPLICATES, Reason, ToleranceError};
use crate::evaluator::{Evaluator, Workspace};
use crate::sampling::{Population, Replicates};

/// Designs of a chunk: enough to fill the lanes of an evaluator that computes several at once. A multiple of the replicates, so that a
/// study that is stopped between chunks has as many of each.
const CHUNK: u64 = 64;
/// Chunks handed on at once, per thread.
const AHEAD: usize = 4;

/// Writes the points from a number on, as many as fit.
type Fill<'a> = Box<dyn Fn(u64, &mut [f64]) + Sync + 'a>;

/// Points of the unit cube: as many, each a function of its number.
pub(super) struct Points<'a> {
    pub(super) count: u64,
    pub(super) fill: Fill<'a>,
}

/// The points of a sample in replicates.
pub(super) fn points(plan: &Plan, count: u64) -> Result<Points<'static>, ToleranceError> {
    let replicates = Replicates::new(plan.population.len(), REPLICATES, plan.seed).map_err(ToleranceError::Points)?;
    Ok(Points { count, fill: Box::new(move |first, out| replicates.fill(first, out)) })
}

/// A design's values and measures (not a number where it has none), or why it has none.
type Design<'a> = Result<(&'a [f64], &'a [f64]), &'a str>;

/// Room of the threads: as many as were ever needed at once.
pub(super) struct Rooms<'a> {
    evaluator: &'a dyn Evaluator,
    free: Mutex<Vec<Workspace>>,
}

impl<'a> Rooms<'a> {
    pub(super) fn new(evaluator: &'a dyn Evaluator) -> Self {
        Self { evaluator, free: Mutex::new(Vec::new()) }
    }

    pub(super) fn with<T>(&self, work: impl FnOnce(&mut Workspace) -> T) -> T {
        let found = self.free.lock().unwrap_or_else(PoisonError::into_inner).pop();
        let mut room = found.unwrap_or_else(|| self.evaluator.workspace());
        let result = work(&mut room);
        self.free.lock().unwrap_or_else(PoisonError::into_inner).push(room);
        result
    }
}

/// A chunk of designs that was evaluated.
#[derive(Default)]
struct Chunk {
    values: Vec<f64>,
    measures: Vec<f64>,
    /// Per design: nothing, or why it has no values.
    failed: Vec<Option<String>>,
}

/// Draws and evaluates designs; hands each to `sink`, in order. Whether `watch`, which is told how many are done, let it come to its end.
pub(super) fn designs(
    evaluator: &dyn Evaluator,
    population: &Population,
    points: &Points<'_>,
    watch: &mut dyn FnMut(u64) -> bool,
    sink: &mut dyn FnMut(Design<'_>),
) -> bool {
    let rooms = Rooms::new(evaluator);
    let chunk = |first: u64| rooms.with(|room| evaluated(evaluator, population, points, first, room));
    in_order(points.count, watch, &chunk, &mut |chunk: Chunk| {
        let (mut values, mut measures) = (&chunk.values[..], &chunk.measures[..]);
        let count = evaluator.measures().len();
        let each = chunk.failed.iter().filter(|f| f.is_none()).count().max(1);
        let width = values.len() / each;
        for failed in &chunk.failed {
            if let Some(reason) = failed {
                sink(Err(reason));
                continue;
            }
            let (own, rest) = values.split_at(width);
            let (measured, others) = measures.split_at(count);
            (values, measures) = (rest, others);
            sink(Ok((own, measured)));
        }
    })
}

/// Work in chunks on all threads, the results in order.
pub(super) fn in_order<T: Send>(
    count: u64,
    watch: &mut dyn FnMut(u64) -> bool,
    chunk: &(dyn Fn(u64) -> T + Sync),
    sink: &mut dyn FnMut(T),
) -> bool {
    let chunks = count.div_ceil(CHUNK);
    let together = (AHEAD * rayon::current_num_threads()) as u64;
    let mut first = 0;
    while first < chunks {
        if !watch(first * CHUNK) {
            return false;
        }
        let last = chunks.min(first + together);
        let found: Vec<T> = (first..last).into_par_iter().map(|i| chunk(i * CHUNK)).collect();
        found.into_iter().for_each(&mut *sink);
        first = last;
    }
    true
}

/// The designs of the chunk that begins with `first`, one after the other.
pub(super) fn drawn(population: &Population, points: &Points<'_>, first: u64) -> Vec<f64> {
    let n = population.len();
    let count = CHUNK.min(points.count - first);
    #[allow(clippy::cast_possible_truncation, reason = "at most 64")]
    let mut all = vec![0.0; n * count as usize];
    (points.fill)(first, &mut all);
    all.chunks_exact_mut(n.max(1)).for_each(|point| population.draw(point));
    all
}

fn evaluated(evaluator: &dyn Evaluator, population: &Population, points: &Points<'_>, first: u64, room: &mut Workspace) -> Chunk {
    let all = drawn(population, points, first);
    let n = population.len().max(1);
    let mut chunk = Chunk::default();
    evaluator.evaluate_all(&all, room, &mut |_, found| match found {
        Ok(evaluation) => {
            chunk.values.extend_from_slice(&evaluation.values);
            chunk.failed.push(None);
        }
        Err(failure) => chunk.failed.push(Some(failure.reason.clone())),
    });
    let sound = chunk.failed.iter().filter(|f| f.is_none()).count().max(1);
    let mut values = chunk.values.chunks_exact((chunk.values.len() / sound).max(1));
    let mut measured = Vec::with_capacity(evaluator.measures().len());
    chunk.measures.reserve(sound * evaluator.measures().len());
    for (x, _) in all.chunks_exact(n).zip(&chunk.failed).filter(|(_, failed)| failed.is_none()) {
        evaluator.measure(x, values.next().unwrap_or_default(), &mut measured, room);
        chunk.measures.extend_from_slice(&measured);
    }
    chunk
}

/// Most reasons that are told apart.
const MOST_REASONS: usize = 32;

/// Reasons of failures, counted by their words without numbers.
#[derive(Default)]
pub(super) struct Reasons {
    found: BTreeMap<String, Reason>,
}

impl Reasons {
    pub(super) fn add(&mut self, text: &str) {
        let mut key = String::with_capacity(text.len());
        for c in text.chars() {
            let numeric = c.is_ascii_digit() || matches!(c, '.' | '-' | '−');
            if !numeric {
                key.push(c);
            } else if !key.ends_with('#') {
                key.push('#');
            }
        }
        if self.found.len() >= MOST_REASONS && !self.found.contains_key(&key) {
            key.clear();
        }
        let text = if key.is_empty() { "others" } else { text };
        self.found.entry(key).or_insert_with(|| Reason { text: text.to_owned(), count: 0 }).count += 1;
    }

    /// Most frequent first.
    pub(super) fn sorted(self) -> Vec<Reason> {
        let mut all: Vec<Reason> = self.found.into_values().collect();
        all.sort_by(|a, b| b.count.cmp(&a.count).then_with(|| a.text.cmp(&b.text)));
        all
    }
}
