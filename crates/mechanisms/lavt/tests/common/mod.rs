//! What the tests of the family share.

use forcewright_base::diagnostics::Diagnostics;
use forcewright_contract::family::Mechanism as _;
use forcewright_contract::project::{Choices, Project};
use forcewright_contract::read;
use forcewright_lavt::{Design, Lavt, Spec};

/// The design of a project with some of its values set.
pub(crate) fn design(text: &str, set: &[&str]) -> Design {
    let choices = Choices { variant: None, set: set.iter().map(|s| (*s).to_owned()).collect() };
    let project = Project::from_text("test.toml", text, &choices);
    let mut diagnostics: Diagnostics = project.diagnostics;
    let mut spec: Spec = read::read(&project.tree, project.root, &mut diagnostics);
    let design = Lavt::resolve(&mut spec, &mut diagnostics);
    let said: Vec<_> = diagnostics.in_file_order().iter().map(|d| format!("{d:?}")).collect();
    design.unwrap_or_else(|| panic!("{said:#?}"))
}
