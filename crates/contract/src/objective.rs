//! From the words of `[optimise.objective]` to one of the goals that a family has.

use std::fmt::Write as _;

use forcewright_base::diagnostics::{Diagnostic, Diagnostics};
use forcewright_base::text::closest;

use crate::describe::{Located, Section};
use crate::studies::Objective;

/// What a family can make small or large.
#[derive(Debug)]
pub struct Goal {
    /// Its name.
    pub name: &'static str,
    /// What it is.
    pub doc: &'static str,
    /// Which way has a best value.
    pub way: Way,
}

/// What can be optimised of one kind of design of a family.
#[derive(Clone, Copy, Debug)]
pub struct Objectives {
    /// Designs of this kind, in words; empty where the family has one kind.
    pub of: &'static str,
    /// What can be made small or large.
    pub goals: &'static [Goal],
}

/// Objectives as a section in Markdown; nothing where there are none.
pub fn markdown(all: &[Objectives]) -> String {
    if all.is_empty() {
        return String::new();
    }
    let mut text = "\n## Objectives\n\nWhat `optimise.objective` can make small (`minimise`) or large (`maximise`).\n".to_owned();
    for Objectives { of, goals } in all {
        if !of.is_empty() {
            let _ = write!(text, "\nOf {of}:\n");
        }
        text.push_str("\n| objective | sense | meaning |\n| --- | --- | --- |\n");
        for Goal { name, doc, way } in *goals {
            let sense = match way {
                Way::Small => "`minimise`",
                Way::Large => "`maximise`",
                Way::Either => "either",
            };
            let _ = writeln!(text, "| `{name}` | {sense} | {} |", doc.replace('|', "\\|"));
        }
    }
    text
}

/// An objective of each kind, as it is written: `objective = { minimise = "mass" }`.
pub fn advice(all: &[Objectives]) -> String {
    let one = |Objectives { of, goals }: &Objectives| {
        let goal = goals.first()?;
        let sense = if goal.way == Way::Small { "minimise" } else { "maximise" };
        let kind = if of.is_empty() { String::new() } else { format!(" (of {of})") };
        Some(format!("`objective = {{ {sense} = \"{}\" }}`{kind}", goal.name))
    };
    all.iter().filter_map(one).collect::<Vec<_>>().join(" or ")
}

/// Which way a goal has a best value.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Way {
    /// As small as possible.
    Small,
    /// As large as possible.
    Large,
    /// Either, as asked.
    Either,
}

/// The goal that `[optimise.objective]` asks for, and whether it is made large; what is wrong with it is reported.
pub fn goal_of(objective: &Section<Objective>, goals: &'static [Goal], diagnostics: &mut Diagnostics) -> Option<(&'static str, bool)> {
    let place = objective.present.as_ref().map(|p| p.span).unwrap_or_default();
    let refused = match (&objective.minimise, &objective.maximise) {
        (Some(slot), None) => return meant(slot, false, goals, diagnostics),
        (None, Some(slot)) => return meant(slot, true, goals, diagnostics),
        (Some(_), Some(other)) => Diagnostic::error("E0305", other.span, "`minimise` and `maximise` exclude each other")
            .label("the second of two")
            .help("keep one"),
        (None, None) => {
            let first = goals.first().map_or("", |g| g.name);
            Diagnostic::error("E0302", place, "the objective says nothing")
                .label("this table")
                .help(format!("give `minimise = \"{first}\"` or another; {}", listed(goals)))
        }
    };
    diagnostics.push(refused);
    None
}

/// The goal of a name.
fn meant(slot: &Located<String>, large: bool, goals: &'static [Goal], diagnostics: &mut Diagnostics) -> Option<(&'static str, bool)> {
    let Some(goal) = goals.iter().find(|g| g.name == slot.value) else {
        let near = closest(&slot.value, goals.iter().map(|g| g.name));
        let help = near.map_or_else(|| listed(goals), |near| format!("did you mean `{near}`?"));
        let error = Diagnostic::error("E0315", slot.span, format!("`{}` cannot be optimised", slot.value));
        diagnostics.push(error.label("no objective").help(help));
        return None;
    };
    if goal.way == if large { Way::Small } else { Way::Large } {
        let (right, wrong) = if large { ("minimise", "maximise") } else { ("maximise", "minimise") };
        diagnostics.push(
            Diagnostic::error("E0315", slot.span, format!("`{}` has no best value that way", goal.name))
                .label("the wrong way round")
                .help(format!("write `{right} = \"{}\"` instead of `{wrong}`", goal.name)),
        );
        return None;
    }
    Some((goal.name, large))
}

fn listed(goals: &[Goal]) -> String {
    goals.iter().map(|g| format!("`{}`: {}", g.name, g.doc)).collect::<Vec<_>>().join("; ")
}
