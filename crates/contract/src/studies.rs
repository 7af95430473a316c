//! The sections that studies read, the same for every family: `[optimise]` and `[tolerance]`.

use forcewright_base::diagnostics::{Diagnostic, Diagnostics, Span};
use forcewright_base::text::closest;
use forcewright_base::units::Quantity;

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
}

/// A search for a better design.
#[derive(Clone, Debug, Default)]
pub struct Optimise {
    /// What is made small or large.
    pub objective: Section<Objective>,
    /// The numbers that may change, by their paths or patterns of paths.
    pub variables: Vec<Member<Freedom>>,
    /// Number of starts.
    pub starts: Slot<u32>,
    /// Seed of the starts after the first.
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
const MOST_SAMPLES: f64 = 1e8;
/// How near a freedom comes to a smallest value that is excluded, as part of the distance of the present value.
const LEAST_PART: f64 = 1e-3;

impl Studies {
    /// Whether a path lies in one of these sections.
    pub fn hold(path: &str) -> bool {
        path.starts_with("optimise.") || path.starts_with("tolerance.")
    }

    /// Whether a path lies in one of these sections that the file does not have: its defaults mean nothing.
    pub fn lack(&self, path: &str) -> bool {
        let absent = if path.starts_with("optimise.") { self.optimise.present.is_none() } else { self.tolerance.present.is_none() };
        Self::hold(path) && absent
    }
}

impl Describe for Studies {
    fn describe(&mut self, v: &mut dyn Visitor) {
        self.optimise.describe(v, &Param::new("optimise", "A search for a better design: `forcewright optimise`."));
        self.tolerance.describe(v, &Param::new("tolerance", "The scatter of making: `forcewright tolerance`."));
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
        v.count(
            &Param::new("starts", "Searches: the first from the file, the others spread over the ranges.")
                .within(1.0, MOST_STARTS)
                .default("1"),
            &mut self.starts,
        );
        v.count(&Param::new("seed", "Seed of the starts after the first.").default("1"), &mut self.seed);
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
        v.text(&Param::new("minimise", "What is made small: a metric, or an objective of the family."), &mut self.minimise);
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

impl Optimise {
    /// The numbers that may change, each once, in the order of the design. Only the design may change, and the motor that is chosen for it:
    /// what is required, what it is made of and what happens to it stays.
    pub fn free(&self, numbers: &[Number], diagnostics: &mut Diagnostics) -> Vec<Free> {
        let mut found: Vec<Option<Free>> = vec![None; numbers.len()];
        for member in &self.variables {
            for index in chosen(&member.name, &["design", "motor"], numbers, diagnostics) {
                if let Some(free) = freedom(&member.value, &numbers[index], member.name.span, diagnostics) {
                    // The later, usually the narrower pattern, wins.
                    found[index] = Some(free);
                }
            }
        }
        found.into_iter().flatten().collect()
    }
}

/// The numbers that a pattern means; an error if it means none.
pub fn chosen(pattern: &Located<String>, roots: &[&str], numbers: &[Number], diagnostics: &mut Diagnostics) -> Vec<usize> {
    let eligible = |n: &Number| n.path.split('.').next().is_some_and(|root| roots.contains(&root));
    let found: Vec<usize> = (0..numbers.len()).filter(|i| eligible(&numbers[*i]) && matches(&pattern.value, &numbers[*i].path)).collect();
    if found.is_empty() {
        let all = || numbers.iter().filter(|n| eligible(n)).map(|n| n.path.as_str());
        let known = numbers.iter().any(|n| matches(&pattern.value, &n.path));
        let help = if known {
            // Sections that the file does not have are no help.
            let there = roots.iter().filter(|root| numbers.iter().any(|n| n.path.split('.').next() == Some(root)));
            format!("only numbers below {} take part", there.map(|r| format!("`{r}`")).collect::<Vec<_>>().join(" and "))
        } else {
            closest(&pattern.value, all()).map_or_else(
                || format!("paths are written as `{}`, with `*` for any member", all().next().unwrap_or("design.thickness")),
                |near| format!("did you mean `{near}`?"),
            )
        };
        diagnostics.push(
            Diagnostic::error("E0312", pattern.span, format!("`{}` means no number of this file", pattern.value))
                .label("no such number")
                .help(help),
        );
    }
    found
}

fn freedom(freedom: &Freedom, number: &Number, place: Span, diagnostics: &mut Diagnostics) -> Option<Free> {
    let (lower, upper) = match (&freedom.range, &freedom.within) {
        (Some(range), None) => match deferred_quantities(range, number.dimension, diagnostics)?[..] {
            [low, high] if low < high => (low, high),
            _ => {
                diagnostics.push(
                    Diagnostic::error("E0204", range.span, "a range is a smaller and a larger value")
                        .help("write it as `range = [\"low\", \"high\"]`"),
                );
                return None;
            }
        },
        (None, Some(within)) => match deferred_quantities(within, number.dimension, diagnostics)?[..] {
            [width] if width > 0.0 => (number.si - width, number.si + width),
            _ => {
                diagnostics.push(
                    Diagnostic::error("E0204", within.span, "`within` is one positive value").help("write it as `within = \"5 mm\"`"),
                );
                return None;
            }
        },
        _ => {
            diagnostics.push(
                Diagnostic::error("E0302", place, "how far may it change?")
                    .label("this variable")
                    .help("give either `range = [\"low\", \"high\"]` or `within = \"5 mm\"`"),
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
