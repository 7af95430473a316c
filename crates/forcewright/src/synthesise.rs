//! From requirements to project files of designs that meet them.

mod document;
mod files;
mod pages;

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

use forcewright_base::diagnostics::{Diagnostic, Diagnostics, Explanation, SourceId, Sources, Span};
use forcewright_contract::edit;
use forcewright_contract::project::{Choices, Files, Project};
use forcewright_contract::synthesis::{Judgement, Proposal, Relaxation, Synthesiser};
use forcewright_contract::tree::{Item, Value};
use forcewright_model::{Check, CheckState, Report, StatusKind, StudyTable};
use rayon::prelude::*;

use crate::load::asks_for_design;
use crate::optimise::{Beginnings, shortfall, way};
use crate::{FAMILIES, Loaded, Refused, family};
use files::{Known, Recorder, aligned};

/// Designs analysed side by side before it is looked whether one of them does.
const TOGETHER: usize = 4;
/// Corrections of one proposal, beyond which it is taken as it is: families end earlier by themselves.
const MOST_ROUNDS: usize = 8;
/// A proposal that misses a requirement by less than this part of it may be mended by a search.
const NEARLY_MET: f64 = 0.1;
/// Searches made for that.
const MOST_SEARCHES: usize = 2;
/// How often a loosened limit is loosened further where the nearest value does not stand the full analysis, and by how much each time.
const SLACKS: [f64; 4] = [0.0, 0.03, 0.08, 0.2];
/// Parts in which a family's own search tells where it stands.
const PARTS: u32 = 1000;
/// A margin no larger is that of a limit met exactly.
const TAKEN_OVER: f64 = 1e-9;

/// Where a synthesis stands.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SynthesisProgress {
    /// What is being done.
    pub stage: Stage,
    /// Pieces done, and how many there are in this stage.
    pub done: usize,
    /// How many there are.
    pub of: usize,
}

/// What a synthesis is doing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stage {
    /// The family looks through what there is; `done` of `of` parts.
    Sizing,
    /// Designs are analysed and corrected.
    Analysing,
    /// One that nearly meets everything is searched on from.
    Searching,
    /// Limits are loosened one at a time to find out which blocks.
    Loosening,
    /// The best design is set beside its alternatives.
    Comparing,
}

/// A design that was found.
pub struct Designed {
    /// What the family proposed, as last corrected.
    pub proposal: Proposal,
    /// Its project file.
    pub text: String,
    /// Name of that file.
    pub file: String,
    /// Its full analysis.
    pub report: Report,
    /// Whether a search mended it.
    pub searched: bool,
}

impl Designed {
    /// Whether it meets every requirement over its whole travel.
    pub fn met(&self) -> bool {
        self.report.outcome.status.kind == StatusKind::Complete && self.report.outcome.requirements_met()
    }

    /// Checks of its full analysis that it misses, of requirements or not.
    pub fn missed(&self) -> impl Iterator<Item = &Check> {
        self.report.outcome.checks.iter().filter(|c| c.state == CheckState::Missed)
    }

    /// The least margin of its requirements, relative; `None` where none has one.
    pub fn margin(&self) -> Option<f64> {
        let checks = self.report.outcome.checks.iter().filter(|c| c.required);
        // What a design takes over as it is asked for, such as a stroke, has no margin worth a word.
        checks.filter_map(|c| c.margin).filter(|margin| margin.abs() > TAKEN_OVER).reduce(f64::min)
    }
}

/// A limit that, loosened alone, was found to do.
#[derive(Clone, Debug)]
pub struct Way {
    /// The limit and its nearest value.
    pub relaxation: Relaxation,
    /// Whether a design was found and analysed that meets everything with it; otherwise only the closed form says so.
    pub confirmed: bool,
}

/// What a synthesis found.
pub struct Synthesised {
    /// The designs, those that meet everything first, the best first.
    pub designs: Vec<Designed>,
    /// What would do where nothing meets everything.
    pub ways: Vec<Way>,
    /// Designs analysed in full, their corrections included.
    pub analysed: usize,
    /// What the family's closed forms took, in words.
    pub effort: Option<String>,
    /// The family's tables about the best design; empty where none meets everything.
    pub tables: Vec<StudyTable>,
    /// Proposals that are not fit to be made: shape and reason.
    pub rejected: Vec<(String, String)>,
    /// Whether it was interrupted.
    pub interrupted: bool,
    /// What was said about the file.
    pub diagnostics: Diagnostics,
    /// The texts that this points into.
    pub sources: Sources,
    /// The project's title.
    pub title: String,
    /// The family's title.
    pub family: String,
    /// SHA-256 of everything read.
    pub input_sha256: String,
}

impl Synthesised {
    /// Whether a design meets everything.
    pub fn met(&self) -> bool {
        self.designs.first().is_some_and(Designed::met)
    }
}

/// A synthesis ready to run.
pub struct SynthesisTask {
    synthesiser: Box<dyn Synthesiser>,
    /// The user's text without a design, as it is written.
    text: String,
    /// Every file that was read.
    known: Known,
    path: PathBuf,
    diagnostics: Diagnostics,
    sources: Sources,
    title: String,
    family: String,
    input_sha256: String,
}

impl SynthesisTask {
    /// Reads a file of requirements: what it says of a design, a layout or a load is not looked at. `set` are settings `KEY=VALUE`.
    ///
    /// ```
    /// use forcewright::{DiskFiles, SynthesisTask};
    ///
    /// let text = r#"
    /// schema = 1
    /// mechanism = "compliant"
    /// title = "A soft button"
    /// requirements = { force = { nominal = "5 N", band = "10 %" }, travel = "4 mm", stress = { safety_factor = 1.5 } }
    /// material.use = "POM-C"
    /// synthesise = { thickness_min = "0.4 mm", candidates = 1 }
    /// "#;
    /// let task = SynthesisTask::from_text("button.toml", text, &[]).map_err(|e| e.render(false))?;
    /// let found = task.run("button.toml".as_ref(), &|_| true);
    /// assert!(found.met());
    /// # Ok::<(), String>(())
    /// ```
    ///
    /// # Errors
    /// [`Refused`] with everything that is wrong, in file order.
    pub fn from_file(files: &dyn Files, path: &Path, set: &[String]) -> Result<Self, Refused> {
        let recorder = Recorder::new(files);
        let choices = Choices { variant: None, set: set.to_vec() };
        // What cannot be completed is read as any project, so that what is wrong with it is said the same way.
        let unusable = || Loaded::from_file(files, path, &choices).err().unwrap_or_else(|| no_synthesis("this file"));
        let project = Project::load(&recorder, path, &choices);
        let Ok(text) = recorder.read(path) else { return Err(unusable()) };
        // While there is only one family, a file that does not name it well is read as its file, as elsewhere.
        let only = if let [only] = FAMILIES { Some(*only) } else { None };
        let Some(family) = project.mechanism().and_then(|(id, _)| family(id)).or(only) else { return Err(unusable()) };
        let Some(skeleton) = family.skeleton() else { return Err(no_synthesis(family.title())) };
        let Ok((bare, dropped)) = edit::without_tables(&text, skeleton.roots) else { return Err(unusable()) };
        let completed = format!("{}\n{}", aligned(&text, &bare).trim_end_matches('\n'), skeleton.sections);
        recorder.put(path, completed);
        let loaded = Loaded::from_file(&recorder, path, &choices)?;
        let mut diagnostics = loaded.project.diagnostics.clone();
        for root in skeleton.roots {
            if let Some(span) = loaded.project.tree.get(root).and_then(|entry| foreign(&entry.item)) {
                let message = format!("`{root}` comes from the command line or an extended file, and a synthesis would write it");
                diagnostics.push(Diagnostic::error("E0532", span, message).label("not here").help("leave it out"));
            }
        }
        if !dropped.is_empty() {
            let list = dropped.iter().map(|d| format!("`[{d}]`")).collect::<Vec<_>>().join(", ");
            diagnostics.push(Diagnostic::warning(
                "W0530",
                loaded.project.root,
                format!("{list}: not looked at, since a synthesis writes it"),
            ));
        }
        let refused = |diagnostics: Diagnostics| Refused { diagnostics, sources: loaded.project.sources.clone(), file_missing: false };
        let synthesiser = loaded.understood.synthesiser(&mut diagnostics).filter(|_| !diagnostics.has_errors());
        let Some(synthesiser) = synthesiser else { return Err(refused(diagnostics)) };
        let Ok(text) = edit::with_settings(&bare, set, None) else { return Err(unusable()) };
        Ok(Self {
            synthesiser,
            text,
            known: recorder.known(),
            path: path.to_owned(),
            title: title_of(&loaded.project),
            family: family.title().to_owned(),
            input_sha256: loaded.input_sha256.clone(),
            sources: loaded.project.sources.clone(),
            diagnostics,
        })
    }

    /// Whether a file says what a design must do, and has none.
    pub fn is_asked(files: &dyn Files, path: &Path, set: &[String]) -> bool {
        asks_for_design(&Project::load(files, path, &Choices { variant: None, set: set.to_vec() })).is_some()
    }

    /// The same for a text in memory, which cannot extend other files.
    ///
    /// # Errors
    /// As [`Self::from_file`].
    pub fn from_text(name: &str, text: &str, set: &[String]) -> Result<Self, Refused> {
        let path = PathBuf::from(name);
        let known = Known(BTreeMap::from([(path.clone(), Ok(text.to_owned()))]));
        Self::from_file(&known, &path, set)
    }

    /// What was said about the file, and the texts that this points into.
    pub fn diagnostics(&self) -> (&Diagnostics, &Sources) {
        (&self.diagnostics, &self.sources)
    }

    /// Of designs that are nearly the same the first.
    fn drop_alike(&self, designs: &mut Vec<Designed>) {
        let mut kept: Vec<Designed> = Vec::new();
        for design in designs.drain(..) {
            if !kept.iter().any(|k| self.synthesiser.alike(&k.proposal, &design.proposal)) {
                kept.push(design);
            }
        }
        *designs = kept;
    }

    /// Looks for designs, whose files are meant for the folder of `target`; what they extend is named from there. `watch` sees every
    /// step, from any thread, and ends the work by returning `false`: what was found so far is kept.
    pub fn run(&self, target: &Path, watch: &(dyn Fn(&SynthesisProgress) -> bool + Sync)) -> Synthesised {
        let stopped = AtomicBool::new(false);
        let go_on = |progress: SynthesisProgress| {
            stopped.fetch_or(!watch(&progress), Ordering::Relaxed);
            !stopped.load(Ordering::Relaxed)
        };
        let mut work = Work { task: self, go_on: &go_on, analysed: AtomicUsize::new(0) };
        let mut proposals = self.synthesiser.proposals(&|part| go_on(sizing(Stage::Sizing, part)));
        if stopped.load(Ordering::Relaxed) {
            // What the family had found is kept, the best of it, although nothing more is begun.
            proposals.truncate(self.synthesiser.wanted().min(TOGETHER));
            work.go_on = &|_| true;
        }
        let (mut designs, rejected) = work.analysed(&proposals);
        work.go_on = &go_on;
        if !designs.iter().any(Designed::met) && !stopped.load(Ordering::Relaxed) {
            work.mend(&mut designs);
        }
        let met = designs.iter().any(Designed::met);
        let mut ways = Vec::new();
        if !met && !stopped.load(Ordering::Relaxed) {
            ways = work.ways();
            if designs.is_empty() {
                designs = work.analysed(&self.synthesiser.nearest(&|part| go_on(sizing(Stage::Loosening, part)))).0;
            }
        }
        rank(&mut designs);
        designs.retain(|d| !met || d.met());
        self.drop_alike(&mut designs);
        designs.truncate(if met { self.synthesiser.wanted() } else { 1 });
        let stem = self.path.file_stem().unwrap_or_default().to_string_lossy();
        for (index, design) in designs.iter_mut().enumerate() {
            design.file = format!("{stem}-{}-{}.toml", index + 1, design.proposal.topology);
            if let Some(led) = way(target, &self.path).and_then(|way| edit::with_base_from(&design.text, &way).ok()) {
                design.text = led;
            }
            design.report.input_name.clone_from(&design.file);
        }
        let best = designs.first().filter(|_| met && !stopped.load(Ordering::Relaxed));
        let compared = |part: f64| go_on(sizing(Stage::Comparing, part));
        let tables = best.map_or_else(Vec::new, |best| self.synthesiser.tables(&best.proposal, &compared));
        Synthesised {
            effort: self.synthesiser.effort(),
            tables,
            designs,
            ways,
            analysed: work.analysed.into_inner(),
            rejected,
            interrupted: stopped.into_inner(),
            diagnostics: self.diagnostics.clone(),
            sources: self.sources.clone(),
            title: self.title.clone(),
            family: self.family.clone(),
            input_sha256: self.input_sha256.clone(),
        }
    }
}

/// A part of the family's own work.
fn sizing(stage: Stage, part: f64) -> SynthesisProgress {
    let done = (0..PARTS).rev().find(|i| f64::from(*i) <= part * f64::from(PARTS)).unwrap_or(0);
    SynthesisProgress { stage, done: done as usize, of: PARTS as usize }
}

/// The first place in a table that stands in another source than the user's file.
fn foreign(item: &Item) -> Option<Span> {
    if item.span.source != SourceId::default() {
        return Some(item.span);
    }
    match &item.value {
        Value::Table(table) => table.entries.iter().find_map(|e| foreign(&e.item)),
        Value::List(list) => list.iter().find_map(foreign),
        _ => None,
    }
}

/// The title that a project gives itself.
fn title_of(project: &Project) -> String {
    match project.tree.get("title").map(|entry| &entry.item.value) {
        Some(Value::Text(title)) => title.clone(),
        _ => String::new(),
    }
}

fn no_synthesis(family: &str) -> Refused {
    let mut diagnostics = Diagnostics::default();
    let help = "draw the design yourself; `forcewright new --list` names examples to start from";
    diagnostics.push(Diagnostic::placeless("E0533", format!("{family} has no synthesis")).help(help));
    Refused { diagnostics, sources: Sources::default(), file_missing: false }
}

/// What meets everything first; of those the cheapest, a nearly equal cost weighed by the parts; of the others what misses least.
fn rank(designs: &mut [Designed]) {
    // A fiftieth of the cost for each part.
    let score = |d: &Designed| d.proposal.cost * (1.0 + 0.02 * d.proposal.parts as f64);
    let missed = |d: &Designed| if d.met() { 0.0 } else { shortfall(&d.report).max(f64::MIN_POSITIVE) };
    designs.sort_by(|a, b| missed(a).total_cmp(&missed(b)).then(score(a).total_cmp(&score(b))));
}

/// A synthesis on its way.
struct Work<'a> {
    task: &'a SynthesisTask,
    go_on: &'a (dyn Fn(SynthesisProgress) -> bool + Sync),
    analysed: AtomicUsize,
}

impl Work<'_> {
    /// Every proposal analysed and corrected, in their order whichever is done first, and those that are not fit.
    fn analysed(&self, proposals: &[Proposal]) -> (Vec<Designed>, Vec<(String, String)>) {
        let done = AtomicUsize::new(0);
        let one = |proposal: &Proposal| {
            let progress = |done| SynthesisProgress { stage: Stage::Analysing, done, of: proposals.len() };
            if !(self.go_on)(progress(done.load(Ordering::Relaxed))) {
                return None;
            }
            let found = self.corrected(proposal.clone());
            (self.go_on)(progress(done.fetch_add(1, Ordering::Relaxed) + 1));
            Some(found)
        };
        let all: Vec<_> = proposals.par_iter().map(one).collect();
        let (mut designs, mut rejected) = (Vec::new(), Vec::new());
        for (found, proposal) in all.into_iter().zip(proposals) {
            match found {
                Some(Ok(design)) => designs.push(design),
                Some(Err(why)) => rejected.push((proposal.title.clone(), why)),
                None => {}
            }
        }
        (designs, rejected)
    }

    /// A proposal, corrected until the family keeps it; why not, if it is not fit.
    fn corrected(&self, mut proposal: Proposal) -> Result<Designed, String> {
        let mut best: Option<Designed> = None;
        for _ in 0..MOST_ROUNDS {
            let (text, loaded) = self.written(&proposal)?;
            let report = loaded.solve(&loaded.name(), "", &mut |_| true);
            self.analysed.fetch_add(1, Ordering::Relaxed);
            let judgement = self.task.synthesiser.judge(&proposal, &report.outcome);
            let next = Designed { proposal: proposal.clone(), text, file: String::new(), report, searched: false };
            let better = |b: &Designed| (next.met(), -shortfall(&next.report)) >= (b.met(), -shortfall(&b.report));
            if !matches!(judgement, Judgement::Reject(_)) && best.as_ref().is_none_or(better) {
                best = Some(next);
            }
            match judgement {
                Judgement::Correct(corrected) => proposal = *corrected,
                Judgement::Keep => break,
                Judgement::Reject(why) => return best.ok_or(why),
            }
        }
        best.ok_or_else(|| "no correction came to an end".to_owned())
    }

    /// The project file of a proposal.
    fn written(&self, proposal: &Proposal) -> Result<(String, Loaded), String> {
        let text = edit::with_settings(&self.task.text, &proposal.settings, None).map_err(|e| e.to_string())?;
        let text = format!("{}\n{}", text.trim_end(), proposal.sections);
        let loaded = self.loaded(&text)?;
        Ok((text, loaded))
    }

    fn loaded(&self, text: &str) -> Result<Loaded, String> {
        let files = self.task.known.with(&self.task.path, text);
        Loaded::from_file(&files, &self.task.path, &Choices::default()).map_err(|e| e.render(false))
    }

    /// Searches on from designs that nearly meet everything, until one does.
    fn mend(&self, designs: &mut [Designed]) {
        rank(designs);
        let near = |d: &Designed| !d.met() && shortfall(&d.report) < NEARLY_MET;
        let chosen: Vec<usize> = (0..designs.len()).filter(|i| near(&designs[*i])).take(MOST_SEARCHES).collect();
        for (done, index) in chosen.iter().enumerate() {
            let progress = SynthesisProgress { stage: Stage::Searching, done, of: chosen.len() };
            if !(self.go_on)(progress) {
                return;
            }
            let design = &designs[*index];
            let Ok(loaded) = self.loaded(&design.text) else { continue };
            let files = self.task.known.with(&self.task.path, &design.text);
            let watch = |_: &forcewright_study::optimise::Progress| (self.go_on)(progress);
            let from = Beginnings { starts: Some(1), local: true, ..Beginnings::default() };
            let Ok(found) = loaded.optimise_from(&files, &self.task.path, from, &watch) else { continue };
            let (Some(text), Some(report)) = (found.text, found.after) else { continue };
            let sound = !matches!(self.task.synthesiser.judge(&design.proposal, &report.outcome), Judgement::Reject(_));
            let proposal = self.task.synthesiser.searched(&design.proposal, &report.parameters);
            let next = Designed { proposal, text, file: String::new(), report, searched: true };
            if sound && next.met() {
                designs[*index] = next;
                return;
            }
        }
    }

    /// The limits that, loosened alone, let a design meet everything: each at its nearest value, confirmed by a synthesis with it.
    fn ways(&self) -> Vec<Way> {
        let mut ways: Vec<Way> = Vec::new();
        for slack in SLACKS {
            let all = self.task.synthesiser.relaxations(slack, &|part| (self.go_on)(sizing(Stage::Loosening, part)));
            for (done, relaxation) in all.iter().enumerate() {
                if !(self.go_on)(SynthesisProgress { stage: Stage::Loosening, done, of: all.len() }) {
                    break;
                }
                let same = |w: &Way| w.relaxation.key == relaxation.key && w.relaxation.at_most == relaxation.at_most;
                let known = ways.iter().position(same);
                if known.is_some_and(|i| ways[i].confirmed) {
                    continue;
                }
                let way = Way { relaxation: relaxation.clone(), confirmed: self.granted(relaxation) };
                match known {
                    Some(i) if way.confirmed => ways[i] = way,
                    Some(_) => {}
                    None => ways.push(way),
                }
            }
        }
        ways.sort_by_key(|w| !w.confirmed);
        ways
    }

    /// Whether a design meets everything once a limit is loosened.
    fn granted(&self, relaxation: &Relaxation) -> bool {
        let setting = format!("{}={}", relaxation.key, relaxation.value);
        let Ok(text) = edit::with_settings(&self.task.text, &[setting], None) else { return false };
        let files = self.task.known.with(&self.task.path, &text);
        let Ok(task) = SynthesisTask::from_file(&files, &self.task.path, &[]) else { return false };
        let work = Work { task: &task, go_on: self.go_on, analysed: AtomicUsize::new(0) };
        let proposals = task.synthesiser.proposals(&|part| (self.go_on)(sizing(Stage::Loosening, part)));
        // So many at once, whatever the number of threads: the work done is part of the result.
        let found = proposals.chunks(TOGETHER).any(|some| {
            let met: Vec<bool> = some.par_chunks(1).map(|p| work.analysed(p).0.iter().any(Designed::met)).collect();
            met.contains(&true)
        });
        self.analysed.fetch_add(work.analysed.into_inner(), Ordering::Relaxed);
        found
    }
}

const fn code(code: &'static str, title: &'static str, text: &'static str) -> Explanation {
    Explanation { code, title, text }
}

/// Codes of syntheses.
pub(crate) const CODES: &[Explanation] = &[
    code(
        "E0530",
        "a synthesis lacks a requirement",
        "A synthesis sizes designs by what they must do, what they are made of and what can be made. It needs at least\n\n    [requirements]\n    force = { nominal = \"10 N\", band = \"5 %\" }\n    travel = \"6 mm\"\n    stress = { safety_factor = 1.5 }\n    [material]\n    use = \"POM-C\"\n    [synthesise]\n    thickness_min = \"0.5 mm\"\n\nThe thinnest beam depends on machine, tool and material: ask who makes the part. `room`, `depth`, `plates`, `rows`, `series` and `candidates` are optional.",
    ),
    code(
        "E0531",
        "an envelope without a drawing",
        "`requirements.envelope` is a box in the coordinates of a drawing. A synthesis makes the drawing: give the size of the room as `synthesise.room`, width and height of the whole mechanism with its pads and blocks, the height along the load. The files written have what is left of it for the beams as an envelope around their drawing, so that `solve` tests it.",
    ),
    code(
        "E0532",
        "a design from elsewhere",
        "A synthesis writes `[design]`, `[layout]`, `[load]` and `[optimise]`. What the file itself says there is left out with a notice (W0530); what `--set` or an extended file says would be laid over every design written, and is refused.",
    ),
    code(
        "E0533",
        "no synthesis",
        "The family of the file has no synthesis in this version. Draw the design and let `optimise` improve it.",
    ),
    code(
        "W0530",
        "sections that a synthesis writes itself",
        "The sections named are those that a synthesis writes. The files written have its own in their place; the file given stays as it is.",
    ),
];
