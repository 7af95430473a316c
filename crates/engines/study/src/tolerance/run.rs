//! Many designs on all threads, handed on in their order.

use std::collections::BTreeMap;
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::sync::mpsc::{Receiver, TryRecvError, channel};
use std::sync::{Mutex, PoisonError};

use rayon::Yield;

use super::{Plan, REPLICATES, Reason, ToleranceError};
use crate::evaluator::{Evaluator, Workspace};
use crate::sampling::{Population, Replicates};

/// Designs of a chunk: enough to fill the lanes of an evaluator that computes several at once. A multiple of the replicates, so that a
/// study that is stopped between chunks has as many of each.
const CHUNK: u64 = 64;
/// Chunks begun before they are asked for, per thread.
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
pub(super) struct Chunk {
    values: Vec<f64>,
    measures: Vec<f64>,
    /// Per design: nothing, or why it has no values.
    failed: Vec<Option<String>>,
}

impl Chunk {
    /// The values of every design that has some.
    pub(super) fn values(&self) -> impl Iterator<Item = &[f64]> + Clone {
        self.of_sound(&self.values)
    }

    /// The measures of the same designs; not a number where one has no value.
    pub(super) fn measures(&self) -> impl Iterator<Item = &[f64]> + Clone {
        self.of_sound(&self.measures)
    }

    fn of_sound<'a>(&self, all: &'a [f64]) -> impl Iterator<Item = &'a [f64]> + Clone + use<'a> {
        let sound = self.failed.iter().filter(|failed| failed.is_none()).count();
        let width = all.len() / sound.max(1);
        (0..sound).map(move |i| &all[i * width..(i + 1) * width])
    }

    /// Every design: its measures, or why it has no values.
    pub(super) fn designs(&self) -> impl Iterator<Item = Result<&[f64], &str>> {
        let mut measures = self.measures();
        self.failed.iter().map(move |failed| failed.as_deref().map_or_else(|| Ok(measures.next().unwrap_or_default()), Err))
    }
}

/// Draws and evaluates designs; hands chunks of them to `sink`, in order. Whether `watch`, which is told how many are done, let it come
/// to its end.
pub(super) fn designs(
    evaluator: &dyn Evaluator,
    population: &Population,
    points: &Points<'_>,
    watch: &mut dyn FnMut(u64) -> bool,
    sink: &mut dyn FnMut(Chunk),
) -> bool {
    let rooms = Rooms::new(evaluator);
    let chunk = |first: u64| rooms.with(|room| evaluated(evaluator, population, points, first, room));
    in_order(points.count, watch, &chunk, sink)
}

/// Work in chunks on all threads, the results in order. While this thread takes in one, the others go on.
pub(super) fn in_order<T: Send>(
    count: u64,
    watch: &mut dyn FnMut(u64) -> bool,
    chunk: &(dyn Fn(u64) -> T + Sync),
    sink: &mut dyn FnMut(T),
) -> bool {
    let chunks = count.div_ceil(CHUNK);
    let ahead = (AHEAD * rayon::current_num_threads()) as u64;
    let (sender, receiver) = channel();
    rayon::in_place_scope_fifo(|scope| {
        let begin = |index: u64| {
            let sender = sender.clone();
            scope.spawn_fifo(move |_| {
                // A panic goes on where the results are waited for, which would else be for ever. Nobody waits after a stop.
                let found = catch_unwind(AssertUnwindSafe(|| chunk(index * CHUNK)));
                let _ = sender.send((index, found));
            });
        };
        (0..chunks.min(ahead)).for_each(begin);
        let mut early = BTreeMap::new();
        for next in 0..chunks {
            if !watch(next * CHUNK) {
                return false;
            }
            while !early.contains_key(&next) {
                let Some((index, found)) = receive(&receiver) else { return false };
                early.insert(index, found.unwrap_or_else(|panic| resume_unwind(panic)));
            }
            early.remove(&next).into_iter().for_each(&mut *sink);
            if next + ahead < chunks {
                begin(next + ahead);
            }
        }
        true
    })
}

/// The next message. A thread of the pool works in the meantime, as there may be no other.
fn receive<T>(receiver: &Receiver<T>) -> Option<T> {
    loop {
        match receiver.try_recv() {
            Ok(found) => return Some(found),
            Err(TryRecvError::Disconnected) => return None,
            Err(TryRecvError::Empty) => {}
        }
        match rayon::yield_now() {
            Some(Yield::Executed) => {}
            Some(Yield::Idle) => std::thread::yield_now(),
            None => return receiver.recv().ok(),
        }
    }
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
            if chunk.values.is_empty() {
                chunk.values.reserve_exact(all.len() / n * evaluation.values.len());
            }
            chunk.values.extend_from_slice(&evaluation.values);
            chunk.failed.push(None);
        }
        Err(failure) => chunk.failed.push(Some(failure.reason.clone())),
    });
    let sound = all.chunks_exact(n).zip(&chunk.failed).filter(|(_, failed)| failed.is_none());
    let (mut measures, mut measured) = (Vec::new(), Vec::new());
    for ((x, _), values) in sound.zip(chunk.values()) {
        evaluator.measure(x, values, &mut measured, room);
        measures.extend_from_slice(&measured);
    }
    chunk.measures = measures;
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
