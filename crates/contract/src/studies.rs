//! The sections that studies read, the same for every family: `[optimise]`, `[pareto]`, `[tolerance]`, `[measurements]` and `[calibrate]`.

use forcewright_base::diagnostics::{Diagnostic, Diagnostics, Span};
use forcewright_base::text::closest;
use forcewright_base::units::Quantity;

use crate::calibration::{Calibrate, Measurements};
use crate::data::DataFile;
use crate::describe::{Describe, Form, Located, Member, Param, Section, Slot, Visitor, Word};
use crate::numbers::{Number, matches};
use crate::read::deferred_quantities;
use crate::tree::Value;

/// What studies are asked for. A family shows it with its own description.
#[derive(Clone, Debug, Default)]
pub struct Studies {
    /// `[optimise]`
    pub optimise: Section<Optimise>,
    /// `[tolerance]`
    pub tolerance: Section<Tolerance>,
    /// `[measurements]`
    pub measurements: Section<Measurements>,
    /// `[calibrate]`
    pub calibrate: Section<Calibrate>,
    /// `[pareto]`
    pub pareto: Section<Pareto>,
}

/// A search for the designs of which none is better in every goal.
#[derive(Clone, Debug, Default)]
pub struct Pareto {
    /// Metrics that are made small.
    pub minimise: Slot<Vec<Located<String>>>,
    /// Metrics that are made large.
    pub maximise: Slot<Vec<Located<String>>>,
    /// What may change, by its path as for `--set`.
    pub vary: Vec<Member<Varied>>,
    /// Which checks a design must keep.
    pub checks: Slot<&'static str>,
    /// Designs of a generation.
    pub population: Slot<u32>,
    /// Generations after the first.
    pub generations: Slot<u32>,
    /// Seed of the random numbers.
    pub seed: Slot<u32>,
}

/// The values that something may have.
#[derive(Clone, Debug, Default)]
pub struct Varied {
    /// From the first to the second value.
    pub range: Slot<Value>,
    /// In steps of this from the first on.
    pub step: Slot<Value>,
    /// One of these.
    pub among: Slot<Value>,
}

/// A search for a better design.
#[derive(Clone, Debug, Default)]
pub struct Optimise {
    /// What is made small or large.
    pub objective: Section<Objective>,
    /// The numbers that may change, by their paths or patterns of paths.
    pub variables: Vec<Member<Freedom>>,
    /// How designs are searched for.
    pub search: Slot<&'static str>,
    /// Number of starts.
    pub starts: Slot<u32>,
    /// Designs that a search of the whole range computes at most.
    pub evaluations: Slot<u32>,
    /// Seed of the starts after the first, or of the search of the whole range.
    pub seed: Slot<u32>,
    /// How far inside its limits the design is kept.
    pub margin: Slot<Quantity>,
    /// Against what of the scatter of making its limits are kept.
    pub robust: Slot<&'static str>,
    /// The part of the designs that keep each limit.
    pub percentile: Slot<Quantity>,
}

/// What is made small or large.
#[derive(Clone, Debug, Default)]
pub struct Objective {
    /// A metric, or what the family calls an objective.
    pub minimise: Slot<String>,
    /// The same, made large.
    pub maximise: Slot<String>,
    /// The stretch of the travel that counts.
    pub window: Slot<Value>,
    /// A curve to come near to.
    pub target: Slot<Value>,
    /// The same from a file.
    pub target_file: Slot<DataFile>,
}

/// How far a number may change.
#[derive(Clone, Debug, Default)]
pub struct Freedom {
    /// From the first to the second value.
    pub range: Slot<Value>,
    /// At most this far from the value in the file.
    pub within: Slot<Value>,
    /// What can be had: in such steps from the smallest value on.
    pub step: Slot<Value>,
    /// What can be had: one of these.
    pub among: Slot<Value>,
}

/// The scatter of making.
#[derive(Clone, Debug, Default)]
pub struct Tolerance {
    /// Number of designs drawn.
    pub samples: Slot<u32>,
    /// Seed of the draws.
    pub seed: Slot<u32>,
    /// Distribution of every `±` that names none.
    pub distribution: Slot<&'static str>,
    /// The yield that is asked for.
    pub target: Slot<Quantity>,
    /// Numbers that scatter without a `±` of their own, or otherwise, by their paths or patterns of paths.
    pub parameters: Vec<Member<Scatter>>,
    /// Numbers that scatter together.
    pub groups: Vec<Member<Group>>,
}

/// How a number scatters.
#[derive(Clone, Debug, Default)]
pub struct Scatter {
    /// Half width, as behind `±`.
    pub half_width: Slot<Value>,
    /// Its distribution.
    pub distribution: Slot<&'static str>,
}

/// Numbers that scatter together.
#[derive(Clone, Debug, Default)]
pub struct Group {
    /// Paths or patterns of paths.
    pub members: Slot<Vec<Located<String>>>,
    /// Correlation of any two of them.
    pub correlation: Slot<Quantity>,
}

/// Distributions of a `±`.
pub const DISTRIBUTIONS: &[Word] = &[
    Word { word: "normal", doc: "± is three standard deviations" },
    Word { word: "uniform", doc: "evenly between the two ends" },
    Word { word: "triangular", doc: "from the ends to the middle" },
];

/// Which checks the designs of a trade-off must keep.
pub const KEPT: &[Word] = &[
    Word { word: "all", doc: "the requirements of the file, and every check that the family makes by itself" },
    Word { word: "required", doc: "the requirements of the file" },
];

/// How designs are searched for.
pub const SEARCHES: &[Word] = &[
    Word { word: "gradient", doc: "downhill from each start, by exact derivatives" },
    Word {
        word: "global",
        doc: "the whole range without derivatives (CMA-ES with restarts), then downhill from the best places; for rough landscapes with many basins",
    },
];

/// What a design is kept against.
pub const ROBUST: &[Word] = &[
    Word { word: "no", doc: "the design as it is meant" },
    Word { word: "percentile", doc: "each limit is kept by `percentile` of the designs made" },
    Word { word: "worst_case", doc: "each limit is kept at the worst ends of all tolerances at once" },
];

/// What numbers are free for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Purpose {
    /// A search: what is bound to a line stays on it.
    Search,
    /// The scatter of making, which keeps to nothing.
    Scatter,
}

/// Most starts and most samples.
const MOST_STARTS: f64 = 1e5;
/// Fewest and most designs of a search of the whole range.
const EVALUATIONS: [f64; 2] = [100.0, 1e8];
/// Designs of a search of the whole range, without a word.
pub const USUAL_EVALUATIONS: u32 = 10_000;
const MOST_SAMPLES: f64 = 1e8;
/// Most goals, and largest populations and most generations of a trade-off.
const MOST_GOALS: usize = 3;
const MOST_PEOPLE: f64 = 1e4;
/// How near a freedom comes to a smallest value that is excluded, as part of the distance of the present value.
const LEAST_PART: f64 = 1e-3;

impl Studies {
    /// Whether a path lies in one of these sections.
    pub fn hold(path: &str) -> bool {
        matches!(path.split_once('.'), Some(("optimise" | "pareto" | "tolerance" | "measurements" | "calibrate", _)))
    }

    /// Whether a path lies in one of these sections that the file does not have: its defaults mean nothing.
    pub fn lack(&self, path: &str) -> bool {
        let present = match path.split_once('.') {
            Some(("optimise", _)) => &self.optimise.present,
            Some(("pareto", _)) => &self.pareto.present,
            Some(("tolerance", _)) => &self.tolerance.present,
            Some(("measurements", _)) => &self.measurements.present,
            Some(("calibrate", _)) => &self.calibrate.present,
            _ => return false,
        };
        present.is_none()
    }

    /// Shows the sections, with what a family measures otherwise among the tables of `[measurements]`.
    pub fn describe_with(&mut self, v: &mut dyn Visitor, own: &mut dyn FnMut(&mut dyn Visitor)) {
        self.optimise.describe(v, &Param::new("optimise", "A search for a better design: `forcewright optimise`."));
        self.tolerance.describe(v, &Param::new("tolerance", "The scatter of making: `forcewright tolerance`."));
        self.pareto.describe(v, &Param::new("pareto", "Several goals at once: `forcewright pareto`."));
        let Section { present, body } = &mut self.measurements;
        v.section(&Param::new("measurements", "Curves that were measured: `forcewright calibrate`."), present, &mut |v| {
            own(v);
            body.describe(v);
        });
        self.calibrate.describe(v, &Param::new("calibrate", "Parameters from a measured curve: `forcewright calibrate`."));
    }
}

impl Describe for Studies {
    fn describe(&mut self, v: &mut dyn Visitor) {
        self.describe_with(v, &mut |_| {});
    }
}

impl Describe for Pareto {
    fn describe(&mut self, v: &mut dyn Visitor) {
        v.names(&Param::new("minimise", "Metrics that are made small."), 0, MOST_GOALS, &mut self.minimise);
        let doc = "Metrics that are made large. Two goals in all, or three.";
        v.names(&Param::new("maximise", doc), 0, MOST_GOALS, &mut self.maximise);
        v.members(
            &Param::new("vary", "What may change: a path as for `--set`, with its values; `\"design.cables.1.use\"`.").required(),
            Form::Table,
            &mut self.vary,
        );
        v.choice(&Param::new("checks", "Which checks every design of the front must keep.").default("all"), KEPT, &mut self.checks);
        v.count(&Param::new("population", "Designs of a generation.").within(4.0, MOST_PEOPLE).default("40"), &mut self.population);
        v.count(&Param::new("generations", "Generations after the first.").within(0.0, MOST_PEOPLE).default("40"), &mut self.generations);
        v.count(&Param::new("seed", "Seed of the random numbers.").default("1"), &mut self.seed);
    }
}

impl Describe for Varied {
    fn describe(&mut self, v: &mut dyn Visitor) {
        let doc = "Smallest and largest value, `[\"8 mm\", \"12 mm\"]`; of what is counted, whole numbers, `[12, 30]`.";
        v.deferred(&Param::new("range", doc), &mut self.range);
        v.deferred(&Param::new("step", "With `range`: only values in such steps from the smallest on."), &mut self.step);
        v.deferred(&Param::new("among", "One of some values or words, `[\"0.8 mm\", \"1 mm\"]`."), &mut self.among);
    }
}

impl Describe for Optimise {
    fn describe(&mut self, v: &mut dyn Visitor) {
        self.objective.describe(v, &Param::new("objective", "What is made small or large.").required());
        v.members(
            &Param::new("variables", "What may change: a path, or a pattern with `*`, with its freedom; `\"design.beams.*.bend\"`.")
                .required(),
            Form::Table,
            &mut self.variables,
        );
        v.choice(&Param::new("search", "How designs are searched for.").default("gradient"), SEARCHES, &mut self.search);
        v.count(
            &Param::new(
                "starts",
                "With `search = \"gradient\"`: searches, the first from the file, others spread over the ranges, later ones near the best.",
            )
            .within(1.0, MOST_STARTS)
            .default("1"),
            &mut self.starts,
        );
        v.count(
            &Param::new("evaluations", "With `search = \"global\"`: designs that are computed at most before the searches downhill.")
                .within(EVALUATIONS[0], EVALUATIONS[1])
                .default("10000"),
            &mut self.evaluations,
        );
        v.count(&Param::new("seed", "Seed of the starts after the first, or of the global search.").default("1"), &mut self.seed);
        v.quantity(
            &Param::new("margin", "How far inside its limits the design is kept, relative to each limit.").within(0.0, 0.5).default("0"),
            &mut self.margin,
        );
        v.choice(
            &Param::new("robust", "Keep every limit in spite of the scatter of making (`±` and `[tolerance]`).").default("no"),
            ROBUST,
            &mut self.robust,
        );
        v.quantity(
            &Param::new("percentile", "With `robust = \"percentile\"`: the part of the designs made that keep each limit.")
                .within(0.5, 0.999_999)
                .default("95 %"),
            &mut self.percentile,
        );
    }
}

impl Describe for Objective {
    fn describe(&mut self, v: &mut dyn Visitor) {
        v.text(
            &Param::new("minimise", "What is made small: an objective of the family; they are listed below all keys."),
            &mut self.minimise,
        );
        v.text(&Param::new("maximise", "What is made large."), &mut self.maximise);
        v.deferred(&Param::new("window", "The stretch of the travel that counts, `[\"from\", \"to\"]`."), &mut self.window);
        v.deferred(&Param::new("target", "The curve to come near to, `[[\"2 mm\", \"5 N\"], …]`."), &mut self.target);
        let doc = "The same from a CSV file: displacement and force, with units in the header, `travel / mm, force / N`.";
        v.file(&Param::new("target_file", doc), &mut self.target_file);
    }
}

impl Describe for Freedom {
    fn describe(&mut self, v: &mut dyn Visitor) {
        v.deferred(
            &Param::new("range", "Smallest and largest value, `[\"0.8 mm\", \"1.2 mm\"]`, or bare where the number is."),
            &mut self.range,
        );
        v.deferred(&Param::new("within", "Largest distance from the value in the file."), &mut self.within);
        let doc = "With `range`: what can be had comes in such steps from the smallest value on; the optimum is rounded to it.";
        v.deferred(&Param::new("step", doc), &mut self.step);
        let doc = "In place of `range`: what can be had is one of these, `[\"0.8 mm\", \"1 mm\"]`; the optimum is rounded to it.";
        v.deferred(&Param::new("among", doc), &mut self.among);
    }
}

impl Describe for Tolerance {
    fn describe(&mut self, v: &mut dyn Visitor) {
        v.count(&Param::new("samples", "Designs drawn.").within(64.0, MOST_SAMPLES).default("4096"), &mut self.samples);
        v.count(&Param::new("seed", "Seed of the draws.").default("1"), &mut self.seed);
        v.choice(
            &Param::new("distribution", "Distribution of every `±` that names none.").default("normal"),
            DISTRIBUTIONS,
            &mut self.distribution,
        );
        v.quantity(&Param::new("target", "The yield asked for.").within(0.01, 0.999_999).default("95 %"), &mut self.target);
        v.members(
            &Param::new("parameters", "What scatters without a `±` of its own, or otherwise: a path, or a pattern with `*`."),
            Form::Table,
            &mut self.parameters,
        );
        v.members(&Param::new("groups", "Numbers that scatter together."), Form::Table, &mut self.groups);
    }
}

impl Describe for Scatter {
    fn describe(&mut self, v: &mut dyn Visitor) {
        v.deferred(&Param::new("half_width", "Half width, as behind `±`; without it that of the file."), &mut self.half_width);
        v.choice(&Param::new("distribution", "Its distribution."), DISTRIBUTIONS, &mut self.distribution);
    }
}

impl Describe for Group {
    fn describe(&mut self, v: &mut dyn Visitor) {
        v.names(&Param::new("members", "Paths, or patterns of paths.").required(), 1, 64, &mut self.members);
        v.quantity(
            &Param::new("correlation", "Correlation of any two of them; 1 moves them as one.").within(-1.0, 1.0).required(),
            &mut self.correlation,
        );
    }
}

/// A number that may change, and how far.
#[derive(Clone, Debug)]
pub struct Free {
    /// The number.
    pub number: Number,
    /// Smallest value, SI.
    pub lower: f64,
    /// Largest value, SI.
    pub upper: f64,
}

/// Where numbers stand that a search may change.
const SEARCHED: &[&str] = &["design", "motor"];

impl Optimise {
    /// Whether the whole range is searched.
    pub fn global(&self) -> bool {
        self.search.as_ref().is_some_and(|s| s.value == "global")
    }

    /// The numbers that may change, each once, in the order of the design. Only the design may change, and the motor that is chosen for it:
    /// what is required, what it is made of and what happens to it stays.
    pub fn free(&self, numbers: &[Number], diagnostics: &mut Diagnostics) -> Vec<Free> {
        let mut found: Vec<Option<Free>> = vec![None; numbers.len()];
        for member in &self.variables {
            for index in chosen(&member.name, SEARCHED, numbers, diagnostics) {
                if let Some(free) = freedom(&member.value, &numbers[index], member.name.span, diagnostics) {
                    // The later, usually the narrower pattern, wins.
                    found[index] = Some(free);
                }
            }
        }
        found.into_iter().flatten().collect()
    }
}

/// A number that can only be had in some sizes.
#[derive(Clone, Debug)]
pub struct Sized {
    /// Its path.
    pub path: String,
    sizes: Sizes,
}

#[derive(Clone, Debug)]
enum Sizes {
    /// From a smallest value in steps to a largest, SI.
    Steps { from: f64, step: f64, to: f64 },
    /// These, ascending, SI.
    List(Vec<f64>),
}

/// Part of a step by which a range may miss a whole number of them, and a value a size.
const SAME_SIZE: f64 = 1e-6;
/// Part of a range below which a step is none.
const LEAST_STEP: f64 = 1e-6;

impl Sized {
    /// The sizes next to a value, SI: the largest that is not above and the smallest that is not below; one where they are the same, or
    /// where it lies beyond all.
    pub fn around(&self, si: f64) -> Vec<f64> {
        let (below, above) = match &self.sizes {
            Sizes::Steps { from, step, to } => {
                let last = ((to - from) / step + SAME_SIZE).floor();
                let place = ((si - from) / step).clamp(0.0, last);
                let rest = place - place.floor();
                let [low, high] = if (SAME_SIZE..=1.0 - SAME_SIZE).contains(&rest) {
                    [place.floor(), place.ceil().min(last)]
                } else {
                    [place.round(); 2]
                };
                (from + low * step, from + high * step)
            }
            Sizes::List(sizes) => {
                let (first, last) = (sizes.first().copied().unwrap_or(si), sizes.last().copied().unwrap_or(si));
                let near = |size: f64| (size - si).abs() <= SAME_SIZE * (last - first);
                let below = sizes.iter().copied().filter(|s| *s <= si || near(*s)).fold(first, f64::max);
                let above = sizes.iter().copied().filter(|s| *s >= si || near(*s)).fold(last, f64::min);
                if near(below) {
                    (below, below)
                } else if near(above) {
                    (above, above)
                } else {
                    (below, above)
                }
            }
        };
        if above > below { vec![below, above] } else { vec![below] }
    }
}

impl Optimise {
    /// The numbers that may change in sizes only, in the order of the design.
    pub fn sized(&self, numbers: &[Number], diagnostics: &mut Diagnostics) -> Vec<Sized> {
        let mut found: Vec<Option<Sized>> = vec![None; numbers.len()];
        for member in &self.variables {
            // What a pattern lacks is said where ranges are read.
            for index in chosen(&member.name, SEARCHED, numbers, &mut Diagnostics::default()) {
                // As with ranges, the later pattern wins.
                found[index] =
                    sizes(&member.value, &numbers[index], diagnostics).map(|sizes| Sized { path: numbers[index].path.clone(), sizes });
            }
        }
        found.into_iter().flatten().collect()
    }
}

fn sizes(freedom: &Freedom, number: &Number, diagnostics: &mut Diagnostics) -> Option<Sizes> {
    if let Some(among) = &freedom.among {
        let mut all = deferred_quantities(among, number.dimension, diagnostics)?;
        all.sort_by(f64::total_cmp);
        return Some(Sizes::List(all));
    }
    let step = freedom.step.as_ref()?;
    let mut refuse = |message: &str| {
        let help = "write it as `range = [\"0.8 mm\", \"1.2 mm\"], step = \"0.1 mm\"`";
        diagnostics.push(Diagnostic::error("E0204", step.span, message).label("this step").help(help));
    };
    let Some(range) = &freedom.range else {
        refuse("a step belongs to a `range`");
        return None;
    };
    let mut unsaid = Diagnostics::default();
    // What is wrong with the range is said where it is read.
    let ends = deferred_quantities(range, number.dimension, &mut unsaid)?;
    let [from, to] = ends[..] else { return None };
    match deferred_quantities(step, number.dimension, &mut unsaid).as_deref() {
        Some([step]) if *step > LEAST_STEP * (to - from) && *step <= to - from => Some(Sizes::Steps { from, step: *step, to }),
        _ => {
            refuse("a step is one positive value of the quantity of its range, at most as long, and more than a millionth of it");
            None
        }
    }
}

/// The numbers that a pattern means; an error if it means none.
pub fn chosen(pattern: &Located<String>, roots: &[&str], numbers: &[Number], diagnostics: &mut Diagnostics) -> Vec<usize> {
    let eligible = |n: &Number| n.path.split('.').next().is_some_and(|root| roots.contains(&root));
    let found: Vec<usize> = (0..numbers.len()).filter(|i| eligible(&numbers[*i]) && matches(&pattern.value, &numbers[*i].path)).collect();
    if found.is_empty() {
        // Numbers of a bench stand in no list: they are those of its measurement.
        let bench: &[&str] = if roots.contains(&"bench") { &["bench.offset.x", "bench.offset.y", "bench.compliance"] } else { &[] };
        let all = || numbers.iter().filter(|n| eligible(n)).map(|n| n.path.as_str()).chain(bench.iter().copied());
        let known = numbers.iter().any(|n| matches(&pattern.value, &n.path));
        let help = if known {
            // Sections that the file does not have are no help.
            let there = |root: &&&str| **root == "bench" || numbers.iter().any(|n| n.path.split('.').next() == Some(root));
            let there: Vec<String> = roots.iter().filter(there).map(|r| format!("`{r}`")).collect();
            let there = there.split_last().map_or_else(String::new, |(last, others)| {
                if others.is_empty() { last.clone() } else { format!("{} and {last}", others.join(", ")) }
            });
            format!("only numbers below {there} take part")
        } else {
            closest(&pattern.value, all()).map_or_else(
                || format!("paths are written as `{}`, with `*` for any member", all().next().unwrap_or("design.thickness")),
                |near| format!("did you mean `{near}`?"),
            )
        };
        diagnostics.push(
            if known {
                Diagnostic::error("E0312", pattern.span, format!("`{}` takes no part in this study", pattern.value))
                    .label("not this number")
            } else {
                let message = format!("`{}` means no number of this file", pattern.value);
                Diagnostic::error("E0312", pattern.span, message).label("no such number")
            }
            .help(help),
        );
    }
    found
}

fn freedom(freedom: &Freedom, number: &Number, place: Span, diagnostics: &mut Diagnostics) -> Option<Free> {
    let (lower, upper) = match (&freedom.range, &freedom.within, &freedom.among) {
        (Some(range), None, None) => match deferred_quantities(range, number.dimension, diagnostics)?[..] {
            [low, high] if low < high => (low, high),
            _ => {
                diagnostics.push(
                    Diagnostic::error("E0204", range.span, "a range is a smaller and a larger value")
                        .help("write it as `range = [\"low\", \"high\"]`"),
                );
                return None;
            }
        },
        (None, Some(within), None) => match deferred_quantities(within, number.dimension, diagnostics)?[..] {
            [width] if width > 0.0 => (number.si - width, number.si + width),
            _ => {
                diagnostics.push(
                    Diagnostic::error("E0204", within.span, "`within` is one positive value").help("write it as `within = \"5 mm\"`"),
                );
                return None;
            }
        },
        (None, None, Some(among)) => {
            let sizes = deferred_quantities(among, number.dimension, diagnostics)?;
            let ends = (sizes.iter().copied().fold(f64::INFINITY, f64::min), sizes.iter().copied().fold(f64::NEG_INFINITY, f64::max));
            if sizes.len() < 2 || ends.0 >= ends.1 {
                diagnostics.push(
                    Diagnostic::error("E0204", among.span, "there is nothing to choose from")
                        .help("write two values or more, `among = [\"0.8 mm\", \"1 mm\"]`"),
                );
                return None;
            }
            ends
        }
        _ => {
            diagnostics.push(
                Diagnostic::error("E0302", place, "how far may it change?")
                    .label("this variable")
                    .help("give either `range = [\"low\", \"high\"]`, `within = \"5 mm\"` or `among = [\"0.8 mm\", \"1 mm\"]`"),
            );
            return None;
        }
    };
    // A smallest value that is itself excluded is approached to a part of the distance to it.
    let least = number.range.min + if number.range.above { LEAST_PART * (number.si - number.range.min) } else { 0.0 };
    let (lower, upper) = (lower.max(least), upper.min(number.range.max));
    if !(lower..=upper).contains(&number.si) {
        diagnostics.push(
            Diagnostic::error(
                "E0204",
                freedom.range.as_ref().map_or(place, |r| r.span),
                format!("`{}` does not lie in its range", number.path),
            )
            .label("this range")
            .related(number.span, "its value")
            .help("the search starts at the value in the file: change it, or the range"),
        );
        return None;
    }
    Some(Free { number: number.clone(), lower, upper })
}
