//! Everything that can be said about the project without running it.

use std::process::ExitCode;

use crate::Workspace;
use crate::generate;
use crate::layers;
use crate::metadata::{self, cargo};
use crate::step::{Outcome, Steps, visible};
use crate::tidy::Tree;

/// The command `lint`.
pub(crate) fn run(workspace: &Workspace) -> ExitCode {
    let mut steps = Steps::default();
    steps.run("format", || visible(cargo(workspace).args(["fmt", "--all", "--check"])));
    steps.run("clippy", || visible(cargo(workspace).args(["clippy", "--workspace", "--all-targets", "--", "-D", "warnings"])));
    steps.run("documentation", || visible(cargo(workspace).args(["doc", "--workspace", "--no-deps"]).env("RUSTDOCFLAGS", "-Dwarnings")));
    let metadata = metadata::read(workspace);
    steps.run("layers", || match &metadata {
        Ok(metadata) => Outcome::from_problems(&layers::violations(&metadata.packages)),
        Err(error) => Outcome::Failed(error.clone()),
    });
    match Tree::read(workspace) {
        Ok(tree) => {
            let root = &workspace.root;
            steps.run("tidy: length of files", || Outcome::from_problems(&tree.long_files()));
            steps.run("tidy: length of functions", || Outcome::from_problems(&tree.long_functions()));
            steps.run("tidy: nothing unfinished", || Outcome::from_problems(&tree.unfinished()));
            steps.run("tidy: no paths of machines", || Outcome::from_problems(&tree.machine_paths(root)));
            steps.run("tidy: sources are in the bibliography", || Outcome::from_problems(&tree.unknown_citations()));
            let packages = metadata.map_or_else(|_| Vec::new(), |metadata| metadata.packages);
            steps.run("tidy: crates are documented", || Outcome::from_problems(&tree.undocumented_crates(&packages)));
            steps.run("tidy: every example is run", || Outcome::from_problems(&tree.examples_not_run(root)));
        }
        Err(error) => {
            steps.run("tidy", || Outcome::Failed(error));
        }
    }
    generate::steps(workspace, true, None, &mut steps);
    steps.summary("lint")
}
