//! Files of parts, written by an example and read by programs that know nothing of this project.

use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode};
use std::time::Duration;

use serde_json::json;

use crate::Workspace;
use crate::generate::built;
use crate::metadata::{self, cargo};
use crate::python::{CAD, TOOLS, python_name};
use crate::step::{Outcome, Steps, visible};
use crate::test::{emptied, run_script};

/// Drawings and meshes, for the command `test`.
pub(crate) fn run(workspace: &Workspace, steps: &mut Steps) {
    let Some((folder, samples)) = samples(workspace, steps) else { return };
    let (python, reason) = TOOLS.python(workspace, &folder, steps);
    let mut command = Command::new(python);
    command.current_dir(&workspace.root).arg("xtask/python/parts.py");
    let job = json!({ "folder": samples, "without_packages": reason });
    run_script(&mut command, &folder.join("parts.json"), &job, "parts", Duration::from_mins(5), steps);
}

/// Solids in a CAD kernel, force curves by finite elements: the command `validate`.
pub(crate) fn validate(workspace: &Workspace) -> ExitCode {
    let mut steps = Steps::default();
    if let (Some((folder, samples)), Some(binary)) = (samples(workspace, &mut steps), built(workspace, None, &mut steps)) {
        let (python, reason) = CAD.python(workspace, &folder, &mut steps);
        if let Some(reason) = reason {
            steps.run("solids", || Outcome::NotRun(reason));
        } else {
            let mut command = Command::new(python);
            command.current_dir(&workspace.root).arg("xtask/python/solids.py");
            run_script(
                &mut command,
                &folder.join("solids.json"),
                &json!({ "folder": samples, "binary": binary, "root": workspace.root, "projects": PROJECTS }),
                "solids",
                Duration::from_mins(10),
                &mut steps,
            );
        }
    }
    finite_elements(workspace, &mut steps);
    let code = steps.summary("validate");
    println!("\n{}", steps.closing_line());
    code
}

/// Force curves of beams against those of finite elements, where `CalculiX` is installed.
fn finite_elements(workspace: &Workspace, steps: &mut Steps) {
    let (Some(binary), Ok(metadata)) = (built(workspace, None, steps), metadata::read(workspace)) else { return };
    let folder = metadata.target.join("xtask");
    let job = json!({
        "binary": binary,
        "root": workspace.root,
        "folder": folder.join("finite-elements"),
        "element": "0.5 mm",
        "reference": workspace.root.join("reference/lan2010-finite-elements.csv"),
    });
    let mut command = Command::new(python_name());
    command.current_dir(&workspace.root).arg("xtask/python/finite_elements.py");
    run_script(&mut command, &folder.join("finite-elements.json"), &job, "finite elements", Duration::from_hours(1), steps);
}

/// Writes the samples. Gives the folder of the tasks, and that of the samples in it.
fn samples(workspace: &Workspace, steps: &mut Steps) -> Option<(PathBuf, PathBuf)> {
    let mut folders = None;
    steps.run("write sample parts", || {
        let made = metadata::read(workspace).and_then(|metadata| {
            let folder = metadata.target.join("xtask");
            let samples = folder.join("parts");
            emptied(&samples).map(|()| (folder, samples))
        });
        match made {
            Ok((folder, samples)) => {
                let outcome = visible(cargo(workspace).args(EXAMPLE).arg::<&Path>(&samples));
                folders = (outcome == Outcome::Passed).then_some((folder, samples));
                outcome
            }
            Err(error) => Outcome::Failed(error),
        }
    });
    folders
}

/// Projects whose parts are read in a CAD kernel: outlines of beams and of cams, grooved drums, gears.
const PROJECTS: [&str; 7] = [
    "examples/compliant/lan-table3.toml",
    "examples/compliant/lan-end-effector.toml",
    "examples/cam/no-undercut.toml",
    "examples/cam/push-springs.toml",
    "examples/cam/torque-cam.toml",
    "examples/capstan/longval.toml",
    "examples/lavt/butin-2.toml",
];

const EXAMPLE: [&str; 6] = ["run", "--package", "forcewright-fabricate", "--example", "samples", "--"];
