//! Synthesis: from what a mechanism must do to designs that may do it, as a family offers them.
//!
//! A family knows shapes and how they scale; the library completes the user's file with what a family proposes, analyses it in full, has
//! it corrected, and ranks what keeps every requirement. Neither needs to know more of the other.

use forcewright_model::{Outcome, ParameterRow, StudyTable};

/// How a file without a design is made one that can be understood.
#[derive(Clone, Copy, Debug)]
pub struct Skeleton {
    /// The sections that a synthesis writes: what a file says there is not looked at.
    pub roots: &'static [&'static str],
    /// Those sections, well formed, of no particular design.
    pub sections: &'static str,
}

/// A design that a family proposes.
#[derive(Clone, Debug)]
pub struct Proposal {
    /// Name of its shape, fit for a file name.
    pub topology: &'static str,
    /// The same for people.
    pub title: String,
    /// The sections that complete the user's file, with comments on where the shape comes from.
    pub sections: String,
    /// Settings `KEY=VALUE` of other sections that go with them.
    pub settings: Vec<String>,
    /// Its sizes: name and text.
    pub sizes: Vec<(&'static str, String)>,
    /// Numbers of the family's own, from which it corrects the proposal.
    pub state: Vec<f64>,
    /// What the family ranks by, small is good: the room that it takes, m³.
    pub cost: f64,
    /// How many parts it is drawn of: of two that cost nearly the same the simpler one is better.
    pub parts: usize,
}

/// What a family says of a proposal that was analysed in full.
#[derive(Clone, Debug)]
pub enum Judgement {
    /// As good as the family can make it.
    Keep,
    /// Better so.
    Correct(Box<Proposal>),
    /// Not fit to be made, whatever the requirements say; why.
    Reject(String),
}

/// One limit that, loosened alone, lets something be proposed.
#[derive(Clone, Debug, PartialEq)]
pub struct Relaxation {
    /// Its key in the project file.
    pub key: &'static str,
    /// For people: `safety factor`.
    pub name: &'static str,
    /// Its value as in the file: `1.2`, `"6.1 mm"`, `["95 mm", "70 mm"]`.
    pub value: String,
    /// For people: `1.2`, `6.1 mm`, `95 mm × 70 mm`.
    pub text: String,
    /// What is asked for now, for people; empty if nothing is.
    pub now: String,
    /// Whether the value is the most there is, and not the least: `at most 6.1 mm` as opposed to `at least 95 mm × 70 mm`.
    pub at_most: bool,
}

/// Sees what part of the work is done, 0 to 1, from any thread; the work ends soon after it returns `false`, with what was found until then.
pub type Watch<'a> = &'a (dyn Fn(f64) -> bool + Sync);

/// What a family proposes for a file.
pub trait Synthesiser: Send + Sync {
    /// How many designs are wanted.
    fn wanted(&self) -> usize;
    /// Designs by closed forms, the best first. Empty where none keeps to the limits. Where it is interrupted, what was found until then.
    fn proposals(&self, watch: Watch<'_>) -> Vec<Proposal>;
    /// A proposal in the light of its full analysis.
    fn judge(&self, proposal: &Proposal, outcome: &Outcome) -> Judgement;
    /// A proposal after a search has gone on from it: its sizes are those of the parameters that its file now has.
    fn searched(&self, proposal: &Proposal, parameters: &[ParameterRow]) -> Proposal;
    /// Whether two designs are so near to each other that one of them is enough.
    fn alike(&self, a: &Proposal, b: &Proposal) -> bool;
    /// For each limit the nearest value at which, all others as they are, something can be proposed; `slack` from 0 on loosens it by so
    /// much more, relative, where the nearest value did not stand the full analysis.
    fn relaxations(&self, slack: f64, watch: Watch<'_>) -> Vec<Relaxation>;
    /// The nearest that can be offered where nothing keeps to the limits: what misses them least.
    fn nearest(&self, watch: Watch<'_>) -> Vec<Proposal>;
    /// What the closed forms took, in words; empty where there is nothing to tell.
    fn effort(&self) -> Option<String> {
        None
    }
    /// Tables about the best design that meets everything, such as its alternatives.
    fn tables(&self, _best: &Proposal, _watch: Watch<'_>) -> Vec<StudyTable> {
        Vec::new()
    }
}
