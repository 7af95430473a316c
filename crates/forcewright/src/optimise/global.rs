//! A search of the whole range: what may be asked for with it, and what is told of it.

use forcewright_base::diagnostics::{Diagnostic, Diagnostics, Explanation};
use forcewright_base::units::format_number;
use forcewright_contract::describe::Origin;
use forcewright_contract::studies::{Optimise, USUAL_EVALUATIONS};
use forcewright_model::{StudyColumn, StudyTable};
use forcewright_study::cma;
use forcewright_study::optimise::{Explored, Global};
use serde_json::{Value, json};

use super::Optimised;
use crate::{Loaded, Refused};

/// Codes of searches.
pub(crate) const CODES: &[Explanation] = &[Explanation {
    code: "E0923",
    title: "a key of one kind of search is given to the other",
    text: "`[optimise]` searches in one of two ways:\n\n    search = \"gradient\"     # downhill from `starts` designs; the default\n    search = \"global\"       # the whole range, at most `evaluations` designs, then downhill from the best places\n\n`starts` (or `--starts`) says nothing of the second, whose starts are the places that it finds and the design of the file; `evaluations` says nothing of the first, which ends by itself. Remove the key, or choose the other search. All else works with both: `seed`, `margin`, `robust`, `step`, `among`, `--front`.",
}];

/// What `[optimise]` asks for.
pub(super) fn asked(section: &Optimise) -> Option<Global> {
    let evaluations = section.evaluations.as_ref().map_or(USUAL_EVALUATIONS, |e| e.value);
    section.global().then_some(Global { evaluations: u64::from(evaluations) })
}

/// Refuses keys of the other kind of search.
pub(super) fn check(section: &Optimise, diagnostics: &mut Diagnostics) {
    let given = |slot: &forcewright_contract::describe::Slot<u32>| slot.as_ref().filter(|s| s.origin == Origin::File).map(|s| s.span);
    let mut refuse = |span, message: &str, help: &str| {
        let mut refused = Diagnostic::error("E0923", span, message).label("this key").help(help);
        if let Some(search) = section.search.as_ref().filter(|s| s.origin == Origin::File) {
            refused = refused.related(search.span, "the search");
        }
        diagnostics.push(refused);
    };
    match (section.global(), given(&section.starts), given(&section.evaluations)) {
        (true, Some(span), _) => {
            refuse(span, "a global search has no `starts`", "remove it; `evaluations` says how many designs may be computed");
        }
        (false, _, Some(span)) => {
            refuse(span, "only a global search has `evaluations`", "write `search = \"global\"`, or remove it");
        }
        _ => {}
    }
}

impl Loaded {
    /// Refuses a number of starts that was given to a search that has none.
    pub(crate) fn starts_allowed(&self, starts: Option<u32>) -> Result<(), Refused> {
        if starts.is_none() || !self.understood.studies().optimise.global() {
            return Ok(());
        }
        let mut diagnostics = Diagnostics::default();
        diagnostics.push(
            Diagnostic::placeless("E0923", "a global search has no starts, and `--starts` was given")
                .help("leave `--starts` away, or write `search = \"gradient\"`"),
        );
        Err(self.refused(diagnostics))
    }
}

impl Optimised {
    /// What the search of the whole range did, in words.
    pub(super) fn explored_in_words(&self, found: &Explored) -> String {
        let failed = if found.failed > 0 { format!(", {} of them without a curve", found.failed) } else { String::new() };
        let plural = |count: usize, one: &str, many: &str| if count == 1 { format!("1 {one}") } else { format!("{count} {many}") };
        let places = found.places.len() + found.left;
        let left = if found.left > 0 { format!("; of the worst {} of them none went on", found.left) } else { String::new() };
        format!(
            "The whole range was searched without derivatives (CMA-ES, seed {}): {} designs{failed}, in {}, which ended at {}. From each, and from the design of the file, a search went on downhill{left}.",
            self.seed,
            found.evaluations,
            plural(found.runs.len(), "run", "runs"),
            plural(places, "design", "different designs"),
        )
    }

    /// Where the search of the whole range led, and what became of it. `None` without one.
    pub fn place_table(&self) -> Option<StudyTable> {
        let found = self.search.explored.as_ref().filter(|e| !e.places.is_empty())?;
        let columns = vec![
            StudyColumn::Text("Place".to_owned()),
            StudyColumn::Number("Goal there".to_owned()),
            StudyColumn::Number("Largest miss of a limit".to_owned()),
            StudyColumn::Number("Runs that ended there".to_owned()),
            StudyColumn::Number("Goal downhill from it".to_owned()),
        ];
        let rows = found.places.iter().enumerate().map(|(i, place)| {
            // The first search downhill is that from the design of the file.
            let run = self.search.runs.get(i + 1).filter(|r| r.goal.is_finite());
            // What the search allows itself is no miss.
            let miss = self.place_misses.get(i).and_then(Option::as_ref).filter(|_| place.violation > super::NEARLY_KEPT);
            let miss = miss.map_or_else(String::new, |(name, by)| format!("{name} by {} %", format_number(100.0 * by, 2)));
            vec![
                (i + 1).to_string(),
                self.wording.show(place.goal),
                miss,
                place.members.len().to_string(),
                run.map_or_else(|| "–".to_owned(), |r| self.wording.show(r.goal)),
            ]
        });
        Some(StudyTable { caption: "Where the search of the whole range led, the best first".to_owned(), columns, rows: rows.collect() })
    }

    /// The search for the result document.
    pub(super) fn search_document(&self) -> Value {
        let Some(found) = &self.search.explored else { return json!({ "method": "gradient", "seed": self.seed }) };
        let point = |p: &Option<cma::Point>| p.as_ref().map(|p| self.wording.value(p.goal));
        let runs = found.runs.iter().map(|r| {
            json!({
                "population": r.population, "generations": r.generations, "evaluations": r.evaluations, "stop": word(r.stop),
                "goal": point(&r.best), "violation": r.best.as_ref().map(|p| p.violation),
            })
        });
        let places = found
            .places
            .iter()
            .enumerate()
            .map(|(i, p)| json!({ "goal": self.wording.value(p.goal), "violation": p.violation, "members": p.members, "run": i + 1 }));
        json!({
            "method": "global", "seed": self.seed, "evaluations": found.evaluations, "failed": found.failed,
            "runs": runs.collect::<Vec<_>>(), "places": places.collect::<Vec<_>>(), "left": found.left,
        })
    }
}

/// A way to end, for scripts.
fn word(stop: cma::Stop) -> &'static str {
    match stop {
        cma::Stop::Goal => "goal",
        cma::Stop::Step => "step",
        cma::Stop::Rounding => "rounding",
        cma::Stop::Stagnation => "stagnation",
        cma::Stop::Divergence => "divergence",
        cma::Stop::Evaluations => "evaluations",
        cma::Stop::Nothing => "nothing",
        cma::Stop::Interrupted => "interrupted",
    }
}
