//! The designs as lines over parallel axes: a number varied or a goal each.

use forcewright_base::text::visible;
use forcewright_report::study::{Parallel, ParallelAxis, ParallelLine, ParallelRank, ParallelScale};

use super::pages::anchor;
use super::{Choice, Pareto};

impl Pareto {
    /// The picture; none where no design keeps every limit.
    pub(super) fn lines(&self) -> Option<Parallel> {
        if !self.met() {
            return None;
        }
        let words: Vec<Vec<String>> = self.choices.iter().enumerate().map(|(at, choice)| self.words(at, choice)).collect();
        let varied = self.choices.iter().zip(&words).map(|(choice, words)| ParallelAxis {
            name: choice.key.clone(),
            sense: String::new(),
            scale: choice.unit().map_or_else(|| ParallelScale::Words(words.clone()), ParallelScale::Number),
        });
        let goals = self.goals.iter().map(|goal| ParallelAxis {
            name: goal.name.clone(),
            sense: if goal.large { "maximise" } else { "minimise" }.to_owned(),
            scale: ParallelScale::Number(goal.unit.clone()),
        });
        let value = |at: usize, text: &str| {
            let choice = &self.choices[at];
            let word = || words[at].iter().position(|w| *w == visible(text)).map(|i| i as f64);
            if choice.unit().is_some() { choice.si(text) } else { word() }
        };
        let designs = self.designs.iter().enumerate().map(|(at, design)| {
            let own = design.values.iter().enumerate().map(|(i, text)| value(i, text));
            let goals = self.goals.iter().zip(&design.goals).map(|(g, v)| format!("{} {}", g.name, self.goal_text(g, *v)));
            ParallelLine {
                values: own.chain(design.goals.iter().map(|v| Some(*v))).collect(),
                label: format!("Design {}: {}", at + 1, goals.collect::<Vec<_>>().join(", ")),
                leads_to: Some(anchor(at)),
                rank: if design.file.is_some() { ParallelRank::Picked } else { ParallelRank::Others },
            }
        });
        let of_file = self.present.iter().enumerate().map(|(i, text)| text.as_deref().and_then(|text| value(i, text)));
        let its_goals = self.goals.iter().map(|goal| self.before.outcome.metric(&goal.name).map(|m| m.value).filter(|v| v.is_finite()));
        let present = ParallelLine {
            values: of_file.chain(its_goals).collect(),
            label: "The design to begin with".to_owned(),
            leads_to: None,
            rank: ParallelRank::Present,
        };
        Some(Parallel {
            id: "lines",
            title: "What goes with what".to_owned(),
            caption: "Each line is a design and leads to its row of the table: it crosses every axis at its value, those of what was varied \
                      first, then the goals. Where lines between two axes run side by side, the one grows with the other; where they cross, it \
                      falls. Dashed, the design of the project file."
                .to_owned(),
            axes: varied.chain(goals).collect(),
            lines: designs.chain([present]).collect(),
            names: ["designs of the front".to_owned(), "those with a project file".to_owned(), "the design to begin with".to_owned()],
        })
    }

    /// The words of a choice: those of its list, and that of the file.
    fn words(&self, at: usize, choice: &Choice) -> Vec<String> {
        let listed = choice.telling();
        let own = self.present.get(at).cloned().flatten();
        let own = own.filter(|own| !listed.contains(own));
        listed.iter().chain(&own).map(|word| visible(word).into_owned()).collect()
    }
}
