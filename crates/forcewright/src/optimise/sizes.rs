//! What can only be had in steps or in sizes of a catalogue: the continuous optimum is rounded, and what rounding costs is told.
//!
//! Around the optimum each such number has a size below and one above. Of few, all combinations are tried; of many, one number after the
//! other is fixed, the one nearest to a size first, and the rest is searched for again in between. Each combination is searched on from with
//! its sizes held, and judged by the full analysis, as every other design.

use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};

use forcewright_base::diagnostics::{Diagnostic, Diagnostics, Explanation};
use forcewright_contract::project::Files;
use forcewright_contract::studies::Sized;
use forcewright_study::evaluator::Variable;
use forcewright_study::optimise::{Progress, Run, Settings, again};
use forcewright_study::task::Task;
use rayon::prelude::*;

use super::{Candidate, Robust};
use crate::sweep::Snapshot;
use crate::{Loaded, Refused};

/// Numbers that are rounded all at once, in all combinations: 2⁴ searches.
const AT_ONCE: usize = 4;
/// Part of a range by which rounding may put its end beyond it.
const EDGE: f64 = 1e-9;

/// Codes of rounding.
pub(crate) const CODES: &[Explanation] = &[Explanation {
    code: "E0922",
    title: "a number cannot be rounded to sizes",
    text: "A variable of `[optimise]` with `step` or `among` can be had in some sizes only. The search finds the optimum as if it could have any value, tries the sizes around it, and searches for the rest again with each.\n\nThat needs a number that is a variable by itself: one that moves with others has no size of its own. It does not go together with `robust`: the scatter is looked at around the design without sizes. Round first, fix the sizes in the file, and search for the robust design after that.",
}];

/// What rounding did.
#[derive(Clone, Debug, PartialEq)]
pub struct Rounded {
    /// The numbers: path, the optimum if they could have any value, the size, SI.
    pub numbers: Vec<(String, f64, f64)>,
    /// The goal before and after, as [`Run::goal`], by the full analysis where that knows it.
    pub goal: [f64; 2],
    /// Combinations that were tried.
    pub tried: usize,
    /// Those of them that meet every requirement.
    pub met: usize,
}

/// A number that has sizes, with the place of its variable.
pub(super) struct Place {
    at: usize,
    sized: Sized,
    /// The range of the variable, SI: sizes that the language does not allow are none.
    range: [f64; 2],
}

impl Place {
    /// The sizes around the value of a design.
    fn around(&self, x: &[f64]) -> Vec<f64> {
        let [lower, upper] = self.range;
        let slack = EDGE * (upper - lower);
        let all = self.sized.around(x[self.at]);
        let within: Vec<f64> = all.iter().copied().filter(|s| (lower - slack..=upper + slack).contains(s)).collect();
        if within.is_empty() { all } else { within }
    }
}

impl Loaded {
    /// What `[optimise]` lets have in sizes only, among these variables.
    ///
    /// # Errors
    /// [`Refused`] for a number that is no variable by itself, and for sizes of designs that are kept against scatter.
    pub(super) fn places(&self, variables: &[Variable]) -> Result<Vec<Place>, Refused> {
        let mut diagnostics = Diagnostics::default();
        let section = &self.understood.studies().optimise;
        let sized = section.sized(self.understood.numbers(), &mut diagnostics);
        let mut places = Vec::new();
        let mut refuse = |message: String, help: &str| {
            diagnostics.push(Diagnostic::error("E0922", self.project.root, message).label("in this file").help(help));
        };
        if !sized.is_empty() && Robust::asked(section).is_some() {
            refuse(
                "limits kept in spite of scatter cannot be rounded to sizes".to_owned(),
                "write `robust = \"no\"`, or fix the sizes first",
            );
        }
        for sized in sized {
            match variables.iter().position(|v| v.path == sized.path) {
                Some(at) => places.push(Place { at, sized, range: [variables[at].lower, variables[at].upper] }),
                None => {
                    refuse(format!("`{}` moves with others and has no sizes of its own", sized.path), "give it a `range` without `step`");
                }
            }
        }
        if diagnostics.has_errors() {
            return Err(self.refused(diagnostics));
        }
        Ok(places)
    }

    /// The best design with these numbers at sizes, and what that did; the design itself where the search was stopped before.
    pub(super) fn at_sizes(
        &self,
        (files, target): (&Snapshot, &Path),
        settings: &Settings,
        (found, places): (Candidate, &[Place]),
        go_on: &(dyn Fn(&Progress) -> bool + Sync),
        stopped: &AtomicBool,
    ) -> Result<(Candidate, Option<Rounded>), Refused> {
        let (mut task, _) = self.task()?;
        let own_steps = task.steps.clone();
        let mut settings = Settings { reserve: found.reserve.clone(), ..settings.clone() };
        let (mut now, mut open) = (found.clone(), (0..places.len()).collect::<Vec<usize>>());
        let (mut tried, mut met) = (0, 0);
        while !open.is_empty() {
            let combinations = next_sizes(places, &mut open, &now.run.x);
            let held: Vec<usize> = (0..places.len()).filter(|i| !open.contains(i)).map(|i| places[i].at).collect();
            task.steps.clone_from(&own_steps);
            task.steps.iter_mut().for_each(|step| step.held.extend(&held));
            if held.len() == task.evaluator.variables().len() {
                // Nothing is left to search for.
                settings.nlp.iteration_limit = 0;
            }
            let one = |sizes: &Vec<(usize, f64)>| {
                let mut run = now.run.clone();
                for (place, size) in sizes {
                    run.x[places[*place].at] = *size;
                }
                self.rounded((files, target), (&task, &settings), run, go_on, stopped)
            };
            let judged: Vec<Result<Option<Candidate>, Refused>> = combinations.par_iter().map(one).collect();
            let mut best: Option<Candidate> = None;
            for candidate in judged {
                let Some(candidate) = candidate? else { continue };
                (tried, met) = (tried + 1, met + usize::from(candidate.met()));
                if best.as_ref().is_none_or(|b| candidate.beats(b)) {
                    best = Some(candidate);
                }
            }
            match best {
                Some(best) if !stopped.load(Ordering::Relaxed) => now = best,
                _ => return Ok((found, None)),
            }
        }
        let numbers = places.iter().map(|p| (p.sized.path.clone(), found.run.x[p.at], now.run.x[p.at])).collect();
        let rounded = Rounded { numbers, goal: [found.goal, now.goal], tried, met };
        Ok((now, Some(rounded)))
    }

    /// A combination of sizes searched on from and judged; `None` if it has no values.
    fn rounded(
        &self,
        place: (&dyn Files, &Path),
        (task, settings): (&Task, &Settings),
        run: Run,
        go_on: &(dyn Fn(&Progress) -> bool + Sync),
        stopped: &AtomicBool,
    ) -> Result<Option<Candidate>, Refused> {
        let mut next = again(task, settings, &run, go_on);
        if next.goal.is_nan() || stopped.load(Ordering::Relaxed) {
            return Ok(None);
        }
        next.history.splice(0..0, run.history);
        self.kept(place, (task, settings), next, go_on, stopped).map(Some)
    }
}

/// The combinations of sizes to try next around a design, and takes their numbers off the open ones: all of them if they are few, else of
/// the one that is nearest to a size.
fn next_sizes(places: &[Place], open: &mut Vec<usize>, x: &[f64]) -> Vec<Vec<(usize, f64)>> {
    let around = |place: usize| places[place].around(x);
    let two = open.iter().filter(|i| around(**i).len() > 1).count();
    let chosen: Vec<usize> = if two <= AT_ONCE {
        std::mem::take(open)
    } else {
        // How far the nearer size is, over the distance of both; a number that has one size is there.
        let distance = |place: &usize| match around(*place)[..] {
            [below, above] => (x[places[*place].at] - below).min(above - x[places[*place].at]) / (above - below),
            _ => 0.0,
        };
        let nearest = (0..open.len()).reduce(|a, b| if distance(&open[b]) < distance(&open[a]) { b } else { a });
        nearest.map(|i| open.remove(i)).into_iter().collect()
    };
    let mut combinations: Vec<Vec<(usize, f64)>> = vec![Vec::new()];
    for place in chosen {
        let sizes = around(place);
        combinations = combinations.iter().flat_map(|c| sizes.iter().map(|size| [c.as_slice(), &[(place, *size)]].concat())).collect();
    }
    combinations
}
